"""Any body on any support under any loads: a run ends in finite numbers or in a named error, and within its time."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from tests import draws

import trundle as tr

TOO_LONG = 120  # s, for what takes a second; a run without end is what this is for
BALL = tr.Body.solid_sphere(0.02, 0.1)


class TooLong(BaseException):
    """Not an `Exception`, which something on the way might take for its own."""


@contextmanager
def bounded() -> Iterator[None]:
    """Give up on what does not end."""

    def stop(*_: Any) -> None:
        raise TooLong

    before = signal.signal(signal.SIGALRM, stop)
    signal.alarm(TOO_LONG)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def hold(system: tr.RollingSystem, told: dict[str, Any], method: str = "runge-kutta") -> str:
    """Run a system; return "" or the named error, and fail for all else. Warnings are errors in all tests."""
    with bounded():
        try:
            run = tr.simulate(system, system.place(**told), 0.2, 0.02, method)
        except tr.TrundleError as error:
            return str(error)
    for name, variable in run.data.data_vars.items():
        touching = run.data.phase.values != 2 if name == "slip_velocity" else slice(None)
        assert np.isfinite(variable.values[touching]).all(), name
    assert np.linalg.norm(run.data.orientation.values, axis=1) == pytest.approx(1.0, abs=1e-12)
    times = [event.time for event in run.events]
    assert times == sorted(times)
    return ""


few = settings(max_examples=30, suppress_health_check=list(HealthCheck))


@few
@given(draws.anything())
def test_any_run_ends_in_finite_numbers_or_in_a_named_error(
    drawn: tuple[tr.RollingSystem, dict[str, Any]],
) -> None:
    hold(*drawn)


def on(surface: Any, body: tr.Body = BALL, loads: tuple[Any, ...] = (), **support: Any) -> tr.RollingSystem:
    return tr.RollingSystem(body, tr.Support(surface, **support), loads)


# What once broke, hung or came out without a name.
ODD: dict[str, tuple[tr.RollingSystem, dict[str, Any]]] = {
    "a potential without a value where the ball starts": (
        on(tr.Bowl(0.5), loads=(tr.Potential("0.01/sqrt(x**2 + y**2)"),)),
        {},
    ),
    "a centre of mass where the surface's formula has no value": (
        on(tr.HeightField("sqrt(0.3 - x)"), tr.Body.solid_sphere(0.12, 0.4), friction=0.05, tilt=-1.0),
        {"position": (0.197, 0.0)},
    ),
    "a centre of mass where the dome has no normal": (
        on(tr.Dome(0.1), tr.Body.ellipsoid((0.17, 0.085, 0.05), 0.01), friction=0.0, restitution=0.6),
        {"position": (7.5e-5, 0.0)},
    ),
    "a couple that acts in contact only, on a body that nothing presses on": (
        tr.RollingSystem(
            tr.Body.eccentric_sphere(0.02, 0.02, [2.6e-6, 2.4e-6, 3.1e-6], [3e-3, -2e-3, 2e-3]),
            tr.Support(tr.Plane(), friction=0.3, restitution=1.0),
            (tr.RollingCouple(1.5e-3),),
            gravity=0.0,
        ),
        {"spin": 8.0},
    ),
    "a motor in a ball at rest, on which nothing else acts": (
        tr.RollingSystem(
            tr.Body.solid_sphere(0.1, 1.0),
            tr.Support(tr.Cone(1.1, "outside"), motion=tr.SpinBy("5*sin(4*t)"), friction=0.3),
            (tr.Motor((3e-4, 9e-4, 3e-4)),),
            gravity=0.0,
        ),
        {"position": (-0.2, 0.1), "velocity": "co-rotating"},
    ),
    "two turns by formulas": (
        on(tr.Cylinder(1.0), motion=tr.Combined((tr.SpinBy("3 + 2*t"), tr.SpinBy("1 + t"))), friction=0.0),
        {},
    ),
    "a half cylinder dropped on a dome": (
        on(tr.Dome(1.0), tr.Body.half_cylinder(0.2, 1.4), motion=tr.Wobble(-13.0, 0.02), friction=1.0),
        {"velocity": (-0.4, 0.0), "height": 0.05},
    ),
    "a coin thrown flat": (
        on(tr.Dome(0.9), tr.Body.disc(0.04, 1.0), friction=0.3),
        {"position": (0.3, 0.0), "velocity": (-0.6, 0.1, 0.6), "attitude": (0.2, 0.0, 0.2)},
    ),
}


@pytest.mark.parametrize("name", ODD)
def test_what_once_broke_does_not(name: str) -> None:
    hold(*ODD[name])


@pytest.mark.parametrize(
    ("surface", "body"),
    [
        (tr.EllipsoidalBowl((0.5, 0.4, 0.3)), tr.Body.ellipsoid((0.03, 0.02, 0.02), 0.1)),
        (tr.HeightField("0.2*x*y"), BALL),
    ],
)
def test_the_compiled_method_takes_them_too(surface: Any, body: tr.Body) -> None:
    system = on(surface, body, motion=tr.Spin(2.0), friction=0.3)
    assert hold(system, {"position": (0.1, 0.05), "velocity": (0.0, 0.3)}, "taylor") == ""


def start(system: Callable[[], tr.RollingSystem], **told: Any) -> Callable[[], Any]:
    """Return what puts a body down, and runs it."""
    return lambda: tr.simulate(system(), system().place(**{"position": (0.1, 0.0), **told}), 5.0, 0.1, "runge-kutta")


def plane(**support: Any) -> Callable[[], tr.RollingSystem]:
    return lambda: on(tr.Plane(rim=0.5), **support)


BAD: dict[str, tuple[Callable[[], Any], str]] = {
    "too big for the bowl": (
        start(lambda: on(tr.Bowl(0.3), tr.Body.solid_sphere(0.4, 1.0))),
        r"`position` must be where the body fits the surface.*0\.4 m.*0\.3 m",
    ),
    "too big for the walls beside a hill": (
        start(lambda: on(tr.HeightField("500*x**4 - 0.5*x**2"), tr.Body.solid_sphere(0.2, 1.0)), position=(0.0, 0.0)),
        r"`position` must keep the whole body clear of the surface.*lies.*below",
    ),
    "inside the support": (
        lambda: tr.simulate(plane()(), tr.State((0.1, 0.0, 0.01), (0, 0, 0), (0, 0, 0)), 1.0, 0.1),
        r"`start\.position` must put the body on the support or over it.*-0\.01 m",
    ),
    "beyond the rim": (start(plane(), position=(0.6, 0.0)), r"`position` must lie inside the rim at 0\.5 m"),
    "at an apex": (
        start(lambda: on(tr.Cone("45 deg", "outside")), position=(0.0, 0.0)),
        "`position` must be where the surface is smooth",
    ),
    "at a crease": (
        start(lambda: on(tr.HeightField("0.2*abs(x)")), position=(0.0, 0.1)),
        "`position` must be on the surface, where it is smooth.*crease",
    ),
    "beyond the formula": (
        start(lambda: on(tr.HeightField("sqrt(0.3 - x)")), position=(0.4, 0.0)),
        "`position` must be on the surface",
    ),
    "a rate that is not finite": (
        start(plane(motion=tr.SpinBy("1/(t - 3)"))),
        r"`support\.motion\.rate` must be finite.*'1/\(t - 3\)'.*at t = 3 s",
    ),
    "a tilt that is not finite at once": (
        start(plane(motion=tr.Tilt("0.1*log(t)"))),
        r"`support\.motion\.angle` must be finite.*at t = 0 s",
    ),
    "a force that is not finite": (
        start(lambda: on(tr.Plane(), loads=(tr.Force((0, "tan(t)", 0)),))),
        r"`loads\[0\]\.value\[1\]` must be finite.*at t = 1\.57079633 s",
    ),
    "kinetic above static friction": (plane(friction=0.2, kinetic_friction=0.3), "`kinetic_friction` must be at most"),
    "kinetic friction alone": (plane(kinetic_friction=0.3), "`kinetic_friction` must stand beside `friction`"),
    "restitution above one": (plane(friction=0.2, restitution=1.2), r"`restitution` must lie in \[0, 1\].*1\.2"),
    "friction below nothing": (plane(friction=-0.2), "`friction` must"),
    "attitude and orientation": (
        start(plane(), attitude=(0, 1, 0), orientation=(1, 0, 0, 0)),
        "`attitude` must not stand beside `orientation`",
    ),
    "a negative height": (start(plane(), height=-0.1), "`height` must"),
    "slip without friction": (
        start(plane(), velocity=(1.0, 0.0), angular_velocity=(0.0, 0.0, 0.0)),
        r"`angular_velocity` must agree with rolling.*no `friction`.*1 m/s",
    ),
    "a coin laid flat": (
        start(lambda: on(tr.Plane(), tr.Body.disc(0.01, 0.005))),
        "`orientation` must let the body touch in one point",
    ),
    "a hemisphere on its edge": (
        start(lambda: on(tr.Plane(), tr.Body.hemisphere(0.1, 1.0)), attitude=(0.0, "100 deg", 0.0)),
        "`attitude` must let the body touch in one point of its round side",
    ),
    "the number of components": (start(plane(), position=(0.1, 0.0, 0.0)), "`position` must be a list of 2"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_named(name: str) -> None:
    wrong, said = BAD[name]
    with bounded(), pytest.raises(tr.InvalidValueError, match=said):
        wrong()
