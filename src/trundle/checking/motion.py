"""Their motion at some instants: what they gave, and what was worked out of it, each with its error."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import Contact
from ..mechanics.system import RollingSystem, State
from ..solve.samples import Samples
from .record import Array, Theirs, contact_of, orientation_from
from .slopes import SIGMAS, Estimate

INSTANTS = 240  # looked at


@dataclass(frozen=True)
class Motion:
    """Their motion at some instants: what they gave, and what was worked out of it, each with its error.

    Lengths of vectors, (m,): `position_error`, ... ; `angular_velocity` follows from no slip where they gave nothing
    that tells it, and then `turning_known` is False.
    """

    index: NDArray[np.int_]
    time: Array
    position: Array
    velocity: Array
    angular_velocity: Array
    orientation: Array
    acceleration: Array
    angular_acceleration: Array
    position_error: Array
    velocity_error: Array
    angular_velocity_error: Array
    acceleration_error: Array
    angular_acceleration_error: Array
    contact: Contact
    turning_known: bool

    @property
    def offset(self) -> Array:
        """ρ, (m, 3), m."""
        return np.broadcast_to(self.contact.offset.array(), self.position.shape)

    @property
    def carried(self) -> Array:
        """Velocity u of the support at the contact, (m, 3), m/s."""
        return np.broadcast_to(self.contact.support.material_velocity(self.contact.point).array(), self.position.shape)

    @property
    def slip(self) -> Array:
        """Slip s = V + Ω×ρ − u, (m, 3), m/s."""
        return self.velocity + np.cross(self.angular_velocity, self.offset) - self.carried

    def samples(self) -> Samples:
        """Return the record that the independent law takes; the contact force is not known, and stands as zero."""
        point = np.broadcast_to(self.contact.point.array(), self.position.shape)
        zero = np.zeros_like(self.position)
        return Samples(self.time, self.position, point, self.velocity, self.angular_velocity, self.orientation, zero)


def motion_of(system: RollingSystem, theirs: Theirs, start: State | None = None, instants: int = INSTANTS) -> Motion:
    """Work out what they did not give, at instants spread over the run.

    Parameters
    ----------
    system : RollingSystem
        Body and support.
    theirs : Theirs
        Their samples.
    start : State, optional
        Gives orientation and spin where they do not tell.
    instants : int
        How many at most.

    Returns
    -------
    Motion
        At those instants.
    """
    n = theirs.time.size
    index = np.unique(np.linspace(0, n - 1, min(n, instants)).round().astype(int))
    q = _orientation(theirs, start)
    r = theirs.slope("position", index, 0)
    position_error = SIGMAS * r.noise
    if theirs.velocity is not None:
        slope = theirs.slope("velocity", index)
        V, V_error = theirs.velocity[index], SIGMAS * slope.noise
    else:
        first, slope = (theirs.slope("position", index, order) for order in (1, 2))
        V, V_error = first.values, first.error
    contact = contact_of(system, theirs.time[index], theirs.position[index], q[index])
    known = theirs.angular_velocity is not None or theirs.orientation is not None
    if theirs.angular_velocity is not None:
        turning = theirs.slope("angular_velocity", index)
        Omega, Omega_error = theirs.angular_velocity[index], SIGMAS * turning.noise
        if theirs.doubt is not None:
            Omega_error = Omega_error + theirs.doubt[index]
            turning = Estimate(turning.values, turning.error + _growth(theirs, index), turning.noise)
    elif theirs.orientation is not None:
        Omega, Omega_error, turning = turning_of(theirs, index)
    else:
        Omega = _from_no_slip(contact, V, start)
        rho = np.broadcast_to(contact.offset.array(), V.shape)
        Omega_error = (V_error + float(np.abs(rate_of(system))) * position_error) / np.linalg.norm(rho, axis=1)
        turning = Estimate(np.zeros_like(V), np.zeros(index.size), np.zeros(index.size))
    return Motion(
        index,
        theirs.time[index],
        theirs.position[index],
        V,
        Omega,
        q[index],
        slope.values,
        turning.values,
        position_error,
        V_error,
        Omega_error,
        slope.error,
        turning.error,
        contact,
        known,
    )


def turning_of(theirs: Theirs, index: NDArray[np.int_]) -> tuple[Array, Array, Estimate]:
    """Return Ω = 2 q̇ q* and Ω̇ = 2 q̈ q* from their orientations.

    Parameters
    ----------
    theirs : Theirs
        With orientations.
    index : int array (m,)
        At which samples.

    Returns
    -------
    angular_velocity : array (m, 3)
        rad/s.
    error : array (m,)
        Of it, rad/s.
    angular_acceleration : Estimate
        rad/s².
    """
    assert theirs.orientation is not None  # noqa: S101  for the type checker; callers have looked
    q = theirs.orientation
    first, second = (theirs.slope("orientation", index, order) for order in (1, 2))
    back = Quaternion.of(q[index]).conjugate

    def vector(rate: Array) -> Array:
        return 2 * (Quaternion.of(rate) * back).array()[:, 1:]

    # A noisy q shakes q̈ q* as well.
    shaken = 2 * SIGMAS * first.noise * np.linalg.norm(second.values, axis=1)
    alpha = Estimate(vector(second.values), 2 * second.error + shaken, second.noise)
    Omega_error = 2 * first.error + 2 * SIGMAS * first.noise * np.linalg.norm(first.values, axis=1)
    return vector(first.values), Omega_error, alpha


def _growth(theirs: Theirs, index: NDArray[np.int_]) -> Array:
    """Return what a doubt about Ω leaves of its slope: it turns with Ω as the body does."""
    assert theirs.doubt is not None  # noqa: S101
    assert theirs.angular_velocity is not None  # noqa: S101
    return theirs.doubt[index] * float(np.linalg.norm(theirs.angular_velocity, axis=1).max())


def _orientation(theirs: Theirs, start: State | None) -> Array:
    if theirs.orientation is not None:
        return theirs.orientation
    q0 = start.orientation if start is not None else (1.0, 0.0, 0.0, 0.0)
    return np.tile(q0, (theirs.time.size, 1))


def with_orientation(system: RollingSystem, theirs: Theirs, start: State | None) -> Theirs:
    """Add up their Ω to an orientation where the law needs one and they gave none.

    Parameters
    ----------
    system : RollingSystem
        A body that is the same from every side needs none.
    theirs : Theirs
        With Ω.
    start : State, optional
        Gives the orientation at the first sample.

    Returns
    -------
    Theirs
        With an orientation, if one is needed.
    """
    if system.body.is_isotropic_sphere or theirs.orientation is not None or theirs.angular_velocity is None:
        return theirs
    q0 = start.orientation if start is not None else (1.0, 0.0, 0.0, 0.0)
    q, doubt = orientation_from(theirs.time, theirs.angular_velocity, q0)
    size = np.linalg.norm(theirs.angular_velocity, axis=1)
    return replace(theirs, orientation=q, doubt=doubt * size)


def _from_no_slip(contact: Contact, V: Array, start: State | None) -> Array:
    """Return the Ω that rolling asks for, its part along the normal as at the start."""
    u = contact.support.material_velocity(contact.point)
    rho, n = contact.offset, contact.normal
    spin = 0.0 if start is None else float(np.asarray(start.angular_velocity) @ np.broadcast_to(n.array(), V.shape)[0])
    across = (Vector.of(V) - u).cross(rho) / rho.dot(rho)
    Omega = across + rho * ((spin - across.dot(n)) / rho.dot(n))
    return np.broadcast_to(Omega.array(), V.shape)


def rate_of(system: RollingSystem) -> float:
    """Return the support's rate, or the largest of its first instants', rad/s."""
    rate = system.support.motion.steady_rate
    if rate is not None:
        return float(rate)
    return max(float(system.support.motion.at(t).angular_velocity.norm()) for t in (0.0, 0.3, 0.7))
