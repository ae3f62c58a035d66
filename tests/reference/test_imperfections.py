"""The shortcomings of a turntable, against formulas worked out here in many digits and against Newton and Euler."""

from __future__ import annotations

import functools
import json
import math
from dataclasses import replace
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpc, mpf
from tests.reference.imperfect import Table
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.analysis.imperfections.circle import Demonstration
from trundle.analysis.imperfections.measuring import measure
from trundle.analysis.imperfections.resisted import _slope

RATE, G = 3.5, 9.80665
BALL = tr.Body.solid_sphere(radius=0.025, mass=0.51)
LIGHT = tr.Body.hollow_sphere(radius=0.02, mass=0.0027)
STEP = 0.05


@functools.cache
def show(body: tr.Body = BALL, position: Any = (0.2, 0.05), velocity: Any = (0.03, 0.1), spin: float = 0.0) -> Any:
    system = tr.RollingSystem(body, tr.Support(tr.Plane(rim=0.5), motion=tr.Spin(RATE)))
    return Demonstration.of(system, system.place(position, velocity, spin=spin))


def simulated(ideal: Any, system: tr.RollingSystem, duration: float, every: float = STEP, rim: Any = None) -> Any:
    system = replace(system, support=replace(system.support, surface=tr.Plane(rim)))
    return tr.simulate(system, ideal.start(system), duration, every, "taylor")


def path_of(run: tr.Trajectory) -> Any:
    return run.data.position.values[:, 0] + 1j * run.data.position.values[:, 1]


# Air: ζ̈ = (iκ − γ) ζ̇ + iγω_a ζ


def in_air(ideal: Any, coefficient: float, air_rate: float) -> tuple[Any, Any, Any, Any]:
    """Return the roots of λ² − (iκ − γ)λ − iγω_a, the circle's first, and the two amplitudes."""
    k, m = mpf(ideal.system.body.inertia_ratio), mpf(ideal.system.body.mass)
    with mpmath.workdps(40):
        kappa, gamma = mpf(RATE) * k / (1 + k), mpf(coefficient) / (m * (1 + k))
        roots = mpmath.polyroots([1, mpc(gamma, -kappa), mpc(0, -gamma * mpf(air_rate))], maxsteps=200, extraprec=200)
        circle, centre = sorted(roots, key=lambda root: -abs(root))
        z, v = mpc(ideal.position), mpc(ideal.velocity)
        arm = (v - centre * z) / (circle - centre)
        return circle, centre, arm, z - arm


KAPPA = {BALL: RATE * 2 / 7, LIGHT: RATE * 2 / 5}
AIRS = [
    (BALL, 0.05, RATE),
    (BALL, 1e-4, RATE),
    (BALL, 0.05, 0.0),
    (BALL, 0.05, KAPPA[BALL]),
    (BALL, 0.2, -RATE),
    (LIGHT, 1e-4, RATE),
    (LIGHT, 3e-4, 0.5),
]


@pytest.mark.parametrize(("body", "coefficient", "air_rate"), AIRS)
def test_air_against_the_roots(body: tr.Body, coefficient: float, air_rate: float) -> None:
    ideal = show(body)
    circle, centre, arm, rest = in_air(ideal, coefficient, air_rate)
    run = simulated(ideal, ideal.on(load=tr.Drag(coefficient, air_rate)), 20.0)
    fate = ideal.in_air(coefficient, air_rate)
    for t, z in list(zip(run.data.time.values, path_of(run), strict=True))[::40]:
        ours, about = arm * mpmath.exp(circle * mpf(t)), rest * mpmath.exp(centre * mpf(t))
        size = float(abs(ours) + abs(about))
        assert abs(complex(ours + about) - z) <= SOLVER(500, 1e-15, size * (1 + t))
        assert abs(fate.radius(t) - float(abs(ours))) <= EXACT(64, size)
        assert abs(fate.centre(t) - complex(about)) <= EXACT(64, size)


@pytest.mark.parametrize("body", [BALL, LIGHT], ids=["solid", "hollow"])
@pytest.mark.parametrize("share", [-1.0, 0.0, 0.5, 1.0, 1.5, 3.5])
def test_the_circle_grows_where_the_air_turns_faster_than_the_ball_goes_round(body: tr.Body, share: float) -> None:
    kappa = KAPPA[body]
    fate = show(body).in_air(1e-5 * body.mass, share * kappa)
    growth = math.log(fate.radius(1000.0) / fate.radius(0.0)) / 1000.0
    gamma = 1e-5 / (1 + body.inertia_ratio)
    assert growth == pytest.approx(gamma * (share - 1), rel=1e-4, abs=1e-15)
    # and in air that turns with the table that is γ/k
    if share * kappa == pytest.approx(RATE):
        assert growth == pytest.approx(gamma / body.inertia_ratio, rel=1e-4)


def test_in_air_at_rest_the_ball_winds_in_to_a_point_and_stays() -> None:
    ideal = show()
    run = simulated(ideal, ideal.on(load=tr.Drag(2.0)), 30.0, rim=0.5)
    gamma, kappa = 2.0 / (0.51 * 1.4), KAPPA[BALL]
    rests = ideal.position - ideal.velocity / (1j * kappa - gamma)
    assert run.events == ()
    assert abs(path_of(run)[-1] - rests) <= SOLVER(500, 1e-15)
    assert ideal.in_air(2.0, 0.0).leaves(0.5, 1e5) == math.inf


# Tilt


def test_a_tilted_table_carries_the_circle_sideways() -> None:
    ideal, tilt = show(), 0.001
    run = simulated(ideal, ideal.on(tilt=tilt), 60.0, rim=0.5)
    drift = G * math.sin(tilt) / (RATE * 0.4)
    kappa = KAPPA[BALL]
    centre = ideal.position + (ideal.velocity - 1j * drift) * 1j / kappa
    radius = abs(ideal.velocity - 1j * drift) / kappa
    found = measure(run, kappa, RATE)
    assert found is not None
    assert found.centre_rate == pytest.approx(drift, rel=1e-9)
    assert abs(found.radius_rate) < 1e-12
    # |centre + i drift t| + radius = rim, by hand
    earliest = (-centre.imag + math.sqrt((0.5 - radius) ** 2 - centre.real**2)) / drift
    fate = ideal.tilted(tilt)
    assert fate.leaves(0.5, 200.0) == pytest.approx(earliest, rel=1e-12)
    assert earliest <= run.events[-1].time <= earliest + ideal.round_time


# Resistance to rolling


def resisted(start: Any, velocity: Any, offset: float, duration: float) -> tuple[Any, Any, Any, Any]:
    """Return what theory says, the times, and the centre and radius of the circle by Newton and Euler."""
    ideal = show(position=start, velocity=velocity)
    theirs = Table(0.025, 0.51, 0.4, RATE, offset=offset).run(start, velocity, duration)
    t = np.linspace(0.0, duration, 200)
    state = theirs.sol(t)
    z, v = state[0] + 1j * state[1], state[3] + 1j * state[4]
    arm = v / (1j * KAPPA[BALL])
    return ideal.resisted(offset), t, z - arm, abs(arm)


def test_a_table_that_resists_rolling_against_newton_and_euler() -> None:
    ideal, offset = show(), 3e-4
    run = simulated(ideal, ideal.on(load=tr.RollingResistance(offset)), 20.0)
    theirs = Table(0.025, 0.51, 0.4, RATE, offset=offset).run((0.2, 0.05), (0.03, 0.1), 20.0)
    expected = theirs.sol(run.data.time.values)[:3].T
    assert np.abs(run.data.position.values - expected).max() < SOLVER(300, 1e-11)
    assert abs(run.data.position.values[-1] - expected[0]).max() > 0.1  # it does go somewhere


@pytest.mark.parametrize("offset", [1e-6, 1e-5])
@pytest.mark.parametrize(
    ("start", "velocity"), [((0.2, 0.05), (0.03, 0.1)), ((0.1, 0.0), (0.0, 0.1)), ((0.2, 0.0), (0.0, 0.02))]
)
def test_resistance_takes_the_centre_in_and_the_circle_out(start: Any, velocity: Any, offset: float) -> None:
    pull = offset * G / (0.025 * 1.4)
    duration = 0.05 * KAPPA[BALL] / pull  # in which the circle grows by 5 cm at most
    fate, t, centre, radius = resisted(start, velocity, offset, duration)
    # what a round leaves out, and what is of second order in the pull
    slack = fate.sway + 40 * pull**2 / KAPPA[BALL] ** 4 / 0.02
    assert fate.sway == pytest.approx(4 * pull / KAPPA[BALL] ** 2, rel=1e-12)
    assert max(abs(abs(c) - abs(fate.centre(s))) for s, c in zip(t, centre, strict=True)) < slack
    assert max(abs(A - fate.radius(s)) for s, A in zip(t, radius, strict=True)) < slack
    assert fate.radius(duration) > fate.radius(0.0) + 0.002
    assert abs(fate.centre(duration)) < abs(fate.centre(0.0))
    reach = max(abs(c) + A for c, A in zip(centre, radius, strict=True))
    assert reach <= max(fate.reach(s) for s in t)


def test_about_the_axis_the_circle_grows_at_the_speed_at_which_a_slope_drifts() -> None:
    # f = μ'ζ̇/|ζ̇| turns with the circle: dA/dt = μ'/κ = δg/(a k ω), as g sin α/(k ω) of a tilt with sin α = δ/a.
    ideal = show(position=(0.1, 0.0), velocity=(0.0, 0.1 * KAPPA[BALL]))
    fate, drift = ideal.resisted(2e-5), ideal.tilted(math.asin(2e-5 / 0.025))
    grown = (fate.radius(100.0) - fate.radius(0.0)) / 100.0
    assert grown == pytest.approx(abs(drift.centre(1.0) - drift.centre(0.0)), rel=1e-9)
    assert abs(fate.centre(100.0)) < 1e-15


@pytest.mark.parametrize("P", [1e-6, 1e-3, 0.3, 0.999, 1.0, 1.001, 7.0, 1e5])
def test_the_mean_over_a_round_against_quadrature(P: float) -> None:
    def part(angle: Any) -> Any:
        if P == 1:
            return mpmath.cos(angle / 2)
        return (P + mpmath.cos(angle)) / mpmath.sqrt(P * P + 1 + 2 * P * mpmath.cos(angle))

    mean = mpmath.quad(part, [0, 0.999 * mpmath.pi, mpmath.pi]) / mpmath.pi
    assert abs(_slope(P, 1.0) - float(mean)) < 1e-9 * float(mean)


# A table askew on its axle


@pytest.mark.parametrize("spin", [0.0, 25.0])
def test_a_wobbling_table_against_newton_and_euler(spin: float) -> None:
    ideal = show(spin=spin)
    angle = math.radians(2.0)
    run = simulated(ideal, ideal.on(motion=tr.Wobble(RATE, angle)), 20.0)
    theirs = Table(0.025, 0.51, 0.4, RATE, askew=angle).run((0.2, 0.05), (0.03, 0.1), 20.0, spin)
    expected = theirs.sol(run.data.time.values)[:3].T
    assert np.abs(run.data.position.values - expected).max() < SOLVER(300, 1e-11)


@pytest.mark.parametrize("spin", [0.0, 25.0])
def test_the_sway_is_of_first_order_and_the_rest_of_second(spin: float) -> None:
    def off(angle: float) -> float:
        ideal = show(spin=spin)
        z = path_of(simulated(ideal, ideal.on(motion=tr.Wobble(RATE, angle)), 15.0))
        t = np.arange(z.size) * STEP
        kappa, f = KAPPA[BALL], -1j * angle * (G + 0.4 * 0.025 * RATE * (RATE - spin)) / 1.4
        sway = -f / (RATE * (RATE - kappa))
        arm = (ideal.velocity - 1j * RATE * sway) / (1j * kappa)
        first = ideal.position - 1j * angle * 0.025  # the ball stands upright on a table that leans
        z_linear = first - sway - arm + arm * np.exp(1j * kappa * t) + sway * np.exp(1j * RATE * t)
        fate = ideal.wobbling(angle)
        assert fate.sway == pytest.approx(abs(sway), rel=1e-12)
        assert fate.radius(7.0) == pytest.approx(abs(arm), rel=1e-12)
        assert abs(fate.centre(7.0) - (first - sway - arm)) <= EXACT(64, 1.0)
        return float(np.abs(z - z_linear).max())

    assert off(0.002) / off(0.001) == pytest.approx(4.0, rel=0.05)


# An uneven rate: ζ̇ − iκ(t)ζ is constant


def uneven_path(ideal: Any, variation: float, nu: float, times: list[float]) -> list[complex]:
    """Return ζ = e^{iΘ}(ζ₀ + C ∫e^{−iΘ}), with the integral by quadrature."""
    k = ideal.system.body.inertia_ratio
    kappa = mpf(RATE) * k / (1 + k)
    constant = mpc(ideal.velocity) - 1j * kappa * mpc(ideal.position)

    def theta(t: Any) -> Any:
        return kappa * (t + mpf(variation) * (1 - mpmath.cos(nu * t)) / nu)

    found, integral, before = [], mpc(0), 0.0
    for t in times:
        integral += mpmath.quad(lambda s: mpmath.expj(-theta(s)), mpmath.linspace(before, t, 2 + int(t - before)))
        before = t
        found.append(complex(mpmath.expj(theta(t)) * (mpc(ideal.position) + constant * integral)))
    return found


@pytest.mark.parametrize(("variation", "nu"), [(0.1, RATE), (0.01, RATE), (0.3, 0.7), (0.05, KAPPA[BALL])])
def test_an_uneven_rate_against_its_quadrature(variation: float, nu: float) -> None:
    ideal = show()
    run = simulated(ideal, ideal.on(motion=tr.UnevenSpin(RATE, variation, nu)), 20.0)
    every = path_of(run)[::40]
    expected = uneven_path(ideal, variation, nu, run.data.time.values[::40].tolist())
    assert np.abs(every - expected).max() < SOLVER(500, 1e-15, 10.0)


def test_an_uneven_rate_leaves_the_circle_where_theory_has_it() -> None:
    ideal = show()
    run = simulated(
        ideal, ideal.on(motion=tr.UnevenSpin(RATE, 0.05, RATE)), 40 * ideal.round_time, ideal.round_time / 24
    )
    fate, z = ideal.uneven(0.05, RATE), path_of(run)
    # e^{iΘ} and the table's turn come to 2 rounds of 7 turns: over those the centre is the mean
    whole = 40 * 24
    assert abs(z[:whole].mean() - fate.centre(0.0)) < 1e-4 * abs(z).max()
    assert abs(z).max() <= fate.reach(0.0)
    assert abs(z).max() > abs(fate.centre(0.0)) + fate.radius(0.0) - fate.sway
    # about C/κ-centred circles nothing sways at all: the ball goes round the axis
    about = Demonstration(ideal.system, ideal.position, 1j * KAPPA[BALL] * ideal.position, 0.0)
    assert about.uneven(0.05, RATE).reach(0.0) == pytest.approx(abs(ideal.position), rel=1e-12)


@pytest.mark.parametrize(("variation", "nu"), [(0.3, 0.7), (0.5, 0.09), (0.2, 9.0)])
def test_the_ball_stays_within_the_reach_of_theory(variation: float, nu: float) -> None:
    ideal = show()
    fate, times = ideal.uneven(variation, nu), [float(t) for t in range(60)]
    path = uneven_path(ideal, variation, nu, times)
    assert all(abs(z) <= fate.reach(t) * (1 + 1e-12) for t, z in zip(times, path, strict=True))


def test_a_circle_over_the_rim_is_said_to_be_so() -> None:
    table = tr.sensitivity("off-the-rim", horizon="10 s")
    assert "over the rim even where all is perfect" in str(table)
    assert table.given.leaves == pytest.approx(1.959, abs=5e-4)  # what its notes tell
    assert "from" not in table.given.expected


def test_a_rate_that_varies_in_step_with_the_circle_throws_the_ball_off() -> None:
    ideal, kappa = show(), KAPPA[BALL]
    constant = abs(ideal.velocity - 1j * kappa * ideal.position)
    growth = constant * float(mpmath.besselj(1, 0.05))
    fate = ideal.uneven(0.05, kappa)
    assert (fate.radius(2000.0) - fate.radius(1000.0)) / 1000 == pytest.approx(growth, rel=1e-2)
    run = simulated(ideal, ideal.on(motion=tr.UnevenSpin(RATE, 0.05, kappa)), 300.0, rim=0.5)
    assert run.events
    assert run.events[-1].time >= fate.leaves(0.5, 300.0)
    assert run.events[-1].time == pytest.approx(fate.leaves(0.5, 300.0), rel=0.2)


# The drag of air


@pytest.mark.parametrize("reynolds", [1.0, 30.0, 330.0, 1660.0, 1e4, 1e5])
def test_the_drag_of_air_against_another_curve(reynolds: float) -> None:
    """Brown and Lawler, J. Environ. Eng. 129, 222 (2003): fitted anew to 480 measurements, up to Re = 2·10⁵."""
    density, viscosity, radius = 1.2041, 1.8134e-5, 0.025
    speed = reynolds * viscosity / (density * 2 * radius)
    theirs = 24 / reynolds * (1 + 0.15 * reynolds**0.681) + 0.407 / (1 + 8710 / reynolds)
    force = 0.5 * density * theirs * math.pi * radius**2 * speed**2
    assert tr.air_drag(radius, speed) == pytest.approx(force / speed, rel=0.1)  # what measurements scatter by


def test_the_drag_of_air_at_no_speed_is_stokes() -> None:
    assert tr.air_drag("2 cm", 0.0) == pytest.approx(6 * math.pi * 1.8134e-5 * 0.02, rel=1e-12)


# The table


@functools.cache
def table_of(name: str) -> tr.Sensitivity:
    return tr.sensitivity(name, horizon="10 min")


def test_the_worst_comes_first_and_those_that_stay_last() -> None:
    table = table_of("level-turntable-nudged")
    times = [math.inf if row.leaves is None else row.leaves for row in table.rows]
    assert times == sorted(times)
    assert {row.name for row in table.rows} == {
        *("tilt", "still-air", "turning-air", "rolling-resistance", "wobble", "uneven-rate")
    }
    assert table.rows[0].name == "tilt"
    # |c + i v t| + ϱ = 0.5 m with v = g sin 0.1° /(0.4 ω)
    omega, nudge = 33.3 * math.pi / 30, 0.1
    v = G * math.sin(math.radians(0.1)) / (0.4 * omega)
    kappa = omega * 2 / 7
    centre, radius = 0.2 - (nudge - v) / kappa, (nudge - v) / kappa
    earliest = math.sqrt((0.5 - radius) ** 2 - centre**2) / v
    assert table["tilt"].theory_leaves == pytest.approx(earliest, rel=1e-9)
    assert earliest <= table["tilt"].leaves <= earliest + 2 * math.pi / kappa
    for name in ("wobble", "still-air", "uneven-rate", "as-given"):
        assert table[name].leaves is None
        assert table[name].theory_leaves == math.inf


@pytest.mark.parametrize("name", ["level-turntable-nudged", "hollow-ball-turntable"])
def test_measured_and_theory_agree_on_how_the_circle_moves(name: str) -> None:
    for row in (*table_of(name).rows, table_of(name).given):
        assert row.motion is not None
        assert row.theory_motion is not None
        if row.name in {"turning-air", "still-air", "rolling-resistance"}:
            continue  # compared in tests of their own; a mean over a growth is not one number
        # m/s: what is of second order in the angle; a sway of half a millimetre, seen for ten minutes
        second = 4 * row.size**2 * 3.49 * table_of(name).offset if row.name == "wobble" else 0.0
        slack = {"wobble": second, "uneven-rate": 5e-4 / 600}.get(row.name, 1e-12)
        assert abs(row.motion.centre_rate - row.theory_motion.centre_rate) < slack
        assert abs(row.motion.radius_rate - row.theory_motion.radius_rate) < slack


def test_a_scenario_that_has_a_shortcoming_keeps_its_size() -> None:
    table = table_of("real-demonstration")
    own = {row.name: row.size for row in table.rows if row.own}
    assert own == pytest.approx({"tilt": math.radians(0.03), "wobble": math.radians(0.1), "still-air": 8e-5}, rel=1e-15)
    assert table["uneven-rate"].size == 0.01
    assert table["turning-air"].size == pytest.approx(tr.air_drag(0.025, 0.25), rel=0.01)
    light = table_of("real-demonstration-light-ball")
    assert {row.name for row in light.rows if row.own} == {"turning-air", "uneven-rate"}


def test_sizes_can_be_given() -> None:
    scenario = tr.Scenario.load("real-demonstration")
    sizes = {
        "tilt": "1 deg",
        "drag": "2 g/s",
        "rolling_resistance": "10 um",
        "wobble": "0.5 deg",
        "variation": 0.02,
        "variation_rate": "10 rpm",
    }
    table = tr.sensitivity(scenario.system(), scenario.start_state(), **sizes, horizon=20.0)
    assert not any(row.own for row in table.rows)
    assert table["tilt"].size == pytest.approx(math.pi / 180)
    assert (table["still-air"].size, table["turning-air"].size, table["uneven-rate"].size) == (2e-3, 2e-3, 0.02)
    assert table["uneven-rate"].size_text == "2 %, every 6 s"
    assert table["wobble"].size_text == "0.5°"
    assert table["rolling-resistance"].size == pytest.approx(1e-5)


def test_a_scenario_that_resists_keeps_its_resistance() -> None:
    system = replace(PLAIN, loads=(tr.RollingResistance("3 um"),))
    table = tr.sensitivity(system, system.place((0.1, 0.0), (0.0, 0.1)), horizon="1 min")
    assert [row.name for row in table.rows if row.own] == ["rolling-resistance"]
    assert table["rolling-resistance"].size == 3e-6
    assert table["rolling-resistance"].motion == table.given.motion


@pytest.mark.parametrize("start", [(0.1, 0.0), (0.0, 0.0)])
def test_a_ball_that_a_table_holds_fast_stays_or_is_said_to_stop(start: Any) -> None:
    riding = tr.sensitivity(PLAIN, PLAIN.place(start, "co-rotating"), rolling_resistance="5 mm", horizon="1 min")
    assert riding["rolling-resistance"].outcome == "stays"
    spinning = tr.sensitivity(PLAIN, PLAIN.place(start, (0.0, 0.1)), rolling_resistance="5 mm", horizon="1 min")
    assert spinning["rolling-resistance"].outcome.startswith("stops after")


def test_json_says_the_same_in_si() -> None:
    table = table_of("real-demonstration")
    told = json.loads(table.as_json())
    assert [row["name"] for row in told["rows"]] == [row.name for row in table.rows]
    assert told["as_given"]["leaves"] == table.given.leaves
    assert told["rows"][0]["size"] == table.rows[0].size


def test_text_and_figure_show_every_row() -> None:
    table = table_of("real-demonstration")
    figure = table.plot()
    shown = " ".join(text.get_text() for text in figure.texts).replace("\n", " ")
    for row in (*table.rows, table.given):
        assert row.label in str(table)
        assert row.outcome in str(table)
        assert row.label in shown
    words = {text.get_text() for text in figure.axes[0].texts}
    assert {"off after 114 s", "stays"} <= words


PLAIN = tr.RollingSystem(BALL, tr.Support(tr.Plane(rim=0.5), motion=tr.Spin(RATE)))
REFUSED = {
    "support.rim": replace(PLAIN, support=replace(PLAIN.support, surface=tr.Plane())),
    "support.motion": replace(PLAIN, support=replace(PLAIN.support, motion=tr.Fixed())),
    "loads": replace(PLAIN, loads=(tr.Force((0.1, 0, 0)),)),
}


@pytest.mark.parametrize("key", REFUSED)
def test_what_is_no_such_demonstration_is_refused(key: str) -> None:
    system = REFUSED[key]
    with pytest.raises(tr.InvalidValueError) as refused:
        tr.sensitivity(system, system.place((0.1, 0.0)))
    assert refused.value.key == key


@pytest.mark.parametrize(
    ("key", "given"),
    [
        ("tilt", "3 kg"),
        ("tilt", "95 deg"),
        ("drag", -1.0),
        ("horizon", "0 s"),
        ("horizon", "1 s"),
        ("horizon", "1e9 s"),
    ],
)
def test_a_wrong_value_is_named(key: str, given: Any) -> None:
    with pytest.raises(tr.InvalidValueError) as refused:
        tr.sensitivity(PLAIN, PLAIN.place((0.1, 0.0), (0.0, 0.1)), **{key: given})
    assert refused.value.key == key


def test_a_ball_at_rest_has_a_circle_of_no_size() -> None:
    table = tr.sensitivity(PLAIN, PLAIN.place((0.1, 0.0)), horizon="1 min")
    assert table.radius == 0.0
    assert table["as-given"].motion is not None
    assert table["as-given"].motion.size < 1e-15
    assert table["tilt"].leaves is not None


def test_the_table_may_turn_the_other_way() -> None:
    def times(sign: float) -> list[float]:
        system = replace(PLAIN, support=replace(PLAIN.support, motion=tr.Spin(sign * RATE)))
        table = tr.sensitivity(system, system.place((0.1, 0.0), (0.0, sign * 0.1)), horizon="5 min")
        assert all(row.leaves is None or row.theory_leaves <= row.leaves for row in table.rows)
        return [row.leaves for row in table.rows if row.leaves is not None]

    there, back = times(1.0), times(-1.0)
    assert there
    assert there == pytest.approx(back, rel=1e-9)  # the mirror image


def test_the_command(tmp_path: Any, capsys: Any) -> None:
    from trundle.cli import run

    words = ["sensitivity", "level-turntable-nudged", "--horizon", "1 min", "-o", str(tmp_path)]
    assert run(words) == 0
    assert (tmp_path / "sensitivity.png").stat().st_size > 10_000
    out = capsys.readouterr().out
    assert "table not level" in out
    assert "Wrote" in out
    assert run([*words, "--json", "--no-figure"]) == 0
    assert json.loads(capsys.readouterr().out)["horizon"] == 60
    assert run([*words, "--uneven", "1 kg"]) == 2
    assert "`--uneven` must be a number" in capsys.readouterr().err
    assert run([*words, "--rolling-resistance", "-1 mm"]) == 2
    assert "`--rolling-resistance` must not be negative" in capsys.readouterr().err
    endless = tmp_path / "endless.toml"
    endless.write_text(tr.Scenario.load("tilted-turntable").to_toml().replace('rim = "0.5 m"\n', ""), encoding="utf-8")
    assert run(["sensitivity", str(endless)]) == 2
    assert "`support.rim` must be given" in capsys.readouterr().err
