"""Loads: what they do, and whether what they say of themselves is so."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from tests.contracts.contract_load import LoadContract

from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.loads import BodyMotion, Drag, Force, Gravity, Torque


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
    load = Drag(0.5, air_rate=-3.0)

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


def test_a_load_pushes_in_the_inertial_frame() -> None:
    assert Force((1.0, 2.0, 3.0)).value == Vector(1.0, 2.0, 3.0)
