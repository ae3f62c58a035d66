"""Lyapunov exponents of a motion, through its events."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InvalidValueError, SolverError
from ...mechanics import checks
from ...mechanics.system import RollingSystem, State
from ...simulation.labels import PHASES
from ...solve.contact_state import ContactState
from ...solve.samples import Array, Progress, Samples
from ...solve.transitions import PhaseStart
from .asked import Asked, checked_count, integrator, scale_of
from .neutral import Neutral, neutral
from .spectrum import LyapunovExponents
from .tangents import Growth, TangentRun, beginning, tangents

if TYPE_CHECKING:
    import xarray

_BLOCKS = 10
_STUDENT = 2.262  # 95 %, nine degrees of freedom
_LEAST = 40  # stretches: from fewer no error can be told
_MOST = 20_000  # stretches, unless more are asked for
_LOOKS = 7  # instants at which it is asked which moves are neutral
_POWER = 3  # of the time, by which something without an exponent may grow
_ROUNDING = 1e-12  # of the rate at which the motion changes


def lyapunov_exponents(
    system: Any,
    start: State | None = None,
    duration: Any = None,
    *,
    every: Any = None,
    count: int | None = None,
    transient: Any = None,
    method: str = "auto",
    tolerance: float | None = None,
    progress: Progress | None = None,
) -> LyapunovExponents:
    """Return the Lyapunov exponents of a motion: the rates at which nearby motions part from it, or come nearer.

    Small differences of the state are followed by the variational equations, through all events (Leine and Nijmeijer's
    saltation matrices), and made orthonormal by QR time and again. They keep to the constraints: of a body that rolls
    there are eight, of one that slips ten, of one in flight twelve, and two more for a support on a free axle.

    The error of an exponent is the half-width of the 95 % interval from the means of ten blocks of the time, and the
    difference between the means of both halves of it, together. An exponent so small that it may be a growth by a power
    of the time, up to the third, has one more share: what a growth in proportion to the time seems to be. No error
    knows of what the motion has not yet come to.

    Parameters
    ----------
    system : RollingSystem, Scenario, str or path
        A system, a scenario, the name of one that ships, or a file.
    start : State, optional
        Absent: the scenario's, or ``system.place()``.
    duration : float or quantity, optional
        How long to follow the motion, s; absent: as long as the scenario runs.
    every : float or quantity, optional
        When the differences are made orthonormal, s; absent: once in the time in which the motion changes.
    count : int, optional
        How many exponents, the largest; absent: all of them.
    transient : float or quantity, optional
        How much of the time at the beginning is left out of the means, s; absent: a tenth.
    method : str
        "taylor", "runge-kutta", or "auto", the first where it is to be had.
    tolerance : float, optional
        Of the method; absent: its own.
    progress : callable, optional
        Told the fraction done, 0 to 1.

    Returns
    -------
    LyapunovExponents
        With errors, with the mean divergence of the law that they must sum up to, and with the count of those that must
        be zero: one for the flow, for each symmetry and for each first integral.

    Raises
    ------
    InvalidValueError
        If a number is refused, or the duration is too short for an error to be told.
    SolverError
        If the motion starts at an event, rests, ends so soon that no error can be told, or has no derivative because an
        event is only just reached.

    Source: Benettin et al. [benettin1980]; for rolling, Borisov et al. [borisov2012].

    Examples
    --------
    >>> import trundle as tr
    >>> bowl = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> found = tr.lyapunov_exponents(bowl, bowl.place(position=(0.2, 0.0), velocity=(0.0, 0.9)), "60 s")
    >>> found.dimension, found.positive, found.passed
    (8, 0, True)
    """
    asked = Asked.of(system, start)
    length = asked.duration(duration)
    now = beginning(asked.system, asked.start)
    at = ContactState.of(asked.system, asked.start)
    rate = 1 / at.moment(asked.system)
    scale = scale_of(asked.system, now.law, at.arm, rate)
    basis = tangents(asked.system, now, scale)
    dimension = basis.shape[1]
    columns = (basis @ _mixed(dimension))[:, : checked_count(count, dimension)]
    step = max(1 / rate, length / _MOST) if every is None else float(checks.positive(every, "time", "every"))
    left_out = None if transient is None else float(checks.non_negative(transient, "time", "transient"))
    times = asked.start.time + np.linspace(0.0, length, max(1, int(np.ceil(length / step - 1e-9))) + 1)[1:]
    integrate, error = integrator(asked.system, method, tolerance, asked.start.time, float(times[-1]))
    run = TangentRun(integrate, asked.system, times, now, columns, at.arm, rate)
    samples = run.solve(asked.start, error, progress)
    run.finished()
    left_out = 0.1 * (run.growth[-1].time - asked.start.time) if left_out is None else left_out
    _check_long_enough(run.growth, samples, left_out)
    zeros = _zeros(asked.system, now, samples, basis, scale)
    zeros = replace(zeros, count=max(0, zeros.count - len(run.lost)), lost=len(run.lost))
    return _told(asked, run, samples, length, left_out, dimension, zeros)


def _mixed(dimension: int) -> Array:
    """Return a rotation, the same each time: no difference begins along a direction that keeps to itself."""
    return np.linalg.qr(np.random.default_rng(1980).normal(size=(dimension, dimension)))[0]


def _check_long_enough(growth: list[Growth], samples: Samples, left_out: float) -> None:
    """Refuse a motion that is too short for an error to be told."""
    end = growth[-1].time
    kept = sum(one.time >= growth[0].time + left_out for one in growth)
    if kept >= _LEAST and end > growth[0].time + left_out:
        return
    said = (
        f"Of {end - growth[0].time:.6g} s {left_out:.6g} s are left out: {kept} times the differences were made "
        f"orthonormal, and an error needs {_LEAST}."
    )
    last = samples.events[-1] if samples.events else None
    if last is not None and last.final:
        raise SolverError(f"The motion {last.text}. {said} Begin it elsewhere, or give a shorter `every`.")
    remedy = f"{said} Follow it for longer, or give a shorter `every`."
    raise InvalidValueError("duration", "must be long enough for an error", f"{end - growth[0].time:.6g} s", remedy)


def _zeros(system: RollingSystem, now: PhaseStart, samples: Samples, basis: Array, scale: Array) -> Neutral:
    """Return which exponents must be zero."""
    law = now.law
    alike = np.flatnonzero(samples.phase == law.code)
    chosen = alike[np.unique(np.linspace(0, alike.size - 1, _LOOKS).astype(int))] if alike.size else alike
    states = [np.array(now.state_vector, dtype=float)]
    states += [np.array(law.state_vector(ContactState.of(system, samples.state(int(i))))) for i in chosen]
    times = np.array([now.time, *samples.time[chosen]])
    phases = dict.fromkeys([PHASES[law.code], *(PHASES[int(code)] for code in np.unique(samples.phase))])
    return neutral(system, law, times, np.array(states), basis, scale, tuple(phases), changes=bool(samples.events))


def _told(
    asked: Asked,
    run: TangentRun,
    samples: Samples,
    length: float,
    left_out: float,
    dimension: int,
    zeros: Neutral,
) -> LyapunovExponents:
    """Return the exponents in descending order, with what there is to say of them."""
    since = np.array([one.time for one in run.growth]) - asked.start.time
    logs = np.array([one.logs for one in run.growth])
    reached = float(since[-1])
    values, errors = means(since, logs, left_out, _ROUNDING * run.rate)
    order = np.argsort(-values, kind="stable")
    last = samples.events[-1] if samples.events else None
    return LyapunovExponents(
        asked.title,
        asked.system,
        asked.start,
        values[order],
        errors[order],
        reached,
        length,
        left_out,
        run.between / reached,
        run.volume / reached,
        run.across / reached,
        dimension,
        zeros,
        run.rate,
        last.text if last is not None and last.final else "",
        len(samples.events),
        _dataset(asked, since[1:], logs[1:, order]),
    )


def means(since: Array, logs: Array, left_out: float, rounding: float) -> tuple[Array, Array]:
    """Return the mean rates of growth behind the transient, and their errors.

    Examples
    --------
    What grows in proportion to the time has no exponent, and the error says so:

    >>> time = np.linspace(0.0, 100.0, 1001)
    >>> value, error = means(time, np.log(1 + time)[:, None], 10.0, 0.0)
    >>> bool(0 < value[0] < error[0])
    True
    """
    with np.errstate(invalid="ignore"):

        def at(instant: Array) -> Array:
            return np.stack([np.interp(instant, since, column) for column in logs.T], axis=-1)

        edges = np.linspace(left_out, since[-1], _BLOCKS + 1)
        blocks = np.diff(at(edges), axis=0) / np.diff(edges)[:, None]
        values = blocks.mean(axis=0)
        spread = _STUDENT * blocks.std(axis=0, ddof=1) / np.sqrt(_BLOCKS)
        first, second = blocks[: _BLOCKS // 2].mean(axis=0), blocks[_BLOCKS // 2 :].mean(axis=0)
        in_proportion = np.log(since[-1] / max(left_out, 0.1 * since[-1])) / (since[-1] - left_out)
        by_power = np.abs(values) <= _POWER * in_proportion
        errors = spread + np.abs(second - first) + np.where(by_power, in_proportion, 0.0) + rounding
    gone = ~np.isfinite(logs[-1])
    return np.where(gone, -np.inf, values), np.where(gone, 0.0, errors)


def _dataset(asked: Asked, since: Array, logs: Array) -> xarray.Dataset:
    import xarray

    about = {"long_name": "running mean of the exponent, from the start", "units": "s-1"}
    positive = since > 0
    return xarray.Dataset(
        {"running_mean": (("time", "exponent"), logs[positive] / since[positive, None], about)},
        coords={
            "time": ("time", asked.start.time + since[positive], {"long_name": "time", "units": "s"}),
            "exponent": np.arange(1, logs.shape[1] + 1),
        },
        attrs={"title": asked.title},
    )
