"""Starts that differ a little: in every way in which a state can change within its phase."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..mechanics.algebra import E_X, E_Z, Quaternion, Vector
from ..mechanics.contact import Contact
from ..mechanics.nearest import closest_contact
from ..mechanics.placing import SLIP_TOLERANCE, no_gap
from ..mechanics.system import RollingSystem, State


def nudged(system: RollingSystem, start: State, change: float, turn: float, move: float) -> list[State]:
    """Return starts that differ a little in place, orientation or motion, in the phase in which the start finds itself.

    A body that rolls, rolls elsewhere or differently; one that slips, turns and slips differently along the support;
    one that flies, or is about to strike, turns and moves differently. A cylinder changes only what keeps it straight.

    Examples
    --------
    What slips backwards goes on slipping so:

    >>> import trundle as tr
    >>> cloth = tr.Support(tr.Plane(), friction=0.2)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.0286, 0.17), cloth)
    >>> start = system.place(velocity=(2.0, 0.3), angular_velocity=(5.0, -60.0, 20.0))
    >>> found = nudged(system, start, 1e-8, 1e-10, 1e-10)
    >>> len(found), max(abs(state.velocity[0] - 2.0) for state in found) < 1e-9
    (10, True)
    """
    here = _Start.of(system, start)
    n, axis = here.contact.normal, system.body.shape.axis
    e = n.cross(E_X if abs(n.x) < 0.9 else E_Z)
    e = e / e.norm()
    own = here.q.matrix() @ axis if axis is not None else None
    turns = [e, n.cross(e), n] if own is None else [own]
    moves = [e, n.cross(e)] if own is None else [own, n.cross(own)]
    upward = [n] if here.flies else []
    slips = moves + upward if here.flies or here.slides else []
    speed = change * float(here.contact.offset.norm())
    return [
        *(here.changed(turning=way * change) for way in turns),
        *(here.changed(speed=way * speed) for way in slips),
        *(here.changed(turn=way * turn) for way in turns),
        *(here.changed(move=way * move) for way in moves + (upward if here.over > 0 else [])),
        *(here.changed(support=i, by=turn * max(abs(part), 1.0)) for i, part in enumerate(start.support)),
    ]


_NOTHING = Vector(0.0, 0.0, 0.0)


@dataclass(frozen=True)
class _Start:
    """A start, with where it touches or is nearest to the support, and in what phase it is."""

    system: RollingSystem
    state: State
    contact: Contact
    slip: Vector
    over: float
    flies: bool
    slides: bool

    @classmethod
    def of(cls, system: RollingSystem, state: State) -> _Start:
        contact = closest_contact(
            system, state.time, Vector(*state.position), Quaternion(*state.orientation), state.support
        )
        V, Omega, n = Vector(*state.velocity), Vector(*state.angular_velocity), contact.normal
        slip = contact.slip_velocity(V, Omega)
        over = float((Vector(*state.position) + contact.offset - contact.point).dot(n))
        off = float(slip.dot(n))
        speed = SLIP_TOLERANCE * max(float(part.norm()) for part in (V, Omega.cross(contact.offset), V - slip))
        over = over if over > no_gap(contact, state.position) else 0.0
        slides = system.support.friction is not None and float((slip - n * off).norm()) > speed
        return cls(system, state, contact, slip, over, over > 0 or abs(off) > speed, slides)

    @property
    def q(self) -> Quaternion:
        return Quaternion(*self.state.orientation)

    def changed(
        self,
        turning: Vector = _NOTHING,
        speed: Vector = _NOTHING,
        turn: Vector = _NOTHING,
        move: Vector = _NOTHING,
        support: int = -1,
        by: float = 0.0,
    ) -> State:
        """Return a state changed in Ω, V, orientation, place or the support's own motion that keeps the phase."""
        coordinates = tuple(part + by * (i == support) for i, part in enumerate(self.state.support))
        q = Quaternion(1.0, *(turn * 0.5)) * self.q
        q = Quaternion(*(part / math.hypot(*q) for part in q))
        there = closest_contact(self.system, self.state.time, Vector(*self.state.position) + move, q, coordinates)
        n, Omega = there.normal, Vector(*self.state.angular_velocity) + turning
        rises = float(move.dot(n)) if self.over > 0 else 0.0
        centre = there.centre + n * (self.over + rises)
        if self.flies:  # what turns about its contact while it strikes, goes on to strike
            V = Vector(*self.state.velocity) + speed
        else:
            slip = self.slip + speed if self.slides else _NOTHING
            V = there.rolling_velocity(Omega) + slip - n * slip.dot(n)
        return replace(
            self.state,
            position=_floats(centre),
            velocity=_floats(V),
            angular_velocity=_floats(Omega),
            orientation=(float(q.w), float(q.x), float(q.y), float(q.z)),
            support=coordinates,
        )


def _floats(v: Vector) -> tuple[float, float, float]:
    x, y, z = map(float, v)
    return x, y, z
