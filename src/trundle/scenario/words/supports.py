"""From a surface and its motion back to their tables."""

from __future__ import annotations

from ...mechanics.motions import Fixed, Spin, UnevenSpin, Wobble
from ...mechanics.surfaces import Cylinder, Plane
from .parts import Describe, Words, moving, number_of


def _plane(plane: Plane, key: str) -> Words:
    rim = {} if plane.rim is None else {"rim": number_of(plane.rim, f"{key}.rim")}
    return {"kind": "plane", **rim}


def _cylinder(cylinder: Cylinder, key: str) -> Words:
    return {"kind": "cylinder", "radius": number_of(cylinder.radius, f"{key}.radius"), "side": cylinder.side}


SURFACES: Describe = {Plane: _plane, Cylinder: _cylinder}
MOTIONS: Describe = {
    Fixed: lambda motion, key: {"kind": "fixed"},  # noqa: ARG005
    Spin: lambda motion, key: moving("spin", motion, key),
    UnevenSpin: lambda motion, key: moving("uneven-spin", motion, key),
    Wobble: lambda motion, key: moving("wobble", motion, key),
}
