"""Machine code is what Python's arithmetic is, to the last bit; and where there is no compiler, runs are the same."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.mechanics.scalars import namespace
from trundle.solve import machine_code as module
from trundle.solve import tracing
from trundle.solve.laws import RollingLaw
from trundle.solve.machine_code import IN_HASTE, WITH_CARE, machine_code
from trundle.solve.tape import Tape

pytest.importorskip("llvmlite")

NUMBERS = [0.0, -0.0, 1.0, -2.5, 0.1, 1e-300, 1e300, 5e-324, math.pi, -math.pi / 2, 7e15, -1e-8]
TWO = [
    lambda a, b: a + b,
    lambda a, b: a - b,
    lambda a, b: a * b,
    lambda a, b: a / b,
    lambda a, b: namespace(a, b).atan2(a, b),
    lambda a, b: namespace(a, b).hypot(a, b),
    lambda a, b: namespace(a, b).where(a < b, a, b),
    lambda a, b: namespace(a, b).where(a > b, b, 3.0),
    lambda a, b: namespace(a, b).where(True, a, b),
    lambda a, b: namespace(a, b).where(False, a, b),
]
ONE = [
    lambda a: -a,
    abs,
    lambda a: a**3,
    lambda a: a**-2,
    *(
        lambda a, name=name: getattr(namespace(a), name)(a)
        for name in ("sqrt", "sin", "cos", "tan", "exp", "expm1", "log")
    ),
]


def alike(one: list[float], other: list[float]) -> bool:
    """Tell whether numbers are the same to the last bit, also the sign of a zero; one that is none is like another."""
    pairs = list(zip(one, other, strict=True))
    return all(math.isnan(a) == math.isnan(b) for a, b in pairs) and all(
        a == b and math.copysign(1, a) == math.copysign(1, b) for a, b in pairs if not math.isnan(a)
    )


@pytest.mark.parametrize("level", [IN_HASTE, WITH_CARE])
@pytest.mark.parametrize("seed", range(12))
def test_any_operations_on_any_numbers(seed: int, level: int) -> None:
    """Random chains of operations: each operand is an earlier result, an input or a number."""
    chosen, tape = np.random.default_rng(seed), Tape()
    known: list[Any] = [*tape.inputs(4), 0.1, -3.0]
    for _ in range(60):
        operation = (ONE + TWO)[chosen.integers(len(ONE + TWO))]
        operands = [known[i] for i in chosen.integers(len(known), size=1 if operation in ONE else 2)]
        if any(not isinstance(one, float) for one in operands):
            known.append(operation(*operands))
    outputs = known[6:]
    code, text, told = machine_code(tape, outputs, level), [tape.function([one]) for one in outputs], 0
    for _ in range(40):
        x = [float(chosen.choice(NUMBERS)) if chosen.random() < 0.5 else chosen.normal(0, 2) for _ in range(4)]
        found = code(x)
        for value, one in zip(found, text, strict=True):
            try:
                (wanted,) = one(x)
            except (ArithmeticError, ValueError):
                continue
            told += 1
            assert alike([value], [wanted]), (value, wanted)
    assert told > 400


@pytest.mark.parametrize(
    ("of", "x", "found"),
    [
        (lambda a: 1.0 / a, 0.0, math.inf),
        (lambda a: -1.0 / a, 0.0, -math.inf),
        (lambda a: namespace(a).sqrt(a), -1.0, math.nan),
        (lambda a: namespace(a).log(a), 0.0, -math.inf),
        (lambda a: namespace(a).exp(a), 1e4, math.inf),
        (lambda a: namespace(a).where(a < 1.0, a, 2.0), math.nan, 2.0),
        (lambda a: namespace(a).sin(a), math.inf, math.nan),
    ],
)
def test_what_python_refuses_is_no_number(of: Any, x: float, found: float) -> None:
    tape = Tape()
    (a,) = tape.inputs(1)
    assert alike(machine_code(tape, [of(a)])([x]), [found])


def test_outputs_may_be_numbers_and_inputs() -> None:
    tape = Tape()
    x, y = tape.inputs(2)
    assert machine_code(tape, [2.5, y, x, y])([1.0, -0.0]) == [2.5, -0.0, 1.0, -0.0]


BODIES = {
    "egg": tr.Body.ellipsoid((0.03, 0.02, 0.025), 0.1, centre=(0.0, 0.001, 0.002)),
    "torus": tr.Body.torus(0.02, 0.006, 0.05),
    "disc": tr.Body.disc(radius=0.012, mass=0.0075),
}
SURFACES = {
    "bowl": tr.EllipsoidalBowl((0.5, 0.4, 0.3)),
    "formula": tr.HeightField("0.02*sin(9*x)*cos(7*y) + 0.1*(x**2 + y**2)"),
    "table": tr.HeightField.through(
        np.linspace(-0.3, 0.3, 9), np.linspace(-0.3, 0.3, 9), [[x * x + y * y for y in range(9)] for x in range(9)]
    ),
}


@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize("body", BODIES)
def test_a_law_is_the_same_to_the_last_bit(body: str, surface: str, monkeypatch: pytest.MonkeyPatch) -> None:
    support = tr.Support(SURFACES[surface], tilt=0.1, motion=tr.Spin(-2.0))
    system = tr.RollingSystem(BODIES[body], support, loads=[tr.QuadraticDrag(0.01)])
    monkeypatch.setattr(tracing, "_LONG", 0)
    found = []
    for available in (True, False):
        monkeypatch.setattr(tracing, "available", lambda available=available: available)
        tracing._memory.cache_clear()
        law = tracing.python_law(system, RollingLaw(), (0.0, 0.0, 0.0, 0.0))
        state = [0.01, -0.02, 0.003, 0.8, 0.1, -0.5, 0.32, 3.0, -7.0, 11.0]
        found.append([*law.rates(0.3, state), *law.event_functions(0.3, state), *law.corners(0.3, state)])
    tracing._memory.cache_clear()
    assert alike(*found)


def test_a_run_is_the_same_without_a_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    """A ball that grips and slips in a rocking cone, whose law takes ten thousand operations."""
    cone = tr.Support(tr.Cone(0.03), motion=tr.Rock(1.0, -0.1), friction=0.06)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.047, 0.5), cone)
    start = system.place((0.0416, -0.0284), velocity=(1.7, 0.07), spin=0.1)
    runs = []
    for available in (True, False):
        monkeypatch.setattr(tracing, "available", lambda available=available: available)
        tracing._memory.cache_clear()
        runs.append(tr.simulate(system, start, 0.6, 0.05, method="runge-kutta"))
    tracing._memory.cache_clear()
    with_, without = (run.samples for run in runs)
    assert {event.kind for event in runs[0].events} >= {"grip", "slip"}
    assert np.array_equal(with_.position, without.position)
    assert np.array_equal(with_.orientation, without.orientation)


def test_without_the_c_librarys_functions_it_is_pythons(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_LIBRARY", {"no_such_function": 1})
    module.available.cache_clear()
    assert not module.available()
    module.available.cache_clear()
