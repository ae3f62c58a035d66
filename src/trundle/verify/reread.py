"""The card of a run whose numbers come from a file that may have changed: nothing in it is taken on trust."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..errors import TrundleError
from ..files import first_line
from ..mechanics.system import RollingSystem, State
from ..solve.methods import Method
from ..solve.samples import FLIGHT, Samples
from . import card
from .bounds import EXACT, Array, bound_of, largest, sizes_of, speed_of, turned_in
from .card import Card, CardFigure, checked

_MOST_RADIANS = 1e7  # that a method follows to check numbers which may be nonsense
_AGAIN, _OTHERS = "the method run again", "the rest of the file"


def card_of_file(
    system: RollingSystem,
    start: State,
    time: Array,
    read: Callable[[], tuple[Samples, Array]],
    method: Method,
    title: str = "",
) -> Card:
    """Check a trajectory as `card` does, and beside it whatever else a file says: its start, phases, slip and events.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("level-turntable-nudged").run()
    >>> slid = run.data.slip_velocity.values + 0.1
    >>> method = Method(run.method, run.tolerance)
    >>> made = card_of_file(run.system, run.start, run.data.time.values, lambda: (run.samples, slid), method)
    >>> [figure.name for figure in made.failures]
    ['the rest of the file']
    """
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore", RuntimeWarning)
            _check_length(system, start, time)
            samples, slip = read()
            there = tuple(event for event in samples.events if event.time <= time[-1])  # of a part of a run
            samples = replace(samples, events=there)
            _check_begin(system, start, samples)
            made = card(system, start, samples, method, title)
            bound = next((one.bound for one in made.figures if one.name == _AGAIN and one.bound), 0.0)
            figure = _others(system, start, samples, slip, method, max(bound, bound_of(method, turned_in(samples))))
    except Exception as error:  # noqa: BLE001  numbers that are no motion may make anything raise anything
        note = f"the run cannot be repeated: {first_line(error)}"
        figure = CardFigure(_AGAIN, float("nan"), "", None, False, note)
        return Card(title, f"{method.name}, as the file says", (figure,))
    return replace(made, figures=(*made.figures, figure))


def _check_length(system: RollingSystem, start: State, time: Array) -> None:
    """Refuse what could not be followed to its end."""
    with_support = float(system.support.motion.fastest_rate)
    turned = max(float(np.linalg.norm(start.angular_velocity)), with_support) * float(time[-1] - start.time)
    if not turned <= _MOST_RADIANS:
        raise TrundleError(f"it would turn by {turned:.2g} rad, more than {_MOST_RADIANS:.0e}")


def _check_begin(system: RollingSystem, start: State, at: Samples) -> None:
    """Refuse samples that do not begin with the start, unless something struck at once."""
    if at.time[0] != start.time or any(event.time <= start.time for event in at.events):
        return
    sizes = {**sizes_of(system, at), "orientation": 1.0}
    for name in ("position", "velocity", "angular_velocity", "orientation"):
        size = sizes[name]
        wanted = np.asarray(getattr(start, name), dtype=float)
        off = float(np.abs(getattr(at, name)[0] - wanted).max())
        if not off <= EXACT * max(size, float(np.abs(wanted).max()), 1e-300):
            raise TrundleError(f"its first sample is not its start: {name} is off by {off:.2g}")


def _others(
    system: RollingSystem, start: State, ours: Samples, slip: Array, method: Method, bound: float
) -> CardFigure:
    """Compare phases, slip, events and the support's own coordinates with those of the method run again."""
    times, places = np.unique(ours.time, return_inverse=True)
    again = method.solve(system, start, times)
    if again.time.size != times.size or [one.kind for one in ours.events] != [one.kind for one in again.events]:
        return checked(_OTHERS, float("inf"), bound, "the method run again ends elsewhere, or has other events")
    theirs, span = again.part(places), max(float(times[-1] - start.time), 1e-300)
    late = [abs(one.time - other.time) / span for one, other in zip(ours.events, again.events, strict=True)]
    near = _near(ours, again, bound * span)
    strange = ~near & (ours.phase != theirs.phase)
    V, carried, u = theirs.speeds(system)
    slips = ~near & ~strange & (ours.phase != FLIGHT)
    off = (slip - (V + carried - u).array())[slips]
    apart = largest(off) / max(speed_of(system, ours), 1e-300) if slips.any() else 0.0
    coordinates = np.abs(ours.support_coordinates - theirs.support_coordinates).max(axis=0, initial=0.0) / np.maximum(
        np.abs(theirs.support_coordinates).max(axis=0), 1e-300
    )
    share = float("inf") if strange.any() else max(apart, *late, *coordinates.tolist(), 0.0)
    note = "phases, slip, events and what the support does: as the method run again gives them"
    return checked(_OTHERS, share, bound, note)


def _near(ours: Samples, again: Samples, slack: float) -> NDArray[np.bool_]:
    """Tell which samples are so near an event that rounding decides on which side of it they are."""
    times = np.sort([event.time for event in (*ours.events, *again.events)])
    if not times.size:
        return np.zeros(ours.time.size, dtype=bool)
    later = np.minimum(np.searchsorted(times, ours.time), times.size - 1)
    nearest = np.minimum(np.abs(times[later] - ours.time), np.abs(times[np.maximum(later - 1, 0)] - ours.time))
    return np.asarray(nearest <= slack)


__all__ = ["card_of_file"]
