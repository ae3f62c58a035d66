"""The first moment of slip, which is worked out by hand, is one in which nothing has changed much."""

from __future__ import annotations

from typing import Any

import trundle as tr
from trundle.mechanics.algebra import E_Z, Vector
from trundle.mechanics.system import State
from trundle.solve.contact_state import ContactState
from trundle.solve.slip_onset import slip_onset

RADIUS = 0.327145
# A ring that fell on its side in a bowl, which is all but as hollow there: the contact runs round the ring within
# microseconds, at 6 km/s, while the body itself is slow.
BEGINS_TO_SLIP = State(
    position=(0.0003951134553605382, -0.0006256189655703291, 0.00025102506859040223),
    velocity=(0.0016841744961171431, -0.003043633115433175, 0.1804494004340376),
    angular_velocity=(19.84515554349772, -5.029266766609537, -0.2700436963166922),
    orientation=(0.9753469692100666, -0.0007925735595922178, -0.0008087810256041614, -0.2206739843142886),
    time=1.4856878371815403,
    support=(4.164188091545752e-06, 3.7962706654832477e-06),
)
POINT = Vector(-0.010746963997333244, -0.006894802410241252, 0.00024927428679377933)


def test_a_contact_that_runs_fast_stays_on_the_surface() -> None:
    motion = tr.FreeAxle(0.110672, bearing_torque=0.000330105)
    bowl = tr.Support(tr.Bowl(RADIUS), friction=0.0222479, motion=motion)
    system = tr.RollingSystem(tr.Body.ring(0.0127847, 0.0118486), bowl)
    begun: Any = slip_onset(system, ContactState.of(system, BEGINS_TO_SLIP, POINT))
    point = begun.at.contact.point
    assert (point - POINT).norm() > 1e-10  # it has moved
    assert abs((point - E_Z * RADIUS).norm() - RADIUS) < 1e-15
