"""Their motion at some instants: what they gave, and what was worked out of it, each with what noise leaves open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.contact import Contact
from ...mechanics.system import RollingSystem, State
from ...solve.samples import Samples
from ...verify.acting import cross
from .doubts import Doubt, doubt_of
from .record import Array, ExternalTrajectory, contact_of, orientation_from
from .slopes import Estimate, Index

_SPINNING = 400  # instants at which a spin that nothing tells is followed
_AVERAGED = 0.3  # share of the noise that is left where windows take their means


@dataclass(frozen=True)
class Instants:
    """States at some instants, and the contact there; arrays (m,), (m, 3) and (m, 4), inertial support frame, SI."""

    time: Array
    position: Array
    velocity: Array
    angular_velocity: Array
    orientation: Array
    contact: Contact

    @cached_property
    def offset(self) -> Array:
        """ρ, (m, 3), m."""
        return np.broadcast_to(self.contact.offset.array(), self.position.shape)

    @cached_property
    def carried(self) -> Array:
        """Velocity u of the support at the contact, (m, 3), m/s."""
        return np.broadcast_to(self.contact.support.material_velocity(self.contact.point).array(), self.position.shape)

    @cached_property
    def slip(self) -> Array:
        """Slip s = V + Ω×ρ − u, (m, 3), m/s."""
        return self.velocity + cross(self.angular_velocity, self.offset) - self.carried

    @cached_property
    def arm(self) -> float:
        """The largest |ρ|, m."""
        return float(np.linalg.norm(self.offset, axis=1).max())

    def samples(self) -> Samples:
        """Return the record that the independent law takes; the contact force is not known, and stands as zero."""
        point = np.broadcast_to(self.contact.point.array(), self.position.shape)
        zero = np.zeros_like(self.position)
        return Samples(self.time, self.position, point, self.velocity, self.angular_velocity, self.orientation, zero)


@dataclass(frozen=True)
class Motion(Instants):
    """Their states at some of their samples, with what noise and spacing leave open of each part.

    `estimates` has position, velocity, angular_velocity and orientation, as far as they were given or follow from
    what was; `sources` says of which of their arrays each is made. Where nothing tells Ω it follows from no slip,
    and its part along the normal from `spin`.
    """

    index: Index
    estimates: Mapping[str, Estimate]
    sources: Mapping[str, str]
    spin: Array

    @property
    def turning_known(self) -> bool:
        """Whether what they gave tells Ω."""
        return "angular_velocity" in self.estimates

    def shifted(self, system: RollingSystem, steps: Sequence[tuple[str, Array]]) -> Instants:
        """Return the states as they are and behind them, one after the other, with one part changed by each step.

        A step is a part's name and a change of it, (m, 3); an orientation is turned by its, a spin grows by the first.
        """
        names = ("position", "velocity", "angular_velocity", "orientation", "spin")
        stacked = {name: [getattr(self, name)] * (1 + len(steps)) for name in names}
        for i, (name, step) in enumerate(steps):
            stacked[name][i + 1] = _changed(name, getattr(self, name), step)
        parts = {name: np.concatenate(arrays) for name, arrays in stacked.items()}
        spin = None if self.turning_known else parts["spin"]
        return instants(system, np.tile(self.time, 1 + len(steps)), parts, spin)


def _changed(name: str, part: Array, step: Array) -> Array:
    if name == "spin":
        return part + step[:, 0]
    if name != "orientation":
        return part + step
    turned = (Quaternion(1.0, *(Vector.of(step) * 0.5)) * Quaternion.of(part)).array()
    return np.asarray(turned / np.linalg.norm(turned, axis=1, keepdims=True))


def instants(system: RollingSystem, time: Array, parts: Mapping[str, Array], spin: Array | None = None) -> Instants:
    """Return states with their contact."""
    contact = contact_of(system, time, parts["position"], parts["orientation"])
    Omega = parts["angular_velocity"] if spin is None else _from_no_slip(contact, parts["velocity"], spin)
    return Instants(time, parts["position"], parts["velocity"], Omega, parts["orientation"], contact)


def motion_of(system: RollingSystem, theirs: ExternalTrajectory, start: State | None, index: Index) -> Motion:
    """Work out what they did not give, at some of their samples."""
    estimates, sources = _estimates(theirs, index)
    time, parts = theirs.time[index], {name: estimate.values for name, estimate in estimates.items()}
    if "orientation" in parts:
        parts["orientation"] = parts["orientation"] / np.linalg.norm(parts["orientation"], axis=1, keepdims=True)
    else:
        parts["orientation"] = np.tile(first_orientation(start), (index.size, 1))
    spin = np.zeros(index.size)
    if "angular_velocity" not in parts:
        spin, doubt = spin_of(system, theirs, start, index)
        if doubt.any():
            estimates["spin"], sources["spin"] = _doubtful(spin, doubt, estimates["position"]), "position"
    now = instants(system, time, parts, spin if "angular_velocity" not in parts else None)
    return Motion(
        time,
        now.position,
        now.velocity,
        now.angular_velocity,
        now.orientation,
        now.contact,
        index,
        estimates,
        sources,
        spin,
    )


def first_orientation(start: State | None) -> tuple[float, ...]:
    """Return the orientation that a run is taken to start with where nothing tells it."""
    return start.orientation if start is not None else (1.0, 0.0, 0.0, 0.0)


def _estimates(theirs: ExternalTrajectory, index: Index) -> tuple[dict[str, Estimate], dict[str, str]]:
    """Return what their arrays tell of the state, and which array tells it."""

    def value(name: str, order: int = 0) -> Estimate:
        found = theirs.slope(name, index, order, _AVERAGED)
        doubt = theirs.doubts.get(name)
        if doubt is None or order:
            return found
        return replace(found, bias=found.bias + doubt.angle[index] * np.linalg.norm(found.values, axis=1))

    found, sources = {"position": value("position")}, {"position": "position"}
    if theirs.velocity is not None:
        found["velocity"], sources["velocity"] = value("velocity"), "velocity"
    else:
        found["velocity"], sources["velocity"] = value("position", 1), "position"
    if theirs.orientation is not None:
        found["orientation"], sources["orientation"] = value("orientation"), "orientation"
    if theirs.angular_velocity is not None:
        found["angular_velocity"], sources["angular_velocity"] = value("angular_velocity"), "angular_velocity"
    elif theirs.orientation is not None:
        found["angular_velocity"], sources["angular_velocity"] = turning_of(theirs, index), "orientation"
    return found, sources


def turning_of(theirs: ExternalTrajectory, index: Index) -> Estimate:
    """Return Ω = 2 q̇ q* from their orientations."""
    rate, q = (theirs.slope("orientation", index, order, _AVERAGED) for order in (1, 0))
    Omega = 2 * (Quaternion.of(rate.values) * Quaternion.of(q.values).conjugate).array()[:, 1:]
    size = np.linalg.norm(rate.values, axis=1)
    found = rate.scaled(2.0, Omega, 2 * (rate.bias + q.bias * size))
    return replace(found, spread=2 * np.hypot(rate.spread, q.spread * size))


def _doubtful(spin: Array, doubt: Array, like: Estimate) -> Estimate:
    """Return a spin whose error is no noise of the samples."""
    none, nowhere = np.zeros(spin.size), np.zeros((spin.size, 1))
    return Estimate(spin[:, None], none, doubt, none, like.freedom, 1.0, nowhere.astype(int), nowhere)


def spin_of(
    system: RollingSystem, theirs: ExternalTrajectory, start: State | None, index: Index
) -> tuple[Array, Array]:
    """Return Ω·n where nothing that was given tells it: as at the start, and as a ball's goes on from there.

    Parameters
    ----------
    system : RollingSystem
        A ball, and its support.
    theirs : Theirs
        Their path.
    start : State, optional
        Gives the spin at the first sample, unless theirs has one.
    index : int array (m,)
        At which samples.

    Returns
    -------
    spin, doubt : array (m,)
        rad/s; the doubt is what half of the instants would change. No contact force turns a ball about the normal, so
        that the rate of Ω·n is Ω·ṅ.
    """
    n = theirs.time.size
    some = np.unique(np.linspace(0, n - 1, min(n, _SPINNING)).round().astype(int))
    flat = system.support.surface.flat
    at = some[:1] if flat else some
    position, velocity = theirs.slope("position", at, 0).values, _velocity(theirs, at)
    q = np.tile(first_orientation(start), (at.size, 1))
    contact = contact_of(system, theirs.time[at], position, q)
    normal = np.broadcast_to(contact.normal.array(), position.shape)
    first = theirs.spin
    if first is None:
        first = 0.0 if start is None else float(np.asarray(start.angular_velocity) @ normal[0])
    if flat:
        return np.full(index.size, first), np.zeros(index.size)
    across = _from_no_slip(contact, velocity, np.zeros(at.size))
    half = np.unique(np.append(np.arange(0, at.size, 2), at.size - 1))
    fine, coarse = (
        _turned_along(theirs.time[at[some]], normal[some], across[some], theirs.time[index])
        for some in (slice(None), half)
    )
    return first + fine, np.maximum.accumulate(np.abs(fine - coarse))


def _turned_along(time: Array, normal: Array, across: Array, wanted: Array) -> Array:
    """Return the integral of Ω·ṅ from the first instant on."""
    from scipy.interpolate import CubicSpline

    along = CubicSpline(time, normal).derivative()(time)
    rate = CubicSpline(time, (across * along).sum(axis=1))
    return np.asarray(rate.antiderivative()(wanted), dtype=float)


def _velocity(theirs: ExternalTrajectory, index: Index) -> Array:
    return theirs.velocity[index] if theirs.velocity is not None else theirs.slope("position", index, 1).values


def with_orientation(system: RollingSystem, theirs: ExternalTrajectory, start: State | None) -> ExternalTrajectory:
    """Add up their Ω to an orientation where the law needs one and they gave none."""
    if system.body.is_isotropic_sphere or theirs.orientation is not None or theirs.angular_velocity is None:
        return theirs
    q, doubt = added_up(theirs, first_orientation(start))
    return replace(theirs, orientation=q, doubts={**theirs.doubts, "orientation": doubt})


def added_up(theirs: ExternalTrajectory, q0: tuple[float, ...]) -> tuple[Array, Doubt]:
    """Return the orientation that their Ω adds up to, and the angle by which it may be off."""
    assert theirs.angular_velocity is not None  # noqa: S101  for the type checker; callers have looked
    q, gain = orientation_from(theirs.time, theirs.angular_velocity, q0)
    return q, doubt_of(theirs.time, theirs.angular_velocity, gain, theirs.windows)


def turned_to_space(theirs: ExternalTrajectory, q0: tuple[float, ...]) -> ExternalTrajectory:
    """Take their Ω for one along the body's axes, add it up to an orientation, and turn it to those of the frame."""
    assert theirs.angular_velocity is not None  # noqa: S101  for the type checker; callers have looked
    q, gain = orientation_from(theirs.time, theirs.angular_velocity, q0, body_axes=True)
    turned = (Quaternion.of(q).matrix() @ Vector.of(theirs.angular_velocity)).array()
    doubt = doubt_of(theirs.time, turned, gain, theirs.windows)
    doubts = {**theirs.doubts, "angular_velocity": doubt, "orientation": doubt}
    return replace(theirs, angular_velocity=turned, orientation=q, doubts=doubts)


def _from_no_slip(contact: Contact, V: Array, spin: Array) -> Array:
    """Return the Ω that rolling asks for, with a given part along the normal."""
    u = contact.support.material_velocity(contact.point)
    rho, n = contact.offset, contact.normal
    across = (Vector.of(V) - u).cross(rho) / rho.dot(rho)
    Omega = across + rho * ((spin - across.dot(n)) / rho.dot(n))
    return np.broadcast_to(Omega.array(), V.shape).astype(float)


def rate_of(system: RollingSystem) -> float:
    """Return the size of the support's rate, or the largest of its first instants', rad/s.

    Examples
    --------
    >>> import trundle as tr
    >>> rate_of(tr.RollingSystem(tr.Body.solid_sphere(0.5, 1.0), tr.Support(tr.Plane(), motion=tr.Spin(-2.0))))
    2.0
    """
    rate = system.support.motion.steady_rate
    if rate is not None:
        return abs(float(rate))
    return max(float(system.support.motion.at(t).angular_velocity.norm()) for t in (0.0, 0.3, 0.7))
