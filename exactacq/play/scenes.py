"""Scenes as the page holds them: documents whose numbers are texts, and what is wrong with them.

A document is that of a scene file (`exactacq.files.scene_json`), but every number is a text, as "21/2" or
"0.1": the page's own numbers are floats. It need not make a legal scene: it is what someone draws.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any

from exactacq.errors import FormatError, InvalidScene
from exactacq.files.checking.inspection import inspect
from exactacq.files.gallery import is_swept
from exactacq.files.loops.contents import Contents
from exactacq.files.scene_json import contents_of, parse_json, scene_text
from exactacq.files.sources import NamedSource
from exactacq.numbers.rationals import plain
from exactacq.scene.bounding import at_corner
from exactacq.scene.scene import Obstacle, Scene, radius_of, start_of
from exactacq.scene.terrain_components import ground_of
from exactacq.scene.validation import LISTED, violations
from exactacq.strategies.options import Baseline, Strategy, TargetChoice

SETTINGS = ("scene", "strategy", "lookahead", "target")
"""What a request about a drawing may hold."""
STRATEGIES: tuple[Strategy | Baseline, ...] = (*Strategy, *Baseline)
"""How a drawing may be explored: by any strategy that comes with the library."""


@dataclass(frozen=True, slots=True)
class Request:
    """A drawing, and how it is to be explored."""

    contents: Contents
    strategy: Strategy | Baseline = Strategy.SIGHTSEER
    lookahead: bool = True
    target: TargetChoice = TargetChoice.KNOWN

    @classmethod
    def of(cls, body: bytes) -> Request:
        """The request in a body of JSON; `FormatError` for what is none. Linear in the body."""
        told = parse_json(body)
        if not isinstance(told, dict) or "scene" not in told:
            raise FormatError("a request is an object with a scene")
        for key in told:
            if key not in SETTINGS:
                raise FormatError(f"unknown key {key[:40]!r}; known are {', '.join(SETTINGS)}")
        name = told.get("strategy", Strategy.SIGHTSEER)
        strategy = next((known for known in STRATEGIES if known == name), None)
        if strategy is None:
            raise FormatError(f"strategy: one of {', '.join(STRATEGIES)}")
        lookahead = told.get("lookahead", True)
        if not isinstance(lookahead, bool):
            raise FormatError("lookahead: true or false")
        target = TargetChoice(told.get("target", TargetChoice.KNOWN))
        return cls(contents_of(told["scene"]), strategy, lookahead, target)

    def scene(self) -> Scene:
        """The scene to be explored; `InvalidScene` with all rules that are broken."""
        scene = self.contents.scene(advise=False)
        return at_corner(scene) if self.strategy is Strategy.SEED_SPREADER else scene


def text_of(contents: Contents) -> str:
    """A scene file of what may be no legal scene."""
    obstacles, wall, notes = contents.arranged()
    parts = contents.radius, contents.terrain, contents.name, wall, tuple(notes)
    return scene_text(obstacles, contents.start, *parts)


def document(text: str) -> Any:
    """The document of a scene file."""
    return parse_json(text.encode("utf-8", "replace"))


def flaws(request: Request) -> list[dict[str, Any]]:
    """What is wrong with a drawing: texts, with the loops and the places concerned; at most `LISTED`.

    Loops have their numbers in the order of the drawing; the wall's is -1. Near linear in the edges.
    """
    contents = request.contents
    loops = [Obstacle.of(k, shape) for k, shape in enumerate(contents.loops)]
    if contents.wall is not None:
        loops.append(Obstacle.of(len(loops), contents.wall, is_enclosure=True))
    # The Seed Spreader's start is a corner of its terrain, whatever the drawing says.
    swept = request.strategy is Strategy.SEED_SPREADER
    start = None if contents.start is None or swept else start_of(Scene(), contents.start)
    found = violations(loops, start, contents.radius, contents.terrain)
    told = [
        {
            "text": violation.text,
            "loops": [-1 if loops[k].is_enclosure else k for k in violation.loops],
            "places": [place.xy for place in violation.places if all(map(isfinite, place.xy))],
        }
        for violation in found
    ]
    return _listed(told or list(_lacks(request)))


def _listed(told: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """At most `LISTED` flaws, and how many more there are."""
    left = len(told) - LISTED
    return told if left <= 0 else [*told[:LISTED], _flaw(f"and {left} more")]


def _flaw(text: str, *loops: int) -> dict[str, Any]:
    return {"text": text, "loops": list(loops), "places": []}


def _lacks(request: Request) -> Iterator[dict[str, Any]]:
    """What is wrong with a legal scene for its strategy."""
    try:
        scene = request.scene()
        place = scene.start
        if request.strategy is not Strategy.SEED_SPREADER:
            place = start_of(scene)
            for k in scene.meets_border():
                label = scene.obstacles[k].label
                yield _flaw(
                    f"obstacle {label} meets the terrain's border: only the Seed Spreader takes it", k
                )
        elif scene.enclosure is None or scene.terrain is not None:
            ground_of(scene)
        radius_of(scene, None, place)
    except InvalidScene as error:
        yield from map(_flaw, error.violations)


def opened(
    name: str, start: Sequence[object] | None = None, options: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """What a file or a gallery scene holds, as the page opens it.

    Without a start a drawing is read as `exactacq.inspect` proposes it: with a start, a radius and options
    that make a scene of it, where these are found. Otherwise all its loops are obstacles. Raises
    `FormatError` for a file that cannot be read, or holds no closed loop.
    """
    source, options = NamedSource(name), options or {}
    contents = source.contents(start, options)
    told: dict[str, Any] = {"options": {}, "trouble": ""}
    with source.named():
        if start is None and contents.start is None and contents.startless:
            text = _proposed(name, contents, options, told)
        elif contents.lacking:
            raise FormatError(contents.lacking)
        else:
            text = text_of(contents)
    told["scene"] = document(text)
    told["strategy"] = (
        Strategy.SEED_SPREADER if source.format is None and is_swept(name) else Strategy.SIGHTSEER
    )
    return told


def _proposed(name: str, contents: Contents, options: Mapping[str, Any], told: dict[str, Any]) -> str:
    """The text of a drawing with a start and a radius that fit it; which options it was read with is told."""
    found = inspect(name, **options)
    if found.scene is None:
        if not contents.loops:
            raise FormatError(contents.lacking or "there is no closed loop in it")
        told["trouble"] = found.trouble
        return scene_text(contents.loops, None, contents.radius, contents.terrain, contents.name)
    scene = found.scene.replace(radius=found.radius)
    told["options"] = {
        name: _plain(value) for name, value in (found.options or {}).items() if value not in (None, False)
    }
    place = scene.start.rational if scene.start is not None else None
    return scene_text(
        scene.shapes, place, scene.radius, scene.terrain, scene.name, scene.enclosure, scene.notes
    )


def _plain(value: object) -> Any:
    """The value of an option as JSON."""
    if isinstance(value, bool | str):
        return value
    return list(value) if isinstance(value, list | tuple) else plain(value)


def dumped(value: object) -> bytes:
    """JSON as it is sent."""
    return json.dumps(value, separators=(",", ":"), allow_nan=False).encode()
