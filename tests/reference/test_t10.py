"""The Legendre form T10: against mpmath's Legendre functions, the multipliers in Euler's angles, and runs."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest
from tests.reference.disc_by_multipliers import accelerations
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.invariants.legendre import LEGENDRE_PAIR, Rim, covers, rim_of, transfer, upright_rates
from trundle.solve.exact.rolling_disc import Nodding

BODIES = {
    "disc": tr.Body.disc(0.2, 3.0),
    "ring": tr.Body.ring(0.2, 3.0),
    "thick": tr.Body.disc(0.2, 3.0, thickness=0.1),
}


def rim(name: str) -> Rim:
    found = rim_of(BODIES[name])
    assert found is not None
    return found


def on_plane(body: tr.Body) -> tr.RollingSystem:
    return tr.RollingSystem(body, tr.Support(tr.Plane()))


def nodding(name: str) -> tuple[tr.RollingSystem, tr.State]:
    system = on_plane(BODIES[name])
    lean = (math.cos(0.7), math.sin(0.7), 0.0, 0.0)
    return system, system.place(velocity=(1.2, 0.1), spin=1.5, orientation=lean)


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("x", [0.0, 1e-9, 0.3, -0.5, 0.75, -0.97, 0.999, 1 - 1e-9])
def test_the_series_are_legendre_functions(name: str, x: float) -> None:
    """Of degree ν with ν(ν + 1) = −σC/A: the even and the odd combination of P_ν(x) and P_ν(−x), by mpmath."""
    body = rim(name)
    with mp.workdps(60):
        degree = mp.mpf(-0.5) + mp.sqrt(mp.mpf(0.25) - mp.mpf(body.share) * body.ratio)

        def pair(z: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
            up, down = (mp.re(mp.legenp(degree, 0, side * z, type=2)) for side in (1, -1))
            return up + down, up - down

        at = mp.mpf(x)
        even, odd = pair(at)
        slopes = [mp.diff(lambda z, i=i: pair(z)[i], at, h=mp.mpf(10) ** -22) for i in (0, 1)]
        first, steep = pair(mp.mpf(0))[0], mp.diff(lambda z: pair(z)[1], 0, h=mp.mpf(10) ** -22)
        # ω₃ = even/even(0) starts with η = 0; the odd one with η = 1, that is ω₃′ = −σ.
        expected = [even / first, -body.share * odd / steep]
        expected += [-(1 - at**2) / body.share * slopes[0] / first, (1 - at**2) * slopes[1] / steep]
    for value, exact in zip(transfer(x, body), expected, strict=True):
        assert float(value) == pytest.approx(float(exact), abs=EXACT(200, max(1.0, abs(float(exact)))))


@pytest.mark.parametrize("name", BODIES)
def test_the_linear_pair_follows_from_the_multipliers(name: str) -> None:
    """(1 − x²) dω₃/dx = −σ η and dη/dx = −(C/A) ω₃, from accelerations that know nothing of the rolling law."""
    body, random = rim(name), np.random.default_rng(1900)
    for lean, rate, psi, phi in random.uniform(-1.2, 1.2, (12, 4)):
        numbers = (body.mass, body.radius, body.across, body.along, 9.8)
        found = np.array(accelerations()(numbers, (lean, rate, psi, phi))[0], dtype=float).ravel()
        x, room = math.sin(lean), math.cos(lean) ** 2
        x_rate = math.cos(lean) * rate
        spin, eta = phi + psi * x, psi * room
        spin_rate = found[2] + found[1] * x + psi * x_rate
        eta_rate = found[1] * room - 2 * psi * x * x_rate
        assert room * spin_rate == pytest.approx(-body.share * eta * x_rate, abs=1e-13)
        assert eta_rate == pytest.approx(-body.ratio * spin * x_rate, abs=1e-13)


@pytest.mark.parametrize("name", BODIES)
def test_the_rates_when_upright_stay_the_same_along_a_run(name: str) -> None:
    system, start = nodding(name)
    run = tr.simulate(system, start, duration=4.0, every=0.02, method="taylor")
    q = Quaternion.of(run.data.orientation.values)
    Omega = Vector.of(run.data.angular_velocity.values)
    size = float(np.abs(run.data.angular_velocity.values).max())
    for terms in upright_rates(rim(name), q, Omega):
        value = sum(terms)
        assert np.abs(value - value[0]).max() < SOLVER(1e3, 1e-15, size)


def test_the_pair_is_a_first_integral_of_the_systems_that_have_it() -> None:
    system, _ = nodding("disc")
    assert LEGENDRE_PAIR.survives(system) == ("rolling",)
    for other in (
        tr.RollingSystem(BODIES["disc"], tr.Support(tr.Plane(), tilt=0.1)),
        tr.RollingSystem(BODIES["disc"], tr.Support(tr.Plane(), motion=tr.Spin(1.0))),
        tr.RollingSystem(BODIES["disc"], tr.Support(tr.Plane()), loads=(tr.Drag(0.1),)),
        on_plane(tr.Body.torus(0.2, 0.01, mass=1.0)),
        on_plane(tr.Body.solid_sphere(0.1, 1.0)),
        on_plane(tr.Body.disc(0.2, 1.0, centre=(0.0, 0.0, 0.01))),
        on_plane(tr.Body.disc(0.2, 1.0, moments=(0.01, 0.012, 0.02))),
    ):
        assert not covers(other)
        assert LEGENDRE_PAIR.survives(other) == ()
        with pytest.raises(tr.OutOfDomainError, match="T10 covers"):
            Nodding.of(other, nodding("disc")[1])


@pytest.mark.parametrize("name", BODIES)
def test_period_and_turning_points_are_those_of_the_run(name: str) -> None:
    system, start = nodding(name)
    motion, x = Nodding.of(system, start), math.cos(1.4)
    period = motion.period(x)
    run = tr.simulate(system, start, duration=period, every=period / 4000, method="taylor")
    seen = Quaternion.of(run.data.orientation.values).matrix().c.z
    assert seen[-1] == pytest.approx(x, abs=SOLVER(1e5, 1e-15))
    low, high = motion.turning_points(x)
    assert (low, high) == (pytest.approx(seen.min(), abs=1e-6), pytest.approx(seen.max(), abs=1e-6))
    assert seen.min() >= low - 1e-12
    assert seen.max() <= high + 1e-12
    ends = np.array([motion.square(low), motion.square(high)])
    assert np.abs(ends).max() < EXACT(1e4, 1 / period**2)


def test_a_disc_with_no_turning_falls_flat_and_says_so() -> None:
    system = on_plane(BODIES["disc"])
    start = system.place(orientation=(math.cos(0.7), math.sin(0.7), 0.0, 0.0))
    with pytest.raises(tr.SolverError, match="falls flat"):
        Nodding.of(system, start).period(math.cos(1.4))


def test_the_quadrature_and_the_run_that_closes_agree_on_the_period() -> None:
    system, start = nodding("ring")
    found = tr.periodic_motion(system, start)
    assert found.period == pytest.approx(Nodding.of(system, start).period(math.cos(1.4)), rel=1e-9)
