"""Fits with exact derivatives, beside the same residuals minimised by SciPy with two-point differences."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
from scipy.optimize import least_squares

import trundle as tr
from measure import Row, best_times, check, seconds
from trundle.analysis.fit.api import pose
from trundle.analysis.fit.camera import Camera
from trundle.analysis.fit.first_guess import first_guess
from trundle.analysis.fit.minimising import minimise
from trundle.analysis.fit.observations import observe
from trundle.analysis.fit.problem import Problem
from trundle.analysis.fit.unknowns import changed

TITLE = "A fit, beside SciPy's least squares with two-point differences of the same residuals"

NOISE, ROUNDS = 5e-4, 3
BALL = {"kind": "sphere", "radius": 0.025, "mass": 0.065, "inertia_ratio": 0.42}
TABLE = {"kind": "plane", "tilt": 0.005, "motion": {"kind": "spin", "rate": 3.487}}
BOWL = {"kind": "bowl", "radius": 0.5, "motion": {"kind": "spin", "rate": 3.487}}
CASES: dict[str, tuple[dict[str, Any], list[str], dict[str, float], float, float]] = {
    "turntable, closed form": (
        {"body": BALL, "support": TABLE, "loads": [{"kind": "drag", "coefficient": 5e-4}],
         "start": {"position": [0.1, 0.0], "velocity": [0.0, 0.15]}},
        ["body.inertia_ratio", "support.tilt", "loads[0].coefficient"],
        {"body.inertia_ratio": 0.4, "support.tilt": 0.006, "loads[0].coefficient": 1e-3},
        20.0, 3.0,
    ),
    "bowl that turns, integrated": (
        {"body": BALL, "support": BOWL, "start": {"position": [0.12, 0.0], "velocity": [0.0, 0.1]}},
        ["body.inertia_ratio", "support.radius"],
        {"body.inertia_ratio": 0.4, "support.radius": 0.51},
        5.0, 1.0,
    ),
    "bowl, slips first, integrated": (
        {"body": BALL, "support": {"kind": "bowl", "radius": 0.5, "friction": 0.12},
         "start": {"position": [0.12, 0.0], "velocity": [0.0, 0.4], "angular_velocity": [0.0, 0.0, 0.0]}},
        ["support.friction", "support.radius"],
        {"support.friction": 0.115, "support.radius": 0.51},
        1.2, 1.0,
    ),
}  # fmt: skip


def posed(name: str) -> tuple[Problem, Any]:
    """Return the problem of a case, of a run with other numbers, and where both begin."""
    tables, free, truth, length, _ = CASES[name]
    first = tr.Scenario.read({**tables, "run": {"duration": length, "every": length / 600}}, name)
    run = tr.Scenario.loads(changed(first, truth).to_toml()).run()
    draw, place = np.random.default_rng(1), run.data.position.values
    data = {axis: place[:, i] + draw.normal(scale=NOISE, size=len(place)) for i, axis in enumerate("xy")}
    problem = pose([observe({"t": run.data.time.values, **data})], first, free, None, NOISE, Camera(), start=True)
    return problem, first_guess(problem)


def ours(problem: Problem, guess: Any) -> Any:
    """Return the minimum by exact derivatives."""
    problem.last = None
    return minimise(problem, guess, np.zeros(guess.size, dtype=bool), staged=False).values


def scipys(problem: Problem, guess: Any) -> Any:
    """Return it by differences."""
    problem.last = None
    return least_squares(problem.residual, guess, jac="2-point", x_scale="jac", method="trf").x


def rows() -> Iterator[Row]:
    """Measure them in turns, from the same first guess to the same minimum."""
    for name, (*_, least) in CASES.items():
        problem, guess = posed(name)
        here, there = ours(problem, guess), scipys(problem, guess)
        sums = [float((problem.residual(values) ** 2).sum()) for values in (here, there)]
        check(sums[0] < sums[1] + 0.01, f"{name}: both must come to the same minimum, {sums}")
        best = best_times({"ours": partial(ours, problem, guess), "scipy": partial(scipys, problem, guess)}, ROUNDS)
        raw = f"{seconds(best['scipy'])} / {seconds(best['ours'])}, {1 / best['ours']:.3g} fits/s"
        yield Row(f"{name}: SciPy / fit", best["scipy"] / best["ours"], least=least, raw=raw)
