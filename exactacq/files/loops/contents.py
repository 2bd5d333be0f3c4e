"""What a file shows before anything is decided, and the scene that it makes around a start.

Readers end here: they find closed loops and lines that stay open, and what the file says of a start, a wall,
a radius and a terrain. Which loop is the wall, and what the robot can never see, the start decides.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace

from flint import fmpq

from exactacq.errors import FormatError, InvalidScene
from exactacq.files.loops.arrangement import arranged
from exactacq.files.loops.chains import Chain
from exactacq.files.loops.drawing import is_named
from exactacq.files.loops.nesting import Loops
from exactacq.files.repairs.gaps import ChainGaps
from exactacq.files.source import one_line
from exactacq.geometry.points import Point
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Shape, Terrain
from exactacq.scene.validation import DISJOINT, SIMPLE, WITHIN, place_text

AS_TOLD = "as told"
"""The file itself says which loop is the wall; all others are obstacles."""
MOST_TRIED = 2000
"""Edges beyond which a scene that is refused is not tried with other options."""
TRIED = ({"outer": "drop"}, {"union": True}, {"outer": "drop", "union": True}, {"outer": "room"})
"""Options that are tried in turn where a scene is refused."""


@dataclass(frozen=True, slots=True)
class Layers:
    """The layers of a drawing with their counts of entities, and which are read: all if None."""

    counts: Counter[str] = field(default_factory=Counter)
    chosen: tuple[str, ...] | None = None
    homes: dict[str, str] = field(default_factory=dict)
    """The layers of loops, by the names of the loops, where these are known."""

    def read(self, layer: str) -> bool:
        """Whether a layer is read."""
        return self.chosen is None or any(is_named(layer, name) for name in self.chosen)


@dataclass(frozen=True, slots=True, kw_only=True)
class Contents:
    """The closed loops of a file in its order, and what else it shows or says.

    With *outer* "wall", "drop" or "room" the start decides what the loops are, see
    `exactacq.files.loops.nesting.nest`; with `AS_TOLD` the *wall* is told. *options* are those of the format
    that `TRIED` may use. Without a start some files make no scene: *startless* says so. *lacking* says why a
    file makes none at all. Around a start there are an even number of loops with *free* 0, an odd one with 1.
    """

    name: str | None
    loops: tuple[Shape, ...]
    outer: str = AS_TOLD
    union: bool = False
    options: tuple[str, ...] = ()
    wall: Shape | None = None
    start: tuple[fmpq, fmpq] | None = None
    radius: fmpq | None = None
    terrain: Terrain | None = None
    notes: tuple[str, ...] = ()
    startless: str = ""
    lacking: str = ""
    free: int | None = None
    open_chains: tuple[tuple[Chain, ...], ...] = ()
    """Lines that do not close and are left out, each as its pieces in order."""
    gaps: ChainGaps = field(default_factory=ChainGaps)
    """What would close these."""
    branches: int = 0
    """At so many points three or more ends of lines meet, so that no loop goes through."""
    has_curves: bool = False
    """Whether curves were left out that are read with ``flatten``."""
    walls: int = 0
    """So many of the last loops are walls around lines: nothing within them is free."""
    layers: Layers = field(default_factory=Layers)
    unit: str = ""
    """What the file says of its unit of length."""

    @property
    def edges(self) -> int:
        """Number of edges of the loops."""
        every = (*self.loops, *([] if self.wall is None else [self.wall]))
        return sum(1 if isinstance(shape, Circle) else len(shape.vertices) for shape in every)

    def scene(self, *, advise: bool = True) -> Scene:
        """The scene around the start. Raises `FormatError`, and `InvalidScene` with what would help.

        Nothing is tried that would help without *advise*.
        """
        if self.start is None and self.startless:
            raise FormatError(self.startless)
        if self.lacking:
            raise FormatError(self.lacking)
        try:
            return self._scene()
        except InvalidScene as error:
            cure = (self._cure() or self._advice(error)) if advise else ""
            raise InvalidScene(error.violations, cure) from None

    def arranged(self) -> tuple[list[Shape], Shape | None, list[str]]:
        """The obstacles, the wall, and the notes; the scene may still refuse them.

        Raises `FormatError` for a start in a blocked cell or in a wall around a line, and as
        `exactacq.files.loops.union.unite`.
        """
        notes = list(self.notes)
        if self.outer == AS_TOLD:
            return list(self.loops), self.wall, notes
        place = None if self.start is None else Point(*self.start)
        if self.free is not None and place is not None:
            around = len(Loops(self.loops).around(place))
            if around % 2 != self.free:
                raise FormatError(f"the start {place} lies in a blocked cell; choose one in a free cell")
        if self.walls and place is not None:
            walls = self.loops[-self.walls :]
            if hit := Loops(walls).around(place):
                line = one_line(repr(walls[hit[0]].name))
                raise FormatError(
                    f"the start {place_text(place)} lies inside an obstacle, the wall along {line}: it must "
                    "lie in free space; give another, such as the one that `exactacq check` proposes"
                )
        obstacles, wall = arranged(list(self.loops), place, self.outer, self.union, notes)
        return obstacles, wall, notes

    def _scene(self) -> Scene:
        obstacles, wall, notes = self.arranged()
        return Scene(
            obstacles,
            self.start,
            terrain=self.terrain,
            enclosure=wall,
            radius=self.radius,
            name=self.name,
            notes=notes,
        )

    def _cure(self) -> str:
        """The options that make a scene of what is refused without them; "" if none do."""
        for more in TRIED:
            if self.edges > MOST_TRIED or any(
                name not in self.options or getattr(self, name) == value for name, value in more.items()
            ):
                continue
            try:
                replace(self, **more)._scene()
            except (FormatError, InvalidScene):
                continue
            told = (f"--{name}" if value is True else f"--{name} {value}" for name, value in more.items())
            return f"with {' '.join(told)} it is a scene"
        return ""

    def _advice(self, error: InvalidScene) -> str:
        """What to do with a file where loops meet and no option makes a scene of it; perhaps ""."""
        told = " ".join(map(str, error.violations))
        cures = []
        meets = any(rule in told for rule in (DISJOINT, WITHIN))
        if meets and "union" in self.options and not self.union and self.edges > MOST_TRIED:
            cures.append("--union merges loops that meet")
        if meets and "union" not in self.options:
            cures.append(
                "move the shapes apart in the file; of formats that take it --union merges what meets"
            )
        if SIMPLE in told:
            cures.append("no option mends a boundary that meets itself: part it in the file where it does")
        if cures and self.layers.counts and self.layers.chosen is None:
            cures.append("--layers reads a part")
        return "; ".join(cures)
