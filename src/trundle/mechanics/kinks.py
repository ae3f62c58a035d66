"""The instants at which a formula in the time has a kink: where what stands between bars passes through zero.

They are found by interval arithmetic and not by looking. Where the bounds of what stands between the bars leave out
zero, there is no kink; elsewhere an interval is halved, until what is left of it is rounding [moore1966]. A place or an
angle of a support that has a kink makes its velocity jump.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .expressions import Expression

if TYPE_CHECKING:
    from .motions import Motion
    from .system import RollingSystem

Array = NDArray[np.float64]
Bounds = tuple[Array, Array]

_FIRST = 64  # intervals
_MOST = 20_000  # of them at a time: no formula with so many kinks is followed from one to the next
_BLUR = 4e-16  # of a number, by which each operation, and the clock itself, may be off
_WIDEST = 1e-6  # of the span: what is left of an instant that is known at all
_BEYOND = 1e-7  # of the span, by which is looked farther: a kink at its end is one, too
_JUMP = 1e-9  # of the support's velocities: what is no more is no jump
_ANY_TURN = 0.7391  # of a support's own coordinates, at which the jumps of two parts do not cancel by chance


@dataclass(frozen=True)
class Kink:
    """An instant at which a formula in the time has a kink, as exactly as floats can tell it."""

    before: float  # s; what stands between the bars is surely not zero there or at `behind`, nor beyond them
    time: float  # the first float at which it is evaluated as it is behind the kink, s
    behind: float  # s
    jolts: bool = False  # whether the velocity of the support jumps there


def kinks(thing: Any, begin: float, end: float) -> list[Kink]:
    """Return the kinks of a system's formulas in the time, ascending; those at one instant are one.

    Examples
    --------
    >>> from trundle.mechanics.motions import SpinBy
    >>> found = kinks(SpinBy("2*abs(t - 1.5) + abs(cos(t))"), 0.0, 3.0)
    >>> [round(kink.time, 12) for kink in found]
    [1.5, 1.570796326795]
    """
    further = end + _BEYOND * (end - begin)
    found = [kink for tree in set(_between_bars(thing)) for kink in _passed(tree, begin, further)]
    merged: list[Kink] = []
    for kink in sorted(found, key=lambda kink: kink.before):
        if merged and kink.before <= merged[-1].behind:
            last = merged.pop()
            kink = Kink(last.before, max(last.time, kink.time), max(last.behind, kink.behind))
        merged.append(kink)
    return [kink for kink in merged if begin < kink.behind and kink.time <= end]


def kinks_and_jolts(system: RollingSystem, begin: float, end: float) -> list[Kink]:
    """Return the kinks of a system's formulas, and of each whether the velocity of the support jumps there.

    Examples
    --------
    >>> import trundle as tr
    >>> shelf = tr.Support(tr.Plane(), motion=tr.Move(("abs(t - 1)", 0.0, 0.0)))
    >>> [kink.jolts for kink in kinks_and_jolts(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), shelf), 0.0, 2.0)]
    [True]
    """
    motion = system.support.motion
    return [replace(kink, jolts=has_kinks(motion) and _jumps(motion, kink)) for kink in kinks(system, begin, end)]


def _jumps(motion: Motion, kink: Kink) -> bool:
    """Tell whether the velocity of a support jumps at a kink, by more than it changes in the time that is unclear."""
    before, after = (motion.at(time, *(_ANY_TURN for _ in motion.coordinates)) for time in (kink.before, kink.behind))
    pairs = ("velocity", "acceleration"), ("angular_velocity", "angular_acceleration")
    for velocity, acceleration in pairs:
        v, w = getattr(before, velocity), getattr(after, velocity)
        rates = getattr(before, acceleration).norm() + getattr(after, acceleration).norm()
        if (w - v).norm() > _JUMP * max(v.norm(), w.norm()) + rates * (kink.behind - kink.before):
            return True
    return False


def has_kinks(thing: Any) -> bool:
    """Tell whether a system has a formula in the time that may have a kink.

    Examples
    --------
    >>> from trundle.mechanics.motions import SpinBy
    >>> has_kinks(SpinBy("abs(t - 1)")), has_kinks(SpinBy("sin(t)"))
    (True, False)
    """
    return next(_between_bars(thing), None) is not None


def _between_bars(thing: Any) -> Iterator[Any]:
    """Yield what stands between bars, in t alone, in all formulas of a system."""
    if isinstance(thing, Expression):
        yield from _in_tree(thing.tree)
    elif isinstance(thing, tuple):
        for part in thing:
            yield from _between_bars(part)
    elif is_dataclass(thing) and not isinstance(thing, type):
        for field in fields(thing):
            yield from _between_bars(getattr(thing, field.name))


def _in_tree(tree: Any) -> Iterator[Any]:
    if not isinstance(tree, tuple):
        return
    operator, *parts = tree
    if operator == "**":
        parts = parts[:1]
    if operator == "abs" and Expression(parts[0], "").variables == {"t"}:
        yield parts[0]
    for part in parts:
        yield from _in_tree(part)


def _passed(tree: Any, begin: float, end: float) -> list[Kink]:
    """Return the zeros of a formula; none where they cannot be told apart."""
    edges = np.linspace(begin, end, _FIRST + 1)
    a, b, blur = edges[:-1], edges[1:], _BLUR * max(abs(begin), abs(end))
    while True:
        with np.errstate(all="ignore"):
            low, high = _bounds(tree, a - blur, b + blur)
        unclear = ~((low > 0) | (high < 0))  # also where it is not finite
        a, b = a[unclear], b[unclear]
        middle = 0.5 * (a + b)
        halved = (b - a > blur) & (middle > a) & (middle < b)
        if not halved.any() or 2 * a.size > _MOST:
            break
        a, b = np.concatenate([a, middle[halved]]), np.concatenate([np.where(halved, middle, b), b[halved]])
    if not a.size:
        return []
    order = np.argsort(a)
    a, b = a[order], b[order]
    parts = np.flatnonzero(a[1:] > b[:-1]) + 1
    firsts, lasts = a[np.append(0, parts)], b[np.append(parts - 1, a.size - 1)]
    known = lasts - firsts <= _WIDEST * (end - begin)
    return [_located(tree, *ends) for ends in zip(firsts[known].tolist(), lasts[known].tolist(), strict=True)]


def _located(tree: Any, before: float, behind: float) -> Kink:
    """Return the kink between two instants, found by halving.

    What is zero at a float counts as behind it, as the slope of what stands between bars does.
    """
    formula = Expression(tree, "")
    sign = np.sign(formula.at(t=behind))
    first, last = before, behind
    while first < (middle := 0.5 * (first + last)) < last:
        first, last = (first, middle) if formula.at(t=middle) * sign >= 0 else (middle, last)
    return Kink(before, last, behind)


def _bounds(tree: Any, a: Array, b: Array) -> Bounds:
    """Return bounds of a formula over intervals, wider by what rounding may do."""
    if isinstance(tree, str):
        return a, b
    if not isinstance(tree, tuple):
        return np.full_like(a, tree), np.full_like(a, tree)
    operator, *rest = tree
    if operator == "**":
        return _blurred(*_power(_bounds(rest[0], a, b), int(rest[1])))
    return _blurred(*_OPERATIONS[operator](*(_bounds(part, a, b) for part in rest)))


def _blurred(low: Array, high: Array) -> Bounds:
    return low - _BLUR * np.abs(low), high + _BLUR * np.abs(high)


def _among(*corners: Array) -> Bounds:
    """Return bounds from the values at all corners; none at all where one of them is not a number."""
    low, high = np.minimum.reduce(corners), np.maximum.reduce(corners)
    return np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high)


def _product(x: Bounds, y: Bounds) -> Bounds:
    return _among(*(one * other for one in x for other in y))


def _quotient(x: Bounds, y: Bounds) -> Bounds:
    none = (y[0] <= 0) & (y[1] >= 0)
    low, high = _among(*(one / other for one in x for other in y))
    return np.where(none, -np.inf, low), np.where(none, np.inf, high)


def _power(x: Bounds, exponent: int) -> Bounds:
    if exponent < 0:
        one = np.ones_like(x[0])
        return _quotient((one, one), _power(x, -exponent))
    low, high = _among(x[0] ** exponent, x[1] ** exponent)
    through = (x[0] < 0) & (x[1] > 0)
    return (np.where(through, 0.0, low) if exponent % 2 == 0 and exponent else low), high


def _size(x: Bounds) -> Bounds:
    low, high = _among(np.abs(x[0]), np.abs(x[1]))
    return np.where((x[0] < 0) & (x[1] > 0), 0.0, low), high


def _hypot(x: Bounds, y: Bounds) -> Bounds:
    (a, b), (c, d) = _size(x), _size(y)
    return np.hypot(a, c), np.hypot(b, d)


def _wave(function: Callable[[Array], Array], crest: float) -> Callable[[Bounds], Bounds]:
    """Return bounds of a sine whose crests are at `crest`, and half a turn from there its troughs."""

    def bounds(x: Bounds) -> Bounds:
        low, high = _among(function(x[0]), function(x[1]))
        turn = 2 * np.pi
        crests = np.floor((x[1] - crest) / turn) > np.floor((x[0] - crest) / turn)
        troughs = np.floor((x[1] - crest) / turn - 0.5) > np.floor((x[0] - crest) / turn - 0.5)
        # In all else an angle's own rounding is in its bounds; a compiler that turns it in parts makes another.
        return np.where(troughs, -1.0, low - _BLUR), np.where(crests, 1.0, high + _BLUR)

    return bounds


_SINE, _COSINE = _wave(np.sin, 0.5 * np.pi), _wave(np.cos, 0.0)
_OPERATIONS: dict[str, Callable[..., Bounds]] = {
    "+": lambda x, y: (x[0] + y[0], x[1] + y[1]),
    "-": lambda x, y: (x[0] - y[1], x[1] - y[0]),
    "*": _product,
    "/": _quotient,
    "neg": lambda x: (-x[1], -x[0]),
    "abs": _size,
    "sqrt": lambda x: _among(*(np.sqrt(np.maximum(part, 0.0)) for part in x)),
    "exp": lambda x: (np.exp(x[0]), np.exp(x[1])),
    "log": lambda x: _among(np.log(x[0]), np.log(x[1])),
    "sin": _SINE,
    "cos": _COSINE,
    "tan": lambda x: _quotient(_SINE(x), _COSINE(x)),
    "hypot": _hypot,
}
