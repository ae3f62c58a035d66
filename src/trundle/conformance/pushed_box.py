"""A box that is pushed over the ground with balls on it: SimBenchmark's rolling test, which has a formula.

Each ball that rolls on a box with acceleration a is pulled along by f = (k/(1 + k)) m a, so that
F − μ (M + n m) g = (M + n m k/(1 + k)) a, and the ball itself gains k a/(1 + k).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from ..errors import ScenarioError
from ..mechanics.system import STANDARD_GRAVITY
from .case import END, Array, Case, Input, Motion, Task


@dataclass(frozen=True)
class PushedBox(Case):
    """A box on rough ground, pushed by a constant force, with rows of balls that roll on it.

    Parameters
    ----------
    name, title, about : str
        As those of `Case`.
    force : float
        N.
    direction : float
        Of the force, rad from the first axis.
    friction : tuple of float
        Coefficients: box and ground, ball and box.
    gravity : float
        m/s².

    Examples
    --------
    >>> import trundle as tr
    >>> case = next(case for case in tr.conformance.cases() if case.name == "diagonal-box")
    >>> round(case.acceleration, 6), round(case.ball_acceleration, 6)
    (0.741236, 0.211782)
    """

    force: float
    direction: float
    friction: tuple[float, float] = (0.4, 0.8)
    gravity: float = STANDARD_GRAVITY

    table: ClassVar[str] = "pushed-box"
    box_mass: ClassVar[float] = 10.0
    half_widths: ClassVar[tuple[float, float, float]] = (4.0, 4.0, 0.2)
    ball_mass: ClassVar[float] = 1.0
    radius: ClassVar[float] = 0.1
    ratio: ClassVar[float] = 0.4  # k = I/(m a²)
    rows: ClassVar[tuple[float, ...]] = (-2.0, -1.0, 0.0, 1.0, 2.0)  # m, both ways
    duration = 1.0
    every = 0.01

    @classmethod
    def read(cls, name: str, tables: Mapping[str, Any], source: str) -> PushedBox:
        """Make a case of the tables of a case file."""
        numbers = tables[cls.table]
        for key in ("force", "direction"):
            if not isinstance(numbers, Mapping) or not isinstance(numbers.get(key), (int, float)):
                got = numbers.get(key) if isinstance(numbers, Mapping) else numbers
                raise ScenarioError(f"{cls.table}.{key}", "must be a number", got, "", source)
        title, about = (str(tables.get(key, "")).strip() for key in ("title", "notes"))
        return cls(name, title, about, float(numbers["force"]), float(numbers["direction"]))

    @property
    def acceleration(self) -> float:
        """Of the box, m/s²."""
        carried = self.box_mass + len(self.rows) ** 2 * self.ball_mass * self.ratio / (1 + self.ratio)
        return (self.force - self.friction[0] * self._weight) / carried

    @property
    def ball_acceleration(self) -> float:
        """Of each ball, m/s²."""
        return self.acceleration * self.ratio / (1 + self.ratio)

    @property
    def _weight(self) -> float:
        """Of all bodies together, N."""
        return (self.box_mass + len(self.rows) ** 2 * self.ball_mass) * self.gravity

    @property
    def _along(self) -> tuple[float, float]:
        """The unit vector of the force."""
        return math.cos(self.direction), math.sin(self.direction)

    def situation(self) -> Task:
        """Return the box, then the balls in rows."""
        x, y, z = self.half_widths
        c, s = self._along
        m, M, a = self.ball_mass, self.box_mass, self.radius
        rest = {"velocity": [0.0] * 3, "angular_velocity": [0.0] * 3, "orientation": [1.0, 0.0, 0.0, 0.0]}
        spun = self.ratio * m * a * a
        box = {
            "shape": {"kind": "box", "half_widths": [x, y, z]},
            "offset": [0.0] * 3,
            "mass": M,
            "inertia": _diagonal(M / 3 * (y * y + z * z), M / 3 * (x * x + z * z), M / 3 * (x * x + y * y)),
            "force": [self.force * c, self.force * s, 0.0],
            "position": [0.0, 0.0, z],
            **rest,
        }
        balls = [
            {
                "shape": {"kind": "sphere", "radius": a},
                "offset": [0.0] * 3,
                "mass": m,
                "inertia": _diagonal(spun, spun, spun),
                "force": [0.0] * 3,
                "position": [across, up, 2 * z + a],
                **rest,
            }
            for across in self.rows
            for up in self.rows
        ]
        return {
            "gravity": [0.0, 0.0, -self.gravity],
            "bodies": [box, *balls],
            "support": {"kind": "plane", "motion": {"kind": "fixed"}},
            "friction": self.friction[0],
            "friction_between": self.friction[1],
            "restitution": 0.0,
        }

    def exact(self, method: str = "auto") -> Motion:
        """Return the motion by its formula; by any other method, by integrating the equations of all bodies."""
        gains = np.array([self.acceleration, *[self.ball_acceleration] * len(self.rows) ** 2])
        t = self.times()
        if method != "auto":
            from .pushed_box_equations import integrated

            return self._motion(t, *integrated(self.situation(), t))
        moved = 0.5 * gains * t[:, None] ** 2
        speed = gains * t[:, None]
        # No slip: the lowest point of a ball has the velocity of the box.
        turning = (speed[:, :1] - speed) / self.radius
        turning[:, 0] = 0.0
        turned = (moved[:, :1] - moved) / self.radius
        turned[:, 0] = 0.0
        return self._motion(t, moved, speed, turning, turned)

    def _motion(self, t: Array, moved: Array, speed: Array, turning: Array, turned: Array) -> Motion:
        """Turn what happens along the force into positions, velocities and orientations."""
        c, s = self._along
        along, axis = np.array([c, s, 0.0]), np.array([s, -c, 0.0])
        first = np.array([body["position"] for body in self.situation()["bodies"]])
        quaternion = np.concatenate([np.cos(turned / 2)[..., None], np.sin(turned / 2)[..., None] * axis], axis=-1)
        return Motion(
            time=t,
            position=first + moved[..., None] * along,
            velocity=speed[..., None] * along,
            angular_velocity=turning[..., None] * axis,
            orientation=quaternion,
        )

    def inputs(self) -> tuple[Input, ...]:
        """Return the force and its direction, the friction of the ground and gravity."""
        c, s = self._along
        mu, g = self.friction[0], self.gravity
        carried = (self.force - mu * self._weight) / self.acceleration
        end = self.exact()
        state = np.concatenate([getattr(end, part)[-1] - getattr(end, part)[0] for part in END], axis=1)
        faster = state / self.acceleration  # all of it grows with the acceleration of the box
        x, y, z = np.split(state.reshape(-1, 3, 3), 3, axis=2)
        turned = np.concatenate([-y, x, 0 * z], axis=2).reshape(-1, 9)
        pushes = {"force": [c, s, 0.0], "direction": [-s * self.force, c * self.force, 0.0]}
        return (
            Input("force", self._slopes(force=pushes["force"]), faster / carried, self.force, self._with("force")),
            Input("direction", self._slopes(force=pushes["direction"]), turned, 1.0, self._with("direction")),
            Input(
                "friction",
                self._slopes(friction=1.0),
                -self._weight / carried * faster,
                mu,
                lambda by: replace(self, friction=(mu + by, self.friction[1])),
            ),
            Input(
                "gravity",
                self._slopes(gravity=[0.0, 0.0, -1.0]),
                -mu * self._weight / (g * carried) * faster,
                g,
                self._with("gravity"),
            ),
        )

    def _with(self, name: str) -> Callable[[float], PushedBox]:
        """Return what makes a case with so much more of a number."""
        return lambda by: replace(self, **{name: getattr(self, name) + by})

    def _slopes(self, force: list[float] | None = None, **others: Any) -> Task:
        """Return how the numbers of the task change: by nothing but by what is given."""

        def still(told: Any) -> Any:
            if isinstance(told, dict):
                return {key: still(part) for key, part in told.items()}
            if isinstance(told, list):
                return [still(part) for part in told]
            return told if isinstance(told, str) else 0.0

        slopes: Task = still(self.situation()) | others
        slopes["bodies"][0]["force"] = force or [0.0] * 3
        return slopes

    def slip(self, motion: Motion) -> Array:
        """Return the velocity of each ball's lowest point over the box; zero for the box, which has to slip."""
        V, Omega = motion.velocity, motion.angular_velocity
        arm = np.array([0.0, 0.0, -self.radius])
        slip = V + np.cross(Omega, arm) - V[:, :1]
        slip[:, 0] = 0.0
        return slip

    def friction_force(self, motion: Motion) -> Array:
        """Return what the gain of momentum leaves of the force that pushes, on the ground."""
        mass = np.array([self.box_mass, *[self.ball_mass] * len(self.rows) ** 2])
        gained = mass @ (motion.velocity[-1] - motion.velocity[0]) / self.duration
        force: Array = (gained - self.force * np.array([*self._along, 0.0])) * [1.0, 1.0, 0.0]
        return force

    def energy(self, motion: Motion) -> Array:
        """Return the kinetic energy, less the work of the force and of the friction on the ground."""
        moved = motion.position[:, 0] - motion.position[:1, 0]
        work = (self.force - self.friction[0] * self._weight) * (moved @ np.array([*self._along, 0.0]))
        return self.kinetic_energy(motion) - work


def _diagonal(*moments: float) -> list[list[float]]:
    """Return a diagonal matrix as lists."""
    return np.diag(moments).tolist()
