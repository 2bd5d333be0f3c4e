"""Workers on this machine: processes of their own, each bounded in time, and replaced when they die."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections import Counter, deque
from collections.abc import Iterable, Iterator
from contextlib import suppress
from queue import Empty, SimpleQueue
from threading import Thread
from time import monotonic
from types import TracebackType

from exactacq.study.campaign.judging import Record, Result, Row, lost
from exactacq.study.campaign.settings import CampaignError, Settings, Task

DEATHS = 2
"""A scene on which so many processes died is given up: the first may have been killed from outside."""
LIFE = 500
"""Scenes after which a process is replaced, so that what it remembers cannot grow without end."""

Message = tuple["_Process", str | None]
"""A line that a process wrote, None at the end of them."""


class Team:
    """A context manager: *size* worker processes, at work on one `records` at a time.

    A scene gets ``settings.timeout`` seconds; then its process is killed, whatever it is at, and the scene is
    recorded as a timeout. If a process dies, its scene is tried once more elsewhere, and is recorded as
    crashed if that process dies too.
    """

    def __init__(self, settings: Settings, size: int) -> None:
        self.settings = settings
        self._inbox: SimpleQueue[Message] = SimpleQueue()
        self._size, self._stillborn = size, 0
        self._deaths: Counter[Task] = Counter()
        self._processes: list[_Process] = []

    def __enter__(self) -> Team:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        for process in self._processes:
            process.kill()

    def records(self, tasks: Iterable[Task]) -> Iterator[Record]:
        """The records of all tasks, in the order in which they are finished.

        Raises `CampaignError` if processes cannot be started.
        """
        todo = deque(tasks)
        while todo or any(process.task for process in self._processes):
            self._employ(todo)
            message = self._next_message()
            if message is not None:
                yield from self._heard(*message, todo)
            yield from self._overdue()

    def _employ(self, todo: deque[Task]) -> None:
        """Give scenes to the processes that wait for one, and start more as long as there are scenes left."""
        for process in self._processes:
            if process.ready and process.task is None and todo:
                process.give(todo.popleft())
        starting = sum(not process.ready for process in self._processes)
        for _ in range(min(self._size - len(self._processes), len(todo) - starting)):
            self._processes.append(_Process(self.settings, self._inbox))

    def _next_message(self) -> Message | None:
        """The next message, or None if a deadline comes first."""
        deadline = min((p.deadline for p in self._processes if p.task is not None), default=None)
        try:
            return self._inbox.get(timeout=None if deadline is None else max(0.0, deadline - monotonic()))
        except Empty:
            return None

    def _heard(self, process: _Process, line: str | None, todo: deque[Task]) -> Iterator[Record]:
        if process not in self._processes:
            return  # Last words of a process that was killed: its scene is recorded.
        if line is None:
            yield from self._died(process, todo)
            return
        process.ready, self._stillborn = True, 0
        if process.task is not None:
            process.task = None
            yield _record(line)
        if process.judged >= LIFE:
            self._dismiss(process)

    def _died(self, process: _Process, todo: deque[Task]) -> Iterator[Record]:
        self._dismiss(process)
        if process.task is None:
            self._stillborn += not process.ready
            if self._stillborn > self._size:
                raise CampaignError("the worker processes end before they judge a scene; see above for why")
            return
        self._deaths[process.task] += 1
        if self._deaths[process.task] < DEATHS:
            todo.appendleft(process.task)
        else:
            detail = f"{DEATHS} processes died, the last with exit status {process.status}"
            yield lost(process.task, Result.CRASHED, process.seconds, detail)

    def _overdue(self) -> Iterator[Record]:
        for process in [p for p in self._processes if p.task is not None and p.deadline <= monotonic()]:
            assert process.task is not None
            self._dismiss(process)
            limit = f"not finished after {self.settings.timeout:g} seconds"
            yield lost(process.task, Result.TIMEOUT, process.seconds, limit)

    def _dismiss(self, process: _Process) -> None:
        self._processes.remove(process)
        process.kill()


class _Process:
    """One worker process and the scene it is at."""

    def __init__(self, settings: Settings, inbox: SimpleQueue[Message]) -> None:
        self.task: Task | None = None
        self.ready, self.judged, self.began, self.deadline = False, 0, 0.0, 0.0
        self._timeout = settings.timeout
        # The workers must find what this process finds, and nothing else that lies about here (-P).
        paths = os.pathsep.join(path or os.getcwd() for path in sys.path)
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", "exactacq.study.campaign.worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": paths},
            text=True,
        )
        Thread(target=self._listen, args=(inbox,), daemon=True).start()
        self._send([settings.claims, settings.audit])

    def _listen(self, inbox: SimpleQueue[Message]) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as answers:
            for line in answers:
                if line.endswith("\n"):  # The last line of a process that was killed may not be whole.
                    inbox.put((self, line))
        inbox.put((self, None))

    def give(self, task: Task) -> None:
        """Begin a scene."""
        self.task, self.began = task, monotonic()
        self.deadline = self.began + self._timeout
        self.judged += 1
        self._send(task)

    def _send(self, message: object) -> None:
        assert self._process.stdin is not None
        with suppress(OSError):  # If the process is dead, the end of its answers will tell.
            self._process.stdin.write(json.dumps(message) + "\n")
            self._process.stdin.flush()

    @property
    def seconds(self) -> float:
        """Time since the scene began."""
        return monotonic() - self.began

    @property
    def status(self) -> int | None:
        """The exit status of a process that has ended; minus the signal that killed it."""
        return self._process.wait()

    def kill(self) -> None:
        """End the process at once, if it has not ended."""
        self._process.kill()
        self._process.wait()
        assert self._process.stdin is not None
        with suppress(OSError):  # What was not sent is not needed.
            self._process.stdin.close()


def _record(line: str) -> Record:
    task, *values, rows = json.loads(line)
    return Record._make([Task(*task), *values, tuple(Row(*row) for row in rows)])
