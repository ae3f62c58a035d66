"""Tables of loads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from .values import AirRate, Coefficient, Force3, Table, Torque3

if TYPE_CHECKING:
    from ...mechanics.loads import Load


def _values(value: tuple[float | str, ...]) -> tuple[Any, ...]:
    return tuple(part if isinstance(part, str) else float(part) for part in value)


class ForceLoad(Table):
    """A force on the centre of mass, constant or given by formulas in the time t."""

    kind: Literal["force"]
    value: Force3 = Field(description="In the support frame, which does not turn with the support.")

    def build(self, support_rate: float = 0.0) -> Load:  # noqa: ARG002  only the air knows of it
        """Return the load."""
        from ...mechanics.loads import Force

        return Force(_values(self.value))


class TorqueLoad(Table):
    """A torque about the centre of mass, constant or given by formulas in the time t."""

    kind: Literal["torque"]
    value: Torque3 = Field(description="In the support frame, which does not turn with the support.")

    def build(self, support_rate: float = 0.0) -> Load:  # noqa: ARG002  only the air knows of it
        """Return the load."""
        from ...mechanics.loads import Torque

        return Torque(_values(self.value))


class DragLoad(Table):
    """Linear drag, the force -c (V - that of the air)."""

    kind: Literal["drag"]
    coefficient: Coefficient
    air: AirRate = Field(default="still", description='"still", "turning" with the support, or a rate of its own.')

    def build(self, support_rate: float = 0.0) -> Load:
        """Return the load; air that turns with the support has its rate on the whole."""
        from ...mechanics.loads import Drag

        rates = {"still": 0.0, "turning": support_rate}
        return Drag(float(self.coefficient), rates[self.air] if isinstance(self.air, str) else float(self.air))


Loads = ForceLoad | TorqueLoad | DragLoad

LOADS: dict[str, type[Table]] = {"force": ForceLoad, "torque": TorqueLoad, "drag": DragLoad}
