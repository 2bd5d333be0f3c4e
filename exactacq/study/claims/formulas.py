"""Formulas in the words of claims: TeX between dollars for the documentation, plain characters elsewhere."""

from __future__ import annotations

import re

_FORMULA = re.compile(r"\$([^$]+)\$")
_SPOKEN = (
    (r"\\lvert S S_1 \\rvert", "S-S1"),
    (r"\\tfrac\{(\w+)\}\{(\w+)\}", r"\1/\2"),
    (r"\\(?:text|mathit)\{(\w+)\}", r"\1"),
    (r"\\lvert ", "|"),
    (r" \\rvert", "|"),
    (r"\\le\b", "<="),
    (r"\\ge\b", ">="),
    (r"\\,", " "),
    (r"\\([a-z]+)", r"\1"),
    (r"\{(\w+)\}", r"\1"),
    (r"\{([^{}]+)\}", r"(\1)"),
)
"""What TeX is in plain words: patterns and replacements, applied one after the other."""


def spoken(text: str) -> str:
    r"""The text with its formulas in plain characters.

    >>> spoken(r"at most $\tfrac{1}{2} \sum n_j (n_j - 1)$, or $\min(R, d_{\max})$ for $n \ge 2$")
    'at most 1/2 sum n_j (n_j - 1), or min(R, d_max) for n >= 2'
    """
    return _FORMULA.sub(lambda found: _plainly(found[1]), text)


def _plainly(formula: str) -> str:
    for pattern, plain in _SPOKEN:
        formula = re.sub(pattern, plain, formula)
    return formula
