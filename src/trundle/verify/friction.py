"""What the support does to the body: the normal force, the friction that rolling takes, and friction while slipping."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..mechanics.system import RollingSystem
from ..solve.samples import FLIGHT, ROLLING, Samples
from .bounds import Array, largest
from .card import CardFigure, checked

_SLACK = 1e-8  # by which rolling may pass the cone before it gives way: what `CONE_SLACK` leaves, and rounding


def _parts(system: RollingSystem, at: Samples) -> tuple[Array, Array]:
    """Return N and f of the contact force."""
    normal = at.normals(system)
    N = np.einsum("ni,ni->n", at.contact_force, normal)
    return N, at.contact_force - N[:, None] * normal


def contact_force(system: RollingSystem, samples: Samples) -> Iterator[CardFigure]:
    """Say what friction rolling needs, and whether the support pushes rather than pulls.

    Parameters
    ----------
    system : RollingSystem
        What moved.
    samples : Samples
        Of the run.

    Yields
    ------
    CardFigure
        Two, for the parts of the run in which the body touches, and rolls.

    Examples
    --------
    >>> import trundle as tr
    >>> tr.Scenario.load("tilted-turntable").run().card()["normal force"].passed
    True
    """
    least, needed, size = (math.inf, 0.0), (-1.0, 0.0), 0.0  # what, and when
    for _, some in samples.blocks():
        touching = some.part(some.phase != FLIGHT)
        if not touching.time.size:
            continue
        N, f = _parts(system, touching)
        size = max(size, largest(touching.contact_force))
        least = min(least, _at(touching, N, int(np.argmin(N))))
        rolls = touching.phase == ROLLING
        if rolls.any():
            share = np.where(rolls, _share(np.linalg.norm(f, axis=1), N), -1.0)
            needed = max(needed, _at(touching, share, int(np.argmax(share))), key=lambda found: found[0])
    if least[0] < math.inf:
        yield _pushing(*least, size)
    if needed[0] >= 0:
        yield _holding(system, *needed)


def _at(samples: Samples, values: Array, index: int) -> tuple[float, float]:
    return float(values[index]), float(samples.time[index])


def _share(f: Array, N: Array) -> Array:
    """Return |f|/N, which is without bound where nothing presses the body on and something holds it."""
    return np.where(N > 0, f / np.where(N > 0, N, 1.0), np.where(f > 0, np.inf, 0.0))


def _pushing(least: float, time: float, size: float) -> CardFigure:
    """Say whether the support pushed all the time, given the least N and the largest force."""
    pushed = None if size == 0 else least >= -1e-12 * size
    held = "; a support cannot pull: it would come off" if pushed is False else ""
    return CardFigure("normal force", least, "N", None, pushed, f"least, at t = {time:.6g} s{held}")


def _holding(system: RollingSystem, needed: float, time: float) -> CardFigure:
    """Say whether friction sufficed for rolling, given the largest |f|/N."""
    mu, note = system.support.friction, f"max |f|/N, at t = {time:.6g} s"
    if mu is None:
        return CardFigure("friction coefficient needed", needed, note=note)
    enough = bool(needed <= mu * (1 + _SLACK))
    note += "" if enough else "; it would slip"
    return CardFigure("friction coefficient needed", needed, "", float(mu), enough, note)


def friction_law(system: RollingSystem, slipping: Samples, bound: float) -> CardFigure:
    """Check Coulomb's law of slipping: f = −μ N ŝ.

    Parameters
    ----------
    system : RollingSystem
        What moved.
    slipping : Samples
        Samples in which it slips.
    bound : float
        The share of μN by which friction may be off.

    Returns
    -------
    CardFigure
        The largest departure.
    """
    N, f = _parts(system, slipping)
    V, turning, u = slipping.speeds(system)
    s = (V + turning - u).array()
    speed = np.linalg.norm(s, axis=1)
    mu = float(system.support.sliding_friction)
    clear = speed > 1e-6 * max(float(speed.max()), 1e-300)  # of less, rounding decides the direction
    off = f[clear] + mu * (N / np.where(speed > 0, speed, 1.0))[clear, None] * s[clear]
    share = largest(off) / max(largest(slipping.contact_force), 1e-300) if clear.any() else 0.0
    # V is the small difference that slip is made of: its direction is as sharp as that.
    sharp = max(
        1.0, float((np.max(V.norm()) + np.max(turning.norm())) / max(float(speed[clear].min(initial=1.0)), 1e-300))
    )
    return checked("friction while slipping", share, bound * sharp, f"f = −μ N ŝ, μ = {mu:g}")
