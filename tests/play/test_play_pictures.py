"""The pictures of docs/play.md show the page as it is."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from chromium import Chromium
from draw_pictures import PICTURES, SIZE, draw
from nightly import by_night
from servers import ROOT

PIL = pytest.importorskip("PIL.Image", reason="the extra images is not installed")

OTHER = 0.06
"""Share of the pixels that may differ: fonts are others elsewhere."""


def test_the_documentation_shows_all_of_them() -> None:
    text = (ROOT / "docs" / "play.md").read_text()
    assert set(re.findall(r"\(images/([\w.]+)\)", text)) == set(PICTURES)


@by_night
def test_they_are_as_the_page_is_now(browser: Chromium, address: str, tmp_path: Path) -> None:
    draw(browser, address, tmp_path)
    for name in PICTURES:
        made, stored = (
            np.asarray(PIL.open(folder / name).convert("L"), dtype=float)
            for folder in (tmp_path, ROOT / "docs" / "images")
        )
        assert made.shape == stored.shape == SIZE[::-1]
        assert np.ptp(made) > 200, "nothing is shown"
        share = float(np.mean(np.abs(made - stored) > 40))
        assert share < OTHER, f"{name}: {share:.1%} differ; python tests/play/draw_pictures.py makes it anew"
