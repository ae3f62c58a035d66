"""Derivatives against differences of runs: the same question asked of the plain laws, with other numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...errors import TrundleError
from ...mechanics.system import RollingSystem, State
from ...scenario import ScenarioFile
from ...solve.samples import Array, Samples
from .following import Followed
from .keys import Key, moved

_STEPS = (1e-4, 1e-6)  # shares of each number by which it is changed; the second where the first is too coarse
_ALONE = 1e-2  # in SI, a number that is 0 where no other has its unit
_ENOUGH = 1e-6  # share of a derivative by which a difference of runs may be off
_SURE = 10.0  # times how far two differences with other steps are apart
_VAGUE = 1e-2  # share of a derivative from which on a difference tells nothing
_STILL = 1e-10  # share of a length in the time of the run: what moves no faster is at rest but for rounding


@dataclass(frozen=True)
class Agreement:
    """How far the derivatives are from differences of runs in which all numbers are changed at once, or each."""

    # the largest difference, as a share of the largest derivative of its quantity; not a number where nothing could be
    # compared
    apart: float
    sure: float  # how well the differences themselves are known, as a share of the largest
    samples: int  # at how many samples they were compared: those in the same phase in all runs
    left_out: tuple[str, ...] = ()  # the numbers that could not be changed both ways, such as a drag of 0

    @property
    def passed(self) -> bool | None:
        """Whether they agree as well as the differences are known; None where these tell nothing."""
        told = self.samples and self.sure <= _VAGUE
        return bool(self.apart <= max(_ENOUGH, _SURE * self.sure)) if told else None

    def __str__(self) -> str:
        if not self.samples:
            return "not compared with differences of runs"
        if self.passed is None:
            return "differences of runs tell nothing here: the motion parts too fast"
        if self.passed:
            rest = f", {', '.join(self.left_out)} apart" if self.left_out else ""
            return f"agrees with differences of runs to {self.apart:.1g}{rest}"
        return f"differs from differences of runs by {self.apart:.2g} of its size; these are known to {self.sure:.1g}"


Solve = Callable[[RollingSystem, State, Array], Samples]


def compare(scenario: ScenarioFile, wanted: Sequence[Key], followed: Followed, times: Array, solve: Solve) -> Agreement:
    """Change all numbers at once, a little up and down, and compare what the runs differ by with the derivatives.

    Where no run begins so with all of them changed, each is changed by itself.
    """
    best = partial(_best, partial(_compared, scenario, wanted, followed, times, solve))
    together = best(range(len(wanted)))
    if together.samples:
        return together
    alone = [best([j]) for j in range(len(wanted))]
    told = [one for one in alone if one.samples]
    if not told:
        return together
    left_out = tuple(key.name for key, one in zip(wanted, alone, strict=True) if not one.samples)
    largest = (max(one.apart for one in told), max(one.sure for one in told))
    return Agreement(*largest, min(one.samples for one in told), left_out)


def _best(compared: Callable[[Sequence[int], float], Agreement], which: Sequence[int]) -> Agreement:
    """Change some of the numbers at once, by less where that tells more."""
    best: Agreement | None = None
    for share in _STEPS:
        found = compared(which, share)
        best = found if best is None or found.sure < best.sure else best
        if best.sure <= _ENOUGH / _SURE or not best.samples:
            break
    return best or Agreement(np.nan, np.nan, 0)


def _compared(
    scenario: ScenarioFile,
    wanted: Sequence[Key],
    followed: Followed,
    times: Array,
    solve: Solve,
    which: Sequence[int],
    share: float,
) -> Agreement:
    steps = [share * _size(key, wanted) * (-1) ** j for j, key in enumerate(wanted)]
    usable = [j for j in which if _may_change(scenario, wanted[j], steps[j])]
    left_out = tuple(wanted[j].name for j in which if j not in usable)
    none = Agreement(np.nan, np.nan, 0, left_out)
    if not usable:
        return none

    def begun(part: float) -> tuple[RollingSystem, State]:
        return moved(scenario, {wanted[j].name: wanted[j].value + part * steps[j] for j in usable})

    try:
        starts = [begun(part) for part in (1.0, -1.0, 0.5, -0.5)]
        first = int(np.searchsorted(times, max(start.time for _, start in starts)))  # before that some have not begun
        runs = [solve(system, start, times[first:]) for system, start in starts]
    except TrundleError:  # with these numbers all at once the body cannot start so
        return none
    far, near, here = runs[:2], runs[2:], followed.samples.part(slice(first, None))
    size = min(one.time.size for one in (*runs, here))
    alike = [(one.phase[:size] == here.phase[:size]) & (one.time[:size] == here.time[:size]) for one in runs]
    everywhere = np.all(alike, axis=0)
    if not everywhere.any():
        return none
    apart, sure = 0.0, 0.0
    for name, usual in _sizes(here).items():
        wide, narrow = (
            (getattr(up, name)[:size] - getattr(down, name)[:size])[everywhere] / (2 * part)
            for (up, down), part in ((far, 1.0), (near, 0.5))
        )
        found = followed.slopes[name][first:][:size][everywhere][:, :, usable] @ np.array([steps[j] for j in usable])
        least = 1e-3 * share * usual
        of_runs = (4 * narrow - wide) / 3
        apart = max(apart, float(np.abs(found - of_runs).max()) / max(float(np.abs(found).max()), least))
        # Of its own size: where runs part as far as they can, differences are nothing beside a derivative that grows.
        sure = max(sure, float(np.abs(wide - narrow).max()) / 3 / max(float(np.abs(of_runs).max()), least))
    return Agreement(apart, sure, int(everywhere.sum()), left_out)


def _sizes(at: Samples) -> dict[str, float]:
    """Return of what size the compared quantities are; beside V, an Ω of V/|ρ| is."""
    arm = float(np.linalg.norm(at.position - at.contact, axis=1).max())
    place, V, turning = (float(np.abs(part).max()) for part in (at.position, at.velocity, at.angular_velocity))
    length = max(place, arm)
    speed = max(V, turning * arm, _STILL * length / max(float(np.ptp(at.time)), 1e-300))
    return {"position": length, "velocity": speed, "angular_velocity": speed / arm}


def _size(key: Key, wanted: Sequence[Key]) -> float:
    """Return of what size a number is: where it is 0, the largest other of its unit."""
    others = max((abs(other.value) for other in wanted if other.unit == key.unit), default=0.0)
    return abs(key.value) or others or _ALONE


def _may_change(scenario: ScenarioFile, key: Key, step: float) -> bool:
    try:
        for way in (1, -1):
            moved(scenario, {key.name: key.value + way * step})
    except TrundleError:
        return False
    return True
