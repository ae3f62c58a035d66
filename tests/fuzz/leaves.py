"""The numbers of a scenario's tables, each with what the format says of it: found in the format's own classes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from trundle.errors import InvalidValueError
from trundle.scenario.fields import Measure, Measures
from trundle.scenario.tables import Table

NUMBER = re.compile(r"(?<![\w.*])(?<!\*\* )\d+\.?\d*(?:[eE][+-]?\d+)?|(?<![\w.*])\.\d+")  # in a formula, no exponent
QUANTITY = re.compile(r"\s*([+-]?\d+\.?\d*(?:[eE][+-]?\d+)?)\s*(.*)")


@dataclass(frozen=True)
class Leaf:
    """One value in nested tables.

    Parameters
    ----------
    holder : dict or list
        What it is in.
    key : str or int
        Where.
    measure : Measure or None
        What the format asks of it; None of a text that is a formula.
    """

    holder: Any
    key: Any
    measure: Measure | None

    @property
    def value(self) -> Any:
        return self.holder[self.key]

    def allows(self, value: Any) -> bool:
        """Whether the format takes a value here, as far as the value alone can tell."""
        try:
            return self.measure is None or self.measure(value) is not None
        except InvalidValueError:
            return False


def kind_of(table: type[BaseModel]) -> str:
    """Return the `kind` that stands for a table."""
    return str(get_args(table.model_fields["kind"].annotation)[0])


def alternatives(annotation: Any) -> list[Any]:
    """Return the members of a union, without None and without what is annotated to the whole; else the type itself."""
    if get_origin(annotation) is Annotated:
        inner, *notes = get_args(annotation)
        if any(isinstance(note, FieldInfo) for note in notes):  # a discriminator
            return alternatives(inner)
        return [annotation]
    if get_origin(annotation) is None or get_origin(annotation) in (tuple, Literal):
        return [annotation]
    return [each for part in get_args(annotation) if part is not type(None) for each in alternatives(part)]


def tables_of(annotation: Any) -> list[type[Table]]:
    """Return which tables a type allows; of a tuple, in it."""
    if get_origin(annotation) is tuple:
        return [table for part in get_args(annotation) if part is not ... for table in tables_of(part)]
    found = alternatives(annotation)
    return [part for part in found if isinstance(part, type) and issubclass(part, Table)]


def notes_of(field: FieldInfo) -> list[Any]:
    """Return what is annotated to the value of a field."""
    inner = [part for part in alternatives(field.annotation) if get_origin(part) is Annotated]
    return [*field.metadata, *(note for part in inner for note in get_args(part)[1:])]


def leaves(model: type[BaseModel], data: dict[str, Any]) -> Iterator[Leaf]:
    """Return each number, quantity and formula in the tables of a scenario."""
    for name, field in model.model_fields.items():
        key = field.alias or name
        if key not in data or key in ("title", "notes"):
            continue
        value, tables = data[key], tables_of(field.annotation)
        if tables:
            kinds = {} if len(tables) == 1 else {kind_of(table): table for table in tables}
            for each in value if isinstance(value, list) else [value]:
                yield from leaves(kinds[each["kind"]] if kinds else tables[0], each)
            continue
        measures = [note for note in notes_of(field) if isinstance(note, (Measure, Measures))]
        places = [(value, i) for i in range(len(value))] if isinstance(value, list) else [(data, key)]
        for holder, place in places:
            if re.search(r"\d", str(holder[place])):  # no word, such as "still"
                yield Leaf(holder, place, next((getattr(note, "each", note) for note in measures), None))


def times(value: Any, factor: float) -> Any:
    """Return a number, a quantity or the first number of a formula times a factor, in the words that it came in."""
    if isinstance(value, bool):
        return value
    if isinstance(value, (int, float)):
        return rounded(value * factor)
    if not isinstance(value, str):
        return value
    whole = QUANTITY.fullmatch(value)
    if whole and not re.search(r"[*(]|\bt\b", whole[2]):
        return f"{rounded(float(whole[1]) * factor)!r} {whole[2]}".strip()
    return NUMBER.sub(lambda found: repr(rounded(float(found[0]) * abs(factor))), value, count=1)


def rounded(number: float) -> float:
    """Return six digits of a number."""
    return float(f"{number:.6g}") + 0.0
