"""Sweeps: members a second, what a second worker brings, what an empty chunk costs, memory, and runs a map takes."""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from measure import Row, check, seconds, timed
from trundle.analysis.sweep import engine
from trundle.analysis.sweep.plan import Plan, read_plan
from trundle.analysis.sweep.refining import next_places

TITLE = "Sweeps: 5 s with 51 samples each, as many members as a block has, on one core"

MEMBERS, ROUNDS = 4096, 5
# What -> what is run, what varies, and the least that a core has to do in a second.
KINDS: dict[str, tuple[str, dict[str, Any], float]] = {
    "tilted table": ("tilted-turntable", {"start.position[0]": {"uniform": [0.05, 0.1]}}, 5600),
    "off the rim": ("off-the-rim", {"start.position[0]": {"uniform": [0.099, 0.101]}}, 254),
    "bowl": ("ball-in-a-turning-bowl", {"start.position[0]": {"uniform": [0.1, 0.2]}}, 1860),
    "rattleback": ("rattleback", {"body.products[0]": {"uniform": [1.8e-5, 2.2e-5]}}, 120),
}
PAIR_CHUNKS, EMPTY_CHUNKS, EMPTY_WORKERS = 24, 10_000, 16
FIELDS, FINE = 100, 1000


def rows() -> Iterator[Row]:
    """Measure rates against their targets, and what is around the runs."""
    rates: dict[str, float] = {}
    for what, (scenario, over, least) in KINDS.items():
        plan = plan_of(scenario, over)
        count = 256 if least < 200 else 1024
        best, made = float("inf"), float("inf")
        plan.job.run(plan.table[: plan.job.block])
        for _ in range(2 if least < 200 else ROUNDS):
            best = min(best, timed(lambda: plan.job.run(plan.table[:count]))[0])  # noqa: B023  called at once
            made = min(made, timed(lambda: plan.job._made(plan.table[:count]))[0])  # noqa: B023
        rates[what] = count / best
        yield Row(f"{what}: members a second", rates[what], least=least, raw=seconds(best), kind="count")
        if what == "tilted table":
            yield Row("  of which to make the starts", made / best, most=0.05, raw=seconds(made))
        elif what == "off the rim":
            yield Row("  times as long as without an event", rates["tilted table"] / rates[what], most=2.0)
    one, two = pair()
    yield Row("two workers / twice one", two / (2 * one), least=0.85, raw=f"{one:.0f} and {two:.0f} members a second")
    each = empty_chunk()
    yield Row(f"an empty chunk on {EMPTY_WORKERS} Dask workers", each, most=3e-3, raw=f"{EMPTY_CHUNKS}", kind="time")
    yield Row("peak memory of 10^6 members in a store, MB", memory(), most=1000, kind="count")
    yield from near_boundary()


def plan_of(scenario: str, over: dict[str, Any], **more: Any) -> Plan:
    tables = {"scenario": scenario, "over": over, "design": "sobol", "members": MEMBERS, "measure": "max hypot(x, y)"}
    return read_plan({**tables, "run": {"duration": 5.0, "every": 0.1}, **more})


def pair() -> tuple[float, float]:
    """Return the members a second of one worker and of two, in turns, without their start."""
    plan = plan_of("tilted-turntable", KINDS["tilted table"][1], chunk=512, run={"duration": 20.0, "every": 0.1})
    rate = {1: 0.0, 2: 0.0}
    for _ in range(2):
        for workers in rate:
            times: list[float] = []
            chunks = iter([chunk % plan.chunks for chunk in range(PAIR_CHUNKS)])
            more = partial(next, chunks, None)
            engine._on_processes(workers, plan, more, lambda *_: times.append(time.perf_counter()))  # noqa: B023
            first = 2 * workers  # each has compiled
            rate[workers] = max(rate[workers], (len(times) - 1 - first) * plan.chunk / (times[-1] - times[first]))
    return rate[1], rate[2]


@dataclass(frozen=True)
class Nothing:
    """A job that does nothing."""

    def run(self, _: Any) -> dict[str, Any]:
        return {}


@dataclass(frozen=True)
class Empty:
    """A plan of nothing."""

    job: Nothing = Nothing()

    def values(self, chunk: int) -> Any:
        return np.full((1, 1), chunk)


def empty_chunk() -> float:
    """Return how long a chunk takes in which nothing is done, s."""
    from distributed import Client, LocalCluster

    options = {"n_workers": EMPTY_WORKERS, "threads_per_worker": 1, "processes": False, "dashboard_address": None}
    with LocalCluster(**options) as cluster, Client(cluster) as client:
        done: list[int] = []
        waiting = iter(range(EMPTY_CHUNKS))
        more = partial(next, waiting, None)
        taken, _ = timed(lambda: engine._on_dask(client, Empty(), more, lambda chunk, _: done.append(chunk)))
        check(sorted(done) == list(range(EMPTY_CHUNKS)), "each chunk has to come back once")
    return taken / EMPTY_CHUNKS


def memory() -> float:
    """Return the peak memory of a process that takes in a million members, MB: their runs themselves left out."""
    done = subprocess.run([sys.executable, __file__], check=True, capture_output=True, encoding="utf-8")  # noqa: S603
    return float(done.stdout)


def a_million() -> None:
    from pathlib import Path

    from trundle.analysis.sweep import api
    from trundle.analysis.sweep.job import Job

    def nothing(job: Job, values: Any) -> Any:
        columns = job.empty(len(values))
        columns["status"][:] = 1
        return columns

    Job.run = nothing  # type: ignore[method-assign]
    plan = plan_of("tilted-turntable", KINDS["tilted table"][1], members=2**20)
    with tempfile.TemporaryDirectory() as folder:
        api.run_plan(plan, engine.Engine(), store=Path(folder) / "a.zarr")
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)


def near_boundary() -> Iterator[Row]:
    """Count the runs that the tippe top's map takes, and those of one ten times as fine with the same boundary."""
    import trundle as tr

    over = {
        "start.angular_velocity[2]": {"from": 40.0, "to": 200.0, "count": FIELDS},
        "support.friction": {"from": 0.05, "to": 1.0, "count": FIELDS, "scale": "log"},
    }
    begun = time.process_time()
    found = tr.sweep("tippe-top", over, ["turned-over"], design="boundary", duration="8 s", every="0.1 s")
    taken = time.process_time() - begun
    classes, places = found.dataset["turned-over"].values, np.arange(FINE) * FIELDS // FINE
    fine, run = classes[np.ix_(places, places)].astype(int), np.zeros((FINE, FINE), dtype=bool)
    while (some := next_places(run, np.where(run, fine, 0))[0]).size:
        run.ravel()[some] = True
    count = found.counts["done"]
    yield Row(f"tippe top, {FIELDS}²: runs of {FIELDS**2}", count, raw=seconds(taken), kind="count")
    yield Row(f"the same boundary in {FINE}²: runs", run.sum(), most=1e5, kind="count")


if __name__ == "__main__":
    a_million()
