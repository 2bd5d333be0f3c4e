"""Symmetric drawings with rounded coordinates: equal numbers come in forms that are long to prove equal."""

from __future__ import annotations

from fractions import Fraction as Q

import pytest

import exactacq as xa
from exactacq import Scene, Terrain
from exactacq.auditing.audit import audit
from exactacq.numbers import sign


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
