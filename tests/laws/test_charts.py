"""In every chart the law is the same: its rates, its events, and where a run leads, also from one chart to another."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from tests import draws
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.parameters import numbers
from trundle.solve import corner_events, integrators, taylor
from trundle.solve.charts import CHART, LAWS_OWN, BodyAxes, Chart, LineOfNodes, SupportAxes, charts
from trundle.solve.dense import Dense
from trundle.solve.laws import CORNER, RollingLaw
from trundle.solve.lowering import Lowered, lower

COIN = tr.Body.disc(0.012, mass=0.0075, thickness=0.0022)
PUCK = tr.Body.ellipsoid((0.1, 0.1, 0.06), mass=0.5, centre=(0.0, 0.0, 0.01), moments=(2e-3, 2e-3, 3e-3))
STONE = tr.Body.ellipsoid((0.2, 0.03, 0.02), mass=1.0, moments=(2e-4, 1.6e-3, 1.7e-3), products=(-2e-5, 0, 0))
BALL = tr.Body.solid_sphere(0.05, 0.1)
LOADS = (tr.Drag(0.02), tr.RollingCouple(1e-4), tr.Motor((0.0, 1e-4, 2e-4)), tr.PivotFriction(1e-4))
SUPPORTS = {
    "a table": tr.Support(tr.Plane(), friction=0.3),
    "a slope": tr.Support(tr.Plane(rim=3.0), tilt=0.1),
    "a turntable": tr.Support(tr.Plane(), motion=tr.Spin(-0.7), tilt=0.05, friction=0.5),
    "a shaken table": tr.Support(tr.Plane(), motion=tr.Shake((0.01, 0.0, 0.002), 18.0)),
    "a free table": tr.Support(tr.Plane(), motion=tr.FreeAxle(inertia=2e-3)),
    "a spinning bowl": tr.Support(tr.EllipsoidalBowl((0.9, 0.8, 0.7)), motion=tr.Spin(1.5), friction=0.4),
    "a wobbling bowl": tr.Support(tr.Bowl(0.8), motion=tr.Wobble(1.5, 0.1)),
}
BODIES = {"coin": COIN, "puck": PUCK, "stone": STONE, "ball": BALL}
few = settings(max_examples=10, suppress_health_check=list(HealthCheck), deadline=None)
numbers_between = st.floats(-1.0, 1.0)


def lowered_in(system: tr.RollingSystem, chart: Chart) -> Lowered:
    """Return the law of rolling as it is compiled in a chart."""
    return lower(system, RollingLaw(), chart, [i for i, value in enumerate(numbers(system)) if value == 0])


def rates_and_events(
    system: tr.RollingSystem, ready: Lowered, time: float, state: list[float]
) -> tuple[list[float], dict[str, float]]:
    """Return a law's rates and event functions as they come out of a chart."""
    chart = ready.chart
    own = chart.of_law(system, time, state)
    given_numbers = [*numbers(system), *[0.0] * corner_events.count(system)]
    outputs = ready.tape.function(ready.outputs)([0.0, *own, *ready.values(given_numbers, time)])
    rates, step = outputs[: len(own)], 1e-30
    moved = [np.array([complex(value, step * rate)]) for value, rate in zip(own, rates, strict=True)]
    if isinstance(chart, SupportAxes):  # how the axes turn is not seen at one instant
        columns = chart.to_law(system, np.array([time]), moved)
        found = np.array([np.ravel(column)[0].imag / step for column in columns])
        turning = Vector(0.0, 0.0, system.support.motion.mean_rate)
        found[:3] += turning.cross(Vector(*state[:3])).array()
        found[3:7] += Quaternion(*state[3:7]).rate(turning).array()
        found[7:] += turning.cross(Vector(*state[7:])).array()
    else:
        columns = chart.to_law(system, np.array([complex(time, step)]), moved)
        found = np.array([np.ravel(column)[0].imag / step for column in columns])
    return found.tolist(), dict(zip(ready.event_functions, outputs[len(own) :], strict=True))


def hold(system: tr.RollingSystem, ready: Lowered, time: float, state: list[float]) -> None:
    """Hold what comes out of a chart against the law itself."""
    law = RollingLaw()
    rates, events = rates_and_events(system, ready, time, state)
    wanted, stops = law.rates(system, time, state), law.event_functions(system, time, state, ())
    for part in (slice(0, 3), slice(3, 7), slice(7, 10), slice(10, None)):
        scale = max(map(abs, (*wanted[7:10], *state[7:10], 1.0))) if part.start < 10 else max(map(abs, wanted))
        assert np.abs(np.subtract(rates[part], wanted[part])).max(initial=0.0) <= EXACT(3000, scale), part
    forces = abs(stops["lift"]) + system.body.mass * (9.8 + max(map(abs, wanted)) * 0.3)
    for name, value in events.items():
        if name != CHART and not name.startswith(CORNER):
            scale = forces * forces if name == "slip" else forces if name == "lift" else 1.0
            assert abs(value - stops[name]) <= EXACT(3000, scale), name


def state_of(system: tr.RollingSystem, seed: int) -> list[float]:
    """Return some state by the law's numbers, neither upright nor at rest."""
    random = np.random.default_rng(seed)
    surface, motion = system.support.surface, system.support.motion
    coordinates = tuple(random.uniform(-1, 1, len(motion.coordinates)).tolist())
    there = surface.point(*random.uniform(0.05, 0.2, 2).tolist())
    p = motion.at(2.75, *coordinates).carried(there)
    q = random.normal(size=4)
    q[1:3] += 0.6
    return [*p, *(q / np.linalg.norm(q)).tolist(), *random.normal(size=3).tolist(), *coordinates]


@pytest.mark.parametrize("support", SUPPORTS)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("loads", [(), LOADS])
def test_the_law_is_the_same_in_every_chart(body: str, support: str, loads: tuple[Any, ...]) -> None:
    system = tr.RollingSystem(BODIES[body], SUPPORTS[support], loads)
    tried = [type(chart) for chart in charts(system, RollingLaw())]
    for chart in charts(system, RollingLaw()):
        ready = lowered_in(system, chart)
        for seed in range(4):
            hold(system, ready, 2.75, state_of(system, seed))
    assert BodyAxes in tried
    assert (SupportAxes in tried) == (support == "a spinning bowl")
    assert (LineOfNodes in tried) == (body != "stone" and support not in ("a spinning bowl", "a wobbling bowl"))


@few
@given(draws.anything(), st.integers(0, 10**6))
def test_the_law_is_the_same_whatever_rolls_on_whatever(drawn: tuple[tr.RollingSystem, Any], seed: int) -> None:
    system, told = drawn
    try:
        start = system.place(**told)
        state = RollingLaw().pack(system, start)
        wanted = RollingLaw().rates(system, start.time, state)
    except (tr.TrundleError, ArithmeticError, ValueError):
        assume(False)
    state[7:10] = np.random.default_rng(seed).normal(size=3).tolist()
    assume(system.support.surface.analytic and np.isfinite(wanted).all() and max(map(abs, wanted)) < 1e6)
    touching = system.support.motion.at(start.time, *start.support).local(Vector(*state[:3]))
    assume(abs(system.support.surface.level(touching)) < 1e-12)  # where a body falls, no law of rolling holds
    for chart in charts(system, RollingLaw()):
        if chart.contains(state):
            hold(system, lowered_in(system, chart), start.time, state)


@pytest.fixture
def one_chart(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Run without the other charts."""

    def solved(solve: Any) -> Any:
        with monkeypatch.context() as patch:
            memory = integrators._Memory()
            patch.setattr(integrators, "_memory", lambda: memory)
            patch.setattr(integrators, "charts", lambda *_: (LAWS_OWN,))
            return solve()

    return solved


RUNS = {
    "a puck that falls through upright": (PUCK, "a table", {"attitude": (0.3, 0.5, 0.0), "spin": 0.3}),
    "a coin that rolls": (COIN, "a table", {"attitude": (0.0, 1.4, 0.0), "velocity": (0.5, 0.0), "spin": 1.0}),
    "a stone on a turntable": (STONE, "a turntable", {"attitude": (0.0, 0.02, 0.01), "spin": -5.0}),
    "a ball in a spinning bowl": (BALL, "a spinning bowl", {"position": (0.1, 0.05), "velocity": (0.1, 0.2)}),
}


@pytest.mark.parametrize("name", RUNS)
def test_a_run_leads_to_the_same_place_in_every_chart(name: str, one_chart: Any) -> None:
    pytest.importorskip("heyoka")
    body, support, told = RUNS[name]
    support_without_friction = tr.Support(**{**vars(SUPPORTS[support]), "friction": None, "kinetic_friction": None})
    system = tr.RollingSystem(body, support_without_friction)
    start, times = system.place(**told, time=1.25), 1.25 + np.linspace(0.0, 4.0, 81)
    found = taylor.solve(system, start, times)
    wanted = one_chart(lambda: taylor.solve(system, start, times))
    keep, beside = taylor.keeping()
    kept = Dense(keep, beside, system, start, float(times[-1]), taylor.TOLERANCE)(times)
    for samples in (found, kept):
        assert samples.events == wanted.events == ()
        for key in ("position", "velocity", "orientation", "angular_velocity", "contact_force"):
            one, other = getattr(samples, key), getattr(wanted, key)
            assert np.abs(one - other).max() <= SOLVER(100_000, taylor.TOLERANCE, np.abs(other).max()), key
    assert np.abs(np.diff(found.orientation, axis=0)).max() < 0.9  # q keeps its sign


def test_the_puck_leaves_the_nodes_on_its_way() -> None:
    pytest.importorskip("heyoka")
    body, support, told = RUNS["a puck that falls through upright"]
    system = tr.RollingSystem(body, SUPPORTS[support])
    start = system.place(**told)
    run = taylor.solve(system, start, np.linspace(0.0, 4.0, 401))
    x, y = run.orientation[:, 1:3].T
    w, z = run.orientation[:, [0, 3]].T
    sine = 2 * np.hypot(x, y) * np.hypot(w, z)
    assert sine[0] > 0.15 > 0.1 > sine.min()
    state = RollingLaw().pack(system, start)
    assert isinstance(integrators.ready(system, RollingLaw(), 1e-15, state)[0].chart, LineOfNodes)
