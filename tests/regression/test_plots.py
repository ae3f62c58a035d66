"""The figures show the data that they are given, in named units and frames, whatever the motion's size."""

from __future__ import annotations

import io
import math
import subprocess
import sys
from dataclasses import dataclass, field
from functools import cache
from types import SimpleNamespace
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Ellipse

import trundle as tr
from trundle.views.plots import path_figure, series_figure

OMEGA = 3.487  # rad/s
SCALES = {"10⁷ m": 1e7, "km": 1e3, "m": 1.0, "cm": 1e-2, "mm": 1e-3, "µm": 1e-6, "nm": 1e-9}


@dataclass
class Run:
    """A ball on a plane by the formulas of the theory page, section 5, in NumPy's complex exponentials."""

    rate: float = OMEGA
    tilt: float = 0.0
    rim: float | None = None
    friction: float | None = None
    k: float = 0.4
    radius: float = 0.025
    mass: float = 0.065
    position: complex = 0.1
    velocity: complex = 0.0
    force: complex = 0.0
    torque: complex = 0.0
    duration: float = 20.0
    samples: int = 2001
    title: str = "A ball on a table"
    until_rim: bool = False
    frame: str = "support"
    events: tuple[Any, ...] = ()
    data: xr.Dataset = field(init=False)

    def __post_init__(self) -> None:
        motion = tr.Spin(self.rate) if self.rate else tr.Fixed()
        support = tr.Support(tr.Plane(rim=self.rim), motion=motion, tilt=self.tilt, friction=self.friction)
        body = tr.Body.sphere(radius=self.radius, mass=self.mass, inertia_ratio=self.k)
        loads: tuple[Any, ...] = ()
        if self.force:
            loads += (tr.Force((self.force.real, self.force.imag, 0.0)),)
        if self.torque:
            loads += (tr.Torque((self.torque.real, self.torque.imag, 0.0)),)
        self.system = tr.RollingSystem(body, support, loads=loads)
        at = (complex(self.position).real, complex(self.position).imag)
        along = (complex(self.velocity).real, complex(self.velocity).imag)
        self.start = self.system.place(position=at, velocity=along)
        self.time = np.linspace(0.0, self.duration, self.samples)
        if self.until_rim:
            inside = np.abs(self.zeta) < self.rim
            self.time = self.time[: np.argmin(inside) + 1]
            self.events = (SimpleNamespace(time=float(self.time[-1]), kind="rim", text="ran off the rim"),)
        self.data = self._dataset()

    @property
    def kappa(self) -> float:
        return self.rate * self.k / (1 + self.k)

    @property
    def phi(self) -> complex:
        pull = self.mass * 9.80665 * math.sin(self.tilt) + self.force
        return (pull - 1j * self.torque / self.radius) / (self.mass * (1 + self.k))

    @property
    def zeta(self) -> np.ndarray:
        t, V = self.time, complex(self.velocity)
        if not self.rate:
            return self.position + V * t + self.phi * t * t / 2
        drift = 1j * self.phi / self.kappa
        return self.position + drift * t + (V - drift) * (np.exp(1j * self.kappa * t) - 1) / (1j * self.kappa)

    @property
    def zeta_dot(self) -> np.ndarray:
        t, V = self.time, complex(self.velocity)
        if not self.rate:
            return V + self.phi * t
        drift = 1j * self.phi / self.kappa
        return drift + (V - drift) * np.exp(1j * self.kappa * t)

    @property
    def guide(self) -> np.ndarray:
        """The centre of curvature of what is left of the motion when the drift is taken off."""
        return self.zeta + 1j * (self.zeta_dot - 1j * self.phi / self.kappa) / self.kappa

    def _dataset(self) -> xr.Dataset:
        zeta, dot = self.zeta, self.zeta_dot
        acceleration = 1j * self.kappa * dot + self.phi
        R = self.mass * acceleration - self.mass * 9.80665 * math.sin(self.tilt) - self.force
        Omega = (1j * dot + self.rate * zeta) / self.radius
        normal = np.full_like(self.time, self.mass * 9.80665 * math.cos(self.tilt))
        arrays = {
            "position": _columns(zeta, self.radius),
            "contact": _columns(zeta, 0.0),
            "velocity": _columns(dot, 0.0),
            "angular_velocity": _columns(Omega, 0.5),
            "contact_force": np.column_stack([R.real, R.imag, normal]),
        }
        if self.frame == "world":
            c, s = math.cos(self.tilt), math.sin(self.tilt)
            turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
            arrays = {name: values @ turn.T for name, values in arrays.items()}
        elif self.frame == "corotating":
            back = np.exp(-1j * self.rate * self.time)
            arrays["position"] = _columns(zeta * back, self.radius)
            arrays["velocity"] = _columns((dot - 1j * self.rate * zeta) * back, 0.0)
        variables = {name: (("time", "axis"), values) for name, values in arrays.items()}
        return xr.Dataset(variables, {"time": self.time, "axis": list("xyz")}, {"title": self.title})

    def in_frame(self, name: str) -> Run:
        other = object.__new__(Run)
        other.__dict__.update(self.__dict__)
        other.frame = name
        other.data = other._dataset()
        return other


def _columns(plane: np.ndarray, third: float) -> np.ndarray:
    return np.column_stack([plane.real, plane.imag, np.full(len(plane), third)])


CASES = {
    "tilted": Run(tilt=math.radians(3.0), duration=60.0, samples=6001, friction=0.3),
    "nudged": Run(velocity=0.1j, rim=0.5),
    "put down": Run(rim=0.5, duration=60.0),
    "put down, no rim": Run(duration=60.0),
    "at rest on the axis": Run(position=0.0),
    "co-rotating": Run(velocity=0.1j * OMEGA, rim=0.8),
    "off the rim": Run(tilt=math.radians(3.0), rim=0.5, until_rim=True, friction=0.3),
    "hollow": Run(k=2 / 3, tilt=math.radians(1.0), rim=0.5, until_rim=True),
    "negative": Run(rate=-3.0, tilt=math.radians(-2.0), duration=8.0),
    "straight": Run(rate=0.0, position=0.0, force=0.05 + 0.02j, duration=10.0),
    "torque": Run(rate=0.0, position=0.0, torque=0.0005j, velocity=0.2j, duration=5.0),
    "force on a turntable": Run(force=0.02 + 0.01j, duration=30.0),
    "force across a turntable": Run(force=0.05j, duration=30.0),
    "slope": Run(rate=0.0, tilt=math.radians(10.0), velocity=0.3j, duration=3.0),
    "straight down": Run(rate=0.0, tilt=math.radians(10.0), duration=3.0),
    "200 turns": Run(velocity=0.1j, duration=1260.0, samples=6001),
    "200 turns, tilted": Run(tilt=math.radians(0.05), velocity=0.3j, duration=1260.0, samples=12001),
    "200 turns, drifting far": Run(tilt=math.radians(3.0), duration=1260.0, samples=12001),
    "tiny": Run(velocity=2e-6j),
    "tiny ball": Run(radius=1e-5, mass=1e-11, position=0.0, velocity=2e-6j),
    "huge": Run(rate=0.001, tilt=math.radians(3.0), position=0.0, duration=20000.0),
    "two samples": Run(rate=0.0, velocity=0.1 + 0.05j, samples=2),
    "two samples on a turntable": Run(velocity=0.1j, samples=2),
    "at rest on a fixed plane": Run(rate=0.0),
    "one sample": Run(tilt=math.radians(1.0), samples=1),
    "three samples": Run(tilt=math.radians(1.0), samples=3, duration=1.0),
    "drifting straight": Run(
        tilt=math.radians(1.0), velocity=1j * 9.80665 * math.sin(math.radians(1.0)) / (0.4 * OMEGA)
    ),
    "few samples": Run(velocity=0.1j, duration=60.0, samples=41),
    "barely turning": Run(rate=1e-9, velocity=0.1j, duration=5.0),
    "a long title": Run(velocity=0.1j, title="A $title$ of\nmany words " * 20),
}


@pytest.fixture(params=CASES)
def name(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(params=["path", "series"])
def figure(name: str, request: pytest.FixtureRequest) -> Any:
    return sheet_of(name, request.param)


def sheet_of(name: str, kind: str = "path") -> Any:
    """A figure, drawn once for all tests that look at it."""
    return _drawn(name, kind)


@cache  # of both, for a cache does not know that a path left unsaid is a path
def _drawn(name: str, kind: str) -> Any:
    figure = {"path": path_figure, "series": series_figure}[kind](CASES[name])
    FigureCanvasAgg(figure).draw()
    return figure


def rendered(figure: Any) -> bytes:
    picture = io.BytesIO()
    figure.savefig(picture, format="png", dpi=60)
    return picture.getvalue()


def panel(figure: Any, title: str) -> Any:
    return next(ax for ax in figure.axes if ax.get_title(loc="left").startswith(title))


def path_of(ax: Any) -> np.ndarray:
    """The drawn path as x + iy in m, whichever way the page is turned."""
    (line,) = [line for line in ax.lines if line.get_label() == "path"]
    across, up = scale_of(ax.get_xlabel() or "(m)"), scale_of(ax.get_ylabel())
    if "y" in (ax.get_xlabel() or "y").lower()[:1]:
        return line.get_ydata() * up + 1j * line.get_xdata() * (across if ax.get_xlabel() else up)
    return line.get_xdata() * across + 1j * line.get_ydata() * up


def scale_of(label: str) -> float:
    return SCALES[label.rsplit("(", 1)[1].rstrip(")")]


def test_every_kind_of_run_is_drawn_without_a_warning(figure: Any) -> None:
    picture = np.asarray(figure.canvas.buffer_rgba())
    assert np.all(picture[0, :, :3] == 255)
    assert np.count_nonzero(picture[..., :3] < 128) > 3000


def test_nothing_leaves_the_sheet_or_lies_upon_something_else(figure: Any) -> None:
    renderer = figure.canvas.get_renderer()
    sheet = figure.bbox
    boxes = [ax.get_tightbbox(renderer) for ax in figure.axes]
    boxes += [legend.get_window_extent(renderer) for legend in figure.legends]
    boxes += [text.get_window_extent(renderer) for text in figure.texts]
    for i, box in enumerate(boxes):
        assert box.x0 >= -1.0
        assert box.y0 >= -1.0
        assert box.x1 <= sheet.x1 + 1.0
        assert box.y1 <= sheet.y1 + 1.0
        for other in boxes[:i]:
            across = min(box.x1, other.x1) - max(box.x0, other.x0)
            up = min(box.y1, other.y1) - max(box.y0, other.y0)
            assert min(across, up) < 2.0


def test_ticks_are_numbers_and_short(figure: Any) -> None:
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            assert np.all(np.isfinite(axis.get_ticklocs()))
            assert axis.get_offset_text().get_text() == ""
            assert all(len(label.get_text()) <= 6 for label in axis.get_ticklabels())


def test_axes_name_their_units(name: str) -> None:
    maps = sheet_of(name).axes
    assert all("(" in ax.get_ylabel() for ax in maps)
    assert any("(" in ax.get_xlabel() for ax in maps)
    series = sheet_of(name, "series").axes
    for ax in series:
        assert ax.get_ylabel() == "" or "(" in ax.get_ylabel() or "|f|/N" in ax.get_ylabel()
    assert series[-1].get_xlabel().startswith("time (")


def test_maps_have_equal_aspect(name: str) -> None:
    for ax in [ax for ax in sheet_of(name).axes if ax.get_title(loc="left")]:
        box = ax.get_window_extent()
        (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
        assert abs(right - left) / box.width == pytest.approx(abs(high - low) / box.height, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "titles"),
    [
        ("tilted", ["Support frame, first 13 s", "World frame, from above", "Corotating frame"]),
        (
            "200 turns, drifting far",
            ["Support frame, first 13 s", "World frame, from above", "Corotating frame, first 13 s"],
        ),
        ("off the rim", ["Support frame", "World frame, from above", "Corotating frame"]),
        ("nudged", ["Support and world frame", "Corotating frame"]),
        ("slope", ["Support frame", "World frame, from above"]),
        ("straight", ["Support and world frame"]),
    ],
)
def test_only_frames_that_tell_something_are_shown(name: str, titles: list[str]) -> None:
    shown = [ax.get_title(loc="left") for ax in sheet_of(name).axes]
    assert [title for title in shown if title] == titles


@pytest.mark.parametrize("name", ["off the rim", "hollow", "negative", "nudged", "co-rotating", "straight", "huge"])
def test_the_path_drawn_is_the_path_given(name: str) -> None:
    run = CASES[name]
    figure = sheet_of(name)
    expected = {"Support": run.zeta, "Corotating": run.zeta * np.exp(-1j * run.rate * run.time)}
    for title, zeta in expected.items():
        if title == "Corotating" and not run.rate:
            continue
        assert np.allclose(path_of(panel(figure, title)), zeta, rtol=0, atol=1e-12 * np.max(np.abs(zeta)))
    if run.tilt:
        seen = run.zeta.real * math.cos(run.tilt) + run.radius * math.sin(run.tilt) + 1j * run.zeta.imag
        drawn = path_of(panel(figure, "World"))
        assert np.allclose(drawn, seen, rtol=0, atol=1e-12 * np.max(np.abs(seen)))


def test_a_slope_falls_towards_the_reader_and_the_view_is_from_above() -> None:
    for name in ("off the rim", "negative"):
        run = CASES[name]
        ax = panel(sheet_of(name), "Support")
        # Pixels of the origin and of the ends of the two axes of the plane: (across, up) = (y, x).
        origin, x, y = ax.transData.transform([(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)])
        downhill = math.copysign(1.0, run.tilt) * (x - origin)
        assert downhill[1] < 0.0
        assert np.linalg.det([x - origin, y - origin]) > 0.0


def test_a_tiny_path_is_counted_from_its_start() -> None:
    run = CASES["tiny"]
    ax = panel(path_figure(run), "Support")
    assert ax.get_xlabel() == "x − 10 cm (µm)"
    (line,) = [line for line in ax.lines if line.get_label() == "path"]
    assert np.allclose(line.get_xdata(), (run.zeta.real - 0.1) / 1e-6, atol=1e-9)


def test_the_guiding_centre_drawn_is_the_centre_of_curvature() -> None:
    for name in ("off the rim", "hollow", "negative", "force on a turntable"):
        run = CASES[name]
        ax = panel(path_figure(run), "Support")
        turned = ax.get_xlabel().startswith("y")
        scale = scale_of(ax.get_ylabel())
        lines = [line.get_xydata() * scale for line in ax.lines if line.get_color() == "#D55E00" and line.is_dashed()]
        (track,) = lines
        drawn = track[:, 1] + 1j * track[:, 0] if turned else track[:, 0] + 1j * track[:, 1]
        assert np.allclose(drawn[[0, -1]], run.guide[[0, -1]], rtol=0, atol=1e-10)


def test_the_guiding_centre_at_rest_is_a_mark() -> None:
    run = Run(velocity=0.1 + 0.05j, rim=0.5)
    ax = panel(path_figure(run), "Support")
    (mark,) = [line for line in ax.lines if line.get_marker() == "D"]
    assert np.allclose(mark.get_xydata()[0] * 0.01, [run.guide[0].real, run.guide[0].imag], atol=1e-12)


def test_there_is_no_guiding_centre_where_nothing_turns() -> None:
    for name in ("straight", "slope", "torque"):
        for ax in sheet_of(name).axes:
            assert not [line for line in ax.lines if line.get_color() == "#D55E00"]


def test_a_guiding_centre_far_away_is_not_claimed() -> None:
    figure = sheet_of("barely turning")
    texts = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert not [text for text in texts if "guiding" in text]
    assert figure.texts[1].get_text().startswith("table 10⁻⁹ rad/s")


def test_a_real_run_is_drawn_in_the_frames_of_its_trajectory() -> None:
    run = tr.Scenario.load("tilted-turntable-put-down").run()
    ax = panel(path_figure(run), "World")
    (track,) = [line for line in ax.lines if line.get_color() == "#D55E00" and line.is_dashed()]
    # Over whole circles the ball's mean place downhill is the guiding centre's.
    circle = 2 * math.pi / (run.system.support.motion.rate * 2 / 7)
    seen = run.at(np.linspace(0.0, circle, 720, endpoint=False)).in_frame("world").data["position"].values
    assert np.allclose(track.get_ydata() * scale_of(ax.get_ylabel()), np.mean(seen[:, 0]), rtol=0, atol=1e-12)


def of_each_kind() -> list[str]:
    """One shipped scenario for each combination of body, surface and motion of the support."""
    found: dict[tuple[type, ...], str] = {}
    for name in tr.Scenario.names():
        try:
            system = tr.Scenario.load(name).system()
        except tr.TrundleError:  # one without a system: where forces play no part
            continue
        support = system.support
        found.setdefault((type(system.body.shape), type(support.surface), type(support.motion)), name)
    return list(found.values())


@pytest.mark.parametrize("scenario", of_each_kind())
def test_shipped_scenarios_are_drawn_by_their_trajectory(scenario: str) -> None:
    run = tr.Scenario.load(scenario).run()
    for kind in ("path", "series"):
        assert rendered(run.plot(kind)).startswith(b"\x89PNG")


def test_the_strip_shows_heights_above_the_start() -> None:
    run = CASES["off the rim"]
    figure = path_figure(run)
    strip = next(ax for ax in figure.axes if ax.get_ylabel().startswith("height"))
    (line,) = [line for line in strip.lines if len(line.get_xdata()) == len(run.time) and not line.is_dashed()]
    fall = -math.sin(run.tilt) * (run.zeta.real - run.zeta.real[0])
    assert np.allclose(line.get_ydata() * scale_of(strip.get_ylabel()), fall, atol=1e-12)
    (mean,) = [line for line in strip.lines if line.get_color() == "#D55E00" and line.is_dashed()]
    level = -math.sin(run.tilt) * (run.guide[0].real - 0.1)
    assert np.allclose(mean.get_ydata() * scale_of(strip.get_ylabel()), level, atol=1e-12)
    assert strip.get_xlim() == panel(figure, "World").get_xlim()


def test_the_rim_has_its_radius_and_is_foreshortened_from_above() -> None:
    figure = sheet_of("off the rim")
    flat, seen = (panel(figure, name).patches[0] for name in ("Support", "World"))
    assert isinstance(flat, Ellipse)
    assert (flat.width, flat.height) == pytest.approx((100.0, 100.0))  # cm; y across, x up the page
    assert (seen.width, seen.height) == pytest.approx((100.0, 100.0 * math.cos(math.radians(3.0))))


def test_an_event_is_marked_where_it_happened() -> None:
    run = CASES["off the rim"]
    figure = path_figure(run)
    (mark,) = [line for line in panel(figure, "Support").lines if line.get_marker() == "X"]
    assert np.allclose(mark.get_xydata()[0] * 0.01, [run.zeta[-1].imag, run.zeta[-1].real], atol=1e-12)
    texts = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert any(text.startswith("ran off the rim, 1.5") for text in texts)


def test_a_ball_put_down_stays_and_says_so() -> None:
    figure = sheet_of("put down")
    support = panel(figure, "Support")
    assert "at rest" in [text.get_text() for text in support.texts]
    assert not [line for line in support.lines if line.get_label() == "path"]
    assert np.allclose(np.abs(path_of(panel(figure, "Corotating"))), 0.1, atol=1e-6)


def test_a_coarsely_sampled_circle_is_drawn_round() -> None:
    run = Run(velocity=0.1j, duration=60.0, samples=61)  # six samples a turn; 2 to 3 where the table turns
    figure = path_figure(run)
    drawn = path_of(panel(figure, "Support"))
    assert len(drawn) > 400
    assert np.allclose(np.abs(drawn - run.guide[0]), abs(0.1 - run.guide[0]), rtol=2e-2)
    assert {complex(round(z.real, 12), round(z.imag, 12)) for z in run.zeta} <= {
        complex(round(z.real, 12), round(z.imag, 12)) for z in drawn
    }
    assert not [
        line for line in panel(figure, "Corotating").lines if line.get_label() == "path" and line.get_ls() != "None"
    ]


def test_a_long_line_is_thinned_without_a_visible_change() -> None:
    run = Run(velocity=0.1j, duration=20.0, samples=400_001)
    drawn = path_of(panel(path_figure(run), "Support"))
    assert len(drawn) <= 100_000
    places = np.linspace(0, len(drawn) - 1, 4001).astype(int)
    assert np.allclose(np.abs(drawn[places] - run.guide[0]), abs(0.1 - run.guide[0]), rtol=1e-9)
    for ax in series_figure(run).axes:
        assert all(len(line.get_xdata()) <= 100_000 for line in ax.lines)


def test_thinned_series_keep_their_extremes() -> None:
    run = Run(velocity=0.1j, duration=5000.0, samples=300_001)
    figure = series_figure(run)
    whole = next(ax for ax in figure.axes if ax.get_title(loc="left").startswith("all"))
    x = whole.lines[0].get_ydata() * scale_of(figure.axes[0].get_ylabel())
    assert (x.min(), x.max()) == (pytest.approx(run.zeta.real.min()), pytest.approx(run.zeta.real.max()))


def test_many_turns_show_the_first_and_all() -> None:
    figure = series_figure(CASES["200 turns"])
    titles = [ax.get_title(loc="left") for ax in figure.axes if ax.get_title(loc="left")]
    assert titles == ["first 5 turns", "all 200 turns"]
    first = next(ax for ax in figure.axes if ax.get_xlabel())
    assert first.get_xlim()[1] == pytest.approx(5 * 2 * math.pi / CASES["200 turns"].kappa, rel=0.01)


def test_series_show_the_data_in_their_units() -> None:
    run = CASES["off the rim"]
    position, speed, turning, force, friction, height = series_figure(run).axes
    assert position.get_ylabel() == "position (cm)"
    assert np.allclose(position.lines[0].get_ydata() * 0.01, run.zeta.real)
    assert np.allclose(position.lines[1].get_ydata() * 0.01, run.zeta.imag)
    assert np.allclose(speed.lines[0].get_ydata() * 0.01, np.abs(run.zeta_dot))
    assert turning.get_ylabel().endswith("(rad/s)")
    assert np.allclose(turning.lines[0].get_ydata() * run.radius, (1j * run.zeta_dot + run.rate * run.zeta).real)
    assert force.get_ylabel().endswith("(mN)")
    R = run.data["contact_force"].values
    assert np.allclose(force.lines[0].get_ydata() * 1e-3, R[:, 2])
    assert np.allclose(force.lines[1].get_ydata() * 1e-3, np.hypot(R[:, 0], R[:, 1]))
    assert np.allclose(friction.lines[0].get_ydata(), np.hypot(R[:, 0], R[:, 1]) / R[:, 2])
    assert height.get_ylabel() == "height\nabove start (mm)"


@pytest.mark.parametrize("side", ["inside", "outside"])
def test_a_contact_force_of_rounding_is_drawn_as_none_beside_the_weight(side: str) -> None:
    wall = tr.Support(tr.Cylinder(0.355, side=side), friction=0.4)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.03, 0.1), wall)  # falls freely along it, whichever way it drifts
    run = tr.simulate(system, system.place((-0.1, -0.05), velocity=(0.0, 0.1)), 0.6, 0.05)
    largest = np.abs(run.data["contact_force"].values).max()
    assert 0 < largest < 1e-12
    axes = {ax.get_ylabel(): ax for ax in series_figure(run).axes}
    (force,) = (ax for label, ax in axes.items() if label.startswith("contact"))
    assert force.get_ylim()[1] > 1e6 * largest
    assert not any(label.startswith("friction") for label in axes)


def test_friction_offered_is_a_line_or_a_sentence() -> None:
    near, far = (series_figure(Run(tilt=math.radians(3.0), friction=mu)).axes[4] for mu in (0.2, 20.0))
    assert near.lines[-1].get_ydata()[0] == pytest.approx(0.2)
    assert "μ = 0.2" in [text.get_text() for text in near.texts]
    assert len(far.lines) == 1
    assert "the support offers μ = 20" in far.texts[0].get_text()


def test_the_users_settings_are_neither_used_nor_changed() -> None:
    def pixels(figure: Any) -> np.ndarray:
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        return np.array(canvas.buffer_rgba())

    run = CASES["off the rim"]
    saved, shown = rendered(path_figure(run)), pixels(path_figure(run))
    theirs = {"font.size": 30.0, "axes.facecolor": "red", "lines.linewidth": 9.0, "axes.unicode_minus": False}
    with mpl.rc_context(theirs | {"savefig.transparent": True}):
        before = dict(mpl.rcParams)
        assert rendered(path_figure(run)) == saved
        assert np.array_equal(pixels(path_figure(run)), shown)
        assert dict(mpl.rcParams) == before


def test_a_notebook_shows_the_figure() -> None:
    assert sheet_of("nudged")._repr_png_().startswith(b"\x89PNG")


def test_other_formats_are_saved_too() -> None:
    for kind, start in (("svg", b"<?xml"), ("pdf", b"%PDF")):
        picture = io.BytesIO()
        path_figure(CASES["nudged"]).savefig(picture, format=kind)
        assert picture.getvalue().startswith(start)


def test_titles_of_any_script_are_shown_plainly() -> None:
    figure = path_figure(Run(velocity=0.1j, title="転がる球 costs $5 and $6"))
    assert figure.texts[0].get_text() == "転がる球 costs $5 and $6"
    rendered(figure)


def test_importing_the_room_loads_no_matplotlib() -> None:
    code = "import sys, trundle.views.plots; print('matplotlib' in sys.modules)"
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)  # noqa: S603
    assert answer.stdout.strip() == "False"
