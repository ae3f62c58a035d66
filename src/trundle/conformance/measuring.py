"""An engine's motion against the exact one: errors, the order at which they fall with the step, and one word for it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from .case import Array, Case, Motion, extent

EXACT, CONVERGES, SLOWLY, PLATEAUS, DIVERGES = "exact", "converges", "converges slowly", "plateaus", "diverges"
ASTRAY, SILENT_LIMIT, FLOAT_FLOOR, ONE_STEP = "astray", "silent limit", "float32 floor", "one step"
CANNOT, NOT_RUN = "cannot", "no result"
CLASSES = {  # each with what it means
    EXACT: "at rounding, whatever the step",
    CONVERGES: "the error falls at least as the step to the power 0.9",
    SLOWLY: "it falls, more slowly",
    PLATEAUS: "a smaller step does not help",
    DIVERGES: "a smaller step makes it worse, or no numbers come out",
    ASTRAY: "half a turn off at the finest steps, where errors cannot grow: smaller steps may help, and do not show",
    SILENT_LIMIT: "a speed is cut off at a fixed value, and nothing says so",
    FLOAT_FLOOR: "what is left is the rounding of single precision: the same run in double falls on",
    ONE_STEP: "numbers at one step only, which tell nothing of how they fall",
    CANNOT: "the engine has no words for it, and says so",
    NOT_RUN: "it failed, took too long, or could not be installed",
}
_ROUNDING = 1e-9  # error at which no step is told from another
_FAST, _FLAT, _WORSE = 0.9, 0.2, -0.5  # orders
_CUT = 0.01  # share by which the exact rate exceeds one that is cut off
_SAME = 1e-6  # relative: rates that are all cut off at one value
_MANY = 5  # samples at that value


@dataclass(frozen=True)
class Errors:
    """How far a motion is from the exact one, the worst over the run.

    Parameters
    ----------
    position : float
        Of any body's centre of mass, over the length of its path.
    angle : float
        Of any body's orientation, rad: at most π.
    turning : float
        The same over the angle through which the body has turned.
    reach : float
        Of the position of that body which is furthest off, over the distance to which its own path takes it from the
        middle of the path: an error of about 1 cannot grow while both stay where they are.
    slip : float
        Of the velocity of slipping over the speed that all kinetic energy would be; not a number where the engine
        does not say enough.
    energy : float
        Over the highest kinetic energy; of the moving energy on a driven support.
    friction : float
        Of the mean force of friction, over that force; not a number where the case has no other force.
    own : float
        The larger of those of position and turning from a body that is exact but for the mesh; not a number where
        the support is none.
    mesh : float
        What that body is off by itself: the share that is no fault of the engine's.
    spin : float
        About the vertical at the end, over the exact one, where a body spins up the other way: negative where the
        engine does not turn it round. Not a number where none does.
    """

    position: float
    angle: float
    turning: float
    reach: float
    slip: float
    energy: float
    friction: float
    own: float = math.nan
    mesh: float = math.nan
    spin: float = math.nan

    @property
    def worst(self) -> float:
        """The one that classes go by: the larger of those of position and turning, or what is not the mesh's."""
        return max(self.position, self.turning) if math.isnan(self.own) else self.own


def errors_of(case: Case, exact: Motion, motion: Motion) -> Errors:
    """Measure a motion against the exact one, and against the one that is exact but for a mesh.

    Examples
    --------
    >>> import trundle as tr
    >>> case = tr.conformance.cases()[0]
    >>> errors_of(case, case.exact(), case.exact()).worst < 1e-15
    True
    """
    found, on_mesh = _apart(case, exact, motion), case.on_mesh()
    if on_mesh is None:
        return found
    own, mesh = (_apart(case, *pair) for pair in ((on_mesh, motion), (exact, on_mesh)))
    return replace(found, own=own.worst, mesh=mesh.worst)


def _apart(case: Case, exact: Motion, motion: Motion) -> Errors:
    apart = np.linalg.norm(motion.position - exact.position, axis=-1).max(0)
    around = np.linalg.norm(exact.position - exact.position.mean(0), axis=-1).max(0)
    path = np.linalg.norm(np.diff(exact.position, axis=0), axis=-1).sum(0)
    between = _angles(motion.orientation, exact.orientation).max(0)
    kinetic = case.kinetic_energy(exact).max()
    speed = math.sqrt(2 * kinetic / sum(body["mass"] for body in case.situation()["bodies"]))
    spin = np.linalg.norm(exact.angular_velocity, axis=-1)
    turned = (0.5 * (spin[1:] + spin[:-1]) * np.diff(exact.time)[:, None]).sum(0)
    slip = np.abs(np.linalg.norm(case.slip(motion) - case.slip(exact), axis=-1)).max()
    energy = np.abs(case.energy(motion) - case.energy(exact)).max() / kinetic
    friction = case.friction_force(exact)
    # A body that stays, or does not turn, is measured by how far the others go, and by its own size.
    path = np.maximum(path, max(1e-3 * path.max(), extent(case)))
    return Errors(
        float((apart / path).max()),
        float(between.max()),
        float((between / np.maximum(turned, 1e-3 * turned.max())).max()),
        float((apart / np.maximum(around, 1e-3 * extent(case))).max()),
        float(slip) / speed,
        float(energy),
        float(np.linalg.norm(case.friction_force(motion) - friction) / np.linalg.norm(friction)),
        spin=_turned_round(exact.angular_velocity[:, 0, 2], motion.angular_velocity[:, 0, 2]),
    )


def _turned_round(exact: Array, found: Array) -> float:
    """Return the last spin over the exact one, where that has changed its sign and is large again."""
    round_it_goes = exact[-1] * exact[0] < 0 and abs(exact[-1]) > 0.5 * np.abs(exact).max()
    return float(found[-1] / exact[-1]) if round_it_goes else math.nan


def _angles(p: Array, q: Array) -> Array:
    """Return the angles between orientations, rad, small ones without loss."""
    same = np.sign((p * q).sum(-1, keepdims=True))
    half = np.linalg.norm(p - same * q, axis=-1) / 2
    return 4 * np.arcsin(np.minimum(half, 1.0))


def order(steps: Array, errors: Array) -> float:
    """Return the order between the two finest steps that gave a number; not a number where there are fewer.

    Examples
    --------
    >>> round(order(np.array([1e-2, 1e-3]), np.array([4e-2, 4e-4])), 12)
    2.0
    """
    known = np.isfinite(errors) & (errors > 0)
    chosen = np.argsort(steps[known])[:2]
    if chosen.size < 2:
        return math.nan
    (fine, coarse), (small, large) = steps[known][chosen], errors[known][chosen]
    return float(math.log(large / small) / math.log(coarse / fine))


def classify(errors: Mapping[float, float]) -> str:
    """Return the class of errors at several steps; infinite where the numbers were not finite.

    Examples
    --------
    >>> classify({1e-2: 3e-2, 1e-3: 3e-3}), classify({1e-2: 3e-2, 1e-3: 2.9e-2}), classify({1e-2: 1e-14})
    ('converges', 'plateaus', 'exact')
    """
    known = {step: error for step, error in errors.items() if not math.isnan(error)}
    if not known:
        return NOT_RUN
    if max(known.values()) <= _ROUNDING:
        return EXACT
    if math.isinf(known[min(known)]):
        return DIVERGES
    p = order(np.array(list(known)), np.array(list(known.values())))
    if math.isnan(p):
        return ONE_STEP
    if known[min(known)] <= _ROUNDING:
        return CONVERGES
    return CONVERGES if p >= _FAST else SLOWLY if p >= _FLAT else PLATEAUS if p > _WORSE else DIVERGES


def cut_off(exact: Motion, motion: Motion) -> float | None:
    """Return the rate at which components of the angular velocity are cut off, rad/s, where they are.

    They are where the largest component stays at one value for several samples while the exact one exceeds it.
    """
    ours = np.abs(exact.angular_velocity).max(axis=(1, 2))
    theirs = np.abs(motion.angular_velocity).max(axis=(1, 2))
    limit = float(theirs.max())
    there = (np.abs(theirs - limit) <= _SAME * limit) & (ours > (1 + _CUT) * limit)
    # The exact rate must change meanwhile: a ball that spins evenly stays at one value, too.
    if limit > 0 and there.sum() >= _MANY and np.ptp(ours[there]) > 10 * _SAME * limit:
        return limit
    return None
