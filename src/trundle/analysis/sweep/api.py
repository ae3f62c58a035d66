"""The one entry: plan a sweep, run it, and return or store what comes of it."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from ...solve.samples import Progress
from .boundary import NearBoundary
from .engine import Engine
from .job import Columns
from .measures import INFERRED
from .plan import Plan, read_plan
from .result import Sweep
from .store import Store

_PILOTS, _QUICK = 4, 0.01  # members that are timed, and s: a whole block of those that take less


def sweep(
    scenario: Any,
    over: Mapping[str, Any] | None = None,
    measure: Any = None,
    *,
    design: str | None = None,
    members: int | None = None,
    seed: int = 0,
    duration: Any = None,
    every: Any = None,
    method: str | None = None,
    keep: str | int = "nothing",
    title: str | None = None,
    table: Any = None,
    store: Any = None,
    resume: bool = False,
    chunk: int | None = None,
    workers: int | None = 1,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> Sweep:
    """Run a scenario for many values of its numbers, and measure each run.

    Parameters
    ----------
    scenario : Scenario, str or path
        What is run: a scenario, the name of one that ships, or a file.
    over : mapping of str to values
        What varies, by its key in the scenario, such as ``"start.velocity[0]"``. The values are a list or array,
        ``{"from": ..., "to": ..., "count": ..., "scale": "log"}``, ``{"uniform": [low, high]}``,
        ``{"normal": [mean, deviation]}`` or ``"33.3 ± 0.3 rpm"``; with units, or in SI.
    measure : str, callable, or list or mapping of these
        What is measured of each member: ``"turned-over"``, ``"energy-lost"``, ``"end-time"``, ``"ending"``,
        ``"lyapunov"``, ``"events"``; ``"count slip"`` or ``"time slip"`` for a kind of event; ``"end"``, ``"start"``,
        ``"max"``, ``"min"``, ``"mean"``, ``"first"`` (when it is first 0) or ``"period"`` and a formula in what is
        sampled, such as ``"max hypot(x, y)"``; or a function of the dataset of one run that returns a number.
    design : str, optional
        "grid": each value with each. "boundary": the same over two numbers, of which only members near the boundary
        between the classes of the first measure are run, and the others inferred. "together": the first of each, then
        the second. "random", "latin-hypercube", "sobol": drawn; "variance": drawn so that shares of the variance can be
        told. Default: a grid.
    members : int, optional
        How many are drawn; for "variance" in each of its sets.
    seed : int
        Of the draws.
    duration, every : float or quantity, optional
        Instead of the scenario's, s.
    method : str, optional
        Instead of the scenario's. "auto" and "taylor" take members together where that can be done.
    keep : str or int
        "nothing", "samples", or n, to keep each n-th sample.
    title : str, optional
        Absent: the scenario's.
    table : mapping or path, optional
        Instead of `over`: the values of each member, or a CSV file with the keys as its heads.
    store : path, optional
        A Zarr store to write chunk by chunk; absent: the results stay in memory.
    resume : bool
        Whether to go on with a store that is there.
    chunk : int, optional
        Members written at once.
    workers : int, optional
        Processes; None: as many as there are processors. Results are the same to the last bit for any number.
    scheduler : str, optional
        Of Dask: "local", or the address of one.
    progress : callable, optional
        Told the fraction done, 0 to 1.

    Returns
    -------
    Sweep
        What varied and what was measured, as one labelled dataset.

    Raises
    ------
    InvalidValueError
        If a key, a value, a figure or a unit is refused: before anything runs, and all that is wrong at once.
    MissingExtraError
        If a store or a scheduler is named and the extra ``sweep`` is not installed.

    Examples
    --------
    How far out a ball gets on a table within two seconds, by how fast the table turns:

    >>> import trundle as tr
    >>> found = tr.sweep(
    ...     "tilted-turntable",
    ...     over={"support.motion.rate": ["30 rpm", "33.3 rpm", "45 rpm"]},
    ...     measure={"far": "max hypot(x, y)"},
    ...     duration="2 s",
    ... )
    >>> found.dataset.far.dims, bool((found.dataset.status == 1).all())
    (('support.motion.rate',), True)
    """
    run = {
        key: _bare(value)
        for key, value in (("duration", duration), ("every", every), ("method", method))
        if value is not None
    }
    tables = {
        "title": title,
        "scenario": scenario,
        "run": run or None,
        "over": over,
        "table": table,
        "design": design,
        "members": members,
        "seed": seed,
        "measure": measure,
        "keep": keep,
        "chunk": chunk,
    }
    plan = read_plan({key: value for key, value in tables.items() if value is not None})
    return run_plan(
        plan, Engine(workers, scheduler), store=None if store is None else Path(store), resume=resume, progress=progress
    )


def _bare(value: Any) -> Any:
    """Return a quantity as text with its unit: the file of a sweep has no other."""
    return f"{value.magnitude!r} {value.units}" if hasattr(value, "magnitude") else value


def run_plan(
    plan: Plan,
    engine: Engine,
    *,
    store: Path | None = None,
    resume: bool = False,
    part: tuple[int, int] = (1, 1),
    progress: Progress | None = None,
) -> Sweep:
    """Run what a plan says, or what is left of it, in memory or into a store.

    Parameters
    ----------
    plan : Plan
        What to do.
    engine : Engine
        Where.
    store : Path, optional
        To write to.
    resume : bool
        Whether to go on with a store that is there.
    part : pair of int
        Which part of how many: every so-many-th chunk.
    progress : callable, optional
        Told the fraction done.
    """
    engine.check(plan)
    if plan.design.name == "boundary" and part != (1, 1):
        rule = 'must be run whole where the design is "boundary": which members are run depends on those before them'
        raise InvalidValueError("--part", rule, f"{part[0]}/{part[1]}", "Take a --scheduler for several machines.")
    if store is None:
        memory = plan.job.empty(plan.members)

        def keep(where: Any, columns: Columns) -> None:
            for name, column in columns.items():
                memory[name][where] = column

        _run(plan, engine, memory["status"], memory[plan.measures[0].name], keep, part, progress)
        return Sweep.of(plan, memory)
    there = resume and store.exists()
    opened = Store.open(store) if there else Store.create(store, plan)
    with opened.held():
        if there:
            opened.check_same(plan)
        try:
            classes = opened.values(plan.measures[0].name)
            _run(plan, engine, opened.status, classes, opened.write, part, progress)
        except InvalidValueError:  # there is no such scheduler
            if not there:
                shutil.rmtree(store)
            raise
    return Sweep(plan.title, opened.dataset())


def _run(
    plan: Plan,
    engine: Engine,
    status: Any,
    first: Any,
    write: Callable[[Any, Columns], None],
    part: tuple[int, int],
    progress: Progress | None,
) -> None:
    """Run what is left of a plan, given what became of each member and its first measure, and write it."""
    tell = progress or (lambda _: None)
    if plan.design.name == "boundary":
        near = NearBoundary(plan, status, first)

        def take(piece: int, columns: Columns) -> None:
            write(near.take(piece, columns), columns)
            tell(near.share)

        engine.run(near, near, take)
        places, classes = near.inferred
        for some in np.split(places, np.searchsorted(places, np.arange(plan.chunk, plan.members, plan.chunk))):
            if some.size:
                inferred = classes[np.searchsorted(places, some)].astype(plan.measures[0].dtype)
                write(some, {plan.measures[0].name: inferred, "status": np.full(some.size, INFERRED, dtype=np.int8)})
        return
    left = [chunk for chunk in range(part[0] - 1, plan.chunks, part[1]) if not status[chunk * plan.chunk]]
    chunks, done = iter(left), count(1)

    def put(chunk: int, columns: Columns) -> None:
        write(slice(chunk * plan.chunk, chunk * plan.chunk + len(columns["status"])), columns)
        tell(next(done) / len(left))

    engine.run(plan, lambda: next(chunks, None), put)


@dataclass(frozen=True)
class Cost:
    """What a sweep will take: seconds, and bytes before they are compressed."""

    seconds: float
    bytes: int


def cost(plan: Plan, engine: Engine) -> Cost:
    """Time a few members, after one that compiles, and say what all of them will take.

    Examples
    --------
    >>> plan = read_plan({"scenario": "tilted-turntable", "over": {"gravity": [9.8, 9.9]}, "measure": "max z"})
    >>> cost(plan, Engine()).bytes
    34
    """
    each = 0.0
    for pilots in (1, _PILOTS, plan.job.block):
        chosen = np.linspace(0, plan.members - 1, min(pilots, plan.members)).astype(int)
        begun = time.perf_counter()
        plan.job.run(plan.table[chosen])
        each = (time.perf_counter() - begun) / chosen.size
        if pilots == _PILOTS and each > _QUICK:
            break
    return Cost(each * plan.members / engine.processes, plan.bytes)


__all__ = ["Cost", "cost", "run_plan", "sweep"]
