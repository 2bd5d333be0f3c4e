"""What a file holds before anything is decided, and what a refused scene is told to be cured by."""

from __future__ import annotations

import json
from pathlib import Path

import ezdxf
import pytest
import shapely

import exactacq as xa
from exactacq.files.by_suffix import contents_of
from exactacq.geometry.intersections import ContactKind
from exactacq.scene.scene import Obstacle, Scene
from exactacq.scene.validation import violations


def frame_and_holes(path: Path) -> Path:
    """A frame, a square that crosses it, and two that lie in it and overlap."""
    document = ezdxf.new()
    for x, y, size in ((0, 0, 100), (90, 10, 20), (20, 20, 10), (25, 25, 10)):
        corners = [(x, y), (x + size, y), (x + size, y + size), (x, y + size)]
        document.modelspace().add_lwpolyline(corners, close=True)
    document.saveas(path)
    return path


def test_contents_know_no_start_and_nothing_of_walls(tmp_path: Path) -> None:
    contents = contents_of(frame_and_holes(tmp_path / "d.dxf"), None, {})
    assert len(contents.loops) == 4 and contents.wall is None and contents.edges == 16
    with pytest.raises(xa.FormatError, match="--start X,Y"):
        contents.scene()


@pytest.mark.parametrize(
    ("start", "options", "cure"),
    [
        ((5, 5), {}, "with --union it is a scene"),
        ((5, 5), {"union": True}, None),
        ((5, 5), {"outer": "drop"}, "with --union it is a scene"),
        ((-5, 5), {}, "with --union it is a scene"),
    ],
)
def test_what_is_said_to_cure_a_scene_does(
    tmp_path: Path, start: tuple[int, int], options: dict[str, object], cure: str | None
) -> None:
    path = frame_and_holes(tmp_path / "d.dxf")
    if cure is None:
        assert isinstance(xa.load(path, start=start, **options), Scene)
        return
    with pytest.raises(xa.InvalidScene, match=cure):
        xa.load(path, start=start, **options)


def test_a_frame_that_is_crossed_may_be_dropped(tmp_path: Path) -> None:
    """An obstacle that the robot's start is not near crosses the frame, and a union would part the room."""
    document = ezdxf.new()
    for corners in (
        [(0, 0), (100, 0), (100, 100), (0, 100)],
        [(-5, 40), (105, 40), (105, 60), (50, 70), (-5, 60)],
    ):
        document.modelspace().add_lwpolyline(corners, close=True)
    document.saveas(tmp_path / "d.dxf")
    with pytest.raises(xa.InvalidScene, match="with --outer drop it is a scene"):
        xa.load(tmp_path / "d.dxf", start=(5, 5))
    assert xa.load(tmp_path / "d.dxf", start=(5, 5), outer="drop").enclosure is None


def test_only_options_of_the_format_are_named(tmp_path: Path) -> None:
    boxes = [shapely.box(0, 0, 2, 2), shapely.box(1, 1, 3, 3)]
    both = shapely.GeometryCollection(boxes)
    with pytest.raises(xa.InvalidScene, match="with --union it is a scene"):
        xa.load(both)
    told = {"obstacles": [{"boundary": [list(p) for p in box.exterior.coords]} for box in boxes]}
    (tmp_path / "s.json").write_text(json.dumps(told))
    with pytest.raises(
        xa.InvalidScene,
        match="move the shapes apart in the file; of formats",
    ):
        xa.load(tmp_path / "s.json")


def test_violations_know_their_loops_places_and_kinds() -> None:
    boxes = [(0, 0, 10, 10), (5, 5, 15, 15), (20, 0, 30, 9), (22, 2, 24, 4), (30, 2, 31, 3)]
    loops = [Obstacle.of(k, xa.Polygon(shapely.box(*box))) for k, box in enumerate(boxes)]
    nested, strict = violations(loops, nested=True), violations(loops)
    crossing = [v for v in nested if v.kind is ContactKind.CROSSING]
    assert {v.loops for v in crossing} == {(0, 1)}
    assert {p.xy for v in crossing for p in v.places} == {(10, 5), (5, 10)}
    (overlap,) = (v for v in nested if v.kind is ContactKind.OVERLAP)
    assert overlap.loops == (2, 4) and {p.xy for p in overlap.places} == {(30, 2), (30, 3)}
    (inside,) = (v for v in strict if v not in nested)
    assert inside.loops == (3, 2) and "O4 lies inside obstacle O3" in str(inside)
    with pytest.raises(xa.InvalidScene) as refused:
        xa.Scene([loop.shape for loop in loops])
    assert refused.value.violations == tuple(map(str, strict))
