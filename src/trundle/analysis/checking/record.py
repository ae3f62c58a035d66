"""Somebody else's trajectory as labelled arrays, and what can be worked out of it where a part is missing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.contact import Contact, contact_at
from ...mechanics.nearest import closest_contacts
from ...mechanics.shapes import concentric_sphere
from ...mechanics.system import RollingSystem
from .doubts import Doubt
from .noise import noise_of
from .polynomials import Known
from .slopes import Estimate, Index, best_fit, derivative

Array = NDArray[np.float64]

FEWEST = 12  # samples that a slope and its error can be taken from
_SPLINE = 7  # degree: the components of Ω along the body's axes turn with the body
_SEARCH = 50  # steps at most to the place of contact; spheres on planes and cylinders need two


@dataclass(frozen=True)
class ExternalTrajectory:
    """A trajectory to be checked, in the inertial support frame; what was not given is None.

    Examples
    --------
    >>> t = np.linspace(0.0, 1.0, 20)
    >>> ExternalTrajectory(t, np.zeros((20, 3))).parts
    'position'
    """

    time: Array  # (n,): ascending, s
    position: Array  # (n, 3): centre of mass, m
    velocity: Array | None = None  # (n, 3): m/s
    angular_velocity: Array | None = None  # (n, 3): Ω, rad/s
    orientation: Array | None = None  # (n, 4): quaternions (w, x, y, z), body frame to support frame
    # whether the third component of the position is theirs, or follows from touching the plane
    height_given: bool = True
    # of an orientation that was added up from Ω, or of an Ω that such a one turned
    doubts: Mapping[str, Doubt] = field(default_factory=dict)
    spin: float | None = None  # Ω·n at the first sample, where nothing that was given tells it, rad/s
    remarks: tuple[str, ...] = ()  # what was left out in reading
    source: str = ""  # where it comes from, for titles
    # What was worked out goes on to changed copies, by the arrays that it was worked out of.
    windows: Known = field(default_factory=dict, compare=False, repr=False)
    _kept: dict[Any, Any] = field(default_factory=dict, compare=False, repr=False)

    def slope(self, name: str, index: Index, order: int = 1, kept: float = 1.0) -> Estimate:
        """Return a derivative of one of the arrays at some samples; it is worked out once."""
        time, values = self.time, getattr(self, name)
        own, key = (id(time), id(values)), (name, order, kept)
        if own not in self._kept:  # with the arrays, so that no others take their places in memory
            self._kept[own] = noise_of(time, values, self.windows), time, values
        noise = self._kept[own][0]
        if key not in self._kept:  # changed copies bend as much: units and axes are what changes
            self._kept[key] = best_fit(time, values, order, self.windows, noise, kept)
        whole = (*own, *key, index.tobytes())
        if whole not in self._kept:
            self._kept[whole] = derivative(time, values, index, order, self.windows, self._kept[key], noise)
        return self._kept[whole]

    @property
    def parts(self) -> str:
        """What was given, in words."""
        names = {
            "position": self.position,
            "velocity": self.velocity,
            "Ω": self.angular_velocity,
            "orientation": self.orientation,
        }
        given = [name for name, array in names.items() if array is not None]
        return given[0] if len(given) == 1 else f"{', '.join(given[:-1])} and {given[-1]}"


def checked(theirs: ExternalTrajectory, system: RollingSystem) -> ExternalTrajectory:
    """Refuse what cannot be checked, and give quaternions unit length and a sign that is continuous in time.

    Examples
    --------
    See `trundle.check`.
    """
    t = theirs.time
    if t.size < FEWEST:
        raise InvalidValueError("time", f"must hold {FEWEST} samples or more", f"{t.size}", "Write more of the run.")
    backwards = np.flatnonzero(np.diff(t) <= 0)
    if backwards.size:
        i = int(backwards[0])
        raise InvalidValueError(
            "time", "must ascend", f"{t[i]:g} s, then {t[i + 1]:g} s (samples {i + 1} and {i + 2})", "Sort the rows."
        )
    if not theirs.height_given:
        theirs = replace(theirs, position=_with_height(theirs.position, system))
    if theirs.orientation is not None:
        theirs = replace(theirs, orientation=_unit_quaternions(theirs.orientation))
    if theirs.orientation is None and theirs.angular_velocity is None and not _same_from_every_side(system):
        raise InvalidValueError(
            "columns",
            "must hold Ω or the orientation for a body that is not the same from every side",
            theirs.parts,
            "Add wx, wy, wz or qw, qx, qy, qz.",
        )
    return theirs


def _with_height(position: Array, system: RollingSystem) -> Array:
    if not (system.support.surface.flat and concentric_sphere(system.body.shape)):
        raise InvalidValueError(
            "columns", "must hold all of x, y, z unless a ball rolls on a plane", "x and y", "Add the third component."
        )
    return np.column_stack([position[:, :2], np.full(position.shape[0], float(system.body.radius))])


def _unit_quaternions(q: Array) -> Array:
    length = np.linalg.norm(q, axis=1)
    worst = int(np.argmax(np.abs(length - 1)))
    if abs(length[worst] - 1) > 0.02:
        raise InvalidValueError(
            "orientation",
            "must be unit quaternions",
            f"length {length[worst]:.6g} in sample {worst + 1}",
            "Normalise them, or map the columns that hold them.",
        )
    q = q / length[:, None]
    flips = np.cumprod(np.where((q[1:] * q[:-1]).sum(axis=1) < 0, -1.0, 1.0))
    return q * np.concatenate([[1.0], flips])[:, None]


def _same_from_every_side(system: RollingSystem) -> bool:
    return bool(system.body.is_isotropic_sphere)


def check_covered(system: RollingSystem) -> None:
    """Refuse a support of which data about the body do not tell where it is.

    Examples
    --------
    >>> import trundle as tr
    >>> free = tr.Support(tr.Plane(), motion=tr.FreeAxle(inertia=0.1))
    >>> check_covered(tr.RollingSystem(tr.Body.solid_sphere(0.5, 1.0), free))
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `support.motion` must say where the support is at each instant, for a check; ...
    """
    own = system.support.motion.coordinates
    if own:
        raise InvalidValueError(
            "support.motion",
            "must say where the support is at each instant, for a check",
            system.support.motion.word,
            f"Its {' and '.join(own)} would have to come with the data, which is not covered.",
        )


def contact_of(system: RollingSystem, time: Array, centre: Array, orientation: Array) -> Contact:
    """Return the contact of a body whose centre is known: p = r + ρ(n(p)), found by going back and forth.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.5, 1.0), tr.Support(tr.Plane()))
    >>> contact = contact_of(system, np.zeros(1), np.array([[1.0, 2.0, 0.5]]), np.array([[1.0, 0, 0, 0]]))
    >>> contact.point.array().tolist()
    [[1.0, 2.0, 0.0]]
    """
    q, r = Quaternion.of(orientation), Vector.of(centre)
    point, moved = r, np.inf
    contact = contact_at(system, time, point, q)
    size = max(float(np.max(contact.offset.norm())), 1e-300)
    for _ in range(_SEARCH):
        before, point = point, r + contact.offset
        contact = contact_at(system, time, point, q)
        moved = float(np.max((point - before).norm()))
        if moved <= 1e-14 * size:
            break
    if moved <= 1e-9 * size:
        return contact
    contact = closest_contacts(system, time, centre, orientation)
    return replace(contact, point=r + contact.offset)


def gap_of(system: RollingSystem, contact: Contact) -> Array:
    """Return the signed distance of the body's lowest point from the support, to first order, m."""
    own = contact.support.local(contact.point)
    gap = np.asarray(system.support.surface.level(own), dtype=float)
    return np.broadcast_to(gap, np.shape(np.asarray(contact.point.x))).astype(float)


def orientation_from(
    time: Array, angular_velocity: Array, start: tuple[float, ...], *, body_axes: bool = False
) -> tuple[Array, Array]:
    """Add up Ω to an orientation, and say by how much it may be off.

    Examples
    --------
    >>> t = np.linspace(0.0, np.pi, 31)
    >>> q, doubt = orientation_from(t, np.outer(np.ones(31), [0.0, 0.0, 1.0]), (1.0, 0.0, 0.0, 0.0))
    >>> [round(c, 9) + 0.0 for c in q[-1].tolist()], bool(doubt.max() < 1e-9)
    ([0.0, 0.0, 0.0, 1.0], True)
    """
    from scipy.interpolate import make_interp_spline

    from ...solve.orientation import orientation

    sign = -1.0 if body_axes else 1.0  # the inverse rotation turns by −Ω, in the body's axes
    q0 = np.asarray(start) * [1.0, sign, sign, sign]
    found = []
    for stride in (1, 2):
        kept = np.unique(np.append(np.arange(0, time.size, stride), time.size - 1))
        spline = make_interp_spline(time[kept], sign * angular_velocity[kept], k=min(_SPLINE, kept.size - 1))
        found.append(orientation(_columns_of(spline), time, q0, float(time[0]), time[kept]))
    q, coarse = found
    side = np.sign((q * coarse).sum(axis=1, keepdims=True))
    doubt = 2 * np.linalg.norm(q - side * coarse, axis=1)
    return q * [1.0, sign, sign, sign], np.asarray(np.maximum.accumulate(doubt), dtype=float)


def _columns_of(spline: Callable[[Array], Array]) -> Callable[[Array], Array]:
    return lambda t: spline(t).T
