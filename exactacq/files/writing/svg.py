"""SVG drawings: a group for each kind of thing; arcs are arcs, coordinates are those of the scene, y up.

The viewBox is that of the scene, and one transformation mirrors all in its middle, which turns y up. No
coordinate is shifted or scaled otherwise, so finite decimals stay as they are.
"""

from __future__ import annotations

from html import escape

from flint import fmpq

from exactacq.errors import without_controls
from exactacq.files.loops.chains import Corner
from exactacq.files.writing.corners import Corners
from exactacq.files.writing.decimals import Precision, text
from exactacq.files.writing.sheet import Item, Sheet, Written
from exactacq.geometry.curves import Arc
from exactacq.numbers.rationals import rational
from exactacq.numbers.real import Real

WIDEST = fmpq(1, 2)
"""Largest bulge, but of arcs that are exact: the centre of a wider one would move more than its radius."""
MARGIN = 0.05
"""Free border, as a part of the larger side."""
PIXELS = 800
"""Of the larger side, where nothing scales the picture."""
AREA, WALL = "fill:#dcd7cd;stroke:#8a8377;stroke-width:1", "fill:none;stroke:#8a8377;stroke-width:2"
LOOKS = {
    "obstacles": AREA,
    "enclosure": WALL,
    "terrain": "fill:none;stroke:#70767d;stroke-width:1;stroke-dasharray:4 3",
    "view": "fill:#3b7dd8;fill-opacity:0.16;stroke:#3b7dd8;stroke-width:1",
    "rays": "fill:none;stroke:#d6273d;stroke-width:1",
    "known": "fill:none;stroke:#22262b;stroke-width:2.5",
    "path": "fill:none;stroke:#3b7dd8;stroke-width:2",
    "links": "fill:none;stroke:#f6b64b;stroke-width:5;stroke-opacity:0.55",
    "diversions": "fill:none;stroke:#e8590c;stroke-width:2",
}
POINT = "fill:none;stroke:#d6273d;stroke-width:6"


def written(sheet: Sheet) -> Written:
    """The sheet as an SVG document; the same sheet always gives the same text. Linear in the curves."""
    writer = _SvgWriter(Precision.of(sheet))
    groups = []
    for layer in sheet.layers:
        paths = [writer.path(item) for item in sheet.items if item.layer == layer]
        style = LOOKS.get(layer, POINT)
        groups.append(f'<g id="{escape(layer)}" style="{style}">\n' + "\n".join(paths) + "\n</g>")
    body = "\n".join(groups)
    box, size = _frame(sheet)
    mirror = text(2 * box[1] + box[3])
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{" ".join(map(text, box))}" {size}>',
        f"<title>{_told(sheet.title)}</title>",
        f'<g transform="matrix(1 0 0 -1 0 {mirror})" stroke-linecap="round" stroke-linejoin="round">',
        *([body] if body else []),
        "</g>",
        "</svg>",
    ]
    return Written(("\n".join(lines) + "\n").encode(), writer.moved)


def _frame(sheet: Sheet) -> tuple[tuple[fmpq, ...], str]:
    """The view, about all that there is: left, low, width and height, and its size in pixels."""
    strokes = [curve.stroke() for item in sheet.items for curve in item.curves]
    places = [place for stroke in strokes for place in stroke.points().tolist()]
    places += [item.place.xy for item in sheet.items if item.place is not None]
    xs, ys = zip(*(places or [(0.0, 0.0)]), strict=True)
    size = max(max(xs) - min(xs), max(ys) - min(ys)) or 1.0
    corner = [min(side) - MARGIN * size for side in (xs, ys)]
    sides = [max(side) - min(side) + 2 * MARGIN * size for side in (xs, ys)]
    pixels = (f"{PIXELS * side / max(sides):.0f}" for side in sides)
    box = tuple(rational(f"{number:.9g}") for number in (*corner, *sides))
    return box, " ".join(f'{name}="{count}"' for name, count in zip(("width", "height"), pixels, strict=True))


def _told(value: object) -> str:
    """What XML holds of a name or number."""
    return escape(without_controls(str(value)))


class _SvgWriter:
    def __init__(self, precision: Precision) -> None:
        self.precision, self.moved = precision, fmpq(0)

    def path(self, item: Item) -> str:
        """One item, a full circle as such; a point is a stroke of no length, which round ends make a dot."""
        told = "".join(
            f' data-{key}="{_told(value)}"' for key, value in item.properties.items() if value is not None
        )
        name = item.properties.get("name")
        title = f"<title>{_told(name)}</title>" if name else ""
        first = item.curves[0] if item.curves else None
        element, data = "path", ""
        if isinstance(first, Arc) and first.full and len(item.curves) == 1:
            element, data = "circle", self._circle(first)
        else:
            data = f'd="{self._data(item)}"'
        return f'<{element} vector-effect="non-scaling-stroke" {data}{told}>{title}</{element}>'

    def _circle(self, circle: Arc) -> str:
        """A full circle; where it starts is not told."""
        values = (circle.center.x, circle.center.y, circle.radius)
        (x, dx), (y, dy), (radius, error) = map(self.precision.rounded, values)
        self.moved = max(self.moved, dx + dy + error)
        return f'cx="{text(x)}" cy="{text(y)}" r="{text(radius)}"'

    def _data(self, item: Item) -> str:
        if item.place is not None:
            (x, dx), (y, dy) = self.precision.rounded(item.place.x), self.precision.rounded(item.place.y)
            self.moved = max(self.moved, dx + dy)
            return f"M{text(x)} {text(y)}h0"
        chain = Corners(item, self.precision, self._is_exact, WIDEST)
        corners = chain.corners
        following = [*corners[1:], *(corners[:1] if item.closed else [])]
        data, more = f"M{text(corners[0].x)} {text(corners[0].y)}", fmpq(0)
        for corner, curve, end in zip(corners, chain.curves, following, strict=False):
            if isinstance(curve, Arc):
                radius, moved = self._radius(corner, end, curve)
                more = max(more, moved)
                data += f"A{text(radius)} {text(radius)} 0 {int(abs(corner.bulge) > 1)} {int(curve.ccw)} "
            else:
                data += "L"
            data += f"{text(end.x)} {text(end.y)}"
        self.moved = max(self.moved, chain.moved + more)
        return data + ("Z" if item.closed else "")

    def _is_exact(self, arc: Arc) -> bool:
        return not self.precision.rounded(arc.radius)[1]

    def _radius(self, start: Corner, end: Corner, arc: Arc) -> tuple[fmpq, fmpq]:
        """The radius of the arc between two corners, and how far its rounding moves a point at most.

        With sin h = c / (2 r) for the chord c and half of the angle h, the bulge b = tan (h / 2) is at most
        `WIDEST`, so cos h >= 3/5, and |db| <= 1.05 c |dr| / (2 r^2): a point moves by c |db| / 2 at most (see
        `exactacq.files.loops.chains`), which is 0.7 |dr| as c <= 1.6 r; twice the change is enough for one
        of up to a hundredth. An arc that is smaller stays within two diameters.
        """
        if not start.bulge_shift and self._is_exact(arc):
            return self.precision.rounded(arc.radius)[0], fmpq(0)
        chord = Real((end.x - start.x) ** 2 + (end.y - start.y) ** 2).sqrt()
        size = abs(start.bulge)
        radius, moved = self.precision.rounded(chord * ((1 + size * size) / (4 * size)))
        return radius, 2 * moved if 100 * moved <= radius else 4 * (radius + moved)
