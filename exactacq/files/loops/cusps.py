"""Joints that rounding made cross: where two edges leave a corner in (almost) one direction.

At a smooth joint the edges leave in opposite directions, and a rounding error tilts them without a second
contact: near the joint each stays on its own side. At a cusp, where both leave in one direction, a tilt of
the wrong sign makes them meet again close by. There the rounded bulge of an arc is moved to the safe side.
"""

from __future__ import annotations

from flint import fmpq

from exactacq.files.loops.chains import Chain, Corner, bend_of, distance_above
from exactacq.geometry.curves import Curve
from exactacq.geometry.intersections import contacts
from exactacq.geometry.points import Point, distance_sq
from exactacq.scene.shapes import edge

CUSP_SINE_SQ = fmpq(1, 10**6)
"""Squared sine of the angle between two edges below which a second contact near the joint is looked for."""
FIRST_STEP = fmpq(1, 2**50)
"""First change of a bulge, relative to it: as much as rounding may have moved it. Doubled on failure."""


def open_cusps(loop: Chain, tolerance: fmpq) -> int:
    """Alter bulges of computed arcs so that no cusp's edges meet again within the tolerance; how many were.

    An arc is computed if its bulge or an end is not the file's. A joint that cannot be mended by a move
    within the tolerance stays as it is, for the scene to refuse. The move of each bulge is added to its
    ``bulge_shift``. Linear in the edges.
    """
    return sum(_open_cusp(loop, i, tolerance) for i in range(len(loop.corners)))


def _open_cusp(loop: Chain, i: int, tolerance: fmpq) -> bool:
    n = len(loop.corners)
    if n < 2 or not _meet_again(loop, i, tolerance):
        return False
    for k in ((i - 1) % n, i):
        corner = loop.corners[k]
        bulge, reach = corner.bulge, distance_above(corner, loop.corners[(k + 1) % n])
        step, center = abs(bulge) * FIRST_STEP, corner.center
        computed = bool(bulge and (corner.bulge_shift or corner.shift or loop.corners[(k + 1) % n].shift))
        while computed and reach * step / 2 <= tolerance:
            for change in (step, -step):
                corner.bulge, corner.center = bulge + change, None
                if not any(_meet_again(loop, j % n, tolerance) for j in (k, k + 1)):
                    corner.bulge_shift += step
                    return True
            step *= 2
        corner.bulge, corner.center = bulge, center
    return False


def _meet_again(loop: Chain, i: int, tolerance: fmpq) -> bool:
    """Whether the edges before and after corner i leave it in one direction and meet again close to it."""
    n = len(loop.corners)
    before, here, after = loop.corners[i - 1], loop.corners[i], loop.corners[(i + 1) % n]
    if not (before.bulge or here.bulge):
        return False
    back, ahead = _leaving(here, before, -before.bulge), _leaving(here, after, here.bulge)
    cross, dot = back[0] * ahead[1] - back[1] * ahead[0], back[0] * ahead[0] + back[1] * ahead[1]
    if dot <= 0 or cross * cross > CUSP_SINE_SQ * dot * dot:
        return False
    joint = Point(here.x, here.y)
    ends = [joint, *([Point(before.x, before.y)] if n == 2 else [])]
    near = tolerance * tolerance
    for contact in contacts(_edge(before, here), _edge(here, after)):
        for point in (contact.start, contact.end):
            if not any(point == end for end in ends) and distance_sq(point, joint).compare(near) <= 0:
                return True
    return False


def _leaving(start: Corner, end: Corner, bulge: fmpq) -> tuple[fmpq, fmpq]:
    """The direction of the edge at its start: the chord turned by -2 atan(bulge), not normalised."""
    dx, dy = end.x - start.x, end.y - start.y
    cosine, sine = 1 - bulge * bulge, -2 * bulge
    return dx * cosine - dy * sine, dx * sine + dy * cosine


def _edge(start: Corner, end: Corner) -> Curve:
    return edge(Point(start.x, start.y), Point(end.x, end.y), bend_of(start, end))
