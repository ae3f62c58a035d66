"""Each landing by itself: one impulse at the contact, inside the friction cone, by Keller's course and Stronge's work.

So is each jolt, in which the velocity of the support jumps under a body: all is relative to the support as it is after.

`mechanics.impact`, which makes the landings of a run, is not asked: the states before and after are held against the
momentum that one impulse carries, and against the impulse of `course`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import contact_at, normal_at
from ..mechanics.slipping import unpushed
from ..mechanics.system import RollingSystem, State
from ..solve.samples import Event
from ..solve.transitions import JOLT
from .acting import cross, inertia_of
from .bounds import EXACT, Array
from .card import CardFigure
from .course import Course
from .each_sample import Shares, worst_of

_KINDS = ("land", "settle", JOLT)
_MOST = 1000  # landings looked at
_CUT = 1e-6  # of |ρ|: how high a bounce may rise that is cut
_ROUNDING = 1e-15  # of the speeds at hand
_UNCLEAR = 1e-9  # of them, by which it may seem to come off or down where the support jerks along itself
_SET_DOWN = 4 * _ROUNDING  # of them, by which the contact of a body that stays seems to come off


@dataclass(frozen=True)
class Landing:
    """One landing, or one jolt: where, with what momentum, and what its impulse should have been.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("bouncing-ball-with-backspin").run(duration=0.5)
    >>> landing = Landing(run.system, run.events[0])
    >>> bool(abs(landing.wanted - landing.impulse).max() < 1e-15)
    True
    """

    system: RollingSystem  # what landed
    event: Event  # with the states before and after, and the contact

    @property
    def before(self) -> State:
        """Just before."""
        assert self.event.before is not None  # noqa: S101  landings have both
        return self.event.before

    @property
    def after(self) -> State:
        """Just after."""
        assert self.event.after is not None  # noqa: S101
        return self.event.after

    @cached_property
    def n(self) -> Array:
        """The support's normal where it touches."""
        coordinates = self.before.support
        return _row(normal_at(self.system, self.before.time, Vector(*self._point), coordinates))

    @property
    def _point(self) -> tuple[float, float, float]:
        assert self.event.contact is not None  # noqa: S101
        return self.event.contact

    @cached_property
    def rho(self) -> Array:
        """From the centre of mass to the contact, m."""
        return np.array(self._point) - np.array(self.before.position)

    @cached_property
    def J(self) -> Array:
        """The inertia tensor, kg m²."""
        return inertia_of(self.system, np.array([self.before.orientation]))[0]

    @cached_property
    def lever(self) -> Array | None:
        """e×(p − X) of a free axle, m."""
        motion = self.system.support.motion
        pose = motion.at(self.before.time, *self.before.support)
        return _row(pose.axle.cross(Vector(*self._point) - pose.origin)) if motion.free else None

    def point_velocity(self, V: Array, Omega: Array) -> Array:
        """Return V + Ω×ρ, m/s."""
        return V + _cross(Omega, self.rho)

    @cached_property
    def comes(self) -> Array:
        """The slip s just before, m/s."""
        return self._slip(self.before)

    @cached_property
    def goes(self) -> Array:
        """The slip s just after, m/s."""
        return self._slip(self.after)

    def _slip(self, state: State) -> Array:
        u = self.system.support.motion.at(state.time, *state.support).material_velocity(Vector(*self._point))
        return self.point_velocity(*_speeds(state)) - _row(u)

    @cached_property
    def speed(self) -> float:
        """The fastest of V, Ω×ρ and u before it, m/s: what rounding is a share of."""
        V, Omega = _speeds(self.before)
        carried = _cross(Omega, self.rho)
        u = V + carried - self.comes
        return max(*(float(np.linalg.norm(v)) for v in (V, carried, u)), 1e-300)

    @cached_property
    def course(self) -> Course:
        """What its slip went through; it has run its course."""
        turn = cross(np.eye(3), self.rho)  # row i is e_i×ρ, and ρ×P is turn P
        M = np.eye(3) / float(self.system.body.mass) + turn.T @ np.linalg.solve(self.J, turn)
        if self.lever is not None:
            M = M + np.outer(self.lever, self.lever) / float(self.system.support.motion.inertia)
        support, axes, mu = self.system.support, self._axes, self.mu
        slip = axes @ self.comes
        if self.jolted and self.stays:  # what would open the contact was cut
            slip[2] = min(slip[2], 0.0)
        landing = partial(Course, axes @ M @ axes.T, mu, float(support.restitution), slip)
        back = float(support.tangential_restitution)
        if mu is None and back > 0:  # nothing slips that stays on it, or that would with the slip it is given back
            found = landing(back)
            after = self._struck_by(axes.T @ found.impulse() if self.strikes else np.zeros(3))
            off = min(float(self.goes @ self.n), float(found.slip[2]))
            bare = off <= EXACT * self.speed  # it comes off with no speed, or not at all
            pulled_off = self._opening(after) * float(np.linalg.norm(self.rho)) > EXACT * self.speed**2
            if not pulled_off if bare else self._rise(off, after) < _CUT:
                back = 0.0
        return landing(back)

    @cached_property
    def jolted(self) -> bool:
        """Whether it was the support whose velocity jumped."""
        return self.event.kind == JOLT

    @cached_property
    def strikes(self) -> bool:
        """Whether there is an impulse: as they come together, or as friction without limit takes the body along."""
        down = -float(self.comes @ self.n)
        if not self.jolted:
            return down > 0
        return down > _UNCLEAR * self.speed or (self.mu is None and (self.stays or down >= -_UNCLEAR * self.speed))

    @property
    def mu(self) -> float | None:
        """The coefficient of slipping; None: no limit."""
        support = self.system.support
        coefficient = support.friction if support.kinetic_friction is None else support.kinetic_friction
        return None if coefficient is None else float(coefficient)

    @cached_property
    def _axes(self) -> Array:
        """Two tangents and n, as rows."""
        smallest = np.eye(3)[np.argmin(np.abs(self.n))]
        first = _cross(self.n, smallest)
        first /= np.linalg.norm(first)
        return np.stack([first, _cross(self.n, first), self.n])

    @cached_property
    def wanted(self) -> Array:
        """The impulse that the course makes, N s; none where nothing strikes."""
        return self._axes.T @ self.course.impulse() if self.strikes else np.zeros(3)

    @cached_property
    def off(self) -> float:
        """How fast the body would come off again after that impulse, m/s; a bounce that is cut loses it."""
        return float(self._slip(self._struck) @ self.n)

    @cached_property
    def _struck(self) -> State:
        """The body after that impulse."""
        return self._struck_by(self.wanted)

    def _struck_by(self, impulse: Array) -> State:
        """Return the body after an impulse at the contact, and a free axle after its opposite."""
        V, Omega = _speeds(self.before)
        V = V + impulse / float(self.system.body.mass)
        Omega = Omega + np.linalg.solve(self.J, _cross(self.rho, impulse))
        coordinates = self.before.support
        if self.lever is not None:
            rate = coordinates[-1] - float(self.lever @ impulse) / float(self.system.support.motion.inertia)
            coordinates = (*coordinates[:-1], rate)
        return replace(self.before, velocity=tuple(V), angular_velocity=tuple(Omega), support=coordinates)

    @cached_property
    def stays(self) -> bool:
        """Whether the body was set down: what is left of the speed off the support is gone, were it a rounding."""
        return self.event.kind == "settle" or float(self.goes @ self.n) <= _SET_DOWN * self.speed

    @property
    def cut(self) -> bool:
        """Whether bounces to come were cut."""
        return self.event.kind == "settle" or (self.jolted and self.stays and self.off > _UNCLEAR * self.speed)

    @cached_property
    def expected(self) -> tuple[Array, Array]:
        """V and Ω after that impulse, and after the bounces to come were cut where they were."""
        V, Omega = _speeds(self._struck)
        return (V - self.off * self.n, Omega) if self.stays else (V, Omega)

    @cached_property
    def impulse(self) -> Array:
        """The impulse that the change of V shows, N s."""
        lost = self.off * self.n if self.cut else 0.0
        return float(self.system.body.mass) * (_speeds(self.after)[0] - _speeds(self.before)[0] + lost)

    @cached_property
    def size(self) -> float:
        """Of the impulse, or where there is none the momentum, N s: what an error of it is a share of."""
        if not self.strikes:
            return float(self.system.body.mass) * self.speed
        return max(float(np.linalg.norm(self.wanted)), float(np.linalg.norm(self.impulse)), 1e-300)

    @cached_property
    def sharp(self) -> float:
        """The share of the impulse that rounding of V, Ω and ρ leaves open.

        ρ is the small difference of two places, and Ω×ρ as sharp as these.
        """
        carried = float(np.linalg.norm(_speeds(self.before)[1]) * np.linalg.norm(self._point))
        momentum = float(self.system.body.mass) * (self.speed + carried) / self.size
        return self._level + _ROUNDING * momentum

    @property
    def _level(self) -> float:
        """The share of the speed that rounding of ρ leaves open."""
        return EXACT + _ROUNDING * float(np.linalg.norm(self._point)) / float(np.linalg.norm(self.rho))

    @property
    def work(self) -> float:
        """What the impulse did to the body's energy, and the cut, J: half of P times both velocities of the contact."""
        before, struck, after = _speeds(self.before), _speeds(self._struck), self.expected
        mean = 0.5 * (self.point_velocity(*before) + self.point_velocity(*struck))
        cut = 0.5 * float(self.system.body.mass) * float((after[0] - struck[0]) @ (after[0] + struck[0]))
        return float(self.wanted @ mean) + cut

    @property
    def gained(self) -> float:
        """What the body's energy gained, J."""
        (V, Omega), (V_after, Omega_after) = _speeds(self.before), _speeds(self.after)
        moved = float(self.system.body.mass) * float((V_after + V) @ (V_after - V))
        return 0.5 * (moved + float((Omega_after + Omega) @ self.J @ (Omega_after - Omega)))

    def one_impulse(self) -> Iterator[tuple[str, float, float]]:
        """Yield what must hold of any impulse at the contact: name, share, and how much it may be."""
        P, arm = self.impulse, float(np.linalg.norm(self.rho))
        spin = self.J @ (_speeds(self.after)[1] - _speeds(self.before)[1]) - _cross(self.rho, P)
        turned = float(np.linalg.norm(self.J @ _speeds(self.before)[1]))
        yield (
            "J ΔΩ = ρ×m ΔV",
            float(np.linalg.norm(spin)) / (arm * self.size),
            self.sharp + _ROUNDING * turned / (arm * self.size),
        )
        if self.lever is not None:
            inertia, rate = float(self.system.support.motion.inertia), self.before.support[-1]
            change = inertia * (self.after.support[-1] - rate) + float(self.lever @ P)
            size = self.size * max(float(np.linalg.norm(self.lever)), arm)
            yield "the axle", abs(change) / size, self.sharp + _ROUNDING * abs(inertia * rate) / size
        along = float(P @ self.n)
        yield "it pushes", -along / self.size, self.sharp
        if self.course.mu is not None:
            aside = float(np.linalg.norm(P - along * self.n))
            yield "the friction cone", (aside - self.course.mu * along) / self.size, self.sharp
        if not self.jolted:
            yield "comes down before", float(self.comes @ self.n) / self.speed, self._level
        yield "and not after", -float(self.goes @ self.n) / self.speed, self._level
        place = np.subtract(self.after.position, self.before.position)
        yield "the place stays", float(np.abs(place).max()), 0.0
        yield (
            "and the orientation",
            float(np.abs(np.subtract(self.after.orientation, self.before.orientation)).max()),
            0.0,
        )
        if self.cut:
            # Of a jolt the flight may be cut, and what friction without limit would make of it.
            left_behind = max(0.0, float(self.comes @ self.n))
            off = max(left_behind, self.off - left_behind)
            yield "only low bounces are cut", max(0.0, self._rise(off, self.after) / _CUT - 1), 1e-3

    @property
    def pull(self) -> float:
        """How fast the gap's rate changes just before it, m/s²."""
        return abs(self._opening(self.before))

    def _rise(self, off: float, after: State) -> float:
        """Return how high a bounce rises that comes off so fast, m/s, from a state, as a share of |ρ|."""
        return off**2 / (2 * max(-self._opening(after), 1e-300)) / float(np.linalg.norm(self.rho))

    def _opening(self, state: State) -> float:
        """Return the gap's acceleration without a contact force, m/s²."""
        q, coordinates = Quaternion(*state.orientation), state.support
        contact = contact_at(self.system, state.time, Vector(*self._point), q, coordinates)
        slip = self._slip(state)
        sliding = Vector(*(slip - self.n * (slip @ self.n)))
        Omega = Vector(*state.angular_velocity)
        return float(unpushed(self.system, state.time, contact, q, Omega, sliding, coordinates).opening)

    def by_its_course(self) -> Iterator[tuple[str, float, float]]:
        """Yield how far V and Ω after it are from what the impulse of its course makes of them."""
        (V, Omega), (found, turned) = self.expected, _speeds(self.after)
        m, arm = float(self.system.body.mass), float(np.linalg.norm(self.rho))
        # A light impulse turns a body of hardly any inertia: M P = Δs says as little of P as rounding leaves.
        bound = 10 * self.sharp + _ROUNDING * float(np.linalg.cond(self.course.M))
        yield "V after it", m * float(np.linalg.norm(found - V)) / self.size, bound
        moment = float(np.linalg.norm(self.J @ (turned - Omega))) / (arm * self.size)
        spun = _ROUNDING * float(np.linalg.norm(self.J @ Omega)) / (arm * self.size)
        yield "Ω after it", moment, bound + spun


def landings_of(system: RollingSystem, events: tuple[Event, ...]) -> list[Landing]:
    """Return the landings and jolts of a run, or as many as are looked at, spread over it."""
    found = [Landing(system, event) for event in events if event.kind in _KINDS and event.contact is not None]
    return found[:: -(-len(found) // _MOST)] if len(found) > _MOST else found


def landing_figures(landings: list[Landing]) -> Iterator[CardFigure]:
    """Yield two figures: what holds of any impulse, and the impulse itself."""
    if not landings:
        return
    times = np.array([landing.before.time for landing in landings])
    jolts = sum(landing.jolted for landing in landings)
    kinds = ((len(landings) - jolts, "landing"), (jolts, "jolt"))
    count = " and ".join(f"{many} {kind}{'s' * (many > 1)}" for many, kind in kinds if many)
    one = [list(landing.one_impulse()) for landing in landings]
    said = f"{count}: m ΔV turns the body as J ΔΩ = ρ×m ΔV, pushes, inside the friction cone"
    yield _figure("landings: one impulse at the contact", one, times, said)
    course = [list(landing.by_its_course()) for landing in landings]
    e = float(landings[0].system.support.restitution)
    said = f"{count}: slip followed again by Keller's equations, e² = {e * e:g} of the work given back"
    yield _figure("landings: slip and restitution", course, times, said)


def _figure(name: str, found: list[list[tuple[str, float, float]]], times: Array, said: str) -> CardFigure:
    """Return the worst of what was found of each landing."""
    flat = [(time, *one) for time, each in zip(times, found, strict=True) for one in each]
    conditions = [Shares(what, np.array([share]), max(bound, 1e-300)) for _, what, share, bound in flat]
    worst = max(range(len(flat)), key=lambda i: conditions[i].ratio[0])
    return worst_of(name, [conditions[worst]], np.array([flat[worst][0]]), said)


def _cross(a: Array, b: Array) -> Array:
    """Return a×b: `np.cross`, at a tenth of its price for two vectors."""
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])


def _row(v: Vector) -> Array:
    return np.array([float(part) for part in v])


def _speeds(state: State) -> tuple[Array, Array]:
    return np.array(state.velocity), np.array(state.angular_velocity)
