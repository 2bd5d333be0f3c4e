"""The path data of SVG: subpaths of lines and circular arcs, in the numbers of the file."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import NoReturn

from flint import fmpq

from exactacq.errors import CurvesRefused, FormatError
from exactacq.files.loops.chains import ZERO, Corner, root_above
from exactacq.files.loops.rational_arcs import arc_of_radius, rational_turn
from exactacq.files.repairs.bezier import BezierPiece, arc_pieces, polynomial
from exactacq.files.repairs.flattened import BY_ARCS
from exactacq.files.source import MAX_EDGES, one_line
from exactacq.files.svg.transforms import NUMBER
from exactacq.numbers.rationals import rational

Pair = tuple[fmpq, fmpq]
_GAP = re.compile(r"[\s,]*")
_COMMAND, _FLAG, _NUMBER = re.compile(r"[A-Za-z]"), re.compile(r"[01]"), re.compile(NUMBER, re.ASCII)
_ARGUMENTS = {
    "M": "nn", "L": "nn", "H": "n", "V": "n", "Z": "", "A": "nnnffnn",
    "C": "nnnnnn", "S": "nnnn", "Q": "nnnn", "T": "nn",
}  # fmt: skip
_CURVES = {"C": "cubic Bézier", "S": "cubic Bézier", "Q": "quadratic Bézier", "T": "quadratic Bézier"}


@dataclass(slots=True)
class DrawnCurve:
    """A Bézier curve or an arc of an ellipse as joined pieces, and how far these are from it at most.

    *turned* bounds by how many radians the axes of an ellipse are off.
    """

    kind: str
    pieces: list[BezierPiece]
    error: fmpq = ZERO
    turned: fmpq = ZERO


@dataclass(slots=True)
class Subpath:
    """Corners, each with the edge that follows; the last one's says nothing if the subpath stays open."""

    corners: list[Corner] = field(default_factory=list)
    closed: bool = False
    curves: dict[int, DrawnCurve] = field(default_factory=dict)
    """The edges that are no arcs, by the numbers of their corners."""

    def close(self) -> None:
        """An edge to the first corner, but none of no length: programs draw the last edge and close, too."""
        self.closed = True
        first, last = self.corners[0], self.corners[-1]
        if len(self.corners) > 2 and (first.x, first.y) == (last.x, last.y):
            self.corners.pop()

    def line(self, end: Pair) -> None:
        """A straight edge to a point."""
        self.corners.append(Corner(*end, fmpq(0)))

    def arc(self, edge: Corner, end: Pair) -> None:
        """An edge that the last corner is to have, to a point."""
        self.corners[-1] = edge
        self.line(end)

    def curve(self, edge: DrawnCurve, end: Pair) -> None:
        """An edge of another kind, to a point."""
        self.curves[len(self.corners) - 1] = edge
        self.line(end)


def oval_arc(start: Corner, end: Corner) -> DrawnCurve:
    """The arc from a corner to the next one, for a map that makes it elliptical.

    Its pieces have a rational bulge, which moves no point by more than the error, see
    `exactacq.files.loops.chains`.
    """
    a, b = (start.x, start.y), (end.x, end.y)
    chord = root_above((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2)
    return DrawnCurve("elliptical arc", arc_pieces(a, b, start.bulge), chord * start.bulge_shift / 2)


def subpaths(data: str, curved: bool = False) -> list[Subpath]:
    """The subpaths of path data; `FormatError` for what is no path, and for other curves unless *curved*."""
    return _PathReader(data, curved).read()


class _PathReader:
    """One pass over the data, from command to command."""

    def __init__(self, data: str, curved: bool) -> None:
        self.data, self.place, self.curved = data, 0, curved
        self.control: tuple[int, Pair] | None = None
        self.found: list[Subpath] = []
        self.here = self.first = (fmpq(0), fmpq(0))
        self.edges = 0

    def read(self) -> list[Subpath]:
        """All subpaths that have an edge."""
        command = ""
        while not self._at_end():
            letter = self._next(_COMMAND)
            if letter:
                command = letter
            elif not command or command in "Zz":
                self._refuse("a command")
            self._step(command)
            command = {"M": "L", "m": "l"}.get(command, command)
        return [subpath for subpath in self.found if len(subpath.corners) > 1]

    def _step(self, command: str) -> None:
        kind, relative = command.upper(), command.islower()
        if kind in _CURVES and not self.curved:
            raise CurvesRefused(
                f"a {_CURVES[kind]} curve is not read: replace it by lines and arcs, or have it {BY_ARCS}"
            )
        if kind not in _ARGUMENTS:
            self._refuse(f"a command other than {command}")
        given = [self._argument(which) for which in _ARGUMENTS[kind]]
        if not self.found and kind != "M":
            self._refuse("a path that begins with M")
        before, self.control = self.control, None
        self.edges += 1
        if self.edges > MAX_EDGES:
            raise FormatError(f"a path of more than {MAX_EDGES} edges; export only the part that matters")
        x, y = self.here if relative else (fmpq(0), fmpq(0))
        if kind == "Z":
            self.found[-1].close()
            self.here = self.first
            self.found.append(Subpath([Corner(*self.first, fmpq(0))]))
            return
        end = {
            "H": lambda: (x + given[0], self.here[1]),
            "V": lambda: (self.here[0], y + given[0]),
        }.get(kind, lambda: (x + given[-2], y + given[-1]))()
        if kind == "M":
            self.first = end
            self.found.append(Subpath([Corner(*end, fmpq(0))]))
        elif kind in _CURVES:
            points = [(x + u, y + v) for u, v in zip(given[::2], given[1::2], strict=True)]
            self._bezier(kind, points, before)
        elif kind == "A" and end != self.here:
            self._arc(end, given)
        elif kind != "A":
            self.found[-1].line(end)
        self.here = end

    def _bezier(self, kind: str, points: list[Pair], before: tuple[int, Pair] | None) -> None:
        """A Bézier curve; S and T begin with the control point before, mirrored in the place reached."""
        degree, here = 3 if kind in "CS" else 2, self.here
        if kind in "ST":
            last = before[1] if before is not None and before[0] == degree else here
            points = [(2 * here[0] - last[0], 2 * here[1] - last[1]), *points]
        self.found[-1].curve(DrawnCurve("Bézier curve", [polynomial([here, *points])]), points[-1])
        self.control = degree, points[-2]

    def _elliptical(self, end: Pair, given: list[fmpq]) -> None:
        """An arc of an ellipse: where its axes are turned upright and scaled, it is one of a circle."""
        across, along, degrees, large, sweep = given[:5]
        (cosine, sine), off = rational_turn(degrees)
        a, b = abs(across), abs(along)
        ends = [((x * cosine + y * sine) / a, (y * cosine - x * sine) / b) for x, y in (self.here, end)]
        edge = arc_of_radius(ends[0], ends[1], fmpq(1), bool(large), bool(sweep))
        axes = (a * cosine, a * sine), (-b * sine, b * cosine)
        drawn = oval_arc(edge, Corner(*ends[1], ZERO))
        moved = [piece.image((ZERO, ZERO), *axes) for piece in drawn.pieces]
        self.found[-1].curve(DrawnCurve(drawn.kind, moved, max(a, b) * drawn.error, off), end)

    def _arc(self, end: Pair, given: list[fmpq]) -> None:
        across, along, _, large, sweep = given[:5]
        if across and along and abs(across) != abs(along):
            if self.curved:
                self._elliptical(end, given)
                return
            raise CurvesRefused(
                "an elliptical arc (A of two radii) is not read: replace it by circular ones, or have it "
                f"{BY_ARCS}"
            )
        if not (across and along):
            self.found[-1].line(end)
            return
        edge = arc_of_radius(self.here, end, abs(across), bool(large), bool(sweep))
        self.found[-1].arc(edge, end)

    def _argument(self, which: str) -> fmpq:
        text = self._next(_FLAG if which == "f" else _NUMBER)
        if text is None:
            self._refuse("a flag, 0 or 1," if which == "f" else "a number")
        return rational(text)

    def _next(self, pattern: re.Pattern[str]) -> str | None:
        self._at_end()
        match = pattern.match(self.data, self.place)
        if match is None:
            return None
        self.place = match.end()
        return match[0]

    def _at_end(self) -> bool:
        gap = _GAP.match(self.data, self.place)
        self.place = gap.end() if gap else self.place
        return self.place >= len(self.data)

    def _refuse(self, needed: str) -> NoReturn:
        rest = self.data[self.place : self.place + 20]
        found = one_line(repr(rest)) if rest else "the end"
        raise FormatError(f"path data: {needed} is needed at character {self.place + 1}, not {found}")
