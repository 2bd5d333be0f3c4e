"""How a finished run stands beside what any path needs, and what it has missed: all exact."""

from __future__ import annotations

from dataclasses import dataclass

from exactacq.numbers.length import Length
from exactacq.strategies.offline import offline_bounds
from exactacq.strategies.run import Run


@dataclass(frozen=True)
class LowerBound:
    """What no path can be shorter than that does a task, and whether the run has done that task.

    ``ratio``, a float, is the run's length over the value, NaN where the value is 0.
    """

    value: Length
    ratio: float
    applies: bool


@dataclass(frozen=True)
class Standing:
    """A run beside the lower bounds of `offline_bounds`, and how much boundary it has not seen.

    ``seeing`` is for paths from the run's start that see something of each obstacle, ``circling`` for those
    that walk along all boundaries. ``boundary`` is the length of all boundaries, ``unknown`` of what of them
    the run has not seen. Obstacles are the run's: of the Seed Spreader the components of its terrain.
    """

    seeing: LowerBound
    circling: LowerBound
    unknown: Length
    boundary: Length


def standing(run: Run) -> Standing:
    """Set a run beside the lower bounds of paths from its start.

    Components of one obstacle count once where they are only to be seen, and their distances from others are
    taken to be the obstacle's, which are no longer. Raises and costs what `offline_bounds` does.

    >>> import exactacq as xa
    >>> found = standing(xa.sightseer(xa.load("squares")))
    >>> print(found.circling.value, found.circling.ratio, found.seeing.value, found.unknown, found.boundary)
    21 1.1428571428571428 0 0 16
    """
    bodies = run.obstacles
    wanted = None if run.ground is None else {c.obstacle.index for c in run.ground.components}
    bounds = offline_bounds(run.scene, run.radius, start=run.start, obstacles=wanted)
    boundary = Length.sum(body.perimeter for body in bodies)
    circling = Length.sum(Length(gap.length) for gap in bounds.tree) + boundary
    return Standing(
        _beside(run, bounds.seeing, not run.unseen),
        _beside(run, circling, len(run.visits) == len(bodies)),
        boundary - run.map.known_length(),
        boundary,
    )


def _beside(run: Run, value: Length, applies: bool) -> LowerBound:
    ratio = float(run.length) / float(value) if value.sign() else float("nan")
    return LowerBound(value, ratio, applies)
