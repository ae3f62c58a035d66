"""Motions of the support, those of the package and those that only the tests have."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import pytest
from tests.additions import Tumble
from tests.contracts.contract_motion import MotionContract

from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import Vector
from trundle.mechanics.expressions import Expression
from trundle.mechanics.motions import (
    Combined,
    Fixed,
    FreeAxle,
    Motion,
    Move,
    PrecessingTilt,
    Rock,
    Shake,
    Spin,
    SpinBy,
    Tilt,
    UnevenSpin,
    Wobble,
)


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


class TestSpinByARamp(MotionContract):
    motion = SpinBy("2 - 0.5*t")

    def support_coordinates_at(self, t: Any) -> tuple[Any, ...]:
        return (2 * t - t * t / 4,)


class TestSpinByAStartUp(MotionContract):
    motion = SpinBy("3.5*(1 - exp(-2*t)) + 0.25*sin(5*t)")

    def support_coordinates_at(self, t: Any) -> tuple[Any, ...]:
        return (3.5 * (t + mpmath.expm1(-2 * t) / 2) + 0.05 * (1 - mpmath.cos(5 * t)),)

    @pytest.mark.parametrize("rate", ["2*x", "t.real", "3 m", "t**0.5", None, float("inf")])
    def test_a_rate_is_a_formula_in_the_time_or_an_angular_velocity(self, rate: object) -> None:
        with pytest.raises(InvalidValueError, match="rate"):
            SpinBy(rate)

    def test_an_uneven_spin_is_one_of_its_kind(self) -> None:
        uneven, driven = UnevenSpin(3.5, 0.25, 2.0), SpinBy("3.5*(1 + 0.25*sin(2*t))")
        for t in (0.0, 0.3, 2.0):
            angle = 3.5 * (t + 0.25 * (1 - math.cos(2 * t)) / 2)
            one, other = uneven.at(t), driven.at(t, angle)
            assert one.angular_velocity.z == pytest.approx(other.angular_velocity.z, rel=1e-15)
            assert one.angular_acceleration.z == pytest.approx(other.angular_acceleration.z, rel=1e-15)

    def test_it_says_how_fast_it_goes_in_an_interval(self) -> None:
        assert SpinBy("2*sin(5*t)").fastest_rate_within(0.0, 10.0) == pytest.approx(2 + 5, rel=1e-3)
        assert SpinBy("1/(t - 1)").fastest_rate_within(0.0, 2.0) > 100  # looks where it is finite


class TestFreeAxle(MotionContract):
    motion = FreeAxle(0.02, rate=1.5, motor_torque="0.1*sin(t)", bearing_drag=0.01, bearing_torque=0.003)

    def support_coordinates_at(self, t: Any) -> tuple[Any, ...]:
        return (1.5 * t, mpmath.mpf(1.5))

    def test_bearings_brake_either_way_and_let_go_at_rest(self) -> None:
        bearing = FreeAxle(0.02, bearing_drag=0.25, bearing_torque=0.5)
        assert bearing.axle_torque(0.0, (0.0, 0.0)) == 0.0
        for rate in (2.0, -2.0):
            wanted = -math.copysign(0.25 * 2 + 0.5 / math.hypot(1, 0.01 / 2), rate)
            assert bearing.axle_torque(0.0, (0.0, rate)) == pytest.approx(wanted, rel=1e-15)

    @pytest.mark.parametrize(
        ("key", "value"),
        [("inertia", 0.0), ("inertia", "2 kg"), ("bearing_drag", -1.0), ("bearing_torque", -1.0), ("below", 0.0),
         ("motor_torque", "2*x")],
    )  # fmt: skip
    def test_it_refuses_by_name(self, key: str, value: object) -> None:
        with pytest.raises(InvalidValueError, match=key):
            FreeAxle(**{"inertia": 0.02, key: value})


class TestTilt(MotionContract):
    motion = Tilt("0.2*sin(3*t) - 0.1*t", axis=(1.0, -2.0, 0.5))

    def test_its_axis_stays(self) -> None:
        axis = Vector(1.0, -2.0, 0.5)
        assert (self.motion.at(0.7).rotation @ axis - axis).norm() < 1e-15

    def test_a_positive_angle_lowers_the_first_axis_as_a_tilt_does(self) -> None:
        assert (Tilt("5 deg").at(0.0).rotation @ Vector(1.0, 0.0, 0.0)).z < 0

    @pytest.mark.parametrize("axis", [(0, 0, 0), (1, 0), "x", (1, 0, float("nan"))])
    def test_an_axis_has_a_direction(self, axis: object) -> None:
        with pytest.raises(InvalidValueError, match="axis"):
            Tilt(0.1, axis)


class TestRock(MotionContract):
    motion = Rock(0.25, 3.0, phase=0.5, axis=(0.0, 1.0, 1.0))

    def test_it_is_the_tilt_by_its_formula(self) -> None:
        tilt = Tilt("0.25*sin(3*t + 0.5)", axis=(0.0, 1.0, 1.0))
        for t in (0.0, 1.3):
            one, other = self.motion.at(t), tilt.at(t)
            off = one.angular_acceleration - other.angular_acceleration
            assert off.norm() < 1e-14


class TestShake(MotionContract):
    motion = Shake((0.02, -0.01, 0.03), 8.0, phase=-0.25)
    rate = 20.0

    def test_it_is_the_move_by_its_formulas(self) -> None:
        move = Move(tuple(f"{a}*sin(8*t - 0.25)" for a in (0.02, -0.01, 0.03)))
        for t in (0.0, 1.3):
            assert (self.motion.at(t).acceleration - move.at(t).acceleration).norm() < 1e-14
        assert move.fastest_rate_within(0.0, 3.0) == pytest.approx(8.0, rel=1e-3)


class TestMove(MotionContract):
    motion = Move(("0.1*t**2", "0.05*sin(4*t)*exp(-t)", 0.2))

    @pytest.mark.parametrize("position", ["t", ("t", 0.0), ("t", 0.0, "2 kg"), ("t", "x", 0.0)])
    def test_a_place_has_three_components(self, position: object) -> None:
        with pytest.raises(InvalidValueError, match="position"):
            Move(position)


class TestPrecessingTilt(MotionContract):
    motion = PrecessingTilt(0.3, -2.5)

    def test_its_low_side_goes_round_and_its_material_does_not(self) -> None:
        for t in (0.0, 0.4, 7.0):
            R = self.motion.at(t).rotation
            axis = R @ Vector(0.0, 0.0, 1.0)
            assert axis.z == pytest.approx(math.cos(0.3), abs=1e-15)
            assert math.atan2(axis.y, axis.x) == pytest.approx(math.remainder(-2.5 * t, 2 * math.pi), abs=1e-12)
        whole = self.motion.at(2 * math.pi / 2.5).rotation @ Vector(1.0, 0.0, 0.0)
        assert (whole - self.motion.at(0.0).rotation @ Vector(1.0, 0.0, 0.0)).norm() < 1e-14

    def test_with_a_spin_inside_it_is_a_wobble(self) -> None:
        # The lean that goes round and the material that goes round with it: R₃(ωt) R₂(ε), a quarter turn from R₁.
        both = Combined((self.motion, Spin(-2.5)))
        wobble = Wobble(-2.5, 0.3)
        for t in (0.0, 0.9):
            quarter = math.pi / 2 / 2.5  # the wobble leans away from the second axis at t = 0
            off = both.at(t).angular_velocity - wobble.at(t - quarter).angular_velocity
            assert off.norm() < 1e-15
            axis, other = (m.rotation @ Vector(0.0, 0.0, 1.0) for m in (both.at(t), wobble.at(t - quarter)))
            assert (axis - other).norm() < 1e-15


class TestEverythingAtOnce(MotionContract):
    motion = Combined(
        (Shake((0.1, -0.2, 0.05), 3.0), Rock(0.3, 2.0, axis=(1.0, 0.5, 0.0)), Wobble(2.5, 0.2), Move(("0.1*t", 0, 0)))
    )


class TestAnUnevenWobble(MotionContract):
    motion = Combined((SpinBy("2.5 + 0.3*cos(4*t)"), Tilt(0.2, axis=(1.0, 0.0, 0.0))))

    def support_coordinates_at(self, t: Any) -> tuple[Any, ...]:
        return (2.5 * t + 0.3 / 4 * mpmath.sin(4 * t),)


class TestTwoGivenSpins(MotionContract):
    motion = Combined((SpinBy("t"), Rock(0.3, 2.0), SpinBy("1 - t")))

    def support_coordinates_at(self, t: Any) -> tuple[Any, ...]:
        return (t * t / 2, t - t * t / 2)

    def test_their_coordinates_have_names_of_their_own(self) -> None:
        assert self.motion.coordinates == ("angle", "angle_2")


class TestSpinsThatAdd(MotionContract):
    motion = Combined((Fixed(), Spin(2.0), Spin(-0.5)))

    def test_they_are_one(self) -> None:
        assert self.motion.steady_rate == self.motion.mean_rate == 1.5


class TestAShakenFreeTable(MotionContract):
    motion = Combined((Shake((0.02, -0.01, 0.03), 4.0), FreeAxle(0.02, rate=1.5, bearing_drag=0.01)))

    def support_coordinates_at(self, t: Any) -> tuple[Any, ...]:
        return (1.5 * t, mpmath.mpf(1.5))

    def test_it_is_as_free_as_its_last_part(self) -> None:
        assert self.motion.free
        assert self.motion.inertia == 0.02
        assert self.motion.axle_torque(0.0, (0.0, 2.0)) == -0.02
        assert self.motion.coordinate_rates(0.0, (0.0, 2.0), 0.06) == (2.0, pytest.approx(2.0))

    @pytest.mark.parametrize(
        ("parts", "named"),
        [((FreeAxle(1.0), Spin(1.0)), r"parts\[0\].*last"), ((Rock(0.1, 1.0), FreeAxle(1.0)), r"parts\[0\].*turn"),
         ((Fixed(), Combined((Shake((0, 0, 1), 1.0), Spin(1.0))), FreeAxle(1.0)), r"parts\[2\].*turn"),
         ((), "at least one"), ((Spin(1.0), 3.0), r"parts\[1\]"), (3.0, r"parts\[0\]")],
    )  # fmt: skip
    def test_what_cannot_be_is_refused_by_name(self, parts: object, named: str) -> None:
        with pytest.raises(InvalidValueError, match=named):
            Combined(parts)


@pytest.mark.parametrize(
    "motion",
    [SpinBy("2*t + sin(3*t)"), FreeAxle(1.0, motor_torque="2*t"), Rock(0.1, 2.0), Move(("2*t", 0.5, 0.0)),
     Combined((Shake((0.1, 0.2, 0.3), 2.0), SpinBy("4*t"))), PrecessingTilt(0.1, 2.0), Tilt("0.5*t")],
    ids=lambda motion: type(motion).__name__,
)  # fmt: skip
def test_its_numbers_are_parameters(motion: Motion) -> None:
    from trundle.mechanics.parameters import numbers, with_numbers

    values = numbers(motion)
    assert numbers(with_numbers(motion, [2 * value for value in values])) == [2 * value for value in values]


def test_a_formula_that_is_read_already_is_kept() -> None:
    rate = Expression.parse("2*t", ("t",), "rate")
    assert SpinBy(rate).rate is rate


class TestTumble(MotionContract):
    motion = Tumble(1.5, 0.25, -0.75, Vector(0.5, -0.25, 0.125), 2.0)
