"""Contradictions between the strategy's look ahead and the audit's are counted."""

from __future__ import annotations

import pytest
import stress_look_ahead


def test_a_look_ahead_that_lies_is_found(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert stress_look_ahead.main(["0", "3"]) == 0
    honest = stress_look_ahead.sees_later
    monkeypatch.setattr(stress_look_ahead, "sees_later", lambda *asked: not honest(*asked))
    assert stress_look_ahead.main(["0", "3"]) == 1
    first, second, *_ = capsys.readouterr().out.splitlines()
    assert (first, second) == ("equal: 6", "map 0, x = 0")
