"""Motions of the support, those of the package and those that only the tests have."""

from __future__ import annotations

import pytest
from tests.additions import Tumble
from tests.contracts.contract_motion import MotionContract

from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import Vector
from trundle.mechanics.motions import Fixed, Spin


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


class TestTumble(MotionContract):
    motion = Tumble(1.5, 0.25, -0.75, Vector(0.5, -0.25, 0.125), 2.0)
