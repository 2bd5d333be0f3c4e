"""Float images of a scene's edges and of a family of lines, as the loops take them.

An exact coordinate is given as a float and the *rest* that the float leaves, itself rounded: their sum is off
by at most 2^-106 times the coordinate. So the difference of two coordinates is as good as its own size
allows, however far from the origin they are. For floats a, b with rests c, d, and m the float that is
computed, three roundings lose at most u (|a - b| + |c - d| + |m|), where |a - b| <= |m| (1 + 4 u) + |c - d|
and |c - d| <= u (|a| + |b|) (1 + u). With the errors of the rests that is at most 2^-52 |m| + 2^-103 (|a| +
|b|), up to the factor `WIDEN`.
"""

from __future__ import annotations

from typing import Final, final

STRAIGHT: Final = 0
CONVEX: Final = 1
CONCAVE: Final = -1
TURNING: Final = 0
ROLLING: Final = 1
SLIDING: Final = 2
SPOKES: Final = 3
REST: Final = 9.860761315262648e-32
"""2^-103: what coordinates with a rest lose, relative to their size."""


Held = tuple[float, float, float, float]
"""A point: x and what it leaves, y and what it leaves."""


@final
class EdgeImage:
    """An edge of a scene with the vertex at which it begins, of the same number; it ends at ``following``.

    ``kind`` is straight, convex or concave; centre and radius are those of an arc. A radius is held with the
    bound `UNIT` times itself.
    """

    def __init__(
        self, start: Held, center: Held, radius: float, kind: int, full: bool, following: int, previous: int
    ) -> None:
        self.x, self.x_rest, self.y, self.y_rest = start
        self.cx, self.cx_rest, self.cy, self.cy_rest = center
        self.radius, self.kind, self.full = radius, kind, full
        self.following, self.previous = following, previous

    def place(self) -> Held:
        """The vertex, as `LineFrame` takes it."""
        return self.x, self.x_rest, self.y, self.y_rest


@final
class LineFrame:
    """A family of lines (see `exactacq.visibility.line_families`), by the float images of its data.

    The centre comes with rests and the bound ``blur``. The base vector, held with one bound for both
    components, is given divided by ``unit``, a power of two, such that its length is about 1. The radius of
    an arc to which lines are normal is held with the bound `UNIT` times itself. ``sense`` is 1 or -1: of
    normals whether they go to the left of a segment, or outward from an arc.
    """

    def __init__(
        self,
        kind: int,
        center: tuple[float, float, float, float],
        blur: float,
        base: tuple[float, float, float],
        unit: float,
        radius: float,
        sense: int,
    ) -> None:
        self.kind = kind
        self.x, self.x_rest, self.y, self.y_rest = center
        self.blur = blur
        self.ux, self.uy, self.bound = base
        self.unit = unit
        self.radius = radius
        self.sense = sense
