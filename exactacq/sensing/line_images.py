"""Line families in floats: what their first and last lines meet, with proven bounds of the error.

Parameters along an edge are bounded in extended numbers: its start, where a line is known to pass it, is
minus infinity and its end infinity, so that nothing is to be compared with them.
"""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable
from dataclasses import dataclass
from math import hypot, inf, sqrt
from typing import Any, NamedTuple, TypeAlias

from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.kernel import lines
from exactacq.numbers.rationals import nearest_float
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.line_points import Role, Side
from exactacq.visibility.line_families import Rolling, Sector, Sliding
from exactacq.visibility.rotational_sweep import Passed
from exactacq.visibility.sensor_range import Range

SURE = 1e-9
"""Relative margin of distances; round-off is far below."""

Span: TypeAlias = "tuple[float, float]"
"""Bounds of a parameter, or of an interval of parameters."""
EndNames: TypeAlias = "tuple[Collection[Hashable], Collection[Hashable]]"
"""Names of the first and of the last line of a family."""
NOTHING: Span = (inf, -inf)
EVERYTHING: Span = (-inf, inf)


class EdgePlace(NamedTuple):
    """Where a line meets an edge: bounds of the parameter, the point, and the error of its coordinates."""

    low: float
    high: float
    x: float
    y: float
    error: float


Places: TypeAlias = "tuple[EdgePlace, EdgePlace]"
"""Where the first and the last line of a family meet an edge."""


class Extent(NamedTuple):
    """What a family shows of an edge, at most, and where it is seen from: at most and at least.

    *names* tell what the lines from both ends of that are called: equal names, one place of an edge.
    """

    edge: int
    shown: Span
    source: Span
    surely: Span
    names: tuple[Collection[Hashable], Collection[Hashable]] = ((), ())


@dataclass(slots=True)
class Image:
    """A line family in floats: its first and last line, and where these meet its edges, by role."""

    frame: lines.Frame
    parameters: tuple[float, float]
    first: lines.Line
    last: lines.Line
    spots: dict[Role, Places]


class LineImages:
    """Makes the images of line families, and tells what views between their edges show."""

    def __init__(self, table: EdgeTable, range_: Range) -> None:
        self.table, self.range = table, range_
        self._curves: dict[int, lines.Straight | lines.Round] = {}

    def of(
        self, sector: Sector, ends: tuple[Real, Real], passed: tuple[Passed, Passed], sides: Iterable[Side]
    ) -> Image | None:
        """The image of the lines of a sector between two; None if floats cannot tell what they meet."""
        frame = sector.image
        low, high = (float_ball(t) for t in ends)
        first, last = lines.line_at(frame, *low), lines.line_at(frame, *high)
        spots: dict[Role, Places] = {}
        for side in sides:
            found = []
            for line, t, events in zip((first, last), ends, passed, strict=True):
                spot = self._spot(sector, side, line, t, events)
                if spot is None:
                    return None
                found.append(spot)
            if self.table.full[side.edge]:
                found = self._on_circle(sector, ends, side, found)
                if not found:
                    return None
            spots[side.role] = found[0], found[1]
        return Image(frame, (low[0], high[0]), first, last, spots)

    def _on_circle(
        self, sector: Sector, ends: tuple[Real, Real], side: Side, places: list[EdgePlace]
    ) -> list[EdgePlace]:
        """Two places on a full circle if the side does not pass its start, where parameters jump, else none.

        While lines turn by a quarter at most, a contact moves by a quarter, another place by less than three
        quarters, for its direction from the circle's centre is off the line's by less than a quarter.
        """
        start = self.table.curves[side.edge].start
        for k, (a, b) in enumerate((places, places[::-1])):
            if a.low <= 0 or a.high >= 4:
                contact, direction = sector.touch(ends[k])
                # Where the line is nearly a tangent, both its crossings are within the error.
                is_one = a.high - a.low < SURE and direction.cross(start - contact).sign() == 0
                if not (is_one and 0 < b.low <= b.high < 4):
                    return []
                at_zero = b.high < 2
                places[k] = a._replace(low=-inf, high=-inf) if at_zero else a._replace(low=inf, high=inf)
        bounds = [(max(p.low, 0.0), min(p.high, 4.0)) for p in places]
        apart = max(b for _, b in bounds) - min(a for a, _ in bounds)
        return places if apart < 1 else []

    def seen(self, sector: Sector, image: Image, side: Side, other: Side, names: EndNames) -> Extent:
        """What views along the lines of an image show of edge *other* from *side*; two lines are named."""
        a, b = image.spots[side.role], image.spots[other.role]
        slack = self.slack(sector, side, a) + self.slack(sector, other, b)
        if isinstance(self.table.curves[side.edge], Arc):
            # A line may meet an arc twice.
            names = (), ()
        return sight(self.range, other.edge, a, b, slack, names)

    def slack(self, sector: Sector, side: Side, spots: Places) -> float:
        """How far a side may leave the box of its two extreme points."""
        p, q = spots
        error = 2 * (p.error + q.error)
        if side.fixed:
            return error
        return error + _bend(sector, self.table.curves[side.edge], hypot(p.x - q.x, p.y - q.y))

    def curve(self, e: int) -> lines.Straight | lines.Round:
        """An edge in floats."""
        if e not in self._curves:
            self._curves[e] = curve_image(self.table.curves[e])
        return self._curves[e]

    def _spot(
        self, sector: Sector, side: Side, line: lines.Line, t: Real, passed: Passed
    ) -> EdgePlace | None:
        curve = self.curve(side.edge)
        x, y, _, _, error, _ = line
        if side.role is Role.CONTACT:
            if side.fixed:
                return EdgePlace(-inf, -inf, x, y, error)
            if isinstance(sector, Sliding):
                return EdgePlace(*_fraction(t), x, y, error)
            assert len(curve) == 6, "tangents and normals of arcs touch an arc"
            u, ue = lines.parameter_round(curve, x, y, error)
            return EdgePlace(u - ue, u + ue, x, y, error)
        end = self._corner(side.edge, passed) if len(curve) == 4 else 0.0
        _, fe, u, ue, x, y, error = lines.meets(line, curve, int(side.role))
        if fe == inf or ue == inf:
            return None
        return EdgePlace(end or u - ue, end or u + ue, x, y, error)

    def _corner(self, edge: int, passed: Passed) -> float:
        """Which end of a segment a line passes: minus infinity, infinity, or 0 if none is known."""
        for number, touching, _ in passed:
            if not touching:
                if number == edge:
                    return -inf
                if number == self.table.next[edge]:
                    return inf
        return 0.0


def sight(
    range_: Range,
    edge: int,
    source: Places,
    shown: Places,
    slack: float,
    names: EndNames,
) -> Extent:
    """What is shown of an edge, and from where, by two extreme views whose lines are named.

    *slack* is what sides may bend aside.
    """
    verdict = within(range_, source, shown, slack)
    if verdict is False:
        return Extent(edge, NOTHING, NOTHING, NOTHING)
    if not verdict:
        return Extent(edge, _hull(*shown), _hull(*source), NOTHING)
    surely = _core(*source)
    return Extent(
        edge, _hull(*shown), _hull(*source), surely, names if source[0].high <= source[1].low else names[::-1]
    )


def within(range_: Range, one: Places, other: Places, slack: float) -> bool | None:
    """Whether two sides are within range of each other all over, or nowhere (False); None if that is open."""
    (a, b), (c, d) = one, other
    longest = max(hypot(p.x - q.x, p.y - q.y) for p in one for q in other)
    if (longest + slack) * (1 + SURE) < range_.below:
        return True
    gap_x = max(min(a.x, b.x) - max(c.x, d.x), min(c.x, d.x) - max(a.x, b.x), 0.0)
    gap_y = max(min(a.y, b.y) - max(c.y, d.y), min(c.y, d.y) - max(a.y, b.y), 0.0)
    return False if hypot(gap_x, gap_y) - slack > range_.above * (1 + SURE) else None


def _bend(sector: Sector, curve: Curve, chord: float) -> float:
    """How far a side bends away from its chord at most (no side of turning lines passes a half turn)."""
    if isinstance(curve, Segment):
        return 0.0
    radius = sqrt(nearest_float(curve.radius_sq)) * (1 + SURE)
    if isinstance(sector, Rolling | Sliding):
        return 2 * radius
    return min(chord**2 / (4 * radius) * (1 + SURE) * 2, radius)


def curve_image(curve: Curve) -> lines.Straight | lines.Round:
    """A boundary edge in floats."""
    if isinstance(curve, Segment):
        x, y = _pair(curve.start.rational)
        dx, dy = _pair(curve.direction.rational)
        return x, y, dx, dy
    ax, ay = _pair(curve.center.rational)
    bx, by = _pair((curve.start - curve.center).rational)
    return ax, ay, sqrt(nearest_float(curve.radius_sq)), bx, by, 1 if curve.ccw else -1


def _pair(values: Any) -> tuple[float, float]:
    x, y = values
    return nearest_float(x), nearest_float(y)


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


def _fraction(t: Real) -> Span:
    """Bounds of a place on a segment."""
    if not t.is_late and t.rational in (0, 1):
        return (inf, inf) if t.rational else (-inf, -inf)
    u, error = float_ball(t)
    return u - error, u + error


def float_ball(t: Real) -> tuple[float, float]:
    """A float near a number, with a bound of its error."""
    if not t.is_late and t.rational is not None:
        middle = nearest_float(t.rational)
        return middle, lines.EPS * abs(middle)
    ball = t.ball(64)
    middle = float(ball.mid())
    return middle, 2.0 * float(ball.rad()) + lines.EPS * abs(middle) + lines.TINY


def _hull(a: EdgePlace, b: EdgePlace) -> Span:
    return min(a.low, b.low), max(a.high, b.high)


def _core(a: EdgePlace, b: EdgePlace) -> Span:
    """What certainly lies between two spots."""
    if a.high <= b.low:
        return a.high, b.low
    return (b.high, a.low) if b.high <= a.low else NOTHING
