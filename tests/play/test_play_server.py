"""The server of the page: what it answers, whom it refuses, and that nothing hostile ends it."""

from __future__ import annotations

import json
import socket
import time
from typing import Any
from urllib.parse import urlsplit

import pytest
from nightly import by_night

from exactacq import explore, load, load_run, sightseer
from exactacq.output.vocabulary import DARK, colours

httpx = pytest.importorskip("httpx", reason="httpx is not installed")
HTTP = httpx.Client(verify=False, limits=httpx.Limits(max_keepalive_connections=0))
"""To read certificates, which nothing needs here, takes longer than a request."""
DISCS = [{"circle": {"center": [x, "0"], "radius": r}} for x, r in (("5", "2"), ("12", "3"))]
ROOM = [[x, y] for x, y in (("-30", "-30"), ("30", "-30"), ("30", "30"), ("-30", "30"))]
SCENE = {"start": ["0", "0"], "radius": "20", "obstacles": DISCS}
JSON = {"content-type": "application/json"}
FILE = {"content-type": "application/octet-stream"}


def post(address: str, path: str, value: Any, **options: Any) -> Any:
    body = value if isinstance(value, bytes) else json.dumps(value).encode()
    return HTTP.post(address + path, content=body, headers=JSON, timeout=60, **options)


def finished(address: str, number: int) -> dict[str, Any]:
    for _ in range(600):
        told: dict[str, Any] = HTTP.get(address + f"api/run?number={number}").json()
        if told["state"] != "running":
            return told
        time.sleep(0.05)
    raise TimeoutError


def test_the_page_has_all_it_needs_and_asks_for_nothing_else(address: str) -> None:
    page = HTTP.get(address)
    assert page.status_code == 200
    assert "default-src 'none'" in page.headers["content-security-policy"]
    assert "$" not in page.text and " style=" not in page.text and " onclick=" not in page.text
    for name in ("main.js", "player/player.js", "play.css", "colours.css", "scales.json", "icon.svg"):
        answer = HTTP.get(address + name)
        assert answer.status_code == 200 and answer.headers["x-content-type-options"] == "nosniff"
    assert set(colours(dark=True)) == set(colours()) == set(DARK)


def test_a_run_is_told_and_saved_exactly(address: str) -> None:
    number = post(address, "api/run", {"scene": SCENE}).json()["number"]
    told = finished(address, number)
    assert told["state"] == "finished" and told["parts"] == 2
    data = HTTP.get(address + f"api/data?number={number}").json()
    assert data["report"]["length"][0] == "5 + 12*pi"
    assert data["report"]["bounds"][0]["closed"] == "4 + 15*pi"
    trace = post(address, "api/save?kind=trace", None, params={"kind": "trace"}).json()
    assert trace["length"] == sightseer(load("circles")).to_json()["length"]
    assert b"<svg" in post(address, "api/save?kind=figure&at=2", None).content
    assert HTTP.get(address + "api/run?number=0").status_code == 410


def test_a_baseline_is_run_and_saved_like_the_others(address: str) -> None:
    number = post(address, "api/run", {"scene": SCENE, "strategy": "nearest-frontier"}).json()["number"]
    assert finished(address, number)["state"] == "finished"
    data = HTTP.get(address + f"api/data?number={number}").json()
    own = explore(load("circles"), "nearest-frontier")
    assert data["report"]["length"] == [f"≈ {own.length.decimal(20)}"]
    assert data["report"]["bounds"] == [] and data["report"]["done"] == ["acquired", 2, 2]
    assert data["run"]["plans"][0][1] == own.events[0].why(list(own.names()))
    trace = post(address, "api/save?kind=trace", None).json()
    saved = load_run(trace)
    assert (saved.path, saved.events) == (own.path, own.events)
    refused = post(address, "api/check", {"scene": SCENE, "strategy": "best"})
    assert refused.status_code == 422 and "nearest-frontier" in refused.json()["error"]


def test_broken_rules_are_told_with_their_places(address: str) -> None:
    crossing = {**SCENE, "obstacles": [DISCS[0], {"circle": {"center": ["7", "0"], "radius": "1"}}]}
    (flaw, *_) = post(address, "api/check", {"scene": crossing}).json()["flaws"]
    assert flaw["loops"] == [0, 1] and "disjoint" in flaw["text"] and flaw["places"]
    assert post(address, "api/check", {"scene": SCENE}).json() == {"flaws": []}
    met = {**SCENE, "enclosure": ROOM, "terrain": {"width": "9", "height": "9", "origin": ["-1", "-4"]}}
    for strategy in ("sightseer", "nearest-frontier"):
        (flaw,) = post(address, "api/check", {"scene": met, "strategy": strategy}).json()["flaws"]
        assert flaw["loops"] == [1] and "O2 meets the terrain's border" in flaw["text"]
    swept = {"scene": SCENE, "strategy": "seed-spreader"}
    assert "terrain" in post(address, "api/check", swept).json()["flaws"][0]["text"]


@pytest.mark.parametrize("wait", [0, 0.3])
def test_a_run_can_be_stopped(wait: float, address: str) -> None:
    """Also one that waits for its turn: it was begun all the same, and went on to its end."""
    scene = HTTP.get(address + "api/gallery/plate", timeout=60).json()["scene"]
    number = post(address, "api/run", {"scene": scene}).json()["number"]
    time.sleep(wait)
    assert post(address, "api/stop", {}).status_code == 200
    assert finished(address, number)["state"] == "stopped"
    assert post(address, "api/check", {"scene": SCENE}).json() == {"flaws": []}


def test_files_are_opened_by_their_content(address: str) -> None:
    wkt = b"POLYGON ((2 2, 4 2, 4 4, 2 2))"
    found = HTTP.post(address + "api/open?suffix=.wkt&start=0,0", content=wkt, headers=FILE, timeout=60)
    assert len(found.json()["scene"]["obstacles"]) == 1
    for suffix in (".yaml", ".csv", ".exe", "", "/../x", "." * 500):
        answer = HTTP.post(
            address + "api/open", params={"suffix": suffix}, content=wkt, headers=FILE, timeout=60
        )
        assert answer.status_code == 422 and answer.json()["error"]


def test_other_pages_and_names_are_refused(address: str) -> None:
    port = urlsplit(address).port
    foreign = [
        ({"host": "evil.example"}, 421), ({"host": f"evil.example:{port}"}, 421),
        ({"host": "127.0.0.1:1"}, 421),
        ({"origin": "http://evil.example"}, 403), ({"origin": "null"}, 403),
        ({"origin": f"https://127.0.0.1:{port}"}, 403), ({"sec-fetch-site": "cross-site"}, 403),
    ]  # fmt: skip
    for headers, status in foreign:
        assert HTTP.get(address, headers=headers).status_code == status
        answer = HTTP.post(address + "api/run", content=b"{}", headers={**JSON, **headers})
        assert answer.status_code == status and answer.json()["error"]
    root = f"http://127.0.0.1:{port}"
    for path in ("/", "/api/run", "/x/api/run", "/" + "a" * 32 + "/"):
        assert HTTP.get(root + path).status_code == 404
    assert HTTP.post(address + "api/run", content=b"{}", headers=FILE).status_code == 415
    for method in ("PUT", "DELETE", "PATCH", "OPTIONS", "BREW"):
        assert HTTP.request(method, address).status_code == 405


def test_no_path_leads_out_of_the_page(address: str) -> None:
    parts = urlsplit(address)
    for path in (
        "../api.py",
        "..%2fapi.py",
        "%2e%2e/server.py",
        "assets/../../api.py",
        "/etc/passwd",
        "%00",
        "index.html",
    ):
        with socket.create_connection((str(parts.hostname), parts.port or 0), 10) as plain:
            head = f"Host: {parts.netloc}\r\nConnection: close\r\n\r\n"
            plain.sendall(f"GET {parts.path}{path} HTTP/1.1\r\n{head}".encode())
            answer = b"".join(iter(lambda: plain.recv(65536), b""))
        assert answer.split(b" ", 2)[1] == b"404", path


@pytest.mark.parametrize(
    "body",
    [
        b"", b"{", b"null", b"[]", b"7", b"\xff\xfe", b'{"scene": 1}', b"[" * 200_000,
        b'{"scene":' * 50_000, b'{"scene": {"obstacles": [NaN]}}',
        b'{"scene": {"obstacles": [], "radius": NaN, "start": [Infinity, 0]}}',
        b'{"scene": {"obstacles": [], "radius": 1e999999999}}',
        b'{"scene": {"obstacles": [], "radius": ' + b"9" * 1_000_000 + b"}}",
        b'{"scene": {"obstacles": []}, "strategy": []}', b'{"scene": {"obstacles": []}, "lookahead": 3}',
        pytest.param(
            b'{"scene": {"obstacles": [{"boundary": [' + b"[1,2]," * 999_999 + b"[1,2]]}]}}", marks=by_night
        ),
    ],
    ids=range(16),
)  # fmt: skip
def test_hostile_bodies_end_in_one_error(address: str, body: bytes) -> None:
    began = time.monotonic()
    answer = post(address, "api/check", body)
    assert answer.status_code == 422
    assert 0 < len(answer.json()["error"]) < 1000 and "Traceback" not in answer.text
    assert "internal error" not in answer.text
    assert time.monotonic() - began < 40


def test_bodies_that_are_too_large_are_refused(address: str) -> None:
    answer = HTTP.post(address + "api/check", content=b" " * (25 << 20), headers=JSON, timeout=60)
    assert answer.status_code == 413


def test_after_all_that_it_still_answers(address: str) -> None:
    assert post(address, "api/check", {"scene": SCENE}).json() == {"flaws": []}
