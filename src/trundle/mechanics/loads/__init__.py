"""Loads on the body, one file a family: force and torque about its centre of mass, in the inertial support frame.

A new load is one class with `force`, `torque` and, if it has one, `potential`; `tests/contracts` has the test to
inherit.
"""

from __future__ import annotations

from .air import Drag
from .base import Acting, BodyMotion, Load, at_rest, constant_part
from .given import Force, Gravity, Torque

__all__ = ["Acting", "BodyMotion", "Drag", "Force", "Gravity", "Load", "Torque", "at_rest", "constant_part"]
