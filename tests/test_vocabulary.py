"""One vocabulary: what figures, tables and pages call things is in one table, and in the glossary."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from gallery_runs import gallery_run

import exactacq as xa
from exactacq import cli
from exactacq.output import vocabulary
from exactacq.output.animation.frames import frames_of
from exactacq.output.animation.page import page
from exactacq.output.figures.draw import figure
from exactacq.output.report_data import comparison_data, scene_data
from exactacq.output.vocabulary import Labels, Word
from exactacq.strategies.run import Run

ROOT = Path(__file__).parent.parent
COLOUR = re.compile(r"#[0-9a-f]{6}\b")
REMARK = r"R [=≈] .*|#1, #2, \.\.\.: order of visits|\d+ labels? left out|walked again \(inner line\)"
"""What legends say beside words: the radius, what signs mean, what is missing."""


def runs() -> list[Run]:
    """Runs that miss something, divert, stop early, or are cut by the border, and a complete one."""
    return [gallery_run(name) for name in ("circles", "m4", "m9", "m14", "m15", "e3", "case2")]


def test_legends_have_words_of_the_vocabulary_only() -> None:
    shown = set()
    for run in runs():
        for at in (None, float(run.length) / 2):
            shown |= {text.get_text() for text in figure(run, at).legends[0].get_texts()}
    own = {text for text in shown if not re.fullmatch(REMARK, text)}
    assert own <= set(Word), own - set(Word)
    assert len(own) > 15


def test_tables_have_words_of_the_vocabulary(capsys: pytest.CaptureFixture[str]) -> None:
    for command, words in {
        ("explore", "circles"): (Word.VISIT, Word.LEAVE, Word.HIT, Word.LINK, Word.ORDER, Word.LENGTH),
        ("explore", "m4"): (Word.UNVISITED, Word.UNAPPLIED),
        ("explore", "m14", "--strategy", "seed-spreader"): (Word.UNSEEN, Word.M_LINE),
        ("explore", "m15", "--strategy", "seed-spreader"): (Word.DIVERSION, Word.D, Word.Q),
        ("compare", "figure2"): (Word.VISITED, Word.ACQUIRED, Word.UNSEEN, Word.DIVERSION),
    }.items():
        assert cli.main(command) == 0
        out = capsys.readouterr().out
        assert all(word in out for word in words), command


def glossary(text: str) -> list[str]:
    """The terms that a part of the glossary explains."""
    blocks = re.findall(r"^```\{glossary\}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    return [line for block in blocks for line in block.splitlines() if line and not line.startswith(" ")]


def test_every_word_is_in_the_glossary() -> None:
    """By itself, beside another one, or with its symbol, as in "hit point H"."""
    terms = glossary((ROOT / "docs" / "glossary.md").read_text(encoding="utf-8"))
    known = {name for term in terms for name in (term, *term.split(", "))}
    known |= {
        part for name in known if (match := re.fullmatch(r"(.+) ([A-Z])", name)) for part in match.groups()
    }
    assert set(Word) - {Word.OBSTACLE} <= known, set(Word) - known


def test_the_glossary_tells_pictures_words_in_order() -> None:
    text = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    terms = glossary(text.partition("## In pictures and tables")[2].partition("\n## ")[0])
    assert terms == sorted(terms, key=str.casefold)
    assert len(terms) > 10


def test_colours_are_in_the_vocabulary_alone() -> None:
    """But for those of the page's buttons and lists, which are no things of a run."""
    output = ROOT / "exactacq" / "output"
    found = {
        path.name
        for path in output.rglob("*")
        if path.suffix in (".py", ".css", ".html", ".js") and COLOUR.search(path.read_text(encoding="utf-8"))
    }
    assert found == {"vocabulary.py", "page.css"}
    named = list(vocabulary.colours().values())
    assert all(COLOUR.fullmatch(colour) for colour in named)
    assert len(named) == len(set(named)) > 12


def test_decimals_stay_as_they_were_written() -> None:
    scene = xa.Scene([xa.Circle(("130.1", 0), "10.05")], ("0.5", "-2.25"), radius="130.1")
    run = xa.sightseer(scene)
    assert "R = 130.1" in repr(run)
    shown = [text.get_text() for text in figure(run, labels=Labels.NONE).legends[0].get_texts()]
    assert any(text.startswith("R = 130.1") for text in shown)
    assert '"radius":"130.1"' in page(run, frames_of(run, fine=0))
    assert scene_data(scene)["start"] == ["0.5", "-2.25"]
    assert comparison_data([run])["runs"][0]["radius"] == "130.1"
    with pytest.raises(xa.InvalidScene, match=r"\(130\.1, 0\)"):
        xa.sightseer(scene, start=("130.1", 0))
