"""The file of a campaign: SQLite with one writer. What is committed survives any kill of any process.

campaign    key, value: the settings, and "wall", the seconds that coordinators spent
statements  claim, statement ("printed" or "corrected"), strategy, called ("true" or "false"), text
scenes      strategy, seed, outcome, seconds, length, detail, json (of scenes that did not pass)
findings    strategy, seed, claim, statement, outcome, ratio, detail
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

from exactacq.study.campaign.judging import Record
from exactacq.study.campaign.settings import Called, CampaignError, Settings, Task

APPLICATION = 0x65786163
"""SQLite's mark of whose file it is: "exac"."""
SCHEMA = """
CREATE TABLE campaign (key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE statements (claim TEXT, statement TEXT, strategy TEXT NOT NULL, called TEXT NOT NULL,
    text TEXT NOT NULL, PRIMARY KEY (claim, statement));
CREATE TABLE scenes (strategy TEXT, seed INTEGER, outcome TEXT NOT NULL, seconds REAL NOT NULL, length REAL,
    detail TEXT NOT NULL, json TEXT, PRIMARY KEY (strategy, seed));
CREATE TABLE findings (strategy TEXT, seed INTEGER, claim TEXT, statement TEXT, outcome TEXT NOT NULL,
    ratio REAL, detail TEXT NOT NULL, PRIMARY KEY (strategy, seed, claim, statement));
"""


class Store:
    """The results of one campaign, in a file or, without a path, in memory.

    A file that is there is gone on with if it is of the same campaign; `CampaignError` says how it differs.
    Nothing is written to a file that is refused.
    """

    def __init__(self, path: Path | None, settings: Settings, statements: Sequence[Called]) -> None:
        self.path = path
        try:
            self._base = sqlite3.connect(":memory:" if path is None else path)
            self._open(settings, statements)
        except sqlite3.Error as error:
            raise CampaignError(f"{path}: cannot be used as a campaign's file: {error}") from None

    def _open(self, settings: Settings, statements: Sequence[Called]) -> None:
        known = settings.as_text()
        ((tables,),) = self.rows("SELECT count(*) FROM sqlite_master")
        if tables:
            self._compare(known, statements)
        self._base.execute("PRAGMA journal_mode = WAL")
        if tables:
            return
        with self._base:
            self._base.execute("BEGIN")
            for command in SCHEMA.split(";"):
                self._base.execute(command)
            self._base.execute(f"PRAGMA application_id = {APPLICATION}")
            self._base.executemany("INSERT INTO campaign VALUES (?, ?)", [*known.items(), ("wall", "0")])
            self._base.executemany("INSERT INTO statements VALUES (?, ?, ?, ?, ?)", statements)

    def _compare(self, known: dict[str, str], statements: Sequence[Called]) -> None:
        if self.rows("PRAGMA application_id") != [(APPLICATION,)]:
            raise CampaignError(f"{self.path}: not the file of a campaign; it is left as it is")
        found = dict(self.rows("SELECT key, value FROM campaign"))
        for key, value in known.items():
            if found.get(key) != value:
                differs = f"made with {key} {found.get(key)}, not {value}"
                raise CampaignError(f"{self.path}: {differs}; choose another file")
        here = sorted(statements)
        if here != sorted(Called(*row) for row in self.rows("SELECT * FROM statements")):
            raise CampaignError(f"{self.path}: made with other statements of the claims; choose another file")

    def __enter__(self) -> Store:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._base.close()

    def rows(self, query: str, values: Sequence[object] = ()) -> list[tuple[Any, ...]]:
        """The answer to a query."""
        return self._base.execute(query, values).fetchall()

    def done(self) -> set[Task]:
        """The scenes that are judged."""
        return {Task(*row) for row in self.rows("SELECT strategy, seed FROM scenes")}

    @property
    def wall(self) -> float:
        """Seconds that coordinators spent on the campaign so far."""
        ((seconds,),) = self.rows("SELECT value FROM campaign WHERE key = 'wall'")
        return float(seconds)

    def add(self, records: Iterable[Record], wall: float) -> None:
        """Commit what came in, and the seconds spent so far. A scene that is there already stays."""
        with self._base:
            self._base.execute("UPDATE campaign SET value = ? WHERE key = 'wall'", (f"{wall:.3f}",))
            for record in records:
                task, *data, rows = record
                values = (*task, *data)
                new = self._base.execute("INSERT OR IGNORE INTO scenes VALUES (?, ?, ?, ?, ?, ?, ?)", values)
                if new.rowcount:
                    lines = [(*task, *row) for row in rows]
                    self._base.executemany("INSERT INTO findings VALUES (?, ?, ?, ?, ?, ?, ?)", lines)
