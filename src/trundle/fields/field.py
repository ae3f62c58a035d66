"""A vector field: the right-hand side of a system's law as a function, with names and units, for other programs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..errors import InvalidValueError, OutOfDomainError, UnknownNameError
from ..mechanics.parameters import numbers, parameters
from ..mechanics.system import RollingSystem, State
from ..units import UNITS
from .backends import BACKENDS, Backend, Function
from .inputs import GROUPS, inputs_of
from .printers import c, symbolic
from .resets import CODES
from .routines import OUTPUTS, PhaseRoutines, Routine, check_analytic, phases_of

_UNIT_OF = {"p": "m", "q": "", "Omega": "rad/s", "s": "m/s", "V": "m/s", "g": "m", "r": "m"}  # of the state's symbols


@dataclass(frozen=True)
class FieldReset:
    """What follows an event.

    Parameters
    ----------
    phase : callable or None
        (t, y, p, u) -> the code of the phase that follows, an array of one number; None where only one may.
    states : mapping of str to callable
        For each phase that may follow, (t, y, p, u) -> the state with which it begins.
    """

    phase: Function | None
    states: Mapping[str, Function]


@dataclass(frozen=True)
class VectorField:
    """The right-hand side dy/dt = f(t, y, p, u) of a system in one of its phases.

    Parameters
    ----------
    system : RollingSystem
        What moves.
    backend : str
        "numpy", "numba", "jax", "sympy", "c" or "javascript".
    phase : str
        "rolling", "slipping", "flight" or "rest".
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

    def __post_init__(self) -> None:
        if self.backend not in BACKENDS:
            raise UnknownNameError("backend", str(self.backend), BACKENDS)
        check_analytic(self.system)
        if self.phase not in CODES:
            raise UnknownNameError("phase", str(self.phase), CODES)
        if self.phase not in self.phases:
            raise OutOfDomainError(
                f"This system has no {self.phase}: it has {', '.join(self.phases)}. Slipping takes a `friction` of the "
                "support, rolling one that is not 0, and rest a resistance to rolling."
            )
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
    def parameter_names(self) -> tuple[str, ...]:
        """The names of the numbers of p: every number of the system."""
        return tuple(name for name, _ in parameters(self.system))

    @property
    def parameter_units(self) -> tuple[str, ...]:
        """Their units; numbers in a formula are in SI, and have none here."""
        return tuple(UNITS[dimension][0] for _, dimension in parameters(self.system))

    @property
    def parameters(self) -> Any:
        """P of the system, an array."""
        return np.array(numbers(self.system))

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

    @property
    def output_names(self) -> tuple[str, ...]:
        """The names of the outputs."""
        return tuple(name for name, _ in OUTPUTS)

    @property
    def output_units(self) -> tuple[str, ...]:
        """Their units."""
        return tuple(unit for _, unit in OUTPUTS)

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
        return self._backend.function(self._routines.rates())

    @cached_property
    def events(self) -> Function:
        """F(t, y, p, u): what ends the phase where it falls through zero, in the order of `event_names`.

        Where something may shrink to nothing, as slip does, it takes e besides: `event_parameters` of the state in
        which the phase began.
        """
        return self._backend.function(self._routines.events()[1])

    @cached_property
    def event_parameters(self) -> Function | None:
        """F(t, y, p, u): what `events` takes as e; None where it takes none."""
        wanted = self._routines.law.event_parameters > 0
        return self._backend.function(self._routines.event_parameters()) if wanted else None

    @cached_property
    def outputs(self) -> Function:
        """F(t, y, p, u): position, velocity, contact force and energy, in the order of `output_names`."""
        return self._backend.function(self._routines.outputs())

    @cached_property
    def resets(self) -> Mapping[str, FieldReset]:
        """What follows each event after which the motion goes on."""
        self._need_phases()
        return {event: self._reset(event) for event in self._routines.resets()}

    def _reset(self, event: str) -> FieldReset:
        routines = {each.name.removeprefix(f"{self.phase}_"): each for each in self._routines.after(event)}
        choice = routines.pop(f"phase_after_{event}", None)
        states = {name.removesuffix(f"_after_{event}"): self._backend.function(r) for name, r in routines.items()}
        return FieldReset(None if choice is None else self._backend.function(choice), states)

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
        if name not in self.resets:
            raise OutOfDomainError(
                f"After `{event}` of {self.phase} no phase follows that can be written out: the run ends there, or the "
                "landing turns the slip on the way, as where the body is no ball and friction is limited. "
                "trundle.simulate follows that."
            )
        reset = self.resets[name]
        code = None if reset.phase is None else int(np.asarray(reset.phase(t, y, p, u)).item())
        follows = next(phase for phase in reset.states if code is None or CODES[phase] == code)
        return self.at(follows), reset.states[follows](t, y, p, u)

    def _need_phases(self) -> None:
        if not self._backend.phases:
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

    def routines(self) -> list[Routine]:
        """Return the routines of all phases that the backend has, as they are printed.

        Returns
        -------
        list of Routine
            Those of this phase first.
        """
        others = [phase for phase in self.phases if phase != self.phase] if self._backend.phases else []
        return [each for phase in (self.phase, *others) for each in self.at(phase)._routines.all()]

    def source(self, name: str = "field", start: State | None = None) -> str:
        """Return the text of all functions, with what their arguments are.

        Parameters
        ----------
        name : str
            With which the functions of C begin, and its header: letters, digits and underscores.
        start : State, optional
            Its y is told with the names.

        Returns
        -------
        str
            A module of Python, of JAX or of JavaScript, a file of C, or LaTeX.

        Examples
        --------
        >>> import trundle as tr
        >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
        >>> "void ball_rolling_rates(" in level.vector_field("c").source("ball")
        True
        """
        if not name.isidentifier() or not name.isascii():
            raise InvalidValueError("name", "must consist of letters, digits and underscores", name)
        if not self._backend.phases:
            return self.latex()
        return self._backend.source(self.routines(), name, self._said(start))

    def header(self, name: str = "field") -> str:
        """Return the header that declares the functions of C.

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
        >>> import trundle as tr
        >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
        >>> "#ifndef BALL_H" in level.vector_field("c").header("ball")
        True
        """
        return c.header(self.routines(), name, self._said())

    def _said(self, start: State | None = None) -> str:
        """Say what the functions take, all in SI."""
        lines = ["The law of one rolling system, as trundle wrote it. All numbers are in SI.", "", "t: time (s)"]
        for phase in (self.phase, *(each for each in self.phases if self._backend.phases and each != self.phase)):
            there = self.at(phase)
            begins = there.pack(start) if start is not None and phase == self.phase else None
            lines += _table(f"y of {phase}", there.state_names, there.state_units, begins)
            if there.event_names:
                lines.append(f"events of {phase}: " + ", ".join(there.event_names))
        lines += _table("p", self.parameter_names, self.parameter_units, self.parameters)
        lines += _table("u", self.input_names, self.input_units, self.inputs)
        lines += _table("outputs", self.output_names, self.output_units)
        return "\n".join(lines)

    @cached_property
    def _routines(self) -> PhaseRoutines:
        return PhaseRoutines(self.system, self.phase, self.input_groups)

    @property
    def _backend(self) -> Backend:
        return BACKENDS[self.backend]


def _table(title: str, names: Sequence[str], units: Sequence[str], values: Any = None) -> list[str]:
    """List names with their places, units and values."""
    if not names:
        return []
    values = [None] * len(names) if values is None else values.tolist()
    rows = zip(names, units, values, strict=True)
    return [
        f"{title}:",
        *(
            f"    [{i}] {name}{f' ({unit})' if unit else ''}{'' if value is None else f' = {value!r}'}"
            for i, (name, unit, value) in enumerate(rows)
        ),
    ]


__all__ = ["FieldReset", "VectorField"]
