"""Mistakes that are none of the law: a ball that slips, and steps too crude for the motion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..mechanics.system import RollingSystem
from ..verify.law import applied
from .diagnosing import Case, Trial
from .examining import ACCELERATION, GAP, LAW_SHARE, PATH, SLIP, TURN, TURNING, Series, independent_law
from .motion import Motion
from .record import Array, Theirs

_EVERYTHING = frozenset({GAP, PATH, TURN, SLIP, ACCELERATION, TURNING})
_STEADY = 0.02  # of the coefficient of friction while it slips


def friction(case: Case) -> Iterator[Trial]:
    """Try a body that slips under a constant coefficient of friction: Newton and Euler with one contact force."""
    at, slip = case.motion, case.series.get(SLIP)
    if slip is None or slip.worst <= 1:
        return
    mismatch, f, N = _reaction(case.system, at)
    slipping = slip.ratio > 3
    ahead = at.slip / np.maximum(slip.length, 1e-300)[:, None]
    mu = -(f * ahead).sum(axis=1) / np.where(N != 0, N, np.nan)
    name = "velocity" if case.theirs.velocity is not None else "position"
    slopes = [case.theirs.slope(name, at.index, 1 if name == "velocity" else 2)]
    if case.theirs.angular_velocity is not None:
        slopes.append(case.theirs.slope("angular_velocity", at.index))
    away = _away_from_changes(slipping, at.index, max(slope.reach for slope in slopes))
    some = slipping & away
    if (case.series[ACCELERATION].ratio[~slipping & away] > 1).any():
        return
    if some.sum() < 3 or not (N[some] > 0).all():
        return
    typical = float(np.median(mu[some]))
    across = np.linalg.norm(f + (mu * N)[:, None] * ahead, axis=1)[some] / N[some]
    steady = max(float(np.abs(mu[some] - typical).max()), float(across.max()))
    if not typical > 0 or steady > _STEADY * typical + LAW_SHARE * case.tolerance:
        return
    ends = float(at.time[np.flatnonzero(slipping)[-1]])
    numbers = {"friction": typical, "until": ends}
    until = "all through" if slipping[-1] else f"until t = {ends:.4g} s, and rolls from then on"
    mine = case.series.get(TURNING) or slip
    rest = Series(
        TURNING,
        at.time[some],
        mismatch[some],
        mine.size,
        mine.bound[some] + LAW_SHARE * case.tolerance * mine.size,
        mine.asked,
        "Newton and Euler with one contact force",
    )
    if slip.ratio[0] <= 1 and slipping[-1]:
        until = f"from t = {float(at.time[np.flatnonzero(slipping)[0]]):.4g} s on"
    says = f"It slips {until}: while it does, friction is μN against the slip, with μ = {typical:.4g}."
    excused = _EVERYTHING - {TURNING}
    yield Trial("slipping", says, excused=excused, extra=(rest,), numbers=numbers, whole=False)


def _away_from_changes(slipping: NDArray[np.bool_], index: NDArray[np.int_], reach: int) -> NDArray[np.bool_]:
    """Leave out instants beside those where slipping begins or ends: slopes reach across."""
    near = np.zeros(slipping.size, dtype=bool)
    for change in np.flatnonzero(np.diff(slipping.astype(int))):
        near |= (index >= index[change] - reach) & (index <= index[change + 1] + reach)
    # One-sided slopes at the ends of the samples reach twice as far.
    near[: int(np.searchsorted(index, index[0] + reach))] |= near[: 1 + int(np.searchsorted(index, 2 * reach))].any()
    return ~near


def _reaction(system: RollingSystem, at: Motion) -> tuple[Array, Array, Array]:
    """Return Euler's equation's mismatch as an angular acceleration, and f and N of the force that V̇ asks for."""
    F, K, J, gyroscopic, _ = applied(system, at.samples(), at.velocity)
    R = float(system.body.mass) * at.acceleration - F
    torque = np.einsum("nij,nj->ni", J, at.angular_acceleration) + gyroscopic - K - np.cross(at.offset, R)
    n = np.broadcast_to(at.contact.normal.array(), R.shape)
    N = (R * n).sum(axis=1)
    return np.linalg.solve(J, torque[..., None])[..., 0], R - N[:, None] * n, N


def steps(case: Case) -> Iterator[Trial]:
    """Try Euler's method, one step a sample: exact differences, wrong slopes."""
    theirs = case.theirs
    if theirs.velocity is None or theirs.time.size < 20:
        return
    step = np.diff(theirs.time)
    h = float(np.median(step))
    if np.abs(step - h).max() > 1e-6 * h:
        return
    moved = np.diff(theirs.position, axis=0) / h
    size = float(np.abs(theirs.velocity).max()) + 1e-300
    rounding = 1e-12 * size + 4 * np.finfo(float).eps * float(np.abs(theirs.position).max()) / h
    for name, V in (("semi-implicit", theirs.velocity[1:]), ("explicit", theirs.velocity[:-1])):
        if np.abs(moved - V).max() > max(rounding, 1e-3 * _slope_error(case)):
            continue
        differences = _differences(case, theirs, h)
        says = (
            f"The law is right and the steps are crude: {name} Euler with {h:.4g} s a step, of first order, so that "
            "halving the step halves the error. Use a method of higher order, or allow for it with tolerance."
        )
        excused = _EVERYTHING - {ACCELERATION}
        yield Trial("crude-steps", says, excused=excused, extra=(differences,), numbers={"step": h}, whole=False)
        return


def _slope_error(case: Case) -> float:
    path = case.series[PATH]
    return float(path.length.max())


def _differences(case: Case, theirs: Theirs, h: float) -> Series:
    """Compare the steps of the velocity with the law at the state before them."""
    at = case.motion
    inner = at.index < theirs.time.size - 1
    index = at.index[inner]
    assert theirs.velocity is not None  # noqa: S101  steps() has looked
    V_rate, _ = independent_law(case.system, at)
    stepped = (theirs.velocity[index + 1] - theirs.velocity[index]) / h
    mine = case.series[ACCELERATION]
    rounding = 8 * np.finfo(float).eps * float(np.abs(theirs.velocity).max()) / h
    return Series(
        ACCELERATION,
        at.time[inner],
        stepped - V_rate[inner],
        mine.size,
        np.full(index.size, mine.asked + rounding),
        mine.asked,
        "differences of the velocity",
    )


CRUDE = (steps, friction)

__all__ = ["CRUDE"]
