"""DOP853's loop, compiled by numba once for all laws; imported only where numba is.

The method, its control of the step and its polynomials are SciPy's: E. Hairer, S. P. Nørsett, G. Wanner, Solving
Ordinary Differential Equations I, 2nd ed. (Springer, 1993), section II.5 and appendix. Besides, what rounding takes off
each sum y + Δy is carried on to the next step.
"""

from __future__ import annotations

import contextlib
import warnings
from typing import Any

import numba
import numpy as np
from numba import errors, float64, int64, types, uintp, void

from .compiled_steps import ENDED, FULL, LOOK, LOW, STUCK
from .machine_code import MachineCode

_SAFETY, _LEAST_FACTOR, _MOST_FACTOR, _EXPONENT = 0.9, 0.2, 10.0, -1 / 8  # of the next step, as SciPy has them

_array, _table = float64[::1], float64[:, ::1]
_FILLING = void(uintp, uintp)  # of where [t, *state, *numbers] lie, and where what it fills in is to lie
_STATE, _FOUND = types.UniTuple(_array, 5), types.Tuple((_array, _table, float64[:, :, ::1], _table))
_TABLES = types.Tuple((_table, _array, _array, _array, _table, _array))
_given: Any = {"error_model": "numpy", "nogil": True}
njit: Any = numba.njit


def _compiled(function: Any, *signature: Any) -> Any:
    """Compile a function, or take it as numba has kept it; where there is nowhere to keep it, it is not kept."""
    with contextlib.suppress(Exception):
        return njit(*signature, cache=True, **_given)(function)
    return njit(*signature, **_given)(function)


@_compiled
def _copy(numbers: Any, into: Any) -> None:
    """Copy numbers: to compile `into[:] = numbers`, which may not fit, takes numba two seconds."""
    for i in range(numbers.size):
        into[i] = numbers[i]


@_compiled
def _stage(which: Any, a: Any, k: Any, y: Any, h: Any, moved: Any, x: Any) -> None:
    """Put the state at which a stage's rates are wanted into x."""
    for i in range(y.size):
        part = 0.0
        for j in range(which):
            part += a[which, j] * k[j, i]
        moved[i] = part * h
        x[1 + i] = y[i] + moved[i]


@_compiled
def _error(e3: Any, e5: Any, k: Any, y: Any, new: Any, h: Any, least: Any, tolerance: Any) -> Any:
    """Return the estimated error of a step; 1 is the most."""
    third, fifth = 0.0, 0.0
    for i in range(y.size):
        scale = least[i] + max(abs(y[i]), abs(new[i])) * tolerance
        three, five = 0.0, 0.0
        for j in range(13):
            three += e3[j] * k[j, i]
            five += e5[j] * k[j, i]
        third += (three / scale) ** 2
        fifth += (five / scale) ** 2
    return 0.0 if third == 0 and fifth == 0 else h * fifth / np.sqrt((fifth + 0.01 * third) * y.size)


@_compiled
def _polynomial(d: Any, k: Any, y: Any, new: Any, h: Any, terms: Any) -> None:
    """Work out the terms of the polynomial through a step."""
    for i in range(y.size):
        moved = new[i] - y[i]
        terms[0, i] = moved
        terms[1, i] = h * k[0, i] - moved
        terms[2, i] = 2 * moved - h * (k[12, i] + k[0, i])
        for row in range(4):
            part = 0.0
            for j in range(16):
                part += d[row, j] * k[j, i]
            terms[3 + row, i] = h * part


@_compiled
def _may_fall(values: Any) -> Any:
    """Tell whether an event function falls through zero from one look to the next, or may do so between them."""
    for which in range(values.shape[1]):
        lowest, highest, known = np.inf, -np.inf, True
        for look in range(values.shape[0]):
            value = values[look, which]
            if look and values[look - 1, which] >= 0 and value < 0:
                return True
            lowest, highest, known = min(lowest, value), max(highest, value), known and not np.isnan(value)
        if known and lowest < LOW * (highest - lowest):
            return True
    return False


@_compiled
def _looked(functions: Any, looks: Any, begin: Any, h: Any, y: Any, terms: Any, x: Any, values: Any) -> Any:
    """Tell whether a step may hold an event, by its polynomial."""
    for look in range(looks.size):
        share = looks[look]
        x[0] = begin + share * h
        for i in range(y.size):
            part = 0.0
            for j in range(7):
                part = (part + terms[6 - j, i]) * (share if j % 2 == 0 else 1 - share)
            x[1 + i] = part + y[i]
        functions(x.ctypes.data, values[look].ctypes.data)
    return _may_fall(values)


@_compiled
def _step(
    rates: Any, begin: Any, t: Any, h: Any, y: Any, carry: Any, a: Any, c: Any, x: Any, k: Any, room: Any
) -> None:
    """Work out a step's thirteen stages; leave its Δy and the state behind it in `room`."""
    moved, new = room
    for which in range(1, 13):
        _stage(which, a, k, y, h, moved, x)
        x[0] = begin + (t + c[which] * h)
        if which == 12:
            for i in range(y.size):
                moved[i] += carry[i]
                new[i] = y[i] + moved[i]
                x[1 + i] = new[i]
        rates(x.ctypes.data, k[which].ctypes.data)


def _advance(rates: Any, functions: Any, numbers: Any, state: Any, tables: Any, found: Any) -> Any:
    """Take steps until there are as many as asked for, or the end or one that may hold an event is come to.

    Numbers: from when times count, the time, the end, the next step, the tolerance, the longest step. State: x = [t,
    *y, *numbers of the law], y, ẏ, the carry, the least errors. Returns how many steps it took, and why no more;
    `numbers`, `state` and `found` (times, states, polynomials, looks) are filled in.
    """
    begin, t, end, step, tolerance, longest = numbers
    x, y, f, carry, least = state
    a, c, e3, e5, d, looks = tables
    times, starts, terms, values = found
    k, room, count, why = np.empty((16, y.size)), np.empty((3, y.size)), 0, FULL
    times[0], moved, new = t, room[0], room[1]
    while count < len(starts) and why == FULL:
        _copy(f, k[0])
        shortest, rejected = 10 * (np.nextafter(t, np.inf) - t), False
        step = max(min(step, longest), shortest)
        while True:
            if not step >= shortest:
                numbers[1], numbers[3] = t, step
                return count, STUCK
            later = min(t + step, end)
            h = later - t
            _step(rates, begin, t, h, y, carry, a, c, x, k, (moved, new))
            error = _error(e3, e5, k, y, new, h, least, tolerance)
            if error < 1:
                factor = _MOST_FACTOR if error == 0 else min(_MOST_FACTOR, _SAFETY * error**_EXPONENT)
                step = h * (min(1.0, factor) if rejected else factor)
                break
            factor = _SAFETY * error**_EXPONENT
            step, rejected = h * (factor if factor > _LEAST_FACTOR else _LEAST_FACTOR), True
        for which in range(13, 16):
            _stage(which, a, k, y, h, room[2], x)
            x[0] = begin + (t + c[which] * h)
            rates(x.ctypes.data, k[which].ctypes.data)
        _polynomial(d, k, y, new, h, terms[count])
        _copy(y, starts[count])
        if values.shape[1] and _looked(functions, looks, begin + t, h, y, terms[count], x, values):
            why = LOOK
        for i in range(y.size):
            carry[i] = moved[i] - (new[i] - y[i])
            y[i], f[i] = new[i], k[12, i]
        t, count = later, count + 1
        times[count] = t
        if t >= end and why == FULL:
            why = ENDED
    numbers[1], numbers[3] = t, step
    return count, why


class _Function(types.WrapperAddressProtocol):
    """Machine code as numba calls it."""

    def __init__(self, code: MachineCode) -> None:
        self.code = code

    def __wrapper_address__(self) -> int:
        return self.code.address

    def signature(self) -> Any:
        """Return what it takes."""
        return _FILLING


def advance() -> Any:
    """Return the loop, compiled, or as numba kept it.

    Examples
    --------
    >>> callable(advance())
    True
    """
    signature = types.UniTuple(int64, 2)(
        types.FunctionType(_FILLING), types.FunctionType(_FILLING), _array, _STATE, _TABLES, _FOUND
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", errors.NumbaExperimentalFeatureWarning)  # of functions as arguments
        loop = _compiled(_advance, signature)
    return lambda rates, functions, *given: loop(_Function(rates), _Function(functions), *given)
