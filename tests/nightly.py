"""What is repeated every day, and what at night: with HYPOTHESIS_PROFILE=nightly all is tried.

Laws hold for many seeds, files and scenes. A few of them are tried every day, always the same ones.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TypeVar

from hypothesis import settings

T = TypeVar("T")

NIGHTLY = "nightly" in (settings.get_current_profile_name(), os.environ.get("HYPOTHESIS_PROFILE"))


def some(values: Iterable[T], k: int) -> list[T]:
    """All values at night; every day k of them, evenly spread from the first on."""
    found = list(values)
    if NIGHTLY or k >= len(found):
        return found
    return [found[i * len(found) // k] for i in range(k)]


def examples(everyday: int, nightly: int) -> settings:
    """How many examples Hypothesis tries."""
    return settings(max_examples=nightly if NIGHTLY else everyday)
