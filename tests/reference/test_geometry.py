"""A ball rolled along a path, against the lecture, spherical geometry, and rotations in forty digits."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.tolerances import EXACT, ULP

import trundle as tr
from trundle.solve.orientation import orientation

Quaternion = tuple[Any, Any, Any, Any]


def times(p: Quaternion, q: Quaternion) -> Quaternion:
    a, b, c, d = p
    w, x, y, z = q
    return (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )


def rolled_by(dx: Any, dy: Any, radius: Any) -> Quaternion:
    """Roll straight: a rotation by length/a about n × direction, in multiple precision."""
    length = mp.hypot(dx, dy)
    half = length / radius / 2
    return (mp.cos(half), -dy / length * mp.sin(half), dx / length * mp.sin(half), mp.mpf(0))


def chords(curve: Any, first: Any, last: Any, radius: Any, count: int) -> list[Any]:
    """Roll along the chords of a curve, in multiple precision."""
    q: Quaternion = (mp.mpf(1), mp.mpf(0), mp.mpf(0), mp.mpf(0))
    here = curve(first)
    for k in range(1, count + 1):
        there = curve(first + (last - first) * mp.mpf(k) / count)
        q = times(rolled_by(there[0] - here[0], there[1] - here[1], radius), q)
        here = there
    return list(q)


def extrapolated(curve: Any, first: Any, last: Any, radius: Any, coarsest: int = 16) -> np.ndarray:
    """Let the chords of a curve shrink to nothing: their error is a series in even powers of their length."""
    with mp.workdps(40):
        rows = [chords(curve, mp.mpf(first), mp.mpf(last), mp.mpf(radius), coarsest * 2**j) for j in range(7)]
        for order in range(1, 7):
            factor, before = mp.mpf(4) ** order, rows[-1]
            rows = [
                [(factor * b - a) / (factor - 1) for a, b in zip(coarse, fine, strict=True)]
                for coarse, fine in pairwise(rows)
            ]
        assert max(abs(a - b) for a, b in zip(before, rows[0], strict=True)) < 1e-13  # it has converged
        return np.array([float(part) for part in rows[0]])


def angle_between(p: np.ndarray, q: np.ndarray) -> float:
    """Return the angle of the rotation from one to the other; small ones keep their digits."""
    w, x, y, z = times(tuple(p), (q[0], -q[1], -q[2], -q[3]))
    return 2 * math.atan2(math.hypot(x, y, z), abs(w))


def quarter(degrees: float) -> tr.Straight:
    return tr.Straight(heading=f"{degrees} deg", turn="90 deg")


# --- the lecture ---------------------------------------------------------------------------------------------


def test_x_then_y_leaves_the_pole_at_plus_x() -> None:
    """Rolled along x the pole points along +x; then along y, it still does; the ball is at (π/2, π/2) a."""
    rolled = tr.roll_along([quarter(0), quarter(90)], radius=1.0)
    poles = [[0, 0, 1], [1, 0, 0], [1, 0, 0]]
    np.testing.assert_allclose(rolled.stages.north_pole, poles, rtol=0, atol=EXACT(4, 1.0))
    places = np.array([[0, 0], [1, 0], [1, 1]]) * math.pi / 2
    np.testing.assert_allclose(rolled.stages.contact, places, rtol=0, atol=EXACT(4, 1.0))


def test_y_then_x_leaves_the_pole_at_plus_y() -> None:
    rolled = tr.roll_along([quarter(90), quarter(0)], radius=1.0)
    poles = [[0, 0, 1], [0, 1, 0], [0, 1, 0]]
    np.testing.assert_allclose(rolled.stages.north_pole, poles, rtol=0, atol=EXACT(4, 1.0))
    np.testing.assert_allclose(rolled.stages.contact[-1], [math.pi / 2] * 2, rtol=0, atol=EXACT(4, 1.0))


def test_the_two_orders_as_whole_rotations() -> None:
    """A quarter turn about y and one about −x, multiplied by hand: (1 ∓ i + j ∓ k)/2."""
    xy, yx = (tr.roll_along(path, 1.0) for path in ([quarter(0), quarter(90)], [quarter(90), quarter(0)]))
    np.testing.assert_allclose(xy.stages.orientation[-1], [0.5, -0.5, 0.5, -0.5], rtol=0, atol=EXACT(4, 1.0))
    np.testing.assert_allclose(yx.stages.orientation[-1], [0.5, -0.5, 0.5, 0.5], rtol=0, atol=EXACT(4, 1.0))
    assert xy.rotation.angle == pytest.approx(2 * math.pi / 3, abs=EXACT(8, 1.0))
    np.testing.assert_allclose(xy.rotation.axis, np.array([-1, 1, -1]) / math.sqrt(3), rtol=0, atol=EXACT(8, 1.0))


def test_back_by_the_way_it_came_nothing_is_turned() -> None:
    way = [tr.Straight(heading=0.3, length=0.7), tr.Straight(heading=1.9, length=0.4)]
    back = [tr.Straight(heading=1.9 + math.pi, length=0.4), tr.Straight(heading=0.3 + math.pi, length=0.7)]
    rolled = tr.roll_along(way + back, radius=0.1)
    assert rolled.is_closed
    assert rolled.rotation.angle < EXACT(64, 1.0)
    assert rolled.enclosed_area == pytest.approx(0.0, abs=EXACT(8, 1.0))


# --- Gauss and Bonnet: what the contact point traces on the ball ------------------------------------------------


def test_an_octant_of_the_ball_turns_it_by_a_quarter() -> None:
    """Three quarter turns trace an octant, of area π/2 a², and leave the ball turned by just that, clockwise."""
    rolled = tr.roll_along([quarter(0), quarter(90), quarter(180)], radius=0.3)
    assert rolled.rotation.about_normal == pytest.approx(-math.pi / 2, abs=EXACT(8, 1.0))
    np.testing.assert_allclose(rolled.rotation.axis, [0, 0, -1], rtol=0, atol=EXACT(8, 1.0))
    np.testing.assert_allclose(rolled.stages.trace[-1], rolled.stages.trace[0], rtol=0, atol=EXACT(8, 0.3))


@pytest.mark.parametrize("corners", [3, 4, 5, 7])
@pytest.mark.parametrize("corner_angle", [0.15, 0.5, 0.9])
@pytest.mark.parametrize("side", [1, -1])
def test_polygons_on_the_ball(corners: int, corner_angle: float, side: int) -> None:
    """A regular polygon on the ball of area A turns it by −A/a² about the normal, whatever its size.

    Its sides follow from its corners by spherical trigonometry, cos(s/2) = cos(π/n)/sin(β/2), and its area from the
    sum of its corners, n β − (n − 2)π.
    """
    beta = math.pi * ((corners - 2) / corners * (1 - corner_angle) + corner_angle)
    sides = 2 * math.acos(math.cos(math.pi / corners) / math.sin(beta / 2))
    path = [tr.Straight(heading=0.4 + side * k * (math.pi - beta), turn=sides) for k in range(corners)]
    rolled = tr.roll_along(path, radius=2.0)
    area = side * (corners * beta - (corners - 2) * math.pi)
    turned = math.remainder(rolled.rotation.about_normal + area, 2 * math.pi)
    assert abs(turned) < EXACT(64, corners)
    assert math.hypot(*rolled.rotation.axis[:2]) * math.sin(rolled.rotation.angle / 2) < EXACT(64, corners)


def test_a_small_loop_turns_the_ball_by_its_area_and_the_rest_is_of_fourth_order() -> None:
    """The angle is |A|/a² up to the fourth power of the size; the axis leaves the normal by the first."""
    sizes = np.array([0.2, 0.1, 0.05, 0.025])
    for turn_left in (1, -1):
        missing, lean = [], []
        for size in sizes:
            corner = [(size, 0.0), (size, 0.6 * size), (0.2 * size, turn_left * size), (0.0, 0.0)]
            if turn_left < 0:
                corner[1] = (size, -0.6 * size)
            rolled = tr.roll_along([tr.Straight(to=place) for place in corner], radius=1.0)
            assert rolled.is_closed
            x, y = np.array([(0.0, 0.0), *corner[:-1]]).T
            shoelace = 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
            assert math.copysign(1, shoelace) == turn_left
            assert rolled.enclosed_area == pytest.approx(shoelace, rel=EXACT(64, 1.0))
            assert rolled.small_loop_angle == pytest.approx(-shoelace, rel=EXACT(64, 1.0))
            assert math.copysign(1, rolled.rotation.axis[2]) == -turn_left
            missing.append(abs(rolled.rotation.angle - abs(shoelace)))
            lean.append(math.hypot(*rolled.rotation.axis[:2]))
        orders = np.diff(np.log(missing)) / np.diff(np.log(sizes))
        assert abs(orders[-1] - 4) < 0.05
        assert abs((np.diff(np.log(lean)) / np.diff(np.log(sizes)))[-1] - 1) < 0.05


def test_a_circle_by_its_own_formula() -> None:
    """Once round a circle of radius R: 2π(√(1 + R²/a²) − 1), about an axis that leans by atan(R/a) towards −t."""
    for ratio in (1e-3, 0.1, 0.4):
        rolled = tr.roll_along(tr.Arc(radius=ratio, angle="1 turn"), radius=1.0)
        exact = float(2 * mp.pi * (mp.sqrt(1 + mp.mpf(ratio) ** 2) - 1))
        assert rolled.rotation.angle == pytest.approx(exact, abs=EXACT(32, 2 * math.pi))
        lean = np.array([0.0, ratio, -1.0]) / math.hypot(1, ratio)
        np.testing.assert_allclose(rolled.rotation.axis, lean, rtol=0, atol=EXACT(64, 1.0) / exact)
        assert rolled.enclosed_area == pytest.approx(math.pi * ratio**2, rel=EXACT(16, 1.0))


def test_a_path_that_is_its_own_half_turn_leaves_nothing_about_the_normal() -> None:
    """From r(−u) = −r(u) follows q⁻¹ = R q R⁻¹ with R half a turn about n: the z part of q is minus itself."""
    eight = tr.Curve(function=lambda u: (3 * np.sin(u), np.sin(2 * u)), start=-math.pi, stop=math.pi)
    rolled = tr.roll_along(eight, radius=1.0)
    assert rolled.rotation.angle > 0.1
    assert abs(rolled.stages.orientation[-1][3]) < rolled.error_bound


# --- closed form, rotation products and their bound -----------------------------------------------------------


@pytest.mark.parametrize(("radius", "angle"), [(0.7, 5.0), (0.7, -5.0), (3.0, 1.5), (0.02, 20.0), (1e9, 1e-9)])
def test_arcs_against_their_chords(radius: float, angle: float) -> None:
    """The closed form G2, against chords of the same arc in forty digits that shrink to nothing."""
    rolled = tr.roll_along(tr.Arc(radius=radius, angle=angle, heading=0.3), radius=0.5)
    sign = math.copysign(1, angle)

    def arc(theta: Any) -> tuple[Any, Any]:
        start, now = mp.mpf(0.3), mp.mpf(0.3) + sign * theta
        return radius * sign * (mp.sin(now) - mp.sin(start)), radius * sign * (mp.cos(start) - mp.cos(now))

    theirs = extrapolated(arc, 0.0, abs(angle), 0.5)
    assert angle_between(rolled.stages.orientation[-1], theirs) < rolled.error_bound
    assert rolled.error_bound < EXACT(8, 2.0 + rolled.length / 0.5 + abs(angle))


def test_a_straight_piece_is_the_arc_of_no_curvature() -> None:
    straight = tr.roll_along(tr.Straight(heading=0.2, length=1.0), radius=0.3)
    near = tr.roll_along(tr.Arc(heading=0.2, radius=1e12, angle=1e-12), radius=0.3)
    assert angle_between(straight.stages.orientation[-1], near.stages.orientation[-1]) < 1e-11
    np.testing.assert_allclose(straight.stages.contact, near.stages.contact, rtol=0, atol=1e-11)


CURVES = {
    "parabola": (lambda u: (u, u * u), -1.0, 1.5),
    "cycloid, with its cusps": (lambda u: (u - sin(u), 1 - cos(u)), 0.0, 4 * math.pi),
    "spiral": (lambda u: (exp(u / 5) * cos(u), exp(u / 5) * sin(u)), 0.0, 8.0),
    "narrow turn": (lambda u: (u, 0.05 / (u * u + 0.01)), -1.0, 1.0),
}


def sin(u: Any) -> Any:
    return np.sin(u) if isinstance(u, np.ndarray) else mp.sin(u)


def cos(u: Any) -> Any:
    return np.cos(u) if isinstance(u, np.ndarray) else mp.cos(u)


def exp(u: Any) -> Any:
    return np.exp(u) if isinstance(u, np.ndarray) else mp.exp(u)


@pytest.mark.parametrize("name", CURVES)
def test_curves_by_function_keep_their_error_bound(name: str) -> None:
    """Rotation products against chords in forty digits; the function alone is common to both."""
    function, start, stop = CURVES[name]
    rolled = tr.roll_along(tr.Curve(function=function, start=start, stop=stop), radius=0.5)
    origin = function(mp.mpf(start))
    theirs = extrapolated(
        lambda u: tuple(a - b for a, b in zip(function(u), origin, strict=True)), start, stop, 0.5, 80
    )
    assert angle_between(rolled.stages.orientation[-1], theirs) < rolled.error_bound
    assert rolled.error_bound < 1e-10


def test_two_paths_near_each_other_turn_the_ball_nearly_alike() -> None:
    """G3 on its own: a path bent by ε, however fast it wiggles, turns the ball within (2ε/a)(1 + L/a)."""
    for wiggles in (1, 10, 100):
        epsilon = 1e-3 / wiggles
        straight = tr.roll_along(tr.Curve(function=lambda u: (u, 0.2 * u * u), stop=3.0), radius=0.4)
        wavy = tr.Curve(function=lambda u, k=wiggles, e=epsilon: (u, 0.2 * u * u + e * np.sin(k * u)), stop=3.0)
        bent = tr.roll_along(wavy, radius=0.4)
        apart = angle_between(straight.stages.orientation[-1], bent.stages.orientation[-1])
        bound = 2 * epsilon / 0.4 * (1 + max(straight.length, bent.length) / 0.4)
        assert 0.01 * bound < apart < bound


def test_the_spline_is_the_one_that_is_promised() -> None:
    """Through points of a cubic, it is the cubic where its parameter is the length of chords: on a line."""
    along = np.array([0.0, 0.3, 1.0, 1.4, 2.0])
    rolled = tr.roll_along(tr.Curve(points=np.column_stack([along, 2 * along])), radius=0.5)
    straight = tr.roll_along(tr.Straight(to=(2.0, 4.0)), radius=0.5)
    assert angle_between(rolled.stages.orientation[-1], straight.stages.orientation[-1]) < rolled.error_bound
    assert rolled.length == pytest.approx(straight.length, rel=EXACT(16, 1.0))


def test_more_points_bring_the_spline_to_the_circle_by_the_fourth_power() -> None:
    circle = tr.roll_along(tr.Arc(radius=1.0, angle="1 turn", heading="90 deg"), radius=0.7, start=(1.0, 0.0))
    off = []
    for count in (16, 32, 64):
        angle = 2 * math.pi * np.arange(count) / count
        points = np.column_stack([np.cos(angle), np.sin(angle)])
        rolled = tr.roll_along(tr.Curve(points=points, closed=True), radius=0.7)
        assert rolled.is_closed
        off.append(angle_between(rolled.stages.orientation[-1], circle.stages.orientation[-1]))
    assert math.log2(off[0] / off[1]) > 3.8
    assert math.log2(off[1] / off[2]) > 3.8


# --- any number of points --------------------------------------------------------------------------------------

MIXED = [
    tr.Straight(heading="20 deg", length=0.5),
    tr.Arc(radius=0.3, angle="-140 deg"),
    tr.Straight(turn="2 turn"),
    tr.Arc(radius=0.1, angle="300 deg", heading="10 deg"),
]


def test_samples_are_paths_cut_short() -> None:
    """The ball after a length s of a piece is the ball at the end of a path that stops there."""
    whole = tr.roll_along(MIXED, radius=0.2)
    cut = [*MIXED[:3], tr.Arc(radius=0.1, angle=0.37, heading="10 deg")]
    short = tr.roll_along(cut, radius=0.2)
    there = whole.at(short.length)
    assert angle_between(there.orientation[0], short.stages.orientation[-1]) < whole.error_bound
    np.testing.assert_allclose(there.contact[0], short.stages.contact[-1], rtol=0, atol=EXACT(32, whole.length))
    assert math.remainder(there.heading[0] - math.radians(10) - 0.37, 2 * math.pi) == pytest.approx(0, abs=1e-14)


def test_samples_at_stages_are_the_stages_and_any_order_is_allowed() -> None:
    rolled = tr.roll_along(MIXED, radius=0.2, orientation=(1, 2, 3, 4))
    at = rolled.at(rolled.stages.distance[::-1])
    np.testing.assert_allclose(at.orientation[::-1], rolled.stages.orientation, rtol=0, atol=rolled.error_bound)
    np.testing.assert_allclose(at.contact[::-1], rolled.stages.contact, rtol=0, atol=EXACT(16, 1.0))
    np.testing.assert_allclose(np.linalg.norm(at.orientation, axis=1), 1, rtol=0, atol=EXACT(2, 1.0))


def test_distances_along_a_curve_are_lengths() -> None:
    """On the parabola y = x²/2 the length from the vertex is (x√(1 + x²) + asinh x)/2."""
    rolled = tr.roll_along(tr.Curve(function=lambda u: (u, u * u / 2), stop=2.0), radius=0.3)
    x = np.linspace(0, 2, 41)
    lengths = (x * np.hypot(1, x) + np.arcsinh(x)) / 2
    at = rolled.at(np.minimum(lengths, rolled.length))
    np.testing.assert_allclose(at.contact, np.column_stack([x, x * x / 2]), rtol=0, atol=1e-12)
    np.testing.assert_allclose(at.heading, np.arctan(x), rtol=0, atol=1e-12)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.tuples(st.floats(-4, 4), st.floats(0.05, 3), st.floats(-6, 6)), min_size=1, max_size=5),
    st.floats(0.1, 3),
    st.floats(-3, 3),
)
def test_turning_and_enlarging_the_path_turns_and_keeps_the_rotation(
    rows: list[tuple[float, float, float]], scale: float, turned: float
) -> None:
    """Turn the path by θ about n: q becomes R q R⁻¹. Enlarge path and ball: q stays."""

    def path(theta: float, size: float) -> tr.RolledPath:
        pieces = []
        for heading, length, angle in rows:
            begin = heading + theta
            if abs(angle) < 0.1:
                pieces.append(tr.Straight(heading=begin, length=length * size))
            else:
                pieces.append(tr.Arc(heading=begin, radius=length * size, angle=angle))
        return tr.roll_along(pieces, radius=0.7 * size)

    plain, other = path(0.0, 1.0), path(turned, scale)
    R = (math.cos(turned / 2), 0.0, 0.0, math.sin(turned / 2))
    back = (R[0], 0.0, 0.0, -R[3])
    wanted = np.array(times(times(R, tuple(plain.stages.orientation[-1])), back))
    slack = 8 * ULP * (10 + sum(abs(heading) + abs(turned) for heading, _, _ in rows))
    assert angle_between(other.stages.orientation[-1], wanted) < plain.error_bound + other.error_bound + slack


def test_the_path_may_be_taken_piece_by_piece() -> None:
    """Rolling on from where and how a path ended is the same as the whole path: what an interactive page does."""
    whole = tr.roll_along(MIXED, radius=0.2)
    first = tr.roll_along(MIXED[:2], radius=0.2)
    at = first.stages
    onward = [tr.Straight(heading=at.heading[-1], turn="2 turn"), MIXED[3]]
    second = tr.roll_along(onward, radius=0.2, start=at.contact[-1], orientation=at.orientation[-1])
    assert angle_between(second.stages.orientation[-1], whole.stages.orientation[-1]) < whole.error_bound
    np.testing.assert_allclose(second.stages.contact[-1], whole.stages.contact[-1], rtol=0, atol=EXACT(32, 1.0))


@pytest.mark.parametrize("speed", [1.0, 0.1, 1e-3, 1e-5])
@pytest.mark.parametrize("bend", [1.0, 10.0, 200.0])
def test_rotation_products_follow_an_axis_that_turns_faster_than_the_ball(speed: float, bend: float) -> None:
    """A tight arc turns the axis by far more than the ball; G2, held to chords above, is what comes out."""
    exact = tr.roll_along(tr.Arc(radius=1 / bend, angle=bend, heading=0.0), radius=1 / speed).stages.orientation[-1]

    def angular_velocity(s: np.ndarray) -> np.ndarray:
        return speed * np.stack([-np.sin(bend * s), np.cos(bend * s), 0 * s])

    found = orientation(angular_velocity, np.array([1.0]), (1.0, 0.0, 0.0, 0.0))[0]
    assert angle_between(found, exact) < EXACT(8, 2.0 + speed + bend)
