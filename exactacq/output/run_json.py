"""Runs as JSON, exact and complete: what `load_run` reads is the run again."""

from __future__ import annotations

import json
import os
from collections.abc import Hashable, Iterator, Sequence
from typing import Any

from exactacq.errors import ExactacqError, FormatError
from exactacq.files.scene_json import parse_json, scene_of, scene_to_json
from exactacq.files.source import one_line, read_bytes
from exactacq.files.whole_files import readable
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.number_json import Decoder, Encoder, Number, is_place
from exactacq.numbers.rationals import rational
from exactacq.scene.terrain_components import ground_of
from exactacq.sensing.history import Memory
from exactacq.sensing.path import Event, Path, Piece
from exactacq.sensing.sensor import Kind
from exactacq.strategies.bounds import sightseer_bounds, spreader_bounds
from exactacq.strategies.run import Bound, Diversion, Run, Sweeping, TreeLink

FORMAT, VERSION = "exactacq run", 2
DIGITS = 20
"""Decimals beside exact values are for readers: they are not read back."""
SENSED = {kind.value for kind in Kind}
NAMES = {
    "corner": ("corner",),
    "circle": ("circle",),
    "corners": ("corner", "corner"),
    "corner, circle": ("corner", "circle", "crossing"),
    "circles": ("circle", "circle", "crossing", "turn"),
}
"""What names hold after their first word: numbers of edges, a truth value, 1 or -1."""
CLOSED = 200
"""Closed forms up to so many characters are written beside the decimals."""


def run_to_json(run: Run) -> dict[str, Any]:
    """JSON data of a run: exact numbers (see `exactacq.numbers.number_json`), decimals beside them for
    readers.

    Linear in the path. Raises `FormatError` if the scene's start is irrational.
    """
    out = Encoder()
    positions = Length.running_decimals((piece.length for piece in run.path), DIGITS)
    document: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "strategy": run.strategy,
        "radius": str(run.radius),
        "start": _point(out, run.start),
        "length": _length(run.length),
        "visits": list(run.visits),
        "unseen": list(run.unseen),
        "unvisited": list(run.unvisited),
        "stack_depth": run.stack_depth,
        **({} if run.sweeping is None else {"sweeping": _sweeping(out, run.sweeping)}),
        "bounds": [_bound(bound) for bound in run.bounds],
        "links": [_link(out, link) for link in run.links],
        "path": [_piece(out, piece) for piece in run.path],
        "events": [_event(out, event, positions) for event in run.events],
        "scene": scene_to_json(run.scene),
    }
    document["numbers"] = out.table
    return document


def load_run(source: str | os.PathLike[str] | dict[str, Any]) -> Run:
    """The run in a file that ``explore --trace`` wrote, or in the data of `run_to_json`.

    Lengths are summed and bounds evaluated anew. Raises `FormatError` for anything else, `InvalidScene` if
    the scene breaks the rules. That the run is the one a strategy makes is not checked.
    """
    name = "the data" if isinstance(source, dict) else os.fspath(source)
    try:
        data = json.dumps(source).encode() if isinstance(source, dict) else read_bytes(source)
        document = parse_json(data)
        if not isinstance(document, dict) or document.get("format") != FORMAT:
            raise FormatError("not a run: write one with exactacq explore SCENE --trace F.json")
        if int(document["version"]) != VERSION:
            raise FormatError(f"version {int(document['version'])} of a run is not known here")
        return _run(document)
    except ExactacqError as error:
        raise type(error)(
            [f"{name}: {error}"] if hasattr(error, "violations") else f"{name}: {error}"
        ) from None
    except KeyError as error:
        raise FormatError(f"{name}: the run has no {error}") from None
    except (TypeError, ValueError, AttributeError, ArithmeticError, IndexError) as error:
        raise FormatError(f"{name}: not a run ({one_line(error)})") from None


def _run(document: dict[str, Any]) -> Run:
    numbers = _Points(Decoder(document["numbers"]))
    scene = scene_of(document["scene"])
    edges = [edge for obstacle in scene.obstacles for edge in obstacle.edges]
    path = Path(_read_piece(numbers, piece, edges) for piece in document["path"])
    links = tuple(_read_link(numbers, link) for link in document["links"])
    radius, start = rational(document["radius"]), numbers.point(document["start"])
    if radius <= 0:
        raise FormatError(f"the radius must be positive, not {radius}")
    sweeping = _read_sweeping(numbers, document["sweeping"]) if "sweeping" in document else None
    ground = None if sweeping is None else ground_of(scene)
    memory = None
    if any(event["point"] is None for event in document["events"]):
        memory = Memory.of(scene, radius, start, path, ground)
    events = tuple(_read_events(numbers, document["events"], path, memory))
    visits, unseen, unvisited = (
        tuple(int(k) for k in document[key]) for key in ("visits", "unseen", "unvisited")
    )
    count = len(scene.obstacles if ground is None else ground.components)
    swept = () if sweeping is None else (*sweeping.encounters, *sweeping.again)
    diversions = () if sweeping is None else sweeping.diversions
    if any(not 0 <= d.first <= d.last <= len(path) for d in diversions):
        raise FormatError("a diversion names pieces that the path does not have")
    named = [
        *swept,
        *(d.obstacle for d in diversions),
        *visits,
        *unseen,
        *unvisited,
        *(p.obstacle for p in path),
        *(e.obstacle for e in events),
    ]
    if any(k is not None and not 0 <= k < count for k in named):
        raise FormatError(f"the run names an obstacle that its scene of {count} does not have")
    length = path.length_after(len(path))
    if ground is None or sweeping is None:
        bounds = sightseer_bounds(scene, radius, length, links, visits)
    else:
        bounds = spreader_bounds(ground, radius, sweeping, length)
    return Run(
        scene=scene,
        radius=radius,
        strategy=str(document["strategy"]),
        start=start,
        path=path,
        visits=visits,
        links=links,
        events=events,
        bounds=bounds,
        unseen=unseen,
        unvisited=unvisited,
        stack_depth=int(document["stack_depth"]),
        record=memory,
        sweeping=sweeping,
    )


# -- writing ---------------------------------------------------------------------------------------


def _point(out: Encoder, point: Point) -> list[Number]:
    return [out.number(point.x), out.number(point.y)]


def _length(length: Length) -> dict[str, str]:
    closed = readable(length, CLOSED, DIGITS)
    return {"closed": closed[0], "decimal": length.decimal(DIGITS)}


def _bound(bound: Bound) -> dict[str, Any]:
    value = {"value": _length(bound.value), "holds": bound.holds, "ratio": repr(bound.ratio)}
    return {"name": bound.name, "source": bound.source, **value}


def _link(out: Encoder, link: TreeLink) -> dict[str, Any]:
    return {
        "source": link.source,
        "target": link.target,
        "leave": _point(out, link.leave),
        "hit": _point(out, link.hit),
        "length": out.number(link.length.algebraic),
        "traversals": link.traversals,
    }


def _sweeping(out: Encoder, sweeping: Sweeping) -> dict[str, Any]:
    return {
        "lookahead": sweeping.lookahead,
        "target": sweeping.target,
        "diversions": [
            {
                "obstacle": d.obstacle,
                "leave": _point(out, d.leave),
                "hit": _point(out, d.hit),
                "reason": d.reason,
                "first": d.first,
                "last": d.last,
            }
            for d in sweeping.diversions
        ],
        "encounters": list(sweeping.encounters),
        "again": list(sweeping.again),
        "unreached": list(sweeping.unreached),
    }


def _piece(out: Encoder, piece: Piece) -> dict[str, Any]:
    document: dict[str, Any] = {"kind": piece.kind, "obstacle": piece.obstacle}
    document["start"], document["end"] = _point(out, piece.start), _point(out, piece.end)
    if piece.touches:
        document["touches"] = [list(name) for name in piece.touches]  # type: ignore[call-overload]
    curve = piece.curve
    if isinstance(curve, Arc):
        document["arc"] = {
            "center": _point(out, curve.center),
            "radius_sq": str(curve.radius_sq),
            "ccw": curve.ccw,
            "full": curve.full,
        }
    return document


def _place(out: Encoder, point: Point) -> list[Number] | None:
    """A point, or None for one that has no exact form:

    sensing finds it again (see `exactacq.numbers.function_zeros`).
    """
    try:
        return _point(out, point)
    except FormatError:
        return None


def _event(out: Encoder, event: Event, positions: list[str]) -> dict[str, Any]:
    return {
        "kind": event.kind,
        "obstacle": event.obstacle,
        "note": event.note,
        "point": _place(out, event.point),
        "after": event.after,
        "inside": event.inside,
        "at": event.at.decimal(DIGITS) if event.inside else positions[event.after],
    }


# -- reading ---------------------------------------------------------------------------------------


class _Points:
    """Numbers of a document, and its points: equal pairs of numbers give one shared point."""

    def __init__(self, numbers: Decoder) -> None:
        self.numbers = numbers
        self._points: dict[tuple[bool, str, bool, str], Point] = {}

    def point(self, pair: list[Any]) -> Point:
        """The point of two numbers."""
        x, y = pair
        key = is_place(x), str(x), is_place(y), str(y)
        if key not in self._points:
            self._points[key] = Point(self.numbers.number(x), self.numbers.number(y))
        return self._points[key]


def _read_piece(numbers: _Points, document: dict[str, Any], edges: Sequence[Curve]) -> Piece:
    start, end = numbers.point(document["start"]), numbers.point(document["end"])
    curve: Curve = Segment(start, end)
    if "arc" in document:
        arc = document["arc"]
        center, square = numbers.point(arc["center"]), rational(arc["radius_sq"])
        curve = Arc(start, end, center, square, arc["ccw"] is True, arc["full"] is True)
    is_straight, obstacle = document["kind"] == "straight", _index(document["obstacle"])
    if not is_straight and document["kind"] != "boundary":
        raise FormatError("a piece of the path is straight or boundary")
    if is_straight != (obstacle is None) or (is_straight and isinstance(curve, Arc)):
        raise FormatError("a piece of the path is straight, or on the boundary of an obstacle")
    touches = tuple(_read_name(name, edges) for name in document.get("touches", ()))
    return Piece(document["kind"], obstacle, curve, touches)


def _read_name(name: list[Any], edges: Sequence[Curve]) -> tuple[Hashable, ...]:
    """What a straight piece touches, with numbers as they were written.

    See `exactacq.visibility.line_names`.
    """
    kind, *parts = name
    roles = NAMES.get(str(kind))
    if roles is None or len(parts) != len(roles):
        raise FormatError(f"a piece touches something unknown: {str(name)[:40]}")
    read: list[Hashable] = [str(kind)]
    for role, part in zip(roles, parts, strict=True):
        is_truth = isinstance(part, bool)
        value = part if is_truth else int(part)
        known = abs(value) == 1 if role == "turn" else 0 <= value < len(edges)
        if role == "circle":
            known = known and isinstance(edges[value], Arc)
        if is_truth != (role == "crossing") or not (is_truth or known):
            raise FormatError(f"a piece touches a {role} that the scene does not have: {str(part)[:40]}")
        read.append(value)
    return tuple(read)


def _read_link(numbers: _Points, document: dict[str, Any]) -> TreeLink:
    source = document["source"]
    return TreeLink(
        source="S" if source == "S" else int(source),
        target=int(document["target"]),
        leave=numbers.point(document["leave"]),
        hit=numbers.point(document["hit"]),
        length=Length(numbers.numbers.number(document["length"])),
        traversals=int(document["traversals"]),
    )


def _read_sweeping(numbers: _Points, document: dict[str, Any]) -> Sweeping:
    return Sweeping(
        bool(document["lookahead"]),
        str(document["target"]),
        tuple(
            Diversion(
                int(d["obstacle"]),
                numbers.point(d["leave"]),
                numbers.point(d["hit"]),
                str(d["reason"]),
                int(d["first"]),
                int(d["last"]),
            )
            for d in document["diversions"]
        ),
        tuple(int(k) for k in document["encounters"]),
        tuple(int(k) for k in document["again"]),
        tuple(int(k) for k in document["unreached"]),
    )


def _read_events(
    numbers: _Points, documents: list[dict[str, Any]], path: Path, memory: Memory | None
) -> Iterator[Event]:
    """The events; those without a point happened where the repeated sensing says."""
    reports = iter(memory.reports) if memory else None
    for document in documents:
        kind, obstacle = str(document["kind"]), _index(document["obstacle"])
        place: Point | None = None
        if reports is not None and kind in SENSED:
            report = next(reports, None)
            if report is None or (report.kind.value, report.obstacle) != (kind, obstacle):
                raise FormatError(f"the path does not show the {kind} of obstacle {obstacle} that it names")
            place = report.place
        if document["point"] is not None:
            place = numbers.point(document["point"])
        if place is None:
            raise FormatError(f"an event of kind {kind} has no point")
        yield _read_event(document, place, path)


def _read_event(document: dict[str, Any], place: Point, path: Path) -> Event:
    after, inside = int(document["after"]), document["inside"] is True
    if not 0 <= after <= len(path):
        raise FormatError(f"an event after piece {after} of a path of {len(path)}")
    if inside and after == len(path):
        raise FormatError(f"an event inside piece {after} of a path of {len(path)}")
    obstacle, note = _index(document["obstacle"]), str(document["note"])
    return Event(str(document["kind"]), place, obstacle, note, after, path, inside)


def _index(value: Any) -> int | None:
    return None if value is None else int(value)
