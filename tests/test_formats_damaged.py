"""Damaged files of every format: each is read, or refused in one line, in bounded time.

`EXACTACQ_MUTATIONS` asks for more than the everyday number; `fuzz_files` reads thousands of each format,
within limits of memory and time. What that found is in the cases below.
"""

from __future__ import annotations

import json
import os
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest
from hostile_files import LAUGHS, OUTSIDE, Kind, dxf_of, hostile, kinds, put, read
from hostile_structures import STRUCTURES, structured
from hostile_trees import text
from nightly import NIGHTLY

import exactacq as xa
from exactacq.files.loops import nesting
from exactacq.files.repairs import flattened
from exactacq.files.svg.document import parse
from exactacq.scene import validation

COUNT = int(os.environ.get("EXACTACQ_MUTATIONS", "60" if NIGHTLY else "8"))
SECONDS = 20
"""More than any file may take, on a busy machine too; most take milliseconds."""
LONGEST = 1000
"""Most characters of a message; that of an invalid scene lists all violations."""
KINDS = kinds()
RUN = KINDS["run"].samples[3]
"""A run around a circle and a triangle."""
Maker = Callable[[Kind, int, str], tuple[bytes, dict[str, object]]]


def test_every_format_that_is_read_has_samples() -> None:
    suffixes = {kind.suffix for kind in KINDS.values()}
    for known in xa.formats():
        assert known.reader is None or suffixes.intersection(known.suffixes), known.name


@pytest.mark.parametrize("name", KINDS)
def test_the_samples_are_read(tmp_path: Path, name: str) -> None:
    kind = KINDS[name]
    for sample in kind.samples:
        options = {"border": "open"} if name == "movingai" else {}
        options |= {"flatten": 1} if b"C15" in sample else {}
        try:
            read(name, put(kind, tmp_path, sample), {"start": (1000, 1000), **options})
        except xa.InvalidScene as error:  # the start lies outside the wall: the file itself is read
            assert name in ("visilibity", "json") and "start" in str(error)


@pytest.mark.parametrize("name", KINDS)
def test_the_samples_are_read_when_taken_apart_and_put_together(tmp_path: Path, name: str) -> None:
    """Otherwise most changes by structure would get no further than the parser."""
    kind, parse = KINDS[name], STRUCTURES[name].parse
    for sample in kind.samples:
        options = {"start": (1000, 1000), "border": "open"} if name == "movingai" else {"start": (1000, 1000)}
        options |= {"flatten": 1} if b"C15" in sample else {}
        seen = []
        for data in (sample, text(parse(sample))):
            try:
                read(name, put(kind, tmp_path, data), options)
                seen.append("")
            except xa.InvalidScene as error:
                seen.append(str(error))
        assert seen[0] == seen[1]


@pytest.mark.parametrize("made", [hostile, structured])
@pytest.mark.parametrize("name", KINDS)
def test_damaged_files_end_in_one_line(
    tmp_path: Path, name: str, made: Maker, capfd: pytest.CaptureFixture[str]
) -> None:
    kind, refused = KINDS[name], 0
    whole = len(kind.bombs)
    for n in range(whole, whole + COUNT):
        data, options = made(kind, n, name)
        path = put(kind, tmp_path, data)
        begun = time.process_time()
        try:
            read(name, path, options)
        except xa.ExactacqError as error:
            refused += 1
            assert "\n" not in str(error), n
            assert isinstance(error, xa.InvalidScene) or len(str(error)) < LONGEST, n
        except Exception as error:
            error.add_note(f"no. {n}: {data[:2000]!r}, {options}")
            raise
        assert time.process_time() - begun < SECONDS, n
    assert refused, "no mutation did harm: the test is void"
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("name", [name for name, kind in KINDS.items() if kind.bombs])
def test_files_that_are_known_to_hurt(tmp_path: Path, name: str) -> None:
    """Nested without end, expanding without end, declaring more than they hold."""
    kind = KINDS[name]
    for bomb in kind.bombs:
        begun = time.process_time()
        try:
            read(name, put(kind, tmp_path, bomb), {"start": (1000, 1)})
        except xa.ExactacqError as error:
            assert "\n" not in str(error) and len(str(error)) < LONGEST
        assert time.process_time() - begun < SECONDS


@pytest.mark.parametrize("data", [LAUGHS, OUTSIDE], ids=["expanding", "outside"])
def test_no_entity_is_expanded(tmp_path: Path, data: bytes) -> None:
    with pytest.raises(xa.FormatError, match=r"it declares the entity '.'; save it without"):
        read("svg", put(KINDS["svg"], tmp_path, data), {})


def test_values_that_a_dtd_gives_to_all_elements_are_not_taken() -> None:
    """Such a value is a new text for each element: a megabyte of file became gigabytes."""
    dtd = f'<!DOCTYPE svg [<!ATTLIST g id CDATA "{"x" * 100_000}">]>'
    tracemalloc.start()
    root = parse(f"{dtd}<svg>{'<g/>' * 1000}</svg>".encode())
    memory = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(root.parts) == 1000 and memory < 10_000_000


SHAPE = '<path d="M0 0h9v9z"/>'
USE = '<use href="#a"/>'
LONG = 10_000


@pytest.mark.parametrize(
    ("body", "told"),
    [
        (f'<g id="a">{1000 * "<text/>"}</g>{1000 * USE}', "more than 400000 elements are drawn"),
        (f'<g id="a" name="{LONG * "a"}"/>{7000 * USE}', "more than 67108864 characters of elements"),
        (f'<rect width="{5 * LONG * "1"}!" height="1"/>', "width: a number"),
        (f'<path id="a" d="{LONG * "M0 0"}"/>{1000 * USE}', ""),
        (f'<g id="a" style="{LONG * "a:b;"}"/>{1500 * USE}', ""),
    ],
    ids=["texts", "names", "digits", "paths", "styles"],
)
def test_what_is_used_again_and_again_in_a_drawing(tmp_path: Path, body: str, told: str) -> None:
    """What shows nothing did not count, and paths and styles were read once more for each use."""
    path = put(KINDS["svg"], tmp_path, f"<svg>{body}{SHAPE}</svg>".encode())
    begun = time.process_time()
    try:
        assert len(xa.load(path, start=(-1, -1)).obstacles) == 1 and not told
    except xa.FormatError as error:
        assert told and told in str(error)
    assert time.process_time() - begun < SECONDS


# -- what thousands of each format found --------------------------------------------------------------


def svg(tmp_path: Path, body: str, **options: object) -> xa.Scene:
    path = put(Kind(".svg", ()), tmp_path, f'<svg viewBox="0 0 90 90">{body}</svg>'.encode())
    return xa.load(path, start=(-9, "-9.5"), **options)


def test_a_path_through_one_corner_many_times(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """To find paths drawn twice, all their rotations that begin in the least corner were compared."""
    monkeypatch.setattr(validation, "MET", validation.MET if NIGHTLY else 1000)
    begun = time.process_time()
    with pytest.raises(xa.InvalidScene):
        svg(tmp_path, f'<path d="M0 0{"l5 0 0 5-5-5" * 1500}z"/>')
    assert time.process_time() - begun < SECONDS


def test_moves_of_more_digits_than_python_writes_out(tmp_path: Path) -> None:
    """How far a point moved at most was told by way of all its digits."""
    end = f"0.{'0' * 4900}1"
    (triangle,) = svg(tmp_path, f'<path d="M0 0h9v9L{end} {end}"/>', tolerance=1).shapes
    assert len(triangle.vertices) == 3


@pytest.mark.parametrize("option", ["flatten", "thicken", "tolerance"])
def test_long_numbers_are_not_written_out_in_messages(tmp_path: Path, option: str) -> None:
    with pytest.raises(xa.FormatError, match=r"not -1000000000000?\.\.\.0+$"):
        svg(tmp_path, '<path d="M0 0C5 9 9 5 9 0M0 0h3"/>', **{"flatten": 1, option: -(10**4000)})


def test_curves_under_transforms_of_long_numbers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each arc takes longer, so fewer are found before the rest is refused."""
    depth, most = (30, 4000) if NIGHTLY else (16, 400)
    turned = '<g transform="rotate(30) scale(2 1)">' * depth
    monkeypatch.setattr(flattened, "MAX_MADE", most)
    begun = time.process_time()
    with pytest.raises(xa.FormatError, match=f"more than {most} arcs"):
        svg(tmp_path, turned + '<path d="M1 1C15 30 30 30 30 10"/>' + "</g>" * depth, flatten="1e-3")
    assert time.process_time() - begun < SECONDS


def test_one_loop_over_and_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All pairs of edges meet, at few places: the search for violations stops, and nothing is merged."""
    few, many = (500, 1000) if NIGHTLY else (150, 300)
    monkeypatch.setattr(nesting, "MAX_COMPARED", few * few // 3)
    path = put(KINDS["wkt"], tmp_path, f"POLYGON({','.join(['(0 0, 4 0, 1 3, 0 0)'] * few)})".encode())
    begun = time.process_time()
    with pytest.raises(xa.ExactacqError, match=r"pairs of edges nearly meet; select"):
        xa.load(path, start=(9, 9), union=True)
    path = put(KINDS["visilibity"], tmp_path, b"//\n0 0\n9 0\n9 9\n0 9\n" + b"//\n1 1\n2 1\n2 2\n" * many)
    with pytest.raises(xa.InvalidScene) as error:
        xa.load(path, start=(8, 8))
    assert len(error.value.violations) < 60
    assert time.process_time() - begun < 2 * SECONDS


def test_the_union_with_an_arc_that_is_nearly_straight(tmp_path: Path) -> None:
    """Its bulge was enclosed too widely to tell that it is positive."""
    text = (
        "MULTISURFACE(CURVEPOLYGON(CIRCULARSTRING(1 1e-99, 2 1, 1 1, 0 1, 1 1e-99)), "
        "CURVEPOLYGON(COMPOUNDCURVE((0 0, 4 0), CIRCULARSTRING(4 0, 1e9 1, 4 2), (4 2, 0 2, 0 0))))"
    )
    path = put(KINDS["wkt"], tmp_path, text.encode())
    try:
        assert xa.load(path, start=(-9, 9), union=True).obstacles
    except xa.ExactacqError as error:
        assert "\n" not in str(error)


def test_values_in_messages_are_short(tmp_path: Path) -> None:
    """Nested ones were written out whole, and so were integers of thousands of digits."""
    nested = b'{"a":' * 300 + b"1" + b"}" * 300
    text = b'{"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [%b, 4], [0, 0]]]}' % nested
    with pytest.raises(xa.FormatError, match="not a number: ") as error:
        xa.load(put(KINDS["geojson"], tmp_path, text), start=(9, 9))
    assert len(str(error.value)) < len(str(tmp_path)) + 200
    for part, value in (("after", 10**4000), ("radius", -(10**4000)), ("version", 10**4000)):
        run = json.loads(RUN)
        (run["events"][0] if part == "after" else run)[part] = value
        with pytest.raises(xa.FormatError, match="000") as error:
            xa.load_run(put(KINDS["run"], tmp_path, json.dumps(run).encode()))
        assert len(str(error.value)) < len(str(tmp_path)) + 200


def test_what_is_no_image_is_refused_without_names_of_objects(tmp_path: Path) -> None:
    with pytest.raises(xa.FormatError, match=r"not a readable image .of no known kind, or damaged"):
        xa.load(put(KINDS["png"], tmp_path, b"\x89PNG\r\n\x1a\n" + bytes(99)), start=(9, 9))


@pytest.mark.parametrize("x", ["99", "4000001/1000000"])
def test_arcs_of_a_path_end_on_their_circles(tmp_path: Path, x: str) -> None:
    """Otherwise their lengths, asked for later, were an internal error."""
    run = json.loads(RUN)
    arc = next(piece["arc"] for piece in run["path"] if "arc" in piece)
    arc["center"][0] = x
    with pytest.raises(xa.FormatError, match="an arc of the path does not end on its circle"):
        xa.load_run(put(KINDS["run"], tmp_path, json.dumps(run).encode()))


def test_events_within_arcs_lie_on_their_circles(tmp_path: Path) -> None:
    run = json.loads(RUN)
    k, piece = next((k, piece) for k, piece in enumerate(run["path"]) if "arc" in piece)
    event = {"kind": "sight", "obstacle": 1, "point": ["1/3", "1/7"], "after": k, "inside": True}
    run["events"] = [event]
    with pytest.raises(xa.FormatError, match="an event does not lie on the arc of the path that it names"):
        xa.load_run(put(KINDS["run"], tmp_path, json.dumps(run).encode()))
    run["events"] = [event | {"point": piece["start"]}]
    assert xa.load_run(put(KINDS["run"], tmp_path, json.dumps(run).encode())).to_json()


def test_a_path_beside_the_boundary_has_no_map(tmp_path: Path) -> None:
    run = json.loads(RUN)
    square = next(
        k for k, piece in enumerate(run["path"]) if piece["kind"] == "boundary" and "arc" not in piece
    )
    run["path"][square]["end"] = ["1/3", "1/7"]
    found = xa.load_run(put(KINDS["run"], tmp_path, json.dumps(run).encode()))
    with pytest.raises(xa.FormatError, match="no edge of the boundary carries"):
        _ = found.map


def test_a_drawing_without_entities_and_with_damaged_layouts(tmp_path: Path) -> None:
    """What is on paper is asked for where the model is empty, and there ezdxf meets the damage."""
    data = (Path(__file__).parent / "data" / "issue21.dxf").read_bytes()
    path = put(KINDS["dxf"], tmp_path, data[:16405] + 3 * data[14291:16405] + data[16405:])
    with pytest.raises(xa.FormatError, match="a damaged entity"):
        xa.load(path, start=(0, 0))


def test_a_text_with_a_line_separator_of_unicode_in_a_drawing_without_a_header(tmp_path: Path) -> None:
    """Its line was taken apart there, so that the file counted as damaged."""
    text = ("TEXT", 10, 0.0, 20, 0.0, 40, 1.0, 1, "one\u2028two")
    path = put(KINDS["dxf"], tmp_path, dxf_of(text, ("CIRCLE", 10, 0.0, 20, 0.0, 40, 1.0)))
    scene = xa.load(path, start=(5, 5))
    assert len(scene.obstacles) == 1 and "damaged" not in " ".join(scene.notes)
