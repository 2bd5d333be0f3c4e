"""The Seed Spreader against a stepping simulator in floats that shares no code with it."""

from __future__ import annotations

from fractions import Fraction as Q
from math import cos, pi, sin
from random import Random

import pytest
from nightly import NIGHTLY
from stepping_spreader import Spread, spread_scene

import exactacq as xa
from exactacq import Polygon, Scene, Terrain
from exactacq.sensing.event import Ending
from exactacq.strategies.run import Run


def generic_scene(rng: Random) -> Scene:
    """A few convex and dented polygons in general position, some of them over the border."""
    width, height = rng.choice([(12, 8), (9, 14), (16, 6)])
    shapes: list[Polygon] = []
    disks: list[tuple[float, float, float]] = []
    for _ in range(40):
        size = rng.uniform(0.3, 1.4)
        x, y = rng.uniform(0, width), rng.uniform(0, height)
        if x + y < 2 * size + 0.3 or any(
            (x - a) ** 2 + (y - b) ** 2 < (size + r + 0.2) ** 2 for a, b, r in disks
        ):
            continue
        disks.append((x, y, size))
        count = rng.randint(3, 7)
        turns = sorted((k + rng.uniform(0.1, 0.9)) * 2 * pi / count for k in range(count))
        radii = [size * (rng.uniform(0.4, 1) if rng.random() < 0.4 else 1) for _ in turns]
        corners = [(x + r * cos(t), y + r * sin(t)) for r, t in zip(radii, turns, strict=True)]
        shapes.append(Polygon([(Q(round(u * 1000), 1000), Q(round(v * 1000), 1000)) for u, v in corners]))
        if len(shapes) == rng.choice([3, 5, 8]):
            break
    return Scene(shapes, terrain=Terrain(width, height), radius=Q(rng.randint(18, 60), 10))


def outcome(spread: Spread) -> tuple[object, ...]:
    """What a step must not change."""
    acquired = [k for k, _ in spread.acquisitions]
    return acquired, spread.visits, [d.obstacle for d in spread.diversions], spread.trapped


def exact_outcome(run: Run) -> tuple[object, ...]:
    acquired = [e.obstacle for e in run.events if e.kind == "acquire"]
    trapped = run.events[-1].obstacle if run.ending is Ending.TRAPPED else None
    return acquired, list(run.visits), [d.obstacle for d in run.diversions], trapped


def agrees(scene: Scene, options: dict[str, object]) -> bool:
    """Whether the simulator decides one way with two steps; then the library must decide so too."""
    radius = float(Q(str(scene.radius)))
    coarse, fine = (spread_scene(scene, radius, step=radius / n, **options) for n in (120, 190))
    if outcome(coarse) != outcome(fine):
        return False
    run = xa.seed_spreader(scene, **options)
    assert exact_outcome(run) == outcome(fine)
    slack = 12 * radius / 120 * (1 + len(run.diversions))
    assert float(run.length) == pytest.approx(fine.length, abs=slack)
    return True


EVERY_DAY = (1, 3, 8)
"""With and without a look ahead, to known and to visible targets; 2 and 9 take long."""


@pytest.mark.parametrize("seed", range(16) if NIGHTLY else EVERY_DAY)
def test_random_generic_scenes(seed: int) -> None:
    scene = generic_scene(Random(seed))
    options: dict[str, object] = {
        "lookahead": seed % 3 != 0,
        "target": "visible" if seed % 4 == 1 else "known",
    }
    if not agrees(scene, options):
        pytest.skip("the simulator's own steps disagree")
