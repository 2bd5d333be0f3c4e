"""The lines of a drawing that stay open: how long they are, what they would enclose, and what closes them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import atan, hypot

from flint import fmpq

from exactacq.files.checking.cures import Trial
from exactacq.files.loops.chains import Chain, Corner, bend_of, distance_above
from exactacq.files.loops.contents import Contents
from exactacq.files.loops.nesting import Loops
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import nearest_float
from exactacq.scene.shapes import Outline, Shape, shape_edges
from exactacq.scene.validation import LIMIT

CURVES = ("flatten", "thicken")
"""The options that may close chains with curves that were left out, or make walls of them."""
MOST_CHAINS = 400
"""The longest chains, for which it is asked what they enclose."""
Place = tuple[fmpq, fmpq]


@dataclass(frozen=True, slots=True)
class OpenChain:
    """A line that stays open: its pieces by name, its ends, and what is known of its gap.

    *length* is a float. *gap* is the width of the widest gap that keeps it open, between ends that are
    nearest to each other, and *across* are the ends there; if its ends have no such mates this is None, and
    the gap is the one between them. *encloses* says whether, closed, it would have other loops within.
    *cures* are options that close it, of tolerances the least one, or if none does, one that makes it a wall;
    each is tried.
    """

    pieces: tuple[str, ...]
    edges: int
    length: float
    ends: tuple[Place, Place]
    gap: fmpq
    across: tuple[Place, Place] | None
    encloses: bool
    cures: tuple[str, ...] = ()


def open_chains(contents: Contents, tried: Sequence[Trial]) -> tuple[OpenChain, ...]:
    """All open chains of a file, the longest first."""
    closing = contents.gaps.closings
    gaps = {k: max(c.gaps, key=lambda gap: gap.width) for c in closing for k in c.chains}
    walks = [walked(path) for path in contents.open_chains]
    lengths = [sum(map(_length, walk, walk[1:])) for walk in walks]
    order = sorted(range(len(walks)), key=lambda k: -lengths[k])
    asked = order[:MOST_CHAINS]
    around = dict(zip(asked, _enclosing([walks[k] for k in asked], contents.loops), strict=True))
    around = {k: around.get(k, False) for k in order}
    for trial in tried:
        if "tolerance" in trial.options:
            held = _holders(trial.contents, contents)
            for closed in closing:
                if _labels(contents, closed.chains) & held:
                    around.update(dict.fromkeys(closed.chains, True))
    return tuple(
        OpenChain(
            tuple(piece.label for piece in contents.open_chains[k]),
            len(walks[k]) - 1,
            lengths[k],
            (_place(walks[k][0]), _place(walks[k][-1])),
            gaps[k].width if k in gaps else distance_above(walks[k][0], walks[k][-1]),
            gaps[k].places if k in gaps else None,
            around[k],
            _cures(contents, k, tried),
        )
        for k in order
    )


def walked(path: Sequence[Chain]) -> list[Corner]:
    """The corners along a path of pieces that meet in their ends."""
    corners: list[Corner] = []
    for k, piece in enumerate(path):
        ahead = piece.corners
        other = path[1] if k == 0 and len(path) > 1 else None
        ends = {_place(c) for c in (other.corners[0], other.corners[-1])} if other else set()
        turned = _place(corners[-1]) != _place(ahead[0]) if corners else _place(ahead[-1]) not in ends
        row = piece.backwards() if turned and len(path) > 1 else ahead
        if corners:
            # One of the two ends was moved to the other one: the arc before it may have lost its centre.
            shift = max(corners[-1].shift, row[0].shift)
            corners = [*corners[:-1], replace(row[0], shift=shift), *row[1:]]
        else:
            corners = list(row)
    return corners


def _place(corner: Corner) -> Place:
    return corner.x, corner.y


def _length(start: Corner, end: Corner) -> float:
    """An arc of bulge b over a chord c is c atan(b) (1 + b^2) / b long."""
    chord = hypot(*(nearest_float(min(abs(d), LIMIT)) for d in (end.x - start.x, end.y - start.y)))
    b = nearest_float(max(-LIMIT, min(start.bulge, LIMIT)))
    return chord * atan(b) * (1 + b * b) / b if b else chord


def _labels(contents: Contents, chains: Iterable[int]) -> set[str]:
    """The names of the pieces of some chains."""
    return {piece.label for k in chains for piece in contents.open_chains[k]}


def _cures(contents: Contents, k: int, tried: Sequence[Trial]) -> tuple[str, ...]:
    """The options after which a chain is not open any more; of tolerances the least one."""
    labels = {piece.label for piece in contents.open_chains[k]}
    least = contents.gaps.least(k)
    closed = [
        trial
        for trial in tried
        if "layers" not in trial.options
        for name in trial.options
        if (name in CURVES and labels.isdisjoint(trial.still_open))
        or (name == "tolerance" and trial.options[name] == least)
    ]
    lines = [trial for trial in closed if "thicken" not in trial.options]
    return tuple(trial.words for trial in lines or closed)


def _enclosing(walks: Sequence[list[Corner]], loops: Sequence[Shape]) -> list[bool]:
    """Which chains have loops within if a straight edge closes them."""
    rings = [
        Outline([(c.x, c.y, bend_of(c, d)) for c, d in zip(w, [*w[1:], w[0]], strict=True)]) for w in walks
    ]
    found = [False] * len(walks)
    lines = Loops(rings)
    for shape in loops if walks else ():
        if edges := shape_edges(shape):
            for k in lines.around(edges[0].start):
                found[k] = True
    return found


def _holders(closed: Contents, before: Contents) -> set[str]:
    """The names of the pieces of loops that are new and have others within."""
    known = {shape.name for shape in before.loops}
    new = [shape for shape in closed.loops if shape.name not in known]
    lines = Loops(new)
    places = [edges[0].start for shape in closed.loops if (edges := shape_edges(shape))]
    inside: set[int] = set()
    for point in places if new else ():
        inside |= {k for k in lines.around(point) if not _passes(new[k], point)}
    return {_first_piece(new[k]) for k in inside}


def _first_piece(shape: Shape) -> str:
    return (shape.name or "").removeprefix("loop from ")


def _passes(shape: Shape, point: Point) -> bool:
    """Whether a point is the first one of the shape."""
    return shape_edges(shape)[0].start == point
