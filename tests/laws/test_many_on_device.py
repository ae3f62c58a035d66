"""Members in JAX: what they give, what they say of their error, and who goes alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.analysis.many import on_device

pytest.importorskip("jax")

FIELDS = ("position", "velocity", "angular_velocity", "orientation", "contact_force")


def apart(ours: Any, theirs: Any) -> float:
    shares = []
    for name in FIELDS:
        a, b = ours[name].values, theirs[name].values
        shares.append(np.abs(a - b).max() / np.abs(b).max())
    return float(max(shares))


def balls(surface: Any, count: int, seed: int = 0, **support: Any) -> tuple[list[Any], list[Any]]:
    drawn = np.random.default_rng(seed)
    systems = [
        tr.RollingSystem(tr.Body.solid_sphere(a, 0.1), tr.Support(surface, motion=tr.Spin(w), **support))
        for a, w in zip(drawn.uniform(0.08, 0.12, count), drawn.uniform(-2, 2, count), strict=True)
    ]
    places, speeds = drawn.uniform(-0.1, 0.1, (count, 2)), drawn.normal(0, 0.1, (count, 2))
    return systems, tr.place_many(systems, places, velocity=speeds)


def test_the_closed_form_to_the_error_that_it_says() -> None:
    systems, starts = balls(tr.Plane(), 12, tilt=0.01)
    runs = tr.simulate_many(systems, starts, 3.0, 0.5, device="cpu")
    assert runs.method == "runge-kutta"
    for member, (system, start) in enumerate(zip(systems, starts, strict=True)):
        exact = tr.simulate(system, start, 3.0, 0.5, method="exact").data
        found, error = runs.isel(member=member), float(runs.error[member])
        assert 0 < error < on_device.ERROR
        for name in ("position", "angular_velocity", "orientation"):
            difference = np.abs(found[name] - exact[name]).max()
            assert difference <= 3 * error * np.abs(exact[name]).max()


def test_they_are_what_taylor_gives() -> None:
    systems, starts = balls(tr.EllipsoidalBowl((0.5, 0.4, 0.3)), 10)
    ours, theirs = (tr.simulate_many(systems, starts, 1.0, 0.25, device=device) for device in ("cpu", None))
    assert np.isfinite(ours.error).all()
    assert apart(ours, theirs) < 1e-8
    assert ours.time.equals(theirs.time)
    assert ours["body.radius"].equals(theirs["body.radius"])


def test_who_comes_to_an_event_goes_alone() -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 0.1), tr.Support(tr.Plane(rim=0.5)))
    starts = [system.place((0.1, 0.0), (v, 0.0)) for v in (0.1, 1.0, -0.1, -2.0)]
    ours, theirs = (tr.simulate_many(system, starts, 1.0, 0.25, device=device) for device in ("cpu", None))
    assert ours.ending.values.tolist() == theirs.ending.values.tolist() == ["", "rim", "", "rim"]
    assert np.isfinite(ours.error.values).tolist() == [True, False, True, False]
    np.testing.assert_allclose(ours.position, theirs.position, atol=1e-10)
    np.testing.assert_array_equal(ours.end, theirs.end)


def test_who_is_not_exact_enough_goes_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    systems, starts = balls(tr.Plane(), 4)
    monkeypatch.setattr(on_device.OnDevice, "_steps", lambda *_: 2)  # far too long
    ours, theirs = (tr.simulate_many(systems, starts, 20.0, 10.0, device=device) for device in ("cpu", None))
    assert np.isnan(ours.error).all()
    assert apart(ours, theirs) < 1e-12


def test_in_parts_and_of_one_size(monkeypatch: pytest.MonkeyPatch) -> None:
    systems, starts = balls(tr.Plane(), 7)
    whole = tr.simulate_many(systems, starts, 1.0, 0.5, device="cpu")
    monkeypatch.setattr(on_device, "_AT_ONCE", 90)  # three at a time, the last block filled up
    parts = tr.simulate_many(systems, starts, 1.0, 0.5, device="cpu")
    np.testing.assert_allclose(parts.position, whole.position, atol=1e-15)
    np.testing.assert_allclose(parts.error, whole.error, rtol=0.5, atol=1e-12)


def test_one_member_and_two_instants() -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 0.1), tr.Support(tr.Plane(), tilt=0.1))
    runs = tr.simulate_many(system, system.place(time=2.0), 1.0, 1.0, device="cpu")
    x = float(runs.position[0, -1, 0])
    assert x == pytest.approx(5 / 7 * 9.80665 * np.sin(0.1) / 2, rel=1e-9)
    assert runs.time.values.tolist() == [2.0, 3.0]


def test_resistances_go_alone() -> None:
    resisted = tr.RollingSystem(
        tr.Body.solid_sphere(0.1, 0.1), tr.Support(tr.Plane()), loads=[tr.RollingResistance(0.001)]
    )
    runs = tr.simulate_many(resisted, resisted.place((0.0, 0.0), (0.1, 0.0)), 1.0, 0.5, device="cpu")
    assert "error" not in runs
    assert runs.ending.values.tolist() == [""]


@pytest.mark.parametrize("device", ["tpu2", "gpu:7", 3, ""])
def test_a_device_that_is_not_there(device: Any) -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 0.1), tr.Support(tr.Plane()))
    with pytest.raises(tr.InvalidValueError, match="`device` must be a platform that JAX finds here"):
        tr.simulate_many(system, system.place(), 1.0, 0.5, device=device)


def test_jax_keeps_its_precision_for_others() -> None:
    import jax

    before = jax.config.jax_enable_x64
    systems, starts = balls(tr.Plane(), 2)
    tr.simulate_many(systems, starts, 0.5, 0.5, device="cpu")
    assert jax.config.jax_enable_x64 == before


def test_who_comes_to_a_second_wall_ends_there() -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 1.0), tr.Support(tr.HeightField("sqrt(x**2 + 1e-6)")))
    runs = tr.simulate_many(system, [system.place((x, 0.0)) for x in (0.05, 0.3, -0.05)], 0.2, 0.01, device="cpu")
    assert runs.ending.values.tolist() == ["wall", "", "wall"]
    assert np.isnan(runs.error.values).tolist() == [True, False, True]
    assert np.isnan(runs.position.values[0, -1]).all()
