"""Reports as JSON data, for programs: what `exactacq.output.report` says in tables.

Numbers are exact where they are short: rationals as text "p/q", lengths with their closed form and a decimal.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from exactacq.geometry.curves import Arc
from exactacq.numbers.length import Length
from exactacq.output.run_json import bound_to_json, length_to_json
from exactacq.scene.scene import Scene
from exactacq.strategies.run import Run, SeedSpreaderRun


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
        "start": None if start is None else [str(start.x), str(start.y)],
        "radius": None if scene.radius is None else str(scene.radius),
        "terrain": None if terrain is None else {"width": str(terrain.width), "height": str(terrain.height)},
        "notes": list(scene.notes),
    }


def comparison_data(first: Run, second: Run) -> dict[str, Any]:
    """Two runs on one scene; ``ratio`` is the second's length over the first's, None if that is 0."""
    ratio = float(second.length) / float(first.length) if first.length.sign() else None
    return {"scene": first.scene.name, "runs": [_run(first), _run(second)], "ratio": ratio}


def gallery_data(scenes: Mapping[str, str]) -> list[dict[str, str]]:
    """The gallery's names, and what they show."""
    return [{"name": name, "shows": line} for name, line in scenes.items()]


def _run(run: Run) -> dict[str, Any]:
    return {
        "strategy": run.strategy,
        "start": [str(run.start.x), str(run.start.y)],
        "radius": str(run.radius),
        "length": length_to_json(run.length),
        "obstacles": len(run.obstacles),
        "visits": list(run.visits),
        "acquired": list(run.map.acquired),
        "unseen": list(run.unseen),
        "unvisited": list(run.unvisited),
        "diversions": len(run.diversions) if isinstance(run, SeedSpreaderRun) else None,
        "bounds": [bound_to_json(bound) for bound in run.bounds],
    }
