"""Faults planted into the library: a text in a function is replaced, and the function compiled anew."""

from __future__ import annotations
import __future__

import inspect
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from textwrap import dedent
from typing import Any, NamedTuple

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from exactacq.cached import cached_property

PATIENCE = 5.0
"""Seconds of the processor for one case: the longest take a tenth of that."""


class Fault(NamedTuple):
    """In a function of a module, or in a method of a class of it ("Class.method"), *old* becomes *new*."""

    module: Any
    function: str
    old: str
    new: str

    def plant(self, patch: pytest.MonkeyPatch) -> None:
        """Plant it wherever the function is known by its name; the text must stand there once."""
        owner, _, name = self.function.rpartition(".")
        holder = getattr(self.module, owner) if owner else self.module
        original = vars(holder)[name]
        source = dedent(inspect.getsource(_function(original)))
        assert source.count(self.old) == 1, f"{self.old!r} stands {source.count(self.old)} times in {name}"
        changed = _compiled(self.module, name, source.replace(self.old, self.new))
        if owner:
            if isinstance(changed, cached_property):
                changed.__set_name__(holder, name)
            patch.setattr(holder, name, changed)
            return
        for module in list(sys.modules.values()):
            if getattr(module, "__dict__", {}).get(name) is original:
                patch.setattr(module, name, changed)


def _function(member: Any) -> Any:
    """The function behind what a class or module holds by a name."""
    if isinstance(member, property):
        return member.fget
    return getattr(member, "__func__", None) or getattr(member, "func", None) or member


def _compiled(module: Any, name: str, source: str) -> Any:
    flags = __future__.annotations.compiler_flag
    names: dict[str, Any] = {}
    exec(compile(source, f"<planted {name}>", "exec", flags=flags), vars(module), names)
    return names[name]


class Law(NamedTuple):
    """What an oracle says of a case, the cases that it is asked about, and how many at night."""

    check: Callable[[Any], None]
    cases: st.SearchStrategy[Any]
    examples: int


class Planted(NamedTuple):
    """A fault, the law that notices it, and a case that shows it."""

    what: str
    law: Law
    case: Any
    fault: Fault


class Endless(Exception):
    """The work takes longer than it may: what is 0 but is not proved so is computed to ever more digits."""


@contextmanager
def within(seconds: float) -> Iterator[None]:
    """Work that may take so many seconds of the processor, or raises `Endless`; on Unix only."""

    def stop(*_: object) -> None:
        raise Endless

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def holds(law: Callable[[Any], None], case: Any, seconds: float) -> bool:
    """Whether a law holds in one case, and is done in time."""
    try:
        with within(seconds):
            law(case)
    except Exception:
        return False
    return True


def holds_always(law: Callable[[Any], None], cases: st.SearchStrategy[Any], examples: int) -> bool:
    """Whether a law holds on so many cases, always the same; the first failure ends it, as it is."""

    @settings(
        max_examples=examples,
        derandomize=True,
        database=None,
        deadline=None,
        phases=[Phase.generate],
        report_multiple_bugs=False,
        suppress_health_check=list(HealthCheck),
    )
    @given(cases)
    def tried(case: Any) -> None:
        with within(PATIENCE):
            law(case)

    try:
        tried()
    except Exception:
        return False
    return True
