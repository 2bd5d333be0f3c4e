"""Scenes from files; the suffix of the file's name chooses the format, see `exactacq.files.formats`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from flint import fmpq

from exactacq.errors import FormatError, InvalidScene
from exactacq.files.formats import Format, format_of
from exactacq.files.source import one_line
from exactacq.geometry.points import Point
from exactacq.scene.bends import rational_pair
from exactacq.scene.scene import Scene
from exactacq.scene.validation import DISJOINT, SIMPLE, WITHIN


def load(path: str | Path, *, start: Point | Sequence[object] | None = None, **options: Any) -> Scene:
    """The scene in a file.

    *start*, a pair of numbers, overrides a JSON scene's and is required for a drawing. Which *options* there
    are depends on the format: `exactacq.formats` tells. Those of drawings are *layers* (a name or several;
    all by default), *outer* (what becomes of the outermost loop around the start: "wall" or "drop"; with
    "room" the innermost one is the wall), *tolerance* (how far apart ends are joined, in the drawing's unit),
    *union* (merge loops that overlap). What an importer did is in the scene's ``notes``.

    Raises `FormatError` for a file that cannot be read or an option that makes no sense, and `InvalidScene`
    for a scene that breaks the rules; each message is one line. Near linear in the file.

    >>> from importlib.resources import files
    >>> load(files("exactacq") / "files" / "data" / "issue42.dxf", start=(-30, -60))
    <Scene 'issue42': 15 obstacles>
    """
    try:
        known = format_of(Path(path))
        return known.read(Path(path), _place(start), options)
    except FormatError as error:
        raise FormatError(f"{one_line(path)}: {error}") from None
    except InvalidScene as error:
        raise InvalidScene(error.violations, _cure(error, known, options)) from None


def load_geo(
    document: Mapping[str, Any], *, start: Point | Sequence[object] | None = None, **options: Any
) -> Scene:
    """The scene of areas told as GeoJSON, with the options of that format; errors as those of `load`."""
    from exactacq.files.geojson import scene_of_geo

    values = format_of(Path("x.geojson")).checked(options)
    return scene_of_geo(document, None, _place(start), **values)


def _cure(error: InvalidScene, known: Format, options: Mapping[str, object]) -> str:
    """What may help where loops of a file meet: an option, or else what to do with the file."""
    told = " ".join(error.violations)
    names = [option.name for option in known.options]
    cures = []
    if any(rule in told for rule in (DISJOINT, WITHIN)):
        if "union" in names and not options.get("union"):
            cures.append("--union (union=True in Python) merges loops that meet")
        elif known.name == "json":
            cures.append(
                "move the shapes apart in the file; of formats that take it --union merges what meets"
            )
    if SIMPLE in told:
        cures.append("no option mends a boundary that meets itself: part it in the file where it does")
    if cures and "layers" in names and options.get("layers") is None:
        cures.append("--layers reads a part")
    return "; ".join(cures)


def _place(start: Point | Sequence[object] | None) -> tuple[fmpq, fmpq] | None:
    if start is None:
        return None
    if isinstance(start, Point):
        if start.rational is None:
            raise FormatError(f"the start {start} is not rational: give two rational numbers")
        return start.rational
    return rational_pair(start)
