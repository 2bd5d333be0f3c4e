"""exactacq: exact sensor-based terrain acquisition among segments and circular arcs."""

from exactacq.errors import AuditError, ExactacqError, FormatError, InvalidScene, Undecided
from exactacq.lengths import Length
from exactacq.links import visibility_graph
from exactacq.loading import load
from exactacq.points import Point
from exactacq.reals import Real
from exactacq.scene import Scene
from exactacq.shapes import Circle, Outline, Polygon, Terrain
from exactacq.sightseer import sightseer
from exactacq.trace import Run

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
    "load",
    "sightseer",
    "visibility_graph",
]
