"""Explores and sweeps drawings in many ways: ``python tests/stress_drawings.py [FILE ...]``.

Without files, all that `tests/data` holds of at most `MOST` edges. Symmetric drawings tie from starts on
their axes, so most starts lie there: the one that ``exactacq check`` proposes, the middle of the drawing,
places level with both, and random ones. The ranges are what is proposed, twice that, and a third of the
drawing. Drawings without a wall around them are swept too, with and without look ahead, in a rectangle a
tenth larger than they are on each side. Every run is audited. A line is printed for each run that is
undecided, late or wrong, and one with the counts; the exit status is 1 if there is any.
"""

from __future__ import annotations

import signal
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial
from itertools import product
from pathlib import Path
from random import Random
from types import FrameType

import exactacq as xa

DATA = Path(__file__).parent / "data"
SUFFIXES = (".dxf", ".geojson", ".json", ".kicad_pcb", ".map", ".svg", ".wkt", ".yaml")
MOST = 160
"""Edges of a drawing that is tried, at most: larger ones take minutes each."""
SECONDS = 180
"""What a run and its audit may take."""

Start = tuple[Fraction, Fraction]


class LateError(Exception):
    """A run takes longer than it may."""


def _stop(number: int, frame: FrameType | None) -> None:
    raise LateError


def starts(found: xa.Inspection, random: int = 4) -> Iterator[Start]:
    """Places to start from, some not free: that proposed, three level with the middle, and random ones."""
    assert found.start is not None
    x, y = (Fraction(str(c)) for c in found.start)
    (left, bottom), (right, top) = ((Fraction(c) for c in corner) for corner in found.extent)
    middle_x, middle_y = (Fraction(round((a + b) * 4), 8) for a, b in ((left, right), (bottom, top)))
    yield from ((x, y), (middle_x, middle_y), (middle_x, y), (x, middle_y))
    rng = Random(7)
    for k in range(random):
        some_x = Fraction(round(2 * (left + (right - left) * Fraction(rng.random()))), 2)
        some_y = Fraction(round(2 * (bottom + (top - bottom) * Fraction(rng.random()))), 2)
        yield [(some_x, some_y), (some_x, middle_y), (middle_x, some_y)][k % 3]


def outcome(run: Callable[[], xa.Run]) -> str:
    """What becomes of a run and its audit: "passed", "not free", or a fault in one line."""
    before = signal.signal(signal.SIGALRM, _stop)
    # More than once: what is raised in a callback of a weak reference is lost.
    signal.setitimer(signal.ITIMER_REAL, SECONDS, SECONDS)
    try:
        xa.audit(run(), samples=8)
    except xa.InvalidScene:
        return "not free"
    except LateError:
        return f"more than {SECONDS} s"
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    return "passed"


def tried(path: Path, random: int = 4) -> Iterator[tuple[str, str]]:
    """All runs on a drawing, by the options that make them; none if it is no legal scene or has too many
    edges."""
    try:
        found = xa.inspect(path)
    except xa.ExactacqError:
        return
    if found.scene is None or found.start is None or found.radius is None:
        return
    if sum(len(obstacle.edges) for obstacle in found.scene.obstacles) > MOST:
        return
    (left, bottom), (right, top) = ((Fraction(c) for c in corner) for corner in found.extent)
    size, proposed = max(right - left, top - bottom), Fraction(str(found.radius))
    ranges = proposed, 2 * proposed, Fraction(max(1, round(size / 3)))
    for (x, y), radius in product(starts(found, random), ranges):
        run = partial(xa.sightseer, found.scene, radius, start=(x, y))
        yield f"--start {x},{y} --radius {radius}", outcome(run)
    if found.scene.enclosure is not None:
        return
    margin = Fraction(max(1, round(size * 8 / 10)), 8)
    room = found.scene.replace(start=None)
    room = room.replace(terrain=xa.terrain_around(room, margin))
    for radius, ahead in product(ranges, ("", "no-")):
        run = partial(xa.seed_spreader, room, radius, lookahead=not ahead)
        yield f"--terrain bbox:{margin} --radius {radius} --{ahead}lookahead", outcome(run)


def main(names: list[str]) -> int:
    paths = [Path(name) for name in names] or [p for p in sorted(DATA.rglob("*")) if p.suffix in SUFFIXES]
    counts: Counter[str] = Counter()
    for path in paths:
        for options, what in tried(path):
            counts[what if what in ("passed", "not free") else "faults"] += 1
            if what not in ("passed", "not free"):
                print(f"{path} {options}: {what}", flush=True)
    print(f"{len(paths)} files: {counts['passed']} runs passed, {counts['faults']} did not")
    return int(counts["faults"] > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
