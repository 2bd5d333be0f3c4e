"""One scene judged: the run, its audit, and what the scene says of every statement."""

from __future__ import annotations

import json
import traceback
from collections.abc import Callable, Generator, Iterable
from enum import StrEnum
from functools import partial
from time import perf_counter
from typing import NamedTuple

from exactacq.auditing.audit import audit
from exactacq.errors import AuditError, InvalidScene, Undecided
from exactacq.files.scene_json import scene_to_json
from exactacq.scene.scene import Scene
from exactacq.strategies.run import Run
from exactacq.study.campaign.settings import RANDOM, Called, SceneSource, Settings, Task, claims_at, parts
from exactacq.study.claims.model import Case, Finding, Outcome, Statement, Subject
from exactacq.study.processes import Lost, Team

SAMPLES = 8
"""Samples of each kind that an audit takes: few, and others on each scene, for there are many scenes."""


class Result(StrEnum):
    """What became of a scene; the worse comes later. Only PASSED is praise."""

    PASSED = "passed"
    UNDECIDED = "undecided"
    TIMEOUT = "timeout"
    AUDIT = "audit failed"
    CRASHED = "crashed"
    ERROR = "error"


HOLDS, FAILS, SILENT = (outcome.name.lower() for outcome in Outcome)
"""What a scene says of a statement; beside these "undecided" and "error" if the check gave no answer."""


class Row(NamedTuple):
    """What one scene says of one statement."""

    claim: str
    statement: str
    outcome: str
    ratio: float | None = None
    detail: str = ""


class Record(NamedTuple):
    """All that is kept of a scene. ``length`` is that of the run; ``scene`` is JSON if anything failed."""

    task: Task
    result: str
    seconds: float = 0.0
    length: float | None = None
    detail: str = ""
    scene: str | None = None
    rows: tuple[Row, ...] = ()


def judge(
    task: Task, statements: Iterable[tuple[Called, Statement]], audited: bool, source: SceneSource = RANDOM
) -> Record:
    """Make the scene, run the strategy on it, audit the run, and put the case to all its statements.

    Never raises: what goes wrong is part of the record. Apart from ``seconds`` it depends on nothing but the
    arguments. Cost: the run's, the audit's and the checks'; seconds.
    """
    began = perf_counter()
    try:
        case = Case(source.scene(task))
    except Exception as error:
        return Record(task, Result.ERROR.value, perf_counter() - began, detail=_words(error))
    result, detail, length = _run(case, task, audited)
    # Without a run there is nothing to say, and each check would only meet the same error again.
    asked = [] if length is None else [s for s in statements if s[0].strategy == task.strategy]
    rows = tuple(_row(called, statement, case) for called, statement in asked)
    for row in rows:
        spoilt = _SPOILS.get(row.outcome, Result.PASSED)
        if _ORDER.index(spoilt) > _ORDER.index(result):
            result, detail = spoilt, f"{row.claim} ({row.statement}): {row.detail}"
    seconds = perf_counter() - began
    failing = result is not Result.PASSED or any(row.outcome == FAILS for row in rows)
    return Record(
        task, result.value, seconds, length, detail, scene_text(case.scene) if failing else None, rows
    )


def records(settings: Settings, tasks: Iterable[Task], size: int) -> Generator[Record, None, None]:
    """The records of all tasks by *size* processes of their own, in the order in which they are finished.

    A scene that takes longer than ``settings.timeout`` seconds is recorded as a timeout, one over which two
    processes died as crashed. Raises `exactacq.study.processes.ProcessError`.
    """
    with Team(
        partial(_judge_of, settings.claims, settings.audit, settings.source), size, settings.timeout
    ) as team:
        for task, record in team.results(tasks):
            if isinstance(record, Lost):
                result = Result.CRASHED if record.died else Result.TIMEOUT
                yield lost(settings, task, result, record.seconds, record.detail)
            else:
                yield record


def _judge_of(claims: str, audited: bool, source: SceneSource) -> Callable[[Task], Record]:
    statements = list(parts(claims_at(claims)))
    return lambda task: judge(task, statements, audited, source)


def lost(settings: Settings, task: Task, result: Result, seconds: float, detail: str) -> Record:
    """The record of a scene whose process gave no answer."""
    return Record(task, result.value, seconds, detail=detail, scene=scene_text(settings.source.scene(task)))


def scene_text(scene: Scene) -> str:
    """The scene as a JSON document that every command reads."""
    return json.dumps(scene_to_json(scene))


_ORDER = list(Result)
_SPOILS = {"undecided": Result.UNDECIDED, "error": Result.ERROR}


def _run(case: Case, task: Task, audited: bool) -> tuple[Result, str, float | None]:
    """What became of the run and its audit, and its length if there is one."""
    length = None
    try:
        run: Run = case.sightseer if task.strategy == Subject.SIGHTSEER.value else case.spreader
        length = float(run.length)
        run.sense()
        if audited:
            audit(run, samples=SAMPLES, seed=task.seed)
    except Undecided as error:
        return Result.UNDECIDED, _words(error), length
    except AuditError as error:
        return Result.AUDIT, str(error), length
    except Exception as error:
        return Result.ERROR, _words(error), length
    return Result.PASSED, "", length


def _row(called: Called, statement: Statement, case: Case) -> Row:
    assert statement.check is not None
    outcome, finding = _finding(statement.check, case)
    return Row(called.claim, called.part, outcome, finding.ratio, finding.detail)


def _finding(check: Callable[[Case], Finding], case: Case) -> tuple[str, Finding]:
    try:
        finding = check(case)
    except InvalidScene as error:
        # The strategy's own run is made: another one refuses the scene, as the Sightseer does at borders.
        return SILENT, Finding(Outcome.SILENT, str(error))
    except Undecided as error:
        return "undecided", Finding(Outcome.SILENT, _words(error))
    except Exception as error:
        return "error", Finding(Outcome.SILENT, _words(error))
    return finding.outcome.name.lower(), finding


def _words(error: BaseException) -> str:
    """The error's kind and message, and where it was first raised."""
    while error.__cause__ is not None:
        error = error.__cause__
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} (in {frame.name})"
