"""A support pushes and never pulls: what slips comes off where it must, and what has no answer is named."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from tests.tolerances import SOLVER

import trundle as tr
from trundle.mechanics.system import STANDARD_GRAVITY

G = STANDARD_GRAVITY
BALL = tr.Body.solid_sphere(0.05, 1.0)
METHODS = ("auto", "taylor", "runge-kutta")


def run_of(system: tr.RollingSystem, start: tr.State, duration: float = 0.3, method: str = "auto") -> tr.Trajectory:
    run = tr.simulate(system, start, duration, duration / 30, method)
    pushed = np.einsum("ni,ni->n", run.samples.contact_force, run.samples.normals(system))
    assert pushed.min() >= -1e-12 * max(1.0, np.abs(pushed).max())
    assert run.card().passed
    return run


def flies_from_the_start(system: tr.RollingSystem, start: tr.State, method: str, pull: float = G) -> None:
    """It comes off at once, and its centre follows a parabola."""
    run = run_of(system, start, 0.05, method)
    assert run.events[0].kind == "lift"
    assert run.events[0].time == start.time
    follows_a_parabola(run, start, pull)


def follows_a_parabola(run: tr.Trajectory, start: tr.State, pull: float = G) -> None:
    t = run.data.time.values[:, None]
    parabola = np.array(start.position) + np.array(start.velocity) * t - 0.5 * np.array([0.0, 0.0, pull]) * t * t
    assert np.abs(run.data.position.values - parabola).max() <= SOLVER(10, max(run.tolerance, 1e-15))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("friction", [0.0, 0.05, 0.3, 2.0])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_too_fast_over_a_dome_it_flies_however_it_slips(friction: float, way: float, method: str) -> None:
    dome = tr.RollingSystem(BALL, tr.Support(tr.Dome(0.3), friction=friction))
    speed = way * math.sqrt(G * 0.35) * (1 + 1e-6)  # v² = gL: just too fast
    flies_from_the_start(dome, dome.place((0.0, 0.0), (speed, 0.0), angular_velocity=(0.0, 0.0, 0.0)), method)
    hill = tr.HeightField("-0.2*x**2 + 0.1*y")  # as curved along x at its crest as a circle of 2.5 m
    if method != "auto":
        crest = tr.RollingSystem(BALL, tr.Support(hill, friction=friction))
        start = crest.place((0.0, 0.0), (6 * way, 0.6 * way), angular_velocity=(0.0, 0.0, 0.0))
        assert run_of(crest, start, 0.05, method).events[0].time == 0.0


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("friction", [None, 0.0, 0.3])
@pytest.mark.parametrize("surface", [tr.Dome(0.3), tr.Cylinder(0.3, "outside")])
def test_where_nothing_presses_and_the_wall_falls_away_it_leaves_at_once(
    surface: Any, friction: Any, method: str
) -> None:
    """At the equator the weight is along the wall: N is 0 up to rounding, and a pull would be needed from then on."""
    tilt, place = ("0 deg", (0.3, 0.0)) if isinstance(surface, tr.Dome) else ("90 deg", ("90 deg", 0.0))
    wall = tr.RollingSystem(BALL, tr.Support(surface, friction=friction, tilt=tilt))
    run = run_of(wall, wall.place(place), 0.05, method)
    assert [(event.kind, event.time) for event in run.events] == [("lift", 0.0)]


@pytest.mark.parametrize("method", METHODS)
def test_thrown_up_from_the_support_it_comes_down_on_it(method: str) -> None:
    """The flight begins where it touches, with no gap at all, and lasts 2v/g."""
    floor = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=0.3))
    for speed in (1e-3, 0.08, 3.0):
        lasts = 2 * speed / G
        start = floor.place(velocity=(0.03, -0.1, speed), angular_velocity=(0.0, 0.0, 0.0))
        run = tr.simulate(floor, start, 3 * lasts, lasts / 7, method)
        assert run.events[0].kind == "land"
        assert abs(run.events[0].time - lasts) <= SOLVER(100, max(run.tolerance, 1e-15), lasts)


def test_where_nothing_presses_but_will_it_stays() -> None:
    """In the wall's equator from inside, and on a plane without weight, what follows presses, or nothing does."""
    bowl = tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.3)))
    assert not run_of(bowl, bowl.place((0.3, 0.0)), 0.05, "taylor").events
    nowhere = tr.RollingSystem(BALL, tr.Support(tr.Plane()), gravity=0.0)
    assert not run_of(nowhere, nowhere.place(velocity=(1.0, 0.0)), 0.05, "taylor").events


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("share", [0.0, 0.3, 0.9, 1 - 1e-6])
def test_without_friction_it_leaves_a_dome_where_a_particle_does(share: float, method: str) -> None:
    dome = tr.RollingSystem(BALL, tr.Support(tr.Dome(0.3), friction=0.0))
    speed = max(math.sqrt(share * G * 0.35), 1e-4)
    start = dome.place((0.0, 0.0), (speed, 0.0), angular_velocity=(0.0, 3.0, 1.0))
    off = run_of(dome, start, 2.0, method).events[0]
    # m v²/L = m g cos θ with v² = v₀² + 2gL(1 − cos θ)
    leaves = (2 + speed * speed / (G * 0.35)) / 3
    assert off.kind == "lift"
    assert abs((off.before.position[2] + 0.3) / 0.35 - leaves) <= SOLVER(1000, 1e-13)


@pytest.mark.parametrize("method", ["exact", "taylor", "runge-kutta"])
@pytest.mark.parametrize("up", [1e-3, 0.1, 2.0])
def test_thrown_up_from_the_floor_it_comes_down_again(up: float, method: str) -> None:
    floor = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=0.1))
    start = replace(floor.place((0.2, 0.1)), velocity=(0.3, 0.0, up))  # the gap is 0 at first
    landed = run_of(floor, start, 2.5 * up / G, method).events[0]
    assert landed.kind == "land"
    assert abs(landed.time / (2 * up / G) - 1) <= SOLVER(10, 1e-13)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("restitution", [0.0, 0.5])
@pytest.mark.parametrize("friction", [None, 0.0, 0.1])
def test_it_strikes_a_dome_and_goes_on_through_the_air(friction: Any, restitution: float, method: str) -> None:
    dome = tr.RollingSystem(BALL, tr.Support(tr.Dome(0.3), friction=friction, restitution=restitution))
    rolling = (0.0, 60.0, 0.0)  # without a limit to friction it may touch in no other way
    start = dome.place((0.0, 0.0), (3.0, 0.0, -2.0), angular_velocity=rolling if friction is None else (0.0, 0.0, 0.0))
    run = run_of(dome, start, 0.1, method)
    assert [event.kind for event in run.events] == (["land"] if restitution else ["land", "lift"])
    after = run.events[0].after
    assert after is not None
    follows_a_parabola(run, after)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_a_force_that_lifts_does_so_whether_it_rolls_or_slips(friction: float, method: str) -> None:
    for lift in (G * (1 + 1e-9), 20.0):
        pulled = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=friction), (tr.Force((0.0, 0.0, lift)),))
        for turning in (None, (0.0, 0.0, 0.0), (0.0, 20.0, 0.0)):
            start = pulled.place((0.0, 0.0), (1.0, 0.0), angular_velocity=turning)
            flies_from_the_start(pulled, start, method, G - lift)
    held = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=friction), (tr.Force((0.0, 0.0, G * (1 - 1e-9))),))
    start = held.place((0.0, 0.0), (1.0, 0.0), angular_velocity=(0.0, 0.0, 0.0))
    assert not run_of(held, start, 0.3, method).events


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("turning", [None, (0.0, 0.0, 0.0)])
def test_a_table_that_falls_away_leaves_it_behind_until_it_comes_back(turning: Any, method: str) -> None:
    shaken = tr.Support(
        tr.Plane(), motion=tr.Shake((0.0, 0.0, 0.05), 20.0, "90 deg"), friction=0.1
    )  # 20 m/s² downwards
    table = tr.RollingSystem(BALL, shaken)
    run = run_of(table, table.place((0.0, 0.0), (1.0, 0.0), angular_velocity=turning), 0.2, method)
    assert [event.kind for event in run.events[:2]] == ["lift", "land"]
    assert run.events[0].time == 0.0
    meets = brentq(lambda t: 0.05 - 0.5 * G * t * t - 0.05 * math.cos(20 * t), 0.05, 0.16, xtol=1e-15)
    assert abs(run.events[1].time - meets) <= SOLVER(1000, 1e-15)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("friction", [None, 0.0, 1e-3, 0.3, 2.0])
@pytest.mark.parametrize("resistance", [0.0, 1e-3])
def test_what_a_shaken_table_hardly_holds_leaves_where_the_table_falls_faster(
    friction: Any, resistance: float, method: str
) -> None:
    loads = (tr.RollingResistance(resistance),) * bool(resistance)
    for height, rate in ((0.005, 60.0), (-0.005, 60.0), (0.01, 45.0), (0.01, 31.5)):
        shaken = tr.Support(tr.Plane(), motion=tr.Shake((0.0, 0.0, height), rate), friction=friction)
        system = tr.RollingSystem(BALL, shaken, loads)
        # The table's acceleration is −Aω² sin ωt: it falls away where that is −g.
        first = math.asin(G / (abs(height) * rate**2)) / rate + (math.pi / rate if height < 0 else 0.0)
        for velocity in ((0.0, 0.0), (0.5, 0.2)):
            if velocity != (0.0, 0.0) and resistance:
                continue  # then friction is asked for
            run = run_of(system, system.place((0.0, 0.0), velocity), 0.2, method)
            assert run.events[0].kind == "lift"
            assert abs(run.events[0].time - first) <= SOLVER(100, 1e-15 if method == "taylor" else 1e-12)


def test_any_instants_can_be_asked_for() -> None:
    shaken = tr.Support(tr.Plane(), motion=tr.Shake((0.0, 0.0, 0.01), 45.0), friction=0.1)
    system = tr.RollingSystem(BALL, shaken)
    random = np.random.default_rng(18)
    for begin in random.uniform(0.0, 3.0, 40).tolist():
        start = system.place((0.0, 0.0), (0.5, 0.0), time=begin)
        run = tr.simulate(system, start, 0.3, 0.1, "taylor")
        run.at(begin + np.sort(random.uniform(0.0, 0.3, 40)))


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("friction", [0.05, 0.4, 2.0])
def test_before_it_lands_it_flies_and_after_it_what_came_of_it_goes_on(friction: float, method: str) -> None:
    egg = tr.Body.ellipsoid((0.05, 0.04, 0.03), 1.0)
    system = tr.RollingSystem(egg, tr.Support(tr.Plane(), friction=friction))
    start = system.place((0.0, 0.0), (1.0, 0.5), angular_velocity=(3.0, -7.0, 20.0), height=0.1)
    landing = tr.simulate(system, start, 0.2, 0.01, method).events[0]
    assert landing.kind == "land"
    before, after = landing.before, landing.after
    assert before is not None
    assert after is not None
    for _ in range(2):  # elsewhere than where the run was made an event may lie a rounding aside
        near = [
            np.nextafter(landing.time, 0.0),
            *(landing.time + np.logspace(-16 if method == "taylor" else -12, -9, 15)),
        ]
        seen = tr.Trajectory.at(tr.simulate(system, start, 0.2, 0.01, method), [*near[:1], *np.unique(near[1:])])
        landing = next(event for event in seen.events if event.kind == "land")
    flies = seen.data.time.values < landing.time
    assert (seen.data.phase.values[flies] == 2).all()
    assert (seen.data.phase.values[~flies] != 2).all()
    wanted = np.where(flies[:, None], before.velocity, after.velocity)
    assert np.abs(seen.data.velocity.values - wanted).max() <= 1e-6


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("off", [0.003, 0.03, 0.3])
def test_thrown_off_the_ground_of_a_bowl_it_comes_down_where_its_parabola_does(off: float, method: str) -> None:
    # The centre stays within R − a of the middle of the bowl: a cubic in t, once t = 0 is divided out.
    system = tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.4), friction=0.3))
    start = system.place(velocity=(1.5, 0.0, off))
    run = run_of(system, start, 0.2, method)
    x, z = np.polynomial.Polynomial([0.0, 1.5]), np.polynomial.Polynomial([-0.35, off, -G / 2])
    roots = np.asarray(np.polynomial.Polynomial((x * x + z * z - 0.35**2).coef[1:]).roots())
    lands = float(roots.real[(roots.imag == 0) & (roots.real > 0)].min())
    assert run.events[0].kind == "land"
    assert abs(run.events[0].time - lands) <= SOLVER(10, max(run.tolerance, 1e-13))


def test_a_bounce_is_cut_by_how_it_comes_off_what_it_struck() -> None:
    # What strikes the side of a light bowl on an axle sets that in motion: by as much less it comes off.
    bowl = tr.EllipsoidalBowl((0.24, 0.43, 0.18))
    support = tr.Support(bowl, motion=tr.FreeAxle(5e-4), restitution=0.1166)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.1136, 0.5), support)
    for height in (0.01, 0.03, 0.05):
        start = system.place((0.01, -0.13), (0.44, 0.03, -0.16), height=height)
        card = tr.simulate(system, start, 0.2, 0.01).card()
        assert card["landings: one impulse at the contact"].passed


def test_a_body_without_weight_goes_on_against_resistance() -> None:
    ring = tr.Body.ring(0.05, 0.1)
    loads = (tr.RollingResistance(6e-4), tr.Motor(("0.003*abs(t - 3)", -6e-4, "0.002*abs(t - 0.8)")))
    support = tr.Support(tr.Plane(), friction=0.4)
    system = tr.RollingSystem(ring, support, loads, gravity=0.0)
    run = tr.simulate(system, system.place((0.0, 0.0), attitude=("90 deg", "-90 deg", 0.03)), 1.0, 0.05, "taylor")
    assert np.isfinite(run.data.position.values).all()


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("friction", [None, 0.0, 0.3])
def test_nothing_presses_it_on_until_something_does(friction: Any, method: str) -> None:
    def pushed(force: str) -> tr.RollingSystem:
        support = tr.Support(tr.Plane(), friction=friction)
        return tr.RollingSystem(BALL, support, (tr.Force((0.0, 0.0, force)),), gravity=0.0)

    for velocity in ((0.0, 0.0), (2.0, -1.0)):
        still = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=friction), gravity=0.0)
        assert not run_of(still, still.place((0.0, 0.0), velocity), 2.0, method).events
        up = pushed("0.3*t")
        run = run_of(up, up.place((0.0, 0.0), velocity), 0.4, method)
        assert [event.kind for event in run.events] == ["lift"]
        assert abs(run.data.position.values[-1, 2] - (0.05 + 0.3 * 0.4**3 / 6)) <= SOLVER(1000, 1e-12)
        down = pushed("-sin(5*t)")
        run = run_of(down, down.place((0.0, 0.0), velocity), 0.8, method)
        assert [event.kind for event in run.events] == ["lift"]
        assert abs(run.events[0].time - math.pi / 5) <= 1e-6  # it leaves slowly: a rounding of N is worth so much time


# Painlevé: a rod that is dragged towards its tip


ROD, LENGTH, THICKNESS = tr.Body.ellipsoid((0.005, 0.005, 0.5), 1.0), 0.5, 0.005


def dragged(friction: float, lean: float, speed: float, rate: float = 0.0) -> tuple[tr.RollingSystem, tr.State]:
    """Return a rod that leans from the vertical towards +x, and is dragged along x."""
    system = tr.RollingSystem(ROD, tr.Support(tr.Plane(), friction=friction))
    q = (math.cos(lean / 2), 0.0, math.sin(lean / 2), 0.0)
    return system, system.place((0.0, 0.0), (speed, 0.0), orientation=q, angular_velocity=(0.0, rate, 0.0))


def jams_at(lean: float) -> float:
    """Return the μ at which n·a₁ = 0: (κ² + x²)/(xz), (x, z) from the contact to the centre, κ² = J/m, in the plane."""
    b2, c2 = THICKNESS**2, LENGTH**2
    z = math.sqrt(b2 * math.sin(lean) ** 2 + c2 * math.cos(lean) ** 2)
    x = (c2 - b2) * math.sin(lean) * math.cos(lean) / z
    return ((b2 + c2) / 5 + x * x) / (x * z)


@pytest.mark.parametrize("lean", [0.3, 0.5, 0.8, 1.2])
def test_where_friction_jams_a_rod_is_named_and_nowhere_else(lean: float) -> None:
    limit = jams_at(lean)
    for friction, speed in ((limit * 3, 1.0), (0.5 * limit, -1.0), (limit * 0.99, -1.0)):
        system, start = dragged(friction, lean, speed)
        assert tr.simulate(system, start, 1e-5, 1e-6).data.phase.values.tolist() == [1] * 11
    with pytest.raises(tr.SolverError, match=r"all but jams.*Painlevé"):
        tr.simulate(*dragged(limit * (1 - 1e-9), lean, -1.0), 0.02, 0.005)
    for friction in (limit * (1 + 1e-9), limit * (1 + 1e-3), 2 * limit):
        with pytest.raises(tr.SolverError, match=r"neither roll.*Painlevé"):
            tr.simulate(*dragged(friction, lean, -1.0), 0.02, 0.005)
        # Turning fast enough to leave by itself, it may also stay: there are two answers.
        with pytest.raises(tr.SolverError, match=r"slip on or come off.*Painlevé"):
            tr.simulate(*dragged(friction, lean, -1.0, 30.0), 0.02, 0.005)
