"""File systems of a test's own, small or read-only, and commands without root's rights; for Linux.

What is mounted is seen by the commands of one script only, and is gone when they end.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
from functools import cache
from pathlib import Path

DROP, OVERRIDE = 24, 1
"""What the system calls giving up a right for good, and root's right to write what may not be written."""


@cache
def cannot_mount() -> str:
    """Why nothing can be mounted here, in a line; empty if it can."""
    try:
        done = in_own_mounts("mount -t tmpfs -o size=64k none /tmp")
    except OSError as error:
        return str(error)
    return done.stderr.strip().replace("\n", "; ") if done.returncode else ""


def in_own_mounts(script: str) -> subprocess.CompletedProcess[str]:
    """Run a shell script as the root of user and mount namespaces of its own; what fails in it ends it."""
    return subprocess.run(
        ["unshare", "--user", "--map-root-user", "--mount", "sh", "-ec", script],
        capture_output=True,
        text=True,
        check=False,
    )


def without_override() -> None:
    """To be called in a new process: what it runs is held to the rights of files, even as root."""
    if os.geteuid() == 0:
        ctypes.CDLL(None).prctl(DROP, OVERRIDE, 0, 0, 0)


def ending(command: str, told: Path) -> str:
    """A line of a script that prints the command's exit status; what it tells goes to a file."""
    return f"{command} >/dev/null 2>{told} && echo 0 || echo $?"
