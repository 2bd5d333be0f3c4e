"""Boards of KiCad: their edges, exact arcs, placed footprints, and broken files."""

from __future__ import annotations

from pathlib import Path

import pytest

import exactacq as xa
from exactacq.files import kicad

LINE = "(start 0 0) (end 4 0)"
BOARD = Path(__file__).parent / "data" / "board.kicad_pcb"
INSIDE = (105, -45)


def read(folder: Path, content: str, **options: object) -> xa.Scene:
    path = folder / "board.kicad_pcb"
    path.write_text(f"(kicad_pcb (version 1) {content})")
    return xa.load(path, start=(1000, 1000), **options)


def edge(kind: str, content: str, layer: str = "Edge.Cuts") -> str:
    return f'({kind} {content} (layer "{layer}"))'


def areas(scene: xa.Scene) -> list[str]:
    return [str(obstacle.area) for obstacle in scene.obstacles]


def test_a_board_is_a_room_with_its_cut_outs() -> None:
    scene = xa.load(BOARD, start=INSIDE)
    assert scene.enclosure is not None
    assert len(scene.enclosure.vertices) == 8
    assert sorted(areas(scene)[:-1]) == sorted(["4*pi + 24", "8", "4*pi", "2*pi", "25", "2*pi + 20"])
    assert float(scene.obstacles[-1].area) == pytest.approx(60 * 30 - (4 - 3.14159265) * 4, abs=1e-4)
    assert scene.notes == ("rotated footprints by rational rotations, off by at most 1.7e-16 radians",)
    run = xa.sightseer(scene, 30)
    assert len(run.visits) >= 6
    xa.audit(run)


def test_arcs_are_kept_exactly() -> None:
    """The corners' middles are rounded to six decimals: the circle through the three points is taken."""
    scene = xa.load(BOARD, start=INSIDE)
    arcs = [e for e in scene.obstacles[-1].edges if isinstance(e, xa.Arc)]
    middles = [
        (x, -y) for x in ("100.585786", "159.414214") for y in (xa.Real("40.585786"), xa.Real("69.414214"))
    ]
    assert all(sum(arc.passes(xa.Point(*middle)) for arc in arcs) == 1 for middle in middles)


def test_footprints_are_placed_and_turned_as_seen() -> None:
    """90 degrees turn the slot upright; its place is (110, 55), with y going up (110, -55)."""
    slot = xa.load(BOARD, start=INSIDE).obstacles[0]
    assert {(e.start.x, e.start.y) for e in slot.edges} == {(108, -58), (108, -52), (112, -52), (112, -58)}


def test_other_layers() -> None:
    scene = xa.load(BOARD, start=(0, 0), layers="F.CrtYd")
    assert scene.shapes == (xa.Circle((110, -55), 9, "fp_circle 6"),)
    with pytest.raises(xa.FormatError, match=r"no layer 'Roof'; it has 'Edge.Cuts' \(\d+\), "):
        xa.load(BOARD, start=(0, 0), layers=["Roof"])


@pytest.mark.parametrize(
    ("content", "area"),
    [
        (edge("gr_arc", "(start 0 0) (mid 2 0) (end 0 0)"), "pi"),
        (edge("gr_circle", "(center 0 0) (end 1 1)"), "2*pi"),
        (edge("gr_poly", "(pts (xy 0 0) (xy 1 0) (xy 1 1))"), "1/2"),
        (
            edge("gr_line", "(start 0 0) (end 4 0)") + edge("gr_arc", "(start 4 0) (mid 2 2) (end 0 0)"),
            "2*pi",
        ),
        (edge("gr_rect", "(start 0 0) (end 4 2)") + edge("gr_curve", "(pts (xy 0 0))"), "8"),
    ],
)
def test_kinds_of_edges(tmp_path: Path, content: str, area: str) -> None:
    assert areas(read(tmp_path, content)) == [area]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "nothing to read"),
        (edge("gr_line", "(start 0 0)"), "gr_line 1: it has no end"),
        (edge("gr_line", "(start 0 0) (end 1)"), "gr_line 1: end: two numbers are needed, not 1"),
        (edge("gr_line", "(start 0 0) (end 1 x)"), "gr_line 1: not a number: 'x'"),
        (edge("gr_line", "(start 0 0) (end 1 (1))"), "gr_line 1: not a number"),
        (edge("gr_arc", "(start 0 0) (end 1 1) (angle 90)"), "an arc without a middle"),
        (edge("gr_arc", "(start 0 0) (mid 3 3) (end 1 1)"), "the third point lies on the line"),
        (edge("gr_line", "(start 0 0) (end 1 1)"), "no closed loop"),
        ('(footprint "F" (at 1))', "footprint F: at: two or three numbers"),
        ('(footprint "F" (at 1 2 x))', "footprint F: not a number: 'x'"),
        (")", "line 1: the lists do not end well|a parenthesis too many"),
        ("(", "the lists do not end well"),
        ('"', "the lists do not end well"),
        ("(" * 5000, "nested more than 64 deep"),
    ],
)
def test_broken_boards_are_one_line(tmp_path: Path, content: str, message: str) -> None:
    with pytest.raises(xa.FormatError, match=message) as caught:
        read(tmp_path, content)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400


def test_words_are_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kicad, "MAX_TOKENS", 1000)
    with pytest.raises(xa.FormatError, match="more than 1000 words"):
        read(tmp_path, "a " * 1100)


def test_files_that_are_no_boards(tmp_path: Path) -> None:
    path = tmp_path / "board.kicad_pcb"
    for text, message in (
        ("(kicad_sch)", "not a board"),
        ("word", "do not end well"),
        ("() ()", "do not end well"),
    ):
        path.write_text(text)
        with pytest.raises(xa.FormatError, match=message):
            xa.load(path)
