"""The law of slip so slow that friction settles its direction at once: only its speed is a number of the state."""

from __future__ import annotations

from copy import copy
from typing import Any, NamedTuple

import numpy as np

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import contact_at
from ..mechanics.creep import slip_rates
from ..mechanics.scalars import Scalar, as_float
from ..mechanics.slipping import Slipping, slip
from ..mechanics.system import RollingSystem
from . import corner_events
from .contact_state import ContactState, floats
from .laws import CONTACT, Numbers, SlippingLaw
from .tracing import python_law

# How many times as fast as slip has grown, r, its direction must settle: with the terms in 1/r to 1/r⁴ of how far it
# lags behind. Where slip grows from nothing the third is 6/r³ of the angle by which it has turned. It is known but for
# the share of the time in which the motion changes that has passed, and what is left out must be this small, rad: a
# method whose steps are as short as the direction takes to settle leaves it trembling by more. Where it is larger,
# `SlippingLaw` follows the direction.
SETTLES_FAST = 30.0
_LEFT_OUT = 1e-11
# How many times its direction must settle in the time in which the motion changes to be followed by this law before a
# method of series goes on: a step of this one takes as long as some sixty of its, of seven such times each. Where
# series have taken long, later: that gives up the last two digits of a direction for four fifths of the time.
_IN_SERIES, _LATE = 2e5, 5e3
# Where a direction settles faster than by so many times N/m, as on a light axle, V̇ shows what is left out of it so many
# times larger: no more is counted for being late.
_FASTEST, _ANYHOW = 4.0, 1e12
_TURNS = 20.0  # times as fast as the body turns: no slower does a direction settle whose steps would be too short
_LASTS = 50.0  # times the step over which its turning is seen: about how long it holds
SEEN = 1e-4  # of the time in which the motion changes: over it one sees how the direction turns
GROWN = ("settled", "lags", "turns", "series")  # ends at which slip is to be followed with its direction
_NEAR = 0.98  # cosine of the angle by which the direction may turn until it is looked for near another


class _Way(NamedTuple):
    """How slip goes that is slow."""

    hat: Vector
    settling: Scalar  # how fast its direction settles, times |s|, m/s²
    left_out: Scalar  # of its direction, about, rad


class CreepingLaw(SlippingLaw):
    """Slipping along the direction that friction keeps: the state is (p, q, Ω, |s|).

    It ends where |s| falls back to nothing, "held", where slip has grown so fast that its direction lags, "settled" and
    "lags", where the body itself turns almost as fast as that settles, "turns", where series take over, "series", or
    where it has turned away from the one near which it is looked for, "turned", to be followed from there.

    Parameters
    ----------
    weightless, turning
        As of `SlippingLaw`.
    step : float
        A time in which the body hardly moves, s, over which the turning of the direction is seen: `SEEN` of the time in
        which the motion changes.
    since : float
        When slip began, s.
    near : tuple of float
        A unit vector: near it is the direction that slip keeps.
    in_series : float
        How many times its direction settles, at the least, in the time in which the motion changes.
    fastest : float
        How fast it counts as settling for that, at the most, in units of N/m.
    """

    variables = (*CONTACT, "speed")
    brief = True
    handed_on = (*GROWN, "turned")
    ways: dict[Any, _Way] | None = None  # worked out while it is traced

    def __init__(
        self,
        weightless: bool = False,
        turning: str = "free",
        step: float = 0.0,
        since: float = 0.0,
        near: tuple[float, float, float] = (1.0, 0.0, 0.0),
        in_series: float = 0.0,
        fastest: float = _ANYHOW,
    ) -> None:
        super().__init__(weightless, turning)
        self.step, self.since, self.in_series, self.fastest = step, since, in_series, fastest
        self.near_x, self.near_y, self.near_z = near

    @property
    def lasts(self) -> float:  # type: ignore[override]
        """Some thousand times the first moment of slip: where its direction lags it mostly ends sooner."""
        return _LASTS * self.step

    @property
    def ends(self) -> tuple[str, ...]:
        """Nothing: its speed is followed through zero."""
        return ()

    def turned(self, direction: Vector) -> CreepingLaw:
        """Return the same law with another direction near which slip keeps one."""
        return CreepingLaw(self.weightless, self.turning, self.step, self.since, floats(direction))

    def before_series(self, *, late: bool = False) -> CreepingLaw:
        """Return the same law, handed on where series follow its direction with less work."""
        near = self.near_x, self.near_y, self.near_z
        how = (_LATE, _FASTEST) if late else (_IN_SERIES, _ANYHOW)
        return CreepingLaw(self.weightless, self.turning, self.step, self.since, near, *how)

    def stiff(self, numbers: Any) -> bool:  # noqa: ARG002
        """Tell that no direction has to settle."""
        return False

    def _settled(self, system: RollingSystem, time: Scalar, state: Numbers) -> tuple[Vector, Vector, Scalar]:
        """Return the direction that slip keeps, the one across it, and how fast the first settles, times |s|."""
        p, q, Omega, (speed, *_), coordinates = self.split(state)
        contact = contact_at(system, time, p, q, coordinates)
        n, near = contact.normal, Vector(self.near_x, self.near_y, self.near_z)
        first = near - n * n.dot(near)
        first = first / first.norm()
        for _ in range(2):  # for slip along the direction looked for, not the one near it
            rates = slip_rates(system, time, contact, q, Omega, first, first * speed, coordinates, held=self.held)
            c, s, settling = rates.settled()
            first, across = rates.direction(c, s), rates.direction(-s, c)
        return first, across, settling

    def traced(self) -> CreepingLaw:
        """Return a copy that works its direction out once: rates, event functions and what is found share it."""
        free = copy(self)
        free.ways = {}
        return free

    def _way(self, system: RollingSystem, time: Scalar, state: Numbers) -> _Way:
        """Return ŝ, lagging behind the direction that slip keeps."""
        if self.ways is None:
            return self._found_way(system, time, state)
        key = id(time), *map(id, state)
        if key not in self.ways:
            self.ways[key] = self._found_way(system, time, state)
        return self.ways[key]

    def _found_way(self, system: RollingSystem, time: Scalar, state: Numbers) -> _Way:
        """Return it to the fourth order of u, how long the direction takes to settle.

        Of a direction at an angle β that settles at β₀, β̇ = (β₀ − β)/u, it is β = β₀ − uβ̇₀ + u(uβ̇₀)˙ − u(u(uβ̇₀)˙)˙ + …,
        and u grows as a power of the time since slip began.
        """
        first, settling, _ = self._lagging(system, time, state)
        now = self._now(system, time, state, first)
        across = now.contact.normal.cross(first)
        beside = self._beside(system, time, state, first)
        (before, slower, kept), (after, faster, kept_after) = (self._lagging(system, *there) for there in beside)
        turning = (after - before).dot(across) / (2 * self.step)
        kept_turning = (kept_after - kept).dot(across) / (2 * self.step)
        u, share = state[10] / settling, state[10] / (settling * (time - self.since))
        grows = (beside[1][1][10] / faster - beside[0][1][10] / slower) / (2 * self.step)
        third = kept_turning * grows * (2 * grows - share) * (1 - 3 * grows + 2 * share)
        third = third + 3 * grows * (kept_turning * (1 - grows) - turning)
        hat = first + across * ((now.slip_rate.dot(across) - state[10] * turning) / settling - u * third)
        passed = (time - self.since) * SEEN / self.step
        left_out = 1.2 * u * kept_turning * (grows**2 + share**2) * (passed + 20 * share**2)
        return _Way(hat / hat.norm(), settling, left_out)

    def _lagging(self, system: RollingSystem, time: Scalar, state: Numbers) -> tuple[Vector, Scalar, Vector]:
        """Return ŝ but for the square of how far it lags behind, how fast it settles, times |s|, and where."""
        kept, across, settling = self._settled(system, time, state)
        before, after = (self._settled(system, *beside)[0] for beside in self._beside(system, time, state, kept))
        turning = (after - before).dot(across) / (2 * self.step)
        hat = kept - across * (state[10] * turning / settling)
        return hat / hat.norm(), settling, kept

    def _beside(
        self, system: RollingSystem, time: Scalar, state: Numbers, hat: Vector
    ) -> list[tuple[Scalar, list[Scalar]]]:
        """Return the time and the state a step before and a step later: how fast a direction turns is seen over both.

        The step is so short that the square of its share of the time in which the motion changes is left out, and so
        long that a slope of a slope has more digits than a method asks for.
        """
        rates = self._rates(system, time, state, hat)
        return [
            (time + step, [number + rate * step for number, rate in zip(state, rates, strict=True)])
            for step in (-self.step, self.step)
        ]

    def _now(self, system: RollingSystem, time: Scalar, state: Numbers, direction: Vector | None = None) -> Slipping:
        p, q, Omega, (speed, *_), coordinates = self.split(state)
        hat = self._settled(system, time, state)[0] if direction is None else direction
        return slip(system, time, p, q, Omega, hat * speed, coordinates, hat, held=self.held)

    def _rates(self, system: RollingSystem, time: Scalar, state: Numbers, hat: Vector) -> list[Scalar]:
        now = self._now(system, time, state, hat)
        coordinates = system.support.motion.coordinate_rates(time, self.split(state)[4], now.axle_moment)
        return [*now.point_rate, *now.orientation_rate, *now.angular_acceleration, now.slip_rate.dot(hat), *coordinates]

    def rates(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return ṗ, q̇, Ω̇ and the rate of |s|."""
        return self._rates(system, time, state, self._way(system, time, state).hat)

    def reaction(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector:
        """Return R of slipping along the direction that friction keeps."""
        return self._now(system, time, state, self._way(system, time, state).hat).reaction

    def event_functions(
        self, system: RollingSystem, time: Scalar, state: Numbers, event_parameters: Numbers
    ) -> dict[str, Scalar]:
        """Return the normal force, its effect on the gap, the speed of slip, how its direction lags, and the bounds."""
        hat, settling, left_out = self._way(system, time, state)
        now, Omega = self._now(system, time, state, hat), self.split(state)[2]
        speed = state[10]
        most = now.normal_force * self.fastest / system.body.mass
        counted = settling * most / (settling + most)
        return {
            **self._pressing(system, now, event_parameters),
            "held": speed,
            "settled": settling * (time - self.since) - SETTLES_FAST * speed,
            "lags": _LEFT_OUT**2 - left_out**2,
            "turns": settling**2 - (_TURNS * speed) ** 2 * Omega.dot(Omega),
            "series": counted * self.step / SEEN - self.in_series * speed,
            "turned": hat.dot(Vector(self.near_x, self.near_y, self.near_z)) - _NEAR,
            **self._bounds(system, now.contact, Quaternion(*state[3:7]), 0.0),
        }

    def settles(self, system: RollingSystem, at: ContactState) -> bool:
        """Tell whether the direction of a body's slip settles so fast that it can be followed by this law."""
        time, numbers = at.state.time, self.state_vector(at)
        law = python_law(system, self, (0.0,) * (self.event_parameters + corner_events.count(system)), time, numbers)
        stops = dict(zip(law.names, law.event_functions(time, numbers), strict=True))
        return min(stops[name] for name in GROWN) > 0

    def state_vector(self, at: ContactState) -> list[float]:
        """Return p, q, Ω and |s| of the slip along the support."""
        return [*at.nearest, *at.orientation, *at.Omega, at.sliding.norm(), *at.state.support]

    def direction(self, system: RollingSystem, time: float, numbers: Any) -> Vector:
        """Return ŝ."""
        state = list(map(as_float, numbers))
        return Vector(*python_law(system, self, time=time, state=state).found(time, state))

    def found(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return ŝ."""
        return [*self._way(system, time, state).hat]

    def _slip(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector:
        plain = isinstance(time, float) and isinstance(state[10], float)
        return (self.direction(system, time, state) if plain else self._way(system, time, state).hat) * state[10]

    def _recorded(self, system: RollingSystem, time: Any, states: Any) -> Slipping:
        columns = list(states.T)
        columns[3:7] = (states[:, 3:7] / np.linalg.norm(states[:, 3:7], axis=1, keepdims=True)).T
        return self._now(system, time, columns, self._way(system, time, columns).hat)
