"""A motion followed by the fields alone, by SciPy's method and its search for events, is that of a run."""

from __future__ import annotations

from dataclasses import dataclass
from dataclasses import field as dataclass_field
from importlib.util import find_spec
from itertools import groupby
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.tolerances import EXACT

import trundle as tr
from trundle.errors import OutOfDomainError
from trundle.fields import VectorField
from trundle.fields.compiler import compiler
from trundle.fields.routines import starting_phase

LANGUAGES = [*(["jax"] if find_spec("jax") else []), *(["c"] if compiler() else [])]
BALL = tr.Body.solid_sphere(0.02, 0.1)
ROUGH = tr.Support(tr.Plane(), friction=0.2)
SHIPPED = {
    "billiard-swerve": 1.0,
    "bouncing-ball-with-backspin": 4.0,
    "incline-with-slip": 1.0,
    "loop-the-loop-too-slow": 1.0,
    "off-the-rim": 10.0,
    "rocking-hemisphere-over-its-edge": 2.0,
    "roll-off-a-sphere": 1.1,
    "roll-off-a-sphere-slipping": 1.1,
    "superball": 4.0,
    "tippe-top": 1.5,
    "turntable-drop": 4.0,
}
# Against resistance to rolling a body may slip and be kept from turning.
RESISTED = {
    "it slides, stops turning, and comes to rest": (
        tr.RollingSystem(BALL, ROUGH, (tr.RollingResistance(0.015),)),
        {"velocity": (1.0, 0.0), "angular_velocity": (0.0, -2.0, 3.0)},
        1.0,
        ["slipping", "held_slipping"],
    ),
    "it slides with backspin, rolls, and comes to rest": (
        tr.RollingSystem(BALL, ROUGH, (tr.RollingResistance(2e-3),)),
        {"velocity": (0.3, 0.0), "angular_velocity": (0.0, -20.0, 0.0)},
        2.0,
        ["slipping", "rolling", "rest"],
    ),
    "it is pushed to and fro": (
        tr.RollingSystem(BALL, ROUGH, (tr.RollingResistance(0.015), tr.Force(("0.3*sin(3*t)", "0.1*cos(2*t)", 0.0)))),
        {},
        2.5,
        ["rest", "held_slipping", "rest", "held_slipping", "rest", "held_slipping"],
    ),
    "a torque makes it turn while it slips": (
        tr.RollingSystem(BALL, ROUGH, (tr.RollingResistance(0.006), tr.Torque((0.0, "0.008*t", 0.0)))),
        {"velocity": (1.5, 0.0), "angular_velocity": (0.0, 0.0, 0.0)},
        0.7,
        ["held_slipping", "slipping", "rolling"],
    ),
    "it stops turning on ice": (
        tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=0.0), (tr.RollingResistance(1e-3),)),
        {"velocity": (0.3, 0.1), "angular_velocity": (5.0, -20.0, 4.0)},
        1.0,
        ["slipping", "held_slipping"],
    ),
    "dropped straight down, it stays where it lands": (
        tr.RollingSystem(BALL, ROUGH, (tr.RollingResistance(1e-3),)),
        {"height": 0.1, "angular_velocity": (0.0, 0.0, 0.0)},
        0.5,
        ["flight", "rest"],
    ),
    "it slides in a bowl": (
        tr.RollingSystem(
            BALL, tr.Support(tr.Bowl(0.3), friction=0.2, kinetic_friction=0.1), (tr.RollingResistance(0.015),)
        ),
        {"position": (0.15, 0.0), "velocity": (0.0, 0.3), "angular_velocity": (0.0, 0.0, 0.0)},
        2.0,
        ["held_slipping", "rest"],
    ),
    "thrown, it lands turning and goes on": (
        tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=0.3), (tr.RollingResistance(1e-3),)),
        {"height": 0.1, "velocity": (0.5, 0.0, 0.0), "angular_velocity": (0.0, 0.0, 2.0)},
        1.5,
        ["flight", "rolling"],
    ),
}


@dataclass
class Course:
    """Where a body is at the sampled times, and what ended each phase: the field, the event, the time and the state."""

    rows: dict[float, Any] = dataclass_field(default_factory=dict)
    passed: list[tuple[VectorField, str, float, Any]] = dataclass_field(default_factory=list)

    @property
    def phases(self) -> list[str]:
        return [field.phase for field, *_ in self.passed]


def crossing(field: VectorField, i: int, e: list[Any]) -> Any:
    """Return an event function as SciPy takes it."""

    def value(t: float, y: Any, p: Any, u: Any) -> float:
        return float(field.events(t, y, p, u, *e)[i])

    value.__dict__.update(terminal=True, direction=-1.0)
    return value


def followed(field: VectorField, y: Any, times: Any) -> Course:
    """Follow a state through what a field and its resets say."""
    t, end, found = float(times[0]), float(times[-1]), Course()
    while True:
        p, u = field.parameters, field.inputs
        e = [] if field.event_parameters is None else [field.event_parameters(t, y, p, u)]
        here = np.asarray(field.events(t, y, p, u, *e))
        broken = [name for name, value in zip(field.event_names, here, strict=True) if value < 0 and name != "land"]
        if broken:
            at, where, event = t, y, broken[0]
        else:
            run = solve_ivp(
                field.rates,
                (t, end),
                y,
                method="DOP853",
                rtol=1e-12,
                atol=1e-13,
                max_step=(end - times[0]) / 40,  # at rest it would pass over what falls below zero and comes back
                dense_output=True,
                args=(p, u),
                events=[crossing(field, i, e) for i in range(len(field.event_names))],
            )
            for time in times[(times >= t) & (times <= run.t[-1])]:
                found.rows[float(time)] = np.asarray(field.outputs(time, run.sol(time), p, u))[:6]
            if run.status == 0:
                return found
            which = next(i for i, each in enumerate(run.t_events) if each.size)
            at, where, event = run.t_events[which][0], run.y_events[which][0], field.event_names[which]
        t = float(at)
        found.passed.append((field, event, t, where))
        try:
            field, y = field.after(event, t, where, p, u)
        except OutOfDomainError:
            return found


def compared(system: tr.RollingSystem, start: tr.State, duration: float) -> Course:
    """Compare a run with what the fields make of its start: a slip begins there with a billionth of the speeds."""
    run = tr.simulate(system, start, duration=duration, every=duration / 40)
    field = system.vector_field("numpy", starting_phase(system, start), ())
    times = run.data.time.values
    found = followed(field, field.pack(start), times)
    assert set(found.rows) >= set(times[:-1].tolist())
    known = np.hstack([run.data.position.values, run.data.velocity.values])
    for time, row in zip(times.tolist(), known, strict=True):
        if time in found.rows:
            assert np.abs(found.rows[time] - row).max() <= 1e-8 * np.abs(known).max(), (time, found.phases)
    return found


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_scenario_goes_as_its_fields(name: str) -> None:
    scenario = tr.Scenario.load(name)
    compared(scenario.system(), scenario.start_state(), SHIPPED[name])


@pytest.mark.parametrize("name", RESISTED)
def test_a_resisted_body_goes_as_its_fields(name: str) -> None:
    system, placed, duration, phases = RESISTED[name]
    found = compared(system, system.place(**placed), duration)
    assert [phase for phase, _ in groupby([*found.phases, *phases[-1:]])] == phases
    for field, event, t, y in found.passed[:3]:  # what follows, too, is the same in the other languages
        reference = outcome(field, event, t, y)
        for backend in (*LANGUAGES, *(["numba"] if "torque" in name else [])):
            follows, state = outcome(system.vector_field(backend, field.phase, ()), event, t, y)
            assert follows == reference[0], (backend, event)
            assert np.abs(state - reference[1]).max(initial=0.0) <= EXACT(256, 1.0), (backend, event)


def outcome(field: VectorField, event: str, t: float, y: Any) -> tuple[str, Any]:
    """Return the phase that follows, and its state; none, where the motion ends."""
    try:
        follows, state = field.after(event, t, y, field.parameters, field.inputs)
    except OutOfDomainError:
        return "", np.zeros(0)
    return follows.phase, np.asarray(state)
