"""The derivatives of all that is sampled, from the state of a law and how it changes with the parameters."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.duals import slopes_of, unstacked
from ...mechanics.system import RollingSystem
from ...solve.laws import Law
from ...solve.samples import FLIGHT, Array

Slopes = dict[str, Array]  # of each quantity, (n, components, parameters)


def slopes_of_samples(system: RollingSystem, law: Law, time: Array, states: Array, count: int) -> Slopes:
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

    Returns
    -------
    dict of array
        (n, components, parameters), by the names of a trajectory's variables.
    """
    size = states.shape[1] // (1 + count)
    state: Any = unstacked(list(states.T), size)
    state[3:7] = Quaternion(*state[3:7]).unit
    with np.errstate(all="ignore"):  # a slope that there is not is no number
        found = _quantities(system, law, time, state)
        return {name: _array(parts, time.size, count) for name, parts in found.items()}


def _quantities(system: RollingSystem, law: Law, time: Any, state: Any) -> dict[str, Any]:
    """Return what is sampled, in duals."""
    p, q, _, rest, coordinates = law.split(state)
    motion = law.motion(system, time, state)
    contact = law._contact(system, time, p, q, rest, coordinates)
    r, V, Omega, point = motion.position, motion.velocity, motion.angular_velocity, contact.point
    slip = V + Omega.cross(point - r) - contact.support.material_velocity(point)
    return {
        "position": r,
        "contact": point,
        "velocity": V,
        "angular_velocity": Omega,
        "contact_force": law.contact_force(system, time, state),
        "slip_velocity": slip * np.nan if law.code == FLIGHT else slip,
        "orientation": q,
        "support": coordinates,
    }


def _array(parts: Vector | Quaternion | tuple[Any, ...], samples: int, count: int) -> Array:
    """Return the slopes of some duals as one array (samples, parts, parameters)."""
    duals = list(parts)
    slopes = np.empty((samples, len(duals), count))
    for i, dual in enumerate(duals):
        for j, slope in enumerate(slopes_of(dual, count)):
            slopes[:, i, j] = slope
    return slopes
