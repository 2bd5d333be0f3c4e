"""The words and colours of figures, tables, pages and films: one of each for a thing, whoever shows it.

Words are those of the paper where it has some (docs/glossary.md explains them). What happens on a path has
its words with the events (`exactacq.sensing.event`), and why the robot goes on with the decisions
(`exactacq.sensing.decision`). Obstacles have their labels (``Run.names``): their names, or "O" and their
number from 1 in the order of the scene. "#1", "#2", ... is the order of visits.
"""

from __future__ import annotations

from enum import StrEnum
from typing import NoReturn

from exactacq.errors import FormatError, shown

INK, SOFT, PAPER, GROUND, LINE = "#22262b", "#5f656c", "#ffffff", "#fdfdfc", "#c9ccd0"
"""Text and marks; text beside; what is behind everything, and behind a drawing; thin lines of a page."""
FILL, EDGE, FAINT, PARTIAL = "#dcd7cd", "#8a8377", "#f3f0ea", "#e9e5dc"
"""An obstacle and its outline; one of which nothing, and one of which a part is known yet."""
MISSED, MISSED_FILL = "#b3502e", "#f4e3dc"
"""What a run has missed."""
VIEW, HIT, TREE, AWAY, AWAY_AGAIN = "#3b7dd8", "#d6273d", "#f6b64b", "#e8590c", "#ffc9a3"
"""View, range and robot; hit points and frontier; links; diversions, and what of them is walked again."""
SHADE = 0.16
"""How opaque the view is."""
SCALE, SCALE_END, SCALE_END_DARK = "viridis", 0.94, 0.7
"""Matplotlib's scale of colours along the path, up to this share: the last of it is too pale on paper. On
dark ground the first of it is too dark, and this share is left from the other end."""
DARK = {
    "INK": "#e8eaed", "SOFT": "#a3a9b1", "PAPER": "#16181b", "GROUND": "#1c1f23", "LINE": "#3a3f46",
    "FILL": "#4a463e", "EDGE": "#8f887b", "FAINT": "#26272a", "PARTIAL": "#35332f",
    "MISSED": "#e08a68", "MISSED_FILL": "#43302a", "VIEW": "#6ba4f5", "HIT": "#ff6b78", "TREE": "#f6b64b",
    "AWAY": "#ff8a4c", "AWAY_AGAIN": "#8a5334",
}  # fmt: skip
"""The colours on dark ground, by the names of those on light ground."""


class Word(StrEnum):
    """What things are called in legends, titles, columns and captions."""

    START = "start S"
    END = "end T"
    STOP = "stop"
    ROBOT = "robot"
    RADIUS = "R"
    LENGTH = "length"
    WHY = "why"
    """For what reason the robot goes on as it does."""
    PATH = "path"
    AGAIN = "walked again"
    VIEW = "view"
    KNOWN = "known boundary"
    UNKNOWN = "unknown boundary"
    FRONTIER = "frontier"
    OBSTACLE = "obstacle"
    ACQUIRED = "acquired"
    VISITED = "visited"
    VISIT = "visit"
    ORDER = "order of visits"
    UNVISITED = "seen, never visited"
    INCOMPLETE = "incomplete"
    UNSEEN = "never seen"
    UNREACHABLE = "unreachable"
    LINK = "link"
    HIT = "hit point"
    LEAVE = "leave point"
    M_LINE = "M-line"
    CROSSING = "crossing point"
    DIVERSION = "diversion"
    D = "D"
    Q = "Q"
    SEEING = "seeing bound"
    CIRCLING = "circling bound"
    UNAPPLIED = "does not apply"
    """Of a bound that does not speak of a run."""


class Labels(StrEnum):
    """Which labels a picture has. Obstacles of a scene alone have names only."""

    NONE = "none"
    """No text in the drawing."""
    NUMBERS = "numbers"
    """The order of visits, and the points that the paper names: S, T, D and Q."""
    NAMES = "names"
    """The obstacles' names, and these points."""
    ALL = "all"
    """Names, order of visits, and these points."""

    @classmethod
    def _missing_(cls, value: object) -> NoReturn:
        raise FormatError(f"labels: {', '.join(cls)}, not {shown(value)}")


def colours(*, dark: bool = False) -> dict[str, str]:
    """All colours by their names, on light or on dark ground."""
    light = {name: value for name, value in globals().items() if str(value).startswith("#")}
    return {name: DARK[name] for name in light} if dark else light


def rgb(colour: str) -> tuple[int, int, int]:
    """Red, green and blue of a colour, from 0 to 255."""
    red, green, blue = bytes.fromhex(colour[1:])
    return red, green, blue


def ordinal(order: int) -> str:
    """The sign of a visit, counted from 1."""
    return f"#{order}"


def missed_word(is_map_enough: bool) -> Word:
    """What ``Run.unvisited`` obstacles are called: only the Sightseer must visit what it acquires."""
    return Word.INCOMPLETE if is_map_enough else Word.UNVISITED
