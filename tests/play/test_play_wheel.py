"""The wheel has all files of the page, and serves the same from them."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path, PurePosixPath

import pytest

from exactacq.play.assets import Asset, assets

ROOT = Path(__file__).parents[2]
NAMED = {
    ".js": rb'from "([^"]+)"|import "([^"]+)"|ask\("([\w/]+\.\w+)"\)',
    ".css": rb"url\(([^)]+)\)",
    "": rb'(?:src|href)="([^"#]+)"',
}
"""How files of the page name others, by their suffixes; the page itself has none."""


def test_whatever_a_file_of_the_page_names_is_there() -> None:
    found = assets()
    count = 0
    for name, asset in found.items():
        for groups in re.findall(NAMED.get(PurePosixPath(name).suffix, rb"$^"), asset.content):
            for other in filter(None, [groups] if isinstance(groups, bytes) else groups):
                beside = str(PurePosixPath(name).parent / other.decode()).removeprefix("./")
                assert os.path.normpath(beside) in found, f"{name} names {other.decode()}"
                count += 1
    assert count > 30


def test_the_wheel_has_them_all(tmp_path: Path) -> None:
    pytest.importorskip("hatchling", reason="hatchling is not installed")
    line = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    # Without the compiled kernel, which takes minutes.
    environment = {**os.environ, "HATCH_BUILD_NO_HOOKS": "true"}
    subprocess.run(line, cwd=ROOT, env=environment, check=True, capture_output=True, timeout=300)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as packed:
        names = set(packed.namelist())
        packed.extractall(tmp_path / "installed")
    own = {
        path.relative_to(ROOT).as_posix()
        for room in ("play", "output")
        for path in (ROOT / "exactacq" / room).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert own <= names, own - names
    code = (
        "import json, exactacq; from exactacq.play.assets import assets; "
        "told = {name: [asset.content.decode(), asset.kind] for name, asset in assets().items()}; "
        "print(json.dumps([exactacq.__file__, told]))"
    )
    paths = os.pathsep.join([str(tmp_path / "installed"), os.environ.get("PYTHONPATH", "")])
    said = subprocess.run(
        [sys.executable, "-P", "-c", code],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": paths}, check=True, capture_output=True, timeout=300,
    )  # fmt: skip
    file, served = json.loads(said.stdout)
    assert Path(file).is_relative_to(tmp_path)
    assert {k: Asset(text.encode(), kind) for k, (text, kind) in served.items()} == assets()
