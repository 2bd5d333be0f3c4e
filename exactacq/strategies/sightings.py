"""What a robot saw on its way, obstacles by its own numbers: taken in when somebody asks."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from itertools import islice

from exactacq.sensing.event import EventKind
from exactacq.sensing.memory import Report
from exactacq.strategies.known_map import Sighting
from exactacq.strategies.numbering import Numbering
from exactacq.strategies.walker import Walker
from exactacq.visibility.links import Node


class Sightings:
    """The sightings of a *walker* in order, what is in sight and not wholly known, and the *numbers*.

    All that is asked senses first what was walked since: `Undecided` as `Walker.sense`.
    """

    def __init__(self, walker: Walker, numbers: Numbering) -> None:
        self._walker, self._numbers = walker, numbers
        self._every: list[Sighting] = []
        self._in_sight: set[int] = set()
        self._incomplete: set[int] = set()
        # With which sighting each obstacle was first seen.
        self._first: list[int] = []
        # While it is held nothing is taken in.
        self.is_held = False
        # Is told of each report that is taken in.
        self.hear: Callable[[Report], None] = lambda report: None

    @property
    def every(self) -> list[Sighting]:
        """All of them so far."""
        self.take_in()
        return self._every

    @property
    def numbers(self) -> Numbering:
        """The numbers of all obstacles seen so far."""
        self.take_in()
        return self._numbers

    @property
    def in_sight(self) -> set[int]:
        """The obstacles in sight, but for those that are wholly known."""
        self.take_in()
        return self._in_sight

    @property
    def incomplete(self) -> set[int]:
        """The obstacles of which some, but not all, is known."""
        self.take_in()
        return self._incomplete

    def own(self, node: Node) -> int | None:
        """The robot's number of an obstacle that it has seen; None for the start."""
        return self.numbers.own[node] if isinstance(node, int) else None

    def unvisited_after(self, pieces: int, visits: int) -> tuple[int, ...]:
        """The obstacles seen after so many pieces of the path that were not among the first visits."""
        numbers, count = self.numbers, self._walker.memory.report_count(pieces)
        visited = {numbers.own[k] for k in islice(self._walker.visited, visits)}
        return tuple(i for i in range(bisect_left(self._first, count)) if i not in visited)

    def take_in(self) -> None:
        """Number what came into sight since the last time, and tell of it."""
        walker = self._walker
        if self.is_held or len(self._every) == len(walker.memory.reports):
            return
        with walker.sensing:
            for report in walker.memory.reports[len(self._every) :]:
                number = self._numbers.add(report.obstacle)
                if number == len(self._first):
                    self._first.append(len(self._every))
                self._add(Sighting(report.kind, number, report.place, report.reason))
                self.hear(report)

    def _add(self, seen: Sighting) -> None:
        if seen.kind in (EventKind.SIGHT, EventKind.REGAIN):
            self._in_sight.add(seen.obstacle)
            self._incomplete.add(seen.obstacle)
        else:
            self._in_sight.discard(seen.obstacle)
            if seen.kind is EventKind.ACQUIRE:
                self._incomplete.discard(seen.obstacle)
        self._every.append(seen)
