"""Arrays in memory as tables: mappings, tables of pandas, datasets of xarray, with vectors taken apart."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import InvalidValueError
from . import names
from .options import Options
from .table import Table

_WHOLE = {  # arrays of vectors -> the letter before the names of their parts
    **dict.fromkeys(("position", "r", "x"), ""),
    **dict.fromkeys(("velocity", "V", "v"), "v"),
    **dict.fromkeys(("angular_velocity", "Omega", "Ω", "omega"), "w"),
    **dict.fromkeys(("orientation", "q", "quaternion"), "q"),
}


def table_of(data: Any, options: Options) -> tuple[str, Table]:
    """Return what a track in memory is called, and its table.

    Examples
    --------
    >>> _, table = table_of({"t": [0.0, 0.1], "position": np.zeros((2, 3))}, Options())
    >>> [column.heading for column in table.columns]
    ['t', 'x', 'y', 'z']
    """
    source = ""
    if hasattr(data, "samples") and hasattr(data, "in_frame"):  # a Trajectory
        source, data = data.title, data.data
    if hasattr(data, "data_vars"):
        return source, dataset_table(data, options)
    if hasattr(data, "columns"):
        data = {str(name): data[name].to_numpy() for name in data.columns}
    if not isinstance(data, Mapping):
        rule = "must be a file, a table, a dataset or a mapping from names to arrays"
        raise InvalidValueError("data", rule, type(data).__name__)
    return source, mapping_table(data, options)


def dataset_table(data: Any, options: Options) -> Table:
    """Return the variables of a dataset, with a unit in brackets where an attribute says one, and its frame."""
    found = {}
    for name in [*data.coords, *data.data_vars]:
        variable = data[name]
        if variable.dtype.kind not in "iuf":
            continue
        unit = str(variable.attrs.get("units", "")).partition(" since ")[0]
        unit = re.sub(r"\s+([a-z]+)-(\d)", r"/\1^\2", unit).replace("^1", "")  # "m s-1", as CF has it
        found[f"{name} [{unit}]" if unit else str(name)] = variable.values
    return mapping_table(found, options, frame=str(data.attrs.get("frame", "")))


def mapping_table(data: Mapping[str, Any], options: Options, **known: Any) -> Table:
    """Return one-dimensional columns: arrays of vectors come apart under trundle's names."""
    table: dict[str, Any] = {}
    for name, values in data.items():
        array = _array(values)
        if array.ndim == 1:
            table[str(name)] = array
            continue
        bare, unit = names.apart(str(name))
        if bare not in _WHOLE or array.dtype == object:
            continue
        stem, behind = _WHOLE[bare], f" [{unit}]" if unit else ""
        order = options.quaternion if stem == "q" else "xyz"
        if array.ndim == 2:
            if array.shape[1] not in ((2, 3) if not stem else (len(order),)):
                raise InvalidValueError(str(name), f"must have the shape (n, {len(order)})", f"the shape {array.shape}")
            table |= {
                f"{stem}{part}{behind}": array[:, i] for i, part in zip(range(array.shape[1]), order, strict=False)
            }
        elif array.ndim == 3 and array.shape[1:] == (3, 3):
            table |= {f"r{i + 1}{j + 1}": array[:, i, j] for i in range(3) for j in range(3)}
    return Table.of(table, **known)


def _array(values: Any) -> Any:
    """Return numbers, or objects: text is refused where a number is needed."""
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        return np.asarray(values, dtype=object)
