"""The numbers of the lecture, of Milne, of Landau and Lifshitz and of Weltner, read off from paths.

[landau1976] section 38; [milne1948]; [weltner1979]; [weltner1987].
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.solve.methods import tolerance_of

G, RATE, A, M = 9.80665, 3.5, 0.025, 0.065
SOLID, SHELL = tr.Body.solid_sphere(radius=A, mass=M), tr.Body.hollow_sphere(radius=A, mass=M)


@pytest.fixture(params=["exact", "taylor"])
def method(request: pytest.FixtureRequest) -> str:
    if request.param == "taylor":
        pytest.importorskip("heyoka")
    return request.param


def run(
    method: str, body: tr.Body, duration: float, *, rate: float = 0.0, tilt: float = 0.0, loads: Any = (), **start: Any
) -> Any:
    motion = tr.Spin(rate) if rate else tr.Fixed()
    system = tr.RollingSystem(body, tr.Support(tr.Plane(), motion=motion, tilt=tilt), loads=loads)
    return tr.simulate(system, system.place(**start), duration=duration, every=duration / 1200, method=method)


def plane(variable: Any) -> Any:
    return variable.values[:, 0] + 1j * variable.values[:, 1]


def slack(ours: tr.Trajectory, scale: float) -> float:
    """Return what roundings and the method may do to a quantity of that scale, for a run of some circles."""
    turned = np.linalg.norm(ours.data.angular_velocity.values, axis=1).max() * ours.data.time.values[-1]
    return EXACT(64, scale) + SOLVER(4 * turned, tolerance_of(ours.method), scale)


@pytest.mark.parametrize(("body", "share"), [(SOLID, 2 / 7), (SHELL, 2 / 5)], ids=["solid 2/7", "hollow 2/5"])
def test_a_nudged_ball_circles_at_a_share_of_the_tables_rate(method: str, body: tr.Body, share: float) -> None:
    ours = run(method, body, 12.0, rate=RATE, position=(0.1, 0.05), velocity=(0.2, 0.1))
    angle = np.unwrap(np.angle(plane(ours.data.velocity)))
    t = ours.data.time.values
    assert abs((angle[-1] - angle[0]) / t[-1] - share * RATE) <= slack(ours, 1.0)
    speed = np.abs(plane(ours.data.velocity))
    assert np.ptp(speed) <= slack(ours, speed[0])


def test_a_ball_put_down_gently_stays(method: str) -> None:
    ours = run(method, SOLID, 60.0, rate=RATE, position=(0.1, 0.05))
    moved = np.abs(plane(ours.data.position) - (0.1 + 0.05j)).max()
    assert moved == 0 if method == "exact" else moved <= slack(ours, 0.1)


def circle_through(points: Any) -> tuple[complex, float]:
    """Return centre and radius of the circle through three points."""
    p, q, r = points
    u, v = q - p, r - p
    centre = p + (abs(u) ** 2 * v - abs(v) ** 2 * u) / (2j * (u.conjugate() * v).imag)
    return centre, abs(centre - p)


def test_a_ball_released_with_the_table_circles_on_the_far_side(method: str) -> None:
    # Weltner: the circle's centre is at −(5/2) r₀ and its radius is (7/2) r₀.
    r0 = 0.12
    ours = run(method, SOLID, 2 * math.pi / RATE, rate=RATE, position=(r0, 0.0), velocity="co-rotating")
    centre, radius = circle_through(plane(ours.data.position)[[0, 500, 1100]])
    assert abs(centre + 2.5 * r0) <= slack(ours, 20 * r0)
    assert abs(radius - 3.5 * r0) <= slack(ours, 20 * r0)


@pytest.mark.parametrize("k", [2 / 5, 2 / 3, 0.2])
def test_on_a_tilted_table_the_drift_is_horizontal(method: str, k: float) -> None:
    # The lecture: (m a²/I ω) g sin α, horizontal, not down the plane; and the mean height stays the same.
    tilt, rate = 0.05, 6.0
    loop = 2 * math.pi * (1 + k) / (k * rate)
    body = tr.Body.sphere(A, M, k)
    ours = run(method, body, 3 * loop, rate=rate, tilt=tilt, position=(0.1, 0.0), velocity=(0.1, -0.2))
    zeta = plane(ours.data.position)[:-1].reshape(3, 400)
    loops = zeta.mean(axis=1)  # over whole loops, evenly sampled
    drift = np.diff(loops) / loop
    size = np.abs(zeta).max()
    assert np.abs(drift.imag - G * math.sin(tilt) / (rate * k)).max() <= slack(ours, size)
    assert np.abs(drift.real).max() <= slack(ours, size)
    height = ours.in_frame("world").data.position.values[:-1, 2].reshape(3, 400).mean(axis=1)
    assert np.ptp(height) <= slack(ours, size)
    assert np.ptp(ours.in_frame("world").data.position.values[:, 2]) > 1e-3  # though it rises and falls


@pytest.mark.parametrize(("body", "share"), [(SOLID, 5 / 7), (SHELL, 3 / 5)], ids=["solid 5/7", "shell 3/5"])
def test_a_fixed_slope(method: str, body: tr.Body, share: float) -> None:
    ours = run(method, body, 2.0, tilt=0.3, position=(0.0, 0.1))
    t, x = ours.data.time.values, ours.data.position.values[:, 0]
    down = share * G * math.sin(0.3) * t**2 / 2
    assert np.abs(x - down).max() <= slack(ours, down.max())
    # Friction is what slows it: (1 − share) m g sin α, up the slope; and the normal force m g cos α.
    force = ours.data.contact_force.values
    assert np.abs(force[:, 0] + (1 - share) * M * G * math.sin(0.3)).max() <= slack(ours, M * G)
    assert np.abs(force[:, 2] - M * G * math.cos(0.3)).max() <= slack(ours, M * G)


def test_the_reaction_to_a_force_and_a_torque(method: str) -> None:
    # Landau and Lifshitz, section 38, problem 2 (the lecture's equations for R and dV/dt).
    F, K = (0.1, -0.05, 0.02), (3e-4, -2e-4, 1e-5)
    ours = run(method, SOLID, 2.0, loads=(tr.Force(F), tr.Torque(K)), velocity=(0.3, 0.1))
    R = ours.data.contact_force.values
    assert np.abs(R[:, 0] - (5 / 7 * K[1] / A - 2 / 7 * F[0])).max() <= slack(ours, 0.1)
    assert np.abs(R[:, 1] - (-5 / 7 * K[0] / A - 2 / 7 * F[1])).max() <= slack(ours, 0.1)
    assert np.abs(R[:, 2] - (M * G - F[2])).max() <= slack(ours, M * G)
    t, V = ours.data.time.values, ours.data.velocity.values
    for i, push in ((0, F[0] + K[1] / A), (1, F[1] - K[0] / A)):
        assert np.abs(V[:, i] - V[0, i] - 5 / (7 * M) * push * t).max() <= slack(ours, 1.0)
    # The torque about the normal only spins the ball.
    spin = ours.data.angular_velocity.values[:, 2]
    assert np.abs(spin - K[2] / (0.4 * M * A**2) * t).max() <= slack(ours, 2.0)


def test_a_ball_rolled_around_a_quarter_square_comes_back_turned(method: str) -> None:
    # The lecture: a quarter turn along x, then one along y, is not the same as y first, then x.
    from scipy.spatial.transform import Rotation

    def rolled(*legs: tuple[float, float]) -> Any:
        q, at = (1.0, 0.0, 0.0, 0.0), (0.0, 0.0)
        for leg in legs:
            ours = run(method, SOLID, math.pi / 2 * A / 0.1, position=at, velocity=leg, orientation=q)
            q, at = tuple(ours.data.orientation.values[-1]), tuple(ours.data.position.values[-1, :2])
        return at, q

    (at, q), (there, p) = rolled((0.1, 0.0), (0.0, 0.1)), rolled((0.0, 0.1), (0.1, 0.0))
    assert np.abs(np.subtract(at, there)).max() <= EXACT(64, A)
    # Along x first, the north pole ends pointing along x; along y first, along y.
    for turned, pole in ((q, [1.0, 0.0, 0.0]), (p, [0.0, 1.0, 0.0])):
        now = Rotation.from_quat(turned, scalar_first=True).apply([0.0, 0.0, 1.0])
        assert np.abs(now - pole).max() <= EXACT(64, 1)


def test_a_charge_in_crossed_fields_runs_the_same_path(method: str) -> None:
    # M ζ̈ = −iQB ζ̇ + QE with κ = −QB/M and φ = QE/M: Larmor circle about a guiding centre that drifts at E×B/B².
    k, tilt, v0 = 2 / 5, 0.05, 0.1 - 0.2j
    ours = run(method, SOLID, 10.0, rate=RATE, tilt=tilt, position=(0.0, 0.0), velocity=(v0.real, v0.imag))
    charge, mass = 2.0, 3.0
    B, E = -mass * RATE * k / (1 + k) / charge, mass * G * math.sin(tilt) / (1 + k) / charge
    drift, larmor = -1j * E / B, -charge * B / mass  # E×B/B² points along −iE/B
    t = ours.data.time.values
    path = drift * t + (v0 - drift) * (np.exp(1j * larmor * t) - 1) / (1j * larmor)
    assert np.abs(plane(ours.data.position) - path).max() <= slack(ours, np.abs(path).max())
