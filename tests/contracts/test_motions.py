"""Motions of the support, those of the package and those that only the tests have."""

from __future__ import annotations

import math

import pytest
from tests.additions import Tumble
from tests.contracts.contract_motion import MotionContract

from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import Vector
from trundle.mechanics.motions import Fixed, Spin, UnevenSpin, Wobble


class TestFixed(MotionContract):
    motion = Fixed()


class TestSpin(MotionContract):
    motion = Spin(3.49)

    @pytest.mark.parametrize("rate", [float("nan"), float("inf"), "fast", "3 m"])
    def test_a_rate_is_an_angular_velocity(self, rate: object) -> None:
        with pytest.raises(InvalidValueError, match="rate"):
            Spin(rate)

    def test_a_positive_rate_turns_the_first_axis_towards_the_second(self) -> None:
        first_axis = Spin(1.0).at(0.5).rotation @ Vector(1.0, 0.0, 0.0)
        assert first_axis.y > 0


class TestSpinBackwards(MotionContract):
    motion = Spin(-0.25)


class TestUnevenSpin(MotionContract):
    motion = UnevenSpin(3.5, 0.25, 2.0)

    def test_on_the_whole_it_turns_at_its_rate(self) -> None:
        # After whole periods of the variation it has turned as a steady spin would have.
        period = 2 * math.pi / 2.0
        first_axis = self.motion.at(3 * period).rotation @ Vector(1.0, 0.0, 0.0)
        wanted = Spin(3.5).at(3 * period).rotation @ Vector(1.0, 0.0, 0.0)
        # ∫ω dt = ω₀(t + ε(1 − cos νt)/ν), and cos νt = 1 there
        assert (first_axis - wanted).norm() < 1e-13

    def test_a_variation_needs_a_rate(self) -> None:
        with pytest.raises(InvalidValueError, match="variation_rate"):
            UnevenSpin(3.5, 0.01, 0.0)


class TestWobble(MotionContract):
    motion = Wobble(-2.5, 0.3)

    def test_its_own_axis_goes_round_the_axle_at_the_angle(self) -> None:
        for t in (0.0, 0.4, 7.0):
            axis = self.motion.at(t).rotation @ Vector(0.0, 0.0, 1.0)
            assert axis.z == pytest.approx(math.cos(0.3), abs=1e-15)
            assert math.atan2(axis.y, axis.x) == pytest.approx(
                math.remainder(-math.pi / 2 - 2.5 * t, 2 * math.pi), abs=1e-12
            )


class TestTumble(MotionContract):
    motion = Tumble(1.5, 0.25, -0.75, Vector(0.5, -0.25, 0.125), 2.0)
