"""Libraries that only some formats need, and how to install them."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from exactacq.errors import FormatError


def extra(module: str, name: str) -> Any:
    """A module of an optional library; `FormatError` that names the extra if it is missing."""
    try:
        return import_module(module)
    except ImportError:
        library = module.split(".", maxsplit=1)[0]
        raise FormatError(f"this needs {library}: {installing(name)}") from None


def installing(name: str) -> str:
    """How an extra is installed."""
    return f"in a clone of exactacq, pip install '.[{name}]'"
