"""Builders: ways to make a body of one kind, whose parameters say in their annotations what they are."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import signature
from typing import Annotated, Any, TypeVar

from ...errors import InvalidValueError
from ..parts import NOT_NEGATIVE, POSITIVE, Number, Numbers, read_fields
from ..shapes import Shape
from .inertia import CYLINDER_RATIO, SPHERE_RATIO

Make = TypeVar("Make", bound=Callable[..., Any])

_PRODUCTS = "J_xy, J_xz, J_yz, elements of the inertia tensor: J_xy = -∫ x y dm."
_MOMENTS = "J_xx, J_yy, J_zz about the centre of mass"
_ON_THE_DIAGONAL = ("xx", "yy", "zz")
_EACH = Number("inertia", POSITIVE, example=1.6e-5)
_LENGTH = Number("length", example="2 mm")

Radius = Annotated[Any, Number("length", POSITIVE)]
Mass = Annotated[Any, Number("mass", POSITIVE)]
MassOr = Annotated[Any, Number("mass", POSITIVE, "Required, or `density`.", "200 g")]
DensityOr = Annotated[Any, Number("density", POSITIVE, "Of a homogeneous body, instead of the mass.")]
SphereRatio = Annotated[Any, SPHERE_RATIO]
CylinderRatio = Annotated[Any, CYLINDER_RATIO]
Moments = Annotated[Any, Numbers(_EACH, f"{_MOMENTS}.", label="Moment", names=_ON_THE_DIAGONAL)]
OwnMoments = Annotated[
    Any,
    Numbers(_EACH, f"{_MOMENTS}; absent: those of a homogeneous body.", label="Moment", names=_ON_THE_DIAGONAL),
]
Products = Annotated[
    Any, Numbers(Number("inertia", example=1e-6), _PRODUCTS, label="Product", names=("xy", "xz", "yz"))
]
_CENTRE = "Of the shape from the centre of mass, body frame."
Centre = Annotated[Any, Numbers(_LENGTH, _CENTRE, label="Centre of the shape")]
OffCentre = Annotated[Any, Numbers(_LENGTH, _CENTRE, example=(0, 0, "3 mm"), label="Centre of the shape")]
Thickness = Annotated[
    Any, Number("length", NOT_NEGATIVE, "Counts in mass and inertia; the rim stays sharp.", example="2 mm")
]
SemiAxes = Annotated[
    Any,
    Numbers(
        Number("length", POSITIVE),
        "Along the axes of the body frame.",
        example=("5 cm", "4 cm", "3 cm"),
        label="Semi-axis",
    ),
]


def builder(kind: str, shape: type[Shape]) -> Callable[[Make], Make]:
    """Make a method of `Body` the builder of a kind: what it is given is read by its annotations.

    Parameters
    ----------
    kind : str
        Its name in files.
    shape : type
        Of the bodies that it makes.
    """

    def of(make: Make) -> Make:
        parameters = signature(make)

        @wraps(make)
        def build(cls: Any, *args: Any, **named: Any) -> Any:
            given = dict(parameters.bind(cls, *args, **named).arguments)
            given.pop("cls")
            try:
                return make(cls, **read_fields(build, given))
            except InvalidValueError as error:  # in the words that it was given in
                received = given.get(error.key, error.received)
                raise InvalidValueError(error.key, error.rule, received, error.remedy) from None

        made: Any = build
        made.kind, made.shape = kind, shape
        return made

    return of
