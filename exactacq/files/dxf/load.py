"""DXF drawings: closed loops of the model space become a wall and obstacles.

Read are LWPOLYLINE and POLYLINE with bulges, LINE, ARC and CIRCLE, also inside blocks, as seen from above (z
is ignored, the mirrored extrusion (0, 0, -1) applied). Units stay the drawing's. A DXF coordinate is a
double; its value is taken to be the shortest decimal that denotes that double, which is what exporters write.
Everything that is moved, joined or left out is named in the scene's notes, with proven bounds of the moves.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from flint import fmpq

from exactacq.errors import FormatError
from exactacq.files.dxf.chains import Chain, scientific_above
from exactacq.files.dxf.cusps import open_cusps
from exactacq.files.dxf.entities import Drawing, read_drawing
from exactacq.files.dxf.nesting import Loops, nest
from exactacq.files.dxf.stitching import Stitched, stitch
from exactacq.files.dxf.union import unite
from exactacq.files.source import check_edges, one_line
from exactacq.geometry.points import Point
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Shape

TOLERANCE = fmpq(1, 10**6)
"""Default tolerance over the drawing's size. Real parts differ at joints by 1e-15 to 1e-7 of their size
(doubles, or six decimals), and their shortest edges are 1e-5 to 1e-3 of it: 1e-6 lies between."""
NAMED = 5
"""How many left out loops a note names."""


def load_dxf(
    path: str | Path,
    start: tuple[fmpq, fmpq] | None,
    layers: Iterable[str] | None = None,
    *,
    outer: str = "wall",
    tolerance: object = None,
    union: bool = False,
) -> Scene:
    """The scene in a DXF drawing.

    *start* is required (a drawing has none); *layers* selects by name, all by default. Ends and neighbouring
    vertices within *tolerance* (default `TOLERANCE` times the larger side of the drawing) are joined. The
    outermost loop around the start is the wall, or dropped (``outer="drop"``: all other loops then stay);
    loops outside the wall or inside an obstacle are left out. Loops that overlap or touch are refused by the
    scene, or merged if they are polygons and *union* is set. Raises `FormatError` and `InvalidScene`.
    """
    if outer not in ("wall", "drop"):
        raise FormatError(f'outer is "wall" or "drop", not {one_line(repr(outer))}')
    reach = None if tolerance is None else rational(tolerance)
    if reach is not None and reach < 0:
        raise FormatError(f"the tolerance is a length of at least 0, not {reach}")
    drawing = read_drawing(path, layers)
    check_edges(sum(chain.edges for chain in drawing.chains) + len(drawing.circles))
    notes = [*drawing.notes, *_left_out(drawing.dropped)]
    other = f"select other layers of {drawing.layer_list()}" if drawing.layers else "export another drawing"
    if not drawing.chains and not drawing.circles:
        raise FormatError(f"nothing to read{_because(notes)}; {other}")
    (x0, y0), (x1, y1) = drawing.extent()
    if start is None:
        raise FormatError(
            f"a drawing has no start: give one with --start X,Y (start=(x, y) in Python); "
            f"this one spans x {short(x0)} to {short(x1)}, y {short(y0)} to {short(y1)}"
        )
    if reach is None:
        reach = default_tolerance(max(x1 - x0, y1 - y0))
    stitched = stitch(drawing.chains, reach)
    cusps = sum(open_cusps(loop, reach) for loop in stitched.loops)
    shapes = _shapes(drawing, stitched)
    notes += _report(stitched, reach, cusps)
    if not shapes:
        raise FormatError(f"no closed loop{_because(notes)}; give a larger --tolerance, or {other}")
    obstacles, wall = _arranged(shapes, Point(*start), outer, union, notes)
    return Scene(obstacles, start=start, enclosure=wall, name=Path(path).stem, notes=notes)


def default_tolerance(size: fmpq) -> fmpq:
    """`TOLERANCE` of the size, rounded down to a power of ten; 0 for a size of 0."""
    if not size:
        return fmpq(0)
    power = fmpq(1)
    while power > size:
        power /= 10
    while power * 10 <= size:
        power *= 10
    return power * TOLERANCE


def _shapes(drawing: Drawing, stitched: Stitched) -> list[Shape]:
    """All loops in the order of the file; a circle drawn twice counts as a duplicate."""
    placed: list[tuple[int, Shape]] = [(loop.order, loop.shape()) for loop in stitched.loops]
    seen: set[tuple[object, ...]] = set()
    for order, circle in drawing.circles:
        key = (circle.center, circle.radius)
        if key in seen:
            stitched.duplicates += 1
        else:
            seen.add(key)
            placed.append((order, circle))
    return [shape for _, shape in sorted(placed, key=lambda entry: entry[0])]


def _arranged(
    shapes: list[Shape], start: Point, outer: str, union: bool, notes: list[str]
) -> tuple[list[Shape], Shape | None]:
    """The obstacles and the wall; what was left out goes to the notes."""
    loops = Loops(shapes)
    nested = nest(loops, start, outer)
    if nested.dropped is not None:
        notes.append(f"dropped the outer loop {shapes[nested.dropped].name}")
    notes += _named("outside the wall left out", shapes, nested.outside)
    notes += _named("inside an obstacle left out (the robot cannot see them)", shapes, nested.hidden)
    wall = None if nested.wall is None else shapes[nested.wall]
    obstacles = [shapes[i] for i in nested.obstacles]
    if union:
        merged = unite(obstacles, wall, start)
        if merged.notes:
            kept = [*merged.obstacles, *([] if merged.wall is None else [merged.wall])]
            nested = nest(Loops(kept), start, "keep", wall=None if merged.wall is None else len(kept) - 1)
            obstacles, wall = [kept[i] for i in nested.obstacles], merged.wall
            notes += merged.notes
            notes += _named("outside the free place left out", kept, nested.outside)
            notes += _named("inside a union left out (the robot cannot see them)", kept, nested.hidden)
    return obstacles, wall


# -- what the notes say ----------------------------------------------------------------------------


def _report(stitched: Stitched, tolerance: fmpq, cusps: int) -> list[str]:
    """One sentence for each thing that was done to the loops, and for all that was left out of them."""
    moved = max((loop.moved() for loop in stitched.loops), default=fmpq(0))
    notes = []
    if stitched.joined:
        far = scientific_above(stitched.largest)
        ends = count(stitched.joined, "end")
        also = ", open chains included" if stitched.open_chains else ""
        notes.append(f"joined {ends} within {short(tolerance)}{also}; the largest move is at most {far}")
    if moved:
        far = scientific_above(moved)
        notes.append(f"no point of any loop moved by more than {far} (arcs made rational, ends joined)")
    if cusps:
        notes.append(
            f"changed a bulge at {count(cusps, 'cusp')} that rounding had made cross, within that bound"
        )
    if stitched.short_edges:
        notes.append(f"took out {count(stitched.short_edges, 'edge')} not longer than {short(tolerance)}")
    if stitched.duplicates:
        notes.append(f"left out {count(stitched.duplicates, 'piece')} drawn twice")
    if stitched.flat:
        notes.append(f"left out {count(stitched.flat, 'loop')} without area")
    if chains := stitched.open_chains:
        pieces = sum(len(chain) for chain in chains)
        x, y = _place(chains[0][0])
        notes.append(
            f"left out {count(len(chains), 'open chain')} ({count(pieces, 'piece')}), "
            f"the first {chains[0][0].label} from ({x}, {y})"
        )
    if stitched.branches:
        x, y = (short(c) for c in stitched.branches[0])
        n = len(stitched.branches)
        notes.append(f"{count(n, 'branch point')} where three or more ends meet, the first at ({x}, {y})")
    return notes


def _left_out(dropped: Counter[str]) -> list[str]:
    named = ", ".join(f"{n} {reason}" for reason, n in dropped.most_common())
    return [f"left out {named}"] if named else []


def _named(what: str, shapes: Sequence[Shape], members: list[int]) -> list[str]:
    if not members:
        return []
    names = ", ".join(str(shapes[i].name) for i in members[:NAMED])
    more = f" and {len(members) - NAMED} more" if len(members) > NAMED else ""
    return [f"{count(len(members), 'loop')} {what}: {names}{more}"]


def _because(notes: list[str]) -> str:
    return f" ({'; '.join(notes)})" if notes else ""


def _place(chain: Chain) -> tuple[str, str]:
    return short(chain.corners[0].x), short(chain.corners[0].y)


def count(n: int, noun: str) -> str:
    """``1 end``, ``2 ends``."""
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"


def short(value: fmpq) -> str:
    """Six digits of a number, for messages."""
    return f"{float(Real(value)):.6g}"
