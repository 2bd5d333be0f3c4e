"""Figures: curves that are curves, everything named in the legend, the same bytes every time."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from itertools import pairwise
from pathlib import Path
from random import Random

import matplotlib as mpl
import numpy as np
import pytest
import shapely
from gallery_runs import gallery_run
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.path import Path as Outline
from nightly import some
from sweeps import swept_scene

from exactacq import FormatError, InvalidScene
from exactacq.files import gallery
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.real import fmpq
from exactacq.output.figures.draw import figure, save, save_side_by_side, side_by_side, svg
from exactacq.output.figures.sweep import SweptTerrain, component_region
from exactacq.output.regions import Region, part
from exactacq.output.vocabulary import AWAY
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Polygon, Terrain
from exactacq.scene.terrain_components import ground_of
from exactacq.sensing.event import EventKind
from exactacq.strategies.run import Run
from exactacq.strategies.seed_spreader.strategy import seed_spreader
from exactacq.strategies.sightseer.strategy import sightseer
from exactacq.visibility.shortest_path import shortest_path

SVG = "{http://www.w3.org/2000/svg}"


def square(x: int, y: int, side: int = 2) -> Polygon:
    return Polygon([(x, y), (x + side, y), (x + side, y + side), (x, y + side)])


@pytest.fixture(scope="module")
def circles() -> Run:
    return gallery_run("circles")


@pytest.fixture(scope="module")
def eleven() -> Run:
    return gallery_run("figure2")


@pytest.fixture(scope="module")
def crossing() -> Run:
    """A sweep among obstacles over the border, one of them in two components."""
    corners = [(8, 3), (13, 3), (13, 6), (8, 6), (8, 5), (12, 5), (12, 4), (8, 4)]
    shapes = [square(3, 4, 1), Circle((4, 10), 2), Polygon(corners, name="fork")]
    return seed_spreader(Scene(shapes, terrain=Terrain(11, 10), radius=6, name="over the border"))


@pytest.fixture(scope="module")
def diverted() -> Run:
    return gallery_run("m15")


def texts(run: Run | Scene) -> list[str]:
    drawn = figure(run)
    return [t.get_text() for t in drawn.axes[0].texts]


def legend(run: Run | Scene) -> list[str]:
    return [t.get_text() for t in figure(run).legends[0].get_texts()]


def bezier_points(path: Outline) -> np.ndarray:
    """Points on the cubic pieces of a path, by de Casteljau's rule."""
    points, at = [], path.vertices[0]
    pieces = path.vertices[1:].reshape(-1, 3, 2)
    for a, b, c in pieces:
        for t in np.linspace(0, 1, 9):
            s = 1 - t
            points.append(s**3 * at + 3 * s * s * t * a + 3 * s * t * t * b + t**3 * c)
        at = c
    return np.array(points)


@pytest.mark.parametrize("bulge", ["1/1000000", "1/7", "-1/3", "1", "-1", "5", "-1000"])
def test_arcs_are_drawn_within_a_millionth_of_their_radius(bulge: str) -> None:
    from exactacq.numbers.rationals import rational

    arc = Arc.from_bulge(Point(1, 2), Point(4, -3), rational(bulge))
    path = part(arc.stroke(), 0, 1)
    assert set(path.codes[1:]) == {Outline.CURVE4}
    assert tuple(path.vertices[0]) == (1, 2)
    assert tuple(path.vertices[-1]) == (4, -3)
    offset = bezier_points(path) - arc.center.xy
    radius = float(arc.radius)
    assert np.abs(np.hypot(*offset.T) - radius).max() < 1e-6 * radius
    exact = np.array([arc.point(fmpq(k, 5)).xy for k in range(6)])
    assert arc.stroke().covers(exact, np.zeros(6), 1e-12 * max(radius, 1.0)).all()
    outside = np.array([arc.center.xy]) * 2 - exact[2]
    assert arc.stroke().covers(outside, np.zeros(1), 1e-12).any() == (abs(arc.stroke().sweep) > math.pi)


def test_nearly_straight_arcs_keep_their_digits() -> None:
    arc = Arc.from_bulge(Point(0, 0), Point(1, 0), fmpq(1, 10**9))
    for vertex in part(arc.stroke(), 0, 1).vertices:
        assert abs(vertex[1]) < 1e-8
        assert -1e-12 <= vertex[0] <= 1 + 1e-12


def test_parts_of_a_stroke_join() -> None:
    arc = Arc.from_bulge(Point(0, 0), Point(3, 1), fmpq(-7, 3))
    stroke = arc.stroke()
    parts = [part(stroke, k / 7, (k + 1) / 7) for k in range(7)]
    for before, after in pairwise(parts):
        assert np.allclose(before.vertices[-1], after.vertices[0], rtol=0, atol=1e-12)


def test_heart_lies_inside_a_concave_obstacle() -> None:
    horseshoe = Polygon([(0, 0), (10, 0), (10, 9), (9, 9), (9, 1), (1, 1), (1, 9), (0, 9)])
    obstacle = Scene([horseshoe]).obstacles[0]
    (x, y), depth = Region.of(obstacle).heart()
    assert obstacle.locate(Point(x, y)) == 1
    assert 0.4 < depth <= 0.75


def test_a_stroke_covers_what_runs_along_it() -> None:
    along, across = Segment(Point(1, 1), Point(3, 3)), Segment(Point(1, 3), Point(3, 1))
    stroke = Segment(Point(4, 4), Point(0, 0)).stroke()
    for segment, expected in ((along, True), (across, False)):
        other = segment.stroke()
        covered = stroke.covers(np.array([other.at(0.5)]), np.array([other.heading(0.5)]), 1e-9)
        assert covered.tolist() == [expected]


def test_a_stroke_shorter_than_the_tolerance_covers_nothing_far_away() -> None:
    """Its direction was divided by the tolerance instead of its length, so that all seemed to be near."""
    short = Segment(Point(0, 0), Point("8e-14", 0)).stroke()
    places = np.array([(5.0, 0.0), (0.0, 3.0), (4e-14, 0.0)])
    assert short.covers(places, np.zeros(3), 1e-6).tolist() == [False, False, True]


def test_pieces_walked_again_are_narrower(circles: Run) -> None:
    """Of the first circle a half is walked again on the way to the second one; of the links, none."""
    (path,) = (c for c in figure(circles).axes[0].collections if isinstance(c, PathCollection))
    widths, counts = np.unique(path.get_linewidths(), return_counts=True)
    assert len(widths) == 2
    share = counts[0] / counts.sum()
    assert share == pytest.approx(2 * math.pi / float(circles.length), abs=0.02)


def test_colours_follow_the_path_length(circles: Run) -> None:
    (path,) = (c for c in figure(circles).axes[0].collections if isinstance(c, PathCollection))
    times = path.get_array()
    assert (np.diff(times) > 0).all()
    assert path.norm.vmin == 0
    assert path.norm.vmax == pytest.approx(float(circles.length))


def test_labels_show_order_ends_and_range_once(eleven: Run) -> None:
    shown = texts(eleven)
    assert sorted(shown) == sorted(
        [*(f"{sign}{k}" for sign in "O#" for k in range(1, 12)), "S", "T", "R = 10"]
    )
    assert set(legend(eleven)) >= {
        "link",
        "hit point",
        "leave point",
        "start S",
        "end T",
        "#1, #2, ...: order of visits",
    }


def test_title_has_the_closed_form_if_short(circles: Run, eleven: Run) -> None:
    assert any("5 + 12*pi ≈ 42.699112" in t.get_text() for t in figure(circles).texts)
    assert any("length ≈ 439.73956" in t.get_text() for t in figure(eleven).texts)


def test_what_was_missed_is_drawn_and_named() -> None:
    scene = Scene([Circle((5, 0), 2), square(40, 0)], start=(0, 0))
    run = sightseer(scene, 5)
    assert "never seen" in legend(run)
    assert any("1 never seen" in t.get_text() for t in figure(run).texts)
    assert "seen, never visited" in legend(sightseer(gallery.scene("m4")))


def test_radius_beyond_the_view_is_said_in_the_legend(circles: Run) -> None:
    assert "R = 20 (beyond the view)" in legend(circles)


@pytest.mark.parametrize(
    "scene",
    [
        gallery.scene("figure2"),
        Scene([Circle((5 * k, 0), 1) for k in range(1, 21)], start=(0, 0), radius=10, name="a row"),
        Scene([square(0, 10 * k) for k in range(1, 12)], start=(0, 0), radius=10, name="a column"),
        Scene([square(3, 3)], start=(1, 1), radius=3, enclosure=square(0, 0, 9)),
        Scene(start=(0, 0), radius=3),
        Scene([square(9, 0)], start=(0, 0), radius=3, name="a name that is too long for a title, " * 4),
        gallery.scene("m18"),
        gallery.scene("e3"),
        gallery.scene("case2"),
    ],
    ids=["figure2", "row", "column", "room", "empty", "named", "m18", "e3", "case2"],
)
def test_layout_keeps_everything_apart_and_true(scene: Scene) -> None:
    """Drawing, colour bar, legend and titles do not overlap nor leave the page; both axes have one scale."""
    drawn = figure(sightseer(scene) if scene.terrain is None else seed_spreader(scene))
    drawn.canvas.draw()
    axes = drawn.axes[0]
    boxes = [a.get_tightbbox() for a in drawn.axes] + [x.get_window_extent() for x in drawn.legends]
    boxes += [t.get_window_extent() for t in drawn.texts]
    for k, box in enumerate(boxes):
        assert box.x0 >= 0
        assert box.y0 >= 0
        assert box.x1 <= drawn.bbox.x1
        assert box.y1 <= drawn.bbox.y1
        assert not any(box.overlaps(other) for other in boxes[:k])
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    assert axes.bbox.width / (x1 - x0) == pytest.approx(axes.bbox.height / (y1 - y0))


def test_svg_is_wellformed_and_made_of_curves(circles: Run) -> None:
    root = ET.fromstring(svg(circles))
    assert root.tag == f"{SVG}svg"
    assert not list(root.iter(f"{SVG}image"))
    obstacles = [p for p in root.iter(f"{SVG}path") if "fill: #dcd7cd" in p.get("style", "")]
    assert len(obstacles) == 2
    for path in obstacles:
        assert path.get("d", "").count("C ") == 16
        assert "L " not in path.get("d", "")


def test_svg_is_the_same_in_every_process_and_under_every_setting(circles: Run) -> None:
    here = svg(circles)
    with mpl.rc_context({"lines.linewidth": 9, "font.size": 30, "axes.grid": True, "svg.fonttype": "none"}):
        assert svg(circles) == here
    code = (
        "import exactacq as xa; print(exactacq.output.figures.svg(xa.sightseer(xa.load('circles'))), end='')"
    )
    code = f"import sys, exactacq.output.figures; sys.stdout.reconfigure(encoding='utf-8'); {code}"
    environment = {**os.environ, "PYTHONHASHSEED": "12345"}
    there = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, env=environment, timeout=60, check=True
    )
    assert there.stdout.decode() == here


@pytest.mark.parametrize(("suffix", "magic"), [(".svg", b"<?xml"), (".pdf", b"%PDF"), (".PNG", b"\x89PNG")])
def test_save_writes_every_type_twice_the_same(
    circles: Run, tmp_path: Path, suffix: str, magic: bytes
) -> None:
    paths = [tmp_path / f"{name}{suffix}" for name in "ab"]
    for path in paths:
        save(circles, path)
    first, second = (path.read_bytes() for path in paths)
    assert first.startswith(magic)
    assert first == second
    assert sorted(tmp_path.iterdir()) == paths


def test_unknown_type_is_refused_before_drawing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("exactacq.output.figures.draw.figure", lambda _: pytest.fail("was drawn"))
    with pytest.raises(FormatError, match=r"must end in \.svg, \.pdf, \.png"):
        save(Scene(), tmp_path / "run.jpeg")
    assert not list(tmp_path.iterdir())


def test_a_failed_write_keeps_the_old_file(
    tmp_path: Path, circles: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "run.svg"
    target.write_text("old")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(OSError, match="No space"):
        save(circles, target)
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_scenes_alone_are_drawn_with_names() -> None:
    scene = Scene([Polygon([(0, 0), (9, 0), (9, 9), (0, 9)], name="A1"), Circle((20, 0), 5)])
    assert sorted(texts(scene)) == ["A1", "O2"]
    ET.fromstring(svg(scene))


def test_long_names_that_begin_alike_are_numbers() -> None:
    """As those of walls that were merged: what is left of them when they are cut tells them apart no more."""
    names = [
        "union of 'LINE 16', 'LINE 17'",
        "union of 'LINE 16', 'LINE 18'",
        "a long name of its own",
        "B",
        "B",
    ]
    scene = Scene([Circle((20 * k, 0), 9, name=name) for k, name in enumerate(names)])
    assert sorted(texts(scene)) == ["B", "B", "O1", "O2", "a long name of it…"]


# -- sweeps ----------------------------------------------------------------------------------------


def area(region: Region) -> float:
    x, y = region.points.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def test_components_are_closed_along_the_border(crossing: Run) -> None:
    """The half disc, the two tines of a fork whose handle lies outside, and what lies inside as it is."""
    sweep = SweptTerrain.of(crossing)
    assert sweep is not None
    assert [body.label for body in crossing.obstacles] == ["O1", "O2", "fork a", "fork b"]
    found = [area(region) for region in sweep.regions]
    assert found == pytest.approx([1, 2 * math.pi, 3, 3], rel=1e-2)
    for body, region in zip(crossing.obstacles, sweep.regions, strict=True):
        low, high = region.box
        assert (low >= 0).all()
        assert (high <= (11, 10)).all()
        (x, y), depth = region.heart()
        assert depth > 0
        assert body.obstacle.locate(Point(x, y)) == 1  # type: ignore[attr-defined]


def inside(shape: Polygon, width: int, height: int) -> float:
    """The area of a polygon within a terrain, by shapely."""
    outline = shapely.Polygon([(float(x), float(y)) for x, y, _ in shape.vertices])
    return float(outline.intersection(shapely.box(0, 0, width, height)).area)


@pytest.mark.parametrize(
    "corners",
    [
        [(5, -1), (9, -1), (9, 9), (-1, 9), (-1, 5), (4, 4)],  # over three corners
        [(-1, 2), (9, 2), (9, 3), (-1, 3)],  # across: the far side is out of reach
        [(7, 7), (9, 7), (9, 9), (7, 9)],
        [(9, 1), (9, 7), (2, 7), (8, 4), (2, 2), (8, 1)],  # touches the border from inside itself
        [(2, 8), (8, 2), (9, 2), (9, 9), (2, 9)],  # its ends are on two sides
        [(2, 1), (3, 1), (3, 9), (-1, 9), (-1, 5), (2, 5)],
    ],
)
def test_components_over_corners(corners: list[tuple[int, int]]) -> None:
    shape = Polygon(corners)
    ground = ground_of(Scene([shape], terrain=Terrain(8, 8)))
    regions = [component_region(c, ground.terrain) for c in ground.components]
    assert sum(map(area, regions)) == pytest.approx(inside(shape, 8, 8))


@pytest.mark.parametrize("seed", range(60))
def test_components_fill_what_the_terrain_leaves(seed: int) -> None:
    scene = swept_scene(Random(seed), arcs=False)
    ground = ground_of(scene)
    width, height = int(ground.terrain.width), int(ground.terrain.height)
    for obstacle, shape in zip(scene.obstacles, scene.shapes, strict=True):
        parts = [component_region(c, ground.terrain) for c in ground.of(obstacle.index)]
        assert all(area(part) > 0 for part in parts)
        assert sum(map(area, parts)) == pytest.approx(inside(shape, width, height))  # type: ignore[arg-type]


def test_a_sweep_names_all_that_it_shows(crossing: Run, diverted: Run) -> None:
    assert {"M-line", "crossing point", "unreachable", "start S", "end T"} <= set(legend(crossing))
    assert {"M-line", "diversion", "D", "Q"} <= set(legend(diverted))
    assert {"unreachable", "crossing point"}.isdisjoint(legend(diverted))
    assert {"D", "Q", "E", "W", "#1", "S", "T", "R = 20"} == set(texts(diverted))
    titles = [t.get_text() for t in figure(diverted).texts]
    assert titles[0] == "Seed Spreader Strategy: m15"
    assert titles[1].endswith("2 of 2 obstacles acquired")
    assert len(titles) == 2


def test_labels_lie_in_the_components_that_were_circled(crossing: Run) -> None:
    shown = {t.get_text(): t.get_position() for t in figure(crossing).axes[0].texts}
    for number in crossing.visits:
        place = Point(*shown[crossing.obstacles[number].label])
        assert crossing.obstacles[number].obstacle.locate(place) == 1  # type: ignore[attr-defined]


def test_what_is_missed_by_a_sweep_is_said() -> None:
    missed = figure(seed_spreader(gallery.scene("m14")))
    assert [t.get_text() for t in missed.texts][2:] == ["1 never seen"]
    ended = seed_spreader(gallery.scene("e3"))
    assert [t.get_text() for t in figure(ended).texts][2:] == ["ended before T"]
    assert "stop" in legend(ended)
    wall = Polygon([(-1, 4), (9, 4), (9, 5), (-1, 5)])
    behind = seed_spreader(Scene([wall, square(3, 6, 1)], terrain=Terrain(8, 8)), 8)
    assert "1 unreachable" in [t.get_text() for t in figure(behind).texts][2]


def path_colours(run: Run) -> set[str]:
    drawn = figure(run).axes[0]
    (path,) = (c for c in drawn.collections if c.get_zorder() == 3)
    path.update_scalarmappable()
    return {mpl.colors.to_hex(colour) for colour in path.get_edgecolors()}


def test_diversions_have_their_own_colour(crossing: Run, diverted: Run) -> None:
    assert AWAY in path_colours(diverted)
    assert AWAY not in path_colours(crossing)


def test_a_moment_of_a_sweep(diverted: Run) -> None:
    """Before the diversion nothing of it is shown; at its start D and Q are; then its path."""
    (diversion,) = diverted.diversions  # type: ignore[union-attr]
    leaves = next(event for event in diverted.events if event.kind == "divert")
    before = [t.get_text() for t in figure(diverted, at=100).legends[0].get_texts()]
    assert "D" not in before
    assert {"M-line", "robot", "view"} <= set(before)
    then = figure(diverted, at=leaves)
    assert {"D", "Q"} <= {t.get_text() for t in then.axes[0].texts}
    assert "after" in then.texts[1].get_text()
    assert diversion.first == leaves.after


def test_many_runs_stand_in_rows_and_are_drawn_to_one_scale() -> None:
    """Though they begin in different places; nothing covers anything."""
    scene = Scene([Circle((3, 9), 1), square(4, 4)], (0, 0), radius=12, name="two")
    runs = [sightseer(scene, start=start) for start in ((0, 0), (-9, 0), (4, 20), (9, 9))]
    drawn = side_by_side(runs)
    drawn.canvas.draw()
    maps = [ax for ax in drawn.axes if len(ax.patches) > 1]
    assert len(maps) == 4
    assert len({(*ax.get_xlim(), *ax.get_ylim()) for ax in maps}) == 1
    assert maps[0].bbox.y0 == pytest.approx(maps[1].bbox.y0) and maps[2].bbox.y1 < maps[0].bbox.y0
    boxes = [ax.get_tightbbox() for ax in drawn.axes] + [x.get_window_extent() for x in drawn.legends]
    boxes += [t.get_window_extent() for t in drawn.texts]
    for k, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[:k])


def test_two_runs_side_by_side(tmp_path: Path) -> None:
    shapes = [Circle((3, 9), 1), Circle((8, 3), 1), square(4, 4)]
    scene = Scene(shapes, (0, 0), terrain=Terrain(12, 11), radius=7, name="three")
    seen, swept = sightseer(scene), seed_spreader(scene)
    drawn = side_by_side([seen, swept])
    drawn.canvas.draw()
    titles = [t.get_text() for t in drawn.texts]
    assert {"Sightseer Strategy: three", "Seed Spreader Strategy: three"} <= set(titles)
    boxes = [a.get_tightbbox() for a in drawn.axes] + [x.get_window_extent() for x in drawn.legends]
    boxes += [t.get_window_extent() for t in drawn.texts]
    for k, box in enumerate(boxes):
        assert min(box.x0, box.y0) >= 0
        assert box.x1 <= drawn.bbox.x1
        assert box.y1 <= drawn.bbox.y1
        assert not any(box.overlaps(other) for other in boxes[:k])
    left, right = drawn.axes[0], drawn.axes[1]
    assert left.bbox.y0 == pytest.approx(right.bbox.y0)
    assert left.bbox.height == pytest.approx(right.bbox.height)
    bars = [ax for ax in drawn.axes if ax.get_xlabel() == "path, by length"]
    longest = float(max(seen.length, swept.length))
    assert [bar.get_xlim() for bar in bars] == [(0, longest)] * 2, "one colour is one length"
    (mark,) = [line.get_xdata()[0] for bar in bars for line in bar.lines]
    assert mark == float(min(seen.length, swept.length))
    for suffix, magic in some(((".svg", b"<?xml"), (".pdf", b"%PDF"), (".png", b"\x89PNG")), 1):
        paths = [tmp_path / f"{name}{suffix}" for name in "ab"]
        for path in paths:
            save_side_by_side([seen, swept], path)
        first, second = (path.read_bytes() for path in paths)
        assert first.startswith(magic)
        assert first == second
    with pytest.raises(FormatError, match="must end in"):
        save_side_by_side([seen, swept], tmp_path / "pair.gif")


def test_far_and_tiny_scenes_are_refused_in_words() -> None:
    with pytest.raises(FormatError, match="too small to be drawn"):
        figure(Scene([Circle((10**30, 0), 1)]))
    with pytest.raises((FormatError, InvalidScene)):
        figure(Scene([Circle((10**400, 0), 1)]))


@pytest.mark.parametrize("power", [-60, 60])
def test_numbers_at_ticks_are_short_whatever_the_unit_is(power: int) -> None:
    unit = fmpq(10) ** power
    drawn = figure(Scene([Circle((5 * unit, 0), unit)], (0, 0), radius=9 * unit))
    drawn.canvas.draw()
    axes = drawn.axes[0]
    labels = [label.get_text() for label in (*axes.get_xticklabels(), *axes.get_yticklabels())]
    assert max(map(len, labels)) < 6
    assert "1e" in axes.xaxis.get_offset_text().get_text()


def test_a_title_is_no_wider_than_its_page() -> None:
    run = gallery_run("tight-l3")
    leave = next(event for event in run.events if event.kind is EventKind.LEAVE)
    drawn = figure(run, leave)
    drawn.canvas.draw()
    told = drawn.texts[1]
    assert told.get_window_extent().width < drawn.bbox.width
    assert told.get_text() == "after ≈ 14.20286 of ≈ 30.292123,  1 of 1 obstacle acquired"


def test_tiny_scenes_are_not_distorted() -> None:
    unit = fmpq(10) ** -60
    scene = Scene([Circle((5 * unit, 0), unit)], (0, 0), radius=9 * unit)
    way = shortest_path(scene, (0, 0), (9 * unit, unit))
    for page in (figure(way), figure(scene, ax=Figure().add_subplot())):
        page.draw_without_rendering()
        axes = page.axes[0]
        across, up = (axes.transData.transform((float(x), float(y))) for x, y in ((unit, 0), (0, unit)))
        start = axes.transData.transform((0, 0))
        assert (across - start)[0] == pytest.approx((up - start)[1], rel=1e-3)
    assert figure(way).axes[0].get_title() == "length ≈ 9.10034e-60"
