"""From which orientation a ball starts if its Ω is along its own axes: it must then roll as its path says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...mechanics.algebra import Quaternion
from ...mechanics.shapes import concentric_sphere
from .case import Case
from .examining import SLIP
from .fitting import least_squares
from .motion import first_orientation, motion_of, turned_to_space
from .record import Array, ExternalTrajectory

_LITTLE = 1e-4  # of what rolls, that slips: no start is told more closely
_FAR_BETTER = 0.5  # of the slip that the given start leaves: another must be so much better
_TOGETHER = 10.0  # residuals that noise moves together
_UNIT = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Aligned:
    """Where the sum of Ω along the body's axes starts."""

    start: Quaternion  # body frame to support frame
    given: bool  # whether it is the one that a run is taken to start with; else it was fitted
    unsure: float = 0.0  # by what a fit may be off, rad


def aligned(case: Case) -> Aligned:
    """Take their Ω for one along the body's axes, and find the orientation from which the ball rolls best."""
    given = Quaternion(*first_orientation(case.start))
    if not concentric_sphere(case.system.body.shape):  # where another touches, its orientation tells
        return Aligned(given, given=True)
    own = turned_to_space(case.theirs, _UNIT)
    little = max(_LITTLE, float(own.doubts["orientation"].angle.max()))
    best = Aligned(given, given=True)
    # On a circle about the centre the path cannot tell one rate from another, and the one that is said comes first.
    for rolling in (_Rolling(case, own, rate_free=False), _Rolling(case, own, rate_free=True)):
        if rolling.left(given) <= little:
            return Aligned(given, given=True)
        fits = [fit for start in _starts(given) if (fit := rolling.fitted(start)) is not None]
        found = min(fits, key=lambda fit: rolling.left(fit.start), default=best)
        if rolling.left(found.start) <= _FAR_BETTER * rolling.left(best.start):
            best = found
        if rolling.left(best.start) <= little:
            return best
    return best


def _starts(given: Quaternion) -> Iterator[Quaternion]:
    """Yield orientations of which one is near each, the given one first: it is turned as a cube is onto itself."""
    from scipy.spatial.transform import Rotation

    turns = sorted(Rotation.create_group("O"), key=lambda turn: turn.magnitude())
    yield from (Quaternion(*turn.as_quat(scalar_first=True)) * given for turn in turns)


class _Rolling:
    """The slip of a ball, over its bounds, if Ω was added up along its own axes from one start or another.

    All of it is linear in the nine elements of the start's rotation matrix, so that a triangle of ten rows stands for
    the thousands of a track. The support may be free to turn at another rate than is said, the mistake that is most
    often made beside this one.
    """

    def __init__(self, case: Case, own: ExternalTrajectory, *, rate_free: bool) -> None:
        at = motion_of(case.system, own, case.start, case.view.instants)
        bound = case.series[SLIP].bound[:, None]
        velocity, carried = ((v / bound).ravel() for v in (at.velocity, at.carried))
        rolled = _elements(np.cross(np.eye(3)[:, None], at.offset / bound), at.angular_velocity)
        flat = case.system.support.surface.flat and case.system.body.is_isotropic_sphere
        normal = np.broadcast_to(at.contact.normal.array(), at.position.shape) if flat else 0.0 * at.position
        arm = np.linalg.norm(at.offset, axis=1)[:, None]
        spin = _elements((normal * arm).T[:, :, None], at.angular_velocity)
        spin = (spin - spin.mean(axis=0)) / bound  # of a ball on a plane no contact can change it
        slip = np.column_stack([rolled, velocity if rate_free else velocity - carried])
        if rate_free:  # the share of what is carried with which least slips
            slip -= np.outer(carried, carried @ slip) / max(float(carried @ carried), 1e-300)
        self._off = np.vstack([slip, np.column_stack([spin, np.zeros(len(spin))])])
        self._size = velocity.size
        self._rolled, self._slip, self._short = (
            np.asarray(np.linalg.qr(rows, "r")) for rows in (rolled, slip, self._off)
        )

    def fitted(self, start: Quaternion) -> Aligned | None:
        """Turn a start until least is off."""
        turned = np.array([(Quaternion(*e) * start).array() for e in np.eye(4)])
        constant, products = self._short[:, :9] @ _NONE + self._short[:, 9], _PRODUCTS @ self._short[:, :9].T

        def residuals(sets: Array) -> Array:
            q = _turn(sets.T).array() @ turned
            return constant + np.einsum("ki,kj->kij", q, q).reshape(-1, 16) @ products

        found = least_squares(
            residuals,
            [0.0, 0.0, 0.0],
            lambda angles: self._off @ _with_one(_turn(angles) * start),
        )
        if found is None:
            return None
        angles, doubts = found  # as if all residuals were moved together
        unsure = float(np.linalg.norm(doubts)) * np.sqrt(_TOGETHER / self._size)
        return Aligned(_turn(angles) * start, given=False, unsure=unsure)

    def left(self, start: Quaternion) -> float:
        """Return the slip as a share of what rolls."""
        elements = _with_one(start)
        slip, rolled = np.linalg.norm(self._slip @ elements), np.linalg.norm(self._rolled @ elements[:-1])
        return float(slip) / max(float(rolled), 1e-300)


def _elements(weights: Array, turning: Array) -> Array:
    """Return, for each element of a matrix M by rows, what it adds to the sum of the weights times M turning."""
    return np.stack([weight * turning[:, [k]] for weight in weights for k in range(3)], axis=-1).reshape(-1, 9)


def _nine(start: Any) -> Array:
    return np.array([element for row in Quaternion(*start).matrix().rows for element in row])


# The nine elements are these, and for each product of two components of a quaternion these (16, 9) more.
_NONE = _nine(np.zeros(4))
_PRODUCTS = 0.5 * np.array([_nine(a + b) - _nine(a) - _nine(b) + _NONE for a in np.eye(4) for b in np.eye(4)])


def _with_one(start: Quaternion) -> Array:
    """Return the nine elements of a rotation matrix, and one for what does not depend on it."""
    return np.array([*_nine(start), 1.0])


def _turn(angles: Array) -> Quaternion:
    """Return the turn about a vector by its length, rad."""
    half = np.linalg.norm(angles, axis=0) / 2
    return Quaternion(np.cos(half), *(0.5 * np.sinc(half / np.pi) * angles))


__all__ = ["Aligned", "aligned"]
