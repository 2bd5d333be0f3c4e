"""exactacq: exact sensor-based terrain acquisition among segments and circular arcs.

A robot with a limited radius of vision maps unknown obstacles by a strategy: `sightseer`, `seed_spreader`, or
one of your own (`strategy`, `explore`). Path, map and length are exact. Names are imported on first use: a
program that needs `Length` only does not wait for the modules that draw or read files.
"""

from importlib import import_module

from exactacq.scene.ports import JSON, PLAYER, SVG, offer

TYPE_CHECKING = False  # That of typing, whose import takes as long as all else here.
if TYPE_CHECKING:
    from typing import Any

    from exactacq.auditing.audit import audit
    from exactacq.errors import (
        AuditError,
        ExactacqError,
        FormatError,
        InvalidScene,
        MoveError,
        StrategyError,
        Undecided,
    )
    from exactacq.files.checking.inspection import Inspection, inspect
    from exactacq.files.formats import formats
    from exactacq.files.load import load
    from exactacq.geometry.curves import Arc, Segment
    from exactacq.geometry.points import Point
    from exactacq.numbers.length import Length
    from exactacq.numbers.real import Real
    from exactacq.output.figures import figure
    from exactacq.output.results import write
    from exactacq.output.run_json import load_run
    from exactacq.scene.bends import Around, Via
    from exactacq.scene.bounding import terrain_around
    from exactacq.scene.scene import Scene
    from exactacq.scene.shapes import Circle, Outline, Polygon, Terrain
    from exactacq.sensing.decision import Decision
    from exactacq.sensing.event import Event, EventKind
    from exactacq.sensing.map import Map
    from exactacq.sensing.path import Path
    from exactacq.sensing.view_events import sweep
    from exactacq.strategies.explore import explore
    from exactacq.strategies.registry import strategy
    from exactacq.strategies.robot import Robot
    from exactacq.strategies.run import OwnRun, Run, SeedSpreaderRun, SightseerRun
    from exactacq.strategies.seed_spreader.strategy import seed_spreader
    from exactacq.strategies.sightseer.strategy import sightseer
    from exactacq.visibility.graphs import tangent_graph, visibility_graph
    from exactacq.visibility.isovist import Isovist, isovist
    from exactacq.visibility.shortest_path import ShortestPath, shortest_path

__all__ = [
    "Arc",
    "Around",
    "AuditError",
    "Circle",
    "Decision",
    "Event",
    "EventKind",
    "ExactacqError",
    "FormatError",
    "Inspection",
    "InvalidScene",
    "Isovist",
    "Length",
    "Map",
    "MoveError",
    "Outline",
    "OwnRun",
    "Path",
    "Point",
    "Polygon",
    "Real",
    "Robot",
    "Run",
    "Scene",
    "SeedSpreaderRun",
    "Segment",
    "ShortestPath",
    "SightseerRun",
    "StrategyError",
    "Terrain",
    "Undecided",
    "Via",
    "audit",
    "explore",
    "figure",
    "formats",
    "inspect",
    "isovist",
    "load",
    "load_run",
    "seed_spreader",
    "shortest_path",
    "sightseer",
    "strategy",
    "sweep",
    "tangent_graph",
    "terrain_around",
    "visibility_graph",
    "write",
]

_HOMES = {
    "Arc": "exactacq.geometry.curves",
    "Around": "exactacq.scene.bends",
    "AuditError": "exactacq.errors",
    "Circle": "exactacq.scene.shapes",
    "Decision": "exactacq.sensing.decision",
    "Event": "exactacq.sensing.event",
    "EventKind": "exactacq.sensing.event",
    "ExactacqError": "exactacq.errors",
    "FormatError": "exactacq.errors",
    "Inspection": "exactacq.files.checking.inspection",
    "InvalidScene": "exactacq.errors",
    "Isovist": "exactacq.visibility.isovist",
    "Length": "exactacq.numbers.length",
    "Map": "exactacq.sensing.map",
    "MoveError": "exactacq.errors",
    "Outline": "exactacq.scene.shapes",
    "OwnRun": "exactacq.strategies.run",
    "Path": "exactacq.sensing.path",
    "Point": "exactacq.geometry.points",
    "Polygon": "exactacq.scene.shapes",
    "Real": "exactacq.numbers.real",
    "Robot": "exactacq.strategies.robot",
    "Run": "exactacq.strategies.run",
    "Scene": "exactacq.scene.scene",
    "SeedSpreaderRun": "exactacq.strategies.run",
    "Segment": "exactacq.geometry.curves",
    "ShortestPath": "exactacq.visibility.shortest_path",
    "SightseerRun": "exactacq.strategies.run",
    "StrategyError": "exactacq.errors",
    "Terrain": "exactacq.scene.shapes",
    "Undecided": "exactacq.errors",
    "Via": "exactacq.scene.bends",
    "audit": "exactacq.auditing.audit",
    "explore": "exactacq.strategies.explore",
    "figure": "exactacq.output.figures",
    "formats": "exactacq.files.formats",
    "inspect": "exactacq.files.checking.inspection",
    "isovist": "exactacq.visibility.isovist",
    "load": "exactacq.files.load",
    "load_run": "exactacq.output.run_json",
    "seed_spreader": "exactacq.strategies.seed_spreader.strategy",
    "shortest_path": "exactacq.visibility.shortest_path",
    "sightseer": "exactacq.strategies.sightseer.strategy",
    "strategy": "exactacq.strategies.registry",
    "sweep": "exactacq.sensing.view_events",
    "tangent_graph": "exactacq.visibility.graphs",
    "terrain_around": "exactacq.scene.bounding",
    "visibility_graph": "exactacq.visibility.graphs",
    "write": "exactacq.output.results",
}
"""Where the names live."""

offer(SVG, "exactacq.scene.scene.Scene", "exactacq.output.figures", "svg")
offer(SVG, "exactacq.strategies.run.Run", "exactacq.output.figures", "svg")
offer(SVG, "exactacq.visibility.isovist.Isovist", "exactacq.output.isovist_svg", "svg")
offer(PLAYER, "exactacq.strategies.run.Run", "exactacq.output.animation.notebook", "Player")
offer(SVG, "exactacq.visibility.shortest_path.ShortestPath", "exactacq.output.figures", "svg")
offer(JSON, "exactacq.strategies.run.Run", "exactacq.output.run_json", "run_to_json")


def __getattr__(name: str) -> "Any":
    """Load the module where a name lives; from then on it is a name of this one."""
    if name == "kernel":  # Whose DESCRIPTION says which form of the kernel runs.
        return import_module("exactacq.kernel")
    if name == "__version__":
        return import_module("importlib.metadata").version("exactacq")
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_HOMES[name]), name)
    return value


def __dir__() -> list[str]:
    """The vocabulary, without the rooms and what is imported to fill it."""
    return sorted(__all__)
