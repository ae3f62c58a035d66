"""Shapes of bodies: each is held to the contract, and says where it ends."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.contracts.contract_shape import ShapeContract
from tests.precise import across, directions, precisely, slope, unit
from tests.tolerances import EXACT

import trundle as tr
from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.parameters import numbers, with_numbers
from trundle.mechanics.shapes import (
    CylinderShape,
    Disc,
    Ellipsoid,
    HalfCylinder,
    Hemisphere,
    Shape,
    Sphere,
    SupportFunction,
    Torus,
)

AWAY = Vector(0.05, -0.02, 0.1)
ACROSS = Vector(0.05, -0.02, 0.0)


def ellipsoid(x: Vector, a: float, b: float, c: float) -> Any:
    return (x.x / a) ** 2 + (x.y / b) ** 2 + (x.z / c) ** 2 - 1


class TestSphere(ShapeContract):
    shape = Sphere(0.3)

    def level(self, x: Vector) -> Any:
        return x.norm() - 0.3


class TestSphereOffCentre(ShapeContract):
    shape = Sphere(0.3, centre=AWAY)

    def level(self, x: Vector) -> Any:
        return (x - AWAY).norm() - 0.3


class TestHemisphere(TestSphereOffCentre):
    shape = Hemisphere(0.3, centre=AWAY)


class TestRoller(ShapeContract):
    shape = CylinderShape(0.3, centre=ACROSS)

    def level(self, x: Vector) -> Any:
        return (x - ACROSS).norm() - 0.3


class TestHalfCylinder(TestRoller):
    shape = HalfCylinder(0.3, centre=ACROSS)


class TestEllipsoid(ShapeContract):
    shape = Ellipsoid(0.5, 0.3, 0.2)

    def level(self, x: Vector) -> Any:
        return ellipsoid(x, 0.5, 0.3, 0.2)


class TestLongEllipsoidOffCentre(ShapeContract):
    shape = Ellipsoid(0.5, 0.03, 0.02, centre=AWAY)

    def level(self, x: Vector) -> Any:
        return ellipsoid(x - AWAY, 0.5, 0.03, 0.02)


class TestThinDisc(ShapeContract):
    shape = Disc(0.4)
    edged = True

    def level(self, x: Vector) -> Any:
        return abs(Vector(x.x, x.y, 0).norm() - 0.4) + abs(x.z)


class TestDiscOffCentre(ShapeContract):
    shape = Disc(0.4, centre=AWAY)
    edged = True

    def level(self, x: Vector) -> Any:
        y = x - AWAY
        return abs(Vector(y.x, y.y, 0).norm() - 0.4) + abs(y.z)


class TestTorus(ShapeContract):
    shape = Torus(0.4, 0.1)

    def level(self, x: Vector) -> Any:
        return Vector(Vector(x.x, x.y, 0).norm() - 0.4, 0, x.z).norm() - 0.1


class TestFormulaOfAnEllipsoid(ShapeContract):
    # In powers of two, so that the numbers in the formula are the squares of the semi-axes to the last digit.
    shape = SupportFunction("sqrt(nu_x**2/4 + 0.0625*nu_y**2 + 0.015625*nu_z**2) + 0.125*nu_y", centre=AWAY)

    def level(self, x: Vector) -> Any:
        return ellipsoid(x - AWAY - Vector(0, 0.125, 0), 0.5, 0.25, 0.125)


class TestFormulaOfASphere(ShapeContract):
    shape = SupportFunction("0.25")

    def level(self, x: Vector) -> Any:
        return x.norm() - 0.25


EGGS = ("0.03 + 0.004*nu_z**3", "0.05 + 0.01*nu_x*nu_y*nu_z - 0.003*exp(nu_y)", "0.1 + 0.01*abs(nu_z)**3")


@pytest.mark.parametrize("text", EGGS)
@precisely
def test_a_formula_is_its_own_reach_along_the_normal(text: str) -> None:
    # X·ν = h, and along the surface X·t is the slope of h: both straight from the formula, without the continuation.
    shape = SupportFunction(text)
    for nu in directions(text, 10):

        def h(v: Vector) -> Any:
            return shape.formula.at(nu_x=v.x, nu_y=v.y, nu_z=v.z)

        X = shape.support_map(nu)
        assert abs(X.dot(nu) - h(nu)) <= EXACT(4, 0.1)
        for t in across(nu):
            turned = slope(lambda s, nu=nu, t=t, h=h: h(unit(nu + t * s)))
            assert abs(X.dot(t) - turned) <= EXACT(4, 0.1)


@pytest.mark.parametrize(
    ("text", "rule", "where"),
    [
        ("0.1 + 0.2*nu_x**2*nu_y**2", "convex", r"nu = \(-?0\.7071, -?0\.7071, 0\)"),
        ("-0.1", "convex", "nu = "),
        ("0.1*sin(nu_x)", "convex", "nu = "),
        ("0.1 + 0.02*nu_z**2 + 0.5*exp(400*(nu_y - 1))", "convex", r"nu = \(\S+, 1, \S+\)"),
        ("0.1*hypot(nu_x, nu_y)", "finite and smooth", r"nu = \(0, 0, -1\)"),
        ("log(nu_x)", "finite and smooth", "nu = "),
        ("0.1 + exp(500*nu_x)", "finite and smooth", "nu = "),
        ("1/0", "finite", "divides by zero"),
        ("0.1 + 0.02*abs(nu_x - 0.3)", "flat face", r"nu = \(0\.3, "),
        ("abs(nu_x) + abs(nu_y) + abs(nu_z)", "flat face", "nu = "),
        ("0.1 + hypot(nu_x - 0.3*nu_z, nu_y - 0.2*nu_z)", "flat face", r"nu = \(0\.28\d*, 0\.18\d*, 0\.94\d*\)"),
        ("0.1*nu_x", "must be that of a body", "no size"),
        ("0.1 + nu", "must be a formula in nu_x, nu_y, nu_z", "Not allowed: nu"),
        ("__import__('os')", "must be a formula", "Not allowed"),
    ],
)
def test_a_formula_that_is_no_smooth_convex_body_is_refused_with_the_direction(
    text: str, rule: str, where: str
) -> None:
    with pytest.raises(InvalidValueError, match=rule) as caught:
        SupportFunction(text)
    assert caught.value.key == "support_function"
    caught.match(where)


def test_how_far_convexity_is_told() -> None:
    # By hand: along a meridian h + h_θθ = 1 + c(3 cos²θ − 1)/2 − 3c cos 2θ, least at the pole, where it is 1 − 2c.
    assert SupportFunction("1 + 0.499*(3*nu_z**2 - 1)/2").axisymmetric
    with pytest.raises(InvalidValueError, match=r"nu = \(\S+, \S+, -?1\)"):
        SupportFunction("1 + 0.501*(3*nu_z**2 - 1)/2")


def test_the_numbers_in_a_formula_are_parameters() -> None:
    import sympy

    shape = SupportFunction("0.03 + 0.004*nu_z**2")
    assert numbers(shape) == [0.03, 0.004]
    a, b = sympy.symbols("a b", positive=True)
    bottom = with_numbers(shape, [a, b]).support_gradient(Vector(sympy.Integer(0), sympy.Integer(0), sympy.Integer(-1)))
    assert sympy.simplify(bottom.a.x - (a - b)) == 0  # by hand: h + h_θθ = a + b cos²θ − 2b cos 2θ at the pole


@pytest.mark.parametrize(
    ("shape", "symmetric"),
    [
        (Sphere(1.0), True),
        (Sphere(1.0, (0, 0, 0.1)), True),
        (Sphere(1.0, (0.1, 0, 0)), False),
        (Ellipsoid(1.0, 1.0, 0.5), True),
        (Ellipsoid(1.0, 1.1, 0.5), False),
        (Ellipsoid(1.0, 1.0, 0.5, (0, 0.1, 0)), False),
        (Disc(1.0), True),
        (Torus(1.0, 0.1, (0.0, 0.0, 0.2)), True),
        (Torus(1.0, 0.1, (0.2, 0.0, 0.0)), False),
        (SupportFunction("0.1 + 0.02*nu_z**3"), True),
        (SupportFunction("sqrt(0.1*nu_z**2 + 0.2*nu_x**2 + 0.2*nu_y**2)"), True),
        (SupportFunction("0.1 + 1e-6*nu_x"), False),
    ],
    ids=str,
)
def test_what_looks_the_same_all_round_says_so(shape: Shape, symmetric: bool) -> None:
    assert shape.axisymmetric is symmetric


def test_where_a_shape_ends() -> None:
    down, level = Vector(0.0, 0.0, -1.0), Vector(0.0, 1.0, 0.0)
    assert Sphere(1.0).validity_margin(down) is None
    half = Hemisphere(1.0)
    assert half.validity_margin(down) == 1.0
    assert half.validity_margin(level) == 0.0
    assert half.validity_margin(-down) < 0
    across_axis = HalfCylinder(1.0)
    assert across_axis.validity_margin(Vector(-1.0, 0.0, 0.0)) == 1.0
    assert across_axis.validity_margin(level) == 0.0
    for rim in (Disc(1.0), Torus(1.0, 0.1)):
        assert rim.validity_margin(level) == pytest.approx(1.0)
        assert rim.validity_margin(Vector(2e-6, 0.0, -1.0)) > 0 > rim.validity_margin(Vector(5e-7, 0.0, -1.0))


def test_a_centre_may_have_units_and_be_a_list() -> None:
    assert Sphere("5 cm", centre=["1 mm", 0, 0]).centre == Vector(0.001, 0.0, 0.0)
    with pytest.raises(InvalidValueError, match=r"`centre\[1\]` must be a length"):
        tr.Ellipsoid(1, 2, 3, centre=[0, "3 kg", 0])


def test_a_direction_along_an_axis_is_no_special_place() -> None:
    # The continuation h(λν) = λ h(ν) divides by |ν|, and nothing by a component.
    for nu in (Vector(0.0, 0.0, 1.0), Vector(-1.0, 0.0, 0.0)):
        X = SupportFunction("sqrt(0.04*nu_x**2 + 0.09*nu_y**2 + 0.25*nu_z**2)").support_map(nu)
        assert (X.x, X.y, X.z) == pytest.approx((0.2 * nu.x, 0.0, 0.5 * nu.z), abs=EXACT(4, 0.5))


def test_the_circle_that_a_torus_is_rounded_about_is_the_disc() -> None:
    nu = unit(Vector(mpmath.mpf("0.3"), mpmath.mpf("-0.4"), mpmath.mpf("0.7")))
    gap = Torus(0.4, 0.1).support_map(nu) - Disc(0.4).support_map(nu)
    assert math.isclose(float(gap.norm()), 0.1, rel_tol=1e-15)
    assert np.allclose([float(part) for part in gap], [0.1 * float(part) for part in nu], rtol=1e-14)


leaves = st.sampled_from(["nu_x", "nu_y", "nu_z", "0.1", "1", "3", "1e-12", "1e12", "0", "pi"])
formulas = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.builds("({} {} {})".format, inner, st.sampled_from("+-*/"), inner),
        st.builds("{}({})".format, st.sampled_from(["sin", "cos", "tan", "sqrt", "exp", "log", "abs"]), inner),
        st.builds("({})**{}".format, inner, st.integers(-3, 6)),
    ),
    max_leaves=6,
)


@settings(deadline=None, max_examples=60, suppress_health_check=[HealthCheck.too_slow])
@given(st.one_of(formulas, formulas.map("1 + 0.01*({})".format)))
def test_any_formula_is_a_body_or_one_error(text: str) -> None:
    try:
        body = tr.Body.shape_formula(text, density=1000.0)
    except InvalidValueError:
        return
    Q = Quaternion(0.5, -0.5, 0.1, math.sqrt(0.49)).matrix()
    rho, C = body.shape.contact(Q, Vector(0.0, 0.6, 0.8))
    assert math.isfinite(body.mass)
    assert all(math.isfinite(part) for part in (*rho, *(part for row in C.rows for part in row)))
    assert rho.dot(Vector(0.0, 0.6, 0.8)) < 0  # the centre of mass is on the body's side
