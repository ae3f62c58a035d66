"""ODE in double precision, by the names that Panda3D gives its functions: the library is one that DART's wheel brings.

It has what a ball on planes, spheres and hinged tables needs.
"""

from __future__ import annotations

import ctypes
from ctypes import POINTER, Structure, byref, c_double, c_int, c_void_p, sizeof
from functools import cache, partial
from importlib.util import find_spec
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from .serving import CannotError

_Vector = c_double * 4  # as ODE pads them


class _Mass(Structure):
    _fields_ = (("mass", c_double), ("center", _Vector), ("inertia", c_double * 12))

    def setParameters(self, *numbers: float) -> None:
        """Set mass, centre and inertia."""
        _call("dMassSetParameters", self, *numbers)


class _Surface(Structure):
    _fields_ = (
        ("mode", c_int),
        *((name, c_double) for name in ("mu", "mu2", "rho", "rho2", "rhoN", "bounce", "bounceVel")),
        *((name, c_double) for name in ("erp", "cfm", "motion1", "motion2", "motionN", "slip1", "slip2")),
    )
    MFContactBounce, MFContactApprox1 = 0x004, 0x7000

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("set"):
            raise AttributeError(name)
        return partial(setattr, self, name[3].lower() + name[4:])


class _Place(Structure):
    _fields_ = (
        ("place", _Vector),
        ("normal", _Vector),
        ("depth", c_double),
        ("geom", c_void_p),
        ("other", c_void_p),
        ("side", c_int),
        ("other_side", c_int),
    )


class _Contact(Structure):
    _fields_ = (("surface", _Surface), ("geom", _Place), ("along", _Vector))

    def setGeom(self, geom: _Place) -> None:
        """Say where two shapes meet."""
        self.geom = geom

    def setSurface(self, surface: _Surface) -> None:
        """Say how."""
        self.surface = surface


class _Handle:
    """What ODE has made, with the functions of its kind as methods."""

    def __init__(self, kind: str, create: str, *given: Any) -> None:
        self.kind, self.pointer = kind, _call(create, *given, returns=c_void_p)

    def __getattr__(self, name: str) -> Any:
        verb, rest = (name[:3], name[3:]) if name[:3] in ("set", "get") else (name, "")
        if self.kind == "Hinge":
            whole = f"dJoint{verb.title()}" + (f"Hinge{rest}" if rest else "")
        else:
            whole = f"d{self.kind}{name[0].upper()}{name[1:]}"
        if verb != "get":
            return partial(_call, whole, self)
        if rest == "Angle":
            return partial(_call, whole, self, returns=c_double)
        length = 4 if rest == "Quaternion" else 3
        return lambda: _call(whole, self, returns=POINTER(c_double))[:length]

    def attachBody(self, body: _Handle, _index: int) -> None:
        """Join a body to the ground."""
        _call("dJointAttach", self, body, None)


class _Met(list[_Place]):
    """Where two shapes meet."""

    getNumContacts, getContactGeom = list.__len__, list.__getitem__  # noqa: N815  Panda3D's names


def _collide(geom: _Handle, other: _Handle, most: int) -> _Met:
    found = (_Place * most)()
    collide = _library().dCollide
    return _Met(found[: collide(c_void_p(geom.pointer), c_void_p(other.pointer), most, found, sizeof(_Place))])


def _call(name: str, *given: Any, returns: Any = None) -> Any:
    """Call a function of the library; numbers are of double precision in all of those used here."""
    function = getattr(_library(), name)
    function.restype = returns
    return function(*map(_told, given))


def _told(given: Any) -> Any:
    if isinstance(given, _Handle):
        return c_void_p(given.pointer)
    if isinstance(given, Structure):
        return byref(given)
    if isinstance(given, tuple):
        return _Vector(*given)
    return given if given is None or isinstance(given, c_int) else c_double(given)


@cache
def _library() -> Any:
    spec = find_spec("dartpy")
    beside = Path(spec.origin).parent if spec is not None and spec.origin else Path()
    found = [path for folder in ("dartpy.libs", ".dylibs") for path in (beside / folder).glob("*ode-*")]
    if not found:
        raise CannotError("dartpy's wheel brings no libode on this system")
    library = ctypes.CDLL(str(found[0]))
    library.dInitODE2(0)
    if not library.dCheckConfiguration(b"ODE_double_precision"):
        raise CannotError("the libode of dartpy's wheel is not of double precision")
    return library


def _tuple(*numbers: float) -> tuple[float, ...]:
    return numbers


core = SimpleNamespace(LVector3f=_tuple, LQuaternionf=_tuple)
ode = SimpleNamespace(
    OdeWorld=partial(_Handle, "World", "dWorldCreate"),
    OdeBody=partial(_Handle, "Body", "dBodyCreate"),
    OdeMass=_Mass,
    OdePlaneGeom=partial(_Handle, "Geom", "dCreatePlane", None),
    OdeSphereGeom=partial(_Handle, "Geom", "dCreateSphere", None),
    OdeBoxGeom=partial(_Handle, "Geom", "dCreateBox", None),
    OdeCylinderGeom=partial(_Handle, "Geom", "dCreateCylinder", None),
    OdeJointGroup=lambda: _Handle("JointGroup", "dJointGroupCreate", c_int(0)),
    OdeHingeJoint=lambda world: _Handle("Hinge", "dJointCreateHinge", world, None),
    OdeContactJoint=partial(_Handle, "Joint", "dJointCreateContact"),
    OdeContact=_Contact,
    OdeSurfaceParameters=_Surface,
    OdeUtil=SimpleNamespace(collide=_collide),
)
