"""What a layout of a DXF file shows: the blocks in it expanded and placed, multiple lines taken apart."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from ezdxf import transform
from ezdxf.math import Matrix44

from exactacq.errors import FormatError
from exactacq.files.counting import count
from exactacq.files.loops.drawing import Drawing
from exactacq.files.source import MAX_EDGES

MAX_ENTITIES = 2 * MAX_EDGES
"""Most entities and vertices of a file, counted before ezdxf starts: it takes about 2 KB for each."""
MAX_DEPTH = 16
"""Deepest nesting of blocks that is followed; drawings have two or three levels, a loop has no end."""
READ = ("LINE", "ARC", "CIRCLE", "LWPOLYLINE", "POLYLINE", "ELLIPSE", "SPLINE")
"""The kinds of entities that may be read."""


class Unseen:
    """The layers of a document that are switched off or frozen."""

    def __init__(self, document: Any) -> None:
        layers = {layer.dxf.name.casefold(): layer for layer in document.layers}
        self._frozen = {name for name, layer in layers.items() if layer.is_frozen()}
        self._off = {name for name, layer in layers.items() if layer.is_off()}

    def hides(self, entity: Any, layer: str) -> bool:
        """Whether an entity on a layer is hidden; a reference to a block is not by a layer that is off."""
        name = layer.casefold()
        if entity.dxf.get("invisible", 0) or name in self._frozen:
            return True
        return name in self._off and entity.dxftype() != "INSERT"


@dataclass(frozen=True, slots=True)
class _BlockLevel:
    """The entities of a layout or of blocks in it, each with the matrix that places it: None in a layout.

    *layer* is that of the reference to the block, *depth* how many blocks there are around.
    """

    entities: Iterator[tuple[Any, Matrix44 | None]]
    layer: str | None = None
    depth: int = 0
    is_hidden: bool = False


def shown(layout: Iterable[Any], drawing: Drawing, unseen: Unseen) -> Iterator[tuple[Any, str, bool]]:
    """(entity, layer, whether it is hidden), blocks and multiple lines expanded.

    Layer "0" in a block is the layer of its reference. Entities of other kinds than `READ` stay where they
    are in their block.
    """
    placed = expanded = multiple = 0
    stack = [_BlockLevel((entity, None) for entity in layout)]
    while stack:
        level = stack[-1]
        entity, matrix = next(level.entities, (None, None))
        if entity is None:
            stack.pop()
            continue
        kind, layer = entity.dxftype(), str(entity.dxf.get("layer", "0"))
        layer = level.layer if level.layer is not None and layer == "0" else layer
        is_hidden = level.is_hidden or unseen.hides(entity, layer)
        if kind == "MLINE":
            lines = [part for part in entity.virtual_entities() if part.dxftype() in ("LINE", "ARC")]
            stack.append(_BlockLevel(iter([(line, matrix) for line in lines]), layer, level.depth, is_hidden))
            if lines:
                multiple += 1
            else:
                drawing.dropped["MLINE without a style"] += 1
        elif kind == "INSERT":
            if level.depth >= MAX_DEPTH:
                raise FormatError(
                    f"blocks are nested more than {MAX_DEPTH} deep (one in itself?); explode them"
                )
            block = entity.block()
            if block is None:
                drawing.dropped["INSERT of a missing block"] += 1
                continue
            expanded += entity.mcount
            placed += entity.mcount * _weight(block)
            if placed > MAX_ENTITIES:
                raise FormatError(
                    f"its blocks expand to more than {MAX_ENTITIES} entities and vertices; export one part"
                )
            stack.append(_BlockLevel(_content(entity, block, matrix), layer, level.depth + 1, is_hidden))
        elif matrix is None or kind not in READ:
            yield entity, layer, is_hidden
        else:
            parts = _placed(entity, matrix)
            if not parts:
                drawing.dropped[f"{kind} in a block"] += 1
            yield from ((part, layer, is_hidden) for part in parts)
    for number, what in ((expanded, "block reference"), (multiple, "MLINE")):
        if number:
            drawing.notes.append(
                f"expanded {count(number, what)}; their content is placed in double precision"
            )


def _weight(block: Iterable[Any]) -> int:
    """How many entities and vertices it takes to place a block: what shows nothing takes its time, too."""
    return 1 + sum(1 + _vertices(entity) for entity in block)


def _vertices(entity: Any) -> int:
    """How many vertices an entity of many has."""
    kind = entity.dxftype()
    if kind in ("LWPOLYLINE", "POLYLINE"):
        return len(entity)
    return len(entity.vertices if kind == "MLINE" else entity.control_points if kind == "SPLINE" else ())


def _content(
    reference: Any, block: Iterable[Any], outer: Matrix44 | None
) -> Iterator[tuple[Any, Matrix44 | None]]:
    """The entities of a block as often as a reference places it, but for the templates of attributes.

    Matrices are multiplied, and each entity is placed once, by the product. References in a block are not
    placed as entities are: in a block that is stretched along one axis, a turned one has no two scales.
    """
    for copy in reference.multi_insert() if reference.mcount > 1 else [reference]:
        matrix = copy.matrix44()
        matrix = matrix if outer is None else matrix * outer
        yield from ((entity, matrix) for entity in block if entity.dxftype() != "ATTDEF")


def _placed(entity: Any, matrix: Matrix44) -> list[Any]:
    """What a matrix makes of an entity, several parts of a polyline with arcs that become elliptical.

    None of an entity that ezdxf cannot place, or that a scale of 0 makes nothing of.
    """
    try:
        return list(transform.copies([entity], matrix)[1])
    except (ArithmeticError, ValueError):
        return []
