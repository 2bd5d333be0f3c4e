"""Random scenes of disjoint obstacles as plain rational data, and the way from there to a library scene.

Disjointness is by construction: every shape keeps to its own cell of a lattice. All data are Fractions, so a
transformed scene (moved, turned by (3/5, 4/5), scaled, mirrored) is the exact image. The generators take any
`random.Random`: a seeded one, or hypothesis's own, which shrinks.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import atan
from random import Random

from hypothesis import strategies as st
from oracles import Disc, Room, reverse_loop

Q = Fraction
Pair = tuple[Fraction, Fraction]
EPS = Q(1, 10**60)
ZERO, ONE = Q(0), Q(1)


@dataclass(frozen=True)
class Terrain:
    """A scene as plain data: shapes as `oracles` takes them (a `Room` last), a start or None, a radius.

    For the Seed Spreader *limits* has the west, south, east and north side of the rectangle that it sweeps.
    """

    shapes: tuple[object, ...]
    start: Pair | None
    radius: Fraction
    limits: tuple[Fraction, Fraction, Fraction, Fraction] | None = None

    def scene(self) -> object:
        """The same as an `exactacq.Scene`."""
        return build(self.shapes, self.start, self.limits, self.radius)


def build(
    shapes: Sequence[object],
    start: Sequence[object] | None = None,
    limits: Sequence[Fraction] | None = None,
    radius: object = None,
) -> object:
    """An `exactacq.Scene` from plain shapes."""
    import exactacq as xa

    obstacles, enclosure = [], None
    for shape in shapes:
        if isinstance(shape, Disc):
            obstacles.append(xa.Circle((shape.x, shape.y), shape.r))
        elif isinstance(shape, Room):
            enclosure = xa.Outline(shape.vertices)
        elif all(len(v) == 2 for v in shape):
            obstacles.append(xa.Polygon(shape))
        else:
            obstacles.append(xa.Outline(shape))
    terrain = None
    if limits is not None:
        west, south, east, north = limits
        terrain = xa.Terrain(east - west, north - south, origin=(west, south))
    return xa.Scene(obstacles, start=start, enclosure=enclosure, terrain=terrain, radius=radius)


def box(x0: object, x1: object, y0: object, y1: object) -> list[tuple]:
    """The rectangle [x0, x1] x [y0, y1]."""
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


# Exact images.


@dataclass(frozen=True)
class Similarity:
    """x -> scale * turn(mirror(x)) + shift; `turn` is a rational unit complex number."""

    turn: Pair = (ONE, ZERO)
    scale: Fraction = ONE
    shift: Pair = (ZERO, ZERO)
    mirror: bool = False

    def point(self, p: Sequence[object]) -> Pair:
        x, y = Q(p[0]), -Q(p[1]) if self.mirror else Q(p[1])
        c, s = self.turn
        return self.scale * (c * x - s * y) + self.shift[0], self.scale * (s * x + c * y) + self.shift[1]

    def shape(self, shape: object) -> object:
        if isinstance(shape, Disc):
            return Disc(*self.point((shape.x, shape.y)), self.scale * Q(shape.r))
        if isinstance(shape, Room):
            return Room(self.shape(shape.vertices))
        sign = -1 if self.mirror else 1
        return [(*self.point(v), *(sign * Q(b) for b in v[2:])) for v in shape]

    def terrain(self, terrain: Terrain) -> Terrain:
        start = None if terrain.start is None else self.point(terrain.start)
        shapes = tuple(self.shape(shape) for shape in terrain.shapes)
        limits = terrain.limits
        if limits is not None:
            assert 0 in self.turn, "a rectangle with upright sides"
            xs, ys = zip(*(self.point(limits[k : k + 2]) for k in (0, 2)), strict=True)
            limits = min(xs), min(ys), max(xs), max(ys)
        return Terrain(shapes, start, self.scale * terrain.radius, limits)


SIMILARITIES = {
    "translation": Similarity(shift=(Q(22, 7), Q(-355, 113))),
    "rotation": Similarity(turn=(Q(3, 5), Q(4, 5))),
    "scaling": Similarity(scale=Q(7, 3)),
    "mirror": Similarity(mirror=True),
    "all at once": Similarity((Q(-5, 13), Q(12, 13)), Q(2, 9), (Q(-3), Q(1, 7)), mirror=True),
}


def reversed_order(terrain: Terrain) -> Terrain:
    """Every loop's vertices the other way round (and starting elsewhere)."""

    def turn(shape: object) -> object:
        if isinstance(shape, Disc):
            return shape
        if isinstance(shape, Room):
            return Room(turn(shape.vertices))
        backwards = reverse_loop(shape)
        if all(len(v) == 2 for v in shape):
            backwards = [v[:2] for v in backwards]
        return backwards[1:] + backwards[:1]

    return replace(terrain, shapes=tuple(turn(shape) for shape in terrain.shapes))


def split_point(p: Sequence, q: Sequence, bulge: Fraction, part: Fraction) -> tuple[Pair, Fraction, Fraction]:
    """A point of an edge and the bulges before and after: tan(a + b) by the addition theorem."""
    x, y, u, v = (Q(c) for c in (*p[:2], *q[:2]))
    first = bulge * part
    last = (bulge - first) / (1 + bulge * first)
    if not bulge:
        return (x + (u - x) * part, y + (v - y) * part), Q(0), Q(0)
    away = (1 - bulge**2) / (4 * bulge)
    cx, cy = (x + u) / 2 - (v - y) * away, (y + v) / 2 + (u - x) * away
    c, s = (1 - first**2) / (1 + first**2), 2 * first / (1 + first**2)
    c, s = c * c - s * s, 2 * c * s
    return (cx + (x - cx) * c - (y - cy) * s, cy + (x - cx) * s + (y - cy) * c), first, last


# Shapes that fit into the open disc of radius 1 about the origin, in general position.


def _circle_point(t: Fraction) -> Pair:
    return (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)


def _directions(rng: Random, k: int) -> list[Pair]:
    """k rational points of the unit circle, counterclockwise, about evenly spread."""
    out = []
    for m in range(k):
        quarter, part = divmod(Q(4 * m, k) + Q(rng.randint(0, 96), 97) * Q(2, k), 1)
        x, y = _circle_point(part)
        for _ in range(quarter % 4):
            x, y = -y, x
        out.append((x, y))
    return out


def convex_polygon(rng: Random) -> list[Pair]:
    """Corners on a circle."""
    return _directions(rng, rng.randint(3, 6))


def star_polygon(rng: Random) -> list[Pair]:
    """Corners at changing distance: mostly not convex."""
    return [
        (r * x, r * y) for x, y in _directions(rng, rng.randint(4, 7)) for r in [Q(rng.randint(30, 97), 97)]
    ]


def octagon(rng: Random) -> list[Pair]:
    """An octagon with two orders of mirror symmetry, turned."""
    a, b = Q(rng.randint(80, 90), 97), Q(rng.randint(30, 40), 97)
    corners = [(a, b), (b, a), (-b, a), (-a, b), (-a, -b), (-b, -a), (b, -a), (a, -b)]
    turn = Similarity(turn=_circle_point(Q(rng.randint(0, 40), 97)))
    return [turn.point(v) for v in corners]


def bulged(rng: Random) -> list[tuple]:
    """A convex polygon with gently bulging and hollow edges."""
    bulges = [Q(rng.choice([-12, -7, 0, 8, 15]), 97) for _ in range(6)]
    return [(x, y, b) for (x, y), b in zip(convex_polygon(rng), bulges, strict=False)]


def half_ring(rng: Random) -> list[tuple]:
    """Half of an annulus: a deep hollow."""
    r = Q(rng.randint(40, 80), 97)
    turn = Similarity(turn=_circle_point(Q(rng.randint(0, 96), 97)))
    return turn.shape([(Q(1), 0, 1), (Q(-1), 0, 0), (-r, 0, -1), (r, 0, 0)])


def disc(rng: Random) -> Disc:
    """A circle."""
    return Disc(Q(0), Q(0), Q(rng.randint(50, 97), 97))


POLYGONS: tuple[Callable[[Random], object], ...] = (convex_polygon, star_polygon, octagon)
ROUND: tuple[Callable[[Random], object], ...] = (disc, bulged, half_ring)


def random_terrain(
    rng: Random,
    kinds: Sequence[Callable[[Random], object]] = POLYGONS + ROUND,
    *,
    columns: int = 3,
    rows: int = 2,
    room: bool = False,
) -> Terrain:
    """Shapes of size 2 in a lattice of pitch 3; the start (general position) sits in one cell of its own."""
    cells = [(Q(3 * x), Q(3 * y)) for y in range(rows) for x in range(columns)]
    home = cells.pop(rng.randrange(len(cells)))
    shapes = []
    for cell in cells:
        shift = tuple(c + Q(rng.randint(-46, 46), 97) for c in cell)
        scale = Q(rng.randint(60, 97), 97)
        turn = _circle_point(Q(rng.randint(0, 100), 101))
        shapes.append(Similarity(turn, scale, shift).shape(rng.choice(list(kinds))(rng)))
    start = tuple(c + Q(rng.randint(-89, 89), 101) for c in home)
    if room:
        width, height = 3 * columns, 3 * rows
        skew = [Q(rng.randint(0, 30), 97) for _ in range(4)]
        shapes.append(
            Room(
                [
                    (Q(-2) - skew[0], Q(-2)),
                    (width - 1 + skew[1], Q(-2) - skew[0], Q(1, 9)),
                    (width - 1, height - 1 + skew[2]),
                    (Q(-2), height - 1 + skew[3], Q(-1, 97)),
                ]
            )
        )
    return Terrain(tuple(shapes), start, Q(rng.randint(300, 900), 97))


# Degenerate scenes: small integers, shared lines, equal gaps.


def _grid_shape(rng: Random) -> object:
    """A shape with corners on the grid {0, .., 3}^2 (a circle through such points)."""
    a, b = sorted(rng.sample(range(4), 2))
    c, d = sorted(rng.sample(range(4), 2))
    return rng.choice(
        [
            box(a, b, c, d),
            box(0, 3, 0, 3),
            [(a, c), (b, c), (a, d)],
            [(b, d), (a, d), (b, c)],
            [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)],
            [(1, 0), (3, 1), (2, 3), (0, 2)],
            [(0, 1), (1, 0), (2, 0), (3, 1), (3, 2), (2, 3), (1, 3), (0, 2)],
            Disc(1, 1, 1),
            Disc(2, 1, 1),
            Disc(Q(3, 2), Q(3, 2), Q(3, 2)),
            [(0, 0), (3, 0, 1), (3, 2), (0, 2)] if rng.random() < 0.5 else [(0, 1, 1), (2, 1)],
        ]
    )


def degenerate_terrain(rng: Random, *, columns: int = 3, rows: int = 2) -> Terrain:
    """Grid shapes in cells of pitch 5: collinear corners, equal gaps, parallel edges, R equal to a gap."""
    cells = [(5 * x, 5 * y) for y in range(rows) for x in range(columns)]
    home = cells.pop(rng.randrange(len(cells)))
    shapes = tuple(Similarity(shift=(Q(x), Q(y))).shape(_grid_shape(rng)) for x, y in cells)
    start = (Q(home[0] + rng.randint(0, 3)), Q(home[1] + rng.randint(0, 3)))
    return Terrain(shapes, start, Q(rng.choice([2, 3, 4, 5, 6, 7, 10])))


def square_grid(columns: int, rows: int, side: object = 1, pitch: object = 2) -> list[list[tuple]]:
    """Axis-parallel squares, row by row from the origin."""
    corners = [(pitch * x, pitch * y) for y in range(rows) for x in range(columns)]
    return [box(x, x + side, y, y + side) for x, y in corners]


def circle_grid(columns: int, rows: int, radius: object = 1, pitch: object = 3) -> list[Disc]:
    """Circles, row by row, the first about the origin."""
    return [Disc(pitch * x, pitch * y, radius) for y in range(rows) for x in range(columns)]


def terrains(**options: object) -> st.SearchStrategy[Terrain]:
    """`random_terrain` under hypothesis."""
    return st.randoms(use_true_random=False).map(lambda rng: random_terrain(rng, **options))


def degenerate_terrains(**options: object) -> st.SearchStrategy[Terrain]:
    """`degenerate_terrain` under hypothesis."""
    return st.randoms(use_true_random=False).map(lambda rng: degenerate_terrain(rng, **options))


# Arcs as drawings have them: on one circle or about one centre, joined smoothly or in cusps, round rooms.

STADIUM = [(-2, -1), (2, -1, 1), (2, 1), (-2, 1, 1)]
ROUNDED_U = [(-2, 2), (-2, 0, 1), (2, 0), (2, 2), (1, 2), (1, 0, -1), (-1, 0), (-1, 2)]
S_BAND = [(0, 2, 1), (0, Q(-1, 2), -1), (0, -1), (0, -2, 1), (0, Q(1, 2), -1), (0, 1)]
SMOOTH: tuple[list[tuple], ...] = (STADIUM, ROUNDED_U, S_BAND)
FREE_CUSPS: tuple[list[tuple], ...] = (
    [(2, -1), (-1, -1, 1), (-1, 1), (-2, 1), (-2, -2), (2, -2)],  # an arc on a floor
    [(2, 0, 1), (0, 0, 1), (-2, 0), (0, -2)],  # two arcs
)
SPIKES: tuple[list[tuple], ...] = (
    [(-1, -1), (1, -1), (1, Q(1, 2), Q(-1, 3))],  # an arc on a floor
    [(-2, 0, 1), (2, 0, Q(-1, 2))],  # two arcs
)
ROOM_BULGES = (Q(1), Q(1, 2), Q(3, 4), Q(2), Q(3))
"""Of the first arc of a round room or circle: its ends are rational."""
RING_BULGES = (Q(1, 5), Q(1, 4), Q(1, 3), Q(2, 5), Q(1, 2), Q(1))


def turned(v: Sequence[object], bulge: Fraction) -> Pair:
    """A vector turned by the angle of a bulge b, which is that of (1 + i b)^4."""
    x, y = Q(v[0]), Q(v[1])
    for _ in range(4):
        x, y = x - bulge * y, y + bulge * x
    size = (1 + bulge * bulge) ** 2
    return x / size, y / size


def arcs_of_circle(center: Pair, radius: Fraction, bulge: Fraction) -> list[tuple]:
    """A circle as two arcs, the first from its east point."""
    (x, y), (u, v) = center, turned((radius, 0), bulge)
    return [(x + radius, y, bulge), (x + u, y + v, 1 / bulge)]


def fillets() -> list[tuple]:
    """A triangle with rounded corners: 4 atan(1/2) twice and 4 atan(3/4) make a full turn."""
    x, y = Q(-1), Q(-1)
    along = (Q(1), Q(0))
    loop: list[tuple] = []
    for length, bulge in ((2, Q(1, 2)), (Q(28, 25), Q(1, 2)), (2, Q(3, 4))):
        loop.append((x, y, Q(0)))
        x, y = x + length * along[0], y + length * along[1]
        loop.append((x, y, bulge))
        after = turned(along, bulge)
        # The fillet has radius 1/2 and its centre to the left.
        x, y = x + (after[1] - along[1]) / 2, y - (after[0] - along[0]) / 2
        along = after
    assert (x, y) == loop[0][:2], "the loop closes"
    return loop


def ring(rng: Random, inner: object, outer: object) -> list[list[tuple]]:
    """Annular sectors and segments of a disc about the origin, apart from each other, on two circles."""
    ray, angle, shapes = turned((1, 0), rng.choice(RING_BULGES)), 0.0, []
    for _ in range(rng.randint(1, 3)):
        bulge, gap = rng.choice(RING_BULGES), rng.choice(RING_BULGES[:3])
        angle += 4 * (atan(bulge) + atan(gap))
        if angle > 6.2:
            break
        first, last = ray, turned(ray, bulge)
        ray = turned(last, gap)
        (a, b), (c, d) = (tuple(Q(r) * w for w in first) for r in (outer, inner))
        (e, f), (g, h) = (tuple(Q(r) * w for w in last) for r in (outer, inner))
        cap = rng.choice([0, 0, 1]) if outer - inner < inner / 2 else 0
        sector = [(a, b, bulge), (e, f, cap), (g, h, -bulge), (c, d, cap)]
        shapes.append(rng.choice([sector, sector, [(a, b, bulge), (e, f)]]))
    return shapes


def arc_terrain(rng: Random) -> Terrain:
    """Either obstacles about one centre or smooth shapes and cusps in cells, mostly in a round room."""
    shapes: list[object]
    if rng.random() < 0.5:
        shapes = [*ring(rng, 2, 3), *(ring(rng, 5, 6) if rng.random() < 0.5 else ())]
        if rng.random() < 0.5:
            shapes.append(rng.choice([Disc(0, 0, 1), _arcs(ONE, rng.choice(ROOM_BULGES))]))
        center, radius = (ZERO, ZERO), Q(9)
    else:
        kinds = (
            *SMOOTH,
            *FREE_CUSPS,
            *SPIKES,
            fillets(),
            Disc(0, 0, 2),
            _arcs(2 * ONE, ONE),
        )
        cells = [Similarity(rng.choice([(1, 0), (0, 1), (-1, 0)]), shift=(Q(5 * k), ZERO)) for k in range(2)]
        shapes = [place.shape(rng.choice(kinds)) for place in cells]
        center, radius = (Q(5, 2), ZERO), Q(8)
    start = rng.choice([(Q(rng.randint(-8, 8)), Q(rng.randint(-8, 8), 2)), _a_vertex(rng, shapes)])
    center = center[0] + rng.choice([0, 0, 1]), center[1]
    room = [Room(arcs_of_circle(center, radius, rng.choice(ROOM_BULGES)))] if rng.random() < 0.7 else []
    return Terrain((*shapes, *room), start, Q(rng.choice([1, 2, 3, 5, 60])))


def _arcs(radius: Fraction, bulge: Fraction) -> list[tuple]:
    return arcs_of_circle((ZERO, ZERO), radius, bulge)


def _a_vertex(rng: Random, shapes: Sequence[object]) -> Pair:
    shape = rng.choice(list(shapes))
    x, y = (shape.x + shape.r, shape.y) if isinstance(shape, Disc) else rng.choice(shape)[:2]
    return Q(x), Q(y)
