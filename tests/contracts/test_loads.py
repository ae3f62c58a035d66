"""Loads: what they do, and whether what they say of themselves is so."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from tests.contracts.contract_load import LoadContract

from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import E_Z, ZERO, Quaternion, Vector
from trundle.mechanics.loads import (
    BodyMotion,
    Drag,
    Force,
    Gravity,
    Magnus,
    Motor,
    PivotFriction,
    Potential,
    QuadraticDrag,
    RollingCouple,
    RollingResistance,
    Torque,
    at_rest,
)


class TestGravity(LoadContract):
    load = Gravity(0.0, 0.0, -9.80665)


class TestGravityOnASlope(LoadContract):
    load = Gravity(1.5, 0.0, -9.5)


class TestForce(LoadContract):
    load = Force((0.5, -0.25, 0.125))

    @pytest.mark.parametrize("value", [(0.1, 0.2), 0.1, ("1 m", 0, 0), (0, 0, float("nan")), "0.1 N"])
    def test_a_force_has_three_components(self, value: object) -> None:
        with pytest.raises(InvalidValueError, match="value"):
            Force(value)


class TestForceThatVaries(LoadContract):
    load = Force(("2*sin(3*t)", 0.5, "t**2 - 1"))

    @pytest.mark.parametrize(
        "formula",
        ["sinh(t)", "t.real", "t if t else 0", "[t]", "x*t", "t**0.5", "t**99", "9**9**9*t", "sin(t, 2)", "t*1e999",
         "__import__('os').system('true') or t", "lambda: t", "t @ t", "sin(t=1)", "t and 1", "sin(*[t])",
         "-" * 90 + "t"],
    )  # fmt: skip
    def test_a_formula_is_of_a_short_list(self, formula: str) -> None:
        with pytest.raises(InvalidValueError, match=r"value\[1\]"):
            Force((0.0, formula, 0.0))

    def test_every_function_of_the_list_is_the_one_of_its_name(self) -> None:
        t = 0.7
        for text, wanted in {
            "sin(t)": math.sin(t), "cos(t)": math.cos(t), "tan(t)": math.tan(t), "sqrt(t)": math.sqrt(t),
            "exp(-t)": math.exp(-t), "log(t)": math.log(t), "abs(-t)": t, "hypot(t, 2)": math.hypot(t, 2.0),
            "+t - pi": t - math.pi, "2*t/3": 2 * t / 3, "-t**-2": -(t**-2), "(1 - t)**3": (1 - t) ** 3,
        }.items():  # fmt: skip
            assert Force((text, 0.0, 0.0)).at(t).x == pytest.approx(wanted, rel=4e-16), text

    def test_every_kind_of_scalar_goes_through_a_formula(self) -> None:
        import heyoka
        import sympy

        load = Force(("abs(t - 2)*hypot(t, 3) + log(1 + t**2)*tan(t/9) - sqrt(exp(t))*cos(pi*t)", 0.0, 0.0))
        times = np.linspace(0.1, 3.0, 5)
        one = [load.at(float(t)).x for t in times]
        variable, symbol = heyoka.make_vars("t"), sympy.Symbol("t", real=True)
        compiled = heyoka.cfunc([load.at(variable).x], [variable])
        assert np.allclose(load.at(times).x, one, rtol=1e-14)
        assert np.allclose(compiled(times[None, :])[0], one, rtol=1e-14)
        assert [float(load.at(symbol).x.subs(symbol, t)) for t in times] == pytest.approx(one, rel=1e-13)
        assert [float(load.at(mpmath.mpf(t)).x) for t in times] == pytest.approx(one, rel=1e-13)


class TestTorqueThatVariesAboutTheAxis(LoadContract):
    load = Torque((0.0, 0.0, "cos(t)"))


class TestForceAlongTheAxis(LoadContract):
    load = Force((0.0, 0.0, 2.0))


class TestTorque(LoadContract):
    load = Torque((0.5, -0.25, 0.125))


class TestTorqueAboutTheAxis(LoadContract):
    load = Torque((0.0, 0.0, 2.0))


class TestDragByAirThatTurns(LoadContract):
    load = Drag(0.5, air=-3.0)

    def test_air_that_moves_along_does_not_drag(self) -> None:
        r = Vector(0.3, -0.2, 0.1)
        carried = BodyMotion(0.0, 1.0, r, Vector(0.0, 0.0, -3.0).cross(r), Quaternion(1.0, 0.0, 0.0, 0.0), r)
        assert self.load.force(carried).norm() == 0.0
        assert self.load.linear_drag is None


class TestDrag(LoadContract):
    load = Drag(0.5)

    def test_it_says_its_coefficient(self) -> None:
        assert Drag("5 g/s").linear_drag == 0.005

    def test_it_cannot_push(self) -> None:
        with pytest.raises(InvalidValueError, match="coefficient"):
            Drag(-0.5)


class TestQuadraticDrag(LoadContract):
    load = QuadraticDrag(0.5)

    def test_it_is_the_square_to_a_millionth_of_a_metre_a_second(self) -> None:
        # |F| = c v √(v² + v₀²) lies above c v² by less than c v₀²/2
        for v in (0.0, 1e-8, 1e-6, 1e-3, 1.0, 50.0):
            force = self.load.force(moving(Vector(v, 0.0, 0.0)))
            assert 0 <= -force.x - 0.5 * v * v <= 0.5 * 1e-12 / 2 + 4e-16 * 0.5 * v * v

    def test_it_cannot_push(self) -> None:
        with pytest.raises(InvalidValueError, match="coefficient"):
            QuadraticDrag(-0.5)
        assert QuadraticDrag("2 g/m").coefficient == 0.002
        with pytest.raises(InvalidValueError, match="coefficient"):
            QuadraticDrag("2 g/s")


class TestQuadraticDragByAirThatTurns(LoadContract):
    load = QuadraticDrag(0.5, air=-3.0)


class TestMagnus(LoadContract):
    load = Magnus(0.5)

    def test_topspin_pushes_down_and_does_no_work(self) -> None:
        topspin = moving(Vector(2.0, 0.0, 0.0), Vector(0.0, 3.0, 0.0))  # rolls along +x
        assert self.load.force(topspin) == Vector(0.0, 0.0, -3.0)
        motion = moving(Vector(0.5, -1.0, 2.0), Vector(3.0, 1.0, -0.5))
        assert self.load.force(motion).dot(motion.velocity) == pytest.approx(0.0, abs=1e-15)


class TestRollingResistance(LoadContract):
    load = RollingResistance(0.5)

    def test_it_is_as_large_for_slow_rolling_as_for_fast_and_blind_to_spin(self) -> None:
        for speed in (1e-12, 1.0, 1e6):
            couple = self.load.torque_per_normal_force(moving(ZERO, Vector(0.6 * speed, -0.8 * speed, 7.0)))
            assert couple.x == pytest.approx(-0.3, rel=1e-15)
            assert couple.y == pytest.approx(0.4, rel=1e-15)
            assert couple.z == 0.0

    def test_it_is_nothing_where_nothing_turns_over(self) -> None:
        for spin in (0.0, 3.0):
            still = moving(ZERO, Vector(0.0, 0.0, spin))
            assert list(self.load.torque_per_normal_force(still)) == [0.0, 0.0, 0.0]
        together = replace(moving(ZERO, Vector(1.0, 2.0, 3.0)), support_angular_velocity=Vector(1.0, 2.0, 3.0))
        assert list(self.load.torque_per_normal_force(together)) == [0.0, 0.0, 0.0]

    def test_it_is_a_length(self) -> None:
        assert RollingResistance("0.2 mm").offset == 0.0002
        for offset in (-1e-3, "0.01 N", "1 mm/s"):
            with pytest.raises(InvalidValueError, match="offset"):
                RollingResistance(offset)


class TestPivotFriction(LoadContract):
    load = PivotFriction(0.5, below=0.25)

    def test_above_its_rate_it_is_dry(self) -> None:
        for spin in (25.0, -25.0):
            couple = self.load.torque_per_normal_force(moving(ZERO, Vector(3.0, 1.0, spin)))
            assert couple.z == pytest.approx(-math.copysign(0.5, spin), rel=1e-4)
            assert couple.x == couple.y == 0.0


class TestRollingCouple(LoadContract):
    load = RollingCouple(0.5)


class TestRollingCoupleThatPivotsEasily(LoadContract):
    load = RollingCouple(0.5, pivot_coefficient=0.125)

    def test_its_parts_are_apart(self) -> None:
        assert self.load.torque(moving(ZERO, Vector(2.0, -4.0, 8.0))) == Vector(-1.0, 2.0, -1.0)


class TestMotor(LoadContract):
    load = Motor((0.5, "sin(3*t)", -0.25))

    def test_it_turns_with_the_body(self) -> None:
        half = math.sqrt(0.5)
        quarter = replace(at_rest(1.0), orientation=Quaternion(half, 0.0, 0.0, half))  # first axis along the second
        torque = Motor((2.0, 0.0, 0.0)).torque(quarter)
        assert (torque - Vector(0.0, 2.0, 0.0)).norm() < 1e-15


class TestATrap(LoadContract):
    load = Potential("1.5*(x**2 + y**2) + 0.2*z**3")

    def test_gravity_is_one_of_its_kind(self) -> None:
        weight = Potential("0.75*9.8*z")
        wanted = Gravity(0.0, 0.0, -9.8).force(at_rest(0.75))
        assert (weight.force(at_rest(0.75)) - wanted).norm() < 1e-15

    @pytest.mark.parametrize("formula", ["x*w", "x.real", "", "x**0.5", ["x"], None, "9**9**9*x", True])
    def test_a_formula_is_of_a_short_list(self, formula: object) -> None:
        with pytest.raises(InvalidValueError, match="formula"):
            Potential(formula)


class TestATrapThatIsLonger(LoadContract):
    load = Potential("1.5*x**2 + 1.25*y**2")


class TestARoundWell(LoadContract):
    load = Potential("-2*exp(-hypot(x, y)**2/0.5)*cos(z) + sqrt(1 + x*x + y*y)")


class TestAFlatPotential(LoadContract):
    load = Potential("0.5*sin(2*z)")


class TestAPotentialThatSwells(LoadContract):
    load = Potential("0.5*(x**2 + y**2)*(1 + 0.5*sin(t))")

    def test_with_time_in_it_no_energy_is_kept(self) -> None:
        assert self.load.potential(at_rest(1.0)) is None


@pytest.mark.parametrize(
    ("formula", "symmetric"),
    [("x**2 + y**2", True), ("exp(-(x**2 + y**2)/1e-6)", True), ("exp(-(x**2 + 2*y**2)/1e-6)", False),
     ("1/hypot(x, y)", True), ("log(x**2 + y**2) + z", True), ("log(x)", False), ("x*y", False), ("3*z", True),
     ("x**2 + y**2 + 1e-9*x", False), ("7", True)],
)  # fmt: skip
def test_a_potential_knows_whether_it_is_round(formula: str, symmetric: bool) -> None:
    assert Potential(formula).symmetric == symmetric


def moving(velocity: Vector, angular_velocity: Vector = ZERO) -> BodyMotion:
    """Return a body that moves over a level plane."""
    return replace(at_rest(1.0), velocity=velocity, angular_velocity=angular_velocity, normal=E_Z)


def test_a_load_pushes_in_the_inertial_frame() -> None:
    assert Force((1.0, 2.0, 3.0)).value == Vector(1.0, 2.0, 3.0)
