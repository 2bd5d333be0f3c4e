"""The edges in sight in the cells of a sweep, beside those that an isovist shows from inside each cell."""

from __future__ import annotations

from typing import TypeAlias

import exactacq as xa
from exactacq.numbers.between import rational_between
from exactacq.sensing.view_events import Change, Sweep, SweepEvent

Edges: TypeAlias = "set[tuple[int, int]]"


def edges_in_sight(scene: xa.Scene, place: xa.Point, radius: object) -> tuple[Edges, Edges]:
    """The edges of which an isovist shows a part with length, and those that have a point just in range."""
    square = xa.Point(radius, 0).norm_sq()
    seen = xa.isovist(scene, place, radius).seen()
    long = {edge for edge, spans in seen.items() if any(start != end for start, end in spans)}
    return long, {
        edge
        for edge, spans in seen.items()
        if any(start == end and (start - place).norm_sq() == square for start, end in spans)
    }


def pass_event(event: SweepEvent, in_sight: Edges, just: Edges) -> None:
    """Change the edges in sight at an event, before which its edge must be in sight or not, as it tells.

    An edge with a point *just* in range may be called either.
    """
    edge = event.obstacle, event.edge
    if event.change in (Change.ENTRY, Change.REAPPEARANCE):
        assert edge not in in_sight, event
        in_sight.add(edge)
    elif event.change in (Change.EXIT, Change.OCCLUSION):
        assert edge in in_sight | just, event
        in_sight.discard(edge)
    else:
        assert edge in in_sight, event


def check_edges(scene: xa.Scene, radius: object, swept: Sweep) -> int:
    """Inside every cell the edges in sight are those of the cell before, but for what events tell.

    Returns how many cells there are. The place is not the middle: there the piece may just touch a circle, of
    which it sees a single point from that one place.
    """
    in_sight: Edges = set()
    just: Edges = set()
    for k, cell in enumerate(swept.cells):
        middle = rational_between(cell.low, cell.high)
        beyond = rational_between(xa.Real(middle), cell.high)
        place = cell.point(middle + (beyond - middle) * 3 / 7)
        before, (seen, just) = just, edges_in_sight(scene, place, radius)
        if k:
            for event in swept.events:
                if event.leg == cell.leg and event.u is cell.begin[0]:
                    pass_event(event, in_sight, before)
            assert seen <= in_sight <= seen | just, (place, seen ^ in_sight)
        in_sight = in_sight & just | seen
    return len(swept.cells)
