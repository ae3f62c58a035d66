"""Python: on plain numbers, for the interpreter and for numba; and on arrays, for NumPy and JAX."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

from ...solve.tape import Dialect, WrittenLoop
from ..routines import Routine

_MATH = ("sqrt", "sin", "cos", "tan", "exp", "expm1", "log", "atan2")
_PLAIN = partial(Dialect, functions={name: f"math.{name}" for name in _MATH}, choice="({1} if {0} else {2})")
_ARRAYS = {name: f"{{0}}.{name}" for name in (*_MATH[1:-1], "abs", "where")}

PRELUDE = "import math\n\nimport numpy as np\n"

# Of arrays each element goes round as often as it wants to.
ARRAY_PRELUDE = f'''\
{PRELUDE}

def _repeated(body, start, given):
    """Return what a body makes of some numbers, again and again while the first is above 0."""
    while np.any(start[0] > 0):
        start = [np.where(start[0] > 0, after, now) for after, now in zip(body(*start, *given), start)]
    return start
'''

# Where the branch that is not taken has no slope, its NaN would stay: so what has none is never worked out.
JAX_PRELUDE = '''\
import functools

import jax
import jax.numpy as jnp


def _sqrt(x):
    """Return √x; its slope at 0 is taken as 0, as that of the length of a vector that vanishes."""
    return jnp.where(x == 0, 0.0 * x, jnp.sqrt(jnp.where(x == 0, 1.0, x)))


def _atan2(y, x):
    """Return the angle of the point (x, y); its slope at the origin is taken as 0."""
    nowhere = (x == 0) & (y == 0)
    return jnp.where(nowhere, 0.0, jnp.arctan2(y, jnp.where(nowhere, 1.0, x)))


@functools.partial(jax.jit, static_argnums=0)
def _repeated(body, start, given):
    """Return what a body makes of some numbers, again and again while the first is above 0."""

    def again(now):
        return tuple(jnp.where(now[0] > 0, a, b).astype(b.dtype) for a, b in zip(body(*now, *given), now))

    kind = jnp.result_type(*start, *given)
    start = tuple(part.astype(kind) for part in jnp.broadcast_arrays(*start, *given)[: len(start)])
    return jax.lax.while_loop(lambda now: jnp.any(now[0] > 0), again, start)
'''


def function(routine: Routine) -> str:
    """Print a function of plain numbers that returns an array; numba compiles it.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.fields.routines import PhaseRoutines
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> print(function(PhaseRoutines(level, "rolling", ()).rates()).splitlines()[0])
    def rolling_rates(t, y, p, u):
    """
    lines, results = routine.written(_dialect(None), "{}[{}]")
    body = [part for line in lines for part in _step(line, None)]
    body.append(f"found = np.empty({len(results)})")
    body += [f"found[{i}] = {text}" for i, text in enumerate(results)]
    return _function(routine, [*body, "return found"])


def array_function(routine: Routine, module: str) -> str:
    """Print a function of arrays whose last axis holds the numbers, for NumPy ("np") or JAX ("jnp").

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.fields.routines import PhaseRoutines
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> print(array_function(PhaseRoutines(level, "rolling", ()).rates(), "jnp").splitlines()[-1].strip())
    return jnp.stack(jnp.broadcast_arrays(...), axis=-1)
    """
    lines, results = routine.written(_dialect(module), "{}[..., {}]")
    body = [part for line in lines for part in _step(line, module)]
    joined = ", ".join(results) + ("," if len(results) == 1 else "")
    return _function(routine, [*body, f"return {module}.stack({module}.broadcast_arrays({joined}), axis=-1)"])


def loops(routine: Routine, module: str | None = None) -> dict[str, str]:
    """Print the loops of a routine as functions, by name: of plain numbers, or one pass of arrays."""
    lines, _ = routine.written(_dialect(module), "{}[..., {}]" if module else "{}[{}]")
    return dict(_loop(line, module) for line in lines if isinstance(line, WrittenLoop))


def _loop(line: WrittenLoop, module: str | None) -> tuple[str, str]:
    """Print a loop, whose name is made from what it does."""
    steps = [part for each in line.lines for part in _step(each, module)]
    if module:
        body = [*steps, f"return {', '.join(line.results)}"]
    else:
        inside = [*steps, f"{', '.join(line.changing)} = {', '.join(line.results)}"]
        head, end = f"while {line.changing[0]} > 0.0:", f"return {', '.join(line.changing)}"
        body = [head, *(f"    {each}" for each in inside), end]
    text = "\n".join(f"    {each}" for each in body)
    name = f"loop_{hashlib.sha256(text.encode()).hexdigest()[:16]}"
    return name, f"def {name}({', '.join([*line.changing, *line.staying])}):\n{text}\n"


def _step(line: Any, module: str | None) -> list[str]:
    """Print a step, or a call of a loop."""
    if not isinstance(line, WrittenLoop):
        return [f"{line[0]} = {line[1]}"]
    name, _ = _loop(line, module)
    start, given = ", ".join(line.start), ", ".join(line.given)
    call = f"_repeated({name}, ({start},), ({given},))" if module else f"{name}({start}, {given})"
    return [f"{', '.join(line.targets)} = {call}"]


def _dialect(module: str | None) -> Callable[[Callable[[int], str]], Dialect]:
    """Return how plain numbers are written, or arrays of a module."""
    if module is None:
        return lambda variable: _PLAIN(variable)
    names = {"sqrt": "_sqrt", "atan2": "_atan2"} if module == "jnp" else {"sqrt": "np.sqrt", "atan2": "np.arctan2"}
    names |= {name: text.format(module) for name, text in _ARRAYS.items()}
    return lambda variable: Dialect(variable, names, f"{module}.where({{}}, {{}}, {{}})")


def _function(routine: Routine, body: list[str]) -> str:
    arguments = ", ".join(name for name, _ in routine.arguments)
    said = f'"""{routine.said}"""'
    return "\n".join([f"def {routine.name}({arguments}):", *(f"    {line}" for line in (said, *body))]) + "\n"


def module(routines: Iterable[Routine], said: str) -> str:
    """Print a module of NumPy and the standard library that numba compiles as it is."""
    return _joined(f"{said}\n\n{PRELUDE}", routines, None)


def jax_module(routines: Iterable[Routine], said: str) -> str:
    """Print a module of JAX."""
    return _joined(f"{said}\n\n{JAX_PRELUDE}", routines, "jnp")


def _joined(head: str, routines: Iterable[Routine], module: str | None) -> str:
    """Print what stands before some functions, their loops, and these."""
    routines = list(routines)
    around = {name: text for each in routines for name, text in loops(each, module).items()}
    texts = [function(each) if module is None else array_function(each, module) for each in routines]
    return "\n\n".join([head, *around.values(), *texts])
