"""Any scenario that the format has words for: each table, key and unit is found in the format's own classes."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import cache
from random import Random
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from trundle.errors import TrundleError
from trundle.scenario import ScenarioFile
from trundle.scenario.fields import Coordinate, Measure, Measures, Varying
from trundle.scenario.tables import Table
from trundle.scenario.tables.of_parts import FormulaText, ListOfLengths, Worded
from trundle.units import UNITS

from .leaves import NUMBER, alternatives, kind_of, notes_of, rounded, tables_of

_TRIES = 300  # of a table whose numbers must suit each other
_KNOTS = 6  # of a table of heights

# What a tabletop experiment has, from and to, SI. Of a body, what depends on its size and weight is a share of that.
_SIZES = {
    "mass": (0.005, 2.0),
    "time": (0.01, 2.0),
    "angle": (0.005, 1.5),
    "velocity": (0.02, 2.0),
    "acceleration": (1.0, 30.0),
    "angular velocity": (0.1, 30.0),
    "force": (0.003, 0.5),  # of the weight
    "torque": (0.003, 0.3),  # of the weight, an arm of the body's size
    "inertia": (0.2, 0.5),  # of m a²
    "damping": (0.01, 3.0),  # of m/s
    "quadratic damping": (0.001, 0.3),  # of m/a
    "rotational damping": (0.01, 3.0),  # of m a²/s
    "density": (300.0, 8000.0),
    "number": (0.02, 1.0),
}
_LENGTHS = {"body": (0.01, 0.2), "support": (0.1, 2.0), "motion": (0.001, 0.1), "loads": (1e-5, 2e-3)}
_CHANCES = {"friction": 0.6, "motion": 0.6, "applied_loads": 0.5, "velocity": 0.6}  # that a key stands there
_CHANCE = 0.3


@dataclass
class Draw:
    """A random scenario, on the way.

    Parameters
    ----------
    random : Random
        Seeded.
    part : str
        "body", "support", "motion", "loads" or "start": what is being drawn.
    mass, length : float
        Of the body, kg and m, as soon as they are known.
    """

    random: Random
    part: str = "start"
    mass: float = 0.1
    length: float = 0.05

    def between(self, low: float, high: float) -> float:
        """Return a number as likely of one size as of another."""
        return float(low * (high / low) ** self.random.random())

    def scale(self, measure: Measure, kind: str) -> float:
        """Return a size for a number of a kind, in SI."""
        if kind == "length":
            low, high = _LENGTHS.get(self.part, (0.003, 0.3))
            small = 0.2 if self.part == "body" and measure.sign == "any" else 1.0
            return self.between(low, high) * small
        size = self.between(*_SIZES[kind])
        if self.part == "loads" and kind == "mass":  # of the air that a Magnus force moves
            return size * 0.01
        if self.part == "motion" and kind == "inertia":  # of a table
            return size * self.between(1e-3, 1.0)
        if self.part == "body" and kind == "inertia" and measure.sign == "any":  # a product of inertia
            size *= 0.1
        m, a = self.mass, self.length
        shares = {"force": 9.8 * m, "torque": 9.8 * m * a, "inertia": m * a * a, "damping": m}
        shares |= {"quadratic damping": m / a, "rotational damping": m * a * a}
        return size * shares.get(kind, 1.0)

    def number(self, measure: Measure) -> Any:
        """Return a number, quantity, formula or word that the format takes."""
        if isinstance(measure, Worded) and self.random.random() < 0.5:
            return self.random.choice(measure.words)
        kind = measure.kind
        if isinstance(measure, Coordinate):
            kind = self.random.choice([measure.kind, measure.otherwise])
        if isinstance(measure, Varying) and self.random.random() < 0.4:
            return self.course(self.scale(measure, kind))
        if kind == "angle" and self.random.random() < 0.2:
            special = self.random.choice(["90 deg", "45 deg", "-90 deg", "180 deg"])
            if _allows(measure, special):
                return special
        for _ in range(_TRIES):
            value = self.scale(measure, kind)
            if measure.sign == "any":
                value *= self.random.choice([1, -1])
            if measure.sign != "positive" and self.random.random() < 0.1:
                value = 0.0
            told: Any = rounded(value)
            if UNITS[kind][0] and not isinstance(measure, Coordinate) and self.random.random() < 0.3:
                told = f"{told!r} {UNITS[kind][0]}"
            if _allows(measure, told):
                return told
        raise NotDrawnError(f"a {kind}")

    def course(self, size: float) -> str:
        """Return a formula in the time."""
        a, b, w = rounded(size), rounded(size * self.between(0.1, 3)), rounded(self.between(0.3, 20))
        return self.random.choice(
            [f"{a}*sin({w}*t)", f"{a}*cos({w}*t) + {b}", f"{a}*exp(-{w}*t)", f"{a} + {b}*t", f"{a}*(1 - exp(-t))",
             f"{a}*t**2", f"{a}*abs(t - {w})", f"{a}*sqrt(1 + {w}*t)", f"-{a}*t*exp(-t)"]
        )  # fmt: skip

    def formula(self, example: str, variables: tuple[str, ...]) -> str:
        """Return a formula that is made like an example, with other numbers and variables, and more terms perhaps."""
        text = NUMBER.sub(lambda found: repr(rounded(float(found[0]) * self.between(1 / 3, 3))), example)
        text = re.sub("|".join(sorted(variables, key=len, reverse=True)) or "$^", lambda _: self.pick(variables), text)
        if self.part != "body" and variables and self.random.random() < 0.6:  # a body must stay convex
            text += f" + {self.term(variables)}"
        return text

    def pick(self, variables: tuple[str, ...]) -> str:
        return self.random.choice(variables)

    def term(self, variables: tuple[str, ...]) -> str:
        """Return a term in some variables, about a tenth of one in size."""
        u, v = self.pick(variables), self.pick(variables)
        c, k = rounded(self.between(0.005, 0.5) * self.random.choice([1, -1])), rounded(self.between(0.5, 10))
        return self.random.choice(
            [f"{c}*{u}**2", f"{c}*{u}*{v}", f"{c}*sin({k}*{u})", f"{c}*cos({k}*{u})*cos({k}*{v})", f"{c}*abs({u})",
             f"{c}*sqrt({u}**2 + 0.01)", f"{c}*exp({u})", f"{c}*log(0.3 + {u})", f"{c}*{u}**4", f"{c}*{u}"]
        )  # fmt: skip

    def heights(self, lengths: ListOfLengths) -> list[Any]:
        """Return distances that ascend, heights, or rows of heights."""
        size, power = self.between(0.1, 1.0), self.random.choice([1, 2])
        begin = self.random.choice([0.0, -size]) if power == 1 else 0.0
        steps = [i / (_KNOTS - 1) for i in range(_KNOTS)]
        if lengths.rows:
            a, b = self.random.uniform(-0.3, 0.3), self.random.uniform(-0.3, 0.3)
            return [[rounded(size * (a * s * s + b * s * t + 0.1 * t * t)) for t in steps] for s in steps]
        return [rounded(begin + (size - begin) * step**power) for step in steps]

    def table(self, kinds: list[type[Table]]) -> dict[str, Any]:
        """Return a table of one of some kinds, its numbers suiting each other."""
        chosen = self.random.choice(kinds)
        for _ in range(_TRIES):
            drawn = self.fields(chosen)
            try:
                chosen.model_validate(drawn)
            except (ValidationError, TrundleError):
                continue
            return drawn
        raise NotDrawnError(chosen.__name__)

    def fields(self, model: type[BaseModel]) -> dict[str, Any]:
        """Return values for the keys of a table, some of which may be left out."""
        found = {}
        for name, one in model.model_fields.items():
            if one.is_required() or self.random.random() < _CHANCES.get(name, _CHANCE):
                found[one.alias or name] = value = self.value(model, name, one)
                if self.part == "body" and name == "mass":
                    self.mass = si(value, name)
                if self.part == "body" and name == "radius":
                    self.length = si(value, "length")
        return found

    def value(self, model: type[BaseModel], name: str, one: FieldInfo) -> Any:
        """Return a value for one key."""
        tables = tables_of(one.annotation)
        if tables:
            part = name if name in ("body", "support", "motion") else "loads" if "loads" in name else self.part
            below = replace(self, part=part)
            if get_origin(one.annotation) is tuple:
                return [below.table(tables) for _ in range(self.random.choice([1, 2, 2]))]
            return below.table(tables)
        notes = notes_of(one)
        for note in notes:
            if isinstance(note, Measures):
                if note.words and self.random.random() < 0.15:
                    return self.random.choice(note.words)
                sizes = range(note.size, min(note.most or note.size, note.size + 1) + 1)
                return [self.number(note.each) for _ in range(self.random.choice(sizes))]
            if isinstance(note, Measure):
                return self.number(note)
            if isinstance(note, ListOfLengths):
                return self.heights(note)
            if isinstance(note, FormulaText):
                return self.formula(note.formula.example, note.formula.variables)
        choices = [part for part in alternatives(one.annotation) if get_origin(part) is Literal]
        if choices:
            return self.random.choice(get_args(choices[0]))
        return self.formula(one.examples[0], _variables(model, name)) if one.examples else ""


class NotDrawnError(Exception):
    """After many tries, no numbers suit each other."""


def _allows(measure: Measure, value: Any) -> bool:
    try:
        measure(value)
    except TrundleError:
        return False
    return True


def si(value: Any, kind: str) -> float:
    """Return a number or a quantity in SI."""
    return float(Measure(kind)(value))


@cache
def _variables(model: type[Table], key: str) -> tuple[str, ...]:
    """Return the variables of a formula that is a key of a table, as the format says them when it refuses one."""
    draw, fields = Draw(seeded(key), "body"), model.model_fields
    needed = [name for name, one in fields.items() if one.is_required() and name != key]
    given = {name: draw.value(model, name, fields[name]) for name in needed}
    try:
        model.model_validate({**given, **({"mass": 0.1} if "mass" in fields else {}), key: "?"})
    except ValidationError as error:
        found = re.search(r"formula in ([\w, ]+)", str(error))
        if found:
            return tuple(re.findall(r"\w+", found[1].replace(" and ", " ")))
    raise NotDrawnError(f"a formula for {key}")


def seeded(*what: object) -> Random:
    """Return a generator that gives the same for the same words."""
    return Random(" ".join(map(str, what)))  # noqa: S311


def anything(random: Random) -> dict[str, Any]:
    """Return the tables of a scenario with any body, surface, motion and loads; no start yet, and no run."""
    draw, model = Draw(random), ScenarioFile.model_fields
    found: dict[str, Any] = {"body": draw.value(ScenarioFile, "body", model["body"])}
    kinds: dict[str, Any] = {kind_of(each): each for each in tables_of(model["body"].annotation)}
    draw.mass = float(kinds[found["body"]["kind"]].model_validate(found["body"]).build().mass)
    draw.length = si(found["body"].get("radius", draw.length), "length")
    found["support"] = draw.value(ScenarioFile, "support", model["support"])
    if random.random() < _CHANCES["applied_loads"]:
        found["loads"] = draw.value(ScenarioFile, "applied_loads", model["applied_loads"])
    if random.random() < 0.15:
        found["gravity"] = random.choice([0.0, 1.62, 30.0])
    return found


def start(random: Random) -> dict[str, Any]:
    """Return any start."""
    return Draw(random).table(tables_of(ScenarioFile.model_fields["start"].annotation))


def start_key(name: str, random: Random) -> Any:
    """Return another value for a key of the start."""
    table = tables_of(ScenarioFile.model_fields["start"].annotation)[0]
    return Draw(random).value(table, name, table.model_fields[name])


def method(random: Random) -> str:
    """Return a method, mostly the one that trundle chooses."""
    run = tables_of(ScenarioFile.model_fields["timing"].annotation)[0]
    one = run.model_fields["method"]
    return str(one.default if random.random() < 0.8 else random.choice(get_args(one.annotation)))
