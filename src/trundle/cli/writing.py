"""Files that appear whole or not at all: written to a folder of their own beside the target, then renamed."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from ..errors import InvalidValueError, SolverError, TrundleError
from ..files import staging
from . import signals


class CannotWriteError(TrundleError):
    """The files of a run could not be written."""


def check_folder(folder: Path, names: tuple[str, ...], key: str = "--output") -> None:
    """Find out, before the work is done, whether files can be written to a folder that may not exist yet.

    Examples
    --------
    >>> check_folder(Path("out"), ("run.nc",))
    """
    try:
        above = _nearest_folder(folder)
        taken = next((name for name in names if (folder / name).is_dir()), None)
        allowed = os.access(above, os.W_OK | os.X_OK)
    except (OSError, ValueError) as error:  # a name too long, for one
        remedy = f"The system says: {_reason(error)}."
        raise InvalidValueError(key, "must be a folder", str(folder), remedy) from None
    if not above.is_dir():
        raise InvalidValueError(key, "must be a folder", str(folder), f"'{above}' is a file.")
    if taken:
        raise InvalidValueError(key, "must leave room for files", str(folder), f"'{taken}' is a folder there.")
    if not allowed:
        raise CannotWriteError(f"'{above}' may not be written to: name another folder by {key}. Nothing was written.")


def write_together(folder: Path, files: Mapping[str, Callable[[Path], object]]) -> list[Path]:
    """Write several files so that none of them is ever there in part.

    Examples
    --------
    >>> write_together(Path("out"), {"note.txt": lambda path: path.write_text("whole")})[0].read_text()
    'whole'
    """
    try:
        above = _nearest_folder(folder)
        with staging(above, folder.absolute().parent) as stage:
            for name, write in files.items():
                write(stage / name)
                _to_disk(stage / name)
            with _uninterrupted():
                _move(stage, folder, above, list(files))
            signals.wrote()
    except (OSError, RuntimeError) as error:  # RuntimeError: HDF5 on a full disk
        if isinstance(error, RuntimeError) and "HDF5" not in str(error) and "H5" not in str(error):
            raise
        raise _failure(folder, error) from None
    except SolverError:  # what should be written cannot be worked out: of that the folder knows nothing
        raise
    except TrundleError as error:  # a writer that explains itself
        raise _failure(folder, error) from None
    return [folder / name for name in files]


def _nearest_folder(folder: Path) -> Path:
    """Return the folder itself, or the nearest thing above it that exists."""
    return next(path for path in (folder.absolute(), *folder.absolute().parents) if path.exists())


def _to_disk(path: Path) -> None:
    with path.open("rb") as stream:
        os.fsync(stream.fileno())


def _move(stage: Path, folder: Path, above: Path, names: list[str]) -> None:
    made = [path for path in (folder.absolute(), *folder.absolute().parents) if above in path.parents]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name in names:
            (stage / name).replace(folder / name)
    except OSError:
        for path in made:
            with contextlib.suppress(OSError):
                path.rmdir()
        raise


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Do not hear Ctrl-C for the moment that the renaming takes, lest some files be new and some old."""
    before = {}
    with contextlib.suppress(ValueError):  # only the main thread hears signals
        for name in ("SIGINT", "SIGTERM", "SIGHUP"):
            if hasattr(signal, name):
                number = getattr(signal, name)
                before[number] = signal.signal(number, signal.SIG_IGN)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _failure(folder: Path, error: Exception) -> CannotWriteError:
    return CannotWriteError(f"could not write to '{folder}': {_reason(error)}. Nothing was written.")


def _reason(error: Exception) -> str:
    text = str(error)
    for number, words in _REASONS.items():  # HDF5 has the system's words in its own message
        if getattr(error, "errno", None) == number or os.strerror(number) in text:
            return words
    first = getattr(error, "strerror", None) or text.partition("\n")[0] or type(error).__name__
    return first.rstrip(".")


_REASONS = {
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "the disk quota is used up",
    errno.EFBIG: "a file would be larger than is allowed",
    errno.EACCES: "permission denied",
    errno.EROFS: "it is read-only",
}
