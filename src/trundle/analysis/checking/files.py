"""Files that hold a trajectory: CSV and its relatives, Parquet, NetCDF."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from ...extras import need
from ...simulation.netcdf import read_netcdf

_MISSING = ("", "nan", "na", "n/a", "null", "none", "-", "--")  # what programs write where they have no number
_WIDE = (b"\xff\xfe", b"\xfe\xff")  # how a file in UTF-16 begins
_TEXT, _PARQUET, _NETCDF = (".csv", ".txt", ".tsv", ".dat"), (".parquet", ".pq"), (".nc", ".nc4", ".h5", ".cdf")


@dataclass(frozen=True)
class Table:
    """The columns of a text file, of numbers or of text, and the line in which each of their rows stands."""

    columns: dict[str, Any]
    lines: tuple[int, ...]


def open_file(path: Path, columns: Mapping[str, str]) -> Any:
    r"""Return what a file holds, by its ending.

    Examples
    --------
    >>> _ = Path("theirs.csv").write_text("t,x,y\n0,1,2\n")
    >>> list(open_file(Path("theirs.csv"), {}).columns)
    ['t', 'x', 'y']
    """
    ending = path.suffix.lower()
    readers = {**dict.fromkeys(_TEXT, _text), **dict.fromkeys(_PARQUET, _parquet), **dict.fromkeys(_NETCDF, _netcdf)}
    if ending not in readers:
        raise InvalidValueError("file", "must end in .csv, .txt, .tsv, .dat, .parquet or .nc", str(path))
    if not path.is_file():
        raise InvalidValueError("file", "must exist", str(path), "Check the name and the folder.")
    if ending in _PARQUET:
        need("parquet", str(path), "CSV and NetCDF need nothing more.")
    try:
        return readers[ending](path, columns)
    except InvalidValueError:
        raise
    except Exception as error:  # noqa: BLE001  each library has a dozen kinds; all mean that the file is no such file
        reason = str(error).strip().partition("\n")[0].rstrip(".") or type(error).__name__
        raise InvalidValueError("file", f"must be a readable {ending} file", str(path), f"{reason}.") from None


def _text(path: Path, columns: Mapping[str, str]) -> Any:
    content = path.read_bytes()
    lines = content.decode("utf-16" if content[:2] in _WIDE else "utf-8-sig").splitlines()
    remarks = [line for line in lines if line.lstrip().startswith("#")]
    rows = [(i + 1, bare) for i, line in enumerate(lines) if (bare := line.partition("#")[0].strip("\r\n")).strip()]
    if not rows:
        raise InvalidValueError("file", "must hold rows of numbers", str(path))
    separator = next((sign for sign in ("\t", ";", ",") if sign in rows[0][1]), None)
    decimal = "," if separator != "," and re.search(r"\d,\d", rows[-1][1]) else "."
    cells = [(line, _cells(text, separator)) for line, text in rows]
    headless = all(_is_number(cell, decimal) for cell in cells[0][1])
    names = _names_of(remarks, separator, len(cells[0][1])) if headless else _trimmed(cells.pop(0)[1])
    if headless and not names:
        if not columns:
            raise InvalidValueError(
                "file",
                "must begin with a line of headings",
                str(path),
                "Add one, such as t,x,y,z, or name the columns by number: columns t=1, x=2, y=3.",
            )
        names = [str(i + 1) for i in range(len(_trimmed(cells[0][1])))]
    return _table(names, cells, decimal)


def _cells(text: str, separator: str | None) -> list[str]:
    if separator is None:
        return text.split()
    cells = next(csv.reader([text], delimiter=separator)) if '"' in text else text.split(separator)
    return [cell.strip() for cell in cells]


def _trimmed(cells: list[str]) -> list[str]:
    """Return the cells without empty ones at the end, which a separator at the end of a line makes."""
    while cells and not cells[-1]:
        cells = cells[:-1]
    return cells


def _table(names: list[str], cells: list[tuple[int, list[str]]], decimal: str) -> Table:
    """Return columns of numbers, or of text where one of them is none."""
    names = [name or f"column {i + 1}" for i, name in enumerate(names)]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InvalidValueError("headings", "must differ from each other", f"{twice!r} twice", "Rename one.")
    count, rows = len(names), []
    for line, row in cells:
        if len(row) > count:
            row = row[:count] + _trimmed(row[count:])
        if len(row) != count:
            raise InvalidValueError(
                "file",
                f"must have a cell for each of its {count} headings in every line",
                f"{len(row)} in line {line}",
                "Is a heading missing, or part of the line?",
            )
        rows.append(row)
    return Table({name: _column([row[i] for row in rows], decimal) for i, name in enumerate(names)},
                 tuple(line for line, _ in cells))  # fmt: skip


def _column(cells: list[str], decimal: str) -> Any:
    plain = [cell.replace(decimal, ".") for cell in cells] if decimal != "." else cells
    try:
        return np.array([float("nan" if cell.lower() in _MISSING else cell) for cell in plain])
    except ValueError:
        return np.array(plain, dtype=object)


def _names_of(remarks: list[str], separator: str | None, count: int) -> list[str]:
    """Return the headings from the last remark that has as many words as there are columns (as numpy.savetxt does)."""
    for line in reversed(remarks):
        for sign in (separator or r"\s+", r"[,;\s]+"):
            words = [word.strip() for word in re.split(sign, line.lstrip("# \t").strip())]
            if len(words) == count:
                return words
    return []


def _is_number(cell: str, decimal: str) -> bool:
    try:
        float(cell.strip().strip('"').replace(decimal, "."))
    except ValueError:
        return cell.lower() in _MISSING
    return True


def _parquet(path: Path, columns: Mapping[str, str]) -> Any:  # noqa: ARG001
    import pandas as pd

    return pd.read_parquet(path)


def _netcdf(path: Path, columns: Mapping[str, str]) -> Any:  # noqa: ARG001
    import xarray

    with path.open("rb") as stream:
        classic = stream.read(3) == b"CDF"  # NetCDF3, which is no HDF5
    return xarray.load_dataset(path) if classic else read_netcdf(path)
