"""A terrain may lie anywhere: a scene that is moved gives the run that is moved, and passes the audit."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from flint import fmpq
from nightly import some

import exactacq as xa
from exactacq.files.scene_json import scene_to_json
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real, rational
from exactacq.scene.shapes import Shape
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import random_scene

SHIFT = fmpq(-1301, 10), fmpq(77, 3)


def moved(scene: xa.Scene) -> xa.Scene:
    """The scene, its SW corner in SHIFT."""
    dx, dy = SHIFT

    def shape(one: Shape) -> Shape:
        if isinstance(one, xa.Circle):
            return xa.Circle((one.center[0] + dx, one.center[1] + dy), one.radius, one.name)
        rows = [(x + dx, y + dy, bulge) for x, y, bulge in one.vertices]
        return (
            xa.Outline(rows, one.name)
            if isinstance(one, xa.Outline)
            else xa.Polygon([row[:2] for row in rows], one.name)
        )

    assert scene.terrain is not None
    terrain = xa.Terrain(scene.terrain.width, scene.terrain.height, origin=SHIFT)
    return xa.Scene(map(shape, scene.shapes), terrain=terrain, radius=scene.radius, name=scene.name)


SCENES = {name: xa.load(name) for name in ("figure3", "m15", "e3")}
SCENES |= {f"random {seed}": random_scene(Subject.SEED_SPREADER, seed) for seed in range(40, 52)}


@pytest.mark.parametrize("name", some(SCENES, 6))
def test_a_moved_scene_gives_the_moved_run(name: str) -> None:
    scene, away = SCENES[name], moved(SCENES[name])
    run, other = xa.seed_spreader(scene), xa.seed_spreader(away)
    assert other.length == run.length
    assert other.start == Point(*SHIFT)
    assert len(other.events) == len(run.events)
    for one, two in zip(run.events, other.events, strict=True):
        assert (two.kind, two.obstacle, two.reason) == (one.kind, one.obstacle, one.reason)
        assert two.point == one.point + Point(*SHIFT)
    assert other.bounds == run.bounds
    assert other.map.known_length() == run.map.known_length()
    assert [c.label for c in other.obstacles] == [c.label for c in run.obstacles]
    xa.audit(other, samples=8)


def test_a_terrain_says_where_it_is(tmp_path: Path) -> None:
    terrain = xa.Terrain(4, "5/2", origin=("0.1", -3))
    assert terrain.limits == (fmpq(1, 10), -3, fmpq(41, 10), fmpq(-1, 2))
    assert terrain.south_west == Point("0.1", -3)
    assert xa.Terrain(4, "5/2", terrain.south_west) == terrain != xa.Terrain(4, "5/2")
    scene = xa.Scene([xa.Circle((2, -2), "1/2")], terrain=terrain, radius=1)
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(scene_to_json(scene)))
    assert xa.load(path) == scene
    assert scene.meets_border() == []
    run = xa.seed_spreader(scene)
    assert run.ending.name == "END_OF_M_LINE"


@pytest.mark.parametrize("origin", [(1,), "ab", (1, "x"), Point(0, Real(2).sqrt())])
def test_an_origin_that_is_none_is_refused(origin: object) -> None:
    with pytest.raises(xa.FormatError, match="origin"):
        xa.Terrain(3, 4, origin=origin)  # type: ignore[arg-type]


def test_the_start_is_the_south_west_corner() -> None:
    scene = xa.Scene([], start=(0, 0), terrain=xa.Terrain(4, 4, origin=(1, 1)), radius=1)
    with pytest.raises(xa.InvalidScene, match=r"the start .* is not the terrain's SW corner \(1, 1\)"):
        xa.seed_spreader(scene)
    covered = xa.Scene([xa.Circle((1, 1), 1)], terrain=xa.Terrain(4, 4, origin=(1, 1)), radius=1)
    with pytest.raises(xa.InvalidScene, match=r"obstacle O1 covers the SW corner \(1, 1\)"):
        xa.seed_spreader(covered)


def test_the_terrain_around_a_scene_holds_it() -> None:
    """Irrational extents are rounded outward, by less than a millionth of the radius."""
    moon = xa.Outline([(0, 0, "1/2"), (4, 1, "-1/3")])
    scene = xa.Scene([moon, [(-3, 5), (-2, 5), (-2, 6)]])
    around = xa.terrain_around(scene)
    assert xa.Scene(scene.shapes, terrain=xa.terrain_around(scene, "1/100")).meets_border() == []
    for k in range(4):
        inward = [fmpq(0)] * 4
        inward[k] = fmpq(1, 10**5) * (1 if k < 2 else -1)
        west, south, east, north = (a + b for a, b in zip(around.limits, inward, strict=True))
        smaller = xa.Terrain(east - west, north - south, (west, south))
        assert scene.replace(terrain=smaller).meets_border() != []
    with pytest.raises(xa.FormatError, match="margin: must not be negative"):
        xa.terrain_around(scene, -1)
    with pytest.raises(xa.InvalidScene, match="no extent"):
        xa.terrain_around(xa.Scene([]))


@pytest.mark.parametrize("margin", [0, "1/3"])
def test_the_terrain_around_a_scene_holds_its_start(margin: object) -> None:
    """It did not: the Sightseer began outside of the terrain that `compare` showed."""
    disc = xa.Circle((5, 0), 2)
    about, room = xa.terrain_around(xa.Scene([disc]), margin), rational(margin)
    for start, sides in (
        ((5, 3), (3, -2, 7, 3)), ((-1, -4), (-1, -4, 7, 2)), ((9, 1), (3, -2, 9, 2)),
        ((3, -2), (3, -2, 7, 2)),
    ):  # fmt: skip
        scene = xa.Scene([disc], start)
        west, south, east, north = xa.terrain_around(scene, margin).limits
        assert (west + room, south + room, east - room, north - room) == sides
        assert xa.terrain_around(scene.replace(start=None), margin) == about


def test_the_terrain_around_an_irrational_start_is_a_little_wider() -> None:
    root = xa.Real(10**9).sqrt()
    start = xa.Point(root, -root)
    west, south, east, north = xa.terrain_around(xa.Scene([xa.Circle((5, 0), 2)], start)).limits
    assert (west, north) == (3, 2)
    assert 0 < xa.Real(east) - root < root / 10**6 and 0 < -root - xa.Real(south) < root / 10**6


def test_a_rectangular_room_is_its_terrain() -> None:
    """The enclosure counts as the border: the sweep is that of the terrain alone."""
    post = xa.Circle((3, 3), 1)
    room = xa.Polygon([(-2, 0), (1, 0), (9, 0), (9, 7), (-2, 7)])
    run = xa.seed_spreader(xa.Scene([post], enclosure=room, radius=3))
    alone = xa.seed_spreader(xa.Scene([post], terrain=xa.Terrain(11, 7, (-2, 0)), radius=3))
    assert run == alone
    crooked = xa.Polygon([(-2, 0), (9, 0), (9, 7), (-2, 8)])
    with pytest.raises(xa.InvalidScene, match="an enclosure of another form must be left out"):
        xa.seed_spreader(xa.Scene([post], enclosure=crooked, radius=3))
    other = xa.Scene([post], enclosure=room, terrain=xa.Terrain(8, 6), radius=3)
    with pytest.raises(xa.InvalidScene, match="an enclosure"):
        xa.seed_spreader(other)
