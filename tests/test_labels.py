"""Labels of figures: they keep apart, say what the table says, and can be left out; drawings in own axes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from random import Random
from xml.etree import ElementTree

import matplotlib.pyplot as plt
import numpy as np
import pytest
from gallery_runs import gallery_run
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox
from nightly import some

import exactacq as xa
from exactacq import FormatError, cli
from exactacq.files.octagons import random_octagons
from exactacq.output.figures import labels
from exactacq.output.figures.drawing_figure import drawing
from exactacq.output.figures.labels import FAR, GAP, SPACE, LabelRoom, around, extent, fitted, width
from exactacq.output.vocabulary import Labels
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Polygon

SHARE = 0.12
"""Of the smaller one of two labels' boxes so much may be common: they have room for letters like g, too."""


def boxes(drawn: Figure) -> list[tuple[str, Bbox]]:
    drawn.canvas.draw()
    return [(text.get_text(), text.get_window_extent()) for text in drawn.axes[0].texts]


def share(one: Bbox, other: Bbox) -> float:
    common = Bbox.intersection(one, other)
    least = min(box.width * box.height for box in (one, other))
    return 0.0 if common is None else float(common.width * common.height / least)


def board() -> Scene:
    """93 round holes in rows in a board."""
    holes = [Circle((10 * i + 5 * (j % 2) + 8, 12 * j + 8), "1.2") for j in range(8) for i in range(12)]
    wall = Polygon([(0, 0), (130, 0), (130, 100), (0, 100)])
    return Scene(holes[:93], (2, 2), radius=30, enclosure=wall)


def dense_scenes() -> Iterator[Scene]:
    yield random_octagons(100, 1)
    yield board()
    yield xa.load("tests/data/turtlebot3.yaml", start=(0, "0.5"))
    yield row()


def row() -> Scene:
    """Small triangles in a row, with names that are far wider than they are."""
    names = {k: f"a name of size {k}" for k in range(0, 60, 2)}
    return Scene([Polygon([(k, 0), (k + 1, 0), (k, 1)], name=name) for k, name in names.items()])


@pytest.mark.parametrize("scene", list(dense_scenes()), ids=["octagons", "board", "map", "long names"])
def test_labels_of_dense_scenes_keep_apart(scene: Scene) -> None:
    keep_apart(xa.figure(scene))


@pytest.mark.parametrize("name", some(["plate", "figure2", "m9", "figure4", "figure3", "case3"], 2))
def test_labels_of_runs_keep_apart(name: str) -> None:
    run = gallery_run(name)
    keep_apart(xa.figure(run))
    keep_apart(xa.figure(run, at=run.near(float(run.length) / 3)))


def keep_apart(drawn: Figure) -> None:
    found = boxes(drawn)
    window = drawn.axes[0].get_window_extent()
    for k, (word, box) in enumerate(found):
        assert window.padded(1).contains(box.x0, box.y0) and window.padded(1).contains(box.x1, box.y1), word
        for other, place in found[:k]:
            assert share(box, place) <= SHARE, (word, other)


def test_all_labels_of_a_hundred_octagons_are_there() -> None:
    drawn = xa.figure(random_octagons(100, 1))
    assert {f"O{k}" for k in range(1, 101)} <= {word for word, _ in boxes(drawn)}
    assert not any("left out" in text.get_text() for text in drawn.legends[0].get_texts())


def test_what_finds_no_room_is_counted() -> None:
    grid = [Circle((x, y), "0.1") for x in range(18) for y in range(18)]
    drawn = xa.figure(Scene(grid, start=(-1, 0), radius=3))
    shown = sum(word.startswith("O") for word, _ in boxes(drawn))
    (told,) = [t.get_text() for t in drawn.legends[0].get_texts() if "left out" in t.get_text()]
    assert shown + int(told.split()[0]) == 324


def test_far_labels_have_leader_lines() -> None:
    drawn = xa.figure(row())
    leaders = [line for line in drawn.axes[0].lines if line.get_zorder() == 5.5]
    assert leaders
    for line in leaders:
        start, end = drawn.axes[0].transData.transform(line.get_xydata()) * 72 / drawn.dpi
        assert np.hypot(*(end - start)) <= FAR + 3


@pytest.mark.parametrize(
    ("labels", "present", "absent"),
    some(
        [
            ("names", {"O1", "O2", "S", "T"}, {"#1", "#2"}),
            ("all", {"O1", "#1", "S", "T"}, set()),
            ("numbers", {"#1", "#2", "S", "T"}, {"O1", "O2"}),
            ("none", set(), {"O1", "#1", "S", "T", "R = 20"}),
        ],
        2,
    ),
)
def test_labels_can_be_chosen(labels: str, present: set[str], absent: set[str], tmp_path: Path) -> None:
    drawn = xa.figure(gallery_run("circles"), labels=labels)
    shown = {word for word, _ in boxes(drawn)}
    assert present <= shown and absent.isdisjoint(shown)
    legend = [t.get_text() for t in drawn.legends[0].get_texts()]
    assert ("#1, #2, ...: order of visits" in legend) == ("#1" in present)
    assert any(word.startswith("R = 20") for word in [*legend, *shown])
    target = tmp_path / "run.svg"
    assert cli.main(["explore", "circles", "--figure", str(target), "--labels", labels]) == 0
    assert cli.main(["gallery", "circles", "--figure", str(tmp_path / "scene.svg"), "--labels", labels]) == 0


def test_a_name_with_two_dollar_signs_is_no_formula() -> None:
    drawn = xa.figure(Scene([Circle((0, 0), 3, name="pin $1_$2")], (9, 9), radius=5))
    assert "pin $1_$2" in [text for text, _ in boxes(drawn)]


def test_figures_of_names_with_control_characters_are_xml(tmp_path: Path) -> None:
    scene = Scene([Circle((0, 0), 3, name="red\x1b[31m")], (9, 9), radius=5, name="a\x1b scene")
    assert scene.shapes[0].name == "red\x1b[31m"
    drawn = xa.figure(scene)
    drawn.savefig(tmp_path / "f.svg")
    assert "red [31m" in [text for text, _ in boxes(drawn)]
    ElementTree.parse(tmp_path / "f.svg")


@pytest.mark.parametrize("name", ["   ", "\n", "\u200b", "\u202e", "\u2800"])
def test_names_in_which_nothing_is_to_be_seen_are_drawn(name: str) -> None:
    scene = Scene([Circle((0, 0), 3, name=name)], (9, 9), radius=5, name=name)
    assert len(xa.figure(scene).axes[0].texts) == 3


def test_of_an_endless_name_only_what_fits_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(labels, "width", lambda text: width(text) if len(text) <= 400 else pytest.fail())
    assert fitted("endless " * 10**6, 12.0, 300.0).endswith("…")


def test_figures_of_checks_show_short_texts_that_are_xml(tmp_path: Path) -> None:
    scene = Scene([Circle((5, 0), 3)], (0, 0), radius="1/12345678901234567", name="a\x1b long name " * 20)
    xa.write(scene, tmp_path / "scene.json")
    assert cli.main(["check", str(tmp_path / "scene.json"), "--figure", str(tmp_path / "f.svg")]) == 0
    ElementTree.parse(tmp_path / "f.svg")
    page = drawing(xa.inspect(tmp_path / "scene.json"))
    page.canvas.draw()
    title, (legend,) = page.texts[0], page.legends
    assert title.get_window_extent().width < page.bbox.width
    assert [text.get_text() for text in legend.get_texts()] == ["R ≈ 8.1e-17", "start S"]


def test_a_check_of_what_is_lost_in_floating_point_is_not_drawn() -> None:
    far = Scene([Circle((10**30, 0), 1)], (10**30 + 2, 0), radius=1)
    with pytest.raises(FormatError, match="too small to be drawn"):
        drawing(xa.inspect(far))


def test_other_labels_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(FormatError, match="labels: none, numbers, names, all, not"):
        xa.figure(xa.load("circles"), labels="some")
    assert cli.main(["explore", "circles", "--labels", "some"]) == 2
    assert "labels" in capsys.readouterr().err


def test_names_and_numbers_are_those_of_the_table(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["explore", "figure2"]) == 0
    rows = re.findall(r"^(#\d+) +(O\d+) ", capsys.readouterr().out, re.MULTILINE)
    drawn = xa.figure(xa.sightseer(xa.load("figure2"))).axes[0].texts
    words = [text.get_text() for text in drawn]
    pairs = [(words[k + 1], word) for k, word in enumerate(words[:-1]) if word.startswith("O")]
    assert len(rows) == 11 and sorted(rows) == sorted(pairs)


def test_before_a_visit_its_number_is_not_told() -> None:
    run = xa.sightseer(xa.load("circles"))
    words = [text.get_text() for text in xa.figure(run, at=4).axes[0].texts]
    assert {"O1", "O2", "#1"} <= set(words) and "#2" not in words


def test_a_name_that_looks_like_the_order_of_a_visit_is_a_name() -> None:
    scene = Scene([Circle((5, 0), 2, name="#7")], (0, 0), radius=9)
    run = xa.sightseer(scene)
    assert "#7" in [text for text, _ in boxes(xa.figure(run, run.events[0]))]
    assert not any("order" in text.get_text() for text in xa.figure(scene).legends[0].get_texts())


def test_labels_stand_still_from_moment_to_moment() -> None:
    run = xa.sightseer(xa.load("figure2"))
    places = [
        {t.get_text(): t.get_position()[0] for t in xa.figure(run, at=at).axes[0].texts} for at in (10, 60)
    ]
    same = [word for word in places[0] if word.startswith("O") and places[0][word] == places[1].get(word)]
    assert len(same) >= 9


# -- a user's axes ---------------------------------------------------------------------------------


def test_a_figure_is_drawn_into_axes_that_are_there() -> None:
    page, (left, right) = plt.subplots(1, 2, figsize=(11, 5))
    run = xa.sightseer(xa.load("figure2"))
    try:
        assert xa.figure(run, ax=left) is page
        assert xa.figure(run.scene, ax=right, labels="names") is page
        page.canvas.draw()
        assert left.get_title().startswith("Sightseer Strategy: figure2")
        assert {"O1", "#1", "S", "T"} <= {t.get_text() for t in left.texts}
        assert left.get_aspect() == right.get_aspect() == 1.0
        assert "link" in [t.get_text() for t in left.get_legend().get_texts()]
        assert len(page.axes) == 2
        found = [(t.get_text(), t.get_window_extent()) for t in left.texts]
        for k, (word, box) in enumerate(found):
            assert all(share(box, other) <= SHARE for _, other in found[:k]), word
    finally:
        plt.close(page)


# -- progress --------------------------------------------------------------------------------------


def test_progress_grows_to_the_total() -> None:
    run = xa.sightseer(xa.load("figure2"))
    for at in (None, 40):
        told: list[tuple[int, int]] = []
        xa.figure(run, at, progress=lambda done, total, told=told: told.append((done, total)))
        assert len(told) > 11 and told == sorted(set(told)) and told[-1] == (told[0][1],) * 2


# -- the room --------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(8))
def test_boxes_in_a_room_are_disjoint_and_clear_where_they_can_be(seed: int) -> None:
    rng = Random(seed)
    room = LabelRoom(200, 150)
    wall = np.stack((np.full(150, 100.5), np.arange(150) + 0.5), 1)
    room.mark_line(wall)
    placed = [
        room.beside(["O1", "#1"], 8.0, np.array([[rng.uniform(5, 195), rng.uniform(5, 145)]]), 2.0, FAR)
        for _ in range(40)
    ]
    assert sum(p is not None for p in placed) > 25
    boxes = [around(p.middle, extent(["O1", "#1"], p.size)) for p in placed if p is not None]
    for k, one in enumerate(boxes):
        assert one[0] >= 0 and one[2] <= 200 and one[1] >= 0 and one[3] <= 150
        for other in boxes[:k]:
            beside = max(one[0] - other[2], other[0] - one[2])
            assert beside >= SPACE * 8.0 or one[3] <= other[1] or other[3] <= one[1]
    alone = LabelRoom(200, 150)
    alone.mark_line(wall)
    found = alone.beside(["O1"], 8.0, np.array([[100.5, 75.0]]), 2.0, FAR)
    assert found is not None
    box = around(found.middle, extent(["O1"], 8.0))
    assert box[0] >= 100.5 + GAP or box[2] <= 100.5 - GAP, "beside the line, not on it"


def test_no_label_is_placed_where_there_is_no_room() -> None:
    room = LabelRoom(10, 10)
    assert room.beside(["a long word"], 9.0, np.array([[5.0, 5.0]]), 1.0, FAR) is None
    assert room.inside(["a"], (5.0, 5.0), np.array([[4.0, 4.0], [6.0, 4.0], [6.0, 6.0]]), 4.5) is None
    assert list(Labels) == ["none", "numbers", "names", "all"]
