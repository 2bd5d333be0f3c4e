"""What the documentation shows and does not store: pictures and verdicts, computed when it is built.

``docs/_generated`` receives the SVG files of `PICTURES`, the text of the page of claims with its pictures and
arguments, the tables of bounds, those of stored results, and the help of all commands with what their
examples print. ``-D claims_scenes=N`` tries the claims on N random scenes of each kind.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from shutil import copytree, rmtree
from typing import Any

import claims_page
import command_page
import tightest
import tightness_page
import trust_page

import exactacq as xa
from exactacq.files import gallery
from exactacq.output.figures import draw as figures
from exactacq.output.figures.vertex_scan_figure import limit_figure
from exactacq.scene.bounding import at_corner
from exactacq.study import claims
from exactacq.study.claims.model import Case, Subject
from exactacq.study.claims.tightness import YARDSTICKS

FOLDER = "_generated"
SCENES = 12
"""Random scenes of each kind: enough to show what a verdict rests on, and a matter of seconds."""


def _subject(name: str) -> Subject:
    """The strategy that a gallery scene is there for."""
    return Subject.SEED_SPREADER if gallery.is_swept(name) else Subject.SIGHTSEER


def _run(name: str) -> xa.Run:
    """The run on a gallery scene by that strategy."""
    return claims_page.run_on(claims_page.example(name), _subject(name))


def _cases() -> Iterator[tuple[str, Case, xa.Run]]:
    """All scenes of the gallery, each with that run."""
    return ((name, claims_page.example(name), _run(name)) for name in gallery.names())


def _whole(name: str) -> Callable[[Path], None]:
    """Draws a whole run."""
    return lambda path: figures.save(_run(name), path)


def _moment(path: Path) -> None:
    run = _run("plate")
    figures.save(run, path, at=run.near(1000))


def _compared(path: Path) -> None:
    scene = xa.load("figure2")
    framed = scene.replace(terrain=xa.terrain_around(scene, 1))
    runs = [
        xa.explore(framed, "sightseer"),
        xa.explore(at_corner(framed), "seed-spreader"),
        xa.explore(framed, "nearest-frontier"),
    ]
    figures.save_side_by_side(runs, path)


def _way(path: Path) -> None:
    found = xa.shortest_path(xa.load("figure2"), (23, 3), (8, 25))
    figures.save(found, path)


PICTURES: dict[str, Callable[[Path], None]] = {
    **{f"{name}.svg": _whole(name) for name in ("figure1", "figure2", "figure3", "figure4", "plate")},
    "plate_moment.svg": _moment,
    "shortest_path.svg": _way,
    "compared.svg": _compared,
    "polygon_limit.svg": lambda path: limit_figure().savefig(path),
}
"""The pictures that pages name, each with what draws it."""
TEXTS = ("verdicts.md", "tightest.md", "tightness.md", "trust.md", "comparison.md", "commands.md")
"""The texts that pages include."""


def generate(app: Any) -> None:
    """Write everything anew; called once when a build begins."""
    folder = Path(app.srcdir) / FOLDER
    rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for name, draw in PICTURES.items():
        draw(folder / name)
    arguments = Path(app.srcdir).parent / "proofs" / "arguments"
    claims_page.write(folder, claims.CLAIMS, int(app.config.claims_scenes), arguments)
    tightest.write(folder, _cases())
    scenes = ((name, _subject(name), claims_page.example(name)) for name in gallery.names())
    tightness_page.write(folder, YARDSTICKS, scenes)
    trust_page.write(folder, Path(app.srcdir) / "results")
    trust_page.write(folder, Path(app.srcdir) / "results" / "comparison", "comparison.md")
    command_page.write(folder)


def take_along(app: Any, failure: Exception | None) -> None:
    """Copy the pages that play runs beside the built ones; called once when a build ends."""
    if failure is None and app.builder.format == "html":
        made = Path(app.srcdir) / FOLDER / claims_page.PLAYED
        copytree(made, Path(app.outdir) / claims_page.PLAYED, dirs_exist_ok=True)


def setup(app: Any) -> dict[str, bool]:
    """Hook into Sphinx."""
    app.add_config_value("claims_scenes", SCENES, "env")
    app.connect("builder-inited", generate)
    app.connect("build-finished", take_along)
    return {"parallel_read_safe": True}
