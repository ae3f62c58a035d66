"""Maps over a grid of starts: how fast neighbours have parted by a time, and where each start ends up."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Headline, Markup, Plottable, pairs
from ...errors import InvalidValueError, TrundleError
from ...mechanics import checks
from ...mechanics.duals import Dual, slopes_of
from ...mechanics.system import RollingSystem, State
from ...solve.contact_state import ContactState
from ...solve.samples import Array, Progress
from ..many import simulate_many
from ..sensitivities.following import VariationalRun
from .asked import Asked, integrator, scale_of
from .tangents import beginning, tangents

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

Place = Callable[..., State]


@dataclass(frozen=True, repr=False)
class StartMap(Plottable):
    """A figure for each start of a grid.

    Parameters
    ----------
    name : str
        Of the variable in `data`: "exponent" or "basin".
    duration : float
        s.
    classes : tuple of str
        What the numbers of a basin stand for; empty for exponents.
    data : xarray.Dataset
        Over the quantities of the grid, with `reason`: why a start has no figure, or ended early.

    Examples
    --------
    See `lyapunov_map` and `basins_of_attraction`.
    """

    name: str
    duration: float
    classes: tuple[str, ...]
    data: xarray.Dataset = field(compare=False)

    @property
    def shares(self) -> dict[str, float]:
        """The share of the starts in each basin."""
        values = self.data[self.name].values
        return {name: float((values == i).mean()) for i, name in enumerate(self.classes)}

    @property
    def _words(self) -> str:
        shape = " × ".join(str(size) for size in self.data[self.name].shape)
        if self.classes:
            return f"{len(self.classes)} basins on a grid of {shape} starts"
        return f"largest exponent over {self.duration:.6g} s on a grid of {shape} starts"

    @property
    def _facts(self) -> list[tuple[str, str]]:
        if self.classes:
            return [(name, f"{share:.2%}") for name, share in self.shares.items()]
        values = self.data[self.name].values
        known = values[np.isfinite(values)]
        facts = [("from", f"{known.min():.6g} 1/s"), ("to", f"{known.max():.6g} 1/s")] if known.size else []
        return [*facts, ("without", str(values.size - known.size))]

    def __str__(self) -> str:
        return "\n".join([self._words, *(f"{name}: {fact}" for name, fact in self._facts)])

    def _headline(self) -> Headline:
        return Headline("", self._words)

    def _parts(self) -> Iterator[Markup]:
        yield pairs(self._facts)

    def plot(self) -> Figure:
        """Draw the map of two quantities, or the curve of one."""
        from matplotlib.colors import BoundaryNorm, ListedColormap
        from matplotlib.figure import Figure

        from ...views.plots.sheet import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION

        values = self.data[self.name]
        figure = Figure(figsize=(6.5, 5.0), layout="constrained")
        panel = figure.subplots()
        panel.set_xlabel(str(values.dims[0]))
        if values.ndim == 1:
            panel.plot(values[values.dims[0]].values, values.values, ".-", color=BLUE)
            panel.set_ylabel("basin" if self.classes else "exponent, 1/s")
            return figure
        panel.set_ylabel(str(values.dims[1]))
        x, y = (values[dim].values for dim in values.dims)
        if self.classes:
            house = itertools.cycle((BLUE, ORANGE, GREEN, PURPLE, SKY, VERMILION))
            colours = list(itertools.islice(house, len(self.classes)))
            norm = BoundaryNorm(np.arange(len(colours) + 1) - 0.5, len(colours))
            shown = panel.pcolormesh(x, y, values.values.T, cmap=ListedColormap(colours), norm=norm)
            bar = figure.colorbar(shown, ticks=range(len(self.classes)))
            bar.ax.set_yticklabels(self.classes)
        else:
            shown = panel.pcolormesh(x, y, values.values.T, cmap="cividis")
            figure.colorbar(shown, label="exponent, 1/s")
        return figure


def lyapunov_map(
    system: RollingSystem,
    over: Mapping[str, Sequence[float]],
    place: Place,
    duration: Any,
    *,
    tolerance: float | None = None,
    progress: Progress | None = None,
) -> StartMap:
    """Return the largest finite-time Lyapunov exponent of each start of a grid.

    It is the logarithm of how much the difference has grown that grows most, over the time: of the largest singular
    value of the state's slopes by the start.

    Parameters
    ----------
    system : RollingSystem
        What moves.
    over : mapping of str to sequence of float
        One or two quantities and their values.
    place : callable
        Takes one value of each, by name; returns the start.
    duration : float or quantity
        s.
    tolerance : float, optional
        Of the method; absent: its own.
    progress : callable, optional
        Told the fraction done, 0 to 1.

    Returns
    -------
    StartMap
        `exponent`, 1/s; not a number, with its `reason`, where a start is refused or ends early.

    Raises
    ------
    InvalidValueError
        If the grid is refused.

    Examples
    --------
    Near the top of a dome neighbours part as fast as anywhere:

    >>> import trundle as tr
    >>> dome = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), tr.Support(tr.Dome(0.2)))
    >>> found = tr.lyapunov_map(dome, {"x": [0.0, 0.02]}, lambda x: dome.place(position=(x, 0.0)), "0.4 s")
    >>> found.data.exponent.dims
    ('x',)
    """
    names, grid = _grid(over)
    length = float(checks.positive(duration, "time", "duration"))
    values, reasons = np.full(len(grid), np.nan), [""] * len(grid)
    for i, row in enumerate(grid):
        try:
            start = place(**dict(zip(names, row, strict=True)))
            values[i] = _finite_time_exponent(system, start, length, tolerance)
        except TrundleError as error:
            reasons[i] = str(error)
        if progress is not None:
            progress((i + 1) / len(grid))
    about = {"long_name": f"largest Lyapunov exponent over {length:g} s", "units": "s-1"}
    return StartMap("exponent", length, (), _dataset("exponent", over, values, reasons, about))


def _finite_time_exponent(system: RollingSystem, start: State, length: float, tolerance: float | None) -> float:
    """Return the growth of the difference that grows most, 1/s."""
    asked = Asked.of(system, start)
    now, at = beginning(system, asked.start), ContactState.of(system, asked.start)
    rate, end = 1 / at.moment(system), start.time + length
    scale = scale_of(system, now.law, at.arm, rate)
    columns = tangents(system, now, scale)
    rows = scale[:, None] * columns
    seeds: Any = [Dual(float(y), tuple(row)) for y, row in zip(now.state_vector, rows.tolist(), strict=True)]
    integrate, error = integrator(system, "auto", tolerance, start.time, end)
    run = VariationalRun(integrate, system, np.array([end]), system, replace(now, state_vector=seeds), columns.shape[1])
    samples = run.solve(start, error, None)
    if samples.events and samples.events[-1].final:
        raise InvalidValueError("duration", "must not outlast the motion", length, f"It {samples.events[-1].text}.")
    law, _, state = run.here
    slopes = np.array([slopes_of(one, run.count) for one in state], dtype=float)
    slopes /= scale_of(system, law, at.arm, rate)[:, None]
    return float(np.log(np.linalg.svd(slopes, compute_uv=False)[0]) / length)


def basins_of_attraction(
    system: RollingSystem,
    over: Mapping[str, Sequence[float]],
    place: Place,
    duration: Any,
    *,
    kind: Callable[[xarray.Dataset], str] | None = None,
    apart: Any = None,
    workers: int | None = 1,
    progress: Progress | None = None,
) -> StartMap:
    """Return where each start of a grid ends up.

    Parameters
    ----------
    system : RollingSystem
        What moves.
    over : mapping of str to sequence of float
        One or two quantities and their values.
    place : callable
        Takes one value of each, by name; returns the start.
    duration : float or quantity
        Long enough for the motions to settle, s.
    kind : callable, optional
        Takes one member of the runs, as `simulate_many` returns them, and returns the name of its class. Absent: what
        ended it early, else the place at which it ends.
    apart : float or quantity, optional
        Places no further apart are one, m; absent: a twentieth of how far the ends are spread.
    workers : int, optional
        As for `simulate_many`.
    progress : callable, optional
        Told the fraction done, 0 to 1.

    Returns
    -------
    StartMap
        `basin`, the number of the class in `classes`, which are in the order in which the grid comes to them.

    Raises
    ------
    InvalidValueError
        If the grid is refused.

    Examples
    --------
    A ball with drag in a double trough settles in one or the other:

    >>> import trundle as tr
    >>> surface = tr.HeightField("2*(x**2 - 0.04)**2/0.04 + y**2")
    >>> ball = tr.Body.solid_sphere(0.01, 0.05)
    >>> system = tr.RollingSystem(ball, tr.Support(surface), loads=[tr.Drag(0.2)])
    >>> found = tr.basins_of_attraction(
    ...     system, {"x": [-0.3, -0.1, 0.1]}, lambda x: system.place(position=(x, 0.0)), "8 s"
    ... )
    >>> len(found.classes), found.data.basin.values.tolist()
    (2, [0, 0, 1])
    """
    names, grid = _grid(over)
    length = float(checks.positive(duration, "time", "duration"))
    starts = [place(**dict(zip(names, row, strict=True))) for row in grid]
    runs = simulate_many(system, starts, length, length, workers=workers, progress=progress)
    reasons = [str(reason) for reason in runs.reason.values]
    if kind is not None:
        said = [str(kind(runs.isel(member=i))) for i in range(len(grid))]
    else:
        said = _by_end(runs, None if apart is None else float(checks.positive(apart, "length", "apart")))
    classes = tuple(dict.fromkeys(said))
    values = np.array([classes.index(one) for one in said])
    about = {"long_name": "basin of attraction", "units": "1", "flag_values": list(range(len(classes)))}
    return StartMap("basin", length, classes, _dataset("basin", over, values, reasons, about))


def _by_end(runs: xarray.Dataset, apart: float | None) -> list[str]:
    """Return a name for where each member ends: what ended it early, or a place."""
    ends = runs.position.values[:, -1]
    whole = np.isfinite(ends).all(axis=1)
    limit = 0.05 * float(np.ptp(ends[whole], axis=0).max(initial=0.0)) if apart is None else apart
    places: list[Array] = []
    said = []
    for end, ending, settled in zip(ends, runs.ending.values, whole, strict=True):
        if not settled:
            said.append(str(ending) or "no motion")
            continue
        known = next((one for one in places if np.linalg.norm(one - end) <= max(limit, 1e-9)), None)
        if known is None:
            places.append(end)
            known = end
        said.append(f"({known[0] + 0.0:.3g}, {known[1] + 0.0:.3g}, {known[2] + 0.0:.3g}) m")
    return said


def _grid(over: Mapping[str, Sequence[float]]) -> tuple[list[str], list[tuple[float, ...]]]:
    """Return the names, and all combinations of the values."""
    if not isinstance(over, Mapping) or not 1 <= len(over) <= 2:
        remedy = 'Write for instance {"x": np.linspace(-0.1, 0.1, 21)}.'
        raise InvalidValueError("over", "must name one or two quantities with their values", over, remedy)
    axes = []
    for name, values in over.items():
        axis = np.asarray(values, dtype=float)
        if axis.ndim != 1 or not axis.size or not np.isfinite(axis).all():
            raise InvalidValueError(f"over[{name!r}]", "must hold finite numbers", values)
        axes.append(axis.tolist())
    return list(over), list(itertools.product(*axes))


def _dataset(
    name: str, over: Mapping[str, Sequence[float]], values: Array, reasons: list[str], about: dict[str, Any]
) -> xarray.Dataset:
    import xarray

    shape = tuple(len(axis) for axis in over.values())
    dims = tuple(over)
    return xarray.Dataset(
        {
            name: (dims, values.reshape(shape), about),
            "reason": (dims, np.array(reasons, dtype=object).reshape(shape)),
        },
        coords={key: (key, np.asarray(axis, dtype=float)) for key, axis in over.items()},
    )
