"""The page in a browser: shown, pointed at, clicked and typed on."""

from __future__ import annotations

import json

from chromium import Chromium

SHAPES = "document.querySelectorAll('#shapes path').length"
READY = "document.body && document.body.dataset.ready === 'true'"
WATCHES = "document.body.dataset.mode === 'watch' && !document.body.dataset.busy"


def show(
    browser: Chromium, address: str, width: int = 1280, height: int = 800, scheme: str = "light"
) -> None:
    browser.complaints.clear()
    browser.requests.clear()
    browser.resize(width, height)
    media = [{"name": "prefers-color-scheme", "value": scheme}]
    browser.send("Emulation.setEmulatedMedia", features=media)
    browser.send("Page.navigate", url="about:blank")
    browser.until("location.href === 'about:blank'")
    browser.send("Page.navigate", url=address)
    browser.until(READY)
    browser.requests[:] = [url for url in browser.requests if url != "about:blank"]


def point(browser: Chromium, kind: str, x: float, y: float) -> None:
    button = "none" if kind == "mouseMoved" else "left"
    browser.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, clickCount=1)


def click(browser: Chromium, x: float, y: float) -> None:
    for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
        point(browser, kind, x, y)


def key(browser: Chromium, *names: str) -> None:
    for name in names:
        browser.press(name, text=name if len(name) == 1 else "\r" if name == "Enter" else "")


def square(browser: Chromium) -> None:
    """A square by clicks, east of the start."""
    browser.click("[data-tool=polygon]")
    for x, y in ((600, 200), (720, 200), (720, 320), (600, 320), (600, 200)):
        click(browser, x, y)
    browser.until(f"{SHAPES} === 1 && document.getElementById('verdict').dataset.ok === 'true'")


def drop(browser: Chromium, name: str, text: str) -> None:
    """Let a file fall on the page."""
    browser.run(
        "(() => { const all = new DataTransfer(); "
        f"all.items.add(new File([{json.dumps(text)}], {json.dumps(name)})); "
        "const options = { dataTransfer: all, bubbles: true, cancelable: true }; "
        "document.dispatchEvent(new DragEvent('drop', options)); })()"
    )
