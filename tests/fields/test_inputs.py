"""What a controller drives: u does what the same loads and the same motion do as parts of the system."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.additions import Tumble
from tests.tolerances import EXACT

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector

EGG = tr.Body.ellipsoid((0.2, 0.15, 0.12), mass=1.0, turn="2 deg")
BOWL = tr.EllipsoidalBowl((0.5, 0.4, 0.3))
SYSTEM = tr.RollingSystem(EGG, tr.Support(BOWL, motion=tr.Spin(0.7), friction=0.4))
ON_AXLE = tr.RollingSystem(tr.Body.solid_sphere(0.05, 0.3), tr.Support(tr.Plane(), motion=tr.FreeAxle(0.1, rate=2.0)))
SHAKEN = tr.Shake((0.01, 0.02, 0.003), 4.0)
TUMBLING = Tumble(0.5, 0.3, -0.4, Vector(0.2, -0.1, 0.05), 1.5)
T = 0.3


def driven(field: Any, **values: Any) -> Any:
    """Return u with some of the inputs set."""
    u = dict(zip(field.input_names, field.inputs.tolist(), strict=True))
    for name, value in values.items():
        names = [name] if name in u else [f"{name}_{axis}" for axis in ("wxyz" if name.endswith("_q") else "xyz")]
        u |= dict(zip(names, np.atleast_1d(value).tolist(), strict=True))
    assert len(u) == field.inputs.size
    return np.array(list(u.values()))


def as_inputs(motion: Any, *, turns: bool) -> dict[str, Any]:
    """Return what a motion does at T as inputs."""
    now = motion.at(T)
    told = {
        "support": now.origin.array(),
        "support_velocity": now.velocity.array(),
        "support_acceleration": now.acceleration.array(),
    }
    turning = {
        "support_q": Quaternion.of_matrix(now.rotation).array(),
        "support_angular_velocity": now.angular_velocity.array(),
        "support_angular_acceleration": now.angular_acceleration.array(),
    }
    return told | (turning if turns else {})


def state(field: Any) -> Any:
    """Return some state by the support."""
    y = field.pack(field.system.place((0.1, 0.05), spin=1.0))
    y[: y.size - len(field.system.support.motion.coordinates)] += 0.05
    return y


@pytest.mark.parametrize("phase", ["rolling", "slipping", "flight"])
def test_a_force_and_a_torque_are_the_loads(phase: str) -> None:
    F, K = (0.3, -0.2, 0.1), (0.01, 0.02, -0.03)
    field = SYSTEM.vector_field("numpy", phase)
    loaded = replace(SYSTEM, loads=(tr.Force(F), tr.Torque(K))).vector_field("numpy", phase)
    y = field.pack(SYSTEM.place((0.1, 0.05), spin=1.0)) + 0.05
    found = field.rates(T, y, field.parameters, driven(field, force=F, torque=K))
    reference = loaded.rates(T, y, loaded.parameters, loaded.inputs)
    assert np.abs(found - reference).max() <= EXACT(64, np.abs(reference).max())
    assert np.abs(found - field.rates(T, y, field.parameters, field.inputs)).max() > 1e-3


@pytest.mark.parametrize("motion", [SHAKEN, TUMBLING])
@pytest.mark.parametrize("phase", ["rolling", "slipping", "flight"])
def test_a_platform_carries_the_support(motion: Any, phase: str) -> None:
    field = SYSTEM.vector_field("numpy", phase)
    carried = replace(SYSTEM, support=replace(SYSTEM.support, motion=tr.Combined((motion, tr.Spin(0.7)))))
    known = carried.vector_field("numpy", phase)
    y = field.pack(SYSTEM.place((0.1, 0.05), spin=1.0)) + 0.05
    found = field.rates(T, y, field.parameters, driven(field, **as_inputs(motion, turns=True)))
    reference = known.rates(T, y, known.parameters, known.inputs)
    assert np.abs(found - reference).max() <= EXACT(1024, np.abs(reference).max())


def test_an_axle_that_turns_freely_is_shifted() -> None:
    field = ON_AXLE.vector_field("numpy")
    assert not any("angular" in name for name in field.input_names)
    carried = replace(ON_AXLE, support=replace(ON_AXLE.support, motion=tr.Combined((SHAKEN, ON_AXLE.support.motion))))
    known = carried.vector_field("numpy")
    found = field.rates(T, state(field), field.parameters, driven(field, **as_inputs(SHAKEN, turns=False)))
    reference = known.rates(T, state(field), known.parameters, known.inputs)
    assert np.abs(found - reference).max() <= EXACT(256, np.abs(reference).max())


def test_inputs_that_are_left_out_are_not_there() -> None:
    field = SYSTEM.vector_field("numpy", inputs=("torque",))
    assert field.input_names == ("torque_x", "torque_y", "torque_z")
    assert SYSTEM.vector_field("numpy", inputs=()).inputs.size == 0
