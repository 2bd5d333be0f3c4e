"""Finished runs: path, events, links, diversions, bounds, and the map at every moment."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, fields
from html import escape
from math import tan
from typing import Any, Protocol, Self, TypeVar

from flint import fmpq

from exactacq.cached import cached_property
from exactacq.files.whole_files import readable
from exactacq.geometry.curves import Arc, Curve
from exactacq.geometry.geo import Geo
from exactacq.geometry.points import Point, distance
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import plain
from exactacq.progress import Meter, Progress
from exactacq.scene.ports import JSON, PLAYER, SVG, made
from exactacq.scene.scene import Scene
from exactacq.scene.terrain_components import Ground, ground_of
from exactacq.sensing.event import Ending, Event, EventKind, Reason
from exactacq.sensing.map import Body, Map
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Path
from exactacq.strategies.late_entry import late
from exactacq.strategies.tables import Table, event_table
from exactacq.visibility.isovist import Isovist

AnyRun = TypeVar("AnyRun", bound="Run")
CLOSED_FORM = 60
"""Closed forms of at most this many characters stand in tables."""


@dataclass(frozen=True)
class Bound:
    """A bound on the path's length, or on the number of visits, by the paper's formula (``source``).

    ``value`` is exact, and so is the comparison ``holds``; ``ratio``, a float, is what is bounded over the
    value (NaN where the value is 0). ``applies`` tells whether the formula speaks of such a run at all:
    those of the Sightseer, for one, are for runs that visit all obstacles. The last two are not compared.

    >>> import exactacq as xa
    >>> bound = xa.sightseer(xa.load("circles")).bounds[0]
    >>> print(bound.name, bound.value, bound.holds, bound.applies)
    (1) 4 + 15*pi True True
    """

    name: str
    source: str
    value: Length
    holds: bool
    ratio: float = field(compare=False)
    applies: bool = field(default=True, compare=False)

    def _repr_latex_(self) -> str:
        """For notebooks: the formula's number and value, with the verdict."""
        verdict = "holds" if self.holds else "does not hold"
        return f"{self.name}, {self.source}: {self.value._repr_latex_()} {verdict}"


@late("events", "bounds")
@dataclass(frozen=True, repr=False, kw_only=True)
class Run:
    """A finished exploration: a `SightseerRun`, a `SeedSpreaderRun` or an `OwnRun`.

    ``path`` and ``events`` are in the order of the walk; ``visits`` are the numbers of obstacles in the order
    in which the robot walked around them, ``bounds`` the paper's bounds on the length. ``unseen`` obstacles
    never came on the map. ``unvisited`` ones did without being reached, or, but for the Sightseer, without
    becoming wholly known. ``record`` is the sensing, or what does it when somebody asks; a run that was read
    from a file has none and repeats the sensing on first use.

    Runs are equal if all their entries but the record are: so is a run that was copied, pickled or read back.
    A run has a hash only if all its lengths and points are rational.

    >>> import exactacq as xa
    >>> run = xa.sightseer(xa.load("circles"))
    >>> print(run.length, run.visits, run.complete, len(run.events))
    5 + 12*pi (0, 1) True 11
    """

    scene: Scene
    radius: fmpq
    start: Point
    path: Path
    visits: tuple[int, ...]
    events: tuple[Event, ...]
    bounds: tuple[Bound, ...]
    unseen: tuple[int, ...]
    unvisited: tuple[int, ...]
    record: Memory | Sensing | None = field(default=None, repr=False, compare=False)

    @property
    @abstractmethod
    def strategy(self) -> str:
        """The strategy's name."""

    @property
    @abstractmethod
    def title(self) -> str:
        """What the strategy is called in titles."""

    @cached_property
    def length(self) -> Length:
        """Exact length of the path."""
        return self.path.length_after(len(self.path))

    @property
    def complete(self) -> bool:
        """Whether every obstacle was visited, or, but for the Sightseer, is wholly known."""
        return not self.unseen and not self.unvisited

    @cached_property
    def memory(self) -> Memory:
        """What the robot learned on its way."""
        if self.record is not None:
            return self.record if isinstance(self.record, Memory) else self.record()
        return Memory.of(self.scene, self.radius, self.start, self.path, self.ground)

    @property
    def ground(self) -> Ground | None:
        """What the terrain leaves of the scene's obstacles, if the robot was confined to it; else None."""
        return None

    @property
    def obstacles(self) -> Sequence[Body]:
        """What the numbers of obstacles in this run mean.

        The scene's obstacles; of a robot that was confined to a terrain, as for the Seed Spreader, the
        components that this leaves of them.
        """
        return self.scene.obstacles if self.ground is None else self.ground.components

    def sense(self, progress: Progress | None = None) -> Self:
        """Find out now all that the robot saw on its way; returns the run.

        The way of a `SightseerRun` does not depend on it: so it is found out when it is first asked for, as
        its events and maps are. It takes several times as long as the way alone. What is not sensed yet
        raises `Undecided`, with the run up to there, where a comparison is beyond the library's limits; it
        does so whenever it is asked for. *progress* is called with the number of pieces of the path that are
        sensed, and of those to be sensed; the look around at the start counts as one.

        >>> import exactacq as xa
        >>> len(xa.sightseer(xa.load("circles")).sense().events)
        11
        """
        meter = Meter(progress, len(self.path) + 1)
        if self.record is not None and not isinstance(self.record, Memory):
            self.record(progress)
        else:
            self.memory.after(0)  # That of a run from a file is made here.
            meter.close()
        len(self.events)  # They are made here, of what was seen.
        return self

    @property
    def ending(self) -> Ending | None:
        """Why the path ends."""
        return self.events[-1].ending

    @cached_property
    def map(self) -> Map:
        """The map at the end."""
        return self.memory.after(len(self.path))

    @property
    def incomplete(self) -> tuple[int, ...]:
        """The obstacles of which some but not all was seen."""
        return self.map.incomplete

    def map_at(self, moment: Event | Length | object) -> Map:
        """The map as it was at an event of this run, or after a length of the path.

        Where the place has transcendental coordinates, as most places on an arc have, the map is exact too,
        but what depends on the place has no closed form. ValueError if the path has no such place, for an
        event of another run, or if it lies inside an arc after a sum of angles that are no simple fractions
        (see `near`). Cost: that of sensing one piece, once for all moments of it that are asked for together.

        >>> import exactacq as xa
        >>> print(xa.sightseer(xa.load("circles")).map_at(2).known_length())
        2*acos(-17/25)
        """
        count, place = self.moment(moment)
        return self.memory.after(count) if place is None else self.memory.within(count, place)

    def view_at(self, moment: Event | Length | object) -> Isovist:
        """What the robot sees at an event of this run, or after a length of it; raises what `map_at` raises.

        >>> import exactacq as xa
        >>> xa.sightseer(xa.load("circles")).view_at(2)
        <Isovist from (2, 0) within 20>
        """
        count, place = self.moment(moment)
        if place is None:
            place = (
                self.path[count].start
                if count < len(self.path)
                else self.path[-1].end
                if count
                else self.start
            )
            own, facts = self.memory.view_after(count, place)
        else:
            own, facts = self.memory.view_within(count, place)
        return Isovist(self.scene, place, self.radius, own, facts)

    def moment(self, moment: Event | Length | object) -> tuple[int, Point | None]:
        """The number of whole pieces before a moment, and the place in the next one if it lies inside it.

        >>> import exactacq as xa
        >>> xa.sightseer(xa.load("circles")).moment(2)
        (0, Point(2, 0))
        """
        if isinstance(moment, Event):
            if moment.path is not self.path and moment.path != self.path:
                raise ValueError(f"{moment!r} is an event of another run")
            return moment.after, moment.point if moment.inside else None
        count, rest = self.path.find(Length(moment))
        if rest.sign() == 0:
            return count, None
        try:
            return count, self.path[count].curve.after(rest)
        except ValueError:
            for event in self.events:
                if event.after == count and event.inside and event.beyond == rest:
                    return count, event.point
            raise

    def near(self, length: Length | object) -> Event:
        """A place after a length of the path, for `map_at`, `view_at` and figures: an event of kind "moment".

        Where that is no algebraic place, a rational parameter beside it is taken: it is off by round-off
        only, and the event's own ``at`` is exact. ValueError if the path is shorter.

        >>> import exactacq as xa
        >>> near = xa.sightseer(xa.load("circles")).near(6)
        >>> f"{near.at:.12f}", near.obstacle
        ('6.000000000000', 0)
        """
        count, rest = self.path.find(Length(length))
        if rest.sign() == 0:
            place = self.path[count - 1].end if count else self.start
            return Event(EventKind.MOMENT, place, None, count, self.path)
        piece = self.path[count]
        if isinstance(piece.curve, Arc) or rest != Length(rest.algebraic):
            place = piece.point(_share(piece.curve, rest))
        else:
            place = piece.curve.after(rest)
        return Event(EventKind.MOMENT, place, piece.obstacle, count, self.path, inside=True)

    def __repr__(self) -> str:
        name = f" on {self.scene.name}" if self.scene.name else ""
        done = f"{len(self.visits)} of {len(self.obstacles)} obstacles visited"
        size = f"R = {plain(self.radius)}, length {float(self.length):.6g}"
        return f"<{type(self).__name__}{name}, {size}, {done}>"

    def __reduce__(self) -> tuple[Any, ...]:
        """Without the sensing, which is repeated when it is first asked for: it knows places by identity."""
        state = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "record"}
        return _again, (type(self), state)

    @property
    def __geo_interface__(self) -> Geo:
        """The path as GeoJSON: a LineString, arcs as chords; a Point if the robot never leaves the start."""
        return self.path.__geo_interface__ if self.path else self.start.__geo_interface__

    def _repr_html_(self) -> str:
        """A line that says what the run is, its figure, and the bounds."""
        picture = self._repr_svg_()
        bounds = self.bound_table._repr_html_() if self.bounds else ""
        return f"<div><p>{escape(repr(self)[1:-1])}</p>{picture[picture.index('<svg') :]}{bounds}</div>"

    def _repr_svg_(self) -> str:
        return str(made(SVG, self))

    def animate(self) -> Any:
        """The page that plays the run, for a notebook to show or to `save` as an .html file.

        It is made when it is first shown: a map and a view for each place where something happens, and for
        some between them. (`exactacq.output.animation.notebook.Player` has labels and progress too.)

        >>> import exactacq as xa
        >>> xa.sightseer(xa.load("circles")).animate()
        <Player of <SightseerRun on circles, R = 20, length 42.6991, 2 of 2 obstacles visited>>
        """
        return made(PLAYER, self)

    def to_json(self) -> dict[str, Any]:
        """The run as JSON data with exact numbers; `exactacq.load_run` reads it back. Linear in the path.

        >>> import exactacq as xa
        >>> data = xa.sightseer(xa.load("circles")).to_json()
        >>> data["format"], data["length"]["closed"]
        ('exactacq run', '5 + 12*pi')
        """
        document: dict[str, Any] = made(JSON, self)
        return document

    @property
    def event_table(self) -> Table:
        """The events in rows: what happened, to which obstacle, after which length, where, and why.

        ``number`` is that of the event in `events`, ``at`` the length of the path so far, ``x`` and ``y`` the
        place, all floats in the scene's unit; ``obstacle`` its number, ``name`` its label; ``why`` tells the
        decision to make the move that begins there (see `Event.why`). Linear in the path; and a few links for
        each decision, the first time.

        >>> import exactacq as xa
        >>> row = xa.sightseer(xa.load("circles")).event_table[2]
        >>> row["kind"], row["name"], row["at"], row["x"], row["y"], row["note"]
        ('hit', 'O1', 3.0, 3.0, 0.0, 'from S')
        """
        return event_table(self.events, list(self.names()))

    @property
    def bound_table(self) -> Table:
        """The bounds in rows: name, source, value as a float and closed form if short, and verdicts.

        >>> import exactacq as xa
        >>> row = xa.sightseer(xa.load("circles")).bound_table[0]
        >>> row["name"], round(row["value"], 3), row["closed"], row["holds"]
        ('(1)', 51.124, '4 + 15*pi', True)
        """
        columns = ("name", "source", "value", "closed", "holds", "ratio", "applies")
        return Table(columns, (dict(zip(columns, _told(bound), strict=True)) for bound in self.bounds))

    def names(self) -> Iterator[str]:
        """The obstacles' labels: their names, or "O" and the number from 1.

        >>> import exactacq as xa
        >>> list(xa.sightseer(xa.load("circles")).names())
        ['O1', 'O2']
        """
        return (body.label for body in self.obstacles)


class Sensing(Protocol):
    """What finds out all that a robot saw on its way; *progress* is told how many pieces of this are done."""

    def __call__(self, progress: Progress | None = None) -> Memory: ...


def bounded(run: AnyRun, bounds: tuple[Bound, ...]) -> AnyRun:
    """A run with other bounds; what it saw is not asked for."""
    copy = object.__new__(type(run))
    copy.__dict__.update(run.__dict__, bounds=bounds)
    return copy


def _again(kind: type[Run], state: dict[str, Any]) -> Run:
    """The run that was pickled or copied."""
    return kind(**state)


def _told(bound: Bound) -> tuple[str | float | bool | None, ...]:
    """A bound's entries in a table."""
    closed, *rest = readable(bound.value, CLOSED_FORM, 17)
    form = closed if rest or "≈" not in closed else None
    return bound.name, bound.source, float(bound.value), form, bound.holds, bound.ratio, bound.applies


def _share(curve: Curve, length: Length) -> fmpq:
    """The parameter of a curve's point after about a length of it (see `Arc.point`)."""
    share, half, parts = float(length) / float(curve.length), 0, 1
    if isinstance(curve, Arc):
        whole, turned = (float(part) / float(curve.radius) for part in (curve.length, length))
        if curve.full:
            half, parts = int(turned > whole / 2), 2
        share = tan((turned - half * whole / 2) / 4) / tan(whole / parts / 4)
    return min(max((fmpq(*share.as_integer_ratio()) + half) / parts, fmpq(0)), fmpq(1))


@dataclass(frozen=True)
class TreeLink:
    """An edge of the tree that the run walked: from ``leave`` on ``source`` ("S": the start) to ``hit``."""

    source: int | str
    target: int
    leave: Point
    hit: Point
    length: Length
    traversals: int


@dataclass(frozen=True)
class Diversion:
    """A diversion of the Seed Spreader from ``leave`` (D) on the M-line to ``hit`` (Q), and back.

    The pieces of the path from number ``first`` to ``last``, the latter excluded, belong to it.
    """

    obstacle: int
    leave: Point
    hit: Point
    reason: Reason
    first: int
    last: int

    @cached_property
    def length(self) -> Length:
        """The length of the straight way from D to Q."""
        return Length(distance(self.leave, self.hit))


@dataclass(frozen=True, repr=False, kw_only=True)
class SightseerRun(Run):
    """A finished exploration by the Sightseer Strategy.

    ``links`` are the edges of the tree that it walked, in the order of the visits, and ``stack_depth`` the
    most entries that its stack held. ``unseen`` and ``unvisited`` are empty where the paper's model (a) holds
    for the radius: the start sees an obstacle, and chains of links join all obstacles.

    >>> import exactacq as xa
    >>> run = xa.sightseer(xa.load("circles"))
    >>> [(link.source, link.target, str(link.length)) for link in run.links], run.ending.value
    ([('S', 0, '3'), (0, 1, '2')], 'all visited')
    """

    strategy = "sightseer"
    title = "Sightseer Strategy"

    links: tuple[TreeLink, ...]
    stack_depth: int


@dataclass(frozen=True, repr=False, kw_only=True)
class SeedSpreaderRun(Run):
    """A finished exploration by the Seed Spreader Strategy, with its options ``lookahead`` and ``target``.

    ``encounters`` are the obstacles that were met on the M-line or on the way out on a diversion, in order;
    ``again`` those that blocked the M-line and were acquired before. ``unreached`` are the obstacles of the
    scene of which the terrain has a component that the robot cannot reach from the SW corner.

    >>> import exactacq as xa
    >>> run = xa.seed_spreader(xa.load("case3"))
    >>> [(diversion.obstacle, diversion.reason.value) for diversion in run.diversions]
    [(2, 'out of sight')]
    """

    strategy = "seed-spreader"
    title = "Seed Spreader Strategy"

    lookahead: bool
    target: str
    diversions: tuple[Diversion, ...]
    encounters: tuple[int, ...]
    again: tuple[int, ...]
    unreached: tuple[int, ...]

    @property
    def links(self) -> tuple[Diversion, ...]:
        """The diversions, by the name that the straight ways of both strategies share."""
        return self.diversions

    @cached_property
    def ground(self) -> Ground:
        """What the terrain leaves of the scene's obstacles."""
        return _ground(self)


@dataclass(frozen=True, repr=False, kw_only=True)
class OwnRun(Run):
    """A finished exploration by a strategy of the user's own, of that ``name`` (see `exactacq.explore`).

    It has no bounds unless the strategy was registered with some; ``unvisited`` obstacles are those that were
    seen and are not wholly known. If the robot was ``confined`` to the terrain, obstacles are the components
    of this, and ``visits`` those among them that the border does not cut.

    >>> import exactacq as xa
    >>> run = xa.explore(xa.load("circles"), lambda robot: robot.go_to((3, 0)))
    >>> print(run.ending.value, run.length, run.map.incomplete)
    finished 3 (0,)
    """

    name: str
    confined: bool = False

    @cached_property
    def ground(self) -> Ground | None:
        """What the terrain leaves of the scene's obstacles, if the robot was confined to it; else None."""
        return _ground(self) if self.confined else None

    @property
    def strategy(self) -> str:
        """The strategy's name."""
        return self.name

    @property
    def title(self) -> str:
        """What the strategy is called in titles."""
        return f"Strategy {self.name}"

    def __repr__(self) -> str:
        return super().__repr__().replace("OwnRun", f"OwnRun {self.name}", 1)


def _ground(run: Run) -> Ground:
    """What the terrain leaves of the scene's obstacles, as the run has found it or anew."""
    ground = run.record.ground if isinstance(run.record, Memory) else None
    return ground_of(run.scene) if ground is None else ground
