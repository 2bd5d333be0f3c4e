"""What is kept of a file while it is read several times, with other options each time."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

T = TypeVar("T")

_KEPT: ContextVar[dict[Hashable, Any] | None] = ContextVar("_KEPT", default=None)


@contextmanager
def rereading() -> Iterator[None]:
    """Within this context `once` makes nothing twice."""
    token = _KEPT.set({})
    try:
        yield
    finally:
        _KEPT.reset(token)


def once(key: Hashable, make: Callable[[], T]) -> T:
    """What is made of what the key names: as it was made before within `rereading`, else anew.

    >>> with rereading():
    ...     once("text", list) is once("text", list)
    True
    >>> once("text", list) is once("text", list)
    False
    """
    kept = _KEPT.get()
    if kept is None:
        return make()
    if key not in kept:
        kept[key] = make()
    found: T = kept[key]
    return found
