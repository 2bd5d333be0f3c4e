"""JSON scenes, read and written without a rounding.

A number's literal text is its value ("0.1" is 1/10); rationals are strings "p/q". Written and read again, a
scene is the same scene: shapes, names, start, terrain, enclosure, radius and notes.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NoReturn

from flint import fmpq

from exactacq.errors import FormatError, about
from exactacq.files.loops.contents import Contents
from exactacq.files.source import MAX_EDGES, check_edges, decoded, one_line, read_bytes
from exactacq.files.writing.sheet import Sheet, Written
from exactacq.numbers.rationals import plain, rational
from exactacq.scene.bends import Around, Bend, Via
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Outline, Polygon, Shape, Terrain

MAX_COMMAS = 8 * MAX_EDGES
"""A vertex brings at most three commas: more than this in a file cannot be a scene that is taken."""
SCENE_KEYS = ("name", "start", "radius", "terrain", "enclosure", "obstacles", "notes")
SHAPE_KEYS = ("name", "boundary", "circle")
BEND_KEYS = ("center", "clockwise", "through")
_ESCAPE = re.compile(
    r"\\u[dD][89abAB][\da-fA-F]{2}\\u[dD][c-fC-F][\da-fA-F]{2}|(?P<half>\\u[dD][89a-fA-F][\da-fA-F]{2})|\\."
)
"""An escape in JSON: two surrogates, which are one character; one of them alone; or any other."""


class _Literal(str):
    """The text of a JSON number, told apart from a JSON string."""

    __slots__ = ()
    is_json_number = True


def read_document(path: str | Path) -> Any:
    """The data of a JSON file, as `parse_json`; `FormatError` too for more than a scene may have."""
    data = read_bytes(path)
    if data.count(b",") > MAX_COMMAS:
        raise FormatError(f"more than {MAX_EDGES} edges; give a smaller scene")
    return parse_json(data)


def contents_of(document: Any, start: tuple[fmpq, fmpq] | None = None) -> Contents:
    """The parts of the scene that parsed JSON describes; *start*, if given, overrides its own.

    Raises `FormatError` with the place in the document. Linear in it.
    """
    parts = _counted_parts(document)
    parts["start"] = parts["start"] if start is None else start
    return Contents(loops=tuple(parts.pop("obstacles")), wall=parts.pop("enclosure"), **parts)


def parse_json(data: bytes) -> Any:
    """JSON data, numbers as the text that stands in the file; `FormatError` for what is no JSON.

    JSON can write half of a character (a surrogate without its other half), which no file, figure or page
    can: that is a `FormatError` too, with its place. Linear in the data.
    """
    text = decoded(data)
    try:
        document = json.loads(
            text,
            parse_float=_Literal,
            parse_int=_Literal,
            parse_constant=_Literal,
            object_pairs_hook=_object,
        )
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise FormatError(f"{place}: not JSON ({one_line(error.msg)}); correct the file") from None
    except RecursionError:
        raise FormatError("nested too deeply; a scene has five levels") from None
    for escape in _ESCAPE.finditer(text):
        if escape["half"]:
            line, column = (
                text.count("\n", 0, escape.start()) + 1,
                escape.start() - text.rfind("\n", 0, escape.start()),
            )
            raise FormatError(
                f"line {line}, column {column}: {escape['half']} is half of a character; write a whole one"
            )
    return document


def scene_of(document: Any) -> Scene:
    """The scene that parsed JSON describes: see `contents_of`. Raises `InvalidScene`, too."""
    return Scene(**_counted_parts(document))


def scene_to_json(scene: Scene) -> dict[str, Any]:
    """A JSON-ready dict that `load_json` reads back as an equal scene: ints, or strings "p/q".

    Raises `FormatError` if the start is not rational.
    """
    parts = scene.radius, scene.terrain, scene.enclosure, scene.name, scene.notes
    document: dict[str, Any] = _plain(_document(scene.shapes, _rational_start(scene), *parts))
    return document


def whole_text(scene: Scene) -> str:
    """A scene file that `load_json` reads back as an equal scene, with decimals where they are finite.

    Raises `FormatError` if the start is not rational.
    """
    start = _rational_start(scene)
    parts = scene.radius, scene.terrain, scene.name, scene.enclosure, scene.notes
    return scene_text(scene.shapes, start, *parts)


def written(sheet: Sheet) -> Written:
    """The exact document of a sheet's subject; `FormatError` if it has none."""
    if sheet.document is None:
        raise FormatError("a JSON file holds a whole scene or a whole run; choose another format")
    return Written(sheet.document().encode())


def _rational_start(scene: Scene) -> tuple[fmpq, fmpq] | None:
    start = None if scene.start is None else scene.start.rational
    if start is None and scene.start is not None:
        raise FormatError("the start is not a rational point: a JSON scene cannot hold it")
    return start


def scene_text(
    shapes: Iterable[Shape],
    start: tuple[fmpq, fmpq] | None = None,
    radius: fmpq | None = None,
    terrain: Terrain | None = None,
    name: str | None = None,
    enclosure: Shape | None = None,
    notes: tuple[str, ...] = (),
) -> str:
    """A scene file that is pleasant to read, for parts that need not make a valid scene.

    One obstacle a line; numbers are decimals where these are finite.
    """
    rows = []
    for key, value in _document(shapes, start, radius, terrain, enclosure, name, notes).items():
        parts = ",\n    ".join(map(_text_of, value)) if key == "obstacles" else ""
        rows.append(f'"{key}": ' + (f"[\n    {parts}\n  ]" if parts else _text_of(value)))
    return "{\n  " + ",\n  ".join(rows) + "\n}\n"


# -- writing ---------------------------------------------------------------------------------------


def _document(
    shapes: Iterable[Shape],
    start: tuple[fmpq, fmpq] | None,
    radius: fmpq | None,
    terrain: Terrain | None,
    enclosure: Shape | None = None,
    name: str | None = None,
    notes: tuple[str, ...] = (),
) -> dict[str, Any]:
    """A scene's JSON document with rationals for numbers; without what is not given."""
    document: dict[str, Any] = {
        "name": name,
        "start": None if start is None else list(start),
        "radius": radius,
        "terrain": None if terrain is None else _terrain(terrain),
        "enclosure": None if enclosure is None else _described(enclosure),
        "obstacles": [_described(shape) for shape in shapes],
        "notes": list(notes) or None,
    }
    if enclosure is not None and list(document["enclosure"]) == ["boundary"]:
        document["enclosure"] = document["enclosure"]["boundary"]
    return {key: value for key, value in document.items() if value is not None}


def _terrain(terrain: Terrain) -> dict[str, Any]:
    """Its sides, and the origin unless that is that of the coordinates."""
    document: dict[str, Any] = {"width": terrain.width, "height": terrain.height}
    return document | ({"origin": list(terrain.origin)} if any(terrain.origin) else {})


def _described(shape: Shape) -> dict[str, Any]:
    document: dict[str, Any] = {} if shape.name is None else {"name": shape.name}
    if isinstance(shape, Circle):
        document["circle"] = {"center": list(shape.center), "radius": shape.radius}
        return document
    rows = [[x, y, _bend_document(told)] if told else [x, y] for x, y, told in shape.vertices]
    if isinstance(shape, Outline) and rows and not any(bulge for _, _, bulge in shape.vertices):
        rows[0].append(fmpq(0))  # a bulge, even 0, says that this is an Outline
    document["boundary"] = rows
    return document


def _bend_document(told: Bend) -> Any:
    if isinstance(told, Around):
        return {"center": list(told.center), **({} if told.ccw else {"clockwise": True})}
    return told


def _plain(value: Any) -> Any:
    """Rationals as ints or strings "p/q"."""
    if isinstance(value, fmpq):
        return int(value.p) if value.q == 1 else f"{value.p}/{value.q}"
    if isinstance(value, dict):
        return {key: _plain(part) for key, part in value.items()}
    return list(map(_plain, value)) if isinstance(value, list) else value


def _text_of(value: Any) -> str:
    """A value on one line, rationals as `_number_text`."""
    if isinstance(value, fmpq):
        return _number_text(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{key}": {_text_of(part)}' for key, part in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_text_of, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def _number_text(value: fmpq) -> str:
    """A JSON number if the value is a finite decimal, else the string "p/q"."""
    text = plain(value)
    return f'"{text}"' if "/" in text else text


# -- reading ---------------------------------------------------------------------------------------


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object without repeated keys."""
    found = dict(pairs)
    if len(found) < len(pairs):
        counts = Counter(key for key, _ in pairs)
        twice = next(key for key, n in counts.items() if n > 1)
        raise FormatError(f"the key {one_line(repr(twice))} stands twice in one object; keep one")
    return found


def _counted_parts(document: Any) -> dict[str, Any]:
    parts = _scene_parts(document)
    check_edges(sum(_edge_count(s) for s in (*parts["obstacles"], parts["enclosure"])))
    return parts


def _scene_parts(document: Any) -> dict[str, Any]:
    _keys(document, "the scene", SCENE_KEYS)
    if "obstacles" not in document:
        raise FormatError('the scene has no "obstacles"; give a list (it may be empty)')
    parts: dict[str, Any] = {"start": None, "radius": None, "terrain": None, "enclosure": None}
    if (start := document.get("start")) is not None:
        parts["start"] = _numbers(start, "start", (2,))
    if (radius := document.get("radius")) is not None:
        parts["radius"] = _number(radius, "radius")
    if (terrain := document.get("terrain")) is not None:
        _keys(terrain, "terrain", ("width", "height", "origin"), required=("width", "height"))
        width, height = (_number(terrain[k], f"terrain.{k}") for k in ("width", "height"))
        origin = (0, 0) if "origin" not in terrain else _numbers(terrain["origin"], "terrain.origin", (2,))
        parts["terrain"] = Terrain(width, height, origin)
    if (wall := document.get("enclosure")) is not None:
        shape = {"boundary": wall} if isinstance(wall, list) else wall
        parts["enclosure"] = _shape(shape, "enclosure")
    obstacles = _list(document["obstacles"], "obstacles")
    parts["obstacles"] = [_shape(shape, f"obstacles[{i}]") for i, shape in enumerate(obstacles)]
    parts["name"] = _text(document.get("name"), "name")
    notes = [_text(n, f"notes[{i}]") for i, n in enumerate(_list(document.get("notes", []), "notes"))]
    parts["notes"] = tuple(note for note in notes if note is not None)
    return parts


def _shape(value: Any, place: str) -> Shape:
    _keys(value, place, SHAPE_KEYS)
    name = _text(value.get("name"), f"{place}.name")
    if ("boundary" in value) == ("circle" in value):
        raise FormatError(f'{place}: a shape has either a "boundary" or a "circle"')
    if "circle" in value:
        circle, inner = value["circle"], f"{place}.circle"
        _keys(circle, inner, ("center", "radius"), required=("center", "radius"))
        center = _numbers(circle["center"], f"{inner}.center", (2,))
        return Circle(center, _number(circle["radius"], f"{inner}.radius"), name)
    rows = _list(value["boundary"], f"{place}.boundary")
    vertices = [_vertex(row, f"{place}.boundary[{i}]") for i, row in enumerate(rows)]
    if any(len(vertex) == 3 for vertex in vertices):
        with about(place):
            return Outline(vertices, name)
    return Polygon(vertices, name)


def _vertex(value: Any, place: str) -> tuple[Any, ...]:
    """x, y, and what the edge that follows bends by if that is said."""
    row = _list(value, place)
    if len(row) != 3 or not isinstance(row[2], dict):
        return _numbers(row, place, (2, 3))
    x, y = _numbers(row[:2], place, (2,))
    return x, y, _bend(row[2], f"{place}[2]")


def _bend(value: dict[str, Any], place: str) -> Around | Via:
    _keys(value, place, BEND_KEYS)
    if ("center" in value) == ("through" in value):
        raise FormatError(f'{place}: an arc has either a "center" or a point "through" which it goes')
    if "through" in value:
        _keys(value, place, ("through",))
        return Via(_numbers(value["through"], f"{place}.through", (2,)))
    clockwise = value.get("clockwise", False)
    if not isinstance(clockwise, bool):
        _refuse(f"{place}.clockwise", "true or false", clockwise)
    return Around(_numbers(value["center"], f"{place}.center", (2,)), not clockwise)


def _edge_count(shape: Shape | None) -> int:
    return 0 if shape is None else 1 if isinstance(shape, Circle) else len(shape.vertices)


def _number(value: Any, place: str) -> fmpq:
    if not isinstance(value, str):
        _refuse(place, "a number", value)
    try:
        return rational(str(value))
    except FormatError as error:
        raise FormatError(f'{place}: {one_line(error)}; write an integer, a decimal or "p/q"') from None


def _numbers(value: Any, place: str, counts: tuple[int, ...]) -> tuple[fmpq, ...]:
    row = _list(value, place)
    if len(row) not in counts:
        needed = "[x, y]" if counts == (2,) else "[x, y] or [x, y, bend]"
        raise FormatError(f"{place}: {needed} is needed, not {len(row)} values")
    return tuple(_number(number, f"{place}[{i}]") for i, number in enumerate(row))


def _list(value: Any, place: str) -> list[Any]:
    if not isinstance(value, list):
        _refuse(place, "a list", value)
    return value


def _text(value: Any, place: str) -> str | None:
    if value is not None and (not isinstance(value, str) or isinstance(value, _Literal)):
        _refuse(place, "a text", value)
    return None if value is None else str(value)


def _keys(value: Any, place: str, known: Iterable[str], required: Iterable[str] = ()) -> None:
    if not isinstance(value, dict):
        _refuse(place, "an object", value)
    if unknown := [key for key in value if key not in known]:
        raise FormatError(f"{place}: unknown key {one_line(repr(unknown[0]))}; known are {', '.join(known)}")
    if missing := [key for key in required if key not in value]:
        raise FormatError(f'{place}: "{missing[0]}" is missing')


def _refuse(place: str, needed: str, value: Any) -> NoReturn:
    kinds: dict[type, str] = {dict: "an object", list: "a list", bool: "true or false", _Literal: "a number"}
    found = "null" if value is None else kinds.get(type(value), "a text")
    raise FormatError(f"{place}: {needed} is needed, not {found}")
