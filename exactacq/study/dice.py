"""Dice: choices that are the same for the same seed on every platform and version of Python."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import TypeVar

Item = TypeVar("Item")


class Dice:
    """Choices from `Random.random` alone, whose stream Python promises to keep for a seed."""

    def __init__(self, seed: int) -> None:
        self._rng = Random(seed)

    def below(self, n: int) -> int:
        """A number from 0 to n - 1."""
        return int(self._rng.random() * n)

    def between(self, low: int, high: int) -> int:
        """A number from low to high."""
        return low + self.below(high - low + 1)

    def choice(self, items: Sequence[Item]) -> Item:
        """One of the items."""
        return items[self.below(len(items))]

    def chance(self, percent: int) -> bool:
        """True in so many cases of a hundred."""
        return self.below(100) < percent
