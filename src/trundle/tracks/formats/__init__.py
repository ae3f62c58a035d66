"""The formats that are read. A new one is a file here and its name in this list, the narrower before the wider."""

from __future__ import annotations

from collections.abc import Sequence

from ...errors import InvalidValueError
from ...files import first_line
from ..file import File
from ..options import Options
from ..table import Table
from .base import Format, GridFormat
from .capstone import Capstone
from .deeplabcut import DeepLabCut, DeepLabCutHDF5
from .logger_pro import LoggerPro
from .netcdf import NetCDF
from .parquet import Parquet
from .phyphox import Phyphox
from .plain import PlainTable
from .sleap import Sleap
from .tracker_export import TrackerExport
from .tracker_project import TrackerProject
from .vernier import VernierVideoAnalysis

FORMATS: tuple[Format, ...] = (
    TrackerProject(),
    TrackerExport(),
    LoggerPro(),
    VernierVideoAnalysis(),
    Capstone(),
    Phyphox(),
    DeepLabCut(),
    DeepLabCutHDF5(),
    Sleap(),
    NetCDF(),
    Parquet(),
    PlainTable(),
)


def endings() -> list[str]:
    """Return the endings of files that are read, those of plain tables first."""
    return list(dict.fromkeys(ending for one in reversed(FORMATS) for ending in one.endings))


def read_file(file: File, options: Options) -> tuple[Format, Sequence[Table]]:
    r"""Read a file as the first format that recognises it.

    Examples
    --------
    >>> from pathlib import Path
    >>> found, tables = read_file(File(Path("a.csv"), b"t,x,y\n0,1,2\n"), Options())
    >>> found.name, [column.heading for column in tables[0].columns]
    ('a table with headings', ['t', 'x', 'y'])
    """
    try:
        one = next((one for one in FORMATS if file.ending in one.endings and one.recognises(file)), None)
        if one is not None:
            return one, one.read(file, options)
    except (InvalidValueError, ImportError, MemoryError):
        raise
    except Exception as error:  # noqa: BLE001  each library has a dozen kinds; all mean that the file is no such file
        reason = first_line(error)
        raise InvalidValueError(
            "file", f"must be a readable {file.ending} file", str(file.path), f"{reason}."
        ) from None
    kinds = [one.name for one in FORMATS if file.ending in one.endings]
    raise InvalidValueError(
        "file", f"must hold {' or '.join(kinds)}", str(file.path), "Is it another kind of file under this ending?"
    )


__all__ = ["FORMATS", "Format", "GridFormat", "endings", "read_file"]
