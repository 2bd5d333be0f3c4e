"""The curves of a drawing that arcs are to stand for, flattened and counted: the option ``flatten``.

The curves are those that scenes do not have: ellipses and arcs of them, Bézier curves, splines.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from flint import fmpq

from exactacq.errors import FormatError, shown
from exactacq.files.counting import count
from exactacq.files.loops.chains import ZERO, Corner, root_above, scientific_above
from exactacq.files.loops.rational_arcs import arc_corners, nearly_pi
from exactacq.files.repairs.bezier import ONE, BezierPiece, Pair, arc_pieces
from exactacq.files.repairs.flatten import FlatChain, flatten

MAX_EDGES = 20_000
"""Most arcs and segments that stand for the curves of one file."""
MAX_MADE = 4_000
"""Most arcs and segments that are found: each takes some 2.5 milliseconds, and counts more where numbers are
long. Those of a curve that was there before, but for where it lies, as letters are, are only moved."""
LONG_BITS = 400
"""Numbers so long double the time for an arc."""
MAX_PART = 90
"""Degrees of an ellipse in one piece."""
DECIMALS = 10**10
"""Angles are rounded to such parts of a degree: doubles near multiples of 90 degrees become these."""


BY_ARCS = "read by arcs within a distance, with --flatten LENGTH"
"""What messages about curves that are not read propose, and notes about those that are left out."""


@dataclass(slots=True)
class Flattening:
    """How far curves and what stands for them may be apart, and what was flattened so far."""

    tolerance: fmpq
    curves: Counter[str] = field(default_factory=Counter)
    arcs: int = 0
    segments: int = 0
    made: int = 0
    """How many arcs and segments were found, and not moved from where a like curve lies; see `MAX_MADE`."""
    known: dict[tuple[object, ...], FlatChain] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.tolerance <= 0:
            raise FormatError(f"flatten: a length above 0 is needed, not {shown(self.tolerance)}")

    def corners(self, kind: str, pieces: Sequence[BezierPiece], error: fmpq = ZERO) -> list[Corner]:
        """The corners of an open chain within the tolerance of a curve; none for a curve that is a point.

        *error* bounds how far the pieces are from the curve already. Raises `FormatError` as `flatten`.
        """
        u, v = pieces[0].point(ZERO)
        chain = self._at_origin([piece.image((-u, -v), (ONE, ZERO), (ZERO, ONE)) for piece in pieces], error)
        self.curves[kind] += 1
        self.arcs += chain.arcs
        self.segments += len(chain.edges) - chain.arcs
        for number, most in ((self.arcs + self.segments, MAX_EDGES), (self.made, MAX_MADE)):
            if number > most:
                raise FormatError(f"flatten: more than {most} arcs; give a larger length, or one part")
        if chain.end is None:
            return []
        corners = [Corner(x + u, y + v, bulge) for x, y, bulge in chain.edges]
        return [*corners, Corner(chain.end[0] + u, chain.end[1] + v, ZERO)]

    def _at_origin(self, pieces: list[BezierPiece], error: fmpq) -> FlatChain:
        """The chain of a curve that begins at the origin."""
        key = (error, *(piece.rows for piece in pieces))
        if key not in self.known:
            self.known[key] = flatten(pieces, self.tolerance - error)
            bits = max(int(n.q).bit_length() for piece in pieces for row in piece.rows for n in row)
            self.made += len(self.known[key].edges) * (LONG_BITS + bits) // LONG_BITS
        return self.known[key]

    def notes(self) -> list[str]:
        """What to tell of it, with the bound."""
        if not self.curves:
            return []
        named = ", ".join(count(n, kind) for kind, n in self.curves.most_common())
        far = scientific_above(self.tolerance)
        return [
            f"flattened {named} into {count(self.arcs, 'arc')} and {count(self.segments, 'segment')}: "
            f"no point of either is farther than {far} from the other"
        ]


def ellipse(
    center: Pair, major: Pair, minor: Pair, start: fmpq, end: fmpq
) -> tuple[list[BezierPiece], bool, fmpq]:
    """The points center + major cos t + minor sin t from t = start to end (radians) as joined pieces.

    Also whether it is the whole ellipse (as in DXF, if both are one angle), and a bound of how far the pieces
    are from it: ends at multiples of 90 degrees are exact, others are rounded, see `arc_corners`.
    """
    degrees, rounded = [], fmpq(0)
    for angle in (start, end):
        exact = angle * 180 / nearly_pi()
        near = (exact * DECIMALS + fmpq(1, 2)).floor() / fmpq(DECIMALS)
        degrees.append(near)
        rounded = max(rounded, abs(near - exact) / 57 + abs(angle) / 2**100)
    first, included = degrees[0], degrees[1] - degrees[0]
    included -= (included / 360).floor() * 360
    whole = included == 0
    included = included or fmpq(360)
    parts = int((included / MAX_PART).ceil())
    pieces, error = [], fmpq(0)
    for k in range(parts):
        low, high = (first + included * i / parts for i in (k, k + 1))
        corners = arc_corners((fmpq(0), fmpq(0)), fmpq(1), low, high) or []
        a, b = corners
        error = max(error, a.shift + b.shift + a.bulge_shift)  # the chord is shorter than 2
        unit = arc_pieces((a.x, a.y), (b.x, b.y), a.bulge)
        pieces += [piece.image(center, major, minor) for piece in unit]
    stretch = root_above(major[0] ** 2 + major[1] ** 2 + minor[0] ** 2 + minor[1] ** 2)
    return pieces, whole, (error + rounded) * stretch
