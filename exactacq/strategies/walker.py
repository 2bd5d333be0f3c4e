"""The walker: it goes along boundaries and straight ways, and senses them when somebody asks what it saw.

It counts obstacles as the scene does, and believes what it is told of ways that are free. What a strategy may
do and ask is the robot's (`exactacq.strategies.robot`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from threading import RLock

from exactacq.errors import ExactacqError, Undecided
from exactacq.gc_pause import uncollected
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.progress import Meter, Progress
from exactacq.scene.boundary_walk import Boundary
from exactacq.sensing.map import Body
from exactacq.sensing.memory import Memory, Report
from exactacq.sensing.path import Piece
from exactacq.visibility.links import START, Node


class Walker:
    """A point at *start*; *memory* makes a fresh memory for what it sees.

    Pieces of the path are sensed when the memory is asked for: where links alone decide the way, nobody asks.
    """

    def __init__(self, start: Point, memory: Callable[[], Memory]) -> None:
        self._fresh, self._memory = memory, memory()
        # What was reported at the start, and from each piece that is sensed.
        self._reports: list[list[Report]] = []
        self._sensing = RLock()
        self._boundaries: dict[int, Boundary] = {}
        self.pieces: list[Piece] = []
        self.start = self.position = start
        self.at: Node = START
        # After how many pieces each obstacle was visited, in the order of the visits.
        self.visited: dict[int, int] = {}
        # Why it does not move any more, if it does not.
        self.stuck: ExactacqError | None = None

    @property
    def count(self) -> int:
        """The number of pieces of the path so far."""
        return len(self.pieces)

    @property
    def bodies(self) -> Sequence[Body]:
        """What its numbers of obstacles mean."""
        return self._memory.bodies

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
        edges = len(self.bodies[self.at].edges)
        self._walk(curves[:edges], step)
        self._walk(curves[edges:])  # the rest of the edge where it began; or back to the first end
        self.position = curves[-1].end
        self.visit()

    def visit(self) -> None:
        """Mark the present obstacle visited: the walker has been all around."""
        assert isinstance(self.at, int)
        self.visited.setdefault(self.at, self.count)

    def go_straight(self, node: Node, target: Point) -> None:
        """Go to a point along a free segment; from then on the walker is at *node*."""
        if self.position != target:
            self.move(Piece("straight", None, Segment(self.position, target)))
        self.at, self.position = node, target

    def boundary(self) -> Boundary:
        """That of the obstacle where the walker is."""
        assert isinstance(self.at, int), "the walker is not at a boundary"
        if self.at not in self._boundaries:
            body = self.bodies[self.at]
            self._boundaries[self.at] = Boundary(body.edges, body.perimeter, body.closed)
        return self._boundaries[self.at]

    def _walk(self, curves: list[Curve], step: Callable[[], None] = lambda: None) -> None:
        assert isinstance(self.at, int)
        for curve in curves:
            self.move(Piece("boundary", self.at, curve))
            step()

    def move(self, piece: Piece) -> None:
        """Walk a piece of the path."""
        self.pieces.append(piece)

    # -- sensing -----------------------------------------------------------------------------------

    @property
    def memory(self) -> Memory:
        """All that it has seen; `Undecided` as `sense`."""
        self.sense()
        return self._memory

    @property
    def reports(self) -> list[list[Report]]:
        """What it saw at the start, and on each piece of the path; `Undecided` as `sense`."""
        self.sense()
        return self._reports

    @property
    def is_sensed(self) -> bool:
        """Whether all of the path is sensed."""
        return len(self._reports) > len(self.pieces)

    def sense(self, progress: Progress | None = None) -> None:
        """Sense what of the path is not sensed yet; *progress* is told pieces.

        `Undecided` where a comparison is: the path ends before that piece then, and the walker is stuck.
        """
        if not self.is_sensed:
            self._sense(progress)
        elif progress is not None:
            Meter(progress, self.count).close()

    def _sense(self, progress: Progress | None) -> None:
        meter = Meter(progress, len(self.pieces) - len(self._reports) + 1)
        with self._sensing, uncollected():
            try:
                if not self._reports:
                    self._reports.append(self._memory.begin(self.start))
                while not self.is_sensed:
                    self._reports.append(self._memory.walk(self.pieces[len(self._reports) - 1]))
                    meter.add()
            except Undecided as error:
                self._fall_back()
                self.stuck = error
                raise
            except BaseException:
                # Half of a piece may be taken in: the next time begins anew.
                self._memory, self._reports = self._fresh(), []
                raise
            meter.close()

    def _fall_back(self) -> None:
        """End the path where the last piece ends that could be sensed."""
        if not self._reports:
            self._reports.append([])
        count = len(self._reports) - 1
        around = [*self.pieces[count : count + 1], *self.pieces[:count][-1:]]
        del self.pieces[count:]
        for obstacle in [k for k, after in self.visited.items() if after > count]:
            del self.visited[obstacle]
        self.position = self.pieces[-1].end if self.pieces else self.start
        self.at = next((piece.obstacle for piece in around if piece.obstacle is not None), START)
