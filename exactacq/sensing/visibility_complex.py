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

from exactacq.scene.edge_table import EdgeTable, Floats, Ints
from exactacq.sensing.complex_edges import Bundle, FamilySweeper, FeatureFamilies
from exactacq.sensing.line_images import LineImages
from exactacq.visibility.sensor_range import Range

KEPT = 1024
"""Families that are remembered, the last used of each kind: enough for a wide neighbourhood, and a bound of
the memory."""


class VisibilityComplex:
    """The families of views of one scene within one radius."""

    def __init__(self, table: EdgeTable, range_: Range) -> None:
        self.table, self.range = table, range_
        sweeper = FamilySweeper(table, range_)
        self.clipper, self.features = sweeper.clipper, sweeper.features
        self.images = LineImages(table, range_)
        self._normals_of = lru_cache(KEPT)(sweeper.normals)
        self._tangents_of = lru_cache(KEPT)(sweeper.tangents)
        self._corner_normals_of = lru_cache(KEPT)(sweeper.corner_normals)

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

    def on(self, edge: int, wanted: frozenset[int]) -> Iterator[tuple[Bundle, int]]:
        """The bundles between an edge and wanted ones, with the number of its side.

        Not those that start at a corner of it: what a corner sees is a view.
        """
        for feature in self.near(self.table.boxes[edge], wanted, edge):
            for bundle, side in feature.on(edge):
                if bundle.sides[1 - side].edge in wanted:
                    yield bundle, side

    def near(self, box: Floats, wanted: frozenset[int], own: int | None = None) -> Iterator[FeatureFamilies]:
        """The families that may show wanted edges to places in a box, which lies on edge *own* if given.

        A tangent's contact lies between the two ends of a view, so both are within reach of it together.
        """
        edges = np.array(sorted(wanted), dtype=np.intp)
        reach = self.range.above + 8 * self.table.roundoff
        edges = edges[_gaps(self.table.boxes[edges], box) <= reach]
        for e in edges.tolist():
            if e != own:
                yield self._normals_of(e)
        if own is not None:
            yield self._normals_of(own)
        left, bottom, right, top = box.tolist()
        close = self._features_at[self.table.near((left, bottom), (right, top), self.range.above)].ravel()
        close = close[close >= 0]
        here = _gaps(self._spots[close], box)
        close, here = close[here <= reach], here[here <= reach]
        there = _gaps(self.table.boxes[edges], self._spots[close, None]).min(axis=1, initial=np.inf)
        for k in close[here + there <= reach].tolist():
            yield self._tangents_of(k)
            if not self.features[k].round and self.features[k].edges[1] in wanted:
                yield self._corner_normals_of(k)


def _gaps(boxes: Floats, box: Floats) -> Floats:
    """Distances of boxes from a box, or from each of several in a row of its own."""
    apart = np.maximum(np.maximum(boxes[:, :2] - box[..., 2:], box[..., :2] - boxes[:, 2:]), 0.0)
    return np.hypot(apart[..., 0], apart[..., 1])
