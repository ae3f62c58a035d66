"""Bodies: a mass, an inertia tensor and a shape, and builders for the common ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..errors import InvalidValueError
from . import checks
from .algebra import ZERO, Matrix, Vector
from .scalars import Scalar, is_number
from .shapes import Roller, Shape, Sphere, concentric_sphere

SOLID_SPHERE, HOLLOW_SPHERE = 2 / 5, 2 / 3  # k = I/(m a²)
SOLID_CYLINDER, HOOP = 1 / 2, 1.0


@dataclass(frozen=True)
class Isotropic:
    """The same moment of inertia about every axis through the centre of mass.

    Parameters
    ----------
    moment : float
        I, kg m².

    Examples
    --------
    >>> Body(1.0, Isotropic(2.0), Sphere(1.0)).inertia_in_space(Matrix.identity()).a
    Vector(x=2.0, y=0.0, z=0.0)
    """

    moment: Scalar

    def __post_init__(self) -> None:
        object.__setattr__(self, "moment", checks.positive(self.moment, "inertia", "inertia.moment"))

    def in_space(self, Q: Matrix, body: Body) -> Matrix:  # noqa: ARG002  the same from every side
        """Return the inertia tensor in the support frame, kg m²."""
        return Matrix.diagonal(self.moment, self.moment, self.moment)

    def gyroscopic(self, Q: Matrix, Omega: Vector, body: Body) -> Vector:  # noqa: ARG002
        """Return Ω×JΩ = 0: JΩ is along Ω."""
        return ZERO

    def ratio_of(self, body: Body) -> Scalar:
        """Return k = I/(m a²) for a spherical body of radius a."""
        return self.moment / (body.mass * body.radius * body.radius)


@dataclass(frozen=True)
class RatioInertia:
    """The inertia I = k m a² of a round body, given by its ratio k, which is kept to the last digit.

    Parameters
    ----------
    ratio : float
        k = I/(m a²): 2/5 for a solid sphere, 2/3 for a shell, never more for a sphere; 1/2 for a solid cylinder about
        its axis, 1 for a hoop, never more.

    Examples
    --------
    >>> RatioInertia(0.4).ratio
    0.4
    """

    ratio: Scalar

    def __post_init__(self) -> None:
        object.__setattr__(self, "ratio", checks.positive(self.ratio, "number", "inertia_ratio"))

    def in_space(self, Q: Matrix, body: Body) -> Matrix:  # noqa: ARG002  the same from every side
        """Return the inertia tensor in the support frame, kg m²."""
        moment = self.ratio * body.mass * body.radius * body.radius
        return Matrix.diagonal(moment, moment, moment)

    def gyroscopic(self, Q: Matrix, Omega: Vector, body: Body) -> Vector:  # noqa: ARG002
        """Return Ω×JΩ = 0: JΩ is along Ω."""
        return ZERO

    def ratio_of(self, body: Body) -> Scalar:  # noqa: ARG002
        """Return k."""
        return self.ratio


@dataclass(frozen=True)
class Principal:
    """Three principal moments of inertia, about the axes of the body frame.

    Parameters
    ----------
    x, y, z : float
        Moments about the centre of mass, kg m².

    Examples
    --------
    >>> Body(1.0, Principal(1.0, 2.0, 2.5), Sphere(3.0)).inertia_in_space(Matrix.identity()).b
    Vector(x=0.0, y=2.0, z=0.0)
    """

    x: Scalar
    y: Scalar
    z: Scalar

    def __post_init__(self) -> None:
        moments = [checks.positive(getattr(self, name), "inertia", f"inertia.{name}") for name in "xyz"]
        for name, moment in zip("xyz", moments, strict=True):
            object.__setattr__(self, name, moment)
        if all(is_number(moment) for moment in moments) and 2 * max(moments) > sum(moments) * (1 + 1e-12):
            raise InvalidValueError(
                "inertia", "must obey the triangle rule, each moment at most the sum of the others", tuple(moments)
            )

    def in_space(self, Q: Matrix, body: Body) -> Matrix:  # noqa: ARG002
        """Return Q diag(x, y, z) Qᵀ, the inertia tensor in the support frame, kg m²."""
        return Q @ Matrix.diagonal(self.x, self.y, self.z) @ Q.transpose

    def gyroscopic(self, Q: Matrix, Omega: Vector, body: Body) -> Vector:
        """Return Ω×JΩ in the support frame, N m."""
        return Omega.cross(self.in_space(Q, body) @ Omega)


Inertia = (Isotropic, RatioInertia, Principal)


@dataclass(frozen=True)
class Body:
    """A rigid convex body.

    Parameters
    ----------
    mass : float
        m, kg.
    inertia : Isotropic, RatioInertia or Principal
        J about the centre of mass.
    shape : Shape
        The surface that touches the support.

    Examples
    --------
    >>> Body.solid_sphere(radius=0.025, mass=0.065).inertia_ratio
    0.4
    """

    mass: Scalar
    inertia: Isotropic | RatioInertia | Principal
    shape: Shape

    def __post_init__(self) -> None:
        checks.instance(self.inertia, Inertia, "inertia", "Give for instance tr.Isotropic(1e-5).")
        checks.instance(self.shape, Shape, "shape", "Give for instance tr.Sphere(0.025).")
        object.__setattr__(self, "mass", checks.positive(self.mass, "mass", "mass"))
        if isinstance(self.inertia, RatioInertia):
            self._check_ratio(self.inertia.ratio)

    def _check_ratio(self, k: Scalar) -> None:
        """Refuse an inertia ratio for which mass would have to lie outside the body."""
        most, said, remedy = HOLLOW_SPHERE, "2/3", "A thin shell has 2/3; no sphere has more."
        if self.shape.axis is not None:
            most, said, remedy = HOOP, "1", "A hoop has 1; no cylinder has more."
        if is_number(k) and k > most * (1 + 1e-12):
            raise InvalidValueError("inertia_ratio", f"must lie in (0, {said}]", k, remedy)

    @staticmethod
    def sphere(radius: Any, mass: Any, inertia_ratio: Any) -> Body:
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
        >>> ball = Body.sphere(radius="40 mm", mass="2.7 g", inertia_ratio=0.5)
        >>> ball.shape.radius, round(ball.inertia_ratio, 12)
        (0.04, 0.5)
        """
        return Body(mass, RatioInertia(inertia_ratio), Sphere(radius))

    @staticmethod
    def solid_sphere(radius: Any, mass: Any) -> Body:
        """Make a homogeneous ball, I = (2/5) m a².

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.

        Returns
        -------
        Body
            The ball.

        Examples
        --------
        >>> Body.solid_sphere(radius=1.0, mass=5.0).inertia_in_space(Matrix.identity()).c.z
        2.0
        """
        return Body.sphere(radius, mass, SOLID_SPHERE)

    @staticmethod
    def hollow_sphere(radius: Any, mass: Any) -> Body:
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
        >>> Body.hollow_sphere(radius=1.0, mass=3.0).inertia_ratio
        0.6666666666666666
        """
        return Body.sphere(radius, mass, HOLLOW_SPHERE)

    @staticmethod
    def cylinder(radius: Any, mass: Any, inertia_ratio: Any = SOLID_CYLINDER) -> Body:
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
        >>> Body.cylinder("3 cm", "200 g").inertia_ratio
        0.5
        """
        return Body(mass, RatioInertia(inertia_ratio), Roller(radius))

    @staticmethod
    def hoop(radius: Any, mass: Any) -> Body:
        """Make a hoop or a thin pipe that rolls straight, I = m a².

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.

        Returns
        -------
        Body
            The hoop.

        Examples
        --------
        >>> Body.hoop("30 cm", "1 kg").inertia_ratio
        1.0
        """
        return Body.cylinder(radius, mass, HOOP)

    @staticmethod
    def weighted_cylinder(
        radius: Any, mass: Any, weight: Any, distance: Any, inertia_ratio: Any = SOLID_CYLINDER
    ) -> Body:
        """Make a cylinder with a small weight fixed off its axis, on the first axis of the body frame.

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
        >>> Body.weighted_cylinder(0.05, 0.3, 0.1, 0.04).shape.centre.x
        -0.01
        """
        bare = Body.cylinder(radius, mass, inertia_ratio)
        m, d = checks.positive(weight, "mass", "weight"), checks.positive(distance, "length", "distance")
        if is_number(d) and is_number(bare.radius) and d > bare.radius:
            raise InvalidValueError(
                "distance", "must be at most the radius", distance, f"The cylinder ends at {bare.radius:g} m."
            )
        total = bare.mass + m
        centre = m * d / total
        moment = bare.inertia_ratio * bare.mass * bare.radius**2 + bare.mass * centre**2 + m * (d - centre) ** 2
        return Body(total, Isotropic(moment), Roller(bare.radius, Vector(-centre, 0.0, 0.0)))

    def inertia_in_space(self, Q: Matrix) -> Matrix:
        """Return J in the support frame, kg m², for the rotation matrix Q from the body frame to that frame."""
        return self.inertia.in_space(Q, self)

    def gyroscopic(self, Q: Matrix, Omega: Vector) -> Vector:
        """Return Ω×JΩ in the support frame, N m."""
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
        return concentric_sphere(self.shape) and not isinstance(self.inertia, Principal)

    @property
    def inertia_ratio(self) -> Scalar:
        """K = I/(m a²) of an isotropic sphere."""
        if isinstance(self.inertia, Principal) or not self.is_isotropic_sphere:
            raise InvalidValueError("inertia_ratio", "exists only for a sphere with isotropic inertia", self)
        return self.inertia.ratio_of(self)
