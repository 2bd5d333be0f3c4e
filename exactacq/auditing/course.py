"""How far an audit is, told to whoever wants to know."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import accumulate
from typing import TypeAlias

Progress: TypeAlias = Callable[[int, int], None]


class Course:
    """Counts the steps of an audit whose *parts*, one after the other, take at most so many steps each."""

    def __init__(self, progress: Progress | None, parts: Sequence[int]) -> None:
        self._progress, self._ends = progress, list(accumulate(parts))
        self._done, self._part = 0, 0

    def step(self) -> None:
        """A step of the present part is done."""
        self._tell(min(self._done + 1, self._ends[self._part]))

    def close(self) -> None:
        """The present part is done; the next one begins."""
        self._tell(self._ends[self._part])
        self._part += 1

    def _tell(self, done: int) -> None:
        if self._progress is not None and done > self._done:
            self._progress(done, self._ends[-1])
        self._done = done
