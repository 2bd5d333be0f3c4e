"""The line families that cross a straight way: where a line does, the robot sees along it both ways.

It sees past the contact, to the contact, or, on the normal of an edge, to the foot.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from itertools import pairwise

from flint import arb, fmpq

from exactacq.cached import cached_property
from exactacq.geometry.curves import Segment
from exactacq.geometry.intersections import line_contacts
from exactacq.geometry.late import Balls, Pin
from exactacq.kernel.bounded import TINY, UNIT
from exactacq.kernel.extents import Extent
from exactacq.kernel.family_images import FamilyImage
from exactacq.kernel.images import SLIDING, SPOKES
from exactacq.kernel.lines import line_at, side_of
from exactacq.kernel.ways import Crossing, crossings, extents_from_way
from exactacq.numbers.between import rational_between
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.sensing.line_family import LineFamily, family_of
from exactacq.sensing.line_points import Role, Side
from exactacq.sensing.straight_way import StraightWay
from exactacq.sensing.view_families import FreeViews, ViewFamily
from exactacq.sensing.way_cuts import Cut, WayCuts
from exactacq.visibility.chords import meet
from exactacq.visibility.line_balls import LONG, crossing, line, long_frame


class WayCrossings:
    """Those of some *families*, in lists, that may cross a way and meet *wanted* edges."""

    def __init__(self, way: StraightWay, families: list[list[FamilyImage]], wanted: frozenset[int]) -> None:
        self.way, self.wanted = way, wanted
        self._families, self._cuts = families, WayCuts(way)
        self._is_along: dict[int, bool] = {}

    @cached_property
    def _found(self) -> list[Crossing]:
        count = len(self.way.table.curves)
        found = crossings(self._families, set(self.wanted), count, self.way.image)
        left = [at for at in found if at[1] or at[0].fixed or not self._are_along(at[0])]
        self.way.tell_lines_at_ends(left)
        return left

    def _are_along(self, family: FamilyImage) -> bool:
        """Whether of some normals only one may cross the way: along itself, which its own line tells.

        So it is with those of a straight edge that are parallel to it, and with those, outward, of a round
        boundary whose centre its line passes.
        """
        kind, *_, sense = family.frame
        if kind not in (SLIDING, SPOKES) or (kind == SPOKES and sense < 0):
            return False
        e = self.way.table.line_numbers.circles[family.edge(Role.CONTACT)]
        if kind == SPOKES:
            return self.way.passes_centre(e)
        if e not in self._is_along:
            edge, along = self.way.clipper.curve(e), self.way.piece.direction
            assert isinstance(edge, Segment), "normals of arcs are spokes"
            self._is_along[e] = edge.direction.dot(along).sign() == 0
        return self._is_along[e]

    def __iter__(self) -> Iterator[tuple[FamilyImage, bool]]:
        """The line families, and whether all their lines cross the way."""
        return iter(self._found)

    def extents(self) -> list[Extent]:
        """What they show, in floats; the origins are their places here."""
        curves, reach = self.way.table.curve_images, self.way.complex.images.reach
        return extents_from_way(self._found, set(self.wanted), self.way.image, curves, reach)

    def views(
        self,
        line_family: LineFamily,
        certain: bool,
        wanted: frozenset[int],
        told: Role | None = None,
        near: Collection[int] = (),
    ) -> Iterator[ViewFamily]:
        """Views along the lines of a family; *certain* if each line passes between the ends of the way.

        *told* is on which side of the contact they do, if that is known, and the views of *near* sides, by
        their roles, are known to be within range.
        """
        if not line_family.sector.round and line_family.anchor in self.way.touches:
            # Every line through a corner that the way touches crosses it there and shows nothing else.
            return
        cuts: list[Cut] = [
            (line_family.low, None, line_family.names[0]),
            (line_family.high, None, line_family.names[1]),
        ]
        if not certain:
            cuts = self._cuts.of(line_family)
        for (low, first, called), (high, last, named) in pairwise(cuts):
            role = told
            if told is None or not certain:
                role = self._role_of_part(line_family, rational_between(low, high), wanted, told)
            if role is None:
                continue
            here = Side(self.way.number, role, on_way=True)
            for other in _shown(line_family, role, wanted):
                names, pins = (called, named), (first, last)
                passed = (
                    line_family.passed[0] if low is line_family.low else (),
                    line_family.passed[1] if high is line_family.high else (),
                )
                anchor = line_family.anchor if line_family.goes_back else None
                in_range = other.role in near
                free_views = FreeViews(
                    line_family.sector, low, high, (here, other), names, pins, passed, anchor, in_range
                )
                yield from self.way.clipper.families(free_views)

    def pin(self, number: int, role: Role, is_last: bool) -> Pin:
        """Where the first or the last line of a family, by its place here, crosses the way, on that side."""
        image, certain = self._found[number]
        line_family = family_of(image)
        t, names = line_family.high if is_last else line_family.low, line_family.names[is_last]
        known = None if certain else self._cuts.pin_at(line_family, t, names)
        if known is not None:
            return known
        here = Side(self.way.number, role, on_way=True)
        return self.way.clipper.views.pin(line_family.sector, t, here, names, line_family.passed[is_last])

    def _role_of_part(
        self, line_family: LineFamily, t: fmpq, wanted: frozenset[int], told: Role | None
    ) -> Role | None:
        """On which side of the contact a line crosses the way, if it does; *told* if floats part its ends."""
        if told is not None:
            ax, ay, bx, by, error = self.way.image.ends
            near = float(t)
            at = line_at(line_family.sector.image, near, UNIT * abs(near) + TINY)
            one, other = side_of(at, ax, ay, error, 0.0), side_of(at, bx, by, error, 0.0)
            if one and other:
                return None if one == other else told
        return self._role(line_family, t, wanted)

    def _role(self, line_family: LineFamily, t: fmpq, wanted: frozenset[int]) -> Role | None:
        """On which side of the contact the line crosses the way within its free part, if it does."""
        is_told, role = self._clear_role(line_family, t)
        if is_told:
            return role if role is None or _shown(line_family, role, wanted) else None
        contact, direction = line_family.sector.touch(Real(t))
        met = line_contacts(contact, direction, self.way.piece)
        if not met or met[0].sign() == 0:
            return None
        role = Role(met[0].sign())
        if not _shown(line_family, role, wanted):
            return None
        wall = line_family.sides[role + 1]
        if wall is None:
            return role if _is_open(line_family, role) else None
        limit = meet(contact, direction, self.way.clipper.curve(wall.edge), role)
        return role if (limit - met[0]).sign() * role >= 0 else None

    def _clear_role(self, line_family: LineFamily, t: fmpq) -> tuple[bool, Role | None]:
        """Whether long balls tell that, and what they tell."""
        sector = line_family.sector
        start, end = self._long_ends
        with workprec(LONG):
            at = line(sector, arb(t), long_frame(sector))
            met = crossing(at, start, end)
            if not met:
                return met is not None, None
            tau = met[0][0]
        role = Role(ball_sign(tau))
        if role is Role.CONTACT:
            return False, None
        wall = line_family.sides[role + 1]
        if wall is None:
            return True, role if _is_open(line_family, role) else None
        limit = self.way.clipper.views.balls_of(wall.edge).met(at, role)
        order = 0 if limit is None else ball_sign(limit[0] - tau) * role
        return order != 0, role if order > 0 else None

    @cached_property
    def _long_ends(self) -> tuple[Balls, Balls]:
        """Long balls around the ends of the way."""
        start, end = self.way.piece.start, self.way.piece.end
        return (start.x.ball(LONG), start.y.ball(LONG)), (end.x.ball(LONG), end.y.ball(LONG))


def _is_open(line_family: LineFamily, role: Role) -> bool:
    """Whether lines that meet nothing within reach on one side of the contact go there at all.

    Normals do not go back from their edge.
    """
    return role is Role.AHEAD or line_family.goes_back


def _shown(line_family: LineFamily, role: Role, wanted: frozenset[int]) -> list[Side]:
    """The wanted sides that a line family shows from behind or ahead of its contact."""
    shown = line_family.contact, line_family.sides[1 - role]
    return [side for side in shown if side is not None and side.edge in wanted]
