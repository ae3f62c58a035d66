"""What every benchmark shares: timing that stays fair on a busy machine, and one row of the table."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

T = TypeVar("T")

_SLICE = 0.1  # s: in each round a fast candidate is repeated for this long, a slow one runs once


class BrokenBenchmarkError(Exception):
    """A benchmark compares things that do not agree, so its ratios mean nothing."""


@dataclass(frozen=True)
class Row:
    """One line of the table.

    Parameters
    ----------
    what : str
        What is compared with what.
    measured : float
        The ratio, or an error, or a time in s.
    most, least : float, optional
        The target: at most, or at least. Without either the row is for information.
    raw : str
        The times that the ratio was made from.
    kind : str
        "ratio", "error", "time" or "count".
    """

    what: str
    measured: float
    most: float | None = None
    least: float | None = None
    raw: str = ""
    kind: str = "ratio"

    @property
    def target(self) -> str:
        """The target as text."""
        if self.most is not None:
            return f"<= {_number(self.most, self.kind)}"
        return "" if self.least is None else f">= {_number(self.least, self.kind)}"

    @property
    def missed(self) -> bool:
        """Whether there is a target and it was missed; a measurement that is not a number misses it."""
        if self.most is not None:
            return not self.measured <= self.most
        return self.least is not None and not self.measured >= self.least

    @property
    def verdict(self) -> str:
        """ok, MISSED, or nothing where there is no target."""
        return "MISSED" if self.missed else "ok" if self.target else ""

    @property
    def value(self) -> str:
        """The measurement as text."""
        return _number(self.measured, self.kind)


def _number(value: float, kind: str) -> str:
    if kind == "time":
        return seconds(value)
    formats = {"ratio": "{:.3g} x", "error": "{:.1e}", "count": "{:.0f}"}
    return formats[kind].format(value)


def seconds(value: float) -> str:
    """Return a time as text with three digits and a unit."""
    for factor, unit in ((1.0, "s"), (1e3, "ms"), (1e6, "us")):
        if value * factor >= 1:
            return f"{value * factor:.3g} {unit}"
    return f"{value * 1e9:.3g} ns"


def best_times(candidates: Mapping[str, Callable[[], Any]], rounds: int) -> dict[str, float]:
    """Return the shortest time of each candidate, s.

    The candidates take turns, so that what else the machine does meets all of them; each has run once before.
    """
    for run in candidates.values():
        run()
    best = dict.fromkeys(candidates, math.inf)
    for _ in range(rounds):
        for name, run in candidates.items():
            begun = time.perf_counter()
            while True:
                best[name] = min(best[name], timed(run)[0])
                if time.perf_counter() - begun > _SLICE:
                    break
    return best


def timed(run: Callable[[], T]) -> tuple[float, T]:
    """Return how long a call took, s, and its result.

    The smaller of elapsed and processor time counts: other programs lengthen the first, threads the second. A long
    run is interrupted more often than a short one, so elapsed time alone would favour the short one.
    """
    start, used = time.perf_counter(), time.process_time()
    result = run()
    return min(time.perf_counter() - start, time.process_time() - used), result


def check(agrees: bool, rule: str) -> None:
    """Stop a benchmark whose candidates do not agree."""
    if not agrees:
        raise BrokenBenchmarkError(rule)
