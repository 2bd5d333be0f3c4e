"""Hypothesis profiles: `quick` (default, deterministic, few examples) and `long`.

Choose with the environment variable HYPOTHESIS_PROFILE or pytest's ``--hypothesis-profile``.
"""

from __future__ import annotations

import os

from hypothesis import HealthCheck, Phase, settings

SLOW_SCENES = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much]

settings.register_profile(
    "quick",
    derandomize=True,
    deadline=None,
    max_examples=20,
    database=None,
    phases=[Phase.explicit, Phase.generate],  # shrinking exact scenes takes minutes: left to `long`
    print_blob=True,
    suppress_health_check=SLOW_SCENES,
)
settings.register_profile(
    "long", deadline=None, max_examples=400, print_blob=True, suppress_health_check=SLOW_SCENES
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "quick"))
