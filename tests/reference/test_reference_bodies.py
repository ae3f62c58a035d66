"""The classic problems of bodies that are no uniform balls: shipped scenarios against what others have found.

Every number that goes into an expectation stands here, not taken from the scenario's file.
"""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.reference.bodies_by_multipliers import Free, ball, cross, ellipsoid, furthest_apart, matrix, rim
from tests.tolerances import EXACT, SOLVER

import trundle as tr

G = 9.80665
SLOPE = math.radians(20)


def disc(mass: float, a: float, share: float = 0.5) -> np.ndarray:
    """J of a disc (1/2) or a ring (1)."""
    return np.diag([share / 2, share / 2, share]) * mass * a * a


def guide(t: float, _: np.ndarray) -> np.ndarray:
    """The couple that holds a coin upright on an incline."""
    size = -2 * 0.1 * G * 0.05 * math.sin(SLOPE) * math.sin(16 * t)
    return size * np.array([math.cos(16 * t), math.sin(16 * t), 0.0])


CHAPLYGIN = np.diag([2.0e-3, 3.2e-3, 4.8e-3])
ROUTH = np.diag([3.0e-6, 3.0e-6, 3.2e-6])
TIPPE = np.diag([131 / 350, 131 / 350, 2 / 5]) * 0.02 * 0.02**2
STONE = np.array([[2e-4, 2e-5, 0], [2e-5, 1.6e-3, 0], [0, 0, 1.7e-3]])
UNDERSIDE = ellipsoid((0.2, 0.03, 0.02), (0, 0, 0.01))
DOWN = (G * math.sin(SLOPE), 0.0, -G * math.cos(SLOPE))

FREE: dict[str, tuple[Free, float]] = {
    "coin-rolling-upright": (Free(0.008, disc(0.008, 0.012), rim(0.012)), 0.3),
    "hoop-rolling-too-slowly": (Free(0.5, disc(0.5, 0.3, 1.0), rim(0.3)), 2.0),
    "coin-in-a-circle": (Free(0.008, disc(0.008, 0.012), rim(0.012)), 0.5),
    "coin-upright-on-incline": (Free(0.1, disc(0.1, 0.05), rim(0.05), gravity=DOWN, couple=guide), 0.4),
    "coin-spun-on-edge": (Free(0.008, disc(0.008, 0.012), rim(0.012)), 0.4),
    "eulers-disc": (Free(0.4, disc(0.4, 0.0375), rim(0.0375), couple=lambda _, Omega: -4e-5 * Omega), 0.3),
    "chaplygin-ball": (Free(0.64, CHAPLYGIN, ball(0.1)), 2.0),
    "chaplygin-ball-on-turntable": (Free(0.64, CHAPLYGIN, ball(0.1), rate=math.pi), 2.0),
    "routh-sphere": (Free(0.02, ROUTH, ball(0.02, (0, 0, 0.006))), 0.7),
    "tippe-top": (Free(0.02, TIPPE, ball(0.02, (0, 0, 0.006)), slides=0.3), 0.15),
    "rattleback": (Free(1.0, STONE, UNDERSIDE, tolerance=1e-11), 1.0),
    "rattleback-with-losses": (
        Free(1.0, STONE, UNDERSIDE, couple=lambda _, Omega: -1e-4 * Omega, tolerance=1e-11),
        1.5,
    ),
}


def followed(name: str, duration: float, every: float) -> tr.Trajectory:
    scenario = tr.Scenario.load(name)
    return tr.simulate(scenario.system(), scenario.start_state(), duration=duration, every=every)


@pytest.mark.parametrize("name", FREE)
def test_the_scenario_moves_as_the_multipliers_say(name: str) -> None:
    free, duration = FREE[name]
    run = followed(name, duration, duration / 20)
    states = free.follow(tr.Scenario.load(name).start_state(), run.data.time.to_numpy())
    place, turning, direction = furthest_apart(run, states)
    fastest = abs(run.data.angular_velocity.to_numpy()).max()
    angle = 1 + fastest * duration  # how far it has turned, and DOP853's errors with it
    bound = SOLVER(100, free.tolerance, angle)
    assert max(direction, place / 0.2, turning / fastest) < bound


def axis(run: tr.Trajectory) -> np.ndarray:
    """The third axis of the body in space, (time, 3)."""
    return np.array([matrix(q)[:, 2] for q in run.data.orientation.to_numpy()])


def lean(run: tr.Trajectory) -> np.ndarray:
    """Out of upright, rad: positive where the top leans to the left of a coin that heads along the first axis."""
    return np.arcsin(axis(run)[:, 2])


@pytest.mark.parametrize(
    ("body", "a", "share", "limit"),
    [(tr.Body.disc(0.012, 0.008), 0.012, 0.5, 3), (tr.Body.ring(0.3, 0.5), 0.3, 1.0, 4)],
    ids=["disc, v² > g a/3", "hoop, v² > g a/4"],
)
@pytest.mark.parametrize("relative", [0.7, 1.3])
def test_a_nudged_coin_sways_or_falls_at_the_linear_rate(
    body: tr.Body, a: float, share: float, limit: int, relative: float
) -> None:
    # (A + m a²) λ̈ = (m g a − (C/A)(C + m a²) v²/a²) λ, with A = C/2: C/A = 2 [przybylska2016].
    v = relative * math.sqrt(G * a / limit)
    square = (G / a - 2 * (share + 1) * (v / a) ** 2) / (share / 2 + 1)
    assert (square > 0) == (relative < 1)  # the limit
    rate = math.sqrt(abs(square))
    system = tr.RollingSystem(body, tr.Support(tr.Plane()))
    nudge = 1e-6
    # It also turns at 2 (v/a) λ, as it does in the growing and swaying motions: else it sways about another lean.
    start = system.place(velocity=(v, 0.0), spin=v / a * nudge, attitude=(0.0, math.pi / 2 - nudge, 0.0))
    run = tr.simulate(system, start, duration=1.0 / rate, every=0.1 / rate)
    t = run.data.time.to_numpy()
    expected = np.cosh(rate * t) if square > 0 else np.cos(rate * t)
    assert abs(lean(run) / nudge - expected).max() < 1e-8


def test_the_leaning_coin_stays_on_its_circle() -> None:
    # P² = (g/a) tan λ/((3/2) R/a − (5/4) sin λ), from Newton and Euler in the steady motion.
    run = tr.Scenario.load("coin-in-a-circle").run()
    a, R, tilt = 0.012, 0.12, math.radians(20)
    P = math.sqrt(G / a * math.tan(tilt) / (1.5 * R / a - 1.25 * math.sin(tilt)))
    t, contact = run.data.time.to_numpy(), run.data.contact.to_numpy()
    first = contact[0]
    expected = first + np.stack([R * np.sin(P * t), R * (1 - np.cos(P * t)), 0 * t], axis=1)
    assert abs(contact - expected).max() < SOLVER(1e4, 1e-15, R)
    assert abs(lean(run) - tilt).max() < SOLVER(1e4, 1e-15)
    assert run.card().passed


def test_a_fast_coin_sleeps_on_its_edge() -> None:
    # Spun about its upright diameter: λ̈ = −(P² − 4g/(5a)) λ for a disc, about a lean that the nudge shifts.
    a, P = 0.012, 40.0
    run = followed("coin-spun-on-edge", 1.0, 0.001)
    t, found = run.data.time.to_numpy(), lean(run)
    middle = 0.5 * (found.max() + found.min())
    up = np.flatnonzero((found[:-1] < middle) & (found[1:] >= middle))
    crossing = t[up] + (middle - found[up]) / (found[up + 1] - found[up]) * 0.001
    period = float(np.diff(crossing).mean())
    assert period == pytest.approx(2 * math.pi / math.sqrt(P**2 - 0.8 * G / a), rel=1e-3)  # of a sway of half a degree


def test_the_upright_coin_does_not_descend() -> None:
    # (1 + k) v̇ = g sin α cos ωt along the heading ωt [neimark1972]: a cycloid with its cusps on a level line.
    run = tr.Scenario.load("coin-upright-on-incline").run()
    omega, a, k = 16.0, 0.05, 0.5
    t = run.data.time.to_numpy()
    half = G * math.sin(SLOPE) / (1 + k) / (2 * omega**2)
    expected = np.stack([half * np.sin(omega * t) ** 2, half * (omega * t - 0.5 * np.sin(2 * omega * t)), a + 0 * t], 1)
    assert abs(run.data.position.to_numpy() - expected).max() < SOLVER(1e3, 1e-15, 0.2)
    assert abs(axis(run)[:, 2]).max() < SOLVER(1e4, 1e-15)


def test_no_spin_makes_a_free_coin_do_so() -> None:
    # Without the guide it is off by ten times the height of the arch after half a turn, however fast it spins.
    system = tr.RollingSystem(tr.Body.disc(0.05, 0.1), tr.Support(tr.Plane(), tilt=SLOPE))
    for omega in (40.0, 100.0, 300.0):
        start = system.place(spin=omega, attitude=(0.0, math.pi / 2, 0.0))
        run = tr.simulate(system, start, duration=math.pi / omega, every=math.pi / omega)
        half = G * math.sin(SLOPE) / 1.5 / (2 * omega**2)
        x, y, _ = run.data.position.to_numpy()[-1]
        assert 9 < math.hypot(x, y - half * math.pi) / half < 11


@pytest.mark.parametrize("degrees", [15, 5, 2])
def test_eulers_disc_obeys_the_law_of_its_steady_motion(degrees: float) -> None:
    # Centre at rest: P² sin θ = 4 g/a [moffatt2000], E = (3/2) m g a sin θ, and a couple −cΩ with |Ω| = P sin θ takes
    # c P² sin² θ: sin θ falls as exp(−8 c t/(3 m a²)), and P rises. All this up to a share sin² θ, by which the couple
    # also turns the disc about its own axis.
    a, m, c, theta = 0.0375, 0.4, 1e-5, math.radians(degrees)
    system = tr.RollingSystem(tr.Body.disc(a, m), tr.Support(tr.Plane()), loads=(tr.RollingCouple(c),))
    spin = math.sqrt(4 * G / a / math.sin(theta)) * math.sin(theta) ** 2
    run = tr.simulate(system, system.place(spin=spin, attitude=(0.0, theta, 0.0)), duration=8.0, every=0.002)
    t, e = run.data.time.to_numpy(), axis(run)
    sine = np.hypot(e[:, 0], e[:, 1])
    expected = math.sin(theta) * np.exp(-8 * c * t / (3 * m * a * a))
    assert sine[-1] < 0.75 * sine[0]
    assert abs(sine / expected - 1).max() < math.sin(theta) ** 2
    P = np.diff(np.unwrap(np.arctan2(e[:, 1], e[:, 0]))) / 0.002
    between = 0.5 * (sine[1:] + sine[:-1])
    assert abs(P * np.sqrt(between * a / (4 * G)) - 1).max() < 1.5 * math.sin(theta) ** 2


def space_axes(run: tr.Trajectory) -> np.ndarray:
    """The rotation matrices, (time, 3, 3)."""
    return np.array([matrix(q) for q in run.data.orientation.to_numpy()])


def spread(values: np.ndarray) -> float:
    """How far a quantity wanders, as a share of itself."""
    return float(np.ptp(values, axis=0).max() / abs(values).max())


def test_chaplygins_ball_with_upright_momentum_turns_as_a_free_body() -> None:
    # With M = JΩ + mρ×(Ω×ρ) upright [chaplygin1903], Ω is a constant times J₊⁻¹n, J₊ = J + m a²: n moves in the body as
    # the angular momentum of a free body of moments J₊ [landau1976], section 37.
    run = tr.Scenario.load("chaplygin-ball").run()
    a, m = 0.1, 0.64
    Q, Omega = space_axes(run), run.data.angular_velocity.to_numpy()
    rho = np.array([0.0, 0.0, -a])
    M = np.einsum("tij,jk,tlk,tl->ti", Q, CHAPLYGIN, Q, Omega) + m * np.cross(rho, np.cross(Omega, rho))
    assert abs(M - M[0]).max() < SOLVER(100, 1e-15, abs(M[0]).max())
    assert abs(M[0, :2]).max() < EXACT(4, M[0, 2])

    I1, I2, I3 = (mpmath.mpf(x) / 10000 for x in (84, 96, 112))
    E2, h2 = I2 * 64 + I3 * 4, (8 * I2) ** 2 + (2 * I3) ** 2  # from Ω = (0, 8, 2) in the body
    rate = mpmath.sqrt((I3 - I2) * (h2 - E2 * I1) / (I1 * I2 * I3))
    k2 = (I2 - I1) * (E2 * I3 - h2) / ((I3 - I2) * (h2 - E2 * I1))
    own = np.einsum("tji,tj->ti", Q, Omega)
    for i in range(0, len(own), 40):
        u = mpmath.ellipk(k2) + rate * float(run.data.time[i])
        expected = [
            mpmath.sqrt((E2 * I3 - h2) / (I1 * (I3 - I1))) * mpmath.ellipfun("cn", u, m=k2),
            mpmath.sqrt((E2 * I3 - h2) / (I2 * (I3 - I2))) * mpmath.ellipfun("sn", u, m=k2),
            mpmath.sqrt((h2 - E2 * I1) / (I3 * (I3 - I1))) * mpmath.ellipfun("dn", u, m=k2),
        ]
        assert abs(own[i] - np.array(expected, dtype=float)).max() < SOLVER(1e4, 1e-15, 8.0)


def test_chaplygins_ball_on_a_turntable_keeps_its_moving_energy() -> None:
    run = tr.Scenario.load("chaplygin-ball-on-turntable").run()
    m, omega = 0.64, math.pi
    Q, Omega = space_axes(run), run.data.angular_velocity.to_numpy()
    r, V = run.data.position.to_numpy(), run.data.velocity.to_numpy()
    L = np.einsum("tij,jk,tlk,tl->ti", Q, CHAPLYGIN, Q, Omega)
    energy = 0.5 * m * (V**2).sum(1) + 0.5 * (Omega * L).sum(1)
    about_axis = (m * np.cross(r, V) + L)[:, 2]
    assert spread(energy) > 0.1
    assert np.ptp(energy - omega * about_axis) < SOLVER(1e3, 1e-15, energy.max())


def jellett(run: tr.Trajectory, J: np.ndarray, offset: float, a: float) -> np.ndarray:
    """JΩ·ρ along the run, with the sphere's centre at `offset` along the body's third axis."""
    Q, Omega = space_axes(run), run.data.angular_velocity.to_numpy()
    rho = offset * Q[:, :, 2] - np.array([0.0, 0.0, a])
    return np.einsum("tij,jk,tlk,tl,ti->t", Q, J, Q, Omega, rho)


def test_rouths_sphere_keeps_the_integrals_of_jellett_and_routh() -> None:
    # [jellett1872] and [routh1905]: JΩ·ρ, and Ω·e √(J₁J₃ + m ρ·Jρ).
    run = tr.Scenario.load("routh-sphere").run()
    assert spread(jellett(run, ROUTH, 0.006, 0.02)) < SOLVER(100, 1e-15)
    Q, Omega = space_axes(run), run.data.angular_velocity.to_numpy()
    rho = 0.006 * Q[:, :, 2] - np.array([0.0, 0.0, 0.02])
    pressed = np.einsum("tij,jk,tlk,tl,ti->t", Q, ROUTH, Q, rho, rho)
    routh = (Omega * Q[:, :, 2]).sum(1) * np.sqrt(ROUTH[0, 0] * ROUTH[2, 2] + 0.02 * pressed)
    assert spread(routh) < SOLVER(100, 1e-15)
    assert spread(Q[:, 2, 2]) > 0.1  # it nods


def test_the_tippe_top_turns_over() -> None:
    run = tr.Scenario.load("tippe-top").run()
    m, a, share = 0.02, 0.02, 0.3
    over = np.arccos(axis(run)[:, 2])
    assert math.degrees(over[0]) < 6
    assert math.degrees(over[-1]) > 150
    kept = jellett(run, TIPPE, share * a, a)
    assert spread(kept) < SOLVER(1e4, 1e-15)
    # The published threshold of turning over, with 1 − α < γ = I₁/I₃ < 1 (Rauch-Wojciechowski and Rutstam, 2014).
    gamma = TIPPE[0, 0] / TIPPE[2, 2]
    assert 1 - share < gamma < 1
    assert abs(kept[0]) > math.sqrt(m * G * a**3 * TIPPE[2, 2] * share) * (1 + share) ** 2 / math.sqrt(
        1 + share - gamma
    )
    # The centre of mass rises, with energy from the spin.
    height = run.data.position.to_numpy()[:, 2]
    assert height[-1] - height[0] > 0.9 * 2 * share * a
    assert [event.kind for event in run.events] == ["grip"]


def kane_levinson(sigma: float, first: float, times: np.ndarray) -> np.ndarray:
    """Return α, β, γ, ω₁, ω₂, ω₃ of [kane1982]: third body axis down, centimetres and grams over 1000."""
    squares, inertia = np.array([400.0, 9.0, 4.0]), np.array([[2, -0.2, 0], [-0.2, 16, 0], [0, 0, 17.0]])

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        alpha, beta, w = y[0], y[1], y[3:]
        down = np.array([-math.cos(alpha) * math.sin(beta), math.sin(alpha), math.cos(alpha) * math.cos(beta)])
        length = math.sqrt(squares @ down**2)
        x = squares * down / length - np.array([0, 0, 1.0])
        down_rate = cross(down, w)
        x_rate = squares * (down_rate / length - down * (squares @ (down * down_rate)) / length**3)
        pull = 100 * G * cross(down, x) - sigma * w + cross(inertia @ w, w)
        mass = inertia + x @ x * np.eye(3) - np.outer(x, x)
        w_rate = np.linalg.solve(mass, pull + cross(x, cross(w, cross(x, w) - x_rate)))
        gamma_rate = (w[2] * math.cos(beta) - w[0] * math.sin(beta)) / math.cos(alpha)
        beta_rate = w[1] - gamma_rate * math.sin(alpha)
        return np.array([w[2] * math.sin(beta) + w[0] * math.cos(beta), beta_rate, gamma_rate, *w_rate])

    start = [math.radians(0.5), math.radians(0.5), 0.0, 0.0, 0.0, first]
    return solve_ivp(rates, (0, times[-1]), start, method="DOP853", rtol=1e-10, atol=1e-11, t_eval=times).y


@pytest.mark.parametrize(("name", "sigma"), [("rattleback", 0.0), ("rattleback-with-losses", 1.0)])
def test_the_rattleback_reverses_as_kane_and_levinsons(name: str, sigma: float) -> None:
    run = followed(name, 4.0, 0.05)
    alpha, beta, gamma, *w = kane_levinson(sigma, -5.0, run.data.time.to_numpy())
    own = np.einsum("tji,tj->ti", space_axes(run), run.data.angular_velocity.to_numpy())
    assert abs(own - np.stack([w[0], -w[1], -w[2]], axis=1)).max() < SOLVER(1e4, 1e-10, 5.0)
    assert abs(axis(run)[:, 2] - np.cos(alpha) * np.cos(beta)).max() < SOLVER(1e3, 1e-10)
    assert own[0, 2] == pytest.approx(5.0, rel=1e-12)
    assert own[-1, 2] < -1  # it has turned round
    furthest = int(np.argmin(gamma))
    assert 2.4 < run.data.time[furthest] < 3.0
    assert gamma[-1] > gamma[furthest] + 0.5  # rad


ROCKERS = {
    "rocking-half-cylinder": (0.1, 4 / (3 * math.pi), 0.5 - (4 / (3 * math.pi)) ** 2, 8 / (9 * math.pi - 16)),
    "rocking-hemisphere": (0.05, 3 / 8, 83 / 320, 15 / 26),
}  # a, d/a, I/(m a²), ω² a/g


@pytest.mark.parametrize("name", ROCKERS)
def test_the_period_of_rocking(name: str) -> None:
    # ½[I + m(a² + d² − 2 a d cos θ)] θ̇² = m g d (cos θ − cos θ₀), by quadrature.
    a, d, share, square = ROCKERS[name]

    def period(first: float) -> float:
        top = mpmath.sin(mpmath.mpf(first) / 2)

        def integrand(u: Any) -> Any:
            sine2 = (top * mpmath.sin(u)) ** 2  # sin²(θ/2)
            return mpmath.sqrt((share + 1 + d * d - 2 * d * (1 - 2 * sine2)) / (1 - sine2))

        return float(4 * mpmath.sqrt(a / (G * d)) * mpmath.quad(integrand, [0, mpmath.pi / 2]))

    assert period(1e-6) == pytest.approx(2 * math.pi / math.sqrt(square * G / a), rel=1e-10)
    expected = period(math.pi / 3)
    run = followed(name, 3 * expected, 0.25 * expected)
    height = run.data.position.to_numpy()[:, 2]
    lowest, highest = a * (1 - d), a * (1 - d / 2)
    assert abs(height[::2] - highest).max() < SOLVER(100, 1e-15, a)  # at rest at both ends, twice a period
    assert abs(height[1::2] - lowest).max() < SOLVER(100, 1e-15, a)
    assert abs(run.data.velocity.to_numpy()[::2]).max() < SOLVER(1e4, 1e-15, 1.0)


def test_the_hemisphere_tips_over_its_edge() -> None:
    run = tr.Scenario.load("rocking-hemisphere-over-its-edge").run()
    (event,) = run.events
    a, d, share = 0.05, 3 / 8, 83 / 320
    first = 0.5 / ((1 - d) * a)  # θ̇ at the bottom

    def rate(theta: Any) -> Any:
        kept = (share + (1 - d) ** 2) * first**2 - 2 * G * d / a * (1 - mpmath.cos(theta))
        return mpmath.sqrt(kept / (share + 1 + d * d - 2 * d * mpmath.cos(theta)))

    expected = mpmath.quad(lambda theta: 1 / rate(theta), [0, mpmath.pi / 2])
    assert event.kind == "edge"
    assert event.text.startswith("tipped onto the edge of its round side, which its shape does not cover at t = ")
    assert event.time == pytest.approx(float(expected), abs=SOLVER(1e4, 1e-15))


def test_a_coin_that_falls_over_lies_flat() -> None:
    """At rest at a lean θ₀ it turns about its contact: (A + ma²)θ̇²/2 = mga(sin θ₀ − sin θ), A = ma²/4."""
    a, lean = 0.012, math.radians(20)
    system = tr.RollingSystem(tr.Body.disc(a, 0.0075), tr.Support(tr.Plane()))
    run = tr.simulate(system, system.place(attitude=(0.0, lean, 0.0)), 1.0, 0.01)
    (event,) = run.events
    expected = mpmath.quad(
        lambda u: 2 * u / mpmath.sqrt(16 * G / (5 * a) * mpmath.cos(lean - u * u / 2) * mpmath.sin(u * u / 2)),
        [0, mpmath.sqrt(lean)],
    )
    assert event.kind == "edge"
    assert event.text.startswith("came to lie flat on its face, which its shape does not cover at t = ")
    # The run ends a millionth of a radian short of flat.
    assert event.time == pytest.approx(float(expected), abs=1e-6 / math.sqrt(8 * G / (5 * a) * math.sin(lean)) + 1e-9)
