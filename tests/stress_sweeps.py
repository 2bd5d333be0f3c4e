"""The edges in sight along pieces of paths, as `sweep` tells in every cell, beside isovists.

``python tests/stress_sweeps.py KIND FIRST COUNT`` sweeps all pieces of the runs on COUNT random scenes of
campaigns, from the seed FIRST on; KIND is `sightseer` or `seed-spreader`. With the KIND `drawings` it takes
COUNT of the drawings of the tests, from number FIRST on, and in each of them 12 edges at random and a
straight way from each. It prints a line for each piece that differs or ends in an error, and one with counts.
A hundred random scenes take half a minute.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from random import Random

from flint import fmpq
from swept_edges import check_edges

import exactacq as xa
from exactacq.geometry.curves import Segment
from exactacq.sensing.path import Piece
from exactacq.study.claims.model import Subject
from exactacq.study.random_scenes import random_scene

DATA = Path(__file__).parent / "data"
DRAWN = {".dxf", ".svg", ".json", ".geojson", ".wkt", ".pgm", ".map", ".kicad_pcb"}
DRAWINGS = sorted(path for path in DATA.rglob("*") if path.suffix in DRAWN)
EDGES = 12
LONGEST = 300
"""So much of an error is printed."""
MOST = 1500
"""Drawings with more edges are left out."""


def of_run(kind: str, seed: int) -> Iterator[tuple[xa.Scene, object, Piece]]:
    """The pieces of a run on a random scene."""
    run = (xa.sightseer if kind == "sightseer" else xa.seed_spreader)(random_scene(Subject(kind), seed))
    for piece in run.path:
        owner = piece.obstacle
        if owner is not None and run.ground is not None:
            owner = run.ground.components[owner].obstacle.index
        yield run.scene, run.radius, Piece(piece.kind, owner, piece.curve)


def of_drawing(number: int) -> Iterator[tuple[xa.Scene, object, Piece]]:
    """Some edges of a drawing, and a straight way from each to a place that is seen from it."""
    found = xa.inspect(DRAWINGS[number])
    scene, rng = found.scene, Random(number)
    if scene is None or found.radius is None or sum(len(o.edges) for o in scene.obstacles) > MOST:
        return
    for _ in range(EDGES):
        obstacle = rng.choice(scene.obstacles)
        edge = rng.choice(obstacle.edges)
        yield scene, found.radius, Piece("boundary", obstacle.index, edge)
        begin = edge.point(fmpq(3, 8))
        spans = xa.isovist(scene, begin, found.radius).seen().items()
        ends = [
            end
            for (k, e), parts in spans
            if scene.obstacles[k].edges[e] is not edge
            for part in parts
            for end in part
            if end.rational is not None and end != begin
        ]
        if begin.rational is not None and ends:
            yield scene, found.radius, Piece("straight", None, Segment(begin, rng.choice(ends)))


def pieces_of(kind: str, first: int, count: int) -> Iterator[tuple[xa.Scene, object, Piece]]:
    """The pieces of all scenes of a kind, with scenes and radii; a scene that is refused has none."""
    numbers = range(first, first + count)
    for number in numbers if kind != "drawings" else numbers[: max(len(DRAWINGS) - first, 0)]:
        try:
            yield from of_drawing(number) if kind == "drawings" else of_run(kind, number)
        except xa.ExactacqError as error:
            print(f"{kind}:{number} {type(error).__name__}: {error}", flush=True)


def main(arguments: list[str] | None = None) -> int:
    """Compare, and tell what differs."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("kind", choices=("sightseer", "seed-spreader", "drawings"))
    parser.add_argument("first", type=int)
    parser.add_argument("count", type=int)
    asked = parser.parse_args(arguments)
    begin, pieces, cells, events, wrong = time.process_time(), 0, 0, 0, 0
    for scene, radius, piece in pieces_of(asked.kind, asked.first, asked.count):
        pieces += 1
        try:
            swept = xa.sweep(scene, piece.curve, radius, obstacle=piece.obstacle)
            cells += check_edges(scene, radius, swept)
            events += len(swept.events)
        except (AssertionError, xa.ExactacqError) as error:
            wrong += 1
            where = f"{piece.kind} {piece.obstacle} {piece.start.xy} {piece.end.xy} within {radius}"
            print(f"{where}: {type(error).__name__}: {str(error)[:LONGEST]}", flush=True)
    spent = time.process_time() - begin
    print(f"{asked.kind}: {pieces} pieces, {events} events, {cells} cells, {wrong} wrong; {spent:.0f} s")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
