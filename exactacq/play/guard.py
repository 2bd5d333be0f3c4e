"""Who may ask the server: this machine's own page, and nothing else.

Any web page may send requests to 127.0.0.1, some under a name of its own that leads there (DNS rebinding).
So a request needs a `Host` that is this server's, an `Origin`, if any, that is too, and the token in its
path, which nobody guesses. Bodies have a known kind, so that no form of another page makes one, and a limit.
"""

from __future__ import annotations

import asyncio
import hmac
import json
from collections.abc import Awaitable, Callable, Iterable, MutableMapping
from contextlib import suppress
from typing import Any

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Application = Callable[[Message, Receive, Send], Awaitable[None]]

DRAWING_BYTES, FILE_BYTES = 24 << 20, 64 << 20
"""Largest bodies: of a drawing, some 200,000 edges, and of a file that is opened."""
DRAINED, PATIENCE = 2 * FILE_BYTES, 3.0
"""So much of a body that is refused is read all the same, in so many seconds: if the connection ended while
the body comes, the answer would be lost with it."""
BODY_SECONDS = 30.0
"""In which a body must be there: it comes from this machine."""
JSON, FILE = "application/json", "application/octet-stream"
"""Kinds of bodies."""
OPENING = "/api/open"
"""The path that takes a file."""
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}
"""Headers of every answer: nothing but what the server itself has is loaded, and nobody else may look."""


class Refused(Exception):
    """A request that is not answered: its status, and why."""

    def __init__(self, status: int, why: str) -> None:
        self.status, self.why = status, why
        super().__init__(why)


class Guard:
    """Lets requests with one of the *hosts* and the *token* through to an application, without the token."""

    def __init__(self, application: Application, hosts: Iterable[str], token: str) -> None:
        self.application, self.hosts, self.token = application, frozenset(hosts), token

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        """Answer a request."""
        if scope["type"] == "lifespan":
            await self.application(scope, receive, send)
            return
        if scope["type"] != "http":
            return

        async def answer(message: Message) -> None:
            if message["type"] == "http.response.start":
                own = [(name.lower().encode(), value.encode()) for name, value in HEADERS.items()]
                message["headers"] = [*message.get("headers", []), *own]
            await send(message)

        try:
            body = await self._body(scope, receive)
        except Refused as refusal:
            await _drain(receive)
            await _refuse(refusal, answer)
            return
        path = scope["path"].removeprefix(f"/{self.token}")
        inner = {**scope, "path": path, "raw_path": path.encode("utf-8", "replace")}
        read = False

        async def whole() -> Message:
            nonlocal read
            if read:
                return await receive()
            read = True
            return {"type": "http.request", "body": body, "more_body": False}

        await self.application(inner, whole, answer)

    async def _body(self, scope: Message, receive: Receive) -> bytes:
        """The body of a request that is let through; `Refused` for any other."""
        headers: dict[str, list[str]] = {}
        for name, value in scope["headers"]:
            headers.setdefault(name.decode("latin-1").lower(), []).append(value.decode("latin-1"))
        hosts, origins = headers.get("host", []), headers.get("origin", [])
        if len(hosts) != 1 or hosts[0].lower() not in self.hosts:
            raise Refused(421, "this server has another name")
        if origins not in ([], [f"http://{hosts[0]}"]):
            raise Refused(403, "requests of other pages are refused")
        if headers.get("sec-fetch-site", ["none"]) not in (["none"], ["same-origin"]):
            raise Refused(403, "requests of other pages are refused")
        first, _, path = scope["path"].removeprefix("/").partition("/")
        if not hmac.compare_digest(first.encode(), self.token.encode()):
            raise Refused(404, "open the address that exactacq play has printed")
        if scope["method"] not in ("GET", "HEAD", "POST"):
            raise Refused(405, "requests are GET and POST")
        if scope["method"] != "POST":
            most, kind = 0, ""
        else:
            opening = f"/{path}" == OPENING
            most, kind = (FILE_BYTES, FILE) if opening else (DRAWING_BYTES, JSON)
            if headers.get("content-type", [""])[0].partition(";")[0].strip().lower() != kind:
                raise Refused(415, f"a body of the kind {kind} is needed")
        sizes = headers.get("content-length", ["0"])
        if not sizes[0].isdecimal() or len(sizes[0]) > 12 or int(sizes[0]) > most:
            raise Refused(413, f"more than {most >> 20} MB")
        try:
            async with asyncio.timeout(BODY_SECONDS):
                return await _read(receive, most)
        except TimeoutError:
            raise Refused(408, f"the request is not whole after {BODY_SECONDS:g} seconds") from None


async def _read(receive: Receive, most: int) -> bytes:
    """A body of at most so many bytes."""
    parts, size, more = [], 0, True
    while more:
        message = await receive()
        if message["type"] != "http.request":
            raise Refused(400, "the request is not whole")
        parts.append(message.get("body", b""))
        size += len(parts[-1])
        if size > most:
            raise Refused(413, f"more than {most >> 20} MB")
        more = message.get("more_body", False)
    return b"".join(parts)


async def _drain(receive: Receive) -> None:
    """Read the rest of a body, but not for ever."""
    left, more = DRAINED, True
    with suppress(TimeoutError):
        async with asyncio.timeout(PATIENCE):
            while more and left > 0:
                message = await receive()
                left -= len(message.get("body", b""))
                more = message.get("more_body", False)


async def _refuse(refusal: Refused, send: Send) -> None:
    body = json.dumps({"error": refusal.why}).encode()
    headers = [(b"content-type", JSON.encode()), (b"content-length", str(len(body)).encode())]
    # What is left of a body after that is not read.
    headers += [(b"connection", b"close")]
    await send({"type": "http.response.start", "status": refusal.status, "headers": headers})
    await send({"type": "http.response.body", "body": body})
