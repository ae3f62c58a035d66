"""Vary one shortcoming at a time, and rank them by what they do."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ...errors import InvalidValueError
from ...mechanics import checks
from ...mechanics.loads import Drag, RollingResistance
from ...mechanics.motions import UnevenSpin, Wobble
from ...mechanics.system import RollingSystem, State
from ...scenario import ScenarioFile
from ...simulation.simulate import Scenario, simulate
from ...simulation.trajectory import Trajectory
from ...solve.samples import Progress
from .air import air_drag
from .circle import Demonstration, Fate
from .kinds import Askew, Resistance, Shortcoming, StillAir, Tilt, TurningAir, Uneven
from .measuring import CircleMotion, measure
from .report import Sensitivity
from .rows import Row

SAMPLES_A_ROUND = 24
MOST_ROUNDS = 100_000
LEANING, ASKEW, VARIATION = math.radians(0.1), math.radians(0.1), 0.01
RESISTANCE = 1e-4  # of the weight


def sensitivity(
    scenario: Any,
    start: State | None = None,
    *,
    tilt: Any = None,
    drag: Any = None,
    rolling_resistance: Any = None,
    wobble: Any = None,
    variation: Any = None,
    variation_rate: Any = None,
    horizon: Any = 3600.0,
    method: str = "taylor",
    progress: Progress | None = None,
) -> Sensitivity:
    """Find out which shortcoming of a turntable demonstration matters most, and how long until the ball is off.

    The scenario is first made perfect: level, at a steady rate, without drag and resistance. Then one shortcoming at a
    time is put in. A size that is not given is the scenario's own where it has that shortcoming; else it is 0.1° of
    tilt, 0.1° of wobble, a rate uneven by 1 % once a turn, the drag of room air on the ball (`air_drag`), and a
    resistance to rolling of a ten-thousandth of the weight.

    Parameters
    ----------
    scenario : Scenario, str or RollingSystem
        A ball on a turntable with a rim: a scenario, the name of one that ships, a file, or a system with its start.
    start : State
        With a system only.
    tilt : float or quantity, optional
        Of the table, rad.
    drag : float or quantity, optional
        Coefficient of linear drag, kg/s, for air at rest as for air that turns with the table.
    rolling_resistance : float or quantity, optional
        How far ahead of the contact the normal force acts, m, as of `RollingResistance`.
    wobble : float or quantity, optional
        Angle between the table's axis and its axle, rad.
    variation : float, optional
        Of the table's rate, as a share of it.
    variation_rate : float or quantity, optional
        At which the rate varies, rad/s.
    horizon : float or quantity
        How long to wait for the ball, s.
    method : str
        As for `simulate`. Taylor's method serves the whole table alike, and owes nothing to the formulas beside it.
    progress : callable, optional
        Told the fraction done, 0 to 1.

    Returns
    -------
    Sensitivity
        The table, the worst shortcoming first.

    Raises
    ------
    InvalidValueError
        If it is no ball on a turntable with a rim, or a value is refused.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.sensitivity("level-turntable-nudged", horizon="60 s")
    >>> table.rows[0].name, round(table.rows[0].leaves)
    ('tilt', 33)
    """
    system, first, title = _read(scenario, start)
    show = Demonstration.of(system, first)
    length = checks.positive(horizon, "time", "horizon")
    if length > MOST_ROUNDS * show.round_time:
        remedy = f"A round takes {show.round_time:.3g} s; ask for {MOST_ROUNDS * show.round_time:.3g} s at most."
        raise InvalidValueError("horizon", f"must be at most {MOST_ROUNDS:,} rounds", horizon, remedy)
    if length < show.round_time:
        raise InvalidValueError("horizon", "must be a round at least", horizon, f"One takes {show.round_time:.3g} s.")
    found = _sizes(system, show, tilt, drag, rolling_resistance, wobble, variation, variation_rate)
    count = len(found) + 1

    def run(system: RollingSystem, start: State, done: int) -> Trajectory:
        def tell(fraction: float) -> None:
            if progress is not None:
                progress((done + fraction) / count)

        every = show.round_time / SAMPLES_A_ROUND
        return simulate(system, start, length, every, method, title=title, scenario="", progress=tell)

    rows = []
    for done, (shortcoming, own) in enumerate(found):
        changed = shortcoming.system(show)
        moved = run(changed, show.start(changed), done)
        facts = {name: getattr(shortcoming, name) for name in ("name", "label", "size", "size_text")}
        rows.append(_row({**facts, "own": own}, show, moved, shortcoming.fate(show)))
    perfect = not any(own for _, own in found)
    label, fate = ("nothing wrong", show.fate()) if perfect else ("the scenario as it is", None)
    as_given = {"name": "as-given", "label": label, "size": None, "size_text": "", "own": True}
    given = _row(as_given, show, run(system, first, count - 1), fate)
    return Sensitivity(
        title,
        show.rim,
        length,
        show.round_time,
        show.fate().radius(0.0),
        abs(show.fate().centre(0.0)),
        tuple(sorted(rows, key=lambda row: row.rank)),
        given,
    )


def _read(scenario: Any, start: State | None) -> tuple[RollingSystem, State, str]:
    if isinstance(scenario, RollingSystem):
        if not isinstance(start, State):
            raise InvalidValueError("start", "must be a State beside a system", start, "See system.place(...).")
        return scenario, start, "Ball on a turntable"
    if start is not None:
        raise InvalidValueError("start", "belongs to a system; a scenario has its own", start, "Leave it out.")
    read = scenario if isinstance(scenario, ScenarioFile) else Scenario.load(scenario)
    return read.system(), read.start_state(), read.title


def _sizes(
    system: RollingSystem,
    show: Demonstration,
    tilt: Any,
    drag: Any,
    rolling_resistance: Any,
    wobble: Any,
    variation: Any,
    variation_rate: Any,
) -> list[tuple[Shortcoming, bool]]:
    """Return the shortcomings, each with whether its size is the scenario's own: given, the scenario's, or usual."""
    support, motion = system.support, system.support.motion
    air = [load for load in system.loads if isinstance(load, Drag)]
    still = sum(float(load.coefficient) for load in air if load.air == 0)
    turning = sum(float(load.coefficient) for load in air if load.air != 0)
    rolling = sum(float(load.offset) for load in system.loads if isinstance(load, RollingResistance))
    askew = motion.angle if isinstance(motion, Wobble) else 0.0
    uneven = motion.variation if isinstance(motion, UnevenSpin) else 0.0
    period = motion.variation_rate if isinstance(motion, UnevenSpin) else abs(show.rate)
    radius = float(system.body.shape.radius)  # type: ignore[attr-defined]

    def size(
        key: str, given: Any, own: float, usual: Callable[[], float], check: Callable[..., float], kind: str
    ) -> Any:
        if given is not None:
            return check(given, kind, key), False
        return (float(own), True) if own else (usual(), False)

    def usual_drag(rate: float) -> Callable[[], float]:
        return lambda: air_drag(radius, show.speed_in_air(rate))

    leaning, leans = size("tilt", tilt, support.tilt, lambda: LEANING, checks.real, "angle")
    support.surface.check_tilt(leaning, tilt)
    calm, is_calm = size("drag", drag, still, usual_drag(0.0), checks.non_negative, "damping")
    carried, is_carried = size("drag", drag, turning, usual_drag(show.rate), checks.non_negative, "damping")
    ahead, resists = size(
        "rolling_resistance", rolling_resistance, rolling, lambda: RESISTANCE * radius, checks.non_negative, "length"
    )
    angle, wobbles = size("wobble", wobble, askew, lambda: ASKEW, checks.real, "angle")
    share, varies = size("variation", variation, uneven, lambda: VARIATION, checks.real, "number")
    if variation_rate is not None:
        period = checks.positive(variation_rate, "angular velocity", "variation_rate")
    return [
        (Tilt(leaning), leans),
        (StillAir(calm), is_calm),
        (TurningAir(carried), is_carried),
        (Resistance(ahead), resists),
        (Askew(angle), wobbles),
        (Uneven(share, float(period)), varies),
    ]


def _row(facts: dict[str, Any], show: Demonstration, run: Trajectory, fate: Fate | None) -> Row:
    times = run.data.time.values
    begin, end = float(times[0]), float(times[-1])
    leaves = run.events[-1].time - begin if run.events and run.events[-1].kind == "rim" else None
    found = {**facts, "leaves": leaves, "motion": measure(run, show.kappa, show.rate), "run": run}
    if fate is None:
        return Row(**found)
    span = end - begin
    moved = CircleMotion(
        abs(fate.centre(span) - fate.centre(0.0)) / span, (fate.radius(span) - fate.radius(0.0)) / span
    )
    until = span if leaves is None else 2 * span
    return Row(**found, theory_leaves=fate.leaves(show.rim, until), theory_motion=moved, theory=fate.saying)
