"""SVG drawings: the lines of paths and basic shapes become loops, as in other drawings; y goes up.

Lines and circular arcs are read, through nested groups and drawings, their transforms and viewBoxes, symbols
and ``use``; what is filled or how lines are drawn does not matter, and clips and masks are not applied.
Ellipses and Bézier curves are refused by name, or arcs stand for them. Numbers are the decimals of the file,
lengths with a unit are taken in pixels, 96 to the inch. The drawing is mirrored in the middle of its viewBox,
so that it fills the same box with y going up; without a viewBox in half its height, or in y = 0. Names of
layers are the labels and ids of groups and elements.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from flint import fmpq

from exactacq.errors import CurvesRefused, FormatError, about
from exactacq.files.counting import count
from exactacq.files.loops.assembly import drawing_contents
from exactacq.files.loops.chains import Chain, Corner, root_above, scientific_above
from exactacq.files.loops.contents import Contents
from exactacq.files.loops.drawing import Drawing, LayerChoice
from exactacq.files.loops.rational_arcs import arc_around
from exactacq.files.repairs.flattened import BY_ARCS, Flattening
from exactacq.files.source import MAX_BYTES, MAX_EDGES, check_edges, one_line, read_bytes
from exactacq.files.svg.document import MAX_DEPTH, MAX_ELEMENTS, Element, named, parse
from exactacq.files.svg.path_data import DrawnCurve, Subpath, oval_arc, subpaths
from exactacq.files.svg.transforms import ZERO, Matrix, numbers, transform
from exactacq.files.svg.viewports import Box, length, nested, outermost
from exactacq.numbers.atoms import rational_sqrt
from exactacq.scene.shapes import Circle

GROUPS = ("g", "a", "switch")
SHAPES = ("path", "rect", "circle", "ellipse", "line", "polyline", "polygon")
LEFT_OUT = ("image", "text", "foreignObject", "style")
"""What is left out and counted; other elements, such as definitions, show nothing by themselves."""
TERRAIN = "terrain"
"""The ``data-kind`` of the border of a terrain, as `exactacq.files.writing.svg` draws it: it is no wall."""
MAX_TEXT = MAX_BYTES
"""Most characters of attributes that are drawn: no file has more if none of its elements is used again."""
CONDITIONS = ("requiredExtensions", "requiredFeatures", "systemLanguage")
"""What asks a reader for something, as the elements in a ``switch`` do."""
CUTS = ("clip-path", "mask")
"""What hides parts of elements, which are read whole."""
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
    reader.read(parse(read_bytes(path)))
    drawing = reader.drawing
    reader.choice.check(drawing)
    drawing.notes += [] if reader.flattening is None else reader.flattening.notes()
    if reader.reused:
        drawing.notes.append(f"drew {count(reader.reused, 'element')} by use")
    if reader.error:
        far = scientific_above(reader.error)
        drawing.notes.append(f"rotated by rational rotations, off by at most {far} radians in sum")
    return drawing_contents(
        drawing, path.stem, start, outer=outer, tolerance=tolerance, union=union, thickness=thicken
    )


@dataclass(frozen=True, slots=True)
class _DrawnIn:
    """Where something is drawn: its matrix, the names of the groups around, the box of percentages."""

    matrix: Matrix
    box: Box | None
    layers: tuple[str, ...] = ()
    visible: bool = True
    depth: int = 0


class _SvgReader:
    """The shapes of a document, in the order in which they are drawn."""

    def __init__(self, choice: LayerChoice, flattening: Flattening | None) -> None:
        self.drawing, self.choice, self.flattening = Drawing(), choice, flattening
        self.named: dict[str, Element] = {}
        self.paths: dict[str, list[Subpath]] = {}
        self.order = self.edges = self.drawn = self.text = self.reused = 0
        self.error = fmpq(0)

    def read(self, root: Element) -> None:
        """All that a document shows."""
        self.named = named(root)
        with about(f"line {root.line}"):
            matrix, box = outermost(root.attributes)
        if root.style("transform") not in ("", "none"):
            self.drawing.dropped["transform of the whole drawing"] += 1
        for part in root.parts:
            self._draw(part, _DrawnIn(matrix, box))

    def _draw(self, element: Element, outer: _DrawnIn, size: dict[str, str] | None = None) -> None:
        """What an element shows in a frame; a ``use`` draws it with the *size* that it tells."""
        kind = element.kind
        self._count(element)
        if kind in LEFT_OUT or kind not in (*GROUPS, *SHAPES, "svg", "use", "symbol"):
            if kind in LEFT_OUT:
                self.drawing.dropped[kind] += 1
            return
        if kind == "symbol" and size is None:
            return
        with about(f"line {element.line}"):
            if outer.depth > MAX_DEPTH:
                raise FormatError(
                    f"uses are nested more than {MAX_DEPTH} deep (one in itself?); break them up"
                )
            frame = self._framed(element, outer, size or {})
            if frame is not None and kind in SHAPES:
                self._visible_shape(element, frame)
        if frame is None or kind in SHAPES:
            return
        if kind == "use":
            self._use(element, frame)
            return
        for part in self._chosen(element.parts) if kind == "switch" else element.parts:
            self._draw(part, frame)

    def _chosen(self, parts: list[Element]) -> list[Element]:
        """Of what a ``switch`` may draw the first that asks a reader for nothing, or else the first."""
        choices = [part for part in parts if part.kind in (*GROUPS, *SHAPES, *LEFT_OUT[:3], "svg", "use")]
        free = [part for part in choices if not any(key in part.attributes for key in CONDITIONS)]
        self.drawing.dropped.update(["other choice of a switch"] * (len(choices) - 1))
        return (free or choices)[:1]

    def _count(self, element: Element) -> None:
        """`FormatError` if uses make too much of a file, of its elements or of their long attributes."""
        self.drawn += 1
        self.text += sum(map(len, element.attributes.values()))
        for number, most, what in (
            (self.drawn, MAX_ELEMENTS, "elements"),
            (self.text, MAX_TEXT, "characters of elements"),
        ):
            if number > most:
                raise FormatError(
                    f"line {element.line}: more than {most} {what} are drawn; export only one part"
                )

    def _framed(self, element: Element, outer: _DrawnIn, size: dict[str, str]) -> _DrawnIn | None:
        """The frame of what is in an element, or of the element if it is a shape; None if it is not shown."""
        if element.style("display") == "none":
            self.drawing.dropped["hidden element"] += 1
            return None
        if element.attributes.get("data-kind") == TERRAIN:
            self.drawing.dropped["border of a terrain"] += 1
            return None
        self.drawing.dropped.update(w for w in CUTS if element.style(w) not in ("", "none"))
        moved = element.attributes.get("transform", "")
        if element.style("transform") not in (moved.strip(), "none"):
            self.drawing.dropped["transform in a style"] += 1
        names = (element.attributes.get(key) for key in ("inkscape:label", "id"))
        layers = outer.layers + tuple(name for name in names if name)
        visible = {"visible": True, "hidden": False, "collapse": False}.get(element.style("visibility"))
        frame = replace(
            outer,
            layers=layers,
            visible=outer.visible if visible is None else visible,
            depth=outer.depth + 1,
        )
        with about(one_line(f"{element.kind} {element.attributes.get('id', '')}")):
            matrix = outer.matrix.after(transform(moved))
            if element.kind == "use":
                x, y = (length(element.attributes, key, outer.box) for key in ("x", "y"))
                matrix = matrix.after(Matrix(e=x, f=y))
            if element.kind not in ("svg", "symbol"):
                return replace(frame, matrix=matrix)
            placed = nested(element.attributes, outer.box, size)
        if placed is None:
            self.drawing.dropped[f"{element.kind} of no size"] += 1
            return None
        return replace(frame, matrix=matrix.after(placed[0]), box=placed[1])

    def _use(self, element: Element, frame: _DrawnIn) -> None:
        """What a ``use`` refers to, drawn at its place."""
        told = element.attributes.get("href") or element.attributes.get("xlink:href") or ""
        target = self.named.get(told.strip().removeprefix("#")) if told.strip().startswith("#") else None
        if target is None:
            self.drawing.dropped["use of what the file does not have"] += 1
            return
        self.reused += 1
        size = {key: value for key, value in element.attributes.items() if key in ("width", "height")}
        self._draw(target, frame, size)

    def _visible_shape(self, element: Element, frame: _DrawnIn) -> None:
        if not frame.visible:
            self.drawing.dropped["hidden element"] += 1
            return
        with about(one_line(f"{element.kind} {element.attributes.get('id', '')}")):
            self._shape(element.kind, element.attributes, frame)

    def _shape(self, kind: str, attributes: dict[str, str], frame: _DrawnIn) -> None:
        self.order += 1
        label = attributes.get("id") or f"{kind} {self.order}"
        self.drawing.layers[frame.layers[-1] if frame.layers else "without a name"] += 1
        if not self.choice.take(*(frame.layers or ("without a name",))):
            return
        if not frame.matrix.determinant:
            self.drawing.dropped[f"flattened {kind}"] += 1
            return
        self.error, matrix = max(self.error, frame.matrix.error), frame.matrix
        if kind == "path":
            data = attributes.get("d", "")
            if data not in self.paths:
                self.paths[data] = subpaths(data, curved=self.flattening is not None)
            found = self.paths[data]
        elif kind in ("circle", "ellipse"):
            self._circle(kind, attributes, frame, label)
            return
        else:
            found, narrowed = _basic(kind, attributes, frame.box)
            matrix = matrix.after(narrowed)
            if narrowed.d != 1 and self.flattening is None:
                raise CurvesRefused(
                    "a rectangle with elliptical corners is not read: give it rx and ry alike, or have it "
                    f"{BY_ARCS}"
                )
        for n, subpath in enumerate(found, 1):
            name = label if len(found) == 1 else f"{label}, part {n}"
            if self.flattening is None or not (subpath.curves or _made_oval(subpath, matrix)):
                corners = _moved(subpath, matrix)
            else:
                corners = self._flattened(subpath, matrix)
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

    def _circle(self, kind: str, attributes: dict[str, str], frame: _DrawnIn, label: str) -> None:
        matrix, box = frame.matrix, frame.box
        x, y = (length(attributes, key, box) for key in ("cx", "cy"))
        radii = [length(attributes, key, box) for key in (("r",) if kind == "circle" else ("rx", "ry"))]
        round_one = radii[0] == radii[-1] and matrix.is_similar()
        if not round_one and self.flattening is None:
            raise CurvesRefused(f"an ellipse is not read: replace it by arcs, or have it {BY_ARCS}")
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


def _made_oval(subpath: Subpath, matrix: Matrix) -> bool:
    """Whether a matrix makes arcs of a subpath elliptical."""
    return any(c.bulge for c in subpath.corners) and not matrix.is_similar()


def _moved(subpath: Subpath, matrix: Matrix, oval: bool = False) -> list[Corner]:
    """The corners where a matrix puts them; `FormatError` for arcs made elliptical, if not *oval*."""
    sense = 1 if matrix.determinant > 0 else -1
    if not oval and _made_oval(subpath, matrix):
        raise CurvesRefused(
            "its transform makes arcs elliptical, which are not read; apply another one, or have them "
            f"{BY_ARCS}"
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


def _basic(kind: str, attributes: dict[str, str], box: Box | None) -> tuple[list[Subpath], Matrix]:
    """A line, polyline, polygon or rectangle, and a matrix that it is to be put through first."""
    if kind == "rect":
        return _rectangle(attributes, box)
    if kind == "line":
        x, y, u, v = (length(attributes, key, box) for key in ("x1", "y1", "x2", "y2"))
        places = [(x, y), (u, v)]
    else:
        flat = numbers(attributes.get("points", ""), "points")
        if len(flat) > 2 * MAX_EDGES:
            raise FormatError(f"more than {MAX_EDGES} edges; export only the part that matters")
        places = list(zip(flat[::2], flat[1::2], strict=False))
    if len(places) < 2:
        return [], Matrix()
    return [Subpath([Corner(x, y, fmpq(0)) for x, y in places], kind == "polygon")], Matrix()


def _rectangle(attributes: dict[str, str], box: Box | None) -> tuple[list[Subpath], Matrix]:
    """A rectangle, perhaps with round corners; elliptical ones are made so by the matrix, which scales y."""
    x, y, width, height = (length(attributes, key, box) for key in ("x", "y", "width", "height"))
    if width <= 0 or height <= 0:
        return [], Matrix()
    across, along = (
        length(attributes, first if attributes.get(first, "auto") != "auto" else second, box)
        for first, second in (("rx", "ry"), ("ry", "rx"))
    )
    across, along = min(across, width / 2), min(along, height / 2)
    r = across if across > 0 and along > 0 else fmpq(0)
    scale = along / across if r else fmpq(1)
    y, height = y / scale, height / scale
    corners: list[Corner] = []
    for cx, cy, dx, dy in (
        (x + width, y, -1, 1), (x + width, y + height, -1, -1), (x, y + height, 1, -1), (x, y, 1, 1),
    ):  # fmt: skip
        if not r:
            corners.append(Corner(cx, cy, fmpq(0)))
            continue
        first = (cx + dx * r, cy) if dx * dy < 0 else (cx, cy + dy * r)
        last = (cx, cy + dy * r) if dx * dy < 0 else (cx + dx * r, cy)
        corners += [arc_around(first, last, (cx + dx * r, cy + dy * r), True), Corner(*last, fmpq(0))]
    return [Subpath(corners, True)], Matrix(d=scale)
