"""JSON files: scenes of this library, and what others write as JSON, told apart by their keys.

`DIALECTS` lists what is read beside scenes: GeoJSON under the suffix .json, and the environments of
extremitypathfinder, a ``boundary`` and ``holes`` as lists of vertices. No scene has such keys, so there is
nothing to choose.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from flint import fmpq

from exactacq.errors import FormatError, about, shown
from exactacq.files.geojson import geo_contents
from exactacq.files.loops.areas import Areas
from exactacq.files.loops.contents import Contents
from exactacq.files.scene_json import contents_of, read_document
from exactacq.files.source import one_line
from exactacq.scene.bends import rational_pair

Place = tuple[fmpq, fmpq]


@dataclass(frozen=True, slots=True)
class Dialect:
    """What another program writes as JSON: its title, the keys that tell it, and what reads it.

    *read* takes the document, the name of the file without its suffix, and the start.
    """

    title: str
    keys: tuple[str, ...]
    read: Callable[[Mapping[str, Any], str, Place | None], Contents]


def load_json(path: Path, start: Place | None = None) -> Contents:
    """The parts of the scene in a JSON file; *start*, if given, overrides the file's.

    Raises `FormatError` (with the place in the file) for what is none. Linear in the file.
    """
    document = read_document(path)
    if isinstance(document, dict):
        for dialect in DIALECTS:
            if document.keys() >= set(dialect.keys):
                return dialect.read(document, path.stem, start)
    return contents_of(document, start)


def _environment(document: Mapping[str, Any], name: str, start: Place | None) -> Contents:
    """The boundary is the wall, the holes are obstacles, as in extremitypathfinder."""
    if unknown := [key for key in document if key not in ("boundary", "holes")]:
        told = one_line(repr(unknown[0]))
        raise FormatError(f"an environment has a boundary and holes, not {told}; leave it out")
    rings = [document["boundary"], *_listed(document["holes"], "holes")]
    areas = Areas()
    for k, ring in enumerate(rings):
        label = f"hole {k}" if k else "boundary"
        with about(label):
            rows = [(*rational_pair(row), fmpq(0)) for row in _listed(ring, "vertices")]
            if len({row[:2] for row in rows}) < 3:
                raise FormatError("three vertices are needed; correct the file")
            areas.add([*rows, rows[0]], label)
    wall, *obstacles = areas.rings
    return Contents(name=name, loops=tuple(obstacles), wall=wall, start=start, notes=tuple(areas.mended()))


def _listed(value: Any, what: str) -> list[Any]:
    if not isinstance(value, list):
        raise FormatError(f"{what}: a list is needed, not {shown(value)}; correct the file")
    return value


def _run(_: Mapping[str, Any], __: str, ___: Place | None) -> Contents:
    raise FormatError(
        "this is a run, not a scene: exactacq.load_run reads it (its scene is .scene), and "
        "`exactacq convert` writes it as a drawing"
    )


DIALECTS = (
    Dialect("environments of extremitypathfinder", ("boundary", "holes"), _environment),
    Dialect("GeoJSON", ("type", "coordinates"), geo_contents),
    Dialect("GeoJSON", ("type", "geometry"), geo_contents),
    Dialect("GeoJSON", ("type", "features"), geo_contents),
    Dialect("GeoJSON", ("type", "geometries"), geo_contents),
    Dialect("runs", ("format", "version", "scene"), _run),
)
"""What is told by its keys, beside scenes."""
