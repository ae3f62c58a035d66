"""Many samples take little more memory than their result, and what finds no room is refused before anything runs."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.tolerances import EXACT

import trundle as tr
from trundle.simulation import labels, memory
from trundle.views.plots import fewer

LIMITED = """
import resource, sys
from pathlib import Path
import trundle as tr

table = tr.Support(tr.Plane(rim=50.0), motion=tr.Spin(3.0), tilt=0.01)
system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), table)
start = system.place((0.1, 0.0), (0.0, 0.1))
method, count, times = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])


def whole(count):
    every = 2.0 / (count - 1)
    if method == "many":
        starts = [start] * 8
        return tr.simulate_many(system, starts, 2.0, 2.0 / (count // 8 - 1)).nbytes
    run = tr.simulate(system, start, 2.0, every, method=method)
    assert run.data.time.size == count and run.card().passed
    run.save(Path(sys.argv[4]))
    return run.data.nbytes


def limited(room):
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + int(room),) * 2)


each = whole(1600) / 1600  # and all is imported and compiled
limited(times * each * count)
try:
    print("done", whole(count))
except (MemoryError, tr.TrundleError) as error:
    print(type(error).__name__, error)
"""


def limited(method: str, count: int, times: float, folder: Path) -> str:
    """Run so many samples where the memory is a multiple of what the result takes."""
    words = [sys.executable, "-c", LIMITED, method, str(count), str(times), str(folder / "run.nc")]
    alone = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MALLOC_ARENA_MAX": "1"}  # no rooms for threads
    done = subprocess.run(words, capture_output=True, text=True, check=False, env={**os.environ, **alone})  # noqa: S603
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory cannot be limited here")
@pytest.mark.parametrize("method", ["exact", "taylor", "runge-kutta", "many"])
def test_a_million_samples_with_card_and_file(method: str, tmp_path: Path) -> None:
    """Within 1.6 times the result; with every array held twice it would be more than 2."""
    if method in ("taylor", "many"):
        pytest.importorskip("heyoka")
    assert limited(method, 1_000_000, 1.6, tmp_path).startswith("done 1")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="memory cannot be limited here")
@pytest.mark.parametrize("method", ["exact", "many"])
def test_what_finds_no_room_is_refused(method: str, tmp_path: Path) -> None:
    said = limited(method, 2_000_000, 0.8, tmp_path)
    assert said.startswith("InvalidValueError `every` must leave no more samples than find room in memory; got")
    assert "2,000,000 of them take 555 MB, and 2" in said


def test_a_refusal_says_what_would_find_room(monkeypatch: pytest.MonkeyPatch) -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane()))
    start, sizes = system.place(velocity=(0.1, 0.0)), 185 * 1.5
    monkeypatch.setattr(memory, "free", lambda: 500_001 * sizes)
    rule = (
        "`every` must leave no more samples than find room in memory; got '1 us'. 1,000,001 of them take 278 MB, and "
    )
    with pytest.raises(tr.InvalidValueError) as refused:
        tr.simulate(system, start, "1 s", "1 us")
    assert str(refused.value) == f"{rule}139 MB are free: ask for 2e-06 s or more, or a shorter duration."
    assert tr.simulate(system, start, "1 s", "2 us").data.time.size == 500_001
    with pytest.raises(tr.InvalidValueError, match="ask each of the 4 members for 125,000 instants or fewer, or part"):
        tr.simulate_many(system, [start] * 4, "1 s", "4 us")
    run = tr.simulate(system, start, "1 s", "0.5 s")
    with pytest.raises(tr.InvalidValueError, match=r"`times` must.*got '1,000,000 times'.*ask for 500,001 at a time"):
        run.at(np.linspace(0.0, 1.0, 1_000_000))


def test_the_size_of_a_sample_is_that_of_the_data() -> None:
    ball = tr.Body.solid_sphere(0.02, 0.1)
    for motion in (tr.Fixed(), tr.FreeAxle(inertia=0.02, rate=3.0)):
        system = tr.RollingSystem(ball, tr.Support(tr.Plane(), motion=motion))
        data = tr.simulate(system, system.place((0.1, 0.0)), 1.0, 0.001).data.drop_vars(["axis", "quaternion"])
        assert data.nbytes == 1001 * labels.size_of(system)


def test_control_groups_count(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A container's limit, in either version of control groups, and no limit."""
    monkeypatch.setattr(memory, "_CGROUPS", tmp_path)
    monkeypatch.setattr(memory, "_of_machine", lambda: [9e9])
    monkeypatch.setattr(memory, "_of_process", list)
    assert memory.free() == 9e9
    (tmp_path / "memory").mkdir()
    for folder, limit, used in [
        (tmp_path / "memory", "limit_in_bytes", "usage_in_bytes"),
        (tmp_path, "max", "current"),
    ]:
        (folder / f"memory.{limit}").write_text("3000\n")
        (folder / f"memory.{used}").write_text("2500\n")
        (folder / "memory.stat").write_text("active_file 7\ninactive_file 400\n")
    names = Path("/proc/self/cgroup")
    if not names.exists():
        pytest.skip("no control groups here")
    assert memory.free() == 900.0
    (tmp_path / "memory.max").write_text("max\n")
    (tmp_path / "memory" / "memory.limit_in_bytes").write_text("max\n")
    assert memory.free() == 9e9


# --- figures ------------------------------------------------------------------------------------------------------


def long_run(monkeypatch: pytest.MonkeyPatch, **start: Any) -> tr.Trajectory:
    monkeypatch.setattr(fewer, "MOST", 5000)
    table = tr.Support(tr.Plane(), motion=tr.Spin(3.0), friction=0.1)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), table)
    return tr.simulate(system, system.place(**start), 20.0, 20.0 / 100_000)


def test_a_figure_takes_as_many_samples_as_it_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    run = long_run(monkeypatch, position=(0.1, 0.0), velocity=(0.0, 0.1))
    some = fewer.fewer(run)
    assert 4000 < some.data.time.size <= 5001
    assert some.data.time.values[[0, -1]].tolist() == run.data.time.values[[0, -1]].tolist()
    assert some.plot().axes  # and can be drawn


def test_a_figure_keeps_the_samples_that_its_lines_bend_at(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that is sampled twenty times a turn loses none of it, though every twentieth would look at rest."""
    monkeypatch.setattr(fewer, "MOST", 5000)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane(), motion=tr.Spin(7.0)))
    turn = 2 * np.pi / 2.0  # κ = 7 · 2/7
    run = tr.simulate(system, system.place((0.1, 0.0), (0.0, 0.1)), 5000 * turn, turn / 20)
    assert fewer.fewer(run).data.time.size == run.data.time.size


def test_a_figure_keeps_the_samples_that_the_turning_support_shows(monkeypatch: pytest.MonkeyPatch) -> None:
    """A ball at rest beside a fast table goes round in the table's eyes."""
    monkeypatch.setattr(fewer, "MOST", 5000)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane(), motion=tr.Spin(300.0)))
    at_rest = system.place((0.1, 0.0), (0.0, 0.0))
    run = tr.simulate(system, at_rest, 20.0, 20.0 / 100_000)
    assert 300.0 * np.diff(fewer.fewer(run).data.time.values).max() <= 0.25


def test_an_event_does_not_keep_all_samples(monkeypatch: pytest.MonkeyPatch) -> None:
    run = long_run(monkeypatch, position=(0.1, 0.0), velocity=(0.0, 0.1), angular_velocity=(0.0, 0.0, 9.0))
    assert [event.kind for event in run.events] == ["grip"]
    assert fewer.fewer(run).data.time.size <= 5001


def test_a_table_is_written_some_rows_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    from trundle.views.viewer import table

    run = tr.Scenario.load("free-turntable-ellipse").run(duration=1.0, every=0.01)
    whole = table.csv_of(run.data)
    monkeypatch.setattr(table, "_ROWS", 7)
    assert table.csv_of(run.data) == whole
    assert whole.count(b"\r\n") == 102


# --- blocks ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("frame", ["world", "corotating"])
@pytest.mark.parametrize("motion", [tr.Spin(3.0), tr.Wobble(2.0, 0.03), tr.FreeAxle(inertia=0.02, rate=3.0)])
@pytest.mark.parametrize("method", ["auto", "runge-kutta"])
def test_blocks_leave_no_seam(method: str, motion: tr.Motion, frame: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is worked out some at a time is what it is all at once."""
    from trundle.solve import closed_form, frames, phases, runge_kutta, samples, taylor

    table = tr.Support(tr.Plane(), motion=motion, tilt=0.02, friction=0.2)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), table)
    start = system.place((0.1, 0.0), (0.3, 0.1), angular_velocity=(0.0, 0.0, 2.0), time=1.0)  # slips, grips

    def made() -> tuple[Any, ...]:
        run = tr.simulate(system, start, 1.0, 0.001, method=method)
        return run.data, run.in_frame(frame).data, run.in_frame(frame).in_frame("support").data, run.card()

    whole = made()
    for module in (frames, closed_form, phases, runge_kutta, samples, taylor):
        monkeypatch.setattr(module, "AT_ONCE", 97)
    parts = made()
    for one, other in zip(whole[:3], parts[:3], strict=True):
        for name, values in one.data_vars.items():
            scale = max(float(np.abs(values).max()), 1.0)
            assert float(np.abs(values - other[name]).max()) <= EXACT(1000, scale), name
            assert np.array_equal(np.isnan(values), np.isnan(other[name]))
    for figure, other in zip(whole[3].figures, parts[3].figures, strict=True):
        assert (figure.name, figure.passed) == (other.name, other.passed)
