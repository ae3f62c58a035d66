"""Exact derivatives by ten numbers, beside the run alone: variational equations, closed form, and a run with events."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import trundle as tr
from bodies import cases
from measure import Row, best_times, check, seconds
from trundle.analysis.sensitivities.keys import keys

TITLE = "Derivatives by ten numbers beside the run alone, by the same method"

COUNT, MOST, MOST_REDUCED, ROUNDS = 10, 60.0, 30.0, 5
EVERY = 0.1
REDUCED = "coin, by numbers that leave it round"
DURATIONS = {"rattleback": 5.0, "coin": 60.0, "bowl": 100.0}
LEFT_OUT = ("restitution", "start.orientation")  # of 0; four numbers for three
BREAKING = ("body.moments", "support.tilt")  # with which a coin is no body of revolution, and its own rotation counts


def scenarios() -> Iterator[tuple[str, tr.Scenario, str]]:
    """Yield the cases with the method of the run."""
    for case in cases():
        length = DURATIONS[case.name.split()[-1]]
        scenario = tr.Scenario.describe(case.system, case.start, duration=length, every=EVERY)
        yield case.name, scenario, "taylor"
        if case.name == "coin":
            yield REDUCED, scenario, "taylor"
    yield "a ball that bounces 38 times", tr.Scenario.load("bouncing-ball-with-backspin"), "taylor"
    yield "a ball on a tilted turntable, closed form", tr.Scenario.load("tilted-turntable"), "exact"


def rows() -> Iterator[Row]:
    """Measure them in turns, after a comparison with differences of runs."""
    for name, scenario, method in scenarios():
        left_out = LEFT_OUT + BREAKING if name == REDUCED else LEFT_OUT
        wrt = [key.name for key in keys(scenario) if not any(part in key.name for part in left_out)][:COUNT]
        way = "auto" if method == "exact" else "variational"
        derived = partial(tr.sensitivities, scenario, wrt, method=way, compared=False)
        agrees = tr.sensitivities(scenario, wrt, method=way).passed
        check(agrees is True, f"{name}: derivatives must agree with differences of runs")
        best = best_times({"run": partial(scenario.run, method), "derived": derived}, ROUNDS)
        run, derivatives = best["run"], best["derived"]
        raw = f"{seconds(derivatives)} / {seconds(run)}"
        most = MOST_REDUCED if name == REDUCED else MOST
        yield Row(f"{name}: {len(wrt)} numbers / run alone", derivatives / run, most=most, raw=raw)
