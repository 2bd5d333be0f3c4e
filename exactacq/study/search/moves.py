"""Small random changes of drafts. All numbers stay rational, and short: steps are rounded to few digits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import floor, log10
from random import Random

from flint import fmpq

from exactacq.numbers.rationals import nearest_float
from exactacq.scene.shapes import Circle, Polygon, Shape
from exactacq.study.search.drafts import Draft, Seat, corners, is_convex, rebuilt

WIDEST, FINEST = 0.3, 0.0005
"""The lengths of steps, as shares of the draft's extent; every size between is equally likely."""


@dataclass(frozen=True)
class Rules:
    """What a search keeps to: numbers of obstacles, edges and strips, seats for starts, convex obstacles."""

    obstacles: int = 4
    edges: int = 40
    strips: int = 40
    seated: bool = False
    convex: bool = False
    least: int = 1

    def allow(self, draft: Draft) -> bool:
        """Whether a draft keeps to the rules."""
        return (
            self.least <= len(draft.shapes) <= self.obstacles
            and draft.edges <= self.edges
            and (draft.size is None or draft.size[0] <= self.strips * draft.radius)
            and (not self.seated or draft.seat is not None)
            and (not self.convex or all(is_convex(shape) for shape in draft.shapes))
        )


def mutate(draft: Draft, rng: Random, rules: Rules) -> Draft:
    """A neighbour of a draft that keeps to the rules, one to three moves away; maybe no valid scene."""
    while True:
        found: Draft | None = draft
        for _ in range(1 + int(rng.random() < 0.4) + int(rng.random() < 0.2)):
            move = MOVES[int(rng.random() * len(MOVES))]
            found = found and move(found, rng)
        if found is not None and found != draft and rules.allow(found):
            return found


def rounded(value: fmpq | float, digits: int) -> fmpq:
    """The nearest multiple of 10^-digits; digits may be negative."""
    unit = fmpq(10) ** digits
    exact = fmpq(*value.as_integer_ratio()) if isinstance(value, float) else value
    return fmpq((exact * unit + fmpq(1, 2)).floor()) / unit


def _step(draft: Draft, rng: Random) -> fmpq:
    """A step of either sign, with two significant digits."""
    size = draft.extent * WIDEST * (FINEST / WIDEST) ** rng.random()
    step = rounded(size, 1 - floor(log10(size)))
    return step if rng.random() < 0.5 else -step


def _shift(draft: Draft, rng: Random) -> tuple[fmpq, fmpq]:
    """A step along an axis, or in both coordinates."""
    kind, zero = int(rng.random() * 4), fmpq(0)
    dx = zero if kind == 0 else _step(draft, rng)
    dy = zero if kind == 1 else _step(draft, rng)
    return dx, dy


def _any(draft: Draft, rng: Random) -> int:
    return int(rng.random() * len(draft.shapes))


def _move_vertex(draft: Draft, rng: Random) -> Draft | None:
    """Move a vertex, or change an edge's bulge, or a circle's radius."""
    if not draft.shapes:
        return None
    k = _any(draft, rng)
    shape = draft.shapes[k]
    if isinstance(shape, Circle):
        size = shape.radius + _step(draft, rng)
        return draft.replaced(k, Circle(shape.center, size, shape.name)) if size > 0 else None
    i = int(rng.random() * len(shape.vertices))
    x, y, bulge = shape.vertices[i]
    if bulge and rng.random() < 0.3:
        changed = x, y, rounded(nearest_float(bulge) * (0.5 + rng.random()), 2)
    else:
        dx, dy = _shift(draft, rng)
        changed = x + dx, y + dy, bulge
    return draft.replaced(k, rebuilt(shape, (*shape.vertices[:i], changed, *shape.vertices[i + 1 :])))


def _move_level(draft: Draft, rng: Random) -> Draft | None:
    """Move all vertices of an obstacle with one abscissa, or one ordinate, together: edges stay upright."""
    if not draft.shapes:
        return None
    k = _any(draft, rng)
    axis = int(rng.random() * 2)
    places = corners(draft.shapes[k])
    level = places[int(rng.random() * len(places))][axis]
    step = _step(draft, rng)

    def change(shape: int, kind: str, value: fmpq) -> fmpq:
        return value + step if shape == k and kind == "xy"[axis] and value == level else value

    return draft.mapped(change)


def _move_obstacle(draft: Draft, rng: Random) -> Draft | None:
    if not draft.shapes:
        return None
    k = _any(draft, rng)
    return draft.replaced(k, _translated(draft.shapes[k], *_shift(draft, rng)))


def _scale_obstacle(draft: Draft, rng: Random) -> Draft | None:
    """Stretch an obstacle about a vertex, along one axis or both; circles about the centre."""
    if not draft.shapes:
        return None
    k = _any(draft, rng)
    shape = draft.shapes[k]
    factor = rounded(2 ** (2 * rng.random() - 1), 2)
    if isinstance(shape, Circle):
        return draft.replaced(k, Circle(shape.center, shape.radius * factor, shape.name))
    kind = int(rng.random() * 3) if not any(v[2] for v in shape.vertices) else 2
    across, along = fmpq(1) if kind == 0 else factor, fmpq(1) if kind == 1 else factor
    a, b, _ = shape.vertices[int(rng.random() * len(shape.vertices))]
    vertices = tuple((a + (x - a) * across, b + (y - b) * along, v) for x, y, v in shape.vertices)
    return draft.replaced(k, rebuilt(shape, vertices))


def _part(draft: Draft, rng: Random) -> Draft | None:
    """Move everything beyond a vertical or horizontal line: what lies across it is stretched."""
    places = [p for shape in draft.shapes for p in corners(shape)]
    if not places:
        return None
    axis = int(rng.random() * 2)
    level, step = places[int(rng.random() * len(places))][axis], _step(draft, rng)
    kinds = ("xy"[axis], ("width", "height")[axis])

    def change(_: int, kind: str, value: fmpq) -> fmpq:
        return value + step if kind in kinds and value >= level else value

    return draft.mapped(change)


def _remove_obstacle(draft: Draft, rng: Random) -> Draft | None:
    return draft.without(_any(draft, rng)) if len(draft.shapes) > 1 else None


def _add_obstacle(draft: Draft, rng: Random) -> Draft | None:
    """A small new obstacle, or a copy of one beside it."""
    if draft.shapes and rng.random() < 0.5:
        copy = _translated(draft.shapes[_any(draft, rng)], *_shift(draft, rng))
        return replace(draft, shapes=(*draft.shapes, copy))
    places = [p for shape in draft.shapes for p in corners(shape)] or [(fmpq(1), fmpq(1))]
    x, y = places[int(rng.random() * len(places))]
    dx, dy = _shift(draft, rng)
    x, y = x + dx, y + dy
    wide, high = abs(_step(draft, rng)), abs(_step(draft, rng))
    kind = int(rng.random() * 3)
    new: Shape
    if kind == 0:
        new = Circle((x, y), wide)
    else:
        ring = [(x, y), (x + wide, y), (x + wide, y + high), (x, y + high)]
        new = Polygon(ring[: 5 - kind])
    return replace(draft, shapes=(*draft.shapes, new))


def _remove_vertex(draft: Draft, rng: Random) -> Draft | None:
    if not draft.shapes:
        return None
    k = _any(draft, rng)
    return without_vertex(draft, k, int(rng.random() * 64))


def without_vertex(draft: Draft, k: int, i: int) -> Draft | None:
    """Without a vertex (counted around) of a loop of more than three; None for others."""
    shape = draft.shapes[k]
    if isinstance(shape, Circle) or len(shape.vertices) <= 3:
        return None
    i %= len(shape.vertices)
    draft = replace(draft, seat=_reseated(draft.seat, k, i, len(shape.vertices)))
    return draft.replaced(k, rebuilt(shape, shape.vertices[:i] + shape.vertices[i + 1 :]))


def _reseated(seat: Seat | None, k: int, i: int, count: int) -> Seat | None:
    """A seat that keeps to its vertex or edge where vertex *i* of *count* is taken from obstacle *k*."""
    if seat is None or seat.obstacle != k or seat.edge < i:
        return seat
    if seat.edge == i:
        return Seat(k, i % (count - 1), fmpq(0))
    return seat._replace(edge=seat.edge - 1)


def _split_edge(draft: Draft, rng: Random) -> Draft | None:
    """A new vertex near the middle of a straight edge, off it by a step."""
    if not draft.shapes:
        return None
    k = _any(draft, rng)
    shape = draft.shapes[k]
    if isinstance(shape, Circle):
        return None
    i = int(rng.random() * len(shape.vertices))
    (x, y, bulge), (u, v, _) = shape.vertices[i], shape.vertices[(i + 1) % len(shape.vertices)]
    if bulge:
        return None
    dx, dy = _shift(draft, rng)
    new = (x + u) / 2 + dx, (y + v) / 2 + dy, fmpq(0)
    seat = draft.seat
    if seat is not None and seat.obstacle == k and seat.edge > i:
        draft = replace(draft, seat=seat._replace(edge=seat.edge + 1))
    return draft.replaced(k, rebuilt(shape, (*shape.vertices[: i + 1], new, *shape.vertices[i + 1 :])))


def _change_frame(draft: Draft, rng: Random) -> Draft | None:
    """Another radius, or a terrain of another width or height."""
    step = _step(draft, rng)
    kind = int(rng.random() * 3) if draft.size is not None else 0
    if draft.size is None or kind == 0:
        return replace(draft, radius=draft.radius + step) if draft.radius + step > 0 else None
    width, height = draft.size
    size = (width + step, height) if kind == 1 else (width, height + step)
    return replace(draft, size=size) if min(size) > 0 else None


def _change_start(draft: Draft, rng: Random) -> Draft | None:
    """Another start, on a boundary or free; the Seed Spreader has none of its own."""
    if draft.size is not None:
        return None
    if draft.shapes and rng.random() < 0.6:
        k = _any(draft, rng)
        shape = draft.shapes[k]
        edge = 0 if isinstance(shape, Circle) else int(rng.random() * len(shape.vertices))
        share = fmpq(0)
        if not isinstance(shape, Circle) and not shape.vertices[edge][2]:
            share = fmpq(int(rng.random() * 8), 8)
        return replace(draft, start=None, seat=Seat(k, edge, share))
    x, y = draft.place or (fmpq(0), fmpq(0))
    dx, dy = _shift(draft, rng)
    return replace(draft, start=(x + dx, y + dy), seat=None)


def _translated(shape: Shape, dx: fmpq, dy: fmpq) -> Shape:
    if isinstance(shape, Circle):
        return Circle((shape.center[0] + dx, shape.center[1] + dy), shape.radius, shape.name)
    return rebuilt(shape, tuple((x + dx, y + dy, bulge) for x, y, bulge in shape.vertices))


Move = Callable[[Draft, Random], "Draft | None"]
MOVES: tuple[Move, ...] = (
    _move_vertex,
    _move_level,
    _move_level,
    _move_obstacle,
    _move_obstacle,
    _scale_obstacle,
    _part,
    _part,
    _remove_obstacle,
    _add_obstacle,
    _remove_vertex,
    _split_edge,
    _change_frame,
    _change_start,
)
"""One is drawn at random; those named twice pay most."""
