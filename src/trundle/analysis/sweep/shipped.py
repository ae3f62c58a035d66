"""Sweeps as files: the shipped ones by name, any other by path."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...errors import InvalidValueError, did_you_mean
from ...scenario import files
from .plan import Plan, read_plan

FOLDER = Path(__file__).resolve().parents[2] / "sweeps"


def titles() -> list[tuple[str, str]]:
    """Return names and titles of the sweeps that ship with the package.

    Examples
    --------
    >>> [name for name, _ in titles()]
    ['rattleback', 'shaken-bowl', 'tippe-top']
    """
    return [(path.stem, str(tables_of(path.stem)["title"])) for path in sorted(FOLDER.glob("*.toml"))]


def tables_of(name: str) -> dict[str, Any]:
    """Return a sweep that ships with the package as its file has it.

    Examples
    --------
    >>> tables_of("tippe-top")["scenario"]
    'tippe-top'
    """
    path = FOLDER / f"{name}.toml"
    return files.parse(path.read_text("utf-8"), path.name)


def load(name_or_path: str) -> Plan:
    """Read a sweep that ships with the package, or a file, and check it.

    Examples
    --------
    >>> load("tippe-top").document.title
    'Tippe top that turns over'
    """
    place = FOLDER / f"{name_or_path}.toml"
    if not place.is_file():
        place = Path(name_or_path)
    if not place.is_file():
        known = [path.stem for path in sorted(FOLDER.glob("*.toml"))]
        remedy = f"{did_you_mean(name_or_path, known)} Those that ship with trundle: {', '.join(known)}.".strip()
        raise InvalidValueError("FILE", "must be a sweep's file or the name of a shipped one", name_or_path, remedy)
    return read_plan(files.parse(files.read(place), str(name_or_path)), str(name_or_path), near=place.parent)
