"""SymPy, and by it LaTeX: the equations as one reads them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...mechanics.scalars import namespace
from ...solve.tape import Node
from ..routines import Routine


def expressions(routine: Routine, values: Sequence[Any]) -> list[Any]:
    """Return the outputs of a routine as SymPy expressions of the values of its inputs.

    Examples
    --------
    >>> import sympy
    >>> import trundle as tr
    >>> from trundle.fields.routines import PhaseRoutines
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> rates = PhaseRoutines(level, "rolling", ()).rates()
    >>> expressions(rates, sympy.symbols(f"x:{len(rates.names)}", real=True))[2]
    0
    """
    import sympy

    made: dict[int, Any] = {}
    xp = namespace(sympy.Symbol("x"))

    def operand(part: Any) -> Any:
        return made[part.index] if isinstance(part, Node) else exactly(part)

    for index in routine.tape.needed(routine.outputs):
        operation, *operands = routine.tape.steps[index]
        if operation == "input":
            made[index] = values[operands[0]]
        else:
            made[index] = _SYMPY.get(operation, lambda xp, *parts, name=operation: getattr(xp, name)(*parts))(
                xp, *map(operand, operands)
            )
    return [operand(part) for part in routine.outputs]


_SYMPY: dict[str, Any] = {
    "+": lambda _, a, b: a + b,
    "-": lambda _, a, b: a - b,
    "*": lambda _, a, b: a * b,
    "/": lambda _, a, b: a / b,
    "neg": lambda _, a: -a,
    "<": lambda _, a, b: a < b,
    ">": lambda _, a, b: a > b,
}


def exactly(number: float) -> Any:
    """Return a number as a formula has it: 1/2 and 2, not 0.5 and 2.0.

    Examples
    --------
    >>> exactly(0.5), exactly(-2.0)
    (1/2, -2)
    """
    import sympy

    near = sympy.Rational(number).limit_denominator(1000)
    return near if float(near) == number else sympy.Float(number)
