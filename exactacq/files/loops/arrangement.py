"""Closed loops become a wall and obstacles; what the robot cannot see is left out, and named."""

from __future__ import annotations

from collections.abc import Sequence

from exactacq.files.counting import count
from exactacq.files.loops.nesting import Loops, nest
from exactacq.files.loops.union import unite
from exactacq.files.source import one_line
from exactacq.geometry.points import Point
from exactacq.scene.shapes import Shape

NAMED = 5
"""How many left out loops a note names."""


def arranged(
    shapes: list[Shape], start: Point | None, outer: str, union: bool, notes: list[str]
) -> tuple[list[Shape], Shape | None]:
    """The obstacles and the wall, see `nest` for *outer*; what was left out goes to the notes.

    Without a start there is no wall. Overlapping polygons are merged if *union* is set.
    """
    loops = Loops(shapes)
    nested = nest(loops, start, outer)
    if nested.dropped is not None:
        notes.append(f"dropped the outer loop {shapes[nested.dropped].name}")
    notes += _named("outside the wall left out", shapes, nested.outside)
    notes += _named("inside an obstacle left out (the robot cannot see them)", shapes, nested.hidden)
    wall = None if nested.wall is None else shapes[nested.wall]
    obstacles = [shapes[i] for i in nested.obstacles]
    if union:
        merged = unite(obstacles, wall, start)
        if merged.notes:
            kept = [*merged.obstacles, *([] if merged.wall is None else [merged.wall])]
            nested = nest(Loops(kept), start, "keep", wall=None if merged.wall is None else len(kept) - 1)
            obstacles, wall = [kept[i] for i in nested.obstacles], merged.wall
            notes += merged.notes
            notes += _named("outside the free place left out", kept, nested.outside)
            notes += _named("inside a union left out (the robot cannot see them)", kept, nested.hidden)
    return obstacles, wall


def _named(what: str, shapes: Sequence[Shape], members: list[int]) -> list[str]:
    if not members:
        return []
    names = ", ".join(one_line(shapes[i].name or f"loop {i + 1}") for i in members[:NAMED])
    more = f" and {len(members) - NAMED} more" if len(members) > NAMED else ""
    return [f"{count(len(members), 'loop')} {what}: {names}{more}"]
