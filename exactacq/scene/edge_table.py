"""The scene's edges as flat arrays: exact curves beside their float images, which only prune.

``roundoff`` bounds the error of every float coordinate and of every difference of two of them; the
margins of the pruning code are multiples of it.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from math import inf
from typing import Any

import numpy as np
from flint import fmpq, fmpz
from numpy.typing import NDArray

from exactacq.cached import cached_property
from exactacq.geometry.box_index import bounds, circles, united
from exactacq.geometry.constructions import circles_touched, corners_passed
from exactacq.geometry.coordinates import raw
from exactacq.geometry.curve_images import curve_image
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.kernel import images
from exactacq.kernel.box_tree import BoxNode, box_tree
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.images import EdgeImage
from exactacq.kernel.lattice import Lattice
from exactacq.kernel.line_keys import LineNumbers
from exactacq.kernel.lines import Line
from exactacq.kernel.shadows import Shadows, Spot, lit
from exactacq.numbers.float_bounds import margin
from exactacq.recent import Recent
from exactacq.scene.scene import Obstacle

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

STRAIGHT, CONVEX, CONCAVE = images.STRAIGHT, images.CONVEX, images.CONCAVE
NEAR_KEPT = 1024
"""So many lists of what is near are remembered: those of a wide neighbourhood."""
LATTICE_BITS = 64
"""Up to this size of the common denominator vertices are looked at as integers."""
COARSE_BITS = 32
"""Up to this size of the common denominator coordinates are not rounded: those that should be equal are."""
HIDING = 0.4
"""Within this part of the reach is looked for what hides others,"""
CLOSE = 0.2
"""if within this part of it"""
MANY = 24
"""there are so many edges: among fewer ones that takes as long as is spared."""
SAMPLES = 16
"""If it is so at none of so many edges, it is looked for nowhere."""
BITS = 64
"""Precision of the balls that tell which edges are not near a point."""
ROUNDOFF = 2.0**-50
"""What differences of coordinates are off by at most, relative to the largest of them."""


class EdgeTable:
    """All boundary edges of a scene, numbered obstacle by obstacle.

    Edge ``e`` starts at vertex ``e``, where ``previous[e]`` ends, and ends at vertex ``next[e]``;
    the edge of a full circle has no vertex. Built in near linear time.
    """

    def __init__(self, obstacles: Sequence[Obstacle]) -> None:
        self.obstacles = obstacles
        self.curves: list[Curve] = [edge for o in obstacles for edge in o.edges]
        counts = [len(o.edges) for o in obstacles]
        self.owner: Ints = np.repeat(np.arange(len(obstacles)), counts)
        self.owners: list[int] = self.owner.tolist()
        self.numbers: list[int] = [k for count in counts for k in range(count)]
        firsts = np.cumsum([0, *counts])
        self.first: Ints = firsts[:-1]
        self.next: Ints = np.arange(1, len(self.curves) + 1)
        self.next[firsts[1:] - 1] = firsts[:-1]
        self.previous: Ints = np.argsort(self.next)
        self.following: list[int] = self.next.tolist()
        self.preceding: list[int] = self.previous.tolist()
        self.starts: list[Point] = [c.start for c in self.curves]
        self.vertices = [_pair(start) for start in self.starts]
        self.kind = np.array([_kind(c) for c in self.curves], dtype=np.int8)
        self.kinds: list[int] = self.kind.tolist()
        self.full = np.array([isinstance(c, Arc) and c.full for c in self.curves], dtype=bool)
        self.start: Floats = np.array([_floats(v) for v in self.vertices], dtype=float).reshape(-1, 2)
        self.end = self.start[self.next] if len(self.curves) else self.start
        self.rows: Floats = np.concatenate((self.start, self.end - self.start), axis=1).T.copy()
        """Four rows: where every edge starts, and the vector from there to its end."""
        self.curved = bool(self.kind.any())
        round_ = circles(self.curves)
        self.center, self.radius = round_[:, :2], round_[:, 2]
        self.boxes: Floats = bounds(self.curves)
        self._around = Recent[tuple[Spot, Spot, float], list[int]](NEAR_KEPT)
        self._lit = Recent[tuple[tuple[Spot, ...], float], list[int]](NEAR_KEPT)
        self._dense: dict[float, bool] = {}
        self.magnitude = float(np.abs(self.boxes).max(initial=0.0))
        self._largest = max(self.magnitude, float(self.radius.max(initial=0.0)))

    @property
    def roundoff(self) -> float:
        """The bound of errors, infinite if tests want nothing decided by floats."""
        return margin(self._error())

    @cached_property
    def tree(self) -> BoxNode:
        """The edges' boxes, to find those that are near."""
        return box_tree([(x0, y0, x1, y1) for x0, y0, x1, y1 in self.boxes.tolist()])

    @cached_property
    def hulls(self) -> Floats:
        """The boxes of the obstacles."""
        return united(self.boxes, self.first)

    @cached_property
    def circles(self) -> dict[int, int]:
        """For every arc the number of the first arc on its circle."""
        return {e: first for first, arcs in self._on_circles.items() for e in arcs}

    @cached_property
    def _arcs_by_circle(self) -> dict[Hashable, list[int]]:
        """The arcs on each circle, by its centre and squared radius: what a `Carrier` has too."""
        found: dict[Hashable, list[int]] = {}
        for e, curve in enumerate(self.curves):
            if isinstance(curve, Arc):
                found.setdefault((*raw(curve.center), curve.radius_sq), []).append(e)
        return found

    def known_touched(self, start: Point, end: Point) -> list[int]:
        """The features that the line of two points is known to touch by how these were made, however far."""
        numbers = self.line_numbers
        passed = (corner for corner in corners_passed(start, end) if not corner.is_late)
        corners = (v for corner in passed for v in self.vertices_at(corner))
        arcs = (self._arcs_by_circle.get(circle) for circle in circles_touched(start, end))
        found = [numbers.feature(v, False) for v in corners if not self.full[v]]
        return found + [numbers.feature(some[0], True) for some in arcs if some is not None]

    def vertices_at(self, point: Point) -> list[int]:
        """The vertices at a point."""
        if point.rational is None:
            return []
        near = self.around(point.xy, point.xy, 0.0)
        return [e for e in near if self.vertices[e] == point.rational]

    def arc_on(self, circle: int) -> Arc:
        """The first arc on a circle, which is given as a feature (see `line_numbers`)."""
        arc = self.curves[self.line_numbers.first_arc(circle)]
        assert isinstance(arc, Arc), "only arcs have circles"
        return arc

    def on_circle_of(self, e: int) -> tuple[int, ...]:
        """The arcs on the circle of an arc, itself among them; a straight edge alone."""
        return self._on_circles.get(self.circles.get(e, e), (e,))

    @cached_property
    def _on_circles(self) -> dict[int, tuple[int, ...]]:
        """By the first arc of every circle all that are on it."""
        return {arcs[0]: tuple(arcs) for arcs in self._arcs_by_circle.values()}

    @cached_property
    def line_numbers(self) -> LineNumbers:
        """What numbers corners, circles, and lines that touch two of them."""
        return LineNumbers([self.circles.get(e, e) for e in range(len(self.curves))])

    @cached_property
    def images(self) -> list[EdgeImage]:
        """The edges as the compiled loops take them."""
        centers = (_pair(c.center) if isinstance(c, Arc) else (fmpq(0), fmpq(0)) for c in self.curves)
        return [
            EdgeImage(with_rests(vertex), with_rests(center), *rest)
            for vertex, center, *rest in zip(
                self.vertices,
                centers,
                self.radius.tolist(),
                self.kinds,
                self.full.tolist(),
                self.following,
                self.preceding,
                strict=True,
            )
        ]

    @cached_property
    def lattice(self) -> tuple[fmpz, Lattice] | None:
        """The vertices as integers, and the number that they are multiplied by; None if that is large."""
        common = fmpz(1)
        for x, y in self.vertices:
            common = common.lcm(x.q).lcm(y.q)
            if common.height_bits() > LATTICE_BITS:
                return None
        xs, ys = ([int((v[k] * common).p) for v in self.vertices] for k in (0, 1))
        return common, Lattice(xs, ys)

    @cached_property
    def is_coarse(self) -> bool:
        """Whether vertices are on a coarse lattice, and arcs have few digits: what looks equal mostly is."""
        return (
            self.lattice is not None
            and self.lattice[0].height_bits() <= COARSE_BITS
            and all(_is_short(curve) for curve in self.curves if isinstance(curve, Arc))
        )

    @cached_property
    def curve_images(self) -> list[CurveImage]:
        """The edges one by one, as the compiled loops take them."""
        return [curve_image(curve) for curve in self.curves]

    def edges_of(self, obstacle: int) -> range:
        """The edges of one obstacle."""
        first = int(self.first[obstacle])
        return range(first, first + len(self.obstacles[obstacle].edges))

    def edges_at(self, point: Point) -> tuple[int, ...]:
        """The edges through a point of a boundary: at a vertex the incoming one, then the outgoing one.

        Empty for a point that is on no boundary.
        """
        x, y = point.xy
        near = self.around((x, y), (x, y), 0.0)
        return self.passing(near, point)

    def passing(self, edges: Iterable[int], point: Point) -> tuple[int, ...]:
        """Those of some edges that pass through a point: at a vertex the incoming one first."""
        found = [e for e in edges if _passes(self.curves[e], point)]
        if len(found) == 2 and self.curves[found[0]].start == point:
            found.reverse()
        return tuple(found)

    def roundoff_at(self, *places: tuple[float, float]) -> float:
        """The bound for differences of the table's coordinates and places, which may lie far outside."""
        return margin(self._error(*places))

    def _error(self, *places: tuple[float, float]) -> float:
        far = self._largest
        for x, y in places:
            far = max(far, abs(x), abs(y))
        return ROUNDOFF * far

    def near(self, low: tuple[float, float], high: tuple[float, float], reach: float) -> Ints:
        """The edges whose boxes come within *reach* of the box from *low* to *high*."""
        return np.array(self.around(low, high, reach), dtype=np.intp)

    def around(self, low: tuple[float, float], high: tuple[float, float], reach: float) -> list[int]:
        """The numbers that `near` gives, as a list, which is not to be changed: cheaper if they are few.

        These are looked at, whatever decides then. The last answers are kept: all sectors of a corner ask for
        one box, as do ways along an edge.
        """
        key = low, high, reach
        found = self._around.get(key)
        if found is None:
            window = *low, *high
            slack = 8 * ROUNDOFF * max(self._largest, *map(abs, window))
            found = self.tree.near(window, reach + slack)
            self._around.put(key, found)
        return found

    def lit(self, places: tuple[Spot, ...], reach: float) -> list[int]:
        """The edges that may be seen within *reach* from somewhere between some places; not to be changed.

        Of those that are in reach `around` them, what single edges and discs certainly hide is left out. The
        last answers are kept.
        """
        key = places, reach
        found = self._lit.get(key)
        if found is None:
            found = self._found_lit(places, reach)
            self._lit.put(key, found)
        return found

    def _found_lit(self, places: tuple[Spot, ...], reach: float) -> list[int]:
        """What `lit` gives."""
        low = high = places[0]
        if len(places) > 1:
            xs, ys = zip(*places, strict=True)
            low, high = (min(xs), min(ys)), (max(xs), max(ys))
        if self._is_dense(reach):
            close, slack = self.around(low, high, reach * HIDING), 8 * self.roundoff_at(low, high)
            if len(close) >= MANY and slack < inf:
                hiding = Shadows(self.images, close, places, slack)
                return lit(self.tree, (*low, *high), reach + 8 * self._error(low, high), hiding)
        return self.around(low, high, reach)

    def _is_dense(self, reach: float) -> bool:
        """Whether many edges are close to one of a few edges, spread over the scene."""
        found = self._dense.get(reach)
        if found is None:
            some = range(0, len(self.curves), len(self.curves) // SAMPLES + 1)
            places = (self.curves[e].start.xy for e in some)
            found = any(len(self.around(place, place, reach * CLOSE)) >= MANY for place in places)
            self._dense[reach] = found
        return found

    def spots(self, e: int) -> tuple[Spot, ...]:
        """Places between which all of an edge lies."""
        curve = self.curves[e]
        return (
            (curve.start.xy, curve.end.xy) if isinstance(curve, Segment) else corners(self.boxes[e].tolist())
        )

    def along(self, line: Line, reach: float) -> list[int]:
        """The edges whose boxes a line may meet within *reach* of its contact: to be looked at."""
        slack = 8 * self._error((line[0], line[1]))
        return self.tree.along(line, reach + slack, slack)

    def distance_bounds(self, x: float, y: float, edges: Ints) -> Floats:
        """Lower bounds of the distances from a point to edges."""
        a, b = self.start[edges], self.end[edges]
        along = b - a
        offset = np.array((x, y)) - a
        size = np.maximum((along**2).sum(axis=1), 1e-300)
        u = np.clip((offset * along).sum(axis=1) / size, 0.0, 1.0)
        straight = np.hypot(*(offset - u[:, None] * along).T)
        low, high = self.boxes[edges, :2], self.boxes[edges, 2:]
        gap = np.maximum(np.maximum(low - (x, y), (x, y) - high), 0.0)
        to_box = np.hypot(gap[:, 0], gap[:, 1])
        spoke = np.hypot(x - self.center[edges, 0], y - self.center[edges, 1])
        curved = np.maximum(to_box, np.abs(spoke - self.radius[edges]))
        bound = np.where(self.kind[edges] == STRAIGHT, straight, curved)
        bounds: Floats = np.maximum(bound * (1 - 1e-14) - 8 * self.roundoff, 0.0)
        return bounds


def _is_short(arc: Arc) -> bool:
    """Whether an arc's centre and radius have few digits, as those drawn on a coarse lattice have."""
    centre = max(c.q.height_bits() for c in _pair(arc.center))
    return bool(centre <= COARSE_BITS and arc.radius_sq.q.height_bits() <= 2 * COARSE_BITS)


def _passes(curve: Curve, point: Point) -> bool:
    """Whether a curve contains a point, which may be the very object at which it ends."""
    if point is curve.start or point is curve.end:
        return True
    return curve.may_pass(point, BITS) and curve.passes(point)


def corners(box: Sequence[float]) -> tuple[Spot, ...]:
    """The corners of a box."""
    left, bottom, right, top = box
    return (left, bottom), (right, bottom), (right, top), (left, top)


def quotient(top: Floats | float, bottom: Floats) -> Floats:
    """A quotient by numbers of at least 0, without a warning where it is huge or infinite.

    There it is an error that leaves everything unsure, or no number that anything is decided by.
    """
    with np.errstate(over="ignore"):
        return top / np.maximum(bottom, 1e-300)


def _kind(curve: Curve) -> int:
    if isinstance(curve, Segment):
        return STRAIGHT
    return CONVEX if curve.ccw else CONCAVE


def _pair(point: Any) -> tuple[fmpq, fmpq]:
    pair = point.rational
    assert pair is not None, "boundary vertices and centres are rational"
    return pair  # type: ignore[no-any-return]


def with_rests(pair: tuple[fmpq, fmpq]) -> tuple[float, float, float, float]:
    """Each coordinate as the nearest float, and what that leaves, as a float."""
    x, y = map(float, pair)
    return x, float(pair[0] - _of_float(x)), y, float(pair[1] - _of_float(y))


def _of_float(value: float) -> fmpq:
    return fmpq(*value.as_integer_ratio())


def _floats(pair: tuple[fmpq, fmpq]) -> tuple[float, float]:
    return float(pair[0]), float(pair[1])
