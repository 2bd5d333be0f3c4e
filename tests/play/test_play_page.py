"""The page in a browser: drawn in by mouse and keys, run, scrubbed, stopped, saved; by night, on a phone."""

from __future__ import annotations

import json
import time
from pathlib import Path

from board_page import SHAPES, WATCHES, click, key, show, square
from chromium import Chromium
from nightly import by_night

from exactacq.play.scenes import STRATEGIES

CHOOSE = (
    "(() => {{ const s = document.getElementById('strategy'); s.value = '{}'; "
    "s.dispatchEvent(new Event('change', {{ bubbles: true }})); }})()"
)


def test_a_square_is_drawn_run_scrubbed_and_saved(page: Chromium, tmp_path: Path) -> None:
    page.send("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    square(page)
    page.click("#undo")
    page.until(f"{SHAPES} === 0")
    page.click("#redo")
    page.until(f"{SHAPES} === 1")
    page.click("#mode")
    page.until(WATCHES, 60)
    assert page.run("document.querySelectorAll('#list button').length") > 3
    page.run(
        "(() => { const s = document.getElementById('slider'); s.value = s.max / 2; "
        "s.dispatchEvent(new Event('input', { bubbles: true })); })()"
    )
    assert page.run("document.getElementById('length').textContent").startswith("≈")
    page.press("End")
    whole = page.run("document.getElementById('whole').textContent")
    assert page.run("document.getElementById('length').textContent").startswith(whole)
    for kind, ending in (("scene", ".json"), ("figure", ".svg")):
        page.run(f"document.querySelector('[data-save={kind}]').click()")
        end = time.monotonic() + 30
        while not [path for path in tmp_path.iterdir() if path.suffix == ending]:
            page.run("0")
            assert time.monotonic() < end
            time.sleep(0.05)
    (saved,) = tmp_path.glob("*.json")
    (boundary,) = [shape["boundary"] for shape in json.loads(saved.read_text())["obstacles"]]
    assert len(boundary) == 4 and all(isinstance(number, int) for row in boundary for number in row)
    page.press("Escape")
    page.until("document.body.dataset.mode === 'draw'")


def test_the_terrain_moves_the_start_of_a_sweep_only(page: Chromium) -> None:
    square(page)
    page.click("[data-tool=terrain]")
    click(page, 300, 600)
    click(page, 800, 150)
    place = "document.getElementById('beginning').getAttribute('transform')"
    page.run(CHOOSE.format("sightseer"))
    own = page.run(place)
    page.run(CHOOSE.format("seed-spreader"))
    assert page.run(place) != own
    page.run(CHOOSE.format("nearest-frontier"))
    assert page.run(place) == own
    page.click("[data-tool=start]")
    click(page, 500, 500)
    assert (
        page.run(place) != own and page.run("document.getElementById('strategy').value") == "nearest-frontier"
    )


def test_what_is_broken_is_told_beside_the_shapes(page: Chromium) -> None:
    square(page)
    page.click("[data-tool=circle]")
    click(page, 720, 260)
    click(page, 760, 260)
    page.until("document.querySelectorAll('#marks circle').length > 0", 30)
    assert "disjoint" in page.run("document.querySelector('#callouts p').textContent")
    page.click("#mode")
    assert page.run("document.getElementById('trouble').hidden") is False
    assert page.run("document.body.dataset.mode") == "draw"


def test_every_strategy_is_offered_with_what_it_does(page: Chromium) -> None:
    offered = page.run("[...document.getElementById('strategy').options].map((o) => o.value)")
    assert offered == list(STRATEGIES)
    told = set()
    for name in offered:
        page.run(CHOOSE.format(name))
        told.add(page.run("document.getElementById('strategy-told').textContent"))
    assert len(told) == len(offered) and "" not in told


@by_night
def test_a_run_without_bounds_says_so_and_tells_its_reasons(page: Chromium) -> None:
    page.run("document.querySelector('[data-example=circles]').click()")
    page.until(f"{SHAPES} === 2", 30)
    page.run(CHOOSE.format("nearest-frontier"))
    page.click("#mode")
    page.until(WATCHES, 60)
    assert page.run("document.getElementById('summary').textContent").startswith("2 of 2 obstacles acquired")
    assert page.run("document.getElementById('boundless').hidden") is False
    page.press("Home")
    assert page.run("document.getElementById('why').textContent").startswith(
        "to the nearest frontier by path"
    )
    page.run(CHOOSE.format("sightseer"))
    page.until("document.getElementById('outcome-title').textContent === 'Sightseer Strategy'", 60)
    page.until(WATCHES, 60)
    assert page.run("document.getElementById('verdicts').textContent") == ": 4 of 4 hold"
    assert page.run("document.getElementById('boundless').hidden") is True


def test_an_example_is_watched_by_one_click(page: Chromium) -> None:
    page.click("#welcome [data-watch]")
    page.until("document.body.dataset.busy === 'run' || document.body.dataset.mode === 'watch'", 30)
    page.run("document.getElementById('stop').click()")
    page.until("!document.body.dataset.busy", 30)


def test_a_run_is_stopped(page: Chromium) -> None:
    page.click("[data-example=plate]")
    page.until(f"{SHAPES} > 10", 30)
    page.click("#mode")
    page.until("document.body.dataset.busy === 'run'")
    page.run("document.getElementById('stop').click()")
    page.until("!document.body.dataset.busy")


def test_the_keyboard_alone_draws_and_runs(page: Chromium) -> None:
    page.run("document.getElementById('board').focus()")
    key(
        page,
        "p",
        *["ArrowRight"] * 3,
        "Enter",
        "ArrowRight",
        "ArrowRight",
        "Enter",
        "ArrowUp",
        "Enter",
        "Enter",
    )
    page.until(f"{SHAPES} === 1 && document.getElementById('verdict').dataset.ok === 'true'", 30)
    assert page.run("getComputedStyle(document.getElementById('board')).outlineStyle") == "solid"
    page.send(
        "Input.dispatchKeyEvent",
        type="rawKeyDown",
        key="Enter",
        code="Enter",
        modifiers=2,
        windowsVirtualKeyCode=13,
    )
    page.until(WATCHES, 60)
    assert page.run(
        "[...document.querySelectorAll('button, input, select')].every((e) => (e.getAttribute('aria-label') "
        "|| e.closest('label')?.textContent || e.textContent).trim())"
    )


def test_by_night_it_is_dark(browser: Chromium, address: str) -> None:
    show(browser, address, scheme="dark")
    light, dark = browser.run(
        "[getComputedStyle(document.body).color, getComputedStyle(document.body).backgroundColor]"
        ".map((c) => c.match(/\\d+/g).map(Number).reduce((a, b) => a + b))"
    )
    assert dark < 120 and light > 600


def test_a_phone_scrolls_up_and_down_only(browser: Chromium, address: str) -> None:
    show(browser, address, 360, 740)
    assert browser.run("document.documentElement.scrollWidth") <= 360
    browser.run("document.querySelector('[data-example=circles]').click()")
    browser.until(f"{SHAPES} === 2", 30)
    browser.click("#mode")
    browser.until(WATCHES, 60)
    assert browser.run("document.documentElement.scrollWidth") <= 360


def test_the_welcome_goes_when_anything_is_done(page: Chromium) -> None:
    hidden = "document.getElementById('welcome').hidden"
    assert page.run(hidden) is False
    inside = (
        "(() => { const a = document.getElementById('reach').getBoundingClientRect(); "
        "const b = document.getElementById('show').getBoundingClientRect(); "
        "return a.top > b.top && a.bottom < b.bottom && a.left > b.left && a.right < b.right; })()"
    )
    assert page.run(inside), "all that the robot can see is in the window"
    page.click("[data-tool=terrain]")
    for x, y in ((300, 200), (700, 500)):
        click(page, x, y)
    page.until("document.querySelector('[data-tool=select]').ariaPressed === 'true'")
    assert page.run(hidden) is True
    assert page.run("getComputedStyle(document.getElementById('board')).outlineStyle") == "none"
    page.click("[data-action=fresh]")
    page.until(f"!{hidden}")
    page.run("document.querySelector('[data-example=circles]').click()")
    page.until(f"{SHAPES} === 2", 30)
    assert page.run(hidden) is True
