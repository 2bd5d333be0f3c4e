"""Points that families of views share by name: nobody has to prove that they are equal."""

from __future__ import annotations

import pytest

import exactacq as xa
from exactacq.geometry.interval_union import Cover, Interval
from exactacq.geometry.late import Pin
from exactacq.geometry.points import Point
from exactacq.kernel.line_keys import LineNumbers
from exactacq.numbers import real
from exactacq.sensing.named_pins import PINS_KEPT, NamedPins


def pin(k: int) -> Pin:
    return Point(k, 0), xa.Real(k)


def test_what_was_asked_for_last_is_kept() -> None:
    pins = NamedPins(LineNumbers([]))
    first = pin(0)
    pins.put((0, 0, 0), first)
    for k in range(1, 3 * PINS_KEPT):
        pins.put((k, 0, 0), pin(k))
        if k % 1000 == 0:
            assert pins.get((0, 0, 0)) is first
    assert pins.get((1, 0, 0)) is None
    kept = sum(pins.get((k, 0, 0)) is not None for k in range(3 * PINS_KEPT))
    assert PINS_KEPT // 2 <= kept <= PINS_KEPT


def test_a_way_adds_to_what_is_shared() -> None:
    numbers, way = LineNumbers([]), pin(3)
    scene = NamedPins(numbers)
    scene.put((1, 2, 0), pin(1))
    added = NamedPins(numbers, scene)
    added.put((7, 8, 0), way)
    assert added.get((1, 2, 0)) is scene.get((1, 2, 0))
    assert (added.get((7, 8, 0)), scene.get((7, 8, 0))) == (way, None)
    assert added.at(way[1]) == {(7, 8, 0): way}


def test_a_point_is_known_by_every_number_of_its_line() -> None:
    """Of a line through four corners one way knew one pair, another the other: until a third told of all."""
    numbers = LineNumbers([*range(9)])
    pins, here = NamedPins(numbers), pin(2)
    one, other = numbers.corners(1, 2), numbers.corners(3, 4)
    pins.put((one, 9, 0), here)
    assert pins.get((other, 9, 0)) is None
    assert numbers.keys(1, [(2, 0, 0)]) == [one]
    assert numbers.keys(4, [(3, 0, 0), (2, 0, 0)])[0] == other
    assert numbers.keys(2, [(1, 0, 0), (4, 0, 0)])[0] == one
    assert pins.get((other, 9, 0)) is here
    for name in ((other, 8, 0), (other, 9, 1), (numbers.corners(1, 7), 9, 0)):
        assert pins.get(name) is None


def test_few_ends_of_views_in_rows_of_holes_are_made_to_be_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a grid of equal holes a line that touches two touches many, and ways look along the same lines.

    While the ends of what ways showed were known to the ways alone, 387 numbers were made in this run to find
    that intervals end where known ones do, and what a place shows had its ends made again for each piece.
    """
    inside, made = [False], []
    make, added = real._LateReal._made, Cover.added

    def counted(number: real._LateReal) -> None:
        if inside[0]:
            made.append(number)
        make(number)

    def watched(cover: Cover, new: Interval) -> Cover:
        inside[0] = True
        try:
            return added(cover, new)
        finally:
            inside[0] = False

    monkeypatch.setattr(real._LateReal, "_made", counted)
    monkeypatch.setattr(Cover, "added", watched)
    holes = [xa.Circle((2 * k + 2, 2 * j + 2), "3/5") for k in range(4) for j in range(4)]
    run = xa.sightseer(xa.Scene(holes, start=(1, 1)), radius=8)
    assert len(run.events) > 500
    # Two ends are compared with a float that was taken from their bounds (see `FamilyFilter`).
    assert len(made) <= 2
