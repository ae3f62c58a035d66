"""What the series show: the quantities that matter to a run, each with its lines."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.attitude import attitude_of
from trundle.mechanics.contact import normal_at
from trundle.wording import Unit, unit_for

from .events import FLIGHT, SLIPPING, part_in
from .facts import NOTHING, Facts, coordinate_variables, guiding_centre, support_states
from .scales import Array

if TYPE_CHECKING:
    from trundle.simulation.trajectory import Trajectory


@dataclass(frozen=True)
class Series:
    """One panel: its quantity, its lines by name, and the size beside which rounding error is nothing."""

    name: str
    kind: str
    natural: float
    lines: dict[str, Array]
    from_zero: bool = False
    offered: float | None = None  # the friction coefficient that the support has

    @property
    def largest(self) -> float:
        """The largest magnitude of any line."""
        return max(float(np.nanmax(np.abs(line))) for line in self.lines.values())

    @property
    def is_nothing(self) -> bool:
        """Whether all lines are zero but for rounding."""
        return self.largest <= NOTHING * self.natural

    @property
    def unit(self) -> Unit:
        """The unit that its axis is labelled in."""
        return unit_for(self.natural if self.is_nothing else self.largest, self.kind)

    @property
    def label(self) -> str:
        """The name and the unit."""
        return f"{self.name} ({self.unit.symbol})" if self.unit.symbol else self.name


def quantities_of(run: Trajectory, facts: Facts) -> list[Series]:
    """Return the panels of a run, from the top."""
    support = run.in_frame("support").data
    time = np.asarray(support["time"].values, dtype=float)
    r, V = _array(support, "position"), _array(support, "velocity")
    Omega = _array(support, "angular_velocity")
    duration = float(time[-1] - time[0])
    length = max(float(np.max(np.abs(r))), facts.radius, 1e-300)
    frequency = max(abs(facts.rate), 1.0 / duration if duration > 0.0 else 1.0)
    panels = [
        _position(r, length),
        Series("speed", "speed", length * frequency, {"": np.sqrt(np.sum(V * V, axis=1))}, from_zero=True),
        Series(
            "angular\nvelocity",
            "angular velocity",
            max(frequency, float(np.max(np.abs(Omega)))),
            _turning(Omega, facts),
        ),
        *_forces(run, facts, time, support, length * frequency**2),
    ]
    heights = _heights(run, facts, r, length)
    others = [*_slip(facts, time, support, panels[1].largest), *_lean(run, facts, support), *_support_rate(run)]
    return [*panels, *([heights] if heights else []), *others]


def _array(data: Any, name: str) -> Array:
    return np.asarray(data[name].values, dtype=float)


def _forces(run: Trajectory, facts: Facts, time: Array, support: Any, acceleration: float) -> list[Series]:
    """Return the contact force and the friction needed; a small share of the weight is none, or of m times this."""
    R = _array(support, "contact_force")
    coordinates = tuple(_array(support, name) for name in coordinate_variables(run))
    normal = normal_at(run.system, time, Vector.of(_array(support, "contact")), coordinates).array()
    normal = np.broadcast_to(normal, R.shape)
    N = np.einsum("ni,ni->n", R, normal)
    f = np.linalg.norm(R - N[:, None] * normal, axis=1)
    force = run.system.body.mass * (run.system.gravity or acceleration)
    lines = {"N, normal": N, "|f|, friction": f}
    panels = [Series("contact\nforce", "force", force, lines, from_zero=True)]
    if float(np.max(N)) > NOTHING * force:
        pressed = np.where((NOTHING * force < N) & ~part_in(facts.stretches, FLIGHT, time), N, np.nan)
        name = "friction\nneeded, |f|/N"
        if any(stretch.phase == SLIPPING for stretch in facts.stretches):
            name = "friction\n|f|/N"
        if np.any(np.isfinite(pressed)):
            panels.append(Series(name, "number", 1.0, {"": f / pressed}, from_zero=True, offered=facts.friction))
    return panels


def _turning(Omega: Array, facts: Facts) -> dict[str, Array]:
    along = "Ωz" if facts.curved or not facts.stays else "Ωn, normal"
    if facts.wall is None or facts.curved:
        return {"Ωx": Omega[:, 0], "Ωy": Omega[:, 1], along: Omega[:, 2]}
    size = NOTHING * max(float(np.max(np.abs(Omega))), 1e-300)
    across = {"Ωx": Omega[:, 0], "Ωy": Omega[:, 1]}
    seen = {name: values for name, values in across.items() if float(np.max(np.abs(values))) > size}
    return {"Ωz, along\nthe axis": Omega[:, 2], **seen}


def _heights(run: Trajectory, facts: Facts, r: Array, length: float) -> Series | None:
    """Return the height above the start, where the support is tilted or the body rises and falls."""
    height = _array(run.in_frame("world").data, "position")[:, 2]
    if not facts.tilted and float(np.ptp(height)) <= 1e-6 * length:
        return None
    lines = {"": height - height[0]}
    guide = guiding_centre(run, _array(run.data, "time")) if facts.tilted else None
    if guide is not None:
        lines = {"ball": lines[""], "guiding\ncentre": (guide[:, 0] - r[0, 0]) * -math.sin(facts.tilt)}
    return Series("height\nabove start", "length", length, lines)


def _slip(facts: Facts, time: Array, support: Any, fastest: float) -> list[Series]:
    if not any(stretch.phase == SLIPPING for stretch in facts.stretches):
        return []
    speed = np.linalg.norm(_array(support, "slip_velocity"), axis=1)
    speed = np.where(part_in(facts.stretches, FLIGHT, time), np.nan, speed)
    return [Series("slip speed", "speed", max(fastest, 1e-300), {"": speed}, from_zero=True)]


def _lean(run: Trajectory, facts: Facts, support: Any) -> list[Series]:
    """Return the angle between the body's third axis and the normal, of a body that shows it."""
    shape = run.system.body.shape
    if shape.axis is not None or not facts.off_centre:
        return []
    state = support_states(run)
    there = state.local(Vector.of(_array(support, "contact")))
    first, second = run.system.support.surface.directions(there)
    n = run.system.support.surface.normal(there)
    turned = (state.rotation @ first, state.rotation @ second, state.rotation @ n)
    lean = attitude_of(*turned, Quaternion.of(_array(support, "orientation"))).lean
    values = np.broadcast_to(np.asarray(lean, dtype=float), support["time"].shape)
    return [Series("lean of axis\nfrom normal", "angle", 1.0, {"": values})]


def _support_rate(run: Trajectory) -> list[Series]:
    """Return the rate at which the support turns about its axis, where it changes."""
    if run.system.support.motion.steady_rate is not None:
        return []
    state = support_states(run)
    rate = np.asarray(state.angular_velocity.dot(state.axle), dtype=float)
    rate = np.broadcast_to(rate, run.data["time"].shape)
    size = float(np.max(np.abs(rate)))
    if float(np.ptp(rate)) <= NOTHING * size or size == 0.0:
        return []
    return [Series("rate of\nthe support", "angular velocity", size, {"": rate})]


def _position(r: Array, length: float) -> Series:
    """Count from the start where the path is tiny beside its distance from the axis."""
    x, y = r[:, 0], r[:, 1]
    extent = max(float(np.ptp(x)), float(np.ptp(y)))
    if NOTHING * length < extent < 0.01 * length:
        return Series("position\nfrom start", "length", length, {"x − x₀": x - x[0], "y − y₀": y - y[0]})
    return Series("position", "length", length, {"x": x, "y": y})
