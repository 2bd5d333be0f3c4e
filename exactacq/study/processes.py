"""Processes that work and can be killed: each task is bounded in time, and survives the death of a process.

``python -m exactacq.study.processes`` is the program of one. It reads pickles: first a function that makes
the work, which None answers; then one task after the other, each of which its result answers. It ends when
its input does, even within a task: no coordinator, no work.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import traceback
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from threading import TIMEOUT_MAX, Thread
from time import monotonic
from types import TracebackType
from typing import Any, Generic, NamedTuple, TypeVar

from exactacq.errors import ExactacqError

DEATHS = 2
"""A task over which so many processes died is given up: the first may have been killed from outside."""
LIFE = 500
"""Tasks after which a process is replaced, so that what it remembers cannot grow without end."""
SPARE = 3
"""So many more processes than work at once may end, one after another, before they take up a task."""
START = 300.0
"""Seconds in which a process must be ready for its first task, however busy the machine is."""
END = object()
"""Stands for the end of what a process answers."""

Task = TypeVar("Task")
Answer = TypeVar("Answer")
Message = tuple["_Process", Any]


class ProcessError(ExactacqError):
    """Processes cannot be started: they end before they take up a task."""


def program(module: str) -> tuple[list[str], dict[str, str]]:
    """The command line and the environment that run a module of this package as a process.

    It finds what this process finds, and nothing else that lies about here (-P).
    """
    paths = os.pathsep.join(path or os.getcwd() for path in sys.path)
    return [sys.executable, "-P", "-m", module], {**os.environ, "PYTHONPATH": paths}


class Lost(NamedTuple):
    """What stands for a result that never came: processes ``died`` over it, or it was not there in time."""

    died: bool
    seconds: float
    detail: str


class Team(Generic[Task, Answer]):
    """A context manager: *size* processes, at work on one `results` at a time.

    Each process calls *make* once, which gives the function from a task to its result. A task gets *timeout*
    seconds; then its process is killed, whatever it is at. If a process dies, its task is tried once more
    elsewhere, and is lost if that process dies too. *make*, tasks and results must be what pickle takes.
    """

    def __init__(self, make: Callable[[], Callable[[Task], Answer]], size: int, timeout: float) -> None:
        self._make, self._size, self._timeout = pickle.dumps(make), size, timeout
        self._inbox: SimpleQueue[Message] = SimpleQueue()
        self._stillborn = 0
        self._processes: list[_Process] = []

    def __enter__(self) -> Team[Task, Answer]:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """End all processes at once."""
        while self._processes:
            self._dismiss(self._processes[-1])

    def results(self, tasks: Iterable[Task]) -> Iterator[tuple[Task, Answer | Lost]]:
        """All tasks with their results, in the order in which they are finished.

        Raises `ProcessError`.
        """
        todo = deque(_Job(task) for task in tasks)
        while todo or any(process.job for process in self._processes):
            self._employ(todo)
            message = self._next_message()
            while message is not None:  # All that came while results were dealt with came in time.
                yield from self._heard(*message, todo)
                message = None if self._inbox.empty() else self._inbox.get()
            yield from self._overdue()

    def _employ(self, todo: deque[_Job]) -> None:
        """Give tasks to the processes that wait for one, and start more as long as there are tasks left."""
        for process in self._processes:
            if process.ready and process.job is None and todo:
                process.give(todo.popleft(), self._timeout)
        starting = sum(not process.ready for process in self._processes)
        for _ in range(min(self._size - len(self._processes), len(todo) - starting)):
            self._processes.append(_Process(self._make, self._inbox))

    def _next_message(self) -> Message | None:
        """The next message, or None if a deadline comes first."""
        deadline = min((p.deadline for p in self._processes if p.is_awaited), default=None)
        try:
            wait = None if deadline is None else min(max(0.0, deadline - monotonic()), TIMEOUT_MAX)
            return self._inbox.get(timeout=wait)
        except Empty:
            return None

    def _heard(
        self, process: _Process, answer: Any, todo: deque[_Job]
    ) -> Iterator[tuple[Task, Answer | Lost]]:
        if process not in self._processes:
            return  # Last words of a process that was killed: its task is lost.
        if answer is END:
            yield from self._died(process, todo)
            return
        process.ready, self._stillborn = True, 0
        if process.job is not None:
            task, process.job = process.job.task, None
            yield task, answer
        if process.given >= LIFE:
            self._dismiss(process)

    def _died(self, process: _Process, todo: deque[_Job]) -> Iterator[tuple[Task, Lost]]:
        self._dismiss(process)
        if process.job is None:
            if not process.ready:
                self._is_stillborn(f"end before they take up a task, the last with status {process.status}")
            return
        process.job.deaths += 1
        if process.job.deaths < DEATHS:
            todo.appendleft(process.job)
        else:
            detail = f"{DEATHS} processes died, the last with exit status {process.status}"
            yield process.job.task, Lost(True, process.seconds, detail)

    def _is_stillborn(self, what: str) -> None:
        """Count a process that never took up a task; so many of them have a reason that will not go away."""
        self._stillborn += 1
        if self._stillborn > self._size + SPARE:
            raise ProcessError(f"processes {what}; see above for why")

    def _overdue(self) -> Iterator[tuple[Task, Lost]]:
        for process in [p for p in self._processes if p.is_awaited and p.deadline <= monotonic()]:
            self._dismiss(process)
            if process.job is None:
                self._is_stillborn(f"are not ready for a task after {START:g} seconds")
                continue
            limit = f"not finished after {self._timeout:g} seconds"
            yield process.job.task, Lost(False, process.seconds, limit)

    def _dismiss(self, process: _Process) -> None:
        self._processes.remove(process)
        process.kill()


@dataclass(eq=False)
class _Job:
    """A task, and how many processes died over it."""

    task: Any
    deaths: int = 0


class _Process:
    """One process and the job that it is at."""

    def __init__(self, make: bytes, inbox: SimpleQueue[Message]) -> None:
        self.job: _Job | None = None
        self.ready, self.given, self.began = False, 0, monotonic()
        self.deadline = self.began + START
        line, environment = program("exactacq.study.processes")
        self._process = subprocess.Popen(line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment)
        Thread(target=self._listen, args=(inbox,), daemon=True).start()
        self._send(make)

    def _listen(self, inbox: SimpleQueue[Message]) -> None:
        assert self._process.stdout is not None
        # The last answer of a process that was killed may not be whole.
        with self._process.stdout as answers, suppress(Exception):
            while True:
                inbox.put((self, pickle.load(answers)))
        inbox.put((self, END))

    def give(self, job: _Job, timeout: float) -> None:
        """Begin a job."""
        self.job, self.began = job, monotonic()
        self.deadline = self.began + timeout
        self.given += 1
        self._send(pickle.dumps(job.task))

    def _send(self, message: bytes) -> None:
        assert self._process.stdin is not None
        with suppress(OSError):  # If the process is dead, the end of its answers will tell.
            self._process.stdin.write(message)
            self._process.stdin.flush()

    @property
    def is_awaited(self) -> bool:
        """Whether an answer is to come before the deadline: it is at a job, or starts."""
        return self.job is not None or not self.ready

    @property
    def seconds(self) -> float:
        """Time since the job began."""
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


# -- the program of a process ----------------------------------------------------------------------


def main() -> None:
    """Work until there is no more input."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Control-C is for the coordinator, which ends its workers.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # What the work prints must not get among the answers.
    inputs = _inputs()
    work, answer = next(inputs)(), None
    while True:
        pickle.dump(answer, answers)
        answers.flush()
        answer = work(next(inputs))


def _inputs() -> Iterator[Any]:
    """What comes in, which a thread awaits so that the end of it is noticed at any time."""
    queue: SimpleQueue[Any] = SimpleQueue()

    def listen() -> None:
        try:
            while True:
                queue.put(pickle.load(sys.stdin.buffer))
        except BaseException as error:
            if not isinstance(error, EOFError):
                traceback.print_exception(error)
            os._exit(0)

    Thread(target=listen, daemon=True).start()
    while True:
        yield queue.get()


if __name__ == "__main__":
    main()
