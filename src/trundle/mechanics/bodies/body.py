"""The body that rolls: a mass, an inertia tensor and a shape, with builders for the common ones."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, Self

from ...errors import InvalidValueError
from .. import checks
from ..algebra import ZERO, Matrix, Vector
from ..parts import POSITIVE, Formula, Number
from ..scalars import Scalar, is_number, is_zero, namespace
from ..shapes import (
    CylinderShape,
    Disc,
    Ellipsoid,
    HalfCylinder,
    Hemisphere,
    Shape,
    Sphere,
    SupportFunction,
    Torus,
    concentric_sphere,
)
from ..shapes.support_function import NAMES
from .builder import (
    Centre,
    CylinderRatio,
    DensityOr,
    Mass,
    MassOr,
    Moments,
    OffCentre,
    OwnMoments,
    Products,
    Radius,
    SemiAxes,
    SphereRatio,
    Thickness,
    builder,
)
from .homogeneous import homogeneous
from .inertia import CYLINDER_RATIO, SPHERE_RATIO, Inertia, Isotropic, Principal, RatioInertia, Tensor, inertia_of

SOLID_SPHERE, HOLLOW_SPHERE = 2 / 5, 2 / 3  # k = I/(m a²)
SOLID_CYLINDER, HOOP = 1 / 2, 1.0


@dataclass(frozen=True)
class Body:
    """A rigid convex body.

    Parameters
    ----------
    mass : float
        m, kg.
    inertia : Isotropic, RatioInertia, Principal or Tensor
        J about the centre of mass.
    shape : Shape
        The surface that touches the support.

    Examples
    --------
    >>> Body.solid_sphere(radius=0.025, mass=0.065).inertia_ratio
    0.4
    """

    mass: Annotated[Scalar, Number("mass")]
    inertia: Isotropic | RatioInertia | Principal | Tensor
    shape: Shape

    def __post_init__(self) -> None:
        checks.instance(self.inertia, Inertia, "inertia", "Give for instance tr.Isotropic(1e-5).")
        checks.instance(self.shape, Shape, "shape", "Give for instance tr.Sphere(0.025).")
        object.__setattr__(self, "mass", checks.positive(self.mass, "mass", "mass"))
        if isinstance(self.inertia, RatioInertia):
            self._check_ratio(self.inertia.ratio)

    def _check_ratio(self, k: Scalar) -> None:
        """Refuse an inertia ratio without a radius, or one for which mass would have to lie outside the body."""
        if not isinstance(self.shape, Sphere):
            remedy = "Give for instance tr.Principal(1e-5, 2e-5, 2.5e-5)."
            raise InvalidValueError("inertia", "may be given by a ratio only for a sphere or cylinder", k, remedy)
        (SPHERE_RATIO if self.shape.axis is None else CYLINDER_RATIO).read(k, "inertia_ratio")

    def inertia_in_space(self, Q: Matrix) -> Matrix:
        """Return J in the support frame, kg m², for the rotation matrix Q from the body frame to that frame.

        Parameters
        ----------
        Q : Matrix
            Body frame to support frame.

        Returns
        -------
        Matrix
            Symmetric.
        """
        return self.inertia.in_space(Q, self)

    def gyroscopic(self, Q: Matrix, Omega: Vector) -> Vector:
        """Return Ω×JΩ in the support frame, N m.

        Parameters
        ----------
        Q : Matrix
            Body frame to support frame.
        Omega : Vector
            Ω, support frame, rad/s.

        Returns
        -------
        Vector
            Support frame.
        """
        return self.inertia.gyroscopic(Q, Omega, self)

    @property
    def radius(self) -> Scalar:
        """A of a sphere, m."""
        if not isinstance(self.shape, Sphere):
            raise InvalidValueError("radius", "exists only for a sphere", self.shape)
        return self.shape.radius

    @property
    def is_isotropic_sphere(self) -> bool:
        """Whether it rolls as a sphere about its centre of mass with the same inertia about every axis."""
        return concentric_sphere(self.shape) and self.inertia.isotropic

    @property
    def axisymmetric(self) -> bool:
        """Whether shape and inertia are the same after any turn about the body's third axis."""
        return self.shape.axisymmetric and self.inertia.axisymmetric

    @property
    def inertia_ratio(self) -> Scalar:
        """K = I/(m a²) of an isotropic sphere."""
        if not isinstance(self.inertia, (Isotropic, RatioInertia)) or not self.is_isotropic_sphere:
            raise InvalidValueError("inertia_ratio", "exists only for a sphere with isotropic inertia", self)
        return self.inertia.ratio_of(self)

    def parameters(self) -> dict[str, Any]:
        """Return what a body tells of itself in the words of its builders.

        Returns
        -------
        dict of str to number, Vector or Expression
            By the names of the builders' parameters; SI, the moments about the centre of mass, the centre that of the
            shape from there, body frame.

        Examples
        --------
        >>> Body.solid_sphere(0.025, 0.065).parameters()["inertia_ratio"]
        0.4
        """
        shape = self.shape.parameters()
        return {"mass": self.mass, **shape, "centre": shape.get("centre") or ZERO, **self.inertia.parameters(self)}

    @classmethod
    def builders(cls) -> dict[str, Callable[..., Self]]:
        """Return what makes the bodies that files may name, by kind.

        Returns
        -------
        dict of str to callable
            The builders of this class, in the order in which they stand here.

        Examples
        --------
        >>> Body.builders()["ring"](radius="30 cm", mass="1 kg").mass
        1.0
        """
        own = (getattr(cls, name) for name, what in vars(Body).items() if isinstance(what, classmethod))
        return {made.kind: made for made in own if hasattr(made, "kind")}

    @classmethod
    @builder("solid-sphere", Sphere)
    def solid_sphere(cls, radius: Radius, mass: MassOr = None, density: DensityOr = None) -> Self:
        """Make a homogeneous ball, I = (2/5) m a².

        Parameters
        ----------
        radius : float or quantity
            a, m.
        mass, density : float or quantity
            One of the two, kg or kg/m³.

        Returns
        -------
        Body
            The ball.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.solid_sphere(radius=1.0, mass=5.0).inertia_ratio
        0.4
        >>> f"{Body.solid_sphere('25 mm', density='7.8 g/cm^3').mass:.3f} kg"
        '0.511 kg'
        """
        volume = 4 / 3 * math.pi * radius * radius * radius
        return cls.sphere(radius, mass_of(mass, density, volume), SOLID_SPHERE)

    @classmethod
    @builder("hollow-sphere", Sphere)
    def hollow_sphere(cls, radius: Radius, mass: Mass) -> Self:
        """Make a thin spherical shell, I = (2/3) m a².

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.

        Returns
        -------
        Body
            The shell.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.hollow_sphere(radius=1.0, mass=3.0).inertia_ratio
        0.6666666666666666
        """
        return cls.sphere(radius, mass, HOLLOW_SPHERE)

    @classmethod
    @builder("sphere", Sphere)
    def sphere(cls, radius: Radius, mass: Mass, inertia_ratio: SphereRatio) -> Self:
        """Make a sphere whose mass lies symmetrically about its centre.

        Parameters
        ----------
        radius : float or quantity
            a, m.
        mass : float or quantity
            m, kg.
        inertia_ratio : float
            k = I/(m a²): 2/5 for a solid sphere, 2/3 for a shell, never more.

        Returns
        -------
        Body
            The sphere.

        Raises
        ------
        InvalidValueError
            If a value is not positive, or k is more than a shell's.

        Examples
        --------
        >>> from trundle import Body
        >>> ball = Body.sphere(radius="40 mm", mass="2.7 g", inertia_ratio=0.5)
        >>> ball.shape.radius, round(ball.inertia_ratio, 12)
        (0.04, 0.5)
        """
        return cls(mass, RatioInertia(inertia_ratio), Sphere(radius))

    @classmethod
    @builder("sphere-with-moment", Sphere)
    def sphere_with_moment(
        cls,
        radius: Radius,
        mass: Mass,
        moment_of_inertia: Annotated[
            Any, Number("inertia", POSITIVE, "I, at most a shell's (2/3) m a².", example="1.6e-5 kg*m^2")
        ],
    ) -> Self:
        """Make a sphere of a given moment of inertia, the same about every axis through its centre.

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.
        moment_of_inertia : float or quantity
            I, kg m², at most a shell's (2/3) m a².

        Returns
        -------
        Body
            The sphere.

        Raises
        ------
        InvalidValueError
            If a value is not positive, or I is more than a shell's.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.sphere_with_moment("25 mm", "65 g", "1.6e-5 kg*m^2").inertia
        Isotropic(moment=1.6e-05)
        """
        most = 2 / 3 * mass * radius * radius
        if is_number(most) and is_number(moment_of_inertia) and not moment_of_inertia <= most * (1 + 1e-12):
            remedy = f"2/3 m a² = {most:g} kg m² is a thin shell, all its mass at the surface; no sphere has more."
            raise InvalidValueError("moment_of_inertia", "must be at most that of a shell", moment_of_inertia, remedy)
        return cls(mass, Isotropic(moment_of_inertia), Sphere(radius))

    @classmethod
    @builder("eccentric-sphere", Sphere)
    def eccentric_sphere(
        cls, radius: Radius, mass: Mass, moments: Moments, centre: OffCentre = None, products: Products = None
    ) -> Self:
        """Make a sphere with any inertia and its centre of mass anywhere inside: a Chaplygin ball, a Routh sphere.

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.
        moments : sequence of 3 floats or quantities
            J_xx, J_yy, J_zz about the centre of mass, along the axes of the body frame, kg m².
        centre : sequence of 3 floats or quantities, optional
            The sphere's centre from the centre of mass, body frame, m; absent: the two coincide (Chaplygin's ball).
        products : sequence of 3 floats or quantities, optional
            J_xy, J_xz, J_yz, elements of the tensor with their sign, kg m².

        Returns
        -------
        Body
            The sphere.

        Raises
        ------
        InvalidValueError
            If the centre of mass lies outside the sphere, or the moments belong to no body.

        Examples
        --------
        A tippe top without its stem: heavy at the bottom, so its centre lies above its centre of mass.

        >>> from trundle import Body
        >>> Body.eccentric_sphere("15 mm", "6 g", (8e-7, 8e-7, 7e-7), centre=(0, 0, "2 mm")).axisymmetric
        True
        """
        if centre is not None and all(map(is_zero, centre)):
            centre = None
        elif centre is not None and all(map(is_number, (*centre, radius))):
            away = namespace().sqrt(centre.dot(centre))
            if away >= radius:
                remedy = f"It lies {away:g} m from a centre of mass that must be inside the sphere."
                raise InvalidValueError("centre", "must lie less than the radius away", centre, remedy)
        return cls(mass, inertia_of(moments, products), Sphere(radius, centre))

    @classmethod
    @builder("hemisphere", Hemisphere)
    def hemisphere(
        cls,
        radius: Radius,
        mass: MassOr = None,
        density: DensityOr = None,
        moments: OwnMoments = None,
        products: Products = None,
        centre: Centre = None,
    ) -> Self:
        """Make a half sphere that rocks on its round side; the normal of its flat face is the third axis.

        Parameters
        ----------
        radius : float or quantity
            a, m.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        moments, products : sequence of 3 floats or quantities, optional
            J_xx, J_yy, J_zz and J_xy, J_xz, J_yz about the centre of mass, kg m²; absent: as below.
        centre : sequence of 3 floats or quantities, optional
            The middle of the flat face from the centre of mass, body frame, m; absent: (0, 0, (3/8) a).

        Returns
        -------
        Body
            A solid one: its centre of mass lies (3/8) a from the flat face; J = (83/320) m a² across the third axis,
            (2/5) m a² about it. It is told apart from a sphere by `shape.covers`, zero where it tips over its edge.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.hemisphere(0.08, mass=1.0).shape.centre.z
        0.03
        """
        a = radius
        m = mass_of(mass, density, 2 / 3 * math.pi * a * a * a)
        across = 83 / 320 * m * (a * a)
        own = (across, across, 2 / 5 * m * (a * a)) if moments is None else moments
        return cls(m, inertia_of(own, products), Hemisphere(a, (0.0, 0.0, 3 / 8 * a) if centre is None else centre))

    @classmethod
    @builder("cylinder", CylinderShape)
    def cylinder(cls, radius: Radius, mass: Mass, inertia_ratio: CylinderRatio = SOLID_CYLINDER) -> Self:
        """Make a cylinder that rolls straight on its round side.

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.
        inertia_ratio : float
            k = I/(m a²) about its axis: 1/2 where it is solid, at most a hoop's 1.

        Returns
        -------
        Body
            The cylinder; its axis is the third of the body frame.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.cylinder("3 cm", "200 g").inertia_ratio
        0.5
        """
        return cls(mass, RatioInertia(inertia_ratio), CylinderShape(radius))

    @classmethod
    @builder("hoop", CylinderShape)
    def hoop(cls, radius: Radius, mass: Mass) -> Self:
        """Make a hoop or a thin pipe that rolls straight, I = m a².

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.

        Returns
        -------
        Body
            The hoop. One that may lean and turn is `Body.ring`.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.hoop("30 cm", "1 kg").inertia_ratio
        1.0
        """
        return cls.cylinder(radius, mass, HOOP)

    @classmethod
    @builder("weighted-cylinder", CylinderShape)
    def weighted_cylinder(
        cls,
        radius: Radius,
        mass: Annotated[Any, Number("mass", POSITIVE, "Without the weight.")],
        weight: Annotated[Any, Number("mass", POSITIVE, "Mass of the weight.", example="50 g")],
        distance: Annotated[Any, Number("length", POSITIVE, "Of the weight from the axis.", example="15 mm")],
        inertia_ratio: CylinderRatio = SOLID_CYLINDER,
    ) -> Self:
        """Make a cylinder with a small weight fixed off its axis; unturned, the weight lies along the first axis.

        Parameters
        ----------
        radius, mass, inertia_ratio : see cylinder
            Of the cylinder without the weight.
        weight : float or quantity
            Mass of the weight, kg.
        distance : float or quantity
            Of the weight from the axis, m, at most the radius.

        Returns
        -------
        Body
            Its mass is that of both, its inertia that about their common centre of mass.

        Raises
        ------
        InvalidValueError
            If a value is not positive, or the weight would stick out.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.weighted_cylinder(0.05, 0.3, 0.1, 0.04).shape.centre.x
        -0.01
        """
        if is_number(distance) and is_number(radius) and distance > radius:
            remedy = f"The cylinder ends at {radius:g} m."
            raise InvalidValueError("distance", "must be at most the radius", distance, remedy)
        total = mass + weight
        away = weight * distance / total
        moment = inertia_ratio * mass * radius**2 + mass * away**2 + weight * (distance - away) ** 2
        return cls(total, Isotropic(moment), CylinderShape(radius, Vector(-away, 0.0, 0.0)))

    @classmethod
    @builder("eccentric-cylinder", CylinderShape)
    def eccentric_cylinder(
        cls,
        radius: Radius,
        mass: Mass,
        moment_of_inertia: Annotated[
            Any, Number("inertia", POSITIVE, "About the line through the centre of mass along the cylinder.")
        ],
        centre: Centre = None,
    ) -> Self:
        """Make a cylinder of any inertia, with its axis anywhere from its centre of mass, that rolls straight.

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.
        moment_of_inertia : float or quantity
            About the line through the centre of mass along the cylinder, kg m².
        centre : sequence of 3 floats or quantities, optional
            The axis from the centre of mass, in the body frame, m; its third component is 0.

        Returns
        -------
        Body
            The cylinder.

        Raises
        ------
        InvalidValueError
            If a value is not positive, or the centre of mass would lie outside the cylinder.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.eccentric_cylinder("5 cm", "1 kg", 1e-3, centre=("-1 cm", 0, 0)).shape.centre.x
        -0.01
        """
        if centre is not None and all(map(is_number, (*centre, radius))):
            away = math.hypot(centre.x, centre.y)
            if away >= radius:
                remedy = f"It lies {away:g} m from a centre of mass that must be inside the cylinder."
                raise InvalidValueError("centre", "must lie less than the radius away", centre, remedy)
        return cls(mass, Isotropic(moment_of_inertia), CylinderShape(radius, centre))

    @classmethod
    @builder("half-cylinder", HalfCylinder)
    def half_cylinder(
        cls,
        radius: Radius,
        mass: MassOr = None,
        density: DensityOr = None,
        length: Annotated[Any, Number("length", POSITIVE, "Along the axis; needed with a density only.")] = None,
        moment_of_inertia: Annotated[
            Any, Number("inertia", POSITIVE, "About its centre of mass; absent: of a solid.")
        ] = None,
        centre: Centre = None,
    ) -> Self:
        """Make a half cylinder that rocks on its round side; the normal of its flat face is the first axis.

        Parameters
        ----------
        radius : float or quantity
            a, m.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        length : float or quantity, optional
            Along the axis, m; it is needed with a density only.
        moment_of_inertia : float or quantity, optional
            About the line through the centre of mass along the axis, kg m²; absent: as below.
        centre : sequence of 3 floats or quantities, optional
            The axis of the round side from the centre of mass, body frame, m; absent: (4a/(3π), 0, 0).

        Returns
        -------
        Body
            A solid one: its centre of mass lies 4a/(3π) from the flat face; I = (1/2 − 16/(9π²)) m a² about the line
            through it along the axis. It rolls straight, as every cylinder here.

        Examples
        --------
        >>> from trundle import Body
        >>> round(Body.half_cylinder(0.1, mass=1.0).shape.centre.x, 6)
        0.042441
        """
        a = radius
        volume = None if length is None else 0.5 * math.pi * a * a * length
        m = mass_of(mass, density, volume, "`length`")
        away = 4 / (3 * math.pi)
        own = (1 / 2 - away * away) * m * (a * a) if moment_of_inertia is None else moment_of_inertia
        return cls(m, Isotropic(own), HalfCylinder(a, (away * a, 0.0, 0.0) if centre is None else centre))

    @classmethod
    @builder("disc", Disc)
    def disc(
        cls,
        radius: Radius,
        mass: MassOr = None,
        density: DensityOr = None,
        thickness: Thickness = 0.0,
        moments: OwnMoments = None,
        products: Products = None,
        centre: Centre = None,
    ) -> Self:
        """Make a disc, a coin, that rolls, leans and spins on its rim; homogeneous unless moments are given.

        Parameters
        ----------
        radius : float or quantity
            a, m.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        thickness : float or quantity
            d, m. It counts in mass and inertia; the rim that touches is the sharp circle half way between the faces.
        moments, products : sequence of 3 floats or quantities, optional
            J_xx, J_yy, J_zz and J_xy, J_xz, J_yz about the centre of mass, kg m²; absent: as below.
        centre : sequence of 3 floats or quantities, optional
            The middle of the disc from the centre of mass, body frame, m; absent: the two coincide.

        Returns
        -------
        Body
            J = m(a²/4 + d²/12) across its axis, the third of the body frame, and m a²/2 about it.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.disc(2.0, mass=1.0).inertia
        Principal(x=1.0, y=1.0, z=2.0)
        """
        a, d = radius, thickness
        volume = None if isinstance(d, float) and d == 0 else math.pi * a * a * d
        m = mass_of(mass, density, volume, "`thickness`")
        across = m * (a * a / 4 + d * d / 12)
        own = (across, across, m * (a * a) / 2) if moments is None else moments
        return cls(m, inertia_of(own, products), Disc(a, centre))

    @classmethod
    @builder("ring", Disc)
    def ring(cls, radius: Radius, mass: Mass) -> Self:
        """Make a thin ring that rolls, leans and spins on its rim; a `hoop` rolls straight.

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.

        Returns
        -------
        Body
            J = m a²/2 across its axis, the third of the body frame, and m a² about it.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.ring(2.0, 1.0).inertia
        Principal(x=2.0, y=2.0, z=4.0)
        """
        square = mass * (radius * radius)
        return cls(mass, Principal(square / 2, square / 2, square), Disc(radius))

    @classmethod
    @builder("torus", Torus)
    def torus(
        cls,
        radius: Annotated[Any, Number("length", POSITIVE, "Of the circle through the middle of the ring.")],
        rim_radius: Annotated[Any, Number("length", POSITIVE, "Of the cross-section, at most the radius.", "8 mm")],
        mass: MassOr = None,
        density: DensityOr = None,
        moments: OwnMoments = None,
        products: Products = None,
        centre: Centre = None,
    ) -> Self:
        """Make a solid ring of round cross-section that rolls, leans and spins on its rim.

        Parameters
        ----------
        radius : float or quantity
            a, of the circle through the middle of the ring, m; the whole is a + e in radius.
        rim_radius : float or quantity
            e, of the cross-section, m, at most a.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        moments, products : sequence of 3 floats or quantities, optional
            J_xx, J_yy, J_zz and J_xy, J_xz, J_yz about the centre of mass, kg m²; absent: as below.
        centre : sequence of 3 floats or quantities, optional
            The middle of the ring from the centre of mass, body frame, m; absent: the two coincide.

        Returns
        -------
        Body
            J = m(a²/2 + 5e²/8) across its axis, the third of the body frame, and m(a² + 3e²/4) about it. With moments
            of its own it may as well be a disc whose rim is rounded.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.torus(2.0, 1.0, mass=8.0).inertia
        Principal(x=21.0, y=21.0, z=38.0)
        """
        a, e = radius, rim_radius
        if is_number(a) and is_number(e) and e > a:
            remedy = f"A ring of radius {a:g} m has no hole left at that."
            raise InvalidValueError("rim_radius", "must be at most `radius`", rim_radius, remedy)
        m = mass_of(mass, density, 2 * math.pi**2 * a * e * e)
        across = m * (a * a / 2 + 5 * (e * e) / 8)
        own = (across, across, m * (a * a + 3 * (e * e) / 4)) if moments is None else moments
        return cls(m, inertia_of(own, products), Torus(a, e, centre))

    @classmethod
    @builder("ellipsoid", Ellipsoid)
    def ellipsoid(
        cls,
        semi_axes: SemiAxes,
        mass: MassOr = None,
        density: DensityOr = None,
        moments: OwnMoments = None,
        products: Products = None,
        turn: Annotated[Any, Number("angle", said="Of the inertia against the shape, about the third axis.")] = 0.0,
        centre: Centre = None,
    ) -> Self:
        """Make an ellipsoid, homogeneous or with an inertia of its own, as a rattleback has.

        Parameters
        ----------
        semi_axes : sequence of 3 floats or quantities
            a, b, c along the axes of the body frame, m.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        moments : sequence of 3 floats or quantities, optional
            J_xx, J_yy, J_zz about the centre of mass, kg m²; absent: m(b² + c²)/5 and so on.
        products : sequence of 3 floats or quantities, optional
            J_xy, J_xz, J_yz, elements of the tensor with their sign, kg m².
        turn : float or quantity
            The inertia is turned against the shape by this angle about the third axis, from the first towards the
            second, rad.
        centre : sequence of 3 floats or quantities, optional
            The ellipsoid's centre from the centre of mass, body frame, m; absent: the two coincide.

        Returns
        -------
        Body
            The ellipsoid.

        Raises
        ------
        InvalidValueError
            If a value is not positive, or the moments belong to no body.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.ellipsoid((3.0, 2.0, 1.0), mass=5.0).inertia
        Principal(x=5.0, y=10.0, z=13.0)
        """
        a, b, c = semi_axes
        m = mass_of(mass, density, 4 / 3 * math.pi * a * b * c)
        if moments is None:
            moments = [m * (p * p + q * q) / 5 for p, q in ((b, c), (c, a), (a, b))]
        return cls(m, inertia_of(moments, products, turn), Ellipsoid(a, b, c, centre))

    @classmethod
    @builder("formula", SupportFunction)
    def shape_formula(
        cls,
        support_function: Annotated[
            Any,
            Formula(
                NAMES,
                "h in nu_x, nu_y, nu_z, m: how far the body reaches in the direction of the unit normal nu.",
                "0.025 + 0.003*nu_z + 0.004*nu_z**2",
            ),
        ],
        mass: MassOr = None,
        density: DensityOr = None,
        moments: OwnMoments = None,
        products: Products = None,
        centre: Centre = None,
    ) -> Self:
        """Make a smooth convex body of your own from its support function, homogeneous unless moments are given.

        Parameters
        ----------
        support_function : str
            h(ν) in nu_x, nu_y, nu_z, the components of the outward unit normal, m: how far the body reaches in the
            direction ν from a point of your choice.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        moments, products : sequence of 3 floats or quantities, optional
            J_xx, J_yy, J_zz and J_xy, J_xz, J_yz about the centre of mass, kg m²; absent: those of a homogeneous body.
        centre : sequence of 3 floats or quantities, optional
            The point that h is reckoned from, from the centre of mass, body frame, m. Absent: where it is in a
            homogeneous body; with `moments`, in the centre of mass.

        Returns
        -------
        Body
            Volume, centre of mass and inertia come from integrals over the surface; the axes stay those of h.

        Raises
        ------
        InvalidValueError
            If h is not that of a smooth convex body; the direction is named.

        Examples
        --------
        >>> from trundle import Body
        >>> egg = Body.shape_formula("0.025 + 0.003*nu_z + 0.004*nu_z**2", density="1.03 g/cm^3")
        >>> round(egg.mass, 4), egg.axisymmetric
        (0.0779, True)
        """
        bare = SupportFunction(support_function)
        if moments is not None:
            m = mass_of(mass, density, homogeneous(bare).volume if mass is None else None)
            return cls(m, inertia_of(moments, products), SupportFunction(bare.formula, centre))
        for name, value in (("products", products), ("centre", centre)):
            if value is not None:
                remedy = "Without them the body is homogeneous, and both follow from its shape."
                raise InvalidValueError(name, "must stand beside `moments`", value, remedy)
        whole = homogeneous(bare)
        m = mass_of(mass, density, whole.volume)
        moments, products = whole.inertia(m)
        away = None if whole.centre == ZERO else ZERO - whole.centre
        return cls(m, inertia_of(moments, products), SupportFunction(bare.formula, away))


def mass_of(mass: Any, density: Any, volume: Scalar | None, missing: str = "") -> Scalar:
    """Return a mass that was given, or that of a homogeneous body whose density was given: exactly one of them.

    Examples
    --------
    >>> mass_of(None, "7.8 g/cm^3", 2e-6)
    0.0156
    """
    if mass is not None and density is not None:
        raise InvalidValueError("density", "must not stand beside `mass`", density, "Give one of the two.")
    if mass is not None:
        return checks.positive(mass, "mass", "mass")
    if density is None:
        raise InvalidValueError("mass", "must be given, or `density`", None, "Give for instance mass='65 g'.")
    heavy = checks.positive(density, "density", "density")
    if volume is None:
        raise InvalidValueError("density", f"needs {missing}", density, "Or give `mass`.")
    return heavy * volume
