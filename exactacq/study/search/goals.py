"""What is searched for: the statement of a claim, or one of the bounds that every run is compared with."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from exactacq.auditing.bounds import VISITS
from exactacq.errors import FormatError
from exactacq.files.whole_files import readable
from exactacq.numbers.length import Length
from exactacq.strategies.run import Bound, Run, SeedSpreaderRun
from exactacq.study.claims import CLAIMS
from exactacq.study.claims.model import Case, Finding, Outcome, Statement, Subject
from exactacq.study.claims.premises import PREMISES

CORRECTED: dict[Subject, dict[str, str | None]] = {
    Subject.SIGHTSEER: {"(1)": "T1 corrected", "(2)": "(2) + S-S1"},
    Subject.SEED_SPREADER: {
        "(4)": "L3 corrected",
        "(5)": "T2 corrected",
        "(6)": "T2 corrected",
        "(8)": None,
        "(9)": "T2 corrected",
        "(10)": "T2 corrected",
        "(11)": "T2 corrected",
    },
}
"""The printed bounds, as `exactacq.strategies.bounds` calls them, and what holds instead."""


@dataclass(frozen=True)
class Goal:
    """A statement to be broken, and what to call it."""

    name: str
    statement: Statement

    @property
    def subject(self) -> Subject:
        """Which run it speaks of."""
        return self.statement.subject

    def check(self, case: Case) -> Finding:
        """What a case says of it."""
        assert self.statement.check is not None, "goals without a check are refused"
        return self.statement.check(case)


def goal(name: str, corrected: bool = False) -> Goal:
    """The printed or corrected statement of a claim, or of a bound by its name, with or without brackets.

    Raises `FormatError` if there is none, or if no single scene decides it.

    >>> goal("(6)").subject.value
    'seed-spreader'
    """
    found = _bound_statement(name, corrected) or _claim_statement(name, corrected)
    if found is None:
        raise FormatError(f"no claim or bound {name[:40]!r}; there are {', '.join(goal_names())}")
    if found.check is None:
        raise FormatError(f"{name}: no scene decides this statement, so there is nothing to search for")
    return Goal(f"{name}, corrected" if corrected else name, found)


def goal_names() -> list[str]:
    """The names of claims and bounds."""
    return [*(claim.name for claim in CLAIMS), *_subjects()]


def _claim_statement(name: str, corrected: bool) -> Statement | None:
    claim = next((c for c in CLAIMS if c.name.casefold() == name.casefold()), None)
    if claim is None:
        return None
    if corrected and claim.corrected is None:
        raise FormatError(f"{claim.name}: there is no corrected statement of it")
    return claim.corrected if corrected else claim.printed


def _subjects() -> dict[str, Subject]:
    return {
        name: subject
        for subject, pairs in CORRECTED.items()
        for name in (*pairs, *(other for other in pairs.values() if other is not None))
    }


def _bound_statement(name: str, corrected: bool) -> Statement | None:
    subjects = _subjects()
    key = name if name in subjects else f"({name})"
    if key not in subjects:
        return None
    subject = subjects[key]
    if corrected:
        other = CORRECTED[subject].get(key)
        if other is None:
            raise FormatError(f"{key}: there is no corrected form of it")
        key = other

    return Statement(f"bound {key} holds", subject, partial(_compared, subject, key))


def _compared(subject: Subject, name: str, case: Case) -> Finding:
    """A run against one of its bounds; silent where the bound is not meant for it."""
    run = case.sightseer if subject is Subject.SIGHTSEER else case.spreader
    bound = next((b for b in run.bounds if b.name == name), None)
    if bound is None:
        return Finding(Outcome.SILENT, "no such bound without obstacles")
    if not PREMISES[name].holds(case):
        return Finding(Outcome.SILENT, f"not meant for this run, but for: {PREMISES[name].words}")
    outcome = Outcome.HOLDS if bound.holds else Outcome.FAILS
    return Finding(outcome, _detail(run, bound), _ratio(bound))


def _ratio(bound: Bound) -> float:
    if bound.value.sign():
        return bound.ratio
    return 0.0 if bound.holds else float("inf")


def _detail(run: Run, bound: Bound) -> str:
    """Both sides in closed form, and how they compare: exactly."""
    what, length = "P", run.length
    if isinstance(run, SeedSpreaderRun) and bound.name in VISITS:
        what, length = "visits", Length(len(run.encounters))
    relation = ">" if not bound.holds else "=" if length == bound.value else "<"
    left, right = (" ".join(readable(value, 40, 12)) for value in (length, bound.value))
    return f"{what} = {left} {relation} {right}"
