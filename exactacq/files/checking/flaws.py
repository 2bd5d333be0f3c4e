"""The violations of the rules for scenes in what a file holds, with or without a start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from networkx.utils import UnionFind

from exactacq.errors import FormatError, InvalidScene
from exactacq.files.checking.sketch import Sketch
from exactacq.files.counting import count
from exactacq.files.loops.contents import AS_TOLD, Contents
from exactacq.files.loops.nesting import Loops
from exactacq.files.loops.union import unite
from exactacq.geometry.points import Point
from exactacq.scene.scene import Obstacle
from exactacq.scene.shapes import Shape
from exactacq.scene.validation import Violation, violations

LARGE = 2
"""How many times as large as what is in it the box of a frame is."""


@dataclass(frozen=True, slots=True)
class Judged:
    """The loops that count, numbered as a scene would do it, and the violations among them.

    ``notes`` tell what was done to the file's loops.
    """

    loops: tuple[Obstacle, ...]
    violations: tuple[Violation, ...]
    notes: tuple[str, ...] = ()


def judged(contents: Contents) -> Judged:
    """What a scene would be made of, and what is wrong with it.

    Without a start, if the file does not tell what is the wall, all loops count, as they may lie anywhere
    around it. Then loops may lie in each other, "drop" leaves out the loop around most others, and a union is
    made of each group of loops that meet, if that can be done. Near linear in the edges; `FormatError` for
    millions of edges that overlap.
    """
    if contents.start is not None or contents.outer == AS_TOLD:
        try:
            obstacles, wall, notes = contents.arranged()
        except (FormatError, InvalidScene) as error:
            is_plain = contents.union and not contents.walls
            plain = judged(replace(contents, union=False)) if is_plain else _all_loops(contents)
            told = getattr(error, "violations", (str(error),))
            return Judged(plain.loops, (*map(Violation, told), *plain.violations), plain.notes)
        loops = _numbered(obstacles, wall)
        place = None if contents.start is None else Point(*contents.start)
        found = violations(loops, place, contents.radius, contents.terrain)
        return Judged(loops, tuple(found), tuple(notes))
    return _all_loops(contents)


def frame(shapes: Sequence[Shape]) -> int | None:
    """The loop around most others, if it is around more than half of them, and large beside each."""
    sketch = Sketch.of(shapes)
    held = sketch.nesting.sum(axis=0)
    if not len(held) or not held.max() or 2 * held.max() <= len(shapes) - 1:
        return None
    best = int(np.argmax(held))
    areas = [float(np.prod(np.ptp(line, axis=0))) if len(line) else 0.0 for line in sketch.lines]
    inner = max(areas[k] for k in np.flatnonzero(sketch.nesting[:, best]).tolist())
    return best if areas[best] >= LARGE * inner else None


def _all_loops(contents: Contents) -> Judged:
    shapes = list(contents.loops)
    if contents.outer == "drop" and (outermost := frame(shapes)) is not None:
        del shapes[outermost]
    before, notes = len(shapes), contents.notes
    if contents.union:
        shapes = list(_united(shapes))
        notes = *notes, f"merged {count(before, 'loop')} into {len(shapes)}"
    loops = _numbered(shapes, contents.wall)
    return Judged(loops, tuple(violations(loops, nested=True)), notes)


def _numbered(shapes: Sequence[Shape], wall: Shape | None) -> tuple[Obstacle, ...]:
    walls = [] if wall is None else [Obstacle.of(len(shapes), wall, is_enclosure=True)]
    return (*(Obstacle.of(k, shape) for k, shape in enumerate(shapes)), *walls)


def _united(shapes: Sequence[Shape]) -> list[Shape]:
    """The loops with unions in place of groups that meet; a group that has none stays as it is."""
    groups = UnionFind(range(len(shapes)))
    for pair in Loops(shapes).meeting:
        groups.union(*pair)
    found: list[Shape] = []
    for group in sorted(map(sorted, groups.to_sets())):
        members = [shapes[i] for i in group]
        try:
            found += unite(members, None, None).obstacles if len(members) > 1 else members
        except (FormatError, InvalidScene):
            found += members
    return found
