"""A fit against motion by formulas that the package did not make: values, errors, verdicts, and what stays unknown."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from tests.fitting.measured import (
    RADIUS,
    ball,
    down_incline,
    in_hollow,
    on_turntable,
    scenario,
    seen,
    turntable,
)

import trundle as tr
from trundle.analysis.fit.alternatives import IDEAS, tried
from trundle.analysis.fit.undetermined import Undetermined

K, RATE, TILT = "body.inertia_ratio", "support.motion.rate", "support.tilt"
OMEGA, NOISE = 3.487, 5e-4
T = np.arange(1200) / 60.0
SHORT = np.arange(300) / 30.0


@cache
def table(k: float = 0.5, rate: float = OMEGA, tilt: float = 0.0) -> tr.Scenario:
    return scenario(body=ball(k), support=turntable(rate, tilt))


def off(fit: tr.Fit, name: str, truth: float) -> float:
    """How many of its own standard deviations a number is off the truth."""
    one = fit[name]
    assert one.sigma is not None, one
    return abs(one.value - truth) / one.sigma


def only(fit: tr.Fit, name: str) -> Undetermined:
    """The one sentence on a number that is not fixed."""
    (found,) = [one for one in fit.undetermined if name in one.names]
    return found


def test_a_turntable_in_the_lecture_room() -> None:
    data = seen(T, NOISE, 1, z=on_turntable(T, OMEGA, tilt=0.006))
    first = table(tilt=0.001)
    found = tr.fit(data, first, [K, TILT], noise="0.5 mm")
    assert found[K].sigma < 2e-5
    assert max(off(found, K, 0.4), off(found, TILT, 0.006)) < 4
    assert max(off(found, "start.position[0]", 0.1), off(found, "start.velocity[1]", 0.15)) < 4
    assert 0.9 < found.judgement.reduced < 1.1
    assert (found.answer, found.passed) == ("good", True)
    assert not found.undetermined


@pytest.mark.parametrize("first", [0.2, 0.65])
def test_the_first_guess_needs_no_help(first: float) -> None:
    data = seen(T, NOISE, 2, z=on_turntable(T, OMEGA))
    assert off(tr.fit(data, table(first), [K], noise=NOISE), K, 0.4) < 4
    one = {"t": data["t"], "x": data["x"]}
    assert off(tr.fit(one, table(first), [K], noise=NOISE), K, 0.4) < 4


def test_a_table_that_turns_clockwise_or_not_at_all() -> None:
    clockwise = tr.fit(seen(T, NOISE, 3, z=on_turntable(T, -OMEGA)), table(0.4, 2.0), [RATE], noise=NOISE)
    assert off(clockwise, RATE, -OMEGA) < 4
    still = tr.fit(seen(T, NOISE, 4, z=0.1 + 0.02j * T), table(0.4, 1.0), [RATE], noise=NOISE)
    assert off(still, RATE, 0.0) < 4


# What cannot be known


def test_the_rate_and_the_ratio_are_known_together_only() -> None:
    found = tr.fit(seen(T, NOISE, 5, z=on_turntable(T, OMEGA)), table(), [K, RATE], noise=NOISE)
    said = only(found, K)
    assert set(said.names) == {K, RATE}
    (fixed,) = said.combinations
    assert (fixed.text, fixed.unit) == (f"{RATE}·{K}/(1 + {K})", "rad/s")
    assert abs(fixed.value - OMEGA * 2 / 7) < 4 * fixed.sigma < 1e-3
    assert f"Give `{RATE}` or `{K}`, or film a mark on the support" in str(said)
    assert found[K].sigma is None
    assert found[RATE].sigma is None
    assert (found.answer, found.passed) == ("cannot decide", None)
    assert np.isfinite(found.values).all()


@pytest.mark.parametrize("what", ["mark", "angle", "turning", "prior"])
def test_what_is_said_to_help_does(what: str) -> None:
    path = on_turntable(T, OMEGA)
    data, priors, turn = seen(T, NOISE, 6, z=path), {}, OMEGA * T + 0.3
    noise: dict[str, Any] = {"x": NOISE, "y": NOISE}
    if what == "mark":
        data |= seen(T, NOISE, 7, mark_x=0.2 * np.cos(turn), mark_y=0.2 * np.sin(turn))
        noise |= {"mark_x": NOISE, "mark_y": NOISE}
    elif what == "angle":
        data |= seen(T, 0.005, 7, angle=np.mod(turn, 2 * np.pi))
        noise |= {"angle": "5 mrad"}
    elif what == "turning":  # no slip: a Ω = iζ̇ + ωζ
        speed = 0.15j * np.exp(2j / 7 * OMEGA * T)
        turning = (1j * speed + OMEGA * path) / RADIUS
        data |= seen(T, 0.05, 7, wx=turning.real, wy=turning.imag)
        noise |= {"wx": 0.05, "wy": 0.05}
    else:
        priors = {RATE: (OMEGA, "0.001 rad/s")}
    found = tr.fit(data, table(0.5, 3.4), [K, RATE], noise=noise, priors=priors)
    assert found.answer == "good"
    assert max(off(found, K, 0.4), off(found, RATE, OMEGA)) < 4


def test_the_axis_does_not_show() -> None:
    path = on_turntable(T, OMEGA) + 0.013 - 0.007j
    found = tr.fit(seen(T, NOISE, 8, z=path), table(), [K, "camera.origin"], noise=NOISE)
    for i, where in enumerate((0.113, -0.007)):
        (fixed,) = only(found, f"camera.origin[{i}]").combinations
        assert fixed.text == f"start.position[{i}] + camera.origin[{i}]"
        assert abs(fixed.value - where) < 4 * fixed.sigma
    assert off(found, K, 0.4) < 4  # which does not care
    assert found.answer == "good"


def test_a_scale_goes_into_the_tilt_and_the_start() -> None:
    path = 3.0 * on_turntable(T, OMEGA, tilt=0.006)  # pixels taken for something else
    found = tr.fit(seen(T, NOISE, 9, z=path), table(tilt=0.004), [K, TILT, "camera.scale"], noise=NOISE)
    fixed = only(found, TILT).combinations[0]
    assert fixed.text in (f"{TILT}·camera.scale", f"sin({TILT})·camera.scale")
    assert abs(fixed.value - 0.018) < 4 * fixed.sigma + 1e-6  # the sine of so small an angle
    assert found[TILT].sigma is None
    assert found["start.velocity[1]"].sigma is None
    assert off(found, K, 0.4) < 4


def test_an_incline_tells_the_slope_by_the_ratio() -> None:
    t = np.linspace(0.0, 1.5, 90)
    slope = scenario(body=ball(0.5), support={"kind": "plane", "tilt": 0.1})
    data = seen(t, 1e-3, 10, x=down_incline(t, 0.1, 0.4))
    found = tr.fit(data, slope, [K, TILT], noise="1 mm")
    (fixed,) = only(found, K).combinations
    assert fixed.text == f"sin({TILT})/(1 + {K})"
    assert abs(fixed.value - np.sin(0.1) / 1.4) < 4 * fixed.sigma
    assert "Held, as these data do not show it: start.velocity[1], start.position[1]." in found.remarks
    assert off(tr.fit(data, slope, [K], noise="1 mm"), K, 0.4) < 4


@pytest.mark.parametrize(("tilt", "ratio"), [(0.06, 0.4), (0.12, 0.4), (0.03, 0.6), (0.05, 0.65)])
def test_it_does_so_where_the_given_slope_would_ask_for_a_ratio_that_no_ball_has(tilt: float, ratio: float) -> None:
    """With the slope held as the scenario has it, k would have to leave 0 to 2/3, and the fit would be bad."""
    t = np.linspace(0.0, 3.0, 200)
    slope = scenario(body=ball(ratio), support={"kind": "plane", "tilt": tilt})
    found = tr.fit(seen(t, NOISE, 8, x=down_incline(t, 0.05, 0.4, 0.1)), slope, [K, TILT], noise=NOISE)
    assert found.answer == "cannot decide"
    assert found[K].sigma is None
    assert found[TILT].sigma is None
    (fixed,) = only(found, K).combinations
    assert fixed.text == f"sin({TILT})/(1 + {K})"
    assert abs(fixed.value - np.sin(0.05) / 1.4) < 4 * fixed.sigma


def test_a_hoop_is_no_ball_of_any_ratio() -> None:
    t = np.linspace(0.0, 3.0, 200)
    slope = scenario(body=ball(0.5), support={"kind": "plane", "tilt": 0.05})
    found = tr.fit(seen(t, 1e-3, 4, x=down_incline(t, 0.05, 1.0)), slope, [K], noise="1 mm")
    assert found.answer == "bad"
    assert found[K].cells[2] == "at its limit; the data ask for more"


def test_laws_that_do_as_well_as_each_other_are_named_together() -> None:
    """A push against the motion, as resistance makes it; too short and too noisy to be told from drag of air."""
    t = np.linspace(0.0, 2.0, 240)
    x = 0.5 * t - 0.5 * 0.004 * 9.80665 / 1.4 * t**2
    told = tr.fit(seen(t, 1e-3, 2, x=x, y=0 * t), scenario(), [], noise="1 mm").compare()
    assert {"resistance to rolling", "drag of air at rest"} <= {one.words for one in told.rivals}
    assert "these data do not tell which" in told.verdict
    assert "still" not in told.verdict


def test_the_best_of_bad_laws_is_said_to_be_bad() -> None:
    """Drag by the square of the speed, for which there is none: ln(1 + cvt)/c in place of a straight line."""
    t = np.linspace(0.0, 4.0, 300)
    x = np.log1p(0.2 * t) / 0.2
    told = tr.fit(seen(t, 1e-3, 3, x=x, y=0 * t), scenario(), [], noise="1 mm").compare()
    assert told.best is not None
    assert "but not well: χ²/dof is still" in told.verdict


HOLLOWS = {
    "bowl": ({"kind": "bowl"}, {"position": [0.05, 0.0]}),
    "cylinder": ({"kind": "cylinder", "tilt": np.pi / 2}, {"position": [0.5, 0.0]}),
}


@pytest.mark.parametrize("speed", [-2.1, 1.3])
@pytest.mark.parametrize("turned", [0.5, 0.7, 0.95])  # rad from row to row
def test_rows_far_apart_tell_the_start_by_the_first_of_them(turned: float, speed: float) -> None:
    """A golf ball in its hole: it goes round, and bobs by what it is. Eight rows, all but a turn, made it slow.

    Round at φ̇ it goes down and up as often as √(k/(1 + k)) φ̇ says, by g/(k φ̇²) either way.
    """
    rate = speed / 0.03  # of the centre, round the axis
    t = np.arange(120) * turned / abs(rate)
    depth = 9.80665 / (0.4 * rate**2) * (1 - np.cos(np.sqrt(0.4 / 1.4) * rate * t))
    data = seen(t, 1e-4, 5, z=0.03 * np.exp(1j * rate * t))
    data |= seen(t, 1e-4, 6, z=-depth)
    start = {"position": [0.0, 0.0], "velocity": [0.9 * speed, 0.0]}
    first = scenario(body=ball(0.5), support={"kind": "cylinder", "radius": 0.055}, start=start)
    found = tr.fit(data, first, K, noise="0.1 mm")
    assert found.answer == "good", str(found)
    assert off(found, K, 0.4) < 4
    assert off(found, "start.velocity[0]", speed) < 4


@pytest.mark.parametrize("kind", HOLLOWS)
def test_a_bowl_and_a_pipe_tell_their_radius_by_that_of_the_ball(kind: str) -> None:
    t = np.arange(60) / 30.0
    swing = 0.1 * np.exp(1j * in_hollow(t, 0.125, 0.4, 0.6))  # the centre, from the middle of the circle
    data = seen(t, NOISE, 11, z=swing) if kind == "cylinder" else seen(t, NOISE, 11, z=swing.imag + 0j)
    support, start = HOLLOWS[kind]
    first = scenario(support={**support, "radius": 0.13}, start=start)
    found = tr.fit(data, first, ["support.radius", "body.radius"], noise=NOISE)
    fixed = only(found, "body.radius").combinations[0]
    assert fixed.text == "support.radius − body.radius"
    assert abs(fixed.value - 0.1) < 4 * fixed.sigma < 1e-3
    assert found.judgement.good


@pytest.mark.parametrize("kind", HOLLOWS)
def test_a_bowl_and_a_pipe_tell_the_ratio_by_gravity(kind: str) -> None:
    t = np.arange(60) / 30.0
    swing = 0.1 * np.exp(1j * in_hollow(t, 0.125, 0.4, 0.6))
    data = seen(t, NOISE, 12, z=swing) if kind == "cylinder" else seen(t, NOISE, 12, z=swing.imag + 0j)
    support, start = HOLLOWS[kind]
    first = scenario(body=ball(0.5), support={**support, "radius": 0.125}, start=start)
    (fixed,) = only(tr.fit(data, first, [K, "gravity"], noise=NOISE), K).combinations
    assert fixed.text == f"gravity/(1 + {K})"
    assert abs(fixed.value - 9.80665 / 1.4) < 4 * fixed.sigma


def test_a_mass_that_nothing_depends_on_is_said_not_to_show() -> None:
    found = tr.fit(seen(SHORT, NOISE, 13, z=on_turntable(SHORT, OMEGA)), table(), ["body.mass", K], noise=NOISE)
    assert str(only(found, "body.mass")) == "These data do not show `body.mass`. Give `body.mass`."
    assert found.answer == "good"


# Judging


def test_a_puck_and_a_hoop_are_no_balls() -> None:
    t = np.linspace(0.0, 1.5, 90)
    slope = scenario(support={"kind": "plane", "tilt": 0.1})
    for ratio in (0.0, 1.0):  # one slides without friction, one is a hoop
        found = tr.fit(seen(t, 1e-3, 14, x=down_incline(t, 0.1, ratio)), slope, noise="1 mm")
        assert found.answer == "bad"
        assert found.judgement.excess > 5
        assert found.passed is False


def test_a_puck_is_told_to_slide() -> None:
    t = np.linspace(0.0, 1.5, 90)
    slope = scenario(support={"kind": "plane", "tilt": 0.1})
    found = tr.fit(seen(t, 1e-3, 15, x=down_incline(t, 0.1, 0.0)), slope, noise="1 mm")
    (idea,) = [one for one in IDEAS if one.words.startswith("sliding")]
    slides = tried(found, idea)
    assert slides is not None
    assert slides.gain > 1000
    assert abs(slides.chi_square / 88 - 1) < 0.6


def test_drag_that_is_missing_is_named() -> None:
    t = SHORT[:150]
    found = tr.fit(seen(t, NOISE, 16, z=on_turntable(t, OMEGA, drag=2e-3)), table(), [K], noise=NOISE)
    assert found.answer == "bad"
    best = found.compare().best
    assert best is not None
    assert best.words == "drag of air at rest"
    ((_, value, sigma),) = best.values
    assert abs(value - 2e-3) < 4 * sigma


def test_outliers_are_named_by_row_and_borne_by_a_loss() -> None:
    data = seen(SHORT, NOISE, 17, z=on_turntable(SHORT, OMEGA))
    data["x"][100] += 0.05
    data["y"][200:203] -= 0.03
    plain = tr.fit(data, table(), [K], noise=NOISE)
    assert plain.answer == "bad"
    assert {(one.row, one.column) for one in plain.judgement.outliers} == {
        (101, "x"),
        *((i, "y") for i in (201, 202, 203)),
    }
    borne = tr.fit(data, table(), [K], noise=NOISE, loss="cauchy")
    assert borne.answer == "good"
    assert off(borne, K, 0.4) < 4


def test_noise_larger_than_the_motion_decides_nothing() -> None:
    found = tr.fit(seen(SHORT, 5.0, 18, z=on_turntable(SHORT, OMEGA)), table(), [K])
    assert found.verdict == "cannot decide: the noise is larger than the motion"
    rest = tr.fit(seen(SHORT, NOISE, 19, z=0.1 + 0j * SHORT), table(), [K])
    assert rest.answer == "cannot decide"


def test_noise_is_estimated_where_it_is_not_given() -> None:
    data = seen(T, NOISE, 20, z=on_turntable(T, OMEGA))
    given, guessed = (tr.fit(data, table(), [K], noise=noise) for noise in (NOISE, None))
    assert abs(guessed[K].sigma / given[K].sigma - 1) < 0.1
    assert guessed.answer == "good"


# Edges


@pytest.mark.parametrize("columns", ["xy", "xyz", "xyz vx vy vz wx wy wz qw qx qy qz"])
@pytest.mark.parametrize("key", ["support.tilt", "support.motion.rate"])
def test_a_run_of_ones_own_is_fitted_to_what_rounding_leaves(key: str, columns: str) -> None:
    """Its spin, 0, is no better known than a rounding of its other turning: it does not outweigh all other columns."""
    scenario = tr.Scenario.load("tilted-turntable")
    run = scenario.run(duration=2.0)
    given = {"position": "xyz", "velocity": ("vx", "vy", "vz"), "angular_velocity": ("wx", "wy", "wz")}
    given |= {"orientation": ("qw", "qx", "qy", "qz")}
    every = {name: run.data[one].values[:, i] for one, names in given.items() for i, name in enumerate(names)}
    names = list(columns) if " " not in columns else [*"xyz", *columns.split()[1:]]
    fit = tr.fit({"t": run.samples.time, **{name: every[name] for name in names}}, scenario, free=[key])
    assert fit.judgement.good, str(fit)
    found, truth = fit[key], scenario.support.tilt if key == "support.tilt" else scenario.support.motion.rate
    assert abs(found.value - truth) <= max(5 * found.sigma, 1e-9 * truth)
    assert 1e-17 < found.sigma < 1e-6 * truth
    assert not fit.judgement.outliers


OWN_RUNS = {
    "round in a trough": """
body = { kind = "solid-sphere", radius = "10 mm", mass = "32.7 g" }
support = { kind = "cylinder", radius = "20 cm", tilt = "90 deg" }
start = { position = [0, 0], velocity = [3, 0] }
run = { duration = 2, every = 0.01 }
""",
    "round a hole, some times a second": """
body = { kind = "sphere", radius = "21.35 mm", mass = "45.9 g", inertia_ratio = 0.4 }
support = { kind = "cylinder", radius = "54 mm" }
start = { position = ["0 deg", "0 cm"], velocity = ["-2.17073 m/s", "0 m/s"] }
run = { duration = 2.73308, every = 0.0144162 }
""",
    "by another method": """
body = { kind = "eccentric-sphere", radius = "10 cm", mass = "640 g", moments = [0.002, 0.0032, 0.0048] }
support = { kind = "plane", motion = { kind = "spin", rate = "-30 rpm" } }
start = { position = [0.2, 0], velocity = [0, 0], orientation = [0.8, 0.48, 0.36, 0] }
run = { duration = 1.1, every = 0.005, method = "runge-kutta" }
""",
    "turned by nothing": """
body = { kind = "solid-sphere", radius = "3 cm", mass = "0.1 kg" }
support = { kind = "plane", tilt = "-5 deg" }
start = { position = [0, 0], velocity = [0, 0] }
run = { duration = 1, every = 0.02 }
""",
}


@pytest.mark.parametrize("name", OWN_RUNS)
def test_a_run_of_ones_own_is_a_good_fit_however_it_moves(name: str) -> None:
    """Its residuals are what a solver is off by: they follow one another, and nothing added may explain them."""
    asked = tr.Scenario.loads(OWN_RUNS[name])
    run = asked.run()
    columns = {"t": run.samples.time} | dict(zip("xyz", run.samples.position.T, strict=True))
    columns |= dict(zip(("vx", "vy", "vz"), run.samples.velocity.T, strict=True))
    columns |= dict(zip(("wx", "wy", "wz"), run.samples.angular_velocity.T, strict=True))
    fit = tr.fit(columns, asked, free=["gravity"])
    assert fit.judgement.good, str(fit)
    if name == "by another method":  # nothing falls there
        assert fit["gravity"].sigma is None or fit["gravity"].sigma < 1e-6
        return
    assert abs(fit["gravity"].value - 9.80665) <= max(5 * fit["gravity"].sigma, 1e-9)
    best = fit.compare().best
    assert best is None, str(best)


@pytest.mark.parametrize(
    ("body", "start", "ways"),
    [
        ("half-cylinder", {"roll": "60 deg"}, 1),
        ("half-cylinder", {"roll": "-40 deg", "velocity": [0.1, 0]}, 2),
        ("cylinder", {"velocity": [0.3, -0.4]}, 2),
        ("cylinder", {"velocity": [0.3, 0], "orientation": [1, 1, 0, 0]}, 1),
    ],
)
def test_a_cylinder_starts_across_its_axis(body: str, start: dict[str, Any], ways: int) -> None:
    """It has no spin, and lying still or laid already but one way to go: no other may stand in the fit's way."""
    ratio = {"inertia_ratio": 0.5} if body == "cylinder" else {}
    tables: dict[str, Any] = {"body": {"kind": body, "radius": 0.1, "mass": 2.0, **ratio}, "support": {"kind": "plane"}}
    tables |= {"start": {"position": [0, 0], **start}, "run": {"duration": 1.2, "every": 0.01}}
    asked = tr.Scenario.read(tables)
    samples = asked.run().samples
    columns = {"t": samples.time} | dict(zip("xyz", samples.position.T, strict=True))
    columns |= dict(zip(("wx", "wy", "wz"), samples.angular_velocity.T, strict=True))
    fit = tr.fit(columns, asked, free=["body.radius"])
    assert fit.answer == "good", str(fit)
    assert fit["body.radius"].value == pytest.approx(0.1, abs=1e-5)
    assert [one.name for one in fit.estimates if "spin" in one.name] == []
    assert len([one.name for one in fit.estimates if "velocity" in one.name]) == ways


@pytest.mark.parametrize("key", ["body.mass", "support.radius", "gravity"])
@pytest.mark.filterwarnings("error")
def test_where_the_surface_begins_a_fit_ends_in_words(key: str, capfd: pytest.CaptureFixture[str]) -> None:
    """At the equator of a dome the place along x has no slope, and a step outwards no place."""
    dome = tr.Scenario.loads("""
body = { kind = "solid-sphere", radius = "10 mm", mass = "32.7 g" }
support = { kind = "dome", radius = "20 cm", friction = 0.3 }
start = { position = [0.2, 0] }
run = { duration = 1, every = 0.01 }
""")
    samples = dome.run().samples
    columns = {"t": samples.time} | dict(zip("xyz", samples.position.T, strict=True))
    if key == "support.radius":
        fit = tr.fit(columns, dome, free=[key])
        assert fit.answer == "bad"
        assert str(fit)
        assert fit.plot()
    else:
        with pytest.raises(tr.SolverError, match="has no derivative"):
            tr.fit(columns, dome, free=[key])
    assert capfd.readouterr() == ("", "")


@pytest.mark.filterwarnings("error")
def test_what_never_moves_shows_nothing_and_is_drawn() -> None:
    asked = tr.Scenario.loads("""
body = { kind = "solid-sphere", radius = "2 cm", mass = "0.1 kg" }
support = { kind = "plane" }
start = { position = [0.2, 0] }
run = { duration = 1, every = 0.05 }
""")
    samples = asked.run().samples
    columns = {"t": samples.time} | dict(zip("xyz", samples.position.T, strict=True))
    fit = tr.fit(columns, asked, free=["body.mass"])
    assert fit.answer == "cannot decide"
    assert "body.mass" in fit.undetermined[0].names
    low, high = fit.plot().axes[0].get_xlim()
    assert low < 0.19 < 0.21 < high


def test_a_number_stops_at_its_limit() -> None:
    drag = scenario(body=ball(0.5), support=turntable(OMEGA), loads=[{"kind": "drag", "coefficient": 1e-3}])
    states = set()
    for seed in range(4):
        found = tr.fit(
            seen(SHORT, NOISE, seed, z=on_turntable(SHORT, OMEGA)), drag, [K, "loads[0].coefficient"], noise=NOISE
        )
        one = found["loads[0].coefficient"]
        states.add(one.state)
        if one.state == "limit":
            assert one.value == 0.0
            assert -4 * one.alone_sigma < one.alone < 0
            assert "at its limit; the data say -" in str(one)
        assert off(found, K, 0.4) < 4
        tr.Scenario.loads(found.to_toml()).run()
    assert states == {"limit", "fitted"}


def test_gaps_uneven_times_and_columns_of_their_own_length() -> None:
    draw = np.random.default_rng(21)
    t = np.sort(draw.uniform(0.0, 15.0, 500))
    data = seen(t, NOISE, 22, z=on_turntable(t, OMEGA))
    data["x"][100:200] = np.nan
    data["y"][150:300] = np.nan
    found = tr.fit(data, table(), [K], noise=NOISE)
    assert off(found, K, 0.4) < 4
    assert found.judgement.freedom == 1000 - 250 - 5


def test_two_runs_share_what_is_free() -> None:
    other = on_turntable(SHORT, OMEGA, place=0.2j, speed=-0.1)
    one, two = seen(SHORT, NOISE, 23, z=on_turntable(SHORT, OMEGA)), seen(SHORT + 3.0, NOISE, 24, z=other)
    both = tr.fit([one, two], table(), [K], noise=NOISE)
    alone = tr.fit(one, table(), [K], noise=NOISE)
    assert off(both, K, 0.4) < 4
    assert both[K].sigma < alone[K].sigma
    assert len(both.scenarios) == 2
    assert both["start.position[1] of run 2"].sigma is not None


def test_covariances_and_units_say_the_same() -> None:
    data = seen(SHORT, NOISE, 25, z=on_turntable(SHORT, OMEGA))
    plain = tr.fit(data, table(), [K], noise=NOISE)
    in_mm = {"t [ms]": 1e3 * data["t"], "x": 1e3 * data["x"], "y": 1e3 * data["y"]}
    for again in (
        tr.fit(data, table(), [K], noise=NOISE**2 * np.eye(2)),
        tr.fit(data, table(), [K], noise=NOISE**2 * np.eye(600)),
        tr.fit(in_mm, table(), [K], noise="0.5 mm", units="mm"),
        tr.fit(data, table(), [K], noise=np.full(300, NOISE)),
    ):
        assert again[K].value == pytest.approx(plain[K].value, rel=1e-8)
        assert again[K].sigma == pytest.approx(plain[K].sigma, rel=1e-5)


def test_correlated_noise_is_weighed_as_it_is() -> None:
    # What x and y have in common says nothing of y alone: the textbook's error of a mean of two.
    data = seen(SHORT, NOISE, 26, z=on_turntable(SHORT, OMEGA))
    alike = NOISE**2 * np.array([[1.0, 0.9], [0.9, 1.0]])
    apart = tr.fit(data, table(), [K], noise=NOISE)
    found = tr.fit(data, table(), [K], noise=alike)
    assert found[K].sigma != pytest.approx(apart[K].sigma, rel=0.05)
    assert found.judgement.reduced > 1.5  # the noise in the data is not alike


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"free": ["body.inertia"]}, "Did you mean 'body.inertia_ratio'"),
        ({"free": ["camera.scal"]}, "unknown number of the camera 'camera.scal'"),
        ({"free": ["body.kind"]}, "unknown number of the scenario"),
        ({"noise": 0}, "`noise` must be positive"),
        ({"noise": {"x": NOISE}}, "none of y"),
        ({"noise": np.ones((3, 3))}, "must be of shape"),
        ({"noise": [[1.0, 2.0], [2.0, 1.0]]}, "positive definite"),
        ({"loss": "cubic"}, "unknown loss"),
        ({"start": "somewhere"}, "unknown start"),
        ({"priors": {RATE: (3.0, 0.1)}}, "unknown free number"),
        ({"priors": {K: (0.4, 0)}}, "must have a positive deviation"),
        ({"camera": {"scale": -1}}, "camera.scale"),
        ({"camera": {"zoom": 2}}, "unknown number of a camera"),
        ({"data": {"t": [0, 1, 2], "x": [0, 1, 2]}}, "4 rows at least"),
        ({"data": {"t": [0, 1, 2, 3], "x": [0, 1, 2, 3]}}, "4 values for 5 numbers"),
        ({"data": {"t": [0, 1, 2, 3], "x": [np.nan] * 4}}, "only empty ones: x"),
        ({"data": {"t": [0, 1, 1, 3, 3, 4, 4, 5, 5], "x": [0] * 9}}, "rows 2 and 3"),
        ({"data": {"x": [0, 1, 2, 3]}}, "no column for t"),
        ({"data": {"t": [0, 1, 2, 3], "x": ["a", "b", "c", "d"]}}, "`x` must hold numbers"),
        ({"data": 7}, "must be a file, a table"),
    ],
)
def test_what_is_refused_is_refused_in_words(change: dict[str, Any], says: str) -> None:
    given = {"data": seen(SHORT, NOISE, 27, z=on_turntable(SHORT, OMEGA)), "scenario": table(), "free": [K]}
    with pytest.raises(tr.TrundleError, match=says.replace("(", r"\(")):
        tr.fit(**{**given, **change})


# A ball that slips first, and spots


def test_friction_shows_while_a_ball_slips() -> None:
    # Coulomb by hand: V falls at μg along x while it slips, until V = 5/7 of what it was; then it rolls on evenly.
    mu, speed = 0.05, 0.5
    t = np.arange(180) / 60.0
    grip = 2 / 7 * speed / (mu * 9.80665)
    slips = np.minimum(t, grip)
    x = speed * slips - 0.5 * mu * 9.80665 * slips**2 + 5 / 7 * speed * (t - slips)
    first = scenario(
        support={"kind": "plane", "friction": 0.08},
        start={"position": [0, 0], "velocity": [0.4, 0.0], "angular_velocity": [0, 0, 0]},
    )
    found = tr.fit(seen(t, NOISE, 28, z=x + 0j), first, ["support.friction"], noise=NOISE)
    assert found.judgement.good
    assert max(off(found, "support.friction", mu), off(found, "start.velocity[0]", speed)) < 4


def test_a_spot_on_the_ball_shows_its_turning() -> None:
    # It rolls straight along x: the spot goes round the centre by x/a, clockwise seen from −y.
    t = np.arange(90) / 60.0
    x = down_incline(t, 0.05, 0.4)
    turn = x / RADIUS + 0.4
    spot = {"spot_x": x + 0.02 * np.sin(turn), "spot_z": RADIUS + 0.02 * np.cos(turn), "spot_y": np.full(90, 0.01)}
    slope = scenario(body=ball(0.5), support={"kind": "plane", "tilt": 0.05})
    found = tr.fit(seen(t, NOISE, 29, **spot), slope, [K], noise=NOISE)
    assert found.judgement.good
    assert off(found, K, 0.4) < 4
