"""The switch by which floats decide nothing: runs are the same, whatever the floats say then."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import stress_floats
from nightly import NIGHTLY, some
from stress_floats import told

import exactacq as xa
from exactacq import kernel
from exactacq.files.octagons import random_octagons
from exactacq.kernel.images import EdgeImage
from exactacq.scene.edge_table import EdgeTable
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import random_scene


def sightseer(name: str) -> Callable[[], xa.Run]:
    return lambda: xa.sightseer(xa.load(name))


def spreader(name: str, **options: object) -> Callable[[], xa.Run]:
    return lambda: xa.seed_spreader(xa.load(name), **options)


RUNS: dict[str, Callable[[], xa.Run]] = {
    **{f"sightseer {name}": sightseer(name) for name in some(("m11", "circles", "figure1", "m8"), 1)},
    "octagons": lambda: xa.sightseer(random_octagons(5, 1), 5),
    **{
        f"random sightseer {seed}": (lambda s=seed: xa.sightseer(random_scene(Subject.SIGHTSEER, s)))
        for seed in some(range(10), 2)
    },
    **({"spreader figure4": spreader("figure4")} if NIGHTLY else {"spreader case2": spreader("case2")}),
    "a look ahead that is cut to what is in reach": lambda: xa.seed_spreader(
        random_scene(Subject.SEED_SPREADER, 96000022)
    ),
    "spreader m25, what is visible": spreader("m25", target="visible"),
    "spreader m25, without looking ahead": spreader("m25", lookahead=False),
    **{
        f"random spreader {seed}": (lambda s=seed: xa.seed_spreader(random_scene(Subject.SEED_SPREADER, s)))
        for seed in some(range(10), 2)
    },
}


def spoil(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tables of edges get wrong coordinates in floats: only what they are made of and boxes stay right."""
    init, images = EdgeTable.__init__, EdgeTable.images.func

    def wrong(self: EdgeTable, obstacles: object) -> None:
        init(self, obstacles)  # type: ignore[arg-type]
        for name in ("start", "end", "center"):
            places = getattr(self, name)
            setattr(self, name, np.roll(places, 1, axis=0)[:, ::-1] * 0.75 - 1)
        self.radius = self.radius * 3 + 1

    def wrong_images(self: EdgeTable) -> list[EdgeImage]:
        found = []
        for k, right in enumerate(images(self)):
            x, y = float((7 * k + 1) % 11), float((7 * k + 5) % 11)
            start, center = (x, 0.0, y, 0.0), (y, 0.0, x, 0.0)
            found.append(
                EdgeImage(start, center, 2.0, right.kind, right.full, right.following, right.previous)
            )
        return found

    monkeypatch.setattr(EdgeTable, "__init__", wrong)
    monkeypatch.setattr(EdgeTable, "images", property(wrong_images))


@pytest.mark.parametrize("name", RUNS)
def test_floats_decide_nothing(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the switch a run is the same, even if the floats of the scene's edges are wrong."""
    usual = told(RUNS[name]())
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    assert told(RUNS[name]()) == usual
    spoil(monkeypatch)
    assert told(RUNS[name]()) == usual


@pytest.mark.parametrize("exact", [False, True], ids=["floats", "exact"])
def test_a_known_corner_is_told_once(exact: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Exact views end in the corner twice, on both of its edges: the point was told beside what it ends."""
    monkeypatch.setattr(kernel, "EXACT_ONLY", exact)
    run = xa.sightseer(random_scene(Subject.SIGHTSEER, 90000036))
    for event in run.events:
        known = run.map_at(event)
        for i in known.seen:
            parts = known.known(i)
            alone = {part.start for part in parts if part.curve is None}
            assert len(alone) == sum(part.curve is None for part in parts)
            assert not alone & {end for part in parts if part.curve for end in (part.start, part.end)}


def test_scenes_that_differ_are_counted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """`stress_floats` finds none among honest runs, and a run that the switch has changed."""
    monkeypatch.setattr(kernel, "EXACT_ONLY", False)  # It is set back when the test ends.
    assert stress_floats.main(["sightseer", "1", "1"]) == 0
    wrong = xa.sightseer(random_scene(Subject.SIGHTSEER, 2))
    honest = stress_floats.run
    monkeypatch.setattr(stress_floats, "run", lambda *of: wrong if kernel.EXACT_ONLY else honest(*of))
    assert stress_floats.main(["sightseer", "1", "2"]) == 1
    assert "sightseer:1\nsightseer: 2 scenes, 1 differ, 0 end in an error" in capsys.readouterr().out
