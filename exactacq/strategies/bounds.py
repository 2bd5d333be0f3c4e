"""The paper's bounds on the length of a path, as printed and corrected, evaluated exactly."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from flint import fmpq

from exactacq.errors import StrategyError, shown
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.scene.gaps import boundary_distance
from exactacq.scene.scene import Scene
from exactacq.scene.terrain_components import Ground
from exactacq.sensing.event import Ending, EventKind, Occasion
from exactacq.strategies.late_entry import later
from exactacq.strategies.registry import OwnStrategy, registered
from exactacq.strategies.run import Bound, OwnRun, SeedSpreaderRun, SightseerRun, bounded
from exactacq.strategies.seed_spreader.blocked import Blocking
from exactacq.strategies.seed_spreader.mline import MLine
from exactacq.visibility.links import START

HALF = fmpq(1, 2)
WAYS = Occasion.WAY_OUT, Occasion.WAY_BACK
"""Where diversions meet obstacles."""
AnyRun = TypeVar("AnyRun", bound=SightseerRun | SeedSpreaderRun | OwnRun)


def with_bounds(run: AnyRun, table: EdgeTable | None = None) -> AnyRun:
    """A finished run with the bounds of its strategy; they do not speak of one that was given up.

    *table* has the edges of its scene's obstacles, if it is there.
    """
    if isinstance(run, OwnRun):
        bounds = own_bounds(run, registered(run.name))
    elif isinstance(run, SightseerRun):
        bounds = sightseer_bounds(run, table)
    else:
        bounds = spreader_bounds(run, table)
    return bounded(run, bounds)


def with_late_bounds(run: AnyRun, table: EdgeTable) -> AnyRun:
    """A finished run whose bounds are found when somebody reads them (see `with_bounds`)."""
    return bounded(run, later(lambda: with_bounds(run, table).bounds))


def own_bounds(run: OwnRun, own: OwnStrategy | None) -> tuple[Bound, ...]:
    """The bounds that a strategy of the user's own tells, if it tells any; two cannot have one name."""
    if own is None or own.bounds is None:
        return ()
    found = own.bounds(run)
    if not isinstance(found, Iterable):
        raise StrategyError(f"bounds of {run.name}: several are needed, as in a list, not {shown(found)}")
    told = [_told(run.name, bound) for bound in found]
    if len({name for name, _, _ in told}) < len(told):
        raise StrategyError(
            f"two bounds of {run.name} have one name: {', '.join(name for name, _, _ in told)}"
        )
    return tuple(_bound(name, source, value, run.length, True) for name, source, value in told)


def _told(strategy: str, bound: Any) -> tuple[str, str, Length]:
    """Name, source and value of a bound that a strategy tells; `StrategyError` for anything else."""
    try:
        name, source, value = bound
        return str(name), str(source), Length(value)
    except (TypeError, ValueError) as error:
        text = f"bounds of {strategy}: name, source and value are needed, not {shown(bound)}"
        raise StrategyError(text) from error


def sightseer_bounds(run: SightseerRun, table: EdgeTable | None = None) -> tuple[Bound, ...]:
    """Bounds (1) and (2) as printed, and the forms of Theorem 1 that hold in model (a).

    n counts all obstacles of the scene. The corrected ones add the way S-S1 from a free start to the first
    obstacle; the first of them also replaces the largest distance by the longest link between obstacles,
    counts 2n - 3 traversals, and charges no return along the last obstacle. Outside model (a), where links
    can start at S twice, even these may fail. Empty without obstacles.
    """
    scene, radius, length, links, visits = run.scene, run.radius, run.length, run.links, run.visits
    n = len(scene.obstacles)
    if n == 0:
        return ()
    perimeters = [o.perimeter for o in scene.obstacles]
    total, largest = Length.sum(perimeters), max(perimeters)
    around = total * fmpq(3, 2) + largest * (fmpq(n - 2) * HALF)
    reach = Length(radius)
    ways_in = [link.length for link in links if link.source == START]
    approach = Length.sum(ways_in)
    steps = [link.length for link in links if link.source != START]
    if n == 1:
        corrected = approach + total
    else:
        step = min([reach, max(steps, default=Length(0))])
        last = perimeters[visits[-1]] if visits else Length(0)
        corrected = approach + step * (2 * n - 3) + around - last * HALF
    printed = min([reach, _largest_distance(scene, radius, table)]) * (2 * (n - 1)) + around
    wide = reach * (2 * (n - 1)) + around
    # Then chains of links join all obstacles, none by way of the start, which sees one: the model (a).
    # From one that does not join them all the robot goes back to the start, and sets out a second time.
    linked = run.complete and len(ways_in) < 2
    return (
        _bound("(1)", "Theorem 1, as printed", printed, length, linked),
        _bound("(2)", "Theorem 1 for d_max >= R, as printed", wide, length, linked),
        _bound("T1 corrected", "(1) with v_max, S-S1 and 2n - 3", corrected, length, linked),
        _bound("(2) + S-S1", "(2) with the way from a free start", wide + approach, length, linked),
    )


@dataclass(frozen=True)
class Census:
    """Where the components of a terrain lie, strip by strip from the west.

    ``inside`` are n_1..n_r, those wholly inside a strip; ``crossing`` are n_01..n_0r, those that cross the
    boundary of a strip and of none to its west. They add up to n_0.
    """

    inside: tuple[int, ...]
    crossing: tuple[int, ...]

    @property
    def pairs(self) -> int:
        """The sum of n_j (n_j - 1) over j = 0..r."""
        return sum(count * (count - 1) for count in (*self.inside, sum(self.crossing)))


def census(ground: Ground, radius: fmpq, table: EdgeTable | None = None) -> Census:
    """Count the components that can be reached by strips; *table* has the obstacles' edges, if there."""
    mline, table = MLine(ground.terrain, radius), table or EdgeTable(ground.obstacles)
    first: dict[int, int] = {}
    for crossing in mline.crossings(Blocking(ground, table)):
        # Line j bounds strips j and j + 1, the joint after it only the latter; the first line bounds strip 1.
        strip = max(1, (crossing.piece + 1) // 2)
        if crossing.component.edges:
            first[crossing.component.index] = min(strip, first.get(crossing.component.index, strip))
    inside = Counter(mline.strip(c) for c in ground.components if c.index not in first)
    crossing_ones = Counter(first.values())
    strips = range(1, mline.strips + 1)
    return Census(tuple(inside[j] for j in strips), tuple(crossing_ones[j] for j in strips))


def spreader_bounds(run: SeedSpreaderRun, table: EdgeTable | None = None) -> tuple[Bound, ...]:
    """Bounds (4)-(6) and (8)-(11) as printed, and the forms of Lemma 3 and Theorem 2 that hold.

    n counts the components that can be reached, p is what the robot can walk of a boundary. n_j are the
    components wholly inside strip j, n_0 those that cross the M-line. Corrected forms charge every time that
    an acquired obstacle was met again on the M-line, and what diversions are longer than R one way. (4)
    bounds the number of visits, not a length.
    """
    ground, radius, length = run.ground, run.radius, run.length
    components, mline = ground.components, MLine(ground.terrain, radius)
    counts = census(ground, radius, table)
    n, crossing, pairs = len(components), sum(counts.crossing), counts.pairs
    perimeters = [c.perimeter for c in components]
    total, largest = Length.sum(perimeters), max(perimeters, default=Length(0))
    a, b, r, w = ground.terrain.height, ground.terrain.width, mline.strips, mline.width
    sweep = Length(a + b + r * a)
    hops = largest * (2 * n * crossing + pairs)
    wide = sweep + Length(2 * n * radius)
    clear = all(c.closed for c in components)
    met = Length.sum(perimeters[k] for k in run.again)
    share = HALF if clear else fmpq(1)
    far = (d.length - Length(radius) for d in run.diversions if d.length > Length(radius))
    beyond = Length.sum(far)
    corrected = wide + beyond * 2 + total * (3 * share) + hops * share + met * share
    whole = run.ending is Ending.END_OF_M_LINE
    plain, direct = not (run.encounters or run.diversions), not _meets_known(run)
    values = [
        ("(5)", "Theorem 2, as printed", Length(a + r * (w + a) + 2 * n * w) + total * 3 + hops, True),
        ("(6)", "Theorem 2 for rw = B, w = R, as printed", wide + total * 3 + hops, True),
        ("(8)", "Case 1: no crossing, no diversion", sweep, plain),
        ("(9)", "Case 2: (6) without its last terms", wide + total * 3, direct),
        ("(10)", "Case 3: clear of the border, as printed", wide + total * fmpq(3, 2) + hops * HALF, clear),
        ("(11)", "Cases 2 and 3, as printed", wide + total * fmpq(3, 2), direct and clear),
        ("T2 corrected", "(6) or (10), plus what is met again and far diversions", corrected, True),
    ]
    visits = Length(len(run.encounters))
    most = Length(n + n * crossing + pairs * HALF)
    return (
        _bound("(4)", "Lemma 3, visits, as printed", most, visits, whole),
        _bound("L3 corrected", "(4), plus what is met again", most + Length(len(run.again)), visits, whole),
        *(_bound(name, source, value, length, whole and fits) for name, source, value, fits in values),
    )


def _meets_known(run: SeedSpreaderRun) -> bool:
    """Whether a diversion meets an obstacle, on its way out or back, that was acquired before."""
    acquired: set[int | None] = set()
    for event in run.events:
        if event.kind is EventKind.ACQUIRE:
            acquired.add(event.obstacle)
        elif event.kind is EventKind.HIT and event.occasion in WAYS and event.obstacle in acquired:
            return True
    return False


def _bound(name: str, source: str, value: Length, length: Length, applies: bool) -> Bound:
    ratio = float(length) / float(value) if value.sign() else float("nan")
    return Bound(name, source, value, length <= value, ratio, applies)


def _largest_distance(scene: Scene, radius: fmpq, table: EdgeTable | None) -> Length:
    """d_max, the largest closest distance between two obstacles, or the radius if d_max is larger.

    Outer obstacles and their farthest partners come first; float upper bounds then spare nearly all exact
    distances. Quadratic in the number of obstacles in floats if all lie within the radius, linear in memory.
    """
    table = table or EdgeTable(scene.obstacles)
    spots = table.start[table.first]
    best = Real(0)
    for i in np.argsort(-np.hypot(*(spots - spots.mean(axis=0)).T)):
        upper = np.hypot(*(spots - spots[i]).T) * (1 + 1e-12) + 8 * table.roundoff
        for j in np.argsort(-upper):
            if upper[j] < float(best):
                break
            if i != j:
                best = max(best, boundary_distance(table, int(i), int(j)))
                if best.compare(radius) >= 0:
                    return Length(radius)
    return Length(best)
