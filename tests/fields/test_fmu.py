"""The law as a unit of FMI 3.0, run by FMPy, moves as a run does, and ends where the phase ends."""

from __future__ import annotations

import io
import subprocess
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.fields import compiler as compilers
from trundle.fields.compiler import compiler
from trundle.fields.fmi import archive, fmu
from trundle.fields.printers.c import FLAGS

fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed")
WITH_C = pytest.mark.skipif(compiler() is None, reason="no C compiler is found here")
KINDS = ("CoSimulation", "ModelExchange")


def made(folder: Path, name: str) -> tuple[str, tr.RollingSystem, tr.State]:
    """Write the unit of a shipped scenario."""
    scenario = tr.Scenario.load(name)
    system, start = scenario.system(), scenario.start_state()
    target = folder / f"{name}.fmu"
    target.write_bytes(fmu(system, start, scenario.title)[0])
    return str(target), system, start


def ran(unit: str, kind: str, stop: float, **options: Any) -> Any:
    """Run a unit as its importers do."""
    given = {"output_interval": 0.05, "relative_tolerance": 1e-9} | options
    return fmpy.simulate_fmu(unit, fmi_type=kind, stop_time=stop, **given)


@pytest.mark.parametrize("name", ["tilted-turntable", "rattleback", "turntable-drop"])
def test_it_is_a_valid_unit(name: str, tmp_path: Path) -> None:
    from fmpy.validation import validate_fmu

    unit, system, _ = made(tmp_path, name)
    assert validate_fmu(unit) == []
    told = fmpy.read_model_description(unit)
    field = system.vector_field()
    tunable = [each.name for each in told.modelVariables if each.variability == "tunable"]
    assert tunable == list(field.parameter_names)
    assert told.modelExchange is not None
    assert told.coSimulation is not None
    assert "the simulation ends where another begins" in told.description


@WITH_C
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["tilted-turntable", "free-turntable-ellipse", "incline-with-slip"])
def test_it_moves_as_a_run_does(name: str, kind: str, tmp_path: Path) -> None:
    unit, system, start = made(tmp_path, name)
    run = tr.simulate(system, start, duration=1.5, every=0.05)
    found = ran(unit, kind, 1.5)
    bound = 1e-9 if kind == "CoSimulation" else 1e-6  # by our method at the tolerance asked for; by that of FMPy
    assert found["time"].size == run.data.time.size
    for i, axis in enumerate("xyz"):
        for quantity in ("position", "velocity", "contact_force"):
            known = run.data[quantity].values[:, i]
            size = max(1e-3, np.abs(run.data[quantity].values).max())
            assert np.abs(found[f"{quantity}_{axis}"] - known).max() <= bound * size, (quantity, axis)


@WITH_C
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["off-the-rim", "roll-off-a-sphere", "billiard-swerve"])
def test_it_ends_where_the_phase_ends(name: str, kind: str, tmp_path: Path) -> None:
    unit, system, start = made(tmp_path, name)
    event = tr.simulate(system, start, duration=4.0, every=0.1).events[0]
    told: list[str] = []
    ran(unit, kind, 4.0, debug_logging=True, logger=lambda _e, _s, _c, text: told.append(text.decode()))
    (text,) = (text for text in told if "The phase ends" in text)
    _, _, when = text.partition("t = ")
    assert f"'{event.kind}'" in text
    assert float(when.split()[0]) == pytest.approx(event.time, abs=1e-7)


@WITH_C
@pytest.mark.parametrize("early", [True, False])
def test_the_last_step_of_a_phase_ends_at_its_event(early: bool, tmp_path: Path) -> None:
    """An importer that lets a step end early has the last sample at the event itself, and else at the step's end."""
    unit, system, start = made(tmp_path, "off-the-rim")
    event = tr.simulate(system, start, duration=4.0, every=0.1).events[0]
    there = tr.simulate(system, start, duration=event.time, every=event.time / 4).data.position.values[-1]
    found = ran(unit, "CoSimulation", 4.0, early_return_allowed=early)
    before, last = found["time"][-2:]
    assert before < event.time < 4.0
    if early:
        assert last == pytest.approx(event.time, abs=1e-9)
    else:
        assert event.time < last < before + 0.1
    for known, axis in zip(there, "xyz", strict=True):
        assert found[f"position_{axis}"][-1] == pytest.approx(known, abs=1e-8)


@WITH_C
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("name", "until"), [("bouncing-ball-with-backspin", 2.0), ("tippe-top", 1.0)])
def test_it_goes_on_where_the_same_phase_follows(name: str, until: float, kind: str, tmp_path: Path) -> None:
    """A ball that bounces flies on; slip that has turned by a quarter is slip."""
    unit, system, start = made(tmp_path, name)
    run = tr.simulate(system, start, duration=until, every=until / 4)
    found = ran(unit, kind, until, output_interval=until / 40, relative_tolerance=1e-10)
    for i, axis in enumerate("xyz"):
        for time, known in zip(run.data.time.values, run.data.position.values[:, i], strict=True):
            assert found[f"position_{axis}"][np.isclose(found["time"], time)][-1] == pytest.approx(known, abs=1e-6)


@WITH_C
@pytest.mark.parametrize("kind", KINDS)
def test_a_bad_value_is_refused_in_words(kind: str, tmp_path: Path) -> None:
    unit, *_ = made(tmp_path, "tilted-turntable")
    for name, value, words in (
        ("body.radius", -1.0, "body.radius must be positive; got -1."),
        ("support.restitution", -0.5, "support.restitution must not be negative; got -0.5."),
        ("body.mass", float("nan"), "body.mass must be a finite number; got nan."),
        ("p_x", float("inf"), "A value must be a finite number; got inf."),
    ):
        told: list[str] = []
        log = {"debug_logging": True, "logger": lambda *said, told=told: told.append(said[-1].decode())}
        with pytest.raises(Exception, match="fmi3SetFloat64 failed"):
            ran(unit, kind, 1.0, start_values={name: value}, **log)
        assert told == [words]


@WITH_C
@pytest.mark.parametrize("kind", KINDS)
def test_parameters_and_inputs_are_those_of_the_law(kind: str, tmp_path: Path) -> None:
    """On a level floor a solid ball gains x = (5/14) (F/m) t² from a force; on a slope, of g sin α."""
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane()))
    target = tmp_path / "ball.fmu"
    target.write_bytes(fmu(system, system.place(), "A ball")[0])
    for name, value, push in (("force_x", 0.05, 0.5), ("support.tilt", 0.1, 9.80665 * np.sin(0.1))):
        found = ran(str(target), kind, 1.0, start_values={name: value})
        assert found["position_x"][-1] == pytest.approx(5 / 14 * push, rel=1e-7)


@WITH_C
def test_the_sources_compile_without_a_warning(tmp_path: Path) -> None:
    unit, *_ = made(tmp_path, "real-demonstration")
    with zipfile.ZipFile(unit) as held:
        held.extractall(tmp_path)
    strict = ("-Wall", "-Wextra", "-Werror", "-Wno-unused-parameter", "-fPIC", "-shared")
    sources = sorted((tmp_path / "sources").glob("*.c"))
    command = [str(compiler()), *FLAGS, *strict, *map(str, sources), "-o", str(tmp_path / "x.so"), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
    assert done.returncode == 0, done.stderr


def test_without_a_compiler_there_are_the_sources(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(archive, "compiler", lambda: None)
    level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    content, where = fmu(level, level.place(), "A ball")
    names = zipfile.ZipFile(io.BytesIO(content)).namelist()
    assert where == ""
    assert "sources/fmi3.c" in names
    assert not any(name.startswith("binaries") for name in names)
    assert compilers.compiler is compiler


def test_the_same_unit_is_the_same_file() -> None:
    level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    assert fmu(level, level.place(), "A ball") == fmu(level, level.place(), "A ball")
