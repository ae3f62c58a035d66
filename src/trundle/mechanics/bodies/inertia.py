"""Inertia tensors about the centre of mass: the same all round, by a ratio, by principal moments, or any."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from ...errors import InvalidValueError
from .. import checks
from ..algebra import ZERO, IsotropicTensor, Matrix, RotatedTensor, Vector
from ..parts import POSITIVE, Number
from ..scalars import Scalar, is_number, is_zero, namespace

MOMENT = Number("inertia")

_SLACK = 1e-12  # of a moment: the rounding that a rule is not held against


def _at_most_a_shell(k: Scalar, received: Any) -> None:
    # I ≤ (2/3) m a² for any mass inside a sphere: I is a third of the trace, (2/3) Σ m r² with r ≤ a.
    if not 0 < k <= 2 / 3 * (1 + _SLACK):
        remedy = "2/3 is a thin shell, all its mass at the surface; no sphere has more."
        raise InvalidValueError("", "must lie in (0, 2/3]", received, remedy)


def _at_most_a_hoop(k: Scalar, received: Any) -> None:
    if not 0 < k <= 1 + _SLACK:
        raise InvalidValueError("", "must lie in (0, 1]", received, "1 is a hoop; no cylinder has more.")


SPHERE_RATIO = Number(
    "number",
    POSITIVE,
    "k = I/(m a²), above 0 and at most a shell's 2/3.",
    0.4,
    limit=_at_most_a_shell,
    label="Inertia ratio k",
)
CYLINDER_RATIO = Number(
    "number",
    POSITIVE,
    "k = I/(m a²) about its axis, at most a hoop's 1.",
    0.5,
    limit=_at_most_a_hoop,
    label="Inertia ratio k",
)


@dataclass(frozen=True)
class Isotropic:
    """The same moment of inertia about every axis through the centre of mass.

    Parameters
    ----------
    moment : float
        I, kg m².

    Examples
    --------
    >>> from trundle import Body, Sphere
    >>> Body(1.0, Isotropic(2.0), Sphere(1.0)).inertia_in_space(Matrix.identity()).a
    Vector(x=2.0, y=0.0, z=0.0)
    """

    moment: Annotated[Scalar, MOMENT]
    isotropic = axisymmetric = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "moment", checks.positive(self.moment, "inertia", "inertia.moment"))

    def in_space(self, Q: Matrix, body: Any) -> IsotropicTensor:  # noqa: ARG002  the same from every side
        """Return the inertia tensor in the support frame, kg m²."""
        return IsotropicTensor.of(self.moment)

    def gyroscopic(self, Q: Matrix, Omega: Vector, body: Any) -> Vector:  # noqa: ARG002
        """Return Ω×JΩ = 0: JΩ is along Ω."""
        return ZERO

    @property
    def of_revolution(self) -> Isotropic:
        """The same, known to be symmetric about the third axis."""
        return self

    def parameters(self, body: Any) -> dict[str, Any]:  # noqa: ARG002
        """Return what a builder may be given instead."""
        return {"moment_of_inertia": self.moment, "moments": (self.moment,) * 3}

    def ratio_of(self, body: Any) -> Scalar:
        """Return k = I/(m a²) for a spherical body of radius a."""
        return self.moment / (body.mass * body.radius * body.radius)

    def times(self, factor: Scalar, body: Any) -> Isotropic:  # noqa: ARG002
        """Return so many times as large an inertia."""
        return Isotropic(self.moment * factor)


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
    isotropic = axisymmetric = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "ratio", checks.positive(self.ratio, "number", "inertia_ratio"))

    def in_space(self, Q: Matrix, body: Any) -> IsotropicTensor:  # noqa: ARG002  the same from every side
        """Return the inertia tensor in the support frame, kg m²."""
        return IsotropicTensor.of(self.ratio * body.mass * body.radius * body.radius)

    def gyroscopic(self, Q: Matrix, Omega: Vector, body: Any) -> Vector:  # noqa: ARG002
        """Return Ω×JΩ = 0: JΩ is along Ω."""
        return ZERO

    @property
    def of_revolution(self) -> RatioInertia:
        """The same, known to be symmetric about the third axis."""
        return self

    def parameters(self, body: Any) -> dict[str, Any]:
        """Return what a builder may be given instead."""
        moment = self.ratio * body.mass * body.radius * body.radius
        return {"inertia_ratio": self.ratio, "moment_of_inertia": moment, "moments": (moment,) * 3}

    def ratio_of(self, body: Any) -> Scalar:  # noqa: ARG002
        """Return k."""
        return self.ratio

    def times(self, factor: Scalar, body: Any) -> Isotropic:
        """Return so many times as large an inertia, more than a hoop's, even."""
        return Isotropic(self.ratio * body.mass * body.radius * body.radius * factor)


@dataclass(frozen=True)
class Principal:
    """Three principal moments of inertia, about the axes of the body frame.

    Parameters
    ----------
    x, y, z : float
        Moments about the centre of mass, kg m².

    Examples
    --------
    >>> from trundle import Body, Sphere
    >>> Body(1.0, Principal(1.0, 2.0, 2.5), Sphere(3.0)).inertia_in_space(Matrix.identity()).b
    Vector(x=0.0, y=2.0, z=0.0)
    """

    x: Annotated[Scalar, MOMENT]
    y: Annotated[Scalar, MOMENT]
    z: Annotated[Scalar, MOMENT]
    isotropic = False

    def __post_init__(self) -> None:
        moments = [checks.positive(getattr(self, name), "inertia", f"inertia.{name}") for name in "xyz"]
        for name, moment in zip("xyz", moments, strict=True):
            object.__setattr__(self, name, moment)
        if all(is_number(moment) for moment in moments) and 2 * max(moments) > sum(moments) * (1 + _SLACK):
            raise InvalidValueError(
                "inertia", "must obey the triangle rule, each moment at most the sum of the others", tuple(moments)
            )

    def parameters(self, body: Any) -> dict[str, Any]:  # noqa: ARG002
        """Return what a builder may be given instead."""
        return {"moments": (self.x, self.y, self.z)}

    @property
    def axisymmetric(self) -> bool:
        """Whether the first two moments are equal."""
        return is_number(self.x) and is_number(self.y) and bool(self.x == self.y)

    @property
    def of_revolution(self) -> Principal:
        """The same, known to be symmetric about the third axis."""
        return Principal(self.x, self.x, self.z)

    def times(self, factor: Scalar, body: Any) -> Principal:  # noqa: ARG002
        """Return so many times as large an inertia."""
        return Principal(self.x * factor, self.y * factor, self.z * factor)

    def in_space(self, Q: Matrix, body: Any) -> Matrix:  # noqa: ARG002
        """Return Q diag(x, y, z) Qᵀ, the inertia tensor in the support frame, kg m²."""
        return RotatedTensor(Q, Matrix.diagonal(self.x, self.y, self.z)).dense

    def gyroscopic(self, Q: Matrix, Omega: Vector, body: Any) -> Vector:
        """Return Ω×JΩ in the support frame, N m."""
        return Omega.cross(self.in_space(Q, body) @ Omega)


@dataclass(frozen=True)
class Tensor:
    """Any inertia tensor, by its six elements in the body frame: its principal axes need not be those of the shape.

    Parameters
    ----------
    xx, yy, zz : float
        Moments about the axes of the body frame through the centre of mass, kg m².
    xy, xz, yz : float
        The other elements of the tensor, kg m²: xy = −∫ x y dm, with its sign.

    Raises
    ------
    InvalidValueError
        If the principal moments are not positive or break the triangle rule.

    Examples
    --------
    The rattleback of Kane and Levinson along their axes, whose third points down:

    >>> round(Tensor(2e-4, 1.6e-3, 1.7e-3, xy=-2e-5).principal_turn, 6)
    0.014282
    """

    xx: Annotated[Scalar, MOMENT]
    yy: Annotated[Scalar, MOMENT]
    zz: Annotated[Scalar, MOMENT]
    xy: Annotated[Scalar, MOMENT] = 0.0
    xz: Annotated[Scalar, MOMENT] = 0.0
    yz: Annotated[Scalar, MOMENT] = 0.0
    isotropic = False

    def __post_init__(self) -> None:
        for i, name in enumerate(("xx", "yy", "zz")):
            object.__setattr__(self, name, checks.positive(getattr(self, name), "inertia", f"moments[{i}]"))
        for i, name in enumerate(("xy", "xz", "yz")):
            object.__setattr__(self, name, checks.real(getattr(self, name), "inertia", f"products[{i}]"))
        if all(is_number(element) for element in self.elements):
            self._check_principal_moments()

    def _check_principal_moments(self) -> None:
        import numpy as np

        moments = np.linalg.eigvalsh([list(row) for row in self.matrix.rows])
        shown = ", ".join(f"{moment:.6g}" for moment in moments)
        if not moments[0] > 0:
            remedy = f"They are {shown} kg m². Is a product of inertia too large?"
            raise InvalidValueError("inertia", "must have positive principal moments", self.elements, remedy)
        if moments[2] > (moments[0] + moments[1]) * (1 + _SLACK):
            rule = "must obey the triangle rule, each principal moment at most the sum of the others"
            raise InvalidValueError("inertia", rule, self.elements, f"They are {shown} kg m².")

    @property
    def elements(self) -> tuple[Scalar, ...]:
        """The six elements, as they are given."""
        return self.xx, self.yy, self.zz, self.xy, self.xz, self.yz

    def parameters(self, body: Any) -> dict[str, Any]:  # noqa: ARG002
        """Return what a builder may be given instead."""
        return {"moments": self.elements[:3], "products": self.elements[3:]}

    @property
    def matrix(self) -> Matrix:
        """The tensor in the body frame."""
        rows = ((self.xx, self.xy, self.xz), (self.xy, self.yy, self.yz), (self.xz, self.yz, self.zz))
        return Matrix(*(Vector(*row) for row in rows))

    @property
    def principal_turn(self) -> Scalar:
        """The angle from the first axis to the nearest principal one, about the third, rad, where xz = yz = 0."""
        apart = self.xx - self.yy
        angle = 0.5 * namespace(self.elements).atan2(2.0 * self.xy, apart)
        return angle if not is_number(apart) or apart >= 0 else 0.5 * namespace().atan2(-2.0 * self.xy, -apart)

    @property
    def axisymmetric(self) -> bool:
        """Whether it is diagonal with its first two moments equal."""
        return all(is_number(element) for element in self.elements) and bool(
            self.xx == self.yy and self.xy == self.xz == self.yz == 0
        )

    @property
    def of_revolution(self) -> Principal:
        """The same, known to be symmetric about the third axis."""
        return Principal(self.xx, self.xx, self.zz)

    def times(self, factor: Scalar, body: Any) -> Tensor:  # noqa: ARG002
        """Return so many times as large an inertia."""
        return Tensor(*(element * factor for element in self.elements))

    def in_space(self, Q: Matrix, body: Any) -> Matrix:  # noqa: ARG002
        """Return Q J Qᵀ, the inertia tensor in the support frame, kg m²."""
        return RotatedTensor(Q, self.matrix).dense

    def gyroscopic(self, Q: Matrix, Omega: Vector, body: Any) -> Vector:
        """Return Ω×JΩ in the support frame, N m."""
        return Omega.cross(self.in_space(Q, body) @ Omega)


Inertia = (Isotropic, RatioInertia, Principal, Tensor)


def inertia_of(moments: Any, products: Any = None, turn: Any = 0.0) -> Isotropic | Principal | Tensor:
    """Return the inertia with given elements, of the simplest kind that holds them.

    Examples
    --------
    >>> inertia_of((1.0, 2.0, 2.5)), inertia_of((1.0, 2.0, 2.5), turn="90 deg").yy
    (Principal(x=1.0, y=2.0, z=2.5), 1.0)
    """
    xx, yy, zz = (
        checks.positive(moment, "inertia", f"moments[{i}]")
        for i, moment in enumerate(checks.components(moments, "inertia", "moments"))
    )
    xy, xz, yz = checks.components((0.0, 0.0, 0.0) if products is None else products, "inertia", "products")
    angle = checks.real(turn, "angle", "turn")
    try:
        if not all(is_zero(value) for value in (xy, xz, yz, angle)):
            return Tensor(*_turned((xx, yy, zz, xy, xz, yz), angle))
        if is_number(xx) and is_number(yy) and is_number(zz) and xx == yy == zz:
            return Isotropic(xx)
        return Principal(xx, yy, zz)
    except InvalidValueError as error:
        raise InvalidValueError("moments", error.rule, error.received, error.remedy) from None


def _turned(elements: tuple[Scalar, ...], angle: Scalar) -> tuple[Scalar, ...]:
    """Return the elements of R₃ J R₃ᵀ."""
    if is_zero(angle):
        return elements
    xx, yy, zz, xy, xz, yz = elements
    xp = namespace(angle)
    c, s = xp.cos(angle), xp.sin(angle)
    return (
        xx * (c * c) + yy * (s * s) - 2.0 * (xy * c * s),
        xx * (s * s) + yy * (c * c) + 2.0 * (xy * c * s),
        zz,
        (xx - yy) * (c * s) + xy * (c * c - s * s),
        xz * c - yz * s,
        xz * s + yz * c,
    )
