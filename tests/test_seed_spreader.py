"""The Seed Spreader: scenes with known outcomes, laws on random degenerate scenes, and bad input."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction as Q
from random import Random

import pytest
from nightly import some
from sweeps import rectangle, swept_scene

import exactacq as xa
from exactacq import Circle, Length, Polygon, Scene, Terrain
from exactacq.errors import InvalidScene
from exactacq.numbers.rationals import rational
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.event import Ending, Occasion
from exactacq.strategies.bounds import census
from exactacq.strategies.run import Run
from exactacq.strategies.seed_spreader.blocked import Blocking
from exactacq.strategies.seed_spreader.mline import MLine


def labels(run: Run, numbers: object) -> list[str]:
    return [run.obstacles[k].label for k in numbers]  # type: ignore[attr-defined]


def moves(run: Run) -> list[tuple[str, str, str]]:
    kinds = ("hit", "cross", "leave", "divert", "return")
    return [
        (e.kind, str(e.point), run.obstacles[e.obstacle].label)
        for e in run.events
        if e.kind in kinds and e.obstacle is not None
    ]


class TestKnownScenes:
    @pytest.mark.parametrize(("width", "height", "radius"), [(10, 4, 3), (5, 7, 9), (Q(7, 3), 1, Q(2, 5))])
    def test_empty_terrain(self, width: object, height: object, radius: object) -> None:
        """(8), and with R > B the two sides of the terrain."""
        run = xa.seed_spreader(Scene([], terrain=Terrain(width, height)), radius)
        strips = -(-Q(width) // Q(radius))
        assert run.length == Length(rational(Q(height) * (strips + 1) + Q(width)))
        assert run.complete

    def test_m14(self) -> None:
        run = xa.seed_spreader(xa.load("m14"))
        assert labels(run, run.map.acquired) == ["W", "E"]
        assert labels(run, run.unseen) == ["X"]
        assert not run.diversions
        assert run.length == Length(220)
        assert xa.sightseer(xa.load("m14"), start=(0, 40)).map.acquired == (0, 1, 2)

    def test_m15(self) -> None:
        run = xa.seed_spreader(xa.load("m15"))
        (diversion,) = run.diversions
        assert (run.obstacles[diversion.obstacle].label, diversion.reason) == ("W", "out of reach")
        assert run.complete

    def test_m25(self) -> None:
        run = xa.seed_spreader(xa.load("m25"))
        assert not run.diversions
        assert run.length == Length(220)
        hasty = xa.seed_spreader(xa.load("m25"), lookahead=False)
        (diversion,) = hasty.diversions
        assert (hasty.obstacles[diversion.obstacle].label, str(diversion.leave)) == ("W", "(20, 52)")
        assert hasty.length == Length(251)

    @pytest.mark.parametrize(
        ("target", "visits", "length"), [("known", "E W1", 465.677939), ("visible", "W1 W2", 402.977)]
    )
    def test_m18(self, target: str, visits: str, length: float) -> None:
        """The way to the nearest known point of W1 meets E: E is circled, which acquires W2."""
        run = xa.seed_spreader(xa.load("m18"), target=target)
        assert labels(run, run.visits) == visits.split()
        assert float(run.length) == pytest.approx(length, abs=1e-3)
        assert run.complete

    @pytest.mark.parametrize(("k", "broken"), [(3, "(11)"), (6, "(10)"), (8, "(9)"), (16, "(6)")])
    def test_m20(self, k: int, broken: str) -> None:
        """The closed form, and the first bound that fails for this k and for none below."""
        run = xa.seed_spreader(xa.load(f"m20-{k}"))
        bar = 2 * (k + Q(8, 10)) + Q(2, 100)
        ways = sum(2 * min(i - Q(1, 10), k + Q(9, 10) - i) + Q(1, 100) for i in range(1, k + 1))
        assert run.length == Length(rational((k + 2) * 4 + (k + 1) - Q(k, 100) + bar + ways))
        holds = {bound.name: bound.holds for bound in run.bounds}
        assert not holds[broken]
        assert holds["T2 corrected"]
        assert holds["L3 corrected"]
        assert len(run.again) == k - 1
        less = Scene([rectangle(Q(1, 10), 2, k - Q(1, 10), Q(201, 100))], terrain=Terrain(k, 4))
        assert {b.name: b.holds for b in xa.seed_spreader(less, 1).bounds}[broken]

    def test_e3(self) -> None:
        """c_2 is on the border and cannot be reached; the next that can is on the line after."""
        run = xa.seed_spreader(xa.load("e3"))
        assert moves(run)[:2] == [("hit", "(0, 2)", "wall"), ("leave", "(1, 2)", "wall")]
        assert run.ending is Ending.TRAPPED
        assert run.complete
        assert run.length == Length(20)

    def test_census(self) -> None:
        """Figure 4: O1 and O6 cross strip 1 first, O2 and O4 strip 2, O5 strip 3; O3 lies inside."""
        run = xa.seed_spreader(xa.load("figure4"))
        counts = census(run.ground, run.radius)
        assert counts.inside == (0, 1, 0)
        assert counts.crossing == (2, 2, 1)
        assert counts.pairs == 5 * 4

    def test_figure_3(self) -> None:
        run = xa.seed_spreader(xa.load("figure3"))
        assert len(run.obstacles) == 11
        assert len(run.visits) == 3
        assert run.complete


class TestMoves:
    def test_around_the_shorter_way(self) -> None:
        """Met below its middle a square is circled, then passed the shorter way; of equal ways, the left."""
        scene = Scene([rectangle(2, 2, 5, 4)], terrain=Terrain(8, 8), radius=3)
        run = xa.seed_spreader(scene)
        assert moves(run) == [("hit", "(3, 2)", "O1"), ("leave", "(3, 4)", "O1")] or run.complete

    def test_border_arc_is_walked_to_both_ends(self) -> None:
        """From a hit in its middle: to the end ahead, to the other end, and back to the leave point."""
        scene = Scene([Polygon([(1, 4), (5, 4), (5, 9), (1, 9)])], terrain=Terrain(6, 8), radius=3)
        run = xa.seed_spreader(scene, radius=Q(3, 2))
        hit = next(e for e in run.events if e.kind == "hit")
        assert str(hit.point) == "(3/2, 4)" or str(hit.point) == "(1, 8)"
        assert run.complete

    def test_t_inside_an_obstacle(self) -> None:
        run = xa.seed_spreader(Scene([Circle((9, 0), 1)], terrain=Terrain(9, 4)), 3)
        assert run.ending is Ending.TRAPPED
        assert str(run.path[-1].end) == "(9, 1)" or run.path[-1].obstacle == 0

    def test_a_visible_target(self) -> None:
        far = xa.seed_spreader(xa.load("m15"), target="visible")
        assert far.complete


class TestLaws:
    @pytest.mark.parametrize("seed", [*some(range(70), 12), 114, 154, 157, 182, 187, 196, 219, 229])
    def test_random_scenes(self, seed: int) -> None:
        rng = Random(seed)
        scene = swept_scene(rng, arcs=seed % 2 == 1, clear=seed % 5 == 0)
        run = xa.seed_spreader(scene, lookahead=seed % 3 != 0, target="visible" if seed % 7 == 0 else "known")
        law_of_sweeps(run)


def law_of_sweeps(run: Run) -> None:
    """What holds for every sweep that is not stopped by an obstacle around S or T."""
    bounds = {bound.name: bound for bound in run.bounds}
    assert bounds["T2 corrected"].holds
    assert bounds["L3 corrected"].holds
    if run.ending is Ending.END_OF_M_LINE:
        assert set(run.map.seen) == set(run.map.acquired)
        if not run.encounters:
            terrain = run.scene.terrain
            strips = -(-Q(str(terrain.width)) // Q(str(run.radius)))
            sweep = Q(str(terrain.height)) * (strips + 1) + Q(str(terrain.width))
            assert run.length == Length(rational(sweep))
    law_of_leave_points(run)
    law_of_acquisitions(run)


def law_of_leave_points(run: Run) -> None:
    """The M-line is met at ever later crossing points, and left, clear of the border, at the next one (3)."""
    line = MLine(run.scene.terrain, run.radius)
    crossings = line.crossings(Blocking(run.ground, EdgeTable(run.scene.obstacles)))
    at = before = -1
    for event in run.events:
        if event.occasion is not Occasion.M_LINE:
            continue
        later = [k for k in range(at + 1, len(crossings)) if crossings[k].stop.point == event.point]
        at = next(k for k in later if crossings[k].ends == (event.kind == "leave"))
        body = run.obstacles[event.obstacle]
        if event.kind == "leave" and body.closed:
            assert at == before + 1
        before = at


def law_of_acquisitions(run: Run) -> None:
    """To walk around an obstacle and away costs at most 3 p, 1.5 p clear of the border."""
    at: int | None = None
    walked: dict[int, Length] = {}
    times: Counter[object] = Counter()
    for piece in run.path:
        if piece.obstacle != at:
            at, walked, times = piece.obstacle, {}, Counter()
        if at is None:
            continue
        body = run.obstacles[at]
        times[frozenset((str(piece.start), str(piece.end)))] += 1
        walked[at] = walked.get(at, Length(0)) + piece.length
        most = body.perimeter * rational(Q(3, 2) if body.closed else Q(3))
        assert walked[at] <= most
        assert max(times.values()) <= 3


class TestBadInput:
    @pytest.mark.parametrize(
        ("scene", "what"),
        [
            (Scene([], radius=1), "needs a terrain"),
            (Scene([], terrain=Terrain(4, 4)), "radius"),
            (Scene([], start=(1, 0), terrain=Terrain(4, 4), radius=1), "SW corner"),
            (Scene([rectangle(-1, -1, 1, 1)], terrain=Terrain(4, 4), radius=1), "covers the SW corner"),
            (Scene([rectangle(-1, -1, 9, 9)], terrain=Terrain(4, 4), radius=1), "covers the SW corner"),
            (Scene([rectangle(0, 0, 1, 1)], terrain=Terrain(4, 4), radius=1), "covers the SW corner"),
            (Scene([rectangle(5, 1, 6, 2)], terrain=Terrain(4, 4), radius=1), "outside the terrain"),
            (Scene([rectangle(4, 1, 6, 2)], terrain=Terrain(4, 4), radius=1), "outside the terrain"),
            (Scene([], terrain=Terrain(4, 4), radius=Q(1, 10**9)), "times as wide as the radius"),
        ],
    )
    def test_refused(self, scene: Scene, what: str) -> None:
        with pytest.raises(InvalidScene, match=what):
            xa.seed_spreader(scene)

    def test_enclosure_and_target(self) -> None:
        room = Scene([], terrain=Terrain(4, 4), radius=1, enclosure=rectangle(-1, -1, 9, 9))
        with pytest.raises(InvalidScene, match="enclosure"):
            xa.seed_spreader(room)
        with pytest.raises(ValueError, match="far"):
            xa.seed_spreader(Scene([], terrain=Terrain(4, 4), radius=1), target="far")
