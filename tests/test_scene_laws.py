"""Laws of whole runs on drawn scenes, for both strategies: what must not change a run, and who must agree."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import pytest
from drawn_scenes import motions, scenes, terrains
from drawn_scenes.placing import cut
from hypothesis import assume, given
from hypothesis import strategies as st
from map_oracle import Answer, Spot, known, spots
from nightly import examples, some
from oracles import Room
from strategies import ONE, ZERO, Similarity, Terrain, box
from test_exact_only import told
from test_laws_of_arcs import has_ties

import exactacq as xa
from exactacq import kernel
from exactacq.files.scene_json import parse_json, scene_of, whole_text
from exactacq.geometry.curves import Arc
from exactacq.study.claims.model import Subject

Q = Fraction
EXAMPLES = examples(2, 100)
DIGITS = 40
LARGEST = 10**4
"""Radius of an arc up to which the oracle's floats are good to its margin."""


def explored(scene: xa.Scene) -> xa.Run:
    """The run of the strategy for which the scene was drawn."""
    return xa.sightseer(scene) if scene.terrain is None else xa.seed_spreader(scene)


def run_of(terrain: Terrain) -> xa.Run:
    return explored(terrain.scene())


def outline(run: xa.Run, scale: Fraction = ONE, *, events: bool = True) -> list[object]:
    """What a run came to, in numbers of a scene that many times as large, without numbers of edges."""
    lengths = [run.map.known_length(k) for k in range(len(run.obstacles))]
    moments = [(e.kind, e.obstacle, e.note, digits(e.at * scale)) for e in run.events] if events else []
    return [
        run.visits,
        run.unseen,
        run.unvisited,
        digits(run.length * scale),
        [digits(length * scale) for length in lengths],
        (run.map.acquired, run.map.incomplete),
        moments,
    ]


def digits(length: xa.Length) -> str:
    return length.decimal(DIGITS)


# -- the laws --------------------------------------------------------------------------------------


def law_of_the_audit(scene: xa.Scene) -> None:
    xa.audit(explored(scene), samples=12)


def law_of_floats(scene: xa.Scene) -> None:
    """If floats decide nothing, the run is the same."""
    usual = told(explored(scene))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kernel, "EXACT_ONLY", True)
        assert told(explored(scene)) == usual


def law_of_shifts(terrain: Terrain, move: Similarity) -> None:
    """Moved without a turn, and stretched, everything is as it was: the order of coordinates stays."""
    move = replace(move, turn=(ONE, ZERO), mirror=False)
    assert outline(run_of(move.terrain(terrain))) == outline(run_of(terrain), move.scale)


def law_of_motions(terrain: Terrain, move: Similarity) -> None:
    """Turned or mirrored, the Sightseer's run is the image, if no two ways tie: coordinates decide ties.

    A mirror image is circled the other way, so other events come on the way.
    """
    image, run = (run_of(t) for t in (move.terrain(terrain), terrain))
    events = not move.mirror
    if outline(image, events=events) != outline(run, move.scale, events=events):
        assert has_ties(terrain)


def law_of_distance(terrain: Terrain) -> None:
    """What lies out of reach changes nothing but what is unseen."""
    assume(not any(isinstance(shape, Room) for shape in terrain.shapes))
    far = tuple(box(10**12, 10**12 + 1, y, y + 1) for y in (-(10**12), 10**12))
    run, other = run_of(terrain), run_of(replace(terrain, shapes=(*terrain.shapes, *far)))
    count = len(terrain.shapes)
    assert other.unseen == (*run.unseen, count, count + 1)
    mine, theirs = outline(run), outline(other)
    assert theirs[4][count:] == [digits(xa.Length(0))] * 2
    assert (theirs[0], *theirs[2:4], theirs[4][:count], theirs[5]) == (mine[0], *mine[2:5], mine[5])
    assert [moment[:2] + moment[3:] for moment in theirs[6]] == [m[:2] + m[3:] for m in mine[6]]


def law_of_drawing(terrain: Terrain, cuts: int) -> None:
    """Edges and arcs cut in two, circles drawn as arcs: nothing changes but numbers of edges."""

    def redrawn(shape: object) -> object:
        return Room(cut(shape.vertices, cuts)) if isinstance(shape, Room) else cut(shape, cuts)

    other = replace(terrain, shapes=tuple(map(redrawn, terrain.shapes)))
    assert outline(run_of(other)) == outline(run_of(terrain))


def law_of_files(scene: xa.Scene) -> None:
    """A scene that is written and read again gives the same run, and so does a run."""
    again = scene_of(parse_json(whole_text(scene).encode()))
    assert again == scene
    run = explored(scene)
    assert told(explored(again)) == told(run)
    assert xa.load_run(json.loads(json.dumps(run.to_json()))) == run


def law_of_sampled_maps(scene: xa.Scene) -> None:
    """What the map says of sampled boundary points, an oracle in floats says too, if it can tell."""
    arcs = [edge for o in scene.obstacles for edge in o.edges if isinstance(edge, Arc)]
    assume(all(float(arc.radius) < LARGEST for arc in arcs))
    run = explored(scene)
    at_border = scene.meets_border()
    inner = [spot for spot in spots(scene, [Q(1, 7), Q(5, 9)]) if spot.obstacle not in at_border]
    for spot, answer in zip(inner, known(scene, run.radius, run.path, inner), strict=True):
        if answer != Answer.CLOSE:
            assert is_known(run, spot) == (answer == Answer.YES), spot


def is_known(run: xa.Run, spot: Spot) -> bool:
    """Whether the map knows a point of an obstacle that does not meet a border; never one behind others."""
    if run.ground is None:
        return run.map.knows(spot.obstacle, spot.point)
    (component,) = run.ground.of(spot.obstacle)
    return component in run.obstacles and run.map.knows(component.index, spot.point)


# -- under hypothesis ------------------------------------------------------------------------------

Law = Callable[[xa.Scene], None]
LAWS: tuple[Law, ...] = (law_of_the_audit, law_of_files, law_of_floats)


@pytest.mark.parametrize(
    "law, subject",
    some(((law, subject) for law in LAWS for subject in Subject), 5),
    ids=lambda it: it.value if isinstance(it, Subject) else it.__name__.removeprefix("law_of_"),
)
@EXAMPLES
@given(st.data())
def test_law(law: Law, subject: Subject, data: st.DataObject) -> None:
    law(data.draw(scenes(subject)))


@pytest.mark.parametrize("subject", list(Subject), ids=lambda subject: subject.value)
@EXAMPLES
@given(st.data())
def test_sampled_maps(subject: Subject, data: st.DataObject) -> None:
    law_of_sampled_maps(data.draw(scenes(subject, moved=False)))


@pytest.mark.parametrize("subject", list(Subject), ids=lambda subject: subject.value)
@EXAMPLES
@given(st.data(), motions(always=True))
def test_shifts(subject: Subject, data: st.DataObject, move: Similarity) -> None:
    law_of_shifts(data.draw(terrains(subject, moved=False)), move)


@EXAMPLES
@given(terrains(moved=False), motions(always=True))
def test_motions(terrain: Terrain, move: Similarity) -> None:
    law_of_motions(terrain, move)


@EXAMPLES
@given(terrains(rooms=False))
def test_distance(terrain: Terrain) -> None:
    law_of_distance(terrain)


@pytest.mark.parametrize("subject", list(Subject), ids=lambda subject: subject.value)
@EXAMPLES
@given(st.data(), st.integers(2, 31).map(lambda n: n & ~1))
def test_drawing(subject: Subject, data: st.DataObject, cuts: int) -> None:
    law_of_drawing(data.draw(terrains(subject)), cuts)
