"""Tangent lines that graze several features, followed both ways up to what blocks them.

`exactacq.visibility.pinched_lines` follows them by the names of what they pass. Where that leaves something
open, `exactacq.visibility.free_segment.walk_line` does it by exact contacts.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from flint import arb

from exactacq.geometry.late import Pin, late_point
from exactacq.geometry.points import Point
from exactacq.kernel.line_walks import Hit
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import CONVEX, EdgeTable
from exactacq.sensing.line_points import Role, Side
from exactacq.sensing.line_views import LineViews
from exactacq.visibility.features import Feature
from exactacq.visibility.free_segment import LineWalk, walk_line
from exactacq.visibility.line_balls import line
from exactacq.visibility.line_families import Sector
from exactacq.visibility.line_names import Namer, Names
from exactacq.visibility.pinched_lines import walked
from exactacq.visibility.rotational_sweep import Passed
from exactacq.visibility.sensor_range import Range


@dataclass(frozen=True, slots=True)
class FeatureLine:
    """The tangent line of a feature at a parameter of one of its sectors, with all that it passes.

    That is of the edges *near* its contact, or of all within reach.
    """

    feature: Feature
    sector: Sector
    t: Real
    passed: Passed
    near: frozenset[int] | None = None


@dataclass(frozen=True, slots=True)
class Met:
    """An edge that a line meets, and where: places are numbered from the contact on, equal ones alike."""

    edge: int
    pin: Pin
    place: int


@dataclass(frozen=True, slots=True)
class FollowedLine:
    """What a line meets, from behind its contact to ahead of it, and whether its two ends are blocked.

    The contact is among it. Of arcs that are ``blind`` nothing is told.
    """

    met: list[Met]
    is_blocked: tuple[bool, bool]
    blind: set[int]

    def end(self, role: Role) -> Met | None:
        """What blocks the line on one side, if anything does."""
        ahead = role is Role.AHEAD
        return self.met[-1 if ahead else 0] if self.is_blocked[ahead] else None


class LineFollower:
    """Follows tangent lines of the features of a scene as far as the range."""

    def __init__(self, table: EdgeTable, range_: Range, views: LineViews, namer: Namer) -> None:
        self.table, self.range, self.views, self._namer = table, range_, views, namer

    def follow(self, at: FeatureLine) -> FollowedLine:
        """What a line meets, as far as it is free."""
        names = self._names(at)
        behind, ahead, is_blocked = self._followed(at, names)
        own = at.feature.edges[-1]
        if at.feature.round:
            here = [Met(own, self._pin(at, names, own, Role.CONTACT), 0)]
        else:
            here = [Met(e, self._vertex(own, e), 0) for e in at.feature.edges]
        met = [*reversed(behind), *here, *ahead]
        return FollowedLine(met, is_blocked, self._blind(behind, ahead, is_blocked) - {own})

    def _followed(self, at: FeatureLine, names: Names) -> tuple[list[Met], list[Met], tuple[bool, bool]]:
        """What a line meets behind and ahead, nearest first, and whether the last of it blocks the line."""
        walk = walked(self.table, at.feature, at.sector, at.t, at.passed, self.range.above, at.near)
        if walk is not None:
            behind = self._named(walk.behind, at, names, Role.BEHIND)
            ahead = self._named(walk.ahead, at, names, Role.AHEAD)
            return behind, ahead, (walk.is_blocked_behind, walk.is_blocked_ahead)
        walks = walk_line(self.table, at.sector, at.t, self.range.above)
        behind, ahead = (self._exact(walk, at, role) for walk, role in zip(walks, (-1, 1), strict=True))
        return behind, ahead, (walks[0].blocked, walks[1].blocked)

    def _named(self, hits: list[Hit], at: FeatureLine, names: Names, role: Role) -> list[Met]:
        found: list[Met] = []
        place, last = 0, -1
        for e, vertex in hits:
            if vertex < 0 or vertex != last:
                place, last = place + role, vertex
            pin = self._pin(at, names, e, role) if vertex < 0 else self._vertex(vertex, e)
            found.append(Met(e, pin, place))
        return found

    def _exact(self, walk: LineWalk, at: FeatureLine, role: int) -> list[Met]:
        contact, direction = at.sector.touch(at.t)
        found: list[Met] = []
        place, before = 0, Real(0)
        for tau, e in walk.hits:
            if tau.compare(before) != 0:
                place, before, point = place + role, tau, contact + direction * tau
            found.append(Met(e, (point, self.views.rails[e].parameter(point)), place))
        return found

    def _vertex(self, vertex: int, e: int) -> Pin:
        """An end of an edge."""
        point = self.table.curves[e].start if vertex == e else self.table.curves[e].end
        return point, self.views.rails[e].parameter(point)

    def _pin(self, at: FeatureLine, names: Names, e: int, role: Role) -> Pin:
        return self.views.pin(at.sector, at.t, Side(e, role), names, at.passed)

    def _names(self, at: FeatureLine) -> Names:
        return self._namer.names(at.feature, at.sector, at.t, at.passed)

    def meeting(self, at: FeatureLine, role: Role, edge: int) -> Pin:
        """Where a line enters an obstacle through an edge."""
        return self._pin(at, self._names(at), edge, role)

    def at_range(self, at: FeatureLine, role: Role) -> Point:
        """The end of a line that is as long as the range."""
        x, y, dx, dy = line(at.sector, at.t.ball(64))
        away = role * arb(self.range.radius) / (dx * dx + dy * dy).sqrt()
        return late_point((x + dx * away, y + dy * away), self._at_range, at, role)

    def _at_range(self, at: FeatureLine, role: Role) -> Point:
        contact, direction = at.sector.touch(at.t)
        reached: Point = contact + direction * (int(role) * self.range.radius / direction.norm_sq().sqrt())
        return reached

    def _blind(self, behind: list[Met], ahead: list[Met], is_blocked: tuple[bool, bool]) -> set[int]:
        """The convex arcs that a line touches once, between their ends: they tell who sees them along it."""
        times = Counter(met.edge for met in behind + ahead)
        blocking = {
            met[-1].edge for met, blocked in zip((behind, ahead), is_blocked, strict=True) if blocked and met
        }
        return {
            e
            for e, count in times.items()
            if count == 1 and e not in blocking and self.table.images.kind[e] == CONVEX
        }
