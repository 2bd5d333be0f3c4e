"""Output files written whole or not at all, and lengths as text of bounded size."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Collection
from pathlib import Path

from exactacq.errors import FormatError
from exactacq.numbers.exact import is_short
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import plain

FIGURES = (".svg", ".pdf", ".png")
"""File types of figures."""
TRACES = (".json",)
"""File types of traces."""
PAGES = (".html",)
"""File types of animated pages."""
FILMS = (".gif", ".mp4")
"""File types of films."""


def readable(length: Length, limit: int, digits: int) -> tuple[str, ...]:
    """The closed form, if it has at most *limit* characters, and ``≈`` the decimal value.

    A finite decimal is its own value and comes alone.
    """
    decimal = length.decimal(digits)
    if "e" not in decimal and "." in decimal:
        decimal = decimal.rstrip("0").rstrip(".")
    closed = str(length) if all(is_short(number, limit) for number in length.numbers) else ""
    value = length.algebraic.rational if closed and length == Length(length.algebraic) else None
    if value is not None:
        closed = plain(value)
    if closed == decimal or (value is not None and "/" not in closed):
        return (closed,)
    return (closed, f"≈ {decimal}") if 0 < len(closed) <= limit else (f"≈ {decimal}",)


def check_output(path: str | os.PathLike[str], suffixes: Collection[str]) -> Path:
    """The path, if a file of one of the *suffixes* can be written there; `FormatError` otherwise.

    To be called before long work starts, so that a bad name does not cost the result. Writes nothing.
    """
    target = Path(path)
    if "\0" in str(target):
        raise FormatError(f"{str(target)!r}: not a file name")
    if target.suffix.lower() not in suffixes:
        raise FormatError(f"{target}: a file name must end in {', '.join(suffixes)}")
    if target.is_dir():
        raise FormatError(f"{target}: this is a directory; give the name of a file")
    folder = target.parent
    if not folder.is_dir():
        raise FormatError(f"{target}: there is no directory {folder}; make it first")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise FormatError(f"{target}: the directory {folder} cannot be written to")
    return target


def write_whole(path: str | os.PathLike[str], data: bytes) -> None:
    """Write a file through a temporary one beside it and a rename: readers see the old or the new file.

    Raises `OSError` with the name of the file; nothing is left behind then.
    """
    target = Path(path)
    try:
        _write_beside(target, data)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(target)) from None


def _write_beside(target: Path, data: bytes) -> None:
    handle, temporary = tempfile.mkstemp(prefix=f".{target.name[:40]}.", suffix=".part", dir=target.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        Path(temporary).chmod(_mode(target))
        Path(temporary).replace(target)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def _mode(target: Path) -> int:
    """Permissions as if the file had been opened for writing: those it has, or the process's default."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
