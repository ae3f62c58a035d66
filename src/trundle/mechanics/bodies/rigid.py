"""What a body is to the mechanics: a mass, an inertia tensor and a shape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...errors import InvalidValueError
from .. import checks
from ..algebra import Matrix, Vector
from ..scalars import Scalar, is_number
from ..shapes import Shape, Sphere, concentric_sphere
from .inertia import Inertia, Isotropic, Principal, RatioInertia, Tensor

SOLID_SPHERE, HOLLOW_SPHERE = 2 / 5, 2 / 3  # k = I/(m a²)
SOLID_CYLINDER, HOOP = 1 / 2, 1.0


@dataclass(frozen=True)
class RigidBody:
    """Mass, inertia and shape, without the builders of `Body`.

    Examples
    --------
    >>> RigidBody(1.0, Isotropic(2.0), Sphere(3.0)).radius
    3.0
    """

    mass: Scalar
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
        most, said, remedy = HOLLOW_SPHERE, "2/3", "A thin shell has 2/3; no sphere has more."
        if self.shape.axis is not None:
            most, said, remedy = HOOP, "1", "A hoop has 1; no cylinder has more."
        if is_number(k) and k > most * (1 + 1e-12):
            raise InvalidValueError("inertia_ratio", f"must lie in (0, {said}]", k, remedy)

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
        return concentric_sphere(self.shape) and isinstance(self.inertia, (Isotropic, RatioInertia))

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
