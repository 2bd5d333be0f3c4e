"""An isovist as a small SVG picture: the view shaded, windows dashed, range arcs drawn, obstacles faint.

Written by hand rather than plotted: a notebook shows many of them. SVG knows arcs, so nothing is approximated
but the coordinates. The same view always gives the same text.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import hypot

from exactacq.geometry.curves import Arc, Curve
from exactacq.output.vocabulary import EDGE, FILL, GROUND, HIT, INK, PAPER, SHADE, VIEW
from exactacq.visibility.isovist import Isovist, ViewKind

WIDTH = 420
"""Pixels, of the picture's sides."""
MARGIN = 0.06
"""Share of the picture's side beyond the range."""


def svg(view: Isovist) -> str:
    """The picture: a square a little larger than the range, about the point."""
    return _Picture(view).text()


class _Picture:
    def __init__(self, view: Isovist) -> None:
        self.view = view
        self.x, self.y = view.point.xy
        self.scale = WIDTH * (1 - 2 * MARGIN) / (2 * float(view.radius))

    def text(self) -> str:
        """The whole document."""
        view = self.view
        pieces = view.pieces
        obstacles = [o for o in view.scene.obstacles if not o.is_enclosure and self._is_near(o.edges)]
        walls = [o for o in view.scene.obstacles if o.is_enclosure]
        side = f"{WIDTH}"
        frame = f"M0 0H{side}V{side}H0Z"
        lines = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {side} {side}" '
            f'width="{side}" height="{side}">',
            f"<title>Isovist from ({self.x:.6g}, {self.y:.6g}) within {float(view.radius):.6g}</title>",
            f'<rect width="{side}" height="{side}" fill="{GROUND}"/>',
            f'<g fill="{FILL}" stroke="{EDGE}" stroke-width="0.8" fill-rule="evenodd" opacity="0.55">',
            *(f'<path d="{self._loop(o.edges)}"/>' for o in obstacles),
            *(f'<path d="{frame}{self._loop(o.edges)}"/>' for o in walls),
            "</g>",
        ]
        if pieces:
            outline = self._loop([piece.curve for piece in pieces])
            lines.append(f'<path d="{outline}" fill="{VIEW}" fill-opacity="{SHADE}"/>')
        for kind, style in (
            (ViewKind.RANGE, f'stroke="{VIEW}" stroke-width="1.1"'),
            (ViewKind.WINDOW, f'stroke="{VIEW}" stroke-width="0.9" stroke-dasharray="4 3"'),
            (ViewKind.EDGE, f'stroke="{INK}" stroke-width="2.2" stroke-linecap="round"'),
        ):
            paths = "".join(self._line(piece.curve) for piece in pieces if piece.kind is kind)
            lines += [f'<path d="{paths}" fill="none" {style}/>'] if paths else []
        paths = "".join(self._line(ray) for ray in view.rays)
        lines += [f'<path d="{paths}" fill="none" stroke="{HIT}" stroke-width="0.9"/>'] if paths else []
        x, y = self._place((self.x, self.y))
        lines += [f'<circle cx="{x}" cy="{y}" r="3.6" fill="{VIEW}" stroke="{PAPER}"/>', "</svg>"]
        return "\n".join(lines)

    def _is_near(self, edges: Iterable[Curve]) -> bool:
        """Whether some of an obstacle may be in the picture."""
        reach = float(self.view.radius) / (1 - 2 * MARGIN) * 1.5
        return any(
            hypot(x - self.x, y - self.y) < reach + float(edge.length)
            for edge in edges
            for x, y in (edge.start.xy,)
        )

    def _place(self, point: tuple[float, float]) -> tuple[str, str]:
        """Pixels of a place of the scene, the y axis up."""
        x = WIDTH / 2 + (point[0] - self.x) * self.scale
        y = WIDTH / 2 - (point[1] - self.y) * self.scale
        return f"{x:.2f}", f"{y:.2f}"

    def _line(self, curve: Curve) -> str:
        """A curve as a path of its own."""
        x, y = self._place(curve.start.xy)
        return f"M{x} {y}{self._onward(curve)}"

    def _loop(self, curves: Iterable[Curve]) -> str:
        """A closed chain of curves as a path."""
        parts = list(curves)
        x, y = self._place(parts[0].start.xy)
        return f"M{x} {y}{''.join(map(self._onward, parts))}Z"

    def _onward(self, curve: Curve) -> str:
        """A curve, drawn on from its start; a full circle as two halves."""
        x, y = self._place(curve.end.xy)
        if not isinstance(curve, Arc):
            return f"L{x} {y}"
        radius, sweep = f"{float(curve.radius) * self.scale:.2f}", int(not curve.ccw)
        if curve.full:
            u, v = self._place((curve.center + (curve.center - curve.start)).xy)
            return f"A{radius} {radius} 0 0 {sweep} {u} {v}A{radius} {radius} 0 0 {sweep} {x} {y}"
        # The sine, in the arc's own sense, is negative beyond half a turn.
        wide = curve.turn[1].sign() < 0
        return f"A{radius} {radius} 0 {int(wide)} {sweep} {x} {y}"
