"""Files that are written whole or not at all, and read in one piece or refused in one line."""

from __future__ import annotations

import os
import shutil
import tempfile
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import InvalidValueError, RunFileError, TrundleError

if TYPE_CHECKING:
    import xarray

FILM_ENDINGS = (".mp4", ".mov", ".m4v", ".avi", ".webm", ".mkv", ".mpg", ".mpeg", ".mts", ".3gp", ".wmv", ".ogv")
_STAGE, _UNHELD = ".trundle-", ".trundle+"  # folders of a process that holds them, and for an instant before that
_HEAP = b"GCOL\x01\0\0\0"  # where a file of HDF5 keeps its words
_OLD = 86_400.0  # s: older than this is what nobody writes to any more, where no lock can tell


@contextmanager
def staging(above: Path, *others: Path) -> Iterator[Path]:
    """Make a folder to write in, beside what is to be made, that goes at the end; and clear those of the killed.

    Only a process that is killed leaves its folder. It held a lock on it, which went with the process: so whoever
    writes there next sees that nobody needs it any more.

    Examples
    --------
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with staging(Path(folder)) as stage:
    ...         print(stage.name[:9], len(list(Path(folder).iterdir())))
    ...     print(list(Path(folder).iterdir()))
    .trundle- 1
    []
    """
    for place in {above, *others}:
        _clear(place)
    made = Path(tempfile.mkdtemp(prefix=_UNHELD, dir=above))
    stage = made.with_name(made.name.replace(_UNHELD, _STAGE))  # it has this name only while it is held
    held = None
    try:
        held = hold(made)
        made.replace(stage)
        yield stage
    finally:
        for folder in (made, stage):
            shutil.rmtree(folder, ignore_errors=True)
        if held is not None:
            os.close(held)


def hold(folder: Path) -> int | None:
    """Lock a folder, and return what holds the lock; None where somebody else has it, or folders cannot be locked.

    Examples
    --------
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     lock = hold(Path(folder))
    ...     print(hold(Path(folder)))
    ...     os.close(lock)
    None
    """
    try:
        import fcntl

        opened = os.open(folder, os.O_RDONLY | os.O_CLOEXEC)
    except (ImportError, OSError):
        return None
    try:
        fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(opened)
        return None
    return opened


def _clear(above: Path) -> None:
    """Remove the folders of processes that were killed; never a reason to fail."""
    with suppress(OSError):
        for left in [*above.glob(f"{_STAGE}*"), *above.glob(f"{_UNHELD}*")]:
            with suppress(OSError):
                _clear_one(left)


def _clear_one(left: Path) -> None:
    if left.is_symlink() or not left.is_dir():
        return
    old = time.time() - left.stat().st_mtime > _OLD
    held = hold(left) if left.name.startswith(_STAGE) else None
    if held is not None or old:
        shutil.rmtree(left, ignore_errors=True)
    if held is not None:
        os.close(held)


@contextmanager
def written_whole(target: Path) -> Iterator[Path]:
    """Give a temporary file to write, in a folder beside the target, and rename it to the target at the end.

    Whatever interrupts the writing, the target is as it was before.

    Examples
    --------
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with written_whole(Path(folder) / "a.txt") as temporary:
    ...         _ = temporary.write_text("whole")
    ...     (Path(folder) / "a.txt").read_text()
    'whole'
    """
    if not target.parent.is_dir():
        raise TrundleError(f"{target} cannot be written: there is no folder {target.parent}. Make it first.")
    try:
        with staging(target.parent) as stage:
            yield stage / target.name
            (stage / target.name).replace(target)
    except OSError as error:
        reason = error.strerror or str(error)
        raise TrundleError(f"{target} cannot be written: {reason}. Choose another folder or make room.") from None


def read_netcdf(path: Path) -> xarray.Dataset:
    """Read a NetCDF4 file into memory.

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
            check_heaps(path.read_bytes())
            with h5py.File(path) as file:
                dict(file.attrs)  # where one is damaged, h5netcdf leaves a file half open that complains when it goes
            return xarray.load_dataset(path, engine="h5netcdf", decode_times=False)
    except FileNotFoundError:
        raise RunFileError("file", "must exist", path.name, "Check the name and the folder.", str(path)) from None
    except Exception as error:  # noqa: BLE001  a damaged file makes four libraries raise a dozen kinds
        remedy = f"It is damaged, or something else ({first_line(error)})."
        raise RunFileError("file", "must be NetCDF4", path.name, remedy, str(path)) from None


def check_heaps(content: bytes) -> None:
    r"""Refuse a file of HDF5 whose words lie in a heap that leads back to itself: the library would never return.

    A heap of words begins with GCOL, and holds objects that each say how long they are; the last is free space.

    Examples
    --------
    >>> check_heaps(b"GCOL\x01\0\0\0" + (64).to_bytes(8, "little") + bytes(48))
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `file` must be whole; got 'words that lead back to themselves'. It is damaged.
    """
    place = content.find(_HEAP)
    while place >= 0:
        end = place + int.from_bytes(content[place + 8 : place + 16], "little")
        at = place + 16
        while at + 16 <= min(end, len(content)):
            index, size = (
                int.from_bytes(content[at : at + 2], "little"),
                int.from_bytes(content[at + 8 : at + 16], "little"),
            )
            step = 16 + -(-size // 8) * 8 if index else size  # the size of what is free has its own 16 bytes in it
            if step < 16 or at + step > end:
                raise InvalidValueError("file", "must be whole", "words that lead back to themselves", "It is damaged.")
            at += step
        place = content.find(_HEAP, place + 4)


def first_line(error: Exception) -> str:
    r"""Return the first line of what an error says, or its kind where it says nothing.

    Examples
    --------
    >>> first_line(ValueError("No such thing.\nLook elsewhere."))
    'No such thing'
    """
    text = getattr(error, "strerror", None) or str(error)
    return text.strip().partition("\n")[0].rstrip(".") or type(error).__name__
