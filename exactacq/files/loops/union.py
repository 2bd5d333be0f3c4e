"""The union of overlapping loops of segments and arcs, by their exact overlay.

Polygons merge exactly. Where arcs are crossed, vertices are rational points near the crossings, and the note
bounds how far that moves anything: see `exactacq.files.repairs.overlay`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from networkx.utils import UnionFind

from exactacq.errors import FormatError
from exactacq.files.loops.chains import scientific_above
from exactacq.files.loops.nesting import Loops
from exactacq.files.repairs.overlay import overlay
from exactacq.geometry.intersections import winding
from exactacq.geometry.points import Point
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Shape, shape_edges

NAMED = 6
"""How many loops of a group a message names."""


@dataclass(slots=True)
class Merged:
    """Obstacles and wall after the union."""

    obstacles: list[Shape]
    wall: Shape | None
    notes: list[str] = field(default_factory=list)


def unite(shapes: list[Shape], wall: Shape | None, start: Point | None) -> Merged:
    """Merge obstacles that meet each other, or the wall, into their union.

    What the wall and the obstacles that meet it leave free around the start becomes the new wall; so does a
    hole of a union that holds the start; other holes are filled, for the robot cannot see them. Raises
    `FormatError` if a group of meeting loops holds an arc or has no common grid, or the start is in none of
    its free places, and `InvalidScene` if one of its polygons crosses itself.
    """
    every = [*([] if wall is None else [wall]), *shapes]
    merged = Merged([], wall)
    groups = UnionFind(range(len(every)))
    for pair in Loops(every).meeting:
        groups.union(*pair)
    for group in sorted(map(sorted, groups.to_sets())):
        members = [every[i] for i in group]
        if len(members) > 1:
            _merge(members, members[0] is wall, start, merged)
        elif members[0] is not wall:
            merged.obstacles.append(members[0])
    return merged


def _merge(members: list[Shape], walled: bool, start: Point | None, merged: Merged) -> None:
    """One group of meeting loops; the first is the wall if *walled*."""
    names = ", ".join(repr(member.name) for member in members[:NAMED])
    names += f" and {len(members) - NAMED} more" if len(members) > NAMED else ""
    for member in members:
        Scene([member])
    rings = overlay(members, _is_free if walled else any)
    name = f"union of {names}"
    shapes = [ring.shape(name) for ring in rings]
    rooms = [shape for ring, shape in zip(rings, shapes, strict=True) if ring.outer == walled]
    solids = [shape for ring, shape in zip(rings, shapes, strict=True) if ring.outer != walled]
    room = next((r for r in rooms if start is not None and _inside(r, start)), None)
    if walled and room is None:
        raise FormatError(f"no union of {names}: the start is not in what it leaves free; choose another")
    far = max(ring.chain.moved() for ring in rings)
    if far:
        off = (
            f"no point moved by more than {scientific_above(far)}, where crossings of arcs were made rational"
        )
        merged.notes.append(f"merged {names} into their union; {off}")
    else:
        merged.notes.append(f"merged {names} into their exact union")
    if room is None:
        merged.obstacles += solids
    else:
        if walled or merged.wall is None or _inside(merged.wall, shape_edges(room)[0].start):
            merged.wall = room
        merged.obstacles += [solid for solid in solids if _inside(room, shape_edges(solid)[0].start)]
    closed = len(rooms) - (room is not None)
    if closed:
        merged.notes.append(f"left out {closed} free places closed in by {name} (the robot cannot see them)")


def _is_free(held: Sequence[bool]) -> bool:
    """Whether a point is inside the wall, the first loop, and in no other."""
    return held[0] and not any(held[1:])


def _inside(shape: Shape, point: Point) -> bool:
    return bool(winding(shape_edges(shape), point))
