"""Work for the processes of a lab: it says which process does it, and how often it was begun."""

from __future__ import annotations

import os
import time
from pathlib import Path


def work(path: str, seconds: float, answer: object = None) -> object:
    """Write the process's number into a file, take some time, and answer."""
    with Path(path).open("a") as file:
        file.write(f"{os.getpid()}\n")
    time.sleep(seconds)
    return answer


def begun(path: Path) -> list[int]:
    """The processes that began this work, one after the other."""
    return [int(line) for line in path.read_text().split()] if path.exists() else []


def work_for(seconds: float) -> int:
    """Work, and say which process did."""
    time.sleep(seconds)
    return os.getpid()
