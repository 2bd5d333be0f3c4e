"""What a campaign is asked to do: which scenes, which claims, how long a scene may take."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING, NamedTuple

from exactacq.errors import ExactacqError, FormatError
from exactacq.strategies.options import Strategy
from exactacq.study.families.names import SIZES

if TYPE_CHECKING:
    from exactacq.scene.scene import Scene
    from exactacq.study.claims.model import Claim, Statement

CLAIMS = "exactacq.study.claims:CLAIMS"
"""Where the claims are, as module:name: processes import them, for checks need not be picklable."""
MOST_SCENES = 10**6
"""Most scenes of a strategy in a campaign: the seeds of campaigns are so far apart."""


class CampaignError(ExactacqError):
    """A campaign cannot be begun, or cannot go on; what is in its file stays."""


class Task(NamedTuple):
    """One scene to be judged."""

    strategy: str
    seed: int

    def __str__(self) -> str:
        return f"{self.strategy}:{self.seed}"


class Called(NamedTuple):
    """One statement that scenes can try, and what it is called."""

    claim: str
    part: str
    strategy: str
    truth: str
    text: str


class SceneSource(NamedTuple):
    """Where scenes come from: small random ones, or drawings of a family, of all sizes of a range in turn."""

    family: str = ""
    least: int = 5
    most: int = 40

    def scene(self, task: Task) -> Scene:
        """The scene of a task. Raises what `family_scene` raises."""
        if not self.family:
            from exactacq.study.claims.model import Subject
            from exactacq.study.random_scenes import random_scene

            return random_scene(Subject(task.strategy), task.seed)
        from exactacq.study.families.scenes import family_scene

        size = self.least + task.seed % (self.most - self.least + 1)
        return family_scene(self.family, size, task.seed, task.strategy)

    @property
    def options(self) -> str:
        """What the command line is told for these scenes, with a space before each option."""
        return f" --family {self.family} --size {self.least}..{self.most}" if self.family else ""

    def __str__(self) -> str:
        return self.options.strip() or "random"


RANDOM = SceneSource()
"""The scenes of `exactacq.study.random_scenes`."""


def sizes_of(text: str) -> tuple[int, int]:
    """The least and the greatest size of "12" or "5..40". Raises `FormatError`."""
    least, dots, most = text.partition("..")
    most = most if dots else least
    if not all(part.isascii() and part.isdecimal() and len(part) < 10 for part in (least, most)):
        raise FormatError(f"--size: give a size like 12, or sizes like 5..40, not {text!r}")
    if not SIZES[0] <= int(least) <= int(most) <= SIZES[-1]:
        raise FormatError(f"--size: sizes ascend from {SIZES[0]} to {SIZES[-1]}, not {text}")
    return int(least), int(most)


@dataclass(frozen=True)
class Settings:
    """A campaign: *scenes* of each strategy, from the *seed*; *timeout* is in seconds a scene."""

    scenes: int = 100
    seed: int = 0
    strategies: tuple[str, ...] = tuple(strategy.value for strategy in Strategy)
    audit: bool = True
    timeout: float = 120.0
    claims: str = CLAIMS
    source: SceneSource = RANDOM

    def tasks(self) -> Iterator[Task]:
        """All scenes, the strategies in turn. Campaigns of different seeds share no scene."""
        first = self.seed * MOST_SCENES
        for seed in range(first, first + self.scenes):
            for strategy in self.strategies:
                yield Task(strategy, seed)

    def as_text(self) -> dict[str, str]:
        """What a campaign's file must agree on, word by word, for the campaign to go on in it."""
        words = asdict(self) | {"strategies": " ".join(self.strategies), "version": version("exactacq")}
        return {key: str(value) for key, value in words.items()}


def claims_at(reference: str) -> tuple[Claim, ...]:
    """The claims that "module:name" names, or none for no words. Raises `CampaignError`."""
    if not reference:
        return ()
    module, _, name = reference.partition(":")
    try:
        return tuple(getattr(import_module(module), name))
    except (ImportError, AttributeError) as error:
        raise CampaignError(f"no claims at {reference}: {error}") from None


def parts(claims: tuple[Claim, ...]) -> Iterator[tuple[Called, Statement]]:
    """The statements that single scenes can try: what is printed, and what holds instead."""
    for claim in claims:
        for part, statement in zip(("printed", "corrected"), claim.statements, strict=False):
            if statement.check is not None:
                truth = "false" if statement.is_called_false else "true"
                yield Called(claim.name, part, statement.subject.value, truth, statement.words), statement
