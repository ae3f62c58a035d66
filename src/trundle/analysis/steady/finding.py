"""The search for steady motions: Newton's method from a start to the nearest state that only moves by symmetries."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...errors import InvalidValueError
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.nearest import closest_contact
from ...mechanics.parts import words_of
from ...mechanics.system import RollingSystem, State
from .flow import Array, Flow, bears_complex_numbers, scale_of
from .quantities import Held
from .symmetry import group_matrix, moved_by, samples, symmetries

_STEPS = 80
_LONGEST = 0.25  # step of Newton's method, in units of the scale
FOUND = 1e-12  # residual, likewise
_SAME = 1e-9  # share by which the law may differ between two times
_RANK = 1e-9  # singular values below this share are none
_LOOSE = 1e3  # the rates of the symmetries may change as they like; the state not
_TIMES = (0.731, 2.57, 11.3)  # in units of 1/rate, at which the law is asked whether it is the same


@dataclass(frozen=True)
class Relative:
    """A state whose rates are those of a symmetry: f(y) = ξ(y).

    Parameters
    ----------
    flow : Flow
        The law, in the frame in which it does not ask the time.
    y : (10,) array
        p, q, Ω.
    shares : (9,) array
        Of the move ξ, as `symmetry.moved_by` takes them.
    symmetries : (k, 9) array
        All that the flow has.
    residual : float
        |f − ξ| in units of the scale and its rate.
    """

    flow: Flow
    y: Array
    shares: Array
    symmetries: Array
    residual: float


def flow_of(system: RollingSystem, start: State) -> tuple[Flow, Array]:
    """Return the law as a flow in the frame in which it does not ask the time, and the start in its numbers."""
    rate = system.support.motion.steady_rate
    if rate is None:
        remedy = "Let the support rest or turn steadily; or run the scenario."
        raise InvalidValueError(
            "support.motion", "must be steady for a steady motion", system.support.motion.word, remedy
        )
    if system.support.friction is not None:
        system = replace(system, support=replace(system.support, friction=None))
    q = Quaternion(*start.orientation)
    offset = closest_contact(system, start.time, Vector(*start.position), q).offset
    y = np.array([*(Vector(*start.position) + offset), *q, *start.angular_velocity], dtype=float)
    flow = Flow(system, start.time, 0.0, scale_of(system, y, start.time))
    if not _autonomous(flow, y):
        flow = replace(flow, turning=float(rate))
        if rate == 0 or not _autonomous(flow, y):
            remedy = (
                "A load that changes with time, or one that pulls to a side of a turning shape, leaves nothing steady."
            )
            raise InvalidValueError("loads", "must look the same at all times", words_of(system.loads), remedy)
    return replace(flow, by_complex_step=bears_complex_numbers(flow, y)), y


def _autonomous(flow: Flow, y: Array) -> bool:
    """Whether the rates are the same at all times, seen from a frame that turns with `flow.turning`."""
    for there in [y, *samples(flow, y)[:3]]:
        now = flow.rates(there)
        for units in _TIMES:
            dt = units / flow.rate
            turned = group_matrix(np.array([0, 0, 0, 0, 0, flow.turning * dt, 0, 0, 0]))[:10, :10]
            then = replace(flow, time=flow.time + dt).rates(turned @ there)
            if np.abs((then - turned @ now) / (flow.scale * flow.rate)).max() > _SAME * (1 + np.abs(now).max()):
                return False
    return True


def nearest(flow: Flow, y: Array, found: Array | None = None, held: tuple[Held, ...] = ()) -> Relative:
    """Return the steady motion nearest to a state, some quantities of it held.

    Newton's method with the shortest of all steps that solve the linear equations: it ends on the family of steady
    motions next to where it began, and moves along no direction that does not matter.
    """
    moves = symmetries(flow, y) if found is None else found
    best = None
    for _ in range(_STEPS):
        shares = shares_of(flow, y, moves)
        now = Relative(flow, y, shares, moves, _residual(flow, y, shares, held))
        if best is not None and now.residual >= 0.5 * best.residual and best.residual <= FOUND:
            return now if now.residual < best.residual else best
        best = now if best is None or now.residual < best.residual else best
        y = flow.put_back(y + flow.scale * _step(flow, y, shares, moves, held))
    return best  # type: ignore[return-value]


def _moves(y: Array, moves: Array) -> Array:
    """Return where the symmetries move a state, (10, k)."""
    return np.stack([moved_by(row, y) for row in moves], axis=1) if len(moves) else np.zeros((10, 0))


def shares_of(flow: Flow, y: Array, moves: Array) -> Array:
    """Return the symmetry that the rates come nearest to; of several of one effect that which turns space least."""
    if not len(moves):
        return np.zeros(9)
    weight = 1.0 / flow.scale
    columns = _moves(y, moves) * weight[:, None]
    U, singular, basis = np.linalg.svd(columns, full_matrices=True)
    rank = int((singular > _RANK * max(singular.max(), 1e-300)).sum())
    rates = flow.rates(y) * weight
    known = basis[:rank].T @ ((U[:, :rank].T @ rates) / singular[:rank])
    free = basis[rank:].T  # moves that leave the state as it is
    if free.shape[1]:
        turns = moves[:, 3:6].T
        known = known - free @ np.linalg.lstsq(turns @ free, turns @ known, rcond=1e-9)[0]
    return np.asarray(known @ moves)


def _residual(flow: Flow, y: Array, shares: Array, held: tuple[Held, ...]) -> float:
    off = (flow.rates(y) - moved_by(shares, y)) / (flow.scale * flow.rate)
    missing = [one.missing(flow, y, shares) for one in held]
    return float(np.linalg.norm([*off, *missing]))


def co_moving_slopes(flow: Flow, y: Array, shares: Array, directions: Array) -> Array:
    """Return D(f − ξ) along directions: the linear law as seen from what moves by the symmetry."""
    from .symmetry import linear_part

    return flow.slopes(flow.rates, y, directions) - linear_part(shares, directions)


def _step(flow: Flow, y: Array, shares: Array, moves: Array, held: tuple[Held, ...]) -> Array:
    """Return the shortest step of Newton's method in units of the scale."""
    basis, unit = flow.tangent(y), flow.scale * flow.rate
    directions = flow.scale[:, None] * basis
    slopes = co_moving_slopes(flow, y, shares, directions) / unit[:, None]
    free = _moves(y, moves) * (_LOOSE / unit)[:, None] * flow.rate
    rows, right = [np.hstack([slopes, -free])], [(moved_by(shares, y) - flow.rates(y)) / unit]
    for one in held:
        along, by_shares = one.slopes(flow, y, shares, directions)
        rows.append(np.concatenate([along, (moves @ by_shares) * _LOOSE * flow.rate])[None, :])
        right.append(np.array([-one.missing(flow, y, shares)]))
    step = np.linalg.lstsq(np.vstack(rows), np.concatenate(right), rcond=1e-10)[0][: basis.shape[1]]
    size = np.linalg.norm(step)
    return np.asarray(basis @ step) * min(1.0, _LONGEST / max(float(size), 1e-300))
