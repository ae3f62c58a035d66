"""A measured track: labelled columns in SI, how they were read, and what was left out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..display import Headline, Markup, Plottable, fold, pairs, paragraph, table
from ..errors import UnknownNameError
from .table import Rejected

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Index = NDArray[np.int_]
TOLD = 6  # rows that are named
_HEADS = ("column", "unit", "from", "values", "without a number")


@dataclass(frozen=True, repr=False)
class Track(Plottable):
    """What was measured of a moving body, and how it was read: what `read_track` returns.

    Parameters
    ----------
    data : xarray.Dataset
        Columns along `time` (s, ascending) under trundle's names, in SI: x, y, z, vx, ..., wx, ..., angle, qw, ...; NaN
        where there is no number. Each has the attributes `units` and `heading`, as it stood in the file; the
        coordinate `row` is the number of the row in it.
    name : str
        Of the track in the file; may be empty.
    source : str
        The file, or the title of the run.
    format : str
        What kind of file it is.
    frame : str
        "support", "world" or "corotating".
    axes : str
        "space" or "body": along which Ω has its components.
    clauses : tuple of str
        How it was read: what was taken for what, how many rows, and the like.
    rejected : tuple of Rejected
        Rows that were not taken, each with its number and the reason.
    left_out : mapping from str to str
        Headings of columns that were not taken -> why.
    counted : str
        What numbers of rows count: line, row or frame.
    provenance : mapping
        Digest (SHA-256) and size of the file, its format and the options of the reading.

    Examples
    --------
    >>> import trundle as tr
    >>> track = tr.read_track({"t": [0.0, 0.1, 0.2], "x": [0.0, 1.0, 2.0], "y": [0.0, 0.0, 0.0]})
    >>> print(track.taken)
    t from column `t`, x, y in m, 3 rows, no gaps, 10 samples a second
    """

    data: xarray.Dataset
    name: str = ""
    source: str = ""
    format: str = ""
    frame: str = "support"
    axes: str = "space"
    clauses: tuple[str, ...] = ()
    rejected: tuple[Rejected, ...] = ()
    left_out: Mapping[str, str] = field(default_factory=dict)
    counted: str = "row"
    provenance: Mapping[str, Any] = field(default_factory=dict)

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of what was measured, without the time."""
        return tuple(str(name) for name in self.data.data_vars)

    @property
    def time(self) -> Array:
        """The times of the rows, s, ascending; shape (n,)."""
        return np.asarray(self.data["time"].values, dtype=float)

    def __len__(self) -> int:
        return int(self.data.sizes["time"])

    def __getitem__(self, column: str) -> Array:
        """Return one column in SI, of shape (n,), NaN where there is no number."""
        if column in ("t", "time"):
            return self.time
        if column not in self.columns:
            raise UnknownNameError("column of this track", column, ["t", *self.columns])
        return np.asarray(self.data[column].values, dtype=float)

    def whole(self, *columns: str) -> dict[str, Array]:
        """Return the time and some columns, without the rows in which one of them has no number.

        Parameters
        ----------
        *columns : str
            Their names; none: all.

        Returns
        -------
        dict from str to array (m,)
            By name, "t" the first.

        Raises
        ------
        UnknownNameError
            If there is no such column.

        Examples
        --------
        >>> import trundle as tr
        >>> track = tr.read_track({"t": [0.0, 0.1, 0.2], "x": [0.0, float("nan"), 2.0], "y": [0.0, 0.0, 0.0]})
        >>> track.whole("x", "y")["t"].tolist()
        [0.0, 0.2]
        """
        found = {"t": self.time} | {name: self[name] for name in columns or self.columns}
        kept = np.all([np.isfinite(array) for array in found.values()], axis=0)
        return {name: array[kept] for name, array in found.items()}

    def plot(self) -> Figure:
        """Draw the path where x and y were measured, and each column over time.

        Examples
        --------
        >>> import trundle as tr
        >>> track = tr.read_track({"t": [0.0, 0.1, 0.2], "x": [0.0, 1.0, 2.0], "y": [0.0, 0.0, 0.0]})
        >>> [axes.get_ylabel() for axes in track.plot().axes]
        ['y (m)', 'x (m)', 'y (m)']
        """
        from .figure import draw

        return draw(self)

    def _headline(self) -> Headline:
        return Headline(" · ".join(filter(None, (self.source, self.name))) or "a track", self.taken)

    def _columns(self) -> list[tuple[str, str, str, str, str]]:
        """Return a line for each column: name, unit, heading, extent, and how many rows have no number."""
        shown = []
        for name in self.columns:
            values, attributes = self[name], self.data[name].attrs
            some = values[np.isfinite(values)]
            extent = f"{some.min() + 0.0:.6g} to {some.max() + 0.0:.6g}" if some.size else "no number"
            empty = str(values.size - some.size)
            shown.append((name, str(attributes["units"]), str(attributes["heading"]), extent, empty))
        return shown

    @property
    def taken(self) -> str:
        """How it was read, in a sentence."""
        return ", ".join(self.clauses)

    @property
    def left_out_rows(self) -> str:
        """Which rows were not taken and why, in a sentence that names the first of them; empty if all were."""
        return f"{', '.join(self.rejections)}." if self.rejected else ""

    @property
    def rejections(self) -> tuple[str, ...]:
        """The same in its clauses."""
        if not self.rejected:
            return ()
        first, *others = (f"{self.counted} {one.row} ({one.reason})" for one in self.rejected[:TOLD])
        rows = "1 row was" if len(self.rejected) == 1 else f"{len(self.rejected)} rows were"
        more = [f"and {len(self.rejected) - TOLD} more"] if len(self.rejected) > TOLD else []
        return (f"{rows} left out: {first}", *others, *more)

    def _parts(self) -> Iterator[Markup]:
        yield table(self._columns(), _HEADS)
        if self.rejected:
            yield paragraph(self.left_out_rows)
        if self.left_out:
            yield paragraph(self._left_out_columns())
        yield fold("where it comes from", pairs([(name, str(value)) for name, value in self.provenance.items()]))

    def _left_out_columns(self) -> str:
        return "Columns left out: " + "; ".join(f"`{name}` ({why})" for name, why in self.left_out.items()) + "."

    def __str__(self) -> str:
        head = self._headline()
        lines = [f"{head.title} ({self.format})" if self.format else head.title, head.words]
        rows = [_HEADS, *self._columns()]
        widths = [max(map(len, cells)) for cells in zip(*rows, strict=True)]
        lines += [
            "  " + "  ".join(f"{cell:<{w}}" for cell, w in zip(row, widths, strict=True)).rstrip() for row in rows
        ]
        lines += [self.left_out_rows] if self.rejected else []
        lines += [self._left_out_columns()] if self.left_out else []
        return "\n".join(lines)
