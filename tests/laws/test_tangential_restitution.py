"""Landings that give slip back: Garwin's and Cross's balls, and what holds for any body.

The balls are held to conservation laws solved in whole fractions, and to Cross's formulas; other bodies to the inertia
seen at the contact, worked out here with NumPy, and to mpmath.
"""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Matrix, Quaternion, Vector
from trundle.mechanics.contact import contact_at
from trundle.mechanics.impact import Impact, _Course, land
from trundle.solve import transitions
from trundle.solve.contact_state import ContactState
from trundle.verify.course import Course
from trundle.verify.landings import Landing

Array = Any
STILL = Quaternion(1.0, 0.0, 0.0, 0.0)
RADIUS = 0.025


def floor(body: tr.Body, e: float, e_t: float, friction: float | None = None) -> tr.RollingSystem:
    support = tr.Support(tr.Plane(), friction=friction, restitution=e, tangential_restitution=e_t)
    return tr.RollingSystem(body, support)


def sphere(k: float = 0.4) -> tr.Body:
    return tr.Body.sphere(RADIUS, 0.07, k)


def bounced(system: tr.RollingSystem, V: tuple[float, ...], Omega: tuple[float, ...]) -> tuple[Array, Array]:
    """Return V and Ω of a ball after a landing."""
    contact = contact_at(system, 0.0, Vector(0.0, 0.0, 0.0), STILL)
    struck = land(system, contact, STILL, contact.slip_velocity(Vector(*V), Vector(*Omega)))
    return (Vector(*V) + struck.velocity_change).array(), (Vector(*Omega) + struck.angular_velocity_change).array()


# --- balls ------------------------------------------------------------------------------------------------------


def garwin(k: Fraction, V: Fraction, C: Fraction) -> tuple[Fraction, Fraction]:
    """Return V and C = aΩ_y after a bounce that keeps energy and the angular momentum about the contact.

    V − V' = k(C' − C) and V² − V'² = k(C'² − C²), so that V + V' = C + C': the slip V − C changes its sign.
    """
    # From the first, V' + kC' = V + kC; from the second, V' − C' = C − V.
    Vnew = ((V + k * C) + k * (C - V)) / (1 + k)
    return Vnew, Vnew + V - C


@pytest.mark.parametrize("k", [Fraction(2, 5), Fraction(2, 3), Fraction(1, 4)])
@pytest.mark.parametrize(("V", "C"), [(1, -3), (2, 0), (0, 5), (-1, -1), (3, 3)])
def test_garwins_superball_keeps_energy_and_turns_its_slip_round(k: Fraction, V: int, C: int) -> None:
    wanted = garwin(k, Fraction(V), Fraction(C))
    assert k * C**2 + V**2 == k * wanted[1] ** 2 + wanted[0] ** 2
    after, turning = bounced(floor(sphere(float(k)), 1.0, 1.0), (V, 0.0, -2.0), (0.0, C / RADIUS, 7.0))
    assert np.abs(after - [float(wanted[0]), 0.0, 2.0]).max() <= EXACT(16, 5.0)
    assert np.abs(turning - [0.0, float(wanted[1]) / RADIUS, 7.0]).max() <= EXACT(16, 5.0 / RADIUS)
    assert garwin(k, *wanted) == (V, C)  # the second bounce undoes the first


def test_a_superball_thrown_under_a_table_comes_back() -> None:
    # Floor, underside of the table, floor (Garwin 1969): a solid ball without spin comes back with 333/343 of V.
    V, C = Fraction(1), Fraction(0)
    for side in (1, -1, 1):
        V, turned = garwin(Fraction(2, 5), V, side * C)
        C = side * turned
    assert 343 * V == -333
    rough = floor(sphere(), 1.0, 1.0)
    v, omega = np.array([1.0, 0.0, -3.0]), np.zeros(3)
    for side in (1.0, -1.0, 1.0):
        # Seen in a mirror that lies level, the underside is a floor: V_z changes its sign, and so do Ω_x and Ω_y.
        mirror = np.array([1.0, 1.0, side])
        v, omega = bounced(rough, tuple(mirror * v), tuple(side * mirror * omega))
        v, omega = mirror * v, side * mirror * omega
    assert np.abs(v - [float(V), 0.0, 3.0]).max() <= EXACT(64, 3.0)
    assert abs(omega[1] - float(C) / RADIUS) <= EXACT(64, 3.0 / RADIUS)


@pytest.mark.parametrize("e_t", [0.0, 0.24, 0.76, 1.0])
@pytest.mark.parametrize("k", [0.4, 0.55])
@pytest.mark.parametrize(("V", "C"), [(2.0, 0.0), (1.0, -4.0), (-0.5, 2.0), (3.0, 2.9)])
def test_a_ball_that_grips_follows_cross(k: float, e_t: float, V: float, C: float) -> None:
    # Cross (2002) has e_x = −(V' − C')/(V − C), and the angular momentum about the contact: V' + kC' = V + kC.
    after, turning = bounced(floor(sphere(k), 0.7, e_t, friction=3.0), (V, 0.0, -6.0), (0.0, C / RADIUS, 0.0))
    assert abs(after[0] - ((1 - k * e_t) * V + k * (1 + e_t) * C) / (1 + k)) <= EXACT(32, 5.0)
    assert abs(turning[1] * RADIUS - ((1 + e_t) * V + (k - e_t) * C) / (1 + k)) <= EXACT(32, 5.0)
    assert abs(after[2] - 0.7 * 6.0) <= EXACT(32, 5.0)


@pytest.mark.parametrize("e_t", [0.3, 1.0])
@pytest.mark.parametrize(("friction", "e"), [(0.05, 0.0), (0.2, 0.6), (0.2, 1.0)])
def test_a_ball_for_which_friction_is_too_weak_slips_through(friction: float, e: float, e_t: float) -> None:
    # μ(1 + e)|V_z| is what friction can give each unit of mass; beyond (1 + e_t) s/(1 + 1/k) it is not asked for.
    slip = np.array([3.0, -4.0])
    after, _ = bounced(floor(sphere(), e, e_t, friction), (*slip, -2.0), (0.0, 0.0, 0.0))
    given = min(friction * (1 + e) * 2.0, (1 + e_t) * 5.0 * 2 / 7)
    assert np.abs(after[:2] - slip * (1 - given / 5.0)).max() <= EXACT(32, 5.0)


@pytest.mark.parametrize("method", ["auto", "taylor", "runge-kutta"])
def test_a_superball_that_is_let_go_on_jumps_back_and_forth(method: str) -> None:
    # Each bounce undoes the one before: V is V₀, then V₀ − (4/7) s, then V₀ again, for ever (Garwin 1969).
    system = floor(sphere(), 1.0, 1.0, friction=2.0)
    start = system.place((0, 0), velocity=(1.0, 0.5, 0.0), angular_velocity=(3.0, -100.0, 40.0), height=0.3)
    run = tr.simulate(system, start, duration=2.5, every=0.01, method=method)
    slip = np.array([1.0 + 100.0 * RADIUS, 0.5 + 3.0 * RADIUS])
    back, fall = np.array([1.0, 0.5]) - 4 / 7 * slip, math.sqrt(2 * 0.3 / 9.80665)
    assert [event.kind for event in run.events] == ["land"] * 5
    for n, event in enumerate(run.events):
        assert abs(event.time - (2 * n + 1) * fall) <= SOLVER(1e3, 1e-13)
        assert np.abs(np.array(event.after.velocity[:2]) - ([1.0, 0.5] if n % 2 else back)).max() <= SOLVER(1e4, 1e-14)
    t = run.data.time.values
    bounces = np.floor((t / fall + 1) / 2)
    forth, jumped = np.ceil(bounces / 2), np.floor(bounces / 2)  # whole flights with back, with V₀ after the first
    since = t - np.where(bounces > 0, (2 * bounces - 1) * fall, 0.0)
    for i, v0 in enumerate((1.0, 0.5)):
        whole = np.where(bounces > 0, v0 * fall, 0.0) + 2 * fall * (back[i] * (forth - bounces % 2) + v0 * jumped)
        whole -= np.where((bounces > 0) & (bounces % 2 == 0), 2 * fall * v0, 0.0)
        x = whole + np.where(bounces % 2, back[i], v0) * since
        assert np.abs(run.data.position.values[:, i] - x).max() <= SOLVER(1e4, 1e-13)
    assert run.card().passed


def test_what_stays_on_a_support_that_lets_nothing_slip_keeps_no_slip() -> None:
    system = floor(sphere(), 0.0, 1.0)
    run = tr.simulate(system, system.place(velocity=(1.0, 0.0), height=0.1), duration=0.5, every=0.1)
    assert [event.kind for event in run.events] == ["land"]
    assert run.data.phase[-1] == 0
    assert np.abs(run.data.velocity.values[-1] - [5 / 7, 0, 0]).max() <= EXACT(16, 1.0)
    assert run.card().passed


def test_what_stays_and_may_slip_slips_back() -> None:
    system = floor(sphere(), 0.0, 0.5, friction=1.5)
    start = system.place(velocity=(1.0, 0.0, -1.0), angular_velocity=(0, 0, 0))
    run = tr.simulate(system, start, duration=0.5, every=0.1)
    assert [event.kind for event in run.events] == ["land", "grip"]
    # Friction turns it by s/(1 + 1/k) in all, however the slip came to an end.
    assert abs(run.events[0].after.velocity[0] - (1 - 1.5 * 2 / 7)) <= EXACT(16, 1.0)
    assert np.abs(run.data.velocity.values[-1] - [5 / 7, 0, 0]).max() <= SOLVER(1e3, 1e-13)


@pytest.mark.parametrize(
    ("e", "e_t", "down", "tilt"), [(0.3, 1.0, 0.01, 0.0), (0.6, 0.8, 1.0, 20.0), (0.6, 1.0, 0.1, 20.0)]
)
def test_where_slip_given_back_would_leave_a_bounce_to_be_cut_none_is(
    e: float, e_t: float, down: float, tilt: float
) -> None:
    support = tr.Support(tr.Plane(), tilt=f"{tilt} deg", restitution=e, tangential_restitution=e_t)
    system = tr.RollingSystem(tr.Body.ellipsoid((0.05, 0.04, 0.03), 1.0), support)
    start = system.place((0.0, 0.0), (0.3, 0.1, -down), angular_velocity=(3.0, -5.0, 2.0), height=1e-9)
    run = tr.simulate(system, start, duration=0.5, every=0.05)
    landings = [Landing(system, event) for event in run.events if event.kind == "land"]
    along = [np.linalg.norm(landing.goes - landing.n * (landing.goes @ landing.n)) for landing in landings]
    assert min(along) <= EXACT(64, 1.0)  # one bounce leaves no slip: by e alone it is not too low
    assert run.events[-1].kind == "settle"
    assert run.card().passed, str(run.card())


# --- any body ---------------------------------------------------------------------------------------------------


def bodies(rng: np.random.Generator) -> tuple[tr.Body, Quaternion]:
    """Return an ellipsoid or an uneven ball, turned anyhow."""
    q = rng.normal(size=4)
    turned = Quaternion(*map(float, q / np.linalg.norm(q)))
    a, b, c = map(float, 0.1 * 10 ** rng.uniform(-0.5, 0.5, 3))
    if rng.random() < 0.5:
        return tr.Body.ellipsoid((a, b, c), 2.0), turned
    off = tuple(map(float, 0.03 * rng.uniform(-1, 1, 3)))
    return tr.Body.eccentric_sphere(0.1, 2.0, [5e-3, 6e-3, 7e-3], off), turned


def struck(body: tr.Body, q: Quaternion, slip: Array, e: float, e_t: float, mu: float | None) -> tuple[Impact, Array]:
    """Return what a landing does, and M, from the inertia tensor and ρ with NumPy."""
    system = floor(body, e, e_t, mu)
    contact = contact_at(system, 0.0, Vector(0.0, 0.0, 0.0), q)
    x, y, z = contact.offset.array()
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    J = np.array([list(row) for row in body.inertia_in_space(q.matrix()).rows])
    M = np.eye(3) / body.mass - cross @ np.linalg.solve(J, cross)
    return land(system, contact, q, Vector(*map(float, slip))), M


@pytest.mark.parametrize("e_t", [0.2, 1.0])
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("mu", [None, 0.05, 0.4, 1.5])
def test_no_landing_makes_energy_pulls_or_leaves_the_cone(mu: float | None, e: float, e_t: float) -> None:
    rng = np.random.default_rng(seed=12)
    reversed_, limited = 0, 0
    for _ in range(30):
        body, q = bodies(rng)
        slip = np.array([*rng.normal(size=2), -rng.exponential()])
        try:
            found, M = struck(body, q, slip, e, e_t, mu)
        except tr.SolverError:  # it jams, which has nothing to do with slip that comes back
            continue
        P = found.impulse.array()
        after, scale = slip + M @ P, np.linalg.norm(slip)
        plain, _ = struck(body, q, slip, e, 0.0, mu)
        left = slip + M @ plain.impulse.array()
        energy = [0.5 * s @ np.linalg.solve(M, s) for s in (slip, left, after)]
        assert energy[1] - SOLVER(1e2, 1e-12, energy[0]) <= energy[2] <= energy[0] + SOLVER(1e2, 1e-12, energy[0])
        assert P[2] >= -SOLVER(1, 1e-12, scale)
        assert mu is None or np.hypot(*P[:2]) <= mu * P[2] + SOLVER(10, 1e-10, scale * body.mass)
        assert after[2] >= -SOLVER(10, 1e-10, scale)
        back = np.linalg.solve(M[:2, :2], slip[:2])
        assert np.linalg.norm(np.cross(P - plain.impulse.array(), [*back, 0.0])[2]) <= SOLVER(10, 1e-10, scale)
        reversed_ += bool((after - left)[:2] @ slip[:2] < -1e-3)
        limited += bool(abs(after[2] - left[2]) > 1e-3)
    assert mu == 0.05 or (reversed_ > 3 and limited > 3)  # the cases do ask for it


def test_a_wholly_elastic_landing_turns_all_of_the_slip_round_whatever_the_body() -> None:
    # Without limit to friction and with e = e_t = 1, P = −2M⁻¹s and s' = −s: Garwin's rule with a matrix.
    rng = np.random.default_rng(seed=3)
    met = 0
    for _ in range(60):
        body, q = bodies(rng)
        slip = np.array([*rng.normal(size=2), -1.0])
        found, M = struck(body, q, slip, 1.0, 1.0, None)
        with mpmath.workdps(40):
            P = -2 * mpmath.lu_solve(mpmath.matrix(M.tolist()), mpmath.matrix(slip.tolist()))
            along = mpmath.lu_solve(mpmath.matrix(M[:2, :2].tolist()), mpmath.matrix(slip[:2].tolist()))
            lifted = slip[2] - (mpmath.matrix(M[2:, :2].tolist()) * along)[0] >= 0  # by friction alone
        if lifted:
            continue  # −2M⁻¹s would have the support pull
        met += 1
        assert np.abs(found.impulse.array() - np.array([float(p) for p in P])).max() <= SOLVER(1e3, 1e-13)
    assert met > 20


def leaning(angle: float) -> tuple[tr.Body, Quaternion]:
    """Return an ellipsoid turned about the second axis."""
    body = tr.Body(2.0, tr.Principal(0.04, 0.05, 0.03), tr.Ellipsoid(0.3, 0.2, 0.1))
    return body, Quaternion(math.cos(angle / 2), 0.0, math.sin(angle / 2), 0.0)


@pytest.mark.parametrize("across", [0.7, -0.7])
@pytest.mark.parametrize(("e", "e_t"), [(0.0, 0.5), (0.3, 0.9), (0.9, 0.3), (0.5, 0.5)])
def test_a_leaning_body_whose_slip_comes_back(across: float, e: float, e_t: float) -> None:
    # In a plane, without limit to friction: energy is ½s_t²/M_tt + ½c y² with y = s_n − s_t M_nt/M_tt, of
    # which friction alone changes the first and a push along n, with friction that holds, the second.
    found, M = struck(*leaning(0.4), np.array([across, 0.0, -2.0]), e, e_t, None)
    after = np.array([across, 0.0, -2.0]) + M @ found.impulse.array()
    ratio, c = M[0, 2] / M[0, 0], np.linalg.inv(M)[2, 2]
    y = -2.0 - across * ratio
    assert y < 0
    if -e * y - e_t * across * ratio >= 0:
        wanted = np.array([-e_t * across, 0.0, -e * y - e_t * across * ratio])
    else:  # it would press the body on: the support holds it at s_n = 0, and does no work
        energy = 0.5 * c * (e * y) ** 2 + 0.5 * (e_t * across) ** 2 / M[0, 0]
        wanted = np.array([-math.copysign(math.sqrt(2 * energy / np.linalg.inv(M)[0, 0]), across), 0.0, 0.0])
    assert np.abs(after - wanted).max() <= SOLVER(10, 1e-13)


@pytest.mark.parametrize(("mu", "across", "e"), [(0.8, 0.2, 0.0), (1.0, 0.5, 0.1), (1.2, 1.0, 0.1), (1.2, 2.0, 0.0)])
def test_what_comes_back_is_no_more_than_friction_left_unused(mu: float, across: float, e: float) -> None:
    # Slip ends after P₁ at μ for each unit of P; from there on friction holds with h = M_nt/M_tt, and leaves μ − h.
    plain, M = struck(*leaning(0.4), np.array([across, 0.0, -2.0]), e, 0.0, mu)
    found, _ = struck(*leaning(0.4), np.array([across, 0.0, -2.0]), e, 1.0, mu)
    h = abs(M[0, 2] / M[0, 0])
    held = plain.impulse.z - across / (mu * M[0, 0] - M[0, 2])
    back = found.impulse - plain.impulse
    assert held > 0
    assert h < mu
    assert back.z > 0 > back.x  # it is pressed on, and the support holds against it
    assert abs(-back.x - (mu - h) * held - mu * back.z) <= SOLVER(1, 1e-13)


@pytest.mark.parametrize("e", [0.0, 0.4])
@pytest.mark.parametrize("mu", [None, 0.1, 0.6])
def test_a_landing_changes_little_where_the_body_or_its_slip_changes_little(mu: float | None, e: float) -> None:
    def answer(lean: float, slip: tuple[float, float]) -> Array:
        return struck(*leaning(lean), np.array([*slip, -2.0]), e, 0.8, mu)[0].impulse.array()

    tiny = 1e-9
    for lean, slip in ((0.0, (1.0, 0.4)), (0.3, (0.0, 0.0)), (0.3, (0.0, 0.5)), (0.0, (0.0, 0.0))):
        near = [answer(lean + sign * tiny, (slip[0] + turn * tiny, slip[1])) for sign in (-1, 0, 1) for turn in (-1, 1)]
        assert np.ptp(near, axis=0).max() <= SOLVER(1e3, 1e-9)


@pytest.mark.parametrize("mu", [None, 0.12, 0.5, 2.0])
def test_what_comes_all_but_straight_down_gets_no_more_slip_back_than_it_had(mu: float | None) -> None:
    rng = np.random.default_rng(seed=1)
    for count in range(20):
        A, (e, e_t) = rng.normal(size=(3, 3)), rng.uniform(size=2)
        M = A @ A.T + 0.3 * np.eye(3)
        if count % 2:  # a body symmetric about a plane
            M[1, 0] = M[0, 1] = M[1, 2] = M[2, 1] = 0.0
        rows, answers = Matrix(*(Vector(*row) for row in M.tolist())), []
        for size in (0.0, 1e-300, 1e-17, 1e-10):
            slip = np.array([0.6 * size, -0.8 * size, -2.0])
            P = _Course(rows, math.inf if mu is None else mu, e, e_t, Vector(*slip.tolist())).impulse().array()
            assert np.abs(P - Course(M, mu, e, slip, e_t).impulse()).max() <= SOLVER(10, 1e-12, np.abs(P).max())
            answers.append(P)
            assert np.abs(P - answers[0]).max() <= SOLVER(10, 1e-13 + size, np.abs(P).max())


def test_a_tangential_restitution_is_a_share() -> None:
    with pytest.raises(tr.InvalidValueError, match=r"`tangential_restitution` must lie in \[0, 1\].*1\.5"):
        tr.Support(tr.Plane(), tangential_restitution=1.5)
    with pytest.raises(tr.InvalidValueError, match=r"`tangential_restitution` must not be negative.*-1"):
        tr.Support(tr.Plane(), tangential_restitution=-1)


@pytest.mark.parametrize("friction", [None, 2.8])
def test_rounding_does_not_decide_whether_a_body_that_is_pressed_down_by_its_friction_bounces(
    friction: float | None,
) -> None:
    # What gives the slip back may press an egg onto the floor: it comes off with no speed, and what pulls it decides.
    pressed = 0
    for seed in range(130):
        drawn = np.random.default_rng(seed)
        egg = tr.Body.ellipsoid(tuple(drawn.uniform(0.05, 0.2, 3)), mass=1.0)
        shares = {"restitution": drawn.choice([0.0, 0.02, 0.3]), "tangential_restitution": drawn.uniform(0.1, 1.0)}
        slips = tr.RollingSystem(egg, tr.Support(tr.Plane(), friction=1.0, **shares))
        turned, speeds, spins = drawn.normal(size=4), drawn.normal(size=3), drawn.normal(size=3)
        velocity = (3 * speeds[0], 3 * speeds[1], -0.3 * abs(speeds[2]))
        start = slips.place(
            orientation=turned / np.linalg.norm(turned), velocity=velocity, angular_velocity=tuple(20 * spins)
        )
        system = replace(slips, support=replace(slips.support, friction=friction))
        outcomes = []
        for _ in range(6):
            V, Omega = (tuple(v * (1 + 1e-15 * drawn.normal(size=3))) for v in (start.velocity, start.angular_velocity))
            outcomes.append(what_follows(system, replace(start, velocity=V, angular_velocity=Omega)))
        first, *rest = outcomes
        for kinds, moves in rest:
            assert kinds == first[0], seed
            np.testing.assert_allclose(moves, first[1], rtol=0.0, atol=1e-10, err_msg=str(seed))
        pressed += first[0] == ["land"]
    assert pressed > 50


def what_follows(system: tr.RollingSystem, start: tr.State) -> tuple[list[str], list[float]]:
    """Return the events of a landing, and V and aΩ after it."""
    at = ContactState.of(system, start)
    try:
        follows = transitions._struck(system, at)
    except tr.SolverError as error:
        return [str(error)], []
    after = follows.law.unpack(system, follows.time, follows.state_vector)
    return [event.kind for event in follows.events], [*after.V, *(after.Omega * at.arm)]
