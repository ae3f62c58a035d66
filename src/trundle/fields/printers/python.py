"""Python: on plain numbers, for the interpreter and for numba; and on arrays, for NumPy and JAX."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from ...solve.tape import Dialect
from ..routines import Routine

_MATH = ("sqrt", "sin", "cos", "tan", "exp", "expm1", "log", "atan2")
_PLAIN = partial(Dialect, functions={name: f"math.{name}" for name in _MATH}, choice="({1} if {0} else {2})")
_ARRAYS = {name: f"{{0}}.{name}" for name in (*_MATH[1:-1], "abs", "where")}

PRELUDE = "import math\n\nimport numpy as np\n"

# Where the branch that is not taken has no slope, its NaN would stay: so what has none is never worked out.
JAX_PRELUDE = '''\
import jax.numpy as jnp


def _sqrt(x):
    """Return √x; its slope at 0 is taken as 0, as that of the length of a vector that vanishes."""
    return jnp.where(x == 0, 0.0 * x, jnp.sqrt(jnp.where(x == 0, 1.0, x)))


def _atan2(y, x):
    """Return the angle of the point (x, y); its slope at the origin is taken as 0."""
    nowhere = (x == 0) & (y == 0)
    return jnp.where(nowhere, 0.0, jnp.arctan2(y, jnp.where(nowhere, 1.0, x)))
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
    lines, results = routine.written(lambda variable: _PLAIN(variable), "{}[{}]")
    body = [f"{name} = {text}" for name, text in lines]
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
    names = {"sqrt": "_sqrt", "atan2": "_atan2"} if module == "jnp" else {"sqrt": "np.sqrt", "atan2": "np.arctan2"}
    names |= {name: text.format(module) for name, text in _ARRAYS.items()}
    choice = f"{module}.where({{}}, {{}}, {{}})"
    lines, results = routine.written(lambda variable: Dialect(variable, names, choice), "{}[..., {}]")
    body = [f"{name} = {text}" for name, text in lines]
    joined = ", ".join(results) + ("," if len(results) == 1 else "")
    return _function(routine, [*body, f"return {module}.stack({module}.broadcast_arrays({joined}), axis=-1)"])


def _function(routine: Routine, body: list[str]) -> str:
    arguments = ", ".join(name for name, _ in routine.arguments)
    said = f'"""{routine.said}"""'
    return "\n".join([f"def {routine.name}({arguments}):", *(f"    {line}" for line in (said, *body))]) + "\n"


def module(routines: Iterable[Routine], said: str) -> str:
    """Print a module of NumPy and the standard library that numba compiles as it is."""
    return "\n\n".join([f"{said}\n\n{PRELUDE}", *map(function, routines)])


def jax_module(routines: Iterable[Routine], said: str) -> str:
    """Print a module of JAX."""
    return "\n\n".join([f"{said}\n\n{JAX_PRELUDE}", *(array_function(each, "jnp") for each in routines)])
