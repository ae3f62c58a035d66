"""Tables of spheres, and of cylinders that roll straight as one would."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import Field, model_validator

from ....errors import InvalidValueError
from ...fields import written
from ..values import CylinderRatio, Mass, Moment, Radius, Ratio, Table
from .built import Built, DensityOr, MassOr

if TYPE_CHECKING:
    from ....mechanics.bodies import Body


class SolidSphere(Built):
    """A homogeneous ball, k = 2/5."""

    kind: Literal["solid-sphere"]
    builder: ClassVar[str] = "solid_sphere"
    radius: Radius
    mass: MassOr = None
    density: DensityOr = None


class HollowSphere(Table):
    """A thin spherical shell, k = 2/3."""

    kind: Literal["hollow-sphere"]
    radius: Radius
    mass: Mass

    def build(self) -> Body:
        """Return the body."""
        from ....mechanics.bodies import Body

        return Body.hollow_sphere(radius=float(self.radius), mass=float(self.mass))


class AnySphere(Table):
    """A sphere of a given inertia ratio k = I/(m a²)."""

    kind: Literal["sphere"]
    radius: Radius
    mass: Mass
    inertia_ratio: Ratio = Field(
        title="Inertia ratio k", description="k = I/(m a²), above 0 and at most a shell's 2/3.", examples=[0.4]
    )

    def build(self) -> Body:
        """Return the body."""
        from ....mechanics.bodies import Body

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
        from ....mechanics.bodies import Body, Isotropic
        from ....mechanics.shapes import Sphere

        return Body(float(self.mass), Isotropic(float(self.moment_of_inertia)), Sphere(float(self.radius)))


class CylinderBody(Table):
    """A cylinder that rolls straight on its round side, k = 1/2 where it is solid."""

    kind: Literal["cylinder"]
    radius: Radius
    mass: Mass
    inertia_ratio: CylinderRatio = Field(
        default=0.5, title="Inertia ratio k", description="k = I/(m a²) about its axis, at most a hoop's 1."
    )

    def build(self) -> Body:
        """Return the body."""
        from ....mechanics.bodies import Body

        return Body.cylinder(float(self.radius), float(self.mass), float(self.inertia_ratio))


class Hoop(Table):
    """A hoop or thin pipe that rolls straight, k = 1."""

    kind: Literal["hoop"]
    radius: Radius
    mass: Mass

    def build(self) -> Body:
        """Return the body."""
        from ....mechanics.bodies import Body

        return Body.hoop(float(self.radius), float(self.mass))


class WeightedCylinder(Table):
    """A cylinder with a small weight fixed off its axis; with roll 0 the weight is on top."""

    kind: Literal["weighted-cylinder"]
    radius: Radius
    mass: Mass = Field(description="Without the weight.")
    inertia_ratio: CylinderRatio = Field(
        default=0.5, title="Inertia ratio k", description="k of the cylinder without the weight."
    )
    weight: Mass = Field(description="Mass of the weight.", examples=["50 g"])
    distance: Radius = Field(description="Of the weight from the axis.", examples=["15 mm"])

    @model_validator(mode="after")
    def _check(self) -> WeightedCylinder:
        if not self.distance <= self.radius:
            remedy = f"The cylinder ends at {float(self.radius):g} m."
            raise InvalidValueError("distance", "must be at most the radius", written(self.distance), remedy)
        return self

    def build(self) -> Body:
        """Return the body."""
        from ....mechanics.bodies import Body

        numbers = (self.radius, self.mass, self.weight, self.distance, self.inertia_ratio)
        return Body.weighted_cylinder(*map(float, numbers))
