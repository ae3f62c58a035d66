"""Mistakes that are none of the law: a ball that slips, and steps too crude for the motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import Quaternion
from ...mechanics.system import RollingSystem
from ...verify.acting import cross
from ...verify.law import applied
from .case import Case
from .comparisons import ACCELERATION, PATH, TURN, TURNING
from .examining import GAP, LAW_SHARE, SLIP
from .laws import independent_law
from .mistakes import ALONE, Suspect
from .motion import Motion, motion_of
from .record import Array
from .series import Series
from .slopes import Estimate, Index

_EVERYTHING = frozenset({GAP, PATH, TURN, SLIP, ACCELERATION, TURNING})
_UNCLEAR = 3.0  # times the usual bound of the slip: a kink stands out as noise
_MORE = 10.0  # times what is asked of the law: less friction than that is none
_STEADY = 0.02  # of the coefficient of friction while it slips


def crude(case: Case) -> Iterator[Suspect]:
    """Yield what is no mistake of the law: crude steps, and slip."""
    yield from _steps(case)
    yield from _friction(case)


@dataclass(frozen=True)
class _Slopes:
    """Their motion with its accelerations, instant by instant."""

    at: Motion
    V_rate: Estimate
    Omega_rate: Estimate


def _slopes(case: Case) -> _Slopes:
    theirs, index = case.theirs, case.view.instants
    at = motion_of(case.system, theirs, case.start, index)
    name, order = ("velocity", 1) if theirs.velocity is not None else ("position", 2)
    V_rate = theirs.slope(name, index, order)
    if theirs.angular_velocity is not None:
        return _Slopes(at, V_rate, theirs.slope("angular_velocity", index))
    second = theirs.slope("orientation", index, 2)
    turned = 2 * (Quaternion.of(second.values) * Quaternion.of(at.orientation).conjugate).array()[:, 1:]
    return _Slopes(at, V_rate, second.scaled(2.0, turned, 2 * second.bias))


def _friction(case: Case) -> Iterator[Suspect]:
    """Try a body that slips under a constant coefficient of friction: Newton and Euler with one contact force."""
    slip = case.series.get(SLIP)
    if slip is None or slip.worst <= 1:
        return
    slopes = _slopes(case)
    at, law, asked = slopes.at, _law_error(case, slopes), LAW_SHARE * case.tolerance
    mismatch, f, N = _reaction(case.system, slopes)
    slipping = slip.ratio > 3
    ahead = at.slip / np.maximum(slip.length, 1e-300)[:, None]
    mu = -(f * ahead).sum(axis=1) / np.where(N != 0, N, np.nan)
    unclear = slip.bound > _UNCLEAR * float(np.median(slip.bound))
    away = _away_from_changes(slipping, unclear, at.index, max(slopes.V_rate.reach, slopes.Omega_rate.reach))
    some = slipping & away
    if (law[~slipping & away] > 1).any() or some.sum() < 3 or not (N[some] > 0).all():
        return
    typical = float(np.median(mu[some]))
    across = np.linalg.norm(f + (mu * N)[:, None] * ahead, axis=1)[some] / N[some]
    steady = max(float(np.abs(mu[some] - typical).max()), float(across.max()))
    if not typical > _MORE * asked or steady > _STEADY * typical + asked:
        return
    plainly = slip.length > 3 * float(np.median(slip.bound))
    ends = float(at.time[np.flatnonzero(plainly)[-1]])
    until = "all through" if slipping[-1] else f"until t = {ends:.4g} s, and rolls from then on"
    if slip.ratio[0] <= 1 and slipping[-1]:
        until = f"from t = {float(at.time[np.flatnonzero(slipping)[0]]):.4g} s on"
    size = max(case.series[TURNING].size if TURNING in case.series else 0.0, 1e-300)
    bound = (asked * size + slopes.Omega_rate.error + _lever(case.system, at) * slopes.V_rate.error)[some]
    note = "Newton and Euler with one contact force"
    rest = Series(TURNING, at.time[some], mismatch[some], size, bound, asked * size, note)
    says = f"It slips {until}: while it does, friction is μN against the slip, with μ = {typical:.4g}."
    numbers = {"friction": typical, "until": ends}
    yield Suspect(
        "slipping",
        says,
        ALONE,
        excused=_EVERYTHING - {TURNING},
        further=lambda _: (rest,),
        numbers=numbers,
        whole=False,
    )


def _law_error(case: Case, slopes: _Slopes) -> Array:
    """Return how far the acceleration is from the law of rolling, over what it may be, at each instant."""
    V_rate, _ = independent_law(case.system, slopes.at)
    law = case.series[ACCELERATION]
    off = np.linalg.norm(slopes.V_rate.values - V_rate, axis=1)
    return np.asarray(off / (law.asked + float(np.median(law.bound)) + slopes.V_rate.error))


def _lever(system: RollingSystem, at: Motion) -> float:
    """Return what Ω̇ makes of an error of V̇, 1/m."""
    _, _, J, _, _ = applied(system, at.samples(), at.velocity)
    least = float(np.linalg.eigvalsh(J).min())
    return float(system.body.mass) * at.arm / least


def _away_from_changes(
    slipping: NDArray[np.bool_], unclear: NDArray[np.bool_], index: Index, reach: int
) -> NDArray[np.bool_]:
    """Leave out instants beside those where slipping begins or ends, or where that is unclear: slopes reach across."""
    near = np.zeros(slipping.size, dtype=bool)
    for change in np.flatnonzero((np.diff(slipping.astype(int)) != 0) | unclear[1:] | unclear[:-1]):
        near |= (index >= index[change] - reach) & (index <= index[change + 1] + reach)
    # One-sided slopes at the ends of the samples reach twice as far.
    near[: int(np.searchsorted(index, index[0] + reach))] |= near[: 1 + int(np.searchsorted(index, 2 * reach))].any()
    return ~near


def _reaction(system: RollingSystem, slopes: _Slopes) -> tuple[Array, Array, Array]:
    """Return Euler's equation's mismatch as an angular acceleration, and f and N of the force that V̇ asks for."""
    at = slopes.at
    F, K, J, gyroscopic, _ = applied(system, at.samples(), at.velocity)
    R = float(system.body.mass) * slopes.V_rate.values - F
    torque = np.einsum("nij,nj->ni", J, slopes.Omega_rate.values) + gyroscopic - K - cross(at.offset, R)
    n = np.broadcast_to(at.contact.normal.array(), R.shape)
    N = (R * n).sum(axis=1)
    return np.linalg.solve(J, torque[..., None])[..., 0], R - N[:, None] * n, N


def _steps(case: Case) -> Iterator[Suspect]:
    """Try Euler's method, one step a sample: exact differences, wrong slopes."""
    theirs = case.theirs
    if theirs.velocity is None or theirs.time.size < 20 or PATH not in case.series:
        return
    step = np.diff(theirs.time)
    h = float(np.median(step))
    if np.abs(step - h).max() > 1e-6 * h:
        return
    moved = np.diff(theirs.position, axis=0) / h
    size = float(np.abs(theirs.velocity).max()) + 1e-300
    rounding = 1e-12 * size + 4 * np.finfo(float).eps * float(np.abs(theirs.position).max()) / h
    slope_error = float(case.series[PATH].length.max())
    for name, V in (("semi-implicit", theirs.velocity[1:]), ("explicit", theirs.velocity[:-1])):
        if np.abs(moved - V).max() > max(rounding, 1e-3 * slope_error):
            continue
        says = (
            f"The steps are crude: {name} Euler with {h:.4g} s a step, of first order, so that halving the step "
            "halves the error. Use a method of higher order, or allow for it with tolerance."
        )
        yield Suspect(
            "crude-steps",
            says,
            frozenset({"steps"}),
            excused=_EVERYTHING - {ACCELERATION},
            further=partial(_differences, case, h),
            numbers={"step": h},
            whole=False,
        )
        return


def _differences(case: Case, h: float, system: RollingSystem) -> tuple[Series, ...]:
    """Compare the steps of the velocity with the law at the state before them."""
    velocity = case.theirs.velocity
    assert velocity is not None  # noqa: S101  _steps() has looked
    index = case.view.instants[case.view.instants < case.theirs.time.size - 1]
    at = motion_of(system, case.theirs, case.start, index)
    V_rate, _ = independent_law(system, at)
    stepped = (velocity[index + 1] - velocity[index]) / h
    mine = case.series[ACCELERATION]
    rounding = 8 * np.finfo(float).eps * float(np.abs(velocity).max()) / h
    bound = np.full(index.size, mine.asked + rounding)
    return (Series(ACCELERATION, at.time, stepped - V_rate, mine.size, bound, mine.asked, "differences of V"),)
