"""What the families of a leg tell of the views from its places, where their numbers may not.

A family ends where its views touch something else, or become as long as the range. From that place this is
known, however complicated its coordinates are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import chain

from exactacq.cached import cached_property
from exactacq.geometry.coordinates import dot
from exactacq.geometry.late import balls, from_to
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import ball_sign
from exactacq.numbers.real import Real
from exactacq.scene.edge_table import EdgeTable
from exactacq.sensing.end_names import holds
from exactacq.sensing.leg_views import Share, Shares
from exactacq.sensing.line_points import Role
from exactacq.sensing.straight_way import facts_on_leg
from exactacq.sensing.view_families import LineView
from exactacq.visibility.place_facts import (
    NOTHING_KNOWN,
    Alignment,
    Hold,
    PlaceFacts,
    Touched,
    tangents_along,
    tangents_at,
    tangents_from,
)


class LegFacts:
    """Facts about the places of a leg, by what it shows."""

    def __init__(self, shares: Shares) -> None:
        self._shares = shares

    def tell(self, u: Real, place: Point) -> None:
        """Tell the view from a place what is known of it, as it is made: its numbers may not."""
        facts = self.at(u, place)
        if facts is not NOTHING_KNOWN:
            self._shares.view(place, self._shares.leg.own(u), lambda: facts)

    def at(self, u: Real, place: Point) -> PlaceFacts:
        """What is known of a place, with parameter *u*; `NOTHING_KNOWN` if no family ends there."""
        table, around = self._shares.complex.table, balls(place)
        rays, held = dict[frozenset[Touched], Alignment](), set[Hold]()
        rim, tangent = list[tuple[int, Point]](), dict[int, Point]()
        for end, share in self._ends:
            v, views = end.places[share.side], share.family.free_views
            if views is None or not _is_at(v, u, end.tight):
                continue
            if not end.tight:
                features = views.touched(end.t, table.line_numbers)
                if features:
                    lines = views.lines(end.t)
                    for ray in tangents_from(table, around, views.sector, end.t, features):
                        known = rays.setdefault(ray.touched, ray)
                        rays[ray.touched] = replace(known, lines=known.lines | lines)
                continue
            e, point, curve = share.edge, end.points[1 - share.side], table.curves[share.edge]
            if point is curve.start or point is curve.end:
                rim.append((e, point))
            elif views.sides[1 - share.side].role is Role.CONTACT and views.is_normal:
                tangent[table.line_numbers.circles[e]] = point
            else:
                held.update(holds(table, place, e, point, views, end.t))
        some = rays or held or rim or tangent
        found = PlaceFacts([*rays.values()], held, rim, tangent) if some else NOTHING_KNOWN
        # Last: of several forms of one ray that of the way counts, which `OwnLine` uses too.
        shares = self._shares
        return found.joined(facts_on_leg(shares.view, table, shares.leg, place, self._met_beyond(place)))

    def _met_beyond(self, place: Point) -> dict[int, Point]:
        """Where a straight way's own line meets edges beyond a place, by what it shows from a stretch."""
        leg = self._shares.leg
        at, along = balls(place), from_to(balls(leg.start), balls(leg.end))
        found: dict[int, Point] = {}
        for share in chain.from_iterable(self._shares.of.values()):
            shown, source = share.shown, share.source
            is_along = share.family.free_views is None and source.low is not source.high
            is_one = is_along and shown.low is shown.high
            if is_one and ball_sign(dot(from_to(at, balls(shown.start)), along)) > 0:
                found[share.edge] = shown.start
        return found

    @cached_property
    def _ends(self) -> list[tuple[LineView, Share]]:
        """The extreme views."""
        shares = chain.from_iterable(self._shares.of.values())
        return [(end, share) for share in shares for end in (share.family.first, share.family.last)]


def rays_along(table: EdgeTable, share: Share, start: Point) -> Iterator[Alignment]:
    """The rays along an extreme view of a share that begins at a place, the very object, of the leg.

    The one to what the view shows comes to that edge there. Where a corner is shown, views from a stretch of
    the leg show it, and only those from its ends are known.
    """
    views, side = share.family.free_views, share.side
    ends = (share.family.first, share.family.last)
    end = next((end for end in ends if end.points[side] is start), None)
    if end is None or views is None or views.anchor is None:
        return
    place, (near, far) = balls(end.points[side]), (views.sides[side].role, views.sides[1 - side].role)
    ahead = 1 if far > near else -1
    if near is Role.CONTACT and views.sector.round:
        rays = tangents_at(views.sector, end.t, views.anchor)
    else:
        # The numbers of a line through two places tell less than these.
        u, v = from_to(place, balls(end.points[1 - side]))
        direction = u * ahead, v * ahead
        rays = tangents_along(table, place, direction, views.sector, end.t, [views.anchor])
    for ray in rays:
        yield replace(ray, met={share.edge: end.points[1 - side]}) if ray.sense == ahead else ray


def _is_at(v: Real, u: Real, tight: bool) -> bool:
    """Whether two parameters are one.

    Where a family ends by the range that is proved; elsewhere numbers of another form do not count as equal,
    since the proof may take longer than it saves.
    """
    if v is u or not v.overlaps(u):
        return v is u
    return v.compare(u) == 0 if tight else v.key == u.key
