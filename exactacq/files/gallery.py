"""Scenes that ship with the library: the paper's figures, counterexamples to its claims, and a real part.

Each has its start and radius set. The numbers of the counterexamples are chosen so that a claim just fails.
"""

from __future__ import annotations

from importlib.resources import as_file, files

from exactacq.errors import FormatError
from exactacq.files.by_suffix import load
from exactacq.scene.scene import Scene

_SCENES = {
    "figure1": "the paper's Figure 1: O2 is completely known from O1, yet O3 can only be seen from O2",
    "figure2": "a terrain as in the paper's Figures 2 and 3: 11 obstacles, convex and not, polygons and arcs",
    "circles": "two circles in a row: the path is 5 + 12*pi long",
    "squares": "two squares in a row: the path is 24 long",
    "m4": "a triangle that is glimpsed on the way between two others, but cannot be reached from either",
    "m8": "the link between two obstacles is longer than their distance, for a bar stands between them",
    "m9": "ten crumbs in the slots of a block, seen from across a wide place only: bound (1) fails",
    "m11": "Figure 1 with right angles: a C, a square in its mouth, and a bar that only the square sees",
    "figure3": "the terrain of figure2 swept by the Seed Spreader: three of the eleven are circled",
    "figure4": "the paper's Figure 4: forced directions, ignored crossings, a reversal, a short cut",
    "case1": "a sweep that neither meets nor diverts: its length is A + B + rA, bound (8)",
    "case2": "obstacles inside the strips, one of them at the border: diversions only, bound (9)",
    "case3": "obstacles clear of the border: crossings and diversions, bound (10)",
    "e3": "a wall across the terrain: the next crossing point (eq. 3) lies where the robot cannot walk",
    "m14": "two obstacles become known from the lines and hide a third for good: the sweep misses it",
    "m15": "an obstacle goes out of reach while it is hidden: acquired by a diversion, rule (ii)",
    "m18": "one long obstacle hides two others in turn: how many diversions does that take?",
    "m20-3": "a thin bar across three lines, met again on each: bound (11) fails",
    "m20-6": "the same across six lines: bound (10) fails",
    "m20-8": "the same across eight lines: bound (9) fails",
    "m20-16": "the same across sixteen lines: bound (6) fails",
    "m25": "an obstacle that is hidden for a while: a look ahead on the map spares the diversion",
    "l2": "a single obstacle: one visit, where 2(n - 1) is none",
    "sss5": "one obstacle hides two others in turn and is never in the way: two diversions, n = 3",
    "sss6": "a pocket that cannot be seen from a strip of width 1: the diversion goes a radius of 10 far",
    "sss9": "m14 nearer to the start: what the sweep misses, the Sightseer acquires",
    "relay": "five crumbs, each seen only from the one before: ever longer diversions, bound (6) fails",
    "tight-t1": "four obstacles on which bound (1) fails, found by search",
    "tight-l3": "one triangle that is visited three times: bound (4) fails",
    "tight-t2": "one convex obstacle on which bound (6) fails",
    "tight-t2-snake": "one obstacle in two strips on which bound (6) fails by its many windings",
    "tight-sss2": "one obstacle in three components, of which the middle one is never seen",
    "tight-sss5": "three triangles and two diversions, of which none circles what hid its aim",
    "tight-sss5-fan": "seven convex obstacles and six diversions",
    "plate": "a real part, as a room: the outline is the wall, its fourteen holes are obstacles",
}
_SWEPT = (
    "figure3", "figure4", "case", "e3", "m14", "m15", "m18", "m20", "m25", "sss", "relay",
    "tight-l3", "tight-t2", "tight-sss",
)  # fmt: skip
_PLATE = "issue42.dxf"
_PLATE_START, _PLATE_RADIUS = (-30, -60), 60


def names() -> dict[str, str]:
    """The scenes' names, each with one line on what it shows.

    >>> names()["circles"]
    'two circles in a row: the path is 5 + 12*pi long'
    """
    return dict(_SCENES)


def is_swept(name: str) -> bool:
    """Whether a scene is there for the Seed Spreader."""
    return name.startswith(_SWEPT)


def scene(name: str) -> Scene:
    """The scene of that name, made anew. Raises `FormatError`, which lists the names, if there is none.

    >>> scene("circles")
    <Scene 'circles': 2 obstacles>
    """
    if name not in _SCENES:
        raise FormatError(f"no gallery scene {name[:40]!r}; there are {', '.join(_SCENES)}")
    data = files("exactacq") / "files" / "data"
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
