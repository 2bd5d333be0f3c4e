"""Run files: runs as JSON, written and read without a rounding.

A run file is one JSON object with ``"format": "exactacq run"`` and ``"version"``, the number of the
format's version (`VERSION`). Files of versions 2 to 5 are read too (`old_run_files`), others are refused. It
has the scene, the path, visits, links, events and bounds, and one table of all algebraic numbers. Of a
strategy of the user's own it has the name and ``"own": true``, and ``"confined": true`` if its robot was
confined to the terrain. The map is not written: the sensing is repeated on first use.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Iterator
from typing import Any

from flint import arb, fmpq

from exactacq.errors import ExactacqError, FormatError, shown
from exactacq.files.scene_json import parse_json, scene_of, scene_to_json
from exactacq.files.source import one_line, read_bytes
from exactacq.files.whole_files import readable
from exactacq.geometry.curves import Arc, Curve, Segment
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.number_json import Decoder, Encoder, Number, is_place
from exactacq.numbers.rationals import rational
from exactacq.output.old_run_files import OLD_VERSIONS, upgraded
from exactacq.scene.terrain_components import ground_of
from exactacq.scene.validation import LIMIT, LIMIT_TEXT
from exactacq.sensing.decision import Candidate, Decision, Rule
from exactacq.sensing.event import SENSED, Ending, Event, EventKind, Occasion, Reason
from exactacq.sensing.memory import Memory
from exactacq.sensing.path import Path, Piece
from exactacq.sensing.view_length import ViewLength
from exactacq.strategies.bounds import with_bounds
from exactacq.strategies.registry import is_name
from exactacq.strategies.run import Bound, Diversion, OwnRun, Run, SeedSpreaderRun, SightseerRun, TreeLink
from exactacq.visibility.links import START

FORMAT, VERSION = "exactacq run", 6
DIGITS = 20
"""Decimals beside exact values are for readers: they are not read back."""
BEYOND = 4 * LIMIT
"""Farther from the axes there is nothing of a run: see `LIMIT`."""
FACTS = ("occasion", "other", "reason", "ending")
"""Fields of events that are written where they apply."""
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
        "length": length_to_json(run.length),
        "visits": list(run.visits),
        "unseen": list(run.unseen),
        "unvisited": list(run.unvisited),
        "bounds": [bound_to_json(bound) for bound in run.bounds],
        **_of_strategy(out, run),
        "path": [_piece(out, piece) for piece in run.path],
        "events": [_event(out, event, positions) for event in run.events],
        "scene": scene_to_json(run.scene),
    }
    document["numbers"] = out.table
    return document


def is_run_file(path: str | os.PathLike[str]) -> bool:
    """Whether a file is JSON that says that it is a run; False for what cannot be read.

    The text of its ``"format"`` decides: no run is read. Linear in the file.
    """
    if os.path.splitext(path)[1].lower() != ".json":
        return False
    try:
        return re.search(rb'"format"\s*:\s*"exactacq run"', read_bytes(path)) is not None
    except FormatError:
        return False


def load_run(source: str | os.PathLike[str] | dict[str, Any]) -> Run:
    """The run in a file that ``explore --trace`` wrote, or in the data of `Run.to_json`.

    Lengths are summed and bounds evaluated anew: those of a strategy of the user's own if one of its name is
    registered, else it has none. Raises `FormatError` for anything else, also for a run of
    an unknown version of the format, and `InvalidScene` if the scene breaks the rules. Whether a strategy
    would make this run is not checked: see `audit`. Linear in the path.

    >>> import exactacq as xa
    >>> run = xa.sightseer(xa.load("circles"))
    >>> load_run(run.to_json()).length == run.length
    True
    """
    name = "the data" if isinstance(source, dict) else os.fspath(source)
    if name.lstrip().startswith("{"):
        raise FormatError("a text stands for the name of a file: give json.loads of it")
    try:
        data = json.dumps(source).encode() if isinstance(source, dict) else read_bytes(source)
        document = parse_json(data)
        if not isinstance(document, dict) or document.get("format") != FORMAT:
            raise FormatError("not a run: write one with exactacq explore SCENE --trace F.json")
        version = int(document["version"])
        if version not in (*OLD_VERSIONS, VERSION):
            raise FormatError(f"version {shown(document['version'])} of a run is not known here")
        return _run(document if version == VERSION else upgraded(document))
    except ExactacqError as error:
        raise type(error)(
            [f"{name}: {error}"] if hasattr(error, "violations") else f"{name}: {error}"
        ) from None
    except KeyError as error:
        raise FormatError(f"{name}: the run has no {error}") from None
    except (TypeError, ValueError, AttributeError, ArithmeticError, IndexError) as error:
        raise FormatError(f"{name}: not a run ({one_line(error)})") from None


def _run(document: dict[str, Any]) -> Run:
    run = _without_bounds(document)
    return run if run.ending is Ending.UNDECIDED else with_bounds(run)


def _without_bounds(document: dict[str, Any]) -> SightseerRun | SeedSpreaderRun | OwnRun:
    numbers = _Points(Decoder(document["numbers"], ViewLength.of_parts))
    scene = scene_of(document["scene"])
    radius, start = rational(document["radius"]), numbers.point(document["start"])
    if not 1 / LIMIT <= radius <= LIMIT:
        told = shown(document["radius"])
        raise FormatError(f"the radius must be positive, from 1/{LIMIT_TEXT} to {LIMIT_TEXT}, not {told}")
    strategy = document["strategy"]
    is_own = _truth(document.get("own", False)) and is_name(strategy)
    if not is_own and strategy not in (SightseerRun.strategy, SeedSpreaderRun.strategy):
        raise FormatError(f"a run of the unknown strategy {str(strategy)[:40]!r}")
    confined = is_own and _truth(document.get("confined", False))
    ground = ground_of(scene) if confined or strategy == SeedSpreaderRun.strategy else None
    count = len(scene.obstacles if ground is None else ground.components)
    path = Path(_read_piece(numbers, piece, count) for piece in document["path"])
    memory = None
    if any(event["point"] is None for event in document["events"]):
        memory = Memory.of(scene, radius, start, path, ground)
    common: dict[str, Any] = {
        "scene": scene,
        "radius": radius,
        "start": start,
        "path": path,
        "visits": _indices(document["visits"], count),
        "events": tuple(_read_events(numbers, document["events"], path, memory, count)),
        "bounds": (),
        "unseen": _indices(document["unseen"], count),
        "unvisited": _indices(document["unvisited"], count),
        "record": memory,
    }
    if is_own:
        return OwnRun(**common, name=strategy, confined=confined)
    if ground is None:
        links = tuple(_read_link(numbers, link, count) for link in document["links"])
        return SightseerRun(**common, links=links, stack_depth=int(document["stack_depth"]))
    return SeedSpreaderRun(
        **common,
        lookahead=_truth(document["lookahead"]),
        target=str(document["target"]),
        diversions=tuple(_read_diversion(numbers, d, path, count) for d in document["diversions"]),
        encounters=_indices(document["encounters"], count),
        again=_indices(document["again"], count),
        unreached=_indices(document["unreached"], len(scene.obstacles)),
    )


# -- writing ---------------------------------------------------------------------------------------


def _point(out: Encoder, point: Point) -> list[Number]:
    return [out.number(point.x), out.number(point.y)]


def _decimal(point: Point) -> list[float]:
    """The nearest floats, for readers: they are not read back."""
    return list(point.xy)


def length_to_json(length: Length) -> dict[str, str]:
    """A length's closed form, if it is short, and its decimal value."""
    closed = readable(length, CLOSED, DIGITS)
    return {"closed": closed[0], "decimal": length.decimal(DIGITS)}


def bound_to_json(bound: Bound) -> dict[str, Any]:
    """A bound's name, source and value, whether it holds, and whether it speaks of the run."""
    value = {"value": length_to_json(bound.value), "holds": bound.holds, "ratio": repr(bound.ratio)}
    return {"name": bound.name, "source": bound.source, **value, "applies": bound.applies}


def _link(out: Encoder, link: TreeLink) -> dict[str, Any]:
    return {
        "source": link.source,
        "target": link.target,
        "leave": _point(out, link.leave),
        "hit": _point(out, link.hit),
        "leave_decimal": _decimal(link.leave),
        "hit_decimal": _decimal(link.hit),
        "length": out.number(link.length.algebraic),
        "traversals": link.traversals,
    }


def _of_strategy(out: Encoder, run: Run) -> dict[str, Any]:
    if isinstance(run, SightseerRun):
        return {"stack_depth": run.stack_depth, "links": [_link(out, link) for link in run.links]}
    if isinstance(run, OwnRun):
        return {"own": True, "confined": True} if run.confined else {"own": True}
    assert isinstance(run, SeedSpreaderRun)
    return {
        "lookahead": run.lookahead,
        "target": run.target,
        "diversions": [
            {
                "obstacle": d.obstacle,
                "leave": _point(out, d.leave),
                "hit": _point(out, d.hit),
                "leave_decimal": _decimal(d.leave),
                "hit_decimal": _decimal(d.hit),
                "reason": d.reason,
                "first": d.first,
                "last": d.last,
            }
            for d in run.diversions
        ],
        "encounters": list(run.encounters),
        "again": list(run.again),
        "unreached": list(run.unreached),
    }


def _piece(out: Encoder, piece: Piece) -> dict[str, Any]:
    document: dict[str, Any] = {"kind": piece.kind, "obstacle": piece.obstacle}
    document["start"], document["end"] = _point(out, piece.start), _point(out, piece.end)
    document["start_decimal"], document["end_decimal"] = _decimal(piece.start), _decimal(piece.end)
    curve = piece.curve
    if isinstance(curve, Arc):
        document["arc"] = {
            "center": _point(out, curve.center),
            "radius_sq": str(curve.radius_sq),
            "ccw": curve.ccw,
            "full": curve.full,
        }
    return document


def _event(out: Encoder, event: Event, positions: list[str]) -> dict[str, Any]:
    facts = {name: getattr(event, name) for name in FACTS}
    return {
        "kind": event.kind,
        "obstacle": event.obstacle,
        **{name: fact for name, fact in facts.items() if fact is not None},
        "point": _point(out, event.point),
        "point_decimal": _decimal(event.point),
        "after": event.after,
        "inside": event.inside,
        "at": event.at.decimal(DIGITS) if event.inside else positions[event.after],
        **({} if event.decision is None else {"decision": _decision(out, event.decision)}),
    }


def _decision(out: Encoder, decision: Decision) -> dict[str, Any]:
    document: dict[str, Any] = {"rule": decision.rule, "after": decision.after}
    if decision.because:
        document["because"] = decision.because
    return {
        **document,
        "chosen": decision.chosen,
        **_size(out, decision.length),
        "others": [{"obstacle": k, **_size(out, length)} for k, length in decision.others],
        **({"more": decision.more} if decision.more else {}),
    }


def _size(out: Encoder, length: Length | None) -> dict[str, Any]:
    """A length that was compared."""
    if length is None:
        return {}
    return {"length": _exact_length(out, length), "length_decimal": length.decimal(DIGITS)}


def _exact_length(out: Encoder, length: Length) -> Number | dict[str, Any]:
    """A number; for a length with angles what it is made of (see `Length.numbers`)."""
    algebraic, turn, *rest = map(out.number, length.numbers)
    if turn == "0" and not rest:
        return algebraic
    count = len(rest) // 3
    ways = zip(rest[count::2], rest[count + 1 :: 2], strict=True)
    angles = [[factor, *way] for factor, way in zip(rest[:count], ways, strict=True)]
    return {"algebraic": algebraic, "pi": turn, "angles": angles}


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
            point = Point(self.numbers.number(x), self.numbers.number(y))
            # Vertices keep to the limit; arcs between them, and their centres, may lie a little beyond.
            if any(abs(number.ball(64)) > BEYOND for number in (point.x, point.y)):
                raise FormatError(f"a place of the run lies much farther than {LIMIT_TEXT} from the axes")
            self._points[key] = point
        return self._points[key]


def _read_piece(numbers: _Points, document: dict[str, Any], count: int) -> Piece:
    start, end = numbers.point(document["start"]), numbers.point(document["end"])
    curve: Curve = Segment(start, end)
    if "arc" in document:
        arc = document["arc"]
        center, square = numbers.point(arc["center"]), rational(arc["radius_sq"])
        if square <= 0 or not all(_may_lie_on(place, center, square) for place in (start, end)):
            raise FormatError("an arc of the path does not end on its circle")
        curve = Arc(start, end, center, square, _truth(arc["ccw"]), _truth(arc["full"]))
    if (start == end) != (isinstance(curve, Arc) and curve.full):
        raise FormatError("a piece of the path leads from one place to another, or once around a circle")
    is_straight, obstacle = document["kind"] == "straight", document["obstacle"]
    obstacle = None if obstacle is None else _obstacle(obstacle, count)
    if not is_straight and document["kind"] != "boundary":
        raise FormatError("a piece of the path is straight or boundary")
    if is_straight != (obstacle is None) or (is_straight and isinstance(curve, Arc)):
        raise FormatError("a piece of the path is straight, or on the boundary of an obstacle")
    return Piece(document["kind"], obstacle, curve)


def _may_lie_on(place: Point, center: Point, square: fmpq) -> bool:
    """Whether a place lies on a circle: exact for rational ones, else not excluded by balls."""
    if place.rational is not None and center.rational is not None:
        (x, y), (a, b) = place.rational, center.rational
        return bool((x - a) ** 2 + (y - b) ** 2 == square)
    dx, dy = (p.ball(64) - c.ball(64) for p, c in ((place.x, center.x), (place.y, center.y)))
    return bool((dx**2 + dy**2).overlaps(arb(square)))


def _read_link(numbers: _Points, document: dict[str, Any], count: int) -> TreeLink:
    return TreeLink(
        source=_node(document["source"], count),
        target=_obstacle(document["target"], count),
        leave=numbers.point(document["leave"]),
        hit=numbers.point(document["hit"]),
        length=Length(numbers.numbers.number(document["length"])),
        traversals=int(document["traversals"]),
    )


def _read_diversion(numbers: _Points, document: dict[str, Any], path: Path, count: int) -> Diversion:
    first, last = int(document["first"]), int(document["last"])
    if not 0 <= first <= last <= len(path):
        raise FormatError("a diversion names pieces that the path does not have")
    return Diversion(
        _obstacle(document["obstacle"], count),
        numbers.point(document["leave"]),
        numbers.point(document["hit"]),
        Reason(document["reason"]),
        first,
        last,
    )


def _read_events(
    numbers: _Points, documents: list[dict[str, Any]], path: Path, memory: Memory | None, count: int
) -> Iterator[Event]:
    """The events; those of an old file that have no point happened where the repeated sensing says."""
    reports = iter(memory.reports) if memory else None
    for document in documents:
        kind = EventKind(document["kind"])
        obstacle = None if document["obstacle"] is None else _obstacle(document["obstacle"], count)
        place: Point | None = None
        if reports is not None and kind in SENSED:
            report = next(reports, None)
            if report is None or (report.kind, report.obstacle) != (kind, obstacle):
                raise FormatError(f"the path does not show the {kind} of obstacle {obstacle} that it names")
            place = report.place
        if document["point"] is not None:
            place = numbers.point(document["point"])
        if place is None:
            raise FormatError(f"an event of kind {kind} has no point")
        after, inside = int(document["after"]), _truth(document["inside"])
        if not 0 <= after <= len(path) - inside:
            raise FormatError(f"an event after piece {shown(document['after'])} of a path of {len(path)}")
        within = path[after].curve if inside and document["point"] is not None else None
        if isinstance(within, Arc) and not _may_lie_on(place, within.center, within.radius_sq):
            raise FormatError("an event does not lie on the arc of the path that it names")
        other = None if "other" not in document else _node(document["other"], count)
        reason = None if "reason" not in document else Reason(document["reason"])
        ending = None if "ending" not in document else Ending(document["ending"])
        occasion = None if "occasion" not in document else Occasion(document["occasion"])
        decided = None
        if "decision" in document:
            decided = _read_decision(numbers, document["decision"], after, count)
        why: dict[str, Any] = {"occasion": occasion, "other": other, "reason": reason, "ending": ending}
        why["decided"] = decided
        yield Event(kind, place, obstacle, after, path, inside, **why)


def _read_decision(numbers: _Points, document: dict[str, Any], latest: int, count: int) -> Decision:
    after, chosen = int(document["after"]), document["chosen"]
    if not 0 <= after <= latest:
        raise FormatError("a decision is not made before the event that it belongs to")
    because = document.get("because", "")
    if is_place(because):
        raise FormatError("the reason of a decision is a text")
    return Decision(
        because,
        None if chosen is None else _node(chosen, count),
        _read_length(numbers, document.get("length")),
        tuple(
            Candidate(_obstacle(other["obstacle"], count), _read_length(numbers, other.get("length")))
            for other in document["others"]
        ),
        Rule(document["rule"]),
        after,
        int(document.get("more", 0)),
    )


def _read_length(numbers: _Points, value: Any) -> Length | None:
    if value is None:
        return None
    number = numbers.numbers.number
    if not isinstance(value, dict):
        return Length(number(value))
    angles = (Length.arc(*map(number, angle)) for angle in value["angles"])
    turn = Length.turns(number(value["pi"]), "1/2")
    return Length.sum((Length(number(value["algebraic"])), turn, *angles))


def _indices(values: Iterable[Any], count: int) -> tuple[int, ...]:
    return tuple(_obstacle(value, count) for value in values)


def _obstacle(value: Any, count: int) -> int:
    if not 0 <= int(value) < count:
        raise FormatError(f"the run names an obstacle that its scene of {count} does not have")
    return int(value)


def _node(value: Any, count: int) -> int | str:
    return START if value == START else _obstacle(value, count)


def _truth(value: Any) -> bool:
    if not isinstance(value, bool):
        raise FormatError(f"true or false is needed, not {shown(value)}")
    return value
