"""Tables of supports: a surface, how it leans and moves."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, model_validator
from pydantic_core import CoreSchema, core_schema

from ...errors import InvalidValueError
from ..fields import Measure, Measures, Quantity, written
from ..together import each_checked
from .motions import FixedMotion, Motions
from .values import AnyTilt, Friction, Radius, Restitution, Rim, Table, Tilt

if TYPE_CHECKING:
    from ...mechanics.surfaces import Surface
    from ...mechanics.system import Support


def _check_upright(tilt: float, received: Any) -> None:
    if not abs(tilt) < math.pi / 2:
        remedy = "At 90 deg the surface's axis lies level. Write deg behind degrees."
        raise InvalidValueError("", "must lie in (-90 deg, 90 deg)", received, remedy)


def _check_half_angle(angle: float, received: Any) -> None:
    if not 0 < angle < math.pi / 2:
        remedy = "It is the angle between axis and wall. Write deg behind degrees."
        raise InvalidValueError("", "must lie between 0 and 90 deg", received, remedy)


def _check_not_zero(radius: float, received: Any) -> None:
    if radius == 0:
        raise InvalidValueError("", "must not be zero", received, "Positive makes a bowl, negative a mound.")


@dataclass(frozen=True)
class Lengths:
    """The type of a list of lengths of any size, or of a list of such lists, for use in ``Annotated``.

    Parameters
    ----------
    rows : bool
        Whether it is a list of lists.

    Examples
    --------
    >>> Lengths()(["1 cm", 0]), Lengths(rows=True)([[0, "1 mm"], []])
    ((0.01, 0.0), ((0.0, 0.001), ()))
    """

    rows: bool = False

    def __call__(self, value: Any, key: str = "") -> tuple[Any, ...]:
        """Return the checked numbers."""
        if not isinstance(value, (list, tuple)):
            kind = "a list of lists of lengths" if self.rows else "a list of lengths"
            raise InvalidValueError(key, f"must be {kind}", value, f"Write for instance {self.offer}.")
        each = Lengths() if self.rows else Measure("length")
        return each_checked(each, value, key)

    @property
    def offer(self) -> str:
        """An example of the value as it stands in a file."""
        return "[[0, 0.01], [0, 0.02]]" if self.rows else '[0, "5 mm", "20 mm", "45 mm"]'

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.__call__)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return what an editor may know of it."""
        each = Lengths() if self.rows else Measure("length")
        return {"type": "array", "items": each.__get_pydantic_json_schema__(schema, handler)}


Upright = Annotated[float, Measure("angle", check=_check_upright)]
HalfAngle = Annotated[float, Measure("angle", check=_check_half_angle, example='"30 deg"')]
VertexRadius = Annotated[float, Measure("length", check=_check_not_zero)]
SemiAxes = Annotated[tuple[float, float, float], Measures(Measure("length", "positive"), 3)]
Row = Annotated[tuple[float, ...], Lengths()]
Rows = Annotated[tuple[tuple[float, ...], ...], Lengths(rows=True)]
Side = Literal["inside", "outside"]
Motion = Annotated[Motions, Field(discriminator="kind")]

_TILT = Field(default=0.0, description="Angle of the axis to the vertical; down the first axis.")
_FORMULA = "In SI: numbers, the variables, pi, + - * / **, sin, cos, tan, sqrt, exp, log, abs and hypot."


class OnSurface(Table):
    """The keys of every support: each lists its own first and then these."""

    if TYPE_CHECKING:
        kind: str
        tilt: float

    friction: Friction | None = Field(default=None, description="Coulomb coefficient; absent: never slips.")
    kinetic_friction: Friction | None = Field(
        default=None, description="Coefficient while it slips, at most `friction`; absent: the same."
    )
    restitution: Restitution = Field(
        default=0.0, description="Of a landing, 0 to 1: e, of which e² of the energy comes back."
    )
    tangential_restitution: Restitution = Field(
        default=0.0, description="Of a landing, 0 to 1: e_t, of which e_t² of what friction took comes back."
    )
    motion: Motion = FixedMotion(kind="fixed")

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        for key in OnSurface.model_fields:  # pydantic puts what is inherited first
            cls.model_fields[key] = cls.model_fields.pop(key)

    def surface(self) -> Surface:
        """Return the surface."""
        raise NotImplementedError

    @model_validator(mode="after")
    def _check(self) -> Self:
        self.surface()  # it knows what its numbers must be to each other
        try:
            self.build()
        except InvalidValueError as error:
            received = written(getattr(self, error.key, error.received))
            raise InvalidValueError(error.key, error.rule, received, error.remedy) from None
        return self

    def build(self) -> Support:
        """Return the support."""
        from ...mechanics.system import Support

        kinetic = None if self.kinetic_friction is None else float(self.kinetic_friction)
        return Support(
            self.surface(),
            motion=self.motion.build(),
            tilt=float(self.tilt),
            friction=None if self.friction is None else float(self.friction),
            kinetic_friction=kinetic,
            restitution=float(self.restitution),
            tangential_restitution=float(self.tangential_restitution),
        )


class PlaneSupport(OnSurface):
    """A plane, bounded by a circular rim or unbounded."""

    kind: Literal["plane"]
    tilt: Tilt = Field(default=0.0, description="Angle of the plane's normal to the vertical; down the first axis.")
    rim: Rim | None = Field(default=None, description="Radius of the rim; absent: unbounded.")

    def surface(self) -> Surface:
        """Return the plane."""
        from ...mechanics.surfaces import Plane

        return Plane(_as_given(self.rim))


class CylinderSupport(OnSurface):
    """A circular cylinder about the third axis, rolled on from inside or outside; a tilt of 90 deg lays it down."""

    kind: Literal["cylinder"]
    radius: Radius
    side: Side = "inside"
    tilt: AnyTilt = Field(default=0.0, description="Angle of the axis to the vertical; 90 deg: a trough or a log.")
    rim: ClassVar[None] = None

    def surface(self) -> Surface:
        """Return the cylinder."""
        from ...mechanics.surfaces import Cylinder

        return Cylinder(_as_given(self.radius), self.side)


class BowlSupport(OnSurface):
    """The inside of a sphere; its lowest point is the origin."""

    kind: Literal["bowl"]
    radius: Radius
    rim: Rim | None = Field(default=None, description="Distance of the edge from the axis; absent: a closed sphere.")
    tilt: Upright = _TILT

    def surface(self) -> Surface:
        """Return the bowl."""
        from ...mechanics.surfaces import Bowl

        return Bowl(_as_given(self.radius), _as_given(self.rim))


class DomeSupport(OnSurface):
    """The outside of a sphere; its top is the origin."""

    kind: Literal["dome"]
    radius: Radius
    rim: Rim | None = Field(default=None, description="Distance of the edge from the axis; absent: the whole sphere.")
    tilt: Upright = _TILT

    def surface(self) -> Surface:
        """Return the dome."""
        from ...mechanics.surfaces import Dome

        return Dome(_as_given(self.radius), _as_given(self.rim))


class ConeSupport(OnSurface):
    """A circular cone with its apex at the origin: a funnel from inside, a hill from outside."""

    kind: Literal["cone"]
    half_angle: HalfAngle = Field(description="Between the axis and the wall.")
    side: Side = "inside"
    rim: Rim | None = Field(default=None, description="Distance of the edge from the axis; absent: unbounded.")
    tilt: AnyTilt = _TILT

    def surface(self) -> Surface:
        """Return the cone."""
        from ...mechanics.surfaces import Cone

        return Cone(_as_given(self.half_angle), self.side, _as_given(self.rim))


class ParaboloidSupport(OnSurface):
    """The paraboloid z = r²/(2 radius): a bowl, or a mound where the radius is negative."""

    kind: Literal["paraboloid"]
    radius: VertexRadius = Field(description="Radius of curvature at the vertex; negative: a mound.")
    rim: Rim | None = Field(default=None, description="Distance of the edge from the axis; absent: unbounded.")
    tilt: Upright = _TILT

    def surface(self) -> Surface:
        """Return the paraboloid."""
        from ...mechanics.surfaces import Paraboloid

        return Paraboloid(_as_given(self.radius), _as_given(self.rim))


class EllipsoidalBowlSupport(OnSurface):
    """The inside of an ellipsoid; its lowest point is the origin."""

    kind: Literal["ellipsoidal-bowl"]
    semi_axes: SemiAxes = Field(description="Along the three axes.")
    depth: Radius | None = Field(default=None, description="Height of the edge over the lowest point; absent: closed.")
    tilt: Upright = _TILT
    rim: ClassVar[None] = None

    def surface(self) -> Surface:
        """Return the bowl."""
        from ...mechanics.surfaces import EllipsoidalBowl

        return EllipsoidalBowl(written(self.semi_axes), _as_given(self.depth))


class TorusTrackSupport(OnSurface):
    """A torus about the third axis, rolled on inside its tube or outside; the origin is its centre."""

    kind: Literal["torus-track"]
    ring_radius: Radius = Field(description="Of the circle that the tube follows.")
    tube_radius: Radius = Field(description="Of the tube.")
    side: Side = "inside"
    tilt: AnyTilt = _TILT
    rim: ClassVar[None] = None

    def surface(self) -> Surface:
        """Return the torus."""
        from ...mechanics.surfaces import TorusTrack

        return TorusTrack(_as_given(self.ring_radius), _as_given(self.tube_radius), self.side)


class RevolutionSupport(OnSurface):
    """A surface of revolution about the third axis, by a formula z(r) or through points (r, z)."""

    kind: Literal["revolution"]
    formula: str | None = Field(default=None, description=f"z in r or r2 = r². {_FORMULA}", examples=["2*r**2"])
    r: Row | None = Field(default=None, description="Distances from the axis, four at least, ascending.")
    z: Row | None = Field(default=None, description="Heights there; the surface is a smooth spline through them.")
    rim: Rim | None = Field(default=None, description="Of a formula: distance of the edge from the axis.")
    tilt: Upright = _TILT

    def surface(self) -> Surface:
        """Return the surface."""
        from ...mechanics.surfaces import Revolution

        if _by_formula(self, ("r", "z")):
            return Revolution(self.formula, _as_given(self.rim))
        return Revolution.through(written(self.r), written(self.z))


class HeightFieldSupport(OnSurface):
    """A height field over the plane of the first two axes, by a formula z(x, y) or through a grid of heights."""

    kind: Literal["height-field"]
    formula: str | None = Field(default=None, description=f"z in x and y. {_FORMULA}", examples=["0.1*x**2"])
    x: Row | None = Field(default=None, description="Along the first axis, four at least, ascending.")
    y: Row | None = Field(default=None, description="Along the second axis, four at least, ascending.")
    z: Rows | None = Field(default=None, description="A list for each x with a height for each y.")
    rim: Rim | None = Field(default=None, description="Of a formula: distance of the edge from the axis.")
    tilt: Upright = _TILT

    def surface(self) -> Surface:
        """Return the surface."""
        from ...mechanics.surfaces import HeightField

        if _by_formula(self, ("x", "y", "z")):
            return HeightField(self.formula, _as_given(self.rim))
        return HeightField.through(written(self.x), written(self.y), written(self.z))


def _as_given(value: Any) -> Any:
    """Return a value as the user wrote it, for the message of whoever refuses it."""
    return written(value) if isinstance(value, Quantity) else value


def _by_formula(table: Any, keys: tuple[str, ...]) -> bool:
    """Tell a formula from a table of numbers, and refuse both together, half of one, and neither."""
    given = [key for key in keys if getattr(table, key) is not None]
    names = f"{', '.join(keys[:-1])} and {keys[-1]}"
    if table.formula is not None:
        if given:
            remedy = f"Give the formula, or {names}."
            raise InvalidValueError(given[0], "must not stand beside `formula`", table.formula, remedy)
        return True
    missing = [key for key in keys if key not in given]
    if not given:
        raise InvalidValueError("formula", "must be given", "no formula and no table", f"Or give {names}.")
    if missing:
        raise InvalidValueError(missing[0], f"must be given beside `{given[0]}`", "nothing", "Or give a `formula`.")
    if table.rim is not None:
        remedy = "The surface ends where its table does."
        raise InvalidValueError("rim", "belongs to a surface by a formula", written(table.rim), remedy)
    return False


Supports = (
    PlaneSupport
    | CylinderSupport
    | BowlSupport
    | DomeSupport
    | ConeSupport
    | ParaboloidSupport
    | EllipsoidalBowlSupport
    | TorusTrackSupport
    | RevolutionSupport
    | HeightFieldSupport
)

SUPPORTS: dict[str, type[Table]] = {
    "plane": PlaneSupport,
    "cylinder": CylinderSupport,
    "bowl": BowlSupport,
    "dome": DomeSupport,
    "cone": ConeSupport,
    "paraboloid": ParaboloidSupport,
    "ellipsoidal-bowl": EllipsoidalBowlSupport,
    "torus-track": TorusTrackSupport,
    "revolution": RevolutionSupport,
    "height-field": HeightFieldSupport,
}
