"""What is compared over windows: the slope of something they wrote, and what it should be by the rest and the law."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.system import RollingSystem
from .laws import Rates
from .motion import Instants, Motion
from .record import Array, ExternalTrajectory
from .slopes import Index

PATH, TURN = "velocity is the slope of the path", "orientation turns as Ω"
ACCELERATION, TURNING = "law of motion, acceleration", "law of motion, angular acceleration"
SHIFTED = 24  # instants at which it is seen what the law makes of errors in the states
_STEP = 1e-4  # of the scale of a part of the state: the least by which it is shifted

Gains = dict[str, Array]


ACCELERATES, TURNS, SLIPS, LIFTS = range(4)  # what is asked of the states: V̇, Ω̇, s and the gap


@dataclass(frozen=True)
class Sensitivity:
    """What errors of the states do to what follows from them, at some instants: the longest vector for a unit of each.

    `curvature` is what noise does to their means.
    """

    time: Array
    gains: tuple[Gains, ...]
    curvature: tuple[Array, ...]

    def gains_at(self, which: int, time: Array) -> Gains:
        """Return the gains of one of them at other instants."""
        return {name: np.interp(time, self.time, gain) for name, gain in self.gains[which].items()}

    def curvature_at(self, which: int, time: Array) -> Array:
        """Return what noise does to the mean of one of them at other instants."""
        return np.interp(time, self.time, self.curvature[which])


def sensitivity_of(
    system: RollingSystem, asked: Callable[[Instants], Sequence[Array]], at: Motion
) -> tuple[Sensitivity, tuple[Array, ...]]:
    """Shift the states to either side, part by part, and see what becomes of what follows from them."""
    steps, spreads = [], []
    for name, scale in _scales(system, at).items():
        spread = at.estimates[name].spread[:, None]
        step = np.maximum(spread, _STEP * scale)
        spreads += [(name, step, spread)] * 3
        steps += [(name, side * step * e) for e in np.eye(3) for side in (1.0, -1.0)]
    m, found = at.time.size, asked(at.shifted(system, steps))
    stacked = [array.reshape(1 + len(steps), m, -1) for array in found]
    gains: list[Gains] = []
    curvature = []
    for values in stacked:
        squares: dict[str, list[Array]] = {}
        bend = np.zeros_like(values[0])
        for (name, step, spread), ahead, back in zip(spreads, values[1::2], values[2::2], strict=True):
            squares.setdefault(name, []).append((ahead - back) / (2 * step))
            bend += 0.5 * (ahead + back - 2 * values[0]) * (spread / step) ** 2
        gains.append({name: np.linalg.norm(np.stack(rows, -1), 2, axis=(1, 2)) for name, rows in squares.items()})
        curvature.append(np.linalg.norm(bend, axis=1))
    return Sensitivity(at.time, tuple(gains), tuple(curvature)), tuple(values[0] for values in stacked)


def _scales(system: RollingSystem, at: Motion) -> dict[str, float]:
    """Return the parts of the state that the law depends on, with the size of each."""
    extent = max(float(np.ptp(at.position, axis=0).max()), at.arm)
    speed = max(_largest(at.velocity, np.cross(at.angular_velocity, at.offset)), 1e-3 * at.arm)
    turning = speed / at.arm
    scales = {"position": extent, "velocity": speed, "angular_velocity": turning, "orientation": 1.0, "spin": turning}
    if system.body.is_isotropic_sphere:
        del scales["orientation"]
    return {name: scale for name, scale in scales.items() if name in at.estimates}


@dataclass(frozen=True)
class Comparison:
    """One slope of what they wrote, and what it should be."""

    name: str  # of the figure
    array: str  # which of theirs
    order: int  # which derivative of it
    rate: Callable[[Motion, Rates], Array]  # (motion, rates of the law) -> what it should be, (m, c)
    # (motion, sensitivity) -> what errors of each part of the state do to that
    gains: Callable[[Motion, Sensitivity], Gains]
    which: int | None = None  # `ACCELERATES` or `TURNS`, where it takes the one or the other from the law
    turning: bool = False  # whether it is a slope of quaternions: twice the mismatch, times q*, is one of vectors

    def vectors(self, at: Motion, place: Index, mismatch: Array) -> Array:
        """Return the mismatch of each window as a vector, (k, 3)."""
        if not self.turning:
            return mismatch
        q = at.orientation[place[:, place.shape[1] // 2]]
        return 2 * (Quaternion.of(mismatch) * Quaternion.of(q).conjugate).array()[:, 1:]


def comparisons(theirs: ExternalTrajectory) -> Iterator[Comparison]:
    """Yield what can be compared of what they gave; where two have one name, the closer one is to be taken."""
    given = {name for name in ("velocity", "angular_velocity", "orientation") if getattr(theirs, name) is not None}
    given -= {"orientation"} & set(theirs.doubts)
    if "velocity" in given:
        yield Comparison(PATH, "position", 1, lambda at, _: at.velocity, _of_velocity)
        yield Comparison(ACCELERATION, "velocity", 1, _acceleration, _of_acceleration, ACCELERATES)
    yield Comparison(ACCELERATION, "position", 2, _acceleration, _of_acceleration, ACCELERATES)
    if {"angular_velocity", "orientation"} <= given:
        yield Comparison(TURN, "orientation", 1, _turn, _of_turn, turning=True)
    if "angular_velocity" in given:
        yield Comparison(TURNING, "angular_velocity", 1, lambda _, rates: rates[1], _of_turning, TURNS)
    elif "orientation" in given:
        yield Comparison(TURNING, "orientation", 2, _second_turn, _of_second_turn, TURNS, turning=True)


def _acceleration(_: Motion, rates: Rates) -> Array:
    return rates[0]


def _of_acceleration(at: Motion, law: Sensitivity) -> Gains:
    return law.gains_at(ACCELERATES, at.time)


def _of_turning(at: Motion, law: Sensitivity) -> Gains:
    return law.gains_at(TURNS, at.time)


def _of_velocity(at: Motion, _: Sensitivity) -> Gains:
    return {"velocity": np.ones(at.time.size)}


def _turn(at: Motion, _: Rates) -> Array:
    """Return q̇ = ½Ωq."""
    return np.asarray(Quaternion.of(at.orientation).rate(Vector.of(at.angular_velocity)).array(), dtype=float)


def _of_turn(at: Motion, _: Sensitivity) -> Gains:
    half = 0.5 * np.linalg.norm(at.angular_velocity, axis=1)
    return {"angular_velocity": np.full(at.time.size, 0.5), "orientation": half}


def _second_turn(at: Motion, rates: Rates) -> Array:
    """Return q̈ = ½Ω̇q − ¼Ω²q."""
    q = Quaternion.of(at.orientation)
    square = (at.angular_velocity**2).sum(axis=1, keepdims=True)
    return np.asarray(q.rate(Vector.of(rates[1])).array() - 0.25 * square * at.orientation, dtype=float)


def _of_second_turn(at: Motion, law: Sensitivity) -> Gains:
    gains = {name: 0.5 * gain for name, gain in law.gains_at(TURNS, at.time).items()}
    size = np.linalg.norm(at.angular_velocity, axis=1)
    for name, more in (("angular_velocity", 0.5 * size), ("orientation", 0.25 * size**2)):
        gains[name] = gains.get(name, 0.0) + more
    return gains


def _largest(*arrays: Array) -> float:
    return max(float(np.linalg.norm(array, axis=1).max()) for array in arrays)


def nodes_of(index: Mapping[str, Index]) -> tuple[Index, dict[str, Index]]:
    """Return all samples that windows look at, ascending, and where among them each window's nodes are.

    Examples
    --------
    >>> nodes_of({"a": np.array([[0, 2, 4]]), "b": np.array([[2, 3, 4]])})
    (array([0, 2, 3, 4]), {'a': array([[0, 1, 3]]), 'b': array([[1, 2, 3]])})
    """
    every = np.unique(np.concatenate([samples.ravel() for samples in index.values()]))
    return every, {name: np.searchsorted(every, samples) for name, samples in index.items()}
