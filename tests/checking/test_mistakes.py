"""Each mistake is planted in somebody else's integration, and must be found and named; right data must pass."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.scenario import files

from .theirs import Ball, G, N, integrated, only, replace, skidding, turned, vectors, with_parts

BALL = Ball(tilt=0.004)
LOPSIDED = Ball(J=(5e-5, 8e-5, 12e-5), omega=0.0, tilt=0.0)  # Chaplygin's: its centre of mass in the middle
PUSHED = Ball(omega=0.0, tilt=0.0, push=(0.05, 0.02, 0.0))
K_UNIT = BALL.m * BALL.a**2


def system(ball: Ball) -> tr.RollingSystem:
    inertia = tr.Isotropic(ball.J[0]) if len(set(ball.J)) == 1 else tr.Principal(*ball.J)
    motion = tr.Spin(ball.omega) if ball.omega else tr.Fixed()
    loads = [tr.Force(ball.push)] * any(ball.push) + [tr.Drag(ball.drag)] * bool(ball.drag)
    table = tr.Support(tr.Plane(), motion=motion, tilt=ball.tilt)
    return tr.RollingSystem(tr.Body(ball.m, inertia, tr.Sphere(ball.a)), table, loads=tuple(loads))


@functools.cache
def run(wrong: Ball = BALL, start_of: Ball | None = None) -> dict[str, Any]:
    y0 = (start_of or wrong).start(0.1, 0.05, 0.1, -0.2, 3.0)
    return wrong.run(y0, 2.0)


def found(data: dict[str, Any], ball: Ball, **options: Any) -> tr.Check:
    return tr.check(data, system(ball), **options)


def names(checked: tr.Check) -> set[str]:
    return {mistake.name for mistake in checked.likely}


@pytest.mark.parametrize("parts", ["", "v", "w", "q", "vwq"])
@pytest.mark.parametrize("ball", [BALL, PUSHED], ids=["turntable", "pushed"])
def test_a_right_integration_passes_whatever_of_it_was_written(ball: Ball, parts: str) -> None:
    checked = found(only(run(ball), parts), ball)
    assert checked.passed, str(checked)
    assert (checked.first_failure, checked.likely, checked.remark) == (None, (), "")
    assert all(figure.value < 0.1 * figure.bound for figure in checked.figures if figure.bound)


@pytest.mark.parametrize("parts", ["w", "q", "vwq"])
def test_a_lopsided_ball_passes(parts: str) -> None:
    assert found(only(run(LOPSIDED), parts), LOPSIDED).passed


@pytest.mark.parametrize("parts", ["", "vw"])
@pytest.mark.parametrize("digits", [4, 6])
def test_digits_cut_off_widen_the_bound_and_the_card_says_so(parts: str, digits: int) -> None:
    exact = found(only(run(), parts), BALL)
    rounded = found({name: np.round(array, digits) for name, array in only(run(), parts).items()}, BALL)
    assert rounded.passed
    law = rounded["law of motion, acceleration"]
    assert law.bound > exact["law of motion, acceleration"].bound
    told = "noise and spacing of the data leave that much open" in law.note
    assert told is (law.bound > 2 * exact["law of motion, acceleration"].bound)
    assert told or digits > 4
    scatter = rounded["scatter of the positions"].value
    assert 0.3 < scatter / (10.0**-digits / np.sqrt(6)) < 1.5  # 10⁻ᵈ/√12 in each of two components that move


def test_noise_of_a_camera_passes_and_a_wrong_law_under_it_fails() -> None:
    shaken = np.random.default_rng(1).normal(scale=2e-5, size=(200, 2))
    shell = run(replace(BALL, J=(2 / 3 * K_UNIT,) * 3), BALL)
    for data, passes in ((run(), True), (shell, False)):
        seen = {"t": data["t"], "x": data["x"] + shaken[:, 0], "y": data["y"] + shaken[:, 1]}
        checked = found(seen, BALL)
        assert checked.passed is passes
        assert passes or "wrong-inertia-ratio" in names(checked)


def shipped() -> list[str]:
    found = []
    for name in files.names():
        try:
            tr.Scenario.load(name)
        except tr.ScenarioError:  # a path without forces
            continue
        found.append(name)
    return found


@pytest.mark.parametrize("name", shipped())
def test_what_ships_passes_on_every_surface(name: str) -> None:
    scenario = tr.Scenario.load(name)
    short = scenario.run(duration=min(1.0, float(scenario.timing.duration)))
    if short.events or (short.data.phase.values != 0).any():
        pytest.skip("it slips, flies or stops: a check is about rolling")
    if short.system.support.motion.coordinates:
        with pytest.raises(tr.InvalidValueError, match=r"support\.motion"):
            tr.check(short, scenario)
        return
    checked = tr.check(short, scenario)
    assert checked.passed, str(checked)
    ours = [figure for figure in checked.figures if figure.name == "our own run from the same start"]
    assert all(figure.passed is not False for figure in ours)
    # The rattleback magnifies a difference beyond what a comparison can tell.
    assert any(figure.passed for figure in ours) or name.startswith("rattleback")


SPUN = replace(BALL, omega=-BALL.omega)
STILL = replace(BALL, omega=0.0)
SHELL = replace(BALL, J=(2 / 3 * K_UNIT,) * 3)
DEGREES = replace(BALL, tilt=float(np.degrees(BALL.tilt)))
LAWS = {
    "k of a shell": (SHELL, BALL, BALL, "wrong-inertia-ratio"),
    "all moments": (replace(LOPSIDED, J=(6e-5, 9.6e-5, 14.4e-5)), LOPSIDED, LOPSIDED, "wrong-inertia"),
    "other sense": (SPUN, SPUN, BALL, "sign-of-table-rate"),
    "table at rest": (STILL, STILL, BALL, "table-motion-ignored"),
    "no gyroscopic term": (replace(LOPSIDED, gyroscopic=False), LOPSIDED, LOPSIDED, "missing-gyroscopic-term"),
    "no u rate": (replace(BALL, carried=False), BALL, BALL, "missing-carrying-term"),
    "no tilt": (replace(BALL, tilt=0.0), BALL, BALL, "tilt-left-out"),
    "tilt up": (replace(BALL, tilt=-BALL.tilt), BALL, BALL, "sign-of-tilt"),
    "tilt in degrees": (DEGREES, BALL, BALL, "degrees-for-radians"),
    "no force": (replace(PUSHED, push=(0.0, 0.0, 0.0)), PUSHED, PUSHED, "load-left-out"),
    "no rolling factor": (replace(PUSHED, push=(0.07, 0.028, 0.0)), PUSHED, PUSHED, "rolling-factor"),
    "no drag": (BALL, BALL, replace(BALL, drag=0.3), "load-left-out"),
}
ODD = {  # by numbers that have no reason
    "odd k": (replace(BALL, J=(0.45 * K_UNIT,) * 3), BALL, BALL, "wrong-inertia-ratio"),
    "rate off": (replace(BALL, omega=3.6), replace(BALL, omega=3.6), BALL, "wrong-table-rate"),
    "odd tilt": (replace(BALL, tilt=0.006), BALL, BALL, "wrong-gravity-or-force"),
}


@pytest.mark.parametrize("case", LAWS)
def test_a_wrong_law_is_named(case: str) -> None:
    wrong, start_of, right, name = LAWS[case]
    checked = found(only(run(wrong, start_of), "vw"), right)
    assert not checked.passed
    assert names(checked) == {name}, str(checked)
    (mistake,) = checked.likely
    assert mistake.after <= mistake.bound < mistake.before
    assert checked.first_failure == 0.0


def test_what_was_fitted_is_what_was_planted() -> None:
    def number(case: str, key: str) -> float:
        wrong, start_of, right, name = ODD[case]
        (mistake,) = found(only(run(wrong, start_of), "v"), right).likely
        assert (mistake.name, mistake.named) == (name, False)
        return mistake.numbers[key]

    assert number("odd k", "inertia_ratio") == pytest.approx(0.45, rel=1e-6)
    assert number("rate off", "rate") == pytest.approx(3.6, rel=1e-6)
    assert number("odd tilt", "x") == pytest.approx(G * (np.sin(0.006) - np.sin(0.004)), rel=1e-6)


def test_two_mistakes_that_positions_cannot_tell_apart_are_both_listed() -> None:
    checked = found(only(run(STILL), ""), BALL)
    assert names(checked) == {"table-motion-ignored", "missing-carrying-term"}
    assert "cannot tell them apart" in str(checked)
    level = replace(BALL, tilt=0.0)
    shell = found(only(run(replace(SHELL, tilt=0.0), level), ""), level)
    assert [mistake.name for mistake in shell.likely] == ["wrong-inertia-ratio", "wrong-table-rate"]
    assert [mistake.named for mistake in shell.likely] == [True, False]


def corotating(data: dict[str, Any], omega: float) -> dict[str, Any]:
    c, s = np.cos(omega * data["t"]), np.sin(omega * data["t"])

    def seen(v: Any) -> Any:
        return np.column_stack([c * v[:, 0] + s * v[:, 1], -s * v[:, 0] + c * v[:, 1], v[:, 2]])

    r, V, w = (vectors(data, stem) for stem in ("", "v", "w"))
    V, w = V - omega * np.cross(N, r), w - omega * N
    return with_parts(with_parts(with_parts(data, "", seen(r)), "v", seen(V)), "w", seen(w))


def along_body(data: dict[str, Any]) -> dict[str, Any]:
    Q = np.array([turned(q) for q in vectors(data, "q")])
    return with_parts(data, "w", np.einsum("nji,nj->ni", Q, vectors(data, "w")))


def from_displacement(data: dict[str, Any], ball: Ball) -> dict[str, Any]:
    d = vectors(data, "") - vectors(data, "")[0]
    angle, axis = np.linalg.norm(d, axis=1) / ball.a, np.cross(N, d)
    axis /= np.maximum(np.linalg.norm(axis, axis=1), 1e-300)[:, None]
    return with_parts(data, "q", np.column_stack([np.cos(angle / 2), np.sin(angle / 2)[:, None] * axis]))


def scaled(data: dict[str, Any], stem: str, factor: float) -> dict[str, Any]:
    return data | {f"{stem}{axis}": data[f"{stem}{axis}"] * factor for axis in "xyz"}


def misread(case: str) -> tuple[dict[str, Any], Ball, str]:
    data = run()
    q = vectors(data, "q")
    return {
        "milliseconds": (data | {"t": data["t"] * 1e3}, BALL, "time-unit"),
        "millimetres": (scaled(data, "", 1e3), BALL, "length-unit"),
        "degrees": (scaled(data, "w", 180 / np.pi), BALL, "degrees-for-radians"),
        "rpm": (only(scaled(data, "w", 30 / np.pi), "w"), BALL, "rate-unit"),
        "sign of omega": (only(scaled(data, "w", -1.0), "vw"), BALL, "sign-of-angular-velocity"),
        "contact": (data | {"z": 0 * data["z"]}, BALL, "contact-for-centre"),
        "table's eyes": (only(corotating(data, BALL.omega), "vw"), BALL, "corotating-frame"),
        "table's eyes, path": (only(corotating(data, BALL.omega), ""), BALL, "corotating-frame"),
        "body rates": (along_body(data), BALL, "body-axes-for-space-axes"),
        "body rates alone": (only(along_body(data), "vw"), BALL, "body-axes-for-space-axes"),
        "q of body rates": (
            with_parts(data, "q", integrated(data, body_axes=True)),
            BALL,
            "body-axes-for-space-axes",
        ),
        "holonomic": (from_displacement(run(PUSHED), PUSHED), PUSHED, "holonomic-constraint"),
        "holonomic, q alone": (only(from_displacement(run(PUSHED), PUSHED), "q"), PUSHED, "holonomic-constraint"),
        "xyzw": (with_parts(data, "q", q[:, [1, 2, 3, 0]]), BALL, "quaternion-order"),
        "inverse": (with_parts(data, "q", q * [1, -1, -1, -1]), BALL, "inverse-orientation"),
    }[case]


MISREAD = [
    *("milliseconds", "millimetres", "degrees", "rpm", "sign of omega", "contact"),
    *("table's eyes", "table's eyes, path", "body rates", "body rates alone", "q of body rates"),
    *("holonomic", "holonomic, q alone", "xyzw", "inverse"),
]


@pytest.mark.parametrize("case", MISREAD)
def test_numbers_that_mean_something_else_are_named(case: str) -> None:
    data, ball, name = misread(case)
    checked = found(data, ball)
    assert not checked.passed
    assert names(checked) == {name}, str(checked)


def test_an_orientation_integrated_rightly_is_no_mistake() -> None:
    assert found(with_parts(run(), "q", integrated(run(), body_axes=False)), BALL).passed


def test_a_ball_that_skids_and_then_rolls() -> None:
    level = replace(BALL, omega=0.0, tilt=0.0)
    data, end = skidding(level, 0.1, np.array([0.5, 0.1, 0.0]), np.array([4.0, -10.0, 2.0]))
    checked = found(data, level)
    assert names(checked) == {"slipping"}, str(checked)
    assert checked.likely[0].numbers["friction"] == pytest.approx(0.1, rel=1e-6)
    assert checked.likely[0].numbers["until"] == pytest.approx(end, abs=0.004)  # two samples


def test_the_first_time_it_goes_wrong() -> None:
    first = run()
    onward = np.array([first[name][-1] for name in list(first)[1:]])
    second = replace(BALL, tilt=0.02).run(onward, 1.0)
    both = {name: np.concatenate([first[name][:-1], second[name]]) for name in first}
    both["t"] = np.concatenate([first["t"][:-1], first["t"][-1] + second["t"]])
    for parts in ("vw", ""):
        checked = found(only(both, parts), BALL)
        assert checked.first_failure == pytest.approx(first["t"][-1], abs=0.1)
        assert not checked.likely
        assert "look for what changes there" in checked.remark


def test_crude_steps_are_told_from_a_wrong_law() -> None:
    data = BALL.stepped(BALL.start(0.1, 0.05, 0.1, -0.2, 3.0), 1.0)
    checked = found(only(data, "vw"), BALL)
    assert names(checked) == {"crude-steps"}
    assert checked.likely[0].numbers["step"] == pytest.approx(1e-3)
    assert found(only(data, "vw"), BALL, tolerance=1e-3).passed  # for those who can live with it
    positions = found(only(data, ""), BALL)
    assert not positions.passed
    assert "steps" in positions.remark


def test_data_that_tell_nothing_are_said_to() -> None:
    shaken = np.random.default_rng(1).normal(scale=2e-2, size=(200, 2))
    checked = found({"t": run()["t"], "x": run()["x"] + shaken[:, 0], "y": run()["y"] + shaken[:, 1]}, BALL)
    assert "too noisy to tell: law of motion" in checked.remark


def test_it_draws_and_goes_to_json_and_back() -> None:
    checked = found(only(run(SHELL, BALL), "v"), BALL)
    sheet = checked.plot()
    assert len(sheet.axes) == 1 + sum(figure.bound is not None for figure in checked.figures)
    assert checked.as_dict()["likely"][0]["name"] == "wrong-inertia-ratio"
    assert tr.Card.from_json(checked.as_json()).figures == checked.figures
