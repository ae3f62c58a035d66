"""Compiled integrators in the user's cache: the least recently used goes, so that it does not grow without end."""

from __future__ import annotations

import contextlib
import hashlib
import itertools
import os
import pickle
import stat
import time
from pathlib import Path
from typing import Any

from ..files import written_whole

MOST_BYTES = 512 * 2**20  # some four hundred integrators
MOST_DAYS = 90.0  # not used for longer
_OURS = ("taylor-*.pickle", "law-*.py", "__pycache__/law-*.nb?")  # the last two of earlier versions
_ROOM = 0.8  # share of the most that is left, so that not each new one asks for room


def cache_folder() -> Path:
    """Return the folder of the user's cache in which compiled integrators are kept.

    Examples
    --------
    >>> cache_folder().name
    'trundle'
    """
    from platformdirs import user_cache_path

    return user_cache_path("trundle", appauthor=False)


def load(key: str) -> Any:
    """Read a compiled integrator; anything wrong with it means to compile again.

    A pickle can run code, so it must belong to this user and be writable by nobody else.

    Examples
    --------
    >>> load("nothing of this name") is None
    True
    """
    path = _path(key)
    try:
        if not (_trusted(path.parent) and _trusted(path)):
            return None
        digest, _, body = path.read_bytes().partition(b"\n")
        if hashlib.sha256(body).hexdigest().encode() != digest:
            return None
        with contextlib.suppress(OSError):
            os.utime(path)  # used now: its time says how long ago that was
        return pickle.loads(body)  # noqa: S301  own file, checked above
    except Exception:  # noqa: BLE001  a cache must never be a reason to fail
        return None


def store(key: str, integrator: Any) -> None:
    """Write a compiled integrator, whole or not at all; a cache that cannot be written is done without.

    Examples
    --------
    See `trundle.solve.taylor`.
    """
    folder = cache_folder()
    with contextlib.suppress(Exception):
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        body = pickle.dumps(integrator)
        with written_whole(_path(key)) as temporary:
            temporary.touch(mode=0o600)  # whatever the umask, or `load` would not trust it
            temporary.write_bytes(hashlib.sha256(body).hexdigest().encode() + b"\n" + body)
        prune(folder)


def _trusted(place: Path) -> bool:
    """Tell whether a file or folder belongs to this user, and nobody else may write it.

    Windows has no such owners and modes; there the folder of the user's cache is nobody else's.
    """
    if not hasattr(os, "getuid"):
        return True
    facts = place.stat()
    return facts.st_uid == os.getuid() and not facts.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def prune(folder: Path) -> None:
    """Remove what was not used for long, and the least recently used of what is too much.

    Several processes may do so at once: a file that is gone is compiled again by whoever asks for it.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = (Path(folder) / "taylor-a.pickle").write_bytes(b"")
    ...     prune(Path(folder))
    ...     print(len(list(Path(folder).iterdir())))
    1
    """
    found = []
    for path in itertools.chain.from_iterable(map(folder.glob, _OURS)):
        with contextlib.suppress(OSError):
            facts = path.lstat()
            found.append((facts.st_mtime, facts.st_size, path))
    total, since = sum(size for _, size, _ in found), time.time() - MOST_DAYS * 86_400
    room = MOST_BYTES if total <= MOST_BYTES else _ROOM * MOST_BYTES
    for used, size, path in sorted(found)[:-1]:  # the last one used is what this is for
        if used >= since and total <= room:
            break
        with contextlib.suppress(OSError):
            path.unlink()
        total -= size


def _path(key: str) -> Path:
    return cache_folder() / f"taylor-{key}.pickle"
