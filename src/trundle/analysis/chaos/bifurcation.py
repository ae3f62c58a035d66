"""Bifurcation diagrams: where a motion settles while a number of its system goes up, and down again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Headline, Markup, Plottable, Serializable, pairs
from ...errors import InvalidValueError, TrundleError
from ...mechanics import checks
from ...mechanics.parameters import parameters
from ...mechanics.system import RollingSystem, State
from ...solve.contact_state import ContactState
from ...solve.samples import Array, Progress
from .asked import Asked
from .conditions import Condition, quantities, quantity_of
from .crossings import PoincareMotion
from .returning import number_of, put_down, with_number
from .tangents import beginning

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

WAYS = ("up", "down")
_MOST = 100_000  # motions
_SAME = 1e-4  # of the range of all points: nearer than this they are one
_SHOWN = 64  # the most points at a value that are told apart as a period


@dataclass(frozen=True, repr=False)
class BifurcationDiagram(Plottable, Serializable):
    """The points of a section of a motion that has settled, against a number of the system.

    Parameters
    ----------
    title : str
        Of the scenario; empty where there is none.
    name, unit : str
        Of the number that changes, and its SI unit.
    observed : str
        What is noted at each crossing, such as "velocity.z".
    condition : str
        Of the section.
    data : xarray.Dataset
        `points` over `way` ("up", "down"), `value` and `crossing`, the last crossings at each value, SI, not a number
        where there are fewer; `reason`, why there are none.

    Examples
    --------
    See `bifurcation_diagram`.
    """

    title: str
    name: str
    unit: str
    observed: str
    condition: str
    data: xarray.Dataset = field(compare=False)

    @property
    def ways(self) -> list[str]:
        """The ways that the number went, in order."""
        return [str(way) for way in self.data.way.values]

    @property
    def values(self) -> Array:
        """The values of the number, ascending, SI."""
        return np.asarray(self.data.value.values)

    def periods(self, way: str) -> list[int]:
        """Return after how many crossings the motion repeats at each value.

        Parameters
        ----------
        way : str
            "up" or "down".

        Returns
        -------
        list of int
            0 where it does not repeat within half of the crossings kept.

        Examples
        --------
        See `bifurcation_diagram`.
        """
        points = self.data.points.values
        near = _SAME * float(np.ptp(points[np.isfinite(points)])) if np.isfinite(points).any() else 0.0
        return [_period(row[np.isfinite(row)], near) for row in self.data.points.sel(way=way).values]

    @property
    def hysteresis(self) -> Array:
        """The values at which it matters from where the number came: the motion settles elsewhere, SI."""
        if len(self.ways) < 2:
            return np.empty(0)
        points = self.data.points.values
        near = 10 * _SAME * float(np.ptp(points[np.isfinite(points)])) if np.isfinite(points).any() else 0.0
        return self.values[[_apart(up, down, near) for up, down in zip(*points, strict=True)]]

    def __str__(self) -> str:
        lines = [self.title] if self.title else []
        return "\n".join([*lines, self._words, *(f"{name}: {fact}" for name, fact in self._facts)])

    @property
    def _words(self) -> str:
        return f"{self.observed} of a settled motion, {self.condition}, at {self.values.size} values of {self.name}"

    @property
    def _facts(self) -> list[tuple[str, str]]:
        facts = [(f"repeats after, {way}", _runs(self.values, self.periods(way))) for way in self.ways]
        if self.hysteresis.size:
            where = f"{self.hysteresis.min():.6g} to {self.hysteresis.max():.6g} {self.unit}"
            facts.append(("hysteresis", f"at {self.hysteresis.size} values, {where}"))
        elif len(self.ways) > 1:
            facts.append(("hysteresis", "none seen"))
        return facts

    def _headline(self) -> Headline:
        return Headline(self.title, self._words)

    def _parts(self) -> Iterator[Markup]:
        yield pairs(self._facts)

    def plot(self) -> Figure:
        """Draw the points against the number, those of the way down as open circles.

        Returns
        -------
        matplotlib.figure.Figure
            Needs neither a display nor pyplot.

        Examples
        --------
        See `bifurcation_diagram`.
        """
        from matplotlib.figure import Figure

        from ...views.plots.sheet import BLUE, VERMILION

        figure = Figure(figsize=(7.0, 4.6), layout="constrained")
        panel = figure.subplots()
        styles = {"up": (".", BLUE, BLUE, 3.0), "down": ("o", VERMILION, "none", 5.0)}
        for way in self.ways:
            points = self.data.points.sel(way=way).values
            mark, edge, face, size = styles[way]
            across = np.repeat(self.values, points.shape[1])
            panel.plot(across, points.ravel(), mark, ms=size, mec=edge, mfc=face, mew=0.6, ls="none", label=way)
        unit = str(self.data.points.attrs["units"])
        panel.set_xlabel(f"{self.name}, {self.unit}")
        panel.set_ylabel(f"{self.observed}, {unit}")
        panel.set_title(self.condition, fontsize=10, loc="left")
        if len(self.ways) > 1:
            panel.legend(title=f"{self.name} goes", fontsize=9)
        figure.suptitle(self.title, fontsize=11)
        return figure

    def as_dict(self) -> dict[str, Any]:
        """Return what is said of the diagram, and its points, in SI units.

        Returns
        -------
        dict
            As JSON takes it.

        Examples
        --------
        See `bifurcation_diagram`.
        """
        points = {
            way: [row[np.isfinite(row)].tolist() for row in self.data.points.sel(way=way).values] for way in self.ways
        }
        return {
            "title": self.title,
            "name": self.name,
            "unit": self.unit,
            "observed": self.observed,
            "condition": self.condition,
            "values": self.values.tolist(),
            "points": points,
            "periods": {way: self.periods(way) for way in self.ways},
            "hysteresis": self.hysteresis.tolist(),
        }


def bifurcation_diagram(
    system: Any,
    along: str,
    values: Sequence[Any],
    observe: str,
    section: Any = None,
    start: State | None = None,
    *,
    period: Any = None,
    settle: Any = None,
    duration: Any = None,
    ways: Sequence[str] = WAYS,
    keep: int = _SHOWN,
    method: str = "auto",
    tolerance: float | None = None,
    progress: Progress | None = None,
) -> BifurcationDiagram:
    """Return where a motion settles while a number of its system goes up, and then down again.

    At each value the motion goes on from where it was at the one before, so that it stays on its branch as long as that
    attracts: what differs between the two ways is hysteresis. `PeriodicOrbit.along` follows unstable branches, too.

    Parameters
    ----------
    system : RollingSystem, Scenario, str or path
        A system, a scenario, the name of one that ships, or a file.
    along : str
        The number that changes, such as "support.motion.amplitude.z"; an unknown one is answered with all there are.
    values : sequence of float or quantity
        That it takes; they are gone through in ascending order, and back.
    observe : str
        What is noted at each crossing: a scalar quantity of a run's dataset, such as "velocity.z".
    section : str or callable, optional
        As for `poincare_section`.
    start : State, optional
        Of the first value of the first way; absent: the scenario's, or ``system.place()``.
    period : float or quantity, optional
        Instead of a section: a stroboscope, once in each period of the support, s.
    settle : float or quantity, optional
        How long the motion may settle at each value, s; absent: half of the duration.
    duration : float or quantity, optional
        How long it is followed at each value, s; absent: as long as the scenario runs.
    ways : sequence of str
        "up", "down", or both in the order in which they are gone.
    keep : int
        The last so many crossings at each value are kept.
    method, tolerance : optional
        As for `poincare_section`.
    progress : callable, optional
        Told the fraction done, 0 to 1.

    Returns
    -------
    BifurcationDiagram
        The points, the periods, and where there is hysteresis.

    Raises
    ------
    InvalidValueError
        If a number is refused.
    UnknownNameError
        If there is no such number or quantity.

    Examples
    --------
    A ball in a bowl that is shaken sideways, seen once in each period, climbs higher the harder the bowl is shaken:

    >>> import math
    >>> import trundle as tr
    >>> bowl = tr.Support(tr.Bowl(0.5), motion=tr.Shake((0.001, 0.0, 0.0), 10.0))
    >>> ball = tr.RollingSystem(tr.Body.solid_sphere(0.01, 0.03), bowl, loads=(tr.Drag(0.1),))
    >>> found = tr.bifurcation_diagram(
    ...     ball, "support.motion.amplitude.x", [0.001, 0.002], "position.x", period=math.pi / 5, duration="60 s"
    ... )
    >>> found.periods("up"), found.hysteresis.size
    ([1, 1], 0)
    """
    asked = Asked.of(system, start)
    length = asked.duration(duration)
    which, _, unit = number_of(asked.system, along)
    dimension = parameters(asked.system)[which].dimension
    taken = np.sort([float(checks.real(value, dimension, f"values[{i}]")) for i, value in enumerate(values)])
    _check(taken, ways, keep)
    quiet = 0.5 * length if settle is None else float(checks.positive(settle, "time", "settle"))
    if quiet >= length:
        raise InvalidValueError("settle", f"must be shorter than the motion ({length:g} s)", settle)
    strobe = None if period is None else float(checks.positive(period, "time", "period"))
    if (section is None) == (strobe is None):
        rule = "must be given, or `period` instead"
        raise InvalidValueError("section", rule, section, 'Write for instance "land", or a period.')
    if strobe is not None:  # whole periods, so that the next value begins where this one was seen last
        length = strobe * max(1, round(length / strobe))
    quantity_of(asked.system, observe)
    points = np.full((len(ways), taken.size, keep), np.nan)
    reasons = np.full((len(ways), taken.size), "", dtype=object)
    here, now = asked.system, asked.start
    said = f"once in {strobe:.9g} s" if strobe is not None else ""
    for i, way in enumerate(ways):
        order = range(taken.size) if way == "up" else range(taken.size - 1, -1, -1)
        for done, j in enumerate(order):
            there = with_number(asked.system, which, float(taken[j]))
            try:
                now, here = _carried(here, there, now), there
                motion = PoincareMotion(Asked(asked.title, there, now), length, method, tolerance)
                found, said = _seen(motion, section, strobe, quiet, observe)
                points[i, j, : min(keep, found.size)] = found[-keep:]
                now = motion.last
            except TrundleError as error:  # it begins anew at the next value
                reasons[i, j] = str(error).partition("\n")[0]
                here, now = asked.system, asked.start
            if progress is not None:
                progress((i * taken.size + done + 1) / (len(ways) * taken.size))
    return BifurcationDiagram(
        asked.title, along, unit, observe, said, _labelled(asked.system, points, reasons, taken, ways, observe, unit)
    )


def _check(values: Array, ways: Sequence[str], keep: Any) -> None:
    if values.size < 2 or not np.isfinite(values).all() or np.unique(values).size < values.size:
        raise InvalidValueError("values", "must be two or more, each another", values.tolist()[:6])
    if not ways or any(way not in WAYS for way in ways) or len(set(ways)) < len(ways) or isinstance(ways, str):
        raise InvalidValueError("ways", 'must be "up", "down" or both', ways, 'Write for instance ways=["up"].')
    if isinstance(keep, bool) or not isinstance(keep, int) or keep < 2:
        raise InvalidValueError("keep", "must be a whole number, 2 or more", keep)
    if values.size * len(ways) > _MOST:
        raise InvalidValueError("values", f"must be at most {_MOST // len(ways):,}", values.size)


def _carried(before: RollingSystem, system: RollingSystem, now: State) -> State:
    """Return a state of one system as one of another: rolling where it rolled, and not within the support."""
    if before is not system:
        try:
            phase = beginning(before, now)
            now = put_down(system, phase, np.array(phase.state_vector, dtype=float), now.time)
        except TrundleError:  # at rest, or at an event: as it is
            pass
    at = ContactState.of(system, now)
    return now if at.gap >= 0 else at.over(0.0).state


def _seen(motion: PoincareMotion, section: Any, strobe: float | None, quiet: float, observe: str) -> tuple[Array, str]:
    """Return what is observed at each crossing once the motion has settled, and what the condition is."""
    if strobe is not None:
        found = motion.strobed(strobe)
    else:
        found = motion.crossings(Condition.of(section, motion.asked.system, "rising"), None)
    values = quantity_of(motion.asked.system, observe)[0](found.data)
    late = found.data.time.values > motion.asked.start.time + quiet * (1 - 1e-12)
    return np.asarray(values, dtype=float)[late], found.condition


def _labelled(
    system: RollingSystem, points: Array, reasons: Any, values: Array, ways: Sequence[str], observe: str, unit: str
) -> xarray.Dataset:
    import xarray

    said = {"long_name": quantities(system)[observe][1], "units": quantities(system)[observe][0]}
    return xarray.Dataset(
        {"points": (("way", "value", "crossing"), points, said), "reason": (("way", "value"), reasons)},
        coords={"way": list(ways), "value": ("value", values, {"units": unit})},
    )


def _period(points: Array, near: float) -> int:
    """Return after how many points they repeat; 0 where they do not."""
    for count in range(1, points.size // 2 + 1):
        if np.all(np.abs(points[count:] - points[:-count]) <= near):
            return count
    return 0


def _apart(one: Array, other: Array, near: float) -> bool:
    """Tell whether two sets of points are different: some point of one is far from all of the other."""
    one, other = one[np.isfinite(one)], other[np.isfinite(other)]
    if not (one.size and other.size):
        return bool(one.size or other.size)
    away = np.abs(one[:, None] - other[None])
    irregular = min(one.size, other.size) > 1 and max(np.ptp(one), np.ptp(other)) > 10 * near
    if irregular:  # of clouds of points the extent counts, of which each has a sample
        return bool(
            abs(one.min() - other.min()) > 0.2 * np.ptp(other) or abs(one.max() - other.max()) > 0.2 * np.ptp(other)
        )
    return bool(max(away.min(axis=0).max(), away.min(axis=1).max()) > near)


def _runs(values: Array, periods: Sequence[int]) -> str:
    """Return periods in words, each with the values where it begins: "1 to 0.5, 2 to 0.7"."""
    parts, first = [], 0
    for i in range(1, len(periods) + 1):
        if i == len(periods) or periods[i] != periods[first]:
            name = str(periods[first]) if periods[first] else "none seen"
            parts.append(f"{name} ({values[first]:.6g} to {values[i - 1]:.6g})")
            first = i
    return ", ".join(parts)
