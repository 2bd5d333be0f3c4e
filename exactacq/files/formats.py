"""The registry of file formats: what each is called, what reads and writes it, and which options it takes.

Readers and writers are named, not imported: the command line lists all options without loading any of them.
A format is one file or folder beside this one, perhaps one in `writing`, and one `register` below.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from exactacq.errors import FormatError, shown

if TYPE_CHECKING:
    from exactacq.files.loops.contents import Contents
    from exactacq.files.writing.sheet import Sheet, Written


@dataclass(frozen=True, slots=True)
class FileOption:
    """An option of a format: of `exactacq.load` by its name, of the command line by ``--name``.

    Its *kind* is "number", "names" (a text or several), "flag" (off by default) or "choice" (of *choices*).
    """

    name: str
    kind: Literal["number", "names", "flag", "choice"]
    help: str
    default: object = None
    choices: tuple[str, ...] = ()
    why: str = ""
    """Why other formats do not take it, where that may be asked."""

    def of_text(self, text: str) -> object:
        """The value that a text on the command line stands for; names are parted by commas."""
        return [name.strip() for name in text.split(",")] if self.kind == "names" else text

    def checked(self, value: object) -> object:
        """The value as the reader takes it; `FormatError` for one of another kind."""
        if self.kind == "number":
            return value if value is None else _number(self.name, value)
        if self.kind == "names":
            return [value] if isinstance(value, str) else value if value is None else _names(self, value)
        if value == self.default:
            return value
        known: tuple[object, ...] = (False, True) if self.kind == "flag" else self.choices
        if value not in known:
            wanted = " or ".join(f'"{k}"' if isinstance(k, str) else str(k) for k in known)
            raise FormatError(f"{self.name} is {wanted}, not {shown(value)}")
        return value


@dataclass(frozen=True, slots=True, kw_only=True)
class Format:
    """A file format: its name, what its files are, their suffixes, what reads and writes them, its options.

    *reader* and *writer* are "module:function", or None. A reader takes the path, the start (two rationals,
    or None) and the options by name, and returns what the file holds: see `exactacq.files.loops.contents`. A
    writer takes a sheet (see `exactacq.files.writing.sheet`) and returns the content of the file.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    reader: str | None = None
    writer: str | None = None
    options: tuple[FileOption, ...] = ()

    def read(self, path: Path, start: object, values: Mapping[str, object]) -> Contents:
        """What a file holds; `FormatError` for wrong options before anything is read."""
        checked = self.checked(values)
        if self.reader is None:
            raise FormatError(f"{self.title} are written, but not read")
        contents: Contents = _named(self.reader)(path, start, **checked)
        return contents

    def written(self, sheet: Sheet) -> Written:
        """A sheet as the content of a file of this format, which has a writer."""
        assert self.writer is not None, "only formats that are written are asked to"
        content: Written = _named(self.writer)(sheet)
        return content

    def checked(self, values: Mapping[str, object]) -> dict[str, Any]:
        """The options as the reader takes them; `FormatError` for those of other formats or kinds."""
        own = {option.name: option for option in self.options}
        for name, value in values.items():
            if name not in own:
                _check_unused(name, value, self)
        return {name: own[name].checked(value) for name, value in values.items() if name in own}


def _named(name: str) -> Callable[..., Any]:
    """The function of "module:function"."""
    module, function = name.split(":")
    found: Callable[..., Any] = getattr(import_module(module), function)
    return found


_FORMATS: dict[str, Format] = {}


def register(new: Format) -> None:
    """Add a format; ValueError if its name or a suffix is taken."""
    taken = {suffix for other in _FORMATS.values() for suffix in other.suffixes}
    if new.name in _FORMATS or taken.intersection(new.suffixes):
        raise ValueError(f"there is a format of the name {new.name!r}, or of one of its suffixes")
    _FORMATS[new.name] = new


def formats() -> tuple[Format, ...]:
    """The file formats that `exactacq.load` reads, `exactacq.write` writes, or both.

    >>> for known in formats()[:2]:
    ...     print(known.name, *known.suffixes, *(option.name for option in known.options))
    json .json
    wkt .wkt .ewkt union
    """
    return tuple(_FORMATS.values())


def options() -> dict[str, FileOption]:
    """All options by their names; an option that several formats have is one."""
    return {option.name: option for known in formats() for option in known.options}


def written_suffixes() -> tuple[str, ...]:
    """The suffixes of the formats that are written."""
    return tuple(suffix for known in formats() if known.writer is not None for suffix in known.suffixes)


def format_of(path: Path) -> Format:
    """The format of a file by its suffix, in any case; `FormatError` if there is none."""
    suffix = path.suffix.lower()
    for known in formats():
        if suffix in known.suffixes:
            return known
    kind = f"unknown file type {shown(suffix)}" if suffix else "a file name without a type"
    read = " ".join(suffix for known in formats() if known.reader for suffix in known.suffixes)
    raise FormatError(f"{kind}; files that are read end in {read}")


def _check_unused(name: str, value: object, used: Format) -> None:
    """`FormatError` for an option that a format has not, unless its value asks for nothing."""
    owners = [known.title for known in formats() if any(option.name == name for option in known.options)]
    if not owners:
        raise FormatError(f"no option {shown(name)}; there are {', '.join(options())}")
    if value != options()[name].default:
        *others, last = owners
        whom = f"{', '.join(others)} and {last}" if others else last
        why = f" ({options()[name].why})" if options()[name].why else ""
        raise FormatError(f"{name} is for {whom}, not for {used.title}; leave it out{why}")


def _number(name: str, value: object) -> object:
    from exactacq.numbers.rationals import rational

    try:
        return rational(value)
    except FormatError as error:
        raise FormatError(f"{name}: {error}; give a number like 10, 0.1 or 21/2") from None


def _names(option: FileOption, value: object) -> list[str]:
    names = list(value) if hasattr(value, "__iter__") else []
    if not names or not all(isinstance(name, str) for name in names):
        raise FormatError(f"{option.name}: a text or a list of texts is needed, not {shown(value)}")
    return names


LAYERS = FileOption(
    "layers", "names", "Layers to read, as A,B; * stands for any text, ? for a character; default: all."
)
OUTER = FileOption(
    "outer",
    "choice",
    "The outermost loop around the start: the wall, or dropped. With room the innermost one is the wall.",
    "wall",
    ("wall", "drop", "room"),
)
TOLERANCE = FileOption("tolerance", "number", "Join ends that are this far apart.")
FLATTEN = FileOption(
    "flatten", "number", "Ellipses, splines and Bézier curves by arcs, within this distance."
)
UNION = FileOption("union", "flag", "Merge loops that overlap.", False)
CORNERS = FileOption(
    "corners",
    "choice",
    "Blocked cells that touch in a corner: joined, or parted.",
    "join",
    ("join", "part"),
)
BORDER = FileOption(
    "border", "choice", "Beyond the grid all is free, or all is blocked.", None, ("open", "wall")
)
UNKNOWN = FileOption("unknown", "choice", "What unknown cells are.", "free", ("free", "blocked"))
THRESHOLD = FileOption("threshold", "number", "Blocked is what is darker: 0 for black to 1 for white; 1/2.")
RESOLUTION = FileOption("resolution", "number", "Width of a cell; 1.")
SIMPLIFY = FileOption(
    "simplify",
    "number",
    "Fewer vertices of outlines, which move by at most this distance.",
    why="it smooths the steps that cells make; vertices of other files are taken as they were meant",
)
THICKEN = FileOption("thicken", "number", "Walls so thick for lines that stay open.")
DRAWING = (LAYERS, OUTER, TOLERANCE, UNION, THICKEN)
"""What drawings of loose lines and arcs take."""
CURVED = (*DRAWING, FLATTEN)
"""What drawings take that may hold other curves."""

register(
    Format(
        name="json",
        title="JSON scenes",
        suffixes=(".json",),
        reader="exactacq.files.json_dialects:load_json",
        writer="exactacq.files.scene_json:written",
    )
)
register(
    Format(
        name="wkt",
        title="well-known text",
        suffixes=(".wkt", ".ewkt"),
        reader="exactacq.files.wkt:load_wkt",
        writer="exactacq.files.writing.wkt:written",
        options=(UNION,),
    )
)
register(
    Format(
        name="geojson",
        title="GeoJSON",
        suffixes=(".geojson",),
        reader="exactacq.files.geojson:load_geojson",
        writer="exactacq.files.writing.geojson:written",
        options=(UNION,),
    )
)
register(
    Format(
        name="ros",
        title="maps of ROS",
        suffixes=(".yaml", ".yml"),
        reader="exactacq.files.grids.ros_map:load_ros_map",
        options=(CORNERS, BORDER, UNKNOWN, SIMPLIFY),
    )
)
register(
    Format(
        name="image",
        title="images",
        suffixes=(".pgm", ".png", ".bmp", ".gif", ".jpg", ".jpeg"),
        reader="exactacq.files.grids.image:load_image",
        options=(THRESHOLD, RESOLUTION, CORNERS, BORDER, SIMPLIFY),
    )
)
register(
    Format(
        name="movingai",
        title="MovingAI maps",
        suffixes=(".map",),
        reader="exactacq.files.grids.movingai:load_movingai",
        options=(CORNERS, BORDER, SIMPLIFY),
    )
)
register(
    Format(
        name="visilibity",
        title="VisiLibity environments",
        suffixes=(".environment",),
        reader="exactacq.files.visilibity:load_visilibity",
    )
)
register(
    Format(
        name="dxf",
        title="DXF drawings",
        suffixes=(".dxf",),
        reader="exactacq.files.dxf.load:load_dxf",
        writer="exactacq.files.writing.dxf:written",
        options=CURVED,
    )
)
register(
    Format(
        name="kicad",
        title="boards of KiCad",
        suffixes=(".kicad_pcb",),
        reader="exactacq.files.kicad:load_kicad",
        options=DRAWING,
    )
)
register(
    Format(
        name="svg",
        title="SVG drawings",
        suffixes=(".svg",),
        reader="exactacq.files.svg.load:load_svg",
        writer="exactacq.files.writing.svg:written",
        options=CURVED,
    )
)
register(
    Format(
        name="csv",
        title="CSV tables",
        suffixes=(".csv",),
        writer="exactacq.files.writing.csv:written",
    )
)
