"""Makes the float images of the line families of a scene (see `exactacq.kernel.family_images`)."""

from __future__ import annotations

from functools import cached_property
from math import inf

from exactacq import kernel
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.kernel import lines
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.extents import SURE, Span
from exactacq.kernel.family_images import NONE, EdgePlace, FamilyImage, locate
from exactacq.numbers.rationals import nearest_float
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.line_points import Role, Side
from exactacq.visibility.line_families import Sector, Spokes, Turning
from exactacq.visibility.rotational_sweep import Passed
from exactacq.visibility.sensor_range import Range


class LineImages:
    """The curves of a scene in floats, and the images of line families that are made from them."""

    def __init__(self, table: EdgeTable, range_: Range) -> None:
        self.table = table
        self.reach = range_.below, range_.above

    @cached_property
    def curves(self) -> list[CurveImage]:
        """The edges."""
        return [curve_image(curve) for curve in self.table.curves]

    def of(
        self,
        sector: Sector,
        ends: tuple[Real, Real],
        passed: tuple[Passed, Passed],
        sides: tuple[Side | None, Side, Side | None],
        goes_back: bool,
        keys: tuple[list[int], list[int]],
    ) -> FamilyImage:
        """The image of the lines of a sector between two; *sides* lie behind, at the contact and ahead."""
        edges = [NONE if side is None else side.edge for side in sides]
        contact = sides[1]
        turns = isinstance(sector, Turning) and not isinstance(sector, Spokes)
        corners = tuple([number for number, touching, _ in some if not touching] for some in passed)
        image = FamilyImage(
            sector.image,
            (*float_ball(ends[0]), *float_ball(ends[1])),
            (edges[0], edges[1], edges[2]),
            contact.fixed,
            goes_back,
            contact.edge if turns else NONE,
            (corners[0], corners[1]),
            keys,
        )
        if kernel.EXACT_ONLY:
            return image
        locate(image, self.curves, self.table.images.following)
        for role, side in zip(Role, sides, strict=True):
            if image.is_known and side is not None and self.table.full[side.edge]:
                self._unroll(image, role, sector, ends, side)
        return image

    def _unroll(
        self, image: FamilyImage, role: Role, sector: Sector, ends: tuple[Real, Real], side: Side
    ) -> None:
        """Two places on a full circle: known if the side does not pass its start, where parameters jump.

        While lines turn by a quarter at most, a contact moves by a quarter, another place by less than three
        quarters, for its direction from the circle's centre is off the line's by less than a quarter.
        """
        start = self.table.curves[side.edge].start
        found: list[EdgePlace] = list(image.places(role))
        for k in (0, 1):
            (low, high, *rest), other = found[k], found[1 - k]
            if low <= 0 or high >= 4:
                contact, direction = sector.touch(ends[k])
                # Where the line is nearly a tangent, both its crossings are within the error.
                is_one = high - low < SURE and direction.cross(start - contact).sign() == 0
                if not (is_one and 0 < other[0] <= other[1] < 4):
                    image.is_known = False
                    return
                end = -inf if other[1] < 2 else inf
                found[k] = (end, end, rest[0], rest[1], rest[2])
        bounds = [(max(low, 0.0), min(high, 4.0)) for low, high, *_ in found]
        image.is_known = max(b for _, b in bounds) - min(a for a, _ in bounds) < 1
        image.move(role, (found[0], found[1]))


def curve_image(curve: Curve) -> CurveImage:
    """A boundary edge or a straight way in floats."""
    if isinstance(curve, Segment):
        return CurveImage(*_pair(curve.start), *_pair(curve.end - curve.start), 0.0, 0, False)
    radius = nearest_float(curve.radius_sq) ** 0.5
    sense = 1 if curve.ccw else -1
    return CurveImage(*_pair(curve.center), *_pair(curve.start - curve.center), radius, sense, curve.full)


def _pair(point: Point) -> tuple[float, float]:
    """The coordinates in floats (see `rough`)."""
    return rough(point.x), rough(point.y)


def rough(value: Real) -> float:
    """A float that is off by at most `lines.EPS` times a number, or times `lines.TINY` if that is more."""
    if not value.is_late and value.rational is not None:
        return nearest_float(value.rational)
    bits = 64
    while True:
        ball = value.ball(bits)
        middle = nearest_float(ball.mid().fmpq())
        if float(ball.rad()) <= 2.0**-55 * max(abs(middle), lines.TINY):
            return middle
        bits *= 2


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


def float_ball(t: Real) -> tuple[float, float]:
    """A float near a parameter, with a bound of its error: of a late one what its ball tells."""
    if t.is_late or t.rational is None:
        bits = 64
        ball = t.ball(bits)
        while not t.is_late and ball.rad() > 2.0**-52 * max(abs(float(ball.mid())), 1.0):
            bits *= 2
            ball = t.ball(bits)
        middle = float(ball.mid())
        return middle, 2.0 * float(ball.rad()) + lines.EPS * abs(middle) + lines.TINY
    middle = nearest_float(t.rational)
    return middle, lines.EPS * abs(middle)
