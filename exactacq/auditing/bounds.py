"""The audit of links and bounds: their values again, from end points and the paper's formulas."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from flint import arb

from exactacq.auditing.comparisons import BITS, agrees, ball_sum
from exactacq.auditing.ground import Field
from exactacq.auditing.visibility import World
from exactacq.errors import AuditError
from exactacq.geometry.box_index import united
from exactacq.geometry.curves import Segment
from exactacq.geometry.nearest_points import nearest_points
from exactacq.numbers.length import Length
from exactacq.numbers.precision import workprec
from exactacq.numbers.real import Real
from exactacq.sensing.event import Ending, EventKind, Occasion
from exactacq.strategies.run import Run, SeedSpreaderRun, SightseerRun

VISITS = ("(4)", "L3 corrected")
"""Bounds of the number of visits, not of a length."""
CLOSE = 1e-12
"""By less than this part of it a ratio, of floats, is off by its three roundings."""


def check_bounds(run: Run, values: Mapping[str, arb]) -> None:
    """Each bound has the value of its formula, and holds and applies if and only if it says so."""
    names = [bound.name for bound in run.bounds]
    if names != list(values):
        raise AuditError(f"the bounds are {names}, not {list(values)}")
    way = ball_sum([piece.curve for piece in run.path])
    visits = len(run.encounters) if isinstance(run, SeedSpreaderRun) else 0
    for bound in run.bounds:
        value = values[bound.name]
        of_visits = isinstance(run, SeedSpreaderRun) and bound.name in VISITS
        length = arb(visits) if of_visits else way
        if not agrees(bound.value, value):
            raise AuditError(f"bound {bound.name} is {bound.value.decimal(20)}..., not {value.str(20)}")
        # Where balls cannot tell the two apart they may be equal, which only exact lengths decide.
        exact = Length(visits) if of_visits else run.length
        holds = True if length < value else False if length > value else exact <= bound.value
        if bound.holds is not holds:
            raise AuditError(f"bound {bound.name} says {bound.holds}, but holds is {holds}")
        if bound.applies is not (applies := _applies(run, bound.name)):
            raise AuditError(f"bound {bound.name} says {bound.applies}, but applies is {applies}")
        with workprec(BITS):
            ratio = length / value if value != 0 else arb("nan")
            is_near = abs(ratio - arb(bound.ratio)) <= abs(ratio) * CLOSE
        if not is_near and (ratio.is_finite() or bound.ratio == bound.ratio):
            raise AuditError(f"bound {bound.name} has the ratio {bound.ratio}, not {ratio.str(17)}")


def _applies(run: Run, name: str) -> bool:
    """Whether a formula speaks of a run: Theorem 1 of the model (a), those of sweeps if they come to T.

    (8) is for runs that meet nothing, (9) for such as meet nothing known on diversions, (10) where all
    obstacles are clear of the border, (11) where both is so.
    """
    if isinstance(run, SightseerRun):
        return run.complete and sum(link.source == "S" for link in run.links) < 2
    if not isinstance(run, SeedSpreaderRun):
        return True
    acquired: set[int | None] = set()
    is_direct, is_clear = True, all(body.closed for body in run.obstacles)
    for event in run.events:
        if event.kind is EventKind.ACQUIRE:
            acquired.add(event.obstacle)
        elif event.kind is EventKind.HIT and event.occasion in (Occasion.WAY_OUT, Occasion.WAY_BACK):
            is_direct &= event.obstacle not in acquired
    fits = {
        "(8)": not (run.encounters or run.diversions),
        "(9)": is_direct,
        "(10)": is_clear,
        "(11)": is_direct and is_clear,
    }
    return run.ending is Ending.END_OF_M_LINE and fits.get(name, True)


def sightseer_values(run: SightseerRun, world: World) -> dict[str, arb]:
    """The paper's (1) and (2), and the forms that hold; S-S1 is the way from a free start, v a link.

    (1)  2 (n - 1) min(R, d_max) + 3/2 sum p + (n - 2)/2 p_max;  (2)  the same with R for the minimum;
    T1 corrected  S-S1 + (2 n - 3) min(R, v_max) + 3/2 sum p - p_last/2 + (n - 2)/2 p_max, or S-S1 + p_1.
    """
    obstacles, n = run.scene.obstacles, len(run.scene.obstacles)
    if not n:
        return {}
    farthest = clipped_distance(run, world)
    with workprec(BITS):
        perimeters = [ball_sum(obstacle.edges) for obstacle in obstacles]
        reach = arb(run.radius)
        lengths = [(link.source, ball_sum([Segment(link.leave, link.hit)])) for link in run.links]
        approach = sum((length for source, length in lengths if source == "S"), arb(0))
        steps = [length for source, length in lengths if source != "S"]
        largest = _greatest(perimeters)
        around = sum(perimeters, arb(0)) * 3 / 2 + largest * (n - 2) / 2
        last = perimeters[run.visits[-1]] if run.visits else arb(0)
        step = reach.min(_greatest(steps)) if steps else arb(0)
        corrected = approach + (step * (2 * n - 3) + around - last / 2 if n > 1 else perimeters[0])
        wide = 2 * (n - 1) * reach + around
        return {
            "(1)": 2 * (n - 1) * farthest.ball(BITS) + around,
            "(2)": wide,
            "T1 corrected": corrected,
            "(2) + S-S1": wide + approach,
        }


def spreader_values(run: SeedSpreaderRun, field: Field) -> dict[str, arb]:
    """The paper's (4)-(6) and (8)-(11), and the forms of Lemma 3 and Theorem 2 that hold.

    (4)  n + n n_0 + 1/2 sum n_j (n_j - 1);
    (5)  A + r (w + A) + 2 n w + 3 sum p + 2 n n_0 p_max + p_max sum n_j (n_j - 1);
    (6)  the same with A + B + r A + 2 n R for the first terms;  (8)  A + B + r A;
    (9)  (6) without the terms with p_max;  (10)  half of what (6) has of p;  (11)  both;
    L3 corrected  (4) + re, the number of times that known obstacles blocked the M-line;
    T2 corrected  (6) + the p of those, or (10) + half of it where no obstacle meets the border, + twice what
                  diversions are longer than R one way.
    """
    a, b, reach, n = field.height, field.width, run.radius, len(run.obstacles)
    r, w = len(field.lines) - 1, min(run.radius, field.width)
    crossing = field.crossing
    counts = Counter(field.strip(k) for k in range(n) if k not in crossing)
    counts[0] = len(crossing)
    pairs = sum(count * (count - 1) for count in counts.values())
    with workprec(BITS):
        perimeters = [ball_sum(body.edges) for body in run.obstacles]
        total, largest = sum(perimeters, arb(0)), _greatest([*perimeters, arb(0)])
        hops = largest * (2 * n * len(crossing) + pairs)
        again = sum((perimeters[k] for k in run.again), arb(0))
        ways = [ball_sum([Segment(d.leave, d.hit)]) for d in run.diversions]
        beyond = sum(((way - arb(reach)).max(arb(0)) for way in ways), arb(0))
        visits = arb(n + n * len(crossing)) + arb(pairs) / 2
        sweep = arb(a + b + r * a)
        wide = sweep + arb(2 * n * reach)
        part = arb(1) / 2 if all(body.closed for body in run.obstacles) else arb(1)
        return {
            "(4)": visits,
            "L3 corrected": visits + len(run.again),
            "(5)": arb(a + r * (w + a) + 2 * n * w) + 3 * total + hops,
            "(6)": wide + 3 * total + hops,
            "(8)": sweep,
            "(9)": wide + 3 * total,
            "(10)": wide + total * 3 / 2 + hops / 2,
            "(11)": wide + total * 3 / 2,
            "T2 corrected": wide + 2 * beyond + 3 * part * total + part * hops + part * again,
        }


def _greatest(balls: Sequence[arb]) -> arb:
    found = balls[0]
    for ball in balls[1:]:
        found = found.max(ball)
    return found


def clipped_distance(run: Run, world: World) -> Real:
    """min(R, d_max): the largest closest distance between two obstacles, or the radius if that is less.

    Only pairs whose boxes do not keep them below the largest so far need an exact distance.
    """
    ranges = [world.edges_of(o.index) for o in run.scene.obstacles]
    hulls = united(world.boxes, world.first[:-1])
    best = Real(0)
    for i, hull in enumerate(hulls):
        reach = np.hypot(*np.maximum(hull[2:] - hulls[:, :2], hulls[:, 2:] - hull[:2]).T) * (1 + 1e-12)
        for j in range(i):
            if reach[j] >= float(best):
                best = max(best, _distance(world, ranges[i], ranges[j]))
                if best.compare(run.radius) >= 0:
                    return Real(run.radius)
    return best


def _distance(world: World, first: Iterable[int], second: Sequence[int]) -> Real:
    """The closest distance between two obstacles, given by their edges."""
    least: Real | None = None
    for a in first:
        gaps = np.maximum(
            world.boxes[second, :2] - world.boxes[a, 2:], world.boxes[a, :2] - world.boxes[second, 2:]
        )
        for gap, b in zip(np.hypot(*np.maximum(gaps, 0).T), second, strict=True):
            if least is None or gap**2 * (1 - 1e-12) <= float(least):
                for pair in nearest_points(world.edges[a], world.edges[b]):
                    least = pair.distance_sq if least is None else min(least, pair.distance_sq)
    assert least is not None
    return least.sqrt()
