"""What a rolled path refuses and says, its figure, and faults that its card must see."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.analysis.geometry import ball, bends
from trundle.analysis.geometry.curves import RolledCurve
from trundle.errors import InvalidValueError, UnknownNameError
from trundle.mechanics.algebra import Quaternion


def rolled(*pieces: Any) -> tr.RolledPath:
    return tr.roll_along(pieces or [tr.Straight(turn="90 deg")], radius=0.5)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: tr.Straight(), "`length, turn, to` must be one of the three; got []."),
        (lambda: tr.Straight(length=1, turn=1), "`length, turn, to` must be one of the three; got ['length', 'turn']."),
        (lambda: tr.Straight(to=(1, 1), heading=0), "`heading` must not stand beside `to`"),
        (lambda: tr.Straight(length="1 kg"), "`length` must be a length; got '1 kg'"),
        (lambda: tr.Straight(length=0), "`length` must be positive; got 0"),
        (lambda: tr.Straight(length=math.nan), "`length` must be a finite number; got nan"),
        (lambda: tr.Straight(length=[1, 2]), "`length` must be a length"),
        (lambda: tr.Straight(to=3), "`to` must be a pair of lengths; got 3"),
        (lambda: tr.Arc(radius=1, angle=0), "`angle` must not be zero"),
        (lambda: tr.Arc(radius=-1, angle=1), "`radius` must be positive"),
        (lambda: tr.Curve(), "`points, function` must be one of the two; got 'neither'"),
        (lambda: tr.Curve(points=[(0, 0)] * 3), "`points` must hold at least 2 different points"),
        (lambda: tr.Curve(points=[(0, 0), (1, 1), (0, 0)], closed=True), "`points` must hold at least 3"),
        (lambda: tr.Curve(points=[(0, 0), (1, "1 s")]), "`points[1][1]` must be a length; got '1 s'"),
        (lambda: tr.Curve(points=7), "`points` must be a list of points; got 7"),
        (lambda: tr.Curve(function=1), "`function` must be callable; got 1"),
        (lambda: tr.Curve(function=math.sin, start=1, stop=1), "`stop` must be greater than `start`; got 1.0"),
        (lambda: rolled(tr.Curve(function=math.sin)), "`function` must return x and y"),
        (lambda: rolled(tr.Curve(function=lambda u: (u, math.sqrt(u - 2)))), "`function` must return x and y"),
        (lambda: rolled(tr.Curve(function=lambda u: (u, u * np.inf))), "`function` must be finite"),
        (lambda: rolled(tr.Curve(function=lambda u: (u, np.sign(u - 0.3)))), "`function` must be smooth"),
        (lambda: tr.roll_along([], 1.0), "`path` must have at least one piece"),
        (lambda: tr.roll_along([1], 1.0), "`path[0]` must be a piece of path; got 1"),
        (lambda: tr.roll_along(tr.Straight(length=1), 0), "`radius` must be positive; got 0"),
        (lambda: tr.roll_along(tr.Straight(length=1), 1, orientation=(0, 0, 0, 0)), "`orientation` must be"),
        (lambda: tr.roll_along(tr.Straight(length=1), 1, start=(1,)), "`start` must be a pair"),
        (lambda: rolled().at([-1.0]), "`distances` must lie on the path"),
        (lambda: rolled().at(math.nan), "`distances` must lie on the path"),
        (lambda: rolled().sampled(1e-9), "`every` must give at most 10 million samples"),
    ],
)
def test_refusals(call: Callable[[], Any], said: str) -> None:
    with pytest.raises(InvalidValueError) as caught:
        call()
    assert str(caught.value).startswith(said)


def test_a_typo_lists_what_there_is() -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'north_pole'"):
        rolled().nort_pole  # noqa: B018


def test_a_function_may_be_for_one_number_or_for_arrays() -> None:
    one = rolled(tr.Curve(function=lambda u: (math.sin(u), 1 - math.cos(u)), stop=3.0))
    many = rolled(tr.Curve(function=lambda u: (np.sin(u), 1 - np.cos(u)), stop=3.0))
    line = rolled(tr.Curve(function=lambda u: (u, 0), stop=3.0))
    np.testing.assert_allclose(one.stages.orientation, many.stages.orientation, rtol=0, atol=1e-14)
    assert line.length == pytest.approx(3.0, rel=1e-14)


def test_points_may_repeat_as_a_resting_pen_does() -> None:
    points = [(0, 0), (0, 0), (1, 1), (1, 1), (1, 1), (2, 0)]
    assert tr.Curve(points=points).points == ((0, 0), (1, 1), (2, 0))


def test_a_heading_is_kept_from_piece_to_piece() -> None:
    path = rolled(
        tr.Straight(heading="30 deg", length=1),
        tr.Arc(radius=1, angle="60 deg"),
        tr.Straight(length=2),
        tr.Arc(radius=0.5, angle="-45 deg"),
        tr.Straight(length=1),
    )
    np.testing.assert_allclose(np.degrees(path.stages.heading), [30, 30, 90, 90, 45, 45], rtol=1e-14)


def test_after_a_curve_the_path_goes_on_as_the_curve_ends() -> None:
    cycloid = tr.Curve(function=lambda u: (u - np.sin(u), 1 - np.cos(u)), stop=2 * np.pi)  # stands still at its ends
    path = rolled(cycloid, tr.Straight(length=1.0))
    np.testing.assert_allclose(np.degrees(path.stages.heading), [90, -90, -90], atol=1e-6)
    np.testing.assert_allclose(path.stages.contact[-1], [2 * np.pi, -1.0], atol=1e-7)


# --- the card ------------------------------------------------------------------------------------------------


def test_the_card_of_a_path_with_every_kind_of_piece_holds() -> None:
    curve = tr.Curve(function=lambda u: (1 + u, np.sin(u)), stop=4.0)
    card = rolled(tr.Straight(to=(1, 0)), curve, tr.Arc(radius=0.3, angle="-200 deg")).card()
    assert card.passed
    assert {"no slip", "no pivoting", "closed form against rotation products"} <= {f.name for f in card.figures}
    assert card["rotation products against Runge-Kutta"].passed


def test_the_card_of_odd_but_right_paths_holds() -> None:
    """A hand that trembles, a ball a thousand times larger than its arc, and a speck of a path far from the origin."""
    trembling = np.cumsum(np.random.default_rng(0).normal(size=(200, 2)), axis=0) * 0.01
    assert rolled(tr.Curve(points=trembling)).card().passed
    assert rolled(tr.Arc(radius=5e-4, angle=-50)).card().passed
    assert tr.roll_along(tr.Straight(length=1e-6), radius=0.3, start=(10.0, 20.0)).card().passed


@pytest.mark.parametrize("share", [1e-6, 1e-9])
def test_the_card_sees_a_ball_that_slips(monkeypatch: pytest.MonkeyPatch, share: float) -> None:
    honest = bends.turn
    monkeypatch.setattr(bends, "turn", lambda h, k, s, a: honest(h, k, s, a * (1 + share)))
    card = rolled(tr.Straight(length=1), tr.Arc(radius=1, angle=1)).card()
    assert card["no slip"].passed is False
    assert card["no pivoting"].passed
    assert card["closed form against rotation products"].passed is False


def test_the_card_sees_a_ball_that_pivots(monkeypatch: pytest.MonkeyPatch) -> None:
    """An arc taken as if the ball turned with it: what one gets who forgets the first factor of G2."""

    def carried(heading: Any, curvature: Any, distance: Any, radius: float) -> np.ndarray:
        twist = np.multiply(curvature, distance) / 2
        turning = Quaternion(np.cos(twist), 0 * twist, 0 * twist, np.sin(twist))
        return (turning * Quaternion.of(honest(heading, curvature, distance, radius))).array()

    honest = bends.turn
    monkeypatch.setattr(bends, "turn", carried)
    assert rolled(tr.Arc(radius=1, angle=1)).card()["no pivoting"].passed is False


def test_the_card_sees_a_curve_followed_badly(monkeypatch: pytest.MonkeyPatch) -> None:
    honest = RolledCurve.orientations

    def bad(self: RolledCurve, u: Any, start: Any) -> Any:
        lag = Quaternion(math.cos(1e-6), 0.0, math.sin(1e-6), 0.0)
        late = (lag * Quaternion.of(honest(self, u, start))).array()
        return np.where(np.asarray(u)[:, None] > self.ends[0] + 0.5, late, honest(self, u, start))

    monkeypatch.setattr(RolledCurve, "orientations", bad)
    curve = tr.Curve(function=lambda u: (u, u * u), stop=2.0)
    assert rolled(curve).card()["rotation products against Runge-Kutta"].passed is False


# --- the figure ----------------------------------------------------------------------------------------------


def test_the_picture_shows_the_spot_that_faces_the_viewer() -> None:
    """Orange on the northern half, blue on the southern, whatever the view; the pole's white cap where it points."""
    up, north_to_x = (1.0, 0.0, 0.0, 0.0), (math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0)
    from_above = ball.picture(up, ball.ABOVE, 60)
    assert (from_above[20:40, 34:50, 0] > from_above[20:40, 34:50, 2]).all()  # all of it northern
    tipped = ball.picture(north_to_x, ball.ABOVE, 60)
    redder = tipped[..., 0] > tipped[..., 2]
    assert redder[25:35, 40:50].all()  # the half towards +x, which is to the right
    assert not redder[25:35, 8:20].any()
    assert from_above[0, 0, 3] == 0  # outside of the ball there is nothing
    aside = ball.picture(up, ball.ASIDE, 60)
    assert (aside[10:14, 28:32, 0] > aside[10:14, 28:32, 2]).all()
    assert not (aside[52:56, 28:32, 0] > aside[52:56, 28:32, 2]).any()


def test_the_figure_has_equal_scales_units_and_a_ball_for_each_stage() -> None:
    x, y = (tr.Straight(heading=f"{angle} deg", turn="90 deg") for angle in (0, 90))
    one, two = tr.roll_along([x, y], radius="25 mm"), tr.roll_along([y, x], radius="25 mm")
    figure = one.plot(two)
    maps, rows = figure.axes[::2], figure.axes[1::2]
    for ax in maps:
        assert ax.get_aspect() == 1
        assert (ax.get_xlabel(), ax.get_ylabel()) == ("x (cm)", "y (cm)")
        assert len(ax.images) == 3
    assert all(len(ax.images) == 3 for ax in rows)
    assert maps[0].get_xlim() == maps[1].get_xlim()
    ends = [tuple(np.mean(np.reshape(ax.images[-1].get_extent(), (2, 2)), axis=1)) for ax in maps]
    np.testing.assert_allclose(ends, [[2.5 * math.pi / 2] * 2] * 2, rtol=1e-12)


@pytest.mark.parametrize(
    "path",
    [
        [tr.Straight(length=1e-6)],
        [tr.Straight(heading=k, length=1.0) for k in range(200)],
        [tr.Arc(radius=1e-4, angle="3 turn")],
        [tr.Curve(points=[(0, 0), (5, 0), (5, 0.001)])],
        [tr.Straight(length=1.0, heading="45 deg"), tr.Straight(length=1.0, heading="225 deg")] * 4,
    ],
)
def test_odd_paths_are_drawn(path: list[Any], tmp_path: Any) -> None:
    drawn = tr.roll_along(path, radius=0.3, title="$odd$")
    drawn.plot().savefig(tmp_path / "odd.png", dpi=40)
    everything = [image for ax in drawn.plot().axes for image in ax.images]
    assert 2 <= len(everything) <= 30


def test_all_of_a_ball_lies_within_the_map() -> None:
    """Home again, the ball is drawn beside its beginning; there must be room for it."""
    home = tr.PathScenario.load("roll-home-turned").run()
    ax = home.plot().axes[0]
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    for image in ax.images:
        x0, x1, y0, y1 = image.get_extent()
        assert left < x0 < x1 < right
        assert bottom < y0 < y1 < top


def test_a_path_is_frozen() -> None:
    path = rolled(tr.Straight(length=0.5))
    with pytest.raises(AttributeError):
        path.radius = 1.0  # type: ignore[misc]
    assert path.rotation.angle == pytest.approx(1.0, rel=1e-14)
    assert replace(path, radius=1.0).rotation.angle == pytest.approx(0.5, rel=1e-14)
