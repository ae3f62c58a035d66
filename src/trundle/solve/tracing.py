"""The laws traced once with symbols, so that they can be compiled: by heyoka to Taylor series, on a tape to Python.

The system's own numbers are parameters, so that another radius, tilt or rate compiles nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..mechanics.parameters import numbers, with_numbers
from ..mechanics.scalars import Scalar
from ..mechanics.system import RollingSystem, State
from .laws import Law, RollingLaw
from .tape import Tape

# (time, state) -> rates, and the values of the law's stops in their order
Traced = Callable[[float, Sequence[float]], list[float]]


def state_rates(system: RollingSystem, time: Scalar, state: Sequence[Scalar]) -> list[Scalar]:
    """Return the rates of the ten numbers (p, q, Ω) by the rolling law.

    Parameters
    ----------
    system : RollingSystem
        Its numbers may be any scalars.
    time : Scalar
        s.
    state : sequence of 10 Scalar
        p in m, q, Ω in rad/s, inertial support frame.

    Returns
    -------
    list of 10 Scalar
        Their time derivatives.

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

    Parameters
    ----------
    system : RollingSystem
        Body and support.
    start : State
        Centre, orientation and Ω.

    Returns
    -------
    list of float
        p in m, q, Ω in rad/s.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> contact_state(level, level.place((0.5, 0.0)))[:3]
    [0.5, 0.0, 0.0]
    """
    return RollingLaw().pack(system, start)


def heyoka_system(system: RollingSystem, law: Law | None = None) -> tuple[list[tuple[Any, Any]], dict[str, Any]]:
    """Trace a law with heyoka: the system's numbers, and after them the law's extras, become runtime parameters.

    Parameters
    ----------
    system : RollingSystem
        Only its structure matters.
    law : Law, optional
        Of the phase; absent: rolling.

    Returns
    -------
    equations : list of (variable, rate)
        As `heyoka.taylor_adaptive` takes them.
    stops : dict of expressions
        Each falls through 0 where the phase ends, by name.
    """
    import heyoka

    law = RollingLaw() if law is None else law
    count = len(numbers(system))
    symbolic = with_numbers(system, [heyoka.par[i] for i in range(count)])
    extras = [heyoka.par[count + i] for i in range(law.extras)]
    variables = heyoka.make_vars(*law.names(system))
    rates = law.rates(symbolic, heyoka.time, variables)
    stops = law.stops(symbolic, heyoka.time, variables, extras)
    equations = list(zip(variables, map(_expression, rates), strict=True))
    return equations, {name: _expression(stop) for name, stop in stops.items()}


def _expression(value: Any) -> Any:
    import heyoka

    return value if isinstance(value, heyoka.expression) else heyoka.expression(float(value))


def python_law(system: RollingSystem, law: Law, extras: Sequence[float] = ()) -> tuple[Traced, list[str]]:
    """Trace a law on a tape and return it as a flat Python function, some 20 times faster than the vectors.

    Parameters
    ----------
    system : RollingSystem
        Structure and numbers. A support given as a table cannot be traced: it is worked out on floats each time.
    law : Law
        Of the phase.
    extras : sequence of float
        What its stops take besides.

    Returns
    -------
    function : callable
        (t, state) -> rates and stops, one list.
    stops : list of str
        Names of the stops.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> law, stops = python_law(level, RollingLaw())
    >>> law(0.0, [0, 0, 0, 1, 0, 0, 0, 0.0, 2.0, 0.0])[0], stops
    (2.0, ['lift'])
    """
    size = len(law.names(system))
    if not system.support.surface.analytic:
        return _untraced(system, law, extras)
    values = [*numbers(system), *extras]
    tape = Tape()
    time, *rest = tape.inputs(1 + size + len(values))
    state, parameters = rest[:size], rest[size:]
    symbolic = with_numbers(system, parameters[: len(values) - len(extras)])
    rates = law.rates(symbolic, time, state)
    stops = law.stops(symbolic, time, state, parameters[len(values) - len(extras) :])
    function = tape.function([*rates, *stops.values()])
    return lambda t, y: function([t, *y, *values]), list(stops)


def _untraced(system: RollingSystem, law: Law, extras: Sequence[float]) -> tuple[Traced, list[str]]:
    def evaluated(t: float, y: Sequence[float]) -> list[float]:
        return [float(value) for value in (*law.rates(system, t, y), *law.stops(system, t, y, extras).values())]

    start = [0.0] * len(law.names(system))
    start[3] = 1.0
    return evaluated, list(law.stops(system, 0.0, start, extras))
