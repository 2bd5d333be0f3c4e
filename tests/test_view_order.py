"""Which way places move where lines turn is known without comparing them: here they are compared."""

from __future__ import annotations

from collections import Counter

import pytest
from flint import fmpq
from nightly import some

import exactacq as xa
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.line_points import Role
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.study.random_scenes import Subject, random_scene
from exactacq.visibility.sensor_range import Range

ROOM = xa.Scene(
    [xa.Circle((3, 3), 1), xa.Outline([(6, 2, 0), (9, 2, "1/2"), (9, 5, "-1/3"), (6, 5, 1)])],
    enclosure=xa.Circle((5, 4), 8),
)
"""A round room with a disc, and a boundary that turns both ways."""
SEEDS = some(range(64500000, 64500200), 12)


def moves(scene: xa.Scene, radius: fmpq) -> Counter[str]:
    """How often a place moves as told, by its role, among all families of a scene."""
    table = EdgeTable(scene.obstacles)
    families = VisibilityComplex(table, Range(radius))
    found: Counter[str] = Counter()
    for e in range(len(table.curves)):
        for one in families.extents(e):
            for family, _ in families.views(one):
                for k in (0, 1):
                    grows = None if family.free_views is None else family.free_views.grows(k)
                    order = family.first.places[k].compare(family.last.places[k])
                    assert grows is None or order in (0, -1 if grows else 1)
                    if grows is not None and order:
                        assert family.free_views is not None
                        found[family.free_views.sides[k].role.name] += 1
    return found


def test_in_a_room() -> None:
    assert min(moves(ROOM, fmpq(6))[role.name] for role in Role) > 10


@pytest.mark.parametrize("name", ["circles", "squares", "plate", "figure2"])
def test_in_the_gallery(name: str) -> None:
    assert moves(xa.load(name), fmpq(4))["AHEAD"] > 0


def test_in_random_scenes() -> None:
    found: Counter[str] = Counter()
    for seed in SEEDS:
        scene = random_scene(Subject.SIGHTSEER, seed)
        found += moves(scene, scene.radius or fmpq(3))
    assert min(found[role.name] for role in Role) > 10
