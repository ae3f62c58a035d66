"""`trundle lab` in a process of its own, as a user starts it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PATIENCE = 90  # s, for a start on a busy machine


class LabError(Exception):
    """The lab did not start, or did not end as it should."""


@contextmanager
def lab(folder: Path) -> Iterator[str]:
    """Serve the lab on a free port of this machine; yields its origin, without a slash at the end."""
    out, err = folder / "lab.out", folder / "lab.err"
    with out.open("w") as stdout, err.open("w") as stderr:
        process = subprocess.Popen(
            [sys.executable, "-m", "trundle", "lab", "--no-open", "--port", "0"],
            env=os.environ | {"PYTHONUNBUFFERED": "1"},
            stdin=subprocess.DEVNULL,
            stdout=stdout,
            stderr=stderr,
        )
    try:
        yield _address(process, out, err)
    finally:
        _end(process)
    said = err.read_text()
    if process.returncode not in (0, 143) or "Traceback" in said:
        raise LabError(f"trundle lab ended with {process.returncode} and said:\n{said[-3000:]}")


def _address(process: subprocess.Popen[bytes], out: Path, err: Path) -> str:
    """Wait until the lab says where it is, and answers there."""
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until and process.poll() is None:
        if found := re.search(r"(http://[\d.:]+)/", out.read_text()):
            with urllib.request.urlopen(found[1], timeout=PATIENCE) as answer:  # noqa: S310  an address of this machine
                if b"<script" not in answer.read():
                    raise LabError("The page is not built into this copy: python web/build.py bundle")
            return found[1]
        time.sleep(0.05)
    _end(process)
    raise LabError(f"trundle lab did not start within {PATIENCE} s:\n{out.read_text()}{err.read_text()}")


def _end(process: subprocess.Popen[bytes]) -> None:
    """End it as a service manager would, and make sure of it."""
    timer = threading.Timer(20, process.kill)
    timer.start()
    process.terminate()
    process.wait()
    timer.cancel()
