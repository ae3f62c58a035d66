"""Files that hold a trajectory: CSV and its relatives, Parquet, NetCDF."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import InvalidValueError
from ..netcdf import read_netcdf

_TEXT, _PARQUET, _NETCDF = (".csv", ".txt", ".tsv", ".dat"), (".parquet", ".pq"), (".nc", ".nc4", ".h5", ".cdf")


def open_file(path: Path, columns: Mapping[str, str]) -> Any:
    r"""Return what a file holds, by its ending.

    Parameters
    ----------
    path : Path
        Ends in .csv, .txt, .tsv or .dat (text); .parquet; or .nc (NetCDF).
    columns : mapping
        Named columns; a text file without headings takes them in order from the keys.

    Returns
    -------
    pandas.DataFrame or xarray.Dataset
        Not yet looked at.

    Raises
    ------
    InvalidValueError
        If the file does not exist or cannot be read.

    Examples
    --------
    >>> _ = Path("theirs.csv").write_text("t,x,y\n0,1,2\n")
    >>> open_file(Path("theirs.csv"), {}).columns.tolist()
    ['t', 'x', 'y']
    """
    ending = path.suffix.lower()
    readers = {**dict.fromkeys(_TEXT, _text), **dict.fromkeys(_PARQUET, _parquet), **dict.fromkeys(_NETCDF, _netcdf)}
    if ending not in readers:
        raise InvalidValueError("file", "must end in .csv, .txt, .tsv, .dat, .parquet or .nc", str(path))
    if not path.is_file():
        raise InvalidValueError("file", "must exist", str(path), "Check the name and the folder.")
    try:
        return readers[ending](path, columns)
    except InvalidValueError:
        raise
    except ImportError:
        raise InvalidValueError(
            "file",
            "must be CSV or NetCDF where pyarrow is not installed",
            str(path),
            "Install trundle[parquet], or write CSV.",
        ) from None
    except Exception as error:  # noqa: BLE001  each library has a dozen kinds; all mean that the file is no such file
        reason = str(error).strip().partition("\n")[0].rstrip(".") or type(error).__name__
        raise InvalidValueError("file", f"must be a readable {ending} file", str(path), f"{reason}.") from None


def _text(path: Path, columns: Mapping[str, str]) -> Any:
    import pandas as pd

    with path.open(encoding="utf-8-sig") as stream:
        head = [line.rstrip("\r\n") for _, line in zip(range(200), stream, strict=False)]
    remarks = [line for line in head if line.lstrip().startswith("#")]
    rows = [line for line in head if line.strip() and line not in remarks]
    if not rows:
        raise InvalidValueError("file", "must hold rows of numbers", str(path))
    separator = next((sign for sign in ("\t", ";", ",") if sign in rows[0]), r"\s+")
    decimal = "," if separator == ";" and re.search(r"\d,\d", rows[-1]) else "."
    first = re.split(separator, rows[0].strip())
    headless = all(_is_number(cell, decimal) for cell in first)
    given: dict[str, Any] = {"sep": separator, "comment": "#", "decimal": decimal, "encoding": "utf-8-sig"}
    given["skipinitialspace"] = True
    if headless:
        names = _names_of(remarks, separator, len(first)) or [str(i + 1) for i in range(len(first))]
        given |= {"header": None, "names": names}
    table = pd.read_csv(path, **given)
    table.columns = [str(name).strip() for name in table.columns]
    if headless and not columns and names[0] == "1":
        raise InvalidValueError(
            "file",
            "must begin with a line of headings",
            str(path),
            "Add one, such as t,x,y,z, or name the columns by number: columns t=1, x=2, y=3.",
        )
    return table


def _names_of(remarks: list[str], separator: str, count: int) -> list[str]:
    """Return the headings from the last remark that has as many words as there are columns (as numpy.savetxt does)."""
    for line in reversed(remarks):
        for sign in (separator, r"[,;\s]+"):
            words = [word.strip() for word in re.split(sign, line.lstrip("# \t").strip())]
            if len(words) == count:
                return words
    return []


def _is_number(cell: str, decimal: str) -> bool:
    try:
        float(cell.strip().strip('"').replace(decimal, "."))
    except ValueError:
        return False
    return True


def _parquet(path: Path, columns: Mapping[str, str]) -> Any:  # noqa: ARG001
    import pandas as pd

    return pd.read_parquet(path)


def _netcdf(path: Path, columns: Mapping[str, str]) -> Any:  # noqa: ARG001
    import xarray

    with path.open("rb") as stream:
        classic = stream.read(3) == b"CDF"  # NetCDF3, which is no HDF5
    return xarray.load_dataset(path) if classic else read_netcdf(path)
