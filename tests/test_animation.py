"""The animated page: what is encoded, that nothing a user writes can act, and what a browser makes of it."""

from __future__ import annotations

import base64
import cmath
import hashlib
import json
import math
import re
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from chromium import Chromium, binary

from exactacq import FormatError, isovist
from exactacq.files import gallery
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real
from exactacq.output.animation.page import (
    FAR,
    LIMIT,
    SIZE,
    Changes,
    Frame,
    Paper,
    Stop,
    chosen,
    frames_of,
    page,
    stops,
)
from exactacq.output.figures import draw as figures
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Outline, Polygon, Terrain
from exactacq.sensing.event import Event, EventKind
from exactacq.strategies.run import Run
from exactacq.strategies.seed_spreader.strategy import seed_spreader
from exactacq.strategies.sightseer.strategy import sightseer

CODE = Path(__file__).parent.parent / "exactacq" / "output" / "animation"
HOSTILE = (
    '</script><script>window.hacked = 1</script><img src=x onerror="window.hacked = 2">',
    "<!--<script>\u2028${window.hacked = 3}`$data $policy",
)
TOLERANCE = 2e-4
"""Page units: twice the last digit of the page's numbers."""


def encoded(run: Run, frames: list[Frame] | None = None) -> dict[str, Any]:
    """The data in the page."""
    text = page(run, frames_of(run) if frames is None else frames)
    (block,) = re.findall(r'<script type="application/json" id="data">(.*)</script>', text)
    return json.loads(block)


@pytest.fixture(scope="module")
def circles() -> Run:
    return sightseer(gallery.scene("circles"))


@pytest.fixture(scope="module")
def eleven() -> Run:
    return sightseer(gallery.scene("m11"))


@pytest.fixture(scope="module")
def room() -> Run:
    """Two obstacles with hostile names in a room with a round corner."""
    shapes = [Polygon([(2, 2), (4, 2), (4, 5)], name=HOSTILE[0]), Circle((8, 4), 1, name=HOSTILE[1])]
    walls = Outline([(0, 0), (10, 0), (10, 6, "1/3"), (8, 8), (0, 8)], name="\ud800 \u202ewall")
    return sightseer(Scene(shapes, (1, 1), enclosure=walls, radius=12, name=HOSTILE[0]))


@pytest.fixture(scope="module")
def swept() -> Run:
    """A sweep that diverts twice; one obstacle lies over the border."""
    return seed_spreader(gallery.scene("case2"))


# -- stops and frames ------------------------------------------------------------------------------


def test_stops_are_the_ends_of_pieces_and_the_places_of_events(circles: Run) -> None:
    start, end = circles.events[0], circles.events[-1]
    places = [circles.path[0].point(Fraction(u)) for u in ("1/3", "1/3", "1/2")]
    more = [Event(EventKind.SIGHT, place, 0, 0, circles.path, inside=True) for place in places]
    found = stops(replace(circles, events=(start, *more, end)))
    assert [stop.after for stop in found] == [0, 0, 0, *range(1, len(circles.path) + 1)]
    assert [stop.place for stop in found[:4]] == [Point(0, 0), Point(1, 0), Point("1.5", 0), Point(3, 0)]
    assert [stop.events for stop in found[:4]] == [[start], more[:2], more[2:], []]
    assert found[-1].events == [end]


def test_a_loop_that_ends_where_it_began_has_two_stops() -> None:
    run = sightseer(Scene([Circle((5, 0), 1)], (0, 0), radius=10))
    hit = next(event for event in run.events if event.kind == "hit")
    there = [stop for stop in stops(run) if stop.place == hit.point]
    assert [stop.after for stop in there] == [hit.after, len(run.path)]


def test_frames_are_the_exact_maps_and_views_of_their_moments(eleven: Run) -> None:
    found, frames = stops(eleven), list(frames_of(eleven))
    assert [event for frame in frames for event in frame.events] == list(eleven.events)
    assert len(frames) == len(found)
    assert all(one.at < other.at for one, other in pairwise(frames))
    for stop, frame in zip(found, frames, strict=True):
        moment = stop.events[-1] if stop.events else eleven.path.length_after(stop.after)
        assert frame.at == (moment.at if isinstance(moment, Event) else moment)
        assert frame.place == stop.place
        learnt = eleven.map_at(moment)
        known = Length.sum(curve.length for curves in frame.known.values() for curve in curves)
        assert known == learnt.known_length()
        assert tuple(frame.acquired) == learnt.acquired
        assert [(p.x, p.y) for p in frame.frontier] == [(p.x, p.y) for _, p in learnt.frontier]
        outline = [piece.curve for piece in isovist(eleven.scene, stop.place, eleven.radius).pieces]
        assert [repr(curve) for curve in frame.view] == [repr(curve) for curve in outline]


def test_m11_acquires_the_square_from_the_c_and_sees_the_bar_only_later(eleven: Run) -> None:
    frames = list(frames_of(eleven))
    acquired = next(frame for frame in frames if 1 in frame.acquired)
    assert acquired.at == 36
    assert 2 not in acquired.known
    assert (
        next(frame for frame in frames if 2 in frame.known).at == Fraction(233, 2) - 3 * Real(11).sqrt() / 5
    )


def test_too_many_stops_are_thinned_out_evenly_the_least_important_first(circles: Run) -> None:
    start = circles.events[0]
    lose = replace(start, kind="lose")
    happens = {0: [start], 5: [lose]}
    found = [Stop(k, Point(k, 0), happens.get(k % 10, [])) for k in range(101)]

    def kept(limit: int) -> list[int]:
        return [stop.after for stop in chosen(found, limit)]

    assert chosen(found, 101) == found
    assert kept(21) == list(range(0, 101, 5))
    assert kept(11) == list(range(0, 101, 10))
    assert sorted({*kept(13)} - {*kept(11)}) == [5, 95]
    assert kept(3) == [0, 50, 100]
    assert kept(2) == [0, 100]
    for limit in range(2, 102):
        assert len({*kept(limit)}) == limit
        assert {0, 100} < {*kept(limit)} or limit == 2
    with pytest.raises(ValueError, match="at least 2"):
        chosen(found, 1)
    assert LIMIT >= 2


# -- encoding --------------------------------------------------------------------------------------


def arc_points(data: str) -> Iterator[tuple[float, float]]:
    """Points of SVG path data of arcs and lines, by the conversion of SVG's implementation notes (F.6.5)."""
    numbers = r"(-?[\d.e+-]+) (-?[\d.e+-]+)"
    at: tuple[float, float] = (0, 0)
    pattern = rf"([MLZ])(?:{numbers})?|A([\d.]+) [\d.]+ 0 0 ([01]) {numbers}"
    for command, x, y, radius, flag, x2, y2 in re.findall(pattern, data):
        if radius:
            end, r = (float(x2), float(y2)), float(radius)
            mx, my = (at[0] + end[0]) / 2, (at[1] + end[1]) / 2
            dx, dy = (end[0] - at[0]) / 2, (end[1] - at[1]) / 2
            half = math.hypot(dx, dy)
            height = math.sqrt(max(0.0, r * r - half * half)) * (1 if flag == "1" else -1) / half
            cx, cy = mx - dy * height, my + dx * height
            first, last = math.atan2(at[1] - cy, at[0] - cx), math.atan2(end[1] - cy, end[0] - cx)
            turn = (last - first) % math.tau - (0 if flag == "1" else math.tau)
            r = max(r, half)
            yield from (
                (cx + r * math.cos(first + turn * k / 8), cy + r * math.sin(first + turn * k / 8))
                for k in range(1, 9)
            )
            at = end
        elif command != "Z":
            at = float(x), float(y)
            yield at


@pytest.mark.parametrize("bulge", ["1/1000", "1/7", "-1/3", "1", "-1", "3/2", "-5"])
def test_arcs_are_arcs_through_the_right_points(bulge: str) -> None:
    arc = Arc.from_bulge(Point(1, 2), Point(4, -3), Length(bulge).algebraic.rational)
    paper = Paper((-5.0, 5.0), 100.0, [1000, 1000])
    drawn = list(arc_points(paper.line([arc])))
    exact = [paper.point(arc.point(Fraction(k, 200)).xy) for k in range(201)]
    for x, y in drawn:
        assert math.hypot(
            x - 100 * (5 + arc.center.xy[0]), y - 100 * (5 - arc.center.xy[1])
        ) == pytest.approx(100 * float(arc.radius), abs=10 * TOLERANCE)
        assert min(math.hypot(x - u, y - v) for u, v in exact) < 100 * float(arc.length) / 60
    assert drawn[-1] == pytest.approx(exact[-1], abs=1e-6)


def test_a_full_circle_is_three_arcs_and_a_nearly_straight_one_a_line() -> None:
    paper = Paper((0.0, 10.0), 100.0, [1000, 1000])
    east = Point(3, 5)
    assert paper.line([Arc(east, east, Point(2, 5), Length(1).algebraic.rational, True, True)]) == (
        "M300 500A100 100 0 0 0 150 413.3975A100 100 0 0 0 150 586.6025A100 100 0 0 0 300 500"
    )
    flat = Arc.from_bulge(Point(1, 1), Point(9, 1), Length("1/100000").algebraic.rational)
    assert paper.line([flat]) == "M100 900L900 900"


def test_curves_that_meet_are_one_line() -> None:
    paper = Paper((0.0, 10.0), 100.0, [1000, 1000])
    corner = Segment(Point(0, 0), Point(1, 0)), Segment(Point(1, 0), Point(1, 1))
    assert paper.line(corner) == "M0 1000L100 1000L100 900"
    assert paper.line(reversed(corner)) == "M100 1000L100 900M0 1000L100 1000"
    assert paper.outline(corner).endswith("Z")
    assert paper.outline([]) == ""


def test_a_known_stretch_is_encoded_once_with_its_frames() -> None:
    paper = Paper((0.0, 10.0), 100.0, [1000, 1000])
    ends = [Point(k, 0) for k in range(4)]
    one, two, three = (Segment(ends[0], end) for end in ends[1:])
    changes = Changes(paper)
    same = Segment(ends[0], ends[1])
    again = [one]
    steps: list[dict[int, list[Curve]]] = [
        {}, {0: again}, {0: [same], 1: again}, {0: [two], 1: again}, {0: [three], 1: [same]},
        {0: [one], 1: []}, {0: [one]},
    ]  # fmt: skip
    for known in steps:
        changes.advance(known)
    assert [entry[:4] for entry in changes.entries()] == [
        [0, 1, 3, 100], [1, 2, 5, 100], [0, 3, 4, 200], [0, 4, 5, 300], [0, 5, None, 100],
    ]  # fmt: skip
    assert changes.entries()[0][4] == "M0 1000L100 1000"


def test_frames_can_be_rebuilt_from_the_encoding(circles: Run) -> None:
    frames, data = list(frames_of(circles)), encoded(circles)
    paper = Paper.of(circles.scene, circles.start, 20.0)
    assert len(data["frames"]) == len(frames)
    for number, frame in enumerate(frames):
        known = {
            (obstacle, drawn)
            for obstacle, first, end, _, drawn in data["known"]
            if first <= number and (end is None or number < end)
        }
        drawn = {
            (obstacle, paper.line([curve])) for obstacle, curves in frame.known.items() for curve in curves
        }
        assert known == drawn
        assert data["frames"][number]["at"] == pytest.approx(float(frame.at) * data["scale"], abs=TOLERANCE)
        assert data["frames"][number]["place"] == paper.point(frame.place.xy)
        acquired = {
            k
            for k, o in enumerate(data["obstacles"])
            if o["acquired"] is not None and o["acquired"] <= number
        }
        assert acquired == set(frame.acquired)
    assert sum(o["perimeter"] for o in data["obstacles"]) == pytest.approx(10 * math.pi * data["scale"])


def test_events_have_exact_lengths_names_and_frames(circles: Run) -> None:
    data = encoded(circles)
    assert [event[0] for event in data["events"]] == list(range(1, len(circles.events) + 1))
    moves = [event[1:4] for event in data["events"] if event[1] in ("start", "hit", "leave", "stop")]
    assert moves == [
        ["start", None, ""], ["hit", 0, "from S"], ["leave", 0, "to O2"], ["hit", 1, "from O1"],
        ["stop", 1, "every obstacle is visited"],
    ]  # fmt: skip
    paper = Paper.of(circles.scene, circles.start, 20.0)
    exact = {}
    for event, (_, kind, obstacle, _, number) in zip(circles.events, data["events"], strict=True):
        shown = data["frames"][number]
        assert shown["place"] == paper.point(event.point.xy)
        exact[kind, obstacle] = shown["exact"]
    assert exact["hit", 0] == "3"
    assert exact["leave", 0] == "3 + 6*pi ≈ 21.849556"
    assert exact["acquire", 0] == "2*asin(2/5) + 3 + 3*pi ≈ 13.247812"
    assert exact["stop", 1] == data["length"] == "5 + 12*pi ≈ 42.699112"


def test_what_is_left_out_is_owned_up_to(circles: Run) -> None:
    frames = list(frames_of(circles))
    assert encoded(circles)["left_out"] is None
    data = encoded(circles, [frames[0], frames[-1]])
    assert data["left_out"] == [2, len(frames)]
    assert [event[0] for event in data["events"]] == [1, 2, len(circles.events)]
    with pytest.raises(ValueError, match="at least one"):
        page(circles, [])


@pytest.mark.parametrize("factor", ["1e-50", "1e12"])
def test_similar_scenes_are_drawn_alike(factor: str) -> None:
    def run(unit: str) -> Run:
        size = Length(unit).algebraic.rational
        shapes = [Circle((5 * size, 0), 2 * size), Polygon([(8 * size, 0), (9 * size, 0), (9 * size, size)])]
        return sightseer(Scene(shapes, (0, 0), radius=10 * size))

    one, other = encoded(run("1")), encoded(run(factor))
    assert other["scale"] == pytest.approx(one["scale"] / float(factor))
    for shown in (*one["frames"], *other["frames"]):
        shown.pop("exact")
    for part in ("box", "path", "known", "frames", "start"):
        assert other[part] == one[part]
    assert max(one["box"]) == pytest.approx(1.12 * SIZE, abs=1)


def test_a_scene_lost_in_floating_point_is_refused() -> None:
    far = 10**12
    run = sightseer(Scene([Circle((far + 5, 0), 2)], (far, 0), radius=10))
    with pytest.raises(FormatError, match="move the scene closer"):
        encoded(run)


def test_an_enclosure_blocks_all_the_rest_and_nothing_to_do_is_fine(room: Run) -> None:
    wall = encoded(room)["obstacles"][-1]
    assert wall["outline"].endswith(f"M{-FAR} {-FAR}H{FAR}V{FAR}H{-FAR}Z")
    assert wall["heart"] is None
    empty = encoded(sightseer(Scene([], (7, 7), radius=2)))
    assert empty["path"] == []
    assert empty["box"] == pytest.approx([1.12 * SIZE] * 2)


def test_a_sweep_has_its_line_its_diversions_and_components(swept: Run) -> None:
    data = encoded(swept)
    paper = Paper.of(swept.scene, swept.start, 8.0, swept=True)
    assert data["title"] == "Seed Spreader Strategy: case2"
    assert len(data["obstacles"]) == len(swept.obstacles)
    assert [o["perimeter"] for o in data["obstacles"]] == [
        paper.length(float(body.perimeter)) for body in swept.obstacles
    ]
    assert data["diversions"] == [[d.first, d.last] for d in swept.diversions]  # type: ignore[union-attr]
    corners = [(0, 0), (0, 20), (8, 20), (8, 0), (16, 0), (16, 20)]
    places = [" ".join(map(str, paper.point(corner))) for corner in corners]
    assert data["mline"] == "M" + "L".join(places)
    assert data["beyond"].count("M") == 1
    assert {"divert", "return", "hit", "leave"} <= {event[1] for event in data["events"]}
    assert data["frames"][-1]["place"] == places_of(paper, swept)[-1]
    assert all(o["acquired"] is not None for o in data["obstacles"])
    left, top, width, height = data["terrain"]
    x, y, depth = data["obstacles"][0]["heart"]
    assert left < x < left + width
    assert top < y < top + height
    assert depth > 0


def places_of(paper: Paper, run: Run) -> list[list[float]]:
    return [paper.point(stop.place.xy) for stop in stops(run)]


def test_the_sightseer_has_no_line(circles: Run) -> None:
    data = encoded(circles)
    assert (data["mline"], data["beyond"], data["diversions"]) == ("", "", [])


def test_notes_call_obstacles_by_their_names() -> None:
    wall = Polygon([(-1, 4), (9, 4), (9, 5), (-1, 5)], name="wall")
    data = encoded(seed_spreader(Scene([Circle((4, 2), 1), wall], terrain=Terrain(9, 8), radius=5)))
    notes = [event[3] for event in data["events"]]
    assert notes[-1].endswith("trapped in wall")
    assert "on the M-line" in notes


# -- the page as text ------------------------------------------------------------------------------


def test_equal_runs_give_equal_pages(room: Run) -> None:
    again = sightseer(room.scene)
    assert page(again, frames_of(again)) == page(room, list(frames_of(room)))


def test_the_policy_allows_this_script_and_this_style_only(room: Run) -> None:
    text = page(room, frames_of(room))
    (policy,) = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]*)"', text)
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    assert rules["default-src"] == "'none'"
    for tag in ("script", "style"):
        (content,) = re.findall(rf"<{tag}>(.*?)</{tag}>", text, re.DOTALL)
        digest = base64.b64encode(hashlib.sha256(content.encode()).digest()).decode()
        assert rules[f"{tag}-src"] == f"'sha256-{digest}'"
    addresses = set(re.findall(r"[a-z]+://[^\"'\s]*", text))
    assert addresses == {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xhtml"}


def test_what_a_user_writes_is_in_the_block_of_data_only(room: Run) -> None:
    text = page(room, frames_of(room))
    assert text.isascii() or not re.search("[\ud800-\udfff\u2028\u202e]", text)
    text.encode()
    before, block, after = re.split(r'(?<=id="data">)(.*)(?=</script>\n<script>)', text)
    assert "hacked" not in before + after
    assert "<" not in block
    assert [o["name"] for o in json.loads(block)["obstacles"]][:2] == list(HOSTILE)
    script = (CODE / "page.js").read_text("utf-8")
    for danger in ("innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", "Function("):
        assert danger not in script


def luminance(colour: str) -> float:
    """Relative luminance by WCAG 2."""
    shares = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4 for s in shares]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def test_colours_are_those_of_the_figures_and_can_be_told_apart() -> None:
    colours = dict(re.findall(r"--([a-z]+): (#[0-9a-f]{6});", (CODE / "page.css").read_text("utf-8")))
    own = {name: getattr(figures, name.upper()) for name in ("ink", "paper", "fill", "edge", "view")}
    assert colours | own | {"robot": figures.HIT} == colours
    for text, ground in (("ink", "paper"), ("soft", "paper"), ("ink", "fill"), ("ink", "ground")):
        assert contrast(colours[text], colours[ground]) >= 4.5
    for mark, ground in (
        ("path", "ground"),
        ("path", "ink"),
        ("frontier", "ground"),
        ("robot", "ground"),
        ("away", "ground"),
    ):
        assert contrast(colours[mark], colours[ground]) >= 3
    assert contrast(colours["soft"], "#e3edfb") >= 4.5  # in the list's current entry


# -- the page in a browser -------------------------------------------------------------------------


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
    there = frame(browser)
    slide(browser, browser.run("Number(document.getElementById('slider').value)") + 1)
    assert frame(browser) == there
    assert texts(browser, "#status") == [f"On the way after event {leave} of {len(circles.events)}"]
    browser.press("ArrowLeft")
    assert texts(browser, "#status") == [f"{leave}. leave O1, to O2"]


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
        drawn = browser.run("[...document.querySelectorAll('#walked path')].at(-1).getTotalLength()")
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
        assert len(texts(browser, "#frontier circle")) == len(shown.frontier)
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
    assert (frame(browser), texts(browser, "#verb")) == (1, ["Play"])
    browser.run("document.getElementById('speed').focus()")
    browser.press("ArrowRight")
    assert frame(browser) == 1
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
    assert texts(browser, "#names text")[:2] == list(HOSTILE)
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
    assert (
        browser.run("document.getElementById('slider').getAttribute('aria-valuetext')")
        == "0 of 1387/10 ≈ 138.7"
    )
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


def test_closed_outlines_of_views_are_drawn_whole(room: Run) -> None:
    shown = [f for f in frames_of(room) if f.view]
    assert shown
    for entry in encoded(room)["frames"]:
        assert not entry["view"] or (entry["view"].count("M") == 1 and entry["view"].endswith("Z"))
    curves: list[Curve] = list(shown[0].view)
    assert all(a.end == b.start for a, b in pairwise([*curves, curves[0]]))
