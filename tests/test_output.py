"""Lengths as a person reads them: closed forms where they are short."""

from __future__ import annotations

from fractions import Fraction

import pytest

from exactacq import Length
from exactacq.files.whole_files import readable
from exactacq.output.report import console, run_report
from exactacq.scene.scene import Scene
from exactacq.scene.shapes import Circle
from exactacq.strategies.sightseer.strategy import sightseer


def angle(t: Fraction) -> Length:
    """The angle whose half has the tangent t."""
    return Length.arc(1, (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t))


@pytest.mark.parametrize(
    ("length", "texts"),
    [
        (Length(12), ("12",)),
        (Length.turns(1), ("2*pi", "≈ 6.28318530717959")),
        (angle(Fraction(1)), ("pi/2", "≈ 1.5707963267949")),
        (Length(Fraction(1, 4)), ("0.25",)),
        (Length(Fraction(1, 3)), ("1/3", "≈ 0.333333333333333")),
    ],
)
def test_short_forms_come_with_their_decimals(length: Length, texts: tuple[str, ...]) -> None:
    assert readable(length, 40, 15) == texts


def test_forms_of_huge_numbers_are_not_even_written_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """The digits of angles count too: those of a long run on arcs took a minute to write, to be dropped."""
    monkeypatch.setattr(Length, "__str__", lambda _: pytest.fail("written out"))
    long = Fraction(10**5000 + 1, 10**5000)
    assert readable(Length(long), 40, 15) == ("≈ 1",)
    assert readable(angle(long), 40, 15) == ("≈ 1.5707963267949",)
    assert readable(Length.turns(long), 40, 15) == ("≈ 6.28318530717959",)


def test_places_far_from_the_origin_are_told_apart(capsys: pytest.CaptureFixture[str]) -> None:
    x, y = 500_000, 5_400_000  # metres of a map
    console().print(run_report(sightseer(Scene([Circle((x + 4, y + 3), 3)], (x, y), radius=9))))
    assert "S = (500000, 5400000)" in (out := capsys.readouterr().out)
    assert "(500001.6, 5400001.2)" in out


def test_a_long_radius_is_told_once_to_be_rounded(capsys: pytest.CaptureFixture[str]) -> None:
    console().print(run_report(sightseer(Scene([], (0, 0), radius=Fraction(10**40 + 1, 10**39)))))
    assert "R ≈ 10.0000000000, 0 obstacles" in capsys.readouterr().out
