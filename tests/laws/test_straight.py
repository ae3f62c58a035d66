"""Cylinders and hoops roll straight: what they do then, and what is refused because it would turn them aside."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.spatial.transform import Rotation
from tests.draws import imperfect, rollers
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import Vector
from trundle.solve.methods import tolerance_of

G = 9.80665
LOG = tr.Body.cylinder(0.1, 0.75)
SLOPE = tr.Support(tr.Plane(), tilt=0.2)
PIPE = tr.Support(tr.Cylinder(0.5), tilt="90 deg")


def agree(system: tr.RollingSystem, start: tr.State, one: str, other: str, multiple: float) -> None:
    a, b = (tr.simulate(system, start, duration=1.0, every=0.125, method=name) for name in (one, other))
    turned = float(np.linalg.norm(a.data.angular_velocity.values, axis=1).max())
    bound = SOLVER(multiple * (1 + turned), max(tolerance_of(one), tolerance_of(other), 1e-15))
    arm = float(system.body.shape.radius)
    fastest = max(float(np.abs(a.data.velocity).max()), arm * turned)
    sizes = {
        "position": float(np.abs(a.data.position).max()) + fastest + G,
        "velocity": fastest + G,  # of the weight, in a second
        "angular_velocity": (fastest + G) / arm,
        "contact_force": float(system.body.mass) * (2 * G + fastest**2 / 0.1),
        "orientation": 1.0,
    }
    for name, size in sizes.items():
        assert float(np.abs(a.data[name] - b.data[name]).max()) <= bound * size, name


@settings(max_examples=25)
@given(rollers())
def test_the_closed_form_is_the_general_law(run: tuple[tr.RollingSystem, tr.State]) -> None:
    agree(*run, "exact", "taylor", 300)


@settings(max_examples=12)
@given(imperfect())
def test_two_methods_agree_on_an_imperfect_table(run: tuple[tr.RollingSystem, tr.State]) -> None:
    agree(*run, "taylor", "runge-kutta", 30)


@pytest.mark.parametrize(("k", "share"), [(1 / 2, 2 / 3), (1.0, 1 / 2), (1e-9, 1.0)])
def test_down_a_slope_a_cylinder_gains_its_share(k: float, share: float) -> None:
    system = tr.RollingSystem(tr.Body.cylinder(0.1, 0.75, k), SLOPE)
    run = tr.simulate(system, system.place(), 2.0, 2.0)
    assert run.data.position[-1, 0].item() == pytest.approx(share * G * math.sin(0.2) * 2.0, rel=2e-9)


def test_laid_down_its_axis_lies_across_its_way_and_its_mark_is_on_top() -> None:
    for system, place, way, normal in [
        (tr.RollingSystem(LOG, SLOPE), {"position": (0.3, 0.1)}, [1, 0, 0], [0, 0, 1]),
        (tr.RollingSystem(LOG, SLOPE), {"velocity": (-0.3, 0.0)}, [1, 0, 0], [0, 0, 1]),
        (tr.RollingSystem(LOG, tr.Support(tr.Plane())), {"velocity": (3.0, 4.0)}, [0.6, 0.8, 0], [0, 0, 1]),
        (tr.RollingSystem(LOG, PIPE), {"position": ("90 deg", 0.0)}, [-1, 0, 0], [0, -1, 0]),
    ]:
        for roll in (0.0, 0.7):
            start = system.place(**place, roll=roll)
            Q = Rotation.from_quat(start.orientation, scalar_first=True).as_matrix()
            axis = np.cross(normal, way)
            assert np.allclose(Q[:, 2], axis, atol=1e-15)
            mark = Rotation.from_rotvec(roll * axis).apply(normal)
            assert np.allclose(Q[:, 0], mark, atol=1e-15)


def test_on_a_level_plane_a_cylinder_may_roll_any_way() -> None:
    system = tr.RollingSystem(LOG, tr.Support(tr.Plane()))
    run = tr.simulate(system, system.place(velocity=(0.3, -0.4)), 2.0, 0.5)
    assert np.allclose(run.data.position[-1], [0.6, -0.8, 0.1], atol=1e-15)
    assert run.card().passed


@pytest.mark.parametrize(
    ("support", "arguments", "loads", "key"),
    [
        (tr.Support(tr.Plane(), motion=tr.Spin(1.0)), {"position": (0.3, 0.0)}, (), "body"),
        (SLOPE, {"velocity": (0.2, 0.3)}, (), "body"),
        (SLOPE, {"spin": 1.0}, (), "body"),
        (SLOPE, {}, (tr.Force((0.0, 0.1, 0.0)),), "body"),
        (SLOPE, {}, (tr.Torque((0.0, 0.0, 0.1)),), "body"),
        (SLOPE, {"orientation": (1.0, 0.0, 0.0, 0.0)}, (), "orientation"),
        (SLOPE, {"orientation": (0.5, -0.5, -0.5, -0.5), "roll": 0.1}, (), "roll"),
        (PIPE, {"velocity": (0.2, 0.3)}, (), "body"),
        (tr.Support(tr.Cylinder(0.5), tilt=1.0), {}, (), "body"),
    ],
)
def test_what_would_turn_it_aside_is_refused(support: Any, arguments: Any, loads: Any, key: str) -> None:
    system = tr.RollingSystem(LOG, support, loads=loads)
    with pytest.raises(InvalidValueError) as caught:
        system.place(**arguments)
    assert caught.value.key == key


def test_a_hand_made_start_that_lies_askew_is_refused_by_the_run() -> None:
    system = tr.RollingSystem(LOG, SLOPE)
    askew = tr.State((0.0, 0.0, 0.1), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
    with pytest.raises(InvalidValueError, match="axis along the support"):
        tr.simulate(system, askew, 1.0, 0.5)


@pytest.mark.parametrize(
    ("support", "loads"),
    [
        (SLOPE, (tr.Force((0.0, "0.1*t", 0.0)),)),
        (SLOPE, (tr.Torque(("0.1*t", 0.0, 0.0)),)),
        (tr.Support(tr.Plane(), motion=tr.SpinBy("0.1*t")), ()),
        (tr.Support(tr.Plane(), motion=tr.SpinBy("-0.1*t**2")), ()),
        (tr.Support(tr.Plane(), motion=tr.Rock(0.1, 1.0)), ()),
    ],
)
def test_what_would_turn_it_aside_later_is_refused_before_it_runs(support: Any, loads: Any) -> None:
    system = tr.RollingSystem(LOG, support, loads=loads)
    with pytest.raises(InvalidValueError, match="must roll straight") as caught:
        tr.simulate(system, system.place(velocity=(0.2, 0.0) if support is SLOPE else (0.0, 0.2)), 1.0, 0.01)
    assert caught.value.key == "body"


@pytest.mark.parametrize("rate", [1.0, -1.0])
@pytest.mark.parametrize(
    ("support", "loads"),
    [
        (lambda rate: tr.Support(tr.Plane(), motion=tr.Spin(rate)), ()),
        (lambda rate: tr.Support(tr.Plane(), motion=tr.Spin(rate), tilt=0.1), ()),
        (lambda rate: tr.Support(tr.Plane(), motion=tr.Wobble(rate, 0.01)), ()),
        (lambda rate: tr.Support(tr.Cylinder(0.5), motion=tr.Spin(rate), tilt=1.2), ()),
        (lambda _: tr.Support(tr.Plane()), (tr.Drag(0.1, air=1.0),)),
    ],
)
def test_what_pushes_it_aside_a_little_further_on_is_refused_where_it_is_put_down(
    support: Any, loads: Any, rate: float
) -> None:
    # On the axle nothing pushes it aside yet.
    with pytest.raises(InvalidValueError, match="must roll straight"):
        tr.RollingSystem(LOG, support(rate), loads=loads).place((0.0, 0.0), spin=None)


@pytest.mark.parametrize(
    "support",
    [
        tr.Support(tr.Plane(), motion=tr.Shake((0.02, 0.0, 0.01), 3.0)),
        tr.Support(tr.Plane(), motion=tr.Rock(0.1, 2.0)),
        tr.Support(tr.Plane(), tilt=-0.1),
        tr.Support(tr.Cylinder(0.5), motion=tr.Spin(-1.0), tilt="90 deg"),
        tr.Support(tr.Cylinder(0.5, side="outside"), motion=tr.SpinBy("cos(t)"), tilt="90 deg", friction=0.3),
    ],
)
def test_what_is_the_same_on_both_sides_is_not(support: Any) -> None:
    system = tr.RollingSystem(LOG, support)
    assert tr.simulate(system, system.place(velocity=(0.2, 0.0)), 0.2, 0.01).card().passed


@pytest.mark.parametrize("ratio", [0.0, -0.5, 1.01, float("nan")])
def test_no_cylinder_has_more_inertia_than_a_hoop(ratio: float) -> None:
    with pytest.raises(InvalidValueError, match="inertia_ratio"):
        tr.Body.cylinder(0.1, 1.0, ratio)


def test_a_weight_moves_centre_of_mass_and_inertia_as_steiner_says() -> None:
    M, m, a, d = 0.3, 0.1, 0.05, 0.04
    body = tr.Body.weighted_cylinder(a, M, m, d)
    # About the cylinder's axis the moments add: M a²/2 + m d².
    centre = m * d / (M + m)
    assert body.mass == pytest.approx(M + m)
    assert tuple(body.shape.centre) == pytest.approx((-centre, 0.0, 0.0))
    assert body.inertia.moment + body.mass * centre**2 == pytest.approx(M * a * a / 2 + m * d * d, rel=1e-14)
    with pytest.raises(InvalidValueError, match="distance"):
        tr.Body.weighted_cylinder(a, M, m, 0.06)
    with pytest.raises(InvalidValueError, match="centre"):
        tr.CylinderShape(a, Vector(0.0, 0.0, 0.01))


def test_a_weighted_hoop_keeps_its_energy_and_passes() -> None:
    body = tr.Body.weighted_cylinder(0.05, 0.3, 0.1, 0.04)
    system = tr.RollingSystem(body, tr.Support(tr.Plane()))
    card = tr.simulate(system, system.place(roll="90 deg"), 5.0, 0.01).card()
    assert card.passed
    assert "drift of the energy" in [figure.name for figure in card.figures]


def test_a_ball_put_down_in_a_pipe_touches_its_wall_and_rolls() -> None:
    ball = tr.Body.solid_sphere(0.05, 0.5)
    system = tr.RollingSystem(ball, tr.Support(tr.Cylinder(0.4), motion=tr.Spin(2.0), tilt=0.3))
    start = system.place((1.0, 0.2), (0.3, -0.1), spin=4.0)
    r, V, Omega = (np.array(getattr(start, name)) for name in ("position", "velocity", "angular_velocity"))
    n = -np.array([math.cos(1.0), math.sin(1.0), 0.0])
    around = np.array([-math.sin(1.0), math.cos(1.0), 0.0])
    assert np.allclose(r, -0.35 * n + [0, 0, 0.2], atol=1e-15)
    assert np.allclose(V, 0.3 * around + [0, 0, -0.1], atol=1e-15)
    assert Omega @ n == pytest.approx(4.0)
    assert np.allclose(V + np.cross(Omega, -0.05 * n), 2.0 * 0.4 * around, atol=EXACT(16, 1))
    riding = system.place((1.0, 0.2), "co-rotating")
    assert np.allclose(riding.velocity, 2.0 * 0.35 * around, atol=1e-15)
    assert np.allclose(riding.angular_velocity, [0.0, 0.0, 2.0], atol=EXACT(32, 1))


@pytest.mark.parametrize("distance", [0.0, 100.0, 1e4])
@pytest.mark.parametrize("tilt", [0.0, 0.1])
@pytest.mark.parametrize("body", [tr.Body.cylinder(radius=0.05, mass=0.2), tr.Body.solid_sphere(0.05, 0.2)])
def test_far_away_it_turns_as_far_as_it_rolls(body: tr.Body, tilt: float, distance: float) -> None:
    """Its turn was read off its place, of which 10 km away a radian has eleven digits left."""
    system = tr.RollingSystem(body, tr.Support(tr.Plane(), tilt=tilt))
    run = tr.simulate(system, system.place((distance, 0.0), (0.3, 0.0)), 2.0, 0.1)
    assert run.method == "exact"
    t, k = run.samples.time, 0.5 if body.shape.axis is not None else 0.4
    turned = (0.3 * t + 0.5 * G * np.sin(tilt) / (1 + k) * t * t) / 0.05
    w, x, y, z = run.samples.orientation[0]
    c, s = np.cos(0.5 * turned), np.sin(0.5 * turned)  # about the second axis
    wanted = np.stack([c * w - s * y, c * x + s * z, c * y + s * w, c * z - s * x], axis=1)
    assert np.abs(run.samples.orientation - wanted).max() <= EXACT(8, turned.max())
    failures = run.card().failures
    assert not failures, failures


AXLE = tr.Support(tr.Plane(), motion=tr.FreeAxle(0.003))


@pytest.mark.parametrize(
    ("body", "start"),
    [
        (tr.Body.half_cylinder(0.045, 0.2), {"position": (-0.4, 0.0), "velocity": (0.1, 0.05)}),
        (tr.Body.half_cylinder(0.045, 0.2), {"position": (0.0, 0.3), "velocity": (-0.1, 0.0)}),
        (LOG, {"position": (0.3, 0.1), "velocity": (0.1, 0.0)}),
    ],
)
def test_what_turns_a_free_table_under_itself_is_refused(body: tr.Body, start: dict[str, Any]) -> None:
    """What pushes along its way aside of the axle turns the table, and the table turns it: also where that is later."""
    system = tr.RollingSystem(body, AXLE, loads=(tr.Force((0.1, 0.0, 0.0)),) if body is LOG else ())
    with pytest.raises(InvalidValueError, match="must roll straight"):
        tr.simulate(system, system.place(**start), 1.0, 0.1)


@pytest.mark.parametrize("body", [LOG, tr.Body.half_cylinder(0.045, 0.2)])
@pytest.mark.parametrize("velocity", [(0.1, 0.0), (-0.2, 0.0)])
def test_what_rolls_over_the_axle_of_a_free_table_leaves_it_at_rest(
    body: tr.Body, velocity: tuple[float, float]
) -> None:
    system = tr.RollingSystem(body, AXLE)
    run = tr.simulate(system, system.place(position=(-0.01, 0.0), velocity=velocity), 1.0, 0.1)
    assert np.abs(run.data.support_rate.values).max() < 1e-12
    assert run.card().passed


@pytest.mark.parametrize("torque", [-1e-4, 1e-4])
def test_weightless_and_at_rest_it_is_turned_by_what_turns_its_table(torque: float) -> None:
    """Nothing but the motor says then how fast anything is: over the axle it is turned on the spot, aside carried."""
    table = tr.Support(tr.Plane(), motion=tr.FreeAxle(0.003, motor_torque=torque))
    system = tr.RollingSystem(LOG, table, gravity=0.0)
    for place in ((0.0, 0.0), (0.3, 0.1)):
        with pytest.raises(InvalidValueError, match="must roll straight"):
            tr.simulate(system, system.place(position=place), 1.0, 0.1)
