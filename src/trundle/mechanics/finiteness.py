"""Whether a formula in the time is finite throughout a run, decided by interval arithmetic and not by looking.

Where the bounds of a formula over an interval are finite, so is the formula all over it. Where they are not, the
interval is halved, from its beginning on, until either they are or the instant is found [moore1966].
"""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from functools import lru_cache
from typing import Any

from ..errors import InvalidValueError
from .algebra import Vector
from .expressions import Expression
from .records import remembered

_MOST_LOOKS = 4000
_FINEST = 1e-12  # of the run: an instant is found to this
_LARGEST = 1e300
_NEAR = 1e-5  # of an instant


class _UnclearError(Exception):
    """The bounds over an interval do not say that a formula and its slopes are finite there."""


@lru_cache(maxsize=100)  # a scenario is checked when it is read, and before it is run
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
    for place, formula in _formulas(thing):
        near = (start - _NEAR * abs(start), end + _NEAR * abs(end))
        if (instant := first_singular(formula, *near)) is not None:
            remedy = f"It is not at t = {instant + 0.0:.9g} s."
            if not start <= instant <= end:
                remedy += " Begin later than that." if instant < start else " End the run sooner before that."
            rule = "must be finite, with its slopes, throughout the run"
            raise InvalidValueError((key + place).removeprefix("."), rule, formula.text, remedy)


def _formulas(thing: Any) -> tuple[tuple[str, Expression], ...]:
    """Return the formulas in t of a system, or of a part of it, each with its place in that."""
    if isinstance(thing, Expression):
        return (("", thing),) if thing.variables <= {"t"} else ()
    if isinstance(thing, (tuple, Vector)):
        return tuple((f"[{i}]{place}", found) for i, part in enumerate(thing) for place, found in _formulas(part))
    return _formulas_of_part(thing) if is_dataclass(thing) and not isinstance(thing, type) else ()


@remembered
def _formulas_of_part(part: Any) -> tuple[tuple[str, Expression], ...]:
    places = ((f".{field.name}", getattr(part, field.name)) for field in fields(part))
    return tuple((place + further, found) for place, value in places for further, found in _formulas(value))


def varies(thing: Any) -> bool:
    """Tell whether a system has a formula in the time.

    Examples
    --------
    >>> from trundle.mechanics.motions import Spin, SpinBy
    >>> varies(SpinBy("1/(t - 3)")), varies(Spin(1.0))
    (True, False)
    """
    return bool(_formulas(thing))


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
