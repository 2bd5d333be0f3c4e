"""Writing scenes and results to files of any format that is written."""

from __future__ import annotations

import os
from collections.abc import Collection

from exactacq.errors import FormatError
from exactacq.files.formats import format_of, written_suffixes
from exactacq.files.loops.chains import scientific_above
from exactacq.files.whole_files import check_output, write_whole
from exactacq.output.sheets import sheet_of


def write(
    subject: object,
    path: str | os.PathLike[str],
    *,
    at: object = None,
    only: str | Collection[str] | None = None,
) -> tuple[str, ...]:
    """Write a scene or a result to a file; the suffix of its name chooses the format. Returns remarks.

    *subject* is a `Scene`, a `Run`, the `Path`, the links or a `Map` of a run, or an `Isovist`. With *at*, an
    event or a length of the path, a run is written as it was then. *only* selects kinds of things, such as
    "path"; in a file they are layers (DXF), groups (SVG), a property (GeoJSON) or a column (CSV).

    Numbers that are finite decimals stay as they are (as doubles in DXF: up to 15 digits); others are
    rounded, and arcs become chords in GeoJSON. The remarks say by how much any point has moved at most, which
    is proven, and what the format does not hold. JSON holds a whole scene or run without any rounding. Files
    are written whole or not at all.

    Raises `FormatError` for another suffix, kind of things or subject, ValueError for a moment that the run
    does not have, and `OSError`. Linear in the curves that are written.

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
    try:
        content = format_of(target).written(sheet)
    except FormatError as error:
        raise FormatError(f"{target}: {error}") from None
    write_whole(target, content.data)
    moved = "every number is exact"
    if content.moved:
        moved = f"no point lies more than {scientific_above(content.moved)} from its exact place"
    return moved, *(f"a {target.suffix.lower()} file holds {note}" for note in content.notes)
