"""exactacq: exact sensor-based terrain acquisition among segments and circular arcs."""

from typing import TYPE_CHECKING, Any

from exactacq.audit.run import audit
from exactacq.errors import AuditError, ExactacqError, FormatError, InvalidScene, Undecided
from exactacq.files.load import load
from exactacq.geometry.curves import Arc, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.real import Real
from exactacq.scene.ports import JSON, SVG, offer
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle, Outline, Polygon, Terrain
from exactacq.sensing.map import Map
from exactacq.sensing.path import Event, Path
from exactacq.sensing.view_events import sweep
from exactacq.strategies.run import Run
from exactacq.strategies.seed_spreader.strategy import seed_spreader
from exactacq.strategies.sightseer.strategy import sightseer
from exactacq.visibility.isovist import Isovist, isovist
from exactacq.visibility.links import visibility_graph

offer(SVG, Scene, "exactacq.output.figures", "svg")
offer(SVG, Run, "exactacq.output.figures", "svg")
offer(SVG, Isovist, "exactacq.output.isovist_svg", "svg")
offer(JSON, Run, "exactacq.output.run_json", "run_to_json")

if TYPE_CHECKING:
    from exactacq.output.figures import figure
    from exactacq.output.run_json import load_run

__all__ = [
    "Arc",
    "AuditError",
    "Circle",
    "Event",
    "ExactacqError",
    "FormatError",
    "InvalidScene",
    "Isovist",
    "Length",
    "Map",
    "Outline",
    "Path",
    "Point",
    "Polygon",
    "Real",
    "Run",
    "Scene",
    "Segment",
    "Terrain",
    "Undecided",
    "audit",
    "figure",
    "isovist",
    "load",
    "load_run",
    "seed_spreader",
    "sightseer",
    "sweep",
    "visibility_graph",
]


def __getattr__(name: str) -> Any:
    """Load what draws or reads runs when it is first asked for: matplotlib takes most of a second."""
    if name == "figure":
        from exactacq.output.figures import figure

        return figure
    if name == "load_run":
        from exactacq.output.run_json import load_run

        return load_run
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """The vocabulary, without the rooms and what is imported to fill it."""
    return sorted(__all__)
