"""What Hypothesis draws: spheres on planes, turning or not, tilted or not, pushed or not, with a start."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

import trundle as tr


def numbers(size: float) -> st.SearchStrategy[float]:
    return st.floats(-size, size, allow_subnormal=False).map(lambda x: x if abs(x) > 1e-9 * size else 0.0)


pairs = st.tuples(numbers(0.5), numbers(0.5))
triples = st.tuples(numbers(0.05), numbers(0.05), numbers(0.05))
loads = st.tuples(
    st.builds(tr.Force, triples),
    st.builds(tr.Torque, st.tuples(numbers(1e-3), numbers(1e-3), numbers(1e-5))),
    st.builds(tr.Drag, st.floats(0.0, 0.05)),
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
