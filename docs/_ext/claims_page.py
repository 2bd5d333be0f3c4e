"""The page of claims: every statement with its computed verdict, its argument and its counterexamples."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import cut_out

from exactacq.errors import Undecided
from exactacq.files import gallery
from exactacq.output.animation.frames import frames_of
from exactacq.output.animation.page import page as player
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
PLAYED = "played"
"""The folder of the pages that play a run: in the generated one, and beside the built page of claims."""
CONTENTS, DEFINITIONS = "README", "definitions"
"""The argument that lists the others, and the page beside their folder with the rules that they cite."""
FRAME = "width: 100%; height: 46rem; border: 1px solid #c9ccd0"
"""How the page that plays a run is framed."""
LONG = 40
"""Characters of formulas that are taken apart at the end of a line."""
DETAILS, FAILURES = 3, 5
"""Most findings, and most failing scenes, of one statement that the page quotes."""
_LINK = re.compile(r"(?<!!)\[([^\]\n]+)\]\(([^)\s]+)\)")
_DISPLAY = re.compile(r"\s*\$\$(.+?)\$\$\s*", re.DOTALL)
_HEADING = re.compile(r"^#+ .*$", re.MULTILINE)
_SPECIAL = re.compile(r"([\\*_<>\[\]|$#~])")
_KEPT = re.compile(r"(`[^`]*`|\$[^$]+\$)")
"""Code in backticks and formulas between dollars, which Markdown takes as they are."""


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
    (folder / PLAYED).mkdir()
    for name, subject in {(n, s.subject) for s in statements for n in s.counterexamples}:
        _show(run_on(example(name), subject), name, subject, folder)
    (folder / "arguments").mkdir()
    for name, text in texts.items():
        below = "\n".join(["", *_below(n for n in texts if n != CONTENTS)]) if name == CONTENTS else ""
        page_of_it = portable(text, set(texts)) + below
        (folder / "arguments" / f"{name}.md").write_text(page_of_it, encoding="utf-8")


def _show(run: Run, name: str, subject: Subject, folder: Path) -> None:
    """Write the figure of a counterexample's run, the part of it drawn large, and the page that plays it."""
    figures.save(run, folder / picture(name, subject))
    if name in cut_out.CUT_OUTS:
        cut_out.draw(run, cut_out.CUT_OUTS[name], folder / part_of(name))
    (folder / played(name, subject)).write_text(player(run, frames_of(run)), encoding="utf-8")


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
            yield from shown(name, statement.subject)
    if claim.note:
        yield from (plain(claim.note), "")


def shown(name: str, subject: Subject) -> Iterator[str]:
    """The figure of a counterexample, the part of it that is drawn large, and its run to be played."""
    caption = plain(f"The {STRATEGIES[subject]} on {name}: {gallery.names()[name]}")
    yield from (f"![{caption}]({FOLDER}/{picture(name, subject)})", "", caption, "")
    if name in cut_out.CUT_OUTS:
        words = plain(cut_out.CUT_OUTS[name].words)
        yield from (f"![A part of the figure of {name}]({FOLDER}/{part_of(name)})", "", words, "")
    title = f"The run of the {STRATEGIES[subject]} on {name}"
    yield from (
        "```{raw} html",
        f'<details style="margin-bottom: 1.2rem"><summary>Play this run ({name})</summary>',
        f'<iframe src="{played(name, subject)}" title="{title}" loading="lazy" style="{FRAME}"></iframe>',
        "</details>",
        "```",
        "",
    )


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


def part_of(scene: str) -> str:
    """Where the part of that picture is which is drawn large."""
    return f"scenes/{scene}-part.svg"


def played(scene: str, subject: Subject) -> str:
    """Where the page is that plays the run on a counterexample."""
    return f"{PLAYED}/{scene}-{subject.value}.html"


def plain(text: str) -> str:
    """Text in which Markdown sees no markup but code in backticks and formulas between dollars."""
    parts = _KEPT.split(" ".join(text.split()))
    return "".join(_parted(p) if k % 2 else _SPECIAL.sub(r"\\\1", p) for k, p in enumerate(parts))


def _parted(kept: str) -> str:
    """A long formula as several that begin with the plus signs outside of brackets: there a line may end."""
    if not kept.startswith("$") or len(kept) <= LONG:
        return kept
    found, depth = "", 0
    for k, sign in enumerate(kept):
        depth += (sign in "({") - (sign in ")}")
        found += "$ ${}+" if sign == "+" and depth == 0 and kept[k - 1] == " " else sign
    return found.replace(" $ $", "$ $")


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
