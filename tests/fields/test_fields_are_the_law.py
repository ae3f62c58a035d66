"""What is printed is the law: for every shipped scenario, in every phase, in each language."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy
from tests.fields.systems import DYNAMIC, FEW, arguments, node, shipped
from tests.tolerances import EXACT

import trundle as tr
from trundle.errors import OutOfDomainError
from trundle.fields.compiler import compiler
from trundle.fields.fmi.archive import beginning
from trundle.fields.printers.c import FLAGS
from trundle.solve.laws import Law, RollingLaw

ROUTINES = ("rates", "events", "outputs")
WITH_C = pytest.mark.skipif(compiler() is None, reason="no C compiler is found here")


@pytest.mark.parametrize("name", DYNAMIC)
def test_rolling_is_the_float_law(name: str) -> None:
    field, (t, y, p, u) = shipped(name, "numpy", "slipping" if name == "tippe-top" else "rolling")
    law: Law = field._routines.law
    reference = np.array([float(rate) for rate in law.rates(field.system, t, y.tolist())])
    found = field.rates(t, y, p, u)
    assert np.abs(found - reference).max() <= EXACT(512, np.abs(reference).max())
    if field.event_parameters is None:
        events = law.event_functions(field.system, t, y.tolist(), ())
        assert field.event_names == tuple(events)
        reference = np.array([float(event) for event in events.values()])
        assert np.abs(field.events(t, y, p, u) - reference).max(initial=0.0) <= EXACT(2048, np.abs(reference).max())


@pytest.mark.parametrize("name", FEW)
def test_the_outputs_are_those_of_a_run(name: str) -> None:
    scenario = tr.Scenario.load(name)
    system, start = scenario.system(), scenario.start_state()
    run = tr.simulate(system, start, duration=0.2, every=0.1)
    from trundle.verify.energy import energy

    for i, code in enumerate(run.data.phase.values.tolist()):
        phase = {0: "rolling", 1: "slipping", 2: "flight", 3: "rest"}[code]
        field, state = system.vector_field("numpy", phase), run.samples.state(i)
        given = (state.time, field.pack(state), field.parameters, field.inputs)
        found = dict(zip(field.output_names, field.outputs(*given), strict=True))
        for quantity in ("position", "velocity", "contact_force"):
            vector = [found[f"{quantity}_{axis}"] for axis in "xyz"]
            known = run.data[quantity].values[i]
            assert np.abs(np.array(vector) - known).max() <= 1e-10 * max(1.0, np.abs(known).max())
        known = float(energy(system, run.samples)[i])
        assert abs(found["energy"] - known) <= 1e-10 * max(abs(known), 1e-3)


@WITH_C
@pytest.mark.parametrize("name", DYNAMIC)
def test_c_is_the_floats_bit_for_bit(name: str) -> None:
    phases = tr.Scenario.load(name).system().vector_field().phases
    for phase in phases if name in FEW else phases[:1]:
        floats, given = shipped(name, "numpy", phase)
        for routine in ROUTINES if name in FEW else ROUTINES[:1]:
            these = arguments(floats, given, routine)
            compiled = getattr(floats.system.vector_field("c", phase), routine)(*these)
            assert np.array_equal(compiled, getattr(floats, routine)(*these))


@pytest.mark.parametrize("name", FEW)
def test_numba_is_the_floats(name: str) -> None:
    for phase in tr.Scenario.load(name).system().vector_field().phases[:2]:
        floats, given = shipped(name, "numpy", phase)
        compiled = floats.system.vector_field("numba", phase).rates(*given)
        reference = floats.rates(*given)
        assert np.abs(compiled - reference).max() <= EXACT(256, np.abs(reference).max())


@pytest.mark.parametrize("name", FEW)
def test_arrays_of_states_are_many_states(name: str) -> None:
    field, (t, y, p, u) = shipped(name, "numpy")
    many = y + 0.01 * np.random.default_rng(1).normal(size=(3, 2, y.size))
    found = field.rates(t, many, p, u)
    assert found.shape == many.shape
    reference = np.array([[field.rates(t, one, p, u) for one in row] for row in many])
    assert np.abs(found - reference).max() <= EXACT(512, np.abs(reference).max())


@pytest.mark.parametrize("name", FEW[:2])
def test_symbols_are_the_law(name: str) -> None:
    field, given = shipped(name, "sympy")
    reference = shipped(name, "numpy")[0].rates(*given)
    t, y, p, u = given
    assert np.abs(np.array(field.rates(t, list(y), list(p), list(u)), dtype=float) - reference).max() <= EXACT(
        512, np.abs(reference).max()
    )
    plain = field.system.vector_field("sympy", inputs=())
    definitions, rates = plain.equations(shared=True)
    values = dict(zip([*plain.symbols[1], *plain.symbols[2]], [*y, *p], strict=True))
    values[plain.symbols[0]] = t
    for symbol, what in definitions:
        values[symbol] = what.xreplace(values)
    found = np.array([float(sympy.N(rate.xreplace(values))) for rate in rates])
    assert np.abs(found - reference).max() <= EXACT(512, np.abs(reference).max())


def test_the_turntable_reads_as_in_a_paper() -> None:
    field = tr.Scenario.load("tilted-turntable").system().vector_field("sympy", inputs=())
    a, k, g, alpha, omega = sympy.symbols("radius ratio gravity tilt rate", real=True)
    px, Omega_x = sympy.symbols("p_x Omega_x", real=True)
    # a (1 + k) Ω̇ = ω u × n + g sin α along the second axis, u the velocity of the ball: T5 differentiated
    wanted = (g * sympy.sin(alpha) + omega * (omega * px - a * Omega_x)) / (a * (1 + k))
    rate = field.equations()[1][field.state_names.index("Omega_y")]
    assert sympy.simplify(rate - wanted) == 0
    assert sympy.count_ops(rate) <= 16
    assert r"\dot{\Omega}_{y} &=" in field.latex()


def test_javascript_is_the_law(tmp_path: Path) -> None:
    lines, asked = [], []
    for i, name in enumerate(FEW):
        floats, given = shipped(name, "numpy")
        (tmp_path / f"field{i}.mjs").write_text(floats.system.vector_field("javascript").source())
        lines.append(f'import * as f{i} from "./field{i}.mjs";')
        for routine in ROUTINES:
            these = arguments(floats, given, routine)
            told = json.dumps([part if isinstance(part, float) else part.tolist() for part in these])
            asked.append((f"f{i}.rolling_{routine}(...{told})", getattr(floats, routine)(*these)))
    lines.append(f"console.log(JSON.stringify([{', '.join(call for call, _ in asked)}]));")
    (tmp_path / "main.mjs").write_text("\n".join(lines))
    done = subprocess.run([node(), "main.mjs"], cwd=tmp_path, capture_output=True, text=True, check=True)  # noqa: S603
    for found, (_, reference) in zip(json.loads(done.stdout), asked, strict=True):
        assert np.abs(np.array(found) - reference).max(initial=0) <= 1e-13 * np.abs(reference).max(initial=1.0)


@WITH_C
def test_the_file_of_c_stands_alone(tmp_path: Path) -> None:
    field, (t, y, p, u) = shipped("billiard-swerve", "c")
    (tmp_path / "ball.c").write_text(field.source("ball"))
    (tmp_path / "ball.h").write_text(field.header("ball"))
    numbers = {"y": y, "p": p, "u": u}
    given = "\n".join(f"double {n}[] = {{{', '.join(map(repr, v.tolist()))}}};" for n, v in numbers.items())
    (tmp_path / "main.c").write_text(
        f'#include <stdio.h>\n#include "ball.h"\n{given}\nint main(void) {{ double f[10];\n'
        f" ball_rolling_rates({t}, y, p, u, f);\n"
        ' for (int i = 0; i < 10; i++) printf("%a\\n", f[i]);\n return 0; }\n'
    )
    strict = ("-Wall", "-Wextra", "-Wpedantic", "-Werror")
    command = [str(compiler()), *FLAGS, *strict, "-o", "main", "main.c", "ball.c", "-lm"]
    subprocess.run(command, cwd=tmp_path, check=True)  # noqa: S603
    done = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True)  # noqa: S603
    found = [float.fromhex(line) for line in done.stdout.split()]
    assert found == field.system.vector_field("numpy").rates(t, y, p, u).tolist()


@WITH_C
def test_a_file_of_c_with_loops_has_nothing_unused(tmp_path: Path) -> None:
    """A landing that turns the slip is a loop, of which not all is wanted."""
    (tmp_path / "top.c").write_text(tr.Scenario.load("tippe-top").system().vector_field("c").source("top"))
    strict = ("-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror")
    subprocess.run([str(compiler()), *FLAGS, *strict, "top.c"], cwd=tmp_path, check=True)  # noqa: S603


@pytest.mark.parametrize("name", DYNAMIC)
def test_a_start_has_rates(name: str) -> None:
    """Also where slip begins at once, which has no direction before."""
    scenario = tr.Scenario.load(name)
    field, y = beginning(scenario.system(), scenario.start_state())
    floats = scenario.system().vector_field("numpy", field.phase)
    assert np.isfinite(floats.rates(0.0, y, floats.parameters, floats.inputs)).all()


def test_every_number_has_one_name() -> None:
    units: dict[str, Any] = {}
    for name in DYNAMIC:
        field = tr.Scenario.load(name).system().vector_field()
        assert len(set(field.parameter_names)) == len(field.parameters) == len(field.parameter_units)
        assert len(set(field.input_names)) == len(field.inputs) == len(field.input_units)
        assert len(field.state_names) == len(field.state_units)
        units |= dict(zip(field.parameter_names, field.parameter_units, strict=True))
    known = {
        "body.radius": "m",
        "body.mass": "kg",
        "gravity": "m/s^2",
        "support.tilt": "rad",
        "body.inertia.x": "kg*m^2",
    }
    assert units | known == units
    assert units["support.motion.rate"] == "rad/s"
    assert RollingLaw().names(tr.Scenario.load("free-turntable-ellipse").system())[-2:] == (
        "support_angle",
        "support_rate",
    )


@pytest.mark.parametrize("extra", ["jax", "numba"])
def test_without_its_extra_a_backend_names_it(extra: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trundle.extras.find_spec", lambda _: None)
    field = tr.Scenario.load("tilted-turntable").system().vector_field(extra)
    assert "def rolling_rates" in field.source()  # which needs nothing
    with pytest.raises(tr.MissingExtraError, match=rf"pip install 'trundle\[{extra}\]'"):
        _ = field.rates


def test_a_surface_given_by_a_table_is_refused() -> None:
    r = np.linspace(0.0, 0.3, 7)
    dish = tr.Support(tr.Revolution.through(r.tolist(), (0.5 * r * r).tolist()))
    with pytest.raises(OutOfDomainError, match="cannot be written out as formulas"):
        tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), dish).vector_field("c")
