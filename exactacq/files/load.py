"""Loading a scene from a file, or from the gallery by its name."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from exactacq.errors import FormatError, shown
from exactacq.files import gallery
from exactacq.files.by_suffix import load as load_file
from exactacq.files.by_suffix import load_geo
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import HasGeoInterface


def load(name: str | os.PathLike[str] | HasGeoInterface | Mapping[str, Any], **options: Any) -> Scene:
    """The scene in a file, or else the gallery scene of that name, or that of another library's areas.

    Such areas are all objects with `__geo_interface__`, such as polygons of shapely, lists of them, and dicts
    that are GeoJSON; they are read like GeoJSON. *options* are the start and those of the format: see
    `exactacq.files.by_suffix.load`. Raises `FormatError` if there is no such file or scene or the file cannot
    be read, `InvalidScene` if the scene breaks the rules. Near linear in the size of the file.

    >>> scene = load("circles")
    >>> scene, scene.start, scene.radius
    (<Scene 'circles': 2 obstacles>, Point(0, 0), 20)
    >>> import shapely
    >>> load(shapely.box(2, 2, 3, 3).union(shapely.box(7, 1, 8, 3)), start=(0, 0))
    <Scene: 2 obstacles>
    """
    geo = _geo(name)
    if geo is not None:
        return load_geo(geo, **options)
    if not isinstance(name, str | os.PathLike):
        raise FormatError(f"a file's or scene's name, or areas, are loaded, not {shown(name)}")
    text = os.fspath(name)
    if "\0" in text or os.path.lexists(text):
        return load_file(text, **options)
    if text in gallery.names():
        if options:
            raise FormatError(f"{text}: a gallery scene takes no options for files; leave them out")
        return gallery.scene(text)
    if os.path.splitext(text)[1]:
        return load_file(text, **options)
    raise FormatError(f"{text}: no such file or gallery scene; `exactacq gallery` lists the scenes")


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
