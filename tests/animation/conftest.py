"""Runs whose pages are tested."""

from __future__ import annotations

import pytest
from gallery_runs import gallery_run
from pages import HOSTILE

from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Outline, Polygon
from exactacq.strategies.run import Run
from exactacq.strategies.sightseer.strategy import sightseer


@pytest.fixture(scope="module")
def circles() -> Run:
    return gallery_run("circles")


@pytest.fixture(scope="module")
def eleven() -> Run:
    return gallery_run("m11")


@pytest.fixture(scope="module")
def room() -> Run:
    """Two obstacles with hostile names in a room with a round corner."""
    shapes = [Polygon([(2, 2), (4, 2), (4, 5)], name=HOSTILE[0]), Circle((8, 4), 1, name=HOSTILE[1])]
    walls = Outline([(0, 0), (10, 0), (10, 6, "1/3"), (8, 8), (0, 8)], name="\u2028 \u202ewall")
    return sightseer(Scene(shapes, (1, 1), enclosure=walls, radius=12, name=HOSTILE[0]))


@pytest.fixture(scope="module")
def swept() -> Run:
    """A sweep that diverts twice; one obstacle lies over the border."""
    return gallery_run("case2")
