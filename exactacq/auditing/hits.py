"""Where rays meet edges and curves, in floats with bounds of their errors."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Bools: TypeAlias = NDArray[np.bool_]
Ints: TypeAlias = NDArray[np.intp]

EPS = 2.0**-48
"""Relative error of a product with an offset from q (rounded once: 2^-53) and a ray (2^-50), with room."""
TINY = 1e-290
"""Added to margins: covers what underflow loses."""


class HitDistances(NamedTuple):
    """Float bounds of the distances at which rays meet curves; arrays of shape (rays, columns).

    ``low`` is infinite where there is certainly no contact ahead; ``sure`` says that the curve is certainly
    crossed, between its ends, ahead.
    """

    low: Floats
    high: Floats
    sure: Bools


class Hits(NamedTuple):
    """`HitDistances` for curves of mixed kinds, with each column's ``curve``; ``far``: an arc's far root."""

    low: Floats
    high: Floats
    sure: Bools
    curve: Ints
    far: Bools


def cross(a: Floats, b: Floats) -> Floats:
    """The cross products of vectors in the last axis."""
    found: Floats = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return found


def _sides(units: Floats, places: Floats) -> tuple[Floats, Floats]:
    """The cross products of rays, in rows, and places, in columns, and margins of these."""
    left = np.stack((places[:, 1], -places[:, 0]))
    return units @ left, EPS * np.hypot(*places.T) + TINY


def surely_blocked(units: Floats, starts: Floats, ends: Floats) -> Floats:
    """The distance within which each ray certainly crosses one of some segments; infinite if none is sure."""
    (s, ds), (e, de) = _sides(units, starts), _sides(units, ends)
    rays, columns = np.nonzero(((s > ds) & (e < -de)) | ((s < -ds) & (e > de)))
    t, slack = _crossing(starts[columns], ends[columns], s[rays, columns], e[rays, columns])
    nearest = np.full(len(units), np.inf)
    np.minimum.at(nearest, rays, np.where(t > slack, t + slack, np.inf))
    return nearest


def segment_hits(units: Floats, starts: Floats, ends: Floats) -> HitDistances:
    """Where rays meet segments; most pairs are clear, as a segment lies on one side of the ray's line."""
    (s, ds), (e, de) = _sides(units, starts), _sides(units, ends)
    missed = ((s > ds) & (e > de)) | ((s < -ds) & (e < -de))
    pairs = np.nonzero(~missed)
    rays, columns = pairs
    some = _possible_hits(units[rays], starts[columns], ends[columns], s[pairs], e[pairs])
    found = HitDistances(
        np.full(missed.shape, np.inf), np.full(missed.shape, np.inf), np.zeros(missed.shape, dtype=bool)
    )
    for whole, part in zip(found, some, strict=True):
        whole[pairs] = part
    return found


def _crossing(starts: Floats, ends: Floats, s: Floats, e: Floats) -> tuple[Floats, Floats]:
    """How far rays go to the lines of segments, t = s x e / (u x e - u x s), and a bound of the error.

    *s* and *e* are u x s and u x e. If their margins overlap the bound is none.
    """
    a, b = np.hypot(*starts.T), np.hypot(*ends.T)
    rough = EPS * (a + b) + 2 * TINY
    with np.errstate(all="ignore"):
        t = cross(starts, ends) / (e - s)
        return t, (EPS * a * b + np.abs(t) * rough) / (np.abs(e - s) - rough) + TINY


def _possible_hits(units: Floats, starts: Floats, ends: Floats, s: Floats, e: Floats) -> HitDistances:
    """Where a ray meets a segment from s to e; for pairs of a ray and a segment.

    If one of the two signs of *s*, u x s, and *e*, u x e, is uncertain, the contact is near that end; if both
    are, anywhere between.
    """
    a, b = np.hypot(*starts.T), np.hypot(*ends.T)
    ds, de = EPS * a + TINY, EPS * b + TINY
    unsure_s, unsure_e = np.abs(s) <= ds, np.abs(e) <= de
    crossed = ~unsure_s & ~unsure_e
    t, slack = _crossing(starts, ends, s, e)
    with np.errstate(all="ignore"):
        chord = np.hypot(*(ends - starts).T) * (1 + EPS)
        near_s, near_e = 2 * ds * chord / (np.abs(e) - de), 2 * de * chord / (np.abs(s) - ds)
    # Where neither end is certain the segment points at q, or away from it.
    both = unsure_s & unsure_e
    at_s, at_e = unsure_s & ~both, unsure_e & ~both
    ahead_s, ahead_e = (units * starts).sum(axis=1) > 0, (units * ends).sum(axis=1) > 0
    facing = np.where(ahead_s & ahead_e, np.minimum(a, b) * (1 - EPS), 0.0)
    with np.errstate(invalid="ignore"):
        low = np.where(crossed, t - slack, np.where(at_s, a - near_s, np.where(at_e, b - near_e, facing)))
        high = np.where(crossed, t + slack, np.inf)
    gone = np.where(crossed, high < 0, np.where(at_s, ~ahead_s & (near_s < a / 2), False))
    gone |= (at_e & ~ahead_e & (near_e < b / 2)) | (both & ~ahead_s & ~ahead_e & (a > 0) & (b > 0))
    low = np.where(np.isnan(low), -np.inf, low)
    high = np.where(np.isnan(high), np.inf, high)
    return HitDistances(
        np.where(gone, np.inf, low), np.where(gone, np.inf, high), crossed & ~gone & (low > 0)
    )


def arc_hits(
    units: Floats, centers: Floats, shape: Floats, chords: tuple[Floats, Floats], own: Bools
) -> list[HitDistances]:
    """Where rays meet arcs, for the near and for the far roots t = u.c -+ sqrt(r^2 - (u x c)^2).

    A contact is on the arc if it lies on the arc's side of the chord. On an own circle the roots are 0,
    which is left out, and 2 u.c.
    """
    radius, sense, full = shape[:, 0], shape[:, 1], shape[:, 2] > 0
    starts, along = chords
    size = np.hypot(*centers.T) + radius
    b, h = units @ centers.T, cross(units[:, None], centers)
    error = 4 * EPS * size * size + TINY
    square = (radius - h) * (radius + h)
    real = square > error
    root = np.sqrt(np.maximum(square, 0.0))
    with np.errstate(all="ignore"):
        slack = np.where(real, error / root, np.sqrt(np.maximum(square, 0.0) + error)) + 4 * EPS * size
    if own.any():
        slack = np.where(own, 8 * EPS * size, slack)
    width, across = np.hypot(*along.T), cross(along, starts)
    turn, base = cross(along, units[:, None]), 4 * EPS * np.hypot(*starts.T)
    found = []
    for far in (False, True):
        t = np.where(real, b + (root if far else -root), b)
        if own.any():
            t = np.where(own, 2 * b, t)
        side = sense * (turn * t - across)
        margin = width * (slack + 4 * EPS * np.abs(t) + base) + TINY
        low, high = t - slack, t + slack
        beside = ~full & (side > margin)
        gone = (square < -error) | (high < 0) | beside
        if own.any():
            gone = np.where(own, (high < 0) | beside | (not far), gone)
        sure = (real | own) & (full | (side < -margin)) & (low > 0) & ~gone
        found.append(HitDistances(np.where(gone, np.inf, low), np.where(gone, np.inf, high), sure))
    return found
