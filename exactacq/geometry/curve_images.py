"""Curves as the compiled loops take them."""

from __future__ import annotations

from exactacq.geometry.curves import Curve, Segment
from exactacq.geometry.points import Point
from exactacq.kernel.clearance import Place
from exactacq.kernel.curve_images import CurveImage
from exactacq.numbers.float_bounds import float_ball, rough
from exactacq.numbers.rationals import nearest_float


def curve_image(curve: Curve) -> CurveImage:
    """A boundary edge or a straight way in floats."""
    if isinstance(curve, Segment):
        return CurveImage(*_pair(curve.start), *_pair(curve.end - curve.start), 0.0, 0, False)
    radius = nearest_float(curve.radius_sq) ** 0.5
    sense = 1 if curve.ccw else -1
    return CurveImage(*_pair(curve.center), *_pair(curve.start - curve.center), radius, sense, curve.full)


def held_point(point: Point) -> Place:
    """A point, or a vector, in floats with one bound for both coordinates; nothing late is made."""
    (x, p), (y, q) = float_ball(point.x), float_ball(point.y)
    return x, y, max(p, q)


def _pair(point: Point) -> tuple[float, float]:
    """The coordinates in floats (see `rough`)."""
    return rough(point.x), rough(point.y)
