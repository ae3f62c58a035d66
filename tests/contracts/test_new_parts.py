"""A new shape of body, surface, motion, load and closed form, each one file and what names it, are known everywhere.

They are written into a copy of the package, and the copy is used as its users would.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import trundle

SURFACE = '''
from dataclasses import dataclass
from typing import Annotated

from ... import wording
from ..parts import POSITIVE, Number
from ..scalars import Scalar, namespace
from .over_plane import OverPlane


@dataclass(frozen=True)
class EllipticFunnel(OverPlane):
    """A funnel z = √(x²/p² + y²/q² + 1) − 1, steeper along one axis than along the other."""

    first: Annotated[Scalar, Number("length", POSITIVE, "Along the first axis.", "30 cm")]
    second: Annotated[Scalar, Number("length", POSITIVE, "Along the second axis.", "40 cm")]
    kind = "elliptic-funnel"
    where, noun, ground = "in", "elliptic funnel", "funnel"
    axisymmetric = False

    def key_numbers(self):
        return [f"scales {wording.length(self.first, self.second)}"]

    def height(self, x, y):
        square = (x / self.first) ** 2 + (y / self.second) ** 2
        return 0.1 * (namespace(square).sqrt(square + 1.0) - 1.0)
'''
MOTION = '''
from dataclasses import dataclass
from typing import Annotated

from ... import wording
from ..algebra import ZERO, Matrix, Vector
from ..parts import Number
from ..scalars import Scalar, namespace
from .base import Motion, SupportState


@dataclass(frozen=True)
class Heave(Motion):
    """A support that goes up and down, A sin νt."""

    amplitude: Annotated[Scalar, Number("length", said="Up and down.", example="1 mm")]
    rate: Annotated[Scalar, Number("angular velocity", example="5 rad/s")]
    kind = "heave"
    way = "heaving"
    turns = False

    def key_numbers(self, ground, own):
        return [f"{ground} heaves by {wording.length(self.amplitude)}"]

    @property
    def fastest_rate(self):
        return abs(self.rate)

    def at(self, time):
        xp = namespace(self.rate * time)
        s, c = xp.sin(self.rate * time), xp.cos(self.rate * time)
        up = Vector(0.0, 0.0, 1.0) * self.amplitude
        return SupportState(
            Matrix.identity(), up * s, up * (self.rate * c), up * (-(self.rate * self.rate) * s), ZERO, ZERO
        )
'''
LOAD = '''
from dataclasses import dataclass
from typing import Annotated

from ... import wording
from ..parts import NOT_NEGATIVE, Number
from ..scalars import Scalar
from .base import Load


@dataclass(frozen=True)
class Tether(Load):
    """A soft spring that pulls the centre of mass to the origin, −k r."""

    stiffness: Annotated[Scalar, Number("number", NOT_NEGATIVE, "k, N/m.", 0.2)]
    kind = "tether"
    symmetric = True
    leaves_spin = True

    def key_numbers(self):
        return [f"tether {wording.short(float(self.stiffness), 3)} N/m"]

    def force(self, motion):
        return motion.position * -self.stiffness

    def potential(self, motion):
        return motion.position.dot(motion.position) * (0.5 * self.stiffness)
'''
SHAPE = '''
from dataclasses import dataclass
from typing import Annotated

from ... import wording
from ..algebra import Matrix, Vector
from ..scalars import Scalar, namespace
from .base import RADIUS, Shape


@dataclass(frozen=True)
class Spheroid(Shape):
    """An ellipsoid of revolution about the third axis."""

    noun = "spheroid"
    equator: Annotated[Scalar, RADIUS]
    pole: Annotated[Scalar, RADIUS]
    axisymmetric = True

    def key_numbers(self):
        return [f"spheroid {wording.length(self.equator, self.pole)}"]

    def _reached(self, nu):
        a, c = self.equator * self.equator, self.pole * self.pole
        stretched = Vector(a * nu.x, a * nu.y, c * nu.z)
        h = namespace(*stretched).sqrt(nu.dot(stretched))
        return stretched / h, h

    def support_map(self, nu):
        return self._reached(nu)[0]

    def support_gradient(self, nu):
        x, h = self._reached(nu)
        a, c = self.equator * self.equator, self.pole * self.pole
        return (Matrix.diagonal(a, a, c) - Matrix.outer(x, x)) * (1.0 / h)
'''
BUILDER = '''
    @classmethod
    @builder("spheroid", Spheroid)
    def spheroid(
        cls,
        equator: Annotated[Any, Number("length", POSITIVE, "Half its width.", "3 cm")],
        pole: Annotated[Any, Number("length", POSITIVE, "Half its height.", "2 cm")],
        mass: MassOr = None,
        density: DensityOr = None,
    ) -> Self:
        """Make a homogeneous ellipsoid of revolution."""
        m = mass_of(mass, density, 4 / 3 * math.pi * equator * equator * pole)
        across = m * (equator * equator + pole * pole) / 5
        return cls(m, Principal(across, across, 2 / 5 * m * equator * equator), Spheroid(equator, pole))

'''
FORM = '''
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ...mechanics.algebra import E_Z, Quaternion, Vector
from ...mechanics.shapes import Disc
from ...mechanics.surfaces import Plane
from ...mechanics.system import RollingSystem, State
from .base import ClosedForm
from .domain import ALONG_NORMAL, AT_REST, CONSTANT_LOADS, PRESSED, START, Condition, constant_forces, on, that
from .formula import Lines, quantity


def _aside(system: RollingSystem, start: State) -> Iterator[str]:
    axis = Quaternion(*start.orientation).matrix() @ E_Z
    Omega = Vector(*start.angular_velocity)
    if abs(axis.z) > 1e-12:
        yield "the disc leans"
    if axis.cross(Omega).norm() > 1e-12 * Omega.norm():
        yield "the disc does not turn about its own axis"


@dataclass(frozen=True)
class UprightDisc(ClosedForm):
    """A disc that rolls upright along a line: V and Ω stay as they are, and the support bears the weight."""

    radius: float
    position: tuple[float, float]
    velocity: tuple[float, float]
    force: float

    name = "disc rolling upright"
    equation = "D1"
    source = "by symmetry"
    conditions = (
        that(lambda system: isinstance(system.body.shape, Disc), "a disc", "the body is no disc"),
        on(Plane),
        AT_REST,
        CONSTANT_LOADS,
        ALONG_NORMAL,
        PRESSED,
        Condition(", upright and straight ahead", _aside, START),
    )
    never = frozenset({"lift"})

    @classmethod
    def of(cls, system, start):
        cls.check_domain(system, start)
        force, _ = constant_forces(system)
        return cls(system.body.shape.radius, start.position[:2], start.velocity[:2], -force.z)

    @property
    def period(self):
        return math.inf

    def max_rate(self, duration):
        return math.hypot(*self.velocity) / self.radius

    def motion_at(self, t):
        (x, y), (vx, vy), a, zero = self.position, self.velocity, self.radius, 0.0 * t
        return (
            Vector(x + vx * t, y + vy * t, a + zero),
            Vector(vx + zero, vy + zero, zero),
            Vector(-vy / a + zero, vx / a + zero, zero),
            Vector(zero, zero, self.force + zero),
        )

    def formulas(self, system: RollingSystem) -> Lines:
        return [("V = V_0", "|V| = " + quantity(math.hypot(*self.velocity), "m/s"))]
'''
FILES = {
    "mechanics/shapes": ("spheroid", SHAPE, "Spheroid"),
    "mechanics/surfaces": ("funnel", SURFACE, "EllipticFunnel"),
    "mechanics/motions": ("heave", MOTION, "Heave"),
    "mechanics/loads": ("tether", LOAD, "Tether"),
    "solve/exact": ("upright_disc", FORM, "UprightDisc"),
}
SCENARIO = """
[body]
kind = "spheroid"
equator = "3 cm"
pole = "2 cm"
density = "1 g/cm^3"
[support]
kind = "elliptic-funnel"
first = "30 cm"
second = 0.4
motion = {kind = "heave", amplitude = "1 mm", rate = "5 rad/s"}
[[loads]]
kind = "tether"
stiffness = 0.2
[start]
position = ["10 cm", "5 cm"]
velocity = ["0.1 m/s", 0]
[run]
duration = "0.5 s"
every = "10 ms"
"""
COIN = """
[body]
kind = "disc"
radius = "12 mm"
mass = "8 g"
[support]
kind = "plane"
[start]
position = [0, 0]
velocity = ["30 cm/s", "10 cm/s"]
attitude = ["18.434948822922 deg", "90 deg", "0 deg"]
[run]
duration = "1 s"
every = "10 ms"
"""
ASKED = """
import json, sys
import trundle as tr
from trundle.scenario.tables import KINDS
scenario = tr.Scenario.load(sys.argv[1])
run = scenario.run()
again = tr.Scenario.describe(run.system, scenario.start_state(), duration=0.5, every=0.01)
from trundle.views.plots.words import key_numbers, title_of
print(json.dumps({
    "passed": run.card().passed,
    "title": title_of(run.system),
    "numbers": key_numbers(run.system),
    "same": again.system() == run.system,
    "schema": str(tr.Scenario.schema()),
    "body": again.body.kind,
    "kinds": [list(KINDS["support"])[-1], list(KINDS["support.motion"])[-1], list(KINDS["loads"])[-1]],
    "scene": len(run.save_html(sys.argv[2]).read_bytes()) > 100_000,
}))
"""
IN_THE_LAB = """
import json
from trundle.lab import answers
from trundle.views.scene import unpack
parts = json.loads(answers.parts().body)
body, surface = parts["body"]["spheroid"], parts["support"]["elliptic-funnel"]
motion, load = parts["motion"]["heave"], parts["loads"]["tether"]
chosen = {
    "body": body["first"],
    "support": surface["first"] | {"motion": motion["first"]},
    "start": surface["start"],
    "loads": [load["first"]],
    "run": {"duration": 0.5, "every": 0.01},
}
scene = unpack(answers.simulate(chosen).body)
def nudged(kind):
    chosen["support"]["motion"] = parts["motion"][kind]["first"]
    run = unpack(answers.simulate(chosen).body)
    at = {key: run.columns[key][20].tolist() for key in ("position", "velocity", "contact", "angular_velocity")}
    at |= {"orientation": run.columns["orientation"][20].tolist(), "time": float(run.columns["time"][20])}
    return json.loads(answers.start(chosen, at, nudge=[0.0, 0.0, 0.0]).body)
print(json.dumps({
    "labels": [part["label"] for part in (body, surface, motion, load)],
    "first": [part["first"] for part in (body, surface, motion, load)],
    "start": body["start"],
    "field": surface["fields"]["first"],
    "name": scene.header["support"]["name"],
    "flat": scene.header["support"]["flat"],
    "deep": scene.header["support"]["deep"],
    "nudged": [nudged("spin"), nudged("fixed")],
}))
"""
SHOWN = """
import json, sys
import trundle as tr
from trundle.cli.expectations import expectations
from trundle.views.scene import scene_of
run = tr.Scenario.load(sys.argv[1]).run()
card, header = run.card(), scene_of(run).header
leaning = tr.Scenario.load("coin-rolling-upright")
try:
    leaning.run(method="exact")
    refused = ""
except tr.OutOfDomainError as error:
    refused = str(error)
page = run.save_html(sys.argv[2]).read_text(encoding="utf-8")
print(json.dumps({
    "method": run.method,
    "passed": card.passed,
    "card": str(card),
    "formula": header["formula"],
    "findings": header["findings"],
    "page": [word in page for word in ("Disc rolling upright", "Distance from the start")],
    "refused": refused,
    "expected": expectations(tr.Scenario.load(sys.argv[1])),
}))
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package in which the parts are written."""
    folder = tmp_path_factory.mktemp("copy")
    shutil.copytree(Path(trundle.__file__).parent, folder / "trundle", ignore=shutil.ignore_patterns("__pycache__"))
    for family, (name, text, made) in FILES.items():
        home = folder / "trundle" / family
        (home / f"{name}.py").write_text(f'"""New."""\n\nfrom __future__ import annotations\n{text}', encoding="utf-8")
        listed, line = home / "__init__.py", f"from .{name} import {made}\n"
        text = listed.read_text(encoding="utf-8")
        listed.write_text(re.sub(r"(?m)^(from \.base import .+\n)", rf"\1{line}", text), encoding="utf-8")
    body = folder / "trundle" / "mechanics" / "bodies" / "body.py"
    builds = body.read_text(encoding="utf-8").replace("    Shape,\n", "    Shape,\n    Spheroid,\n", 1)
    first, there, rest = builds.partition("\n    @classmethod\n    @builder(")
    body.write_text(first + BUILDER + there.lstrip("\n") + rest, encoding="utf-8")
    (folder / "new.toml").write_text(SCENARIO, encoding="utf-8")
    (folder / "coin.toml").write_text(COIN, encoding="utf-8")
    return folder


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    surroundings = os.environ | {"PYTHONPATH": str(folder), "MPLBACKEND": "Agg", "NO_COLOR": "1"}
    return subprocess.run(  # noqa: S603
        [sys.executable, *words], cwd=folder, env=surroundings, capture_output=True, text=True, check=False, timeout=300
    )


def test_new_parts_are_known_in_files_figures_and_scenes(copy: Path) -> None:
    done = run(copy, "-c", ASKED, "new.toml", "new.html")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["passed"], found
    assert found["same"]
    assert found["scene"]
    assert found["title"] == "Spheroid in a heaving elliptic funnel"
    assert {"table heaves by 1 mm", "funnel heaves by 1 mm"} & set(found["numbers"].split("  ·  "))
    assert "scales 30 cm × 40 cm" in found["numbers"]
    assert "tether 0.2 N/m" in found["numbers"]
    assert "spheroid 3 cm × 2 cm" in found["numbers"]
    assert found["body"] == "spheroid"
    for word in ("elliptic-funnel", "heave", "tether", "Along the first axis.", "Half its height.", "Up and down."):
        assert word in found["schema"]


def test_new_parts_are_in_the_tables_of_the_documents(copy: Path) -> None:
    shutil.copy(Path(__file__).parents[1] / "documents" / "tables.py", copy)
    done = run(copy, "-c", "from tables import TABLES; print(*(make() for make in TABLES.values()))")
    assert done.returncode == 0, done.stderr
    for row in (
        "| `spheroid` | `spheroid` | A homogeneous ellipsoid of revolution. | `equator`, `pole`, `mass`, `density` |",
        "| `pole` | `spheroid` | Half its height. | m | required | positive |",
        "| `first` | `elliptic-funnel` | Along the first axis. | m | required | positive |",
        "| `stiffness` | `tether` | k, N/m. | 1 | required | 0 or more |",
        "| `heave` | `Heave` | A support that goes up and down, A sin νt. | `amplitude`, `rate` |",
        "| D1 | disc rolling upright | a disc, on a plane",
    ):
        assert row in done.stdout


def test_new_parts_run_on_the_command_line(copy: Path) -> None:
    done = run(copy, "-m", "trundle", "run", "new.toml", "-o", "out")
    assert done.returncode == 0, done.stderr
    assert {path.suffix for path in (copy / "out").iterdir()} >= {".png", ".nc"}


def test_a_wrong_value_of_a_new_part_is_named(copy: Path) -> None:
    (copy / "bad.toml").write_text(SCENARIO.replace('first = "30 cm"', "first = -1"), encoding="utf-8")
    done = run(copy, "-m", "trundle", "run", "bad.toml", "-o", "none")
    assert done.returncode == 2
    assert "`support.first` must be positive; got -1" in done.stderr
    assert not (copy / "none").exists()


def test_new_parts_can_be_chosen_in_the_lab(copy: Path) -> None:
    done = run(copy, "-c", IN_THE_LAB)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["labels"] == ["Spheroid", "Elliptic funnel", "Heave", "Tether"]
    assert found["first"] == [
        {"kind": "spheroid", "equator": "3 cm", "pole": "2 cm", "mass": "200 g"},
        {"kind": "elliptic-funnel", "first": "30 cm", "second": "40 cm"},
        {"kind": "heave", "amplitude": "1 mm", "rate": "5 rad/s"},
        {"kind": "tether", "stiffness": 0.2},
    ]
    assert found["start"] == {"attitude": [0, "20 deg", 0], "velocity": [0, 0]}, "it is no ball: it leans and rocks"
    shown = {"label": "First", "said": "Along the first axis.", "unit": "cm", "min": 0.03, "max": 3.0, "decades": True}
    assert shown.items() <= found["field"].items()
    assert (found["name"], found["flat"], found["deep"]) == ("Heaving elliptic funnel", False, True)
    turning, resting = found["nudged"]
    assert turning["time"] == 0.2, "an uneven surface on a turntable is not taken for a round one"
    assert "time" not in resting


def test_a_new_closed_form_is_chosen_checked_and_shown(copy: Path) -> None:
    done = run(copy, "-c", SHOWN, "coin.toml", "coin.html")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["method"] == "exact"
    assert found["passed"], found["card"]
    assert "closed form D1, disc rolling upright (by symmetry)" in found["card"]
    assert "closed form against Taylor" in found["card"]
    assert found["formula"] == {
        "name": "Disc rolling upright",
        "source": "D1",
        "latex": "V = V_0",
        "numbers_latex": r"|V| = 0.3162\,\mathrm{m/s}",
    }
    way = next(row for row in found["findings"] if row["name"] == "Distance from the start")
    assert way["predicted"] == pytest.approx(0.1**0.5, rel=1e-12)
    assert way["difference"] < 1e-12
    assert all(found["page"])
    assert found["expected"][0] == ["closed form", "D1, disc rolling upright"]
    assert found["expected"][1][1] == "(0.3, 0.1, 0.012) m"
    assert "D1 (disc rolling upright) covers a disc, on a plane at rest" in found["refused"]
    assert "Outside it: the disc leans" in found["refused"]
