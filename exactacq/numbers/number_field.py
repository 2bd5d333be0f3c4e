"""Fields of one and of two roots of polynomials, as first fields of towers of square roots.

Elements of the field of a root of an irreducible integer polynomial are polynomials in the root. Two roots
are polynomials in one number, a sum of them.
"""

from __future__ import annotations

from collections.abc import Collection
from functools import lru_cache
from itertools import count, product

from flint import acb, arb, fmpq, fmpq_mat, fmpq_poly, fmpz, fmpz_poly

from exactacq.cached import cached_property
from exactacq.numbers.atoms import Atom, Root
from exactacq.numbers.fields import RootKey, product_cost
from exactacq.numbers.isolation import isolated_roots
from exactacq.numbers.linear_forms import Terms, polynomial
from exactacq.numbers.precision import workprec

MOST_DEGREE = 8
"""Square roots are not looked for in fields of a higher degree: signs of all conjugates are tried."""
BITS = 128
"""Working bits beyond those of an element's coefficients that are tried first for its roots."""
ROOT_BITS = 256
"""Precision that tells most roots of different polynomials apart."""
MOST_WORK = 1 << 26
"""Bits of an element (see `NumberField.size`) times the square of its field's degree up to which a minimal
polynomial is looked for. The element is taken as it is once it was multiplied by all powers of the root."""
SUMS = 4
"""Products are added up, and each sum is reduced: together that takes so many times longer."""
INVERSE = 3500
"""An inverse costs the field's degree squared times the words of the element to the power 1.5, over this."""
WIDE = 0.25
"""Balls with a smaller radius hold at most one integer."""


class NumberField:
    """The field of real root number *index* of an irreducible polynomial of ascending *coefficients*.

    >>> cubic = NumberField((-2, 0, 0, 1), 0)
    >>> cubic.inverse(fmpq_poly([0, 1]))
    (1/2*x^2, 1)
    >>> cubic.square_root(fmpq_poly([1, 2, 1])), cubic.square_root(fmpq_poly([2]))
    (x + 1, None)
    """

    one = fmpz(1)

    def __init__(self, coefficients: tuple[int, ...], index: int = 0) -> None:
        self.polynomial = fmpz_poly(list(coefficients))
        self.modulus = fmpq_poly(self.polynomial)
        self.degree = self.polynomial.degree()
        self._index = index

    def constant(self, value: int) -> fmpq_poly:
        """An integer as an element."""
        return fmpq_poly([value])

    def of_atom(self, atom: Atom) -> fmpq_poly | None:
        """A power of the root; None for what is not in the field."""
        return fmpq_poly([*[0] * atom.args[2], 1]) if isinstance(atom, Root) else None

    def size(self, a: fmpq_poly) -> int:
        """Bits of an element, roughly."""
        return len(a) * int(a.numer().height_bits() + a.denom().bit_length())

    def times(self, a: fmpq_poly, b: fmpq_poly) -> fmpq_poly:
        """The product of two elements."""
        return a * b % self.modulus

    def lowest(self, parts: dict[int, fmpq_poly], under: fmpz) -> tuple[dict[int, fmpq_poly], fmpz]:
        """Elements over a common denominator, as elements over 1."""
        return (parts, under) if under == 1 else ({m: c / under for m, c in parts.items()}, fmpz(1))

    def cost(self, a: Collection[fmpq_poly], b: fmpq_poly) -> float:
        """What it costs to multiply elements by one, in products of short integers."""
        return SUMS * (product_cost(a, b, self.size) + float(len(a) * (self.degree**2 - 1)))

    def lowest_cost(self, parts: dict[int, fmpq_poly], under: fmpz) -> float:
        """What `lowest` costs."""
        return len(parts)

    def inverse_cost(self, a: fmpq_poly) -> float:
        """What an inverse costs, in products of short integers."""
        return float(self.degree**2 * (self.size(a) >> 6) ** 1.5 / INVERSE)

    def inverse(self, c: fmpq_poly) -> tuple[fmpq_poly, fmpz]:
        """1 over an element that is not 0, as an element and its denominator, which is 1."""
        if c.degree() == 0:
            return fmpq_poly([1 / c[0]]), fmpz(1)
        common, inverse, _ = c.xgcd(self.modulus)
        return inverse / common[0], fmpz(1)

    def square_root(self, c: fmpq_poly) -> fmpq_poly | None:
        """A square root of an element if the field holds one, else None (beyond `MOST_DEGREE` always).

        Let f be the polynomial, a its root, and f(x) / (x - a) = sum of d_i x^i: the d_i are algebraic
        integers. So if s is one too, the traces T_i of s d_i are integers, and s f'(a) = sum of T_i a^i
        (Euler's dual basis).
        """
        if c.degree() <= 0 and c[0] >= 0 and (c[0].p * c[0].q).is_square():
            return fmpq_poly([(c[0].p * c[0].q).isqrt()]) / c[0].q
        if self.degree > MOST_DEGREE:
            return None
        lead = self.polynomial.leading_coefficient()
        # The norm of a square is a square.
        norm = self.polynomial.resultant(c.numer()) * lead ** c.degree() * c.denom() ** self.degree
        if norm < 0 or not norm.is_square():
            return None
        scale = c.denom() * lead ** (self.degree - 1)
        whole = c * scale * scale
        for traces in self._traces(whole.numer()):
            root = fmpq_poly(traces) * self._inverse_slope % self.modulus
            if self.times(root, root) == whole:
                return root / scale
        return None

    @cached_property
    def _inverse_slope(self) -> fmpq_poly:
        return self.inverse(self.modulus.derivative())[0]

    def _traces(self, c: fmpz_poly) -> list[list[fmpz]]:
        """Integers that may be the traces of s d_i with s^2 = c: all that balls leave over."""
        bits = int(c.height_bits()) + BITS
        while True:
            with workprec(bits):
                shares = self._shares(c)
                if shares is None:
                    return []
                if all(sum(share[i].rad() for share in shares) < WIDE for i in range(self.degree)):
                    first, *others = shares
                    signs = product((1, -1), repeat=len(others))
                    return [found for some in signs if (found := self._integers(first, others, some))]
            bits *= 2

    def _integers(self, first: list[arb], others: list[list[arb]], signs: tuple[int, ...]) -> list[fmpz]:
        """The sums of all shares with some signs, empty if one of them is no integer."""
        found: list[fmpz] = []
        for i in range(self.degree):
            total = first[i]
            for share, sign in zip(others, signs, strict=True):
                total = total + share[i] if sign > 0 else total - share[i]
            trace = total.unique_fmpz()
            if trace is None:
                return []
            found.append(trace)
        return found

    def _shares(self, c: fmpz_poly) -> list[list[arb]] | None:
        """What each root of f, with its conjugate, adds to the traces, up to a sign; None if s cannot be.

        The root of what c is there is taken away from the negative axis, where it would jump.
        """
        shares: list[list[arb]] = []
        for place, _ in self.polynomial.complex_roots():
            is_real = place.imag == 0
            value = c(place)
            if is_real and value.real < 0:
                return None
            if is_real or place.imag > 0:
                root = (-value).sqrt() * acb(0, 1) if value.real.mid() < 0 else value.sqrt()
                share, dual = [], acb(self.polynomial[self.degree])
                for k in reversed(range(self.degree)):
                    term = root * dual
                    share.append(term.real if is_real else 2 * term.real)
                    dual = dual * place + self.polynomial[k]
                shares.append(share[::-1])
        return shares

    def minimal_polynomial(self, c: fmpq_poly) -> tuple[int, ...] | None:
        """Ascending coefficients of the irreducible integer polynomial of which an element is a root.

        None where that would take more than a few seconds.
        """
        rows, power = [], c
        for _ in range(self.degree):
            rows.append([power[k] for k in range(self.degree)])
            power = power * fmpq_poly([0, 1]) % self.modulus
        if self.size(power) * self.degree**2 > MOST_WORK:
            return None
        return tuple(int(k) for k in fmpq_mat(rows).minpoly().numer().coeffs())

    def root_number(self, c: fmpq_poly, polynomial: tuple[int, ...]) -> int:
        """Which real root of its minimal polynomial an element is, from the left."""
        roots, bits = list(enumerate(isolated_roots(polynomial))), ROOT_BITS
        while len(roots) > 1:
            with workprec(bits):
                here = self.ball(c, bits)
                roots = [(k, root) for k, root in roots if root.overlaps(here)]
            bits *= 2
        return roots[0][0]

    def _root_ball(self, bits: int) -> arb:
        return Root.make(tuple(map(int, self.polynomial.coeffs())), self._index, 1).ball(bits)

    def ball(self, c: fmpq_poly, bits: int) -> arb:
        """An enclosure of an element, with *bits* working bits that the caller has set."""
        return arb(c[0]) if c.degree() <= 0 else _at(c, self._root_ball(bits))


class JoinedRoots(NumberField):
    """The field of two roots x and y, that of z = x + k y with an integer k.

    Numbers x^i y^j, with exponents below the degrees, span all polynomials in x and y. To multiply by z is a
    matrix T there, and z a zero of the characteristic polynomial of T. If that has no factor twice, the
    powers of z span the same. An irreducible factor of it is the polynomial of z.

    >>> field = JoinedRoots(((-2, 0, 0, 1), 0), ((-3, 0, 0, 1), 0))
    >>> x, y = (field.of_atom(Root.make((-n, 0, 0, 1), 0, 1)) for n in (2, 3))
    >>> field.degree, field.times(x, field.times(x, x)), field.times(y, field.times(y, y))
    (9, 2, 3)
    """

    def __init__(self, one: RootKey, other: RootKey) -> None:
        self._roots = Root.make(*one, 1), Root.make(*other, 1)
        first, second = (fmpq_poly(list(coefficients)) for coefficients, _ in (one, other))
        for k in count(1):
            matrix = _multiplication(first, second, k)
            characteristic = matrix.charpoly()
            if characteristic.gcd(characteristic.derivative()).degree() == 0:
                break
        self._k = k
        super().__init__(tuple(int(c) for c in self._own_factor(characteristic).coeffs()))
        x = self._in_powers(matrix, second.degree())
        self._images = dict(zip((one, other), (x, (fmpq_poly([0, 1]) - x) / k), strict=True))

    def of_atom(self, atom: Atom) -> fmpq_poly | None:
        """A power of a root; None for what is not in the field."""
        if not isinstance(atom, Root) or (image := self._images.get(atom.args[:2])) is None:
            return None
        power = image
        for _ in range(atom.args[2] - 1):
            power = self.times(power, image)
        return power

    def _root_ball(self, bits: int) -> arb:
        one, other = self._roots
        return one.ball(bits) + self._k * other.ball(bits)

    def _own_factor(self, polynomial: fmpq_poly) -> fmpz_poly:
        """The irreducible factor of which z is a root."""
        factors = [factor for factor, _ in polynomial.numer().factor()[1]]
        bits = ROOT_BITS
        while len(factors) > 1:
            with workprec(bits):
                z = self._root_ball(bits)
                factors = [factor for factor in factors if factor(z).contains(0)]
            bits *= 2
        return factors[0]

    def _in_powers(self, matrix: fmpq_mat, degree: int) -> fmpq_poly:
        """x as a polynomial in z, by its coefficients in the powers of z; *degree* is that of y."""
        n = matrix.nrows()
        power, x = (fmpq_mat(n, 1, [fmpq(row == place) for row in range(n)]) for place in (0, degree))
        columns = []
        for _ in range(n):
            columns.append([power[row, 0] for row in range(n)])
            power = matrix * power
        found = fmpq_mat([list(row) for row in zip(*columns, strict=True)]).solve(x)
        return fmpq_poly([found[row, 0] for row in range(n)]) % self.modulus


@lru_cache(maxsize=64)
def joined_roots(one: RootKey, other: RootKey) -> JoinedRoots:
    """The field of two roots, which is made once."""
    return JoinedRoots(one, other)


def _multiplication(first: fmpq_poly, second: fmpq_poly, k: int) -> fmpq_mat:
    """What multiplying by x + k y does with x^i y^j, which has number i * degree(second) + j."""
    d, e = first.degree(), second.degree()
    matrix = fmpq_mat(d * e, d * e)
    for i in range(d):
        for j in range(e):
            images = [(i2 * e + j, c) for i2, c in _next(first, i)]
            images += [(i * e + j2, k * c) for j2, c in _next(second, j)]
            for row, c in images:
                matrix[row, i * e + j] += c
    return matrix


def _next(polynomial: fmpq_poly, i: int) -> list[tuple[int, fmpq]]:
    """The power after x^i of a root, by exponents and coefficients."""
    degree, lead = polynomial.degree(), polynomial.leading_coefficient()
    return [(i + 1, fmpq(1))] if i + 1 < degree else [(m, -polynomial[m] / lead) for m in range(degree)]


def _at(polynomial: fmpq_poly, place: arb) -> arb:
    total = arb(0)
    for coefficient in reversed(polynomial.numer().coeffs()):
        total = total * place + coefficient
    return total / polynomial.denom()


def vanishes_in_parts(terms: Terms) -> bool | None:
    """Whether an element of the field of one root and one of another's add up to 0.

    Then one is minus the other: they have one minimal polynomial, and are the same root of it. No field is
    made that holds both, whose degree would be the product of theirs. None for other forms, and long ones.
    """
    parts: dict[RootKey, dict[Atom, fmpq]] = {}
    for atom, c in terms.items():
        if isinstance(atom, Root):
            parts.setdefault(atom.args[:2], {})[atom] = c
        elif atom != 1:
            return None
    if len(parts) != 2:
        return None
    (one, first), (other, second) = ((NumberField(*key), polynomial(part)) for key, part in parts.items())
    first, second = first + terms.get(1, 0), -second
    least, its_own = one.minimal_polynomial(first), other.minimal_polynomial(second)
    if least is None or its_own is None:
        return None
    if least != its_own:
        return False
    return one.root_number(first, least) == other.root_number(second, least)
