"""Commands whose standard error is a terminal, as people see them."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
import threading


def on_a_terminal(*arguments: str) -> tuple[bytes, bytes]:
    """What a command line prints, and what a terminal shows of it besides."""
    outer, inner = pty.openpty()
    command = [sys.executable, "-m", "exactacq", *arguments]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=inner, env={**os.environ, "TERM": "xterm"}
    ) as running:
        os.close(inner)
        seen: list[bytes] = []
        # The terminal must be read while the command runs: a full one would stop it.
        reader = threading.Thread(target=lambda: seen.extend(iter(lambda: _read(outer), b"")))
        reader.start()
        assert running.stdout is not None
        out = running.stdout.read()
    reader.join()
    os.close(outer)
    return out, b"".join(seen)


def _read(terminal: int) -> bytes:
    """What a terminal shows next; nothing once the other end is closed, which Linux says by an error."""
    try:
        return os.read(terminal, 65536)
    except OSError:
        return b""
