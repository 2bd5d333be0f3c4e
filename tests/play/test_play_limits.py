"""What the server keeps to: loopback addresses alone, and the memory and time of its processes."""

from __future__ import annotations

import socket
import sys
import time
from contextlib import suppress
from pathlib import Path
from threading import Thread
from typing import Any
from urllib.parse import urlsplit

import pytest
from hostile_requests import SCENE
from nightly import by_night
from servers import Served, served

httpx = pytest.importorskip("httpx", reason="httpx is not installed")
HTTP = httpx.Client(verify=False, limits=httpx.Limits(max_keepalive_connections=0))
"""To read certificates, which nothing needs here, takes longer than a request."""
EMPTY_LISTS = b'{"scene": {"obstacles": [' + b"[]," * 7_000_000 + b"[]]}}"
"""A drawing that takes some 600 MB when it is read."""


def asked(address: str, path: str, value: Any) -> Any:
    return HTTP.post(address + path, json=value, timeout=60).json()


def ended(address: str, number: int) -> dict[str, Any]:
    """What is told of a run when it is over."""
    end = time.monotonic() + 60
    while time.monotonic() < end:
        told: dict[str, Any] = HTTP.get(address + f"api/run?number={number}", timeout=60).json()
        if told["state"] != "running":
            return told
        time.sleep(0.05)
    raise TimeoutError


def reached(host: str, port: int) -> bool:
    """Whether someone listens there."""
    try:
        socket.create_connection((host, port), 2).close()
    except OSError:
        return False
    return True


def own_addresses() -> set[str]:
    """Addresses by which other machines reach this one, as far as it knows them."""
    found = {
        str(row[4][0]) for row in socket.getaddrinfo(socket.gethostname(), None, type=socket.SOCK_STREAM)
    }
    for family, far in ((socket.AF_INET, "192.0.2.1"), (socket.AF_INET6, "2001:db8::1")):
        try:
            with socket.socket(family, socket.SOCK_DGRAM) as nobody:  # Nothing is sent.
                nobody.connect((far, 9))
                found.add(nobody.getsockname()[0])
        except OSError:
            continue
    return {host for host in found if host != "::1" and not host.startswith("127.0.0.1")}


def has_ipv6() -> bool:
    try:
        with socket.socket(socket.AF_INET6) as one:
            one.bind(("::1", 0))
    except OSError:
        return False
    return True


@by_night
@pytest.mark.skipif(not has_ipv6(), reason="this machine has no IPv6")
def test_ipv6_is_served_on_the_loopback_interface_alone() -> None:
    with served("--ipv6", place="[::1]") as server:
        host = f"[::1]:{server.port}"
        assert HTTP.get(server.address).status_code == 200
        own = {"origin": f"http://{host}"}
        assert HTTP.post(
            server.address + "api/check", json={"scene": SCENE}, headers=own, timeout=60
        ).json() == {"flaws": []}
        for headers, status in (
            ({"host": f"127.0.0.1:{server.port}"}, 421),
            ({"host": f"::1:{server.port}"}, 421),
            ({"origin": f"http://127.0.0.1:{server.port}"}, 403),
            ({"host": f"localhost:{server.port}"}, 200),
        ):
            assert HTTP.get(server.address, headers=headers).status_code == status
        assert reached("::1", server.port)
        for other in ("127.0.0.1", *own_addresses()):
            assert not reached(other, server.port), other
        listens_at(server, {"00000000000000000000000001000000"})


def test_ipv4_is_served_on_the_loopback_interface_alone(address: str) -> None:
    port = urlsplit(address).port or 0
    assert reached("127.0.0.1", port)
    for other in ("::1", *own_addresses(), *(["127.0.0.2"] if sys.platform == "linux" else [])):
        assert not reached(other, port), other


def listens_at(server: Served, places: set[str]) -> None:
    """The system says at which addresses the port is listened to."""
    if sys.platform != "linux":
        return
    rows = [
        line.split()
        for name in ("tcp", "tcp6")
        for line in Path(f"/proc/net/{name}").read_text().splitlines()[1:]
    ]
    local = [row[1].split(":") for row in rows if row[3] == "0A"]
    assert {place for place, port in local if int(port, 16) == server.port} == places


@by_night
@pytest.mark.skipif(sys.platform != "linux", reason="memory is limited on Linux only")
def test_a_process_gets_no_more_memory_than_it_may(address: str) -> None:
    kind = {"content-type": "application/json"}
    enough = HTTP.post(address + "api/check", content=EMPTY_LISTS, headers=kind, timeout=60)
    assert enough.status_code == 422 and "memory" not in enough.json()["error"]
    with served("--memory", "512") as server:
        less = HTTP.post(server.address + "api/check", content=EMPTY_LISTS, headers=kind, timeout=60)
        assert less.status_code == 422 and "--memory" in less.json()["error"]
        assert asked(server.address, "api/check", {"scene": SCENE}) == {"flaws": []}


def test_a_run_gets_no_more_time_than_it_may() -> None:
    with served("--seconds", "1") as server:
        scene = HTTP.get(server.address + "api/gallery/plate", timeout=60).json()["scene"]
        before = server.processes() if sys.platform == "linux" else []
        number = asked(server.address, "api/run", {"scene": scene})["number"]
        told = ended(server.address, number)
        assert told["state"] == "failed" and "1 seconds" in told["error"] and "--seconds" in told["error"]
        assert told["seconds"] < 20
        if sys.platform == "linux":
            end = time.monotonic() + 20
            # One is killed, and another one is there before it is asked for; the system takes its time.
            while len(now := set(server.processes())) != 3 or len(set(before) - now) != 1:
                assert time.monotonic() < end, "the process is still at work"
                time.sleep(0.05)
        assert asked(server.address, "api/check", {"scene": SCENE}) == {"flaws": []}


def test_nothing_is_left_of_a_file_that_was_being_opened(tmp_path: Path) -> None:
    rings = ",".join(f"(({k} 0, {k + 0.5} 0, {k} 1, {k} 0))" for k in range(40_000))
    found: list[Path] = []

    def send(address: str) -> None:
        kind = {"content-type": "application/octet-stream"}
        content = f"MULTIPOLYGON ({rings})".encode()
        with suppress(httpx.HTTPError):
            HTTP.post(address + "api/open?suffix=.wkt", content=content, headers=kind, timeout=60)

    with served(TMPDIR=str(tmp_path)) as server:
        sender = Thread(target=send, args=(server.address,))
        sender.start()
        end = time.monotonic() + 60
        while not found:
            assert time.monotonic() < end
            found = list(tmp_path.rglob("drawing.wkt"))
    sender.join(60)
    assert list(tmp_path.iterdir()) == []
