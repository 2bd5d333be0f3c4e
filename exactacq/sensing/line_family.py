"""The families and the single lines of one pencil: views along free lines, made when they are asked for.

A family (a `LineFamily`) is a maximal set of neighbouring lines that all meet the same two edges, one behind
the contact and one ahead of it. It contains three families of views (a `FreeViews` each): from the edge
behind to the contact, from the contact to the edge ahead, and from the one edge to the other.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.curves import Segment
from exactacq.geometry.points import Point
from exactacq.kernel.cells import LineCells
from exactacq.kernel.extents import EVERYTHING, NOTHING, Extent
from exactacq.kernel.family_images import NONE, FamilyImage
from exactacq.kernel.images import TURNING
from exactacq.kernel.line_keys import LineNumbers
from exactacq.kernel.pencil_images import pencil_images
from exactacq.numbers.real import Real
from exactacq.sensing.line_images import LineImages
from exactacq.sensing.line_points import Role, Side
from exactacq.sensing.view_families import FamilyClipper, FreeViews, ViewFamily
from exactacq.visibility.features import Feature
from exactacq.visibility.line_families import Sector
from exactacq.visibility.line_names import Anchor, Namer, Names
from exactacq.visibility.rotational_sweep import Passed, Pencil


@dataclass(slots=True)
class LineFamily:
    """A cell of a pencil with what its lines meet; None where nothing is met within reach.

    Normals have nothing ``behind`` and do not go back: they start at the contact, which lies on an edge. So
    does the contact of a convex arc; a corner counts as the start of the edge that follows it. ``anchor``
    names what tangents touch, ``names`` the first and the last line (see `line_names`), ``passed`` what they
    pass.
    """

    sector: Sector
    low: Real
    high: Real
    behind: Side | None
    contact: Side
    ahead: Side | None
    goes_back: bool
    anchor: Anchor | None = None
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
        own = NONE if feature is None or not self.goes_back else self._namer.number(feature)
        is_round = feature is not None and feature.round
        frame, at = lines.sector.image, (contact.edge, contact.fixed)
        found = pencil_images(lines.rows, frame, at, self.goes_back, (own, is_round), numbers, self)
        images.locate(found, lines)
        return found

    def family(self, image: FamilyImage) -> LineFamily:
        """The family of an image, made when it is first asked for."""
        k = image.number
        if k not in self._made:
            self._made[k] = self._family(self.lines.rows[k])
        return self._made[k]

    def _family(self, row: LineCells) -> LineFamily:
        cell, feature = self.lines.cell(row), self._feature
        behind = None if cell.behind is None or not self.goes_back else Side(cell.behind, Role.BEHIND)
        ahead = None if cell.ahead is None else Side(cell.ahead, Role.AHEAD)
        names: tuple[Names, Names] = (), ()
        if feature is not None and self.goes_back:
            first, last = (
                self._namer.names(feature, self.lines.sector, t, passed)
                for t, passed in zip((cell.low, cell.high), cell.bounds, strict=True)
            )
            names = first, last
        return LineFamily(
            self.lines.sector,
            cell.low,
            cell.high,
            behind,
            self.contact,
            ahead,
            self.goes_back,
            None if feature is None else self._namer.anchor(feature),
            names,
            cell.bounds,
        )


def family_of(image: FamilyImage) -> LineFamily:
    """The family of an image."""
    assert isinstance(image.origin, PencilFamilies), "families come from pencils"
    return image.origin.family(image)


@dataclass(slots=True)
class SingleLine:
    """A single line: from ``place`` it shows edge ``shown`` from one point of a run to the other.

    The place lies on edge ``edge``, with parameter ``u`` if known, or in free space within reach (None);
    what lies between sees the run too.
    """

    place: Point
    edge: int | None
    run: tuple[Point, Point]
    shown: int
    u: Real | None = None
    _views: list[ViewFamily] | None = None
    _image: FamilyImage | None = None

    @property
    def line(self) -> tuple[Point, Point]:
        """Two points of the line, of the scene's if possible."""
        return self.run if self.run[0] is not self.run[1] else (self.place, self.run[0])

    @property
    def image(self) -> FamilyImage:
        """The line in floats, as a family of one: by a point and a direction.

        The points are subtracted exactly and then rounded: the difference of their floats could be 0.
        """
        if self._image is None:
            self._image = self._imaged()
        return self._image

    def _imaged(self) -> FamilyImage:
        start, end = self.line
        way = curve_image(Segment(start, end))
        frame = TURNING, way.x, way.y, way.wx, way.wy, 0.0, 1
        at = 0.0, 0.0, 0.0, 0.0
        return FamilyImage(frame, at, (NONE, NONE, NONE), False, True, NONE, ([], []), ([], []), None, 0)

    def extent(self, images: LineImages, here: int = 0) -> Extent:
        """What is shown at most, and from where: of the run from the place, or if *here* of the place."""
        edge, shown, source = self.shown, images.hull(self.shown, self.run), EVERYTHING
        if self.edge is not None:
            source = images.hull(self.edge, (self.place,))
            if here:
                edge, shown, source = self.edge, source, shown
        return Extent(edge, shown, source, NOTHING, [], [], self, here, 1 - here, True)

    def views(self, here: int, there: int, clipper: FamilyClipper) -> tuple[list[ViewFamily], int]:
        """The views from the place, which lies on an edge, within range; and on which side of them is *here*.

        They are made when they are first asked for.
        """
        if self._views is None:
            assert self.edge is not None, "a place in free space is on no edge"
            u = clipper.rails[self.edge].parameter(self.place) if self.u is None else self.u
            ends = clipper.along((self.place, u), self.run, self.shown)
            self._views = [ViewFamily((self.edge, self.shown), *end) for end in ends]
        return self._views, here
