"""Numbers at a generic place: algebraic functions of one transcendental number.

The place after an algebraic length inside an arc is turned by an algebraic angle, not 0, so its coordinates
are transcendental (Lindemann), and what depends on it are algebraic functions f of one number tau. Such an
f(tau) is 0 if and only if f vanishes identically near tau. A function that does not has no more zeros than
its degree, the product of its height as a function and the degree of its radicals; so it is tried at one
rational more than that, all so near to tau that no radical passes 0 on the way. Most need no trial: a tower
of square roots (`exactacq.numbers.tower`) shows that they vanish.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import partial
from math import prod
from typing import TYPE_CHECKING, Any, TypeVar, cast
from uuid import uuid4

from flint import arb, ctx, fmpq

from exactacq.errors import Undecided
from exactacq.numbers.atoms import Atom, Form, Generators, Inverse, Node, Product, Sqrt, atom_ball
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import Enclosing, ball_sign, decimal_string, enclose

if TYPE_CHECKING:
    import sympy

R = TypeVar("R", bound=Form)
"""The type of real numbers, which stands above."""
NEAR = (24, 100, 400)
"""The rationals that are tried differ from tau by less than 2 to the minus one of these."""
FINE = 4096
"""Precision that is tried before a proof of 0."""
MOST_TRIALS = 1 << 12
SHOWN_DIGITS = 30
"""Decimals that stand for a number where a closed form is asked for."""


class Generic(Node):
    """A transcendental number: a name that tells it from others, and a function that encloses it."""

    __slots__ = ()
    args: tuple[Hashable, Callable[[int], arb]]

    @classmethod
    def make(cls, *args: Any) -> Node:
        """Of a name and a function that gives a ball for a number of working bits."""
        return cls._intern((cls, args[0]), args)

    def _evaluate(self, bits: int) -> arb:
        return self.args[1](bits)

    def _bound(self) -> float:
        return 0.0

    def _collect(self) -> Generators:
        return frozenset({(self, 1)})

    def sympy(self) -> sympy.Expr:
        """A decimal: there is no closed form."""
        from sympy import Float

        return Float(decimal_string(self.precise_ball, SHOWN_DIGITS), SHOWN_DIGITS)


def generic_in(value: Form) -> Generic | None:
    """The transcendental number that a real is made of, if any; `Undecided` if there are several."""
    found = [key for key, _ in value.generators() if isinstance(key, Generic)]
    if len(found) > 1:
        raise Undecided("a relation between several transcendental numbers")
    return found[0] if found else None


def transcendental(real: type[R], ball: Enclosing) -> R:
    """A new number from its balls; that it is transcendental is the caller's promise."""
    # The name is no other number's, in a process that the number is sent to neither.
    made: R = cast(Any, real).of_atom(Generic.make(uuid4(), ball))
    return made


def turned(radial: tuple[R, R], sense: int, length: Enclosing, radius: Enclosing) -> tuple[R, R]:
    """A vector turned by length / radius, less than two full turns; counterclockwise if *sense* is 1.

    That e to the power of i times the angle is transcendental is the caller's promise.
    """
    x, y = cast("tuple[Any, Any]", radial)
    tau = transcendental(type(x), partial(_quarter_tangent, sense, length, radius))
    square = tau * tau
    half_cos, half_sin = (1 - square) / (1 + square), 2 * tau / (1 + square)
    cosine, sine = half_cos * half_cos - half_sin * half_sin, 2 * half_cos * half_sin
    return x * cosine - y * sine, y * cosine + x * sine


def _quarter_tangent(sense: int, length: Enclosing, radius: Enclosing, bits: int) -> arb:
    return (sense * length(bits) / radius(bits) / 4).tan()


def sign_at(value: Form, tau: Generic) -> int:
    """The sign of an algebraic function of *tau*, which balls of moderate precision did not tell."""
    if sign := ball_sign(value.ball(FINE)):
        return sign
    degree = prod(d for key, d in value.generators() if isinstance(key, Sqrt))
    trials = int(degree * _degree(value, {})) + 1
    low, high = _beside(value, tau)
    real: Any = type(value)
    for k in range(min(trials, MOST_TRIALS)):
        place = real(low + (high - low) * fmpq(k + 1, k + 2))
        if _evaluated(value, {tau: place}, real.of_atom).sign():
            return _refined(value)
    if trials > MOST_TRIALS:
        raise Undecided(f"a number that vanishes at {MOST_TRIALS} of {trials} places")
    return 0


def _refined(value: Form) -> int:
    bits = 512
    while not (sign := ball_sign(value.ball(bits))):
        bits *= 2
    return sign


def _beside(value: Form, tau: Generic) -> tuple[fmpq, fmpq]:
    """Rationals around tau between which no radical and no divisor passes 0.

    As far apart as the value allows: short rationals are decided soon.
    """
    for bits in NEAR:
        with workprec(4 * bits):
            low, high = enclose(tau.precise_ball, bits)
            around = arb((low + high) / 2, (high - low) / 2)
            if _evaluated(value, {tau: around}, lambda atom: atom_ball(atom, ctx.prec)).is_finite():
                return low, high
    raise Undecided("a radical may pass 0 beside a transcendental number")


def _evaluated(value: Form, known: dict[Atom, Any], leaf: Callable[[Atom], Any]) -> Any:
    """The value of an expression where some atoms are *known* to be other numbers, Reals or balls.

    *leaf* gives other atoms that are made of no reals; what is made of them becomes known.
    """
    total = 0
    for atom, c in value.terms.items():
        if atom not in known:
            args = [_evaluated(arg, known, leaf) for arg in _arguments(atom)]
            if isinstance(atom, Sqrt):
                known[atom] = _root(args[0])
            elif isinstance(atom, Product):
                known[atom] = args[0] * args[1]
            elif isinstance(atom, Inverse):
                known[atom] = 1 / args[0]
            else:
                known[atom] = leaf(atom)
        total += known[atom] * c
    return total


def _root(square: Any) -> Any:
    """The square root; not finite for a ball that may hold 0."""
    return arb.nan() if isinstance(square, arb) and not square > 0 else square.sqrt()


def _degree(value: Form, known: dict[Atom, float]) -> float:
    """The height of a real as a function of the transcendental number: its degree over its radicals'."""
    for atom in value.terms:
        if atom not in known:
            below = sum(_degree(arg, known) for arg in _arguments(atom))
            known[atom] = 1.0 if isinstance(atom, Generic) else below / 2 if isinstance(atom, Sqrt) else below
    return sum(known[atom] for atom in value.terms)


def _arguments(atom: Atom) -> tuple[Form, ...]:
    return atom.args if isinstance(atom, Sqrt | Product | Inverse) else ()
