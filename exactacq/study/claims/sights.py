"""Whether a map contains everything that a path shows, decided corner by corner with the audit's own code."""

from __future__ import annotations

from collections.abc import Iterator

from exactacq.auditing.places import point_at
from exactacq.auditing.visibility import visible
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import rational
from exactacq.strategies.run import Run
from exactacq.study.claims.model import Case

SHARES = (rational(0), rational("1/3"), rational("2/3"))
"""Where on each edge the map is asked: its start, and two places inside."""


def overlooked(case: Case, run: Run) -> str | None:
    """A boundary point that some corner of the path sees, but that is missing on the final map.

    Asks rational points of boundaries that the map does not know, and corners of the path with rational
    coordinates: exact where it asks, and cheap where the map is complete.
    """
    corners = [p for p in (run.start, *(piece.end for piece in run.path)) if p.rational is not None]
    for i, point in _unknown(run):
        for corner in corners:
            if visible(case.world, run.radius, corner, point):
                return f"{point} of obstacle {i} is visible from {corner} and not on the map"
    return None


def _unknown(run: Run) -> Iterator[tuple[int, Point]]:
    chart = run.map
    for i, body in enumerate(run.obstacles):
        if i in chart.acquired:
            continue
        for edge in body.edges:
            for share in SHARES:
                point = point_at(edge, share)
                if point is not None and point.rational is not None and not chart.knows(i, point):
                    yield i, point
