"""What came back from an adapter: read, and named where it is not what was asked for."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .case import END, PARTS, Array, Case, Input, Motion, extent, in_body_axes

OK, CANNOT, FAILED, NOT_FINITE, BAD = "ok", "cannot", "failed", "not finite", "bad answer"
TOO_SLOW, NOT_INSTALLED = "too slow", "not installed"
_LOOSE = 1e-3  # of a unit quaternion's length, and of a start relative to its size: float32 is far inside
_SMALL_TURN = 0.5  # rad between samples: up to there differences of orientations tell Ω
_AGREES, _DISAGREES = 0.1, 0.5  # of the rate of turning, in the middle of all samples


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
        _check_turning(motion)
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
        off = float(np.abs(begun - given[name]).max())
        if name == "position":  # a contact that is a spring starts in balance, a little lower
            size = 0.5 * extent(case) / _LOOSE
        if off <= _LOOSE * size:
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


def _check_turning(motion: Motion) -> None:
    """Name axes of the angular velocity that the orientations contradict, where samples are close enough to tell."""
    q, Omega = motion.orientation, motion.angular_velocity
    w, u = q[..., :1], q[..., 1:]
    step = motion.time[1] - motion.time[0]
    # Twice the vector part of q(t + h) q(t)* is Ω h between the samples, for a small turn.
    dw = (q[1:] * q[:-1]).sum(-1, keepdims=True)
    dv = w[:-1] * u[1:] - w[1:] * u[:-1] - np.cross(u[1:], u[:-1])
    seen = 2 * dv * np.sign(dw) / step
    middle = 0.5 * (Omega[1:] + Omega[:-1])
    size = np.linalg.norm(middle, axis=-1)
    tells = (size * step < _SMALL_TURN) & (size > _LOOSE / step)
    if tells.sum() < 10:
        return

    def apart(other: Array) -> float:
        return float(np.median((np.linalg.norm(seen - other, axis=-1) / np.maximum(size, 1e-30))[tells]))

    if apart(middle) < _DISAGREES:
        return
    tries: dict[str, Callable[[Array], Array]] = {
        "it is in the axes of the body": lambda x: in_body_axes(q[1:] * [1, -1, -1, -1], x),
        "its sign is wrong": lambda x: -x,
        "it is in degrees a second": np.radians,
    }
    for words, change in tries.items():
        if apart(change(middle)) < _AGREES:
            raise _BadAnswerError(f"`angular_velocity` is not how the body turns: {words}")


def _apart(p: Array, q: Array) -> float:
    """Return by how much unit quaternions differ, whatever their sign."""
    return float((1 - np.abs((p * q).sum(-1))).max())
