"""The visibility complex of a scene within a radius: families of free lines, computed on demand and kept.

Its edges are families of lines that touch one feature, its vertices are lines that touch two, the free
bitangents (Pocchiola and Vegter, "The visibility complex", 1996). Where a viewer crosses such a line its
view changes: a visual event (Hall-Holt, "Kinetic visibility", 2002). Four kinds of families are swept
where the robot comes near: the tangent lines of every feature, the normals of every edge, those of every
convex corner, and the rays from the ends of edges. Normals only tell from where an obstacle is in sight; they
are swept where tangents may not (see `exactacq.kernel.normals`). A family that was dropped is swept again
where the robot comes back; cost: near linear in the scene at constant density and range.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from math import inf

from exactacq import kernel
from exactacq.cached import cached_property
from exactacq.geometry.late import Pin
from exactacq.kernel.extents import Extent
from exactacq.kernel.family_images import NONE, FamilyImage
from exactacq.kernel.normals import Front, shows_along_normals, telling
from exactacq.kernel.shadows import Spot
from exactacq.kernel.single_lines import EdgeFamilies, SingleImage, shown_from
from exactacq.recent import Recent
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.complex_edges import FamilySweeper
from exactacq.sensing.line_family import family_of, single_of
from exactacq.sensing.view_families import ViewFamily
from exactacq.visibility.sensor_range import Range

KEPT = 512
"""When the families of so many edges are remembered, or of twice those of a neighbourhood if these are more,
the others are dropped that were not used meanwhile. So no one way makes a family twice, and memory is
bounded by what is near. With four times as many a run among 1,000 octagons takes an eighth less time, and
95 MB more."""
SEEN_FROM_KEPT = 128
"""Edges for which it is remembered what is seen from them."""


class VisibilityComplex:
    """The families of views of one scene within one radius."""

    def __init__(self, table: EdgeTable, range_: Range, cut: Collection[int] = ()) -> None:
        """Of *cut* obstacles only a part counts.

        To ``done`` may be added edges of obstacles of which nobody asks any more from where they are seen.
        """
        self.table, self.range, self._cut = table, range_, cut
        self.done: set[int] = set()
        sweeper = FamilySweeper(table, range_)
        self.clipper, self.images = sweeper.clipper, sweeper.images
        self._tangents = FamilyStore(sweeper.tangents)
        self._normals = FamilyStore(sweeper.normals)
        self._corner_normals = FamilyStore(sweeper.corner_normals)
        self._rays = FamilyStore(sweeper.rays)
        self._seen_from = Recent[int, list[Extent]](SEEN_FROM_KEPT)

    def near(self, places: tuple[Spot, ...]) -> list[EdgeFamilies]:
        """The tangents and normals of the edges in sight between some places: all that may show anything."""
        return self.sighting(places) + self._corner_normals.of(self._edges(places))

    def sighting(self, places: tuple[Spot, ...]) -> list[EdgeFamilies]:
        """Those that tell that an edge is in sight. Normals at a corner do not: they show one point of it."""
        edges = self._edges(places)
        return self._tangents.of(edges) + self._normals.of(edges)

    def telling(self, places: tuple[Spot, ...], edge: int = NONE) -> list[EdgeFamilies]:
        """Those without which it would not be known what is shown, and from where an obstacle is in sight.

        The places are on an edge, if it is given, or the ends of a straight way.
        """
        if kernel.EXACT_ONLY:
            return self.near(places)
        edges = self._edges(places)
        asked = [e for e in edges if e == edge or e not in self.done]
        along, corners = telling(self._fronts, asked, places, edge, self.images.reach)
        return self._tangents.of(edges) + self._normals.of(along) + self._corner_normals.of(corners)

    def shows_along_normals(self, places: tuple[Spot, ...], edges: Collection[int]) -> bool:
        """Whether of some edges there may be something that only normals of a way between two places show."""
        return kernel.EXACT_ONLY or shows_along_normals(self._fronts, [*edges], places, self.images.reach)

    def rays(self, places: tuple[Spot, ...]) -> list[EdgeFamilies]:
        """The rays from the ends of the edges in sight between some places (see `end_rays`)."""
        return self._rays.of(self._edges(places))

    def _edges(self, places: tuple[Spot, ...]) -> list[int]:
        """The edges that may be seen from somewhere between some places."""
        return self.table.lit(places, self.range.above)

    @cached_property
    def _fronts(self) -> list[Front]:
        """The edges as it takes them to tell whose normals matter."""
        table = self.table
        plane = -inf, -inf, inf, inf
        boxes = [plane if k in self._cut else hull for k, hull in enumerate(map(tuple, table.hulls.tolist()))]
        images, owners = table.curve_images, table.owners
        return [
            Front(image, images[table.preceding[e]], owners[e], boxes[owners[e]])
            for e, image in enumerate(images)
        ]

    def extents(self, edge: int) -> list[Extent]:
        """What tangents and normals at an edge show of others from it, in floats.

        Not what starts at a corner of the edge: what a corner sees is a view.
        """
        return self._shown(edge, self.near(self.table.spots(edge)))

    def sighting_extents(self, edge: int) -> list[Extent]:
        """What families show from an edge that tell what is in sight, in floats; single lines do not."""
        found = self._shown(edge, self.sighting(self.table.spots(edge)))
        return [one for one in found if isinstance(one.origin, FamilyImage)]

    def extents_of_rays(self, edge: int) -> list[Extent]:
        """Which edges the rays from their ends show from an edge, in floats."""
        return self._shown(edge, self.rays(self.table.spots(edge)))

    def telling_extents(self, edge: int) -> list[Extent]:
        """What `telling` families show of others from an edge, in floats; as `extents`.

        The last are kept: a robot comes back to an edge.
        """
        found = self._seen_from.get(edge)
        if found is None:
            found = self._shown(edge, self.telling(self.table.spots(edge), edge))
            self._seen_from.put(edge, found)
        return found

    def _shown(self, edge: int, near: list[EdgeFamilies]) -> list[Extent]:
        """What families show of others from an edge, and single lines that meet it."""
        return shown_from(edge, near, self.table.curve_images, self.images.reach)

    def views(self, one: Extent) -> Iterator[tuple[ViewFamily, int]]:
        """The families that `extents` tells of, and which of their sides lies on the edge."""
        source, here, there = one.origin, one.here, one.there
        if isinstance(source, FamilyImage):
            families, side = family_of(source).views(here, there, self.clipper, one.in_range)
        else:
            assert isinstance(source, SingleImage), "families come from lines"
            families, side = single_of(source).views(here, self.clipper)
        return ((family, side) for family in families)

    def pin(self, one: Extent, is_last: bool) -> Pin:
        """Where the first or the last line of a family that `extents` tells of meets the edge."""
        source = one.origin
        if isinstance(source, FamilyImage):
            return family_of(source).pin(one.here, is_last, self.clipper)
        assert isinstance(source, SingleImage), "families come from lines"
        return single_of(source).pin(one.here, self.clipper)


class FamilyStore:
    """Families of one kind by their edges, swept where that was not done yet."""

    def __init__(self, swept: Callable[[int], EdgeFamilies]) -> None:
        """*swept* are the families of an edge."""
        self._swept, self._most = swept, KEPT
        # Those that were used since the last ones were dropped, and what was there before.
        self._used: dict[int, EdgeFamilies] = {}
        self._before: dict[int, EdgeFamilies] = {}

    def of(self, edges: list[int]) -> list[EdgeFamilies]:
        """The families of some edges."""
        used = self._used
        for e in [e for e in edges if e not in used]:
            families = self._before.pop(e, None)
            used[e] = self._swept(e) if families is None else families
        self._most = max(self._most, 2 * len(edges))
        if len(used) >= self._most:
            self._used, self._before = {}, used
        return [used[e] for e in edges]
