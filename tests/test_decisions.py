"""Why the robot goes on as it does: what decisions tell is so, in numbers and words, and lies are found."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from gallery_runs import gallery_run
from nightly import some
from strategies import degenerate_terrain
from test_laws_of_runs import run_of

import exactacq as xa
from exactacq.auditing.decisions import check_decisions
from exactacq.errors import AuditError, FormatError
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.output.report import console, run_report
from exactacq.sensing.decision import Candidate, Decision, Rule
from exactacq.sensing.event import Event, Reason
from exactacq.strategies.known_links import KnownLinks
from exactacq.strategies.seed_spreader.reasons import nearest_loss
from exactacq.study.claims.model import Case
from exactacq.study.random_scenes import Subject, random_scene
from exactacq.visibility.links import START

OLD = Path(__file__).parent / "data" / "runs"
TIED = xa.Scene(
    [xa.Circle((0, 5), 1), xa.Circle((5, 0), 1), xa.Circle((-7, 0), 1)], start=(0, 0), radius=6, name="tied"
)
"""Two discs at the distance 4 from the start, and one at 6."""


def decided(run: xa.Run) -> list[Event]:
    return [event for event in run.events if event.decision is not None]


def runs() -> list[xa.Run]:
    """Runs by the Sightseer, with ties in most of those on grids."""
    from random import Random

    grids = [run_of(degenerate_terrain(Random(seed))) for seed in some(range(24), 6)]
    scenes = [random_scene(Subject.SIGHTSEER, seed) for seed in some(range(12), 3)]
    names = ("figure2", "m4", "m8", "m9")
    return [*filter(None, grids), *map(xa.sightseer, scenes), *map(gallery_run, names)]


class TestSightseer:
    def test_all_moves_are_told(self) -> None:
        """Each way along a link begins with its decision; nothing else has one."""
        for run in runs():
            moves = [e for e in run.events if e.kind in ("hit", "backtrack")]
            assert [e.decision.rule for e in decided(run)] == [
                Rule.NEAREST if e.kind == "hit" else Rule.BACK for e in moves
            ]
            assert {e.kind for e in decided(run)} <= {"start", "leave", "backtrack"}

    def test_against_the_visibility_graph(self) -> None:
        """The chosen one and the others are the unvisited neighbours in order, and going back has none."""
        for run in runs():
            graph = xa.visibility_graph(run.scene.replace(start=run.start), run.radius)
            at: int | str = START
            for event in decided(run):
                decision, chart = event.decision, run.memory.after(event.decision.after)
                at = START if event.obstacle is None else event.obstacle
                visited = _visited(run, decision.after)
                links = [(graph[at][k]["weight"], k) for k in graph[at] if k not in visited and k != START]
                if decision.rule is Rule.BACK:
                    assert links == []
                    assert [c.obstacle for c in decision.others if c.obstacle in visited] == []
                    left = set(chart.seen) - visited
                    assert {c.obstacle for c in decision.others} <= left
                    assert len(decision.others) + decision.more == len(left)
                    assert decision.length == run.radius
                    continue
                links.sort(key=lambda link: link[1])
                links.sort(key=lambda link: link[0])
                told = [
                    (decision.length, decision.chosen),
                    *((c.length, c.obstacle) for c in decision.others),
                ]
                assert told == links[:3]
                assert {k for _, k in told} <= set(chart.seen) - visited

    def test_the_chosen_one_is_the_least(self) -> None:
        for event in (event for run in runs() for event in decided(run)):
            decision = event.decision
            if decision.rule is Rule.NEAREST:
                assert all(
                    other.length > decision.length
                    or (other.length == decision.length and other.obstacle > decision.chosen)
                    for other in decision.others
                )

    def test_a_tie(self) -> None:
        run = xa.sightseer(TIED)
        start = run.events[0]
        assert start.decision == Decision(
            "", 0, Length(4), (Candidate(1, Length(4)), Candidate(2, Length(6))), Rule.NEAREST, 0
        )
        assert start.decision.ties == (1,)
        assert start.why(["O1", "O2", "O3"]) == "O1 and O2 are equally near: 4; O1 has the smaller number"
        assert start.why().startswith("obstacle 0 and obstacle 1 are equally near")

    def test_another_rule_of_choice_is_not_called_nearest(self) -> None:
        run = Case(TIED).farthest
        assert {e.decision.rule for e in decided(run)} <= {Rule.BACK}

    def test_others_that_cannot_be_put_in_order(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The choice stands, and nobody says that there was no other."""
        run = xa.sightseer(TIED)

        def undecided(*_: object) -> list[object]:
            raise xa.Undecided("two links")

        monkeypatch.setattr(KnownLinks, "nearest_few", undecided)
        words = "nearest is obstacle 0: 4; which ones come next is undecided"
        assert run.events[0].why() == words
        again = xa.load_run(run.to_json())
        assert again.events[0].why() == words
        check_decisions(again)

    def test_the_others_are_looked_for_when_they_are_asked_for(self) -> None:
        run = xa.sightseer(TIED)
        late = [event for event in run.events if callable(event.decided)]
        returns = [event for event in run.events if event.kind == "backtrack"]
        assert len(late) == len(run.visits) + len(returns) and run == xa.sightseer(TIED)
        assert all(callable(event.decided) for event in late)
        assert isinstance(late[0].decision, Decision) and late[0].decided is late[0].decision


@cache
def sweeps() -> tuple[xa.Run, ...]:
    """Sweeps with diversions for one obstacle, and for the nearest of several."""
    scenes = [random_scene(Subject.SEED_SPREADER, seed) for seed in (41, 50)]
    return *map(xa.seed_spreader, scenes), *map(gallery_run, ("figure4", "case2", "case3", "m18"))


class TestSeedSpreader:
    def test_diversions_are_told_and_lead_to_the_nearest(self) -> None:
        several = 0
        for run in sweeps():
            diversions = [event for event in run.events if event.kind == "divert"]
            assert len(diversions) == len(run.diversions) > 0
            for event in diversions:
                decision, chart = event.decision, run.map_at(event)
                assert (decision.rule, decision.chosen) == (Rule.ABOUT_TO_BE_LOST, event.obstacle)
                told = [Candidate(decision.chosen, decision.length), *decision.others]
                assert {k for k, _ in told} <= set(chart.incomplete)
                assert all(
                    decision.length < other.length
                    or (decision.length == other.length and decision.chosen < other.obstacle)
                    for other in decision.others
                )
                several += len(decision.others)
                for k, length in told:
                    ends = [p for part in chart.known(k) for p in (part.start, part.end)]
                    assert min(xa.Segment(event.point, p).length for p in ends if p != event.point) >= length
        assert several >= 3

    def test_reasons_to_divert_now(self) -> None:
        words = {
            event.reason: event.why() for run in sweeps() for event in run.events if event.kind == "divert"
        }
        assert words[Reason.LINE_ENDS].endswith("; the line of the M-line ends")
        assert words[Reason.OUT_OF_SIGHT].endswith("; it goes out of sight")
        assert words[Reason.OUT_OF_REACH].endswith("; what is known of it goes out of reach")

    def test_going_on_is_told_where_it_goes_on(self) -> None:
        """The next piece is straight, unless nothing follows; and all that is incomplete is counted."""
        for run in sweeps():
            on = [event for event in decided(run) if event.decision.rule is Rule.GO_ON]
            assert on[0] is run.events[0]
            for event in on:
                chart = run.memory.after(event.after)
                assert run.path[event.after].kind == "straight"
                left = event.decision.others
                assert {k for k, _ in left} <= set(chart.incomplete)
                assert len(left) + event.decision.more == len(chart.incomplete)

    def test_a_tie(self) -> None:
        aims = {3: Point(1, 1), 1: Point(-1, 1), 2: Point(2, 0), 0: Point(0, 3)}
        decision = nearest_loss(1, aims, Point(0, 0))
        assert [k for k, _ in decision.others] == [3, 2, 0] and decision.ties == (3,)
        words = "obstacle 1 and obstacle 3 are equally near: 1.414; obstacle 1 has the smaller number"
        assert decision.describe() == words

    @pytest.mark.parametrize(
        ("rule", "changes", "words"),
        [
            (Rule.ABOUT_TO_BE_LOST, {"length": "5/2"}, "is not so far away"),
            (Rule.ABOUT_TO_BE_LOST, {"others": ((4, 9),)}, "obstacle 4 is not about to be lost"),
            (Rule.ABOUT_TO_BE_LOST, {"length": None}, "is not about to be lost"),
            (Rule.ABOUT_TO_BE_LOST, {"rule": Rule.OWN}, "which the strategy does not have"),
            (Rule.ABOUT_TO_BE_LOST, {"more": 1}, "counts 1 more"),
            (Rule.GO_ON, {"chosen": "S"}, "chooses nothing"),
            (Rule.GO_ON, {"others": ()}, "as incomplete"),
            (Rule.GO_ON, {"more": 1}, "as incomplete"),
        ],
    )
    def test_lies_are_found(self, rule: Rule, changes: dict[str, object], words: str) -> None:
        run = gallery_run("figure4")
        k = next(k for k, e in enumerate(run.events) if e.decision and e.decision.rule is rule)
        event = replace(run.events[k], decided=replace(run.events[k].decision, **changes))
        with pytest.raises(AuditError, match="the decision at event") as caught:
            xa.audit(replace(run, events=(*run.events[:k], event, *run.events[k + 1 :])), samples=0)
        assert words in str(caught.value)

    @pytest.mark.parametrize(
        ("changes", "words"),
        [
            ({"chosen": 4}, "is for obstacle 4"),
            ({"others": ((4, 1),)}, "prefers obstacle 2 to obstacle 4"),
            ({"others": ((0, 9),)}, "names obstacles [0], which were not incomplete"),
        ],
    )
    def test_lies_are_found_without_a_map(self, changes: dict[str, object], words: str) -> None:
        run = gallery_run("figure4")
        k = next(k for k, e in enumerate(run.events) if e.kind == "divert")
        event = replace(run.events[k], decided=replace(run.events[k].decision, **changes))
        with pytest.raises(AuditError) as caught:
            check_decisions(replace(run, events=(*run.events[:k], event, *run.events[k + 1 :])))
        assert words in str(caught.value)

    @pytest.mark.parametrize("lie", [lambda size: -size, lambda size: size + Length.turns(1)])
    def test_a_length_that_is_none(self, lie: Callable[[Length], Length]) -> None:
        """Of what is compared with a distance its square is, and without its angles."""
        run = gallery_run("figure4")
        k = next(k for k, e in enumerate(run.events) if e.kind == "divert")
        told = run.events[k].decision
        event = replace(run.events[k], decided=replace(told, length=lie(told.length), others=()))
        with pytest.raises(AuditError, match="is not so far away"):
            xa.audit(replace(run, events=(*run.events[:k], event, *run.events[k + 1 :])), samples=0)

    def test_honest_sweeps_pass(self) -> None:
        for run in sweeps()[:3]:
            xa.audit(run, samples=0)


def _visited(run: xa.Run, after: int) -> set[int]:
    """By the path: each obstacle whose perimeter was walked in one go before."""
    found = set()
    for k in range(len(run.obstacles)):
        walked = Length.sum(p.length for p in run.path[:after] if p.obstacle == k)
        if walked >= run.obstacles[k].perimeter:
            found.add(k)
    return found


class TestWords:
    NAMES = tuple(f"O{k + 1}" for k in range(9))

    @pytest.mark.parametrize(
        ("told", "sentence"),
        [
            ((4, 3, []), "only O5 is in reach: 3"),
            ((4, xa.Real(18).sqrt(), [(1, "7.571")]), "nearest is O5: 4.243 < 7.571 (O2)"),
            ((4, 3, [(1, 4), (0, 5), (7, 6)]), "nearest is O5: 3 < 4 (O2), 5 (O1), 6 (O8)"),
            ((2, 5, [(3, 5)]), "O3 and O4 are equally near: 5; O3 has the smaller number"),
            (
                (2, 5, [(3, 5), (8, 5), (0, 6)]),
                "O3, O4 and O9 are equally near: 5; O3 has the smallest number",
            ),
            ((0, 1, [(1, "1.00000003")]), "nearest is O1: 1 < 1.000000030000000 (O2)"),
            ((0, "1/3", [(1, xa.Real("1/9").sqrt() + xa.Real("1e-30"))]), None),
        ],
    )
    def test_of_the_nearest(self, told: tuple, sentence: str | None) -> None:
        chosen, length, others = told
        decision = Decision(chosen=chosen, length=length, others=others, rule="nearest")
        found = decision.describe(self.NAMES)
        if sentence is None:
            sentence = found
            one, other = found.removeprefix("nearest is O1: ").removesuffix(" (O2)").split(" < ")
            assert one != other
        assert found == sentence

    def test_of_going_back(self) -> None:
        back = Decision(chosen="S", length="21/2", others=[2, 3, 4], more=1, rule="back")
        words = "back to S: no link of at most 10.5 leads from here to O3, O4, O5 or 1 more"
        assert back.describe(self.NAMES) == words
        assert replace(back, others=(Candidate(2),), more=0).describe().endswith("to obstacle 2")

    def test_of_losses(self) -> None:
        loss = Decision(chosen=4, length=2, rule="about to be lost")
        assert loss.describe(self.NAMES) == "only O5 is about to be lost, 2 away"
        more = replace(loss, others=((1, 3), (2, 4), (3, 5), (5, 6)))
        words = "nearest of what is about to be lost is O5: 2 < 3 (O2), 4 (O3), 5 (O4) and 1 more"
        assert more.describe(self.NAMES) == words

    def test_of_going_on(self) -> None:
        on = Decision(rule="go on")
        assert on.describe() == "on along the M-line: nothing is about to be lost"
        assert replace(on, others=(0, 1)).describe(self.NAMES).endswith("; incomplete: O1 and O2")

    @pytest.mark.parametrize(
        "make",
        [
            lambda: Decision(3),
            lambda: Decision(chosen="T"),
            lambda: Decision(chosen=True),
            lambda: Decision(chosen=1.5),
            lambda: Decision(others=["S"]),
            lambda: Decision(more=-1),
            lambda: Decision(more=0.5),
            lambda: Decision(length="wide"),
            lambda: Decision(others=[(0, "wide")]),
            lambda: Decision(others=3),
            lambda: Decision(others=[(0, 1, 2)]),
            lambda: Decision(others=[()]),
            lambda: Decision("why", others=[7]).numbered([0], 0),
            lambda: Decision("why", chosen=-1).numbered([0], 0),
        ],
    )
    def test_what_is_no_decision(self, make: Callable[[], object]) -> None:
        with pytest.raises(FormatError) as caught:
            make()
        assert "\n" not in str(caught.value)

    def test_in_reports_and_tables(self) -> None:
        run = xa.sightseer(TIED)
        words = "O1 and O2 are equally near: 4; O1 has the smaller number"
        out = console()
        with out.capture() as shown:
            out.print(run_report(run))
        assert words in shown.get() and " why" in shown.get()
        assert run.event_table[0]["why"] == words and run.event_table[-1]["why"] == ""
        assert words in run.event_table._repr_html_()
        assert "obstacle 0 and obstacle 1 are equally near: 4" in run.events[0]._repr_html_()

    def test_in_html_all_is_text(self) -> None:
        event = replace(xa.sightseer(TIED).events[0], decided=Decision("<script>", chosen=0))
        assert "<script>" not in event._repr_html_() and "&lt;script&gt;" in event._repr_html_()


def talking(robot: xa.Robot) -> None:
    """A strategy that says why it moves: in free space, at a boundary, along it, and along a link."""
    robot.go_to((1, 0), reason="a look aside")
    robot.go_to((2, 0), reason=xa.Decision("the wider gap", chosen=0, length="7/2"))
    robot.go_to((0, 0))
    robot.take(robot.nearest_unvisited(None))
    robot.walk("left", until="acquire", reason="to see\nall of it")
    robot.circle(reason=xa.Decision("to be sure", length=xa.Length.turns(1), chosen=0))
    robot.take(robot.nearest_unvisited(robot.at), reason="for a change")
    robot.circle()


class TestOwn:
    SCENE = xa.load("circles")

    def test_reasons_are_told_where_moves_begin(self) -> None:
        run = xa.explore(self.SCENE, talking)
        told = [(e.kind.value, e.obstacle, e.why(list(run.names()))) for e in decided(run)]
        assert told == [
            ("start", None, "a look aside"),
            ("decide", None, "the wider gap (O1: 3.5)"),
            ("decide", None, "only O1 is in reach: 3"),
            ("hit", 0, "to see all of it"),
            ("decide", 0, "to be sure (O1: 6.283)"),
            ("leave", 0, "for a change"),
        ]
        xa.audit(run, samples=4)

    def test_round_trip(self) -> None:
        run = xa.explore(self.SCENE, talking)
        again = xa.load_run(json.loads(json.dumps(run.to_json())))
        assert [e.decision for e in again.events] == [e.decision for e in run.events]
        assert again.to_json() == run.to_json()

    def test_a_function_is_called_when_its_reason_is_read(self) -> None:
        asked = []

        def why() -> Decision:
            asked.append(len(asked))
            return Decision("for later", chosen=1)

        def go(robot: xa.Robot) -> None:
            robot.go_to((0, 1), reason=why)
            robot.go_to((0, 0), reason=lambda: "and back")

        run = xa.explore(TIED, go)
        assert asked == []
        start, *others = [event for event in run.events if event.decided]
        assert start.decision == Decision("for later", chosen=1) and start.why() == "for later"
        assert [other.why() for other in others] == ["and back"]
        assert asked == [0]

    def test_on_routes(self) -> None:
        """Where a piece begins, along a boundary and from it on, and not where no way is made."""

        def sweep(robot: xa.Robot) -> None:
            route = robot.lay([(0, 0), (20, 0)])
            robot.follow(route, reason="to the east")
            robot.follow(route, reason="no way")
            robot.circle()
            place = next(robot.exits(route, 0))
            robot.take_up(route, place, reason=xa.Decision("around it", chosen=0, length=xa.Length.turns(1)))
            with pytest.raises(xa.MoveError):
                robot.take_up(route, place, reason="not ahead")
            with pytest.raises(FormatError):
                robot.follow(route, reason=xa.Decision(chosen=7))
            robot.follow(route, watch=lambda _: robot.position, reason="no step")
            robot.follow(route, reason="on")

        scene = xa.Scene([xa.Circle((5, 0), 2)], start=(0, 0), radius=20)
        run = xa.explore(scene, sweep)
        assert [(e.kind.value, e.after, e.why()) for e in decided(run)] == [
            ("start", 0, "to the east"),
            ("decide", 2, "around it (obstacle 0: 6.283)"),
            ("leave", 3, "on"),
        ]
        xa.audit(run, samples=4)

    def test_a_walk_to_where_the_robot_is_tells_nothing(self) -> None:
        def still(robot: xa.Robot) -> None:
            robot.go_to((5, 0))
            robot.circle()
            robot.walk_to(robot.position, reason="here already")
            with pytest.raises(xa.MoveError):
                robot.walk_to((0, 0), reason="no such point")

        assert decided(xa.explore(self.SCENE, still)) == []

    def test_a_link_taken_later_was_not_decided_now(self) -> None:
        def slow(robot: xa.Robot) -> None:
            link = robot.nearest_unvisited(None)
            robot.go_to((1, 0))
            robot.go_to((0, 0))
            robot.take(link)

        assert decided(xa.explore(self.SCENE, slow)) == []

    def test_moves_without_a_way_tell_nothing(self) -> None:
        def still(robot: xa.Robot) -> None:
            robot.go_to((0, 0), reason="no reason")
            robot.take(robot.nearest_unvisited(None))
            robot.circle()
            with pytest.raises(xa.MoveError):
                robot.walk_to((0, 0), reason="no such point")
            robot.walk("left", to=robot.position, reason="here already")

        run = xa.explore(self.SCENE, still)
        assert [e.why() for e in decided(run)] == ["only obstacle 0 is in reach: 3"]

    def test_reasons_name_what_was_seen(self) -> None:
        for reason in (3, xa.Decision("why", chosen=1)):
            with pytest.raises(FormatError):
                xa.Robot(xa.Scene(self.SCENE.shapes, start=(0, 0), radius=4)).go_to((1, 0), reason=reason)

    def test_numbers_become_those_of_the_scene(self) -> None:
        """The robot sees the second disc first."""
        scene = xa.Scene([xa.Circle((20, 0), 1), xa.Circle((4, 0), 1)], start=(0, 0), radius=5)

        def go(robot: xa.Robot) -> None:
            robot.go_to((1, 0), reason=xa.Decision("there", chosen=0, length=2))

        assert xa.explore(scene, go).events[0].decision.chosen in (0, 1)
        assert xa.explore(scene, go).events[0].why() == "there (obstacle 1: 2)"


class TestFiles:
    @pytest.mark.parametrize("name", ["figure2", "m8", "m9", "case2", "figure4"])
    def test_round_trip(self, name: str) -> None:
        run = gallery_run(name)
        document = json.loads(json.dumps(run.to_json()))
        again = xa.load_run(document)
        assert [e.decision for e in again.events] == [e.decision for e in run.events]
        copied = pickle.loads(pickle.dumps(xa.sightseer(TIED)))
        assert copied.events[0].decision == xa.sightseer(TIED).events[0].decision
        check_decisions(again)

    @pytest.mark.parametrize("path", sorted(OLD.glob("version[2-4]-*.json")), ids=lambda path: path.stem)
    def test_files_of_before_tell_none(self, path: Path) -> None:
        run = xa.load_run(path)
        assert decided(run) == [] and all(event.why() == "" for event in run.events)

    def test_a_length_without_an_exact_form_is_told_as_a_decimal(self) -> None:
        run = xa.sightseer(TIED)
        event = replace(run.events[0], decided=Decision("why", length=xa.Length.turns(1, "1/7")))
        (told, *_) = replace(run, events=(event, *run.events[1:])).to_json()["events"]
        assert told["decision"]["length"] == {"algebraic": "0", "pi": "2/7", "angles": []}
        assert told["decision"]["length_decimal"].startswith("0.897597901025655")

    @pytest.mark.parametrize(
        "change",
        [
            {"rule": "whim"},
            {"after": 99},
            {"after": -1},
            {"chosen": 99},
            {"others": [{"obstacle": 99}]},
            {"others": [{}]},
            {"length": "x"},
            {"length": {"pi": "1"}},
            {"length": {"algebraic": "0", "pi": "0", "angles": [["1", "2", "0"]]}},
            {"because": 3},
            {"more": "x"},
        ],
    )
    def test_damage_is_one_clear_error(self, change: dict[str, object]) -> None:
        document = xa.sightseer(TIED).to_json()
        document["events"][0]["decision"].update(change)
        with pytest.raises(FormatError) as caught:
            xa.load_run(document)
        assert "\n" not in str(caught.value)


def lying(number: int, **changes: object) -> xa.Run:
    """The run among the discs, one of whose decisions says something else."""
    run = xa.sightseer(TIED)
    k = next(k for k, e in enumerate(run.events) if e is decided(run)[number])
    event = replace(run.events[k], decided=replace(run.events[k].decision, **changes))
    return replace(run, events=(*run.events[:k], event, *run.events[k + 1 :]))


class TestLies:
    """Decisions: 0 at the start, 1 to the second disc, then back."""

    @pytest.mark.parametrize(
        ("number", "changes", "words"),
        [
            (0, {"chosen": 1, "others": ((0, 4),)}, "prefers obstacle 1 to obstacle 0"),
            (0, {"length": "4.0000000000000001"}, "prefers obstacle 0 to obstacle 1"),
            (0, {"length": 4 - xa.Real("1e-50")}, "but the robot goes another way"),
            (0, {"others": ((1, "3.9"),)}, "prefers obstacle 0 to obstacle 1"),
            (0, {"others": ((1, "6.1"),)}, "longer than the radius"),
            (0, {"others": ((1, None),)}, "tells no length of obstacle 1"),
            (0, {"others": ((0, 4),)}, "names an obstacle twice"),
            (0, {"chosen": None}, "chooses no obstacle"),
            (0, {"chosen": "S"}, "chooses no obstacle"),
            (0, {"after": 1}, "not where its move begins"),
            (1, {"after": 0}, "not where its move begins"),
            (1, {"others": ((0, "5.9"),)}, "were visited by then"),
            (0, {"rule": Rule.BACK}, "is for a backtrack"),
            (0, {"rule": Rule.OWN}, "which the strategy does not have"),
            (0, {"more": 1}, "counts 1 more"),
        ],
    )
    def test_are_found(self, number: int, changes: dict[str, object], words: str) -> None:
        run = lying(number, **changes)
        with pytest.raises(AuditError, match="the decision at event") as caught:
            xa.audit(run, samples=0)
        assert words in str(caught.value)

    @pytest.mark.parametrize(
        ("changes", "words"),
        [
            ({"chosen": 0, "others": ()}, "for a backtrack to 0"),
            ({"others": ((2, 9),)}, "tells lengths of others"),
            ({"length": 9}, "the radius"),
            ({"others": (1,)}, "as unvisited"),
            ({"others": ()}, "as unvisited"),
            ({"more": 1}, "as unvisited"),
        ],
    )
    def test_of_going_back(self, changes: dict[str, object], words: str) -> None:
        run = gallery_run("m4")
        k = next(k for k, e in enumerate(run.events) if e.decision and e.decision.chosen == "S")
        event = replace(run.events[k], decided=replace(run.events[k].decision, **changes))
        with pytest.raises(AuditError) as caught:
            check_decisions(replace(run, events=(*run.events[:k], event, *run.events[k + 1 :])))
        assert words in str(caught.value)

    def test_of_another_move(self) -> None:
        """The robot goes back where it says that it goes on, to what it comes to later; and on, not back."""
        run = xa.sightseer(xa.Scene([xa.Circle((x, 0), 1) for x in (4, -4, 9)], start=(0, 0)), 5)
        told = [event for event in decided(run) if event.kind != "start"]
        assert [event.decision.chosen for event in told] == [2, 0, "S", 1]
        lies = {
            2: {"rule": Rule.NEAREST, "chosen": 1, "length": Length(3), "others": ()},
            3: {"rule": Rule.BACK, "chosen": "S", "length": Length(5), "others": ((1, None),)},
        }
        for n, lie in lies.items():
            k = next(k for k, event in enumerate(run.events) if event is told[n])
            event = replace(run.events[k], decided=replace(told[n].decision, **lie))
            with pytest.raises(AuditError, match="but the robot goes to"):
                check_decisions(replace(run, events=(*run.events[:k], event, *run.events[k + 1 :])))

    def test_what_was_not_seen_by_then(self) -> None:
        run = gallery_run("m8")
        assert run.events[0].decision.rule is Rule.NEAREST
        unseen = next(e.obstacle for e in run.events if e.kind == "sight" and e.after > 0)
        other = Candidate(unseen, Length("7/2"))
        event = replace(run.events[0], decided=replace(run.events[0].decision, others=(other,)))
        with pytest.raises(AuditError, match="were not seen by then"):
            check_decisions(replace(run, events=(event, *run.events[1:])))

    def test_honest_runs_pass(self) -> None:
        for run in runs():
            check_decisions(run)
