"""What a Poincaré section is of: a quantity that passes a value, a function of the state, or a kind of event."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InvalidValueError, UnknownNameError
from ...mechanics import checks
from ...mechanics.system import RollingSystem
from ...simulation import labels
from ...solve.samples import KINDS, Array
from ...units import UNITS

if TYPE_CHECKING:
    import xarray

WAYS = ("rising", "falling", "crossing")
_PASSES = re.compile(r"\s*([A-Za-z_0-9.]+)\s+(\w+)\s+through\s+(.+?)\s*")
_ZERO = re.compile(r"[+-]?0+(\.0*)?")  # in whatever unit
_EXAMPLE = 'Write for instance "position.z rising through 10 mm", or name a kind of event, such as "land".'


@dataclass(frozen=True)
class Condition:
    """Where a motion is noted: where a function of its samples passes zero, or where events of a kind are."""

    text: str  # as it was asked for
    # takes a dataset like `Trajectory.data`, returns a number for each instant; None where events are asked for
    function: Callable[[xarray.Dataset], Array] | None
    way: str = "rising"  # "rising", "falling" or "crossing": either way
    event: str = ""  # the kind of event; empty where there is a function

    @classmethod
    def of(cls, given: Any, system: RollingSystem, way: str) -> Condition:
        """Return the condition that is asked for, or say what is wrong with it."""
        if way not in WAYS:
            raise UnknownNameError("way through a section", str(way), WAYS)
        if callable(given):
            return cls(getattr(given, "__name__", "a function"), given, way)
        if not isinstance(given, str):
            raise InvalidValueError("section", "must be text or a function of the samples", given, _EXAMPLE)
        if given in KINDS:
            return cls(given, None, way, given)
        found = _PASSES.fullmatch(given)
        if found is None:
            raise InvalidValueError("section", "must say which quantity passes which value, and how", given, _EXAMPLE)
        name, said, value = found.groups()
        if said not in WAYS:
            raise UnknownNameError("way through a section", said, WAYS)
        quantity, kind = quantity_of(system, name)
        level = 0.0 if _ZERO.fullmatch(value) else float(checks.real(value, kind, "section"))
        return cls(given, lambda data: quantity(data) - level, said)


def quantities(system: RollingSystem) -> dict[str, tuple[str, str]]:
    """Return the scalar quantities of a dataset by name: the variable's unit, and what it is called.

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> quantities(ball)["velocity.x"]
    ('m s-1', 'velocity of the centre of mass, x')
    """
    parts = {"axis": "xyz", "quaternion": "wxyz"}
    found: dict[str, tuple[str, str]] = {}
    for name, (dims, about) in labels.facts(system).items():
        if len(dims) == 1:
            found[name] = (about["units"], about["long_name"])
        else:
            rows = {f"{name}.{part}": (about["units"], f"{about['long_name']}, {part}") for part in parts[dims[1]]}
            found |= rows
    return found


def quantity_of(system: RollingSystem, name: str) -> tuple[Callable[[xarray.Dataset], Array], str]:
    """Return what reads a scalar quantity off a dataset, and its kind, one of `trundle.units.UNITS`."""
    known = quantities(system)
    if name not in known:
        raise UnknownNameError("quantity", name, known)
    variable, _, part = name.partition(".")
    unit = known[name][0].replace(" ", "*")
    units = {"m*s-1": "velocity", "rad*s-1": "angular velocity", "m": "length", "N": "force", "rad": "angle"}
    kind = units.get(unit, "number")
    dim = "quaternion" if variable == "orientation" else "axis"

    def read(data: xarray.Dataset) -> Array:
        column = data[variable].sel({dim: part}) if part else data[variable]
        return np.asarray(column.values, dtype=float)

    return read, kind if kind in UNITS else "number"
