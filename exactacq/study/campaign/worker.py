"""The program of a worker: reads scenes to be judged line by line, and answers each with its record.

``python -m exactacq.study.campaign.worker``; lines are JSON. The first line holds the claims' place and
whether to audit; the answer is an empty list. Then each line is ``[strategy, seed]``, and each answer a
record. The worker ends when its input does, even within a scene: no coordinator, no work.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from collections.abc import Iterator
from queue import SimpleQueue
from threading import Thread
from typing import TextIO

from exactacq.study.campaign.judging import judge
from exactacq.study.campaign.settings import Task, claims_at, parts


def main() -> None:
    """Judge scenes until there is no more input."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Control-C is for the coordinator, which ends its workers.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # What a check prints must not get among the answers.
    lines = _lines()
    reference, audited = json.loads(next(lines))
    statements = list(parts(claims_at(reference)))
    _answer(answers, [])
    for line in lines:
        _answer(answers, judge(Task(*json.loads(line)), statements, audited))


def _lines() -> Iterator[str]:
    """Lines of standard input, which a thread awaits so that its end is noticed at any time."""
    queue: SimpleQueue[str] = SimpleQueue()

    def listen() -> None:
        for line in sys.stdin:
            queue.put(line)
        os._exit(0)

    Thread(target=listen, daemon=True).start()
    while True:
        yield queue.get()


def _answer(answers: TextIO, record: object) -> None:
    answers.write(json.dumps(record) + "\n")
    answers.flush()


if __name__ == "__main__":
    main()
