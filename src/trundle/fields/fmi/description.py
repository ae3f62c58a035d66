"""What a unit says of itself: modelDescription.xml and buildDescription.xml of FMI 3.0."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from importlib.metadata import version
from itertools import count
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np

from ..field import VectorField

IDENTIFIER = "trundle_model"
_IN_BASE = {"N": "kg*m/s^2", "J": "kg*m^2/s^2"}
_BASE = ("kg", "m", "s", "rad")


def model_description(field: VectorField, y: np.ndarray, begin: float, title: str, token: str) -> str:
    """Return modelDescription.xml; the value references are those of fmi3.c."""
    ends = ", ".join(field.event_names)
    left_out = f"Only {field.phase} is in it: the simulation ends where another begins" + (
        f" ({ends})." if ends else "."
    )
    root = ET.Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName=title,
        instantiationToken=token,
        description=left_out,
        generationTool=f"trundle {version('trundle')}",
        variableNamingConvention="flat",
    )
    ET.SubElement(root, "ModelExchange", modelIdentifier=IDENTIFIER, canGetAndSetFMUState="true")
    able = ("canHandleVariableCommunicationStepSize", "canGetAndSetFMUState", "mightReturnEarlyFromDoStep")
    ET.SubElement(root, "CoSimulation", {"modelIdentifier": IDENTIFIER} | dict.fromkeys(able, "true"))
    rates = [f"{unit}/s" if unit else "1/s" for unit in field.state_units]
    units = {*field.state_units, *rates, *field.parameter_units, *field.input_units, *field.output_units, "s"}
    _define(root, sorted(units - {""}))
    ET.SubElement(root, "DefaultExperiment", startTime=repr(begin), stopTime=repr(begin + 1.0))
    variables, structure = ET.SubElement(root, "ModelVariables"), ET.SubElement(root, "ModelStructure")
    references = count()

    def add(names: Iterable[str], units: Iterable[str], values: Any = None, **said: str) -> list[int]:
        found = []
        for i, (name, unit) in enumerate(zip(names, units, strict=True)):
            found.append(next(references))
            told = {"name": name, "valueReference": str(found[-1]), **said}
            told |= {"unit": unit} if unit else {}
            told |= {"start": repr(float(values[i]))} if values is not None else {}
            ET.SubElement(variables, "Float64", told)
        return found

    add(["time"], ["s"], causality="independent", variability="continuous")
    local: dict[str, Any] = {"causality": "local", "variability": "continuous"}
    states = add(field.state_names, field.state_units, y, **local, initial="exact")
    derivatives = add([f"der({name})" for name in field.state_names], rates, **local)
    for state, element in zip(states, list(variables)[derivatives[0] :], strict=True):
        element.set("derivative", str(state))
    add(field.parameter_names, field.parameter_units, field.parameters, causality="parameter", variability="tunable")
    add(field.input_names, field.input_units, field.inputs, causality="input", variability="continuous")
    event_names = [f"event.{name}" for name in field.event_names]
    events = add(event_names, [""] * len(event_names), **local)
    outputs = add(field.output_names, field.output_units, causality="output", variability="continuous")
    for kind, found in (
        ("Output", outputs),
        ("ContinuousStateDerivative", derivatives),
        ("InitialUnknown", [*derivatives, *outputs]),
        ("EventIndicator", events),
    ):
        for reference in found:
            ET.SubElement(structure, kind, valueReference=str(reference))
    return _text(root)


def _define(root: ET.Element, units: list[str]) -> None:
    """Say what each unit is in those of the SI."""
    definitions = ET.SubElement(root, "UnitDefinitions")
    for unit in units:
        powers = _powers(unit)
        told = {base: str(powers[base]) for base in _BASE if powers[base]}
        ET.SubElement(ET.SubElement(definitions, "Unit", name=unit), "BaseUnit", told)


def _powers(unit: str) -> Counter[str]:
    """Return the powers of the base units: of "kg*m^2/s", 1, 2 and −1."""
    found: Counter[str] = Counter()
    for sign, factor, power in re.findall(r"([*/]?)([A-Za-z]+)(?:\^(\d+))?", unit):
        times = int(power or 1) * (-1 if sign == "/" else 1)
        for base, many in (_powers(_IN_BASE[factor]) if factor in _IN_BASE else {factor: 1}).items():
            found[base] += many * times
    return found


def build_description(sources: list[str]) -> str:
    """Return buildDescription.xml."""
    root = ET.Element("fmiBuildDescription", fmiVersion="3.0")
    build = ET.SubElement(root, "BuildConfiguration", modelIdentifier=IDENTIFIER)
    told = {"language": "C99", "compiler": "gcc", "compilerOptions": "-ffp-contract=off"}
    kept = ET.SubElement(build, "SourceFileSet", told)
    for name in sources:
        ET.SubElement(kept, "SourceFile", name=name)
    ET.SubElement(build, "Library", name="m")
    return _text(root)


def _text(root: ET.Element) -> str:
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"
