"""Simulated annealing with restarts over drafts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from math import exp, isinf
from random import Random
from time import monotonic

from exactacq.errors import FormatError
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import random_scene
from exactacq.study.search.drafts import Draft
from exactacq.study.search.moves import Rules, mutate
from exactacq.study.search.referee import Referee, Ruling

HOT, COLD = 0.05, 0.0005
"""Temperatures at the begin and the end of a round, as shares of the score."""
ROUND = 300
"""Steps of one round of annealing; then it starts again, every other time from the best."""
THROWS = 2000
"""Random scenes that are looked at before the search gives up for want of a start that keeps to the rules."""


@dataclass
class Budget:
    """How long a search may take: a number of candidates, seconds of the wall clock, or both."""

    steps: int | None = None
    seconds: float | None = None
    used: int = 0
    begun: float = field(default_factory=monotonic)

    @property
    def is_spent(self) -> bool:
        """Whether there is nothing left."""
        if self.steps is not None and self.used >= self.steps:
            return True
        return self.seconds is not None and monotonic() - self.begun >= self.seconds

    def spend(self) -> bool:
        """Count one candidate; False if there is nothing left."""
        if self.is_spent:
            return False
        self.used += 1
        return True


@dataclass
class Search:
    """A search for the highest score. It repeats itself for the same seed and number of steps.

    That is so as long as no candidate is dropped for its time. ``best`` is the best ruling so far,
    ``improved`` is told of each improvement.
    """

    referee: Referee
    subject: Subject
    rules: Rules
    seed: int = 0
    begin: Draft | None = None
    improved: Callable[[Ruling], None] | None = None
    best: Ruling | None = None

    def run(self, budget: Budget) -> Ruling | None:
        """Search until the budget is spent; the best ruling, None if no scene tried is spoken of."""
        rng = Random(self.seed)
        starts = self._starts(rng, budget)
        for number in _endless():
            again = number % 2 == 1 and self.best is not None
            first = self.best.draft if again and self.best is not None else next(starts, None)
            if first is None or not self._round(first, rng, budget):
                return self.best
        return self.best

    def note(self, ruling: Ruling) -> None:
        """Keep a ruling if it is the best so far."""
        if ruling.speaks and (self.best is None or ruling.rank > self.best.rank):
            self.best = ruling
            if self.improved is not None:
                self.improved(ruling)

    def _round(self, first: Draft, rng: Random, budget: Budget) -> bool:
        """One round of annealing; False if the budget is spent."""
        if not budget.spend():
            return False
        now = self.referee.judge(first)
        self.note(now)
        for step in range(ROUND):
            if not budget.spend():
                return False
            ruling = self.referee.judge(mutate(now.draft, rng, self.rules))
            self.note(ruling)
            heat = HOT * (COLD / HOT) ** (step / ROUND)
            if _accepts(now.score, ruling.score, heat, rng):
                now = ruling
        return True

    def _starts(self, rng: Random, budget: Budget) -> Iterator[Draft]:
        """While the budget lasts: the draft given, again and again, or random scenes that keep the rules."""
        if self.begin is not None:
            if not self.rules.allow(self.begin):
                raise FormatError("the scene to begin with does not keep to the search's own rules")
            while True:
                yield self.begin
        misses = 0
        while misses < THROWS:
            if budget.is_spent:
                return
            scene = random_scene(self.subject, int(rng.random() * 10**9))
            draft = None if scene.enclosure is not None else trimmed(Draft.of(scene), self.rules)
            if draft is not None and self.rules.allow(draft):
                misses = 0
                yield draft
            misses += 1
        if self.best is None:
            raise FormatError("no random scene keeps to the search's rules; give a scene to begin with")


def trimmed(draft: Draft, rules: Rules) -> Draft | None:
    """A draft with no more obstacles than the rules allow: the last ones go, but not the start's."""
    found: Draft | None = draft
    while found is not None and len(found.shapes) > rules.obstacles:
        last = len(found.shapes) - 1
        keep = found.seat is not None and found.seat.obstacle == last
        found = found.without(last - keep)
    return found


def _accepts(old: float, new: float, heat: float, rng: Random) -> bool:
    """Metropolis' rule; a draft that is dropped is taken only from another such."""
    chance = rng.random()
    if new >= old:
        return True
    return not isinf(new) and not isinf(old) and chance < exp((new - old) / (heat * (abs(old) + 0.1)))


def _endless() -> Iterable[int]:
    number = 0
    while True:
        yield number
        number += 1
