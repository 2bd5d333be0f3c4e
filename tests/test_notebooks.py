"""How results show themselves in notebooks."""

from __future__ import annotations

import html
import re
from pathlib import Path

import pytest

import exactacq as xa


@pytest.fixture(scope="module")
def run() -> xa.Run:
    """A run among obstacles of which one has a name that tries to be markup."""
    shapes = [xa.Circle((5, 0), 2), xa.Circle((12, 0), 3)]
    return xa.sightseer(xa.Scene(shapes, start=(0, 0), radius=20, name="</iframe><script>"))


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        (xa.Real("1/2"), r"$\displaystyle \frac{1}{2}$"),
        (xa.Real(2).sqrt(), r"$\displaystyle \sqrt{2}$"),
        (5 + xa.Length.turns(6), r"$\displaystyle 5 + 12 \pi$"),
        (sum((xa.Real(k).sqrt() for k in range(2, 60)), xa.Real(0)), r"$\approx 304.763177250268$"),
        (xa.Real(10) ** 200, r"$\approx 1.00000000000000e+200$"),
    ],
)
def test_numbers_are_formulas_while_they_are_short(number: xa.Real | xa.Length, expected: str) -> None:
    assert number._repr_latex_() == expected


def test_a_player_holds_the_whole_page(run: xa.Run, tmp_path: Path) -> None:
    player = run.animate()
    frame = player._repr_html_()
    (held,) = re.findall('srcdoc="([^"]*)"', frame)
    assert html.unescape(held) == player.html
    assert 'sandbox="allow-scripts"' in frame  # and not its own origin: it cannot reach the notebook
    assert "<script" not in frame
    player.save(tmp_path / "run.html")
    assert (tmp_path / "run.html").read_text("utf-8") == player.html
    with pytest.raises(xa.FormatError, match="html"):
        player.save(tmp_path / "run.txt")


def test_tables_and_bounds_show_themselves(run: xa.Run) -> None:
    table = run.event_table._repr_html_()
    assert table.count("<tr>") == 1 + len(run.events)
    assert "<td>2*acos" not in table  # floats, rounded for reading
    assert run.bound_table._repr_html_() in run._repr_html_()
    assert run.bounds[0]._repr_latex_().startswith(r"(1), Theorem 1, as printed: $\displaystyle 4 + 15 \pi$")
    assert run.events[2]._repr_html_().startswith("<p><b>hit</b> of obstacle 0 at (3, 0)")


def test_long_tables_are_cut() -> None:
    rows = xa.sightseer(xa.load("figure2")).event_table
    assert f"and {len(rows) - 100} rows more" in rows._repr_html_()
