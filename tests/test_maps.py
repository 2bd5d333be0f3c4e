"""What maps of a run answer to questions that make no sense."""

from __future__ import annotations

from collections.abc import Callable

import pytest

import exactacq as xa
from exactacq.sensing.map import Map

QUESTIONS: list[Callable[[Map, object], object]] = [
    lambda known, i: known.known(i),
    lambda known, i: known.known_length(i),
    lambda known, i: known.is_incomplete(i),
    lambda known, i: known.knows(i, (7, 0)),
    lambda known, i: known.beside(i, xa.Point(7, 0)),
    lambda known, i: known.spots(i, xa.Point(7, 0)),
    lambda known, i: known.spots_on(i, xa.Point(7, 0), (0,)),
]


@pytest.mark.parametrize("i", [-1, 2, "O1", 0.5])
def test_a_map_names_the_numbers_of_its_obstacles_where_one_is_wrong(i: object) -> None:
    """-1 told of nothing known, or of the last obstacle, and 2 ended in an error without words."""
    known = xa.sightseer(xa.load("circles")).map
    for question in QUESTIONS:
        with pytest.raises(ValueError, match="this map has 2, numbered from 0"):
            question(known, i)


def test_the_map_of_an_empty_scene_has_no_obstacle() -> None:
    known = xa.sightseer(xa.Scene([], start=(0, 0), radius=1)).map
    assert (known.seen, known.known_length()) == ((), xa.Length(0))
    with pytest.raises(ValueError, match="no obstacle 0: this map has 0"):
        known.known(0)


@pytest.mark.parametrize(
    "shape",
    [
        xa.Circle((3, 0), 1),
        xa.Outline([(2, 0, xa.Around((3, 0))), (4, 0, xa.Around((3, 0)))]),
        xa.Polygon([(2, 0), (3, -1), (4, 0), (3, 1)]),
    ],
    ids=["inside an edge", "at a joint", "at a corner"],
)
def test_a_single_known_point_is_one_end(shape: xa.Circle | xa.Outline | xa.Polygon) -> None:
    """It was two where two edges meet: each of them knows it."""
    robot = xa.Robot(xa.Scene([shape], start=(0, -3), radius=2))
    robot.go_to((0, 3))
    assert robot.map.frontier == ((0, xa.Point(2, 0)),)
    assert len(robot.map.known(0)) == 1
