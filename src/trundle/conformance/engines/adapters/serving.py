"""What every adapter shares: tasks come as lines of JSON on standard input, answers go as lines on standard output.

An engine may print what it likes: while it runs, its standard output goes to standard error. This file needs nothing
but Python, since it runs in the environment of the engine.
"""

from __future__ import annotations

import json
import math
import os
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

Task = dict[str, Any]
Read = Callable[[], Sequence[Sequence[Sequence[float]]]]
PARTS = ("position", "orientation", "velocity", "angular_velocity")
END = ("position", "velocity", "angular_velocity")  # of which derivatives are asked for


class CannotError(Exception):
    """What an engine has no words for; the message says why."""


def serve(run: Callable[[Task], Task]) -> None:
    """Answer task after task, until there are no more."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    for line in sys.stdin:
        task = json.loads(line)
        try:
            answer = run(task)
        except CannotError as error:
            answer = {"cannot": str(error)}
        except Exception as error:  # noqa: BLE001  whatever an engine raises is what it answers
            answer = {"failed": f"{type(error).__name__}: {error}"}
        answers.write(json.dumps({"task": task["task"], **answer}) + "\n")
        answers.flush()


def march(
    task: Task,
    engine: str,
    step: Callable[[int], None],
    read: Read,
    support: Callable[[], Sequence[float]] | None = None,
) -> Task:
    """Step an engine from sample to sample; return what it showed, and the processor time that the stepping took.

    Parameters
    ----------
    task : dict
        As it came.
    engine : str
        Name and version.
    step : callable
        Takes that many steps of task["dt"].
    read : callable
        Returns, for each body, position, orientation (w, x, y, z), velocity and angular velocity in space axes.
    support : callable, optional
        Returns the angle and the rate of a table on a hinge.
    """
    each = round(task["every"] / task["dt"])
    if each < 1 or abs(each * task["dt"] - task["every"]) > 1e-9:
        raise CannotError(f"its step of {task['dt']:g} s does not divide the time between samples")
    answer: Task = {"engine": engine, "time": [], **{part: [] for part in PARTS}}
    if support is not None:
        answer["support"] = []
    spent = 0.0
    count = round(task["duration"] / task["every"])
    for i in range(count + 1):
        answer["time"].append(i * task["every"])
        seen = read()
        for k, part in enumerate(PARTS):
            answer[part].append([[float(x) for x in body[k]] for body in seen])
        if support is not None:
            answer["support"].append([float(x) for x in support()])
        if i < count:
            began = time.process_time()
            step(each)
            spent += time.process_time() - began
    return {**answer, "seconds": spent}


def changes(direction: Task) -> set[str]:
    """Return what changes along a direction of differentiation: its keys that have a slope other than zero.

    Of what is within another, the innermost key is named; "start" stands for the state of a body, and the rate of a
    table on a hinge.
    """

    def within(key: str, part: Any) -> set[str]:
        if isinstance(part, dict):
            return set().union(*(within(*item) for item in part.items()))
        if isinstance(part, list):
            return set().union(*(within(key, each) for each in part))
        return {key} if not isinstance(part, str) and part != 0 else set()

    words = within("", direction)
    begins = {*PARTS, *(["rate"] if direction["support"]["motion"]["kind"] == "hinge" else [])}
    return words - begins | ({"start"} if words & begins else set())


def refuse(task: Task, reasons: dict[str, str]) -> None:
    """Refuse a task that has one of these words: a shape, a support, a motion of it, mesh, restitution or offset."""
    support = task["support"]
    words = {support["kind"], support["motion"]["kind"], *(body["shape"]["kind"] for body in task["bodies"])}
    if "mesh" in support:
        words.add("mesh")
    if task["restitution"]:
        words.add("restitution")
    if any(any(body["offset"]) for body in task["bodies"]):
        words.add("offset")
    for word, reason in reasons.items():
        if word in words:
            raise CannotError(reason)


def pieces(mesh: Task, share: float = 0.1) -> list[list[list[float]]]:
    """Return the six corners of a prism behind each triangle of a bowl, away from its middle by that share more.

    Each is convex and none is in the way of another: this is how engines whose meshes are convex are told of a bowl.
    """
    vertices = mesh["vertices"]
    middle = mesh["middle"]

    def behind(vertex: list[float]) -> list[float]:
        return [x + share * (x - m) for x, m in zip(vertex, middle, strict=True)]

    return [[vertices[i] for i in triangle] + [behind(vertices[i]) for i in triangle] for triangle in mesh["triangles"]]


def plates(np: Any, mesh: Task) -> list[tuple[Any, Any, float]]:
    """Return, for each triangle of a bowl, a middle, axes whose third points inwards, and how far the corners reach.

    A square plate behind it reaches farther than the triangle, but not into the bowl, which is convex.
    """
    found = []
    for corners in np.array(mesh["vertices"])[np.array(mesh["triangles"])]:
        middle = corners.mean(0)
        along = (corners[1] - corners[0]) / np.linalg.norm(corners[1] - corners[0])
        normal = np.cross(along, corners[2] - corners[0])
        normal /= np.linalg.norm(normal)
        reach = float(np.linalg.norm(corners - middle, axis=-1).max())
        found.append((middle, np.stack([along, np.cross(normal, along), normal], axis=-1), reach))
    return found


def rotation(q: Sequence[float]) -> list[list[float]]:
    """Return the matrix of a unit quaternion (w, x, y, z)."""
    w, x, y, z = q
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]


def principal_axes(inertia: Sequence[Sequence[float]]) -> tuple[list[float], list[float]]:
    """Return moments and the quaternion of the principal axes of an inertia that is diagonal but for its xy product."""
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = inertia
    if xz or yz:
        raise CannotError("this adapter takes products of inertia about the third axis only")
    angle = 0.5 * math.atan2(2 * xy, xx - yy) if xy else 0.0
    mean, half = 0.5 * (xx + yy), math.hypot(0.5 * (xx - yy), xy)
    moments = [mean + half, mean - half, zz] if xy else [xx, yy, zz]
    return moments, [math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)]


def turned(q: Sequence[float], vector: Sequence[float]) -> list[float]:
    """Turn a vector by a unit quaternion."""
    return [sum(a * b for a, b in zip(row, vector, strict=True)) for row in rotation(q)]


def backwards(q: Sequence[float], vector: Sequence[float]) -> list[float]:
    """Turn a vector back by a unit quaternion."""
    return turned([q[0], -q[1], -q[2], -q[3]], vector)


def cross(a: Sequence[float], b: Sequence[float]) -> list[float]:
    """Return the product a × b."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def times(p: Sequence[float], q: Sequence[float]) -> list[float]:
    """Multiply two quaternions."""
    a, b, c, d = p
    w, x, y, z = q
    return [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
