"""Random exact scenes for either strategy, degenerate on purpose: small, with many ties and tangencies.

Obstacles fill boxes on a small integer grid, so that edges are collinear, circles touch lines, distances are
equal, and the radius of vision equals gaps. A share is generic: octagons, or a scene a hair off the grid.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from flint import fmpq

from exactacq.errors import InvalidScene
from exactacq.files.octagons import GAP, UNIT, random_octagons
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Outline, Polygon, Shape, Terrain
from exactacq.scene.terrain_components import ground_of
from exactacq.study.claims.model import Subject
from exactacq.study.dice import Dice
from exactacq.study.random_arcs import (
    CUSPS,
    HALF,
    LATE,
    QUARTER,
    ROOM_ARCS,
    SMOOTH,
    Corner,
    Drawn,
    circle_of_arcs,
    ring,
    rounded_triangle,
    subdivided,
)

HAIR = fmpq(1, 10**9)
"""How far some scenes are off the grid: far below what floats of this size tell apart by guessing."""
MOST = 7
"""Most obstacles of a scene: a run then takes seconds at most."""
THROWS = 20
"""Throws of one box, or of a start, before the scene does without it."""

POLYGONS: tuple[Drawn, ...] = (
    [(0, 0), (1, 0), (1, 1), (0, 1)],
    [(0, 0), (1, 0), (0, 1)],
    [(0, 0), (1, 0), (HALF, 1)],
    [(0, 0), (1, 0), (1, 1), (HALF, QUARTER), (0, 1)],
    [(0, HALF), (HALF, 0), (1, HALF), (HALF, 1)],
    [(0, 0), (1, 0), (1, QUARTER), (QUARTER, QUARTER), (QUARTER, 1), (0, 1)],
    [(0, 0), (1, 0), (1, 1), (LATE, 1), (LATE, QUARTER), (QUARTER, QUARTER), (QUARTER, 1), (0, 1)],
)
"""Polygons in the unit square, to fill any box: rectangle, triangles, concave pentagon, diamond, hooks."""
TENANT: Drawn = [(LATE / 2, HALF), (5 * QUARTER / 2, HALF), (HALF, LATE)]
"""A triangle in the last hook's pocket."""
OUTLINES: tuple[Drawn, ...] = (
    [(0, 0, fmpq(-1, 5)), (1, 0), (1, 1), (0, 1)],
    [(0, 0, fmpq(-1, 5)), (1, 0), (1, 1, fmpq(-1, 5)), (0, 1)],
    [(0, 0, fmpq(1, 5)), (1, 0), (1, 1), (0, 1)],
)
"""Outlines with an arc that is shallow enough for any box: hollow or bulging by a tenth of their width."""
ROUNDED: tuple[Drawn, ...] = (
    [(0, HALF, HALF), (1, HALF, HALF)],
    [(0, HALF, 1), (1, HALF)],
    [(0, HALF, 1), (1, HALF, -HALF)],
    [(0, 0), (1, 0, -1), (1, 1), (0, 1)],
    [(QUARTER, QUARTER), (LATE, QUARTER, 1), (LATE, LATE), (QUARTER, LATE, 1)],
)
"""Outlines for square boxes: lens, half disc, crescent, bay, stadium with smooth joints."""

TERRAINS = ((8, 8), (6, 10), (14, 6), (3, 12), (5, 4))
"""Widths and heights of the Seed Spreader's terrains."""
CANYONS = ((6, 24), (8, 20), (5, 18))
"""Terrains much longer than the radius, where one passes an obstacle for good."""
SWEEP_RADII = (fmpq(1), fmpq(2), fmpq(3), fmpq(5, 2), fmpq(5), fmpq(20))
"""Some divide the widths, some do not, some exceed them."""
TINY = fmpq(2, 3)
"""A radius for narrow terrains only: a sweep has as many lines as it goes into the width."""
SIGHTS = (fmpq(1), fmpq(3, 2), fmpq(2), fmpq(5, 2), fmpq(3), fmpq(5))
"""Radii that equal gaps between boxes, diagonals of 3-4-5 triangles, or halves of gaps."""
FAR = fmpq(60)
"""More than any scene's diameter: every obstacle is then in reach of another, the paper's model (a)."""


class Box(NamedTuple):
    """A rectangle with corners on the grid."""

    left: int
    bottom: int
    right: int
    top: int

    def is_apart(self, other: Box) -> bool:
        """Whether the boxes are disjoint, and so at least 1 apart."""
        aside = self.right < other.left or other.right < self.left
        return aside or self.top < other.bottom or other.top < self.bottom


def random_scene(subject: Subject, seed: int) -> Scene:
    """A small valid scene with its radius, the same on every platform for the same arguments.

    The Sightseer gets a start, on the grid or on a boundary, no terrain, and sometimes an enclosure; in two
    scenes of five the radius exceeds the scene. The Seed Spreader gets a terrain and starts in its SW corner.
    In half of its scenes obstacles lie over the border; a tenth are long and narrow with many diversions, and
    the slowest. ValueError for a negative seed. Cost: about ten milliseconds.

    >>> from exactacq.study.random_scenes import Subject, random_scene
    >>> random_scene(Subject.SIGHTSEER, 1)
    <Scene 'sightseer-1': 5 obstacles>
    """
    if seed < 0:
        raise ValueError(f"a seed must not be negative: {seed}")
    if seed % 5 >= 3:
        return arc_scene(subject, seed)
    return _made(_sightseer_scene if subject is Subject.SIGHTSEER else _swept_scene, subject, seed)


def arc_scene(subject: Subject, seed: int) -> Scene:
    """A small valid scene with its radius, built from the shapes of `random_arcs` that drawings contain.

    Circles in several arcs, arcs on one circle or on concentric ones, smooth joints, cusps, subdivided edges.
    Equal arguments give equal scenes on every platform.
    """
    return _made(_sightseer_arcs if subject is Subject.SIGHTSEER else _swept_arcs, subject, seed)


def _made(make: Callable[[Dice, str], Scene], subject: Subject, seed: int) -> Scene:
    # Neighbouring seeds give unlike streams; the two subjects must not share theirs.
    dice = Dice(2 * seed + (subject is Subject.SIGHTSEER))
    while True:
        try:
            return make(dice, f"{subject.value}-{seed}")
        except InvalidScene:
            continue  # A box's shape may miss the terrain, or a start lie inside an obstacle: throw again.


def _sightseer_scene(dice: Dice, name: str) -> Scene:
    radius = FAR if dice.chance(40) else dice.choice(SIGHTS)
    if dice.chance(15):
        shapes = list(random_octagons(dice.between(1, MOST), dice.below(10**6)).shapes)
        start = _on_boundary(dice, shapes) if dice.chance(30) else (fmpq(0), fmpq(0))
        return Scene(shapes, start, radius=radius, name=name)
    width, height = dice.choice(((8, 8), (12, 6), (5, 9)))
    shapes = _shapes(dice, Box(0, 0, width, height), Box(-1, -1, width, height), dice.between(1, MOST))
    room = Box(-dice.between(1, 3), -1, width + 1, height + dice.between(1, 3))
    wall = _Spot(room, 0, fmpq(0)).shape(POLYGONS[0]) if dice.chance(12) else None
    return _with_start(dice, shapes, room, wall, radius, name)


def _with_start(
    dice: Dice, shapes: Sequence[Shape], room: Box, wall: Shape | None, radius: fmpq, name: str
) -> Scene:
    for _ in range(THROWS):
        try:
            return Scene(shapes, _start(dice, shapes, room), enclosure=wall, radius=radius, name=name)
        except InvalidScene:
            continue
    raise InvalidScene(["no free start was found"])


def _start(dice: Dice, shapes: Sequence[Shape], room: Box) -> Corner:
    if dice.chance(40):
        return _on_boundary(dice, shapes)
    doubled = dice.between(2 * room.left, 2 * room.right), dice.between(2 * room.bottom, 2 * room.top)
    return fmpq(doubled[0], 2), fmpq(doubled[1], 2)


def _on_boundary(dice: Dice, shapes: Sequence[Shape]) -> Corner:
    """A vertex, the middle of a straight edge, or a circle's east point."""
    shape = dice.choice(shapes)
    if isinstance(shape, Circle):
        return shape.center[0] + shape.radius, shape.center[1]
    k = dice.below(len(shape.vertices))
    (x, y, bulge), (u, v, _) = shape.vertices[k], shape.vertices[(k + 1) % len(shape.vertices)]
    return (x, y) if bulge or dice.chance(50) else ((x + u) / 2, (y + v) / 2)


def _swept_scene(dice: Dice, name: str) -> Scene:
    kind = dice.below(100)
    if kind < 12:
        scene = _swept_octagons(dice, name)
    elif kind < 30:
        scene = _canyon(dice, name)
    else:
        width, height = dice.choice(TERRAINS)
        within = Box(-1, -1, width + 3, height + 3)
        if dice.chance(30):
            within = Box(1, 1, width - 1, height - 1)
        shapes = _shapes(dice, within, Box(0, 0, width, height), dice.between(1, MOST))
        radius = TINY if width < 6 and dice.chance(30) else dice.choice(SWEEP_RADII)
        scene = Scene(shapes, (0, 0), terrain=Terrain(width, height), radius=radius, name=name)
    ground_of(scene)
    return scene


def _canyon(dice: Dice, name: str) -> Scene:
    """A long narrow terrain with walls along the lines: obstacles hide each other, and get lost."""
    width, height = dice.choice(CANYONS)
    within = Box(1, 1, width - 1, height - 1)
    shapes = _shapes(dice, within, Box(0, 0, width, height), dice.between(4, MOST), (1, 7))
    radius = dice.choice((fmpq(width), fmpq(width), fmpq(width - 1), fmpq(width, 2)))
    return Scene(shapes, (0, 0), terrain=Terrain(width, height), radius=radius, name=name)


def _sightseer_arcs(dice: Dice, name: str) -> Scene:
    radius = FAR if dice.chance(40) else dice.choice(SIGHTS)
    percent = dice.choice((0, 30, 80))
    if dice.chance(40):
        center, size = (fmpq(0), fmpq(0)), fmpq(dice.choice((9, 12)))
        shapes = list(_rings(dice, center, ((2, 3), (4, 5), (6, 8)), percent))
        room = Box(-9, -9, 9, 9)
    else:
        width, height = dice.choice(((8, 8), (12, 6), (5, 9)))
        within = Box(0, 0, width, height)
        shapes = _shapes(dice, within, Box(-1, -1, width, height), dice.between(1, 4), drawn=_with_arcs)
        shapes = [subdivided(dice, shape, percent) for shape in shapes]
        center, size = (fmpq(width, 2), fmpq(height, 2)), fmpq(8)
        room = Box(-1, -1, width + 1, height + 1)
    wall = _round_room(dice, center, size, percent) if dice.chance(60) else None
    return _with_start(dice, shapes, room, wall, radius, name)


def _round_room(dice: Dice, center: Corner, size: fmpq, percent: int) -> Shape:
    """A circle about obstacles no farther than *size*, in one to four arcs, or a triangle with fillets."""
    kind = dice.below(5)
    if kind == 0:
        low = Box(*(int(c - 3 * size) for c in center), *(int(c + 3 * size) for c in center))
        return subdivided(dice, _Spot(low, 0, fmpq(0)).shape(rounded_triangle(fmpq(1, 10))), percent)
    if kind == 1:
        return Circle(center, size)
    off = center[0] + dice.choice((0, 0, 1)), center[1]
    return subdivided(dice, circle_of_arcs(off, size + 1, dice.choice(ROOM_ARCS)), percent)


def _rings(dice: Dice, center: Corner, rings: Sequence[tuple[int, int]], percent: int) -> Iterator[Shape]:
    """Obstacles with arcs on circles about one centre, and perhaps a circle in the middle."""
    if dice.chance(40):
        yield subdivided(dice, Circle(center, 1), percent)
    first = dice.below(len(rings))
    for inner, outer in rings[first : first + dice.between(1, 2)]:
        for shape in ring(dice, center, (fmpq(inner), fmpq(outer)), dice.between(1, 3)):
            yield subdivided(dice, shape, percent)


def _swept_arcs(dice: Dice, name: str) -> Scene:
    percent = dice.choice((0, 30, 80))
    if dice.chance(30):
        width, height = 8, dice.choice((8, 10))
        shapes = list(_rings(dice, (fmpq(4), fmpq(height, 2)), ((1, 2), (3, 4)), percent))
    else:
        width, height = dice.choice(TERRAINS)
        within = Box(-1, -1, width + 3, height + 3)
        if dice.chance(50):
            within = Box(1, 1, width - 1, height - 1)
        shapes = _shapes(dice, within, Box(0, 0, width, height), dice.between(1, 4), drawn=_with_arcs)
        shapes = [subdivided(dice, shape, percent) for shape in shapes]
    scene = Scene(shapes, (0, 0), terrain=Terrain(width, height), radius=dice.choice(SWEEP_RADII), name=name)
    ground_of(scene)
    return scene


def _with_arcs(dice: Dice, box: Box) -> list[Shape]:
    """One shape that fills a box: a smooth one or one with a cusp if the box is square, or a polygon."""
    place = _Spot(box, dice.below(8), fmpq(0))
    if box.right - box.left != box.top - box.bottom:
        return [place.shape(dice.choice((*OUTLINES, POLYGONS[0], POLYGONS[5])))]
    kind = dice.below(4)
    if kind == 0:
        return [place.circle()]
    return [place.shape(dice.choice((SMOOTH, CUSPS, ROUNDED)[kind - 1]))]


def _swept_octagons(dice: Dice, name: str) -> Scene:
    """Octagons in a terrain that holds them with room to spare, or that cuts the eastern or northern ones."""
    shapes = random_octagons(dice.between(1, MOST), dice.below(10**6)).shapes
    corners = [v for shape in shapes if not isinstance(shape, Circle) for v in shape.vertices]
    room = fmpq(dice.choice((GAP, GAP, -UNIT // 2)), UNIT)
    size = max(x for x, _, _ in corners) + room, max(y for _, y, _ in corners) + room
    return Scene(shapes, (0, 0), terrain=Terrain(*size), radius=dice.choice(SWEEP_RADII[1:]), name=name)


def _shapes(
    dice: Dice,
    within: Box,
    terrain: Box,
    count: int,
    sides: tuple[int, int] = (3, 3),
    drawn: Callable[[Dice, Box], list[Shape]] | None = None,
) -> list[Shape]:
    """Obstacles in boxes apart from each other, each partly in the terrain and off its SW corner.

    *count* boxes of at most these *sides* are thrown; those that find no place are left out. *drawn* fills a
    box; by default polygons do, and some round shapes.
    """
    if drawn is None:
        drawn = _filler(dice)
    boxes: list[Box] = []
    shapes: list[Shape] = []
    for _ in range(count):
        for _ in range(THROWS):
            box = _box(dice, within, sides)
            misses = box.right <= terrain.left or box.top <= terrain.bottom
            misses = misses or box.left >= terrain.right or box.bottom >= terrain.top
            on_corner = box.left <= terrain.left and box.bottom <= terrain.bottom
            if not misses and not on_corner and all(box.is_apart(other) for other in boxes):
                boxes.append(box)
                shapes += drawn(dice, box)
                break
    return shapes[:MOST]


def _filler(dice: Dice) -> Callable[[Dice, Box], list[Shape]]:
    """Fills boxes with polygons and some round shapes, perhaps half of them a hair off the grid."""
    round_share = dice.choice((0, 40, 80))
    shift = HAIR if dice.chance(10) else fmpq(0)
    return lambda dice, box: _filled(dice, box, round_share, shift if dice.chance(50) else fmpq(0))


def _box(dice: Dice, within: Box, sides: tuple[int, int]) -> Box:
    width, height = dice.between(1, sides[0]), dice.between(1, sides[1])
    left = dice.between(within.left, max(within.left, within.right - width))
    bottom = dice.between(within.bottom, max(within.bottom, within.top - height))
    return Box(left, bottom, left + width, bottom + height)


def _filled(dice: Dice, box: Box, round_share: int, shift: fmpq) -> list[Shape]:
    """One shape that fills the box, and perhaps what sits in its pocket."""
    place = _Spot(box, dice.below(8), shift)
    is_square = box.right - box.left == box.top - box.bottom
    if not dice.chance(round_share):
        drawn = dice.choice(POLYGONS)
        shapes = [place.shape(drawn)]
        if drawn is POLYGONS[-1] and dice.chance(60):
            shapes.append(place.shape(TENANT))
        return shapes
    if is_square and dice.chance(50):
        return [place.circle()]
    return [place.shape(dice.choice((*OUTLINES, *ROUNDED) if is_square else OUTLINES))]


class _Spot:
    """Where a shape of the unit square goes: one of its eight symmetries, a box, and a shift to the east."""

    def __init__(self, box: Box, symmetry: int, shift: fmpq) -> None:
        self.box, self.shift = box, shift
        self.swaps, self.flips_x, self.flips_y = symmetry & 1, symmetry & 2, symmetry & 4
        self.mirrors = (symmetry.bit_count() & 1) == 1

    def shape(self, drawn: Drawn) -> Shape:
        """The outline there; a mirror image turns bulges round."""
        vertices = [self._vertex(*vertex) for vertex in drawn]
        return Outline(vertices) if any(b for _, _, b in vertices) else Polygon([v[:2] for v in vertices])

    def _vertex(self, x: fmpq | int, y: fmpq | int, bulge: fmpq | int = 0) -> tuple[fmpq, fmpq, fmpq | int]:
        if self.swaps:
            x, y = y, x
        if self.flips_x:
            x = 1 - x
        if self.flips_y:
            y = 1 - y
        left, bottom, right, top = self.box
        east, north = fmpq(left) + x * (right - left), fmpq(bottom) + y * (top - bottom)
        return east + self.shift, north, -bulge if self.mirrors else bulge

    def circle(self) -> Circle:
        """The circle that touches all sides of a square box."""
        x, y, _ = self._vertex(HALF, HALF)
        return Circle((x, y), fmpq(self.box.right - self.box.left, 2))
