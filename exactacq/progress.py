"""How far long work is, told to whoever wants to know."""

from __future__ import annotations

from collections.abc import Callable
from itertools import accumulate
from typing import TypeAlias

Progress: TypeAlias = Callable[[int, int], None]
"""Called with the number of steps done, which grows, and of all, which stays; at last with all of them."""


class Meter:
    """Counts the steps of work whose *parts*, one after the other, take at most so many steps each, and calls
    a function, if there is one, as they are done."""

    def __init__(self, progress: Progress | None, *parts: int) -> None:
        self._progress, self._ends = progress, [max(end, 1) for end in accumulate(parts)]
        self._done, self._part = 0, 0

    def add(self, count: int = 1) -> None:
        """More steps of the present part are done."""
        self._tell(min(self._done + count, self._ends[self._part]))

    def close(self) -> None:
        """The present part is done, also what was left out of it; the next one begins."""
        self._tell(self._ends[self._part])
        self._part += 1

    def _tell(self, done: int) -> None:
        if self._progress is not None and done > self._done:
            self._progress(done, self._ends[-1])
        self._done = done
