"""Numbers at a generic place: algebraic functions of one transcendental number.

The place after an algebraic length inside an arc is turned by an algebraic angle, not 0, so its coordinates
are transcendental (Lindemann), and what depends on it are algebraic functions f of one number tau. Such an
f(tau) is 0 if and only if f vanishes identically near tau. A function that does not has no more zeros than
its degree, the product of its height as a function and the degree of its radicals; so it is tried at one
rational more than that, all so near to tau that no radical passes 0 on the way.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from math import prod
from typing import TYPE_CHECKING, Any, TypeAlias

from flint import arb, ctx, fmpq

from exactacq.atoms import Generators, Inverse, Node, Product, Sqrt
from exactacq.errors import Undecided
from exactacq.numerals import Enclosing, ball_sign, enclose

if TYPE_CHECKING:
    import sympy

    from exactacq.reals import Real

Vector: TypeAlias = "tuple[Real, Real]"
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

        from exactacq.reals import Real

        return Float(Real.of_atom(self).decimal(SHOWN_DIGITS), SHOWN_DIGITS)


def generic_in(value: Real) -> Generic | None:
    """The transcendental number that a real is made of, if any; `Undecided` if there are several."""
    found = [key for key, _ in value.generators() if isinstance(key, Generic)]
    if len(found) > 1:
        raise Undecided("a relation between several transcendental numbers")
    return found[0] if found else None


def transcendental(real: type[Real], ball: Enclosing) -> Real:
    """A new number from its balls; that it is transcendental is the caller's promise."""
    return real.of_atom(Generic.make(object(), ball))


def turned(radial: Vector, sense: int, length: Enclosing, radius: Enclosing) -> Vector:
    """A vector turned by length / radius, less than two full turns; counterclockwise if *sense* is 1.

    That e to the power of i times the angle is transcendental is the caller's promise.
    """

    def quarter_tangent(bits: int) -> arb:
        return (sense * length(bits) / radius(bits) / 4).tan()

    x, y = radial
    tau = transcendental(type(x), quarter_tangent)
    square = tau * tau
    half_cos, half_sin = (1 - square) / (1 + square), 2 * tau / (1 + square)
    cosine, sine = half_cos * half_cos - half_sin * half_sin, 2 * half_cos * half_sin
    return x * cosine - y * sine, y * cosine + x * sine


def sign_at(value: Real, tau: Generic) -> int:
    """The sign of an algebraic function of *tau*, which balls of moderate precision did not tell."""
    if sign := ball_sign(value.ball(FINE)):
        return sign
    degree = prod(d for key, d in value.generators() if isinstance(key, Sqrt))
    trials = int(degree * _degree(value, {})) + 1
    trial = _Trial.beside(value, tau)
    for k in range(min(trials, MOST_TRIALS)):
        if trial.at(value, k).sign():
            return _refined(value)
    if trials > MOST_TRIALS:
        raise Undecided(f"a number that vanishes at {MOST_TRIALS} of {trials} places")
    return 0


def _refined(value: Real) -> int:
    bits = 512
    while not (sign := ball_sign(value.ball(bits))):
        bits *= 2
    return sign


def _degree(value: Real, known: dict[Node, float]) -> float:
    """The height of a real as a function of the transcendental number: its degree over its radicals'."""
    return sum(_node_degree(atom, known) for atom in value.terms if isinstance(atom, Node))


def _node_degree(node: Node, known: dict[Node, float]) -> float:
    if node not in known:
        if isinstance(node, Generic):
            known[node] = 1.0
        else:
            below = [_degree(arg, known) for arg in _arguments(node)]
            known[node] = sum(below) / (2 if isinstance(node, Sqrt) else 1)
    return known[node]


def _arguments(node: Node) -> tuple[Real, ...]:
    return node.args if isinstance(node, Sqrt | Product | Inverse) else ()  # type: ignore[return-value]


class _Trial:
    """Rationals beside a transcendental number; between *low* and *high* no radical passes 0."""

    def __init__(self, real: type[Real], tau: Generic, bits: int) -> None:
        self.real, self.tau = real, tau
        with ctx.workprec(4 * bits):
            self.low, self.high = enclose(real.of_atom(tau).ball, bits)
            middle, radius = (self.low + self.high) / 2, (self.high - self.low) / 2
            self.around: dict[Node, arb] = {tau: arb(middle, radius)}

    @classmethod
    def beside(cls, value: Real, tau: Generic) -> _Trial:
        """As wide as a real allows: short rationals are decided soon."""
        for bits in NEAR:
            trial = cls(type(value), tau, bits)
            with ctx.workprec(4 * bits):
                if trial._enclosed(value).is_finite():
                    return trial
        raise Undecided("a radical may pass 0 beside a transcendental number")

    def at(self, value: Real, k: int) -> Real:
        """The value of the function at rational number *k*."""
        q = self.low + (self.high - self.low) * fmpq(k + 1, k + 2)
        return _Substitution({self.tau: self.real(q)}).of(value)

    def _enclosed(self, value: Real) -> arb:
        """A ball around all values between low and high; not finite if a radical or a divisor may be 0."""
        total = arb(0)
        for atom, c in value.terms.items():
            total += arb(c) * (self._around(atom) if isinstance(atom, Node) else arb(atom).sqrt())
        return total

    def _around(self, node: Node) -> arb:
        if node not in self.around:
            args = [self._enclosed(arg) for arg in _arguments(node)]
            if isinstance(node, Sqrt):
                self.around[node] = args[0].sqrt() if args[0] > 0 else arb.nan()
            elif isinstance(node, Product):
                self.around[node] = args[0] * args[1]
            elif isinstance(node, Inverse):
                self.around[node] = 1 / args[0]
            else:
                self.around[node] = node.ball(ctx.prec)
        return self.around[node]


class _Substitution:
    """Reals with other numbers in place of some nodes."""

    def __init__(self, known: dict[Node, Real]) -> None:
        self.known = known

    def of(self, value: Real) -> Real:
        """The value of the expression."""
        real = type(value)
        return real.sum(
            (self._node(atom, real) if isinstance(atom, Node) else real.of_atom(atom)) * c
            for atom, c in value.terms.items()
        )

    def _node(self, node: Node, real: type[Real]) -> Real:
        if node not in self.known:
            args = [self.of(arg) for arg in _arguments(node)]
            if isinstance(node, Sqrt):
                self.known[node] = args[0].sqrt()
            elif isinstance(node, Product):
                self.known[node] = args[0] * args[1]
            elif isinstance(node, Inverse):
                self.known[node] = 1 / args[0]
            else:
                self.known[node] = real.of_atom(node)
        return self.known[node]
