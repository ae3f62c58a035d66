"""What tolerances do: how far a run may be off when some numbers are only known within limits, and which matters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Headline, Markup, Plottable, Serializable, paragraph, table
from ...errors import InvalidValueError
from ...solve.samples import Progress
from .api import sweep
from .figure import in_print
from .measures import DONE
from .result import Sweep

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_QUANTILES = {"least": 0.0, "5 %": 0.05, "median": 0.5, "95 %": 0.95, "largest": 1.0}
_HEADINGS = ("number", "share alone", "share in all")
_NOTHING = 1e-12  # of the largest value: so little spread is rounding


@dataclass(frozen=True, repr=False)
class Tolerance(Plottable, Serializable):
    """How widely a measure is spread when some numbers are only known within limits, and whose doing that is.

    Parameters
    ----------
    measure : str
        What was measured.
    unit : str
        Its SI unit.
    spread : dict of str to float
        Its least value, quantiles and largest, SI.
    shares : dict of str to pair of float
        Of each number: the share of the variance that it makes alone (Sobol's first index), and that in which it has
        any part (the total index). Not numbers where the measure does not vary, or a member has no value.
    sweep : Sweep
        All members.

    Examples
    --------
    >>> import trundle as tr
    >>> found = tr.tolerance("tilted-turntable", {"support.tilt": "1 ± 0.1 deg"}, "end x", members=8, duration="1 s")
    >>> sorted(found.spread)
    ['5 %', '95 %', 'largest', 'least', 'median']
    """

    measure: str
    unit: str
    spread: dict[str, float]
    shares: dict[str, tuple[float, float]]
    sweep: Sweep

    def __str__(self) -> str:
        rows = [_HEADINGS, *self._rows]
        widths = [max(len(row[i]) for row in rows) for i in range(len(_HEADINGS))]
        lines = ["  ".join(f"{cell:<{w}}" for cell, w in zip(row, widths, strict=True)).rstrip() for row in rows]
        return "\n".join([self.sweep.title, self.sentence, *lines])

    @property
    def sentence(self) -> str:
        """The spread in words."""
        unit = in_print(self.unit)
        said = ", ".join(f"{name} {value:.5g}" for name, value in self.spread.items())
        return f"{self.measure}{f' ({unit})' if unit else ''}: {said}; {self.sweep.outcome}"

    @property
    def _rows(self) -> list[tuple[str, ...]]:
        ranked = sorted(self.shares.items(), key=lambda item: -np.nan_to_num(item[1][1]))
        return [(name, *(f"{100 * share:.3g} %" for share in both)) for name, both in ranked]

    def _headline(self) -> Headline:
        return Headline(self.sweep.title, self.sentence)

    def _parts(self) -> Iterator[Markup]:
        yield paragraph(self.sentence)
        yield table(self._rows, _HEADINGS)

    def as_dict(self) -> dict[str, Any]:
        """Return what is said, in SI units.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.tolerance("tilted-turntable", {"gravity": "9.8 ± 0.1 m/s^2"}, "max z", members=4).as_dict()["measure"]
        'max z'
        """
        shares = {
            name: [None if np.isnan(share) else float(share) for share in both] for name, both in self.shares.items()
        }
        return {
            "title": self.sweep.title,
            "measure": self.measure,
            "unit": self.unit,
            **{name: float(value) for name, value in self.spread.items()},
            "shares": shares,
            **self.sweep.counts,
        }

    def plot(self) -> Figure:
        """Draw the measure over each number, and how it is distributed.

        Examples
        --------
        >>> import trundle as tr
        >>> found = tr.tolerance("tilted-turntable", {"support.tilt": "1 ± 0.1 deg"}, "end x", members=8)
        >>> len(found.plot().axes)
        2
        """
        from .figure import draw_marginals

        return draw_marginals(self.sweep, self.measure)


def tolerance(
    scenario: Any,
    over: Mapping[str, Any],
    measure: Any,
    *,
    members: int = 256,
    normal: bool = False,
    seed: int = 0,
    duration: Any = None,
    every: Any = None,
    workers: int | None = 1,
    progress: Progress | None = None,
) -> Tolerance:
    """Return how far a run may be off when some of its numbers are only known within limits.

    Parameters
    ----------
    scenario : Scenario, str or path
        What is run.
    over : mapping of str to values
        What is uncertain, by its key in the scenario: ``"33.3 ± 0.3 rpm"``, or any distribution that `sweep` takes.
    measure : str or callable
        What matters, such as ``"end hypot(x, y)"``: a number that `sweep` measures.
    members : int
        Of each of the sets that are drawn, a power of 2; there are two more sets than numbers.
    normal : bool
        Whether what stands after ± is a standard deviation; else it is a limit, and all between is equally likely.
    seed : int
        Of the draws.
    duration, every : float or quantity, optional
        Instead of the scenario's, s.
    workers : int, optional
        Processes; None: as many as there are processors.
    progress : callable, optional
        Told the fraction done, 0 to 1.

    Returns
    -------
    Tolerance
        The spread of the measure, and each number's share of its variance, by Sobol's indices (Saltelli's estimate in
        `scipy.stats.sobol_indices`).

    Raises
    ------
    InvalidValueError
        As `sweep`; and if the measure is a class, which has no variance.

    Examples
    --------
    A turntable at 33.3 ± 0.3 rpm, level within 0.1°: how far may the ball be after 10 s?

    >>> import trundle as tr
    >>> limits = {"support.motion.rate": "33.3 ± 0.3 rpm", "support.tilt": "0 ± 0.1 deg"}
    >>> found = tr.tolerance("tilted-turntable", limits, "end hypot(x, y)", members=16, duration="10 s", every="1 s")
    >>> list(found.shares)
    ['support.motion.rate', 'support.tilt']
    """
    given = over
    if normal and isinstance(over, Mapping):
        given = {key: {"normal": spec} if isinstance(spec, str) else spec for key, spec in over.items()}
    found = sweep(
        scenario,
        given,
        measure,
        design="variance",
        members=members,
        seed=seed,
        duration=duration,
        every=every,
        workers=workers,
        progress=progress,
    )
    if len(found.measures) != 1:
        raise InvalidValueError("measure", "must be one figure", found.measures, "Ask for each by itself.")
    (name,) = found.measures
    one = found.data[name]
    if "flag_meanings" in one.attrs:
        rule = "must be a number, not a class"
        raise InvalidValueError("measure", rule, name, "Take for instance 'max hypot(x, y)'.")
    drawn = one.values[: 2 * members]  # the two sets that are drawn freely
    there = drawn[np.isfinite(drawn)]
    quantiles = np.quantile(there, list(_QUANTILES.values())) if there.size else np.full(len(_QUANTILES), np.nan)
    spread = dict(zip(_QUANTILES, quantiles.tolist(), strict=True))
    return Tolerance(name, str(one.attrs["units"]), spread, _shares(found, one.values, members), found)


def _shares(found: Sweep, values: Any, members: int) -> dict[str, tuple[float, float]]:
    """Return Sobol's first and total index of each number."""
    from scipy.stats import sobol_indices

    keys = found.over
    done = (found.data.status.values == DONE).all() and np.isfinite(values).all()
    if not done or np.ptp(values) <= _NOTHING * np.abs(values).max():
        return dict.fromkeys(keys, (np.nan, np.nan))
    one, other, *mixed = np.repeat(
        values.reshape(-1, 1, members), 2, axis=1
    )  # twice: of one by one SciPy makes no array
    indices = sobol_indices(func={"f_A": one, "f_B": other, "f_AB": np.stack(mixed)}, n=members)
    first, total = (np.reshape(part, (2, len(keys)))[0] for part in (indices.first_order, indices.total_order))
    return {key: (float(first[i]), float(total[i])) for i, key in enumerate(keys)}
