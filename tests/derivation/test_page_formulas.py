"""The formulas that a scene shows with its numbers are those that the derivations prove."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any

import pytest
import sympy as sp
from sympy.parsing.latex import parse_latex
from tests.derivation.derived import derived

import trundle as tr
from trundle.analysis.derivation.topics import TOPICS
from trundle.analysis.derivation.zero import is_zero
from trundle.solve.exact import CLOSED_FORMS

# What SymPy's grammar does not read, or takes for a function, and what stands in its place.
READABLE = {
    r"\ddot\zeta": "X",
    r"\dot\zeta": "Y",
    r"\dot v": "W",
    r"\nu^2": "P",
    r"\varphi": "Q",
    r"\ell": "L",
    "v_d": "D",
    "m(1+k)": r"m \cdot (1+k) \cdot",
    r"\cdot}": "}",
    r"\,": " ",
}
# These letters and the page's own names, as the derivations have them. Their drift is a complex number, along y.
LEFT = {"X": "zetaddot", "W": "Vdot_x", "P": "lambda_0**2", "D": "v_d", "kappa": "kappa", "gamma": "gamma"}
NAMED = dict(zip(sp.symbols("Y Q L i G"), [*sp.symbols("zetadot varphi ell"), sp.I, sp.sympify("m*g")], strict=True))

BALL, CYLINDER = tr.Body.solid_sphere(radius=0.025, mass=0.51), tr.Body.cylinder(radius=0.03, mass=0.2)
LEVEL, LEANING = (tr.Support(tr.Plane(), tr.Spin(-3.5), tilt=tilt) for tilt in (0.0, 0.01))
SLOPE, DRUM = tr.Support(tr.Plane(), tilt=0.2), tr.Support(tr.Cylinder(0.5), tilt="90 deg")
# A derivation, a system of its kind with a start, and the left sides of the formulas that both have.
CASES: list[tuple[str, tr.RollingSystem, tuple[float, float], set[str]]] = [
    ("turntable", tr.RollingSystem(BALL, LEVEL), (0.1, 0.0), {"kappa"}),
    ("tilted-turntable", tr.RollingSystem(BALL, LEANING), (0.1, 0.0), {"kappa", "v_d"}),
    (
        "ball-with-drag",
        tr.RollingSystem(BALL, LEANING, loads=(tr.Drag(0.01),)),
        (0.1, 0.0),
        {"zetaddot", "kappa", "gamma"},
    ),
    ("cylinder-on-incline", tr.RollingSystem(CYLINDER, SLOPE), (0.0, 0.0), {"Vdot_x"}),
    ("cylinder-in-cylinder", tr.RollingSystem(CYLINDER, DRUM), (1.0, 0.0), {"lambda_0**2"}),
]


def proved(topic: str) -> dict[str, list[Any]]:
    """Return the right sides that a derivation proves for each left side."""
    found: dict[str, list[Any]] = {}
    for step in derived(topic).steps:
        for equation in step.equations:
            formula = equation.formula
            if isinstance(formula, sp.Eq) and isinstance(formula.lhs, sp.Expr):
                found.setdefault(str(formula.lhs), []).append(formula.rhs)
    return found


def shown(system: tr.RollingSystem, position: tuple[float, float]) -> dict[str, Any]:
    """Return the right sides that a scene shows for each left side, in the names of the derivation."""
    form = tr.simulate(system, system.place(position=position), duration=0.1, every=0.01).closed_form
    assert form is not None
    found = {}
    for latex in (one for lines, _ in form.formulas(system) for one in lines.split(r",\quad")):
        for told, letter in READABLE.items():
            latex = latex.replace(told, letter)
        left, equals, right = latex.strip().removeprefix("\\").partition(" = ")
        if equals and left in LEFT:
            parsed = parse_latex(right, backend="lark").subs(NAMED)
            found[LEFT[left]] = sp.I * parsed if left == "D" else parsed
    return found


def plain(expression: Any) -> Any:
    """Return an expression in symbols that are told apart by nothing but their names."""
    return expression.subs({symbol: sp.Symbol(symbol.name) for symbol in expression.free_symbols})


@pytest.mark.parametrize(("topic", "system", "position", "both"), CASES, ids=[case[0] for case in CASES])
def test_what_a_scene_shows_is_proved(
    topic: str, system: tr.RollingSystem, position: tuple[float, float], both: set[str]
) -> None:
    right, page = proved(topic), shown(system, position)
    assert set(right) & set(page) == both
    for left in both:
        assert any(is_zero(plain(one) - page[left]) for one in right[left]), f"{left} = {page[left]}, not {right[left]}"


def test_every_form_that_is_derived_is_looked_at() -> None:
    names = {form.__module__.rpartition(".")[2] for form in CLOSED_FORMS}
    derivable = {name for name in names if find_spec(f"trundle.analysis.derivation.{name}")}
    assert derivable == {TOPICS[topic].form for topic, *_ in CASES}
