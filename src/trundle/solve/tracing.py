"""The laws traced once on a tape and turned to flat Python; `lowering` makes them ready for heyoka's compiler."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, partial
from itertools import pairwise
from typing import Any

from ..mechanics.duals import has_duals
from ..mechanics.parameters import numbers, structure_of, with_numbers
from ..mechanics.scalars import Scalar, as_float, namespace
from ..mechanics.system import RollingSystem, State
from . import corner_events
from .laws import Law, RollingLaw
from .machine_code import WITH_CARE, MachineCode, available, machine_code
from .tape import Tape

_MOST_TRACED = 64  # kept
_LONG, _ALIKE = 2000, 1.1  # operations; times those of the rates that all outputs of a law are together at most
_OF_PYTHON = 25.0  # operations of machine code that take as long as one of Python's
_UNTRACED = 250_000.0  # the same for a law on vectors


@dataclass(frozen=True)
class CompiledLaw:
    """A law as `compiled_loop` takes it: functions of [t, *state, *values]."""

    rates: MachineCode
    event_functions: MachineCode
    count: int  # of the event functions
    values: tuple[float, ...]


@dataclass(frozen=True)
class PythonLaw:
    """A law on plain numbers.

    Parameters
    ----------
    rates : callable
        (t, state) -> how fast each number of the state changes.
    stops : callable
        (t, state) -> the values of the law's stops.
    names : tuple of str
        Of the event functions.
    found : callable
        (t, state) -> what else of the state the law works out at some cost, as `Law.found` has it.
    corners : callable
        (t, state) -> the components of what passes through zero at each corner of the loads.
    compiled : callable, optional
        () -> the same for the compiled loop, with care; absent: it cannot be traced.
    work : float
        About how long the rates take, operations of machine code.
    """

    rates: Callable[[float, Sequence[float]], list[float]]
    event_functions: Callable[[float, Sequence[float]], list[float]]
    names: tuple[str, ...]
    found: Callable[[float, Sequence[float]], list[float]]
    corners: Callable[[float, Sequence[float]], list[float]]
    compiled: Callable[[], CompiledLaw] | None = None
    work: float = _UNTRACED


def state_rates(system: RollingSystem, time: Scalar, state: Sequence[Scalar]) -> list[Scalar]:
    """Return the rates of the ten numbers (p, q, Ω) by the rolling law.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> [rate + 0.0 for rate in state_rates(level, 0.0, [0, 0, 0, 1, 0, 0, 0, 0.0, 2.0, 0.0])]
    [2.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]
    """
    return RollingLaw().rates(system, time, state)


def contact_state(system: RollingSystem, start: State) -> list[float]:
    """Return the ten numbers (p, q, Ω) of a start, and those of the support's own motion.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> contact_state(level, level.place((0.5, 0.0)))[:3]
    [0.5, 0.0, 0.0]
    """
    return RollingLaw().pack(system, start)


def python_law(
    system: RollingSystem,
    law: Law,
    event_parameters: Sequence[float] = (),
    time: float = 0.0,
    state: Sequence[float] = (),
) -> PythonLaw:
    """Trace a law on a tape and return it as flat Python functions, some 20 times faster than the vectors.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> law = python_law(level, RollingLaw())
    >>> law.rates(0.0, [0, 0, 0, 1, 0, 0, 0, 0.0, 2.0, 0.0])[0], law.names
    (2.0, ('lift',))
    """
    if not system.support.surface.recordable or system.once(has_duals) or has_duals((*vars(law).values(), *state)):
        return _untraced(system, law, event_parameters, time, state)
    own = {name: value for name, value in vars(law).items() if isinstance(value, float)}
    values = [*system.once(numbers), *own.values(), *event_parameters]
    flat = _known(system, law, tuple(own))
    values += [0.0] * (flat.values - len(values))  # of which rates do not lean on those of event functions
    return PythonLaw(
        lambda t, y: flat.rates([t, *y, *values]),
        lambda t, y: flat.event_functions([t, *y, *values]),
        flat.names,
        lambda t, y: flat.found([t, *y, *values]),
        lambda t, y: flat.corners([t, *y, *values]),
        lambda: CompiledLaw(*flat.compiled, len(flat.names), tuple(map(float, values))),
        flat.work,
    )


_Function = Callable[[Sequence[float]], list[float]]


@dataclass(frozen=True)
class _Flat:
    """A law on its tape, as functions of [t, *state, *numbers]."""

    rates: _Function
    event_functions: _Function
    names: tuple[str, ...]
    found: _Function
    corners: _Function
    compiling: Callable[[], tuple[MachineCode, MachineCode]]
    values: int  # numbers after the state
    work: float

    @cached_property
    def compiled(self) -> tuple[MachineCode, MachineCode]:
        """Rates and event functions, compiled with care."""
        return self.compiling()


@cache
def _memory() -> OrderedDict[Any, _Flat]:
    """Return the laws traced in this process: a run of many stretches comes back to each."""
    return OrderedDict()


def _known(system: RollingSystem, law: Law, own: tuple[str, ...]) -> _Flat:
    """Return a law traced, once for each structure of a system."""
    memory, kept = _memory(), tuple((name, value) for name, value in vars(law).items() if name not in own)
    structure = (system.once(structure_of), type(law), kept)
    try:
        hash(structure)
    except TypeError:  # a part of one's own that cannot be hashed, and so may change
        return _traced(system, law, own)
    if structure not in memory:
        memory[structure] = _traced(system, law, own)
        if len(memory) > _MOST_TRACED:
            memory.popitem(last=False)
    return memory[structure]


def _traced(system: RollingSystem, law: Law, own: tuple[str, ...]) -> _Flat:
    """Trace a law with all numbers of the system, and those of the law, as inputs."""
    size, count = len(law.names(system)), len(numbers(system))
    tape = Tape()
    time, *rest = tape.inputs(1 + size + count + len(own) + law.event_parameters + corner_events.count(system))
    state, parameters = rest[:size], rest[size:]
    symbolic, free = with_numbers(system, parameters[:count]), law.traced()
    vars(free).update(zip(own, parameters[count:], strict=False))
    rates = free.rates(symbolic, time, state)
    own_stops = parameters[count + len(own) :]
    stops = corner_events.all_event_functions(symbolic, free, time, _recorded(state), own_stops)
    found = free.found(symbolic, time, state)
    vectors = [part for vector in corner_events.vectors(symbolic, free, time, state) for part in vector]
    values = list(stops.values())
    rates_, stops_, found_, vectors_ = _functions(tape, rates, values, found, vectors)

    def compiling() -> tuple[MachineCode, MachineCode]:
        return machine_code(tape, rates, WITH_CARE), machine_code(tape, values, WITH_CARE)

    operations = len(tape.needed(rates))
    work = operations * (1.0 if _is_long(operations) and available() else _OF_PYTHON)
    return _Flat(rates_, stops_, tuple(stops), found_, vectors_, compiling, len(parameters), work)


def _functions(tape: Tape, *outputs: Sequence[Any]) -> tuple[_Function, ...]:
    """Return a function for each of some lists of outputs, in machine code where they are long.

    They are parts of one where long lists are all but the same work. To make one of ten thousand operations takes a
    tenth of a second, so each is made when it is first called.
    """
    together, edges = [one for part in outputs for one in part], [0]
    for part in outputs:
        edges.append(edges[-1] + len(part))
    operations = len(tape.needed(outputs[0]))
    make = machine_code if _is_long(operations) and available() else Tape.function
    if not _is_long(operations) or len(tape.needed(together)) > _ALIKE * operations:
        return tuple(_when_called(partial(make, tape, part)) for part in outputs)
    whole = _when_called(partial(make, tape, together))

    def between(begin: int, end: int) -> _Function:
        return lambda x: whole(x)[begin:end]

    return tuple(between(*pair) for pair in pairwise(edges))


def _is_long(operations: int) -> bool:
    return operations >= _LONG


def _when_called(make: Callable[[], _Function]) -> _Function:
    """Return a function that is made when it is first called."""
    made = cache(make)
    return lambda x: made()(x)


def _recorded(state: Sequence[Scalar]) -> list[Scalar]:
    """Return a state with q/|q|, as samples hold it: else N is 0 at an instant at which a sample has some."""
    length = namespace(*state[3:7]).sqrt(sum((part * part for part in state[3:7]), 0.0))
    return [*state[:3], *(part / length for part in state[3:7]), *state[7:]]


def _untraced(
    system: RollingSystem, law: Law, event_parameters: Sequence[float], time: float, state: Sequence[float]
) -> PythonLaw:
    def rates(t: float, y: Sequence[float]) -> list[float]:
        return [as_float(rate) for rate in law.rates(system, t, y)]

    def stops(t: float, y: Sequence[float]) -> list[float]:
        found = corner_events.all_event_functions(system, law, t, _recorded(y), event_parameters)
        return [as_float(value) for value in found.values()]

    def found(t: float, y: Sequence[float]) -> list[float]:
        return [as_float(part) for part in law.found(system, t, y)]

    def vectors(t: float, y: Sequence[float]) -> list[float]:
        return [as_float(part) for vector in corner_events.vectors(system, law, t, y) for part in vector]

    # Which stops there are is read off a state in which the law holds: of any other it may know nothing.
    given = event_parameters or (0.0,) * (law.event_parameters + corner_events.count(system))
    names = tuple(corner_events.all_event_functions(system, law, time, state, given)) if len(state) else ()
    return PythonLaw(rates, stops, names, found, vectors)
