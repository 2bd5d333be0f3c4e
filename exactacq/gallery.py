"""Scenes that ship with the library: the paper's figures, counterexamples to its claims, and a real part.

Each has its start and radius set. The numbers of the counterexamples are chosen so that a claim just fails.
"""

from __future__ import annotations

from importlib.resources import as_file, files

from exactacq.errors import FormatError
from exactacq.formats import load
from exactacq.scene import Scene

_SCENES = {
    "figure1": "the paper's Figure 1: O2 is completely known from O1, yet O3 can only be seen from O2",
    "figure2": "a terrain as in the paper's Figures 2 and 3: 11 obstacles, convex and not, polygons and arcs",
    "circles": "two circles in a row: the path is 5 + 12*pi long",
    "squares": "two squares in a row: the path is 24 long",
    "m4": "a triangle that is glimpsed on the way between two others, but cannot be reached from either",
    "m8": "the link between two obstacles is longer than their distance, for a bar stands between them",
    "m9": "ten crumbs in the slots of a block, seen from across a wide place only: bound (1) fails",
    "m11": "Figure 1 with right angles: a C, a square in its mouth, and a bar that only the square sees",
    "plate": "a real part, as a room: the outline is the wall, its fourteen holes are obstacles",
}
_PLATE = "issue42.dxf"
_PLATE_START, _PLATE_RADIUS = (-30, -60), 60


def names() -> dict[str, str]:
    """The scenes' names, each with one line on what it shows."""
    return dict(_SCENES)


def scene(name: str) -> Scene:
    """The scene of that name, made anew. Raises `FormatError`, which lists the names, if there is none."""
    if name not in _SCENES:
        raise FormatError(f"no gallery scene {name[:40]!r}; there are {', '.join(_SCENES)}")
    data = files("exactacq") / "data"
    if name == "plate":
        with as_file(data / _PLATE) as path:
            part = load(path, start=_PLATE_START)
        return Scene(
            part.shapes,
            part.start,
            enclosure=part.enclosure,
            radius=_PLATE_RADIUS,
            name=name,
            notes=part.notes,
        )
    with as_file(data / "gallery" / f"{name}.json") as path:
        return load(path)
