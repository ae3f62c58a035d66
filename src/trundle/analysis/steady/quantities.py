"""What a steady motion is told apart by: speed, spin, lean, turning, distance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .flow import Array, Flow

KINDS = {
    "speed": "velocity",
    "spin": "angular velocity",
    "lean": "angle",
    "turning": "angular velocity",
    "distance": "length",
    "rate": "angular velocity",
}
MEANINGS = {
    "speed": "of the centre of mass",
    "spin": "Ω·n, about the normal",
    "lean": "of the body's axis out of the support's tangent plane",
    "turning": "about the support's axis, of all that can be seen",
    "distance": "of the contact from the axis about which all turns",
    "rate": "of the support",
}
UNITS = {"speed": "m/s", "spin": "rad/s", "lean": "rad", "turning": "rad/s", "distance": "m", "rate": "rad/s"}


def body_axis(moves: Array) -> Array | None:
    """Return the body's axis of symmetry in its own frame, a unit vector; None where there is none or every one."""
    if not len(moves):
        return None
    # Turns of the body alone: combinations of the symmetries without shift and turn of space.
    _, singular, basis = np.linalg.svd(moves[:, :6].T, full_matrices=True)
    rank = int((singular > 1e-7 * max(float(np.abs(moves).max()), 1e-300)).sum())
    own = basis[rank:] @ moves[:, 6:]
    if len(own) != 1:
        return None
    axis = own[0] / np.linalg.norm(own[0])
    return np.asarray(axis * np.sign(axis[np.abs(axis).argmax()]))


@dataclass(frozen=True)
class Held:
    """A quantity that must have a given value.

    Parameters
    ----------
    name : str
        One of `KINDS`, not "rate".
    value : float
        SI.
    axis : (3,) array, optional
        The body's axis, for "lean".
    """

    name: str
    value: float
    axis: Array | None = None

    def now(self, flow: Flow, y: Any, shares: Array) -> Any:
        """Return the value at a state."""
        return value_of(self.name, flow, y, shares, self.axis)

    def missing(self, flow: Flow, y: Array, shares: Array) -> float:
        """Return how far the value is off, in units of the scale."""
        return float((self.now(flow, y, shares) - self.value) / self._unit(flow))

    def slopes(self, flow: Flow, y: Array, shares: Array, directions: Array) -> tuple[Array, Array]:
        """Return its derivatives along directions and by the shares of the symmetry, in units of the scale."""
        unit, by_shares = self._unit(flow), np.zeros(9)
        if self.name == "turning":
            by_shares[5] = 1.0 / unit
            return np.zeros(directions.shape[1]), by_shares
        along = flow.slopes(lambda z: self.now(flow, z, shares), y, directions)
        return np.nan_to_num(along / unit), by_shares

    def _unit(self, flow: Flow) -> float:
        units = {"speed": flow.length * flow.rate, "lean": 1.0, "distance": flow.length}
        return units.get(self.name, flow.rate)


def value_of(name: str, flow: Flow, y: Any, shares: Array, axis: Array | None) -> Any:
    """Return a quantity of a state, for one state or many, real or complex."""
    compute: dict[str, Callable[[], Any]] = {
        "speed": lambda: _length(*flow.law(y).velocity),
        "spin": lambda: _spin(flow, y),
        "lean": lambda: np.arcsin(_axis_over(flow, y, axis)),
        "turning": lambda: shares[5] + flow.turning,
        "distance": lambda: _length(y[0] - pole(shares)[0], y[1] - pole(shares)[1]),
    }
    return compute[name]()


def pole(shares: Array) -> Array:
    """Return the point of the plane z = 0 about which a move turns; the origin where it turns about none."""
    turn, shift = shares[5], shares[:2]
    far = abs(turn) * 1e9 <= float(np.hypot(*shift))
    return np.zeros(2) if turn == 0 or far else np.array([-shift[1], shift[0]]) / turn


def _length(*parts: Any) -> Any:
    return np.sqrt(sum(part * part for part in parts))


def _spin(flow: Flow, y: Any) -> Any:
    now = flow.law(y)
    n = now.contact.normal
    return y[7] * n.x + y[8] * n.y + y[9] * n.z


def _axis_over(flow: Flow, y: Any, axis: Array | None) -> Any:
    from ...mechanics.algebra import Quaternion, Vector

    if axis is None:
        return np.nan * y[0]
    e = Quaternion(*y[3:7]).matrix() @ Vector(*axis)
    n = flow.law(y).contact.normal
    # q of a nudged state is not of length 1: e is longer than 1 by its square.
    return e.dot(n) / _length(*e)
