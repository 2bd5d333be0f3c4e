"""Files taken apart as their formats have it, as trees, and put together again.

Checksums, lengths, brackets and end tags are written anew, so that what is changed between is well-formed.
"""

from __future__ import annotations

import json
import re
import struct
import xml.etree.ElementTree as ET
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeGuard
from xml.sax.saxutils import quoteattr


@dataclass
class Branch:
    """A node with nodes in it; only nodes of one kind are exchanged. *opening* says what it is called."""

    kind: str
    opening: bytes
    items: list[Node]
    closing: bytes = b""
    joint: bytes = b""


Node = bytes | Branch


def text(node: Node) -> bytes:
    """The node as a piece of the file."""
    if isinstance(node, bytes):
        return node
    if node.kind in _WRITTEN:
        return _WRITTEN[node.kind](node)
    return node.opening + node.joint.join(map(text, node.items)) + node.closing


# -- formats of text -----------------------------------------------------------------------------------


def json_tree(data: bytes) -> Node:
    return _json_node(json.loads(data))


def _json_node(value: object) -> Node:
    if isinstance(value, dict):
        members: list[Node] = [
            Branch("member", json.dumps(k).encode() + b": ", [_json_node(v)]) for k, v in value.items()
        ]
        return Branch("object", b"{", members, b"}", b", ")
    if isinstance(value, list):
        return Branch("array", b"[", [_json_node(v) for v in value], b"]", b", ")
    return json.dumps(value).encode()


_WORDS = re.compile(rb"[A-Za-z]+|[-+]?[\d.]+(?:[eE][-+]?\d+)?|[^\s,]")


def xml_tree(data: bytes) -> Node:
    return _element(ET.fromstring(data))


def _element(node: ET.Element) -> Branch:
    name = str(node.tag).rpartition("}")[2].encode()
    items: list[Node] = [
        Branch("attribute", key.rpartition("}")[2].encode(), list(_WORDS.findall(value.encode())), b"", b" ")
        for key, value in node.attrib.items()
    ]
    for child in node:
        items.append(_element(child))
    return Branch("element", name, items)


def _element_text(node: Branch) -> bytes:
    attributes = {a.opening: text(a) for a in node.items if _is_attribute(a)}
    children = b"".join(text(c) for c in node.items if not _is_attribute(c))
    begin = b" ".join((node.opening, *attributes.values()))
    return b"<%b>%b</%b>" % (begin, children, node.opening)


def _is_attribute(node: Node) -> TypeGuard[Branch]:
    return isinstance(node, Branch) and node.kind == "attribute"


def _attribute_text(node: Branch) -> bytes:
    value = node.joint.join(map(text, node.items)).decode("utf-8", "replace")
    return node.opening + b"=" + quoteattr(value).encode()


def bracket_tree(data: bytes) -> Node:
    """Lists in round brackets, as of WKT and KiCad; strings in quotes are words."""
    words = re.findall(rb'"(?:[^"\\]|\\.)*"|[(),]|[^\s(),"]+', data)
    return Branch("list", b"", list(_listed(iter(words))), b"", b" ")


def _listed(words: Iterator[bytes]) -> Iterator[Node]:
    for word in words:
        if word == b")":
            return
        yield Branch("list", b"(", list(_listed(words)), b")", b" ") if word == b"(" else word


def lines_tree(data: bytes) -> Node:
    """Lines of words: environments and maps of characters."""
    lines: list[Node] = [
        Branch("line", b"", list(_word_pieces(line)), b"", b"") for line in data.split(b"\n")
    ]
    return Branch("lines", b"", lines, b"", b"\n")


def _word_pieces(line: bytes) -> Iterator[Node]:
    yield from re.findall(rb"\s+|[\w.]+|.", line) or [b""]


def yaml_tree(data: bytes) -> Node:
    """Keys and values; a value may be a list."""
    lines: list[Node] = []
    for line in data.rstrip().split(b"\n"):
        key, colon, value = line.partition(b": ")
        listed = value.startswith(b"[")
        items: list[Node] = list(value.strip(b"[]").split(b", ")) if listed else [value or b""]
        inner: Node = Branch("value", b"[", items, b"]", b", ") if listed else items[0]
        lines.append(Branch("member", key + colon, [inner]))
    return Branch("lines", b"", lines, b"", b"\n")


def dxf_tree(data: bytes) -> Node:
    """Sections of entities, or of blocks of entities; these are lists of values, each called by its code."""
    lines = data.replace(b"\r\n", b"\n").split(b"\n")
    pairs = [Branch("pair", c.strip() + b"\n", [v]) for c, v in zip(lines[::2], lines[1::2], strict=False)]
    entities: list[Branch] = []
    for pair in pairs:
        if pair.opening == b"0\n" or not entities:
            entities.append(Branch("entity", b"", [], b"", b"\n"))
        entities[-1].items.append(pair)
    blocks = _grouped(entities, b"BLOCK", b"ENDBLK", "block")
    sections = _grouped(blocks, b"SECTION", b"ENDSEC", "section")
    return Branch("file", b"", list(sections), b"\n", b"\n")


def _grouped(nodes: list[Branch], first: bytes, last: bytes, kind: str) -> list[Branch]:
    out: list[Branch] = []
    inside = False
    for node in nodes:
        word = text(node.items[0]) if node.kind == "entity" else b""
        if word == b"0\n" + first:
            out.append(Branch(kind, b"", [], b"", b"\n"))
            inside = True
        if inside:
            out[-1].items.append(node)
        else:
            out.append(node)
        inside = inside and word != b"0\n" + last
    return out


# -- images ----------------------------------------------------------------------------------------------


def _cut(data: bytes, *sizes: int) -> list[Node]:
    """Fields of so many bytes, and the rest."""
    fields: list[Node] = []
    place = 0
    for size in sizes:
        fields.append(data[place : place + size])
        place += size
    return [*fields, data[place:]]


def png_tree(data: bytes) -> Node:
    chunks: list[Node] = []
    place = 8
    while place + 8 <= len(data):
        (size,) = struct.unpack_from(">I", data, place)
        kind, body = data[place + 4 : place + 8], data[place + 8 : place + 8 + size]
        if kind == b"IDAT":
            chunks.append(Branch("packed", kind, [zlib.decompress(body)]))
        else:
            chunks.append(
                Branch("chunk", kind, _cut(body, 4, 4, 1, 1, 1, 1, 1) if kind == b"IHDR" else [body])
            )
        place += 12 + size
    return Branch("file", data[:8], chunks)


def _chunk_text(node: Branch) -> bytes:
    body = b"".join(map(text, node.items))
    if node.kind == "packed":
        body = zlib.compress(body)
    return (
        struct.pack(">I", len(body))
        + node.opening
        + body
        + struct.pack(">I", zlib.crc32(node.opening + body))
    )


def jpeg_tree(data: bytes) -> Node:
    """Segments; what follows the start of the scan is one piece."""
    segments: list[Node] = []
    place = 2
    while place + 4 <= len(data) and data[place] == 0xFF:
        marker = data[place : place + 2]
        (size,) = struct.unpack_from(">H", data, place + 2)
        body = data[place + 4 : place + 2 + size]
        frame = marker in (b"\xff\xc0", b"\xff\xc2")
        segments.append(
            Branch("segment", marker, _cut(body, 1, 2, 2, 1, 1, 1, 1) if frame else _cut(body, 1, 16))
        )
        place += 2 + size
        if marker == b"\xff\xda":
            break
    return Branch("file", data[:2], [*segments, data[place:]])


def _segment_text(node: Branch) -> bytes:
    body = b"".join(map(text, node.items))
    return node.opening + struct.pack(">H", min(len(body) + 2, 0xFFFF)) + body


def gif_tree(data: bytes) -> Node:
    """The header, the palette, and the blocks of the image."""
    header = _cut(data[:13], 6, 2, 2, 1, 1, 1)[:6]
    size = 3 * 2 ** ((data[10] & 7) + 1) if data[10] & 0x80 else 0
    rest = data[13 + size :]
    place = max(rest.find(b","), 0)
    image = _cut(rest[place:], 1, 2, 2, 2, 2, 1, 1, 1)
    parts: list[Node] = [
        Branch("fields", b"", header), Branch("fields", b"", [data[13 : 13 + size]]),
        Branch("fields", b"", [rest[:place]]), Branch("fields", b"", image),
    ]  # fmt: skip
    return Branch("file", b"", parts)


def bmp_tree(data: bytes) -> Node:
    """Both headers field by field, the palette colour by colour, and the rows."""
    (begin,) = struct.unpack_from("<I", data, 10)
    palette = data[54:begin]
    colours: list[Node] = [palette[k : k + 4] for k in range(0, len(palette), 4)]
    header = _cut(data[:54], 2, 4, 4, 4, 4, 4, 4, 2, 2, 4, 4, 4, 4, 4, 4)[:15]
    rows = data[begin:]
    parts: list[Node] = [
        Branch("fields", b"", header),
        Branch("fields", b"", colours),
        Branch("fields", b"", [rows]),
    ]
    return Branch("file", b"", parts)


def pgm_tree(data: bytes) -> Node:
    """Words of the header and the samples, with what is between them."""
    if data.startswith(b"P5"):
        head, sep, raster = data.partition(b"255\n")
        return Branch("file", b"", [*re.findall(rb"\s+|[^\s]+", head + sep), raster])
    return lines_tree(data)


_WRITTEN: dict[str, Callable[[Branch], bytes]] = {
    "element": _element_text,
    "attribute": _attribute_text,
    "chunk": _chunk_text,
    "packed": _chunk_text,
    "segment": _segment_text,
}  # fmt: skip
