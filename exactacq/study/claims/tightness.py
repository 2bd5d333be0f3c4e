"""How tight each corrected bound is: what it bounds as a share of it, exactly, scene by scene.

A yardstick is one bound with a family of scenes that reaches it, or comes as near as one likes. The proof for
all members of a family is `proofs/arguments/tight.md`; what nobody knows is told as open.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from exactacq.geometry.points import Point, distance
from exactacq.numbers.length import Length
from exactacq.numbers.quotient import Quotient
from exactacq.numbers.rationals import rational
from exactacq.scene.scene import Scene
from exactacq.study.claims.coverage import times_walked
from exactacq.study.claims.figure_scenes import column
from exactacq.study.claims.model import Case, Subject
from exactacq.study.claims.spreader import TIMELY, pockets
from exactacq.study.claims.sweeps import all_convex
from exactacq.study.claims.tallies import Tally, bounds_of, straight_length
from exactacq.study.claims.tight_families import arms, hooks, relay, rods, slabs
from exactacq.study.claims.trees import arrivals
from exactacq.study.claims.walks import is_circuit, stays
from exactacq.visibility.links import START

SIGHTSEER, SPREADER = Subject.SIGHTSEER, Subject.SEED_SPREADER
SHORT = 60
"""Characters that a closed form may take where a ratio is told."""


class Portion(NamedTuple):
    """What was bounded, and its bound, which is above 0."""

    part: Length
    whole: Length

    @property
    def ratio(self) -> Quotient:
        """The part over the whole, exactly."""
        return Quotient(self.part, self.whole)

    @property
    def is_whole(self) -> bool:
        """Whether the bound is reached."""
        return self.part == self.whole

    @property
    def rank(self) -> tuple[bool, float]:
        """Ascends with the ratio: told by floats, and exactly whether one is whole and another is not."""
        return self.is_whole, float(self.ratio)

    def __str__(self) -> str:
        """The ratio as a fraction or, if its closed form is short, as two lengths; and as a decimal.

        >>> print(Portion(Length(345), Length(482)), Portion(Length(3), Length.turns(1)), sep="; ")
        345/482 = 0.715768; (3) / (2*pi) = 0.477465
        """
        if self.is_whole:
            return "1"
        decimal = f"{float(self.ratio):.6f}"
        fraction = self.ratio.rational
        form = f"({self.part}) / ({self.whole})" if fraction is None else str(fraction)
        return f"{form} = {decimal}" if len(form) <= SHORT else decimal


class Reach(Enum):
    """How near to a bound its family comes, for all members by the written argument."""

    ATTAINED = "is 1"
    APPROACHED = "tends to 1"
    OPEN = "open"


@dataclass(frozen=True)
class Yardstick:
    """One bound: the claim it belongs to, what is divided by what, and the family of scenes that tests it.

    ``measure`` gives the share on a case, or None where the bound does not speak of it. ``members`` are a few
    scenes of the family, in the order in which the ratio grows; ``family`` tells of it and of its limit.
    ``gap`` is what is open.
    """

    claim: str
    words: str
    subject: Subject
    measure: Callable[[Case], Portion | None]
    reach: Reach
    family: str = ""
    members: Callable[[], tuple[Scene, ...]] = tuple
    gap: str = ""


def best(yardstick: Yardstick, cases: Iterable[tuple[str, Case]]) -> tuple[str, Portion] | None:
    """The named case of the largest share, the first of several; None if the bound speaks of none."""
    found: tuple[str, Portion] | None = None
    for name, case in cases:
        share = yardstick.measure(case)
        if share is not None and (found is None or share.rank > found[1].rank):
            found = name, share
    return found


# -- the Sightseer's bounds ------------------------------------------------------------------------


def _longest_link(case: Case) -> Portion | None:
    """The longest tree edge between obstacles, and R."""
    links = [link.length for link in case.sightseer.links if link.source != START]
    return Portion(max(links), Length(case.sightseer.radius)) if links else None


def _arrivals(case: Case) -> Portion | None:
    """The visits, and 2(n - 1)."""
    n = len(case.scene.obstacles)
    if n < 2 or not case.is_mutually_visible:
        return None
    return Portion(Length(arrivals(case.sightseer)), Length(2 * (n - 1)))


def _tour_of(name: str, least: int, most: int | None = None) -> Callable[[Case], Portion | None]:
    """P and the bound of that name, where *least* to *most* obstacles make up model (a)."""

    def measure(case: Case) -> Portion | None:
        n = len(case.scene.obstacles)
        if n < least or (most is not None and n > most) or not case.is_mutually_visible:
            return None
        return Portion(case.sightseer.length, bounds_of(case.sightseer)[name])

    return measure


# -- the Seed Spreader's bounds --------------------------------------------------------------------


def _diversions(case: Case) -> Portion | None:
    """The diversions, and n."""
    run = case.spreader
    return Portion(Length(len(run.diversions)), Length(len(run.obstacles))) if run.diversions else None


def _convex_diversions(case: Case) -> Portion | None:
    return _diversions(case) if all_convex(case.spreader) else None


def _timely_way(case: Case) -> Portion | None:
    """The longest straight way, there and back, of a diversion because of sight or reach, and 2R."""
    run = case.spreader
    ways = [straight_length(run, d) for d in run.diversions if d.reason in TIMELY]
    return Portion(max(ways), Length(2 * run.radius)) if ways else None


def _all_ways(case: Case) -> Portion | None:
    """The lengths |DQ| of all diversions, and n diagonals of the terrain."""
    run, terrain = case.spreader, case.scene.terrain
    if terrain is None or not run.diversions:
        return None
    diagonal = Length(distance(Point(0, 0), Point(terrain.width, terrain.height)))
    return Portion(Length.sum(d.length for d in run.diversions), diagonal * len(run.obstacles))


def _acquisition(closed: bool) -> Callable[[Case], Portion | None]:
    """The costliest acquisition on the M-line, and 1.5p for loops or 3p for arcs, p its own perimeter."""
    times = rational("3/2") if closed else rational(3)

    def measure(case: Case) -> Portion | None:
        run = case.spreader
        circuits = (stay for stay in stays(run) if run.obstacles[stay.obstacle].closed is closed)
        shares = [
            Portion(stay.length, run.obstacles[stay.obstacle].perimeter * times)
            for stay in circuits
            if is_circuit(run, stay)
        ]
        return max(shares, key=lambda share: share.rank, default=None)

    return measure


def _thrice(case: Case) -> Portion | None:
    """How often a piece of boundary is walked on one stay, at most, and three."""
    counts = [times_walked(case.spreader, [stay]) for stay in stays(case.spreader)]
    return Portion(Length(max(counts)), Length(3)) if counts else None


def _visits(case: Case) -> Portion | None:
    """The visits of a sweep, and the corrected Lemma 3."""
    tally = case.shared(Tally)
    return Portion(Length(tally.visits), tally.proved_visits()) if tally.n else None


def _beyond_the_m_line(clear: bool) -> Callable[[Case], Portion | None]:
    """P and the corrected Theorem 2, both less the M-line's own length."""

    def measure(case: Case) -> Portion | None:
        tally = case.shared(Tally)
        if not tally.n or tally.is_clear is not clear:
            return None
        line = bounds_of(case.spreader)["(8)"]
        return Portion(case.spreader.length - line, tally.proved_length() - line)

    return measure


YARDSTICKS = (
    Yardstick(
        "SS-6",
        "the longest tree edge over $R$",
        SIGHTSEER,
        _longest_link,
        Reach.ATTAINED,
        r"columns: gaps of exactly $R$. Over $\min(R, v_{\max})$ it is 1 on every scene, by definition",
        lambda: (column(2), column()),
    ),
    Yardstick(
        "L2",
        r"visits over $2(n - 1)$, for $n \ge 2$",
        SIGHTSEER,
        _arrivals,
        Reach.ATTAINED,
        "rods with $n - 1$ crumbs, for every $n$",
        lambda: (rods(2, 10), rods(3, 10), rods(6, 20)),
    ),
    Yardstick(
        "T1",
        "$P$ over the corrected bound, for $n = 2$",
        SIGHTSEER,
        _tour_of("T1 corrected", 2, 2),
        Reach.ATTAINED,
        "a column of two",
        lambda: (column(2),),
    ),
    Yardstick(
        "T1",
        r"$P$ over the corrected bound, for $n \ge 3$",
        SIGHTSEER,
        _tour_of("T1 corrected", 3),
        Reach.APPROACHED,
        "rods with $n - 1$ crumbs that get longer and longer, for every $n$. For no $n$ from 3 on it is 1",
        lambda: (rods(3, 10), rods(4, 100), rods(5, 1000), rods(6, 10000)),
    ),
    Yardstick(
        "T1",
        r"$P$ over (2) as printed, for $n \ge 2$",
        SIGHTSEER,
        _tour_of("(2)", 2),
        Reach.APPROACHED,
        "the same rods. For no $n$ from 2 on it is 1: there (2) is true as printed",
        lambda: (rods(3, 10), rods(4, 100), rods(5, 1000), rods(6, 10000)),
    ),
    Yardstick(
        "SSS-5",
        "diversions over $n$",
        SPREADER,
        _diversions,
        Reach.ATTAINED,
        "$n$ obstacles with pockets, for every $n$",
        lambda: (pockets(1), pockets(2), pockets(3)),
    ),
    Yardstick(
        "SSS-5",
        "diversions over $n$, all obstacles convex",
        SPREADER,
        _convex_diversions,
        Reach.OPEN,
        gap="Whether $n$ convex obstacles can take $n$ diversions, or what share of $n$, is not known.",
    ),
    Yardstick(
        "SSS-6",
        "the straight way of a diversion because of sight or reach over $2R$",
        SPREADER,
        _timely_way,
        Reach.ATTAINED,
        r"obstacles with pockets that go out of reach. Over $2\,\lvert DQ \rvert$ it is 1 wherever nothing "
        "is in the way",
        lambda: (pockets(1), pockets(2)),
    ),
    Yardstick(
        "SSS-6",
        r"the sum of all $\lvert DQ \rvert$ over $n \sqrt{A^2 + B^2}$",
        SPREADER,
        _all_ways,
        Reach.APPROACHED,
        "relays over $k$ places with $k^2$ crumbs at the last one",
        lambda: (relay(1), relay(2, crumbs=4)),
    ),
    Yardstick(
        "SSS-7",
        "one acquisition clear of the border over $1.5 p$",
        SPREADER,
        _acquisition(closed=True),
        Reach.ATTAINED,
        "a bar with arms across one line",
        lambda: (arms(1, 1),),
    ),
    Yardstick(
        "SSS-7",
        "one acquisition at the border over $3p$",
        SPREADER,
        _acquisition(closed=False),
        Reach.APPROACHED,
        "hooks across one line, the last strip narrower and narrower. It is never 1",
        lambda: (hooks(1, 1), hooks(1, 1, "1/10"), hooks(1, 1, "1/100")),
    ),
    Yardstick(
        "SSS-8",
        "how often a piece is walked on one stay, over 3",
        SPREADER,
        _thrice,
        Reach.ATTAINED,
        "hooks",
        lambda: (hooks(1, 1),),
    ),
    Yardstick(
        "L3",
        "visits over the corrected bound",
        SPREADER,
        _visits,
        Reach.ATTAINED,
        r"slabs, for every $n$: all $\tfrac{1}{2} n (n - 1)$ pairs meet",
        lambda: (slabs(1), slabs(2), slabs(3), slabs(4)),
        r"Where diversions stay in their strips and $n_0 > 0$, it is less than 1, for $n_0^2$ can be taken "
        r"away. Whether what is left of $n\,n_0$ is needed is open, and so is the term for overtaken aims: "
        "no scene is known that has any.",
    ),
    Yardstick(
        "T2",
        "$P$ over the corrected bound clear of the border, both less the M-line",
        SPREADER,
        _beyond_the_m_line(clear=True),
        Reach.APPROACHED,
        "$n$ slabs, by the pairs; and bars with arms $k^2$ long across $k$ lines, by what is met again",
        lambda: (slabs(2), slabs(4), slabs(8), arms(4, 16), arms(8, 64), arms(16, 256)),
        r"No scene is known that needs the term with $n_0$, or that for overtaken aims. An aim takes $p$ of "
        "its $1.5 p$, unless it is passed on the way back.",
    ),
    Yardstick(
        "T2",
        "$P$ over the corrected bound at the border, both less the M-line",
        SPREADER,
        _beyond_the_m_line(clear=False),
        Reach.APPROACHED,
        "hooks $k^2$ long across $k$ lines",
        lambda: (hooks(2, 4), hooks(4, 16), hooks(8, 64), hooks(16, 256)),
        "The terms for pairs are not tried at the border.",
    ),
)
"""The bounds that hold, with what is known of how tight they are."""
