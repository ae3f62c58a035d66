"""What every table is, and the types of the numbers in them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Annotated, Any, Self

from pydantic import BaseModel, ConfigDict, GetJsonSchemaHandler, model_validator
from pydantic_core import CoreSchema

from ...errors import InvalidValueError
from ...mechanics.placing import VELOCITY_WORDS
from ..fields import Coordinate, Diameter, Measure, Measures, diameter_of


class Table(BaseModel):
    """A table of the file: frozen, and no key but those named. A diameter may stand instead of a radius."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, defer_build=True)

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy, with other parts where given; what the original described does not come with it.

        Parameters
        ----------
        update : mapping, optional
            Parts by name; they are not checked.
        deep : bool
            Whether the parts are copied too.

        Returns
        -------
        The same class
            The copy.

        Examples
        --------
        >>> import trundle as tr
        >>> on_the_moon = tr.Scenario.load("tilted-turntable").model_copy(update={"gravity": 1.62})
        >>> on_the_moon.system().gravity
        1.62
        """
        copied = super().model_copy(update=update, deep=deep)
        for name in vars(copied).keys() - type(self).model_fields.keys():
            del vars(copied)[name]
        return copied

    @classmethod
    def _diameters(cls) -> dict[str, str]:
        """Return the key of each radius that may be given as a diameter, with that key."""
        return _diameters_of(cls)

    @model_validator(mode="before")
    @classmethod
    def _halve(cls, data: Any) -> Any:
        given = {key: whole for key, whole in cls._diameters().items() if isinstance(data, dict) and whole in data}
        if not given:
            return data
        rest = {key: value for key, value in data.items() if key not in given.values()}
        return rest | {key: Diameter(whole, data[whole], data.get(key)) for key, whole in given.items()}

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return what an editor may know of it: one of radius and diameter."""
        schema = handler.resolve_ref_schema(handler(core_schema))
        for key, whole in cls._diameters().items():
            described = {**schema["properties"][key], "description": f"Twice `{key}`, to be given instead of it."}
            schema["properties"][whole] = described
            if key in schema.get("required", ()):
                schema["required"].remove(key)
                schema.setdefault("allOf", []).append({"oneOf": [{"required": [key]}, {"required": [whole]}]})
        return schema


@cache
def _diameters_of(table: type[Table]) -> dict[str, str]:
    return {key: whole for key in table.model_fields if (whole := diameter_of(table, key)) is not None}


def _check_restitution(share: float, received: Any) -> None:
    if not share <= 1:
        raise InvalidValueError("", "must lie in [0, 1]", received, "1 gives back all that the landing took.")


Radius = Annotated[float, Measure("length", "positive")]
Friction = Annotated[float, Measure("number", "not negative", example="0.3")]
Restitution = Annotated[float, Measure("number", "not negative", _check_restitution, "0.5")]
Angle = Annotated[float, Measure("angle")]
Rate = Annotated[float, Measure("angular velocity")]
Duration = Annotated[float, Measure("time", "positive")]
Step = Annotated[float, Measure("time", "positive", example='"10 ms"')]
Rate3 = Annotated[tuple[float, float, float], Measures(Measure("angular velocity", example='"10 rad/s"'), 3)]
Place2 = Annotated[tuple[float, float], Measures(Coordinate("length", example='"10 cm"'), 2)]
Velocity = Annotated[
    tuple[float, float] | tuple[float, float, float] | str, Measures(Measure("velocity"), 2, VELOCITY_WORDS, most=3)
]
_TURNS = ("heading", "lean", "turn")
Angle3 = Annotated[tuple[float, float, float], Measures(Measure("angle", example='"90 deg"'), 3, names=_TURNS)]
Instant = Annotated[float, Measure("time", example='"2 s"')]
Own = Annotated[
    tuple[float, ...], Measures(Coordinate("angle", example='"30 deg"', otherwise="angular velocity"), 1, most=8)
]
Height = Annotated[float, Measure("length", "not negative", example='"5 cm"')]
Turn4 = Annotated[
    tuple[float, float, float, float], Measures(Measure("number", example="1.0"), 4, names=("w", "x", "y", "z"))
]
