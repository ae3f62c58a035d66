"""Tables of loads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from ...errors import InvalidValueError
from ...mechanics.expressions import Expression
from ..fields import Measure
from .motions import RotationalDamping, plain, plains
from .values import AirRate, Coefficient, Force3, PositiveRate, Table, Torque3

if TYPE_CHECKING:
    from ...mechanics.loads import Load


@dataclass(frozen=True)
class Formula:
    """The type of a formula in named variables, for use in ``Annotated``.

    Parameters
    ----------
    variables : tuple of str
        The names that may stand in it.

    Examples
    --------
    >>> Formula(("x", "y"))("x*y")
    'x*y'
    """

    variables: tuple[str, ...]
    offer = '"0.5*3*(x**2 + y**2)"'

    def __call__(self, value: Any) -> str:
        """Return the text of the checked formula."""
        if not isinstance(value, str):
            rule = f"must be a formula in {', '.join(self.variables)}"
            raise InvalidValueError("", rule, value, f"Write for instance {self.offer}.")
        return Expression.parse(value, self.variables, "").text

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.__call__)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return what an editor may know of it: a text."""
        described = f"A formula in {', '.join(self.variables)}, SI."
        return {"type": "string", "description": described, "examples": [self.offer.strip('"')]}


Energy = Annotated[str, Formula(("x", "y", "z", "t"))]
QuadraticDamping = Annotated[float, Measure("quadratic damping", "not negative")]
Offset = Annotated[float, Measure("length", "not negative")]
MagnusMass = Annotated[float, Measure("mass")]


class ForceLoad(Table):
    """A force on the centre of mass, constant or given by formulas in the time t."""

    kind: Literal["force"]
    value: Force3 = Field(description="In the support frame, which does not turn with the support.")

    def build(self) -> Load:
        """Return the load."""
        from ...mechanics.loads import Force

        return Force(plains(self.value))


class TorqueLoad(Table):
    """A torque about the centre of mass, constant or given by formulas in the time t."""

    kind: Literal["torque"]
    value: Torque3 = Field(description="In the support frame, which does not turn with the support.")

    def build(self) -> Load:
        """Return the load."""
        from ...mechanics.loads import Torque

        return Torque(plains(self.value))


_ABOUT_AIR = '"still", "turning" with the support, or a rate of its own.'


class DragLoad(Table):
    """Linear drag, the force -c (V - that of the air)."""

    kind: Literal["drag"]
    coefficient: Coefficient
    air: AirRate = Field(default="still", description=_ABOUT_AIR)

    def build(self) -> Load:
        """Return the load."""
        from ...mechanics.loads import Drag

        return Drag(float(self.coefficient), plain(self.air))


class QuadraticDragLoad(Table):
    """Quadratic drag, the force -c |v| v with v = V - that of the air."""

    kind: Literal["quadratic-drag"]
    coefficient: QuadraticDamping = Field(description="0.5 times the air's density, the area and its coefficient.")
    air: AirRate = Field(default="still", description=_ABOUT_AIR)

    def build(self) -> Load:
        """Return the load."""
        from ...mechanics.loads import QuadraticDrag

        return QuadraticDrag(float(self.coefficient), plain(self.air))


class PotentialLoad(Table):
    """The force of a field, from a formula for its potential energy."""

    kind: Literal["potential"]
    formula: Energy = Field(description="U in J, in x, y, z of the centre in m and the time t in s.")

    def build(self) -> Load:
        """Return the load."""
        from ...mechanics.loads import Potential

        return Potential(self.formula)


class RollingResistanceLoad(Table):
    """Resistance to rolling, a couple of the normal force times an offset."""

    kind: Literal["rolling-resistance"]
    offset: Offset = Field(description="How far ahead of the contact the normal force acts.", examples=["0.05 mm"])

    def build(self) -> Load:
        """Return the load."""
        from ...mechanics.loads import RollingResistance

        return RollingResistance(float(self.offset))


class PivotFrictionLoad(Table):
    """Resistance to spinning on the spot, a couple of the normal force times an offset."""

    kind: Literal["pivot-friction"]
    offset: Offset = Field(description="Friction coefficient times the area's mean radius.", examples=["20 um"])
    below: PositiveRate = Field(default=0.01, description="The spin below which it eases off.")

    def build(self) -> Load:
        """Return the load."""
        from ...mechanics.loads import PivotFriction

        return PivotFriction(float(self.offset), float(self.below))


class RollingCoupleLoad(Table):
    """A viscous couple at the contact, -c times the turning of the body over its support."""

    kind: Literal["rolling-couple"]
    coefficient: RotationalDamping
    pivot_coefficient: RotationalDamping | None = Field(default=None, description="About the normal; absent: the same.")

    def build(self) -> Load:
        """Return the load."""
        from ...mechanics.loads import RollingCouple

        pivot = None if self.pivot_coefficient is None else float(self.pivot_coefficient)
        return RollingCouple(float(self.coefficient), pivot)


class MagnusLoad(Table):
    """The sideways force of still air on a body that turns while it moves, c times angular velocity x velocity."""

    kind: Literal["magnus"]
    coefficient: MagnusMass = Field(description="Positive: topspin pushes down.", examples=["0.1 g"])

    def build(self) -> Load:
        """Return the load."""
        from ...mechanics.loads import Magnus

        return Magnus(float(self.coefficient))


class MotorLoad(Table):
    """A torque in the body's own axes, constant or given by formulas in the time t: a motor inside."""

    kind: Literal["motor"]
    value: Torque3 = Field(description="Along the body's axes, which turn with it.")

    def build(self) -> Load:
        """Return the load."""
        from ...mechanics.loads import Motor

        return Motor(plains(self.value))


Loads = (
    ForceLoad
    | TorqueLoad
    | DragLoad
    | QuadraticDragLoad
    | PotentialLoad
    | RollingResistanceLoad
    | PivotFrictionLoad
    | RollingCoupleLoad
    | MagnusLoad
    | MotorLoad
)

LOADS: dict[str, type[Table]] = {
    "force": ForceLoad,
    "torque": TorqueLoad,
    "drag": DragLoad,
    "quadratic-drag": QuadraticDragLoad,
    "potential": PotentialLoad,
    "rolling-resistance": RollingResistanceLoad,
    "pivot-friction": PivotFrictionLoad,
    "rolling-couple": RollingCoupleLoad,
    "magnus": MagnusLoad,
    "motor": MotorLoad,
}
