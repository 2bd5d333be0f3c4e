"""Why the Seed Spreader diverts, and why it goes on along the M-line: its decisions, told in full."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from exactacq.geometry.points import Point, distance
from exactacq.numbers.length import Length
from exactacq.sensing.decision import FEW, Candidate, Decision, Rule


def nearest_loss(chosen: int, aims: Mapping[int, Point], place: Point) -> Decision:
    """The decision for the nearest of what is about to be lost; *aims* are the nearest points of all."""
    away = {k: Length(distance(aim, place)) for k, aim in aims.items()}
    length = away.pop(chosen)
    others = sorted(away.items(), key=lambda other: (float(other[1]), other[0]))
    return Decision(
        chosen=chosen,
        length=length,
        others=tuple(Candidate(*other) for other in others),
        rule=Rule.ABOUT_TO_BE_LOST,
    )


def going_on(incomplete: Collection[int]) -> Decision:
    """The decision to go on along the M-line, as none of what is *incomplete* is about to be lost."""
    left = sorted(incomplete)
    others, more = tuple(map(Candidate, left[:FEW])), len(left[FEW:])
    return Decision(others=others, rule=Rule.GO_ON, more=more)
