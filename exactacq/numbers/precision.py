"""The working precision of balls. The process has only one, so one thread at a time computes with balls.

Whoever sets the precision holds `LOCK` until it is reset; so does who makes or changes numbers that others
may share. Whoever holds it waits for nothing else, or two threads could wait for each other: no callback is
called meanwhile.
"""

from __future__ import annotations

from threading import RLock

from flint import ctx

LOCK = RLock()
"""Held while the working precision is set, and while shared numbers are made or changed. Re-entrant."""


class workprec:  # noqa: N801 - it reads as the context manager of the same name in python-flint
    """A context with a working precision of *bits*, for balls of this thread alone.

    >>> from flint import arb
    >>> with workprec(100):
    ...     print(arb(2).sqrt().str(25, radius=False))
    1.414213562373095048801689
    """

    __slots__ = ("_before", "_bits")

    def __init__(self, bits: int) -> None:
        self._bits = bits

    def __enter__(self) -> None:
        LOCK.acquire()
        self._before = ctx.prec
        try:
            ctx.prec = self._bits
        except BaseException:
            LOCK.release()
            raise

    def __exit__(self, *_: object) -> None:
        ctx.prec = self._before
        LOCK.release()
