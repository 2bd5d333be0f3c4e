"""One-parameter families of views: free segments between two boundary edges, none longer than the range.

Take a point of edge f that is visible from edge e, and its *shortest* view from e. It cannot be shortened
by moving its end along e. So it touches a corner or a convex arc that keeps it from moving, or it is
normal to e, or it starts at an end of e. Hence the tangent lines of corners and arcs, the normals of
edges and the rays from vertices, families with one parameter each, contain every shortest view: together
they give all that e sees of f, and, with the roles exchanged, the part of e from which anything of f is
in sight. A `FreeViews` is such a family before the range is considered; `FamilyClipper.families` restricts it
to the range, and the results are `ViewFamily` objects. A `LineView` is one view of either.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from exactacq.geometry.interval_union import Interval
from exactacq.geometry.late import Pin
from exactacq.geometry.points import Point
from exactacq.kernel.line_keys import LineNumbers
from exactacq.numbers.real import Real
from exactacq.sensing.line_points import Role, Side
from exactacq.visibility.line_families import Sector, Sliding, Spokes
from exactacq.visibility.line_names import Names
from exactacq.visibility.rotational_sweep import Passed
from exactacq.visibility.sensor_range import Range

SidePin: TypeAlias = "tuple[int, Pin]"
"""The point of the first side, 0, or of the second one, 1."""


@dataclass(slots=True)
class LineView:
    """A view along one line: the line's parameter ``t``, both end points, and their parameters on the rails.

    ``tight`` if it is known to be as long as the range, because the views on one side of it are longer.
    """

    t: Real
    points: tuple[Point, Point]
    places: tuple[Real, Real]
    tight: bool = False

    def is_short(self, range_: Range) -> bool:
        """Whether the view is shorter than the range."""
        return not self.tight and range_.order(*self.points) < 0

    def tightened(self) -> LineView:
        """The view, marked as exactly as long as the range."""
        return LineView(self.t, self.points, self.places, tight=True)

    def placed(self, k: int, place: Real) -> LineView:
        """The view with the parameter *place* on side k."""
        places = (place, self.places[1]) if k == 0 else (self.places[0], place)
        return LineView(self.t, self.points, places, self.tight)

    def pinned(self, k: int, point: Point, place: Real) -> LineView:
        """The view with *point* and its parameter *place* on side k."""
        points = (point, self.points[1]) if k == 0 else (self.points[0], point)
        return LineView(self.t, points, self.places, self.tight).placed(k, place)


@dataclass(slots=True)
class FreeViews:
    """The views between two sides along the lines of a sector from ``low`` to ``high``.

    ``names`` are those of the first and the last line (see `line_names`); ``pinned`` are their points on the
    first side, where these are known; ``passed`` tells what they pass. ``anchor`` is the number of the
    feature that tangents touch; the views along normals, without, bound nothing of what is seen. ``in_range``
    if all are known to be within range.
    """

    sector: Sector
    low: Real
    high: Real
    sides: tuple[Side, Side]
    names: tuple[Names, Names] = ((), ())
    pinned: tuple[Pin | None, Pin | None] = (None, None)
    passed: tuple[Passed, Passed] = ((), ())
    anchor: int | None = None
    in_range: bool = False

    @property
    def is_normal(self) -> bool:
        """Whether the lines are normals of an edge."""
        return isinstance(self.sector, Sliding | Spokes)

    def grows(self, k: int) -> bool | None:
        """Whether the parameter of side k grows where it does not stay; None if the lines do not tell.

        Lines that turn meet edges at places that move back along these: edges have their obstacles to the
        left, and lines enter them, going ahead or back. Where the contact moves, it does so ahead on its arc.
        """
        side = self.sides[k]
        return None if side.on_way or not self.sector.turns else side.role is Role.CONTACT

    def lines(self, t: Real) -> frozenset[int]:
        """The numbers of the first or the last line; none if it has no name."""
        bounds = zip((self.low, self.high), self.names, strict=True)
        return frozenset(number for bound, names in bounds if t is bound for number, _ in names)

    def touched(self, t: Real, numbers: LineNumbers) -> list[int]:
        """The features that the first or the last line touches, by their numbers; none for a normal."""
        for bound, passed in zip((self.low, self.high), self.passed, strict=True):
            if t is bound and self.anchor is not None:
                return [self.anchor, *(numbers.feature(number, side != 0) for number, side, _ in passed)]
        return []


@dataclass(slots=True)
class ViewFamily:
    """A family of free views within range, from one extreme view to the other; both ends move monotonically.

    Without ``free_views`` it has one fixed end, and all its views lie on one line.
    """

    edges: tuple[int, int]
    first: LineView
    last: LineView
    free_views: FreeViews | None = None

    def ends_on(self, k: int) -> tuple[LineView, LineView]:
        """The extreme views with the lower and the higher parameter of side k."""
        grows = None if self.free_views is None else self.free_views.grows(k)
        if grows is None:
            grows = self.first.places[k].compare(self.last.places[k]) <= 0
        return (self.first, self.last) if grows else (self.last, self.first)

    def interval(self, k: int) -> Interval:
        """What the family has of side k."""
        one, other = self.ends_on(k)
        return Interval(one.places[k], one.points[k], other.places[k], other.points[k])
