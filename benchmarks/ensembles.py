"""Ten thousand members in one call, against one run after another, on one core."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import trundle as tr
from measure import Row, best_times, check, seconds, timed
from trundle.solve import taylor

TITLE = (
    "Ten thousand balls in spinning elliptic bowls, radius, mass, rate and start varied: 10 s, 101 samples, one thread"
)

MEMBERS, ALONE, ROUNDS = 10_000, 40, 3
DURATION, EVERY = 10.0, 0.1


def rows() -> Iterator[Row]:
    """Time all members together, a few of them alone, and an equal number together."""
    systems, starts = _members()
    times = np.linspace(0.0, DURATION, round(DURATION / EVERY) + 1)
    few = slice(0, ALONE * 8)
    tr.simulate_many(systems[:8], starts[:8], DURATION, EVERY)  # compiles
    took, runs = timed(lambda: tr.simulate_many(systems, starts, DURATION, EVERY))
    check(bool((runs.ending == "").all()), "every ball must roll to the end")

    def simulated() -> list[Any]:
        return [tr.simulate(*pair, DURATION, EVERY, method="taylor") for pair in _pairs(systems, starts)]

    def solved() -> list[Any]:
        return [taylor.solve(*pair, times) for pair in _pairs(systems, starts)]

    best = best_times(
        {
            "together": lambda: tr.simulate_many(systems[few], starts[few], DURATION, EVERY),
            "simulate": simulated,
            "taylor.solve": solved,
        },
        ROUNDS,
    )
    worst = max(
        float(np.abs(run.data[name] - runs[name].isel(member=member)).max())
        for member, run in enumerate(simulated())
        for name in ("position", "orientation")
    )
    check(worst < 1e-11, f"members must give what they give alone; they are {worst:.1e} apart")
    each = {name: time / (8 * ALONE if name == "together" else ALONE) for name, time in best.items()}
    for name, least in (("simulate", 3), ("taylor.solve", 3)):
        raw = f"{seconds(each[name])} / {seconds(each['together'])} each"
        yield Row(f"{name}, one by one / simulate_many, a member", each[name] / each["together"], least=least, raw=raw)
    yield Row("all 10,000 in one call, a member", took / MEMBERS, raw=f"{seconds(took)} in all", kind="time")
    yield Row("largest difference from the runs alone", worst, kind="error")
    yield from _placing()


def _placing() -> Iterator[Row]:
    """Time starts put down in one call, and one by one."""
    random = np.random.default_rng(1)
    for name, surface in (("table", tr.Plane()), ("elliptic bowl", tr.EllipsoidalBowl((0.5, 0.4, 0.3)))):
        system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), tr.Support(surface, motion=tr.Spin(1.5)))
        places, speeds = random.uniform(-0.1, 0.1, (MEMBERS, 2)), random.normal(0, 0.1, (MEMBERS, 2))

        def together(system: Any = system, places: Any = places, speeds: Any = speeds) -> Any:
            return tr.place_many(system, places, velocity=speeds)

        def alone(system: Any = system, places: Any = places, speeds: Any = speeds) -> Any:
            return [system.place(*pair) for pair in zip(places[:ALONE], speeds[:ALONE], strict=True)]

        check(alone() == together()[:ALONE], "starts must be the same in one call and one by one")
        best = best_times({"together": together, "alone": alone}, ROUNDS)
        each, one = best["together"] / MEMBERS, best["alone"] / ALONE
        raw = f"{seconds(one)} / {seconds(each)} each"
        yield Row(f"place, one by one / place_many, on a {name}", one / each, least=15, raw=raw)


def _pairs(systems: list[Any], starts: list[Any]) -> list[tuple[Any, Any]]:
    return list(zip(systems[:ALONE], starts[:ALONE], strict=True))


def _members() -> tuple[list[tr.RollingSystem], list[tr.State]]:
    numbers = np.random.default_rng(20).uniform(size=(MEMBERS, 6))
    systems, starts = [], []
    for a, m, rate, x, y, v in numbers:
        table = tr.Support(tr.EllipsoidalBowl((0.5, 0.4, 0.3)), motion=tr.Spin(1.0 + rate))
        system = tr.RollingSystem(tr.Body.solid_sphere(0.05 + 0.05 * a, 0.1 + m), table)
        systems.append(system)
        starts.append(system.place((0.1 * x, 0.1 * y), (0.2 * v, 0.1), spin=1.0))
    return systems, starts
