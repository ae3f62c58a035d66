"""What must stay constant does, through Taylor's method, for bodies and supports that only the tests have."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.shapes import Ellipsoid, Sphere, Torus
from trundle.solve import runge_kutta, taylor
from trundle.solve.patience import Patience
from trundle.solve.samples import Samples

pytest.importorskip("heyoka")

G = 9.80665
TIMES = np.linspace(0.0, 10.0, 201)


def thin_disc(mass: float, a: float) -> tr.Body:
    """A homogeneous disc: m a²/4 about a diameter, m a²/2 about its axis."""
    return tr.Body(mass, tr.Principal(mass * a * a / 4, mass * a * a / 4, mass * a * a / 2), Torus(a, 0.0))


def ellipsoid(mass: float, a: float, b: float, c: float) -> tr.Body:
    """A homogeneous ellipsoid."""
    moments = [mass * (b * b + c * c) / 5, mass * (c * c + a * a) / 5, mass * (a * a + b * b) / 5]
    return tr.Body(mass, tr.Principal(*moments), Ellipsoid(a, b, c))


def space_inertia(body: tr.Body, at: Samples) -> Any:
    """Return J in space (n, 3, 3) from the principal moments, the rotations made by SciPy."""
    from scipy.spatial.transform import Rotation

    Q = Rotation.from_quat(at.orientation, scalar_first=True).as_matrix()
    moments = np.array([body.inertia.x, body.inertia.y, body.inertia.z])
    return np.einsum("nij,j,nkj->nik", Q, moments, Q)


def energies(system: tr.RollingSystem, at: Samples) -> tuple[Any, Any, Any]:
    """Return ½mV², ½Ω·JΩ and the potential energy of weight on a level support."""
    m, V, Omega = system.body.mass, at.velocity, at.angular_velocity
    turning = 0.5 * np.einsum("ni,nij,nj->n", Omega, space_inertia(system.body, at), Omega)
    return 0.5 * m * (V * V).sum(axis=1), turning, m * G * at.position[:, 2]


def radians(at: Samples) -> float:
    return float(np.linalg.norm(at.angular_velocity, axis=1).max() * at.time[-1])


def drift(terms: Any) -> float:
    total = sum(terms)
    return float(np.abs(total - total[0]).max() / max(np.abs(term).max() for term in terms))


def tilted(axis: tuple[float, float, float], angle: float) -> tuple[float, ...]:
    return (math.cos(angle / 2), *(math.sin(angle / 2) * part for part in axis))


LEVEL = {
    "thin disc": (thin_disc(2.0, 0.3), tilted((1.0, 0.0, 0.0), math.pi / 2 - 0.3), (1.5, 0.2), 4.0),
    "triaxial ellipsoid": (ellipsoid(1.5, 0.3, 0.25, 0.2), tilted((0.6, 0.8, 0.0), 1.0), (0.5, -0.3), 6.0),
}


@pytest.mark.parametrize("name", LEVEL)
def test_energy_of_a_body_on_a_level_plane(name: str) -> None:
    body, orientation, velocity, spin = LEVEL[name]
    system = tr.RollingSystem(body, tr.Support(tr.Plane()))
    start = system.place(velocity=velocity, spin=spin, orientation=orientation)
    at = taylor.solve(system, start, TIMES)
    kinetic, turning, potential = energies(system, at)
    assert np.ptp(potential) > 0.05 * kinetic.max()  # it does rise and fall
    assert drift((kinetic, turning, potential)) <= SOLVER(1 + radians(at), 1e-15)
    assert np.abs(at.contact[:, 2]).max() <= SOLVER(1 + radians(at), 1e-15)


def test_moving_energy_of_an_ellipsoid_on_a_turntable() -> None:
    rate, body = 2.0, ellipsoid(1.5, 0.3, 0.25, 0.2)
    system = tr.RollingSystem(body, tr.Support(tr.Plane(), motion=tr.Spin(rate)))
    start = system.place((0.5, 0.0), (0.3, 0.6), spin=3.0, orientation=tilted((0.6, 0.8, 0.0), 0.4))
    at = taylor.solve(system, start, TIMES)
    assert not at.events
    energy = energies(system, at)
    orbital = body.mass * (at.position[:, 0] * at.velocity[:, 1] - at.position[:, 1] * at.velocity[:, 0])
    own = np.einsum("nj,nj->n", space_inertia(body, at)[:, 2], at.angular_velocity)
    assert np.ptp(sum(energy)) > 0.2  # J: the table gives and takes
    assert drift((*energy, -rate * orbital, -rate * own)) <= SOLVER(2 * (1 + radians(at)), 1e-15)


def test_angular_momentum_of_chaplygins_ball_about_the_contact() -> None:
    body = tr.Body(1.5, tr.Principal(0.02, 0.03, 0.04), Sphere(0.25))
    system = tr.RollingSystem(body, tr.Support(tr.Plane()))
    start = system.place(velocity=(0.5, -0.3), spin=6.0, orientation=tilted((0.6, 0.8, 0.0), 1.0))
    at = taylor.solve(system, start, TIMES)
    own = np.einsum("nij,nj->ni", space_inertia(body, at), at.angular_velocity)
    rho = np.array([0.0, 0.0, -0.25])
    orbital = body.mass * np.cross(rho, np.cross(at.angular_velocity, rho))
    assert np.ptp(own, axis=0)[:2].min() > 0.01
    assert drift((own, orbital)) <= SOLVER(1 + radians(at), 1e-15)
    assert drift(energies(system, at)) <= SOLVER(1 + radians(at), 1e-15)


def pipe_start(a: float, b: float, around: float, up: float, radial: float) -> tr.State:
    """A ball at (b − a, 0, 0) in a pipe: V = −Ω×ρ with ρ = a e_r, so V_φ = −a Ω_z and V_z = a Ω_φ."""
    V = (0.0, (b - a) * around, up)
    return tr.State((b - a, 0.0, 0.0), V, (radial, up / a, -(b - a) * around / a))


@pytest.mark.parametrize("k", [2 / 5, 2 / 3, 0.1])
def test_a_ball_in_a_vertical_pipe_bobs(k: float) -> None:
    """Euler along e_r and e_φ: Ω_r' = φ̇ Ω_φ, (1 + k) a Ω_φ' = −k a φ̇ Ω_r − g, and φ̇ is constant (the golfer's dilemma).

    So z swings at ν = φ̇ √(k/(1 + k)), √(2/7) of the turning for a solid ball, about a level set by gravity and Ω_r.
    """
    a, b, around, up, radial = 0.05, 0.3, 12.0, 0.4, -3.0
    body = tr.Body.sphere(a, 0.5, k)
    system = tr.RollingSystem(body, tr.Support(tr.Cylinder(b)))
    at = taylor.solve(system, pipe_start(a, b, around, up, radial), TIMES)
    nu = around * math.sqrt(k / (1 + k))
    pull = (k * around * a * radial + G) / (1 + k)
    z = up / nu * np.sin(nu * TIMES) - pull / nu**2 * (1 - np.cos(nu * TIMES))
    path = np.stack([(b - a) * np.cos(around * TIMES), (b - a) * np.sin(around * TIMES), z], axis=1)
    size = np.abs(path).max()
    assert np.abs(at.position - path).max() <= SOLVER(1 + radians(at), 1e-15, size)
    # The wall carries m φ̇² (b − a) and pushes along e_φ with nothing, since φ̈ = 0.
    inwards = -path * [1, 1, 0] / (b - a)
    N = np.einsum("ni,ni->n", at.contact_force, inwards)
    f = at.contact_force - N[:, None] * inwards
    assert np.abs(N - body.mass * around**2 * (b - a)).max() <= SOLVER(1 + radians(at), 1e-15, N.max())
    assert np.abs(f[:, :2]).max() <= SOLVER(1 + radians(at), 1e-15, N.max())


@pytest.mark.parametrize("rate", [0.0, math.pi, -4.0])
def test_what_rounding_leaves_of_q_is_not_turned_into_more_by_thousands_of_radians(rate: float) -> None:
    a, body = 0.005, tr.Body(0.64, tr.Principal(0.002, 0.0032, 0.0048), Sphere(0.005))
    system = tr.RollingSystem(body, tr.Support(tr.Plane(), motion=tr.Spin(rate)))
    start = system.place((-1.3, 0.01), (0.0, 3.0), spin=500.0, orientation=tilted((0.6, 0.8, 0.0), 1.0))
    at = taylor.solve(system, start, TIMES)
    assert radians(at) > 6000
    own = np.einsum("nij,nj->ni", space_inertia(body, at), at.angular_velocity)
    rho = np.array([0.0, 0.0, -a])
    assert drift((own, -body.mass * np.cross(rho, at.velocity))) <= EXACT(1000, 1.0)


@pytest.mark.parametrize("around", [20_000.0, -15_000.0])
def test_a_ball_in_a_pipe_hardly_wider_bobs_as_evenly_after_ten_thousand_rounds(around: float) -> None:
    # What rounding leaves of its distance from the axis is a hundred times as much of the circle of its centre.
    a, b, k, up = 0.01, 0.01014, 2 / 5, 0.4
    system = tr.RollingSystem(tr.Body.sphere(a, 0.03, k), tr.Support(tr.Cylinder(b)))
    times = np.linspace(0.0, 3.0, 301)
    at = taylor.solve(system, pipe_start(a, b, around, up, 0.0), times)
    nu = around * math.sqrt(k / (1 + k))
    z = up / nu * np.sin(nu * times) - G / (1 + k) / nu**2 * (1 - np.cos(nu * times))
    assert np.abs(at.position[:, 2] - z).max() <= EXACT(200, abs(around) * 3.0 * up / abs(nu))


def test_the_weighted_ball_swings_like_a_pendulum() -> None:
    """Rocking about its lowest place in a plane: ½[I + m(a² + c² − 2ac cos θ)]θ̇² − mgc cos θ is the energy."""
    a, c, m, I = 0.25, 0.1, 1.5, 0.03
    body = tr.Body(m, tr.Isotropic(I), Sphere(a, Vector(0.0, 0.0, c)))
    system = tr.RollingSystem(body, tr.Support(tr.Plane()))
    at = taylor.solve(system, system.place(orientation=tilted((0.0, 1.0, 0.0), 2.5)), TIMES)
    theta = 2 * np.unwrap(np.arctan2(at.orientation[:, 2], at.orientation[:, 0]))
    # c points up in the body frame at θ = 0; the centre of mass hangs c cos θ below the sphere's centre.
    assert np.abs(at.position[:, 2] - (a - c * np.cos(theta))).max() <= SOLVER(1 + radians(at), 1e-15, a)
    turning = 0.5 * (I + m * (a * a + c * c - 2 * a * c * np.cos(theta))) * at.angular_velocity[:, 1] ** 2
    assert drift((turning, -m * G * c * np.cos(theta))) <= SOLVER(1 + radians(at), 1e-15)
    assert np.ptp(np.cos(theta)) > 0.05


@pytest.mark.parametrize("name", LEVEL)
def test_runge_kutta_agrees(name: str) -> None:
    body, orientation, velocity, spin = LEVEL[name]
    system = tr.RollingSystem(body, tr.Support(tr.Plane()))
    start = system.place(velocity=velocity, spin=spin, orientation=orientation)
    times = TIMES[:41]
    ours, theirs = taylor.solve(system, start, times), runge_kutta.solve(system, start, times)
    bound = SOLVER(20 * (1 + radians(ours)), runge_kutta.TOLERANCE)
    for field in ("position", "velocity", "angular_velocity", "orientation", "contact_force"):
        one, other = getattr(ours, field), getattr(theirs, field)
        assert np.abs(one - other).max() <= bound * np.abs(one).max(), field


def test_a_quaternion_means_the_same_rotation_as_scipys() -> None:
    from scipy.spatial.transform import Rotation

    q = np.array([0.5, -0.1, 0.7, 0.5]) / np.linalg.norm([0.5, -0.1, 0.7, 0.5])
    ours = Quaternion(*q).matrix()
    theirs = Rotation.from_quat(q, scalar_first=True).as_matrix()
    assert np.allclose([list(row) for row in ours.rows], theirs, rtol=0, atol=EXACT(4, 1))


def test_patience_reckons_with_what_a_step_of_a_law_costs(monkeypatch: pytest.MonkeyPatch) -> None:
    """A step for an ellipsoid is the work of several for a ball: as many steps would take several times as long."""
    taken: list[int] = []
    after = Patience.after
    monkeypatch.setattr(
        Patience, "after", lambda self, steps, *rest: [taken.append(steps), after(self, steps, *rest)][1]
    )
    monkeypatch.setattr(taylor, "_PATIENCE", taylor._PATIENCE | {"steps": 1.0, "spare": 5e3})
    steps = []
    for body in (tr.Body.solid_sphere(0.02, 0.1), ellipsoid(0.1, 0.02, 0.025, 0.03)):
        system = tr.RollingSystem(body, tr.Support(tr.Bowl(0.5)))
        with pytest.raises(tr.SolverError, match="hardly gets on"):
            taylor.solve(system, system.place((0.1, 0.0), (0.0, 0.3)), np.array([0.0, 1e4]))
        steps.append(sum(taken))
        taken.clear()
    ball, egg = steps
    assert 3 * egg < ball <= 5.5e3


def spent(course: Any, end: float = 1.0, steps: float = 1e15) -> float:
    """Return when patience is lost with work W(t), of which 1e5 is to spare; infinity where it is not."""
    patience = Patience(0.0, end, steps=steps, spare=1e5, name="It")
    before, times = 0.0, np.linspace(0.0, end, 20_001)[1:]
    for time, done in zip(times.tolist(), np.broadcast_to(course(times), times.shape).tolist(), strict=True):
        try:
            patience.after(done - before, time)
        except tr.SolverError:
            return time
        before = done
    return math.inf


@pytest.mark.parametrize(
    ("course", "lost"),
    [
        (lambda t: np.exp(60 * t), math.log(2e5) / 60),  # 1e26 in all
        (lambda t: np.exp(60 * t + np.sin(60 * t)), math.log(2e5) / 60),  # by fits and starts
        (lambda t: 30 * np.expm1(60 * t), math.log(2e5 / 30) / 60),
        (lambda t: np.exp(24 * t), math.inf),  # 2e10, fewer than it may take
        (lambda t: 1e5 * np.exp(60 * (t - 0.9)), math.inf),  # too late for more than some hundred times as much
        (lambda t: 2e6 * t**16, math.inf),
        (lambda t: 1e8 * t, math.inf),
        (lambda t: 1e9 * t**8, math.inf),
        (lambda t: 1e12 * np.maximum(t - 0.5, 0.0), math.inf),  # after a time in which nothing happened
        (lambda t: 1e7 * np.sqrt(t), math.inf),
        (lambda t: 1e6 * t + 2e6 * (1 + np.tanh(40 * (t - 0.1))), math.inf),  # forty times as fast for a while
    ],
)
def test_patience_is_lost_at_once_where_work_doubles_without_end_and_there_alone(course: Any, lost: float) -> None:
    found = spent(course)
    assert found == lost or lost <= found <= lost + math.log(2.5) / 60


@pytest.mark.parametrize(("total", "lost"), [(1e6, False), (3e6, False), (2e7, True), (1e9, True)])
def test_patience_is_lost_early_where_doubling_work_comes_to_several_times_what_it_may_take(
    total: float, lost: bool
) -> None:
    found = spent(lambda t: total**t, steps=3e6)
    assert (found <= 1.01 * math.log(2.5e5, total)) == lost


def test_a_ball_thrown_outwards_over_hill_after_hill_is_given_up_before_a_minute_went_into_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each turn of the table throws it out twelve times as far and fast; what led to an event had not been counted."""
    done: list[float] = []
    after = Patience.after

    def counted(patience: Patience, steps: int, time: float, each: float = 1.0) -> None:
        done.append(steps * each * (patience.name != "The run"))
        after(patience, steps, time, each)

    monkeypatch.setattr(Patience, "after", counted)
    hills = tr.HeightField("0.035*sin(16*y)*cos(17*y)")
    support = tr.Support(hills, motion=tr.Wobble(-16.0, math.pi / 2), friction=0.32, tilt=-0.056)
    system = tr.RollingSystem(tr.Body.hollow_sphere(0.01, 0.8), support)
    with pytest.raises(tr.SolverError, match="hardly gets on"):
        taylor.solve(system, system.place((0.0, 0.21), (-0.2, 0.6)), np.linspace(0.0, 3.0, 31))
    assert 2e5 < sum(done) < 1e6  # its way is chaotic: by another rounding the work doubles more or less evenly


def test_short_steps_where_slip_begins_are_no_reason_to_compile_anything() -> None:
    # Its hundred first steps led over a tenth of a microsecond, and half a minute went into code for the rest.
    effort = taylor._Effort(cost=400)
    effort.after(100, 1e-7)
    effort.look(left=1.0)
    assert effort.level == taylor.IN_HASTE
    effort.after(6900, 1e-3)
    effort.look(left=1.0)
    assert effort.level == taylor.WITH_CARE  # seven thousand for all of a second
    effort.after(50_000, 1e-3)
    effort.look(left=1.0)
    assert effort.level == taylor.WITH_CARE  # as many again for each of the milliseconds to come are refused
    effort.after(50_000, 4e-2)
    effort.look(left=1.0)
    assert effort.level == taylor.UNROLLED  # a million


@pytest.mark.parametrize(
    ("look", "level"),
    [
        ({}, taylor.WITH_CARE),
        ({"growing": True}, taylor.IN_HASTE),
        ({"holds": lambda: 0.1}, taylor.IN_HASTE),  # a thousand steps
        ({"holds": lambda: 0.9}, taylor.WITH_CARE),
    ],
)
def test_a_law_is_compiled_with_care_only_for_as_many_steps_as_it_seems_to_hold(look: Any, level: int) -> None:
    effort = taylor._Effort(cost=700)
    effort.after(1000, 0.1)
    effort.look(1.0, **look)
    assert effort.level == taylor.IN_HASTE  # of ten thousand too few are done to tell
    effort.after(3000, 0.3)
    effort.look(1.0, **look)
    assert effort.level == level


BRIEFLY = {
    "hemisphere that comes to the rim": """
body = { kind = "hemisphere", radius = 0.128034, density = 2508.35, moments = [0.000417, 0.000661259, 0.000396511] }
start = { position = [0.148713, -0.0758385], velocity = [0.0376158, 0.258142], attitude = [0.0, -0.108489, "-90 deg"] }
run = { duration = 1.96621, every = 0.02 }
[support]
kind = "height-field"
formula = "0.010449*sin(5.23905*x)*cos(12.9582*x)"
rim = 0.229554
friction = 0.0394405
""",
    "torus whose steps are short where it begins to slip": """
body = { kind = "torus", radius = 0.0684098, rim_radius = 0.0111881, mass = 0.188287, centre = [0, -0.01304, 0.002818] }
start = { position = [0.105789, -0.0176573], velocity = [-0.0472598, 0.173451] }
run = { duration = 2.0, every = 0.0142876 }
[support]
kind = "cone"
half_angle = 0.138798
rim = 0.267859
friction = 0.918407
motion = { kind = "rock", amplitude = "45 deg", rate = -25.8389, phase = -0.0378098 }
""",
}


@pytest.mark.parametrize("name", BRIEFLY)
def test_no_long_law_is_compiled_with_care_for_the_few_steps_to_where_it_ends(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    efforts: list[Any] = []
    effort = taylor.Shared.effort

    def noted(self: taylor.Shared, *law: Any) -> Any:
        efforts.append(effort(self, *law))
        return efforts[-1]

    monkeypatch.setattr(taylor.Shared, "effort", noted)
    tr.Scenario.loads(BRIEFLY[name]).run()
    long = [one for one in efforts if one.cost > taylor._SHORT_LAW]
    assert max(one.steps for one in long) > 100  # they were looked at
    assert {one.level for one in long} == {taylor.IN_HASTE}


# --- a ball that slides without friction ------------------------------------------------------------------------------

BOWL, BALL_RADIUS = 0.5, 0.02
WITHOUT = {"friction": 0.0}, {"friction": 0.05, "kinetic_friction": 0.0}


def sliding(speed: float, friction: dict[str, float], duration: float, method: str) -> tr.Trajectory:
    system = tr.RollingSystem(tr.Body.solid_sphere(BALL_RADIUS, 0.1), tr.Support(tr.Bowl(BOWL), **friction))
    start = system.place((0.2, 0.0), velocity=(0.0, speed, 0.0), angular_velocity=(0.0, 0.0, 0.0))
    return tr.simulate(system, start, duration, duration / 50, method=method)


def pendulum(run: tr.Trajectory) -> Any:
    """Return the height over the bowl's centre, by 30 digits, of a spherical pendulum that sets out level.

    Its energy and its angular momentum h leave L² ż² = 2 (E − g z)(L² − z²) − h² = 2g (z − z₁)(z − z₂)(z − z₃), and so
    z = z₁ + (z₂ − z₁) sn²(ωt + φ).
    """
    import mpmath as mp

    (x, _, height), (_, v, _) = run.start.position, run.start.velocity
    with mp.workdps(30):
        g, z0, x, v = mp.mpf(G), mp.mpf(height) - BOWL, mp.mpf(x), mp.mpf(v)
        L2, E = x * x + z0 * z0, v * v / 2 + g * z0
        z1, z2, z3 = sorted(map(mp.re, mp.polyroots([2 * g, -2 * E, -2 * g * L2, 2 * E * L2 - x * x * v * v])))
        m, rate = (z2 - z1) / (z3 - z1), mp.sqrt(2 * g * (z3 - z1) / L2) / 2
        phase = mp.ellipk(m) if abs(z0 - z2) < abs(z0 - z1) else mp.mpf(0)
        sn = (mp.ellipfun("sn", rate * mp.mpf(t) + phase, m=m) for t in run.data.time.values.tolist())
        return np.array([float(z1 + (z2 - z1) * s * s) for s in sn])


@pytest.mark.parametrize("friction", WITHOUT)
@pytest.mark.parametrize("speed", [0.3, -1.0, 6.0])
def test_a_ball_that_slides_in_a_bowl_for_long_is_a_spherical_pendulum(
    speed: float, friction: dict[str, float]
) -> None:
    run = sliding(speed, friction, 300.0, "taylor")
    heights = run.data.position.values[:, 2] - BOWL
    assert (run.data.phase.values == 1).all()
    z, V = run.data.position.values[:, 2], run.data.velocity.values
    off = drift([0.5 * (V * V).sum(axis=1), G * z])
    assert off < 3e-14  # 1e-10 where s keeps what rounding leaves along n
    swings = 300.0 * max(abs(speed) / BOWL, math.sqrt(G / BOWL))  # rad; energy off by a share is a phase off by half
    np.testing.assert_allclose(heights, pendulum(run), rtol=0, atol=0.5 * off * swings * BOWL)
    assert run.card().passed


def test_a_ball_that_slides_in_a_bowl_is_one_by_the_runge_kutta_method_too() -> None:
    run = sliding(1.0, WITHOUT[0], 100.0, "runge-kutta")
    np.testing.assert_allclose(run.data.position.values[:, 2] - BOWL, pendulum(run), rtol=0, atol=1e-9)
    z, V = run.data.position.values[:, 2], run.data.velocity.values
    assert drift([0.5 * (V * V).sum(axis=1), G * z]) < 2e-11


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("speed", [1e5, -3e4])
def test_slip_that_turns_by_right_angles_without_end_is_refused_in_words(speed: float, method: str) -> None:
    """No event happens there, and so nothing counted how often a stretch began."""
    with pytest.raises(tr.SolverError, match="The run hardly gets on at t = "):
        sliding(speed, WITHOUT[1], 4.0, method)


def test_each_run_of_many_from_one_instant_has_patience_of_its_own() -> None:
    """Neighbours are followed over the same time again and again, with what is compiled for all of them."""
    shared = taylor.Shared()
    first = shared.patience(0.0, 10.0)
    first.after(1000, 4.0)
    assert shared.patience(4.0 - 1e-15, 10.0) is first  # the next stretch, a rounding before
    assert shared.patience(4.0, 10.0) is first
    again = shared.patience(0.0, 10.0)
    assert again is not first
    assert again.owed == 0
    first.after(1000, 9.0)
    assert shared.patience(9.0, 10.0) is again


def test_a_contact_that_chatters_is_refused_after_a_thousand_events() -> None:
    """A couple that acts while they touch throws a ball off a wall, and without it that comes back."""
    text = """
    loads = [{ kind = "force", value = ["-0.018865*t*exp(-t)", -1.09577, 0.247336] },
             { kind = "rolling-couple", coefficient = 0.00523655 }]
    body = { kind = "solid-sphere", radius = 0.0566788, density = 778.979 }
    start = { position = ["90 deg", -0.225559], attitude = ["90 deg", "90 deg", -0.0289094] }
    run = { duration = 2.0, every = 0.05 }
    [support]
    kind = "cylinder"
    radius = 0.149252
    restitution = 0.37455
    motion = { kind = "precessing-tilt", angle = -0.0155381, rate = 7.89709 }
    """
    with pytest.raises(tr.SolverError, match=r"chatters at t = 0\.9.*1000 events \(lift, land\)"):
        tr.Scenario.loads(text).run()


def test_what_bounces_a_thousand_times_between_two_walls_does_not_chatter() -> None:
    pipe = tr.Support(tr.Cylinder(0.5), friction=0.3, restitution=1.0)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.45, 1.0), pipe, gravity=0.0)
    run = tr.simulate(system, system.place((0.0, 0.0), (0.0, 0.0, 30.0)), duration=3.8, every=0.1, method="taylor")
    assert len(run.events) == 1140  # 0.1 m apart
    assert {event.kind for event in run.events} == {"land"}
    assert run.events[-1].time == pytest.approx(3.8, abs=1e-10)
