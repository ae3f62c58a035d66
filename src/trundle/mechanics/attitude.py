"""How a body that is not round is put down: heading, lean and turn about the contact, and back.

The orientation is Q = [e₁ e₂ n] R₃(ψ) R₁(θ) R₃(φ), with e₁ and e₂ the directions in which the support's two
coordinates grow, n its normal, and R₁, R₃ turns about the first and third axis.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from . import checks
from .algebra import Matrix, Quaternion, Vector
from .scalars import Scalar, less, namespace

_POLE = 1e-12  # sine of the lean below which heading and turn are one angle


class Attitude(NamedTuple):
    """Heading ψ, lean θ and turn φ, rad: z-x-z Euler angles in the frame of the contact."""

    heading: Scalar
    lean: Scalar
    turn: Scalar


def attitude(
    first: Vector, second: Vector, normal: Vector, heading: Any = 0.0, lean: Any = 0.0, turn: Any = 0.0
) -> Quaternion:
    """Return the orientation of a body by how it stands on its support.

    Parameters
    ----------
    first, second, normal : Vector
        e₁, e₂ and n at the contact: right-handed, of length 1, in numbers.
    heading : float or quantity
        ψ, from e₁ towards e₂ to the direction of a coin's track, about n, rad.
    lean : float or quantity
        θ, between the body's third axis and n, rad: 90 degrees for an upright coin, 0 for one that lies flat. The third
        axis of an upright coin points to the right of its heading; below 90 degrees its top leans to the left.
    turn : float or quantity
        φ, of the body about its third axis, rad.

    Returns
    -------
    Quaternion
        Body frame to support frame, w not negative.

    Examples
    --------
    A coin that stands upright, heading along the first direction: its axis points to its right, against the second.

    >>> from trundle.mechanics.algebra import E_X, E_Y, E_Z
    >>> axis = attitude(E_X, E_Y, E_Z, lean="90 deg").matrix() @ E_Z
    >>> [round(part, 12) + 0.0 for part in axis]
    [0.0, -1.0, 0.0]
    """
    psi, theta, phi = (
        checks.real(value, "angle", name) for name, value in (("heading", heading), ("lean", lean), ("turn", turn))
    )
    xp = namespace(psi, theta, phi)
    c, s = xp.cos(0.5 * theta), xp.sin(0.5 * theta)
    half, apart = 0.5 * (psi + phi), 0.5 * (psi - phi)
    own = Quaternion(c * xp.cos(half), s * xp.cos(apart), s * xp.sin(apart), c * xp.sin(half))
    q = Quaternion.of_matrix(Matrix(first, second, normal).transpose) * own
    turned = less(q.w, 0.0)
    return Quaternion(*(xp.where(turned, -part, part) for part in q))


def attitude_of(first: Vector, second: Vector, normal: Vector, orientation: Quaternion) -> Attitude:
    """Return heading, lean and turn of a body from its orientation: the inverse of `attitude`.

    Examples
    --------
    >>> from trundle.mechanics.algebra import E_X, E_Y, E_Z
    >>> found = attitude_of(E_X, E_Y, E_Z, attitude(E_X, E_Y, E_Z, 0.5, 1.2, -2.0))
    >>> [round(angle, 12) for angle in found]
    [0.5, 1.2, -2.0]
    """
    across, _, axis = orientation.matrix().transpose.rows
    seen = Vector(first.dot(axis), second.dot(axis), normal.dot(axis))
    rows = orientation.matrix().transpose @ normal  # n in the body frame
    xp = namespace(tuple(seen), tuple(rows))
    sine = xp.hypot(seen.x, seen.y)
    pole = less(sine, _POLE)
    heading = xp.where(pole, xp.atan2(second.dot(across), first.dot(across)), xp.atan2(seen.x, -seen.y))
    turn = xp.where(pole, 0.0 * sine, xp.atan2(rows.x, rows.y))
    return Attitude(heading, xp.atan2(sine, seen.z), turn)
