"""CITATION.cff names this version, the bibliography holds what is cited, the glossary what words mean."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
import yaml

from exactacq.output.vocabulary import Word
from exactacq.sensing.event import EventKind, Occasion, Reason

ROOT = Path(__file__).parent.parent
PAGES = {path.stem: path.read_text(encoding="utf-8") for path in (ROOT / "docs").glob("*.md")}


def test_the_citation_names_the_project_and_its_version() -> None:
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert (
        cited["cff-version"] == "1.2.0"
        and cited["message"]
        and cited["authors"]
        and cited["type"] == "software"
    )
    assert (cited["title"], str(cited["version"])) == (project["name"], project["version"])
    assert cited["abstract"] == project["description"] and cited["keywords"] == project["keywords"]
    assert cited["license"] == "MIT" and (ROOT / "LICENSE").read_text().startswith("MIT License")
    assert all(work["title"] in " ".join(PAGES["bibliography"].split()) for work in cited["references"])


def works() -> dict[str, str]:
    """The bibliography's entries by their labels."""
    parts = re.split(r"^\((ref-[a-z-]+)\)=\n", PAGES["bibliography"], flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


@pytest.mark.parametrize("label", works())
def test_a_work_has_authors_title_and_year_or_says_why_not(label: str) -> None:
    text = " ".join(works()[label].split())
    assert re.match(r"[A-Z]\. [^*]+\. \*[^*]+\.\* ", text)
    assert re.search(r"\b(19[6-9]\d|20[0-2]\d)\b", text)
    for doi, address in re.findall(r"\[doi:(\S+?)\]\(https://doi\.org/(\S+)\)", text):
        assert re.fullmatch(r"10\.\d{4,}/\S+", doi)
        assert address.replace("%28", "(").replace("%29", ")") == doi


def test_works_are_cited_and_what_is_cited_is_there() -> None:
    """By a link, or by name in the pages, the proofs or the docstrings."""
    labels = {label for text in PAGES.values() for label in re.findall(r"\]\((ref-[a-z-]+)\)", text)}
    assert labels <= set(works())
    others = [text for name, text in PAGES.items() if name != "bibliography"]
    others += [path.read_text(encoding="utf-8") for path in (ROOT / "exactacq").rglob("*.py")]
    told = " ".join(others)
    for label, text in works().items():
        family = re.match(r"(?:[A-Z]\. ?)+([\w-]+)", text)[1]  # type: ignore[index]
        assert label in labels or family in told, label


def terms() -> list[str]:
    """What the glossary explains; several words that are explained together are parted by commas."""
    blocks = re.findall(r"^```\{glossary\}\n(.*?)^```", PAGES["glossary"], re.MULTILINE | re.DOTALL)
    return [line for block in blocks for line in block.splitlines() if line and not line.startswith(" ")]


def test_the_glossary_explains_what_events_and_figures_say() -> None:
    known = {word.lower() for term in terms() for word in (term, *term.split(", "))}
    words = [*EventKind, *Reason, *(o for o in Occasion if o not in (Occasion.WAY_OUT, Occasion.WAY_BACK))]
    words += ["tree link", "crossing point", "frontier", "never seen", "diversion", "terrain", "hit point H"]
    words += [
        "window",
        "range arc",
        "look-ahead",
        "strip",
        "aim",
        "pencil",
        "family",
        "free bitangent",
        "shore",
    ]
    unexplained = {str(word) for word in words if str(word).lower() not in known}
    assert unexplained <= {"start", "stop", "moment", "advance"}
    assert {"start", "stop", "moment"} <= set(re.findall(r"\w+", PAGES["glossary"]))


def test_the_glossary_explains_a_word_once_in_short() -> None:
    names = [word for term in terms() for word in ([term] if term in set(Word) else term.split(", "))]
    assert len(names) == len(set(names))
    linked = set(re.findall(r"\{term\}`(?:[^`<]*<)?([^`<>]+)>?`", "".join(PAGES.values())))
    assert linked <= set(terms())
