"""A store of a sweep: whole chunks or none, whatever ends the sweep, and the same bits in the end."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.sweeps.stores import files_of

import trundle as tr
from trundle.analysis.sweep import api, job
from trundle.analysis.sweep.engine import Engine
from trundle.analysis.sweep.plan import Plan, read_plan
from trundle.analysis.sweep.store import NoRoomError, Store, check_room

pytest.importorskip("heyoka")
pytest.importorskip("zarr")

TABLE = "tilted-turntable"


def a_plan(members: int = 64, chunk: int = 8, **more: Any) -> Plan:
    over = {"start.position[0]": {"from": 0.05, "to": 0.4, "count": members}}
    return read_plan({"scenario": TABLE, "run": {"duration": 1.0, "every": 0.1}, "over": over, "chunk": chunk,
                      "measure": ["end x", "ending"], **more})  # fmt: skip


def test_it_opens_in_xarray_without_a_warning_with_units_and_texts(tmp_path: Path) -> None:
    import xarray

    api.run_plan(a_plan(keep=5), Engine(), store=tmp_path / "a.zarr")
    data = xarray.open_zarr(tmp_path / "a.zarr", chunks=None)
    assert data["start.position[0]"].attrs["units"] == "m"
    assert data["position"].dims == ("member", "time", "axis")
    assert data.time.values.tolist() == [0.0, 0.5, 1.0]
    assert data.axis.values.tolist() == ["x", "y", "z"]
    assert tr.Scenario.loads(data.attrs["scenario"]).timing.duration == 1.0
    assert 'scenario = "tilted-turntable"' in data.attrs["sweep"]
    assert "heyoka" in data.attrs["source"]
    refused = data.status.values == 2
    assert 0 < refused.sum() < 64
    assert all(str(reason) for reason in data.reason.values[refused])


def test_a_store_opens_while_it_grows(tmp_path: Path) -> None:
    plan = a_plan()
    store = Store.create(tmp_path / "a.zarr", plan)
    store.write(slice(24, 32), plan.job.run(plan.values(3)))
    found = tr.Sweep.load(tmp_path / "a.zarr")
    assert found.counts == {"waiting": 56, "done": 8, "refused": 0, "failed": 0, "inferred": 0}
    assert np.isfinite(found.data["end x"].values).sum() == 8
    assert "56 waiting" in str(found)


def test_what_is_saved_from_memory_is_what_was_stored(tmp_path: Path) -> None:
    plan = a_plan(keep=5)
    api.run_plan(plan, Engine(), store=tmp_path / "a.zarr")
    api.run_plan(plan, Engine()).save(tmp_path / "b.zarr")
    assert files_of(tmp_path / "a.zarr") == files_of(tmp_path / "b.zarr")


def test_parts_are_joined_to_the_store_of_the_whole(tmp_path: Path) -> None:
    plan = a_plan(60)
    api.run_plan(plan, Engine(), store=tmp_path / "all.zarr")
    for k in (1, 2, 3):
        api.run_plan(plan, Engine(), store=tmp_path / f"{k}.zarr", part=(k, 3))
    joined = Store.create(tmp_path / "joined.zarr", Store.open(tmp_path / "1.zarr").plan())
    assert [joined.take(Store.open(tmp_path / f"{k}.zarr")) for k in (1, 2, 3, 1)] == [3, 3, 2, 0]
    assert files_of(tmp_path / "joined.zarr") == files_of(tmp_path / "all.zarr")
    with pytest.raises(tr.InvalidValueError, match="must hold results of the same"):
        joined.check_same(a_plan(61))


class Halt(BaseException):
    """What no handler of errors takes."""


@pytest.mark.parametrize("at", [0, 1, 5])
def test_interrupted_between_any_two_files_it_goes_on_and_repeats_no_chunk(
    at: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import zarr

    plan = a_plan()
    api.run_plan(plan, Engine(), store=tmp_path / "whole.zarr")
    begun: list[int] = []
    run, put, left = job.Job.run, zarr.Array.__setitem__, [4 * 3 + at]

    def noted(self: job.Job, values: Any) -> Any:
        begun.append(int(np.flatnonzero(plan.table[:, 0] == values[0, 0])[0]) // plan.chunk)
        return run(self, values)

    def stopping(self: Any, *given: Any) -> None:
        left[0] -= 1
        if left[0] == 0:
            raise Halt
        put(self, *given)

    store = Store.create(tmp_path / "a.zarr", plan)
    monkeypatch.setattr(job.Job, "run", noted)
    monkeypatch.setattr(zarr.Array, "__setitem__", stopping)
    with pytest.raises(Halt):
        api.run_plan(plan, Engine(), store=store.path, resume=True)
    monkeypatch.setattr(zarr.Array, "__setitem__", put)
    done = np.flatnonzero(Store.open(store.path).done).tolist()
    assert 2 <= len(done) < plan.chunks
    (store.path / "end x" / "c" / "7.0123abcd.partial").write_bytes(b"half")
    first = len(begun)
    api.run_plan(plan, Engine(), store=store.path, resume=True)
    assert sorted(begun[first:] + done) == list(range(plan.chunks))
    assert files_of(store.path) == files_of(tmp_path / "whole.zarr")


def near_boundary() -> Plan:
    over = {
        "start.position[0]": {"from": "5 cm", "to": "35 cm", "count": 20},
        "support.motion.rate": {"from": "20 rpm", "to": "45 rpm", "count": 18},
    }
    return read_plan({"scenario": TABLE, "run": {"duration": 2.0, "every": 0.5}, "over": over, "keep": 2,
                      "measure": ["ending", "end x"], "design": "boundary", "chunk": 32})  # fmt: skip


def test_a_map_near_the_boundary_goes_on_from_between_any_two_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Stopped again and again, and in the middle of a round too: no piece that is whole is run again."""
    import zarr

    plan, pieces = near_boundary(), []
    run, put = job.Job.run, zarr.Array.__setitem__
    api.run_plan(plan, Engine(), store=tmp_path / "whole.zarr")
    allowed = iter([40, 59, 101, 160])  # writes before it is stopped
    left = [next(allowed)]

    def noted(self: job.Job, values: Any) -> Any:
        pieces.append(values.tobytes())
        return run(self, values)

    def stopping(self: Any, *given: Any) -> None:
        left[0] -= 1
        if left[0] == 0:
            raise Halt
        put(self, *given)

    monkeypatch.setattr(job.Job, "run", noted)
    store = Store.create(tmp_path / "a.zarr", plan).path
    monkeypatch.setattr(zarr.Array, "__setitem__", stopping)
    stops = 0
    while True:
        try:
            api.run_plan(plan, Engine(), store=store, resume=True)
            break
        except Halt:
            stops += 1
            left[0] = next(allowed, -1)
    assert stops >= 3
    assert len(pieces) <= len(set(pieces)) + stops
    assert files_of(store) == files_of(tmp_path / "whole.zarr")
    (store / "status" / "c" / "3").unlink()  # as if killed between the files of one variable
    api.run_plan(plan, Engine(), store=store, resume=True)
    assert files_of(store) == files_of(tmp_path / "whole.zarr")


def test_a_map_near_the_boundary_has_the_same_bits_from_any_engine(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    plan = near_boundary()
    api.run_plan(plan, Engine(2), store=tmp_path / "a.zarr")
    options = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster:
        api.run_plan(plan, Engine(1, cluster.scheduler_address), store=tmp_path / "b.zarr")
    api.run_plan(plan, Engine()).save(tmp_path / "c.zarr")
    assert files_of(tmp_path / "a.zarr") == files_of(tmp_path / "b.zarr") == files_of(tmp_path / "c.zarr")


SLOW = """
title = "Slow enough to be killed"
scenario = "tilted-turntable"
chunk = 8
[run]
duration = "20 s"
every = "5 ms"
[over]
"start.position[0]" = { from = 0.05, to = 0.4, count = 240 }
"support.tilt" = [0, 0.01]
[measure]
far = "max hypot(x, y)"
"""


def test_killed_at_random_moments_it_ends_with_the_same_bits(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(SLOW)
    command = [sys.executable, "-m", "trundle", "sweep", "--quiet", "--workers"]
    subprocess.run([*command, "1", "s.toml", "-o", "whole.zarr"], cwd=tmp_path, check=True, timeout=120)  # noqa: S603
    moments, kills = np.random.default_rng(0), 0
    words = ["2", "s.toml", "-o", "a.zarr"]
    while kills < 2:
        before = _done(tmp_path / "a.zarr")
        process = subprocess.Popen([*command, *words], cwd=tmp_path, stderr=subprocess.DEVNULL, start_new_session=True)  # noqa: S603
        while process.poll() is None and _done(tmp_path / "a.zarr") <= before:
            time.sleep(0.02)
        time.sleep(moments.uniform(0, 0.2))
        if process.poll() is None:
            os.kill(process.pid, signal.SIGKILL)
        process.wait()
        assert _gone(process.pid)
        kills += 1
        words = ["1", "--resume", "a.zarr"]
    subprocess.run([*command, *words], cwd=tmp_path, check=True, timeout=120)  # noqa: S603
    assert files_of(tmp_path / "a.zarr") == files_of(tmp_path / "whole.zarr")


def _done(path: Path) -> int:
    return len(list(path.glob("status/c/*"))) if path.exists() else 0


def _gone(group: int) -> bool:
    """Wait until no process of a group is left: workers end with the one that started them."""
    for _ in range(200):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.05)
    return False


def test_a_disk_that_is_full_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import zarr

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    plan = a_plan()
    store = Store.create(tmp_path / "a.zarr", plan)
    monkeypatch.setattr(zarr.Array, "__setitem__", full)
    with pytest.raises(NoRoomError, match=r"No space left on device\. Make room, then go on with") as told:
        api.run_plan(plan, Engine(), store=store.path, resume=True)
    assert "\n" not in str(told.value)


def test_what_the_disk_has_no_room_for_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = a_plan(keep=1)
    assert plan.bytes > 64 * 11 * 180
    monkeypatch.setattr("shutil.disk_usage", lambda _: type("Usage", (), {"free": 1000})())
    with pytest.raises(tr.InvalidValueError, match="`keep` must leave results that fit the disk, which has 1 kB left"):
        check_room(tmp_path / "a.zarr", plan)


def test_it_writes_over_nothing_and_shares_with_nobody(tmp_path: Path) -> None:
    plan = a_plan()
    store = Store.create(tmp_path / "a.zarr", plan)
    with pytest.raises(tr.InvalidValueError, match="must not exist yet"):
        api.run_plan(plan, Engine(), store=store.path)
    with store.held(), pytest.raises(tr.InvalidValueError, match="by two at once"):
        api.run_plan(plan, Engine(), store=store.path, resume=True)
    with pytest.raises(tr.InvalidValueError, match="has another `measured`"):
        api.run_plan(a_plan(measure=["end y"]), Engine(), store=store.path, resume=True)
    for path in (tmp_path, tmp_path / "nothing"):
        with pytest.raises(tr.InvalidValueError, match="must be a store that a sweep wrote"):
            tr.Sweep.load(path)


FEW = SLOW.replace("count = 240", "count = 4").replace("20 s", "0.1 s")
WAYS = [["--workers", "2"], ["--workers", "2", "--scheduler", "local"]]
MINE = """
import sys
import homework
import trundle as tr
if __name__ == "__main__":
    options = {"workers": 2} if sys.argv[1] == "2" else {"workers": 2, "scheduler": "local"}
    over = {"gravity": [9.8, 9.9, 10.0]}
    found = tr.sweep("tilted-turntable", over, [homework.far, "end x"], duration=0.1, every=0.05, chunk=1, **options)
    assert (found.dataset.far == found.dataset["end x"]).all()
    print("done")
"""


@pytest.mark.parametrize("words", WAYS, ids=["processes", "dask"])
def test_files_of_the_folder_that_one_is_in_are_not_taken_for_pythons_own(words: list[str], tmp_path: Path) -> None:
    for name in ("random", "signal", "struct", "statistics", "nt"):
        (tmp_path / f"{name}.py").write_text(f"raise RuntimeError('{name} of the homework')\n")
    (tmp_path / "s.toml").write_text(FEW)
    command = [Path(sys.executable).with_name("trundle"), "sweep", "s.toml", *words]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=120)  # noqa: S603
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stdout + done.stderr


@pytest.mark.parametrize("way", ["2", "dask"])
def test_a_function_of_a_file_beside_ones_own_is_found_by_all_processes(way: str, tmp_path: Path) -> None:
    (tmp_path / "homework.py").write_text("def far(run):\n    return float(run.position[-1, 0])\n")
    (tmp_path / "mine.py").write_text(MINE)
    command = [sys.executable, "mine.py", way]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=120)  # noqa: S603
    assert done.stdout.strip() == "done", done.stderr
