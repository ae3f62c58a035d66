"""The values in a scenario file: numbers and texts with units, each checked under its own name."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from datetime import date, time
from decimal import Decimal
from typing import Any

from pydantic import BaseModel, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from ..errors import InvalidValueError, did_you_mean
from ..mechanics.expressions import Expression, is_formula
from ..units import UNITS, to_si
from .together import each_checked


class Quantity(float):
    """A float in SI that remembers the text it was written as.

    Parameters
    ----------
    value : float
        The number in SI.
    text : str, optional
        What the user wrote, such as ``"33.3 rpm"``.

    Examples
    --------
    >>> Quantity(0.025, "25 mm") * 2, Quantity(0.025, "25 mm").text
    (0.05, '25 mm')
    """

    text: str | None

    def __new__(cls, value: float, text: str | None = None) -> Quantity:
        """Make the number and keep the text beside it."""
        quantity = super().__new__(cls, value)
        quantity.text = text
        return quantity

    def __getnewargs__(self) -> tuple[float, str | None]:  # type: ignore[override]
        return float(self), self.text

    @property
    def written(self) -> str | float:
        """The text as the user wrote it, or the bare number."""
        return float(self) if self.text is None else self.text


# Beyond these sizes products of a few numbers leave the range of floats; no experiment comes near.
SMALLEST_DIVISOR, LARGEST = 1e-30, 1e30


def written(value: Any) -> Any:
    """Return what a user wrote for a number, or for each of a list of numbers.

    Examples
    --------
    >>> written((Quantity(0.025, "25 mm"), Quantity(0.0)))
    ['25 mm', 0.0]
    """
    if isinstance(value, (list, tuple)):
        return [written(part) for part in value]
    return value.written if isinstance(value, Quantity) else value


def bare(value: Any) -> Any:
    """Return numbers without the texts that they were written as, and anything else as it is.

    Examples
    --------
    >>> bare((Quantity(0.025, "25 mm"), "co-rotating", None))
    (0.025, 'co-rotating', None)
    """
    if isinstance(value, tuple):
        return tuple(map(bare, value))
    return float(value) if isinstance(value, Quantity) else value


@dataclass(frozen=True)
class Diameter:
    """What a user wrote for a diameter, on its way to the radius of the same table."""

    key: str  # ``"diameter"``, or ``"ring_diameter"`` of a ``"ring_radius"``
    value: Any  # what stands there
    radius: Any = None  # what stands beside it as the radius; None where nothing does

    def __repr__(self) -> str:
        return repr(self.value)

    def halved(self, measure: Measure) -> Quantity:
        """Return the radius, written in the unit of the diameter."""
        if self.radius is not None:
            radius = self.key.replace("diameter", "radius")
            raise InvalidValueError("", f"must not stand beside `{radius}`", self.value, "Give one of the two.")
        whole = measure(self.value)
        found = _NUMBER.match(whole.text or "")
        text = f"{Decimal(found[0]) / 2}{whole.text[found.end() :]}" if found and whole.text else None
        half = float(whole) / 2
        return Quantity(half, text if text is not None and to_si(text, measure.kind, "") == half else None)


def diameter_of(table: type[BaseModel], key: str) -> str | None:
    """Return the key that may stand instead of a radius of a table; None where the key is none.

    Examples
    --------
    >>> from trundle.scenario.tables import SUPPORTS
    >>> diameter_of(SUPPORTS["bowl"], "radius"), diameter_of(SUPPORTS["bowl"], "rim")
    ('diameter', None)
    """
    notes = table.model_fields[key].metadata if key.endswith("radius") and key in table.model_fields else ()
    lengths = [note for note in notes if isinstance(note, Measure) and (note.kind, note.sign) == ("length", "positive")]
    return key.removesuffix("radius") + "diameter" if lengths else None


_NUMBER = re.compile(r"\s*[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?")

Check = Callable[[float, Any], None]


@dataclass(frozen=True)
class Measure:
    """The type of one number of a scenario file, for use in ``Annotated``.

    Examples
    --------
    >>> Measure("length", "positive")("25 mm")
    0.025
    """

    kind: str  # one of `trundle.units.UNITS`
    sign: str = "any"  # ``"positive"``, ``"not negative"`` or ``"any"``
    # a further check of (number in SI, value as it came); it raises `InvalidValueError`, its key ``""``
    check: Check | None = None
    example: str | None = None  # what an error message offers; the kind's own example where it is absent

    def __call__(self, value: Any, key: str = "") -> Quantity:
        """Return the checked number; `key` is its place inside its own field, such as ``"[1]"``."""
        if isinstance(value, Diameter):
            return value.halved(self)
        if isinstance(value, Quantity) and value.text is not None:
            value = value.text
        if isinstance(value, bool) or not isinstance(value, (int, float, str)):
            raise InvalidValueError(key, f"must be {_a(self.kind)}", value, _not_a_number(value, self.offer))
        number = to_si(value, self.kind, key)
        if self.check is not None:
            self.check(number, value)
        if self.sign == "positive" and not number > 0:
            raise InvalidValueError(key, "must be positive", value, f"Write for instance {self.offer}.")
        if self.sign == "not negative" and number < 0:
            raise InvalidValueError(key, "must not be negative", value, f"Write for instance {self.offer}.")
        if abs(number) > LARGEST or (self.sign == "positive" and number < SMALLEST_DIVISOR):
            low = f"{SMALLEST_DIVISOR:g}" if self.sign == "positive" else "0"
            raise InvalidValueError(key, f"must be {low} to {LARGEST:g} in size, in SI", value, "Check the unit.")
        return Quantity(number + 0.0, value if isinstance(value, str) else None)

    @property
    def offer(self) -> str:
        """An example of the value as it stands in a file."""
        return self.example or f'"{UNITS[self.kind][1]}"'

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.__call__)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return what an editor may know of it: a number in SI, or a text with a unit."""
        number: dict[str, Any] = {"type": "number"}
        if self.sign != "any":
            number["exclusiveMinimum" if self.sign == "positive" else "minimum"] = 0
        unit, example = UNITS[self.kind]
        described = f"{_a(self.kind).capitalize()}: a bare number in {unit}" if unit else "A bare number"
        text = {"type": "string", "pattern": r"^\s*[+\-−]?(\d|\.\d)", "examples": [example]}
        return {
            "anyOf": [number, text],
            "description": described + (", or a text with a unit." if unit else "."),
        }


@dataclass(frozen=True)
class Coordinate(Measure):
    """The type of a coordinate of one of two kinds; which, the surface or the motion says later.

    Parameters
    ----------
    kind, sign, check, example
        As of a `Measure`.
    otherwise : str
        The other kind.

    Examples
    --------
    >>> Coordinate("length")("10 cm"), round(Coordinate("length")("180 deg"), 6)
    (0.1, 3.141593)
    """

    otherwise: str = "angle"

    def __call__(self, value: Any, key: str = "") -> Quantity:
        """Return the checked number."""
        try:
            return super().__call__(value, key)
        except InvalidValueError:
            try:
                return Measure(self.otherwise)(value, key)
            except InvalidValueError:
                pass
            raise


@dataclass(frozen=True)
class Varying(Measure):
    """The type of a number that may also be a formula in the time, in SI.

    Examples
    --------
    >>> Varying("force")("0.1*sin(3*t)"), Varying("force")("0.1 N")
    ('0.1*sin(3*t)', 0.1)
    """

    def __call__(self, value: Any, key: str = "") -> Any:
        """Return the checked number, or the text of the checked formula."""
        if not is_formula(value):
            return super().__call__(value, key)
        return Expression.parse(value, ("t",), key).text

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return what an editor may know of it: a number, or any text."""
        described = super().__get_pydantic_json_schema__(schema, handler)
        formula = {"type": "string", "description": "A formula in the time t in s, SI.", "examples": ["0.1*sin(3*t)"]}
        return {**described, "anyOf": [*described["anyOf"], formula]}


@dataclass(frozen=True)
class Measures:
    """The type of a list of numbers of one kind, for use in ``Annotated``.

    Examples
    --------
    >>> Measures(Measure("length"), 2)(["10 cm", 0])
    (0.1, 0.0)
    """

    each: Measure  # what each number is
    size: int  # how many
    words: tuple[str, ...] = ()  # texts that may stand instead of the list
    most: int | None = None  # how many there may be at most, where some may be left out at the end; absent: `size`
    names: tuple[str, ...] = ("x", "y", "z")  # what tells one from the other at their controls; absent: the axes

    def __call__(self, value: Any) -> tuple[Quantity, ...] | str:
        """Return the checked numbers, or the word."""
        if self.words and isinstance(value, str):
            if value in self.words:
                return value
            raise InvalidValueError("", self._rule, value, (did_you_mean(value, self.words) or self._remedy).strip())
        if not isinstance(value, (list, tuple)) or not self.size <= len(value) <= (self.most or self.size):
            raise InvalidValueError("", self._rule, value, self._remedy)
        return each_checked(self.each, value)

    @property
    def offer(self) -> str:
        """An example of the value as it stands in a file: zeros follow the first component, where they may."""
        first = self.each.offer
        if self.each.sign == "positive":
            return f"[{', '.join([first] * self.size)}]"
        zero = re.sub(r"[\d.]+(e-?\d+)?", "0", first, count=1)
        return f"[{', '.join([first] + [zero] * (self.size - 1))}]"

    @property
    def _rule(self) -> str:
        sizes = str(self.size) if self.most is None else f"{self.size} or {self.most}"
        *others, last = [f"a list of {sizes}", *(f'"{word}"' for word in self.words)]
        return f"must be {', '.join(others)} or {last}" if others else f"must be {last}"

    @property
    def _remedy(self) -> str:
        return f"Write for instance {self.offer}."

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.__call__)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return what an editor may know of it: a list of so many numbers, or a word."""
        each = self.each.__get_pydantic_json_schema__(schema, handler)
        numbers = {"type": "array", "items": each, "minItems": self.size, "maxItems": self.most or self.size}
        return {"anyOf": [numbers, {"enum": list(self.words)}]} if self.words else numbers


def _a(kind: str) -> str:
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"


def _not_a_number(value: Any, offer: str) -> str:
    if isinstance(value, (date, time)):
        return f"A date is no quantity; write for instance {offer}."
    return f"Write for instance {offer}."
