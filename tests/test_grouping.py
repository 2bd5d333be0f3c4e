"""Things in exact order, equal ones together."""

from __future__ import annotations

from itertools import groupby

from hypothesis import given
from hypothesis import strategies as st

from exactacq.grouping import in_groups


@given(st.lists(st.integers(-9, 9)))
def test_groups_are_those_of_a_stable_sort(numbers: list[int]) -> None:
    """Equal squares stay in the order in which they came, and no pair is compared twice."""
    asked: list[tuple[int, int]] = []

    def compare(a: tuple[int, int], b: tuple[int, int]) -> int:
        asked.append((a[0], b[0]))
        return (a[1] ** 2 > b[1] ** 2) - (a[1] ** 2 < b[1] ** 2)

    things = list(enumerate(numbers))
    by_square = lambda thing: thing[1] ** 2  # noqa: E731
    expected = [list(equal) for _, equal in groupby(sorted(things, key=by_square), key=by_square)]
    assert in_groups(things, compare) == expected
    assert len(set(map(frozenset, asked))) == len(asked)
