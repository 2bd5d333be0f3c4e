"""Which families at a leg matter: floats never contradict exact families, nor leave out what counts."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import groupby
from math import inf
from random import Random

import pytest
from flint import fmpq
from nightly import NIGHTLY, some
from strategies import arc_terrain, build, circle_grid, degenerate_terrain, random_terrain, square_grid

import exactacq as xa
from exactacq import kernel
from exactacq.files.octagons import random_octagons
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.curves import Curve, Segment
from exactacq.kernel.choice import mattering
from exactacq.kernel.extents import Extent, Span
from exactacq.kernel.leg_spans import LegSpan
from exactacq.kernel.single_lines import SingleImage
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing import family_filter, visibility_complex
from exactacq.sensing.complex_edges import FamilySweeper
from exactacq.sensing.end_names import Seen
from exactacq.sensing.event import Reason
from exactacq.sensing.free_way import PinOf, WayViews
from exactacq.sensing.leg_facts import LegFacts
from exactacq.sensing.legs import Leg, legs_of
from exactacq.sensing.line_family import family_of, single_of
from exactacq.sensing.straight_way import StraightWay
from exactacq.sensing.targets import Targets
from exactacq.sensing.view_families import ViewFamily
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.visibility.place_facts import NOTHING_KNOWN, PlaceFacts
from exactacq.visibility.sensor_range import Range

Told = tuple[list[Extent], list[tuple[Real, Real, Rail, Real, Real, Rail]]]
"""What floats tell of a family, in parts where it passes the start of a full circle; the exact families,
source and shown with rails."""

SCENES = ["figure2", "m11", "plate"]


def told(complex_: VisibilityComplex, leg: Leg, run: xa.SightseerRun) -> Iterator[Told]:
    """What floats tell of every family at a leg, beside the exact families."""
    wanted = frozenset(range(len(complex_.table.curves)))
    rails = complex_.clipper.rails

    def pair(family: ViewFamily, side: int, near: Rail) -> tuple[Real, Real, Rail, Real, Real, Rail]:
        here, there = ([end.places[k] for end in (family.first, family.last)] for k in (side, 1 - side))
        return min(here), max(here), near, min(there), max(there), rails[family.edges[1 - side]]

    if leg.edge is not None:
        for parts in in_parts(complex_.extents(leg.edge)):
            yield parts, [pair(family, side, rails[leg.edge]) for family, side in complex_.views(parts[0])]
        return

    def view(place: xa.Point, own: tuple[int, ...] | None, facts: Callable[[], PlaceFacts]) -> Seen:
        return Seen(complex_.table, rails, place, complex_.range, own, facts())

    way = WayViews(StraightWay(complex_, leg), wanted, view)
    extents, clipper = way.crossing.extents(), way.way.clipper

    def told_of(one: Extent, families: Iterator[ViewFamily]) -> Told:
        parts = (clipper.clipped(family, 0, leg.span) for family in families)
        return [one], [pair(part, 0, leg.rail) for part in parts if part is not None]

    for one in way.normals.extents():
        yield told_of(one, way.normals.views(one.origin))
    crossing_lines = {id(one.origin): one for one in way.single_lines()}
    for edge in complex_.near(leg.spots):
        for image in edge.whole_lines:
            views = way.along(single_of(image))
            if id(image) in crossing_lines:
                yield told_of(crossing_lines[id(image)], views)
            else:
                assert not list(views)
    for n, (image, certain) in enumerate(way.crossing):
        line_family = family_of(image)
        left = {side.edge for side in line_family.sides if side is not None}
        for parts in in_parts([one for one in extents if one.origin == n]):
            exact, one = [], parts[0]
            for family in way.crossing.views(line_family, certain, frozenset({one.edge})):
                part = clipper.clipped(family, 0, leg.span)
                if part is not None and family.free_views.sides[1] is line_family.sides[one.there + 1]:
                    exact.append(pair(part, 0, leg.rail))
            left.discard(one.edge)
            yield parts, exact
        for edge in left:
            # What is not mentioned is not shown, but from an end of the way.
            for family in way.crossing.views(line_family, certain, frozenset({edge})):
                part = clipper.clipped(family, 0, leg.span)
                if part is not None:
                    low, high = sorted(end.places[0] for end in (part.first, part.last))
                    assert low == high and (low == leg.span.low or low == leg.span.high)


def in_parts(extents: list[Extent]) -> Iterator[list[Extent]]:
    """The extents of each family."""
    for _, parts in groupby(extents, lambda one: (id(one.origin), one.here, one.there)):
        yield list(parts)


def is_above(bound: float, u: Real, rail: Rail) -> bool:
    """Whether an extended number is at least a parameter: infinity stands for the end of an edge or a way."""
    return bound == inf or u <= bound or (bound == -inf and u.sign() == 0)


def is_below(bound: float, u: Real, rail: Rail) -> bool:
    """Whether an extended number is at most a parameter."""
    return bound == -inf or u >= bound or (bound == inf and u == rail.top)


def is_inside(source: Span, leg: Leg) -> bool:
    """Whether all of where a family is seen from surely lies in a leg."""
    low, high = leg.span.low, leg.span.high
    starts, ends = leg.edge is not None and low.sign() == 0, leg.edge is not None and high == leg.rail.top
    return (starts or source[0] >= low) and (ends or source[1] <= high)


def cover(spans: list[tuple[Real, Real]], low: Real, high: Real) -> bool:
    """Whether intervals together cover one; a family over a full circle's start is cut there."""
    for a, b in sorted(spans):
        if a <= low <= high <= b:
            return True
        if a <= low:
            low = max(low, b)
    return False


def check(run: xa.SightseerRun) -> int:
    """Compare floats with exact families along the first legs of a run; how many were compared."""
    table = EdgeTable(run.scene.obstacles)
    complex_ = VisibilityComplex(table, Range(run.radius))
    count = 0
    for piece in run.path[:8]:
        for leg in legs_of(table, complex_.clipper.rails, piece.obstacle, piece.curve):
            for parts, exact in told(complex_, leg, run):
                if not parts[0].is_known:
                    continue
                for family in exact:
                    count += 1
                    assert any(is_within(family, one) for one in parts)
                for one in parts:
                    check_sure(one, exact, leg)
    return count


def is_within(family: tuple[Real, Real, Rail, Real, Real, Rail], one: Extent) -> bool:
    """Whether an exact family is seen from, and shows, no more than floats tell."""
    a, b, near, c, d, far = family
    is_source = is_below(one.source[0], a, near) and is_above(one.source[1], b, near)
    return is_source and is_below(one.shown[0], c, far) and is_above(one.shown[1], d, far)


def check_sure(one: Extent, exact: list[tuple[Real, Real, Rail, Real, Real, Rail]], leg: Leg) -> None:
    """Compare where a family surely is seen from, and what it surely shows, with the exact families."""
    if one.surely[0] <= one.surely[1]:
        low, high = leg.span.low, leg.span.high
        sure = [Real(v) if abs(v) < inf else (leg.rail.top if v > 0 else Real(0)) for v in one.surely]
        sure = [max(sure[0], low), min(sure[1], high)] if leg.edge is None else sure
        if sure[0] <= sure[1]:
            assert cover([(a, b) for a, b, *_ in exact], *sure)
    if one.told[0] <= one.told[1] and is_inside(one.source, leg):
        assert any(is_above(one.told[0], c, far) and is_below(one.told[1], d, far) for *_, c, d, far in exact)


@pytest.mark.parametrize("name", some(SCENES, 2))
def test_floats_agree_with_exact_families(name: str) -> None:
    assert check(xa.sightseer(xa.load(name))) > 20


@pytest.mark.parametrize("seed", range(6) if NIGHTLY else (0, 1, 2))
def test_floats_agree_on_random_scenes(seed: int) -> None:
    make = (random_terrain, degenerate_terrain, arc_terrain)[seed % 3]
    terrain = make(Random(seed))
    start = terrain.start or (-3, -3)
    scene = terrain.scene()
    try:
        run = xa.sightseer(xa.Scene(scene.shapes, start=start, radius=terrain.radius))
    except (xa.InvalidScene, xa.Undecided):
        pytest.skip("no run")
    check(run)


def test_floats_agree_on_a_board() -> None:
    """The robot walks along rows of holes: their quarter turns begin with lines parallel to its ways."""
    holes = [xa.Circle((2 * k % 6, 2 * (k // 3)), "3/5") for k in range(6)]
    assert check(xa.sightseer(xa.Scene(holes, start=(-1, -1), radius=5))) > 20


def compare_pins(complex_: VisibilityComplex) -> int:
    """Compare where lines meet edges, made alone, with the ends of families; how many were compared."""
    count = 0
    for e, rail in enumerate(complex_.clipper.rails):
        for one in complex_.extents(e):
            single = isinstance(one.origin, SingleImage)
            sure = one.surely[0] <= one.surely[1]
            if not one.is_known or not one.in_range or not (single or sure):
                continue
            sources = [family.interval(side) for family, side in complex_.views(one)]
            assert sources
            for is_last in (False, True):
                point, u = complex_.pin(one, is_last)
                is_high = is_last != one.is_turned
                if sure and abs(one.surely[is_high]) == inf:
                    continue
                found = [(part.high, part.end) if is_high else (part.low, part.start) for part in sources]
                count += 1
                assert any((u == v) and (point == p) for v, p in found)
                assert is_below(one.source[0], u, rail) and is_above(one.source[1], u, rail)
    return count


GRIDS = {"discs": circle_grid(3, 3), "squares": square_grid(4, 3)}


def table_of(name: str | int) -> EdgeTable:
    """The edges of a grid, or of the random terrain of a number."""
    if isinstance(name, str):
        return EdgeTable(build(GRIDS[name]).obstacles)
    make = arc_terrain if name % 3 else degenerate_terrain
    return EdgeTable(build(make(Random(name)).shapes).obstacles)


@pytest.mark.parametrize("name", [*GRIDS, *some(range(12), 4)])
def test_where_families_begin_and_end_alone(name: str | int) -> None:
    """Those that matter only for that are not made: their lines meet the edge where their views begin."""
    table = table_of(name)
    assert compare_pins(VisibilityComplex(table, Range(fmpq(17, 2)))) > 50


def record(run: xa.SightseerRun) -> list[object]:
    """All that a run tells."""
    events = [(e.kind, e.obstacle, *map(digits, e.point), e.describe()) for e in run.events]
    known = [digits(run.map.known_length(k)) for k in range(len(run.scene.obstacles))]
    return [events, digits(run.length), known]


def digits(number: Real | xa.Length) -> str:
    return number.decimal(40)


@pytest.mark.parametrize("name", [*SCENES, "figure4"] if NIGHTLY else ["m11", "circles"])
def test_leaving_out_changes_nothing(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the switch that makes every family matter a run is the same."""
    scene = xa.load(name)
    explore = xa.sightseer if name != "figure4" else xa.seed_spreader
    usual = record(explore(scene))
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    assert record(explore(scene)) == usual


def test_leaving_out_changes_nothing_on_a_board(monkeypatch: pytest.MonkeyPatch) -> None:
    """There most single lines are extreme views of families, or found from both their ends."""
    holes = [xa.Circle((2 * k % 6, 2 * (k // 3)), "3/5") for k in range(6)]
    scene = xa.Scene(holes, start=(-1, -1), radius=5)
    usual = record(xa.sightseer(scene))
    monkeypatch.setattr(kernel, "EXACT_ONLY", True)
    assert record(xa.sightseer(scene)) == usual


def keyed_views(complex_: VisibilityComplex, edge: int) -> Iterator[tuple[list[int], int, str, str]]:
    """The keys of extreme views from an edge, the edges that are seen, and the points from and to which."""
    for one in complex_.extents(edge):
        is_single = isinstance(one.origin, SingleImage)
        for family, side in complex_.views(one):
            first, last = sorted((family.first, family.last), key=lambda end: end.places[side])
            for end, keys in ((first, one.first_keys), (last, one.last_keys)):
                # Families end at the start of a full circle too.
                views = family.free_views
                if keys and (is_single or (views is not None and end.t in (views.low, views.high))):
                    here, there = map(digits_of, end.points)
                    yield (keys, one.edge, there, here) if side else (keys, one.edge, here, there)


def digits_of(point: xa.Point) -> str:
    return f"{digits(point.x)} {digits(point.y)}"


def ends_of(curve: Curve) -> set[str]:
    """Both ends of a straight edge, between which a line may run along it; nothing for an arc."""
    return {digits_of(curve.start), digits_of(curve.end)} if isinstance(curve, Segment) else set()


@pytest.mark.parametrize("name", [*GRIDS, *some(range(12), 3)])
def test_views_with_equal_keys_are_equal(name: str | int) -> None:
    """Also from circles, which a line meets twice; scenes with many lines that pass several features."""
    table = table_of(name)
    complex_ = VisibilityComplex(table, Range(fmpq(17, 2)))
    shared = 0
    for e in range(len(table.curves)):
        at: dict[tuple[int, int], tuple[str, str]] = {}
        for keys, shown, here, there in keyed_views(complex_, e):
            # Families that are seen from a straight leg have the keys of all their lines, single lines fewer.
            if not table.kinds[shown] or table.full[shown]:
                for key in keys:
                    shared += (key, shown) in at
                    place, seen = at.setdefault((key, shown), (here, there))
                    assert place == here or {place, here} == ends_of(table.curves[e])
                    assert seen == there or {seen, there} == ends_of(table.curves[shown])
    assert shared > 500 or name not in GRIDS


def seen_all_along(edge: int) -> Extent:
    """What a family tells that shows something of an edge from everywhere on a leg from 0 to 1."""
    return Extent(edge, (0.25, 0.5), (-1.0, 2.0), (-1.0, 2.0), [], [], edge, 0, 1, True)


@pytest.mark.parametrize("is_whole", [True, False])
def test_one_family_that_shows_an_obstacle_all_along_is_enough(is_whole: bool) -> None:
    """Of an edge of which only a part counts it may show the rest, so there each family matters."""
    leg, everything = LegSpan((0.0, 0.0), (1.0, 1.0)), (-inf, inf)
    owners = {0: [(7, is_whole)], 1: [(7, is_whole)]}
    known = {0: [everything], 1: [everything]}
    chosen, groups, *_ = mattering(
        [seen_all_along(0), seen_all_along(1)], leg, owners, {7}, set(), known, known
    )
    assert chosen == ([] if is_whole else [0, 1])
    assert [(k, first.surely, last.surely) for k, first, last in groups] == [
        (7, everything, everything)
    ] * is_whole


def test_most_families_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Among octagons fewer than a quarter of the families at a leg are made exact."""
    asked, kept = 0, 0
    choose = family_filter.FamilyFilter.choose

    def counted(self: family_filter.FamilyFilter, extents: list, pin: PinOf) -> list:
        nonlocal asked, kept
        chosen = choose(self, extents, pin)
        obstacles = [{k for k, _ in self.targets.on(one.edge)} for one in extents]
        asked, kept = asked + sum(1 for some in obstacles if some & self.obstacles), kept + len(chosen)
        return chosen

    monkeypatch.setattr(family_filter.FamilyFilter, "choose", counted)
    xa.sightseer(random_octagons(8, 1)).sense()
    assert asked > 500 and kept < asked / 4


def test_a_family_narrower_than_floats_is_no_single_line() -> None:
    """A line runs past the tip of a sliver, which a wall's lowest point and the other tip nearly touch.

    The tip stays in sight. The lines through it between these two points meet the walk within 10^-31: their
    family was taken for one line, the last one of the next family, and the obstacle for lost there.
    """
    hair = fmpq(1, 10**30)
    wall = xa.Outline([(0, 0, 1), (8, 0, 0)])
    sliver = xa.Outline([("1/2", -4 - hair, 2), ("9/2", -4 - hair, "-1.999998")])
    terrain = xa.Terrain(10, 10 + hair, origin=(-1, -9 - hair))
    run = xa.seed_spreader(xa.Scene([wall, sliver], terrain=terrain, radius="5/3"))
    assert all(event.reason is not Reason.OCCLUSION for event in run.events if event.obstacle == 1)


def test_normals_at_the_end_of_a_way() -> None:
    """The robot sees a wall along its normals from a way that begins at the wall's corner.

    The normals of an edge have its start as their origin, as the tangents of a corner have the corner; but
    they do not all pass it.
    """
    diamond = xa.Polygon([("9/2", 7), (3, "11/2"), ("9/2", 4), (6, "11/2")])
    scene = xa.Scene([diamond], terrain=xa.Terrain(8, 8), radius=1)
    lost = [e.point for e in xa.seed_spreader(scene).events if e.kind == "lose" and e.point.x == 3]
    assert lost == [xa.Point(3, xa.Real("11/2") - xa.Real(2).sqrt())]


def test_along_a_row_of_circles() -> None:
    """From its lowest point a circle sees all others of a row, along their common tangent.

    All of them lie on the same side of it. That point is no end of an edge, and no tangent line of another
    circle beside the common one leads there: turned one way it is blocked, turned the other way it misses.
    """
    row = [xa.Circle((2 * k, 2), "3/5") for k in range(4)]
    run = xa.sightseer(xa.Scene(row, start=(-1, 1), radius=20))
    lowest = xa.Point(0, "7/5")
    assert [e.obstacle for e in run.events if e.kind == "lose" and e.point == lowest] == [2, 3, 2, 3]


def test_a_family_with_a_line_parallel_to_the_way() -> None:
    """Lines through the square's corner cross the way's line beyond it, then nowhere, then at its very end.

    Taken for one that moves from far away towards the end, the crossing would pass all of the way, and the
    square would be in sight from the start.
    """
    wall = xa.Outline([(5, 2, "1/5"), (6, 2), (6, 1), (5, 1)])
    square = xa.Polygon([(1, 4), (1, 7), (4, 7), (4, 4)])
    hidden = xa.Polygon([(4, 0), (4, 3), (1, 3), ("13/4", "3/2"), (1, 0)])
    front = xa.Polygon([(5, 6), (5, 4), (7, 4), ("11/2", 5), (7, 6)])
    run = xa.sightseer(xa.Scene([wall, square, hidden, front], start=("13/2", -1), radius=60))
    (seen,) = (event.point for event in run.events if event.kind == "sight" and event.obstacle == 1)
    assert seen == xa.Point(6, 2)


def test_forgetting_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Families that are out of reach are dropped, and made again when the robot comes back."""
    usual = record(xa.sightseer(random_octagons(30, 1), 3))
    monkeypatch.setattr(visibility_complex, "KEPT", 1)
    monkeypatch.setattr(visibility_complex, "SEEN_FROM_KEPT", 1)
    made: list[int] = []
    swept = FamilySweeper.tangents
    monkeypatch.setattr(FamilySweeper, "tangents", lambda self, e: made.append(e) or swept(self, e))
    assert record(xa.sightseer(random_octagons(30, 1), 3)) == usual
    assert len(made) > len(set(made)) > 200


EDGE = 0, Segment(xa.Point(1, 0), xa.Point(2, 0))
"""The second third of a square's edge."""
WAY = None, Segment(xa.Point(0, -1), xa.Point(3, -1))


def offered(
    piece: tuple[int | None, Segment], begin: Real, end: Real, single: Real
) -> tuple[family_filter.FamilyFilter, Extent, Extent]:
    """What chose among a family that is seen from one place to another and a *single* line from a third.

    Both show another obstacle, of which all is known.
    """
    square = xa.Polygon([(0, 0), (3, 0), (3, 3), (0, 3)])
    table = EdgeTable(xa.Scene([square, xa.Circle((1, -4), 1)], radius=9).obstacles)
    rails = VisibilityComplex(table, Range(fmpq(9))).clipper.rails
    (leg,) = legs_of(table, rails, *piece)
    a, b, c = map(float, (begin, end, single))
    blur, apart, nothing = 1e-12, "family", (inf, -inf)
    family = Extent(4, (1, 2), (a - blur, b + blur), (a + blur, b - blur), [7], [8], apart, 0, 1, True)
    line = Extent(4, (1, 1), (c - blur, c + blur), nothing, [9], [9], "line", 0, 1, True)
    family.in_range = line.in_range = True
    known = {4: [(-inf, inf)]}
    chooser = family_filter.FamilyFilter(leg, Targets.whole(table, rails), [1], [], known, {})

    def pin(one: Extent, is_last: bool) -> tuple[xa.Point, Real]:
        u = single if one is line else end if is_last else begin
        return leg.rail.point(u), u

    assert chooser.choose([family, line], pin) == []
    return chooser, family, line


def chosen_places(
    piece: tuple[int | None, Segment], begin: Real, end: Real, single: Real
) -> list[tuple[Real, Real]]:
    """From where on a piece the other obstacle is told to be in sight."""
    chooser, _, _ = offered(piece, begin, end, single)
    found, span = chooser.in_sight.get(1, []), chooser.leg.span
    assert all(span.low <= i.low <= i.high <= span.high for i in found)
    return [(i.low, i.high) for i in found]


@pytest.mark.parametrize("piece", [EDGE, WAY], ids=["edge", "way"])
def test_which_families_may_begin_or_end_at_a_place(piece: tuple[int | None, Segment]) -> None:
    """A place that floats cannot tell from an end counts, one between the ends does not."""
    begin, single, end = (Real(fmpq(n, 90)) for n in (36, 45, 54))
    chooser, family, line = offered(piece, begin, end, single)
    hair, wide = Real(fmpq(1, 10**15)), Real(fmpq(1, 10**6))
    for place, here in ((begin, [family]), (end, [family]), (single, [line])):
        for near in (place, place + hair, place - hair):
            assert chooser.ending_at(near) == here
        for far in (place + wide, place - wide):
            assert chooser.ending_at(far) == []


def test_places_near_the_ends_of_a_leg() -> None:
    """A family that begins just before the leg is seen from its start, a single line not at all."""
    third, hair = Real(fmpq(1, 3)), Real(fmpq(1, 10**30))
    middle, inside = Real(fmpq(1, 2)), Real(fmpq(5, 9))
    assert chosen_places(EDGE, third + hair, middle, inside) == [(third + hair, middle), (inside, inside)]
    assert chosen_places(EDGE, third - hair, middle, third - hair) == [(third, middle)]
    assert chosen_places(EDGE, middle, 2 * third + hair, 2 * third + hair) == [(middle, 2 * third)]
    assert chosen_places(EDGE, middle, inside, 2 * third) == [(middle, inside), (2 * third, 2 * third)]
    assert chosen_places(WAY, -hair, middle, inside) == [(Real(0), middle), (inside, inside)]
    assert chosen_places(WAY, middle, 1 + hair, 1 + hair) == [(middle, Real(1))]


def test_facts_are_told_of_places_of_events(monkeypatch: pytest.MonkeyPatch) -> None:
    """Maps at events are told what their lines of sight touch, also where a run makes no family of it."""
    told: list[tuple[xa.Point, PlaceFacts]] = []
    at = LegFacts.at

    def kept(self: LegFacts, u: Real, place: xa.Point) -> PlaceFacts:
        told.append((place, at(self, u, place)))
        return told[-1][1]

    monkeypatch.setattr(LegFacts, "at", kept)
    run = xa.sightseer(random_octagons(8, 1))
    count = 0
    for event in run.events:
        if event.reason is Reason.OCCLUSION:
            list(run.map_at(event).known(0))
            facts = [known for place, known in told if place is event.point]
            count += len(facts)
            assert NOTHING_KNOWN not in facts
    assert count > 10
