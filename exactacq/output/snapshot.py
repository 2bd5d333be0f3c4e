"""A moment of a run: how far the robot has come, what it knows, and what it sees."""

from __future__ import annotations

from dataclasses import dataclass, replace

from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.sensing.event import Event
from exactacq.sensing.map import Map
from exactacq.sensing.path import Piece
from exactacq.strategies.run import Run
from exactacq.visibility.isovist import Isovist


@dataclass(frozen=True)
class Snapshot:
    """How many whole pieces were walked, all of the way (the last perhaps in part), the map and the view."""

    count: int
    walked: tuple[Piece, ...]
    at: Length
    place: Point
    map: Map
    view: Isovist

    @classmethod
    def of(cls, run: Run, at: Event | object) -> Snapshot:
        """The moment of an event, or after a length of the path (see `Run.near`)."""
        if not isinstance(at, Event):
            at = run.near(at)
        count, place = run.moment(at)
        walked = tuple(run.path[:count])
        if place is not None:
            piece = run.path[count]
            walked += (replace(piece, curve=piece.curve.part(piece.start, place)),)
        here = walked[-1].end if walked else run.start
        length = Length.sum(piece.length for piece in walked)
        return cls(count, walked, length, here, run.map_at(at), run.view_at(at))
