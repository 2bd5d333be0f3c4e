"""The claims about the Seed Spreader Strategy up to its bounds (paper, section 4)."""

from __future__ import annotations

from exactacq.numbers.length import Length
from exactacq.numbers.rationals import rational
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Outline, Polygon, Shape, Terrain
from exactacq.sensing.event import EventKind, Occasion, Reason
from exactacq.strategies.run import Diversion
from exactacq.study.claims.coverage import times_walked
from exactacq.study.claims.model import SILENT, Case, Claim, Finding, Statement, Subject, flaw, found
from exactacq.study.claims.sights import overlooked
from exactacq.study.claims.sweeps import (
    all_convex,
    bare_walk,
    circled_on,
    crossing_flaw,
    is_convex,
    progress_flaw,
)
from exactacq.study.claims.tallies import HALF, straight_length
from exactacq.study.claims.walks import is_circuit, stays

SPREADER = Subject.SEED_SPREADER
TIMELY = Reason.OUT_OF_SIGHT, Reason.OUT_OF_REACH
"""Reasons of diversions that begin while the obstacle is within the radius of vision."""
LONE: tuple[Shape, ...] = (
    Polygon([(1, 2), (3, 2), (3, 9), (1, 9)]),
    Polygon([(1, 1), ("39/10", "11/2"), (1, 10)]),
    Polygon([(0, 1), (4, 3), ("1/2", 10)]),
    Polygon([(2, 1), (3, 5), (2, 11), (1, 5)]),
    Circle((2, 6), "3/2"),
    Circle((2, 6), 2),
    Outline([(1, 2, 1), (3, 2), (3, 7, 1), (1, 7)]),
)
"""Convex obstacles for a strip of width 4, some of which touch its lines in a point."""
POCKETS = (1, 2, 3)
"""How many obstacles with pockets; a second in all."""


def advances(case: Case) -> Finding:
    """The sweep advances on the M-line, each diversion acquires an obstacle, and it ends at T or trapped."""
    return flaw(progress_flaw(case))


def finds_everything(case: Case) -> Finding:
    """At T every obstacle in reach is acquired."""
    if not case.swept_to_the_end:
        return SILENT
    run = case.spreader
    missing = sorted(set(range(len(run.obstacles))) - set(run.map.acquired))
    return found(not missing, f"not acquired: {_labels(case, missing)}" if missing else "")


def acquires_what_it_sees(case: Case) -> Finding:
    """At T every obstacle with a known point is acquired, and the map lacks nothing that the path shows."""
    if not case.swept_to_the_end:
        return SILENT
    run = case.spreader
    if (text := overlooked(case, run)) is not None:
        return flaw(text)
    left = sorted(set(run.map.seen) - set(run.map.acquired))
    return found(not left, f"seen, not acquired: {_labels(case, left)}" if left else "")


def acquires_by_sight_alone(case: Case) -> Finding:
    """With a diversion only where an obstacle goes from visible to invisible, nothing stays incomplete.

    Decided where nothing blocks the M-line and nothing incomplete goes out of sight on a line that diversions
    start from: then this reading never diverts, and its path is the bare M-line.
    """
    run = case.spreader
    if any(
        event.kind in (EventKind.HIT, EventKind.CROSS) and event.occasion is Occasion.M_LINE
        for event in run.events
    ):
        return SILENT
    bare = bare_walk(case)
    if bare.lost:
        return SILENT
    text = f"never lost from sight, yet incomplete at T: {_labels(case, bare.left)}"
    return found(not bare.left, text if bare.left else "")


def acquires_the_lone_convex(case: Case) -> Finding:
    """A convex obstacle in a strip that nothing else enters is acquired without leaving the M-line."""
    alone = _alone(case)
    if not alone:
        return SILENT
    run = case.spreader
    met = {stay.obstacle for stay in stays(run)} | {d.obstacle for d in run.diversions}
    for k in alone:
        if k in met:
            return flaw(f"{run.obstacles[k].label} is walked to")
        if k not in run.map.acquired:
            return flaw(f"{run.obstacles[k].label} is not acquired")
    return found(True)


def _alone(case: Case) -> list[int]:
    """Convex obstacles clear of the border that share their strip with no point of another."""
    field, bodies = case.field, case.spreader.obstacles
    extents = [field.extent(k) for k in range(len(bodies))]
    lone = []
    for k in sorted(set(range(len(bodies))) - field.crossing):
        if not (bodies[k].closed and is_convex(bodies[k].edges)):
            continue
        j = field.strip(k)
        west, east = field.lines[j - 1], field.lines[j]
        others = (extents[i] for i in range(len(bodies)) if i != k)
        if all(right.compare(west) < 0 or left.compare(east) > 0 for left, right in others):
            lone.append(k)
    return lone


def lone_convex() -> Finding:
    """Single convex obstacles in a strip as wide as the radius, and in one that is narrower."""
    for shape in LONE:
        for terrain, radius in ((Terrain(4, 12), 4), (Terrain(4, 12), 9)):
            case = Case(Scene([shape], terrain=terrain, radius=radius))
            finding = acquires_the_lone_convex(case)
            if finding is SILENT or finding.detail:
                return found(False, f"{shape!r} at R = {radius}: {finding.detail or 'not alone'}")
    return found(True)


def diverts_for_occluders(case: Case) -> Finding:
    """Convex obstacles: at most n / 2 diversions, each of which circles an obstacle besides its target."""
    run = case.spreader
    diversions, n = run.diversions, len(run.obstacles)
    if not diversions or not all_convex(run):
        return SILENT
    count = f"{len(diversions)} diversions, n = {n}"
    for diversion in diversions:
        if not circled_on(run, diversion) - {diversion.obstacle}:
            label = run.obstacles[diversion.obstacle].label
            return found(False, f"{count}; the one to {label} circles nothing else")
    return found(2 * len(diversions) <= n, count, 2 * len(diversions) / n)


def diverts_once_each(case: Case) -> Finding:
    """At most n diversions, each to another obstacle."""
    run = case.spreader
    targets = [diversion.obstacle for diversion in run.diversions]
    if not targets:
        return SILENT
    return found(len(targets) == len(set(targets)), f"to {_labels(case, targets)}")


def pockets(count: int) -> Scene:
    """Squares with a pocket that can be seen from inside only, out of each other's sight; R = B = 20.

    The pocket opens to the west, and its upper western corner lies behind the wall above its mouth.
    """
    unit, column = rational("1/100"), 14
    outer = [(0, 0), (3, 0), (3, 3), (0, 3)]
    pocket = [(0, 2), (HALF, 2), (HALF, 5 * HALF), (2, 5 * HALF), (2, 1), (0, 1)]
    outline = [(column + x * unit, 30 + y * unit) for x, y in outer + pocket]
    shapes = [Polygon([(x, y + 90 * k) for x, y in outline]) for k in range(count)]
    return Scene(shapes, terrain=Terrain(20, 90 * count), radius=20, name=f"pockets-{count}")


def diverts_to_each_pocket() -> Finding:
    """Obstacles with pockets, far from each other: as many diversions as obstacles."""
    for count in POCKETS:
        run = Case(pockets(count)).spreader
        targets = sorted(diversion.obstacle for diversion in run.diversions)
        if targets != list(range(count)):
            return found(False, f"{count} pockets, diversions to {targets}")
    return found(True)


def diversions_within_width(case: Case) -> Finding:
    """A diversion walks at most 2w straight, there and back."""
    terrain = case.scene.terrain
    assert terrain is not None
    width = min(case.spreader.radius, terrain.width)
    return _short(case, Length(2 * width), (*TIMELY, Reason.LINE_ENDS, Reason.OVERDUE))


def diversions_within_radius(case: Case) -> Finding:
    """A diversion because of sight or reach walks at most 2R straight, any diversion at most 2 |DQ|."""
    run = case.spreader
    for diversion in run.diversions:
        if straight_length(run, diversion) > diversion.length * 2:
            return flaw(_way(case, diversion))
    return _short(case, Length(2 * run.radius), TIMELY)


def _short(case: Case, most: Length, reasons: tuple[Reason, ...]) -> Finding:
    run = case.spreader
    diversions = [d for d in run.diversions if d.reason in reasons]
    if not diversions:
        return SILENT
    longest = max(diversions, key=lambda d: straight_length(run, d))
    way = straight_length(run, longest)
    text = f"{_way(case, longest)}, at most {float(most):.6g}"
    return found(way <= most, text, float(way) / float(most))


def _way(case: Case, diversion: Diversion) -> str:
    way = float(straight_length(case.spreader, diversion))
    return f"the diversion to {case.spreader.obstacles[diversion.obstacle].label} goes {way:.6g} straight"


def costs_three_perimeters(case: Case) -> Finding:
    """To circle an obstacle and leave it costs at most 3p, 1.5p clear of the border; to pass, p or p/2."""
    run, worst = case.spreader, None
    for stay in stays(run):
        body = run.obstacles[stay.obstacle]
        perimeter = Length.sum(edge.length for edge in body.edges)
        most = perimeter * (3 if is_circuit(run, stay) else 1) * (HALF if body.closed else 1)
        ratio = float(stay.length) / float(most)
        worst = ratio if worst is None else max(worst, ratio)
        if stay.length > most:
            return found(False, f"{body.label}: {float(stay.length):.6g} of {float(most):.6g}", ratio)
    return SILENT if worst is None else found(True, "", worst)


def walks_thrice_in_all(case: Case) -> Finding:
    """No piece of a boundary is walked more than three times in the whole run."""
    run = case.spreader
    walks = list(stays(run))
    owners = {stay.obstacle for stay in walks}
    if not owners:
        return SILENT
    most = max(times_walked(run, (s for s in walks if s.obstacle == k)) for k in owners)
    return found(most <= 3, f"walked {most} times", most / 3)


def walks_thrice_at_a_time(case: Case) -> Finding:
    """No piece of a boundary is walked more than three times on one stay at its obstacle."""
    run = case.spreader
    counts = [times_walked(run, [stay]) for stay in stays(run)]
    return found(max(counts) <= 3, "", max(counts) / 3) if counts else SILENT


def matches_the_sightseer(case: Case) -> Finding:
    """What the Sightseer acquires in a terrain the Seed Spreader acquires too."""
    if not case.swept_to_the_end:
        return SILENT
    swept = {
        component.obstacle.index
        for k, component in enumerate(case.field.run.ground.components if case.field.run.ground else ())
        if k in case.spreader.map.acquired
    }
    lacking = sorted(set(case.sightseer.map.acquired) - swept)
    names = ", ".join(case.scene.obstacles[k].label for k in lacking)
    return found(not lacking, f"acquired by the Sightseer only: {names}" if lacking else "")


def leaves_at_the_next_crossing(case: Case) -> Finding:
    """L = c_(k+1) for every hit H = c_k."""
    return _crossings(case, clear_only=False)


def leaves_where_it_can(case: Case) -> Finding:
    """Clear of the border L = c_(k+1), and crossings are even; at it L is the next that can be walked to."""
    return _crossings(case, clear_only=True)


def _crossings(case: Case, clear_only: bool) -> Finding:
    if not any(
        event.occasion is Occasion.M_LINE and event.kind is EventKind.LEAVE for event in case.spreader.events
    ):
        return SILENT
    return flaw(crossing_flaw(case, clear_only))


def _labels(case: Case, obstacles: object) -> str:
    return ", ".join(case.spreader.obstacles[k].label for k in obstacles)  # type: ignore[attr-defined]


CLAIMS = (
    Claim(
        "SSS-1",
        "section 4.1",
        Statement(
            "The Seed Spreader ends: each hop over an obstacle advances on the M-line, and each diversion "
            "acquires one more obstacle.",
            SPREADER,
            advances,
            argument="SSS-1",
        ),
    ),
    Claim(
        "SSS-2",
        "section 5, convergence; section 1, formulation (b)",
        Statement(
            "A sweep that comes to T has acquired every obstacle that can be reached.",
            SPREADER,
            finds_everything,
            counterexamples=("m14",),
        ),
        Statement(
            "A sweep that comes to T has acquired every obstacle in reach of which it knows a point.",
            SPREADER,
            acquires_what_it_sees,
            argument="SSS-2",
        ),
        "Two obstacles can become known from the lines and hide a third for good; three convex ones suffice.",
    ),
    Claim(
        "SSS-3",
        "section 4.1, the very last moment, cases (1) and (2)",
        Statement(
            "It is enough to divert where an incomplete obstacle goes from visible to invisible: then "
            "too each obstacle that was seen is acquired at T.",
            SPREADER,
            acquires_by_sight_alone,
            counterexamples=("m15",),
        ),
        Statement(
            "With the range of known points and the end of a line as further reasons, it is acquired.",
            SPREADER,
            acquires_what_it_sees,
            argument="SSS-2",
        ),
        "The engine has no option for this reading. It is decided by sensing along the bare M-line: on "
        "m15 nothing incomplete goes out of sight on the eastern line, so that this reading never diverts.",
    ),
    Claim(
        "SSS-4",
        "section 4.3, before Case 1",
        Statement(
            "A convex obstacle alone in its strip is acquired from the M-line.",
            SPREADER,
            acquires_the_lone_convex,
            lone_convex,
            argument="SSS-4",
        ),
    ),
    Claim(
        "SSS-5",
        "section 4.3, before Case 1",
        Statement(
            "For convex obstacles every diversion circles an unvisited occluder besides its target, so "
            "there are at most $n / 2$ diversions.",
            SPREADER,
            diverts_for_occluders,
            counterexamples=("m15", "sss5"),
        ),
        Statement(
            "There are at most $n$ diversions, and for every $n$ there are $n$ obstacles that take $n$.",
            SPREADER,
            diverts_once_each,
            diverts_to_each_pocket,
            argument="SSS-5",
        ),
        "The occluder can be known already (m15), or lie beside the way to the target (sss5): there two "
        "diversions are made for three obstacles, by any option. On the like scene m18 it is one, and two "
        "only if they go to visible points. Obstacles with pockets reach $n$; seven convex ones can take "
        "six (tight-sss5-fan).",
    ),
    Claim(
        "SSS-6",
        "section 4.3, before Theorem 2: the term $2nw$ of (5)",
        Statement(
            "The straight parts of a diversion add up to at most $2w$, $w$ the width of a strip.",
            SPREADER,
            diversions_within_width,
            counterexamples=("sss6", "relay"),
        ),
        Statement(
            r"They add up to at most $2\,\lvert DQ \rvert$, which is at most $2R$ for a diversion because "
            "of sight or reach.",
            SPREADER,
            diversions_within_radius,
            argument="ways",
        ),
        "Even $2R$ is too little for an obstacle that was first seen on another diversion: on relay "
        r"$\lvert DQ \rvert$ grows to $5.8\,R$, and with it the sum of all diversions grows quadratically "
        "in $n$.",
    ),
    Claim(
        "SSS-7",
        "section 4.3, before Theorem 2",
        Statement(
            "To acquire an obstacle and leave it costs at most $3p$ of its boundary, $1.5p$ clear of the "
            "border; to pass around it $p$, or $p/2$.",
            SPREADER,
            costs_three_perimeters,
            argument="SSS-7",
        ),
    ),
    Claim(
        "SSS-8",
        "section 4.1",
        Statement(
            "No piece of a boundary is walked more than three times in a run.",
            SPREADER,
            walks_thrice_in_all,
            counterexamples=("m20-8",),
        ),
        Statement(
            "No piece of a boundary is walked more than three times on one stay at its obstacle.",
            SPREADER,
            walks_thrice_at_a_time,
            argument="SSS-8",
        ),
        "A known obstacle is passed again on every line that it blocks.",
    ),
    Claim(
        "SSS-9",
        "section 1, after the formulations",
        Statement(
            "The Seed Spreader acquires whatever the Sightseer would acquire in the same terrain.",
            SPREADER,
            matches_the_sightseer,
            counterexamples=("sss9",),
        ),
        note="The obstacle that the sweep misses in m14 is in sight of the two that hide it.",
    ),
    Claim(
        "E3",
        "section 4.1, equation (3)",
        Statement(
            "The robot leaves an obstacle at the crossing point after its hit point: $H = c_k$, "
            "$L = c_{k+1}$.",
            SPREADER,
            leaves_at_the_next_crossing,
            counterexamples=("e3",),
        ),
        Statement(
            "That holds clear of the border, where the crossing points are even in number; at the border "
            "$L$ is the next one at which the M-line goes on and that the robot can walk to.",
            SPREADER,
            leaves_where_it_can,
            argument="E3",
        ),
    ),
)
