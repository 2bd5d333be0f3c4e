"""What a file holds, before a start and a radius are chosen: what is wrong, what cures it, where to start."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from shlex import quote
from typing import Any

from flint import fmpq

from exactacq.errors import CurvesRefused, FormatError, InvalidScene, Undecided
from exactacq.files.checking.cures import Options, Trial, cured, near_enough, size_of, trials, words
from exactacq.files.checking.flaws import Judged, judged
from exactacq.files.checking.lines import OpenChain, open_chains
from exactacq.files.checking.sketch import Sketch, places_of
from exactacq.files.checking.starts import Beginning, beginning, vision
from exactacq.files.loops.contents import Contents
from exactacq.files.rereading import rereading
from exactacq.files.sources import NamedSource
from exactacq.geometry.intersections import ContactKind
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import nearest_float, plain
from exactacq.progress import Progress
from exactacq.scene.scene import Obstacle, Scene
from exactacq.scene.shapes import HasGeoInterface
from exactacq.scene.validation import LIMIT, Violation

Place = tuple[fmpq, fmpq]
STEPS = 4
"""Reading, violations, cures, and a start."""
BEST, BEST_PARTS = 2, 4
"""How many of the trials a start is looked for with, whatever their options, and how many of those of a part
of a plan."""
CLOSING = {"tolerance", "flatten"}
"""Options that close chains, other than by walls around them."""
COARSE = (fmpq(10) ** 9, fmpq(1), fmpq(1, 1000))
"""Lengths with which such a drawing is read to find out how large it is."""
TOGETHER = {"tolerance", "union", "flatten"}
"""Options that are also tried all together."""


@dataclass(frozen=True, slots=True)
class LoopFound:
    """A closed loop: what reports and the file call it, its edges, and how many other loops are around it."""

    obstacle: Obstacle
    depth: int
    holds: int
    """How many loops it has within."""

    @property
    def label(self) -> str:
        """What it is called: "O" and its number, or "wall"."""
        return "wall" if self.obstacle.is_enclosure else f"O{self.obstacle.index + 1}"

    @property
    def role(self) -> str:
        """The wall if the file or the start says so; else single, outer, hole or nested, by its place."""
        if self.obstacle.is_enclosure:
            return "wall"
        return ("outer" if self.holds else "single", "hole")[self.depth] if self.depth < 2 else "nested"


@dataclass(frozen=True, slots=True)
class Flaw:
    """A broken rule in words: where, by which loops, how edges meet, and options that cure it, each tried."""

    text: str
    places: tuple[Point, ...] = ()
    loops: tuple[int, ...] = ()
    kind: ContactKind | None = None
    cures: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Inspection:
    """What `inspect` has found in a file.

    ``loops``, ``open_chains`` and ``violations`` are those of the file as it is read, all of them if no start
    is given. ``start`` and ``radius`` are the given ones, or proposals: with the ``options`` there is a
    ``scene`` around that start, and ``command`` explores it. All these are None, or empty, if none was found.
    ``gap`` is what the radius is chosen by: the widest link that leads to an obstacle. ``notes`` tell what
    the reader did.

    >>> import exactacq as xa
    >>> import shapely
    >>> found = xa.inspect(shapely.MultiPolygon([shapely.box(0, 0, 2, 2), shapely.box(2, 1, 3, 3)]))
    >>> found.trouble, found.violations[0].cures, found.options
    ('1 violation of the rules for scenes', ('--union',), {'union': True})
    >>> print(*found.start, found.radius)
    5/2 1/2 3/4
    """

    name: str
    format: str
    contents: Contents
    loops: tuple[LoopFound, ...]
    open_chains: tuple[OpenChain, ...]
    violations: tuple[Flaw, ...]
    extent: tuple[tuple[float, float], tuple[float, float]] | None
    start: Place | None = None
    radius: fmpq | None = None
    gap: float | None = None
    options: Options | None = None
    scene: Scene | None = None
    command: str = ""
    notes: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether nothing is wrong: no rule is broken, and no chain stays open that would enclose loops."""
        return not self.trouble

    @property
    def trouble(self) -> str:
        """What is wrong, in one line; "" if nothing is."""
        wrong = []
        if self.violations:
            count = len(self.violations)
            wrong.append(f"{count} violation{'s' * (count != 1)} of the rules for scenes")
        if around := sum(chain.encloses for chain in self.open_chains):
            them = "an open chain" if around == 1 else f"{around} open chains"
            wrong.append(f"{them} would enclose other loops")
        if not self.loops and self.contents.lacking:
            wrong.append("there is no closed loop")
        return ", and ".join(wrong)

    def __repr__(self) -> str:
        return f"<Inspection of {self.name}: {len(self.loops)} loops, {self.trouble or 'OK'}>"


def inspect(
    name: str | os.PathLike[str] | HasGeoInterface,
    *,
    start: Point | Sequence[object] | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Inspection:
    """What a file or gallery scene holds, and all that is wrong with it; no start is needed.

    The arguments are those of `load`. *progress* is called with the number of steps done, and of all. Options
    that cure a violation or close a chain are named only after they were tried; none are tried for files of
    more than 10,000 edges. Curves that a reader refuses are read by arcs (``flatten``), as a note says.
    Raises `FormatError` for a file that cannot be read.

    >>> from importlib.resources import files
    >>> found = inspect(files("exactacq") / "files" / "data" / "issue42.dxf")
    >>> found.ok, len(found.loops), [loop.role for loop in found.loops].count("hole")
    (True, 15, 14)
    >>> len(found.scene.obstacles)
    15
    """
    tell = progress or (lambda done, total: None)
    tell(0, STEPS)
    source = NamedSource(name)
    options = source.format.checked(options) if source.format is not None else options
    with rereading():
        contents, options = _first_read(source, start, options)
        tell(1, STEPS)
        before = judged(contents)
        tell(2, STEPS)
        inquiry = _Inquiry(source, start, options, contents, before)
        tell(3, STEPS)
        found = inquiry.found(name="areas" if source.geo is not None else source.label)
        tell(4, STEPS)
    return found


def _first_read(source: NamedSource, start: Any, options: dict[str, Any]) -> tuple[Contents, dict[str, Any]]:
    """What a file holds, and with which options it is read: curves by arcs where they are refused."""
    try:
        return source.contents(start, options), options
    except CurvesRefused:
        for length in COARSE:
            with suppress(FormatError):
                # However coarse the arcs are, the ends of curves tell how large the drawing is.
                size = size_of(source.contents(start, {**options, "flatten": length}))
                if 0 < size < LIMIT:
                    by_arcs = {**options, "flatten": near_enough(size)}
                    contents = source.contents(start, by_arcs)
                    note = f"read with {words(by_arcs)}: it has curves that are no arcs"
                    return replace(contents, notes=(note, *contents.notes)), by_arcs
        raise


class _Inquiry:
    """The trials of one inspection, and what is found by them."""

    def __init__(
        self, source: NamedSource, start: Any, options: Options, contents: Contents, before: Judged
    ) -> None:
        self.source, self.start, self.options = source, start, options
        self.contents, self.before = contents, before
        self.tried: list[Trial] = []
        if before.violations or contents.open_chains or contents.lacking:
            self.tried = list(trials(contents, before, self._allowed, self._read))

    @property
    def _allowed(self) -> tuple[str, ...]:
        return tuple(o.name for o in self.source.format.options) if self.source.format is not None else ()

    def _read(self, more: Options, start: Place | None = None) -> Contents:
        return self.source.contents(start or self.start, {**self.options, **more})

    def found(self, name: str) -> Inspection:
        """All that is to be told."""
        sketch = Sketch.of([loop.shape for loop in self.before.loops])
        around = sketch.nesting
        counted = zip(
            self.before.loops, around.sum(axis=1).tolist(), around.sum(axis=0).tolist(), strict=True
        )
        chains = open_chains(self.contents, self.tried)
        size = nearest_float(min(size_of(self.contents), LIMIT))
        found = Inspection(
            name=name,
            format="gallery scenes" if self.source.format is None else self.source.format.title,
            contents=self.contents,
            loops=tuple(LoopFound(*row) for row in counted),
            open_chains=chains,
            violations=tuple(self._flaw(violation, size) for violation in self.before.violations),
            extent=self._extent(sketch),
            notes=self.before.notes,
        )
        begun = self._begun(any(chain.encloses for chain in chains))
        if begun is None:
            return found
        options, beginning = begun
        radius, gap = vision(beginning.scene)
        return replace(
            found,
            start=beginning.start,
            radius=radius,
            gap=gap,
            options={**self.options, **options},
            scene=beginning.scene,
            command=self._command({**self.options, **options}, beginning, radius),
        )

    def _extent(self, sketch: Sketch) -> tuple[tuple[float, float], tuple[float, float]] | None:
        """The box of all that can be shown, from its lower left to its upper right corner."""
        pieces = [piece for path in self.contents.open_chains for piece in path]
        places = places_of((corner.x, corner.y) for piece in pieces for corner in piece.corners)
        places += [] if sketch.is_empty else [(float(x), float(y)) for x, y in sketch.box]
        if not places:
            return None
        xs, ys = zip(*places, strict=True)
        return (min(xs), min(ys)), (max(xs), max(ys))

    def _flaw(self, violation: Violation, size: float) -> Flaw:
        cures = [trial.words for trial in self.tried if cured(trial, violation, self.before, size)]
        return Flaw(violation.text, violation.places, violation.loops, violation.kind, tuple(cures))

    def _begun(self, is_open: bool) -> tuple[Options, Beginning] | None:
        """The options and the start with which there are most boundaries, and of such the fewest options.

        Of the ways to read all of the file those up to the first that is good enough and leaves no chain open
        that could be closed are looked at, if no chain has to be closed; and the parts of a plan.
        """
        found: list[tuple[Options, Beginning]] = []
        fewest = min((len(t.contents.open_chains) for t in self.tried if self._closes(t)), default=None)
        for options, contents in self._ways():
            is_enough = self._begin(options, contents, found)
            closes_all = fewest is None or len(contents.open_chains) <= fewest
            if is_enough and closes_all and not (is_open or self._is_of_lines(contents)):
                break
        for trial in self._order(is_part=True)[:BEST_PARTS]:
            self._begin(trial.options, trial.contents, found)
        return max(found, key=_rank, default=None)

    def _closes(self, trial: Trial) -> bool:
        """Whether a trial closes chains without walls, breaks no further rule, and takes no loop away."""
        known, left = ({loop.name for loop in told.loops} for told in (self.contents, trial.contents))
        return (
            not trial.is_part
            and not CLOSING.isdisjoint(trial.options)
            and known <= left
            and len(trial.judged.violations) <= len(self.before.violations)
            and len(trial.contents.open_chains) < len(self.contents.open_chains)
        )

    def _is_of_lines(self, contents: Contents) -> bool:
        """Whether the file has no loops but lines, and more of these stay open than loops are closed."""
        return not self.contents.loops and len(contents.open_chains) > len(contents.loops)

    def _begin(self, options: Options, contents: Contents, found: list[tuple[Options, Beginning]]) -> bool:
        """Add the start that is found with some options; whether it is good enough not to look further.

        Where most of the loops are left out, a start in a room is looked for too.
        """
        begun = self._beginning(options, contents)
        leaves_most = begun is None or 2 * len(begun.scene.obstacles) < len(contents.loops)
        if begun is not None:
            found.append((options, begun))
        if leaves_most and contents.outer == "wall" and "outer" in self._allowed:
            room: Options = {**options, "outer": "room"}
            within = self._beginning(room, replace(contents, outer="room"))
            if within is not None:
                found.append((room, within))
        return begun is not None and begun.is_first and not leaves_most

    def _beginning(self, options: Options, contents: Contents) -> Beginning | None:
        return beginning(contents, partial(self._around, options, contents))

    def _order(self, *, is_part: bool) -> list[Trial]:
        """The trials of parts of a plan, or of all of the file, the best first.

        Lines of the whole become walls only if nothing else does as well: often they are no walls.
        """
        return sorted(
            (trial for trial in self.tried if trial.is_part is is_part),
            key=lambda trial: (
                len(trial.judged.violations),
                "thicken" in trial.options and not is_part,
                len(trial.contents.open_chains),
            ),
        )

    def _ways(self) -> Iterator[tuple[Options, Contents]]:
        """Contents to start in: as they are, with what leaves the fewest violations, and with all of that.

        Of each further kind of options the best trial follows; walls only where a file consists of lines
        and nothing else closes many of them.
        """
        yield {}, self.contents
        order = self._order(is_part=False)
        best = order[:BEST]
        is_of_lines = all(self._is_of_lines(trial.contents) for trial in best)
        for trial in order[BEST:]:
            is_new = all(set(trial.options) != set(other.options) for other in best)
            if is_new and (is_of_lines or "thicken" not in trial.options):
                best.append(trial)
        yield from ((trial.options, trial.contents) for trial in best)
        every: dict[str, object] = {}
        for trial in order:
            if TOGETHER.issuperset(trial.options) and trial.helps(self.before, self.contents):
                every = {**trial.options, **every}
        if len(every) > 1:
            with suppress(FormatError, InvalidScene, Undecided):
                yield every, self._read(every)

    def _around(self, options: Options, contents: Contents, start: Place) -> Contents:
        """The contents around a start; what a grid is simplified to depends on it, so that is read again."""
        again = self.options.get("simplify") is not None
        return self._read(options, start) if again else replace(contents, start=start)

    def _command(self, options: Options, begun: Beginning, radius: fmpq) -> str:
        """The command line that explores the scene; "" for areas that are in no file."""
        if self.source.geo is not None:
            return ""
        scene, told = begun.scene, self.contents
        parts = ["exactacq explore", quote(self.source.label), words(options)]
        if scene.terrain is not None and scene.meets_border():
            parts.append("--strategy seed-spreader")
        elif self.start is not None or told.start is None:
            parts.append(words({"start": ",".join(map(plain, begun.start))}))
        if told.radius is None:
            parts.append(words({"radius": radius}))
        return " ".join(filter(None, parts))


def _rank(found: tuple[Options, Beginning]) -> tuple[int, bool, int, bool]:
    """The more boundaries, and the fewer options, the better; then lines are rather no walls."""
    options, begun = found
    return len(begun.scene.obstacles), begun.is_first, -len(options), "thicken" not in options
