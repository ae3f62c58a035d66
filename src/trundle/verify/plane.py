"""The lecture's own formulas beside a run: reaction and acceleration of a ball on a fixed plane; straight rolling."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..mechanics.algebra import E_Z, Quaternion, Vector
from ..mechanics.scalars import is_zero
from ..mechanics.system import RollingSystem
from ..solve.samples import Samples
from .bounds import Array, largest
from .card import CardFigure, checked


def reactions(system: RollingSystem, at: Samples, bound: float) -> Iterator[CardFigure]:
    """Compare contact force and acceleration with R = (K×n/a − kF)/(1 + k), m V̇ = (F + K×n/a)/(1 + k) in the plane.

    They come from the lecture's elimination for a sphere on a fixed plane (Landau and Lifshitz, Mechanics, § 38,
    problem 1), which the rolling law does not use. F is all applied force, K all applied torque, at each sample.

    Examples
    --------
    >>> import trundle as tr
    >>> card = tr.Scenario.load("ball-under-torque").run().card()
    >>> card["reaction in the plane"].passed, card["reaction in the plane"].note[:46]
    (True, '(K×n/a − kF)/(1 + k); at the start (0.0714286,')
    """
    if not (system.body.is_isotropic_sphere and system.support.surface.flat) or not _is_fixed(system):
        return
    k, a, m = (float(number) for number in (system.body.inertia_ratio, system.body.radius, system.body.mass))
    acting = system.acting_on(at.motion(system))
    K = acting.torque + acting.couple * at.contact_force[:, 2]  # with resistance, which goes with the normal force
    F, driven = (_in_plane(v, at) for v in (acting.force, K.cross(E_Z) * (1 / a)))
    R = at.contact_force[:, :2]
    size = max(largest(F), largest(driven), 1e-300)
    if max(largest(F), largest(driven)) == 0:  # nothing pushes: nothing to compare with
        return
    wanted = (driven - k * F) / (1 + k)
    off = largest(R - wanted) / size
    yield checked("reaction in the plane", off, bound, f"(K×n/a − kF)/(1 + k); at the start {_pair(R[0])} N")
    gained = (F + driven) / (m * (1 + k))
    off = largest((F + R) / m - gained) * m / size
    note = f"(F + K×n/a)/(m(1 + k)); at the start {_pair(gained[0])} m/s²"
    yield checked("acceleration in the plane", off, bound, note)


def straightness(system: RollingSystem, at: Samples, bound: float) -> Iterator[CardFigure]:
    """Check that a cylinder kept to its line: Ω along its axis, and the axis along the support.

    Examples
    --------
    >>> import trundle as tr
    >>> tr.Scenario.load("cylinder-on-incline").run().card()["rolls straight"].passed
    True
    """
    if system.body.shape.axis is None:
        return
    axis = (Quaternion.of(at.orientation).matrix() @ system.body.shape.axis).array()
    along = np.einsum("ni,ni->n", at.angular_velocity, axis)
    # Beside what the contact force could bring about in the run: at rest, Ω itself is nothing but rounding.
    arm, span = largest(at.contact - at.position), float(at.time[-1] - at.time[0])
    driven = 1e-3 * largest(at.contact_force) / float(system.body.mass) * span / arm
    size = max(largest(at.angular_velocity), driven, 1e-300)
    across = largest(at.angular_velocity - along[:, None] * axis) / size
    askew = float(np.abs(np.einsum("ni,ni->n", axis, at.normals(system))).max())
    yield checked(
        "rolls straight", max(across, askew), bound, "share of Ω across the axis, and of the axis off the wall"
    )


def _is_fixed(system: RollingSystem) -> bool:
    rate = system.support.motion.steady_rate
    return rate is not None and is_zero(rate)


def _in_plane(v: Vector, at: Samples) -> Array:
    return np.broadcast_to(v.array(), at.position.shape)[:, :2]


def _pair(pair: Array) -> str:
    return f"({pair[0] + 0.0:.6g}, {pair[1] + 0.0:.6g})"
