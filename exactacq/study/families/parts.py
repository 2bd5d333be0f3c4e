"""Outlines that drawings are made of: boxes with corners, chamfers or fillets, slots; and where they go."""

from __future__ import annotations

from flint import fmpq

from exactacq.scene.bends import Around
from exactacq.scene.shapes import Circle, Outline, Polygon, Shape
from exactacq.study.families.plan import Corner, Rectangle


def box(place: Rectangle) -> Polygon:
    """A rectangle."""
    left, bottom, right, top = place
    return Polygon([(left, bottom), (right, bottom), (right, top), (left, top)])


def chamfered(place: Rectangle, cut: fmpq) -> Polygon:
    """A rectangle whose corners are cut off, so far along both sides, which are longer than twice that."""
    left, bottom, right, top = place
    return Polygon(
        [
            (left + cut, bottom),
            (right - cut, bottom),
            (right, bottom + cut),
            (right, top - cut),
            (right - cut, top),
            (left + cut, top),
            (left, top - cut),
            (left, bottom + cut),
        ]
    )


def rounded(place: Rectangle, radius: fmpq) -> Outline:
    """A rectangle with quarter circles for corners; twice the radius may be a side, or both sides.

    Then quarter circles follow each other, and what is meant for a half circle is two arcs of one circle.
    """
    left, bottom, right, top = place
    inner = Rectangle(left + radius, bottom + radius, right - radius, top - radius)
    corners: list[tuple[object, ...]] = [
        (inner.left, bottom),
        (inner.right, bottom, Around((inner.right, inner.bottom))),
        (right, inner.bottom),
        (right, inner.top, Around((inner.right, inner.top))),
        (inner.right, top),
        (inner.left, top, Around((inner.left, inner.top))),
        (left, inner.top),
        (left, inner.bottom, Around((inner.left, inner.bottom))),
    ]
    kept = [c for c, after in zip(corners, [*corners[1:], corners[0]], strict=True) if c[:2] != after[:2]]
    return Outline(kept)


def slot(place: Rectangle) -> Shape:
    """A stadium with half circles at the ends of the longer sides; a circle in a square."""
    left, bottom, right, top = place
    width, height = right - left, top - bottom
    if width == height:
        return Circle(place.middle, width / 2)
    if width > height:
        ends = left + height / 2, right - height / 2
        return Outline([(ends[0], bottom), (ends[1], bottom, 1), (ends[1], top), (ends[0], top, 1)])
    ends = bottom + width / 2, top - width / 2
    return Outline([(right, ends[0]), (right, ends[1], 1), (left, ends[1]), (left, ends[0], 1)])


def diamond(place: Rectangle) -> Polygon:
    """The rhombus between the middles of a rectangle's sides."""
    left, bottom, right, top = place
    x, y = place.middle
    return Polygon([(x, bottom), (right, y), (x, top), (left, y)])


def around(center: Corner, half: fmpq | int) -> Rectangle:
    """The square about a centre."""
    return Rectangle(center[0] - half, center[1] - half, center[0] + half, center[1] + half)


def moved(shape: Shape, east: fmpq | int, north: fmpq | int) -> Shape:
    """The shape elsewhere."""
    if isinstance(shape, Circle):
        return Circle((shape.center[0] + east, shape.center[1] + north), shape.radius)
    return Outline([(x + east, y + north, _moved(bend, east, north)) for x, y, bend in shape.vertices])


def _moved(bend: fmpq | Around, east: fmpq | int, north: fmpq | int) -> fmpq | Around:
    if isinstance(bend, Around):
        return Around((bend.center[0] + east, bend.center[1] + north), bend.ccw)
    return bend
