"""A process that does tasks for the page, one at a time, and can be killed: see `exactacq.play.bench`."""

from __future__ import annotations

import asyncio
import json
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

from exactacq.play.bench import HEAD
from exactacq.study.processes import program

Heard = Callable[[bytes, bytes], None]
"""Called with the letter and the content of each message before the answer."""

STOPPED = {"error": "stopped", "stopped": True}
"""What is told of a task that was stopped."""


class TaskError(Exception):
    """A task has no answer; ``told`` says why, as JSON data with the key "error"."""

    def __init__(self, told: dict[str, Any]) -> None:
        self.told = told
        super().__init__(told["error"])


class Worker:
    """A process with so many megabytes of memory, started when it is first needed.

    Its temporary files are in the *folder*, if there is one: whoever made that takes away what is left in it
    when the process is killed.
    """

    def __init__(self, megabytes: int, folder: str | None = None) -> None:
        self.megabytes, self.folder = megabytes, folder
        self._process: Process | None = None
        self._turn = asyncio.Lock()
        self._stopped = self._at_work = False

    async def ask(
        self,
        task: Mapping[str, Any],
        body: bytes = b"",
        *,
        seconds: float,
        heard: Heard = lambda kind, content: None,
        is_wanted: Callable[[], bool] = lambda: True,
    ) -> bytes:
        """The answer to a task, for which there are so many seconds; `TaskError` if there is none.

        Tasks wait for one another; one that is not wanted any more when its turn comes is not begun. A
        process that dies, or takes too long, is replaced.
        """
        async with self._turn:
            self._stopped = False
            await self._begin()
            try:
                if not is_wanted():
                    raise TaskError(STOPPED)
                async with asyncio.timeout(seconds):
                    return await self._done(json.dumps(task).encode() + b"\n" + body, heard)
            except TimeoutError:
                limit = f"not finished after {seconds:g} seconds"
                raise TaskError({"error": f"{limit}; see the option --seconds"}) from None
            except (asyncio.IncompleteReadError, OSError):
                if self._stopped:
                    raise TaskError(STOPPED) from None
                death = f"the process ended: it needed more than {self.megabytes} MB, or failed"
                raise TaskError({"error": f"{death}; see the option --memory"}) from None
            finally:
                if self._at_work:
                    self.kill()

    async def start(self) -> None:
        """Start the process if there is none; tasks that are at work come first."""
        async with self._turn:
            await self._begin()

    async def _begin(self) -> None:
        if self._process is not None and self._process.returncode is None:
            return
        line, environment = program("exactacq.play.bench")
        if self.folder is not None:
            environment["TMPDIR"] = self.folder
        self._process = await asyncio.create_subprocess_exec(
            *line, str(self.megabytes), stdin=PIPE, stdout=PIPE, env=environment
        )
        self._at_work = False

    async def _done(self, message: bytes, heard: Heard) -> bytes:
        process = self._process
        assert process is not None and process.stdin is not None
        self._at_work = True
        process.stdin.write(HEAD.pack(b"t", len(message)) + message)
        await process.stdin.drain()
        while True:
            kind, content = await self._message(process)
            if kind == b"e":
                self._at_work = False
                raise TaskError(json.loads(content))
            if kind == b"a":
                self._at_work = False
                return content
            heard(kind, content)

    async def _message(self, process: Process) -> tuple[bytes, bytes]:
        assert process.stdout is not None
        kind, size = HEAD.unpack(await process.stdout.readexactly(HEAD.size))
        return kind, await process.stdout.readexactly(size)

    def stop(self) -> None:
        """End the task that is at work, if there is one."""
        if self._at_work:
            self._stopped = True
            self.kill()

    async def close(self) -> None:
        """End the process at once, and wait until it has ended."""
        process = self._process
        self.kill()
        if process is not None:
            await process.wait()

    def kill(self) -> None:
        """End the process at once."""
        process, self._process, self._at_work = self._process, None, False
        if process is not None:
            with suppress(ProcessLookupError):
                process.kill()
