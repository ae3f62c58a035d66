"""How slipping begins: its first moment is worked out by hand, since it grows from nothing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from ..errors import SolverError
from ..mechanics.algebra import E_X, E_Y, E_Z, ZERO, Matrix, Vector
from ..mechanics.contact import Contact, Rolling, roll
from ..mechanics.creep import SlipRates, slip_rates
from ..mechanics.duals import has_duals, values_of
from ..mechanics.onset import onset
from ..mechanics.scalars import as_float
from ..mechanics.slipping import HeldInertia, Response, response
from ..mechanics.system import RollingSystem
from .contact_state import WEIGHTLESS, ContactState, floats
from .creeping import SEEN, SETTLES_FAST, CreepingLaw
from .laws import Held, Law, RestingLaw, RollingLaw, SlippingLaw
from .samples import RESTING
from .tracing import python_law

_FIRST = 1e-6  # share of the time in which the motion changes that the first moment of slip takes
_ROLLED = 10 * _FIRST**2  # share of the forces at hand that rolling in that moment takes off N, where it is none


@dataclass(frozen=True)
class Onset:
    """A body that has slipped for a moment: where it is, the law that it follows, what its event functions take."""

    at: ContactState
    law: Callable[..., SlippingLaw]  # as `SlippingLaw` is made
    direction: Vector
    ending: tuple[float, ...]


def slip_onset(system: RollingSystem, at: ContactState, law: Law | None = None) -> Onset | ContactState | None:
    """Return a body that has slipped for a moment, in which it still rolled but for what friction could not give.

    What it cannot give grows from nothing, mostly, and so the slip is the integral of a slope. Where friction settles
    the direction of so small a slip at once, its speed alone is followed until it has grown.

    Examples
    --------
    >>> import trundle as tr
    >>> slope = tr.Support(tr.Plane(), tilt=1.0, friction=0.1)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), slope)
    >>> begun = slip_onset(system, ContactState.of(system, system.place()))
    >>> begun.at.state.time < 1e-6 and begun.at.V.x > 0
    True
    """
    law = RollingLaw() if law is None else law
    time, numbers = at.state.time, law.state_vector(at)
    rates = python_law(system, law, time=time, state=numbers).rates
    moment = _FIRST * law.moment(system, at, rates(time, numbers))

    def later(wait: float) -> tuple[ContactState, _Growth | None]:
        moved = law.rk4_step(system, time, numbers, wait, rates)
        then = law.unpack(system, time + wait, moved)
        return then, _growth(system, then, law, _ROLLED)

    begun, (_, halfway), (then, grown) = _growth(system, at, law), later(0.5 * moment), later(moment)
    if grown is None or halfway is None:
        return then if _holds(system, then, law) else None
    speed = moment * ((0.0 if begun is None else begun.rate) + 4 * halfway.rate + grown.rate) / 6
    hat = grown.direction
    slipping = _pushed(system, then, hat * speed, law)
    creeping = partial(CreepingLaw, step=SEEN / _FIRST * moment, since=time, near=floats(hat))
    turning = "held" if law.code == RESTING else "resisted" if system.resisted else "free"  # as it will be followed
    if grown.settling * moment > SETTLES_FAST * speed and creeping(turning=turning).settles(system, slipping):
        return Onset(slipping, creeping, hat, ())
    near = min((0.25 * speed) ** 2, at.still(system) ** 2)
    return Onset(slipping, SlippingLaw, hat, (near, *floats(hat)))


def jammed(time: float, share: float = -1.0, opens: bool = False) -> SolverError:
    """Name Painlevé's paradox: rigid contact with so much friction has no motion, or more than one.

    Examples
    --------
    >>> print(jammed(2.5, -0.3, opens=True))
    At t = 2.5 s the body may slip on or come off ...
    """
    if share > 0:
        what = "friction all but jams the body, and presses it on without limit"
    elif opens:
        what = "the body may slip on or come off the support, and the laws of rigid contact do not say which"
    else:
        what = "the body can neither roll, nor slip any way, nor come off the support"
    return SolverError(f"At t = {time:.9g} s {what} (Painlevé's paradox). Use less friction.")


@dataclass(frozen=True)
class _Growth:
    """How slip begins to grow."""

    direction: Vector
    rate: float  # m/s²
    settling: float  # of its direction, times |s|, m/s²


def _growth(system: RollingSystem, at: ContactState, law: Law, floor: float = WEIGHTLESS) -> _Growth | None:
    """Return how slip grows: where friction only just gives way, against the friction that rolling takes.

    The support may seem to pull by a share of the forces at hand.
    """
    state, held, q = at.state, law.code == RESTING, at.orientation
    try:
        contact, first = _against(system, at, held=held)
    except ZeroDivisionError:  # nothing asks for friction
        return None
    rates = slip_rates(system, state.time, contact, q, at.Omega, first, ZERO, state.support, held=held)
    least = -floor * at.forces(system)
    c, s, settling = rates.settled()
    if c > 0 and settling > 0 and _rate(rates, c, s) > 0 and rates.normal_force(c, s) > least:
        return _Growth(rates.direction(c, s), _rate(rates, c, s), settling)
    for rate, (c, s) in onset(values_of(rates).along_and_pressing):
        if rates.normal_force(c, s) > least:
            if has_duals(rates):  # a root that was searched for has no slopes: those of Newton's method from there
                c, s, _ = rates.settled(c, s)
                rate = _rate(rates, c, s)
            return _Growth(rates.direction(c, s), rate, 0.0)
    return None


def _rate(rates: SlipRates, c: float, s: float) -> float:
    first, second = rates.along(c, s)
    return as_float(c * first + s * second)


def _holds(system: RollingSystem, at: ContactState, law: Law) -> bool:
    """Tell whether friction gives what rolling takes."""
    stops = law.event_functions(system, at.state.time, law.state_vector(at), ())
    return bool(stops["slip"] >= 0 and stops["lift"] >= 0)


def _pushed(system: RollingSystem, at: ContactState, slip: Vector, law: Law) -> ContactState:
    """Return the body after the impulse at the contact that makes it slip so, with the couple that comes with N."""
    whole, state, contact = system.body.inertia_in_space(at.orientation.matrix()), at.state, at.contact
    J = HeldInertia(contact.normal, whole) if law.code == RESTING else whole
    moving = contact.body_motion(system.body.mass, state.time, at.V, at.orientation, at.Omega)
    acting = system.acting_on(moving, held=law.code == RESTING)
    couple = acting.couple if acting.has_couple else ZERO

    def answer(push: Vector) -> Response:
        return response(system, contact, J, push, couple * push.dot(contact.normal))

    P = Matrix(*(answer(e).slip for e in (E_X, E_Y, E_Z))).transpose.solve(slip)
    coordinates, motion, support = state.support, system.support.motion, contact.support
    if motion.free:
        moment = support.lever(contact.point).dot(P) + support.axle.dot(couple) * P.dot(contact.normal)
        coordinates = (*coordinates[:-1], coordinates[-1] - as_float(moment / motion.inertia))
    moved = at.moving(system, at.V + P / system.body.mass, at.Omega + answer(P).angular_velocity, coordinates)
    return replace(moved, slip=slip)  # smaller than a rounding of V and Ω


def _against(system: RollingSystem, at: ContactState, *, held: bool) -> tuple[Contact, Vector]:
    """Return the contact, and −f/|f|, f being the friction that rolling takes, or rest that resistance holds."""
    state = at.state
    now: Rolling | Held
    if held:
        now = RestingLaw().held(system, state.time, RestingLaw().state_vector(at))
    else:
        now = roll(system, state.time, at.contact.point, at.orientation, at.Omega, state.support)
    n, R = now.contact.normal, now.reaction
    f = R - n * n.dot(R)
    return now.contact, f / -f.norm()
