"""Loading a scene from a file, or from the gallery by its name."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from exactacq.errors import FormatError
from exactacq.files.sources import NamedSource
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
    source = NamedSource(name)
    start = options.pop("start", None)
    if start is not None and source.format is None:
        raise FormatError(
            f"{source.label}: a gallery scene has its own start; give another by .replace(start=...)"
        )
    contents = source.contents(start, options)
    with source.named():
        return contents.scene()
