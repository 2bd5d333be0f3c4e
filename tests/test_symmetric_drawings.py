"""Symmetric drawings with rounded coordinates: equal numbers come in forms that are long to prove equal."""

from __future__ import annotations

from fractions import Fraction as Q

import pytest

import exactacq as xa
from exactacq import Scene, Terrain
from exactacq.auditing.audit import audit
from exactacq.numbers import sign
from exactacq.sensing.view_length import ViewLength


def test_a_line_of_sight_ends_on_the_arc_that_it_leads_to() -> None:
    """Two slots of a drawing with rounded coordinates; the robot leaves its line at an irrational place.

    The line to its aim meets the arc there at 1, in a form of which nobody can prove that it is 1: the audit
    ended in `Undecided`.
    """
    half = xa.Around(
        ("-10210069040179248047/4499999962616000000", "41722308545394573613/2249999981308000000")
    )
    other = xa.Around(
        ("-20542522194195534709/4500000774410000000", "21677877448767335327/900000154882000000")
    )
    slots = [
        xa.Outline(
            [
                ("-10.933674", "13.330595"),
                ("-1.694879", "17.157429", half),
                ("-2.842929", "19.929068"),
                ("-12.081725", "16.102234", 1),
            ]
        ),
        xa.Outline(
            [
                ("-13.229775", "18.873872"),
                ("-3.99098", "22.700707", other),
                ("-5.13903", "25.472345"),
                ("-14.377825", "21.645511", 1),
            ]
        ),
    ]
    scene = Scene(slots, terrain=Terrain(70, 51, (-17, -5)), radius=12)
    audit(xa.seed_spreader(scene, lookahead=False, target="visible"), samples=2)


def test_mirrored_ends_of_what_is_known_of_a_pad_are_not_compared() -> None:
    """Two pads of a grid that is turned by 45 degrees, drawn as two arcs each, R equal to a gap.

    Both ends of what is known are as far from the rest of the line, in two forms of which only a long height
    bound proves that they are equal: the audit ended in `Undecided`. Each is compared with the range alone.
    """
    low, high = "-1436310425971407/500000000000000", "-1321405574028593/500000000000000"
    pads = [
        xa.Outline([(a, str(-Q(high)), 1), (b, str(-Q(low)), 1)])
        for a, b in (
            (low, high),
            ("-976691425971407/500000000000000", "-861786574028593/500000000000000"),
        )
    ]
    terrain = Terrain("7.8404322", "7.8404332", ("-3.9202161", "-1.1625001"))
    run = xa.seed_spreader(Scene(pads, terrain=terrain, radius="39/40"))
    audit(run, samples=2)


def test_mirror_images_come_into_range_together(monkeypatch: pytest.MonkeyPatch) -> None:
    """The robot walks along the diagonal, the mirror axis of a bean with two petals beside it.

    Where they come into range is one number of degree 12, in two forms. That these are equal took a height
    bound of four million bits, some seven seconds; their minimal polynomials tell it at once.
    """
    monkeypatch.setattr(sign, "ZERO_TEST_BITS", 1 << 16)
    a, b, c, d = "18.255", "4.891", "8.791", "2.356"
    petals = [
        xa.Outline([(f"-{a}", b, "0.408"), (f"-{c}", d, "0.408")]),
        xa.Outline([(d, f"-{c}", "0.408"), (b, f"-{a}", "0.408")]),
    ]
    round_, bulge = xa.Around((0, 0)), "0.267949"
    bean = xa.Outline(
        [
            ("2.828427", "2.828427", bulge),
            ("-1.035276", "3.863703", round_),
            ("-3.863703", "1.035276", bulge),
            ("-2.828427", "-2.828427", bulge),
            ("1.035276", "-3.863703", round_),
            ("3.863703", "-1.035276", bulge),
        ]
    )
    run = xa.sightseer(Scene([*petals, bean], start=(7, 7), radius=14))
    first, second = (event.point for event in run.events if event.kind == "sight" and event.obstacle != 2)
    assert first == second and first.x == first.y


def test_a_view_along_the_tangent_of_two_mirrored_arcs_is_as_long_as_the_range() -> None:
    """The robot leaves its line where it loses what lies along that tangent.

    Near it the length changes as a root does, with an infinite slope, of which nothing could be told: a sweep
    without a look ahead ended in `Undecided`.
    """
    shapes = [
        xa.Outline([(4, 6), (4, 7, 1), (2, 7), (2, 6, Q(-1, 2))]),
        xa.Outline([(4, 12), (4, 11, -1), (2, 11), (2, 12, Q(1, 2))]),
        xa.Outline([(8, 6), (8, 5, -1), (6, 5), (6, 6, Q(1, 2))]),
    ]
    scene = Scene(shapes, start=(-3, -3), terrain=Terrain(12, 18, (-3, -3)), radius=5)
    audit(xa.seed_spreader(scene, lookahead=False), samples=2)


def test_nearly_straight_arcs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Bulges of 10^-6, as programs write them for straight lines: circles of a million times the size.

    Where a view past one of them to another is as long as the range, 350,000 lengths were computed.
    """
    values = []
    evaluate = ViewLength._value

    def counted(self: ViewLength, t: object, root: object) -> object:
        values.append(1)
        return evaluate(self, t, root)

    monkeypatch.setattr(ViewLength, "_value", counted)
    thousand = Q(1, 1000)
    shapes = [
        xa.Outline([(x * thousand, y * thousand, Q(bulge, 10**6)) for x, y, bulge in corners])
        for corners in (
            [
                (60104, 55861, 414214),
                (64347, 55861, 1),
                (71418, 62933, 414214),
                (71418, 67175, 1),
                (67175, 71418, 414214),
                (62933, 71418, 1),
                (55861, 64347, 414214),
                (55861, 60104, 10),
            ],
            [(37477, 79903, 1001000), (47376, 89803, 999990)],
            [(19092, 96874, 1), (30406, 108187, -300), (23335, 115258, 1000), (12021, 103945, 1)],
        )
    ]
    corner = Q("-61.619"), Q("-18.656755001")
    terrain = Terrain(Q("143.915547894"), Q("143.914755001"), corner)
    xa.seed_spreader(Scene(shapes, start=corner, terrain=terrain, radius=60), lookahead=False).sense()
    assert 0 < len(values) < 10_000


@pytest.mark.parametrize("off", [0, 1e-17, -3e-17, 1e-16, 1e-12])
def test_links_past_pins_that_are_nearly_in_a_row_and_their_mirror_images(off: float) -> None:
    """Their centres are rounded off one line, as of a hexagonal grid that a program draws.

    Of a link that nearly touches both of its ends, floats tell half of the digits of its length. By these it
    was not taken for the image of another one, and the lengths were roots of two polynomials of degree 20.
    """
    low = 0.21666666666666667
    rows = [(side * x, y) for side in (1, -1) for x, y in ((-0.25, -low), (-0.125, off))]
    pins = [xa.Circle(center, 0.01125) for center in [*rows, (0, low)]]
    graph = xa.visibility_graph(Scene(pins), 0.75)
    assert graph[0][4]["weight"] == graph[2][4]["weight"]
