"""Makes the pictures of docs/play.md anew: ``python tests/play/draw_pictures.py [FOLDER]``.

It needs Chromium or Chrome, and the extra play. The folder is docs/images if none is given.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parents[1])]

from board_page import SHAPES, WATCHES, click, drop, point, show  # noqa: E402
from chromium import Chromium  # noqa: E402
from servers import ROOT, served  # noqa: E402

SIZE = 1160, 720
"""Pixels of the window."""
TOUCHING = {
    "start": [0, 0],
    "radius": 10,
    "obstacles": [
        {"boundary": [[3, 2], [9, 2], [9, 7], [3, 7]]},
        {"circle": {"center": [9, 0], "radius": 3}},
    ],
}
"""Two obstacles that break a rule."""
HALFWAY = (
    "(() => { const s = document.getElementById('slider'); s.value = s.max / 2; "
    "s.dispatchEvent(new Event('input', { bubbles: true })); })()"
)
HEART = (
    "(({ x, y, width, height }) => [x + width / 2, y + height / 2])"
    "(document.querySelectorAll('#shapes path')[1].getBoundingClientRect())"
)


def run(browser: Chromium, address: str, path: Path) -> None:
    """Half of the Sightseer's run of Figure 2."""
    show(browser, address, *SIZE)
    browser.run("document.querySelector('[data-example=figure2]').click()")
    browser.until(f"{SHAPES} === 11", 30)
    browser.click("#mode")
    browser.until(f"{WATCHES} && document.body.dataset.whole === 'true'", 120)
    browser.run("document.body.dataset.playing === 'true' && document.getElementById('play').click()")
    point(browser, "mouseMoved", *SIZE)
    browser.run(HALFWAY)
    browser.run("document.activeElement.blur()")
    browser.until("document.getElementById('length').textContent.includes('219')")
    browser.screenshot(path)


def rules(browser: Chromium, address: str, path: Path) -> None:
    """Two obstacles that meet, one of them selected."""
    show(browser, address, *SIZE)
    drop(browser, "two obstacles.json", json.dumps(TOUCHING))
    browser.until(f"{SHAPES} === 2 && !document.querySelector('dialog[open]')", 30)
    click(browser, *browser.run(HEART))
    browser.until("document.querySelectorAll('#marks circle').length > 0", 30)
    browser.run("document.activeElement.blur()")
    browser.screenshot(path)


PICTURES = {"play_run.png": run, "play_rules.png": rules}


def draw(browser: Chromium, address: str, folder: Path) -> None:
    """Write all pictures into a folder."""
    for name, picture in PICTURES.items():
        picture(browser, address, folder / name)


if __name__ == "__main__":
    with served() as server, Chromium() as browser:
        draw(browser, server.address, Path(sys.argv[1]) if sys.argv[1:] else ROOT / "docs" / "images")
