"""The files of the page, all of them in the package: served by their whole names, and nothing else."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import PurePath
from string import Template
from typing import NamedTuple

from exactacq.output import vocabulary
from exactacq.output.animation.page import SCRIPTS, STYLE, fragments, scale, variables

KINDS = {
    ".html": "text/html",
    ".js": "text/javascript",
    ".css": "text/css",
    ".json": "application/json",
    ".svg": "image/svg+xml",
}
"""The kinds of files by their suffixes."""


class Asset(NamedTuple):
    """A file of the page, and of what kind it is."""

    content: bytes
    kind: str


def assets() -> dict[str, Asset]:
    """All files of the page by their names; the page itself has none."""
    own, played = (files(f"exactacq.{room}") for room in ("play", "output.animation"))
    texts = {path.name: path.read_text("utf-8") for path in (own / "assets").iterdir() if path.is_file()}
    texts |= {name: played.joinpath(name).read_text("utf-8") for name in (*SCRIPTS, STYLE)}
    texts["colours.css"] = _colours()
    texts["scales.json"] = json.dumps({"light": scale(), "dark": scale(dark=True)})
    page = Template(texts.pop("index.html")).substitute(fragments())
    found = {name: Asset(text.encode(), _kind(name)) for name, text in texts.items()}
    return {"": Asset(page.encode(), _kind("index.html")), **found}


def _kind(name: str) -> str:
    return f"{KINDS[PurePath(name).suffix]}; charset=utf-8"


def _colours() -> str:
    """The colours by day and by night."""
    light, dark = (variables(vocabulary.colours(dark=dark)) for dark in (False, True))
    return f":root {{\n{light}\n}}\n@media (prefers-color-scheme: dark) {{ :root {{\n{dark}\n}} }}\n"
