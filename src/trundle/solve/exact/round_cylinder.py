"""What the closed forms of a ball that rolls round a cylinder, and along it, have in common (T7, T8)."""

from __future__ import annotations

import math
from typing import Any

from ...mechanics.algebra import E_Z, Vector
from ...mechanics.duals import value_of
from ...mechanics.scalars import Scalar, is_number, namespace
from ...mechanics.surfaces import Cylinder
from ...mechanics.system import RollingSystem, State
from .domain import CONSTANT_LOADS, NO_TORQUE, SPHERE, TURNING_STEADILY, constant_forces, on
from .phi import quotient_times, two_product

_ASIDE = 1e-12  # share of the loads that may point across or along the axis by rounding
ON_CYLINDER = (SPHERE, on(Cylinder), TURNING_STEADILY, CONSTANT_LOADS, NO_TORQUE)


def pull(system: RollingSystem) -> tuple[float, float, float]:
    """Return the constant force on the body, N, without what is rounding only across or along the axis.

    Examples
    --------
    >>> import trundle as tr
    >>> upside_down = tr.Support(tr.Cylinder(1.0), tilt="180 deg")
    >>> pull(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), upside_down))
    (0.0, 0.0, 9.80665)
    """
    fx, fy, fz = constant_forces(system)[0]
    across = math.hypot(value_of(fx), value_of(fy))
    if across <= _ASIDE * abs(value_of(fz)):
        return 0.0, 0.0, fz
    return fx, fy, 0.0 if abs(value_of(fz)) <= _ASIDE * across else fz


def numbers_of(system: RollingSystem, start: State) -> dict[str, Any]:
    """Return body, cylinder and start as the closed forms take them, the angle from the first axis.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5)))
    >>> numbers_of(system, system.place((0.0, 2.0), (0.8, 0.1)))["angular_rate"]
    2.0
    """
    surface: Any = system.support.surface
    r, V, Omega = Vector(*start.position), Vector(*start.velocity), Vector(*start.angular_velocity)
    xp = namespace(r.x, r.y)
    distance = xp.hypot(r.x, r.y)
    length = surface.radius + surface.sign * system.body.radius
    return {
        "radius": system.body.radius,
        "mass": system.body.mass,
        "inertia_ratio": system.body.inertia_ratio,
        "track_radius": surface.radius,
        "side": surface.sign,
        "rate": system.support.motion.steady_rate,
        "angle": xp.atan2(r.y, r.x),
        "angular_rate": (r.x * V.y - r.y * V.x) / (distance * length),
        "height": r.z,
        "climb": V.z,
        "spin": surface.sign * (r.x * Omega.x + r.y * Omega.y) / distance,
        "force": pull(system),
    }


def frequency_ratio(k: Scalar) -> tuple[Scalar, Scalar]:
    """Return √(k/(1 + k)) as a float and what the float leaves, so that a phase keeps its last digit.

    Examples
    --------
    >>> frequency_ratio(1 / 3)[0]
    0.5
    """
    square, rest = quotient_times(1.0, k)
    root = namespace(square).sqrt(square)
    if not (is_number(root) or hasattr(root, "__array_namespace__")):
        return root, 0.0
    again, error = two_product(root, root)
    whole = namespace(root).where(root > 0, root, 1.0)
    return root, ((square - again) - error + rest) / (2 * whole)  # a step of Newton's


def vectors_of(
    form: Any, out: Vector, angular: tuple[Scalar, Scalar], along: tuple[Scalar, Scalar, Scalar], twist: Scalar
) -> tuple[Vector, Vector, Vector, Vector]:
    """Return position, velocity, angular velocity and contact force from the motion round and along the cylinder."""
    length, (rate, rate_rate), (z, climb, climb_rate) = form.length, angular, along
    around, per_radius = Vector(-out.y, out.x, 0.0), form.side / form.radius
    speed = rate * length
    # Rolling, V + Ω×ρ = u with ρ = −a n: ℓθ̇ − side·aΩ_z = bω along the tangent, ż + side·aΩ_θ = 0 along the axis.
    Omega = out * (twist * per_radius) - around * (climb * per_radius)
    Omega = Omega + E_Z * ((speed - form.track_radius * form.rate) * per_radius)
    acceleration = around * (rate_rate * length) - out * (speed * rate) + E_Z * climb_rate
    return (
        out * length + E_Z * z,
        around * speed + E_Z * climb,
        Omega,
        acceleration * form.mass - Vector(*form.force),
    )
