"""The trace: what a robot does, written down where it does it, and with what it saw the events of a run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from typing import Any

from exactacq.errors import Undecided
from exactacq.sensing.decision import Decision
from exactacq.sensing.event import Ending, Event, EventKind
from exactacq.sensing.path import Path
from exactacq.strategies.walker import Walker


class Trace:
    """What a *walker* at its start does from now on."""

    def __init__(self, walker: Walker) -> None:
        self._walker = walker
        # After how many pieces each event happened; events know the path, which goes on.
        self._marks: list[tuple[int, partial[Event]]] = []
        self.mark(EventKind.START, None)

    def mark(self, kind: EventKind, obstacle: int | None, **why: Any) -> None:
        """Write an event here and now; *why* are its occasion, other, reason, ending and what is decided (see
        `Event`)."""
        self._marks.append(self._here(kind, obstacle, **why))

    def _here(self, kind: EventKind, obstacle: int | None, **why: Any) -> tuple[int, partial[Event]]:
        walker = self._walker
        return walker.count, partial(Event, kind, walker.position, obstacle, walker.count, **why)

    def explain(self, decided: Decision | Callable[[], Decision]) -> bool:
        """Tell the decision on what follows the event that was written last, if that happened here.

        One that has a decision keeps it.
        """
        after, mark = self._marks[-1]
        if after != self._walker.count or mark.keywords.get("decided") is not None:
            return False
        self._marks[-1] = after, partial(mark, decided=decided)
        return True

    def count(self, kind: EventKind) -> int:
        """How many events of a kind were written."""
        return sum(mark.args[0] is kind for _, mark in self._marks)

    def give_up(self, error: Undecided) -> Undecided:
        """End the trace where the last piece ends that could be sensed; the error that came first on the way.

        The path ends there too. To do so again changes nothing.
        """
        walker = self._walker
        with suppress(Undecided):
            walker.sense()
        at = walker.pieces[-1].obstacle if walker.pieces else None
        kept = [mark for mark in self._marks if mark[0] <= walker.count and mark[1].args[0] != EventKind.STOP]
        self._marks = [*kept, self._here(EventKind.STOP, at, ending=Ending.UNDECIDED)]
        return walker.undecided or error

    def events(self, path: Path) -> tuple[Event, ...]:
        """The events on the whole path, sensed ones among them; `Undecided` as `Walker.sense`."""
        return tuple(self._in_order(path))

    def _in_order(self, path: Path) -> Iterator[Event]:
        """What the robot did, and before each of it what it had seen by then."""
        memory, told = self._walker.memory, 0
        for number, (after, mark) in enumerate(self._marks):
            # It had not looked around yet when it was put at the start.
            seen = memory.report_count(after) if number else 0
            yield from (report.event(path) for report in memory.reports[told:seen])
            yield mark(path=path)
            told = seen
        yield from (report.event(path) for report in memory.reports[told:])
