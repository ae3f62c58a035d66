"""The instants at which a run is sampled."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidValueError
from ..mechanics import checks
from ..mechanics.system import RollingSystem, State
from .contact_state import moment

MOST_SAMPLES = 10_000_000  # 1.9 GB of results
# How far apart two floats may be at the start of a run, as a share of the step, and of a time in which it changes.
_COARSEST_OF_STEP, _COARSEST_OF_MOMENT = 1e-3, 1e-7


def check_sampling(duration: Any, every: Any, prefix: str = "") -> tuple[float, float]:
    """Return duration and step in s, or say what is wrong with them.

    Examples
    --------
    >>> check_sampling("60 s", "10 ms")
    (60.0, 0.01)
    """
    length = checks.positive(duration, "time", f"{prefix}duration")
    step = checks.positive(every, "time", f"{prefix}every")
    if step > length:
        raise InvalidValueError(
            f"{prefix}every", f"must not be longer than the run ({length:g} s)", every, "Give a shorter step."
        )
    count = length / step + 1
    if count > MOST_SAMPLES:
        raise InvalidValueError(
            f"{prefix}every",
            f"must leave at most {MOST_SAMPLES:,} samples",
            every,
            f"It makes {_count(count)}; {_longer(length, MOST_SAMPLES)}.",
        )
    return length, step


def sample_times(duration: Any, every: Any, prefix: str = "") -> NDArray[np.float64]:
    """Return the instants 0, h, 2h, ... of a run and its end.

    Examples
    --------
    >>> sample_times(1.0, 0.4).tolist()
    [0.0, 0.4, 0.8, 1.0]
    """
    length, step = check_sampling(duration, every, prefix)
    whole = math.floor(length / step * (1 + 4e-16))
    times = np.arange(whole + 1, dtype=np.float64) * np.float64(step)
    if length - times[-1] > 1e-9 * step:
        return np.concatenate([times, [length]])
    times[-1] = length
    return times


def check_clock(system: RollingSystem, start: State, step: float) -> None:
    """Refuse a start so far from 0 on the clock that rounding of the time would show in the motion.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> check_clock(table, table.place(time=1e6), 0.01)
    """
    apart = float(np.spacing(abs(start.time)))
    if start.time and apart > min(_COARSEST_OF_STEP * step, _COARSEST_OF_MOMENT * moment(system, start)):
        rule = f"must be nearer to 0 for samples {step:g} s apart"
        remedy = f"Instants there are {apart:.1g} s apart. Let the run start nearer to 0, and shift its formulas in t."
        raise InvalidValueError("start.time", rule, start.time, remedy)


def longer_step(times: NDArray[np.float64], most: int) -> str:
    """Say which step leaves a run fewer samples.

    Examples
    --------
    >>> longer_step(np.linspace(0.0, 10.0, 1001), 101)
    'ask for 0.1 s or more, or a shorter duration'
    """
    return _longer(float(times[-1] - times[0]), most)


def _longer(length: float, most: int) -> str:
    return f"ask for {_round_up(length / (most - 1)):g} s or more, or a shorter duration"


def _round_up(value: float) -> float:
    digits = 10.0 ** (math.floor(math.log10(value)) - 1)
    return math.ceil(value / digits) * digits


def _count(count: float) -> str:
    return f"{round(count):,}" if count < 1e15 else f"{count:.3g}"
