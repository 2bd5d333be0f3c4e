"""Where scenes come from: a file, the gallery, or another library's areas."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from pathlib import Path
from typing import Any, cast

from exactacq.errors import FormatError, shown
from exactacq.files import gallery
from exactacq.files.by_suffix import contents_of, contents_of_geo, naming
from exactacq.files.formats import Format, format_of
from exactacq.files.loops.contents import Contents
from exactacq.geometry.points import Point
from exactacq.scene.shapes import HasGeoInterface


class NamedSource:
    """What a name stands for: a file, or else a gallery scene; or areas with `__geo_interface__`.

    ``label`` names it in messages, and ``format`` is None for a gallery scene. Raises `FormatError` for
    neither, and for a file of an unknown format.
    """

    def __init__(self, name: str | os.PathLike[str] | HasGeoInterface | Mapping[str, Any]) -> None:
        self.geo = _geo(name)
        if self.geo is None and not isinstance(name, str | os.PathLike):
            raise FormatError(f"a file's or scene's name, or areas, are loaded, not {shown(name)}")
        self.label = "" if self.geo is not None else os.fspath(cast("str | os.PathLike[str]", name))
        self.format: Format | None = None
        is_file = "\0" in self.label or os.path.lexists(self.label)
        if self.geo is not None:
            self.format = format_of(Path("x.geojson"))
        elif is_file or (self.label not in gallery.names() and os.path.splitext(self.label)[1]):
            with naming(self.label):
                if os.path.isdir(self.label):
                    raise FormatError("this is a directory; give a file in it")
                self.format = format_of(Path(self.label))
        elif self.label not in gallery.names():
            near = get_close_matches(self.label.lower(), gallery.names(), 1)
            hint = f"did you mean {near[0]}?" if near else "`exactacq gallery` lists the scenes"
            raise FormatError(f"{self.label}: no such file or gallery scene; {hint}")

    def contents(self, start: Point | Sequence[object] | None, options: Mapping[str, Any]) -> Contents:
        """What it holds, before anything is decided; `FormatError` as `exactacq.load`."""
        with self.named():
            if self.geo is not None:
                return contents_of_geo(self.geo, start, options)
            if self.format is not None:
                return contents_of(self.label, start, options)
            if options:
                raise FormatError("a gallery scene takes no options for files; leave them out")
            return _of_gallery(self.label, start)

    @contextmanager
    def named(self) -> Iterator[None]:
        """Put the name of a file or scene before what a `FormatError` says of it."""
        if self.geo is not None:
            yield
        else:
            with naming(self.label):
                yield


def _geo(value: Any) -> Mapping[str, Any] | None:
    """What an object says of where it is; a list of such objects is a collection. None for anything else."""
    if isinstance(value, Mapping):
        return value
    if isinstance(value, list | tuple) and value:
        parts = [_geo(part) for part in value]
        if any(part is None for part in parts):
            return None
        return {"type": "GeometryCollection", "geometries": parts}
    geo: Mapping[str, Any] | None = getattr(value, "__geo_interface__", None)
    return geo


def _of_gallery(name: str, start: Point | Sequence[object] | None) -> Contents:
    scene = gallery.scene(name)
    place = scene.start if start is None else Point.of(start)
    return Contents(
        name=scene.name,
        loops=scene.shapes,
        wall=scene.enclosure,
        start=None if place is None else place.rational,
        radius=scene.radius,
        terrain=scene.terrain,
        notes=scene.notes,
    )
