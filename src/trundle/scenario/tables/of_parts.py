"""The table of a part, made from what the part says about itself."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Literal, Union

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, create_model, model_validator
from pydantic_core import CoreSchema, core_schema

from ...errors import InvalidValueError
from ...mechanics.expressions import Expression
from ...mechanics.parts import (
    Choice,
    Formula,
    Lengths,
    Maker,
    Number,
    Numbers,
    Part,
    PartsOf,
    defaults_of,
    fields_of,
    sentence_of,
)
from ..fields import Measure, Measures, Varying, bare
from ..together import each_checked
from .values import Table


@dataclass(frozen=True)
class Worded(Measure):
    """The type of a number in whose place some texts may stand.

    Examples
    --------
    >>> Worded("angular velocity", words=("still",))("still")
    'still'
    """

    words: tuple[str, ...] = ()

    def __call__(self, value: Any, key: str = "") -> Any:
        """Return the checked number, or the word."""
        return value if isinstance(value, str) and value in self.words else super().__call__(value, key)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return what an editor may know of it."""
        described = super().__get_pydantic_json_schema__(schema, handler)
        return {**described, "anyOf": [{"enum": list(self.words)}, *described["anyOf"]]}


@dataclass(frozen=True)
class Direction(Measures):
    """The type of three numbers that are a direction.

    Examples
    --------
    >>> Direction(Measure("number"), 3)([0, 2, 0])
    (0.0, 2.0, 0.0)
    """

    def __call__(self, value: Any) -> Any:
        """Return the checked numbers."""
        found = super().__call__(value)
        if not any(found):
            raise InvalidValueError("", "must have a direction", value, "Write for instance [1, 0, 0].")
        return found


@dataclass(frozen=True)
class ListOfLengths:
    """The type of a list of lengths of any size, or of a list of such lists, for use in ``Annotated``.

    Examples
    --------
    >>> ListOfLengths()(["1 cm", 0]), ListOfLengths(rows=True)([[0, "1 mm"], []])
    ((0.01, 0.0), ((0.0, 0.001), ()))
    """

    rows: bool = False  # whether it is a list of lists

    def __call__(self, value: Any, key: str = "") -> tuple[Any, ...]:
        """Return the checked numbers."""
        if not isinstance(value, (list, tuple)):
            kind = "a list of lists of lengths" if self.rows else "a list of lengths"
            raise InvalidValueError(key, f"must be {kind}", value, f"Write for instance {self.offer}.")
        each = ListOfLengths() if self.rows else Measure("length")
        return each_checked(each, value, key)

    @property
    def offer(self) -> str:
        """An example of the value as it stands in a file."""
        return "[[0, 0.01], [0, 0.02]]" if self.rows else '[0, "5 mm", "20 mm", "45 mm"]'

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.__call__)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return what an editor may know of it."""
        each = ListOfLengths() if self.rows else Measure("length")
        return {"type": "array", "items": each.__get_pydantic_json_schema__(schema, handler)}


@dataclass(frozen=True)
class FormulaText:
    """The type of a formula in named variables, for use in ``Annotated``.

    Examples
    --------
    >>> FormulaText(Formula(("x", "y")))("x*y")
    'x*y'
    """

    formula: Formula  # what the part says about it

    @property
    def offer(self) -> str:
        """An example of the value as it stands in a file."""
        return json.dumps(self.formula.example)

    def __call__(self, value: Any) -> str:
        """Return the text of the checked formula."""
        if not isinstance(value, str):
            rule = f"must be a formula in {', '.join(self.formula.variables)}"
            raise InvalidValueError("", rule, value, f"Write for instance {self.offer}.")
        return Expression.parse(value, self.formula.variables, "").text

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.__call__)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return what an editor may know of it: a text."""
        described = f"A formula in {', '.join(self.formula.variables)}, SI."
        return {"type": "string", "description": described, "examples": [self.formula.example]}


_HOME = __package__  # where a pickle looks for a class that is made here


class PartTable(Table):
    """The table of a part: its keys are the part's fields."""

    part: ClassVar[Maker]

    def build(self) -> Any:
        """Return the part."""
        return type(self).part(**{name: _value(getattr(self, name)) for name in fields_of(type(self).part)})

    @model_validator(mode="after")
    def _check(self) -> Any:
        if any(isinstance(field, PartsOf) for field in fields_of(type(self).part).values()):
            self.build()  # it knows which parts go together
        return self


def _value(value: Any) -> Any:
    """Return what stands in a table as the mechanics takes it."""
    if isinstance(value, Table):
        return value.build()  # type: ignore[attr-defined]
    if isinstance(value, tuple):
        return tuple(map(_value, value))
    return bare(value)


def table_of(
    part: Any,
    others: tuple[type[Table], ...] = (),
    *,
    base: type[PartTable] = PartTable,
    name: str = "",
    instead: Mapping[str, Lengths] = MappingProxyType({}),
    more: Mapping[str, Any] = MappingProxyType({}),
) -> type[Table]:
    """Return the class of the tables of a part: of its class, or of a builder of bodies.

    Examples
    --------
    >>> import math
    >>> from trundle.mechanics.motions import Spin
    >>> table_of(Spin)(kind="spin", rate="30 rpm").build().rate == math.pi
    True
    """
    own: Mapping[str, Any] = fields_of(part)
    defaults = dict(defaults_of(part))
    if instead:
        first = next(iter(own))
        own = {first: own[first], **instead, **own}
        defaults |= dict.fromkeys((first, *instead))
    keys: dict[str, Any] = {"kind": (Literal[part.kind], ...)}
    for key, field in own.items():
        kind = annotation_of(field, others)
        label = getattr(field, "label", "") or None
        noted: Any = Field(
            defaults.get(key, ...), title=label, description=field.said or None, examples=_examples(field)
        )
        keys[key] = (kind | None if defaults.get(key, 0) is None else kind, noted)
    name = name or part.__name__ + next(base.__name__ for base in part.__mro__ if Part in base.__bases__)
    made = create_model(name, __base__=base, __module__=_HOME, __doc__=sentence_of(part), **keys, **more)
    made.part = part
    return made


def _examples(field: Any) -> list[Any] | None:
    example = getattr(field, "example", None)
    if example is None or isinstance(field, Formula):
        return None
    return [list(example) if isinstance(example, tuple) else example]


def annotation_of(field: Any, others: tuple[type[Table], ...] = ()) -> Any:
    """Return the type of what stands in a file for a field of a part.

    Examples
    --------
    >>> annotation_of(Choice(("inside", "outside"), "side"))
    typing.Literal['inside', 'outside']
    """
    match field:
        case Number():
            return Annotated[float | str if field.varies or field.words else float, _measure(field)]
        case Numbers():
            each = float | str if field.each.varies else float
            measures = Direction if field.direction else Measures
            return Annotated[tuple[each, each, each], measures(_measure(field.each), 3, names=field.names)]  # type: ignore[valid-type]
        case Formula():
            return Annotated[str, FormulaText(field)]
        case Choice():
            return Literal[field.words]
        case Lengths():
            kind = tuple[tuple[float, ...], ...] if field.rows else tuple[float, ...]
            return Annotated[kind, ListOfLengths(field.rows)]
        case PartsOf():
            return tuple[one_of(others), ...]  # type: ignore[misc]
    raise TypeError(field)


def one_of(tables: tuple[type[Table], ...]) -> Any:
    """Return the type of one of several tables, told apart by kind."""
    return Annotated[Union[tables], Field(discriminator="kind")]  # noqa: UP007  they are known only now


def _measure(number: Number) -> Measure:
    example = None if number.example is None else json.dumps(number.example)
    if number.varies:
        return Varying(number.dimension, number.sign, None, example)
    if number.words:
        return Worded(number.dimension, number.sign, number.limit, example, tuple(number.words))
    return Measure(number.dimension, number.sign, number.limit, example)


__all__ = ["Direction", "FormulaText", "PartTable", "Worded", "annotation_of", "one_of", "table_of"]
