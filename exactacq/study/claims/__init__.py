"""The paper's claims as executable statements, one for every row of the study."""

from __future__ import annotations

from exactacq.errors import FormatError
from exactacq.study.claims import figure_claims, sightseer, spreader, theorems
from exactacq.study.claims.model import (
    Case,
    Claim,
    Finding,
    Outcome,
    Statement,
    Status,
    Subject,
    Verdict,
    verdict,
)

__all__ = [
    "CLAIMS",
    "Case",
    "Claim",
    "Finding",
    "Outcome",
    "Statement",
    "Status",
    "Subject",
    "Verdict",
    "claim",
    "verdict",
]

CLAIMS: tuple[Claim, ...] = (
    *sightseer.CLAIMS,
    *(c for c in theorems.CLAIMS if c.name == "T1"),
    *spreader.CLAIMS,
    *(c for c in theorems.CLAIMS if c.name != "T1"),
    *figure_claims.CLAIMS,
)
"""All claims: on the Sightseer, on the Seed Spreader, on bounds and figures."""


def claim(name: str) -> Claim:
    """The claim of that name, as "SS-6". Raises `FormatError`, which lists the names, if there is none.

    >>> claim("T2").place
    'Theorem 2, bounds (5), (6) and (9)-(11)'
    """
    for found in CLAIMS:
        if found.name == name:
            return found
    names = ", ".join(c.name for c in CLAIMS)
    raise FormatError(f"no claim {name[:40]!r}; there are {names}")
