"""Servers as a user starts them: `exactacq play` with options, ended by control-C."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO
from urllib.parse import urlsplit

import pytest

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Served:
    """A running server: its address, and its process."""

    address: str
    pid: int

    @property
    def port(self) -> int:
        """The port that it listens to."""
        port = urlsplit(self.address).port
        assert port is not None
        return port

    def processes(self) -> list[int]:
        """The processes that it has now, itself first (Linux)."""
        children = Path(f"/proc/{self.pid}/task/{self.pid}/children").read_text()
        return [self.pid, *map(int, children.split())]

    def megabytes(self) -> float:
        """The most memory that the process of the server itself, without its children, ever had (Linux)."""
        found = re.search(r"VmHWM:\s+(\d+) kB", Path(f"/proc/{self.pid}/status").read_text())
        assert found is not None
        return int(found[1]) / 1024


@contextmanager
def served(
    *options: str,
    place: str = "127.0.0.1",
    folder: Path | None = None,
    errors: IO[str] | None = None,
    **environment: str,
) -> Iterator[Served]:
    """A server with options, in a folder; it must end by control-C, at once and quietly.

    What it says of errors goes to a file, if there is one.
    """
    pytest.importorskip("starlette", reason="the extra play is not installed")
    pytest.importorskip("uvicorn", reason="the extra play is not installed")
    line = [sys.executable, "-u", "-m", "exactacq", "play", "--no-browser", *options]
    own = [environment.pop("PYTHONPATH", None), str(ROOT), os.environ.get("PYTHONPATH")]
    environment["PYTHONPATH"] = os.pathsep.join(filter(None, own))
    with subprocess.Popen(
        line, stdout=subprocess.PIPE, stderr=errors, text=True, cwd=folder, env={**os.environ, **environment}
    ) as server:
        assert server.stdout is not None
        try:
            found = re.search(rf"http://{re.escape(place)}:\d+/[\w-]{{32}}/", server.stdout.readline())
            assert found
            yield Served(found[0], server.pid)
        finally:
            server.send_signal(2)
            try:
                assert server.wait(10) == 0
            except subprocess.TimeoutExpired:
                server.kill()
                raise
