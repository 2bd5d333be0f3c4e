"""The data in a page, and names that try to be code."""

from __future__ import annotations

import json
import re
from typing import Any

from exactacq.output.animation.page import Frame, frames_of, page
from exactacq.strategies.run import Run

HOSTILE = (
    '</script><script>window.hacked = 1</script><img src=x onerror="window.hacked = 2">',
    "<!--<script>\u2028${window.hacked = 3}`$data $policy",
)


def encoded(run: Run, frames: list[Frame] | None = None) -> dict[str, Any]:
    """The data in the page."""
    text = page(run, frames_of(run) if frames is None else frames)
    (block,) = re.findall(r'<script type="application/json" id="data">(.*)</script>', text)
    return json.loads(block)
