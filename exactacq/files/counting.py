"""Numbers of things in notes and messages."""

from __future__ import annotations

import re

_JOINT = re.compile(r"( of | in | without | \()")
"""What follows a noun begins so."""


def count(n: int, noun: str, plural: str = "") -> str:
    """``1 end``, ``2 ends``; the *plural* is that of nouns that have another.

    What follows the noun stays as it is.

    >>> count(1, "open chain"), count(2, "circle of no radius"), count(3, "POLYLINE mesh")
    ('1 open chain', '2 circles of no radius', '3 POLYLINE meshes')
    """
    if n == 1 or plural:
        return f"{n} {noun if n == 1 else plural}"
    head, *rest = _JOINT.split(noun, maxsplit=1)
    ending = "es" if head.lower().endswith(("s", "x", "z", "ch", "sh")) else "s"
    return f"{n} {head}{ending}{''.join(rest)}"
