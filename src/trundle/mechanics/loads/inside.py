"""What drives a body from inside: the motor of a spherical robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from ..algebra import Vector
from ..parts import Number, Numbers
from .base import BodyMotion
from .given import Given


@dataclass(frozen=True)
class Motor(Given):
    """A torque that is given in the body's own axes and turns with the body.

    Idealised: what the motor pushes off from (a pendulum, a flywheel) is nowhere in the equations, neither its weight
    nor its turning. With a flywheel it is right while the wheel's own momentum stays small beside the body's.

    Parameters
    ----------
    value : sequence of 3 floats, quantities or formulas
        The torque along the body's axes, N m; a formula such as ``"1e-3*sin(2*t)"`` is in SI, t in s.

    Examples
    --------
    >>> from trundle.mechanics.loads import at_rest
    >>> Motor((0.001, 0.0, 0.0)).torque(at_rest(1.0)).x
    0.001
    """

    value: Annotated[Any, Numbers(Number("torque", varies=True), "Along the body's axes, which turn with it.")]
    kind = "motor"
    label = "Motor torque"
    noun = "motor torque"

    def torque(self, motion: BodyMotion) -> Vector:
        """Return Q τ(t)."""
        turned: Vector = motion.orientation.matrix() @ self.at(motion.time)
        return turned

    @property
    def constant(self) -> bool:  # type: ignore[override]
        """False: it turns with the body."""
        return False

    @property
    def symmetric(self) -> bool:
        """True: it turns with the body."""
        return True
