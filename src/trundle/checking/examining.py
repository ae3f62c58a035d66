"""The motion of somebody else against contact, constraint and law, instant by instant, each with its own bound."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import Contact, roll
from ..mechanics.loads import BodyMotion
from ..mechanics.surfaces import Plane
from ..mechanics.system import RollingSystem, State
from ..solve.samples import Samples
from ..verify.law import _applied as applied
from ..verify.law import _newton_euler as newton_euler
from .record import Array, Theirs, contact_of, gap_of, orientation_from
from .slopes import SIGMAS, Estimate

_INSTANTS = 240
LAW_SHARE = 10.0  # times the tolerance: an acceleration is a slope, and multiplies what a method leaves
GAP, PATH, TURN, SLIP = "touches the support", "velocity is the slope of the path", "orientation turns as Ω", "no slip"
ACCELERATION, TURNING = "law of motion, acceleration", "law of motion, angular acceleration"


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


@dataclass(frozen=True)
class Series:
    """One residual over time beside its bound.

    Parameters
    ----------
    name : str
        Of the check.
    time : array (m,)
        s.
    residual : array (m, c)
        As vectors.
    size : float
        Beside which a residual is small or not: the shares are shares of it.
    bound : array (m,)
        The longest vector allowed.
    asked : float
        The part of the bound that the tolerance makes; the rest is what the data themselves leave open.
    note : str
        How it was measured.

    Examples
    --------
    >>> one = Series("no slip", np.arange(2.0), np.array([[0.0], [0.5]]), 1.0, np.array([0.25, 0.25]), 0.1, "")
    >>> float(one.worst), one.share, one.first_failure
    (2.0, 0.5, 1.0)
    """

    name: str
    time: Array
    residual: Array
    size: float
    bound: Array
    asked: float
    note: str

    @property
    def length(self) -> Array:
        """The residual's length at each instant."""
        return np.asarray(np.linalg.norm(self.residual, axis=1), dtype=float)

    @property
    def ratio(self) -> Array:
        """The residual over its bound."""
        return self.length / self.bound

    @property
    def worst(self) -> float:
        """The largest residual over its bound."""
        return float(self.ratio.max())

    @property
    def share(self) -> float:
        """The residual as a share of the size, where it is worst against its bound."""
        return float(self.length[np.argmax(self.ratio)] / self.size)

    @property
    def allowed(self) -> float:
        """The bound as a share of the size, at the same instant."""
        return float(self.bound[np.argmax(self.ratio)] / self.size)

    @property
    def first_failure(self) -> float | None:
        """The first instant at which the bound is exceeded, s."""
        over = np.flatnonzero(self.ratio > 1)
        return float(self.time[over[0]]) if over.size else None


Law = Callable[[RollingSystem, Motion], tuple[Array, Array]]


def independent_law(system: RollingSystem, at: Motion) -> tuple[Array, Array]:
    """Return V̇ and Ω̇ from Newton, Euler and the differentiated constraint as one 9×9 system; T2 is not used.

    Parameters
    ----------
    system : RollingSystem
        Body, support and loads.
    at : Motion
        The states.

    Returns
    -------
    acceleration, angular_acceleration : array (m, 3)
        m/s² and rad/s².
    """
    slip = Vector.of(at.slip)
    Omega, V = Vector.of(at.angular_velocity), Vector.of(at.velocity)
    p_rate, rho_rate = (np.broadcast_to(v.array(), at.position.shape) for v in at.contact.rates(slip, Omega, V))
    F, K, J, gyroscopic, u_rate = applied(system, at.samples(), p_rate)
    constraint = u_rate - np.cross(at.angular_velocity, rho_rate)
    V_rate, Omega_rate, _ = newton_euler(float(system.body.mass), J, at.offset, F, K - gyroscopic, constraint)
    return V_rate, Omega_rate


def eliminated_law(system: RollingSystem, at: Motion) -> tuple[Array, Array]:
    """Return V̇ and Ω̇ from T2 and T3, for systems that leave a term out: the 9×9 route knows all terms.

    Parameters
    ----------
    system, at
        As for `independent_law`.

    Returns
    -------
    acceleration, angular_acceleration : array (m, 3)
        m/s² and rad/s².
    """
    q, Omega = Quaternion.of(at.orientation), Vector.of(at.angular_velocity)
    now = roll(system, at.time, at.contact.point, q, Omega)
    state = BodyMotion(at.time, system.body.mass, now.contact.centre, now.velocity, q, Omega)
    V_rate = (now.reaction + system.loads_on(state)[0]) / system.body.mass
    shape = at.position.shape
    return np.broadcast_to(V_rate.array(), shape), np.broadcast_to(now.angular_acceleration.array(), shape)


def motion_of(system: RollingSystem, theirs: Theirs, start: State | None = None, instants: int = _INSTANTS) -> Motion:
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
        Omega_error = (V_error + float(np.abs(_rate(system))) * position_error) / np.linalg.norm(rho, axis=1)
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


def _rate(system: RollingSystem) -> float:
    """Return the support's rate, or the largest of its first instants', rad/s."""
    rate = system.support.motion.steady_rate
    if rate is not None:
        return float(rate)
    return max(float(system.support.motion.at(t).angular_velocity.norm()) for t in (0.0, 0.3, 0.7))


def examine(
    system: RollingSystem,
    theirs: Theirs,
    tolerance: float,
    start: State | None = None,
    law: Law = independent_law,
    instants: int = _INSTANTS,
) -> tuple[dict[str, Series], Motion]:
    """Compare their motion with contact, constraint and law.

    Parameters
    ----------
    system : RollingSystem
        What is said to move.
    theirs : Theirs
        Their samples, checked.
    tolerance : float
        To which they are held, as a share; the data's own noise and spacing may ask for more room.
    start : State, optional
        As for `motion_of`.
    law : callable
        Gives the accelerations.
    instants : int
        How many at most.

    Returns
    -------
    series : dict from str to Series
        By name.
    motion : Motion
        That they are of.
    """
    at = motion_of(system, theirs, start, instants)
    arm = float(np.linalg.norm(at.offset, axis=1).max())
    speed = _largest(at.velocity, np.cross(at.angular_velocity, at.offset), at.carried)
    rate = _rate(system)
    found: list[Series] = []

    def add(name: str, residual: Array, size: float, error: Array, times: float, note: str) -> None:
        residual = residual if residual.ndim == 2 else residual[:, None]
        asked = times * tolerance * size
        found.append(Series(name, at.time, residual, size, asked + error, asked, note))

    if theirs.height_given:
        add(GAP, gap_of(system, at.contact), arm, at.position_error, 1.0, "gap, share of the radius")
    if theirs.velocity is not None:
        slope = theirs.slope("position", at.index)
        error = slope.error + at.velocity_error
        add(PATH, slope.values - at.velocity, speed, error, 1.0, "share of the speed")
    if theirs.orientation is not None and theirs.angular_velocity is not None and theirs.doubt is None:
        turned, error, _ = turning_of(theirs, at.index)
        size = _largest(at.angular_velocity, turned)
        error = error + at.angular_velocity_error
        add(TURN, turned - at.angular_velocity, size, error, 1.0, "2 q̇ q* against Ω, share of Ω")
    if at.turning_known:
        error = at.velocity_error + arm * at.angular_velocity_error + rate * at.position_error
        add(SLIP, at.slip, speed, error, 1.0, "|V + Ω×ρ − u| over the speed")
    V_rate, Omega_rate = law(system, at)
    simple = system.body.is_isotropic_sphere and isinstance(system.support.surface, Plane)
    quick = rate if simple else rate + _largest(at.angular_velocity)
    weight = 1e-3 * float(np.max(Vector(*system.weight.acceleration).norm()))
    size = max(_largest(at.acceleration, V_rate), 1e-2 * rate * speed, weight)
    passed_on = quick * (at.velocity_error + arm * at.angular_velocity_error)
    note = "Newton, Euler and constraint as one 9×9 system"
    add(ACCELERATION, at.acceleration - V_rate, size, at.acceleration_error + passed_on, LAW_SHARE, note)
    if at.turning_known:
        size = max(size / arm, _largest(at.angular_acceleration, Omega_rate))
        error = at.angular_acceleration_error + passed_on / arm
        add(TURNING, at.angular_acceleration - Omega_rate, size, error, LAW_SHARE, note)
    return {series.name: series for series in found}, at


def _largest(*arrays: Any) -> float:
    return max(1e-300, *(float(np.linalg.norm(array, axis=1).max()) for array in arrays))
