"""A drawing of chains and circles becomes loops and what stays open: joined, and reported."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from flint import fmpq

from exactacq.errors import CurvesRefused, FormatError, shown
from exactacq.files.counting import count
from exactacq.files.loops.chains import Chain, scientific_above
from exactacq.files.loops.contents import Contents, Layers
from exactacq.files.loops.cusps import open_cusps
from exactacq.files.loops.drawing import Drawing, main_box
from exactacq.files.loops.stitching import Stitched, stitch
from exactacq.files.repairs.gaps import MOST_EDGES, ChainGaps, copied, gaps_of
from exactacq.files.repairs.thicken import thicken
from exactacq.files.source import check_edges
from exactacq.numbers.rationals import plain, rational
from exactacq.numbers.real import Real
from exactacq.scene.shapes import Loop, Shape

TOLERANCE = fmpq(1, 10**6)
"""Default tolerance over the drawing's size. Real parts differ at joints by 1e-15 to 1e-7 of their size
(doubles, or six decimals), and their shortest edges are 1e-5 to 1e-3 of it: 1e-6 lies between."""
SHAPES = "draw obstacles by lines, arcs, circles or polylines that close"
"""What to do about a drawing of other things."""
SCIENTIFIC = 12
"""Numbers of at most so many digits are written with an exponent where that is short."""


def drawing_contents(
    drawing: Drawing,
    name: str,
    start: tuple[fmpq, fmpq] | None,
    *,
    outer: str = "wall",
    tolerance: fmpq | None = None,
    union: bool = False,
    thickness: fmpq | None = None,
) -> Contents:
    """What a drawing shows; a scene around a *start* only, for a drawing has none.

    Ends and neighbouring vertices within *tolerance* are joined: by default `TOLERANCE` times the larger side
    of the drawing, but for what is far off. The outermost loop around the start is the wall, or dropped
    (``outer="drop"``: all other loops then stay); with ``outer="room"`` the innermost one is the wall. Loops
    outside the wall or inside an obstacle are left out. Loops that overlap or touch are refused by the scene,
    or merged if *union* is set. With a *thickness* chains that stay open are walls so thick, merged where
    they overlap and with what they meet. Raises `FormatError` if there is nothing to read.
    """
    if tolerance is not None and tolerance < 0:
        raise FormatError(f"the tolerance is a length of at least 0, not {shown(tolerance)}")
    edges = sum(chain.edges for chain in drawing.chains)
    check_edges(edges + len(drawing.circles))
    notes = [*drawing.notes, *([drawing.readable] if drawing.readable else []), *_left_out(drawing.dropped)]
    other = "export another drawing"
    if drawing.layers:
        is_all = drawing.chosen is None
        other = SHAPES if is_all else f"select other layers of {drawing.layer_list()}"
    if not drawing.chains and not drawing.circles:
        way = drawing.readable or other
        refused = CurvesRefused if drawing.has_curves else FormatError
        raise refused(f"nothing to read{_because(_left_out(drawing.dropped))}; {way}")
    corners = drawing.corners()
    (x0, x1), (y0, y1) = ((min(values), max(values)) for values in zip(*corners, strict=True))
    startless = (
        f"a drawing has no start: give one with --start X,Y (start=(x, y) in Python), such as the "
        "one that `exactacq check` proposes; "
        f"this one spans x {short(x0)} to {short(x1)}, y {short(y0)} to {short(y1)}"
    )
    reach = tolerance
    if reach is None:
        low, high = main_box(corners)
        reach = default_tolerance(max(high[0] - low[0], high[1] - low[1]))
        far = (
            c for c in corners if not all(a <= value <= b for a, value, b in zip(low, c, high, strict=True))
        )
        if (place := next(far, None)) is not None:
            where = ", ".join(map(short, place))
            notes.append(
                f"what is about ({where}) is far from nearly everything else, by which the tolerance goes"
            )
    pieces = copied(drawing.chains) if thickness is None and edges <= MOST_EDGES else []
    stitched = stitch(drawing.chains, reach)
    gaps = gaps_of(stitched, pieces) if thickness is None else ChainGaps()
    cusps = sum(open_cusps(loop, reach) for loop in stitched.loops)
    shapes = _shapes(drawing, stitched)
    notes += _report(stitched, reach, cusps, thickness)
    walls: list[Shape] = []
    if thickness is not None:
        thick = thicken([piece for path in stitched.open_chains for piece in path], thickness)
        walls = thick.shapes
        check_edges(sum(len(s.vertices) if isinstance(s, Loop) else 2 for s in walls))
        union = union or bool(walls)
        shapes += [(0, shape) for shape in walls]
        if thick.off:
            notes.append(f"no outline of these walls is off by more than {scientific_above(thick.off)}")
    hint = _what_closes(gaps, len(stitched.open_chains))
    ways = [hint] if hint else []
    if stitched.open_chains:
        ways.append("--thicken LENGTH for walls along the lines")
    elif stitched.short_edges:
        ways.append("a smaller --tolerance")
    give = f"give {', '.join(ways)}, or " if ways else ""
    lacking = f"no closed loop{_because(notes)}; {give}{other}"
    if hint:
        notes.append(f"open chains close with {hint}")
    return Contents(
        name=name,
        loops=tuple(shape for _, shape in shapes),
        outer=outer,
        union=union,
        options=("outer", "union"),
        start=start,
        notes=tuple(notes),
        startless=startless,
        lacking="" if shapes else lacking,
        open_chains=() if thickness else tuple(map(tuple, stitched.open_chains)),
        gaps=gaps,
        branches=len(stitched.branches),
        has_curves=drawing.has_curves,
        walls=len(walls),
        layers=Layers(drawing.layers, drawing.chosen, _homes(drawing, shapes)),
        unit=drawing.unit,
    )


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


def _homes(drawing: Drawing, shapes: Sequence[tuple[int, Shape]]) -> dict[str, str]:
    """The layers of loops: of those in pieces, the first one's."""
    return {s.name: drawing.homes[order] for order, s in shapes if s.name and order in drawing.homes}


def _shapes(drawing: Drawing, stitched: Stitched) -> list[tuple[int, Shape]]:
    """All loops, with their places, in the order of the file; a circle drawn twice counts as a duplicate."""
    placed: list[tuple[int, Shape]] = [(loop.order, loop.shape()) for loop in stitched.loops]
    seen: set[tuple[object, ...]] = set()
    for order, circle in drawing.circles:
        key = (circle.center, circle.radius)
        if key in seen:
            stitched.duplicates += 1
        else:
            seen.add(key)
            placed.append((order, circle))
    return sorted(placed, key=lambda entry: entry[0])


# -- what the notes say ----------------------------------------------------------------------------


def _report(stitched: Stitched, tolerance: fmpq, cusps: int, thickness: fmpq | None) -> list[str]:
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
        done = (
            "left out" if thickness is None else f"made walls {short(thickness)} thick, with round ends, of"
        )
        notes.append(
            f"{done} {count(len(chains), 'open chain')} ({count(pieces, 'piece')}), "
            f"the first {chains[0][0].label} from ({x}, {y})"
        )
    if stitched.branches:
        x, y = (short(c) for c in stitched.branches[0])
        n = len(stitched.branches)
        notes.append(f"{count(n, 'branch point')} where three or more ends meet, the first at ({x}, {y})")
    return notes


def _what_closes(gaps: ChainGaps, chains: int) -> str:
    """The least tolerance that closes open chains, where the gap is, and the one that closes most of them."""
    if not gaps.tried:
        return ""
    least = gaps.tried[0]
    gap = max(least.closing.gaps, key=lambda gap: gap.width)
    x, y = (short(c) for c in gap.places[0])
    mate = "its other end" if gap.pieces[0] == gap.pieces[1] else gap.pieces[1]
    most = max(gaps.tried, key=lambda tried: len(tried.chains))
    more = f"; --tolerance {in_full(most.tolerance)} closes {len(most.chains)}" if most is not least else ""
    return (
        f"--tolerance {in_full(least.tolerance)}, which closes {len(least.chains)} of "
        f"{count(chains, 'open chain')}: {gap.pieces[0]} ends at ({x}, {y}), "
        f"{scientific_above(gap.width)} from {mate}{more}"
    )


def _left_out(dropped: Counter[str]) -> list[str]:
    named = ", ".join(count(n, reason) for reason, n in dropped.most_common())
    return [f"left out {named}"] if named else []


def _because(notes: list[str]) -> str:
    return f" ({'; '.join(notes)})" if notes else ""


def _place(chain: Chain) -> tuple[str, str]:
    return short(chain.corners[0].x), short(chain.corners[0].y)


def in_full(value: fmpq) -> str:
    """A positive number without loss, for the command line: ``8.8e-11`` rather than many zeros."""
    text = scientific_above(value, SCIENTIFIC)
    return text if rational(text) == value else plain(value)


def short(value: fmpq) -> str:
    """Six digits of a number, for messages."""
    try:
        return f"{float(Real(value)):.6g}"
    except OverflowError:
        return Real(value).decimal(6)
