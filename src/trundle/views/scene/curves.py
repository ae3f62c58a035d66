"""What may be drawn over time, or against each other: the numbers of a run that only its mechanics can tell."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...mechanics import quantities
from ...mechanics.algebra import Vector
from ...mechanics.invariants import Record
from ...mechanics.system import RollingSystem
from ...solve.samples import FLIGHT, SLIPPING, Samples

Array = NDArray[np.float64]
PREFIX = "curve_"  # of the columns


class Curve(NamedTuple):
    """One quantity over the samples; where there is none it is not a number."""

    key: str
    label: str
    unit: str
    values: Array


def curves_of(system: RollingSystem, at: Samples) -> tuple[list[dict[str, str]], dict[str, NDArray[Any]]]:
    """Return what each curve is called, and their columns.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("level-turntable-nudged").run()
    >>> told, columns = curves_of(run.system, run.samples)
    >>> told[0], columns["curve_spin_normal"].shape
    ({'column': 'curve_spin_normal', 'label': 'Spin about the normal', 'unit': 'rad/s'}, (2001,))
    """
    found = list(_curves(system, at))
    told = [{"column": PREFIX + one.key, "label": one.label, "unit": one.unit} for one in found]
    return told, {PREFIX + one.key: one.values.astype(np.float32) for one in found}


def upwards(system: RollingSystem) -> Array:
    """Return the unit vector that points vertically up, in the support frame."""
    return np.array([*quantities.upwards(float(system.support.tilt))])


def third_axis(at: Samples) -> Array:
    """Return the body's third axis (n, 3) in the support frame."""
    w, x, y, z = at.orientation.T
    return np.column_stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])


def _curves(system: RollingSystem, at: Samples) -> Iterator[Curve]:
    touches, none = at.phase != FLIGHT, np.full(at.time.size, np.nan)
    record = Record(at.motion(system), Vector.of(at.contact), at.support_columns)
    n, force = Vector.of(at.normals(system)), Vector.of(at.contact_force)
    with np.errstate(divide="ignore", invalid="ignore"):  # no force, no share of it
        found = list(quantities.quantities(system, system, record, at.support(system), n, force))
    for key, label, unit, value, touching in ((q.key, q.label, q.unit, q.value, q.touching) for q in found):
        if key == "normal" and (at.phase == SLIPPING).any():
            slip = np.linalg.norm(slip_of(system, at), axis=1)
            yield Curve("slip", "Slip speed", "m/s", np.where(touches, slip, none))
        known = np.isfinite(value) & (touches if touching else True)
        yield Curve(key, label, unit, np.where(known, np.asarray(value, dtype=float), none))


def slip_of(system: RollingSystem, at: Samples) -> Array:
    """Return the slip velocity s = V + Ω×ρ − u (n, 3), m/s."""
    if at.slip_velocity is not None:
        return np.asarray(at.slip_velocity, dtype=float)
    V, turning, material = at.speeds(system)
    return np.asarray((V + turning - material).array(), dtype=float)
