"""Where families meet the range: what floats find is what exact numbers find."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from random import Random

import pytest
from nightly import some
from strategies import arc_terrain, degenerate_terrain, random_terrain
from test_ties import past_a_circle

import exactacq as xa
from exactacq.kernel.curve_images import CurveImage
from exactacq.kernel.family_images import AHEAD, BEHIND
from exactacq.kernel.images import TURNING
from exactacq.kernel.lines import line_at
from exactacq.kernel.range_cuts import ALL_IN_RANGE, FIRST_TOO_LONG, LAST_TOO_LONG, UNSURE, parted_lines
from exactacq.sensing import range_ends
from exactacq.sensing.range_ends import RangeEnds
from exactacq.sensing.view_families import FreeViews, ViewFamily


def square_length(t: Fraction, left: Fraction, right: Fraction) -> Fraction:
    """The squared length of the line in direction (1, t) between x = left and x = right."""
    return (right - left) ** 2 * (1 + t * t)


@pytest.mark.parametrize("seed", some(range(200), 60))
def test_lines_in_range_are_told_as_fractions_do(seed: int) -> None:
    """Views through the origin between two upright walls: the middle may be in range, the ends not."""
    rng = Random(seed)
    left, right = Fraction(-rng.randint(1, 9), 2), Fraction(rng.randint(1, 9), 2)
    walls = [CurveImage(float(x), -99.0, 0.0, 198.0, 0.0, 0, False) for x in (left, right)]
    low, high = sorted((rng.uniform(-2, 2), rng.uniform(-2, 2)))
    radius = rng.choice((Fraction(rng.randint(2, 40), 2), right - left))
    reach = float(radius) * (1 - 1e-12), float(radius) * (1 + 1e-12)
    frame = TURNING, 0.0, 0.0, 1.0, 0.0, 0.0, 1
    ends = line_at(frame, low, 0.0), line_at(frame, high, 0.0)
    told, near, far = parted_lines(frame, ends, (low, low, high, high), BEHIND, AHEAD, *walls, reach)
    longer = [square_length(Fraction(t), left, right) > radius**2 for t in (low, high)]
    expected = {(False, False): ALL_IN_RANGE, (True, False): FIRST_TOO_LONG, (False, True): LAST_TOO_LONG}
    assert told == expected.get((longer[0], longer[1]), UNSURE)
    if told in (FIRST_TOO_LONG, LAST_TOO_LONG):
        assert low <= min(near, far) < max(near, far) <= high
        assert abs(near - far) < 1e-9
        assert (
            square_length(Fraction(near), left, right) < radius**2 < square_length(Fraction(far), left, right)
        )


def told(families: Iterable[ViewFamily]) -> list[tuple[object, ...]]:
    """The extreme views of families in exact numbers."""
    return [
        (
            family.edges,
            *((end.t.key, *map(point_key, end.points), end.tight) for end in (family.first, family.last)),
        )
        for family in families
    ]


def point_key(point: xa.Point) -> tuple[object, object]:
    return point.x.key, point.y.key


def test_views_at_the_range_are_those_of_polynomials(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of all families of some runs: late numbers become those that exact candidates give."""
    asked: list[tuple[RangeEnds, FreeViews]] = []
    within = RangeEnds.within

    def noted(self: RangeEnds, free_views: FreeViews) -> Iterator[ViewFamily]:
        asked.append((self, free_views))
        return within(self, free_views)

    with monkeypatch.context() as patch:
        patch.setattr(RangeEnds, "within", noted)
        for make in (random_terrain, degenerate_terrain, arc_terrain):
            for seed in some(range(30), 6):
                xa.sightseer(make(Random(seed)).scene())
    found = [[*one.within(free_views)] for one, free_views in asked]
    ends = [end for families in found for family in families for end in (family.first, family.last)]
    assert any(end.tight and end.t.is_late for end in ends)
    by_floats = [told(families) for families in found]
    monkeypatch.setattr(range_ends, "parted_lines", lambda *_: (UNSURE, 0.0, 0.0))
    assert by_floats == [told(one.within(free_views)) for one, free_views in asked]


@pytest.mark.parametrize("seed", [36, 40, 47, 52])
def test_what_is_told_to_be_in_range_is(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Views that are made without asking whether they are too long.

    Lines through a corner where a concave arc begins may meet that arc ahead too. From a way across them the
    corner was in range and the arc not: as both are on one edge, the views of the arc were taken for short.
    """
    try:
        scene = past_a_circle(seed)
    except xa.InvalidScene:
        pytest.skip("no scene")
    told, within = [0], RangeEnds.within

    def checked(self: RangeEnds, free_views: FreeViews) -> Iterator[ViewFamily]:
        for family in within(self, free_views):
            if free_views.in_range:
                told[0] += 1
                assert all(self.range.order(*end.points) <= 0 for end in (family.first, family.last))
            yield family

    monkeypatch.setattr(RangeEnds, "within", checked)
    xa.audit(xa.sightseer(scene), samples=4)
    assert told[0] > 20
