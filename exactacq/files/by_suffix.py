"""Scenes from files; the suffix of the file's name chooses the format, see `exactacq.files.formats`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.formats import format_of
from exactacq.files.loops.contents import Contents
from exactacq.files.source import one_line
from exactacq.geometry.points import Point
from exactacq.scene.bends import rational_pair
from exactacq.scene.scene import Scene


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
    with naming(path):
        return contents_of(path, start, options).scene()


def contents_of(
    path: str | Path, start: Point | Sequence[object] | None, options: Mapping[str, Any]
) -> Contents:
    """What a file holds before anything is decided; errors as those of `load`, which name no file here.

    A drawing has its file's name. Bytes in that that are no UTF-8 become question marks: results are UTF-8.
    """
    contents = format_of(Path(path)).read(Path(path), _place(start), options)
    name = None if contents.name is None else contents.name.encode("utf-8", "replace").decode()
    return contents if name == contents.name else replace(contents, name=name)


@contextmanager
def naming(path: str | Path) -> Iterator[None]:
    """Put a file's name before what a `FormatError` says of it."""
    try:
        yield
    except FormatError as error:
        raise type(error)(f"{one_line(path)}: {error}") from None


def contents_of_geo(
    document: Mapping[str, Any], start: Point | Sequence[object] | None, options: Mapping[str, Any]
) -> Contents:
    """The areas that GeoJSON tells, before anything is decided."""
    from exactacq.files.geojson import geo_contents

    values = format_of(Path("x.geojson")).checked(options)
    return geo_contents(document, None, _place(start), **values)


def _place(start: Point | Sequence[object] | None) -> tuple[fmpq, fmpq] | None:
    if start is None:
        return None
    if isinstance(start, Point):
        if start.rational is None:
            raise FormatError(f"the start {start} is not rational: give two rational numbers")
        return start.rational
    return rational_pair(start)
