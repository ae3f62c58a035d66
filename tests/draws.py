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


def _of(*builders: Any) -> st.SearchStrategy[Any]:
    return st.one_of(*builders)


_sizes, _masses = st.floats(0.01, 0.2), st.floats(0.01, 2.0)
_angles, _rates = numbers(3.2), numbers(15.0)
ROUND = _of(
    bodies,
    st.builds(
        lambda a, m, c, j: tr.Body.eccentric_sphere(a, m, [x * m * a * a for x in j], [x * a for x in c]),
        _sizes,
        _masses,
        st.tuples(*[numbers(0.3)] * 3),
        st.tuples(*[st.floats(0.3, 0.5)] * 3),
    ),
)
ANY_BODY = _of(
    ROUND,
    st.builds(
        lambda axes, m, turn: tr.Body.ellipsoid(axes, m, turn=turn), st.tuples(*[_sizes] * 3), _masses, numbers(0.5)
    ),
    st.builds(lambda a, m, h: tr.Body.disc(a, m, thickness=h), _sizes, _masses, st.sampled_from([0.0, 0.004])),
    st.builds(tr.Body.ring, _sizes, _masses),
    st.builds(lambda a, e, m: tr.Body.torus(a, a * e, m), _sizes, st.floats(0.05, 0.9), _masses),
    st.builds(tr.Body.hemisphere, _sizes, _masses),
    st.builds(
        lambda a, b, m: tr.Body.shape_formula(f"{a!r} + {b!r}*nu_z + {0.1 * a!r}*nu_x**2", mass=m),
        _sizes,
        numbers(0.01),
        _masses,
    ),
    st.builds(tr.Body.cylinder, _sizes, _masses),
    st.builds(lambda a, m, w: tr.Body.weighted_cylinder(a, m, w, 0.7 * a), _sizes, _masses, _masses),
    st.builds(lambda a, m: tr.Body.half_cylinder(a, m), _sizes, _masses),
)
_rims = st.one_of(st.none(), st.floats(0.3, 1.0))
_sides = st.sampled_from(["inside", "outside"])
ANY_SURFACE = _of(
    st.builds(tr.Plane, _rims),
    st.builds(tr.Cylinder, st.floats(0.05, 1.0), _sides),
    st.builds(tr.Bowl, st.floats(0.1, 1.0)),
    st.builds(tr.Dome, st.floats(0.1, 1.0)),
    st.builds(tr.Cone, st.floats(0.2, 1.4), _sides, _rims),
    st.builds(tr.Paraboloid, st.one_of(st.floats(0.1, 1.0), st.floats(-1.0, -0.1)), _rims),
    st.builds(tr.EllipsoidalBowl, st.tuples(*[st.floats(0.2, 1.0)] * 3)),
    st.builds(tr.TorusTrack, st.floats(0.6, 1.0), st.floats(0.1, 0.5), _sides),
    st.builds(
        tr.Revolution,
        st.sampled_from(["0.3*r2", "0.1*cos(8*r)", "0.2*sqrt(r2 + 0.01)", "0.2*r", "r2/(0.5 - r2)", "0.05*log(r)"]),
        _rims,
    ),
    st.builds(
        tr.HeightField,
        st.sampled_from(
            ["0.2*x*y", "0.05*sin(6*x)*cos(6*y)", "0.2*abs(x)", "sqrt(0.3 - x)", "0.1*exp(3*x)", "0.3*x**2 + 0.1*y**4"]
        ),
        _rims,
    ),
)
_simple_motions = _of(
    st.builds(tr.Spin, _rates),
    st.builds(tr.UnevenSpin, _rates, numbers(0.5), st.floats(0.5, 8.0)),
    st.builds(tr.Wobble, _rates, numbers(0.3)),
    st.builds(
        tr.SpinBy,
        st.sampled_from(["3 + 2*t", "5*sin(4*t)", "4*exp(-t)", "1/(t - 0.2)", "sqrt(0.3 - t)", "2*abs(t - 0.1)"]),
    ),
    st.builds(tr.Tilt, st.sampled_from(["0.2*sin(5*t)", "0.1*t**2"])),
    st.builds(tr.Rock, numbers(0.4), st.floats(0.5, 9.0), _angles),
    st.builds(tr.Shake, st.tuples(*[numbers(0.02)] * 3), st.floats(0.5, 30.0), _angles),
    st.builds(tr.PrecessingTilt, numbers(0.3), _rates),
    st.just(tr.Move(("0.1*t**2", 0.0, "0.01*sin(9*t)"))),
)
_free = st.builds(
    tr.FreeAxle, st.floats(1e-4, 1.0), _rates, st.sampled_from([0.0, "0.01*sin(t)"]), st.sampled_from([0.0, 0.01])
)
ANY_MOTION = _of(
    st.just(tr.Fixed()),
    _simple_motions,
    _free,
    st.builds(lambda a, b: tr.Combined((a, b)), _simple_motions, _simple_motions),
    st.builds(lambda a, b: tr.Combined((a, b)), st.just(tr.Shake((0.01, 0.0, 0.0), 9.0)), _free),
)
_small = st.tuples(*[numbers(0.05)] * 3)
ANY_LOAD = _of(
    st.builds(tr.Force, _small),
    st.just(tr.Force((0.0, "0.05*sin(9*t)", "0.1*exp(-t)"))),
    st.builds(lambda v: tr.Torque(tuple(0.01 * x for x in v)), _small),
    st.builds(tr.Drag, st.floats(0.0, 0.1), st.one_of(st.just(0.0), _rates)),
    st.builds(tr.QuadraticDrag, st.floats(0.0, 0.1), st.one_of(st.just(0.0), _rates)),
    st.builds(tr.Magnus, st.floats(0.0, 0.01)),
    st.builds(
        tr.Potential, st.sampled_from(["x**2 + 2*y**2", "0.01*x*y*z", "0.01/sqrt(x**2 + y**2)", "0.1*log(0.5 + x)"])
    ),
    st.builds(tr.RollingResistance, st.floats(0.0, 0.005)),
    st.builds(tr.PivotFriction, st.floats(0.0, 1e-4), st.just(0.5)),
    st.builds(tr.RollingCouple, st.floats(0.0, 1e-3)),
    st.builds(tr.Motor, st.tuples(*[numbers(1e-3)] * 3)),
)
_mu = st.sampled_from([None, 0.0, 0.05, 0.3, 1.0])


@st.composite
def anything(draw: st.DrawFn) -> tuple[tr.RollingSystem, dict[str, Any]]:
    """Any body on any support that moves in any way, under any loads, with what `place` is told."""
    mu = draw(_mu)
    kinetic = draw(st.sampled_from([None, 0.5, 1.0])) if mu is not None else None
    surface = draw(ANY_SURFACE)
    lying = isinstance(surface, (tr.Cylinder, tr.Cone, tr.TorusTrack))
    support = tr.Support(
        surface,
        draw(ANY_MOTION),
        draw(st.sampled_from([0.0, 0.3, -1.0, *([0.5 * 3.141592653589793] if lying else [])])),
        mu,
        None if kinetic is None or mu is None else kinetic * mu,
        draw(st.sampled_from([0.0, 0.6, 1.0])),
        draw(st.sampled_from([0.0, 0.0, 0.5, 1.0])),
    )
    system = tr.RollingSystem(
        draw(ANY_BODY),
        support,
        tuple(draw(st.lists(ANY_LOAD, max_size=2))),
        gravity=draw(st.sampled_from([9.80665, 9.80665, 9.80665, 0.0])),
    )
    told: dict[str, Any] = {"position": draw(st.tuples(numbers(0.3), numbers(0.3)))}
    told["velocity"] = draw(
        st.one_of(
            st.none(), st.just("co-rotating"), st.tuples(numbers(1.0), numbers(1.0)), st.tuples(*[numbers(1.0)] * 3)
        )
    )
    told["height"] = draw(st.sampled_from([0.0, 0.0, 0.0, 0.05]))
    if draw(st.booleans()):
        told["spin"] = draw(_rates)
    elif draw(st.booleans()):
        told["angular_velocity"] = draw(st.tuples(*[_rates] * 3))
    if draw(st.booleans()):
        told["attitude"] = draw(st.tuples(_angles, numbers(1.5), _angles))
    return system, told
