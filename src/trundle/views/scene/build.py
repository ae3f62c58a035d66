"""A run as a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...errors import InvalidValueError
from ...mechanics.motions import SupportState
from ...mechanics.system import RollingSystem
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
    places: np.ndarray | None = None,
) -> Scene:
    """Return what a viewer needs to draw a run.

    `curves`: and what may be drawn of it over time, as on every page that has its card. `places`: where other runs
    touch the ground, if they share it.

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
    places = _places(run, at, state) if places is None else places
    ground = ground_under(run.system, places, radius_about_centre(body.vertices))
    header = header_of(run, ground, radius_about_centre(body.vertices))
    if curves or with_card:
        header["curves"], more = curves_of(run.system, at)
        columns |= more
    columns |= body.columns("body") | ground.mesh.columns("support")
    found = findings_of(run.system, run.start, run.samples, form)
    header |= {
        "seconds": seconds,
        "findings": [one.as_dict() for one in found],
        "headline": headline_of(run.system, run.samples, found),
        "formula": formula_of(run.system, form),
        "guiding_centre": "guiding_centre" in columns,
        "card": run.card().as_dict() if with_card else None,
    }
    units = {name: unit for name, unit in UNITS.items() if name in columns}
    return Scene(header, columns, units, {"body": body, "support": ground.mesh})


def places_of(run: Trajectory) -> np.ndarray:
    """Return where a run needs its ground, (n, 3), in the support's own frame, m.

    Examples
    --------
    >>> import trundle as tr
    >>> places_of(tr.Scenario.load("level-turntable-nudged").run()).shape[1]
    3
    """
    run = run.in_frame("support")
    at = shown(run, MOST)
    return _places(run, at, at.support(run.system))


def _places(run: Trajectory, at: Samples, state: SupportState) -> np.ndarray:
    contact, touching = material(at, state, at.contact), ~flying(at)
    # Below a flight there is a plane too, seen to be flown over.
    return contact[touching] if touching.any() and not run.system.support.surface.flat else contact


def ground_under(system: RollingSystem, places: np.ndarray, radius: float) -> Ground:
    """Return the ground of a system about some places, for a body of some size."""
    support = system.support
    return ground_of(support.surface, moves(system) and support.motion.turns, places, radius)
