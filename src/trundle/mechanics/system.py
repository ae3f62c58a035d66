"""A rolling system (body, support, loads) and a state to start it from."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from ..display import Displayed, Markup, number, numbers, pairs
from ..errors import InvalidValueError
from . import checks
from .algebra import E_Z, ZERO, Vector
from .bodies import Body
from .contact import Contact
from .duals import value_of
from .loads import Acting, BodyMotion, Gravity, Load
from .motions import Fixed, Motion
from .parts import Number
from .scalars import Scalar, is_number, less, namespace
from .surfaces import Surface

if TYPE_CHECKING:
    from ..fields import VectorField

T = TypeVar("T")
STANDARD_GRAVITY = 9.80665  # m/s², exact by definition (3rd CGPM, 1901)


@dataclass(frozen=True)
class Support:
    """What the body rolls on: a surface, how it moves, how it leans.

    Parameters
    ----------
    surface : Surface
        The surface in the support's own frame.
    motion : Motion
        How it moves; at rest unless said otherwise.
    tilt : float or quantity
        α, the angle between the support's axis and the vertical, rad; the first axis points down the slope.
    friction : float, optional
        Coulomb's coefficient μ; absent: it holds whatever rolling takes, and the card says how much that was.
    kinetic_friction : float, optional
        Of slipping, at most `friction`; absent: the same.
    restitution : float
        e of a landing, by Stronge's hypothesis: the share e² of the work of compression is given back; 0 to 1.
    tangential_restitution : float
        e_t of a landing: the share e_t² of what friction took is given back, so that a ball that grips comes off with
        −e_t of its slip (Garwin, Cross); 0 to 1.

    Examples
    --------
    >>> from trundle.mechanics.surfaces import Plane
    >>> Support(Plane(), tilt="3 deg").tilt
    0.05235987755982989
    """

    surface: Surface
    motion: Motion = field(default_factory=Fixed)
    tilt: Annotated[Scalar, Number("angle")] = 0.0
    friction: Scalar | None = None
    kinetic_friction: Scalar | None = None
    restitution: Scalar = 0.0
    tangential_restitution: Scalar = 0.0

    def __post_init__(self) -> None:
        checks.instance(self.surface, Surface, "surface", "Give for instance tr.Plane(rim=0.5).")
        checks.instance(self.motion, Motion, "motion", "Give for instance tr.Spin(3.5).")
        tilt = checks.real(self.tilt, "angle", "tilt")
        if is_number(tilt):
            self.surface.check_tilt(tilt, self.tilt)
        object.__setattr__(self, "tilt", tilt)
        if self.friction is not None:
            object.__setattr__(self, "friction", checks.non_negative(self.friction, "number", "friction"))
        self._check_slipping()

    def _check_slipping(self) -> None:
        """Check what belongs to slipping and landing."""
        if self.kinetic_friction is not None:
            kinetic = checks.non_negative(self.kinetic_friction, "number", "kinetic_friction")
            object.__setattr__(self, "kinetic_friction", kinetic)
            if self.friction is None:
                remedy = "Give `friction` too: where rolling ends."
                raise InvalidValueError("kinetic_friction", "must stand beside `friction`", kinetic, remedy)
            if is_number(kinetic) and is_number(self.friction) and kinetic > self.friction:
                raise InvalidValueError("kinetic_friction", "must be at most `friction`", kinetic)
        for key in ("restitution", "tangential_restitution"):
            e = checks.non_negative(getattr(self, key), "number", key)
            if is_number(e) and e > 1:
                raise InvalidValueError(key, "must lie in [0, 1]", getattr(self, key))
            object.__setattr__(self, key, e)

    @property
    def sliding_friction(self) -> Scalar:
        """The coefficient of slipping, μ of f = −μ N ŝ."""
        return self.friction if self.kinetic_friction is None else self.kinetic_friction


@dataclass(frozen=True)
class State(Displayed):
    """Where a body is and how it moves, in the inertial support frame.

    Parameters
    ----------
    position : tuple of 3 floats
        Centre of mass, m.
    velocity : tuple of 3 floats
        Of the centre of mass, m/s.
    angular_velocity : tuple of 3 floats
        Ω, rad/s.
    orientation : tuple of 4 floats
        Unit quaternion (w, x, y, z), body frame to support frame.
    time : float
        s.
    support : tuple of float
        The coordinates of the support's own motion, such as the angle and rate of a free axle; mostly none.

    Examples
    --------
    >>> State((0.1, 0.0, 0.025), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)).orientation
    (1.0, 0.0, 0.0, 0.0)
    """

    position: tuple[float, float, float]
    velocity: tuple[float, float, float]
    angular_velocity: tuple[float, float, float]
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    time: float = 0.0
    support: tuple[float, ...] = ()

    def _parts(self) -> Iterator[Markup]:
        yield pairs(
            [
                ("position r", numbers(self.position, unit="m")),
                ("velocity V", numbers(self.velocity, unit="m/s")),
                ("angular velocity Ω", numbers(self.angular_velocity, unit="rad/s")),
                ("orientation q", numbers(self.orientation)),
                ("time", number(self.time, unit="s")),
                ("support", numbers(self.support) if self.support else ""),
            ]
        )


@dataclass(frozen=True)
class RollingSystem:
    """A body that rolls on a support under loads.

    Parameters
    ----------
    body : Body
        What rolls.
    support : Support
        What it rolls on.
    loads : sequence of Load
        Forces and torques besides gravity.
    gravity : float or quantity
        g, m/s²; 0 turns it off.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(rim=0.5), motion=tr.Spin(3.49), tilt=0.05)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.025, mass=0.065), table)
    >>> start = system.place(position=(0.10, 0.0), velocity=(0.0, 0.2))
    >>> [round(rate, 6) for rate in start.angular_velocity]
    [5.96, 0.0, 0.0]
    """

    body: Body
    support: Support
    loads: tuple[Load, ...] = ()
    gravity: Annotated[Scalar, Number("acceleration")] = STANDARD_GRAVITY

    def __post_init__(self) -> None:
        checks.instance(self.body, Body, "body", "Give for instance tr.Body.solid_sphere(radius=0.025, mass=0.065).")
        checks.instance(self.support, Support, "support", "Give for instance tr.Support(tr.Plane()).")
        example = "Give for instance [tr.Drag(0.01)]."
        loads = self.loads if isinstance(self.loads, (list, tuple)) else (self.loads,)
        for i, load in enumerate(loads):
            checks.instance(load, Load, f"loads[{i}]", example)
        object.__setattr__(self, "loads", tuple(load.over(self.support.motion) for load in loads))
        object.__setattr__(self, "gravity", checks.non_negative(self.gravity, "acceleration", "gravity"))

    @cached_property  # asked for at every instant at which forces are
    def weight(self) -> Gravity:
        """Gravity in the support frame: g(sin α, 0, −cos α)."""
        tilt = self.support.tilt
        xp = namespace(tilt)
        # The float nearest to a right angle means one: cos α as sin(π/2 − α) leaves no gravity along a level axis.
        if getattr(xp, "exact", False):
            normal = xp.cos(tilt)
        else:  # both sides of 0 have the same slope there
            normal = xp.sin(0.5 * math.pi - xp.where(less(value_of(tilt), 0.0), -tilt, tilt))
        return Gravity(self.gravity * xp.sin(tilt), 0.0, -(self.gravity * normal))

    @cached_property
    def all_loads(self) -> tuple[Load, ...]:
        """Gravity and the other loads."""
        return (self.weight, *self.loads)

    @cached_property
    def _known(self) -> dict[Any, Any]:
        """What others have found out of it, by who they are: as it is frozen, that stays so."""
        return {}

    def once(self, find: Callable[[RollingSystem], T]) -> T:
        """Return what a function finds out of it, which is asked only once.

        Examples
        --------
        >>> import trundle as tr
        >>> from trundle.mechanics.parameters import numbers
        >>> ball = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
        >>> ball.once(numbers) is ball.once(numbers)
        True
        """
        if find not in self._known:
            self._known[find] = find(self)
        found: T = self._known[find]
        return found

    def __getstate__(self) -> dict[str, Any]:
        """Return its parts; a copy finds out again what follows from them."""
        return {part.name: getattr(self, part.name) for part in fields(self)}

    @property
    def corners(self) -> tuple[Callable[[BodyMotion], Vector], ...]:
        """Vectors on whose lengths the loads depend, so that they have corners in the time where one passes zero."""
        return tuple(corner for load in self.loads for corner in load.corners)

    def loads_on(self, motion: BodyMotion) -> tuple[Vector, Vector]:
        """Return the applied force F, N, and torque K about the centre of mass, N m."""
        acting = self.acting_on(motion)
        return acting.force, acting.torque

    @property
    def resisted(self) -> bool:
        """Whether a resistance acts that stops the body's turning over the support."""
        return any(load.stops for load in self.loads)

    @property
    def resistance(self) -> Scalar:
        """The couple that resistance can hold against for each newton of normal force, m."""
        return sum((load.offset for load in self.loads if load.stops), 0.0)

    def acting_on(self, motion: BodyMotion, *, held: bool = False) -> Acting:
        """Return all that acts on the body besides the contact force; held, no resistance, which has no direction."""
        force, torque, from_support, couple = ZERO, ZERO, ZERO, ZERO
        for load in self.all_loads:
            exerted = load.torque(motion)
            force, torque = force + load.force(motion), torque + exerted
            from_support = from_support + exerted if load.at_contact else from_support
            if not (held and load.stops):
                couple = couple + load.torque_per_normal_force(motion)
        return Acting(force, torque, from_support, couple)

    def place(
        self,
        position: Any = (0.0, 0.0),
        velocity: Any = None,
        spin: Any = None,
        angular_velocity: Any = None,
        orientation: Any = None,
        roll: Any = 0.0,
        attitude: Any = None,
        height: Any = 0.0,
        time: Any = 0.0,
        support: Any = None,
    ) -> State:
        """Put the body down so that it rolls from the first instant; or so that it slips, or falls.

        Parameters
        ----------
        position : sequence of 2 floats or quantities
            On a plane, the centre of the body over it, m. On a curved support, the coordinates of the contact: on a
            cylinder the angle from its first axis towards the second, rad, and the height along its axis, m.
        velocity : sequence of 2 or 3 floats or quantities, "co-rotating" or "rolling", optional
            Of the centre, in the inertial support frame, along the directions in which the two coordinates grow and
            along the normal, m/s; absent: at rest. Of two components, the third follows from the contact.
            "co-rotating" releases the body from rest relative to the support's material under it; "rolling" is the
            velocity at which it rolls with the `angular_velocity` given.
        spin : float or quantity, optional
            Ω·n, rad/s; the rest of Ω follows from no slip. Absent: 0, or the support's rate when co-rotating.
        angular_velocity : sequence of 3 floats or quantities, optional
            Ω instead of `spin`. It must agree with rolling unless the support has a `friction`: then it may slip.
        orientation : sequence of 4 floats, optional
            Quaternion (w, x, y, z), body frame to support frame; it is normalised. Absent: not turned; a cylinder is
            laid across its way, the first axis of the body frame along the normal.
        roll : float or quantity
            Of a cylinder laid down so: the angle by which it has rolled on since, rad.
        attitude : sequence of 3 floats or quantities, optional
            Heading, lean and turn instead of `orientation`, rad: see `trundle.mechanics.attitude`. An upright coin
            that heads along the first direction has (0, π/2, 0).
        height : float or quantity
            Of the body over the support, along the normal, m; above 0 it falls, and does not turn unless told to.
        time : float or quantity
            When, on the clock of the support's motion and of loads that vary, s.
        support : sequence of floats or quantities, optional
            The coordinates of the support's own motion, such as angle and rate of a free axle, rad and rad/s; absent:
            as the motion itself starts.

        Returns
        -------
        State
            The start.

        Raises
        ------
        InvalidValueError
            If a value is refused, the body does not fit there, or the start contradicts itself.

        Examples
        --------
        >>> import trundle as tr
        >>> table = tr.Support(tr.Plane(), motion=tr.Spin(2.0))
        >>> system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.5, mass=1.0), table)
        >>> system.place(position=(1.0, 0.0), velocity="co-rotating").velocity
        (0.0, 2.0, 0.0)
        """
        from .placing import Placing

        placing = Placing(
            self, position, velocity, spin, angular_velocity, orientation, roll, attitude, height, time, support
        )
        return placing.state()

    def vector_field(
        self, backend: str = "numpy", phase: str = "rolling", inputs: Sequence[str] = ("force", "torque", "support")
    ) -> VectorField:
        """Return the right-hand side dy/dt = f(t, y, p, u) of this system's law, for a program of your own.

        Parameters
        ----------
        backend : str
            "numpy", "numba", "jax", "sympy", "c" or "javascript".
        phase : str
            "rolling", "slipping", "flight" or "rest".
        inputs : sequence of str
            What u holds: a "force" and a "torque" on the body, the motion of a platform that carries the "support".

        Returns
        -------
        VectorField
            Functions of the state y, the parameters p and the inputs u, with the names and units of each.

        Raises
        ------
        UnknownNameError
            If there is no such backend, phase or input.
        InvalidValueError
            If the system never has that phase.
        OutOfDomainError
            If its surface is known by a table only.

        Examples
        --------
        >>> import trundle as tr
        >>> table = tr.Support(tr.Plane(), motion=tr.Spin(2.0))
        >>> system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.5, mass=1.0), table)
        >>> f = system.vector_field("numpy")
        >>> y = f.pack(system.place(position=(1.0, 0.0), velocity="co-rotating"))
        >>> f.rates(0.0, y, f.parameters, f.inputs)[:3].tolist()
        [0.0, 2.0, 0.0]
        """
        from ..fields import VectorField

        return VectorField(self, backend, phase, tuple(inputs))

    def check_rim(self, contact: Contact, position: Any) -> None:
        """Refuse a contact point at or beyond the rim, naming the position as the user gave it."""
        there = contact.support.local(contact.point)
        rim, distance = self.support.surface.rim, math.hypot(there.x, there.y)
        if rim is not None and distance >= rim:
            raise InvalidValueError(
                "position",
                f"must lie inside the rim at {rim:g} m",
                position,
                f"The contact is {distance:g} m from the axis.",
            )


__all__ = ["E_Z", "STANDARD_GRAVITY", "RollingSystem", "State", "Support"]
