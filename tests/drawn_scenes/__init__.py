"""Scenes under hypothesis, for both strategies: obstacles by kind, each placed by its relation to the others.

`scenes` draws valid scenes of the library, `terrains` the same as plain data, which can be moved and redrawn.
What is drawn are small numbers that mean something in every context (`drawing.Draft`), so that nearly
nothing is rejected and failures shrink to few, plain obstacles in plain relations.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from hypothesis import note
from hypothesis import strategies as st
from strategies import ONE, ZERO, Similarity, Terrain

import exactacq as xa
from drawn_scenes.drawing import (
    FACTORS,
    MARGINS,
    WAYS_TO_BOUND,
    WAYS_TO_ENCLOSE,
    WAYS_TO_START,
    Draft,
    swept,
    toured,
)
from drawn_scenes.kinds import CURVED, KINDS, STRAIGHT, VARIANTS, Kind
from drawn_scenes.placing import GAPS, HAIRS, RELATIONS, TURNS, Step
from exactacq.files.scene_json import whole_text
from exactacq.study.claims.model import Subject

__all__ = ["CURVED", "KINDS", "STRAIGHT", "motions", "scenes", "terrains"]

Q = Fraction
SHIFTS = ((ZERO, ZERO), (Q(22, 7), Q(-355, 113)), (Q(10**6), Q(-(10**6))), (Q(10**9 + 7), Q(3 - 10**9)))
SCALES = (ONE, Q(7, 3), Q(1, 10**9), Q(10**9))
FEW = st.integers(0, 7)


def steps(kinds: Sequence[Kind]) -> st.SearchStrategy[Step]:
    """What is drawn for one obstacle; the plainest is a unit square a unit away from the last one."""
    return st.builds(
        Step,
        relation=st.sampled_from(RELATIONS),
        kind=st.sampled_from(kinds),
        width=st.integers(1, 4),
        height=st.integers(1, 3),
        variant=st.integers(0, VARIANTS - 1),
        other=FEW,
        mine=FEW,
        theirs=FEW,
        side=FEW,
        gap=rarely(GAPS),
        pose=rarely(range(2 * len(TURNS))),
        hair=rarely(HAIRS),
        cuts=rarely(range(32)),
    )


def rarely(values: Sequence) -> st.SearchStrategy:
    """The first of the values, or, once in three draws, any of them."""
    return st.one_of(st.just(values[0]), st.just(values[0]), st.sampled_from(values))


def motions(upright: bool = False, *, always: bool = False) -> st.SearchStrategy[Similarity]:
    """Rational motions and changes of scale: seldom any, unless *always*; *upright* keeps rectangles so."""
    some = st.sampled_from if always else rarely
    return st.builds(
        Similarity,
        turn=some(TURNS[:4] if upright else TURNS),
        scale=some(SCALES),
        shift=some(SHIFTS),
        mirror=st.booleans() if always else some((False, True)),
    )


def terrains(
    subject: Subject = Subject.SIGHTSEER,
    kinds: Sequence[Kind] = KINDS,
    *,
    least: int = 1,
    most: int = 4,
    rooms: bool = True,
    moved: bool = True,
) -> st.SearchStrategy[Terrain]:
    """Scenes as plain data, of *least* to *most* steps of one or a few obstacles.

    Without *rooms* there is no enclosure; if not *moved*, numbers stay small.
    """
    sweeps = subject is Subject.SEED_SPREADER
    drafts = st.builds(
        Draft,
        steps=st.lists(steps(kinds), min_size=least, max_size=most),
        start=st.tuples(st.integers(0, WAYS_TO_START - 1), FEW),
        room=st.tuples(rarely(range(WAYS_TO_ENCLOSE)) if rooms else st.just(0), st.sampled_from(MARGINS)),
        sight=st.tuples(st.integers(0, 2), st.integers(0, 20)),
        factor=rarely(FACTORS),
        hair=rarely(HAIRS),
        border=st.tuples(*[rarely(range(WAYS_TO_BOUND))] * 4),
        motion=motions(sweeps) if moved else st.just(Similarity()),
    )
    return drafts.map(swept if sweeps else toured)


def scenes(subject: Subject = Subject.SIGHTSEER, **options: object) -> st.SearchStrategy[xa.Scene]:
    """The scenes of `terrains`, with the start or the terrain, and the radius. A failing one is printed."""
    return terrains(subject, **options).map(told)


def told(terrain: Terrain) -> xa.Scene:
    """The scene; hypothesis prints it as JSON where an example fails."""
    scene = terrain.scene()
    note(f"scene: {whole_text(scene)}")
    return scene
