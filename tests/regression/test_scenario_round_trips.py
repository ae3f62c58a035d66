"""What is made in Python, written as a scenario and read again is the same system, start and run, to the last digit."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.errors import ScenarioError
from trundle.scenario import ScenarioFile, files

BALL = tr.Body.solid_sphere(radius=0.02, mass=0.26)
EGG = tr.Body.shape_formula("0.025 + 0.003*nu_z + 0.004*nu_z**2", density=1030)
CHAPLYGIN = tr.Body.eccentric_sphere(0.02, 0.3, (3e-5, 4e-5, 5e-5), (0.002, -0.001, 0.003))
BODIES: dict[str, tuple[tr.Body, dict[str, Any]]] = {  # and how it is put down
    "solid sphere": (BALL, {"spin": 0.7}),
    "shell, turned": (tr.Body.hollow_sphere(0.02, 0.0027), {"orientation": (0.1, 0.2, 0.3, 0.4)}),
    "eccentric sphere": (CHAPLYGIN, {"orientation": (0.5, 0.5, -0.5, 0.5), "spin": -2.0}),
    "eccentric sphere, by its attitude": (CHAPLYGIN, {"attitude": (0.3, 1.2, -0.4), "spin": 3.0}),
    "hemisphere": (tr.Body.hemisphere(0.05, density=1200), {"attitude": (0.0, 0.3, 0.0)}),
    "disc": (tr.Body.disc(0.012, mass=0.0075), {"attitude": ("30 deg", "80 deg", 0.0), "spin": 1.5}),
    "ring": (tr.Body.ring(0.3, 1), {"attitude": (0.0, "90 deg", 0.0)}),
    "torus": (tr.Body.torus(0.2, 0.01, mass=1), {"attitude": (-1.0, 1.4, 2.0)}),
    "ellipsoid": (tr.Body.ellipsoid((0.2, 0.03, 0.02), density=1000, turn=0.1), {"attitude": (0.0, 0.01, 0.0)}),
    "formula": (EGG, {"attitude": (0.2, 0.9, 0.1), "spin": 4.0}),
}
STRAIGHT = [
    tr.Body.cylinder(0.03, 0.2, 0.4),
    tr.Body.hoop(0.03, 0.1),
    tr.Body.weighted_cylinder(0.05, 0.3, 0.1, 0.04),
    tr.Body.half_cylinder(0.05, density=1200, length=0.2),
]
SURFACES: dict[str, tuple[Any, tuple[Any, Any]]] = {  # and where on it
    "plane": (tr.Plane(rim=1.0), (0.1, -0.2)),
    "pipe": (tr.Cylinder(0.5), (0.7, 0.1)),
    "log": (tr.Cylinder(0.3, "outside"), (2.9, 0.1)),
    "bowl": (tr.Bowl(0.5, rim=0.4), (0.1, 0.2)),
    "dome": (tr.Dome(0.4), (-0.1, 0.05)),
    "funnel": (tr.Cone("40 deg"), (0.1, 0.2)),
    "hill": (tr.Cone(1.1, "outside", rim=1.0), (0.3, -0.1)),
    "paraboloid": (tr.Paraboloid(0.4), (0.1, 0.1)),
    "mound": (tr.Paraboloid(-0.4), (0.1, 0.3)),
    "elliptic bowl": (tr.EllipsoidalBowl((0.5, 0.4, 0.3)), (0.2, 0.1)),
    "torus track": (tr.TorusTrack(0.4, 0.1), (1.0, 0.4)),
    "revolution": (tr.Revolution("0.5*r2 + r2**2"), (0.1, 0.2)),
    "height field": (tr.HeightField("0.1*x**2 - 0.2*x*y"), (0.1, 0.2)),
}
MOTIONS = [
    tr.Spin(-1 / 3),
    tr.UnevenSpin(3.5, 0.01, 3.5),
    tr.Wobble(3.5, 0.002),
    tr.SpinBy("3.5*(1 - exp(-t/2))"),
    tr.FreeAxle(0.01, 2.0, "0.1*t", 1e-3, 2e-3),
    tr.Tilt("0.1*sin(2*t)", (1, 1, 0)),
    tr.Rock(0.05, 2.0, 0.3),
    tr.PrecessingTilt(0.05, 2.0),
    tr.Shake((0.002, 0.0, 0.001), 30.0, 0.1),
    tr.Move((0.0, "0.1*t**2", 0.05)),
    tr.Combined((tr.Shake((0.002, 0.0, 0.0), 30.0), tr.Spin(2.0))),
]
LOADS = [
    tr.Force((0.1, "0.01*t", 0.0)),
    tr.Torque((0.0, 1e-3, "1e-3*sin(t)")),
    tr.Drag(0.01, air=1 / 3),
    tr.QuadraticDrag(0.02),
    tr.Potential("0.5*3*(x**2 + y**2)"),
    tr.RollingResistance(5e-5),
    tr.PivotFriction(2e-5, 0.02),
    tr.RollingCouple(1e-5, 2e-5),
    tr.Magnus(1e-4),
    tr.Motor((0.0, 1e-3, "1e-3*t")),
]


def again(system: tr.RollingSystem, start: tr.State) -> ScenarioFile:
    told = ScenarioFile.describe(system, start, duration=0.1, every=0.01)
    read = ScenarioFile.loads(told.to_toml())
    assert read.system() == system
    return read


def near(back: tr.State, start: tr.State, ulps: float) -> None:
    """Compare two states to some units in the last place of each part's size, or of 1."""
    for part in ("position", "velocity", "angular_velocity", "orientation"):
        there, here = getattr(start, part), getattr(back, part)
        np.testing.assert_allclose(here, there, rtol=0, atol=EXACT(ulps, 1 + np.linalg.norm(there)))
    assert (back.time, back.support) == (start.time, start.support)


@pytest.mark.parametrize("name", BODIES)
def test_every_body_comes_back_to_the_last_digit(name: str) -> None:
    body, how = BODIES[name]
    system = tr.RollingSystem(body, tr.Support(tr.Plane(), tilt=0.1))
    start = system.place((0.1, -0.2), (0.03, 0.04), **how)
    assert again(system, start).start_state() == start


@pytest.mark.parametrize("body", STRAIGHT, ids=lambda body: f"{type(body.shape).__name__}, {body.mass:g} kg")
@pytest.mark.parametrize("surface", [tr.Plane(), tr.Cylinder(0.5)], ids=["plane", "trough"])
def test_what_rolls_straight_comes_back_to_the_last_digit(body: tr.Body, surface: tr.Surface) -> None:
    level = isinstance(surface, tr.Cylinder)
    system = tr.RollingSystem(body, tr.Support(surface, tilt=math.pi / 2 if level else 0.2))
    start = system.place((0.3, 0.0), (0.1, 0.0), roll=0.5)
    assert again(system, start).start_state() == start


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("body", ["solid sphere", "eccentric sphere", "formula"])
def test_every_surface_comes_back(name: str, body: str) -> None:
    """To the last digit where the place was said in a few; an eccentric body's contact is not under its centre."""
    surface, place = SURFACES[name]
    rolls, how = BODIES[body]
    system = tr.RollingSystem(rolls, tr.Support(surface, friction=0.7))
    start = system.place(place, (0.03, 0.04), **how)
    assert again(system, start).start_state() == start


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda motion: type(motion).__name__)
def test_every_motion_comes_back(motion: tr.Motion) -> None:
    """To the last digit on a plane; in a bowl that moves a velocity of 0 may come back as a rounding of the bowl's."""
    for surface, how in itertools.product((tr.Plane(), tr.Bowl(0.5)), ({}, {"velocity": "co-rotating"})):
        system = tr.RollingSystem(BALL, tr.Support(surface, motion=motion))
        start = system.place((0.1, 0.05), **how)
        near(again(system, start).start_state(), start, 0 if isinstance(surface, tr.Plane) else 4)


def _own_later(motion: tr.Motion) -> list[Any]:
    """Coordinates of the motion's own that it does not start with."""
    return [value + 0.3 * (i + 1) for i, value in enumerate(motion.initial_coordinates())]


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda motion: type(motion).__name__)
def test_a_later_instant_comes_back_with_where_the_support_stands_then(motion: tr.Motion) -> None:
    for surface in (tr.Plane(), tr.Bowl(0.5)):
        system = tr.RollingSystem(BALL, tr.Support(surface, motion=motion))
        start = system.place((0.1, 0.05), time="1.7 s", support=_own_later(motion) or None)
        assert start.time == 1.7
        near(again(system, start).start_state(), start, 4)


@pytest.mark.parametrize("motion", [*MOTIONS[1:5], MOTIONS[6], MOTIONS[8]], ids=lambda motion: type(motion).__name__)
@pytest.mark.parametrize("surface", [tr.Plane(), tr.EllipsoidalBowl((0.5, 0.4, 0.3))], ids=lambda s: type(s).__name__)
def test_a_run_written_down_half_way_goes_on_as_if_it_had_not_been(motion: tr.Motion, surface: tr.Surface) -> None:
    """Held to the run that was never interrupted; by Runge-Kutta, whose steps the interruption moves."""
    system = tr.RollingSystem(BALL, tr.Support(surface, motion=motion))
    whole = tr.simulate(system, system.place((0.05, 0.02), (0.03, 0.04)), 2.0, 0.5, "runge-kutta")
    half = whole.samples.state(2)
    assert half.time == 1.0
    told = tr.simulate(system, half, 1.0, 0.5, "runge-kutta").scenario
    on = tr.Scenario.loads(told or "").run()
    np.testing.assert_array_equal(on.data.time, [1.0, 1.5, 2.0])
    for part in ("position", "velocity", "angular_velocity"):
        here, there = on.data[part].values[-1], whole.data[part].values[-1]
        np.testing.assert_allclose(here, there, rtol=0, atol=SOLVER(1e3, 1e-12, 1 + np.linalg.norm(there)))


@pytest.mark.parametrize(
    ("start", "key", "said"),
    [
        ('support = ["0.3 rad"]', "start.support", "must hold angle, rate"),
        ('support = ["0.3 rad", "2 rad"]', "start.support[1]", "angular velocity"),
        ('support = ["2 rad/s", "2 rad/s"]', "start.support[0]", "angle"),
        ("support = []", "start.support", "list"),
        ('time = "2 m"', "start.time", "time"),
    ],
)
def test_a_wrong_instant_is_refused_by_its_key(start: str, key: str, said: str) -> None:
    text = tr.Scenario.load("free-turntable-ellipse").to_toml().replace("[start]", f"[start]\n{start}")
    with pytest.raises(ScenarioError, match=said) as caught:
        tr.Scenario.loads(text)
    assert caught.value.key == key


def test_a_support_that_has_no_motion_of_its_own_takes_no_coordinates() -> None:
    text = tr.Scenario.load("tilted-turntable").to_toml().replace("[start]", "[start]\nsupport = [0.3]")
    with pytest.raises(ScenarioError, match="function of the time alone"):
        tr.Scenario.loads(text)


def test_a_formula_must_be_finite_while_the_run_lasts_and_not_before() -> None:
    text = tr.Scenario.load("turntable-starting-up").to_toml()
    spin = text.replace('"3.5*(1 - exp(-t/2))"', '"1/(t - 1)"')
    assert spin != text, "the scenario has another formula"
    with pytest.raises(ScenarioError, match="t = 1"):
        tr.Scenario.loads(spin)
    later = tr.Scenario.loads(spin.replace("[start]", '[start]\ntime = "1.5 s"'))
    assert np.isfinite(later.run(duration=0.5, every=0.1).data.position).all()


@pytest.mark.parametrize("load", LOADS, ids=lambda load: type(load).__name__)
def test_every_load_comes_back_to_the_last_digit(load: tr.Load) -> None:
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(2.0)), (load,))
    start = system.place((0.1, -0.2), (0.03, 0.04))
    assert again(system, start).start_state() == start


ROUGH: dict[str, Any] = {"friction": 0.3, "kinetic_friction": 0.2, "restitution": 0.6}


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize(
    "how",
    [
        {"velocity": (0.5, -0.2), "angular_velocity": (0.0, 30.0, -2.0)},  # slips
        {"height": 0.02, "velocity": (0.5, -0.2)},  # falls
        {"height": 0.02, "velocity": (0.5, -0.2, 1.5), "spin": 3.0},  # is thrown up
        {"height": 0.05, "velocity": (0.0, 0.0, -1.0), "angular_velocity": (1.0, 2.0, 3.0)},
        {"velocity": (0.1, 0.2, 2.0), "angular_velocity": (1.0, 2.0, 3.0)},  # jumps off
    ],
    ids=["slips", "falls", "is thrown", "is thrown down", "jumps"],
)
def test_a_start_that_slips_or_flies_comes_back(name: str, how: dict[str, Any]) -> None:
    surface, place = SURFACES[name]
    system = tr.RollingSystem(BALL, tr.Support(surface, motion=tr.Spin(2.0), **ROUGH))
    start = system.place(place, **how)
    near(again(system, start).start_state(), start, 8)


@pytest.mark.parametrize("body", ["solid sphere", "eccentric sphere", "formula"])
@pytest.mark.parametrize("name", SURFACES)
def test_any_state_of_a_run_comes_back_to_a_rounding(name: str, body: str) -> None:
    """Where a run has come to nobody would have said in a few digits."""
    surface, place = SURFACES[name]
    rolls, how = BODIES[body]
    system = tr.RollingSystem(rolls, tr.Support(surface, friction=0.7))
    start = system.place(tuple(part / 3 for part in place), (0.03, 0.04), **how)
    V, Omega = ((x * (1 + 1e-13), y, z) for x, y, z in (start.velocity, start.angular_velocity))
    state = tr.State(start.position, V, Omega, start.orientation)
    near(again(system, state).start_state(), state, 16)


RERUN: dict[str, tuple[tr.RollingSystem, dict[str, Any]]] = {
    "egg in a bowl": (
        tr.RollingSystem(EGG, tr.Support(tr.Bowl(0.5), motion=tr.Spin(2.0))),
        {"position": (0.1, 0.2), "attitude": (0.2, 0.9, 0.1)},
    ),
    "slips on a free table": (
        tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.FreeAxle(0.01, 2.0), **ROUGH), (tr.Drag(0.01),)),
        {"position": (0.1, 0.2), "velocity": (1.0, 0.0), "angular_velocity": (0.0, 0.0, 0.0)},
    ),
    "bounces": (
        tr.RollingSystem(CHAPLYGIN, tr.Support(tr.Plane(), tilt=0.2, **ROUGH)),
        {"position": (0.1, 0.2), "height": 0.01, "velocity": (0.3, 0.0, 0.1)},
    ),
}


@pytest.mark.parametrize("name", RERUN)
def test_a_saved_run_runs_again_the_same(name: str, tmp_path: Path) -> None:
    system, how = RERUN[name]
    run = tr.simulate(system, system.place(**how), duration=0.2, every=0.01, method="runge-kutta")
    loaded = tr.Trajectory.load(run.save(tmp_path / "run.nc"))
    rerun = tr.Scenario.loads(loaded.scenario).run()
    for key in run.data.data_vars:
        np.testing.assert_array_equal(rerun.data[key], run.data[key])
    assert [event.kind for event in rerun.events] == [event.kind for event in run.events]


def test_words_are_as_short_as_they_may_be() -> None:
    """Of a start that someone wrote in a few digits nobody gets back sixteen."""
    system = tr.RollingSystem(EGG, tr.Support(tr.Bowl(0.5), friction=0.5))
    start = system.place((0.1, 0.2), (0.03, 0.04), attitude=(0.2, 0.9, 0.1), spin=0.3, height=0.02)
    table = ScenarioFile.describe(system, start, duration=1.0, every=0.1).start
    assert (table.position, table.velocity, table.height) == ((0.1, 0.2), (0.03, 0.04), 0.02)
    assert table.attitude == (0.2, 0.9, 0.1)
    assert table.spin == 0.3


def test_what_is_said_to_be_nothing_is_not_written() -> None:
    """JSON has a word for it, TOML has none."""
    tables = files.tables_of("tilted-turntable")
    tables["support"]["rim"] = tables["start"]["spin"] = None
    text = tr.Scenario.read(tables).to_toml()
    assert "rim" not in text
    assert "spin = " not in text.partition("[start]")[2]
    assert tr.Scenario.loads(text).to_toml() == text
