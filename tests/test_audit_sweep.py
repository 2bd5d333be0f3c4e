"""The audit of sweeps finds planted flaws of every kind by name, and nothing in good runs.

Paths are planted whole: the sensing of the planted path is repeated, so its maps fit, and what is wrong is
the move alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from fractions import Fraction as Q
from functools import cache
from random import Random
from typing import Any

import pytest
from flint import fmpq
from nightly import some
from planted_sweeps import (
    around,
    block,
    boundary,
    diverted,
    hanging,
    hasty,
    ladder,
    moves,
    resewn,
    shelf,
    straight,
    told,
    with_event,
    with_sights,
    without,
)
from sweeps import rectangle, swept_scene

import exactacq as xa
from exactacq import Circle, Polygon, Scene, Terrain
from exactacq.auditing.audit import audit
from exactacq.errors import AuditError
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.sensing.event import Ending, EventKind, Reason
from exactacq.sensing.path import Path, Piece
from exactacq.strategies.run import Run, SeedSpreaderRun
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import random_scene

SWEPT = (
    "case1", "case2", "case3", "e3", "figure3", "figure4", "m14", "m15", "m18", "m20-3", "m20-6", "m20-8",
    "m20-16", "m25",
)  # fmt: skip


def refused(run: Run, *words: str, samples: int = 8, seed: int = 0) -> None:
    """The audit names the flaw in these words."""
    with pytest.raises(AuditError) as caught:
        audit(run, samples=samples, seed=seed)
    for word in words:
        assert word in str(caught.value)


class TestGoodRuns:
    @pytest.mark.parametrize("name", some(SWEPT, 3))
    def test_gallery(self, name: str) -> None:
        audit(xa.seed_spreader(xa.load(name)), samples=24)

    @pytest.mark.parametrize("name", some(["m15", "m25", "m18"], 2))
    def test_options(self, name: str) -> None:
        audit(xa.seed_spreader(xa.load(name), lookahead=False), samples=16)
        audit(xa.seed_spreader(xa.load(name), target="visible"), samples=16)

    @pytest.mark.parametrize("seed", some(range(36), 8))
    def test_random_scenes(self, seed: int) -> None:
        scene = swept_scene(Random(seed), arcs=seed % 2 == 1, clear=seed % 5 == 0)
        target = "visible" if seed % 7 == 0 else "known"
        audit(xa.seed_spreader(scene, lookahead=seed % 3 != 0, target=target), samples=16)

    def test_a_ray_to_the_border_may_end_where_an_obstacle_begins(self) -> None:
        """What lies west of the triangle is the point where the circle meets the border: free on one side."""
        shapes = [Circle((0, 2), 1), Polygon([(2, 1), (3, 1), (2, 3)])]
        audit(xa.seed_spreader(Scene(shapes, terrain=Terrain(8, 8)), 3), samples=16)

    def test_a_ray_to_the_border_may_end_in_a_bay(self) -> None:
        """West of the circle is a bay that touches the border from within, blocked on both sides there."""
        bay = xa.Outline([(-1, 1), (1, 1, -1), (1, 3), (-1, 3)])
        audit(xa.seed_spreader(Scene([bay, Circle((3, 2), 1)], terrain=Terrain(8, 8)), Q(5, 2)), samples=16)
        wedge = Polygon([(-1, 1), (1, 1), (0, 2), (1, 3), (-1, 3)])
        audit(xa.seed_spreader(Scene([wedge, Circle((3, 2), 1)], terrain=Terrain(8, 8)), 3), samples=16)

    @pytest.mark.parametrize("unit", [fmpq(1, 10**6), fmpq(1, 10**30)])
    def test_a_scene_that_is_one_float(self, unit: fmpq) -> None:
        """Lines of sight are looked for in floats: as seen from the line these tell its places apart."""
        scene = xa.load("m25")
        shapes = [[(1 + unit * x, 1 + unit * y) for x, y, _ in shape.vertices] for shape in scene.shapes]
        (x, y), width, height = scene.terrain.origin, scene.terrain.width, scene.terrain.height
        terrain = Terrain(unit * width, unit * height, (1 + unit * x, 1 + unit * y))
        audit(xa.seed_spreader(Scene(shapes, terrain=terrain), unit * scene.radius), samples=8)

    def test_empty_terrain(self) -> None:
        audit(xa.seed_spreader(Scene([], terrain=Terrain(10, 4)), 3))
        audit(xa.seed_spreader(Scene([], terrain=Terrain(Q(7, 3), 1)), 9))

    def test_what_cannot_be_reached(self) -> None:
        """A wall from border to border, an obstacle behind it, and a pocket."""
        wall, behind, before = (
            rectangle(-1, 2, 5, 3),
            rectangle(1, Q(7, 2), 2, 5),
            rectangle(1, 1, 2, Q(3, 2)),
        )
        audit(xa.seed_spreader(Scene([wall, behind, before], terrain=Terrain(4, 4)), 1))
        hook = Polygon([(2, 5), (2, 1), (6, 1), (6, 2), (3, 2), (3, 5)])
        audit(xa.seed_spreader(Scene([hook, rectangle(4, 3, 5, 4)], terrain=Terrain(6, 5)), 2))
        notch = Polygon([(1, 5), (1, 2), (2, 2), (Q(5, 2), 4), (3, 2), (4, 2), (4, 5)])
        audit(xa.seed_spreader(Scene([notch], terrain=Terrain(8, 4)), 3))

    def test_trapped(self) -> None:
        audit(xa.seed_spreader(Scene([xa.Circle((9, 0), 1)], terrain=Terrain(9, 4)), 3))


class TestSensing:
    """What the sensor once got wrong, as audits of random scenes showed."""

    def test_a_corner_seen_alone(self) -> None:
        """From S the corner (5, 0) is at distance 5, and one of its edges lies on the border."""
        audit(xa.seed_spreader(Scene([Polygon([(5, 0), (7, 0), (7, 3)])], terrain=Terrain(8, 8)), 5))

    def test_past_the_end_of_an_edge_across_the_way(self) -> None:
        """The line x = 7 passes the corner (7, 2), whose edge to the east is in range from y = 3 on."""
        scene = Scene([Polygon([(9, 1), (9, 2), (7, 2)])], terrain=Terrain(10, 8))
        audit(xa.seed_spreader(scene, 1), samples=200)

    def test_a_tangency_ahead(self) -> None:
        """Past the corner (0, 4) only the point (0, 11/2) of the circle is in sight, from y = 5/2 on."""
        shapes = [xa.Circle((Q(1, 2), Q(11, 2)), Q(1, 2)), Polygon([(1, 2), (1, 4), (0, 4)])]
        audit(xa.seed_spreader(Scene(shapes, terrain=Terrain(6, 10)), 3), samples=200)

    def test_a_cut_seen_from_the_start_of_a_circle(self) -> None:
        """A leg that ends at a circle's start, (2, 11/2), meets the view of O1's end at (3, 6) there."""
        shapes = [xa.Circle((Q(1, 2), Q(11, 2)), Q(3, 2)), rectangle(3, 5, 6, 8)]
        audit(xa.seed_spreader(Scene(shapes, terrain=Terrain(14, 6)), 3))

    def test_range_at_a_cut(self) -> None:
        """From x = 5 the cut end (22/3, 6) is in range from y = 5.1 on, not from 5.75 on."""
        scene = Scene([Polygon([(8, 5), (8, 8), (6, 8)])], terrain=Terrain(14, 6))
        audit(xa.seed_spreader(scene, Q(5, 2)), samples=200)


# -- planting --------------------------------------------------------------------------------------


class TestPlanting:
    @pytest.mark.parametrize("make", [block, shelf, hanging, hasty, around, ladder])
    def test_nothing(self, make: Callable[[], Run]) -> None:
        """To replace nothing leaves a good run."""
        audit(resewn(make(), 0, 0), samples=8)


# -- flaws -----------------------------------------------------------------------------------------


class TestMLine:
    def test_start_elsewhere(self) -> None:
        path = Path((*straight((0, 1), (0, 8)), *block().path[1:]))
        events = [replace(event, path=path) for event in moves(block())]
        events[0] = replace(events[0], point=Point(0, 1))
        run = replace(block(), start=Point(0, 1), path=path, events=tuple(events), record=None)
        refused(with_sights(run), "the run starts at (0, 1), not in the SW corner")

    def test_off_the_line(self) -> None:
        for x in (1, Q(1, 10**300)):
            run = resewn(block(), 0, 1, *straight((0, 0), (x, 4), (0, 8)))
            refused(run, "piece 0 does not advance on the M-line")

    def test_to_and_fro(self) -> None:
        run = resewn(block(), 0, 1, *straight((0, 0), (0, 5), (0, 4), (0, 8)))
        refused(run, "piece 1 does not advance on the M-line")

    def test_outside(self) -> None:
        run = resewn(block(), 0, 1, *straight((0, 0), (-1, 4), (0, 8)))
        refused(run, "piece 0 leaves the terrain")

    def test_under_an_obstacle_at_the_border(self) -> None:
        """Along the border no interior is entered, but on its side of it is none but the obstacle's."""
        run = resewn(hanging(), 1, 6, *straight((0, 8), (3, 8)))
        refused(run, "piece 1 follows the M-line where it is blocked, at (1, 8)")

    def test_through(self) -> None:
        run = resewn(block(), 3, 11, *straight((3, 4), (3, 2)))
        refused(run, "piece 3 passes through the interior of obstacle 0")

    def test_stops_early(self) -> None:
        run = with_event(resewn(block(), 13, 14), "stop", point=Point(6, 0))
        refused(run, "(stop) comes before the end of the M-line")

    def test_goes_on(self) -> None:
        run = with_event(resewn(block(), 14, 14, *straight((6, 8), (6, 0))), "stop", point=Point(6, 0))
        refused(run, "piece 14 goes on from the end of the M-line")


class TestHits:
    def test_not_hit(self) -> None:
        """A walk around without a word."""
        run = without(without(block(), "hit"), "leave")
        refused(run, "piece 3 does not advance on the M-line")

    def test_another_obstacle(self) -> None:
        scene = Scene([rectangle(2, 2, 4, 4), rectangle(5, 5, Q(11, 2), 6)], terrain=Terrain(6, 8))
        run = xa.seed_spreader(scene, 3)
        refused(with_event(run, "hit", obstacle=1), "(hit of obstacle 1) is not where", "begins to block")

    def test_known_or_not(self) -> None:
        refused(
            with_event(block(), "hit", kind=EventKind.CROSS),
            "(cross of obstacle 0)",
            "hit of obstacle 0 is due",
        )
        refused(
            with_event(ladder(), "cross", kind=EventKind.HIT),
            "(hit of obstacle 0)",
            "cross of obstacle 0 is due",
        )

    def test_clockwise(self) -> None:
        loop = boundary(0, (3, 4), (4, 4), (4, 2), (2, 2), (2, 4), (3, 4))
        refused(resewn(block(), 3, 8, *loop), "obstacle 0 was not walked all around after", "(hit of")

    def test_no_loop(self) -> None:
        refused(resewn(block(), 3, 8), "obstacle 0 was not walked all around")

    def test_a_needless_loop(self) -> None:
        """The third line meets the bar again, and walks around it again."""
        run = ladder()
        left, right, low, top = Q(1, 10), Q(39, 10), 2, Q(201, 100)
        loop = boundary(0, (2, low), (right, low), (right, top), (left, top), (left, low), (2, low))
        refused(
            resewn(run, 14, 15, *loop, run.path[14]), "(leave of obstacle 0) is not reached the shorter way"
        )

    def test_one_end_only(self) -> None:
        """From (3, 3), on top of an obstacle at the southern border, only to the end where it is left."""
        run = xa.seed_spreader(Scene([rectangle(2, -1, 4, 3)], terrain=Terrain(6, 8)), 3)
        ends = ["(2, 3)", "(2, 0)", "(2, 3)", "(4, 3)", "(4, 0)"]
        assert [str(piece.end) for piece in run.path[3:8]] == ends
        refused(
            resewn(run, 3, 8, *boundary(0, (3, 3), (4, 3), (4, 0))),
            "obstacle 0 was not walked all around after",
        )

    def test_unequal_ways(self) -> None:
        """From (3, 4) by the east to (3, 2) it is as far as by the west, which comes first."""
        east = boundary(0, (3, 4), (4, 4), (4, 2), (3, 2))
        refused(resewn(block(), 8, 11, *east), "(leave of obstacle 0) is not reached the shorter way")

    def test_the_longer_way(self) -> None:
        run = xa.seed_spreader(Scene([rectangle(2, 2, 5, 4)], terrain=Terrain(6, 8)), 3)
        k = next(k for k, event in enumerate(run.events) if event.kind == "leave")
        last = run.events[k].after
        first = next(e.after for e in run.events if e.kind == "hit") + 5
        east = boundary(0, (3, 4), (5, 4), (5, 2), (3, 2))
        refused(resewn(run, first, last, *east), "(leave of obstacle 0) is not reached the shorter way")

    def test_leaves_elsewhere(self) -> None:
        """At the corner (2, 2), and from there aside of the line."""
        run = resewn(block(), 10, 11, *straight((2, 2), (3, 2)))
        run = with_event(run, "leave", after=10, point=Point(2, 2))
        refused(run, "(leave of obstacle 0)")

    def test_leaves_in_silence(self) -> None:
        refused(without(block(), "leave"), "(stop)", "is not")

    def test_trapped(self) -> None:
        run = xa.seed_spreader(Scene([xa.Circle((9, 0), 1)], terrain=Terrain(9, 4)), 3)
        refused(with_event(run, "stop", ending=Ending.END_OF_M_LINE), "(stop", "trapped is True")
        refused(with_event(run, "stop", ending=Ending.WAY_CLOSED), "(stop", "closes the straight way")
        refused(with_event(block(), "stop", ending=Ending.TRAPPED), "(stop)", "trapped is False")

    @pytest.mark.parametrize(
        ("change", "words"),
        [
            (lambda run: replace(run, visits=()), "visits are []"),
            (lambda run: replace(run, visits=(0, 0)), "visits are [0, 0]"),
            (lambda run: told(run, encounters=(0,)), "encounters are [0], but the moves make [0, 0, 0]"),
            (lambda run: told(run, again=(0,)), "encounters of known obstacles are [0]"),
            (lambda run: replace(run, unseen=(0,)), "obstacles unseen are [0], by the map []"),
            (lambda run: replace(run, unvisited=(0,)), "obstacles unvisited are [0], by the map []"),
            (lambda run: told(run, unreached=(0,)), "obstacles out of reach are [0], not []"),
        ],
    )
    def test_accounts(self, change: Callable[[Run], Run], words: str) -> None:
        refused(change(ladder()), words)


class TestDiversions:
    @pytest.mark.parametrize(
        ("changes", "words"),
        [
            ({"obstacle": 1}, "divert of obstacle 1 is due"),
            ({"leave": Point(20, 51)}, "(divert of obstacle 0) is not diversion 0"),
            ({"hit": Point(9, 51)}, "(divert of obstacle 0) does not aim at the nearest known point"),
            ({"hit": Point(10, 52)}, "diversion 0 did not reach (10, 52)"),
            ({"reason": "out of reach"}, "(divert of obstacle 0) is not diversion 0"),
            ({"first": 0}, "(divert of obstacle 0) is not diversion 0"),
            ({"last": 12}, "(return of obstacle 0) is not the end of diversion 0"),
        ],
    )
    def test_accounts(self, changes: dict[str, Any], words: str) -> None:
        refused(diverted(hasty(), **changes), words)

    def test_lists(self) -> None:
        run = hasty()
        refused(told(run, diversions=()), "is in no list of diversions")
        refused(told(run, diversions=run.diversions * 2), "diversions are 2, the moves make 1")

    @pytest.mark.parametrize("reason", ["out of reach", "overdue", "the line ends", "occlusion"])
    def test_other_reasons(self, reason: str) -> None:
        why = Reason(reason)
        run = diverted(
            with_event(with_event(hasty(), "divert", reason=why), "return", reason=why), reason=why
        )
        refused(run, f"(divert of obstacle 0) is due to '{reason}', which is not so")

    def test_needless(self) -> None:
        """With a look ahead W is seen again, beyond E."""
        refused(
            told(hasty(), lookahead=True), "(divert of obstacle 0) is needless: by the map", "is seen from"
        )

    def test_missing_out_of_sight(self) -> None:
        refused(
            told(xa.seed_spreader(xa.load("m25")), lookahead=False), "(lose of obstacle 0) is not followed by"
        )

    def test_missing_out_of_reach(self) -> None:
        run = around()
        (diversion,) = run.diversions
        sewn = resewn(run, diversion.first, diversion.last)
        events = tuple(event for event in sewn.events if event.kind not in ("divert", "return"))
        refused(
            replace(told(sewn, diversions=()), events=events),
            "obstacle 0 is out of reach",
            "without a diversion",
        )

    def test_missing_at_the_end_of_a_line(self) -> None:
        run = xa.seed_spreader(swept_scene(Random(94), True, clear=True), lookahead=False)
        (diversion,) = run.diversions
        sewn = resewn(run, diversion.first, diversion.last)
        events = tuple(event for event in sewn.events if event.kind not in ("divert", "return"))
        refused(replace(told(sewn, diversions=()), events=events), f"obstacle {diversion.obstacle} is lost")

    def test_aims_at_another_point(self) -> None:
        """On to (8.5, 52), along the top of W, and around from there."""
        run, corners = hasty(), ((9, 52), (Q(17, 2), 52), (Q(17, 2), 48), (9, 48))
        out, back = run.path[3:5], run.path[11:13]
        loop = boundary(0, corners[1], corners[2], corners[3], corners[0], corners[1])
        pieces = [*out, *straight((11, 52), corners[1]), *loop, *straight(corners[1], (11, 52)), *back]
        path = Path((*run.path[:3], *pieces, *run.path[13:]))
        assert len(path) == len(run.path)
        run = replace(run, path=path, record=None)
        run = replace(run, events=tuple(replace(event, path=path) for event in run.events))
        run = with_event(run, "hit", point=Point(*corners[1]))
        run = with_event(run, "leave", point=Point(*corners[1]))
        run = with_sights(replace(run, events=tuple(moves(run))))
        refused(diverted(run, hit=Point(*corners[1])), "does not aim at the nearest known point")

    def test_aims_at_a_hidden_point(self) -> None:
        """From D = (8, 4) the nearest known point is hidden, another one is in sight."""
        scene = swept_scene(Random(89), True, clear=True)
        run = xa.seed_spreader(scene, lookahead=False)
        seen = xa.seed_spreader(scene, lookahead=False, target="visible")
        audit(seen, samples=8)
        refused(told(run, target="visible"), "does not aim at a visible point")
        refused(told(seen, target="known"), "does not aim at the nearest known point")

    def test_not_around(self) -> None:
        refused(
            resewn(hasty(), 6, 10), "obstacle 0 was not walked all around after", "(divert of obstacle 0)"
        )

    def test_does_not_return(self) -> None:
        """To (20, 51) in place of (20, 52)."""
        path = Path((*hasty().path[:12], *straight((Q(23, 2), 52), (20, 51), (20, 0))))
        events = tuple(replace(event, path=path) for event in moves(hasty()))
        run = with_event(
            replace(hasty(), path=path, events=events, record=None), "return", point=Point(20, 51)
        )
        refused(with_sights(run), "piece 12 is not on the way to (20, 52)")

    def test_blocker_on_the_way(self) -> None:
        """E is passed the longer way."""
        run = around()
        hit = next(event for event in run.events if event.kind == "hit")
        a, b = run.path[hit.after].start, run.path[hit.after + 1].end
        corners = [Point(12, 45), Point(12, 55), Point(11, 55)]
        pieces = [Segment(p, q) for p, q in zip([a, *corners], [*corners, b], strict=True)]
        run = resewn(run, hit.after, hit.after + 2, *(Piece("boundary", 1, piece) for piece in pieces))
        refused(diverted(run, last=run.diversions[0].last + 2), "is not reached the shorter way")

    def test_silent_blocker(self) -> None:
        run = around()
        refused(without(without(run, "hit"), "leave"), "piece 4 is not on the way to (11.63")


class TestComponents:
    """Components as `exactacq.scene.terrain_components` does not make them."""

    @staticmethod
    def _with(run: Run, change: Callable[[list[Any]], Sequence[Any]]) -> Run:
        planted = replace(run)
        ground = run.ground

        class Ground:
            components = tuple(change(list(ground.components)))
            unreached = ground.unreached

        planted.__dict__["ground"] = Ground()
        return planted

    @staticmethod
    @cache
    def run() -> Run:
        """A wall across, one end of a line family beyond it, and one obstacle before it."""
        shapes = [rectangle(-1, 4, 7, 5), rectangle(1, 1, 2, 2), rectangle(3, -1, 4, 1)]
        return xa.seed_spreader(Scene(shapes, terrain=Terrain(6, 8)), 3)

    def test_good(self) -> None:
        audit(self._with(self.run(), lambda parts: parts))

    @pytest.mark.parametrize(
        ("change", "words"),
        [
            (lambda c: c[:2], "is part of 0 components, not of 1"),
            (lambda c: [c[0], c[2], c[1]], "not in their order"),
            (lambda c: [c[0], c[1], replace(c[2], obstacle=c[1].obstacle)], "is not on edge"),
            (lambda c: [*c[:2], replace(c[2], shore=c[2].shore[:-1])], "is part of 0 components"),
            (
                lambda c: [*c[:2], replace(c[2], shore=(*c[2].shore, c[2].shore[0]))],
                "is part of 2 components",
            ),
            (lambda c: [*c[:2], replace(c[2], closed=True)], "whether it is a loop"),
            (lambda c: [c[0], replace(c[1], closed=False), c[2]], "whether it is a loop"),
            (lambda c: [replace(c[0], shore=c[0].hidden[0], hidden=(c[0].shore,)), *c[1:]], "be reached"),
            (lambda c: [replace(c[0], hidden=()), *c[1:]], "is part of 0 components, not of 1"),
            (lambda c: [*c[:2], replace(c[2], shore=c[2].shore[::-1])], "is not in one piece"),
            (lambda c: [c[0], replace(c[1], shore=c[1].shore[:2]), c[2]], "is part of 0 components"),
            (lambda c: [*c, c[2]], "is part of 2 components"),
        ],
    )
    def test_flaws(self, change: Callable[[list[Any]], Sequence[Any]], words: str) -> None:
        refused(self._with(self.run(), change), words)

    def test_merged(self) -> None:
        comb = Polygon([(1, 5), (1, 2), (2, 2), (2, 4), (3, 4), (3, 1), (4, 1), (4, 5)])
        run = xa.seed_spreader(Scene([comb], terrain=Terrain(6, Q(7, 2))), 9)
        assert len(run.obstacles) == 2
        merged = self._with(run, lambda c: [replace(c[0], shore=(*c[0].shore, *c[1].shore))])
        refused(merged, "components [0, 0] are in reach")

    def test_a_hair_too_short(self) -> None:
        def cut(components: list[Any]) -> list[Any]:
            part = components[2].shore[0]
            end = part.curve.start + part.curve.direction * Q(999999, 10**6)
            shorter = part._replace(curve=Segment(part.curve.start, end))
            return [*components[:2], replace(components[2], shore=(shorter, *components[2].shore[1:]))]

        refused(self._with(self.run(), cut), "component 2 has")


class TestKnowledge:
    """Maps of another moment than the asked one, and events of sight that do not fit."""

    @pytest.mark.parametrize(("step", "word"), [(-1, "lacks the point"), (1, "knows the point")])
    def test_off_by_a_piece(self, step: int, word: str) -> None:
        class Shifted(SeedSpreaderRun):
            def map_at(self, event: object) -> object:
                if event.kind == "moment":
                    return super().map_at(event)
                return self.memory.after(min(max(event.after + step, 0), len(self.path)))

        run = xa.seed_spreader(xa.load("case1"))
        shifted = Shifted(**{field.name: getattr(run, field.name) for field in fields(run)})
        refused(shifted, "the map at event", word, samples=200, seed=1)

    def test_acquired_too_early(self) -> None:
        """Said to be known at the hit, the square would have to be passed."""
        run = block()
        acquire = next(event for event in run.events if event.kind == "acquire")
        hit = next(event for event in run.events if event.kind == "hit")
        events = [event for event in run.events if event is not acquire]
        at = events.index(hit)
        early = replace(acquire, point=hit.point, after=hit.after, inside=False)
        refused(replace(run, events=(*events[:at], early, *events[at:])), "cross of obstacle 0 is due")

    def test_seen_but_not_acquired(self) -> None:
        run = ladder()
        k = next(k for k, event in enumerate(run.events) if event.kind == "acquire")
        events = run.events[:k] + run.events[k + 1 :]
        refused(replace(run, events=events), "(cross of obstacle 0)", "hit of obstacle 0 is due")

    def test_unknown_kind(self) -> None:
        refused(
            with_event(block(), "leave", kind=EventKind.BACKTRACK),
            "(backtrack of obstacle 0) is of no known kind",
        )


class TestBounds:
    @pytest.mark.parametrize("k", range(9))
    @pytest.mark.parametrize("make", [ladder, shelf])
    def test_values(self, k: int, make: Callable[[], Run]) -> None:
        run = make()
        bound = run.bounds[k]
        flaws = [
            ({"value": bound.value + Length(Q(1, 10**400))}, bound.name),
            ({"holds": not bound.holds}, "holds"),
        ]
        if k in (0, 5):
            flaws += [({"ratio": bound.ratio * (1 + 1e-9)}, "ratio"), ({"name": "(3)"}, "the bounds are")]
        for changes, word in flaws:
            bounds = (*run.bounds[:k], replace(bound, **changes), *run.bounds[k + 1 :])
            refused(replace(run, bounds=bounds), "bound", word)


@pytest.mark.parametrize(
    "seed",
    some(
        [
            1001113,  # a view past a corner is as long as the range
            1000221,  # the start of a circle is known alone
            1000251,  # a way touches an arc
            1000230,  # a leg ends where a family does
            1000756,  # parts end at one height on both sides of an arc
            1001201,  # points of vertical edges
            1001472,  # on the way back nothing is learned
        ],
        2,
    ),
)
def test_moments_that_once_had_no_answer(seed: int) -> None:
    """Maps at events of random sweeps that were wrong, or took too many bits to prove equal numbers equal."""
    scene = random_scene(Subject.SEED_SPREADER, seed)
    audit(xa.seed_spreader(scene), samples=8, seed=seed)


@pytest.mark.parametrize(
    "seed",
    some(
        [
            213002282,  # the look ahead: the end of a known arc lies on a line of sight through it
            2000031,  # the audit: on the way back from a diversion a wall is met where it was left
            221000735,  # a float of a number that is 0 but not proved to be
            1005007,  # the same, in an audit
            224001315,  # the same
            233001077,  # the look ahead: a walk begins where a line past a corner is as long as the range
        ],
        3,
    ),
)
def test_places_with_long_numbers(seed: int) -> None:
    """Whether two forms of such a place are equal is `Undecided`: what it is made of has to tell it."""
    audit(xa.seed_spreader(random_scene(Subject.SEED_SPREADER, seed)), samples=8, seed=seed)


def test_a_sight_between_corners_a_billionth_apart() -> None:
    """A sight that begins in the post that it touches: the audit divided a series by what may be 0."""
    hook = Polygon([(0, 0), (4, 0), (4, 3), (3, 3), (3, 1), (1, 1), (1, 3), (0, 3)])
    near = 1 + Q(1, 10**9)
    box = Polygon([(near, near), ("5/2", near), ("5/2", "5/2"), (near, "5/2")])
    run = xa.seed_spreader(Scene([hook, box], terrain=Terrain(6, 5, origin=(-1, -1)), radius=5))
    audit(run, samples=2)


def test_an_aim_that_became_known_on_the_way_is_passed_around() -> None:
    """Around the hook all of the triangle comes in sight; its aim is then reached past its near side."""
    hook = Polygon(
        [(3, 13), (3, 11), (Q(13, 4), 11), (Q(13, 4), Q(25, 2)), (Q(15, 4), Q(25, 2)), (Q(15, 4), 11),
         (4, 11), (4, 13)]
    )  # fmt: skip
    triangle = Polygon([(Q(27, 8), 12), (Q(7, 2), Q(23, 2)), (Q(29, 8), 12)])
    others = [Polygon([(3, 4), (4, 10), (3, 10)]), Polygon([(3, 14), (4, 17), (3, 17)])]
    run = xa.seed_spreader(Scene([hook, triangle, *others], terrain=Terrain(5, 18)), Q(5, 2))
    hits = [
        (event.kind, event.obstacle, event.note) for event in run.events if event.kind in ("hit", "divert")
    ]
    aim = hits.index(("divert", 1, "out of reach"))
    assert hits[aim + 1 :][:3] == [
        ("hit", 0, "on the way"),
        ("hit", 1, "on the way"),
        ("hit", 1, "diversion"),
    ]
    audit(run)
