"""What a robot shows its strategy on a straight way: what it sees there, place by place."""

from __future__ import annotations

from collections.abc import Set

from exactacq.errors import FormatError, MoveError, shown
from exactacq.geometry.coordinates import cross
from exactacq.geometry.curves import Segment
from exactacq.geometry.late import balls, from_to
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import ball_sign
from exactacq.sensing.map import Map
from exactacq.sensing.path import Piece
from exactacq.sensing.sensor import Ahead, Notice
from exactacq.strategies.known_map import KnownMap, Sighting
from exactacq.strategies.moves import Passage, Watch
from exactacq.strategies.numbering import Numbering
from exactacq.strategies.walker import Walker


class Lookout:
    """Asks a *watch* on a straight way with distinct ends, first where the robot sets out.

    Places are ordered by one coordinate. That of a place where a view ends may not be made yet: balls decide
    most comparisons.
    """

    def __init__(self, way: Segment, watch: Watch, walker: Walker, numbers: Numbering) -> None:
        self._watch, self._walker, self._numbers = watch, walker, numbers
        along = way.direction
        self._start = balls(way.start)
        self._along = from_to(self._start, balls(way.end))
        self._upright = along.y.sign() != 0
        self._sense = along.y.sign() if self._upright else along.x.sign()
        now = walker.memory.now
        self._stop: Point | None = None
        self._ask(Passage(way.start, None, KnownMap(numbers, lambda _: now)))

    def stop_on(self, piece: Piece) -> Point | None:
        """Where on a piece, which is one leg and is walked next, the robot is to halt; None if beyond it."""
        ahead = self._walker.memory.ahead(piece)
        for notice in ahead.notices:
            if self._is_due_before(notice.place):
                break
            self._pass(ahead, notice)
        return self._stop if self._is_due_before(piece.end) else None

    def _is_due_before(self, place: Point) -> bool:
        return self._stop is not None and self._order(self._stop, place) < 0

    def _order(self, a: Point, b: Point) -> int:
        """-1, 0 or 1 as the robot passes one place before, at or after another."""
        return (a.y.compare(b.y) if self._upright else a.x.compare(b.x)) * self._sense

    def _ask(self, passage: Passage) -> None:
        answer = self._watch(passage)
        try:
            stop = None if answer is None else Point.of(answer)
        except FormatError:
            text = f"what watches a way answers with a point of it or with None, not {shown(answer)}"
            raise MoveError(text) from None
        if stop is not None and stop is not self._stop:
            # Balls are enough here: of a place that is reached it is asked exactly.
            if ball_sign(cross(self._along, from_to(self._start, balls(stop)))):
                raise MoveError(f"{stop} is not on the way")
            if self._order(stop, passage.place) < 0:
                raise MoveError(f"the robot has passed {stop}, and cannot halt there")
        self._stop = stop

    def _pass(self, ahead: Ahead, notice: Notice) -> None:
        number, memory, passing = self._numbers.add(notice.obstacle), self._walker.memory, True

        def chart(obstacles: Set[int]) -> Map:
            if not passing:
                raise MoveError("the robot has passed the place of this map")
            return memory.map_ahead(ahead, notice.u, notice.place, obstacles)

        seen = Sighting(notice.kind, number, notice.place, notice.reason)
        try:
            self._ask(Passage(notice.place, seen, KnownMap(self._numbers, chart)))
        finally:
            passing = False
