"""A motion as a table of numbers, which any program reads, `trundle check` among them."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray

_ROWS = 50_000  # written at once


def csv_of(data: xarray.Dataset) -> bytes:
    """Return labelled arrays as CSV: a column for each component, its unit in brackets behind its name.

    Examples
    --------
    >>> import trundle as tr
    >>> csv_of(tr.Scenario.load("level-turntable-nudged").run().data).split(b",")[:3]
    [b'time [s]', b'position_x [m]', b'position_y [m]']
    """
    import pandas as pd

    main, text = "time" if "time" in data.dims else "distance", io.BytesIO()
    for first in range(0, data.sizes[main], _ROWS):
        columns = _columns(data.isel({main: slice(first, first + _ROWS)}), main)
        lines = pd.DataFrame(columns).to_csv(index=False, header=first == 0, lineterminator="\r\n")
        text.write(lines.encode())
    return text.getvalue()


def _columns(data: xarray.Dataset, main: str) -> dict[str, Any]:
    """Return the columns of a table, by their headings."""
    columns = {_heading(main, data[main]): data[main].values}
    for name, variable in data.data_vars.items():
        if variable.dims == (main,):
            columns[_heading(str(name), variable)] = variable.values
        elif variable.dims[0] == main:
            for part in data[variable.dims[1]].values:
                values = variable.sel({variable.dims[1]: part}).values
                columns[_heading(f"{name}_{part}", variable)] = values
    return columns


def _heading(name: str, variable: xarray.DataArray) -> str:
    unit = str(variable.attrs.get("units", "1")).replace(" s-1", "/s")
    return name if unit == "1" else f"{name} [{unit}]"
