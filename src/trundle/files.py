"""Files that are written whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import TrundleError


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
