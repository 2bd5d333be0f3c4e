"""Boxes in floats around known pieces of boundaries: for filters, which are padded where that matters."""

from __future__ import annotations

from collections.abc import Sequence

from exactacq.geometry.curves import Curve, Segment


def hull(curve: Curve) -> tuple[float, ...]:
    """A box around a curve, of an arc around its circle."""
    if isinstance(curve, Segment):
        (a, b), (c, d) = curve.start.xy, curve.end.xy
        return min(a, c), min(b, d), max(a, c), max(b, d)
    (x, y), r = curve.center.xy, float(curve.radius) * (1 + 1e-12)
    return x - r, y - r, x + r, y + r


def overlap(a: Sequence[float], b: Sequence[float]) -> bool:
    """Whether two boxes meet."""
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]
