"""The charge in crossed fields that moves as a ball on a turntable does, as a scene."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..views.scene.header import body_table
from ..views.scene.sphere import Array, sphere_scene
from .limits import MOST_SAMPLES

if TYPE_CHECKING:
    from ..analysis.analogy import Twin
    from ..simulation.simulate import Scenario
    from ..views.scene import Scene

_SIZE = 0.6  # of the charge as it is drawn, over the radius of the ball


def charge_scene(scenario: Scenario, samples: int | None = None) -> Scene:
    """Return the charge that moves as the ball of a scenario, in step with it.

    Examples
    --------
    >>> import trundle as tr
    >>> charge_scene(tr.Scenario.load("tilted-turntable")).header["kind"]
    'charge'
    """
    from ..analysis.analogy import twin
    from ..analysis.analogy.table import rows, settings

    pair = twin(scenario)
    duration = pair.shown_duration
    own = math.ceil(duration / float(scenario.timing.every)) + 1
    time = np.linspace(0.0, duration, samples or min(max(own, 2), MOST_SAMPLES))
    radius = _SIZE * float(pair.ball.radius)
    particle, columns = pair.particle, _columns(pair, time, radius)
    (ex, ey), b = particle.electric_field, particle.magnetic_field
    drift = particle.drift_velocity if b or particle.resistance else None
    gyrates = bool(b) and not particle.resistance
    header = {
        "kind": "charge",
        "title": f"{pair.title}: the charge in crossed fields" if pair.title else "A charge in crossed fields",
        "body": body_table("charge", "Charge", radius, particle.mass, noun="charge"),
        "E": [ex, ey, 0.0],
        "B": [0.0, 0.0, b],
        "charge": particle.charge,
        "resistance": particle.resistance,
        "slow_motion": pair.slow_motion,
        "gyration_rate": particle.gyration_rate,
        "larmor_radius": particle.larmor_radius if gyrates else None,
        "drift": None if drift is None else [*drift, 0.0],
        "table": [
            dict(zip(("name", "ball", "ball_value", "charge", "charge_value"), row, strict=True)) for row in rows(pair)
        ],
        "settings": [{"name": name, "value": value} for name, value in settings(pair)],
        "apart": pair.largest_difference(duration),
        "rounding": pair.rounding(duration),
    }
    return sphere_scene(radius, columns, header)


def _columns(pair: Twin, time: Array, radius: float) -> dict[str, Array]:
    particle, own = pair.particle, time / pair.slow_motion
    x, y = particle.position_at(own)
    vx, vy = (part / pair.slow_motion for part in particle.velocity_at(own))
    still = np.zeros_like(time)
    (ex, ey), q, b = particle.electric_field, particle.charge, particle.magnetic_field
    pace = pair.slow_motion
    columns: dict[str, Any] = {
        "time": time,
        "position": np.column_stack([x, y, still + radius]),
        "velocity": np.column_stack([vx, vy, still]),
        "electric_force": np.column_stack([still + q * ex, still + q * ey, still]),
        "magnetic_force": np.column_stack([q * b * vy * pace, -q * b * vx * pace, still]),
    }
    if b and not particle.resistance:
        cx, cy = particle.guiding_centre(own)
        columns["guiding_centre"] = np.column_stack([cx, cy, still + radius])
    return columns
