"""What a scene promises and what it measures: each right by itself, and a fault in one seen against the other."""

import math
import re
from dataclasses import replace

import mpmath
import numpy as np
import pytest

import trundle as tr
from trundle.scenario.files import is_shipped_path, names
from trundle.solve.exact import closed_form
from trundle.solve.exact.finding import Finding
from trundle.views.scene import scene_of
from trundle.views.scene.findings import findings_of

BALL = {"solid": tr.Body.solid_sphere(0.025, 0.51), "hollow": tr.Body.hollow_sphere(0.025, 0.51)}


def found(run, samples=None):
    """Return the findings of a run by name, of samples of its own unless others are given."""
    form = closed_form(run.system, run.start)
    rows = findings_of(run.system, run.start, run.samples if samples is None else samples, form)
    return {row.name: row.as_dict() for row in rows}


def simulated(support, start, body="solid", loads=(), duration=10.0, every=0.01, method="auto"):
    system = tr.RollingSystem(BALL.get(body, body), support, loads=loads)
    return tr.simulate(system, system.place(**start), duration, every, method=method)


def table(rate=3.5, **more):
    return tr.Support(tr.Plane(), motion=tr.Spin(rate), **more)


NUDGED = {"position": (0.1, 0.0), "velocity": (0.0, 0.2)}


def agrees(row, predicted, tolerance):
    assert row["predicted"] == pytest.approx(predicted, rel=1e-12, abs=1e-15)
    assert row["measured"] == pytest.approx(float(predicted), rel=tolerance, abs=tolerance * 1e-3)


@pytest.mark.parametrize(("body", "share"), [("solid", mpmath.mpf(2) / 7), ("hollow", mpmath.mpf(2) / 5)])
def test_a_turntable_by_hand(body, share):
    rows = found(simulated(table(), NUDGED, body))
    kappa = share * mpmath.mpf("3.5")
    centre = mpmath.mpf("0.1") - mpmath.mpf("0.2") / kappa  # i ζ̇/κ of a velocity along the second axis
    agrees(rows["Angular rate of the circle"], kappa, 1e-9)
    agrees(rows["Share of the table's rate"], share, 1e-9)
    agrees(rows["Radius of the circle"], mpmath.mpf("0.2") / kappa, 1e-9)
    agrees(rows["Distance of its centre from the axis"], abs(centre), 1e-9)
    agrees(rows["Friction needed"], kappa * mpmath.mpf("0.2") / mpmath.mpf("9.80665"), 1e-9)


def test_a_tilted_turntable_by_hand():
    rows = found(simulated(table(tilt=0.02), NUDGED, duration=20.0))
    drift = mpmath.mpf("9.80665") * mpmath.sin(mpmath.mpf(0.02)) / (mpmath.mpf("0.4") * mpmath.mpf("3.5"))
    agrees(rows["Drift speed"], drift, 1e-9)
    agrees(rows["Direction of the drift, from straight downhill"], 90, 1e-9)
    agrees(
        rows["Radius of the circle"], abs(mpmath.mpf("0.2") - drift), 1e-9
    )  # κ is 1 rad/s, the drift along the start


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_the_other_methods_measure_the_same(method):
    row = found(simulated(table(), NUDGED, method=method))["Angular rate of the circle"]
    assert row["predicted"] == pytest.approx(1.0, rel=1e-15)
    assert row["measured"] == pytest.approx(1.0, rel=1e-9)


def test_a_ball_put_down_gently_stays():
    row = found(simulated(table(), {"position": (0.1, 0.0)}))["Distance that it moves"]
    assert row["predicted"] == 0
    assert row["measured"] < 1e-12


def test_a_slope_by_hand():
    rows = found(simulated(tr.Support(tr.Plane(), tilt=0.1), {"position": (0.0, 0.0)}, duration=2.0))
    agrees(rows["Acceleration"], mpmath.mpf(5) / 7 * mpmath.mpf("9.80665") * mpmath.sin(mpmath.mpf(0.1)), 1e-9)
    agrees(rows["Share of a sliding block's"], mpmath.mpf(5) / 7, 1e-9)
    agrees(rows["Friction needed"], mpmath.mpf(2) / 7 * mpmath.tan(mpmath.mpf(0.1)), 1e-9)


def test_air_by_hand():
    loads = (tr.Drag(0.05),)
    rows = found(simulated(table(tilt=0.02), NUDGED, loads=loads, duration=20.0))
    gamma = mpmath.mpf("0.05") / (mpmath.mpf("0.51") * mpmath.mpf("1.4"))
    agrees(rows["Rate at which air slows it"], gamma, 1e-6)
    agrees(rows["Angular rate of the spiral"], 1, 1e-6)
    push = mpmath.mpf("9.80665") * mpmath.sin(mpmath.mpf(0.02)) / mpmath.mpf("1.4")
    agrees(rows["Speed that it comes to"], push / abs(mpmath.mpc(-gamma, 1)), 1e-6)


def test_moving_air():
    rows = found(simulated(table(), NUDGED, loads=(tr.Drag(0.05, air=3.5),), duration=20.0))
    for part in ("faster", "slower"):
        for what in (f"Angular rate of the {part} part", f"Growth of the {part} part"):
            assert rows[what]["measured"] == pytest.approx(rows[what]["predicted"], abs=1e-5)
    assert rows["Growth of the faster part"]["measured"] > 0  # air that overtakes the ball drives it outwards


def test_billiards_by_hand():
    cloth = tr.Support(tr.Plane(), friction=0.2)
    rows = found(simulated(cloth, {"velocity": (2.0, 0.0), "angular_velocity": (0.0, 0.0, 0.0)}, duration=1.0))
    grip = mpmath.mpf(4) / (7 * mpmath.mpf("0.2") * mpmath.mpf("9.80665"))
    agrees(rows["Time at which it grips"], grip, 1e-9)
    agrees(rows["Speed after it grips"], mpmath.mpf(10) / 7, 1e-9)
    agrees(rows["Distance to there"], grip * mpmath.mpf(12) / 7, 1e-9)
    agrees(rows["Friction while it slips"], mpmath.mpf("0.2"), 1e-9)


def test_a_ball_that_rolls_to_rest_by_hand():
    felt = (tr.RollingResistance(0.001),)
    rows = found(simulated(tr.Support(tr.Plane()), {"velocity": (0.3, 0.0)}, loads=felt, duration=3.0))
    slowed = mpmath.mpf(5) / 7 * mpmath.mpf("9.80665") * mpmath.mpf("0.001") / mpmath.mpf("0.025")
    agrees(rows["Time at which it stops"], mpmath.mpf("0.3") / slowed, 1e-6)
    agrees(rows["Way to there"], mpmath.mpf("0.3") ** 2 / (2 * slowed), 1e-6)


def test_a_pendulum_by_hand():
    pipe = tr.Support(tr.Cylinder(0.5), tilt="90 deg")
    rows = found(simulated(pipe, {"position": (1.0, 0.0)}, duration=5.0))
    length = mpmath.mpf("0.475")
    slow = mpmath.sqrt(mpmath.mpf("9.80665") / (mpmath.mpf("1.4") * length))
    period = 4 / slow * mpmath.ellipk(mpmath.sin(mpmath.mpf("0.5")) ** 2)
    agrees(rows["Time of one swing"], period, 1e-7)
    agrees(rows["Amplitude"], mpmath.degrees(1), 1e-6)


def test_a_pendulum_that_goes_round():
    pipe = tr.Support(tr.Cylinder(0.2), tilt="90 deg")
    row = found(simulated(pipe, {"position": (0.0, 0.0), "velocity": (3.5, 0.0)}, duration=2.0))["Time of one round"]
    assert row["measured"] == pytest.approx(row["predicted"], rel=1e-7)


def test_bobbing_by_hand():
    rows = found(
        simulated(tr.Support(tr.Cylinder(0.1)), {"position": (0.0, 0.0), "velocity": (1.5, 0.0)}, duration=3.0)
    )
    round_ = mpmath.mpf("1.5") / mpmath.mpf("0.075")
    ratio = mpmath.sqrt(mpmath.mpf(2) / 7)
    agrees(rows["Rate of going round"], round_, 1e-9)
    agrees(rows["Ratio of the two"], ratio, 1e-6)
    agrees(rows["Rate of bobbing"], round_ * ratio, 1e-6)
    depth = 2 * mpmath.mpf("9.80665") / mpmath.mpf("1.4") / (round_ * ratio) ** 2
    agrees(rows["Height that it bobs through"], depth, 1e-6)


@pytest.mark.parametrize("friction", [None, 0.3])
def test_a_dome_lets_go_where_it_should(friction):
    dome = tr.Support(tr.Dome(0.2), friction=friction)
    rows = found(simulated(dome, {"position": (0.002, 0.0)}, duration=3.0, every=0.002))
    angle = rows["Angle from the top where it comes off"]
    assert angle["measured"] == pytest.approx(angle["predicted"], rel=1e-4)
    if friction is None:
        start = math.sqrt(1 - (0.002 / 0.2) ** 2)
        assert math.cos(math.radians(angle["predicted"])) == pytest.approx(2 * start / 3.4, rel=1e-9)
    else:
        slips = rows["Angle from the top where it begins to slip"]
        assert slips["measured"] == pytest.approx(slips["predicted"], rel=1e-4)


def test_a_free_table():
    wheel = tr.Support(tr.Plane(), motion=tr.FreeAxle(0.5, 3.5))
    rows = found(simulated(wheel, NUDGED, duration=20.0))
    agrees(rows["Angular momentum about the axle"], 0.5 * 3.5 + 0.51 * 0.1 * 0.2, 1e-9)
    for name in ("Time round the ellipse", "Eccentricity of the ellipse"):
        assert rows[name]["measured"] == pytest.approx(rows[name]["predicted"], rel=1e-6)


def test_an_uneven_table():
    uneven = tr.Support(tr.Plane(), motion=tr.UnevenSpin(3.5, 0.3, 2.0))
    row = found(simulated(uneven, NUDGED))["Velocity less its share of the table's"]
    agrees(row, abs(mpmath.mpf("0.2") - mpmath.mpf(2) / 7 * mpmath.mpf("3.5") * mpmath.mpf("0.1")), 1e-9)


def test_a_landing():
    floor = tr.Support(tr.Plane(), friction=0.3, restitution=0.5)
    rows = found(simulated(floor, {"height": 0.5, "velocity": (1.0, 0.0)}, duration=1.0))
    lands = mpmath.sqrt(1 / mpmath.mpf("9.80665"))
    agrees(rows["Time at which it lands"], lands, 1e-9)
    agrees(rows["Distance to there"], lands, 1e-9)


@pytest.mark.parametrize(("name", "reaction"), [("ball-under-force", -2 / 7 * 0.1), ("ball-under-torque", 5 / 7 * 0.1)])
def test_the_table_holds_a_ball_back_by_two_sevenths_and_drives_one_by_five(name, reaction):
    """The lecture's reaction, to a force of 0.1 N at the centre, and to a torque of 0.1 N times the radius."""
    row = found(tr.Scenario.load(name).run())["Reaction of the support"]
    assert row["predicted"] == pytest.approx(reaction, rel=1e-14)
    assert row["measured"] == pytest.approx(reaction, rel=1e-12)


def bent(samples, name, change):
    values = np.array(getattr(samples, name))
    change(values)
    return replace(samples, **{name: values})


def test_a_fault_in_the_samples_shows():
    """A path a thousandth too fast, or a force a tenth too large: what was predicted stays, what is measured moves."""
    run = simulated(table(), NUDGED)
    right = found(run)
    assert all(row["difference"] is None or row["difference"] < 1e-9 for row in right.values())

    faster = replace(run.samples, time=run.samples.time / 1.001)
    rows = found(run, faster)
    assert rows["Angular rate of the circle"]["predicted"] == right["Angular rate of the circle"]["predicted"]
    assert rows["Angular rate of the circle"]["difference"] == pytest.approx(1e-3, rel=1e-3)

    wider = bent(run.samples, "position", lambda r: np.multiply(r[:, :2], 1.01, out=r[:, :2]))
    assert found(run, wider)["Radius of the circle"]["difference"] == pytest.approx(1e-2, rel=1e-3)

    stronger = bent(run.samples, "contact_force", lambda f: np.multiply(f[:, :2], 1.1, out=f[:, :2]))
    assert found(run, stronger)["Friction needed"]["difference"] == pytest.approx(0.1, rel=1e-6)

    spun = bent(run.samples, "angular_velocity", lambda w: np.add(w[500:, 2], 1e-3, out=w[500:, 2]))
    assert found(run, spun)["Spin about the normal"]["measured"] == pytest.approx(1e-3)
    assert found(run, spun)["Moving energy"]["difference"] > 0


SHIPPED = [name for name in names() if not is_shipped_path(name)]


@pytest.mark.parametrize("name", SHIPPED)
def test_every_shipped_scenario_agrees_with_its_predictions(name):
    header = scene_of(tr.Scenario.load(name).run(), samples=500).header
    for row in header["findings"]:
        assert set(row) == {"name", "symbol", "predicted", "measured", "unit", "difference", "note"}
        assert row["name"]
        assert row["symbol"]
        for key in ("predicted", "measured", "difference"):
            assert row[key] is None or math.isfinite(row[key])
        assert row["difference"] is None or row["difference"] < 1e-5, row
    assert len({row["name"] for row in header["findings"]}) == len(header["findings"])
    said, other = header["headline"]["text"], header["headline"]["other"]
    first, second = (float(re.search(r"[\d.]+", text)[0]) for text in (said, other))
    assert first == pytest.approx(second, rel=2e-3), said
    assert header["formula"]["latex"].count("{") == header["formula"]["latex"].count("}")
    assert header["formula"]["numbers_latex"].count("{") == header["formula"]["numbers_latex"].count("}")


def test_a_difference_is_a_share_of_what_was_predicted():
    assert Finding("x", "x", 2.0, 2.1).difference == pytest.approx(0.05)
    assert Finding("x", "x", 0.0, 0.1, scale=2.0).difference == pytest.approx(0.05)
    assert Finding("x", "x", 0.0, 0.1).difference is None
    assert Finding("x", "x", None, 0.1).difference is None
    assert Finding("x", "x", 1.0, math.inf).difference is None


def test_the_formula_holds_the_current_numbers():
    header = scene_of(simulated(table(rate=7.0, tilt=0.02), NUDGED)).header
    formula = header["formula"]
    assert formula["source"] == "T5"
    assert r"\kappa &= \frac{k}{1+k}\,\omega" in formula["latex"]
    assert r"\kappa &= \tfrac{2}{7}\cdot 7\,\mathrm{rad/s} = 2\,\mathrm{rad/s}" in formula["numbers_latex"]
    assert r"0.07004\,\mathrm{m/s}" in formula["numbers_latex"]


def test_without_a_closed_form_the_law_is_shown():
    header = scene_of(tr.Scenario.load("rattleback").run(duration=1.0)).header
    assert header["formula"]["source"] == "T2"
    assert "guiding_centre" not in scene_of(tr.Scenario.load("rattleback").run(duration=1.0)).columns


def test_the_guiding_centre_is_the_middle_of_the_circle():
    scene = scene_of(simulated(table(tilt=0.02), NUDGED))
    columns = scene.columns
    assert scene.header["guiding_centre"]
    away = np.linalg.norm(columns["position"][:, :2] - columns["guiding_centre"][:, :2], axis=1)
    assert np.ptp(away) < 1e-5 * np.max(away)
    assert np.all(columns["guiding_centre"][:, 2] == 0)


def test_a_ball_with_three_moments():
    body = tr.Body.eccentric_sphere(0.1, 0.64, (2e-3, 2e-3, 4e-3), (0.0, 0.0, 0.0))
    start = {"velocity": (0.3, 0.1), "spin": 8.0, "orientation": (0.9, 0.3, 0.1, 0.0)}
    rows = found(simulated(tr.Support(tr.Plane()), start, body))
    for name in ("Time of one nutation", "Speed from one nutation to the next"):
        assert rows[name]["measured"] == pytest.approx(rows[name]["predicted"], rel=1e-4)


def test_an_integral_that_is_nothing_by_chance_is_off_by_nothing():
    half = tr.RollingSystem(tr.Body.hemisphere(radius=0.05, mass=0.25), tr.Support(tr.Plane()))
    start = half.place(attitude=(math.radians(-90.0), math.radians(60.0), 0.0))  # JΩ·ρ = 0, of terms that all vanish
    assert found(tr.simulate(half, start, 2.0, 0.01))["Integral of Jellett"]["difference"] < 1e-12
