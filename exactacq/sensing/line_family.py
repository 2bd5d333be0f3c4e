"""The families and the single lines of one pencil: views along free lines, made when they are asked for.

A family (a `LineFamily`) is a maximal set of neighbouring lines that all meet the same two edges, one behind
the contact and one ahead of it. It contains three families of views (a `FreeViews` each): from the edge
behind to the contact, from the contact to the edge ahead, and from the one edge to the other.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf
from typing import TypeAlias

from exactacq.geometry.late import Pin
from exactacq.geometry.points import Point
from exactacq.kernel.extents import EVERYTHING
from exactacq.kernel.family_images import NONE, FamilyImage
from exactacq.kernel.line_keys import LineNumbers
from exactacq.kernel.pencil_images import pencil_images
from exactacq.kernel.single_lines import SingleImage
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.family_clipper import FamilyClipper
from exactacq.sensing.line_images import LineImages
from exactacq.sensing.line_points import Role, Side
from exactacq.sensing.view_families import FreeViews, ViewFamily
from exactacq.visibility.features import Feature
from exactacq.visibility.line_families import Sector, Sliding
from exactacq.visibility.line_names import Namer, Names
from exactacq.visibility.rotational_sweep import Passed, Pencil

Reached: TypeAlias = "tuple[Point, Real | None]"
"""A place, and its parameter on its edge if that is known."""


@dataclass(slots=True)
class LineFamily:
    """A cell of a pencil with what its lines meet; None where nothing is met within reach.

    Normals and rays have nothing ``behind`` and do not go back: they start at the contact, which lies on an
    edge. So does the contact of a convex arc; a corner that tangents touch counts as the start of the edge
    that follows it. ``anchor`` is the number of what is touched (see `line_keys`), ``names`` are those of the
    first and the last line (see `line_names`), ``passed`` is what they pass.
    """

    sector: Sector
    low: Real
    high: Real
    behind: Side | None
    contact: Side
    ahead: Side | None
    goes_back: bool
    anchor: int | None = None
    names: tuple[Names, Names] = ((), ())
    passed: tuple[Passed, Passed] = ((), ())
    _views: dict[tuple[int, int], list[ViewFamily]] = field(default_factory=dict)

    @property
    def sides(self) -> tuple[Side | None, Side, Side | None]:
        """What its lines meet or touch: behind, at the contact, ahead."""
        return self.behind, self.contact, self.ahead

    def views(
        self, here: int, there: int, clipper: FamilyClipper, in_range: bool
    ) -> tuple[list[ViewFamily], int]:
        """The views within range between two of its parts, and which of their two sides is *here*.

        They are made when they are first asked for. *in_range* if it is known that they all are.
        """
        pair = min(here, there), max(here, there)
        if pair not in self._views:
            self._views[pair] = clipper.families(self._free_views(*pair, in_range))
        return self._views[pair], int(here > there)

    def pin(self, here: int, is_last: bool, clipper: FamilyClipper) -> Pin:
        """Where its first or its last line meets one of its parts, *here*."""
        side, t = self.sides[here + 1], self.high if is_last else self.low
        assert side is not None, "lines meet what is seen from"
        return clipper.views.pin(self.sector, t, side, self.names[is_last], self.passed[is_last])

    def _free_views(self, first: int, last: int, in_range: bool) -> FreeViews:
        one, other = self.sides[first + 1], self.sides[last + 1]
        assert one is not None and other is not None, "views lie between edges"
        anchor = self.anchor if self.goes_back else None
        return FreeViews(
            self.sector,
            self.low,
            self.high,
            (one, other),
            self.names,
            passed=self.passed,
            anchor=anchor,
            in_range=in_range,
        )


class PencilFamilies:
    """The line families of one pencil of lines that all touch ``contact``; tangents go back from it too.

    *feature* is the corner or the arc that is touched, if lines are named by it.
    """

    def __init__(
        self,
        lines: Pencil,
        contact: Side,
        namer: Namer,
        feature: Feature | None,
        goes_back: bool,
    ) -> None:
        self.lines, self.contact, self.goes_back = lines, contact, goes_back
        self._namer, self._feature = namer, feature
        self._made: dict[int, LineFamily] = {}

    def imaged(self, images: LineImages, numbers: LineNumbers) -> list[FamilyImage]:
        """The families in floats, with *numbers* for their lines. They know this; it does not keep them."""
        lines, feature, contact = self.lines, self._feature, self.contact
        own = NONE if feature is None else self._namer.number(feature)
        frame, at = lines.sector.image, (contact.edge, self._corner)
        curves, following = images.curves, images.table.following
        found = pencil_images(lines.rows, frame, at, self.goes_back, own, numbers, curves, following, self)
        images.unroll(found, lines)
        return found

    @property
    def _corner(self) -> int:
        """The vertex at which the contact stays, or `NONE`."""
        e, following = self.contact.edge, self.lines.table.following
        return NONE if not self.contact.fixed else following[e] if self.contact.at_end else e

    def family(self, image: FamilyImage) -> LineFamily:
        """The family of an image, made when it is first asked for."""
        k = image.number
        if k not in self._made:
            self._made[k] = self._family(image)
        return self._made[k]

    def _family(self, image: FamilyImage) -> LineFamily:
        cell, feature, corner = self.lines.cell(self.lines.rows[image.number]), self._feature, self._corner
        behind = None if cell.behind is None or not self.goes_back else self._side(image, Role.BEHIND)
        ahead = None if cell.ahead is None else self._side(image, Role.AHEAD)
        bounds = zip((cell.low, cell.high), cell.bounds, strict=True)
        names: tuple[Names, Names] = (), ()
        if feature is not None or isinstance(self.lines.sector, Sliding):
            first, last = (self._names(t, passed) for t, passed in bounds)
            names = first, last
        return LineFamily(
            self.lines.sector,
            cell.low,
            cell.high,
            behind,
            self.contact if self.contact.fixed else self._side(image, Role.CONTACT),
            ahead,
            self.goes_back,
            corner if corner != NONE else None if feature is None else self._namer.number(feature),
            names,
            cell.bounds,
        )

    def _names(self, t: Real, passed: Passed) -> Names:
        """The names of a line that bounds a family."""
        sector, feature = self.lines.sector, self._feature
        if feature is None:
            return self._namer.names_of_normal(self.contact.edge, sector, t, passed)
        return self._namer.names(feature, sector, t, passed)

    def _side(self, image: FamilyImage, role: Role) -> Side:
        return Side(image.edge(role), role, start=start_of(image, role, self.lines.table))


def start_of(image: FamilyImage, role: Role, table: EdgeTable) -> int | None:
    """What parameters are at the start of the full circle that lines meet, if surely none passes it."""
    if not (image.is_known and table.images[image.edge(role)].full):
        return None
    ends = [(low, high) for low, high, *_ in image.places(role)]
    return None if EVERYTHING in ends else 4 if (inf, inf) in ends else 0


def family_of(image: FamilyImage) -> LineFamily:
    """The family of an image."""
    assert isinstance(image.origin, PencilFamilies), "families come from pencils"
    return image.origin.family(image)


def rational_line(image: FamilyImage, is_last: bool) -> tuple[Point, Point] | None:
    """Contact and direction of the first or the last line of a family, if these are seen to be rational."""
    assert isinstance(image.origin, PencilFamilies), "families come from pencils"
    lines = image.origin.lines
    row = lines.rows[image.number]
    value = lines.rational(row.last if is_last else row.first)
    if value is None:
        return None
    contact, direction = lines.sector.touch(Real(value))
    return None if contact.rational is None or direction.rational is None else (contact, direction)


class SingleLine:
    """A single line: from ``place`` it shows edge ``shown`` from one point of a run to the other.

    The place lies on edge ``edge``, with parameter ``u`` if known, or in free space within reach (None);
    what lies between sees the run too. It may be given as what makes it. ``keys`` are numbers of the line
    (see `line_keys`).
    """

    __slots__ = ("_reached", "_views", "edge", "keys", "run", "shown")

    def __init__(
        self, reached: Reached | Callable[[], Reached], run: tuple[Pin, Pin], image: SingleImage
    ) -> None:
        self._reached, self.run = reached, run
        self.edge = None if image.edge == NONE else image.edge
        self.shown, self.keys = image.shown, image.keys
        self._views: list[ViewFamily] | None = None

    @property
    def place(self) -> Point:
        """Where the line begins."""
        return self._made[0]

    @property
    def points(self) -> tuple[Point, Point]:
        """The nearest and the farthest point of the run."""
        (near, _), (far, _) = self.run
        return near, far

    @property
    def u(self) -> Real | None:
        """The parameter of the place on its edge, if it is known."""
        return self._made[1]

    @property
    def _made(self) -> Reached:
        if not isinstance(self._reached, tuple):
            self._reached = self._reached()
        return self._reached

    def views(self, here: int, clipper: FamilyClipper) -> tuple[list[ViewFamily], int]:
        """The views from the place, which lies on an edge, within range; and on which side of them is *here*.

        They are made when they are first asked for.
        """
        if self._views is None:
            assert self.edge is not None, "a place in free space is on no edge"
            ends = clipper.along(self.pin(0, clipper), self.run, self.shown)
            self._views = [ViewFamily((self.edge, self.shown), *end) for end in ends]
        return self._views, here

    def pin(self, here: int, clipper: FamilyClipper) -> Pin:
        """The place, which lies on an edge, or if *here* is 1 the nearest point of the run."""
        if here:
            return self.run[0]
        place, u = self._made
        assert self.edge is not None, "a place in free space is on no edge"
        return place, clipper.rails[self.edge].parameter(place) if u is None else u


class SingleLines(ABC):
    """What makes single lines from their images, of which it is the origin."""

    @abstractmethod
    def single(self, image: SingleImage) -> SingleLine:
        """A single line, made when it is first asked for."""


def single_of(image: SingleImage) -> SingleLine:
    """The single line of an image."""
    assert isinstance(image.origin, SingleLines), "single lines come from lines"
    return image.origin.single(image)
