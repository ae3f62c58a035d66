"""The C compiler of this machine, if there is one."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

from ..errors import SolverError
from .printers.c import FLAGS


def compiler() -> str | None:
    """Return the command of a C compiler: what CC says, or cc, gcc or clang; None where there is none.

    Examples
    --------
    >>> found = compiler()
    """
    return next(
        (found for name in (os.environ.get("CC", ""), "cc", "gcc", "clang") if (found := shutil.which(name))), None
    )


def shared_library(command: str, sources: list[Path], target: Path, *options: str) -> None:
    """Compile sources to a shared library."""
    shared = "-dynamiclib" if sys.platform == "darwin" else "-shared"
    line = [command, *FLAGS, "-fPIC", shared, *options, "-o", str(target), *map(str, sources), "-lm"]
    done = subprocess.run(line, capture_output=True, text=True, errors="replace", check=False)  # noqa: S603
    if done.returncode:
        raise SolverError(f"{command} does not compile it: {done.stderr.strip()[:2000]}")
