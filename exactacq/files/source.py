"""Reading a file's bytes within limits.

The messages name no file: `exactacq.files.by_suffix.load` puts it first.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path

from exactacq.errors import FormatError

MAX_BYTES = 64 << 20
"""Largest file that is read; scenes of `MAX_EDGES` edges need a third of this in any format."""
MAX_EDGES = 200_000
"""Most edges a scene may have: its validation then still ends in minutes, not hours."""


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """The whole content of a regular, not empty file of at most `MAX_BYTES`; `FormatError` otherwise.

    Kind and size are checked before anything is opened, so neither noise nor a device costs time or memory.
    """
    try:
        status = os.stat(path)
        if stat.S_ISDIR(status.st_mode):
            raise FormatError("this is a directory; give a file in it")
        if not stat.S_ISREG(status.st_mode):
            raise FormatError("not a regular file; give another")
        if status.st_size > MAX_BYTES:
            size = f"{status.st_size >> 20} MB is more than the {MAX_BYTES >> 20} MB that are read"
            raise FormatError(f"{size}; export only the part that matters")
        with Path(path).open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except FormatError:
        raise
    except FileNotFoundError:
        raise FormatError("no such file; check the name") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or one_line(error)
        raise FormatError(f"cannot be read ({reason}); check its name and rights") from None
    if not data.strip():
        raise FormatError("the file is empty; save or export it again")
    return data


def read_text(path: str | os.PathLike[str]) -> str:
    """The content of a text file in UTF-8; `FormatError` as `read_bytes`, and for other bytes."""
    return decoded(read_bytes(path))


def decoded(data: bytes) -> str:
    """Bytes in UTF-8 as text; `FormatError` for others."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FormatError(f"byte {error.start} is not UTF-8; save the file as UTF-8") from None


def one_line(error: object) -> str:
    """An error's text on one line of at most 160 printable characters."""
    text = "".join(c if c.isprintable() else " " for c in str(error))
    return " ".join(text.split())[:160] or type(error).__name__


def check_edges(count: int) -> None:
    """`FormatError` if a scene would have more than `MAX_EDGES` edges."""
    if count > MAX_EDGES:
        most = f"{count} edges are more than the {MAX_EDGES} that are taken"
        raise FormatError(f"{most}; select layers or export only the part that matters")
