"""The audit finds planted flaws of every kind by name, and nothing in good runs.

Most flaws are planted in one run whose knowledge can be written down by hand: a square of side 4, seen from
(0, 0) with radius 5/2. Its bottom, for one, is known up to 5/2 ahead of the robot that walks it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from functools import cache
from random import Random
from typing import Any

import pytest
from flint import fmpq
from gallery_runs import gallery_run
from hypothesis import given
from hypothesis import strategies as st
from nightly import examples, some
from strategies import EPS, Terrain, box, build, degenerate_terrain, random_terrain
from test_laws_of_runs import crowded_room, run_of

import exactacq as xa
from exactacq.auditing.audit import audit
from exactacq.errors import AuditError
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.sensing.event import SENSED, Ending, Event, EventKind, Reason
from exactacq.sensing.path import Path, Piece
from exactacq.strategies.run import Run, SeedSpreaderRun, SightseerRun
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import random_scene

Q = Fraction
SIDE = [Point(2, -2), Point(6, -2), Point(6, 2), Point(2, 2)]
"""Corners of the square: edges 0 to 3 are its bottom, right, top and left."""


@dataclass(frozen=True)
class KnownPart:
    """As `exactacq.sensing.map.Known`."""

    edge: int
    start: Point
    end: Point
    whole: bool = False


class Chart:
    """A map of one obstacle as plain shares of its edges: rows (edge, low, high)."""

    def __init__(self, run: Run, rows: Sequence[tuple[int, object, object]]) -> None:
        self.edges = run.scene.obstacles[0].edges
        self.rows = sorted(rows)
        whole = [row[1:] for row in self.rows] == [(0, 1)] * len(self.edges)
        self.seen = (0,) if rows else ()
        self.acquired, self.incomplete = ((0,), ()) if whole else ((), (0,) if rows else ())

    def _point(self, edge: int, share: object) -> Point:
        return self.edges[edge].point(fmpq(*Q(share).as_integer_ratio()))

    def known(self, _: int) -> tuple[KnownPart, ...]:
        return tuple(KnownPart(k, self._point(k, a), self._point(k, b)) for k, a, b in self.rows)

    def spots(self, _: int, point: Point) -> tuple[Point]:
        return (point,)

    def knows_some(self, spots: tuple[Point]) -> bool:
        (point,) = spots
        return any(
            point == part.start or (part.start != part.end and Segment(part.start, part.end).passes(point))
            for part in self.known(0)
        )

    def known_length(self, _: int) -> Length:
        return Length.sum(Segment(part.start, part.end).length for part in self.known(0))

    @property
    def frontier(self) -> tuple[tuple[int, Point], ...]:
        return tuple((0, p) for part in self.known(0) for p in (part.start, part.end))


class SquareRun(SightseerRun):
    """The run around the square, with the map it ought to have."""

    @property
    def map(self) -> Chart:  # type: ignore[override]
        return self.chart(6, Q(0))

    def map_at(self, event: Event) -> Chart:  # type: ignore[override]
        x, y = event.point.xy
        along = {0: x, 2: x - 2, 3: y + 2, 4: 6 - x}.get(event.after, 0)
        return self.chart(event.after, Q(along) if event.inside else Q(0))

    def chart(self, after: int, along: Fraction) -> Chart:
        """What is known after whole pieces and some way along the next."""
        return Chart(self, self.rows(after, along))

    def rows(self, after: int, along: Fraction) -> list[tuple[int, object, object]]:
        """Only the left is seen from afar; each other edge from its first corner on, up to 5/2 ahead."""
        reach = Q(5, 8)
        if after == 0:
            half = min(Q(2), Q(3, 2) + along) / 4
            return [(3, Q(1, 2) - half, Q(1, 2) + half)]
        done = [(3, 0, 1)]
        for edge, piece in ((0, 2), (1, 3), (2, 4)):
            if after >= piece:
                walked = Q(1) if after > piece else along / 4
                done.append((edge, 0, min(Q(1), walked + reach)))
        return done


@cache
def square_run() -> SquareRun:
    """start, sight, hit, acquire 3/2 along the top, stop."""
    run = xa.sightseer(build([[tuple(p.rational) for p in SIDE]], (0, 0)), Q(5, 2))
    moves = [event for event in run.events if event.kind not in SENSED]
    acquire = Event(EventKind.ACQUIRE, Point("9/2", 2), 0, 4, run.path, inside=True)
    sight = Event(EventKind.SIGHT, run.start, 0, 0, run.path)
    events = (moves[0], sight, moves[1], acquire, moves[2])
    values = {field.name: getattr(run, field.name) for field in fields(run)}
    return SquareRun(**{**values, "events": events})


def lying(rows: Callable[[list, int], list], kind: type[Chart] = Chart) -> Run:
    """The square's run with maps of another kind, or with other rows, given the true ones and the piece."""

    class Lying(SquareRun):
        def chart(self, after: int, along: Fraction) -> Chart:
            return kind(self, rows(self.rows(after, along), after))

    run = square_run()
    return Lying(**{field.name: getattr(run, field.name) for field in fields(run)})


def at_the_start(rows: list) -> Callable[[list, int], list]:
    """These rows before the first piece is walked, then the true ones."""
    return lambda honest, after: honest if after else rows


def with_piece(run: Run, k: int, *pieces: Piece) -> Run:
    """The run with one piece of its path replaced."""
    return replace(run, path=Path((*run.path[:k], *pieces, *run.path[k + 1 :])))


def with_event(run: Run, k: int, **changes: object) -> Run:
    """The run with one event changed."""
    return replace(run, events=(*run.events[:k], replace(run.events[k], **changes), *run.events[k + 1 :]))


def boundary(start: Sequence[object], end: Sequence[object], obstacle: int = 0) -> Piece:
    return Piece("boundary", obstacle, Segment(Point(*start), Point(*end)))


def straight(start: Sequence[object], end: Sequence[object]) -> Piece:
    return Piece("straight", None, Segment(Point(*start), Point(*end)))


def refused(run: Run, *words: str, samples: int = 200) -> None:
    """The audit names the flaw in these words."""
    with pytest.raises(AuditError) as caught:
        audit(run, samples=samples)
    for word in words:
        assert word in str(caught.value)


def test_square() -> None:
    audit(square_run())
    for seed in range(5):
        audit(square_run(), samples=30, seed=seed)


def test_other_strategies_are_not_audited() -> None:
    common = {field.name: getattr(square_run(), field.name) for field in fields(Run)}
    with pytest.raises(ValueError, match="no audit for a Run"):
        audit(Run(**common))


def test_a_sight_just_after_the_start_of_a_circle() -> None:
    """The corner is out of range by 10^-18: a place shortly before its sight is one before the start."""
    near = 2 + fmpq(1, 10**9)
    corner = xa.Polygon([(near, 7), (5, 7), (5, 8), (near, 8)])
    scene = xa.Scene([xa.Circle(("3/2", "11/2"), "1/2"), corner], start=(2, "11/2"))
    run = xa.sightseer(scene, radius="3/2")
    sight = next(event for event in run.events if event.kind is EventKind.SIGHT and event.obstacle == 1)
    assert sight.inside and 0 < sight.at < fmpq(1, 10**17)
    audit(run, samples=100)


GALLERY = ("figure1", "figure2", "circles", "squares", "m4", "m8", "m11")
EXAMPLES = examples(3, 100)


def terrain_of(rng: Random) -> Terrain:
    """Grid shapes with ties and tangencies, shapes in general position, or a crowded room."""
    kinds = (degenerate_terrain, lambda rng: random_terrain(rng, columns=2), crowded_room)
    return rng.choice(kinds)(rng)


class TestGoodRuns:
    @pytest.mark.parametrize("name", some(reversed(GALLERY), 4))
    def test_gallery(self, name: str) -> None:
        audit(gallery_run(name))

    @EXAMPLES
    @given(st.randoms(use_true_random=False))
    def test_random_scenes(self, rng: Random) -> None:
        run = run_of(terrain_of(rng))
        if run is not None:
            audit(run, samples=16)

    def test_nothing_in_sight(self) -> None:
        """No piece and one place: what the start alone sees."""
        audit(xa.sightseer(build([box(2, 3, 0, 1)], (0, 0)), 1))
        audit(xa.sightseer(xa.Scene([], start=(0, 0)), 1))

    def test_a_gap(self) -> None:
        """Through a gap of 10^-60 between two walls a third obstacle is seen."""
        shapes = [box(2, 3, 0, 3), box(2, 3, -3, -EPS), box(5, 6, -1, 1)]
        run = xa.sightseer(build(shapes, (0, 0)), 10)
        assert "sight" in [event.kind for event in run.events if event.obstacle == 2 and event.after == 0]
        audit(run)


class TestRealMaps:
    """Maps of another moment than the asked one, in a run whose O2 is acquired before it is visited."""

    @pytest.mark.parametrize(("step", "word"), [(-1, "lacks the point"), (1, "knows the point")])
    def test_off_by_an_event(self, step: int, word: str) -> None:
        class Shifted(SightseerRun):
            def map_at(self, event: object) -> object:
                if event.kind == "moment":
                    return super().map_at(event)
                k = next(k for k, other in enumerate(self.events) if other is event) + step
                return super().map_at(self.events[min(max(k, 0), len(self.events) - 1)])

        run = xa.sightseer(xa.load("figure1"))
        shifted = Shifted(**{field.name: getattr(run, field.name) for field in fields(run)})
        refused(shifted, "the map at event", word)

    def test_acquired_too_early(self) -> None:
        """O2 is acquired during the loop of O1, not at its beginning."""
        run = xa.sightseer(xa.load("figure1"))
        k = next(k for k, e in enumerate(run.events) if (e.kind, e.obstacle) == ("acquire", 1))
        hit = next(e for e in run.events if e.kind == "hit")
        early = replace(run.events[k], point=hit.point, after=hit.after, inside=False)
        events = [e for e in run.events if e is not run.events[k]]
        sight = next(m for m, e in enumerate(events) if (e.kind, e.obstacle) == ("sight", 1))
        at = max(sight, events.index(hit)) + 1
        early = replace(
            early, point=events[at - 1].point, after=events[at - 1].after, inside=events[at - 1].inside
        )
        refused(replace(run, events=(*events[:at], early, *events[at:])), "(acquire of obstacle 1)")


class TestPath:
    """Pieces: 0 goes straight to (2, 0); 1 to 5 walk round by (2, -2), (6, -2), (6, 2) and (2, 2)."""

    def test_start_elsewhere(self) -> None:
        refused(replace(square_run(), start=Point(Q(1, 10**30), 0)), "piece 0", "the run starts")

    def test_gap(self) -> None:
        run = square_run()
        refused(with_piece(run, 2, boundary((2, -2), (5, -2))), "piece 3 starts at (6, -2)", "(5, -2)")

    def test_invisible_gap(self) -> None:
        short = boundary((2, -2), (6 - Q(1, 10**60), -2))
        refused(with_piece(square_run(), 2, short), "piece 3")

    def test_through_the_obstacle(self) -> None:
        across = straight((2, -2), (6, 2)), straight((6, 2), (6, -2))
        refused(with_piece(square_run(), 2, *across), "piece 2", "interior of obstacle 0", "(4, 0)")

    def test_a_shaving_of_the_obstacle(self) -> None:
        low = -2 + Q(1, 10**60)
        way = [(0, 0), (1, low), (7, low), (7, -3), (1, -3), (2, 0)]
        refused(
            with_piece(square_run(), 0, *map(straight, way, way[1:])), "piece 1", "interior of obstacle 0"
        )

    def test_grazing_is_free(self) -> None:
        """Along an edge and past a corner: the flaw found is the next one."""
        way = [(0, 0), (0, -2), (8, -2), (8, 8), (0, 0), (2, 0)]
        refused(with_piece(square_run(), 0, *map(straight, way, way[1:])), "event 2 (hit of obstacle 0)")

    def test_off_the_boundary(self) -> None:
        beside = boundary((2, -2), (4, -2 - Q(1, 10**40))), boundary((4, -2 - Q(1, 10**40)), (6, -2))
        refused(with_piece(square_run(), 2, *beside), "piece 2", "edge of obstacle 0")

    def test_over_a_corner(self) -> None:
        corner = boundary((2, 0), (3, -2)), boundary((3, -2), (6, -2))
        refused(with_piece(with_piece(square_run(), 1), 1, *corner), "piece 1", "edge of obstacle 0")

    def test_boundary_of_nothing(self) -> None:
        run = square_run()
        refused(with_piece(run, 2, replace(run.path[2], obstacle=1)), "piece 2")
        refused(with_piece(run, 2, replace(run.path[2], obstacle=None)), "piece 2")
        refused(with_piece(run, 2, replace(run.path[2], kind="tunnel")), "piece 2", "tunnel")

    @pytest.mark.parametrize("digits", [3, 400, 490])
    def test_length(self, digits: int) -> None:
        run = replace(square_run())
        run.__dict__["length"] = square_run().length + Length(Q(1, 10**digits))
        refused(run, "the length")

    def test_arc_outside_its_edge(self) -> None:
        """Three quarters of a circle bound a room of which the last quarter is a straight edge."""
        run = xa.sightseer(build([[(1, 0, 1), (-1, 0)]], (-3, 0)), 5)
        curve = next(piece.curve for piece in run.path if isinstance(piece.curve, Arc))
        k = next(k for k, piece in enumerate(run.path) if piece.curve is curve)
        arc = Arc(curve.start, curve.end, curve.center, curve.radius_sq, not curve.ccw)
        refused(with_piece(run, k, replace(run.path[k], curve=arc)), f"piece {k}", "edge of obstacle 0")


class TestEvents:
    """Events: 0 start, 1 sight, 2 hit, 3 acquire, 4 stop."""

    def test_swapped(self) -> None:
        a, b, c, d, e = square_run().events
        refused(
            replace(square_run(), events=(a, b, d, c, e)), "event 3 (hit of obstacle 0)", "event 2 (acquire"
        )
        refused(replace(square_run(), events=(a, c, b, d, e)), "event 2 (sight", "event 1 (hit")
        refused(replace(square_run(), events=(b, a, c, d, e)), "start")

    def test_swapped_within_a_piece(self) -> None:
        a, b, c, d, e = square_run().events
        lost = replace(d, kind=EventKind.LOSE, reason=Reason.RANGE, point=Point(5, 2))
        refused(
            replace(square_run(), events=(a, b, c, d, lost, e)),
            "event 4 (lose",
            "event 3 (acquire",
            "before it",
        )

    def test_off_the_path(self) -> None:
        refused(
            with_event(square_run(), 3, point=Point(Q(9, 2), 2 + Q(1, 10**400))), "event 3", "not on the path"
        )
        refused(with_event(square_run(), 3, after=3), "event 3", "not on the path")
        refused(with_event(square_run(), 2, point=Point(2, Q(1, 10**9))), "event 2", "not on the path")
        refused(with_event(square_run(), 4, after=7), "event 4", "not on the path")

    def test_unknown_kind(self) -> None:
        refused(with_event(square_run(), 3, kind=EventKind.DIVERT), "event 3", "no known kind")

    def test_missing_ends(self) -> None:
        run = square_run()
        refused(replace(run, events=run.events[1:]), "start")
        refused(replace(run, events=run.events[:-1]), "stop")
        refused(with_event(run, 4, point=run.path[4].end, after=5), "end of the path")

    @pytest.mark.parametrize("kind", ["leave", "backtrack"])
    def test_wrong_move(self, kind: str) -> None:
        refused(with_event(square_run(), 2, kind=EventKind(kind)), f"event 2 ({kind}", "cannot follow")

    def test_sights_in_the_wrong_order(self) -> None:
        a, b, c, d, e = square_run().events
        lose, regain = replace(d, kind=EventKind.LOSE, reason=Reason.RANGE), replace(d, kind=EventKind.REGAIN)
        cases = (
            ((a, c, d, e), "event 1 (hit of obstacle 0) comes before"),
            ((a, b, b, c, d, e), "event 1 (sight of obstacle 0) cannot follow sight"),
            ((a, b, c, regain, d, e), "event 3 (regain of obstacle 0) cannot follow sight"),
            ((a, b, c, lose, lose, d, e), "cannot follow lose"),
            ((a, b, c, d, lose, e), "event 4 (lose of obstacle 0) cannot follow acquire"),
            ((a, b, c, d, d, e), "cannot follow acquire"),
            ((a, b, c, replace(lose, reason=Reason.OVERDUE), regain, d, e), "overdue"),
        )
        for events, words in cases:
            refused(replace(square_run(), events=events), words)

    def test_missing_acquire(self) -> None:
        a, b, c, _, e = square_run().events
        refused(replace(square_run(), events=(a, b, c, e)), "acquired in events", "[0]")


class TestAccounts:
    @pytest.mark.parametrize(
        "ending", [None, *(ending for ending in Ending if ending not in ("all visited", "undecided"))]
    )
    def test_another_ending(self, ending: Ending | None) -> None:
        refused(with_event(square_run(), 4, ending=ending), "event 4 (stop", "which is not so")

    def test_visits(self) -> None:
        refused(replace(square_run(), visits=()), "visits")
        refused(replace(square_run(), visits=(0, 0)), "visits")

    def test_part_of_a_loop(self) -> None:
        """To (4, -2) and back, then round: no walk in one go."""
        run = square_run()
        there, back = boundary((2, -2), (4, -2)), boundary((4, -2), (2, -2))
        path = Path((*run.path[:2], there, back, *run.path[2:]))
        events = (*run.events[:2], replace(run.events[2]), replace(run.events[4], after=len(path)))
        longer = replace(run, path=path, events=tuple(replace(event, path=path) for event in events))
        refused(longer, "obstacle 0 was not walked all around")

    def test_no_loop(self) -> None:
        run = square_run()
        path = Path(run.path[:1])
        events = tuple(
            replace(event, path=path) for event in (*run.events[:3], replace(run.events[4], after=1))
        )
        refused(replace(run, path=path, events=events), "obstacle 0 was not walked all around")

    def test_links(self) -> None:
        (link,) = square_run().links
        for changes, words in (
            ({"length": Length(2) + Length(Q(1, 10**480))}, "the link from S to 0 is not"),
            ({"traversals": 2}, "the link from S to 0 was walked 1 times"),
            ({"hit": Point(2, 1)}, "event 2 (hit of obstacle 0)"),
            ({"leave": Point(0, 1)}, "event 2 (hit of obstacle 0)"),
            ({"target": 1}, "event 2 (hit of obstacle 0) has no link"),
            ({"source": 1}, "event 2 (hit of obstacle 0) has no link"),
        ):
            refused(replace(square_run(), links=(replace(link, **changes),)), words)

    def test_radius_below_a_link(self) -> None:
        refused(replace(square_run(), radius=fmpq(2) - fmpq(1, 10**60)), "longer than the radius")

    def test_stack_depth(self) -> None:
        refused(replace(square_run(), stack_depth=2), "1 deep, not 2")

    def test_unseen(self) -> None:
        refused(replace(square_run(), unseen=(0,)), "unseen are [0], by the map []")
        refused(replace(square_run(), unvisited=(0,)), "unvisited are [0], by the map []")

    @pytest.mark.parametrize("k", range(4))
    def test_bounds(self, k: int) -> None:
        run = square_run()
        bound = run.bounds[k]
        for changes, word in (
            ({"value": bound.value + Length(Q(1, 10**450))}, bound.name),
            ({"holds": not bound.holds}, "holds"),
            ({"ratio": bound.ratio * (1 + 1e-9)}, "ratio"),
            ({"ratio": float("nan")}, "ratio"),
            ({"name": "(3)"}, "(3)"),
        ):
            bounds = (*run.bounds[:k], replace(bound, **changes), *run.bounds[k + 1 :])
            refused(replace(run, bounds=bounds), "bound", word)

    def test_missing_bound(self) -> None:
        refused(replace(square_run(), bounds=square_run().bounds[1:]), "the bounds are")


class TestMaps:
    """Flaws of the map alone: it is consistent in itself, but not what the path sees, or not consistent."""

    def test_a_part_is_lost(self) -> None:
        refused(lying(lambda rows, after: rows[1:]), "acquired in events")

    def test_a_part_is_lost_on_the_way(self) -> None:
        run = lying(lambda rows, after: rows[1:] if after == 4 else rows)
        refused(run, "the map at event 3 (acquire of obstacle 0)")
        between = lying(lambda rows, after: rows[1:] if after in (2, 3) else rows)
        refused(between, "the map at (", "on piece 2 lacks the point")

    def test_a_part_is_added(self) -> None:
        run = lying(at_the_start([(1, Q(3, 4), Q(7, 8)), (3, Q(1, 8), Q(7, 8))]))
        refused(run, "the map at event", "knows the point (6, ", "of obstacle 0, which no place of the path")

    def test_a_point_is_added(self) -> None:
        """A single point is known to the map only: it shows in the frontier, and in what lies beside it."""
        run = lying(at_the_start([(1, Q(1, 2), Q(1, 2)), (3, Q(1, 8), Q(7, 8))]))
        refused(run, "knows the point (6, 0)")

    @pytest.mark.parametrize("size", some([Q(1, 10**9), Q(1, 10**5), Q(1, 10)], 1))
    def test_a_part_is_longer_or_shorter(self, size: Fraction) -> None:
        for shift, words in ((size, "knows the point (2, -1."), (-size, "lacks the point (2, -1.")):
            refused(lying(at_the_start([(3, Q(1, 8), Q(7, 8) + shift)])), "the map at event", words)

    def test_a_part_is_shifted(self) -> None:
        shift = Q(1, 10**9)
        run = lying(at_the_start([(3, Q(1, 8) + shift, Q(7, 8) + shift)]))
        refused(run, "the map at event", "the point (2, ")

    def test_known_length(self) -> None:
        class Shifted(Chart):
            def known_length(self, i: int) -> Length:
                return super().known_length(i) + Length(Q(1, 10**450))

        refused(lying(lambda rows, after: rows, Shifted), "known length of obstacle 0")

    @pytest.mark.parametrize(
        ("rows", "words"),
        [
            ([(0, 0, Q(1, 2)), (0, Q(1, 2), 1)], "is not beyond the one before"),
            ([(0, 0, Q(3, 4)), (0, Q(1, 2), 1)], "is not beyond the one before"),
            ([(0, Q(3, 4), Q(1, 2))], "runs against edge 0"),
            ([(0, 0, 0), (0, 0, 1)], "is not beyond the one before"),
        ],
    )
    def test_parts_out_of_order(self, rows: list, words: str) -> None:
        refused(lying(at_the_start(rows)), words)

    @pytest.mark.parametrize(
        ("name", "words"),
        [
            ("acquired", "acquired obstacles are [0]"),
            ("incomplete", "incomplete obstacles are []"),
            ("seen", "seen obstacles are []"),
            ("frontier", "missing in the frontier"),
        ],
    )
    def test_lists(self, name: str, words: str) -> None:
        """Lists of the map at the start, where the obstacle is seen and incomplete."""
        honest = {"acquired": (0,), "incomplete": (), "seen": (), "frontier": ()}[name]

        class Listing(Chart):
            def __getattribute__(self, key: str) -> object:
                value = super().__getattribute__(key)
                return honest if key == name and len(self.rows) == 1 else value

        refused(lying(lambda rows, after: rows, Listing), words)

    def test_early_acquire(self) -> None:
        """At the corner before, only the first five eighths of the top are in range."""
        run = with_event(square_run(), 3, point=Point(6, 2), inside=False)

        class Early(type(run)):  # type: ignore[misc]
            def chart(self, after: int, along: Fraction) -> Chart:
                return super().chart(after if after < 4 else 5, along)

        early = Early(**{field.name: getattr(run, field.name) for field in fields(run)})
        refused(early, "event 3 (acquire of obstacle 0)")

    def test_late_sight(self) -> None:
        run = square_run()
        late = replace(run.events[1], point=Point(1, 0), inside=True)

        class Late(SquareRun):
            def chart(self, after: int, along: Fraction) -> Chart:
                return Chart(self, [] if (after, along) == (0, 0) else self.rows(after, along))

        events = (run.events[0], late, *run.events[2:])
        values = {field.name: getattr(run, field.name) for field in fields(run)}
        refused(Late(**{**values, "events": events}), "event 1 (sight of obstacle 0) is late")

    def test_lost_in_full_view(self) -> None:
        a, b, c, d, e = square_run().events
        lose = replace(b, kind=EventKind.LOSE, reason=Reason.OCCLUSION, point=Point(1, 0), inside=True)
        refused(replace(square_run(), events=(a, b, lose, c, d, e)), "obstacle 0 is not out of sight from")


class MovedEnd:
    """The final map of a run, but for an end of a known part: it is moved along its straight edge."""

    def __init__(self, chart: Any, obstacle: int, part: int, size: Fraction) -> None:
        self.chart, self.obstacle, self.part = chart, obstacle, part
        old = chart.known(obstacle)[part]
        way = old.end - old.start
        self.old, self.moved = old, old.start + way * (1 + size)
        self.sliver, self.grows = Segment(*sorted((old.end, self.moved), key=lambda p: p.xy)), size > 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self.chart, name)

    def known(self, i: int) -> list[Any]:
        parts = list(self.chart.known(i))
        if i == self.obstacle:
            parts[self.part] = replace(self.old, end=self.moved, curve=Segment(self.old.start, self.moved))
        return parts

    def known_length(self, i: int) -> Length:
        return Length.sum(part.length for part in self.known(i))

    def spots(self, i: int, point: Point) -> Any:
        self.asked = i, point
        return self.chart.spots(i, point)

    def knows_some(self, spots: Any) -> bool:
        i, point = self.asked
        if i == self.obstacle and point != self.moved and self.sliver.passes(point):
            return self.grows
        return bool(self.chart.knows_some(spots))

    @property
    def frontier(self) -> list[tuple[int, Point]]:
        ends = [(i, p) for i, p in self.chart.frontier if p != self.old.end]
        return [*ends, (self.obstacle, self.moved)]


class TestEndsOfTheFinalMap:
    """Each end of what is known in the end is asked for, whatever is sampled."""

    @pytest.mark.parametrize(("size", "word"), [(Q(1, 10**8), "knows"), (-Q(1, 10**8), "lacks")])
    def test_a_moved_end(self, size: Fraction, word: str) -> None:
        """The sweep is trapped in a hook, of which a part of the ground, up to (17/8, 3/2), is known."""
        run = xa.seed_spreader(random_scene(Subject.SEED_SPREADER, 45))
        audit(run, samples=0)
        parts = run.map.known(0)
        (part,) = (k for k, part in enumerate(parts) if part.end == Point("17/8", "3/2"))

        class Lying(SeedSpreaderRun):
            map = MovedEnd(run.map, 0, part, size)  # type: ignore[assignment]

        lying_run = Lying(**{field.name: getattr(run, field.name) for field in fields(run)})
        refused(lying_run, f"the final map {word} the point (2.12", samples=0)
