"""What goes wrong, and what has to be known: exceptions and the warning's category."""

from __future__ import annotations

import os
import re
import warnings
from typing import Any

from . import _rodcal


class RodcalWarning(UserWarning):
    """Something to know before a number is trusted."""


class Error(Exception):
    """Anything that the library refuses.

    Attributes: ``file``, ``line``, ``column`` (from 1) say where; ``found`` and ``expected`` what
    stood there and what would be right; ``hint`` what to do. Each is ``None`` where it makes no
    sense. Inputs that were built in memory are named in angle brackets: line 1 of ``<readings>`` is
    the names of its columns, line 2 its first row. A `FileError` has ``errno``, ``strerror`` and
    ``filename`` too, as every OSError.
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
        errno: int | None = None,
    ) -> None:
        self.message = in_python(_rodcal.visible(message))
        super().__init__(self.message)
        self.file = file
        self.line = line
        self.column = column
        self.found = found
        self.expected = expected
        self.hint = None if hint is None else in_python(_rodcal.visible(hint))
        self.code = errno
        if isinstance(self, OSError):
            reason = self.message if errno is None else os.strerror(errno)
            for name, value in (("errno", errno), ("filename", file), ("strerror", reason)):
                setattr(self, name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        own = (self.message, self.file, self.line, self.column, self.found, self.expected, self.hint, self.code)
        return type(self), own

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
    errno: int | None,
) -> Error:
    """The exception for an error of the library; called by the part in Rust."""
    return _KINDS[kind](message, file, line, column, found, expected, hint, errno)


def warn(messages: list[str], stacklevel: int = 3) -> None:
    """Warns of each message, at the line that called the package."""
    for message in messages:
        warnings.warn(in_python(message), RodcalWarning, stacklevel=stacklevel)


#: Options of the commands that a hint may name: those that take no value, and all others.
_SWITCHES = ("apply", "aligned", "force", "prune")
_OPTIONS = (
    "at",
    "base-link",
    "base",
    "between",
    "campaign",
    "candidates",
    "change-deg",
    "clear-mm",
    "cone-deg",
    "count",
    "criterion",
    "draws",
    "elements",
    "folds",
    "generate",
    "mode",
    "noise-um",
    "poses",
    "rig",
    "robot",
    "robust",
    "rod",
    "samples",
    "tip-link",
    "tool",
    "validation",
    "volume-mm",
)
_OPTION = re.compile(rf"--({'|'.join(_SWITCHES)})\b|--({'|'.join(_OPTIONS)})\b(?: (N|calc|fea|meas|none|huber|tukey)\b)?")
_COMMAND = re.compile(r"`rodcal ([a-z]+)(?: ([a-z]+))?`")


def in_python(text: str) -> str:
    """Words of the library about the command line, about this package: ``--force`` is ``force=True``.

    >>> in_python("replace it with --force, or use --mode fea; `rodcal diagnose rig` says more")
    "replace it with force=True, or use mode='fea'; `rodcal.diagnose_rig` says more"
    """

    def option(match: re.Match[str]) -> str:
        switch, name, value = match.groups()
        if switch:
            return f"{switch}=True"
        name = {"tool": "tool_mm"}.get(name, name.replace("-", "_"))
        return name if value is None else f"{name}={value if value == 'N' else repr(value)}"

    text = _OPTION.sub(option, text).replace("--out writes", "write() writes").replace("with --out", "with write()")
    return _COMMAND.sub(lambda match: f"`rodcal.{'_'.join(part for part in match.groups() if part)}`", text)
