"""What the support does to the body: the normal force, the friction that rolling takes, and friction while slipping."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import contact_at
from ..mechanics.system import RollingSystem
from ..solve.contact_state import WEIGHTLESS
from ..solve.samples import FLIGHT, RESTING, ROLLING, SLIPPING, Samples
from .acting import acting, cross, turning_over
from .bounds import Array, largest, sizes_of
from .card import CardFigure, checked
from .each_sample import Shares, worst_of

_SLACK = 1e-8  # by which rolling may pass the cone before it gives way: what `CONE_SLACK` leaves, and rounding
_LOOKS, _FINER, _MOST_DIPS, _CLOSE = 3, 14, 100, 1e-9  # how often, how finely and at how many dips it looks closer
_PULLS = 2e-12  # share of the forces at hand by which the support seems to pull: what docs/phases.md leaves to rounding
_SLOWEST = 1e-9  # of the fastest: a slip that has all but not begun has no direction of its own
_ROUNDING = 1e-12  # of the speeds at the contact: a slip that is no more has the direction of its rounding
_FIRST = 1e-3  # how far the normal may turn in the first moment of slip
_TOLD = 1e-2  # sharpness of a direction beyond which nothing is said of it


def normal_and_friction(system: RollingSystem, at: Samples) -> tuple[Array, Array]:
    """Return N and f of the contact force."""
    normal = at.normals(system)
    N = np.einsum("ni,ni->n", at.contact_force, normal)
    return N, at.contact_force - N[:, None] * normal


def looked_into(system: RollingSystem, at: Samples, follow: Callable[[Array], Samples]) -> Samples:
    """Return samples with more of them where, between two, the support might pull or friction might not do."""
    at = at.part(np.unique(at.time, return_index=True)[1])
    for _ in range(_LOOKS):
        between = _dips(system, at)
        if not between.size:
            break
        more = follow(np.unique(between))
        at = Samples.joined([at, more])
        at = at.part(np.unique(at.time, return_index=True)[1])
    return at


def _dips(system: RollingSystem, at: Samples) -> Array:
    """Return instants around where N, or μN − |f|, is lowest and might fall below zero unseen."""
    N, f = normal_and_friction(system, at)
    holds = (at.phase == ROLLING) | (at.phase == RESTING)
    watched = [(N, at.phase != FLIGHT)]
    if system.support.friction is not None:
        watched.append((float(system.support.friction) * N - np.linalg.norm(f, axis=1), holds))
    found = [np.empty(0)]
    for value, asked in watched:
        left, here, right = value[:-2], value[1:-1], value[2:]
        ours = asked[:-2] & asked[1:-1] & asked[2:] & (at.phase[:-2] == at.phase[2:])
        # In between it may fall below zero, but hardly by more than it falls and rises from look to look.
        may = ours & (here >= 0) & (here < left) & (here <= right) & (here < np.maximum(left, right) - here)
        wide = at.time[2:] - at.time[:-2] > _CLOSE * np.abs(at.time[1:-1])
        some = np.flatnonzero(may & wide)[:_MOST_DIPS]
        found += [np.linspace(at.time[i], at.time[i + 2], _FINER + 2)[1:-1] for i in some]
    return np.concatenate(found)


def contact_force(system: RollingSystem, *parts: Samples) -> Iterator[CardFigure]:
    """Say what friction rolling needs, and whether the support pushes rather than pulls.

    Examples
    --------
    >>> import trundle as tr
    >>> tr.Scenario.load("tilted-turntable").run().card()["normal force"].passed
    True
    """
    least, needed, resisted = (math.inf, 0.0), (-1.0, 0.0), (-1.0, 0.0)  # what, and when
    size = 0.0
    for some in (some for part in parts for _, some in part.blocks()):
        size = max(size, _forces(system, some))
        touching = some.part((some.phase != FLIGHT) & _directed(system, some))
        if not touching.time.size:
            continue
        N, f = normal_and_friction(system, touching)
        least = min(least, _at(touching, N, int(np.argmin(N))))
        rests = touching.phase == RESTING
        share = _share(np.linalg.norm(f, axis=1), N, WEIGHTLESS * size)
        share = np.where((touching.phase == ROLLING) | rests, share, -1.0)
        needed = max(needed, _at(touching, share, int(np.argmax(share))), key=lambda found: found[0])
        if rests.any():
            resisted = max(resisted, _lever(system, touching.part(rests)), key=lambda found: found[0])
    if least[0] < math.inf:
        yield _pushing(*least, size)
    if needed[0] >= 0:
        yield _holding(system, *needed)
    if resisted[0] >= 0:
        yield _resistance(system, *resisted)


def _forces(system: RollingSystem, at: Samples) -> float:
    """Return the size of the forces in a motion, N, also of those that cancel: what a support that moves asks for."""
    sizes, support = sizes_of(system, at), at.support(system)
    p = Vector.of(at.contact)
    carried = np.broadcast_to(support.material_acceleration(p, support.material_velocity(p)).array(), at.position.shape)
    moved = max(sizes["velocity"] * sizes["angular_velocity"], largest(carried * (at.phase != FLIGHT)[:, None]))
    return max(sizes["contact_force"], float(system.body.mass) * moved)


def slip_of(system: RollingSystem, at: Samples) -> tuple[Array, Array]:
    """Return the slip, and the speeds that it is the small difference of, m/s.

    Examples
    --------
    >>> import trundle as tr
    >>> lane = tr.RollingSystem(tr.Body.solid_sphere(0.1, 7.0), tr.Support(tr.Plane(), friction=0.1), gravity=10.0)
    >>> start = lane.place(velocity=(7.0, 0.0), angular_velocity=(0.0, 0.0, 0.0))
    >>> s, speeds = slip_of(lane, tr.simulate(lane, start, duration=3.0, every=1.0).samples)
    >>> s[:, 0].round(9).tolist(), speeds.round(9).tolist()
    ([7.0, 3.5, 0.0, 0.0], [7.0, 8.5, 10.0, 10.0])
    """
    V, turning, u = (np.broadcast_to(v.array(), at.position.shape) for v in at.speeds(system))
    # Ω×ρ is as sharp as |Ω||ρ|, also where Ω is along ρ and all three are rounding.
    arm = np.linalg.norm(at.contact - at.position, axis=1)
    turns = np.linalg.norm(at.angular_velocity, axis=1) * arm
    return V + turning - u, np.linalg.norm(V, axis=1) + turns + np.linalg.norm(u, axis=1)


def _directed(system: RollingSystem, at: Samples) -> NDArray[np.bool_]:
    """Tell where a force along a motion has a direction: at the very grip, or stop, it is that of a rounding."""
    s, at_contact = slip_of(system, at)
    slips = (at.phase != SLIPPING) | (np.linalg.norm(s, axis=1) > _ROUNDING * at_contact)
    if not system.resisted:
        return slips
    turning, rates = turning_over(system, at)
    return slips & ((at.phase != ROLLING) | (turning > _ROUNDING * rates))


def _at(samples: Samples, values: Array, index: int) -> tuple[float, float]:
    return float(values[index]), float(samples.time[index])


def _share(f: Array, N: Array, rounding: float) -> Array:
    """Return |f|/N: nothing where both are rounding, without bound where only N is nothing."""
    share = np.where(N > 0, f / np.where(N > 0, N, 1.0), np.where(f > 0, np.inf, 0.0))
    return np.where(np.maximum(f, np.abs(N)) > rounding, share, 0.0)


def _pushing(least: float, time: float, size: float) -> CardFigure:
    """Say whether the support pushed all the time, given the least N and the largest force."""
    pushed = None if size == 0 else least >= -_PULLS * size
    held = "; a support cannot pull: it would come off" if pushed is False else ""
    return CardFigure("normal force", least, "N", None, pushed, f"least, at t = {time:.6g} s{held}")


def _holding(system: RollingSystem, needed: float, time: float) -> CardFigure:
    """Say whether friction sufficed for rolling and for rest, given the largest |f|/N."""
    mu, note = system.support.friction, f"max |f|/N, at t = {time:.6g} s"
    if mu is None:
        return CardFigure("friction coefficient needed", needed, note=note)
    enough = bool(needed <= mu * (1 + _SLACK))
    note += "" if enough else "; it would slip"
    return CardFigure("friction coefficient needed", needed, "", float(mu), enough, note)


def _resistance(system: RollingSystem, needed: float, time: float) -> CardFigure:
    """Say whether resistance to rolling sufficed for rest."""
    most = float(system.resistance)
    note = f"couple over N of a body at rest, at t = {time:.6g} s"
    return CardFigure("resistance needed", needed, "m", most, bool(needed <= most * (1 + _SLACK)), note)


def _lever(system: RollingSystem, rests: Samples) -> tuple[float, float]:
    """Return the largest lever of N that a body at rest needs, m, and when."""
    couple, N = holding(system, rests)
    needed = np.linalg.norm(couple, axis=1) / np.maximum(N, 1e-300)
    return _at(rests, needed, int(np.argmax(needed)))


def holding(system: RollingSystem, held: Samples) -> tuple[Array, Array]:
    """Return the couple along the support that keeps a body from turning over it, N m, and the normal force."""
    _, K, J, gyroscopic = acting(system, held)
    n = held.normals(system)
    torque = K - gyroscopic + cross(held.contact - held.position, held.contact_force)
    whole = np.einsum("nij,nj->ni", J, _carried_along(system, held)) - torque
    about = np.einsum("nij,nj->ni", J, n)  # about the normal nothing holds a body that slips
    spins = (held.phase == SLIPPING) * (whole * n).sum(axis=1) / (about * n).sum(axis=1)
    whole = whole - spins[:, None] * about
    N, _ = normal_and_friction(system, held)
    return whole - (whole * n).sum(axis=1, keepdims=True) * n, N


def _carried_along(system: RollingSystem, held: Samples) -> Array:
    """Return the rate of Ω along the support of a body that only spins about the normal over it, ω̇ + Ω_n ṅ."""
    q, Omega = Quaternion.of(held.orientation), Vector.of(held.angular_velocity)
    contact = contact_at(system, held.time, Vector.of(held.contact), q, held.support_columns)
    V, turning, u = held.speeds(system)
    p_rate, _ = contact.rates(V + turning - u, Omega, V)
    support, n = contact.support, contact.normal
    n_rate = support.angular_velocity.cross(n) + contact.shape_operator @ (p_rate - u)
    spin = n.dot(Omega - support.angular_velocity)
    return np.broadcast_to((support.angular_acceleration + n_rate * spin).array(), held.position.shape)


def friction_law(system: RollingSystem, slipping: Samples, bound: float) -> CardFigure:
    """Check Coulomb's law of slipping: f = −μ N ŝ."""
    support = system.support
    coefficient = support.friction if support.kinetic_friction is None else support.kinetic_friction
    if coefficient is None:
        return checked("friction while slipping", np.inf, bound, "nothing limits its friction: it cannot slip")
    mu = float(coefficient)
    N, f = normal_and_friction(system, slipping)
    s, at_contact = slip_of(system, slipping)
    speed, size = np.linalg.norm(s, axis=1), max(largest(slipping.contact_force), 1e-300)
    sharp = np.where(speed > _SLOWEST * at_contact.max(), bound * (1 + at_contact / np.maximum(speed, 1e-300)), np.inf)
    off = np.linalg.norm(f + mu * (N / np.maximum(speed, 1e-300))[:, None] * s, axis=1) / size
    conditions = [
        Shares(
            "its size",
            np.abs(np.linalg.norm(f, axis=1) - mu * np.abs(N)) / size,
            np.where(sharp < _TOLD, bound, _FIRST),
        ),
        Shares("its direction", np.where(sharp < _TOLD, off, 0.0), sharp),
    ]
    return worst_of("friction while slipping", conditions, slipping.time, f"f = −μ N ŝ, μ = {mu:g}")
