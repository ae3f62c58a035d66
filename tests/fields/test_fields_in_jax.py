"""The law in JAX: compiled, mapped and differentiated, in both precisions."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest
from tests.fields.systems import DYNAMIC, FEW, shipped
from tests.precise import DIGITS
from tests.tolerances import EXACT

import trundle as tr
from trundle.fields.inputs import with_inputs
from trundle.mechanics.parameters import with_numbers
from trundle.solve.laws import RollingLaw

jax = pytest.importorskip("jax", reason="the extra jax is not installed")


@pytest.mark.parametrize("name", FEW)
def test_compiled_and_mapped_it_is_the_law(name: str) -> None:
    field, (t, y, p, u) = shipped(name, "jax")
    plain = field.system.vector_field("numpy")
    many = y + 0.01 * np.random.default_rng(2).normal(size=(5, y.size))
    found = jax.jit(jax.vmap(field.rates, (None, 0, None, None)))(t, many, p, u)
    reference = plain.rates(t, many, p, u)
    assert np.abs(found - reference).max() <= EXACT(1024, np.abs(reference).max())


@pytest.mark.parametrize("name", FEW)
def test_single_precision_stays_single(name: str) -> None:
    field, (t, y, p, u) = shipped(name, "jax")
    single = [np.float32(part) for part in (t, y, p, u)]
    found = jax.jit(field.rates)(*single)
    reference = field.rates(t, y, p, u)
    assert found.dtype == np.float32
    assert np.abs(found - reference).max() <= 2e-4 * np.abs(reference).max()


MOST = 64  # numbers that any law takes: with as many for each, JAX compiles an operation once for all of them


def in_one(field: Any, y: Any) -> tuple[Any, Any, int]:
    """The rates as a function of all numbers, these, and how many of them are not there to fill up."""
    parts = [np.zeros(1), y, field.parameters, field.inputs]
    ends = np.cumsum([len(part) for part in parts])

    def rates(given: Any) -> Any:
        t, *rest, _ = jax.numpy.split(given, ends)
        return field.rates(t[0], *rest)

    return rates, np.concatenate([*parts, np.zeros(MOST - ends[-1])]), int(ends[-1])


@pytest.mark.parametrize("name", DYNAMIC)
def test_all_slopes_are_finite(name: str) -> None:
    scenario = tr.Scenario.load(name)
    system = scenario.system()
    field = system.vector_field("jax", system.vector_field().phases[0])
    rates, given, count = in_one(field, field.pack(scenario.start_state()))
    slopes = jax.jacfwd(rates)(given)
    assert np.isfinite(slopes).all()
    assert slopes[:, :count].any()
    assert not slopes[:, count:].any()


BALL = tr.Body.solid_sphere(0.02, 0.1)
AT_NOTHING = {
    "drag that goes with the square, at rest": tr.RollingSystem(BALL, tr.Support(tr.Plane()), (tr.QuadraticDrag(0.1),)),
    "resistance to rolling, at rest": tr.RollingSystem(BALL, tr.Support(tr.Plane()), (tr.RollingResistance(1e-4),)),
    "the apex of a surface of revolution": tr.RollingSystem(BALL, tr.Support(tr.Revolution("0.5*r**2"))),
    "a dry bearing": tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.FreeAxle(0.1, bearing_torque=0.01))),
}


@pytest.mark.parametrize("name", AT_NOTHING)
def test_slopes_are_finite_where_a_length_is_nothing(name: str) -> None:
    field = AT_NOTHING[name].vector_field("jax")
    rates, given, count = in_one(field, field.pack(AT_NOTHING[name].place()))
    for slopes in (jax.jacfwd, jax.jacrev):
        found = slopes(rates)(given)
        assert np.isfinite(found).all()
        assert found[:, :count].any()


@pytest.mark.parametrize("name", ["level-turntable-put-down", "ball-in-a-turning-bowl", "rattleback-with-losses"])
def test_slopes_backwards_are_those_forwards(name: str) -> None:
    scenario = tr.Scenario.load(name)
    field = scenario.system().vector_field("jax")
    given = 0.0, field.pack(scenario.start_state()), field.parameters, field.inputs
    forwards = jax.jacfwd(field.rates, argnums=(1, 2, 3))(*given)
    backwards = jax.jacrev(field.rates, argnums=(1, 2, 3))(*given)
    for one, other in zip(forwards, backwards, strict=True):
        assert np.abs(one - other).max() <= EXACT(4096, max(1.0, np.abs(one).max()))


@pytest.mark.parametrize("name", ["tilted-turntable", "rattleback", "coin-in-a-circle"])
def test_slopes_are_those_of_differences_in_forty_digits(name: str) -> None:
    field, (t, y, p, u) = shipped(name, "jax")
    given = np.concatenate([y, p, u])
    slopes = np.hstack(jax.jacfwd(field.rates, argnums=(1, 2, 3))(t, y, p, u))

    def rates(numbers: list[Any]) -> list[Any]:
        state, rest = numbers[: y.size], numbers[y.size :]
        system = with_inputs(with_numbers(field.system, rest[: p.size]), field.input_groups, rest[p.size :])
        return RollingLaw().rates(system, mpmath.mpf(t), state)

    with mpmath.workdps(DIGITS):
        step = mpmath.mpf(10) ** -15
        for i in range(given.size):
            moved = [[mpmath.mpf(x) + (step * sign if i == j else 0) for j, x in enumerate(given)] for sign in (1, -1)]
            above, below = map(rates, moved)
            reference = np.array([float((a - b) / (2 * step)) for a, b in zip(above, below, strict=True)])
            assert np.abs(slopes[:, i] - reference).max() <= 1e-12 * max(1.0, np.abs(reference).max())


def test_the_slope_of_a_whole_run() -> None:
    """A ball from rest on a slope gains x = (5/14) g sin α t², so that dx/dα = (5/14) g cos α t²."""
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane(), tilt=0.1))
    field = system.vector_field("jax")
    y0, u, tilt = field.pack(system.place()), field.inputs, field.parameter_names.index("support.tilt")

    def gone(alpha: Any) -> Any:
        p, h = jax.numpy.asarray(field.parameters).at[tilt].set(alpha), 0.05

        def step(y: Any, t: Any) -> tuple[Any, None]:
            first = field.rates(t, y, p, u)
            second = field.rates(t + h / 2, y + h / 2 * first, p, u)
            third = field.rates(t + h / 2, y + h / 2 * second, p, u)
            fourth = field.rates(t + h, y + h * third, p, u)
            return y + h / 6 * (first + 2 * second + 2 * third + fourth), None

        y, _ = jax.lax.scan(step, jax.numpy.asarray(y0), h * jax.numpy.arange(20))
        return y[0]

    assert float(jax.jit(jax.grad(gone))(0.1)) == pytest.approx(5 / 14 * 9.80665 * np.cos(0.1), rel=1e-12)


def test_diffrax_integrates_it() -> None:
    diffrax = pytest.importorskip("diffrax", reason="diffrax, a peer of the benchmarks, is not installed")
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.02))
    start = system.place((0.1, 0.0))
    field = system.vector_field("jax")
    p, u = field.parameters, field.inputs
    found = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, _: field.rates(t, y, p, u)),
        diffrax.Dopri8(),
        t0=0.0,
        t1=2.0,
        dt0=0.01,
        y0=jax.numpy.asarray(field.pack(start)),
        stepsize_controller=diffrax.PIDController(rtol=1e-10, atol=1e-10),
    )
    run = tr.simulate(system, start, duration=2.0, every=2.0)
    assert np.abs(np.asarray(found.ys[-1, :2]) - run.data.position.values[-1, :2]).max() <= 1e-8
