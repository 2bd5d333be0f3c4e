"""Pausing the interpreter's search for cyclic garbage.

A run makes millions of small objects that live as long as it. It leaves no cycles, and once it is dropped it
is freed without a search (tests see to both). Without a pause the interpreter walks through all of them
again and again: a sixth of the time, more in larger scenes.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def uncollected() -> Iterator[None]:
    """No search for cyclic garbage meanwhile (of the whole process), if there is one. Also a decorator.

    Where the pauses of two threads overlap, the search goes on as soon as the one that stopped it ends.
    """
    searching = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if searching:
            gc.enable()
