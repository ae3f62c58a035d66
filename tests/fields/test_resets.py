"""What follows an event is what follows it in a run, and what a formula says."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.tolerances import EXACT

import trundle as tr
from trundle.errors import InvalidValueError, OutOfDomainError, UnknownNameError
from trundle.fields import VectorField
from trundle.fields.compiler import compiler
from trundle.fields.touching import CODES
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.contact import contact_at
from trundle.mechanics.impact import land
from trundle.simulation.trajectory import Event

BACKENDS = ("numpy", "numba", "jax", "c")
PHASES = {code: phase for phase, code in CODES.items()}
ROUGH = tr.Support(tr.Plane(), friction=0.3, restitution=0.6)
FLOOR = tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), ROUGH)


def fields(system: tr.RollingSystem, backend: str, phase: str) -> VectorField:
    if backend == "c" and compiler() is None:
        pytest.skip("no C compiler is found here")
    if backend == "jax":
        pytest.importorskip("jax", reason="the extra jax is not installed")
    return system.vector_field(backend, phase, ())


def coming_down(along: float, down: float) -> tr.State:
    """Return a ball of 0.1 m that touches the floor, and does not turn."""
    return tr.State((0.0, 0.0, 0.1), (along, 0.0, down), (0.0, 0.0, 0.0))


def meant(field: VectorField, state: Any) -> dict[str, Any]:
    """Return place, turning and slip, or velocity, of a state in numbers."""
    return dict(zip(field.state_names, np.asarray(state).tolist(), strict=True))


RUNS = {
    "bouncing ball": (FLOOR, {"height": 0.5, "velocity": (1.0, 0.2, 0.0), "angular_velocity": (3.0, 40.0, 5.0)}, 3.0),
    "thrown egg without friction": (
        tr.RollingSystem(
            tr.Body.ellipsoid((0.2, 0.15, 0.12), mass=1.0), tr.Support(tr.Plane(), friction=0.0, restitution=0.7)
        ),
        {"height": 0.3, "velocity": (0.5, 0.0, 0.0), "orientation": (0.9, 0.2, 0.1, 0.3)},
        0.8,
    ),
    "egg on a rough floor": (
        tr.RollingSystem(tr.Body.ellipsoid((0.2, 0.15, 0.12), mass=1.0), ROUGH),
        {"height": 0.3, "velocity": (0.5, 0.0, 0.0), "orientation": (0.9, 0.2, 0.1, 0.3)},
        0.6,
    ),
    "superball": (
        tr.RollingSystem(
            tr.Body.solid_sphere(0.1, 2.0),
            tr.Support(tr.Plane(), friction=0.5, restitution=0.9, tangential_restitution=0.8),
        ),
        {"height": 0.3, "velocity": (0.5, 0.0, 0.0)},
        1.0,
    ),
    "ball on a turntable that turns freely": (
        tr.RollingSystem(
            tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane(), motion=tr.FreeAxle(0.5, rate=3.0), restitution=0.6)
        ),
        {"position": (0.3, 0.0), "height": 0.3, "velocity": (0.4, 1.0, 0.0)},
        1.2,
    ),
    "ball that swerves": (
        tr.RollingSystem(tr.Body.solid_sphere(0.03, 0.17), tr.Support(tr.Plane(), friction=0.2)),
        {"velocity": (1.0, 0.5), "angular_velocity": (10.0, -30.0, 4.0)},
        2.0,
    ),
    "ball off a turning dome": (
        tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Dome(0.5), motion=tr.Spin(0.5), friction=0.4)),
        {"position": (0.05, 0.0), "velocity": (0.2, 0.0)},
        2.0,
    ),
    "ball that comes to rest and is pushed on": (
        tr.RollingSystem(
            tr.Body.solid_sphere(0.02, 0.1),
            tr.Support(tr.Plane(), friction=0.5),
            (tr.RollingResistance(1e-3), tr.Force(("0.1*sin(2*t)", 0.0, 0.0))),
        ),
        {"velocity": (0.01, 0.0)},
        1.0,
    ),
}


def followed(run: tr.Trajectory) -> list[tuple[str, str, Event]]:
    """Return the phase before each event of a run and after it."""
    phase = run.data.phase.values
    found = []
    for event in run.events:
        where = int(np.searchsorted(run.data.time.values, event.time))
        if event.after is not None and 0 < where < phase.size - 1:
            found.append((PHASES[int(phase[where - 1])], PHASES[int(phase[where])], event))
    return found


@pytest.mark.parametrize("name", RUNS)
def test_what_follows_an_event_is_what_follows_it_in_a_run(name: str) -> None:
    system, placed, duration = RUNS[name]
    start = system.place(**placed)
    run = tr.simulate(system, start, duration=duration, every=1e-3)
    seen = set()
    for before, after, event in followed(run):
        kind = "land" if event.kind == "settle" else event.kind  # a landing after which the bounce is cut
        field = system.vector_field("numpy", before, ())
        if kind not in field.resets and kind != "land":
            continue
        y = field.pack(event.before)
        if before == "slipping" and event.kind == "grip":
            y[10:13] = 0.0
            y[10] = 1e-14  # all but ended
        found, state = field.after(kind, event.time, y, field.parameters, field.inputs)
        assert event.after is not None
        reference = found.pack(event.after)
        size = np.abs(reference).max()
        if event.kind in ("slip", "start"):  # from nothing, and the way that the run goes on
            begins = slice(10, 13) if event.kind == "slip" else slice(7, 10)
            later = found.pack(run.samples.state(int(np.searchsorted(run.data.time, event.time)) + 5))[begins]
            little = state[begins] - (0.0 if event.kind == "slip" else reference[begins])
            assert 0 < np.abs(little).max() <= 1e-4 * np.abs(later).max()
            assert little @ later >= 0.99 * np.linalg.norm(little) * np.linalg.norm(later)
            state[begins] = reference[begins] = 0.0
        assert found.phase == ("flight" if "bounced" in event.text else after)  # perhaps for less than a sample
        assert np.abs(state - reference).max() <= 1e-8 * size, event.text
        seen.add((before, event.kind, found.phase))
    assert seen


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_ball_that_lands_without_slipping_keeps_five_sevenths(backend: str) -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane(), restitution=0.5))
    field = fields(system, backend, "flight")
    y = field.pack(coming_down(1.0, -3.0))
    found, state = field.after("land", 0.0, y, field.parameters, field.inputs)
    now = meant(found, state)
    assert found.phase == "flight"
    assert now["V_x"] == pytest.approx(5 / 7, abs=EXACT(16, 1))
    assert now["V_z"] == pytest.approx(1.5, abs=EXACT(16, 3))
    assert now["Omega_y"] * 0.1 == pytest.approx(5 / 7, abs=EXACT(16, 1))


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_ball_that_slips_as_it_lands_is_slowed_by_the_friction_of_the_impulse(backend: str) -> None:
    """Of a fall of 1 m/s with e = 0.6, friction 0.3 takes μ (1 + e) v from the sliding: 0.48 m/s."""
    field = fields(FLOOR, backend, "flight")
    y = field.pack(coming_down(3.0, -1.0))
    found, state = field.after("land", 0.0, y, field.parameters, field.inputs)
    assert found.phase == "flight"
    assert meant(found, state)["V_x"] == pytest.approx(3.0 - 0.48, abs=EXACT(16, 3))


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("friction", [None, 0.7, 0.15, 0.05])
def test_a_ball_gives_back_what_friction_can(friction: float | None, backend: str) -> None:
    """An impulse P changes the slip by 7/2 P/m: (1 + e_t) of what ends it is given, or μ (1 + e) v m, what is less.

    There is as much friction as one likes, enough, too little for all of it, and too little to end the slip.
    """
    support = tr.Support(tr.Plane(), friction=friction, restitution=0.8, tangential_restitution=0.8)
    field = fields(tr.RollingSystem(FLOOR.body, support), backend, "flight")
    y = field.pack(coming_down(2.0, -3.0))
    found, state = field.after("land", 0.0, y, field.parameters, field.inputs)
    now = meant(found, state)
    impulse = min(1.8 * 2.0 / 3.5, math.inf if friction is None else friction * 1.8 * 3.0)
    assert found.phase == "flight"
    assert now["V_x"] == pytest.approx(2.0 - impulse, abs=EXACT(16, 2))
    assert now["Omega_y"] * 0.1 == pytest.approx(2.5 * impulse, abs=EXACT(32, 2))


TURNS = {
    "it goes on slipping": ({"friction": 0.2, "restitution": 0.5}, (0.5, -0.2, -2.0)),
    "it sticks on the way": ({"friction": 0.7, "restitution": 0.3}, (0.3, 0.2, -3.0)),
    "some of the slip is given back": (
        {"friction": 0.9, "restitution": 0.6, "tangential_restitution": 0.7},
        (0.3, 0.2, -3.0),
    ),
    "without limit, and given back": ({"restitution": 0.6, "tangential_restitution": 0.7}, (0.3, 0.2, -3.0)),
    "slip ends, and begins the other way": ({"friction": 0.05, "restitution": 0.8}, (0.02, 0.01, -2.0)),
}


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_landing_that_turns_the_slip_is_that_of_a_run(backend: str) -> None:
    """`mechanics.impact.land` follows the same course by branches, and by series of more terms."""
    egg = tr.Body.ellipsoid((0.2, 0.15, 0.12), mass=1.0, centre=(0.02, -0.01, 0.03))
    turned, made = (0.8, 0.36, 0.48, 0.0), dict[Any, VectorField]()
    for name, (given, velocity) in TURNS.items():
        if backend != "numpy" and "friction" not in given:  # another function, which takes its time to be compiled
            continue
        system = tr.RollingSystem(egg, tr.Support(tr.Plane(), **given))
        # One structure, one function: numbers are parameters.
        field = made.setdefault("friction" in given, fields(system, backend, "flight"))
        slips = tr.RollingSystem(egg, tr.Support(tr.Plane(), friction=1.0))
        y = field.pack(slips.place(velocity=velocity, orientation=turned, angular_velocity=(0.0, 0.0, 0.0)))
        p = system.vector_field("numpy", "flight", ()).parameters
        contact = contact_at(system, 0.0, Vector(*y[:3]), Quaternion(*turned))
        struck = land(system, contact, Quaternion(*turned), Vector(*velocity)).velocity_change
        state = np.asarray(field.resets["land"].states["flight"](0.0, y, p, field.inputs))
        V = state[[field.state_names.index(f"V_{axis}") for axis in "xyz"]] - velocity
        assert np.abs(V - struck.array()).max() <= 1e-12 * np.abs(struck.array()).max(), name


def test_landings_by_the_thousand_are_those_of_each() -> None:
    egg = tr.Body.ellipsoid((0.2, 0.15, 0.12), mass=1.0, centre=(0.02, -0.01, 0.03))
    system = tr.RollingSystem(egg, tr.Support(tr.Plane(), friction=0.3, restitution=0.5))
    field = system.vector_field("numpy", "flight", ())
    y = field.pack(system.place(velocity=(0.5, -0.2, -2.0), orientation=(0.8, 0.36, 0.48, 0.0)))
    many = np.tile(y, (7, 1))
    many[:, field.state_names.index("V_x")] = np.linspace(-1.0, 1.0, 7)
    land_ = field.resets["land"].states["flight"]
    found = land_(0.0, many, field.parameters, field.inputs)
    for one, state in zip(many, found, strict=True):
        assert np.abs(state - land_(0.0, one, field.parameters, field.inputs)).max() <= EXACT(64, 2.0)


@pytest.mark.parametrize("backend", BACKENDS)
def test_it_stays_where_nothing_is_given_back(backend: str) -> None:
    for speed, phase in ((0.1, "rolling"), (30.0, "slipping")):
        system = tr.RollingSystem(FLOOR.body, tr.Support(tr.Plane(), friction=0.3))
        field = fields(system, backend, "flight")
        y = field.pack(coming_down(speed, -1.0))
        assert field.after("land", 0.0, y, field.parameters, field.inputs)[0].phase == phase


@pytest.mark.parametrize("backend", BACKENDS)
def test_slip_begins_against_friction_and_ends_in_rolling(backend: str) -> None:
    system = tr.RollingSystem(FLOOR.body, tr.Support(tr.Plane(), tilt=1.0, friction=0.3))
    field = fields(system, backend, "rolling")
    y = field.pack(system.place())
    slips, state = field.after("slip", 0.0, y, field.parameters, field.inputs)
    now = meant(slips, state)
    assert now["s_x"] > 0
    assert abs(now["s_y"]) + abs(now["s_z"]) <= EXACT(16, now["s_x"])
    level = fields(FLOOR, backend, "slipping")
    rolls, state = level.after("grip", 0.0, state, level.parameters, level.inputs)
    assert rolls.phase == "rolling"
    assert np.array_equal(state, y)


def test_what_is_not_written_out_is_said() -> None:
    egg = tr.RollingSystem(tr.Body.ellipsoid((0.2, 0.15, 0.12), mass=1.0), ROUGH)
    field = egg.vector_field("c", "flight")
    given = (0.0, field.pack(egg.place(height=0.1)), field.parameters, field.inputs)
    bounded = tr.RollingSystem(egg.body, tr.Support(tr.Plane(rim=0.5))).vector_field("numpy")
    with pytest.raises(OutOfDomainError, match="the run ends there"):
        bounded.after("rim", 0.0, bounded.pack(egg.place()), bounded.parameters, bounded.inputs)
    resisted = tr.RollingSystem(FLOOR.body, ROUGH, (tr.RollingResistance(1e-3),)).vector_field("numpy")
    spinning = resisted.pack(FLOOR.place(spin=3.0))
    with pytest.raises(OutOfDomainError, match="the run ends there"):
        resisted.after("stop", 0.0, spinning, resisted.parameters, resisted.inputs)
    with pytest.raises(UnknownNameError, match="There are: land"):
        field.after("lend", *given)
    with pytest.raises(OutOfDomainError, match="leaves out what follows an event"):
        _ = egg.vector_field("sympy").resets
    with pytest.raises(OutOfDomainError, match="cannot be called from Python"):
        _ = egg.vector_field("javascript").rates
    with pytest.raises(InvalidValueError, match="may have: rolling, slipping, flight; got 'rest'"):
        egg.vector_field("numpy", "rest")
    for what, words in (
        (("fortran",), "backend"),
        (("c", "sinking"), "phase"),
        (("c", "rolling", ("wind",)), "inputs"),
    ):
        with pytest.raises(UnknownNameError, match=words):
            egg.vector_field(*what)
