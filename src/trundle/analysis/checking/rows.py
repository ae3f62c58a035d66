"""Rows without a number: left out with a word, or refused, by their line and column."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...errors import InvalidValueError
from ...tracks import Track
from .slopes import Array

_MOST = 0.5  # of the rows, that may be left out
_TOLD = 6  # lines that are named


def whole_rows(track: Track, needed: Sequence[str]) -> tuple[dict[str, Array], tuple[str, ...]]:
    """Return the time and the columns that are needed, without the rows in which one of them has no number.

    Examples
    --------
    >>> import trundle as tr
    >>> track = tr.read_track({"t": np.arange(4.0), "x": np.array([0.0, np.nan, 2.0, 3.0])})
    >>> kept, remarks = whole_rows(track, ["x"])
    >>> kept["x"].tolist(), remarks
    ([0.0, 2.0, 3.0], ('1 of 4 rows was left out, for want of a number: row 2 (x).',))
    """
    columns = {name: track[name] for name in ("t", *needed)}
    headings = {"t": track.data["time"].attrs["heading"]} | {name: track.data[name].attrs["heading"] for name in needed}
    missing = {headings[name]: np.isnan(array) for name, array in columns.items()}
    rows = track.data["row"].values
    for heading, empty in missing.items():
        if empty.mean() > _MOST:
            first = f"{track.counted} {rows[np.flatnonzero(empty)[0]]}"
            received = f"none in {int(empty.sum())} of {empty.size} rows, {first} the first"
            raise InvalidValueError(heading, "must hold a number in most rows", received, "Leave the column out.")
    bad = np.any(list(missing.values()), axis=0)
    gone = {int(rows[i]): ", ".join(n for n, empty in missing.items() if empty[i]) for i in np.flatnonzero(bad)}
    gone |= {one.row: one.reason for one in track.rejected}
    if not gone:
        return columns, ()
    told = [f"{track.counted} {row} ({why})" for row, why in sorted(gone.items())[:_TOLD]]
    more = f" and {len(gone) - _TOLD} more" if len(gone) > _TOLD else ""
    verb = "was" if len(gone) == 1 else "were"
    count = bad.size + len(track.rejected)
    says = f"{len(gone)} of {count} rows {verb} left out, for want of a number: {', '.join(told)}{more}."
    return {name: array[~bad] for name, array in columns.items()}, (says,)
