"""Every kind of body can be said in a scenario file, and every body made in Python can be written as one."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

import trundle as tr
from trundle.errors import ScenarioError
from trundle.scenario import ScenarioFile
from trundle.scenario.layout import layout
from trundle.scenario.serialize import body_words
from trundle.scenario.tables import KINDS

REST: dict[str, Any] = {
    "support": {"kind": "plane"},
    "start": {"position": [0.0, 0.0]},
    "run": {"duration": 1.0, "every": 0.1},
}
ON_ITS_RIM = {**REST, "start": {"position": [0.0, 0.0], "attitude": [0.0, 1.5, 0.0]}}


def rest(body: tr.Body) -> dict[str, Any]:
    """Return the tables beside a body's."""
    return ON_ITS_RIM if isinstance(body.shape, (tr.Disc, tr.Torus)) else REST


FILES = {
    'kind = "eccentric-sphere"\nradius = "15 mm"\nmass = "6 g"\nmoments = [8e-7, 8e-7, 7e-7]\n'
    'centre = [0, 0, "2 mm"]': (tr.Body.eccentric_sphere(0.015, 0.006, (8e-7, 8e-7, 7e-7), (0, 0, 0.002))),
    'kind = "hemisphere"\nradius = "5 cm"\ndensity = "1.2 g/cm^3"': tr.Body.hemisphere(0.05, density=1200),
    'kind = "eccentric-cylinder"\nradius = 0.05\nmass = 0.4\nmoment_of_inertia = 5e-4\ncentre = ["-1 cm", 0, 0]': (
        tr.Body.eccentric_cylinder(0.05, 0.4, 5e-4, (-0.01, 0, 0))
    ),
    'kind = "half-cylinder"\nradius = "5 cm"\ndensity = 1200\nlength = "20 cm"': (
        tr.Body.half_cylinder(0.05, density=1200, length=0.2)
    ),
    'kind = "disc"\nradius = "1.2 cm"\nmass = "7.5 g"\nthickness = "2.2 mm"': (
        tr.Body.disc(0.012, mass=0.0075, thickness=0.0022)
    ),
    'kind = "ring"\nradius = "30 cm"\nmass = 1': tr.Body.ring(0.3, 1),
    'kind = "torus"\nradius = "20 cm"\nrim_radius = "1 cm"\nmass = 1': tr.Body.torus(0.2, 0.01, mass=1),
    'kind = "ellipsoid"\nsemi_axes = ["20 cm", "3 cm", "2 cm"]\nmass = 1\nmoments = [2e-4, 1.6e-3, 1.7e-3]\n'
    'products = [-2e-5, 0, 0]\ncentre = [0, 0, "1 cm"]': tr.Body.ellipsoid(
        (0.2, 0.03, 0.02), 1, moments=(2e-4, 1.6e-3, 1.7e-3), products=(-2e-5, 0, 0), centre=(0, 0, 0.01)
    ),
    'kind = "ellipsoid"\nsemi_axes = ["20 cm", "3 cm", "2 cm"]\ndensity = 1000\nturn = "0.5 rad"': (
        tr.Body.ellipsoid((0.2, 0.03, 0.02), density=1000, turn=0.5)
    ),
    'kind = "formula"\nsupport_function = "0.025 + 0.003*nu_z + 0.004*nu_z**2"\ndensity = "1.03 g/cm^3"': (
        tr.Body.shape_formula("0.025 + 0.003*nu_z + 0.004*nu_z**2", density=1030)
    ),
}


@pytest.mark.parametrize("text", FILES, ids=lambda text: text.splitlines()[0])
def test_a_file_says_the_body(text: str) -> None:
    data = {"body": tomllib.loads(text), **rest(FILES[text])}
    scenario = ScenarioFile.read(data)
    assert scenario.system().body == FILES[text]
    assert tomllib.loads(scenario.to_toml())["body"] == tomllib.loads(text)  # in the user's own words


def test_every_kind_is_here_or_was_before() -> None:
    said = {tomllib.loads(text)["kind"] for text in FILES}
    before = {"solid-sphere", "hollow-sphere", "sphere", "sphere-with-moment", "cylinder", "hoop", "weighted-cylinder"}
    assert said | before == set(KINDS["body"])


def test_every_key_of_a_new_kind_says_what_it_is() -> None:
    plain = {"kind", "radius", "mass"}  # which say it themselves
    for table in KINDS["body"].values():
        for key, field in table.model_fields.items():
            assert key in plain or field.description, f"{table.__name__}.{key}"


BODIES = [
    *FILES.values(),
    tr.Body.solid_sphere(1, 1),
    tr.Body.sphere(1, 1, 0.3),
    tr.Body(1, tr.Isotropic(0.3), tr.Sphere(1)),
    tr.Body(1, tr.Tensor(0.1, 0.2, 0.25, 0.01, 0.02, 0.03), tr.Sphere(1)),
    tr.Body.weighted_cylinder(0.05, 0.3, 0.1, 0.04),
    tr.Body(1, tr.Isotropic(0.2), tr.CylinderShape(1)),
    tr.Body.hoop(0.3, 1),
    tr.Body.half_cylinder(0.1, 1, moment_of_inertia=0.005, centre=(0.06, 0, 0)),
    tr.Body.hemisphere(0.1, 1, moments=(0.004, 0.004, 0.005), centre=(0, 0, 0.05)),
    tr.Body(1, tr.Principal(0.004, 0.004, 0.005), tr.Hemisphere(0.1, (0, 0, 0))),
    tr.Body(2, tr.Principal(1, 2, 2.5), tr.Disc(2, (0.1, 0, 0))),
    tr.Body(2, tr.Principal(1, 2, 2.5), tr.Torus(0.1, 0.02)),
    tr.Body.ellipsoid((0.2, 0.03, 0.02), 1),
    tr.Body.shape_formula("0.05 + 0.01*nu_x*nu_y - 0.003*nu_z", mass=1, moments=(1e-3, 1e-3, 1e-3)),
]


@pytest.mark.parametrize("body", BODIES, ids=lambda body: f"{type(body.shape).__name__}, {type(body.inertia).__name__}")
def test_a_body_made_in_python_comes_back_to_the_last_digit(body: tr.Body) -> None:
    text = layout({"body": body_words(body)})
    assert ScenarioFile.read({**tomllib.loads(text), **rest(body)}).system().body == body


def test_what_a_file_cannot_hold_is_refused() -> None:
    import numpy as np

    class Own(tr.Shape):
        """A shape that only this test knows."""

    for body in (
        tr.Body(1, tr.Isotropic(1), Own()),
        tr.Body(1, tr.Principal(1, 1, 1.5), tr.CylinderShape(1)),  # to roll straight, it needs one moment only
    ):
        with pytest.raises(ScenarioError, match="kind that the scenario format has words for"):
            body_words(body)
    with pytest.raises(ScenarioError, match="must be one number"):
        body_words(tr.Body.disc(np.array([0.1, 0.2]), mass=1.0))


@pytest.mark.parametrize(
    ("body", "key", "remedy"),
    [
        ('kind = "disc"\nradius = 1', "body.mass", "must be given, or `density`; got nothing"),
        ('kind = "disc"\nradius = 1\nmass = 1\ndensity = 1', "body.density", "Give one of the two"),
        ('kind = "disc"\nradius = 1\ndensity = 1', "body.density", "needs `thickness`"),
        ('kind = "disc"\nradius = 1\nmass = 1\nthickness = "-1 mm"', "body.thickness", "must not be negative"),
        ('kind = "half-cylinder"\nradius = 1\ndensity = "1 g"', "body.density", "7.8 g/cm^3"),
        ('kind = "half-cylinder"\nradius = 1\ndensity = 1', "body.density", "needs `length`"),
        ('kind = "torus"\nradius = 1\nmass = 1\nrim_radius = "2 m"', "body.rim_radius", "got '2 m'"),
        (
            'kind = "ellipsoid"\nsemi_axes = [1, 2]\nmass = 1',
            "body.semi_axes",
            'Write for instance ["25 mm", "25 mm"',
        ),
        ('kind = "ellipsoid"\nsemi_axes = [1, 2, 3]\nmass = 1\nmoments = [1, 2, 4]', "body.moments", "triangle rule"),
        ('kind = "ellipsoid"\nsemi_axes = [1, 2, 3]\nmass = 1\nturm = 1', "body.turm", "Did you mean 'turn'"),
        ('kind = "eccentric-sphere"\nradius = 1\nmass = 1', "body.moments", "must be given"),
        (
            'kind = "eccentric-sphere"\nradius = 1\nmass = 1\nmoments = [1, 1, 1]\ncentre = ["1 m", 0, 0]',
            "body.centre",
            "less than the radius",
        ),
        (
            'kind = "formula"\nsupport_function = 3\nmass = 1',
            "body.support_function",
            "must be a formula in nu_x, nu_y, nu_z",
        ),
        ('kind = "formula"\nsupport_function = "0.1 + nu"\nmass = 1', "body.support_function", "Not allowed: nu"),
        ('kind = "formula"\nsupport_function = "0.1*sin(nu_x)"\nmass = 1', "body.support_function", "at nu = "),
        ('kind = "coin"\nradius = 1\nmass = 1', "body.kind", "There are: solid-sphere"),
    ],
    ids=lambda value: value.splitlines()[0] if "\n" in value else "",
)
def test_one_message_names_the_key_and_the_remedy(body: str, key: str, remedy: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        ScenarioFile.read({"body": tomllib.loads(body), **REST})
    assert caught.value.key == key
    assert remedy in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_copy_builds_anew() -> None:
    scenario = ScenarioFile.read({"body": {"kind": "solid-sphere", "radius": 0.02, "mass": 0.1}, **REST})
    assert (scenario.body.build().mass, scenario.support.build().friction) == (0.1, None)
    body = scenario.body.model_copy(update={"mass": 0.2})
    support = scenario.support.model_copy(update={"friction": 0.3})
    assert (body.build().mass, support.build().friction) == (0.2, 0.3)
    assert scenario.model_copy(update={"body": body, "support": support}).system().body.mass == 0.2
