"""Curves as floats: for drawing and for formats that know no exact numbers; nothing is decided here."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

SAMPLE = math.pi / 24
"""Angle between the points of an arc that show where it runs."""
FLAT = 1e6
"""An arc whose radius is so many lengths counts as straight: its centre is rounded by more than it bulges."""
Floats: TypeAlias = "NDArray[np.float64]"


@dataclass(frozen=True, slots=True)
class Stroke:
    """A curve in floats. An arc starts at ``angle`` (from its centre) and turns by ``sweep``, signed.

    Points of an arc are reckoned from its start, not its centre: nearly straight arcs lose no digits.
    """

    start: tuple[float, float]
    end: tuple[float, float]
    length: float
    center: tuple[float, float] | None = None
    radius: float = 0.0
    angle: float = 0.0
    sweep: float = 0.0

    def at(self, u: float) -> tuple[float, float]:
        """The point at the fraction *u* of the length; the ends are the curve's own."""
        if u in (0, 1):
            return self.end if u else self.start
        if self.center is None:
            return tuple(s + u * (e - s) for s, e in zip(self.start, self.end, strict=True))  # type: ignore[return-value]
        half = self.sweep * u / 2
        chord = 2 * self.radius * math.sin(half)
        return (
            self.start[0] - chord * math.sin(self.angle + half),
            self.start[1] + chord * math.cos(self.angle + half),
        )

    def heading(self, u: float) -> float:
        """Direction of travel, as an angle."""
        if self.center is None:
            return math.atan2(self.end[1] - self.start[1], self.end[0] - self.start[0])
        return self.angle + self.sweep * u + math.copysign(math.pi / 2, self.sweep)

    def steps(self, bend: float) -> int:
        """Into how many parts of at most *bend* the stroke falls; a straight one into one."""
        return max(1, math.ceil(abs(self.sweep) / bend - 1e-9))

    def points(self, count: int | None = None) -> Floats:
        """*count* + 1 points, ends included; by default enough to show where an arc runs."""
        count = count or self.steps(SAMPLE)
        return np.array([self.at(k / count) for k in range(count + 1)])

    def extremes(self) -> list[tuple[float, float]]:
        """The ends, and what an arc has of the westernmost, southernmost and such points of its circle.

        >>> half = Stroke((1.0, 0.0), (-1.0, 0.0), math.pi, (0.0, 0.0), 1.0, 0.0, math.pi)
        >>> half.extremes()
        [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0)]
        """
        found = [self.start, self.end]
        if self.center is not None and self.radius < FLAT * self.length:
            x, y = self.center
            for k, (u, v) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
                turned = (k * math.pi / 2 - self.angle) * math.copysign(1, self.sweep)
                if 0 < turned % (2 * math.pi) < abs(self.sweep):
                    found.append((x + u * self.radius, y + v * self.radius))
        return found

    def covers(self, points: Floats, headings: Floats, tolerance: float) -> Any:
        """Which of the points lie on this stroke and run along it, in either sense."""
        if self.center is None:
            offset, heading = points - np.array(self.start), self.heading(0)
            x, y = math.cos(heading), math.sin(heading)
            forward, aside = offset @ (x, y), offset @ (y, -x)
            parallel = np.abs(np.sin(headings - heading)) < 1e-6
            within = (forward > -tolerance) & (forward < self.length + tolerance)
            return (np.abs(aside) < tolerance) & within & parallel
        offset = points - np.array(self.center)
        turned = (np.arctan2(offset[:, 1], offset[:, 0]) - self.angle) * math.copysign(1, self.sweep)
        slack = tolerance / self.radius
        within = np.mod(turned + slack, 2 * math.pi) < abs(self.sweep) + 2 * slack
        return (np.abs(np.hypot(offset[:, 0], offset[:, 1]) - self.radius) < tolerance) & within
