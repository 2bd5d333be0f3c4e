"""Search for scenes that break a statement, or come close: exact scenes, mutated, judged, and made small."""

from __future__ import annotations

from exactacq.study.search.drafts import Draft
from exactacq.study.search.goals import Goal, goal, goal_names
from exactacq.study.search.local import Budget, Search
from exactacq.study.search.referee import Referee, Ruling
from exactacq.study.search.shrinking import shrink

__all__ = ["Budget", "Draft", "Goal", "Referee", "Ruling", "Search", "goal", "goal_names", "shrink"]
