"""A run written as JSON and read back is the same run, exactly; anything else is one clear error."""

from __future__ import annotations

import copy
import json
import subprocess
import sys
from dataclasses import fields
from fractions import Fraction
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest
from gallery_runs import gallery_run
from nightly import by_night, some

from exactacq import (
    Arc,
    Around,
    Circle,
    FormatError,
    InvalidScene,
    Length,
    Outline,
    Point,
    Polygon,
    Real,
    Run,
    Scene,
    Terrain,
    explore,
    load_run,
    seed_spreader,
    sightseer,
)
from exactacq.errors import Undecided
from exactacq.files import gallery
from exactacq.files.octagons import random_octagons
from exactacq.numbers import number_json
from exactacq.numbers.function_zeros import roots
from exactacq.numbers.number_json import Decoder, Encoder
from exactacq.output.run_json import VERSION
from exactacq.sensing.view_length import ViewLength
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import random_scene

OLD = Path(__file__).parent / "data" / "runs"


def curve_data(piece):
    arc = getattr(piece.curve, "center", None)
    return (
        piece.kind,
        piece.obstacle,
        arc is None or (piece.curve.radius_sq, piece.curve.ccw, piece.curve.full),
    )


def assert_same(one: Run, other: Run) -> None:
    assert one.length == other.length
    assert (one.strategy, one.radius, one.visits) == (other.strategy, other.radius, other.visits)
    assert (one.unseen, one.unvisited) == (other.unseen, other.unvisited)
    assert one.start == other.start
    assert len(one.path) == len(other.path)
    for a, b in zip(one.path, other.path, strict=True):
        assert curve_data(a) == curve_data(b)
        assert a.start == b.start and a.end == b.end and a.length == b.length
    assert type(one) is type(other)
    of_strategy = {field.name for field in fields(one)} - {field.name for field in fields(Run)}
    assert all(getattr(one, name) == getattr(other, name) for name in of_strategy)
    assert one.events == other.events
    for a, b in zip(one.bounds, other.bounds, strict=True):
        assert (a.name, a.source, a.holds) == (b.name, b.source, b.holds) and a.value == b.value
    assert [o.name for o in one.scene.obstacles] == [o.name for o in other.scene.obstacles]


@cache
def room() -> Run:
    wall = Outline([(6, 0, 1), (-6, 0, 1)])
    inside = [
        Circle((2, 1), 1),
        Outline([(-3, 0, "1/2"), (-2, 1), ("-5/2", 2, "-1/3")]),
        Polygon([(0, -4), (1, -3), (-1, -3)]),
    ]
    return sightseer(Scene(inside, start=(0, 0), enclosure=wall), radius=Fraction(9, 2))


@pytest.mark.parametrize("name", some(reversed([*gallery.names()]), 7))
def test_gallery_runs_come_back(name: str, tmp_path: Path) -> None:
    run = gallery_run(name)
    path = tmp_path / "run.json"
    path.write_text(json.dumps(run.to_json()), encoding="utf-8")
    assert_same(run, load_run(path))
    law_of_reading_back(run)


def law_of_reading_back(run: Run) -> None:
    """A run that is read back is written as the same text, and its sensing, repeated, finds the same map."""
    text = json.dumps(run.to_json())
    again = load_run(json.loads(text))
    assert json.dumps(again.to_json()) == text
    for k in range(len(run.map.obstacles)):
        assert again.map.known_length(k) == run.map.known_length(k)
    assert again.map.frontier == run.map.frontier
    found, before = again.memory.reports, run.memory.reports
    assert [(r.kind, r.obstacle, r.after) for r in found] == [(r.kind, r.obstacle, r.after) for r in before]


@pytest.mark.parametrize("subject", list(Subject), ids=lambda subject: subject.value)
@pytest.mark.parametrize("first", some(range(0, 60, 10), 1))
def test_random_runs_come_back(subject: Subject, first: int) -> None:
    for seed in range(first, first + 10):
        scene = random_scene(subject, seed)
        try:
            run = sightseer(scene) if subject is Subject.SIGHTSEER else seed_spreader(scene)
        except Undecided:
            continue
        law_of_reading_back(run)


def test_data_come_back_without_a_file() -> None:
    run = room()
    assert_same(run, load_run(run.to_json()))


def test_points_are_shared_and_the_path_is_connected() -> None:
    again = load_run(room().to_json())
    assert all(a.end is b.start for a, b in pairwise(again.path))


def test_the_file_stays_small() -> None:
    text = json.dumps(sightseer(random_octagons(50, seed=1)).to_json())
    assert len(text) < 1_000_000


def test_numbers_of_every_kind_come_back() -> None:
    two, three = Real(2).sqrt(), Real(3).sqrt()
    cubic = roots([-2, 0, 0, 1])[0]
    nested = (two + three + 1).sqrt()
    values = [
        Real("-7/3"), Real(10) ** 60 + Real("1e-60"), two / 3 - three, cubic**2 - cubic / 5 + 1, nested,
        (nested + cubic) * (nested - three), 1 / (nested + cubic), (nested * nested + cubic).sqrt(),
    ]  # fmt: skip
    out = Encoder()
    written = [out.number(value) for value in values]
    table = json.loads(json.dumps(out.table))
    decoder = Decoder(table, ViewLength.of_parts)
    for value, number in zip(values, written, strict=True):
        assert decoder.number(number) == value
    assert len(table) == len({json.dumps(entry) for entry in table}), "nothing is stored twice"


def test_a_transcendental_number_has_no_exact_text() -> None:
    circle = Arc(Point(1, 0), Point(1, 0), Point(0, 0), Fraction(1), ccw=True, full=True)
    with pytest.raises(FormatError, match="which is transcendental"):
        Encoder().number(circle.after(Length(1)).x)


def test_integers_longer_than_python_prints_come_back() -> None:
    long = Real(2 ** (1 << 14) + 1)
    assert len(str(long.rational)) > 4900
    values = [long, 1 / long, (long + Fraction(1, 2)).sqrt(), roots([-long, 0, 1, 1])[0] / long]
    out = Encoder()
    written = [out.number(value) for value in values]
    decoder = Decoder(out.table, ViewLength.of_parts)
    assert [decoder.number(number).compare(value) for number, value in zip(written, values, strict=True)] == [
        0
    ] * 4


def test_numbers_of_sixty_digits_come_back() -> None:
    """A round room, a hair off its place, around a lens: the reader refused what the run had written."""
    x, hair = Fraction(2887, 676), Fraction(1, 10**60)
    room = Outline([(x + 14 + hair, Fraction(9498, 845), 1), (x - 14 + hair, Fraction(9498, 845), 1)])
    lens = Outline([(0, 0, Fraction(-1, 10**9)), (Fraction(18, 5), Fraction(24, 5), Fraction(-1, 2))])
    run = sightseer(Scene([lens], enclosure=room, start=(Fraction(-831, 676), Fraction(-1, 2)), radius=60))
    assert load_run(run.to_json()).length == run.length


def test_decimals_stand_beside() -> None:
    document = gallery_run("circles").to_json()
    assert document["length"]["closed"] == "5 + 12*pi"
    assert document["events"][-1]["at"] == document["length"]["decimal"]


ONE_PLUS_ROOT = [["1", ["radical", "1"]], ["1", ["radical", "2"]]]
"""Its square's square's square doubles in length at every step."""

HIGH = [["1", ["root", ["-1", "-1", *["0"] * 37, "1"], 0, 1]], ["1", ["radical", "1"]]]
"""1 + x with x^39 = x + 1: its inverse plus 1, and the inverse of that plus 1, take long."""


LONG = [[str(3**8000 + k), ["root", ["-2", *["0"] * 59, "1"], 1, k]] for k in range(1, 60)]
"""An element of a field of degree 60, of coefficients with 3818 digits: its inverse takes minutes."""


def nested(k: int) -> list:
    """Entry k + 1 of the table: 1 + sqrt(number k)."""
    return [["1", ["radical", "1"]], ["1", ["sqrt", k]]]


def damaged(change):
    document = copy.deepcopy(gallery_run("m8").to_json())
    change(document)
    return document


@pytest.mark.parametrize(
    "change",
    [
        lambda d: d.pop("format"),
        lambda d: d.update(version=VERSION + 1),
        lambda d: d.pop("path"),
        lambda d: d.update(path=3),
        lambda d: d.update(numbers=[[["1", ["sqrt", "-1"]]]]),
        lambda d: d.update(numbers=[[["1", ["inverse", "0"]]]]),
        lambda d: d.update(numbers=[[["1", ["sqrt", 0]]]]),
        lambda d: d.update(numbers=[[["1", ["radical", "-2"]]]]),
        lambda d: d.update(numbers=[[["1", ["root", ["1", "0", "1"], 0, 1]]]]),
        lambda d: d.update(numbers=[[["1", ["root", ["1"] * 9999, 0, 1]]]]),
        lambda d: d.update(numbers=[[["1", ["logarithm", "2"]]]]),
        lambda d: d.update(numbers=[[["1/2x", ["radical", "2"]]]]),
        lambda d: d.update(numbers=[[["1", ["radical", "1/2"]]]]),
        pytest.param(
            lambda d: d.update(numbers=[ONE_PLUS_ROOT, *([["1", ["product", k, k]]] for k in range(99))]),
            marks=by_night,
        ),
        lambda d: d.update(numbers=[ONE_PLUS_ROOT, *(nested(k) for k in range(99))]),
        lambda d: d.update(numbers=[HIGH, *([["1", ["inverse", k]], HIGH[1]] for k in range(9999))]),
        lambda d: d.update(numbers=[LONG, [["1", ["inverse", 0]]]]),
        lambda d: d.update(numbers={}),
        lambda d: d.update(start=["0"]),
        lambda d: d.update(start=["nan", "0"]),
        lambda d: d.update(start=[10**6, "0"]),
        lambda d: d.update(visits=[99]),
        lambda d: d.update(radius="x"),
        lambda d: d["events"][0].update(after=10**9),
        lambda d: d["path"][0].update(kind="flight"),
        lambda d: d["scene"].pop("obstacles"),
    ],
)
def test_damage_is_one_clear_error(change) -> None:
    with pytest.raises(FormatError) as caught:
        load_run(damaged(change))
    assert "\n" not in str(caught.value)


def test_products_of_long_radicals_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """A few bytes stand for each, and many digits: without a bound a file of a megabyte took all memory."""
    monkeypatch.setattr(number_json, "MAX_TOTAL", 1 << 18)
    radicals = [[["1", ["radical", str(10**300 + 2 * k + 1)]]] for k in range(32)]
    products = [[["1", ["product", 2 * k, 2 * k + 1]]] for k in range(31)]
    again = [[["1", ["product", 62, k]]] for k in range(16)]
    Decoder([*radicals, *products], ViewLength.of_parts)
    with pytest.raises(FormatError, match="too large"):
        Decoder([*radicals, *products, *again], ViewLength.of_parts)


@pytest.mark.parametrize("content", [b"", b"{", b"\x00\xff", b"[" * 10**5, b'{"obstacles": []}', b"3"])
def test_files_that_are_no_runs(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "run.json"
    path.write_bytes(content)
    with pytest.raises(FormatError, match=r"run\.json"):
        load_run(path)
    with pytest.raises(FormatError, match="missing"):
        load_run(tmp_path / "missing.json")


def test_lengths_of_links_are_algebraic() -> None:
    for link in load_run(room().to_json()).links:
        assert link.length == Length((link.hit - link.leave).norm_sq().sqrt())
        assert isinstance(link.leave, Point)


def test_an_event_without_a_point_is_found_again() -> None:
    # Until version 5 zeros of functions were not written: the sensing is repeated to find the place.
    run = gallery_run("m11")
    document = run.to_json()
    blanked = [
        k for k, event in enumerate(document["events"]) if event["kind"] in ("sight", "lose", "acquire")
    ]
    for k in blanked:
        document["events"][k]["point"] = None
    again = load_run(document)
    assert len(blanked) > 3
    assert [event.point for event in again.events] == [event.point for event in run.events]
    assert again.map.known_length() == run.map.known_length()


@pytest.mark.parametrize("kind", ["hit", "sight"])
def test_a_point_that_sensing_cannot_find_is_refused(kind: str) -> None:
    document = gallery_run("m11").to_json()
    event = next(event for event in document["events"] if event["kind"] == kind)
    event["point"] = None
    event["obstacle"] = 2 if kind == "sight" else event["obstacle"]
    with pytest.raises(FormatError, match="no point" if kind == "hit" else "does not show"):
        load_run(document)


@pytest.mark.parametrize(
    ("part", "value", "what"),
    [
        (("encounters",), [99], "does not have"),
        (("diversions", 0, "last"), 10**9, "pieces that the path does not have"),
        (("scene", "terrain"), {"width": 1, "height": 1}, "outside the terrain"),
        (("radius",), "1/1000000000", "as wide as the radius"),
        (("radius",), "-1", "must be positive"),
        (("diversions",), 7, "not a run"),
        (("diversions", 0, "reason"), "a whim", "not a valid Reason"),
        (("strategy",), "sightseer", "has no 'links'"),
    ],
)
def test_broken_sweeps_are_refused(part: tuple[object, ...], value: object, what: str) -> None:
    document = json.loads(json.dumps(gallery_run("figure4").to_json()))
    place = document
    for key in part[:-1]:
        place = place[key]
    place[part[-1]] = value
    with pytest.raises((FormatError, InvalidScene), match=what):
        load_run(document)


@pytest.mark.parametrize(
    ("part", "value", "what"),
    [
        (("radius",), "9" * 400, "from 1/10.100 to 10.100"),
        (("path", 0, "start"), ["0", "9" * 400], "farther than"),
        (("path", 0, "end"), ["0", "0"], "from one place to another"),
        (("path", 2, "end"), ["3", "0"], "from one place to another"),
        (("path", 4, "arc", "full"), False, "from one place to another"),
        (("path", 4, "arc", "full"), "true", "true or false"),
        (("path", 1, "arc", "ccw"), 1, "true or false"),
        (("events", 0, "inside"), "false", "true or false"),
    ],
)
def test_what_would_fail_when_the_run_is_shown_is_refused(
    part: tuple[object, ...], value: object, what: str
) -> None:
    *places, last = part
    document = copy.deepcopy(gallery_run("circles").to_json())
    place = document
    for key in places:
        place = place[key]
    place[last] = value
    with pytest.raises((FormatError, InvalidScene), match=what):
        load_run(document)


@pytest.mark.parametrize("path", sorted(OLD.glob("version2-*.json")), ids=lambda path: path.stem)
def test_files_of_version_2_are_read(path: Path) -> None:
    """Their events say in words what fields say now: the words that the fields give are the same."""
    document = json.loads(path.read_text("utf-8"))
    run = load_run(path)
    strategy = sightseer if run.strategy == "sightseer" else seed_spreader
    assert [event.note for event in run.events] == [event["note"] for event in document["events"]]
    assert_same(run, strategy(run.scene, run.radius))


@pytest.mark.parametrize("path", sorted(OLD.glob("version3-*.json")), ids=lambda path: path.stem)
def test_files_of_version_3_are_read(path: Path) -> None:
    """What straight pieces touch is left out: the sensing is the same."""
    run = load_run(path)
    strategy = sightseer if run.strategy == "sightseer" else seed_spreader
    again = strategy(run.scene, run.radius)
    assert_same(run, again)
    assert run.map.known_length() == again.map.known_length()
    assert all("touches" not in piece for piece in run.to_json()["path"])


@pytest.mark.parametrize("path", sorted(OLD.glob("version5-*.json")), ids=lambda path: path.stem)
def test_files_of_version_5_are_read(path: Path) -> None:
    """Events without a point, as in one of them, are found again."""
    run = load_run(path)
    again = sightseer(run.scene, run.radius)
    assert_same(run, again)
    assert [(e.kind, e.obstacle, e.point) for e in run.events] == [
        (e.kind, e.obstacle, e.point) for e in again.events
    ]
    assert run.to_json()["version"] == VERSION


@pytest.mark.parametrize("note", ["from", "trapped", "from 0 S", "from 99", "overdue"])
def test_words_that_version_2_never_wrote_are_refused(note: str) -> None:
    document = json.loads((OLD / "version2-squares.json").read_text("utf-8"))
    event = next(event for event in document["events"] if event["kind"] == "hit")
    event["note"] = note
    if note == "overdue":
        event["kind"] = "overdue"
    with pytest.raises(FormatError):
        load_run(document)


def test_the_text_of_a_run_is_no_file_name() -> None:
    """The error says what to do instead of repeating the text."""
    run = gallery_run("squares")
    text = json.dumps(run.to_json())
    with pytest.raises(FormatError, match=r"give json\.loads of it") as caught:
        load_run(text)
    assert len(str(caught.value)) < 200
    assert load_run(json.loads(text)).length == run.length


def test_a_run_whose_numbers_have_great_heights_is_read() -> None:
    """A diversion from an irrational place: nested numbers, of few digits each, whose heights were added up.

    One of twelve sweeps of drawings with arcs was written and could not be read back.
    """
    part = Fraction(207107, 500000)
    spiral = [("3.9", "0.475", part), ("3.425", 0, part), ("4.15", "-0.725", part), ("5.125", "0.25", part)]
    spiral += [("3.9", "1.475"), ("3.9", "1.325", -part), ("4.975", "0.25", -part), ("4.15", "-0.575", -part)]
    spiral += [("3.575", 0, -part), ("3.9", "0.325")]
    tear = [("3.571", "4.838", "1.527525"), ("4.738", "3.671"), ("5.24", "4.951", "0.654654")]
    kidney = [("9.19", "8.158", "0.884725"), ("6.61", "8.158", 1), ("7.007", "8.11", "-0.884725")]
    shapes = [spiral, [*tear, ("4.851", "5.34")], [*kidney, ("8.793", "8.11")]]
    corner = Fraction("-2.7004554"), Fraction(-45149326689741, 16568560000000)
    terrain = Terrain(Fraction("13.8919011"), Fraction(232362377997081, 16568560000000), corner)
    scene = Scene([Outline(shape) for shape in shapes], terrain=terrain, radius=4)
    run = seed_spreader(scene, target="visible")
    document = run.to_json()
    assert (
        max(number.height_bound() for number in Decoder(document["numbers"], ViewLength.of_parts)._values)
        > 1e8
    )
    again = load_run(document)
    assert again.length == run.length
    assert [str(e.at.decimal(30)) for e in again.events] == [str(e.at.decimal(30)) for e in run.events]


def test_a_run_that_turns_where_a_view_leaves_the_range_comes_back() -> None:
    """The nearest frontier begins where a view of an arc is as long as the range, a zero of a function.

    Two of 139 runs could not be written.
    """
    cup = [(-4, -3, Around((0, 0))), (3, 4)]
    cup += [("12/5", "16/5", Around((0, 0), ccw=False)), ("-16/5", "-12/5")]
    plate = [("1/5", "3/20"), ("7/20", "-1/20"), ("3/4", "1/4"), ("3/5", "9/20")]
    shapes = [Outline(cup), Polygon(plate), Circle((-4, 0), "1/2")]
    run = explore(Scene(shapes, start=("-137/52", "213/65"), radius="81/20"), "nearest-frontier")
    assert '"zero"' in json.dumps(run.to_json()["numbers"])
    law_of_reading_back(run)


def test_a_run_is_written_alike_by_every_process() -> None:
    """Products were in the order of their factors' hashes, which are those of addresses."""
    program = "import exactacq as xa, json; print(json.dumps(xa.sightseer(xa.load('figure2')).to_json()))"
    texts = {subprocess.check_output([sys.executable, "-c", program]) for _ in range(3)}
    assert len(texts) == 1
    assert load_run(json.loads(texts.pop())) == gallery_run("figure2")
