"""Memory: the sensing of a whole path, piece by piece, and the map as it was at any moment of it.

What a piece added is kept as the edges that changed, so a run remembers every moment in memory proportional
to what was learned.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set
from dataclasses import dataclass

from flint import fmpq

from exactacq.components import Ground
from exactacq.points import Point
from exactacq.reals import Real
from exactacq.scene import Scene
from exactacq.trace import Piece
from exactacq.vision.intervals import Cover
from exactacq.vision.knowledge import Body, Map
from exactacq.vision.legs import Leg, legs_of
from exactacq.vision.sensing import Kind, Notice, Senses
from exactacq.vision.table import EdgeTable


@dataclass(frozen=True, slots=True)
class Report:
    """A notice placed on the path: after ``after`` whole pieces, or inside the piece of that number."""

    kind: Kind
    obstacle: int
    place: Point
    note: str
    after: int
    inside: bool


class Memory:
    """What a robot has learned on its way so far, with all ``reports``. *radius* is rational and positive.

    On a *ground* its components take the place of the scene's obstacles.
    """

    def __init__(
        self,
        scene: Scene,
        radius: fmpq,
        table: EdgeTable | None = None,
        ground: Ground | None = None,
    ) -> None:
        self.scene, self.radius, self.ground = scene, radius, ground
        self._table = EdgeTable(scene.obstacles) if table is None else table
        self.bodies: Sequence[Body] = scene.obstacles if ground is None else ground.components
        targets = None if ground is None else ground.targets(self._table)
        self._senses = Senses(self._table, radius, targets)
        self.reports: list[Report] = []
        # The parameters of the reports' places: numbers that glances share, so that ties with them are free.
        self._parameters: dict[tuple[int, int], tuple[Point, Real]] = {}
        self._learned: list[dict[int, Cover]] = []
        self._legs: list[list[Leg]] = []

    @classmethod
    def of(
        cls, scene: Scene, radius: fmpq, start: Point, path: Iterable[Piece], ground: Ground | None = None
    ) -> Memory:
        """The memory of a robot that walked a path."""
        memory = cls(scene, radius, ground=ground)
        memory.begin(start)
        for piece in path:
            memory.walk(piece)
        return memory

    @property
    def seen(self) -> set[int]:
        """The obstacles of which some point is known by now."""
        return self._senses.seen

    def begin(self, start: Point) -> list[Report]:
        """Look around at the start."""
        notices, learned = self._senses.look_around(start)
        self._learned.append(learned)
        return self._reported([Report(n.kind, n.obstacle, n.place, n.note, 0, False) for n in notices])

    def walk(self, piece: Piece) -> list[Report]:
        """Take in all that a piece of the path shows; the reports in the order in which they come."""
        legs, count = self._legs_of(piece), len(self._legs)
        reports = []
        learned: dict[int, Cover] = {}
        for k, leg in enumerate(legs):
            notices, more = self._senses.follow(leg)
            learned.update(more)
            for n in notices:
                self._parameters[count, id(n.place)] = n.place, n.u
                at_start = k == 0 and leg.order(n.u, leg.first) == 0
                at_end = k == len(legs) - 1 and leg.order(n.u, leg.last) == 0
                after = count + 1 if at_end and not at_start else count
                inside = not (at_start or at_end)
                reports.append(Report(n.kind, n.obstacle, n.place, n.note, after, inside))
        self._learned.append(learned)
        self._legs.append(legs)
        return self._reported(reports)

    def _legs_of(self, piece: Piece) -> list[Leg]:
        owner = piece.obstacle
        if owner is not None and self.ground is not None:
            owner = self.ground.components[owner].obstacle.index
        return legs_of(self._table, self._senses.rails, owner, piece.curve, piece.touches)

    def ahead(self, piece: Piece) -> tuple[Leg, list[Notice]]:
        """What a straight piece will tell when it is walked next."""
        (leg,) = self._legs_of(piece)
        return leg, self._senses.ahead(leg)[0]

    def on_the_way(self, leg: Leg, u: Real, place: Point) -> Map:
        """The map as it will be at a place of a leg that is walked next."""
        covers = dict(self._senses.covers)
        if leg.order(u, leg.first) > 0:
            covers.update(self._senses.known_after(leg.upto(u, place), covers))
        return self._map(covers)

    @property
    def now(self) -> Map:
        """The map as it is."""
        return self._map(dict(self._senses.covers))

    @property
    def in_sight(self) -> Set[int]:
        """The obstacles in sight, acquired ones aside."""
        return self._senses.in_sight

    @property
    def acquired(self) -> Set[int]:
        """The obstacles that are wholly known."""
        return self._senses.acquired

    def after(self, count: int) -> Map:
        """The map after the first *count* pieces."""
        return self._map(self._covers(count))

    def within(self, count: int, place: Point) -> Map:
        """The map when the robot is at a place inside piece number *count*."""
        covers = self._covers(count)
        for leg in self._legs[count]:
            _, u = self._parameters.get((count, id(place))) or (place, leg.rail.parameter(place))
            if leg.span.low.compare(u) <= 0 and leg.span.high.compare(u) >= 0:
                if leg.order(u, leg.first) > 0:
                    covers.update(self._senses.known_after(leg.upto(u, place), covers))
                break
            covers.update(self._senses.known_after(leg, covers))
        return self._map(covers)

    def _reported(self, reports: list[Report]) -> list[Report]:
        self.reports += reports
        return reports

    def _covers(self, count: int) -> dict[int, Cover]:
        covers: dict[int, Cover] = {}
        for learned in self._learned[: count + 1]:
            covers.update(learned)
        return covers

    def _map(self, covers: dict[int, Cover]) -> Map:
        return Map(self.bodies, self._senses.targets, self._senses.rails, covers)
