"""The examples of these pages run as tests: in a directory of their own, where they may write files."""

from __future__ import annotations

from pathlib import Path

import pytest

collect_ignore = ["_build", "_generated"]


@pytest.fixture(autouse=True)
def _somewhere_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
