"""Volume, centre of mass and inertia of a homogeneous body, from its support map by integrals over the sphere of ν.

With the area element dA = det(∂X/∂ν) dν of the Gauss map and h = X·ν, the divergence theorem gives
V = ⅓∮h dA, V c = ¼∮X h dA and ∫x xᵀ dV = ⅕∮X Xᵀ h dA.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...errors import InvalidValueError
from ..algebra import Vector
from ..shapes import Shape

_FEWEST, _MOST = 24, 384  # latitudes
_CLOSE, _CLOSE_ENOUGH = 1e-12, 1e-9  # of two counts of latitudes; the finer is much better than that
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Homogeneous:
    """Volume, centre of mass and second moments of a homogeneous body.

    Examples
    --------
    >>> from trundle.mechanics.shapes import Sphere
    >>> round(homogeneous(Sphere(1.0)).inertia(5.0)[0][2], 12)
    2.0
    """

    volume: float  # m³
    centre: Vector  # of mass, from the origin of the shape, m
    second: tuple[float, ...]  # ∫x xᵀ dV/V about the centre of mass, its elements xx, yy, zz, xy, xz, yz, m²

    def inertia(self, mass: Any) -> tuple[tuple[Any, Any, Any], tuple[Any, Any, Any]]:
        """Return J_xx, J_yy, J_zz and J_xy, J_xz, J_yz about the centre of mass, kg m²."""
        xx, yy, zz, xy, xz, yz = self.second
        return (mass * (yy + zz), mass * (zz + xx), mass * (xx + yy)), (
            0.0 - mass * xy,
            0.0 - mass * xz,
            0.0 - mass * yz,
        )


def homogeneous(shape: Shape) -> Homogeneous:
    """Return volume, centre of mass and second moments of a homogeneous body.

    Examples
    --------
    >>> import math
    >>> from trundle.mechanics.shapes import Ellipsoid
    >>> round(homogeneous(Ellipsoid(3.0, 2.0, 1.0)).volume / math.pi, 12)
    8.0
    """
    import numpy as np

    refusal = InvalidValueError(
        "support_function",
        "must be smooth enough to integrate over",
        getattr(shape, "formula", shape),
        "Round it off, or give `mass` and `moments`.",
    )
    try:
        widths = _half_widths(shape)
    except ArithmeticError:
        raise refusal from None
    size = max(widths)
    latitudes, before, change = _FEWEST, None, np.inf
    while latitudes <= _MOST and change > _CLOSE:
        now = _integrals(shape, latitudes, widths)
        if before is not None:
            change = float(np.abs(now - before).max() / np.abs(now).max())
        latitudes, before = 2 * latitudes, now
    if before is None or not change <= _CLOSE_ENOUGH or not before[0] > 0:
        raise refusal
    return _whole(before, size)


def _half_widths(shape: Shape) -> tuple[float, ...]:
    """Return half the extent of the body along each axis, m."""
    widths = []
    for i in range(3):
        nu = Vector(*(1.0 if i == j else 0.0 for j in range(3)))
        widths.append(0.5 * float((shape.support_map(nu) - shape.support_map(-nu)).dot(nu)))
    return tuple(widths)


def _grid(latitudes: int, widths: tuple[float, ...]) -> tuple[Vector, Any]:
    """Return directions and their weights: Gauss-Legendre in the height, even in the longitude of a sphere.

    That sphere is the one which the ellipsoid of the body's widths is stretched from; so the directions stand thick
    where a long body is sharply curved, and for an ellipsoid the integrands are polynomials.
    """
    import numpy as np

    height, weight = np.polynomial.legendre.leggauss(latitudes)
    angle = (np.arange(2 * latitudes) + 0.5) * (np.pi / latitudes)
    z, phi = (part.ravel() for part in np.meshgrid(height, angle, indexing="ij"))
    across = np.sqrt(1 - z * z)
    size, (a, b, c) = max(widths), widths
    u = Vector(across * np.cos(phi) * (size / a), across * np.sin(phi) * (size / b), z * (size / c))
    length = u.norm()
    stretched = (size / a) * (size / b) * (size / c) / (length * length * length)
    return u / length, np.repeat(weight, 2 * latitudes) * (np.pi / latitudes) * stretched


def _integrals(shape: Shape, latitudes: int, widths: tuple[float, ...]) -> Any:
    """Return V, ∫x dV and ∫x xᵀ dV, lengths in units of the largest half-width."""
    import numpy as np

    nu, weight = _grid(latitudes, widths)
    size = max(widths)
    point, gradient = shape.support_map(nu) / size, shape.support_gradient(nu) * (1 / size)
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = (tuple(row) for row in gradient.rows)
    # ∂X/∂ν has the eigenvalue 0 along ν, so that its determinant across ν is the sum of its minors.
    area = (xx * yy - xy * xy) + (yy * zz - yz * yz) + (zz * xx - xz * xz)
    measure = weight * point.dot(nu) * area
    x, y, z = point
    second = (x * x, y * y, z * z, x * y, x * z, y * z)
    return np.array(
        [
            np.sum(measure) / 3,
            *(np.sum(measure * part) / 4 for part in (x, y, z)),
            *(np.sum(measure * part) / 5 for part in second),
        ]
    )


def _whole(found: Any, size: float) -> Homogeneous:
    volume, *rest = (float(part) for part in found)
    # What is rounding is no asymmetry: a body that looks symmetric is made so.
    x, y, z = (0.0 if abs(part) <= _ROUNDING * volume else part / volume for part in rest[:3])
    about = (x * x, y * y, z * z, x * y, x * z, y * z)
    moments = [moment / volume - square for moment, square in zip(rest[3:], about, strict=True)]
    largest = max(moments[:3])
    off = [0.0 if abs(moment) <= _ROUNDING * largest else moment for moment in moments[3:]]
    own = moments[:3]
    for i, j in ((0, 1), (1, 2), (2, 0)):
        if abs(own[i] - own[j]) <= _ROUNDING * largest:
            own[i] = own[j] = min(own[i], own[j])
    second = tuple(moment * size * size for moment in (*own, *off))
    return Homogeneous(volume * size**3, Vector(x * size, y * size, z * size), second)
