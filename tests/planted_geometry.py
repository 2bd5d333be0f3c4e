"""Faults planted into contacts, places in loops and nearest points, each with a case that shows it."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import test_contact_oracle as contact_oracle
import test_locate_oracle as locate_oracle
import test_nearest_oracle as nearest_oracle
from drawn_curves import pairs
from moebius import Bow, Spot, Straight
from planting import Fault, Law, Planted
from test_locate_oracle import LOOPS, STILL, Corner, Loop, corners

from exactacq.geometry import boundary_index, coordinates, curves, intersections, loops, nearest_points

Place = tuple[int, int]

CONTACTS = Law(contact_oracle.check_contacts, pairs(), 6000)
LINES = Law(contact_oracle.check_line, pairs(), 3000)
SPANS = Law(contact_oracle.check_spans, pairs(), 3000)
POINTS = Law(contact_oracle.check_points, pairs(), 2000)
NEAREST = Law(nearest_oracle.check_nearest, pairs(), 2400)
WINDING = Law(locate_oracle.check_winding, locate_oracle.asked(locate_oracle.chains()), 2400)
LOCATE = Law(locate_oracle.check_locate, locate_oracle.asked(locate_oracle.loops), 2400)


def spot(place: Place) -> Spot:
    return Spot(*map(Fraction, place))


def root_spot(x: int, y: int, square: int, u: int, v: int) -> Spot:
    """The point (x, y) and so many times a root."""
    return Spot(*map(Fraction, (x, y, square, u, v)))


def segment(start: Place, end: Place) -> Straight:
    return Straight(spot(start), spot(end))


def bow(centre: Place, start: Place, end: Place | None = None, ccw: bool = True) -> Bow:
    """An arc, or without an end a circle."""
    square = Fraction((start[0] - centre[0]) ** 2 + (start[1] - centre[1]) ** 2)
    return Bow(spot(centre), square, spot(start), None if end is None else spot(end), ccw)


def asked(loop: str | tuple[Corner, ...], x: Any, y: Any) -> tuple[Loop, Spot]:
    """A loop, by name or by corners, and a place."""
    found = LOOPS[loop] if isinstance(loop, str) else loop
    return Loop(found, STILL), Spot(Fraction(x), Fraction(y))


HALF, ZERO = Fraction(1, 2), Fraction(0)
UNIT = bow((0, 0), (1, 0))
AXIS = segment((-2, 0), (2, 0))
VERTICAL_CHORD = corners((0, 0, 1), (0, 4, 1))

CONTACT_FAULTS = [
    Planted(
        "a tangent line misses the arc",
        LINES,
        (AXIS, bow((0, 1), (0, 2))),
        Fault(intersections, "_line_arc", "sign(discriminant) + 1", "2 * (discriminant > 0)"),
    ),
    Planted(
        "a line meets a clockwise arc where it meets the rest of its circle",
        LINES,
        (AXIS, bow((0, 0), (0, -1), (0, 1), ccw=False)),
        Fault(intersections, "_spans_at", "side < 0 if arc.ccw else side > 0", "side < 0"),
    ),
    Planted(
        "the second point of a line through an arc's end is forgotten",
        LINES,
        (AXIS, bow((0, 0), (1, 0), (0, -1))),
        Fault(intersections, "_line_arc", "if _spans_at(arc, w, direction, other) else", "if False else"),
    ),
    Planted(
        "a line through both ends of an arc meets it once",
        LINES,
        (AXIS, bow((0, 0), (1, 0), (-1, 0))),
        Fault(intersections, "_line_arc", "for p, v in on_line]", "for p, v in on_line[:1]]"),
    ),
    Planted(
        "a line through a segment's end misses it",
        LINES,
        (AXIS, segment((1, 0), (2, 2))),
        Fault(intersections, "_line_segment", "sides[0] * sides[1] > 0", "sides[0] * sides[1] >= 0"),
    ),
    Planted(
        "a ray through an arc's end meets its interior",
        SPANS,
        (segment((2, 0), (3, 0)), bow((0, 0), (1, 0), (0, 1))),
        Fault(coordinates, "between", "1 if strict else 0", "0"),
    ),
    Planted(
        "an arc of more than half a circle spans what lies behind both ends only",
        SPANS,
        (segment((1, 1), (3, 0)), bow((0, 0), (1, 0), (0, -1))),
        Fault(
            coordinates, "between", "after >= least or before >= least", "after >= least and before >= least"
        ),
    ),
    Planted(
        "opposite directions are the same",
        CONTACTS,
        (bow((0, 0), (1, 0), (-1, 0)), bow((0, 0), (1, 0), (0, -1))),
        Fault(coordinates, "same_direction", "sign(dot(a, b)) > 0", "True"),
    ),
    Planted(
        "a segment is open at its start",
        CONTACTS,
        (segment((1, 0), (3, 0)), UNIT),
        Fault(intersections, "_segment_arc", "after < 0 or", "after <= 0 or"),
    ),
    Planted(
        "where an arc ends on a segment it crosses it",
        CONTACTS,
        (AXIS, bow((0, 0), (1, 0), (0, -1))),
        Fault(intersections, "_segment_arc", "is_end or hit.tangent", "hit.tangent"),
    ),
    Planted(
        "an end of a segment is taken to lie on an arc",
        CONTACTS,
        (segment((2, 0), (3, 0)), UNIT),
        Fault(intersections, "_is_known_on", "and arc.on_circle(point)", ""),
    ),
    Planted(
        "a segment's end on an arc is computed again",
        CONTACTS,
        (Straight(Spot(HALF, ZERO, Fraction(3), ZERO, HALF), spot((2, 3))), UNIT),
        Fault(intersections, "_segment_arc", "segment.start if after == 0 else", ""),
    ),
    Planted(
        "an overlap ends at the farther end",
        CONTACTS,
        (segment((0, 0), (3, 0)), segment((1, 0), (4, 0))),
        Fault(
            intersections, "_collinear", "compare(raw(last), raw(a.end))", "compare(raw(a.end), raw(last))"
        ),
    ),
    Planted(
        "segments that run against each other overlap backwards",
        CONTACTS,
        (segment((0, 0), (3, 0)), segment((4, 0), (1, 0))),
        Fault(intersections, "_collinear", "else (b.end, b.start)", "else (b.start, b.end)"),
    ),
    Planted(
        "segments of one line that are apart overlap",
        CONTACTS,
        (segment((0, 0), (1, 0)), segment((2, 0), (3, 0))),
        Fault(intersections, "_collinear", "if order == forward else []", "if order else []"),
    ),
    Planted(
        "a segment that ends at another crosses it",
        CONTACTS,
        (AXIS, segment((1, 0), (1, 2))),
        Fault(intersections, "_segments", "(u_side, b.start)", "(1, b.start)"),
    ),
    Planted(
        "two circles meet once",
        CONTACTS,
        (UNIT, bow((1, 0), (2, 0))),
        Fault(intersections, "_arcs", "[:count]", "[:1]"),
    ),
    Planted(
        "circles that touch are said to cross",
        CONTACTS,
        (bow((0, 0), (0, 1)), bow((2, 0), (2, 1))),
        Fault(intersections, "_arcs", "end is None and count == 2", "end is None"),
    ),
    Planted(
        "circles meet on the line that is left of their middle",
        CONTACTS,
        (UNIT, bow((1, 0), (3, 0))),
        Fault(intersections, "_arcs", "square + a.radius_sq - b.radius_sq", "square"),
    ),
    Planted(
        "a start that two arcs share counts twice",
        CONTACTS,
        (bow((0, 0), (1, 0), (0, 1)), bow((0, 0), (1, 0), (-1, 0))),
        Fault(intersections, "common_angles", "if not same_direction(a_start, b_start) and", "if"),
    ),
    Planted(
        "of two arcs of one circle that meet at both ends one piece is found",
        CONTACTS,
        (bow((0, 0), (1, 0), (0, -1)), bow((0, 0), (-1, 0), (0, 1))),
        Fault(
            intersections,
            "common_angles",
            "starts.append((b.start, b_start))",
            "starts = starts or [(b.start, b_start)]",
        ),
    ),
    Planted(
        "arcs of one circle are compared as if both ran one way",
        CONTACTS,
        (bow((0, 0), (1, 0), (0, 1)), bow((0, 0), (0, 1), (1, 0), ccw=False)),
        Fault(intersections, "common_angles", "b = b.reversed()", "pass"),
    ),
    Planted(
        "circles about one centre are one",
        CONTACTS,
        (UNIT, bow((0, 0), (2, 0))),
        Fault(intersections, "contacts", "if a.radius_sq == b.radius_sq else []", ""),
    ),
    Planted(
        "an arc passes the rest of its circle",
        POINTS,
        (segment((0, -1), (3, 0)), bow((0, 0), (1, 0), (-1, 0))),
        Fault(curves, "Arc.passes", " and self.contains(point)", ""),
    ),
    Planted(
        "an arc passes its chord",
        POINTS,
        (segment((0, 0), (3, 0)), bow((0, 0), (1, 0), (-1, 0))),
        Fault(curves, "Arc.passes", "self.on_circle(point) and ", ""),
    ),
    Planted(
        "a segment passes its line",
        POINTS,
        (segment((3, 0), (4, 1)), AXIS),
        Fault(curves, "Segment.passes", " or not self.contains(point)", ""),
    ),
    Planted(
        "balls prove that an arc does not pass what it does",
        POINTS,
        (segment((0, -1), (0, -2)), bow((0, 0), (1, 0), (-1, 0), ccw=False)),
        Fault(curves, "Arc.may_pass", "side if self.ccw else -side", "side"),
    ),
]

LOCATION_FAULTS = [
    Planted(
        "an edge that ends level with the point crosses the ray",
        WINDING,
        asked("leaf", -1, 0),
        Fault(loops, "winding", "int(to_height > 0)", "int(to_height >= 0)"),
    ),
    Planted(
        "a vertical chord has no side",
        WINDING,
        asked(VERTICAL_CHORD, 0, 2),
        Fault(loops, "winding", "sign(chord[0]) or -sign(chord[1])", "sign(chord[0])"),
    ),
    Planted(
        "a level chord has no side",
        WINDING,
        asked("disc of two halves", 0, 0),
        Fault(loops, "winding", "sign(chord[0]) or -sign(chord[1])", "-sign(chord[1])"),
    ),
    Planted(
        "what lies between chord and arc is on the other side",
        WINDING,
        asked("disc of two halves", 0, -1),
        Fault(loops, "winding", "turns -= side if", "turns += side if"),
    ),
    Planted(
        "a point of an arc is within it",
        WINDING,
        asked("disc of two halves", 0, -2),
        Fault(loops, "winding", "if inside == 0:", "if False:"),
    ),
    Planted(
        "the ends of a segment do not belong to it",
        WINDING,
        asked("square", 4, 4),
        Fault(loops, "_meets_origin", "sign(dot(start, end)) <= 0", "sign(dot(start, end)) < 0"),
    ),
    Planted(
        "the far side of a room is free",
        LOCATE,
        asked("square", 9, 9),
        Fault(loops, "locate", "Location.OUTSIDE if ccw else Location.INSIDE", "Location.OUTSIDE"),
    ),
    Planted(
        "edges to the west are left out by their boxes, those to the east are not",
        LOCATE,
        asked("gear", 46, -2),
        Fault(boundary_index, "BoundaryIndex._meeting", "right >= x - dx", "right <= x + dx"),
    ),
    Planted(
        "edges beneath the ray are left out by their upper sides",
        LOCATE,
        asked("gear", 46, -2),
        Fault(boundary_index, "BoundaryIndex._meeting", "high >= y - dy", "low >= y - dy"),
    ),
]

NEAREST_FAULTS = [
    Planted(
        "an end whose curve leaves along the other is no minimum",
        NEAREST,
        (AXIS, bow((0, 2), (0, 1), (1, 2))),
        Fault(nearest_points, "_from_end", "sign(dot(rise, into)) >= 0", "sign(dot(rise, into)) > 0"),
    ),
    Planted(
        "an end whose curve leaves along a circle is no minimum",
        NEAREST,
        (segment((0, 2), (2, 2)), UNIT),
        Fault(nearest_points, "_from_end", "sign(dot(ray, into)) < 0", "sign(dot(ray, into)) <= 0"),
    ),
    Planted(
        "an end above the end of a segment has a foot there",
        NEAREST,
        (segment((0, 0), (2, 0)), segment((2, 1), (3, 2))),
        Fault(nearest_points, "_from_end", "sign(square - t) <= 0", "sign(square - t) < 0"),
    ),
    Planted(
        "the smaller circle's far side is taken for the near one",
        NEAREST,
        (UNIT, bow((1, 0), (4, 0))),
        Fault(nearest_points, "_inner_pairs", "-1 if apart or a.radius_sq < b.radius_sq", "-1 if apart"),
    ),
    Planted(
        "circles that cross have a nearest pair",
        NEAREST,
        (UNIT, bow((1, 0), (2, 0))),
        Fault(nearest_points, "_inner_pairs", "4 * a.radius_sq * b.radius_sq) < 0", "4 * a.radius_sq) < -99"),
    ),
    Planted(
        "clockwise arcs lead the other way from their ends",
        NEAREST,
        (segment((2, 1), (3, 1)), bow((0, 0), (1, 0), (0, -1), ccw=False)),
        Fault(nearest_points, "_ends", "1 if curve.ccw else -1", "1"),
    ),
    Planted(
        "the far side of a circle counts as near a line",
        NEAREST,
        (segment((-2, 3), (2, 3)), UNIT),
        Fault(nearest_points, "_segment_to_arc", "- arc.radius_sq) < 0", "- arc.radius_sq) > 0"),
    ),
    Planted(
        "segments that face each other in a point only have a common piece",
        NEAREST,
        (segment((1, 0), (2, 0)), segment((0, 1), (1, 1))),
        Fault(nearest_points, "_parallel", "ahead(a.start, last) <= 0", "ahead(a.start, last) < 0"),
    ),
    Planted(
        "a piece of parallel segments begins at the earlier start",
        NEAREST,
        (segment((0, 0), (3, 0)), segment((1, 1), (4, 1))),
        Fault(nearest_points, "_parallel", "if side < 0:", "if side > 0:"),
    ),
    Planted(
        "the slope of a steep direction is that of a flat one",
        NEAREST,
        (
            Straight(root_spot(0, 0, 2, 0, 0), root_spot(0, 0, 2, 1, 3)),
            Straight(root_spot(0, 0, 2, 2, 0), root_spot(0, 0, 2, 3, 3)),
        ),
        Fault(
            nearest_points,
            "_heading",
            "(slope * unit, unit) if steep else (unit, slope * unit)",
            "(unit, slope * unit)",
        ),
    ),
    Planted(
        "a family of arcs runs against its first",
        NEAREST,
        (bow((0, 0), (1, 0), (0, 1)), bow((0, 0), (0, 2), (2, 0), ccw=False)),
        Fault(nearest_points, "_concentric", "arc if arc.ccw == a.ccw else arc.reversed()", "arc"),
    ),
    Planted(
        "arcs about one centre that share one direction have a common piece",
        NEAREST,
        (bow((0, 0), (1, 0), (0, 1)), bow((0, 0), (0, 2), (-2, 0))),
        Fault(nearest_points, "_concentric", "if start is end and", "if False and"),
    ),
    Planted(
        "an end at a circle's centre has one nearest point",
        NEAREST,
        (segment((0, 0), (3, 0)), bow((0, 0), (0, 1), (-1, 0))),
        Fault(nearest_points, "_from_end", "if sign(square) == 0:", "if sign(square) < 0:"),
    ),
]
