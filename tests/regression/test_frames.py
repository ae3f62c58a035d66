"""The frame fixed to a support that moves in any way: by hand, by finite differences, and there and back."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import xarray as xr

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.solve import frames

BALL = tr.Body.solid_sphere(radius=0.02, mass=0.05)
MOTIONS = {
    "spin by a formula": tr.SpinBy("3.5*(1 - exp(-t/2))"),
    "free axle": tr.FreeAxle(0.03, rate=3.0, bearing_drag=0.01),
    "rock": tr.Rock("5 deg", 3.0, axis=(1.0, 2.0, 0.0)),
    "shake": tr.Shake((0.02, 0.0, 0.005), 6.0, "0.3 rad"),
    "wobble": tr.Wobble(3.5, "2 deg"),
    "tilt": tr.Tilt("0.05*t"),
    "precessing tilt": tr.PrecessingTilt("3 deg", 2.0),
    "a turntable on a shaking one": tr.Combined((tr.Shake((0.02, 0.0, 0.0), 6.0), tr.Spin(3.0))),
    "a start-up on a rocking ship": tr.Combined((tr.Rock("3 deg", 2.0), tr.SpinBy("2*t"))),
}
DURATION, STEP = 3.0, 1e-3


@dataclass(frozen=True)
class Given:
    """A made-up motion of a body: nothing that any law of motion allows, and so nothing that could hide a mistake."""

    motion: Any
    time: np.ndarray

    @property
    def own(self) -> tuple[np.ndarray, ...]:
        if "rate" in self.motion.coordinates:
            return 0.4 * self.time**2 + np.sin(self.time), 0.8 * self.time + np.cos(self.time)
        return tuple((1 - np.cos(self.time)) * 7.0 for _ in self.motion.coordinates)

    @property
    def names(self) -> list[str]:
        return [f"support_{name}" for name in self.motion.coordinates]

    def data(self) -> xr.Dataset:
        t = self.time
        position = np.column_stack([0.2 + 0.1 * t, 0.1 * np.sin(2 * t), 0.02 + 0.01 * t * t])
        velocity = np.column_stack([np.full_like(t, 0.1), 0.2 * np.cos(2 * t), 0.02 * t])
        turn = np.column_stack([np.cos(t), *(np.sin(t) * part for part in (0.0, 0.6, 0.8))])
        vectors = {
            "position": position,
            "velocity": velocity,
            "contact": position - [0.0, 0.0, 0.02],
            "angular_velocity": np.broadcast_to([0.0, 1.2, 1.6], position.shape),
            "contact_force": np.broadcast_to([0.1, -0.2, 0.5], position.shape),
        }
        variables = {name: (("time", "axis"), values) for name, values in vectors.items()}
        own = {name: (("time",), values) for name, values in zip(self.names, self.own, strict=True)}
        return xr.Dataset(
            {**variables, "orientation": (("time", "quaternion"), turn), **own},
            {"time": t, "axis": list("xyz"), "quaternion": list("wxyz")},
        )

    def seen(self, data: xr.Dataset | None = None) -> xr.Dataset:
        support = tr.Support(tr.Plane(), motion=self.motion)
        return frames.change(self.data() if data is None else data, support, "support", "corotating", self.names)


@pytest.fixture(params=MOTIONS)
def motion(request: pytest.FixtureRequest) -> Any:
    return MOTIONS[request.param]


@pytest.fixture
def given(motion: Any) -> Given:
    return Given(motion, np.arange(0.0, DURATION, STEP))


def consistent(motion: Any) -> Given:
    """One whose own coordinates are those that the motion really runs through, so that rates may be compared."""
    if "angle" not in motion.coordinates:
        return Given(motion, np.arange(0.0, DURATION, STEP))

    class RotatedTensor(Given):
        @property
        def own(self) -> tuple[np.ndarray, ...]:
            t = self.time
            if "rate" in self.motion.coordinates:
                return 3.0 * t, np.full_like(t, 3.0)
            if isinstance(self.motion, tr.Combined):
                return (t * t,)
            return (3.5 * (t + 2 * np.exp(-t / 2) - 2),)

    return RotatedTensor(motion, np.arange(0.0, DURATION, STEP))


def vectors(data: xr.Dataset, name: str) -> np.ndarray:
    return np.asarray(data[name].values)


def turned(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    return (Quaternion.of(q).matrix() @ Vector.of(v)).array()


def test_velocity_is_the_rate_of_position(motion: Any) -> None:
    seen = consistent(motion).seen()
    r, V = vectors(seen, "position"), vectors(seen, "velocity")
    # Central differences: off by r‴ h²/6, and r‴ is below 100 m/s³ here.
    rate = (r[2:] - r[:-2]) / (2 * STEP)
    assert np.allclose(rate, V[1:-1], rtol=0, atol=100 * STEP**2 / 6)


def test_angular_velocity_is_the_rate_of_orientation(motion: Any) -> None:
    seen = consistent(motion).seen()
    q, omega = Quaternion.of(vectors(seen, "orientation")), vectors(seen, "angular_velocity")
    steps = q.array()
    rate = Quaternion.of((steps[2:] - steps[:-2]) / (2 * STEP))
    twice = (rate * Quaternion.of(steps[1:-1]).conjugate).array() * 2.0
    assert np.allclose(twice[:, 1:], omega[1:-1], rtol=0, atol=200 * STEP**2 / 6)
    assert np.allclose(twice[:, 0], 0.0, rtol=0, atol=200 * STEP**2 / 6)


def test_what_is_seen_is_what_the_support_carries(given: Given) -> None:
    """A painted spot of the support stands still: its place, turned and shifted by hand, is where it was seen."""
    data, seen = given.data(), given.seen()
    state = given.motion.at(given.time, *given.own)
    for name in ("position", "contact"):
        back = state.origin + state.rotation @ Vector.of(vectors(seen, name))
        assert np.allclose(back.array(), vectors(data, name), rtol=0, atol=1e-14)
    force = (state.rotation @ Vector.of(vectors(seen, "contact_force"))).array()
    assert np.allclose(force, vectors(data, "contact_force"), rtol=0, atol=1e-14)


def test_the_orientation_seen_turns_body_axes_to_the_supports(given: Given) -> None:
    data, seen = given.data(), given.seen()
    spot = np.broadcast_to([0.3, -0.5, 0.8], (len(given.time), 3))
    state = given.motion.at(given.time, *given.own)
    in_space = turned(vectors(data, "orientation"), spot)
    in_table = turned(vectors(seen, "orientation"), spot)
    assert np.allclose((state.rotation @ Vector.of(in_table)).array(), in_space, rtol=0, atol=1e-14)


def test_the_sign_of_the_orientation_is_continuous(given: Given) -> None:
    q = vectors(given.seen(), "orientation")
    assert np.all(np.sum(q[1:] * q[:-1], axis=1) > 0.99)


def test_the_sign_is_the_same_however_few_the_samples(given: Given) -> None:
    """Of seven samples, seconds apart, each has the sign that it has among thousands."""
    whole, few = given.seen(), given.seen(given.data().isel(time=slice(40, None, 430)))
    same = np.sum(vectors(few, "orientation") * vectors(whole, "orientation")[40::430], axis=1)
    assert np.allclose(same, 1.0, rtol=0, atol=1e-13)


def test_there_and_back_is_where_it_was(given: Given) -> None:
    data = given.data()
    support = tr.Support(tr.Plane(), motion=given.motion)
    again = frames.change(given.seen(), support, "corotating", "support", given.names)
    for name in ("position", "velocity", "contact", "angular_velocity", "contact_force", "orientation"):
        assert np.allclose(vectors(again, name), vectors(data, name), rtol=0, atol=2e-14), name


def test_a_steady_turn_written_in_other_words_is_seen_the_same() -> None:
    time = np.linspace(0.0, 40.0, 41)
    data = Given(tr.Spin(3.0), time).data()
    spin = Given(tr.Spin(3.0), time).seen(data)
    turning = data.assign(support_angle=(("time",), 3.0 * time), support_rate=(("time",), np.full(41, 3.0)))
    for motion in (tr.SpinBy("3 + 0*t"), tr.FreeAxle(0.1, rate=3.0), tr.Wobble(3.0, 0.0), tr.UnevenSpin(3.0, 0.0, 1.0)):
        seen = Given(motion, time).seen(turning)
        for name in ("position", "velocity", "angular_velocity", "orientation", "contact_force"):
            assert np.allclose(vectors(seen, name), vectors(spin, name), rtol=0, atol=1e-12), (motion, name)


def test_what_stands_on_a_shaken_tray_is_seen_at_rest() -> None:
    tray = tr.Shake((0.1, 0.0, 0.0), 2.0)
    time = np.linspace(0.0, 5.0, 11)
    data = Given(tray, time).data()
    shift, speed = 0.1 * np.sin(2 * time), 0.2 * np.cos(2 * time)
    ride = np.column_stack([0.3 + shift, np.full(11, 0.2), np.full(11, 0.02)])
    data["position"] = (("time", "axis"), ride)
    data["velocity"] = (("time", "axis"), np.column_stack([speed, np.zeros(11), np.zeros(11)]))
    seen = Given(tray, time).seen(data)
    assert np.allclose(vectors(seen, "position"), [0.3, 0.2, 0.02], rtol=0, atol=1e-15)
    assert np.allclose(vectors(seen, "velocity"), 0.0, rtol=0, atol=1e-15)


def test_data_without_the_tables_angle_are_refused() -> None:
    motion = tr.SpinBy("t")
    data = Given(motion, np.linspace(0.0, 1.0, 3)).data().drop_vars("support_angle")
    with pytest.raises(tr.OutOfDomainError, match="do not hold it"):
        Given(motion, np.linspace(0.0, 1.0, 3)).seen(data)


def test_a_run_on_a_free_table_is_seen_from_it() -> None:
    table = tr.Support(tr.Plane(), motion=tr.FreeAxle(0.03, rate=3.0))
    system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.03, mass=0.3), table)
    run = tr.simulate(system, system.place((0.2, 0.0), (0.0, 0.3)), duration=2.0, every=0.01)
    seen = run.in_frame("corotating")
    angle = run.data["support_angle"].values
    z = (run.data.position.values[:, 0] + 1j * run.data.position.values[:, 1]) * np.exp(-1j * angle)
    assert np.allclose(seen.data.position.values[:, 0] + 1j * seen.data.position.values[:, 1], z, rtol=0, atol=1e-14)
    # Rolling is rolling for whoever looks: V′ + Ω′×ρ′ = 0 in the eyes of the table.
    rho = seen.data.contact.values - seen.data.position.values
    slip = seen.data.velocity.values + np.cross(seen.data.angular_velocity.values, rho)
    assert np.allclose(slip, 0.0, rtol=0, atol=1e-12)
    assert math.isclose(seen.in_frame("support").data.position.values[-1, 0], run.data.position.values[-1, 0])


def test_a_run_on_a_rocking_plane_stays_on_it() -> None:
    plane = tr.Support(tr.Plane(), motion=tr.Rock("5 deg", 3.0))
    system = tr.RollingSystem(BALL, plane)
    run = tr.simulate(system, system.place((0.1, 0.1)), duration=2.0, every=0.01)
    seen = run.in_frame("corotating").data
    assert np.allclose(seen.position.values[:, 2], 0.02, rtol=0, atol=1e-12)
    assert np.allclose(seen.contact.values[:, 2], 0.0, rtol=0, atol=1e-12)
