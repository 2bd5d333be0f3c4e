"""Areas from well-known text (WKT, and EWKT with its SRID): polygons, and curves with their arcs kept.

POLYGON, MULTIPOLYGON, CURVEPOLYGON, MULTISURFACE, TRIANGLE, collections of them, and closed lines and curves
are read. An arc of a CIRCULARSTRING goes through three points of the file, so it is exact; if its ends are
equal, the third point is opposite and the arc a full circle. Other lines and points are left out and counted.
Heights (Z) and measures (M) are left out. A file may hold any number of geometries, one after the other.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.loops.areas import Areas, Row, is_rounded
from exactacq.files.loops.contents import Contents
from exactacq.files.source import MAX_EDGES, one_line, read_text
from exactacq.numbers.rationals import rational
from exactacq.scene.bends import Via

MAX_COMMAS = 4 * MAX_EDGES
"""A vertex brings at most two commas (an arc has two points): a file of more is no scene that is taken."""
MAX_TOKENS = 20 * MAX_EDGES
"""Most words, numbers and signs of a file."""
MAX_DEPTH = 16
"""Deepest nesting of collections that is followed."""
_TOKEN = re.compile(r"\s*(?:([A-Za-z]+)|([-+.\d][^\s(),;]*)|([(),;=]))")
_STRAIGHT, _ROUND = ("LINESTRING", "LINEARRING"), ("CIRCULARSTRING", "COMPOUNDCURVE")
_POLYGONS = ("POLYGON", "TRIANGLE", "CURVEPOLYGON")
_LISTS = ("MULTIPOLYGON", "MULTISURFACE", "MULTICURVE", "MULTILINESTRING", "GEOMETRYCOLLECTION")
_MEMBERS = {"MULTIPOLYGON": "POLYGON", "MULTISURFACE": "POLYGON"}
"""What a member of a list is that does not say."""


def load_wkt(path: Path, start: tuple[fmpq, fmpq] | None, *, union: bool = False) -> Contents:
    """The areas in a WKT file, around the start: see `exactacq.files.loops.areas`.

    Raises `FormatError` with the place in the file. Linear in the file.
    """
    text = read_text(path)
    if text.count(",") > MAX_COMMAS:
        raise FormatError(f"more than {MAX_EDGES} edges; give a smaller part")
    return wkt_areas(text).contents(path.stem, start, union=union)


def wkt_areas(text: str) -> Areas:
    """The areas in a text; `FormatError` for what is no WKT."""
    reader = _WktReader(text)
    while reader.kind:
        if reader.word == "SRID":
            for expected in ("SRID", "=", None, ";"):
                reader.take(expected)
        else:
            reader.geometry(0, None)
            if reader.word == ";":
                reader.take(";")
    return reader.areas


class _WktReader:
    """One pass over the tokens; ``word`` is the next one, in upper case, of a ``kind``: "" at the end."""

    def __init__(self, text: str) -> None:
        self.text, self.areas, self.count, self.tokens = text, Areas(), 0, 0
        self.place, self.end, self.kind, self.word = 0, 0, "", ""
        self._next()

    def _next(self) -> None:
        match = _TOKEN.match(self.text, self.end)
        if match is None:
            self.place = self.end + len(self.text[self.end :]) - len(self.text[self.end :].lstrip())
            self.kind, self.word = "", ""
            if self.place < len(self.text):
                self.refuse("a geometry")
            return
        self.tokens += 1
        if self.tokens > MAX_TOKENS:
            self.reject(f"more than {MAX_TOKENS} words before this; give a smaller part")
        self.kind = ("", "word", "number", "sign")[match.lastindex or 0]
        self.word = match[match.lastindex or 0].upper()
        self.place, self.end = match.start(match.lastindex or 0), match.end()

    def refuse(self, needed: str) -> NoReturn:
        """`FormatError` that something else than the next token is needed."""
        rest = self.text[self.place : self.place + 20]
        self.reject(f"{needed} is needed, not {one_line(repr(rest)) if rest else 'the end'}")

    def reject(self, reason: str) -> NoReturn:
        """`FormatError` with the place of the next token."""
        line = self.text.count("\n", 0, self.place) + 1
        column = self.place - self.text.rfind("\n", 0, self.place)
        raise FormatError(f"line {line}, column {column}: {reason}")

    def take(self, expected: str | None) -> str:
        """The next token, which has to be the expected one, or with None a number."""
        if self.kind != "number" if expected is None else self.word != expected:
            self.refuse("a number" if expected is None else repr(expected))
        word = self.word
        self._next()
        return word

    def geometry(self, depth: int, member: str | None) -> None:
        """One geometry; *member* is its kind if it begins with a parenthesis."""
        if depth > MAX_DEPTH:
            self.reject(f"collections are nested more than {MAX_DEPTH} deep")
        kind = self._kind() if self.kind == "word" and self.word != "EMPTY" else member
        if kind is None:
            self.refuse("a geometry such as POLYGON")
        if self.word == "EMPTY":
            self.take("EMPTY")
        elif kind in _POLYGONS:
            self.count += 1
            holes = -1
            for _ in self._listed():
                holes += 1
                name = f"polygon {self.count}" + (f", hole {holes}" if holes else "")
                self.areas.add(self._curve("LINESTRING"), name)
        elif kind in _STRAIGHT or kind in _ROUND:
            rows = self._curve(kind)
            if rows[0][:2] == rows[-1][:2] or is_rounded(rows):
                self.count += 1
                self.areas.add(rows, f"loop {self.count}")
            else:
                self.areas.leave_out(f"open {kind}")
        elif kind in _LISTS:
            for _ in self._listed():
                self.geometry(depth + 1, _MEMBERS.get(kind, "LINESTRING" if kind[:5] == "MULTI" else None))
        else:
            for _ in self._listed():  # the places of points, each perhaps in parentheses
                if self.word == "(":
                    self._places()
                else:
                    self._place()
            self.areas.leave_out(kind)

    def _kind(self) -> str:
        """The kind of geometry that begins here, without what it says of heights and measures."""
        kind, known = self.word, (*_STRAIGHT, *_ROUND, *_POLYGONS, *_LISTS, "POINT", "MULTIPOINT")
        forms = (kind.removesuffix(dimensions) for dimensions in ("ZM", "Z", "M", ""))
        bare = next((form for form in forms if form in known), None)
        if bare is None:
            self.refuse("a geometry such as POLYGON")
        self._next()
        if self.word in ("Z", "M", "ZM"):
            self._next()
        return bare

    def _listed(self) -> Iterator[None]:
        """Enter parentheses; once for each member between commas."""
        self.take("(")
        yield
        while self.word == ",":
            self.take(",")
            yield
        self.take(")")

    def _curve(self, kind: str, piece: bool = False) -> list[Row]:
        """A curve from its start to its end, or a piece of one; the last row's bend says nothing."""
        if self.kind == "word":
            kind = self._kind()
        if kind == "COMPOUNDCURVE" and not piece:
            rows: list[Row] = []
            for _ in self._listed():
                more = self._curve("LINESTRING", piece=True)
                if rows and rows[-1][:2] != more[0][:2]:
                    self.reject("the piece before this does not begin where the one before it ends")
                rows[-1:] = more
            return rows
        if kind not in (*_STRAIGHT, "CIRCULARSTRING"):
            self.reject(f"a line or an arc is needed, not a {kind}")
        places = self._places()
        if kind != "CIRCULARSTRING":
            return [(x, y, fmpq(0)) for x, y in places]
        if len(places) < 3 or len(places) % 2 == 0:
            self.reject(f"a CIRCULARSTRING has 3, 5, 7 ... points, not {len(places)} as the one before this")
        arcs = [(*places[i], Via(places[i + 1])) for i in range(0, len(places) - 1, 2)]
        return [*arcs, (*places[-1], fmpq(0))]

    def _places(self) -> list[tuple[fmpq, fmpq]]:
        return [self._place() for _ in self._listed()]

    def _place(self) -> tuple[fmpq, fmpq]:
        """Two coordinates; one or two further ones are left out."""
        numbers = []
        while self.kind == "number":
            try:
                numbers.append(rational(self.word))
            except FormatError:
                self.refuse("a number")
            self._next()
        if not 2 <= len(numbers) <= 4:
            self.reject(f"a point has two to four numbers, not {len(numbers)} as the one before this")
        self.areas.flattened |= len(numbers) > 2
        return numbers[0], numbers[1]
