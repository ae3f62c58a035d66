"""The cases: each exact motion by two routes, and each task complete."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import trundle as tr
from trundle.conformance import Case, PushedBox, Rolling, cases
from trundle.conformance.engines.adapters import trundle as own_adapter
from trundle.conformance.measuring import errors_of

CASES = cases()
# The top magnifies what is rounded, most of all as it begins to grip.
MAGNIFIED = {"tippe-top": 1e-10}


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_two_routes_lead_to_the_same_motion(case: Case) -> None:
    exact = case.exact()
    # A closed form is compared with Taylor's series, and those with DOP853, whose steps are relative to 1e-12.
    closed = isinstance(case, Rolling) and case.scenario.run().method == "exact"
    other = case.exact("taylor" if closed else "runge-kutta")
    errors = errors_of(case, exact, other)
    bound = MAGNIFIED.get(case.name, 1e-12)
    assert errors.position <= bound
    assert errors.turning <= bound
    assert errors.slip <= 10 * bound or isinstance(case, PushedBox)
    assert errors.energy <= 10 * bound


@pytest.mark.parametrize(
    "case", [case for case in CASES if isinstance(case, Rolling) and case.on_mesh() is None], ids=lambda case: case.name
)
def test_the_task_tells_all_of_the_motion(case: Case) -> None:
    task = json.loads(json.dumps(case.task(1e-3)))
    answer = own_adapter.run(task)
    exact = case.exact()
    size = np.abs(exact.position).max()
    assert np.abs(np.array(answer["position"]) - exact.position).max() <= 1e-12 * size
    assert (
        np.abs(np.array(answer["angular_velocity"]) - exact.angular_velocity).max()
        <= 1e-10 * np.abs(exact.angular_velocity).max()
    )


def test_the_pushed_box_gains_what_simbenchmark_asks() -> None:
    """F − μ_g (M + n m) g over M + n m k/(1 + k), worked out by hand for 150 N."""
    by_hand = (150 - 0.4 * 35 * 9.80665) / (10 + 25 * 2 / 7)
    for case in CASES:
        if isinstance(case, PushedBox):
            motion = case.exact()
            assert motion.velocity[-1, 0] @ [np.cos(case.direction), np.sin(case.direction), 0] == pytest.approx(
                by_hand
            )
            assert np.linalg.norm(motion.velocity[-1, 1:], axis=-1) == pytest.approx(2 / 7 * by_hand)


@pytest.mark.parametrize("name", ["pushed-box", "diagonal-box"])
def test_the_ground_holds_the_box_by_its_friction(name: str) -> None:
    """μ times the weight of all; an error of it counts elevenfold in the motion, which the small net force makes."""
    case = next(case for case in CASES if case.name == name)
    exact = case.exact()
    friction = 0.4 * 35.0 * 9.80665
    assert np.linalg.norm(case.friction_force(exact)) == pytest.approx(friction, rel=1e-12)
    assert case.friction_force(exact) @ exact.velocity[-1, 0] < 0
    net = 150.0 - friction
    wrong = replace(exact, velocity=exact.velocity * (150.0 - 1.01 * friction) / net)
    assert errors_of(case, exact, wrong).friction == pytest.approx(0.01, rel=1e-9)
    assert friction / net == pytest.approx(10.8, abs=0.05)


def test_energy_and_slip_are_what_the_laws_say() -> None:
    """What only rolls keeps its energy, or moving energy, and does not slip."""
    for case in CASES:
        if any(word in case.name for word in ("billiard", "bounce", "tippe", "dome")):
            continue
        exact = case.exact()
        scale = case.kinetic_energy(exact).max()
        assert np.ptp(case.energy(exact)) <= 1e-12 * scale, case.name
        assert np.abs(case.slip(exact)).max() <= 1e-13 * max(1.0, np.abs(exact.velocity).max()), case.name


def test_needs_are_read_off_the_task() -> None:
    needs = {case.name: case.needs for case in CASES}
    assert needs["hinged-turntable"] == {"plane", "sphere", "hinge"}
    assert needs["tippe-top"] == {"plane", "sphere", "offset"}
    assert needs["bounce-with-spin"] >= {"restitution"}
    assert needs["bowl-mesh-fine"] == {"mesh", "sphere"}
    assert needs["pushed-box"] >= {"several bodies", "box"}


@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("ball-in-a-turning-bowl", "support.kind"),
        ("cylinder-on-incline", "body.kind"),
        ("tilted-turntable", "support.friction"),
        ("ball-on-a-pushed-box", "support.motion.kind"),
        ("eulers-disc", "support.friction"),
    ],
)
def test_what_a_task_cannot_say_is_refused(name: str, key: str) -> None:
    with pytest.raises(tr.ScenarioError, match=key):
        Rolling.of(name, tr.Scenario.load(name))


def test_a_folder_without_cases_is_refused(tmp_path) -> None:
    with pytest.raises(tr.InvalidValueError, match="must hold case files"):
        cases(tmp_path)
    (tmp_path / "box.toml").write_text('title = "x"\n[pushed-box]\nforce = "hard"\n')
    with pytest.raises(tr.ScenarioError, match=r"pushed-box\.force"):
        cases(tmp_path)
