"""URDF, the robots of ROS: the body alone, with a free base; where it is and on what it rolls is the engine's."""

from __future__ import annotations

from ..case import Task
from .writing import add, disc, lone_body, six, written


def write(said: str, situation: Task) -> str:
    """Write one link: its inertia and its shape."""
    body = lone_body(situation)
    root = add(None, "robot", name="trundle")
    link = add(root, "link", name="body")
    inertial = add(link, "inertial")
    add(inertial, "mass", value=body["mass"])
    add(inertial, "inertia", **six(body["inertia"]))
    collision = add(link, "collision")
    add(collision, "origin", xyz=body["offset"], rpy=(0, 0, 0))
    geometry = add(collision, "geometry")
    if body["shape"]["kind"] == "sphere":
        add(geometry, "sphere", radius=body["shape"]["radius"])
    else:
        radius, half = disc(body["shape"])
        add(geometry, "cylinder", radius=radius, length=2 * half)
    return written(root, said)
