"""Derivatives of the final state, an engine's own and differences of its runs, against the exact ones.

They are measured in metres: a velocity counts for how far it leads within the run, an angular velocity for how far it
rolls a body of the size of the smallest.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from .answers import CANNOT, NOT_FINITE, OK, TOO_SLOW
from .case import END, Array, Case, Input, Motion, extent
from .running import Adapter

SHARES = (1e-3, 1e-5)  # of a number, by which it is changed for differences of runs
OWN = "derivatives of its own"
_NONE = "it gives no derivatives of its own"


class Result(NamedTuple):
    """What came of derivatives taken in one way."""

    outcome: str
    message: str
    error: float = math.nan  # relative, the largest by any input
    seconds: float = math.nan
    engine: str = ""


def compared(
    case: Case, inputs: Sequence[Input], found: Sequence[Array | str], seconds: float = math.nan, engine: str = ""
) -> Result:
    """Compare derivatives with the exact ones; those that are missing are told of, with why.

    Examples
    --------
    >>> import trundle as tr
    >>> case = next(case for case in tr.conformance.cases() if case.name == "incline")
    >>> first = case.inputs()[0]
    >>> round(compared(case, [first], [1.01 * first.exact]).error, 12)
    0.01
    >>> compared(case, [first], ["it has none by this"])[:2]
    ('cannot', 'gravity: it has none by this')
    """
    scale = np.repeat([1.0, case.duration, case.duration * extent(case)], 3)
    reasons: dict[str, list[str]] = {}
    errors = []
    for wanted, slopes in zip(inputs, found, strict=True):
        if isinstance(slopes, str):
            reasons.setdefault(slopes, []).append(wanted.name)
        else:
            apart = np.linalg.norm((slopes - wanted.exact) * scale)
            errors.append(float(apart / np.linalg.norm(wanted.exact * scale)))
    message = "; ".join(f"{', '.join(names)}: {reason}" for reason, names in reasons.items())
    return Result(OK if errors else CANNOT, message, max(errors, default=math.nan), seconds, engine)


def own(
    adapter: Adapter, case: Case, inputs: Sequence[Input], dt: float, setting: Mapping[str, Any]
) -> dict[str, Result]:
    """Return what came of an engine's own derivatives, by each way that it has to them."""
    answer = adapter.answer(case, dt, dict(setting), inputs)
    if answer.outcome != OK:
        return {OWN: Result(answer.outcome, answer.message, engine=answer.engine)}
    if not answer.derivatives:
        return {OWN: Result(CANNOT, _NONE, engine=answer.engine)}
    return {
        way: compared(case, inputs, found, answer.seconds, answer.engine) for way, found in answer.derivatives.items()
    }


def of_runs(
    adapter: Adapter, case: Case, inputs: Sequence[Input], dt: float, setting: Mapping[str, Any]
) -> dict[str, Result]:
    """Return what came of differences of an engine's runs: two for each input, all of them within its limit."""
    return {
        f"differences of runs by {share:g}": _of_runs(adapter, case, inputs, dt, setting, share) for share in SHARES
    }


def _of_runs(
    adapter: Adapter, case: Case, inputs: Sequence[Input], dt: float, setting: Mapping[str, Any], share: float
) -> Result:
    until, spent = time.monotonic() + adapter.limit, 0.0
    found: list[Array | str] = []
    for wanted in inputs:
        ends, by = [], share * wanted.size
        for near in (wanted.moved(-by), wanted.moved(by)):
            answer = adapter.answer(near, dt, dict(setting))
            if answer.motion is None:
                failed = math.inf if answer.outcome == NOT_FINITE else math.nan
                return Result(answer.outcome, answer.message, failed, engine=answer.engine)
            if time.monotonic() > until:
                return Result(TOO_SLOW, f"{2 * len(inputs)} runs take more than {adapter.limit:g} s")
            ends.append(_end(answer.motion))
            spent += answer.seconds
        found.append((ends[1] - ends[0]) / (2 * by))
    return compared(case, inputs, found, spent, answer.engine)


def _end(motion: Motion) -> Array:
    """Return the final state, without orientations."""
    return np.concatenate([getattr(motion, part)[-1] for part in END], axis=1)
