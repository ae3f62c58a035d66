"""What follows when a phase ends, over any scalar: grip, slip onset, lift-off, landing, stop and start.

As in `trundle.solve.transitions`, which looks closer: there slip begins after its first moment.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import contact_at
from ..mechanics.impact import keeps_direction, straight_impulse
from ..mechanics.scalars import Scalar, is_number, less, namespace
from ..mechanics.slipping import unpushed
from ..mechanics.system import RollingSystem
from ..solve.contact_state import STILL
from ..solve.laws import CONTACT, Law, Numbers, RestingLaw, RollingLaw, cone, state_turning
from ..solve.samples import FLIGHT, RESTING, ROLLING, SLIPPING
from ..solve.transitions import SETTLED, TAKE_OFF
from .landings import turning_impulse

CODES = {"rolling": ROLLING, "slipping": SLIPPING, "flight": FLIGHT, "rest": RESTING}
_FIRST = 1e-9  # share of the speeds at hand with which slip, or turning, begins, and below which there is none


@dataclass(frozen=True)
class Follows:
    """The state of each phase that may follow, and which does, by its code; none where only one may."""

    states: dict[str, list[Scalar]]
    phase: Scalar | None = None

    def codes(self) -> list[tuple[str, int]]:
        """Return the code of each."""
        return [(name, CODES[name]) for name in self.states]


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
    p, q, Omega, _, coordinates = law.split(state)
    motion = law.motion(system, time, state)
    gap = (p - motion.position).norm() * TAKE_OFF
    r = motion.position + n * gap
    return Follows({"flight": [*p, *q, *Omega, *motion.velocity, gap, *r, *coordinates]})


def _slip(system: RollingSystem, law: Law, time: Scalar, state: Numbers, n: Vector, plain: RollingSystem) -> Follows:  # noqa: ARG001
    """Return slip that begins against the friction that rolling, or rest, takes."""
    p, q, Omega, _, coordinates = law.split(state)
    R = law.reaction(system, time, state)
    f = R - n * n.dot(R)
    s = f * (-_FIRST * _speed(system, law, time, state) / f.norm())
    return Follows({"slipping": [*p, *q, *Omega, *s, *coordinates]})


def _grip(system: RollingSystem, law: Law, time: Scalar, state: Numbers, n: Vector, plain: RollingSystem) -> Follows:
    """Return rolling, or slip the other way where friction cannot hold the body."""
    rolling, coordinates = RollingLaw(), law.split(state)[4]
    rolls = [*state[: len(CONTACT)], *coordinates]
    contact = contact_at(system, time, *_place(law, state))
    R = rolling.reaction(system, time, rolls)
    holds = cone(system, contact, R, contact.normal.dot(R))["slip"]
    slips = _slip(system, rolling, time, rolls, n, plain).states["slipping"]
    return _either(holds, ("rolling", rolls), ("slipping", slips))


def _stop(system: RollingSystem, law: Law, time: Scalar, state: Numbers, n: Vector, plain: RollingSystem) -> Follows:
    """Return rest, or rolling that begins anew where the resistance cannot hold the body."""
    p, q, _, _, coordinates = law.split(state)
    resting, rests = RestingLaw(), [*p, *q, *_at_rest(system, time, coordinates), *coordinates]
    holds = resting.event_functions(system, time, rests, ())["start"]
    rolls = _start(system, resting, time, rests, n, plain).states["rolling"]
    return _either(holds, ("rest", rests), ("rolling", rolls))


def _start(system: RollingSystem, law: Law, time: Scalar, state: Numbers, n: Vector, plain: RollingSystem) -> Follows:  # noqa: ARG001
    """Return rolling with a first little turn against what the resistance would have to give."""
    p, q, _, _, coordinates = law.split(state)
    Omega = _at_rest(system, time, coordinates)
    held = RestingLaw().held(system, time, state)
    couple = held.couple - n * n.dot(held.couple)
    size = _speed(system, law, time, state) / held.contact.offset.norm()
    Omega = Omega - couple * (_FIRST * size / couple.norm())
    return Follows({"rolling": [*p, *q, *Omega, *coordinates]})


def _land(system: RollingSystem, law: Law, time: Scalar, state: Numbers, n: Vector, plain: RollingSystem) -> Follows:
    """Return flight where the body bounces, else slipping or rolling; a bounce as low as in a run is cut."""
    p, q, Omega, _, coordinates = law.split(state)
    motion, contact = law.motion(system, time, state), contact_at(system, time, p, q, coordinates)
    V, mass, free = motion.velocity, system.body.mass, system.support.motion.free
    impulse = straight_impulse if keeps_direction(plain) else turning_impulse
    P = impulse(system, contact, q, contact.slip_velocity(V, Omega))
    J = system.body.inertia_in_space(q.matrix())
    V, Omega = V + P / mass, Omega + J.solve(contact.offset.cross(P))
    if free:
        moment = contact.support.lever(p).dot(P)
        coordinates = (*coordinates[:-1], coordinates[-1] - moment / system.support.motion.inertia)
        contact = contact_at(system, time, p, q, coordinates)
    s = contact.slip_velocity(V, Omega)
    off = n.dot(s)
    along, arm = s - n * off, contact.offset.norm()
    pull = -unpushed(system, time, contact, q, Omega, along, coordinates).opening
    xp = namespace(off, pull, arm)
    tiny = _FIRST * _speed(system, law, time, state)
    # Lower than the height at which a run cuts a bounce, or off by rounding alone.
    height = xp.where(less(0.0, pull), off * off - 2.0 * SETTLED * arm * pull, 1.0)
    bounces = xp.where(less(tiny, off), height, -1.0)
    gap = arm * TAKE_OFF
    flies = [*p, *q, *Omega, *V, gap, *(motion.position + n * gap), *coordinates]
    states = {"flight": flies}
    friction = plain.support.friction
    none = friction is not None and is_number(friction) and friction == 0
    if friction is not None:
        states["slipping"] = [*p, *q, *Omega, *along, *coordinates]
    if not none:
        states["rolling"] = [*p, *q, *Omega, *coordinates]
    slides = along.dot(along) - tiny * tiny
    stays = xp.where(less(0.0, slides), float(SLIPPING), float(ROLLING))
    stays = float(ROLLING) if friction is None else float(SLIPPING) if none else stays
    return Follows(states, xp.where(less(0.0, bounces), float(FLIGHT), stays))


def _place(law: Law, state: Numbers) -> tuple[Vector, Quaternion, tuple[Scalar, ...]]:
    p, q, _, _, coordinates = law.split(state)
    return p, q, coordinates


def _at_rest(system: RollingSystem, time: Scalar, coordinates: tuple[Scalar, ...]) -> Vector:
    return system.support.motion.at(time, *coordinates).angular_velocity


def _either(holds: Scalar, one: tuple[str, list[Scalar]], other: tuple[str, list[Scalar]]) -> Follows:
    """Return the other where what holds is less than zero."""
    first, second = (float(CODES[name]) for name, _ in (one, other))
    return Follows(dict((one, other)), namespace(holds).where(less(holds, 0.0), second, first))


RESETS: dict[tuple[str, str], Reset] = {
    ("rolling", "slip"): _slip,
    ("rolling", "lift"): _lift,
    ("rolling", "stop"): _stop,
    ("slipping", "grip"): _grip,
    ("slipping", "lift"): _lift,
    ("flight", "land"): _land,
    ("rest", "start"): _start,
    ("rest", "lift"): _lift,
}

# Where a body goes on slipping, and resistance to rolling keeps it from turning: no phase of fields.
HELD = {("slipping", "stop"), ("rest", "slip")}
