"""Many members in one call: the same numbers as one by one, whatever the company, and every event where it belongs."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.tolerances import SOLVER

import trundle as tr
from trundle.analysis.many import running as many
from trundle.solve import ensemble, integrator_cache, integrators, runge_kutta, taylor
from trundle.solve.contact_state import STILL
from trundle.solve.exact import SphereOnPlane
from trundle.solve.laws import RollingLaw
from trundle.solve.transitions import PhaseStart

pytest.importorskip("heyoka")

BALL = tr.Body.solid_sphere(radius=0.025, mass=0.065)
COIN = tr.Body.disc(radius=0.012, mass=0.0075, thickness=0.0022)
FLAT = tr.Support(tr.Plane())
BOWL = tr.EllipsoidalBowl((0.5, 0.4, 0.3))


@pytest.fixture
def alone(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Note which members are not taken along with the others."""
    found: list[int] = []
    put_alone = many.Runs.put_alone

    def noted(self: Any, member: int, *arguments: Any) -> None:
        found.append(member)
        put_alone(self, member, *arguments)

    monkeypatch.setattr(many.Runs, "put_alone", noted)
    return found


def coins() -> tuple[list[tr.RollingSystem], list[tr.State]]:
    systems = [tr.RollingSystem(COIN, FLAT, gravity=g) for g in np.linspace(9.0, 10.0, 11)]
    return systems, [
        system.place(attitude=(0.1, f"{80 + j} deg", 0.0), velocity=(0.5, 0.05 + 0.01 * j), spin=1.0)
        for j, system in enumerate(systems)
    ]


def bowls() -> tuple[list[tr.RollingSystem], list[tr.State]]:
    systems = [
        tr.RollingSystem(tr.Body.solid_sphere(0.02 + 0.004 * j, 0.1), tr.Support(BOWL, motion=tr.Spin(1.0 + 0.1 * j)))
        for j in range(11)
    ]
    return systems, [system.place((0.1, 0.01 * j), (0.1, 0.2), spin=1.0) for j, system in enumerate(systems)]


def stones() -> tuple[list[tr.RollingSystem], list[tr.State]]:
    stone = tr.Body.ellipsoid((0.2, 0.15, 0.12), mass=1.0, turn="2 deg")
    system = tr.RollingSystem(stone, replace(FLAT, tilt=0.01, friction=0.8))
    return [system], [system.place(attitude=(0.0, 0.02 * j, 0.1), spin=1.0) for j in range(9)]


def free_tables() -> tuple[list[tr.RollingSystem], list[tr.State]]:
    table = tr.Support(tr.Plane(), motion=tr.FreeAxle(inertia=0.02, rate=3.0))
    system = tr.RollingSystem(BALL, table)
    return [system], [system.place((0.1, 0.0), (0.0, 0.02 * j), spin=0.0) for j in range(9)]


@pytest.mark.parametrize("made", [coins, bowls, stones, free_tables])
def test_the_same_numbers_as_one_by_one(made: Any, alone: list[int]) -> None:
    systems, starts = made()
    runs = tr.simulate_many(systems, starts, duration=1.0, every=0.1)
    assert not alone
    systems = systems * len(starts) if len(systems) == 1 else systems
    for member in (0, 3, 8):
        single = tr.simulate(systems[member], starts[member], 1.0, 0.1, method="taylor").data
        assert set(single.data_vars) <= set(runs.data_vars)
        for name, values in single.data_vars.items():
            found, scale = runs[name].isel(member=member), max(float(np.abs(values).max()), 1e-3)
            assert found.dims == values.dims
            assert float(np.abs(found - values).max()) <= SOLVER(3000, taylor.TOLERANCE, scale), name


def tables(sign: float = 1.0, begin: float = 0.0) -> tuple[list[tr.RollingSystem], list[tr.State]]:
    """Balls of all sizes on turntables of all rates: more than fill a register, not all of a second."""
    systems = [
        tr.RollingSystem(
            tr.Body.solid_sphere(0.02 + 0.003 * j, 0.1),
            tr.Support(tr.Plane(), motion=tr.Spin(sign * (1.0 + 0.2 * j)), tilt=1e-4 * j),
        )
        for j in range(11)
    ]
    return systems, [system.place((0.1, 0.01 * j), (0.1, 0.2), 1.0, time=begin) for j, system in enumerate(systems)]


def free_axles(sign: float = 1.0, begin: float = 0.0) -> tuple[list[tr.RollingSystem], list[tr.State]]:
    systems = [
        tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.FreeAxle(inertia=0.01 * (1 + j), rate=sign * (2 + j))))
        for j in range(3)
    ]
    return systems, [system.place((0.1, 0.0), (0.0, 0.05), time=begin) for system in systems]


def uneven(sign: float = 1.0, begin: float = 0.0) -> tuple[list[tr.RollingSystem], list[tr.State]]:
    """The law knows the time: from a table that turns unevenly, and a force that swings."""
    systems = [
        tr.RollingSystem(
            BALL,
            tr.Support(tr.Plane(), motion=tr.UnevenSpin(sign * 2.0, 0.3, 1.0 + 0.1 * j)),
            loads=[tr.Force((f"{0.01 + 0.001 * j} * sin({2 + j} * t)", 0.0, 0.0))],
        )
        for j in range(3)
    ]
    return systems, [system.place((0.1, 0.0), (0.0, 0.1), time=begin) for system in systems]


def test_any_number_of_samples() -> None:
    """Against the closed form: the parts of a run have 60 instants, 119 fall into one, 120 into two."""
    made = [tables(sign) for sign in (1.0, -1.0)]
    exact = [[SphereOnPlane.of(*pair) for pair in zip(*members, strict=True)] for members in made]
    # All numbers over the first two edges, then those about the others.
    for steps in [*range(1, 131), *(n for n in range(131, 301) if (n + 2) % 60 < 5)]:
        (systems, starts), forms = made[steps % 2], exact[steps % 2]
        runs = tr.simulate_many(systems, starts, duration=3.0, every=3.0 / steps)
        assert runs.time.size == steps + 1
        for member, form in enumerate(forms):
            assert form is not None
            r, V, Omega, _ = form.motion_at(runs.time.values)
            for name, wanted in (("position", r), ("velocity", V), ("angular_velocity", Omega)):
                values = np.broadcast_to(wanted.array(), (steps + 1, 3))
                apart = np.abs(runs[name].values[member] - values).max()
                assert apart <= SOLVER(1000, taylor.TOLERANCE, max(np.abs(values).max(), 1.0)), (steps, member, name)


# Edges of the parts, last steps that are shorter, steps longer than a reference of time serves, ends across 100 s.
RUNS = [
    (0.0, 1.0, 1 / 119),
    (-7.25, 1.0, 1 / 120.5),
    (1e5, 7.0, 0.01),
    (0.0, 99.99, 0.7),
    (3.5, 100.0, 1.0),
    (1e5, 100.5, 100.5),
    (-40.0, 101.0, 0.33),
    (0.0, 250.0, 120.0),
    (1e5, 250.0, 0.4),
]


@pytest.mark.parametrize(("begin", "duration", "every"), RUNS)
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("made", [tables, free_axles, uneven])
def test_any_duration_step_and_beginning(
    made: Any, sign: float, begin: float, duration: float, every: float, alone: list[int]
) -> None:
    systems, starts = made(sign, begin)
    runs = tr.simulate_many(systems, starts, duration, every, workers=2)
    assert not alone
    assert set(runs.ending.values) == {""}
    for member in {0, len(systems) - 1}:
        single = tr.simulate(systems[member], starts[member], duration, every, method="taylor").data
        assert np.array_equal(runs.time, single.time)
        turned = 1.0 + float(np.abs(single.angular_velocity).max()) * duration
        for name, values in single.data_vars.items():
            scale = max(float(np.abs(values).max()), 1.0)
            apart = float(np.abs(runs[name].isel(member=member) - values).max())
            assert apart <= SOLVER(30, taylor.TOLERANCE, scale * turned), name


def test_instants_at_any_distance() -> None:
    """The engine takes any ascending instants, close together and far apart."""
    systems, _ = bowls()
    numbers = np.random.default_rng(3)
    times = 2.5 + np.cumsum(np.concatenate([[0.0], 10 ** numbers.uniform(-6, -1, 700), [130.0], [1e-3] * 5]))
    starts = [system.place((0.1, 0.01 * j), (0.1, 0.2), 1.0, time=2.5) for j, system in enumerate(systems)]
    states, rolls = ensemble.rolling_from(systems, starts)
    assert rolls.all()
    found: dict[int, list[Any]] = {}

    def done(block: ensemble.Block) -> None:
        for member in np.unique(block.members).tolist():
            own = block.members == member
            found.setdefault(member, []).append((block.rows[own], block.samples.part(own)))

    begins = {i: PhaseStart(RollingLaw(), starts[i], state.tolist()) for i, state in enumerate(states)}
    broken, events = ensemble.integrate(systems, begins, times, done, workers=2)
    assert (broken, events) == ([], dict.fromkeys(begins, ()))
    for member in (0, 7, 10):
        rows = np.concatenate([rows for rows, _ in found[member]])
        assert np.array_equal(rows, np.arange(times.size))
        mine = np.concatenate([part.position for _, part in found[member]])
        wanted = taylor.solve(systems[member], starts[member], times).position
        early = times < 20.0  # then motions in a bowl have grown far apart
        assert np.abs(mine - wanted)[early].max() <= SOLVER(3000, taylor.TOLERANCE)
        assert np.abs(mine - wanted).max() <= 1e-9


def test_balls_on_a_tilted_turntable_against_the_closed_form(alone: list[int]) -> None:
    systems = [
        tr.RollingSystem(tr.Body.solid_sphere(a, 0.1), tr.Support(tr.Plane(), motion=tr.Spin(rate), tilt=tilt))
        for a, rate, tilt in [(0.01, 3.0, 0.01), (0.02, -2.0, 0.05), (0.05, 0.0, 0.1), (0.03, 1e-3, 0.0)]
    ]
    starts = [system.place((0.1, 0.0), (0.0, 0.2), spin=1.0) for system in systems]
    runs = tr.simulate_many(systems, starts, duration=5.0, every=0.5)
    assert not alone
    for member, (system, start) in enumerate(zip(systems, starts, strict=True)):
        exact = tr.simulate(system, start, 5.0, 0.5, method="exact").data
        for name in ("position", "velocity", "angular_velocity", "orientation", "contact_force"):
            scale = max(float(np.abs(exact[name]).max()), 1.0)
            apart = float(np.abs(runs[name].isel(member=member) - exact[name]).max())
            assert apart <= SOLVER(1000, taylor.TOLERANCE, scale)


def test_a_member_does_not_depend_on_its_company() -> None:
    systems, starts = bowls()
    whole = tr.simulate_many(systems, starts, 1.0, 0.25)
    for order in ([4], [10, 3, 4], list(range(10, -1, -1))):
        some = tr.simulate_many([systems[i] for i in order], [starts[i] for i in order], 1.0, 0.25, workers=3)
        wanted = whole.isel(member=order)
        for name in ("contact", "orientation", "angular_velocity"):
            assert np.array_equal(some[name].values, wanted[name].values)


def test_members_that_run_off_the_rim_end_there(alone: list[int]) -> None:
    table = tr.Support(tr.Plane(rim=0.5), motion=tr.Spin(3.5))
    system = tr.RollingSystem(BALL, table)
    starts = [system.place((0.1, 0.0), (0.0, speed)) for speed in (0.0, 0.1, 1.0, 0.05, 2.0, 0.15, 0.0, 0.1, 3.0, 0.2)]
    runs = tr.simulate_many(system, starts, duration=2.0, every=0.1)
    fast = [2, 4, 8]
    assert alone == []
    assert runs.ending.values.tolist() == ["rim" if i in fast else "" for i in range(10)]
    for member in range(10):
        single = tr.simulate(system, starts[member], 2.0, 0.1, method="exact")
        ended = single.events[-1].time if single.events else 2.0
        assert float(runs.end[member]) == pytest.approx(ended, abs=SOLVER(1000, taylor.TOLERANCE))
        before = runs.time.values <= ended
        mine = runs.isel(member=member)
        assert np.array_equal(np.isfinite(mine.position.values).all(axis=1), before)
        assert np.array_equal(mine.phase.values == -1, ~before)
        apart = np.abs(mine.position.values[before] - single.data.position.values[: before.sum()]).max()
        assert apart <= SOLVER(1000, taylor.TOLERANCE)
        assert int(runs.events[member]) == len(single.events)


def test_members_that_slip_or_fly_are_followed_through_their_phases(alone: list[int]) -> None:
    system = tr.RollingSystem(BALL, replace(FLAT, friction=0.2))
    starts = [
        system.place(velocity=(1.0, 0.0)),
        system.place(velocity=(0.7, 0.0), angular_velocity=(0.0, 0.0, 0.0)),
        system.place(velocity=(0.7, 0.0, 0.0), angular_velocity=(0.0, 0.0, 0.0), height=0.05),
    ]
    runs = tr.simulate_many(system, starts, duration=1.0, every=0.05)
    assert alone == []
    assert runs.phase.isel(time=0).values.tolist() == [0, 1, 2]
    assert (runs.phase.isel(time=-1) == 0).all()
    assert runs.events.values.tolist()[0] == 0
    assert (runs.events.values[1:] >= 1).all()
    # Billiards: it slips for 2v/(7μg), and goes on at 5v/7.
    grip = 2 * 0.7 / (7 * 0.2 * 9.80665)
    mine = runs.isel(member=1)
    assert np.array_equal(mine.phase.values, np.where(mine.time.values < grip, 1, 0))
    assert float(mine.velocity.sel(axis="x")[-1]) == pytest.approx(0.5, abs=1e-9)


@pytest.mark.parametrize("steps", [1, 2, 300])
def test_an_event_in_the_last_step_that_a_lane_may_take_is_seen(
    steps: int, alone: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A billiard ball slips for 2 v/(7 μ g), and then rolls at 5/7 v."""
    monkeypatch.setattr(ensemble, "_STEPS", steps)
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=0.2))
    speeds = np.linspace(0.5, 1.5, 11)
    starts = [system.place(velocity=(v, 0.0), angular_velocity=(0.0, 0.0, 0.0)) for v in speeds]
    data = tr.simulate_many(system, starts, duration=0.5, every=0.25)
    grips = 2 * speeds / (7 * 0.2 * 9.80665)
    x = speeds * grips - 0.1 * 9.80665 * grips**2 + 5 / 7 * speeds * (0.5 - grips)
    assert np.abs(data.position.values[:, -1, 0] - x).max() <= SOLVER(30, taylor.TOLERANCE)
    assert alone == []


def test_a_ball_that_begins_to_turn_against_resistance_is_taken_along(alone: list[int]) -> None:
    """It slips for v/(μ g + (5/2)(μ − δ/a) g), as both friction and what it leaves of the resistance say."""
    mu, delta, g, a = 0.2, 1e-3, 9.80665, 0.025
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=mu), (tr.RollingResistance(delta),))
    speeds = np.linspace(0.4, 0.8, 11)
    starts = [system.place(velocity=(v, 0.0), angular_velocity=(0.0, 0.0, 0.0)) for v in speeds]
    data = tr.simulate_many(system, starts, duration=0.2, every=0.1)
    grips = speeds / (mu * g + 2.5 * (mu - delta / a) * g)
    x = speeds * grips - 0.5 * mu * g * grips**2
    left = 0.2 - grips
    slows = delta * g / (1.4 * a)  # that of a ball which rolls
    x += (speeds - mu * g * grips) * left - 0.5 * slows * left**2
    assert (data.events.values == 1).all()
    # It begins with a first little turn, four times what is all but nothing.
    assert np.abs(data.position.values[:, -1, 0] - x).max() <= 2 * 4 * STILL * speeds.max() * 0.2
    assert alone == []


def test_starts_at_a_later_time() -> None:
    systems, starts = bowls()
    later = [replace(start, time=float(j)) for j, start in enumerate(starts)]
    level = tr.RollingSystem(BALL, FLAT)
    runs = tr.simulate_many(level, [replace(level.place(velocity=(v, 0.0)), time=4.0) for v in (1.0, 2.0)], 1.0, 0.5)
    assert runs.time.values.tolist() == [4.0, 4.5, 5.0]
    assert np.abs(runs.position.sel(axis="x").values - [[0, 0.5, 1], [0, 1, 2]]).max() <= SOLVER(100, taylor.TOLERANCE)
    with pytest.raises(tr.InvalidValueError, match=r"starts\[1\].time` must be that of starts\[0\], 0 s; got 1.0"):
        tr.simulate_many(systems, later, 1.0, 0.5)


def refused() -> Iterator[Any]:
    system = tr.RollingSystem(BALL, FLAT)
    other = replace(system, support=tr.Support(tr.Plane(rim=1.0)))
    start = system.place((0.1, 0.0))
    yield pytest.param([system, other], start, {}, r"systems\[1\].*same parts", id="structure")
    yield pytest.param([system] * 2, [start] * 3, {}, r"starts.*as many as the systems, 2; got 3", id="count")
    yield pytest.param(system, [], {}, "starts.*at least one", id="none")
    yield pytest.param(system, [start, 4], {}, r"starts\[1\].*must be a State", id="kind")
    yield pytest.param(4, start, {}, r"systems\[0\].*must be a RollingSystem", id="system")
    yield pytest.param(system, [start] * 100, {"every": 1e-5}, "10,000,000 samples", id="samples")
    yield pytest.param(system, start, {"workers": 0}, "workers", id="workers")
    yield pytest.param(system, replace(start, time=float("nan")), {}, r"starts\[0\].time` must be a finite", id="time")
    yield pytest.param(system, start, {"duration": -1.0}, "`duration` must be positive", id="duration")
    yield pytest.param(system, start, {"every": 2.0}, "`every` must not be longer than the run", id="step")


@pytest.mark.parametrize(("systems", "starts", "more", "said"), list(refused()))
def test_what_is_refused_is_named(systems: Any, starts: Any, more: dict[str, Any], said: str) -> None:
    with pytest.raises(tr.InvalidValueError, match=said):
        tr.simulate_many(systems, starts, **{"duration": 1.0, "every": 0.5, **more})


def test_without_heyoka_members_run_one_by_one(monkeypatch: pytest.MonkeyPatch, alone: list[int]) -> None:
    systems, starts = bowls()
    wanted = tr.simulate_many(systems[:2], starts[:2], 0.5, 0.25)
    monkeypatch.setattr(taylor, "available", lambda: False)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # that heyoka is not there, once
        tr.simulate_many(systems[0], starts[0], 0.5, 0.25)
    runs = tr.simulate_many(systems[:2], starts[:2], 0.5, 0.25)
    assert alone == [0, 0, 1]
    assert np.abs(runs.position - wanted.position).max() <= SOLVER(1000, runge_kutta.TOLERANCE)


def test_another_radius_or_rate_compiles_nothing(monkeypatch: pytest.MonkeyPatch, tmp_path: Any) -> None:
    compiled: list[Any] = []
    compile_, memory = ensemble._compile, integrators._Memory()
    monkeypatch.setattr(ensemble, "_compile", lambda *parts: compiled.append(parts) or compile_(*parts))
    monkeypatch.setattr(integrator_cache, "cache_folder", lambda: tmp_path / "cache")
    monkeypatch.setattr(integrators, "_memory", lambda: memory)
    systems, starts = bowls()
    for some in (slice(0, 3), slice(3, 11)):
        tr.simulate_many(systems[some], starts[some], 0.25, 0.25)
    assert len(compiled) == 1


def test_progress_is_told_to_the_end() -> None:
    systems, starts = bowls()
    told: list[float] = []
    tr.simulate_many(systems, starts, 0.5, 0.25, progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0


def test_it_says_what_was_varied_and_from_where(tmp_path: Path) -> None:
    import xarray

    drawn = np.random.default_rng(3)
    radii, tilts = drawn.uniform(0.02, 0.03, 4), np.array([0.01, -0.01, 0.0, 0.02])
    systems = [
        tr.RollingSystem(tr.Body.solid_sphere(a, 0.065), tr.Support(tr.Plane(rim=0.5), motion=tr.Spin(2.0), tilt=tilt))
        for a, tilt in zip(radii, tilts, strict=True)
    ]
    starts = [system.place((0.1, 0.0), (0.0, v)) for system, v in zip(systems, (0.1, 0.2, -0.1, 3.0), strict=True)]
    runs = tr.simulate_many(systems, starts, 1.0, 0.5, known={"seed": [7, 8, 9, 10]}, title="Four balls")
    runs.to_netcdf(tmp_path / "runs.nc", engine="h5netcdf")
    for found in (runs, xarray.open_dataset(tmp_path / "runs.nc", engine="h5netcdf")):
        assert found["body.radius"].values.tolist() == radii.tolist()
        assert found["support.tilt"].values.tolist() == tilts.tolist()
        assert found["body.radius"].units == "m"
        assert "body.mass" not in found.coords
        assert found.seed.values.tolist() == [7, 8, 9, 10]
        assert found["start.velocity"].sel(axis="y").values.tolist() == [0.1, 0.2, -0.1, 3.0]
        assert np.array_equal(found["start.position"].values, [start.position for start in starts])
        assert found.title == "Four balls"
        (tmp_path / "first.toml").write_text(found.scenario)
        first = tr.Scenario.load(tmp_path / "first.toml")
        assert first.start_state() == starts[0]
    picked = runs.isel(member=np.flatnonzero(runs["support.tilt"].values > 0))
    assert picked.seed.values.tolist() == [7, 10]


def test_members_alike_vary_in_nothing() -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane()))
    runs = tr.simulate_many(system, [system.place((x, 0.0)) for x in (0.1, 0.2)], 1.0, 0.5)
    assert {name for name in runs.coords if "." in str(name)} == {
        "start.position",
        "start.velocity",
        "start.angular_velocity",
        "start.orientation",
    }


@pytest.mark.parametrize("seeds", [[1], [1, 2, 3], 5, [[1, 2], [3, 4]]])
def test_what_is_known_has_a_value_for_each_member(seeds: Any) -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane()))
    with pytest.raises(tr.InvalidValueError, match="a value for each of the 2 members"):
        tr.simulate_many(system, [system.place((x, 0.0)) for x in (0.1, 0.2)], 1.0, 0.5, known={"seed": seeds})
