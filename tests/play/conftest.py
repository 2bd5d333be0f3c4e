"""A server on a free port, as a user starts it, and a browser that shows the page."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from board_page import show
from chromium import Chromium, binary
from servers import served


@pytest.fixture(scope="session")
def address() -> Iterator[str]:
    """The address of a running ``exactacq play``."""
    with served() as server:
        yield server.address


@pytest.fixture(scope="session")
def browser() -> Iterator[Chromium]:
    if binary() is None:
        pytest.skip("no Chromium or Chrome is installed")
    with Chromium() as running:
        yield running


@pytest.fixture
def page(browser: Chromium, address: str) -> Iterator[Chromium]:
    """The page anew; it must neither complain nor ask for anything of others."""
    show(browser, address)
    yield browser
    assert browser.complaints == []
    assert all(url.startswith((address, "blob:")) for url in browser.requests)
