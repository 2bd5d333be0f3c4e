"""Some hundred hostile requests, and good ones between them: the server stays well, and writes nothing."""

from __future__ import annotations

import json
import re
import socket
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from http.client import HTTPException, HTTPResponse
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from hostile_requests import SCENE, Attack, attack
from nightly import NIGHTLY, by_night
from servers import Served, served

httpx = pytest.importorskip("httpx", reason="httpx is not installed")
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")

COUNT = 5000 if NIGHTLY else 80
"""Requests that are tried."""
GOOD = 1 if NIGHTLY else 4
"""After so many of them comes a good one."""
PATIENCE = 150.0
"""Seconds for an answer: a file may be read for two minutes."""
MEMORY = 700
"""Megabytes that the server itself may need: the largest body a few times, and its libraries."""


@contextmanager
def started(folder: Path) -> Iterator[Served]:
    """A server with little time and memory, whose writing is noted in a folder; it tells of no failure."""
    for name in ("home", "tmp", "cwd", "cache"):
        (folder / name).mkdir()
    environment = {
        "WATCHED_NOTES": str(folder / "notes"), "PYTHONPATH": str(Path(__file__).parent / "watched"),
        "HOME": str(folder / "home"), "TMPDIR": str(folder / "tmp"), "PYTHONDONTWRITEBYTECODE": "1",
        "XDG_CACHE_HOME": str(folder / "cache"), "XDG_CONFIG_HOME": str(folder / "cache"),
        "SECRET": "neither read nor told",
    }  # fmt: skip
    options, said = ("--seconds", "5", "--memory", "1024"), folder / "said"
    with (
        said.open("w") as errors,
        served(*options, folder=folder / "cwd", errors=errors, **environment) as server,
    ):
        yield server
    assert "Traceback" not in said.read_text(errors="replace"), said.read_text(errors="replace")[-3000:]


@pytest.fixture(scope="module")
def watched(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Served, Path]]:
    """A server, and the folder beside which it must write nothing."""
    folder = tmp_path_factory.mktemp("watched")
    with started(folder) as server:
        yield server, folder
    assert not any((folder / "tmp").iterdir())


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    """Who asks good things."""
    with httpx.Client(timeout=PATIENCE) as one:
        yield one


def answer(server: Served, request: Attack) -> tuple[int, bytes, dict[str, str]]:
    """The status, body and headers of the answer; status 0 if there is none, and none need be."""
    with socket.create_connection(("127.0.0.1", server.port), PATIENCE) as plain:
        whole = request.sent
        size = max(1, -(-len(whole) // request.pieces))
        try:
            for k in range(0, len(whole), size):
                plain.sendall(whole[k : k + size])
                time.sleep(request.pause)
        except OSError:  # Refused before it was whole: the answer may have come all the same.
            pass
        plain.settimeout(PATIENCE if request.is_whole else 0.05)
        try:
            response = HTTPResponse(plain, method=request.method)
            response.begin()
            return response.status, response.read(), {k.lower(): v for k, v in response.getheaders()}
        except (HTTPException, OSError) as error:
            assert not (request.is_whole and isinstance(error, TimeoutError)), "no answer"
            return 0, b"", {}


def good(server: Served, client: Any) -> None:
    """A good request is answered as if nothing had happened."""
    assert client.get(server.address + "api/first").json() is None
    found = client.post(server.address + "api/check", json={"scene": SCENE})
    assert found.json() == {"flaws": []}


def test_hostile_requests_do_no_harm(watched: tuple[Served, Path], client: Any) -> None:
    server, folder = watched
    parts = urlsplit(server.address)
    token = parts.path.strip("/")
    good(server, client)
    kinds: set[int] = set()
    for n in range(COUNT):
        request = attack(n, parts.netloc, token)
        try:
            status, body, headers = answer(server, request)
            kinds.add(status)
            check(request, status, body, headers, request.may_be_answered(parts.netloc, token))
            if status == 202:
                saved(server, client, json.loads(body)["number"])
            if n % GOOD == GOOD - 1:
                good(server, client)
        except Exception as error:
            raise AssertionError(f"request {n}: {request}") from error
    # The first with a wrong type of content comes later than those of a day.
    assert {0, 200, 202, 400, 403, 404, 405, 410, 413, 421, 422} <= kinds
    assert 415 in kinds or not NIGHTLY
    assert server.megabytes() < MEMORY and len(server.processes()) <= 3
    written(folder)


def saved(server: Served, client: Any, number: int) -> None:
    """A run of something odd ends, and is saved, or it is told why not."""
    answers = [client.get(server.address + f"api/run?number={number}")]
    while answers[-1].json()["state"] == "running":
        time.sleep(0.05)
        answers[-1] = client.get(server.address + f"api/run?number={number}")
    if answers[-1].json()["state"] == "finished":
        answers += [
            client.post(server.address + "api/save", params={"kind": kind}, json={})
            for kind in ("figure", "trace", "page")
        ]
    for found in answers:
        assert found.status_code in (200, 422) and b"internal error" not in found.content, found.text[:500]


@by_night
def test_half_a_character_is_refused(watched: tuple[Served, Path], client: Any) -> None:
    """It was drawn, but no figure of the run could be."""
    disc = {"name": "\ud800", "circle": {"center": [5, 0], "radius": 2}}
    body = json.dumps({"scene": {**SCENE, "obstacles": [disc]}})
    kind = {"content-type": "application/json"}
    found = client.post(watched[0].address + "api/check", content=body, headers=kind)
    assert found.status_code == 422 and "half of a character" in found.json()["error"]
    body = json.dumps({"scene": {**SCENE, "name": "\U0001f642 \u00e9"}})
    found = client.post(watched[0].address + "api/run", content=body, headers=kind)
    saved(watched[0], client, found.json()["number"])


def check(request: Attack, status: int, body: bytes, headers: dict[str, str], own: bool) -> None:
    """An answer is no failure, tells nothing, and is none to other pages."""
    assert status < 500, (status, body[:300])
    assert own or not 200 <= status < 300, "a request of another page is answered"
    for word in (b"Traceback", b"internal error", b"neither read", b"root:", b'File "/'):
        assert word not in body, body[:1000]
    if status > 400 and request.method != "HEAD":
        assert 0 < len(json.loads(body)["error"]) < 5000
    if status not in (0, 400):
        assert (
            headers["x-content-type-options"] == "nosniff"
            and "default-src 'none'" in headers["content-security-policy"]
        )


def written(folder: Path) -> None:
    """What was written: temporary files, which are gone, and the lists of fonts of two libraries."""
    notes = (folder / "notes").read_text(errors="replace").splitlines()
    assert notes, "nothing is noted at all"
    allowed = (
        rf"[\w.]+ '{re.escape(str(folder))}/(tmp|cache)/.*",
        r"os.remove 'drawing\.\w+'",  # In a temporary folder, by its descriptor.
        rf"subprocess.Popen '({re.escape(sys.executable)}|fc-list)'",
    )
    assert [line for line in notes if not re.fullmatch("|".join(allowed), line)] == []
    assert [path for name in ("home", "cwd") for path in (folder / name).iterdir()] == []
    assert [path for path in (folder / "tmp").rglob("*") if path.is_file()] == []
    assert {path.name for path in (folder / "cache").iterdir()} <= {"ezdxf", "matplotlib"}
