"""What the window shows: labels that leave each other room."""

from __future__ import annotations

import json
from typing import Any

import pytest
from board_page import SHAPES, drop, point, show
from chromium import Chromium

LABELS = "[...document.querySelectorAll('#labels text')].map((t) => t.textContent)"
LABEL_BOXES = (
    "[...document.querySelectorAll('#labels text')].map((t) => "
    "(({ x, y, width, height }) => [x, y + 3, x + width, y + height - 3])(t.getBBox()))"
)
SHAPE = "document.querySelectorAll('#shapes path')[{}]"


def crowd(columns: int, rows: int) -> str:
    """A scene file: obstacles in rows, some with long names."""
    obstacles: list[dict[str, Any]] = [
        {
            **({"name": f"pillar number {k}"} if k % 3 == 0 else {}),
            "circle": {"center": [3 * (k % columns), 3 * (k // columns)], "radius": "1" if k % 2 else "1/4"},
        }
        for k in range(columns * rows)
    ]
    return json.dumps({"start": [-3, -3], "radius": 5, "obstacles": obstacles})


def drawn(page: Chromium, text: str, count: int) -> None:
    """Open a file of so many shapes."""
    drop(page, "crowd.json", text)
    page.until(f"{SHAPES} === {count} && !document.querySelector('dialog[open]')", 30)


def labels_are_apart(page: Chromium) -> bool:
    boxes = page.run(LABEL_BOXES)
    return not any(
        a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]
        for k, a in enumerate(boxes)
        for b in boxes[:k]
    )


@pytest.mark.parametrize("width", [360, 1400])
def test_labels_do_not_cover_each_other(page: Chromium, address: str, width: int) -> None:
    show(page, address, width, 800)
    drawn(page, crowd(14, 9), 126)
    assert 0 < len(page.run(LABELS)) < 126
    for _ in range(10):
        page.run("document.querySelector('[data-action=larger]').click()")
        assert labels_are_apart(page)


def test_labels_that_have_room_are_all_there(page: Chromium) -> None:
    for name, count in (("circles", 2), ("figure2", 11)):
        page.run(f"document.querySelector('[data-example={name}]').click()")
        page.until(f"{SHAPES} === {count}", 30)
        assert len(page.run(LABELS)) == count and labels_are_apart(page)


def test_what_is_pointed_at_or_selected_has_its_label(page: Chromium) -> None:
    drawn(page, crowd(14, 9), 126)
    hidden = 66
    name = f"pillar number {hidden}"
    assert name not in page.run(LABELS)
    box = page.run(
        "(({ x, y, width, height }) => [x + width / 2, y + height / 2])"
        f"({SHAPE.format(hidden)}.getBoundingClientRect())"
    )
    point(page, "mouseMoved", *box)
    assert name in page.run(LABELS) and labels_are_apart(page)
    point(page, "mouseMoved", box[0] + 9, box[1] + 9)
    page.until(f"!{LABELS}.includes({json.dumps(name)})")
    page.run(f"document.querySelectorAll('[data-pick]')[{hidden}].focus()")
    page.until(f"{LABELS}.includes({json.dumps(name)})")
    page.run("document.activeElement.blur()")
    page.until(f"!{LABELS}.includes({json.dumps(name)})")
    page.run(f"document.querySelectorAll('[data-pick]')[{hidden}].click()")
    page.until(f"{LABELS}.includes({json.dumps(name)})")
