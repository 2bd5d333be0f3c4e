"""The documentation holds together: pages, links, scenes; and the page of claims says what was computed.

The build itself, which computes all pictures and verdicts, is a command of its own:
``sphinx-build -W -b html docs docs/_build/html``.
"""

from __future__ import annotations

import importlib
import json
import re
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from types import ModuleType

import pytest

import exactacq
from exactacq import Undecided
from exactacq.files import gallery
from exactacq.study.claims.model import Case, Claim, Finding, Outcome, Statement, Status, Subject, verdict
from exactacq.study.claims.tightness import Portion, Reach, Yardstick

DOCS = Path(__file__).parent.parent / "docs"
PAGES = {path.stem: path.read_text(encoding="utf-8") for path in DOCS.glob("*.md")}
LABELS = {label for text in PAGES.values() for label in re.findall(r"^\(([\w-]+)\)=$", text, re.MULTILINE)}
FENCE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
NAMED = re.compile(
    r"""(?:xa\.load|gallery\.scene)\(["']([^"'./]+)["']"""
    r"""|exactacq (?:explore|compare|check|gallery) ([a-z][\w-]*)(?![\w./-])"""
    r"""|scenes? `([^`]+)`"""
)


@pytest.fixture(scope="module")
def extension(monkeypatch_module: pytest.MonkeyPatch) -> ModuleType:
    module = importlib.import_module("claims_page")
    monkeypatch_module.setattr(module, "frames_of", partial(module.frames_of, fine=0))
    return module


@pytest.fixture(scope="module")
def monkeypatch_module() -> Iterator[pytest.MonkeyPatch]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(DOCS / "_ext")
        yield patch
    for name in ("claims_page", "generated", "cut_out", "tightness_page"):
        sys.modules.pop(name, None)


# -- pages -----------------------------------------------------------------------------------------


def listed(text: str) -> list[str]:
    """The pages in a page's tables of contents."""
    found = []
    for block in FENCE.findall(text):
        if block.startswith("```{toctree}"):
            entries = [line.strip() for line in block.splitlines()[1:-1] if not line.startswith(":")]
            found += [re.sub(r".*<(.*)>", r"\1", entry) for entry in entries if entry]
    return found


def slugs(text: str) -> set[str]:
    """The anchors that headings give."""
    headings = re.findall(r"^#+ (.*)$", FENCE.sub("", text), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken_links(text: str, made: set[str]) -> list[str]:
    """The local targets that are no page, no file, and not made by the build."""
    broken = []
    for target in LINK.findall(FENCE.sub("", text)):
        path, _, part = target.partition("#")
        if "://" in target or path.removeprefix("_generated/") in made:
            continue
        page = PAGES.get(path.removesuffix(".md")) if path.endswith(".md") else None
        known = page is not None or (path != "" and (DOCS / path).is_file()) or target.startswith("#")
        known = known or target in LABELS
        if not known or (part and part not in slugs(text if not path else page or "")):
            broken.append(target)
    return broken


def scenes_named(text: str) -> set[str]:
    """What a text calls a gallery scene, in code, on a command line, or as "scene `name`"."""
    return {next(filter(None, groups)) for groups in NAMED.findall(text)}


def test_every_page_is_listed_once() -> None:
    entries = [entry for text in PAGES.values() for entry in listed(text)]
    assert sorted(entries) == sorted(set(PAGES) - {"index"})


def test_no_page_takes_the_place_of_one_that_sphinx_makes() -> None:
    assert not set(PAGES) & {"search", "genindex", "py-modindex"}


@pytest.mark.parametrize("page", sorted(PAGES))
def test_links_resolve(page: str, extension: ModuleType) -> None:
    generated = importlib.import_module("generated")
    assert broken_links(PAGES[page], {*generated.PICTURES, *generated.TEXTS}) == []


def test_a_broken_link_is_found() -> None:
    text = "# Top\n[a](nowhere.md) [b](#top) [c](#bottom) ![d](_generated/x.svg)"
    text += " [e](formats.md#runs) [f](formats.md#x)"
    assert broken_links(text, set()) == ["nowhere.md", "#bottom", "_generated/x.svg", "formats.md#x"]
    assert "_generated/x.svg" not in broken_links(text, {"x.svg"})


@pytest.mark.parametrize("page", sorted(PAGES))
def test_scenes_that_are_named_exist(page: str) -> None:
    assert scenes_named(PAGES[page]) <= set(gallery.names())


def test_scenes_are_found_where_they_are_named() -> None:
    text = 'xa.load("one") `exactacq explore two --at 3` scene `three` xa.load("part.dxf")'
    text += " `exactacq check part.dxf`, `exactacq gallery`, and explore more"
    assert scenes_named(text) == {"one", "two", "three"}
    assert scenes_named(PAGES["figures"]) == {"figure1", "figure2", "figure3", "figure4"}


def test_everything_public_is_in_the_reference() -> None:
    documented = set(re.findall(r"^\.\. auto\w+:: (\w+)$", PAGES["api"], re.MULTILINE))
    assert documented == set(exactacq.__all__)


# -- stored results ----------------------------------------------------------------------------------


RESULTS = sorted((DOCS / "results").rglob("*.json"))


@pytest.mark.parametrize("path", RESULTS, ids=lambda path: path.stem)
def test_results_are_whole_and_name_what_made_them(path: Path, extension: ModuleType) -> None:
    result = json.loads(path.read_text(encoding="utf-8"))
    text = "\n".join(importlib.import_module("trust_page").section(result))
    assert re.fullmatch("[0-9a-f]{7,40}", result["version"])
    assert text.count("$ ") >= len(result["commands"]) > 0
    for command in result["commands"]:
        files = [DOCS.parent / name for name in re.findall(r"\btests/[\w/]+\.py", command)]
        assert "exactacq verify" in command or (files and all(file.is_file() for file in files))
    for row in result.get("rows", ()):
        assert len(row) == len(result["columns"])


def test_campaigns_are_told_as_one_with_what_is_open(extension: ModuleType) -> None:
    statement = {
        "claim": "L1", "statement": "printed", "called": "true", "held": 3, "failed": 1, "unanswered": 2
    }  # fmt: skip
    summary = {
        "statements": [statement, {**statement, "called": "false", "held": 50}],
        "scenes": {"passed": 5, "undecided": 1},
        "wrong": [],
        "open": [{"scene": f"sightseer:{k}", "what": "undecided", "why": "a tie"} for k in range(45)],
    }
    lines = list(importlib.import_module("trust_page")._campaigns([summary, {**summary, "open": []}]))
    assert lines[:3] == ["| passed | undecided |", "|---|---|", "| 10 | 2 |"]
    assert "The 1 statements that are called true held 6 times on single scenes, failed 2 times" in lines[4]
    assert lines[-3] == "| `sightseer:39` | undecided | a tie |" and lines[-1].startswith("5 more")


# -- how tight the bounds are ------------------------------------------------------------------------


def test_the_table_of_tightness_tells_exact_ratios_and_what_is_open(
    extension: ModuleType, tmp_path: Path
) -> None:
    page = importlib.import_module("tightness_page")
    tour = Yardstick("X|", "$a$", Subject.SIGHTSEER, half_of_the_length, Reach.ATTAINED, "one", lone, "why")
    sweep = Yardstick("Y", "b", Subject.SEED_SPREADER, lambda _: None, Reach.OPEN)
    page.write(tmp_path, [tour, sweep], [("squares", Subject.SIGHTSEER, squares(""))])
    rows = (tmp_path / "tightness.md").read_text(encoding="utf-8").splitlines()
    proved = f"[is 1]({page.ARGUMENT})"
    half = "1/2 = 0.500000"
    assert rows[2] == f"| X\\| | $a$ | {half} on `squares` | one | {proved} | `squares`: {half} |"
    assert rows[3] == "| Y | b | no scene speaks of it |  | open |  |"
    assert rows[-1] == "- *X\\|* ($a$): why"


def half_of_the_length(case: Case) -> Portion:
    return Portion(case.sightseer.length, case.sightseer.length * 2)


def lone() -> tuple[exactacq.Scene, ...]:
    return (gallery.scene("squares"),)


# -- the page of claims ----------------------------------------------------------------------------


def short(case: Case) -> Finding:
    """A statement that the squares hold and the circles break."""
    ratio = float(case.sightseer.length) / 30
    outcome = Outcome.HOLDS if ratio <= 1 else Outcome.FAILS
    return Finding(outcome, f"P = {case.sightseer.length}", ratio)


SHORT = Claim(
    "L9 (short)",
    "Lemma 9",
    Statement("P <= 30 * [one]", Subject.SIGHTSEER, short, counterexamples=("circles",)),
    Statement(
        "a `run` stops", Subject.SIGHTSEER, lambda _: Finding(Outcome.HOLDS, "it did"), argument="stops"
    ),
    note="see the_next|one",
)


def squares(_: str) -> Case:
    return Case(gallery.scene("squares"))


def circles(_: str) -> Case:
    return Case(gallery.scene("circles"))


def page_of(extension: ModuleType, claim: Claim, example: object) -> str:
    cases = (("sightseer scene 0", squares("")),)
    return extension.page(
        [(claim, [verdict(s, cases, example) for s in claim.statements])], 1, ["stops", "why"]
    )


def test_a_false_claim_and_what_holds_instead(extension: ModuleType) -> None:
    text = page_of(extension, SHORT, circles)
    assert "| [L9 (short)](#claim-l9-short) | P \\<= 30 \\* \\[one\\] | false | proved |" in text
    assert "(claim-l9-short)=\n\n## L9 (short)\n" in text
    assert "*False*: one case speaks of it; it fails on circles; the largest ratio is 1.423304." in text
    assert "- circles: P = 5 + 12\\*pi" in text
    assert "(_generated/scenes/circles-sightseer.svg)" in text
    assert "*Proved*: one case speaks of it." in text and "it did" not in text
    assert "[The argument](_generated/arguments/stops.md)" in text
    assert "see the\\_next\\|one" in text and "a `run` stops" in text
    assert listed(text) == ["_generated/arguments/stops", "_generated/arguments/why"]


def test_formulas_stay_as_they_are(extension: ModuleType) -> None:
    text = r"at most $n_0 \le 2$ * [one], `a_b`"
    assert extension.plain(text) == r"at most $n_0 \le 2$ \* \[one\], `a_b`"


def test_long_formulas_can_end_a_line(extension: ModuleType) -> None:
    """Before a plus sign, but not within brackets."""
    text = r"$P \le A + k (2n\,n_0 + p_{\max}) + 1.5 \sum p_i - 1$ for $n + 1$"
    assert extension.plain(text) == (
        r"$P \le A$ ${}+ k (2n\,n_0 + p_{\max})$ ${}+ 1.5 \sum p_i - 1$ for $n + 1$"
    )


def test_a_counterexample_can_be_played(extension: ModuleType, tmp_path: Path) -> None:
    text = page_of(extension, SHORT, circles)
    assert '<iframe src="played/circles-sightseer.html" title="The run of the Sightseer on circles"' in text
    assert text.count('loading="lazy"') == 1
    extension.write(tmp_path, [SHORT], 0, tmp_path)
    played = (tmp_path / "played" / "circles-sightseer.html").read_text()
    assert "Sightseer Strategy: circles" in played and "default-src 'none'" in played


def test_a_part_of_a_figure_is_drawn_large(extension: ModuleType, tmp_path: Path) -> None:
    """The part lies in its scene, and shows the obstacles that are numbered in it, in the order of visits."""
    for name, part in extension.cut_out.CUT_OUTS.items():
        run = extension.example(name).sightseer
        shown = dict(extension.cut_out.in_window(run, part))
        assert list(shown) == list(range(3, 13))
        extension.cut_out.draw(run, part, tmp_path / "part.svg")
        assert (tmp_path / "part.svg").read_text().count("<path") > len(shown)
        assert f"![A part of the figure of {name}](_generated/scenes/{name}-part.svg)" in "\n".join(
            extension.shown(name, Subject.SIGHTSEER)
        )


def test_a_verdict_is_computed_not_told(extension: ModuleType) -> None:
    """A counterexample that holds contradicts what the claim is called."""
    text = page_of(extension, SHORT, squares)
    assert "| not as called here | proved |" in text
    assert "*Not as called here*: one case speaks of it; the largest ratio is 0.800000." in text


def test_a_statement_that_nothing_speaks_of(extension: ModuleType) -> None:
    silent = Statement("so", Subject.SIGHTSEER, lambda _: Finding(Outcome.SILENT, "no"))
    text = page_of(extension, Claim("X", "p. 1", silent), circles)
    assert "*No scene spoke of it*: no case speaks of it." in text


def test_undecided_cases_are_passed_over(extension: ModuleType) -> None:
    def undecided(case: Case) -> Finding:
        raise Undecided("a tie")

    true = Statement("so", Subject.SIGHTSEER, undecided)
    assert extension.judge(true, [("a", squares(""))], squares).status is Status.UNTRIED
    false = Statement("so", Subject.SIGHTSEER, undecided, counterexamples=("squares",))
    with pytest.raises(Undecided):
        extension.judge(false, [], squares)


def test_what_is_written(extension: ModuleType, tmp_path: Path) -> None:
    (tmp_path / "arguments").mkdir()
    words = (
        "# It stops\n\n[why](../x.py), [see](other.md), [so](stops.md#x), [web](https://a.b) ![p](p.svg)\n"
    )
    (tmp_path / "arguments" / "stops.md").write_text(words)
    folder = tmp_path / "out"
    folder.mkdir()
    extension.write(folder, [SHORT], 2, tmp_path / "arguments")
    assert "*Proved*: 2 cases speak of it." in (folder / "verdicts.md").read_text()
    assert "<svg" in (folder / "scenes" / "circles-sightseer.svg").read_text()
    copied = (folder / "arguments" / "stops.md").read_text()
    assert copied == "# It stops\n\nwhy, see, [so](stops.md#x), [web](https://a.b) ![p](p.svg)\n"


def test_the_definitions_are_a_page_beside_the_arguments(extension: ModuleType, tmp_path: Path) -> None:
    (tmp_path / "arguments").mkdir()
    (tmp_path / "arguments" / "README.md").write_text("# All\n\n[rules](../definitions.md), [it](stops.md)\n")
    (tmp_path / "arguments" / "stops.md").write_text("# It stops\n\nBy (V2).\n")
    (tmp_path / "definitions.md").write_text("# Rules\n\nSee [it](arguments/stops.md), [x](../x.md).\n")
    folder = tmp_path / "out"
    folder.mkdir()
    extension.write(folder, [SHORT], 0, tmp_path / "arguments")
    text = (folder / "verdicts.md").read_text()
    assert "[definitions and rules](_generated/arguments/definitions.md)" in text
    contents = (folder / "arguments" / "README.md").read_text()
    assert "[rules](definitions.md), [it](stops.md)" in contents
    assert listed(contents) == ["definitions", "stops"]
    assert (folder / "arguments" / "definitions.md").read_text() == "# Rules\n\nSee [it](stops.md), x.\n"


def test_formulas_on_display_stand_alone(extension: ModuleType) -> None:
    text = "for $n$,\n$$P \\le A\n+ B$$\nwhere $A$"
    assert extension.portable(text, set()) == "for $n$,\n\n$$\nP \\le A + B\n$$\n\nwhere $A$"
