"""The command ``exactacq gallery``; what it needs is imported when it runs."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from exactacq.cli.arguments import AsJson, FigureFile, LabelChoice
from exactacq.cli.completion import gallery_scenes
from exactacq.cli.own_strategies import NamedStrategy
from exactacq.cli.runs import explored, watched
from exactacq.errors import FormatError
from exactacq.output.vocabulary import Labels
from exactacq.strategies.options import Strategy


def gallery(
    name: Annotated[
        str | None,
        typer.Argument(metavar="[NAME]", help="A scene to describe or draw.", autocompletion=gallery_scenes),
    ] = None,
    figure: FigureFile = None,
    labels: LabelChoice = Labels.ALL,
    out: Annotated[
        str | None, typer.Option(metavar="DIR", help="Explore every scene, and write DIR/NAME.svg.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """List the gallery; draw one scene of it (--figure), or the runs on all of them (--out).

    The Seed Spreader runs on the scenes that are there for it.
    """
    from exactacq.files import gallery as scenes
    from exactacq.output.report import console, scene_list, scene_report
    from exactacq.output.report_data import gallery_data, scene_data, text_of

    if as_json and (figure is not None or out is not None):
        raise FormatError("--json: prints what a scene holds; leave the pictures out")
    if name is None and figure is not None:
        raise FormatError(
            "--figure: name the scene to be drawn, as in: exactacq gallery figure2 --figure F.svg"
        )
    if out is not None:
        if name is not None:
            raise FormatError("--out: draws every scene; leave the name out")
        _draw_gallery(Path(out), labels)
    elif as_json:
        data = gallery_data(scenes.names()) if name is None else scene_data(scenes.scene(name))
        sys.stdout.write(text_of(data))
    elif name is None:
        console().print(scene_list(scenes.names()))
    elif figure is None:
        console().print(scene_report(scenes.scene(name)))
    else:
        from exactacq.output.figures import save

        save(scenes.scene(name), figure, labels=labels)
        print(f"figure written to {figure}")


def _draw_gallery(folder: Path, labels: Labels) -> None:
    from exactacq.files import gallery as scenes
    from exactacq.files.whole_files import FIGURES, check_output
    from exactacq.output.figures import save

    if folder.exists() and not folder.is_dir():
        raise FormatError(f"--out: {folder} is a file; a folder for all pictures is needed")
    folder.mkdir(exist_ok=True)
    for name in scenes.names():
        path = folder / f"{name}.svg"
        world = scenes.scene(name)
        strategy = Strategy.SEED_SPREADER if scenes.is_swept(name) else Strategy.SIGHTSEER
        run, target = (
            explored(world, None, NamedStrategy(strategy, strategy.value)),
            check_output(path, FIGURES),
        )
        with watched("drawing") as progress:
            save(run, target, labels=labels, progress=progress)
        print(f"figure written to {path}")
