"""What every motion of a support is: pose, twist and acceleration as the rolling law needs them."""

from __future__ import annotations

from ..algebra import Matrix, Vector
from ..parts import Part
from ..records import frozen_record
from ..scalars import Scalar


@frozen_record()
class SupportState:
    """Pose, twist and acceleration of the support at one instant, in the inertial support frame.

    Examples
    --------
    >>> from trundle.mechanics.motions import Spin
    >>> Spin(2.0).at(0.0).material_velocity(Vector(0.5, 0.0, 0.0))
    Vector(x=0.0, y=1.0, z=0.0)
    """

    rotation: Matrix  # support's own frame to the inertial frame
    origin: Vector  # X, m
    velocity: Vector  # of X, m/s
    acceleration: Vector  # of X, m/s²
    angular_velocity: Vector  # ω, rad/s
    angular_acceleration: Vector  # rad/s²

    @property
    def axle(self) -> Vector:
        """The support's third axis, about which it turns."""
        return self.rotation.transpose.c

    def lever(self, p: Vector) -> Vector:
        """Return e×(p − X): how the material at p speeds up for each rad/s² about the axle, m.

        Parameters
        ----------
        p : Vector
            A point, support frame, m.

        Returns
        -------
        Vector
            m, support frame.
        """
        return self.axle.cross(p - self.origin)

    def carried(self, local: Vector) -> Vector:
        """Return where the point of the support with given own coordinates is, m.

        Parameters
        ----------
        local : Vector
            Coordinates in the support's own frame, m.

        Returns
        -------
        Vector
            Support frame.
        """
        return self.origin + self.rotation @ local

    def local(self, p: Vector) -> Vector:
        """Return the support's own coordinates of a point, m.

        Parameters
        ----------
        p : Vector
            A point, support frame, m.

        Returns
        -------
        Vector
            In the support's own frame.
        """
        return (p - self.origin) @ self.rotation

    def material_velocity(self, p: Vector) -> Vector:
        """Return u(p) = Ẋ + ω×(p − X), the velocity of the support's material at p, m/s.

        Parameters
        ----------
        p : Vector
            A point, support frame, m.

        Returns
        -------
        Vector
            Support frame.
        """
        return self.velocity + self.angular_velocity.cross(p - self.origin)

    def material_acceleration(self, p: Vector, p_rate: Vector) -> Vector:
        """Return u̇ = Ẍ + ω̇×(p − X) + ω×(ṗ − Ẋ), the rate of u along a moving contact point, m/s².

        Parameters
        ----------
        p : Vector
            The contact point, support frame, m.
        p_rate : Vector
            ṗ, how it moves, m/s.

        Returns
        -------
        Vector
            Support frame.
        """
        return (
            self.acceleration
            + self.angular_acceleration.cross(p - self.origin)
            + self.angular_velocity.cross(p_rate - self.velocity)
        )


class Motion(Part):
    """How a support moves: as a function of time, and of coordinates of its own that the run carries along.

    A motion of one's own needs `at`, for any scalar; what it says of itself in the attributes below should be true.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> from trundle.mechanics.algebra import ZERO
    >>> @dataclass(frozen=True)
    ... class Lift(Motion):
    ...     rate: Scalar
    ...     turns = False
    ...
    ...     def at(self, time, *coordinates):
    ...         up = Vector(0.0, 0.0, 1.0) * self.rate
    ...         return SupportState(Matrix.identity(), up * time, up, ZERO, ZERO, ZERO)
    >>> Lift(0.5).at(2.0).origin.z
    1.0
    """

    way: str = "moving"  # what figures call a support that moves so
    coordinates: tuple[str, ...] = ()  # names of these coordinates: ("angle",) or, of a free axle, ("angle", "rate")

    keeps_axis: bool | None = None  # whether it never leans the support's third axis; None: that is looked at
    turns: bool = True  # False: it only shifts the support
    free: bool = False  # whether the axle's acceleration is an unknown of the contact law
    inertia: Scalar  # of a free axle, kg m²

    @property
    def coordinate_kinds(self) -> tuple[str, ...]:
        """What kind of quantity each of these coordinates is: one of `trundle.units.UNITS`."""
        return tuple("angular velocity" if name.startswith("rate") else "angle" for name in self.coordinates)

    def axle_torque(self, time: Scalar, coordinates: tuple[Scalar, ...]) -> Scalar:  # noqa: ARG002
        """Return what drives or brakes a free axle besides the body, N m.

        Parameters
        ----------
        time : Scalar
            s.
        coordinates : tuple of Scalar
            Its own coordinates, as many as `coordinates` names.

        Returns
        -------
        Scalar
            About the axle.
        """
        return 0.0

    def at(self, time: Scalar, *coordinates: Scalar) -> SupportState:
        """Return pose, twist and acceleration at a time in s, the coordinates of its own having the given values.

        Parameters
        ----------
        time : Scalar
            s.
        *coordinates : Scalar
            Its own coordinates, as many as `coordinates` names.

        Returns
        -------
        SupportState
            In the inertial support frame.
        """
        raise NotImplementedError

    def initial_coordinates(self) -> tuple[Scalar, ...]:
        """Return the coordinates of its own at the start of a run.

        Returns
        -------
        tuple of Scalar
            As many as `coordinates` names.
        """
        return ()

    def coordinate_rates(self, time: Scalar, coordinates: tuple[Scalar, ...], moment: Scalar) -> tuple[Scalar, ...]:  # noqa: ARG002
        """Return the rates of these coordinates under a moment about the axle that the body exerts, N m.

        Parameters
        ----------
        time : Scalar
            s.
        coordinates : tuple of Scalar
            Its own coordinates, as many as `coordinates` names.
        moment : Scalar
            Of the body, N m.

        Returns
        -------
        tuple of Scalar
            As many as `coordinates` names, each for a second.
        """
        return ()

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:  # noqa: ARG002
        """Return what figures say of it, given a word for what moves and the coordinates of its own at the start.

        Parameters
        ----------
        ground : str
            The word for what moves: "table", "bowl".
        coordinates : tuple of float
            Its own coordinates at the start.

        Returns
        -------
        list of str
            Such as ``["ω = 3.5 rad/s"]``.
        """
        return []

    @property
    def steady_rate(self) -> Scalar | None:
        """ω of a steady turn about the support's third axis, rad/s; None for any other motion."""
        return None

    @property
    def mean_rate(self) -> Scalar:
        """The rate at which the support turns about its third axis on the whole, rad/s."""
        return 0.0 if self.steady_rate is None else self.steady_rate

    @property
    def fastest_rate(self) -> Scalar:
        """The fastest rate in the motion, rad/s: what a look at it must resolve."""
        return abs(self.mean_rate)

    def fastest_rate_within(self, start: float, end: float) -> float:  # noqa: ARG002  formulas ask when
        """Return the fastest rate in the motion from one time to another, rad/s.

        Parameters
        ----------
        start, end : float
            s.

        Returns
        -------
        float
            Of the time between.
        """
        return float(self.fastest_rate)
