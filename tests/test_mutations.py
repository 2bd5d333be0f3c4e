"""Wrong code planted on purpose: some claim's check must catch each.

Every mutation names the scene on which it is tried and the statements that fail there. On the same scenes,
without a mutation, these statements hold.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from exactacq.files import gallery
from exactacq.numbers.length import Length
from exactacq.scene.boundary_walk import Boundary
from exactacq.sensing.leg_views import Shares
from exactacq.strategies import bounds
from exactacq.strategies.robot import Robot
from exactacq.strategies.seed_spreader.rules import Spreader
from exactacq.study.claims import CLAIMS, Case, Outcome, Statement

Patch = pytest.MonkeyPatch


def wrong_bound(patch: Patch) -> None:
    """The corrected bound of Theorem 1 is reported a thousandth too low."""
    _change_bounds(patch, "sightseer_bounds", "T1 corrected")


def wrong_length_of_m_line(patch: Patch) -> None:
    """Bound (8) is reported a thousandth too low."""
    _change_bounds(patch, "spreader_bounds", "(8)")


def _change_bounds(patch: Patch, function: str, name: str) -> None:
    original = getattr(bounds, function)

    def changed(*args: Any) -> Any:
        return tuple(
            replace(b, value=b.value - Length("1/1000")) if b.name == name else b for b in original(*args)
        )

    patch.setattr(bounds, function, changed)


def skipped_obstacle(patch: Patch) -> None:
    """The Sightseer never goes to the last obstacle."""
    original = Robot.nearest_unvisited

    def blind(self: Robot, *source: Any) -> Any:
        link = original(self, *source)
        last = len(self._table.obstacles) - 1
        return None if link is not None and self._numbers[link.target] == last else link

    patch.setattr(Robot, "nearest_unvisited", blind)


def lost_interval(patch: Patch) -> None:
    """What is seen of the third edge is forgotten."""
    original = Shares.taught

    def forgetful(self: Shares, *known: Any, **options: Any) -> Any:
        return {e: cover for e, cover in original(self, *known, **options).items() if e != 2}

    patch.setattr(Shares, "taught", forgetful)


def lost_on_the_way(patch: Patch) -> None:
    """What is seen of the third edge from straight ways is forgotten."""
    original = Shares.taught

    def forgetful(self: Shares, *known: Any, **options: Any) -> Any:
        lost = {2} if self.leg.edge is None else set()
        return {e: cover for e, cover in original(self, *known, **options).items() if e not in lost}

    patch.setattr(Shares, "taught", forgetful)


def miscounted_strip(patch: Patch) -> None:
    """n_1 is one too large."""
    original = bounds.census

    def off_by_one(*args: Any) -> Any:
        counts = original(*args)
        return replace(counts, inside=(counts.inside[0] + 1, *counts.inside[1:]))

    patch.setattr(bounds, "census", off_by_one)


def unnoted_visits(patch: Patch) -> None:
    """Visits on diversions are not noted, so that the run compares too few with (4)."""
    original = Spreader._approach

    def silent(self: Spreader, *way: Any) -> None:
        before = len(self.encounters)
        original(self, *way)
        del self.encounters[before:]

    patch.setattr(Spreader, "_approach", silent)


def longer_way(patch: Patch) -> None:
    """Of the two ways round a boundary the longer one is taken."""
    original = Boundary.way

    def other(self: Boundary, start: Any, end: Any) -> Any:
        length, forward = original(self, start, end)
        return (self.perimeter - length, not forward) if self.closed else (length, forward)

    patch.setattr(Boundary, "way", other)


def second_turn(patch: Patch) -> None:
    """Each obstacle is circled twice, one turn after the other."""
    original = Robot.circle

    def twice(self: Robot) -> None:
        original(self)
        original(self)

    patch.setattr(Robot, "circle", twice)


def late_leave(patch: Patch) -> None:
    """The Seed Spreader leaves an obstacle at its last crossing point."""

    original = Robot.exits

    def last(self: Robot, route: Any, i: int) -> Any:
        return iter(list(original(self, route, i))[-1:])

    patch.setattr(Robot, "exits", last)


MUTATIONS: tuple[tuple[Callable[[Patch], None], str, tuple[str, ...]], ...] = (
    (wrong_bound, "squares", ("T1 corrected",)),
    (wrong_length_of_m_line, "case1", ("C8",)),
    (skipped_obstacle, "squares", ("SS-1 corrected", "SS-3", "SS-4 corrected", "SS-5")),
    (second_turn, "m8", ("SS-1 corrected", "T1 corrected")),
    (lost_interval, "squares", ("SS-3", "SS-4 corrected")),
    (lost_on_the_way, "", ("SSS-4",)),
    (miscounted_strip, "m25", ("L3 corrected", "T2 corrected")),
    (unnoted_visits, "m15", ("L3 corrected", "T2 corrected")),
    (longer_way, "m20-3", ("SSS-7",)),
    (late_leave, "m20-3", ("E3 corrected",)),
)


def statements(names: tuple[str, ...]) -> list[Statement]:
    """Statements by the claim's name, with "corrected" behind it for what holds in its place."""
    of = {c.name: c.printed for c in CLAIMS} | {
        f"{c.name} corrected": c.corrected for c in CLAIMS if c.corrected is not None
    }
    return [of[name] for name in names]


def outcomes(scene: str, names: tuple[str, ...]) -> list[Outcome]:
    """What a scene says of statements; without a scene, what their trials say."""
    if not scene:
        return [s.trial().outcome for s in statements(names) if s.trial is not None]
    case = Case(gallery.scene(scene))
    return [s.check(case).outcome for s in statements(names) if s.check is not None]


@pytest.mark.parametrize(
    ("mutation", "scene", "names"), [pytest.param(*m, id=f"{m[0].__name__}-{m[1]}") for m in MUTATIONS]
)
def test_a_planted_flaw_is_caught(
    mutation: Callable[[Patch], None], scene: str, names: tuple[str, ...], monkeypatch: Patch
) -> None:
    assert outcomes(scene, names) == [Outcome.HOLDS] * len(names)
    mutation(monkeypatch)
    assert outcomes(scene, names) == [Outcome.FAILS] * len(names)
