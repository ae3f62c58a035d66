"""A run ends where another part of the body comes to the support: at the instant that geometry says, by any method."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle import verify
from trundle.analysis.many import running
from trundle.mechanics.overlap import TOUCHING, fits_anywhere
from trundle.mechanics.shapes import Ellipsoid
from trundle.solve.methods import Method
from trundle.solve.walls import UpToWall

pytest.importorskip("heyoka")

G = 9.80665
A = 0.02  # m


def valley(friction: float | None = None) -> tr.RollingSystem:
    """A ball between two walls at a right angle, each at 45° to the level."""
    support = tr.Support(tr.HeightField("sqrt(x**2 + 1e-14)"), friction=friction)
    return tr.RollingSystem(tr.Body.solid_sphere(A, 1.0), support)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("every", [0.01, 0.3, 3.0])
def test_a_ball_comes_to_the_other_wall_when_it_is_in_the_middle(method: str, side: float, every: float) -> None:
    # Down its wall it gains (5/7) g sin 45°, by √2 (0.05 − a/√2) m.
    wanted = math.sqrt(2 * math.sqrt(2) * (0.05 - A / math.sqrt(2)) / (5 / 7 * G * math.sin(math.pi / 4)))
    system = valley()
    run = tr.simulate(system, system.place((0.05 * side, 0.0)), duration=3.0, every=every, method=method)
    (event,) = run.events
    assert event.kind == "wall"
    assert event.final
    assert event.time == run.samples.time[-1]
    assert abs(event.time - wanted) <= 1e-8 * wanted
    np.testing.assert_allclose(event.before.position, (0.0, 0.0, math.sqrt(2) * A), atol=1e-9)
    assert run.card().passed, str(run.card())
    assert "touched the support in a second place" in event.text


def test_nothing_is_told_of_a_wall_that_the_run_does_not_come_to() -> None:
    system = valley()
    run = tr.simulate(system, system.place((0.05, 0.0)), duration=0.1, every=0.01)
    assert run.events == ()
    assert run.samples.time.size == 11
    later = run.at([0.05, 0.1])
    np.testing.assert_array_equal(later.data.time.values, [0.05, 0.1])


def test_what_slips_or_flies_comes_to_a_wall_too() -> None:
    system = valley(friction=0.05)
    slips = tr.simulate(system, system.place((0.05, 0.0), angular_velocity=(0.0, 30.0, 0.0)), duration=1.0, every=0.1)
    assert [event.kind for event in slips.events] == ["wall"]
    assert set(slips.data.phase.values) == {1}
    start = system.place((0.05, 0.0), velocity=(-1.0, 0.0, 0.0), height=0.02)
    flies = tr.simulate(system, start, duration=1.0, every=0.1)
    assert flies.events[-1].kind == "wall"
    assert slips.card().passed
    assert flies.card().passed
    x, _, z = flies.events[-1].before.position
    assert abs(math.sqrt(0.5) * (z - abs(x)) - A) <= 2e-9  # from the nearer wall


def deepest(R: float, axes: tuple[float, ...], at: Any) -> float:
    """Return how far the points of an ellipsoid are out of a sphere of radius R about (0, 0, R), by SciPy."""
    from scipy.optimize import minimize
    from scipy.spatial.transform import Rotation

    Q = Rotation.from_quat(at.orientation, scalar_first=True).as_matrix()
    centre = np.asarray(at.position) - (0.0, 0.0, R)

    def inside(angles: Any) -> float:
        u, v = angles
        point = np.array(axes) * (math.cos(u) * math.sin(v), math.sin(u) * math.sin(v), math.cos(v))
        return R - float(np.linalg.norm(centre + Q @ point))

    seeds = [(u, v) for u in np.linspace(0, 2 * math.pi, 9)[:-1] for v in np.linspace(0.2, 3.0, 5)]
    ends = [minimize(inside, seed, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-14}) for seed in seeds]
    places = {}
    for end in ends:
        u, v = end.x
        point = (math.cos(u) * math.sin(v), math.sin(u) * math.sin(v), math.cos(v))
        places[tuple(round(3 * x) for x in point)] = end.fun
    return sorted(places.values())[1]  # the second of those apart: one is the contact


@pytest.mark.parametrize("spin", [0.0, 3.0, -8.0])
def test_an_ellipsoid_comes_to_the_other_side_of_a_bowl_where_scipy_finds_that_it_does(spin: float) -> None:
    axes, R = (0.06, 0.03, 0.03), 0.09
    body = tr.Body(1.0, tr.Principal(4e-4, 9e-4, 9e-4), Ellipsoid(*axes))
    system = tr.RollingSystem(body, tr.Support(tr.Bowl(R)))
    half = math.radians(35)  # it stands on its end, askew, and falls over
    start = system.place((0.0, 0.01), spin=spin, orientation=(math.cos(half), 0.0, -math.sin(half), 0.0))
    run = tr.simulate(system, start, duration=2.0, every=0.05)
    event = run.events[-1]
    assert event.kind == "wall"
    assert abs(deepest(R, axes, event.before)) <= 2e-9
    just_before = run.at([event.time * (1 - 1e-3)]).samples.state(0)
    assert deepest(R, axes, just_before) > 1e-7
    assert run.card().passed, str(run.card())


@pytest.mark.parametrize("duration", [0.087, 0.3, 2.0, 100.0])
def test_a_wall_just_before_another_end_is_found_however_much_more_is_asked_for(duration: float) -> None:
    """This disc strikes a bowl, its other end 0.4 ms later; 0.6 ms on, the bowl would be rounder than the disc."""
    body = tr.Body.disc(0.0118513, thickness=0.0302067, density=1234.96)
    bowl = tr.EllipsoidalBowl((0.766638, 0.274539, 0.141292))
    system = tr.RollingSystem(body, tr.Support(bowl, friction=0.069146))
    start = system.place((0.104954, 0.0123729), velocity=(0.0676024, -0.0997183, 0.125977), height=0.0257207)
    run = tr.simulate(system, start, duration=duration, every=duration / 100)
    assert [event.kind for event in run.events] == ["land", "wall"]
    assert abs(run.events[-1].time - tr.simulate(system, start, 0.087, 0.01).events[-1].time) <= 1e-12
    assert run.card().passed, str(run.card())


def test_the_card_of_a_run_that_goes_through_a_wall_fails() -> None:
    system = valley()
    start = system.place((0.05, 0.0))
    with pytest.MonkeyPatch.context() as blind:
        blind.setattr(UpToWall, "runs_into", lambda _, at: np.zeros(at.time.size, dtype=bool))
        run = tr.simulate(system, start, duration=0.15, every=0.01)
    assert run.events == ()
    assert not run.card().passed


@pytest.mark.parametrize("late", [-1e-4, 1e-6, 1e-4])
def test_the_card_of_a_wall_at_another_instant_fails(late: float) -> None:
    system = valley()
    run = tr.simulate(system, system.place((0.05, 0.0)), duration=1.0, every=0.01)
    (event,) = run.events
    moved = replace(run.samples, events=(replace(event, time=event.time * (1 + late)),))
    assert not verify.card(system, run.start, moved, Method.of("taylor")).passed


def test_a_method_that_is_less_exact_sees_no_wall_in_its_own_error() -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(A, 1.0), tr.Support(tr.HeightField("0.01*sin(20*x)*cos(15*y)")))
    start = system.place((0.01, 0.02), (0.1, 0.05))
    run = tr.simulate(system, start, duration=3.0, every=0.1, method="runge-kutta", tolerance=1e-6)
    assert all(event.kind != "wall" for event in run.events)


@pytest.mark.parametrize("shape", ["disc", "ring"])
def test_on_a_plane_and_on_a_dome_nothing_is_looked_for(shape: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A plane through the contact is between the two."""
    monkeypatch.setattr("trundle.solve.walls.reach", None)
    body = getattr(tr.Body, shape)(0.02, 0.1)
    for surface in (tr.Plane(), tr.Dome(0.5)):
        system = tr.RollingSystem(body, tr.Support(surface))
        start = system.place((0.0, 0.0), (0.1, 0.0), attitude=("0 deg", "80 deg", "0 deg"))
        assert tr.simulate(system, start, duration=0.1, every=0.05).data.time.size == 3


def test_a_part_below_the_surface_at_the_start_is_refused_also_in_a_state_made_by_hand() -> None:
    system = valley()
    inside = replace(system.place((0.05, 0.0)), position=(-0.005, 0.0, -0.005 + math.sqrt(2) * A))
    with pytest.raises(tr.InvalidValueError, match="must put the body on the support or over it"):
        tr.simulate(system, inside, duration=1.0, every=0.1)


def test_of_a_million_samples_no_more_are_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[int] = []
    runs_into = UpToWall.runs_into
    monkeypatch.setattr(UpToWall, "runs_into", lambda self, at: [seen.append(at.time.size), runs_into(self, at)][1])
    system = valley()
    Method.of("taylor").solve(system, system.place((0.05, 0.0)), np.linspace(0.0, 0.1, 20_001))
    assert seen == [257]  # what docs/surfaces.md says
    assert TOUCHING == 1e-9  # and this


@pytest.mark.parametrize("radius", [0.03, 0.095, 0.0999])
def test_a_ball_inside_a_tube_lies_within_it_wherever_it_touches(radius: float) -> None:
    """No point of it is farther from the ring than the tube is wide; a larger one is looked at."""
    ring, tube = 0.15, 0.1
    track = tr.TorusTrack(ring, tube)
    nu = np.random.default_rng(5).normal(size=(20_000, 3))
    nu /= np.linalg.norm(nu, axis=1)[:, None]
    for angle in np.linspace(-math.pi, math.pi, 25):
        p = track.point(0.3, float(angle))
        x, y, z = (p.array() + radius * track.normal(p).array() + radius * nu).T
        assert np.hypot(np.hypot(x, y) - ring, z).max() <= tube * (1 + 1e-12)
    assert fits_anywhere(tr.RollingSystem(tr.Body.solid_sphere(radius, 1.0), tr.Support(track)))
    assert not fits_anywhere(tr.RollingSystem(tr.Body.solid_sphere(0.11, 1.0), tr.Support(track)))
    outside = tr.Support(tr.TorusTrack(ring, tube, "outside"))
    assert not fits_anywhere(tr.RollingSystem(tr.Body.solid_sphere(radius, 1.0), outside))


@pytest.mark.parametrize("radii", [(A,), (0.8 * A, 0.9 * A, A, 1.1 * A)], ids=["one system", "a system each"])
def test_members_that_come_to_a_wall_end_there_and_change_no_other(
    radii: tuple[float, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    alone = list[int]()
    put = running.Runs.put_alone
    monkeypatch.setattr(
        running.Runs, "put_alone", lambda self, member, *given: [alone.append(member), put(self, member, *given)][1]
    )
    support = tr.Support(tr.HeightField("sqrt(x**2 + 1e-14)"))
    systems = [tr.RollingSystem(tr.Body.solid_sphere(a, 1.0), support) for a in radii]
    systems *= 8 // len(systems)
    places = (0.05, -0.05, 0.2, 0.25, 0.3, -0.3, 0.06, 0.22)
    starts = [system.place((x, 0.0)) for system, x in zip(systems, places, strict=True)]
    runs = tr.simulate_many(systems, starts, duration=0.25, every=0.01)
    for member, (system, start) in enumerate(zip(systems, starts, strict=True)):
        run = tr.simulate(system, start, duration=0.25, every=0.01, method="taylor")
        assert runs.ending.values[member] == ("wall" if run.events else "")
        assert runs.end.values[member] == pytest.approx(run.samples.time[-1], abs=1e-13)
        kept = np.isfinite(runs.position.values[member, :, 0]).sum()
        assert kept == (run.samples.time <= 0.25).sum() - bool(run.events)
        np.testing.assert_allclose(runs.position.values[member, :kept], run.samples.position[:kept], atol=1e-14)
    assert sorted(alone) == [member for member, x in enumerate(places) if abs(x) < 0.1]


def test_members_that_fit_everywhere_are_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "reach", None)
    system = tr.RollingSystem(tr.Body.solid_sphere(A, 1.0), tr.Support(tr.Bowl(0.5)))
    runs = tr.simulate_many(system, [system.place((x, 0.0)) for x in (0.1, 0.2)], duration=0.1, every=0.01)
    assert runs.ending.values.tolist() == ["", ""]


def test_of_a_member_no_more_than_seventeen_samples_are_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[int] = []
    reach = running.reach
    monkeypatch.setattr(running, "reach", lambda system, at: [seen.append(at.time.size), reach(system, at)][1])
    system = valley()
    starts = [system.place((x, 0.0)) for x in (0.2, 0.3)]
    tr.simulate_many(system, starts, duration=0.1, every=1e-4)
    tr.simulate_many(system, starts, duration=0.1, every=0.05)
    assert seen == [34, 6]  # what docs/many-at-once.md says
