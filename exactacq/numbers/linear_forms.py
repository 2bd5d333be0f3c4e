"""Linear forms over atoms, as coefficients by atom: the part of arithmetic that needs no signs.

Sums of square roots of integers and elements of the field that one root of a polynomial generates are
canonical; `exactacq.numbers.real` makes numbers of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from flint import fmpq, fmpq_poly, fmpz, fmpz_poly

from exactacq.numbers.atoms import Atom, Root, rational_sqrt, square_free
from exactacq.numbers.isolation import isolated_roots

Terms: TypeAlias = Mapping[Atom, fmpq]
"""A linear form; no coefficient is 0."""
Field: TypeAlias = tuple[tuple[int, ...], int]
"""Ascending coefficients of an irreducible polynomial, and the index of the root that generates the field."""

CONTENT_BITS = 1 << 11
"""How many bits the coefficients of a form may have together for their content to be taken out."""
ZERO, ONE = fmpq(0), fmpq(1)


def add_to(terms: dict[Atom, fmpq], other: Terms, factor: fmpq = ONE) -> dict[Atom, fmpq]:
    """Add factor * other to *terms*, and return these; the factor is not 0."""
    for atom, c in other.items():
        before = terms.get(atom)
        if before is None:
            terms[atom] = c * factor
        elif total := before + c * factor:
            terms[atom] = total
        else:
            del terms[atom]
    return terms


def short_content(terms: Terms) -> fmpq:
    """The largest rational of which all coefficients are integer multiples; 1 if they are long.

    It may have as many bits as all coefficients together. Where numbers are made of one another, by products
    and roots, they would become three times as long at every step. That roots of multiples of a long form are
    multiples of each other is then told by their fields, not by their forms.
    """
    if sum(c.height_bits() for c in terms.values()) > CONTENT_BITS:
        return ONE
    numerator, denominator = fmpz(0), fmpz(1)
    for c in terms.values():
        numerator, denominator = numerator.gcd(c.p), denominator.lcm(c.q)
    return fmpq(numerator, denominator)


def _nonzero(terms: Terms) -> dict[Atom, fmpq]:
    return {atom: c for atom, c in terms.items() if c}


# -- square roots of integers ----------------------------------------------------------------------


def is_surd(terms: Terms) -> bool:
    """Whether all atoms are square roots of integers."""
    return all(type(atom) is int for atom in terms)


def square_root(q: fmpq) -> dict[Atom, fmpq]:
    """The square root of a positive rational; its two parts are factored apart, as they are coprime."""
    below = int(q.q)
    (over, a), (under, b) = square_free(int(q.p)), square_free(below)
    return {a * b: fmpq(over * under, below)}


def denested(terms: Terms) -> dict[Atom, fmpq] | None:
    """sqrt(p + q sqrt(d)) as a sum of two square roots, where p^2 - q^2 d is a square."""
    if len(terms) != 2 or not is_surd(terms) or 1 not in terms:
        return None
    p = terms[1]
    ((d, q),) = ((a, c) for a, c in terms.items() if a != 1)
    norm = rational_sqrt(p * p - q * q * d)
    if norm is None or p < 0:
        return None
    return add_to(square_root((p + norm) / 2), square_root((p - norm) / 2), ONE if q > 0 else -ONE)


def merged(surds: Terms) -> dict[Atom, fmpq]:
    """Collect radicals that differ by a square factor which trial division did not find."""
    terms: dict[Atom, fmpq] = {}
    for d, c in surds.items():
        for e in terms:
            ratio = rational_sqrt(fmpq(d, e))
            if ratio is not None:
                terms[e] += c * ratio
                break
        else:
            terms[d] = c
    return _nonzero(terms)


# -- roots of polynomials --------------------------------------------------------------------------


def field_of(terms: Terms) -> Field | None:
    """The field of the one root that a form is made of, if it needs no other atoms."""
    field = None
    for atom in terms:
        if isinstance(atom, Root):
            if field is None:
                field = atom.args[:2]
            elif field != atom.args[:2]:
                return None
        elif atom != 1:
            return None
    return field


def polynomial(terms: Terms) -> fmpq_poly:
    """An element of such a field as a polynomial in the root."""
    powers = {0 if isinstance(atom, int) else atom.args[2]: c for atom, c in terms.items()}
    return fmpq_poly([powers.get(k, 0) for k in range(max(powers) + 1)])


def field_element(field: Field, value: fmpq_poly) -> dict[Atom, fmpq]:
    """A polynomial of degree below the field's, evaluated at its root."""
    return {Root.make(*field, k) if k else 1: c for k, c in enumerate(value.coeffs()) if c}


def irreducible_roots(factor: fmpz_poly) -> list[dict[Atom, fmpq]]:
    """The real roots of an irreducible polynomial; closed forms up to degree 2."""
    coefficients = tuple(factor.coeffs())
    if len(coefficients) == 2:
        return [_nonzero({1: fmpq(-coefficients[0], coefficients[1])})]
    if len(coefficients) == 3:
        c, b, a = coefficients
        square = b * b - 4 * a * c
        if square < 0:
            return []
        ((radicand, side),) = square_root(fmpq(square)).items()
        return [_nonzero({radicand: s * side / (2 * a), 1: fmpq(-b, 2 * a)}) for s in (ONE, -ONE)]
    key = tuple(int(c) for c in coefficients)
    return [{Root.make(key, k, 1): ONE} for k in range(len(isolated_roots(key)))]
