"""Where a formula is not smooth, or ends: how far that is, and what passes through zero there."""

from __future__ import annotations

from typing import Any

from .expressions import Expression
from .jets import Jet
from .scalars import Scalar, namespace

# Metres beyond which a seam does not matter. What is left of a seam's distance stays finite where its slope vanishes.
_FAR = 1.0
_NOTHING = 1e-300
_MOST_SQUARES = 3


def seams(tree: Any) -> list[Any]:
    """Return parts of a formula that are 0 where it is not smooth, or ends.

    Examples
    --------
    >>> seams(("*", 0.2, ("abs", "x"))), seams(("+", ("sin", "x"), ("/", "y", 2.0)))
    (['x'], [])
    """
    if not isinstance(tree, tuple):
        return []
    operator, *rest = tree
    if operator == "**":
        return [*seams(rest[0]), *([rest[0]] if int(rest[1]) < 0 else [])]
    found = [seam for part in rest for seam in seams(part)]
    if operator in ("abs", "sqrt", "log"):
        found.append(rest[0])
    elif operator == "/":
        found.append(rest[1])
    elif operator == "hypot":
        found.append(("+", *(("**", part, "2") for part in rest)))
    elif operator == "tan":
        found.append(("cos", rest[0]))
    return [seam for seam in found if isinstance(seam, (str, tuple))]


def lengths(tree: Any) -> list[tuple[Any, ...]]:
    """Return the vectors, as tuples of up to three parts of a formula, whose lengths stand in it.

    Where one passes through zero the formula has a corner. A constant under the root rounds that off, however little.

    Examples
    --------
    >>> lengths(("*", 0.2, ("abs", "x"))), lengths(("sqrt", ("+", ("*", "x", "x"), ("**", "y", "2"))))
    ([('x',)], [('x', 'y')])
    """
    if not isinstance(tree, tuple):
        return []
    operator, *rest = tree
    rest = rest[:1] if operator == "**" else rest
    found = [length for part in rest for length in lengths(part)]
    if operator in ("abs", "hypot"):
        found.append(tuple(rest))
    elif operator == "sqrt":
        squared = _squared(rest[0])
        if squared:
            found.append(tuple(squared[:_MOST_SQUARES]))
    return found


def _squared(tree: Any) -> list[Any] | None:
    """Return what is squared in a sum of squares and constants; None for anything else."""
    if not isinstance(tree, tuple):
        return None if isinstance(tree, str) else []
    operator, first, *others = tree
    if operator == "+":
        parts = [_squared(part) for part in (first, *others)]
        return None if None in parts else [one for part in parts if part is not None for one in part]
    if operator == "*":
        if first == others[0]:
            return [first]
        weighted = [part for part in (first, *others) if isinstance(part, (str, tuple))]
        return _squared(weighted[0]) if len(weighted) == 1 else None
    if operator == "/":
        return _squared(first) if not isinstance(others[0], (str, tuple)) else None
    return [first] if operator == "**" and int(others[0]) == 2 else None


def to_the_next(trees: list[Any], **values: Any) -> Scalar | None:
    """Return about how far the nearest seam is, m, at most 1 m; 0 on it.

    Examples
    --------
    >>> from trundle.mechanics.jets import jets
    >>> x, y = jets((0.03, 0.04))
    >>> round(to_the_next(seams(("abs", "x")), x=x, y=y), 4)
    0.03
    """
    product: Scalar | None = None
    for tree in trees:
        g = Expression(tree, "").at(**values)
        if not isinstance(g, Jet):
            continue
        slope, square = sum((part * part for part in g.gradient), 0.0), g.value * g.value
        share = square / (slope * _FAR**2 + square + _NOTHING)
        product = share if product is None else product * share
    return None if product is None else namespace(product).sqrt(product) * _FAR
