"""How far long work is, told to whoever wants to know."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

Progress: TypeAlias = Callable[[int, int], None]
"""Called with what is done and the total, never with less than before, at last with the total."""


class Meter:
    """Counts steps of *total*, and calls a function, if there is one, after each of them."""

    def __init__(self, progress: Progress | None, total: int) -> None:
        self.progress, self.total, self.done = progress, max(total, 1), 0

    def add(self, count: int = 1) -> None:
        """More steps are done."""
        self._tell(min(self.done + count, self.total))

    def finish(self) -> None:
        """All is done, also what was left out."""
        self._tell(self.total)

    def _tell(self, done: int) -> None:
        if self.progress is not None and done > self.done:
            self.progress(done, self.total)
        self.done = done
