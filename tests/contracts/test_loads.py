"""Loads: what they do, and whether what they say of themselves is so."""

from __future__ import annotations

import pytest
from tests.contracts.contract_load import LoadContract

from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import Vector
from trundle.mechanics.loads import Drag, Force, Gravity, Torque


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


class TestForceAlongTheAxis(LoadContract):
    load = Force((0.0, 0.0, 2.0))


class TestTorque(LoadContract):
    load = Torque((0.5, -0.25, 0.125))


class TestTorqueAboutTheAxis(LoadContract):
    load = Torque((0.0, 0.0, 2.0))


class TestDrag(LoadContract):
    load = Drag(0.5)

    def test_it_says_its_coefficient(self) -> None:
        assert Drag("5 g/s").linear_drag == 0.005

    def test_it_cannot_push(self) -> None:
        with pytest.raises(InvalidValueError, match="coefficient"):
            Drag(-0.5)


def test_a_load_pushes_in_the_inertial_frame() -> None:
    assert Force((1.0, 2.0, 3.0)).value == Vector(1.0, 2.0, 3.0)
