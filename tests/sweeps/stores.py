"""What the tests of stores share."""

from __future__ import annotations

from pathlib import Path


def files_of(path: Path) -> dict[str, bytes]:
    return {part.relative_to(path).as_posix(): part.read_bytes() for part in path.rglob("*") if part.is_file()}
