"""What a body does that touches and stays: rolls, slips or rests, over any scalar, by choices without branches."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from ..mechanics.algebra import ZERO, Quaternion, Vector
from ..mechanics.contact import Contact, contact_at
from ..mechanics.scalars import Scalar, is_zero, less, namespace
from ..mechanics.slipping import Slipping, slip, unturned
from ..mechanics.system import RollingSystem
from ..solve.laws import Held, Law, RestingLaw, RollingLaw, left_of_resistance, state_turning
from ..solve.samples import FLIGHT, RESTING, ROLLING, SLIPPING

HELD = "held_slipping"  # slip while resistance to rolling keeps the body from turning over the support
CODES = {"rolling": ROLLING, "slipping": SLIPPING, "flight": FLIGHT, "rest": RESTING, HELD: 4}
NOTHING = -1  # the code where no phase follows
FIRST = 1e-9  # share of the speeds at hand with which slip, or turning, begins, and below which there is none


@dataclass(frozen=True)
class Follows:
    """The state of each phase that may follow, and which does, by its code; none where only one may."""

    states: dict[str, list[Scalar]]
    phase: Scalar | None = None
    ends: bool = False  # whether nothing may follow, too

    def codes(self) -> list[tuple[str, int]]:
        """Return the code of each."""
        return [*((name, CODES[name]) for name in self.states), *([("none: the motion ends", NOTHING)] * self.ends)]


@dataclass(frozen=True)
class Option:
    """What follows unless something before it does."""

    phase: str  # "": nothing, the motion ends
    state: list[Scalar]
    takes: Scalar = 1.0  # 1 where it does, else 0


@dataclass(frozen=True)
class Touch:
    """A body that touches the support and stays on it."""

    system: RollingSystem
    time: Scalar
    p: Vector
    q: Quaternion
    Omega: Vector
    coordinates: tuple[Scalar, ...]
    speed: Scalar  # of the speeds at hand, m/s
    plain: RollingSystem  # with plain numbers

    @cached_property
    def contact(self) -> Contact:
        """The geometry."""
        return contact_at(self.system, self.time, self.p, self.q, self.coordinates)

    @property
    def turning(self) -> Scalar:
        """How fast it turns over the support, m/s."""
        return state_turning(self.contact, self.Omega).norm() * self.contact.offset.norm()

    @property
    def spin(self) -> Scalar:
        """How fast it spins about the normal, m/s."""
        relative = self.Omega - self.contact.support.angular_velocity
        return abs(relative.dot(self.contact.normal)) * self.contact.offset.norm()

    @property
    def unturned(self) -> Touch:
        """The same without turning over the support."""
        return replace(self, Omega=unturned(self.contact, self.Omega))

    @property
    def at_rest(self) -> Touch:
        """The same, carried along by the support."""
        return replace(self, Omega=self.contact.support.angular_velocity)

    def turned(self, holding: Vector) -> Touch:
        """Return the same with a first little turn against a couple that would hold it."""
        n = self.contact.normal
        turn = _against(holding - n * holding.dot(n), FIRST * self.speed / self.contact.offset.norm())
        return replace(self, Omega=self.Omega + turn)

    def first_slip(self, reaction: Vector) -> Vector:
        """Return a first little slip against the friction of a contact force."""
        n = self.contact.normal
        return _against(reaction - n * n.dot(reaction), FIRST * self.speed)

    def held(self, s: Vector) -> Slipping:
        """Return how it slips if it does not turn."""
        direction = s / _guarded(s.norm()) if not is_zero(self.plain.support.friction) else ZERO
        return slip(self.system, self.time, self.p, self.q, self.Omega, s, self.coordinates, direction, held=True)

    def resting(self) -> Held:
        """Return what holds it at rest."""
        return RestingLaw().held(self.system, self.time, self.state())

    def left(self, law: Law) -> dict[str, Scalar]:
        """Return what is left of what a law may ask for."""
        return law.event_functions(self.system, self.time, self.state(), ())

    def state(self, s: Iterable[Scalar] = ()) -> list[Scalar]:
        """Return the numbers of a state."""
        return [*self.p, *self.q, *self.Omega, *s, *self.coordinates]

    def sliding(self, s: Vector) -> Iterator[Option]:
        """Yield what may follow where it slips: turning as it will, or held by resistance to rolling."""
        slips = Option("slipping", self.state(s))
        if not self.plain.resisted:
            yield slips
            return
        yield replace(slips, takes=above(self.turning, FIRST * self.speed))
        if self.plain.support.motion.free:  # against which no law holds a body
            yield Option("", [])
            return
        still = self.unturned
        now = still.held(s)
        left = left_of_resistance(self.system, now.normal_force, now.holding)
        yield Option(HELD, still.state(s), _at_least(now.normal_force, 0.0) * _at_least(left, 0.0))
        yield Option("slipping", still.turned(now.holding).state(s))

    def sticking(self) -> Iterator[Option]:
        """Yield what may follow where it does not slip, as long as friction gives what that asks for.

        One that does not turn against a resistance and spins on the spot has no law.
        """
        rolls = self
        if self.plain.resisted:
            turns = above(self.turning, FIRST * self.speed)
            begins = self.unturned.turned(self.resting().couple).Omega
            xp = namespace(turns, self.speed)
            took = (xp.where(less(0.5, turns), a, b) for a, b in zip(self.Omega, begins, strict=True))
            rolls = replace(self, Omega=Vector(*took))
            spins = above(self.spin, FIRST * self.speed)
            if not self.plain.support.motion.free:
                yield from self.at_rest._staying((1.0 - turns) * (1.0 - spins))
            yield Option("", [], (1.0 - turns) * spins)
        law = RollingLaw()
        left = rolls.left(law)
        if "slip" not in left:
            yield Option("rolling", rolls.state())
            return
        yield Option("rolling", rolls.state(), _at_least(left["slip"], 0.0))
        R = law.reaction(self.system, self.time, rolls.state())
        yield Option("slipping", rolls.state(rolls.first_slip(R)))

    def _staying(self, still: Scalar) -> Iterator[Option]:
        """Yield what may follow where it does not even turn, as long as resistance holds it."""
        left = self.left(RestingLaw())
        still = still * _at_least(left["lift"], 0.0) * _at_least(left["start"], 0.0)
        rests = Option("rest", self.state(), still)
        if "slip" not in left:
            yield rests
            return
        yield replace(rests, takes=still * _at_least(left["slip"], 0.0))
        yield from where(still, self.sliding(self.first_slip(self.resting().reaction)))


def where(takes: Scalar, options: Iterator[Option]) -> Iterator[Option]:
    """Yield options that follow only where something else is so as well."""
    for option in options:
        yield replace(option, takes=takes * option.takes)


def first(options: Sequence[Option]) -> Follows:
    """Return what follows: the first option that takes, or else the last."""
    *others, last = options
    phase: Scalar = float(CODES.get(last.phase, NOTHING))
    states = {last.phase: last.state} if last.phase else {}
    for option in reversed(others):
        xp = namespace(option.takes)
        takes = less(0.5, option.takes)
        phase = xp.where(takes, float(CODES.get(option.phase, NOTHING)), phase)
        if option.phase:
            before = states.get(option.phase, option.state)
            states[option.phase] = [xp.where(takes, a, b) for a, b in zip(option.state, before, strict=True)]
    ends = not all(option.phase for option in options)
    return Follows(states, phase if ends or len(states) > 1 else None, ends)


def above(value: Scalar, limit: Scalar) -> Scalar:
    """Return 1 where a value is above a limit, else 0."""
    return namespace(value, limit).where(less(limit, value), 1.0, 0.0)


def _at_least(value: Scalar, limit: Scalar) -> Scalar:
    return namespace(value, limit).where(less(value, limit), 0.0, 1.0)


def _against(v: Vector, size: Scalar) -> Vector:
    """Return a vector of some size against another; none, against none."""
    return v * (-size / _guarded(v.norm()))


def _guarded(length: Scalar) -> Scalar:
    """Return a length by which may be divided."""
    return namespace(length).where(less(0.0, length), length, 1.0)
