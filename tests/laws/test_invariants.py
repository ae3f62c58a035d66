"""First integrals: what is named stays constant, what is not named does not, and in the named phases only."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.tolerances import SOLVER

import trundle as tr
from trundle.mechanics.algebra import Vector
from trundle.mechanics.invariants import FLIGHT, INVARIANTS, ROLLING, SLIPPING, Record, invariants_of
from trundle.mechanics.invariants.revolution import _Meridian
from trundle.mechanics.loads import PivotFriction, RollingCouple
from trundle.mechanics.symmetry import ball_of, keeps_axis
from trundle.solve.laws import FlightLaw, RollingLaw, SlippingLaw
from trundle.solve.methods import Method
from trundle.solve.samples import Samples
from trundle.verify.integrals import drifts

NAMED = {integral.name: integral for integral in INVARIANTS}
ENERGY, MOVING, SPIN = "energy", "moving energy", "spin about the normal"
NORMAL, ABOUT = "angular momentum about the normal", "angular momentum about the contact"
JELLETT, ROUTH, PAIR = "integral of Jellett", "integral of Routh", "pair of linear integrals of Routh"
WITH_TABLE, TABLE_MOMENTUM = "energy with the table", "angular momentum with the table"
FREE = "angular momentum about the centre of mass"

BALL = tr.Body.solid_sphere(0.025, 0.065)
CHAPLYGIN = tr.Body(0.065, tr.Principal(1.6e-5, 1.7e-5, 1.8e-5), tr.Sphere(0.025))
OFF_CENTRE = tr.Sphere(0.025, Vector(0.0, 0.0, 0.004))
TOP = tr.Body(0.065, tr.Principal(1.6e-5, 1.6e-5, 1.2e-5), OFF_CENTRE)  # Routh's sphere, the tippe top's shape
LOPSIDED = tr.Body(0.065, tr.Principal(1.6e-5, 1.5e-5, 1.2e-5), OFF_CENTRE)
EGG = tr.Body(0.065, tr.Principal(1.6e-5, 1.6e-5, 1.2e-5), tr.Ellipsoid(0.025, 0.025, 0.03))
TURN, TILTED = tr.Spin(2.0), (0.9, 0.3, 0.2, 0.1)


def system_of(
    body: tr.Body, surface: Any = None, motion: Any = None, loads: Any = (), tilt: float = 0.0, **support: Any
) -> tr.RollingSystem:
    return tr.RollingSystem(body, tr.Support(surface or tr.Plane(), motion or tr.Fixed(), tilt, **support), loads)


def start_of(system: tr.RollingSystem, **start: Any) -> tr.State:
    """A start on a support that turns as this one does at first; a free axle has its own coordinates besides."""
    motion = system.support.motion
    still = (
        replace(system, support=replace(system.support, motion=tr.Spin(motion.mean_rate)))
        if motion.coordinates
        else system
    )
    given_ = {"position": (0.1, 0.03), "velocity": (0.05, 0.2), "spin": 2.0, "orientation": TILTED} | start
    return replace(still.place(**given_), support=motion.initial_coordinates())


def followed(law: Any, system: tr.RollingSystem, start: tr.State, duration: float) -> Samples:
    """The motion of one phase by SciPy, whatever its end."""
    from scipy.integrate import solve_ivp

    times = np.linspace(0.0, duration, 41)
    done = solve_ivp(
        lambda t, y: law.rates(system, t, list(y)),
        (0.0, duration),
        law.pack(system, start),
        method="DOP853",
        rtol=1e-12,
        atol=1e-14,
        t_eval=times,
    )
    return law.record(system, times, done.y.T)


def ran(system: tr.RollingSystem, duration: float = 2.0, **start: Any) -> Samples:
    pytest.importorskip("heyoka")
    run = tr.simulate(system, start_of(system, **start), duration=duration, every=duration / 80, method="taylor")
    return run.samples


def drift(name: str, system: tr.RollingSystem, at: Samples) -> float:
    """How much an integral changes, beside its largest term."""
    terms = NAMED[name].terms(system, Record(at.motion(system), Vector.of(at.contact), at.support_columns))
    rows = [term.array() if isinstance(term, Vector) else np.asarray(term, dtype=float) for term in terms]
    size = max(float(np.abs(row).max()) for row in rows)
    total = sum(rows[1:], rows[0])
    change = float(np.abs(total - total[0]).max())
    return change / size if change else 0.0


def named(system: tr.RollingSystem, *phases: str) -> set[str]:
    return {integral.name for integral in invariants_of(system, phases or (ROLLING,))}


def turned(at: Samples) -> float:
    return 1 + float(np.linalg.norm(at.angular_velocity, axis=1).max() * at.time[-1])


# What has which, and a neighbour that lacks it: the same but for one thing.
ROUND = {"position": (0.1, 0.03)}
ON_WALL = {"position": (0.3, 0.0), "velocity": (0.4, 0.1)}
HAVE: dict[str, tuple[tr.RollingSystem, set[str], dict[str, Any]]] = {
    "ball on a turntable": (system_of(BALL, motion=TURN), {MOVING, SPIN, ABOUT}, ROUND),
    "ball on an uneven turntable": (system_of(BALL, motion=tr.UnevenSpin(2.0, 0.3, 3.0)), {SPIN, ABOUT}, ROUND),
    "ball on a wobbling turntable": (system_of(BALL, motion=tr.Wobble(2.0, 0.05)), set(), ROUND),
    "ball on a tilted turntable": (system_of(BALL, motion=TURN, tilt=0.05), {SPIN}, ROUND),
    "Chaplygin's ball": (system_of(CHAPLYGIN), {ENERGY, NORMAL, ABOUT}, ROUND),
    "Chaplygin's ball on a turntable": (system_of(CHAPLYGIN, motion=TURN), {MOVING, NORMAL, ABOUT}, ROUND),
    "Chaplygin's ball on a slope": (system_of(CHAPLYGIN, tilt=0.1), {ENERGY, NORMAL}, ROUND),
    "Routh's sphere": (system_of(TOP), {ENERGY, JELLETT, ROUTH}, ROUND),
    "Routh's sphere on a tilted turntable": (system_of(TOP, motion=TURN, tilt=0.05), {JELLETT}, ROUND),
    "Routh's sphere in a bowl": (system_of(TOP, tr.Bowl(0.3)), {ENERGY}, ROUND),
    "lopsided sphere": (system_of(LOPSIDED), {ENERGY}, ROUND),
    "egg": (system_of(EGG), {ENERGY}, ROUND),
    "ball in a bowl": (system_of(BALL, tr.Bowl(0.3)), {ENERGY, PAIR}, ROUND),
    "ball in a turning paraboloid": (system_of(BALL, tr.Paraboloid(0.3), TURN), {MOVING, PAIR}, ROUND),
    "ball on a tilted paraboloid": (system_of(BALL, tr.Paraboloid(0.3), tilt=0.05), {ENERGY}, ROUND),
    "ball in a turning elliptic bowl": (system_of(BALL, tr.EllipsoidalBowl((0.3, 0.4, 0.2)), TURN), {MOVING}, ROUND),
    "ball in a turning upright cylinder": (system_of(BALL, tr.Cylinder(0.3), TURN), {MOVING, PAIR}, ON_WALL),
    "Chaplygin's ball in a paraboloid": (system_of(CHAPLYGIN, tr.Paraboloid(0.3)), {ENERGY}, ROUND),
}


@pytest.mark.parametrize("name", HAVE)
def test_what_is_named_is_constant_and_what_is_not_is_not(name: str) -> None:
    system, wanted, start = HAVE[name]
    assert named(system) == wanted
    at = ran(system, **start)
    for integral in wanted:
        assert drift(integral, system, at) <= SOLVER(10 * turned(at), 1e-15), integral
    ball = ball_of(system.body)
    steady = system.support.motion.steady_rate is not None
    others = {ENERGY, MOVING} if steady else {ENERGY}
    others |= {NORMAL, ABOUT} if ball is not None and ball.concentric else set()
    others |= {JELLETT} if ball is not None and not ball.concentric else set()
    others |= {ROUTH} if ball is not None and ball.axis is not None else set()
    others |= {PAIR} if system.body.is_isotropic_sphere and steady else set()
    if system.body.is_isotropic_sphere and isinstance(system.support.surface, tr.Plane):
        others -= {NORMAL, PAIR}  # the spin in other words, and on the plane the circle
    if steady and float(system.support.motion.steady_rate or 0.0) == 0.0:
        others -= {MOVING}
    if isinstance(system.support.surface, tr.Cylinder):
        others -= {ENERGY, NORMAL}  # in an upright one V_φ and Ω_z are constant by themselves, by the pair
    for integral in others - wanted:
        assert drift(integral, system, at) > 1e-5, integral


def test_two_integrals_of_one_system_say_more_than_the_energy() -> None:
    # Each system of Routh's has as many integrals as make it solvable: three numbers of its five-dimensional motion.
    assert {ENERGY, JELLETT, ROUTH} <= named(system_of(TOP))
    assert {ENERGY, PAIR} <= named(system_of(BALL, tr.Bowl(0.3)))


# --- loads ----------------------------------------------------------------------------------------------

PLAIN = {ENERGY, SPIN, ABOUT}


@pytest.mark.parametrize(
    ("load", "kept"),
    [
        (tr.Force((0.0, 0.0, -0.2)), PLAIN),
        (tr.Force((0.01, 0.0, 0.0)), {ENERGY, SPIN}),
        (tr.Force(("0.01*sin(t)", 0.0, 0.0)), {SPIN}),
        (tr.Torque((1e-4, 0.0, 0.0)), {SPIN}),
        (tr.Torque((0.0, 0.0, 1e-5)), set()),
        (tr.Drag(0.01), {SPIN}),
        (RollingCouple(1e-6), set()),
        (PivotFriction(1e-4), set()),
    ],
)
def test_loads(load: Any, kept: set[str]) -> None:
    system = system_of(BALL, loads=(load,))
    assert named(system) == kept
    at = followed(RollingLaw(), system, start_of(system), 1.0)
    for name in PLAIN:
        if name in kept:
            assert drift(name, system, at) <= SOLVER(20 * turned(at), 1e-12), name
        elif name != ENERGY or load.at_contact:  # the others have no potential to look at
            assert drift(name, system, at) > 1e-6, name


def test_jellett_asks_only_for_no_torque() -> None:
    # Drag on the centre of mass, a slope and a shaken table leave it alone; a torque does not.
    shaken = tr.Combined((tr.Shake((0.01, 0.0, 0.005), 9.0), tr.Spin(2.0)))
    system = system_of(TOP, motion=shaken, loads=(tr.Drag(0.05),), tilt=0.1)
    assert named(system) == {JELLETT}
    at = followed(RollingLaw(), system, start_of(system), 1.0)
    assert drift(JELLETT, system, at) <= SOLVER(20 * turned(at), 1e-12)
    twisted = system_of(TOP, loads=(tr.Torque((0.0, 0.0, 1e-5)),))
    assert JELLETT not in named(twisted)
    assert drift(JELLETT, twisted, followed(RollingLaw(), twisted, start_of(twisted), 1.0)) > 1e-4


# --- phases ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("body", "motion", "tilt", "rolls", "slips", "flies"),
    [
        (BALL, TURN, 0.0, {MOVING, SPIN, ABOUT}, {SPIN, ABOUT}, {ENERGY, MOVING, SPIN, ABOUT, FREE}),
        (CHAPLYGIN, TURN, 0.0, {MOVING, NORMAL, ABOUT}, {NORMAL, ABOUT}, {ENERGY, MOVING, NORMAL, ABOUT, FREE}),
        (TOP, TURN, 0.05, {JELLETT}, {JELLETT}, {ENERGY, JELLETT, FREE}),
        (TOP, None, 0.0, {ENERGY, JELLETT, ROUTH}, {JELLETT}, {ENERGY, JELLETT, FREE}),
    ],
)
def test_phases(body: Any, motion: Any, tilt: float, rolls: Any, slips: Any, flies: Any) -> None:
    system = system_of(body, motion=motion, tilt=tilt, friction=0.1)
    put_down = start_of(system)
    slid = replace(put_down, velocity=(0.9, -0.3, put_down.velocity[2]))
    thrown = replace(put_down, position=(*put_down.position[:2], 0.3), velocity=(0.2, 0.1, 0.5))
    laws = {ROLLING: (RollingLaw(), put_down), SLIPPING: (SlippingLaw(), slid), FLIGHT: (FlightLaw(), thrown)}
    every = rolls | slips | flies
    for (phase, (law, start)), kept in zip(laws.items(), (rolls, slips, flies), strict=True):
        assert named(system, phase) == kept
        at = followed(law, system, start, 0.1)
        for name in every:
            change = drift(name, system, at)
            if name in kept:
                assert change <= SOLVER(20 * turned(at), 1e-12), (phase, name)
            elif not (name == ENERGY and motion is not None) and (phase, name) != (FLIGHT, ROUTH):
                assert change > 1e-6, (phase, name)
    assert named(system, ROLLING, SLIPPING) == rolls & slips


def test_without_friction_the_energy_survives_slipping() -> None:
    system = system_of(TOP, friction=0.0)
    start = start_of(system)
    assert ENERGY in named(system, SLIPPING)
    at = followed(SlippingLaw(), system, replace(start, velocity=(0.5, 0.0, start.velocity[2])), 0.2)
    assert drift(ENERGY, system, at) <= SOLVER(20 * turned(at), 1e-12)


# --- free tables ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("motion", "surface", "loads", "tilt", "kept"),
    [
        (tr.FreeAxle(1e-3, 2.0), None, (), 0.0, {WITH_TABLE, TABLE_MOMENTUM, SPIN, ABOUT}),
        (tr.FreeAxle(1e-3, 2.0), None, (), 0.05, {WITH_TABLE, SPIN}),
        (tr.FreeAxle(1e-3, 2.0), tr.EllipsoidalBowl((0.3, 0.4, 0.2)), (), 0.0, {WITH_TABLE, TABLE_MOMENTUM}),
        (tr.FreeAxle(1e-3, 2.0, bearing_drag=1e-4), None, (), 0.0, {SPIN, ABOUT}),
        (tr.FreeAxle(1e-3, 2.0, motor_torque=1e-4), None, (), 0.0, {SPIN, ABOUT}),
        (tr.FreeAxle(1e-3, 2.0), None, (RollingCouple(1e-5),), 0.0, {TABLE_MOMENTUM}),
    ],
)
def test_free_tables(motion: Any, surface: Any, loads: Any, tilt: float, kept: set[str]) -> None:
    system = system_of(BALL, surface, motion, loads, tilt)
    assert named(system) == kept
    at = followed(RollingLaw(), system, start_of(system), 1.5)
    assert np.ptp(at.support_coordinates[:, 1]) > 1e-3  # the table does feel the ball
    for name in kept:
        assert drift(name, system, at) <= SOLVER(20 * turned(at), 1e-12), name
    free = system_of(BALL, surface, replace(motion, bearing_drag=0.0, motor_torque=0.0))
    for name in {WITH_TABLE, TABLE_MOMENTUM} - kept:  # by the terms that they would have
        assert drift_with(free, system, name, at) > 1e-6, name


def drift_with(like: tr.RollingSystem, system: tr.RollingSystem, name: str, at: Samples) -> float:
    """The drift of another system's integral along this one's motion; the loads' part of an energy is this one's."""
    terms = NAMED[name].terms(
        replace(like, support=replace(like.support, tilt=system.support.tilt)), _record(system, at)
    )
    total = sum(np.asarray(term, dtype=float) for term in terms)
    return float(np.abs(total - total[0]).max() / max(float(np.abs(term).max()) for term in terms))


def _record(system: tr.RollingSystem, at: Samples) -> Record:
    return Record(at.motion(system), Vector.of(at.contact), at.support_columns)


# --- Routh's pair in closed form ------------------------------------------------------------------------


def test_the_pair_on_a_cylinder_and_on_a_plane_s_limit_is_what_is_known() -> None:
    # [routh1905]: on an upright cylinder R V_φ is constant, and aΩ·n grows evenly with the height, by n_R V_φ/R.
    at = ran(system := system_of(BALL, tr.Cylinder(0.3)), 1.0, **ON_WALL)
    terms = NAMED[PAIR].terms(system, _record(system, at))
    r, V, R = at.position, at.velocity, 0.275
    momentum = r[:, 0] * V[:, 1] - r[:, 1] * V[:, 0]
    n = -r * [1, 1, 0] / R
    spin = 0.025 * (n * at.angular_velocity).sum(axis=1)
    known = np.column_stack([momentum, 0.3 * (spin + momentum / R**2 * (r[:, 2] - r[0, 2]))])
    assert np.abs(sum(terms) - known).max() <= SOLVER(turned(at), 1e-14, np.abs(known).max())


def test_the_pair_in_a_bowl_is_what_is_known() -> None:
    # On a sphere κ = κ_φ: Ω·n is constant, and R V_φ differs from (k/(1 + k)) aΩ·n times −n_z b' by a constant.
    at = ran(system := system_of(BALL, tr.Bowl(0.3)), 1.5, spin=60.0)
    n = at.normals(system)
    spin = (n * at.angular_velocity).sum(axis=1)
    assert np.ptp(spin) <= SOLVER(turned(at), 1e-15, np.abs(at.angular_velocity).max())
    momentum = at.position[:, 0] * at.velocity[:, 1] - at.position[:, 1] * at.velocity[:, 0]
    other = momentum - 0.4 / 1.4 * 0.025 * spin * 0.275 * n[:, 2]
    assert np.ptp(momentum) > 1e-3
    assert np.ptp(other) <= SOLVER(turned(at), 1e-14, np.abs(momentum).max())


def test_the_pair_over_the_axis_itself_is_finite() -> None:
    system = system_of(BALL, tr.Paraboloid(0.3))
    at = followed(RollingLaw(), system, start_of(system, position=(0.1, 0.0), velocity=(-0.3, 1e-5)), 1.0)
    assert np.hypot(*at.contact[:, :2].T).min() < 0.01
    assert drift(PAIR, system, at) <= SOLVER(20 * turned(at), 1e-12)


@pytest.mark.parametrize(
    ("half_angle", "speed", "spin"),
    [
        (math.radians(2.7), 2e-3, 0.0),
        (math.radians(2.7), 6e-4, 30.0),
        (math.radians(2.7), -6e-4, 3.0),
        (0.02, -2e-3, 3.0),
    ],
)
def test_the_pair_in_a_cone_hardly_wider_than_the_ball_is_what_is_known(
    half_angle: float, speed: float, spin: float
) -> None:
    # In a cone at rest R V_φ is constant, and aΩ·n + (n_R/n_z) V_φ: near the axis both are told by the smallest R.
    pytest.importorskip("heyoka")
    system = tr.RollingSystem(tr.Body.solid_sphere(0.01, 0.008), tr.Support(tr.Cone(half_angle)))
    start = system.place((0.0106, 0.0), (0.0, speed), spin=spin)
    run = tr.simulate(system, start, 2.0, 0.02, method="taylor")
    at = run.samples
    n, R, (x, y) = at.normals(system), np.hypot(*at.position[:, :2].T), at.position[:, :2].T
    across = (x * at.velocity[:, 1] - y * at.velocity[:, 0]) / R
    spins = 0.01 * (n * at.angular_velocity).sum(axis=1)
    slope = math.hypot(*n[0, :2]) / n[0, 2]
    assert R.min() < 0.1 * R.max()
    assert np.ptp(R * across) <= 1e-11 * np.abs(R * across).max()
    assert np.ptp(spins - slope * across) <= 1e-11 * slope * np.abs(across).max()
    assert run.card()[f"drift of the {PAIR}"].value <= 1e-12
    late = replace(at, angular_velocity=at.angular_velocity * (1 + 1e-11 * at.time)[:, None])
    assert drift(PAIR, system, late) > 1e-12


@pytest.mark.parametrize("spin", [0.0, 30.0])
def test_the_pair_deep_in_a_narrow_cone_drifts_by_rounding_of_the_height_alone(spin: float) -> None:
    # Δ(aΩ·n) is (V_φ/R) Δz: with R = 2 mm at a height of 1.5 m, a rounding of z is hundreds of one of V_φ.
    pytest.importorskip("heyoka")
    system = tr.RollingSystem(tr.Body.hollow_sphere(0.0278, 0.25), tr.Support(tr.Cone(0.0201)))
    run = tr.simulate(system, system.place((0.0298, 0.0), (0.3, 5.2), spin=spin), 0.1, 0.1, method="taylor")
    method, at = Method.of("taylor"), run.samples
    (figure,) = (figure for figure in drifts(system, at, method) if PAIR in figure.name)
    assert figure.passed
    late = replace(at, angular_velocity=at.angular_velocity * np.array([1.0, 1.0 + 1e-9])[:, None])
    (figure,) = (figure for figure in drifts(system, late, method) if PAIR in figure.name)
    assert not figure.passed


@pytest.mark.parametrize("spin", [0.0, 2.0, -5.0])
@pytest.mark.parametrize("velocity", [(0.3, 6.0), (0.3, -6.0), (-2.0, 9.0), (1.0, 1.0)])
def test_the_pair_is_carried_round_a_tube_as_often_as_the_ball_goes(velocity: tuple[float, float], spin: float) -> None:
    # Round a closed meridian the equation along it does not come back to what it was: each round has its own share.
    system = system_of(tr.Body.solid_sphere(0.02, 1.0), tr.TorusTrack(0.5, 0.1), motion=tr.Spin(spin))
    run = tr.simulate(system, system.place((0.0, 0.0), velocity), 1.5, 0.002)
    at, ends = run.samples, [event.time for event in run.events if event.kind == "lift"]
    rolled = at.part(at.time < min(ends, default=np.inf))
    x, z = np.hypot(*rolled.contact[:, :2].T) - 0.5, rolled.contact[:, 2]
    turns = np.ptp(np.unwrap(np.arctan2(z, x))) / (2 * math.pi)
    assert turns > (1.5 if not ends and velocity[1] != 1.0 else 0.25)
    assert drift(PAIR, system, rolled) <= 1e-12
    late = replace(rolled, angular_velocity=rolled.angular_velocity * (1 + 1e-10 * rolled.time)[:, None])
    assert drift(PAIR, system, late) > 1e-12


def test_where_a_ball_may_have_gone_round_a_tube_between_two_samples_nothing_is_said() -> None:
    system = system_of(tr.Body.solid_sphere(0.02, 1.0), tr.TorusTrack(0.5, 0.1))
    run = tr.simulate(system, system.place((0.0, 0.0), (-2.0, 9.0)), 0.9, 0.05)
    assert not run.events
    assert NAMED[PAIR].terms(system, _record(system, run.samples)) == []


def test_energy_in_a_groove_hardly_wider_than_the_ball_drifts_by_rounding_of_the_place_alone() -> None:
    # The contact goes a hundred times as far as the centre: its rounding turns the normal, and lifts the ball.
    pytest.importorskip("heyoka")
    ball = tr.Body(0.0236, tr.Principal(8.6e-5, 1.22e-4, 1.0e-4), tr.Sphere(0.134903))
    system = tr.RollingSystem(ball, tr.Support(tr.TorusTrack(1.17132, 0.135072)))
    start = system.place((-0.05, -0.0452), velocity=(0.05, 0.14))
    at, method = tr.simulate(system, start, 3.0, 0.02, method="taylor").samples, Method.of("taylor")
    (figure,) = (figure for figure in drifts(system, at, method) if ENERGY in figure.name)
    assert figure.passed
    faster = (1 + 1e-10 * at.time)[:, None]
    late = replace(at, angular_velocity=at.angular_velocity * faster, velocity=at.velocity * faster)
    (figure,) = (figure for figure in drifts(system, late, method) if ENERGY in figure.name)
    assert not figure.passed


def test_the_pair_is_carried_along_a_short_stretch_in_few_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    # Between two slips of a hundred the contact goes a millimetre: no shorter steps are needed there than on all of it.
    taken: list[float] = []
    slopes = _Meridian.slopes
    monkeypatch.setattr(_Meridian, "slopes", lambda self, s, y: [taken.append(s), slopes(self, s, y)][1])
    system, counts = system_of(BALL, tr.Cone(0.8)), []
    for duration in (0.002, 1.0):
        at = ran(system, duration, position=(0.1, 0.0), velocity=(0.3, 0.2), spin=5.0)
        assert drift(PAIR, system, at) <= SOLVER(20 * turned(at), 1e-12)
        counts.append(len(taken))
        taken.clear()
    short, long = counts
    assert 5 * short < long


@pytest.mark.parametrize("off_axis", [1e-3, 1e-4, 1e-5])
def test_the_pair_is_carried_as_easily_near_the_axis(off_axis: float, monkeypatch: pytest.MonkeyPatch) -> None:
    # There the spin changes by ℓ/R, a million times ℓ: its tolerance asked for steps of 1e-14 of the way.
    pytest.importorskip("heyoka")
    taken: list[float] = []
    slopes = _Meridian.slopes
    monkeypatch.setattr(_Meridian, "slopes", lambda self, s, y: [taken.append(s), slopes(self, s, y)][1])
    cone = tr.Cone(0.0246)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.0352, 0.0094), tr.Support(cone))
    place = 0.0352 * math.cos(0.0246) + off_axis, 0.0
    run = tr.simulate(system, system.place(place, (0.02, 0.1), spin=3.0), off_axis * 40, off_axis, method="taylor")
    at = run.samples
    n, R, (x, y) = at.normals(system), np.hypot(*at.position[:, :2].T), at.position[:, :2].T
    across = (x * at.velocity[:, 1] - y * at.velocity[:, 0]) / R
    spins = 0.0352 * (n * at.angular_velocity).sum(axis=1)
    kept = spins - math.hypot(*n[0, :2]) / n[0, 2] * across  # as in a cone hardly wider than the ball
    assert np.ptp(R) > 0.03 * R.max()
    assert np.ptp(R * across) <= 1e-11 * np.abs(R * across).max()
    assert np.ptp(kept) <= 1e-11 * np.abs(kept).max()
    (figure,) = (figure for figure in drifts(system, at, Method.of("taylor")) if PAIR in figure.name)
    assert figure.passed
    assert len(taken) < 20_000  # for a handful of records
    late = replace(at, angular_velocity=at.angular_velocity * np.linspace(1.0, 1.0 + 1e-8, at.time.size)[:, None])
    (figure,) = (figure for figure in drifts(system, late, Method.of("taylor")) if PAIR in figure.name)
    assert not figure.passed


# --- drawn ----------------------------------------------------------------------------------------------

SIZE = st.floats(0.5, 2.0)


@st.composite
def systems(draw: st.DrawFn) -> tr.RollingSystem:
    a, m, J = 0.025 * draw(SIZE), 0.065, 1.6e-5
    shift = 0.2 * a * draw(st.floats(0.1, 1.0))
    bodies = [
        tr.Body.sphere(a, m, draw(st.floats(0.1, 0.6))),
        tr.Body(m, tr.Principal(J, J * draw(st.floats(0.8, 1.2)), J), tr.Sphere(a)),
        tr.Body(m, tr.Principal(J, J, J * draw(st.floats(0.5, 1.4))), tr.Sphere(a, Vector(0.0, 0.0, shift))),
        tr.Body(m, tr.Isotropic(J), tr.Sphere(a, Vector(shift, 0.0, 0.0))),
        tr.Body(m, tr.Principal(J, J, 0.7 * J), tr.Sphere(a, Vector(shift, 0.0, 0.0))),
    ]
    surface = draw(st.sampled_from([tr.Plane(), tr.Plane(), tr.Bowl(0.6), tr.Paraboloid(0.4)]))
    rate = draw(st.floats(-3.0, 3.0))
    motions = [tr.Fixed(), tr.Spin(rate), tr.SpinBy("1 + 0.5*sin(3*t)"), tr.Shake((0.002, 0.0, 0.0), 7.0)]
    motion = draw(st.sampled_from([*motions, tr.FreeAxle(1e-3, rate)]))
    loads = draw(st.sampled_from([(), (tr.Force((0.0, 0.0, 0.05)),), (tr.Drag(0.01),), (tr.Force((0.02, 0.0, 0.0)),)]))
    tilt = draw(st.sampled_from([0.0, 0.0, 0.05]))
    return system_of(draw(st.sampled_from(bodies)), surface, motion, loads, tilt)


@settings(max_examples=20)
@given(systems(), st.floats(-3.0, 3.0), st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2)))
def test_whatever_is_named_is_constant(system: tr.RollingSystem, spin: float, velocity: tuple[float, float]) -> None:
    at = followed(RollingLaw(), system, start_of(system, spin=spin, velocity=velocity), 0.2)
    for integral in invariants_of(system):
        assert drift(integral.name, system, at) <= SOLVER(50 * turned(at), 1e-12), integral.name


# --- symmetries -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("motion", "kept"),
    [
        (tr.Fixed(), True),
        (tr.UnevenSpin(2.0, 0.1, 3.0), True),
        (tr.SpinBy("exp(-t)"), True),
        (tr.FreeAxle(1.0), True),
        (tr.Shake((0.01, 0.0, 0.01), 5.0), True),
        (tr.Combined((tr.Shake((0.01, 0.0, 0.0), 5.0), tr.Spin(2.0))), True),
        (tr.Wobble(2.0, 1e-9), False),
        (tr.Tilt("0.01*(t - 1000 + abs(t - 1000))"), False),
        (tr.Rock(1e-9, 3.0), False),
    ],
)
def test_which_motions_keep_the_axis(motion: Any, kept: bool) -> None:
    assert keeps_axis(motion) is kept


def test_an_axis_of_symmetry_is_found_wherever_it_lies() -> None:
    e = Vector(2 / 3, -1 / 3, 2 / 3)
    J = [[1.6e-5 * (i == j) - 4e-6 * a * b for j, b in enumerate(e)] for i, a in enumerate(e)]
    body = tr.Body(0.065, tr.Tensor(J[0][0], J[1][1], J[2][2], J[0][1], J[0][2], J[1][2]), tr.Sphere(0.025, e * 0.004))
    found = ball_of(body)
    assert found is not None
    assert found.axis is not None
    assert (found.axis - e).norm() < 1e-15
    assert math.dist(found.moments, (1.6e-5, 1.2e-5)) < 1e-19
    system = system_of(body)
    assert named(system) == {ENERGY, JELLETT, ROUTH}
    at = followed(RollingLaw(), system, start_of(system), 0.5)
    for name in (JELLETT, ROUTH):
        assert drift(name, system, at) <= SOLVER(20 * turned(at), 1e-12)
    off = tr.Body(
        0.065,
        tr.Tensor(J[0][0], J[1][1], J[2][2], J[0][1], J[0][2], J[1][2]),
        tr.Sphere(0.025, Vector(0.0, 0.0, 0.004)),
    )
    assert named(system_of(off)) == {ENERGY}


def test_a_cylinder_that_rolls_straight_has_no_integral_of_a_ball() -> None:
    weighted = system_of(tr.Body.weighted_cylinder(0.05, 0.3, 0.1, 0.04))
    assert named(weighted) == {ENERGY}


def test_on_the_axis_the_pair_of_routh_has_nothing_to_say() -> None:
    bowl = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Bowl(0.5)))
    run = tr.simulate(bowl, bowl.place((0.0, 0.0), (0.5, 0.25)), 1.0, 0.1, method="runge-kutta")
    assert run.card().passed
    assert not any("Routh" in figure.name for figure in run.card().figures)
