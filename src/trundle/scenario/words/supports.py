"""From a surface back to its table."""

from __future__ import annotations

from typing import Any

from ...mechanics.surfaces import (
    Bowl,
    Cone,
    Cylinder,
    Dome,
    EllipsoidalBowl,
    HeightField,
    HeightTable,
    Paraboloid,
    Plane,
    Revolution,
    RevolutionTable,
    TorusTrack,
)
from .parts import Describe, Words, number_of, numbers_of


def _numbers(surface: Any, kind: str, key: str, *names: str) -> Words:
    """Return the words of a surface that is its numbers; what is None is left out."""
    given = {name: getattr(surface, name) for name in names}
    return {"kind": kind, **{n: number_of(v, f"{key}.{n}") for n, v in given.items() if v is not None}}


def _ellipsoidal_bowl(bowl: EllipsoidalBowl, key: str) -> Words:
    axes = numbers_of(bowl.semi_axes, f"{key}.semi_axes")
    return {**_numbers(bowl, "ellipsoidal-bowl", key, "depth"), "semi_axes": axes}


def _by_formula(surface: Revolution | HeightField, kind: str, key: str) -> Words:
    return {**_numbers(surface, kind, key, "rim"), "formula": surface.formula.text}


def _with_side(surface: Any, kind: str, key: str, *names: str) -> Words:
    return {**_numbers(surface, kind, key, *names), "side": surface.side}


def _grid(surface: HeightTable, key: str) -> Words:  # noqa: ARG001  its numbers were checked when it was made
    x, y = surface.grid.axes
    return {"kind": "height-field", "x": list(x), "y": list(y), "z": [list(row) for row in surface.grid.values]}


def _profile(surface: RevolutionTable, key: str) -> Words:  # noqa: ARG001  its numbers were checked when it was made
    return {"kind": "revolution", "r": list(surface.profile.r), "z": list(surface.profile.values)}


SURFACES: Describe = {
    Plane: lambda surface, key: _numbers(surface, "plane", key, "rim"),
    Cylinder: lambda surface, key: _with_side(surface, "cylinder", key, "radius"),
    Bowl: lambda surface, key: _numbers(surface, "bowl", key, "radius", "rim"),
    Dome: lambda surface, key: _numbers(surface, "dome", key, "radius", "rim"),
    Cone: lambda surface, key: _with_side(surface, "cone", key, "half_angle", "rim"),
    Paraboloid: lambda surface, key: _numbers(surface, "paraboloid", key, "radius", "rim"),
    EllipsoidalBowl: _ellipsoidal_bowl,
    TorusTrack: lambda surface, key: _with_side(surface, "torus-track", key, "ring_radius", "tube_radius"),
    Revolution: lambda surface, key: _by_formula(surface, "revolution", key),
    RevolutionTable: _profile,
    HeightField: lambda surface, key: _by_formula(surface, "height-field", key),
    HeightTable: _grid,
}
