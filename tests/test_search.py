"""The search: it repeats itself, judges exactly, makes finds small and keeps what they show."""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path
from random import Random

import pytest
import typer
from flint import fmpq
from nightly import by_night
from typer.testing import CliRunner

import exactacq as xa
from exactacq.errors import FormatError, InvalidScene
from exactacq.files import gallery
from exactacq.files.scene_json import scene_text
from exactacq.numbers.rationals import rational
from exactacq.study.claims.model import Case, Finding, Outcome, Statement, Subject
from exactacq.study.claims.sweeps import is_convex as convex
from exactacq.study.search import Budget, Draft, Goal, Referee, Search, annealing, goal, goal_names, shrink
from exactacq.study.search import hypothesis_search as hypothesis_home
from exactacq.study.search.command import search
from exactacq.study.search.drafts import Seat, is_convex
from exactacq.study.search.hypothesis_search import hypothesis_search
from exactacq.study.search.moves import MOVES, Rules, mutate, rounded
from exactacq.study.search.referee import BROKEN, Ruling, judged

GALLERY = Path(gallery.__file__).parent / "data" / "gallery"
APP = typer.Typer()
APP.command()(search)


def box(x: object, y: object, side: object = 1) -> xa.Polygon:
    x, y, side = fmpq(x), fmpq(y), fmpq(side)
    return xa.Polygon([(x, y), (x + side, y), (x + side, y + side), (x, y + side)])


def two_boxes() -> Draft:
    return Draft((box(0, 0), box(3, 0)), fmpq(10), start=(fmpq(-1), fmpq(0)))


def visits_less_than_two(case: Case) -> Finding:
    """A false statement that is broken by any two obstacles in sight."""
    run = case.sightseer
    ratio = len(run.visits) / 2
    return Finding(Outcome.FAILS if len(run.visits) >= 2 else Outcome.HOLDS, "", ratio)


def is_short(case: Case) -> Finding:
    """P <= 40: a statement whose ratio can be raised step by step."""
    run = case.sightseer
    return Finding(Outcome.HOLDS if run.length <= 40 else Outcome.FAILS, "", float(run.length) / 40)


def sleeps(case: Case) -> Finding:
    """Takes a minute over two obstacles."""
    time.sleep(60 if len(case.scene.shapes) == 2 else 0)
    return Finding(Outcome.HOLDS, "", 0.5)


def dies(case: Case) -> Finding:
    """Ends its process over two obstacles."""
    if len(case.scene.shapes) == 2:
        os._exit(7)
    return Finding(Outcome.HOLDS, "", 0.5)


def explore(check: object, seed: int, steps: int, begin: Draft | None = None) -> Search:
    hunt = Search(Referee(check), Subject.SIGHTSEER, Rules(obstacles=3), seed, begin)
    hunt.run(Budget(steps))
    return hunt


# -- drafts --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["circles", "figure2", "m4", "m9", "m14", "m20-3"])
def test_a_draft_gives_its_scene_back(name: str, tmp_path: Path) -> None:
    scene = gallery.scene(name)
    draft = Draft.of(scene)
    assert draft.scene().shapes == scene.shapes
    if not gallery.is_swept(name):
        assert draft.scene().start == scene.start
    path = tmp_path / "scene.json"
    path.write_text(draft.text(name))
    assert Draft.of(xa.load(path)) == draft
    assert draft.mapped(lambda _, __, value: value) == draft
    assert sum(1 for _ in draft.numbers()) == _numbers_mapped(draft)


def _numbers_mapped(draft: Draft) -> int:
    seen: list[fmpq] = []
    draft.mapped(lambda _, __, value: seen.append(value) or value)
    return len(seen)


def test_a_start_on_a_boundary_goes_with_it() -> None:
    scene = xa.Scene([box(0, 0)], start=("1/4", 0), radius=9)
    draft = Draft.of(scene)
    assert (draft.start, draft.seat) == (None, Seat(0, 0, fmpq(1, 4)))
    assert draft.replaced(0, box(5, 5)).place == (fmpq(21, 4), fmpq(5))


def test_convexity() -> None:
    notched = xa.Polygon([(0, 0), (4, 0), (4, 4), (2, 1), (0, 4)])
    lens, bay = xa.Outline([(0, 0, 1), (2, 0, 1)]), xa.Outline([(0, 0), (4, 0, "-1/2"), (4, 4), (0, 4)])
    peanut = xa.Outline([(0, 0, 2), (2, 0, 1)])
    shapes = [
        box(0, 0),
        xa.Polygon([(0, 0), (0, 1), (1, 0)]),
        xa.Circle((0, 0), 1),
        lens,
        notched,
        bay,
        peanut,
    ]
    assert [is_convex(shape) for shape in shapes] == [True] * 4 + [False] * 3
    assert [convex(xa.Scene([shape]).obstacles[0].edges) for shape in shapes] == [True] * 4 + [False] * 3


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ((5, 1), "5"),
        ((-1, 4), "-0.25"),
        ((1, 3), '"1/3"'),
        ((21, 2), "10.5"),
        ((3, 1000), "0.003"),
        ((0, 1), "0"),
    ],
)
def test_numbers_are_written_exactly(value: tuple[int, int], text: str) -> None:
    assert f'"radius": {text},' in scene_text((), radius=fmpq(*value))


# -- moves ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["m8", "m14"])
def test_moves_keep_the_rules_and_most_give_valid_scenes(name: str) -> None:
    rules, rng = Rules(obstacles=4, edges=20, seated=name == "m8"), Random(5)
    first, valid = Draft.of(gallery.scene(name)), 0
    for _ in range(150):
        draft = mutate(first, rng, rules)
        assert draft != first
        assert rules.allow(draft)
        try:
            draft.scene()
        except InvalidScene:
            continue
        valid += 1
        assert json.loads(draft.text())["obstacles"]
    assert valid > 40


def test_every_move_does_something_somewhere() -> None:
    rng, drafts = Random(1), [Draft.of(gallery.scene(name)) for name in ("figure2", "m8", "m14")]
    for move in MOVES:
        assert any(move(draft, rng) not in (None, draft) for draft in drafts for _ in range(9)), move


def test_rules_bound_what_is_tried() -> None:
    boxes, sweep = two_boxes(), Draft.of(gallery.scene("m20-3"))
    assert Rules(obstacles=2, least=2, edges=8).allow(boxes)
    for rules in (Rules(obstacles=1), Rules(least=3), Rules(edges=7), Rules(seated=True)):
        assert not rules.allow(boxes)
    assert Rules(strips=4).allow(sweep)
    assert not Rules(strips=3).allow(sweep)


def test_convex_searches_stay_convex() -> None:
    rng, rules = Random(3), Rules(convex=True)
    draft = two_boxes()
    for _ in range(60):
        draft = mutate(draft, rng, rules)
        assert all(is_convex(shape) for shape in draft.shapes)


@pytest.mark.parametrize(
    ("digits", "expected"), [(0, "12"), (1, "12.3"), (-1, "10"), (2, "12.35"), (3, "12.345")]
)
def test_rounding(digits: int, expected: str) -> None:
    assert rounded(rational("12.345"), digits) == rational(expected)
    assert rounded(rational("-0.5"), 0) == 0
    assert rounded(2.5, 0) == 3


# -- the referee ---------------------------------------------------------------------------------------


def test_the_referee_says_why_it_drops_a_draft() -> None:
    overlapping = Draft((box(0, 0), box(0, 0)), fmpq(1), start=(fmpq(-1), fmpq(0)))
    assert judged(is_short, overlapping).reason.startswith("invalid: ")

    def breaks(_: Case) -> Finding:
        raise AssertionError("planted")

    with Referee(breaks) as referee:
        assert referee.judge(two_boxes()).score == float("-inf")
        assert referee.dropped == {"fault": 1}
        assert referee.faults[0].reason == "fault: AssertionError: planted"


@by_night
def test_the_child_process_judges_alike_and_is_ended_when_slow() -> None:
    with Referee(is_short, limit=60) as child, Referee(is_short) as here:
        for draft in (two_boxes(), Draft((box(0, 0),), fmpq(1), start=(fmpq(0), fmpq(0)))):
            assert child.judge(draft) == here.judge(draft)

    begun = time.monotonic()
    with Referee(sleeps, limit=0.3) as referee:
        assert referee.judge(two_boxes()).reason == "too slow"
        assert referee.judge(Draft((box(0, 0),), fmpq(1), start=(fmpq(0), fmpq(0)))).score == 0.5
    assert time.monotonic() - begun < 20


@by_night
def test_a_draft_that_ends_the_process_is_a_fault() -> None:
    with Referee(dies, limit=60) as referee:
        assert referee.judge(two_boxes()).reason == "fault: 2 processes died, the last with exit status 7"
        assert referee.judge(Draft((box(0, 0),), fmpq(1), start=(fmpq(0), fmpq(0)))).score == 0.5
        assert referee.dropped == {"fault": 1}


def test_a_failure_without_a_ratio_beats_what_holds() -> None:
    fails = judged(lambda _: Finding(Outcome.FAILS), two_boxes())
    holds = judged(lambda _: Finding(Outcome.HOLDS), two_boxes())
    silent = judged(lambda _: Finding(Outcome.SILENT), two_boxes())
    assert (fails.score, holds.score, silent.score) == (BROKEN, 0.0, float("-inf"))
    assert (fails.speaks, silent.speaks, fails.fails) == (True, False, True)


# -- the local search ----------------------------------------------------------------------------------


def test_the_same_seed_finds_the_same_scene() -> None:
    first, again, other = (explore(is_short, seed, 8) for seed in (7, 7, 8))
    assert first.best == again.best
    assert first.best != other.best


def test_a_false_statement_is_found_broken_and_the_ratio_rises() -> None:
    begin = two_boxes()
    hunt = explore(is_short, 2, 20, begin)
    assert hunt.best is not None
    assert judged(is_short, begin).score < hunt.best.score
    one_box = Draft((box(0, 0),), fmpq(10), start=(fmpq(-1), fmpq(0)))
    planted = explore(visits_less_than_two, 1, 25, one_box)
    assert planted.best is not None
    assert planted.best.fails
    assert judged(visits_less_than_two, planted.best.draft) == planted.best


def test_improvements_are_told_in_order() -> None:
    scores: list[float] = []
    hunt = Search(
        Referee(is_short),
        Subject.SIGHTSEER,
        Rules(),
        1,
        two_boxes(),
        lambda ruling: scores.append(ruling.score),
    )
    hunt.run(Budget(15))
    assert scores == sorted(set(scores))
    assert len(scores) > 1


def test_a_failure_is_kept_although_floats_take_it_for_a_tie() -> None:
    """P beyond its bound by less than floats tell is the find, not a scene where both sides are equal."""
    hunt = Search(Referee(is_short), Subject.SIGHTSEER, Rules())
    rulings = [
        Ruling(two_boxes(), Finding(o, "", 1.0)) for o in (Outcome.HOLDS, Outcome.FAILS, Outcome.HOLDS)
    ]
    for ruling in rulings:
        hunt.note(ruling)
    assert hunt.best is rulings[1]


def test_a_search_begins_only_where_its_rules_allow() -> None:
    hunt = Search(Referee(is_short), Subject.SIGHTSEER, Rules(obstacles=1), 0, two_boxes())
    with pytest.raises(FormatError, match="rules"):
        hunt.run(Budget(5))


# -- shrinking -----------------------------------------------------------------------------------------


def test_shrinking_drops_what_is_superfluous_and_keeps_the_violation() -> None:
    far = xa.Polygon([("30.123", 30), ("31.77", 30), (31, "31.456")])
    bent = xa.Polygon([(0, 0), ("0.512", "-0.031"), (1, 0), (1, 1), (0, 1)])
    draft = Draft((bent, far, box(3, 0)), rational("10.123"), start=(rational("-1.077"), fmpq(0)))
    check = visits_less_than_two
    found = judged(check, draft)
    assert found.fails
    small = shrink(Referee(check), found, Budget(400), Rules(), 0.5)
    assert small.fails
    assert judged(check, small.draft) == small
    assert len(small.draft.shapes) == 2, "the third obstacle was not needed"
    assert small.draft.edges == 6
    assert small.draft.radius == 10
    assert small.draft.digits < draft.digits / 2
    again = shrink(Referee(check), small, Budget(400), Rules(), 0.5)
    assert again == small, "a local minimum"


def test_shrinking_keeps_its_share_of_the_ratio() -> None:
    draft = Draft((box(0, 0), box(fmpq(31, 10), 0, fmpq(27, 10))), fmpq(10), start=(fmpq(-1), fmpq(0)))
    found = judged(is_short, draft)
    assert not found.fails
    small = shrink(Referee(is_short), found, Budget(100), Rules(), 0.95)
    assert small.draft != draft
    assert small.score >= 0.95 * found.score


# -- goals ---------------------------------------------------------------------------------------------


def test_a_bound_is_a_goal_with_or_without_brackets() -> None:
    for name in ("(11)", "11"):
        finding = goal(name).check(Case(gallery.scene("m20-3")))
        assert (finding.outcome, round(finding.ratio, 6)) == (Outcome.FAILS, 1.042479)
    assert finding.detail == "P = 39.02 > 37.43"
    corrected = goal("11", corrected=True).check(Case(gallery.scene("m20-3")))
    assert corrected.outcome is Outcome.HOLDS
    assert goal("(4)").check(Case(gallery.scene("m20-3"))).detail == "visits = 3 > 2"


def test_the_sightseers_bounds_speak_of_model_a_only() -> None:
    far, seated = (Case(xa.Scene([box(0, 0)], start=(x, 0), radius=9)) for x in (-3, 0))
    assert goal("(1)").check(far).outcome is Outcome.SILENT, "a way to the first obstacle is not charged"
    assert goal("T1 corrected").check(far).detail == "P = 7 = 7"
    assert goal("(1)").check(seated).outcome is Outcome.HOLDS
    assert goal("(1)").check(Case(gallery.scene("m4"))).outcome is Outcome.SILENT
    assert goal("(1)").check(Case(xa.Scene(start=(0, 0), radius=1))).outcome is Outcome.SILENT


def test_every_claim_with_a_check_is_a_goal() -> None:
    from exactacq.study.claims import CLAIMS

    for claim in CLAIMS:
        if claim.printed.check is not None:
            assert goal(claim.name).statement is claim.printed
        else:
            with pytest.raises(FormatError, match="no scene decides"):
                goal(claim.name)
    assert {"(1)", "T2 corrected", CLAIMS[0].name} <= set(goal_names())


@pytest.mark.parametrize(
    ("name", "corrected", "message"),
    [
        ("T99", False, "no claim or bound 'T99'; there are"),
        ("(8)", True, "no corrected form"),
        ("", False, "no claim"),
    ],
)
def test_unknown_goals_are_refused(name: str, corrected: bool, message: str) -> None:
    with pytest.raises(FormatError, match=message.replace("(", r"\(")):
        goal(name, corrected)


def test_looking_for_a_start_is_counted_in_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search of two seconds looked at 2000 random scenes, half a minute, for one that it may begin with."""
    monkeypatch.setattr(annealing, "THROWS", 3)
    hunt = Search(Referee(is_short), Subject.SIGHTSEER, Rules(least=5))
    assert hunt.run(Budget(seconds=0)) is None
    with pytest.raises(FormatError, match="no random scene keeps"):
        hunt.run(Budget(seconds=60))


def test_what_was_found_is_kept_where_there_are_no_more_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error told of the last 2000 random scenes only, and threw the find away."""
    monkeypatch.setattr(annealing, "THROWS", 3)
    hunt = Search(Referee(is_short), Subject.SIGHTSEER, Rules(least=5), best=judged(is_short, two_boxes()))
    assert hunt.run(Budget(seconds=60)) is hunt.best


# -- hypothesis ----------------------------------------------------------------------------------------


def test_hypothesis_finds_what_is_broken() -> None:
    pytest.importorskip("hypothesis")
    hunt = Search(Referee(visits_less_than_two), Subject.SIGHTSEER, Rules(obstacles=3), 1)
    hypothesis_search(hunt, Budget(60))
    assert hunt.best is not None
    assert hunt.best.fails
    assert judged(visits_less_than_two, hunt.best.draft) == hunt.best


def test_hypothesis_ends_with_the_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    """Once the seconds were over it went on to draw all of its examples, a million."""
    pytest.importorskip("hypothesis")
    monkeypatch.setattr(hypothesis_home, "MOST_EXAMPLES", 20)
    asked: list[Budget] = []

    def spend(budget: Budget) -> bool:
        asked.append(budget)
        return False

    monkeypatch.setattr(Budget, "spend", spend)
    hypothesis_search(Search(Referee(is_short), Subject.SIGHTSEER, Rules(), 1), Budget(seconds=0))
    assert len(asked) == 1


def test_hypothesis_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "hypothesis", None)
    hunt = Search(Referee(is_short), Subject.SIGHTSEER, Rules(), 1)
    with pytest.raises(FormatError, match="hypothesis is not installed"):
        hypothesis_search(hunt, Budget(5))


# -- the command ---------------------------------------------------------------------------------------


def test_the_command_writes_what_it_found(tmp_path: Path) -> None:
    out, figure = tmp_path / "f.json", tmp_path / "f.svg"
    line = [
        "11",
        "--from",
        "m20-3",
        "--obstacles",
        "1",
        "--steps",
        "6",
        "--out",
        str(out),
        "--figure",
        str(figure),
    ]
    result = CliRunner().invoke(APP, line, catch_exceptions=False)
    assert result.exit_code == 0
    assert "BROKEN" in result.stdout
    assert "> 1 (exactly)" in result.stdout
    assert f"exactacq explore {out} --strategy seed-spreader" in " ".join(result.stdout.split())
    broken = {b.name: b.holds for b in xa.seed_spreader(xa.load(out)).bounds}
    assert broken["(11)"] is False
    assert figure.read_text().lstrip().startswith("<?xml")


def test_the_command_refuses_before_it_searches(tmp_path: Path) -> None:
    wrong = [
        (["nothing"], "no claim or bound"),
        (["(6)", "--strategy", "sightseer"], "speaks of the seed-spreader"),
        (["(6)", "--least", "5"], "--least: no scene has at least 5 and at most 4 obstacles"),
        (["(6)", "--out", str(tmp_path / "f.txt")], "must end in"),
    ]
    for line, message in wrong:
        result = CliRunner().invoke(APP, line)
        assert isinstance(result.exception, FormatError)
        assert message in str(result.exception)
    assert list(tmp_path.iterdir()) == []


# -- what was found ------------------------------------------------------------------------------------


def test_goals_may_be_made_by_hand() -> None:
    mine = Goal("mine", Statement("P <= 40", Subject.SIGHTSEER, is_short))
    assert mine.subject is Subject.SIGHTSEER
    assert mine.check(Case(two_boxes().scene())).outcome is Outcome.HOLDS


@pytest.mark.parametrize(
    ("name", "broken", "held", "bodies"),
    [
        ("tight-t1", ["(1)", "T1"], ["(2)", "T1 corrected"], 4),
        ("tight-l3", ["(4)", "L3"], ["(6)", "L3 corrected"], 1),
        ("tight-t2", ["(5)", "(6)", "T2"], ["T2 corrected"], 1),
        ("tight-t2-snake", ["(5)", "(6)", "T2"], ["T2 corrected"], 1),
        ("tight-sss2", ["SSS-2"], ["(6)"], 3),
        ("tight-sss5", ["SSS-5"], ["(6)"], 3),
        ("tight-sss5-fan", ["SSS-5"], ["(6)"], 7),
    ],
)
def test_the_finds_in_the_gallery(name: str, broken: list[str], held: list[str], bodies: int) -> None:
    scene = xa.load(GALLERY / f"{name}.json")
    case = Case(scene)
    assert scene.name == name
    assert {goal(g).check(case).outcome for g in broken} == {Outcome.FAILS}
    assert {goal(g).check(case).outcome for g in held} == {Outcome.HOLDS}
    run = case.sightseer if scene.terrain is None else case.spreader
    assert len(run.obstacles) == bodies


def test_diversions_can_be_one_less_than_obstacles() -> None:
    for name, count in (("tight-sss5", 2), ("tight-sss5-fan", 6)):
        scene = xa.load(GALLERY / f"{name}.json")
        assert all(is_convex(shape) for shape in scene.shapes)
        run = xa.seed_spreader(scene)
        targets = [d.obstacle for d in run.diversions]
        assert (len(targets), len(set(targets)), len(run.obstacles)) == (count, count, count + 1)


def test_a_bar_that_ends_outside_of_the_terrain_breaks_6_by_its_whole_perimeter() -> None:
    """The paper's p is the boundary's length; a run's is the shore's, which is 8 of the 40 of tight-t2."""
    whole = xa.load("tight-t2")
    east, slope = rational("4.01"), rational("0.4") / rational("19.8")
    bar = xa.Polygon([(0, "0.4"), ("0.2", "0.4"), (east, (20 - east) * slope), (east, (20 - east) / 50)])
    run = xa.seed_spreader(xa.Scene([bar], (0, 0), terrain=whole.terrain, radius=whole.radius))
    assert run.length == xa.seed_spreader(whole).length
    outside = run.scene.obstacles[0].perimeter - run.obstacles[0].perimeter
    values = {bound.name: bound.value for bound in run.bounds}
    assert all(run.length > values[name] + outside * 5 for name in ("(5)", "(6)"))  # 3 p + 2 n n_0 p_max


def test_the_tight_bars_are_convex_and_cross_few_strips() -> None:
    for name, strips in (("tight-l3", 3), ("tight-t2", 5), ("tight-t2-snake", 2)):
        scene = xa.load(GALLERY / f"{name}.json")
        assert (scene.terrain.width / scene.radius).ceil() == strips
        assert is_convex(scene.shapes[0]) == (name != "tight-t2-snake")
