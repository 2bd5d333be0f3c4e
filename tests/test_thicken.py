"""Walls of lines: their outlines against shapely's, and at distances told by formulas."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from random import Random

import ezdxf
import mpmath
import numpy as np
import pytest
import shapely
from flint import fmpq
from nightly import some

from exactacq.errors import FormatError
from exactacq.files.by_suffix import load
from exactacq.files.loops.chains import Chain, Corner
from exactacq.files.repairs.overlay import overlay
from exactacq.files.repairs.thicken import thicken, unit_near
from exactacq.scene.scene import Scene


def chain(*rows: tuple[object, object, object]) -> Chain:
    return Chain("wall", [Corner(*(fmpq(v) for v in row)) for row in rows])


def points_of(wall: Chain, count: int = 2000) -> np.ndarray:
    """Points along a chain, by w = s / (s + (1 - s) exp(2 i atan b))."""
    s = np.linspace(0, 1, count)
    parts = []
    for a, b in pairwise(wall.corners):
        p, q = complex(float(a.x), float(a.y)), complex(float(b.x), float(b.y))
        w = s / (s + (1 - s) * np.exp(2j * np.arctan(float(a.bulge))))
        parts.append(p + (q - p) * w)
    return np.concatenate(parts)


def random_chain(random: Random) -> Chain:
    rows = []
    while len(rows) < random.randrange(2, 6):
        place = random.randrange(20), random.randrange(20)
        if not rows or rows[-1][:2] != place:
            rows.append((*place, random.choice([0, 0, fmpq(1, 2), fmpq(-1, 3), 1, fmpq(3, 2)])))
    return chain(*rows)


@pytest.mark.parametrize("seed", some(range(25), 8))
def test_the_union_is_what_is_near_the_chain(seed: int) -> None:
    random = Random(seed)
    wall = random_chain(random)
    half = float(fmpq(random.randrange(1, 9), 4))
    thick = thicken([wall], fmpq(int(half * 8), 4))
    line = shapely.LineString([(z.real, z.imag) for z in points_of(wall)])
    wanted = line.buffer(half, quad_segs=256)
    rings = [
        (r.outer, shapely.geometry.shape(r.shape("").__geo_interface__)) for r in overlay(thick.shapes, any)
    ]
    found = shapely.union_all([p for outer, p in rings if outer]).difference(
        shapely.union_all([p for outer, p in rings if not outer])
    )
    # Chords of arcs, here and there, stray by 10^-4 of radii below 25.
    assert found.symmetric_difference(wanted).area < wanted.length * 4e-3
    assert thick.off < fmpq(1, 10**10)


@pytest.mark.parametrize("bulge", [0, fmpq(1, 3), fmpq(-1, 3), fmpq(5, 2)])
def test_every_corner_is_at_half_the_thickness_nearly(bulge: fmpq) -> None:
    wall = chain((0, 0, bulge), (7, 3, 0))
    places = points_of(wall, 20001)
    body, *_ = thicken([wall], fmpq(1)).shapes
    for x, y, _ in body.vertices:
        assert np.abs(places - complex(float(x), float(y))).min() == pytest.approx(0.5, abs=1e-6)


def test_lines_along_the_axes_are_exact() -> None:
    thick = thicken([chain((0, 0, 0), (5, 0, 0), (5, 5, 0), (8, 9, 0))], fmpq(1))
    assert thick.off == 0
    rings = overlay(thick.shapes, any)
    assert len(rings) == 1
    assert rings[0].chain.moved() == 0


def test_an_arc_tighter_than_half_the_thickness_is_a_sector() -> None:
    wall = chain((0, 0, 1), (1, 0, 0))
    rings = overlay(thicken([wall], fmpq(4)).shapes, any)
    wanted = shapely.LineString([(z.real, z.imag) for z in points_of(wall)]).buffer(2, quad_segs=256)
    (ring,) = rings
    shape = ring.shape("")
    Scene([shape])
    assert shapely.geometry.shape(shape.__geo_interface__).area == pytest.approx(wanted.area, rel=1e-3)


@pytest.mark.parametrize(
    "vector", [(3, 4), (-1, 1), (1, 0), (0, -7), (fmpq(1, 10**9), 1), (5, fmpq(1, 10**30))]
)
def test_a_unit_vector_is_one_and_near(vector: tuple[object, object]) -> None:
    x, y = (fmpq(v) for v in vector)
    (u, v), angle = unit_near((x, y))
    assert u * u + v * v == 1
    with mpmath.workdps(60):
        a, b, c, d = (mpmath.mpf(int(w.p)) / int(w.q) for w in (x, y, u, v))
        assert (
            abs(mpmath.atan2(a * d - b * c, a * c + b * d)) <= mpmath.mpf(int(angle.p)) / int(angle.q) + 1e-50
        )
    assert angle < fmpq(1, 2**49)


@pytest.mark.parametrize("thickness", [fmpq(0), fmpq(-1)])
def test_a_thickness_is_a_length(thickness: fmpq) -> None:
    with pytest.raises(FormatError, match="above 0"):
        thicken([], thickness)


def plan(tmp_path: Path) -> Path:
    """Two rooms by four lines and one between them; a chair."""
    document = ezdxf.new()
    model = document.modelspace()
    for a, b in (
        ((0, 0), (10, 0)),
        ((10, 0), (10, 6)),
        ((10, 6), (0, 6)),
        ((0, 6), (0, "0.5")),
        ((5, 0), (5, 4)),
    ):
        model.add_line(tuple(map(float, a)), tuple(map(float, b)))
    model.add_circle((2, 2), 0.5)
    path = tmp_path / "plan.dxf"
    document.saveas(path)
    return path


def test_a_plan_of_lines(tmp_path: Path) -> None:
    path = plan(tmp_path)
    inside = load(path, start=(8, 3), thicken="1/5")
    assert inside.enclosure is None
    assert [len(o.edges) for o in inside.obstacles] and len(inside.obstacles) == 2
    assert any(note.startswith("made walls 0.2 thick") for note in inside.notes)
    closed = load(path, start=(8, 3), thicken=2)
    assert closed.enclosure is not None
    with pytest.raises(FormatError, match="start"):
        load(path, thicken=1)


def test_walls_whose_outlines_meet_in_one_point_of_two_forms(tmp_path: Path) -> None:
    """Two lines, one along the other, run into an arc whose end rounding has moved.

    The point was computed twice, with roots whose squares were not split off, and no union was found.
    """
    document = ezdxf.new()
    model = document.modelspace()
    model.add_arc((136, 15), 5, 270, 0)
    for x in (63.99999999999999, -74):
        model.add_line((x, 10), (135.9999973026017, 10))
    path = tmp_path / "walls.dxf"
    document.saveas(path)
    scene = load(path, start=(0, 60), thicken="1.1")
    (obstacle,) = scene.obstacles
    area = 1.1 * (135.9999973 + 74) + 1.1 * 5 * np.pi / 2 + np.pi * 0.55**2
    assert float(obstacle.area) == pytest.approx(area, rel=1e-6)
