"""The search for equilibria: what is asked, what is refused, what is returned."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

from ...errors import InvalidValueError
from ...mechanics import checks
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.nearest import closest_contact
from ...mechanics.parts import words_of
from ...mechanics.scalars import is_zero
from ...mechanics.system import RollingSystem, State
from ...scenario import ScenarioFile
from . import rest
from .examining import examine
from .line import NEAR, ROOT, Line, roll_line
from .result import Equilibria, Equilibrium
from .search import Family, Place, Search
from .words import direction_names

A_TURN, OPEN, ROUND = math.pi, 20 * math.pi, 200 * math.pi  # rad either way: on a plane, a curve, right round
MOST_TURNS = 1000
STEADY = 1e-12  # share by which loads may differ between two times
MOST_MEMBERS = 40  # of a family that are looked at one by one
ACROSS = 1e-9  # share of the torque that may push a cylinder out of its line


def equilibria(system: Any, start: State | None = None, *, turns: Any = None, title: str = "") -> Equilibria:
    """Find where a body stays when it is put down at rest: by virtual work, among all places it can roll to.

    Parameters
    ----------
    system : RollingSystem or Scenario
        Its support at rest, its loads the same at all times.
    start : State, optional
        Where the search begins, and, for a cylinder, which way it rolls; absent: the scenario's start, or
        ``system.place()``.
    turns : float, optional
        For a cylinder, how many turns either way are searched, 1000 at most; absent: on a plane under constant loads
        half a turn, since every turn repeats the last; on a support that comes round, half way round if that takes no
        more than a hundred; else ten.
    title : str
        For text and figure; absent: the scenario's.

    Returns
    -------
    Equilibria
        Each with contact force, friction needed, stability and modes; and what was searched.

    Raises
    ------
    InvalidValueError
        If the support moves, the loads change with time, or they push a cylinder out of its line.

    Source: d'Alembert's principle [landau1976], section 38, with equations T1-T3 at Ω = 0.

    Examples
    --------
    >>> import trundle as tr
    >>> trough = tr.Support(tr.Cylinder(0.5), tilt="90 deg")
    >>> ball = tr.Body.solid_sphere(radius=0.1, mass=1.0)
    >>> found = tr.equilibria(tr.RollingSystem(ball, trough, gravity=9.8))
    >>> round(found[0].modes[0].frequency ** 2, 12)  # g/((1 + k)(b − a))
    17.5
    """
    if isinstance(system, ScenarioFile):
        start = system.start_state() if start is None else start
        system, title = system.system(), title or system.title
    checks.instance(system, RollingSystem, "system", "Give a tr.RollingSystem or a tr.Scenario.")
    _check_support(system)
    start = system.place() if start is None else start
    checks.instance(start, State, "start", "Let system.place(...) make it.")
    place = _place(system, start)
    _check_steady(system, start.time, place)
    search = _along_line if system.body.shape.axis is not None else _everywhere
    result = search(system, start, place, turns)
    return replace(result, title=title)


def _place(system: RollingSystem, start: State) -> Place:
    q = Quaternion(*start.orientation)
    return Place(closest_contact(system, start.time, Vector(*start.position), q).point, q)


def _check_support(system: RollingSystem) -> None:
    motion = system.support.motion
    if motion.steady_rate is None or not is_zero(motion.steady_rate):
        remedy = (
            "A body that rests on a moving support moves; where it rides along for ever is a relative equilibrium, "
            "another question. Leave the motion out, or run the scenario."
        )
        raise InvalidValueError("support.motion", "must be at rest for equilibria", motion.word, remedy)


def _check_steady(system: RollingSystem, time: float, place: Place) -> None:
    contact = rest.contact_at(system, time, place.p, place.q)
    then = [system.loads_on(rest.still(system, time + dt, contact, place.q)) for dt in (0.0, 0.3718, 1.618, 27.18)]
    size = max(force.norm() + torque.norm() / contact.offset.norm() for force, torque in then)
    for force, torque in then[1:]:
        if (force - then[0][0]).norm() + (torque - then[0][1]).norm() / contact.offset.norm() > STEADY * size:
            remedy = (
                "A load that changes with time leaves nothing at rest; give it a constant value, or run the scenario."
            )
            raise InvalidValueError(
                "loads", "must be the same at all times for equilibria", words_of(system.loads), remedy
            )


# --- a cylinder: one number -------------------------------------------------------------------------------


def _along_line(system: RollingSystem, start: State, place: Place, turns: Any) -> Equilibria:
    axis = place.q.matrix() @ _given(system.body.shape.axis)
    uniform = all(load.constant or load.linear_drag is not None for load in system.all_loads)
    asked = None if turns is None else 2 * math.pi * _checked(turns)
    line = _laid(system, start.time, place, axis, A_TURN if uniform else OPEN, asked)
    _check_straight(line)
    friction = _friction(system)
    potential = rest.has_energy(system, start.time, place.p, place.q)

    def at(angle: float, **about: Any) -> Equilibrium:
        there = Place(*_numbers(line.place(angle)))
        energy = float(rest.potential(system, start.time, there.p, there.q) if potential else line.energy(angle))
        return examine(system, start.time, there, friction=friction, energy=energy, line=line, angle=angle, **about)

    if line.flat:
        stationary = [at(0.0, free=("along its line",), dimension=1)]
    else:
        stationary = [at(angle) for angle in sorted([*line.roots(), *line.ledges])]
    repeats = None
    if uniform and _straight_support(line):
        stationary = [one for one in stationary if (one.angle or 0.0) > line.low + NEAR] or stationary
        turn = line.distance(math.pi) - line.distance(-math.pi), line.energy(math.pi) - line.energy(-math.pi)
        small = 1e-12 * line.scale
        repeats = (float(turn[0]), 0.0 if abs(turn[1]) < small else float(turn[1]))
    found, pulled = _held(stationary, line.scale)
    bent = abs(float(line.distance(line.high)) - float(line.distance(line.low)))
    searched = f"{_turns(line)} of the cylinder, {bent:.4g} m along the support, from the start"
    reason = "" if found else _why_none_on_line(line)
    section = line, (*found, *pulled)
    return Equilibria(system, start, found, pulled, potential, searched, lambda: section, reason, repeats)


def _checked(turns: Any) -> float:
    number = float(checks.positive(turns, "number", "turns"))
    if number > MOST_TURNS:
        raise InvalidValueError("turns", f"must be at most {MOST_TURNS}", turns, "Begin nearer to what you look for.")
    return number


def _laid(
    system: RollingSystem, time: float, place: Place, axis: Vector, on_plane: float, asked: float | None = None
) -> Line:
    """Roll along a line as far as it was asked for; else half way round a support, or some way where it is open."""
    first = asked or on_plane
    line = roll_line(system, time, place.p, place.q, axis, (first, first))
    if asked is not None or line.straight:
        return line
    return roll_line(system, time, place.p, place.q, axis, (OPEN, ROUND))


def _check_straight(line: Line) -> None:
    """Refuse loads that would turn a cylinder out of its line somewhere on the way."""
    for angle in line.angles[:: max(1, line.angles.size // 64)]:
        p, q = _numbers(line.place(angle))
        torque = rest.torque_about_contact(line.system, line.time, p, q)
        across = (torque - line.axis * torque.dot(line.axis)).norm()
        if across > ACROSS * max(line.scale, 1e-300):
            remedy = f"Here {across:.4g} N m turns it askew. Let it roll down the slope, and push it that way."
            raise InvalidValueError("loads", "must leave a cylinder in its line", words_of(line.system.loads), remedy)


def _straight_support(line: Line) -> bool:
    """Whether the support is straight along the line, and a whole turn fits on it."""
    return line.straight and line.high - line.low >= 2 * math.pi * (1 - 1e-12)


def _turns(line: Line) -> str:
    turns = (line.high - line.low) / (2 * math.pi)
    return "one whole turn" if abs(turns - 1) < 1e-9 else f"{turns:.4g} turns"


def _why_none_on_line(line: Line) -> str:
    low, high = float(line.works.min()), float(line.works.max())
    if low * high <= 0:  # there are stationary points, but none that the support can hold by pushing
        return "At every stationary point the support would have to pull."
    least, most = sorted((abs(low), abs(high)))
    work = f"{least:.4g} J" if most - least <= 1e-9 * most else f"between {least:.4g} and {most:.4g} J"
    way = "on" if low > 0 else "back"
    p, q = _numbers(line.place(line.angles[abs(line.works).argmin()]))
    pushed = _push(line.system, line.time, p, q, least)
    return f"For each radian that it rolls {way} the loads do {work} of work, never none. {pushed}"


def _push(system: RollingSystem, time: float, p: Vector, q: Quaternion, torque: float) -> str:
    """Say what drives the body where it is driven least."""
    contact = rest.contact_at(system, time, p, q)
    F, K = system.loads_on(rest.still(system, time, contact, q))
    along = (F - contact.normal * F.dot(contact.normal)).norm()
    words = f"The applied force along the support is {along:.4g} N"
    if K.norm() > 0 or F.norm() == 0:
        return f"{words}, and the torque about the contact at least {torque:.4g} N m."
    nearest = 1e3 * torque / F.norm()
    return f"{words}, and the line of the applied force never passes the contact nearer than {nearest:.4g} mm."


# --- a ball: place and orientation ------------------------------------------------------------------------


def _everywhere(system: RollingSystem, start: State, place: Place, turns: Any) -> Equilibria:
    if turns is not None:
        raise InvalidValueError("turns", "belongs to a cylinder, which rolls along one line", turns)
    search = Search(system, start.time, place)
    families, nearest, torque = search.families()
    potential = rest.has_energy(system, start.time, place.p, place.q)
    friction = _friction(system)

    def at(there: Place, **about: Any) -> Equilibrium:
        energy = float(rest.potential(system, start.time, there.p, there.q)) if potential else None
        return examine(system, start.time, there, friction=friction, energy=energy, **about)

    found, pulled = _held(
        [one for family in families for one in _kinds(system, search, family, at)],
        rest.torque_scale(system, start.time, place.p, place.q),
    )
    reason = ""
    if not found:
        reason = _why_no_place(system, start.time, nearest, torque, bool(families))
    section = partial(_section, system, start.time, found[0] if found else None, nearest, at)
    return Equilibria(system, start, found, pulled, potential, search.told, section, reason)


def _kinds(system: RollingSystem, search: Search, family: Family, at: Callable[..., Equilibrium]) -> list[Equilibrium]:
    """Return one member of a family for each kind that it has: where it bends, stability and contact may change."""
    about: dict[str, Any] = {"free": _free(system, search, family), "dimension": family.dimension}
    every = max(1, len(family.members) // MOST_MEMBERS)
    kinds: dict[tuple[str, bool], Equilibrium] = {}
    for place in family.members[::every] if search.oriented else [family.place]:
        one = at(place, **about)
        kinds.setdefault((one.stability, one.stands), one)
    return list(kinds.values())


def _free(system: RollingSystem, search: Search, family: Family) -> tuple[str, ...]:
    names = [*direction_names(system), *(("",) * 3)]
    words = [names[i] for i in family.free if i < 2]
    if words == list(direction_names(system)) and system.support.surface.coordinates == ("length", "length"):
        words = ["on the plane"]
    turned = family.dimension - sum(i < 2 for i in family.free)
    if not search.oriented:
        words.append("in any orientation")
    elif turned > 0:
        words.append(
            "turned about the line through centre and centre of mass" if turned == 1 else "in a family of orientations"
        )
    return tuple(words)


def _why_no_place(system: RollingSystem, time: float, nearest: Place, share: float, stationary: bool) -> str:
    if stationary:
        return "At every stationary point the support would have to pull."
    torque = share * rest.torque_scale(system, time, nearest.p, nearest.q)
    return f"No stationary point. {_push(system, time, nearest.p, nearest.q, torque)}"


def _section(
    system: RollingSystem, time: float, lowest: Equilibrium | None, nearest: Place, at: Callable[..., Equilibrium]
) -> tuple[Line | None, tuple[Equilibrium, ...]]:
    """Return a line through the first equilibrium along which its energy changes most, and the equilibria on it."""
    if lowest is None:
        place = nearest
        torque = rest.torque_about_contact(system, time, place.p, place.q)
    else:
        place = Place(Vector(*lowest.contact), Quaternion(*lowest.state.orientation))
        torque = Vector(*max(lowest.modes, key=lambda mode: (math.hypot(*mode.moves) > 0, abs(mode.rate))).turn)
    n = rest.contact_at(system, time, place.p, place.q).normal
    axis = torque - n * torque.dot(n)
    if not axis.norm() > 1e-9 * torque.norm():
        return None, ()
    axis = axis / axis.norm()
    line = _laid(system, time, place, axis, A_TURN)
    places = [
        (angle, Place(*_numbers(line.place(angle)))) for angle in ([0.0] if line.flat and lowest else line.roots())
    ]
    rests = [
        (angle, there)
        for angle, there in places
        if rest.torque_about_contact(system, time, there.p, there.q).norm()
        <= 1e-9 * rest.torque_scale(system, time, there.p, there.q)
    ]
    return line, tuple(at(there, angle=angle) for angle, there in rests)


# --- both -------------------------------------------------------------------------------------------------


def _held(stationary: list[Equilibrium], scale: float) -> tuple[tuple[Equilibrium, ...], tuple[Equilibrium, ...]]:
    """Part the equilibria from the points at which the support would have to pull; count energy from the lowest."""
    found = [one for one in stationary if one.stands]
    if found and found[0].energy is not None:
        zero = min(one.energy for one in found if one.energy is not None)
        found = sorted((_raised(one, zero, scale) for one in found), key=lambda one: one.energy or 0.0)
    return tuple(found), tuple(one for one in stationary if not one.stands)


def _raised(one: Equilibrium, zero: float, scale: float) -> Equilibrium:
    """Count the energy from a zero, differences of rounding as none."""
    if one.energy is None:
        return one
    above = one.energy - zero
    return replace(one, energy=above if above > ROOT * scale else 0.0)


def _friction(system: RollingSystem) -> float | None:
    return None if system.support.friction is None else float(system.support.friction)


def _numbers(place: tuple[Vector, Quaternion]) -> tuple[Vector, Quaternion]:
    return Vector(*map(float, place[0])), Quaternion(*map(float, place[1]))


def _given(axis: Vector | None) -> Vector:
    if axis is None:
        raise InvalidValueError("body", "must be a cylinder", axis)
    return axis
