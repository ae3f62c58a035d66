"""What a figure says about a run besides its samples: title, key numbers, guiding centre, turns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from trundle.mechanics.algebra import ZERO
from trundle.mechanics.loads import at_rest
from trundle.mechanics.shapes import concentric_sphere
from trundle.solve.exact import closed_form

from .events import FLIGHT, EventMarks, PhaseInterval, happenings_of, stretches_of
from .scales import Array
from .words import key_numbers, title_of

if TYPE_CHECKING:
    from trundle.mechanics.motions import SupportState
    from trundle.mechanics.system import RollingSystem
    from trundle.simulation.trajectory import Trajectory

# Below this part of the natural size a length, speed or force is rounding error, and drawn as zero.
NOTHING = 1e-9


@dataclass(frozen=True)
class Facts:
    """The numbers of a system that a figure shows."""

    title: str
    numbers: str
    radius: float  # of the body, or half its largest width, m
    round: bool  # whether it looks like a circle from every side that is drawn
    tilt: float
    rate: float  # mean rate of the support's turn about its third axis, rad/s; 0 where it turns both ways
    moving: bool  # whether the support turns or moves at all
    stays: bool  # whether the support keeps its axis
    fixed: bool  # whether the surface covers the same places all the time
    rim: float | None
    friction: float | None
    noun: str  # of the body
    wall: float | None  # radius of the cylinder that is rolled on, seen along its axis
    ground: str  # what the support is called on the maps
    outline: float | None  # distance from the axis at which the surface is seen to end from above, m
    curved: bool  # whether it takes a picture of its surface
    off_centre: bool  # whether the contact does not follow the centre
    pushes: tuple[tuple[str, float, float], ...]  # name and direction, in the plane, of what acts on the body
    stretches: tuple[PhaseInterval, ...]
    happenings: tuple[EventMarks, ...]

    @property
    def tilted(self) -> bool:
        """Whether the support leans."""
        return self.tilt != 0.0

    @property
    def turning(self) -> bool:
        """Whether the support turns, on the whole one way."""
        return self.rate != 0.0

    @property
    def flies(self) -> bool:
        """Whether the body leaves the support on the way."""
        return any(stretch.phase == FLIGHT for stretch in self.stretches)


def facts_of(run: Trajectory) -> Facts:
    """Gather what the figures show of a run's system."""
    system, support = run.system, run.system.support
    surface, shape = support.surface, system.body.shape
    given = run.data.attrs.get("title")
    straight = shape.axis is not None
    wall = surface.wall_radius
    stays = support.motion.steady_rate is not None or _stays(run)
    return Facts(
        title="".join(letter if letter.isprintable() else " " for letter in str(given)) if given else title_of(system),
        numbers=key_numbers(system, run.start.support),
        radius=_size(run),
        round=shape.spherical and (wall is not None or not straight),
        tilt=float(support.tilt),
        rate=_rate(run),
        moving=support.motion.steady_rate != 0.0,
        stays=stays,
        fixed=support.motion.steady_rate == 0.0 or (stays and surface.axisymmetric),
        rim=None if surface.rim is None else float(surface.rim),
        friction=None if support.friction is None else float(support.friction),
        noun=system.body.shape.noun_of(system.body),
        wall=None if wall is None else float(wall),
        ground=surface.ground,
        outline=next(map(float, surface.outline), None),
        curved=not surface.flat and not (wall is not None and _flat(run)),
        off_centre=not straight and not concentric_sphere(shape),
        pushes=_pushes(system),
        stretches=tuple(stretches_of(run)),
        happenings=tuple(happenings_of(run)),
    )


def support_states(run: Trajectory) -> SupportState:
    """Return pose and twist of the support at each sample."""
    motion = run.system.support.motion
    coordinates = [np.asarray(run.data[name].values, dtype=float) for name in coordinate_variables(run)]
    return motion.at(np.asarray(run.data["time"].values, dtype=float), *coordinates)


def coordinate_variables(run: Trajectory) -> list[str]:
    """Return the names of the variables that hold the coordinates of the support's own motion."""
    return [f"support_{name}" for name in run.system.support.motion.coordinates]


def _size(run: Trajectory) -> float:
    reach = run.system.body.shape.reach
    if reach is not None:
        return float(reach)
    return float(np.linalg.norm(run.data["contact"].values[0] - run.data["position"].values[0]))


def _rate(run: Trajectory) -> float:
    motion = run.system.support.motion
    if motion.steady_rate is not None:
        return float(motion.steady_rate)
    state = support_states(run)
    rates = np.atleast_1d(np.asarray(state.angular_velocity.dot(state.axle), dtype=float))
    largest = float(np.max(np.abs(rates)))
    both = float(np.min(rates)) < -0.01 * largest and float(np.max(rates)) > 0.01 * largest
    # A lean that goes round turns the axle a little, too: that is no turn of the table.
    turned = getattr(motion, "turns", True) and (motion.coordinates or float(motion.mean_rate) != 0.0)
    return 0.0 if both or not turned else float(np.mean(rates))


def _stays(run: Trajectory) -> bool:
    """Tell whether a support that moves keeps its axis, so that one of revolution covers the same places."""
    state = support_states(run)
    away = [np.max(np.abs(part)) for part in (*state.origin, state.axle.x, state.axle.y)]
    return float(max(away)) < 1e-12


def _flat(run: Trajectory) -> bool:
    """Tell whether the motion stays in a plane across the third axis."""
    place = np.asarray(run.data["position"].values, dtype=float)
    return bool(np.ptp(place[:, 2]) <= 1e-6 * max(float(np.max(np.ptp(place, axis=0))), _size(run)))


def guiding_centre(run: Trajectory, times: Array) -> Array | None:
    """Return the point about which the ball circles, (n, 2), m, support frame, where a closed form has it."""
    form = closed_form(run.system, run.start)
    circle = None if form is None else form.circle
    if circle is None:
        return None
    if any(stretch.phase for stretch in stretches_of(run)):
        return None  # it moves while the ball slips
    centre = circle.centre_at(times - run.start.time)
    return np.column_stack([centre.real, centre.imag])


def turns_in(time: Array, velocity: Array) -> float:
    """Count the turns of the acceleration, which on a turntable are steady even where the ball halts.

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


def _pushes(system: RollingSystem) -> tuple[tuple[str, float, float], ...]:
    constant, still, pushes = [load for load in system.loads if load.constant], at_rest(system.body.mass), []
    totals = {
        "force": sum((load.force(still) for load in constant), ZERO),
        "torque": sum((load.torque(still) for load in constant), ZERO),
    }
    for name, total in totals.items():
        x, y = float(total.x), float(total.y)
        if math.hypot(x, y) > 0.0:
            pushes.append((name, x / math.hypot(x, y), y / math.hypot(x, y)))
    return tuple(pushes)
