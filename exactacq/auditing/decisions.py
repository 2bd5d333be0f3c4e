"""The audit of decisions: what is told of a choice is true of the path, and of what was known by then.

That there was nothing better that is not told is not asked: of links and of what is about to be lost others
know more (`exactacq.auditing.seed_spreader`).
"""

from __future__ import annotations

from collections.abc import Collection
from itertools import pairwise
from typing import NoReturn

from exactacq.auditing.comparisons import BITS, agrees, ball_of, event_name
from exactacq.errors import AuditError
from exactacq.numbers.length import Length
from exactacq.sensing.decision import Candidate, Decision, Rule
from exactacq.sensing.event import Event, EventKind
from exactacq.strategies.run import Run, SightseerRun

RULES = {
    "sightseer": (Rule.NEAREST, Rule.BACK),
    "seed-spreader": (Rule.ABOUT_TO_BE_LOST, Rule.GO_ON),
}
"""By which rules the paper's strategies decide."""


def check_decisions(run: Run) -> None:
    """Decisions are made where their moves begin, and what they say of obstacles and lengths is so."""
    for number, event in enumerate(run.events):
        if event.decision is not None:
            _Told(run, number, event, event.decision).check()


class _Told:
    """A decision of a run, and what was known when it was made."""

    def __init__(self, run: Run, number: int, event: Event, decision: Decision) -> None:
        self.run, self.event, self.decision = run, event, decision
        self.later = run.events[number + 1 :]
        self.seen = self._before(EventKind.SIGHT)
        self.incomplete = self.seen - self._before(EventKind.ACQUIRE)

    def _before(self, kind: EventKind) -> set[int]:
        """The obstacles to which something had happened when the decision was made."""
        then = self.decision.after
        events = (e for e in self.run.events if e.kind is kind and e.after <= then)
        return {e.obstacle for e in events if e.obstacle is not None and not (e.inside and e.after == then)}

    def check(self) -> None:
        """What all decisions have in common, then what its rule says."""
        told, event = self.decision, self.event
        if told.rule not in RULES.get(self.run.strategy, Rule):
            self._refuse(f"is made by the rule {told.rule.value!r}, which the strategy does not have")
        walked = {piece.obstacle for piece in self.run.path[max(told.after, 0) : event.after]}
        if not 0 <= told.after <= event.after or not walked <= {event.obstacle} - {None}:
            self._refuse(f"is made after {told.after} pieces, not where its move begins")
        others = [other.obstacle for other in told.others]
        every = [k for k in (told.chosen, *others) if isinstance(k, int)]
        if not set(every) <= self.seen:
            self._refuse(f"names obstacles {sorted(set(every) - self.seen)}, which were not seen by then")
        if len(set(every)) < len(every):
            self._refuse("names an obstacle twice")
        if told.more and told.rule in (Rule.NEAREST, Rule.ABOUT_TO_BE_LOST):
            self._refuse(f"counts {told.more} more, by a rule that counts none")
        if told.rule is Rule.NEAREST:
            self._check_nearest()
        elif told.rule is Rule.BACK:
            self._check_back(others)
        elif told.rule is Rule.ABOUT_TO_BE_LOST:
            self._check_loss(every)
        elif told.rule is Rule.GO_ON:
            if (told.chosen, told.length, told.after) != (None, None, event.after):
                self._refuse("is to go on from here, and chooses nothing")
            self._same(others, self.incomplete, "incomplete")

    def _check_nearest(self) -> None:
        """The chosen one is reached in so long a way, and comes before all that are told; none is visited."""
        told = self.decision
        ranked = [self._chosen(), *told.others]
        for one, other in pairwise(ranked):
            self._check_order(one, other)
        if any(self._size(one) > self.run.radius for one in ranked):
            self._refuse("names a link that is longer than the radius")
        gone = {one.obstacle for one in ranked} & self._visited()
        if gone and isinstance(self.run, SightseerRun):
            self._refuse(f"names obstacles {sorted(gone)}, which were visited by then")
        size, after = self._size(ranked[0]), self.event.after
        way = [] if size.sign() == 0 else [piece.curve for piece in self.run.path[after : after + 1]]
        if way and not agrees(size, ball_of(way[0], BITS)):
            self._refuse(f"is for a link of {size.decimal(20)}..., but the robot goes another way")
        self._check_aim(EventKind.HIT)

    def _check_back(self, others: list[int]) -> None:
        told = self.decision
        self._check_aim(EventKind.BACKTRACK)
        if told.length != self.run.radius:
            self._refuse("does not tell the radius")
        if isinstance(self.run, SightseerRun):
            self._same(others, self.seen - self._visited(), "unvisited")

    def _check_loss(self, every: list[int]) -> None:
        if self.decision.chosen != self.event.obstacle:
            self._refuse(f"is for obstacle {self.decision.chosen}")
        if not set(every) <= self.incomplete:
            self._refuse(f"names obstacles {sorted(set(every) - self.incomplete)}, which were not incomplete")
        for other in self.decision.others:
            self._check_order(self._chosen(), other)

    def _chosen(self) -> Candidate:
        chosen = self.decision.chosen
        if not isinstance(chosen, int):
            self._refuse("chooses no obstacle")
        return Candidate(chosen, self.decision.length)

    def _check_order(self, one: Candidate, other: Candidate) -> None:
        """One is nearer than another, or as near and has the smaller number."""
        order = self._size(one).compare(self._size(other)) or one.obstacle - other.obstacle
        if order > 0:
            self._refuse(
                f"prefers obstacle {one.obstacle} to obstacle {other.obstacle}, which comes before it"
            )

    def _size(self, one: Candidate) -> Length:
        if one.length is None:
            self._refuse(f"tells no length of obstacle {one.obstacle}")
        return one.length

    def _visited(self) -> set[int]:
        """The obstacles that the Sightseer had circled: it does so when it hits them."""
        hits = (e for e in self.run.events if e.kind is EventKind.HIT and e.after < self.decision.after)
        return {e.obstacle for e in hits if e.obstacle is not None}

    def _check_aim(self, kind: EventKind) -> None:
        """The robot goes to the chosen one: its next move is of that kind, there."""
        aims = (e for e in self.later if e.kind in (EventKind.HIT, EventKind.BACKTRACK))
        kinds = ((e.kind, "S" if e.obstacle is None else e.obstacle) for e in aims)
        if (aim := next(kinds, None)) != (kind, self.decision.chosen):
            where = "stays" if aim is None else f"goes to {aim[1]} ({aim[0]})"
            self._refuse(f"is for a {kind} to {self.decision.chosen}, but the robot {where}")

    def _same(self, told: list[int], true: Collection[int], what: str) -> None:
        """Some of the obstacles of which it is true are told, and the number of the others."""
        more = self.decision.more
        if any(other.length is not None for other in self.decision.others):
            self._refuse("tells lengths of others, which were not compared")
        if not set(told) <= set(true) or len(told) + more != len(true):
            self._refuse(f"names obstacles {told} and {more} more as {what}, but {sorted(true)} were")

    def _refuse(self, flaw: str) -> NoReturn:
        raise AuditError(f"the decision at {event_name(self.run, self.event)} {flaw}")
