"""Tangent lines that graze several features, followed both ways up to what blocks them.

`exactacq.visibility.pinched_lines` follows them by the names of what they pass. Where that leaves something
open, `exactacq.visibility.free_segment.walk_line` does it by exact contacts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from math import hypot

from flint import arb

from exactacq.geometry.curve_images import held_point
from exactacq.geometry.curves import Segment
from exactacq.geometry.late import Pin, late_point
from exactacq.geometry.points import Point
from exactacq.kernel.grazing_lines import GrazingLine, MetEdge
from exactacq.kernel.line_walks import CROSSED
from exactacq.kernel.single_lines import SingleImage, Spot
from exactacq.numbers.real import Real
from exactacq.recent import Recent
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.line_family import SingleLine, SingleLines
from exactacq.sensing.line_images import LineImages
from exactacq.sensing.line_points import Role, Side
from exactacq.sensing.line_views import LineViews
from exactacq.visibility.features import Feature, corners_of_segments
from exactacq.visibility.free_runs import FreeRun, Hit, RunSide
from exactacq.visibility.free_segment import LineWalk, walk_line
from exactacq.visibility.line_balls import line
from exactacq.visibility.line_families import Sector
from exactacq.visibility.line_names import Namer
from exactacq.visibility.pinched_lines import walked
from exactacq.visibility.rotational_sweep import Passed
from exactacq.visibility.sensor_range import Range

RUNS_KEPT = 1000
"""So many names of lines are kept at most, with what the lines meet."""
WIDER = 2
"""When a line is followed a second time, it is followed for so many times the reach."""


@dataclass(frozen=True, slots=True)
class FeatureLine:
    """The tangent line of a feature at a parameter of one of its sectors, with all that it passes."""

    feature: Feature
    sector: Sector
    t: Real
    passed: Passed


@dataclass(slots=True)
class FollowedLine(SingleLines):
    """A line in floats, with what it meets from behind its contact to ahead of it, made exact when asked for.

    *pinned* makes the place where it meets an edge, *ended* that which is as far away as the range.
    """

    image: GrazingLine
    pinned: Callable[[int], Pin]
    ended: Callable[[Role], Point]
    _pins: dict[int, Pin] = field(default_factory=dict)
    _singles: dict[tuple[int, int, int], SingleLine] = field(default_factory=dict)

    @property
    def met(self) -> list[MetEdge]:
        """What the line meets, the contact among it."""
        return self.image.met

    def pin(self, number: int) -> Pin:
        """Where the line meets an edge, by its number."""
        if number not in self._pins:
            self._pins[number] = self.pinned(number)
        return self._pins[number]

    def end(self, role: Role) -> int | None:
        """The number of what blocks the line on one side, if anything does."""
        ahead = role is Role.AHEAD
        return (len(self.met) - 1 if ahead else 0) if self.image.is_blocked[ahead] else None

    def single(self, image: SingleImage) -> SingleLine:
        """One of the line's single lines, made when it is first asked for."""
        if image.numbers not in self._singles:
            here, near, far = image.numbers
            is_free = not 0 <= here < len(self.met)
            place = (self.ended(Role.BEHIND if here < 0 else Role.AHEAD), None) if is_free else self.pin(here)
            self._singles[image.numbers] = SingleLine(place, (self.pin(near), self.pin(far)), image)
        return self._singles[image.numbers]


class LineFollower:
    """Follows tangent lines of the features of a scene as far as the range."""

    def __init__(
        self, table: EdgeTable, range_: Range, views: LineViews, namer: Namer, images: LineImages
    ) -> None:
        self.table, self.range, self.views = table, range_, views
        self._namer, self._images = namer, images
        self._runs = Recent[int, FreeRun](RUNS_KEPT)

    def follow(self, at: FeatureLine, near: frozenset[int] | None = None) -> FollowedLine:
        """What a line meets as far as it is free, of the edges *near* its contact, or of all within reach."""
        reach = self.range.above
        walk = walked(self.table, at.feature, at.sector, at.t, at.passed, reach, near)
        if walk is None:
            return self._exactly(at)
        met = [*reversed(walk.behind), *walk.contact([*at.feature.edges]), *walk.ahead]
        below, above = self._images.reach
        far, error = (below + above) / 2, above - below

        def pinned(number: int) -> Pin:
            one = met[number]
            if one.vertex >= 0:
                return self._vertex(one.vertex, one.edge)
            return self.meeting(at, Role((one.place > 0) - (one.place < 0)), one.edge)

        ends = walk.spot(-far, error), walk.spot(far, error)
        is_blocked = walk.is_blocked_behind, walk.is_blocked_ahead
        return self._followed(at, met, ends, is_blocked, pinned)

    def _followed(
        self,
        at: FeatureLine,
        met: list[MetEdge],
        ends: tuple[Spot, Spot],
        is_blocked: tuple[bool, bool],
        pinned: Callable[[int], Pin],
    ) -> FollowedLine:
        table, own = self.table, at.feature.edges[-1]
        corners = corners_of_segments(table)
        image = GrazingLine(table.images, table.curve_images, corners, met, ends, is_blocked, own)
        return FollowedLine(image, pinned, lambda role: self.at_range(at, role))

    def _exactly(self, at: FeatureLine) -> FollowedLine:
        """A line by exact contacts: what it meets, as far as it is free."""
        behind, ahead = self._sides(at)
        hits = [*reversed(behind.hits), *self._here(at), *ahead.hits]
        met = [MetEdge(hit.edge, hit.vertex, hit.place, hit.span, hit.spot) for hit in hits]
        far = self.at_range(at, Role.BEHIND), self.at_range(at, Role.AHEAD)
        ends = held_point(far[0]), held_point(far[1])
        return self._followed(at, met, ends, (behind.blocked, ahead.blocked), lambda k: hits[k].pin)

    def _sides(self, at: FeatureLine) -> tuple[RunSide, RunSide]:
        """What a line meets behind its contact and ahead of it, off a run of the same line if that has it."""
        keys = self.table.line_numbers.keys(self._namer.number(at.feature), [*at.passed])
        runs = dict.fromkeys(run for key in keys if (run := self._runs.get(key)) is not None)
        told = next((told for run in runs if (told := self._told(run, at)) is not None), None)
        if told is None:
            # A line that is followed again may be so from other features too.
            run = self._run(at, self.range.above * (WIDER if runs else 1))
            for key in keys:
                self._runs.put(key, run)
            told = self._told(run, at)
        assert told is not None, "a run tells what is met from where it was followed"
        return told

    def _told(self, run: FreeRun, at: FeatureLine) -> tuple[RunSide, RunSide] | None:
        feature = at.feature
        corner = None if feature.round else self.table.curves[feature.edges[-1]].start
        here = run.place_of(feature.edges, corner)
        return None if here is None else run.seen_from(here, _heading(at), self.range.above)

    def _run(self, at: FeatureLine, reach: float) -> FreeRun:
        """Follow a line by its exact contacts within some reach."""
        walks = walk_line(self.table, at.sector, at.t, reach)
        behind, ahead = (
            RunSide(list(self._met(walk, at, role)), walk.blocked)
            for walk, role in zip(walks, (-1, 1), strict=True)
        )
        here = list(self._here(at))
        contact, curves = here[0].pin[0], self.table.curves
        for e in walks[0].here:
            if e not in at.feature.edges:
                # An arc that ends in the contact, and the edge beside it.
                vertex = e if curves[e].start == contact else self.table.following[e]
                here.append(self._hit(e, self._vertex(vertex, e), 0, 0.0))
        return FreeRun(self.table, _heading(at), behind, here, ahead, reach)

    def _here(self, at: FeatureLine) -> Iterator[Hit]:
        """The edges of the feature, met in the contact."""
        own = at.feature.edges[-1]
        for e in at.feature.edges:
            is_round = at.feature.round
            pin = self.meeting(at, Role.CONTACT, e) if is_round else self._vertex(own, e)
            yield self._hit(e, pin, 0, 0.0)

    def _met(self, walk: LineWalk, at: FeatureLine, role: int) -> Iterator[Hit]:
        """What a line meets on one side."""
        contact, direction = at.sector.touch(at.t)
        size = hypot(*direction.xy)
        place, before = 0, Real(0)
        for tau, e in walk.hits:
            if tau.compare(before) != 0:
                place, before, point = place + role, tau, contact + direction * tau
            yield self._hit(e, (point, self.views.rails[e].parameter(point)), place, float(tau) * size)

    def _hit(self, e: int, pin: Pin, place: int, along: float) -> Hit:
        """An edge as it is met in an exact point: of corners of segments no feature is known there."""
        point, curve, vertex = pin[0], self.table.curves[e], CROSSED
        if not isinstance(curve, Segment) and not self.table.full[e]:
            if point == curve.start:
                vertex = e
            elif point == curve.end:
                vertex = self.table.following[e]
        return Hit(along, place, e, vertex, pin, self._images.hull(e, (point,)), held_point(point))

    def _vertex(self, vertex: int, e: int) -> Pin:
        """An end of an edge."""
        point = self.table.curves[e].start if vertex == e else self.table.curves[e].end
        return point, self.views.rails[e].parameter(point)

    def meeting(self, at: FeatureLine, role: Role, edge: int) -> Pin:
        """Where a line meets an edge on one side of its contact, or has its contact."""
        names = self._namer.names(at.feature, at.sector, at.t, at.passed)
        return self.views.pin(at.sector, at.t, Side(edge, role), names, at.passed)

    def at_range(self, at: FeatureLine, role: Role) -> Point:
        """The end of a line that is as long as the range."""
        x, y, dx, dy = line(at.sector, at.t.ball(64))
        away = role * arb(self.range.radius) / (dx * dx + dy * dy).sqrt()
        return late_point((x + dx * away, y + dy * away), self._at_range, at, role)

    def _at_range(self, at: FeatureLine, role: Role) -> Point:
        contact, direction = at.sector.touch(at.t)
        reached: Point = contact + direction * (int(role) * self.range.radius / direction.norm_sq().sqrt())
        return reached


def _heading(at: FeatureLine) -> tuple[float, float]:
    """The direction of a line in floats."""
    return at.sector.touch(at.t)[1].xy
