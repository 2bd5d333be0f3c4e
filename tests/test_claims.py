"""The registry of claims is complete, its verdicts follow from findings alone, and its counts are right."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise

import pytest

from exactacq import Circle, FormatError, Length, Outline, Polygon, Scene, Terrain
from exactacq.auditing.bounds import clipped_distance
from exactacq.files import gallery
from exactacq.sensing.event import Occasion
from exactacq.study.claims import CLAIMS, Case, Outcome, Statement, Status, Subject, claim, verdict
from exactacq.study.claims.coverage import times_walked
from exactacq.study.claims.formulas import spoken
from exactacq.study.claims.model import SILENT, found
from exactacq.study.claims.sights import overlooked
from exactacq.study.claims.sightseer import farthest_keeps_the_bound
from exactacq.study.claims.sweeps import bare_walk, hops, is_convex
from exactacq.study.claims.tallies import Tally, bounds_flaw, bounds_of, straight_length
from exactacq.study.claims.trees import arrivals, circled, tree_flaw
from exactacq.study.claims.walks import is_circuit, moves, node_at, stays, traversals

ROWS = [
    *("SS-1", "SS-2", "SS-3", "SS-4", "SS-5", "SS-6", "SS-7", "L1", "L2", "T1"),
    *("SSS-1", "SSS-2", "SSS-3", "SSS-4", "SSS-5", "SSS-6", "SSS-7", "SSS-8", "SSS-9", "E3"),
    *("L3", "T2", "C8", "F1", "F2", "F3", "F4", "CMP"),
]


@cache
def example(name: str) -> Case:
    return Case(gallery.scene(name))


class TestRegistry:
    def test_every_row_is_there_once(self) -> None:
        assert [c.name for c in CLAIMS] == ROWS

    def test_every_claim_says_what_and_where_and_can_be_decided(self) -> None:
        for c in CLAIMS:
            assert c.place
            for statement in c.statements:
                assert statement.text.endswith(".")
                assert statement.check or statement.trial
                assert not (statement.is_called_false and statement.argument)

    def test_formulas_have_plain_words(self) -> None:
        """Formulas are between dollars, and nothing of their TeX is left in the words for terminals."""
        texts = [text for c in CLAIMS for text in (c.place, c.note, *(s.text for s in c.statements))]
        for text in texts:
            assert text.count("$") % 2 == 0
            assert not set(spoken(text)) & set("\\{}$")
            assert not set(text) & set("\\{}") or "$" in text
        assert claim("L3").printed.words == "The visits are at most n + n n_0 + 1/2 sum n_j (n_j - 1)."
        assert spoken(r"$\lvert DQ \rvert - c_{k+1}^2 \ge p_{\text{last}}$") == "|DQ| - c_(k+1)^2 >= p_last"

    def test_what_is_called_false_has_its_scene(self) -> None:
        for c in CLAIMS:
            assert c.corrected is None or c.printed.is_called_false
            assert set(c.printed.counterexamples) <= set(gallery.names())

    def test_a_claim_by_name(self) -> None:
        assert claim("SS-6").printed.counterexamples == ("m8",)
        with pytest.raises(FormatError, match=r"no claim 'SS-8'; there are SS-1, .*CMP"):
            claim("SS-8")


class TestVerdict:
    """A verdict for each way in which findings can agree or disagree with what a statement is called."""

    @staticmethod
    def of(*outcomes: Outcome, **fields: object) -> Status:
        """The status of a statement whose check gives these outcomes on so many cases."""
        cases = [(str(k), example("squares")) for k in range(len(outcomes))]
        given = iter(outcomes)
        statement = Statement(
            "It.", Subject.SIGHTSEER, lambda _: found(True) if (o := next(given)) is Outcome.HOLDS else
            SILENT if o is Outcome.SILENT else found(False)
        )  # fmt: skip
        statement = replace(statement, **fields)
        return verdict(statement, cases, example).status

    def test_true(self) -> None:
        assert self.of(Outcome.HOLDS, Outcome.SILENT) is Status.HOLDS
        assert self.of(Outcome.HOLDS, argument="X") is Status.PROVED
        assert self.of(Outcome.SILENT, argument="X") is Status.UNTRIED
        assert self.of(Outcome.HOLDS, Outcome.FAILS, argument="X") is Status.CONTRADICTED

    def test_false(self) -> None:
        assert self.of(Outcome.FAILS, counterexamples=("m8",)) is Status.FALSE
        assert self.of(Outcome.FAILS, Outcome.SILENT, counterexamples=("m8", "m4")) is Status.CONTRADICTED
        assert self.of(Outcome.HOLDS, counterexamples=("m8",)) is Status.CONTRADICTED
        assert self.of(is_false=True) is Status.CONTRADICTED, "nothing was asked that could show it"

    def test_trial(self) -> None:
        fails = Statement("It.", Subject.SIGHTSEER, trial=lambda: found(False, "so"))
        assert verdict(fails, [], example).status is Status.CONTRADICTED
        assert verdict(replace(fails, is_false=True), [], example).status is Status.FALSE
        assert verdict(fails, [], example).details == ("trial: so",)

    def test_worst_ratio(self) -> None:
        statement = claim("T1").corrected
        assert statement is not None
        both = verdict(statement, [(n, example(n)) for n in ("squares", "circles")], example)
        assert (both.tried, both.failures) == (2, ())
        assert both.worst is not None
        assert both.worst <= 1


class TestSightseerCounts:
    def test_two_squares(self) -> None:
        """S, the first square, and on to the second: two moves, none back."""
        run = example("squares").sightseer
        assert [(m.source, m.target) for m in moves(run)] == [("S", 0), (0, 1)]
        assert (arrivals(run), circled(run)) == (2, [0, 1])
        assert [count for _, count in traversals(moves(run))] == [1, 1]

    def test_a_start_on_an_obstacle(self) -> None:
        """S is no node of its own, and to be there is the first visit."""
        scene = Scene([box(0, 0, 1, 1), box(2, 0, 3, 1), box(-2, 0, -1, 1)], (0, 0), radius=1)
        run = Case(scene).sightseer
        assert node_at(run, run.start) == 0
        assert arrivals(run) == 4
        assert tree_flaw(run) is None
        back = [m for m in moves(run) if m.returns]
        assert [(m.source, m.target) for m in back] == [(1, 0)]

    def test_the_farthest_first(self) -> None:
        """From the middle of three the farther one is taken first."""
        scene = Scene([box(0, 0, 1, 1), box(2, 0, 3, 1), box(-3, 0, -2, 1)], (0, 0), radius=3)
        assert circled(Case(scene).farthest) == [0, 2, 1]
        assert circled(Case(scene).sightseer) == [0, 1, 2]

    def test_largest_distance(self) -> None:
        far, lone = example("m8"), example("l2")
        assert clipped_distance(far.sightseer, far.world) == rational_half(7)
        assert clipped_distance(lone.sightseer, lone.world).sign() == 0
        assert bounds_of(lone.sightseer)["T1 corrected"] == Length(10)


class TestSweepCounts:
    def test_figure_4(self) -> None:
        """O1, O2, O4, O5 and O6 cross the M-line, O3 lies in strip 2; O1, O4 and O6 are met again."""
        tally, field = example("figure4").shared(Tally), example("figure4").field
        inside = {body.label: field.strip(k) for k, body in enumerate(tally.run.obstacles)}
        assert {tally.run.obstacles[k].label for k in field.crossing} == {"O1", "O2", "O4", "O5", "O6"}
        assert inside["O3"] == 2
        assert bounds_of(tally.run)["(4)"] == Length("46")  # 6 + 6 * 5 + 5 * 4 / 2
        names = [tally.run.obstacles[k].label for k in tally.met_again]
        assert names == ["O1", "O6", "O4"]
        assert tally.visits == 9
        assert not tally.is_clear

    def test_tangency_is_no_crossing(self) -> None:
        """One obstacle touches a line from the west, one from the east, one lies on both sides of it."""
        shapes = [Circle((2, 2), 1), box(3, 4, 4, 5), box(2, 6, 4, 7)]
        case = Case(Scene(shapes, terrain=Terrain(6, 9), radius=3))
        assert case.field.crossing == {2}
        assert [case.field.strip(k) for k in (0, 1)] == [1, 2]
        assert bounds_of(case.spreader)["(4)"] == Length(6)
        assert bounds_flaw(case, case.spreader) is None

    def test_a_wrong_value_is_named(self) -> None:
        case = example("m25")
        run = case.spreader
        wrong = replace(run, bounds=(replace(run.bounds[0], value=Length(1)), *run.bounds[1:]))
        assert bounds_flaw(case, wrong) == f"bound (4) is 1.{'0' * 19}..., not 3.{'0' * 19}"
        fewer = replace(run, bounds=run.bounds[1:])
        assert bounds_flaw(case, fewer).startswith("the bounds are ['L3 corrected'")
        again = replace(run, again=(0,))
        assert bounds_flaw(case, again) is not None
        tour = example("squares").sightseer
        text = bounds_flaw(example("squares"), replace(tour, visits=(1, 0)))
        assert text == "the run counts the obstacles [1, 0], its path and events [0, 1]"

    def test_far_diversions(self) -> None:
        """Each crumb of the relay is farther; the corrected bound fails without the term for them."""
        case = example("relay")
        ways = [straight_length(case.spreader, d) for d in case.spreader.diversions]
        assert all(a < b for a, b in pairwise(ways))
        assert not any(
            e.kind in ("hit", "cross") and e.occasion is Occasion.M_LINE for e in case.spreader.events
        )
        bound = bounds_of(case.spreader)["T2 corrected"]
        far = Length.sum(d.length - Length(case.spreader.radius) for d in case.spreader.diversions)
        assert bound - far * 2 < case.spreader.length < bound
        assert case.shared(Tally).stays_in_strips
        assert not case.shared(Tally).overtaken
        assert case.shared(Tally).proved_length() == bound

    def test_hops(self) -> None:
        """The bar crosses lines 1 to 3: each time from one crossing point to the next."""
        assert [(h.hit, h.leave) for h in hops(example("m20-3"))] == [(0, 1), (2, 3), (4, 5)]

    def test_times_walked(self) -> None:
        """The left end of the bar: the circuit, and the shorter way on the western lines."""
        run = example("m20-8").spreader
        walks = list(stays(run))
        assert [is_circuit(run, stay) for stay in walks] == [True] + [False] * 7
        assert times_walked(run, walks) == 5
        assert times_walked(run, walks[:1]) == 2

    def test_times_walked_on_arcs(self) -> None:
        """A circle is met at its south point, circled from there, and left at its north point."""
        case = Case(Scene([Circle((3, 4), 1)], terrain=Terrain(6, 8), radius=3))
        (stay,) = stays(case.spreader)
        assert times_walked(case.spreader, [stay]) == 2
        assert times_walked(case.spreader, [stay, stay]) == 4

    def test_bare_walk(self) -> None:
        """On m15 nothing goes out of sight on the eastern line, on m25 both do for a while."""
        assert bare_walk(example("m15")).lost == frozenset()
        assert bare_walk(example("m15")).left == (0,)
        assert bare_walk(example("m25")).lost

    def test_convex(self) -> None:
        shapes = [
            (Circle((0, 0), 1), True),
            (box(0, 0, 1, 1), True),
            (Polygon([(0, 0), (2, 0), (2, 2), (1, 1)]), True),
            (Polygon([(0, 0), (2, 0), (1, "1/2"), (0, 2)]), False),
            (Outline([(0, 0, "1/5"), (1, 0), (1, 1)]), True),
            (Outline([(0, 0, "-1/5"), (1, 0), (1, 1)]), False),
            (Outline([(0, 0, 1), (2, 0, 0), ("3/2", 1, 0), ("1/2", 1, 0)]), True),
            (Outline([(0, 0, 1), (2, 0, 0), (3, 1, 0), (-1, 1, 0)]), False),
            # It only turns left but at (2, 2), where it turns back: a cusp.
            (Outline([(2, 0), (3, 0), (3, 3), (0, 3), (0, 2, 1), (2, 2)]), False),
        ]
        for shape, expected in shapes:
            assert is_convex(Scene([shape]).obstacles[0].edges) is expected, shape


def test_diversions_by_all_options() -> None:
    """What the note on SSS-5 tells: two on sss5, on m18 only to visible points."""
    options = [(ahead, target) for target in ("known", "visible") for ahead in (True, False)]
    for name, counts in (("sss5", [2, 2, 2, 2]), ("m18", [1, 1, 2, 2])):
        assert [len(example(name).sweep(*option).diversions) for option in options] == counts


def test_overlooked() -> None:
    """A final map that is really an earlier one lacks what the path shows since."""
    case = example("squares")
    run = Case(gallery.scene("squares")).sightseer
    assert overlooked(case, run) is None
    vars(run)["map"] = run.map_at(run.events[0])
    text = overlooked(case, run)
    assert text is not None
    assert text.endswith("and not on the map")


def box(left: object, bottom: object, right: object, top: object) -> Polygon:
    return Polygon([(left, bottom), (right, bottom), (right, top), (left, top)])


def rational_half(number: int) -> object:
    return Length(f"{number}/2").algebraic


def test_a_start_between_obstacles_does_not_link_them() -> None:
    """The start sees both, but neither sees the other one: the way back to the start counts double.

    Taken for model (a), the scene failed the corrected Theorem 1 under the rule of SS-7.
    """
    diamond = Polygon([(4, "11/2"), (3, 5), (2, "11/2"), (3, 6)])
    wall = Outline([(8, 2, "-1/5"), (8, 1), (11, 1), (11, 2)])
    case = Case(Scene([diamond, wall], start=(4, "7/2")), radius=5)
    assert [link.source for link in case.farthest.links] == ["S", "S"]
    assert not case.is_mutually_visible
    assert farthest_keeps_the_bound(case) is SILENT
