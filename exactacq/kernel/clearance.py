"""Which edges a segment, a ray or a whole line crosses, in floats with bounds (see `kernel.bounded`)."""

from __future__ import annotations

from typing import Final

from exactacq.kernel.bounded import (
    TINY,
    UNIT,
    cross,
    cross_sign,
    dot,
    dot_sign,
    product,
    quotient,
    root,
    total,
)
from exactacq.kernel.images import STRAIGHT, EdgeImage

Place = tuple[float, float, float]
"""A point, or a vector: two components that are held with one bound."""
SEGMENT: Final = 0
RAY: Final = 1
LINE: Final = 2


def crossed(images: list[EdgeImage], edges: list[int], start: Place, end: Place) -> list[int]:
    """For each of some edges 1 if a segment certainly crosses it between the ends of both, -1 if they
    certainly do not meet, else 0."""
    along = _offset(start, end)
    return [_verdict(images, e, start, end, along, SEGMENT) for e in edges]


def met(images: list[EdgeImage], edges: list[int], place: Place, along: Place) -> list[int]:
    """Those of some edges that a line through a place along a vector does not certainly miss."""
    return [e for e in edges if _verdict(images, e, place, place, along, LINE) >= 0]


def met_ahead(images: list[EdgeImage], edges: list[int], place: Place, along: Place) -> list[int]:
    """Those of some edges that the ray from a place along a vector does not certainly miss."""
    return [e for e in edges if _verdict(images, e, place, place, along, RAY) >= 0]


def _verdict(images: list[EdgeImage], e: int, start: Place, end: Place, along: Place, extent: int) -> int:
    """The verdict of `crossed` for an edge and a segment, or the ray or line along a vector."""
    if images[e].kind == STRAIGHT:
        return _straight(images, e, start, end, along, extent)
    return _round(images, e, start, along, extent)


def _straight(images: list[EdgeImage], e: int, start: Place, end: Place, along: Place, extent: int) -> int:
    """Of a straight edge: both its ends and both ends of the segment lie on different sides, or not."""
    vertex, following = _vertex(images, e), _vertex(images, images[e].following)
    one, other = _offset(start, vertex), _offset(start, following)
    first, last = _side(along, one), _side(along, other)
    if first and first == last:
        return -1
    if extent == RAY and _ahead(along, one) < 0 and _ahead(along, other) < 0:
        return -1
    if extent != SEGMENT:
        return 1 if extent == LINE and first and last else 0
    edge = _offset(vertex, following)
    near, far = _side(edge, _offset(vertex, start)), _side(edge, _offset(vertex, end))
    if near and near == far:
        return -1
    if first and last and near and far:
        return 1
    if _ahead(along, one) < 0 and _ahead(along, other) < 0:
        return -1
    is_beyond = _ahead(along, _offset(end, vertex)) > 0 and _ahead(along, _offset(end, following)) > 0
    return -1 if is_beyond else 0


def _round(images: list[EdgeImage], e: int, start: Place, along: Place, extent: int) -> int:
    """Of an arc: from p along d its circle is met at the (d . w -+ sqrt(|d|^2 r^2 - (d x w)^2)) / |d|^2-th
    parts of d, with w the way to the centre. A point of the circle is on the arc if it is on that side of the
    chord."""
    ox, oy, o = _offset(start, _held(images[e].cx, images[e].cy))
    dx, dy, d = along
    radius = images[e].radius
    square, square_bound = dot(dx, dy, d, dx, dy, d)
    h, h_bound = dot(ox, oy, o, dx, dy, d)
    g, g_bound = cross(dx, dy, d, ox, oy, o)
    size, size_bound = root(square, square_bound)
    reach, reach_bound = product(size, size_bound, radius, UNIT * radius)
    plus, plus_bound = total(reach, reach_bound, g, g_bound)
    minus, minus_bound = total(reach, reach_bound, -g, g_bound)
    under, under_bound = product(plus, plus_bound, minus, minus_bound)
    if -under > under_bound:
        return -1
    half, half_bound = root(under, under_bound)
    vertex = _vertex(images, e)
    chord = _offset(vertex, _vertex(images, images[e].following))
    found = -1
    for sign in (-1.0, 1.0):
        top, top_bound = total(h, h_bound, sign * half, half_bound)
        t, bound = quotient(top, top_bound, square, square_bound)
        if (extent != LINE and -t > bound) or (extent == SEGMENT and t - 1.0 > bound + UNIT):
            continue
        on = 1
        if not images[e].full:
            px, p = product(dx, d, t, bound)
            py, q = product(dy, d, t, bound)
            px, p = total(start[0], start[2], px, p)
            py, q = total(start[1], start[2], py, q)
            on = -images[e].kind * _side(chord, _offset(vertex, (px, py, max(p, q))))
        if on < 0:
            continue
        is_inside = extent == LINE or (t > bound and (extent == RAY or 1.0 - t > bound + UNIT))
        if on > 0 and is_inside and under > under_bound:
            return 1
        found = 0
    return found


def _vertex(images: list[EdgeImage], v: int) -> Place:
    return _held(images[v].x, images[v].y)


def _held(x: float, y: float) -> Place:
    """A point of the scene, each of whose coordinates is the nearest float."""
    return x, y, UNIT * max(abs(x), abs(y)) + TINY


def _offset(a: Place, b: Place) -> Place:
    """The vector from a point to another."""
    x, p = total(b[0], b[2], -a[0], a[2])
    y, q = total(b[1], b[2], -a[1], a[2])
    return x, y, max(p, q)


def _side(a: Place, b: Place) -> int:
    """1 or -1 if a vector certainly lies to the left or right of another, else 0."""
    return cross_sign(a[0], a[1], a[2], b[0], b[1], b[2])


def _ahead(a: Place, b: Place) -> int:
    """1 or -1 if a vector certainly points with or against another, else 0."""
    return dot_sign(a[0], a[1], a[2], b[0], b[1], b[2])
