"""The law of a body that rolls, and of one whose rolling is resisted."""

from __future__ import annotations

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.contact import Rolling, roll
from ...mechanics.scalars import Scalar
from ...mechanics.system import RollingSystem
from ..contact_state import ContactState
from ..samples import ROLLING, Array, Samples
from .columns import arrays, columns_of, phase_of
from .friction import cone
from .law import Law, Numbers, shrinking_events, state_turning


class RollingLaw(Law):
    """No slip: the state is (p, q, Ω)."""

    code = ROLLING
    in_charts = True

    def _now(self, system: RollingSystem, time: Scalar, state: Numbers) -> Rolling:
        p, q, Omega, _, coordinates = self.split(state)
        return roll(system, time, p, q, Omega, coordinates)

    def rates(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return ṗ, q̇, Ω̇."""
        now = self._now(system, time, state)
        coordinates = system.support.motion.coordinate_rates(time, self.split(state)[4], now.axle_moment)
        return [*now.point_rate, *now.orientation_rate, *now.angular_acceleration, *coordinates]

    def event_functions(
        self, system: RollingSystem, time: Scalar, state: Numbers, event_parameters: Numbers
    ) -> dict[str, Scalar]:
        """Return the normal force, the rest of the friction cone, and the bounds."""
        now, (floor, ending) = self._now(system, time, state), self._floor(event_parameters)
        found = cone(system, now.contact, now.reaction, now.normal_force, floor)
        if ending:
            turning = state_turning(now.contact, Vector(*state[7:10]))
            found |= shrinking_events("stop", turning, now.angular_acceleration, ending)
        return {**found, **self._bounds(system, now.contact, Quaternion(*state[3:7]), 0.0)}

    def reaction(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector:
        """Return R of the law."""
        return self._now(system, time, state).reaction

    def state_vector(self, at: ContactState) -> list[float]:
        """Return p = r + ρ, q and Ω."""
        return [*at.nearest, *at.orientation, *at.Omega, *at.state.support]

    def record(self, system: RollingSystem, time: Array, states: Array) -> Samples:
        """Complete p, q and Ω by the rolling law."""
        p, q, Omega, coordinates = columns_of(states, len(self.variables))
        now = roll(system, time, Vector.of(p), Quaternion.of(q), Vector.of(Omega), tuple(coordinates.T))
        centre, V, R = arrays(p, now.contact.centre, now.velocity, now.reaction)
        return Samples(
            time, centre, p, V, Omega, q, R + 0.0, phase=phase_of(time, self.code), support_coordinates=coordinates
        )


class RollingWithResistance(RollingLaw):
    """Rolling that comes to a stop where the body no longer turns over the support."""

    @property
    def ends(self) -> tuple[str, ...]:
        """Its turning may end."""
        return ("stop",)
