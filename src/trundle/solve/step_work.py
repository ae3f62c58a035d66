"""Which numerical method comes to an error with less work: Taylor series, or DOP853 in its compiled loop.

Work is counted, never timed, so that a run has the same digits on any machine and whatever it has compiled before. Both
methods take some first steps, which say how long the others will be.
"""

from __future__ import annotations

import math

from ..errors import SolverError
from ..mechanics.kinks import kinks_and_jolts
from ..mechanics.system import RollingSystem, State
from . import compiled_steps, runge_kutta, transitions
from .charts import CHART
from .samples import ENDS

_FINER = 100.0  # times: then DOP853 errs in all of a run about as much as Taylor's method, whose error adds up less
_FIRST = 10  # steps that are looked at
_BEGINNING = 3000.0  # steps of that loop, while SciPy takes the first ones, here and in the run
_SMOOTH = {"lift", CHART, *ENDS}  # event functions of a law that most likely holds to the end


def of_equal_error(tolerance: float) -> float:
    """Return the tolerance at which DOP853 comes to the error of Taylor's method.

    Examples
    --------
    >>> of_equal_error(1e-6)
    1e-08
    """
    return float(f"{tolerance / _FINER:.15g}")


def takes_less(system: RollingSystem, start: State, end: float, tolerance: float) -> bool:
    """Tell whether DOP853 takes less work to the end, s, than Taylor's method at a tolerance, for an equal error.

    A run of many phases is left to Taylor's method, which begins each at less cost.

    Examples
    --------
    A coin is short work along its line of nodes, where its own rotation has no part in the law:

    >>> import trundle as tr
    >>> coin = tr.RollingSystem(tr.Body.disc(radius=0.012, mass=0.0075), tr.Support(tr.Plane()))
    >>> start = coin.place(attitude=(0.0, "80 deg", 0.0), velocity=(0.5, 0.0), spin=1.0)
    >>> takes_less(coin, start, 60.0, 1e-9)
    False
    """
    from . import taylor

    finer = of_equal_error(tolerance)
    if finer < runge_kutta.FINEST or not compiled_steps.available() or kinks_and_jolts(system, start.time, end):
        return False
    now = transitions.at_start(system, start)
    if now.law.brief or now.across is not None:
        return False
    length, products, names = taylor.first_steps(system, now, end, tolerance, _FIRST)
    if not (length > 0 and set(names) <= _SMOOTH):
        return False
    # Steps of the compiled loop that take as long as Taylor's method does.
    steps = (end - now.time) / length * products / runge_kutta.OF_A_STEP
    if not 2 * _BEGINNING < steps < math.inf:
        return False
    try:
        compiled = (end - now.time) / runge_kutta.first_steps(system, now, end, finer, _FIRST)
    except SolverError:
        return False
    return 2 * runge_kutta.WORTH_THE_LOOP < compiled < steps - _BEGINNING
