"""The unit of a formula, from the units of its variables: what cannot be added is refused before anything runs."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from ...errors import InvalidValueError

Dimension = tuple[Fraction, Fraction, Fraction]  # powers of m, kg and s; an angle has none

_NONE = (Fraction(0),) * 3
# What a variable may be measured in: its powers of m, kg and s.
_POWERS = {
    "": (0, 0, 0),
    "rad": (0, 0, 0),
    "s": (0, 0, 1),
    "m": (1, 0, 0),
    "m s-1": (1, 0, -1),
    "rad s-1": (0, 0, -1),
    "N": (1, 1, -2),
    "J": (2, 1, -2),
}
_NAMES = {tuple(map(Fraction, powers)): unit for unit, powers in _POWERS.items() if "rad" not in unit}
_FREE = ("sin", "cos", "tan", "exp", "log")  # these take what has no dimension


def unit_of(tree: Any, units: dict[str, str], key: str, text: str) -> str:
    """Return the SI unit of a formula.

    A bare number takes the dimension of what it is added to.

    Examples
    --------
    >>> unit_of(("-", ("hypot", "x", "y"), 0.3), {"x": "m", "y": "m"}, "far", "hypot(x, y) - 0.3")
    'm'
    >>> unit_of(("+", "x", "t"), {"x": "m", "t": "s"}, "far", "x + t")
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `far` must add like to like; got 'x + t'. Here m and s come together.
    """
    if isinstance(tree, str):
        return units[tree]
    try:
        found = _dimension(tree, units)
    except _UnlikeError as error:
        raise InvalidValueError(key, "must add like to like", text, str(error)) from None
    return "" if found is None else _said(found)


class _UnlikeError(Exception):
    """Two dimensions that do not go together."""


def _said(dimension: Dimension) -> str:
    if dimension in _NAMES:
        return _NAMES[dimension]
    powers = zip(("kg", "m", "s"), (dimension[1], dimension[0], dimension[2]), strict=True)
    return " ".join(f"{unit}{'' if power == 1 else power}" for unit, power in powers if power)


def _dimension(tree: Any, units: dict[str, str]) -> Dimension | None:
    """Return the dimension; None of a bare number, which may stand for any."""
    if isinstance(tree, str):
        return tuple(map(Fraction, _POWERS[units[tree]]))  # type: ignore[return-value]
    if not isinstance(tree, tuple):
        return None
    operator, *rest = tree
    if operator == "**":
        base = _dimension(rest[0], units)
        return None if base is None else _combined(base, base, Fraction(int(rest[1])), Fraction(0))
    parts = [_dimension(part, units) for part in rest]
    if operator in _FREE:
        if parts[0] not in (None, _NONE):
            raise _UnlikeError(f"{operator} takes what has no unit, and {_said(parts[0])} has one.")
        return _NONE
    if operator in ("neg", "abs"):
        return parts[0]
    if operator == "sqrt":
        return None if parts[0] is None else _combined(parts[0], _NONE, Fraction(1, 2), Fraction(0))
    if operator in ("*", "/"):
        if parts == [None, None]:
            return None
        return _combined(parts[0] or _NONE, parts[1] or _NONE, Fraction(1), Fraction(1 if operator == "*" else -1))
    first, second = parts
    if first is not None and second is not None and first != second:
        raise _UnlikeError(f"Here {_said(first) or 'no unit'} and {_said(second) or 'no unit'} come together.")
    return second if first is None else first


def _combined(one: Dimension, other: Dimension, power: Fraction, times: Fraction) -> Dimension:
    return tuple(a * power + b * times for a, b in zip(one, other, strict=True))  # type: ignore[return-value]
