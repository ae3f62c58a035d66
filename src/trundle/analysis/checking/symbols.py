"""Equations of motion as SymPy expressions, made into a function of the state."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ...errors import InvalidValueError, UnknownNameError

STATE = ("t", "x", "y", "z", "vx", "vy", "vz", "qw", "qx", "qy", "qz", "wx", "wy", "wz")
_FLAT = (2, 3, 6)


def callable_of(equations: Any, values: Mapping[Any, float]) -> Callable[..., Any]:
    """Return equations as a function of t, r, V, q, Ω.

    Examples
    --------
    >>> import sympy
    >>> vx, k = sympy.symbols("vx k")
    >>> callable_of([-k * vx, 0], {"k": 2.0})(0.0, [0, 0, 0], [3.0, 0, 0], [1, 0, 0, 0], [0, 0, 0])
    [-6.0, 0.0]
    """
    if callable(equations) and not hasattr(equations, "free_symbols"):
        return equations
    import sympy

    expressions = _row(equations)
    given = {str(name): value for name, value in values.items()}
    symbols = sorted(set().union(*(e.free_symbols for e in expressions)), key=str)
    unknown = [str(symbol) for symbol in symbols if str(symbol) not in (*STATE, *given)]
    if unknown:
        raise UnknownNameError("symbol (give it in `values`)", unknown[0], [*STATE, *given])
    # By name: a symbol may carry assumptions, which make another symbol of it.
    fixed = {symbol: given[str(symbol)] for symbol in symbols if str(symbol) in given}
    state = {symbol: sympy.Symbol(str(symbol)) for symbol in symbols if str(symbol) not in given}
    plain = [e.subs(fixed).subs(state) for e in expressions]
    function = sympy.lambdify([sympy.Symbol(name) for name in STATE], plain, modules="math")

    def evaluated(t: float, r: Any, V: Any, q: Any, Omega: Any) -> list[float]:
        return [float(part) for part in function(t, *r, *V, *q, *Omega)]

    return evaluated


def _row(equations: Any) -> Sequence[Any]:
    import sympy

    try:
        if isinstance(equations, Mapping):
            equations = list(equations.values())
        parts = [part for entry in equations for part in (entry if hasattr(entry, "__iter__") else [entry])]
        expressions = [sympy.sympify(part) for part in parts]
    except (TypeError, sympy.SympifyError):
        raise InvalidValueError(
            "equations", "must be a callable of t, r, V, q, Ω, or SymPy expressions", equations
        ) from None
    if len(expressions) not in _FLAT:
        raise InvalidValueError("equations", "must be 2, 3 or 6 expressions: V̇, or V̇ and Ω̇", len(expressions))
    return expressions
