"""Connections on which nothing comes, or nothing is taken, are ended; others are not."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from threading import Thread
from typing import Any

import pytest
from nightly import some

from exactacq.play import guard
from exactacq.play.guard import Guard
from exactacq.play.server import impatient

uvicorn = pytest.importorskip("uvicorn", reason="the extra play is not installed")

SECONDS = 0.4
HEAD = b"GET / HTTP/1.1\r\nHost: x\r\n"
MUCH = 64 << 20
"""Bytes that no buffer takes."""


async def application(scope: Any, receive: Any, send: Any) -> None:
    """Answers at once; with much, or after a while, where that is asked for."""
    if scope["path"] == "/late":
        await asyncio.sleep(4 * SECONDS)
    body = bytes(MUCH if scope["path"] == "/much" else 2)
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": body})


@contextmanager
def listening(**settings: Any) -> Iterator[int]:
    """A server of this application, with little patience; its port."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        config = uvicorn.Config(
            application, http=impatient(SECONDS), lifespan="off", log_level="critical", **settings
        )
        server = uvicorn.Server(config)
        thread = Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        try:
            yield listener.getsockname()[1]
        finally:
            server.should_exit = True
            thread.join(20)


def answered(port: int, path: str = "/") -> int:
    with socket.create_connection(("127.0.0.1", port), 20) as plain:
        plain.sendall(HEAD.replace(b"/ ", path.encode() + b" ") + b"Connection: close\r\n\r\n")
        return int(plain.recv(100).split()[1])


def ended(plain: socket.socket) -> bool:
    """Whether the other side hangs up, within some seconds."""
    plain.settimeout(20 * SECONDS)
    try:
        while plain.recv(1 << 16):
            continue
    except TimeoutError:
        return False
    except OSError:
        return True
    return True


SENT = {"none": b"", "letter": b"G", "second": HEAD + b"\r\n" + HEAD, "head": HEAD}


@pytest.mark.parametrize("sent", some(SENT.values(), 2), ids=some(SENT, 2))
def test_a_connection_without_a_request_is_ended(sent: bytes) -> None:
    with listening() as port, socket.create_connection(("127.0.0.1", port), 20) as plain:
        plain.sendall(sent)
        assert ended(plain)


@pytest.mark.parametrize("sent", [b"", HEAD, HEAD + b"\r\n"], ids=["none", "head", "answered"])
def test_idle_connections_keep_nobody_out(sent: bytes) -> None:
    """They did until they were ended, for half a minute."""
    with listening(limit_concurrency=8) as port:
        idle = []
        try:
            for _ in range(12):
                idle.append(socket.create_connection(("127.0.0.1", port), 20))
                idle[-1].sendall(sent)
            assert [answered(port) for _ in range(3)] == [200] * 3
        finally:
            for plain in idle:
                plain.close()


def test_requests_at_work_are_not_ended_for_others() -> None:
    """Nor because their answers take long."""
    with listening(limit_concurrency=4) as port, ThreadPoolExecutor() as threads:
        late = [threads.submit(answered, port, "/late") for _ in range(3)]
        time.sleep(SECONDS)
        assert answered(port) == 503
        assert [one.result() for one in late] == [200] * 3


@pytest.mark.parametrize("method", [b"HEAD", b"POST"])
def test_what_makes_no_sense_is_refused_quietly(method: bytes, caplog: pytest.LogCaptureFixture) -> None:
    """In place of the body of an answer to HEAD, which has none, uvicorn sent a traceback to the terminal."""
    head = HEAD.replace(b"GET", method) + b"Transfer-Encoding: chunked\r\n\r\n"
    with listening() as port, socket.create_connection(("127.0.0.1", port), 20) as plain:
        plain.sendall(head + b"f" * 30 + b"\r\n")
        assert plain.recv(100).startswith(b"HTTP/1.1 400")
        assert ended(plain)
    assert not caplog.records


def test_an_answer_that_is_not_taken_is_given_up() -> None:
    with listening() as port, socket.create_connection(("127.0.0.1", port), 20) as plain:
        plain.sendall(HEAD.replace(b"/ ", b"/much ") + b"\r\n")
        time.sleep(5 * SECONDS)
        plain.settimeout(20)
        size = 0
        try:
            while read := plain.recv(1 << 20):
                size += len(read)
        except OSError:
            pass
        assert size < MUCH


def test_a_body_that_does_not_come_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guard, "BODY_SECONDS", 0.05)
    monkeypatch.setattr(guard, "PATIENCE", 0.05)
    sent: list[Any] = []

    async def receive() -> Any:
        if sent:
            raise AssertionError
        await asyncio.sleep(60)

    async def send(message: Any) -> None:
        sent.append(message)

    headers = [(b"host", b"h"), (b"content-type", b"application/json"), (b"content-length", b"9")]
    scope = {"type": "http", "method": "POST", "path": "/token/api/check", "headers": headers}
    asyncio.run(Guard(application, ["h"], "token")(scope, receive, send))
    assert sent[0]["status"] == 408 and b"not whole" in sent[1]["body"]
