"""Derivatives that owe nothing to duals: differences of whole runs, taken to zero step by Richardson."""

from __future__ import annotations

import copy
import re
from collections.abc import Sequence
from typing import Any

import numpy as np

import trundle as tr

QUANTITIES = ("position", "velocity", "angular_velocity", "orientation", "contact", "contact_force")
_LEVELS = 3


def check(tables: dict[str, Any], keys: Sequence[str], times: Any = None) -> tr.Sensitivities:
    """Hold the derivatives of a run to 1e-8, but for what the differences leave open, which is as little."""
    found = tr.sensitivities(tr.Scenario.read(tables), keys, compared=False)
    where = found.data.time.values if times is None else times
    for key in keys:
        step = 1e-3 * max(abs(float(found.data.value.sel(parameter=key))), 0.05)
        for quantity, (of_runs, sure) in slopes(tables, key, where, step).items():
            size = max(float(np.abs(of_runs).max()), 1.0)
            apart = np.abs(found[quantity].sel(parameter=key, time=where).values - of_runs).max()
            assert sure <= 1e-8 * size, (key, quantity)
            assert apart <= 1e-8 * size + sure, (key, quantity)
    return found


def slopes(tables: dict[str, Any], key: str, times: Any, step: float) -> dict[str, tuple[Any, float]]:
    """Return of each quantity the derivative by a number of a scenario at some times, and how well it is known."""
    found: dict[str, list[list[Any]]] = {name: [] for name in QUANTITIES}
    for level in range(_LEVELS):
        h = step / 2**level
        up, down = (_samples(changed(tables, key, way * h), times) for way in (1, -1))
        for name, rows in found.items():
            rows.append([(getattr(up, name) - getattr(down, name)) / (2 * h)])
            for k in range(level):  # the errors are even powers of the step
                rows[level].append(rows[level][k] + (rows[level][k] - rows[level - 1][k]) / (4 ** (k + 1) - 1))
    return {name: (rows[-1][-1], float(np.abs(rows[-1][-1] - rows[-1][-2]).max())) for name, rows in found.items()}


def changed(tables: dict[str, Any], key: str, by: float) -> dict[str, Any]:
    """Return the tables of a scenario with one number changed."""
    tables = copy.deepcopy(tables)
    parts = [int(index) if index else name for name, index in re.findall(r"([A-Za-z_]\w*)|\[(\d+)\]", key)]
    inner: Any = tables
    for part in parts[:-1]:
        inner = inner[part]
    inner[parts[-1]] += by
    return tables


def _samples(tables: dict[str, Any], times: Any) -> Any:
    scenario = tr.Scenario.read(tables)
    run = tr.simulate(
        scenario.system(), scenario.start_state(), float(times[-1]) + 1e-3, 1e-3 + float(times[-1]), "taylor"
    )
    samples = run.at(times).samples
    assert samples.time.size == len(times)
    return samples
