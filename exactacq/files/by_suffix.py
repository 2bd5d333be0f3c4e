"""Scenes from files; the suffix of the file's name chooses the format: JSON or DXF."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.scene_json import load_json, scene_to_json
from exactacq.files.source import one_line
from exactacq.geometry.points import Point
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import rational_pair

__all__ = ["load", "scene_to_json"]

SUFFIXES = (".json", ".dxf")


def load(
    path: str | Path,
    *,
    start: Point | Sequence[object] | None = None,
    layers: Iterable[str] | None = None,
    outer: str = "wall",
    tolerance: object = None,
    union: bool = False,
) -> Scene:
    """The scene in a file.

    *start*, a pair of numbers, overrides a JSON scene's and is required for a drawing. The other options
    apply to drawings only: *layers* (a name or several; all by default), *outer* (what becomes of the
    outermost loop around the start: "wall" or "drop"), *tolerance* (how far apart ends are joined, in the
    drawing's unit), *union* (merge overlapping polygons). What an importer did is in the scene's ``notes``.

    Raises `FormatError` for a file that cannot be read or an option that makes no sense, and `InvalidScene`
    for a scene that breaks the rules; each message is one line. Near linear in the file.

    >>> from importlib.resources import files
    >>> load(files("exactacq") / "files" / "data" / "issue42.dxf", start=(-30, -60))
    <Scene 'issue42': 15 obstacles>
    """
    suffix = Path(path).suffix.lower()
    options = {"layers": layers, "outer": outer, "tolerance": tolerance, "union": union}
    try:
        if suffix == ".json":
            if unused := [name for name, value in options.items() if value not in (None, False, "wall")]:
                raise FormatError(f"{', '.join(unused)} is for drawings, not for JSON scenes; leave it out")
            return load_json(path, _place(start))
        if suffix == ".dxf":
            from exactacq.files.dxf.load import load_dxf  # ezdxf takes half a second to import

            return load_dxf(path, _place(start), layers, outer=outer, tolerance=tolerance, union=union)
        kind = f"unknown file type {one_line(repr(suffix))}" if suffix else "a file name without a type"
        raise FormatError(f"{kind}; known are {' and '.join(SUFFIXES)}")
    except FormatError as error:
        raise FormatError(f"{one_line(path)}: {error}") from None


def _place(start: Point | Sequence[object] | None) -> tuple[fmpq, fmpq] | None:
    if start is None:
        return None
    if isinstance(start, Point):
        if start.rational is None:
            raise FormatError(f"the start {start} is not rational: give two rational numbers")
        return start.rational
    return rational_pair(start)
