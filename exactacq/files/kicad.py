"""The outline of a board from KiCad: lines, arcs and circles of the layer Edge.Cuts of a .kicad_pcb file.

Arcs go through three points of the file, so they are exact; footprints are placed by their position and
angle, which for angles that are no multiples of 90 degrees is a rational rotation near it. y goes up.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, TypeAlias

from flint import fmpq

from exactacq.errors import FormatError, about
from exactacq.files.loops.assembly import drawing_contents
from exactacq.files.loops.chains import Chain, Corner, scientific_above
from exactacq.files.loops.contents import Contents
from exactacq.files.loops.drawing import Drawing, LayerChoice
from exactacq.files.loops.rational_arcs import arc_around, rational_turn
from exactacq.files.source import MAX_EDGES, check_edges, one_line, read_text
from exactacq.numbers.atoms import rational_sqrt
from exactacq.numbers.rationals import rational
from exactacq.scene.bends import center_through
from exactacq.scene.shapes import Circle

EDGES = "Edge.Cuts"
"""The layer that is read by default."""
MAX_TOKENS = 40 * MAX_EDGES
"""Most words and parentheses of a file: parsing takes about 100 bytes for each."""
MAX_DEPTH = 64
"""Deepest nesting of lists."""
_TOKEN = re.compile(r'\s*(?:([()])|"((?:[^"\\]|\\.)*+)"|([^\s()"]+))', re.DOTALL)
Item: TypeAlias = "str | list[Any]"
Pair: TypeAlias = "tuple[fmpq, fmpq]"


def load_kicad(
    path: Path,
    start: Pair | None,
    layers: Iterable[str] | None = None,
    *,
    outer: str = "wall",
    tolerance: fmpq | None = None,
    union: bool = False,
    thicken: fmpq | None = None,
) -> Contents:
    """The loops of a board: its outline is the wall around the start, its cut-outs are obstacles.

    *layers* are those of graphics to be read, Edge.Cuts by default. The other options are those of
    `drawing_contents`. Raises `FormatError`. Linear in the file.
    """
    board = _parsed(read_text(path))
    if not board or board[0] != "kicad_pcb":
        raise FormatError("not a board of KiCad; give a .kicad_pcb file")
    choice = LayerChoice([EDGES] if layers is None else layers)
    reader = _BoardReader(choice)
    for item in _lists(board):
        if item[0] in ("footprint", "module"):
            reader.footprint(item)
        else:
            reader.graphic(item, "gr_", _Place())
    choice.check(reader.drawing)
    if reader.error:
        far = scientific_above(reader.error)
        reader.drawing.notes.append(f"rotated footprints by rational rotations, off by at most {far} radians")
    return drawing_contents(
        reader.drawing, path.stem, start, outer=outer, tolerance=tolerance, union=union, thickness=thicken
    )


def _parsed(text: str) -> list[Item]:
    """The outermost list of a text of lists in parentheses; `FormatError` for what is none."""
    top: list[Item] = []
    stack, place, count = [top], 0, 0
    while (match := _TOKEN.match(text, place)) is not None:
        place, count = match.end(), count + 1
        if count > MAX_TOKENS:
            raise FormatError(f"more than {MAX_TOKENS} words; give a smaller board")
        if match[1] == "(":
            if len(stack) > MAX_DEPTH:
                raise FormatError(f"lists are nested more than {MAX_DEPTH} deep; save the board again")
            inner: list[Item] = []
            stack[-1].append(inner)
            stack.append(inner)
        elif match[1] == ")":
            stack.pop()
            if not stack:
                raise FormatError(f"line {_line(text, place)}: a parenthesis too many; save the board again")
        else:
            stack[-1].append(match[3] if match[2] is None else match[2])
    if text[place:].strip() or len(stack) > 1 or len(top) != 1 or isinstance(top[0], str):
        raise FormatError(f"line {_line(text, place)}: the lists do not end well; save the board again")
    return top[0]


def _line(text: str, place: int) -> int:
    return text.count("\n", 0, place) + 1


def _lists(item: list[Item]) -> Iterator[list[Item]]:
    """The lists in a list that begin with a word."""
    return (part for part in item if isinstance(part, list) and part and isinstance(part[0], str))


class _Place:
    """Where a footprint lies: its position, and the rotation about it; y goes up."""

    def __init__(self, at: tuple[fmpq, fmpq] = (fmpq(0), fmpq(0)), degrees: fmpq | None = None) -> None:
        self.at = at
        self.turn, self.error = rational_turn(fmpq(0) if degrees is None else degrees)

    def __call__(self, x: fmpq, y: fmpq) -> Pair:
        """A point of the file, whose y goes down and whose angles are counterclockwise as seen."""
        cosine, sine = self.turn
        return self.at[0] + x * cosine + y * sine, -(self.at[1] - x * sine + y * cosine)


class _BoardReader:
    """The graphics of a board, one by one, into a drawing."""

    def __init__(self, choice: LayerChoice) -> None:
        self.drawing, self.choice = Drawing(), choice
        self.order = self.edges = 0
        self.error = fmpq(0)

    def footprint(self, item: list[Item]) -> None:
        """The graphics of a footprint, at its place."""
        at = next((part[1:] for part in _lists(item) if part[0] == "at"), ["0", "0"])
        with about(one_line(f"footprint {item[1] if item[1:] and isinstance(item[1], str) else ''}")):
            numbers = [_rational(value) for value in at if value != "unlocked"]
            if len(numbers) not in (2, 3):
                raise FormatError(f"at: two or three numbers are needed, not {len(numbers)}")
            place = _Place((numbers[0], numbers[1]), numbers[2] if numbers[2:] else None)
            for part in _lists(item):
                self.graphic(part, "fp_", place)

    def graphic(self, item: list[Item], prefix: str, place: _Place) -> None:
        """A graphic whose word begins so; anything else is passed over."""
        kind = str(item[0])
        layer = next((part[1] for part in _lists(item) if part[0] == "layer" and part[1:]), None)
        if not kind.startswith(prefix) or not isinstance(layer, str):
            return
        self.order += 1
        self.drawing.layers[layer] += 1
        if not self.choice.take(layer):
            return
        read = {
            "line": self._line, "arc": self._arc, "circle": self._circle,
            "rect": self._rect, "poly": self._poly,
        }.get(kind.removeprefix(prefix))  # fmt: skip
        if read is None:
            self.drawing.dropped[kind] += 1
            return
        self.error = max(self.error, place.error)
        with about(f"{kind} {self.order}"):
            read(item, place, f"{kind} {self.order}")

    def _add(self, corners: list[Corner], label: str, closed: bool = False) -> None:
        chain = Chain(label, corners, self.order, closed)
        self.edges += chain.edges
        check_edges(self.edges)
        self.drawing.chains.append(chain)

    def _line(self, item: list[Item], place: _Place, label: str) -> None:
        self._add([Corner(*place(*_pair(item, key)), fmpq(0)) for key in ("start", "end")], label)

    def _arc(self, item: list[Item], place: _Place, label: str) -> None:
        if not any(part[0] == "mid" for part in _lists(item)):
            raise FormatError("an arc without a middle, as before KiCad 6; save the board by a newer KiCad")
        start, middle, end = (place(*_pair(item, key)) for key in ("start", "mid", "end"))
        self._add(_arc_corners(start, middle, end), label)

    def _circle(self, item: list[Item], place: _Place, label: str) -> None:
        center, end = place(*_pair(item, "center")), place(*_pair(item, "end"))
        dx, dy = end[0] - center[0], end[1] - center[1]
        radius = rational_sqrt(dx * dx + dy * dy)
        if radius:
            self.drawing.circles.append((self.order, Circle(center, radius, label)))
        elif radius is None:
            halves = [Corner(center[0] + s * dx, center[1] + s * dy, fmpq(1)) for s in (1, -1)]
            self._add(halves, label, closed=True)
        else:
            self.drawing.dropped["circle of no radius"] += 1

    def _rect(self, item: list[Item], place: _Place, label: str) -> None:
        (x, y), (u, v) = _pair(item, "start"), _pair(item, "end")
        corners = [Corner(*place(*corner), fmpq(0)) for corner in ((x, y), (u, y), (u, v), (x, v))]
        self._add(corners, label, closed=True)

    def _poly(self, item: list[Item], place: _Place, label: str) -> None:
        """Points, and arcs by three points, which begin where what is before them ends."""
        rows = next((list(_lists(part)) for part in _lists(item) if part[0] == "pts"), [])
        corners: list[Corner] = []
        for row in rows:
            if row[0] == "arc":
                piece = _arc_corners(*(place(*_pair(row, key)) for key in ("start", "mid", "end")))
                same = bool(corners) and (corners[-1].x, corners[-1].y) == (piece[0].x, piece[0].y)
                corners[len(corners) - same :] = piece
            elif row[0] == "xy":
                corners.append(Corner(*place(*_numbers(row)), fmpq(0)))
        if len(corners) > 1:
            self._add(corners, label, closed=True)


def _arc_corners(start: Pair, middle: Pair, end: Pair) -> list[Corner]:
    """An open chain through three points: an arc, straight if they lie on a line, or a full circle."""
    if start == end:
        if middle == start:
            return [Corner(*start, fmpq(0)), Corner(*end, fmpq(0))]
        return [Corner(*start, fmpq(1)), Corner(*middle, fmpq(1)), Corner(*end, fmpq(0))]
    around = center_through(start, middle, end)
    first = Corner(*start, fmpq(0)) if around is None else arc_around(start, end, around.center, around.ccw)
    return [first, Corner(*end, fmpq(0))]


def _pair(item: list[Item], key: str) -> Pair:
    found = next((part for part in _lists(item) if part[0] == key), None)
    if found is None:
        raise FormatError(f"it has no {key}")
    return _numbers(found)


def _numbers(row: list[Item]) -> Pair:
    if len(row) < 3:
        raise FormatError(f"{row[0]}: two numbers are needed, not {len(row) - 1}")
    return _rational(row[1]), _rational(row[2])


def _rational(value: Item) -> fmpq:
    return rational(value if isinstance(value, str) else "a list")
