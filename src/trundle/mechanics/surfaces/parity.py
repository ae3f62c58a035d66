"""Even formulas in r, rearranged as formulas in r², which are smooth at the axis."""

from __future__ import annotations

from typing import Any

_ONE = ("**", "r2", "0")


class _NeitherError(Exception):
    """A formula is neither even nor odd as it is written."""


def in_square(tree: Any) -> Any:
    """Return a formula in r as one in r2 = r², where it is even as it is written.

    Examples
    --------
    >>> in_square(("+", ("**", "r", "2"), ("*", 0.5, ("**", "r", "4"))))
    ('+', 'r2', ('*', 0.5, ('**', 'r2', '2')))
    >>> in_square(("cos", "r"))
    """
    try:
        odd, rest = _parted(tree)
    except _NeitherError:
        return None
    return None if odd else rest


def is_even(tree: Any) -> bool:
    """Tell whether a formula in r is even, f(−r) = f(r), also where it cannot be written in r².

    Examples
    --------
    >>> is_even(("cos", "r")), is_even(("*", "r", ("sin", "r"))), is_even(("sin", "r"))
    (True, True, False)
    """
    try:
        return not _odd(tree)
    except _NeitherError:
        return False


def _odd(tree: Any) -> bool:
    if not isinstance(tree, tuple):
        return bool(tree == "r")
    operator, *rest = tree
    if operator == "**":
        return _odd(rest[0]) and int(rest[1]) % 2 == 1
    odds = [_odd(part) for part in rest]
    if operator in ("*", "/"):
        return odds[0] != odds[1]
    if operator in ("cos", "abs", "hypot"):
        return False
    if len(set(odds)) > 1 or (odds[0] and operator not in ("neg", "+", "-", "sin", "tan")):
        raise _NeitherError
    return odds[0]


def _parted(tree: Any) -> tuple[bool, Any]:
    """Return whether a formula is odd, and g with f = g(r²), or f = r g(r²) where it is."""
    if not isinstance(tree, tuple):
        return (True, _ONE) if tree == "r" else (False, tree)
    operator, *rest = tree
    odds, parts = zip(*(_parted(part) for part in (rest[:1] if operator == "**" else rest)), strict=True)
    if operator == "**":
        return _power(odds[0], parts[0], int(rest[1]))
    if operator in ("*", "/"):
        return _product(operator, odds, parts)
    if operator == "hypot":
        squares = [_power(odd, part, 2)[1] for odd, part in zip(odds, parts, strict=True)]
        return False, ("sqrt", ("+", *squares))
    if operator in ("neg", "+", "-", "abs") and len(set(odds)) == 1:
        return odds[0], (operator, *parts)
    if any(odds):
        raise _NeitherError
    return False, (operator, *parts)


def _power(odd: bool, part: Any, power: int) -> tuple[bool, Any]:
    if not odd:
        return False, ("**", part, str(power))
    square = ("**", "r2", str(power // 2)) if power // 2 != 1 else "r2"
    return bool(power % 2), _times(square, part if part == _ONE else ("**", part, str(power)))


def _product(operator: str, odds: tuple[bool, ...], parts: tuple[Any, ...]) -> tuple[bool, Any]:
    (first, second), (a, b) = odds, parts
    if operator == "/":
        return first != second, ("/", a, _times("r2", b)) if second and not first else ("/", a, b)
    both = _times(a, b)
    return first != second, _times("r2", both) if first and second else both


def _times(a: Any, b: Any) -> Any:
    if a == _ONE:
        return b
    return a if b == _ONE else ("*", a, b)
