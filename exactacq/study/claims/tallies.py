"""The paper's bounds evaluated from their definitions and a finished run, without
`exactacq.strategies.bounds`.

What a check finds here must also be what the run itself reports: so neither can be wrong alone.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import dist
from typing import NamedTuple

from flint import fmpq

from exactacq.geometry.box_index import box
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.intersections import nearest_points
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real
from exactacq.scene.scene import Obstacle, Scene
from exactacq.sensing.event import EventKind, Occasion
from exactacq.strategies.run import Diversion, Run, SeedSpreaderRun, SightseerRun
from exactacq.study.claims.model import Case
from exactacq.study.claims.trees import circled
from exactacq.study.claims.walks import moves
from exactacq.visibility.links import START

HALF = rational("1/2")
VISITS = Occasion.M_LINE, Occasion.WAY_OUT, Occasion.DIVERSION
"""Hits that are visits: on the M-line, and on the way out on a diversion; not those on the way back."""


def differs(run: Run, values: Mapping[str, Length]) -> str | None:
    """A bound of which the run reports another value than the one found here."""
    told = {bound.name: bound.value for bound in run.bounds}
    for name, value in values.items():
        if name not in told:
            return f"the run reports no bound {name}"
        if told[name] != value:
            return f"bound {name} is {float(value):.12g}, the run says {float(told[name]):.12g}"
    return None


# -- the Sightseer ---------------------------------------------------------------------------------


def largest_distance(scene: Scene) -> Real:
    """d_max: the largest closest distance between two obstacles; 0 for a single one.

    Pairs with two vertices that floats show to be closer than the largest so far are left out.
    """
    obstacles, best = scene.obstacles, Real(0)
    for k, a in enumerate(obstacles):
        for b in obstacles[:k]:
            apart = min(dist(p.start.xy, q.start.xy) for p in a.edges for q in b.edges)
            if apart * (1 + 1e-9) >= float(best):
                best = max(best, closest(a, b))
    return best


def closest(a: Obstacle, b: Obstacle) -> Real:
    """The distance of two obstacles. Pairs of edges that their boxes keep farther apart are left out."""
    best: Real | None = None
    pairs = sorted((_gap(c, d), k, c, d) for k, (c, d) in enumerate((c, d) for c in a.edges for d in b.edges))
    for gap, _, c, d in pairs:
        if best is not None and gap * (1 - 1e-9) > float(best):
            break
        for pair in nearest_points(c, d):
            if best is None or pair.distance_sq.compare(best * best) < 0:
                best = pair.distance_sq.sqrt()
    assert best is not None, "two boundaries have a closest pair"
    return best


def _gap(a: Curve, b: Curve) -> float:
    (x0, y0, x1, y1), (u0, v0, u1, v1) = box(a), box(b)
    across, up = max(u0 - x1, x0 - u1, 0.0), max(v0 - y1, y0 - v1, 0.0)
    return float((across**2 + up**2) ** 0.5)


def theorem_1_printed(run: SightseerRun) -> Length:
    """(1): 2(n - 1) min(R, d_max) + 1.5 sum p + (n - 2)/2 p_max."""
    perimeters = [obstacle.perimeter for obstacle in run.scene.obstacles]
    n = len(perimeters)
    step = min(Length(run.radius), Length(largest_distance(run.scene)))
    around = Length.sum(perimeters) * (3 * HALF) + max(perimeters) * ((n - 2) * HALF)
    return Length.sum((step * (2 * (n - 1)), around))


def theorem_1(run: SightseerRun) -> Length:
    """S-S1 + (2n - 3) min(R, v_max) + 1.5 sum p - p_last/2 + (n - 2)/2 p_max; for n = 1, S-S1 + p.

    v_max is the longest segment between obstacles that was walked; p_last belongs to the obstacle that was
    circled last.
    """
    perimeters = [obstacle.perimeter for obstacle in run.scene.obstacles]
    n = len(perimeters)
    outward = [move for move in moves(run) if not move.returns]
    approach = Length.sum(move.piece.length for move in outward if move.source == START)
    if n == 1:
        return approach + perimeters[0]
    steps = [move.piece.length for move in outward if move.source != START]
    step = min(Length(run.radius), max(steps, default=Length(0)))
    last = perimeters[circled(run)[-1]]
    around = Length.sum(perimeters) * (3 * HALF) - last * HALF + max(perimeters) * ((n - 2) * HALF)
    return Length.sum((approach, step * (2 * n - 3), around))


# -- the Seed Spreader -----------------------------------------------------------------------------


class _Meeting(NamedTuple):
    """A diversion to ``aim`` from ``leave`` (D) and the obstacles that it hits before it is there, and back.

    ``acquired`` are those that were wholly known when they were hit on the way.
    """

    aim: int
    leave: Point
    on_the_way: list[int]
    on_the_way_back: list[int]
    acquired: set[int]


@dataclass(frozen=True)
class Tally:
    """What the bounds of section 4.3 are made of, counted from a terrain and the events on it."""

    case: Case

    @property
    def run(self) -> SeedSpreaderRun:
        """The sweep with the usual options."""
        return self.case.spreader

    @cached_property
    def lines(self) -> list[fmpq]:
        """x of the lines 0..r."""
        terrain, lines = self.run.scene.terrain, [rational(0)]
        assert terrain is not None
        while lines[-1] < terrain.width:
            lines.append(min(lines[-1] + self.run.radius, terrain.width))
        return lines

    @property
    def n(self) -> int:
        """The number of obstacles: components in reach."""
        return len(self.run.obstacles)

    @cached_property
    def crossing(self) -> frozenset[int]:
        """The obstacles that cross the M-line, n_0 of them.

        One clear of the border does if it has points on both sides of a line. One at the border does if it
        blocks the M-line somewhere.
        """
        blocking = {mark.owner for mark in self.case.field.marks}
        found = []
        for k, body in enumerate(self.run.obstacles):
            if body.closed:
                west, east = self.extent(k)
                crosses = any(west.compare(x) < 0 < east.compare(x) for x in self.lines)
            else:
                crosses = k in blocking
            if crosses:
                found.append(k)
        return frozenset(found)

    def extent(self, k: int) -> tuple[Real, Real]:
        """The least and the greatest x of an obstacle's boundary in the terrain."""
        values: list[Real] = []
        component = self.case.field.run.obstacles[k]
        curves = [*component.edges, *(p.curve for s in getattr(component, "hidden", ()) for p in s)]
        for curve in curves:
            values += [curve.start.x, curve.end.x]
            if isinstance(curve, Arc):
                for side in (curve.radius, -curve.radius):
                    point = Point(curve.center.x + side, curve.center.y)
                    values += [point.x] if curve.contains(point) else []
        return min(values), max(values)

    @cached_property
    def counts(self) -> tuple[int, ...]:
        """n_0, n_1, ..., n_r: those that cross the M-line, and those wholly inside each strip."""
        inside: Counter[int] = Counter()
        for k in set(range(self.n)) - self.crossing:
            west, east = self.extent(k)
            inside[self.strip(west, east)] += 1
        return (len(self.crossing), *(inside[j] for j in range(1, len(self.lines))))

    def strip(self, west: Real, east: Real) -> int:
        """The strip j, from line j - 1 to line j, that holds an obstacle."""
        return next(
            j
            for j in range(1, len(self.lines))
            if west.compare(self.lines[j - 1]) >= 0 >= east.compare(self.lines[j])
        )

    @property
    def pairs(self) -> int:
        """The sum of n_j (n_j - 1) over j = 0..r."""
        return sum(count * (count - 1) for count in self.counts)

    @cached_property
    def visits(self) -> int:
        """Arrivals at obstacles on the M-line and on the way out on diversions."""
        return sum(
            event.kind in (EventKind.HIT, EventKind.CROSS) and event.occasion in VISITS
            for event in self.run.events
        )

    @cached_property
    def met_again(self) -> tuple[int, ...]:
        """The obstacles of the hits on the M-line that were acquired before: obstacle i comes re_i times."""
        acquired: set[int] = set()
        again: list[int] = []
        for event in self.run.events:
            if event.obstacle is None:
                continue
            if event.kind is EventKind.ACQUIRE:
                acquired.add(event.obstacle)
            elif event.kind in (EventKind.HIT, EventKind.CROSS) and event.occasion is Occasion.M_LINE:
                again += [event.obstacle] if event.obstacle in acquired else []
        return tuple(again)

    @cached_property
    def diversions_meet_known(self) -> bool:
        """Whether a diversion meets an obstacle on its way out that was acquired before."""
        return any(met.acquired & set(met.on_the_way) for met in self._meetings)

    @cached_property
    def overtaken(self) -> list[int]:
        """The aims that became acquired on the way to them and were then hit before the point aimed at."""
        return [met.aim for met in self._meetings if met.aim in met.acquired & set(met.on_the_way)]

    @cached_property
    def stays_in_strips(self) -> bool:
        """Whether all that diversions from line j meet lies inside strip j or crosses the M-line."""
        for met in self._meetings:
            line = next(j for j, x in enumerate(self.lines) if met.leave.x.compare(x) == 0)
            for k in {met.aim, *met.on_the_way, *met.on_the_way_back} - self.crossing:
                if self.strip(*self.extent(k)) != line:
                    return False
        return True

    @cached_property
    def _meetings(self) -> list[_Meeting]:
        found: list[_Meeting] = []
        acquired: set[int] = set()
        for event in self.run.events:
            k = event.obstacle
            if k is None:
                continue
            if event.kind is EventKind.ACQUIRE:
                acquired.add(k)
            elif event.kind is EventKind.DIVERT:
                found.append(_Meeting(k, event.point, [], [], set()))
            elif event.kind is EventKind.HIT and event.occasion is Occasion.WAY_OUT:
                found[-1].on_the_way.append(k)
                found[-1].acquired.update({k} & acquired)
            elif event.kind is EventKind.HIT and event.occasion is Occasion.WAY_BACK:
                found[-1].on_the_way_back.append(k)
        return found

    @cached_property
    def perimeters(self) -> list[Length]:
        """p_i: what the robot can walk of each boundary."""
        return [Length.sum(edge.length for edge in body.edges) for body in self.run.obstacles]

    @property
    def is_clear(self) -> bool:
        """Whether no obstacle meets the border."""
        return all(body.closed for body in self.run.obstacles)

    @cached_property
    def base(self) -> Length:
        """(8): A + B + rA, the length of the M-line."""
        terrain = self.run.scene.terrain
        assert terrain is not None
        return Length(len(self.lines) * terrain.height + terrain.width)

    @cached_property
    def far(self) -> Length:
        """The sum of |DQ| - R over the diversions to obstacles farther than R."""
        ways = (diversion.length for diversion in self.run.diversions)
        return Length.sum(way - Length(self.run.radius) for way in ways if way > Length(self.run.radius))

    def visit_bounds(self) -> dict[str, Length]:
        """(4), and with what is met again."""
        most = Length(self.n + self.n * self.counts[0] + self.pairs * HALF)
        return {"(4)": most, "L3 corrected": most + Length(len(self.met_again))}

    def proved_visits(self) -> Length:
        """(4), or n + n(n - 1)/2 if a diversion leaves its strip, and what is met again and overtaken."""
        most = self.visit_bounds()["(4)"]
        if not self.stays_in_strips:
            most = Length(self.n + self.n * (self.n - 1) * HALF)
        return Length.sum((most, Length(len(self.met_again) + len(self.overtaken))))

    def length_bounds(self) -> dict[str, Length]:
        """(5), (6), (9)-(11)."""
        terrain, r = self.run.scene.terrain, len(self.lines) - 1
        assert terrain is not None
        width = min(self.run.radius, terrain.width)
        total, hops = Length.sum(self.perimeters) * 3, self._hops()
        fifth = Length(terrain.height + r * (width + terrain.height) + 2 * self.n * width)
        wide = self._wide()
        return {
            "(5)": fifth + total + hops,
            "(6)": wide + total + hops,
            "(9)": wide + total,
            "(10)": wide + total * HALF + hops * HALF,
            "(11)": wide + total * HALF,
        }

    def met_again_bound(self) -> Length:
        """(6), or (10) clear of the border, with far diversions and p, or half, for what is met again."""
        return Length.sum((self._wide(), self.far * 2, self._around(), self._hops() * self._share))

    def proved_length(self) -> Length:
        """The proved bound: `met_again_bound` and the perimeters of overtaken aims.

        If a diversion leaves its strip, n^2 p_max replaces the visits.
        """
        hops = self._hops() if self.stays_in_strips else self._largest * self.n**2
        overtaken = Length.sum(self.perimeters[k] for k in self.overtaken)
        return Length.sum((self._wide(), self.far * 2, self._around(), (hops + overtaken) * self._share))

    @property
    def _share(self) -> fmpq:
        return HALF if self.is_clear else rational(1)

    @property
    def _largest(self) -> Length:
        return max(self.perimeters, default=Length(0))

    def _around(self) -> Length:
        """3 p for all obstacles and p for what is met again, or half of that if clear of the border."""
        met = (self.perimeters[k] for k in self.met_again)
        return Length.sum((*(p * 3 * self._share for p in self.perimeters), *(p * self._share for p in met)))

    def _wide(self) -> Length:
        return self.base + Length(2 * self.n * self.run.radius)

    def _hops(self) -> Length:
        return Length.sum((self._largest * (2 * self.n * self.counts[0] + self.pairs),))


def straight_length(run: Run, diversion: Diversion) -> Length:
    """What a diversion walks straight, there and back."""
    pieces = run.path[diversion.first : diversion.last]
    return Length.sum(piece.length for piece in pieces if piece.kind == "straight")
