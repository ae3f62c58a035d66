"""What a figure says about a run besides its samples: title, key numbers, guiding centre, turns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from trundle.mechanics.loads import Drag, Force, Torque
from trundle.mechanics.motions import Motion, UnevenSpin, Wobble
from trundle.mechanics.scalars import is_zero
from trundle.mechanics.surfaces import Cylinder
from trundle.solve.exact import SphereOnPlane, closed_form

from .scales import Array, as_ratio, short, with_unit

if TYPE_CHECKING:
    from trundle.mechanics.system import RollingSystem
    from trundle.trajectory import Trajectory

# Below this part of the natural size a length, speed or force is rounding error, and drawn as zero.
NOTHING = 1e-9


@dataclass(frozen=True)
class Facts:
    """The numbers of a system that a figure shows."""

    title: str
    numbers: str
    radius: float
    tilt: float
    rate: float
    rim: float | None
    friction: float | None
    noun: str  # of the body
    wall: float | None  # radius of the cylinder that is rolled on, seen along its axis
    pushes: tuple[tuple[str, float, float], ...]  # name and direction, in the plane, of what acts on the body

    @property
    def tilted(self) -> bool:
        """Whether the support leans."""
        return self.tilt != 0.0

    @property
    def turning(self) -> bool:
        """Whether the support turns."""
        return self.rate != 0.0


def facts_of(run: Trajectory) -> Facts:
    """Gather what the figures show of a run's system."""
    system = run.system
    support = system.support
    surface = support.surface
    return Facts(
        title=_title(run),
        numbers=_key_numbers(system),
        radius=float(getattr(system.body.shape, "radius", 0.0)),
        tilt=float(support.tilt),
        rate=float(support.motion.mean_rate),
        rim=None if surface.rim is None else float(surface.rim),
        friction=None if support.friction is None else float(support.friction),
        noun="ball" if system.body.shape.axis is None else "cylinder",
        wall=float(surface.radius) if isinstance(surface, Cylinder) else None,
        pushes=_pushes(system),
    )


def guiding_centre(run: Trajectory, times: Array) -> Array | None:
    """Return the point about which the ball circles, (n, 2), m, support frame, where a closed form has it."""
    form = closed_form(run.system, run.start)
    if not isinstance(form, SphereOnPlane) or not form.has_guiding_centre:
        return None
    x, y = form.guiding_centre(times - run.start.time)
    return np.column_stack([x, y])


def turns_in(time: Array, velocity: Array) -> float:
    """Count the turns of the acceleration, which on a turntable are steady even where the ball halts.

    Parameters
    ----------
    time : (n,) array
        s.
    velocity : (n, 2) array
        m/s.

    Returns
    -------
    float
        Turns over the whole run, without sign.

    Examples
    --------
    >>> t = np.linspace(0.0, 10.0, 501)
    >>> round(turns_in(t, np.column_stack([np.cos(t), np.sin(t)])) * 2 * np.pi, 1)
    10.0
    """
    if len(time) < 3:
        return 0.0
    seen = slice(0, 200_000)
    change = np.diff(velocity[seen], axis=0)
    real = np.hypot(*change.T) > 1e-12 * max(float(np.max(np.hypot(*velocity[seen].T))), 1e-300)
    before, after = change[:-1], change[1:]
    angle = np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], np.sum(before * after, axis=1))[
        real[:-1] & real[1:]
    ]
    if not len(angle):
        return 0.0
    duration = float(time[-1] - time[0])
    return abs(float(np.sum(angle))) / (2 * math.pi) * duration / float(np.sum(np.diff(time[seen])[1:]))


def _title(run: Trajectory) -> str:
    given = run.data.attrs.get("title")
    if given:
        return "".join(letter if letter.isprintable() else " " for letter in str(given))
    system = run.system
    turning = "turning" if system.support.motion.mean_rate else "fixed"
    body = "Ball" if system.body.shape.axis is None else "Cylinder"
    if isinstance(system.support.surface, Cylinder):
        return f"{body} {system.support.surface.side} a {turning} cylinder"
    return f"{body} on a {turning}{', tilted' if system.support.tilt else ''} plane"


def _key_numbers(system: RollingSystem) -> str:
    body, support = system.body, system.support
    parts = []
    rate, wall = float(support.motion.mean_rate), isinstance(support.surface, Cylinder)
    if rate:
        parts.append(f"{'wall' if wall else 'table'} {_rate(rate)}")
    if wall:
        parts.append(f"wall of radius {with_unit(float(support.surface.radius), 'length')}")  # type: ignore[attr-defined]
    elif support.tilt:
        parts.append(f"tilt {short(math.degrees(support.tilt), 4)}°")
    if body.is_isotropic_sphere:
        parts.append(f"inertia ratio k = {as_ratio(float(body.inertia_ratio))}")
        radius = float(getattr(body.shape, "radius", 0.0))
        millimetres = 1e-3 <= radius < 0.1  # as balls are sold
        parts.append(f"radius {f'{radius * 1e3:.4g} mm' if millimetres else with_unit(radius, 'length')}")
    parts += _shortcomings(support.motion)
    for load in system.loads:
        if isinstance(load, Force):
            parts.append(f"force {_size(load, 'force')}")
        elif isinstance(load, Torque):
            parts.append(f"torque {_size(load, 'torque')}")
        elif isinstance(load, Drag):
            air = "" if is_zero(load.air_rate) else ", air turning"
            parts.append(f"drag {with_unit(float(load.coefficient), 'damping')}{air}")
    return "  ·  ".join(parts)


def _shortcomings(motion: Motion) -> list[str]:
    if isinstance(motion, Wobble):
        return [f"askew by {short(math.degrees(float(motion.angle)), 3)}°"]
    if isinstance(motion, UnevenSpin):
        return [f"uneven by {short(100 * float(motion.variation), 3)} %"]
    return []


def _size(load: Force | Torque, kind: str) -> str:
    return with_unit(math.hypot(*load.value), kind) if load.constant else "that varies"


def _rate(rate: float) -> str:
    per_minute = rate * 30 / math.pi
    text = f"{short(rate, 4)} rad/s"
    return f"{text} ({short(per_minute, 4)} rpm)" if 0.1 <= abs(per_minute) < 1e5 else text


def _pushes(system: RollingSystem) -> tuple[tuple[str, float, float], ...]:
    pushes = []
    for kind, name in ((Force, "force"), (Torque, "torque")):
        of_kind = [load.value for load in system.loads if isinstance(load, kind) and load.constant]
        x, y = sum(float(value.x) for value in of_kind), sum(float(value.y) for value in of_kind)
        if math.hypot(x, y) > 0.0:
            pushes.append((name, x / math.hypot(x, y), y / math.hypot(x, y)))
    return tuple(pushes)
