"""What a sweep returns: all members as one labelled dataset, with their figure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Displayed, Headline, Markup, paragraph, table
from ...errors import UnknownNameError
from .job import Columns
from .measures import OUTCOMES, WAITING
from .plan import Plan
from .store import Store, as_listed, described, plan_of, variables

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from ...simulation.simulate import Scenario

_HEADINGS = ("what", "unit", "least", "median", "largest", "members without")


@dataclass(frozen=True, repr=False)
class Sweep(Displayed):
    """The members of a sweep: what varied, and what was measured.

    The measures can be read off the result itself: `found.far` is `found.dataset.far`.

    Parameters
    ----------
    title : str
        Of the sweep.
    data : xarray.Dataset
        All members in a row, over `member`.

    Examples
    --------
    >>> import trundle as tr
    >>> found = tr.sweep("tilted-turntable", {"gravity": [9.78, 9.83]}, ["end-time"], duration="1 s")
    >>> found
    <Sweep: Steel ball on a tilted turntable, 2 members>
    """

    title: str
    data: xarray.Dataset

    @staticmethod
    def of(plan: Plan, columns: Columns) -> Sweep:
        """Label the columns of a sweep that was kept in memory."""
        import xarray

        from ...simulation import labels

        about = variables(plan)
        filled = {name: (dims, columns[name], said) for name, (dims, said) in about.items()}
        coordinates: dict[str, Any] = {
            axis.key: (("member",), column.astype(np.int8) if axis.words else column.copy(), axis.about)
            for axis, column in zip(plan.axes, plan.table.T, strict=True)
        }
        if plan.keep:
            coordinates |= labels.coordinates(plan.job.times)
        return Sweep(plan.title, xarray.Dataset(filled, coords=coordinates, attrs=described(plan)))

    @staticmethod
    def load(path: Any) -> Sweep:
        """Open the store of a sweep, finished or not; numbers are read as they are used.

        Parameters
        ----------
        path : path
            A Zarr store that a sweep wrote.

        Returns
        -------
        Sweep
            As far as it has come.

        Raises
        ------
        InvalidValueError
            If it is no such store.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> import trundle as tr
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     found = tr.sweep("tilted-turntable", {"gravity": [9.78, 9.83]}, ["end-time"], duration="1 s")
        ...     again = tr.Sweep.load(found.save(pathlib.Path(folder) / "results.zarr"))
        ...     again.dataset["end-time"].values.tolist()
        [1.0, 1.0]
        """
        store = Store.open(Path(path))
        return Sweep(str(store.attributes["title"]), store.dataset())

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return self[name]

    def __getitem__(self, name: str) -> xarray.DataArray:
        """Return a variable of the dataset by its name."""
        if name not in self.dataset.variables:
            raise UnknownNameError("variable of the sweep", str(name), [str(known) for known in self.dataset.variables])
        return self.dataset[name]

    @property
    def over(self) -> list[str]:
        """The keys of what varied."""
        return list(self.data.attrs["over"])

    @property
    def measures(self) -> list[str]:
        """The names of what was measured."""
        return list(self.data.attrs["measured"])

    @property
    def dataset(self) -> xarray.Dataset:
        """All members: a dimension for each number of a grid, else the one dimension `member`."""
        shape = tuple(self.data.attrs["grid"])
        if not shape:
            return self.data
        import xarray

        places = np.unravel_index(np.arange(int(np.prod(shape))), shape)
        coordinates: dict[str, Any] = {}
        for i, key in enumerate(self.over):
            column = self.data[key]
            first = [int(np.argmax(places[i] == place)) for place in range(shape[i])]
            coordinates[key] = ((key,), column.values[first], column.attrs)
        coordinates |= {str(name): one for name, one in self.data.coords.items() if "member" not in one.dims}
        filled = {
            name: ((*self.over, *one.dims[1:]), one.values.reshape(*shape, *one.shape[1:]), one.attrs)
            for name, one in self.data.data_vars.items()
        }
        return xarray.Dataset(filled, coords=coordinates, attrs=self.data.attrs)

    @property
    def counts(self) -> dict[str, int]:
        """How many members are waiting, done, refused, failed."""
        found = np.bincount(self.data.status.values, minlength=len(OUTCOMES))
        return dict(zip(OUTCOMES, found.tolist(), strict=True))

    def member(self, at: Mapping[str, float]) -> Scenario:
        """Return the scenario of the member nearest to some values.

        Parameters
        ----------
        at : mapping of str to float
            Values of what varied, SI, each as near as there is one; absent: any.

        Returns
        -------
        Scenario
            Of one member, to run again.

        Raises
        ------
        UnknownNameError
            If something of that name did not vary.

        Examples
        --------
        >>> import trundle as tr
        >>> found = tr.sweep("tilted-turntable", {"gravity": [9.78, 9.83]}, ["end-time"], duration="1 s")
        >>> found.member({"gravity": 9.9}).gravity
        9.83
        """
        for key in at:
            if key not in self.over:
                raise UnknownNameError("number that varies", str(key), self.over)
        off = np.zeros(self.data.sizes["member"])
        for key, value in at.items():
            column = self.data[key].values.astype(float)
            off += ((column - float(value)) / (np.ptp(column) or 1.0)) ** 2
        place = int(np.argmin(off))
        plan = self._plan
        return plan.job.member(plan.table[place])

    @property
    def _plan(self) -> Plan:
        return plan_of(self.data.attrs, lambda key: as_listed(self.data[key].values, self.data[key].attrs))

    def __str__(self) -> str:
        rows = [_HEADINGS, *self._rows]
        widths = [max(len(row[i]) for row in rows) for i in range(len(_HEADINGS))]
        lines = ["  ".join(f"{cell:<{w}}" for cell, w in zip(row, widths, strict=True)).rstrip() for row in rows]
        return "\n".join([self.title, self.outcome, *lines])

    @property
    def outcome(self) -> str:
        """How many members there are, and what became of those that are not done."""
        counts = self.counts
        rest = [f"{counts[name]:,} {name}" for name in OUTCOMES if name != "done" and counts[name]]
        return ", ".join([f"{sum(counts.values()):,} members", *rest])

    @property
    def _rows(self) -> list[tuple[str, ...]]:
        return [self._row(name) for name in (*self.over, *self.measures)]

    def _row(self, name: str) -> tuple[str, ...]:
        one = self.data[name]
        if "flag_meanings" in one.attrs:
            words, values = one.attrs["flag_meanings"].split(), one.values
            pairs = zip(one.attrs["flag_values"], words, strict=True)
            said = ", ".join(
                f"{word} {int((values == value).sum()):,}" for value, word in pairs if (values == value).any()
            )
            return name, "", said, "", "", ""
        values = one.values[np.isfinite(one.values)]
        low, middle, high = np.quantile(values, [0.0, 0.5, 1.0]) if values.size else (np.nan,) * 3
        without = one.size - values.size
        cells = (f"{float(value):.6g}" for value in (low, middle, high))
        return name, str(one.attrs["units"]), *cells, f"{without:,}" if without else ""

    def _headline(self) -> Headline:
        return Headline(self.title, self.outcome)

    def _parts(self) -> Iterator[Markup]:
        if notes := str(self.data.attrs.get("notes", "")):
            yield paragraph(" ".join(notes.split("\n")).strip())
        yield table(self._rows, _HEADINGS)

    def plot(
        self, measure: str | None = None, *, over: Sequence[str] = (), at: Mapping[str, float] | None = None
    ) -> Figure:
        """Draw a measure over what varied: a line over one number, a map over two, else a panel for each number.

        Parameters
        ----------
        measure : str, optional
            Absent: the first.
        over : sequence of str
            The one or two numbers to draw it over; absent: the first two.
        at : mapping of str to float, optional
            Of a grid over more numbers: where the others are held, SI, as near as there is a value; absent: their
            middle.

        Returns
        -------
        matplotlib.figure.Figure
            Needs neither a display nor pyplot.

        Raises
        ------
        UnknownNameError
            If nothing of that name was measured.

        Examples
        --------
        >>> import trundle as tr
        >>> found = tr.sweep("tilted-turntable", {"gravity": [9.78, 9.83]}, ["end-time"], duration="1 s")
        >>> len(found.plot().axes)
        1
        """
        from .figure import draw

        name = self.measures[0] if measure is None else measure
        if name not in self.measures:
            raise UnknownNameError("measure", str(name), self.measures)
        return draw(self, name, at, tuple(over))

    def save(self, path: Any) -> Path:
        """Write the results to a new Zarr store, whole or not at all.

        Parameters
        ----------
        path : path
            Such as ``"results.zarr"``; it must not exist yet.

        Returns
        -------
        pathlib.Path
            The folder.

        Raises
        ------
        InvalidValueError
            If it exists, or is in no folder.

        Examples
        --------
        See `load`.
        """
        plan = self._plan
        store = Store.create(Path(path), plan)
        names = [str(name) for name in self.data.data_vars]
        for chunk in range(plan.chunks):
            where = slice(chunk * plan.chunk, min((chunk + 1) * plan.chunk, plan.members))
            part = self.data.isel(member=where)
            store.write(where, {name: part[name].values for name in names})
        return store.path


def waiting(data: xarray.Dataset) -> bool:
    """Tell whether some members have not been run yet.

    Examples
    --------
    >>> import trundle as tr
    >>> waiting(tr.sweep("tilted-turntable", {"gravity": [9.8]}, ["end-time"], duration="1 s").data)
    False
    """
    return bool((data.status.values == WAITING).any())
