"""Ports: how an object offers what a package above it makes, such as its picture.

A module imports only from below, so a scene cannot import what draws it. It looks up a function here, by the
port's name; the package's `__init__` registers that function, and its module is loaded on first use.
"""

from importlib import import_module

TYPE_CHECKING = False  # The package begins with this file, so it does not wait for typing.
if TYPE_CHECKING:
    from typing import Any

SVG, JSON, PLAYER = "svg", "json", "player"
_MAKERS: dict[tuple[str, str], tuple[str, str]] = {}


def offer(port: str, kind: str, module: str, function: str) -> None:
    """Name the function that makes from an object what a port gives; *kind* is its type's full name."""
    _MAKERS[port, kind] = module, function


def made(port: str, value: object) -> "Any":
    """What a port of an object gives. Only types that `offer` names, and types derived from them, have it."""
    kinds = ((port, f"{kind.__module__}.{kind.__qualname__}") for kind in type(value).__mro__)
    module, function = next(_MAKERS[kind] for kind in kinds if kind in _MAKERS)
    return getattr(import_module(module), function)(value)
