"""What is known of each edge when the robot is inside a leg, found when it is asked for.

What the whole leg shows is cut to the part up to the robot: to sense that part by itself would be harder, as
its end often has complicated coordinates. This is done for the edges within reach of the robot's place only.
What is known of another edge changes only where one more view of it is passed, and is kept until then.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import partial

from exactacq.cached import cached_property
from exactacq.geometry.interval_union import Cover
from exactacq.geometry.points import Point
from exactacq.numbers.float_bounds import float_ball
from exactacq.numbers.real import Real
from exactacq.sensing.end_names import Seen
from exactacq.sensing.leg_facts import LegFacts
from exactacq.sensing.leg_views import Covers, Share, Shares
from exactacq.sensing.legs import Leg


class LegNews:
    """What a leg adds to *covers*, which are known before it, on the way to any place of it."""

    def __init__(self, shares: Shares, covers: Covers) -> None:
        self.shares, self.covers = shares, covers
        self.facts = LegFacts(shares)
        if shares.leg.touches:
            self.facts.tell(shares.leg.first, shares.leg.start)
        self._on: dict[int, EdgeNews] = {}

    def upto(self, u: Real, place: Point, acquired: Collection[int] = ()) -> Underway:
        """The covers that have grown when the robot is at a place. Made in constant time.

        Some obstacles may be known to be *acquired* there.
        """
        return Underway(self, u, place, acquired)

    def on(self, edge: int) -> EdgeNews:
        """What the leg adds to the cover of one edge."""
        if edge not in self._on:
            shares = self.shares
            obstacles = [k for k, _ in shares.targets.on(edge) if k in shares.obstacles]
            of: dict[int, list[Share]] = {k: [] for k in obstacles}
            for k, share in self._by_edge.get(edge, ()):
                of[k].append(share)
            ends = {
                k: [(end, part) for end, part in shares.ends[k] if end.edge == edge]
                for k in obstacles
                if k in shares.ends
            }
            some = Shares(
                shares.complex, shares.targets, shares.leg, obstacles, shares.view, of=of, ends=ends
            )
            self._on[edge] = EdgeNews(edge, some, self.covers)
        return self._on[edge]

    @cached_property
    def edges(self) -> set[int]:
        """The edges to whose covers the leg itself may add: what its start sees is known before it."""
        shares = self.shares
        along = set() if shares.leg.edge is None else {shares.leg.edge}
        ends = (end.edge for found in shares.ends.values() for end, _ in found)
        return {*self._by_edge, *along, *ends}

    @cached_property
    def _by_edge(self) -> dict[int, list[tuple[int, Share]]]:
        found: dict[int, list[tuple[int, Share]]] = {}
        for k, shares in self.shares.of.items():
            for share in shares:
                found.setdefault(share.edge, []).append((k, share))
        return found


class EdgeNews:
    """What a leg adds to the cover of one edge; *shares* are of the edge alone."""

    def __init__(self, edge: int, shares: Shares, covers: Covers) -> None:
        self.edge, self.shares, self.covers = edge, shares, covers
        self._passed: dict[int, Cover | None] = {}
        ahead = shares.leg.ahead
        sources = [share.source for found in shares.of.values() for share in found]
        sources += [part for found in shares.ends.values() for _, part in found]
        self._lasts = [source.high if ahead else source.low for source in sources]
        self._brackets = [float_ball(last) for last in self._lasts]

    def within(self, part: Leg) -> Cover | None:
        """The cover on the way along the first part of the leg; None if it has not grown."""
        return self.shares.cut(part).taught(self.covers).get(self.edge)

    def beyond(self, part: Leg) -> Cover | None:
        """That for a part from whose end nothing of the edge is in sight: no view of it is under way."""
        passed = self._count(part.last)
        if passed not in self._passed:
            self._passed[passed] = self.within(part)
        return self._passed[passed]

    def _count(self, u: Real) -> int:
        """How many of the families and of the views of a border's ends are passed; floats tell most.

        A difference of floats is off by far less than half of itself, so one of more than twice the sum of
        both errors has the sign of the difference of the numbers.
        """
        leg, (at, error) = self.shares.leg, float_ball(u)
        count = 0
        for last, (middle, other) in zip(self._lasts, self._brackets, strict=True):
            if abs(at - middle) > 2.0 * (error + other):
                count += (at > middle) == leg.ahead
            else:
                count += leg.order(last, u) < 0
        return count


class Underway(Mapping[int, Cover]):
    """The covers that have grown along a leg when the robot is at a place; each is made when it is read."""

    def __init__(self, news: LegNews, u: Real, place: Point, acquired: Collection[int]) -> None:
        self._news, self._u, self._place = news, u, place
        # Where an obstacle is acquired, ends of what is known meet: numbers may not tell that they do.
        whole = news.shares.targets.whole_covers
        self._found: dict[int, Cover | None] = {e: cover for k in acquired for e, cover in whole(k)}

    @cached_property
    def _near(self) -> frozenset[int]:
        """The edges within reach of the place, and perhaps a few more."""
        complex_, at = self._news.shares.complex, self._place.xy
        return frozenset(complex_.table.around(at, at, complex_.range.above))

    def _cover(self, edge: int) -> Cover | None:
        if edge not in self._found:
            self._found[edge] = self._grown(edge) if edge in self._edges else None
        return self._found[edge]

    def _grown(self, edge: int) -> Cover | None:
        self._view()
        news = self._news.on(edge)
        return news.within(self._part) if edge in self._near else news.beyond(self._part)

    @cached_property
    def _edges(self) -> set[int]:
        """The edges whose covers may have grown."""
        return {*self._news.edges, *self._view().edges}

    @cached_property
    def _part(self) -> Leg:
        """The leg as far as the place."""
        return self._news.shares.leg.upto(self._u, self._place)

    def _view(self) -> Seen:
        """The view from the place; as it is made it is told what is known of it: its numbers may not."""
        shares, u, place = self._news.shares, self._u, self._place
        return shares.view(place, shares.leg.own(u), partial(self._news.facts.at, u, place))

    def __getitem__(self, edge: int) -> Cover:
        found = self._cover(edge)
        if found is None:
            raise KeyError(edge)
        return found

    def __reduce__(self) -> tuple[type[dict[int, Cover]], tuple[dict[int, Cover]]]:
        # Balls cannot be pickled.
        return dict, (dict(self),)

    def __iter__(self) -> Iterator[int]:
        shares = self._news.shares
        edges = dict.fromkeys(e for k in sorted(shares.obstacles) for e in sorted(shares.targets.edges[k]))
        return (e for e in edges if self._cover(e) is not None)

    def __len__(self) -> int:
        return sum(1 for _ in self)
