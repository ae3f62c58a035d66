"""What follows when a phase ends, over any scalar: grip, slip onset, lift-off, landing, stop and start.

As in `trundle.solve.transitions`, which looks closer: there slip begins after its first moment.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ..mechanics.algebra import Vector
from ..mechanics.contact import contact_at
from ..mechanics.impact import keeps_direction, straight_impulse
from ..mechanics.scalars import Scalar, is_zero, less, namespace
from ..mechanics.slipping import unpushed
from ..mechanics.system import RollingSystem
from ..solve.contact_state import STILL
from ..solve.laws import Law, Numbers, state_turning
from ..solve.samples import RESTING, SLIPPING
from ..solve.transitions import SETTLED, TAKE_OFF
from .landings import turning_impulse
from .touching import FIRST, HELD, Follows, Option, Touch, above, first, where

_LEFT = 1e-6  # share of the speeds at hand below which slip, or turning, that comes to its end has ended

# What follows an event, of (system, law, time, state, n, the system with plain numbers).
Reset = Callable[[RollingSystem, Law, Scalar, Numbers, Vector, RollingSystem], Follows]


def event_parameters(system: RollingSystem, law: Law, time: Scalar, state: Numbers) -> list[Scalar]:
    """Return for all that may shrink to nothing when it is all but nothing, squared, and its direction."""
    found: list[Scalar] = []
    for name in law.ends:
        p, q, Omega, rest, coordinates = law.split(state)
        contact = contact_at(system, time, p, q, coordinates)
        arm = contact.offset.norm()
        v = Vector(*rest[:3]) if name == "grip" else state_turning(contact, Omega)
        least = STILL * _speed(system, law, time, state) / (1.0 if name == "grip" else arm)
        found += [least * least, *(v / v.norm())]
    return found


def _speed(system: RollingSystem, law: Law, time: Scalar, state: Numbers) -> Scalar:
    """Return a speed of this motion: of what moves, and of what the loads make of it, m/s."""
    p, _, Omega, _, _ = law.split(state)
    motion = law.motion(system, time, state)
    arm, (F, _) = (p - motion.position).norm(), system.loads_on(motion)
    V = motion.velocity
    square = V.dot(V) + Omega.dot(Omega) * arm * arm + F.norm() * arm / system.body.mass
    return namespace(square).sqrt(square)


def _lift(system: RollingSystem, law: Law, time: Scalar, state: Numbers, n: Vector, plain: RollingSystem) -> Follows:  # noqa: ARG001
    """Return flight as the body moves, a gap begun that rounding does not close."""
    p, q, _, _, coordinates = law.split(state)
    motion = law.motion(system, time, state)
    gap = (p - motion.position).norm() * TAKE_OFF
    r = motion.position + n * gap
    return Follows({"flight": [*p, *q, *motion.angular_velocity, *motion.velocity, gap, *r, *coordinates]})


def _slip(system: RollingSystem, law: Law, time: Scalar, state: Numbers, n: Vector, plain: RollingSystem) -> Follows:  # noqa: ARG001
    """Return slip that begins against the friction that rolling, or rest, takes."""
    touch = _touch(system, law, time, state, plain)
    s = touch.first_slip(law.reaction(system, time, state))
    return first(list(touch.sliding(s)) if law.code == RESTING else [Option("slipping", touch.state(s))])


def _grip(system: RollingSystem, law: Law, time: Scalar, state: Numbers, n: Vector, plain: RollingSystem) -> Follows:  # noqa: ARG001
    """Return rolling, or rest; slip the other way where friction cannot hold the body; or slip that goes on."""
    touch, s = _touch(system, law, time, state, plain), Vector(*law.split(state)[3])
    goes_on = Option(HELD if law.turning == "held" else "slipping", [*state], above(s.norm(), _LEFT * touch.speed))
    return first([goes_on, *touch.sticking()])


def _stop(system: RollingSystem, law: Law, time: Scalar, state: Numbers, n: Vector, plain: RollingSystem) -> Follows:  # noqa: ARG001
    """Return rest, or slip while the body is held; turning anew where it cannot be; or turning that goes on."""
    touch, slips = _touch(system, law, time, state, plain), law.code == SLIPPING
    goes_on = Option("slipping" if slips else "rolling", [*state], above(touch.turning, _LEFT * touch.speed))
    still = touch.unturned
    follows = still.sliding(Vector(*law.split(state)[3])) if slips else still.sticking()
    return first([goes_on, *follows])


def _start(system: RollingSystem, law: Law, time: Scalar, state: Numbers, n: Vector, plain: RollingSystem) -> Follows:  # noqa: ARG001
    """Return rolling, or slip, with a first little turn against what the resistance would have to give."""
    touch = _touch(system, law, time, state, plain)
    if law.code == SLIPPING:
        s, still = Vector(*law.split(state)[3]), touch.unturned
        return Follows({"slipping": still.turned(still.held(s).holding).state(s)})
    return Follows({"rolling": touch.at_rest.turned(touch.resting().couple).state()})


def _land(system: RollingSystem, law: Law, time: Scalar, state: Numbers, n: Vector, plain: RollingSystem) -> Follows:
    """Return flight where the body bounces, else what it does that stays; a bounce as low as in a run is cut."""
    touch, motion = _touch(system, law, time, state, plain), law.motion(system, time, state)
    q, V, contact, mass = touch.q, motion.velocity, touch.contact, system.body.mass
    impulse = straight_impulse if keeps_direction(plain) else turning_impulse
    P = impulse(system, contact, q, contact.slip_velocity(V, touch.Omega))
    J = system.body.inertia_in_space(q.matrix())
    V, touch = V + P / mass, replace(touch, Omega=touch.Omega + J.solve(contact.offset.cross(P)))
    if plain.support.motion.free:
        *others, rate = touch.coordinates
        moment = contact.support.lever(touch.p).dot(P)
        touch = replace(touch, coordinates=(*others, rate - moment / system.support.motion.inertia))
    contact, Omega = touch.contact, touch.Omega
    s = contact.slip_velocity(V, Omega)
    off = n.dot(s)
    along, arm = s - n * off, contact.offset.norm()
    pull = -unpushed(system, time, contact, q, Omega, along, touch.coordinates).opening
    # Lower than the height at which a run cuts a bounce, or off by rounding alone.
    height = namespace(pull, off).where(less(0.0, pull), off * off - 2.0 * SETTLED * arm * pull, 1.0)
    gap = arm * TAKE_OFF
    flies = [*touch.p, *q, *Omega, *V, gap, *(motion.position + n * gap), *touch.coordinates]
    bounces = Option("flight", flies, above(off, FIRST * touch.speed) * above(height, 0.0))
    friction = plain.support.friction
    if is_zero(friction):
        return first([bounces, *touch.sliding(along)])
    slides = touch.sliding(along) if friction is not None else iter(())
    return first([bounces, *where(above(along.norm(), FIRST * touch.speed), slides), *touch.sticking()])


def _touch(system: RollingSystem, law: Law, time: Scalar, state: Numbers, plain: RollingSystem) -> Touch:
    """Return the body of a state where it touches."""
    p, q, Omega, _, coordinates = law.split(state)
    return Touch(system, time, p, q, Omega, coordinates, _speed(system, law, time, state), plain)


RESETS: dict[tuple[str, str], Reset] = {
    ("rolling", "slip"): _slip,
    ("rolling", "lift"): _lift,
    ("rolling", "stop"): _stop,
    ("slipping", "grip"): _grip,
    ("slipping", "stop"): _stop,
    ("slipping", "lift"): _lift,
    (HELD, "grip"): _grip,
    (HELD, "start"): _start,
    (HELD, "lift"): _lift,
    ("flight", "land"): _land,
    ("rest", "slip"): _slip,
    ("rest", "start"): _start,
    ("rest", "lift"): _lift,
}
