"""Which runs each bound is meant for, as the paper or the corrected statement says."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from exactacq.study.claims.model import Case
from exactacq.study.claims.tallies import Tally
from exactacq.visibility.links import START


class Premise(NamedTuple):
    """Which runs a bound is meant for, in words and as a question to a case."""

    words: str
    holds: Callable[[Case], bool]


def _is_seated(case: Case) -> bool:
    """Whether model (a) holds and the start lies on a boundary, as the paper takes it to."""
    ways = (link for link in case.sightseer.links if link.source == START)
    return case.is_mutually_visible and all(link.length.sign() == 0 for link in ways)


_SEATED = Premise("model (a), S on a boundary", _is_seated)
_LINKED = Premise("model (a)", lambda case: case.is_mutually_visible)
_ANY = Premise("all sweeps", lambda _: True)
_DIRECT = Premise(
    "no known obstacle met on diversions", lambda case: not case.shared(Tally).diversions_meet_known
)
_CLEAR = Premise("clear of the border", lambda case: case.shared(Tally).is_clear)
_BOTH = Premise("both of (9) and (10)", lambda case: _DIRECT.holds(case) and _CLEAR.holds(case))

PREMISES = {
    "(1)": _SEATED,
    "(2)": _SEATED,
    "T1 corrected": _LINKED,
    "(2) + S-S1": _LINKED,
    "(4)": _ANY,
    "(5)": _ANY,
    "(6)": _ANY,
    "(8)": Premise("no hit, no diversion", lambda case: case.shared(Tally).is_plain),
    "(9)": _DIRECT,
    "(10)": _CLEAR,
    "(11)": _BOTH,
    "L3 corrected": _ANY,
    "T2 corrected": _ANY,
}
"""The bounds by their names in a run, in the paper's order; the corrected ones of sweeps last."""
