"""What asks for a concrete part outside its home becomes no more; and the count sees all ways to ask."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.dispatch.__main__ import table
from tests.dispatch.finding import in_source, places
from tests.dispatch.parts import KINDS, kind_of

import trundle as tr
from trundle.mechanics.loads.base import Load
from trundle.mechanics.surfaces.base import Surface
from trundle.solve.exact import CLOSED_FORMS, ClosedForm

MOST = Path(__file__).with_name("most.txt")
IMPORTED = """
from trundle import Bowl, Cone, Plane
from trundle.mechanics import surfaces
from trundle.mechanics.surfaces.base import Surface
from ..solve.exact import SphereOnPlane as Form
"""
WAYS = {
    "isinstance(x, Plane)": ["Plane"],
    "isinstance(x, (Plane, Cone))": ["Plane", "Cone"],
    "isinstance(x, Plane | Cone)": ["Plane", "Cone"],
    "isinstance(x, surfaces.Plane)": ["Plane"],
    "issubclass(x, Plane)": ["Plane"],
    "isinstance(x, Form)": ["SphereOnPlane"],
    "EVEN = (Plane, Cone)\nisinstance(x, EVEN)": ["Plane", "Cone"],
    "def f(x):\n    from trundle import Dome\n    return isinstance(x, Dome)": ["Dome"],
    "match x:\n    case Plane() | Cone():\n        pass": ["Plane", "Cone"],
    "words = {Plane: 'plane', surfaces.Cone: 'cone'}": ["Plane", "Cone"],
    "words = ((Plane, 'plane'), (Cone, 'cone'))": ["Plane", "Cone"],
    "type(x) is Plane": ["Plane"],
    "type(x) in (Plane, Cone)": ["Plane", "Cone"],
    "x.__class__ == Plane": ["Plane"],
    "told.register(Plane, say)": ["Plane"],
    "@told.register(Plane)\ndef _(x): ...": ["Plane"],
    "@told.register\ndef _(x: Plane): ...": ["Plane"],
    "isinstance(x, Surface)": [],
    "isinstance(x, float)": [],
    "Plane(); both = (Plane, Cone); {'plane': Plane}": [],
}


def test_no_more_places_ask_for_a_concrete_part_than_did():
    found, most = list(places(Path(tr.__file__).parents[1], "trundle")), int(MOST.read_text(encoding="utf-8"))
    assert len(found) <= most, (
        f"{len(found)} places ask which part they have, and {most} did: `make dispatch` shows where. Let the part "
        f"answer itself, by a method or an attribute that its base has too.\n{table(found)}"
    )
    assert len(found) == most, f"Fewer places ask than did, well done: write {len(found)} into tests/dispatch/most.txt."


@pytest.mark.parametrize("source", WAYS)
def test_every_way_to_ask_is_seen_and_nothing_else(source):
    assert [one.part for one in in_source(IMPORTED + source, "trundle.views.made_up", "made_up.py")] == WAYS[source]


def test_a_part_may_be_asked_for_in_its_own_home_only():
    source = "from trundle import Plane, Spin\nisinstance(x, Plane) and isinstance(y, Spin)"
    assert [one.part for one in in_source(source, "trundle.mechanics.surfaces.made_up", "made_up.py")] == ["Spin"]
    assert [one.part for one in in_source(source, "trundle.mechanics.surfaces_of_others", "made_up.py")] == [
        "Plane",
        "Spin",
    ]


def test_parts_are_what_derives_from_the_base_of_their_kind():
    parts = (tr.Plane, tr.Sphere, type(tr.Body.solid_sphere(1.0, 1.0).inertia), tr.Spin, tr.Drag, CLOSED_FORMS[0])
    assert [kind_of(part) for part in parts] == list(KINDS)
    assert not any(map(kind_of, (Surface, Load, ClosedForm, float, tr.Support, tr.Plane())))
