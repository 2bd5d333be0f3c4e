"""What happens on a path, as data: events with their kinds, occasions and reasons, and their prose."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from html import escape
from typing import Any

from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.sensing.decision import Decision
from exactacq.sensing.path import Path


class EventKind(StrEnum):
    """What happened: to the robot, or to what it sees of an obstacle. Members are equal to their words.

    >>> EventKind.HIT == "hit"
    True
    """

    START = "start"
    """The path begins."""
    STOP = "stop"
    """The path ends."""
    HIT = "hit"
    """The robot comes to an obstacle."""
    CROSS = "cross"
    """The robot follows the M-line and an obstacle blocks it that is acquired already."""
    LEAVE = "leave"
    """The robot leaves the boundary of an obstacle."""
    BACKTRACK = "backtrack"
    """The robot is back at the obstacle, or the start, from which it came by a link."""
    DIVERT = "divert"
    """The Seed Spreader leaves the M-line for an obstacle that is about to be lost."""
    RETURN = "return"
    """The Seed Spreader is back on the M-line after a diversion."""
    SIGHT = "sight"
    """The first point of an obstacle is known."""
    REGAIN = "regain"
    """An obstacle that is not acquired comes back into sight."""
    ACQUIRE = "acquire"
    """The whole boundary of an obstacle is known."""
    LOSE = "lose"
    """An obstacle that is not acquired goes out of sight."""
    DECIDE = "decide"
    """A strategy of the user's own says why it moves on, where no other event begins its move."""
    MOMENT = "moment"
    """Nothing in particular: a place of the path that was asked for (see `exactacq.Run.near`)."""


SENSED = (EventKind.SIGHT, EventKind.REGAIN, EventKind.ACQUIRE, EventKind.LOSE)
"""What the sensor reports. Reports from one place come in this order."""


class Occasion(StrEnum):
    """On which part of its way the robot hits, crosses or leaves an obstacle."""

    ADVANCE = "advance"
    """The robot goes along a link, the Sightseer to an unvisited obstacle (step 3 of the paper)."""
    BACKTRACK = "backtrack"
    """The robot goes back along a link to where it came from (step 2)."""
    M_LINE = "M-line"
    """The Seed Spreader follows the M-line."""
    WAY_OUT = "way out"
    """The Seed Spreader is on its way from the M-line to the point that a diversion aims at."""
    DIVERSION = "diversion"
    """The Seed Spreader hits the obstacle at the point that a diversion aims at, or leaves it to go back."""
    WAY_BACK = "way back"
    """The Seed Spreader is on its way back to the M-line."""


class Reason(StrEnum):
    """Why an obstacle goes out of sight, or why the Seed Spreader diverts to it.

    The values stand in run files, and are the words that people read.
    """

    OCCLUSION = "occlusion"
    """An obstacle hides it."""
    RANGE = "range"
    """It is farther than the radius of vision."""
    OUT_OF_SIGHT = "out of sight"
    """It goes out of sight and cannot be seen any more from the rest of the line."""
    OUT_OF_REACH = "out of reach"
    """What is known of it goes out of the radius of vision for the rest of the line."""
    LINE_ENDS = "the line ends"
    """The line of the M-line ends."""
    OVERDUE = "overdue"
    """It was out of reach already when the robot came back to the line."""


class Ending(StrEnum):
    """Why a path ends."""

    ALL_VISITED = "all visited"
    """The Sightseer has visited every obstacle of the scene."""
    NOTHING_UNVISITED = "nothing unvisited"
    """Every obstacle on the Sightseer's map is visited."""
    BACK_AT_START = "back at the start"
    """The Sightseer has backtracked to the start and sees nothing unvisited from there."""
    END_OF_M_LINE = "end of the M-line"
    """The Seed Spreader has come to T."""
    TRAPPED = "trapped"
    """An obstacle that blocks the M-line leaves no way on to T."""
    WAY_CLOSED = "way closed"
    """An obstacle closes the straight way of a diversion."""
    FINISHED = "finished"
    """A strategy of the user's own has done what it wanted."""
    MOST_MOVES = "most moves"
    """A strategy of the user's own was to make more moves than it may."""
    UNDECIDED = "undecided"
    """A comparison is beyond the library's limits: the run was given up (see `exactacq.Undecided`)."""

    @property
    def is_early(self) -> bool:
        """Whether an obstacle kept the Seed Spreader from T."""
        return self in (Ending.TRAPPED, Ending.WAY_CLOSED)


_AT = {
    (EventKind.HIT, Occasion.ADVANCE): "from {other}",
    (EventKind.LEAVE, Occasion.ADVANCE): "to {other}",
    (EventKind.LEAVE, Occasion.BACKTRACK): "back to {other}",
    (EventKind.BACKTRACK, Occasion.BACKTRACK): "from {other}",
    (EventKind.HIT, Occasion.DIVERSION): "diversion",
    (EventKind.LEAVE, Occasion.DIVERSION): "back to the M-line",
}
"""What an occasion adds to an event of a certain kind."""
_ON = {
    Occasion.M_LINE: "on the M-line",
    Occasion.WAY_OUT: "on the way",
    Occasion.WAY_BACK: "on the way back",
}
"""What an occasion adds to events of all other kinds."""
_ENDED = {
    Ending.ALL_VISITED: "every obstacle is visited",
    Ending.NOTHING_UNVISITED: "no unvisited obstacle on the map",
    Ending.BACK_AT_START: "back at the start, nothing unvisited in sight",
    Ending.END_OF_M_LINE: "the end of the M-line is reached",
    Ending.TRAPPED: "the start or the end of the M-line is trapped in {obstacle}",
    Ending.WAY_CLOSED: "{obstacle} closes the straight way",
    Ending.FINISHED: "the strategy is done",
    Ending.MOST_MOVES: "no more moves are allowed",
    Ending.UNDECIDED: "given up: a comparison is undecided",
}
"""Why a path ends."""
_NOW = {
    Reason.OUT_OF_SIGHT: "it goes out of sight",
    Reason.OUT_OF_REACH: "what is known of it goes out of reach",
    Reason.LINE_ENDS: "the line of the M-line ends",
    Reason.OVERDUE: "it was out of reach already when the robot came to the line",
}
"""Why the Seed Spreader diverts now, and not later."""


@dataclass(frozen=True, repr=False)
class Event:
    """Something that happened after the first ``after`` pieces of the path, or ``inside`` the next one.

    ``obstacle`` is the number of the obstacle it happened to, if any. Where they apply, ``occasion`` says on
    which part of the robot's way it happened, ``other`` where the Sightseer comes from or goes to (the number
    of an obstacle, or "S" for the start), ``reason`` why an obstacle is lost or diverted to, and ``ending``
    why the path ends. Events are in the order in which they happened.

    The event that begins a move has the ``decision`` to make it, with the numbers that were compared; `why`
    says it in words. It is told, and not compared: events are equal if all else is. ``decided`` is what it is
    made from when it is first asked for, as some of its numbers were not needed on the way.

    >>> import exactacq as xa
    >>> run = xa.sightseer(xa.load("squares"))
    >>> [(event.kind.value, event.other) for event in run.events if event.kind == "hit"]
    [('hit', 'S'), ('hit', 0)]
    >>> run.events[-1].ending
    <Ending.ALL_VISITED: 'all visited'>
    """

    kind: EventKind
    point: Point
    obstacle: int | None
    after: int
    path: Path = field(compare=False)
    inside: bool = False
    occasion: Occasion | None = field(default=None, kw_only=True)
    other: int | str | None = field(default=None, kw_only=True)
    reason: Reason | None = field(default=None, kw_only=True)
    ending: Ending | None = field(default=None, kw_only=True)
    decided: Decision | Callable[[], Decision] | None = field(default=None, kw_only=True, compare=False)

    def __repr__(self) -> str:
        about = "" if self.obstacle is None else f" of obstacle {self.obstacle}"
        x, y = self.point.xy
        return f"<Event: {self.kind}{about} at ({x:.6g}, {y:.6g}){self.note and ', '}{self.note}>"

    def _repr_html_(self) -> str:
        """For notebooks: what happened, where, and after which length."""
        about = "" if self.obstacle is None else f" of obstacle {self.obstacle}"
        x, y = self.point.xy
        note = f", {escape(self.note)}" if self.note else ""
        why = f"<br>{escape(self.why())}" if self.decided is not None else ""
        after = self.at._repr_latex_()
        return f"<p><b>{self.kind}</b>{about} at ({x:.6g}, {y:.6g}) after {after}{note}{why}</p>"

    def __getstate__(self) -> dict[str, Any]:
        """With the decision as it is told: what it is made from knows the scene."""
        return {**self.__dict__, "decided": self.decision}

    @property
    def decision(self) -> Decision | None:
        """Why the robot goes on as it does, if a move begins here, and its strategy told why.

        Of the Sightseer all moves are told. The first time may cost some links, a few milliseconds each.

        >>> import exactacq as xa
        >>> leave = next(e for e in xa.sightseer(xa.load("figure1")).events if e.kind == "leave")
        >>> print(leave.decision.rule, leave.decision.chosen, leave.decision.length, leave.decision.others)
        nearest 1 -2 + sqrt(4010)/10 ()
        """
        decided = self.decided
        if callable(decided):
            decided = decided()
            object.__setattr__(self, "decided", decided)
        return decided

    @property
    def at(self) -> Length:
        """Path length so far. Asking all events of a run in order costs time linear in the path."""
        whole = self.path.length_after(self.after)
        return whole + self.beyond if self.inside else whole

    @property
    def beyond(self) -> Length:
        """Length walked since the end of the last whole piece."""
        if not self.inside:
            return Length(0)
        curve = self.path[self.after].curve
        return curve.part(curve.start, self.point).length

    @property
    def note(self) -> str:
        """Occasion, reason or ending in words, with the numbers of obstacles."""
        return self.describe()

    def describe(self, names: Sequence[str] | None = None) -> str:
        """Occasion, reason or ending in words; obstacles by their *names* if given, else by their numbers.

        >>> import exactacq as xa
        >>> run = xa.sightseer(xa.load("squares"))
        >>> [event.describe(list(run.names())) for event in run.events if event.kind == "hit"]
        ['from S', 'from O1']
        """
        if self.ending is not None:
            text = _ENDED[self.ending]
        elif self.reason is not None:
            text = self.reason.value
        elif self.occasion is not None:
            text = _AT.get((self.kind, self.occasion)) or _ON.get(self.occasion, "")
        else:
            text = ""
        other, obstacle = str(self.other), f"obstacle {self.obstacle}"
        if names is not None:
            other = names[self.other] if isinstance(self.other, int) else other
            obstacle = obstacle if self.obstacle is None else names[self.obstacle]
        return text.format(other=other, obstacle=obstacle)

    def why(self, names: Sequence[str] | None = None) -> str:
        """Why the robot goes on as it does, in a sentence with the lengths that were compared, or "".

        Obstacles by their *names* if given, else by their numbers. The first time it costs what `decision`
        does.

        >>> import exactacq as xa
        >>> run = xa.sightseer(xa.load("figure2"))
        >>> print(next(event.why(list(run.names())) for event in run.events if event.kind == "leave"))
        nearest is O5: 4.236 < 7.652 (O9)
        """
        decision = self.decision
        if decision is None:
            return ""
        now = f"; {_NOW[self.reason]}" if self.reason in _NOW and self.kind is EventKind.DIVERT else ""
        return decision.describe(names) + now
