"""What the symmetries of a system say: of its surface, motion, loads and body (theory page, section 6).

Each question is asked of the things themselves, and where something does not say, the answer is no: an integral that
holds may go unnamed, one that does not is never named.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .algebra import E_Z, ZERO, Matrix, Quaternion, Vector
from .loads import BodyMotion, Load, at_rest
from .motions import Motion
from .records import frozen_record, remembered
from .scalars import is_number, is_zero

if TYPE_CHECKING:
    from .bodies import Body
    from .system import RollingSystem

ROUNDING = 1e-12  # share by which two equal moments of inertia may differ
_INSTANTS = tuple(0.7390851 * 1.9**i for i in range(-12, 20))  # s, 0.3 ms to two days, none a round number
_PLACE = Vector(0.0137, -0.0291, 0.0213)  # m, where no formula is special


def conservative(load: Load) -> bool:
    """Tell whether a load has a potential.

    Examples
    --------
    >>> from trundle.mechanics.loads import Drag, Gravity
    >>> conservative(Gravity(0.0, 0.0, -9.8)), conservative(Drag(0.01))
    (True, False)
    """
    somewhere = BodyMotion(0.137, 1.0, _PLACE, ZERO, Quaternion(1.0, 0.0, 0.0, 0.0), ZERO, E_Z)
    try:
        return load.potential(somewhere) is not None
    except (ArithmeticError, ValueError):  # a formula is there, though not just here
        return True


def without_torque(load: Load) -> bool:
    """Tell whether a load is a force on the centre of mass and nothing else.

    Examples
    --------
    >>> from trundle.mechanics.loads import Drag, Torque
    >>> without_torque(Drag(0.01)), without_torque(Torque((0.0, 0.0, 1e-5)))
    (True, False)
    """
    return type(load).torque is Load.torque and _without_couple(load)


def _without_couple(load: Load) -> bool:
    return type(load).torque_per_normal_force is Load.torque_per_normal_force


def constant_moment(system: RollingSystem, offset: Vector) -> Vector | None:
    """Return the moment K − ρ×F of the loads about a contact at a constant ρ.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> constant_moment(level, Vector(0.0, 0.0, -0.1))
    Vector(x=0.0, y=0.0, z=0.0)
    """
    if not all(load.constant and _without_couple(load) for load in system.all_loads):
        return None
    F, K = system.loads_on(at_rest(system.body.mass))
    moment = K - offset.cross(F)
    return Vector(*(part + 0.0 if is_number(part) else part for part in moment))


def fixed(system: RollingSystem) -> bool:
    """Tell whether the support is at rest.

    Examples
    --------
    >>> import trundle as tr
    >>> fixed(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane(), motion=tr.Spin(0.0))))
    True
    """
    rate = system.support.motion.steady_rate
    return rate is not None and is_zero(rate)


def keeps_axis(motion: Motion) -> bool:
    """Tell whether a motion never leans the support's third axis: it may turn about it and be shifted.

    Parameters
    ----------
    motion : Motion
        Any; its own `keeps_axis` counts, else it is looked at, at instants from a fraction of a millisecond to two
        days, and must not lean by a single bit.

    Returns
    -------
    bool
        False for a wobble.

    Examples
    --------
    >>> import trundle as tr
    >>> keeps_axis(tr.UnevenSpin(3.5, 0.01, 3.5)), keeps_axis(tr.Wobble(3.5, "0.1 deg"))
    (True, False)
    """
    if motion.keeps_axis is not None:
        return motion.keeps_axis
    if motion.steady_rate is not None:
        return True
    try:
        return all(_upright(motion, time) for time in _INSTANTS)
    except (ArithmeticError, ValueError):  # a formula that is not finite for ever
        return False


def _upright(motion: Motion, time: float) -> bool:
    coordinates = tuple(0.613 + 0.29 * i for i in range(len(motion.coordinates)))
    now = motion.at(time, *coordinates)
    axis, turning = now.rotation @ E_Z, (now.angular_velocity, now.angular_acceleration)
    parts = (axis.x, axis.y, axis.z - 1.0, *(part for rate in turning for part in (rate.x, rate.y)))
    return all(is_zero(part) for part in parts)


def same_at_all_times(system: RollingSystem) -> bool:
    """Tell whether it makes no difference when a run starts: neither the support's place nor a load goes by the clock.

    Parameters
    ----------
    system : RollingSystem
        Any.

    Returns
    -------
    bool
        True of a support at rest, and of one that turns evenly and looks the same from all sides, under loads that do
        not depend on the time.

    Examples
    --------
    >>> import trundle as tr
    >>> ball, turning = tr.Body.solid_sphere(0.01, 0.1), tr.Spin(2.0)
    >>> supports = [tr.Support(surface, motion=turning) for surface in (tr.Bowl(0.4), tr.HeightField("0.1*x*y"))]
    >>> [same_at_all_times(tr.RollingSystem(ball, support)) for support in supports]
    [True, False]
    """
    support = system.support
    rate = support.motion.steady_rate
    stays = rate is not None and (is_zero(rate) or support.surface.axisymmetric)
    return stays and not any(_by_the_clock(load) for load in system.all_loads)


def _by_the_clock(load: Load) -> bool:
    turned = Quaternion(0.5, 0.5, 0.5, 0.5)

    def at(time: float) -> tuple[Vector, ...]:
        motion = BodyMotion(time, 1.0, _PLACE, _PLACE, turned, _PLACE, E_Z)
        return load.force(motion), load.torque(motion), load.torque_per_normal_force(motion)

    try:
        return any(at(time) != at(_INSTANTS[0]) for time in _INSTANTS[1:])
    except (ArithmeticError, ValueError):  # a formula that is not finite for ever
        return True


def frictionless(system: RollingSystem) -> bool:
    """Tell whether a body that slips here feels no friction.

    Examples
    --------
    >>> import trundle as tr
    >>> frictionless(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane(), friction=0.0)))
    True
    """
    coefficient = system.support.sliding_friction
    return coefficient is not None and is_zero(coefficient)


@frozen_record()
class Ball:
    """A sphere, its own centre at c from the centre of mass, as its integrals see it."""

    radius: float  # a, m
    centre: Vector  # c, body frame, m
    axis: Vector | None  # e, the axis of symmetry of surface and inertia, body frame; None if there is none
    moments: tuple[float, float]  # J₁ across the axis and J₃ about it, kg m²
    isotropic: bool  # the same inertia about every axis through the centre of mass

    @property
    def concentric(self) -> bool:
        """Whether the two centres coincide."""
        return tuple(self.centre) == (0.0, 0.0, 0.0)


@remembered
def ball_of(body: Body) -> Ball | None:
    """Return what a body is as a sphere that can roll any way.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.shapes import Sphere
    >>> top = tr.Body(1.0, tr.Principal(2e-3, 2e-3, 1e-3), Sphere(0.1, Vector(0.0, 0.0, 0.02)))
    >>> ball_of(top).axis, ball_of(top).moments
    (Vector(x=0.0, y=0.0, z=1.0), (0.002, 0.001))
    """
    shape: Any = body.shape
    J = body.inertia_in_space(Matrix.identity())
    if not shape.spherical or shape.axis is not None:
        return None
    centre = ZERO if shape.centre is None else shape.centre
    known = (shape.radius, *centre, *(part for row in J.rows for part in row))
    if not all(is_number(part) for part in known):
        return None
    scale = float(max(J.a.x, J.b.y, J.c.z))
    isotropic = all(_small((J @ e) - e * J.a.x, scale) for e in (Vector(1.0, 0.0, 0.0), Vector(0.0, 1.0, 0.0), E_Z))
    axes = (centre / centre.norm(),) if any(centre) else () if isotropic else _axes(J)
    for e in axes:
        moments = _moments(J, e, scale)
        if moments is not None:
            return Ball(shape.radius, centre, e, moments, isotropic)
    return Ball(shape.radius, centre, None, (float(J.a.x), float(J.c.z)), isotropic)


def _moments(J: Matrix, e: Vector, scale: float) -> tuple[float, float] | None:
    """Return the moments across an axis and about it, if the inertia is symmetric about that axis."""
    about = e.dot(J @ e)
    across = 0.5 * (J.a.x + J.b.y + J.c.z - about)
    wanted = Matrix.identity() * across + Matrix.outer(e, e) * (about - across)
    if not all(_small(one - other, scale) for one, other in zip(J.rows, wanted.rows, strict=True)):
        return None
    return float(across), float(about)


def _axes(J: Matrix) -> tuple[Vector, ...]:
    """Return the principal axes of an inertia tensor."""
    import numpy as np

    vectors = np.linalg.eigh(np.array([list(row) for row in J.rows], dtype=float))[1]
    return tuple(Vector(*vectors[:, i].tolist()) for i in range(3))


def _small(vector: Vector, scale: float) -> bool:
    return max(abs(part) for part in vector) <= ROUNDING * scale


def on_plane(system: RollingSystem) -> bool:
    """Tell whether the body is on a plane whose normal is the third axis of the support frame for good.

    Examples
    --------
    >>> import trundle as tr
    >>> on_plane(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane(), motion=tr.Spin(2.0))))
    True
    """
    return system.support.surface.flat and keeps_axis(system.support.motion)


def symmetric_potential(system: RollingSystem) -> bool:
    """Tell whether all loads have a potential that a turn about the support's third axis leaves alone.

    Examples
    --------
    >>> import trundle as tr
    >>> symmetric_potential(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane(), tilt=0.1)))
    False
    """
    return all(conservative(load) and load.symmetric for load in system.all_loads)


@remembered
def free_axle(motion: Motion) -> Any:
    """Return the moment of inertia of a table that turns freely on its axle.

    Examples
    --------
    >>> import trundle as tr
    >>> free_axle(tr.Spin(2.0)) is None
    True
    """
    if not motion.free or motion.coordinates != ("angle", "rate"):
        return None
    try:
        idle = all(is_zero(motion.axle_torque(t, (0.613, rate))) for t in _INSTANTS for rate in (-1.7, 0.9))
        still = all(is_zero(part) for t in _INSTANTS for part in motion.at(t, 0.613, 0.9).origin)
    except (ArithmeticError, ValueError):
        return None
    return motion.inertia if idle and still else None
