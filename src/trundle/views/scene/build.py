"""A run as a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...errors import InvalidValueError
from ...solve.exact.formula import formula_of
from ...solve.samples import Samples
from .body_mesh import body_mesh
from .columns import UNITS, columns_of, guiding_centre, material, moves, pose_of
from .curves import curves_of
from .findings import findings_of
from .header import header_of, radius_about_centre
from .headline import headline_of
from .instants import MOST, flying, shown
from .support_mesh import Ground, ground_of
from .wire import Scene

if TYPE_CHECKING:
    from ...simulation.trajectory import Trajectory


def scene_of(
    run: Trajectory,
    samples: int | None = None,
    with_card: bool = False,
    *,
    seconds: float | None = None,
    curves: bool = False,
) -> Scene:
    """Return what a viewer needs to draw a run; `curves`: and what may be drawn of it over time.

    Examples
    --------
    >>> import trundle as tr
    >>> scene = scene_of(tr.Scenario.load("level-turntable-nudged").run())
    >>> scene.header["body"]["name"], scene.columns["position"].shape[1]
    ('Solid sphere', 3)
    """
    if samples is not None and (isinstance(samples, bool) or not isinstance(samples, int) or samples < 2):
        raise InvalidValueError("samples", "must be a whole number from 2 on", samples)
    run = run.in_frame("support")
    at = shown(run, MOST if samples is None else samples)
    body = body_mesh(run.system.body)
    form = run.closed_form
    columns = columns_of(at)
    state = at.support(run.system)
    if moves(run.system):
        columns |= pose_of(run.system, at, state)
    columns |= guiding_centre(run, form, at)
    ground = _ground(run, at, material(at, state, at.contact), radius_about_centre(body.vertices))
    header = header_of(run, ground, radius_about_centre(body.vertices))
    if curves:
        header["curves"], more = curves_of(run.system, at)
        columns |= more
    columns |= body.columns("body", "body_pattern") | ground.mesh.columns("support", "support_marks")
    found = findings_of(run.system, run.start, run.samples, form)
    header |= {
        "seconds": seconds,
        "findings": [one.as_dict() for one in found],
        "headline": headline_of(run.system, run.samples, found),
        "formula": formula_of(run.system, form),
        "guiding_centre": "guiding_centre" in columns,
        "card": run.card().as_dict() if with_card else None,
    }
    return Scene(header, columns, {name: unit for name, unit in UNITS.items() if name in columns})


def _ground(run: Trajectory, at: Samples, contact: np.ndarray, radius: float) -> Ground:
    support, touching = run.system.support, ~flying(at)
    turns = moves(run.system) and support.motion.turns
    # Below a flight there is a plane too, seen to be flown over.
    some = touching.any() and not support.surface.flat
    return ground_of(support.surface, turns, contact[touching] if some else contact, radius)
