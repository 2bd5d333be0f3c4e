"""Scenes from what was drawn: obstacles step by step, then what is around them, the start and the radius."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

from oracles import Room
from strategies import ONE, ZERO, Pair, Similarity, Terrain, arcs_of_circle, split_point

from drawn_scenes.placing import Ground, Step, pick
from drawn_scenes.plane import (
    Box,
    box,
    edges,
    extremes,
    has_root,
    lines,
    minus,
    plus,
    root,
    rounds,
    square,
    vertices,
)
from exactacq.errors import InvalidScene
from exactacq.scene.terrain_components import ground_of

Q = Fraction
RADII = (Q(5), Q(3), Q(2), Q(1), Q(10), Q(60), Q(5, 2))
FACTORS = (ONE, Q(1, 2), Q(2))
MARGINS = (Q(1), Q(3), Q(1, 2), Q(1, 10**9))
STRIPS = 6
"""Most strips of a terrain: a sweep of more takes long."""
MEASURED = 12
"""Vertices of an obstacle whose distances are looked at for the radius."""
SHORTEST = Q(1, 10)
"""A radius is no distance that is shorter than this."""
WAYS_TO_START, WAYS_TO_ENCLOSE, WAYS_TO_BOUND = 8, 6, 6


@dataclass(frozen=True)
class Draft:
    """All that is drawn for a scene; the zeros are the plainest. Numbers are taken modulo what is there.

    *start*, *room* and *sight* are pairs of a way to choose, and what it chooses; *border* has a way for each
    side. The radius is multiplied by *factor*, and *hair* off.
    """

    steps: Sequence[Step]
    start: tuple[int, int]
    room: tuple[int, Fraction]
    sight: tuple[int, int]
    factor: Fraction
    hair: Fraction
    border: tuple[int, int, int, int]
    motion: Similarity


def toured(draft: Draft) -> Terrain:
    """A scene for the Sightseer."""
    ground = built(draft)
    shapes = (*ground.shapes, *room(draft, ground))
    start = next(p for p in starts(draft, ground) if is_legal(Terrain(shapes, p, ONE)))
    return draft.motion.terrain(Terrain(shapes, start, sight(draft, ground.shapes, start)))


def swept(draft: Draft) -> Terrain:
    """A scene for the Seed Spreader, without the obstacles that its terrain leaves out."""
    shapes = built(draft).shapes
    whole = box(shapes)
    for limits in (borders(draft, shapes, whole), grown(whole, ONE)):
        inside = tuple(shape for shape in shapes if box([shape]).meets(limits))
        radius = max(sight(draft, inside, limits[:2]), (limits.right - limits.left) / STRIPS)
        found = draft.motion.terrain(Terrain(inside, None, radius, limits))
        if inside and is_legal(found):
            return found
    raise AssertionError("obstacles that lie apart lie in a terrain around them")


def built(draft: Draft) -> Ground:
    """The obstacles, one or some for each step for which there was room."""
    ground = Ground()
    for step in draft.steps:
        ground.place(step)
    return ground


def is_legal(terrain: Terrain) -> bool:
    """Whether the library takes the scene, and the terrain."""
    try:
        scene = terrain.scene()
        if terrain.limits is not None:
            ground_of(scene)
    except InvalidScene:
        return False
    return True


def grown(around: Box, by: Fraction) -> Box:
    return Box(around.left - by, around.bottom - by, around.right + by, around.top + by)


def middle_of(around: Box) -> Pair:
    return (around.left + around.right) / 2, (around.bottom + around.top) / 2


def starts(draft: Draft, ground: Ground) -> Iterator[Pair]:
    """The place that was drawn to start from, and one that is free.

    In the corner of all; a vertex, the middle of an edge; on the line of an edge; a place of a group, as in a
    pocket, on an axis or in a centre of symmetry; an arc's centre; amid all, or below that.
    """
    way, number = draft.start
    shapes, around = ground.shapes, box(ground.shapes)
    corner = around.left - Q(1, 2), around.bottom - Q(1, 2)
    shape = pick(shapes, number)
    p, q, bulge = pick(list(edges(shape)), number // len(shapes))
    line = pick(lines(shape), number)
    places = [place for group in ground.groups for place in group.places] or [corner]
    centers = [circle.center for circle in rounds(shape)] or [corner]
    middle = middle_of(around)
    yield (
        corner,
        p,
        split_point(p, q, bulge, Q(1, 2))[0],
        plus(line.point, line.along, Q(-1, 2)),
        pick(places, number),
        pick(centers, number),
        middle,
        (middle[0], corner[1]),
    )[way]
    yield corner


def room(draft: Draft, ground: Ground) -> list[Room]:
    """No wall, or one: a box, perhaps bulging, or a circle of two arcs, the last about an arc's centre."""
    way, margin = draft.room
    around = grown(box(ground.shapes), margin + 1)
    left, bottom, right, top = around
    if way == 0:
        return []
    if way < 3:
        bulge = (ZERO, Q(1, 4))[way - 1]
        return [Room([(left, bottom, bulge), (right, bottom), (right, top, bulge), (left, top)])]
    centers = [circle.center for shape in ground.shapes for circle in rounds(shape)]
    center = min(centers, key=lambda c: square(minus(c, middle_of(around))), default=middle_of(around))
    if way < 5:
        center = middle_of(around)
    corners = ((left, bottom), (right, bottom), (right, top), (left, top))
    reach = root(max(square(minus(corner, center)) for corner in corners))
    return [Room(arcs_of_circle(center, Q(int(reach) + 1), (ONE, Q(1, 2), Q(2))[way - 3]))]


def borders(draft: Draft, shapes: Sequence[object], around: Box) -> Box:
    """For each side: 1 or 2 apart from the obstacles, touching, a hair off; through a vertex or the farthest
    point of an arc, as of a bay, or between two of these."""
    places = [p for shape in shapes for p in extremes(shape)]
    found = []
    for side, way in enumerate(draft.border):
        out = -1 if side < 2 else 1
        first, second, third = inwards({p[side % 2] for p in places}, side >= 2)
        ways = around[side] + out, around[side] + 2 * out, around[side], second, (first + third) / 2
        found.append((*ways, around[side] + out * Q(1, 10**9))[way])
    left, bottom, right, top = found
    return Box(left, bottom, right, top) if left < right and bottom < top else grown(around, ONE)


def inwards(levels: set[Fraction], from_above: bool) -> tuple[Fraction, Fraction, Fraction]:
    """The three outermost of some numbers; the last of them, if they are fewer."""
    some = sorted(levels, reverse=from_above)
    return some[0], some[min(1, len(some) - 1)], some[min(2, len(some) - 1)]


def sight(draft: Draft, shapes: Sequence[object], start: Pair) -> Fraction:
    """A plain radius; or what is a distance in the scene, its half or its double; or a hair more or less."""
    way, number = draft.sight
    found = sorted(distances(shapes, start)) if way else []
    radius = pick(found, number) * draft.factor if found else pick(RADII, number)
    return radius + (draft.hair if way < 2 else -draft.hair)


def distances(shapes: Sequence[object], start: Pair) -> set[Fraction]:
    """Rational distances between vertices of different obstacles, of boxes, and from the start."""
    boxes = [box([shape]) for shape in shapes]
    found: set[Fraction] = set()
    for one, other in combinations(boxes, 2):
        found |= {other.left - one.right, one.left - other.right}
        found |= {other.bottom - one.top, one.bottom - other.top}
    rows = [vertices(shape)[:MEASURED] for shape in shapes]
    pairs = [(p, start) for row in rows for p in row]
    pairs += [(p, q) for one, other in combinations(rows, 2) for p in one for q in other]
    squares = {square(minus(p, q)) for p, q in pairs[: MEASURED * MEASURED]}
    found |= {root(value) for value in squares if has_root(value)}
    for shape in shapes:
        for center, point in rounds(shape):
            away, radius = square(minus(start, center)), square(minus(point, center))
            if has_root(away) and has_root(radius):
                found |= {abs(root(away) - root(radius)), root(away) + root(radius)}
    return {value for value in found if value > SHORTEST}
