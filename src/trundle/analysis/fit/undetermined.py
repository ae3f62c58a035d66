"""What the data cannot show, in words: which numbers only together, what is fixed of them, and the cure.

A null vector of the Jacobian says how numbers may change together without any change in the data. Two numbers p and q
in it are fixed in one combination. Where the vector has dq/dp = ±1, that is their difference or sum; where
d ln f(q)/d ln g(p) is a simple ratio for simple functions f and g, it is a product of their powers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ...errors import TrundleError
from ...solve.samples import Array
from .directions import Directions, echelon, taken
from .observations import GYROSCOPE
from .problem import Problem
from .unknowns import Unknown, of_marks, of_run

_SAME = 2e-5  # by which a ratio may be off a simple one
_POWERS = tuple(Fraction(sign * a, b) for b in (1, 2, 3) for a in (1, 2, 3) if a == 1 or a != b for sign in (1, -1))
_SHOWN = 4  # combinations of one direction


@dataclass(frozen=True)
class _Function:
    """A simple function of one number, as it may stand in a product: f, d ln f/dp, and how it is written."""

    at: Callable[[float], float]
    slope: Callable[[float], float]
    written: str


_PLAIN = _Function(lambda p: p, lambda p: 1 / p, "{}")
_OF_RATIO = (
    _Function(lambda p: p / (1 + p), lambda p: 1 / (p * (1 + p)), "{0}/(1 + {0})"),
    _Function(lambda p: 1 + p, lambda p: 1 / (1 + p), "(1 + {})"),
)
_OF_ANGLE = (
    _Function(lambda p: float(np.sin(p)), lambda p: 1 / np.tan(p), "sin({})"),
    _Function(lambda p: float(np.tan(p)), lambda p: 1 / (np.sin(p) * np.cos(p)), "tan({})"),
)


@dataclass(frozen=True)
class Combination:
    """What is fixed of numbers that are free together.

    Parameters
    ----------
    text : str
        Such as "support.motion.rate·body.inertia_ratio/(1 + body.inertia_ratio)".
    value, sigma : float
        SI.
    unit : str
        SI; empty where it has none, or none that is simple.
    exact : bool
        Whether it is known to be fixed all along; else only near these values.
    with_name : str
        The number in it beside the one that is held.
    """

    text: str
    value: float
    sigma: float
    unit: str
    exact: bool
    with_name: str

    def __str__(self) -> str:
        near = "" if self.exact else " (near these values)"
        return f"{self.text} = {pm(self.value, self.sigma)}{self.unit and ' ' + self.unit}{near}"


@dataclass(frozen=True)
class Undetermined:
    """A direction in which the data do not fix the numbers.

    Parameters
    ----------
    names : tuple of str
        Of the numbers that change along it, the one to be held first.
    combinations : tuple of Combination
        What the data fix of these.
    cures : tuple of str
        What else to measure.
    noisy : bool
        Whether the data would show it, were there less noise.
    held : float
        The value of the first number with which all others are given.
    """

    names: tuple[str, ...]
    combinations: tuple[Combination, ...]
    cures: tuple[str, ...]
    noisy: bool
    held: float

    def __str__(self) -> str:
        first, others = self.names[0], self.names[1:]
        remedies = [f"`{name}`" for name in self.names if not name.startswith("start.")] or [f"`{first}`"]
        cure = f"Give {_or(remedies)}" + "".join(f", or {one}" for one in self.cures) + "."
        apart = [name for name in others if not name.startswith("start.")]
        start = len(apart) < len(others)
        if not others:
            return f"{self._data} do not show `{first}`. {cure}"
        if not apart:
            apart, start = list(others), False
        names = f"{_and((first, *apart))} apart{', nor the start' if start else ''}"
        if not self.combinations:
            return f"{self._data} do not tell {names}. {cure}"
        told = [one for one in self.combinations if one.with_name in apart]
        fixed = "; ".join(map(str, told[:_SHOWN])) + (f"; and {len(told) - _SHOWN} more" if len(told) > _SHOWN else "")
        return f"The data fix only {fixed}. They do not tell {names}. {cure}"

    @property
    def _data(self) -> str:
        return "In this noise the data" if self.noisy else "These data"


def pm(value: float, sigma: float) -> str:
    """Write a value with its error: the error with two digits, the value to the same place.

    Examples
    --------
    >>> pm(0.39999581, 2.06e-05), pm(1234.56, 78.9), pm(2.0, 0.0), pm(-1e-9, 0.02)
    ('0.399996 ± 0.000021', '1235 ± 79', '2 ± 0', '0.000 ± 0.020')
    """
    if not (np.isfinite(sigma) and sigma > 0):
        return f"{value:z.6g}" + (" ± 0" if sigma == 0 else "")
    place = 1 - int(np.floor(np.log10(float(f"{sigma:.1e}"))))
    if place > 8 or place < -6 or abs(value) >= 1e7:
        power = int(np.floor(np.log10(max(abs(value), sigma))))
        digits = max(place + power, 0)
        return f"({value / 10.0**power:z.{digits}f} ± {sigma / 10.0**power:.{digits}f})e{power}"
    return f"{round(value, place):z.{max(place, 0)}f} ± {round(sigma, place):.{max(place, 0)}f}"


def undetermined(
    problem: Problem, values: Array, found: Directions, scale: Array, *, cures: bool = True
) -> list[Undetermined]:
    """Return each direction that the data do not fix."""
    nulls: list[tuple[Array, int, bool]] = []
    for null, noisy in ((found.free, False), (found.weak, True)):
        if null.shape[1]:
            rows, pivots = echelon(null, scale, preference(problem.unknowns, null, scale))
            part = taken(found, scale, problem.signal())
            part[pivots] = True
            nulls += [(np.where(part, row, 0.0), pivot, noisy) for row, pivot in zip(rows.T, pivots, strict=True)]
    shown = _others(problem, values) if cures and nulls else []
    told = []
    for i, (row, pivot, noisy) in enumerate(nulls):
        rest = np.array([other for j, (other, *_) in enumerate(nulls) if j != i]).reshape(-1, row.size).T
        told.append(_told(problem, values, found, row, pivot, _cures(shown, row, rest), noisy=noisy))
    return told


def preference(names: Sequence[Unknown], null: Array, scale: Array) -> Array:
    """Return which numbers are best held: those that a user can look up or measure, first of camera and support."""
    involved = np.abs(null / scale[:, None]).max(axis=1)
    involved = involved > 1e-5 * involved.max()
    ranks = {"camera": 6.0, "support": 5.0, "body": 3.0, "loads": 2.0, "gravity": 3.5}
    each = [ranks.get(one.key.partition(".")[0].partition("[")[0], 1.0) + 0.0 * one.asked for one in names]
    return np.asarray(np.where(involved, each, 0.0))


def _told(
    problem: Problem, values: Array, found: Directions, row: Array, pivot: int, cures: tuple[str, ...], *, noisy: bool
) -> Undetermined:
    names = problem.unknowns
    with_it = [int(i) for i in np.flatnonzero(row) if i != pivot]
    with_it.sort(key=lambda i: (not names[i].asked, i))
    pairs: list[Combination] = []
    for place, i in enumerate(with_it if not noisy else []):
        partners = [pivot, *with_it[:place]]
        each = [_combination(names, values, found.covariance, row, p, i) for p in partners]
        pairs.append(next((one for one in each if one.exact), each[0]))
    held = float(values[pivot])
    listed = (names[pivot].name, *(names[i].name for i in with_it))
    return Undetermined(listed, tuple(pairs), cures, noisy, held)


def _combination(names: Sequence[Unknown], values: Array, covariance: Array, row: Array, p: int, q: int) -> Combination:
    """Return what is fixed of two numbers that change together, the other pivots held."""
    slope = row[q] / row[p]
    one, other = names[p], names[q]
    gradient = np.zeros(values.size)
    if one.unit == other.unit and abs(abs(slope) - 1) < _SAME:
        gradient[[q, p]] = 1.0, -slope
        if slope > 0 and gradient @ values < 0:
            gradient, one, other = -gradient, other, one
        text = f"{other.name} {'−' if slope > 0 else '+'} {one.name}"
        with_name = names[q].name
        return Combination(text, float(gradient @ values), _sigma(gradient, covariance), one.unit, True, with_name)
    product = _product(one, other, float(values[p]), float(values[q]), float(slope))
    if product is not None:
        f, g, power = product
        value = float(g.at(float(values[q])) * f.at(float(values[p])) ** float(power))
        gradient[[q, p]] = value * g.slope(float(values[q])), value * float(power) * f.slope(float(values[p]))
        sides = g.written.format(other.name), f.written.format(one.name)
        first = abs(power) == 1 and bool(one.unit) and not other.unit  # what has a unit stands first
        text = _written(*sides, power)
        unit = other.unit if not one.unit and g is _PLAIN else ""
        if first:
            text = _written(*sides[::-1], power)
            unit = one.unit if f is _PLAIN else ""
            if power < 0:
                value, gradient = 1 / value, -gradient / value**2
        return Combination(text, value, _sigma(gradient, covariance), unit, True, other.name)
    gradient[[q, p]] = 1.0, -slope
    text = f"{other.name} {'−' if slope > 0 else '+'} {abs(slope):.4g}·{one.name}"
    return Combination(text, float(gradient @ values), _sigma(gradient, covariance), other.unit, False, other.name)


def _sigma(gradient: Array, covariance: Array) -> float:
    return float(np.sqrt(max(float(gradient @ covariance @ gradient), 0.0)))


def _product(
    one: Unknown, other: Unknown, p: float, q: float, slope: float
) -> tuple[_Function, _Function, Fraction] | None:
    """Return functions f of p and g of q and the power n with which g(q) f(p)ⁿ is fixed, the simplest first."""
    found: list[tuple[int, _Function, _Function, Fraction]] = []
    for i, f in enumerate(_functions(one, p)):
        for j, g in enumerate(_functions(other, q)):
            ratio = -slope * g.slope(q) / f.slope(p)
            power = next((n for n in _POWERS if abs(ratio - float(n)) < _SAME * abs(float(n))), None)
            if power is not None:
                found.append((_POWERS.index(power) // 2 * 3 + i + j, f, g, power))
    return min(found, key=lambda each: each[0])[1:] if found else None


def _functions(one: Unknown, value: float) -> tuple[_Function, ...]:
    if value == 0 or not np.isfinite(value):
        return ()
    if one.unit == "rad":
        return (_PLAIN, *_OF_ANGLE)
    return (_PLAIN, *_OF_RATIO) if not one.unit and value > 0 else (_PLAIN,)


def _written(left: str, right: str, power: Fraction) -> str:
    size = abs(power)
    right = right if size == 1 else f"({right})^{size}" if size.denominator > 1 else f"({right})^{size.numerator}"
    if power > 0:
        return f"{left}·{right}"
    return f"{left}/({right})" if "/" in right or "·" in right else f"{left}/{right}"


# Cures


# What else a camera or a sensor could see; each with how well, as a share of the noise of places, or in SI.
_WAYS = (
    ("film a mark on the support", ("mark_x", "mark_y")),
    ("measure the ball's turning (a spot on it, or a sensor inside)", ("wx", "wy", "wz")),
    ("measure its height too", ("z",)),
    ("measure both coordinates", ("x", "y")),
)
_TRACE = 1e-6  # of what its parts make each for itself: less is none
_MOST_CURES = 2


def _others(problem: Problem, values: Array) -> list[tuple[str, Array, Array]]:
    """Return what else could be measured, with its derivatives by the unknowns and by numbers of its own."""
    model, mine = problem.models[0], of_run(problem.unknowns, 0)
    found = []
    for words, columns in _WAYS:
        extra = {"mark.position[0]": 0.1, "mark.position[1]": 0.02} if columns[0] == "mark_x" else {}
        turning = columns == ("wx", "wy", "wz") and set(GYROSCOPE.values()) <= set(model.seen.columns)
        if turning or set(columns) <= set(model.seen.columns) or (extra and of_marks(model.seen)):
            continue
        try:
            jacobian, count = model.others([float(values[j]) for j in mine], columns, extra)
        except (TrundleError, ArithmeticError, ValueError):
            continue
        flat = jacobian.reshape(-1, jacobian.shape[2])
        whole = np.zeros((flat.shape[0], len(problem.unknowns)))
        whole[:, mine] = flat[:, : len(mine)]
        found.append((words, whole, flat[:, flat.shape[1] - count :]))
    return found


def _cures(others: Sequence[tuple[str, Array, Array]], row: Array, rest: Array) -> tuple[str, ...]:
    """Return the words for what would show a null vector, whatever the rest of them and numbers of its own do."""
    told = []
    for words, jacobian, own in others:
        trace, instead = jacobian @ row, np.hstack([jacobian @ rest, own])
        if instead.shape[1]:
            trace = trace - instead @ np.linalg.lstsq(instead, trace, rcond=1e-10)[0]
        if np.linalg.norm(trace) > _TRACE * float(np.abs(row) @ np.linalg.norm(jacobian, axis=0)) > 0:
            told.append(words)
    return tuple(told[:_MOST_CURES])


def _or(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"


def _and(names: Sequence[str]) -> str:
    words = [f"`{name}`" for name in names]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
