"""The walker: it goes along boundaries and straight ways, senses all the way, and records path and events.

It counts obstacles as the scene does, and believes what it is told of ways that are free. What a strategy may
do and ask is the robot's (`exactacq.strategies.robot`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.scene.boundary_walk import Boundary
from exactacq.sensing.decision import Decision
from exactacq.sensing.event import Ending, Event, EventKind
from exactacq.sensing.memory import Memory, Report
from exactacq.sensing.path import Path, Piece
from exactacq.visibility.links import START, Node


class Walker:
    """A point at *start* whose sensing goes into a fresh memory."""

    def __init__(self, start: Point, memory: Memory) -> None:
        self.memory = memory
        self._boundaries: dict[int, Boundary] = {}
        self.pieces: list[Piece] = []
        # What happened, as it was seen or told: events know the path, which goes on.
        self._marks: list[Report | partial[Event]] = []
        # The number of the last mark, and the pieces before it.
        self._last_mark = 0, 0
        self.start = self.position = start
        self.at: Node = START
        # In the order of the visits: a dict is a set that keeps it.
        self.visited: dict[int, None] = {}
        self.mark(EventKind.START, None)
        self._write(memory.begin(start))

    @property
    def count(self) -> int:
        """The number of pieces of the path so far."""
        return len(self.pieces)

    # -- motion ------------------------------------------------------------------------------------

    def way_to(self, point: Point) -> tuple[Length, bool]:
        """Length and sense of the shorter walk along the present boundary to a point of it."""
        return self.boundary().way(self.position, point)

    def walk_to(self, point: Point) -> None:
        """Walk the present boundary to a point of it, the shorter way."""
        _, forward = self.way_to(point)
        self._walk(self.boundary().walk(self.position, point, forward))
        self.position = point

    def circumnavigate(self, step: Callable[[], None] = lambda: None) -> None:
        """Walk the whole present boundary and mark the obstacle visited; *step* is called for each edge.

        The robot comes back to where it is. On a boundary with two ends it walks to the last one and, unless
        it began there, to the first one, where it stays.
        """
        assert isinstance(self.at, int)
        curves = self.boundary().loop(self.position)
        edges = len(self.memory.bodies[self.at].edges)
        self._walk(curves[:edges], step)
        self._walk(curves[edges:])  # the rest of the edge where it began; or back to the first end
        self.position = curves[-1].end
        self.visited[self.at] = None

    def go_straight(self, node: Node, target: Point) -> None:
        """Go to a point along a free segment; from then on the walker is at *node*."""
        if self.position != target:
            self.move(Piece("straight", None, Segment(self.position, target)))
        self.at, self.position = node, target

    def boundary(self) -> Boundary:
        """That of the obstacle where the walker is."""
        assert isinstance(self.at, int), "the walker is not at a boundary"
        if self.at not in self._boundaries:
            body = self.memory.bodies[self.at]
            self._boundaries[self.at] = Boundary(body.edges, body.perimeter, body.closed)
        return self._boundaries[self.at]

    def _walk(self, curves: list[Curve], step: Callable[[], None] = lambda: None) -> None:
        assert isinstance(self.at, int)
        for curve in curves:
            self.move(Piece("boundary", self.at, curve))
            step()

    def move(self, piece: Piece) -> None:
        """Walk a piece of the path and sense along it."""
        reports = self.memory.walk(piece)
        self.pieces.append(piece)
        self._write(reports)

    def give_up(self) -> None:
        """Stop where the last piece that could be sensed ends, as a comparison is undecided."""
        self.position = self.pieces[-1].end if self.pieces else self.start
        at = self.pieces[-1].obstacle if self.pieces else None
        self.mark(EventKind.STOP, at, ending=Ending.UNDECIDED)

    # -- the trace ---------------------------------------------------------------------------------

    def mark(self, kind: EventKind, obstacle: int | None, **why: Any) -> None:
        """Write an event here and now; *why* are its occasion, other, reason, ending and what is decided (see
        `Event`)."""
        self._last_mark = len(self._marks), len(self.pieces)
        self._marks.append(partial(Event, kind, self.position, obstacle, len(self.pieces), **why))

    def explain(self, decided: Decision | Callable[[], Decision], after: int) -> bool:
        """Tell the decision on what follows the event that was marked last, if that was after *after* pieces.

        One that has a decision keeps it.
        """
        number, place = self._last_mark
        mark = self._marks[number]
        assert not isinstance(mark, Report), "the last mark was told"
        if place != after or mark.keywords.get("decided") is not None:
            return False
        self._marks[number] = partial(mark, decided=decided)
        return True

    def _write(self, reports: list[Report]) -> None:
        self._marks += reports

    def trace(self) -> tuple[Path, tuple[Event, ...], Memory]:
        """The path, the events and the memory so far."""
        path = Path(self.pieces)
        events = (one.event(path) if isinstance(one, Report) else one(path=path) for one in self._marks)
        return path, tuple(events), self.memory
