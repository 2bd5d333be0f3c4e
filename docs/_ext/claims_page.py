"""The page of claims: every statement with its computed verdict, its argument and its counterexamples."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

from exactacq.errors import Undecided
from exactacq.files import gallery
from exactacq.output.figures import draw as figures
from exactacq.strategies.run import Run
from exactacq.study.claims.model import (
    Case,
    Claim,
    Finding,
    Outcome,
    Statement,
    Status,
    Subject,
    Verdict,
    verdict,
)
from exactacq.study.random_scenes import random_scene

STRATEGIES = {Subject.SIGHTSEER: "Sightseer", Subject.SEED_SPREADER: "Seed Spreader"}
FOLDER = "_generated"
"""The generated folder, as the page of claims sees it."""
CONTENTS, DEFINITIONS = "README", "definitions"
"""The argument that lists the others, and the page beside their folder with the rules that they cite."""
DETAILS, FAILURES = 3, 5
"""Most findings, and most failing scenes, of one statement that the page quotes."""
_LINK = re.compile(r"(?<!!)\[([^\]\n]+)\]\(([^)\s]+)\)")
_DISPLAY = re.compile(r"\s*\$\$(.+?)\$\$\s*", re.DOTALL)
_HEADING = re.compile(r"^#+ .*$", re.MULTILINE)
_SPECIAL = re.compile(r"([\\*_<>\[\]|$#~])")


@cache
def example(name: str) -> Case:
    """A gallery scene; all pages share its runs."""
    return Case(gallery.scene(name))


def write(folder: Path, claims: Sequence[Claim], count: int, arguments: Path) -> None:
    """Judge the claims, and write verdicts.md, the pictures and the arguments that it names into a folder.

    Statements that gallery scenes do not refute are tried on *count* random scenes of their kind.
    *arguments* is where the written proofs are; each becomes a page, and so do the definitions beside it.
    """
    cases = {
        subject: [
            (f"{subject.value} scene {seed}", Case(random_scene(subject, seed))) for seed in range(count)
        ]
        for subject in Subject
    }
    judged = [(claim, [judge(s, cases[s.subject], example) for s in claim.statements]) for claim in claims]
    written = [*sorted(arguments.glob("*.md")), *arguments.parent.glob(f"{DEFINITIONS}.md")]
    texts = in_reading_order({path.stem: path.read_text(encoding="utf-8") for path in written})
    (folder / "verdicts.md").write_text(page(judged, count, list(texts)), encoding="utf-8")
    statements = [statement for claim in claims for statement in claim.statements]
    (folder / "scenes").mkdir()
    for name, subject in {(n, s.subject) for s in statements for n in s.counterexamples}:
        figures.save(run_on(example(name), subject), folder / picture(name, subject))
    (folder / "arguments").mkdir()
    for name, text in texts.items():
        below = "\n".join(["", *_below(n for n in texts if n != CONTENTS)]) if name == CONTENTS else ""
        page_of_it = portable(text, set(texts)) + below
        (folder / "arguments" / f"{name}.md").write_text(page_of_it, encoding="utf-8")


def judge(
    statement: Statement, cases: Iterable[tuple[str, Case]], examples: Callable[[str], Case]
) -> Verdict:
    """The verdict, silent on random cases with a comparison beyond the library's limits."""
    check = statement.check
    if check is None or statement.is_called_false:
        return verdict(statement, cases, examples)

    def guarded(case: Case) -> Finding:
        try:
            return check(case)
        except Undecided:
            return Finding(Outcome.SILENT)

    return verdict(replace(statement, check=guarded), cases, examples)


def run_on(case: Case, subject: Subject) -> Run:
    """The run that a statement speaks of."""
    return case.sightseer if subject is Subject.SIGHTSEER else case.spreader


# -- text ------------------------------------------------------------------------------------------


def page(judged: Sequence[tuple[Claim, Sequence[Verdict]]], count: int, arguments: Sequence[str]) -> str:
    """The text that the page of claims includes; *arguments*, or their contents, are the pages below it."""
    lines = [f"When these pages were built, {count} random scenes of each kind were tried.", ""]
    lines += [_tally(verdicts[0].status for _, verdicts in judged), ""]
    if DEFINITIONS in arguments:
        link = f"[definitions and rules]({FOLDER}/arguments/{DEFINITIONS}.md)"
        lines += [f"The arguments cite numbered {link} of the world, of sight and of both strategies.", ""]
    lines += _overview(judged)
    for claim, verdicts in judged:
        lines += _section(claim, verdicts)
    names = [CONTENTS] if CONTENTS in arguments else arguments
    lines += _below(f"{FOLDER}/arguments/{name}" for name in names)
    return "\n".join(lines) + "\n"


def _below(names: Iterable[str]) -> list[str]:
    """The pages below a page."""
    return ["```{toctree}", ":hidden:", "", *names, "```", ""]


def _tally(statuses: Iterable[Status]) -> str:
    """How many statements came out how."""
    counts = Counter(statuses)
    parts = (f"{status.value} {counts[status]}" for status in Status if counts[status])
    return f"{counts.total()} claims, as printed: {', '.join(parts)}."


def _overview(judged: Sequence[tuple[Claim, Sequence[Verdict]]]) -> Iterator[str]:
    yield from (
        "## All claims",
        "",
        "| claim | statement | as printed | corrected |",
        "| --- | --- | --- | --- |",
    )
    for claim, (printed, *rest) in judged:
        corrected = rest[0].status.value if rest else ""
        link = f"[{plain(claim.name)}](#{anchor(claim)})"
        yield f"| {link} | {plain(claim.printed.text)} | {printed.status.value} | {corrected} |"
    yield ""


def _section(claim: Claim, verdicts: Sequence[Verdict]) -> Iterator[str]:
    yield from (
        f"({anchor(claim)})=",
        "",
        f"## {plain(claim.name)}",
        "",
        f"*Place: {plain(claim.place)}*",
        "",
    )
    headings = ("As printed", "What holds instead")
    for heading, statement, found in zip(headings, claim.statements, verdicts, strict=False):
        yield from (f"**{heading}.** {plain(statement.text)}", "")
        yield from (f"*{found.status.value.capitalize()}*: {_numbers(found)}", "")
        yield from (f"- {plain(detail)}" for detail in _telling(found)[:DETAILS])
        yield ""
        if statement.argument is not None:
            yield from (f"[The argument]({FOLDER}/arguments/{statement.argument}.md)", "")
        for name in statement.counterexamples:
            caption = plain(f"The {STRATEGIES[statement.subject]} on {name}: {gallery.names()[name]}")
            yield from (f"![{caption}]({FOLDER}/{picture(name, statement.subject)})", "", caption, "")
    if claim.note:
        yield from (plain(claim.note), "")


def _telling(found: Verdict) -> list[str]:
    """What was found in trials and where the statement fails; that it holds somewhere says little."""
    telling = tuple(f"{name}: " for name in (*found.failures, "trial"))
    return [detail for detail in found.details if detail.startswith(telling)]


def _numbers(found: Verdict) -> str:
    """What was tried, and how close a bound was to fail."""
    if found.status is Status.UNTRIED:
        return "no case speaks of it."
    words = ["one case speaks of it" if found.tried == 1 else f"{found.tried} cases speak of it"]
    if found.failures:
        more = ", …" if len(found.failures) > FAILURES else ""
        words.append(f"it fails on {plain(', '.join(found.failures[:FAILURES]))}{more}")
    if found.worst is not None:
        words.append(f"the largest ratio is {found.worst:.6f}")
    return "; ".join(words) + "."


def anchor(claim: Claim) -> str:
    """The label of a claim's section."""
    return "claim-" + re.sub(r"[^a-z0-9]+", "-", claim.name.lower()).strip("-")


def picture(scene: str, subject: Subject) -> str:
    """Where the picture of a counterexample is, below the generated folder."""
    return f"scenes/{scene}-{subject.value}.svg"


def plain(text: str) -> str:
    """Text in which Markdown sees no markup but code in backticks."""
    parts = " ".join(text.split()).split("`")
    return "`".join(_SPECIAL.sub(r"\\\1", part) if k % 2 == 0 else part for k, part in enumerate(parts))


def portable(text: str, known: set[str]) -> str:
    """An argument as a page: formulas on display stand alone, links lead to pages or are plain words.

    All pages are in one folder. Headings are in plain words too: they are shown where formulas are not set.
    """

    def displayed(match: re.Match[str]) -> str:
        return f"\n\n$$\n{' '.join(match[1].split())}\n$$\n\n"

    def linked(match: re.Match[str]) -> str:
        target, hash_sign, part = match[2].partition("#")
        if "://" in target or not target:
            return match[0]
        name = target.removeprefix("../").removeprefix("arguments/")
        is_page = name.endswith(".md") and name[:-3] in known
        return f"[{match[1]}]({name}{hash_sign}{part})" if is_page else match[1]

    text = _LINK.sub(linked, _DISPLAY.sub(displayed, text))
    return _HEADING.sub(lambda match: match[0].replace("$", "").replace("\\ge", "≥"), text)


def in_reading_order(texts: dict[str, str]) -> dict[str, str]:
    """The arguments in the order in which their contents name them, then the others."""
    contents = texts.get(CONTENTS, "")
    places = {name: max(contents.find(f"{before}{name}.md)") for before in "(/") for name in texts}
    order = sorted(texts, key=lambda name: (name != CONTENTS, places[name] < 0, places[name]))
    return {name: texts[name] for name in order}
