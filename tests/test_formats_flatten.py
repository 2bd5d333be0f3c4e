"""Ellipses, splines and Bézier curves of files, read by arcs."""

from __future__ import annotations

import math
import re
from pathlib import Path

import ezdxf
import pytest
from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.by_suffix import load
from exactacq.files.repairs.bezier import polynomial
from exactacq.files.repairs.flattened import Flattening
from exactacq.numbers.rationals import rational
from exactacq.scene.scene import Scene


def flattened(scene: Scene) -> str:
    return next(note for note in scene.notes if note.startswith("flattened"))


def svg(tmp_path: Path, body: str) -> Path:
    path = tmp_path / "drawing.svg"
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{body}</svg>')
    return path


def dxf(tmp_path: Path, draw: object) -> Path:
    document = ezdxf.new()
    draw(document.modelspace())
    path = tmp_path / "drawing.dxf"
    document.saveas(path)
    return path


def area(scene: Scene) -> float:
    return sum(float(obstacle.area) for obstacle in scene.obstacles)


def test_an_ellipse_of_dxf_has_its_area(tmp_path: Path) -> None:
    path = dxf(tmp_path, lambda m: m.add_ellipse((10, 5), major_axis=(3, 4), ratio=0.4))
    for power in (1, 2, 4):
        scene = load(path, start=(0, -20), flatten=f"1/{10**power}")
        assert f"farther than {10.0**-power:.2g} from" in flattened(scene)
        perimeter = 2 * math.pi * 5
        assert area(scene) == pytest.approx(math.pi * 5 * 2, abs=perimeter * 10.0**-power)


def test_an_arc_of_an_ellipse_is_closed_by_a_line(tmp_path: Path) -> None:
    """Half of an ellipse, cut by a line from end to end; in floats its ends are not quite on the axis."""

    def draw(model: object) -> None:
        model.add_ellipse((0, 0), major_axis=(4, 0), ratio=0.5, start_param=0, end_param=math.pi)
        model.add_line((-4, 0), (4, 0))

    scene = load(dxf(tmp_path, draw), start=(0, -20), flatten=0.001)
    assert area(scene) == pytest.approx(math.pi * 4, abs=0.02)
    assert not [note for note in scene.notes if note.startswith("joined")]


def test_an_arc_between_other_angles_keeps_its_bound(tmp_path: Path) -> None:
    def draw(model: object) -> None:
        model.add_ellipse((0, 0), major_axis=(4, 0), ratio=0.5, start_param=0.3, end_param=2)
        ends = [(4 * math.cos(t), 2 * math.sin(t)) for t in (0.3, 2)]
        model.add_line(*ends)

    scene = load(dxf(tmp_path, draw), start=(0, -20), flatten=0.001)
    assert area(scene) == pytest.approx(4 * 2 / 2 * (1.7 - math.sin(1.7)), abs=0.01)


def test_a_mirrored_ellipse(tmp_path: Path) -> None:
    def draw(model: object) -> None:
        ellipse = model.add_ellipse((0, 0), major_axis=(4, 0), ratio=0.5, start_param=0, end_param=math.pi)
        ellipse.dxf.extrusion = (0, 0, -1)
        model.add_line((-4, 0), (4, 0))

    scene = load(dxf(tmp_path, draw), start=(0, 20), flatten=0.01)
    assert max(float(y) for o in scene.obstacles for _, y, _ in o.shape.vertices) == 0


def test_splines_of_dxf(tmp_path: Path) -> None:
    def draw(model: object) -> None:
        model.add_open_spline([(0, 0, 0), (0, 4, 0), (4, 4, 0), (4, 0, 0)], degree=3)
        model.add_line((0, 0), (4, 0))
        model.add_spline().set_closed([(20, 0, 0), (24, 0, 0), (24, 4, 0), (20, 4, 0)])
        model.add_spline([(50, 0, 0), (51, 1, 0), (52, 0, 0)])

    scene = load(dxf(tmp_path, draw), start=(0, -20), flatten=0.01)
    assert len(scene.obstacles) == 2
    assert flattened(scene).startswith("flattened 2 SPLINEs into")
    assert any("1 SPLINE of fit points only" in note for note in scene.notes)
    assert float(scene.obstacles[0].area) == pytest.approx(9.6, abs=0.1)


def test_without_the_option_the_note_tells_of_it(tmp_path: Path) -> None:
    def draw(model: object) -> None:
        model.add_ellipse((10, 5), major_axis=(3, 4), ratio=0.4)
        model.add_circle((0, 0), 1)

    scene = load(dxf(tmp_path, draw), start=(0, -20))
    assert any("--flatten" in note for note in scene.notes)


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("M10 10 C10 30 30 30 30 10 Z", 240),
        ("M10 10 c0 20 20 20 20 0 z", 240),
        ("M10 10 Q20 30 30 10 Z", 400 / 3),
        ("M10 10 q10 20 20 0 t20 0 V50 H10z", 1600),
        ("M10 10 C10 30 30 30 30 10 S50 -10 50 10 V50 H10z", 1600),
        ("M10 20 A10 5 0 0 1 30 20 Z", math.pi * 25),
        ("M10 20 A10 5 0 1 0 30 20 Z", math.pi * 25),
        ("M30 20 A10 5 90 1 0 30 20.1 Z", math.pi * 50),
        ("M10 20 A10 5 30 0 1 20 20 Z", None),
    ],
)
def test_paths_of_svg(tmp_path: Path, path: str, expected: float | None) -> None:
    scene = load(svg(tmp_path, f'<path d="{path}"/>'), start=(90, 90), flatten=0.01)
    assert len(scene.obstacles) == 1
    if expected is not None:
        assert area(scene) == pytest.approx(expected, abs=1.2)
    assert "0.01" in flattened(scene)


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<ellipse cx="20" cy="20" rx="10" ry="5"/>', math.pi * 50),
        ('<circle cx="20" cy="20" r="5" transform="scale(2,1)"/>', math.pi * 50),
        ('<path d="M20 20a5 5 0 0 1 10 0a5 5 0 0 1-10 0" transform="matrix(2 0 1 1 0 0)"/>', math.pi * 50),
        (
            '<rect x="10" y="10" width="20" height="20" rx="4" transform="scale(2,1)"/>',
            800 - 32 * (4 - math.pi),
        ),
    ],
)
def test_ovals_of_svg(tmp_path: Path, body: str, expected: float) -> None:
    scene = load(svg(tmp_path, body), start=(95, 95), flatten=0.001)
    assert area(scene) == pytest.approx(expected, abs=0.12)


def test_the_message_of_a_curve_names_the_option(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="with --flatten LENGTH"):
        load(svg(tmp_path, '<path d="M10 10 C10 30 30 30 30 10 Z"/>'), start=(90, 90))


@pytest.mark.parametrize("value", [0, -1])
def test_a_length_is_needed(tmp_path: Path, value: int) -> None:
    with pytest.raises(FormatError, match=re.escape(f"flatten: a length above 0 is needed, not {value}")):
        load(svg(tmp_path, '<path d="M10 10 C10 30 30 30 30 10 Z"/>'), start=(90, 90), flatten=fmpq(value))


def test_a_drawing_of_too_many_arcs_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("exactacq.files.repairs.flattened.MAX_EDGES", 3)
    with pytest.raises(FormatError, match="flatten: more than 3 arcs"):
        load(svg(tmp_path, '<path d="M10 10 C10 30 30 30 30 10 Z"/>'), start=(90, 90), flatten="1/100")


def test_curves_that_are_alike_are_flattened_once(tmp_path: Path) -> None:
    """A page of letters, or a megabyte of one ellipse over and over: only the first takes time."""
    shape = "M{0} {1}c0 {2} 4 {2} 4 0z"
    path = tmp_path / "a.svg"
    places = [(10 * x, 7 * y) for x in range(5) for y in range(4)]
    path.write_text(f'<svg><path d="{"".join(shape.format(*place, 3) for place in places)}"/></svg>')
    obstacles = load(path, start=(-5, -5), flatten="0.001").shapes
    first = obstacles[0].vertices
    assert len(obstacles) == len(places)
    for shape, (x, y) in zip(obstacles, places, strict=True):
        assert shape.vertices == tuple((u + x, v - y, bend) for u, v, bend in first)
    reader = Flattening(rational("0.001"))
    piece = polynomial([(rational(x), rational(y)) for x, y in ((0, 0), (0, 3), (4, 3), (4, 0))])
    made = []
    for _ in range(3):
        reader.corners("Bézier curve", [piece])
        made.append(reader.made)
    assert made[0] == made[2] > 0 and reader.arcs == 3 * 10


def test_a_drawing_of_nothing_but_an_ellipse_is_told_to_flatten(tmp_path: Path) -> None:
    path = dxf(tmp_path, lambda m: m.add_ellipse((0, 0), (4, 0), 0.5))
    with pytest.raises(FormatError, match=r"nothing to read \(left out 1 ELLIPSE\); .*--flatten LENGTH"):
        load(path, start=(9, 9))
    assert len(load(path, start=(9, 9), flatten="0.1").obstacles) == 1
