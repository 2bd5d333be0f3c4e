"""Runs with all floats off, beside the usual ones: they must be the same.

``python tests/stress_floats.py KIND FIRST COUNT`` runs COUNT scenes both ways, from the seed FIRST on. KIND
is `sightseer` or `seed-spreader`, for the random scenes of campaigns, or `octagons`, for 5 to 30 octagons
that the Sightseer explores. Lengths, events, bounds and maps are compared, each number to 40 digits. It
prints a line for each scene that differs, and one with counts. A thousand random scenes take ten minutes, a
thousand of octagons two hours.
"""

from __future__ import annotations

import argparse
import sys
import time

import exactacq as xa
from exactacq import kernel
from exactacq.files.octagons import random_octagons
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import random_scene

MAPS = 6
"""Maps at this many events are compared too."""
RADII = ("10", "4", "2", "5/2")


def parts(known: xa.KnownMap) -> list[object]:
    """What a map knows, in 40 digits."""
    return [
        (i, part.edge, part.whole, *(v.decimal(40) for p in (part.start, part.end) for v in (p.x, p.y)))
        for i in known.seen
        for part in known.known(i)
    ]


def told(run: xa.Run) -> list[object]:
    """All that is reported of a run, in 40 digits."""
    events = [
        [e.kind, e.obstacle, e.after, e.inside, e.occasion, e.reason, e.ending, e.other]
        + [number.decimal(40) for number in (e.point.x, e.point.y, e.at)]
        for e in run.events
    ]
    bounds = [(b.name, b.value.decimal(40), b.holds) for b in run.bounds]
    return [events, parts(run.map), bounds, run.length.decimal(40), run.visits, run.unseen, run.unvisited]


def run(kind: str, seed: int) -> xa.Run:
    """The run of a scene."""
    if kind == "octagons":
        return xa.sightseer(random_octagons(5 + seed % 26, seed), radius=RADII[seed % 4])
    scene = random_scene(Subject(kind), seed)
    return (xa.sightseer if kind == "sightseer" else xa.seed_spreader)(scene)


def all_of(kind: str, seed: int) -> object:
    """What is told of a run, or of its error."""
    try:
        found = run(kind, seed)
        step = max(1, len(found.events) // MAPS)
        return told(found), [parts(found.map_at(event)) for event in found.events[::step]]
    except xa.ExactacqError as error:
        return f"{type(error).__name__}: {error}"


def main(arguments: list[str] | None = None) -> int:
    """Compare, and tell what differs."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("kind", choices=("sightseer", "seed-spreader", "octagons"))
    parser.add_argument("first", type=int)
    parser.add_argument("count", type=int)
    asked = parser.parse_args(arguments)
    spent, different, errors = [0.0, 0.0], 0, 0
    for seed in range(asked.first, asked.first + asked.count):
        results = []
        for k, exact in enumerate((False, True)):
            kernel.EXACT_ONLY = exact
            before = time.process_time()
            results.append(all_of(asked.kind, seed))
            spent[k] += time.process_time() - before
        errors += isinstance(results[0], str)
        if results[0] != results[1]:
            different += 1
            print(f"{asked.kind}:{seed}", *(r for r in results if isinstance(r, str)), flush=True)
    print(
        f"{asked.kind}: {asked.count} scenes, {different} differ, {errors} end in an error; "
        f"{spent[0]:.0f} s, and {spent[1]:.0f} s without floats"
    )
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
