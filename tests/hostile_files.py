"""Hostile files of every format, made from samples: the n-th one of a format is always the same.

Samples are changed by bytes (flipped, cut, doubled, spliced), by structure (words swapped, repeated, nested
deeply, numbers replaced by huge, tiny and senseless ones), and by what each format is known to suffer from:
images that declare more pixels than they have, entities and aliases that expand without end.
"""

from __future__ import annotations

import re
import struct
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from io import BytesIO
from pathlib import Path
from random import Random

import numpy as np
import PIL.Image

import exactacq as xa

DATA = Path(__file__).parent / "data"
NUMBERS = (
    b"0", b"-0", b"-1", b"1e308", b"-1e-308", b"1e99999", b"-1e4999", b"1e-4999", b"nan", b"Infinity",
    b"9" * 400, b"9" * 6000, b"0.1", b"4294967296", b"18446744073709551616", b"99999999", b"1/0", b"1/3", b"",
    b"true", b"\xff", b"\x00", b"1.5.5", b"--3", b"\xd9\xa3", b"1e15", b"1e-15", b"0x10", b"1_000",
)  # fmt: skip
RING = "[[0, 0], [4, 0.25], [4, 4], [0, 4], [0, 0]], [[1, 1], [1, 3], [3, 3], [1, 1]]"
LONGEST = 1 << 20
"""Longest file that repetitions make, in bytes: longer ones only take longer."""


@dataclass(frozen=True)
class Kind:
    """A format: how its files are called, undamaged samples, and whole files that are known to hurt."""

    suffix: str
    samples: tuple[bytes, ...]
    bombs: tuple[bytes, ...] = ()
    special: Callable[[bytes, Random], bytes] | None = None
    share: int = 25
    """Of how many files in a hundred *special* makes."""
    beside: dict[str, bytes] = field(default_factory=dict)
    """Files that the samples name."""
    options: tuple[dict[str, object], ...] = ({},)


def _image(form: str, mode: str = "L") -> bytes:
    pixels = np.arange(48, dtype=np.uint8).reshape(6, 8) * 5
    out = BytesIO()
    PIL.Image.fromarray(pixels).convert(mode).save(out, form)
    return out.getvalue()


# -- what declares too much ------------------------------------------------------------------------------

SIZES = (0, 1, 7, 255, 4096, 4097, 20_000, 65_535, 100_000, 1 << 24, (1 << 31) - 1, (1 << 32) - 1)


def _png_sizes(data: bytes, rng: Random) -> bytes:
    """Another width and height with a checksum that is right, perhaps another depth and kind of colour."""
    head = bytearray(data[16:29])
    struct.pack_into(">II", head, 0, rng.choice(SIZES), rng.choice(SIZES))
    if rng.randrange(2):
        head[8], head[9] = rng.choice((1, 2, 4, 8, 16)), rng.choice((0, 2, 3, 4, 6))
    return data[:16] + bytes(head) + struct.pack(">I", zlib.crc32(b"IHDR" + head)) + data[33:]


def _at(place: int, form: str) -> Callable[[bytes, Random], bytes]:
    """Sizes at a place of the header."""

    def changed(data: bytes, rng: Random) -> bytes:
        out, most = bytearray(data), 1 << 8 * struct.calcsize(form) // 2
        struct.pack_into(form, out, place, *(rng.choice(SIZES) % most for _ in range(2)))
        return bytes(out)

    return changed


def _jpeg_sizes(data: bytes, rng: Random) -> bytes:
    place = max(data.find(b"\xff\xc0"), data.find(b"\xff\xc2"))
    return data if place < 0 else _at(place + 5, ">HH")(data, rng)


def _dxf_values(data: bytes, rng: Random) -> bytes:
    """One to four values changed; their codes stay."""
    lines = data.split(b"\n")
    for k in rng.choices(range(1, len(lines) - 1, 2), k=rng.randint(1, 4)):
        own = rng.choice(lines[1::2]).strip()
        lines[k] = rng.choice(
            (own, own, rng.choice(NUMBERS), b"-" + lines[k], lines[k] + b"9", b"1e-9", b"0")
        )
    return b"\n".join(lines)


def _png(width: int, height: int) -> bytes:
    """A PNG of black pixels, well packed; of very many rows most are missing."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    packer = zlib.compressobj(9)
    rows = b"".join(packer.compress(bytes(width + 1)) for _ in range(min(height, 4096))) + packer.flush()
    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


def _png_text(size: int) -> bytes:
    """A PNG with a comment that expands to so many bytes."""
    body = b"a\0\0" + zlib.compress(bytes(size), 9)
    chunk = struct.pack(">I", len(body)) + b"zTXt" + body + struct.pack(">I", zlib.crc32(b"zTXt" + body))
    data = _image("PNG")
    return data[:33] + chunk + data[33:]


# -- samples ---------------------------------------------------------------------------------------------

JSON = """{"name": "a", "start": [0, 0], "radius": "21/2", "terrain": {"width": 20, "height": 10},
 "obstacles": [{"name": "O1", "boundary": [[2, -1], [4, -1, "1/2"], ["4", "1.25"], [2, 1,
 {"through": [1, 0]}]]},
 {"circle": {"center": [8, 0], "radius": 2}},
 {"boundary": [[9, 9, {"center": [9, 8], "clockwise": true}], [10, 8]]}]}"""
WKT = """SRID=1;CURVEPOLYGON(COMPOUNDCURVE((0 0, 4 0), CIRCULARSTRING(4 0, 5 1, 4 2), (4 2, 0 2,
 0 0)), CIRCULARSTRING(1 1, 2 1, 1 1)) MULTIPOLYGON Z (((9 9 1, 10 9 1, 10 10 1, 9 9 1)), EMPTY)
 LINESTRING(0 0, 1e1 -.5)"""
GEOJSON = f"""{{"type": "FeatureCollection", "features": [{{"type": "Feature", "properties":
 {{"name": "a", "kind": "x"}}, "geometry": {{"type": "Polygon", "coordinates": [{RING}]}}}}, {{"type":
 "Feature", "geometry": {{"type": "GeometryCollection", "geometries": [{{"type": "MultiPolygon",
 "coordinates": [[[[9, 9], [10, 9, 7], [10, 10], [9, 9]]]]}}, {{"type": "Point", "coordinates": [1,
 2]}}]}}}}]}}"""
TERRAIN = """{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"kind": "terrain"},
 "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]]]}}, {"type":
 "Feature", "properties": {"kind": "start"}, "geometry": {"type": "Point", "coordinates": [1, 1]}}, {"type":
 "Feature", "properties": null, "geometry": {"type": "MultiLineString", "coordinates": [[[3, 3], [4, 3], [4,
 4.5], [3, 3]], [[0, 1], [2, 3]]]}}]}"""
ENVIRONMENT = "//Model\n//Outer\n0 0\n10.0 0\n10 10\n0 10\n//Hole\n2 2\n2 3\n4 3\n//\n7 3\n6 4\n8 5\n"
MAP = "type octile\nheight 4\nwidth 5\nmap\n.....\n.T.@W\n.@.SG\n.O...\n"
PGM = b"P2\n# plan\n4 3\n255\n0 0 255 255\n255 0 128 0\n0 255 255 0\n"
CURVES = """<svg viewBox="0 0 100 100"><g transform="rotate(30) scale(2 1)"><path
 d="M10 10C15 30 30 30 30 10S50 -10 50 10V50H10z"/><ellipse cx="20" cy="70" rx="4" ry="3"/><path
 d="M60 60q5 9 9 0t9 0M10 20A10 5 30 0 1 20 20L30 80"/></g></svg>"""
SVG = """<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 40"><g id="a"
 transform="translate(1 2) rotate(30) scale(2)"><path d="M2.5 5a.5.5 0 1 0 0-1 .5.5 0 0 0 0 1m4.5
 -3h1v3H6z"/><rect x="15" y="9" width="4" height="3" rx="1"/></g><circle cx="3" cy="30" r="2"
 style="fill:red"/><text>x</text><polygon points="30,30 35,30 35,35"/><!-- note --><line x1="3" y1="35"
 x2="9" y2="35"/></svg>"""
YAML = (
    "image: {}\nresolution: 0.05\norigin: [-1.0, 2, 0.3]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n"
)
LISTED = "---\nimage: './plan.png'\nresolution: 1\norigin:\n- 1\n- 2\n- 0\n# note\nnegate: 1\n"


def dxf_of(*entities: tuple[object, ...], blocks: tuple[tuple[object, ...], ...] = ()) -> bytes:
    """A DXF file without a header: entities, and those of a block B, as codes and values in turn."""

    def listed(rows: tuple[tuple[object, ...], ...]) -> list[object]:
        own = {100: (100, "AcDbEntity")}  # newer kinds say of which class their values are
        return [v for row in rows for v in (0, row[0], *own.get((*row, 0, 0)[1], ()), 8, "0", *row[1:])]

    block = [0, "BLOCK", 8, "0", 2, "B", 70, 0, 10, 0.0, 20, 0.0, *listed(blocks), 0, "ENDBLK", 8, "0"]
    lines = [0, "SECTION", 2, "BLOCKS", *(block if blocks else []), 0, "ENDSEC"]
    lines += [0, "SECTION", 2, "ENTITIES", *listed(entities), 0, "ENDSEC", 0, "EOF"]
    return ("\n".join(map(str, lines)) + "\n").encode()


DXF = (
    dxf_of(
        ("LINE", 10, 0.0, 20, 0.0, 11, 4.0, 21, 0.0),
        ("ARC", 10, 2.0, 20, 0.0, 40, 2.0, 50, 0.0, 51, 180.0),
        ("CIRCLE", 10, 9.5, 20, 3.25, 40, 1.5),
        ("LWPOLYLINE", 100, "AcDbPolyline", 90, 3, 70, 1, 10, 20.0,
         20, 0.0, 42, 0.5, 10, 22.0, 20, 0.0, 10, 22.0, 20, 5.125),
        ("POLYLINE", 66, 1, 70, 1), ("VERTEX", 10, 30.0, 20, 0.0, 42, -0.3), ("VERTEX", 10, 35.0, 20, 0.0),
        ("VERTEX", 10, 35.0, 20, 5.0), ("SEQEND",),
        ("TEXT", 10, 0.0, 20, 0.0, 40, 1.0, 1, "note"),
    ),
    dxf_of(
        ("INSERT", 2, "B", 10, 5.0, 20, 5.0, 41, 2.0, 42, 2.0, 50, 30.0, 70, 2, 71, 2, 44, 9.0, 45, 9.0),
        ("INSERT", 2, "B", 10, -50.0, 20, 5.0, 41, 2.0, 42, 1.0, 230, -1.0),
        ("ELLIPSE", 100, "AcDbEllipse", 10, 60.0, 20, 0.0, 11, 4.0, 21, 1.0, 40, 0.5, 41, 0.0, 42, 6.283),
        ("SPLINE", 100, "AcDbSpline", 70, 8, 71, 3, 72, 8, 73, 4, *(40, 0.0) * 4, *(40, 1.0) * 4, 10, 80.0,
         20, 0.0, 10, 84.0, 20, 4.0, 10, 86.0, 20, -4.0, 10, 80.0, 20, 0.0),
        blocks=(("CIRCLE", 10, 0.0, 20, 0.0, 40, 1.0), ("LINE", 10, 2.0, 20, 0.0, 11, 3.0, 21, 0.0),
                ("LINE", 10, 3.0, 20, 0.0, 11, 3.0, 21, 1.0), ("LINE", 10, 3.0, 20, 1.0, 11, 2.0, 21, 0.0)),
    ),
)  # fmt: skip
ITSELF = dxf_of(("INSERT", 2, "B"), blocks=(("INSERT", 2, "B"), ("CIRCLE", 10, 0.0, 20, 0.0, 40, 1.0)))
ARRAY = dxf_of(
    ("INSERT", 2, "B", 70, 30000, 71, 30000, 44, 1.0, 45, 1.0), blocks=(("CIRCLE", 10, 0, 20, 0, 40, 1),)
)
LAUGHS = (
    '<!DOCTYPE svg [<!ENTITY a "ha">'
    + "".join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True))
    + ']><svg id="&i;"><path d="M0 0h9v9z"/>&i;</svg>'
).encode()
OUTSIDE = (
    b'<!DOCTYPE svg [<!ENTITY x SYSTEM "file:///etc/passwd">]><svg><path id="&x;" d="M0 0h9v9z"/>&x;</svg>'
)
ALIASES = (
    "a: &a [x, x, x]\n"
    + "".join(f"{b}: &{b} [{', '.join([f'*{a}'] * 9)}]\n" for a, b in zip("abcdefg", "bcdefgh", strict=True))
    + "image: *h\nresolution: 1\n"
).encode()


def _current_runs() -> tuple[bytes, ...]:
    """Small runs of both strategies, in the present version of run files."""
    import json

    scene = xa.Scene([xa.Circle((4, 0), 1), xa.Polygon([(3, 3), (5, 3), (4, 5)])], start=(0, 0), radius=5)
    swept = xa.Scene([xa.Polygon([(3, 3), (5, 3), (4, 5)])], terrain=xa.Terrain(8, 8), radius=4)
    runs = xa.sightseer(scene), xa.seed_spreader(swept)
    return tuple(json.dumps(run.to_json()).encode() for run in runs)


@cache
def kinds() -> dict[str, Kind]:
    """All formats by their names; "run" is that of runs."""
    drawn = ({}, {"union": True}, {"tolerance": 1}, {"thicken": "1/3"}, {"outer": "drop"}, {"outer": "room"})
    curved = (*drawn, {"flatten": 1}, {"flatten": "0.01", "union": True}, {"flatten": "1e-4"})
    grid = (
        {}, {"corners": "part"}, {"border": "wall"}, {"border": "open"}, {"simplify": 1},
        {"simplify": "0.3", "border": "open", "corners": "part"},
    )  # fmt: skip
    plan = {"plan.png": _image("PNG")}
    runs = tuple(
        (DATA / "runs" / f"version{v}.json").read_bytes() for v in ("2-case3", "2-trapped", "3-touching")
    )
    deep, open_geo = 100_000, b'{"type":"GeometryCollection","geometries":['
    return {
        "json": Kind(".json", (JSON.encode(), (DATA / "arcs" / "samecircle-b193.json").read_bytes()),
                     (b"[" * deep, b'{"a":' * deep, b"[" * deep + b"]" * deep)),
        "run": Kind(".json", (*runs, *_current_runs())),
        "wkt": Kind(".wkt", (WKT.encode(), b"POLYGON((0 0,4 0,4 4,0 4,0 0),(1 1,1 3,3 3,1 1))"),
                    (b"GEOMETRYCOLLECTION(" * deep, b"POLYGON(" + b"(" * deep),
                    options=({}, {"union": True})),
        "geojson": Kind(".geojson", (GEOJSON.encode(), TERRAIN.encode()),
                        (open_geo * deep,
                         b'{"type":"Polygon","coordinates":' + b"[" * 900 + b"]" * 900 + b"}"),
                        options=({}, {"union": True})),
        "visilibity": Kind(".environment", (ENVIRONMENT.encode(),)),
        "movingai": Kind(".map", (MAP.encode(),), options=grid),
        "pgm": Kind(".pgm", (PGM, b"P5 8 6 255\n" + bytes(range(0, 240, 5))),
                    (b"P5 99999999 99999999 255\n1", b"P2 4096 4096 255\n1", b"P5 4096 4096 65535\n1"),
                    options=grid),
        "png": Kind(".png", (_image("PNG"), _image("PNG", "RGBA"), _image("PNG", "P")),
                    (_png(4096, 4096), _png(5000, 20_000), _png_text(1 << 26)), _png_sizes, options=grid),
        "gif": Kind(".gif", (_image("GIF"),), (), _at(6, "<HH"), options=grid),
        "bmp": Kind(".bmp", (_image("BMP"), _image("BMP", "RGB")), (), _at(18, "<II"), options=grid),
        "jpg": Kind(".jpg", (_image("JPEG"), _image("JPEG", "RGB")), (), _jpeg_sizes, options=grid),
        "ros": Kind(".yaml", (YAML.format("plan.png").encode(), LISTED.encode()), (ALIASES,), beside=plan,
                    options=(*grid, {"unknown": "blocked"})),
        "svg": Kind(".svg", (SVG.encode(), CURVES.encode(), (DATA / "boombox.svg").read_bytes()),
                    (LAUGHS, OUTSIDE, b"<svg>" + b"<g>" * deep,
                     b"<svg>" + b'<g transform="rotate(1)">' * 60 + b'<path d="M0 0h9v9z"/>'),
                    options=curved),
        "kicad": Kind(".kicad_pcb", ((DATA / "board.kicad_pcb").read_bytes(),),
                      (b"(kicad_pcb" + b"(" * deep, b'(kicad_pcb "' + b"\\" * deep), options=drawn),
        "dxf": Kind(".dxf", (*DXF, *DXF, (DATA / "issue21.dxf").read_bytes()), (ITSELF, ARRAY),
                    _dxf_values, 50, options=curved),
    }  # fmt: skip


# -- mutations -------------------------------------------------------------------------------------------


def by_bytes(data: bytes, rng: Random) -> bytes:
    """One to four bytes changed, a piece cut out, doubled or moved, or noise put in."""
    out = bytearray(data)
    kind, i, j = rng.randrange(6), rng.randrange(len(out)), rng.randrange(len(out))
    i, j = min(i, j), min(max(i, j), i + 40) if kind != 3 else j
    if kind == 0:
        for _ in range(rng.randint(1, 4)):
            out[rng.randrange(len(out))] = rng.randrange(256)
    elif kind == 1:
        del out[i:j]
    elif kind == 2:
        out[i:i] = out[i:j]
    elif kind == 3:
        del out[i:]
    elif kind == 4:
        out[i:i] = rng.randbytes(rng.randint(1, 8))
    else:
        out[rng.randrange(len(out))] ^= 1 << rng.randrange(8)
    return bytes(out)


_WORDS = re.compile(rb"[A-Za-z_.]+|[-+]?\d[\d.eE]*|\s+|.", re.DOTALL)


def by_structure(data: bytes, rng: Random) -> bytes:
    """Words, numbers and signs of the text exchanged for others, repeated, or left out."""
    words = _WORDS.findall(data)
    for _ in range(rng.randint(1, 3)):
        i, j = rng.randrange(len(words)), rng.randrange(len(words))
        kind = rng.randrange(7)
        numbers = [k for k, word in enumerate(words) if word[-1:].isdigit()]
        if kind < 2 and numbers:
            words[rng.choice(numbers)] = rng.choice(NUMBERS)
        elif kind == 2:
            words[i], words[j] = words[j], words[i]
        elif kind == 3:
            words[i:i] = words[i : i + rng.randint(1, 12)] * rng.choice((1, 1, 30))
        elif kind == 4:
            del words[i : i + rng.randint(1, 12)]
        elif kind == 5 and numbers:
            words[rng.choice(numbers)] = words[rng.choice(numbers)]
        elif numbers:
            k = rng.choice(numbers)
            words[k] += rng.choice((b"e9", b"e-9", b"e99", b"0000000", b".0000000000000001", b"/7", b"e2000"))
        words = words or [b"x"]
    return b"".join(words)


def by_numbers(data: bytes, rng: Random) -> bytes:
    """One to four numbers of the text exchanged for others that are numbers: all else stays whole."""
    words = _WORDS.findall(data)
    numbers = [k for k, word in enumerate(words) if word[-1:].isdigit()]
    for k in rng.choices(numbers, k=rng.randint(1, 4)) if numbers else []:
        own = words[rng.choice(numbers)]
        words[k] = rng.choice(
            (own, own, b"-" + own, own + b"0", b"0", b"1", b"-1", b"1e-9", b"1e9", b"7e99", b"1e-99")
        )
    return b"".join(words)


def by_repetition(data: bytes, rng: Random) -> bytes:
    """A piece thousands of times over, side by side or each within the one before."""
    i = rng.randrange(len(data))
    piece = data[i : i + rng.randint(1, 200)]
    if rng.randrange(4) == 0:  # a whole line, or all up to a bracket
        places = [m.start() for m in re.finditer(rb"[\[{(<\n]", data)] or [0]
        i = rng.choice(places)
        piece = data[i : next((p for p in places if p > i), len(data))] or b"x"
    count = min(rng.choice((30, 1000, 20_000, 100_000)), LONGEST // len(piece))
    return data[:i] + piece * count + (data[i:] if rng.randrange(2) else b"")


def by_splicing(data: bytes, other: bytes, rng: Random) -> bytes:
    """The beginning of one sample, and the end of another one."""
    return data[: rng.randrange(len(data))] + other[rng.randrange(len(other)) :]


STARTS = (None, (1000, 1000), (3, "7/2"), ("1/4", "1/8"), ("1/4", "-1e9"), (12, "0.1"), (1000, 1), (-9, 500))


def hostile(kind: Kind, n: int, name: str) -> tuple[bytes, dict[str, object]]:
    """The n-th hostile file of a format, and the start and options with which it is read."""
    rng = Random(f"{name} {n}")
    options = {"start": rng.choice(STARTS), **rng.choice(kind.options)}
    if n < len(kind.bombs):
        return kind.bombs[n], options
    data, draw = rng.choice(kind.samples), rng.randrange(100)
    if kind.special is not None and draw < kind.share:
        data = kind.special(data, rng)
        return (by_bytes(data, rng) if rng.randrange(3) == 0 else data), options
    draw = rng.randrange(100)
    if draw < 30:
        data = by_numbers(data, rng)
    elif draw < 60:
        data = by_structure(data, rng)
    elif draw < 92:
        data = by_bytes(data, rng)
    elif draw < 98:
        data = by_splicing(data, rng.choice(kind.samples), rng)
    else:
        data = by_repetition(data, rng)
    return data, options


def put(kind: Kind, folder: Path, data: bytes) -> Path:
    """A file of that content, and beside it what it may name."""
    for name, content in kind.beside.items():
        (folder / name).write_bytes(content)
    path = folder / f"a{kind.suffix}"
    path.write_bytes(data)
    return path


def read(name: str, path: Path, options: dict[str, object]) -> None:
    """Read a file as its format's name says."""
    if name == "run":
        xa.load_run(path)
    else:
        xa.load(path, **options)
