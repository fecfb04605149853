"""What goes wrong, and what has to be known: exceptions and the warning's category."""

from __future__ import annotations

import warnings


class RodcalWarning(UserWarning):
    """Something to know before a number is trusted."""


class Error(Exception):
    """Anything that the library refuses.

    Attributes: ``file``, ``line``, ``column`` (from 1) say where; ``found`` and ``expected`` what
    stood there and what would be right; ``hint`` what to do. Each is ``None`` where it makes no
    sense. Inputs that were built in memory are named in angle brackets: line 1 of ``<readings>`` is
    the names of its columns, line 2 its first row.
    """

    def __init__(
        self,
        message: str,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
        found: str | None = None,
        expected: str | None = None,
        hint: str | None = None,
    ) -> None:
        super().__init__(message)
        self.message = message
        self.file = file
        self.line = line
        self.column = column
        self.found = found
        self.expected = expected
        self.hint = hint

    def __str__(self) -> str:
        return self.message if self.hint is None else f"{self.message}\nhint: {self.hint}"


class InputError(Error, ValueError):
    """A file, a dict, a table or an argument is not what it should be."""


class FileError(Error, OSError):
    """A file cannot be read or written, or stands in the way."""


class NotApplicableError(Error):
    """What was asked for is not possible with these inputs."""


class NumericalError(Error, ArithmeticError):
    """A numerical procedure has no answer."""


_KINDS: dict[str, type[Error]] = {
    "input": InputError,
    "file": FileError,
    "not_applicable": NotApplicableError,
    "numerical": NumericalError,
}


def raised(
    kind: str,
    message: str,
    file: str | None,
    line: int | None,
    column: int | None,
    found: str | None,
    expected: str | None,
    hint: str | None,
) -> Error:
    """The exception for an error of the library; called by the part in Rust."""
    return _KINDS[kind](message, file, line, column, found, expected, hint)


def warn(messages: list[str], stacklevel: int = 3) -> None:
    """Warns of each message, at the line that called the package."""
    for message in messages:
        warnings.warn(message, RodcalWarning, stacklevel=stacklevel)
