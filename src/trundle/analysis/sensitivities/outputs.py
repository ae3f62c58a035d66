"""The derivatives of all that is sampled, from the state of a law and how it changes with the parameters."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.duals import Dual, gathered, slopes_of
from ...mechanics.system import RollingSystem
from ...solve.laws import Law
from ...solve.samples import FLIGHT, Array

Slopes = dict[str, Array]  # of each quantity, (n, components, parameters)


def slopes_of_samples(
    system: RollingSystem, law: Law, time: Array, states: Array, count: int, of_motion: bool = False
) -> Slopes:
    """Return the derivatives of all sampled quantities, given states stacked with their own.

    Parameters
    ----------
    system : RollingSystem
        In duals.
    law : Law
        Of the phase.
    time : array (n,)
        s.
    states : array (n, size · (1 + parameters))
        As `VariationalLaw` has them.
    count : int
        How many parameters there are.
    of_motion : bool
        Whether the motion alone is asked for: no contact, no force, no slip.

    Returns
    -------
    dict of array
        (n, components, parameters), by the names of a trajectory's variables.
    """
    size = states.shape[1] // (1 + count)
    parts = states.T.reshape(1 + count, size, -1)
    state: Any = [Dual(parts[0, i], (parts[1:, i],)) for i in range(size)]  # all slopes at once
    state[3:7] = Quaternion(*state[3:7]).unit
    system = gathered(system)
    with np.errstate(all="ignore"):  # a slope that there is not is no number
        return stacked_slopes((_motion if of_motion else _quantities)(system, law, time, state), time.size, count)


def stacked_slopes(found: dict[str, Any], samples: int, count: int) -> Slopes:
    """Return the slopes of each quantity as an array."""
    return {
        name: np.full((samples, 3, count), np.nan) if parts is None else _array(parts, samples, count)
        for name, parts in found.items()
    }


def _motion(system: RollingSystem, law: Law, time: Any, state: Any) -> dict[str, Any]:
    """Return where the body is and how it moves, in duals, from a state."""
    motion = law.motion(system, time, state)
    _, q, _, _, coordinates = law.split(state)
    return {
        "position": motion.position,
        "velocity": motion.velocity,
        "angular_velocity": motion.angular_velocity,
        "orientation": q,
        "support": coordinates,
    }


def _quantities(system: RollingSystem, law: Law, time: Any, state: Any) -> dict[str, Any]:
    """Return what is sampled, in duals, from a state."""
    p, q, _, rest, coordinates = law.split(state)
    motion = law.motion(system, time, state)
    contact = law._contact(system, time, p, q, rest, coordinates)
    r, V, Omega, point = motion.position, motion.velocity, motion.angular_velocity, contact.point
    u, R = contact.support.material_velocity(point), law.reaction(system, time, state)
    return sampled(law, r, V, Omega, R, q, point, u, coordinates)


def sampled(
    law: Law,
    r: Vector,
    V: Vector,
    Omega: Vector,
    R: Vector,
    q: Quaternion,
    point: Vector,
    u: Vector,
    coordinates: tuple[Any, ...],
) -> dict[str, Any]:
    """Return what is sampled by its names, with the slip V + Ω×ρ − u; in flight there is none."""
    slip = V + Omega.cross(point - r) - u
    return {
        "position": r,
        "contact": point,
        "velocity": V,
        "angular_velocity": Omega,
        "contact_force": R,
        "slip_velocity": None if law.code == FLIGHT else slip,
        "orientation": q,
        "support": coordinates,
    }


def _array(parts: Vector | Quaternion | tuple[Any, ...], samples: int, count: int) -> Array:
    """Return the slopes of some duals as one array (samples, parts, parameters)."""
    duals = list(parts)
    slopes = np.empty((samples, len(duals), count))
    for i, dual in enumerate(duals):
        known = slopes_of(dual, count)
        for j, slope in enumerate(np.broadcast_to(known[0], (count, samples)) if len(known) < count else known):
            slopes[:, i, j] = slope
    return slopes
