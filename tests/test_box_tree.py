"""The tree that finds boxes near a window."""

from __future__ import annotations

from fractions import Fraction
from math import hypot, inf
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from exactacq.kernel.box_tree import Box, BoxNode, box_tree

SLACK = 1e-12
"""Distances are compared by their squares: this close to the reach either answer is right."""


def some_box(rng: Random) -> Box:
    """Points, squares on a grid, bars, and boxes of sizes over ten decades; some without an end."""
    x, y = (rng.choice([rng.randint(-5, 5), rng.uniform(-1, 1) * 10 ** rng.uniform(-3, 3)]) for _ in "xy")
    w, h = (rng.choice([0, 1, 10 ** rng.uniform(-7, 3)]) for _ in "wh")
    return (-inf, y, inf, 1e308) if rng.random() < 0.02 else (x, y, x + w, y + h)


def gap(a: Box, b: Box) -> float:
    """How far two boxes are apart."""
    x, y = (max(a[k] - b[k + 2], b[k] - a[k + 2], 0) for k in range(2))
    return hypot(x, y)


@given(st.integers(0, 10**6))
def test_what_is_found_is_what_is_near(seed: int) -> None:
    rng = Random(seed)
    boxes = [some_box(rng) for _ in range(rng.randint(1, 300))]
    tree = box_tree(boxes)
    for _ in range(10):
        window = rng.choice([rng.choice(boxes), some_box(rng)])
        if inf in window:
            continue
        reach = rng.choice([0, 1, 2, 10 ** rng.uniform(-3, 3)])
        found = tree.near(window, reach)
        assert found == sorted(set(found))
        gaps = [gap(box, window) for box in boxes]
        assert {k for k, far in enumerate(gaps) if far <= reach * (1 - SLACK)} <= set(found)
        assert all(gaps[k] <= reach * (1 + SLACK) for k in found)


@given(st.integers(0, 10**6))
def test_boxes_in_a_row_that_touch_are_found_in_order(seed: int) -> None:
    """As those of boundaries: chains whose boxes share corners, of any lengths, some alone, anywhere."""
    rng = Random(seed)
    boxes: list[Box] = []
    for _ in range(rng.randint(1, 30)):
        x, y = rng.randint(-20, 20), rng.randint(-20, 20)
        for _ in range(rng.choice([1, 2, 3, 11, 12, 13, 25])):
            u, v = x + rng.randint(-2, 2), y + rng.randint(-2, 2)
            boxes.append((min(x, u), min(y, v), max(x, u), max(y, v)))
            x, y = u, v
    tree = box_tree(boxes)
    for _ in range(10):
        window = rng.choice(boxes)
        reach = rng.choice([0, 1, 2, 5, 60])
        assert tree.near(window, reach) == [k for k, box in enumerate(boxes) if gap(box, window) <= reach]


@given(st.integers(0, 10**6))
def test_what_is_found_along_a_line_is_what_it_may_meet(seed: int) -> None:
    """Exactly: a box that the line meets is found, also where only its corner is on it; few others are."""
    rng = Random(seed)
    boxes = [box for box in (some_box(rng) for _ in range(rng.randint(1, 200))) if inf not in box]
    tree = box_tree(boxes)
    for _ in range(5):
        x, y, *_ = rng.choice([*boxes, some_box(rng)])
        if inf in (abs(x), abs(y)):
            continue
        dx, dy = rng.choice([(1.0, 0.0), (1.0, 1.0), (0.0, -3.0), (rng.uniform(-1, 1), rng.uniform(-1, 1))])
        reach = rng.choice([1, 5, 10 ** rng.uniform(-2, 4)])
        found = tree.along((x, y, dx, dy, 0.0, 0.0), reach, 0.0)
        assert found == sorted(set(found))
        for k, box in enumerate(boxes):
            far = gap(box, (x, y, x, y))
            sides = [
                Fraction(dx) * (Fraction(v) - Fraction(y)) - Fraction(dy) * (Fraction(u) - Fraction(x))
                for u in box[::2]
                for v in box[1::2]
            ]
            is_met = min(sides) <= 0 <= max(sides)
            near = min(map(abs, sides)) <= 1e-12 * (hypot(*box) + hypot(x, y)) * hypot(dx, dy)
            if is_met and far <= reach * (1 - SLACK):
                assert k in found
            if far > reach * (1 + SLACK) or not (is_met or near):
                assert k not in found


def test_what_a_line_with_errors_may_meet_is_found() -> None:
    """The contact and the direction may each be off by what they are held with, and boxes by the slack."""
    unit = box_tree([(10.0, 1.0, 11.0, 2.0)])
    level = 0.0, 0.0, 1.0, 0.0
    assert unit.along((*level, 0.0, 0.0), 20, 0.0) == []
    assert unit.along((*level, 1.0, 0.0), 20, 0.0) == [0]
    assert unit.along((*level, 0.0, 0.1), 20, 0.0) == [0]
    assert unit.along((*level, 0.0, 0.0), 20, 0.5) == [0]
    assert unit.along((*level, 0.0, inf), 20, 0.0) == [0]


def test_an_empty_tree() -> None:
    assert box_tree([]).near((0, 0, 0, 0), 1) == []
    assert box_tree([]).along((0.0, 0.0, 1.0, 0.0, 0.0, 0.0), 1, 0.0) == []


@pytest.mark.parametrize("n", [100, 1000, 10000])
def test_a_search_looks_at_little_else_than_what_it_finds(n: int) -> None:
    """Unit squares that fill a bar: a window that meets few of them meets few groups too."""
    tree = box_tree([(k // 10, k % 10, k // 10 + 1, k % 10 + 1) for k in range(n)])
    window = 3.5, 3.5, 5.5, 5.5
    assert len(tree.near(window, 0)) == 9
    assert looked_at(tree, window) < 300


def looked_at(node: BoxNode, window: Box) -> int:
    """How many boxes a search compares with a window."""
    around = node.x0, node.y0, node.x1, node.y1
    if gap(around, window) > 0:
        return 1
    return 1 + sum(looked_at(one, window) for one in node.group)
