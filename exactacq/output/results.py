"""Writing scenes and results to files of any format that is written."""

from __future__ import annotations

import os
from collections.abc import Collection
from pathlib import Path

from flint import fmpq

from exactacq.errors import ExactacqError, FormatError
from exactacq.files.formats import Format, format_of, written_suffixes
from exactacq.files.loops.chains import scientific_above
from exactacq.files.source import one_line
from exactacq.files.whole_files import check_output, write_whole
from exactacq.output.sheets import sheet_of
from exactacq.scene.scene import Scene


def write(
    subject: object,
    path: str | os.PathLike[str],
    *,
    at: object = None,
    only: str | Collection[str] | None = None,
) -> tuple[str, ...]:
    """Write a scene or a result to a file; the suffix of its name chooses the format. Returns remarks.

    *subject* is a `Scene`, a `Run`, the `Path`, the links or a `Map` of a run, an `Isovist`, or a
    `ShortestPath`. With *at*, an event or a length of the path, a run is written as it was then. *only*
    selects kinds of things, such as "path"; in a file they are layers (DXF), groups (SVG), a property
    (GeoJSON) or a column (CSV).

    Numbers that are finite decimals stay as they are (as doubles in DXF: up to 15 digits); others are
    rounded, and arcs become chords in GeoJSON. The remarks say by how much any point has moved at most, which
    is proven, and what the format does not hold. A scene whose numbers were rounded is read again: where
    loops nearly touched, or the start touched one, they may cross then, and a remark says so. JSON holds a
    whole scene or run without any rounding. Files are written whole or not at all.

    Raises `FormatError` for another suffix, kind of things or subject, ValueError for a moment that the run
    does not have, and `OSError`. Linear in the curves that are written; near linear if they are read again.

    >>> import exactacq as xa, tempfile
    >>> run, folder = xa.sightseer(xa.load("squares")), tempfile.TemporaryDirectory()
    >>> xa.write(run, folder.name + "/run.wkt", only=["path", "start"])
    ('every number is exact', 'a .wkt file holds no layers, names and properties')
    >>> xa.write(xa.isovist(run.scene, (0, 0)), folder.name + "/view.dxf")
    ('no point lies more than 2.5e-15 from its exact place',)
    >>> folder.cleanup()
    """
    target = check_output(path, written_suffixes())
    sheet = sheet_of(subject, at)
    if only is not None:
        sheet = sheet.only([only] if isinstance(only, str) else only)
    known = format_of(target)
    try:
        content = known.written(sheet)
    except FormatError as error:
        raise FormatError(f"{target}: {error}") from None
    write_whole(target, content.data)
    told = ["every number is exact"]
    if content.moved:
        told = [f"no point lies more than {scientific_above(content.moved)} from its exact place"]
        told += _read_again(subject, target, known) if isinstance(subject, Scene) and only is None else []
    return *told, *(f"a {target.suffix.lower()} file holds {note}" for note in content.notes)


def _read_again(scene: Scene, target: Path, known: Format) -> list[str]:
    """What rounding did to a scene, if the file that was written is refused or has other loops."""
    start = None if scene.start is None else scene.start.rational
    if known.reader is None or start is None:
        return []
    exact = {"tolerance": fmpq(0)} if any(option.name == "tolerance" for option in known.options) else {}
    whole, cure = len(scene.obstacles), "a .json file holds it exactly"
    try:
        again = known.read(target, start, exact).scene(advise=False)
    except ExactacqError as error:
        return [f"rounded so, it is refused from the same start ({one_line(error)}); {cure}"]
    found = len(again.obstacles)
    if found == whole and (again.enclosure is None) == (scene.enclosure is None):
        return []
    return [f"rounded so, {found} of its {whole} loops are read again from the same start; {cure}"]
