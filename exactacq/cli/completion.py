"""What a shell offers for the arguments of commands: scenes, strategies, and words to choose from.

Where nothing is offered, the shell completes names of files as it is used to.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path


def scenes(incomplete: str) -> list[str]:
    """The gallery scenes that begin so, and then the files in this folder that are read and begin so too."""
    from exactacq.files.formats import formats

    names = gallery_scenes(incomplete)
    read = {suffix for known in formats() if known.reader is not None for suffix in known.suffixes}
    beside = sorted(path.name for path in Path().iterdir() if path.suffix.lower() in read and path.is_file())
    return [*names, *_beginning(beside, incomplete)] if names else []


def gallery_scenes(incomplete: str) -> list[str]:
    """The gallery scenes that begin so."""
    from exactacq.files.gallery import names

    return _beginning(names(), incomplete)


def strategies(incomplete: str) -> list[str]:
    """The library's strategies that begin so, and then the Python files in this folder that do."""
    from exactacq.strategies.options import Baseline, Strategy

    files = sorted(path.name for path in Path().glob("*.py") if path.is_file())
    return [*_beginning((*Strategy, *Baseline), incomplete), *_beginning(files, incomplete)]


def among(words: Iterable[str]) -> Callable[[str], list[str]]:
    """What offers those of the words that begin so."""

    def offered(incomplete: str) -> list[str]:
        return _beginning(words, incomplete)

    return offered


def _beginning(words: Iterable[str], incomplete: str) -> list[str]:
    return [word for word in words if word.startswith(incomplete)]
