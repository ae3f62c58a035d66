"""Whether errors are as large as they say: `python -m tests.fitting.coverage` fits many seeded draws of noise.

The numbers of a case are pooled with their correlation: e·C⁻¹·e is χ² with as many degrees of freedom as there are.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import binomtest, chi2
from tests.fitting.measured import ball, down_incline, on_turntable, scenario, seen, turntable

import trundle as tr

LEVELS = {"1σ": 0.6827, "2σ": 0.9545}
NOISE = 5e-4


@dataclass(frozen=True)
class Case:
    """What is measured without noise, what it is fitted with, and the truth of all that is free."""

    columns: Callable[[], tuple[Any, dict[str, Any]]]
    scenario: tr.Scenario
    truth: dict[str, float]


def _turntable() -> tuple[Any, dict[str, Any]]:
    t = np.arange(300) / 30.0
    return t, {"z": on_turntable(t, 3.487, tilt=0.006)}


def _incline() -> tuple[Any, dict[str, Any]]:
    t = np.arange(90) / 60.0
    return t, {"z": down_incline(t, 0.1, 0.4, 0.05) + 0.02j * t}


BOWL = scenario(
    support={"kind": "bowl", "radius": 0.5, "friction": 0.12},
    start={"position": [0.12, 0.0], "velocity": [0.0, 0.4], "angular_velocity": [0.0, 0.0, 0.0]},
    run={"duration": 1.2, "every": 0.02},
)


def _bowl() -> tuple[Any, dict[str, Any]]:
    """A ball that slips first and then grips: of our own run, as it is the statistics that are judged."""
    run = BOWL.run()
    assert [event.kind for event in run.events] == ["grip"], run.events
    place = run.data.position
    return run.data.time.values, {"z": place.sel(axis="x").values + 1j * place.sel(axis="y").values}


CASES = {
    "turntable": Case(
        _turntable,
        scenario(body=ball(0.42), support=turntable(3.487, 0.005)),
        {"body.inertia_ratio": 0.4, "support.tilt": 0.006, "start.position[0]": 0.1, "start.position[1]": 0.0,
         "start.velocity[0]": 0.0, "start.velocity[1]": 0.15},
    ),
    "incline": Case(
        _incline,
        scenario(body=ball(0.5), support={"kind": "plane", "tilt": 0.1}),
        {"body.inertia_ratio": 0.4, "start.position[0]": 0.0, "start.position[1]": 0.0,
         "start.velocity[0]": 0.05, "start.velocity[1]": 0.02},
    ),
    "bowl": Case(
        _bowl,
        BOWL,
        {"support.friction": 0.12, "support.radius": 0.5, "start.position[0]": 0.12, "start.position[1]": 0.0,
         "start.velocity[0]": 0.0, "start.velocity[1]": 0.4},
    ),
}  # fmt: skip


def distances(case: Case, draws: int) -> Any:
    """Return e·C⁻¹·e of each draw."""
    t, columns = case.columns()
    asked = [name for name in case.truth if not name.startswith("start.")]
    truth, found = np.array(list(case.truth.values())), []
    for seed in range(draws):
        fit = tr.fit(seen(t, NOISE, 1000 + seed, **columns), case.scenario, asked, noise=NOISE)
        names = [one.name for one in fit.estimates]
        place = [names.index(name) for name in case.truth]
        off = fit.values[place] - truth
        found.append(float(off @ np.linalg.solve(fit.covariance[np.ix_(place, place)], off)))
    return np.array(found)


def chances(squares: Any, count: int) -> dict[str, tuple[float, float]]:
    """Return the share within one and two standard deviations, and the chance of a share as odd as that."""
    told = {}
    for name, level in LEVELS.items():
        inside = int((squares < chi2.ppf(level, count)).sum())
        told[name] = inside / squares.size, float(binomtest(inside, squares.size, level).pvalue)
    return told


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--case", choices=CASES, action="append")
    given = parser.parse_args()
    for name in given.case or CASES:
        before = time.process_time()
        squares = distances(CASES[name], given.draws)
        told = chances(squares, len(CASES[name].truth))
        shown = ", ".join(f"{level} {100 * share:.1f} % (p = {p:.2g})" for level, (share, p) in told.items())
        print(f"{name}: {shown}, mean {squares.mean():.2f} of {len(CASES[name].truth)}; "
              f"{(time.process_time() - before) / given.draws:.2f} s a fit", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
