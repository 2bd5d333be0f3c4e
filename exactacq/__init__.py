"""exactacq: exact sensor-based terrain acquisition among segments and circular arcs."""

from typing import TYPE_CHECKING, Any

from exactacq.audit import audit
from exactacq.errors import AuditError, ExactacqError, FormatError, InvalidScene, Undecided
from exactacq.lengths import Length
from exactacq.links import visibility_graph
from exactacq.loading import load
from exactacq.points import Point
from exactacq.ports import JSON, SVG, offer
from exactacq.reals import Real
from exactacq.scene import Scene
from exactacq.seed_spreader import seed_spreader
from exactacq.shapes import Circle, Outline, Polygon, Terrain
from exactacq.sightseer import sightseer
from exactacq.sweep import sweep
from exactacq.trace import Run
from exactacq.vision.isovist import Isovist, isovist

offer(SVG, Scene, "exactacq.figures", "svg")
offer(SVG, Run, "exactacq.figures", "svg")
offer(SVG, Isovist, "exactacq.views_svg", "svg")
offer(JSON, Run, "exactacq.run_json", "run_to_json")

if TYPE_CHECKING:
    from exactacq.figures import figure
    from exactacq.run_json import load_run

__all__ = [
    "AuditError",
    "Circle",
    "ExactacqError",
    "FormatError",
    "InvalidScene",
    "Length",
    "Outline",
    "Point",
    "Polygon",
    "Real",
    "Run",
    "Scene",
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
        from exactacq.figures import figure

        return figure
    if name == "load_run":
        from exactacq.run_json import load_run

        return load_run
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
