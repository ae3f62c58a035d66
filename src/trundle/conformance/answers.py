"""What came back from an adapter: read, and named where it is not what was asked for."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import permutations, product
from typing import Any

import numpy as np

from .case import END, PARTS, Array, Case, Input, Motion, extent, in_body_axes

OK, CANNOT, FAILED, NOT_FINITE, BAD = "ok", "cannot", "failed", "not finite", "bad answer"
TOO_SLOW, NOT_INSTALLED = "too slow", "not installed"
_LOOSE = 1e-3  # of a unit quaternion's length, and of a start relative to its size: float32 is far inside
_LARGE_TURN = 2.0  # rad between samples: beyond it differences of orientations do not tell Ω
_SLOW, _FEWEST = 0.05, 10  # share of the highest rate from which a sample tells, and how many must
_DISAGREES, _AGREES = 0.02, 0.1  # of a rate, in the middle of all samples; share of that which another reading leaves
_STILL = 1e-6  # of the other rate: float32 moves more
_LENGTHS = {"it is in mm": 1e3, "it is in cm": 1e2, "it is in km": 1e-3}
# What may stand in the place of (x, y, z), with the matrix that takes it back; few signs first.
_AXES = {
    f"({', '.join(sign + axis for sign, axis in zip(signs, axes, strict=True))})": np.array(
        [[(-1.0 if sign else 1.0) * (axis == own) for own in "xyz"] for sign, axis in zip(signs, axes, strict=True)]
    )
    for signs in sorted(product(("", "-"), repeat=3), key=lambda signs: sum(map(len, signs)))
    for axes in permutations("xyz")
    if any(signs) or axes != tuple("xyz")
}


@dataclass(frozen=True)
class Answer:
    """An adapter's answer to one task.

    Parameters
    ----------
    outcome : str
        "ok", "cannot", "failed", "not finite", "bad answer", "too slow" or "not installed".
    message : str
        The reason where it is not "ok".
    motion : Motion, optional
        Where it is.
    seconds : float
        Processor time of the stepping, s.
    engine : str
        Name and version, as the adapter says them.
    derivatives : dict
        Where they were asked for: by each way that the engine has, for each input, an array of the shape of
        `Input.exact`, or why there is none.
    """

    outcome: str
    message: str = ""
    motion: Motion | None = None
    seconds: float = float("nan")
    engine: str = ""
    derivatives: dict[str, list[Array | str]] = field(default_factory=dict)


class _BadAnswerError(ValueError):
    """What is wrong with an answer."""


def read_answer(line: str, case: Case, number: int, inputs: Sequence[Input] = ()) -> Answer:
    """Read the line that answers the task of this number; whatever is wrong is said in the answer, and never raised.

    Examples
    --------
    >>> import trundle as tr
    >>> read_answer("Hello, world!", tr.conformance.cases()[0], 1).message
    "not JSON: 'Hello, world!'"
    """
    try:
        told = json.loads(line)
    except (ValueError, RecursionError):
        return Answer(BAD, f"not JSON: {_cut(line)!r}")
    if not isinstance(told, dict):
        return Answer(BAD, f"not an object of JSON: {_cut(line)!r}")
    engine = str(told.get("engine", ""))
    if told.get("task") != number:
        said = f"it is {json.dumps(told['task'])}" if "task" in told else "it is missing"
        return Answer(BAD, f"`task` must be that of the task, {number}; {_cut(said)}", engine=engine)
    for outcome in (CANNOT, FAILED):
        if outcome in told:
            return Answer(outcome, _cut(str(told[outcome])), engine=engine)
    try:
        motion = _motion(told, case)
        _check_start(motion, case)
        _check_rates(motion, extent(case))
        _check_axes(motion, case)
        seconds = float(_array({"seconds": float("nan")} | told, "seconds", ()))
        return Answer(OK, "", motion, seconds, engine, _derivatives(told, inputs) if inputs else {})
    except FloatingPointError as error:
        return Answer(NOT_FINITE, str(error), engine=engine)
    except (_BadAnswerError, TypeError) as error:
        return Answer(BAD, str(error), engine=engine)


def _cut(text: str) -> str:
    """Return the beginning of what may be long, on one line."""
    line = " ".join(text.split())
    return line if len(line) <= 200 else line[:197] + "..."


def _array(told: dict[str, Any], name: str, shape: tuple[int, ...]) -> Array:
    """Return an array of the answer, of the shape that was asked for."""
    if name not in told:
        raise _BadAnswerError(f"`{name}` is missing")
    try:
        found = np.array(told[name], dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise _BadAnswerError(f"`{name}` must be an array of numbers of shape {shape}") from None
    if found.shape != shape:
        raise _BadAnswerError(f"`{name}` must have the shape {shape}; it has {found.shape}")
    return found


def _motion(told: dict[str, Any], case: Case) -> Motion:
    """Return the motion of an answer, its numbers finite and its quaternions of length 1."""
    wanted, count = case.times(), len(case.situation()["bodies"])
    arrays = {name: _array(told, name, (wanted.size, count, size)) for name, size in PARTS.items()}
    time = _array(told, "time", wanted.shape)
    if not np.allclose(time, wanted, rtol=0, atol=_LOOSE * case.every):
        raise _BadAnswerError(f"`time` must be 0 to {case.duration:g} s by {case.every:g} s")
    support = _array(told, "support", (wanted.size, 2)) if told.get("support") is not None else None
    for name, array in (arrays | ({} if support is None else {"support": support})).items():
        bad = ~np.isfinite(array).all(axis=tuple(range(1, array.ndim)))
        if bad.any():
            raise FloatingPointError(f"`{name}` is not a finite number from t = {wanted[bad.argmax()]:g} s on")
    length = np.linalg.norm(arrays["orientation"], axis=-1, keepdims=True)
    worst = float(np.abs(length - 1).max())
    if worst > _LOOSE:
        raise _BadAnswerError(f"`orientation` must hold unit quaternions; a length is off by {worst:.2g}")
    arrays["orientation"] = arrays["orientation"] / length
    return Motion(time=wanted, support=support, **arrays)


def _derivatives(told: dict[str, Any], inputs: Sequence[Input]) -> dict[str, list[Array | str]]:
    """Return the derivatives of the final state by each way, in the order of the inputs."""
    ways = told.get("derivatives", {})
    if not isinstance(ways, dict):
        raise _BadAnswerError("`derivatives` must be an object, with a list for each way to them")
    found: dict[str, list[Array | str]] = {}
    for name, each in ways.items():
        way = _cut(name)
        if not isinstance(each, list) or len(each) != len(inputs):
            raise _BadAnswerError(f"`derivatives`, {way}: must be a list of {len(inputs)}, one for each direction")
        pairs = zip(inputs, each, strict=True)
        found[way] = [_slopes(one, f"{way}, {wanted.name}", len(wanted.exact)) for wanted, one in pairs]
    return found


def _slopes(told: Any, where: str, bodies: int) -> Array | str:
    """Return the derivatives by one input, or why there are none."""
    if isinstance(told, str):
        return _cut(told)
    if not isinstance(told, dict):
        raise _BadAnswerError(f"`derivatives`, {where}: must be an object, or a text that says why there are none")
    try:
        slopes = np.concatenate([_array(told, part, (bodies, 3)) for part in END], axis=1)
    except _BadAnswerError as error:
        raise _BadAnswerError(f"`derivatives`, {where}: {error}") from None
    return slopes if np.isfinite(slopes).all() else "they are not finite"


def _check_start(motion: Motion, case: Case) -> None:
    """Name what is not at the start what the task says: other axes, or another order of the quaternion."""
    bodies = case.situation()["bodies"]
    given = {name: np.array([body[name] for body in bodies]) for name in PARTS}
    for name in ("position", "velocity", "angular_velocity"):
        begun, size = getattr(motion, name)[0], max(1.0, float(np.abs(given[name]).max()))
        apart = np.abs(begun - given[name])
        off = float(apart.max())
        if name == "position":  # a contact that is a spring starts in balance, a little lower
            for words, unit in _LENGTHS.items():
                near = np.abs(begun / unit - given[name]).max() <= _LOOSE * extent(case)
                if near and off > _LOOSE * extent(case):
                    raise _BadAnswerError(f"`position` at the start is off by {off:.3g}: {words}")
            size = 0.5 * extent(case) / _LOOSE
            apart = apart * [5.0, 5.0, 1.0]  # but not aside
        if apart.max() <= _LOOSE * size:
            continue
        turned = in_body_axes(given["orientation"], given[name])
        if name == "angular_velocity" and np.abs(begun - turned).max() <= _LOOSE * size:
            raise _BadAnswerError("`angular_velocity` is in the axes of the body: it must be in those of space")
        raise _BadAnswerError(f"`{name}` at the start is off by {off:.3g}: it must be what the task says")
    q, p = motion.orientation[0], given["orientation"]
    if _apart(q, p) > _LOOSE:
        remedy = "it must be what the task says, (w, x, y, z)"
        if _apart(q[:, [3, 0, 1, 2]], p) <= _LOOSE:
            remedy = "it is (x, y, z, w), and must be (w, x, y, z)"
        elif _apart(q * [1, -1, -1, -1], p) <= _LOOSE:
            remedy = "it turns from space to body, and must turn from body to space"
        raise _BadAnswerError(f"`orientation` at the start is wrong: {remedy}")


def _check_rates(motion: Motion, size: float) -> None:
    """Name velocities that the positions contradict, and angular velocities that the orientations do."""
    step, q = motion.time[1] - motion.time[0], motion.orientation
    least = _LOOSE / motion.time[-1]  # what stays may tremble in its last digits
    back, Omega = q * [1, -1, -1, -1], motion.angular_velocity
    moved, turned, turned_back = np.diff(motion.position, axis=0), _turns(q), _turns(back)
    turned[np.linalg.norm(turned, axis=-1) > _LARGE_TURN] = np.nan  # it may have been the other way round
    speeds = {f"{words}/s": unit for words, unit in _LENGTHS.items()}
    _check_rate("velocity", "the position changes", moved / step, motion.velocity, speeds, {}, least * size)
    others = {
        "it is in the axes of the body": (turned / step, in_body_axes(back, Omega)),
        "`orientation` turns from space to body": (turned_back / step, Omega),
    }
    _check_rate(
        "angular_velocity", "the body turns", turned / step, Omega, {"it is in degrees/s": 180 / np.pi}, others, least
    )


def _check_rate(
    name: str,
    what: str,
    seen: Array,
    told: Array,
    units: Mapping[str, float],
    others: Mapping[str, tuple[Array, Array]],
    least: float,
) -> None:
    """Name what a rate is, if another reading of it agrees with what is seen, and it does not itself."""
    size = np.linalg.norm(seen, axis=-1)
    known = size[np.isfinite(size)]
    if known.size < _FEWEST:
        return
    fastest, said = known.max(), np.linalg.norm(told, axis=-1).max()
    if max(fastest, said) < least:
        return
    if min(fastest, said) < _STILL * max(fastest, said):
        raise _BadAnswerError(f"`{name}` is not how {what}: {'it is zero' if said < fastest else 'nothing changes'}")
    tells = size > _SLOW * fastest
    if tells.sum() < _FEWEST:
        return

    def apart(seen: Array, told: Array) -> float:
        middle = 0.5 * (told[1:] + told[:-1])
        return float(np.median(np.linalg.norm(seen - middle, axis=-1)[tells] / size[tells]))

    itself = apart(seen, told)
    tries = {**others, "its sign is wrong": (seen, -told)}
    tries |= {words: (seen, told / unit) for words, unit in units.items()}
    tries |= {f"it is {words}": (seen, told @ matrix) for words, matrix in _AXES.items()}
    for words, reading in tries.items():
        if itself > _DISAGREES and apart(*reading) < _AGREES * itself:
            raise _BadAnswerError(f"`{name}` is not how {what}: {words}")


def _check_axes(motion: Motion, case: Case) -> None:
    """Name axes and units that neither a start nor rates tell: the motion is the exact one in others."""
    exact = case.exact()
    for name in ("position", "velocity", "angular_velocity"):
        true, found = getattr(exact, name), getattr(motion, name)
        if name == "position":
            true, found = true - true[:1], found - found[:1]
        apart, size = np.abs(found - true).max(), np.abs(true).max()
        if apart <= _DISAGREES * size:
            continue
        readings = {f"it is {words}": found @ matrix for words, matrix in _AXES.items()}
        if name != "angular_velocity":
            readings |= {words: found / unit for words, unit in _LENGTHS.items()}
        for words, reading in readings.items():
            if np.abs(reading - true).max() < _AGREES * min(apart, size):
                raise _BadAnswerError(f"`{name}` is in other axes or units: {words}")


def _turns(q: Array) -> Array:
    """Return the turn from each orientation to the next as a vector along its axis, rad."""
    w, u = q[..., :1], q[..., 1:]
    dw = (q[1:] * q[:-1]).sum(-1, keepdims=True)
    dv = w[:-1] * u[1:] - w[1:] * u[:-1] - np.cross(u[1:], u[:-1])
    sine = np.linalg.norm(dv, axis=-1, keepdims=True)
    turns: Array = np.sign(dw) * dv * 2 * np.arctan2(sine, np.abs(dw)) / sine.clip(1e-300)
    return turns


def _apart(p: Array, q: Array) -> float:
    """Return by how much unit quaternions differ, whatever their sign."""
    return float((1 - np.abs((p * q).sum(-1))).max())
