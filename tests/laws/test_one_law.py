"""The one rolling law gives the same numbers whatever it is traced with: floats, arrays, mpmath, heyoka, SymPy."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest
from tests.additions import Ball, Tumble
from tests.precise import DIGITS
from tests.tolerances import EXACT

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.contact import roll
from trundle.mechanics.parameters import numbers, with_numbers
from trundle.mechanics.shapes import Ellipsoid, Sphere, Torus
from trundle.mechanics.surfaces.over_plane import OverPlane
from trundle.solve.tape import Tape
from trundle.solve.tracing import python_law
from trundle.solve.transitions import at_start

PUSHED = (tr.Force((0.25, -0.5, 0.125)), tr.Torque((0.01, 0.02, -0.03)), tr.Drag(0.3))
TUMBLE = Tumble(1.5, 0.25, -0.75, Vector(0.5, -0.25, 0.125), 2.0)


def system(body: tr.Body, surface: Any, motion: Any) -> tr.RollingSystem:
    return tr.RollingSystem(body, tr.Support(surface, motion=motion, tilt=0.2), loads=PUSHED)


BALL = tr.Body.solid_sphere(radius=0.125, mass=0.75)
EGG = tr.Body(0.75, tr.Principal(0.003, 0.004, 0.005), Ellipsoid(0.15, 0.125, 0.1))
WHEEL = tr.Body(0.75, tr.Principal(0.003, 0.003, 0.005), Torus(0.1, 0.02))
WEIGHTED = tr.Body(0.75, tr.Isotropic(0.004), Sphere(0.125, Vector(0.01, -0.02, 0.03)))
SYSTEMS = {
    "ball on a turntable": system(BALL, tr.Plane(), tr.Spin(3.5)),
    "ball on a slope": system(BALL, tr.Plane(rim=2.0), tr.Fixed()),
    "ellipsoid on a tumbling ball": system(EGG, Ball(0.5, 1.0), TUMBLE),
    "torus in a tumbling bowl": system(WHEEL, Ball(0.8, -1.0), TUMBLE),
    "weighted ball in a spinning pipe": system(WEIGHTED, tr.Cylinder(0.5), tr.Spin(-2.0)),
    "cylinder on an unevenly turning log": system(
        tr.Body.cylinder(0.1, 0.75), tr.Cylinder(0.5, "outside"), tr.UnevenSpin(1.5, 0.2, 2.0)
    ),
    "ball on a wobbling table, pushed to and fro": tr.RollingSystem(
        BALL, tr.Support(tr.Plane(), motion=tr.Wobble(3.5, 0.1)), loads=(tr.Force(("0.2*sin(3*t)", 0.1, "t**2")),)
    ),
}
NAMES = ["t", *(f"p{i}" for i in range(3)), *(f"q{i}" for i in range(4)), *(f"Omega{i}" for i in range(3))]
COUNT = 6


def rates(of: tr.RollingSystem, state: Any) -> list[Any]:
    """Return V, ṗ, q̇, Ω̇ and R from t, p, q and Ω."""
    t, *rest = state
    now = roll(of, t, Vector(*rest[:3]), Quaternion(*rest[3:7]), Vector(*rest[7:]))
    return [*now.velocity, *now.point_rate, *now.orientation_rate, *now.angular_acceleration, *now.reaction]


PARTS = {
    "V": slice(0, 3),
    "p rate": slice(3, 6),
    "q rate": slice(6, 10),
    "Omega rate": slice(10, 13),
    "R": slice(13, 16),
}


@pytest.fixture(scope="module")
def states() -> Any:
    """Return states (COUNT, 11) with p off the axis; the law can be evaluated wherever the normal is defined."""
    draw = np.random.default_rng(seed=1)
    q = draw.normal(size=(COUNT, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    p = draw.uniform(0.3, 0.7, size=(COUNT, 3))
    return np.hstack([draw.uniform(0.1, 2.0, (COUNT, 1)), p, q, draw.normal(size=(COUNT, 3))])


@pytest.fixture(params=SYSTEMS, scope="module")
def traced(request: pytest.FixtureRequest) -> tr.RollingSystem:
    return SYSTEMS[request.param]


@pytest.fixture(scope="module")
def reference(traced: tr.RollingSystem, states: Any) -> Any:
    """Return the rates (COUNT, 16) rounded from `DIGITS` digits, the system's own numbers included."""
    with mpmath.workdps(DIGITS):
        precise = with_numbers(traced, [mpmath.mpf(x) for x in numbers(traced)])
        return np.array([[float(x) for x in rates(precise, [mpmath.mpf(float(x)) for x in s])] for s in states])


def same(found: Any, reference: Any) -> None:
    """Compare by parts: rounding in a vector is measured by its largest component."""
    assert found.shape == reference.shape
    for name, part in PARTS.items():
        size = np.abs(reference[:, part]).max()
        off = np.abs(found[:, part] - reference[:, part]).max()
        assert off <= EXACT(100, size), f"{name}: off by {off / EXACT(1, size):.3g} ulps"


def test_floats(traced: tr.RollingSystem, states: Any, reference: Any) -> None:
    same(np.array([[float(x) for x in rates(traced, s.tolist())] for s in states]), reference)


def test_a_batch_of_arrays_is_one_call(traced: tr.RollingSystem, states: Any, reference: Any) -> None:
    same(np.stack(np.broadcast_arrays(*rates(traced, states.T)), axis=1), reference)


def test_a_batch_of_systems_is_one_call(traced: tr.RollingSystem, states: Any) -> None:
    # Every number of the system an array too: each member differs from the next by a tenth.
    growth = 1 + 0.1 * np.arange(COUNT)
    members = with_numbers(traced, [np.asarray(x) * growth for x in numbers(traced)])
    together = np.stack(np.broadcast_arrays(*rates(members, states.T)), axis=1)
    for i, (state, factor) in enumerate(zip(states, growth, strict=True)):
        one = with_numbers(traced, [x * float(factor) for x in numbers(traced)])
        same(together[i : i + 1], np.array([rates(one, state.tolist())], dtype=float))


def test_heyoka_expressions_compiled(traced: tr.RollingSystem, states: Any, reference: Any) -> None:
    heyoka = pytest.importorskip("heyoka")
    symbolic = with_numbers(traced, [heyoka.par[i] for i in range(len(numbers(traced)))])
    variables = heyoka.make_vars(*NAMES)
    law = [heyoka.expression(x) if isinstance(x, float) else x for x in rates(symbolic, variables)]
    compiled = heyoka.cfunc(law, list(variables), compact_mode=True)
    pars = np.repeat(np.array(numbers(traced))[:, None], COUNT, axis=1)
    same(np.asarray(compiled(np.ascontiguousarray(states.T), pars=pars)).T, reference)


def test_sympy_symbols(traced: tr.RollingSystem, states: Any, reference: Any) -> None:
    import sympy

    variables = sympy.symbols(NAMES, real=True)
    parameters = sympy.symbols(f"par0:{len(numbers(traced))}", real=True)
    law = rates(with_numbers(traced, parameters), variables)
    with mpmath.workdps(DIGITS):
        values = [dict(zip(parameters, map(mpmath.mpf, numbers(traced)), strict=True)) for _ in states]
        for known, state in zip(values, states, strict=True):
            known.update(zip(variables, map(mpmath.mpf, state.tolist()), strict=True))
        found = [[float(_value(sympy.sympify(part), known)) for part in law] for known in values]
    same(np.array(found), reference)


def _value(expression: Any, known: dict[Any, Any]) -> Any:
    """Evaluate a SymPy expression, each part of it once however often it occurs."""
    if expression not in known:
        operations = {
            "Add": lambda *terms: mpmath.fsum(terms),
            "Mul": lambda *factors: mpmath.fprod(factors),
            "Pow": lambda base, exponent: base**exponent,
            "sin": mpmath.sin,
            "cos": mpmath.cos,
        }
        if expression.is_Number:
            known[expression] = (
                mpmath.mpf(expression.p) / expression.q if expression.is_Rational else mpmath.mpf(float(expression))
            )
        else:
            parts = [_value(part, known) for part in expression.args]
            known[expression] = operations[expression.func.__name__](*parts)
    return known[expression]


@pytest.mark.parametrize("power", [-3, -1.5, -0.5, 0, 0.5, 1.5, 2, 2.5, 7, 0.3, -1.7])
def test_a_power_that_is_recorded_is_the_power(power: float) -> None:
    tape = Tape()
    (x,) = tape.inputs(1)
    recorded = tape.function([x**power])
    for value in (0.25, 1.0, 1.7, 30.0):
        assert recorded([value])[0] == pytest.approx(value**power, rel=1e-14)
    assert tape.function([x ** np.float64(power), x ** np.int64(3)])([1.7]) == [recorded([1.7])[0], 1.7 * 1.7 * 1.7]
    with pytest.raises(TypeError):
        x**x


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_a_surface_of_ones_own_may_take_any_power(method: str) -> None:
    """A ball dropped from rest in z = r^1.5 has the speed that its fall gives it, whoever recorded the height."""

    class Cusp(OverPlane):
        axisymmetric = True

        def height(self, x: Any, y: Any) -> Any:
            return (x * x + y * y + 0.01) ** 0.75

    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(Cusp()))
    start = system.place((0.2, 0.1))
    run = tr.simulate(system, start, 0.4, 0.05, method=method)
    at = run.samples
    energy = 0.5 * 0.1 * (at.velocity**2).sum(axis=1) + 0.5 * 4e-5 * 0.4 * (at.angular_velocity**2).sum(axis=1)
    fallen = 0.1 * 9.80665 * (at.position[0, 2] - at.position[:, 2])
    np.testing.assert_allclose(energy, fallen, rtol=1e-9, atol=1e-13)
    assert run.card().passed


@pytest.mark.parametrize("phase", ["rolls", "slips", "flies"])
def test_what_ends_a_stretch_is_that_of_the_unit_quaternion(phase: str) -> None:
    """Steps leave |q| off 1; of samples it is 1, and where N is 0 for one it is so for the other."""
    motion = tr.Support(tr.Bowl(0.8), friction=0.2, motion=tr.Wobble(3.5, 0.1))
    system = tr.RollingSystem(EGG, motion, loads=PUSHED)
    given: Any = {"velocity": (0.3, 0.1)} if phase == "rolls" else {"angular_velocity": (3.0, -1.0, 2.0)}
    start = system.place(
        (0.05, 0.02), **given | ({"height": 0.1} if phase == "flies" else {}), attitude=(0.3, 0.5, 0.2)
    )
    now = at_start(system, start)
    law = python_law(system, now.law, now.event_parameters, now.time, now.state_vector)
    y = np.array(now.state_vector)
    wanted = np.array(law.event_functions(now.time, y.tolist()))
    y[3:7] *= 1.01
    np.testing.assert_allclose(law.event_functions(now.time, y.tolist()), wanted, rtol=1e-11, atol=1e-12)
