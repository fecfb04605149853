"""A bar on stderr for what takes time."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Union

#: ``True`` for a bar, or what is called with how many tasks are done, and of how many (``None``: unknown).
Progress = Union[bool, Callable[[int, Union[int, None]], object], None]

_WIDTH = 40


class Bar:
    """Draws ``what  ████████      120/200, 3 s left`` and wipes it when all is done."""

    def __init__(self, what: str) -> None:
        self.what = what
        self.start = time.monotonic()
        self.drawn = 0

    def __call__(self, done: int, total: int | None) -> None:
        elapsed = time.monotonic() - self.start
        if total is None:
            line = f"{self.what}: {done} done, {elapsed:.0f} s"
        else:
            share = min(1.0, done / total) if total else 1.0
            bar = ("█" * round(_WIDTH * share)).ljust(_WIDTH)
            left = f", {elapsed * (1 - share) / share:.0f} s left" if share > 0 else ""
            line = f"{self.what} {bar} {done}/{total}{left}"
        sys.stderr.write("\r" + line.ljust(self.drawn))
        self.drawn = len(line)
        sys.stderr.flush()

    def close(self) -> None:
        """Wipes it."""
        if self.drawn:
            sys.stderr.write("\r" + " " * self.drawn + "\r")
            sys.stderr.flush()


class Told:
    """Who is told, while the work lasts."""

    def __init__(self, progress: Progress, what: str) -> None:
        self.bar = Bar(what) if progress is True else None
        self.tell = self.bar if progress is True else (progress or None)

    def __enter__(self) -> Callable[[int, int | None], object] | None:
        return self.tell

    def __exit__(self, *_: object) -> None:
        if self.bar is not None:
            self.bar.close()
