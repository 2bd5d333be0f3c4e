"""What is repeated every day, and what at night: with HYPOTHESIS_PROFILE=nightly all is tried.

Laws hold for many seeds, files and scenes. A few of them are tried every day, always the same ones.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TypeVar

import pytest
from hypothesis import settings

T = TypeVar("T")

NIGHTLY = "nightly" in (settings.get_current_profile_name(), os.environ.get("HYPOTHESIS_PROFILE"))


by_night = pytest.mark.skipif(not NIGHTLY, reason="tried at night")
"""A test that takes long, of what shorter ones try every day."""


def some(values: Iterable[T], k: int) -> list[T]:
    """All values at night; every day k of them, evenly spread from the first on."""
    found = list(values)
    if NIGHTLY or k >= len(found):
        return found
    return [found[i * len(found) // k] for i in range(k)]


def examples(everyday: int, nightly: int | None = None) -> settings:
    """How many examples Hypothesis tries: at night 20 times as many, if no other number is given."""
    return settings(max_examples=(nightly or 20 * everyday) if NIGHTLY else everyday)
