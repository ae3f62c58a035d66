"""What is compiled once serves every number: how often the compiler runs, and what a second run waits for."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import trundle as tr
from measure import Row, check, seconds, timed
from trundle.solve import ensemble, integrator_cache, integrators, taylor

TITLE = "Balls in spinning elliptic bowls of other radius, tilt, rate, mass and gravity: what is compiled"

TIMES = np.linspace(0.0, 1.0, 11)


def rows() -> Iterator[Row]:
    """Count compilations with an empty cache, then with the cache of another process."""
    compiled: list[str] = []
    originals = integrators._compile, ensemble._compile, integrator_cache.cache_folder, integrators._memory

    def counted(compile_: Any, name: str) -> Any:
        return lambda *parts: compiled.append(name) or compile_(*parts)

    with tempfile.TemporaryDirectory() as folder:
        integrators._compile, ensemble._compile = counted(originals[0], "one"), counted(originals[1], "many")
        integrator_cache.cache_folder = lambda: Path(folder) / "trundle"
        try:
            first = _fresh(lambda: _run(0.1))
            check(compiled == ["one"], "the first run must compile once")
            second = timed(lambda: [_run(change) for change in (0.2, 0.4, 0.6, 0.8)])[0] / 4
            label = "compilations in four more runs with other numbers"
            yield Row(label, len(compiled) - 1, most=0, kind="count")
            restarted = _fresh(lambda: _run(1.0))
            yield Row("compilations in a new process", len(compiled) - 1, most=0, kind="count")
            tr.simulate_many([_system(0.1)], [_start(_system(0.1))], 1.0, 0.1)
            before = len(compiled)
            systems = [_system(change) for change in np.linspace(0.1, 0.9, 16)]
            tr.simulate_many(systems, [_start(system) for system in systems], 1.0, 0.1)
            yield Row("compilations in a second simulate_many", len(compiled) - before, most=0, kind="count")
        finally:
            integrators._compile, ensemble._compile, integrator_cache.cache_folder, integrators._memory = originals
    yield Row("first run, compiled", first, kind="time")
    yield Row("first run in a new process, from the cache", restarted, raw=f"of {seconds(first)}", kind="time")
    yield Row("each further run of 1 s", second, kind="time")


def _fresh(run: Any) -> float:
    """Return how long a run takes in a process that has compiled nothing yet, s."""
    memory = integrators._Memory()
    integrators._memory = lambda: memory
    return timed(run)[0]


def _run(change: float) -> Any:
    system = _system(change)
    return taylor.solve(system, _start(system), TIMES)


def _system(change: float) -> tr.RollingSystem:
    axes = (0.5 + 0.1 * change, 0.4, 0.3 + 0.1 * change)
    table = tr.Support(tr.EllipsoidalBowl(axes), motion=tr.Spin(1.5 - change), tilt=0.02 * change)
    ball = tr.Body.solid_sphere(0.05 + 0.05 * change, 0.1 + change)
    return tr.RollingSystem(ball, table, gravity=9.8 - change)


def _start(system: tr.RollingSystem) -> tr.State:
    return system.place((0.1, 0.05), (0.1, 0.2), spin=1.0)
