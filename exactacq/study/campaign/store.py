"""The file of a campaign: SQLite with one writer. What is committed survives any kill of any process.

campaign    key, value: the settings, and "wall", the seconds that coordinators spent
statements  claim, statement ("printed" or "corrected"), strategy, called ("true" or "false"), text
scenes      strategy, seed, outcome, seconds, length, detail, json (of scenes that did not pass)
findings    strategy, seed, claim, statement, outcome, ratio, detail
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any

from exactacq.files.source import one_line
from exactacq.study.campaign.judging import Record
from exactacq.study.campaign.settings import Called, CampaignError, Settings, Task

APPLICATION = 0x65786163
"""SQLite's mark of whose file it is: "exac"."""
TABLES = [
    "CREATE TABLE campaign (key TEXT PRIMARY KEY, value TEXT NOT NULL)",
    "CREATE TABLE statements (claim TEXT, statement TEXT, strategy TEXT NOT NULL, called TEXT NOT NULL,"
    " text TEXT NOT NULL, PRIMARY KEY (claim, statement))",
    "CREATE TABLE scenes (strategy TEXT, seed INTEGER, outcome TEXT NOT NULL, seconds REAL NOT NULL,"
    " length REAL, detail TEXT NOT NULL, json TEXT, PRIMARY KEY (strategy, seed))",
    "CREATE TABLE findings (strategy TEXT, seed INTEGER, claim TEXT, statement TEXT, outcome TEXT NOT NULL,"
    " ratio REAL, detail TEXT NOT NULL, PRIMARY KEY (strategy, seed, claim, statement))",
]
"""What makes the tables: SQLite keeps these words."""
PATIENCE = 30
"""Seconds to wait for another process that writes."""
PAGE = 4096
"""Bytes of the first page, which is all that there is before the first commit."""


class Store:
    """The results of one campaign, in a file or, without a path, in memory.

    A file that is there is gone on with if it is of the same campaign and sound; `CampaignError` says how it
    differs, and also whatever prevents to read or write later. Nothing is written to a file that is refused.
    Opening costs a look at all that the file holds: seconds for millions of findings.
    """

    def __init__(self, path: Path | None, settings: Settings, statements: Sequence[Called]) -> None:
        self.path, self.settings = path, settings
        with self._told("cannot be used as a campaign's file"):
            if path is not None and _is_begun(path):
                # What cannot write does not merge the files beside, whose they may ever be.
                read_only = f"{Path(os.path.abspath(path)).as_uri()}?mode=ro"
                with closing(sqlite3.connect(read_only, timeout=PATIENCE, uri=True)) as self._base:
                    self._examine(settings, statements)
            self._base = sqlite3.connect(":memory:" if path is None else path, timeout=PATIENCE)
            with ExitStack() as refused:
                refused.callback(self._base.close)
                self._base.execute("PRAGMA journal_mode = WAL")
                with self._base:
                    self._base.execute("BEGIN IMMEDIATE")
                    if not self._layout():
                        self._make(settings, statements)
                    self._compare(settings, statements)  # Another process may have made the tables.
                    # Whether anything can be written is told now, not when the first scene is judged.
                    self._base.execute("UPDATE campaign SET value = value WHERE key = 'wall'")
                refused.pop_all()

    def _layout(self) -> list[str]:
        """The commands that made the tables, and whatever else there is."""
        commands = self.rows("SELECT sql FROM sqlite_master WHERE sql IS NOT NULL")
        return [" ".join(command.split()) for (command,) in commands]

    def _make(self, settings: Settings, statements: Sequence[Called]) -> None:
        for command in TABLES:
            self._base.execute(command)
        self._base.execute(f"PRAGMA application_id = {APPLICATION}")
        words = [*settings.as_text().items(), ("wall", "0")]
        self._base.executemany("INSERT INTO campaign VALUES (?, ?)", words)
        self._base.executemany("INSERT INTO statements VALUES (?, ?, ?, ?, ?)", statements)

    def _examine(self, settings: Settings, statements: Sequence[Called]) -> None:
        """Refuse a file of another campaign or kind, and one that was damaged or mixed up with another."""
        try:
            if not self._layout():
                return
            self._compare(settings, statements)
            ((flaw,),) = self.rows("PRAGMA integrity_check(1)")
        except CampaignError as error:
            if not getattr(error.__cause__, "sqlite_errorname", "").startswith("SQLITE_CORRUPT"):
                raise
            flaw = str(error.__cause__)
        if flaw == "ok":
            flaw = next(self._flaws(settings), "ok")
        if flaw != "ok":
            words = f"{self.path}: the file is damaged ({one_line(flaw)}); it is left as it is"
            if os.path.exists(f"{self.path}-wal"):
                words += f"; if {self.path}-wal is not of the same campaign, take it away"
            raise CampaignError(words)

    def _flaws(self, settings: Settings) -> Iterator[str]:
        """What SQLite takes for sound but no campaign writes."""
        for table in ("campaign", "statements", "scenes", "findings"):
            columns = self.rows(
                'SELECT name, lower(type), "notnull" OR pk FROM pragma_table_info(?)', (table,)
            )
            wrong = (
                f"typeof({name}) NOT IN ('{kind}', '{kind if must else 'null'}')"
                for name, kind, must in columns
            )
            if self.rows(f"SELECT 1 FROM {table} WHERE {' OR '.join(wrong)} LIMIT 1"):
                yield f"a value of the wrong type among the {table}"
        try:
            _ = self.wall
        except ValueError:
            yield "the seconds spent are no number"
        if not self.done() <= set(settings.tasks()):
            yield "scenes that were not asked for"
        if self.rows("SELECT strategy, seed FROM findings EXCEPT SELECT strategy, seed FROM scenes LIMIT 1"):
            yield "findings of scenes that are not there"

    def _compare(self, settings: Settings, statements: Sequence[Called]) -> None:
        """Refuse what is not the file of this campaign."""
        if self.rows("PRAGMA application_id") != [(APPLICATION,)] or self._layout() != TABLES:
            raise CampaignError(f"{self.path}: not the file of a campaign; it is left as it is")
        found = dict(self.rows("SELECT key, value FROM campaign"))
        for key, value in settings.as_text().items():
            if found.get(key) != value:
                differs = f"made with {key} {one_line(found.get(key))}, not {value}"
                raise CampaignError(f"{self.path}: {differs}; choose another file")
        if set(statements) != {Called(*row) for row in self.rows("SELECT * FROM statements")}:
            raise CampaignError(f"{self.path}: made with other statements of the claims; choose another file")

    def __enter__(self) -> Store:
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._base.close()

    def rows(self, query: str, values: Sequence[object] = ()) -> list[tuple[Any, ...]]:
        """The answer to a query."""
        with self._told("cannot be read"):
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
        with self._told("what is judged so far is kept, but no more can be written"), self._base:
            self._base.execute("UPDATE campaign SET value = ? WHERE key = 'wall'", (f"{wall:.3f}",))
            for record in records:
                task, *data, rows = record
                values = (*task, *data)
                new = self._base.execute("INSERT OR IGNORE INTO scenes VALUES (?, ?, ?, ?, ?, ?, ?)", values)
                if new.rowcount:
                    lines = [(*task, *row) for row in rows]
                    self._base.executemany("INSERT INTO findings VALUES (?, ?, ?, ?, ?, ?, ?)", lines)

    @contextmanager
    def _told(self, what: str) -> Iterator[None]:
        """Errors of SQLite become those of campaigns."""
        try:
            yield
        except sqlite3.Error as error:
            place = "" if self.path is None else f"{self.path}: "
            raise CampaignError(f"{place}{what}: {one_line(error)}") from error


def _is_begun(path: Path) -> bool:
    """Whether a file may hold something. Raises `CampaignError` for what no campaign can be in."""
    if not path.exists():
        return False
    if not path.is_file():
        raise CampaignError(f"{path}: not a regular file; choose another")
    journal = Path(f"{path}-journal")
    if not journal.exists():
        return path.stat().st_size > 0
    with path.open("rb") as file:
        # A campaign has a journal for its very first page only, and then writes ahead; SQLite would take any.
        if file.read(PAGE + 1)[PAGE:] and file.seek(18) and file.read(1) == b"\2":
            raise CampaignError(f"{journal}: not of the campaign beside it; take it away")
    return False
