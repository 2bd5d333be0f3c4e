"""How many examples a test of an oracle tries: a number everyday, many times that in the nightly profile."""

from __future__ import annotations

from hypothesis import settings

NIGHTLY = 20
"""Times as many examples as everyday."""


def examples(everyday: int) -> settings:
    """Settings for a test, from its number of examples everyday."""
    return settings(
        max_examples=everyday * (NIGHTLY if settings.get_current_profile_name() == "nightly" else 1)
    )
