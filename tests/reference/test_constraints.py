"""Growth vectors that are published, loops driven in numbers, Frobenius's condition, integrals along a drive."""

from __future__ import annotations

import random
import subprocess
import sys
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from tests.precise import precisely, slope, turn
from tests.tolerances import SOLVER

import trundle as tr
from trundle.analysis.holonomy.analysis import ConstraintAnalysis
from trundle.mechanics.algebra import Quaternion, Vector

NAMES = tr.PfaffianSystem.names()
FOUND: dict[str, ConstraintAnalysis] = {}
TOLERANCE = 1e-13  # asked of SciPy


def found(name: str) -> ConstraintAnalysis:
    if name not in FOUND:
        FOUND[name] = tr.PfaffianSystem.load(name).analyse()
    return FOUND[name]


# --- what is published -----------------------------------------------------------------------------------

PUBLISHED = {
    "skate": (2, 3),  # [murray1994], chapter 7: the unicycle
    "coin": (2, 3, 4),  # [murray1994], example 7.4: the rolling penny
    "car": (2, 3, 4),  # [murray1994], example 7.5
    "sphere-no-pivot": (2, 3, 5),  # [brockett1993]; [montgomery2002]: Cartan's distributions
    "trailers": (2, 3, 4, 5),  # [laumond1993]
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_growth_vectors_that_are_published(name: str) -> None:
    ours = found(name)
    assert ours.growth == PUBLISHED[name]
    assert (ours.verdict, ours.integrals) == ("nonholonomic", ())


def test_a_sphere_that_may_pivot_reaches_everything_with_one_bracket() -> None:
    ours = found("sphere")
    assert (ours.rank, ours.growth, ours.verdict) == (2, (3, 5), "nonholonomic")


def test_the_jackknifed_tractor_takes_one_bracket_more() -> None:
    # [laumond1993]: the degree of nonholonomy of two trailers is 4, and 5 with the tractor at a right angle.
    ours = found("trailers")
    assert [growth for _, growth in ours.special] == [(2, 3, 4, 4, 5)] * 2
    assert {place[ours.system.coordinates[3]] % sp.pi for place, _ in ours.special} == {sp.pi / 2}
    assert ours.growth_at({"delta_1": 0, "delta_2": sp.pi / 2}) == ours.growth


def test_normal_forms_of_the_textbooks() -> None:
    # [montgomery2002]: Heisenberg, Engel, Martinet, and Hilbert and Cartan's z' = (y'')².
    x, y, z, p, q = sp.symbols("x y z p q")
    forms: list[tuple[Any, Any, Any]] = [
        ((x, y, z), [[y, -x, 2]], (2, 3)),
        ((x, y, p, q), [[-p, 1, 0, 0], [-q, 0, 1, 0]], (2, 3, 4)),
        ((x, y, z), [[-(y**2), 0, 1]], (2, 3)),
        ((x, y, p, q, z), [[-p, 1, 0, 0, 0], [-q, 0, 1, 0, 0], [-(q**2), 0, 0, 0, 1]], (2, 3, 5)),
    ]
    for coordinates, rows, growth in forms:
        assert tr.PfaffianSystem(coordinates, rows).analyse().growth == growth
    martinet = tr.PfaffianSystem(*forms[2][:2]).analyse()
    assert martinet.special == (({y: 0}, (2, 2, 3)),)
    assert martinet.growth_at({"y": 1}) == (2, 3)


def test_a_leaning_disc_in_the_coordinates_of_its_contact() -> None:
    # Where it touches moves by a dψ along the heading, and leaning and turning leave it: the upright coin and one more.
    x, y, phi, theta, psi, a = sp.symbols("x y phi theta psi a")
    by_hand = tr.PfaffianSystem(
        (x, y, phi, theta, psi), [[1, 0, 0, 0, a * sp.cos(phi)], [0, 1, 0, 0, a * sp.sin(phi)]]
    ).analyse()
    assert found("disc").growth == by_hand.growth == (3, 4, 5)


def test_a_ball_on_a_ball_is_held_to_it_only_if_they_are_equal() -> None:
    # [agrachev2004], chapter 24: rolling without pivoting is integrable on isometric surfaces, else (2, 3, 5).
    # Latitudes and longitudes of the contact on both, and the angle between the two grids there.
    q = a1, _, a2, _, psi = sp.symbols("alpha_1 beta_1 alpha_2 beta_2 psi")
    r1, r2 = sp.symbols("R_1 R_2")

    def rows(first: sp.Expr, second: sp.Expr) -> list[list[sp.Expr]]:
        c, s = sp.cos(psi), sp.sin(psi)
        return [
            [-c * first, s * first * sp.sin(a1), second, 0, 0],
            [-s * first, -c * first * sp.sin(a1), 0, second * sp.sin(a2), 0],
            [0, -sp.cos(a1), 0, sp.cos(a2), 1],
        ]

    unequal, equal = (tr.PfaffianSystem(q, rows(r1, second)).analyse() for second in (r2, r1))
    assert (unequal.growth, unequal.verdict) == ((2, 3, 5), "nonholonomic")
    assert (equal.growth, equal.verdict, equal.integrable) == ((2,), "holonomic", 3)


def test_the_lectures_cylinders() -> None:
    x, phi = found("cylinder").system.coordinates
    a, b = sp.symbols("a b", positive=True)
    assert found("cylinder").integrals == (x - a * phi,)
    theta, phi = found("cylinder-in-cylinder").system.coordinates
    (ours,) = found("cylinder-in-cylinder").integrals
    # Arcs of equal length: bθ along the outer one is a(φ + θ) along the inner.
    assert sp.expand(ours - (b * theta - a * (phi + theta))) == 0


# --- the rows are those of rolling -----------------------------------------------------------------------


@precisely
def test_the_spheres_rows_are_the_lectures_rolling_condition() -> None:
    draw = random.Random(3)  # noqa: S311
    system = tr.PfaffianSystem.load("sphere")
    radius = mpmath.mpf("0.3")
    for _ in range(5):
        angles = [mpmath.mpf(draw.uniform(0.2, 2.9)) for _ in range(3)]
        rates = [mpmath.mpf(draw.uniform(-1, 1)) for _ in range(3)]

        def turned(t: Any, angles: Any = angles, rates: Any = rates) -> Any:
            phi, theta, psi = (angle + rate * t for angle, rate in zip(angles, rates, strict=True))
            about_z, about_x = Vector(0, 0, 1), Vector(1, 0, 0)
            q = turn(about_z * phi) * turn(about_x * theta) * turn(about_z * psi)
            return q.matrix()

        Q, rate = turned(mpmath.mpf(0)), slope(turned)
        spin = rate @ Q.transpose
        Omega = Vector(spin.c.y, spin.a.z, spin.b.x)
        V = Omega.cross(Vector(0, 0, 1)) * radius  # the lecture: V = a Ω×n
        values = dict(zip(system.coordinates, [0, 0, *angles], strict=True)) | {sp.Symbol("a", positive=True): radius}
        for row in system.rows.tolist():
            slip = sum(
                mpmath.mpmathify(sp.sympify(entry).evalf(50, subs=values)) * part
                for entry, part in zip(row, [V.x, V.y, *rates], strict=True)
            )
            assert abs(slip) < mpmath.mpf("1e-25")


# --- loops in numbers ------------------------------------------------------------------------------------


@precisely
def test_the_square_turns_the_ball_clockwise_by_its_area() -> None:
    # Rotations composed, no coordinates: rolling by s along e turns by s/a about n×e.
    radius, x, y = mpmath.mpf("0.7"), Vector(0, 1, 0), Vector(-1, 0, 0)
    turns = []
    for side in (mpmath.mpf("1e-6"), mpmath.mpf("1e-9")):
        q = Quaternion(mpmath.mpf(1), 0, 0, 0)
        for axis in (x, y, -x, -y):
            q = turn(axis * (side / radius)) * q
        turns.append([2 * part / side**2 * radius**2 for part in (q.x, q.y, q.z)])
    # Third order in the side is left, so each thousandth of the side is a thousandth of the error.
    for i, limit in enumerate((0, 0, -1)):
        assert abs(turns[0][i] - limit) < 2e-6
        assert abs(turns[1][i] - limit) < 2e-9
    assert dict(zip("xyφθψ", found("sphere").also[0].components, strict=True)) == {
        "x": 0,
        "y": 0,
        "φ": -1 / sp.Symbol("a", positive=True) ** 2,
        "θ": 0,
        "ψ": 0,
    }


def numeric(analysis: ConstraintAnalysis, seed: int) -> tuple[Any, list[Any], Any]:
    """Return a random place, the fields as functions of the place, and what puts numbers for the constants."""
    draw = random.Random(seed)  # noqa: S311
    q = analysis.system.coordinates
    constants = sorted(analysis.system.rows.free_symbols - set(q), key=str)
    given = {c: sp.Rational(draw.randint(11, 20), 10 + 10 * i) for i, c in enumerate(reversed(constants))}

    def evaluated(e: Any) -> Any:
        return sp.lambdify(q, [sp.sympify(part).subs(given) for part in e])

    return np.array([draw.uniform(0.5, 1.2) for _ in q]), [evaluated(f.components) for f in analysis.fields], evaluated


def drive(field: Any, start: Any, length: float) -> Any:
    run = solve_ivp(
        lambda _, q: np.array(field(*q), dtype=float), (0, length), start, "DOP853", rtol=TOLERANCE, atol=TOLERANCE
    )
    return run.y[:, -1]


@pytest.mark.parametrize("name", [name for name in NAMES if name not in ("cylinder", "cylinder-in-cylinder")])
def test_a_small_loop_ends_where_the_bracket_says(name: str) -> None:
    ours = found(name)
    place, fields, evaluated = numeric(ours, 7)
    names = [field.name for field in ours.fields]
    for bracket in [*ours.also, *(b for b in ours.brackets if b.level == 2)]:
        first, second = (names.index(n) for n in bracket.name.strip("[]").split(", "))
        gone = []
        for side in (2e-3, 1e-3):
            end = place
            for i, sense in ((first, 1), (second, 1), (first, -1), (second, -1)):
                end = drive(fields[i], end, sense * side)
            gone.append((end - place) / side**2)
        wanted = np.array(evaluated(bracket.components)(*place), dtype=float)
        # The loop's displacement is s²[X, Y] + O(s³): halving the side halves the error, and the rest is O(s²).
        size = max(1.0, float(np.abs(wanted).max()))
        assert np.abs(2 * gone[1] - gone[0] - wanted).max() < 1e-4 * size + SOLVER(100, TOLERANCE, 1e6)


@pytest.mark.parametrize("name", ["cylinder", "cylinder-in-cylinder", "cart", "disguised"])
def test_integrals_stay_constant_along_a_drive(name: str) -> None:
    ours = found(name)
    place, fields, evaluated = numeric(ours, 11)
    places = [place]
    for i, length in enumerate((0.7, -0.4, 0.3, 0.5)):
        places.append(drive(fields[i % len(fields)], places[-1], length))
    values = np.array([evaluated(ours.integrals)(*p) for p in places])
    assert np.ptp(values, axis=0).max() < SOLVER(1000, TOLERANCE, 10.0)
    assert max(np.abs(after - before).max() for before, after in pairwise(places)) > 0.1  # and yet it went somewhere


# --- Frobenius -------------------------------------------------------------------------------------------


def frobenius(form: list[sp.Expr], q: Any) -> sp.Expr:
    """Return ω∧dω of a form in three coordinates: ω·curl ω."""
    a, b, c = form
    x, y, z = q
    curl = (sp.diff(c, y) - sp.diff(b, z), sp.diff(a, z) - sp.diff(c, x), sp.diff(b, x) - sp.diff(a, y))
    return sp.simplify(sum(part * other for part, other in zip(form, curl, strict=True)))


@pytest.mark.parametrize("seed", range(6))
def test_a_form_with_a_hidden_factor_is_found_out(seed: int) -> None:
    draw = random.Random(seed)  # noqa: S311
    q = x, y, z = sp.symbols("x y z")
    terms = [x * y, z, y * z, x**2, sp.sin(x), sp.exp(y), sp.cos(z)]
    f = sum(draw.choice((1, 2, -3)) * term for term in draw.sample(terms, 3)) + x + 2 * z
    factor = draw.choice((1 + x**2, sp.exp(y - z), y * z, 2 + sp.sin(x)))
    form = [sp.expand(factor * sp.diff(f, c)) for c in q]
    assert frobenius(form, q) == 0
    ours = tr.PfaffianSystem(q, [form]).analyse()
    assert (ours.verdict, ours.growth) == ("holonomic", (2,))
    assert ours.is_integral(f)
    (g,) = ours.integrals
    across = [sp.simplify(sp.diff(f, u) * sp.diff(g, v) - sp.diff(f, v) * sp.diff(g, u)) for u, v in ((x, y), (y, z))]
    assert across == [0, 0]  # g is a function of f
    # One term more that no factor can repair:
    bent = [form[0], form[1], form[2] + x**3 * y]
    spoilt = tr.PfaffianSystem(q, [bent]).analyse()
    assert (spoilt.growth == (2, 3)) == (frobenius(bent, q) != 0)
    assert spoilt.growth == (2, 3)


def test_a_system_in_part_integrable() -> None:
    ours = found("cart")
    a, b = sp.symbols("a b", positive=True)
    theta, left, right = ours.system.coordinates[2:]
    assert (ours.verdict, ours.integrable) == ("partly holonomic", 1)
    # Drive both wheels: the heading is a(φ₂ − φ₁)/(2b), and nothing else follows.
    assert ours.is_integral(2 * b * theta - a * (right - left))
    assert not ours.is_integral(ours.system.coordinates[0])


def test_an_involution_without_a_closed_form_is_said_to_be_one() -> None:
    x, y = sp.symbols("x y")
    ours = tr.PfaffianSystem((x, y), [[sp.sqrt(x**2 + y**2), x + y**3]]).analyse()
    assert (ours.verdict, ours.integrals) == ("holonomic", ())
    assert "1 exists by Frobenius's theorem" in " ".join(str(ours).split())


# --- edges -----------------------------------------------------------------------------------------------


def test_rows_that_follow_from_others_change_nothing() -> None:
    system = tr.PfaffianSystem.load("coin")
    phi = system.coordinates[2]
    rows = system.rows.tolist()
    more = [*rows, [sp.sin(phi) * u - sp.cos(phi) * v for u, v in zip(*rows, strict=True)], [0] * 4]
    ours = tr.PfaffianSystem(system.coordinates, more).analyse()
    assert (ours.rank, ours.growth) == (2, (2, 3, 4))
    assert "2 of the 4 rows follow from the others" in str(ours)


def test_nothing_free_and_everything_free() -> None:
    x, y = sp.symbols("x y")
    fixed = tr.PfaffianSystem((x, y), [[1, x], [y, 1]]).analyse()
    assert (fixed.rank, fixed.growth, fixed.verdict, set(fixed.integrals)) == (2, (0,), "holonomic", {x, y})
    free = tr.PfaffianSystem((x, y), []).analyse()
    assert (free.rank, free.growth, free.verdict, free.integrals) == (0, (2,), "unconstrained", ())
    for analysis in (fixed, free):
        assert str(analysis)
        assert analysis.special == ()


def test_zero_is_told_in_whatever_form_it_comes() -> None:
    x, y, a = sp.symbols("x y a")
    nothing = sp.sin(3 * x) - 3 * sp.sin(x) + 4 * sp.sin(x) ** 3
    other = sp.cosh(a * x) ** 2 - sp.sinh(a * x) ** 2 - 1 + sp.sqrt(x**2 + y**2) ** 2 - x**2 - y**2
    assert tr.PfaffianSystem((x, y), [[nothing, other]]).analyse().rank == 0
    assert tr.PfaffianSystem((x, y), [[nothing, other + sp.Rational(1, 10**30)]]).analyse().rank == 1


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        (sp.Float(0.1), "exact numbers only"),
        (sp.log(sp.Symbol("x")), "decided exactly; got 'log(x)'"),
        (sp.Function("f")(sp.Symbol("x")), "known functions only; got 'f(x)'"),
        (sp.sqrt(sp.Symbol("x") ** 2), "root of a perfect square"),
        (sp.zoo, "must be finite"),
    ],
)
def test_what_cannot_be_decided_is_refused(entry: Any, said: str) -> None:
    x, y = sp.symbols("x y")
    with pytest.raises(tr.InvalidValueError, match=said.replace("(", r"\(").replace(")", r"\)")):
        tr.PfaffianSystem((x, y), [[1, entry]]).analyse()


def test_constraints_written_with_velocities() -> None:
    from sympy.physics.mechanics import dynamicsymbols

    x, phi = dynamicsymbols("x phi")
    a, t = sp.symbols("a"), dynamicsymbols._t
    rates = [sp.diff(c, t) for c in (x, phi)]
    ours = tr.PfaffianSystem.of_velocities((x, phi), rates, [rates[0] - a * rates[1]])
    assert [str(f) for f in ours.analyse().integrals] == ["-a*phi + x"]
    with pytest.raises(tr.InvalidValueError, match="take the time t as a coordinate"):
        tr.PfaffianSystem.of_velocities((x, phi), rates, [rates[0] - a * rates[1] - 3])
    with pytest.raises(tr.InvalidValueError, match="linear in the velocities"):
        tr.PfaffianSystem.of_velocities((x, phi), rates, [rates[0] ** 2 - rates[1]])


def test_a_belt_that_moves_is_holonomic_with_the_time_in_it() -> None:
    x, phi, t, a, v = sp.symbols("x phi t a v")
    (ours,) = tr.PfaffianSystem((x, phi, t), [[1, -a, -v]]).analyse().integrals
    assert sp.expand(ours - (x - a * phi - v * t)) == 0


@pytest.mark.parametrize(
    ("system", "said"),
    [
        (lambda x, y: tr.PfaffianSystem((x, y, x), [[1, 1, 1]]), "different names"),
        (lambda x, y: tr.PfaffianSystem((x, y), [[1]]), "coefficients"),
        (lambda x, y: tr.PfaffianSystem((x, y + 1), [[1, 1]]), "SymPy symbols"),
        (lambda x, y: tr.PfaffianSystem((x, y), [[1, 1]], {"go": [1, 1]}).analyse(), "obey every constraint"),
        (lambda x, y: tr.PfaffianSystem((x, y), [], {"go": [1, 1]}).analyse(), "2 independent fields"),
        (lambda x, y: tr.PfaffianSystem((x, y), [[x, y]]).analyse().growth_at({"z": 0}), "unknown coordinate 'z'"),
        (lambda x, y: tr.PfaffianSystem((x, y), [[x, y]]).analyse().growth_at({x: 0, y: 0}), "independent"),
        (lambda x, y: tr.PfaffianSystem.load("sphre"), "Did you mean 'sphere'"),  # noqa: ARG005
    ],
)
def test_what_makes_no_system_is_refused(system: Any, said: str) -> None:
    with pytest.raises(tr.TrundleError, match=said):
        system(*sp.symbols("x y"))


def test_greek_letters_do_not_depend_on_where_sympy_was_loaded() -> None:
    # SymPy asks the standard output what letters it has when it is imported, and writes phi where it is captured.
    code = (
        "import contextlib, io\nwith contextlib.redirect_stdout(io.StringIO()):\n    import sympy, trundle as tr\n"
        "assert 'x − a φ' in str(tr.PfaffianSystem.load('cylinder').analyse())"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)  # noqa: S603
