"""Options that would cure violations and close chains, each tried before it is named."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np
from flint import fmpq

from exactacq.cached import cached_property
from exactacq.errors import FormatError, InvalidScene, Undecided
from exactacq.files.checking.flaws import Judged, frame, judged
from exactacq.files.checking.starts import rounded_up
from exactacq.files.loops.assembly import default_tolerance, in_full
from exactacq.files.loops.contents import AS_TOLD, Contents
from exactacq.files.loops.drawing import is_named, main_box
from exactacq.geometry.points import Point
from exactacq.geometry.strokes import Floats
from exactacq.numbers.rationals import nearest_float, plain
from exactacq.scene.shapes import Circle, Shape
from exactacq.scene.validation import COUNTED, LIMIT, Violation

MOST_EDGES = 10_000
"""Edges beyond which nothing is tried: a trial takes as long as the check itself, some seconds there."""
THICK_EDGES = 4000
"""Edges of walls around lines and of loops beyond which these are not tried: all are merged."""
LAYER_TRIALS = 2
"""Most layers that are left out, or read alone, in turn."""
WALLS = "*wall*"
"""What layers of walls are named like."""
LAYERS_READ = 12
"""Most layers that are read one by one, those with the most entities."""
LONGEST = 80
"""Most characters of layers that are named to be read."""
COARSER, FINER = (10, 1000), fmpq(1, 1000)
"""Such multiples of the default tolerance are tried where a loop meets itself, or where three ends meet."""
THIN, NEAR = 200, 1000
"""Walls are tried with a thickness of such a part of the drawing's size, curves with such a distance."""
SAME = 1e-9
"""Violations this near each other, as a part of the drawing's size, are taken for the same one."""

Options = Mapping[str, object]
WHOLE: tuple[Options, ...] = ({}, {"union": True})
"""Ways to read layers whose lines are closed."""


@dataclass(frozen=True)
class Trial:
    """What becomes of a file with further options."""

    options: Options
    contents: Contents
    judged: Judged
    is_part: bool = False
    """Whether it reads layers of a plan that belong together, and no others."""

    @property
    def words(self) -> str:
        """The options on a command line."""
        return words(self.options)

    @cached_property
    def places(self) -> Floats:
        """Where violations are left."""
        return np.array([p.xy for v in self.judged.violations for p in v.places], dtype=float).reshape(-1, 2)

    @cached_property
    def still_open(self) -> set[str]:
        """The names of the pieces of chains that stay open."""
        return {piece.label for path in self.contents.open_chains for piece in path}

    def helps(self, before: Judged, contents: Contents) -> bool:
        """Whether violations or open chains are fewer than before."""
        fewer = len(self.judged.violations) < len(before.violations)
        return fewer or len(self.contents.open_chains) < len(contents.open_chains)

    def is_sound(self, contents: Contents) -> bool:
        """Whether no loop is gone by a tolerance, and walls around lines are merged with all that they meet.

        A large tolerance makes nothing of small loops.
        """
        known, left = ({loop.name for loop in told.loops} for told in (contents, self.contents))
        faulty = {self.judged.loops[k].name for v in self.judged.violations for k in v.loops}
        return ("tolerance" not in self.options or known <= left) and (
            "thicken" not in self.options or faulty <= known
        )


def words(options: Options) -> str:
    """Options as on a command line."""
    return " ".join(_word(name, value) for name, value in options.items() if value not in (None, False))


def _word(name: str, value: object) -> str:
    if value is True:
        return f"--{name}"
    if isinstance(value, fmpq):
        text = in_full(value) if value > 0 else plain(value)
    else:
        text = value if isinstance(value, str) else ",".join(map(str, value))  # type: ignore[call-overload]
    return f"--{name}={shlex.quote(text)}" if text.startswith("-") else f"--{name} {shlex.quote(text)}"


def trials(
    contents: Contents,
    found: Judged,
    allowed: Sequence[str],
    read: Callable[[Options], Contents],
) -> Iterator[Trial]:
    """What options make of contents: those of *allowed* that may cure what was found.

    *read* reads the file with further options. None are tried beyond `MOST_EDGES`, or if violations are so
    many that they are not all counted: a union would take as long as there are crossings.
    """
    lines = sum(piece.edges for path in contents.open_chains for piece in path)
    if contents.edges + lines > MOST_EDGES or len(found.violations) >= COUNTED:
        return
    apart = _layers_apart(contents, read) if "layers" in allowed else ()
    whole = ((more, False) for more in _proposals(contents, found))
    for more, is_part in chain(whole, ((more, True) for more in apart)):
        if not set(more) <= set(allowed):
            continue
        try:
            own = {"outer", "union"}
            tried = replace(contents, **more) if set(more) <= own else read(more)  # type: ignore[arg-type]
            if tried.walls and tried.edges > THICK_EDGES:
                continue
            trial = Trial(more, tried, judged(tried), is_part)
        except (FormatError, InvalidScene, Undecided):
            continue
        if trial.is_sound(contents):
            yield trial


def cured(trial: Trial, violation: Violation, before: Judged, size: float) -> bool:
    """Whether a violation is gone in a trial, and not only because what it speaks of is gone.

    It is gone if no violation is left near its places. With fewer layers one of two loops that met has to be
    there still.
    """
    if not trial.judged.loops or "thicken" in trial.options:
        return False
    names, left = {before.loops[k].name for k in violation.loops}, {loop.name for loop in trial.judged.loops}
    if "layers" in trial.options and not names & left:
        return False
    if not violation.places:
        return violation.text not in {other.text for other in trial.judged.violations}
    moved = [value for value in trial.options.values() if isinstance(value, fmpq)]
    reach = SAME * size + 2 * sum(map(nearest_float, moved))
    others = trial.places
    return all(not len(others) or np.hypot(*(others - p.xy).T).min() > reach for p in violation.places)


def _proposals(contents: Contents, found: Judged) -> Iterator[Options]:
    meeting = [v for v in found.violations if len(v.loops) == 2]
    if meeting and contents.outer == "wall" and _meets_the_frame(found, meeting):
        yield {"outer": "drop"}
    if contents.outer == "wall" and contents.start is not None:
        place = Point(*contents.start)
        if any(place in violation.places for violation in found.violations):
            yield {"outer": "room"}
    if meeting and not contents.union:
        yield {"union": True}
    size = size_of(contents)
    if contents.outer == AS_TOLD or not 0 < size < LIMIT:
        return
    closing = [contents.gaps.least(k) for k in range(len(contents.open_chains))]
    yield from ({"tolerance": tolerance} for tolerance in sorted({t for t in closing if t is not None}))
    if any(len(v.loops) == 1 for v in found.violations):
        yield from ({"tolerance": many * default_tolerance(size)} for many in COARSER)
    if contents.branches:
        # What is closer than the default tolerance may have been joined.
        yield {"tolerance": FINER * default_tolerance(size)}
    if meeting:
        yield from _fewer_layers(contents, found, meeting)
    if None in closing:
        yield _walls_of(contents)
    if contents.has_curves:
        yield {"flatten": near_enough(size)}


def _meets_the_frame(found: Judged, meeting: Sequence[Violation]) -> bool:
    walls = [loop.index for loop in found.loops if loop.is_enclosure]
    outermost = walls[0] if walls else frame([loop.shape for loop in found.loops])
    return any(outermost in v.loops for v in meeting)


def _fewer_layers(contents: Contents, found: Judged, meeting: Sequence[Violation]) -> Iterator[Options]:
    """All layers but one, for layers whose loops meet those of another: no walls, and with few entities."""
    counts, homes = contents.layers.counts, contents.layers.homes
    less = set()
    for violation in meeting:
        layers = {homes.get(found.loops[k].name or "", "") for k in violation.loops}
        if len(layers) == 2 and "" not in layers:
            less.add(min(layers, key=lambda layer: (is_named(layer, WALLS), counts[layer], layer)))
    for layer in sorted(less, key=lambda layer: (counts[layer], layer))[:LAYER_TRIALS]:
        others = [name for name in counts if name != layer and contents.layers.read(name)]
        if all(map(_can_be_given, others)) and sum(map(len, others)) <= LONGEST:
            yield {"layers": others}


def _layers_apart(contents: Contents, read: Callable[[Options], Contents]) -> Iterator[Options]:
    """Of the layers of a plan those that have loops alone, together, and those of walls.

    Lines that end at the corners of another layer, as those of doors do, open its loops. Walls are told by
    names, as "A-WALL", and made thick if their lines stay open.
    """
    layers = contents.layers
    if layers.chosen is not None or len(layers.counts) < 2 or not contents.open_chains:
        return
    looped: list[str] = []
    walls: dict[str, Contents] = {}
    for name, _ in layers.counts.most_common(LAYERS_READ):
        if not _can_be_given(name):
            continue
        try:
            alone = read({"layers": [name]})
        except (FormatError, InvalidScene, Undecided):
            continue
        if alone.loops:
            looped.append(name)
        if is_named(name, WALLS):
            walls[name] = alone
    if 1 < len(looped) < len(layers.counts) and sum(map(len, looped)) <= LONGEST:
        yield from ({"layers": looped, **more} for more in WHOLE)
    # Not parts such as "A-WALL-PATT", which have hatches or what is to be torn down.
    main = [name for name in walls if not any(name != other and name.startswith(other) for other in walls)]
    for name in sorted(main, key=len)[:LAYER_TRIALS]:
        ways = (_walls_of(contents),) if walls[name].open_chains else WHOLE
        yield from ({"layers": [name], **more} for more in ways)


def _can_be_given(name: str) -> bool:
    """Whether the name of a layer can be written in a list of names, whose ends are stripped."""
    return bool(name) and "," not in name and name == name.strip()


def _walls_of(contents: Contents) -> Options:
    """The option that makes walls of lines."""
    return {"thicken": rounded_up(nearest_float(size_of(contents)) / THIN)}


def near_enough(size: fmpq) -> fmpq:
    """The distance from curves within which arcs stand for them, of a drawing of that size."""
    return rounded_up(nearest_float(size) / NEAR)


def size_of(contents: Contents) -> fmpq:
    """The larger side of the box of all vertices of loops and open chains, but for what is far off."""
    pairs = [place for shape in contents.loops for place in _corners(shape)]
    pairs += [(c.x, c.y) for path in contents.open_chains for piece in path for c in piece.corners]
    if not pairs:
        return fmpq(0)
    low, high = main_box(pairs)
    return max(high[0] - low[0], high[1] - low[1])


def _corners(shape: Shape) -> list[tuple[fmpq, fmpq]]:
    if isinstance(shape, Circle):
        (x, y), r = shape.center, shape.radius
        return [(x - r, y - r), (x + r, y + r)]
    return [(x, y) for x, y, _ in shape.vertices]
