"""SVG drawings: the lines of paths and basic shapes become loops, as in other drawings; y goes up.

Lines and circular arcs are read, through nested groups and their transforms; what is filled or how lines are
drawn does not matter. Ellipses and Bézier curves are refused by name, or arcs stand for them. Numbers are the
decimals of the file. The drawing is mirrored in the middle of its viewBox, so that it fills the same box with
y going up; without a viewBox in half its height, or in y = 0. Names of layers are the labels and ids of
groups and elements.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.parsers import expat

from flint import fmpq

from exactacq.errors import FormatError, about
from exactacq.files.loops.assembly import drawing_contents
from exactacq.files.loops.chains import Chain, Corner, root_above, scientific_above
from exactacq.files.loops.contents import Contents
from exactacq.files.loops.drawing import Drawing, LayerChoice
from exactacq.files.loops.rational_arcs import arc_around
from exactacq.files.repairs.flattened import Flattening
from exactacq.files.source import MAX_EDGES, check_edges, one_line, read_bytes
from exactacq.files.svg.path_data import DrawnCurve, Subpath, oval_arc, subpaths
from exactacq.files.svg.transforms import ZERO, Matrix, number, numbers, transform
from exactacq.numbers.atoms import rational_sqrt
from exactacq.scene.shapes import Circle

MAX_ELEMENTS = 4 * MAX_EDGES
"""Most elements of a file: each takes some microseconds."""
MAX_DEPTH = 64
"""Deepest nesting of elements that is followed."""
GROUPS = ("svg", "g", "a", "switch")
SHAPES = ("path", "rect", "circle", "ellipse", "line", "polyline", "polygon")
LEFT_OUT = ("use", "image", "text", "foreignObject", "symbol")
"""What is left out and counted; other elements, such as definitions, show nothing by themselves."""
_HIDDEN = re.compile(r"display\s*:\s*none")
Pair = tuple[fmpq, fmpq]


def load_svg(
    path: Path,
    start: Pair | None,
    layers: Iterable[str] | None = None,
    *,
    outer: str = "wall",
    tolerance: fmpq | None = None,
    union: bool = False,
    thicken: fmpq | None = None,
    flatten: fmpq | None = None,
) -> Contents:
    """The loops of an SVG drawing; *layers* are names of groups or elements, all by default.

    With *flatten* arcs stand for ellipses and Bézier curves, within that distance. The other options are
    those of `drawing_contents`. Raises `FormatError`. No entity is expanded and nothing
    outside the file is read.
    """
    reader = _SvgReader(LayerChoice(layers), None if flatten is None else Flattening(flatten))
    _parse(read_bytes(path), reader)
    drawing = reader.drawing
    reader.choice.check(drawing)
    drawing.notes += [] if reader.flattening is None else reader.flattening.notes()
    if reader.error:
        far = scientific_above(reader.error)
        drawing.notes.append(f"rotated by rational rotations, off by at most {far} radians in sum")
    return drawing_contents(
        drawing, path.stem, start, outer=outer, tolerance=tolerance, union=union, thickness=thicken
    )


def _parse(data: bytes, reader: _SvgReader) -> None:
    parser = expat.ParserCreate()
    parser.StartElementHandler = reader.begin
    parser.EndElementHandler = reader.end
    parser.EntityDeclHandler = reader.entity
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        reason = one_line(expat.errors.messages.get(error.code, error))
        raise FormatError(f"line {error.lineno}: not XML ({reason}); export the drawing again") from None
    except FormatError as error:
        raise FormatError(f"line {parser.CurrentLineNumber}: {error}") from None
    except (LookupError, ValueError) as error:  # an encoding that Python does not know
        raise FormatError(f"not XML ({one_line(error)}); save it as UTF-8") from None


@dataclass(slots=True)
class _OpenElement:
    """An open element: where its contents are drawn, and the names of the groups around."""

    matrix: Matrix
    layers: tuple[str, ...] = ()
    shown: bool = True


class _SvgReader:
    """The elements of a document, as they come."""

    def __init__(self, choice: LayerChoice, flattening: Flattening | None) -> None:
        self.drawing, self.choice, self.flattening = Drawing(), choice, flattening
        self.stack: list[_OpenElement] = []
        self.order = self.edges = self.elements = 0
        self.error = fmpq(0)

    def entity(self, name: str, *_: object) -> None:
        """Refuse the declaration of an entity: a few of them expand to gigabytes."""
        raise FormatError(f"it declares the entity {one_line(repr(name))}; save it without")

    def begin(self, tag: str, attributes: dict[str, str]) -> None:
        """An element begins."""
        kind = tag.removeprefix("svg:")
        self.elements += 1
        if self.elements > MAX_ELEMENTS:
            raise FormatError(f"more than {MAX_ELEMENTS} elements; export only the part that matters")
        if not self.stack:
            if kind != "svg":
                raise FormatError(f"not an SVG drawing, but one of {one_line(repr(tag))}")
            self.stack.append(_OpenElement(_upright(attributes)))
            return
        if len(self.stack) >= MAX_DEPTH:
            raise FormatError(f"elements are nested more than {MAX_DEPTH} deep; flatten the groups")
        outer = self.stack[-1]
        frame = _OpenElement(outer.matrix, outer.layers, outer.shown and kind in (*GROUPS, *SHAPES))
        self.stack.append(frame)
        if not outer.shown:
            return
        if kind in LEFT_OUT:
            self.drawing.dropped[kind] += 1
        if attributes.get("display") == "none" or _HIDDEN.search(attributes.get("style", "")):
            self.drawing.dropped["hidden element"] += frame.shown
            frame.shown = False
        if frame.shown:
            named = (attributes.get(key) for key in ("inkscape:label", "id"))
            frame.layers += tuple(name for name in named if name)
            with about(one_line(f"{kind} {attributes.get('id', '')}")):
                frame.matrix = outer.matrix.after(transform(attributes.get("transform", "")))
                if kind == "svg" and not {"viewBox", "x", "y"}.isdisjoint(attributes):
                    raise FormatError("a drawing within the drawing is not placed; take it out")
                if kind in SHAPES:
                    self._shape(kind, attributes, frame)

    def end(self, _: str) -> None:
        """An element ends."""
        self.stack.pop()

    def _shape(self, kind: str, attributes: dict[str, str], frame: _OpenElement) -> None:
        self.order += 1
        label = attributes.get("id") or f"{kind} {self.order}"
        self.drawing.layers[frame.layers[-1] if frame.layers else "without a name"] += 1
        if not self.choice.take(*(frame.layers or ("without a name",))):
            return
        if not frame.matrix.determinant:
            self.drawing.dropped[f"flattened {kind}"] += 1
            return
        self.error = max(self.error, frame.matrix.error)
        if kind == "path":
            found = subpaths(attributes.get("d", ""), curved=self.flattening is not None)
        elif kind in ("circle", "ellipse"):
            self._circle(kind, attributes, frame.matrix, label)
            return
        else:
            found = _basic(kind, attributes)
        for n, subpath in enumerate(found, 1):
            name = label if len(found) == 1 else f"{label}, part {n}"
            if self.flattening is None or not (subpath.curves or _made_oval(subpath, frame.matrix)):
                corners = _moved(subpath, frame.matrix)
            else:
                corners = self._flattened(subpath, frame.matrix)
            self._add(Chain(name, corners, self.order, subpath.closed))

    def _flattened(self, subpath: Subpath, matrix: Matrix) -> list[Corner]:
        """The corners where a matrix puts them, with arcs for the curves, and for arcs that it makes oval."""
        assert self.flattening is not None
        oval, frame = (
            _made_oval(subpath, matrix),
            (matrix(ZERO, ZERO), (matrix.a, matrix.b), (matrix.c, matrix.d)),
        )
        stretch = root_above(matrix.a**2 + matrix.b**2 + matrix.c**2 + matrix.d**2)
        moved = _moved(subpath, matrix, oval)
        count = len(moved) if subpath.closed else len(moved) - 1
        corners: list[Corner] = []
        run: list[DrawnCurve] = []
        for k in range(count):
            here, there = subpath.corners[k], subpath.corners[(k + 1) % len(moved)]
            curve = subpath.curves.get(k)
            if curve is None and here.bulge and oval:
                curve = oval_arc(here, there)
            if curve is None:
                corners.append(moved[k])
                continue
            run.append(curve)
            self.error = max(self.error, matrix.error + curve.turned)
            if k + 1 == count or not (k + 1 in subpath.curves or (oval and there.bulge)):
                pieces = [piece.image(*frame) for drawn in run for piece in drawn.pieces]
                error = max(drawn.error for drawn in run) * stretch
                corners += self.flattening.corners(curve.kind, pieces, error)[:-1]
                run = []
        return corners if subpath.closed else [*corners, moved[-1]]

    def _add(self, chain: Chain) -> None:
        self.edges += chain.edges
        check_edges(self.edges)
        self.drawing.chains.append(chain)

    def _circle(self, kind: str, attributes: dict[str, str], matrix: Matrix, label: str) -> None:
        x, y = (number(attributes.get(key, "0"), key) for key in ("cx", "cy"))
        radii = [number(attributes.get(k, "0"), k) for k in (("r",) if kind == "circle" else ("rx", "ry"))]
        round_one = radii[0] == radii[-1] and matrix.is_similar()
        if not round_one and self.flattening is None:
            raise FormatError(
                "an ellipse is not read: replace it by arcs, or have it read by arcs within a distance, "
                "with --flatten LENGTH"
            )
        if min(radii) <= 0:
            self.drawing.dropped[f"{kind} of no radius"] += 1
            return
        if not round_one:
            placed = matrix.after(Matrix(a=radii[0], d=radii[-1], e=x, f=y))
            unit = Subpath([Corner(fmpq(side), ZERO, fmpq(1)) for side in (1, -1)], closed=True)
            self._add(Chain(label, self._flattened(unit, placed), self.order, closed=True))
            return
        scale = rational_sqrt(matrix.a**2 + matrix.b**2)
        if scale is not None:
            self.drawing.circles.append((self.order, Circle(matrix(x, y), radii[0] * scale, label)))
            return
        halves = Subpath([Corner(x + r, y, fmpq(1)) for r in (radii[0], -radii[0])], closed=True)
        self._add(Chain(label, _moved(halves, matrix), self.order, closed=True))


def _upright(attributes: dict[str, str]) -> Matrix:
    """The mirror that makes y go up."""
    box = numbers(attributes.get("viewBox", ""), "viewBox")
    if len(box) == 4:
        return Matrix(d=fmpq(-1), f=2 * box[1] + box[3])
    try:
        return Matrix(d=fmpq(-1), f=number(attributes.get("height", "0"), "height"))
    except FormatError:
        return Matrix(d=fmpq(-1))


def _made_oval(subpath: Subpath, matrix: Matrix) -> bool:
    """Whether a matrix makes arcs of a subpath elliptical."""
    return any(c.bulge for c in subpath.corners) and not matrix.is_similar()


def _moved(subpath: Subpath, matrix: Matrix, oval: bool = False) -> list[Corner]:
    """The corners where a matrix puts them; `FormatError` for arcs made elliptical, if not *oval*."""
    sense = 1 if matrix.determinant > 0 else -1
    if not oval and _made_oval(subpath, matrix):
        raise FormatError(
            "its transform makes arcs elliptical, which are not read; apply another one, or have them read "
            "by arcs within a distance, with --flatten LENGTH"
        )
    return [
        Corner(
            *matrix(c.x, c.y),
            c.bulge * sense,
            fmpq(0),
            c.bulge_shift,
            None if c.center is None else matrix(*c.center),
        )
        for c in subpath.corners
    ]


def _basic(kind: str, attributes: dict[str, str]) -> list[Subpath]:
    """A line, polyline, polygon or rectangle, perhaps with round corners."""

    def said(key: str) -> fmpq:
        return number(attributes.get(key, "0"), key)

    if kind == "rect":
        return _rectangle(attributes, said)
    if kind == "line":
        places = [(said("x1"), said("y1")), (said("x2"), said("y2"))]
    else:
        flat = numbers(attributes.get("points", ""), "points")
        if len(flat) > 2 * MAX_EDGES:
            raise FormatError(f"more than {MAX_EDGES} edges; export only the part that matters")
        places = list(zip(flat[::2], flat[1::2], strict=False))
    if len(places) < 2:
        return []
    return [Subpath([Corner(x, y, fmpq(0)) for x, y in places], kind == "polygon")]


def _rectangle(attributes: dict[str, str], said: Any) -> list[Subpath]:
    x, y, width, height = said("x"), said("y"), said("width"), said("height")
    if width <= 0 or height <= 0:
        return []
    across = said("rx" if "rx" in attributes else "ry")
    along = said("ry" if "ry" in attributes else "rx")
    across, along = min(across, width / 2), min(along, height / 2)
    if across != along:
        raise FormatError("a rectangle with elliptical corners is not read; give it rx and ry alike")
    r, corners = across, []
    for cx, cy, dx, dy in (
        (x + width, y, -1, 1), (x + width, y + height, -1, -1), (x, y + height, 1, -1), (x, y, 1, 1),
    ):  # fmt: skip
        if not r:
            corners.append(Corner(cx, cy, fmpq(0)))
            continue
        first = (cx + dx * r, cy) if dx * dy < 0 else (cx, cy + dy * r)
        last = (cx, cy + dy * r) if dx * dy < 0 else (cx + dx * r, cy)
        corners += [arc_around(first, last, (cx + dx * r, cy + dy * r), True), Corner(*last, fmpq(0))]
    return [Subpath(corners, True)]
