"""Motions one upon the other: a turntable on a shaking table on a rocking ship."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from ...errors import InvalidValueError
from .. import checks
from ..parts import PartsOf
from ..scalars import Scalar
from .base import Motion, SupportState


@dataclass(frozen=True)
class Combined(Motion):
    """Motions that carry each other, the outermost first: R = R₁R₂, X = X₁ + R₁X₂.

    Parameters
    ----------
    parts : sequence of Motion
        The outermost first. A `FreeAxle` can only be the last, and only be shifted, not turned, by the others: the
        moment that turns a support about an axle which itself turns is not a matter of one moment of inertia.

    Examples
    --------
    >>> from trundle.mechanics.motions import Shake, Spin
    >>> Combined((Shake((0.002, 0.0, 0.0), 10.0), Spin(3.5))).at(0.0).angular_velocity.z
    3.5
    """

    parts: Annotated[Any, PartsOf()]
    kind = "combined"
    label = "Several, one upon the other"

    def __post_init__(self) -> None:
        parts = tuple(self.parts) if isinstance(self.parts, (list, tuple)) else (self.parts,)
        for i, part in enumerate(parts):
            checks.instance(
                part, Motion, f"parts[{i}]", "Give for instance (tr.Shake((0.002, 0, 0), 30), tr.Spin(3.5))."
            )
        parts = tuple(inner for part in parts for inner in (part.parts if isinstance(part, Combined) else (part,)))
        object.__setattr__(self, "parts", parts)
        if not parts:
            raise InvalidValueError("parts", "must hold at least one motion", parts)
        for i, part in enumerate(parts[:-1]):
            if part.free:
                raise InvalidValueError(f"parts[{i}]", "must not be a free axle", part, "It can only be the last part.")
            if parts[-1].free and part.turns:
                remedy = "Shake and Move shift it without turning it."
                raise InvalidValueError(f"parts[{i}]", "must not turn a free axle", part, remedy)

    @property
    def way(self) -> str:  # type: ignore[override]
        """Those of the parts that move."""
        rate = self.steady_rate
        if rate is not None:
            return "turning" if rate else "fixed"
        return ", ".join(dict.fromkeys(part.way for part in self.parts if part.way != "fixed")) or "fixed"

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:
        """Return those of all parts."""
        pairs = zip(self.parts, self._shares(coordinates), strict=True)
        return [text for part, share in pairs for text in part.key_numbers(ground, share)]

    @property
    def coordinates(self) -> tuple[str, ...]:  # type: ignore[override]
        """The coordinates of all parts, numbered where two have one name."""
        names: list[str] = []
        for name in (name for part in self.parts for name in part.coordinates):
            taken = sum(have.partition("_")[0] == name for have in names)
            names.append(f"{name}_{taken + 1}" if taken else name)
        return tuple(names)

    @property
    def free(self) -> bool:  # type: ignore[override]
        """Whether the last part is a free axle."""
        return self.parts[-1].free

    @property
    def turns(self) -> bool:  # type: ignore[override]
        """Whether any part turns the support."""
        return any(part.turns for part in self.parts)

    @property
    def inertia(self) -> Scalar:
        """That of the free axle, kg m²."""
        return self.parts[-1].inertia

    def axle_torque(self, time: Scalar, coordinates: tuple[Scalar, ...]) -> Scalar:
        """Return that on the free axle, N m."""
        return self.parts[-1].axle_torque(time, self._shares(coordinates)[-1])

    def initial_coordinates(self) -> tuple[Scalar, ...]:
        """Return the coordinates of all parts at the start."""
        return tuple(value for part in self.parts for value in part.initial_coordinates())

    def coordinate_rates(self, time: Scalar, coordinates: tuple[Scalar, ...], moment: Scalar) -> tuple[Scalar, ...]:
        """Return the rates of the coordinates of all parts; the moment is that on the last."""
        pairs = zip(self.parts, self._shares(coordinates), strict=True)
        return tuple(rate for part, share in pairs for rate in part.coordinate_rates(time, share, moment))

    @property
    def steady_rate(self) -> Scalar | None:
        """The sum of steady turns, rad/s; None where any part is something else."""
        rates = [part.steady_rate for part in self.parts]
        return None if any(rate is None for rate in rates) else sum(rates)

    @property
    def mean_rate(self) -> Scalar:
        """The sum of those of the parts, rad/s."""
        return sum(part.mean_rate for part in self.parts)

    @property
    def fastest_rate(self) -> Scalar:
        """The sum of those of the parts, rad/s."""
        return sum(part.fastest_rate for part in self.parts)

    def fastest_rate_within(self, start: float, end: float) -> float:
        """Return the sum of those of the parts, rad/s."""
        return sum(part.fastest_rate_within(start, end) for part in self.parts)

    def at(self, time: Scalar, *coordinates: Scalar) -> SupportState:
        """Return the innermost part as the others carry it."""
        pairs = zip(self.parts, self._shares(coordinates), strict=True)
        outer, *inner = (part.at(time, *share) for part, share in pairs)
        for state in inner:
            outer = _carry(outer, state)
        return outer

    def _shares(self, coordinates: tuple[Scalar, ...]) -> list[tuple[Scalar, ...]]:
        """Deal out the coordinates to the parts."""
        rest = iter(coordinates)
        return [tuple(next(rest) for _ in part.coordinates) for part in self.parts]


def _carry(outer: SupportState, inner: SupportState) -> SupportState:
    """Return a motion in a moving frame as seen from outside: both poses, twists and accelerations composed."""
    R, omega, growth = outer.rotation, outer.angular_velocity, outer.angular_acceleration
    arm, velocity, turning = R @ inner.origin, R @ inner.velocity, R @ inner.angular_velocity
    carried = omega.cross(arm)
    return SupportState(
        rotation=R @ inner.rotation,
        origin=outer.origin + arm,
        velocity=outer.velocity + carried + velocity,
        acceleration=(
            outer.acceleration
            + growth.cross(arm)
            + omega.cross(carried)
            + 2.0 * omega.cross(velocity)
            + R @ inner.acceleration
        ),
        angular_velocity=omega + turning,
        angular_acceleration=growth + omega.cross(turning) + R @ inner.angular_acceleration,
    )
