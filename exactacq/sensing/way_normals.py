"""What is seen along the normals of a straight way, to both sides."""

from __future__ import annotations

from collections.abc import Iterator

from exactacq.cached import cached_property
from exactacq.geometry.coordinates import minus, raw
from exactacq.geometry.curves import Arc
from exactacq.geometry.late import Pin
from exactacq.kernel.extents import Extent
from exactacq.kernel.family_images import NONE, FamilyImage
from exactacq.kernel.images import SLIDING
from exactacq.kernel.line_keys import LineNumbers
from exactacq.kernel.pencil_images import pencil_images
from exactacq.kernel.ways import extents_along_normals
from exactacq.numbers.real import Real
from exactacq.sensing.line_family import start_of
from exactacq.sensing.line_points import Role, Side
from exactacq.sensing.straight_way import StraightWay, View
from exactacq.sensing.view_families import FreeViews, ViewFamily
from exactacq.visibility.line_families import Sliding
from exactacq.visibility.rotational_sweep import Pencil, pencil

BITS = 64
"""Precision of the balls that tell on which side of a centre an end of the way lies."""


class WayNormals:
    """The normals of one way that meet *wanted* edges; *view* tells what is seen from its ends."""

    def __init__(self, way: StraightWay, wanted: frozenset[int], view: View) -> None:
        self.way, self.wanted, self._view = way, wanted, view

    @cached_property
    def images(self) -> list[FamilyImage]:
        """Their families in floats. Each knows the pencil that it comes from."""
        way, found = self.way, list[FamilyImage]()
        start, end = raw(way.line.start), raw(way.line.end)
        line, complex_ = way.image.line, way.complex
        along, span = minus(end, start), way.span
        for sense in (1, -1):
            sector = Sliding(start, along, span.low, span.high, sense > 0, self._touching)
            sweep = pencil(way.table, sector, (), complex_.range.above)
            frame = SLIDING, line.x, line.y, line.wx, line.wy, 0.0, sense
            no_names = (NONE, NONE), False, NONE, LineNumbers([])
            curves, following = complex_.images.curves, way.table.following
            images = pencil_images(sweep.rows, frame, *no_names, curves, following, sweep)
            complex_.images.unroll(images, sweep)
            found += images
        return [image for image in found if image.edge(Role.AHEAD) in self.wanted]

    @cached_property
    def _touching(self) -> dict[tuple[int, int], Real]:
        """The ends of the way at which it is normal to an arc: there its own normal touches the arc's circle.

        By circles and the sign of that normal among the two that touch. That these are equal is long to prove
        where the way is irrational: robots leave arcs, and come to them, along normals. And the ends that are
        vertices, by their numbers and 0.
        """
        found: dict[tuple[int, int], Real] = {}
        if self.way.piece.direction.rational is None:
            for point, u in self.way.ends:
                found.update(((vertex, 0), u) for vertex in self.way.table.vertices_at(point))
                for e in self.way.seen_from(self._view, point).own:
                    arc = self.way.table.curves[e]
                    if isinstance(arc, Arc) and self.way.passes_centre(circle := self.way.table.circles[e]):
                        side = (point - arc.center).dot(self.way.piece.direction).clear_sign(BITS)
                        if side:
                            found[circle, side] = u
        return found

    def extents(self) -> list[Extent]:
        """What they show, in floats; the origins are their images."""
        return extents_along_normals(self.images, self.way.table.curve_images, self.way.complex.images.reach)

    def views(self, image: FamilyImage) -> Iterator[ViewFamily]:
        """The views of a family."""
        sweep = image.origin
        assert isinstance(sweep, Pencil), "normals come from pencils"
        cell = sweep.cell(sweep.rows[image.number])
        start = start_of(image, Role.AHEAD, self.way.table)
        here = Side(self.way.number, Role.CONTACT, on_way=True)
        sides = here, Side(image.edge(Role.AHEAD), Role.AHEAD, start=start)
        pinned = self._pin(cell.low), self._pin(cell.high)
        free_views = FreeViews(sweep.sector, cell.low, cell.high, sides, pinned=pinned, passed=cell.bounds)
        yield from self.way.clipper.families(free_views)

    def _pin(self, t: Real) -> Pin | None:
        """The end of the way from which a normal goes, if it is one."""
        if t.is_late:
            return None
        return next((pin for pin in self.way.ends if t is pin[1] or t.key == pin[1].key), None)
