"""How tight the corrected bounds are: closed forms of families, their limits, and what members' runs walk."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from formulas import (
    HALF,
    PRINTED,
    i,
    is_same,
    n,
    ns,
    p_max,
    pairs,
    perimeters,
    radius,
)
from nightly import some
from sympy import Expr, Min, Rational, Symbol, expand, limit, oo, sqrt, summation, symbols

from exactacq import Length
from exactacq.files import gallery
from exactacq.study.claims.model import Case, Subject
from exactacq.study.claims.spreader import pockets
from exactacq.study.claims.tallies import Tally, bounds_of, straight_length
from exactacq.study.claims.tight_families import arms, hooks, relay, rods, slabs
from exactacq.study.claims.tightness import YARDSTICKS, Portion, Reach, Yardstick, best

k, m = Symbol("k", integer=True, positive=True), Symbol("m", integer=True, positive=True)
ell, eps = symbols("ell epsilon", positive=True)
THICK, CRUMB = Rational(1, 10), Rational(1, 5)
"""h or d of rods, arms and hooks; q, the perimeter of a crumb beside a rod."""
CLEAR, AT_BORDER = (3 * HALF, HALF), (Rational(3), Rational(1))
"""What Theorem 2 charges for an acquisition and for a passing, in perimeters."""
READ_ME = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
ROWS = [
    [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
    for line in READ_ME.partition("| bound | ratio of |")[2].split("\n\n")[0].splitlines()[2:]
]
"""The cells of the table of bounds in the read-me, row by row."""


@cache
def case(make: Callable[..., object], *sizes: object, **more: object) -> Case:
    return Case(make(*sizes, **more))


def exact(length: Length) -> Expr:
    return length.sympy()


def theorem_1(count: Expr, around: Expr, last: Expr, most: Expr) -> Expr:
    """The corrected bound for a start on an obstacle and links as long as R = 1."""
    return (2 * count - 3) + 3 * HALF * around - last / 2 + (count - 2) * most / 2


def theorem_2(charges: tuple[Expr, Expr], reach: Expr, crossing: Expr, around: Expr, most: Expr) -> Expr:
    """The corrected bound less the M-line, where nothing is met again and no way is far."""
    each, passing = charges
    mixed = passing * (2 * n * crossing * most + most * pairs)
    return 2 * n * reach + each * around + mixed


def test_theorem_2_as_it_is_used_here_is_6_and_10_less_the_m_line() -> None:
    line = PRINTED["(8)"]
    for charges, name in ((AT_BORDER, "(6)"), (CLEAR, "(10)")):
        assert is_same(line + theorem_2(charges, radius, ns[0], perimeters, p_max), PRINTED[name])


# -- rods ------------------------------------------------------------------------------------------


def rod_tour() -> tuple[Expr, Expr]:
    """P of a rod with n - 1 crumbs, and the corrected Theorem 1 for it."""
    around = 2 * (ell + THICK)
    walks = ell + summation(ell - 2 * (i - 1), (i, 1, n - 2))
    tour = around + walks + (2 * n - 3) + (n - 1) * CRUMB
    return expand(tour), expand(theorem_1(n, around + (n - 1) * CRUMB, CRUMB, around))


def test_what_a_rod_spares_does_not_grow_with_it() -> None:
    tour, bound = rod_tour()
    assert is_same(bound - tour, (n - 1) * THICK + (n - 2) * (n - 3) + (n - 2) * CRUMB / 2)
    assert limit(tour / bound, ell, oo) == 1
    printed = bound + 1 + CRUMB / 2
    assert limit(tour / printed, ell, oo) == 1


@pytest.mark.parametrize(("count", "length"), [(2, 10), (3, 10), (4, 40), (5, 100), (6, 1000), (9, 20)])
def test_tours_of_rods(count: int, length: int) -> None:
    run = case(rods, count, length).sightseer
    sizes = {n: count, ell: length}
    tour, bound = (form.subs(sizes) for form in rod_tour())
    assert (exact(run.length), exact(bounds_of(run)["T1 corrected"])) == (tour, bound)
    assert exact(bounds_of(run)["(2)"]) == bound + 1 + CRUMB / 2
    assert run.visits == tuple(range(count))


def test_a_short_rod_is_refused() -> None:
    with pytest.raises(ValueError, match="at least 10 long"):
        rods(4, 9)


def test_2_is_true_as_printed_from_two_obstacles_on() -> None:
    """(2) less the corrected bound, with links and the way from S at most R: at least p_last / 2."""
    short, near, last, around, most = symbols("short near p_last p p_max", nonnegative=True)
    printed = 2 * (n - 1) * radius + 3 * HALF * around + (n - 2) * most / 2
    links = (2 * n - 3) * (radius - short)
    corrected = (radius - near) + links + 3 * HALF * around - last / 2 + (n - 2) * most / 2
    assert is_same(printed - corrected, near + (2 * n - 3) * short + last / 2)
    for name in ("figure1", "figure2", "circles", "squares", "m8", "m11", "tight-t1"):
        found = case(gallery.scene, name)
        assert found.is_mutually_visible
        assert found.sightseer.length < bounds_of(found.sightseer)["(2)"]


# -- pockets ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [1, 2, 3])
def test_ways_to_pockets_are_2_r_long(count: int) -> None:
    run = case(pockets, count).spreader
    assert len(run.diversions) == count
    assert all(straight_length(run, d) == Length(40) for d in run.diversions)
    loops = Length.sum(body.perimeter for body in run.obstacles)
    assert run.length == bounds_of(run)["(8)"] + Length(40 * count) + loops


# -- slabs -----------------------------------------------------------------------------------------


GAP = 1 / n**2


def slab(number: Expr) -> tuple[Expr, Expr, Expr]:
    """How far from T a slab is, half of its length, and its perimeter."""
    step = (number - 1) * GAP
    thick = GAP / 2
    return 10 + step, 5 + step, 4 * (5 + step) + 2 * thick + 10 * thick / 6


def slab_sweep() -> tuple[Expr, Expr]:
    """P and the corrected Theorem 2, both less the M-line, for n slabs."""
    far, half, around = slab(i)
    ways = summation(expand(2 * far + around), (i, 1, n))
    passings = summation(expand((n - i) * 4 * half), (i, 1, n))
    bound = theorem_2(CLEAR, 20, 0, summation(expand(around), (i, 1, n)), slab(n)[2])
    return expand(ways + passings), expand(bound.subs(pairs, n * (n - 1)))


def test_slabs_come_as_near_to_theorem_2_as_one_likes() -> None:
    sweep, bound = slab_sweep()
    assert limit(sweep / n**2, n, oo) == limit(bound / n**2, n, oo) == 10
    assert limit(sweep / bound, n, oo) == 1
    assert limit((80 + sweep) / (80 + bound), n, oo) == 1


@pytest.mark.parametrize("count", [1, 2, 3, 5])
def test_sweeps_of_slabs(count: int) -> None:
    """All pairs meet: the corrected Lemma 3 is reached, and P is what the closed form says."""
    found = case(slabs, count)
    run, tally = found.spreader, Tally(found)
    sweep, bound = (form.subs(n, count) + 80 for form in slab_sweep())
    assert (exact(run.length), exact(tally.proved_length())) == (sweep, bound)
    assert Length(tally.visits) == tally.proved_visits() == Length(count * (count + 1) // 2)
    assert [d.obstacle for d in run.diversions] == list(range(count))
    assert {d.reason for d in run.diversions} == {"the line ends"}
    assert tally.stays_in_strips and not tally.overtaken and not tally.met_again


# -- arms ------------------------------------------------------------------------------------------


def way_round(line: Expr, length: Expr = ell) -> Expr:
    """From above the bar to below it at x = line, around the western arm."""
    return (line - HALF - THICK) + (length - THICK) + THICK + length + (line - HALF)


def arms_sweep(lines: int, length: Expr = ell) -> tuple[Expr, Expr]:
    """P and the corrected Theorem 2, less the M-line, for arms across so many lines."""
    around = way_round(1, length) + way_round(lines, length)
    rounds = sum(way_round(Min(x, lines + 1 - x), length) for x in range(1, lines + 1))
    bound = theorem_2(CLEAR, 1, 1, around, around).subs({pairs: 0, n: 1})
    return expand(around + rounds - lines * THICK), expand(bound + (lines - 1) * around / 2)


def test_the_closed_form_of_arms() -> None:
    """For all k: the ways round sum up to k (2 ell - 1 - d) and twice floor((k + 1)^2 / 4)."""
    around = 2 * k + 4 * ell - 2 * THICK
    for lines in range(1, 12):
        sweep, bound = arms_sweep(lines)
        rounds = lines * (2 * ell - 1 - THICK) + 2 * ((lines + 1) ** 2 // 4)
        assert is_same(sweep, around.subs(k, lines) + rounds - lines * THICK)
        assert is_same(bound, 2 + (lines + 4) * around.subs(k, lines) / 2)


@pytest.mark.parametrize("square", [(k + 1) ** 2 / 4, ((k + 1) ** 2 - 1) / 4], ids=["odd", "even"])
def test_arms_come_as_near_to_theorem_2_as_one_likes(square: Expr) -> None:
    around = (2 * k + 4 * ell - 2 * THICK).subs(ell, k**2)
    sweep = around + k * (2 * k**2 - 1 - THICK) + 2 * square - k * THICK
    bound = 2 + (k + 4) * around / 2
    line = (k + 2) * (k**2 + 2) + k + 1
    assert limit(sweep / bound, k, oo) == 1
    assert limit((line + sweep) / (line + bound), k, oo) == 1
    assert limit(line / (line + bound), k, oo) == Rational(1, 3), "the M-line is a third of the bound only"


@pytest.mark.parametrize(("lines", "length"), [(1, 1), (2, 4), (3, 9), (4, 16)])
def test_sweeps_of_arms(lines: int, length: int) -> None:
    found = case(arms, lines, length)
    run, line = found.spreader, (lines + 2) * (length + 2) + lines + 1
    sweep, bound = (form + line for form in arms_sweep(lines, Rational(length)))
    assert (exact(run.length), exact(Tally(found).proved_length())) == (sweep, bound)
    assert (Tally(found).visits, Tally(found).proved_visits()) == (lines, Length(lines + 1))


# -- hooks -----------------------------------------------------------------------------------------


def hooks_sweep(lines: Expr, length: Expr, last: Expr) -> tuple[Expr, Expr]:
    """P and the corrected Theorem 2, less the M-line, for a hook across *lines* lines and the border."""
    east = lines + last
    around = 2 * east - 1 + 2 * length - THICK
    rounds = summation(2 * i - 1 + 2 * length - THICK, (i, 2, lines))
    sweep = 3 * around - 2 * (east - 1) + rounds + around - (lines + 1) * THICK
    bound = theorem_2(AT_BORDER, 1, 1, around, around).subs({pairs: 0, n: 1}) + lines * around
    return expand(sweep), expand(bound)


def test_hooks_come_as_near_to_theorem_2_as_one_likes() -> None:
    sweep, bound = hooks_sweep(k, k**2, HALF)
    line = (k + 2) * (k**2 + 2) + k + HALF
    assert limit(sweep / bound, k, oo) == 1
    assert limit((line + sweep) / (line + bound), k, oo) == 1


def test_hooks_across_one_line_come_as_near_to_3_p_as_one_likes() -> None:
    around = 2 * (1 + eps) - 1 + 2 * ell - THICK
    assert limit((3 * around - 2 * eps) / (3 * around), eps, 0, "+") == 1


@pytest.mark.parametrize(
    ("lines", "length", "last"), [(1, 1, "1/2"), (1, 1, "1/100"), (2, 4, "1/2"), (3, 9, "1"), (4, 16, "1/2")]
)
def test_sweeps_of_hooks(lines: int, length: int, last: str) -> None:
    found = case(hooks, lines, length, last)
    run, line = found.spreader, (lines + 2) * (length + 2) + lines + Rational(last)
    sweep, bound = (form + line for form in hooks_sweep(lines, Rational(length), Rational(last)))
    assert (exact(run.length), exact(Tally(found).proved_length())) == (sweep, bound)


# -- relays ----------------------------------------------------------------------------------------


def relay_ways(places: Expr, crumbs: Expr) -> Expr:
    """The heights of the ways: 19 j to place j, and to the last one as often as it has crumbs."""
    return summation(19 * i, (i, 1, places - 1)) + 19 * places * crumbs


def diagonals(places: Expr, crumbs: Expr) -> Expr:
    return (3 * places + crumbs) * sqrt((60 + 19 * places) ** 2 + 400)


def test_relays_come_as_near_to_n_diagonals_as_one_likes() -> None:
    assert limit(relay_ways(k, k**2) / diagonals(k, k**2), k, oo) == 1


@pytest.mark.parametrize(("places", "crumbs"), [(1, 2), (2, 3)])
def test_sweeps_of_relays(places: int, crumbs: int) -> None:
    """One diversion to each crumb from one place; the ways are longer than their heights."""
    run = case(relay, places, crumbs=crumbs).spreader
    assert len(run.obstacles) == 3 * places + crumbs
    assert len(run.diversions) == places + crumbs
    assert len({d.leave.key for d in run.diversions}) == 1
    ways = Length.sum(d.length for d in run.diversions)
    assert ways > Length(int(relay_ways(places, crumbs)))
    share = next(y for y in YARDSTICKS if y.claim == "SSS-6" and "sum" in y.words).measure(Case(run.scene))
    assert share is not None
    assert share.part == ways
    assert abs(float(share.whole) - float(diagonals(places, crumbs))) < 1e-9


# -- yardsticks ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("yardstick", "row"), some(zip(YARDSTICKS, ROWS, strict=True), 8))
def test_the_table_of_the_read_me(yardstick: Yardstick, row: list[str]) -> None:
    """It tells the exact ratio on the best scene of the gallery, which the documentation looks for."""
    claim, _, largest, _, reach, _ = row
    ratio, name = re.fullmatch(r"(.*) on `(.*)`", largest).groups()
    share = yardstick.measure(case(gallery.scene, name))
    assert share is not None
    assert (claim, reach) == (yardstick.claim, yardstick.reach.value)
    assert str(share).endswith(ratio)
    assert share.part <= share.whole


@pytest.mark.parametrize("yardstick", YARDSTICKS, ids=lambda y: f"{y.claim}: {y.words}")
def test_families_are_as_told(yardstick: Yardstick) -> None:
    shares = [yardstick.measure(Case(scene)) for scene in yardstick.members()]
    assert all(share is not None and share.part <= share.whole for share in shares)
    attained = [share.is_whole for share in shares if share is not None]
    assert attained == [yardstick.reach is Reach.ATTAINED] * len(attained)
    assert bool(shares) == bool(yardstick.family) == (yardstick.reach is not Reach.OPEN)
    assert yardstick.gap or shares


def test_the_best_is_whole_if_one_is() -> None:
    """Not the first that a float takes for 1: of several scenes, and of several acquisitions on one."""
    tiny = Length("1/1000000000000000000000")
    assert Portion(Length(2), Length(2)).rank > Portion(Length(1) - tiny, Length(1)).rank
    shares = {
        "near": Portion(Length(1) - tiny, Length(1)),
        "whole": Portion(Length(1), Length(1)),
        "none": None,
    }
    of = Yardstick("X", "x", Subject.SIGHTSEER, lambda c: shares[c], Reach.OPEN)  # type: ignore[arg-type,index]
    assert best(of, [(name, name) for name in shares]) == ("whole", shares["whole"])  # type: ignore[misc]
    assert best(of, [("none", "none")]) is None  # type: ignore[list-item]
