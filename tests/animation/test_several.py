"""The page that plays several runs side by side: one clock, one scale, and each run as it is alone."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from chromium import Chromium, binary
from pages import HOSTILE, encoded, frames_of

import exactacq as xa
from exactacq.output.animation.several import page_of_runs
from exactacq.strategies.run import Run

SHADOWS = "[...document.querySelectorAll('.run')].map((host) => host.shadowRoot)"


def touch(robot: xa.Robot) -> None:
    robot.go_to(robot.map.nearest(0, robot.position))


@pytest.fixture(scope="module")
def runs() -> list[Run]:
    """Paths of three lengths; one begins elsewhere, one is short."""
    scene = xa.load("circles").replace(terrain=xa.Terrain(18, 8, origin=(-1, -4)), name=HOSTILE[0])
    return [xa.sightseer(scene), xa.seed_spreader(scene.replace(start=(-1, -4))), xa.explore(scene, touch)]


def text_of(runs: list[Run]) -> str:
    return page_of_runs(runs, map(frames_of, runs))


@pytest.fixture(scope="module")
def data(runs: list[Run]) -> dict[str, Any]:
    (block,) = re.findall(r'<script type="application/json" id="data">(.*)</script>', text_of(runs))
    return json.loads(block)


@pytest.fixture(scope="module")
def browser() -> Iterator[Chromium]:
    if binary() is None:
        pytest.skip("no Chromium or Chrome is installed")
    with Chromium() as running:
        yield running


@pytest.fixture(scope="module")
def opened(browser: Chromium, runs: list[Run], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("pages") / "runs.html"
    path.write_text(text_of(runs), "utf-8")
    return path


def told(browser: Chromium, name: str) -> list[str]:
    return browser.run(f"{SHADOWS}.map((root) => root.getElementById({json.dumps(name)}).textContent)")


def robots(browser: Chromium) -> list[list[float]]:
    return browser.run(
        f"{SHADOWS}.map((root) => root.getElementById('robot')).map((robot) => "
        "['cx', 'cy'].map((name) => Number(robot.getAttribute(name))))"
    )


def slide(browser: Chromium, length: float) -> None:
    browser.run(
        "(() => { const slider = document.getElementById('slider'); "
        f"slider.value = {length!r}; slider.dispatchEvent(new Event('input', {{bubbles: true}})); }})()"
    )


def test_all_runs_have_one_paper(data: dict[str, Any], runs: list[Run]) -> None:
    first, *others = data["runs"]
    for key in ("scale", "corner", "box"):
        assert all(run[key] == first[key] for run in others)
    for run, own in zip(runs, data["runs"], strict=True):
        assert own["path"][-1][0] / first["scale"] == pytest.approx(float(run.length))
    x, y = data["runs"][1]["start"]
    assert 0 <= x <= first["box"][0] and 0 <= y <= first["box"][1]


def test_one_alone_is_as_on_its_own_page(runs: list[Run]) -> None:
    (block,) = re.findall(r'id="data">(.*)</script>', text_of(runs[:1]))
    (alone,) = json.loads(block)["runs"]
    assert alone.pop("strategy") == "Sightseer Strategy"
    assert alone == encoded(runs[0])
    with pytest.raises(ValueError, match="at least one"):
        text_of([])


def test_equal_runs_give_equal_pages_without_code_of_the_user(runs: list[Run]) -> None:
    assert text_of(runs) == text_of(runs)
    before, _, after = re.split(r'(?<=id="data">)(.*)(?=</script>\n<script>)', text_of(runs))
    assert "hacked" not in before + after


def test_it_loads_in_silence(browser: Chromium, opened: Path) -> None:
    browser.open(opened)
    for key in ("End", "Home", "ArrowRight"):
        browser.press(key)
    assert browser.complaints == browser.refused == []
    assert browser.requests == [opened.absolute().as_uri()]
    assert browser.run("window.hacked ?? null") is None
    assert told(browser, "name") == ["Sightseer Strategy", "Seed Spreader Strategy", "Strategy touch"]


def test_the_word_why_is_not_there_alone(browser: Chromium, opened: Path) -> None:
    browser.open(opened)
    shown = browser.run(
        f"{SHADOWS}.map((root) => getComputedStyle(root.getElementById('plan')).visibility === 'visible')"
    )
    assert shown == [bool(text) for text in told(browser, "why")] == [True, True, False]


def test_all_go_equally_far_and_those_that_are_done_wait(
    browser: Chromium, opened: Path, data: dict[str, Any], runs: list[Run]
) -> None:
    browser.open(opened)
    scale = data["runs"][0]["scale"]
    assert robots(browser) == [run["start"] for run in data["runs"]]
    slide(browser, 2 * scale)
    assert told(browser, "length") == ["≈ 2"] * 3
    assert [x / scale for x, _ in robots(browser)] == pytest.approx(
        [run["start"][0] / scale + step for run, step in zip(data["runs"], (2, 0, 2), strict=True)]
    )
    slide(browser, 6 * scale)
    assert told(browser, "length")[2] == "3"
    assert told(browser, "happened")[2].endswith("the strategy is done")
    assert browser.run("document.getElementById('status').textContent") == "1 of 3 runs ended"
    assert browser.run("[...document.querySelectorAll('.run')].map((host) => host.dataset.ended)") == [
        "false", "false", "true",
    ]  # fmt: skip
    browser.press("End")
    assert robots(browser) == [run["frames"][-1]["place"] for run in data["runs"]]
    assert told(browser, "length")[0] == "5 + 12*pi ≈ 42.699112"
    assert told(browser, "acquired") == [f"{len(run.map.acquired)} of {len(run.obstacles)}" for run in runs]
    assert browser.run("document.getElementById('status').textContent") == "All runs have ended"
    browser.press("Home")
    assert robots(browser) == [run["start"] for run in data["runs"]]


def test_steps_stop_at_the_events_of_all_runs(browser: Chromium, opened: Path, data: dict[str, Any]) -> None:
    browser.open(opened)
    marks = sorted({run["frames"][event[4]]["at"] for run in data["runs"] for event in run["events"]})
    assert len(marks) > max(len({event[4] for event in run["events"]}) for run in data["runs"])
    found = []
    while not browser.run("document.getElementById('next').disabled"):
        browser.click("#next")
        found.append(float(browser.run("document.body.dataset.length")))
    assert found == marks[1:]
    browser.press("ArrowLeft")
    assert float(browser.run("document.body.dataset.length")) == marks[-2]


def test_it_plays_and_pauses(browser: Chromium, opened: Path) -> None:
    browser.open(opened)
    browser.press(" ", "Space", " ")
    browser.until("Number(document.body.dataset.length) > 0")
    browser.press(" ", "Space", " ")
    assert browser.run("document.body.dataset.playing") == "false"
    first = told(browser, "length")
    assert first[0] == first[1] != "0"


@pytest.mark.parametrize("size", [(1280, 800), (820, 600), (400, 800)])
def test_nothing_overlaps_or_overflows(browser: Chromium, opened: Path, size: tuple[int, int]) -> None:
    browser.open(opened, *size)
    browser.press("End")
    assert browser.run("document.documentElement.scrollWidth") <= size[0]
    boxes = browser.run(
        f"[...document.querySelectorAll('header, #controls, #legend'), ...{SHADOWS}.flatMap((root) => "
        "[...root.querySelectorAll('h2, #show, dl, #happened')])].map((e) => "
        "{ const b = e.getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom]; })"
    )
    assert len(boxes) == 3 + 3 * 4
    for k, (left, top, right, bottom) in enumerate(boxes):
        assert left >= 0 and right <= size[0] + 0.5 and right - left > 60 and bottom - top > 10
        for other in boxes[k + 1 :]:
            apart = other[0] >= right - 1, other[2] <= left + 1, other[1] >= bottom - 1, other[3] <= top + 1
            assert any(apart)
