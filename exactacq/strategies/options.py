"""What a user chooses among: words alone, so that the command line's help loads nothing else."""

from __future__ import annotations

from enum import StrEnum
from typing import NoReturn

from exactacq.errors import FormatError, shown

MOST_MOVES = 10_000
"""Moves that a strategy of the user's own may make unless it is told otherwise."""


class Strategy(StrEnum):
    """The paper's strategies."""

    SIGHTSEER = "sightseer"
    SEED_SPREADER = "seed-spreader"


class Baseline(StrEnum):
    """Strategies that come with the library to be compared with, and are run as those of the user's own."""

    NEAREST_FRONTIER = "nearest-frontier"


class TargetChoice(StrEnum):
    """Among which points of an obstacle that is about to be lost the nearest one is aimed at."""

    KNOWN = "known"
    VISIBLE = "visible"

    @classmethod
    def _missing_(cls, value: object) -> NoReturn:
        raise FormatError(f'target: "known" or "visible", not {shown(value)}')
