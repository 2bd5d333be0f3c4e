"""What a user chooses among: words alone, so that the command line's help loads nothing else."""

from __future__ import annotations

from enum import StrEnum

SIZES = range(5, 301)
"""Sizes that every family has."""


class Family(StrEnum):
    """Kinds of drawings. Their size is the number of obstacles; of gears and staircases, that of edges."""

    PLATES = "plates"
    BOARDS = "boards"
    FLOOR_PLANS = "floor-plans"
    GEARS = "gears"
    SLOTS = "slots"
    WORDS = "words"
    STAIRCASES = "staircases"
