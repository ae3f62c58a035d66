"""Tables whose keys are the words of a builder of `Body`, which checks them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from pydantic import Field, model_validator

from ....errors import InvalidValueError
from ...complaints import Nothing
from ...fields import Measure, Measures, written
from ..values import Mass, Table

if TYPE_CHECKING:
    from ....mechanics.bodies import Body


@dataclass(frozen=True)
class AllPositive(Measures):
    """The type of a list of numbers none of which may be zero.

    Examples
    --------
    >>> AllPositive(Measure("length", "positive"), 2).offer
    '["25 mm", "25 mm"]'
    """

    @property
    def offer(self) -> str:
        """An example of the value as it stands in a file."""
        return f"[{', '.join([self.each.offer] * self.size)}]"


Thickness = Annotated[float, Measure("length", "not negative", example='"2 mm"')]
SemiAxes = Annotated[tuple[float, float, float], AllPositive(Measure("length", "positive"), 3)]
_Density = Annotated[float, Measure("density", "positive", example='"7.8 g/cm^3"')]
_Centre = Annotated[tuple[float, float, float], Measures(Measure("length", example='"2 mm"'), 3)]
_Moments = Annotated[
    tuple[float, float, float],
    AllPositive(Measure("inertia", "positive", example="2.5e-5"), 3, names=("xx", "yy", "zz")),
]
_Products = Annotated[
    tuple[float, float, float], Measures(Measure("inertia", example="1e-6"), 3, names=("xy", "xz", "yz"))
]

# Keys that may be left out.
MassOr = Annotated[Mass | None, Field(description="Required, or `density`.", examples=["200 g"])]
DensityOr = Annotated[_Density | None, Field(description="Of a homogeneous body, instead of the mass.")]
Centre = Annotated[
    _Centre | None, Field(title="Centre of the shape", description="Of the shape from the centre of mass, body frame.")
]
Moments = Annotated[_Moments, Field(title="Moment", description="J_xx, J_yy, J_zz about the centre of mass.")]
OwnMoments = Annotated[
    _Moments | None,
    Field(
        title="Moment", description="J_xx, J_yy, J_zz about the centre of mass; absent: those of a homogeneous body."
    ),
]
Products = Annotated[
    _Products | None,
    Field(title="Product", description="J_xy, J_xz, J_yz, elements of the inertia tensor: J_xy = -∫ x y dm."),
]


class Built(Table):
    """A table with the keys of one builder."""

    builder: ClassVar[str]

    @model_validator(mode="after")
    def _check(self) -> Any:
        try:
            self.build()
        except InvalidValueError as error:
            received = Nothing() if error.received is None else error.received
            raise InvalidValueError(error.key, error.rule, received, error.remedy) from None
        return self

    def build(self) -> Body:
        """Return the body."""
        from ....mechanics.bodies import Body

        given = {name: getattr(self, name) for name in type(self).model_fields if name != "kind"}
        # In the user's own words, so that the builder's messages show them.
        body: Body = getattr(Body, self.builder)(**{k: written(v) for k, v in given.items() if v is not None})
        return body
