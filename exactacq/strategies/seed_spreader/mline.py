"""The M-line of the Seed Spreader Strategy (paper, section 4): the path that it would take without obstacles.

It consists of lines from south to north, joined along the terrain's border.

The strips between them are w = min(R, B) wide, the last one perhaps narrower, where B is the terrain's
width. The lines lie at x_j = min(j w, B) from the terrain's west side, j = 0..r with r = ceil(B / R), and
are walked north for even j and south for odd j.
"""

from __future__ import annotations

from itertools import pairwise

from flint import fmpq

from exactacq.cached import cached_property
from exactacq.errors import InvalidScene
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real
from exactacq.scene.shapes import Terrain
from exactacq.scene.terrain_components import Component
from exactacq.strategies.seed_spreader.blocked import Blocking, Crossing
from exactacq.strategies.seed_spreader.range_thresholds import leftmost

MOST_STRIPS = 100_000
"""More would take days; a radius that small is most likely a slip."""


class MLine:
    """The straight pieces of the M-line, from S to T; every other one is a line, those between are joints.

    Raises `InvalidScene` for more than `MOST_STRIPS` strips.
    """

    def __init__(self, terrain: Terrain, radius: fmpq) -> None:
        b = terrain.width
        if b / radius > MOST_STRIPS:
            raise InvalidScene([f"the terrain is more than {MOST_STRIPS} times as wide as the radius"])
        self.terrain, self.width = terrain, min(radius, b)
        self.strips = int((b / radius).ceil())
        west, south, _, north = terrain.limits
        self.lines = [west + min(j * self.width, b) for j in range(self.strips + 1)]
        self.corners = [
            Point(x, north if (j + k) % 2 else south) for j, x in enumerate(self.lines) for k in (0, 1)
        ]
        self.pieces = [Segment(p, q) for p, q in pairwise(self.corners)]

    @property
    def length(self) -> fmpq:
        """(r + 1) A + B."""
        return (self.strips + 1) * self.terrain.height + self.terrain.width

    def strip(self, component: Component) -> int:
        """The number j = 1..r of the strip that a component lies in that does not cross the M-line."""
        left = min((leftmost(curve) for curve in component.edges), default=Real(self.lines[0]))
        return sum(left.compare(x) >= 0 for x in self.lines[:-1])

    @staticmethod
    def line(piece: int) -> int | None:
        """The number j of the line that a piece is; None for a joint."""
        return None if piece % 2 else piece // 2

    def position(self, piece: int, u: Real) -> Real:
        """The length of the M-line from S to a place."""
        return self._starts[piece] + u * self.pieces[piece].length.algebraic

    @cached_property
    def _starts(self) -> list[Real]:
        starts = [Real(0)]
        for piece in self.pieces:
            starts.append(starts[-1] + piece.length.algebraic)
        return starts

    def crossings(self, blocking: Blocking) -> list[Crossing]:
        """All crossing points of all components, in the order of the M-line."""
        return blocking.crossings(self.pieces)
