"""What a layout of a DXF file shows: the blocks in it expanded and placed, multiple lines taken apart."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Any

from exactacq.errors import FormatError
from exactacq.files.counting import count
from exactacq.files.loops.drawing import Drawing
from exactacq.files.source import MAX_EDGES

MAX_ENTITIES = 2 * MAX_EDGES
"""Most entities and vertices of a file, counted before ezdxf starts: it takes about 2 KB for each."""
MAX_DEPTH = 16
"""Deepest nesting of blocks that is followed; drawings have two or three levels, a loop has no end."""


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


def shown(layout: Iterable[Any], drawing: Drawing, unseen: Unseen) -> Iterator[tuple[Any, str, bool]]:
    """(entity, layer, whether it is hidden), blocks and multiple lines expanded.

    Layer "0" in a block is the layer of its reference.
    """

    def skip(entity: Any, reason: str) -> None:
        """Count an entity of a block that ezdxf cannot place."""
        drawing.dropped[f"{entity.dxftype()} in a block"] += 1

    expanded = multiple = 0
    stack: list[tuple[Iterator[Any], str | None, int, bool]] = [(iter(layout), None, 0, False)]
    while stack:
        entities, outer, depth, is_hidden = stack[-1]
        entity = next(entities, None)
        if entity is None:
            stack.pop()
            continue
        layer = str(entity.dxf.get("layer", "0"))
        layer = outer if outer is not None and layer == "0" else layer
        is_hidden = is_hidden or unseen.hides(entity, layer)
        if entity.dxftype() == "MLINE":
            lines = [part for part in entity.virtual_entities() if part.dxftype() in ("LINE", "ARC")]
            stack.append((iter(lines), layer, depth, is_hidden))
            if lines:
                multiple += 1
            else:
                drawing.dropped["MLINE without a style"] += 1
        elif entity.dxftype() != "INSERT":
            yield entity, layer, is_hidden
        elif depth >= MAX_DEPTH:
            raise FormatError(f"blocks are nested more than {MAX_DEPTH} deep (one in itself?); explode them")
        else:
            expanded += entity.mcount
            if expanded > MAX_ENTITIES:
                raise FormatError(f"it refers to blocks more than {MAX_ENTITIES} times; export one part")
            copies = entity.multi_insert() if entity.mcount > 1 else [entity]
            content = chain.from_iterable(c.virtual_entities(skipped_entity_callback=skip) for c in copies)
            stack.append((content, layer, depth + 1, is_hidden))
    for number, what in ((expanded, "block reference"), (multiple, "MLINE")):
        if number:
            drawing.notes.append(
                f"expanded {count(number, what)}; their content is placed in double precision"
            )
