"""The charge against the Lorentz force integrated by others, and the ball against the charge."""

from __future__ import annotations

import math
import random
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.precise import precisely
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.analysis.analogy import ELECTRON_MASS, ELEMENTARY_CHARGE
from trundle.solve.methods import tolerance_of

BALL = tr.Body.solid_sphere(radius=0.025, mass=0.065)


def lorentz(particle: tr.ChargedParticle, t: float) -> Any:
    """Return position and velocity by the exponential of the equations of motion's matrix, at many digits."""
    M, Q, B, C = (mpmath.mpf(x) for x in (particle.mass, particle.charge, particle.magnetic_field, particle.resistance))
    Ex, Ey = (mpmath.mpf(x) for x in particle.electric_field)
    # d(x, y, vx, vy, 1)/dt, with F = Q(E + v×B ẑ) − C v written out.
    rows = [
        [0, 0, 1, 0, 0],
        [0, 0, 0, 1, 0],
        [0, 0, -C / M, Q * B / M, Q * Ex / M],
        [0, 0, -Q * B / M, -C / M, Q * Ey / M],
        [0, 0, 0, 0, 0],
    ]
    start = mpmath.matrix([*particle.position, *particle.velocity, 1])
    return (mpmath.expm(mpmath.matrix(rows) * mpmath.mpf(t)) * start)[:4]


def some(seed: int, **given: Any) -> tr.ChargedParticle:
    draw = random.Random(seed)  # noqa: S311

    def number() -> float:
        return draw.uniform(-1.0, 1.0)

    values: dict[str, Any] = {
        "mass": draw.uniform(0.2, 2.0),
        "charge": draw.choice((-1, 1)) * draw.uniform(0.3, 2.0),
        "magnetic_field": number(),
        "electric_field": (number(), number()),
        "position": (number(), number()),
        "velocity": (number(), number()),
    }
    return tr.ChargedParticle(**values | given)


@pytest.mark.parametrize("resistance", [0.0, 1e-9, 0.3])
@pytest.mark.parametrize("field", [0.7, -1.3, 1e-3, 1e-9, 1e-200, 0.0])
@precisely
def test_the_path_is_that_of_the_lorentz_force(field: float, resistance: float) -> None:
    for seed in range(4):
        charge = some(seed, magnetic_field=field, resistance=resistance)
        for t in (0.0, 1e-7, 0.3, 1.7, 9.0, -2.0):
            exact = lorentz(charge, t)
            ours = (*charge.position_at(t), *charge.velocity_at(t))
            size = max(1.0, *(abs(float(part)) for part in exact))
            steepness = 1 + abs(t) * (abs(charge.gyration_rate) + charge.resistance / charge.mass)
            for part, wanted in zip(ours, exact, strict=True):
                assert abs(part - wanted) <= EXACT(16 * steepness, size)


def test_the_path_is_that_of_a_force_integrated_step_by_step() -> None:
    from scipy.integrate import solve_ivp

    charge = some(5, magnetic_field=2.0)
    (ex, ey), b, share = charge.electric_field, charge.magnetic_field, charge.charge / charge.mass

    def rates(_: float, s: Any) -> Any:
        return s[2], s[3], share * (ex + s[3] * b), share * (ey - s[2] * b)

    times = np.linspace(0.0, 12.0, 60)
    run = solve_ivp(rates, (0, 12), [*charge.position, *charge.velocity], "DOP853", times, rtol=1e-12, atol=1e-12)
    apart = np.abs(np.stack([*charge.position_at(times), *charge.velocity_at(times)]) - run.y).max()
    assert apart < SOLVER(100, 1e-12, np.abs(run.y).max())


def test_the_mean_motion_is_the_textbooks_drift() -> None:
    # E×B/B², whatever the charge, the mass and the speed: the mean over whole turns.
    fields = {"magnetic_field": -0.8, "electric_field": (0.5, -0.3)}
    E, B = np.array([*fields["electric_field"], 0.0]), np.array([0.0, 0.0, fields["magnetic_field"]])
    drift = (np.cross(E, B) / (B @ B))[:2]
    for seed in range(6):
        charge = some(seed, **fields)
        x, y = charge.position_at(np.array([0.0, charge.period]))
        moved = np.array([np.ptp(x), np.ptp(y)]) * np.sign([x[1] - x[0], y[1] - y[0]]) / charge.period
        assert np.abs(moved - drift).max() < EXACT(64, 2.0)
        assert np.abs(np.array(charge.drift_velocity) - drift).max() < EXACT(4, 1.0)
        # Its distance from the guiding centre stays the Larmor radius.
        t = np.linspace(0.0, 20.0, 101)
        (x, y), (cx, cy) = charge.position_at(t), charge.guiding_centre(t)
        assert np.abs(np.hypot(x - cx, y - cy) - charge.larmor_radius).max() < EXACT(256, 20.0)


def test_the_energy_is_kept() -> None:
    t = np.linspace(0.0, 30.0, 301)
    for seed in range(4):
        charge = some(seed)
        (x, y), (vx, vy) = charge.position_at(t), charge.velocity_at(t)
        kinetic = 0.5 * charge.mass * (vx**2 + vy**2)
        assert np.ptp(kinetic + charge.potential_energy(x, y)) < EXACT(4096, kinetic.max())


def test_a_positive_charge_turns_clockwise_about_a_field_at_the_reader() -> None:
    charge = tr.ChargedParticle(1.0, 1.0, 1.0, velocity=(1.0, 0.0))
    assert charge.velocity_at(math.pi / 2)[1] == pytest.approx(-1.0)
    assert charge.guiding_centre(0.0) == (0.0, -1.0)


@pytest.mark.parametrize("resistance", [0.2, 5.0])
def test_in_a_medium_it_ends_in_the_balance_of_forces(resistance: float) -> None:
    charge = some(2, resistance=resistance)
    v = np.array(charge.velocity_at(400.0 * charge.mass / resistance))
    force = charge.charge * (np.array(charge.electric_field) + charge.magnetic_field * np.array([v[1], -v[0]]))
    assert np.abs(force - resistance * v).max() < EXACT(32, 4.0)


# --- the ball --------------------------------------------------------------------------------------------


def turntable(seed: int, **given: Any) -> tuple[tr.RollingSystem, tr.State]:
    draw = random.Random(seed)  # noqa: S311
    rate = given.get("rate", draw.uniform(-6, 6))
    motion = tr.Spin(rate) if rate else tr.Fixed()
    table = tr.Support(tr.Plane(), motion=motion, tilt=given.get("tilt", draw.uniform(-0.1, 0.1)))
    body = tr.Body.sphere(0.02, draw.uniform(0.01, 1.0), draw.uniform(0.2, 2 / 3))
    system = tr.RollingSystem(body, table, given.get("loads", ()))
    at, going = [(draw.uniform(-0.3, 0.3), draw.uniform(-0.3, 0.3)) for _ in range(2)]
    return system, system.place(at, going)


LOADS = [
    (),
    (tr.Drag(0.004),),
    (tr.Force((0.02, -0.01, 0.03)), tr.Torque((1e-4, 2e-4, 3e-4))),
    (tr.Drag(0.02), tr.Force((0.0, 0.05, 0.0))),
]


@pytest.mark.parametrize("loads", LOADS, ids=["no load", "drag", "force and torque", "drag and force"])
def test_ball_and_charge_take_one_path(loads: Any) -> None:
    for seed in range(8):
        pair = tr.twin(*turntable(seed, loads=loads), charge=-0.3, mass="2 g")
        assert pair.largest_difference(30.0) <= pair.rounding(30.0)


@pytest.mark.parametrize("rate", [0.0, 1e-12, 1e-5, 3.0])
def test_the_general_law_takes_the_charges_path(rate: float) -> None:
    # The ball by the rolling law, step by step; the charge by its own formulas: no closed form of the ball in between.
    system, start = turntable(3, rate=rate, tilt=0.05, loads=(tr.Torque((0.0, 3e-4, 0.0)),))
    run = tr.simulate(system, start, 4.0, 0.1, "runge-kutta")
    charge = tr.twin(system, start).particle
    ours = np.stack(charge.position_at(run.data.time.values), axis=-1)
    rolled = run.data.position.values[:, :2]
    turned = np.linalg.norm(run.data.angular_velocity.values, axis=1).max() * 4.0
    assert np.abs(ours - rolled).max() < SOLVER(4 * turned, tolerance_of("runge-kutta"), np.abs(rolled).max())


def test_a_slower_ball_takes_the_electrons_path_a_million_times_later() -> None:
    pair = tr.twin(tr.Scenario.load("tilted-turntable"), electron=True)
    assert (pair.particle.mass, pair.particle.charge) == (ELECTRON_MASS, -ELEMENTARY_CHARGE)
    assert pair.slow_motion == 1e6
    assert pair.largest_difference(20.0) <= pair.rounding(20.0)
    # By hand, from the lecture: B = (2/7) ω M/e · 10⁶ at the reader, and E/B the drift, a million times 0.0368116 m/s.
    B = 2 / 7 * 33.3 * 2 * math.pi / 60 * ELECTRON_MASS / ELEMENTARY_CHARGE * 1e6
    assert abs(pair.particle.magnetic_field - B) < EXACT(16, B)
    ratio = pair.particle.electric_field[0] / pair.particle.magnetic_field
    assert abs(ratio + 9.80665 * math.sin(math.radians(0.3)) / (0.4 * 33.3 * math.pi / 30) * 1e6) < EXACT(32, 4e5)


@pytest.mark.parametrize(("force", "pace"), [(False, 1.0), (True, 1.0), (True, 50.0)])
def test_there_and_back(force: bool, pace: float) -> None:
    loads = (tr.Drag(0.01),) if not force else (tr.Force((0.01, 0.02, 0.0)),)
    tilt = 0.0 if force else 0.04
    system, start = turntable(4, rate=2.5, tilt=tilt, loads=loads)
    pair = tr.twin(system, start, charge=-2.0, mass=0.3, slow_motion=pace)
    back, again = tr.to_turntable(pair.particle, system.body, slow_motion=pace, force=force)
    assert abs(back.support.motion.rate - 2.5) < EXACT(8, 2.5)
    assert abs(back.support.tilt - tilt) < EXACT(16, 0.04)
    if force:
        (load,) = back.loads
        assert np.abs(np.array(tuple(load.value)) - (0.01, 0.02, 0.0)).max() < EXACT(16, 0.02)
    else:
        assert abs(back.loads[0].coefficient - 0.01) < EXACT(16, 0.01)
    assert np.abs(np.array(again.velocity) - start.velocity).max() < EXACT(4, 0.3)
    assert again.position == start.position


def test_a_level_line_is_a_line_of_equal_potential() -> None:
    system, start = turntable(6, rate=3.0, tilt=0.08)
    pair = tr.twin(system, start)
    t = np.linspace(0.0, 9.0, 50)
    centre = pair.particle.guiding_centre(t)
    energy = pair.particle.potential_energy(*centre)
    assert np.ptp(energy) < EXACT(64, pair.particle.mass)
    assert np.ptp(centre[0]) < EXACT(64, 1.0)  # x is the height on the slope
    # And both go along together: m g h of the ball is (1 + k) times the charge's energy, as the ball's inertia is.
    ball, _ = pair.paths(t)
    falls = system.body.mass * 9.80665 * math.sin(0.08) * -ball[:, 0]
    asked = (1 + system.body.inertia_ratio) * pair.particle.potential_energy(*ball.T)
    assert np.abs(falls - asked).max() < EXACT(32, 0.1)


# --- what is refused -------------------------------------------------------------------------------------


def test_what_has_no_counterpart_is_refused() -> None:
    airy, start = turntable(1, loads=(tr.Drag(0.01, air=2.0),))
    with pytest.raises(tr.OutOfDomainError, match="Nothing corresponds to this: the load drag"):
        tr.twin(airy, start)
    lopsided = tr.Body(0.1, tr.Principal(1e-5, 2e-5, 2e-5), tr.Sphere(0.02))
    system = tr.RollingSystem(lopsided, tr.Support(tr.Plane()))
    with pytest.raises(tr.OutOfDomainError, match="no sphere or cylinder with isotropic inertia"):
        tr.twin(system, system.place())
    with pytest.raises(tr.InvalidValueError, match="must be a State"):
        tr.twin(system)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"charge": 0.0}, "must not be zero"),
        ({"mass": "-1 g"}, "must be positive"),
        ({"electron": True, "charge": 2.0}, "must not stand beside"),
        ({"electron": True, "slow_motion": 1e10}, "of the speed of light"),
        ({"slow_motion": math.nan}, "finite"),
    ],
)
def test_wrong_values_are_refused(given: dict[str, Any], said: str) -> None:
    with pytest.raises(tr.InvalidValueError, match=said):
        tr.twin(tr.Scenario.load("tilted-turntable"), **given)


def test_fields_that_no_slope_can_stand_for_are_refused() -> None:
    with pytest.raises(tr.OutOfDomainError, match="lie along it; here it makes 90°"):
        tr.to_turntable(tr.ChargedParticle(1.0, 1.0, 1.0, (0.0, 1.0)))
    with pytest.raises(tr.OutOfDomainError, match="larger slow_motion"):
        tr.to_turntable(tr.ChargedParticle(1.0, 1.0, 1.0, (20.0, 0.0)))
    with pytest.raises(tr.OutOfDomainError, match="only in a magnetic field"):
        tr.ChargedParticle(1.0, 1.0, 0.0).guiding_centre(1.0)
    with pytest.raises(tr.OutOfDomainError, match="nothing holds the charge"):
        _ = tr.ChargedParticle(1.0, 1.0, 0.0).drift_velocity


# --- the figure ------------------------------------------------------------------------------------------


def test_the_figure_shows_both_paths_drift_and_fields() -> None:
    sheet = tr.twin(tr.Scenario.load("tilted-turntable")).plot()
    chart, strip, signs = sheet.axes
    assert chart.get_aspect() == 1.0
    assert (chart.get_xlabel(), chart.get_ylabel()) == ("y, level (cm)", "x, down the slope (cm)")
    assert chart.get_ylim()[0] > chart.get_ylim()[1]  # downhill is down
    told = [text.get_text() for text in sheet.legends[0].get_texts()]
    assert {"path of the ball", "path of the charge", "equal height = equal potential"} <= set(told)
    assert "guiding centre of the ball, 3.68 cm/s" in told
    words = {text.get_text() for text in signs.texts}
    assert {"B, into the page", "E", "force QE", "downhill"} <= words
    assert strip.get_ylabel().startswith("apart")


def test_where_nothing_moves_the_figure_says_so() -> None:
    sheet = tr.twin(tr.Scenario.load("level-turntable-put-down")).plot()
    assert "both at rest" in {text.get_text() for text in sheet.axes[0].texts}
