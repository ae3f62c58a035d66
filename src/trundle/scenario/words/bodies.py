"""From a body back to its table."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...errors import InvalidValueError
from ...mechanics.algebra import Matrix
from ...mechanics.bodies import HOLLOW_SPHERE, SOLID_SPHERE, Body, Isotropic, Principal, Tensor
from ...mechanics.expressions import Expression
from ...mechanics.scalars import Scalar
from ...mechanics.shapes import Disc, Ellipsoid, HalfCylinder, Hemisphere, Roller, Shape, Sphere, SupportFunction, Torus
from ...mechanics.shapes.support_function import NAMES
from .parts import Words, number_of, numbers_of, wordless

_UPRIGHT = Matrix.identity()


def body_words(body: Body) -> Words:
    """Return the table of a body.

    Examples
    --------
    >>> body_words(Body.solid_sphere(radius=0.025, mass=0.065))
    {'kind': 'solid-sphere', 'radius': 0.025, 'mass': 0.065}
    """
    words = _SHAPES.get(type(body.shape))
    if words is None:
        raise wordless("body", body)
    return words(body)


def _sphere(body: Body) -> Words:
    size = {"radius": number_of(body.radius, "body.radius"), **_mass(body)}
    if not body.is_isotropic_sphere:
        return {"kind": "eccentric-sphere", **size, **_inertia(body), **_centre(body)}
    if isinstance(body.inertia, Isotropic):  # its ratio would be rounded once more
        return {"kind": "sphere-with-moment", **size, "moment_of_inertia": _moment(body)}
    ratio = number_of(body.inertia_ratio, "body.inertia_ratio")
    if ratio == SOLID_SPHERE:
        return {"kind": "solid-sphere", **size}
    if ratio == HOLLOW_SPHERE:
        return {"kind": "hollow-sphere", **size}
    return {"kind": "sphere", **size, "inertia_ratio": ratio}


def _roller(body: Body) -> Words:
    size = {"radius": number_of(body.radius, "body.radius"), **_mass(body)}
    if body.is_isotropic_sphere and not isinstance(body.inertia, Isotropic):
        return {"kind": "cylinder", **size, "inertia_ratio": number_of(body.inertia_ratio, "body.inertia_ratio")}
    return {"kind": "eccentric-cylinder", **size, "moment_of_inertia": _moment(body), **_centre(body)}


def _half_cylinder(body: Body) -> Words:
    size = {"radius": number_of(body.radius, "body.radius"), **_mass(body)}
    return _short(body, "half-cylinder", Body.half_cylinder, size) or {
        "kind": "half-cylinder",
        **size,
        "moment_of_inertia": _moment(body),
        **_centre(body, always=True),
    }


def _hemisphere(body: Body) -> Words:
    size = {"radius": number_of(body.radius, "body.radius"), **_mass(body)}
    return _short(body, "hemisphere", Body.hemisphere, size) or {
        "kind": "hemisphere",
        **size,
        **_inertia(body),
        **_centre(body, always=True),
    }


def _disc(body: Body) -> Words:
    size = {**_lengths(body.shape, "radius"), **_mass(body)}
    return (
        _short(body, "disc", Body.disc, size)
        or _short(body, "ring", Body.ring, size)
        or {"kind": "disc", **size, **_inertia(body), **_centre(body)}
    )


def _torus(body: Body) -> Words:
    size = {**_lengths(body.shape, "radius", "rim_radius"), **_mass(body)}
    own = {"kind": "torus", **size, **_inertia(body), **_centre(body)}
    return _short(body, "torus", Body.torus, size) or own


def _ellipsoid(body: Body) -> Words:
    size = {"semi_axes": list(_lengths(body.shape, "a", "b", "c").values()), **_mass(body)}
    own = {"kind": "ellipsoid", **size, **_inertia(body), **_centre(body)}
    return _short(body, "ellipsoid", Body.ellipsoid, size) or own


def _formula(body: Body) -> Words:
    formula = body.shape.formula  # type: ignore[attr-defined]
    # The text says what the numbers were when it was read.
    if Expression.parse(formula.text, NAMES, "body.support_function").tree != formula.tree:
        raise wordless("body", body)
    size = {"support_function": formula.text, **_mass(body)}
    return {"kind": "formula", **size, **_inertia(body), **_centre(body)}


_SHAPES: dict[type[Shape], Callable[[Body], Words]] = {
    Sphere: _sphere,
    Roller: _roller,
    HalfCylinder: _half_cylinder,
    Hemisphere: _hemisphere,
    Disc: _disc,
    Torus: _torus,
    Ellipsoid: _ellipsoid,
    SupportFunction: _formula,
}


def _mass(body: Body) -> Words:
    return {"mass": number_of(body.mass, "body.mass")}


def _lengths(shape: Shape, *names: str) -> Words:
    return {name: number_of(getattr(shape, name), f"body.{name}") for name in names}


def _short(body: Body, kind: str, builder: Callable[..., Body], size: dict[str, Any]) -> Words | None:
    """Return the words of a builder's own body, which needs no moments."""
    try:
        return {"kind": kind, **size} if builder(**size) == body else None
    except InvalidValueError:
        return None


def _moment(body: Body) -> float:
    """Return the one moment of inertia of a body that has no others."""
    if isinstance(body.inertia, (Principal, Tensor)):
        raise wordless("body", body)
    return number_of(body.inertia_in_space(_UPRIGHT).c.z, "body.inertia")


def _inertia(body: Body) -> Words:
    rows = body.inertia_in_space(_UPRIGHT).rows
    moments: tuple[Scalar, ...] = (rows[0].x, rows[1].y, rows[2].z)
    if isinstance(body.inertia, Principal):
        moments = (body.inertia.x, body.inertia.y, body.inertia.z)
    products: Words = {}
    if isinstance(body.inertia, Tensor):
        moments, given = body.inertia.elements[:3], body.inertia.elements[3:]
        products = {"products": numbers_of(given, "body.products")}
    return {"moments": numbers_of(moments, "body.moments"), **products}


def _centre(body: Body, always: bool = False) -> Words:
    """Return where a shape's own centre is; a half whose centre is left out has that of a solid."""
    centre = body.shape.centre  # type: ignore[attr-defined]
    if centre is None:
        return {"centre": [0.0, 0.0, 0.0]} if always else {}
    return {"centre": numbers_of(centre, "body.centre")}
