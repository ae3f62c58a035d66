"""JavaScript: one ES module, of plain numbers and arrays."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ...solve.tape import Dialect, WrittenLoop
from ..routines import Routine

_FUNCTIONS = {name: f"Math.{name}" for name in ("sqrt", "sin", "cos", "tan", "exp", "expm1", "log", "abs", "atan2")}


def _dialect(variable: object) -> Dialect:
    return Dialect(variable, _FUNCTIONS, "({} ? {} : {})")  # type: ignore[arg-type]


def function(routine: Routine) -> str:
    """Print a function that returns an array.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.fields.routines import PhaseRoutines
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> print(function(PhaseRoutines(level, "rolling", ()).rates()).splitlines()[1])
    export function rolling_rates(t, y, p, u) {
    """
    lines, results = routine.written(_dialect, "{}[{}]")
    steps = [f"  {part}" for line in lines for part in _step(line)]
    head = f"export function {routine.name}({', '.join(name for name, _ in routine.arguments)}) {{"
    return "\n".join([f"/** {routine.said} */", head, *steps, f"  return [{', '.join(results)}];", "}"]) + "\n"


def _step(line: Any) -> list[str]:
    """Print a step, or a loop."""
    if not isinstance(line, WrittenLoop):
        return [f"const {line[0]} = {line[1]};"]
    begin = [f"let {name} = {text};" for name, text in zip(line.changing, line.start, strict=True)]
    begin += [f"const {name} = {text};" for name, text in zip(line.staying, line.given, strict=True)]
    steps = [part for each in line.lines for part in _step(each)]
    goes_on = f"[{', '.join(line.changing)}] = [{', '.join(line.results)}];"
    end = f"[{', '.join(line.targets)}] = [{', '.join(line.changing)}];"
    block = [*begin, f"while ({line.changing[0]} > 0) {{", *(f"  {each}" for each in (*steps, goes_on)), "}", end]
    return [f"let {', '.join(line.targets)};", "{", *(f"  {each}" for each in block), "}"]


def module(routines: Iterable[Routine], said: str) -> str:
    """Print an ES module."""
    return "\n".join([f"/*\n{said}\n*/\n", *map(function, routines)])
