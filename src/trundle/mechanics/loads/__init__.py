"""Loads on the body, one file a family: force and torque about its centre of mass, in the inertial support frame.

A new load is one class with `force`, `torque` and, if it has one, `potential`; `tests/contracts` has the test to
inherit.
"""

from __future__ import annotations

from .air import Drag, Magnus, QuadraticDrag
from .base import Acting, BodyMotion, Load, at_rest, constant_part
from .contact import PivotFriction, RollingCouple, RollingResistance
from .field import Potential
from .given import Force, Gravity, Torque
from .inside import Motor

__all__ = [
    "Acting",
    "BodyMotion",
    "Drag",
    "Force",
    "Gravity",
    "Load",
    "Magnus",
    "Motor",
    "PivotFriction",
    "Potential",
    "QuadraticDrag",
    "RollingCouple",
    "RollingResistance",
    "Torque",
    "at_rest",
    "constant_part",
]
