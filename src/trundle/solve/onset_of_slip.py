"""How slipping begins: its first moment is integrated by hand, since its direction settles too fast to be followed."""

from __future__ import annotations

import math
from typing import Any

from ..errors import SolverError
from ..mechanics.algebra import E_X, E_Y, E_Z, ZERO, Matrix, Vector
from ..mechanics.contact import roll
from ..mechanics.impact import response
from ..mechanics.onset import onset
from ..mechanics.slipping import slip
from ..mechanics.system import RollingSystem
from .laws import RollingLaw
from .touch import Touch, floats

_FIRST = 1e-6  # share of |ρ| over that speed that slip takes to begin, at least, and a thousand times that at most
_SETTLED_IN = 2e3  # how much faster its direction settles than it grows once it has begun
_JUST = 1e-8  # share of friction below which what it cannot give has no direction yet


def first_moment(system: RollingSystem, at: Touch, needed: Vector) -> tuple[Touch, tuple[float, ...]]:
    """Return a body that has slipped for a moment, in which it still rolled but for what friction could not give.

    What it cannot give grows from nothing, mostly, and so the slip is the integral of a slope. Its direction would
    settle so fast at first that no method could follow.

    Parameters
    ----------
    system : RollingSystem
        Body, and a support with friction.
    at : Touch
        Where rolling gives way.
    needed : Vector
        The friction that rolling would take, N.

    Returns
    -------
    (Touch, tuple of float)
        The body a little later, and the numbers that the stops of `SlippingLaw` take.

    Raises
    ------
    SolverError
        If friction jams the body.

    Examples
    --------
    >>> import trundle as tr
    >>> slope = tr.Support(tr.Plane(), tilt=1.0, friction=0.1)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), slope)
    >>> at = Touch.of(system, system.place())
    >>> later, _ = first_moment(system, at, _friction(system, at))
    >>> later.state.time < 1e-6 and later.V.x > 0
    True
    """
    time, numbers = at.state.time, RollingLaw().numbers(at)
    begun = _way(system, at, needed)[1]

    def later(wait: float) -> tuple[Touch, Vector, float]:
        moved = RollingLaw().advanced(system, time, numbers, wait)
        then = RollingLaw().meant(system, time + wait, moved)
        return (then, *_way(system, then, _friction(system, then)))

    trial = _FIRST * at.arm / at.scale(system)
    growth = max((later(trial)[2] - begun) / trial, 1e-300)
    J = system.body.inertia_in_space(at.orientation.matrix())
    settling = needed.norm() * response(system, at.contact, J, needed / needed.norm()).norm()
    wait = trial if begun > 0 else min(max(settling / (_SETTLED_IN * growth), trial), 1000 * trial)
    (_, _, halfway), (then, hat, speed) = later(0.5 * wait), later(wait)
    slip = hat * (wait * (begun + 4 * halfway + speed) / 6)
    near = min((0.25 * slip.norm()) ** 2, at.still(system) ** 2)
    return _pushed(system, then, slip), (near, *floats(hat))


def _friction(system: RollingSystem, at: Touch) -> Vector:
    """Return the friction that rolling takes."""
    state, n = at.state, at.contact.normal
    R = roll(system, state.time, at.contact.point, at.orientation, at.Omega, state.support).reaction
    return R - n * n.dot(R)


def _pushed(system: RollingSystem, at: Touch, slip: Vector) -> Touch:
    """Return the body after the impulse at the contact that makes it slip so."""
    J = system.body.inertia_in_space(at.orientation.matrix())
    P = Matrix(*(response(system, at.contact, J, e) for e in (E_X, E_Y, E_Z))).transpose.solve(slip)
    own = at.state.support
    if system.support.motion.free:
        own = (
            *own[:-1],
            own[-1] - float(at.contact.support.lever(at.contact.point).dot(P) / system.support.motion.inertia),
        )
    return at.moving(system, at.V + P / system.body.mass, at.Omega + J.solve(at.contact.offset.cross(P)), own)


def _way(system: RollingSystem, at: Touch, needed: Vector) -> tuple[Vector, float]:
    """Return the direction ŝ in which slip grows along ŝ when friction acts against it, and how fast, m/s²."""
    first = needed / -needed.norm()
    second = at.contact.normal.cross(first)

    def grows(c: Any, s: Any) -> tuple[Any, Any]:
        own, hat = at.state.support, first * c + second * s
        rate = slip(system, at.state.time, at.contact.point, at.orientation, at.Omega, ZERO, own, hat).slip_rate
        return rate.dot(first), rate.dot(second)

    if math.hypot(*grows(1.0, 0.0)) <= _JUST * needed.norm() / system.body.mass:  # it gives way just now
        return first, 0.0
    found = onset(grows)
    if found is None:
        raise SolverError(
            f"At t = {at.state.time:.9g} s the body can neither roll nor slip any way (friction jams it: Painlevé's "
            "paradox of rigid contact). Use less friction."
        )
    speed, (c, s) = found
    return first * c + second * s, speed
