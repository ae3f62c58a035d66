"""The tables of a scenario file: one class for each, told apart by `kind` where there are several.

A new body, surface, motion or load is one class here with `kind` and `build`, in the union below its like.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from ..errors import InvalidValueError
from .fields import Coordinate, Measure, Measures, Varying, written

if TYPE_CHECKING:
    from ..mechanics.bodies import Body
    from ..mechanics.loads import Load
    from ..mechanics.motions import Motion
    from ..mechanics.system import Support

Method = Literal["auto", "exact", "taylor", "runge-kutta"]


class Table(BaseModel):
    """A table of the file: frozen, and no key but those named."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, defer_build=True)


# --- numbers with a rule of their own -------------------------------------------------------------------


def _check_tilt(tilt: float, received: Any) -> None:
    if abs(tilt) < math.pi / 2:
        return
    bare = str(received).removesuffix("rad").strip()
    try:
        remedy = f'Did you mean "{bare} deg"?' if abs(float(bare)) < 90 else ""
    except ValueError:
        remedy = ""
    raise InvalidValueError("", "must lie in (-90 deg, 90 deg)", received, remedy or "At 90 deg the plane is a wall.")


def _check_any_tilt(tilt: float, received: Any) -> None:
    if not abs(tilt) <= math.pi:
        raise InvalidValueError("", "must lie in [-180 deg, 180 deg]", received, "90 deg lays the axis level.")


def _check_inertia_ratio(ratio: float, received: Any) -> None:
    # I ≤ (2/3) m a² for any mass inside a sphere: I is a third of the trace, (2/3) Σ m r² with r ≤ a.
    if not 0 < ratio <= 2 / 3 * (1 + 1e-12):
        remedy = "2/3 is a thin shell, all its mass at the surface; no sphere has more."
        raise InvalidValueError("", "must lie in (0, 2/3]", received, remedy)


def _check_cylinder_ratio(ratio: float, received: Any) -> None:
    if not 0 < ratio <= 1 + 1e-12:
        raise InvalidValueError("", "must lie in (0, 1]", received, "1 is a hoop; no cylinder has more.")


@dataclass(frozen=True)
class Air(Measure):
    """How the air turns: a rate, or one of two words."""

    def __call__(self, value: Any, key: str = "") -> Any:
        """Return the checked rate or word."""
        return value if value in AIRS else super().__call__(value, key)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        """Return what an editor may know of it."""
        described = super().__get_pydantic_json_schema__(schema, handler)
        return {**described, "anyOf": [{"enum": list(AIRS)}, *described["anyOf"]]}


AIRS = ("still", "turning")

Radius = Annotated[float, Measure("length", "positive")]
Mass = Annotated[float, Measure("mass", "positive")]
CylinderRatio = Annotated[float, Measure("number", "positive", _check_cylinder_ratio, "0.5")]
Ratio = Annotated[float, Measure("number", "positive", _check_inertia_ratio, "0.4")]
Moment = Annotated[float, Measure("inertia", "positive")]
AnyTilt = Annotated[float, Measure("angle", check=_check_any_tilt)]
Tilt = Annotated[float, Measure("angle", check=_check_tilt)]
Rim = Annotated[float, Measure("length", "positive", example='"0.5 m"')]
Friction = Annotated[float, Measure("number", "not negative", example="0.3")]
Rate = Annotated[float, Measure("angular velocity")]
Coefficient = Annotated[float, Measure("damping", "not negative")]
Duration = Annotated[float, Measure("time", "positive")]
Step = Annotated[float, Measure("time", "positive", example='"10 ms"')]
Force3 = Annotated[tuple[float | str, float | str, float | str], Measures(Varying("force"), 3)]
Torque3 = Annotated[tuple[float | str, float | str, float | str], Measures(Varying("torque"), 3)]
Rate3 = Annotated[tuple[float, float, float], Measures(Measure("angular velocity", example='"2 rad/s"'), 3)]
Place2 = Annotated[tuple[float, float], Measures(Coordinate("length", example='"10 cm"'), 2)]
Velocity2 = Annotated[tuple[float, float] | str, Measures(Measure("velocity"), 2, "co-rotating")]
Angle = Annotated[float, Measure("angle")]
Share = Annotated[float, Measure("number", example="0.01")]
PositiveRate = Annotated[float, Measure("angular velocity", "positive")]
AirRate = Annotated[float | str, Air("angular velocity")]
Turn4 = Annotated[tuple[float, float, float, float], Measures(Measure("number", example="1.0"), 4)]


# --- bodies ---------------------------------------------------------------------------------------------


class SolidSphere(Table):
    """A homogeneous ball, k = 2/5."""

    kind: Literal["solid-sphere"]
    radius: Radius
    mass: Mass

    def build(self) -> Body:
        """Return the body."""
        from ..mechanics.bodies import Body

        return Body.solid_sphere(radius=float(self.radius), mass=float(self.mass))


class HollowSphere(Table):
    """A thin spherical shell, k = 2/3."""

    kind: Literal["hollow-sphere"]
    radius: Radius
    mass: Mass

    def build(self) -> Body:
        """Return the body."""
        from ..mechanics.bodies import Body

        return Body.hollow_sphere(radius=float(self.radius), mass=float(self.mass))


class AnySphere(Table):
    """A sphere of a given inertia ratio k = I/(m a²)."""

    kind: Literal["sphere"]
    radius: Radius
    mass: Mass
    inertia_ratio: Ratio = Field(description="k = I/(m a²), above 0 and at most a shell's 2/3.", examples=[0.4])

    def build(self) -> Body:
        """Return the body."""
        from ..mechanics.bodies import Body

        return Body.sphere(float(self.radius), float(self.mass), float(self.inertia_ratio))


class MomentSphere(Table):
    """A sphere of a given moment of inertia, the same about every axis through its centre."""

    kind: Literal["sphere-with-moment"]
    radius: Radius
    mass: Mass
    moment_of_inertia: Moment = Field(description="I, at most a shell's (2/3) m a².", examples=["1.6e-5 kg*m^2"])

    @model_validator(mode="after")
    def _check(self) -> MomentSphere:
        most = 2 / 3 * self.mass * self.radius * self.radius
        if not self.moment_of_inertia <= most * (1 + 1e-12):
            remedy = f"2/3 m a² = {most:g} kg m² is a thin shell, all its mass at the surface; no sphere has more."
            shown = written(self.moment_of_inertia)
            raise InvalidValueError("moment_of_inertia", "must be at most that of a shell", shown, remedy)
        return self

    def build(self) -> Body:
        """Return the body."""
        from ..mechanics.bodies import Body, Isotropic
        from ..mechanics.shapes import Sphere

        return Body(float(self.mass), Isotropic(float(self.moment_of_inertia)), Sphere(float(self.radius)))


class CylinderBody(Table):
    """A cylinder that rolls straight on its round side, k = 1/2 where it is solid."""

    kind: Literal["cylinder"]
    radius: Radius
    mass: Mass
    inertia_ratio: CylinderRatio = Field(default=0.5, description="k = I/(m a²) about its axis, at most a hoop's 1.")

    def build(self) -> Body:
        """Return the body."""
        from ..mechanics.bodies import Body

        return Body.cylinder(float(self.radius), float(self.mass), float(self.inertia_ratio))


class Hoop(Table):
    """A hoop or thin pipe that rolls straight, k = 1."""

    kind: Literal["hoop"]
    radius: Radius
    mass: Mass

    def build(self) -> Body:
        """Return the body."""
        from ..mechanics.bodies import Body

        return Body.hoop(float(self.radius), float(self.mass))


class WeightedCylinder(Table):
    """A cylinder with a small weight fixed off its axis; with roll 0 the weight is on top."""

    kind: Literal["weighted-cylinder"]
    radius: Radius
    mass: Mass = Field(description="Without the weight.")
    inertia_ratio: CylinderRatio = Field(default=0.5, description="k of the cylinder without the weight.")
    weight: Mass = Field(description="Mass of the weight.", examples=["50 g"])
    distance: Radius = Field(description="Of the weight from the axis.", examples=["30 mm"])

    @model_validator(mode="after")
    def _check(self) -> WeightedCylinder:
        if not self.distance <= self.radius:
            remedy = f"The cylinder ends at {float(self.radius):g} m."
            raise InvalidValueError("distance", "must be at most the radius", written(self.distance), remedy)
        return self

    def build(self) -> Body:
        """Return the body."""
        from ..mechanics.bodies import Body

        numbers = (self.radius, self.mass, self.weight, self.distance, self.inertia_ratio)
        return Body.weighted_cylinder(*map(float, numbers))


Bodies = SolidSphere | HollowSphere | AnySphere | MomentSphere | CylinderBody | Hoop | WeightedCylinder


# --- supports and how they move -------------------------------------------------------------------------


class FixedMotion(Table):
    """A support at rest."""

    kind: Literal["fixed"]

    def build(self) -> Motion:
        """Return the motion."""
        from ..mechanics.motions import Fixed

        return Fixed()


class SpinMotion(Table):
    """A support that turns steadily about its axis."""

    kind: Literal["spin"]
    rate: Rate = Field(description="Positive turns the first axis towards the second.", examples=["33.3 rpm"])

    def build(self) -> Motion:
        """Return the motion."""
        from ..mechanics.motions import Spin

        return Spin(float(self.rate))


class UnevenSpinMotion(Table):
    """A turn about the axis whose rate varies a little, rate (1 + variation sin(variation_rate t))."""

    kind: Literal["uneven-spin"]
    rate: Rate = Field(description="On the whole.", examples=["33.3 rpm"])
    variation: Share = Field(description="As a share of the rate.", examples=[0.01])
    variation_rate: PositiveRate = Field(description="Of the variation; the rate itself: once a turn.")

    def build(self) -> Motion:
        """Return the motion."""
        from ..mechanics.motions import UnevenSpin

        return UnevenSpin(float(self.rate), float(self.variation), float(self.variation_rate))


class WobbleMotion(Table):
    """A steady turn of a support that sits askew on its axle."""

    kind: Literal["wobble"]
    rate: Rate = Field(description="About the axle.", examples=["33.3 rpm"])
    angle: Angle = Field(description="Between the axle and the support's own axis.", examples=["0.1 deg"])

    def build(self) -> Motion:
        """Return the motion."""
        from ..mechanics.motions import Wobble

        return Wobble(float(self.rate), float(self.angle))


Motions = FixedMotion | SpinMotion | UnevenSpinMotion | WobbleMotion


class PlaneSupport(Table):
    """A plane, bounded by a circular rim or unbounded."""

    kind: Literal["plane"]
    tilt: Tilt = Field(default=0.0, description="Angle of the plane's normal to the vertical; down the first axis.")
    rim: Rim | None = Field(default=None, description="Radius of the rim; absent: unbounded.")
    friction: Friction | None = Field(default=None, description="Coulomb coefficient; absent: never slips.")
    motion: Annotated[Motions, Field(discriminator="kind")] = FixedMotion(kind="fixed")

    def build(self) -> Support:
        """Return the support."""
        from ..mechanics.surfaces import Plane
        from ..mechanics.system import Support

        surface = Plane(rim=None if self.rim is None else float(self.rim))
        friction = None if self.friction is None else float(self.friction)
        return Support(surface, motion=self.motion.build(), tilt=float(self.tilt), friction=friction)


class CylinderSupport(Table):
    """A circular cylinder about the third axis, rolled on from inside or outside; a tilt of 90 deg lays it down."""

    kind: Literal["cylinder"]
    radius: Radius
    side: Literal["inside", "outside"] = "inside"
    tilt: AnyTilt = Field(default=0.0, description="Angle of the axis to the vertical; 90 deg: a trough or a log.")
    friction: Friction | None = Field(default=None, description="Coulomb coefficient; absent: never slips.")
    motion: Annotated[Motions, Field(discriminator="kind")] = FixedMotion(kind="fixed")
    rim: ClassVar[None] = None

    def build(self) -> Support:
        """Return the support."""
        from ..mechanics.surfaces import Cylinder
        from ..mechanics.system import Support

        surface = Cylinder(float(self.radius), self.side)
        friction = None if self.friction is None else float(self.friction)
        return Support(surface, motion=self.motion.build(), tilt=float(self.tilt), friction=friction)


Supports = PlaneSupport | CylinderSupport


# --- loads ----------------------------------------------------------------------------------------------


def _values(value: tuple[float | str, ...]) -> tuple[Any, ...]:
    return tuple(part if isinstance(part, str) else float(part) for part in value)


class ForceLoad(Table):
    """A force on the centre of mass, constant or given by formulas in the time t."""

    kind: Literal["force"]
    value: Force3 = Field(description="In the support frame, which does not turn with the support.")

    def build(self, support_rate: float = 0.0) -> Load:  # noqa: ARG002  only the air knows of it
        """Return the load."""
        from ..mechanics.loads import Force

        return Force(_values(self.value))


class TorqueLoad(Table):
    """A torque about the centre of mass, constant or given by formulas in the time t."""

    kind: Literal["torque"]
    value: Torque3 = Field(description="In the support frame, which does not turn with the support.")

    def build(self, support_rate: float = 0.0) -> Load:  # noqa: ARG002  only the air knows of it
        """Return the load."""
        from ..mechanics.loads import Torque

        return Torque(_values(self.value))


class DragLoad(Table):
    """Linear drag, the force -c (V - that of the air)."""

    kind: Literal["drag"]
    coefficient: Coefficient
    air: AirRate = Field(default="still", description='"still", "turning" with the support, or a rate of its own.')

    def build(self, support_rate: float = 0.0) -> Load:
        """Return the load; air that turns with the support has its rate on the whole."""
        from ..mechanics.loads import Drag

        rates = {"still": 0.0, "turning": support_rate}
        return Drag(float(self.coefficient), rates[self.air] if isinstance(self.air, str) else float(self.air))


Loads = ForceLoad | TorqueLoad | DragLoad


# --- the start and the run ------------------------------------------------------------------------------


class Start(Table):
    """Where the body is put down, and how it moves then."""

    position: Place2 = Field(description="Of the centre over a plane, x and y; on a cylinder its angle and height.")
    velocity: Velocity2 = Field(default=(0.0, 0.0), description="Of the centre, along the two coordinates.")
    spin: Rate | None = Field(default=None, description="Angular velocity about the normal; the rest follows.")
    angular_velocity: Rate3 | None = Field(default=None, description="All of it, instead of spin.")
    orientation: Turn4 | None = Field(default=None, description="Quaternion w, x, y, z; absent: not turned.")
    roll: Angle = Field(default=0.0, description="Of a cylinder: how far it has rolled on since its mark was on top.")

    @model_validator(mode="after")
    def _check(self) -> Start:
        if self.spin is not None and self.angular_velocity is not None:
            remedy = "Give `spin` and the rest follows from no slip, or all three components and no `spin`."
            shown = written(self.angular_velocity)
            raise InvalidValueError("angular_velocity", "must not stand beside `spin`", shown, remedy)
        length = 1.0 if self.orientation is None else math.hypot(*self.orientation)
        if not 1e-150 < length < 1e150:
            shown = written(self.orientation)
            remedy = "Write [1, 0, 0, 0] for a body that is not turned."
            raise InvalidValueError("orientation", "must be a quaternion of unit length", shown, remedy)
        return self

    def arguments(self) -> dict[str, Any]:
        """Return what `RollingSystem.place` takes."""
        velocity = self.velocity if isinstance(self.velocity, str) else tuple(map(float, self.velocity))
        turning = None if self.angular_velocity is None else tuple(map(float, self.angular_velocity))
        return {
            "position": tuple(map(float, self.position)),
            "velocity": velocity,
            "spin": None if self.spin is None else float(self.spin),
            "angular_velocity": turning,
            "orientation": None if self.orientation is None else tuple(map(float, self.orientation)),
            "roll": float(self.roll),
        }


class Run(Table):
    """How long, how finely and by which method."""

    duration: Duration = Field(examples=["60 s"])
    every: Step = Field(description="Time between samples.", examples=["10 ms"])
    method: Method = "auto"

    @model_validator(mode="after")
    def _check(self) -> Run:
        from ..solve.sampling import check_sampling

        check_sampling(written(self.duration), written(self.every))
        return self


# Which class stands for which table, so that an error can list the keys that a table has.
KINDS: dict[str, dict[str, type[Table]]] = {
    "body": {
        "solid-sphere": SolidSphere,
        "hollow-sphere": HollowSphere,
        "sphere": AnySphere,
        "sphere-with-moment": MomentSphere,
        "cylinder": CylinderBody,
        "hoop": Hoop,
        "weighted-cylinder": WeightedCylinder,
    },
    "support": {"plane": PlaneSupport, "cylinder": CylinderSupport},
    "support.motion": {
        "fixed": FixedMotion,
        "spin": SpinMotion,
        "uneven-spin": UnevenSpinMotion,
        "wobble": WobbleMotion,
    },
    "loads": {"force": ForceLoad, "torque": TorqueLoad, "drag": DragLoad},
}
