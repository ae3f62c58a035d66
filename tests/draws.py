"""What Hypothesis draws: spheres on planes, turning or not, tilted or not, pushed or not, with a start."""

from __future__ import annotations

from typing import Any

from hypothesis import assume
from hypothesis import strategies as st
from tests.fuzz.classes import candidate, mended
from tests.fuzz.drawing import seeded

import trundle as tr

_TRIES = 30  # of a start that may be refused


def numbers(size: float) -> st.SearchStrategy[float]:
    return st.floats(-size, size, allow_subnormal=False).map(lambda x: x if abs(x) > 1e-9 * size else 0.0)


pairs = st.tuples(numbers(0.5), numbers(0.5))
triples = st.tuples(numbers(0.05), numbers(0.05), numbers(0.05))
loads = st.tuples(
    st.builds(tr.Force, triples),
    st.builds(tr.Torque, st.tuples(numbers(1e-3), numbers(1e-3), numbers(1e-5))),
    # Below a trillionth the sixty digits of the references would not tell e^z − 1 from 0.
    st.builds(tr.Drag, st.floats(0.0, 0.05).map(lambda c: c if c > 1e-12 else 0.0)),
)
bodies = st.builds(tr.Body.sphere, st.floats(0.02, 0.3), st.floats(0.01, 3.0), st.floats(0.05, 2 / 3))
TILTS = numbers(0.4)


@st.composite
def runs(draw: st.DrawFn, tilts: Any = TILTS, pushes: Any = loads) -> tuple[tr.RollingSystem, tr.State]:
    """A sphere on a plane, turning or not, tilted or not, pushed or not, with a start."""
    rate = draw(st.one_of(st.just(0.0), numbers(12.0)))
    support = tr.Support(tr.Plane(), motion=tr.Spin(rate) if rate else tr.Fixed(), tilt=draw(tilts))
    system = tr.RollingSystem(draw(bodies), support, loads=draw(st.one_of(st.just(()), pushes)))
    q = draw(st.sampled_from([(1.0, 0.0, 0.0, 0.0), (0.5, -0.5, 0.5, 0.5), (1e-9, 0.6, 0.8, 0.0)]))
    velocity = draw(st.one_of(st.none(), st.just("co-rotating"), pairs))
    return system, system.place(draw(pairs), velocity, spin=draw(st.one_of(st.none(), numbers(10.0))), orientation=q)


@st.composite
def rollers(draw: st.DrawFn) -> tuple[tr.RollingSystem, tr.State]:
    """A cylinder that rolls straight, down a slope, inside a pipe or over a log, with a start."""
    body = draw(st.builds(tr.Body.cylinder, st.floats(0.02, 0.2), st.floats(0.1, 3.0), st.floats(0.05, 1.0)))
    roll, speed = draw(numbers(6.0)), draw(numbers(3.0))
    if draw(st.booleans()):
        system = tr.RollingSystem(body, tr.Support(tr.Plane(), tilt=draw(TILTS)))
        return system, system.place((draw(numbers(0.5)), draw(numbers(0.5))), (speed, 0.0), roll=roll)
    wall = tr.Cylinder(draw(st.floats(0.3, 1.0)), draw(st.sampled_from(["inside", "outside"])))
    support = tr.Support(wall, motion=tr.Spin(draw(numbers(6.0))), tilt="90 deg")
    system = tr.RollingSystem(body, support)
    return system, system.place((draw(numbers(3.0)), draw(numbers(0.5))), (speed, 0.0), roll=roll)


@st.composite
def imperfect(draw: st.DrawFn) -> tuple[tr.RollingSystem, tr.State]:
    """A sphere on a table that wobbles or turns unevenly, in moving air, under a force that varies."""
    rate = draw(st.floats(0.5, 8.0))
    uneven = tr.UnevenSpin(rate, draw(numbers(0.1)), draw(st.floats(0.5, 8.0)))
    motion = draw(st.sampled_from([uneven, tr.Wobble(rate, draw(numbers(0.05)))]))
    pushed = (tr.Drag(draw(st.floats(0.0, 0.05)), air=rate), tr.Force(("0.01*sin(2*t)", 0.0, "0.02*t")))
    system = tr.RollingSystem(draw(bodies), tr.Support(tr.Plane(), motion=motion, tilt=draw(TILTS)), loads=pushed)
    return system, system.place(draw(pairs), draw(pairs), spin=draw(numbers(5.0)))


@st.composite
def anything(draw: st.DrawFn) -> tuple[tr.RollingSystem, dict[str, Any]]:
    """Whatever the format has words for: a system, and what `place` is told."""
    random = seeded(draw(st.integers(0, 10**9)))
    tables = candidate("anything", random)
    for _ in range(_TRIES):
        try:
            scenario = tr.Scenario.read(tables)
        except tr.TrundleError as error:
            tables = mended("anything", tables, getattr(error, "key", ""), random)
        else:
            return scenario.system(), scenario.start.arguments()
    assume(False)
    raise AssertionError
