"""Every closed form is known wherever closed forms are shown: lab and saved page, card, expectations and refusals."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from tests.contracts.test_closed_forms import Spring
from tests.reference.test_t15 import TUMBLING

import trundle as tr
from trundle.cli.expectations import expectations
from trundle.mechanics.system import RollingSystem, State
from trundle.solve.exact import CLOSED_FORMS, ClosedForm, closed_form, form_of_phase, refusals
from trundle.views.scene import scene_of
from trundle.views.scene.findings import findings_of

THEORY = (Path(__file__).parents[2] / "docs" / "theory.md").read_text(encoding="utf-8")
BALL = tr.Body.solid_sphere(0.025, 0.5)
UNLIKE = tr.Body(1.0, tr.Principal(3e-3, 4e-3, 5e-3), tr.Sphere(0.1))
ALIKE = tr.Body(1.0, tr.Principal(3e-3, 3e-3, 5e-3), tr.Sphere(0.1))
FELT = (tr.RollingResistance(0.001),)
NUDGED: dict[str, Any] = {"position": (0.1, 0.0), "velocity": (0.0, 0.2)}


def plane(motion: Any = None, **more: Any) -> tr.Support:
    return tr.Support(tr.Plane(), motion=motion or tr.Fixed(), **more)


def placed(support: tr.Support, body: tr.Body = BALL, loads: Any = (), **start: Any) -> tuple[RollingSystem, State]:
    system = RollingSystem(body, support, loads=loads)
    return system, system.place(**start)


CASES = (
    placed(plane(tr.Spin(3.5)), **NUDGED),
    placed(plane(tr.Spin(3.5)), loads=(tr.Drag(0.05, air=3.5),), **NUDGED),
    placed(plane(tr.UnevenSpin(3.5, 0.3, 2.0)), **NUDGED),
    placed(plane(tr.FreeAxle(0.5, 3.5)), **NUDGED),
    placed(plane(), loads=FELT, velocity=(0.3, 0.0)),
    placed(tr.Support(tr.Cylinder(0.5), tilt="90 deg"), loads=FELT, position=(0.0, 0.0)),
    placed(plane(friction=0.2), velocity=(2.0, 0.0), angular_velocity=(0.0, 0.0, 0.0)),
    placed(plane(friction=0.3, restitution=0.5), height=0.5, velocity=(1.0, 0.0)),
    placed(tr.Support(tr.Cylinder(0.1)), position=(0.0, 0.0), velocity=(1.5, 0.0)),
    placed(tr.Support(tr.Cylinder(0.5), tilt="70 deg"), position=(1.0, 0.0)),
    placed(tr.Support(tr.Cylinder(0.5), tilt="90 deg"), position=(1.0, 0.0)),
    placed(tr.Support(tr.Bowl(0.5)), position=(0.2, 0.0)),
    placed(plane(), UNLIKE, spin=3.0),
    placed(plane(), ALIKE, velocity=(0.3, 0.1), spin=8.0, orientation=(0.9, 0.3, 0.1, 0.0)),
    TUMBLING["round the longest"],
)
STRANGE = placed(
    tr.Support(tr.Paraboloid(2.0), motion=tr.Wobble(3.5, 0.1)),
    tr.Body.eccentric_sphere(0.1, 0.64, (2e-3, 3e-3, 4e-3), (0.0, 0.0, 0.01)),
    (Spring(1.0), tr.Drag(0.1, 2.0)),
    position=(0.1, -0.05),
)


def case_of(form: type[ClosedForm]) -> tuple[RollingSystem, State]:
    """Return the first of the cases that a form is chosen for."""
    found = [case for case in CASES if type(closed_form(*case)) is form]
    assert found, f"Give a system and a start that {form.__name__} covers."
    return found[0]


def run_of(form: type[ClosedForm]) -> Any:
    system, start = case_of(form)
    return tr.simulate(system, start, duration=3.0, every=0.01)


def one_by_one(forms: Any = CLOSED_FORMS) -> Any:
    return pytest.mark.parametrize("form", forms, ids=lambda form: form.__name__)


@one_by_one()
def test_scenes_show_its_formula_and_its_findings(form: type[ClosedForm]) -> None:
    run = run_of(form)
    header = scene_of(run, samples=300).header
    formula, own = header["formula"], run.closed_form
    assert (formula["name"].lower(), formula["source"]) == (own.name.lower(), own.equation)
    for text in (formula["latex"], formula["numbers_latex"]):
        assert text.strip()
        assert text.count("{") == text.count("}")
    assert re.search(r"\d", formula["numbers_latex"])
    predicted = [row for row in header["findings"] if row["predicted"] is not None]
    of_run = {row.name for row in findings_of(run.system, run.start, run.samples, None)}
    assert {row["name"] for row in predicted} - of_run
    assert all(row["difference"] is None or row["difference"] < 1e-5 for row in predicted)


@one_by_one()
def test_its_expectations_are_told(form: type[ClosedForm]) -> None:
    system, start = case_of(form)
    scenario = tr.Scenario.describe(system, start, duration=3.0, every=0.01)
    name, *rows = expectations(scenario)
    assert name == ("closed form", f"{form.equation}, {form.name}")
    assert rows
    assert all(said and value for said, value in rows)


def test_expectations_say_why_there_is_no_number() -> None:
    system, start = placed(plane(tr.Spin(50.0)), loads=(tr.Drag(0.5, air=60.0),), **NUDGED)
    scenario = tr.Scenario.describe(system, start, duration=1e6, every=1e3)
    assert "driven out beyond any number" in expectations(scenario)[1][1]


@one_by_one()
def test_the_card_names_it_and_holds_it_against_another_method(form: type[ClosedForm]) -> None:
    card = run_of(form).card()
    assert card.passed
    assert f"closed form {form.equation}, {form.name} ({form.source})" in str(card)
    assert any(figure.name.startswith("closed form against") for figure in card.figures)


@one_by_one()
def test_it_refuses_with_its_domain_and_every_reason(form: type[ClosedForm]) -> None:
    system, start = STRANGE
    refused = refusals(form.phases[0], system, start)
    assert f"The closed form {form.equation} ({form.name}) covers {form.domain()}." in refused
    assert not re.search(r"  |, ,|\.\.| ,", form.domain())
    reasons = form.violations(system, start)
    assert len(reasons) > 1
    assert all(reason in refused for reason in reasons)
    assert form_of_phase(form.phases[0], system, start, ()) is None


@one_by_one()
def test_its_equation_stands_on_the_theory_page(form: type[ClosedForm]) -> None:
    assert re.search(rf"\b{form.equation}\b", THEORY)
