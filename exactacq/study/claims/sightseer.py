"""The claims about the Sightseer Strategy up to Lemma 2 (paper, section 3)."""

from __future__ import annotations

from exactacq.auditing.bounds import clipped_distance
from exactacq.numbers.length import Length
from exactacq.study.claims.lattices import never_ends
from exactacq.study.claims.model import SILENT, Case, Claim, Finding, Statement, Subject, flaw, found
from exactacq.study.claims.sights import overlooked
from exactacq.study.claims.tallies import bounds_flaw, bounds_of
from exactacq.study.claims.trees import arrivals, circled, end_flaw, move_flaw, traversal_flaw, tree_flaw
from exactacq.study.claims.walks import moves
from exactacq.visibility.links import START

SIGHTSEER = Subject.SIGHTSEER


def ends(case: Case) -> Finding:
    """The run ends, after circling each obstacle once that is linked with S by sight, and no other."""
    if (text := end_flaw(case.sightseer)) is not None:
        return flaw(text)
    around = set(circled(case.sightseer))
    return found(
        around == case.within_sight, f"circled {sorted(around)}, linked to S {sorted(case.within_sight)}"
    )


def moves_straight(case: Case) -> Finding:
    """Each straight move to an obstacle not visited before meets no other such one; the others lead back."""
    if not case.sightseer.visits:
        return SILENT
    return flaw(move_flaw(case))


def is_complete(case: Case) -> Finding:
    """In model (a) the run ends with every obstacle circled and acquired, and nothing overlooked."""
    if not case.is_mutually_visible:
        return SILENT
    run = case.sightseer
    everything = set(range(len(run.scene.obstacles)))
    if set(circled(run)) != everything:
        return flaw(f"circled are {circled(run)} of {len(everything)}")
    if set(run.map.acquired) != everything:
        return flaw(f"acquired are {run.map.acquired} of {len(everything)}")
    return flaw(overlooked(case, run))


def shows_linked_only(case: Case) -> Finding:
    """Every obstacle on the map is linked with S by sight between boundaries."""
    strangers = sorted(set(case.sightseer.map.seen) - case.within_sight)
    return found(not strangers, f"on the map but linked to nothing: {strangers}" if strangers else "")


def shows_what_is_visible(case: Case) -> Finding:
    """The map lacks nothing that the path shows, and in model (a) it is complete."""
    if (text := overlooked(case, case.sightseer)) is not None:
        return flaw(text)
    return is_complete(case)


def walks_twice(case: Case) -> Finding:
    """No segment between obstacles is walked more than twice."""
    return flaw(traversal_flaw(case.sightseer)) if len(case.scene.obstacles) > 1 else SILENT


def visits_few(case: Case) -> Finding:
    """At most 2(n - 1) arrivals at obstacles."""
    if not case.is_mutually_visible:
        return SILENT
    count, most = arrivals(case.sightseer), 2 * (len(case.scene.obstacles) - 1)
    return found(count <= most, f"{count} visits, at most {most}", count / most if most else None)


def visits_few_of_several(case: Case) -> Finding:
    """At most 2(n - 1) arrivals at obstacles, claimed for n >= 2 only."""
    return visits_few(case) if len(case.scene.obstacles) > 1 else SILENT


def walks_a_tree(case: Case) -> Finding:
    """The segments are a spanning tree, the stack holds at most n - 1 obstacles, n - 2 visits are returns."""
    return flaw(tree_flaw(case.sightseer)) if case.is_mutually_visible else SILENT


def edges_within_distance(case: Case) -> Finding:
    """Each segment between obstacles is at most min(R, d_max) long."""
    steps = [m.piece.length for m in moves(case.sightseer) if START not in (m.source, m.target)]
    if not steps:
        return SILENT
    most = Length(clipped_distance(case.sightseer, case.world))
    longest = max(steps)
    text = f"the longest edge is {float(longest):.6g}, min(R, d_max) is {float(most):.6g}"
    return found(longest <= most, text, float(longest) / float(most))


def edges_within_sight(case: Case) -> Finding:
    """Each segment between nodes i and j is v(i, j) long, which is at most R."""
    run = case.sightseer
    for move in moves(run):
        if not case.graph.has_edge(move.source, move.target):
            return flaw(f"{move.source} and {move.target} do not see each other")
        if move.piece.length != case.graph.edges[move.source, move.target]["weight"]:
            return flaw(f"the edge from {move.source} to {move.target} is not the shortest visible segment")
        if move.piece.length > Length(run.radius):
            return flaw(f"the edge from {move.source} to {move.target} is longer than R")
    return found(True) if run.links else SILENT


def farthest_keeps_the_bound(case: Case) -> Finding:
    """If the farthest obstacle in sight is chosen, the path is a tree walk too, within Theorem 1."""
    if not case.is_mutually_visible:
        return SILENT
    run = case.farthest
    for text in (end_flaw(run), traversal_flaw(run), tree_flaw(run), bounds_flaw(case, run)):
        if text is not None:
            return flaw(text)
    value = bounds_of(run)["T1 corrected"]
    return found(run.length <= value, "", float(run.length) / float(value))


CLAIMS = (
    Claim(
        "SS-1",
        "section 3.1, convergence",
        Statement(
            "The Sightseer ends on every terrain with a locally finite number of obstacles, be it infinite.",
            SIGHTSEER,
            trial=never_ends,
            is_false=True,
        ),
        Statement(
            "On finitely many obstacles the Sightseer ends; it has then circled once each obstacle that is "
            "linked with S by sight.",
            SIGHTSEER,
            ends,
            argument="SS-1",
        ),
        "The model of section 2 allows an infinite terrain. On a lattice of squares the map never runs "
        "dry; that this goes on for ever is a written argument, the trial shows growing beginnings of "
        "the infinite run.",
    ),
    Claim(
        "SS-2",
        "section 3.1, linear navigation",
        Statement(
            "Each straight move leads to an obstacle not visited before and meets no other such one, or "
            "leads back the way the robot came.",
            SIGHTSEER,
            moves_straight,
            argument="SS-2",
        ),
        note="With $v$ as the weight: of what a segment met first, the first would be nearer. It may graze "
        "visited obstacles.",
    ),
    Claim(
        "SS-3",
        "section 3.2, step 1",
        Statement(
            "In model (a): when no unvisited obstacle is left on the map, the map is complete.",
            SIGHTSEER,
            is_complete,
            argument="SS-3",
        ),
    ),
    Claim(
        "SS-4",
        "section 3.1, and section 3.2, step 2",
        Statement(
            "Only obstacles that are linked by sight between boundaries appear on the map, so that back at S "
            "it is complete.",
            SIGHTSEER,
            shows_linked_only,
            counterexamples=("m4",),
        ),
        Statement(
            "The map lacks nothing that the path shows, and in model (a) it is complete at the end.",
            SIGHTSEER,
            shows_what_is_visible,
            argument="SS-3",
        ),
        "An obstacle can be seen from the way between two others and from neither of their boundaries.",
    ),
    Claim(
        "SS-5",
        "section 3.3, before Lemma 1",
        Statement(
            "In model (a) the segments walked are a spanning tree, the stack holds at most $n - 1$ "
            "obstacles, and at most $n - 2$ visits are returns.",
            SIGHTSEER,
            walks_a_tree,
            argument="SS-5",
        ),
        note="The paper takes S to be on an obstacle. A free S is one more node and one more entry of "
        "the stack.",
    ),
    Claim(
        "SS-6",
        "section 3.3, before Theorem 1",
        Statement(
            r"Each segment between obstacles is at most $\min(R, d_{\max})$ long, $d_{\max}$ the largest "
            "closest distance between two obstacles.",
            SIGHTSEER,
            edges_within_distance,
            counterexamples=("m8",),
        ),
        Statement(
            r"Each segment from $i$ to $j$ is the shortest visible one, $v(i, j)$, and so at most "
            r"$\min(R, v_{\max})$ long.",
            SIGHTSEER,
            edges_within_sight,
            argument="SS-6",
        ),
        "Something may stand where two obstacles are closest.",
    ),
    Claim(
        "SS-7",
        "section 3.3, after Theorem 1",
        Statement(
            "With another choice than the nearest obstacle in sight, the farthest, the corrected bound of "
            "Theorem 1 holds too.",
            SIGHTSEER,
            farthest_keeps_the_bound,
            argument="SS-7",
        ),
        note=r"$v_{\max}$ is then that of the other tree.",
    ),
    Claim(
        "L1",
        "Lemma 1",
        Statement(
            "A segment between obstacles is walked at most twice.", SIGHTSEER, walks_twice, argument="L1"
        ),
        note="Counted by tree edges: two of them may overlap as point sets.",
    ),
    Claim(
        "L2",
        "Lemma 2",
        Statement(
            "In model (a) $n$ obstacles get at most $2(n - 1)$ visits, those on the way back included.",
            SIGHTSEER,
            visits_few,
            counterexamples=("l2",),
        ),
        Statement(
            r"The same for $n \ge 2$.",
            SIGHTSEER,
            visits_few_of_several,
            argument="L2",
        ),
        "A single obstacle is visited once, not 0 times.",
    ),
)
