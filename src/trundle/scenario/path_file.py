"""The scenario file of a ball rolled along a path, without forces: told from the others by its [[path]] tables."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, model_validator
from pydantic_core import CoreSchema, core_schema

from ..errors import InvalidValueError
from .base import Document
from .fields import Measure, Measures, Quantity, written
from .tables import Place2, Radius, Table, Turn4
from .together import each_checked
from .validation_errors import Kinds, Nothing


@dataclass(frozen=True)
class Several:
    """The type of a list of points, each with its own numbers, for use in ``Annotated``.

    Examples
    --------
    >>> Several(Measures(Measure("length"), 2), 2)([[0, 0], ["10 cm", 0]])
    ((0.0, 0.0), (0.1, 0.0))
    """

    each: Measures  # what each point is
    least: int  # how many there must be

    def __call__(self, value: Any) -> tuple[tuple[Quantity, ...], ...]:
        """Return the checked points."""
        if not isinstance(value, (list, tuple)) or len(value) < self.least:
            rule = f"must be a list of at least {self.least} points"
            raise InvalidValueError("", rule, value, f"Write for instance {self.offer}.")
        return each_checked(self._point, value)

    def _point(self, value: Any, key: str) -> Any:
        try:
            return self.each(value)
        except InvalidValueError as error:
            raise InvalidValueError(f"{key}{error.key}", error.rule, error.received, error.remedy) from None

    @property
    def offer(self) -> str:
        """An example of the value as it stands in a file."""
        return f"[{', '.join(['[0, 0]'] * (self.least - 1) + [self.each.offer])}]"

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.__call__)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return what an editor may know of it: a list of so many points."""
        each = self.each.__get_pydantic_json_schema__(schema, handler)
        return {"type": "array", "items": each, "minItems": self.least}


def _check_angle(angle: float, received: Any) -> None:
    if angle == 0:
        remedy = 'Positive turns to the left, negative to the right; for neither take kind = "straight".'
        raise InvalidValueError("", "must not be zero", received, remedy)


Heading = Annotated[float, Measure("angle", example='"90 deg"')]
Turn = Annotated[float, Measure("angle", "positive", example='"90 deg"')]
Bend = Annotated[float, Measure("angle", check=_check_angle, example='"180 deg"')]
Length = Annotated[float, Measure("length", "positive", example='"10 cm"')]
Spacing = Annotated[float, Measure("length", "positive", example='"1 mm"')]
Places = Annotated[tuple[tuple[float, float], ...], Several(Measures(Measure("length", example='"10 cm"'), 2), 2)]

_ON = "Direction of travel, from the first axis towards the second; absent: on as before."


class Ball(Table):
    """The ball, of which only the size matters here."""

    radius: Radius


class StraightPiece(Table):
    """A straight piece: how far, by what angle the ball rolls, or where to."""

    kind: Literal["straight"]
    heading: Heading | None = Field(default=None, description=_ON)
    length: Length | None = Field(default=None, description="How far.")
    turn: Turn | None = Field(default=None, description="The angle by which the ball rolls, instead of the length.")
    to: Place2 | None = Field(default=None, description="Where the contact point goes, instead of heading and length.")

    @model_validator(mode="after")
    def _check(self) -> StraightPiece:
        given = [name for name in ("length", "turn", "to") if getattr(self, name) is not None]
        if not given:
            remedy = 'Say how far (length = "10 cm"), by what angle the ball rolls (turn = "90 deg"), or where to.'
            raise InvalidValueError("length", "must be given, or `turn`, or `to`", Nothing(), remedy)
        if len(given) > 1:
            shown = written(getattr(self, given[1]))
            raise InvalidValueError(given[1], f"must not stand beside `{given[0]}`", shown, "Give one of the two.")
        if self.to is not None and self.heading is not None:
            remedy = "Leave the heading out: it follows from where the path goes."
            raise InvalidValueError("heading", "must not stand beside `to`", written(self.heading), remedy)
        return self


class ArcPiece(Table):
    """A piece of a circle."""

    kind: Literal["arc"]
    heading: Heading | None = Field(default=None, description=_ON)
    radius: Radius = Field(description="Of the circle on the plane.")
    angle: Bend = Field(description="By how much the path turns, positive to the left.")


class CurvePiece(Table):
    """A smooth curve through points: the cubic spline whose parameter is the length of the chords."""

    kind: Literal["curve"]
    points: Places = Field(description="Where the contact point passes; the first is where the path has come to.")
    closed: bool = Field(default=False, description="Whether it closes smoothly to its first point.", strict=True)


Pieces = StraightPiece | ArcPiece | CurvePiece


class PathStart(Table):
    """Where the contact point begins, and how the ball is turned then."""

    position: Place2 | None = Field(default=None, description="Absent: the origin, or where a first curve begins.")
    orientation: Turn4 = Field(default=(1.0, 0.0, 0.0, 0.0), description="Quaternion w, x, y, z.")

    @model_validator(mode="after")
    def _check(self) -> PathStart:
        if not 1e-150 < math.hypot(*self.orientation) < 1e150:
            remedy = "Write [1, 0, 0, 0] for a ball that is not turned."
            raise InvalidValueError(
                "orientation", "must be a quaternion of unit length", written(self.orientation), remedy
            )
        return self


class PathRun(Table):
    """How finely the path is sampled."""

    every: Spacing | None = Field(default=None, description="Absent: a two-hundredth of the path.")


class PathFile(Document):
    """A ball and the path that it rolls along, as a scenario file says them.

    Examples
    --------
    >>> PathFile.load("roll-x-then-y").path[1].heading == math.pi / 2
    True
    """

    kinds: ClassVar[Kinds] = {"path": {"straight": StraightPiece, "arc": ArcPiece, "curve": CurvePiece}}
    rolls_along_path: ClassVar[bool] = True

    body: Ball
    start: PathStart = PathStart()
    path: tuple[Annotated[Pieces, Field(discriminator="kind")], ...]
    sampling: PathRun = Field(default=PathRun(), alias="run")

    @model_validator(mode="after")
    def _check(self) -> PathFile:
        if not self.path:
            remedy = 'Add for instance, each on a line of its own: [[path]] kind = "straight" ; length = "10 cm"'
            raise InvalidValueError("path", "must have at least one piece", [], remedy)
        return self

    @classmethod
    def schema(cls) -> dict[str, Any]:  # type: ignore[override]
        """Return the JSON schema of such a file, for editors.

        Returns
        -------
        dict
            A schema of draft 2020-12.

        Examples
        --------
        >>> sorted(PathFile.schema()["required"])
        ['body', 'path']
        """
        schema = PathFile.model_json_schema()
        return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "trundle path"}
