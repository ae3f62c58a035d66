"""What the compiler is given is the law, also after a million seconds; putting p and q right moves nothing else."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Matrix, Quaternion, Vector
from trundle.mechanics.parameters import numbers
from trundle.solve import integrators, taylor
from trundle.solve.charts import LineOfNodes, SupportAxes, charts
from trundle.solve.laws import FlightLaw, Law, RestingLaw, RollingLaw, SlippingLaw
from trundle.solve.lowering import lower

BALL = tr.Body.solid_sphere(radius=0.1, mass=0.3)
EGG = tr.Body.ellipsoid((0.2, 0.15, 0.12), mass=1.0, turn="2 deg")
BOWL = tr.EllipsoidalBowl((0.5, 0.4, 0.3))
GIVEN = tr.Force(("0.1*sin(3*t)", 0.0, "0.01*t"))

SYSTEMS = {
    "egg on a plane": tr.RollingSystem(EGG, tr.Support(tr.Plane(), tilt=0.1, friction=0.2)),
    "ball in a spinning bowl": tr.RollingSystem(BALL, tr.Support(BOWL, motion=tr.Spin(1.5), friction=0.4)),
    "egg on a turntable under a given force": tr.RollingSystem(
        EGG, tr.Support(tr.Plane(), motion=tr.Spin(-0.7), friction=0.3), (GIVEN,)
    ),
    "ball in a shaken bowl": tr.RollingSystem(
        BALL, tr.Support(BOWL, motion=tr.Shake((0.01, 0.0, 0.002), 18.0), friction=0.5)
    ),
    "ball in a tilting spherical bowl": tr.RollingSystem(
        BALL, tr.Support(tr.Bowl(0.5), motion=tr.Rock("6 deg", 2.0), friction=0.4)
    ),
    "egg on a spinning dome": tr.RollingSystem(EGG, tr.Support(tr.Dome(0.9), motion=tr.Spin(1.1), friction=0.4)),
    "ball in a shaken trough": tr.RollingSystem(
        BALL, tr.Support(tr.Cylinder(0.5), motion=tr.Shake((0.01, 0.0, 0.002), 18.0), tilt="90 deg", friction=0.4)
    ),
    "ball in a tube round a ring": tr.RollingSystem(BALL, tr.Support(tr.TorusTrack(0.9, 0.2), friction=0.4)),
    "egg in a funnel": tr.RollingSystem(EGG, tr.Support(tr.Cone("60 deg"), motion=tr.Spin(-2.0), friction=0.4)),
    "egg on a precessing tilt": tr.RollingSystem(
        EGG, tr.Support(tr.Plane(), motion=tr.PrecessingTilt(0.1, 0.8), friction=0.3)
    ),
}
LAWS = {"rolling": RollingLaw(), "slipping": SlippingLaw(), "flight": FlightLaw(), "resting": RestingLaw()}


def numbers_of(law: Law, system: tr.RollingSystem, time: float) -> list[float]:
    """Return some state of a law, whose contact is on the support."""
    support = system.support.motion.at(time)
    contact = support.origin + support.rotation @ system.support.surface.point(0.11, -0.07)
    q = np.array([0.9, 0.2, -0.3, 0.1])
    more = {"slipping": (0.3, -0.2, 0.1), "flight": (0.3, -0.2, 0.1, 0.02, 0.13, -0.08, 0.21)}
    name = next(name for name, known in LAWS.items() if known is law)
    return [*contact, *(q / np.linalg.norm(q)), 1.3, -0.7, 2.1, *more.get(name, ())]


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize("phase", LAWS)
@pytest.mark.parametrize(("reference", "later"), [(0.0, 0.3), (2.75, 0.0), (2.75, 0.3)])
def test_what_is_compiled_is_the_law(name: str, phase: str, reference: float, later: float) -> None:
    system, law = SYSTEMS[name], LAWS[phase]
    time, event_parameters = reference + later, [0.7, 0.2, -0.4, 0.5][: law.event_parameters]
    state, ready = numbers_of(law, system, time), lower(system, law)
    found = ready.tape.function(ready.outputs)(
        [later, *state, *ready.values([*numbers(system), *event_parameters], reference)]
    )
    stops = law.event_functions(system, time, state, event_parameters)
    wanted = [*law.rates(system, time, state), *(stops[name] for name in ready.event_functions)]
    elsewhere = numbers_of(law, system, time + 0.7)
    other = law.event_functions(
        system, time + 0.7, [*elsewhere[:7], *(2 * part for part in elsewhere[7:])], event_parameters
    )
    left_out = set(stops) - set(ready.event_functions)  # what never changes
    assert all(other[name] == pytest.approx(stops[name], abs=1e-15) for name in left_out)
    scale = max(abs(value) for value in wanted)
    assert np.abs(np.array(found) - wanted).max() <= EXACT(300, scale)


@pytest.mark.parametrize("phase", LAWS)
def test_another_radius_tilt_or_rate_is_the_same_equations(phase: str) -> None:
    pytest.importorskip("heyoka")
    law, system = LAWS[phase], SYSTEMS["ball in a spinning bowl"]
    support = replace(system.support, motion=tr.Spin(-3.0), tilt=0.2)
    other = replace(system, body=tr.Body.hollow_sphere(0.05, 2.0), support=support)

    def key(system: tr.RollingSystem) -> str:
        ready = lower(system, law)
        return integrators._key(*ready.heyoka(), 1e-15, ready.parameters)

    assert key(system) == key(other)


def test_whole_turns_are_dropped_exactly() -> None:
    rate, time = 1.7, 1e7 / 3
    table = tr.RollingSystem(BALL, tr.Support(BOWL, motion=tr.Spin(rate)))
    ready = lower(table, RollingLaw())
    with mpmath.workdps(40):
        angle = mpmath.mpf(rate) * mpmath.mpf(time)
        c, s = float(mpmath.cos(angle)), float(mpmath.sin(angle))
    assert abs(math.sin(rate * time) - s) > 1e-10  # what a float of the angle gives
    values = ready.values(numbers(table), time)
    for wanted in (c, s):
        assert min(abs(value - wanted) for value in values) <= EXACT(1, 1.0)


def turned(start: tr.State, angle: float, time: float) -> tr.State:
    """Turn a whole state about the vertical."""
    c, s = math.cos(angle), math.sin(angle)
    about = Quaternion(math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2))

    def vector(v: Any) -> tuple[float, ...]:
        return (c * v[0] - s * v[1], s * v[0] + c * v[1], v[2])

    return tr.State(
        vector(start.position),
        vector(start.velocity),
        vector(start.angular_velocity),
        tuple(about * Quaternion(*start.orientation)),
        time,
    )


def test_a_bowl_that_has_turned_for_a_million_seconds_is_known_as_well_as_a_fresh_one() -> None:
    pytest.importorskip("heyoka")
    rate, late = 1.5, 1e6
    with mpmath.workdps(40):
        angle = float(mpmath.fmod(mpmath.mpf(rate) * late, 2 * mpmath.pi))
    system = tr.RollingSystem(BALL, tr.Support(BOWL, motion=tr.Spin(rate)))
    start = system.place((0.1, 0.05), (0.1, 0.2), spin=1.0)
    times = np.linspace(0.0, 20.0, 321)  # sixteenths of a second: 10⁶ s more is still exact
    fresh = taylor.solve(system, start, times)
    old = taylor.solve(system, turned(start, angle, late), late + times)
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = fresh.contact.T
    moved = np.stack([c * x - s * y, s * x + c * y, z], axis=1)
    assert np.abs(old.contact - moved).max() <= SOLVER(100, taylor.TOLERANCE)


class PlainBowl(tr.Bowl):
    """A bowl whose level is the very length that is known on it."""

    def level(self, p: Vector) -> Any:
        return self.radius - self._arm(p).norm()


def test_what_is_known_on_the_support_is_not_taken_for_known_of_a_point_that_is_put_there() -> None:
    system, law = tr.RollingSystem(BALL, tr.Support(PlainBowl(0.5))), LAWS["rolling"]
    state, ready = numbers_of(law, system, 0.0), lower(system, law)
    off = [state[0], state[1], state[2] + 1e-9, *state[3:]]
    tidied = ready.tidy([0.0, *off, *ready.values(numbers(system), 0.0)])
    assert abs(system.support.surface.level(Vector(*off[:3]))) > 1e-10
    assert abs(system.support.surface.level(Vector(*tidied[:3]))) <= EXACT(4, 1.0)


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize("phase", LAWS)
def test_tidying_puts_the_contact_on_the_support_and_leaves_the_rest(name: str, phase: str) -> None:
    system, law, time = SYSTEMS[name], LAWS[phase], 1.25
    ready, support = lower(system, law), system.support.motion.at(time)
    parameters = ready.values([*numbers(system), *[0.0] * law.event_parameters], time)

    def level(p: Any) -> float:
        return float(system.support.surface.level(support.rotation.transpose @ (Vector(*p) - support.origin)))

    right = numbers_of(law, system, time)
    off = np.array(right)
    off[:3] += (3e-10, -2e-10, 4e-10)
    off[3:7] *= 1 + 1e-9
    tidied = ready.tidy([0.0, *off, *parameters])
    assert abs(level(off[:3])) > 1e-11
    assert abs(level(tidied[:3])) <= EXACT(4, 1.0)
    assert abs(math.hypot(*tidied[3:7]) - 1) <= EXACT(2, 1.0)
    assert tidied[7:] == right[7:]
    assert np.abs(np.array(tidied[:3]) - off[:3]).max() <= abs(level(off[:3])) * 1.01  # along the normal, no further


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize("phase", LAWS)
def test_of_what_p_and_q_are_off_the_law_sees_the_square(name: str, phase: str) -> None:
    # Of |q| that is off by ε, the law of an egg is off by as much: over a thousand radians, a thousand times ε.
    system, law, time, off_by = SYSTEMS[name], LAWS[phase], 1.25, 1e-5
    support, surface = system.support.motion.at(time), system.support.surface
    for chart in charts(system, law):
        if isinstance(chart, LineOfNodes):  # it has neither
            continue
        ready = lower(system, law, chart)
        right = np.array(chart.of_law(system, time, numbers_of(law, system, time)))
        off, k = right.copy(), ready.names.index("q_w")
        if k == 3:
            axes, origin = support.rotation, support.origin
            if isinstance(chart, SupportAxes):
                axes, origin = Matrix.identity(), Vector(0.0, 0.0, 0.0)
            there = axes.transpose @ (Vector(*right[:3]) - origin) + off_by * Vector(0.4, -0.3, 0.9)
            off[:3] = (origin + axes @ there).array()
            right[:3] = (origin + axes @ (there + surface.correction(there))).array()
        off[k : k + 4] *= 1 + off_by
        of = ready.tape.function(ready.outputs)
        given = ready.values([*numbers(system), *[0.5] * law.event_parameters], time)
        wanted, found = (np.array(of([0.0, *state, *given])) for state in (right, off))
        found[k : k + 4] /= 1 + off_by
        moving = slice(0, len(ready.names))  # of the event functions some say how far p is from an end
        assert np.abs(found - wanted)[moving].max() <= 200 * off_by**2 * max(1.0, np.abs(wanted).max()), chart
