"""The page that plays a run, in a browser: what it shows, how it is used, what it keeps out."""

from __future__ import annotations

import cmath
import json
import math
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest
from chromium import Chromium, binary
from pages import HOSTILE, encoded, frames_of

from exactacq.geometry.curves import Curve, Segment
from exactacq.numbers.length import Length
from exactacq.output.animation.page import Paper, page
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle
from exactacq.strategies.run import Run
from exactacq.strategies.sightseer.strategy import sightseer

TOLERANCE = 2e-4


@pytest.fixture(scope="module")
def browser() -> Iterator[Chromium]:
    if binary() is None:
        pytest.skip("no Chromium or Chrome is installed")
    with Chromium() as running:
        yield running


@pytest.fixture(scope="module")
def pages(
    circles: Run, eleven: Run, room: Run, swept: Run, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("pages")
    found = {}
    still = sightseer(Scene([Circle((9, 0), 1)], (0, 0), radius=1))
    for name, run in {
        "circles": circles,
        "room": room,
        "m11": eleven,
        "still": still,
        "swept": swept,
    }.items():
        found[name] = folder / f"{name}.html"
        found[name].write_text(page(run, frames_of(run)), "utf-8")
    return found


def frame(browser: Chromium) -> int:
    return int(browser.run("document.body.dataset.frame"))


def robot(browser: Chromium) -> tuple[float, float]:
    x, y = browser.run(
        "['cx', 'cy'].map((name) => Number(document.getElementById('robot').getAttribute(name)))"
    )
    return x, y


def slide(browser: Chromium, length: float) -> None:
    browser.run(
        "(() => { const slider = document.getElementById('slider'); "
        f"slider.value = {length!r}; slider.dispatchEvent(new Event('input', {{bubbles: true}})); }})()"
    )


def texts(browser: Chromium, selector: str) -> list[str]:
    return browser.run(f"[...document.querySelectorAll({json.dumps(selector)})].map((e) => e.textContent)")


@pytest.mark.parametrize("name", ["circles", "room", "m11", "still", "swept"])
def test_it_loads_in_silence_and_asks_the_network_for_nothing(
    browser: Chromium, pages: dict[str, Path], name: str
) -> None:
    browser.open(pages[name])
    browser.press("End")
    browser.press("Home")
    assert browser.run("performance.getEntriesByType('resource').length") == 0
    assert browser.complaints == []
    assert browser.requests == [pages[name].absolute().as_uri()]


def test_the_policy_holds_in_the_browser(browser: Chromium, pages: dict[str, Path]) -> None:
    """Scripts, attributes and images that someone managed to insert would be refused."""
    browser.open(pages["circles"])
    browser.run(
        "(() => { const s = document.createElement('script'); s.textContent = 'window.hacked = 1'; "
        "document.body.append(s); const d = document.createElement('div'); "
        'd.innerHTML = \'<img src="http://localhost:9/x.png" onerror="window.hacked = 2">\'; '
        "document.body.append(d); })()"
    )
    browser.until("true")
    assert browser.run("window.hacked ?? null") is None
    browser.until("document.images[0].complete")
    assert browser.refused == ["csp"]


def test_steps_go_from_event_to_event(browser: Chromium, pages: dict[str, Path], circles: Run) -> None:
    data = encoded(circles)
    eventful = list(dict.fromkeys(entry[4] for entry in data["events"]))
    browser.open(pages["circles"])
    assert frame(browser) == 0
    assert browser.run("document.getElementById('previous').disabled") is True
    for number in eventful[1:]:
        browser.click("#next")
        assert frame(browser) == number
        assert list(robot(browser)) == data["frames"][number]["place"]
        here = [event for event in data["events"] if event[4] == number]
        current = texts(browser, "#list [aria-current] .number"), texts(browser, "#list [aria-current] .at")
        assert current == (
            [str(event[0]) for event in here],
            [f"at {texts(browser, '#length')[0]}"] * len(here),
        )
    assert texts(browser, "#status") == [f"{len(circles.events)}. stop O2, every obstacle is visited"]
    assert browser.run("document.getElementById('next').disabled") is True
    for number in reversed(eventful[:-1]):
        browser.press("ArrowLeft")
        assert frame(browser) == number
    browser.press("ArrowRight")
    assert frame(browser) == eventful[1]
    browser.press("End")
    assert frame(browser) == len(data["frames"]) - 1
    browser.press("Home")
    assert frame(browser) == 0
    hit = next(k for k, event in enumerate(circles.events) if event.kind == "hit" and event.obstacle == 1)
    browser.click(f"[data-event='{hit}']")
    assert texts(browser, "#status") == [f"{hit + 1}. hit O2, from O1"]
    assert texts(browser, "#length") == ["5 + 6*pi ≈ 23.849556"]


def test_back_from_the_way_leads_to_the_event_before(
    browser: Chromium, pages: dict[str, Path], circles: Run
) -> None:
    leave = next(k for k, event in enumerate(circles.events, 1) if event.kind == "leave")
    browser.open(pages["circles"])
    browser.click(f"[data-event='{leave - 1}']")
    slide(browser, browser.run("Number(document.getElementById('slider').value)") + 1)
    assert texts(browser, "#status") == [f"On the way after event {leave} of {len(circles.events)}"]
    browser.press("ArrowLeft")
    assert texts(browser, "#status") == [f"{leave}. leave O1, to O2"]


def test_what_the_robot_is_about_to_do_is_told(
    browser: Chromium, pages: dict[str, Path], circles: Run
) -> None:
    """From where it decides that, which is before it leaves, to where it decides something else."""
    first, second, end = "only O1 is in reach: 3", "only O2 is in reach: 2", "every obstacle is visited"
    scale, rounded = encoded(circles)["scale"], 3 + 4 * math.pi
    browser.open(pages["circles"])
    assert texts(browser, "#plan .kind") == ["why"]
    for length, why in (
        (0, first), (rounded - 0.01, first), (rounded + 0.01, second), (30, second), (0, first)
    ):  # fmt: skip
        slide(browser, length * scale)
        assert texts(browser, "#why") == [why]
    browser.press("End")
    assert texts(browser, "#why") == [end]
    assert texts(browser, "#list .because") == [first, second]


def halfway(curve: Curve) -> tuple[float, float]:
    """The point at half of the length."""
    if isinstance(curve, Segment):
        return curve.point(Fraction(1, 2)).xy
    turn = float(curve.length) / float(curve.radius) / (2 if curve.ccw else -2)
    spoke = complex(*curve.start.xy) - complex(*curve.center.xy)
    place = complex(*curve.center.xy) + spoke * cmath.exp(1j * turn)
    return place.real, place.imag


def test_the_slider_puts_the_robot_on_the_exact_path(
    browser: Chromium, pages: dict[str, Path], circles: Run
) -> None:
    paper, frames = Paper.of(circles.scene, circles.start, 20.0), list(frames_of(circles))
    browser.open(pages["circles"])
    done = 0.0
    for piece in circles.path:
        size = float(piece.length)
        slide(browser, (done + size / 2) * paper.scale)
        middle = paper.point(halfway(piece.curve))
        assert robot(browser) == pytest.approx(middle, abs=1e-3)
        passed = [number for number, shown in enumerate(frames) if float(shown.at) <= done + size / 2]
        assert frame(browser) == passed[-1]
        end = browser.run(
            "(() => { const t = [...document.querySelectorAll('#walked path')].at(-1); "
            "const p = t.getPointAtLength(t.getTotalLength()); return [p.x, p.y]; })()"
        )
        assert end == pytest.approx(middle, abs=0.05)
        drawn = browser.run(
            "[...document.querySelectorAll('#walked path')].filter((p) => p.getAttribute('visibility') "
            "!== 'hidden').reduce((sum, p) => sum + p.getTotalLength(), 0)"
        )
        assert drawn == pytest.approx((done + size / 2) * paper.scale, rel=1e-3)
        done += size


def test_the_map_grows(browser: Chromium, pages: dict[str, Path], circles: Run) -> None:
    frames, data = list(frames_of(circles)), encoded(circles)
    browser.open(pages["circles"])
    for number, shown in enumerate(frames):
        slide(browser, data["frames"][number]["at"])
        assert frame(browser) == number
        stretches = (
            "[...document.querySelectorAll('#known path')].map((p) => Number(p.dataset.stretches ?? 0))"
        )
        assert sum(browser.run(stretches)) == sum(map(len, shown.known.values()))
        assert len(texts(browser, "#frontier rect")) == len(shown.frontier)
        assert len(texts(browser, "#obstacles .acquired")) == len(shown.acquired)
        partial = set(shown.known) - set(shown.acquired)
        assert len(texts(browser, "#obstacles .partial")) == len(partial)
        assert texts(browser, "#acquired") == [f"{len(shown.acquired)} of 2"]
        assert (
            browser.run("document.getElementById('view').getAttribute('d')") == data["frames"][number]["view"]
        )
    assert texts(browser, "#learnt") == ["31.416 of 31.416"]
    slide(browser, 0)
    assert any(curve.length == 0 for shown in frames for curves in shown.known.values() for curve in curves)
    first = Length.sum(curve.length for curves in frames[0].known.values() for curve in curves)
    assert texts(browser, "#learnt") == [f"{float(first):.5g} of 31.416"]
    assert len(texts(browser, "#obstacles .unseen")) == 1


def test_the_marks_of_the_map_stand_where_the_map_ends(browser: Chromium, pages: dict[str, Path]) -> None:
    """The middle of a diamond on the screen, taken back into the plane, is the place that it marks."""
    browser.open(pages["circles"])
    slide(browser, 8.0)
    marks = browser.run("""[...document.querySelectorAll("#frontier rect")].map((rect) => {
        const box = rect.getBoundingClientRect();
        const middle = new DOMPoint(box.x + box.width / 2, box.y + box.height / 2);
        const at = middle.matrixTransform(rect.parentNode.getScreenCTM().inverse());
        return [at.x - rect.x.baseVal.value, at.y - rect.y.baseVal.value, box.width];
    })""")
    assert marks
    for x, y, width in marks:
        assert width > 5
        assert (x, y) == pytest.approx((0, 0), abs=0.01)


def test_it_plays_pauses_and_ends(browser: Chromium, pages: dict[str, Path]) -> None:
    browser.open(pages["circles"])
    browser.run("document.getElementById('speed').value = '4'")
    browser.press(" ", "Space", " ")
    assert texts(browser, "#verb") == ["Pause"]
    browser.until("document.body.dataset.frame >= 2")
    browser.press(" ", "Space", " ")
    assert texts(browser, "#verb") == ["Play"]
    place = robot(browser)
    browser.run("new Promise((done) => setTimeout(done, 150))")
    assert robot(browser) == place
    browser.click("#play")
    browser.until("document.body.dataset.playing === 'false'")
    assert texts(browser, "#status")[0].endswith(". stop O2, every obstacle is visited")
    browser.click("#play")  # again, from the start
    browser.until("document.body.dataset.frame === '0' && document.body.dataset.playing === 'true'")
    slide(browser, 1.0)
    assert texts(browser, "#verb") == ["Play"]


def test_diversions_are_drawn_apart(browser: Chromium, pages: dict[str, Path], swept: Run) -> None:
    """As far as the robot has come; together, diversions and the rest are the whole path."""
    data = encoded(swept)
    visible = "p.getAttribute('visibility') !== 'hidden' && p.classList.contains('away') === %s"
    paths = f"[...document.querySelectorAll('#walked path')].filter((p) => {visible})"
    shown = paths + ".reduce((sum, p) => sum + p.getTotalLength(), 0)"
    browser.open(pages["swept"])
    assert browser.run("document.querySelector('#mline').getAttribute('d')") == data["mline"]
    assert browser.run("[...document.querySelectorAll('.swept')].every((e) => !e.hidden)") is True
    (first, last), *_ = data["diversions"]
    start, end = data["path"][first - 1][0], data["path"][last - 1][0]
    for length, away in ((start - 1, 0), ((start + end) / 2, (end - start) / 2), (end + 1, end - start)):
        slide(browser, length)
        assert browser.run(shown % "true") == pytest.approx(away, rel=1e-3)
        assert browser.run(shown % "false") == pytest.approx(length - away, rel=1e-3)
    browser.open(pages["circles"])
    assert browser.run("[...document.querySelectorAll('.swept')].every((e) => e.hidden)") is True


def test_who_wants_no_motion_sees_one_event_after_the_other(
    browser: Chromium, pages: dict[str, Path], circles: Run
) -> None:
    data = encoded(circles)
    browser.open(pages["circles"], still=True)
    browser.run("document.getElementById('speed').value = '4'")
    browser.run(
        "window.places = []; new MutationObserver(() => { const r = document.getElementById('robot'); "
        "window.places.push([Number(r.getAttribute('cx')), Number(r.getAttribute('cy'))]); })"
        ".observe(document.getElementById('robot'), {attributes: true}); null"
    )
    browser.press(" ", "Space", " ")
    browser.until("document.body.dataset.playing === 'false'")
    places = {tuple(data["frames"][entry[4]]["place"]) for entry in data["events"]}
    assert {tuple(place) for place in browser.run("window.places")} <= places
    assert frame(browser) == len(data["frames"]) - 1


def test_keys_leave_buttons_and_lists_their_own(browser: Chromium, pages: dict[str, Path]) -> None:
    browser.open(pages["circles"])
    browser.run("document.getElementById('next').focus()")
    browser.press(" ", "Space", " ")
    there = frame(browser)
    assert there > 0 and texts(browser, "#verb") == ["Play"]
    browser.run("document.getElementById('speed').focus()")
    browser.press("ArrowRight")
    assert frame(browser) == there
    browser.click("#next")  # A mouse leaves no focus behind, so that the space bar plays.
    browser.press(" ", "Space", " ")
    assert texts(browser, "#verb") == ["Pause"]


def test_hostile_names_are_text(browser: Chromium, pages: dict[str, Path]) -> None:
    browser.open(pages["room"])
    browser.press("End")
    assert browser.run("window.hacked ?? null") is None
    assert browser.run("document.querySelectorAll('img, #list script, #stage script').length") == 0
    assert browser.run("document.scripts.length") == 2
    assert texts(browser, "h1") == [f"Sightseer Strategy: {HOSTILE[0]}"]
    assert [text.rsplit(" #", 1)[0] for text in texts(browser, "#names text")[:2]] == list(HOSTILE)
    assert texts(browser, "#obstacles title")[:2] == list(HOSTILE)
    assert any(HOSTILE[1] in line for line in texts(browser, "#list .what"))
    assert browser.run("document.title") == f"Sightseer Strategy: {HOSTILE[0]}"


@pytest.mark.parametrize("size", [(1280, 800), (820, 600), (400, 800), (320, 568)])
@pytest.mark.parametrize("name", ["circles", "room", "m11", "swept"])
def test_nothing_overlaps_or_overflows(
    browser: Chromium, pages: dict[str, Path], name: str, size: tuple[int, int]
) -> None:
    browser.open(pages[name], *size)
    for key in ("Home", "End", "ArrowLeft"):
        browser.press(key)
        assert browser.run("document.documentElement.scrollWidth") <= size[0]
        boxes = browser.run(
            "['header', '#show', '.buttons', '#slider', '#status', 'dl', '#events', '#legend'].map((s) => "
            "{ const b = document.querySelector(s).getBoundingClientRect(); "
            "return [b.left, b.top, b.right, b.bottom]; })"
        )
        for k, (left, top, right, bottom) in enumerate(boxes):
            assert left >= 0
            assert right <= size[0] + 0.5
            assert right - left > 60
            for other in boxes[k + 1 :]:
                apart = (
                    other[0] >= right - 1
                    or other[2] <= left + 1
                    or other[1] >= bottom - 1
                    or other[3] <= top + 1
                )
                assert apart
    if size == (1280, 800) and name != "room":
        assert browser.run("document.documentElement.scrollHeight") <= 800


def test_everything_that_acts_has_a_name_and_shows_its_focus(
    browser: Chromium, pages: dict[str, Path]
) -> None:
    browser.open(pages["m11"])
    names = browser.run(
        "[...document.querySelectorAll('button, input, select')].map((e) => "
        "e.getAttribute('aria-label') || e.closest('label')?.textContent || e.textContent)"
    )
    assert all(name.strip() for name in names)
    assert browser.run("document.documentElement.lang") == "en"
    assert browser.run("document.getElementById('status').getAttribute('aria-live')") == "polite"
    assert browser.run("document.getElementById('slider').getAttribute('aria-valuetext')") == "0 of 138.7"
    order = []
    for _ in range(6):
        browser.press("Tab")
        order.append(
            browser.run(
                "[document.activeElement.id || document.activeElement.dataset.event, "
                "getComputedStyle(document.activeElement).outlineStyle]"
            )
        )
    assert [name for name, _ in order] == ["play", "next", "speed", "slider", "0", "1"]
    assert all(style == "solid" for _, style in order)
