"""Judges drafts: the exact verdict on each, within a time limit, in a process of its own."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import isnan
from types import TracebackType

from exactacq.errors import InvalidScene, Undecided
from exactacq.study.claims.model import Case, Finding, Outcome
from exactacq.study.processes import Lost, Team
from exactacq.study.search.drafts import Draft

BROKEN = 2.0
"""The score of a failure that has no ratio: above that of any case that holds."""


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

    @property
    def rank(self) -> tuple[bool, float]:
        """What is the better find: a failure is, even if floats take its ratio for that of one that holds."""
        return self.fails, self.score


Check = Callable[[Case], Finding]


class Referee:
    """Decides drafts by a statement's check.

    With a *limit* in seconds each draft is judged in a process of its own, which is killed where it takes
    longer; the check must then be what pickle takes. ``dropped`` counts why drafts were dropped; ``faults``
    keeps those on which the library itself failed. To be closed, or used in a with statement.
    """

    def __init__(self, check: Check, limit: float | None = None) -> None:
        self.check = check
        self.limit = limit
        self.judged = 0
        self.dropped: Counter[str] = Counter()
        self.faults: list[Ruling] = []
        self._team = None if limit is None else Team(partial(_judge, check), 1, limit)

    def __enter__(self) -> Referee:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the process that judges."""
        if self._team is not None:
            self._team.close()

    def judge(self, draft: Draft) -> Ruling:
        """The exact verdict on a draft."""
        self.judged += 1
        ruling = judged(self.check, draft) if self._team is None else _sent(self._team, draft)
        if ruling.finding is None:
            kind = ruling.reason.partition(":")[0]
            self.dropped[kind] += 1
            if kind == "fault":
                self.faults.append(ruling)
        return ruling


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


def _judge(check: Check) -> Callable[[Draft], Ruling]:
    return partial(judged, check)


def _sent(team: Team[Draft, Ruling], draft: Draft) -> Ruling:
    """The verdict of another process."""
    ((_, ruling),) = team.results([draft])
    if isinstance(ruling, Lost):
        return Ruling(draft, None, f"fault: {ruling.detail}" if ruling.died else "too slow")
    return ruling
