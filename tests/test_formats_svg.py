"""SVG drawings: arcs that are exact, transforms, groups, hidden parts, and hostile or broken files."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import pytest
from flint import fmpq
from hypothesis import assume, given
from hypothesis import strategies as st
from nightly import NIGHTLY

import exactacq as xa
from exactacq.files import source
from exactacq.files.loops.rational_arcs import arc_around, arc_of_radius
from exactacq.files.svg import document, load, path_data, transforms

DATA = Path(__file__).parent / "data"
FAR = (1000, 1000)


def read(folder: Path, content: str, start: object = FAR, root: str = "", **options: object) -> xa.Scene:
    path = folder / "drawing.svg"
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {root}>{content}</svg>')
    return xa.load(path, start=start, **options)


def areas(scene: xa.Scene) -> list[str]:
    return [str(obstacle.area) for obstacle in scene.obstacles]


def test_icons_with_quarter_circles_are_exact() -> None:
    for name in ("boombox", "keyboard", "calculator"):
        scene = xa.load(DATA / f"{name}.svg", start=(-1, -1))
        assert not any("moved" in note for note in scene.notes), name
    assert areas(scene) == ["4*pi + 176"]  # 12 by 16, with corners of radius 2


def test_a_run_inside_an_icon() -> None:
    scene = xa.load(DATA / "keyboard.svg", start=("3/2", 5), outer="room")
    assert scene.enclosure is not None and len(scene.obstacles) > 10
    run = xa.sightseer(scene, 3)
    assert run.visits
    xa.audit(run, samples=64 if NIGHTLY else 16)


radii = st.fractions("1/100", 50, max_denominator=100)
coordinates = st.fractions(-20, 20, max_denominator=50)


def exact(value: object) -> fmpq:
    return fmpq(value.numerator, value.denominator)  # type: ignore[attr-defined]


@given(coordinates, coordinates, coordinates, coordinates, radii, st.booleans(), st.booleans())
def test_an_arc_by_its_radius_is_that_of_the_standard(
    x: object, y: object, u: object, v: object, r: object, large: bool, sweep: bool
) -> None:
    """The oracle is the formula of SVG's appendix in floats: centre, then the angle swept."""
    x, y, u, v, r = map(exact, (x, y, u, v, r))
    assume((x, y) != (u, v))
    edge = arc_of_radius((x, y), (u, v), r, large, sweep)
    ax, ay, bx, by, radius = (float(n.p) / float(n.q) for n in (x, y, u, v, r))
    half = math.dist((ax, ay), (bx, by)) / 2
    assume(abs(radius / half - 1) > 1e-6)
    angle = math.pi if radius < half else 2 * math.asin(half / radius)
    angle = 2 * math.pi - angle if large and radius > half else angle
    wanted = math.tan(angle / 4) * (1 if sweep else -1)
    found = float(edge.bulge.p) / float(edge.bulge.q)
    assert found == pytest.approx(wanted, rel=1e-6)
    assert edge.bulge_shift <= abs(edge.bulge) / 2**40
    if edge.center is not None:
        assert sum((a - b) ** 2 for a, b in zip(edge.center, (x, y), strict=True)) == max(r * r, 0)


@given(coordinates, coordinates, coordinates, coordinates, st.booleans())
def test_a_bulge_near_an_irrational_one_is_within_its_bound(
    x: object, y: object, u: object, v: object, ccw: bool
) -> None:
    """A quarter turn and others about (0, 0): the square roots are told by squaring."""
    x, y, u, v = map(exact, (x, y, u, v))
    norm = x * x + y * y
    assume(norm and (u * u + v * v))
    turned = (
        (x * (u * u - v * v) - 2 * u * v * y) / (u * u + v * v),
        (y * (u * u - v * v) + 2 * u * v * x) / (u * u + v * v),
    )
    assume(turned != (x, y))
    edge = arc_around((x, y), turned, (fmpq(0), fmpq(0)), ccw)
    dx, dy = turned[0] - x, turned[1] - y
    slope = 2 * (dy * x - dx * y) / (dx * dx + dy * dy)
    slope = slope if ccw else -slope

    def sign(b: fmpq) -> fmpq:
        return b * b + 2 * slope * b - 1

    size = abs(edge.bulge)
    assert (edge.bulge > 0) == ccw
    if edge.center is None:
        assert sign(size) == 0
    else:
        assert sign(size - edge.bulge_shift) <= 0 <= sign(size + edge.bulge_shift)


@pytest.mark.parametrize(
    ("content", "area"),
    [
        ('<rect x="1" y="2" width="4" height="3"/>', "12"),
        ('<rect width="4" height="3" rx="1"/>', "pi + 8"),
        ('<rect width="4" height="4" rx="2"/>', "4*pi"),
        ('<circle cx="1" cy="2" r=".5"/>', "pi/4"),
        ('<ellipse cx="1" cy="2" rx="2" ry="2"/>', "4*pi"),
        ('<polygon points="0,0 4,0 4,4"/>', "8"),
        ('<polygon points="0 0-4 0-4-4"/>', "8"),
        ('<polyline points="0,0 4,0 4,4 0,0"/>', "8"),
        ('<path d="M0 0h4v4z"/>', "8"),
        ('<path d="m0,0 4,0 0,4z"/>', "8"),
        ('<path d="M0 0L4 0 4 4Z"/>', "8"),
        ('<path d="M0 0a1 1 0 0 1 2 0z"/>', "pi/2"),
        ('<path d="M0 0A1 1 0 012 0z"/>', "pi/2"),
        ('<path d="M0 0a.1.1 0 0 1 2 0z"/>', "pi/2"),
        ('<path d="M0 0a1 1 45 1 1 1 1h-1z"/>', "1 + 3*pi/4"),
        ('<path d="M0 0a0 1 0 0 1 2 0v2z"/>', "2"),
        ('<path d="M0 0a1 1 0 0 0 0 0h4v4z"/>', "8"),
        ('<line x2="4"/><line x1="4" x2="4" y2="4"/><path d="M4 4L0 0"/>', "8"),
        ('<g transform="scale(2)"><circle r="1"/></g>', "4*pi"),
        ('<g transform="scale(2 -2)"><path d="M0 0a1 1 0 0 1 2 0z"/></g>', "2*pi"),
        (
            '<g transform="rotate(90)"><g transform="translate(1,2)"><rect width="4" height="3"/></g></g>',
            "12",
        ),
        ('<g transform="matrix(3 4 -4 3 0 0)"><circle r="1"/></g>', "25*pi"),
        ('<g transform="matrix(1 1 -1 1 0 0)"><circle r="1"/></g>', "2*pi"),
        ('<rect width="4" height="3" transform="skewX(45)"/>', None),
        ('<rect width="4" height="3" transform="rotate(30 1 1)"/>', "12"),
        ('<g transform="rotate(33.3) scale(1,2)"><rect width="4" height="3"/></g>', "24"),
        ('<rect width="4" height="3" transform="scale(1,2) skewY(45)"/>', "24"),
        ('<svg:rect xmlns:svg="http://www.w3.org/2000/svg" width="4" height="3"/>', "12"),
    ],
)
def test_shapes_and_transforms(tmp_path: Path, content: str, area: str | None) -> None:
    found = areas(read(tmp_path, content))
    assert len(found) == 1 and area in (None, found[0])


def test_y_goes_up_in_the_same_box(tmp_path: Path) -> None:
    triangle = '<polygon points="1,1 3,1 1,2"/>'
    for root, wanted in (
        ('viewBox="0 0 10 8"', {(1, 7), (3, 7), (1, 6)}),
        ('viewBox="0 -2 10 8"', {(1, 3), (3, 3), (1, 2)}),
        ('width="10" height="8px"', {(1, 7), (3, 7), (1, 6)}),
        ('width="10in" height="8in"', {(1, 767), (3, 767), (1, 766)}),
        ('width="100%" height="100%"', {(1, -1), (3, -1), (1, -2)}),
    ):
        (shape,) = read(tmp_path, triangle, root=root).shapes
        assert {(x, y) for x, y, _ in shape.vertices} == wanted


def test_arcs_turn_the_way_they_are_drawn(tmp_path: Path) -> None:
    """sweep 1 is clockwise on the screen: the half disc lies above its chord, where y is larger."""
    (shape,) = read(tmp_path, '<path d="M0 5a1 1 0 0 1 2 0z"/>', root='viewBox="0 0 10 10"').obstacles
    assert shape.locate(xa.Point(1, "11/2")) is xa.Scene([xa.Circle((1, 5), 1)]).obstacles[0].locate(
        xa.Point(1, 5)
    )


def test_a_path_that_is_closed_where_it_began_needs_no_repair(tmp_path: Path) -> None:
    """Programs draw the last edge and close, too; an edge without length was told as taken out."""
    content = '<path d="M0 0h9v9L0 0zM20 0a5 5 0 0 1 10 0a5 5 0 0 1-10 0z"/><path d="M40 0q9 0 9 9L40 0z"/>'
    scene = read(tmp_path, content, flatten="1/100")
    assert len(scene.obstacles) == 3 and not any("took out" in text for text in scene.notes)


def test_layers_are_groups_and_elements(tmp_path: Path) -> None:
    content = """<g id="walls"><rect id="a" width="4" height="3"/></g>
    <g inkscape:label="Holes"><g><circle cx="20" r="1"/></g></g><circle cx="30" r="1"/>"""
    root = 'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
    for layers, found in (
        (None, ["12", "pi", "pi"]), ("walls", ["12"]), (["A"], ["12"]), (["holes", "a"], ["12", "pi"]),
        ("without a name", ["pi"]),
    ):  # fmt: skip
        assert areas(read(tmp_path, content, root=root, layers=layers)) == found
    with pytest.raises(xa.FormatError, match=r"no layer 'roof'; it has 'a' \(1\)"):
        read(tmp_path, content, root=root, layers="roof")


def test_what_is_hidden_or_not_drawn_is_left_out(tmp_path: Path) -> None:
    content = """<defs><rect width="9" height="9"/></defs><clipPath><circle r="9"/></clipPath>
    <text>hello</text>    <g display="none"><rect width="9" height="9"/></g>
    <rect style="fill:red;display: none" width="9" height="9"/>
    <use href="#a"/><circle r="0"/><rect width="0" height="9"/><circle r="1"/>
    <rect transform="scale(0)" width="1" height="1"/><path d=""/><polyline points="1,2"/>"""
    scene = read(tmp_path, content)
    assert areas(scene) == ["pi"]
    assert set(scene.notes[0].removeprefix("left out ").split(", ")) == {
        "1 text", "2 hidden elements", "1 use of what the file does not have", "1 circle of no radius",
        "1 flattened rect",
    }  # fmt: skip


def test_of_a_switch_what_asks_for_nothing_is_shown(tmp_path: Path) -> None:
    scene = read(
        tmp_path,
        """<switch><title/><circle systemLanguage="de" r="1"/><circle r="2"/><circle r="3"/></switch>
        <switch><foreignObject requiredExtensions="x"/><g><circle cx="9" r="1"/></g></switch>
        <switch><defs/><circle systemLanguage="de" cx="20" r="3"/></switch>""",
        root='transform="scale(2)"',
    )
    assert areas(scene) == ["4*pi", "pi", "9*pi"]
    assert scene.notes == ("left out 3 other choices of a switch, 1 transform of the whole drawing",)


BOMB = '<!DOCTYPE svg [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><svg><text>&b;</text></svg>'


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('<path d="M0 0c1 1 2 2 3 3z"/>', "line 1: path: a cubic Bézier curve is not read"),
        ('<path id="p" d="M0 0Q1 1 2 2z"/>', "path p: a quadratic Bézier curve is not read"),
        ('<path d="M0 0A1 2 0 0 1 3 3z"/>', "an elliptical arc"),
        ('<ellipse rx="1" ry="2"/>', "an ellipse is not read"),
        ('<circle r="1" transform="scale(1,2)"/>', "an ellipse is not read"),
        ('<path d="M0 0a1 1 0 0 1 2 0z" transform="skewX(10)"/>', "its transform makes arcs elliptical"),
        ('<rect width="4" height="3" rx="9"/>', "a rectangle with elliptical corners"),
        ('<rect width="4" height="3" rx="1" ry="2"/>', "a rectangle with elliptical corners"),
        (
            '<rect width="4em" height="3"/>',
            "width: a number, perhaps with px in cm mm pt pc q or %, is needed",
        ),
        ('<rect width="50%" height="3"/>', "rect: width: 50% of what is not told; give a number"),
        ('<circle r="1e9999999"/>', "circle: not a number"),
        ('<path d="L0 0"/>', "a path that begins with M is needed at character 5"),
        ('<path d="M0 0L1"/>', "a number is needed at character 7, not the end"),
        ('<path d="M0 0X1"/>', "a command other than X is needed"),
        ('<path d="M0 0 1 1 z 3"/>', "a command is needed"),
        ('<path d="M0 0a1 1 0 2 1 3 3"/>', "a flag, 0 or 1, is needed at character 12"),
        ('<rect transform="spin(3)" width="1" height="1"/>', "not a transform: 'spin"),
        ('<rect transform="rotate(1,2)" width="1" height="1"/>', "not a transform: 'rotate"),
        ('<rect transform="scale(x)" width="1" height="1"/>', "transform: numbers are needed, not 'x'"),
        ('<rect transform="skewX(90)" width="1" height="1"/>', "has no image"),
        ('<rect transform="' + "scale(2)" * 99 + '" width="1" height="1"/>', "not a transform"),
        ('<polygon points="1,2 x"/>', "points: numbers are needed"),
        ("<g>" * 5000, "nested more than 64 deep"),
        ('<svg viewBox="0 0 1 1"/>', "a drawing within the drawing without width and height is not placed"),
        ('<svg width="1" height="1" viewBox="0 0 1"/>', "viewBox: four numbers are needed, not 3"),
        (
            '<svg width="1" height="1" viewBox="0 0 1 1" preserveAspectRatio="x"/>',
            "preserveAspectRatio: xMidYMid",
        ),
        ('<g id="a"><use href="#a"/></g>', "uses are nested more than 64 deep .one in itself"),
        ("<g>", "not XML .mismatched tag"),
        ("&nbsp;", "not XML .undefined entity"),
        ("", "nothing to read; export another drawing"),
        (('<g transform="' + "rotate(1.234567)" * 60 + '">') * 40 + "</g>" * 40, "need too long numbers"),
        ('<g transform="' + "a" * 5_000_000 + '"/>', "not a transform"),
        ('<line x2="4"/>', "no closed loop"),
    ],
)
def test_broken_drawings_are_one_line_with_the_place(tmp_path: Path, content: str, message: str) -> None:
    with pytest.raises(xa.FormatError, match=message) as caught:
        read(tmp_path, content)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400


@pytest.mark.parametrize(
    ("part", "times", "message"),
    [
        ('<polygon points="{}"/>', ("1 ", 5 / 2), "more than {1} numbers"),
        ("{}", ("<g/>", 5 / 2), "more than {1} elements"),
        ('<path d="M0 0{}"/>', ("h1", 3 / 2), "a path of more than {0} edges"),
        ("{}", ('<path d="M0 0h1v1z"/>', 7 / 20), "more than the {0} that are taken"),
    ],
)
def test_drawings_that_are_too_large_are_one_line(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    part: str,
    times: tuple[str, float],
    message: str,
) -> None:
    most = source.MAX_EDGES if NIGHTLY else 10_000
    for module in (source, path_data, transforms, load):
        monkeypatch.setattr(module, "MAX_EDGES", most)
    for module in (document, load):
        monkeypatch.setattr(module, "MAX_ELEMENTS", 2 * most)
    repeated, share = times
    with pytest.raises(xa.FormatError, match=message.format(most, 2 * most)) as caught:
        read(tmp_path, part.format(repeated * int(share * most)))
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (BOMB.encode(), "line 1: it declares the entity 'a'"),
        (b'<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]><svg>&a;</svg>', "it declares the entity"),
        (b"<html/>", "not an SVG drawing, but one of 'html'"),
        (b'<?xml version="1.0" encoding="nonsense"?><svg/>', "not XML"),
        (bytes(range(256)), "not XML"),
        (b"", "the file is empty"),
    ],
)
def test_files_that_are_no_drawings(tmp_path: Path, data: bytes, message: str) -> None:
    path = tmp_path / "drawing.svg"
    path.write_bytes(data)
    with pytest.raises(xa.FormatError, match=message):
        xa.load(path, start=FAR)


def test_the_same_decimals_meet(tmp_path: Path) -> None:
    """Ten steps of a tenth end where they began, as binary fractions would not."""
    steps = "h.1" * 10 + "v.1" * 10 + "h-.1" * 10 + "v-.1" * 10
    (shape,) = read(tmp_path, f'<path d="M.3.7{steps}z"/>', tolerance=0).shapes
    assert (shape.vertices[0][0], len(shape.vertices)) == (fmpq(3, 10), 40)
    xs = [x for x, _, _ in shape.vertices]
    assert all(b - a in (0, fmpq(1, 10), fmpq(-1, 10)) for a, b in pairwise(xs))


# -- what is used again, nested, and measured ------------------------------------------------------------

NESTED = "<svg x='10' y='20' width='20' height='40' viewBox='0 0 10 10'>{}</svg>"
SYMBOL = "<symbol id='s' viewBox='0 0 10 10'><rect width='10' height='10'/></symbol>"


def corners(scene: xa.Scene) -> list[tuple[float, float, float, float]]:
    """The boxes of the obstacles as drawn, with y down: west, top, east, bottom, in a page 100 high."""
    found = []
    for shape in scene.shapes:
        xs, ys = zip(*((float(x), 100 - float(y)) for x, y, _ in shape.vertices), strict=True)
        found.append((min(xs), min(ys), max(xs), max(ys)))
    return found


@pytest.mark.parametrize(
    ("content", "boxes"),
    [
        (NESTED.format("<rect width='10' height='10'/>"), [(10, 30, 30, 50)]),  # in the middle of the rest
        (
            NESTED.format("<rect width='10' height='10'/>").replace("'>", "' preserveAspectRatio='none'>", 1),
            [(10, 20, 30, 60)],
        ),
        (
            NESTED.format("<rect width='10' height='10'/>").replace(
                "'>", "' preserveAspectRatio='xMaxYMin slice'>", 1
            ),
            [(-10, 20, 30, 60)],
        ),
        (NESTED.format("<rect width='50%' height='100%'/>"), [(10, 30, 20, 50)]),
        ("<svg x='5' y='6' width='9' height='9'><rect width='4' height='3'/></svg>", [(5, 6, 9, 9)]),
        ("<defs><rect id='a' width='4' height='3'/></defs><use href='#a' x='5' y='6'/>", [(5, 6, 9, 9)]),
        ("<use xlink:href='#a' transform='scale(2)'/><g display='none'>"
         "<rect id='a' x='1' width='4' height='3'/></g>",
         [(2, 0, 10, 6)]),
        (SYMBOL, []),
        (SYMBOL + "<use href='#s' x='20' width='20' height='20'/>"
         "<use href='#s' y='50' width='5' height='5'/>",
         [(20, 0, 40, 20), (0, 50, 5, 55)]),
        ("<g id='a'><rect width='1' height='1'/></g><g id='b'><use href='#a' x='2'/></g>"
         "<use href='#b' y='3'/>",
         [(0, 0, 1, 1), (2, 0, 3, 1), (2, 3, 3, 4)]),
        ("<rect x='1in' y='6pt' width='10%' height='25%'/>", [(96, 8, 106, 33)]),
        ("<g visibility='hidden'><rect width='9' height='9'/>"
         "<rect style='visibility: visible' width='2' height='3'/></g>",
         [(0, 0, 2, 3)]),
        ("<svg width='0' height='5'><rect width='9' height='9'/></svg><rect width='2' height='3'/>",
         [(0, 0, 2, 3)]),
    ],
)  # fmt: skip
def test_where_things_are_drawn(tmp_path: Path, content: str, boxes: list[tuple[float, ...]]) -> None:
    content += "<polygon points='90,90 99,90 99,99'/>"  # that something is there
    scene = read(tmp_path, content, root='viewBox="0 0 100 100" xmlns:xlink="http://www.w3.org/1999/xlink"')
    assert corners(scene)[:-1] == boxes


def test_what_is_done_and_not_done_is_told(tmp_path: Path) -> None:
    content = (
        "<style>a {fill: red}</style><clipPath id='c'><circle r='9'/></clipPath>"
        "<g clip-path='url(#c)' style='mask: url(#m)'><rect id='a' width='4' height='3'/></g>"
        "<use href='#a' x='9'/>"
        "<use href='other.svg#b'/><image/>"
        "<path style='transform: rotate(9deg)' transform='scale(2)' d='M0 9h1v1z'/>"
    )
    used, left = read(tmp_path, content).notes
    assert set(left.removeprefix("left out ").split(", ")) == {
        "1 style", "1 clip-path", "1 mask", "1 use of what the file does not have", "1 image",
        "1 transform in a style",
    }  # fmt: skip
    assert used == "drew 1 element by use"


def test_a_rectangle_with_elliptical_corners_by_arcs(tmp_path: Path) -> None:
    content = '<rect x="3" y="4" width="40" height="30" rx="10" ry="5"/>'
    (room,) = read(tmp_path, content, flatten="0.001").obstacles
    assert float(room.area) == pytest.approx(40 * 30 - 200 + 50 * math.pi, abs=0.1)
    (auto,) = read(tmp_path, '<rect width="4" height="3" rx="1" ry="auto"/>').obstacles
    assert str(auto.area) == "pi + 8"


def test_uses_of_uses_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Twenty groups that each use the one before ten times would draw 10^20 elements."""
    groups = "".join(f"<g id='g{k}'>" + f"<use href='#g{k - 1}'/>" * 10 + "</g>" for k in range(1, 20))
    monkeypatch.setattr("exactacq.files.svg.load.MAX_ELEMENTS", 4000)
    with pytest.raises(xa.FormatError, match="more than 4000 elements are drawn; export only one part"):
        read(tmp_path, f"<defs><g id='g0'/>{groups}</defs><use href='#g19'/>")


@pytest.mark.parametrize("width", ["1.5e308", "5e309", "3.1e310"])
def test_gaps_beyond_the_largest_float_are_told(tmp_path: Path, width: str) -> None:
    with pytest.raises(xa.FormatError):
        read(tmp_path, f'<path d="M0 0L1e312 0L1e312 1e312L0 1e312L0 {width}"/>')
