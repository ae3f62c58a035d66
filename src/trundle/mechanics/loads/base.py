"""What every load is: a force and a torque about the centre of mass, in the inertial support frame."""

from __future__ import annotations

from collections.abc import Callable

from ..algebra import ZERO, Quaternion, Vector
from ..motions import Motion, SupportState
from ..parts import Part
from ..records import frozen_record
from ..scalars import Scalar, is_zero


@frozen_record()
class BodyMotion:
    """What a load may depend on: the motion of the body at one instant, in the inertial support frame.

    Examples
    --------
    >>> from trundle.mechanics.loads import Drag
    >>> still = BodyMotion(0.0, 0.065, ZERO, ZERO, Quaternion(1.0, 0.0, 0.0, 0.0), ZERO)
    >>> Drag(0.01).force(still)
    Vector(x=-0.0, y=-0.0, z=-0.0)
    """

    time: Scalar  # s
    mass: Scalar  # kg
    position: Vector  # of the centre of mass, m
    velocity: Vector  # of the centre of mass, m/s
    orientation: Quaternion
    angular_velocity: Vector  # rad/s
    normal: Vector | None = None  # n at the contact, from the support into the body; None in flight
    support_angular_velocity: Vector = ZERO  # ω, rad/s


@frozen_record()
class Acting:
    """What acts on a body at one instant besides the contact force, in the inertial support frame."""

    force: Vector = ZERO  # F, N
    torque: Vector = ZERO  # K about the centre of mass, N m
    from_support: Vector = ZERO  # the part of K that the support exerts, N m
    couple: Vector = ZERO  # what the support exerts besides for each newton of normal force, m

    @property
    def has_couple(self) -> bool:
        """Whether any load depends on the normal force."""
        return not all(is_zero(part) for part in self.couple)

    def moment_on_axle(self, support: SupportState, N: Scalar) -> Scalar:
        """Return the moment of these couples on the support about its axle under a normal force N, N m.

        Parameters
        ----------
        support : SupportState
            Pose and twist of the support.
        N : Scalar
            Normal force, N.

        Returns
        -------
        Scalar
            About the third axis.
        """
        return -support.axle.dot(self.from_support) - (support.axle.dot(self.couple) * N if self.has_couple else 0.0)


def at_rest(mass: Scalar) -> BodyMotion:
    """Return a body at rest at the origin, where a load that is constant can be read.

    Examples
    --------
    >>> from trundle.mechanics.loads import Gravity
    >>> Gravity(0.0, 0.0, -10.0).force(at_rest(2.0)).z
    -20.0
    """
    return BodyMotion(0.0, mass, ZERO, ZERO, Quaternion(1.0, 0.0, 0.0, 0.0), ZERO)


class Load(Part):
    """A force and a torque on the body; by default neither, and no potential.

    Examples
    --------
    >>> class Lifted(Load):
    ...     def force(self, motion):
    ...         return Vector(0.0, 0.0, 0.5 * motion.mass)
    >>> Lifted().force(at_rest(2.0)).z
    1.0
    """

    constant: bool = False  # the same force and torque always and everywhere
    at_contact: bool = False  # its torque is exchanged with the support
    usual: bool = False  # so common that a page keeps a slider for it, at 0 where it is not there
    stops: bool = False  # it brings rolling to rest in a finite time, where its direction is lost
    offset: Scalar  # of a load that stops: its couple for each newton of normal force, m

    def key_numbers(self) -> list[str]:
        """Return what figures say of it.

        Returns
        -------
        list of str
            Such as ``["drag 0.01 kg/s"]``.
        """
        return []

    def over(self, motion: Motion) -> Load:  # noqa: ARG002
        """Return the load as it is over a support that moves so, which for most loads is the same.

        Parameters
        ----------
        motion : Motion
            Of the support.

        Returns
        -------
        Load
            Of the same kind.
        """
        return self

    @property
    def linear_drag(self) -> Scalar | None:
        """C of a load that is purely −c V, kg/s; None for any other load."""
        return None

    def force(self, motion: BodyMotion) -> Vector:  # noqa: ARG002
        """Return the force on the centre of mass, N.

        Parameters
        ----------
        motion : BodyMotion
            What the body does at this instant.

        Returns
        -------
        Vector
            Support frame.
        """
        return ZERO

    def torque(self, motion: BodyMotion) -> Vector:  # noqa: ARG002
        """Return the torque about the centre of mass, N m.

        Parameters
        ----------
        motion : BodyMotion
            What the body does at this instant.

        Returns
        -------
        Vector
            Support frame.
        """
        return ZERO

    def torque_per_normal_force(self, motion: BodyMotion) -> Vector:  # noqa: ARG002
        """Return the torque, m, that goes with each newton of normal force: of a couple of friction at the contact.

        Parameters
        ----------
        motion : BodyMotion
            What the body does at this instant.

        Returns
        -------
        Vector
            Support frame.
        """
        return ZERO

    @property
    def corners(self) -> tuple[Callable[[BodyMotion], Vector], ...]:
        """Vectors on whose lengths it depends: where one passes through zero, the load has a corner in the time."""
        return ()

    def potential(self, motion: BodyMotion) -> Scalar | None:  # noqa: ARG002
        """Return the potential energy, J; None for a load that has none.

        Parameters
        ----------
        motion : BodyMotion
            What the body does at this instant.

        Returns
        -------
        Scalar or None
            Its slope is −F: the balance of energy on the card uses it.
        """
        return None

    @property
    def symmetric(self) -> bool:
        """Whether turning everything about the support's third axis leaves the load unchanged."""
        return False

    @property
    def leaves_spin(self) -> bool:
        """Whether the load never has a torque along the support's third axis."""
        return False


def constant_part(loads: tuple[Load, ...], mass: Scalar) -> tuple[Vector, Vector, Scalar]:
    """Add up loads that are constant or linear drag.

    Examples
    --------
    >>> from trundle.mechanics.loads import Drag, Gravity
    >>> constant_part((Gravity(0.0, 0.0, -10.0), Drag(0.01), Drag(0.02)), 2.0)[2]
    0.03
    """
    force, torque, drag = ZERO, ZERO, 0.0
    for load in loads:
        if load.linear_drag is not None:
            drag = drag + load.linear_drag
        else:
            force, torque = force + load.force(at_rest(mass)), torque + load.torque(at_rest(mass))
    return force, torque, drag
