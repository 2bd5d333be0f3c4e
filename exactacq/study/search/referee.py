"""Judges drafts: the exact verdict on each, within a time limit, in a process of its own."""

from __future__ import annotations

import multiprocessing
import signal
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from math import isnan
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from types import TracebackType

from exactacq.errors import InvalidScene, Undecided
from exactacq.study.claims.model import Case, Finding, Outcome
from exactacq.study.search.drafts import Draft

BROKEN = 2.0
"""The score of a failure that has no ratio: above that of any case that holds."""
JUDGED = 400
"""Drafts that one process judges before a fresh one takes over: what they intern is given back."""


@dataclass(frozen=True)
class Ruling:
    """What came of a draft. Without a finding, ``reason`` says why it was dropped.

    ``score`` steers the search: the ratio, or `BROKEN` for a failure without one, else 0.
    """

    draft: Draft
    finding: Finding | None
    reason: str = ""

    @property
    def speaks(self) -> bool:
        """Whether the statement speaks of this scene."""
        return self.finding is not None and self.finding.outcome is not Outcome.SILENT

    @property
    def fails(self) -> bool:
        """Whether the scene breaks the statement."""
        return self.finding is not None and self.finding.outcome is Outcome.FAILS

    @property
    def score(self) -> float:
        """How good a find it is; minus infinity for a draft that was dropped or is not spoken of."""
        if self.finding is None or not self.speaks:
            return float("-inf")
        if self.finding.ratio is None or isnan(self.finding.ratio):
            return BROKEN if self.fails else 0.0
        return self.finding.ratio


Check = Callable[[Case], Finding]


class Referee:
    """Decides drafts by a statement's check.

    With a *limit* in seconds each draft is judged in a child process, which is ended where it takes longer;
    where processes cannot be forked there is no limit. ``dropped`` counts why drafts were dropped;
    ``faults`` keeps those on which the library itself failed. To be closed, or used in a with statement.
    """

    def __init__(self, check: Check, limit: float | None = None) -> None:
        self.check = check
        self.limit = limit if "fork" in multiprocessing.get_all_start_methods() else None
        self.judged = 0
        self.dropped: Counter[str] = Counter()
        self.faults: list[Ruling] = []
        self._worker: BaseProcess | None = None
        self._line: Connection | None = None
        self._since = 0

    def __enter__(self) -> Referee:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def judge(self, draft: Draft) -> Ruling:
        """The exact verdict on a draft."""
        self.judged += 1
        ruling = judged(self.check, draft) if self.limit is None else self._sent(draft)
        if ruling.finding is None:
            kind = ruling.reason.partition(":")[0]
            self.dropped[kind] += 1
            if kind == "fault":
                self.faults.append(ruling)
        return ruling

    def close(self) -> None:
        """End the child process."""
        if self._worker is not None:
            self._worker.kill()
            self._worker.join()
            self._worker = None
        if self._line is not None:
            self._line.close()
            self._line = None

    def _sent(self, draft: Draft) -> Ruling:
        if self._since >= JUDGED:
            self.close()
        line = self._line or self._started()
        self._since += 1
        try:
            line.send(draft)
            if line.poll(self.limit):
                finding, reason = line.recv()
                return Ruling(draft, finding, reason)
            reason = "too slow"
        except (EOFError, OSError):
            reason = "fault: the process that judged it died"
        self.close()
        return Ruling(draft, None, reason)

    def _started(self) -> Connection:
        context = multiprocessing.get_context("fork")
        self._line, end = context.Pipe()
        self._worker = context.Process(target=_serve, args=(end, self.check), daemon=True)
        with warnings.catch_warnings():
            # Newer Pythons warn of threads at a fork; the child only computes, and is ended with the search.
            warnings.simplefilter("ignore", DeprecationWarning)
            self._worker.start()
        end.close()
        self._since = 0
        return self._line


def judged(check: Check, draft: Draft) -> Ruling:
    """The verdict on a draft, here and now. Any error of the library itself is a "fault"."""
    try:
        return Ruling(draft, check(Case(draft.scene())))
    except InvalidScene as error:
        return Ruling(draft, None, f"invalid: {error}")
    except Undecided as error:
        return Ruling(draft, None, f"undecided: {error}")
    except Exception as error:
        return Ruling(draft, None, f"fault: {type(error).__name__}: {error}")


def _serve(line: Connection, check: Check) -> None:
    """Judge drafts until the line is closed. Control-C is left to the parent, which ends this process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    while True:
        try:
            draft = line.recv()
        except EOFError:
            return
        ruling = judged(check, draft)
        line.send((ruling.finding, ruling.reason))
