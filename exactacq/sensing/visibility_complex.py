"""The visibility complex of a scene within a radius: families of free lines, computed on demand and kept.

Its edges are families of lines that touch one feature, its vertices are lines that touch two, the free
bitangents (Pocchiola and Vegter, "The visibility complex", 1996). Where a viewer crosses such a line its
view changes: a visual event (Hall-Holt, "Kinetic visibility", 2002). Three kinds of families are swept
where the robot comes near: the tangent lines of every feature, the normals of every edge, and the normals
of every convex corner. Each is swept once; cost: near linear in the scene at constant density and range.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property, lru_cache

import numpy as np

from exactacq.kernel.extents import Extent, extents_from
from exactacq.kernel.family_images import FamilyImage
from exactacq.scene.edge_table import EdgeTable, Floats, Ints
from exactacq.sensing.complex_edges import FamilySweeper, FeatureFamilies
from exactacq.sensing.line_family import LineFamily, SingleLine, family_of
from exactacq.sensing.view_families import ViewFamily
from exactacq.visibility.sensor_range import Range

KEPT = 1024
"""Families that are remembered, the last used of each kind: enough for a wide neighbourhood, and a bound of
the memory."""

EDGES_KEPT = 256
"""Edges for which it is remembered what is seen from them."""


class VisibilityComplex:
    """The families of views of one scene within one radius."""

    def __init__(self, table: EdgeTable, range_: Range) -> None:
        self.table, self.range = table, range_
        sweeper = FamilySweeper(table, range_)
        self.clipper, self.features = sweeper.clipper, sweeper.features
        self.images = sweeper.images
        self._normals_of = lru_cache(KEPT)(sweeper.normals)
        self._tangents_of = lru_cache(KEPT)(sweeper.tangents)
        self._corner_normals_of = lru_cache(KEPT)(sweeper.corner_normals)
        self._extents_from = lru_cache(EDGES_KEPT)(self._from)

    @cached_property
    def _spots(self) -> Floats:
        """Boxes of the features: where their contacts lie."""
        boxes = [
            self.table.boxes[f.edges[0]] if f.round else (*self.table.start[f.edges[1]],) * 2
            for f in self.features
        ]
        return np.array(boxes, dtype=float).reshape(-1, 4)

    @cached_property
    def _features_at(self) -> Ints:
        """For every edge its number as a feature, and that of its start; -1 for none."""
        numbers = np.full((len(self.table.curves), 2), -1, dtype=np.intp)
        for k, feature in enumerate(self.features):
            numbers[feature.edges[-1], int(not feature.round)] = k
        return numbers

    def extents(self, edge: int) -> list[Extent]:
        """What the families at an edge show of others from it, in floats.

        Not what starts at a corner of the edge: what a corner sees is a view. The last are kept: a robot
        comes back to an edge.
        """
        return self._extents_from(edge)

    def views(self, one: Extent) -> Iterator[tuple[ViewFamily, int]]:
        """The families that `extents` tells of, and which of their sides lies on the edge."""
        source = family_of(one.origin) if isinstance(one.origin, FamilyImage) else one.origin
        assert isinstance(source, LineFamily | SingleLine), "families come from lines"
        families, side = source.views(one.here, one.there, self.clipper)
        return ((family, side) for family in families)

    def _from(self, edge: int) -> list[Extent]:
        families: list[FamilyImage] = []
        single_lines: list[Extent] = []
        for feature in self.near(self.table.boxes[edge], own=edge):
            families += feature.images
            for single in feature.single_lines:
                if single.edge == edge:
                    single_lines.append(single.extent(self.table))
                if single.edge is not None and single.shown == edge:
                    single_lines.append(single.extent(self.table, here=1))
        images = self.images
        return extents_from(edge, families, images.curves, images.reach) + single_lines

    def near(
        self, box: Floats, wanted: frozenset[int] | None = None, own: int | None = None
    ) -> Iterator[FeatureFamilies]:
        """The families that may show edges, the *wanted* ones if given, to places in a box.

        The box lies on edge *own* if that is given. A tangent's contact lies between the two ends of a view,
        so both are within reach of it together.
        """
        left, bottom, right, top = box.tolist()
        reach = self.range.above + 8 * self.table.roundoff
        around = self.table.near((left, bottom), (right, top), self.range.above)
        edges = around if wanted is None else np.array(sorted(wanted), dtype=np.intp)
        edges = edges[_gaps(self.table.boxes[edges], box) <= reach]
        for e in edges.tolist():
            if e != own:
                yield self._normals_of(e)
        if own is not None:
            yield self._normals_of(own)
        close = self._features_at[around].ravel()
        close = close[close >= 0]
        here = _gaps(self._spots[close], box)
        close, here = close[here <= reach], here[here <= reach]
        if wanted is not None:
            there = _gaps(self.table.boxes[edges], self._spots[close, None]).min(axis=1, initial=np.inf)
            close = close[here + there <= reach]
        for k in close.tolist():
            yield self._tangents_of(k)
            feature = self.features[k]
            if not feature.round and (wanted is None or feature.edges[1] in wanted):
                yield self._corner_normals_of(k)


def _gaps(boxes: Floats, box: Floats) -> Floats:
    """Distances of boxes from a box, or from each of several in a row of its own."""
    apart = np.maximum(np.maximum(boxes[:, :2] - box[..., 2:], box[..., :2] - boxes[:, 2:]), 0.0)
    return np.hypot(apart[..., 0], apart[..., 1])
