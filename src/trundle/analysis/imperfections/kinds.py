"""The shortcomings, one class each: how large, what they change, what theory says of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from trundle.wording import short, with_unit

from ...mechanics.loads import Drag, RollingResistance
from ...mechanics.motions import UnevenSpin, Wobble
from ...mechanics.system import RollingSystem
from .circle import Demonstration, Fate


@dataclass(frozen=True)
class Shortcoming:
    """One way in which a demonstration is less than perfect."""

    size: float  # in SI
    name: ClassVar[str]
    label: ClassVar[str]

    @property
    def size_text(self) -> str:
        """The size with its unit."""
        raise NotImplementedError

    def system(self, show: Demonstration) -> RollingSystem:
        """Return the demonstration with this shortcoming and no other."""
        raise NotImplementedError

    def fate(self, show: Demonstration) -> Fate:
        """Return what theory says."""
        raise NotImplementedError


class Tilt(Shortcoming):
    """A table that leans by `size`, rad."""

    name, label = "tilt", "table not level"

    @property
    def size_text(self) -> str:
        """In degrees."""
        return f"{short(math.degrees(self.size), 3)}°"

    def system(self, show: Demonstration) -> RollingSystem:
        """Tilt the table."""
        return show.on(tilt=self.size)

    def fate(self, show: Demonstration) -> Fate:
        """Return the drift."""
        return show.tilted(self.size)


class StillAir(Shortcoming):
    """Air at rest that drags with the coefficient `size`, kg/s."""

    name, label = "still-air", "drag of air at rest"

    @property
    def size_text(self) -> str:
        """In grams a second."""
        return f"{short(self.size * 1e3, 3)} g/s"

    def air_rate(self, show: Demonstration) -> float:  # noqa: ARG002
        """Return the rate at which the air turns, rad/s."""
        return 0.0

    def system(self, show: Demonstration) -> RollingSystem:
        """Fill the room with air."""
        return show.on(load=Drag(self.size, self.air_rate(show)))

    def fate(self, show: Demonstration) -> Fate:
        """Return the spiral."""
        return show.in_air(self.size, self.air_rate(show))


class TurningAir(StillAir):
    """Air that turns with the table and drags with the coefficient `size`, kg/s."""

    name, label = "turning-air", "drag of air that turns with the table"

    def air_rate(self, show: Demonstration) -> float:
        """Return the table's rate."""
        return show.rate


class Resistance(Shortcoming):
    """A table against which the ball rolls with resistance: the normal force acts `size` ahead of the contact, m."""

    name, label = "rolling-resistance", "resistance to rolling"

    @property
    def size_text(self) -> str:
        """As a length."""
        return with_unit(self.size, "length")

    def system(self, show: Demonstration) -> RollingSystem:
        """Let the table resist."""
        return show.on(load=RollingResistance(self.size))

    def fate(self, show: Demonstration) -> Fate:
        """Return how the centre comes in and the circle grows."""
        return show.resisted(self.size)


class Askew(Shortcoming):
    """A table askew on its axle by `size`, rad, so that it wobbles once a turn."""

    name, label = "wobble", "table askew on its axle"

    @property
    def size_text(self) -> str:
        """In degrees."""
        return f"{short(math.degrees(self.size), 3)}°"

    def system(self, show: Demonstration) -> RollingSystem:
        """Let the table wobble."""
        return show.on(motion=Wobble(show.rate, self.size))

    def fate(self, show: Demonstration) -> Fate:
        """Return the sway."""
        return show.wobbling(self.size)


@dataclass(frozen=True)
class Uneven(Shortcoming):
    """A table whose rate varies by the share `size`, at a rate of variation in rad/s."""

    variation_rate: float
    name, label = "uneven-rate", "uneven rate of the table"

    @property
    def size_text(self) -> str:
        """In percent, with its period."""
        return f"{short(self.size * 100, 3)} %, every {with_unit(2 * math.pi / self.variation_rate, 'time')}"

    def system(self, show: Demonstration) -> RollingSystem:
        """Let the rate vary."""
        return show.on(motion=UnevenSpin(show.rate, self.size, self.variation_rate))

    def fate(self, show: Demonstration) -> Fate:
        """Return the sway, or the growth in step."""
        return show.uneven(self.size, self.variation_rate)
