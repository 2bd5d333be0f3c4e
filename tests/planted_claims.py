"""Claims that hold, fail, hang or kill their process: the workers of campaigns import them from here.

This module is small, for each worker loads it when it starts.
"""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from exactacq.errors import Undecided
from exactacq.study.claims.model import Case, Claim, Finding, Outcome, Statement, Subject

MARK = "EXACTACQ_TEST_MARK"
"""Names the file that a planted check leaves when it kills its process, so that it does so only once."""


def positive(case: Case) -> Finding:
    """Holds wherever something is to be visited."""
    run = case.sightseer
    if not run.visits:
        return Finding(Outcome.SILENT)
    return Finding(Outcome.HOLDS if run.length.sign() > 0 else Outcome.FAILS, "", float(run.length) / 1000)


def no_third(case: Case) -> Finding:
    """Fails on the scenes of seed 3."""
    return Finding(Outcome.FAILS if str(case.scene.name).endswith("-3") else Outcome.HOLDS, "the third")


def odd(case: Case) -> Finding:
    """Fails on every scene with an odd number of obstacles."""
    return Finding(Outcome.FAILS if len(case.scene.obstacles) % 2 else Outcome.HOLDS)


def hang(case: Case) -> Finding:
    """Never comes back from the scene of seed 1."""
    while str(case.scene.name).endswith("-1"):
        time.sleep(0.05)
    return Finding(Outcome.HOLDS)


def die_once(case: Case) -> Finding:
    """Kills its process the first time."""
    mark = Path(os.environ[MARK])
    if not mark.exists():
        mark.write_text("died")
        os.kill(os.getpid(), signal.SIGKILL)
    return positive(case)


def die(case: Case) -> Finding:
    """Kills its process on the scene of seed 2, every time."""
    if str(case.scene.name).endswith("-2"):
        os.kill(os.getpid(), signal.SIGKILL)
    return Finding(Outcome.HOLDS)


def dawdle(case: Case) -> Finding:
    """Takes its time."""
    time.sleep(0.3)
    return positive(case)


def doubt(case: Case) -> Finding:
    """Is beyond its limits on the scene of seed 0, and broken on that of seed 1."""
    if str(case.scene.name).endswith("-0"):
        raise Undecided("two lengths")
    if str(case.scene.name).endswith("-1"):
        raise ZeroDivisionError("planted")
    print("this must not get among the answers")
    return Finding(Outcome.HOLDS)


def _planted(check: Callable[[Case], Finding], **options: Any) -> Claim:
    return Claim(check.__name__, "here", Statement(str(check.__doc__), Subject.SIGHTSEER, check, **options))


SOUND = (_planted(positive), _planted(odd, counterexamples=("m4",)))
FALSE = (*SOUND, _planted(no_third))
HANGING, DYING, DOUBTFUL, SLOW = (_planted(hang),), (_planted(die),), (_planted(doubt),), (_planted(dawdle),)
DYING_ONCE = (replace(_planted(die_once), name="positive"), SOUND[1])
"""Like SOUND to the eye, so that the verdicts can be compared."""
