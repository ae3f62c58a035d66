"""What every method returns: the states at the instants asked for, and how the run ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import normal_at, roll
from ..mechanics.loads import BodyMotion
from ..mechanics.system import RollingSystem, State

Array = NDArray[np.float64]
Progress = Callable[[float], None]  # told the fraction done, 0 to 1


@dataclass(frozen=True)
class Event:
    """Something that happened at one instant of a run.

    Parameters
    ----------
    time : float
        s.
    kind : str
        ``"rim"``: the contact reached the rim, and the run ended.
    text : str
        What happened, for the reader.

    Examples
    --------
    >>> Event(1.5, "rim", "ran off the rim").kind
    'rim'
    """

    time: float
    kind: str
    text: str


@dataclass(frozen=True)
class Samples:
    """States of one body at ascending instants, in the inertial support frame; arrays (n,), (n, 3) and (n, 4).

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> still = Samples.of_contact(system, np.zeros(1), np.zeros((1, 3)), np.array([[1.0, 0, 0, 0]]), np.zeros((1, 3)))
    >>> still.contact_force.tolist()
    [[0.0, 0.0, 9.80665]]
    """

    time: Array
    position: Array
    contact: Array
    velocity: Array
    angular_velocity: Array
    orientation: Array
    contact_force: Array
    events: tuple[Event, ...] = ()

    @staticmethod
    def of_contact(
        system: RollingSystem, time: Array, point: Array, orientation: Array, angular_velocity: Array
    ) -> Samples:
        """Complete contact point, orientation and Ω to a full record by the rolling law."""
        q = orientation / np.linalg.norm(orientation, axis=-1, keepdims=True)
        now = roll(system, time, Vector.of(point), Quaternion.of(q), Vector.of(angular_velocity))
        full = np.broadcast_shapes(point.shape, angular_velocity.shape)

        def array(v: Vector) -> Array:
            return np.broadcast_to(v.array(), full).copy()

        return Samples(
            time, array(now.contact.centre), point, array(now.velocity), angular_velocity, q, array(now.reaction) + 0.0
        )

    def motion(self, system: RollingSystem) -> BodyMotion:
        """Return the motion that loads and integrals take, with arrays as components."""
        return BodyMotion(
            self.time,
            system.body.mass,
            Vector.of(self.position),
            Vector.of(self.velocity),
            Quaternion.of(self.orientation),
            Vector.of(self.angular_velocity),
        )

    def speeds(self, system: RollingSystem) -> tuple[Vector, Vector, Vector]:
        """Return V, Ω×ρ and u, m/s, from the samples' own numbers; the slip is s = V + Ω×ρ − u."""
        u = system.support.motion.at(self.time).material_velocity(Vector.of(self.contact))
        rho = Vector.of(self.contact - self.position)
        return Vector.of(self.velocity), Vector.of(self.angular_velocity).cross(rho), u

    def normals(self, system: RollingSystem) -> Array:
        """Return the support's unit normal at each contact (n, 3), from the support into the body."""
        normal = normal_at(system, self.time, Vector.of(self.contact))
        return np.broadcast_to(normal.array(), self.position.shape)

    def ended(self, event: Event) -> Samples:
        """Return the same samples with the event that ended them."""
        return replace(self, events=(*self.events, event))

    def part(self, where: Any) -> Samples:
        """Return some of the samples, chosen as an array is indexed."""
        arrays = {f.name: getattr(self, f.name)[where] for f in fields(self) if f.name != "events"}
        return Samples(**arrays, events=self.events)

    def state(self, index: int) -> State:
        """Return one sample as a state to start from."""

        def row(array: Array) -> Any:
            return tuple(array[index].tolist())

        return State(
            row(self.position),
            row(self.velocity),
            row(self.angular_velocity),
            row(self.orientation),
            float(self.time[index]),
        )


def ran_off(time: float, rim: Any) -> Event:
    """Return the event of a contact that reaches the rim.

    Parameters
    ----------
    time : float
        s.
    rim : float
        Distance of the rim from the axis, m.

    Returns
    -------
    Event
        Of kind "rim".

    Examples
    --------
    >>> ran_off(1.25, 0.5).text
    'ran off the rim (0.5 m from the axis) at t = 1.25 s'
    """
    return Event(time, "rim", f"ran off the rim ({float(rim):g} m from the axis) at t = {time:.9g} s")


def cut(times: Array, states: Array, end: float, last: Array) -> tuple[Array, Array]:
    """Keep the states before an end, and add the state at the end itself.

    Parameters
    ----------
    times : array (n,)
        Ascending, s.
    states : array (n, ...)
        One a time.
    end : float
        s.
    last : array (...)
        The state at the end.

    Returns
    -------
    times, states : array
        The last time is the end.

    Examples
    --------
    >>> cut(np.array([0.0, 1.0, 2.0]), np.zeros((3, 1)), 1.5, np.ones(1))[0].tolist()
    [0.0, 1.0, 1.5]
    """
    before = times < end
    return np.append(times[before], end), np.concatenate([states[before], last[None]])
