"""One self-contained page that plays a run: the growing map, the view, the path and the events.

The page is HTML with its script, style and data inside: it loads nothing, and its content security policy
allows that one script and that one style only (by their hashes). Whatever a user can write, names above all,
is in a block of JSON and reaches the document as text. Nothing is decided on the page: it shows what exact
frames say (`frames`), and moves the robot between them along the path in floats. Words and colours are those
of figures and tables (`vocabulary`): style and skeleton have none of their own for what is shown.

Lengths and places on the page are in page units, `SIZE` to the longer side of the scene, y downwards, with
`DECIMALS` decimals: the drawing is as sharp for a scene of 10^-50 as for one of 10^50.
"""

from __future__ import annotations

import base64
import hashlib
import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from string import Template
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_hex

from exactacq.files.whole_files import readable
from exactacq.geometry.curves import Curve
from exactacq.geometry.points import Point
from exactacq.geometry.strokes import Stroke
from exactacq.numbers.length import Length
from exactacq.output import vocabulary
from exactacq.output.animation.frames import Frame, stops
from exactacq.output.figures.sweep import SweptTerrain, turning_places, window
from exactacq.output.regions import Region
from exactacq.output.turns import turns
from exactacq.output.vocabulary import SCALE, SCALE_END, SCALE_END_DARK, Labels, Word
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Terrain
from exactacq.strategies.run import Run

SIZE, DECIMALS, COARSE = 1000, 4, 2
"""Page units along the longer side of a scene, and decimals: seven digits of the scene's size; five are
enough for views between stops, of which there are many."""
MARGIN, SLIMMEST = 0.06, 0.3
"""Free border, and the least ratio of the drawing's sides, as parts of the scene's longer side."""
FAR = 10 * SIZE
"""Page units to the right, to the left, up and down that no window shows."""
FLAT = 1e6
"""Page units: browsers lose larger circles, whose arcs in view differ from a line by less than 0.3."""
WIDEST = 2 * math.pi / 3
"""Angle of one arc: by rounding, the centre of a wider one would move much further than its ends."""
CLOSED_FORM = 40
"""Closed forms of at most this many characters are shown, the decimal value of others."""
COLOURS = 64
"""Steps of the colour scale along the path."""
FRAGMENTS = ("stage", "controls", "numbers", "events", "legend")
"""Pieces of HTML that a page which plays runs is made of."""
SCRIPTS = tuple(
    f"player/{name}.js"
    for name in ("dom", "clock", "chart", "journey", "labels", "stage", "legend", "words", "player")
)
"""The modules that play runs on a page, each after those that it imports."""
STYLE = "player/player.css"
"""How these pieces look."""


def page(run: Run, frames: Iterable[Frame], *, labels: Labels | str = Labels.ALL) -> str:
    """The page of one run as HTML text; equal runs and frames give the same text. *labels* are as in figures.

    *frames* (see `frames_of`) run along the path from its start to its end; they are consumed one by one.
    Raises `ValueError` if there are none, `FormatError` for a scene that is 10^-9 times its distance from
    the origin or less.
    """
    return whole_page("one_run", told(run, frames, Labels(labels)))


def whole_page(name: str, data: object) -> str:
    """The page of that skeleton, style and script, with its data and all that plays runs."""
    # In a block of JSON only "<" could end the block or open a comment; the rest is ASCII by `dumps`.
    block = json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")
    base = Template(_text("page.css")).substitute(colours=variables(vocabulary.colours()))
    style = "\n".join((base, _text(STYLE), _text(f"{name}.css")))
    script = bundled({file: _text(file) for file in (*SCRIPTS, f"{name}.js")})
    allowed = f"script-src {_hash(script)}; style-src {_hash(style)}"
    policy = f"default-src 'none'; {allowed}; base-uri 'none'; form-action 'none'"
    body = Template(_text(f"{name}.html")).substitute(fragments()).rstrip()
    return Template(_text("page.html")).substitute(
        policy=policy, style=style, script=script, data=block, body=body
    )


def fragments() -> dict[str, str]:
    """The parts of a page that plays runs, as HTML by what a skeleton calls them."""
    words = {word.name.lower(): str(word) for word in Word}
    return {name: Template(_text(f"player/{name}.html")).substitute(words).rstrip() for name in FRAGMENTS}


def variables(colours: Mapping[str, str]) -> str:
    """Colours by their names in the vocabulary as variables of a style, and how opaque the view is."""
    lines = (f"  --{name.lower().replace('_', '-')}: {value};" for name, value in colours.items())
    return "\n".join((*lines, f"  --shade: {vocabulary.SHADE};"))


def bundled(modules: Mapping[str, str]) -> str:
    """Modules of JavaScript as one script; each comes after those that it imports, which are among them.

    A module is text without a default export or renamed names, and no two have a name in common at their
    outermost level: then what is left of them without imports and exports means the same.
    """
    parts = (_EXPORT.sub("", _IMPORT.sub("", text)).strip() for text in modules.values())
    return '"use strict";\n(() => {\n' + "\n\n".join(parts) + "\n})();"


_IMPORT = re.compile(r"^import [^;]*;\n", re.MULTILINE)
_EXPORT = re.compile(r"^export (?=const |function )", re.MULTILINE)


def _text(name: str) -> str:
    """A file of this folder."""
    return files("exactacq.output.animation").joinpath(name).read_text("utf-8")


def scale(*, dark: bool = False) -> list[str]:
    """The colours along the path, on light or on dark ground."""
    ends = (1 - SCALE_END_DARK, 1.0) if dark else (0.0, SCALE_END)
    return [to_hex(colour) for colour in mpl.colormaps[SCALE](np.linspace(*ends, COLOURS))]


def _hash(text: str) -> str:
    """How a content security policy names the one inline script or style it allows."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def told(run: Run, frames: Iterable[Frame], labels: Labels, paper: Paper | None = None) -> dict[str, Any]:
    """What the scripts show, as JSON data; on a *paper* of the run's own if none is given."""
    sweep, names = SweptTerrain.of(run), list(run.names())
    paper = paper or Paper.of(run.scene, run.start, float(run.radius), sweep is not None, turning_places(run))
    numbers = {id(event): number for number, event in enumerate(run.events, 1)}
    known, shown, events = Changes(paper), [], []
    plans = Plans(run, names)
    coarse = replace(paper, decimals=COARSE)
    acquired: dict[int, int] = {}
    for number, frame in enumerate(frames):
        known.advance(frame.known)
        for index in frame.acquired:
            acquired.setdefault(index, number)
        for event in frame.events:
            what = event.kind, event.obstacle, event.describe(names)
            events.append([numbers[id(event)], *what, number, event.why(names)])
        plans.advance(frame.after)
        shown.append(
            {
                "at": paper.length(float(frame.at)),
                "exact": " ".join(readable(frame.at, CLOSED_FORM, 8)) if frame.events else None,
                "place": paper.point(frame.place.xy),
                "frontier": [paper.point(point.xy) for point in frame.frontier],
                "view": (coarse if frame.is_passing else paper).outline(frame.view),
                "passing": frame.is_passing,
            }
        )
    if not shown:
        raise ValueError("an animation has at least one frame")
    count, terrain = len(stops(run)), run.scene.terrain
    exact = sum(not entry["passing"] for entry in shown)
    return {
        "title": f"{run.title}: {run.scene.name}" if run.scene.name else run.title,
        "length": " ".join(readable(run.length, CLOSED_FORM, 8)),
        "radius": " ".join(readable(Length(run.radius), CLOSED_FORM, 6)),
        "happened": len(run.events),
        "left_out": [exact, count] if exact < count else None,
        "scale": paper.scale,
        "corner": paper.corner,
        "box": paper.box,
        "terrain": None if terrain is None else paper.rectangle(terrain),
        "obstacles": [
            _obstacle(paper, run, number, region, acquired.get(number))
            for number, region in enumerate(_regions(run, sweep))
        ],
        "labels": labels,
        "visits": _visits(paper, run),
        "colours": scale(),
        "away": vocabulary.AWAY,
        **_sweep(paper, sweep),
        "start": paper.point(run.start.xy),
        "path": list(_path(paper, run)),
        "frames": shown,
        "known": known.entries(),
        "events": events,
        "plans": plans.told,
    }


class Plans:
    """What the robot is about to do in each frame, and why: from where it decides that, to the next decision.

    ``told`` has the number of the first frame and the sentence of each; at the end, why the path ends. The
    Seed Spreader turns at the ends of its lines, which is told too, though it decides nothing there.
    """

    def __init__(self, run: Run, names: Sequence[str]) -> None:
        self.told: list[tuple[int, str]] = []
        stop = run.events[-1]
        plans = {event.decision.after: event.why(names) for event in run.events if event.decision}
        for after, words in turns(run):
            plans[after] = "; ".join(filter(None, (words, plans.get(after))))
        plans[stop.after] = stop.describe(names)
        self._ahead = sorted(plans.items(), reverse=True)
        self._frame = 0

    def advance(self, after: int) -> None:
        """The next frame, after so many whole pieces of the path."""
        while self._ahead and self._ahead[-1][0] <= after:
            self.told.append((self._frame, self._ahead.pop()[1]))
        self._frame += 1


def _visits(paper: Paper, run: Run) -> list[list[float]]:
    """The obstacles in the order of their visits, each with the length of the path at which that begins."""
    lengths = Length.running_decimals((piece.length for piece in run.path), 17)
    begins: dict[int, float] = {}
    for piece, before in zip(run.path, lengths[:-1], strict=True):
        if piece.obstacle is not None:
            begins.setdefault(piece.obstacle, paper.length(float(before)))
    return [[index, begins[index]] for index in run.visits]


def _regions(run: Run, sweep: SweptTerrain | None) -> list[Region]:
    """The regions of the run's obstacles."""
    return [Region.of(obstacle) for obstacle in run.scene.obstacles] if sweep is None else sweep.regions


def _obstacle(paper: Paper, run: Run, number: int, region: Region, acquired: int | None) -> dict[str, Any]:
    body, heart, depth = run.obstacles[number], *region.heart()
    (left, _), (right, top) = region.box
    is_wall = run.ground is None and run.scene.obstacles[number].is_enclosure
    # The enclosure blocks what lies beyond its outline, off the paper too: the window may be wider.
    beyond = f"M{-FAR} {-FAR}H{FAR}V{FAR}H{-FAR}Z" if is_wall else ""
    return {
        "name": body.label,
        "outline": paper.loop(region.strokes) + beyond,
        "perimeter": paper.length(float(body.perimeter)),
        "heart": None if is_wall else [*paper.point(heart), paper.length(depth)],
        "above": paper.point((float(left + right) / 2, float(top))),
        "acquired": acquired,
    }


def _sweep(paper: Paper, sweep: SweptTerrain | None) -> dict[str, Any]:
    """The M-line, the obstacles that are partly out of reach, and the diversions as runs of path pieces."""
    if sweep is None:
        return {"mline": "", "beyond": "", "diversions": []}
    beyond = [o for o in sweep.ground.obstacles if not sweep.is_whole(o.index)]
    return {
        "mline": paper.line(sweep.line),
        "beyond": "".join(paper.outline(obstacle.edges) for obstacle in beyond),
        "diversions": [[detour.pieces.start, detour.pieces.stop] for detour in sweep.detours],
    }


def _path(paper: Paper, run: Run) -> Iterator[list[float]]:
    """Each piece as the path length and the place at its end, and radius, angle and turn of an arc."""
    ends = Length.running_decimals((piece.length for piece in run.path), 17)[1:]
    for piece, end in zip(run.path, ends, strict=True):
        stroke = piece.curve.stroke()
        entry = [paper.length(float(end)), *paper.point(stroke.end)]
        radius = paper.length(stroke.radius)
        if stroke.center is not None and radius < FLAT:
            entry += [radius, round(-stroke.angle, 9), round(-stroke.sweep, 9)]
        yield entry


@dataclass(frozen=True)
class Paper:
    """The page's coordinates: where the drawing's upper left corner lies, units to a length, and its size."""

    corner: tuple[float, float]
    scale: float
    box: list[float]
    decimals: int = DECIMALS

    @classmethod
    def of(
        cls, scene: Scene, start: Point, radius: float, swept: bool = False, others: Iterable[Point] = ()
    ) -> Paper:
        """Paper that shows the obstacles, the terrain, the start and others; little beyond it if *swept*."""
        corners = [corner for obstacle in scene.obstacles for corner in Region.of(obstacle).box]
        corners += [np.array(place.xy) for place in (start, *others)]
        low, high = window(scene, corners, radius, swept)
        size = float(np.max(high - low))
        lack = np.maximum(size * SLIMMEST - (high - low), 0) / 2 + size * MARGIN
        low, high = low - lack, high + lack
        scale = SIZE / size
        box = [_rounded(float(side) * scale, DECIMALS) for side in high - low]
        return cls((float(low[0]), float(high[1])), scale, box)

    def point(self, place: tuple[float, float]) -> list[float]:
        """A place on the page."""
        (x, y), (left, top) = place, self.corner
        return [
            _rounded((x - left) * self.scale, self.decimals),
            _rounded((top - y) * self.scale, self.decimals),
        ]

    def length(self, value: float) -> float:
        """A length on the page."""
        return _rounded(value * self.scale, self.decimals)

    def rectangle(self, terrain: Terrain) -> list[float]:
        """Left, top, width and height of a terrain."""
        west, _, _, north = map(float, terrain.limits)
        return [
            *self.point((west, north)),
            self.length(float(terrain.width)),
            self.length(float(terrain.height)),
        ]

    def line(self, curves: Iterable[Curve]) -> str:
        """SVG path data of curves; those that meet are drawn in one go."""
        return self._chain(curve.stroke() for curve in curves)

    def _chain(self, strokes: Iterable[Stroke]) -> str:
        data, last = "", ""
        for stroke in strokes:
            start, end = (" ".join(map(str, self.point(p))) for p in (stroke.start, stroke.end))
            if start != last:
                data += f"M{start}"
            data, last = data + self._onward(stroke, end), end
        return data

    def outline(self, curves: Iterable[Curve]) -> str:
        """SVG path data of a closed loop; empty if there are no curves."""
        return self.loop(curve.stroke() for curve in curves)

    def loop(self, strokes: Iterable[Stroke]) -> str:
        """SVG path data of a closed loop of strokes; empty if there are none."""
        data = self._chain(strokes)
        return data and data + "Z"

    def _onward(self, stroke: Stroke, end: str) -> str:
        """From the stroke's start to its end; in arcs of at most `WIDEST`."""
        radius = self.length(stroke.radius)
        if stroke.center is None or radius >= FLAT:
            return f"L{end}"
        count = stroke.steps(WIDEST)
        places = [" ".join(map(str, self.point(stroke.at(k / count)))) for k in range(1, count)]
        return "".join(f"A{radius} {radius} 0 0 {int(stroke.sweep < 0)} {place}" for place in (*places, end))


def _rounded(value: float, decimals: int) -> float:
    """To so many decimals; whole numbers as integers, which are shorter in JSON."""
    rounded = round(value, decimals)
    return int(rounded) if rounded == int(rounded) else rounded


class Changes:
    """The known stretches of all frames, each once, where one that is drawn the same is the same."""

    def __init__(self, paper: Paper) -> None:
        self._paper, self._frame = paper, 0
        self._now: dict[int, Strokes] = {}
        self._all: list[list[Any]] = []

    def advance(self, known: Mapping[int, Sequence[Curve]]) -> None:
        """The next frame."""
        unknown = Strokes([], {}, {})
        for obstacle in sorted(self._now.keys() | known.keys()):
            before, curves = self._now.get(obstacle, unknown), known.get(obstacle, ())
            if curves is not before.curves:
                self._now[obstacle] = self._changed(obstacle, before, curves)
        self._frame += 1

    def _changed(self, obstacle: int, before: Strokes, curves: Sequence[Curve]) -> Strokes:
        """The stretches of one obstacle in this frame; those that end are closed."""
        now = Strokes(curves, {}, {})
        for curve in curves:
            # Most stretches run between the very points of the frame before, which is kept till then.
            ends = id(curve.start), id(curve.end)
            data = before.drawn.get(ends) or self._paper.line([curve])
            now.drawn[ends] = data
            entry = now.entries.get(data) or before.entries.get(data)
            if entry is None:
                entry = [obstacle, self._frame, None, self._paper.length(float(curve.length)), data]
                self._all.append(entry)
            now.entries[data] = entry
        for data in before.entries.keys() - now.entries.keys():
            before.entries[data][2] = self._frame
        return now

    def entries(self) -> list[list[Any]]:
        """Obstacle, first frame, frame after the last (None if there is none), length and drawing of each."""
        return self._all


class Strokes(NamedTuple):
    """What is known of one obstacle: curves, drawings by the identity of the ends, entries by drawing."""

    curves: Sequence[Curve]
    drawn: dict[tuple[int, int], str]
    entries: dict[str, list[Any]]
