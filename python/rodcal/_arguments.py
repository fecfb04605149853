"""Numbers of arguments, before the part in Rust takes them: what does not fit is said, not overflown."""

from __future__ import annotations

import operator
from collections.abc import Iterable
from typing import Any

import numpy as np

from ._errors import InputError

#: What an integer of the other side holds, whatever machine it is.
MOST = 2**63 - 1


def whole(name: str, value: Any) -> int:
    """A whole number, 0 or more."""
    try:
        number = operator.index(value)
    except TypeError:
        raise wrong(name, shown(value), "a whole number") from None
    if not 0 <= number <= MOST:
        raise wrong(name, shown(number), f"a whole number from 0 to {MOST}")
    return number


def maybe_whole(name: str, value: Any) -> int | None:
    """A whole number, or none."""
    return None if value is None else whole(name, value)


def numbers(name: str, value: Any, count: int) -> list[float]:
    """So many real numbers."""
    expected = f"{count} numbers"
    try:
        array = np.asarray(value)
        if np.iscomplexobj(array):
            raise wrong(name, "complex", expected)
        found = [float(x) for x in array.reshape(-1)] if array.ndim == 1 else []
    except (TypeError, ValueError, OverflowError):
        raise wrong(name, shown(value), expected) from None
    if len(found) != count:
        raise wrong(name, shown(value), expected)
    return found


def names(name: str, value: Any) -> list[str]:
    """Several texts; one alone is a list of one."""
    if isinstance(value, str):
        return [value]
    found = list(value) if isinstance(value, Iterable) else [None]
    texts = [item for item in found if isinstance(item, str)]
    if len(texts) < len(found):
        raise wrong(name, shown(value), "names in a list")
    return texts


def shown(value: Any) -> str:
    """A value in a message, not longer than a name."""
    kind = type(value).__name__
    if isinstance(value, (int, float, str, bool)) or value is None:
        try:
            text = repr(value)
        except ValueError:  # integers of thousands of digits have no text
            return f"a {kind}"
        return text if len(text) <= 40 else f"{text[:39]}…"
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    return f"a {kind} of {len(value)}" if isinstance(value, (list, tuple, dict)) else f"a {kind}"


def wrong(name: str, found: str, expected: str) -> InputError:
    """The error of an argument."""
    return InputError(f"`{name}` is {found}, expected {expected}", found=found, expected=expected)
