"""Every registered body, surface, motion and load is known to every room: files, words, figures, scenes, the lab."""

from __future__ import annotations

import tomllib
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.lab.parts import all_parts
from trundle.mechanics.loads import Load
from trundle.mechanics.motions import Motion
from trundle.mechanics.parts import kinds_of
from trundle.mechanics.surfaces import Surface
from trundle.scenario import ScenarioFile
from trundle.scenario.tables import KINDS
from trundle.views.plots.words import key_numbers, title_of
from trundle.views.scene.body_mesh import body_mesh

PARTS = all_parts()
SAID = [(family, kind) for family in ("body", "support", "motion", "loads") for kind in PARTS[family]]


def scenario_with(family: str, kind: str) -> ScenarioFile:
    """A ball at rest on a table, with one part as the lab offers it first."""
    first = PARTS[family][kind]["first"]
    tables: dict[str, Any] = {
        "body": {"kind": "solid-sphere", "radius": "25 mm", "mass": "510 g"},
        "support": {"kind": "plane"},
        "start": {"position": ["15 cm", 0]} | PARTS[family][kind].get("start", {}),
        "run": {"duration": "1 s", "every": "10 ms"},
    }
    if family == "motion":
        tables["support"]["motion"] = first or {"kind": "combined", "parts": [{"kind": "spin", "rate": 2.0}]}
    else:
        tables[family] = [first] if family == "loads" else first
    return ScenarioFile.read(tables)


def test_nothing_is_registered_in_one_room_only() -> None:
    assert list(KINDS["body"]) == list(PARTS["body"]) == list(tr.Body.builders())
    assert list(KINDS["support"]) == list(PARTS["support"]) == list(kinds_of(Surface))
    assert set(KINDS["support.motion"]) == set(PARTS["motion"]) == set(kinds_of(Motion))
    assert list(KINDS["loads"]) == list(PARTS["loads"]) == list(kinds_of(Load))


@pytest.mark.parametrize(("family", "kind"), SAID)
def test_a_file_holds_it_and_gives_it_back(family: str, kind: str) -> None:
    scenario = scenario_with(family, kind)
    system, start = scenario.system(), scenario.start_state()
    again = ScenarioFile.describe(system, start, duration=1.0, every=0.01)
    assert again.system() == system
    assert ScenarioFile.read(tomllib.loads(again.to_toml())).system() == system


@pytest.mark.parametrize(("family", "kind"), SAID)
def test_figures_and_scenes_have_words_and_a_picture_of_it(family: str, kind: str) -> None:
    system = scenario_with(family, kind).system()
    title, numbers = title_of(system), key_numbers(system)
    bare = scenario_with("support", "plane").system()
    assert title
    if family != "body" and kind not in ("plane", "fixed"):
        assert numbers != key_numbers(bare), "figures must say what acts, what moves and what is rolled on"
    assert system.body.shape.key_numbers()
    assert np.isfinite(body_mesh(system.body).vertices).all()
    assert system.body.shape.noun != tr.Shape.noun or kind == "formula"
    assert system.support.surface.noun != Surface.noun or "height" in kind or kind == "revolution"
