"""Figures of curved and moving supports, of bodies that lean, slip and fly: what is drawn is what happened."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import trundle as tr
from trundle.mechanics.algebra import Vector
from trundle.views.plots import ground, path_figure, series_figure
from trundle.views.plots.events import FLIGHT, ROLLING, SLIPPING, stretches_of
from trundle.views.plots.facts import facts_of
from trundle.views.plots.words import key_numbers, title_of

BALL = tr.Body.solid_sphere(radius=0.02, mass=0.05)
COIN = tr.Body.disc(radius=0.012, mass=0.0075)
SCALES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "µm": 1e-6}


def run_of(system: tr.RollingSystem, start: Any, duration: float, every: float) -> tr.Trajectory:
    # To be compiled takes longer than most of these motions do; where one comes off a dome, it is the other way round.
    method = "taylor" if isinstance(system.support.surface, tr.Dome) else "runge-kutta"
    return tr.simulate(system, start, duration=duration, every=every, method=method)


def on(surface: Any, start: dict[str, Any], duration: float = 0.8, body: Any = BALL, **support: Any) -> tr.Trajectory:
    system = tr.RollingSystem(body, tr.Support(surface, **support))
    return run_of(system, system.place(**start), duration, 0.01)


SIDE = [-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3]
RUNS: dict[str, Callable[[], tr.Trajectory]] = {
    "bowl spun": lambda: on(
        tr.Bowl(0.5, rim=0.4), {"position": (0.2, 0.0), "velocity": (0.0, 0.5)}, motion=tr.Spin(4.0)
    ),
    "closed bowl": lambda: on(tr.Bowl(0.2), {"velocity": (3.2, 0.4)}, 0.5),
    "elliptic bowl spun": lambda: on(
        tr.EllipsoidalBowl((0.5, 0.35, 0.25)), {"position": (0.2, 0.05), "velocity": (0.0, 0.2)}, motion=tr.Spin(2.0)
    ),
    "dome": lambda: on(tr.Dome(0.3), {"position": (0.05, 0.0), "velocity": (0.3, 0.1)}, 0.7, friction=0.3),
    "cone": lambda: on(tr.Cone("45 deg"), {"position": (0.25, 0.0), "velocity": (0.0, 0.9)}),
    "torus": lambda: on(tr.TorusTrack(0.4, 0.1), {"position": (0.0, 0.3), "velocity": (0.6, 0.0)}, tilt=0.1),
    "upright cylinder": lambda: on(tr.Cylinder(0.06), {"velocity": (0.8, 0.0), "spin": 3.0}),
    "leaning pipe": lambda: on(tr.Cylinder(0.1), {"position": (0.8, 0.0), "velocity": (0.0, 0.1)}, tilt="80 deg"),
    "height table": lambda: on(
        tr.HeightField.through(SIDE, SIDE, [[0.8 * x * x + 0.5 * y * y for y in SIDE] for x in SIDE]),
        {"position": (0.15, 0.05)},
        0.3,
    ),
    "saddle, shaken": lambda: on(
        tr.HeightField("0.3*(x**2 - y**2)"), {"position": (0.1, 0.0)}, motion=tr.Shake((0.02, 0.0, 0.0), 6.0)
    ),
    "rocking plane": lambda: on(tr.Plane(), {"position": (0.1, 0.1)}, motion=tr.Rock("5 deg", 3.0)),
    "start-up": lambda: on(tr.Plane(rim=0.5), {"position": (0.2, 0.0)}, 2.0, motion=tr.SpinBy("3.5*(1 - exp(-t/2))")),
    "free table": lambda: on(
        tr.Plane(rim=0.5), {"position": (0.2, 0.0), "velocity": (0.0, 0.3)}, 2.0, motion=tr.FreeAxle(2e-3, rate=3.0)
    ),
    "coin": lambda: on(tr.Plane(), {"attitude": (0.0, "40 deg", 0.0), "spin": 25.0}, 0.5, body=COIN),
    "coin in a dish": lambda: on(
        tr.Paraboloid(0.5, rim=0.3), {"position": (0.1, 0.0), "attitude": (1.5, "80 deg", 0.0), "spin": 5.0}, 0.4, COIN
    ),
    "drop on a turntable": lambda: on(
        tr.Plane(rim=0.5),
        {"position": (0.2, 0.0), "velocity": (0.0, 0.0), "angular_velocity": (0.0, 0.0, 0.0)},
        1.0,
        motion=tr.Spin(4.0),
        friction=0.1,
    ),
    "bouncing": lambda: on(
        tr.Plane(),
        {"velocity": (0.3, 0.1, 0.0), "height": 0.3, "angular_velocity": (0.0, 0.0, 0.0)},
        3.0,
        friction=0.3,
        restitution=0.8,
    ),
    "straight down": lambda: on(tr.Plane(), {"height": 0.3}, 1.0, friction=0.3, restitution=0.5),
}


@cache
def run(name: str) -> tr.Trajectory:
    return RUNS[name]()


def sheet(name: str, kind: str = "path") -> Any:
    return _drawn(name, kind)


@cache  # of both, for a cache does not know that a path left unsaid is a path
def _drawn(name: str, kind: str) -> Any:
    figure = {"path": path_figure, "series": series_figure}[kind](run(name))
    FigureCanvasAgg(figure).draw()
    return figure


def panel(figure: Any, title: str) -> Any:
    return next(ax for ax in figure.axes if ax.get_title(loc="left").startswith(title))


def by_label(figure: Any, label: str) -> Any:
    return next(ax for ax in figure.axes if ax.get_ylabel().startswith(label))


def scale_of(label: str) -> float:
    return SCALES[label.rsplit("(", 1)[1].rstrip(")").removesuffix("/s")]


def words_of(figure: Any) -> list[str]:
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


@pytest.mark.parametrize("kind", ["path", "series"])
@pytest.mark.parametrize("name", RUNS)
def test_nothing_leaves_the_sheet_or_lies_upon_something_else(name: str, kind: str) -> None:
    figure = sheet(name, kind)
    renderer = figure.canvas.get_renderer()
    flat = [ax for ax in figure.axes if ax.name != "3d"]
    boxes = [ax.get_tightbbox(renderer) for ax in flat]
    boxes += [legend.get_window_extent(renderer) for legend in figure.legends]
    boxes += [text.get_window_extent(renderer) for text in figure.texts]
    for i, box in enumerate(boxes):
        assert box.x0 >= -1.0
        assert box.y0 >= -1.0
        assert box.x1 <= figure.bbox.x1 + 1.0
        assert box.y1 <= figure.bbox.y1 + 1.0
        for other in boxes[:i]:
            across = min(box.x1, other.x1) - max(box.x0, other.x0)
            up = min(box.y1, other.y1) - max(box.y0, other.y0)
            # The marks of events stand on the upper edge of their panel.
            assert min(across, up) < (2.0 if kind == "path" else 8.0)


@pytest.mark.parametrize("name", RUNS)
def test_the_path_from_above_is_that_of_the_data(name: str) -> None:
    ax = next(ax for ax in sheet(name).axes if ax.get_title(loc="left"))
    if name == "straight down":  # from above it does not move
        assert not [line for line in ax.lines if line.get_label() == "path"]
        return
    drawn = np.vstack(
        [line.get_xydata() for line in ax.lines if line.get_color() == "#0072B2" and line.get_ls() != "None"]
    )
    scale = scale_of(ax.get_ylabel())
    drawn = drawn[np.all(np.isfinite(drawn), axis=1)] * scale
    across = "y" if ax.get_ylabel().startswith("x") else "x"
    place = run(name).data.position.sel(axis=[across, "y" if across == "x" else "x"]).values
    gaps = np.min(np.linalg.norm(place[:, None, :] - drawn[None, :, :], axis=2), axis=1)
    assert np.max(gaps) < 1e-9


def test_the_meridian_of_a_bowl_is_its_circle_up_to_the_rim() -> None:
    ax = panel(sheet("bowl spun"), "Meridian")
    (surface,) = [line for line in ax.lines if line.get_color() == "#5F5F5F" and len(line.get_xdata()) > 50]
    r, z = surface.get_xydata().T * scale_of(ax.get_xlabel())
    # The lines of a grid of 320 cells are off by less than a cell squared over 8 radii.
    assert np.allclose(np.hypot(r, z - 0.5), 0.5, rtol=0, atol=(0.45 / 320) ** 2 / 0.5)
    assert 0.4 - 0.45 / 300 < np.max(r) <= 0.4


def test_the_path_keeps_its_distance_from_the_meridian() -> None:
    ax = panel(sheet("cone"), "Meridian")
    scale = scale_of(ax.get_xlabel())
    (path,) = [
        line.get_xydata() * scale for line in ax.lines if line.get_color() == "#0072B2" and len(line.get_xdata()) > 9
    ]
    assert np.allclose((path[:, 1] - path[:, 0]) / math.sqrt(2), 0.02, rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("surface", "law", "bound"),
    [
        (tr.Cone("30 deg"), lambda x, y, z: np.hypot(x, y) - z * math.tan(math.radians(30.0)), 1e-5),
        (tr.TorusTrack(0.4, 0.1), lambda x, y, z: np.hypot(np.hypot(x, y) - 0.4, z) - 0.1, 1e-4),
        (tr.Dome(0.3), lambda x, y, z: np.sqrt(x * x + y * y + (z + 0.3) ** 2) - 0.3, 1e-4),
        (tr.HeightField("0.3*(x**2 - y**2)"), lambda x, y, z: z - 0.3 * (x * x - y * y), 1e-15),
        (tr.Cylinder(0.3), lambda x, y, z: np.hypot(x, y) - 0.3 + 0 * z, 1e-4),
    ],
)
def test_the_mesh_lies_on_the_surface(surface: Any, law: Any, bound: float) -> None:
    u, v = (0.3, 0.4) if surface.coordinates[0] == "angle" else (0.1, 0.15)
    places = surface.point(np.array([u, u + 0.05]), np.array([v, v])).array()
    window = ground.window_of(surface, places, 0.02)
    quads = ground.patches(surface, window)
    assert len(quads) > 300
    assert np.max(np.abs(law(*np.moveaxis(quads, -1, 0)))) < bound


def test_a_view_in_space_has_one_scale_for_all_axes() -> None:
    for name in ("bowl spun", "torus", "upright cylinder", "saddle, shaken"):
        (ax,) = [ax for ax in sheet(name).axes if ax.name == "3d"]
        spans = [np.ptp(limits) for limits in (ax.get_xlim(), ax.get_ylim(), ax.get_zlim())]
        shares = np.asarray(ax._box_aspect) / spans
        assert np.allclose(shares, shares[0])


def test_what_is_behind_a_dome_is_drawn_faint() -> None:
    (ax,) = [ax for ax in sheet("dome").axes if ax.name == "3d"]
    solid, faint = (line.get_data_3d() for line in ax.lines[:2])
    from trundle.views.plots.solid import _page

    eye = np.cross(*_page())
    for drawn, sense in ((solid, 1.0), (faint, -1.0)):
        places = np.array(drawn)[:, np.isfinite(drawn[0])]
        normal = (places + np.array([[0.0], [0.0], [0.3]])) / 0.3
        assert np.all(sense * (eye @ normal) > -0.05)


def test_a_surface_is_not_drawn_where_it_is_not_seen_at_rest() -> None:
    support, turning = (panel(sheet("elliptic bowl spun"), title) for title in ("Support", "Corotating"))
    assert not [c for c in support.collections if len(c.get_paths())]
    assert [c for c in turning.collections if len(c.get_paths())]
    # Of a bowl that is round the same heights are at the same places all the time.
    assert all(panel(sheet("bowl spun"), title).collections for title in ("Support", "Corotating"))


def test_contour_lines_are_heights_of_the_surface() -> None:
    ax = panel(sheet("bowl spun"), "Corotating")
    scale = scale_of(ax.get_ylabel())
    (said,) = [word for word in words_of(sheet("bowl spun")) if word.startswith("surface, every")]
    assert said == "surface, every 5 cm of height"
    (contours,) = ax.collections
    found = [np.hypot(*(path.vertices * scale).T) for path in contours.get_paths() if len(path.vertices) > 8]
    for radius in found:
        height = (0.5 - np.sqrt(0.25 - radius**2)) / 0.05
        assert np.allclose(height, np.round(height), atol=0.01)


def test_the_wall_of_a_cylinder_is_unrolled() -> None:
    ax = panel(sheet("upright cylinder"), "The wall")
    angle, z = next(line for line in ax.lines if len(line.get_xdata()) > 9).get_xydata().T
    place = run("upright cylinder").data.position.values
    assert np.allclose(np.exp(1j * np.radians(angle)), (place[:, 0] + 1j * place[:, 1]) / 0.04, rtol=0, atol=1e-9)
    assert np.allclose(z * scale_of(ax.get_ylabel()), place[:, 2])


def test_phases_follow_each_other_without_a_gap() -> None:
    stretches = stretches_of(run("dome"))
    assert [stretch.phase for stretch in stretches] == [ROLLING, SLIPPING, FLIGHT]
    slip, lift = run("dome").events
    assert [stretch.start for stretch in stretches] == [0.0, slip.time, lift.time]
    assert [stretch.end for stretch in stretches] == [slip.time, lift.time, run("dome").data.time.values[-1]]


def test_events_are_marked_where_they_happened() -> None:
    slip, lift = run("dome").events
    ax = panel(sheet("dome"), "Support")
    for event, marker in ((slip, "d"), (lift, "^")):
        (mark,) = [line for line in ax.lines if line.get_marker() == marker]
        assert np.allclose(mark.get_xydata()[0] * scale_of(ax.get_ylabel()), event.before.position[:2], atol=1e-12)
    assert any(word.startswith("began to slip, 0.") for word in words_of(sheet("dome")))
    assert any(word.startswith("came off the support, 0.") for word in words_of(sheet("dome")))


def test_events_are_ruled_and_phases_shaded_in_every_panel_of_the_series() -> None:
    slip, lift = run("dome").events
    figure = sheet("dome", "series")
    for ax in figure.axes:
        ruled = [segment[0][0] for lines in ax.collections for segment in lines.get_segments() if len(segment)]
        assert {slip.time, lift.time} <= {min(ruled, key=lambda t: abs(t - e.time)) for e in (slip, lift)}
        slipping, flight = ax.patches
        assert slipping.get_hatch() == "//"
        assert not flight.get_hatch()
        assert (slipping.get_x(), slipping.get_x() + slipping.get_width()) == pytest.approx((slip.time, lift.time))
        assert flight.get_x() == pytest.approx(lift.time)
    assert {"slipping", "in flight"} <= set(words_of(figure))


def test_slip_speed_and_normal_force_are_shown_where_there_is_slip() -> None:
    ax = by_label(sheet("drop on a turntable", "series"), "slip speed")
    times, speed = ax.lines[0].get_xydata().T
    # A ball put down on a sliding belt: the slip falls from 4 rad/s times 0.2 m by 7/2 μ g every second,
    # but for the turn of the belt under it, which is of second order.
    assert speed[0] * scale_of(ax.get_ylabel()) == pytest.approx(0.8)
    early = (times > 0.0) & (times < 0.06)
    fall = (0.8 - speed[early] * scale_of(ax.get_ylabel())) / times[early]
    assert np.allclose(fall, 3.5 * 0.1 * 9.80665, rtol=0.03)
    assert by_label(sheet("drop on a turntable", "series"), "contact").lines[0].get_label() == "N, normal"
    assert not [ax for ax in sheet("bowl spun", "series").axes if ax.get_ylabel().startswith("slip")]


def test_many_bounces_are_grouped_and_drawn_where_a_bouncing_ball_bounces() -> None:
    figure = sheet("bouncing")
    (said,) = [word for word in words_of(figure) if word.startswith("bounced")]
    assert int(said.split()[1]) > 20
    assert said.endswith("(5 marked)")
    ax = by_label(figure, "height")
    (marks,) = [line for line in ax.lines if line.get_marker() == "v"]
    height = marks.get_ydata() * scale_of(ax.get_ylabel())
    assert len(height) == 5
    assert np.allclose(height, -0.3, rtol=0, atol=1e-9)
    fall = math.sqrt(2 * 0.3 / 9.80665)
    times = [fall * (1 + 2 * sum(0.8**j for j in range(1, i + 1))) for i in range(4)]
    bounces = [event.time for event in run("bouncing").events[:4]]
    assert np.allclose(bounces, times, rtol=0, atol=1e-9)


def test_a_bounce_is_a_kink_however_few_the_samples() -> None:
    system = run("bouncing").system
    few = run_of(system, run("bouncing").start, 1.0, 0.2)
    ax = by_label(path_figure(few), "height")
    lowest = np.nanmin(np.concatenate([line.get_ydata() for line in ax.lines if len(line.get_xdata()) > 5]))
    assert lowest * scale_of(ax.get_ylabel()) == pytest.approx(-0.3, abs=1e-9)
    assert np.min(few.data.position.values[:, 2]) > 0.03  # no sample is as low


def test_a_ball_that_hops_on_the_spot_is_not_called_at_rest() -> None:
    texts = [text.get_text() for text in panel(sheet("straight down"), "Support").texts]
    assert "straight up and down" in texts
    assert "at rest" not in texts


def test_the_track_of_a_coins_contact_is_drawn() -> None:
    ax = panel(sheet("coin"), "Support")
    (track,) = [line for line in ax.lines if line.get_color() == "#007A5A" and len(line.get_xdata()) > 9]
    assert np.allclose(track.get_xydata() * scale_of(ax.get_ylabel()), run("coin").data.contact.values[:, :2])
    assert "track of the contact" in words_of(sheet("coin"))
    assert "track of the contact" not in words_of(sheet("bouncing"))


def test_the_lean_of_a_coin_is_that_of_its_axis() -> None:
    for name in ("coin", "coin in a dish"):
        ax = by_label(sheet(name, "series"), "lean")
        w, x, y, z = run(name).data.orientation.values.T
        axis = np.column_stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
        at = run(name).data.contact.values
        normal = np.column_stack([-at[:, 0] / 0.5, -at[:, 1] / 0.5, np.ones(len(at))])
        normal = normal / np.linalg.norm(normal, axis=1)[:, None] if name != "coin" else np.array([0.0, 0.0, 1.0])
        lean = np.degrees(np.arccos(np.sum(axis * normal, axis=1)))
        assert np.allclose(ax.lines[0].get_ydata(), lean, rtol=0, atol=1e-6)


def test_the_rate_of_a_table_that_does_not_keep_it_is_shown() -> None:
    free = by_label(sheet("free table", "series"), "rate of")
    assert np.allclose(free.lines[0].get_ydata(), run("free table").data.support_rate.values)
    ramp = by_label(sheet("start-up", "series"), "rate of")
    times, rate = ramp.lines[0].get_xydata().T
    assert np.allclose(rate, 3.5 * (1 - np.exp(-times / 2)), rtol=0, atol=1e-12)
    assert not [ax for ax in sheet("bowl spun", "series").axes if ax.get_ylabel().startswith("rate of")]


def test_moving_supports_are_seen_from_themselves_too() -> None:
    ax = panel(sheet("start-up"), "Corotating")
    drawn = next(line for line in ax.lines if line.get_label() == "path").get_xydata() * scale_of(ax.get_ylabel())
    place, angle = run("start-up").data.position.values, run("start-up").data.support_angle.values
    seen = (place[:, 0] + 1j * place[:, 1]) * np.exp(-1j * angle)
    assert np.min(np.abs(drawn[:, 0] + 1j * drawn[:, 1] - seen[-1])) < 1e-12
    assert panel(sheet("rocking plane"), "Seen from the table")
    assert facts_of(run("rocking plane")).rate == 0.0


@pytest.mark.parametrize(
    ("motion", "word"),
    [
        (tr.Fixed(), "fixed"),
        (tr.Spin(0.0), "fixed"),
        (tr.Spin(2.0), "turning"),
        (tr.SpinBy("3.5*(1 - exp(-t/2))"), "unevenly turning"),
        (tr.FreeAxle(0.03), "freely turning"),
        (tr.Rock("5 deg", 3.0), "rocking"),
        (tr.Shake((0.01, 0.0, 0.0), 6.0), "shaken"),
        (tr.Tilt("0.1*t"), "tilting"),
        (tr.PrecessingTilt(0.1, 2.0), "swirled"),
        (tr.Wobble(3.0, "1 deg"), "turning"),
        (tr.Combined((tr.Rock("3 deg", 2.0), tr.SpinBy("t"))), "rocking, unevenly turning"),
    ],
)
def test_a_title_says_how_the_support_moves(motion: Any, word: str) -> None:
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=motion))
    article = "an" if word.startswith("u") else "a"
    assert title_of(system) == f"Ball on {article} {word} plane"


def test_a_title_says_what_rolls_on_what() -> None:
    titles = {
        "bowl spun": "Ball in a turning bowl",
        "dome": "Ball on a fixed dome",
        "cone": "Ball inside a fixed cone",
        "torus": "Ball inside a fixed, tilted torus",
        "leaning pipe": "Ball inside a fixed cylinder",
        "elliptic bowl spun": "Ball in a turning elliptic bowl",
        "coin in a dish": "Disc in a fixed paraboloid",
        "free table": "Ball on a freely turning plane",
    }
    for name, title in titles.items():
        assert title_of(run(name).system) == title


def test_the_numbers_name_every_load() -> None:
    loads = {
        tr.RollingResistance(0.0005): "rolling resistance δ = 500 µm",
        tr.PivotFriction(0.0005): "pivot friction ε = 500 µm",
        tr.RollingCouple(2e-6): "rolling couple 2·10⁻⁶ N m s",
        tr.QuadraticDrag(0.01): "quadratic drag 0.01 kg/m",
        tr.Magnus(1e-4): "Magnus force, 0.0001 kg",
        tr.Motor((0.0, 1e-3, 0.0)): "motor torque 1 mN m",
        tr.Force(("0.1*t", 0.0, 0.0)): "force that varies",
        tr.Potential("0.5*3*x**2"): "potential U = 0.5·3·x^2",
    }
    support = tr.Support(tr.Plane(), friction=0.3, kinetic_friction=0.2, restitution=0.5)
    numbers = key_numbers(tr.RollingSystem(BALL, support, loads=tuple(loads)))
    assert [said for said in loads.values() if said not in numbers] == []
    assert "friction μ = 0.3, slipping 0.2" in numbers
    assert "restitution e = 0.5" in numbers


@pytest.mark.parametrize("combined", [False, True])
def test_the_rate_of_a_free_table_is_the_one_that_the_run_starts_with(combined: bool) -> None:
    axle = tr.FreeAxle(0.02, 5.0)
    motion = tr.Combined((tr.Shake((0.002, 0.0, 0.0), 30.0), axle)) if combined else axle
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=motion))
    assert "at first 5 rad/s" in key_numbers(system, system.place((0.1, 0.0)).support)
    assert "at first 3 rad/s" in key_numbers(system, system.place((0.1, 0.0), support=(0.5, 3.0)).support)


def test_a_surface_of_ones_own_is_drawn() -> None:
    from trundle.mechanics.surfaces import Surface

    class Trough(Surface):
        axisymmetric = False

        def level(self, p: Vector) -> Any:
            return p.z - p.x * p.x

        def point(self, u: Any, v: Any) -> Vector:
            return Vector(u, v, u * u)

    figure = path_figure(on(Trough(), {"position": (0.2, 0.0), "velocity": (0.0, 0.3)}))
    FigureCanvasAgg(figure).draw()
    assert [ax.get_title(loc="left") for ax in figure.axes][:2] == [
        "Support and world frame, from above",
        "From the side",
    ]
    assert title_of(on(Trough(), {"position": (0.2, 0.0)}, 0.1).system) == "Ball on a fixed surface"


@pytest.mark.parametrize("comes_back", [True, False])
def test_a_flight_that_comes_back_is_drawn_whole(comes_back: bool) -> None:
    """Thrown straight up it touches in one place, and the window round that is a tenth as high as its way."""
    start = {"velocity": (0.0, 0.0, 4.0), "height": 0.001}
    run = on(tr.Paraboloid(0.5), start, 2.0 if comes_back else 0.5, friction=0.3, restitution=0.8)
    assert any(event.kind == "land" for event in run.events) == comes_back
    (ax,) = (one for one in path_figure(run).axes if one.get_title(loc="left") == "Meridian plane")
    scale = SCALES[ax.get_xlabel().rpartition("(")[2].rstrip(")")]
    highest = scale * np.nanmax(np.concatenate([np.asarray(line.get_ydata(), float) for line in ax.lines]))
    reached = float(run.data.position.values[:, 2].max())
    assert reached > 0.6
    assert (abs(highest - reached) < 0.01 * reached) == comes_back
