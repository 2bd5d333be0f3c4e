"""Strategies compared on the gallery and on random scenes: makes the results in ``docs/results/comparison``.

``python tests/compare_strategies.py gallery`` and ``... random [--scenes N] [--first SEED]`` write their
tables there, for the version that is checked out. A scene without a terrain gets the rectangle about all its
obstacles, one unit wider, for the Seed Spreader. As with `exactacq compare`, that one starts in the SW
corner, the others at the scene's start, or else there too. A run that takes more than ``--seconds S`` of
processor time is given up. Takes some seven minutes of it for 1,000 scenes.
"""

from __future__ import annotations

import argparse
import json
import signal
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import median, quantiles
from types import FrameType
from typing import Any, NamedTuple

import exactacq as xa
from exactacq.files import gallery
from exactacq.scene.bounding import at_corner, terrain_around
from exactacq.strategies.options import Baseline, Strategy
from exactacq.strategies.standing import standing
from exactacq.study.random_scenes import Subject, random_scene

FOLDER = Path(__file__).parent.parent / "docs" / "results" / "comparison"
STRATEGIES = (*Strategy, *Baseline)
MARGIN = 1
"""How far the terrain of a scene without one goes beyond its obstacles."""


class Slow(BaseException):
    """A run has taken its time. No `Exception`, so that nobody goes on."""


class Outcome(NamedTuple):
    """What became of a run: an ``answer`` if it has ended, else ``why`` it has not."""

    scene: str
    strategy: str
    why: str = ""
    length: float = 0.0
    acquired: int = 0
    obstacles: int = 0
    unseen: int = 0
    unknown: float = 0.0
    boundary: float = 0.0
    circling: float | None = None
    seeing: float | None = None

    @property
    def is_whole(self) -> bool:
        """Whether it came to know all there is."""
        return not self.why and self.acquired == self.obstacles


def outcome(scene: xa.Scene, strategy: str, seconds: float) -> Outcome:
    """Run a strategy on a scene."""
    name = scene.name or ""
    corner = strategy == Strategy.SEED_SPREADER or scene.start is None
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        run = xa.explore(at_corner(scene) if corner else scene, strategy)
        beside = standing(run)
        ratios = [b.ratio if b.applies and b.value.sign() else None for b in (beside.circling, beside.seeing)]
        known = len(run.map.acquired), len(run.obstacles), len(run.unseen)
        lengths = float(beside.unknown), float(beside.boundary)
        return Outcome(name, strategy, "", float(run.length), *known, *lengths, *ratios)
    except xa.Undecided:
        return Outcome(name, strategy, "undecided")
    except Slow:
        return Outcome(name, strategy, "slow")
    except xa.InvalidScene:
        return Outcome(name, strategy, "refused")
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def with_terrain(scene: xa.Scene) -> xa.Scene:
    """The scene with a terrain; one in an enclosure stays as it is, for the Seed Spreader takes none."""
    has_one = scene.terrain is not None or scene.enclosure is not None
    around = scene.replace(start=None)
    return scene if has_one else scene.replace(terrain=terrain_around(around, MARGIN))


def gallery_result(seconds: float) -> dict[str, Any]:
    """Each scene of the gallery that at least two strategies take."""
    rows = []
    for name in gallery.names():
        found = [outcome(with_terrain(gallery.scene(name)), s, seconds) for s in STRATEGIES]
        if sum(not one.why for one in found) > 1:
            rows.append([f"`{name}`", *map(told, found)])
    return {
        "title": "The gallery",
        "asks": "Length of each run, and what it missed, on all scenes that two of the strategies take.",
        "commands": ["python tests/compare_strategies.py gallery"],
        "version": version(),
        "columns": ["scene", *STRATEGIES],
        "rows": rows,
        "notes": "Numbers in brackets: how many times the circling bound, if the run walks around all.",
    }


def told(one: Outcome) -> str:
    """A run in one cell."""
    if one.why:
        return one.why
    length = f"{one.length:.6g}" + (f" ({one.circling:.3f})" if one.circling is not None else "")
    if one.is_whole:
        return length
    words = [f"{one.unseen} never seen"] if one.unseen else []
    incomplete = one.obstacles - one.acquired - one.unseen
    words += [f"{incomplete} incomplete"] if incomplete else []
    return f"{length}; {', '.join(words)} of {one.obstacles}"


def random_results(scenes: int, first: int, seconds: float) -> Iterator[tuple[str, dict[str, Any]]]:
    """What each strategy does on random scenes, and how long it is beside the Sightseer."""
    command = f"python tests/compare_strategies.py random --scenes {scenes} --first {first}"
    common = {"commands": [command], "version": version()}
    found: dict[str, list[Outcome]] = {s: [] for s in STRATEGIES}
    for seed in range(first, first + scenes):
        scene = with_terrain(random_scene(Subject.SIGHTSEER, seed))
        for strategy in STRATEGIES:
            found[strategy].append(outcome(scene, strategy, seconds))
        if (seed - first) % 25 == 24:
            print(seed - first + 1, "scenes", flush=True)
    yield "2-random", {
        "title": "Random scenes",
        "asks": f"{scenes:,} small [degenerate scenes](campaigns.md#the-scenes) of the Sightseer's "
        "kind. What each strategy came to know, and how many times the lower bounds its path is long, "
        "where these speak of it and are not 0.",
        **common,
        "columns": [
            "strategy", "runs", "knows all", "obstacles never seen", "boundary not seen",
            "circling bound: median, most", "seeing bound: median, most", "refused", "undecided or slow",
        ],
        "rows": [summary(s, found[s]) for s in STRATEGIES],
        "notes": "The Seed Spreader refuses scenes in an enclosure.",
    }  # fmt: skip
    yield (
        "3-lengths",
        {
            "title": "Lengths beside the Sightseer's",
            "asks": "On scenes of which both came to know all: the length over the Sightseer's.",
            **common,
            "columns": [
                "strategy",
                "scenes",
                "shorter",
                "least",
                "quarter",
                "median",
                "three quarters",
                "most",
            ],
            "rows": [beside(s, found[s], found[Strategy.SIGHTSEER]) for s in STRATEGIES[1:]],
        },
    )


def summary(strategy: str, found: Sequence[Outcome]) -> list[str]:
    """A row of what a strategy came to know."""
    runs = [one for one in found if not one.why]
    unseen, obstacles = sum(one.unseen for one in runs), sum(one.obstacles for one in runs)
    unknown, boundary = sum(one.unknown for one in runs), sum(one.boundary for one in runs)
    ratios = [
        [ratio for one in runs if (ratio := getattr(one, kind)) is not None]
        for kind in ("circling", "seeing")
    ]
    failed = sum(one.why in ("undecided", "slow") for one in found)
    return [
        strategy,
        f"{len(runs)}",
        f"{sum(one.is_whole for one in runs)}",
        f"{unseen} of {obstacles}",
        f"{unknown / boundary:.2%}",
        *(f"{median(r):.3f}, {max(r):.3f} ({len(r)} runs)" if r else "-" for r in ratios),
        f"{sum(one.why == 'refused' for one in found)}",
        f"{failed}",
    ]


def beside(strategy: str, found: Sequence[Outcome], first: Sequence[Outcome]) -> list[str]:
    """A row of how long a strategy's paths are beside another one's."""
    pairs = [(a, b) for a, b in zip(found, first, strict=True) if a.is_whole and b.is_whole and b.length]
    ratios = sorted(a.length / b.length for a, b in pairs)
    marks = [ratios[0], *quantiles(ratios, n=4, method="inclusive"), ratios[-1]]
    return [strategy, f"{len(ratios)}", f"{sum(r < 1 for r in ratios)}", *(f"{mark:.3f}" for mark in marks)]


def version() -> str:
    """The commit that is checked out."""
    command = ["git", "rev-parse", "--short=7", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def write(name: str, result: dict[str, Any]) -> None:
    """Store a result."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    text = json.dumps(result, indent=1, ensure_ascii=False) + "\n"
    (FOLDER / f"{name}.json").write_text(text, encoding="utf-8")


def give_up(number: int, frame: FrameType | None) -> None:
    raise Slow


def main() -> None:
    """Make one of the results."""
    parser = argparse.ArgumentParser(description="Compare strategies, and store what comes out.")
    parser.add_argument("what", choices=("gallery", "random"))
    parser.add_argument("--scenes", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seconds", type=float, default=20.0)
    given = parser.parse_args()
    signal.signal(signal.SIGPROF, give_up)
    if given.what == "gallery":
        write("1-gallery", gallery_result(given.seconds))
        return
    for name, result in random_results(given.scenes, given.first, given.seconds):
        write(name, result)


if __name__ == "__main__":
    main()
