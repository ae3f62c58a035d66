"""The rates of a disc or hoop when upright, from Appell's and Korteweg's Legendre functions: T10 of the theory page.

With e the disc's axis and x = e·n, the rates ω₃ = Ω·e and η = Ω·n − x ω₃ obey a linear pair in x alone,

    (1 − x²) dω₃/dx = −σ η,   dη/dx = −(C/A) ω₃,   σ = m a²/(C + m a²),                                    (T10)

whatever the lean does in time ([appell1900], [korteweg1899]). So what they would be with the disc upright, x = 0, never
changes: two first integrals besides the energy.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..algebra import Matrix, Quaternion, Vector
from ..scalars import is_zero
from ..system import RollingSystem
from .base import ROLLING, Invariant, Record

if TYPE_CHECKING:
    from ..bodies import Body

_TERMS = 64  # of a power series whose terms fall by half
_NORMALS = ((0.6, 0.48, 0.64), (-0.28, 0.576, 0.768), (0.36, -0.8, -0.48), (0.8, 0.36, -0.48))
_EQUAL = 1e-12


@dataclass(frozen=True)
class Rim:
    """A body that touches along a sharp circular rim about its centre of mass, and is alike about the rim's axis."""

    axis: Vector  # of the rim, in the body frame, a unit vector
    radius: float  # a, m
    across: float  # A, moment of inertia about a diameter, kg m²
    along: float  # C, moment of inertia about the axis, kg m²
    mass: float  # m, kg

    @property
    def share(self) -> float:
        """σ = m a²/(C + m a²): 2/3 for a disc, 1/2 for a hoop."""
        return self.mass * self.radius**2 / (self.along + self.mass * self.radius**2)

    @property
    def ratio(self) -> float:
        """C/A: 2 for what is thin."""
        return self.along / self.across


def rim_of(body: Body) -> Rim | None:
    """Return the rim of a disc or hoop, found by asking its shape and its inertia; None for any other body.

    Examples
    --------
    >>> import trundle as tr
    >>> rim_of(tr.Body.solid_sphere(0.1, 1.0)) is None
    True
    """
    import numpy as np

    J = body.inertia_in_space(Matrix.identity())
    rows = np.array([[float(part) for part in row] for row in J.rows])
    touched = [body.shape.support_map(Vector(*nu)) for nu in _NORMALS]
    points = np.array([[float(part) for part in point] for point in touched])
    for axis in range(3):
        flat = np.array(_NORMALS)
        flat[:, axis] = 0.0
        radii = np.linalg.norm(points, axis=1)
        round_ = np.abs(points - radii[:, None] * flat / np.linalg.norm(flat, axis=1)[:, None]).max()
        if max(round_, np.ptp(radii)) > _EQUAL * radii.max():
            continue
        others = [i for i in range(3) if i != axis]
        A, B, C = rows[others[0], others[0]], rows[others[1], others[1]], rows[axis, axis]
        if max(abs(A - B), np.abs(rows - np.diag(np.diag(rows))).max()) <= _EQUAL * C:
            return Rim(Vector(*np.eye(3)[axis].tolist()), float(radii[0]), float(A), float(C), float(body.mass))
    return None


def covers(system: RollingSystem) -> bool:
    """Tell whether T10 holds: a disc or hoop on a level plane at rest, under gravity alone.

    Examples
    --------
    >>> import trundle as tr
    >>> covers(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane())))
    False
    """
    support = system.support
    rate = support.motion.steady_rate
    level = support.surface.flat and is_zero(support.tilt) and rate is not None and is_zero(rate)
    return level and not system.loads and rim_of(system.body) is not None


def transfer(x: Any, rim: Rim) -> tuple[Any, Any, Any, Any]:
    """Return the four entries a, b, c, d with ω₃ = a ω₃⁰ + b η⁰ and η = c ω₃⁰ + d η⁰, of determinant 1.

    These are Legendre functions of degree ν, ν(ν + 1) = −σC/A, even and odd: power series about x = 0, and beyond it
    about 1/2, 3/4, 7/8, ... in turn, so that the terms always fall by half.

    Examples
    --------
    >>> hoop = Rim(Vector(0.0, 0.0, 1.0), 1.0, 0.5, 1.0, 1.0)
    >>> a, b, c, d = transfer(0.3, hoop)
    >>> print(round(float(a * d - b * c), 12))
    1.0
    """
    import numpy as np

    given = np.asarray(x, dtype=float)
    side, size = np.where(given < 0, -1.0, 1.0).ravel(), np.abs(given).ravel()
    step = np.floor(-np.log2(np.maximum(1.0 - size, 2.0**-52))).astype(int)
    found = np.empty((size.size, 2, 2))
    whole = np.eye(2)
    for j in range(int(step.max(initial=0)) + 1):
        centre = 1.0 - 0.5**j
        here = step == j
        if here.any():
            found[here] = _series(centre, size[here] - centre, rim) @ whole
        whole = _series(centre, np.array([0.5 ** (j + 1)]), rim)[0] @ whole
    # For −x the even solution keeps ω₃ and turns η, the odd one the other way round.
    a, d = (found[:, i, i].reshape(given.shape) for i in (0, 1))
    b, c = ((side * found[:, i, 1 - i]).reshape(given.shape) for i in (0, 1))
    return a, b, c, d


def _series(centre: float, h: Any, rim: Rim) -> Any:
    """Return the matrices that take (ω₃, η) from x = centre to centre + h, (n, 2, 2).

    By power series in u = h/r, where r = 1 − centre is how far they converge:
    (1 + c − 2cu − ru²) dω₃/du = −σ η and dη/du = −(C/A) r ω₃.
    """
    import numpy as np

    r = 1.0 - centre
    w, eta = [np.array([1.0, 0.0])], [np.array([0.0, 1.0])]
    for n in range(_TERMS):
        before = 2.0 * centre * n * w[n] + (r * (n - 1) * w[n - 1] if n > 0 else 0.0)
        w.append((before - rim.share * eta[n]) / ((1.0 + centre) * (n + 1)))
        eta.append(-rim.ratio * r * w[n] / (n + 1))
    total, u = np.zeros((h.size, 2, 2)), (h / r)[:, None, None]
    for a, b in zip(reversed(w), reversed(eta), strict=True):
        total = total * u + np.stack([a, b])
    return total


def upright_rates(rim: Rim, orientation: Quaternion, angular_velocity: Vector) -> tuple[list[Any], list[Any]]:
    """Return the two constants of T10: Ω·e and Ω·n as they would be with the disc upright, rad/s.

    Examples
    --------
    >>> coin = Rim(Vector(0.0, 0.0, 1.0), 1.0, 0.25, 0.5, 1.0)
    >>> upright = Quaternion(0.5**0.5, 0.5**0.5, 0.0, 0.0)
    >>> spin, turning = upright_rates(coin, upright, Vector(0.0, -3.0, 1.0))
    >>> [round(float(sum(terms)), 12) for terms in (spin, turning)]
    [3.0, 1.0]
    """
    e = orientation.matrix() @ rim.axis
    spin = angular_velocity.dot(e)
    eta = angular_velocity.z - e.z * spin
    a, b, c, d = transfer(e.z, rim)
    return [d * spin, -b * eta], [-c * spin, a * eta]


def _pair(system: RollingSystem, at: Record) -> list[Any]:
    """Return the terms of both constants, as one array (..., 2) each."""
    import numpy as np

    rim = rim_of(system.body)
    spin, turning = upright_rates(rim, at.motion.orientation, at.motion.angular_velocity)  # type: ignore[arg-type]
    return [np.stack(np.broadcast_arrays(*both), axis=-1) for both in zip(spin, turning, strict=True)]


def _size(system: RollingSystem, at: Record) -> Any:
    """Return how large both would be if Ω, of whose components rounding is a share, were along e or n."""
    import numpy as np

    rim, Omega = rim_of(system.body), at.motion.angular_velocity
    e = at.motion.orientation.matrix() @ rim.axis  # type: ignore[union-attr]
    a, b, c, d = (np.abs(entry) for entry in transfer(e.z, rim))  # type: ignore[arg-type]
    return np.stack([d + b, c + a], axis=-1) * np.asarray(Omega.norm())[..., None]


LEGENDRE_PAIR = Invariant(
    "rates when upright (Legendre pair)",
    "Ω·e and Ω·n at e·n = 0, by T10",
    "rad/s",
    lambda system: (ROLLING,) if covers(system) else (),
    _pair,
    size=_size,
)
