"""A trajectory: what it holds, what it refuses, and that a file brings all of it back."""

from __future__ import annotations

import copy
import json
import math
import os
import pickle
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.loads import at_rest
from trundle.mechanics.shapes import Sphere
from trundle.solve.exact import closed_form

BALL = tr.Body.solid_sphere(radius=0.025, mass=0.065)
TABLE = tr.Support(tr.Plane(rim=0.5), motion=tr.Spin(3.5), tilt=0.05, friction=0.3)
SYSTEM = tr.RollingSystem(BALL, TABLE)
START = SYSTEM.place((0.1, 0.03), (0.05, 0.2), spin=2.0, orientation=(0.5, -0.5, 0.5, 0.5))
METHODS = ["exact", "taylor", "runge-kutta"]
VARIABLES = {
    "position": "m",
    "contact": "m",
    "velocity": "m s-1",
    "angular_velocity": "rad s-1",
    "orientation": "1",
    "contact_force": "N",
    "slip_velocity": "m s-1",
    "phase": "1",
}


@pytest.fixture(params=METHODS)
def method(request: pytest.FixtureRequest) -> str:
    if request.param == "taylor":
        pytest.importorskip("heyoka")
    return request.param


def run(
    method: str = "exact", system: tr.RollingSystem = SYSTEM, start: tr.State = START, **options: Any
) -> tr.Trajectory:
    return tr.simulate(system, start, **{"duration": 1.0, "every": 0.1, "method": method} | options)


# --- what it holds --------------------------------------------------------------------------------------


def test_a_run_tells_the_same_before_and_after_it_is_labelled(method: str) -> None:
    seen = run(method, title="A ball")
    before = seen.samples
    told = seen.frame, seen.title, seen.tolerance
    again = pickle.loads(pickle.dumps(seen))  # noqa: S301  from just above
    assert (
        (seen.frame, seen.title, seen.tolerance)
        == told
        == tuple(seen.data.attrs[name] for name in ("frame", "title", "tolerance"))
    )
    for name in ("time", "position", "velocity", "angular_velocity", "orientation", "contact_force", "phase"):
        assert np.array_equal(getattr(before, name), getattr(seen.samples, name))
    assert again.data.identical(seen.data)
    seen.data.position[0, 0] += 1.0
    assert seen.samples.position[0, 0] == seen.data.position.values[0, 0]
    seen.data["position"] = seen.data.position + 1.0
    assert np.array_equal(seen.samples.position, seen.data.position.values)


def test_what_was_found_out_of_a_system_stays_with_it() -> None:
    system = replace(SYSTEM)
    moved = SYSTEM.place((0.2, 0.03), (0.05, 0.2))
    first, second = (run(system=system, start=start).data.position[0, 0].item() for start in (START, moved))
    assert (first, second) == (0.1, 0.2)  # of another start it finds another contact
    assert run(system=system).data.identical(run().data)
    copies = pickle.loads(pickle.dumps(system)), replace(system, gravity=1.62)  # noqa: S301  as above
    assert copies[0] == system
    assert not any(one._known for one in copies)
    assert copies[1].weight.force(at_rest(1.0)).z > system.weight.force(at_rest(1.0)).z


def test_labels(method: str) -> None:
    data = run(method).data
    assert set(data.data_vars) == set(VARIABLES)
    for name, unit in VARIABLES.items():
        assert data[name].attrs["units"] == unit
        assert data[name].attrs["long_name"]
        second = () if name == "phase" else ("quaternion",) if name == "orientation" else ("axis",)
        assert data[name].dims == ("time", *second)
        assert data[name].dtype == (np.int8 if name == "phase" else np.float64)
    assert data.axis.values.tolist() == ["x", "y", "z"]
    assert data.quaternion.values.tolist() == ["w", "x", "y", "z"]
    assert data.time.attrs["units"] == "s"
    assert data.attrs["frame"] == "support"
    assert data.attrs["method"] == method
    assert (data.phase.values == 0).all()


def test_the_first_sample_is_the_start(method: str) -> None:
    data = run(method).data.isel(time=0)
    for name in ("position", "velocity", "angular_velocity", "orientation"):
        wanted = np.array(getattr(START, name))
        assert np.abs(data[name].values - wanted).max() <= EXACT(16, np.abs(wanted).max())


def test_the_contact_is_under_the_centre(method: str) -> None:
    data = run(method).data
    assert np.abs(data.position.values - data.contact.values - [0.0, 0.0, 0.025]).max() <= EXACT(4, 0.5)
    assert np.abs(data.slip_velocity.values).max() <= EXACT(16, 2.0)


def test_the_samples_are_where_they_were_asked() -> None:
    assert run(duration=1.0, every=0.4).data.time.values.tolist() == [0.0, 0.4, 0.8, 1.0]
    assert run(duration="1 s", every="500 ms").data.time.values.tolist() == [0.0, 0.5, 1.0]
    assert run(duration=0.3, every=0.1).data.time.values.tolist() == [0.0, 0.1, 0.2, 0.3]
    assert run(duration=1.0, every=1.0).data.time.values.tolist() == [0.0, 1.0]
    assert run(duration=6e-9, every=2e-9).data.time.size == 4


@pytest.mark.parametrize(
    ("options", "key"),
    [
        ({"duration": 0.0}, "duration"),
        ({"duration": -1.0}, "duration"),
        ({"duration": math.nan}, "duration"),
        ({"duration": math.inf}, "duration"),
        ({"duration": "1 m"}, "duration"),
        ({"every": 0.0}, "every"),
        ({"every": 2.0}, "every"),
        ({"every": 1e-12}, "every"),
    ],
)
def test_impossible_sampling_is_refused(options: dict[str, Any], key: str) -> None:
    with pytest.raises(tr.InvalidValueError, match=f"`{key}`"):
        run(**options)


def test_too_many_samples_are_counted() -> None:
    with pytest.raises(tr.InvalidValueError, match=r"1,000,000,000,001.*ask for"):
        run(duration=1.0, every=1e-12)


def test_progress_goes_from_nothing_to_all(method: str) -> None:
    told: list[float] = []
    run(method, progress=told.append)
    assert told
    assert all(0 <= fraction <= 1 for fraction in told)
    assert told[-1] == pytest.approx(1.0, abs=0.05)


def test_a_clock_that_does_not_start_at_zero(method: str) -> None:
    early, late = run(method), run(method, start=replace(START, time=5.0))
    assert np.abs(late.data.time.values - early.data.time.values - 5.0).max() <= EXACT(1, 6.0)
    slack = EXACT(64, 6.0 * 3.5) + SOLVER(100, early.tolerance)
    for name in ("position", "velocity", "angular_velocity", "orientation", "contact_force"):
        size = np.abs(early.data[name].values).max()
        assert np.abs(late.data[name].values - early.data[name].values).max() <= slack * (1 + size)
    seen = late.in_frame("corotating").data
    r, c, s = late.data.position.values[0], math.cos(17.5), math.sin(17.5)  # the table has turned by 3.5 · 5 rad
    assert np.abs(seen.position.values[0, :2] - [c * r[0] + s * r[1], c * r[1] - s * r[0]]).max() <= EXACT(16, 1.0)
    assert late.card().passed, str(late.card())


# --- what it refuses ------------------------------------------------------------------------------------


def test_a_start_that_slips_is_refused(method: str) -> None:
    rough = replace(SYSTEM, support=replace(TABLE, friction=None))
    with pytest.raises(tr.InvalidValueError, match="no slip"):
        tr.simulate(rough, replace(START, velocity=(0.05, 0.2001, 0.0)), duration=6.0, every=0.5, method=method)


def test_a_start_inside_the_support_is_refused(method: str) -> None:
    with pytest.raises(tr.InvalidValueError, match=r"start\.position"):
        run(method, start=replace(START, position=(0.1, 0.03, 0.024)))


@pytest.mark.parametrize("x", [0.5, 0.7, -0.7])
def test_a_start_beyond_the_rim_is_refused(method: str, x: float) -> None:
    outside = replace(SYSTEM, support=replace(TABLE, surface=tr.Plane())).place((x, 0.0))
    with pytest.raises(tr.InvalidValueError, match="rim"):
        run(method, start=outside)


def test_a_start_that_is_no_state_is_refused() -> None:
    with pytest.raises(tr.InvalidValueError, match="place"):
        run(start=((0.1, 0.0), (0.0, 0.0)))  # type: ignore[arg-type]


@pytest.mark.parametrize("bad", ["analytic", "Exact", "", None, 3])
def test_an_unknown_method_lists_the_methods(bad: Any) -> None:
    with pytest.raises(tr.UnknownNameError, match="auto, exact, taylor, runge-kutta"):
        run(bad)


def test_a_mistyped_attribute_lists_the_names() -> None:
    with pytest.raises(tr.UnknownNameError, match=r"Did you mean 'data'.*events"):
        run().dta  # noqa: B018
    with pytest.raises(tr.UnknownNameError, match="support, world, corotating"):
        run().in_frame("wrold")
    with pytest.raises(tr.UnknownNameError, match="series"):
        run().plot("seris")
    with pytest.raises(tr.UnknownNameError, match=r"Did you mean 'Body'"):
        tr.Boddy  # noqa: B018
    assert not hasattr(run(), "dta")
    assert not hasattr(tr, "Boddy")


def test_a_system_that_no_scenario_can_say_still_runs() -> None:
    # A user's own body goes through the one entry too, as CONTRIBUTING.md shows for a load.
    body = tr.Body(0.065, tr.Principal(1.6e-5, 1.7e-5, 1.8e-5), Sphere(0.025))
    system = tr.RollingSystem(body, TABLE)
    ours = tr.simulate(system, system.place((0.1, 0.0)), duration=0.5, every=0.1, method="runge-kutta", scenario="")
    assert ours.card().passed, str(ours.card())


# --- a tolerance of one's own ----------------------------------------------------------------------------


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-12])
def test_a_tolerance_asked_for_is_kept_and_remembered(method: str, tolerance: float) -> None:
    exact, ours = run(), run(method, tolerance=tolerance)
    assert ours.tolerance == (0.0 if method == "exact" else tolerance)
    turned = float(np.linalg.norm(exact.data.angular_velocity.values, axis=1).max())
    apart = np.abs(ours.data.position - exact.data.position).values.max()
    assert apart <= EXACT(64, 0.5) + SOLVER(4 * turned, ours.tolerance, 0.5)
    assert ours.card().passed, str(ours.card())
    between = np.abs(ours.at([0.55]).data.position - exact.at([0.55]).data.position).values.max()
    assert between <= 2 * apart + EXACT(4, 1)


@pytest.mark.parametrize("name", ["taylor", "runge-kutta"])
def test_a_card_that_knew_nothing_of_the_tolerance_would_fail(name: str) -> None:
    if name == "taylor":
        pytest.importorskip("heyoka")
    coarse = tr.Scenario.load("rattleback").run(name, duration=0.3, every=0.01, tolerance=1e-6)
    assert "tolerance 1e-06" in coarse.card().method
    assert coarse.card().passed, str(coarse.card())
    pretended = replace(coarse, data=coarse.data.assign_attrs(tolerance=1e-12))
    assert not pretended.card().passed


def test_runge_kutta_stops_where_rounding_begins() -> None:
    assert run("runge-kutta", tolerance=1e-15).tolerance == 1e-13


@pytest.mark.parametrize("bad", [0, -1e-9, 1e-16, 1e-5, math.nan, True, "1e-9"])
def test_other_tolerances_are_refused(method: str, bad: Any) -> None:
    with pytest.raises(tr.InvalidValueError, match="`tolerance` must be a number from 1e-15 to 1e-06"):
        run(method, tolerance=bad)


@pytest.mark.parametrize("name", ["tilted-turntable", "incline-with-slip", "bouncing-ball-with-backspin"])
def test_it_knows_the_closed_form_that_it_began_with(name: str, tmp_path: Path) -> None:
    ours = tr.Scenario.load(name).run(duration=0.5, every=0.1)
    wanted = closed_form(ours.system, ours.start)
    assert wanted is not None
    assert ours.closed_form == wanted
    assert tr.Trajectory.load(ours.save(tmp_path / "run.nc")).closed_form == wanted


def test_it_says_where_there_is_no_closed_form() -> None:
    dish = tr.RollingSystem(BALL, tr.Support(tr.Paraboloid(1.0)))
    assert run("runge-kutta", dish, dish.place((0.1, 0.0))).closed_form is None
    assert run("runge-kutta").closed_form == closed_form(SYSTEM, START)


# --- the same motion at other instants ------------------------------------------------------------------


def test_at_the_samples_it_gives_the_samples(method: str) -> None:
    ours = run(method)
    again = ours.at(ours.data.time.values)
    slack = EXACT(16, 1) + SOLVER(10, ours.tolerance)
    for name in VARIABLES:
        assert np.abs(again.data[name].values - ours.data[name].values).max() <= slack * (
            1 + np.abs(ours.data[name].values).max()
        )
    assert again.data.attrs == ours.data.attrs
    assert again.events == ours.events


def test_between_the_samples_nothing_is_interpolated(method: str) -> None:
    coarse, fine = run(method, every=1.0), run(method, every=0.125)
    found = coarse.at([0.125, 0.5, 0.875])
    slack = EXACT(64, 1) + SOLVER(100, fine.tolerance)
    for name in ("position", "orientation", "angular_velocity"):
        wanted = fine.data[name].values[[1, 4, 7]]
        assert np.abs(found.data[name].values - wanted).max() <= slack * (1 + np.abs(wanted).max())


@pytest.mark.parametrize("times", [[0.0], [1.0], 0.3, [0.2, 0.2, 0.7], [0.0, 0.5, 1.0]])
def test_any_ascending_times_will_do(method: str, times: Any) -> None:
    found = run(method).at(times)
    assert found.data.time.values.tolist() == np.atleast_1d(times).tolist()
    assert np.isfinite(found.data.position.values).all()


@pytest.mark.parametrize("times", [[0.5, 0.2], [-0.1], [1.1], [math.nan], [], [0.0, math.inf]])
def test_other_times_are_refused(times: Any) -> None:
    with pytest.raises(tr.InvalidValueError, match="times"):
        run().at(times)


def test_a_run_that_ended_at_the_rim(method: str) -> None:
    ours = run(method, duration=20.0)
    end = ours.events[0].time
    assert end < 20.0
    assert ours.at([0.1, end]).data.time.values.tolist() == [0.1, end]
    with pytest.raises(tr.InvalidValueError, match="times"):
        ours.at([end * 1.01])
    assert ours.card().passed, str(ours.card())


# --- a file brings all of it back -----------------------------------------------------------------------


def same(one: tr.Trajectory, other: tr.Trajectory) -> None:
    assert other.data.identical(one.data)
    for name, variable in one.data.data_vars.items():
        assert other.data[name].dtype == variable.dtype
    assert other.system == one.system
    assert other.start == one.start
    assert other.method == one.method
    assert other.events == one.events
    assert other.scenario == one.scenario
    assert other.tolerance == one.tolerance
    assert other.title == one.title
    assert other.frame == one.frame
    assert other.card() == one.card()


@pytest.mark.parametrize("name", tr.Scenario.names())
def test_scenarios_round_trip(name: str, tmp_path: Path) -> None:
    ours = tr.Scenario.load(name).run(duration=0.5, every=0.1)
    again = tr.Trajectory.load(ours.save(tmp_path / "run.nc"))
    same(ours, again)
    assert again.scenario == tr.Scenario.load(name).to_toml()
    assert tr.Scenario.loads(again.scenario).run(duration=0.5, every=0.1).data.equals(ours.data)


RUNS: dict[str, Any] = {
    "tilted, with a rim and friction": lambda: run(title="Tilted"),
    "off the rim": lambda: run(duration=20.0),
    "by Runge-Kutta": lambda: run("runge-kutta"),
    "with a clock of its own": lambda: run(start=replace(START, time=-2.5)),
    "seen from the world": lambda: run().in_frame("world"),
    "seen from the table": lambda: run().in_frame("corotating"),
    "all loads": lambda: run(
        system=replace(SYSTEM, loads=(tr.Force((0.01, 1 / 3, 0.0)), tr.Torque((1e-4, 0.0, 1e-5)), tr.Drag(1 / 7)))
    ),
    "any ratio": lambda: run(
        system=(
            other := tr.RollingSystem(tr.Body.sphere(0.1 + 0.2, 1 / 3, 0.1234567), tr.Support(tr.Plane()), gravity=1.62)
        ),
        start=other.place((0.1, 0.2), (0.3, 0.4)),
    ),
    "a moment of inertia": lambda: run(
        system=(other := tr.RollingSystem(tr.Body(0.065, tr.Isotropic(1.7e-5), Sphere(0.025)), tr.Support(tr.Plane()))),
        start=other.place((0.1, 0.2), (0.3, 0.4)),
    ),
    "NumPy's numbers": lambda: run(
        start=SYSTEM.place(np.array([0.1, 0.03]), np.array([0.05, 0.2]), spin=np.float64(2))
    ),
    "angular velocity given": lambda: run(
        start=SYSTEM.place((0.1, 0.03), (0.05, 0.2), angular_velocity=START.angular_velocity)
    ),
    "a needed friction without end": lambda: run(system=replace(SYSTEM, loads=(tr.Force((0.0, 0.0, 1.0)),))),
}


@pytest.mark.parametrize("name", RUNS)
def test_runs_of_the_api_round_trip(name: str, tmp_path: Path) -> None:
    ours = RUNS[name]()
    again = tr.Trajectory.load(ours.save(tmp_path / "run.nc"))
    same(ours, again)
    assert again.at([ours.data.time.values[1]]).data.identical(ours.at([ours.data.time.values[1]]).data)
    same(again, tr.Trajectory.load(again.save(tmp_path / "again.nc")))


def test_taylor_round_trips(tmp_path: Path) -> None:
    pytest.importorskip("heyoka")
    ours = run("taylor")
    same(ours, tr.Trajectory.load(ours.save(tmp_path / "run.nc")))


def test_other_programs_can_read_the_file(tmp_path: Path) -> None:
    import h5py

    path = run(title="Ball").save(tmp_path / "run.nc")
    with h5py.File(path) as file:
        assert file["position"].shape == (11, 3)
        assert file["position"].attrs["units"] == b"m" or file["position"].attrs["units"] == "m"
        assert json.loads(file.attrs["card"])["passed"] is True
        assert "[body]" in file.attrs["scenario"]
        assert file.attrs["Conventions"].startswith("CF-")


def test_a_path_may_be_text_and_must_have_its_folder(tmp_path: Path) -> None:
    assert run().save(str(tmp_path / "run.nc")) == tmp_path / "run.nc"
    with pytest.raises(tr.TrundleError, match="folder"):
        run().save(tmp_path / "nowhere" / "run.nc")
    assert not (tmp_path / "nowhere").exists()


KILLED = """
import os, signal, sys
import trundle as tr
from trundle.simulation import netcdf

run = tr.Scenario.load("level-turntable-nudged").run(duration=0.5, every=0.1)
run.card()
write = netcdf._Patient.write

def half(stream, data):
    write(stream, data)
    if stream.tell() > 20_000:
        os.kill(os.getpid(), signal.SIGKILL)

netcdf._Patient.write = half
run.save(sys.argv[1])
"""


@pytest.mark.skipif(os.name != "posix", reason="SIGKILL")
@pytest.mark.parametrize("before", [None, b"what was there"])
def test_a_killed_process_leaves_the_file_as_it_was(before: bytes | None, tmp_path: Path) -> None:
    target = tmp_path / "run.nc"
    if before is not None:
        target.write_bytes(before)
    done = subprocess.run([sys.executable, "-c", KILLED, str(target)], capture_output=True, text=True, check=False)  # noqa: S603
    assert done.returncode == -signal.SIGKILL, done.stderr
    assert (target.read_bytes() if before is not None else target.exists()) == (before or False)
    assert [path.name[0] for path in tmp_path.iterdir() if path != target] == ["."]  # what was being written


FULL = """
import resource, sys
from pathlib import Path
import trundle as tr

target, no_limit = Path(sys.argv[1]), resource.getrlimit(resource.RLIMIT_FSIZE)
run = tr.Scenario.load("level-turntable-nudged").run(duration=60.0, every=60.0 / int(sys.argv[2]))
run.save(target)
whole = target.read_bytes()
for size in [1, *range(0, len(whole), len(whole) // 25), len(whole) - 500, len(whole) - 1]:
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, no_limit[1]))
    try:
        run.save(target)
        print("saved", size, "of", len(whole))
    except tr.TrundleError as error:
        print(error)
    resource.setrlimit(resource.RLIMIT_FSIZE, no_limit)
    assert target.read_bytes() == whole and list(target.parent.iterdir()) == [target]
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no such limits here")
@pytest.mark.parametrize("samples", [10, 20_000])
def test_a_disk_that_fills_at_any_byte_leaves_the_file_as_it_was(samples: int, tmp_path: Path) -> None:
    target = tmp_path / "run.nc"
    words = [sys.executable, "-c", FULL, str(target), str(samples)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)  # noqa: S603
    assert done.returncode == 0, done.stderr
    said = f"{target} cannot be written: File too large. Choose another folder or make room."
    assert set(done.stdout.splitlines()) == {said}


# --- what an import costs -------------------------------------------------------------------------------

HEAVY = (
    "heyoka",
    "xarray",
    "matplotlib",
    "sympy",
    "scipy",
    "pint",
    "pydantic",
    "pandas",
    "numpy",
    "h5netcdf",
    "typer",
    "rich",
)


@pytest.mark.parametrize("code", ["import trundle", "import trundle; dir(trundle); trundle.__all__"])
def test_importing_trundle_loads_nothing_heavy(code: str) -> None:
    code += "; import sys; print(*sorted({name.partition('.')[0] for name in sys.modules}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)  # noqa: S603
    assert not set(done.stdout.split()) & set(HEAVY)


def test_describing_a_system_loads_nothing_heavy() -> None:
    code = """
import sys
import trundle as tr
table = tr.Support(tr.Plane(rim=0.5), motion=tr.Spin("33.3 rpm"), tilt="3 deg")
tr.RollingSystem(tr.Body.solid_sphere(radius="25 mm", mass="65 g"), table).place(position=(0.1, 0.0))
print(*sorted({name.partition(".")[0] for name in sys.modules}))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)  # noqa: S603
    assert not set(done.stdout.split()) & {"heyoka", "xarray", "matplotlib", "sympy", "scipy", "pydantic", "pandas"}


def test_every_public_name_is_there() -> None:
    for name in tr.__all__:
        assert getattr(tr, name) is not None
    assert set(dir(tr)) == set(tr.__all__)
    assert set(tr.__all__) == {*tr._HOME_OF, *tr._ROOMS, "__version__"}


def test_each_copy_of_a_run_is_labelled_by_itself(method: str) -> None:
    found = run(method)
    others = [copy.copy(found), replace(found, scenario="")]
    assert found.data is found.data
    assert "_sampled" not in vars(found)  # nothing is kept twice
    for other in others:
        assert other.data.identical(run(method).data)
    with pytest.raises(tr.UnknownNameError, match="attribute of a Trajectory"):
        _ = found.dataset


def test_other_instants_are_found_without_a_dataset(method: str) -> None:
    found = run(method)
    times = 0.5 * (found.samples.time[:-1] + found.samples.time[1:])
    at = found.at(times)
    assert "data" not in vars(found)
    assert "data" not in vars(at)
    assert np.array_equal(at.samples.time, times)
    assert at.events == found.events
    assert at.data.identical(run(method).at(times).data)


def test_a_formula_shows_itself_as_it_was_written() -> None:
    assert repr(tr.Move(("0.5*t**2", 0.0, 0.0))) == "Move(position=Vector(x='0.5*t**2', y=0.0, z=0.0))"
