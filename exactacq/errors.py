"""The errors a caller can meet; each message says what is wrong, where, and what to do."""

from __future__ import annotations


class ExactacqError(Exception):
    """Root of all errors that exactacq raises on purpose."""


class InvalidScene(ExactacqError, ValueError):
    """A scene breaks a rule of the world: every violation found is in ``violations``."""

    def __init__(self, violations: list[str]) -> None:
        self.violations = tuple(violations)
        super().__init__("; ".join(violations))


class FormatError(ExactacqError, ValueError):
    """A file cannot be read as a scene, or a value cannot be read as a number."""


class Undecided(ExactacqError, ArithmeticError):
    """An exact comparison lies beyond the documented limits; the message names it."""


class AuditError(ExactacqError, AssertionError):
    """A finished run contradicts its scene; the message names the first flaw."""
