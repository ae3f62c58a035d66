"""A flight is free fall and free rotation, also where the body's shape ends and by the apex of a cone.

Held against a parabola, Euler's equations followed by SciPy, and the nearest points of discs and balls in closed form.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.contact import contact_at
from trundle.mechanics.shapes import Disc, Hemisphere, Sphere, Torus
from trundle.mechanics.system import STANDARD_GRAVITY
from trundle.solve.laws import FlightLaw
from trundle.solve.samples import FLIGHT, Samples

Array = NDArray[np.float64]
FOLLOWED = 1e-13  # rtol of SciPy's method
MOMENTS = np.array([0.9e-3, 1.3e-3, 1.7e-3])
RADIUS, DOME, HILL = 0.12, 0.3, float(np.deg2rad(25.0))
PASSES = 0.1  # s
OFF = Vector(0.01, -0.02, 0.015)  # of the shape from the centre of mass
SHAPES: dict[str, Any] = {
    "disc": Disc(RADIUS),
    "disc about another point": Disc(RADIUS, OFF),
    "torus": Torus(0.13, 0.07),
    "half a sphere": Hemisphere(0.1, OFF),
    "ball about another point": Sphere(0.1, OFF),
}
SURFACES: dict[str, Any] = {
    "plane": (tr.Plane(), (0.1, 0.05)),
    "dome": (tr.Dome(DOME), (0.1, 0.05)),
    "hill": (tr.Cone(HILL, "outside"), (0.1, 0.05)),
    "funnel": (tr.Cone("50 deg"), (0.3, 0.1)),
    "track": (tr.TorusTrack(0.57, 0.27, "outside"), (0.59, 0.05)),
}


def over(shape: str, surface: str, motion: Any = None) -> tr.RollingSystem:
    body = tr.Body(0.3, tr.Principal(*MOMENTS), SHAPES[shape])
    support = tr.Support(SURFACES[surface][0], motion=motion or tr.Fixed(), friction=0.3, restitution=0.5)
    return tr.RollingSystem(body, support)


def thrown(system: tr.RollingSystem, surface: str, seed: int) -> tr.State:
    """Return a start that tumbles over the support, some way or other."""
    draw = np.random.default_rng(seed)
    return system.place(
        SURFACES[surface][1],
        tuple(draw.normal(size=3) * [0.3, 0.3, 1.0]),
        height=float(draw.uniform(0.2, 0.6)),
        angular_velocity=tuple(20 * draw.normal(size=3)),
        orientation=tuple(draw.normal(size=4)),
    )


def aimed(system: tr.RollingSystem, seed: int, miss: float) -> tr.State:
    """Return a start over the hill from which the nearest point passes in so small a distance from the apex, m.

    Then, at the time `PASSES`, the body is over a point of the line y = 0, and moves across it.
    """
    draw = np.random.default_rng(seed)
    fall, q = np.array([0.0, 0.0, -STANDARD_GRAVITY]), draw.normal(size=4)
    q, Omega = q / np.linalg.norm(q), 5 * draw.normal(size=3)
    turned = rotations(q, Omega, np.array([0.0, PASSES]))[-1]
    first, then = (Rotation.from_quat(one, scalar_first=True) for one in (q, turned))
    later = then.apply(then.inv().apply(first.apply(MOMENTS * first.inv().apply(Omega))) / MOMENTS)
    line, p = np.array([np.sin(HILL), 0.0, -np.cos(HILL)]), miss * np.array([np.sin(HILL), 0.0, -np.cos(HILL)])
    there = contact_at(system, 0.0, Vector(*p.tolist()), Quaternion(*turned.tolist()))
    n, rho, C = (
        there.normal.array(),
        there.offset.array(),
        np.array([tuple(row) for row in there.inverse_curvature.dense.rows]),
    )
    V = np.array([0.0, draw.uniform(0.7, 1.5), 0.0])
    V = V - line * (line @ (V + np.cross(later, rho) + C @ np.cross(later, n)))  # p moves neither up nor down
    r = p - rho + 0.1 * n - V * PASSES + 0.5 * fall * PASSES**2
    V = V - fall * PASSES
    return tr.State(tuple(r.tolist()), tuple(V.tolist()), tuple(Omega.tolist()), tuple(q.tolist()))


def rotations(orientation: Any, Omega: Any, times: Array) -> Array:
    """Return the orientations of a free body, (n, 4), by Euler's equations in its own frame."""

    def rates(_: float, y: Array) -> Array:
        (w, x, y_, z), own = y[:4], y[4:]
        a, b, c = own
        turning = 0.5 * np.array(
            [-x * a - y_ * b - z * c, w * a + y_ * c - z * b, w * b + z * a - x * c, w * c + x * b - y_ * a]
        )
        return np.concatenate([turning, np.cross(MOMENTS * own, own) / MOMENTS])

    own = Rotation.from_quat(orientation, scalar_first=True).inv().apply(Omega)
    span = (float(times[0]), float(times[-1]))
    found = solve_ivp(rates, span, [*orientation, *own], "DOP853", times, rtol=FOLLOWED, atol=0.1 * FOLLOWED)
    return found.y[:4].T


def first_flight(run: tr.Trajectory) -> Samples:
    """Return the samples of the flight with which a run begins."""
    ends = run.events[0].time if run.events else np.inf
    at = run.samples
    return at.part((at.time < ends) | ((at.time == ends) & (at.phase == FLIGHT)))


def flies_freely(run: tr.Trajectory) -> None:
    """Check that r and V are those of a parabola, and q and Ω those of a free body."""
    at, start, exact = first_flight(run), run.start, max(run.tolerance, 1e-15)
    assert at.time.size > 3
    t, fall = (at.time - start.time)[:, None], np.array([0.0, 0.0, -STANDARD_GRAVITY])
    position = np.array(start.position) + np.array(start.velocity) * t + 0.5 * fall * t * t
    assert np.abs(at.position - position).max() <= SOLVER(10, exact)
    assert np.abs(at.velocity - np.array(start.velocity) - fall * t).max() <= SOLVER(10, exact, 5.0)
    q = rotations(start.orientation, start.angular_velocity, at.time)
    bound = SOLVER(100, FOLLOWED) + SOLVER(100, exact)
    assert np.abs(at.orientation - q).max() <= bound
    first = Rotation.from_quat(start.orientation, scalar_first=True)
    momentum = first.apply(MOMENTS * first.inv().apply(start.angular_velocity))
    turned = Rotation.from_quat(q, scalar_first=True)
    Omega = turned.apply(turned.inv().apply(momentum) / MOMENTS)
    assert np.abs(at.angular_velocity - Omega).max() <= 50 * bound


def run_of(
    shape: str, surface: str, seed: int, method: str = "taylor", miss: float | None = None, motion: Any = None
) -> tr.Trajectory:
    if method == "taylor":
        pytest.importorskip("heyoka")
    system = over(shape, surface, motion)
    start = thrown(system, surface, seed) if miss is None else aimed(system, seed, miss)
    return tr.simulate(system, start, 0.5, 0.002, method=method)


TO_THE_EDGE = [
    ("disc", "dome", 1),
    ("disc", "dome", 13),
    ("disc", "hill", 5),
    ("disc", "track", 1),
    ("disc about another point", "dome", 9),
    ("disc about another point", "track", 11),
    ("torus", "hill", 7),
    ("torus", "track", 10),
    ("half a sphere", "plane", 9),
    ("half a sphere", "dome", 9),
    ("half a sphere", "hill", 6),
]
PAST_THE_APEX = [
    ("ball about another point", 1e-2, "land"),
    ("ball about another point", 1e-4, "land"),
    ("ball about another point", 1e-6, "land"),
    ("disc", 1e-2, "land"),
    ("disc", 1e-4, "end"),
    ("torus", 1e-2, "land"),
    ("torus", 1e-4, "end"),
]


@pytest.mark.parametrize(("shape", "surface", "seed"), TO_THE_EDGE)
def test_it_falls_freely_to_the_edge_of_its_shape(shape: str, surface: str, seed: int) -> None:
    run = run_of(shape, surface, seed)
    assert [event.kind for event in run.events] == ["edge"]
    flies_freely(run)
    assert run.card().passed, str(run.card())


@pytest.mark.parametrize(("shape", "surface", "seed"), TO_THE_EDGE[::5])
def test_so_it_does_by_runge_kutta(shape: str, surface: str, seed: int) -> None:
    run = run_of(shape, surface, seed, "runge-kutta")
    assert [event.kind for event in run.events] == ["edge"]
    flies_freely(run)
    assert run.card().passed, str(run.card())


@pytest.mark.parametrize("motion", [tr.Spin(2.0), tr.Shake((0.05, 0.02, 0.03), 7.0)], ids=["turning", "shaken"])
def test_what_the_support_does_is_nothing_to_it(motion: Any) -> None:
    run = run_of("disc", "hill", 5, motion=motion)
    flies_freely(run)
    assert run.card().passed, str(run.card())


@pytest.mark.parametrize(("shape", "miss", "ends"), PAST_THE_APEX)
def test_it_flies_past_the_apex_of_a_cone_or_ends_there(shape: str, miss: float, ends: str) -> None:
    run = run_of(shape, "hill", 1, miss=miss)
    assert run.events[0].kind == ends
    assert np.linalg.norm(first_flight(run).contact, axis=1).min() <= 1.001 * miss
    flies_freely(run)
    assert run.card().passed, str(run.card())


def nearest_on_a_dome(at: Samples, turned: Rotation) -> Array:
    """Return the points nearest to a disc: the disc's own is on its rim, towards the foot of its plane."""
    middle = np.array([0.0, 0.0, -DOME])
    disc = at.position + turned.apply(OFF.array()) - middle
    foot = turned.inv().apply(-disc) * [1.0, 1.0, 0.0]
    rim = disc + turned.apply(RADIUS * foot / np.linalg.norm(foot, axis=1, keepdims=True))
    return middle + DOME * rim / np.linalg.norm(rim, axis=1, keepdims=True)


def nearest_on_a_hill(at: Samples, turned: Rotation) -> Array:
    """Return the points nearest to a ball: the feet of its centre on the straight lines of the cone."""
    ball = at.position + turned.apply(OFF.array())
    outward = ball[:, :2] / np.linalg.norm(ball[:, :2], axis=1, keepdims=True)
    line = np.column_stack([np.sin(HILL) * outward, np.full(len(ball), -np.cos(HILL))])
    return (ball * line).sum(axis=1, keepdims=True) * line


@pytest.mark.parametrize(
    ("shape", "surface", "seed", "miss"),
    [
        ("disc about another point", "dome", 9, None),
        ("disc about another point", "dome", 1, None),
        *(("ball about another point", "hill", 1, miss) for miss in (1e-2, 1e-4, 1e-6)),
    ],
)
def test_the_nearest_point_is_where_geometry_has_it(shape: str, surface: str, seed: int, miss: float | None) -> None:
    at = first_flight(run_of(shape, surface, seed, miss=miss))
    nearest = nearest_on_a_dome if surface == "dome" else nearest_on_a_hill
    wanted = nearest(at, Rotation.from_quat(at.orientation, scalar_first=True))
    assert np.abs(at.contact - wanted).max() <= EXACT(64, 1.0)


def as_it_was_once(self: FlightLaw, system: tr.RollingSystem, time: Array, states: Array) -> Samples:
    """Record the centre of mass as p − ρ + g n, as flights did that did not carry it."""
    q = Quaternion.of(states[:, 3:7] / np.linalg.norm(states[:, 3:7], axis=1, keepdims=True))
    contact = contact_at(system, time, Vector.of(states[:, :3]), q)
    centre = contact.centre + contact.normal * states[:, 13]
    right = RECORD(self, system, time, states)
    return replace(right, position=np.broadcast_to(centre.array(), right.position.shape).copy())


RECORD = FlightLaw.record


def test_a_centre_worked_out_from_the_nearest_point_would_be_off(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FlightLaw, "record", as_it_was_once)
    run = run_of("disc", "dome", 13)
    with pytest.raises(AssertionError):
        flies_freely(run)
    assert not run.card().passed


@pytest.mark.filterwarnings("error")
def test_a_flight_past_the_end_of_a_formula_has_a_nearest_point_up_to_there() -> None:
    # The height falls without end at x = −0.3: next to it a step of Newton's method would lead outside.
    pit = tr.Support(tr.HeightField("0.05*log(0.3 + x)"), friction=0.3)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), pit)
    run = tr.simulate(system, system.place((-0.2, 0.0), velocity=(-1.0, 0.0, 0.5), height=0.1), 3.0, 0.02)
    assert run.events
    assert np.isfinite(run.samples.contact).all()
    assert run.card().passed
