"""The animated page: what is encoded, that nothing a user writes can act, and what a browser makes of it."""

from __future__ import annotations

import base64
import hashlib
import json
import math
import re
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import pytest
from gallery_runs import gallery_run
from nightly import NIGHTLY
from pages import HOSTILE, encoded, frames_of

from exactacq import FormatError, isovist
from exactacq.errors import Undecided
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real
from exactacq.output import vocabulary
from exactacq.output.animation import frames as animation
from exactacq.output.animation.frames import LIMIT, Stop, chosen, stops
from exactacq.output.animation.page import COARSE, FAR, SCRIPTS, SIZE, Changes, Paper, bundled, page, scale
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Polygon, Terrain
from exactacq.sensing.event import Event, EventKind
from exactacq.strategies.run import Run
from exactacq.strategies.seed_spreader.strategy import seed_spreader
from exactacq.strategies.sightseer.strategy import sightseer

CODE = Path(__file__).parents[2] / "exactacq" / "output" / "animation"
PAGES = ("one_run.js", "several.js")
TOLERANCE = 2e-4
"""Page units: twice the last digit of the page's numbers."""


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
    found, frames = stops(eleven), list(frames_of(eleven, fine=0))
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


def test_a_stop_whose_view_is_undecided_has_none(eleven: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """A path by shortest known ways has ends of such numbers that the library gives up some views there."""
    monkeypatch.setattr("exactacq.visibility.isovist.Isovist.pieces", property(give_up))
    frames = list(frames_of(eleven))
    assert [event for frame in frames for event in frame.events] == list(eleven.events)
    assert not any(frame.view or frame.is_passing for frame in frames)
    assert all(frame["view"] == "" for frame in encoded(eleven, frames)["frames"])


def give_up(view: object) -> None:
    raise Undecided("a tie")


def test_between_stops_map_and_view_are_exact_too(eleven: Run) -> None:
    paper = replace(Paper.of(eleven.scene, eleven.start, float(eleven.radius)), decimals=COARSE)
    frames = list(frames_of(eleven, fine=40))
    between = [(number, frame) for number, frame in enumerate(frames) if frame.is_passing]
    assert len(frames) - len(between) == len(stops(eleven)) and len(between) > 10
    shown = encoded(eleven, frames)["frames"]
    assert all(one.at < other.at for one, other in pairwise(frames))
    for number, frame in between:
        assert not frame.events and shown[number]["passing"]
        view = isovist(eleven.scene, frame.place, eleven.radius)
        assert shown[number]["view"] == paper.outline([piece.curve for piece in view.pieces])
        learnt = eleven.map_at(eleven.near(frame.at))
        known = Length.sum(curve.length for curves in frame.known.values() for curve in curves)
        assert float(known) == pytest.approx(float(learnt.known_length()))


def test_places_between_stops_are_spread_evenly_and_few_in_heavy_scenes(
    eleven: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    gaps = [float(b.at) - float(a.at) for a, b in pairwise(frames_of(eleven, fine=60))]
    step = float(eleven.length) / 61
    assert max(gaps) < 1.85 * step
    monkeypatch.setattr(animation, "HEAVY", 0)
    assert not any(frame.is_passing for frame in frames_of(eleven, fine=60))
    monkeypatch.setattr(animation, "HEAVY", 10**6)
    monkeypatch.setattr(animation, "PIECES", 100)
    assert sum(frame.is_passing for frame in frames_of(eleven, fine=60)) < 20


def test_progress_of_frames_grows_to_the_total(circles: Run) -> None:
    told: list[tuple[int, int]] = []
    frames = list(animation.frames_of(circles, fine=9, progress=lambda *done: told.append(done)))
    assert told == [(k, len(frames)) for k in range(1, len(frames) + 1)]


def test_a_page_with_many_events_stays_small() -> None:
    name, most = ("figure2", 1_000_000) if NIGHTLY else ("m25", 300_000)
    run = gallery_run(name)
    assert len(page(run, animation.frames_of(run)).encode()) < most


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
    for event, (_, kind, obstacle, _, number, _) in zip(circles.events, data["events"], strict=True):
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
    assert data["left_out"] == [2, len(stops(circles))]
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
    script = "".join((CODE / name).read_text("utf-8") for name in (*SCRIPTS, *PAGES))
    for danger in ("innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", "Function("):
        assert danger not in script


@pytest.mark.parametrize("own", PAGES)
def test_modules_make_one_script(own: str) -> None:
    """What they import comes before them, and no two have a name in common at their outermost level."""
    modules = {name: (CODE / name).read_text("utf-8") for name in (*SCRIPTS, own)}
    every = {name.rsplit("/", 1)[-1] for name in (*SCRIPTS, *PAGES)}
    assert {path.name for path in CODE.rglob("*.js")} == every
    names: list[str] = []
    before: set[str] = set()
    for name, text in modules.items():
        used = re.findall(r'from "\./(?:player/)?(\w+)\.js"', text)
        assert set(used) <= before, name
        before.add(Path(name).stem)
        names += re.findall(r"^(?:export )?(?:const|function) (\w+)", text, re.M)
    assert len(names) == len({*names})
    script = bundled(modules)
    assert not re.search(r"^\s*(import|export)\b", script, re.M)
    assert (
        bundled({"a": 'import {\n  b,\n} from "./b.js";\nexport const c = 1;\n'}).split("\n")[2]
        == "const c = 1;"
    )


def luminance(colour: str) -> float:
    """Relative luminance by WCAG 2."""
    shares = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4 for s in shares]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def test_words_and_colours_are_those_of_figures_and_tables(swept: Run) -> None:
    """The skeleton, the style and the script have no word or colour of their own for what is shown."""
    text = page(swept, frames_of(swept))
    skeleton = "".join(path.read_text("utf-8") for path in CODE.rglob("*.html"))
    code = "".join(path.read_text("utf-8") for path in CODE.rglob("*.js"))
    for word in ("known boundary", "unknown boundary", "diversion", "M-line", "order of visits", "start S"):
        assert word in list(vocabulary.Word) and word in text
        assert word not in re.sub(r"\$\w+", "", skeleton)
    style = (CODE / "page.css").read_text("utf-8")
    hover = {"#eef3fb", "#3a4048", "#e8eaec", "#e3edfb", "#1b57b0"}  # of buttons and lists
    assert set(re.findall(r"#[0-9a-f]{6}", style)) == hover
    assert not re.findall(r"#[0-9a-f]{6}", code)
    data = encoded(swept)
    assert data["away"] == vocabulary.AWAY and data["colours"] == scale()


def test_visits_are_numbered_in_their_order(circles: Run, swept: Run) -> None:
    for run in (circles, swept):
        visits = encoded(run)["visits"]
        assert [index for index, _ in visits] == list(run.visits)
        assert visits == sorted(visits, key=lambda visit: visit[1])


def test_colours_can_be_told_apart(room: Run) -> None:
    style = re.search(r"<style>(.*)</style>", page(room, frames_of(room)), re.S)
    assert style
    colours = dict(re.findall(r"--([a-z-]+): (#[0-9a-f]{6});", style[1]))
    for text, ground in (("ink", "paper"), ("soft", "paper"), ("ink", "fill"), ("ink", "ground")):
        assert contrast(colours[text], colours[ground]) >= 4.5
    for mark, ground in (("hit", "ground"), ("view", "ground"), ("away", "ground")):
        assert contrast(colours[mark], colours[ground]) >= 3
    assert contrast(colours["soft"], "#e3edfb") >= 4.5  # in the list's current entry


def test_closed_outlines_of_views_are_drawn_whole(room: Run) -> None:
    shown = [f for f in frames_of(room) if f.view]
    assert shown
    for entry in encoded(room)["frames"]:
        assert not entry["view"] or (entry["view"].count("M") == 1 and entry["view"].endswith("Z"))
    curves: list[Curve] = list(shown[0].view)
    assert all(a.end == b.start for a, b in pairwise([*curves, curves[0]]))


def test_plans_are_told_from_where_they_are_made(eleven: Run) -> None:
    """In the frame where the robot decides, and in no frame before; at the end, why it ends."""
    frames, data = list(frames_of(eleven)), encoded(eleven)
    names = list(eleven.names())
    decided = [event for event in eleven.events if event.decision is not None]
    assert [why for _, why in data["plans"]] == [
        *(event.why(names) for event in decided),
        "every obstacle is visited",
    ]
    for (number, _), event in zip(data["plans"], decided, strict=False):
        made = event.decision.after
        place = eleven.path[made].start if made < len(eleven.path) else eleven.path[-1].end
        assert frames[number].place == place
        assert number == 0 or frames[number - 1].after < made
    assert data["plans"][-1][0] == len(frames) - 1
    assert [event[5] for event in data["events"]] == [event.why(names) for event in eleven.events]
