"""What the bounds are made of, counted from the events of a finished run, and the run's bounds once the audit
has found them by its own means."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from exactacq.auditing.bounds import check_bounds, sightseer_values, spreader_values
from exactacq.auditing.sightseer import check_links
from exactacq.cached import cached_property
from exactacq.errors import AuditError
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import rational
from exactacq.sensing.event import EventKind, Occasion
from exactacq.strategies.run import Diversion, Run, SeedSpreaderRun, SightseerRun
from exactacq.study.claims.model import Case
from exactacq.study.claims.trees import circled

HALF = rational("1/2")
VISITS = Occasion.M_LINE, Occasion.WAY_OUT, Occasion.DIVERSION
"""Hits that are visits: on the M-line, and on the way out on a diversion; not those on the way back."""


def bounds_of(run: Run) -> dict[str, Length]:
    """The values of a run's bounds by their names."""
    return {bound.name: bound.value for bound in run.bounds}


def bounds_flaw(case: Case, run: SightseerRun | SeedSpreaderRun) -> str | None:
    """Where the bounds that a run reports are not those that the audit finds, or count other obstacles than
    its path and events show; None if they are right."""
    try:
        if isinstance(run, SightseerRun):
            told, counted = [*run.visits], circled(run)
            check_links(run)
            check_bounds(run, sightseer_values(run, case.world))
        else:
            tally = case.shared(Tally)
            told, counted = [*run.encounters, *run.again], [*tally.visited, *tally.met_again]
            check_bounds(run, spreader_values(run, case.field))
    except AuditError as error:
        return str(error)
    return None if told == counted else f"the run counts the obstacles {told}, its path and events {counted}"


def tour_flaw(case: Case) -> str | None:
    """What is wrong with the bounds of the Sightseer's run."""
    return bounds_flaw(case, case.sightseer)


def sweep_flaw(case: Case) -> str | None:
    """What is wrong with the bounds of the Seed Spreader's run."""
    return bounds_flaw(case, case.spreader)


class _DiversionHits(NamedTuple):
    """A diversion to ``aim`` from ``leave`` (D) and the obstacles that it hits before it is there, and back.

    ``acquired`` are those that were wholly known when they were hit on the way.
    """

    aim: int
    leave: Point
    on_the_way: list[int]
    on_the_way_back: list[int]
    acquired: set[int]


@dataclass(frozen=True)
class Tally:
    """What the bounds of section 4.3 are made of, counted from a terrain and the events on it."""

    case: Case

    @property
    def run(self) -> SeedSpreaderRun:
        """The sweep with the usual options."""
        return self.case.spreader

    @property
    def n(self) -> int:
        """The number of obstacles: components in reach."""
        return len(self.run.obstacles)

    @cached_property
    def visited(self) -> tuple[int, ...]:
        """The obstacles of the arrivals on the M-line and on the way out on diversions, in order."""
        return tuple(
            event.obstacle
            for event in self.run.events
            if event.kind in (EventKind.HIT, EventKind.CROSS) and event.occasion in VISITS
            if event.obstacle is not None
        )

    @property
    def visits(self) -> int:
        """How many arrivals these are."""
        return len(self.visited)

    @cached_property
    def met_again(self) -> tuple[int, ...]:
        """The obstacles of the hits on the M-line that were acquired before: obstacle i comes re_i times."""
        acquired: set[int] = set()
        again: list[int] = []
        for event in self.run.events:
            if event.obstacle is None:
                continue
            if event.kind is EventKind.ACQUIRE:
                acquired.add(event.obstacle)
            elif event.kind in (EventKind.HIT, EventKind.CROSS) and event.occasion is Occasion.M_LINE:
                again += [event.obstacle] if event.obstacle in acquired else []
        return tuple(again)

    @cached_property
    def diversions_meet_known(self) -> bool:
        """Whether a diversion meets an acquired obstacle; all that it hits on its way back are.

        The paper's Case 2 drops the terms for passing known obstacles, there and back.
        """
        return any(met.acquired or met.on_the_way_back for met in self._meetings)

    @cached_property
    def overtaken(self) -> list[int]:
        """The aims that became acquired on the way to them and were then hit before the point aimed at."""
        return [met.aim for met in self._meetings if met.aim in met.acquired]

    @cached_property
    def stays_in_strips(self) -> bool:
        """Whether all that diversions from line j meet lies inside strip j or crosses the M-line."""
        field = self.case.field
        for met in self._meetings:
            line = next(j for j, x in enumerate(field.lines) if met.leave.x.compare(x) == 0)
            inside = {met.aim, *met.on_the_way, *met.on_the_way_back} - field.crossing
            if any(field.strip(k) != line for k in inside):
                return False
        return True

    @cached_property
    def _meetings(self) -> list[_DiversionHits]:
        found: list[_DiversionHits] = []
        acquired: set[int] = set()
        for event in self.run.events:
            k = event.obstacle
            if k is None:
                continue
            if event.kind is EventKind.ACQUIRE:
                acquired.add(k)
            elif event.kind is EventKind.DIVERT:
                found.append(_DiversionHits(k, event.point, [], [], set()))
            elif event.kind is EventKind.HIT and event.occasion is Occasion.WAY_OUT:
                found[-1].on_the_way.append(k)
                found[-1].acquired.update({k} & acquired)
            elif event.kind is EventKind.HIT and event.occasion is Occasion.WAY_BACK:
                found[-1].on_the_way_back.append(k)
        return found

    @property
    def is_plain(self) -> bool:
        """Whether the sweep follows the M-line all the way."""
        detours = EventKind.HIT, EventKind.CROSS, EventKind.DIVERT
        return not any(event.kind in detours for event in self.run.events)

    @property
    def is_clear(self) -> bool:
        """Whether no obstacle meets the border."""
        return all(body.closed for body in self.run.obstacles)

    def proved_visits(self) -> Length:
        """(4), or n + n(n - 1)/2 if a diversion leaves its strip, and what is met again and overtaken."""
        most = bounds_of(self.run)["L3 corrected"]
        if not self.stays_in_strips:
            most = Length(self.n + self.n * (self.n - 1) * HALF + len(self.met_again))
        return most + Length(len(self.overtaken))

    def proved_length(self) -> Length:
        """(6), or (10) clear of the border, with far diversions and p, or half, for what is met again and for
        overtaken aims; n^2 p_max for the terms with p_max if a diversion leaves its strip."""
        values, perimeters = bounds_of(self.run), [body.perimeter for body in self.run.obstacles]
        more: Length = Length.sum(perimeters[k] for k in self.overtaken)
        if not self.stays_in_strips:
            more = more + max(perimeters) * self.n**2 - (values["(6)"] - values["(9)"])
        return values["T2 corrected"] + (more * HALF if self.is_clear else more)


def straight_length(run: Run, diversion: Diversion) -> Length:
    """What a diversion walks straight, there and back."""
    pieces = run.path[diversion.first : diversion.last]
    return Length.sum(piece.length for piece in pieces if piece.kind == "straight")
