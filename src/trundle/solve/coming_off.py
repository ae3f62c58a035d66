"""Whether a body comes off, or slips, where N is all but nothing: at the cone's tip, and where N only touches zero."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ..mechanics.system import RollingSystem
from . import corner_events
from .contact_state import ContactState
from .laws import Law, RollingLaw
from .tracing import python_law

_AT_HAND = 1e-3  # of the time in which the motion changes
_CLOSER, _SOON = 12, 4  # times ten
_NEARLY = 1e-3  # share of the usual force above which N is no double root's
_UNASKED = 1e-7  # share of what friction can give when the body is pressed on as usual
_ROUNDING = 1e-12  # share of the forces at hand, of which a pull of the support may be


def lift_at_hand(
    system: RollingSystem, law: Law, time: float, numbers: Sequence[float], name: str, event_parameters: Sequence[float]
) -> float | None:
    """Return when the body comes off in whose contact friction, or resistance to rolling, seems to give way.

    What is left of friction, μ²N² − f², has a double root where N has a single one and nothing asks for friction. Of a
    double root only half the digits are found: so the stop may come too soon, and is no slip.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.solve.laws import RollingLaw
    >>> shaken = tr.Support(tr.Plane(), motion=tr.Shake((0.0, 0.0, 0.01), 45.0), friction=0.3)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.05, 1.0), shaken)
    >>> law = RollingLaw()
    >>> state_vector = law.pack(system, system.place(time=0.011234))
    >>> round(lift_at_hand(system, law, 0.011234, state_vector, "slip", ()), 9)  # asin(g/(Aω²))/ω
    0.011234198
    """
    from scipy.optimize import brentq

    at = law.unpack(system, time, numbers)
    look, moment = _looks(system, law, at, numbers, ("lift", name), event_parameters)
    now = look(0.0)[0]
    changes = abs(look(_AT_HAND * moment)[0] - now) / _AT_HAND  # in such a time, N
    if now > _NEARLY * max(changes, at.forces(system)):
        return None
    # From close by outwards: where all forces vanish with N, the motion changes in no time of its own.
    limits = (_AT_HAND * moment * 0.1**k for k in range(_CLOSER, -1, -1))
    limit, later = next(((to, N) for to in limits if (N := look(to)[0]) < 0), (0.0, 0.0))
    if not later < 0 or later > now:
        return None
    wait = 0.0 if now <= 0 else float(brentq(lambda wait: look(wait)[0], 0.0, limit, xtol=1e-15 * limit, rtol=1e-15))
    holds = float(system.support.friction or 0.0)
    if name == "start":
        holds = float(system.resistance)
    usual = (now - later) / limit * moment  # N
    return time + wait if -look(wait)[1] <= (_UNASKED * holds * usual) ** 2 else None


def only_touches(
    system: RollingSystem, law: Law, at: ContactState, numbers: Sequence[float], event_parameters: Sequence[float]
) -> bool:
    """Tell whether N, which has come to zero, rises again at once: the support has pulled by no more than rounding.

    A ball that turns back on its way round an upright pipe is pressed on by m v²/(R − r), a square, before and after.
    """
    look, moment = _looks(system, law, at, numbers, ("lift",), event_parameters)
    least = -_ROUNDING * at.forces(system)
    return all(look(_AT_HAND * moment * 0.1**k)[0] >= least for k in range(_CLOSER))


def slips_at_once(system: RollingSystem, at: ContactState, floor: float) -> bool:
    """Tell whether a body at rest, on which nothing presses, is about to be asked for friction by what begins to move.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.SpinBy("t**2"), friction=0.3)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), table, gravity=0.0)
    >>> slips_at_once(system, ContactState.of(system, system.place((0.1, 0.0))), 0.0)
    True
    """
    if not system.support.friction or at.speed > 0:
        return False
    law = RollingLaw(weightless=True)
    look, moment = _looks(system, law, at, law.state_vector(at), ("slip",), (floor,))
    return all(look(_AT_HAND * moment * 0.1**k)[0] < 0 for k in range(_SOON))


def _looks(
    system: RollingSystem,
    law: Law,
    at: ContactState,
    numbers: Sequence[float],
    names: Sequence[str],
    event_parameters: Sequence[float],
) -> tuple[Callable[[float], list[float]], float]:
    """Return what gives some of a law's event functions a little later, and the time in which the motion changes, s."""
    time = at.state.time
    plain = python_law(system, law, (*event_parameters, *[0.0] * corner_events.count(system)), time, numbers)
    which = [plain.names.index(name) for name in names]

    def look(wait: float) -> list[float]:
        found = plain.event_functions(time + wait, law.rk4_step(system, time, numbers, wait, plain.rates))
        return [found[index] for index in which]

    return look, law.moment(system, at, plain.rates(time, numbers))
