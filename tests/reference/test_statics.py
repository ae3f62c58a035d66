"""Equilibria against energies written down by hand, against mpmath, and against motions that nobody linearised."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from scipy.interpolate import BarycentricInterpolator
from scipy.optimize import brentq
from tests.tolerances import SOLVER

import trundle as tr
from trundle.analysis.statics import rest
from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import ZERO, Quaternion, Vector
from trundle.mechanics.contact import contact_at, roll
from trundle.mechanics.loads import BodyMotion, Load
from trundle.solve.tracing import state_rates

G = 9.80665
A, BARE, WEIGHT, AT = 0.05, 0.3, 0.1, 0.04  # a cylinder with a weight: radius, mass, weight, its distance
M = BARE + WEIGHT
DELTA = WEIGHT * AT / M  # of the centre of mass from the axis, 10 mm
INERTIA = 0.5 * BARE * A**2 + BARE * DELTA**2 + WEIGHT * (AT - DELTA) ** 2
WEIGHTED = tr.Body.weighted_cylinder(A, BARE, WEIGHT, AT)
BALL = tr.Body.solid_sphere(radius=0.1, mass=1.0)
ECCENTRIC = tr.Body(1.0, tr.Isotropic(0.004), tr.Sphere(0.1, Vector(0.02, 0.0, 0.0)))  # centre of mass 20 mm off
CLOSE = SOLVER(100, 1e-13)  # what is integrated along a line, or comes through it
UP = "90 deg"


def on_plane(body: tr.Body, tilt: float = 0.0, **more: object) -> tr.RollingSystem:
    friction = more.pop("friction", None)
    return tr.RollingSystem(body, tr.Support(tr.Plane(), tilt=tilt, friction=friction), **more)


def in_trough(body: tr.Body, radius: float = 0.5, side: str = "inside", **more: object) -> tr.RollingSystem:
    return tr.RollingSystem(body, tr.Support(tr.Cylinder(radius, side), tilt=UP), **more)


# --- balls ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("k", [2 / 5, 2 / 3])
def test_a_ball_in_a_trough_stays_on_its_lowest_line(k: float) -> None:
    """m(1 + k) s̈ = −m g s/(b − a) for the centre's path s: it swings across, and lies anywhere along."""
    found = tr.equilibria(in_trough(tr.Body.sphere(0.1, 2.0, k)))
    (only,) = found
    assert only.stability == "stable"
    assert only.position == pytest.approx((0.0, 0.0), abs=1e-15)
    across, along, pivot = only.modes
    assert across.frequency**2 == pytest.approx(G / ((1 + k) * 0.4), rel=1e-13)
    assert (along.rate, pivot.rate) == (0, 0)
    assert only.moves[:2] == ("around the cylinder", "along its axis")
    assert only.free == ("along its axis", "in any orientation")
    assert only.dimension == 1
    assert (only.normal_force, only.friction_force) == (pytest.approx(2 * G, rel=1e-15), 0.0)
    (top,) = found.pulled  # the highest line: the energy is stationary there, but the ball would fall
    assert abs(top.position[0]) == pytest.approx(math.pi, abs=1e-12)


def test_a_ball_on_top_of_a_log_rolls_off() -> None:
    (only,) = tr.equilibria(in_trough(BALL, side="outside"))
    assert only.stability == "unstable"
    assert only.modes[0].growth ** 2 == pytest.approx(G / (1.4 * 0.6), rel=1e-13)
    assert abs(only.position[0]) == pytest.approx(math.pi, abs=1e-12)


def test_a_ball_rests_anywhere_on_a_level_table_and_nowhere_on_a_slope() -> None:
    (table,) = tr.equilibria(on_plane(BALL))
    assert (table.stability, table.dimension, table.free) == ("indifferent", 2, ("on the plane", "in any orientation"))
    slope = tr.equilibria(on_plane(BALL, tilt=0.1))
    assert len(slope) == 0
    assert f"{G * math.sin(0.1):.4g} N" in slope.reason  # m g sin α along the slope
    assert f"{100 * math.sin(0.1):.4g} mm" in slope.reason  # a sin α beside the contact


def test_a_force_up_the_slope_that_balances_makes_it_indifferent_and_a_hair_more_does_not() -> None:
    push = G * math.sin(0.1)
    hoop = tr.Body.hoop(0.1, 1.0)
    for body in (BALL, hoop):
        (held,) = tr.equilibria(on_plane(body, tilt=0.1, loads=(tr.Force((-push, 0.0, 0.0)),)))
        assert held.stability == "indifferent"
        assert held.dimension >= 1
        assert held.normal_force == pytest.approx(G * math.cos(0.1), rel=1e-14)
        assert len(tr.equilibria(on_plane(body, tilt=0.1, loads=(tr.Force((-push * (1 + 1e-9), 0.0, 0.0)),)))) == 0


def test_a_ball_with_a_heavy_side_on_a_level_table() -> None:
    """It rocks at m g δ/(I + m(a − δ)²) with the heavy side down, and tips at m g δ/(I + m(a + δ)²) with it up."""
    low, high = tr.equilibria(on_plane(ECCENTRIC))
    assert [one.stability for one in (low, high)] == ["stable", "unstable"]
    assert [one.dimension for one in (low, high)] == [3, 3]  # two to place it, one to turn it about the vertical
    for mode in low.modes[:2]:
        assert mode.frequency**2 == pytest.approx(G * 0.02 / (0.004 + 0.08**2), rel=1e-10)
    for mode in high.modes[:2]:
        assert mode.growth**2 == pytest.approx(G * 0.02 / (0.004 + 0.12**2), rel=1e-10)
    assert high.energy == pytest.approx(G * 2 * 0.02, rel=1e-12)


@pytest.mark.parametrize("tilt", [0.15, 0.25])
def test_a_ball_with_a_heavy_side_stays_on_a_slope_while_its_centre_of_mass_gets_over_the_contact(tilt: float) -> None:
    found = tr.equilibria(on_plane(ECCENTRIC, tilt=tilt))
    assert len(found) == (2 if 0.1 * math.sin(tilt) < 0.02 else 0)
    for one in found:
        away = np.subtract(one.state.position, one.contact)
        vertical = np.array([-math.sin(tilt), 0.0, math.cos(tilt)])
        np.testing.assert_allclose(np.cross(away, vertical), 0, atol=1e-12)
        assert one.friction_needed == pytest.approx(math.tan(tilt), rel=1e-11)


def test_the_modes_are_eigenvalues_of_the_whole_law() -> None:
    """In a trough a ball with a heavy side has two unlike modes: compare with the law's ten equations, in 40 digits.

    Their derivatives are differences of mpmath numbers, and nothing is projected on what rolling allows.
    """
    system = in_trough(ECCENTRIC)
    found = tr.equilibria(system)
    assert {one.stability for one in found} == {"stable", "unstable"}
    for one in found:
        state = [*one.contact, *one.state.orientation, 0.0, 0.0, 0.0]
        with mp.workdps(40):
            step = mp.mpf(10) ** -12
            columns = []
            for j in range(10):
                ends = []
                for sign in (1, -1):
                    moved = [mp.mpf(x) + (sign * step if i == j else 0) for i, x in enumerate(state)]
                    ends.append(state_rates(system, 0.0, moved))
                columns.append([float((up - down) / (2 * step)) for up, down in zip(*ends, strict=True)])
        spectrum = np.linalg.eigvals(np.array(columns).T)
        swinging = [mode for mode in one.modes if mode.rate != 0]
        assert len(swinging) == 2
        for mode in swinging:
            assert np.abs(spectrum - mode.rate).min() < 1e-7 * abs(mode.rate)


# --- a cylinder with a weight, on planes ------------------------------------------------------------------


def by_hand(tilt: float, stable: bool) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """Return roll, λ² and the energy over zero roll of a weighted cylinder on a slope, from its energy.

    With the axis at a above the slope, the weight turned by ψ from the normal and x = aψ down the slope, the centre of
    mass is δ(cos ψ n + sin ψ d) from the axis, so U = m g (δ cos(ψ + α) − a ψ sin α); and the moment of inertia about
    the contact is I + m(a² + δ² + 2 a δ cos ψ).
    """
    a, d, m, inertia, alpha = (mp.mpf(x) for x in (A, DELTA, M, INERTIA, tilt))

    def energy(psi: mp.mpf) -> mp.mpf:
        return m * G * (d * mp.cos(psi + alpha) - a * psi * mp.sin(alpha))

    lean = mp.asin(a * mp.sin(alpha) / d)  # sin(ψ + α) = −a sin α/δ
    psi = (lean - mp.pi if stable else -lean) - alpha
    about = inertia + m * (a**2 + d**2 + 2 * a * d * mp.cos(psi))
    return psi, -mp.diff(energy, psi, 2) / about, energy(psi)


@pytest.mark.parametrize("tilt", [0.0, 1e-9, 0.05, 0.15, 0.2])
def test_a_weighted_cylinder_on_a_slope(tilt: float) -> None:
    system = on_plane(WEIGHTED, tilt=tilt, friction=0.1)
    found = tr.equilibria(system, system.place(roll=-0.7))
    assert [one.stability for one in found] == ["stable", "unstable"]
    energies = []
    with mp.workdps(40):
        for one, stable in zip(found, (True, False), strict=True):
            psi, rate_squared, energy = by_hand(tilt, stable)
            turns = round((one.roll - float(psi)) / (2 * math.pi))
            assert one.roll == pytest.approx(float(psi) + 2 * math.pi * turns, abs=CLOSE * 10)
            assert one.modes[0].rate.real ** 2 - one.modes[0].rate.imag ** 2 == pytest.approx(
                float(rate_squared), rel=CLOSE * 100
            )
            whole = round((one.distance / A - 0.7 - float(psi)) / (2 * math.pi))  # it may be a turn further on
            assert one.distance == pytest.approx(A * (float(psi) + 0.7 + 2 * math.pi * whole), abs=CLOSE)
            energies.append(float(energy) - whole * 2 * math.pi * A * M * G * math.sin(tilt))
            assert one.friction_needed == pytest.approx(math.tan(tilt), rel=1e-9, abs=1e-12)
            assert one.holds == (math.tan(tilt) <= 0.1)
            assert one.normal_force == pytest.approx(M * G * math.cos(tilt), rel=1e-14)
    assert found[0].energy == 0
    assert found[1].energy == pytest.approx(energies[1] - energies[0], rel=1e-9)
    distance, energy = found.repeats
    assert distance == pytest.approx(2 * math.pi * A, rel=1e-13)
    assert energy == pytest.approx(-distance * M * G * math.sin(tilt), rel=1e-9, abs=1e-15)


def test_none_on_a_steeper_slope_and_a_ledge_on_the_steepest() -> None:
    steepest = math.asin(DELTA / A)
    assert len(tr.equilibria(on_plane(WEIGHTED, tilt=steepest - 1e-7))) == 2
    (ledge,) = tr.equilibria(on_plane(WEIGHTED, tilt=steepest))
    assert ledge.stability == "unstable"  # U falls on one side, though its second derivative vanishes
    assert ledge.roll == pytest.approx(-math.pi / 2 - steepest, abs=1e-5)  # a double root has half the digits
    none = tr.equilibria(on_plane(WEIGHTED, tilt=0.25))
    assert len(none) == 0
    assert f"{1000 * (A * math.sin(0.25) - DELTA):.4g} mm" in none.reason


@pytest.mark.parametrize("tilt", [0.0, 0.1])
def test_it_swings_as_its_linear_law_says(tilt: float) -> None:
    """The period of small swings by Taylor's method, at two amplitudes, taken to amplitude zero."""
    system = on_plane(WEIGHTED, tilt=tilt)
    low = tr.equilibria(system)[0]
    expected = 2 * math.pi / low.modes[0].frequency
    periods = []
    for amplitude in (0.005, 0.0025):
        start = system.place(roll=low.roll + amplitude)
        run = tr.simulate(system, start, duration=1.2 * expected, every=expected / 400, method="taylor").data
        t, w = run.time.values, run.angular_velocity.values[:, 1]
        i = int(np.flatnonzero((w[5:-1] > 0) & (w[6:] <= 0))[0]) + 5  # it has come back, and turns again
        near = slice(i - 5, i + 7)
        periods.append(brentq(BarycentricInterpolator(t[near], w[near]), t[i], t[i + 1], xtol=1e-14))
    assert (4 * periods[1] - periods[0]) / 3 == pytest.approx(expected, rel=1e-8)


def test_it_falls_as_its_linear_law_says() -> None:
    system = on_plane(WEIGHTED, tilt=0.1)
    high = tr.equilibria(system)[1]
    nudge, growth = 1e-6, high.modes[0].growth
    start = system.place(roll=high.roll + nudge)
    run = tr.simulate(system, start, duration=4 / growth, every=0.5 / growth, method="taylor").data
    gone = (run.position.values[:, 0] - run.position.values[0, 0]) / nudge
    # The centre of mass moves by a + δ cos ψ for each radian.
    expected = (A + DELTA * math.cos(high.roll)) * (np.cosh(growth * run.time.values) - 1)
    np.testing.assert_allclose(gone, expected, rtol=2e-4, atol=1e-8)


def test_its_state_stays_where_it_is_put() -> None:
    system = on_plane(WEIGHTED, tilt=0.1)
    low = tr.equilibria(system)[0]
    run = tr.simulate(system, low.state, duration=5.0, every=0.1).data
    assert np.abs(run.position.values - run.position.values[0]).max() < 1e-13
    again = system.place(low.position, roll=low.roll)
    np.testing.assert_allclose(again.position, low.state.position, atol=1e-15)


# --- a cylinder with a weight, in a trough ----------------------------------------------------------------


def test_a_weighted_cylinder_in_a_trough() -> None:
    """With the weight up at the bottom it falls to either side, U = m g (δ cos(φ(b − a)/a) − (b − a) cos φ)."""
    b = 0.5
    found = tr.equilibria(in_trough(WEIGHTED, b), turns=1.2)
    ratio = (b - A) / A  # the cylinder turns so much for each radian round the trough
    with mp.workdps(30):
        left = mp.findroot(lambda x: (b - A) * mp.sin(x) - DELTA * ratio * mp.sin(ratio * x), -0.2)
        for one, phi in zip(found, (left, -left, mp.mpf(0)), strict=True):
            curvature = M * G * ((b - A) * mp.cos(phi) - DELTA * ratio**2 * mp.cos(ratio * phi))
            about = INERTIA + M * (A**2 + DELTA**2 + 2 * A * DELTA * mp.cos(phi * b / A))
            assert one.position[0] == pytest.approx(float(phi), abs=CLOSE)
            squared = one.modes[0].rate.real ** 2 - one.modes[0].rate.imag ** 2
            assert squared == pytest.approx(float(-curvature / (about * ratio**2)), rel=1e-10)
            assert one.friction_needed == pytest.approx(abs(math.tan(phi)), rel=1e-10, abs=1e-13)
    assert [one.stability for one in found] == ["stable", "stable", "unstable"]
    assert found[0].energy == found[1].energy == 0


def test_a_cylinder_in_a_trough_rests_as_a_ball_does_but_for_its_inertia() -> None:
    found = tr.equilibria(in_trough(tr.Body.cylinder(0.1, 1.0)), tr.RollingSystem.place(in_trough(BALL), (0.3, 0.0)))
    assert found[0].stability == "stable"
    found = tr.equilibria(in_trough(tr.Body.hoop(0.1, 1.0)))
    (only,) = found
    assert only.modes[0].frequency ** 2 == pytest.approx(G / (2 * 0.4), rel=1e-12)
    assert only.dimension == 0


def test_a_search_from_under_a_log_finds_the_top() -> None:
    """Stationary on top: the centre of mass over the contact; it is looked for past the top from both hands."""
    system = in_trough(WEIGHTED, 0.08, side="outside")
    found = tr.equilibria(system)  # from the lowest line, under which nothing stays
    assert len(found) > 0
    for one in found:
        away = np.subtract(one.state.position, one.contact)
        np.testing.assert_allclose(np.cross(away, [1.0, 0.0, 0.0]), 0, atol=1e-12)  # gravity is along the first axis
        assert one.normal_force > 0
        assert one.contact[0] < 0


# --- loads without a potential ----------------------------------------------------------------------------


def test_still_air_moves_no_equilibrium_but_damps_the_swing() -> None:
    """(1 + k) m s̈ = −c ṡ − m g s/(b − a)."""
    (only,) = tr.equilibria(found := in_trough(BALL, loads=(tr.Drag(0.5),)))
    roots = np.roots([1.4, 0.5, G / 0.4])
    assert only.modes[0].rate == pytest.approx(roots[roots.imag > 0][0], rel=1e-12)
    assert only.energy == 0  # at rest the air does not push
    assert tr.equilibria(found).conservative


def test_a_ball_leans_on_turning_air() -> None:
    """Air at ω carries it up the slope where c ω y = m g sin α; ζ̈ = −γ(ζ̇ − iω ζ) about that place."""
    c, rate, tilt = 2.0, 1.0, 0.1
    found = tr.equilibria(on_plane(BALL, tilt=tilt, loads=(tr.Drag(c, rate),)))
    (only,) = found
    assert not found.conservative
    assert only.energy is None
    assert "no energy" in str(found)
    assert only.position == pytest.approx((0.0, G * math.sin(tilt) / (c * rate)), abs=1e-12)
    gamma = c / 1.4
    expected = np.roots([1, gamma, -1j * gamma * rate])
    for mode in only.modes[:2]:
        assert min(abs(mode.rate - np.append(expected, expected.conj()))) < 1e-11


def test_a_torque_holds_a_cylinder_on_a_slope_where_a_weight_cannot() -> None:
    """a m g sin α + m g δ sin(ψ + α) = K: with a torque that holds most of it, the weight need hold less."""
    tilt, held = 0.3, 0.9
    torque = -held * A * M * G * math.sin(tilt)
    found = tr.equilibria(on_plane(WEIGHTED, tilt=tilt, loads=(tr.Torque((0.0, torque, 0.0)),)))
    assert [one.stability for one in found] == ["stable", "unstable"]
    for one in found:
        assert math.sin(one.roll + tilt) == pytest.approx(-(1 - held) * A * math.sin(tilt) / DELTA, abs=1e-11)
    assert not found.conservative


@dataclass(frozen=True)
class Spring(Load):
    """A spring to a point of the table, F = −c(x − x₀, y − y₀, 0)."""

    stiffness: float
    x: float
    y: float

    def force(self, motion: BodyMotion) -> Vector:
        return Vector(motion.position.x - self.x, motion.position.y - self.y, 0.0) * -self.stiffness

    def potential(self, motion: BodyMotion) -> object:
        x, y = motion.position.x - self.x, motion.position.y - self.y
        return 0.5 * self.stiffness * (x * x + y * y)


def test_a_spring_holds_a_ball_and_a_weighted_cylinder() -> None:
    """On a slope the ball hangs m g sin α/c below the spring's end; c x = m g sin α for the cylinder's axis is bent."""
    c, tilt = 7.0, 0.1
    (ball,) = tr.equilibria(on_plane(BALL, tilt=tilt, loads=(Spring(c, 0.3, -0.2),)))
    assert ball.position == pytest.approx((0.3 + G * math.sin(tilt) / c, -0.2), abs=1e-12)
    for mode in ball.modes[:2]:
        assert mode.frequency**2 == pytest.approx(c / 1.4, rel=1e-12)
    found = tr.equilibria(on_plane(WEIGHTED, tilt=tilt, loads=(Spring(c, 0.0, 0.0),)), turns=2)
    assert found.repeats is None

    def energy(psi: float, first: float = A) -> float:
        x = A * psi + DELTA * math.sin(psi)  # of the centre of mass; it starts with the weight on top, at x = 0
        return M * G * ((first + DELTA * math.cos(psi)) * math.cos(tilt) - x * math.sin(tilt)) + 0.5 * c * x * x

    psi = np.linspace(-4 * np.pi, 4 * np.pi, 200001)
    U = np.array([energy(angle) for angle in psi])
    lows = psi[1:-1][(U[1:-1] < U[:-2]) & (U[1:-1] < U[2:])]
    highs = psi[1:-1][(U[1:-1] > U[:-2]) & (U[1:-1] > U[2:])]
    for kind, places in (("stable", lows), ("unstable", highs)):
        ours = sorted(one.distance / A for one in found if one.stability == kind)
        np.testing.assert_allclose(ours, places, atol=2 * (psi[1] - psi[0]))


# --- refusals and limits ----------------------------------------------------------------------------------


@pytest.mark.parametrize("motion", [tr.Spin(1.0), tr.Wobble(1.0, 0.01), tr.UnevenSpin(1.0, 0.01, 1.0)])
def test_a_moving_support_is_refused(motion: object) -> None:
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=motion))
    with pytest.raises(InvalidValueError, match=r"must be at rest for equilibria.*relative equilibrium"):
        tr.equilibria(system)


def test_a_table_that_turns_at_no_rate_is_at_rest() -> None:
    assert len(tr.equilibria(tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(0.0))))) == 1


def test_a_load_that_changes_is_refused() -> None:
    with pytest.raises(InvalidValueError, match="must be the same at all times"):
        tr.equilibria(on_plane(BALL, loads=(tr.Force(("0.1*sin(t)", 0.0, 0.0)),)))


def test_the_rim_ends_the_search() -> None:
    support = tr.Support(tr.Plane(rim=0.06), tilt=0.05)
    system = tr.RollingSystem(WEIGHTED, support)
    found = tr.equilibria(system, system.place(roll=1.2))
    assert all(math.hypot(*one.contact) < 0.06 for one in found)
    assert len(found) < 2
    assert found.repeats is None


def test_turns_are_searched_when_asked_for_and_refused_of_a_ball() -> None:
    assert len(tr.equilibria(on_plane(WEIGHTED, tilt=0.05), turns=2)) == 8
    with pytest.raises(InvalidValueError, match="`turns` belongs to a cylinder"):
        tr.equilibria(on_plane(BALL), turns=2)
    with pytest.raises(InvalidValueError, match="`turns` must be positive"):
        tr.equilibria(on_plane(WEIGHTED), turns=-1)


def test_without_gravity_everything_rests_everywhere() -> None:
    for body in (BALL, WEIGHTED):
        (only,) = tr.equilibria(on_plane(body, gravity=0.0))
        assert (only.stability, only.friction_needed) == ("indifferent", 0.0)


# --- the principle itself ---------------------------------------------------------------------------------


def test_the_work_vanishes_exactly_where_the_law_gives_no_acceleration() -> None:
    """T2 at rest is (inertia about the contact) Ω̇ = the loads' torque about the contact, at any place at all."""
    rng = np.random.default_rng(seed=28)
    for system in (on_plane(ECCENTRIC, tilt=0.2), in_trough(ECCENTRIC, loads=(tr.Torque((0.1, 0.2, 0.3)),))):
        for _ in range(5):
            p = system.support.surface.point(*rng.normal(size=2))
            q = Quaternion(*(part := rng.normal(size=4)) / np.linalg.norm(part))
            now = roll(system, 0.0, p, q, ZERO)
            rho, rate = now.contact.offset, np.array(list(now.angular_acceleration))
            r = np.array(list(rho))
            about = 0.004 * np.eye(3) + r @ r * np.eye(3) - np.outer(r, r)
            work = rest.torque_about_contact(system, 0.0, p, q)
            np.testing.assert_allclose(list(work), about @ rate, rtol=1e-12, atol=1e-14)


def test_the_work_is_the_slope_of_the_energy() -> None:
    """Along a line in a trough: the work integrated there, against the potential of each place."""
    from trundle.analysis.statics.line import roll_line

    system = in_trough(WEIGHTED, loads=(tr.Force((0.3, 0.4, 0.0)),))
    start = system.place((0.4, 0.0), roll=0.3)
    q = Quaternion(*start.orientation)
    p = contact_at(system, 0.0, Vector(0.5 * math.cos(0.4), 0.5 * math.sin(0.4), 0.0), q).point
    line = roll_line(system, 0.0, p, q, q.matrix() @ Vector(0.0, 0.0, 1.0), (3.0, 40.0))
    first = rest.potential(system, 0.0, p, q)
    for angle in np.linspace(line.low, line.high, 9):
        there = line.place(float(angle))
        assert float(line.energy(angle)) == pytest.approx(
            rest.potential(system, 0.0, *there) - first, abs=SOLVER(100, 1e-13)
        )
        assert math.hypot(there[0].x, there[0].y) == pytest.approx(0.5, abs=CLOSE)


# --- the figure -------------------------------------------------------------------------------------------


def test_the_figure_marks_each_place_and_draws_it() -> None:
    found = tr.equilibria(on_plane(WEIGHTED, tilt=0.1), title="On a slope")
    figure = found.plot()
    curve, *drawings = figure.axes
    line, marks = curve.lines[0], [line for line in curve.lines if line.get_marker() in "o^"]
    assert [mark.get_marker() for mark in marks] == ["o", "^"]
    for mark in marks:  # on the curve, at a place where it is level
        (x,), (y,) = mark.get_data()
        places, energies = line.get_data()
        assert float(np.interp(x, places, energies)) == pytest.approx(float(y), abs=1e-2 * np.ptp(energies))
    assert len(drawings) == len(found)
    for ax in drawings:
        assert ax.get_aspect() == 1.0
        assert {"m g", "N", "f"} <= {text.get_text() for text in ax.texts}
    assert figure.texts[0].get_text() == "On a slope"


@pytest.mark.parametrize(
    "system",
    [
        on_plane(BALL, tilt=0.1),
        on_plane(BALL),
        on_plane(ECCENTRIC),
        on_plane(WEIGHTED, loads=(tr.Torque((0.0, 0.01, 0.0)),)),
        on_plane(BALL, loads=(tr.Torque((0.0, 0.0, 0.01)),)),
        on_plane(WEIGHTED, gravity=0.0),
    ],
)
def test_every_outcome_has_a_figure_and_words(system: tr.RollingSystem, tmp_path: Path) -> None:
    found = tr.equilibria(system)
    found.plot().savefig(tmp_path / "figure.png")
    assert (tmp_path / "figure.png").stat().st_size > 10_000
    assert str(found).splitlines()[-1].startswith("searched: ")
