"""The camera: what it makes of places in the frame of the support."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from ...errors import InvalidValueError, UnknownNameError
from ...mechanics.algebra import Vector
from ...mechanics.scalars import Scalar, is_zero, namespace
from ...units import UNITS, to_si

_KINDS = {
    "time_offset": "time", "scale": "number", "rotation": "angle", "origin": "length", "height": "length",
    "accuracy": "length",
}  # fmt: skip


@dataclass(frozen=True)
class Camera:
    """How measured lengths and times differ from those of the scenario.

    A point (x, y) at the height z over the plane of calibration is measured at s·R(θ)·(x, y)/(1 − z/H) + origin, at
    the time that the scenario calls t + offset. Each of these numbers may be free in a fit, by names such as
    "camera.scale".

    Parameters
    ----------
    scale : float
        s: measured length over true length.
    rotation : float, quantity or str
        θ, of the measured axes against those of the scenario, rad.
    origin : pair of float, quantity or str
        Where the scenario's origin is measured, m.
    height : float, quantity or str, optional
        H, of the camera over the plane of calibration, m; absent: very far, no parallax.
    time_offset : float, quantity or str
        What the clock of the scenario shows when that of the data shows 0, s.
    accuracy : float, quantity or str, optional
        By how much lens, calibration and compression may shift all that is seen at one place, m. Such errors do not
        average out: those of the fit allow for them, and no fit is bad for less. Absent: as the track says, or none.

    Examples
    --------
    >>> Camera(rotation="90 deg", origin=("1 cm", 0)).origin
    (0.01, 0.0)
    """

    scale: Scalar = 1.0
    rotation: Scalar = 0.0
    origin: tuple[Scalar, Scalar] = (0.0, 0.0)
    height: Scalar | None = None
    time_offset: Scalar = 0.0
    accuracy: float | None = None

    def __post_init__(self) -> None:
        for name in ("scale", "rotation", "time_offset"):
            object.__setattr__(self, name, to_si(getattr(self, name), _KINDS[name], f"camera.{name}"))
        if self.height is not None:
            object.__setattr__(self, "height", to_si(self.height, "length", "camera.height"))
            if not self.height > 0:
                raise InvalidValueError("camera.height", "must be positive", self.height, "Leave it out if far away.")
        if self.accuracy is not None:
            object.__setattr__(self, "accuracy", to_si(self.accuracy, "length", "camera.accuracy"))
            if not 0 <= self.accuracy < float("inf"):
                remedy = "Write for instance '0.1 mm', or '0 mm' for a camera without error."
                raise InvalidValueError("camera.accuracy", "must not be negative", self.accuracy, remedy)
        if isinstance(self.origin, str) or not hasattr(self.origin, "__len__") or len(self.origin) != 2:
            raise InvalidValueError("camera.origin", "must be two lengths", self.origin, "Write ['1 cm', 0].")
        pair = tuple(to_si(part, "length", f"camera.origin[{i}]") for i, part in enumerate(self.origin))
        object.__setattr__(self, "origin", tuple(0.0 + part for part in pair))
        if not self.scale > 0:
            raise InvalidValueError("camera.scale", "must be positive", self.scale, "Measured length over true length.")

    @staticmethod
    def of(given: Camera | Mapping[str, Any] | None) -> Camera:
        """Return the camera that was given, as one or by its numbers.

        Parameters
        ----------
        given : Camera or mapping, optional
            With keys as its parameters.

        Returns
        -------
        Camera
            One that does nothing, if none was given.

        Examples
        --------
        >>> Camera.of({"scale": 1.02}).scale
        1.02
        """
        if isinstance(given, Camera):
            return given
        known = [field.name for field in fields(Camera)]
        for name in given or {}:
            if name not in known:
                raise UnknownNameError("number of a camera", str(name), known)
        return Camera(**dict(given or {}))

    def numbers(self) -> dict[str, tuple[Scalar, str]]:
        """Return each number that may be free, by name, with its SI unit.

        Returns
        -------
        dict
            Value and unit.

        Examples
        --------
        >>> list(Camera().numbers())
        ['camera.scale', 'camera.rotation', 'camera.origin[0]', 'camera.origin[1]', 'camera.time_offset']
        """
        found = {
            "camera.scale": (self.scale, ""),
            "camera.rotation": (self.rotation, UNITS["angle"][0]),
            "camera.origin[0]": (self.origin[0], "m"),
            "camera.origin[1]": (self.origin[1], "m"),
            "camera.time_offset": (self.time_offset, "s"),
        }
        return found if self.height is None else {**found, "camera.height": (self.height, "m")}

    def sees(self, place: Vector) -> Vector:
        """Return where a point is measured.

        Parameters
        ----------
        place : Vector
            Frame of the support, m.

        Returns
        -------
        Vector
            m; the third part only scaled.

        Examples
        --------
        >>> Camera(scale=2.0, origin=(0.5, 0.0)).sees(Vector(1.0, 0.0, 0.1))
        Vector(x=2.5, y=0.0, z=0.2)
        """
        turned = self.turned(place) * self.scale
        near = 1.0 if self.height is None else 1.0 / (1.0 - place.z / self.height)
        return Vector(turned.x * near + self.origin[0], turned.y * near + self.origin[1], turned.z)

    def turned(self, along: Vector) -> Vector:
        """Return a vector along the measured axes.

        Parameters
        ----------
        along : Vector
            In the frame of the support.

        Returns
        -------
        Vector
            The same, by the measured axes.
        """
        if is_zero(self.rotation):
            return along
        xp = namespace(self.rotation)
        c, s = xp.cos(self.rotation), xp.sin(self.rotation)
        return Vector(c * along.x - s * along.y, s * along.x + c * along.y, along.z)

    def shows(self, measured: Vector, z: float) -> Vector:
        """Return the place of a point at a height that is measured somewhere: the inverse of `sees`.

        Parameters
        ----------
        measured : Vector
            m.
        z : float
            Height, m.

        Returns
        -------
        Vector
            Frame of the support.

        Examples
        --------
        >>> Camera(scale=2.0, origin=(0.5, 0.0)).shows(Vector(2.5, 0.0, 0.0), 0.1)
        Vector(x=1.0, y=0.0, z=0.1)
        """
        near = 1.0 if self.height is None else 1.0 / (1.0 - z / self.height)
        share = 1.0 / (self.scale * near)
        flat = Vector((measured.x - self.origin[0]) * share, (measured.y - self.origin[1]) * share, 0.0)
        xp = namespace(self.rotation)
        c, s = xp.cos(self.rotation), xp.sin(self.rotation)
        return Vector(c * flat.x + s * flat.y, c * flat.y - s * flat.x, z)
