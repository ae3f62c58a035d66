"""A closed form as a function of the time and of its numbers, for other programs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..errors import OutOfDomainError
from ..mechanics.parameters import numbers, with_numbers
from ..mechanics.system import State
from ..solve.exact import ClosedForm
from ..solve.tape import Tape
from .backends import Function
from .printed import Listed, Printed
from .routines import Routine, plain

_QUANTITIES = {"position": "m", "velocity": "m/s", "angular_velocity": "rad/s", "contact_force": "N"}


@dataclass(frozen=True, repr=False)
class MotionFormula(Printed):
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
    _outputs = tuple((f"{name}_{axis}", unit) for name, unit in _QUANTITIES.items() for axis in "xyz")

    def __post_init__(self) -> None:
        self._check_backend()
        _ = self._routine

    @cached_property
    def motion(self) -> Function:
        """F(t, p): place and velocity of the centre, Ω and contact force, t s after the start."""
        return self._language.function(self._routine)

    def routines(self) -> list[Routine]:
        """Return the one function.

        Returns
        -------
        list of Routine
            Of one.
        """
        return [self._routine]

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

    @property
    def _numbered(self) -> Any:
        return self.form

    @property
    def _title(self) -> str:
        return f"The closed form {self.form.equation}"

    def _listed(self, start: State | None = None) -> Iterator[Listed]:  # noqa: ARG002  its start is in its numbers
        yield "p", self.parameter_names, self.parameter_units, self.parameters
        yield "outputs", self.output_names, self.output_units, None
