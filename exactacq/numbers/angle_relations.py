"""Multiplicative relations: a sum of angles rewritten over fewer, if possible independent, angles.

By Baker's theorem a sum of angles with algebraic coefficients is 0 if and only if it vanishes over a
Q-basis of its angles and pi. `reduced` comes as near to that as it can, in three steps:

1. relations known by construction: an arc between two directions has the angle arg(end) - arg(start), so
   contiguous arcs of one circle telescope, in whatever pieces it is cut; and angles that are equal though
   written differently are identified;
2. angles with rational cosine and sine: a basis from factors in Z[i] (complete);
3. any others: integer relations proposed by LLL, used only when exact multiplication proves them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from itertools import combinations, pairwise
from math import frexp, gcd, isqrt

from flint import arb, fmpq, fmpz, fmpz_mat

from exactacq.errors import Undecided
from exactacq.numbers.angles import HALF, Angle, AngleSum, Ends
from exactacq.numbers.precision import workprec
from exactacq.numbers.rationals import coprime_base, valuation
from exactacq.numbers.real import FILTER_BITS, Real

RELATION_ANGLES = 12
"""Most angles among which integer relations are sought, to keep LLL and the proofs in milliseconds."""
RELATION_WEIGHT = 64
"""Largest sum of absolute coefficients of a relation that is proved by multiplication."""
READABLE_ANGLES = 256
"""Most angles for which a closed form tries the basis of Z[i], at up to a millisecond an angle."""
FACTOR_BITS = 96
"""Norms up to this size are factored (milliseconds); larger ones are split by greatest common divisors."""


def reduced(form: AngleSum) -> AngleSum:
    """An equal sum over fewer angles; those with rational cosine and sine are independent with pi.

    Raises `Undecided` if a coefficient or a product of cosines cannot be compared with 0.
    """
    return _eliminated(_in_gaussian_basis(_telescoped(_nonzero(form))))


def simplified(form: AngleSum) -> AngleSum:
    """An equal sum over fewer angles, for printing: independent angles only where that leaves fewer."""
    with suppress(Undecided):  # The form as it stands is right, too.
        telescoped = _telescoped(_nonzero(form))
        form = _eliminated(telescoped)
        if 1 < len(form.angles) <= READABLE_ANGLES:
            independent = _eliminated(_in_gaussian_basis(telescoped))
            form = min(form, independent, key=lambda each: len(each.angles))
    return form


def _nonzero(form: AngleSum) -> AngleSum:
    return AngleSum(form.turn, {angle: c for angle, c in form.angles.items() if c.sign() != 0})


def _combination(powers: Mapping[Angle, int]) -> AngleSum:
    return AngleSum(Real(0), {angle: Real(m) for angle, m in powers.items()})


def _quarters(count: int) -> AngleSum:
    return AngleSum(Real(fmpq(count, 2)), {})


def _whole_quarters(form: AngleSum) -> int:
    """form / (pi/2), known to be an integer."""
    bits = FILTER_BITS[0]
    while True:
        with workprec(bits):
            quarters = 2 * form.ball(bits) / arb.pi()
        whole = quarters.unique_fmpz()
        if whole is not None:
            return int(whole)
        bits *= 2


# -- relations known by construction ---------------------------------------------------------------


def _telescoped(form: AngleSum) -> AngleSum:
    """An equal sum over directions instead of angles between directions, wherever that leaves fewer.

    An arc's angle is kept where directions do not cancel: it alone is the same in a turned scene.
    Folding is linear in the arcs; look-ups are quadratic, at nanoseconds each.
    """
    known = (_by_ends(angle, ends) for angle in form.angles for ends in angle.ends)
    relations = [relation for relation in known if relation is not None]
    relations += _coincidences(dict.fromkeys(angle for each in (form, *relations) for angle in each.angles))
    for group in _connected(relations):
        other = _nonzero(_modulo(form, group))
        if _irrational_count(other) < _irrational_count(form):
            form = other
    return form


def _irrational_count(form: AngleSum) -> int:
    """How many angles are left to the proposals of LLL."""
    return sum(angle.half_tangent is None for angle in form.angles)


def _by_ends(angle: Angle, ends: Ends) -> AngleSum | None:
    """angle - arg(end) + arg(start) - k pi/2, which is 0; None if it says nothing or is beyond comparison."""
    radius = Real(ends.norm_sq).sqrt()
    try:
        start, end = (AngleSum.of(x / radius, y / radius, Real(1)) for x, y in (ends.start, ends.end))
    except Undecided:
        return None
    relation = _combination({angle: 1}) - end + start
    relation -= _quarters(_whole_quarters(relation))
    return relation if relation.angles else None


def _coincidences(angles: Iterable[Angle]) -> list[AngleSum]:
    """Differences that are 0, of angles equal in value and different in expression."""
    irrational = [angle for angle in angles if angle.half_tangent is None]
    irrational.sort(key=lambda angle: float(angle.ball(64).mid()))
    equal = []
    for a, b in pairwise(irrational):
        if not a.ball(64) < b.ball(64) and (proved := _proved({a: 1, b: -1})) is not None:
            equal.append(proved)
    return equal


def _connected(relations: list[AngleSum]) -> list[list[AngleSum]]:
    """The relations in groups that have no angle in common."""
    from networkx.utils import UnionFind  # networkx takes long to import

    classes = UnionFind()
    for relation in relations:
        classes.union(*relation.angles)
    groups: dict[Angle, list[AngleSum]] = {}
    for relation in relations:
        groups.setdefault(classes[next(iter(relation.angles))], []).append(relation)
    return list(groups.values())


def _modulo(form: AngleSum, relations: list[AngleSum]) -> AngleSum:
    """The form with one angle eliminated by each independent relation: 0 if the relations say so."""
    solved: list[tuple[Angle, AngleSum]] = []
    kept = form.angles
    for given in relations:
        relation = given
        for pivot, known in solved:
            if pivot in relation.angles:
                relation -= known * relation.angles[pivot]
        candidates = [angle for angle in relation.angles if angle.half_tangent is None]
        if not candidates:
            continue  # It followed from the others, or is left to the basis of Z[i].
        # Angles of the form go first, so that what remains are directions.
        pivot = next((angle for angle in candidates if angle in kept), candidates[0])
        relation *= 1 / relation.angles[pivot]
        solved.append((pivot, relation))
        if pivot in form.angles:
            form -= relation * form.angles[pivot]
    return form


# -- angles with rational cosine and sine: a basis from factors in Z[i] --------------------------


def _in_gaussian_basis(form: AngleSum) -> AngleSum:
    """An equal sum in which angles with rational cosine and sine are replaced by independent ones.

    Such an angle is twice the argument of w = q + i p, tan(angle/2) = p/q. Split the norms of all w
    into coprime factors n; then w is a unit times a power of 1 + i times powers of Gaussian integers
    of norm n, pairwise coprime with each other and with their conjugates, so the angles of the
    quotients g/conj(g) are linearly independent with pi, by unique factorisation.
    """
    simple = [angle for angle in form.angles if angle.half_tangent is not None]
    if not simple:
        return form
    others = {angle: c for angle, c in form.angles.items() if angle.half_tangent is None}
    parts = [AngleSum(form.turn, others)]
    generators: dict[tuple[int, int], AngleSum] = {}
    for angle, powers in _gaussian_powers(simple).items():
        for ideal in powers:
            if ideal not in generators:
                x, y = _generator(*ideal)
                n = ideal[0]
                cosine, sine = Real(fmpq(x * x - y * y, n)), Real(fmpq(2 * x * y, n))
                generators[ideal] = AngleSum.of(cosine, sine, Real(1))
        image = AngleSum.sum(generators[ideal] * Real(e) for ideal, e in powers.items())
        image += _quarters(_whole_quarters(_combination({angle: 1}) - image))
        parts.append(image * form.angles[angle])
    return AngleSum.sum(parts)


def _gaussian_powers(angles: list[Angle]) -> dict[Angle, dict[tuple[int, int], int]]:
    """For each angle the exponents of the ideals (n, r) in w = q + i p, negative for the conjugate.

    The n are pairwise coprime and odd; r is a square root of -1 mod n and (n, r) the ideal of Gaussian
    integers x + i y with x = r y mod n.
    """
    norms, factors = {}, {}
    for angle in angles:
        p, q = int(angle.half_tangent.p), int(angle.half_tangent.q)  # type: ignore[union-attr]
        norm = p * p + q * q
        norms[angle] = norm if norm % 2 else norm // 2
        if norm.bit_length() <= FACTOR_BITS:
            factors[angle] = [int(prime) for prime, _ in fmpz(norms[angle]).factor()]
    large = [angle for angle in angles if angle not in factors]
    if large:
        primes = set().union(*factors.values())
        base = primes | set(_split_large(large, norms, primes))
        for angle in large:
            factors[angle] = [n for n in base if norms[angle] % n == 0]
    result = {}
    for angle in angles:
        powers = {}
        for n in factors[angle]:
            root = _root_of_minus_one(angle, n)
            powers[n, min(root, n - root)] = valuation(norms[angle], n) * (1 if 2 * root < n else -1)
        result[angle] = powers
    return result


def _split_large(angles: list[Angle], norms: Mapping[Angle, int], primes: Iterable[int]) -> list[int]:
    """A coprime base of the norms without *primes*, fine enough that all roots of -1 agree up to sign.

    Quadratic in the number of angles, which are those with norms beyond `FACTOR_BITS`.
    """
    rests = []
    for angle in angles:
        rest = norms[angle]
        for prime in primes:
            rest //= prime ** valuation(rest, prime)
        rests.append((rest, _root_of_minus_one(angle, rest)))
    numbers = [n for n, _ in rests]
    for (m, r), (n, s) in combinations(rests, 2):
        common = gcd(m, n)
        numbers += [gcd(common, r - s), gcd(common, r + s)]
    return coprime_base(numbers)


def _root_of_minus_one(angle: Angle, n: int) -> int:
    u = angle.half_tangent
    return int(u.q) * pow(int(u.p), -1, n) % n  # type: ignore[union-attr]


def _generator(n: int, root: int) -> tuple[int, int]:
    """(x, y) with x^2 + y^2 = n and x = root y mod n, for root^2 = -1 mod n (Hermite, Serret)."""
    (a, s), (b, t) = (n, 0), (root, 1)
    while b > isqrt(n):
        quotient = a // b
        (a, s), (b, t) = (b, t), (a - quotient * b, s - quotient * t)
    return b, t


# -- angles with algebraic cosine and sine: proposed and proved relations ------------------------


def _eliminated(form: AngleSum) -> AngleSum:
    """An equal sum without terms of coefficient 0 and without angles that are proved to be dependent."""
    form = _nonzero(form)
    for bundle in _bundles(form.angles):
        while (relation := _relation([angle for angle in bundle if angle in form.angles])) is not None:
            # The relation is a sum that is 0: subtract the multiple that cancels one angle.
            weights = {a: abs(m) for a, m in relation.angles.items() if a.half_tangent is None}
            pivot = min(weights, key=lambda angle: weights[angle])
            form = _nonzero(form - relation * (form.angles[pivot] / relation.angles[pivot]))
    return form


def _bundles(angles: Mapping[Angle, Real]) -> list[list[Angle]]:
    """The sets in which relations are sought: all angles if few, else those of commensurable radii."""
    if len(angles) <= RELATION_ANGLES:
        return [list(angles)]
    bundles: list[tuple[Real, list[Angle]]] = []
    for angle, c in angles.items():
        for first, bundle in bundles:
            if c.rational_ratio(first) is not None:
                bundle.append(angle)
                break
        else:
            bundles.append((c, [angle]))
    return [bundle for _, bundle in bundles if len(bundle) <= RELATION_ANGLES]


def _relation(angles: list[Angle]) -> AngleSum | None:
    """A proved sum ``m_1 t_1 + ... + m_k t_k - j pi/2 = 0`` with an irrational t_i, or None."""
    if all(angle.half_tangent is not None for angle in angles):
        return None
    size = len(angles) + 1
    # Of tiny angles as many bits as of others: else any multiple of theirs is 0 in the lattice.
    bits = 64 * size + max(-frexp(float(angle.ball(64)))[1] for angle in angles)
    rows = [[int(i == k) for i in range(size - 1)] for k in range(size)]
    with workprec(bits + 64):
        for angle, row in zip(angles, rows, strict=False):
            share = 2 * angle.ball(bits + 64) / arb.pi()
            row.append(int((share.mid() * fmpz(2) ** bits).floor().unique_fmpz()))
    rows[-1].append(1 << bits)
    # A chance relation has coefficients of about 64 bits: the light rows are worth a proof.
    for row in fmpz_mat(rows).lll().tolist():
        powers = {angle: int(m) for angle, m in zip(angles, row, strict=False) if m}
        weight = sum(abs(m) for m in powers.values())
        if weight and weight <= RELATION_WEIGHT and (proved := _proved(powers)) is not None:
            return proved
    return None


def _proved(powers: Mapping[Angle, int]) -> AngleSum | None:
    """The sum of m t minus its multiple of pi/2 if the product of e^{i m t} proves it to be 0."""
    if all(angle.half_tangent is not None for angle in powers):
        return None
    total = _combination(powers)
    with workprec(FILTER_BITS[-1]):
        share = 2 * total.ball(FILTER_BITS[-1]) / arb.pi()
        whole = int((share.mid() + HALF).floor().unique_fmpz())
        if not abs(share - whole) < arb(2) ** -128:
            return None
    left = _unit_product((angle, m) for angle, m in powers.items() if m > 0)
    right = _unit_product((angle, -m) for angle, m in powers.items() if m < 0)
    for _ in range(whole % 4):
        right = (-right[1], right[0])
    # Both are points of the unit circle, closer than 2^-100: one coordinate decides, where it is steep.
    flat = next((i for i in (0, 1) if abs(left[i].ball(128)) > HALF), None)
    try:
        proved = flat is not None and left[1 - flat] == right[1 - flat]
    except Undecided:
        return None
    return total - _quarters(whole) if proved else None


def _unit_product(powers: Iterable[tuple[Angle, int]]) -> tuple[Real, Real]:
    """Cosine and sine of the sum of m t."""
    x, y = Real(1), Real(0)
    for angle, exponent in powers:
        c, s = angle.cosine, angle.sine
        for bit in range(exponent.bit_length()):
            if bit:
                c, s = c * c - s * s, 2 * c * s
            if exponent >> bit & 1:
                x, y = x * c - y * s, x * s + y * c
    return x, y
