"""What the page asks the server for: scenes, what is wrong with a drawing, runs and their files."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import PurePath
from tempfile import TemporaryDirectory
from time import monotonic
from typing import Any

from exactacq.errors import FormatError
from exactacq.files import gallery
from exactacq.files.extras import extra
from exactacq.files.formats import Format, format_of, formats
from exactacq.play.assets import assets
from exactacq.play.bench import APART
from exactacq.play.worker import TaskError, Worker

CHECK_SECONDS, OPEN_SECONDS = 20.0, 120.0
"""For telling what is wrong with a drawing, and for opening a file."""
KINDS = {
    "figure": ("figure.svg", "image/svg+xml"),
    "trace": ("run.json", "application/json"),
    "page": ("run.html", "text/html; charset=utf-8"),
}
"""What is saved of a run: the names and kinds of the files."""
LONGEST = 60
"""Characters of a length of the path that a figure is wanted of."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Seconds that a run, with its pictures, may take, and megabytes that a process may."""

    seconds: float = 300.0
    megabytes: int = 2048


@dataclass(slots=True)
class Exploration:
    """A run in the making, or made: how far it is, and what is there of it."""

    number: int
    began: float = field(default_factory=monotonic)
    state: str = "running"
    progress: list[Any] = field(default_factory=list)
    parts: int = 0
    data: bytes = b""
    trouble: dict[str, Any] = field(default_factory=dict)
    is_wanted: bool = True

    def heard(self, kind: bytes, content: bytes) -> None:
        """Take in a message of the process."""
        if kind == b"p":
            self.progress = json.loads(content)
        else:
            self.data, self.parts = content, self.parts + 1

    def told(self) -> dict[str, Any]:
        """How it is with the run, as JSON."""
        return {
            "number": self.number,
            "state": self.state,
            "progress": self.progress,
            "parts": self.parts,
            "seconds": round(monotonic() - self.began, 1),
            **self.trouble,
        }


class Api:
    """The answers. One process opens and checks drawings, the other one explores; so both are there at once.

    *first* is what the page shows at first, if anything. *ready* is called when requests are answered.
    """

    def __init__(
        self, first: Mapping[str, Any] | None, limits: Limits, ready: Callable[[], None] = lambda: None
    ) -> None:
        self.first, self.limits, self.ready = first, limits, ready
        self.assets = assets()
        self.reader, self.explorer = Worker(limits.megabytes), Worker(limits.megabytes)
        self.exploration: Exploration | None = None
        self._count = 0
        self._tasks: set[asyncio.Task[None]] = set()

    def application(self) -> Any:
        """The Starlette application."""
        route = extra("starlette.routing", "play").Route
        routes = [
            route("/api/first", self.tell_first),
            route("/api/gallery", self.list_gallery),
            route("/api/gallery/{name}", self.open_gallery),
            route("/api/open", self.open_file, methods=["POST"]),
            route("/api/check", self.check, methods=["POST"]),
            route("/api/text", self.text, methods=["POST"]),
            route("/api/run", self.tell_run),
            route("/api/run", self.begin_run, methods=["POST"]),
            route("/api/data", self.give_data),
            route("/api/stop", self.stop, methods=["POST"]),
            route("/api/save", self.save, methods=["POST"]),
            route("/{name:path}", self.give_asset),
        ]
        handlers: dict[Any, Any] = {404: _missing, 405: _missing, TaskError: _failed, Exception: _broken}
        application = extra("starlette.applications", "play").Starlette
        made = application(routes=routes, exception_handlers=handlers, lifespan=self._life)
        made.router.redirect_slashes = False
        return made

    @asynccontextmanager
    async def _life(self, _: Any) -> AsyncIterator[None]:
        with TemporaryDirectory(prefix="exactacq-play-") as folder:
            self.reader.folder = self.explorer.folder = folder
            await asyncio.gather(self.reader.start(), self.explorer.start())
            self.ready()
            try:
                yield
            finally:
                await asyncio.gather(self.reader.close(), self.explorer.close())

    async def give_asset(self, request: Any) -> Any:
        """A file of the page: one of those that are known, by its whole name."""
        found = self.assets.get(request.path_params["name"])
        if found is None:
            return _json({"error": "there is nothing of this name"}, 404)
        return _answer(found.content, found.kind)

    async def tell_first(self, request: Any) -> Any:
        """What the page shows at first."""
        return _json(self.first)

    async def list_gallery(self, request: Any) -> Any:
        """The gallery's scenes, and the kinds of files that are opened with their options."""
        scenes = [
            {"name": name, "shows": line, "swept": gallery.is_swept(name)}
            for name, line in gallery.names().items()
        ]
        return _json({"scenes": scenes, "formats": [_format(known) for known in formats() if _taken(known)]})

    async def open_gallery(self, request: Any) -> Any:
        """A scene of the gallery."""
        name = request.path_params["name"]
        if name not in gallery.names():
            return _json({"error": "there is no gallery scene of this name"}, 404)
        return _answer(await self.reader.ask({"do": "open", "gallery": name}, seconds=OPEN_SECONDS))

    async def open_file(self, request: Any) -> Any:
        """What the file in the body holds, whose name is known by its suffix alone."""
        asked = request.query_params
        try:
            suffix = PurePath(f"x{asked.get('suffix', '')}").suffix.lower()
            known = format_of(PurePath(f"x{suffix}"))  # type: ignore[arg-type]
            if not _taken(known):
                why = f"{known.title} name other files: open them by `exactacq play FILE`"
                raise FormatError(why if known.name in APART else f"{known.title} are written, but not read")
            options = json.loads(
                asked.get("options", "{}"), parse_int=str, parse_float=str, parse_constant=str
            )
            if not isinstance(options, dict):
                raise FormatError("options: an object is needed")
            known.checked(options)
        except (ValueError, RecursionError) as error:
            return _json({"error": str(error)[:300]}, 422)
        start = asked["start"].split(",") if asked.get("start") else None
        task = {"do": "open", "suffix": suffix, "start": start, "options": options}
        return _answer(await self.reader.ask(task, await request.body(), seconds=OPEN_SECONDS))

    async def check(self, request: Any) -> Any:
        """What is wrong with a drawing."""
        body = await request.body()
        return _answer(await self.reader.ask({"do": "check"}, body, seconds=CHECK_SECONDS))

    async def text(self, request: Any) -> Any:
        """The scene file of a drawing."""
        body = await request.body()
        content = await self.reader.ask({"do": "text"}, body, seconds=CHECK_SECONDS)
        return _answer(content, "application/json", "scene.json")

    async def begin_run(self, request: Any) -> Any:
        """Explore a drawing; a run that is not finished ends."""
        body = await request.body()
        self._count += 1
        self._end(self.exploration)
        self.exploration = Exploration(self._count)
        task = asyncio.create_task(self._explore(self.exploration, body))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return _json({"number": self._count}, 202)

    async def _explore(self, exploration: Exploration, body: bytes) -> None:
        try:
            await self.explorer.ask(
                {"do": "explore"},
                body,
                seconds=self.limits.seconds,
                heard=exploration.heard,
                is_wanted=lambda: exploration.is_wanted,
            )
            exploration.state = "finished"
        except TaskError as error:
            exploration.trouble = error.told
            exploration.state = "stopped" if "stopped" in error.told else "failed"
        if exploration is self.exploration:
            await self.explorer.start()  # If it ended, the next run need not wait for another one.

    async def tell_run(self, request: Any) -> Any:
        """How far the run is."""
        exploration = self._asked(request)
        if exploration is None:
            return _json({"error": "another run has begun since"}, 410)
        return _json(exploration.told())

    async def give_data(self, request: Any) -> Any:
        """The run as the page plays it, as good as it is by now."""
        exploration = self._asked(request)
        if exploration is None or not exploration.data:
            return _json({"error": "there is no such run"}, 410)
        return _answer(exploration.data)

    def _asked(self, request: Any) -> Exploration | None:
        found = self.exploration
        return (
            found if found is not None and request.query_params.get("number") == str(found.number) else None
        )

    async def stop(self, request: Any) -> Any:
        """End the run that is at work, or waits for its turn."""
        if self.exploration is not None and self.exploration.state == "running":
            self._end(self.exploration)
        return _json({})

    def _end(self, exploration: Exploration | None) -> None:
        """End a run, and what else its process does."""
        if exploration is not None:
            exploration.is_wanted = False
        self.explorer.stop()

    async def save(self, request: Any) -> Any:
        """A file of the last run."""
        kind, at = request.query_params.get("kind", ""), request.query_params.get("at", "")
        if kind not in KINDS or len(at) > LONGEST:
            return _json({"error": f"what is saved is one of {', '.join(KINDS)}"}, 422)
        name, media = KINDS[kind]
        content = await self.explorer.ask({"do": "save", "kind": kind, "at": at}, seconds=self.limits.seconds)
        return _answer(content, media, name)


def _taken(known: Format) -> bool:
    """Whether files of a format are opened from the page."""
    return known.reader is not None and known.name not in APART


def _format(known: Format) -> dict[str, Any]:
    own = [
        {"name": o.name, "kind": o.kind, "help": o.help, "choices": o.choices, "default": o.default}
        for o in known.options
    ]
    return {"name": known.name, "title": known.title, "suffixes": known.suffixes, "options": own}


def _answer(content: bytes, kind: str = "application/json", name: str | None = None) -> Any:
    headers = {} if name is None else {"Content-Disposition": f'attachment; filename="{name}"'}
    return extra("starlette.responses", "play").Response(content, media_type=kind, headers=headers)


def _json(value: object, status: int = 200) -> Any:
    return extra("starlette.responses", "play").JSONResponse(value, status)


async def _missing(request: Any, error: Any) -> Any:
    return _json({"error": str(error.detail)}, error.status_code)


async def _failed(request: Any, error: TaskError) -> Any:
    return _json(error.told, 422)


async def _broken(request: Any, error: Exception) -> Any:
    return _json({"error": f"internal error, please report it ({type(error).__name__})"}, 500)
