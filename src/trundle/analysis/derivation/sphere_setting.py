"""What is there in a sphere on a plane: which of the things that T5 covers, as a system of symbols and as a proof."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from ...mechanics.algebra import Vector
from ...mechanics.bodies import Body
from ...mechanics.loads import Drag, Force, Load, Torque, constant_part
from ...mechanics.motions import Fixed, Spin
from ...mechanics.scalars import is_zero
from ...mechanics.surfaces import Plane
from ...mechanics.system import RollingSystem, Support
from .law import at_one_instant
from .steps import Proof
from .symbols import (
    F_XYZ,
    K_XYZ,
    R_XYZ,
    V_XY,
    VDOT_XY,
    F,
    I,
    K,
    R,
    V,
    Vdot,
    Z,
    a,
    alpha,
    c,
    e_x,
    g,
    gamma,
    k,
    kappa,
    m,
    n,
    omega,
    r,
    varphi,
    x,
    y,
    zeta,
    zetaddot,
    zetadot,
)
from .vectors import times, total


@dataclass(frozen=True)
class Setting:
    """Which of the things that T5 covers are there; those that are not drop out of every equation.

    Examples
    --------
    >>> Setting(turning=True).system.support.motion
    Spin(rate=omega)
    """

    turning: bool = False
    tilted: bool = False
    force: tuple[bool, bool, bool] = (False, False, False)
    torque: tuple[bool, bool, bool] = (False, False, False)
    drag: bool = False
    weight: bool = True
    straight: bool = False  # a cylinder or hoop, held to its line
    inertia_ratio: Any = 0.4

    @classmethod
    def of(cls, system: RollingSystem) -> Setting:
        """Read off a system which of its numbers are not zero."""
        force, torque, drag = constant_part(system.loads, system.body.mass)
        weight = not is_zero(system.gravity)
        return cls(
            turning=not is_zero(system.support.motion.steady_rate),
            tilted=weight and not is_zero(system.support.tilt),
            force=(not is_zero(force.x), not is_zero(force.y), not is_zero(force.z)),
            torque=(not is_zero(torque.x), not is_zero(torque.y), not is_zero(torque.z)),
            drag=not is_zero(drag),
            weight=weight,
            straight=system.body.shape.axis is not None,
            inertia_ratio=system.body.inertia_ratio,
        )

    @cached_property
    def system(self) -> RollingSystem:
        """The system with symbols for its numbers."""
        return self.system_with(omega, c)

    def system_with(self, rate: Any, drag: Any) -> RollingSystem:
        """Return the system with symbols for its numbers, and ω and c as given."""
        loads: list[Load] = []
        if any(self.force):
            loads.append(Force(self._kept(F_XYZ, self.force)))
        if any(self.torque):
            loads.append(Torque(self._kept(K_XYZ, self.torque)))
        if self.drag:
            loads.append(Drag(drag))
        support = Support(Plane(), Spin(rate) if self.turning else Fixed(), alpha if self.tilted else 0.0)
        return RollingSystem(Body.sphere(a, m, k), support, tuple(loads), g if self.weight else 0.0)

    @staticmethod
    def _kept(names: tuple[Any, ...], there: tuple[bool, ...]) -> tuple[Any, ...]:
        return tuple(name if kept else sp.Integer(0) for name, kept in zip(names, there, strict=True))

    @property
    def force_xyz(self) -> tuple[Any, ...]:
        """The applied force other than weight and drag."""
        return self._kept(F_XYZ, self.force)

    @property
    def torque_xyz(self) -> tuple[Any, ...]:
        """The applied torque."""
        return self._kept(K_XYZ, self.torque)

    @property
    def noun(self) -> str:
        """What rolls, in a word."""
        return "cylinder" if self.straight else "ball"

    @property
    def pushed(self) -> bool:
        """Whether something pushes along the plane."""
        return self.tilted or any(self.force[:2]) or any(self.torque[:2])

    @property
    def up(self) -> Any:
        """The vertical: the normal itself where the plane is level."""
        return Z if self.tilted else n

    @property
    def applied(self) -> tuple[Any, ...]:
        """The applied forces as vectors, in the order weight, force, drag."""
        return tuple(
            term
            for there, term in (
                (self.weight, times(-m * g, self.up)),
                (any(self.force), F),
                (self.drag, -c * V),
            )
            if there
        )


def proof_of(setting: Setting) -> Proof:
    """Return the proof by the rolling law for a sphere on a plane.

    Examples
    --------
    >>> proof_of(Setting()).values[n].T
    Matrix([[0, 0, 1]])
    """
    values = at_one_instant(setting.system, Vector(x, y, sp.Integer(0)))
    values[F], values[K] = sp.Matrix(setting.force_xyz), sp.Matrix(setting.torque_xyz)
    # The lecture takes r in the plane of the centre, from the point of the axis there.
    values[r] = values[r] - sp.Matrix([0, 0, a])
    values[Z] = sp.Matrix([-sp.sin(alpha), 0, sp.cos(alpha)])
    values[e_x] = sp.Matrix([1, 0, 0])
    values |= dict(zip(VDOT_XY, values[Vdot][:2], strict=True)) | dict(zip(V_XY, values[V][:2], strict=True))
    values |= dict(zip(R_XYZ, values[R], strict=True))
    values |= {I: k * m * a**2, zeta: x + sp.I * y}
    values |= {zetadot: values[V][0] + sp.I * values[V][1], zetaddot: values[Vdot][0] + sp.I * values[Vdot][1]}
    constants = constants_of(setting)
    values |= {kappa: constants[kappa], gamma: constants[gamma], varphi: constants[varphi]}
    return Proof(values)


def constants_of(setting: Setting) -> dict[Any, Any]:
    """Return κ, γ and φ of T5 by the numbers of a system.

    Examples
    --------
    >>> constants_of(Setting(turning=True))[kappa]
    k*omega/(k + 1)
    """
    (fx, fy, _), (kx, ky, _) = setting.force_xyz, setting.torque_xyz
    push = total(*along(setting, 0), sp.I * fy if fy != 0 else 0, -sp.I * kx / a)
    del fx, ky
    return {
        kappa: omega * k / (1 + k) if setting.turning else sp.Integer(0),
        gamma: c / (m * (1 + k)) if setting.drag else sp.Integer(0),
        varphi: push / (m * (1 + k)) if push != 0 else sp.Integer(0),
    }


def along(setting: Setting, axis: int) -> tuple[Any, ...]:
    """Return what pushes along the first or the second axis of the plane: weight, force, torque over radius."""
    (kx, ky, _), weight = setting.torque_xyz, m * g * sp.sin(alpha)
    slope = weight if setting.tilted and axis == 0 else sp.Integer(0)
    return slope, setting.force_xyz[axis], (ky / a, -kx / a)[axis]
