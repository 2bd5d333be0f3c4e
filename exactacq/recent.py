"""What was asked for last, by key, in bounded memory."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from itertools import chain
from typing import Generic, TypeVar

Key = TypeVar("Key", bound=Hashable)
Answer = TypeVar("Answer")


class Recent(Generic[Key, Answer]):
    """Answers by key: of those that were asked for last at least half of *most*, and *most* in all.

    >>> squares = Recent[int, int](4)
    >>> for k in range(6):
    ...     squares.put(k, k * k)
    >>> squares.get(5), squares.get(0)
    (25, None)
    """

    __slots__ = ("_before", "_half", "_of")

    def __init__(self, most: int) -> None:
        self._half = most // 2
        self._of: dict[Key, Answer] = {}
        self._before: dict[Key, Answer] = {}

    def get(self, key: Key) -> Answer | None:
        """The answer to a key, if it is kept."""
        answer = self._of.get(key)
        if answer is None and (answer := self._before.get(key)) is not None:
            self.put(key, answer)
        return answer

    def put(self, key: Key, answer: Answer) -> None:
        """Keep the answer to a key."""
        if len(self._of) >= self._half:
            self._of, self._before = {}, self._of
        self._of[key] = answer

    def items(self) -> Iterator[tuple[Key, Answer]]:
        """All that is kept."""
        return chain(self._before.items(), self._of.items())
