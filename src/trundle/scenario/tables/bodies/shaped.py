"""Tables of bodies that are no spheres about their centre of mass."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field, StrictStr

from ..values import Angle, Mass, Moment, Radius
from .built import Built, Centre, DensityOr, MassOr, Moments, OwnMoments, Products, SemiAxes, Thickness


class EccentricSphere(Built):
    """A sphere with any inertia and its centre of mass anywhere inside: Chaplygin's ball, Routh's sphere."""

    kind: Literal["eccentric-sphere"]
    builder: ClassVar[str] = "eccentric_sphere"
    radius: Radius
    mass: Mass
    moments: Moments
    products: Products = None
    centre: Centre = Field(default=None, examples=[[0, 0, "3 mm"]])


class Hemisphere(Built):
    """Half a sphere, solid unless `moments` are given, that rocks on its round side; its flat face looks along z."""

    kind: Literal["hemisphere"]
    builder: ClassVar[str] = "hemisphere"
    radius: Radius
    mass: MassOr = None
    density: DensityOr = None
    moments: OwnMoments = None
    products: Products = None
    centre: Centre = None


class EccentricCylinder(Built):
    """A cylinder that rolls straight, with any inertia and its centre of mass anywhere inside."""

    kind: Literal["eccentric-cylinder"]
    builder: ClassVar[str] = "eccentric_cylinder"
    radius: Radius
    mass: Mass
    moment_of_inertia: Moment = Field(description="About the line through the centre of mass along the cylinder.")
    centre: Centre = None


class HalfCylinder(Built):
    """Half a cylinder, solid unless its moment is given, that rocks on its round side; its flat face looks along x."""

    kind: Literal["half-cylinder"]
    builder: ClassVar[str] = "half_cylinder"
    radius: Radius
    mass: MassOr = None
    density: DensityOr = None
    length: Radius | None = Field(default=None, description="Along the axis; needed with a density only.")
    moment_of_inertia: Moment | None = Field(default=None, description="About its centre of mass; absent: of a solid.")
    centre: Centre = None


class Disc(Built):
    """A disc, such as a coin, on its rim."""

    kind: Literal["disc"]
    builder: ClassVar[str] = "disc"
    radius: Radius
    mass: MassOr = None
    density: DensityOr = None
    thickness: Thickness | None = Field(default=None, description="Counts in mass and inertia; the rim stays sharp.")
    moments: OwnMoments = None
    products: Products = None
    centre: Centre = None


class Ring(Built):
    """A thin ring on its rim; a `hoop` rolls straight."""

    kind: Literal["ring"]
    builder: ClassVar[str] = "ring"
    radius: Radius
    mass: Mass


class Torus(Built):
    """A solid ring of round cross-section on its rim."""

    kind: Literal["torus"]
    builder: ClassVar[str] = "torus"
    radius: Radius = Field(description="Of the circle through the middle of the ring.")
    rim_radius: Radius = Field(description="Of the cross-section, at most the radius.", examples=["8 mm"])
    mass: MassOr = None
    density: DensityOr = None
    moments: OwnMoments = None
    products: Products = None
    centre: Centre = None


class Ellipsoid(Built):
    """An ellipsoid; with moments turned against it, a rattleback."""

    kind: Literal["ellipsoid"]
    builder: ClassVar[str] = "ellipsoid"
    semi_axes: SemiAxes = Field(
        title="Semi-axis", description="Along the axes of the body frame.", examples=[["5 cm", "4 cm", "3 cm"]]
    )
    mass: MassOr = None
    density: DensityOr = None
    moments: OwnMoments = None
    products: Products = None
    turn: Angle | None = Field(default=None, description="Of the inertia against the shape, about the third axis.")
    centre: Centre = None


class Formula(Built):
    """A smooth convex body given by its support function."""

    kind: Literal["formula"]
    builder: ClassVar[str] = "shape_formula"
    support_function: StrictStr = Field(
        description="h in nu_x, nu_y, nu_z, m: how far the body reaches in the direction of the unit normal nu.",
        examples=["0.025 + 0.003*nu_z + 0.004*nu_z**2"],
    )
    mass: MassOr = None
    density: DensityOr = None
    moments: OwnMoments = None
    products: Products = None
    centre: Centre = None
