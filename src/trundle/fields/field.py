"""A vector field: the right-hand side of a system's law as a function, with names and units, for other programs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..errors import InvalidValueError, OutOfDomainError, UnknownNameError
from ..mechanics.system import RollingSystem, State
from ..units import UNITS
from .backends import BACKENDS, Function
from .inputs import GROUPS, inputs_of
from .printed import Listed, Printed
from .printers import symbolic
from .routines import OUTPUTS, PhaseRoutines, Routine, check_analytic, phases_of
from .touching import CODES, NOTHING

_UNIT_OF = {"p": "m", "q": "", "Omega": "rad/s", "s": "m/s", "V": "m/s", "g": "m", "r": "m"}  # of the state's symbols


@dataclass(frozen=True)
class FieldReset:
    """What follows an event."""

    # (t, y, p, u) -> the code of the phase that follows, an array of one number, −1 for none; None where only one may
    phase: Function | None
    states: Mapping[str, Function]  # for each phase that may follow, (t, y, p, u) -> the state with which it begins


@dataclass(frozen=True, repr=False)
class VectorField(Printed):
    """The right-hand side dy/dt = f(t, y, p, u) of a system in one of its phases.

    Parameters
    ----------
    system : RollingSystem
        What moves.
    backend : str
        "numpy", "numba", "jax", "sympy", "c" or "javascript".
    phase : str
        "rolling", "slipping", "held_slipping", "flight" or "rest".
    input_groups : tuple of str
        Some of "force", "torque" and "support".

    Examples
    --------
    >>> import trundle as tr
    >>> slope = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane(), tilt=0.1))
    >>> f = slope.vector_field("numpy")
    >>> y = f.pack(slope.place())
    >>> rates = f.rates(0.0, y, f.parameters, f.inputs)
    >>> print(round(rates[f.state_names.index("Omega_y")] * 0.02 / (9.80665 * 0.09983341664682815), 12))  # 5/7
    0.714285714286
    """

    system: RollingSystem
    backend: str = "numpy"
    phase: str = "rolling"
    input_groups: tuple[str, ...] = GROUPS
    _outputs = OUTPUTS

    def __post_init__(self) -> None:
        self._check_backend()
        check_analytic(self.system)
        if self.phase not in CODES:
            raise UnknownNameError("phase", str(self.phase), CODES)
        if self.phase not in self.phases:
            rule = f"must be one that the system may have: {', '.join(self.phases)}"
            remedy = (
                "Slipping takes a `friction` of the support, rolling one above 0, rest a resistance to rolling, and "
                "held slipping both."
            )
            raise InvalidValueError("phase", rule, self.phase, remedy)
        inputs_of(self.system, self.input_groups)

    # Names, units and values

    @property
    def state_names(self) -> tuple[str, ...]:
        """The names of the numbers of y."""
        return self._routines.law.names(self.system)

    @property
    def state_units(self) -> tuple[str, ...]:
        """Their units; a quaternion has none."""
        own = self._routines.law.variables
        coordinates = (UNITS[kind][0] for kind in self.system.support.motion.coordinate_kinds)
        return (*(_UNIT_OF[name.partition("_")[0]] for name in own), *coordinates)

    @property
    def input_names(self) -> tuple[str, ...]:
        """The names of the numbers of u, in the inertial support frame."""
        return tuple(name for name, *_ in inputs_of(self.system, self.input_groups))

    @property
    def input_units(self) -> tuple[str, ...]:
        """Their units."""
        return tuple(unit for _, unit, _ in inputs_of(self.system, self.input_groups))

    @property
    def inputs(self) -> Any:
        """U that leaves the system as it is, an array."""
        return np.array([value for *_, value in inputs_of(self.system, self.input_groups)])

    @property
    def event_names(self) -> tuple[str, ...]:
        """The names of the event functions."""
        return self._routines.events()[0]

    # The functions

    def pack(self, start: State) -> Any:
        """Return y of a state.

        Parameters
        ----------
        start : State
            As `RollingSystem.place` returns it.

        Returns
        -------
        array (n,)
            In the order of `state_names`.

        Examples
        --------
        >>> import trundle as tr
        >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
        >>> level.vector_field("numpy").pack(level.place((0.5, 0.0)))[:3].tolist()
        [0.5, 0.0, 0.0]
        """
        return np.array(self._routines.law.pack(self.system, start))

    @cached_property
    def rates(self) -> Function:
        """F(t, y, p, u): the rates of y, each in its unit per second."""
        return self._language.function(self._routines.rates())

    @cached_property
    def events(self) -> Function:
        """F(t, y, p, u): what ends the phase where it falls through zero, in the order of `event_names`.

        Where something may shrink to nothing, as slip does, it takes e besides: `event_parameters` of the state in
        which the phase began.
        """
        return self._language.function(self._routines.events()[1])

    @cached_property
    def event_parameters(self) -> Function | None:
        """F(t, y, p, u): what `events` takes as e; None where it takes none."""
        wanted = self._routines.law.event_parameters > 0
        return self._language.function(self._routines.event_parameters()) if wanted else None

    @cached_property
    def outputs(self) -> Function:
        """F(t, y, p, u): position, velocity, contact force and energy, in the order of `output_names`."""
        return self._language.function(self._routines.outputs())

    @cached_property
    def resets(self) -> Mapping[str, FieldReset]:
        """What follows each event after which the motion goes on."""
        self._need_phases()
        return {event: self._reset(event) for event in self._routines.resets()}

    def _reset(self, event: str) -> FieldReset:
        routines = {each.name.removeprefix(f"{self.phase}_"): each for each in self._routines.after(event)}
        choice = routines.pop(f"phase_after_{event}", None)
        states = {name.removesuffix(f"_after_{event}"): self._language.function(r) for name, r in routines.items()}
        return FieldReset(None if choice is None else self._language.function(choice), states)

    def after(self, event: str, t: float, y: Any, p: Any, u: Any) -> tuple[VectorField, Any]:
        """Return the field of the phase that follows an event, and the state with which it begins.

        Parameters
        ----------
        event : str
            One of `event_names`.
        t : float
            When, s.
        y, p, u : array
            The state at the event, the parameters and the inputs.

        Returns
        -------
        VectorField, array
            Of the same backend.

        Examples
        --------
        >>> import trundle as tr
        >>> floor = tr.Support(tr.Plane(), friction=0.5, restitution=0.5)
        >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), floor)
        >>> f = system.vector_field("numpy", phase="flight")
        >>> y = f.pack(system.place(velocity=(0.0, 0.0, -2.0)))
        >>> bounced, y = f.after("land", 0.0, y, f.parameters, f.inputs)
        >>> print(bounced.phase, round(y[f.state_names.index("V_z")], 12))
        flight 1.0
        """
        self._need_phases()
        name = event.removeprefix("near ")
        if event not in self.event_names:
            raise UnknownNameError("event", event, self.event_names)
        reset = self.resets.get(name)
        code = None if reset is None or reset.phase is None else int(np.asarray(reset.phase(t, y, p, u)).item())
        if reset is None or code == NOTHING:
            raise OutOfDomainError(f"After `{event}` of {self.phase} no phase follows: the run ends there.")
        follows = next(phase for phase in reset.states if code is None or CODES[phase] == code)
        return self.at(follows), reset.states[follows](t, y, p, u)

    def _need_phases(self) -> None:
        if not self._language.phases:
            raise OutOfDomainError(
                f'The backend "{self.backend}" leaves out what follows an event: it has each phase by itself. The '
                "others have it: " + ", ".join(name for name, each in BACKENDS.items() if each.phases) + "."
            )

    # The other phases, and the text

    @property
    def phases(self) -> tuple[str, ...]:
        """The phases that the system may have."""
        return tuple(phases_of(self.system))

    def at(self, phase: str) -> VectorField:
        """Return the field of another phase.

        Parameters
        ----------
        phase : str
            One of `phases`.

        Returns
        -------
        VectorField
            Of the same system, backend and inputs.

        Examples
        --------
        >>> import trundle as tr
        >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
        >>> level.vector_field("numpy").at("flight").state_names[-4:]
        ('g', 'r_x', 'r_y', 'r_z')
        """
        return self if phase == self.phase else VectorField(self.system, self.backend, phase, self.input_groups)

    @cached_property
    def symbols(self) -> tuple[Any, list[Any], list[Any], list[Any]]:
        """SymPy's symbols for t, y, p and u."""
        import sympy

        names = self.state_names, self.parameter_names, self.input_names
        found = iter(symbolic.symbols([name for part in names for name in part]))
        y, p, u = ([next(found) for _ in part] for part in names)
        return sympy.Symbol("t", real=True), y, p, u

    def equations(self, *, shared: bool = False) -> tuple[list[tuple[Any, Any]], list[Any]]:
        """Return the rates as SymPy expressions of `symbols`, whatever the backend.

        Parameters
        ----------
        shared : bool
            Whether what comes more than once gets a name.

        Returns
        -------
        list of (Symbol, Expr), list of Expr
            What the names mean, in order, none unless `shared`; and the rates, simplified where they are short.

        Examples
        --------
        >>> import trundle as tr
        >>> table = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane(), motion=tr.Spin(2.0)))
        >>> table.vector_field("sympy", inputs=()).equations()[1][7]
        rate*(Omega_y*radius - p_y*rate)/(radius*(ratio + 1))
        """
        t, *parts = self.symbols
        values = [t, *(symbol for part in parts for symbol in part)]
        definitions: list[tuple[Any, Any]] | None = [] if shared else None
        rates = symbolic.expressions(self._routines.rates(), values, definitions)
        return (definitions or [], rates if shared else symbolic.simplified(rates))

    def latex(self, *, shared: bool | None = None) -> str:
        r"""Return the equations of motion of this phase in LaTeX.

        Parameters
        ----------
        shared : bool, optional
            Whether what comes more than once gets a name; absent: where the equations are too long without.

        Returns
        -------
        str
            An `align*`.

        Examples
        --------
        >>> import trundle as tr
        >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
        >>> print(level.vector_field("sympy", inputs=()).latex().splitlines()[1])
            \dot{p}_{x} &= \Omega_{y} \mathrm{radius} \\
        """
        _, y, p, u = self.symbols
        shared = not symbolic.readable(self._routines.rates()) if shared is None else shared
        definitions, rates = self.equations(shared=shared)
        return symbolic.latex(y, rates, definitions, [*p, *u])

    def routines(self, *, alone: bool = False) -> list[Routine]:
        """Return the routines of all phases that the backend has, as they are printed.

        Parameters
        ----------
        alone : bool
            Whether to leave out the other phases, and what follows an event.

        Returns
        -------
        list of Routine
            Those of this phase first.
        """
        if alone or not self._language.phases:
            return list(self._routines.motion())
        return [each for phase in self._printed_phases for each in self.at(phase)._routines.all()]

    def source(self, name: str = "field", start: State | None = None) -> str:
        """Return the text of all functions, with what their arguments are; of SymPy, LaTeX.

        Parameters
        ----------
        name, start : see Printed.source
            Of the functions of C; whose numbers are told.

        Returns
        -------
        str
            A module of Python, of JAX or of JavaScript, a file of C, or LaTeX.

        Examples
        --------
        >>> import trundle as tr
        >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
        >>> len(level.vector_field("sympy", inputs=()).source().splitlines())  # ten equations, in an align*
        12
        """
        return super().source(name, start) if self._language.phases else self.latex()

    @property
    def _numbered(self) -> Any:
        return self.system

    @property
    def _title(self) -> str:
        return "The law of one rolling system"

    def _listed(self, start: State | None = None) -> Iterator[Listed]:
        for phase in self._printed_phases:
            there = self.at(phase)
            begins = there.pack(start) if start is not None and phase == self.phase else None
            yield f"y of {phase}", there.state_names, there.state_units, begins
            yield f"events of {phase}", there.event_names, [""] * len(there.event_names), None
        yield "p", self.parameter_names, self.parameter_units, self.parameters
        yield "u", self.input_names, self.input_units, self.inputs
        yield "outputs", self.output_names, self.output_units, None

    @property
    def _printed_phases(self) -> list[str]:
        """The phases that the backend has, this one first."""
        others = [phase for phase in self.phases if phase != self.phase]
        return [self.phase, *(others if self._language.phases else [])]

    @cached_property
    def _routines(self) -> PhaseRoutines:
        return PhaseRoutines(self.system, self.phase, self.input_groups)
