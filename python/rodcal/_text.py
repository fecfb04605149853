"""Dicts as TOML and tables as CSV: inputs in memory take the way of files, and are checked like them.

Numbers are written in as many digits as bring back the same number.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ._errors import InputError


def toml(data: Mapping[str, Any]) -> str:
    """A dict with the keys of a file, as TOML; keys whose value is ``None`` are left out."""
    try:
        text = "".join(f"{_key(key)} = {_value(value, key)}\n" for key, value in data.items() if value is not None)
        text.encode()
    except RecursionError:
        found, expected = "nested without end", "a dict with the keys of a file"
    except UnicodeEncodeError:
        found, expected = "a text with half a character (a lone surrogate)", "text"
    else:
        return text
    raise InputError(f"the dict is {found}, expected {expected}", found=found, expected=expected)


def _key(key: Any) -> str:
    name = str(key)
    return name if re.fullmatch("[A-Za-z0-9_-]+", name) else _value(name, "key")


def _value(value: Any, key: str) -> str:
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, str):
        # JSON escapes all that TOML does but for one character
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")
    if isinstance(value, Mapping):
        items = (f"{_key(k)} = {_value(v, f'{key}.{k}')}" for k, v in value.items() if v is not None)
        return "{" + ", ".join(items) + "}"
    if isinstance(value, Iterable):
        return "[" + ", ".join(_value(item, key) for item in value) + "]"
    found = f"a {type(value).__name__}"
    expected = "a number, a text, a list or a dict"
    raise InputError(f"`{key}` is {found}, expected {expected}", found=found, expected=expected)


def csv_text(table: Any, name: str) -> str:
    """A table as CSV: a dict of columns, a structured array, or a pandas DataFrame.

    A column of shape (n, k) stands for k columns: ``q_deg`` for ``q1_deg`` … ``qk_deg``,
    ``xyz_mm`` for ``x_mm``, ``y_mm``, ``z_mm``, ``dxyz_um`` for ``dx_um``, ``dy_um``, ``dz_um``.
    ``None``, NaN and masked values are blanks.
    """
    return csv_of(columns_of(table, name))


def columns_of(table: Any, name: str) -> dict[str, list[str]]:
    """The cells of a table by the names of its columns, which are as long as one another."""
    columns: dict[str, list[str]] = {}

    def add(column: str, cells: list[str]) -> None:
        # the reader takes upper and lower case for the same
        if any(column.lower() == other.lower() for other in columns):
            raise _wrong(name, column, "there twice", "every column once")
        columns[column] = cells

    for key, values in _columns(table, name):
        array = _array(values)
        if array.ndim == 2:
            for part, column in zip(_parts(key, array.shape[1], name), array.T):
                add(part, _cells(column))
        elif array.ndim == 1:
            add(key, _cells(array))
        else:
            raise _wrong(name, key, f"of shape {array.shape}", "one number or text for each row")
    lengths = {len(cells) for cells in columns.values()}
    if len(lengths) > 1:
        found = ", ".join(f"{key}: {len(cells)}" for key, cells in columns.items())
        raise _wrong(name, "columns", f"of different lengths ({found})", "one length for all columns")
    return columns


def csv_of(columns: Mapping[str, list[str]]) -> str:
    """Columns of cells as CSV."""
    rows = [tuple(columns), *zip(*columns.values())]
    return "".join(",".join(map(_quoted, row)) + "\n" for row in rows)


def _quoted(cell: str) -> str:
    """A cell that stays one: no comment, no two cells, no line's end."""
    is_plain = cell == cell.strip() and not any(mark in cell for mark in ',;"#\t\r\n')
    return cell if is_plain else '"' + cell.replace('"', '""') + '"'


def _columns(table: Any, name: str) -> Iterable[tuple[str, Any]]:
    if isinstance(table, Mapping):
        return [(str(key), values) for key, values in table.items() if values is not None]
    if isinstance(table, np.ndarray) and table.dtype.names is not None:
        return [(key, table[key]) for key in table.dtype.names]
    if hasattr(table, "columns") and hasattr(table, "__getitem__"):
        keys = [str(key) for key in table.columns]
        for key in keys:
            if keys.count(key) > 1:
                raise _wrong(name, key, "there twice", "every column once")
        return [(str(key), table[key].to_numpy()) for key in table.columns]
    expected = "a dict of columns, a structured array or a DataFrame"
    raise _wrong(name, "table", f"a {type(table).__name__}", expected)


def _array(values: Any) -> np.ndarray[Any, Any]:
    """Values as an array; what is masked is ``None``."""
    if isinstance(values, np.ma.MaskedArray):
        # filled(None) would fill in what numpy thinks of
        plain: np.ndarray[Any, Any] = values.data.astype(object)
        plain[np.ma.getmaskarray(values)] = None
        return plain
    return np.asarray(values)


def _parts(key: str, count: int, name: str) -> list[str]:
    stem, _, unit = key.rpartition("_")
    if stem == "q":
        return [f"q{number}_{unit}" for number in range(1, count + 1)]
    if stem.endswith("xyz") and count == 3:
        return [f"{stem[:-3]}{axis}_{unit}" for axis in "xyz"]
    raise _wrong(name, key, f"of {count} columns", "q_deg, xyz_mm or dxyz_um, or one column for each key")


def _cells(array: np.ndarray[Any, Any]) -> list[str]:
    return [_cell(value) for value in array.tolist()]


def _cell(value: Any) -> str:
    # pandas' NA says neither yes nor no
    if value is None or value is np.ma.masked or type(value).__name__ in ("NAType", "NaTType"):
        return ""
    if isinstance(value, float):
        return "" if value != value else repr(value)
    if isinstance(value, bytes):
        return value.decode()
    return str(value)


def _wrong(name: str, key: str, found: str, expected: str) -> InputError:
    return InputError(f"{name}: `{key}` is {found}, expected {expected}", name, found=found, expected=expected)
