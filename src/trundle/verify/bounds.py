"""How much a figure of the card may be: the tolerances, and the sizes against which a difference is small or not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import contact_at
from ..mechanics.loads import Load
from ..mechanics.system import RollingSystem
from ..solve.methods import Method
from ..solve.samples import FLIGHT, Samples

Array = NDArray[np.float64]

# The two tolerances of a card, as shares: what rounding may do, and how many times the tolerance asked a method may
# be off (more after a thousand radians of turning, for what adds up over a run).
EXACT, SOLVER = 1e-12, 1e3
A_ROUNDING = 2.0**-52
A_STEP = 10.0  # times its tolerance that a method may err in a step
_SLOW = 1e-3  # of a body's turning: what a support's own is held against at least
SINGULAR = ("curved", "edge")  # ends of a run at which its law is singular


def bound_of(method: Method, turned: float = 1.0) -> float:
    """Return the share that a method may be off after the body has turned by so many radians."""
    return max(EXACT, SOLVER * method.tolerance * max(1.0, turned / SOLVER))


def turned_in(samples: Samples) -> float:
    """Return about how many radians the body turned."""
    return largest(samples.angular_velocity) * float(samples.time[-1] - samples.time[0])


def largest(array: Array) -> float:
    """Return the length of the longest of many vectors."""
    return float(np.linalg.norm(array, axis=-1).max())


def blur_of(system: RollingSystem, at: Samples) -> float:
    """Return by how much rounding of the orientation may move ρ, m: the body's largest radius of curvature takes part.

    Where a body all but lies flat that is a million times its size.
    """
    touching = at.part(at.phase != FLIGHT)
    if not touching.time.size:
        return 0.0
    place = Vector.of(touching.contact), Quaternion.of(touching.orientation)
    contact = contact_at(system, touching.time, *place, touching.support_columns)
    return A_ROUNDING * float(np.abs(contact.inverse_curvature.trace).max())


def speed_of(system: RollingSystem, at: Samples) -> float:
    """Return the largest of V, Ω×ρ and u: any of them may be the small difference of two large ones."""
    return max(float(np.max(speed.norm())) for speed in at.speeds(system))


def sizes_of(system: RollingSystem, at: Samples) -> dict[str, float]:
    """Return against what a difference of position, velocity, Ω and contact force is small or not.

    The contact force may be the small difference of what turns the body's centre and its contact, and of the loads.
    """
    arm, turning = largest(at.contact - at.position), largest(at.angular_velocity)
    fastest = max(speed_of(system, at), arm * turning)
    loads = np.broadcast_to(system.loads_on(at.motion(system))[0].array(), at.position.shape)
    force = max(largest(at.contact_force), float(system.body.mass) * turning * fastest, largest(loads))
    sizes = {"position": largest(at.position), "velocity": fastest, "angular_velocity": fastest / arm}
    return sizes | {"contact_force": force}


def own_sizes(system: RollingSystem, at: Samples, sizes: dict[str, float]) -> Array:
    """Return against what each of the support's own angle and rate is small or not, also where only rounding moves it.

    A step's error is a share of the largest numbers of the state: |q| is 1, and Ω beside a rate.
    """
    least = {"angle": _SLOW, "angular velocity": max(_SLOW * sizes["angular_velocity"], 1e-300)}
    kinds = system.support.motion.coordinate_kinds
    return np.maximum(np.abs(at.support_coordinates).max(axis=0, initial=0.0), [least[kind] for kind in kinds])


def pace_of(system: RollingSystem, at: Samples) -> float:
    """Return the fastest rate in a motion, as its samples show it, 1/s: what a look at its slopes must resolve.

    Samples far apart do not show by their differences how fast the velocity changes; the forces at each of them do,
    but for that at a singular end. The speed there counts: from rest it may be the only one that is not zero.
    """
    varying = [load for load in system.loads if _varies(load)]
    motion, shape = at.motion(system), at.position.shape
    loads = [vector for load in varying for vector in (load.force(motion), load.torque(motion))]
    changing = [at.velocity, at.angular_velocity, *(np.broadcast_to(load.array(), shape) for load in loads)]
    paces = [_pace(at.time, values) for values in changing]
    regular = before_a_singular_end(at)
    applied = system.loads_on(regular.motion(system))[0].array()
    speed = max(largest(at.velocity), 1e-6 * speed_of(system, at))
    if speed > 0:  # what is at rest in all samples stays at rest
        paces.append(largest(regular.contact_force + applied) / (system.body.mass * speed))
    return largest(at.angular_velocity) + float(system.support.motion.fastest_rate) + max(paces)


def before_a_singular_end(samples: Samples) -> Samples:
    """Return a run without the sample at its very end, where its law is singular, and so are rounding and the force.

    By the force alone, a million times that of all others, all windows would be so short that a slope says nothing.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("tilted-turntable").run()
    >>> before_a_singular_end(run.samples).time.size == run.samples.time.size
    True
    """
    last = samples.events[-1] if samples.events else None
    singular = last is not None and last.kind in SINGULAR and samples.time[-1] >= last.time
    return samples.part(slice(0, -1)) if singular and samples.time.size > 1 else samples


def _varies(load: Load) -> bool:
    return not load.constant and load.linear_drag is None


def _pace(time: Array, values: Array) -> float:
    """Return the largest rate of change of a vector over its largest size."""
    size = largest(values)
    if size == 0 or time.size < 2:
        return 0.0
    steps = np.diff(time)[:, None]
    # The last step may be a sliver, at the end of which a rounding looks like a jump.
    real = steps[:, 0] > 1e-6 * steps.max()
    return largest(np.diff(values, axis=0)[real] / steps[real]) / size
