"""Scenes, runs, paths, maps, views and links as sheets of exact curves, which each format writes.

The kinds of things, which are layers or groups in a file, have one name everywhere: obstacles, enclosure,
terrain, start; path, links or diversions, events; known and frontier of a map; view, rays and viewpoint.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator

from exactacq.errors import FormatError, shown
from exactacq.files.scene_json import whole_text
from exactacq.files.writing.sheet import TERRAIN, Item, Property, Sheet
from exactacq.geometry.curves import Segment
from exactacq.numbers.length import Length
from exactacq.output.snapshot import Snapshot
from exactacq.scene.scene import Obstacle, Scene
from exactacq.scene.shapes import Polygon, Shape, shape_edges
from exactacq.sensing.event import Event
from exactacq.sensing.map import Map
from exactacq.sensing.path import Path, Piece
from exactacq.strategies.run import Diversion, Run, SeedSpreaderRun, SightseerRun, TreeLink
from exactacq.visibility.isovist import Isovist
from exactacq.visibility.shortest_path import ShortestPath


def sheet_of(subject: object, at: Event | Length | object = None) -> Sheet:
    """The sheet of a scene, a run, a path or shortest path, a map, a view, or a list of links or diversions.

    That of a run shows it at the end, or with *at* at a moment: an event or a length of the path. Raises
    `FormatError` for anything else, ValueError for a length that the path does not have. Linear in what it
    shows.
    """
    if isinstance(subject, Run):
        return _run_sheet(subject, at)
    if at is not None:
        raise FormatError("at: only a run has moments; take the map or the path of one")
    if isinstance(subject, Scene):
        return Sheet(subject.name or "scene", tuple(_scene(subject)), lambda: whole_text(subject))
    if isinstance(subject, Path):
        return Sheet("path", tuple(_path(subject)))
    if isinstance(subject, Map):
        return Sheet("map", tuple(_map(subject)))
    if isinstance(subject, Isovist):
        return Sheet("isovist", tuple(_view(subject)))
    if isinstance(subject, ShortestPath):
        return Sheet("shortest path", tuple(_shortest(subject)))
    return Sheet("links", tuple(_links(_listed(subject))))


def _listed(subject: object) -> list[TreeLink | Diversion]:
    links = list(subject) if isinstance(subject, Iterable) and not isinstance(subject, str) else None
    if links is None or not all(isinstance(link, TreeLink | Diversion) for link in links):
        raise FormatError(f"a scene, run, path, map, isovist or its links are written, not {shown(subject)}")
    return links


def _run_sheet(run: Run, at: Event | Length | object) -> Sheet:
    title = f"{run.title}: {run.scene.name}" if run.scene.name else run.title
    scene = [item for item in _scene(run.scene) if item.layer != "start"]
    start = Item("start", place=run.start, properties={"kind": "start"})
    if at is None:
        drawn = [*_map(run.map), *_links(_links_of(run)), *_path(run.path), *_events(run)]
        return Sheet(title, (*scene, start, *drawn), lambda: _run_text(run))
    moment = Snapshot.of(run, at)
    robot = Item("robot", place=moment.place, properties={"at": float(moment.at)})
    drawn = [*_map(moment.map), *_view(moment.view), *_path(moment.walked), robot]
    return Sheet(title, (*scene, start, *(item for item in drawn if item.layer != "viewpoint")))


def _links_of(run: Run) -> Iterable[TreeLink | Diversion]:
    if not isinstance(run, SightseerRun | SeedSpreaderRun):
        return ()
    return run.links


def _run_text(run: Run) -> str:
    return json.dumps(run.to_json(), indent=1, ensure_ascii=False) + "\n"


def _scene(scene: Scene) -> Iterator[Item]:
    """The boundaries as they were given; the kinds in the properties are those of `__geo_interface__`."""
    for obstacle in scene.obstacles:
        yield _obstacle(obstacle)
    if scene.terrain is not None:
        border = Polygon(scene.terrain.corners)
        yield Item(TERRAIN, shape_edges(border), closed=True, properties={"kind": "terrain"})
    if scene.start is not None:
        yield Item("start", place=scene.start, properties={"kind": "start"})


def _obstacle(obstacle: Obstacle) -> Item:
    kind = "enclosure" if obstacle.is_enclosure else "obstacle"
    shape: Shape = obstacle.shape
    told: dict[str, Property] = {"kind": kind, "index": obstacle.index, "name": obstacle.label}
    layer = kind if obstacle.is_enclosure else "obstacles"
    return Item(layer, shape_edges(shape), closed=True, properties=told)


def _path(pieces: Iterable[Piece]) -> Iterator[Item]:
    """The path as one chain; a point if the robot never leaves its start, nothing without pieces."""
    walked = list(pieces)
    curves = tuple(piece.curve for piece in walked)
    length = Length.sum(piece.length for piece in walked)
    if walked and length.sign() == 0:
        yield Item("path", place=walked[0].start, properties={"length": 0.0})
    elif walked:
        yield Item("path", curves, properties={"length": float(length)})


def _shortest(found: ShortestPath) -> Iterator[Item]:
    told: dict[str, Property] = {"length": float(found.length)}
    if found.path:
        yield Item("path", found.path, properties=told)
    else:
        yield Item("path", place=found.start, properties=told)


def _map(known: Map) -> Iterator[Item]:
    """What is known of each boundary: all of it if the obstacle is acquired, else part by part."""
    for i in known.seen:
        body = known.obstacles[i]
        told: dict[str, Property] = {"obstacle": i, "name": body.label, "acquired": i in known.acquired}
        if told["acquired"]:
            yield Item("known", tuple(body.edges), closed=body.closed, properties=told)
            continue
        for part in known.known(i):
            own: dict[str, Property] = {**told, "edge": part.edge}
            if part.curve is None:
                yield Item("known", place=part.start, properties=own)
            else:
                yield Item("known", (part.curve,), properties=own)
    for i, point in known.frontier:
        yield Item("frontier", place=point, properties={"obstacle": i, "name": known.obstacles[i].label})


def _view(view: Isovist) -> Iterator[Item]:
    told = {"radius": str(view.radius)}
    if view.pieces:
        yield Item("view", tuple(piece.curve for piece in view.pieces), closed=True, properties=told)
    for ray in view.rays:
        yield Item("rays", (ray,))
    yield Item("viewpoint", place=view.point, properties=told)


def _links(links: Iterable[TreeLink | Diversion]) -> Iterator[Item]:
    for number, link in enumerate(links, 1):
        told: dict[str, Property] = {"number": number, "length": float(link.length)}
        layer = "diversions"
        if isinstance(link, TreeLink):
            layer, told = "links", {**told, "source": str(link.source), "target": link.target}
        else:
            told = {**told, "obstacle": link.obstacle, "reason": str(link.reason)}
        if link.length.sign() == 0:
            yield Item(layer, place=link.leave, properties=told)
        else:
            yield Item(layer, (Segment(link.leave, link.hit),), properties=told)


def _events(run: Run) -> Iterator[Item]:
    names = list(run.names())
    for number, event in enumerate(run.events, 1):
        told: dict[str, Property] = {
            "number": number,
            "kind": str(event.kind),
            "obstacle": event.obstacle,
            "name": None if event.obstacle is None else names[event.obstacle],
            "at": float(event.at),
            "note": event.describe(names),
            "why": event.why(names),
        }
        yield Item("events", place=event.point, properties=told)
