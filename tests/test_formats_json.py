"""JSON scenes: numbers mean what is written, scenes come back equal, and bad files get one clear line."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from nightly import NIGHTLY

from exactacq.errors import ExactacqError, FormatError, InvalidScene
from exactacq.files import source
from exactacq.files.by_suffix import load
from exactacq.files.scene_json import scene_to_json
from exactacq.geometry.points import Point
from exactacq.numbers.real import rational
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Outline, Polygon, Shape, Terrain

SQUARE = '{"boundary": [[2, -1], [4, -1], [4, 1], [2, 1]]}'


def write(folder: Path, text: str | bytes, name: str = "scene.json") -> Path:
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def described(scene: Scene) -> tuple[object, ...]:
    """All that a scene was given, comparable."""
    start = None if scene.start is None else scene.start.rational
    return scene.shapes, scene.enclosure, start, scene.terrain, scene.radius, scene.name, scene.notes


# -- reading ---------------------------------------------------------------------------------------


def test_the_example_of_the_documentation(tmp_path: Path) -> None:
    text = """{"start": [0, 0], "radius": "21/2", "terrain": {"width": 20, "height": 10}, "obstacles": [
        {"name": "O1", "boundary": [[2, -1], [4, -1, "1/2"], ["4", "1.25"], [2, 1]]},
        {"name": "O2", "circle": {"center": [8, 0], "radius": 2}}]}"""
    scene = load(write(tmp_path, text))
    corners = [(2, -1), (4, -1, "1/2"), (4, "5/4"), (2, 1)]
    assert scene.shapes == (Outline(corners, "O1"), Circle((8, 0), 2, "O2"))
    assert scene.radius == rational("21/2")
    assert scene.terrain == Terrain(20, 10)
    assert scene.start == Point(0, 0)


@pytest.mark.parametrize(
    ("literal", "value"),
    [
        ("0.1", "1/10"),
        ("-0.30000000000000004", "-30000000000000004/100000000000000000"),
        ("1e-60", "1/" + "1" + 60 * "0"),
        ("12345678901234567890123.5", "24691357802469135780247/2"),
        ('"-7/3"', "-7/3"),
        ('" 1.25 "', "5/4"),
        ("2.5E+2", "250"),
    ],
)
def test_a_number_is_its_literal_text(tmp_path: Path, literal: str, value: str) -> None:
    scene = load(write(tmp_path, f'{{"start": [{literal}, 100], "obstacles": []}}'))
    assert scene.start is not None
    assert scene.start.rational == (rational(value), rational(100))


def test_an_enclosure_is_a_list_or_a_shape(tmp_path: Path) -> None:
    rows = "[[-9, -9], [9, -9], [9, 9], [-9, 9]]"
    plain = load(write(tmp_path, f'{{"enclosure": {rows}, "obstacles": [{SQUARE}]}}'))
    named = load(write(tmp_path, f'{{"enclosure": {{"name": "W", "boundary": {rows}}}, "obstacles": []}}'))
    disc = '{"enclosure": {"circle": {"center": [0, 0], "radius": 9}}, "obstacles": []}'
    assert plain.enclosure == Polygon([(-9, -9), (9, -9), (9, 9), (-9, 9)])
    assert plain.obstacles[-1].is_enclosure
    assert named.enclosure == Polygon([(-9, -9), (9, -9), (9, 9), (-9, 9)], "W")
    assert load(write(tmp_path, disc)).enclosure == Circle((0, 0), 9)


def test_a_start_overrides_the_files(tmp_path: Path) -> None:
    path = write(tmp_path, f'{{"start": [0, 0], "obstacles": [{SQUARE}]}}')
    for start in ((1, "1/3"), (Fraction(1), Fraction(1, 3)), Point(1, Fraction(1, 3))):
        scene = load(path, start=start)
        assert scene.start is not None
        assert scene.start.rational == (rational(1), rational("1/3"))


def test_a_byte_order_mark_is_no_error(tmp_path: Path) -> None:
    assert load(write(tmp_path, b'\xef\xbb\xbf{"obstacles": []}')).shapes == ()


# -- round trip ------------------------------------------------------------------------------------

small = st.fractions(min_value=Fraction(1, 4), max_value=Fraction(9, 8), max_denominator=10**6)
bulges = st.fractions(min_value=Fraction(-1, 9), max_value=Fraction(1, 9), max_denominator=10**9)
names = st.none() | st.text(max_size=12)


@st.composite
def shapes(draw: st.DrawFn, cell: int) -> Shape:
    """A shape well inside its own cell of a row, so that any list of them is a valid scene."""
    x, name = Fraction(10 * cell), draw(names)
    a, b = draw(small), draw(small)
    corners = [(x - a, -b), (x + a, -b), (x + b, a), (x - b, b)]
    match draw(st.sampled_from(["polygon", "outline", "straight outline", "circle"])):
        case "polygon":
            return Polygon(corners, name)
        case "outline":
            return Outline([(*corner, draw(bulges)) for corner in corners], name)
        case "straight outline":
            return Outline(corners, name)
        case _:
            return Circle((x + a, b), a, name)


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    count = draw(st.integers(0, 4))
    wall = Polygon([(-50, -50), (90, -50), (90, 50), (-50, 50)], draw(names))
    number = st.fractions(min_value=10, max_value=20, max_denominator=10**30)
    return Scene(
        [draw(shapes(cell)) for cell in range(count)],
        start=draw(st.none() | st.tuples(number, number)),
        enclosure=draw(st.sampled_from([None, wall, Outline(wall.vertices, "round"), Circle((20, 0), 45)])),
        radius=draw(st.none() | number),
        terrain=draw(st.sampled_from([None, Terrain(Fraction(700, 3), 900)])),
        name=draw(names),
        notes=draw(st.lists(st.text(max_size=9), max_size=2)),
    )


@given(scenes())
def test_written_and_read_again_a_scene_is_equal(
    tmp_path_factory: pytest.TempPathFactory, scene: Scene
) -> None:
    document = scene_to_json(scene)
    path = write(tmp_path_factory.mktemp("json"), json.dumps(document))
    again = load(path)
    assert described(again) == described(scene)
    assert scene_to_json(again) == document


def test_an_irrational_start_cannot_be_written() -> None:
    from exactacq.numbers.real import Real

    with pytest.raises(FormatError, match="start is not a rational point"):
        scene_to_json(Scene([], start=Point(Real(2).sqrt(), 0)))


# -- bad input -------------------------------------------------------------------------------------

BAD = {
    "": "the file is empty",
    " \n": "the file is empty",
    "[]": "the scene: an object is needed, not a list",
    "{}": 'the scene has no "obstacles"',
    '{"obstacles": [}': "line 1, column 16: not JSON",
    '{"obstacles": []} x': "line 1, column 19: not JSON",
    '{"obstacles": [], "obstacles": []}': "key 'obstacles' stands twice",
    '{"obstacles": [], "start ": [0, 0]}': "unknown key 'start '",
    '{"obstacles": {}}': "obstacles: a list is needed, not an object",
    '{"obstacles": [[1, 2]]}': r"obstacles\[0\]: an object is needed, not a list",
    '{"obstacles": [{"boundry": []}]}': "unknown key 'boundry'; known are name, boundary, circle",
    '{"obstacles": [{}]}': 'either a "boundary" or a "circle"',
    '{"obstacles": [{"circle": {"center": [0, 0]}}]}': r'obstacles\[0\].circle: "radius" is missing',
    '{"obstacles": [{"circle": {"center": 1, "radius": 1}}]}': "circle.center: a list is needed",
    '{"obstacles": [{"boundary": [[1]]}]}': r"boundary\[0\]: \[x, y\] or \[x, y, bend\] is needed",
    '{"obstacles": [{"boundary": [[1, true]]}]}': r"boundary\[0\]\[1\]: a number is needed, not true",
    '{"obstacles": [{"boundary": [[1, NaN]]}]}': r"boundary\[0\]\[1\]: not a number: 'NaN'",
    '{"obstacles": [], "radius": -Infinity}': "radius: not a number: '-Infinity'",
    '{"obstacles": [], "radius": "ten"}': "radius: not a number: 'ten'",
    '{"obstacles": [], "radius": "1/0"}': "radius: division by zero",
    '{"obstacles": [], "radius": 1e999999}': "radius: number out of range",
    '{"obstacles": [], "start": [0, 0, 0]}': r"start: \[x, y\] is needed, not 3 values",
    '{"obstacles": [], "name": 5}': "name: a text is needed, not a number",
    '{"obstacles": [], "notes": [null, {}]}': r"notes\[1\]: a text is needed, not an object",
    '{"obstacles": [], "terrain": [1, 2]}': "terrain: an object is needed",
}


@pytest.mark.parametrize("text", BAD)
def test_bad_text_is_one_line_with_place_and_reason(tmp_path: Path, text: str) -> None:
    path = write(tmp_path, text)
    with pytest.raises(FormatError, match=BAD[text]) as caught:
        load(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b'{"obstacles": [], "name": "\xff"}', "byte 27 is not UTF-8"),
        (bytes(range(256)) * 100, "not UTF-8|not JSON"),
        (b"[" * 100_000, "nested too deeply"),
        (b'{"a":' * 100_000, "nested too deeply"),
        (b'{"obstacles": [], "radius": ' + b"7" * 100_000 + b"}", "radius: not a number: '7777"),
        (b'{"obstacles": [' + b"1," * 2_000_000 + b"1]}", "more than 200000 edges"),
        (b"{" + b",".join(b'"%d": 0' % (k % 999_999) for k in range(1_000_000)) + b"}", "'0' stands twice"),
    ],
)
def test_noise_is_refused_quickly(tmp_path: Path, content: bytes, message: str) -> None:
    with pytest.raises(FormatError, match=message) as caught:
        load(write(tmp_path, content))
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize(
    ("name", "place"),
    [
        (r"\ud800", "line 2, column 2"),
        (r"\\\\\uDFFF", "line 2, column 6"),
        (r"a\ude42\ud83d", "line 2, column 3"),
        (r"\ud83d\ud83d\ude42", "line 2, column 2"),
    ],
)
def test_half_a_character_is_refused_with_its_place(tmp_path: Path, name: str, place: str) -> None:
    """It was taken, and then could not be written to any file."""
    path = write(tmp_path, f'{{"obstacles": [], "name":\n"{name}"}}')
    with pytest.raises(FormatError, match=rf"scene.json: {place}: \\u[\w]{{4}} is half of a character"):
        load(path)


@pytest.mark.parametrize(
    ("name", "value"), [(r"\ud83d\ude42", "\U0001f642"), (r"\\ud800", r"\ud800"), (r"\u00e9\n", "é\n")]
)
def test_whole_characters_may_be_escaped(tmp_path: Path, name: str, value: str) -> None:
    assert load(write(tmp_path, f'{{"obstacles": [], "name": "{name}"}}')).name == value


def test_too_many_edges_are_refused_before_validation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    most = source.MAX_EDGES if NIGHTLY else 20_000
    monkeypatch.setattr(source, "MAX_EDGES", most)
    rows = ",".join([*["[0,0]"] * most, "[1,0]"])
    with pytest.raises(FormatError, match=f"{most + 1} edges are more than the {most}"):
        load(write(tmp_path, f'{{"obstacles": [{{"boundary": [{rows}]}}]}}'))


def test_a_scene_that_breaks_the_rules_is_invalid_not_malformed(tmp_path: Path) -> None:
    crossing = '{"obstacles": [{"boundary": [[0, 0], [1, 1], [1, 0], [0, 1]]}], "radius": 0}'
    with pytest.raises(InvalidScene) as caught:
        load(write(tmp_path, crossing))
    assert len(caught.value.violations) >= 2


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("missing.json", "no such file"),
        ("folder.json", "is a directory"),
        ("scene.doc", "unknown file type '.doc'; files that are read end in .json"),
        ("scene", "a file name without a type"),
        ("nul\0.json", "cannot be read"),
        ("x" * 5000 + ".json", "cannot be read"),
    ],
)
def test_a_file_that_is_none(tmp_path: Path, name: str, message: str) -> None:
    (tmp_path / "folder.json").mkdir()
    with pytest.raises(FormatError, match=message) as caught:
        load(str(tmp_path / name))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "options", [{"layers": ["A"]}, {"outer": "drop"}, {"tolerance": 1}, {"union": True}, {"start": (1, "x")}]
)
def test_options_that_make_no_sense(tmp_path: Path, options: dict[str, object]) -> None:
    with pytest.raises(FormatError):
        load(write(tmp_path, '{"obstacles": []}'), **options)  # type: ignore[arg-type]


@given(
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(max_size=5),
        lambda inner: (
            st.lists(inner, max_size=3)
            | st.dictionaries(
                st.sampled_from(
                    [
                        "obstacles",
                        "start",
                        "boundary",
                        "circle",
                        "radius",
                        "center",
                        "enclosure",
                        "terrain",
                        "width",
                        "height",
                        "name",
                        "notes",
                    ]
                ),
                inner,
                max_size=3,
            )
        ),
        max_leaves=12,
    )
)
def test_no_document_gets_past_the_named_errors(
    tmp_path_factory: pytest.TempPathFactory, document: object
) -> None:
    path = write(tmp_path_factory.mktemp("fuzz"), json.dumps(document))
    try:
        load(path)
    except ExactacqError as error:
        assert "\n" not in str(error)
