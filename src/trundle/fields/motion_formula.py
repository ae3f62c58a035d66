"""A closed form as a function of the time and of its numbers, for other programs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..errors import OutOfDomainError, UnknownNameError
from ..mechanics.parameters import numbers, parameters, with_numbers
from ..solve.exact import ClosedForm
from ..solve.tape import Tape
from ..units import UNITS
from .backends import BACKENDS, Backend, Function
from .printers import c
from .routines import Routine, plain
from .telling import table

_OUTPUTS = {"position": "m", "velocity": "m/s", "angular_velocity": "rad/s", "contact_force": "N"}


@dataclass(frozen=True)
class MotionFormula:
    """A motion that a closed form knows, as a function of the time and of every number in it.

    Parameters
    ----------
    form : ClosedForm
        Such as `run.closed_form`.
    backend : str
        "numpy", "numba", "jax", "sympy", "c" or "javascript".

    Raises
    ------
    OutOfDomainError
        If the formula decides by the values of its numbers, and cannot be written out for all.

    Examples
    --------
    A ball put down on a turntable at rest stays there:

    >>> from trundle.solve.exact import SphereOnPlane
    >>> still = MotionFormula(SphereOnPlane(0.025, 0.065, 0.4, 3.5, (0.1, 0.2)))
    >>> still.motion(5.0, still.parameters)[:3].tolist()
    [0.1, 0.2, 0.025]
    """

    form: ClosedForm
    backend: str = "numpy"

    def __post_init__(self) -> None:
        if self.backend not in BACKENDS:
            raise UnknownNameError("backend", str(self.backend), BACKENDS)
        _ = self._routine

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """The names of the numbers of p."""
        return tuple(name for name, _ in parameters(self.form))

    @property
    def parameter_units(self) -> tuple[str, ...]:
        """Their units."""
        return tuple(UNITS[dimension][0] for _, dimension in parameters(self.form))

    @property
    def parameters(self) -> Any:
        """P of the closed form, an array."""
        return np.array(numbers(self.form))

    @property
    def output_names(self) -> tuple[str, ...]:
        """The names of what `motion` returns."""
        return tuple(f"{name}_{axis}" for name in _OUTPUTS for axis in "xyz")

    @property
    def output_units(self) -> tuple[str, ...]:
        """Their units."""
        return tuple(unit for unit in _OUTPUTS.values() for _ in "xyz")

    @cached_property
    def motion(self) -> Function:
        """F(t, p): place and velocity of the centre, Ω and contact force, t s after the start."""
        return self._backend.function(self._routine)

    def source(self, name: str = "formula") -> str:
        """Return the text of the function.

        Parameters
        ----------
        name : str
            With which the function begins in C.

        Returns
        -------
        str
            In the language of the backend.

        Examples
        --------
        >>> from trundle.solve.exact import SphereOnPlane
        >>> form = SphereOnPlane(0.025, 0.065, 0.4, 3.5, (0.1, 0.2))
        >>> "export function motion(t, p)" in MotionFormula(form, "javascript").source()
        True
        """
        return self._backend.source([self._routine], name, self._said())

    def header(self, name: str = "formula") -> str:
        """Return the header that declares the function of C.

        Parameters
        ----------
        name : str
            As of `source`.

        Returns
        -------
        str
            C.

        Examples
        --------
        >>> from trundle.solve.exact import SphereOnPlane
        >>> form = SphereOnPlane(0.025, 0.065, 0.4, 3.5, (0.1, 0.2))
        >>> "void ball_motion(double t, const double *p, double *found);" in MotionFormula(form, "c").header("ball")
        True
        """
        return c.header([self._routine], name, self._said())

    @cached_property
    def _routine(self) -> Routine:
        tape, size = Tape(), len(numbers(self.form))
        t, *p = tape.inputs(1 + size)
        try:
            found = with_numbers(self.form, p).motion_at(t)
            self._check(tape, found)
        except (AttributeError, TypeError, ValueError) as error:
            raise OutOfDomainError(
                f"The closed form {self.form.equation} decides by the values of its numbers and cannot be written out "
                f"for all of them ({error}). `vector_field` has the equations of motion."
            ) from None
        said = "Place and velocity of the centre, angular velocity and contact force, at a time after the start."
        outputs = tuple(plain(part) for vector in found for part in vector)
        return Routine("motion", said, (("t", None), ("p", size)), outputs, tape)

    def _check(self, tape: Tape, found: Any) -> None:
        """Refuse what a comparison for equality, which a tape does not see, has made another motion."""
        t = 0.37
        traced = tape.function([part for vector in found for part in vector])([t, *numbers(self.form)])
        known = [float(part) for vector in self.form.motion_at(t) for part in vector]
        if not np.allclose(traced, known, rtol=1e-9, atol=1e-12, equal_nan=True):
            raise TypeError("it is another motion when traced")

    def _said(self) -> str:
        lines = [
            f"The closed form {self.form.equation}, as trundle wrote it. All numbers are in SI.",
            "",
            "t: time (s)",
        ]
        lines += table("p", self.parameter_names, self.parameter_units, self.parameters)
        return "\n".join([*lines, *table("motion", self.output_names, self.output_units)])

    @property
    def _backend(self) -> Backend:
        return BACKENDS[self.backend]
