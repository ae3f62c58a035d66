"""Models for physics engines say what the scenario says, and what they cannot say is told."""

from __future__ import annotations

import json
import re
import subprocess
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import trundle as tr
from trundle.conformance import Rolling, cases, engines
from trundle.conformance.models import FORMATS, engine_model
from trundle.mechanics.algebra import Quaternion, Vector

CASES = {case.name: case for case in cases() if isinstance(case, Rolling)}
REFUSED = {
    ("bounce-with-spin", ".xml"): "support.restitution",
    ("rattleback", ".urdf"): "body.kind",
    **{("driven-turntable", ending): "support.motion.kind" for ending in FORMATS},
    **{(name, ending): "support.kind" for name in CASES if name.startswith("bowl-mesh") for ending in FORMATS},
}
BOTH = [(name, ending) for name in CASES for ending in FORMATS]

# Run by an engine's own interpreter: what it makes of the models.
MUJOCO = """
import json, sys, mujoco
world = mujoco.MjModel.from_xml_string(sys.stdin.read())
data = mujoco.MjData(world)
mujoco.mj_resetDataKeyframe(world, data, world.key("start").id)
mujoco.mj_forward(world, data)
body = world.body("body").id
spun = data.body("body").cvel  # about the centre of mass of the tree: the body's, in the world's axes
print(json.dumps({
    "mass": world.body_mass[body], "position": list(data.xipos[body]),
    "orientation": list(data.xquat[body]), "angular_velocity": list(spun[:3]), "velocity": list(spun[3:]),
    "gravity": list(world.opt.gravity),
    "inertia": (data.ximat[body].reshape(3, 3) * world.body_inertia[body] @ data.ximat[body].reshape(3, 3).T).tolist(),
}))
"""


def parsed(name: str, ending: str) -> tuple[ET.Element, str]:
    text, unsaid = engine_model(CASES[name].scenario, ending)
    return ET.fromstring(text), unsaid  # noqa: S314  our own


def row(text: str | None) -> list[float]:
    return [float(number) for number in (text or "").split()]


@pytest.mark.parametrize(("name", "ending"), BOTH)
def test_a_model_has_the_mass_the_inertia_and_the_start_or_is_refused(name: str, ending: str) -> None:
    if (name, ending) in REFUSED:
        with pytest.raises(tr.ScenarioError, match=re.escape(f"`{REFUSED[name, ending]}` must be")):
            engine_model(CASES[name].scenario, ending)
        return
    root, unsaid = parsed(name, ending)
    scenario = CASES[name].scenario
    body, start = scenario.system().body, scenario.start_state()
    said = f"{ET.tostring(root, encoding='unicode')} {unsaid}"
    numbers = {float(word) for word in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", said)}
    moving = () if ending == ".xml" else (*start.velocity, *start.angular_velocity)  # MJCF has Ω in other axes
    for value in (*start.position, body.mass, scenario.system().support.friction, *moving):
        assert float(value) in numbers


@pytest.mark.parametrize("name", [name for name in CASES if (name, ".xml") not in REFUSED])
def test_what_rolls_in_the_scenario_rolls_in_the_keyframe(name: str) -> None:
    """MuJoCo has Ω in the body's axes and V in the world's: the slip at the contact is that of the scenario."""
    root, _ = parsed(name, ".xml")
    key = root.find("keyframe/key")
    assert key is not None
    places, rates = row(key.get("qpos")), row(key.get("qvel"))
    turns = Rotation.from_quat(places[-4:], scalar_first=True)
    scenario = CASES[name].scenario
    start = scenario.start_state()
    assert turns.apply(rates[-3:]) == pytest.approx(list(map(float, start.angular_velocity)), rel=1e-12, abs=1e-12)
    assert rates[-6:-3] == pytest.approx(list(map(float, start.velocity)), rel=1e-12, abs=1e-12)
    six = row(root.find("worldbody/body[@name='body']/inertial").get("fullinertia"))  # type: ignore[union-attr]
    xx, yy, zz, xy, xz, yz = six
    tensor = scenario.system().body.inertia_in_space(Quaternion(1.0, 0.0, 0.0, 0.0).matrix())
    for axis, line in zip(np.eye(3), ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)), strict=True):
        assert list(map(float, tensor @ Vector(*axis))) == pytest.approx(line, rel=1e-12, abs=1e-18)


def test_a_table_on_an_axle_turns_with_its_inertia() -> None:
    root, _ = parsed("hinged-turntable", ".xml")
    table = root.find("worldbody/body[@name='support']")
    assert table is not None
    assert table.find("joint").get("axis") == "0 0 1"  # type: ignore[union-attr]
    assert row(table.find("inertial").get("diaginertia"))[2] == 0.05  # type: ignore[union-attr]
    assert row(root.find("keyframe/key").get("qvel"))[0] == 3.49  # type: ignore[union-attr]
    root, unsaid = parsed("hinged-turntable", ".sdf")
    assert root.find("world/model/joint").get("type") == "revolute"  # type: ignore[union-attr]
    assert "rate of the support 3.49 rad/s" in unsaid


@pytest.mark.parametrize("ending", FORMATS)
def test_what_is_unsaid_stands_in_the_file_too(ending: str) -> None:
    text, unsaid = engine_model(tr.Scenario.load("billiard-draw"), ending)
    assert unsaid in text
    assert bool(unsaid) == (ending != ".xml")


@pytest.mark.skipif(not engines.engine("mujoco").installed, reason="MuJoCo is not installed: trundle score makes it")
@pytest.mark.parametrize("name", [name for name in CASES if (name, ".xml") not in REFUSED])
def test_mujoco_reads_it_back(name: str) -> None:
    text, _ = engine_model(CASES[name].scenario, ".xml")
    python = str(engines.engine("mujoco").python)
    told = subprocess.run([python, "-c", MUJOCO], input=text, capture_output=True, text=True, check=True)  # noqa: S603
    found: dict[str, Any] = json.loads(told.stdout)
    scenario = CASES[name].scenario
    system, start = scenario.system(), scenario.start_state()
    assert found["mass"] == system.body.mass
    for part in ("position", "velocity", "angular_velocity", "orientation"):
        assert found[part] == pytest.approx(list(map(float, getattr(start, part))), rel=1e-9, abs=1e-12)
    assert found["gravity"] == pytest.approx(CASES[name].situation()["gravity"], rel=1e-12, abs=1e-12)
    tensor = system.body.inertia_in_space(Quaternion(*start.orientation).matrix())
    for axis, line in zip(np.eye(3), found["inertia"], strict=True):
        assert list(map(float, tensor @ Vector(*axis))) == pytest.approx(line, rel=1e-9, abs=1e-15)
