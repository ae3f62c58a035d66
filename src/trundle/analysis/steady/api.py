"""What is asked of `steady_motions`, what is refused, what is returned."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...errors import InvalidValueError, UnknownNameError
from ...mechanics import checks
from ...mechanics.algebra import Vector
from ...mechanics.system import RollingSystem, State
from ...scenario import ScenarioFile
from .finding import Relative, flow_of, nearest, shares_of
from .flow import Array, Flow, triple
from .modes import modes_of, reduce, verdict_of
from .quantities import KINDS, Held, body_axis, pole, value_of
from .result import SteadyMotion, SteadyMotions
from .symmetry import symmetries

STEADY = 1e-11  # residual: what is more is not steady
_NOTHING = 1e-9  # of the scale: a slower rate is none
_ALIKE = 1e-6  # two that differ less are the same
_SPREAD = 1.2  # of the other starts, in units of the scale


def steady_motions(
    system: Any, start: State | None = None, *, holding: Any = (), starts: int = 0, title: str = ""
) -> SteadyMotions:
    """Find the steady motion next to a start: one in which all that matters stays as it is.

    Parameters
    ----------
    system : RollingSystem or Scenario
        Its support at rest or turning steadily, its loads the same at all times.
    start : State, optional
        Where the search begins; absent: the scenario's start, or ``system.place()``.
    holding : sequence of str, or mapping of str to float or quantity
        What keeps its value from the start, or gets one: "speed", "spin", "lean", "turning", "distance".
    starts : int
        How many more starts are tried, for other steady motions with the same held values.
    title : str
        For text and figure; absent: the scenario's.

    Returns
    -------
    SteadyMotions
        Each with frequencies, rates of growth, verdict and evidence.

    Raises
    ------
    InvalidValueError
        If the support or the loads change with time, or a held quantity has no meaning here.

    Source: relative equilibria of T1-T3; for disc and hoop [przybylska2016], [borisov2003].

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.Body.solid_sphere(radius=0.1, mass=1.0)
    >>> inside = tr.RollingSystem(ball, tr.Support(tr.Cylinder(0.5)))
    >>> (level,) = tr.steady_motions(inside, inside.place(velocity=(3.0, 0.0)))
    >>> level.kind, level.verdict
    ('circles', 'stable to first order')
    >>> round((level.modes[0].frequency / level.turning) ** 2, 12) == round(2 / 7, 12)  # the golfer's dilemma
    True
    """
    if isinstance(system, ScenarioFile):
        start = system.start_state() if start is None else start
        system, title = system.system(), title or system.title
    checks.instance(system, RollingSystem, "system", "Give a tr.RollingSystem or a tr.Scenario.")
    if system.body.shape.axis is not None:
        remedy = "A cylinder that rolls straight is kept upright by its line of contact; ask tr.equilibria of it."
        noun = system.body.shape.noun_of(system.body)
        raise InvalidValueError("body", "must touch at a point for a steady motion in space", noun, remedy)
    start = system.place() if start is None else start
    checks.instance(start, State, "start", "Let system.place(...) make it.")
    flow, y = flow_of(system, start)
    moves = symmetries(flow, y)
    held = held_from(flow, y, moves, holding)
    best = nearest(flow, y, moves, held)
    found, pulled = _unlike([described(system, one) for one in _all(flow, y, best, held, starts)])
    apart = float(np.linalg.norm((best.y - y) / flow.scale))
    searched = "Newton's method from the start" + (f" and {starts} more" if starts else "")
    return SteadyMotions(
        system, start, found, pulled, searched, "" if found else _why(best, pulled), apart if found else math.nan, title
    )


def _all(flow: Flow, y: Array, best: Relative, held: tuple[Held, ...], starts: int) -> list[Relative]:
    found = [best] if best.residual <= STEADY else []
    random, basis = np.random.default_rng(1897), flow.tangent(y)
    for _ in range(int(starts)):
        there = flow.put_back(y + flow.scale * (basis @ (_SPREAD * random.uniform(-1, 1, basis.shape[1]))))
        one = nearest(flow, there, best.symmetries, held)
        if one.residual <= STEADY:
            found.append(one)
    return found


def _unlike(all_found: list[SteadyMotion]) -> tuple[tuple[SteadyMotion, ...], int]:
    kept: list[SteadyMotion] = []
    for one in all_found:
        if not any(_alike(one, other) for other in kept):
            kept.append(one)
    return tuple(one for one in kept if one.stands), sum(not one.stands for one in kept)


def _alike(a: SteadyMotion, b: SteadyMotion) -> bool:
    def numbers(one: SteadyMotion) -> Array:
        height = one.state.position[2]
        return np.array([*one.quantities.values(), one.normal_force, height])

    x, y = numbers(a), numbers(b)
    return x.shape == y.shape and bool(np.allclose(x, y, rtol=_ALIKE, atol=_ALIKE * float(np.abs(x).max())))


def _why(best: Relative, pulled: int) -> str:
    if pulled:
        return "In every steady motion found the support would have to pull."
    return (
        "Newton's method found none near the start: the rates always differ from those of a symmetry by at least "
        f"{best.residual:.3g} of their scale."
    )


def held_from(flow: Flow, y: Array, moves: Array, holding: Any) -> tuple[Held, ...]:
    """Return what is held, from names or from a mapping of names to values."""
    asked = dict(holding) if hasattr(holding, "items") else dict.fromkeys(_names(holding))
    axis, shares = body_axis(moves), shares_of(flow, y, moves)
    held = []
    for name, value in asked.items():
        check_name(name, axis)
        number = float(value_of(name, flow, y, shares, axis)) if value is None else _number(name, value)
        held.append(Held(name, number, axis))
    return tuple(held)


def _names(holding: Any) -> tuple[str, ...]:
    return (holding,) if isinstance(holding, str) else tuple(holding)


def _number(name: str, value: Any) -> float:
    return float(checks.real(value, KINDS[name], f"holding[{name}]"))


def check_name(name: str, axis: Array | None, *, sweep: bool = False) -> None:
    """Refuse the name of a quantity that there is not, or not here."""
    known = [one for one in KINDS if one != "rate" or sweep]
    if name not in known:
        raise UnknownNameError("quantity", str(name), known)
    if name == "lean" and axis is None:
        raise InvalidValueError("lean", "belongs to a body with one axis of symmetry", name, "Hold another quantity.")


def described(system: RollingSystem, relative: Relative) -> SteadyMotion:
    """Return what there is to say of a steady motion."""
    flow, y, shares = relative.flow, relative.y, relative.shares
    now, reduced = flow.law(y), reduce(relative)
    modes = modes_of(reduced, flow.rate)
    n, R = now.contact.normal, now.reaction
    N = float(R.dot(n))
    f = float((R - n * N).norm())
    turning = _clean(float(shares[5]) + flow.turning, flow.rate)
    shift = Vector(*(_clean(float(part), flow.length * flow.rate) for part in shares[:3]))
    if abs(turning - flow.turning) > 0:
        shift = Vector(0.0, 0.0, shift.z)
    kind, quantities = _kind(flow, y, turning, shift), _quantities(relative, system)
    return SteadyMotion(
        system=system,
        state=flow.state(y),
        kind=kind,
        turning=turning,
        drift=triple(shift),
        own_turn=triple(Vector(*(_clean(float(part), flow.rate) for part in shares[6:]))),
        quantities=quantities,
        normal_force=N,
        friction_force=f if f > 1e-12 * float(R.norm()) else 0.0,
        modes=modes,
        verdict=verdict_of(modes),
        dimension=reduced.dimension,
        residual=relative.residual,
        frame="turning with the support" if flow.turning else "inertial",
        relative=relative,
        reduced=reduced,
    )


def _clean(value: float, scale: float) -> float:
    return 0.0 if abs(value) <= _NOTHING * scale else value


def _kind(flow: Flow, y: Array, turning: float, shift: Vector) -> str:
    moving = float(flow.law(y).velocity.norm()) > _NOTHING * flow.length * flow.rate
    if not moving:
        return "turns on the spot" if np.linalg.norm(y[7:]) > _NOTHING * flow.rate else "rest"
    if turning == 0:
        return "rolls straight"
    return "winds along the axis" if shift.z else "circles"


def _quantities(relative: Relative, system: RollingSystem) -> dict[str, float]:
    flow, y, shares = relative.flow, relative.y, relative.shares
    axis, found = body_axis(relative.symmetries), {}
    for name in ("speed", "spin", "lean", "turning", "distance"):
        if name == "lean" and axis is None:
            continue
        if name == "distance" and (flow.turning == 0 and _clean(float(shares[5]), flow.rate) == 0):
            continue
        units = {"speed": flow.length * flow.rate, "lean": 1.0, "distance": flow.length}
        found[name] = _clean(float(value_of(name, flow, y, shares, axis)), units.get(name, flow.rate))
    if system.support.motion.steady_rate:
        found["rate"] = float(system.support.motion.steady_rate)
    return found


__all__ = ["check_name", "described", "held_from", "pole", "steady_motions"]
