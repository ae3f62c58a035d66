"""Many bodies put down in one call: the same starts as one by one, and the same refusals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.errors import InvalidValueError
from trundle.mechanics import overlap
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.contact import contact_at
from trundle.mechanics.placing_many import ManyPlacing

BALL = tr.Body.solid_sphere(0.02, 0.065)
LOADED = tr.Body.eccentric_sphere(0.02, 0.065, (1e-5, 1.1e-5, 0.9e-5), centre=(0.004, 0.001, -0.003))
STONE = tr.Body.ellipsoid((0.03, 0.025, 0.02), mass=0.1)
COIN = tr.Body.disc(radius=0.02, mass=0.01)
SUPPORTS = {
    "table": tr.Support(tr.Plane(), motion=tr.Spin(-3.5), tilt=0.05),
    "rimmed": tr.Support(tr.Plane(rim=0.2)),
    "swinging": tr.Support(tr.Plane(), motion=tr.Wobble(rate=3.0, angle="2 deg"), friction=0.3),
    "bowl": tr.Support(tr.Bowl(0.5, rim=0.2)),
    "spinning bowl": tr.Support(tr.EllipsoidalBowl((0.5, 0.4, 0.3)), motion=tr.Spin(1.5)),
    "dish": tr.Support(tr.Paraboloid(0.5), motion=tr.Spin(2.0), tilt=0.1),
    "mound": tr.Support(tr.Paraboloid(-0.5), friction=0.2),
    "dome": tr.Support(tr.Dome(0.5), friction=0.2),
    "pipe": tr.Support(tr.Cylinder(0.5), tilt=1.5),
    "log": tr.Support(tr.Cylinder(0.5, side="outside"), tilt=1.5),
    "cone": tr.Support(tr.Cone("45 deg")),
    "torus": tr.Support(tr.TorusTrack(0.5, 0.2)),
    "axle": tr.Support(tr.Plane(), motion=tr.FreeAxle(0.01, rate=1.0)),
}
FIELDS = ("position", "velocity", "angular_velocity", "orientation", "support")
COUNT = 40


def drawn(seed: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    q = rng.normal(size=(COUNT, 4))
    return {
        "position": rng.uniform(-0.18, 0.18, (COUNT, 2)),
        "velocity": rng.normal(0, 0.2, (COUNT, 2)),
        "whole": rng.normal(0, 0.2, (COUNT, 3)),
        "spin": rng.normal(0, 5, COUNT),
        "turning": rng.normal(0, 5, (COUNT, 3)),
        "orientation": q,
    }


def agree(system: Any, count: int = COUNT, **given: Any) -> int:
    """Compare with `place`, member by member; say how many it put down."""
    systems = system if isinstance(system, list) else [system] * count

    def own(i: int) -> dict[str, Any]:
        return {key: value[i] if isinstance(value, np.ndarray) else value for key, value in given.items()}

    alone, refused = [], None
    for i, each in enumerate(systems):
        try:
            alone.append(each.place(**own(i)))
        except InvalidValueError as error:
            refused = refused or (i, error)
            alone.append(None)
    position, rest = given.pop("position"), given
    good = [i for i, start in enumerate(alone) if start is not None]
    if refused is not None:
        with pytest.raises(InvalidValueError) as told:
            tr.place_many(system, position, **rest)
        assert (told.value.rule, told.value.remedy) == (refused[1].rule, refused[1].remedy)
        if f"{refused[1].key}" in given or refused[1].key == "position":
            assert str(refused[0]) in told.value.key or not isinstance(given.get(refused[1].key, position), np.ndarray)
    if good:
        some = [systems[i] for i in good] if isinstance(system, list) else system
        kept = {key: value[good] if isinstance(value, np.ndarray) else value for key, value in rest.items()}
        starts = tr.place_many(some, position[good], **kept)
        for i, start in zip(good, starts, strict=True):
            for field in FIELDS:
                np.testing.assert_allclose(getattr(start, field), getattr(alone[i], field), rtol=1e-13, atol=1e-14)
            assert start.time == alone[i].time
            assert all(type(part) is float for field in FIELDS for part in getattr(start, field))
    return len(good)


@pytest.mark.parametrize("name", SUPPORTS)
@pytest.mark.parametrize("body", [BALL, LOADED, STONE], ids=["ball", "loaded", "stone"])
def test_they_are_put_down_as_one_by_one(name: str, body: Any) -> None:
    system, some = tr.RollingSystem(body, SUPPORTS[name]), drawn(1)
    down = agree(system, position=some["position"])
    down += agree(system, position=some["position"], velocity=some["velocity"], spin=some["spin"], time=0.7)
    down += agree(system, position=some["position"], velocity="co-rotating", orientation=some["orientation"])
    down += agree(system, position=some["position"], velocity=some["whole"], angular_velocity=some["turning"])
    down += agree(system, position=some["position"], velocity=some["velocity"], angular_velocity=some["turning"])
    down += agree(system, position=some["position"], velocity=some["whole"], spin=2.0)
    down += agree(system, position=some["position"], velocity="rolling", angular_velocity=some["turning"])
    agree(system, position=some["position"], velocity="rolling", spin=2.0)  # refused, whoever
    assert down > COUNT


@pytest.mark.parametrize("name", ["table", "bowl", "dome"])
def test_coins_and_cylinders(name: str) -> None:
    rng, some = np.random.default_rng(2), drawn(3)
    coin = tr.RollingSystem(COIN, SUPPORTS[name])
    angles = np.column_stack([rng.uniform(-3, 3, COUNT), rng.uniform(0.2, 1.5, COUNT), rng.uniform(-3, 3, COUNT)])
    angles[::7, 1] = 0.0  # flat: refused
    agree(coin, position=some["position"], attitude=angles, velocity=some["velocity"] * 0.1, spin=some["spin"])
    if name == "table":
        level = tr.RollingSystem(tr.Body.cylinder(0.05, 1.0), tr.Support(tr.Plane(), tilt=0.1))
        along = np.zeros((COUNT, 2))
        along[:, 0] = rng.normal(size=COUNT)
        assert agree(level, position=some["position"], velocity=along, roll=rng.uniform(0, 3, COUNT)) == COUNT


def test_from_a_height_and_on_the_ground() -> None:
    some, heights = drawn(4), np.linspace(0.0, 0.1, COUNT)
    system = tr.RollingSystem(BALL, SUPPORTS["table"])
    assert agree(system, position=some["position"], height=heights, velocity=some["whole"]) > 0


def test_each_has_a_system_of_its_own() -> None:
    rng, some = np.random.default_rng(5), drawn(6)
    for surface in (
        lambda x: tr.Bowl(0.5 + x),
        lambda x: tr.EllipsoidalBowl((0.5, 0.4 + x, 0.3)),
        lambda _: tr.Plane(),
    ):
        systems = [
            tr.RollingSystem(
                tr.Body.solid_sphere(0.02 + 0.01 * x, 0.1),
                tr.Support(surface(x), motion=tr.Spin(x - 0.5), tilt=0.1 * x),
            )
            for x in rng.uniform(0, 1, COUNT)
        ]
        assert agree(systems, position=some["position"], velocity=some["velocity"], spin=some["spin"]) == COUNT


def test_units_and_one_for_all() -> None:
    system = tr.RollingSystem(BALL, SUPPORTS["table"])
    plain = tr.place_many(system, [[0.1, 0.0], [0.2, 0.05]], velocity=(0.0, 0.2), spin="30 rpm")
    texts = tr.place_many(
        system, [["10 cm", 0], ["200 mm", "5 cm"]], velocity=("0 m/s", "20 cm/s"), spin=["30 rpm"] * 2
    )
    assert plain == texts
    assert plain == [system.place((0.1, 0.0), (0.0, 0.2), math.pi), system.place((0.2, 0.05), (0.0, 0.2), math.pi)]
    assert len(tr.place_many(system, (0.1, 0.0), spin=np.arange(5.0))) == 5
    assert tr.place_many(system, (0.1, 0.0)) == [system.place((0.1, 0.0))]
    import pint

    metres = pint.UnitRegistry().Quantity(np.array([[10.0, 0.0], [20.0, 5.0]]), "cm")
    assert tr.place_many(system, metres, velocity=(0.0, 0.2), spin="30 rpm") == plain


@pytest.mark.parametrize(
    ("given", "key"),
    [
        ({"position": np.zeros((3, 4))}, "position"),
        ({"position": np.zeros((3, 2)), "velocity": np.zeros((4, 2))}, "velocity"),
        ({"position": np.zeros((3, 2)), "velocity": np.zeros((3, 5))}, "velocity"),
        ({"position": np.zeros((0, 2))}, "position"),
        ({"position": np.array([[0.1, 0.0], [np.nan, 0.0]])}, "position"),
        ({"position": [["10 cm", 0], ["3 kg", 0]]}, "position[1][0]"),
        ({"position": [["0.1", "0.3"]]}, "position[0][0]"),
        ({"position": np.zeros((2, 2)), "spin": np.zeros(2), "angular_velocity": np.zeros((2, 3))}, "angular_velocity"),
        ({"position": np.zeros((2, 2)), "velocity": "corotating"}, "velocity"),
        ({"position": np.zeros((2, 2)), "orientation": np.zeros((2, 4))}, "orientation"),
        ({"position": np.zeros((2, 2)), "time": np.inf}, "time"),
    ],
)
def test_what_is_refused(given: dict[str, Any], key: str) -> None:
    with pytest.raises(InvalidValueError) as told:
        tr.place_many(tr.RollingSystem(BALL, SUPPORTS["table"]), **given)
    assert told.value.key.startswith(key)


def test_a_plain_start_is_not_put_down_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tr.RollingSystem, "place", None)
    for name in ("table", "bowl", "spinning bowl", "dish", "dome", "pipe", "log"):
        tr.place_many(tr.RollingSystem(BALL, SUPPORTS[name]), np.full((3, 2), 0.05), spin=np.arange(3.0))


def test_no_mask_lets_through_what_place_refuses(monkeypatch: pytest.MonkeyPatch) -> None:
    """Were the masks left out, starts beyond the rim would be put down: so they have a say."""
    system = tr.RollingSystem(BALL, SUPPORTS["rimmed"])
    with pytest.raises(InvalidValueError, match="rim"):
        tr.place_many(system, [[0.0, 0.0], [0.3, 0.0]])
    monkeypatch.setattr(ManyPlacing, "_fits", lambda self, *_: np.ones(len(self.position), dtype=bool))
    assert len(tr.place_many(system, np.array([[0.0, 0.0], [0.3, 0.0]]))) == 2


SURFACES = {
    "bowl": tr.Bowl(0.5),
    "ellipsoidal": tr.EllipsoidalBowl((0.5, 0.4, 0.3)),
    "deep": tr.EllipsoidalBowl((0.2, 0.3, 0.6)),
    "dish": tr.Paraboloid(0.5),
    "pipe": tr.Cylinder(0.5),
}


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("share", [0.999, 1.02])
def test_the_largest_ball_that_lies_below_a_surface_nowhere(name: str, share: float) -> None:
    """By the search for the deepest point, which knows nothing of the theorem; a larger one is deep somewhere."""
    surface, q = SURFACES[name], Quaternion(1.0, 0.0, 0.0, 0.0)
    system = tr.RollingSystem(tr.Body.solid_sphere(share * float(surface.free_radius), 1.0), tr.Support(surface))
    assert overlap.fits_anywhere(system) == (share < 1)
    rng, deepest = np.random.default_rng(7), 0.0
    width = 1.4 * min(getattr(surface, "semi_axes", (0.5, 0.5))[:2]) * 0.7
    places = np.vstack([rng.uniform(-width / 2, width / 2, (60, 2)), [[0.0, 0.0], [0.0, 1e-3], [1e-3, 0.0]]])
    ends = [(0.49999, 0.0), (0.0, 0.39999)] if name == "ellipsoidal" else []
    for u, v in [*places.tolist(), *ends]:
        contact = contact_at(system, 0.0, surface.point(u, v), q)
        below = overlap.depth(system, contact, q)
        deepest = max(deepest, below[0] if below is not None else 0.0)
    if share < 1:
        assert deepest < 1e-9
    else:
        assert deepest > 1e-7


@pytest.mark.parametrize("surface", [tr.Plane(), tr.Dome(0.3), tr.Paraboloid(-0.2), tr.Cylinder(0.3, side="outside")])
def test_anything_fits_on_a_convex_support(surface: Any) -> None:
    assert surface.free_radius == math.inf


@pytest.mark.parametrize("axes", [(0.03, 0.025, 0.02), (0.01, 0.05, 0.02), (0.02, 0.02, 0.07)])
def test_the_largest_radius_of_curvature_of_an_ellipsoid(axes: tuple[float, float, float]) -> None:
    shape = tr.Body.ellipsoid(axes, mass=1.0).shape
    rng = np.random.default_rng(8)
    nus = np.vstack([rng.normal(size=(2000, 3)), np.eye(3)])
    radii = []
    for nu in nus / np.linalg.norm(nus, axis=1)[:, None]:
        rows = shape.support_gradient(Vector(*nu)).rows
        radii.append(np.linalg.eigvalsh(np.array([[float(x) for x in row] for row in rows])).max())
    assert max(radii) == pytest.approx(shape.largest_radius, rel=1e-12)
