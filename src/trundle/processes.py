"""Processes that are started for work: Python's own modules are theirs, whatever folder somebody is in."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

_SAFE = "PYTHONSAFEPATH"  # as Python's option -P


@contextmanager
def own_modules() -> Iterator[None]:
    """Let each Python that is started meanwhile import nothing from the folder that one is in, say a `random.py`.

    Examples
    --------
    >>> import subprocess, sys
    >>> with own_modules():
    ...     line = [sys.executable, "-c", "import sys; print(sys.flags.safe_path)"]
    ...     print(subprocess.run(line, capture_output=True, text=True).stdout.strip())
    True
    """
    before = os.environ.get(_SAFE)
    os.environ[_SAFE] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[_SAFE]
        else:
            os.environ[_SAFE] = before
