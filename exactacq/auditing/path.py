"""The audit of a path: its pieces fit together, stay in free space or on boundaries, and add up."""

from __future__ import annotations

from collections.abc import Sequence

from exactacq.auditing.comparisons import (
    DIGITS,
    AuditedBody,
    Track,
    Tracks,
    agrees,
    ball_sum,
    is_part,
    place_text,
    same,
)
from exactacq.auditing.ground import Field
from exactacq.auditing.visibility import World
from exactacq.errors import AuditError
from exactacq.geometry.curves import Arc, Curve
from exactacq.progress import Meter
from exactacq.strategies.run import Run


def check_continuity(run: Run) -> None:
    here = run.start
    for k, piece in enumerate(run.path):
        if not same(piece.start, here):
            where = f"piece {k - 1} ends" if k else "the run starts"
            raise AuditError(
                f"piece {k} starts at {place_text(piece.start)}, but {where} at {place_text(here)}"
            )
        here = piece.end


def check_pieces(
    run: Run, world: World, bodies: Sequence[AuditedBody], field: Field | None, meter: Meter
) -> Tracks:
    """Straight pieces stay out of interiors, boundary pieces keep to one edge, which is returned.

    Of a sweep both stay in the terrain: boundaries are shores, and it is enough that ends do.
    """
    tracks: Tracks = []
    for k, piece in enumerate(run.path):
        i = piece.obstacle
        if (piece.kind, i is None) not in (("straight", True), ("boundary", False)):
            raise AuditError(f"piece {k} is {piece.kind!r} along {i}")
        track = None
        if i is None:
            _check_straight(world, k, piece.curve)
        elif i not in range(len(bodies)):
            raise AuditError(f"piece {k} is along obstacle {i}, which the scene does not have")
        else:
            track = _track(world, bodies[i], piece.curve)
            if track is None:
                raise AuditError(f"piece {k} does not lie on an edge of obstacle {i}")
        if field is not None and not (field.contains(piece.start) and field.contains(piece.end)):
            raise AuditError(f"piece {k} leaves the terrain")
        tracks.append(track)
        meter.add()
    return tracks


def _check_straight(world: World, k: int, curve: Curve) -> None:
    if isinstance(curve, Arc) or same(curve.start, curve.end):
        raise AuditError(f"piece {k} is straight, but not a segment longer than a point")
    near = world.near(curve)
    ends = (world.passing(place, near) for place in (curve.start, curve.end))
    found = world.blocker(curve.start, curve.direction, 1, near, *ends)
    if found is not None:
        inside, point = found
        raise AuditError(f"piece {k} passes through the interior of obstacle {inside} at {place_text(point)}")


def _track(world: World, body: AuditedBody, curve: Curve) -> Track | None:
    near = set(world.near(curve))
    some = [pair for pair in zip(body.edges, body.curves, strict=True) if pair[0] in near]
    for forward in (True, False):
        walked = curve if forward else curve.reversed()
        for number, edge in some:
            if is_part(walked, edge):
                return Track(number, forward)
    return None


def check_length(run: Run) -> None:
    total = ball_sum([piece.curve for piece in run.path])
    if not agrees(run.length, total):
        decimals = total.str(20, radius=False)
        raise AuditError(
            f"the length is {run.length.decimal(20)}..., but the pieces add up to {decimals}... "
            f"(compared to {DIGITS} digits)"
        )
