"""Entries of dataclasses that may be made when they are first read."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

Value = TypeVar("Value")
Kind = TypeVar("Kind", bound=type)


class _Later:
    """A value that is not made yet."""

    def __init__(self, make: Callable[[], object]) -> None:
        self.make = make


def later(make: Callable[[], Value]) -> Value:
    """What stands for the value of a late entry until this is read."""
    return cast(Value, _Later(make))


def late(*names: str) -> Callable[[Kind], Kind]:
    """Let entries of a dataclass that have no defaults be late, if `later` stands for their values."""

    def decorated(kind: Kind) -> Kind:
        for name in names:
            setattr(kind, name, _LateEntry(name))
        return kind

    return decorated


class _LateEntry:
    """An entry that is made when it is first read, and kept, if it is late."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, of: Any, owner: type | None = None) -> Any:
        if of is None:
            return self
        value = of.__dict__[self._name]
        if isinstance(value, _Later):
            value = of.__dict__[self._name] = value.make()
        return value

    def __set__(self, of: Any, value: object) -> None:
        of.__dict__[self._name] = value
