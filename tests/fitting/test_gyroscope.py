"""A gyroscope inside a ball: Ω along axes of its own, against motion by formulas that the package did not make."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from tests.fitting.measured import RADIUS, ball, scenario, turntable

import trundle as tr
from trundle.analysis.fit.unknowns import prepared

K, BIAS = "body.inertia_ratio", "gyroscope.bias"
NOISE = "0.01 rad/s"
T = np.arange(600) / 100.0
MOUNTING = np.array([0.7, -1.1, 0.4])


def inside(rate: float, velocity: complex = 0.02 + 0.15j, spin: float = 2.0, k: float = 0.4, **more: Any) -> Any:
    """What a gyroscope shows in a ball on a level table, that starts at 0.1 m on the x-axis.

    Its path is a circle by Milne's formula; Ω follows from V − u = a Ω×n, and the orientation from Ω by SciPy.
    """

    t = more.pop("t", T)

    def turning(t: Any) -> Any:
        v, moved = velocity * np.exp(1j * kappa * t), velocity * t
        if kappa:
            moved = (v - velocity) / (1j * kappa)
        off = (v - 1j * rate * (0.1 + moved)) / RADIUS
        return np.array([-off.imag, off.real, spin + 0 * off.real])

    def law(t: float, q: Any) -> Any:  # q̇ = Ω q/2, the scalar last
        return 0.5 * np.array([*(turning(t) * q[3] + np.cross(turning(t), q[:3])), -turning(t) @ q[:3]])

    kappa = rate * k / (1 + k)
    turned = solve_ivp(law, (0.0, t[-1]), [0.0, 0.0, 0.0, 1.0], "DOP853", t, rtol=1e-10, atol=1e-12).y.T
    own = Rotation.from_quat(turned)
    shown = (own * Rotation.from_rotvec(more.pop("mounting", MOUNTING))).inv().apply(turning(t).T)
    shown = shown + np.random.default_rng(1).normal(scale=0.01, size=shown.shape) + more.pop("bias", 0.0)
    return {"t": t, **{f"gyro_{axis}": column for axis, column in zip("xyz", shown.T, strict=True)}, **more}


def table(rate: float, k: float = 0.5, spin: float = 1.5) -> tr.Scenario:
    return scenario(body=ball(k), support=turntable(rate, 0.0), start={"position": [0.1, 0.0], "spin": spin})


@pytest.mark.parametrize("rate", [3.487, -2.1])
@pytest.mark.parametrize("mounting", [MOUNTING, -MOUNTING, np.array([0.0, 0.0, 3.0]), np.zeros(3)], ids=str)
def test_it_shows_the_ratio_of_inertia_alone(rate: float, mounting: np.ndarray) -> None:
    found = tr.fit(inside(rate, mounting=mounting), table(rate), [K, "start.spin"], noise=NOISE)
    for name, truth in ((K, 0.4), ("start.spin", 2.0)):
        one = found[name]
        assert one.sigma is not None, one
        assert abs(one.value - truth) < 4 * one.sigma
    assert found[K].sigma < 0.01
    assert found.answer == "good"


@pytest.mark.parametrize("rate", [3.487, -2.1])
def test_the_spin_is_found_with_the_start(rate: float) -> None:
    """Whoever lets a ball go knows its spin no better than its velocity."""
    found = tr.fit(inside(rate), table(rate), K, noise=NOISE)
    assert found.answer == "good"
    for name, truth in ((K, 0.4), ("start.spin", 2.0)):
        assert abs(found[name].value - truth) < 4 * found[name].sigma


def test_the_turning_along_axes_at_rest_shows_the_spin_too() -> None:
    """On a level table at rest a ball rolls straight on: Ω = n×V/a + spin n for good."""
    draw = np.random.default_rng(2).normal(scale=1e-3, size=(2, T.size))
    seen = {"t": T, "x": 0.1 + 0.05 * T + draw[0], "wz": -1.3 + draw[1]}
    placed = {"position": [0.0, 0.0], "spin": 0.5}
    found = tr.fit(seen, scenario(body=ball(0.4), start=placed), [], noise={"x": 1e-3, "wz": 1e-3})
    assert abs(found["start.spin"].value + 1.3) < 4 * found["start.spin"].sigma < 1e-3


def test_a_spin_is_about_the_normal_where_a_bowl_leans() -> None:
    """What the three components of Ω say of it, and not the one along z."""
    bowl = {"kind": "bowl", "radius": 0.2}
    told = {"body": ball(0.4), "support": bowl, "start": {"position": [0.1, 0.0], "velocity": [0.0, 0.1], "spin": 3.0}}
    spun = scenario(**told)
    Omega = spun.start_state().angular_velocity
    assert abs(Omega[2] - 3.0) > 0.5
    turning = scenario(**{**told, "start": {**told["start"], "spin": None, "angular_velocity": list(Omega)}})
    assert prepared(turning, [], 0.0).start.spin == pytest.approx(3.0, abs=1e-12)


@pytest.mark.parametrize("rate", [3.487, -2.1])
@pytest.mark.parametrize("spin", [0.0, -2.0])
def test_it_is_found_from_a_start_that_is_far_off(rate: float, spin: float) -> None:
    found = tr.fit(inside(rate), table(rate, spin=spin), [K, "start.spin"], noise=NOISE)
    assert found.answer == "good"
    assert abs(found[K].value - 0.4) < 4 * found[K].sigma


@pytest.mark.parametrize("attitude", [[0, 0, 3.0], [2.0, -1.5, 0.5]], ids=str)
@pytest.mark.parametrize("spin", [1.5, -2.0])
@pytest.mark.parametrize("velocity", [0.02 + 0.15j, -0.1 - 0.1j])
def test_what_is_known_of_the_mounting_is_of_the_axes_of_the_body(
    attitude: list[float], spin: float, velocity: complex
) -> None:
    placed = {"position": [0.1, 0.0], "spin": spin, "attitude": attitude}
    lying = scenario(body=ball(0.5), support=turntable(3.487, 0.0), start=placed)
    own = Rotation.from_quat(lying.start_state().orientation, scalar_first=True)
    mounting = (own.inv() * Rotation.from_rotvec(MOUNTING)).as_rotvec()
    known = {f"gyroscope.mounting[{i}]": (mounting[i], 0.01) for i in range(3)}
    found = tr.fit(inside(3.487, velocity), lying, [K, "start.spin"], priors=known, noise=NOISE)
    assert found.answer == "good"
    for name, truth in ((K, 0.4), ("start.velocity[0]", velocity.real), ("start.velocity[1]", velocity.imag)):
        assert abs(found[name].value - truth) < 4 * found[name].sigma


def circle(rate: float, velocity: complex = 0.02 + 0.15j) -> dict[str, np.ndarray]:
    kappa = rate * 2 / 7
    z = 0.1 + velocity * (np.exp(1j * kappa * T) - 1) / (1j * kappa)
    scatter = np.random.default_rng(5).normal(scale=5e-4, size=(2, T.size))
    return {"x": z.real + scatter[0], "y": z.imag + scatter[1]}


def test_beside_a_film_it_shows_how_it_is_mounted() -> None:
    both = inside(3.487, **circle(3.487))
    noise = {"x": "0.5 mm", "y": "0.5 mm"} | dict.fromkeys(("gyro_x", "gyro_y", "gyro_z"), NOISE)
    found = tr.fit(both, table(3.487), [K, "start.spin"], noise=noise)
    assert not found.undetermined
    for name, truth in ((K, 0.4), *((f"gyroscope.mounting[{i}]", MOUNTING[i]) for i in range(3))):
        one = found[name]
        assert one.sigma is not None, one
        assert abs(one.value - truth) < 4 * one.sigma
    assert found.answer == "good"


def test_what_it_shows_at_rest_is_fitted_where_that_is_asked() -> None:
    bias = np.array([0.05, -0.03, 0.02])
    found = tr.fit(inside(3.487, bias=bias), table(3.487), [K, "start.spin", BIAS], noise=NOISE)
    assert found.answer == "good"
    for name, truth in ((K, 0.4), *((f"{BIAS}[{i}]", bias[i]) for i in range(3))):
        one = found[name]
        assert one.sigma is not None, one
        assert abs(one.value - truth) < 4 * one.sigma
    assert tr.fit(inside(3.487, bias=bias), table(3.487), [K, "start.spin"], noise=NOISE).answer == "bad"


def test_about_the_axis_of_the_table_a_bias_is_not_told_from_the_ratio_of_inertia() -> None:
    """In such a ball Ω goes round a circle: its radius, place and rate are one number too few for k, Ω and a bias."""
    data = inside(3.487, velocity=3.487j * 2 / 7 * 0.1)
    start = {"position": [0.1, 0.0], "spin": 2.0, "velocity": [0.0, 0.0996]}
    turning = scenario(body=ball(0.5), support=turntable(3.487, 0.0), start=start)
    found = tr.fit(data, turning, [K, "start.spin", BIAS], noise=NOISE)
    assert found[K].sigma is None
    assert found.answer != "bad"


def test_left_handed_axes_fit_no_motion() -> None:
    data = inside(3.487)
    data["gyro_z"] = -data["gyro_z"]
    found = tr.fit(data, table(3.487), [K, "start.spin"], noise=NOISE)
    assert found.answer != "good"
    assert found.judgement.reduced > 100


def test_gaps_uneven_times_and_an_unknown_noise() -> None:
    draw = np.random.default_rng(8)
    t = np.sort(draw.uniform(0.0, 8.0, 500))
    data = inside(3.487, t=t - t[0])
    data["gyro_x"][100:108] = np.nan
    data["gyro_y"][0] = np.nan
    found = tr.fit(data, table(3.487), [K, "start.spin"])
    assert abs(found[K].value - 0.4) < 4 * found[K].sigma
    assert found[K].sigma < 0.001


def test_two_runs_share_the_ball_and_not_how_it_lies_in_the_hand() -> None:
    runs = [inside(3.487), inside(3.487, velocity=-0.1 + 0.05j, spin=-3.0, mounting=-MOUNTING)]
    found = tr.fit(runs, table(3.487), [K, "start.spin"], noise=NOISE)
    assert found.answer == "good"
    assert abs(found[K].value - 0.4) < 4 * found[K].sigma
    one = tr.fit(runs[0], table(3.487), [K, "start.spin"], noise=NOISE)
    assert found[K].sigma < one[K].sigma


@pytest.mark.parametrize("step", [0.03, 0.06])
def test_few_rows_a_turn(step: float) -> None:
    found = tr.fit(inside(3.487, t=np.arange(0.0, 9.0, step)), table(3.487), [K, "start.spin"], noise=NOISE)
    assert found.answer == "good"
    assert abs(found[K].value - 0.4) < 4 * found[K].sigma


def test_how_it_is_mounted_is_said_not_to_show_where_it_does_not() -> None:
    """On a table at rest Ω stays along one axis of the ball: about that the gyroscope may sit as it will."""
    found = tr.fit(inside(0.0, spin=0.0), table(0.0, spin=0.0), [], noise=NOISE)
    assert any("gyroscope.mounting" in name for one in found.undetermined for name in one.names)
    assert found.answer != "bad"


def test_it_is_read_from_the_file_of_a_telephone(tmp_path: Any) -> None:
    data = inside(3.487)
    names = ["Time (s)", *(f"Gyroscope {axis} (rad/s)" for axis in "xyz")]
    lines = [",".join(f'"{name}"' for name in names)]
    lines += [",".join(map(repr, map(float, row))) for row in zip(*data.values(), strict=True)]
    (tmp_path / "phone.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    by_file = tr.fit(tmp_path / "phone.csv", table(3.487), [K, "start.spin"], noise=NOISE)
    by_table = tr.fit(data, table(3.487), [K, "start.spin"], noise=NOISE)
    assert by_file[K].value == pytest.approx(by_table[K].value, rel=1e-9)


def test_numbers_of_a_gyroscope_want_one() -> None:
    with pytest.raises(tr.InvalidValueError, match="without a gyroscope"):
        tr.fit({"t": T, **circle(3.487)}, table(3.487), [K, BIAS])
    with pytest.raises(tr.UnknownNameError, match=r"gyroscope\.bias"):
        tr.fit(inside(3.487), table(3.487), ["gyroscope.drift"])
