"""The arguments and options that several commands share, and what their texts mean."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from exactacq.cli.completion import scenes
from exactacq.cli.options import read_from_text
from exactacq.errors import FormatError, InvalidScene
from exactacq.files.formats import written_suffixes
from exactacq.output.vocabulary import Labels

if TYPE_CHECKING:
    from flint import fmpq

    from exactacq.scene.scene import Scene
    from exactacq.scene.shapes import Terrain

Result = TypeVar("Result")
DRAWINGS = tuple(suffix for suffix in written_suffixes() if suffix != ".json")
"""What a view is written as."""
SceneName = Annotated[
    str,
    typer.Argument(metavar="SCENE", help="A file, or the name of a gallery scene.", autocompletion=scenes),
]
Start = Annotated[
    str | None,
    typer.Option(
        metavar="X,Y",
        help="Start point; a drawing has none, and a run needs one. A sweep of it starts in the SW corner.",
    ),
]
TerrainSize = Annotated[
    str | None,
    typer.Option(
        metavar="B,A",
        help="Terrain: B,A or X,Y,B,A (SW corner, width, height) or bbox[:MARGIN]; default: the scene's.",
    ),
]
Radius = Annotated[str | None, typer.Option(metavar="R", help="Radius of vision; default: the scene's own.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON, and no table.")]
LabelChoice = Annotated[
    Labels,
    typer.Option("--labels", help="Labels in pictures: obstacles' names, numbers of visits, all, or none."),
]
MaxMoves = Annotated[
    int,
    typer.Option("--max-moves", metavar="N", min=1, help="Your own strategy: most moves, then the run ends."),
]
FigureFile = Annotated[str | None, typer.Option(metavar="F", help="Write a figure: .svg, .pdf or .png.")]


def scene_of(name: str, start: str | None, options: dict[str, Any], terrain: str | None = None) -> Scene:
    """The scene in the file, or else of the gallery, of that name; an error names it too."""
    try:
        scene = _loaded(name, start, read_from_text(options))
        return scene if terrain is None else scene.replace(terrain=_terrain(terrain, scene))
    except InvalidScene as error:
        first, *others = error.violations
        raise InvalidScene([f"{name}: {first}", *others], error.cure) from None


def _loaded(name: str, start: str | None, options: dict[str, object]) -> Scene:
    from exactacq.files.gallery import names
    from exactacq.files.load import load

    place = None if start is None else place_of("--start", start)
    if place is None:
        return load(name, **options)
    if name not in names() or os.path.lexists(name):
        return load(name, start=place, **options)
    return load(name, **options).replace(start=place)


def check_radius(name: str, scene: Scene, range_: fmpq | None) -> None:
    """`FormatError` if neither an option nor the scene of that name tells how far the robot sees."""
    if range_ is None and scene.radius is None:
        raise FormatError(f"{name}: the scene has no radius of vision: give one with --radius R")


def check_start(scene: Scene, sweeps: bool) -> None:
    """`InvalidScene` with the option that helps if a strategy, one that *sweeps* or not, cannot start."""
    from exactacq.scene.bounding import rectangular_room

    if sweeps and rectangular_room(scene) is None:
        if scene.enclosure is not None:
            cure = "leave out the enclosure (of a drawing: --outer drop), and give --terrain"
            raise InvalidScene([f"a sweep takes a rectangle, no enclosure of another form: {cure}"])
        if scene.terrain is not None:
            return
        raise InvalidScene(["a terrain is needed: give one with --terrain, such as --terrain bbox:1"])
    if not sweeps and scene.start is None:
        raise InvalidScene(["a start is needed: give one with --start X,Y"])


def check_free(scene: Scene, option: str, place: tuple[fmpq, fmpq]) -> None:
    """`InvalidScene` with the option's name for a place that is too far out, or inside an obstacle."""
    from exactacq.geometry.points import Location, Point
    from exactacq.scene.validation import place_flaws, place_text
    from exactacq.visibility.scene_tables import SceneTables

    point = Point(*place)
    if far := list(place_flaws(option, point)):
        raise InvalidScene(far)
    for where, obstacle in SceneTables.of(scene).around(point):
        if where is Location.INSIDE:
            kind = "beyond the enclosure" if obstacle.is_enclosure else "inside obstacle"
            raise InvalidScene([f"{option}: {place_text(point)} lies {kind} {obstacle.label}"])


def needs_start(name: str) -> bool:
    """Whether a scene is in a file that tells no start, so that the place to look from takes its part."""
    from exactacq.files.gallery import names

    is_file = name not in names() or os.path.lexists(name)
    return is_file and Path(name).suffix.lower() != ".json"


def _terrain(text: str, scene: Scene) -> Terrain:
    """The terrain of an option: its sides, with its SW corner or without, or the rectangle about a scene."""
    from exactacq.scene.bounding import terrain_around
    from exactacq.scene.shapes import Terrain

    word, _, margin = text.partition(":")
    if word == "bbox":
        return terrain_around(scene, number_of("--terrain bbox", margin or "0"))
    parts = text.split(",")
    if len(parts) not in (2, 4):
        forms = "B,A or X,Y,B,A without spaces, or bbox:MARGIN"
        raise FormatError(f"--terrain: not two or four numbers: {text!r}; give {forms}")
    *corner, width, height = (number_of("--terrain", part) for part in parts)
    return Terrain(width, height, corner or (0, 0))


def range_of(radius: str | None) -> fmpq | None:
    """The radius of an option, if it is given."""
    range_ = None if radius is None else number_of("--radius", radius)
    if range_ is not None and range_ <= 0:
        raise FormatError(f"--radius: must be positive, not {radius}")
    return range_


def number_of(option: str, text: str) -> fmpq:
    from exactacq.numbers.rationals import rational

    try:
        return rational(text)
    except FormatError as error:
        raise FormatError(f"{option}: {error}; give a number like 10, 0.1 or 21/2") from None


def place_of(option: str, text: str) -> tuple[fmpq, fmpq]:
    parts = text.split(",")
    if len(parts) != 2:
        raise FormatError(f"{option}: not two numbers: {text!r}; give X,Y without spaces, like 0,21/2")
    return number_of(option, parts[0]), number_of(option, parts[1])


def naming(option: str, act: Callable[[], Result]) -> Result:
    """What an action returns; a value that makes no sense is an error that names the option."""
    try:
        return act()
    except FormatError:
        raise
    except ValueError as error:
        raise FormatError(f"{option}: {error}") from None


def check_outputs(scene: str, *wanted: tuple[str | None, Collection[str]]) -> None:
    """That each file that is wanted, with its suffixes, can be written, and writes over no other of these.

    Raises `FormatError`; writes nothing.
    """
    from exactacq.files.whole_files import check_output

    paths = [check_output(file, suffixes) for file, suffixes in wanted if file is not None]
    if any(_is_same(path, scene) for path in paths):
        raise FormatError(f"{scene}: would be overwritten by the output; choose another name")
    real = [os.path.realpath(path) for path in paths]
    for k, path in enumerate(real):
        if path in real[:k]:
            raise FormatError(f"{paths[k]}: is named for two outputs; choose another name for one of them")


def _is_same(path: Path, scene: str) -> bool:
    try:
        return path.samefile(scene)
    except (OSError, ValueError):
        return False
