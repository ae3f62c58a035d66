"""How the routines of each backend become functions that can be called, and a text that can be kept."""

from __future__ import annotations

import ctypes
import tempfile
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import OutOfDomainError
from ..extras import need
from .compiler import compiler, shared_library
from .printers import c, javascript, python, symbolic
from .routines import Routine

Function = Callable[..., Any]


class Backend:
    """One backend: what it makes of a routine, and the text of many."""

    ending = ""  # of a file of its language
    phases = True  # whether it has more than the phase that is asked for

    def function(self, routine: Routine) -> Function:
        """Return a function of the arguments of a routine."""
        raise NotImplementedError

    def source(self, routines: Sequence[Routine], name: str, said: str) -> str:
        """Return the text of some routines."""
        raise NotImplementedError


class Numpy(Backend):
    """Floats, or arrays whose last axis holds the numbers."""

    ending = ".py"

    def function(self, routine: Routine) -> Function:
        """Return a function that works with floats where y has one axis, else with arrays."""
        plain, arrays = _alone(python.PRELUDE, python.function(routine), routine, None), list[Function]()

        def found(t: Any, y: Any, *others: Any) -> Any:
            y = np.asarray(y, dtype=float)
            given = [np.asarray(other, dtype=float) for other in others]
            if np.ndim(t) == 0 and all(each.ndim == 1 for each in (y, *given)):
                return plain(float(t), y.tolist(), *(each.tolist() for each in given))
            if not arrays:
                arrays.append(_alone(python.ARRAY_PRELUDE, python.array_function(routine, "np"), routine, "np"))
            return arrays[0](t, y, *given)

        found.__doc__ = routine.said
        return found

    def source(self, routines: Sequence[Routine], name: str, said: str) -> str:  # noqa: ARG002
        """Return a module of NumPy and the standard library."""
        return python.module(routines, f'"""{said}"""')


class Numba(Numpy):
    """The same on floats, compiled when first called."""

    def function(self, routine: Routine) -> Function:
        """Return a function compiled by numba, that other compiled functions may call."""
        need("numba", 'vector_field("numba")', 'vector_field("numpy") does without it.')
        import numba

        jit = numba.njit(error_model="numpy")
        around = {name: _compiled(text, name) for name, text in python.loops(routine).items()}
        return jit(_made(python.PRELUDE, python.function(routine), routine.name, tuple(around.items())))


class Jax(Backend):
    """JAX: for jit, vmap, grad and jacfwd, in the precision of what it is given."""

    ending = ".py"

    def function(self, routine: Routine) -> Function:
        """Return a function of arrays."""
        need("jax", 'vector_field("jax")', 'vector_field("numpy") does without it.')
        return _alone(python.JAX_PRELUDE, python.array_function(routine, "jnp"), routine, "jnp")

    def source(self, routines: Sequence[Routine], name: str, said: str) -> str:  # noqa: ARG002
        """Return a module of JAX."""
        return python.jax_module(routines, f'"""{said}"""')


class C(Backend):
    """C, compiled where there is a compiler."""

    ending = ".c"

    def function(self, routine: Routine) -> Function:
        """Compile one function, to be called with NumPy's arrays."""
        command = compiler()
        if command is None:
            raise OutOfDomainError(
                "No C compiler is found here (CC, cc, gcc, clang), so that the C cannot be called from Python; its "
                "text is `source`, and compiles elsewhere."
            )
        with tempfile.TemporaryDirectory(prefix="trundle-", ignore_cleanup_errors=True) as folder:
            text, library = Path(folder) / "field.c", Path(folder) / "field.so"
            text.write_text(c.source([routine], "field", routine.said), encoding="utf-8")
            shared_library(command, [text], library)
            compiled = getattr(ctypes.CDLL(str(library)), f"field_{routine.name}")  # stays when its file goes
        sizes = [size for _, size in routine.arguments]

        def found(*given: Any) -> Any:
            kept = [_numbers(each, size) for each, size in zip(given, sizes, strict=True)]
            result = np.empty(len(routine.outputs))
            compiled(
                *(each if isinstance(each, ctypes.c_double) else _pointer(each) for each in kept), _pointer(result)
            )
            return result

        found.__doc__ = routine.said
        return found

    def source(self, routines: Sequence[Routine], name: str, said: str) -> str:
        """Return one file of C."""
        return c.source(routines, name, said)


class JavaScript(Backend):
    """JavaScript, which runs elsewhere."""

    ending = ".mjs"

    def function(self, routine: Routine) -> Function:
        """Say that it is to be run elsewhere."""
        raise OutOfDomainError(
            f"`{routine.name}` in JavaScript cannot be called from Python: its text is `source`, an ES module. "
            'vector_field("numpy") has the same numbers.'
        )

    def source(self, routines: Sequence[Routine], name: str, said: str) -> str:  # noqa: ARG002
        """Return one ES module."""
        return javascript.module(routines, said)


class Sympy(Backend):
    """SymPy's expressions, of any symbols or numbers."""

    ending = ".tex"
    phases = False

    def function(self, routine: Routine) -> Function:
        """Return a function of expressions."""

        def found(*given: Any) -> list[Any]:
            values = [
                part for each, (_, size) in zip(given, routine.arguments, strict=True) for part in _each(each, size)
            ]
            return symbolic.expressions(routine, values)

        found.__doc__ = routine.said
        return found


BACKENDS: dict[str, Backend] = {
    "numpy": Numpy(),
    "numba": Numba(),
    "jax": Jax(),
    "sympy": Sympy(),
    "c": C(),
    "javascript": JavaScript(),
}


def _each(given: Any, size: int | None) -> list[Any]:
    return [given] if size is None else list(given)


@cache
def _made(prelude: str, text: str, name: str, around: tuple[tuple[str, Function], ...] = ()) -> Function:
    """Run a printed function, among others that it calls."""
    place: dict[str, Any] = dict(around)
    exec(f"{prelude}\n\n{text}", place)  # noqa: S102  operators, numbers and names that the printers write
    return place[name]


def _alone(prelude: str, text: str, routine: Routine, module: str | None) -> Function:
    """Run a printed function of Python's, with its loops."""
    around = {name: _made(prelude, loop, name) for name, loop in python.loops(routine, module).items()}
    return _made(prelude, text, routine.name, tuple(around.items()))


@cache
def _compiled(text: str, name: str) -> Function:
    """Compile a loop, once for all functions that call it."""
    import numba

    return numba.njit(error_model="numpy")(_made(python.PRELUDE, text, name))


def _numbers(given: Any, size: int | None) -> Any:
    return ctypes.c_double(given) if size is None else np.ascontiguousarray(given, dtype=float)


def _pointer(array: Any) -> Any:
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
