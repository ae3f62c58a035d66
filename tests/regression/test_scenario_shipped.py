"""The notes of the shipped scenarios tell what one sees: their numbers come out of the lecture's equations.

The motion is integrated here, not by trundle, from the lecture's equations for a sphere on a turning plane
(Milne) or under a force and a torque (Landau).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.reference.imperfect import Table

from trundle.mechanics.algebra import Vector
from trundle.scenario import ScenarioFile, files
from trundle.scenario.path_file import PathFile

STEEL, TABLE = 7.8e3, 33.3 * np.pi / 30  # kg/m³; rad/s
Path = Callable[[object], np.ndarray]


def path_of(name: str) -> Path:
    """Return x, y and their rates as functions of time.

    (1 + 1/k) r̈ = ω n×ṙ + (1/k)(g sin α e_x + F/m + K×n/(m a))
    """
    scenario = ScenarioFile.load(name)
    system, start = scenario.system(), scenario.start_state()
    m, a, k = system.body.mass, system.body.shape.radius, system.body.inertia_ratio
    push = np.array([system.gravity * np.sin(system.support.tilt), 0.0])
    for load in scenario.applied_loads:
        x, y, _ = load.value
        push += np.array([x, y]) / m if load.kind == "force" else np.array([y, -x]) / (m * a)
    rate = getattr(system.support.motion, "rate", 0.0)

    def motion(_: float, state: np.ndarray) -> list[float]:
        _, _, u, v = state
        ax, ay = (rate * np.array([-v, u]) + push / k) / (1 + 1 / k)
        return [u, v, ax, ay]

    first = [*start.position[:2], *start.velocity[:2]]
    run = scenario.timing
    solved = solve_ivp(motion, (0, run.duration), first, "DOP853", rtol=1e-11, atol=1e-12, dense_output=True)
    return lambda t: solved.sol(t)


def first_return(path: Path, guess: float) -> float:
    """Return the time near a guess at which the velocity points as it did at first."""
    times = np.linspace(0.9 * guess, 1.1 * guess, 20001)
    _, _, u, v = path(times)
    _, _, u0, v0 = path(0.0)
    turned = np.angle((u + 1j * v) / (u0 + 1j * v0))
    return float(np.interp(0.0, turned, times))


def radius_of(path: Path, round_time: float, drift: complex = 0) -> tuple[float, complex]:
    """Return radius and first centre of the circle that the path makes about a drifting centre."""
    times = np.linspace(0, round_time, 4096, endpoint=False)
    x, y, _, _ = path(times)
    wheel = x + 1j * y - drift * times
    return float(np.abs(wheel - wheel.mean()).max()), complex(wheel.mean())


def says(name: str, *numbers: str) -> None:
    notes = ScenarioFile.load(name).notes.replace("\n", " ")
    for number in numbers:
        assert number in notes


def test_the_titles_and_names_are_those_of_the_files() -> None:
    assert sorted([*ScenarioFile.names(), *PathFile.names()]) == files.names()
    titles = [kind.load(name).title for kind in (ScenarioFile, PathFile) for name in kind.names()]
    assert titles == [files.title_of(name) for kind in (ScenarioFile, PathFile) for name in kind.names()]
    assert len(set(titles)) == len(titles)


@pytest.mark.parametrize("name", ScenarioFile.names())
def test_each_has_notes_and_a_realistic_ball(name: str) -> None:
    scenario = ScenarioFile.load(name)
    assert len(scenario.notes) > 150
    if scenario.body.kind == "solid-sphere":
        assert scenario.body.mass == pytest.approx(4 / 3 * np.pi * scenario.body.radius**3 * STEEL, rel=0.01)
    elif scenario.body.kind == "hollow-sphere":  # a table-tennis ball, by the rules
        assert (scenario.body.radius, scenario.body.mass) == (0.02, 0.0027)
    else:
        body = scenario.system().body
        assert 0.004 < body.mass < 5
        assert 0.01 < body.shape.support_map(Vector(0.6, 0.48, 0.64)).norm() < 0.5
    assert all(line == line.strip() for line in scenario.notes.splitlines())


def test_tilted_turntable() -> None:
    name = "tilted-turntable"
    path = path_of(name)
    period = first_return(path, 6.3)
    x, y, u, v = path(period) - path(0.0)
    drift = complex(x, y) / period
    radius, centre = radius_of(path, period, drift)
    assert abs(drift.real) < 1e-4 * abs(drift)  # sideways, not down
    assert (abs(u), abs(v)) < (1e-4, 1e-4)
    says(
        name,
        f"{1000 * abs(drift):.1f} mm/s",
        f"{period:.3f} s",
        f"{100 * radius:.1f} cm",
        f"In 20 s the ball crosses {2000 * abs(drift):.0f} cm",
    )
    assert period == pytest.approx(3.5 * 60 / 33.3, rel=1e-6)  # seven halves of a turn
    assert abs(centre + 10 * drift) < 0.005  # half-way through, over the axis
    assert np.hypot(*path(np.linspace(0, 20, 2001))[:2]).max() < 0.5  # it stays on the table


def test_tilted_turntable_put_down() -> None:
    name = "tilted-turntable-put-down"
    path = path_of(name)
    times = np.linspace(0, 10, 100001)
    x, _, u, v = path(times)
    start = path(0.0)
    cusp = times[1000:][np.hypot(u, v)[1000:].argmin()]
    along = path(cusp) - start
    assert abs(along[0]) < 1e-6
    says(name, f"{100 * along[1]:.1f} cm further", f"{100 * (x.max() - x[0]):.1f} cm deep", f"{cusp:.3f} s")
    says(name, f"{1000 * along[1] / cusp:.1f} mm/s")
    inside = path(np.linspace(0, 24, 5001))
    assert np.hypot(inside[0], inside[1]).max() < 0.5


def test_level_turntable_put_down() -> None:
    path = path_of("level-turntable-put-down")
    np.testing.assert_allclose(path(20.0), path(0.0), atol=1e-15)
    says("level-turntable-put-down", f"{TABLE * 0.2:.3f} m/s", f"{TABLE * 0.2 / 0.025:.1f} rad/s")
    Omega = ScenarioFile.load("level-turntable-put-down").start_state().angular_velocity
    assert np.hypot(*Omega[:2]) == pytest.approx(TABLE * 0.2 / 0.025, rel=1e-12)


def test_level_turntable_nudged() -> None:
    path = path_of("level-turntable-nudged")
    period = first_return(path, 6.3)
    radius, centre = radius_of(path, period)
    assert period == pytest.approx(3.5 * 60 / 33.3, rel=1e-6)
    says("level-turntable-nudged", f"{period:.3f} s", f"is 0.1 m/s / (2/7 * 33.3 rpm) = {100 * radius:.1f} cm")
    says("level-turntable-nudged", f"{100 * abs(centre):.1f} cm from the axis")


def test_level_turntable_corotating() -> None:
    name = "level-turntable-corotating"
    path = path_of(name)
    radius, centre = radius_of(path, 3.5 * 60 / 33.3)
    furthest = np.hypot(*path(np.linspace(0, 20, 20001))[:2]).max()
    says(name, f"{100 * radius:.1f} cm", f"{100 * abs(centre):.1f} cm away", f"{100 * furthest:.0f} cm")
    np.testing.assert_allclose(path(7 * 60 / 33.3), path(0.0), atol=1e-9)  # and the table has turned seven times


def test_hollow_ball() -> None:
    path = path_of("hollow-ball-turntable")
    period = first_return(path, 4.5)
    radius, _ = radius_of(path, period)
    assert period == pytest.approx(2.5 * 60 / 33.3, rel=1e-6)
    says("hollow-ball-turntable", f"{period:.3f} s", f"{100 * radius:.2f} cm")


def test_force_and_torque() -> None:
    m, a, F, K = 0.51, 0.025, 0.1, 2.5e-3
    force, torque = path_of("ball-under-force"), path_of("ball-under-torque")
    np.testing.assert_allclose(force(5.0), torque(5.0), rtol=1e-9, atol=1e-12)
    acceleration = force(5.0)[2] / 5
    says(
        "ball-under-force",
        f"{acceleration:.3f} m/s each second",
        f"{force(5.0)[0]:.2f} m away",
        f"{F / m:.3f}",
    )
    says("ball-under-torque", f"{acceleration:.3f} m/s each second")
    # m V̇ = F + R along the first axis
    says("ball-under-force", f"{1000 * (F - m * acceleration):.1f} mN")
    says("ball-under-torque", f"{1000 * m * acceleration:.1f} mN")
    assert K / a == pytest.approx(F, rel=1e-12)


def test_off_the_rim() -> None:
    path = path_of("off-the-rim")
    times = np.linspace(0, 10, 1000001)
    leaves = times[(np.hypot(*path(times)[:2]) >= 0.5).argmax()]
    radius, centre = radius_of(path, 3.5 * 60 / 33.3)
    says(
        "off-the-rim",
        f"{leaves:.3f} s",
        f"{100 * radius:.0f} cm",
        f"{100 * abs(centre):.0f} cm on the other side",
    )


def swing(name: str) -> tuple[Callable[[float], np.ndarray], float, float]:
    """Return θ and θ̇ over time of (1 + k)(b − a)θ̈ = −g sin θ, with its period and that of a small swing."""
    scenario = ScenarioFile.load(name)
    k = {"cylinder": 0.5, "solid-sphere": 0.4}[scenario.body.kind]
    length = scenario.support.radius - scenario.body.radius
    first = [scenario.start.position[0], scenario.start.velocity[0] / length]

    def law(_: float, y: np.ndarray) -> list[float]:
        return [y[1], -9.80665 * np.sin(y[0]) / ((1 + k) * length)]

    solved = solve_ivp(law, (0, scenario.timing.duration), first, "DOP853", rtol=1e-12, atol=1e-13, dense_output=True)
    times = np.linspace(0, scenario.timing.duration, 200_001)
    angle, _ = solved.sol(times)
    if angle.max() - angle.min() > 2 * np.pi:  # one round
        period = float(np.interp(angle[0] + 2 * np.pi, angle, times))
    else:  # two crossings of the lowest line upwards
        up = np.flatnonzero((angle[:-1] < 0) & (angle[1:] >= 0))
        period = float(times[up[1]] - times[up[0]])
    return solved.sol, period, float(2 * np.pi * np.sqrt((1 + k) * length / 9.80665))


def test_cylinder_on_incline() -> None:
    gained = 2 / 3 * 9.80665 * np.sin(np.radians(10))
    come = gained * 1.5**2 / 2
    says(
        "cylinder-on-incline",
        f"{gained:.3f} m/s each second",
        f"{come:.2f} m",
        f"{come / 0.03 / (2 * np.pi):.2f} times",
    )


@pytest.mark.parametrize("name", ["cylinder-in-cylinder", "cylinder-in-turning-cylinder"])
def test_cylinder_in_cylinder(name: str) -> None:
    _, period, small = swing(name)
    says(name, f"{period:.2f} s")
    if name == "cylinder-in-cylinder":
        # At rest at the end of the swing f = m g sin θ k/(1 + k) and N = m g cos θ.
        says(name, f"{small:.2f} s", f"{np.tan(np.radians(60)) / 3:.3f}")
    else:
        says(name, f"{10 * np.pi / 30 * 0.5 / 0.03:.1f} rad/s")


def test_loop_the_loop() -> None:
    path, period, _ = swing("loop-the-loop")
    length = 0.19
    over = np.sqrt(4 * 9.80665 * length / 1.4)
    pressed = np.sqrt(9.80665 * length + 4 * 9.80665 * length / 1.4)
    says("loop-the-loop", f"{period:.3f} s", f"{over:.2f} m/s", f"{pressed:.2f} m/s")
    # From that speed on the ring pushes all the way: N = m(ℓ θ̇² + g cos θ).
    angle, rate = path(np.linspace(0, 3, 3001))
    assert np.all(length * rate**2 + 9.80665 * np.cos(angle) > 0)


def test_real_demonstration() -> None:
    name, a, lean, askew = "real-demonstration", 0.025, np.radians(0.03), np.radians(0.1)
    table = Table(a, 0.51, 0.4, TABLE, rim=0.5, tilt=lean, drag=8e-5, askew=askew)
    (leaves,) = table.run((0.1, 0.0), (0.0, 0.1), 300.0, rtol=1e-8).t_events[0]
    one_round = 3.5 * 60 / 33.3
    says(name, f"{leaves:.1f} s, in its {int(leaves / one_round) + 1}th round", f"{one_round:.3f} s")
    says(name, f"{1000 * 9.80665 * np.sin(lean) / (0.4 * TABLE):.2f} mm/s")
    says(
        name, f"{1000 * 0.5 * np.sin(askew):.1f} mm up and down", f"sways by {1000 * 9.80665 * askew / TABLE**2:.1f} mm"
    )
    says(name, f"{np.log(2) * 0.51 * 1.4 / 8e-5 / 60:.0f} min")
    assert 1000 * np.tan(lean) == pytest.approx(0.5, abs=0.05)  # mm in a metre
    # the sway, from the path: with and without
    straight = Table(a, 0.51, 0.4, TABLE, askew=askew).path((0.1, 0.0), (0.0, 0.1), 12.61, 1e-8)(
        np.linspace(0, 12.61, 4001)
    )
    sway = abs(np.mean(straight * np.exp(-1j * TABLE * np.linspace(0, 12.61, 4001))))
    assert 1000 * sway == pytest.approx(1.4, abs=0.05)


def test_real_demonstration_light_ball() -> None:
    name, k, drag = "real-demonstration-light-ball", 2 / 3, 1.1e-4
    table = Table(0.02, 0.0027, k, TABLE, rim=0.5, drag=drag, air_rate=TABLE, variation=0.01, variation_rate=TABLE)
    (leaves,) = table.run((0.2, 0.0), (0.0, 0.1), 120.0, rtol=1e-8).t_events[0]
    says(name, f"{leaves:.2f} s, in its {int(leaves * 0.4 * 33.3 / 60) + 1}th round")
    gamma = drag / (0.0027 * (1 + k))
    circle, centre = np.roots([1, gamma - 1j * TABLE * k / (1 + k), -1j * gamma * TABLE])
    says(name, f"in to the axis, e-fold in {-1 / centre.real:.1f} s", f"grows, e-fold in {1 / circle.real:.1f} s")
    steel = 4 / 3 * np.pi * 0.02**3 * STEEL  # growth at γ/k = c/(m k (1 + k))
    says(name, f"would take {steel * 0.4 * 1.4 / (0.0027 * k * (1 + k)):.0f} times as long")
    still = Table(0.02, 0.0027, k, TABLE, rim=0.5, drag=drag).run((0.2, 0.0), (0.0, 0.1), 60.0, rtol=1e-6)
    assert still.t_events[0].size == 0
    # the furthest from a motion at a steady rate, while it lasts
    steady = Table(0.02, 0.0027, k, TABLE, drag=drag, air_rate=TABLE).path((0.2, 0.0), (0.0, 0.1), 50.0, 1e-6)
    uneven = Table(0.02, 0.0027, k, TABLE, drag=drag, air_rate=TABLE, variation=0.01, variation_rate=TABLE)
    times = np.linspace(0, 50, 501)
    apart = abs(uneven.path((0.2, 0.0), (0.0, 0.1), 50.0, 1e-6)(times)) - abs(steady(times))
    assert abs(apart).max() < 5e-3


def test_ball_in_a_trough() -> None:
    """(7/5) s̈ = −g sin(s/0.1 m) for the way s of the centre, and twice the angle's sine for the pendulum's period."""
    from scipy.special import ellipk

    name, g, length = "ball-in-a-trough", 9.80665, 0.125 - 0.025
    small = np.sqrt(1.4 * length / g)
    swing = 4 * small * ellipk(np.sin(np.radians(5)) ** 2)
    says(name, f"once in {swing:.3f} s", f"take {2 * np.pi * small:.3f} s", f"{1 / small:.3f} rad/s")
    says(name, f"would take {2 * np.pi * np.sqrt(length / g):.3f} s", f"{2 / 7 * np.tan(np.radians(10)):.3f} of the")


def weighted(tilt: float, roll: float, until: float) -> tuple[float, float, float, Path]:
    """Return offset and moment about the centre of mass of the weighted cylinder, its steepest slope, and its motion.

    Lagrange's equation for the angle ψ of the weight from the normal, x = aψ, M(ψ) the moment about the contact:
    M ψ̈ + ½ M′ ψ̇² = m g (a sin α + δ sin(ψ + α)).
    """
    a, bare, extra, at, g = 0.05, 0.3, 0.1, 0.04, 9.80665
    m = bare + extra
    d = extra * at / m
    inertia = 0.5 * bare * a**2 + bare * d**2 + extra * (at - d) ** 2

    def rates(_: float, y: np.ndarray) -> list[float]:
        about = inertia + m * (a**2 + d**2 + 2 * a * d * np.cos(y[0]))
        push = m * g * (a * np.sin(tilt) + d * np.sin(y[0] + tilt))
        return [y[1], (push + m * a * d * np.sin(y[0]) * y[1] ** 2) / about]

    solved = solve_ivp(rates, (0, until), [roll, 0.0], "DOP853", rtol=1e-11, atol=1e-12, dense_output=True)
    return d, inertia, float(np.degrees(np.arcsin(d / a))), lambda t: solved.sol(t)


def test_weighted_cylinder_on_incline() -> None:
    name, tilt, a, m, g = "weighted-cylinder-on-incline", np.radians(5), 0.05, 0.4, 9.80665
    start = np.radians(-149)
    d, inertia, steepest, path = weighted(tilt, start, 3.0)
    lean = np.arcsin(a * np.sin(tilt) / d)
    assert d == pytest.approx(0.01)
    says(
        name,
        f"= {1000 * a * np.sin(tilt):.2f} mm",
        f"{np.degrees(lean):.1f} degrees",
        f"{steepest:.1f} degrees nothing",
    )
    stays, tips = lean - np.pi - tilt, -lean - tilt
    assert np.degrees(start - stays) == pytest.approx(10, abs=0.5)
    assert np.degrees(stays) == pytest.approx(-159.2, abs=0.05)
    times = np.linspace(0.5, 2, 30001)
    turned = path(times)[1]
    back = times[1:][(turned[:-1] > 0) & (turned[1:] <= 0)][0]
    rates = []
    for psi, sign in ((stays, -1), (tips, 1)):
        about = inertia + m * (a**2 + d**2 + 2 * a * d * np.cos(psi))
        rates.append(np.sqrt(sign * m * g * d * np.cos(psi + tilt) / about))
    says(name, f"{back:.3f} s", f"once in {2 * np.pi / rates[0]:.3f} s", f"e in {1 / rates[1]:.3f} s")
    says(name, f"tan(5 deg) = {np.tan(tilt):.4f}")


def test_weighted_cylinder_too_steep() -> None:
    name, tilt, a, g = "weighted-cylinder-too-steep", np.radians(12), 0.05, 9.80665
    d, _, _, path = weighted(tilt, np.pi, 1.2)
    says(name, f"= {1000 * a * np.sin(tilt):.2f} mm", f"{1000 * (a * np.sin(tilt) - d):.2f} mm")
    times = np.linspace(0, 1.2, 120001)
    psi, rate = path(times)
    slows = np.flatnonzero(np.diff(np.sign(np.diff(rate))))[:2] + 1
    says(name, f"{times[slows[0]]:.2f} s", f"{a * rate[slows[0]]:.3f} m/s", f"to {a * rate[slows[1]]:.3f} m/s")
    first = times[(psi - np.pi >= 2 * np.pi).argmax()]
    plain = np.sqrt(2 * 2 * np.pi * a / (2 / 3 * g * np.sin(tilt)))
    says(name, f"takes {first:.3f} s", f"cylinder {plain:.3f} s")


@pytest.mark.parametrize("name", ["ball-in-a-trough", "weighted-cylinder-on-incline", "weighted-cylinder-too-steep"])
def test_what_may_rest_also_runs(name: str) -> None:
    from trundle import Scenario

    assert Scenario.load(name).run().card().passed
