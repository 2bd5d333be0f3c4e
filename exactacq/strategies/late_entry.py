"""Entries of dataclasses that may be made when they are first asked for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, TypeVar, cast

Value = TypeVar("Value")


class _Later(Generic[Value]):
    """A value that is not made yet."""

    def __init__(self, make: Callable[[], Value]) -> None:
        self.make = make


def later(make: Callable[[], Value]) -> Value:
    """What stands for a value of a `LateEntry` until this is read."""
    return cast(Value, _Later(make))


class LateEntry(Generic[Value]):
    """An entry that is made when it is first read, and kept, if it is given by `later`."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, of: Any, owner: type | None = None) -> Value:
        if of is None:
            raise AttributeError(self._name)  # An entry without a default.
        value = of.__dict__[self._name]
        if isinstance(value, _Later):
            value = of.__dict__[self._name] = value.make()
        made: Value = value
        return made

    def __set__(self, of: Any, value: Value) -> None:
        of.__dict__[self._name] = value
