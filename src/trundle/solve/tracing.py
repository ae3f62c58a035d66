"""The rolling law traced once with symbols, so that it can be compiled: by heyoka to Taylor series, by SymPy to Python.

The state is (p, q, Ω), ten numbers; the system's own numbers are parameters.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import roll, settle
from ..mechanics.parameters import numbers, with_numbers
from ..mechanics.scalars import Scalar
from ..mechanics.system import RollingSystem, State

STATE = ("p_x", "p_y", "p_z", "q_w", "q_x", "q_y", "q_z", "Omega_x", "Omega_y", "Omega_z")


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
    now = roll(system, time, Vector(*state[:3]), Quaternion(*state[3:7]), Vector(*state[7:]))
    return [*now.point_rate, *now.orientation_rate, *now.angular_acceleration]


def contact_state(system: RollingSystem, start: State) -> list[float]:
    """Return the ten numbers (p, q, Ω) of a start.

    Parameters
    ----------
    system : RollingSystem
        Body and support.
    start : State
        Centre, orientation and Ω.

    Returns
    -------
    list of 10 float
        p in m, q, Ω in rad/s.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> contact_state(level, level.place((0.5, 0.0)))[:3]
    [0.5, 0.0, 0.0]
    """
    centre, q = Vector(*start.position), Quaternion(*start.orientation)
    offset = settle(system, start.time, centre, q).offset
    return [*(centre + offset), *q, *start.angular_velocity]


def heyoka_system(system: RollingSystem) -> tuple[list[tuple[Any, Any]], list[Any]]:
    """Trace the law with heyoka: the system's numbers become runtime parameters.

    Parameters
    ----------
    system : RollingSystem
        Only its structure matters.

    Returns
    -------
    equations : list of (variable, rate)
        As `heyoka.taylor_adaptive` takes them.
    exits : list of expressions
        One, rim² − |p − X|², where the surface has a rim; it falls to 0 where the run ends.
    """
    import heyoka

    symbolic = with_numbers(system, [heyoka.par[i] for i in range(len(numbers(system)))])
    variables = heyoka.make_vars(*STATE)
    rates = state_rates(symbolic, heyoka.time, variables)
    expressions = [r if isinstance(r, heyoka.expression) else heyoka.expression(float(r)) for r in rates]
    rim = symbolic.support.surface.rim
    arm = Vector(*variables[:3]) - symbolic.support.motion.at(heyoka.time).origin
    exits = [] if rim is None else [rim * rim - arm.dot(arm)]
    return list(zip(variables, expressions, strict=True)), exits


def python_rates(system: RollingSystem) -> Callable[[float, Sequence[float]], list[float]]:
    """Trace the law with SymPy and return it as a flat Python function, some 20 times faster than the vectors.

    Parameters
    ----------
    system : RollingSystem
        Structure and numbers.

    Returns
    -------
    callable
        (t, state of 10) -> rates of 10.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> python_rates(level)(0.0, [0, 0, 0, 1, 0, 0, 0, 0.0, 2.0, 0.0])[0]
    2.0
    """
    import sympy

    values = numbers(system)
    time, *state = sympy.symbols(("t", *STATE), real=True)
    parameters = sympy.symbols(f"par0:{len(values)}", real=True)
    rates = state_rates(with_numbers(system, parameters), time, state)
    law = sympy.lambdify([time, state, parameters], rates, modules="math", cse=True)
    return lambda t, y: law(t, y, values)
