"""Parameters at which the lines of a family pass points and touch circles, in floats with bounds.

In the family's frame (see `exactacq.kernel.surroundings`), with (k, a) a point or centre, r the circle's
radius and K the span, the parameters are

- turning, and normals of an arc: a / k; for a circle (a w +- r k) / (k w -+ r a) with w = sqrt(k^2 + a^2 -
  r^2);
- rolling: the roots of (q + k) t^2 - 2 a t + (q - k) = 0 with q = K, or K +- r for circles: with
  w = +-sqrt(a^2 + k^2 - q^2) they are (a + w) / (q + k) = (q - k) / (a - w), and the form is taken in which
  the sum of a and w does not cancel;
- sliding: k / K, for circles (k +- r) / K.

An event is a `BoundLine`: an interval that contains the parameter, what is passed (see
`exactacq.visibility.line_families.Sector.exact`), and whether such a line exists for certain.
"""

from __future__ import annotations

from math import inf

from exactacq.kernel.bound_lines import BoundLine
from exactacq.kernel.bounded import UNIT, WIDEN, product, quotient, root, total
from exactacq.kernel.images import CONVEX, ROLLING, SLIDING
from exactacq.kernel.surroundings import APART, Surroundings


def line_events(around: Surroundings, corner: int, low: float, high: float) -> list[BoundLine]:
    """The events between *low* and *high* of all vertices but *corner*, and of convex arcs not at the
    contact.

    What may lie there is included.
    """
    found: list[BoundLine] = []
    kind, span, wide = around.frame.kind, around.span, around.span_bound
    near, images = around.near, around.images
    vertices = near.vertices
    far = max(abs(low), abs(high)) * WIDEN
    n = -1
    for spot in around.spots:
        n += 1
        k, a, e = spot.x, spot.y, spot.bound
        if kind != ROLLING and kind != SLIDING and abs(a) - e > (abs(k) + e) * far:
            continue
        v = vertices[n]
        if v == corner or images[v].full:
            continue
        if kind == ROLLING:
            _roll(found, a, e, k, e, span, wide, v, 0, low, high)
        elif kind == SLIDING:
            _note(found, k, e, span, wide, v, 0, 0, True, low, high)
        else:
            _note(found, a, e, k, e, v, 0, 0, True, low, high)
    for n in range(len(near.arcs)):
        j = near.arcs[n]
        c = near.edges[j]
        if images[c].kind != CONVEX or around.place[j] != APART:
            continue
        center = around.centers[n]
        k, a, e = center.x, center.y, center.bound
        r, r_bound = around.radius(c)
        if kind == ROLLING:
            for side in (1, -1):
                q, q_bound = total(span, wide, side * r, r_bound)
                _roll(found, a, e, k, e, q, q_bound, c, side, low, high)
        elif kind == SLIDING:
            for sign in (1, -1):
                top, bound = total(k, e, sign * r, r_bound)
                _note(found, top, bound, span, wide, c, 1, sign, True, low, high)
        else:
            _touch(found, a, e, k, e, r, r_bound, c, low, high)
    return found


def _roll(
    found: list[BoundLine],
    a: float,
    ae: float,
    k: float,
    ke: float,
    q: float,
    qe: float,
    number: int,
    side: int,
    low: float,
    high: float,
) -> None:
    """Both roots of (q + k) t^2 - 2 a t + (q - k) = 0."""
    plus, pe = total(q, qe, k, ke)
    minus, me = total(q, qe, -k, ke)
    left, le = product(a, ae, a, ae)
    right, re = product(plus, pe, minus, me)
    under, ue = total(left, le, -right, re)
    if -under > ue:
        return
    sure = under > ue
    w, we = root(under, ue)
    for sign in (1, -1):
        # Where nothing is known of w but that it is small, a and w may cancel; then the event is not sure.
        if (a >= 0.0) == (sign > 0):
            top, te = total(a, ae, sign * w, we)
            _note(found, top, te, plus, pe, number, side, sign, sure, low, high)
        else:
            below, be = total(a, ae, -sign * w, we)
            _note(found, minus, me, below, be, number, side, sign, sure, low, high)


def _touch(
    found: list[BoundLine],
    a: float,
    ae: float,
    k: float,
    ke: float,
    r: float,
    re: float,
    number: int,
    low: float,
    high: float,
) -> None:
    """The two lines through the centre that touch a circle."""
    square, square_bound = product(a, ae, a, ae)
    other, other_bound = product(k, ke, k, ke)
    size, size_bound = total(square, square_bound, other, other_bound)
    right, right_bound = product(r, re, r, re)
    under, ue = total(size, size_bound, -right, right_bound)
    if -under > ue:
        return
    sure = under > ue
    w, we = root(under, ue)
    wa, wae = product(w, we, a, ae)
    wk, wke = product(w, we, k, ke)
    ra, rae = product(r, re, a, ae)
    rk, rke = product(r, re, k, ke)
    top, te = total(wa, wae, rk, rke)
    below, be = total(wk, wke, -ra, rae)
    _note(found, top, te, below, be, number, 1, 1, sure, low, high)
    top, te = total(wa, wae, -rk, rke)
    below, be = total(wk, wke, ra, rae)
    _note(found, top, te, below, be, number, 1, -1, sure, low, high)


def _note(
    found: list[BoundLine],
    top: float,
    te: float,
    below: float,
    be: float,
    number: int,
    side: int,
    sign: int,
    sure: bool,
    low: float,
    high: float,
) -> None:
    """Note the event with the parameter top / below, unless it certainly lies outside.

    Its interval is rounded outward: the bound is widened by more than the two roundings take.
    """
    far = max(abs(low), abs(high))
    if abs(top) - te > (abs(below) + be) * far * WIDEN:
        return
    m, e = quotient(top, te, below, be)
    if not e < inf:
        found.append(BoundLine(-inf, inf, number, side, sign, False, None))
        return
    e = e * WIDEN + UNIT * abs(m)
    first, last = m - e, m + e
    if last < low or first > high:
        return
    found.append(BoundLine(first, last, number, side, sign, sure, None))
