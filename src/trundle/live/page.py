"""A live page: one file whose motion is computed where it is opened, by the law that is printed into it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..analysis.sensitivities.keys import moved
from ..errors import OutOfDomainError, TrundleError
from ..fields.routines import FILM
from ..mechanics.parameters import parameters
from ..mechanics.system import RollingSystem
from ..scenario import ScenarioFile
from ..simulation.simulate import Scenario, simulate
from ..simulation.trajectory import Trajectory
from ..solve.samples import Progress
from ..views.scene import Scene as Drawn
from ..views.scene import ground_under, places_of, scene_of
from ..views.scene.body_mesh import body_mesh
from ..views.scene.curves import PREFIX
from ..views.scene.header import radius_about_centre
from ..views.viewer.bundle import built
from ..views.viewer.page import page_of
from . import law
from .sliders import Slider, sliders_of

_FIRST = 600  # samples of the motion that is shown until the page has its own
_LOOKED_AT = 300  # samples of a run at the end of a slider: it says where the ground is needed
_FAR = 1.5  # sizes of the motion in the file, up to which the ground is shown where other motions go
_PICTURES = (3, 5, 7)  # meshes along a slider, as few as do
_NEAR = 1e-3  # of a mesh's size: between them it is drawn so near
_MOST_BYTES = 1_500_000
_FINE = {"vertices": 2.0**-13, "normals": 2.0**-7}  # of their sizes, to which changes of them are kept


def live_page(scenario: Scenario, asked: Sequence[str] = (), *, progress: Progress | None = None) -> bytes:
    """Return a page that computes the motion of a scenario for other numbers, too.

    Parameters
    ----------
    scenario : Scenario
        What is shown.
    asked : sequence of str
        Sliders, such as "body.radius" or "support.tilt=0 deg..2 deg"; none: some are offered.
    progress : callable, optional
        Told the fraction done.

    Returns
    -------
    bytes
        HTML, for any browser and without a network.

    Raises
    ------
    OutOfDomainError
        If no page can hold the law of the scenario.
    InvalidValueError
        If a slider cannot be had.

    Examples
    --------
    >>> import trundle as tr
    >>> scenario = tr.Scenario.load("level-turntable-nudged")
    >>> page = live_page(scenario, ["support.motion.rate"])
    >>> b"worker-src blob:" in page, len(page) < 1_500_000
    (True, True)
    """
    return made(scenario, asked, progress=progress)[0]


def made(scenario: Scenario, asked: Sequence[str] = (), *, progress: Progress | None = None) -> tuple[bytes, Drawn]:
    """Return a live page, and what is drawn there first."""
    law.check(scenario)
    sliders, placed = sliders_of(scenario, asked)
    scene = _scene(scenario, sliders, progress or (lambda _: None))
    said = (scene.header["headline"] or {"said": ""})["said"]
    text = law.script_of(scenario, [one.key for one in sliders], placed, said)
    page = page_of([scene], f"{text}\n{built('live-worker.js')}")
    if len(page) > _MOST_BYTES:
        raise OutOfDomainError(
            f"The page would have {len(page) / 1e6:.1f} MB, and a live page has at most {_MOST_BYTES / 1e6:g} MB: "
            "take fewer sliders that change the shape of body or support."
        )
    return page, scene


def _scene(scenario: Scenario, sliders: Sequence[Slider], progress: Progress) -> Drawn:
    """Return what is drawn: the motion as it is in the file, and how its pictures change along each slider."""
    run = scenario.run(progress=lambda fraction: progress(fraction / (len(sliders) + 1)))
    places = [places_of(run)]
    for i, one in enumerate(sliders):
        for end in (one.low, one.high):
            at = _ended_at(scenario, {one.key.name: end})
            if at is not None:
                places.append(places_of(at))
        progress((i + 2) / (len(sliders) + 1))
    radius = radius_about_centre(body_mesh(run.system.body).vertices)
    ground = np.concatenate([places[0], *(_near(places[0], other, radius) for other in places[1:])])
    scene = scene_of(run, samples=_FIRST, with_card=True, places=ground)
    # The curves are the page's own: it has them as soon as it has computed the motion.
    columns = {name: column for name, column in scene.columns.items() if not name.startswith(PREFIX)}
    variants = []
    for i, one in enumerate(sliders):
        for kind, picture in (("body", _body), ("support", _support(ground, radius))):
            found = _variants(scenario, one, kind, picture)
            if found is not None:
                nodes, changes = found
                steps = {name: step for name, (step, _) in changes.items()}
                variants.append({"slider": i, "nodes": nodes, "steps": steps})
                columns |= {
                    f"live_{i}_{k}_{name}": row for name, (_, rows) in changes.items() for k, row in enumerate(rows)
                }
    live = {
        "sliders": [one.told for one in sliders],
        "variants": variants,
        "curves": law.curves_of(run.system),
        "film": [name for name, _ in FILM],
        "parameters": [name for name, _ in parameters(run.system)],
    }
    return Drawn({**scene.header, "curves": [], "method": "page", "live": live}, columns, scene.units)


def _near(here: Any, others: Any, radius: float) -> Any:
    """Return those of other places that are not so far away that nothing would be seen of what is here."""
    low, high = here.min(axis=0), here.max(axis=0)
    reach = _FAR * max(float(np.max(high - low)), 4 * radius)
    return others[np.all(np.abs(others - 0.5 * (low + high)) <= reach, axis=1)]


def _ended_at(scenario: ScenarioFile, values: dict[str, float]) -> Trajectory | None:
    """Return the run at an end of a slider; None where the law breaks down on its way, which the page will say."""
    system, start = moved(scenario, values)
    duration = float(scenario.timing.duration)
    try:
        return simulate(system, start, duration, duration / _LOOKED_AT, scenario=" ")
    except TrundleError:
        return None


Picture = Callable[[RollingSystem], dict[str, Any]]


def _body(system: RollingSystem) -> dict[str, Any]:
    return body_mesh(system.body).columns("body")


def _support(places: Any, radius: float) -> Picture:
    return lambda system: ground_under(system, places, radius).mesh.columns("support")


def _variants(
    scenario: ScenarioFile, slider: Slider, kind: str, picture: Picture
) -> tuple[list[float], dict[str, tuple[float, list[Any]]]] | None:
    """Return at which values a mesh is known, and what is added to it there; None where it stays as it is."""
    wanted = (f"{kind}_vertices", f"{kind}_normals")

    def at(value: float) -> dict[str, Any]:
        return picture(moved(scenario, {slider.key.name: value})[0])

    here = at(slider.key.value)
    ends = [at(end) for end in (slider.low, slider.high)]
    if all(np.array_equal(here[name], end[name]) for end in ends for name in wanted):
        return None
    sizes = dict(zip(wanted, (float(np.ptp(here[wanted[0]], axis=0).max()), 1.0), strict=True))
    for count in _PICTURES:
        nodes = _nodes(slider, count)
        meshes = [at(node) for node in nodes]
        between = [0.5 * (a + b) for a, b in itertools.pairwise(nodes)]
        others = [at(value) for value in between]
        _check(slider, kind, here, [*meshes, *others])
        weights = [_weights(nodes, value) for value in between]
        apart = max(
            float(np.abs(np.tensordot(w, [mesh[name] for mesh in meshes], 1) - other[name]).max()) / sizes[name]
            for w, other in zip(weights, others, strict=True)
            for name in wanted
        )
        if apart <= _NEAR:
            break
    changes: dict[str, tuple[float, list[Any]]] = {}
    for name in wanted:
        moved_by = [mesh[name] - here[name] for mesh in meshes]
        most = max(float(np.abs(one).max()) for one in moved_by)
        if most > 0:
            step = max(_FINE[name.partition("_")[2]] * sizes[name], most / 32_000)
            changes[name] = step, [_squeezed(one, step) for one in moved_by]
    return nodes, changes


def _nodes(slider: Slider, count: int) -> list[float]:
    """Return values along a slider through which a polynomial keeps near: Chebyshev's, and that of the file."""
    middle, half = 0.5 * (slider.low + slider.high), 0.5 * (slider.high - slider.low)
    nodes = [middle - half * math.cos(math.pi * i / (count - 1)) for i in range(count)]
    nodes[0], nodes[-1] = slider.low, slider.high
    nearest = min(range(count), key=lambda i: abs(nodes[i] - slider.key.value))
    nodes[nearest if 0 < nearest < count - 1 else 1 if nearest == 0 else count - 2] = slider.key.value
    return sorted(set(nodes))


def _weights(nodes: Sequence[float], value: float) -> list[float]:
    """Return Lagrange's weights of nodes at a value."""
    return [math.prod((value - b) / (a - b) for b in nodes if b != a) for a in nodes]


def _check(slider: Slider, kind: str, here: dict[str, Any], meshes: Sequence[dict[str, Any]]) -> None:
    """Refuse a slider along which a picture becomes another, and not the same in another shape."""
    if any(mesh[f"{kind}_vertices"].shape != here[f"{kind}_vertices"].shape for mesh in meshes):
        raise OutOfDomainError(
            f"Along the slider `{slider.key.name}` the picture of the {kind} would have to be made anew, which a live "
            f"page cannot do: let it go less far, with --slider {slider.key.name}=FROM..TO, or leave it out."
        )


def _squeezed(change: Any, step: float) -> Any:
    """Return changes as whole numbers of a step, each less the one before: low bytes, then high ones."""
    whole = np.round(change / step).astype(np.int64)
    less = np.diff(whole, axis=0, prepend=0).ravel().astype(np.uint16)
    return np.concatenate([less & 255, less >> 8]).astype(np.uint8)


__all__ = ["live_page", "made"]
