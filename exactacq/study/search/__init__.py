"""Search for scenes that break a statement, or come close: exact scenes, mutated, judged, and made small.

Names are loaded when they are first asked for: the command's options alone need none of them.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from exactacq.study.search.annealing import Budget, Search
    from exactacq.study.search.drafts import Draft
    from exactacq.study.search.goals import Goal, goal, goal_names
    from exactacq.study.search.referee import Referee, Ruling
    from exactacq.study.search.shrinking import shrink

__all__ = ["Budget", "Draft", "Goal", "Referee", "Ruling", "Search", "goal", "goal_names", "shrink"]

_HOMES = {
    "Budget": "annealing", "Draft": "drafts", "Goal": "goals", "Referee": "referee", "Ruling": "referee",
    "Search": "annealing", "goal": "goals", "goal_names": "goals", "shrink": "shrinking",
}  # fmt: skip
"""The files where the names live."""


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
