"""A server on a free port, as a user starts it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def address() -> Iterator[str]:
    """The address of a running ``exactacq play``; it ends by control-C, at once and quietly."""
    pytest.importorskip("starlette", reason="the extra play is not installed")
    pytest.importorskip("uvicorn", reason="the extra play is not installed")
    line = [sys.executable, "-u", "-m", "exactacq", "play", "--no-browser"]
    paths = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    with subprocess.Popen(
        line, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": paths}
    ) as server:
        assert server.stdout is not None
        try:
            found = re.search(r"http://127\.0\.0\.1:\d+/[\w-]{32}/", server.stdout.readline())
            assert found
            yield found[0]
        finally:
            server.send_signal(2)
            try:
                assert server.wait(10) == 0
            except subprocess.TimeoutExpired:
                server.kill()
                raise
