"""MJCF, the models of MuJoCo: the start is a keyframe."""

from __future__ import annotations

from typing import Any

from ...mechanics.algebra import Quaternion, Vector
from ..case import Task
from .writing import REACH, add, disc, lone_body, six, written


def write(said: str, situation: Task) -> str:
    """Write the model; contacts are as MuJoCo has them, but for the friction cone, which is round."""
    body, support = lone_body(situation), situation["support"]
    root = add(None, "mujoco")
    add(root, "compiler", angle="radian", balanceinertia="false", boundmass=0.0, boundinertia=0.0)
    add(root, "option", gravity=situation["gravity"], cone="elliptic")
    world = add(root, "worldbody")
    turning = _support(world, support)
    _body(world, body)
    mu = situation["friction"]
    pair = add(add(root, "contact"), "pair", geom1="body", geom2="support", condim="3")
    pair.set("friction", f"{mu!r} {mu!r} 0 0 0")  # none against spinning and rolling
    spin = Quaternion(*body["orientation"]).matrix().transpose @ Vector(*body["angular_velocity"])  # body axes
    places = [*([0.0] if turning else []), *body["position"], *body["orientation"]]
    rates = [*([support["motion"]["rate"]] if turning else []), *body["velocity"], *map(float, spin)]
    add(add(root, "keyframe"), "key", name="start", qpos=places, qvel=rates)
    return written(root, said)


def _support(world: Any, support: Task) -> bool:
    """Write the support, and say whether it turns; only the pair below touches, so that nothing is counted twice."""
    shown = {"name": "support", "contype": "0", "conaffinity": "0"}
    turning = support["motion"]["kind"] == "hinge"
    if turning:
        world = add(world, "body", name="support")
        add(world, "joint", name="axle", type="hinge", axis=(0, 0, 1))
        add(world, "inertial", pos=(0, 0, 0), mass=1, diaginertia=(1, 1, support["motion"]["inertia"]))
    if support["kind"] == "dome":
        add(world, "geom", type="sphere", size=support["radius"], pos=(0, 0, -support["radius"]), **shown)
    elif turning:  # a plane may not turn
        add(world, "geom", type="cylinder", size=(REACH, 0.5), pos=(0, 0, -0.5), **shown)
    else:
        add(world, "geom", type="plane", size=(REACH, REACH, 1), **shown)
    return turning


def _body(world: Any, body: Task) -> None:
    made = add(world, "body", name="body", pos=body["position"], quat=body["orientation"])
    add(made, "joint", name="body", type="free")
    add(made, "inertial", pos=(0, 0, 0), mass=body["mass"], fullinertia=six(body["inertia"]).values())
    shape = body["shape"]
    kind, size = {
        "sphere": lambda: ("sphere", [shape["radius"]]),
        "disc": lambda: ("cylinder", disc(shape)),
        "ellipsoid": lambda: ("ellipsoid", shape["semi_axes"]),
    }[shape["kind"]]()
    add(made, "geom", name="body", type=kind, size=size, pos=body["offset"], contype="0", conaffinity="0")
