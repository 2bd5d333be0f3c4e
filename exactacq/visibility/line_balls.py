"""Where lines meet curves, in balls: enclosures of what `chords.meet` gives exactly.

An exact place costs many times what its ball does, and most places are never asked for more than their
order along an edge. All arithmetic is that of `flint.arb`, which bounds its own errors.

Some lines of a sweep are closer than floats can tell, and the cells between them narrower: drawings whose
coordinates are rounded, and those whose thick lines became walls, have many. The order of such lines, and
which edges a line in such a cell meets first, is asked of longer balls (`event_ball`, `first_meetings`):
exact numbers take about ten times as long.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import TypeAlias

from flint import arb, fmpq

from exactacq.geometry.coordinates import Vector, minus, raw
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.late import BITS, Balls, ball_of
from exactacq.geometry.points import Point
from exactacq.kernel.bound_lines import NOTHING
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.visibility.line_families import Rolling, Sector, Sliding, Spokes, Turning

Line: TypeAlias = "tuple[arb, arb, arb, arb]"
"""Contact and direction."""
Meeting: TypeAlias = "tuple[arb, int]"
"""How far ahead a line meets an edge, and 1 if it enters the obstacle there, going ahead, -1 if it leaves."""
FirstMeeting: TypeAlias = "tuple[arb, int, int]"
"""How far ahead a line meets an edge, the sense in which it enters the obstacle there, and the edge."""
Sighted: TypeAlias = "tuple[arb, arb, arb, int]"
"""The vector from a line's contact to a place, its product with the line's direction, and that one's sign."""
LONG = 256
"""Working bits of long balls."""


def line(sector: Sector, t: arb, longer: Line | None = None) -> Line:
    """The line of a sector at a parameter, as `Sector.touch` gives it.

    It is as exact as the balls around the sector's centre and base, for which *longer* ones may be given.
    """
    cx, cy, ex, ey = sector.balls if longer is None else longer
    if type(sector) is Turning:
        # Of this kind are most.
        return cx, cy, ex - t * ey, ey + t * ex
    if type(sector) is Sliding:
        dx, dy = (-ey, ex) if sector.leftward else (ey, -ex)
        return cx + ex * t, cy + ey * t, dx, dy
    if type(sector) is Rolling:
        square = t * t
        growth = 1 + square
        cosine, sine = (1 - square) / growth, 2 * t / growth
        vx, vy = cosine * ex - sine * ey, cosine * ey + sine * ex
        return cx + vx, cy + vy, -vy, vx
    assert isinstance(sector, Spokes), "there are four kinds of sectors"
    dx, dy = ex - t * ey, ey + t * ex
    away = (ball_of(sector.radius_sq) / (dx * dx + dy * dy)).sqrt()
    x, y = cx + dx * away, cy + dy * away
    return (x, y, dx, dy) if sector.outward else (x, y, -dx, -dy)


def through(sector: Sector, point: Balls) -> list[arb] | None:
    """The parameters of the lines through a point, as `Sector.through` has them; None if that is open."""
    (x, y), (cx, cy, ex, ey) = point, sector.balls
    ox, oy, size = x - cx, y - cy, ex * ex + ey * ey
    along, across = ex * ox + ey * oy, ex * oy - ey * ox
    if isinstance(sector, Sliding):
        return [along / size]
    if not isinstance(sector, Rolling):
        return [across / along] if ball_sign(along) else None
    square, below = along * along + across * across - size * size, size + along
    if not (square > 0 and ball_sign(below)):
        return None
    root = square.sqrt()
    return [(across + root) / below, (across - root) / below]


class CurveBalls:
    """The image of a curve in balls."""

    __slots__ = ("_center", "_curve", "_radius_sq", "_start", "_way")

    def __init__(self, curve: Curve, bits: int = BITS) -> None:
        """*bits* is the working precision of the balls, `LONG` at most where that is set."""
        self._curve = curve
        start, end = raw(curve.start), raw(curve.end)
        self._start = curve.start.x.ball(bits), curve.start.y.ball(bits)
        if isinstance(curve, Segment):
            x, y = minus(end, start)
            self._way = ball_of(x), ball_of(y)
        else:
            self._center = curve.center.x.ball(bits), curve.center.y.ball(bits)
            self._radius_sq = ball_of(curve.radius_sq)

    def met(self, at: Line, role: int) -> tuple[arb, Balls] | None:
        """How far along a line enters the obstacle, ahead (1) or back (-1), and where on the curve.

        None if no ball holds it: the line may run along the curve.
        """
        x, y, dx, dy = at
        if isinstance(self._curve, Segment):
            (sx, sy), (wx, wy) = self._start, self._way
            under = wx * dy - wy * dx
            ox, oy = x - sx, y - sy
            u, tau = (ox * dy - oy * dx) / under, (ox * wy - oy * wx) / under
            return (tau, (sx + wx * u, sy + wy * u)) if u.is_finite() else None
        cx, cy = self._center
        ox, oy, size = cx - x, cy - y, dx * dx + dy * dy
        across = ox * dy - oy * dx
        root = (size * self._radius_sq - across * across).nonnegative_part().sqrt()
        far = -role if self._curve.ccw else role
        tau = (ox * dx + oy * dy + far * root) / size
        return (tau, (x + dx * tau, y + dy * tau)) if tau.is_finite() else None


# -- by long balls -----------------------------------------------------------------------------------


def event_ball(sector: Sector, at: Line, circle: tuple[Vector, fmpq], side: int, sign: int) -> arb | None:
    """The parameter of a line that there is (see `Sector.exact`), as exact as the working precision.

    *at* are the sector's centre and base in such balls. None if no ball holds the parameter, as near a
    tangent that is both of the two that there are.
    """
    ((x, y), radius_sq), (cx, cy, ex, ey) = circle, at
    ox, oy, size = arb(x) - cx, arb(y) - cy, ex * ex + ey * ey
    along, across = ex * ox + ey * oy, ex * oy - ey * ox
    if isinstance(sector, Sliding):
        found = (along + sign * (size * arb(radius_sq)).sqrt()) / size if side else along / size
    elif isinstance(sector, Rolling):
        k = size + side * (size * arb(radius_sq)).sqrt()
        found = (across + sign * (size * (ox * ox + oy * oy) - k * k).sqrt()) / (k + along)
    elif side == 0:
        found = across / along
    else:
        reach, radius = (ox * ox + oy * oy - arb(radius_sq)).sqrt(), sign * arb(radius_sq).sqrt()
        found = (reach * across + radius * along) / (reach * along - radius * across)
    return found if found.is_finite() else None


def long_vector(vector: Vector) -> Balls:
    """Long balls around exact components."""
    with workprec(LONG):
        x, y = (c if isinstance(c, Real) else arb(c) for c in vector)
    return x.ball(LONG) if isinstance(x, Real) else x, y.ball(LONG) if isinstance(y, Real) else y


def clear_turn(a: Balls, b: Balls) -> int:
    """1 or -1 as b comes after a or before it, counterclockwise from the east; 0 if long balls leave that
    open."""
    (ax, ay), (bx, by) = a, b
    upper, other = ball_sign(ay), ball_sign(by)
    if not (upper and other):
        return 0
    if upper != other:
        return upper
    with workprec(LONG):
        return ball_sign(ax * by - ay * bx)


def long_frame(sector: Sector) -> Line:
    """The centre and the base of a sector in long balls; the caller must have set the precision to `LONG`."""
    return _held(Point(*sector.center)) + _held(Point(*sector.base))


def entered(first: dict[int, FirstMeeting]) -> tuple[int, int]:
    """At which of the edges that it meets first, behind its contact and ahead, a line enters an obstacle.

    `NOTHING` if there is none, or if it is met from its blocked side.
    """
    (_, back, behind), (_, forth, ahead) = (first.get(side, (None, side, NOTHING)) for side in (-1, 1))
    return behind if back < 0 else NOTHING, ahead if forth > 0 else NOTHING


def first_meetings(
    table: EdgeTable, sector: Sector, t: fmpq | Real, edges: Iterable[int], own: Collection[int] = ()
) -> tuple[dict[int, FirstMeeting], list[int]]:
    """The edge that a line meets first on each side, 1 ahead of its contact and -1 behind, if there is one.

    And a list of the edges of which balls leave open whether they are met nearer. The contact lies on the
    edges *own*, along which the line does not run; there it does not meet them.
    """
    nearest: dict[int, FirstMeeting] = {}
    left: list[int] = []
    curves, following = table.curves, table.following
    # Two edges meet at a vertex, which is looked at once.
    sighted: dict[int, Sighted] = {}
    with workprec(LONG):
        at = line(sector, t.working_ball(LONG) if isinstance(t, Real) else arb(t), long_frame(sector))
        for e in edges:
            curve = curves[e]
            met: list[Meeting] | None = []
            if isinstance(curve, Arc):
                met = _met_round(at, curve, e in own, nearest)
            elif e not in own:
                for v in (e, following[e]):
                    if v not in sighted:
                        sighted[v] = _sighted(at, _held(curves[v].start))
                met = _between(sighted[e], sighted[following[e]])
            if met is None:
                left.append(e)
                continue
            for tau, sense in met:
                side = ball_sign(tau)
                best = nearest.get(side)
                nearer = 1 if best is None else ball_sign(best[0] - tau) * side
                if side == 0 or nearer == 0:
                    left.append(e)
                elif nearer > 0:
                    nearest[side] = tau, sense, e
        return nearest, [e for e in left if not _is_beyond(_span(at, curves[e]), nearest)]


def _span(at: Line, curve: Curve) -> tuple[arb, arb]:
    """Between which places along a line a curve lies, as multiples of the line's direction."""
    x, y, dx, dy = at
    size = dx * dx + dy * dy
    if isinstance(curve, Segment):
        (ax, ay), (bx, by) = _held(curve.start), _held(curve.end)
        return ((ax - x) * dx + (ay - y) * dy) / size, ((bx - x) * dx + (by - y) * dy) / size
    cx, cy = _held(curve.center)
    middle, half = ((cx - x) * dx + (cy - y) * dy) / size, (arb(curve.radius_sq) / size).sqrt()
    return middle - half, middle + half


def _is_beyond(places: Iterable[arb], nearest: dict[int, FirstMeeting]) -> bool:
    """Whether all of some places along a line surely are farther on one side than what is met first there."""
    return any(all(ball_sign(p - tau) == side for p in places) for side, (tau, *_) in nearest.items())


def _met_round(at: Line, curve: Arc, is_own: bool, nearest: dict[int, FirstMeeting]) -> list[Meeting] | None:
    """Where a line crosses an arc, inside it, nearer than another edge; None if balls leave that open."""
    x, y, dx, dy = at
    cx, cy = _held(curve.center)
    ox, oy, size = cx - x, cy - y, dx * dx + dy * dy
    along, across = ox * dx + oy * dy, ox * dy - oy * dx
    if is_own:
        # The contact is on the circle, which the line meets once more.
        roots = [(2 * along / size, ball_sign(along))]
    else:
        square = size * arb(curve.radius_sq) - across * across
        if not ball_sign(square):
            return None
        if square < 0:
            return []
        root = square.sqrt()
        roots = [((along - root) / size, -1), ((along + root) / size, 1)]
        if nearest and _is_beyond([tau for tau, _ in roots], nearest):
            return []
    found: list[Meeting] = []
    for tau, side in roots:
        # A convex arc lies to the right of its chord.
        beside = -1 if curve.full else _beside_chord(curve, x + dx * tau, y + dy * tau)
        if not (side and beside):
            return None
        if curve.full or (beside < 0) == curve.ccw:
            # At the nearer crossing the disc is entered. A clockwise arc has its obstacle outside.
            found.append((tau, -side if curve.ccw else side))
    return found


def _beside_chord(arc: Arc, x: arb, y: arb) -> int:
    """1 or -1 as a place is left or right of the chord from an arc's start to its end, 0 if that is open."""
    (ax, ay), (bx, by) = _held(arc.start), _held(arc.end)
    return ball_sign((bx - ax) * (y - ay) - (by - ay) * (x - ax))


def crossing(at: Line, start: Balls, end: Balls) -> list[Meeting] | None:
    """Where a line crosses a segment, between its ends; None if balls leave open whether it does.

    It enters where it passes from the right of the segment to its left, the side of the obstacle of an edge.
    """
    return _between(_sighted(at, start), _sighted(at, end))


def _sighted(at: Line, place: Balls) -> Sighted:
    """A place as seen from the contact of a line."""
    x, y, dx, dy = at
    ax, ay = place[0] - x, place[1] - y
    height = ax * dy - ay * dx
    return ax, ay, height, ball_sign(height)


def _between(start: Sighted, end: Sighted) -> list[Meeting] | None:
    """Where a line crosses a segment whose ends are seen so from its contact; None if that is open."""
    (ax, ay, first, before), (bx, by, last, after) = start, end
    if not (before and after):
        return None
    return [] if before == after else [((ay * bx - ax * by) / (last - first), after)]


def _held(point: Point) -> Balls:
    """Long balls around the coordinates of a point."""
    return point.x.working_ball(LONG), point.y.working_ball(LONG)
