"""One equilibrium looked at closely: contact force, friction, modes, stability."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...mechanics.algebra import ZERO, Vector, point_inertia
from ...mechanics.contact import Contact, roll
from ...mechanics.system import RollingSystem, State
from . import rest
from .line import Line
from .result import Equilibrium
from .search import Place
from .stability import NOTHING, Mode, modes_of, on_the_spot, stability_of
from .words import SPOT, direction_names

TIPS = 1e-9  # radii for a radian: a mode that moves the contact less tips the body over


def examine(
    system: RollingSystem,
    time: float,
    place: Place,
    *,
    friction: float | None,
    energy: float | None = None,
    line: Line | None = None,
    angle: float | None = None,
    free: tuple[str, ...] = (),
    dimension: int = 0,
) -> Equilibrium:
    """Return what there is to say of a place where the torque about the contact vanishes."""
    p, q = place.p, place.q
    now = roll(system, time, p, q, ZERO)
    contact, R = now.contact, now.reaction
    N = R.dot(contact.normal)
    f = (R - contact.normal * N).norm()
    body_axis = system.body.shape.axis
    first, second = system.support.surface.directions(p)
    turns = [first, second, contact.normal] if body_axis is None else [q.matrix() @ body_axis]
    modes = _modes(system, time, place, turns)
    stability = stability_of(modes, contact.normal)
    if line is not None and body_axis is not None and angle is not None and not line.flat:
        if angle in line.ledges:
            modes = tuple(replace(mode, rate=0j) for mode in modes)  # what is left of it is rounding
            stability = "unstable"
        elif stability == "indifferent":
            stability = _by_the_sides(line.sides(angle))
    still = (0.0, 0.0, 0.0)
    return Equilibrium(
        state=State(_triple(contact.centre), still, still, (q.w, q.x, q.y, q.z), time),
        contact=_triple(p),
        position=_coordinates(system, contact.centre, p, contact.offset),
        roll=None if body_axis is None else _roll(place, contact.normal, q.matrix() @ body_axis),
        distance=None if line is None or body_axis is None else float(line.distance(angle)),
        energy=energy,
        reaction=_triple(R),
        normal_force=float(N),
        friction_force=float(0.0 if f <= NOTHING * 1e-3 * R.norm() else f),
        friction=friction,
        stability=stability,
        modes=modes,
        moves=tuple(_name(system, mode, contact, (first, second)) for mode in modes),
        free=free,
        dimension=dimension,
        kinds=system.support.surface.coordinates,
        angle=angle,
    )


def _modes(system: RollingSystem, time: float, place: Place, turns: list[Vector]) -> tuple[Mode, ...]:
    H, G, moves = rest.linear_law(system, time, place.p, place.q, turns)
    rho = rest.contact_at(system, time, place.p, place.q).offset
    about = system.body.inertia_in_space(place.q.matrix()) + point_inertia(system.body.mass, rho)
    least = min(float(turn.dot(about @ turn)) for turn in turns)
    scale = rest.torque_scale(system, time, place.p, place.q) / least
    return modes_of(H, G, np.array([list(turn) for turn in turns], dtype=float), moves, scale)


def _by_the_sides(sides: tuple[float, float]) -> str:
    """Tell a flat minimum of the energy from a flat maximum and from a ledge, by the work on either side."""
    if sides == (0.0, 0.0):
        return "indifferent"
    return "stable" if sides == (1.0, -1.0) else "unstable"


def _coordinates(system: RollingSystem, centre: Vector, p: Vector, rho: Vector) -> tuple[float, float]:
    """Return the coordinates at which `place` puts the body there: those of its centre, or those of the contact."""
    surface = system.support.surface
    for point in (centre, p):
        u, v = surface.coordinates_of(point)
        if (surface.contact_from_coordinates(u, v, rho) - p).norm() <= 1e-9 * (p.norm() + rho.norm()):
            break
    return float(u) + 0.0, float(v) + 0.0


def _roll(place: Place, n: Vector, axis: Vector) -> float:
    """Return the angle about the axis from the normal to the first axis of the body frame, rad."""
    mark = place.q.matrix() @ Vector(1.0, 0.0, 0.0)
    return math.atan2(mark.dot(axis.cross(n)), mark.dot(n))


def _name(system: RollingSystem, mode: Mode, contact: Contact, directions: tuple[Vector, Vector]) -> str:
    moves = Vector(*mode.moves)
    if system.body.shape.axis is not None:
        return "rolling"
    if on_the_spot(mode, contact.normal):
        return SPOT
    if moves.norm() < TIPS * contact.offset.norm():
        return "tipping over its rim"
    shares = [abs(float(moves.dot(way))) / float(moves.norm()) for way in directions]
    names = direction_names(system)
    return next((name for name, share in zip(names, shares, strict=True) if share > 1 - 1e-6), "obliquely")


def _triple(v: Vector) -> tuple[float, float, float]:
    return float(v.x) + 0.0, float(v.y) + 0.0, float(v.z) + 0.0
