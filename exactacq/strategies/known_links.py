"""The links that a robot knows: from the start, and from boundaries that it has walked all around.

Of equally long ones that to the obstacle with the least number in the scene comes first.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterable
from dataclasses import dataclass
from functools import partial
from heapq import heapify, heappop, heappush
from itertools import islice

from exactacq.errors import Undecided, deciding
from exactacq.geometry.points import Point
from exactacq.numbers.float_bounds import margin
from exactacq.numbers.length import Length
from exactacq.sensing.decision import NEXT, Candidate, Decision, Rule
from exactacq.visibility.links import START, Link, Links, Node

SLACK = 1e-12
"""Floats of lengths that differ by more than this part tell which is less."""


class _LinksByLength:
    """The links from one node, the least (then that to the least index) first; each is compared once.

    *near* are the obstacles that they may lead to, each with a lower bound of the length; lower bounds decide
    which links are computed.
    """

    def __init__(self, near: Iterable[tuple[float, int]], link: Callable[[int], Link | None]) -> None:
        self._link = link
        self._near = sorted(near, reverse=True)
        self._found: list[tuple[float, int, Link]] = []
        # The links that floats cannot tell from the least, in order, the first one last.
        self._least: list[Link] = []

    def first(self, visited: Container[int]) -> Link | None:
        """The least link to an obstacle that was not visited."""
        while True:
            while self._least and self._least[-1].target in visited:
                self._least.pop()
            if self._least:
                return self._least[-1]
            self._least = self._next(visited)
            if not self._least:
                return None

    def _next(self, visited: Container[int]) -> list[Link]:
        while self._found and self._found[0][1] in visited:
            heappop(self._found)
        while self._near and not (self._found and self._near[-1][0] > _at_most(self._found[0][0])):
            _, j = self._near[-1]
            link = None if j in visited else self._link(j)
            if link is not None:
                heappush(self._found, (float(link.length), j, link))
            # Only now: where a link is undecided, or somebody interrupts, nothing is lost.
            self._near.pop()
        least = _at_most(self._found[0][0]) if self._found else 0.0
        close = [link for length, j, link in self._found if length <= least and j not in visited]
        close.sort(key=lambda link: link.target)
        if len(close) > 1:
            names = ", ".join(f"O{link.target + 1}" for link in close)
            with deciding("which of the links to {} is the shortest", names):
                close.sort(key=lambda link: link.length)
        self._found = [found for found in self._found if found[0] > least]
        heapify(self._found)
        return close[::-1]


def _at_most(length: float) -> float:
    """An upper bound of a length, from its float."""
    return length + margin(SLACK * length)


class KnownLinks:
    """The links from the start and from visited obstacles; numbers are the scene's.

    A robot that has walked all around a boundary has seen where each link from it ends.
    """

    def __init__(self, links: Links, start: Point) -> None:
        self._links, self._start = links, start
        self._nearest: dict[Node, _LinksByLength] = {}
        # The nodes of which it is not known that nothing is left, and how many visited ones were counted.
        self._may_lead_on: list[Node] = [START]
        self._counted = 0

    def nearest(self, node: Node, visited: Container[int]) -> Link | None:
        """The shortest link (then the least number) from a node to an obstacle that was not visited.

        What was visited once stays so.
        """
        if node not in self._nearest:
            self._nearest[node] = self._by_length(node)
        return self._nearest[node].first(visited)

    def nearest_few(self, node: Node, visited: Iterable[int], count: int) -> list[Link]:
        """The shortest links, as `nearest` would find one after the other; at most *count* of them.

        Fewer obstacles may be visited than before.
        """
        links, passed, found = self._by_length(node), set(visited), list[Link]()
        while len(found) < count and (link := links.first(passed)) is not None:
            found.append(link)
            passed.add(link.target)
        return found

    def _by_length(self, node: Node) -> _LinksByLength:
        if node == START:
            links = self._links.from_point(self._start)
            return _LinksByLength(((0.0, j) for j in links), links.get)
        assert isinstance(node, int)
        near = self._links.neighbours(node)
        bounds = self._links.lower_bounds(node, near).tolist()
        return _LinksByLength(zip(bounds, near, strict=True), partial(self._links.between, node))

    def lead_on(self, visited: Collection[int]) -> bool:
        """Whether a link from the start or a visited obstacle leads to one that was not visited.

        A node from which none does is not looked at again. Cost: that of the links that may be the shortest.
        """
        self._may_lead_on += islice(visited, self._counted, None)
        self._counted = len(visited)
        while self._may_lead_on and self.nearest(self._may_lead_on[-1], visited) is None:
            self._may_lead_on.pop()
        return bool(self._may_lead_on)

    def of(self, node: Node) -> list[Link]:
        """All links from a node, in the order of the obstacles that they lead to."""
        if node == START:
            return [link for _, link in sorted(self._links.from_point(self._start).items())]
        assert isinstance(node, int)
        between = (self._links.between(node, j) for j in sorted(self._links.neighbours(node)))
        return [link for link in between if link is not None]


@dataclass(frozen=True, slots=True)
class NearestLink:
    """That a link was the shortest one to what was not visited, when ``count`` obstacles were visited.

    The next ones are looked for when somebody asks: the choice did not need their lengths.
    """

    links: KnownLinks
    link: Link
    visited: Iterable[int]
    count: int
    after: int

    def decision(self) -> Decision:
        """The decision for this link. The next ones are left out if they cannot be put in order."""
        link, visited, because = self.link, islice(self.visited, self.count), ""
        try:
            others = self.links.nearest_few(link.source, {link.target, *visited}, NEXT)
        except Undecided:
            others, because = [], "which ones come next is undecided"
        return Decision(
            because,
            chosen=link.target,
            length=Length(link.length),
            others=tuple(Candidate(other.target, Length(other.length)) for other in others),
            rule=Rule.NEAREST,
            after=self.after,
        )
