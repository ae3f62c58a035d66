"""The motion of somebody else against contact, constraint and law, instant by instant, each with its own bound."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import roll
from ..mechanics.surfaces import Plane
from ..mechanics.system import RollingSystem, State
from ..verify.law import applied, newton_euler
from .motion import INSTANTS, Motion, motion_of, rate_of, turning_of
from .record import Array, Theirs, gap_of

LAW_SHARE = 10.0  # times the tolerance: an acceleration is a slope, and multiplies what a method leaves
GAP, PATH, TURN, SLIP = "touches the support", "velocity is the slope of the path", "orientation turns as Ω", "no slip"
ACCELERATION, TURNING = "law of motion, acceleration", "law of motion, angular acceleration"


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
    samples = at.samples()
    F, K, J, gyroscopic, u_rate = applied(system, samples, p_rate)
    constraint = u_rate - np.cross(at.angular_velocity, rho_rate)

    def solved(moment: Array) -> tuple[Array, Array, Array]:
        return newton_euler(float(system.body.mass), J, at.offset, F, moment - gyroscopic, constraint)

    V_rate, Omega_rate, R = solved(K)
    acting = system.acting_on(samples.motion(system))
    if not acting.has_couple:
        return V_rate, Omega_rate
    # A couple that grows with N: all is linear in it, and N = n·R closes the circle.
    V_more, Omega_more, R_more = solved(K + np.broadcast_to(acting.couple.array(), K.shape))
    n = samples.normals(system)
    N = (n * R).sum(axis=1) / (1.0 - (n * (R_more - R)).sum(axis=1))
    return V_rate + N[:, None] * (V_more - V_rate), Omega_rate + N[:, None] * (Omega_more - Omega_rate)


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
    state = now.contact.body_motion(system.body.mass, at.time, now.velocity, q, Omega)
    V_rate = (now.reaction + system.loads_on(state)[0]) / system.body.mass
    shape = at.position.shape
    return np.broadcast_to(V_rate.array(), shape), np.broadcast_to(now.angular_acceleration.array(), shape)


def examine(
    system: RollingSystem,
    theirs: Theirs,
    tolerance: float,
    start: State | None = None,
    law: Law = independent_law,
    instants: int = INSTANTS,
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
    rate = rate_of(system)
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
