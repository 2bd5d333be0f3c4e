"""The server of the page: on the loopback interface only, until control-C."""

from __future__ import annotations

import asyncio
import secrets
import socket
import webbrowser
from collections.abc import Mapping
from contextlib import suppress
from threading import Thread
from typing import Any

from exactacq.errors import FormatError
from exactacq.files.extras import extra
from exactacq.play.api import Api, Limits
from exactacq.play.guard import Guard

LOOPBACK, LOOPBACK_6 = "127.0.0.1", "::1"
"""The addresses of this machine that no other one reaches."""
AT_ONCE = 64
"""Connections at a time, of which the idle ones make room for others."""
PATIENCE = 15.0
"""Seconds in which the head of a request must come, and an answer be taken: connections are few."""


def serve(
    first: Mapping[str, Any] | None = None,
    *,
    port: int = 0,
    ipv6: bool = False,
    browser: bool = True,
    limits: Limits = Limits(),  # noqa: B008
) -> None:
    """Serve the page until control-C; its address is printed, and opened in the *browser*.

    *first* is what it shows at first: see `exactacq.play.scenes.opened`. With *port* 0 one that is free is
    taken. With *ipv6* the address is that of [::1]. Raises `FormatError` if a library is missing, or the port
    taken.
    """
    uvicorn = extra("uvicorn", "play")
    extra("starlette", "play")
    listener = _listening(LOOPBACK_6 if ipv6 else LOOPBACK, port)
    place = f"[{LOOPBACK_6}]" if ipv6 else LOOPBACK
    number, token = listener.getsockname()[1], secrets.token_urlsafe(24)
    address = f"http://{place}:{number}/{token}/"

    def ready() -> None:
        print(f"exactacq play is at {address}\nPress control-C to end it.", flush=True)
        if browser:
            Thread(target=webbrowser.open, args=(address,), daemon=True).start()

    hosts = (f"{place}:{number}", f"localhost:{number}")
    guarded = Guard(Api(first, limits, ready).application(), hosts, token)
    settings = uvicorn.Config(
        guarded,
        http=impatient(PATIENCE),
        ws="none",
        loop="asyncio",
        lifespan="on",
        log_level="critical",
        access_log=False,
        server_header=False,
        limit_concurrency=AT_ONCE,
        timeout_graceful_shutdown=0,
    )
    with listener, suppress(KeyboardInterrupt):
        uvicorn.Server(settings).run(sockets=[listener])


def impatient(seconds: float) -> Any:
    """The protocol of uvicorn's connections, but one on which nothing begins for so many seconds is ended.

    It may take up to twice as long. Where there are as many connections as there may be, a new one ends the
    one that has been idle for the longest time: those keep nobody out.
    """
    base = extra("uvicorn.protocols.http.h11_impl", "play").H11Protocol
    misuse = extra("h11", "play").LocalProtocolError

    class Impatient(base):  # type: ignore[misc, valid-type]
        """A connection that is looked at now and then."""

        cycle: Any

        @property
        def is_idle(self) -> bool:
            """Whether no request is being answered; the head of one may be on its way."""
            return self.cycle is None or self.cycle.response_complete

        def connection_made(self, transport: asyncio.Transport) -> None:
            super().connection_made(transport)
            self.idle_since = self.loop.time()
            self._make_room()
            self._look(object())

        def on_response_complete(self) -> None:
            self.idle_since = self.loop.time()
            super().on_response_complete()

        def _make_room(self) -> None:
            """End another connection if there are too many for a request to be answered."""
            if self.limit_concurrency is None or len(self.connections) < self.limit_concurrency:
                return
            idle = [other for other in self.connections if other is not self and other.is_idle]
            if idle:
                longest = min(idle, key=lambda other: other.idle_since)
                longest.transport.abort()
                self.connections.discard(longest)  # At once: it would be counted until it is told of its end.

        def _look(self, before: object) -> None:
            """End it if no request has begun since the last look, at which none was being answered."""
            if self.is_idle and self.cycle is before:
                self.transport.abort()
            else:
                self._next = self.loop.call_later(seconds, self._look, self.cycle)

        def send_400_response(self, msg: str) -> None:
            """Tell that a request makes no sense, and end; uvicorn fails where it must not send so much.

            It sends a text to those who ask for a head alone, and after an answer that is complete.
            """
            with suppress(misuse):
                super().send_400_response(msg)
            self.transport.close()

        def connection_lost(self, exc: Exception | None) -> None:
            self._next.cancel()
            super().connection_lost(exc)

    return Impatient


def _listening(host: str, port: int) -> socket.socket:
    """A socket on the loopback interface."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    made = socket.socket(family, socket.SOCK_STREAM)
    try:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.bind((host, port))
        made.listen(AT_ONCE)
    except OSError as error:
        made.close()
        raise FormatError(
            f"--port: {port} cannot be used ({error.strerror}); give another, or none"
        ) from None
    return made
