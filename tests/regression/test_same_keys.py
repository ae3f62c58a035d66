"""What docs/motions-and-loads.md, bodies.md and surfaces.md promise: a table and its class have the same keys."""

from __future__ import annotations

import dataclasses
import inspect
from typing import Any

import pytest

import trundle as tr
from trundle.scenario.tables import KINDS
from trundle.scenario.tables.supports import OnSurface

OF_TWO = {"sphere-with-moment"}  # a `Body` with an `Isotropic` inertia, without a builder
ALL = [
    (family, kind)
    for family, kinds in KINDS.items()
    if family != "support.motion.parts"
    for kind in kinds
    if kind not in OF_TWO
]
BY_POINTS = {"revolution": {"r", "z"}, "height-field": {"x", "y", "z"}}  # keys of `through`


def keys_in_python(family: str, kind: str) -> set[str]:
    name = "".join(word.capitalize() for word in kind.split("-"))
    if family == "body":
        builder = {"formula": "shape_formula"}.get(kind, kind.replace("-", "_"))
        return set(inspect.signature(getattr(tr.Body, builder)).parameters)
    fields = {field.name for field in dataclasses.fields(getattr(tr, name)) if field.init}
    if family == "support":  # the table holds the surface and what `Support` takes besides
        fields |= {field.name for field in dataclasses.fields(tr.Support)} - {"surface"} | BY_POINTS.get(kind, set())
    return fields


@pytest.mark.parametrize(("family", "kind"), ALL, ids=[f"{family} {kind}" for family, kind in ALL])
def test_a_table_and_its_class_have_the_same_keys(family: str, kind: str) -> None:
    table: Any = KINDS[family][kind]
    keys = {field.alias or name for name, field in table.model_fields.items()} - {"kind"}
    assert keys == keys_in_python(family, kind)


def test_a_support_lists_its_own_keys_first() -> None:
    for table in KINDS["support"].values():
        shared = list(OnSurface.model_fields)
        assert next(iter(table.model_fields)) == "kind"
        assert list(table.model_fields)[-len(shared) :] == shared


@pytest.mark.parametrize("load", [tr.Drag, tr.QuadraticDrag])
def test_air_may_be_a_word_in_python_as_in_a_file(load: Any) -> None:
    table = tr.Support(tr.Plane(), motion=tr.UnevenSpin(3.0, 0.1, 3.0))
    ball = tr.Body.solid_sphere(0.025, 0.5)
    for air, wanted in (("still", 0.0), ("turning", 3.0), ("2 rad/s", 2.0), (-1.5, -1.5), (None, 0.0)):
        given = load(0.01) if air is None else load(0.01, air=air)
        assert tr.RollingSystem(ball, table, (given,)).loads[0].air == wanted
    with pytest.raises(tr.InvalidValueError, match=r"`air` must be an angular velocity; got 'windy'"):
        load(0.01, air="windy")
