"""What a scenario predicts of the observed columns, and how that changes with what is free: exactly, through duals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...errors import SolverError
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.duals import Dual, gathered, slopes_of, value_of
from ...mechanics.scalars import namespace
from ...mechanics.system import RollingSystem, State
from ...scenario import ScenarioFile
from ...solve import methods, transitions
from ...solve.exact import ClosedForm
from ...solve.samples import Array, Samples
from ..sensitivities import by_formula, keys
from ..sensitivities.by_formula import Moved
from ..sensitivities.following import Followed, check_brink, follow
from .camera import Camera
from .observations import GYROSCOPE, Observations
from .unknowns import BIAS, MOUNTING, OUTSIDE, Unknown, camera_with, rotated, turn_by, vector_of

_TURNED = {"spot_x", "spot_y", "spot_z", *GYROSCOPE.values()}  # what needs the body's orientation


@dataclass(frozen=True)
class Motion:
    """The motion at the times of the rows, in floats or in duals: arrays over the rows."""

    r: Vector
    V: Vector
    Omega: Vector
    q: Any
    system: RollingSystem
    time: Array
    support: tuple[Any, ...]


@dataclass(frozen=True)
class RunModel:
    """The model of one run."""

    scenario: ScenarioFile  # with the start at the time of the first row
    seen: Observations  # of the run
    unknowns: tuple[Unknown, ...]  # what it depends on
    camera: Camera  # where its numbers are not free
    _form: list[type[ClosedForm]] = field(
        default_factory=list, init=False, compare=False, repr=False
    )  # once it is known to do

    @property
    def accuracy(self) -> float:
        """By how much all that is seen at one place may be off, m: as somebody says it, or the track."""
        return self.seen.accuracy if self.camera.accuracy is None else self.camera.accuracy

    @property
    def by_formula(self) -> bool:
        """Whether derivatives come from a closed form, and cost little more than the motion."""
        return bool(self._form)

    def predict(self, values: Sequence[float], rows: int, *, slopes: bool) -> tuple[Array, Array | None]:
        """Return what is predicted of the first rows, (rows, c), and the derivatives, (rows, c, unknowns).

        Raises
        ------
        TrundleError
            Where there is no such motion.
        """
        names = [one.key for one in self.unknowns]
        of_scenario = [i for i, name in enumerate(names) if not name.startswith(OUTSIDE)]
        order = [*of_scenario, *(i for i, name in enumerate(names) if name.startswith(OUTSIDE))]
        count, inside = len(names), len(of_scenario)
        numbers = {names[i]: float(values[i]) for i in order}
        if not slopes:
            camera = camera_with(self.camera, numbers)
            motion = self._motion(numbers, rows, camera)
            return self._columns(motion, numbers, camera, self.seen.columns), None
        each = np.eye(count)[:, :, None]
        duals = {name: Dual(number, (each[i],)) for i, (name, number) in enumerate(numbers.items())}
        camera = camera_with(self.camera, duals)
        motion = self._in_duals(numbers, rows, camera, inside, count)
        found = self._duals(motion, duals, camera, self.seen.columns)
        predicted = np.stack([np.broadcast_to(value_of(one), rows) for one in found], axis=-1)
        jacobian = np.empty((rows, len(found), count))
        for c, one in enumerate(found):
            jacobian[:, c, order] = np.broadcast_to(slopes_of(one, 1)[0], (count, rows)).T
        if not (np.isfinite(predicted).all() and np.isfinite(jacobian).all()):
            raise SolverError("The motion has no derivative there.")
        return predicted, jacobian

    def others(self, values: Sequence[float], columns: Sequence[str], extra: Mapping[str, float]) -> tuple[Array, int]:
        """Return the derivatives of columns that were not observed, (rows, c, unknowns + extra)."""
        names = tuple(Unknown(name, None, value, "m", False) for name, value in extra.items())
        read = self.seen.read
        other = Observations(self.seen.time, tuple(columns), np.zeros((self.seen.time.size, len(columns))),
                             self.seen.rows, self.seen.label, read)  # fmt: skip
        model = RunModel(self.scenario, other, (*self.unknowns, *names), self.camera)
        _, jacobian = model.predict([*values, *extra.values()], self.seen.time.size, slopes=True)
        return np.asarray(jacobian), len(names)

    def orientation(self, values: Sequence[float], row: int) -> Array:
        """Return the orientation of the body at one row, (4,), of a model whose columns need it."""
        numbers = {one.key: float(value) for one, value in zip(self.unknowns, values, strict=True)}
        motion = self._motion(numbers, row + 1, camera_with(self.camera, numbers))
        return np.array([part[row] for part in motion.q])

    # The motion

    def times(self, rows: int, offset: float = 0.0) -> Array:
        """Return the times of the first rows on the clock of the scenario."""
        return self.seen.time[:rows] + offset

    def _motion(self, numbers: Mapping[str, float], rows: int, camera: Camera) -> Motion:
        """Return the motion in floats."""
        system, start = keys.moved(self.scenario, dict(numbers))
        times = self.times(rows, float(camera.time_offset))
        form, _ = (None, None) if self._turned else by_formula.form_throughout(system, start, float(times[-1]))
        if form is not None:
            parts, grown = form.motion_and_support_at(times - start.time)
            support = tuple(first + gone for first, gone in zip(start.support, grown, strict=True))
            return Motion(*parts[:3], None, system, times, support)
        begun = np.maximum(times, start.time)
        _, samples = methods.run(self.scenario.timing.method, system, start, begun)
        held = _held(samples, begun)
        r = held.position + held.velocity * (times - begun)[:, None]
        support = tuple(held.support_coordinates.T) if held.support_coordinates is not None else ()
        return Motion(Vector.of(r), Vector.of(held.velocity), Vector.of(held.angular_velocity),
                      tuple(held.orientation.T), system, times, support)  # fmt: skip

    def _in_duals(self, numbers: Mapping[str, float], rows: int, camera: Camera, inside: int, count: int) -> Motion:
        """Return the motion in duals, with slopes by all that is unknown: the scenario's numbers come first."""
        listed = [keys.Key(name, number, "") for name, number in numbers.items()]
        duals = keys.varied(self.scenario, listed)  # names that it does not have only make room for slopes
        times = self.times(rows, float(value_of(camera.time_offset)))
        found = self._by_formula(numbers, duals, times, count)
        if found is not None:
            (r, V, Omega, _), grown = found
            support = tuple(first + gone for first, gone in zip(gathered(duals[1].support), grown, strict=True))
            motion = Motion(r, V, Omega, None, self._moving(duals[0]), times, support)
        else:
            system, start = keys.moved(self.scenario, dict(numbers))
            begun = np.maximum(times, start.time)
            own = keys.varied(self.scenario, listed[:inside])
            followed = (
                by_formula.follow_formula(system, start, begun, own, list(numbers)[:inside]) if self._turned else None
            )
            if followed is None:
                followed = follow(system, start, begun, own, list(numbers)[:inside], of_motion=True)
            motion = _as_duals(followed, self._moving(duals[0]), begun, times, inside, count)
        if isinstance(camera.time_offset, Dual):
            shift = Dual(0.0, camera.time_offset.slopes)
            moved = Vector(*(one + v * shift for one, v in zip(motion.r, motion.V, strict=True)))
            clock: Any = Dual(times, shift.slopes)
            motion = Motion(moved, motion.V, motion.Omega, motion.q, motion.system, clock, motion.support)
        return motion

    def _moving(self, system: RollingSystem) -> RollingSystem:
        """Return the system with its slopes gathered, where a column looks at the support itself."""
        own = any(name == "angle" or name.startswith("mark_") for name in self.seen.columns)
        return gathered(system) if own else system

    def _by_formula(
        self, numbers: Mapping[str, float], duals: tuple[RollingSystem, State], times: Array, count: int
    ) -> Moved | None:
        """Return the motion in duals by the closed form that covers all of the run, if it has derivatives.

        Where no event can come, whatever the numbers, that is asked once.
        """
        if self._turned:
            return None
        since = times - float(duals[1].time)
        if self._form:
            return by_formula.motion_in_duals(gathered(self._form[0].of(*duals)), since)
        system, start = keys.moved(self.scenario, dict(numbers))
        form, now = by_formula.form_throughout(system, start, float(times[-1]))
        if form is None:
            return None
        check_brink(system, now)
        varied = by_formula.form_in_duals(type(form), duals[0], transitions.at_start(*duals), count)
        moved = None if varied is None else by_formula.motion_in_duals(gathered(varied), since)
        names = now.law.event_functions(system, now.time, now.state_vector, now.event_parameters)
        if moved is not None and set(names) <= form.impossible_events:
            self._form.append(type(form))
        return moved

    @property
    def _turned(self) -> bool:
        return bool(_TURNED.intersection(self.seen.columns))

    # The columns

    def _columns(self, motion: Motion, numbers: Mapping[str, Any], camera: Camera, columns: Sequence[str]) -> Array:
        found = self._duals(motion, numbers, camera, columns)
        size = np.size(motion.time)
        return np.stack([np.broadcast_to(np.asarray(one, dtype=float), size) for one in found], axis=-1)

    def _duals(self, motion: Motion, numbers: Mapping[str, Any], camera: Camera, columns: Sequence[str]) -> list[Any]:
        known: dict[str, Vector] = {}
        makers = {"": self._place, "v": self._velocity, "w": self._turning, "mark_": self._mark, "spot_": self._spot,
                  "gyro_": self._gyroscope, "unrolled_": self._unrolled}  # fmt: skip
        found = []
        for name in columns:
            if name == "angle":
                found.append(self._angle(motion, numbers))
                continue
            what, axis = name[:-1], name[-1]
            if what not in known:
                known[what] = makers[what](motion, numbers, camera)
            found.append(getattr(known[what], axis))
        return found

    def _place(self, motion: Motion, numbers: Mapping[str, Any], camera: Camera) -> Vector:  # noqa: ARG002
        return camera.sees(motion.r)

    def _velocity(self, motion: Motion, numbers: Mapping[str, Any], camera: Camera) -> Vector:  # noqa: ARG002
        return camera.turned(motion.V) * camera.scale

    def _turning(self, motion: Motion, numbers: Mapping[str, Any], camera: Camera) -> Vector:  # noqa: ARG002
        return camera.turned(motion.Omega)

    def _mark(self, motion: Motion, numbers: Mapping[str, Any], camera: Camera) -> Vector:
        there = vector_of(numbers, "mark.position", 2)
        return camera.sees(motion.system.support.motion.at(motion.time, *motion.support).carried(there))

    def _spot(self, motion: Motion, numbers: Mapping[str, Any], camera: Camera) -> Vector:
        return camera.sees(motion.r + rotated(motion.q, vector_of(numbers, "spot.position", 3)))

    def _gyroscope(self, motion: Motion, numbers: Mapping[str, Any], camera: Camera) -> Vector:  # noqa: ARG002
        """Return Ω along the axes of a gyroscope that is fixed in the body, and what it shows at rest besides."""
        own = Quaternion(*motion.q).conjugate.matrix() @ motion.Omega
        bias = Vector(*(numbers.get(f"{BIAS}[{i}]", 0.0) for i in range(3)))
        return turn_by(vector_of(numbers, MOUNTING, 3)).conjugate.matrix() @ own + bias

    def _unrolled(self, motion: Motion, numbers: Mapping[str, Any], camera: Camera) -> Vector:  # noqa: ARG002
        """Return Ω along the axes in which a gyroscope begins."""
        return turn_by(vector_of(numbers, MOUNTING, 3)).conjugate.matrix() @ motion.Omega

    def _angle(self, motion: Motion, numbers: Mapping[str, Any]) -> Any:
        """Return the turn of the support, by as many whole turns more as bring it next to what was measured."""
        pose = motion.system.support.motion.at(motion.time, *motion.support).rotation
        first = pose @ Vector(1.0, 0.0, 0.0)
        angle = namespace(first.x, first.y).atan2(first.y, first.x) + numbers["mark.angle"]
        measured = self.seen.column("angle")[: np.size(value_of(motion.time))]
        turns = np.round((np.nan_to_num(measured) - value_of(angle)) / (2 * np.pi))
        return angle + turns * (2 * np.pi)


def _held(samples: Samples, times: Array) -> Any:
    """Return samples at all times: where the run ends early the body stays, which no fit will like."""
    if samples.time.size == times.size:
        return samples
    places = np.clip(np.searchsorted(samples.time, times, side="right") - 1, 0, samples.time.size - 1)
    support = samples.support_coordinates
    return Samples(
        times,
        samples.position[places],
        samples.contact[places],
        samples.velocity[places] * (times <= samples.time[-1])[:, None],
        samples.angular_velocity[places],
        samples.orientation[places],
        samples.contact_force[places],
        phase=samples.phase[places],
        support_coordinates=None if support is None else support[places],
    )


def _as_duals(followed: Followed, system: RollingSystem, begun: Array, times: Array, inside: int, count: int) -> Motion:
    """Return what was followed as duals of arrays."""
    held, slopes = _held(followed.samples, begun), followed.slopes
    places = np.clip(np.searchsorted(followed.samples.time, begun), 0, followed.samples.time.size - 1)

    def parts(values: Array, name: str) -> list[Dual]:
        of = np.zeros((count, *values.shape))
        of[:inside] = np.moveaxis(slopes[name][places], 2, 0)
        return [Dual(values[:, i], (of[:, :, i],)) for i in range(values.shape[1])]

    V = parts(held.velocity, "velocity")
    late = times - begun  # less than 0 where the run begins a little later
    r = [one + v * late for one, v in zip(parts(held.position, "position"), V, strict=True)]
    coordinates = held.support_coordinates
    support = () if coordinates is None or not coordinates.shape[1] else tuple(parts(coordinates, "support"))
    Omega = Vector(*parts(held.angular_velocity, "angular_velocity"))
    return Motion(Vector(*r), Vector(*V), Omega, parts(held.orientation, "orientation"), system, times, support)
