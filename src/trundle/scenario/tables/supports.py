"""Tables of supports: a surface, how it leans and moves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic import Field

from .motions import FixedMotion, Motions
from .values import AnyTilt, Friction, Radius, Rim, Table, Tilt

if TYPE_CHECKING:
    from ...mechanics.system import Support


class PlaneSupport(Table):
    """A plane, bounded by a circular rim or unbounded."""

    kind: Literal["plane"]
    tilt: Tilt = Field(default=0.0, description="Angle of the plane's normal to the vertical; down the first axis.")
    rim: Rim | None = Field(default=None, description="Radius of the rim; absent: unbounded.")
    friction: Friction | None = Field(default=None, description="Coulomb coefficient; absent: never slips.")
    motion: Annotated[Motions, Field(discriminator="kind")] = FixedMotion(kind="fixed")

    def build(self) -> Support:
        """Return the support."""
        from ...mechanics.surfaces import Plane
        from ...mechanics.system import Support

        surface = Plane(rim=None if self.rim is None else float(self.rim))
        friction = None if self.friction is None else float(self.friction)
        return Support(surface, motion=self.motion.build(), tilt=float(self.tilt), friction=friction)


class CylinderSupport(Table):
    """A circular cylinder about the third axis, rolled on from inside or outside; a tilt of 90 deg lays it down."""

    kind: Literal["cylinder"]
    radius: Radius
    side: Literal["inside", "outside"] = "inside"
    tilt: AnyTilt = Field(default=0.0, description="Angle of the axis to the vertical; 90 deg: a trough or a log.")
    friction: Friction | None = Field(default=None, description="Coulomb coefficient; absent: never slips.")
    motion: Annotated[Motions, Field(discriminator="kind")] = FixedMotion(kind="fixed")
    rim: ClassVar[None] = None

    def build(self) -> Support:
        """Return the support."""
        from ...mechanics.surfaces import Cylinder
        from ...mechanics.system import Support

        surface = Cylinder(float(self.radius), self.side)
        friction = None if self.friction is None else float(self.friction)
        return Support(surface, motion=self.motion.build(), tilt=float(self.tilt), friction=friction)


Supports = PlaneSupport | CylinderSupport

SUPPORTS: dict[str, type[Table]] = {"plane": PlaneSupport, "cylinder": CylinderSupport}
