"""`functools.cached_property` as it is from Python 3.12 on: without a lock.

Before, all objects of a class share a lock, held while a value is computed: threads wait for each other, and
to take it is slower than to compute most values.
"""

from __future__ import annotations

import sys
from functools import cached_property
from typing import TYPE_CHECKING, Any

if not TYPE_CHECKING and sys.version_info < (3, 12):

    class cached_property(cached_property):  # noqa: N801 - it stands for the one of the same name
        """A value that is computed when it is first read, and then kept as an attribute of the object."""

        def __get__(self, instance: Any, owner: type | None = None) -> Any:
            if instance is None:
                return self
            value = instance.__dict__[self.attrname] = self.func(instance)
            return value


__all__ = ["cached_property"]
