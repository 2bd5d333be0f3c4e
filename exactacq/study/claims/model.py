"""What a claim of the paper is, and how a verdict on it is reached: by scenes, never by decree."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Enum
from typing import Any, TypeVar

import networkx as nx

from exactacq.auditing.ground import Field
from exactacq.auditing.visibility import World
from exactacq.cached import cached_property
from exactacq.geometry.points import Point
from exactacq.scene.scene import Scene
from exactacq.sensing.event import Ending
from exactacq.strategies.run import SeedSpreaderRun, SightseerRun
from exactacq.strategies.seed_spreader.strategy import seed_spreader
from exactacq.strategies.sightseer.strategy import sightseer
from exactacq.study.claims.farthest import farthest_first
from exactacq.study.claims.formulas import spoken
from exactacq.visibility.graphs import graph_of
from exactacq.visibility.links import START, Links

Made = TypeVar("Made")


class Outcome(Enum):
    """What one case says of a statement."""

    HOLDS = "holds"
    FAILS = "fails"
    SILENT = "outside what the statement speaks of"


@dataclass(frozen=True)
class Finding:
    """The outcome of one case, why, and for bounds the ratio of what was bounded over the bound."""

    outcome: Outcome
    detail: str = ""
    ratio: float | None = None


SILENT = Finding(Outcome.SILENT)


def found(holds: bool, detail: str = "", ratio: float | None = None) -> Finding:
    """HOLDS or FAILS."""
    return Finding(Outcome.HOLDS if holds else Outcome.FAILS, detail, ratio)


def flaw(text: str | None) -> Finding:
    """FAILS with the first flaw that was found, HOLDS if there is none."""
    return found(text is None, text or "")


class Case:
    """A scene with its radius, the runs on it, and what checks share; all made when first asked for."""

    def __init__(self, scene: Scene, radius: object = None) -> None:
        self.scene, self.radius = scene, scene.radius if radius is None else radius
        self._sweeps: dict[tuple[bool, str], SeedSpreaderRun] = {}

    @cached_property
    def sightseer(self) -> SightseerRun:
        """The Sightseer's run from the scene's start."""
        return sightseer(self.scene, self.radius)

    @cached_property
    def farthest(self) -> SightseerRun:
        """The Sightseer's run if it goes to the farthest visible obstacle in place of the nearest."""
        return farthest_first(self.links)

    @property
    def spreader(self) -> SeedSpreaderRun:
        """The Seed Spreader's run with its usual options."""
        return self.sweep()

    def sweep(self, lookahead: bool = True, target: str = "known") -> SeedSpreaderRun:
        """The Seed Spreader's run."""
        key = lookahead, target
        if key not in self._sweeps:
            self._sweeps[key] = seed_spreader(self.scene, self.radius, lookahead=lookahead, target=target)
        return self._sweeps[key]

    @cached_property
    def links(self) -> Links:
        """The links between obstacles, made apart from those of the runs."""
        return Links(self.scene, self.radius)

    @cached_property
    def graph(self) -> nx.Graph:
        """The obstacle visibility graph, the start included."""
        return graph_of(self.links)

    @property
    def is_mutually_visible(self) -> bool:
        """Whether the paper's model (a) holds: the start sees an obstacle, and all obstacles are linked by
        sight, without the start between them."""
        if not self.scene.obstacles:
            return False
        among = self.graph.subgraph(node for node in self.graph if node != START)
        return bool(nx.is_connected(among) and nx.is_connected(self.graph))

    @cached_property
    def within_sight(self) -> set[int]:
        """The obstacles that are linked with the start by sight, directly or by others."""
        return {int(k) for k in nx.node_connected_component(self.graph, START) if k != START}

    @cached_property
    def world(self) -> World:
        """The scene as the audit sees it."""
        return World(self.scene)

    @cached_property
    def field(self) -> Field:
        """The terrain as the audit sees it: the M-line, and what blocks it."""
        return Field(self.spreader, self.world)

    def shared(self, make: Callable[[Case], Made]) -> Made:
        """What several checks of the case need, made of it once."""
        if make not in self._shared:
            self._shared[make] = make(self)
        made: Made = self._shared[make]
        return made

    @cached_property
    def _shared(self) -> dict[Any, Any]:
        return {}

    @property
    def swept_to_the_end(self) -> bool:
        """Whether the Seed Spreader came to T: no obstacle trapped S or T."""
        end: Point = self.spreader.path[-1].end
        trapped = self.spreader.events[-1].ending is Ending.TRAPPED
        return end == self.field.pieces[-1].end and not trapped


class Subject(Enum):
    """Which run a statement speaks of, and so which random scenes try it."""

    SIGHTSEER = "sightseer"
    SEED_SPREADER = "seed-spreader"


@dataclass(frozen=True)
class Statement:
    """A claim in words of this study, and what decides it.

    ``text`` has its formulas in TeX, between dollars; ``words`` is the same in plain characters.
    ``check`` decides one case. ``trial`` decides what no single scene can, or puts an argument to the
    test. ``counterexamples`` are gallery scenes that must fail the check exactly; a statement with one is
    classified as false. ``is_false`` classifies it as false where no single scene shows it: then the
    trial must fail. ``argument`` names the file under ``proofs/arguments`` with a written proof.
    """

    text: str
    subject: Subject
    check: Callable[[Case], Finding] | None = None
    trial: Callable[[], Finding] | None = None
    counterexamples: tuple[str, ...] = ()
    argument: str | None = None
    is_false: bool = False

    @property
    def words(self) -> str:
        """The text as a terminal shows it, with formulas in plain characters."""
        return spoken(self.text)

    @property
    def is_called_false(self) -> bool:
        """Whether the registry classifies the statement as false."""
        return self.is_false or bool(self.counterexamples)


@dataclass(frozen=True)
class Claim:
    """One row of the study: the paper's statement, where it stands, and what holds instead."""

    name: str
    place: str
    printed: Statement
    corrected: Statement | None = None
    note: str = ""

    @property
    def statements(self) -> tuple[Statement, ...]:
        """What is printed, and what holds instead."""
        return (self.printed,) if self.corrected is None else (self.printed, self.corrected)


class Status(Enum):
    """What is known of a statement once it has been tried."""

    PROVED = "proved"
    HOLDS = "holds on all scenes tried"
    FALSE = "false"
    CONTRADICTED = "not as called here"
    UNTRIED = "no scene spoke of it"


@dataclass(frozen=True)
class Verdict:
    """A computed verdict: ``tried`` cases spoke of the statement, ``failures`` name those that fail it.

    A statement is CONTRADICTED if it is called false and a counterexample of it does not fail, or called true
    and a case fails it.
    """

    status: Status
    tried: int
    failures: tuple[str, ...]
    worst: float | None
    details: tuple[str, ...]


def verdict(
    statement: Statement, cases: Iterable[tuple[str, Case]], examples: Callable[[str], Case]
) -> Verdict:
    """Decide a statement by its counterexamples, or else by its trial and the named *cases*."""
    named: Iterable[tuple[str, Case]] = cases
    if statement.is_called_false:
        named = ((n, examples(n)) for n in statement.counterexamples)
    findings: list[tuple[str, Finding]] = []
    if statement.trial is not None:
        findings.append(("trial", statement.trial()))
    if statement.check is not None:
        findings += [(name, statement.check(case)) for name, case in named]
    spoken = [(name, f) for name, f in findings if f.outcome is not Outcome.SILENT]
    failures = tuple(name for name, f in spoken if f.outcome is Outcome.FAILS)
    ratios = [f.ratio for _, f in spoken if f.ratio is not None]
    return Verdict(
        _status(statement, len(spoken), len(failures), len(findings)),
        len(spoken),
        failures,
        max(ratios, default=None),
        tuple(f"{name}: {f.detail}" for name, f in spoken if f.detail),
    )


def _status(statement: Statement, spoken: int, failures: int, asked: int) -> Status:
    if statement.is_called_false:
        return Status.FALSE if 0 < failures == asked else Status.CONTRADICTED
    if failures:
        return Status.CONTRADICTED
    if not spoken:
        return Status.UNTRIED
    return Status.HOLDS if statement.argument is None else Status.PROVED
