"""One body on one support: a case that a scenario says."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from ..analysis.sensitivities import keys, sensitivities
from ..errors import ScenarioError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.duals import slopes_of
from ..mechanics.scalars import Scalar
from ..mechanics.system import RollingSystem, State
from ..simulation.simulate import Scenario
from .case import END, PARTS, Array, Case, Input, Motion, Task

_SHAPES = {"ball": "sphere", "disc": "disc", "ellipsoid": "ellipsoid"}
_FINEST = 1e-14  # of a second route by DOP853
_FOR = "for a physics engine"
_PARAMETERS = ("gravity", "support.tilt", "support.friction", "support.motion.rate", "support.motion.inertia")
_SMOOTH = {"grip", "slip"}  # events that no contact begins or ends with
_NOTHING = 1e-9  # slopes below do not count: the number changes nothing
_MOTIONS = {"fixed": "fixed", "free-axle": "hinge", "spin": "driven"}


@dataclass(frozen=True)
class Rolling(Case):
    """A case made of a scenario: the exact motion is its run.

    Parameters
    ----------
    name, title, about : str
        As those of `Case`.
    scenario : Scenario
        Body, support, start and timing.

    Examples
    --------
    >>> import trundle as tr
    >>> case = tr.conformance.Rolling.of("swerve", tr.Scenario.load("billiard-swerve"))
    >>> case.exact().position[-1, 0].round(3).tolist()
    [0.939, -1.313, 0.029]
    """

    scenario: Scenario
    surfaces: ClassVar[tuple[str, ...]] = ("plane", "dome")

    @classmethod
    def of(cls, name: str, scenario: Scenario) -> Rolling:
        """Make a case of a scenario, and refuse what the task has no words for.

        Parameters
        ----------
        name : str
            For the table of results.
        scenario : Scenario
            Of one body on a plane or a dome, with a coefficient of friction and without loads.

        Returns
        -------
        Rolling
            The case.

        Raises
        ------
        ScenarioError
            If the task has no words for a part of the scenario.
        """
        case = cls(name, scenario.title, scenario.notes.strip(), scenario)
        case.situation()
        return case

    @classmethod
    def read(cls, name: str, tables: Mapping[str, Any], source: str) -> Rolling:
        """Make a case of the tables of a scenario file."""
        return cls.of(name, Scenario.read(dict(tables), source))

    @property
    def duration(self) -> float:
        """Length of the run, s."""
        return float(self.scenario.timing.duration)

    @property
    def every(self) -> float:
        """Time between samples, s."""
        return float(self.scenario.timing.every)

    def situation(self) -> Task:
        """Return bodies, support, friction and gravity, as the task tells them."""
        self._check()
        told: Task = _leaves(_told(self.scenario.system(), self.scenario.start_state()), float)
        return told

    def inputs(self) -> tuple[Input, ...]:
        """Return start, gravity, slope, friction and table, where the body stays on its support."""
        wanted = [key for key in keys.keys(self.scenario) if key.name.startswith("start.") or key.name in _PARAMETERS]
        slopes = sensitivities(
            self.scenario, [key.name for key in wanted], duration=self.duration, every=self.every, compared=False
        ).data
        if not _SMOOTH.issuperset(map(str, slopes.kind.values)):
            return ()
        ends = np.concatenate([slopes[part].values[-1] for part in END], axis=0).T
        directions = _told(*keys.varied(self.scenario, wanted))

        def one(j: int, key: keys.Key) -> Input:
            def moved(by: float) -> Rolling:
                return replace(self, scenario=keys.replaced(self.scenario, {key.name: key.value + by}))

            direction = _leaves(directions, lambda x: float(slopes_of(x, len(wanted))[j]))
            return Input(key.name, direction, ends[j : j + 1], abs(key.value) or 1.0, moved)

        return tuple(one(j, key) for j, key in enumerate(wanted) if np.linalg.norm(ends[j]) > _NOTHING)

    def _check(self) -> None:
        """Refuse what the task has no words for."""
        system = self.scenario.system()
        support, surface, shape = system.support, system.support.surface, system.body.shape
        for key, received, words in (
            ("body.kind", _SHAPES.get(shape.noun, shape.noun), _SHAPES.values()),
            ("support.kind", surface.kind, self.surfaces),
            ("support.motion.kind", support.motion.kind, _MOTIONS),
        ):
            if received not in words:
                raise ScenarioError(key, f"must be one of {', '.join(words)} {_FOR}", received, "", self.name)
        if support.friction is None:
            remedy = "Add, say, `friction = 0.5` under [support]: in an engine nothing else makes a body roll."
            raise ScenarioError("support.friction", f"must be given {_FOR}", None, remedy, self.name)
        if system.loads:
            raise ScenarioError("loads", f"must be absent {_FOR}", len(system.loads), "", self.name)

    def exact(self, method: str = "auto") -> Motion:
        """Return the run of the scenario."""
        run = self.scenario.run(method=method, tolerance=_FINEST if method == "runge-kutta" else None)
        data = run.data.sel(time=self.times(), method="nearest", tolerance=1e-9)
        arrays = {part: data[part].values[:, None, :] for part in PARTS}
        turning = [data[name].values for name in ("support_angle", "support_rate") if name in data]
        support = np.stack(turning, axis=-1) if turning else None
        return Motion(time=data.time.values, support=support, **arrays)

    def slip(self, motion: Motion) -> Array:
        """Return V + Ω×ρ − ω×p at the point of the body that is nearest to the support."""
        system = self.scenario.system()
        r, V, Omega, q = self._vectors(motion)
        Q = q.matrix()
        n = system.support.surface.normal(r)
        rho, _ = system.body.shape.contact(Q, n)
        p, rate = r + rho, self._rate(motion)
        moved = V + Omega.cross(rho) - Vector(-rate * p.y, rate * p.x, 0.0 * rate)
        return np.stack([part + 0 * motion.time for part in moved], axis=-1)[:, None, :]

    def energy(self, motion: Motion) -> Array:
        """Return T + U with that of a table on a hinge; E − ωL on a driven one, which is constant there."""
        situation, system = self.situation(), self.scenario.system()
        r, V, Omega, q = self._vectors(motion)
        m = system.body.mass
        E = self.kinetic_energy(motion) - m * motion.position[:, 0] @ np.array(situation["gravity"])
        told, rate = situation["support"]["motion"], self._rate(motion)
        if told["kind"] == "hinge":
            return E + 0.5 * told["inertia"] * rate**2
        spun = system.body.inertia_in_space(q.matrix()) @ Omega
        return E - rate * (m * (r.x * V.y - r.y * V.x) + spun.z)

    def _rate(self, motion: Motion) -> Array:
        """Return the rate of the support at each sample, rad/s."""
        told = self.situation()["support"]["motion"]
        if told["kind"] == "hinge":
            return np.full(motion.time.shape, np.nan) if motion.support is None else motion.support[:, 1]
        return np.full(motion.time.shape, told.get("rate", 0.0))

    @staticmethod
    def _vectors(motion: Motion) -> tuple[Vector, Vector, Vector, Quaternion]:
        """Return position, velocity, angular velocity and orientation with arrays for components."""
        r, V, Omega = (Vector(*each[:, 0].T) for each in (motion.position, motion.velocity, motion.angular_velocity))
        return r, V, Omega, Quaternion(*motion.orientation[:, 0].T)


_AXES = (Vector(1.0, 0.0, 0.0), Vector(0.0, 1.0, 0.0), Vector(0.0, 0.0, 1.0))


def _told(system: RollingSystem, start: State) -> Task:
    """Return the words of a task with the scalars that a system and its start are made of."""
    body, support = system.body, system.support
    shape: Task = {"kind": _SHAPES[body.shape.noun]}
    shape |= {key: value for key, value in body.shape.parameters().items() if key != "centre"}
    ground: Task = {"kind": support.surface.kind, "motion": {"kind": _MOTIONS[support.motion.kind]}}
    if hasattr(support.surface, "radius"):
        ground["radius"] = support.surface.radius
    ground["motion"] |= {
        key: getattr(support.motion, key) for key in ("inertia", "rate") if hasattr(support.motion, key)
    }
    inertia = body.inertia_in_space(Quaternion(1.0, 0.0, 0.0, 0.0).matrix())
    return {
        "gravity": [system.weight.x, system.weight.y, system.weight.z],
        "bodies": [
            {
                "shape": shape,
                "offset": list(getattr(body.shape, "centre", None) or Vector(0.0, 0.0, 0.0)),
                "mass": body.mass,
                "inertia": [[e.dot(inertia @ f) for f in _AXES] for e in _AXES],
                "force": [0.0, 0.0, 0.0],
                **{part: list(getattr(start, part)) for part in PARTS},
            }
        ],
        "support": ground,
        "friction": 0.0 if support.friction is None else support.friction,
        "friction_between": 0.0,
        "restitution": support.restitution,
    }


def _leaves(told: Any, number: Callable[[Scalar], float]) -> Any:
    """Return words and lists with a number in the place of each scalar."""
    if isinstance(told, dict):
        return {key: _leaves(value, number) for key, value in told.items()}
    if isinstance(told, (list, tuple)):
        return [_leaves(value, number) for value in told]
    return told if isinstance(told, str) else number(told)
