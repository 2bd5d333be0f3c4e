"""Things in exact order, equal ones together. To prove two numbers equal may take long: it is done once."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

Thing = TypeVar("Thing")


def in_groups(things: Iterable[Thing], compare: Callable[[Thing, Thing], int]) -> list[list[Thing]]:
    """Groups of equal things, in order, each in the order in which they are given.

    *compare* gives -1, 0 or 1 as the first of two things comes before the second, is equal to it or comes
    after. Only the first of each group is compared with others: log2 of the groups' number comparisons each.

    >>> in_groups([3, -1, 2, 1, -3], lambda a, b: (abs(a) > abs(b)) - (abs(a) < abs(b)))
    [[-1, 1], [2], [3, -3]]
    """
    groups: list[list[Thing]] = []
    for thing in things:
        low, high = 0, len(groups)
        while low < high:
            middle = (low + high) // 2
            order = compare(groups[middle][0], thing)
            if order == 0:
                groups[middle].append(thing)
                break
            low, high = (middle + 1, high) if order < 0 else (low, middle)
        else:
            groups.insert(low, [thing])
    return groups
