"""The audit: a finished run checked again by other means than the code that made it.

Lengths are re-added in balls, pieces are located among all edges, events are replayed, bounds are computed
again from the paper's formulas, and knowledge is decided from the target's side (see `visibility`, here as
the other files of this folder). For the Seed Spreader the components, the M-line and what blocks it are found
again (`ground`), and its rules are replayed (`seed_spreader`), with a look ahead of its own (`look_ahead`).
Nothing of the strategies, the robot, the links or the sensing is used.

Places that are not rational are compared with the path and with each other at `DIGITS` digits: there a
deviation beyond them is not found. Everything else is exact, or a ball proves the flaw.
"""

from __future__ import annotations

from collections.abc import Iterator
from random import Random
from typing import Any

from exactacq.auditing.bounds import check_bounds, sightseer_values, spreader_values
from exactacq.auditing.comparisons import AuditedBody
from exactacq.auditing.decisions import check_decisions
from exactacq.auditing.events import check_events, check_sights
from exactacq.auditing.ground import Field, check_components
from exactacq.auditing.knowledge import MOMENTS, Knowledge
from exactacq.auditing.own_strategy import MOVES as OWN_MOVES
from exactacq.auditing.own_strategy import check_own_moves, declared_values
from exactacq.auditing.path import check_continuity, check_length, check_pieces
from exactacq.auditing.seed_spreader import MOVES as SWEEP_MOVES
from exactacq.auditing.seed_spreader import Replay
from exactacq.auditing.sightseer import MOVES, check_ending, check_links, check_moves
from exactacq.auditing.visibility import World
from exactacq.errors import AuditError
from exactacq.gc_pause import uncollected
from exactacq.progress import Meter, Progress
from exactacq.sensing.event import Ending, EventKind
from exactacq.strategies.run import OwnRun, Run, SeedSpreaderRun, SightseerRun


@uncollected()
def audit(run: Run, *, samples: int = 64, seed: int = 0, progress: Progress | None = None) -> None:
    """Check a finished run by other means than those that made it; raises `AuditError` with the first flaw.

    Path, moves, links, bounds and length are checked completely, and so is each place at which a sweep lets
    an obstacle go out of sight or diverts to it. What is known is checked beside all ends of known parts in
    the final map, and on samples: *samples* random boundary points, half as many ends in other maps, and as
    many places on the path, some of them beside events of sight. That nothing at stake goes out of reach is
    asked where pieces of a line begin and at places inside `MOMENTS` of them. Equal seeds give equal samples.
    Of a strategy of the user's own all is checked but what it does, and the values of its bounds. Of
    decisions it is checked that what is told is true and the chosen one the least of it, not that all is
    told. *progress* is told how many of how many steps are done. Returns None if no flaw is found. ValueError
    for a run that was given up, `Undecided` where an exact comparison is beyond the limits. Cost: about ten
    milliseconds a sample at ten obstacles in range, less than one for each piece and event, and that of
    `MOMENTS` maps, and of two for each obstacle that is seen; for the Seed Spreader also of one map for each
    piece on its lines, and for each place where something goes out of sight there.

    >>> import exactacq as xa
    >>> audit(xa.sightseer(xa.load("circles")), samples=8)
    """
    if not isinstance(run, SightseerRun | SeedSpreaderRun | OwnRun):
        raise ValueError(f"no audit for a {type(run).__name__}")
    if run.ending is Ending.UNDECIDED:
        raise ValueError("no audit for a run that was given up: its strategy did not end")
    rng = Random(seed)
    meter = Meter(progress, len(run.path), len(run.events), MOMENTS + 1, 5 * samples // 2, samples)
    world, field = World(run.scene), None
    if run.ground is not None:
        field = Field(run, world)
        check_components(run, field)
    bodies = list(_bodies(run, world))
    check_continuity(run)
    tracks = check_pieces(run, world, bodies, field, meter)
    meter.close()
    check_length(run)
    check_events(run, rng, OWN_MOVES if isinstance(run, OwnRun) else MOVES if field is None else SWEEP_MOVES)
    if isinstance(run, SightseerRun):
        check_moves(run, tracks)
        check_links(run)
        values = sightseer_values(run, world)
    elif isinstance(run, OwnRun):
        check_own_moves(run, bodies, tracks)
        values = declared_values(run)
    else:
        assert isinstance(run, SeedSpreaderRun) and field is not None
        Replay(run, field, bodies, tracks, rng).check(meter)
        values = spreader_values(run, field)
    check_sights(run)
    _check_accounts(run)
    check_bounds(run, values)
    meter.close()
    knowledge = Knowledge(run, world, bodies, tracks, rng, meter)
    knowledge.check_maps()
    meter.close()
    knowledge.check_targets(samples)
    knowledge.check_news()
    meter.close()
    knowledge.check_in_sight(samples)
    meter.close()
    check_decisions(run)


def _bodies(run: Run, world: World) -> Iterator[AuditedBody]:
    """What the numbers of obstacles in a run mean: obstacles of the scene, or shores of components."""
    for k, obstacle in enumerate(run.obstacles):
        body: Any = obstacle
        owner = k if run.ground is None else body.obstacle.index
        first, parts = world.first[owner], range(len(body.edges))
        edges = parts if run.ground is None else [part.edge for part in body.shore]
        yield AuditedBody(k, owner, body.edges, [first + e for e in edges], body.closed)


def _check_accounts(run: Run) -> None:
    """Unseen and unvisited obstacles, and the events of sight, agree with the map.

    A sweep that comes to its end has acquired what it has seen; what it has not is unvisited, and so it is
    for strategies of the user's own.
    """
    seen, acquired, visits = set(run.map.seen), set(run.map.acquired), set(run.visits)
    left = seen - (visits if isinstance(run, SightseerRun) else acquired)
    for name, claimed, expected in (
        ("unseen", run.unseen, set(range(len(run.obstacles))) - seen),
        ("unvisited", run.unvisited, left),
        ("sighted in events", _obstacles(run, EventKind.SIGHT), seen),
        ("acquired in events", _obstacles(run, EventKind.ACQUIRE), acquired),
    ):
        if sorted(claimed) != sorted(expected):
            raise AuditError(f"obstacles {name} are {sorted(claimed)}, by the map {sorted(expected)}")
    if visits - acquired:
        raise AuditError(
            f"obstacles {sorted(visits - acquired)} were visited, but the map lacks parts of them"
        )
    if run.ending is Ending.END_OF_M_LINE and left:
        raise AuditError(f"obstacles {sorted(left)} were seen, but not acquired when T was reached")
    if isinstance(run, SightseerRun):
        check_ending(run, left)


def _obstacles(run: Run, kind: EventKind) -> list[int]:
    return [event.obstacle for event in run.events if event.kind == kind and event.obstacle is not None]
