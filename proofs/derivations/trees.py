"""Depth-first walks over trees of obstacles, counted one by one: the ground of Lemmas 1 and 2.

Obstacles are numbered in the order of their first visits; obstacle 0 is the one reached from the start.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product


@dataclass(frozen=True)
class Walk:
    """A depth-first walk that ends with the last first visit.

    ``stops`` are the obstacles in the order of arrival, the first ``0``. ``turns`` tells for every arrival
    but the last whether the robot walks along the boundary before it leaves: not at a leaf, which it leaves
    where it came.
    """

    parents: tuple[int, ...]
    stops: tuple[int, ...]
    turns: tuple[bool, ...]

    @property
    def count(self) -> int:
        """The number n of obstacles."""
        return len(self.parents) + 1

    @property
    def traversals(self) -> dict[tuple[int, int], int]:
        """How often each link of the tree is walked."""
        found = {(parent, child): 0 for child, parent in enumerate(self.parents, 1)}
        for one, other in zip(self.stops, self.stops[1:], strict=False):
            found[min(one, other), max(one, other)] += 1
        return found

    @property
    def returns(self) -> list[int]:
        """The obstacles of all arrivals that are not first visits."""
        seen: set[int] = set()
        again = []
        for stop in self.stops:
            again += [stop] if stop in seen else []
            seen.add(stop)
        return again


def walks(count: int) -> Iterator[Walk]:
    """Every depth-first walk over *count* obstacles, one for each ordered tree. Grows like 4^count."""
    for parents in product(*(range(child) for child in range(1, count))):
        walk = _walk(parents)
        if walk is not None:
            yield walk


def _walk(parents: tuple[int, ...]) -> Walk | None:
    """The walk that visits the children in the order of their numbers; None if those are out of order."""
    stops, turns, stack = [0], [], [0]
    for child, parent in enumerate(parents, 1):
        if parent not in stack:
            return None
        while stack[-1] != parent:
            leaf = stack.pop()
            turns.append(leaf in parents[: child - 1])
            stops.append(stack[-1])
        turns.append(True)
        stops.append(child)
        stack.append(child)
    return Walk(parents, tuple(stops), tuple(turns))
