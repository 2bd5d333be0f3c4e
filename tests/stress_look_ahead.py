"""The strategy's look ahead and the audit's, which share no code, on random maps: they must not contradict.

``python tests/stress_look_ahead.py FIRST COUNT`` asks both about the maps of COUNT seeds from FIRST on, each
along two lines. It prints a line for each contradiction and one with counts: the strategy may be
`Undecided`, the audit may leave an answer open. Ten thousand maps take two minutes.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter

from test_look_ahead import degenerate

from exactacq.auditing.look_ahead import seen_later
from exactacq.auditing.rest_of_line import KnownPieces, Rest
from exactacq.errors import InvalidScene, Undecided
from exactacq.geometry.points import Point
from exactacq.numbers.real import Real, fmpq
from exactacq.strategies.seed_spreader.prediction.decide import sees_later


def outcome(seed: int, x: int) -> str:
    """How the answers about the map of a seed compare."""
    targets, others, radius, start, stop = degenerate(seed)
    known = [*targets, *others]
    rest = Rest(Point(x, start), Point(x, stop), False)
    theirs = seen_later(rest, KnownPieces(targets, (), others), radius)
    try:
        own = sees_later(fmpq(x), Real(start), stop, targets, lambda _: known, radius)
    except Undecided:
        return "Undecided"
    return "left open by the audit" if theirs.is_open else "equal" if own is theirs.sees else "contradictions"


def main(arguments: list[str] | None = None) -> int:
    """Compare, and tell what differs."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("first", type=int)
    parser.add_argument("count", type=int)
    asked = parser.parse_args(arguments)
    counts: Counter[str] = Counter()
    for seed in range(asked.first, asked.first + asked.count):
        for x in (0, 1):
            try:
                found = outcome(seed, x)
            except InvalidScene:
                found = "no map"
            counts[found] += 1
            if found == "contradictions":
                print(f"map {seed}, x = {x}", flush=True)
    print(", ".join(f"{found}: {n}" for found, n in counts.most_common()))
    return 1 if counts["contradictions"] else 0


if __name__ == "__main__":
    sys.exit(main())
