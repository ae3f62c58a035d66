"""T13: a ball on a free turntable: Weckesser's conic, the table's own equation, and the numerical methods."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from tests.contracts.contract_closed_form import ClosedFormContract
from tests.precise import numbers, precisely, slope
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.solve.exact import SphereOnFreePlane
from trundle.solve.exact.kepler import stumpff
from trundle.solve.methods import tolerance_of

BALL = tr.Body.solid_sphere(radius=0.025, mass=0.065)
SHELL = tr.Body.hollow_sphere(radius=0.02, mass=0.0027)


def on_table(
    body: tr.Body = BALL, inertia: float = 1e-3, rate: float = 3.5, tilt: float = 0.0, loads: Any = (), **start: Any
) -> tuple[tr.RollingSystem, tr.State]:
    bearing = start.pop("bearing", 0.0)
    axle = tr.FreeAxle(inertia, rate, bearing_drag=bearing)
    surface = start.pop("surface", tr.Plane())
    system = tr.RollingSystem(body, tr.Support(surface, motion=axle, tilt=tilt), loads=loads)
    return system, system.place(**({"position": (0.1, -0.05), "velocity": (0.03, 0.2), "spin": 1.5} | start))


def critical(rate: float = 3.5) -> float:
    """Return how fast a ball at the axis must roll so that its path is a parabola: κ̂ h² = m v², h² = ω² I_t."""
    return rate * math.sqrt(1e-3 * (2 / 7) / 0.065)


AXIS = {"position": (0.0, 0.0), "spin": 0.0}
CASES: dict[str, Any] = {
    "ellipse": on_table(),
    "heavy table": on_table(inertia=10.0),
    "light table": on_table(SHELL, inertia=1e-7),
    "hyperbola": on_table(rate=1.0, velocity=(0.3, 0.2)),
    "parabola but for rounding": on_table(**AXIS, velocity=(critical(), 0.0)),
    "table at rest": on_table(rate=0.0),
    "circle about the axis": on_table(velocity=(0.0, 3.5 * 2 / 7 * 0.1), position=(0.1, 0.0)),
    "carried along": on_table(velocity="co-rotating", spin=None),
    "let go at rest": on_table(velocity=None),
    "backwards": on_table(rate=-5.0),
}


class TestSphereOnFreePlane(ClosedFormContract):
    form = SphereOnFreePlane
    span = 4.0

    def cases(self) -> list[tuple[tr.RollingSystem, tr.State]]:
        return list(CASES.values())

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        return [
            (*on_table(tilt=0.1), "pushes along the plane"),
            (*on_table(bearing=0.1), "bearing torque"),
            (*on_table(loads=(tr.Drag(0.1),)), "load drag is"),
            (*on_table(tr.Body(0.065, tr.Principal(1e-5, 2e-5, 2.5e-5), BALL.shape)), "isotropic inertia"),
            (*on_table(surface=tr.Bowl(2.0)), "surface is a bowl"),
        ]

    @precisely
    def test_the_table_obeys_the_moment_that_it_gets(self) -> None:
        for system, start in self.cases():
            motion, inertia = self.form.of(system, start), mpf(system.support.motion.inertia)
            for t in map(abs, numbers("instants", 3, self.span)):
                r, _, _, R = motion.motion_at(t)
                moment = -(r.x * R.y - r.y * R.x)
                angle_rate, rate_rate = (
                    slope(lambda t, i=i, motion=motion: motion.support_coordinates_at(t)[i], t) for i in range(2)
                )
                rate = mpf(start.support[1]) + motion.support_coordinates_at(t)[1]
                assert abs(angle_rate - rate) <= EXACT(32, abs(rate) + abs(mpf(start.support[1])))
                assert abs(inertia * rate_rate - moment) <= EXACT(32, r.norm() * (abs(R.x) + abs(R.y)) + mpf("1e-30"))


@pytest.mark.parametrize("name", CASES)
def test_the_path_is_weckesser_s_conic(name: str) -> None:
    """With its third axis along M, (L + mMy)² = C(I_t + mκ̂r²), and ω²(I_t + mκ̂r²) = C throughout."""
    system, start = CASES[name]
    motion = SphereOnFreePlane.of(system, start)
    t = np.linspace(0.0, 20.0, 400)
    r, V, *_ = motion.motion_at(t)
    omega = start.support[1] + motion.support_coordinates_at(t)[1]
    m, inertia, share = (
        system.body.mass,
        system.support.motion.inertia,
        motion.inertia_ratio / (1 + motion.inertia_ratio),
    )
    spread = inertia + m * share * (r.x**2 + r.y**2)
    C = omega[0] ** 2 * spread[0]
    assert np.allclose(omega**2 * spread, C, rtol=EXACT(64, 1.0), atol=0)
    L = inertia * omega + m * (r.x * V.y - r.y * V.x)
    size = inertia * np.abs(omega).max() + m * np.hypot(r.x, r.y).max() * np.hypot(V.x, V.y).max()
    assert np.allclose(L, motion.angular_momentum, rtol=0, atol=EXACT(64, size))
    Mx, My = motion.drive
    along = L[0] + m * (r.y * Mx - r.x * My)
    largest = (size + m * np.hypot(r.x, r.y).max() * math.hypot(Mx, My)) ** 2
    assert np.allclose(along**2, C * spread, rtol=0, atol=EXACT(64, largest))


def test_the_conic_is_told_by_its_excentricity() -> None:
    slow, fast = (on_table(**AXIS, velocity=(share * critical(), 0.0)) for share in (1 - 1e-9, 1 + 1e-9))
    assert SphereOnFreePlane.of(*slow).path == "ellipse"
    assert SphereOnFreePlane.of(*fast).path == "hyperbola"
    assert SphereOnFreePlane.of(*CASES["table at rest"]).path == "hyperbola"  # its straight limit


def test_once_round_takes_the_integral_of_the_energy() -> None:
    """The time round the ellipse, from its two turning points in r² alone: dr²/dt = 2Mx (quadrature in mpmath)."""
    motion = SphereOnFreePlane.of(*CASES["ellipse"])
    with mpmath.workdps(30):
        k, m, inertia = mpf(motion.inertia_ratio), mpf(motion.mass), mpf(motion.axle_inertia)
        share, zeta = k / (1 + k), mpmath.mpc(*motion.position)
        omega, V = mpf(motion.rate), mpmath.mpc(*motion.velocity)
        M = V - 1j * share * omega * zeta
        momentum = inertia * omega + m * (mpmath.conj(zeta) * V).imag
        root = omega * mpmath.sqrt(inertia + m * share * abs(zeta) ** 2)

        def x_squared(w: Any) -> Any:  # w² = I_t + mκ̂r², y from the conic
            return (w * w - inertia) / (m * share) - ((root * w - momentum) / (m * abs(M))) ** 2

        a = 1 / (m * share) - (root / (m * abs(M))) ** 2
        b = root * momentum / (m * abs(M)) ** 2
        c = -inertia / (m * share) - (momentum / (m * abs(M))) ** 2
        gap = mpmath.sqrt(b * b - a * c)
        low, high = sorted(((-b + gap) / a, (-b - gap) / a))
        middle, half = (low + high) / 2, (high - low) / 2

        def slowness(eta: Any) -> Any:  # dt = w dw/(mκ̂ M x), w = middle − half cos η, x = √−a half sin η
            w = middle - half * mpmath.cos(eta)
            return w / (m * share * abs(M) * mpmath.sqrt(-a))

        assert abs(x_squared(low)) < mpf("1e-25")
        period = 2 * mpmath.quad(slowness, [0, mpmath.pi])
        assert abs(motion.period - period) <= EXACT(64, period)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_the_general_law_agrees(name: str, method: str) -> None:
    if method == "taylor":
        pytest.importorskip("heyoka")
    ours, theirs = (tr.simulate(*CASES[name], 3.0, 0.1, method=one) for one in ("exact", method))
    tolerance = max(tolerance_of(method), 1e-15)
    for field in ("position", "velocity", "angular_velocity", "orientation", "support_angle", "support_rate"):
        size = max(1e-3, float(np.abs(ours.data[field]).max()))
        turned = max(1.0, float(np.abs(ours.data.angular_velocity).max()) * 3.0)
        difference = float(np.abs(ours.data[field] - theirs.data[field]).max())
        assert difference <= SOLVER(50, tolerance, turned * size), field


@pytest.mark.parametrize("square", [0.0, 1e-30, -1e-30, 0.5, -0.5, 2.0, -2.0, 400.0])
def test_stumpff_s_functions_by_definition(square: float) -> None:
    x = np.array([0.0, 1e-9, 0.3, 0.999, 1.0, 1.5, 3.0])
    ours = stumpff(square, x)
    for i, at in enumerate(x):
        with mpmath.workdps(30):
            exact = stumpff(mpf(square), mpf(float(at)))
        for one, other in zip(ours, exact, strict=True):
            assert abs(float(one[i]) - float(other)) <= EXACT(16, max(1.0, abs(float(other))))


PAST = [(1.4, 0.06, (8.0, 0.0)), (-0.7, -0.01, (3.0, -0.02)), (0.2, 1e-3, (8.0, 0.1)), (-3.0, 0.2, (5.0, 0.0))]


def past_the_axle(rate: float, aside: float, velocity: tuple[float, float]) -> SphereOnFreePlane:
    """A ball that passes the axle of a light table, two metres from its start."""
    return SphereOnFreePlane.of(*on_table(inertia=1e-4, rate=rate, position=(-2.0, aside), velocity=velocity, spin=0.0))


@pytest.mark.parametrize(("rate", "aside", "velocity"), PAST)
def test_before_at_and_long_after_its_nearest_approach(
    rate: float, aside: float, velocity: tuple[float, float]
) -> None:
    """The same with forty digits: the turn at the axle makes a rounding of the start a hundred times larger."""
    form = past_the_axle(rate, aside, velocity)
    times = 2.0 / velocity[0] * np.array([0.0, 0.5, 0.99, 1.0, 1.001, 1.01, 1.5, 3.0, 6.0])
    ours, own = form.motion_and_support_at(times)
    with mpmath.workdps(40):
        for i, t in enumerate(times.tolist()):
            exact, exact_own = form.motion_and_support_at(mpf(t))
            for vector, expected, size in zip(ours[:2], exact[:2], (2.0, velocity[0]), strict=True):
                off = max(abs(float(part[i] - there)) for part, there in zip(vector, expected, strict=True))
                assert off <= 1e-12 * max(size, *(abs(float(part)) for part in expected)), t
            assert abs(float(own[0][i] - exact_own[0])) <= 1e-12, t


@pytest.mark.parametrize(("rate", "aside", "velocity"), PAST)
def test_on_its_way_out_it_moves_as_smoothly_as_on_its_way_in(
    rate: float, aside: float, velocity: tuple[float, float]
) -> None:
    """Within microseconds a place is off a cubic by the rounding of itself, not of what cancels in it."""
    form, count = past_the_axle(rate, aside, velocity), np.arange(60)
    for share in (0.1, 1.5, 3.0, 6.0):
        place = form.motion_at(2.0 / velocity[0] * share + 1e-7 * count)[0]
        for part in (place.x, place.y):
            off = part - np.polyval(np.polyfit(count / 60, part, 3), count / 60)
            assert np.abs(off).max() <= 40 * np.spacing(np.hypot(place.x, place.y).max()), share
