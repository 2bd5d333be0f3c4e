"""Faults planted into numbers and lengths, each with a case that shows it."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import test_length_oracle as length_oracle
import test_number_oracle as number_oracle
from matrix_numbers import LARGE, LARGER, Tree, mp, q
from moebius import Bow, Spot
from planted_geometry import root_spot, spot
from planting import Fault, Law, Planted
from test_length_oracle import Relation, Tie, gauss

from exactacq.geometry import curves
from exactacq.numbers import (
    angle_relations,
    angles,
    between,
    exact,
    function_zeros,
    length,
    linear_forms,
    quotient,
    real,
    tower,
)
from exactacq.numbers import sign as signs

TIES = Law(number_oracle.check_tie, number_oracle.ties(number_oracle.numbers), 3000)
ROOTS = Law(number_oracle.check_roots, number_oracle.products(), 1200)
FIELDS = Law(number_oracle.check_field, number_oracle.field_cases, 1200)
ROUNDING = Law(number_oracle.check_rounding, number_oracle.halves(), 800)
ANGLES = Law(length_oracle.check_tie, length_oracle.ties(surds=False), 1200)
SURDS = Law(length_oracle.check_tie, length_oracle.ties(surds=True), 300)
SUMS = Law(length_oracle.check_sum, length_oracle.sums(), 1000)
CUTS = Law(length_oracle.check_cuts, length_oracle.cuts(), 600)


def sqrt(value: Tree | int) -> Tree:
    return ("sqrt", q(value) if isinstance(value, int) else value)


def plus(left: Tree, right: Tree) -> Tree:
    return ("+", left, right)


def minus(left: Tree, right: Tree) -> Tree:
    return ("-", left, right)


def tied(left: Tree, right: Tree, hair: Fraction = Fraction(0), made: int = 0) -> Any:
    return left, right, hair, made


def turned(*factors: tuple[Any, int]) -> Tie:
    """A relation of directions with their multiples: the first on one side, the others on the other."""
    return Tie((Relation(factors, "1"),), 1, Fraction(0), "number")


def cut_at(*spots: Spot, ccw: bool) -> tuple[tuple[Bow, ...], Bow]:
    """A circle of squared radius 6 about the origin, cut at places that are told in its sense."""
    rest = spots[1:] + spots[:1]
    arcs = tuple(Bow(spot((0, 0)), Fraction(6), p, r, ccw) for p, r in zip(spots, rest, strict=True))
    return arcs, arcs[0]._replace(end=None)


NESTED = sqrt(plus(q(2), sqrt(2)))
HAIR, NEAR = Fraction(1, 10**100), Fraction(1, 10**20)

NUMBER_FAULTS = [
    Planted(
        "nested roots that 64 bits do not tell apart are equal",
        TIES,
        tied(plus(q(2), sqrt(2)), plus(q(2), sqrt(2)), HAIR, made=4),
        Fault(real, "Real._against", "return (self * self - right * right).sign()", "return 0"),
    ),
    Planted(
        "of late numbers the one in the left ball is the larger",
        TIES,
        tied(NESTED, NESTED, made=3),
        Fault(
            real,
            "Real.compare",
            "if self._ball < other._ball",
            "if self._ball > other._ball",
        ),
    ),
    Planted(
        "late numbers whose balls meet do not overlap",
        TIES,
        tied(NESTED, NESTED, made=2),
        Fault(real, "Real.overlaps", "if late and not self", "if late and self"),
    ),
    Planted(
        "what is below 2^-256 is 0",
        TIES,
        tied(sqrt(sqrt(8)), sqrt(sqrt(sqrt(64))), HAIR**2),
        Fault(signs, "decided_sign", "arb(2) ** -limit", "arb(2) ** -256"),
    ),
    Planted(
        "signs are those of balls of 256 bits",
        TIES,
        tied(sqrt(2), sqrt(2), HAIR),
        Fault(signs, "decided_sign", "while not (sign := ball_sign(value.ball(bits))):", "while sign := 0:"),
    ),
    Planted(
        "a difference of roots is denested to their sum",
        TIES,
        tied(minus(sqrt(2), q(1)), sqrt(minus(q(3), sqrt(8)))),
        Fault(linear_forms, "denested", "ONE if q > 0 else -ONE", "ONE"),
    ),
    Planted(
        "radicals that differ by the square of a large prime are added as they are",
        TIES,
        tied(sqrt(LARGER * LARGE**2), ("*", q(LARGE), sqrt(LARGER))),
        Fault(linear_forms, "merged", "terms[e] += c * ratio", "terms[e] += c + ratio"),
    ),
    Planted(
        "a conjugate is not the inverse times the norm",
        TIES,
        tied(("/", q(1), plus(sqrt(2), q(1))), minus(sqrt(2), q(1))),
        Fault(real, "Real._inverse", "p * p * a - q * q * b", "p * p * a + q * q * b"),
    ),
    Planted(
        "between two numbers lies the smaller",
        TIES,
        tied(sqrt(2), sqrt(2), HAIR),
        Fault(between, "_dyadic_between", "(low + high) / 2", "low"),
    ),
    Planted(
        "equal numbers are not at most each other",
        TIES,
        tied(sqrt(2), sqrt(2)),
        Fault(exact, "Exact.__le__", "order <= 0", "order < 0"),
    ),
    Planted(
        "a root that the field holds may be the negative one",
        FIELDS,
        ((17, 5, -1), (HAIR, Fraction(1), Fraction(1), Fraction(-2)), (Fraction(1),) * 4, Fraction(0)),
        Fault(tower, "Tower._radical", "self._scaled(root, self._sign(root))", "root"),
    ),
    Planted(
        "a quadratic has one root",
        ROOTS,
        ([Fraction(-2), Fraction(0), Fraction(1)], [-mp.sqrt(2), mp.sqrt(2)]),
        Fault(linear_forms, "irreducible_roots", "for s in (ONE, -ONE)", "for s in (ONE,)"),
    ),
    Planted(
        "double roots count twice",
        ROOTS,
        ([Fraction(1), Fraction(-2), Fraction(1)], [mp.mpf(1)]),
        Fault(
            function_zeros,
            "roots",
            "for factor, _ in whole.factor()[1] for",
            "for factor, n in whole.factor()[1] for _ in range(n) for",
        ),
    ),
    Planted(
        "roots of different factors are not sorted",
        ROOTS,
        ([Fraction(-6), Fraction(3), Fraction(2), Fraction(-1)], [-mp.sqrt(3), mp.sqrt(3), mp.mpf(2)]),
        Fault(function_zeros, "roots", "return sorted(", "return list("),
    ),
    Planted(
        "a tie is rounded up",
        ROUNDING,
        (q(0), Fraction(5, 2), Fraction(0)),
        Fault(exact, "Exact.__round__", "below < 0 or (below == 0 and nearest % 2)", "below < 0"),
    ),
]

MACHIN = (*[(gauss(1, (5, 0), (1, 0)), 1)] * 4, (gauss(1, (239, 0), (1, 0)), -1))
"""(5 + i)^4 / (239 + i), whose angle is an eighth of a turn."""

EAST, NORTH = root_spot(0, 0, 6, 1, 0), root_spot(0, 0, 6, 0, 1)

LENGTH_FAULTS = [
    Planted(
        "angles below the axis are those above",
        ANGLES,
        turned((gauss(1, (2, 0), (1, 0)), -1)),
        Fault(angles, "folded", "TWO, -sign, -sine", "TWO, sign, -sine"),
    ),
    Planted(
        "what is left to a factor's angle is doubled",
        ANGLES,
        turned(*MACHIN),
        Fault(angle_relations, "_in_gaussian_basis", "_quarters(_whole", "_quarters(2 * _whole"),
    ),
    Planted(
        "conjugate factors are one",
        ANGLES,
        turned((gauss(1, (-1, 0), (2, 0)), 3)),
        Fault(angle_relations, "_gaussian_powers", "(1 if 2 * root < n else -1)", "1"),
    ),
    Planted(
        "a sum that is a small turn is 0",
        ANGLES,
        Tie((Relation(MACHIN, "sqrt 2"),), 1, HAIR, "turn"),
        Fault(length, "Length._decide_sign", "return turn", "return 0"),
    ),
    Planted(
        "equal angles of a sum are counted once",
        ANGLES,
        turned(*MACHIN),
        Fault(angles, "AngleSum.sum", "Real.sum(cs)", "cs[0]"),
    ),
    Planted(
        "quarter turns are halves in proofs",
        SURDS,
        turned((gauss(2, (-1, -1), (-1, 2)), 3)),
        Fault(angle_relations, "_proved", "range(whole % 4)", "range(whole % 2)"),
    ),
    Planted(
        "what is proposed of angles is believed",
        SURDS,
        Tie((Relation(((gauss(2, (1, 0), (0, 1)), 1),), "1"),), 1, HAIR, "direction"),
        Fault(angle_relations, "_proved", "left[1 - flat] == right[1 - flat]", "True"),
    ),
    Planted(
        "an angle close to a fraction of pi is that",
        SURDS,
        turned((gauss(3, (0, 1), (1 + NEAR, 0)), 1), (gauss(3, (0, 1), (1, 0)), -1)),
        Fault(angles, "_share_of_pi", "if value.sign() == 0 else None", ""),
    ),
    Planted(
        "a negative divisor does not turn the order round",
        SUMS,
        ([(gauss(1, (2, 0), (1, 0)), Fraction(-1), "1")], Fraction(-1)),
        Fault(quotient, "Quotient._against", " * self._sign", ""),
    ),
    Planted(
        "a sum ends with its first angle",
        SUMS,
        ([(z, Fraction(m), "1") for z, m in MACHIN], Fraction(0)),
        Fault(length, "Length.sum", "part._angular for part in parts", "part._angular for part in parts[:2]"),
    ),
    Planted(
        "a clockwise arc is as long as what it leaves of its circle",
        CUTS,
        cut_at(EAST, NORTH, ccw=False),
        Fault(curves, "Arc.length", " if self.ccw else (self.end, self.start)", ""),
    ),
    Planted(
        "the directions that an angle remembers are exchanged",
        CUTS,
        cut_at(root_spot(0, 1, 5, 1, 0), root_spot(-2, 0, 2, 0, 1), root_spot(-1, 0, 5, 0, -1), ccw=True),
        Fault(length, "Length.between", "else Ends(end, start, norm_sq)", "else Ends(start, end, norm_sq)"),
    ),
    Planted(
        "a full circle is a half",
        CUTS,
        cut_at(EAST, NORTH, ccw=True),
        Fault(curves, "Arc.length", "Length.turns(self.radius)", "Length.turns(self.radius, '1/2')"),
    ),
]
