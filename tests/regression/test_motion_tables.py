"""Motions and loads in a scenario file: every kind reads, means what its class means, and is written back."""

from __future__ import annotations

import math
from typing import Any

import pytest

from trundle.errors import ScenarioError
from trundle.mechanics.loads import (
    Drag,
    Load,
    Magnus,
    Motor,
    PivotFriction,
    Potential,
    QuadraticDrag,
    RollingCouple,
    RollingResistance,
)
from trundle.mechanics.motions import (
    Combined,
    Fixed,
    FreeAxle,
    Motion,
    Move,
    PrecessingTilt,
    Rock,
    Shake,
    Spin,
    SpinBy,
    Tilt,
    Wobble,
)
from trundle.scenario import ScenarioFile
from trundle.scenario.serialize import words_of
from trundle.scenario.tables import KINDS

HEAD = """
[body]
kind = "solid-sphere"
radius = "25 mm"
mass = "65 g"
[start]
position = ["10 cm", 0]
[run]
duration = "1 s"
every = "10 ms"
[support]
kind = "plane"
"""
READ_MOTIONS: dict[str, tuple[str, Motion]] = {
    "spin-by": ('rate = "3.5*(1 - exp(-t/2))"', SpinBy("3.5*(1 - exp(-t/2))")),
    "spin-by, steadily": ('rate = "30 rpm"', SpinBy(math.pi)),
    "free-axle": ('inertia = "20 g*m^2"', FreeAxle(0.02)),
    "free-axle, driven": (
        'inertia = 0.02\nrate = "1 rad/s"\nmotor_torque = "0.1*t"\n'
        'bearing_drag = "2 mN*m*s"\nbearing_torque = "3 mN*m"\nbelow = 0.1',
        FreeAxle(0.02, 1.0, "0.1*t", 0.002, 0.003, 0.1),
    ),
    "tilt": ('angle = "0.1*t"', Tilt("0.1*t")),
    "tilt, of a number": ('angle = "3 deg"\naxis = [1, 0, 0]', Tilt("3 deg", (1.0, 0.0, 0.0))),
    "rock": (
        'amplitude = "3 deg"\nrate = 2\nphase = "90 deg"\naxis = [1, 1, 0]',
        Rock("3 deg", 2.0, "90 deg", (1, 1, 0)),
    ),
    "precessing-tilt": ('angle = "2 deg"\nrate = "1 turn/s"', PrecessingTilt("2 deg", "1 turn/s")),
    "shake": ('amplitude = ["2 mm", 0, 0]\nrate = "30 rad/s"', Shake((0.002, 0.0, 0.0), 30.0)),
    "move": ('position = ["0.1*t**2", "1 cm", 0]', Move(("0.1*t**2", 0.01, 0.0))),
    "combined": (
        'parts = [{kind = "shake", amplitude = ["2 mm", 0, 0], rate = 30}, {kind = "wobble", rate = 3, angle = 0.1}]',
        Combined((Shake((0.002, 0.0, 0.0), 30.0), Wobble(3.0, 0.1))),
    ),
}
READ_LOADS: dict[str, tuple[str, Load]] = {
    "quadratic-drag": ('coefficient = "1 g/m"', QuadraticDrag(0.001)),
    "quadratic-drag, in turning air": ('coefficient = 0.001\nair = "2 rad/s"', QuadraticDrag(0.001, 2.0)),
    "drag, in turning air": ('coefficient = "1 g/s"\nair = "-2 rad/s"', Drag(0.001, -2.0)),
    "potential": ('formula = "1.5*(x**2 + y**2)"', Potential("1.5*(x**2 + y**2)")),
    "rolling-resistance": ('offset = "0.05 mm"', RollingResistance(5e-5)),
    "pivot-friction": ('offset = "20 um"\nbelow = "0.1 rad/s"', PivotFriction(2e-5, 0.1)),
    "rolling-couple": ('coefficient = "2e-6 N*m*s"', RollingCouple(2e-6)),
    "rolling-couple, pivoting easily": ("coefficient = 2e-6\npivot_coefficient = 0", RollingCouple(2e-6, 0.0)),
    "magnus": ('coefficient = "0.1 g"', Magnus(1e-4)),
    "motor": ('value = ["1 mN*m", "0.002*sin(t)", 0]', Motor((0.001, "0.002*sin(t)", 0.0))),
}


def read(motion: str = "", load: str = "") -> ScenarioFile:
    """Return a scenario with a motion, or a load, by its table."""
    motions = f"[support.motion]\n{motion}\n" if motion else ""
    return ScenarioFile.loads(f"{HEAD}{motions}" + (f"[[loads]]\n{load}\n" if load else ""))


def table(name: str, keys: str) -> str:
    """Return the lines of a table."""
    return f'kind = "{name.partition(",")[0]}"\n{keys}'


@pytest.mark.parametrize("name", READ_MOTIONS)
def test_a_motion_reads_as_its_class_and_is_written_back(name: str) -> None:
    keys, wanted = READ_MOTIONS[name]
    scenario = read(motion=table(name, keys))
    assert scenario.support.build().motion == wanted
    words = words_of(wanted, "support.motion")
    again = ScenarioFile.read(
        {**scenario.model_dump(exclude_unset=True, by_alias=True), "support": {"kind": "plane", "motion": words}}
    )
    assert again.support.build().motion == wanted
    assert ScenarioFile.loads(again.to_toml()).support.build().motion == wanted
    assert ScenarioFile.loads(scenario.to_toml()) == scenario


@pytest.mark.parametrize("name", READ_LOADS)
def test_a_load_reads_as_its_class_and_is_written_back(name: str) -> None:
    keys, wanted = READ_LOADS[name]
    scenario = read(load=table(name, keys))
    assert scenario.system().loads == (wanted,)
    words = words_of(wanted, "loads[0]")
    again = ScenarioFile.read({**scenario.model_dump(exclude_unset=True, by_alias=True), "loads": [words]})
    assert again.system().loads == (wanted,)
    assert ScenarioFile.loads(scenario.to_toml()) == scenario


def test_every_kind_has_words_and_is_tested() -> None:
    described = {name.partition(",")[0] for name in READ_MOTIONS} | {"fixed", "spin", "uneven-spin", "wobble"}
    assert described == set(KINDS["support.motion"])
    assert {name.partition(",")[0] for name in READ_LOADS} | {"force", "torque"} == set(KINDS["loads"])


def test_several_parts_may_be_tables_of_their_own() -> None:
    lines = (
        'kind = "combined"\n[[support.motion.parts]]\nkind = "fixed"\n[[support.motion.parts]]\nkind = "spin"\nrate = 2'
    )
    assert read(motion=lines).support.build().motion == Combined((Fixed(), Spin(2.0)))


def test_air_turns_with_a_support_that_is_combined() -> None:
    motion = (
        'kind = "combined"\nparts = [{kind = "shake", amplitude = [0, 0, 0.001], rate = 9}, {kind = "spin", rate = 2}]'
    )
    assert read(motion, 'kind = "quadratic-drag"\ncoefficient = 0.001\nair = "turning"').system().loads[0].air == 2.0


@pytest.mark.parametrize(
    ("motion", "key", "said"),
    [
        ('kind = "spin-by"\nrate = "3*x"', "support.motion.rate", "unknown unit"),
        ('kind = "spin-by"\nrate = "sin(t"', "support.motion.rate", ""),
        ('kind = "spin-by"\nrate = "t**0.5"', "support.motion.rate", "whole number"),
        ('kind = "spin-by"', "support.motion.rate", "3.5*(1 - exp(-t/2))"),
        ('kind = "free-axle"\ninertia = 0', "support.motion.inertia", "positive"),
        ('kind = "free-axle"\ninertia = 1\nbearing_drag = "-1 N*m*s"', "support.motion.bearing_drag", "negative"),
        ('kind = "free-axle"\ninertia = 1\nbearing_drag = "1 N*m"', "support.motion.bearing_drag", "N*m*s"),
        ('kind = "rock"\namplitude = 0.1\nrate = 1\naxis = [0, 0, 0]', "support.motion.axis", "direction"),
        ('kind = "rock"\namplitude = 0.1\nrate = 1\naxis = [0, 1]', "support.motion.axis", "list of 3"),
        ('kind = "shake"\namplitude = 0.1\nrate = 1', "support.motion.amplitude", "list of 3"),
        ('kind = "move"\nposition = ["t", 0, "2 kg"]', "support.motion.position[2]", "length"),
        ('kind = "combined"', "support.motion.parts", '[[support.motion.parts]] kind = "spin"'),
        ('kind = "spin-by"\nrate = "1/t"', "support.motion.rate", "not at t = 0 s"),
        ('kind = "combined"\nparts = []', "support.motion.parts", "at least one"),
        (
            'kind = "combined"\nparts = [{kind = "spin", rate = 1}, {kind = "spinn"}]',
            "support.motion.parts[1].kind",
            "'spin'",
        ),
        ('kind = "combined"\nparts = [{kind = "spin", rat = 1}]', "support.motion.parts[0].rat", "'rate'"),
        ('kind = "combined"\nparts = [{kind = "combined", parts = []}]', "support.motion.parts[0].kind", ""),
        (
            'kind = "combined"\nparts = [{kind = "spin", rate = 1}, {kind = "free-axle", inertia = 1}]',
            "support.motion.parts[0]",
            "turn a free axle",
        ),
    ],
)
def test_what_is_wrong_with_a_motion_is_named(motion: str, key: str, said: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        read(motion=motion)
    assert caught.value.key == key
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("load", "key", "said"),
    [
        ('kind = "potential"\nformula = "x*w"', "loads[0].formula", "x, y, z, t"),
        ('kind = "potential"\nformula = 3', "loads[0].formula", "formula"),
        ('kind = "rolling-resistance"\noffset = "-1 mm"', "loads[0].offset", "negative"),
        ('kind = "rolling-resistance"\noffset = "1 N"', "loads[0].offset", "length"),
        ('kind = "rolling-resistance"\ncoefficient = 0.01', "loads[0].coefficient", "offset"),
        ('kind = "pivot-friction"\noffset = 0\nbelow = 0', "loads[0].below", "positive"),
        ('kind = "quadratic-drag"\ncoefficient = "1 g/s"', "loads[0].coefficient", "kg/m"),
        ('kind = "motor"\nvalue = [0, 0]', "loads[0].value", "list of 3"),
    ],
)
def test_what_is_wrong_with_a_load_is_named(load: str, key: str, said: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        read(load=load)
    assert caught.value.key == key
    assert said in str(caught.value)


def test_editors_know_every_kind() -> None:
    schema: Any = ScenarioFile.schema()
    text = str(schema)
    for kind in (*KINDS["support.motion"], *KINDS["loads"]):
        assert f"'{kind}'" in text
