"""Why a robot goes where it goes, as data: what is chosen, the numbers that were compared, and its words."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import NamedTuple

from exactacq.errors import FormatError, shown
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import plain

DIGITS, MOST_DIGITS = 4, 64
"""Digits of lengths in sentences: as many as tell two apart, up to a limit."""
SHORT = 8
"""Rationals of at most so many characters are told as they are."""
FEW = 3
"""Obstacles that are told, or named in a sentence, where only their number matters."""
NEXT = 2
"""Obstacles that are told after the nearest: each costs a link that the choice did not need."""


class Rule(StrEnum):
    """By which rule a strategy decides. The values stand in run files."""

    NEAREST = "nearest"
    """The Sightseer goes to the unvisited obstacle with the shortest link, of several to that with the least
    number (step 1 of the paper)."""
    BACK = "back"
    """No unvisited obstacle has a link to where the Sightseer is: it goes back to where it came from (step
    2)."""
    ABOUT_TO_BE_LOST = "about to be lost"
    """The Seed Spreader leaves the M-line for the nearest obstacle that it is about to lose (step 1(d))."""
    GO_ON = "go on"
    """The Seed Spreader is about to lose nothing, and goes on along the M-line."""
    OWN = "own"
    """What a strategy of the user's own says (``because``)."""


class Candidate(NamedTuple):
    """An obstacle that was not chosen, and its exact length, if lengths were compared."""

    obstacle: int
    length: Length | None = None


@dataclass(frozen=True)
class Decision:
    """Why the robot makes its next move: the rule, what is chosen, and what else there was to choose.

    ``chosen`` is the number of an obstacle, "S" for the start, or None, and ``length`` what was compared of
    it: the length of its link, or how far it is away. ``others`` are told with theirs. How many depends on
    the rule:

    - nearest: the two nearest others, the first one first; with none of them there are no others at all, or
      ``because`` says why they are not told;
    - back: known obstacles that are not visited, to which no link leads, three at most; ``length`` is the
      radius R, which no link exceeds;
    - about to be lost: all others of which this is true, and how far their nearest points are away;
    - go on: incomplete obstacles, three at most, none of which is about to be lost;
    - own: what the strategy says.

    ``more`` is the number of obstacles of which the same is true and that are not told; of those that are
    farther than the told ones it is not counted.

    ``because`` is the reason in a strategy's own words. ``after`` tells when it was made: after so many
    pieces of the path. The robot sets it. Lengths may be given as numbers, the others as pairs or as numbers
    of obstacles alone. `FormatError` for what is no text, number or obstacle, ValueError for another rule.

    >>> import exactacq as xa
    >>> decision = Decision("the widest gap", chosen=3, length=5, others=[(1, "7/2")])
    >>> print(decision.describe())
    the widest gap (obstacle 3: 5; obstacle 1: 3.5)
    >>> run = xa.sightseer(xa.load("figure2"))
    >>> print(next(event.why() for event in run.events if event.kind == "leave"))
    nearest is obstacle 4: 4.236 < 7.652 (obstacle 8)
    """

    because: str = ""
    chosen: int | str | None = None
    length: Length | None = None
    others: tuple[Candidate, ...] = ()
    rule: Rule = Rule.OWN
    after: int = 0
    more: int = 0

    def __post_init__(self) -> None:
        if not isinstance(self.because, str):
            raise FormatError(f"a reason is a text, not {shown(self.because)}")
        if self.chosen not in (None, "S"):
            _number_of(self.chosen)
        if _number_of(self.more) < 0:
            raise FormatError(f"a reason leaves out no fewer than 0 obstacles, not {self.more}")
        object.__setattr__(self, "length", _length(self.length))
        object.__setattr__(self, "others", tuple(_candidates(self.others)))
        object.__setattr__(self, "rule", Rule(self.rule))

    @property
    def ties(self) -> tuple[int, ...]:
        """The others whose length is equal to the chosen one's.

        >>> Decision(chosen=2, length=5, others=[(3, 5), (0, 9)]).ties
        (3,)
        """
        if self.length is None:
            return ()
        return tuple(c.obstacle for c in self.others if c.length is not None and c.length == self.length)

    def numbered(self, numbers: Sequence[int], after: int) -> Decision:
        """The decision with other numbers of obstacles, after so many pieces of the path.

        ``numbers[k]`` is the other number of k; `FormatError` if there is none.

        >>> Decision("by chance", chosen=1).numbered([7, 4], after=2)  # doctest: +ELLIPSIS
        Decision(because='by chance', chosen=4, ..., rule=<Rule.OWN: 'own'>, after=2, more=0)
        """
        for k in (self.chosen, *(c.obstacle for c in self.others)):
            if isinstance(k, int) and not 0 <= k < len(numbers):
                raise FormatError(f"a reason names obstacle {k}, which the robot has not seen")
        chosen = numbers[self.chosen] if isinstance(self.chosen, int) else self.chosen
        others = tuple(Candidate(numbers[k], length) for k, length in self.others)
        return replace(self, chosen=chosen, others=others, after=after)

    # -- in words ----------------------------------------------------------------------------------

    def describe(self, names: Sequence[str] | None = None) -> str:
        """The decision in a sentence; obstacles by their *names* if given, else by their numbers.

        Lengths have four digits, or as many as tell that of the chosen one from the next. `Undecided` where
        they cannot be compared.

        >>> print(Decision(chosen=2, length=5, others=[(3, 5), (0, 9)], rule="nearest").describe())
        obstacle 2 and obstacle 3 are equally near: 5; obstacle 2 has the smaller number
        """
        label = _Naming(names)
        others = [c.obstacle for c in self.others]
        if self.rule is Rule.OWN:
            return self._own(label)
        if self.rule is Rule.GO_ON:
            left = f"; incomplete: {label.listed(others, 'and', self.more)}" if others else ""
            return f"on along the M-line: nothing is about to be lost{left}"
        if self.rule is Rule.BACK:
            where, reach = label.listed(others, "or", self.more), _text(self.length, DIGITS)
            return f"back to {label(self.chosen)}: no link of at most {reach} leads from here to {where}"
        if self.rule is Rule.NEAREST:
            one = "only {} is in reach: {}"
            several = "nearest is"
        else:
            one = "only {} is about to be lost, {} away"
            several = "nearest of what is about to be lost is"
        chosen, digits = label(self.chosen), self._digits()
        size = _text(self.length, digits)
        if not self.others:
            return f"{several} {chosen}: {size}; {self.because}" if self.because else one.format(chosen, size)
        if ties := self.ties:
            every = label.listed((self.chosen, *ties), "and")
            least = "smallest" if len(ties) > 1 else "smaller"
            return f"{every} are equally near: {size}; {chosen} has the {least} number"
        rest = [f"{_text(c.length, digits)} ({label(c.obstacle)})" for c in self.others[:FEW]]
        return f"{several} {chosen}: {size} < {', '.join(rest)}{_more(len(self.others))}"

    def _own(self, label: _Naming) -> str:
        told = [(self.chosen, self.length), *self.others]
        sizes = [f"{label(k)}: {_text(length, DIGITS)}" for k, length in told if length is not None]
        numbers = "; ".join(sizes[: FEW + 1]) + _more(len(sizes) - 1)
        return " ".join(self.because.split()) + (f" ({numbers})" if sizes else "")

    def _digits(self) -> int:
        """So many digits that the length differs from the others' in print."""
        digits, sizes = DIGITS, [c.length for c in self.others[:FEW]]
        while digits < MOST_DIGITS and any(
            _decimal(size, digits) == _decimal(self.length, digits) and size != self.length for size in sizes
        ):
            digits *= 2
        return digits


class _Naming:
    """What sentences call obstacles, and the start."""

    def __init__(self, names: Sequence[str] | None) -> None:
        self._names = names

    def __call__(self, node: int | str | None) -> str:
        if isinstance(node, int):
            return f"obstacle {node}" if self._names is None else self._names[node]
        return "it" if node is None else node

    def listed(self, nodes: Iterable[int | str | None], last: str, more: int = 0) -> str:
        """Nodes, and how many there are besides."""
        every = [self(node) for node in nodes] + [f"{more} more"] * bool(more)
        return f" {last} ".join([", ".join(every[:-1]), every[-1]] if every[1:] else every)


def _more(others: int) -> str:
    return f" and {others - FEW} more" if others > FEW else ""


def _decimal(length: Length | None, digits: int) -> str:
    return "" if length is None else length.decimal(digits)


def _text(length: Length | None, digits: int) -> str:
    """A length in a sentence: a short rational as it is, else so many digits, from a ball."""
    exact = plain(length.rational) if length is not None and length.rational is not None else ""
    return exact if 0 < len(exact) <= SHORT else _decimal(length, digits)


def _length(given: object) -> Length | None:
    return None if given is None else Length(given)


def _number_of(given: object) -> int:
    if isinstance(given, bool) or not isinstance(given, int):
        raise FormatError(f"a reason names obstacles by their numbers, not {shown(given)}")
    return given


def _candidates(given: object) -> Iterator[Candidate]:
    if not isinstance(given, Iterable):
        raise FormatError(f"the others are obstacles, or pairs of obstacle and length, not {shown(given)}")
    for one in given:
        pair = one if isinstance(one, tuple | list) else (one, None)
        if len(pair) != 2:
            raise FormatError(f"a pair is an obstacle and its length, not {shown(one)}")
        yield Candidate(_number_of(pair[0]), _length(pair[1]))
