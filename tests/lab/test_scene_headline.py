"""What a run is said to show, and what may be drawn of it: against motions written down by hand and closed formulas."""

import math
import re

import numpy as np
import pytest

import trundle as tr
from trundle.scenario import files
from trundle.solve.exact.finding import Finding
from trundle.solve.samples import Samples
from trundle.views.scene import scene_of
from trundle.views.scene.curves import curves_of
from trundle.views.scene.headline import Headline, headline_of

FLOOR = tr.Support(tr.Plane())
TOP = tr.RollingSystem(tr.Body.hemisphere(radius=0.05, mass=0.25), FLOOR)


def turned(time, angle, rate, about):
    """Return samples of a body that only turns about an axis of the support frame."""
    half, still = 0.5 * angle[:, None], np.zeros((time.size, 3))
    orientation = np.hstack([np.cos(half), np.sin(half) * np.asarray(about)])
    place = still + np.array([0.0, 0.0, 0.05])
    return Samples(time, place, still, still, rate[:, None] * np.asarray(about), orientation, still)


def number(text):
    return float(re.search(r"[\d.]+", text)[0])


def test_a_spin_that_reverses_by_hand():
    """Ω = 5 cos(t) about the vertical turns round at t = π/2."""
    time = np.linspace(0.0, 3.0, 601)
    told = headline_of(TOP, turned(time, 5 * np.sin(time), 5 * np.cos(time), (0, 0, 1)), ())
    assert told["text"].startswith("reverses its spin after ")
    assert number(told["text"]) == pytest.approx(math.pi / 2, rel=1e-3)
    assert number(told["other"]) == pytest.approx(math.pi / 2, rel=1e-3)


def test_a_fault_in_one_way_shows_beside_the_other():
    """The angular velocity lags behind the orientation: the two ways to the same number part."""
    time = np.linspace(0.0, 3.0, 601)
    told = headline_of(TOP, turned(time, 5 * np.sin(time), 5 * np.cos(time - 0.2), (0, 0, 1)), ())
    assert number(told["other"]) - number(told["text"]) == pytest.approx(0.2, rel=0.02)


def test_what_turns_over_by_hand():
    """An axis that goes from straight up by 1 rad/s passes the horizontal at π/2, and stays down."""
    time = np.linspace(0.0, 3.0, 301)
    told = headline_of(TOP, turned(time, time, np.ones(301), (1, 0, 0)), ())
    assert told["text"].startswith("turns upside down after ")
    assert number(told["text"]) == pytest.approx(math.pi / 2, rel=1e-3)


def test_what_passes_its_middle_at_a_sample_is_told_too():
    """An axis in steps of 45° is level at a sample, and a height of 0, ±1, 0 m is in its middle at every other."""
    time = np.linspace(0.0, 4.0, 5)
    turning = turned(time, 0.25 * math.pi * time, np.full(5, 0.25 * math.pi), (1, 0, 0))
    assert number(headline_of(TOP, turning, ())["text"]) == pytest.approx(2.0, abs=1e-12)
    time = np.arange(17.0)
    place = np.outer(np.round(np.sin(0.5 * math.pi * time)), [0.0, 0.0, 1.0]) + np.array([1.0, 0.0, 0.0])
    still = np.zeros((time.size, 3))
    rising = Samples(time, place, still, still, still, np.tile([1.0, 0, 0, 0], (time.size, 1)), still)
    assert headline_of(TOP, rising, ())["text"] == "rises and falls every 4 s"


def test_a_coin_on_its_circle_goes_round_as_often_as_its_spin_says():
    run = tr.Scenario.load("coin-in-a-circle").run()
    told = headline_of(run.system, run.samples, ())
    rate = 2 * math.pi / number(told["text"])
    lean = np.radians(curve(run, "lean"))
    # A coin that circles steadily has Ω·n made of its precession and of the turn about its own axis.
    axis = run.samples.angular_velocity[0] - np.array([0.0, 0.0, rate])
    assert abs(np.linalg.norm(axis[:2]) / axis[2]) == pytest.approx(abs(math.tan(lean[0])), rel=2e-3)


def test_a_ball_in_a_shallow_bowl_rises_and_falls_twice_a_swing():
    """A small swing of a solid ball in a bowl takes 2π√(7(R − a)/5g)."""
    bowl = tr.RollingSystem(tr.Body.solid_sphere(0.01, 0.1), tr.Support(tr.Bowl(0.5)))
    run = tr.simulate(bowl, bowl.place(position=(0.02, 0.0)), 10.0, 0.01)
    told = headline_of(bowl, run.samples, ())
    swing = 2 * math.pi * math.sqrt(1.4 * 0.49 / 9.80665)
    assert told["text"].startswith("swings out and in every")
    assert number(told["text"]) == pytest.approx(swing / 2, rel=2e-3)
    assert number(told["other"]) == pytest.approx(swing / 2, rel=2e-3)


def test_an_end_is_found_again_from_the_samples_before_it():
    """A ball on a slope with a rim 0.5 m away has 5/7 of a block's acceleration."""
    slope = tr.RollingSystem(tr.Body.hollow_sphere(0.02, 0.1), tr.Support(tr.Plane(rim=0.5), tilt=0.1))
    run = tr.simulate(slope, slope.place(), 5.0, 0.01)
    told = headline_of(slope, run.samples, ())
    fall = math.sqrt(2 * 0.5 / (0.6 * 9.80665 * math.sin(0.1)))
    assert told["text"] == f"runs off the rim after {fall:.4g} s"
    assert number(told["other"]) == pytest.approx(fall, rel=1e-3)


def test_what_theory_says_comes_first_in_the_unit_that_suits_it():
    rows = [
        Finding("Radius", "r", 1.0, 1.0, "m"),
        Finding("Drift", "v", 0.0361, 0.0368, "m/s", said="drifts {}"),
    ]
    told = headline_of(TOP, turned(np.zeros(1), np.zeros(1), np.zeros(1), (0, 0, 1)), rows)
    assert told["text"] == "drifts 3.68 cm/s"
    assert told["other"] == "3.61 cm/s"
    assert told["predicted"] is True


def test_nothing_is_said_of_what_does_not_move():
    time = np.linspace(0.0, 1.0, 11)
    assert headline_of(TOP, turned(time, 0 * time, 0 * time, (0, 0, 1)), ()) is None


def test_an_angle_and_a_share_are_written_as_people_do():
    assert Headline("comes off {}", "°", -37.5, None, True, "").as_dict()["text"] == "comes off −37.5°"
    assert Headline("circles at {} of it", "", 2 / 7, None, True, "").as_dict()["text"] == "circles at 0.2857 of it"


def curve(run, key):
    _, columns = curves_of(run.system, run.samples)
    return np.asarray(columns[f"curve_{key}"], dtype=float)


def test_the_curves_of_a_ball_on_a_slope_by_hand():
    mass, tilt = 0.3, 0.2
    slope = tr.RollingSystem(tr.Body.solid_sphere(0.02, mass), tr.Support(tr.Plane(), tilt=tilt))
    run = tr.simulate(slope, slope.place(spin=3.0), 1.0, 0.01)
    fallen = 0.5 * (5 / 7) * 9.80665 * math.sin(tilt) ** 2 * run.samples.time**2
    assert curve(run, "spin_normal") == pytest.approx(3.0)
    assert curve(run, "kinetic") - curve(run, "kinetic")[0] == pytest.approx(mass * 9.80665 * fallen, abs=1e-6)
    assert curve(run, "potential")[0] - curve(run, "potential") == pytest.approx(mass * 9.80665 * fallen, abs=1e-6)
    assert np.ptp(curve(run, "energy")) < 1e-6
    assert curve(run, "normal") == pytest.approx(mass * 9.80665 * math.cos(tilt), rel=1e-6)
    assert curve(run, "friction") == pytest.approx(2 / 7 * math.tan(tilt), rel=1e-6)
    # The vertical leans from the normal: Ω grows about the axis across the slope alone, which is level.
    assert curve(run, "spin_vertical") == pytest.approx(3.0 * math.cos(tilt), rel=1e-6)


def test_the_moving_energy_stays_where_the_energy_does_not():
    run = tr.Scenario.load("level-turntable-nudged").run()
    assert np.ptp(curve(run, "moving")) < 1e-6 * np.ptp(curve(run, "energy")) + 1e-7
    assert np.ptp(curve(run, "energy")) > 0.01


def test_slip_ends_where_a_billiard_ball_grips():
    run = tr.Scenario.load("billiard-follow").run()
    slip, grip = curve(run, "slip"), run.events[0].time
    assert slip[0] > 0.1
    assert np.max(slip[run.samples.time > grip]) < 1e-9


def test_what_flies_has_no_force_and_no_normal():
    run = tr.Scenario.load("superball").run()
    flies = run.samples.phase == 2
    assert flies.any()
    for key in ("normal", "friction", "spin_normal"):
        assert np.isnan(curve(run, key)[flies]).all()


def test_curves_come_only_where_they_are_asked_for():
    run = tr.Scenario.load("billiard-draw").run()
    plain, full = scene_of(run), scene_of(run, curves=True)
    assert plain.header["curves"] == []
    assert {one["column"] for one in full.header["curves"]} == set(full.columns) - set(plain.columns)
    assert all(full.columns[one["column"]].shape == full.columns["time"].shape for one in full.header["curves"])


CHANGES = [
    ("eulers-disc", ("start", "velocity"), ["0 m/s", "0.1 m/s"]),
    ("eulers-disc", ("start", "attitude"), ["0 deg", "7.5 deg", "0 deg"]),
    ("eulers-disc", ("support", "tilt"), "-12 deg"),
    ("eulers-disc", ("body", "radius"), "18.75 mm"),
    ("coin-in-a-circle", ("body", "mass"), "20 g"),
    ("rattleback", ("body", "mass"), "20 g"),
    ("tippe-top", ("body", "mass"), "20 g"),
]


@pytest.mark.parametrize("every", ["40 ms", "5 ms", "1 ms"])
@pytest.mark.parametrize(("name", "key", "value"), CHANGES)
def test_what_too_few_samples_cannot_tell_is_not_told(name, key, value, every):
    """Where something goes round faster than it is sampled, two ways of counting differ, and neither is right."""
    tables = files.tables_of(name)
    tables[key[0]][key[1]] = value
    told = {}
    for step in (every, "0.25 ms"):
        tables["run"] = {**tables["run"], "duration": "3 s", "every": step}
        run = tr.Scenario.read(tables).run(tolerance=1e-9)
        told[step] = headline_of(run.system, run.samples, ())
    coarse, fine = told[every], told["0.25 ms"]
    if coarse is None or coarse["said"] != fine["said"]:
        return  # nothing is told, or something else
    assert number(coarse["text"]) == pytest.approx(number(fine["text"]), rel=0.02)
