"""Steady motions of disc and hoop: against Lagrange's multipliers in Euler's angles, and the published limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.reference.disc_by_multipliers import linear_law
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector

G = 9.80665
BODIES = {"disc": tr.Body.disc(0.2, 3.0), "ring": tr.Body.ring(0.2, 3.0)}


def moments(body: tr.Body) -> tuple[float, ...]:
    return body.mass, body.shape.radius, body.inertia.x, body.inertia.z, G


def leaning(lean: float) -> tuple[float, float, float, float]:
    """The disc's axis at `lean` over the plane, across the first axis."""
    half = 0.5 * (0.5 * math.pi - lean)
    return math.cos(half), math.sin(half), 0.0, 0.0


def on_plane(body: tr.Body) -> tr.RollingSystem:
    return tr.RollingSystem(body, tr.Support(tr.Plane()))


def started(system: tr.RollingSystem, lean: float, turning: float, own: float) -> tr.State:
    """A start with ψ̇ and φ̇ given, λ̇ = 0."""
    e = Quaternion(*leaning(lean)).matrix() @ Vector(0.0, 0.0, 1.0)
    Omega = e * own + Vector(0.0, 0.0, turning)
    # V = Ω×(centre − contact), whose part along the plane `place` takes.
    up = Quaternion(*leaning(lean)).matrix() @ Vector(0.0, system.body.shape.radius, 0.0)
    V = Omega.cross(up if up.z > 0 else -up)
    return system.place(velocity=(V.x, V.y), spin=turning + own * e.z, orientation=leaning(lean))


def own_turn(motion: tr.SteadyMotion) -> float:
    return motion.own_turn[2]


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize(
    ("lean", "turning", "own"),
    [(0.3, 2.0, -8.0), (-0.7, 1.0, 9.0), (1.1, 6.0, -5.0), (0.05, 0.3, 20.0), (-0.02, 25.0, 1.0), (0.9, 4.0, 3.0)],
)
def test_a_leaning_disc_circles_as_the_multipliers_say(name: str, lean: float, turning: float, own: float) -> None:
    system = on_plane(BODIES[name])
    (motion,) = tr.steady_motions(system, started(system, lean, turning, own))
    now = motion.quantities["lean"], motion.turning, own_turn(motion)
    off, matrix = linear_law(moments(BODIES[name]), *now)
    rate = motion.relative.flow.rate
    assert abs(off) < EXACT(1e4, rate**2)
    assert motion.dimension == 2
    expected = np.sort_complex(np.linalg.eigvals(matrix) ** 2)
    pair = expected[np.argsort(abs(expected))][2:].real.mean()  # the other two belong to the family: zeros
    assert motion.modes[0].rate.real ** 2 - motion.modes[0].rate.imag ** 2 == pytest.approx(pair, abs=1e-9 * rate**2)
    assert motion.verdict == ("stable to first order" if pair < 0 else "unstable")
    assert motion.checked < SOLVER(1e5, 1e-15, 1e3)


@pytest.mark.parametrize(("name", "share"), [("disc", 1 / 3), ("ring", 1 / 4)])
def test_rolling_upright_is_stable_above_the_known_speed(name: str, share: float) -> None:
    """v² > g a/3 for a disc, g a/4 for a hoop (przybylska2016): A/(C(1 + C)) in units of m a²."""
    body = BODIES[name]
    system, a = on_plane(body), body.shape.radius
    v = math.sqrt(share * G * a)
    (motion,) = tr.steady_motions(system, system.place(velocity=(1.2 * v, 0.0), orientation=leaning(0.0)))
    assert (motion.kind, motion.verdict) == ("rolls straight", "stable to first order")
    sweep = motion.along("speed", 0.8 * v, 1.5 * v, count=5)
    assert sweep.limits == (pytest.approx(v, rel=1e-10),)
    assert [one.verdict for one in sweep.motions[:2]] == ["unstable", "unstable"]
    A, C = body.inertia.x / (body.mass * a * a), body.inertia.z / (body.mass * a * a)
    for value, one in zip(sweep.values, sweep.motions, strict=True):
        square = (G / a - C * (1 + C) / A * (value / a) ** 2) / (1 + A)  # λ² by hand
        assert (one.modes[0].rate ** 2).real == pytest.approx(square, abs=1e-10 * G / a)


@pytest.mark.parametrize(("name", "share"), [("disc", 4 / 5), ("ring", 2 / 3)])
def test_spinning_on_edge_is_stable_above_the_known_rate(name: str, share: float) -> None:
    """ω² > g/(a(1 + A/(m a²))): 4g/(5a) for a disc, 2g/(3a) for a hoop (przybylska2016)."""
    body = BODIES[name]
    system, a = on_plane(body), body.shape.radius
    w = math.sqrt(share * G / a)
    (motion,) = tr.steady_motions(system, system.place(spin=1.5 * w, orientation=leaning(0.0)))
    assert (motion.kind, motion.turning) == ("turns on the spot", pytest.approx(1.5 * w))
    sweep = motion.along("spin", 0.5 * w, 2 * w, count=4)
    assert sweep.limits == (pytest.approx(w, rel=1e-10),)
    for value, one in zip(sweep.values, sweep.motions, strict=True):
        assert (one.modes[0].rate ** 2).real == pytest.approx(w * w - value * value, abs=1e-9 * w * w)


@pytest.mark.parametrize("angle", [0.3, 0.05, 0.01])
def test_eulers_disk_with_its_centre_at_rest(angle: float) -> None:
    """ψ̇² = 4g/(a sin α) at the angle α to the plane (moffatt2000), Ω along the line from contact to centre."""
    body = BODIES["disc"]
    system, a, lean = on_plane(body), body.shape.radius, 0.5 * math.pi - angle
    turning = math.sqrt(4 * G / (a * math.sin(angle)))
    own = -turning * math.sin(lean)
    e = Quaternion(*leaning(lean)).matrix() @ Vector(0.0, 0.0, 1.0)
    still, height = (0.0, 0.0, 0.0), a * math.sin(angle)
    start = tr.State((0.0, 0.0, height), still, (0.0, own * e.y, turning + own * e.z), leaning(lean))
    (motion,) = (found := tr.steady_motions(system, start))
    assert found.moved < 1e-9
    assert motion.turning == pytest.approx(turning, rel=1e-12)
    assert motion.verdict == "stable to first order"
    off, matrix = linear_law(moments(body), lean, turning, own)
    values = np.linalg.eigvals(matrix)
    assert abs(off) < EXACT(1e4, turning**2)
    assert motion.modes[0].frequency == pytest.approx(float(abs(values.imag).max()), rel=1e-7)


def test_with_lean_and_turning_held_there_is_one_spin() -> None:
    system = on_plane(BODIES["disc"])
    start = started(system, 0.4, 2.0, -6.0)
    (motion,) = tr.steady_motions(system, start, holding={"lean": "25 deg", "turning": 2.5})
    assert motion.quantities["lean"] == pytest.approx(math.radians(25), abs=1e-12)
    assert motion.turning == pytest.approx(2.5, abs=1e-12)
    m, a, A, C, g = moments(BODIES["disc"])
    s, x = math.cos(math.radians(25)), math.sin(math.radians(25))
    spin = own_turn(motion) + 2.5 * x  # (C + m a²) ω₂ ω₃ − A ω₂² x/s + m g a x = 0 with ω₂ = ψ̇ s
    assert (C + m * a * a) * 2.5 * s * spin == pytest.approx(A * 2.5**2 * s * x - m * g * a * x, abs=1e-11)


def test_at_the_limit_the_verdict_is_neutral() -> None:
    body = BODIES["disc"]
    system, a = on_plane(body), body.shape.radius
    start = system.place(velocity=(math.sqrt(G * a / 3), 0.0), orientation=leaning(0.0))
    (motion,) = tr.steady_motions(system, start)
    assert motion.verdict == "neutral"
    assert "limit of stability" in str(tr.steady_motions(system, start))
