"""Every claim of the paper, tried: its statements come out as the registry calls them.

A statement called false fails exactly on each of its scenes. Any other holds on the gallery's scenes and on
random ones, and at least one of them spoke of it. Runs are made once for each scene and shared.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest
from nightly import some

from exactacq import Length
from exactacq.auditing.bounds import clipped_distance
from exactacq.files import gallery
from exactacq.files.octagons import random_octagons
from exactacq.study.claims import CLAIMS, Case, Claim, Statement, Status, Subject, verdict
from exactacq.study.claims.tallies import bounds_flaw
from exactacq.study.random_scenes import random_scene

SEEDS = some(range(24), 6)
PRINTED = {"(5)", "(6)", "(9)", "(10)", "(11)"}
RADII = (4, 10)
"""From short to long for eighteen octagons."""
ARGUMENTS = Path(__file__).parent / "arguments"
WRITTEN = {path.stem: path.read_text(encoding="utf-8") for path in sorted(ARGUMENTS.glob("*.md"))}
DEFINITIONS = (ARGUMENTS.parent / "definitions.md").read_text(encoding="utf-8")
RULES = re.findall(r"^\*\*([A-Z]\d+)\. ", DEFINITIONS, re.MULTILINE)
LETTERS = "WVGSKMPD"
LINK = re.compile(r"\]\(([^)\s]+)\)")
TAKEN_APART = {"plate", "figure2"}
"""Gallery scenes too large to be run for every claim; figure2 has a claim of its own."""
STATEMENTS = [
    pytest.param(claim, statement, id=f"{claim.name}-{kind}")
    for claim in CLAIMS
    for kind, statement in zip(("printed", "corrected"), claim.statements, strict=False)
]


@cache
def example(name: str) -> Case:
    """A gallery scene."""
    return Case(gallery.scene(name))


@cache
def randomly(subject: Subject, seed: int) -> Case:
    """A random scene."""
    return Case(random_scene(subject, seed))


@cache
def octagons(radius: int) -> Case:
    """More obstacles than the random scenes have."""
    return Case(random_octagons(18, seed=radius), radius)


def cases(subject: Subject) -> list[tuple[str, Case]]:
    """The gallery's scenes for one of the strategies, and random ones."""
    swept = subject is Subject.SEED_SPREADER
    more = [] if swept else [(f"octagons {radius}", octagons(radius)) for radius in some(RADII, 1)]
    names = [n for n in gallery.names() if gallery.is_swept(n) is swept and n not in TAKEN_APART]
    return more + [(n, example(n)) for n in names] + [(f"seed {k}", randomly(subject, k)) for k in SEEDS]


@pytest.mark.parametrize(("claim", "statement"), STATEMENTS)
def test_verdict(claim: Claim, statement: Statement) -> None:
    found = verdict(statement, cases(statement.subject), example)
    assert found.status not in (Status.CONTRADICTED, Status.UNTRIED), found
    assert (found.status is Status.FALSE) is statement.is_called_false


@pytest.mark.parametrize("name", sorted({s.argument for c in CLAIMS for s in c.statements if s.argument}))
def test_argument_is_written(name: str) -> None:
    """What is called proved has its proof in words beside it."""
    assert (ARGUMENTS / f"{name}.md").is_file()


def cited(text: str) -> set[str]:
    """The rules that a text names: by number, or as the first or last of several, and those between."""
    plain = re.sub(r"`[^`]*`", "", text)
    rules = set(re.findall(rf"\b([{LETTERS}]\d+)\b", plain))
    for letter, first, last in re.findall(rf"\b([{LETTERS}])(\d+) to \1(\d+)\b", plain):
        rules |= {f"{letter}{k}" for k in range(int(first), int(last) + 1)}
    return rules


def test_rules_are_numbered_in_order_and_once() -> None:
    for letter in LETTERS:
        numbers = [int(rule[1:]) for rule in RULES if rule[0] == letter]
        first = 0 if letter in "SP" else 1
        assert numbers == list(range(first, first + len(numbers)))
        assert numbers
    assert {rule[0] for rule in RULES} == set(LETTERS)


def test_citations_are_found() -> None:
    text = "By (V2), S0 to S2 and P1(c), not `m15`, L1 or $S_1$."
    assert cited(text) == {"V2", "S0", "S1", "S2", "P1"}


@pytest.mark.parametrize("name", sorted({*WRITTEN, "definitions"} - {"README"}))
def test_what_an_argument_cites_is_written(name: str) -> None:
    """Rules are those of the definitions, lemmas are files; nothing is left to a text that is not here."""
    text = DEFINITIONS if name == "definitions" else WRITTEN[name]
    assert cited(text)
    assert cited(text) <= set(RULES)
    assert "contract" not in text
    assert name == "definitions" or "**Assumptions.**" in text


@pytest.mark.parametrize("name", sorted({*WRITTEN, "definitions"}))
def test_links_of_arguments_resolve(name: str) -> None:
    folder = ARGUMENTS.parent if name == "definitions" else ARGUMENTS
    text = DEFINITIONS if name == "definitions" else WRITTEN[name]
    assert [link for link in LINK.findall(text) if not (folder / link).is_file()] == []


def test_every_rule_is_cited() -> None:
    """A rule that no argument and no other rule needs would not belong there."""
    others = re.sub(r"^\*\*[A-Z]\d+\. ", "", DEFINITIONS, flags=re.MULTILINE)
    assert set(RULES) == set().union(*map(cited, [others, *WRITTEN.values()]))


def test_every_argument_is_listed() -> None:
    listed = {link.removesuffix(".md") for link in LINK.findall(WRITTEN["README"]) if "/" not in link}
    assert listed == set(WRITTEN) - {"README"}


def test_the_numbers_of_theorem_1() -> None:
    """m9: P = 2248.735 where bound (1) is 1625.7, and d_max is 3.5 on m8."""
    run = example("m9").sightseer
    bounds = {bound.name: bound for bound in run.bounds}
    assert (run.length, bounds["(1)"].value) == (Length("2248.735"), Length("1625.7"))
    assert bounds["T1 corrected"].holds
    assert Length(clipped_distance(example("m8").sightseer, example("m8").world)) == Length("7/2")


@pytest.mark.parametrize(
    ("name", "broken"),
    [
        ("m20-3", {"(11)"}),
        ("m20-6", {"(10)", "(11)"}),
        ("m20-8", {"(9)", "(10)", "(11)"}),
        ("m20-16", {"(5)", "(6)", "(9)", "(10)", "(11)"}),
        ("relay", {"(5)", "(6)", "(9)", "(10)", "(11)"}),
    ],
)
def test_which_bounds_of_theorem_2_break(name: str, broken: set[str]) -> None:
    """As values, whatever the case that a bound is for."""
    run = example(name).spreader
    assert bounds_flaw(example(name), run) is None
    assert {bound.name for bound in run.bounds if bound.name in PRINTED and not bound.holds} == broken
