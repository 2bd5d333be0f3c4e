"""The data in a page, and names that try to be code."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

from exactacq.output.animation import frames
from exactacq.output.animation.frames import Frame
from exactacq.output.animation.page import page
from exactacq.strategies.run import Run

HOSTILE = (
    '</script><script>window.hacked = 1</script><img src=x onerror="window.hacked = 2">',
    "<!--<script>\u2028${window.hacked = 3}`$data $policy",
)

FINE = 7
"""Places between stops in tests."""


def frames_of(run: Run, fine: int = FINE) -> Iterator[Frame]:
    """The frames of a run, with few between its stops."""
    return frames.frames_of(run, fine=fine)


def encoded(run: Run, shown: list[Frame] | None = None) -> dict[str, Any]:
    """The data in the page."""
    text = page(run, frames_of(run) if shown is None else shown)
    (block,) = re.findall(r'<script type="application/json" id="data">(.*)</script>', text)
    return json.loads(block)
