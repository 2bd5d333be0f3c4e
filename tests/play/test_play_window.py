"""What the window shows: labels that leave each other room, everything at any size; and how it is left."""

from __future__ import annotations

import json
from typing import Any

import pytest
from board_page import SHAPES, WATCHES, drop, point, show, square
from chromium import Chromium

LABELS = "[...document.querySelectorAll('#labels text')].map((t) => t.textContent)"
LABEL_BOXES = (
    "[...document.querySelectorAll('#labels text')].map((t) => "
    "(({ x, y, width, height }) => [x, y + 3, x + width, y + height - 3])(t.getBBox()))"
)
SHOWN = (
    "[...document.querySelectorAll('#shapes path:not(.wall)')].every((p) => { "
    "const a = p.getBoundingClientRect(); "
    "const b = document.getElementById('show').getBoundingClientRect(); "
    "return a.left >= b.left && a.right <= b.right && a.top >= b.top && a.bottom <= b.bottom; })"
)
"""Whether no shape is cut off."""
WIDEST = (
    "(() => { const all = [...document.querySelectorAll('#shapes path:not(.wall)')].map((p) => "
    "p.getBoundingClientRect()); "
    "return Math.max(...all.map((b) => b.right)) - Math.min(...all.map((b) => b.left)); })()"
)
"""How wide the drawing is on the screen."""
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


def test_a_narrower_window_cuts_nothing_off(page: Chromium) -> None:
    drawn(page, crowd(5, 2), 10)
    wide = page.run(WIDEST)
    for width, height in ((900, 800), (600, 500), (360, 740), (1280, 800)):
        page.resize(width, height)
        page.until(SHOWN)
    page.until(f"Math.abs({WIDEST} - {wide}) < 1")
    page.run("document.querySelector('[data-example=circles]').click()")
    page.until(f"{SHAPES} === 2", 30)
    page.click("#mode")
    page.until(WATCHES, 90)
    page.resize(700, 600)
    page.until("document.getElementById('show').getBoundingClientRect().right <= 700")
    page.run("document.getElementById('mode').click()")
    page.until(SHOWN)


def test_a_window_that_was_zoomed_stays_as_it_was(page: Chromium) -> None:
    square(page)
    page.run("document.querySelector('[data-action=larger]').click()")
    place = f"(({{ x, y, width }}) => [x, y, width])({SHAPE.format(0)}.getBoundingClientRect())"
    was = page.run(place)
    page.resize(1000, 700)
    page.until("document.getElementById('show').getBoundingClientRect().right <= 1000")
    assert page.run(place) == pytest.approx(was, abs=0.1)
    page.run("document.querySelector('[data-action=fit]').click()")
    page.resize(360, 700)
    page.until(SHOWN)


def test_what_is_drawn_after_that_stays_in_the_window_too(page: Chromium) -> None:
    square(page)
    page.resize(420, 760)
    page.until(SHOWN)


def asks(page: Chromium, address: str) -> bool:
    """Whether the page asks before it is left."""
    page.asked.clear()
    page.send("Page.navigate", url="about:blank")
    page.until("location.href === 'about:blank'")
    found = page.asked == ["beforeunload"]
    assert found or not page.asked
    show(page, address)
    return found


def test_leaving_asks_only_for_what_is_not_saved(page: Chromium, address: str, tmp_path: Any) -> None:
    page.send("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    assert not asks(page, address)
    square(page)
    assert asks(page, address)
    square(page)
    page.click("#undo")
    page.until(f"{SHAPES} === 0")
    assert not asks(page, address)
    page.run("document.querySelector('[data-example=circles]').click()")
    page.until(f"{SHAPES} === 2", 30)
    page.click("#board")
    assert not asks(page, address), "a file was opened, no more"
    page.run("document.querySelector('[data-example=circles]').click()")
    page.until(f"{SHAPES} === 2", 30)
    page.run(
        "(() => { const r = document.getElementById('range'); r.value = '7'; "
        "r.dispatchEvent(new Event('change', { bubbles: true })); })()"
    )
    page.click("#board")
    assert asks(page, address)
    square(page)
    assert page.run("document.title").startswith("* ")
    page.run("document.querySelector('[data-save=scene]').click()")
    page.until("document.body.dataset.busy === undefined && !document.querySelector('#save').open")
    page.until("!document.title.startsWith('* ')")
    assert not asks(page, address)
