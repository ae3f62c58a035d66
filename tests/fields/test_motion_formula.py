"""T5 for other programs: the same motion in each language, and true slopes where ω or the drag is nothing."""

from __future__ import annotations

import json
import subprocess
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from tests.fields.systems import node
from tests.reference.t5 import DIGITS, Ball

import trundle as tr
from trundle.errors import OutOfDomainError
from trundle.fields import MotionFormula
from trundle.fields.compiler import compiler
from trundle.solve.exact import CylinderOnCylinder, SphereOnPlane

VECTORS = ("position", "velocity", "angular_velocity", "contact_force")
GIVEN: dict[str, Any] = {
    "radius": 0.025,
    "mass": 0.065,
    "inertia_ratio": 0.4,
    "position": (0.1, -0.2),
    "velocity": (0.3, 0.4),
    "spin": 1.5,
    "force": (0.02, 0.01, -0.64),
    "torque": (1e-4, -2e-4, 3e-4),
}
# Nothing, next to nothing, a series and the formula proper, of either, and of both.
CASES = list(product((0.0, 1e-9, 0.4, -3.5), (0.0, 1e-9, 0.05), (0.0, 0.7, 20.0)))


def numbers_of(ball: Ball, t: Any) -> list[Any]:
    """Return what the reference says of place, velocity, Ω and force along the plane."""
    found = ball.at(t)
    return [part for name in VECTORS for part in (found[name].value.real, found[name].value.imag)]


def along(found: Any) -> Any:
    """Return the same parts of what the formula says."""
    return np.asarray(found)[..., [0, 1, 3, 4, 6, 7, 9, 10]]


def allowed(ball: Ball, t: float) -> Any:
    """Return what a float may be off."""
    found = ball.at(t)
    return np.array([found[name].bound(mpf(t)) for name in VECTORS for _ in range(2)])


@pytest.mark.parametrize("backend", ["numpy", "numba", "jax", "c"])
def test_it_is_the_motion(backend: str) -> None:
    if backend == "c" and compiler() is None:
        pytest.skip("no C compiler is found here")
    if backend == "jax":
        pytest.importorskip("jax").config.update("jax_enable_x64", True)
    form = SphereOnPlane(rate=1.0, drag=0.1, **GIVEN)
    motion = MotionFormula(form, backend).motion
    for rate, drag, t in CASES:
        ball = Ball(rate=rate, drag=drag, **GIVEN)
        found = along(motion(t, MotionFormula(replace(form, rate=rate, drag=drag)).parameters))
        wrong = np.abs(found - np.array(numbers_of(ball, t), dtype=float))
        assert (wrong <= 2 * allowed(ball, t)).all(), (rate, drag, t)


def test_in_javascript_too(tmp_path: Path) -> None:
    form = SphereOnPlane(rate=1.0, drag=0.1, **GIVEN)
    (tmp_path / "formula.mjs").write_text(MotionFormula(form, "javascript").source())
    calls = []
    for rate, drag, t in CASES:
        p = MotionFormula(replace(form, rate=rate, drag=drag)).parameters.tolist()
        calls.append(f"motion({t}, {json.dumps(p)})")
    text = f'import {{ motion }} from "./formula.mjs";\nconsole.log(JSON.stringify([{", ".join(calls)}]));\n'
    (tmp_path / "main.mjs").write_text(text)
    done = subprocess.run([node(), "main.mjs"], cwd=tmp_path, capture_output=True, text=True, check=True)  # noqa: S603
    for (rate, drag, t), found in zip(CASES, json.loads(done.stdout), strict=True):
        ball = Ball(rate=rate, drag=drag, **GIVEN)
        wrong = np.abs(along(found) - np.array(numbers_of(ball, t), dtype=float))
        assert (wrong <= 2 * allowed(ball, t)).all(), (rate, drag, t)


@pytest.mark.parametrize(("rate", "drag"), list(product((0.0, 3.5), (0.0, 0.05))))
def test_its_slopes_are_true_where_rate_or_drag_is_nothing(rate: float, drag: float) -> None:
    jax = pytest.importorskip("jax", reason="the extra jax is not installed")
    jax.config.update("jax_enable_x64", True)
    formula = MotionFormula(SphereOnPlane(rate=rate, drag=drag, **GIVEN), "jax")
    slopes = [jax.jit(each(formula.motion, argnums=1)) for each in (jax.jacfwd, jax.jacrev)]
    names = formula.parameter_names
    for t in (0.0, 0.7, 20.0):
        found = [np.asarray(each(t, formula.parameters)) for each in slopes]
        assert all(np.isfinite(each).all() for each in found)
        with mpmath.workdps(DIGITS):
            step = mpf(10) ** -20
            for name in ("rate", "drag", "inertia_ratio", "mass", "radius", "velocity[0]", "torque[1]"):
                field, _, which = name.rstrip("]").partition("[")
                ends = []
                for sign in (1, -1):
                    whole = {**GIVEN, "rate": rate, "drag": drag}
                    value = whole[field]
                    moved = mpf(value[int(which)] if which else value) + sign * step
                    parts = [moved if str(i) == which else part for i, part in enumerate(value)] if which else moved
                    ends.append(numbers_of(Ball(**{**whole, field: tuple(parts) if which else parts}), t))
                reference = np.array([float((a - b) / (2 * step)) for a, b in zip(*ends, strict=True)])
                size = max(1.0, np.abs(reference).max())
                for each in found:
                    assert np.abs(along(each[:, names.index(name)].T) - reference).max() <= 1e-11 * size, (t, name)


def test_names_and_what_cannot_be_written_out() -> None:
    scenario = tr.Scenario.load("tilted-turntable")
    form = SphereOnPlane.of(scenario.system(), scenario.start_state())
    formula = MotionFormula(form)
    assert dict(zip(formula.parameter_names, formula.parameter_units, strict=True))["position[1]"] == "m"
    assert formula.output_names[-1] == "contact_force_z"
    scenario = tr.Scenario.load("ball-in-a-trough")
    with pytest.raises(OutOfDomainError, match="T6 decides by the values"):
        MotionFormula(CylinderOnCylinder.of(scenario.system(), scenario.start_state()))
