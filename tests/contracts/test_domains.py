"""The conditions that several closed forms share: each fails for what it names, and for nothing else."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

import trundle as tr
from trundle.mechanics.system import RollingSystem
from trundle.solve.exact import CylinderOnCylinder, domain

SHARED = {name: one for name, one in vars(domain).items() if isinstance(one, domain.Condition)}
BALL = tr.Body.solid_sphere(0.1, 1.0)
STILL = RollingSystem(BALL, tr.Support(tr.Plane()))


def turning(motion: Any) -> RollingSystem:
    return replace(STILL, support=tr.Support(tr.Plane(), motion=motion))


def loaded(*loads: Any) -> RollingSystem:
    return replace(STILL, loads=loads)


FAILS = {
    "nothing": (STILL, {"TURNING_FREELY"}),
    "oblong": (replace(STILL, body=tr.Body(1.0, tr.Principal(3e-3, 3e-3, 5e-3), tr.Sphere(0.1))), {"ROUND", "SPHERE"}),
    "roller": (replace(STILL, body=tr.Body.cylinder(0.1, 1.0)), {"SPHERE"}),
    "spin": (turning(tr.Spin(2.0)), {"AT_REST"}),
    "free axle": (turning(tr.FreeAxle(0.5, 2.0)), {"AT_REST", "TURNING_STEADILY"}),
    "braked axle": (
        turning(tr.FreeAxle(0.5, 2.0, bearing_drag=0.1)),
        {"AT_REST", "TURNING_STEADILY", "TURNING_SO_OR_SO"},
    ),
    "wobble": (turning(tr.Wobble(3.5, 0.1)), {"AT_REST", "TURNING_STEADILY", "TURNING_SO_OR_SO"}),
    "still air": (loaded(tr.Drag(0.1)), {"CONSTANT_LOADS"}),
    "moving air": (loaded(tr.QuadraticDrag(0.1, 2.0)), {"CONSTANT_LOADS", "STILL_AIR"}),
    "growing force": (loaded(tr.Force(("t", 0.0, 0.0))), {"CONSTANT_LOADS"}),
    "force along": (loaded(tr.Force((0.1, 0.0, 0.0))), {"ALONG_NORMAL"}),
    "torque": (loaded(tr.Torque((0.0, 0.0, 0.1))), {"ALONG_NORMAL", "NO_TORQUE"}),
    "lean": (replace(STILL, support=tr.Support(tr.Plane(), tilt=0.1)), {"ALONG_NORMAL"}),
    "pulled up": (loaded(tr.Force((0.0, 0.0, 20.0))), {"PRESSED"}),
}


@pytest.mark.parametrize("case", FAILS)
def test_each_condition_fails_for_what_it_names_alone(case: str) -> None:
    system, fails = FAILS[case]
    fails = fails | ({"TURNING_FREELY"} if case != "free axle" else set())
    found = {name: list(one.failures(system, None)) for name, one in SHARED.items()}
    assert {name for name, reasons in found.items() if reasons} == fails
    assert all(reason.strip() for reasons in found.values() for reason in reasons)


def test_every_shared_condition_can_fail() -> None:
    assert set.union(*(fails for _, fails in FAILS.values())) == set(SHARED) - {"ANY_BODY"}


def test_a_later_stage_is_asked_only_of_what_passes_the_earlier() -> None:
    pipe = RollingSystem(BALL, tr.Support(tr.Cylinder(0.5), tilt="80 deg"), loads=(tr.Torque((0.0, 0.0, 0.1)),))
    start = pipe.place((0.5, 0.0), (0.2, 0.1))
    across = replace(pipe, support=tr.Support(tr.Cylinder(0.5), tilt="90 deg"), loads=())
    both = ["gravity or a force pulls along the cylinder's axis", "a torque acts on the body"]
    assert CylinderOnCylinder.violations(pipe, start) == both
    assert CylinderOnCylinder.violations(replace(pipe, support=replace(pipe.support, surface=tr.Plane())), start) == [
        "the surface is a plane, not a cylinder"
    ]
    assert CylinderOnCylinder.violations(across, start) == [
        "the start moves along the cylinder's axis or spins across it"
    ]
    assert CylinderOnCylinder.violations(across) == []
