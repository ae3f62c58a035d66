"""Scenario files as text: the shipped ones by name, any other by path; what is wrong with one not TOML.

Neither pydantic nor pint is needed here, so that listing and completing names is quick.
"""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ..errors import ScenarioError, did_you_mean

SHIPPED = Path(__file__).resolve().parent.parent / "scenarios"
LARGEST = 2**20  # bytes; a scenario is a page of text
_MOST_PARTS = 20  # of a dotted key
_MOST_KEYS = 100  # of a table; none of the format has half as many
_TOO_LONG = "an integer beyond 1e308"
_MOST_BITS = 1024  # of an integer: what floats hold, and what Python shows
_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
_DEEP_KEY = re.compile(rf"(?<![\w-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{_MOST_PARTS}}}")


def names() -> list[str]:
    """Return the names of the scenarios that ship with the package.

    Examples
    --------
    >>> "tilted-turntable" in names()
    True
    """
    return sorted(path.stem for path in SHIPPED.glob("*.toml"))


def title_of(name: str) -> str:
    """Return the title of a shipped scenario.

    Examples
    --------
    >>> title_of("tilted-turntable")
    'Steel ball on a tilted turntable'
    """
    return str(tables_of(name)["title"])


def rolls_along_path(tables: Mapping[str, Any]) -> bool:
    """Whether the tables of a file are those of a path to roll along, not of a motion under forces.

    Examples
    --------
    >>> rolls_along_path({"path": [{"kind": "straight"}]})
    True
    """
    return "path" in tables


@cache
def is_shipped_path(name: str) -> bool:
    """Whether a shipped scenario rolls a ball along a path, without forces.

    Examples
    --------
    >>> is_shipped_path("tilted-turntable")
    False
    """
    return rolls_along_path(tables_of(name))


def locate(name_or_path: str | os.PathLike[str]) -> Path:
    """Return the file of a shipped scenario or of a path; a shipped name goes before a file of the same name.

    Examples
    --------
    >>> locate("tilted-turntable").name
    'tilted-turntable.toml'
    """
    if isinstance(name_or_path, str) and name_or_path in names():
        return SHIPPED / f"{name_or_path}.toml"
    return Path(name_or_path)


def read(name_or_path: str | os.PathLike[str]) -> str:
    """Return the text of a scenario file.

    Examples
    --------
    >>> read("tilted-turntable").splitlines()[0]
    'title = "Steel ball on a tilted turntable"'
    """
    if not isinstance(name_or_path, (str, os.PathLike)):
        remedy = "`trundle list` names those that ship."
        raise ScenarioError("scenario", "must be the name of a scenario or a file", name_or_path, remedy)
    shown = os.fspath(name_or_path)
    try:
        with locate(name_or_path).open("rb") as stream:
            content = stream.read(LARGEST + 1)
    except (FileNotFoundError, NotADirectoryError, ValueError):  # ValueError: a null character in the path
        raise _no_such(str(shown)) from None
    except IsADirectoryError:
        raise ScenarioError("scenario", "must be a file", shown, "This is a folder; name a file in it.") from None
    except OSError as error:
        remedy = f"The system says: {error.strerror or error}."
        raise ScenarioError("scenario", "must be a file that can be read", shown, remedy) from None
    if content.startswith(b"\x89HDF"):
        remedy = f"It is NetCDF: `trundle export {shown} my.toml` writes the scenario of a run that was saved."
        raise ScenarioError("scenario", "must be text in UTF-8", "NetCDF", remedy, str(shown))
    if len(content) > LARGEST:
        raise _too_large(str(shown))
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        wide = content[:2] in (b"\xff\xfe", b"\xfe\xff")
        remedy = "It looks like UTF-16: save it as UTF-8." if wide else "Save it as plain text in UTF-8."
        line = content.count(b"\n", 0, error.start) + 1
        received = f"byte 0x{content[error.start]:02x} in line {line}"
        raise ScenarioError("scenario", "must be text in UTF-8", received, remedy, str(shown)) from None


def _too_large(shown: str) -> ScenarioError:
    return ScenarioError("scenario", "must be a text of at most 1 MiB", "more", "Is this a scenario file?", shown)


def _no_such(shown: str) -> ScenarioError:
    stem = Path(shown).name.removesuffix(".toml")
    known = ", ".join(names())
    alike = [name for name in names() if stem and stem.lower() in name]
    if stem in alike:
        hint = f"Did you mean {stem!r}, the one that ships with trundle?"
    elif alike:
        hint = f"Did you mean {' or '.join(map(repr, alike))}?"
    else:
        hint = did_you_mean(stem, names())
    remedy = f"{hint.strip()} Those that ship with trundle: {known}.".strip()
    return ScenarioError("scenario", "must be a file or the name of a shipped scenario", shown, remedy)


def tables_of(name_or_path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the tables of a scenario that ships, or of a file.

    Examples
    --------
    >>> tables_of("tilted-turntable")["body"]["kind"]
    'solid-sphere'
    """
    return parse(read(name_or_path), os.fspath(name_or_path))


def parse(text: str, source: str) -> dict[str, Any]:
    """Return the tables of a TOML text.

    Examples
    --------
    >>> parse("gravity = 0", "mine")
    {'gravity': 0}
    """
    if not text.strip():
        remedy = "Start from one that ships with trundle: `trundle show tilted-turntable` prints it."
        raise ScenarioError("scenario", "must hold a scenario", text[:20], remedy, source)
    if len(text) > LARGEST:
        raise _too_large(source)
    if (deep := _DEEP_KEY.search(text)) is not None:  # tomllib's time grows with the cube of a key's parts
        line = text.count("\n", 0, deep.start()) + 1
        rule = f"must have keys of at most {_MOST_PARTS} parts"
        raise ScenarioError(f"line {line}", rule, deep[0][:60], "The longest of the format has 4.", source)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _no_toml(text, str(error), source) from None
    except RecursionError:
        raise ScenarioError("scenario", "must not nest this deep", text[:60], "", source) from None
    except ValueError:  # Python reads no integer of more than 4300 digits
        remedy = "Is there an integer of thousands of digits?"
        raise ScenarioError("scenario", "must hold numbers that can be read", text[:60], remedy, source) from None


@dataclass(frozen=True)
class Bounds:
    """How much a scenario may hold, so that nobody waits for what is none.

    Examples
    --------
    >>> Bounds().check({"loads": [{"kind": "force"}]})
    >>> Bounds().check({"loads": [{}] * 101})
    Traceback (most recent call last):
    ...
    trundle.errors.ScenarioError: `loads` must have at most 100 parts; got 101. Is this a scenario?
    """

    loads: int = 100  # entries: to check a run with 300 of them by a second method takes a minute
    path: int = 10_000  # entries
    values: int = 1_000_000  # numbers, texts, lists and tables, all together
    deepest: int = 20  # levels of lists and tables
    remedy: str = "Is this a scenario?"  # what a message says besides

    def check(self, tables: Mapping[str, Any], source: str = "") -> None:
        """Refuse tables that hold more, before anything looks closely at each of them."""
        for key, most in (("loads", self.loads), ("path", self.path)):
            parts = tables.get(key)
            if isinstance(parts, list) and len(parts) > most:
                raise ScenarioError(key, f"must have at most {most} parts", len(parts), self.remedy, source)
        count, level = 0, [tables]
        for _ in range(self.deepest + 1):
            deeper: list[Any] = []
            for part in level:
                if type(part) is int and part.bit_length() > _MOST_BITS:
                    raise ScenarioError(
                        _path_to(part, tables, self.deepest), "must be a finite number", _TOO_LONG, "", source
                    )
                deeper += self._inside(part, source)
            count += len(deeper)
            if count > self.values:
                raise ScenarioError("scenario", f"must have at most {self.values} values", "more", self.remedy, source)
            level = deeper
        if level:
            rule = f"must nest at most {self.deepest} deep"
            raise ScenarioError("scenario", rule, "deeper tables", self.remedy, source)

    def _inside(self, part: Any, source: str) -> Iterable[Any]:
        """Return what a table or list holds; refuse a table of too many keys."""
        if isinstance(part, Mapping):
            if len(part) > _MOST_KEYS:
                rule = f"must have at most {_MOST_KEYS} keys in a table"
                raise ScenarioError("scenario", rule, len(part), self.remedy, source)
            return part.values()
        return part if isinstance(part, list) else ()


def _path_to(wanted: Any, tables: Any, deepest: int, path: str = "") -> str:
    """Return the path of a value in tables and lists, or nothing where it is not in them so deep."""
    if tables is wanted or deepest < 0:
        return path if tables is wanted else ""
    inside = tables.items() if isinstance(tables, Mapping) else enumerate(tables) if isinstance(tables, list) else ()
    for key, part in inside:
        step = f"[{key}]" if isinstance(key, int) else f"{'.' * bool(path)}{key[:60]}"
        if found := _path_to(wanted, part, deepest - 1, path + step):
            return found
    return ""


_STATEMENT = re.compile(r"\s*([\w.-]+)\s*=\s*([+-]?[\d.]+(?:[eE][+-]?\d+)?\s*[A-Za-z°µμ%][^#\"']*?)\s*(?:#.*)?")


def _no_toml(text: str, message: str, source: str) -> ScenarioError:
    place = re.search(r"\(at (line (\d+), column \d+|end of document)\)$", message)
    said = (message[: place.start()] if place else message).strip()
    lines = text.splitlines() or [""]
    number = int(place[2]) if place and place[2] else len(lines)
    line = lines[min(number, len(lines)) - 1].strip()
    where = f"line {number}" if place is None or place[2] is None else place[1]
    unquoted = _STATEMENT.fullmatch(line)
    if unquoted:
        remedy = f'A quantity with a unit stands in quotes: {unquoted[1]} = "{unquoted[2].strip()}".'
    else:
        remedy = 'A line reads key = value; a text, or a quantity with a unit, stands in "quotes".'
    rule = f"is not valid TOML ({said[:1].lower()}{said[1:]})"
    return ScenarioError(where, rule, line, remedy, source)
