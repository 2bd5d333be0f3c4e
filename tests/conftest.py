"""How tests are run: profiles `everyday` (default, deterministic, few examples) and `nightly` (many).

Choose with the environment variable HYPOTHESIS_PROFILE or pytest's ``--hypothesis-profile``. What Hypothesis
finds at night is kept in `.hypothesis/nightly`, and tried first the next time. What else is tried at night
only is told by the module `nightly`.
"""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator
from compileall import compile_dir
from importlib.util import find_spec
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis.database import DirectoryBasedExampleDatabase

SLOW_SCENES = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much]
FOUND = Path(__file__).resolve().parent.parent / ".hypothesis" / "nightly"

settings.register_profile(
    "everyday",
    derandomize=True,
    deadline=None,
    max_examples=20,
    database=None,
    phases=[Phase.explicit, Phase.generate, Phase.target, Phase.shrink],
    report_multiple_bugs=False,  # Of each test one failure is shrunk, for five minutes at most.
    print_blob=True,
    suppress_health_check=SLOW_SCENES,
)
settings.register_profile(
    "nightly",
    deadline=None,
    max_examples=400,
    database=DirectoryBasedExampleDatabase(FOUND),
    print_blob=True,
    suppress_health_check=SLOW_SCENES,
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "everyday"))


def pytest_configure(config: pytest.Config) -> None:
    """Compile the package once: where nothing compiled may be written, each program that tests start would do
    it again."""
    gc.disable()  # While tests are collected: to search what is no garbage takes a quarter of the time.
    package = find_spec("exactacq")
    if not hasattr(config, "workerinput") and package is not None and package.origin is not None:
        compile_dir(Path(package.origin).parent, quiet=1)


def pytest_collection_finish() -> None:
    """Search for garbage again, but seldom among all objects.

    What tests share stays to the end, and to search it takes seconds. Runs do so from time to time
    (`exactacq.gc_pause`).
    """
    gc.enable()
    gc.set_threshold(*gc.get_threshold()[:2], 1000)


def pytest_sessionfinish() -> None:
    """End soon: pytest and the interpreter would search all that tests share for ten seconds."""
    gc.freeze()


@pytest.fixture
def others_frozen() -> Iterator[None]:
    """Searches for garbage leave out what other tests have left in this process, which takes seconds."""
    gc.freeze()
    yield
    gc.unfreeze()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: object) -> object:
    """With ``-n`` the tests of one file run in one process, which makes once what they share."""
    if config.getoption("dist") != "load":
        return None
    from xdist.scheduler import LoadFileScheduling

    return LoadFileScheduling(config, log)
