"""The program of a process that works for the page: ``python -m exactacq.play.bench MEGABYTES``.

It reads tasks and writes messages, each a letter, the length of what follows as eight bytes, and that. A task
is a line of JSON and a body. Messages are "p" for progress, "d" for a part of the answer, "e" for an error in
words, and "a" for the (last part of the) answer. It ends when its input does, even within a task.
"""

from __future__ import annotations

import json
import os
import signal
import struct
import sys
import traceback
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from tempfile import TemporaryDirectory
from threading import Thread
from time import monotonic
from typing import Any, BinaryIO

from exactacq.errors import ExactacqError, FormatError, InvalidScene
from exactacq.files.formats import formats
from exactacq.play.exploring import Explored
from exactacq.play.scenes import Request, dumped, flaws, opened, text_of

HEAD = struct.Struct(">cQ")
"""What a message begins with."""
PAUSE = 0.08
"""Seconds between two messages of progress, at least."""
APART = {"ros"}
"""Formats that are not taken from a page: a map of ROS names another file, which lies on this machine."""


class Bench:
    """Does tasks one after the other, and says what comes of them."""

    def __init__(self, out: BinaryIO) -> None:
        self.out, self.explored, self.told = out, Explored(), 0.0
        self.tasks: dict[str, Callable[[dict[str, Any], bytes], bytes]] = {
            "check": self.check,
            "open": self.open,
            "explore": self.explore,
            "save": self.save,
            "text": self.text,
        }

    def say(self, kind: bytes, content: bytes) -> None:
        """Send a message."""
        self.out.write(HEAD.pack(kind, len(content)) + content)
        self.out.flush()

    def tell(self, what: str, done: int, count: int) -> None:
        """Send how far the work is, but not too often."""
        if done == count or monotonic() - self.told > PAUSE:
            self.told = monotonic()
            self.say(b"p", dumped([what, done, count]))

    def do(self, message: bytes) -> None:
        """Do a task; whatever goes wrong is told in words."""
        head, _, body = message.partition(b"\n")
        task = json.loads(head)
        try:
            answer = self.tasks[task["do"]](task, body)
        except InvalidScene as error:
            self.say(b"e", dumped({"error": "; ".join(error.violations), "cure": error.cure}))
        except ExactacqError as error:
            self.say(b"e", dumped({"error": " ".join(str(error).split())}))
        except MemoryError:
            self.explored.run = None
            self.say(b"e", dumped({"error": "there is not enough memory for this; see the option --memory"}))
        except Exception as error:
            traceback.print_exception(error)
            fault = f"internal error, please report it ({type(error).__name__}: {str(error)[:160]})"
            self.say(b"e", dumped({"error": fault}))
        else:
            self.say(b"a", answer)

    def check(self, task: dict[str, Any], body: bytes) -> bytes:
        """What is wrong with a drawing."""
        return dumped({"flaws": flaws(Request.of(body))})

    def open(self, task: dict[str, Any], body: bytes) -> bytes:
        """A gallery scene by its name, or a file whose content is the body."""
        if "gallery" in task:
            return dumped(opened(task["gallery"]))
        suffix = next(
            s for known in formats() if known.name not in APART for s in known.suffixes if s == task["suffix"]
        )
        with TemporaryDirectory(prefix="exactacq-play-") as folder:
            path = Path(folder, f"drawing{suffix}")
            path.write_bytes(body)
            try:
                return dumped(opened(str(path), task["start"], task["options"]))
            except FormatError as error:  # The page knows the file by another name.
                raise FormatError(str(error).removeprefix(f"{path}: ")) from None

    def explore(self, task: dict[str, Any], body: bytes) -> bytes:
        """The run of a drawing."""
        self.explored.explore(Request.of(body), self.tell, lambda part: self.say(b"d", part))
        return b""

    def save(self, task: dict[str, Any], body: bytes) -> bytes:
        """A file of the last run."""
        return self.explored.saved(task["kind"], task["at"], self.tell)

    def text(self, task: dict[str, Any], body: bytes) -> bytes:
        """The scene file of a drawing."""
        return text_of(Request.of(body).contents).encode("utf-8", "replace")


def _limit(megabytes: int) -> None:
    """No more memory than this, where the system can see to it."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (megabytes << 20, megabytes << 20))


def _listen(inputs: BinaryIO, tasks: SimpleQueue[bytes]) -> None:
    """Take in tasks; the end of the input ends the process."""
    with suppress(OSError):
        while head := inputs.read(HEAD.size):
            _, size = HEAD.unpack(head)
            tasks.put(inputs.read(size))
    os._exit(0)


def main() -> None:
    """Work until there is no more input."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Control-C is for the server, which ends its processes.
    _limit(int(sys.argv[1]))
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # What the work prints must not get among the answers.
    bench, tasks = Bench(out), SimpleQueue[bytes]()
    Thread(target=_listen, args=(sys.stdin.buffer, tasks), daemon=True).start()
    while True:
        bench.do(tasks.get())


if __name__ == "__main__":
    main()
