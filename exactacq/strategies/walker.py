"""The walker: it goes along boundaries and straight ways, and senses them when somebody asks what it saw.

It numbers obstacles as the scene does, and does not check that a way is free. What a strategy may do and ask
is the robot's (`exactacq.strategies.robot`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from threading import RLock

from exactacq.errors import ExactacqError, Undecided
from exactacq.gc_pause import uncollected
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.progress import Meter, Progress
from exactacq.scene.boundary_walk import Boundary
from exactacq.sensing.map import Body
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Piece
from exactacq.visibility.links import START, Node


class Walker:
    """A point at *start*; *memory* makes a fresh memory for what it sees.

    Pieces of the path are sensed when the memory is asked for: where links alone decide the way, nobody asks.
    """

    def __init__(self, start: Point, memory: Callable[[], Memory]) -> None:
        self._fresh, self._memory = memory, memory()
        # How many pieces are sensed, the look around at the start counted as one.
        self._sensed = 0
        self._is_half_taken = False
        # Held while it senses: others may ask meanwhile.
        self.sensing = RLock()
        self._boundaries: dict[int, Boundary] = {}
        # The pieces of the path, and at which node each began.
        self.pieces: list[Piece] = []
        self._nodes: list[Node] = []
        self.start = self.position = start
        self.at: Node = START
        # After how many pieces each obstacle was visited, in the order of the visits.
        self.visited: dict[int, int] = {}
        # Why it does not move any more, if it does not; and what of what it saw is undecided, if that is why.
        self.stuck: ExactacqError | None = None
        self.undecided: Undecided | None = None

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
        self.walk_on(point, self.way_to(point)[1])

    def walk_on(self, point: Point, forward: bool) -> None:
        """Walk the present boundary to a point of it, in its direction or against it."""
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
        self.visit()

    def visit(self) -> None:
        """Mark the present obstacle visited: the walker has been all around."""
        assert isinstance(self.at, int)
        self.visited.setdefault(self.at, self.count)

    def go_straight(self, node: Node, target: Point) -> None:
        """Go to a point along a free segment; from then on the walker is at *node*.

        Where it is already it keeps its place: an equal point has other numbers, which have to be compared.
        """
        if self.position != target:
            self.move(Piece("straight", None, Segment(self.position, target)))
        self.at = node

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
        """Walk a piece of the path. A straight one leaves the boundary where the walker was."""
        self._nodes.append(self.at)
        self.pieces.append(piece)
        self.position = piece.end
        if piece.obstacle is None:
            self.at = START

    # -- sensing -----------------------------------------------------------------------------------

    @property
    def memory(self) -> Memory:
        """All that it has seen; `Undecided` as `sense`."""
        self.sense()
        return self._memory

    @property
    def is_sensed(self) -> bool:
        """Whether all of the path is sensed."""
        return self._sensed > self.count

    def sense(self, progress: Progress | None = None) -> None:
        """Sense what of the path is not sensed yet; *progress* is told pieces, the start counted as one.

        `Undecided`, once, where a comparison is: the path ends before that piece then, and the walker is
        stuck.
        """
        if self.is_sensed:
            if progress is not None:
                Meter(progress, self.count + 1).close()
            return
        with self.sensing, uncollected():
            meter = Meter(progress, self.count + 1 - self._sensed)
            while not self.is_sensed:
                self._sense_next()
                meter.add()

    def _sense_next(self) -> None:
        """Sense the next piece, or look around at the start; where that was interrupted, begin anew."""
        if self.undecided is not None:
            self._fall_back()
            raise copy(self.undecided)
        if self._is_half_taken:
            self._sensed, self._memory = 0, self._fresh()
        self._is_half_taken, done = True, self._sensed
        try:
            if done:
                self._memory.walk(self.pieces[done - 1])
            else:
                self._memory.begin(self.start)
        except Undecided as error:
            # A copy: it does without what the traceback holds on to.
            self.stuck = self.undecided = copy(error)
            self._fall_back()
            raise
        self._sensed, self._is_half_taken = done + 1, False

    def _fall_back(self) -> None:
        """End the path where the last piece ends that could be sensed."""
        # Where even the look around at the start is undecided, it counts as made: nothing was seen.
        self._sensed = max(self._sensed, 1)
        count = self._sensed - 1
        for obstacle in [k for k, after in self.visited.items() if after > count]:
            del self.visited[obstacle]
        self.at = self._nodes[count] if count < len(self._nodes) else START
        self.position = self.pieces[count - 1].end if count else self.start
        del self.pieces[count:], self._nodes[count:]
