"""Whether a formula in the time is finite throughout a run, decided by interval arithmetic and not by looking.

Where the bounds of a formula over an interval are finite, so is the formula all over it. Where they are not, the
interval is halved, from its beginning on, until either they are or the instant is found [moore1966].
"""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any

from ..errors import InvalidValueError
from .algebra import Vector
from .expressions import Expression

_MOST_LOOKS = 4000
_FINEST = 1e-12  # of the run: an instant is found to this
_LARGEST = 1e300
_NEAR = 1e-5  # of an instant


class _UnclearError(Exception):
    """The bounds over an interval do not say that a formula and its slopes are finite there."""


def first_singular(formula: Expression, start: float, end: float) -> float | None:
    """Return the first instant at which a formula in t, or its slope, is not finite.

    Examples
    --------
    >>> push = Expression.parse("1/(t - 3)", ("t",), "value[0]")
    >>> round(first_singular(push, 0.0, 10.0), 9), first_singular(push, 4.0, 10.0)
    (3.0, None)
    """
    todo, looks = [(float(start), float(end))], 0
    while todo and looks < _MOST_LOOKS:
        a, b = todo.pop()
        looks += 1
        try:
            _bounds(formula.tree, a, b)
        except _UnclearError:
            middle = 0.5 * (a + b)
            if b - a <= _FINEST * max(end - start, abs(a), abs(b)) or not a < middle < b:
                return start if a == start else middle
            todo += [(middle, b), (a, middle)]
    return None


def check_finite(thing: Any, start: float, end: float, key: str = "") -> None:
    """Refuse a system whose formulas in the time are not finite throughout a run, by key and instant.

    Nor may a formula end so near to the run, at an instant t, that the rounding of t would show in it: nearer than 1e-5
    of t a pole makes an error of 1e-11.

    Examples
    --------
    >>> from trundle.mechanics.motions import SpinBy
    >>> check_finite(SpinBy("1/(t - 3)"), 0.0, 2.0)
    >>> check_finite(SpinBy("1/(t - 3)"), 0.0, 10.0, "support.motion")
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `support.motion.rate` must be finite, with its slopes, throughout the run; got \
'1/(t - 3)'. It is not at t = 3 s.
    """
    if isinstance(thing, Expression):
        near = (start - _NEAR * abs(start), end + _NEAR * abs(end))
        if thing.variables <= {"t"} and (instant := first_singular(thing, *near)) is not None:
            remedy = f"It is not at t = {instant + 0.0:.9g} s."
            if not start <= instant <= end:
                remedy += " Begin later than that." if instant < start else " End the run sooner before that."
            raise InvalidValueError(key, "must be finite, with its slopes, throughout the run", thing.text, remedy)
    elif isinstance(thing, (tuple, Vector)):
        for i, part in enumerate(thing):
            check_finite(part, start, end, f"{key}[{i}]")
    elif is_dataclass(thing):
        for field in fields(thing):
            check_finite(getattr(thing, field.name), start, end, f"{key}.{field.name}" if key else field.name)


def varies(thing: Any) -> bool:
    """Tell whether a system has a formula in the time.

    Examples
    --------
    >>> from trundle.mechanics.motions import Spin, SpinBy
    >>> varies(SpinBy("1/(t - 3)")), varies(Spin(1.0))
    (True, False)
    """
    if isinstance(thing, Expression):
        return thing.variables <= {"t"}
    if isinstance(thing, (tuple, Vector)):
        return any(varies(part) for part in thing)
    return is_dataclass(thing) and any(varies(getattr(thing, field.name)) for field in fields(thing))


def _bounds(tree: Any, a: float, b: float) -> Any:
    """Return an interval that holds all values of a formula over [a, b]."""
    from mpmath import iv

    if isinstance(tree, str):
        return iv.mpf([a, b])
    if not isinstance(tree, tuple):
        return iv.mpf(tree)
    operator, *rest = tree
    parts = [_bounds(part, a, b) for part in rest[: 1 if operator == "**" else None]]
    x = parts[0]
    if operator == "**":
        power = int(rest[1])
        _need(power >= 0 or 0 not in x)
        value = x**power
    elif operator == "/":
        _need(0 not in parts[1])
        value = x / parts[1]
    elif operator in ("+", "-", "*"):
        y = parts[1]
        value = x + y if operator == "+" else x - y if operator == "-" else x * y
    elif operator == "neg":
        value = -x
    else:
        value = _function(iv, operator, parts)
    _need(abs(value) < _LARGEST)
    return value


def _function(iv: Any, name: str, parts: list[Any]) -> Any:
    x = parts[0]
    if name == "abs":
        return abs(x)
    if name == "hypot":
        _need(0 not in x or 0 not in parts[1])
        return iv.sqrt(x**2 + parts[1] ** 2)
    if name in ("sqrt", "log"):
        _need(x > 0)
    if name == "tan":
        _need(0 not in iv.cos(x))
    return getattr(iv, name)(x)


def _need(clear: Any) -> None:
    if not clear:  # an interval that cannot decide says None
        raise _UnclearError
