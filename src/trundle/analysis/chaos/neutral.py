"""Which exponents must be zero: along the flow, along each symmetry, and across the levels of each first integral.

Nothing is told of these but the law. A rigid move ξ of space or of the body in itself, and a step c along the flow, are
neutral where v = ξ + c f solves the variational equations along the motion: ∂f/∂y ξ − ∂ξ/∂y f = c ∂f/∂t.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.invariants import Record, invariants_of
from ...mechanics.system import RollingSystem
from ...solve.laws import Law
from ...solve.samples import Array
from ..steady.flow import differences
from .tangents import constraint_rows
from .volume import slopes_at

_NEUTRAL = 1e-8  # singular values below this share are none
_RANK, _ROUGH = 1e-6, 1e-4  # the second where slopes are differences
_DIES = 0.2  # share of itself that is left at the end of a neutral difference which dies away with the motion
_SHIFTS, _TURNS = (
    slice(0, 3),
    slice(3, 6),
)  # shares of a move; behind them turns of the body, and the support's own angle


@dataclass(frozen=True)
class Neutral:
    """The exponents that must be zero."""

    count: int  # how many at least
    flow: bool  # whether one is along the flow
    symmetries: int  # how many more directions the symmetries have
    integrals: tuple[str, ...]  # the first integrals that count
    lost: int = 0  # how many exponents are −∞, by which there may be fewer

    def __str__(self) -> str:
        said = ["the flow itself"] if self.flow else []
        if self.symmetries:
            said.append(f"{self.symmetries} {'symmetry' if self.symmetries == 1 else 'symmetries'}")
        said += [f"the {name}" for name in self.integrals]
        less = f"; less {self.lost} that events take away" if self.lost else ""
        return f"{self.count} ({', '.join(said)}{less})" if said else "none"


def neutral(
    system: RollingSystem,
    law: Law,
    times: Array,
    states: Array,
    basis: Array,
    scale: Array,
    phases: Sequence[str],
    *,
    changes: bool,
) -> Neutral:
    """Find the exponents that must be zero.

    Parameters
    ----------
    system, law : RollingSystem, Law
        Of the phase in which the motion starts.
    times, states : array (n,), (n, size)
        Some instants of the motion in that phase; the first is its start, and the last its end.
    basis : array (size, d)
        Of what may be different at the start, in units of the scale.
    scale : array (size,)
        What is large of each number of the state.
    phases : sequence of str
        All that the motion goes through.
    changes : bool
        Whether events stand between them.
    """
    flow, moves = _neutral_moves(system, law, times, states, scale)
    integrals, rows = _integrals(system, law, float(times[0]), states[0], basis, scale, phases, changes=changes)
    along = basis.T @ moves[0] if moves.size else np.zeros((basis.shape[1], 0))
    k, m = _rank(along), _rank(rows, _ROUGH)
    double = _rank(rows @ np.linalg.qr(along)[0], _ROUGH) if k and m else 0
    return Neutral(k + m - double, flow, max(0, k - flow), tuple(integrals))


def _rank(matrix: Array, least: float = _RANK) -> int:
    """Return the rank of a matrix whose rows or columns are of the size of 1."""
    return int((np.linalg.svd(matrix, compute_uv=False) > least).sum()) if matrix.size else 0


def _neutral_moves(system: RollingSystem, law: Law, times: Array, states: Array, scale: Array) -> tuple[bool, Array]:
    """Return whether the flow is neutral, and the neutral differences at each instant, in units of the scale."""
    slopes, names = slopes_at(system, law, times, states), law.names(system)
    length, rate = float(scale[0]), float(scale[7])
    angles = [i for i, name in enumerate(names) if name.startswith("support") and scale[i] == 1.0]
    sizes = np.array([length] * 3 + [1.0] * (6 + len(angles)) + [1 / rate])
    rates = np.array(
        [law.rates(system, t, list(y)) for t, y in zip(times.tolist(), states.tolist(), strict=True)], float
    )
    rows, vectors = [], []
    for time, y, f, J in zip(times.tolist(), states, rates, slopes, strict=True):
        moves = [_moved(names, share, y, angles) for share in np.eye(sizes.size - 1)]
        swapped = [_moved(names, share, f, angles, linear=True) for share in np.eye(sizes.size - 1)]
        v = np.stack([*moves, f], axis=1) * sizes
        commutators = np.stack([J[:, :-1] @ a - b for a, b in zip(moves, swapped, strict=True)] + [-J[:, -1]], axis=1)
        rows += [
            commutators * sizes / (scale * rate)[:, None],
            constraint_rows(system, law, time, y.tolist()) @ v / length,
        ]
        vectors.append(v / scale[:, None])
    _, singular, basis = np.linalg.svd(np.vstack(rows))
    singular = np.append(singular, np.zeros(len(basis) - len(singular)))
    shares = basis[singular <= _NEUTRAL * max(singular[0], 1.0)].T
    if not shares.size:
        return False, np.zeros((len(times), scale.size, 0))
    found = np.stack([v @ shares for v in vectors])
    kept = _lasting(found)
    symmetric = found[0] @ kept @ _across(shares[-1] @ kept)
    return _rank(found[0] @ kept) > _rank(symmetric), found @ kept


def _across(row: Array) -> Array:
    """Return a basis of what a row of numbers takes to nothing."""
    return np.asarray(np.linalg.svd(row[None, :])[2][int(np.abs(row).max(initial=0.0) > _RANK) :].T)


def _lasting(found: Array) -> Array:
    """Return the combinations of neutral differences that do not die away: those that last from early to late."""
    from scipy.linalg import eigh

    count = max(1, len(found) // 3)
    early, late = np.vstack(list(found[:count])), np.vstack(list(found[-count:]))
    _, sizes, combined = np.linalg.svd(early)
    whole = combined[: int((sizes > _RANK).sum())].T
    shares, combinations = eigh((late @ whole).T @ (late @ whole), (early @ whole).T @ (early @ whole))
    return np.asarray(whole @ combinations[:, shares > _DIES**2])


def _moved(names: Sequence[str], share: Array, y: Array, angles: Sequence[int], *, linear: bool = False) -> Array:
    """Return the rates of a state's numbers under a rigid move; linear, without the shift, as rates of these move."""
    shift, turn, own = Vector(*share[_SHIFTS]), Vector(*share[_TURNS]), Quaternion(0.0, *share[6:9])
    found = np.zeros(len(names))
    for i, name in enumerate(names):
        if name.endswith("_x") and not name.startswith("q"):
            moved = turn.cross(Vector(*y[i : i + 3]))
            if name[0] in "pr" and not linear:
                moved = moved + shift
            found[i : i + 3] = [float(part) for part in moved]
    q = Quaternion(*y[3:7])
    found[3:7] = [float(a) + 0.5 * float(b) for a, b in zip(q.rate(turn), q * own, strict=True)]
    if not linear:
        found[list(angles)] = share[9:]
    return found


def _integrals(
    system: RollingSystem,
    law: Law,
    time: float,
    y: Array,
    basis: Array,
    scale: Array,
    phases: Sequence[str],
    *,
    changes: bool,
) -> tuple[list[str], Array]:
    """Return the first integrals that the motion keeps throughout, and their slopes along the basis."""
    names: list[str] = []
    rows = np.zeros((0, basis.shape[1]))
    for integral in invariants_of(system, phases=tuple(phases)):
        if changes and not integral.through_changes:
            continue

        def value(there: Any, integral: Any = integral) -> Array:
            numbers = list(there)
            norm = np.sqrt(sum(part * part for part in numbers[3:7]))
            numbers[3:7] = [part / norm for part in numbers[3:7]]
            coordinates = law.split(numbers)[4]
            record = Record(law.motion(system, time, numbers), Vector(*numbers[:3]), coordinates)
            terms = integral.terms(system, record)
            parts = [_parts(term, there.shape[1]) for term in terms]
            return np.asarray(sum(parts)) if parts else np.zeros((0, there.shape[1]))

        slopes = differences(value, y, scale[:, None] * basis, rough=True)  # some are quadratures
        sizes = np.abs(slopes).max() if slopes.size else 0.0
        if not np.isfinite(sizes) or sizes == 0:
            continue
        together = np.vstack([rows, slopes / sizes])
        if _rank(together, _ROUGH) > _rank(rows, _ROUGH):
            names.append(integral.name)
            rows = together
    return names, rows


def _parts(term: Any, count: int) -> Array:
    if isinstance(term, Vector):
        return np.stack([np.broadcast_to(np.asarray(part, dtype=float), (count,)) for part in term])
    array = np.asarray(term, dtype=float)
    array = array.T if array.ndim > 1 else array[None]
    return np.broadcast_to(array, (array.shape[0], count))
