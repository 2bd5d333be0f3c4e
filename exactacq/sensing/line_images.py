"""Makes the float images of the line families of a scene (see `exactacq.kernel.family_images`)."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

from exactacq import kernel
from exactacq.cached import cached_property
from exactacq.geometry.curve_images import held_point
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.points import Point
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import EVERYTHING, SURE, Span
from exactacq.kernel.family_images import EdgePlace, EdgePlaces, FamilyImage, perhaps_over_start
from exactacq.kernel.lines import parameter
from exactacq.kernel.single_lines import Spot
from exactacq.numbers.float_bounds import float_ball
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.line_points import Role
from exactacq.visibility.rotational_sweep import Pencil
from exactacq.visibility.sensor_range import Range


class LineImages:
    """The curves of a scene in floats, and the images of line families that are made from them."""

    def __init__(self, table: EdgeTable, range_: Range) -> None:
        self.table = table
        self.reach = range_.below, range_.above

    @cached_property
    def curves(self) -> list[CurveImage]:
        """The curves in floats; none if floats are to decide nothing."""
        return [] if kernel.EXACT_ONLY else self.table.curve_images

    @cached_property
    def has_full(self) -> bool:
        """Whether there are full circles."""
        return bool(self.table.full.any())

    def hull(self, e: int, points: Iterable[Point]) -> Span:
        """Bounds of the parameters of some points of an edge; of a circle's start nothing is told."""
        curve, places = self.table.curves[e], []
        for point in points:
            if not self.table.full[e]:
                if point is curve.start or (not point.is_late and point.rational == curve.start.rational):
                    places.append((-inf, -inf))
                    continue
                if point is curve.end or (not point.is_late and point.rational == curve.end.rational):
                    places.append((inf, inf))
                    continue
            u, error = parameter(self.table.curve_images[e], *held_point(point))
            if self.table.full[e] and not error < u < 4 - error:
                return EVERYTHING
            places.append((u - error, u + error))
        return min(low for low, _ in places), max(high for _, high in places)

    def unroll(self, families: list[FamilyImage], lines: Pencil) -> None:
        """Tell of those of a pencil's families that meet full circles where they may pass their start."""
        if self.has_full:
            for image, role in perhaps_over_start(families, self.table.images):
                self._unroll(image, Role(role), lines, image.edge(role))

    def _unroll(self, image: FamilyImage, role: Role, lines: Pencil, edge: int) -> None:
        """The first and the last place on a full circle, at whose start parameters jump.

        Where lines turn it is known which way the place moves (see `FreeViews.grows`): if parameters change
        the other way, it passes the start, for it makes less than a whole turn. Where lines slide, a place
        that comes near the start may pass it.
        """
        row, turns, grows = lines.rows[image.number], lines.sector.turns, role is Role.CONTACT
        found, start = list(image.places(role)), self.table.curves[edge].start
        for k, bound in enumerate((row.first, row.last)):
            (low, high, *rest), other = found[k], found[1 - k]
            if low <= 0 or high >= 4:
                contact, direction = lines.sector.touch(lines.value(bound))
                # Where the line is nearly a tangent, both its crossings are within the error.
                is_one = high - low < SURE and direction.cross(start - contact).sign() == 0
                is_low = grows == (k == 0) if turns else other[1] < 2
                low, high = (-inf, -inf) if is_low else (inf, inf)
                if not (is_one and 0 < other[0] <= other[1] < 4):
                    low, high = -inf, inf
                found[k] = (low, high, rest[0], rest[1], rest[2])
        first, last = found
        rises, falls = first[1] < last[0], last[1] < first[0]
        if not ((rises if grows else falls) if turns else _spread(first, last) < 1):
            if turns and (rises or falls):
                image.divide(role, *_divided(first, last, grows, held_point(start)))
            first, last = ((-inf, inf, x, y, error) for _, _, x, y, error in found)
        image.move(role, (first, last))


def _spread(first: EdgePlace, last: EdgePlace) -> float:
    """How far two places on a full circle are apart at most, by their parameters."""
    return min(max(first[1], last[1]), 4.0) - max(min(first[0], last[0]), 0.0)


def _divided(first: EdgePlace, last: EdgePlace, grows: bool, start: Spot) -> tuple[EdgePlaces, EdgePlaces]:
    """What of a full circle is met before its *start* is passed, and after."""
    before, after = (inf, -inf) if grows else (-inf, inf)
    return (first, (before, before, *start)), ((after, after, *start), last)


def bounds(u: Real, rail: Rail | None) -> Span:
    """Bounds of a parameter; in extended numbers if it is that of an edge, with its *rail*."""
    if rail is not None and u is rail.top:
        return inf, inf
    if rail is not None and not u.is_late and u.rational is not None:
        if not u.rational:
            return -inf, -inf
        if u.rational == rail.top.rational:
            return inf, inf
    middle, error = float_ball(u)
    return middle - error, middle + error
