"""C99: one file that needs the mathematics library and nothing else, and a header."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ...solve.tape import Dialect, WrittenLoop
from ..routines import Routine

FLAGS = ("-std=c99", "-O2", "-ffp-contract=off")  # a fused product and sum would round once, not twice


def _dialect(variable: object) -> Dialect:
    return Dialect(variable, {"abs": "fabs"}, "({} ? {} : {})")  # type: ignore[arg-type]


def declaration(routine: Routine, prefix: str) -> str:
    """Print the head of a function.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.fields.routines import PhaseRoutines
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> declaration(PhaseRoutines(level, "rolling", ()).rates(), "ball")
    'void ball_rolling_rates(double t, const double *y, const double *p, const double *u, double *found)'
    """
    given = [f"double {name}" if size is None else f"const double *{name}" for name, size in routine.arguments]
    return f"void {prefix}_{routine.name}({', '.join([*given, 'double *found'])})"


def function(routine: Routine, prefix: str) -> str:
    """Print a function that fills `found`."""
    lines, results = routine.written(_dialect, "{}[{}]")
    unused = [f"(void){name};" for name, _ in routine.arguments]
    steps = [part for line in lines for part in _step(line)]
    filled = [f"found[{i}] = {text};" for i, text in enumerate(results)]
    body = "\n".join(f"    {line}" for line in (*unused, *steps, *filled))
    return f"{declaration(routine, prefix)}\n{{\n{body}\n}}\n"


def _step(line: Any) -> list[str]:
    """Print a step, or a loop."""
    if not isinstance(line, WrittenLoop):
        return [f"const double {line[0]} = {line[1]};"]
    outside = [f"double {name};" for name in line.targets]
    begin = [f"double {name} = {text};" for name, text in zip(line.changing, line.start, strict=True)]
    begin += [f"const double {name} = {text};" for name, text in zip(line.staying, line.given, strict=True)]
    steps = [part for each in line.lines for part in _step(each)]
    after = [f"const double next_{name} = {text};" for name, text in zip(line.changing, line.results, strict=True)]
    goes_on = [f"{name} = next_{name};" for name in line.changing]
    inside = [f"    {each}" for each in (*steps, *after, *goes_on)]
    end = [f"{target} = {name};" for target, name in zip(line.targets, line.changing, strict=True)]
    end += [f"(void){target};" for target in line.targets]  # of which some may not be wanted
    block = [*begin, f"while ({line.changing[0]} > 0.0) {{", *inside, "}", *end]
    return [*outside, "{", *(f"    {each}" for each in block), "}"]


def header(routines: Iterable[Routine], prefix: str, said: str) -> str:
    """Print the declarations."""
    guard = f"{prefix.upper()}_H"
    told = [f"/* {each.said} */\n{declaration(each, prefix)};" for each in routines]
    start, end = '#ifdef __cplusplus\nextern "C" {\n#endif', "#ifdef __cplusplus\n}\n#endif"
    return "\n\n".join([f"/*\n{said}\n*/\n#ifndef {guard}\n#define {guard}", start, *told, end, "#endif"]) + "\n"


def source(routines: Iterable[Routine], prefix: str, said: str) -> str:
    """Print the functions, for a compiler that does not contract them: the flags are in `FLAGS`."""
    return "\n".join([f"/*\n{said}\n*/\n#include <math.h>\n", *(function(each, prefix) for each in routines)])
