"""The start of a motion as a function of the numbers on sliders: placed anew by the same placing, on a tape."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import numpy as np

from ..analysis.sensitivities.keys import Key, moved, replaced
from ..errors import OutOfDomainError, TrundleError
from ..fields.routines import STROKES, Routine, phases_of, plain, starting_phase
from ..mechanics.parameters import numbers
from ..mechanics.placing import Placing
from ..mechanics.scalars import is_number
from ..mechanics.system import RollingSystem, State
from ..scenario import ScenarioFile
from ..solve import transitions
from ..solve.contact_state import ContactState
from ..solve.exact import ClosedForm
from ..solve.tape import Tape
from .formula import formula_of
from .recorded import Recorded, step_of

_APART = 1e-12  # of a start's numbers by their size: what is placed on a tape is placed alike but for rounding


@dataclass(frozen=True)
class Placed:
    """The start of a scenario as a function of some of its numbers."""

    phase: str  # in which it begins
    routine: Routine  # (w) -> the numbers of the state and then all those of the system
    size: int  # how many are of the state
    # By which the motion begins: then the state is the orientation, and behind the system's numbers are those of it.
    form: ClosedForm | None = None

    @staticmethod
    def of(scenario: ScenarioFile, wanted: Sequence[Key], *, by_formula: bool = False) -> Placed:
        """Return the start of a scenario for any values of some numbers.

        Raises
        ------
        OutOfDomainError
            If a number on the way is wanted as such, or no closed form has the motion and one is asked for.
        """
        system, start = scenario.system(), scenario.start_state()
        phase = phase_of(system, start)
        form = formula_of(system, start, phase) if by_formula else None
        tape = Tape()
        steps = tape.inputs(len(wanted))
        recorded = {key.name: Recorded(key.value, step) for key, step in zip(wanted, steps, strict=True)}
        try:
            model = replaced(scenario, recorded)
            now = model.system()
            begin, contact = Placing(now, **model.start.arguments()).at_contact(checked=False)
            if form is None:
                state, others = phases_of(system)[phase].state_vector(ContactState.at(begin, contact)), ()
            else:
                state, others = list(begin.orientation), tuple(_counterparts(form, type(form).of(now, begin)))
        except (TypeError, AttributeError, ValueError) as error:
            names = ", ".join(f"`{key.name}`" for key in wanted)
            raise OutOfDomainError(f"The start cannot be written out as a function of {names} ({error}).") from None
        outputs = tuple(plain(step_of(part)) for part in (*state, *_counterparts(system, now), *others))
        said = "The state in which it starts, and then p."
        return Placed(phase, Routine("placed", said, (("w", len(wanted)),), outputs, tape), len(state), form)

    def at(self, values: Sequence[float]) -> np.ndarray:
        """Return what the routine makes of some values."""
        return np.array(self.routine.tape.function(self.routine.outputs)(list(values)))

    def check(self, scenario: ScenarioFile, values: dict[str, float]) -> None:
        """Refuse values for which a start that is placed anew is not this one.

        Raises
        ------
        OutOfDomainError
            With the reason.
        """
        system, start = moved(scenario, values)
        if phase_of(system, start) != self.phase:
            raise OutOfDomainError(f"there it starts {phase_of(system, start)}, and here {self.phase}")
        state, others = self._wanted(system, start)
        wanted = np.array([*state, *numbers(system), *others])
        found = self.at(list(values.values()))
        if found.size != wanted.size:
            raise OutOfDomainError("there the system is made otherwise")
        if not np.allclose(found, wanted, rtol=_APART, atol=_APART * float(np.max(np.abs(state)))):
            raise OutOfDomainError("there the start is placed otherwise")

    def _wanted(self, system: RollingSystem, start: State) -> tuple[Sequence[float], Sequence[float]]:
        """Return the state where it is placed, and the numbers of the closed form."""
        if self.form is None:
            return phases_of(system)[self.phase].pack(system, start), ()
        form = formula_of(system, start, self.phase)
        if type(form) is not type(self.form):
            raise OutOfDomainError("there another closed form has the motion")
        return start.orientation, numbers(form)


def phase_of(system: RollingSystem, start: State) -> str:
    """Return the phase in which a start is placed, if a page can begin with it.

    Raises
    ------
    OutOfDomainError
        If it begins with a stroke, or nothing presses it on.
    """
    now = transitions.at_start(system, start)
    if any(event.kind in STROKES for event in now.events):
        raise OutOfDomainError("It starts with a stroke against the support")
    if now.law.weightless:
        raise OutOfDomainError("Nothing presses the body on the support")
    return starting_phase(system, start)


def _counterparts(system: Any, other: Any) -> Iterator[Any]:
    """Yield what stands in another system where one has its numbers, in the order of `numbers`."""
    if is_dataclass(system):
        for each in fields(system):
            yield from _counterparts(getattr(system, each.name), getattr(other, each.name))
    elif isinstance(system, tuple):
        if len(system) != len(other):
            raise TypeError("the system is made otherwise")
        for one, another in zip(system, other, strict=True):
            yield from _counterparts(one, another)
    elif is_number(system) and not isinstance(system, bool):
        yield other


__all__ = ["Placed", "TrundleError", "phase_of"]
