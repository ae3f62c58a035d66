"""A scenario as a notebook shows it: its keys by table, each value as it was written, bare numbers with their unit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, get_args

from pydantic import BaseModel

from ..display import Markup, joined, number, table
from ..units import UNITS
from .fields import Coordinate, Measure, Measures, written
from .path_file import Several

if TYPE_CHECKING:
    from .base import Document

_LONGEST = 12  # list; a longer one is only counted
_SYMBOLS = str.maketrans("*", " ")
Kinds = Mapping[str, tuple[str, ...]]


def shown(document: Document, kinds: Kinds) -> Markup:
    """Return the keys that a scenario gives, and their values.

    Examples
    --------
    >>> from trundle.scenario import ScenarioFile
    >>> "<td>rate</td><td>33.3 rpm</td>" in shown(ScenarioFile.load("tilted-turntable"), {})
    True
    """
    rows, last = [], ""
    for place, key, value in _entries(document, "", kinds):
        rows.append((place if place != last else "", key, value))
        last = place
    return table(rows)


def _entries(model: BaseModel, place: str, kinds: Kinds) -> Iterator[tuple[str, str, str]]:
    for name, info in type(model).model_fields.items():
        value, key = getattr(model, name), info.alias or name
        if name not in model.model_fields_set or (not place and key in ("title", "group", "notes")):
            continue
        inner = f"{place}.{key}".lstrip(".")
        if isinstance(value, BaseModel):
            yield from _entries(value, inner, kinds)
        elif isinstance(value, tuple) and value and isinstance(value[0], BaseModel):
            for i, part in enumerate(value):
                yield from _entries(part, f"{inner}[{i}]", kinds)
        else:
            measure = _measure(info.metadata) or _measure(get_args(info.annotation))
            units = [_unit(kind) for kind in kinds[inner]] if inner in kinds else _units(measure)
            yield place, key, _said(value, units)


def _measure(parts: Any) -> Any:
    """Return what says of which kind a number is, wherever it stands in the type of a field."""
    for part in parts:
        if isinstance(part, Measure | Measures | Several):
            return part
        if found := _measure(getattr(part, "__metadata__", ()) or get_args(part)):
            return found
    return None


def _units(measure: Any) -> list[str]:
    """Return the unit of each component, or of all; nothing where only the surface knows."""
    while isinstance(measure, Measures | Several):
        measure = measure.each
    return [_unit(measure.kind)] if isinstance(measure, Measure) and not isinstance(measure, Coordinate) else []


def _unit(kind: str) -> str:
    return UNITS[kind][0].replace("^2", "²").replace("^3", "³").translate(_SYMBOLS)


def _said(value: Any, units: list[str]) -> str:
    """Return a value as text: what was written, and of a bare number its unit."""
    plain = written(value)
    if isinstance(plain, list):
        if len(plain) > _LONGEST:
            return f"{len(plain)} values"
        each = units if len(units) == len(plain) else units[:1] * len(plain) or [""] * len(plain)
        return joined(["(", joined((_said(v, [unit]) for v, unit in zip(plain, each, strict=True)), ", "), ")"])
    if isinstance(plain, bool | str):
        return str(plain)
    return number(repr(plain), unit=units[0] if units else "")  # every digit, as the file has it
