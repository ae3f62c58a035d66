"""Steady motions of balls against closed forms, symmetries against what is known, and refusals."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from tests.tolerances import SOLVER

import trundle as tr
from trundle.analysis.steady.finding import flow_of
from trundle.analysis.steady.runs import slope_of_run
from trundle.analysis.steady.symmetry import group_matrix, symmetries
from trundle.mechanics.algebra import E_Z, Vector

G = 9.80665
SOLID, SHELL = tr.Body.solid_sphere(0.1, 2.0), tr.Body.hollow_sphere(0.1, 2.0)


def on_sphere(body: tr.Body, b: float, rate: float) -> tr.RollingSystem:
    """On a dome of radius b, or in a bowl of radius −b."""
    surface = tr.Dome(b) if b > 0 else tr.Bowl(-b)
    return tr.RollingSystem(body, tr.Support(surface, motion=tr.Spin(rate)))


def top(body: tr.Body, b: float, rate: float, spin: float, cosine: float) -> tuple[float, float, float]:
    """The ball on a sphere is a gyroscopic top: with R = a + b and the constant W = aΩ·n + bω n·e its normal obeys

    (1 + k) R n×n̈ = −g n×e − k W ṅ,   for a bowl with −b. Return (1 + k)R, k W and g.
    """
    a, k = body.radius, body.inertia_ratio
    return (1 + k) * (a + b), k * (a * spin + b * rate * cosine), G


@pytest.mark.parametrize("body", [SOLID, SHELL])
@pytest.mark.parametrize(
    ("b", "rate", "spin"), [(0.5, 0.0, 0.0), (0.5, 0.0, 90.0), (0.5, 60.0, -3.0), (-0.5, 25.0, 40.0)]
)
def test_on_top_of_a_dome_and_at_the_bottom_of_a_bowl(body: tr.Body, b: float, rate: float, spin: float) -> None:
    system = on_sphere(body, b, rate)
    (motion,) = tr.steady_motions(system, system.place(spin=spin))
    mu, gyro, g = top(body, b, rate, spin, 1.0)
    expected = np.roots([mu, -1j * gyro, -g])  # (1 + k)R ν̈ − i k W ν̇ − g ν = 0 in the complex ν = n_x + i n_y
    found = [mode.rate for mode in motion.modes]
    for value in expected:
        assert min(min(abs(value - one), abs(np.conj(value) - one)) for one in found) < 1e-10 * abs(value)
    assert motion.dimension == 1  # its spin
    assert motion.checked < SOLVER(1e5, 1e-15)


@pytest.mark.parametrize("body", [SOLID, SHELL])
def test_a_ball_must_spin_fast_to_stay_on_a_sphere(body: tr.Body) -> None:
    """(kaΩ)² > 4(1 + k)(a + b)g, that is Ω² > 35 g(a + b)/a² for a solid ball (routh1905)."""
    a, b, k = body.radius, 0.5, body.inertia_ratio
    system = on_sphere(body, b, 0.0)
    limit = math.sqrt(4 * (1 + k) * (a + b) * G) / (k * a)
    if body is SOLID:
        assert limit**2 == pytest.approx(35 * G * (a + b) / a**2)
    (motion,) = tr.steady_motions(system, system.place(spin=0.7 * limit))
    assert motion.verdict == "unstable"
    assert motion.along("spin", 0.5 * limit, 1.5 * limit, count=3).limits == (pytest.approx(limit, rel=1e-10),)


def test_a_dome_must_spin_fast_to_keep_a_ball() -> None:
    """With the ball's own spin zero only b ω counts: (k b ω)² > 4(1 + k)(a + b)g."""
    a, b, k = 0.1, 0.5, 0.4
    limit = math.sqrt(4 * (1 + k) * (a + b) * G) / (k * b)
    system = on_sphere(SOLID, b, 1.3 * limit)
    (motion,) = tr.steady_motions(system, system.place(spin=0.0))
    assert motion.verdict == "stable to first order"
    sweep = motion.along("rate", 0.5 * limit, 1.5 * limit, count=3)
    assert sweep.limits == (pytest.approx(limit, rel=1e-10),)


@pytest.mark.parametrize(
    ("b", "rate", "place", "speed", "spin"),
    [
        (-0.5, 0.0, 0.3, 2.0, 1.0),
        (-0.5, 12.0, 0.25, 1.5, -8.0),
        (-0.5, 0.0, 0.45, 4.0, 60.0),
        (0.5, 80.0, 0.2, 0.3, 9.0),
    ],
)
def test_circling_on_a_sphere_is_a_tops_steady_precession(
    b: float, rate: float, place: float, speed: float, spin: float
) -> None:
    system = on_sphere(SOLID, b, rate)
    start = system.place(position=(place, 0.0), velocity=(0.0, speed), spin=spin)
    (motion,) = tr.steady_motions(system, start)
    assert (motion.kind, motion.dimension) == ("circles", 2)
    now = motion.relative.flow.law(motion.relative.y)
    cosine, P = float(now.contact.normal.z), motion.turning
    mu, gyro, g = top(SOLID, b, rate, motion.quantities["spin"], cosine)
    assert mu * P * P * cosine - gyro * P + g == pytest.approx(0.0, abs=1e-11 * g)
    # Nutation: V_eff = (p − kW cos θ)²/(2μ sin²θ) + g cos θ, frequency² = V_eff″/μ, by mpmath.
    p = mu * (1 - cosine**2) * P + gyro * cosine

    def potential(theta: mp.mpf) -> mp.mpf:
        return (p - gyro * mp.cos(theta)) ** 2 / (2 * mu * mp.sin(theta) ** 2) + g * mp.cos(theta)

    with mp.workdps(40):
        square = float(mp.diff(potential, mp.acos(mp.mpf(cosine)), 2) / mu)
    assert (motion.modes[0].rate ** 2).real == pytest.approx(-square, rel=1e-9)
    assert motion.checked < SOLVER(1e6, 1e-15)


@pytest.mark.parametrize("body", [SOLID, SHELL])
def test_the_golfers_dilemma(body: tr.Body) -> None:
    """In an upright cylinder the ball bobs at sqrt(k/(1 + k)) of the rate at which it goes round."""
    system = tr.RollingSystem(body, tr.Support(tr.Cylinder(0.6)))
    (motion,) = tr.steady_motions(system, system.place(velocity=(3.0, 0.0)))
    k = body.inertia_ratio
    assert motion.frequencies == (pytest.approx(math.sqrt(k / (1 + k)) * abs(motion.turning), rel=1e-12),)


def test_on_a_turntable_everything_turns_at_kappa() -> None:
    system = tr.RollingSystem(SHELL, tr.Support(tr.Plane(), motion=tr.Spin(5.0)))
    (motion,) = tr.steady_motions(system, system.place(spin=1.0))
    assert motion.frequencies == (pytest.approx(2.0, rel=1e-12),)  # κ = ω k/(1 + k)


def test_drag_on_a_slope_has_a_terminal_velocity() -> None:
    system = tr.RollingSystem(SOLID, tr.Support(tr.Plane(), tilt=0.1), loads=(tr.Drag(4.0),))
    (motion,) = tr.steady_motions(system)
    assert motion.kind == "rolls straight"
    assert motion.quantities["speed"] == pytest.approx(2.0 * G * math.sin(0.1) / 4.0, rel=1e-12)
    assert motion.verdict == "stable"
    assert [mode.growth for mode in motion.modes] == [pytest.approx(-4.0 / (2.0 * 1.4), rel=1e-10)] * len(motion.modes)


def test_time_run_backwards_turns_every_growth_round() -> None:
    """A rattleback that spins steadily: one way a nudge grows, the other way it dies away, at the same rates."""
    ellipsoid = tr.Body.ellipsoid((0.10, 0.02, 0.015), mass=0.1, moments=(2e-5, 3e-4, 3e-4), products=(2e-5, 0.0, 0.0))
    system = tr.RollingSystem(ellipsoid, tr.Support(tr.Plane()))
    rates = []
    for spin in (5.0, -5.0):
        (motion,) = tr.steady_motions(system, system.place(spin=spin))
        assert motion.kind == "turns on the spot"
        assert motion.checked < SOLVER(1e6, 1e-15)
        rates.append(sorted((mode.growth, mode.frequency) for mode in motion.modes))
    assert max(abs(growth) for growth, _ in rates[0]) > 1e-3
    flat = sorted((-growth, frequency) for growth, frequency in rates[1])
    assert np.allclose(rates[0], flat, rtol=1e-8, atol=1e-8)


def test_a_ball_stays_on_a_saddle_that_turns_fast_enough() -> None:
    surface = tr.HeightField("2*(x*x - y*y)")
    ball = tr.Body.solid_sphere(0.01, 0.01)
    slow, fast = (tr.RollingSystem(ball, tr.Support(surface, motion=tr.Spin(rate))) for rate in (3.0, 12.0))
    for system, verdict in ((slow, "unstable"), (fast, "stable to first order")):
        (motion,) = tr.steady_motions(system, system.place(velocity="co-rotating"))
        assert (motion.frame, motion.verdict) == ("turning with the support", verdict)
        assert motion.checked < SOLVER(1e6, 1e-15)


# --- symmetries -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("body", "support", "gravity", "count"),
    [
        (SOLID, tr.Support(tr.Plane()), G, 6),  # two shifts, a turn, three of the ball
        (SOLID, tr.Support(tr.Plane(), motion=tr.Spin(2.0)), G, 4),
        (SOLID, tr.Support(tr.Plane(), tilt=0.2), G, 5),
        (SOLID, tr.Support(tr.Cylinder(0.6)), G, 5),
        (SOLID, tr.Support(tr.Bowl(0.6)), G, 4),
        (SOLID, tr.Support(tr.Bowl(0.6)), 0.0, 6),  # all turns about the bowl's centre, which is not the origin
        (tr.Body.disc(0.1, 1.0), tr.Support(tr.Plane()), G, 4),
        (tr.Body.ellipsoid((0.1, 0.08, 0.06), mass=1.0), tr.Support(tr.Plane()), G, 3),
        (tr.Body.ellipsoid((0.1, 0.1, 0.06), mass=1.0), tr.Support(tr.Plane()), G, 4),
    ],
)
def test_the_law_is_asked_for_its_symmetries(body: tr.Body, support: tr.Support, gravity: float, count: int) -> None:
    system = tr.RollingSystem(body, support, gravity=gravity)
    flow, y = flow_of(system, system.place(velocity=(0.4, 0.2), spin=1.0, orientation=(0.8, 0.5, 0.2, 0.1)))
    assert len(symmetries(flow, y)) == count
    by_differences = replace(flow, by_complex_step=False)
    assert len(symmetries(by_differences, y)) == count
    exact = flow.slopes(flow.rates, y, np.diag(flow.scale))
    rough = by_differences.slopes(flow.rates, y, np.diag(flow.scale))
    assert np.allclose(exact, rough, rtol=1e-9, atol=1e-10 * np.abs(exact).max())


def test_differences_of_runs_are_heyokas_variational_equations() -> None:
    import heyoka

    from trundle.mechanics.parameters import numbers
    from trundle.solve.tracing import state_rates

    system = tr.RollingSystem(tr.Body.disc(1.0, 1.0), tr.Support(tr.Plane()))
    flow, y = flow_of(system, system.place(velocity=(2.0, 0.1), spin=1.0, orientation=(0.8, 0.6, 0.0, 0.0)))
    variables = heyoka.make_vars(*[f"x{i}" for i in range(10)])
    rates = [
        rate if isinstance(rate, heyoka.expression) else heyoka.expression(float(rate))
        for rate in state_rates(system, heyoka.time, variables)
    ]
    varied = heyoka.var_ode_sys(list(zip(variables, rates, strict=True)), heyoka.var_args.vars, order=1)
    integrator = heyoka.taylor_adaptive(varied, y.tolist(), compact_mode=True)
    integrator.propagate_until(0.8)
    exact = integrator.state[10:].reshape(10, 10)
    nudges = flow.scale[:, None] * flow.tangent(y)
    found = slope_of_run(flow, y, nudges, 0.8, np.eye(11))
    assert len(numbers(system)) > 0
    assert np.abs(found - exact @ nudges).max() < SOLVER(1e6, 1e-15, np.abs(exact @ nudges).max())


# --- periodic motions -----------------------------------------------------------------------------------------


def test_small_swings_in_an_elliptic_bowl_have_the_multipliers_of_the_other_swing() -> None:
    """Along one axis of the bowl the ball swings; a nudge across swings at its own frequency meanwhile."""
    ball = tr.Body.solid_sphere(0.02, 1.0)
    system = tr.RollingSystem(ball, tr.Support(tr.HeightField("x*x + 0.8*y*y")))
    (rest,) = tr.steady_motions(system)
    low, high = rest.frequencies
    for curvature, frequency in ((1.6, low), (2.0, high)):  # a pendulum on the parallel surface, slowed by 1 + k
        assert frequency == pytest.approx(math.sqrt(G * curvature / (1 - 0.02 * curvature) / 1.4), rel=1e-12)
    swing = tr.periodic_motion(system, system.place(position=(1e-4, 0.0)))
    assert swing.period == pytest.approx(2 * math.pi / high, rel=1e-5)
    angle = 2 * math.pi * low / high
    across = [value for value in swing.multipliers if abs(value - 1) > 1e-3]
    assert len(across) == 2
    assert np.allclose(sorted(value.real for value in across), math.cos(angle), rtol=0, atol=1e-5)
    assert swing.verdict == "stable to first order"


def test_a_nodding_coin_repeats_and_is_neutral() -> None:
    system = tr.RollingSystem(tr.Body.disc(0.1, 1.0), tr.Support(tr.Plane()))
    start = system.place(velocity=(0.9, 0.0), spin=1.0, orientation=(math.cos(0.7), math.sin(0.7), 0.0, 0.0))
    motion = tr.periodic_motion(system, start)
    assert motion.residual < 1e-12
    assert (motion.free, motion.verdict) == (4, "neutral")
    run = tr.simulate(system, start, duration=motion.period, every=motion.period)
    n = E_Z
    for state in (0, -1):
        V, Omega = (Vector.of(run.data[name].values[state]) for name in ("velocity", "angular_velocity"))
        first = Vector(*start.velocity), Vector(*start.angular_velocity)
        assert V.norm() == pytest.approx(first[0].norm(), rel=1e-10)
        assert Omega.dot(n) == pytest.approx(first[1].dot(n), rel=1e-10)


def test_a_group_move_is_the_motion_it_says() -> None:
    turned = group_matrix(np.array([0, 0, 0, 0, 0, math.pi / 2, 0, 0, 0])) @ np.array(
        [1.0, 0, 0, 1, 0, 0, 0, 2.0, 0, 0, 1]
    )
    assert np.allclose(turned[:10], [0, 1, 0, 0.5**0.5, 0, 0, 0.5**0.5, 0, 2, 0], atol=1e-15)


# --- none, and refused ----------------------------------------------------------------------------------------


def test_where_there_is_none_it_says_why() -> None:
    found = tr.steady_motions(tr.RollingSystem(SOLID, tr.Support(tr.Plane(), tilt=0.1)))
    assert len(found) == 0
    assert "differ from those of a symmetry" in found.reason
    assert "no steady motion" in str(found)


def test_a_motion_in_which_the_support_would_pull_is_none() -> None:
    system = on_sphere(SOLID, 0.5, 0.0)
    far = system.place(position=(0.3, 0.0), velocity=(0.0, 1.0), spin=200.0)
    found = tr.steady_motions(system, far)
    assert all(motion.stands for motion in found)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"loads": (tr.Force(("0.1*sin(3*t)", 0.0, 0.0)),)}, "must look the same at all times"),
        ({"support": tr.Support(tr.Plane(), motion=tr.UnevenSpin(3.0, 0.1, 2.0))}, "must be steady"),
        ({"body": tr.Body.hoop(0.1, 1.0)}, "must touch at a point"),
    ],
)
def test_what_it_refuses(change: dict[str, object], said: str) -> None:
    system = replace(tr.RollingSystem(SOLID, tr.Support(tr.Plane())), **change)
    with pytest.raises(tr.InvalidValueError, match=said):
        tr.steady_motions(system)


def test_names_of_quantities_are_checked() -> None:
    system = tr.RollingSystem(SOLID, tr.Support(tr.Plane()))
    start = system.place(velocity=(1.0, 0.0))
    with pytest.raises(tr.UnknownNameError, match="Did you mean 'speed'"):
        tr.steady_motions(system, start, holding="sped")
    with pytest.raises(tr.InvalidValueError, match="one axis of symmetry"):
        tr.steady_motions(system, start, holding="lean")
    (motion,) = tr.steady_motions(system, start)
    with pytest.raises(tr.InvalidValueError, match="support at rest"):
        motion.along("rate")
    with pytest.raises(tr.InvalidValueError, match="must be above the lowest"):
        motion.along("speed", 2.0, 1.0)
    with pytest.raises(tr.SolverError, match="is a steady motion"):
        tr.periodic_motion(system, start)


@pytest.mark.parametrize("rate", [-3.0, 0.5, 3.0])
def test_what_runs_off_the_rim_before_it_comes_back_has_no_period(rate: float) -> None:
    system = tr.RollingSystem(SOLID, tr.Support(tr.Plane(rim=0.3), motion=tr.Spin(rate)))
    start = system.place(position=(0.25, 0.0), velocity=(0.5, -1.0))
    with pytest.raises(tr.SolverError, match=r"The motion does not come back: it ran off the rim \(0\.3 m"):
        tr.periodic_motion(system, start)


def test_runs_are_compared_with_the_linear_law_while_they_are_on_the_table() -> None:
    system = tr.RollingSystem(SOLID, tr.Support(tr.Plane(rim=0.3)))
    (motion,) = tr.steady_motions(system, system.place(position=(0.295, 0.0), velocity=(0.3, 0.0)))
    assert motion.checked < SOLVER(1e5, 1e-15)
