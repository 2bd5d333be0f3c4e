"""The union of overlapping loops of segments and arcs, by their exact overlay.

Polygons merge exactly. Where arcs are crossed, vertices are rational points near the crossings, and the note
bounds how far that moves anything: see `exactacq.files.repairs.overlay`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from flint import fmpq
from networkx.utils import UnionFind

from exactacq.errors import FormatError
from exactacq.files.counting import count
from exactacq.files.loops.chains import ZERO, scientific_above
from exactacq.files.loops.nesting import Loops
from exactacq.files.repairs.overlay import Ring, overlay
from exactacq.files.rereading import once
from exactacq.geometry.loops import winding
from exactacq.geometry.points import Point
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Shape, shape_edges
from exactacq.scene.validation import place_text

NAMED = 6
"""How many loops of a group a message names."""
LISTED_GROUPS = 8
"""How many groups are told one by one."""


@dataclass(slots=True)
class Merged:
    """Obstacles and wall after the union."""

    obstacles: list[Shape]
    wall: Shape | None
    groups: list[str] = field(default_factory=list)
    """The names of the loops that were merged, group by group."""
    moved: fmpq = ZERO
    """A bound of how far any point is from the exact unions."""
    closed: list[str] = field(default_factory=list)
    """What is told of places that are closed in."""

    @property
    def notes(self) -> list[str]:
        """What to tell of it, with the bound; nothing if no loops met."""
        kind = "union" if self.moved else "exact union"
        told = [f"merged {names} into their {kind}" for names in self.groups[:LISTED_GROUPS]]
        if len(self.groups) > LISTED_GROUPS:
            more = count(len(self.groups) - LISTED_GROUPS, "more group")
            told.append(f"merged {more} of loops that overlap")
        if self.moved:
            far = scientific_above(self.moved)
            told.append(
                f"no point of a union moved by more than {far}, where crossings of arcs were made rational"
            )
        return [*told, *self.closed]


def unite(shapes: list[Shape], wall: Shape | None, start: Point | None) -> Merged:
    """Merge obstacles that meet each other, or the wall, into their union.

    What the wall and the obstacles that meet it leave free around the start becomes the new wall; so does a
    hole of a union that holds the start; other holes are filled, for the robot cannot see them. Raises
    `FormatError` if the start is in none of the places that a group with the wall leaves free, and
    `InvalidScene` if one of the loops crosses itself.
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
    named = list(dict.fromkeys(repr(member.name) for member in members))
    names = ", ".join(named[:NAMED]) + (f" and {len(named) - NAMED} more" if len(named) > NAMED else "")
    rings = _overlaid(members, walled)
    # One loop is enough to find it in the file; all are told once, in the notes.
    first = members[0].name or "a loop"
    name = first if len(named) == 1 else f"{first} and {len(named) - 1} more"
    shapes = [ring.shape(name) for ring in rings]
    rooms = [shape for ring, shape in zip(rings, shapes, strict=True) if ring.outer == walled]
    solids = [shape for ring, shape in zip(rings, shapes, strict=True) if ring.outer != walled]
    room = next((r for r in rooms if start is not None and _inside(r, start)), None)
    if walled and room is None:
        place = "" if start is None else f" {place_text(start)}"
        raise FormatError(f"the start{place} is not in what the union of {names} leaves free: choose another")
    merged.groups.append(names)
    merged.moved = max(merged.moved, *(ring.chain.moved() for ring in rings))
    if room is None:
        merged.obstacles += solids
    else:
        if walled or merged.wall is None or _inside(merged.wall, shape_edges(room)[0].start):
            merged.wall = room
        merged.obstacles += [solid for solid in solids if _inside(room, shape_edges(solid)[0].start)]
    closed = len(rooms) - (room is not None)
    if closed:
        them = "it" if closed == 1 else "them"
        merged.closed.append(
            f"left out {count(closed, 'free place')} closed in by {name} (the robot cannot see {them})"
        )


def _overlaid(members: list[Shape], walled: bool) -> list[Ring]:
    """The boundary of the union of loops, none of which crosses itself: the same one around any start."""

    def made() -> list[Ring]:
        for member in members:
            Scene([member])
        return overlay(members, _is_free if walled else any)

    return once(("overlay", walled, *members), made)


def _is_free(held: Sequence[bool]) -> bool:
    """Whether a point is inside the wall, the first loop, and in no other."""
    return held[0] and not any(held[1:])


def _inside(shape: Shape, point: Point) -> bool:
    return bool(winding(shape_edges(shape), point))
