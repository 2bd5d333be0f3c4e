"""Reports as JSON data, for programs: what `exactacq.output.report` says in tables.

Rationals are exact texts: decimals where these are finite, as "130.1", else "p/q". Lengths have a closed
form, if it is short, and a decimal.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from exactacq.geometry.curves import Arc
from exactacq.geometry.points import Point
from exactacq.numbers.length import Length
from exactacq.numbers.rationals import plain
from exactacq.output.run_json import bound_to_json, length_to_json
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Terrain
from exactacq.strategies.run import Run, SeedSpreaderRun
from exactacq.strategies.standing import LowerBound, standing


def text_of(data: object) -> str:
    """JSON data as it is printed."""
    return json.dumps(data, indent=1, ensure_ascii=False) + "\n"


def scene_data(scene: Scene) -> dict[str, Any]:
    """What a valid scene holds. Linear in its edges."""
    edges = [edge for obstacle in scene.obstacles for edge in obstacle.edges]
    arcs = sum(isinstance(edge, Arc) for edge in edges)
    start, terrain = scene.start, scene.terrain
    return {
        "name": scene.name,
        "ok": True,
        "obstacles": len(scene.shapes),
        "enclosure": scene.enclosure is not None,
        "segments": len(edges) - arcs,
        "arcs": arcs,
        "perimeters": length_to_json(Length.sum(obstacle.perimeter for obstacle in scene.obstacles)),
        "start": None if start is None else _place(start),
        "radius": None if scene.radius is None else plain(scene.radius),
        "terrain": None if terrain is None else _terrain(terrain),
        "notes": list(scene.notes),
    }


def comparison_data(runs: Sequence[Run], refusals: Sequence[str] = ()) -> dict[str, Any]:
    """Runs on one scene, and why strategies refused it.

    ``lower_bounds`` are those of any path, ``unknown`` is the length of boundary that a run has not seen.
    ``ratio`` is the second one's length over the first one's, None if that is 0 or if there is only one.
    """
    lengths = [float(run.length) for run in runs]
    ratio = lengths[1] / lengths[0] if len(runs) == 2 and lengths[0] else None
    return {
        "scene": runs[0].scene.name,
        "runs": [_run(run) for run in runs],
        "refused": list(refusals),
        "ratio": ratio,
    }


def gallery_data(scenes: Mapping[str, str]) -> list[dict[str, str]]:
    """The gallery's names, and what they show."""
    return [{"name": name, "shows": line} for name, line in scenes.items()]


def _terrain(terrain: Terrain) -> dict[str, Any]:
    sides = {"width": plain(terrain.width), "height": plain(terrain.height)}
    return {**sides, "origin": [plain(number) for number in terrain.origin]}


def _place(point: Point) -> list[str]:
    numbers = (point.x, point.y)
    return [str(number) if number.rational is None else plain(number.rational) for number in numbers]


def _least(bound: LowerBound) -> dict[str, Any]:
    ratio = bound.ratio if bound.value.sign() else None
    return {"value": length_to_json(bound.value), "ratio": ratio, "applies": bound.applies}


def _run(run: Run) -> dict[str, Any]:
    beside = standing(run)
    return {
        "strategy": run.strategy,
        "start": _place(run.start),
        "radius": plain(run.radius),
        "length": length_to_json(run.length),
        "obstacles": len(run.obstacles),
        "visits": list(run.visits),
        "acquired": list(run.map.acquired),
        "unseen": list(run.unseen),
        "unvisited": list(run.unvisited),
        "unreachable": [] if run.ground is None else [part.label for part in run.ground.unreached],
        "unknown": length_to_json(beside.unknown),
        "boundary": length_to_json(beside.boundary),
        "lower_bounds": {"seeing": _least(beside.seeing), "circling": _least(beside.circling)},
        "diversions": len(run.diversions) if isinstance(run, SeedSpreaderRun) else None,
        "bounds": [bound_to_json(bound) for bound in run.bounds],
    }
