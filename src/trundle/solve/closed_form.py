"""The closed forms of `exact` as a method: states at given times, orientation, and the instant at the rim."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ..errors import OutOfDomainError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import touch
from ..mechanics.system import RollingSystem, State
from .exact import CLOSED_FORMS, ClosedForm, SphereOnPlane, closed_form
from .monodromy import Monodromy
from .orientation import orientation, periodic_orientation
from .phases import end as end_event
from .samples import Array, Progress, Samples

_PHASE_A_STEP = 0.05  # rad of the motion's own phase between looks at the rim
_LOOKS_AT_ONCE = 100_000
_PERIODS_WORTH_A_MONODROMY = 2.0


def solve(
    system: RollingSystem, start: State, times: Array, tolerance: float = 0.0, progress: Progress | None = None
) -> Samples:
    """Evaluate the closed form at the given times; a rim ends the run at the located instant.

    Parameters
    ----------
    system, start, times, progress
        As for `trundle.solve.taylor.solve`.
    tolerance : float
        Not used: the closed form is as exact as its numbers.

    Returns
    -------
    Samples
        At `times`, cut at the rim where it is reached.

    Raises
    ------
    OutOfDomainError
        If no closed form covers the system.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
    >>> solve(system, system.place((0.1, 0.0)), np.array([0.0, 9.0])).position.tolist()
    [[0.1, 0.0, 0.025], [0.1, 0.0, 0.025]]
    """
    del tolerance
    motion = closed_form(system, start)
    if motion is None:
        refusals = " ".join(form.refusal(system, start) for form in CLOSED_FORMS)
        raise OutOfDomainError(f'{refusals} Use method="taylor" or method="runge-kutta".')
    end = _first_exit(motion, system.support.surface.rim, float(times[-1]) - start.time)
    if end is not None:
        times = np.append(times[times < start.time + end], start.time + end)
    samples = _evaluate(system, motion, start, times, progress)
    return samples if end is None else samples.ended(end_event(system, "rim", samples.state(-1)))


def _evaluate(
    system: RollingSystem, motion: ClosedForm, start: State, times: Array, progress: Progress | None
) -> Samples:
    shape = (times.size, 3)
    position, velocity, turning, force = (np.empty(shape) for _ in range(4))
    for first in range(0, times.size, _LOOKS_AT_ONCE):
        part = slice(first, first + _LOOKS_AT_ONCE)
        parts = motion.motion_at(times[part] - start.time)
        for array, vector in zip((position, velocity, turning, force), parts, strict=True):
            array[part] = vector.array()
        if progress is not None:
            progress(0.5 * min(1.0, (first + _LOOKS_AT_ONCE) / times.size))
    q = orientations(motion, start, times)
    own = _own(system, motion, start, times)
    contact = position + touch(system, times, Vector.of(position), Quaternion.of(q), tuple(own.T)).offset.array()
    if progress is not None:
        progress(1.0)
    return Samples(times, position, contact, velocity, turning, q, force, own=own)


def _own(system: RollingSystem, motion: ClosedForm, start: State, times: Array) -> Array:
    """Return the coordinates of the support's own motion, (n, k)."""
    if not system.support.motion.own:
        return np.zeros((times.size, 0))
    gone = np.stack([np.broadcast_to(part, times.shape) for part in motion.own_at(times - start.time)], axis=1)
    return np.asarray(start.support) + gone


def orientations(motion: ClosedForm, start: State, times: Array) -> Array:
    """Return the orientation at given times; where the motion repeats, any time costs what one circle costs.

    Parameters
    ----------
    motion : ClosedForm
        The motion.
    start : State
        Where it starts.
    times : array (n,)
        Ascending, s.

    Returns
    -------
    array (n, 4)
        Unit quaternions (w, x, y, z), body frame to support frame.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
    >>> start = system.place((0.1, 0.0), (0.0, 0.2))
    >>> orientations(SphereOnPlane.of(system, start), start, np.array([0.0]))[0].tolist()
    [1.0, 0.0, 0.0, 0.0]
    """
    straight = motion.straight_turn(times - start.time)
    if straight is not None:
        axis, angle = straight
        half = np.broadcast_to(0.5 * np.asarray(angle), times.shape)
        turn = Quaternion(np.cos(half), *(axis * np.sin(half)))
        return (turn * Quaternion(*start.orientation)).array()

    def angular_velocity(t: Array) -> Array:
        Omega = motion.motion_at(t)[2]
        return np.stack(np.broadcast_arrays(Omega.x, Omega.y, Omega.z, t))[:3]

    def absolute(t: Array) -> Array:
        return angular_velocity(t - start.time)

    long = times[-1] - start.time > _PERIODS_WORTH_A_MONODROMY * motion.period
    if long and isinstance(motion, SphereOnPlane) and motion.torque[2] == 0:
        return periodic_orientation(angular_velocity, _monodromy(motion), times, start.orientation, start.time)
    return orientation(absolute, times, start.orientation, start.time)


def _monodromy(motion: SphereOnPlane) -> Monodromy:
    """Work out the rotation over one circle from numbers that start exact: a Ω = ω ζ_c + (ω − κ)(ζ − ζ_c)."""
    import mpmath

    with mpmath.workdps(40):
        number = mpmath.mpf
        precise = replace(
            motion,
            radius=number(motion.radius),
            mass=number(motion.mass),
            inertia_ratio=number(motion.inertia_ratio),
            rate=number(motion.rate),
            position=tuple(number(part) for part in motion.position),
            velocity=tuple(number(part) for part in motion.velocity),
        )
        centre = mpmath.mpc(*precise.guiding_centre(0))
        arm = mpmath.mpc(*precise.position) - centre
        turning = (precise.rate - precise.kappa) * arm / precise.radius
        return Monodromy.of_turning_vector(precise.rate * centre / precise.radius, turning, motion.spin, precise.kappa)


def _first_exit(motion: Any, rim: float | None, duration: float) -> float | None:
    """Return the first time at which the contact reaches the rim, if it does within the run."""
    if rim is None or duration <= 0:
        return None
    duration = min(duration, 1.01 * motion.period)
    phase_rate = float(np.hypot(motion.kappa, motion.gamma))
    looks = int(max(256, np.ceil(duration * phase_rate / _PHASE_A_STEP))) + 1

    def excess(t: Any) -> Any:
        r = motion.position_at(t)
        return r.x * r.x + r.y * r.y - rim * rim

    def growth(t: Any) -> Any:
        r, V, *_ = motion.motion_at(t)
        return Vector(r.x, r.y, 0.0).dot(V)

    for first in range(0, looks - 1, _LOOKS_AT_ONCE):
        index = np.arange(first, min(first + _LOOKS_AT_ONCE, looks - 1) + 1)
        step = duration / (looks - 1)
        t = index * step
        over, rate = (np.broadcast_to(value, t.shape) for value in (excess(t), growth(t)))
        out, rising = over >= 0, rate > 0
        # A maximum between two looks, both inside, that may reach the rim: r² gains 2 r·ṙ, which falls to 0 meanwhile.
        near = over[:-1] + 4 * step * (np.abs(rate[:-1]) + np.abs(rate[1:])) >= 0
        peaks = rising[:-1] & ~rising[1:] & ~out[1:] & near
        for j in np.flatnonzero(peaks | out[1:]):
            begin, end = float(t[j]), float(t[j + 1])
            if not out[j + 1]:
                end = _root(growth, begin, end)
                if excess(end) < 0:
                    continue
            return _root(excess, begin, end)
    return None


def _root(function: Any, begin: float, end: float) -> float:
    from scipy.optimize import brentq

    return float(brentq(function, begin, end, xtol=1e-300, rtol=4 * np.finfo(float).eps))
