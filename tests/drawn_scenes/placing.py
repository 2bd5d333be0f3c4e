"""Where a drawn obstacle goes: by its relation to one that is there, at the first free of several places.

Each relation tells a row of places, the plain one first. So nothing drawn is thrown away, and what is drawn
means something however few obstacles are left: hypothesis can drop any of them when it shrinks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import count, islice

from oracles import reverse_loop
from strategies import ONE, ZERO, Pair, build, split_point

from drawn_scenes.kinds import Group, Kind
from drawn_scenes.plane import (
    Box,
    Line,
    Round,
    box,
    edges,
    has_root,
    lines,
    minus,
    moved,
    plus,
    product,
    quotient,
    root,
    rounds,
    square,
    turn,
)
from exactacq.errors import InvalidScene

Q = Fraction
PLACES = 12
"""Places of a relation that are tried; an obstacle for which none is free is left out."""
EAST, NORTH, WEST, SOUTH = SIDES = ((1, 0), (0, 1), (-1, 0), (0, -1))
TURNS: tuple[Pair, ...] = (
    *((Q(x), Q(y)) for x, y in SIDES),
    turn(Q(1, 2)),
    turn(Q(2, 3)),
    turn(Q(-1, 3)),
    turn(Q(1, 10**9)),
)
"""Quarter turns, Pythagorean angles, and hardly a turn at all."""
GAPS = (Q(1), Q(2), Q(1, 2), Q(3), Q(5, 2), Q(1, 10**9), Q(1, 10**30), Q(1, 10**60))
HAIRS = (ZERO, Q(1, 10**9), Q(1, 10**12), Q(1, 10**15), Q(1, 10**18), Q(1, 10**30), Q(1, 10**60))
"""By so little some are off the place where they would tie."""


@dataclass(frozen=True)
class Step:
    """All that is drawn for one obstacle, the zeros the plainest; numbers are taken modulo what is there.

    *other* is the obstacle that it is placed by, *mine* and *theirs* are features of the two.
    """

    relation: Relation
    kind: Kind
    width: int
    height: int
    variant: int
    other: int
    mine: int
    theirs: int
    side: int
    gap: Fraction
    pose: int
    hair: Fraction
    cuts: int


Relation = Callable[[Step, Group, Sequence[Group]], Iterator[Group]]


class Ground:
    """What is placed already."""

    def __init__(self) -> None:
        self.groups: list[Group] = []
        self.boxes: list[tuple[object, Box]] = []

    @property
    def shapes(self) -> list[object]:
        return [shape for shape, _ in self.boxes]

    def place(self, step: Step) -> None:
        """Another obstacle, where there is room for it."""
        posed = image(step.kind(step.width, step.height, step.variant), TURNS[step.pose % 8], step.pose >= 8)
        hair = (step.hair, ZERO) if step.side % 2 else (ZERO, step.hair)
        # What it is placed by comes first in the order of shrinking: the last one, then those before.
        others = self.groups[::-1]
        places = step.relation(step, posed, others) if others else iter([posed])
        for group in islice(places, PLACES):
            found = redrawn(shifted(group, hair), step.cuts)
            boxes = [(shape, box([shape])) for shape in found.shapes]
            if self._is_free(boxes):
                self.groups.append(found)
                self.boxes += boxes
                return

    def _is_free(self, new: Sequence[tuple[object, Box]]) -> bool:
        close = [(a, b) for a, x in new for b, y in self.boxes if x.meets(y)]
        return all(are_apart(a, b) for a, b in close)


def are_apart(one: object, other: object) -> bool:
    """Whether two shapes can be obstacles of one scene."""
    try:
        build([one, other])
    except InvalidScene:
        return False
    return True


def image(group: Group, by: Pair = (ONE, ZERO), mirror: bool = False, shift: Pair = (ZERO, ZERO)) -> Group:
    """The image of all of a group, see `moved`."""

    def place(p: Pair) -> Pair:
        return plus(product((p[0], -p[1]) if mirror else p, by), shift)

    shapes = tuple(moved(shape, by, shift, mirror) for shape in group.shapes)
    return Group(shapes, tuple(map(place, group.places)))


def shifted(group: Group, shift: Pair) -> Group:
    return image(group, shift=shift) if any(shift) else group


# -- relations -------------------------------------------------------------------------------------


def beside(step: Step, new: Group, others: Sequence[Group]) -> Iterator[Group]:
    """A gap away on one side, two sides, middles or ends on one line; then farther that way."""
    there, here = box(pick(others, step.other).shapes), box(new.shapes)
    dx, dy = SIDES[step.side % 4]
    along = {
        EAST: there.right + step.gap - here.left,
        WEST: there.left - step.gap - here.right,
        NORTH: there.top + step.gap - here.bottom,
        SOUTH: there.bottom - step.gap - here.top,
    }[dx, dy]
    low, high = (there[1] - here[1], there[3] - here[3]) if dx else (there[0] - here[0], there[2] - here[2])
    across = (low, high, (low + high) / 2, low + 1)[step.mine % 4]
    for k in count():
        far = along + k * (dx + dy)
        yield shifted(new, (far, across) if dx else (across, far))


def on_a_grid(step: Step, new: Group, others: Sequence[Group]) -> Iterator[Group]:
    """A copy of what is there in the next free places of a row."""
    copied = pick(others, step.other)
    (left, bottom, right, top), (dx, dy) = box(copied.shapes), SIDES[step.side % 4]
    pitch = (right - left if dx else top - bottom) + step.gap
    for k in count(1):
        yield shifted(copied, (k * pitch * dx, k * pitch * dy))


def mirrored(step: Step, new: Group, others: Sequence[Group]) -> Iterator[Group]:
    """The mirror image of what is there, in an upright, level or diagonal axis; on it is a place."""
    copied = pick(others, step.other)
    around = box(copied.shapes)
    # z -> by * conjugate(z) is the mirror in the axis whose angle is half that of `by`.
    by = TURNS[step.mine % 4]
    off = {EAST: (0, 1), NORTH: (1, -1), WEST: (1, 0), SOUTH: (1, 1)}[by]  # across the axis
    middle = (around.left + around.right) / 2, (around.bottom + around.top) / 2
    plain = product((middle[0], -middle[1]), by)
    sign = -1 if step.side % 2 else 1
    extent = max(around.right - around.left, around.top - around.bottom)
    for k in count():
        # The image of the middle lies this far from it.
        far = sign * (extent + step.gap + k)
        to = plus(middle, off, far if 0 in off else far / 2)
        found = image(copied, by, True, minus(to, plain))
        yield Group(found.shapes, (*found.places, plus(middle, minus(to, middle), Q(1, 2))))


def turned_about(step: Step, new: Group, others: Sequence[Group]) -> Iterator[Group]:
    """What is there, turned about the centre of one of its circles, or about a place beside it."""
    copied = pick(others, step.other)
    circles = [c for shape in copied.shapes for c in rounds(shape)]
    around = box(copied.shapes)
    center = (around.left - step.gap, around.bottom)
    if circles and step.mine % 2:
        center = pick(circles, step.theirs).center
    angle, by = TURNS[(step.side + 1) % 7], (ONE, ZERO)
    for _ in range(PLACES):
        by = product(by, angle)
        found = image(copied, by, False, minus(center, product(center, by)))
        yield Group(found.shapes, (*found.places, center))


def on_one_line(step: Step, new: Group, others: Sequence[Group]) -> Iterator[Group]:
    """An edge or a tangent of the new one on the line of an edge, or on a tangent, of what is there.

    Tangents are those in ends of arcs. Along the line it goes as far as there is room, one way.
    """
    there, here = some_line(pick(others, step.other), step.theirs), some_line(new, step.mine)
    by = fitting(there.along, here.along, (ONE, ZERO) if step.side % 2 else (-ONE, ZERO))
    length = size_of(there.along)
    way = there.along[0] / length, there.along[1] / length
    for k in count():
        to = plus(there.point, way, (1 + k) * (step.gap if k % 2 else 2) * (-1 if step.side // 2 % 2 else 1))
        yield image(new, by, False, minus(to, product(here.point, by)))


def on_one_circle(step: Step, new: Group, others: Sequence[Group]) -> Iterator[Group]:
    """An arc of the new one on the circle of an arc that is there, or on one about its centre."""
    theirs = [c for shape in pick(others, step.other).shapes for c in rounds(shape)]
    mine = [c for shape in new.shapes for c in rounds(shape)]
    if not theirs or not mine:
        yield from beside(step, new, others)
        return
    there, here = pick(theirs, step.theirs), pick(mine, step.mine)
    larger = (Q(1), Q(1), Q(2), Q(1, 2), Q(3))[step.side % 5]
    plain = product(quotient(arm(there), arm(here)), (larger, ZERO))
    angle, by = TURNS[(1, 4, 5, 6)[step.variant % 4]], plain
    for _ in range(PLACES):
        by = product(by, angle)
        found = image(new, by, False, minus(there.center, product(here.center, by)))
        yield Group(found.shapes, (*found.places, there.center))


def in_a_pocket(step: Step, new: Group, others: Sequence[Group]) -> Iterator[Group]:
    """Smaller, from a free place of what is there to the north-east; or beside it, if it has none."""
    there = pick(others, step.other)
    if there.places:
        here, place = box(new.shapes), pick(there.places, step.theirs)
        for k in range(PLACES // 2):
            size = Q(1, 3 + step.mine % 3 + k)
            corner = plus((here.left * -size, here.bottom * -size), place)
            yield image(new, (size, ZERO), shift=plus(corner, (size / 2, size / 2)))
    yield from beside(step, new, others)


RELATIONS: tuple[Relation, ...] = (
    beside,
    on_a_grid,
    mirrored,
    on_one_line,
    in_a_pocket,
    turned_about,
    on_one_circle,
)
"""All of them, the plain ones first."""


def pick(things: Sequence, number: int) -> object:
    """One of several, whatever the number."""
    return things[number % len(things)]


def some_line(group: Group, number: int) -> Line:
    return pick([line for shape in group.shapes for line in lines(shape)], number)


def arm(circle: Round) -> Pair:
    return minus(circle.point, circle.center)


def fitting(there: Pair, here: Pair, way: Pair) -> Pair:
    """What turns a vector to the direction of another, and stretches it little: to keep the size."""
    by = product(quotient(there, here), way)
    size = size_of(by)
    return by[0] / size, by[1] / size


def size_of(vector: Pair) -> Fraction:
    """The length if that is rational, else two digits of it."""
    size = square(vector)
    return root(size) if has_root(size) else Q(f"{float(size) ** 0.5:.1e}")


# -- the same shape drawn otherwise ----------------------------------------------------------------


def redrawn(group: Group, cuts: int) -> Group:
    """Edges cut in two, circles in arcs, loops begun elsewhere or drawn the other way; nothing for 0."""
    if not cuts:
        return group
    return Group(tuple(cut(shape, cuts) for shape in group.shapes), group.places)


def cut(shape: object, cuts: int) -> list[tuple]:
    """Every edge whose bit is set is cut."""
    loop: list[tuple] = []
    for k, (p, q, bulge) in enumerate(edges(shape)):
        if cuts >> (1 + k % 4) & 1:
            middle, first, last = split_point(p, q, bulge, (Q(1, 2), Q(1, 3))[k % 2])
            loop += [(*p, first), (*middle, last)]
        else:
            loop.append((*p, bulge))
    if cuts & 1:
        loop = reverse_loop(loop)
        loop = loop[1:] + loop[:1]
    return loop
