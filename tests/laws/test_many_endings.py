"""Members that end early, are refused or break down: each is a row that says why, and changes no other."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import trundle as tr
from trundle.analysis.many import running as many
from trundle.mechanics.algebra import Vector
from trundle.mechanics.loads import Load
from trundle.solve import ensemble
from trundle.solve.laws import RollingLaw
from trundle.solve.transitions import PhaseStart

pytest.importorskip("heyoka")

BALL = tr.Body.solid_sphere(radius=0.025, mass=0.065)
NAN = float("nan")


@dataclass(frozen=True)
class Pull(Load):
    """A pull to the line x = 0, F = −c/x² along the first axis: whoever gets there breaks down."""

    strength: float

    def force(self, motion: Any) -> Vector:
        x = motion.position.x
        return Vector(-self.strength / (x * x), 0.0, 0.0)


def pulled(strength: float) -> tr.RollingSystem:
    return tr.RollingSystem(BALL, tr.Support(tr.Plane(rim=0.5)), loads=[Pull(strength)])


Member = tuple[tr.RollingSystem, tr.State]


def company(begin: float = 0.0) -> list[Member]:
    """All that may become of a member where nothing slips, among many that roll to the end."""
    calm, hard = pulled(1e-6), pulled(1e-3)
    rolls = [(calm, calm.place((0.1, 0.01 * j), (0.01, 0.0), time=begin)) for j in range(16)]
    here = calm.place((0.1, 0.0), time=begin)
    others = [
        (calm, calm.place((0.1, 0.0), (0.4, 0.0), time=begin)),
        (calm, calm.place((0.1, 0.0), (1.0, 0.0), time=begin)),
        (calm, calm.place((0.2, 0.0), height=0.05, time=begin)),  # falls, lands, rolls
        (hard, hard.place((0.1, 0.0), time=begin)),
        (pulled(1e-4), pulled(1e-4).place((0.1, 0.0), time=begin)),
        (calm, replace(here, position=(0.1, 0.0, 0.02))),
        (calm, replace(here, position=(NAN, 0.0, 0.025))),
        (calm, replace(here, position=(0.1, 0.0))),
        (calm, replace(here, velocity=(0.0, NAN, 0.0))),
        (calm, replace(here, orientation=(0.0, 0.0, 0.0, 0.0))),
        (calm, replace(here, support=(1.0,))),
        (calm, replace(here, position=(0.6, 0.0, 0.025))),
    ]
    return _mixed(rolls, others)


def slippery(begin: float = 0.0) -> list[Member]:
    """The same where there is friction, and so slip, on tables that turn either way."""
    systems = [
        tr.RollingSystem(BALL, tr.Support(tr.Plane(rim=0.5), motion=tr.Spin(rate), friction=mu, restitution=0.5))
        for rate, mu in [(2.0, 0.3), (-2.0, 0.3), (0.5, 0.01)]
    ]
    rolls = [(systems[j % 2], systems[j % 2].place((0.1, 0.0), (0.03 * j, 0.05), time=begin)) for j in range(16)]
    still = (0.0, 0.0, 0.0)
    others = [(system, system.place((0.1, 0.0), (0.0, 0.1), angular_velocity=still, time=begin)) for system in systems]
    others += [(system, system.place((0.1, 0.0), height=0.05, time=begin)) for system in systems]
    sunk = replace(others[0][1], position=(0.1, 0.0, 0.0))
    return _mixed(rolls, [*others, (systems[1], sunk)])


def _mixed(rolls: list[Member], others: list[Member]) -> list[Member]:
    return [*rolls[:3], *others[:5], *rolls[3:13], *others[5:], *rolls[13:]]


def many_of(members: list[Member], *timing: float, **options: Any) -> xarray.Dataset:
    systems, starts = zip(*members, strict=True)
    return tr.simulate_many(systems, starts, *timing, **options)


@pytest.mark.parametrize(("duration", "every"), [(2.0, 0.5), (2.0, 0.004), (2.0, 0.0003)])
@pytest.mark.parametrize("workers", [1, 3])
@pytest.mark.parametrize("made", [company, slippery])
def test_each_member_is_what_it_is_alone(made: Any, duration: float, every: float, workers: int) -> None:
    members = made()
    runs = many_of(members, duration, every, workers=workers)
    for i, (system, start) in enumerate(members):
        mine, found = runs.isel(member=i), outcome(i, system, start, duration, every)
        assert (str(mine.ending.values), str(mine.reason.values), int(mine.events)) == found[:3]
        data = found[3]
        kept = np.isin(runs.time.values, [] if data is None else data.time.values)
        assert (mine.phase.values[~kept] == -1).all()
        for name in ("position", "velocity", "orientation", "contact_force"):
            assert np.isnan(mine[name].values[~kept]).all()
        if data is None:
            assert np.isnan(mine.end)
            continue
        assert abs(float(mine.end) - data.time.values[-1]) <= 1e-13  # together it has other roundings
        assert np.array_equal(mine.phase.values[kept], data.phase.values[: kept.sum()])
        assert np.abs(mine.position.values[kept] - data.position.values[: kept.sum()]).max() <= 1e-12
    assert set(runs.ending.values) == {"", "rim", "refused", *(["failed"] if made is company else [])}
    assert set(np.unique(runs.phase)) >= ({-1, 0} if made is company else {-1, 0, 1, 2})


def outcome(i: int, system: tr.RollingSystem, start: tr.State, *timing: float) -> tuple[str, str, int, Any]:
    """What is to be said of a member, and its data, by itself."""
    try:
        run = tr.simulate(system, start, *timing, method="taylor")
    except tr.InvalidValueError as error:
        return "refused", str(error).replace("`start", f"`starts[{i}]", 1), 0, None
    except tr.TrundleError as error:
        return "failed", str(error), 0, None
    final = [(event.kind, event.text) for event in run.events if event.final] or [("", "")]
    return *final[0], len(run.events), run.data


@pytest.mark.parametrize("made", [company, slippery])
def test_the_others_are_what_they_are_without_it(made: Any) -> None:
    """To the last bit, also where a neighbour stops half-way and the register is filled up with somebody else."""
    members = made(begin=3.0)
    whole = many_of(members, 2.0, 0.004)
    good = np.flatnonzero(whole.ending == "").tolist()
    alone = many_of([members[i] for i in good], 2.0, 0.004, workers=2)
    kept = whole.isel(member=good).assign_coords(member=alone.member)
    differ = [name for name in whole.coords if name not in alone.coords]  # numbers in which only the others differ
    assert alone.identical(kept.drop_vars(differ))


def test_a_law_that_is_followed_by_itself_is_not_made_ready_for_the_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    """To trace it, four times for its charts, took half a minute for an egg-shaped body in an egg-shaped bowl."""
    asked: list[Any] = []
    by_itself: list[Any] = []
    ready_in, integrate = ensemble.integrators.ready_in, ensemble.runge_kutta.integrate
    monkeypatch.setattr(ensemble.integrators, "ready_in", lambda *given: asked.append(given[1]) or ready_in(*given))
    monkeypatch.setattr(
        ensemble.runge_kutta, "integrate", lambda *given: by_itself.append(given[1].law) or integrate(*given)
    )
    shaken = tr.Support(tr.Plane(), friction=0.1, motion=tr.Shake((0.02, 0.0, 0.0), 20.0))
    egg = tr.RollingSystem(tr.Body.ellipsoid((0.03, 0.025, 0.02), mass=0.1), shaken)
    many_of([(egg, egg.place(attitude=(0.1 * i, 0.3, 0.0))) for i in range(3)], 0.2, 0.1)
    assert by_itself
    assert asked
    assert not any(law.brief for law in asked)


def test_a_refusal_names_the_member_and_what_is_wrong_with_it() -> None:
    runs = many_of(company(), 2.0, 0.5)
    endings = runs.ending.values.tolist()
    said = {i: str(runs.reason.values[i]) for i, ending in enumerate(endings) if ending in ("refused", "failed")}
    refusals = [
        ("position", "must put the body on the support or over it"),
        ("position", "must hold 3 finite numbers"),
        ("position", "must hold 3 finite numbers"),
        ("velocity", "must hold 3 finite numbers"),
        ("orientation", "must be a unit quaternion"),
        ("support", "must hold nothing"),
    ]
    refused = [i for i in said if endings[i] == "refused"]
    for i, (key, rule) in zip(refused, refusals, strict=False):
        assert said[i].startswith(f"`starts[{i}].{key}` {rule}"), said[i]
    assert "must lie inside the rim at 0.5 m" in said[refused[-1]]
    assert all("broke down at t =" in said[i] for i in said if endings[i] == "failed")


def test_formulas_that_end_within_the_run_are_refused_for_their_member() -> None:
    """The engine might step across a pole; what `simulate` refuses is refused here."""
    systems = [
        tr.RollingSystem(BALL, tr.Support(tr.Plane()), loads=[tr.Force((f"0.001/(t - {pole})", 0.0, 0.0))])
        for pole in (5.0, 0.5, 1.0, 0.25, 1.5)
    ]
    runs = tr.simulate_many(systems, [system.place() for system in systems], 1.0, 0.1)
    assert runs.ending.values.tolist() == ["", "refused", "refused", "refused", ""]
    assert "It is not at t = 0.5 s." in str(runs.reason.values[1])


def test_no_member_need_come_through() -> None:
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane()))
    sunk = replace(system.place(), position=(0.0, 0.0, 0.02))
    runs = tr.simulate_many(system, [sunk, sunk], 1.0, 0.5)
    assert runs.ending.values.tolist() == ["refused"] * 2
    assert np.isnan(runs.position).all()
    fine = tr.simulate_many(system, [system.place()] * 2, 1.0, 0.5)
    assert set(runs.data_vars) == set(fine.data_vars)
    assert all(runs[name].dtype == fine[name].dtype for name in fine)


@pytest.mark.parametrize("error", [ZeroDivisionError("float division by zero"), ValueError("math domain error")])
def test_arithmetic_that_fails_is_a_row(error: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    """As a load of somebody's own may fail, for some numbers only."""
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=0.1))
    sunk = replace(system.place(), position=(0.0, 0.0, 0.02))  # which goes alone

    def broken(*_: Any, **__: Any) -> None:
        raise error

    monkeypatch.setattr(many, "simulate", broken)
    runs = tr.simulate_many(system, [system.place(), sunk], 1.0, 0.5)
    assert runs.ending.values.tolist() == ["", "failed"]
    assert str(runs.reason.values[1]) == f"{type(error).__name__}: {error}"


def test_what_nobody_foresaw_is_not_made_a_row(monkeypatch: pytest.MonkeyPatch) -> None:
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=0.1))

    def broken(*_: Any, **__: Any) -> None:
        raise TypeError("a mistake in the program")

    monkeypatch.setattr(many, "simulate", broken)
    with pytest.raises(TypeError, match="a mistake in the program"):
        tr.simulate_many(system, replace(system.place(), position=(0.0, 0.0, 0.02)), 1.0, 0.5)


def test_the_result_can_be_saved(tmp_path: Path) -> None:
    runs = many_of(company(), 1.0, 0.5)
    runs.to_netcdf(tmp_path / "runs.nc", engine="h5netcdf")
    assert (
        xarray.load_dataset(tmp_path / "runs.nc", engine="h5netcdf").ending.values.tolist()
        == runs.ending.values.tolist()
    )


def test_progress_never_goes_back() -> None:
    told: list[float] = []
    many_of(company(), 4.0, 0.001, workers=2, progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0
    assert len(told) > 20


@pytest.mark.parametrize("workers", [1, 3])
def test_whoever_is_told_of_progress_may_end_it(workers: int) -> None:
    """All threads leave at their next leg, and what was raised is raised."""
    system = tr.RollingSystem(BALL, tr.Support(tr.EllipsoidalBowl((0.5, 0.4, 0.3))))
    starts = [system.place((0.1, 0.01), (0.1, 0.001 * j)) for j in range(2000)]
    told: list[float] = []

    def tell(share: float) -> None:
        told.append(share)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tr.simulate_many(system, starts, 10.0, 0.1, workers=workers, progress=tell)
    assert len(told) <= 3 * workers


ENDLESS = """
import sys
import trundle as tr
system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.EllipsoidalBowl((0.5, 0.4, 0.3))))
starts = [system.place((0.1, 0.01), (0.1, 0.0001 * j)) for j in range(200)]
tr.simulate_many(system, starts[:8], 1.0, 0.5)

def tell(share):
    print(share, flush=True)

print("begun", flush=True)
tr.simulate_many(system, starts, 5e4, 50.0, workers=int(sys.argv[1]), progress=tell)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("workers", ["1", "2"])
def test_control_c_is_heard(workers: str) -> None:
    """Hours of work end within a leg, whichever thread is at it."""
    words = [sys.executable, "-c", ENDLESS, workers]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)  # noqa: S603
    assert process.stdout is not None
    assert process.stdout.readline() == "begun\n"
    process.stdout.readline()
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    begun = time.monotonic()
    _, said = process.communicate(timeout=60)
    assert "KeyboardInterrupt" in said
    assert process.returncode != 0
    assert time.monotonic() - begun < 20.0


def test_a_lane_whose_numbers_are_none_is_left_out() -> None:
    """What a member's parameters come to may be no numbers: it is run by itself, and the others go on."""
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(1.0)))
    starts = [system.place((0.1, 0.0), (0.0, 0.1 * j)) for j in range(5)]
    states, _ = ensemble.rolling_from([system] * 5, starts)
    states[2] = np.nan
    found: list[int] = []
    begins = {i: PhaseStart(RollingLaw(), starts[i], state.tolist()) for i, state in enumerate(states)}
    left, _ = ensemble.integrate(
        [system] * 5, begins, np.linspace(0.0, 1.0, 11), lambda block: found.extend(block.members.tolist())
    )
    assert left == [2]
    assert sorted(set(found)) == [0, 1, 3, 4]


@pytest.mark.parametrize("every", [2.0, 0.1, 0.0003])
def test_who_ends_for_good_ends_in_company(every: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Off the rim at all times, clockwise and not, some at once, two in one register, on one instant with others."""
    systems = [
        tr.RollingSystem(BALL, tr.Support(tr.Plane(rim=rim), motion=tr.Spin(w)))
        for w in (2.0, -2.0)
        for rim in (0.2, 0.3, 0.4, 0.45, 10.0, 0.100001)
    ]
    starts = [system.place((0.1, 0.0), (0.2, 0.1)) for system in systems]
    monkeypatch.setattr(many.Runs, "put_alone", None)
    runs = tr.simulate_many(systems, starts, 2.0, every)
    for i, (system, start) in enumerate(zip(systems, starts, strict=True)):
        exact, mine = tr.simulate(system, start, 2.0, every, method="exact"), runs.isel(member=i)
        assert str(mine.ending.values) == ("rim" if exact.events else "")
        assert int(mine.events) == len(exact.events)
        end = exact.events[0].time if exact.events else 2.0
        assert float(mine.end) == pytest.approx(end, abs=1e-13)
        assert str(mine.reason.values) == (exact.events[0].text if exact.events else "")
        kept = runs.time.values < end if exact.events else np.ones(runs.time.size, dtype=bool)
        assert np.array_equal(np.isfinite(mine.position.values[:, 0]), kept)
        assert np.array_equal(mine.phase.values == -1, ~kept)
        assert np.abs(mine.position.values[kept] - exact.data.position.values[: kept.sum()]).max(initial=0.0) < 1e-12


def test_off_the_end_of_a_bowl_and_the_edge_of_a_half_ball() -> None:
    bowl = tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.5, rim=0.3), motion=tr.Spin(-1.0)))
    half = tr.RollingSystem(tr.Body.hemisphere(0.1, 1.0), tr.Support(tr.Plane()))
    thrown = [bowl.place((0.1, 0.0), (v, 0.3)) for v in (0.1, 3.0, 0.2, 2.5)]
    tipped = [half.place((0.0, 0.0), velocity=(0.0, v)) for v in (0.05, 1.5, -1.5)]
    for system, starts, kind in ((bowl, thrown, "end"), (half, tipped, "edge")):
        runs = tr.simulate_many(system, starts, 1.0, 0.05)
        assert set(runs.ending.values) == {"", kind}
        for i, start in enumerate(starts):
            alone, mine = tr.simulate(system, start, 1.0, 0.05, method="taylor"), runs.isel(member=i)
            assert str(mine.reason.values) == (alone.events[-1].text if alone.events else "")
            assert float(mine.end) == pytest.approx(float(alone.data.time[-1]), abs=1e-12)


FLOOR = tr.Support(tr.Plane(), friction=0.2, restitution=0.5)
EGG = tr.Body.ellipsoid((0.03, 0.025, 0.02), mass=0.1)
ROLLS_BACK = {"angular_velocity": (0.0, -2.0, 0.0)}
STILL = {"angular_velocity": (0.0, 0.0, 0.0)}
THROUGH_PHASES: dict[str, tuple[tr.RollingSystem, list[dict[str, Any]]]] = {
    "slips and comes to rest": (
        tr.RollingSystem(BALL, FLOOR, loads=[tr.RollingResistance(2e-3)]),
        [{"velocity": (0.1 + 0.05 * j, 0.02 * j), **(ROLLS_BACK if j % 2 else {})} for j in range(11)],
    ),
    "bounces with spin": (
        tr.RollingSystem(BALL, FLOOR),
        [
            {"height": 0.02 + 0.01 * j, "velocity": (0.3, 0.0), "angular_velocity": (0.0, 9.0 * j, 3.0)}
            for j in range(9)
        ],
    ),
    "slips without friction": (
        tr.RollingSystem(EGG, replace(FLOOR, friction=0.0)),
        [{"velocity": (0.1, 0.02 * j), "orientation": (0.9, 0.1 * j, 0.2, 0.1)} for j in range(9)],
    ),
    "has a drag with a corner": (
        tr.RollingSystem(BALL, FLOOR, loads=[tr.QuadraticDrag(0.02)]),
        [{"velocity": (0.1 + 0.1 * j, 0.0), **(STILL if j % 3 else {})} for j in range(9)],
    ),
}


@pytest.mark.parametrize(
    ("name", "unrolled"),
    [*((name, False) for name in THROUGH_PHASES), *((name, True) for name in [*THROUGH_PHASES][:3])],
)
def test_members_in_any_phase_go_in_company(name: str, unrolled: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nobody is run alone, and each comes through the events of its own run, at their instants."""
    system, placed = THROUGH_PHASES[name]
    starts = [system.place(**one) for one in placed]
    monkeypatch.setattr(many.Runs, "put_alone", None)
    result = many.run_members([system] * len(starts), starts, 0.6, 0.02, unrolled=unrolled)
    for i, start in enumerate(starts):
        alone = tr.simulate(system, start, 0.6, 0.02, method="taylor")
        assert [kind for kind, _ in result.happened[i]] == [event.kind for event in alone.events]
        apart = [time - event.time for (_, time), event in zip(result.happened[i], alone.events, strict=True)]
        assert max(map(abs, apart), default=0.0) <= 1e-12
        assert np.array_equal(result.arrays["phase"][i], alone.data.phase.values)
        for quantity in ("position", "velocity", "angular_velocity", "orientation"):
            assert np.abs(result.arrays[quantity][i] - alone.data[quantity].values).max() <= 1e-10, quantity


def test_a_long_law_goes_in_fewer_lanes_when_its_loops_are_unrolled(monkeypatch: pytest.MonkeyPatch) -> None:
    """A rattleback's, of five members: what each does is what it does alone."""
    lanes: list[int] = []
    compile_ = ensemble._compile
    monkeypatch.setattr(ensemble.integrators, "kept", lambda _, make: make())
    monkeypatch.setattr(ensemble, "_compile", lambda *given: lanes.append(given[-1]) or compile_(*given))
    stone = tr.Scenario.load("rattleback")
    system, start = stone.system(), stone.start_state()
    moving = ("velocity", "angular_velocity")
    starts = [
        replace(start, **{name: tuple(share * part for part in getattr(start, name)) for name in moving})
        for share in (0.6, -0.8, 1.0, 0.0, 1.3)
    ]
    result = many.run_members([system] * len(starts), starts, 0.5, 0.05, unrolled=True)
    assert lanes == [ensemble.LANES // 2]
    for i, one in enumerate(starts):
        alone = tr.simulate(system, one, 0.5, 0.05)
        for quantity in ("position", "velocity", "angular_velocity", "orientation"):
            assert np.abs(result.arrays[quantity][i] - alone.data[quantity].values).max() <= 1e-10, quantity
