"""A phase whose motion a closed form knows: a page evaluates that, and follows the orientation only."""

from __future__ import annotations

from ..errors import OutOfDomainError
from ..fields.motion_formula import MotionFormula
from ..fields.routines import PhaseRoutines, Routine, phases_of
from ..mechanics.algebra import Quaternion
from ..mechanics.contact import contact_at
from ..mechanics.parameters import numbers, with_numbers
from ..mechanics.system import RollingSystem, State
from ..solve.exact import ClosedForm, closed_form
from ..solve.laws import CONTACT

_ORIENTATION = CONTACT[3:7]


class FormulaRoutines(PhaseRoutines):
    """The routines of a phase that begins a motion, by its closed form: y is the orientation, p ends with its numbers.

    Parameters
    ----------
    system : RollingSystem
        As for `PhaseRoutines`.
    phase : str
        One of `phases_of`.
    form : ClosedForm
        That has the motion.
    begin : float
        When it begins, s.
    """

    def __init__(self, system: RollingSystem, phase: str, form: ClosedForm, begin: float) -> None:
        size = len(numbers(system))
        q, p, _ = self._begin(system, phase, _ORIENTATION, size + len(numbers(form)), 0)
        self.name, self.system = f"{phase}_by_formula", with_numbers(system, p[:size])
        self._form = with_numbers(form, p[size:])
        centre, _, Omega, _ = self._form.motion_at(self._time - begin)
        contact = contact_at(self.system, self._time, centre, Quaternion(*q))
        self._state = [*(centre + contact.offset), *q, *Omega]

    def rates(self) -> Routine:
        """Return how the orientation changes."""
        _, q, Omega, _, _ = self.law.split(self._state)
        return self._routine("rates", "Rates of the orientation.", q.rate(Omega))

    def promised(self, said: str) -> Routine | None:
        """Return the number of a sentence of the closed form's findings; None where only numbers tell it."""
        found = self._form.promised(said)
        return None if found is None else self._routine("promised", "What theory says of what is seen.", [found])


def formula_of(system: RollingSystem, start: State, phase: str) -> ClosedForm:
    """Return the closed form by which a page can have a phase.

    Raises
    ------
    OutOfDomainError
        If there is none, or it cannot be written out.
    """
    form = closed_form(system, start)
    law = phases_of(system)[phase]
    if form is None or law.code not in form.phases or len(law.names(system)) != len(CONTACT):
        raise OutOfDomainError("No closed form has this motion")
    _ = MotionFormula(form).motion
    return form


__all__ = ["FormulaRoutines", "formula_of"]
