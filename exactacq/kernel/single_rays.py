"""What a ray from a place meets in the very direction of events, in floats with bounds."""

from __future__ import annotations

from math import inf

from exactacq.kernel.bounded import UNIT, WIDEN, cross_sign, dot, dot_sign, product, quotient
from exactacq.kernel.images import STRAIGHT
from exactacq.kernel.radial_faces import RadialFaces
from exactacq.kernel.radial_sweep import NOTHING, FaceSweep


def met(sweep: FaceSweep, rank: int, here: list[int], vertices: int) -> tuple[bool, int, list[int], int]:
    """What the ray in a direction meets: whether that is certain, the first face that it does not pass at an
    end, the events before that and within range, nearest first, and whether the face is within range (1),
    beyond (-1) or that is open.

    *here* are events that are the place itself; of others that are no vertices nothing is known.
    """
    faces = sweep.faces
    events = sweep.events(rank)
    x, y, b = events[0].x, events[0].y, events[0].bound
    struck, low, high = NOTHING, inf, inf
    rest = inf
    for face in sweep.covering(rank):
        m, e = faces.way(face, x, y, b)
        if not e < inf:
            return False, NOTHING, [], 0
        e = e * WIDEN + UNIT * abs(m)
        if m + e < high:
            rest = min(rest, low)
            struck, low, high = face.number, m - e, m + e
        elif m - e < rest:
            rest = m - e
    if struck != NOTHING and not rest > high:
        return False, NOTHING, [], 0
    square, square_bound = dot(x, y, b, x, y, b)
    reached = -inf
    found: list[int] = []
    ways: list[tuple[float, float, int]] = []
    for one in events:
        event = one.number
        if event in here:
            continue
        if event >= vertices:
            return False, NOTHING, [], 0
        u, v, e = faces.offset(event)
        m, e = dot(u, v, e, x, y, b)
        m, e = quotient(m, e, square, square_bound)
        e = e * WIDEN + UNIT * abs(m)
        ways.append((m - e, m + e, event))
    ways.sort()
    for first, last, event in ways:
        if not first > reached:
            return False, NOTHING, [], 0
        reached = last
        if first > high:
            break
        u, v, e = faces.offset(event)
        inside = faces.reach(u, v, e)
        if inside < 0:
            break
        if inside == 0 or not last < low:
            return False, NOTHING, [], 0
        found.append(event)
    inside = 0
    if struck != NOTHING:
        m, e = faces.way(faces.faces[struck], x, y, b)
        px, p = product(m, e, x, b)
        py, q = product(m, e, y, b)
        inside = faces.reach(px, py, max(p, q))
    return True, struck, found, inside


def blocks(sweep: FaceSweep, rank: int, vertex: int, along: bool) -> int:
    """Whether the ray in a direction leads into the obstacle at a vertex between straight edges; 0 if open.

    With *along*, or past the other end of one of these edges, it comes along that edge: then it does if the
    corner is reflex. Along an edge that leads on it is free. Otherwise it does if it leaves between the way
    on and the way back.
    """
    faces = sweep.faces
    lead = sweep.events(rank)[0]
    x, y, b = lead.x, lead.y, lead.bound
    images = faces.images
    before, following = images[vertex].previous, images[vertex].following
    if images[vertex].kind != STRAIGHT or images[before].kind != STRAIGHT:
        return 0
    u, v, p = difference(faces, before, vertex)
    s, t, q = difference(faces, vertex, following)
    turn = cross_sign(u, v, p, s, t, q)
    if along or turn == 0:
        return -turn
    if _is_on(sweep, rank, before):
        ahead = dot_sign(x, y, b, u, v, p)
        return 0 if ahead == 0 else -turn if ahead > 0 else -1
    if _is_on(sweep, rank, following):
        ahead = dot_sign(x, y, b, s, t, q)
        return 0 if ahead == 0 else -turn if ahead < 0 else -1
    left, right = cross_sign(s, t, q, x, y, b), cross_sign(x, y, b, -u, -v, p)
    if turn > 0:
        return min(left, right) if left and right else -1 if left < 0 or right < 0 else 0
    return max(left, right) if left and right else 1 if left > 0 or right > 0 else 0


def _is_on(sweep: FaceSweep, rank: int, vertex: int) -> bool:
    """Whether a vertex is known to lie in a direction."""
    event = sweep.faces.found(vertex)
    return event is not None and event.rank == rank


def difference(faces: RadialFaces, a: int, b: int) -> tuple[float, float, float]:
    """The vector between two vertices, with a bound for both components."""
    x, y, p = faces.offset(a)
    u, v, q = faces.offset(b)
    s, t = u - x, v - y
    return s, t, (p + q + UNIT * (abs(s) + abs(t))) * WIDEN
