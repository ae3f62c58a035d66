"""Loads on the body, one file a family: force and torque about its centre of mass, in the inertial support frame.

A new load is one class with `force`, `torque` and, if it has one, `potential`; `tests/contracts` has the test to
inherit.
"""

from __future__ import annotations

# In the order in which lists name them.
# isort: skip_file
from .base import Acting, BodyMotion, Load, at_rest, constant_part
from .given import Force, Torque, Gravity
from .air import Drag, QuadraticDrag, Magnus
from .field import Potential
from .contact import RollingResistance, PivotFriction, RollingCouple
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
