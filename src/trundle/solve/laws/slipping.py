"""The law of a body that slips, under friction and without."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...mechanics.algebra import ZERO, Quaternion, Vector
from ...mechanics.contact import Contact
from ...mechanics.scalars import Scalar, as_float, is_zero
from ...mechanics.slipping import Slipping, slip, slip_direction, unturned
from ...mechanics.system import RollingSystem
from ..contact_state import ContactState
from ..samples import SLIPPING, Array, Samples
from .columns import arrays, columns_of, phase_of, unit_rows
from .friction import left_of_resistance
from .law import CONTACT, Law, Numbers, shrinking_events, state_turning

# Friction all but jams a body where a newton of N opens the contact by so small a share of 1/m.
JAMS = 1e-3
_SLOW_SLIP = 1e-8  # m/s for each rad/s of Ω


class SlippingLaw(Law):
    """Slipping with friction −μ N ŝ: the state is (p, q, Ω, s).

    Against resistance to rolling, turning over the support may end while slip goes on. Then a couple, no larger than
    the resistance, holds the body so until more would be asked of it, "start".

    Parameters
    ----------
    weightless : bool
        As of `Law`.
    turning : str
        "free"; "resisted"; or "held", where the body does not turn over the support.
    """

    code = SLIPPING
    variables: tuple[str, ...] = (*CONTACT, "s_x", "s_y", "s_z")

    def __init__(self, weightless: bool = False, turning: str = "free") -> None:
        super().__init__(weightless)
        self.turning = turning

    @property
    def held(self) -> bool:
        """Whether resistance keeps the body from turning over the support."""
        return self.turning == "held"

    @property
    def ends(self) -> tuple[str, ...]:
        """Its slip may end, and turning that is resisted."""
        return ("grip", *self._turning_ends)

    @property
    def _turning_ends(self) -> tuple[str, ...]:
        return ("stop",) if self.turning == "resisted" else ()

    def _turns(self, contact: Contact, Omega: Vector) -> Vector:
        return unturned(contact, Omega) if self.held else Omega

    def _now(self, system: RollingSystem, time: Scalar, state: Numbers, direction: Vector | None = None) -> Slipping:
        p, q, Omega, s, coordinates = self.split(state)
        return slip(system, time, p, q, Omega, Vector(*s), coordinates, direction, held=self.held)

    def rates(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return ṗ, q̇, Ω̇, ṡ."""
        now = self._now(system, time, state)
        coordinates = system.support.motion.coordinate_rates(time, self.split(state)[4], now.axle_moment)
        return [*now.point_rate, *now.orientation_rate, *now.angular_acceleration, *now.slip_rate, *coordinates]

    def event_functions(
        self, system: RollingSystem, time: Scalar, state: Numbers, event_parameters: Numbers
    ) -> dict[str, Scalar]:
        """Return the normal force, its own effect on the gap, what is left of slip and turning, and the bounds."""
        now, ending = self._now(system, time, state), self._floor(event_parameters)[1]
        found = self._pressing(system, now, event_parameters)
        for i, name in enumerate(self.ends if ending else ()):
            v, rate = Vector(*state[10:13]), now.slip_rate
            if name == "stop":
                v, rate = state_turning(now.contact, Vector(*state[7:10])), now.angular_acceleration
            found |= shrinking_events(name, v, rate, ending[4 * i : 4 * i + 4])
        return {**found, **self._bounds(system, now.contact, Quaternion(*state[3:7]), 0.0)}

    def _pressing(self, system: RollingSystem, now: Slipping, event_parameters: Numbers) -> dict[str, Scalar]:
        """Return the normal force, and how it opens the contact where friction may turn that round."""
        found = {"lift": now.normal_force + self._floor(event_parameters)[0]}
        if self.held:
            found["start"] = left_of_resistance(system, found["lift"], now.holding)
        if not is_zero(system.support.friction):
            found["jam"] = now.opening_per_newton * system.body.mass - JAMS
        return found

    def reaction(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector:
        """Return R of the law."""
        return self._now(system, time, state).reaction

    def state_vector(self, at: ContactState) -> list[float]:
        """Return p, q, Ω and the part of s along the support."""
        return [*at.nearest, *at.orientation, *at.Omega, *at.sliding, *at.state.support]

    def record(self, system: RollingSystem, time: Array, states: Array) -> Samples:
        """Complete p, q, Ω and s by the law of slipping."""
        p, q, Omega, coordinates = columns_of(states, len(self.variables))
        now = self._recorded(system, time, states)
        turning = self._turns(now.contact, Vector.of(Omega))
        centre, V, R, Omega = arrays(p, now.contact.centre, now.velocity, now.reaction, turning)
        return Samples(
            time, centre, p, V, Omega, q, R + 0.0, phase=phase_of(time, self.code), support_coordinates=coordinates
        )

    def _slip(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector:  # noqa: ARG002
        return Vector(*state[10:13])

    def direction(self, system: RollingSystem, time: float, numbers: Sequence[float] | Array) -> Vector:  # noqa: ARG002
        """Return ŝ, the direction of the slip."""
        return slip_direction(Vector(*map(as_float, numbers[10:13])))

    def stiff(self, numbers: Array) -> bool:
        """Tell whether it slips so slowly that the direction of its slip settles far faster than all else changes."""
        s, Omega = (float(np.linalg.norm(part)) for part in (numbers[10:13], numbers[7:10]))
        return "grip" in self.ends and 0 < s < _SLOW_SLIP * Omega

    def _recorded(self, system: RollingSystem, time: Array, states: Array) -> Slipping:
        columns = list(states.T)
        columns[3:7] = unit_rows(states[:, 3:7]).T
        s = Vector(*columns[10:13])
        length = s.norm()
        return self._now(system, time, columns, s / np.where(length > 0, length, 1.0))  # none where s has just ended


class SlidingFreely(SlippingLaw):
    """Contact without any friction: s has no part in the force, and never grips."""

    @property
    def ends(self) -> tuple[str, ...]:
        """Only turning that is resisted may end."""
        return self._turning_ends

    def _now(
        self,
        system: RollingSystem,
        time: Scalar,
        state: Numbers,
        direction: Vector | None = ZERO,  # noqa: ARG002
    ) -> Slipping:
        p, q, Omega, s, coordinates = self.split(state)
        return slip(system, time, p, q, Omega, Vector(*s), coordinates, ZERO, held=self.held)
