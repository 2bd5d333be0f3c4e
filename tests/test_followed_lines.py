"""Lines that graze several features, followed by names: against their exact contacts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from importlib.util import module_from_spec, spec_from_file_location
from math import dist, inf
from pathlib import Path
from random import Random

import pytest
from flint import fmpq
from nightly import some
from strategies import arc_terrain, build, circle_grid, degenerate_terrain, square_grid

import exactacq as xa
from exactacq import kernel
from exactacq.geometry.curve_parameter import Rail
from exactacq.geometry.points import Point
from exactacq.kernel import line_walks
from exactacq.kernel.single_lines import SingleImage
from exactacq.numbers.real import Real
from exactacq.scene import edge_table
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing import followed_lines
from exactacq.sensing.complex_edges import FamilySweeper
from exactacq.sensing.followed_lines import FeatureLine, FollowedLine
from exactacq.sensing.free_way import WayViews
from exactacq.sensing.legs import legs_of
from exactacq.sensing.line_family import single_of
from exactacq.sensing.line_points import Role
from exactacq.sensing.straight_way import StraightWay
from exactacq.sensing.visibility_complex import VisibilityComplex
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import random_scene
from exactacq.visibility import pinched_lines
from exactacq.visibility.features import features
from exactacq.visibility.free_runs import FreeRun, RunSide
from exactacq.visibility.pinched_chords import PinchedLine
from exactacq.visibility.rotational_sweep import Pencil, pencil
from exactacq.visibility.sensor_range import Range

MILL = [xa.Polygon([(k, 0), (k + 1, 0), (k + 1, 1), (k, 1)]) for k in (0, 3, 6)]
SLOTS = [xa.Outline([(k, 0, 0), (k + 2, 0, 1), (k + 2, 1, 0), (k, 1, 1)]) for k in (0, 5, 10)]
ROOM = xa.Polygon([(-9, -9), (30, -9), (30, 9), (-9, 9)])


def scenes() -> dict[str, xa.Scene]:
    """Grids, where lines pass many corners or touch many circles, and drawings with smooth joints."""
    found = {
        "squares": build(square_grid(4, 3)),
        "discs": build(circle_grid(4, 2)),
        "a mill in a room": xa.Scene([*MILL, xa.Circle((12, "1/2"), "1/2")], enclosure=ROOM),
        "slots": xa.Scene(SLOTS, enclosure=ROOM),
    }
    for seed in range(6):
        terrain = (degenerate_terrain if seed % 2 else arc_terrain)(Random(seed))
        found[f"random {seed}"] = build(terrain.shapes)
    # Smooth joints, cusps, arcs on one circle, circles in parts.
    found |= {f"arcs {seed}": random_scene(Subject.SIGHTSEER, seed) for seed in (3, 4, 9, 14, 20003)}
    return found


SCENES = scenes()


def swept_lines(table: EdgeTable, reach: float) -> Iterator[tuple[Pencil, FeatureLine]]:
    """All lines at which cells end, with the sweep that found them."""
    for feature in features(table):
        for sector in feature.sectors:
            found = pencil(table, sector, feature.edges, reach)
            for row in found.rows:
                for bound in (row.first, row.last):
                    yield found, FeatureLine(feature, sector, found.value(bound), tuple(bound.passed))


def lines(sweeper: FamilySweeper, reach: float) -> Iterator[FeatureLine]:
    """All lines at which cells end."""
    return (line for _, line in swept_lines(sweeper.table, reach))


def places(line: FollowedLine, reach: float) -> list[set[tuple[int, str, str]]]:
    """What is met in each place, in order, in 30 digits; beyond the reach only of edges met within it."""
    found: dict[int, set[tuple[int, str, str]]] = {}
    here = next(met.spot[:2] for met in line.met if met.place == 0)
    near = {met.edge for met in line.met if dist(met.spot[:2], here) <= reach}
    for k, met in enumerate(line.met):
        if met.edge in near:
            point: Point = line.pin(k)[0]
            found.setdefault(met.place, set()).add((met.edge, point.x.decimal(30), point.y.decimal(30)))
    return [found[k] for k in sorted(found)]


@pytest.mark.parametrize("name", some(SCENES, 5))
def test_names_tell_what_exact_contacts_tell(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every line at which a cell of a pencil ends; reaches are no gaps, where either may be told."""
    scene = SCENES[name]
    table = EdgeTable(scene.obstacles)
    told = grazing = blocked = 0
    for radius in (fmpq(149, 100), fmpq(353, 100), fmpq(851, 100)):
        sweeper = FamilySweeper(table, Range(radius))
        reach = sweeper.range.above
        for line in lines(sweeper, reach):
            by_names = sweeper.follower.follow(line)
            with monkeypatch.context() as patch:
                patch.setattr(pinched_lines, "WalkedLine", Untold)
                exact = sweeper.follower.follow(line)
            assert by_names.image.is_blocked == exact.image.is_blocked
            assert places(by_names, reach) == places(exact, reach)
            both = {met.edge for met in by_names.met} & {met.edge for met in exact.met}
            assert by_names.image.blind & both == exact.image.blind & both
            for line_ in (by_names, exact):
                check_floats(table, line_)
            told += 1
            grazing += len(places(exact, reach)) > 2
            blocked += exact.image.is_blocked[0] + exact.image.is_blocked[1]
    assert told > 20
    assert blocked > 1
    assert grazing > 1


def test_a_line_along_a_row_is_followed_twice_at_most(monkeypatch: pytest.MonkeyPatch) -> None:
    """Corners of pads whose arcs, as rounded in a file, are not quite tangent: names leave all lines open."""
    pads = [
        xa.Outline([(k, 0, 0), (k + 2, 0, "0.41421356237309"), (k + 3, 1, 0), (k + 3, 3, 0), (k, 3, 0)])
        for k in range(0, 40, 5)
    ]
    table = EdgeTable(xa.Scene(pads, start=(-9, 0)).obstacles)
    sweeper, follower = FamilySweeper(table, Range(fmpq(20))), followed_lines.LineFollower
    asked, followed = Counter[int](), Counter[int]()
    sides, run = follower._sides, follower._run

    def names(at: FeatureLine) -> list[int]:
        return table.line_numbers.keys(sweeper._namer.number(at.feature), [*at.passed])

    def counted(self: followed_lines.LineFollower, at: FeatureLine) -> tuple[RunSide, RunSide]:
        asked.update(names(at))
        return sides(self, at)

    def followed_once_more(self: followed_lines.LineFollower, at: FeatureLine, reach: float) -> FreeRun:
        followed.update(names(at))
        return run(self, at, reach)

    monkeypatch.setattr(follower, "_sides", counted)
    monkeypatch.setattr(follower, "_run", followed_once_more)
    for e in range(len(table.curves)):
        sweeper.tangents(e)
    assert max(followed.values()) == 2
    assert followed.total() < asked.total() / 2


def test_a_line_is_the_same_from_whichever_feature_it_was_followed_first() -> None:
    """Below a half disc, whose side ends where a line touches its arc: it was met at the wrong end."""
    shapes = [xa.Polygon([(2, 0), (4, 0), (4, 1), (2, 1)]), xa.Outline([(0, 6, 1), (2, 6, 0)])]
    table, reach = EdgeTable(xa.Scene(shapes, start=(-5, -5)).obstacles), Range(fmpq(9)).above
    for seed in range(8):
        shared = FamilySweeper(table, Range(fmpq(9)))
        some_lines = list(lines(shared, reach))
        Random(seed).shuffle(some_lines)
        for line in some_lines:
            fresh = FamilySweeper(table, Range(fmpq(9)))
            one, other = (sweeper.follower._exactly(line) for sweeper in (shared, fresh))
            assert places(one, reach) == places(other, reach)
            assert [met.edge for met in one.met] == [met.edge for met in other.met]


def check_floats(table: EdgeTable, line: FollowedLine) -> None:
    """The floats of what is met, and of the places as far away as the range, hold their numbers."""
    for k, met in enumerate(line.met):
        point, u = line.pin(k)
        assert_held(met.spot, point)
        low, high = (
            0 if v == -inf else Rail(table.curves[met.edge]).top if v == inf else v for v in met.span
        )
        assert low <= u <= high or table.full[met.edge]
    for spot, role in zip(line.image.ends, (Role.BEHIND, Role.AHEAD), strict=True):
        assert_held(spot, line.ended(role))


def assert_held(spot: tuple[float, float, float], point: Point) -> None:
    x, y, error = spot
    assert abs(point.x - Real(x)) <= error and abs(point.y - Real(y)) <= error


class Untold:
    """A line of which floats tell nothing."""

    is_told = False

    def __init__(self, *_: object) -> None:
        pass


@pytest.mark.parametrize("name", ["squares", "slots", "arcs 14"])
def test_most_lines_are_told_of(name: str) -> None:
    """Else the exact way would hide what the floats get wrong."""
    table = EdgeTable(SCENES[name].obstacles)
    sweeper = FamilySweeper(table, Range(fmpq(8)))
    count = 0
    told = []
    walked = line_walks.WalkedLine

    def kept(*arguments: object) -> line_walks.WalkedLine:
        made = walked(*arguments)
        told.append(made.is_told)
        return made

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pinched_lines, "WalkedLine", kept)
        for line in lines(sweeper, sweeper.range.above):
            sweeper.follower.follow(line)
            count += 1
    assert len(told) == count
    assert sum(told) > 0.9 * count


@pytest.mark.parametrize("name", some(SCENES, 5))
def test_chords_along_lines_are_the_same_by_exact_contacts(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Between all pairs of obstacles that a line joins; of what is beyond the reach either may be told.

    By names only the edges that were swept are asked, and those surely hidden from the feature are not.
    """
    monkeypatch.setattr(edge_table, "MANY", 0)
    scene = SCENES[name]
    table, reach = EdgeTable(scene.obstacles), Range(fmpq(353, 100)).above
    count = len(scene.obstacles)
    joined = 0
    for sweep, line in swept_lines(table, reach):
        made = sweep, line.feature, line.t, line.passed, reach
        by_names = PinchedLine.of(*made)
        with monkeypatch.context() as patch:
            patch.setattr(pinched_lines, "WalkedLine", Untold)
            exact = PinchedLine.of(*made)
        for i in range(count):
            for j in range(count):
                one, other = by_names.chord(i, j), exact.chord(i, j)
                if one is not None and other is not None:
                    assert (one.start, one.end, one.length) == (other.start, other.end, other.length)
                    joined += 1
                else:
                    assert all(c is None or float(c.length) > reach for c in (one, other))
    # On some random scenes no line joins two obstacles within reach.
    assert joined > 2 or name.startswith(("random", "arcs"))


def told_pairs(sweeper: FamilySweeper) -> set[tuple[object, ...]]:
    """All that single lines show within range: from which place of which edge, and of which edge what."""
    lone = [line for e in range(len(sweeper.table.curves)) for line in sweeper.tangents(e).single_lines]
    made = map(single_of, lone)
    near = [
        line
        for line in made
        if line.place != line.points[0] and sweeper.range.order(line.place, line.points[0]) <= 0
    ]
    return {(line.edge, str(line.place), line.shown, *map(str, line.points)) for line in near}


def telling_all() -> type:
    """Lines that tell what others tell too; of the module as it is not compiled, which can be changed."""
    path = Path(kernel.__file__).parent / "grazing_lines.py"
    spec = spec_from_file_location("grazing_lines", path)
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)

    class TellingAll(module.GrazingLine):  # type: ignore[name-defined, misc]
        def is_told_by_others(self, *_: int) -> bool:
            return False

    return TellingAll


@pytest.mark.parametrize("name", ["squares", "a mill in a room", "sweep"])
def test_one_feature_tells_what_all_would(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """In the sweep, walls without a corner between them lie along a line that touches circles."""
    scene = random_scene(Subject.SEED_SPREADER, 114) if name == "sweep" else SCENES[name]
    table, range_ = EdgeTable(scene.obstacles), Range(fmpq(3))
    found = told_pairs(FamilySweeper(table, range_))
    monkeypatch.setattr(followed_lines, "GrazingLine", telling_all())
    every = told_pairs(FamilySweeper(table, range_))
    assert found == every
    assert len(every) > 20


def test_a_line_that_enters_its_own_obstacle_at_the_contact() -> None:
    """The tangent of a cusp of free space goes on inside, where it met nothing else in reach."""
    arrow = xa.Outline([(0, 2, 1), (0, 0, 1), (0, -2), (2, 0)])
    sweeper = FamilySweeper(EdgeTable(xa.Scene([arrow]).obstacles), Range(fmpq(3, 2)))
    tangents = [
        line
        for line in lines(sweeper, sweeper.range.above)
        if line.feature.round and line.sector.touch(line.t)[0] == Point(0, 0)
    ]
    assert tangents
    for line in tangents:
        for walked in (line_walks.WalkedLine, Untold):
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr(pinched_lines, "WalkedLine", walked)
                found = sweeper.follower.follow(line)
            forward = line.sector.touch(line.t)[1].x > 0
            assert found.image.is_blocked == (not forward, forward)


def test_edges_that_are_crossed_almost_in_one_place() -> None:
    """The line x = 8 enters an obstacle at y = 2 and leaves it 10^-18 below. The first of the two ended the
    walk, though their order was open."""
    hair = fmpq(1, 10**9)
    bay = xa.Outline([(6, 0), (8 + hair, 0, -1), (8 + hair, 2), (6, 2)])
    scene = xa.Scene([xa.Circle((fmpq(13, 2), fmpq(9, 2)), fmpq(3, 2)), bay])
    sweeper = FamilySweeper(EdgeTable(scene.obstacles), Range(fmpq(851, 100)))
    entered = []
    for line in lines(sweeper, sweeper.range.above):
        contact, direction = line.sector.touch(line.t)
        if contact == Point(8, fmpq(9, 2)):
            followed = sweeper.follower.follow(line)
            end = followed.end(Role.AHEAD if direction.y < 0 else Role.BEHIND)
            entered.append(end is not None and followed.pin(end)[0] == Point(8, 2))
    assert entered and all(entered)


def shown_to(way: WayViews, lines: list[SingleImage]) -> set[tuple[object, ...]]:
    """What lines that cross a way show along it: edges, and the ends of the extreme views."""
    return {
        (
            family.edges,
            *(f"{c.decimal(30)}" for end in (family.first, family.last) for p in end.points for c in p),
        )
        for line in lines
        for family in way.along(single_of(line))
    }


@pytest.mark.parametrize("name", ["squares", "discs", "a mill in a room", "slots", "random 1", "arcs 9"])
def test_lines_that_begin_where_they_end_are_enough_for_ways(name: str) -> None:
    """A way that crosses a line sees along it what it shows from farthest away, if that is in range."""
    scene = SCENES[name]
    run = xa.sightseer(scene, "17/2", start=None if scene.start is not None else (-2, "-7/3"))
    complex_ = VisibilityComplex(EdgeTable(scene.obstacles), Range(run.radius))
    rails, several = complex_.clipper.rails, 0
    for piece in run.path:
        if piece.kind != "straight":
            continue
        for leg in legs_of(complex_.table, rails, piece.obstacle, piece.curve):
            if leg.edge is None:
                way = WayViews(StraightWay(complex_, leg), frozenset(range(len(rails))), lambda *_: None)
                near = complex_.near(leg.spots)
                every = shown_to(way, [line for edge in near for line in edge.single_lines])
                assert shown_to(way, [line for edge in near for line in edge.whole_lines]) == every
                several += len(every)
    assert several
