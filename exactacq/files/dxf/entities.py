"""The entities of a DXF file, read through ezdxf, as chains of edges and circles with rational data.

LWPOLYLINE and POLYLINE with their bulges, LINE, ARC and CIRCLE of the model space are read, also inside
blocks (INSERT), and on request ELLIPSE and SPLINE by arcs near them. Other kinds, such as TEXT and DIMENSION,
are left out and counted by name.
"""

from __future__ import annotations

import logging
import re
from collections.abc import Iterable, Iterator
from hashlib import sha256
from io import StringIO
from pathlib import Path
from typing import Any

import ezdxf
from ezdxf import recover
from ezdxf.enums import InsertUnits
from flint import fmpq

from exactacq.errors import FormatError, about
from exactacq.files.counting import count
from exactacq.files.dxf.blocks import MAX_ENTITIES, Unseen, shown
from exactacq.files.loops.chains import ZERO, Chain, Corner
from exactacq.files.loops.drawing import Drawing, LayerChoice
from exactacq.files.loops.rational_arcs import arc_corners
from exactacq.files.repairs.bezier import BezierPiece, spline
from exactacq.files.repairs.flattened import BY_ARCS, Flattening, ellipse
from exactacq.files.rereading import once
from exactacq.files.source import MAX_EDGES, one_line, read_bytes
from exactacq.numbers.rationals import rational
from exactacq.scene.shapes import Circle

MAX_LINES = 20 * MAX_EDGES
"""Most lines of a file, two for each value: ezdxf takes 7 microseconds and 100 bytes for each."""
MOST_NAMED = 6
"""So many layers with hidden entities are named at most."""
BINARY = b"AutoCAD Binary DXF\r\n\x1a\x00"
LEVEL = 1e-12
"""Slope of a plane that is taken for level: some programs write a rotation's rounding errors."""
_OPENING = re.compile(rb"(?:\xef\xbb\xbf)?\s*(?:999[ \t]*\r?\n[^\n]*\n\s*)*0[ \t]*\r?\n[ \t]*SECTION\s")
_HEADER = re.compile(rb"\n[ \t]*2[ \t]*\r?\n[ \t]*HEADER\s")
_VERSION = re.compile(rb"(\$ACADVER\s+1\s+)(AC\d+)")
_LIGHT = ("38", "43", "90", "100")
"""Codes that an LWPOLYLINE alone has: elevation, width, number of vertices, subclass."""
_ENTITY = re.compile(rb"\n[ \t]*0[ \t]*\r?\n[ \t]*[A-Z]")

# Without a handler Python prints what ezdxf mends to standard error; the scene's notes count it.
logging.getLogger("ezdxf").addHandler(logging.NullHandler())


def read_drawing(path: Path, layers: Iterable[str] | None, flattening: Flattening | None = None) -> Drawing:
    """The model space of a DXF file, all layers or those named (in any case).

    What is hidden, alone or with its layer, is left out, unless layers are named. Raises `FormatError` for
    what is no complete DXF file, or has no such layer. Linear in the file.
    """
    drawing = Drawing()
    document = _open(path, drawing)
    selected = LayerChoice(layers)
    order = 0
    try:
        hidden = dict[str, None]()
        for entity, layer, is_hidden in shown(document.modelspace(), drawing, Unseen(document)):
            order += 1
            if order > MAX_ENTITIES:
                raise FormatError(
                    f"its blocks expand to more than {MAX_ENTITIES} entities and vertices; export one part"
                )
            if is_hidden and selected.names is None:
                drawing.dropped[f"hidden {entity.dxftype()}"] += 1
                hidden.setdefault(layer)
                continue
            drawing.layers[layer] += 1
            drawing.homes[order] = layer
            if selected.take(layer):
                _Reader(drawing, order, flattening).read(entity)
        ways = [] if order else [*_on_paper(document)]
        unit = _unit(document)
    except FormatError:
        raise
    except Exception as error:  # ezdxf reads lazily: a damaged entity shows only here, in many ways
        raise FormatError(f"a damaged entity ({one_line(error)}); save or export it again") from None
    selected.check(drawing)
    if hidden:
        names = ", ".join(one_line(repr(name)) for name in [*hidden][:MOST_NAMED])
        ways.append(f"--layers reads what is hidden too, as on {names}")
    if flattening is not None:
        drawing.notes += flattening.notes()
    elif drawing.dropped["ELLIPSE"] or drawing.dropped["SPLINE"]:
        drawing.has_curves = True
        ways.append(f"ellipses and splines are {BY_ARCS}")
    drawing.readable = "; ".join(ways)
    for kind, number in drawing.wide.items():
        drawing.notes.append(f"read the middle line of {count(number, kind)} drawn with a width")
    if drawing.layers:
        drawing.unit = unit
        said = f"the file's unit: {drawing.unit}" if drawing.unit else "the file names no unit"
        drawing.notes.append(f"{said}; layers: {drawing.layer_list()}")
    return drawing


def _on_paper(document: Any) -> Iterator[str]:
    """That what a drawing shows is on its layouts for paper."""
    for layout in document.layouts:
        if layout.is_modelspace:
            continue
        number = sum(entity.dxftype() != "VIEWPORT" for entity in layout)
        if number:
            what = f"{count(number, 'entity', 'entities')} on the layout {one_line(repr(layout.name))}"
            yield f"only what is in the model space is read: move what is on paper there ({what})"


def _unit(document: Any) -> str:
    """The unit that the file names, "" if none; coordinates stay as they are."""
    code = document.header.get("$INSUNITS", 0)
    if not isinstance(code, int) or not 0 < code <= max(InsertUnits):
        return ""
    return re.sub("(?<=[a-z])(?=[A-Z])", " ", InsertUnits(code).name).lower()


def _open(path: Path, drawing: Drawing) -> Any:
    data = read_bytes(path)
    if not data.startswith(BINARY) and not _OPENING.match(data):
        raise FormatError("not a DXF file (no SECTION at its beginning); export the drawing as DXF")
    if not data.rstrip(b" \t\r\n\x00\x1a").endswith(b"EOF"):
        raise FormatError("the DXF file is truncated (no EOF at its end); export the drawing again")
    if data.startswith(BINARY):
        lines, entities = len(data) // 8, 0
    else:
        lines, entities = data.count(b"\n"), sum(1 for _ in _ENTITY.finditer(data))
    for number, most, what in ((entities, MAX_ENTITIES, "entities"), (lines, MAX_LINES, "lines")):
        if number > most:
            raise FormatError(f"{number} {what} are more than the {most} that are read; export one part")
    key = "dxf", path, sha256(data).digest()
    version = _VERSION.search(data)
    is_new = b"LWPOLYLINE" in data or (version is not None and version[2] > b"AC1009")
    is_plain = is_new and b"AcDbEntity" not in data
    is_bare = not data.startswith(BINARY) and (is_plain or _HEADER.search(data) is None)
    del data
    try:
        document, notes = once(key, lambda: _parsed(path, is_bare))
    except Exception as error:  # ezdxf raises what its parsers meet: ValueError, IndexError, struct.error
        reason = one_line(error)
        raise FormatError(f"not a readable DXF file ({reason}); export the drawing again") from None
    drawing.notes += notes
    return document


def _parsed(path: Path, is_bare: bool) -> tuple[Any, list[str]]:
    """The document in a file, which is not to be changed, and a note if it is damaged."""
    try:
        return _bare(path) if is_bare else ezdxf.readfile(path), []
    except ezdxf.DXFStructureError:
        document, auditor = recover.readfile(path)
        mended, left = len(auditor.fixes), len(auditor.errors)
        return document, [f"the file is damaged: {count(mended, 'flaw')} mended on reading, {left} not"]


def _bare(path: Path) -> Any:
    """The document in a text as scripts write it: without a header, or entities without subclasses.

    It gets a header, else ezdxf takes it for a drawing in metres. What has no subclasses is read as the old
    format that had none, in which light polylines are heavy ones.
    """
    data = read_bytes(path)
    is_old = b"AcDbEntity" not in data
    version = "AC1009" if is_old else "AC1015"
    data, named = _VERSION.subn(rb"\g<1>" + version.encode(), data, count=1)
    header = "" if named else f"0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\n{version}\n0\nENDSEC\n"
    text = data.decode("utf-8-sig", errors="surrogateescape")
    lines = [line.rstrip("\n") for line in StringIO(text, newline=None)]  # other separators stand in texts
    return ezdxf.read(StringIO(header + "\n".join(_heavy(lines) if is_old else lines) + "\n"))


def _heavy(lines: list[str]) -> Iterator[str]:
    """The lines of a text, each LWPOLYLINE as a POLYLINE with its vertices."""
    is_light, layer = False, "0"
    for code, value in zip(map(str.strip, lines[::2]), lines[1::2], strict=False):
        if code == "0":
            if is_light:
                yield from ("0", "SEQEND")
            is_light, layer = value.strip() == "LWPOLYLINE", "0"
            yield from (code, "POLYLINE" if is_light else value)
            continue
        if is_light and code == "8":
            layer = value
        if is_light and code == "10":
            yield from ("0", "VERTEX", "8", layer)
        if not is_light or code not in _LIGHT:
            yield from (code, value)


class _Reader:
    """One entity into the drawing."""

    def __init__(self, drawing: Drawing, order: int, flattening: Flattening | None) -> None:
        self.drawing, self.order, self.flattening = drawing, order, flattening

    def read(self, entity: Any) -> None:
        kind = entity.dxftype()
        read = {
            "LINE": self._line,
            "ARC": self._arc_or_circle,
            "CIRCLE": self._arc_or_circle,
            "LWPOLYLINE": self._lwpolyline,
            "POLYLINE": self._polyline,
            **({} if self.flattening is None else {"ELLIPSE": self._ellipse, "SPLINE": self._spline}),
        }.get(kind)
        with about(self._label(entity)):
            reason = kind if read is None else read(entity)
        if reason:
            self.drawing.dropped[reason] += 1
        elif kind.endswith("POLYLINE") and entity.has_width:
            self.drawing.wide[kind] += 1

    def _label(self, entity: Any) -> str:
        handle = entity.dxf.get("handle")
        return f"{entity.dxftype()} {handle}" if handle else f"{entity.dxftype()} no. {self.order}"

    def _add(self, entity: Any, corners: list[Corner], closed: bool = False, stated: bool = True) -> None:
        self.drawing.chains.append(Chain(self._label(entity), corners, self.order, closed, stated))

    def _line(self, entity: Any) -> str | None:
        ends = (entity.dxf.start, entity.dxf.end)
        self._add(entity, [Corner(_exact(p.x), _exact(p.y), fmpq(0)) for p in ends])
        return None

    def _arc_or_circle(self, entity: Any) -> str | None:
        flip = _mirror(entity)
        if flip is None:
            return f"{entity.dxftype()} in a tilted plane"
        radius = _exact(entity.dxf.radius)
        if radius <= 0:
            return f"{entity.dxftype()} of no radius"
        center = (_exact(entity.dxf.center.x) * flip, _exact(entity.dxf.center.y))
        corners = None
        if entity.dxftype() == "ARC":
            start, end = _exact(entity.dxf.start_angle), _exact(entity.dxf.end_angle)
            corners = arc_corners(center, radius, *((start, end) if flip > 0 else (180 - end, 180 - start)))
        if corners is None:
            self.drawing.circles.append((self.order, Circle(center, radius, self._label(entity))))
        else:
            self._add(entity, corners, stated=False)
        return None

    def _ellipse(self, entity: Any) -> str | None:
        flip = _mirror(entity)
        if flip is None:
            return "ELLIPSE in a tilted plane"
        center, major = ((_exact(p.x), _exact(p.y)) for p in (entity.dxf.center, entity.dxf.major_axis))
        ratio = _exact(entity.dxf.ratio) * flip
        start, end = _exact(entity.dxf.start_param), _exact(entity.dxf.end_param)
        minor = (-major[1] * ratio, major[0] * ratio)
        if major == (0, 0) or not ratio:
            return "ELLIPSE of no size"
        pieces, whole, error = ellipse(center, major, minor, start, end)
        return self._curve(entity, pieces, whole, error)

    def _spline(self, entity: Any) -> str | None:
        points = [(_exact(x), _exact(y)) for x, y, _ in entity.control_points]
        if not points:
            return "SPLINE of fit points only"
        knots, weights = ([_exact(v) for v in values] for values in (entity.knots, entity.weights))
        try:
            pieces = spline(int(entity.dxf.degree), knots, points, weights)
        except FormatError as error:
            return f"SPLINE ({error})"
        return self._curve(entity, pieces, pieces[0].point(fmpq(0)) == pieces[-1].point(fmpq(1)))

    def _curve(self, entity: Any, pieces: list[BezierPiece], closed: bool, error: fmpq = ZERO) -> str | None:
        """A curve by arcs; its ends stay, and where it is closed the last one is left out."""
        assert self.flattening is not None
        corners = self.flattening.corners(entity.dxftype(), pieces, error)
        if not corners:
            return f"{entity.dxftype()} of no size"
        self._add(entity, corners[:-1] if closed else corners, closed, stated=not error)
        return None

    def _lwpolyline(self, entity: Any) -> str | None:
        return self._bulged(entity, entity.get_points("xyb"), bool(entity.closed))

    def _polyline(self, entity: Any) -> str | None:
        spline_fit = 4
        if not (entity.is_2d_polyline or entity.is_3d_polyline):
            return "POLYLINE mesh"
        if entity.dxf.get("flags", 0) & spline_fit:
            return "spline-fitted POLYLINE"
        flat = entity.is_2d_polyline
        places = [(v.dxf.location, v.dxf.get("bulge", 0.0) if flat else 0.0) for v in entity.vertices]
        return self._bulged(entity, [(p.x, p.y, bulge) for p, bulge in places], bool(entity.is_closed), flat)

    def _bulged(
        self, entity: Any, rows: Iterable[tuple[float, float, float]], closed: bool, flat: bool = True
    ) -> str | None:
        flip = _mirror(entity) if flat else 1
        if flip is None:
            return f"{entity.dxftype()} in a tilted plane"
        corners = [Corner(_exact(x) * flip, _exact(y), _exact(b) * flip) for x, y, b in rows]
        if len(corners) < 2:
            return f"{entity.dxftype()} of fewer than two vertices"
        self._add(entity, corners, closed)
        return None


def _exact(value: float) -> fmpq:
    """The shortest decimal that denotes a double, exactly; `FormatError` for NaN and infinities."""
    return rational(repr(float(value)))


def _mirror(entity: Any) -> int | None:
    """1 or -1 as x keeps or changes its sign in the entity's coordinates; None if its plane is tilted."""
    x, y, z = entity.dxf.get("extrusion", (0.0, 0.0, 1.0))
    return None if max(abs(x), abs(y)) > LEVEL * abs(z) or not z else 1 if z > 0 else -1
