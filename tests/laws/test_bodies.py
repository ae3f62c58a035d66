"""Mass, centre of mass and inertia of bodies: against integrals and closed forms that the package does not use."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.precise import precisely
from tests.tolerances import EXACT

import trundle as tr
from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import Matrix, Quaternion, Vector
from trundle.mechanics.bodies import homogeneous, inertia_of
from trundle.mechanics.contact import roll

DENSITY = 1200.0
IDENTITY = Matrix.identity()


def tensor(body: tr.Body) -> np.ndarray:
    return np.array([list(row) for row in body.inertia_in_space(IDENTITY).rows], dtype=float)


def of_revolution(radius: Callable[[Any], Any], low: Any, high: Any) -> tuple[Any, Any, Any, Any]:
    """Volume, height of the centre of mass, and J/ρ across and about the axis, of discs stacked along it."""
    pi = mpmath.pi
    volume = mpmath.quad(lambda z: pi * radius(z) ** 2, [low, high])
    centre = mpmath.quad(lambda z: pi * radius(z) ** 2 * z, [low, high]) / volume
    about = mpmath.quad(lambda z: pi * radius(z) ** 4 / 2, [low, high])
    across = mpmath.quad(lambda z: pi * radius(z) ** 4 / 4 + pi * radius(z) ** 2 * (z - centre) ** 2, [low, high])
    return volume, centre, across, about


def holds(body: tr.Body, volume: Any, across: Any, about: Any, ulps: float = 16) -> None:
    assert float(body.mass) == pytest.approx(float(DENSITY * volume), rel=EXACT(ulps, 1))
    wanted = np.diag([float(across), float(across), float(about)]) * DENSITY
    assert np.abs(tensor(body) - wanted).max() <= EXACT(ulps, wanted.max())


def test_a_hemisphere_is_stacked_discs() -> None:
    a = 0.08
    volume, centre, across, about = of_revolution(lambda z: mpmath.sqrt(a * a - z * z), -mpmath.mpf(a), 0)
    body = tr.Body.hemisphere(a, density=DENSITY)
    holds(body, volume, across, about)
    assert float(body.shape.centre.z) == pytest.approx(float(-centre), rel=1e-15)  # the flat face looks along +z


def test_a_coin_is_stacked_discs() -> None:
    a, d = 0.04, 0.006
    volume, _, across, about = of_revolution(lambda _: mpmath.mpf(a), -mpmath.mpf(d) / 2, mpmath.mpf(d) / 2)
    holds(tr.Body.disc(a, density=DENSITY, thickness=d), volume, across, about)


def test_a_torus_is_stacked_washers() -> None:
    a, e = 0.3, 0.12

    def washer(power: int) -> Callable[[Any], Any]:
        return lambda z: (a + mpmath.sqrt(e * e - z * z)) ** power - (a - mpmath.sqrt(e * e - z * z)) ** power

    pi, ends = mpmath.pi, [-mpmath.mpf(e), mpmath.mpf(e)]
    volume = mpmath.quad(lambda z: pi * washer(2)(z), ends)
    about = mpmath.quad(lambda z: pi * washer(4)(z) / 2, ends)
    across = mpmath.quad(lambda z: pi * washer(4)(z) / 4 + pi * washer(2)(z) * z * z, ends)
    holds(tr.Body.torus(a, e, density=DENSITY), volume, across, about)


def test_a_half_cylinder_is_half_discs() -> None:
    a, length = 0.1, 0.25
    # Strips of height 2√(a² − x²) at the distance x below the flat face.
    strip, ends = (lambda x: 2 * mpmath.sqrt(a * a - x * x)), [0, mpmath.mpf(a)]
    area = mpmath.quad(strip, ends)
    centre = mpmath.quad(lambda x: strip(x) * x, ends) / area
    second = mpmath.quad(lambda x: strip(x) * (x - centre) ** 2 + strip(x) ** 3 / 12, ends)
    body = tr.Body.half_cylinder(a, density=DENSITY, length=length)
    assert float(body.mass) == pytest.approx(float(DENSITY * area * length), rel=EXACT(16, 1))
    assert float(body.shape.centre.x) == pytest.approx(float(centre), rel=EXACT(16, 1))
    assert float(body.inertia.moment) == pytest.approx(float(DENSITY * length * second), rel=EXACT(16, 1))


def test_a_ring_is_a_torus_of_no_thickness() -> None:
    assert np.allclose(tensor(tr.Body.ring(0.3, 2.0)), tensor(tr.Body.torus(0.3, 1e-9, mass=2.0)), rtol=1e-15)


def test_an_ellipsoid_is_a_stretched_ball() -> None:
    # ∫x² over the unit ball is 4π/15 (Landau & Lifshitz, Mechanics, section 32, problem 2e).
    a, b, c = 0.2, 0.03, 0.02
    m = DENSITY * 4 / 3 * math.pi * a * b * c
    body = tr.Body.ellipsoid((a, b, c), density=DENSITY)
    seconds = np.array([a * a, b * b, c * c]) * DENSITY * a * b * c * 4 * math.pi / 15
    assert body.mass == pytest.approx(m, rel=EXACT(4, 1))
    assert np.diag(tensor(body)) == pytest.approx(seconds.sum() - seconds, rel=EXACT(8, 1))


# --- by integrals over the support function ---------------------------------------------------------------


@pytest.mark.parametrize("axes", [(0.2, 0.03, 0.02), (1.0, 1.0, 1.0), (1e-3, 5e-2, 2.0)], ids=str)
def test_the_integrals_of_an_ellipsoid_are_its_closed_forms(axes: tuple[float, float, float]) -> None:
    a, b, c = axes
    formula = f"sqrt({a * a!r}*nu_x**2 + {b * b!r}*nu_y**2 + {c * c!r}*nu_z**2) + 0.01*nu_x - 0.02*nu_z"
    found = tr.Body.shape_formula(formula, density=DENSITY)
    exact = tr.Body.ellipsoid(axes, density=DENSITY)
    assert found.mass == pytest.approx(exact.mass, rel=1e-13)
    assert np.abs(tensor(found) - tensor(exact)).max() <= 1e-13 * tensor(exact).max()
    centre = found.shape.centre  # the origin of the formula, seen from the middle of the ellipsoid
    assert [centre.x, centre.y, centre.z] == pytest.approx([-0.01, 0.0, 0.02], abs=1e-13 * max(axes))


def test_the_integrals_of_an_ellipsoid_that_is_turned() -> None:
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    A = turn @ np.diag([0.04, 0.01, 0.0025]) @ turn.T
    terms = [f"{float(A[i, j])!r}*nu_{'xyz'[i]}*nu_{'xyz'[j]}" for i in range(3) for j in range(3)]
    body = tr.Body.shape_formula(f"sqrt({' + '.join(terms)})", mass=2.0)
    # The tensor of second moments of a homogeneous ellipsoid is m A/5.
    wanted = 2.0 / 5 * (np.trace(A) * np.eye(3) - A)
    assert np.abs(tensor(body) - wanted).max() <= 1e-13 * wanted.max()
    assert isinstance(body.inertia, tr.Tensor)


@precisely
def test_the_integrals_of_an_egg_are_those_of_stacked_discs() -> None:
    p, q, s = mpmath.mpf(0.025), mpmath.mpf(0.003), mpmath.mpf(0.004)

    def h(t: Any) -> Any:
        return p + q * mpmath.cos(t) + s * mpmath.cos(t) ** 3

    def slope(t: Any) -> Any:
        return -mpmath.sin(t) * (q + 3 * s * mpmath.cos(t) ** 2)

    def meridian(t: Any) -> tuple[Any, Any]:  # X = hν + h′ν′ of a plane curve, from its support function
        return h(t) * mpmath.sin(t) + slope(t) * mpmath.cos(t), h(t) * mpmath.cos(t) - slope(t) * mpmath.sin(t)

    def stacked(of: Callable[[Any, Any], Any]) -> Any:
        def disc(t: Any) -> Any:
            r, z = meridian(t)
            bend = h(t) + mpmath.diff(slope, t)
            return of(r, z) * bend * mpmath.sin(t)  # dz = −(h + h″) sin t dt

        return mpmath.quad(disc, [0, mpmath.pi / 2, mpmath.pi])

    pi = mpmath.pi
    volume = stacked(lambda r, _: pi * r**2)
    centre = stacked(lambda r, z: pi * r**2 * z) / volume
    about = stacked(lambda r, _: pi * r**4 / 2)
    across = stacked(lambda r, z: pi * r**4 / 4 + pi * r**2 * (z - centre) ** 2)
    body = tr.Body.shape_formula("0.025 + 0.003*nu_z + 0.004*nu_z**3", density=DENSITY)
    holds(body, volume, across, about, ulps=64)
    assert float(body.shape.centre.z) == pytest.approx(float(-centre), rel=1e-13)
    assert body.axisymmetric


def test_a_body_with_flat_faces_is_not_integrated() -> None:
    with pytest.raises(InvalidValueError, match="smooth enough to integrate over"):
        homogeneous(tr.Disc(0.3))


def test_what_does_not_settle_is_refused() -> None:
    with pytest.raises(InvalidValueError, match="smooth enough to integrate over"):
        tr.Body.shape_formula("1 + 1e-5*sin(300*nu_x)*sin(300*nu_z)", mass=1.0)


# --- mass, or density ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: tr.Body.hemisphere(0.1), "`mass` must be given, or `density`"),
        (lambda: tr.Body.hemisphere(0.1, mass=1, density=1), "`density` must not stand beside `mass`"),
        (lambda: tr.Body.disc(0.1, density=1), "`density` needs `thickness`"),
        (lambda: tr.Body.half_cylinder(0.1, density=1), "`density` needs `length`"),
        (lambda: tr.Body.torus(0.1, 0.2, mass=1), "`rim_radius` must be at most `radius`"),
        (lambda: tr.Body.eccentric_sphere(0.1, 1, (1, 1, 1), centre=(0.1, 0, 0)), "`centre` must lie less than"),
        (lambda: tr.Body.eccentric_cylinder(0.1, 1, 1, centre=(0.1, 0, 0)), "`centre` must lie less than"),
        (lambda: tr.Body.eccentric_cylinder(0.1, 1, 1, centre=(0, 0, 0.1)), "`centre` must lie across"),
        (lambda: tr.Body.ellipsoid((1, 2, 3), mass=1, moments=(1, 2, 4)), "`moments` must obey the triangle rule"),
        (lambda: tr.Body.ellipsoid((1, 2, 3), mass=1, moments=(1, -2, 4)), r"`moments\[1\]` must be positive"),
        (lambda: tr.Body.ellipsoid((1, 0, 3), mass=1), r"`semi_axes\[1\]` must be positive"),
        (lambda: tr.Body.shape_formula("0.1", mass=1, centre=(0, 0, 0)), "`centre` must stand beside `moments`"),
        (lambda: tr.Body(1.0, tr.RatioInertia(0.4), tr.Disc(0.1)), "only for a sphere or cylinder"),
        (lambda: tr.Tensor(1.0, 1.0, 1.0, xy=1.0), "positive principal moments"),
        (lambda: tr.Tensor(1.0, 1.2, 0.5, xy=0.6), "triangle rule"),
    ],
)
def test_what_makes_no_body_is_refused(build: Callable[[], Any], message: str) -> None:
    with pytest.raises(InvalidValueError, match=message):
        build()


def test_a_flat_body_is_at_the_edge_of_the_triangle_rule() -> None:
    assert tr.Body.disc(0.1, mass=3.7).inertia.z == 2 * tr.Body.disc(0.1, mass=3.7).inertia.x
    turned = inertia_of((1.0, 2.0, 3.0), turn=0.7)  # still that of a flat body, its eigenvalues rounded
    assert np.linalg.eigvalsh([list(row) for row in turned.matrix.rows]) == pytest.approx([1, 2, 3], rel=1e-15)


# --- inertia turned against the shape -----------------------------------------------------------------------


def test_a_turned_inertia_is_the_tensor_rotated() -> None:
    given = np.array([[2.0, 0.1, -0.2], [0.1, 2.5, 0.3], [-0.2, 0.3, 3.0]])
    angle = 0.4
    R = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
    found = inertia_of(np.diag(given), (0.1, -0.2, 0.3), turn=angle)
    assert np.allclose([list(row) for row in found.matrix.rows], R @ given @ R.T, rtol=0, atol=EXACT(4, 3.0))


@pytest.mark.parametrize("moments", [(2e-4, 1.6e-3, 1.7e-3), (1.6e-3, 2e-4, 1.7e-3)])
@pytest.mark.parametrize("angle", [0.0, 1e-6, 0.3, -0.7])
def test_the_turn_can_be_read_off(moments: tuple[float, float, float], angle: float) -> None:
    found = tr.Tensor(*_elements(inertia_of(moments, turn=angle)))
    assert found.principal_turn == pytest.approx(angle, abs=1e-12)


def _elements(inertia: Any) -> tuple[float, ...]:
    return inertia.elements if isinstance(inertia, tr.Tensor) else (inertia.x, inertia.y, inertia.z)


def test_turning_the_inertia_is_turning_a_ball_that_has_it() -> None:
    # A ball looks the same however it is turned, so only its inertia knows.
    angle, moments = 0.7, (0.003, 0.004, 0.005)
    table = tr.Support(tr.Plane(), motion=tr.Spin(2.0), tilt=0.1)
    turned = tr.Body(0.75, inertia_of(moments, turn=angle), tr.Sphere(0.1))
    q = Quaternion(0.5, -0.1, 0.7, math.sqrt(1 - 0.75))
    about = Quaternion(math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2))
    p, Omega = Vector(0.3, -0.2, 0.0), Vector(1.0, -2.0, 3.0)
    one = roll(tr.RollingSystem(turned, table), 0.0, p, q, Omega)
    other = roll(
        tr.RollingSystem(tr.Body(0.75, tr.Principal(*moments), tr.Sphere(0.1)), table), 0.0, p, q * about, Omega
    )
    for a, b in ((one.angular_acceleration, other.angular_acceleration), (one.reaction, other.reaction)):
        assert np.allclose(a.array(), b.array(), rtol=0, atol=EXACT(256, a.norm()))


def test_a_formula_rolls_as_the_shape_it_describes() -> None:
    egg = tr.Body.ellipsoid((0.15, 0.125, 0.1), mass=0.75, turn=0.2)
    same = tr.Body(0.75, egg.inertia, tr.SupportFunction("sqrt(0.0225*nu_x**2 + 0.015625*nu_y**2 + 0.01*nu_z**2)"))
    bowl = tr.Support(tr.Cylinder(0.9), tilt="90 deg", motion=tr.Spin(1.0))
    q, p, Omega = Quaternion(0.5, 0.5, -0.5, 0.5), Vector(0.9, 0.0, 0.1), Vector(0.2, -1.0, 3.0)
    one, other = (roll(tr.RollingSystem(body, bowl), 0.0, p, q, Omega) for body in (egg, same))
    for a, b in ((one.angular_acceleration, other.angular_acceleration), (one.point_rate, other.point_rate)):
        assert np.allclose(a.array(), b.array(), rtol=0, atol=1e-12 * a.norm())


@pytest.mark.parametrize(
    ("body", "symmetric"),
    [
        (tr.Body.solid_sphere(1.0, 1.0), True),
        (tr.Body.eccentric_sphere(0.1, 1, (1e-3, 1e-3, 9e-4), (0, 0, 0.01)), True),
        (tr.Body.eccentric_sphere(0.1, 1, (1e-3, 1e-3, 9e-4), (0, 0.01, 0)), False),
        (tr.Body.eccentric_sphere(0.1, 1, (1e-3, 1.1e-3, 9e-4)), False),
        (tr.Body.eccentric_sphere(0.1, 1, (1e-3, 1e-3, 1e-3), products=(1e-5, 0, 0)), False),
        (tr.Body.disc(0.1, mass=1), True),
        (tr.Body.torus(0.1, 0.01, mass=1), True),
        (tr.Body.hemisphere(0.1, mass=1), True),
        (tr.Body.half_cylinder(0.1, mass=1), False),
        (tr.Body.ellipsoid((0.2, 0.2, 0.1), mass=1), True),
        (tr.Body.ellipsoid((0.2, 0.2, 0.1), mass=1, moments=(1e-2, 1.1e-2, 1.2e-2)), False),
        (tr.Body.ellipsoid((0.2, 0.1, 0.1), mass=1), False),
    ],
)
def test_what_is_symmetric_about_the_third_axis_says_so(body: tr.Body, symmetric: bool) -> None:
    assert body.axisymmetric is symmetric


def test_only_a_round_body_with_a_round_inertia_is_an_isotropic_sphere() -> None:
    assert tr.Body(1.0, tr.Isotropic(0.1), tr.Sphere(1.0)).is_isotropic_sphere
    for inertia in (tr.Principal(0.1, 0.1, 0.12), tr.Tensor(0.1, 0.1, 0.12)):
        body = tr.Body(1.0, inertia, tr.Sphere(1.0))
        assert not body.is_isotropic_sphere
        with pytest.raises(InvalidValueError, match="isotropic inertia"):
            body.inertia_ratio  # noqa: B018
    assert not tr.Body.hemisphere(0.1, mass=1).is_isotropic_sphere
