"""DOP853 in one compiled loop, as it runs where heyoka is not: beside Taylor's method, and SciPy's loop in Python.

Every side gives the full samples, orientation included. The error is the largest distance of the contact from where
Taylor's method has it, as a share of the largest |p|. At looser tolerances `auto` takes one of the two; the other one,
at the tolerance where its error is about the same, is what it is compared with.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any
from unittest import mock

import numpy as np

from bodies import Case, cases
from measure import Row, best_times, check, seconds, timed
from trundle.solve import methods, runge_kutta, taylor

TITLE = "Runge-Kutta on the general law, compiled by numba: rattleback 20 s, coin 60 s, ball in a spinning bowl 1000 s"

ROUNDS = 5
TOLERANCES = (1e-12, 1e-13)
LOOSER = (1e-9, 1e-6)


def rows() -> Iterator[Row]:
    """Time both in turns; SciPy's loop once, on a hundredth of the run."""
    for case in cases():
        times = case.times
        candidates: dict[str, Callable[[], Any]] = {"taylor": partial(taylor.solve, case.system, case.start, times)}
        for tolerance in TOLERANCES:
            candidates[f"{tolerance:g}"] = partial(runge_kutta.solve, case.system, case.start, times, tolerance)
        best, p = best_times(candidates, ROUNDS), candidates["taylor"]().contact
        for tolerance in TOLERANCES:
            name = f"{tolerance:g}"
            error = np.abs(candidates[name]().contact - p).max() / np.abs(p).max()
            check(error < 1e-7, f"the {case.name} must agree with Taylor's method; they are {error:.1e} apart")
            raw = f"{seconds(best[name])} / {seconds(best['taylor'])}, error {error:.1e}"
            yield Row(f"{case.name}: compiled DOP853 at {name} / Taylor", best[name] / best["taylor"], raw=raw)
        with mock.patch.object(runge_kutta, "available", return_value=False):
            short = times[: times.size // 100]
            alone = timed(partial(runge_kutta.solve, case.system, case.start, short))[0] * times.size / short.size
        raw = f"{seconds(alone)}, from a hundredth of it / {seconds(best['1e-12'])}"
        yield Row("  SciPy's loop on the same law / compiled", alone / best["1e-12"], least=20, raw=raw)
        for tolerance in LOOSER:
            yield from _chosen(case, tolerance, p)


def _chosen(case: Case, tolerance: float, p: Any) -> Iterator[Row]:
    """Time what `auto` takes at a tolerance beside what it leaves, at the loosest tolerance of equal error."""
    times = case.times

    def auto() -> tuple[methods.Method, Any]:
        return methods.run("auto", case.system, case.start, times, tolerance=tolerance)

    def error(samples: Any) -> float:
        return float(np.abs(samples.contact - p).max() / np.abs(p).max())

    chosen, samples = auto()
    other = "runge-kutta" if chosen.name == "taylor" else "taylor"
    ladder = [methods.Method(other, float(f"{m}e-{n}")) for n in range(6, 14) for m in (1, 0.3)]
    tried = [(each, error(each.solve(case.system, case.start, times))) for each in ladder]
    left, reached = next((each, e) for each, e in tried if e <= 1.2 * error(samples))
    best = best_times({"auto": auto, "left": partial(left.solve, case.system, case.start, times)}, ROUNDS)
    raw = f"{seconds(best['left'])} / {seconds(best['auto'])}, errors {reached:.1e} / {error(samples):.1e}"
    what = f"  at {tolerance:g}: {left.name} / {chosen.name}, which auto takes"
    yield Row(what, best["left"] / best["auto"], least=0.8, raw=raw)
