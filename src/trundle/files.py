"""Files that are written whole or not at all, and read in one piece or refused in one line."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import RunFileError, TrundleError

if TYPE_CHECKING:
    import xarray


@contextmanager
def written_whole(target: Path) -> Iterator[Path]:
    """Give a temporary file to write, beside the target, and rename it to the target at the end.

    Whatever interrupts the writing, the target is as it was before; only a killed process leaves the temporary
    file, whose name begins with a dot.

    Parameters
    ----------
    target : pathlib.Path
        The file to make; its folder must exist.

    Yields
    ------
    pathlib.Path
        The temporary file, in the same folder and with the same ending.

    Raises
    ------
    TrundleError
        If the folder does not exist or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with written_whole(Path(folder) / "a.txt") as temporary:
    ...         _ = temporary.write_text("whole")
    ...     (Path(folder) / "a.txt").read_text()
    'whole'
    """
    if not target.parent.is_dir():
        raise TrundleError(f"{target} cannot be written: there is no folder {target.parent}. Make it first.")
    temporary = target.with_name(f".{target.stem}.{os.getpid()}{target.suffix}")
    try:
        yield temporary
        temporary.replace(target)
    except OSError as error:
        reason = error.strerror or str(error)
        raise TrundleError(f"{target} cannot be written: {reason}. Choose another folder or make room.") from None
    finally:
        temporary.unlink(missing_ok=True)


def read_netcdf(path: Path) -> xarray.Dataset:
    """Read a NetCDF4 file into memory.

    Parameters
    ----------
    path : pathlib.Path
        The file.

    Returns
    -------
    xarray.Dataset
        As it is in the file: times are numbers.

    Raises
    ------
    RunFileError
        If there is no such file, or it is no NetCDF4, or damaged.

    Examples
    --------
    >>> _ = Path("text.nc").write_text("not NetCDF")
    >>> read_netcdf(Path("text.nc"))
    Traceback (most recent call last):
    ...
    trundle.errors.RunFileError: text.nc: `file` must be NetCDF4; got 'text.nc'. It is damaged, or something else (...).
    """
    import h5py
    import xarray

    if path.is_dir():
        raise RunFileError("file", "must not be a folder", path.name, "Name a file in it.", str(path))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of what is odd in a file, xarray warns before it fails
            with h5py.File(path) as file:
                dict(file.attrs)  # where one is damaged, h5netcdf leaves a file half open that complains when it goes
            return xarray.load_dataset(path, engine="h5netcdf", decode_times=False)
    except FileNotFoundError:
        raise RunFileError("file", "must exist", path.name, "Check the name and the folder.", str(path)) from None
    except Exception as error:  # noqa: BLE001  a damaged file makes four libraries raise a dozen kinds
        remedy = f"It is damaged, or something else ({first_line(error)})."
        raise RunFileError("file", "must be NetCDF4", path.name, remedy, str(path)) from None


def first_line(error: Exception) -> str:
    r"""Return the first line of what an error says, or its kind where it says nothing.

    Parameters
    ----------
    error : Exception
        Of somebody else's.

    Returns
    -------
    str
        Without the full stop.

    Examples
    --------
    >>> first_line(ValueError("No such thing.\nLook elsewhere."))
    'No such thing'
    """
    text = getattr(error, "strerror", None) or str(error)
    return text.strip().partition("\n")[0].rstrip(".") or type(error).__name__
