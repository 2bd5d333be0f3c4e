"""Hostile files by structure: a sample is taken apart as its format has it, and put together changed.

What comes out is mostly well-formed, so that it gets past the parsers. Nodes of the tree are left out,
repeated, moved, exchanged, nested, renamed, put in from another sample, or get extreme values.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import deepcopy
from dataclasses import dataclass, field
from random import Random

from hostile_files import LONGEST, NUMBERS, SIZES, STARTS, Kind
from hostile_trees import (
    Branch,
    Node,
    bmp_tree,
    bracket_tree,
    dxf_tree,
    gif_tree,
    jpeg_tree,
    json_tree,
    lines_tree,
    pgm_tree,
    png_tree,
    text,
    xml_tree,
    yaml_tree,
)

DEPTHS = (1, 2, 40, 400, 20_000)
COUNTS = (1, 1, 2, 30, 1000, 20_000)
CHANGES = (1, 1, 1, 2, 4)
"""So many a file gets."""


@dataclass(frozen=True)
class Structure:
    """How a format's files are taken apart, values that hurt, what nests, and other names for its nodes."""

    parse: Callable[[bytes], Node]
    values: tuple[bytes, ...] = NUMBERS
    shells: tuple[tuple[bytes, bytes], ...] = ()
    names: dict[str, tuple[bytes, ...]] = field(default_factory=dict)
    binary: bool = False


_JSON_VALUES = (
    *(n for n in NUMBERS if n[:1].isdigit() or n[:1] == b"-"), b"null", b"true", b"false", b'""', b'"x"',
    b"[]", b"{}", b"NaN", b"-Infinity", *(b'"%b"' % n for n in NUMBERS if n.isascii() and b"\0" not in n),
    b'"\\ud800"', b'"\\u0000"', b'"2*sqrt(5)"', b"1.7976931348623157e308", b"5e-324", b'"sightseer"',
)  # fmt: skip
_JSON = Structure(
    json_tree, _JSON_VALUES, ((b"[", b"]"), (b'{"a": ', b"}"), (b'{"through": ', b"}")),
    {"member": (b'"": ', b'"type": ', b'"name": ', b'"kind": ', b'"start": ', b'"radius": ', b'"terrain": ',
                b'"circle": ', b'"boundary": ', b'"holes": ', b'"crs": ', b'"bbox": ')},
)  # fmt: skip
_XML = Structure(
    xml_tree, (*NUMBERS, b"M", b"A", b"C", b"z", b"%", b"50%", b"mm", b"none", b"rotate",
    b"matrix", b"(", b")"),
    ((b"<g>", b"</g>"), (b'<g transform="rotate(7)">', b"</g>"), (b'<svg viewBox="0 0 7 9">', b"</svg>")),
    {"element": (b"g", b"svg", b"defs", b"use", b"symbol", b"path", b"circle", b"polyline",
    b"line", b"clipPath",
                 b"rect", b"ellipse", b"polygon", b"style", b"text", b"image", b"a", b"switch"),
     "attribute": (b"transform", b"d", b"points", b"viewBox", b"width", b"height", b"style", b"display", b"r",
                   b"rx", b"x", b"id", b"href", b"preserveAspectRatio", b"class", b"visibility")},
)  # fmt: skip
_BRACKETS = Structure(
    bracket_tree,
    (*NUMBERS, b"EMPTY", b"Z", b"ZM", b",", b'""', b'"', b"POLYGON", b"CURVEPOLYGON", b"CIRCULARSTRING",
     b"COMPOUNDCURVE", b"GEOMETRYCOLLECTION", b"MULTISURFACE", b"LINESTRING", b"MULTICURVE",
     b"TRIANGLE", b"TIN"),
    ((b"(", b")"), (b"GEOMETRYCOLLECTION(", b")"), (b"CURVEPOLYGON(", b")"), (b"((", b"), (", )),
)  # fmt: skip
_KICAD = Structure(
    bracket_tree,
    (*NUMBERS, b'"Edge.Cuts"', b"Edge.Cuts", b"at", b"start", b"end", b"mid", b"center", b"gr_arc",
    b"gr_line",
     b"gr_circle", b"gr_poly", b"gr_rect", b"gr_curve", b"pts", b"xy", b"arc", b"footprint", b"angle", b'"'),
    ((b"(", b")"), (b'(footprint "x" (at 1 2 30) ', b")"), (b"(pts ", b")")),
)  # fmt: skip
_DXF = Structure(
    dxf_tree,
    (*NUMBERS, b"LINE", b"ARC", b"CIRCLE", b"ELLIPSE", b"SPLINE", b"INSERT", b"LWPOLYLINE",
    b"POLYLINE", b"VERTEX",
     b"SEQEND", b"BLOCK", b"ENDBLK", b"SECTION", b"ENDSEC", b"EOF", b"BLOCKS", b"ENTITIES",
     b"HATCH", b"SOLID",
     b"MLINE", b"DIMENSION", b"*Model_Space", b"B", b"32767", b"-32768", b"TABLE", b"HEADER", b"TABLES"),
    names={"pair": (b"0\n", b"2\n", b"5\n", b"10\n", b"20\n", b"42\n", b"70\n", b"90\n", b"102\n", b"210\n",
                    b"230\n", b"310\n", b"330\n", b"999\n", b"1004\n", b"1071\n", b"-1\n", b"99999\n", b"x\n",
                    b"40\n", b"41\n", b"43\n", b"62\n", b"66\n", b"67\n", b"71\n", b"72\n",
                    b"73\n", b"410\n")},
)  # fmt: skip
_YAML = Structure(
    yaml_tree,
    (*NUMBERS, b".inf", b".nan", b"~", b"null", b"{}", b"[]", b"{a: 1}",
    b"!!python/object:os.system x", b"*a",
     b"&a 1", b"!!binary aGk=", b"2001-01-01", b"0o17", b"12:30:45", b"|\n  x", b">-\n  plan.png",
     b"plan.png",
     b"../a.yaml", b"a.yaml", b"/dev/zero", b".", b"trinary", b"scale", b"raw", b"'", b'"\\ud800"'),
    ((b"[", b"]"), (b"{a: ", b"}"), (b"\n  - ", b"")),
    {"member": (b"image: ", b"resolution: ", b"origin: ", b"negate: ", b"occupied_thresh: ", b"free_thresh: ",
                b"mode: ", b"? ", b"<<: ", b"[]: ", b"- ", b"1: ", b"{}: ", b"  x: ", b"---\n", b"...\n")},
)  # fmt: skip
_MOVINGAI = Structure(
    lines_tree,
    (*NUMBERS, b"height", b"width", b"map", b"type", b"octile", b"@", b"T", b".", b"G", b"S", b"\r"),
)
_IMAGES = {"png": png_tree, "jpg": jpeg_tree, "gif": gif_tree, "bmp": bmp_tree}
_CHUNKS = (
    b"IHDR",
    b"PLTE",
    b"tRNS",
    b"IEND",
    b"acTL",
    b"fcTL",
    b"fdAT",
    b"iCCP",
    b"gAMA",
    b"tEXt",
    b"iTXt",
    b"sPLT",
)
_SEGMENTS = tuple(
    bytes((255, k)) for k in (0xC0, 0xC1, 0xC2, 0xC4, 0xC9, 0xDA, 0xDB, 0xDD, 0xE0, 0xE1, 0xE2, 0xEE, 0xD9)
)

STRUCTURES: dict[str, Structure] = {
    "json": _JSON, "run": _JSON, "geojson": _JSON, "wkt": _BRACKETS, "kicad": _KICAD, "svg": _XML,
    "dxf": _DXF,
    "ros": _YAML, "visilibity": Structure(lines_tree, (*NUMBERS, b"//", b"//x", b" ", b"\r", b"//Outer")),
    "movingai": _MOVINGAI, "pgm": Structure(pgm_tree, (*NUMBERS, b"P2", b"P5", b"#", b"255", b"65535", b" ")),
    **{name: Structure(parse, binary=True, names={"chunk": _CHUNKS, "segment": _SEGMENTS})
       for name, parse in _IMAGES.items()},
}  # fmt: skip


def places_of(node: Node) -> Iterator[tuple[Node, Branch, int]]:
    """All nodes below one, each with the branch that holds it and its number there."""
    if isinstance(node, Branch):
        for k, item in enumerate(node.items):
            yield item, node, k
            yield from places_of(item)


def _kind(node: Node) -> str:
    return node.kind if isinstance(node, Branch) else ""


def changed(tree: Node, other: Node, structure: Structure, rng: Random) -> bool:
    """Change one place of a tree; *other* is another sample, or the same again. Whether it grew long."""
    places = list(places_of(tree))
    if not places:
        return False
    # Leaves are many, branches do more: half of the changes are for these.
    branches = [place for place in places if isinstance(place[0], Branch)]
    node, holder, k = rng.choice(branches if branches and rng.randrange(2) else places)
    alike = [n for n, _, _ in places_of(rng.choice((tree, tree, other))) if _kind(n) == _kind(node)] or [node]
    action = rng.randrange(9)
    if action in (4, 6) and isinstance(node, Branch) and node.kind == "member" and node.items:  # its value
        node, holder, k = node.items[0], node, 0
    if action == 0:
        del holder.items[k : k + rng.choice((1, 1, 2, len(holder.items)))]
    elif action == 1:
        size = len(text(node)) + len(holder.joint) + 1
        count = min(rng.choice(COUNTS), LONGEST // 2 // size)
        holder.items[k:k] = [node] * count
        return count > 2
    elif action == 2:
        holder.items[k] = deepcopy(rng.choice(alike))
    elif action == 3:
        rng.shuffle(holder.items)
    elif action == 4 and structure.shells:
        before, after = rng.choice(structure.shells)
        depth = min(rng.choice(DEPTHS), LONGEST // 2 // len(before + after))
        holder.items[k] = before * depth + text(node) + after * depth
        return depth > 2
    elif action == 5 and isinstance(node, Branch):
        names = structure.names.get(node.kind, ())
        other_name = rng.choice([n for n in alike if isinstance(n, Branch)]).opening
        node.opening = rng.choice((other_name, *names))
    elif action == 6 and isinstance(node, Branch) and node.items:  # what is in it comes into its place
        inner = rng.choice(node.items)
        values = inner.items if isinstance(inner, Branch) and inner.kind == "member" else [inner]
        holder.items[k : k + 1] = values if node.kind in ("object", "array") else node.items
    elif isinstance(node, bytes):
        holder.items[k] = _binary(node, rng) if structure.binary else _value(node, alike, structure, rng)
    else:
        holder.items.insert(rng.randint(0, len(holder.items)), deepcopy(rng.choice(alike)))
    return False


def _value(leaf: bytes, alike: list[Node], structure: Structure, rng: Random) -> bytes:
    draw = rng.randrange(5)
    if draw == 0 and leaf.removeprefix(b"-").isdigit() and len(leaf) < 99:
        return b"%d" % (int(leaf) + rng.choice((-1, 1, 2, 10**6)))
    if draw == 1:
        return b"-" + leaf
    if draw == 2:
        return text(rng.choice(alike))
    return rng.choice(structure.values)


def _binary(leaf: bytes, rng: Random) -> bytes:
    """A field of as many bytes, or of others."""
    size = len(leaf)
    draw = rng.randrange(6)
    if draw < 3 and 0 < size <= 4:
        order = rng.choice(("big", "little"))
        number = rng.choice((*SIZES, int.from_bytes(leaf, "big") + 1)) % (1 << 8 * size)
        return number.to_bytes(size, order)
    if draw == 3:
        return rng.choice((b"\0", b"\xff")) * size
    if draw == 4:
        return leaf[: rng.randint(0, size)] + leaf * rng.choice((0, 0, 1, 300 if size < 4096 else 2))
    return rng.randbytes(size)


def structured(kind: Kind, n: int, name: str) -> tuple[bytes, dict[str, object]]:
    """The n-th file of a format that is hostile by its structure, and the start and options to read it by."""
    rng = Random(f"{name} by structure {n}")
    options = {"start": rng.choice(STARTS), **rng.choice(kind.options)}
    structure = STRUCTURES[name]
    tree, other = (structure.parse(rng.choice(kind.samples)) for _ in range(2))
    if name == "dxf" and rng.randrange(4) == 0:
        _insert(tree, rng)
    for _ in range(rng.choice(CHANGES)):
        if changed(tree, other, structure, rng):
            break  # Nothing is multiplied twice.
    return text(tree) or b" ", options


def _insert(tree: Node, rng: Random) -> None:
    """Blocks that hold references to each other or to themselves, in circles or as arrays of arrays."""
    blocks = [node for node, _, _ in places_of(tree) if isinstance(node, Branch) and node.kind == "block"]
    entities = [node for node, _, _ in places_of(tree) if isinstance(node, Branch) and node.kind == "section"]
    for _ in range(rng.randint(1, 6)):
        holder = rng.choice([*blocks, *entities])
        name = rng.choice([b"B", b"b", b"*U1", b"*Model_Space", b""])
        count = rng.choice([b"1", b"3", b"200", b"32767", b"-1"])
        rows = [(b"0", b"INSERT"), (b"8", b"0"), (b"2", name), (b"70", count), (b"71", count), (b"44", b"1")]
        rows += [(b"41", rng.choice(NUMBERS))] if rng.randrange(3) == 0 else []
        pairs: list[Node] = [Branch("pair", code + b"\n", [value]) for code, value in rows]
        holder.items.insert(
            rng.randint(1, max(1, len(holder.items) - 1)), Branch("entity", b"", pairs, b"", b"\n")
        )
    if blocks and rng.randrange(2):
        again = deepcopy(rng.choice(blocks))
        named = [p for e in again.items[:1] if isinstance(e, Branch) for p in e.items]
        for pair in named:
            if isinstance(pair, Branch) and pair.opening == b"2\n":
                pair.items[:] = [rng.choice([b"C", b"B", b"b"])]
        sections = [s for s in entities if any(item in blocks for item in s.items)]
        for section in sections:
            section.items.insert(1, again)
