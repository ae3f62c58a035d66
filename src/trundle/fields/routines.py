"""The functions of a system's phases, each traced on a tape: what the printers print."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from ..errors import OutOfDomainError
from ..mechanics.algebra import Vector
from ..mechanics.contact import Contact, contact_at
from ..mechanics.invariants import Record
from ..mechanics.invariants.powers import energies
from ..mechanics.loads import BodyMotion
from ..mechanics.parameters import parameters, with_numbers
from ..mechanics.placing import SLIP_TOLERANCE
from ..mechanics.quantities import Quantity, quantities
from ..mechanics.scalars import Scalar, is_number, is_zero
from ..mechanics.system import RollingSystem, State
from ..solve.contact_state import ContactState
from ..solve.laws import FlightLaw, Law, RestingLaw, RollingLaw, RollingWithResistance, SlidingFreely, SlippingLaw
from ..solve.samples import SLIPPING
from ..solve.tape import Dialect, Node, Tape
from ..solve.transitions import at_start
from .inputs import inputs_of, with_inputs
from .resets import RESETS, event_parameters
from .touching import HELD, Follows

STROKES = ("land", "settle", "jolt")  # kinds of event at which the support strikes the body

# What a picture of a motion is made from; its curves come behind that.
FILM = (
    *((f"{name}_{axis}", unit) for name, unit in (("position", "m"), ("contact", "m")) for axis in "xyz"),
    *((f"orientation_{part}", "") for part in "wxyz"),
    *((f"velocity_{axis}", "m/s") for axis in "xyz"),
    *((f"angular_velocity_{axis}", "rad/s") for axis in "xyz"),
    *((f"contact_force_{axis}", "N") for axis in "xyz"),
    *((f"support_position_{axis}", "m") for axis in "xyz"),
    *((f"support_rotation_{row}{column}", "") for row in "xyz" for column in "xyz"),
)
OUTPUTS = (
    *((f"{name}_{axis}", unit) for name, unit in (("position", "m"), ("velocity", "m/s")) for axis in "xyz"),
    *((f"contact_force_{axis}", "N") for axis in "xyz"),
    ("energy", "J"),
)


@dataclass(frozen=True)
class Routine:
    """One function on a tape."""

    name: str  # what it is called
    said: str  # what it returns, as a sentence
    # its arguments in the order of the tape's inputs: how many numbers each has; None, a number
    arguments: tuple[tuple[str, int | None], ...]
    outputs: tuple[Any, ...]  # what it returns
    tape: Tape  # holds them

    def written(self, dialect: Callable[[Callable[[int], str]], Dialect], element: str) -> Any:
        """Return the steps and the results as `Tape.written`, the elements of an argument as the language has them."""
        names = [
            part
            for name, size in self.arguments
            for part in ([name] if size is None else [element.format(name, i) for i in range(size)])
        ]
        return self.tape.written(self.outputs, dialect(names.__getitem__))


def phases_of(system: RollingSystem) -> dict[str, Law]:
    """Return the phases that a system may have, by name, each with its law.

    Examples
    --------
    >>> import trundle as tr
    >>> list(phases_of(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane(), friction=0.2))))
    ['rolling', 'slipping', 'flight']
    """
    friction, found = system.support.friction, dict[str, Law]()
    none = friction is not None and is_number(friction) and friction == 0
    if not none:
        found["rolling"] = RollingWithResistance() if system.resisted else RollingLaw()
    slipping = SlidingFreely if none else SlippingLaw
    if friction is not None:
        found["slipping"] = slipping(turning="resisted" if system.resisted else "free")
        if system.resisted and not system.support.motion.free:
            found[HELD] = slipping(turning="held")
    found["flight"] = FlightLaw()
    if system.resisted and not none and not system.support.motion.free:
        found["rest"] = RestingLaw()
    return found


def starting_phase(system: RollingSystem, start: State) -> str:
    """Return the phase in which a start is placed; where static friction cannot hold it, "slip" ends it at once.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane(), friction=0.2))
    >>> starting_phase(level, level.place()), starting_phase(level, level.place(velocity=(1.0, 0.0), spin=3.0))
    ('rolling', 'rolling')
    >>> starting_phase(level, level.place(height=0.1))
    'flight'
    """
    now, at = at_start(system, start), ContactState.of(system, start)
    if any(event.kind in STROKES for event in now.events):
        return "flight"
    held = now.law.turning == "held"
    if now.law.code == SLIPPING and not is_zero(system.support.friction) and _sticks(at):
        return "rest" if held else "rolling"
    found = phases_of(system).items()
    return next(name for name, law in found if law.code == now.law.code and (law.turning == "held") == held)


def _sticks(at: ContactState) -> bool:
    return not at.sliding.norm() > SLIP_TOLERANCE * at.speed


def check_analytic(system: RollingSystem) -> None:
    """Refuse a surface that is known by a table only."""
    if not system.support.surface.analytic:
        raise OutOfDomainError(
            "The law of a body on a surface given by a table cannot be written out as formulas. Give the surface by a "
            "formula, or use trundle.simulate."
        )


class PhaseRoutines:
    """The routines of one phase of a system: rates, event functions, outputs and what follows each event.

    Parameters
    ----------
    system : RollingSystem
        Its numbers are read for what is decided once: which resets there are.
    phase : str
        One of `phases_of`.
    groups : sequence of str
        Of inputs.
    """

    def __init__(self, system: RollingSystem, phase: str, groups: Sequence[str]) -> None:
        law = phases_of(system)[phase]
        sizes = len(parameters(system)), len(inputs_of(system, groups))
        self._state, p, u = self._begin(system, phase, law.names(system), *sizes)
        self.system = with_inputs(with_numbers(system, p), groups, u)

    def _begin(
        self, system: RollingSystem, phase: str, state: Sequence[str], parameters: int, inputs: int
    ) -> list[list[Node]]:
        """Start a tape whose functions take so many numbers, and return these."""
        self.phase, self.name, self.law, self._plain = phase, phase, phases_of(system)[phase], system
        self.state_names = state
        self._tape = Tape()
        self._sizes = {"y": len(state), "p": parameters, "u": inputs, "e": self.law.event_parameters}
        self._time, *rest = self._tape.inputs(1 + sum(self._sizes.values()))
        parts = iter(rest)
        *found, self._given = ([next(parts) for _ in range(n)] for n in self._sizes.values())
        return found

    def all(self) -> Iterator[Routine]:
        """Return every routine of the phase."""
        yield from self.motion()
        for event in self.resets():
            yield from self.after(event)

    def motion(self) -> Iterator[Routine]:
        """Return those of the phase by itself."""
        yield self.rates()
        yield self.events()[1]
        if self.law.event_parameters:
            yield self.event_parameters()
        yield self.outputs()

    def rates(self) -> Routine:
        """Return the right-hand side."""
        return self._routine("rates", "Rates of the state.", self.law.rates(self.system, self._time, self._state))

    def events(self) -> tuple[tuple[str, ...], Routine]:
        """Return the names of the event functions, and these."""
        found = self.law.event_functions(self.system, self._time, self._state, self._given)
        said = "What ends the phase where it falls through zero: " + ", ".join(found) + "."
        given = self.law.event_parameters > 0
        return tuple(found), self._routine("events", said, found.values(), given=given)

    def event_parameters(self) -> Routine:
        """Return what the event functions take besides, of the state in which the phase begins."""
        found = event_parameters(self.system, self.law, self._time, self._state)
        return self._routine("event_parameters", "What `events` takes as e: of the state as the phase begins.", found)

    def outputs(self) -> Routine:
        """Return position, velocity, contact force and energy."""
        motion = self.law.motion(self.system, self._time, self._state)
        R = self.law.reaction(self.system, self._time, self._state)
        energy = sum(energies(self.system, motion), 0.0)
        said = "Position, velocity, contact force and energy."
        return self._routine("outputs", said, [*motion.position, *motion.velocity, *R, energy])

    def film(self) -> Routine:
        """Return what a picture of the motion is made from, in the order of `FILM`, and then its curves."""
        motion, contact, R = self._shown()
        support = contact.support
        p, q, _ = self._place()
        turn = [part for row in support.rotation.rows for part in row]
        V, Omega, curves = motion.velocity, motion.angular_velocity, [one.value for one in self.curves()]
        found = [*motion.position, *p, *q.unit, *V, *Omega, *R, *support.origin, *turn, *curves]
        return self._routine("film", "What a picture of the motion is made from, and its curves.", found)

    def curves(self) -> list[Quantity]:
        """Return what may be drawn over the time, on the tape."""
        motion, contact, R = self._shown()
        record = Record(motion, contact.point, self._place()[2])
        found = list(quantities(self.system, self._plain, record, contact.support, contact.normal, R))
        if self._plain.support.friction is not None:
            slips = self.law.code == SLIPPING
            slip = contact.slip_velocity(motion.velocity, motion.angular_velocity).norm() if slips else 0.0
            found.append(Quantity("slip", "Slip speed", "m/s", slip, touching=True))
        return found

    def _shown(self) -> tuple[BodyMotion, Contact, Vector]:
        system, law, t, y = self.system, self.law, self._time, self._state
        return law.motion(system, t, y), contact_at(system, t, *self._place()), law.reaction(system, t, y)

    def resets(self) -> list[str]:
        """Return the events after which another phase follows."""
        names = (name for name in self.events()[0] if not name.startswith("near "))
        return [name for name in names if (self.phase, name) in RESETS]

    def after(self, event: str) -> Iterator[Routine]:
        """Return which phase follows an event, if it depends, and the state with which each that may follow begins."""
        follows = self.follows(event)
        if follows.phase is not None:
            codes = ", ".join(f"{code} {name}" for name, code in follows.codes())
            said = f"The phase that follows the event `{event}`: {codes}."
            yield self._routine(f"phase_after_{event}", said, [follows.phase])
        for name, state in follows.states.items():
            said = f"The state of {name} that follows the event `{event}`."
            yield self._routine(f"{name}_after_{event}", said, state)

    def follows(self, event: str) -> Follows:
        """Return what follows an event, on the tape."""
        n = contact_at(self.system, self._time, *self._place()).normal
        return RESETS[self.phase, event](self.system, self.law, self._time, self._state, n, self._plain)

    def _place(self) -> Any:
        p, q, _, _, coordinates = self.law.split(self._state)
        return p, q, coordinates

    def _routine(self, name: str, said: str, outputs: Any, *, given: bool = False) -> Routine:
        arguments = [("t", None), *((name, self._sizes[name]) for name in ("y", "p", "u", *("e" * given)))]
        return Routine(f"{self.name}_{name}", said, tuple(arguments), tuple(map(plain, outputs)), self._tape)


def plain(value: Scalar) -> Any:
    """Return what a tape recorded, or a number as a float.

    Examples
    --------
    >>> plain(1)
    1.0
    """
    return value if isinstance(value, Node) else float(value)
