"""SDFormat, the worlds of Gazebo, which Drake and Bullet read as well; it has no velocities that they would read."""

from __future__ import annotations

from typing import Any

from ..case import Task
from .writing import REACH, THICK, add, angles, disc, lone_body, six, written

_NO_LIMIT = 1e16  # rad: the format's own word for none


def write(said: str, situation: Task) -> str:
    """Write a world with the support and the body."""
    body = lone_body(situation)
    root = add(None, "sdf", version="1.9")
    world = add(root, "world", name="trundle")
    add(world, "gravity", situation["gravity"])
    _support(world, situation)
    model = add(world, "model", name="body")
    add(model, "pose", [*body["position"], *angles(body["orientation"])])
    link = add(model, "link", name="body")
    _inertial(link, body["mass"], six(body["inertia"]))
    shape = body["shape"]
    _collision(link, "body", shape["kind"], shape, situation, body["offset"])
    return written(root, said)


def _support(world: Any, situation: Task) -> None:
    """Write the support: a model of its own, at rest or on an axle."""
    support = situation["support"]
    model = add(world, "model", name="support")
    motion = support["motion"]
    turning = motion["kind"] == "hinge"
    if not turning:
        add(model, "static", "true")
    link = add(model, "link", name="support")
    if turning:
        axle = add(model, "joint", name="axle", type="revolute")
        add(axle, "parent", "world")
        add(axle, "child", "support")
        axis = add(axle, "axis")
        add(axis, "xyz", (0, 0, 1))
        limit = add(axis, "limit")
        add(limit, "lower", -_NO_LIMIT)
        add(limit, "upper", _NO_LIMIT)
        table = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, motion["inertia"]]]
        _inertial(link, 1.0, six(table))
    kind = "table" if turning and support["kind"] == "plane" else support["kind"]
    offset = {"dome": -support.get("radius", 0.0), "table": -THICK / 2, "plane": 0.0}[kind]
    _collision(link, "support", kind, support, situation, [0.0, 0.0, offset])


def _inertial(link: Any, mass: float, inertia: dict[str, float]) -> None:
    made = add(link, "inertial")
    add(made, "mass", mass)
    tensor = add(made, "inertia")
    for key, value in inertia.items():
        add(tensor, key, value)


def _collision(link: Any, name: str, kind: str, shape: Task, situation: Task, offset: list[float]) -> None:
    """Write a shape with what it is like to touch; both partners say the same, however an engine mixes them."""
    made = add(link, "collision", name=name)
    add(made, "pose", [*offset, 0, 0, 0])
    geometry = add(made, "geometry")
    if kind in ("sphere", "dome"):
        add(add(geometry, "sphere"), "radius", shape["radius"])
    elif kind == "ellipsoid":
        add(add(geometry, "ellipsoid"), "radii", shape["semi_axes"])
    elif kind == "plane":
        plane = add(geometry, "plane")
        add(plane, "normal", (0, 0, 1))
        add(plane, "size", (2 * REACH, 2 * REACH))
    else:
        radius, half = disc(shape) if kind == "disc" else (REACH, THICK / 2)
        cylinder = add(geometry, "cylinder")
        add(cylinder, "radius", radius)
        add(cylinder, "length", 2 * half)
    surface = add(made, "surface")
    cone = add(add(surface, "friction"), "ode")
    add(cone, "mu", situation["friction"])
    add(cone, "mu2", situation["friction"])
    add(add(surface, "bounce"), "restitution_coefficient", situation["restitution"])
