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
    lying = [_by_edge(body) for body in bodies]
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
            track = _track(world, lying[i], piece.curve)
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
    found = world.blocker_between(curve)
    if found is not None:
        inside, point = found
        raise AuditError(f"piece {k} passes through the interior of obstacle {inside} at {place_text(point)}")


def _by_edge(body: AuditedBody) -> dict[int, list[Curve]]:
    """The curves of a boundary by the numbers of the scene's edges on which they lie."""
    found: dict[int, list[Curve]] = {}
    for e, curve in zip(body.edges, body.curves, strict=True):
        found.setdefault(e, []).append(curve)
    return found


def _track(world: World, lying: dict[int, list[Curve]], curve: Curve) -> Track | None:
    near = world.near(curve)
    for forward in (True, False):
        walked = curve if forward else curve.reversed()
        for e in near:
            if any(is_part(walked, part) for part in lying.get(e, ())):
                return Track(e, forward)
    return None


def check_length(run: Run) -> None:
    total = ball_sum([piece.curve for piece in run.path])
    if not agrees(run.length, total):
        decimals = total.str(20, radius=False)
        raise AuditError(
            f"the length is {run.length.decimal(20)}..., but the pieces add up to {decimals}... "
            f"(compared to {DIGITS} digits)"
        )
