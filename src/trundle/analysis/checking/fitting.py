"""Numbers of a system that fit what somebody has: a free number explains more easily than one with a reason."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...errors import TrundleError
from ...mechanics.loads import at_rest
from ...mechanics.system import RollingSystem
from . import laws
from .laws import Law
from .mistakes import Suspect, constant_pull, rate_of
from .record import Array

_LARGEST = 9.0  # of the logarithm of a factor
_TINY = 1e-6  # of a number: its doubt is not worth a word
_STEP = float(np.sqrt(np.finfo(float).eps))  # of a number, to its slopes
_MOST_TRIED = 60  # sets of numbers
_ENOUGH = {"ftol": 1e-8, "xtol": 1e-8, "gtol": 1e-8}


@dataclass(frozen=True)
class Family:
    """Systems that differ from the one in hand by a number or two."""

    applies: Callable[[RollingSystem], bool]  # whether a system has such numbers
    guess: Callable[[RollingSystem], list[float]]  # the numbers of a system, to start a fit from
    system: Callable[[RollingSystem, Array], RollingSystem]  # (system, numbers) -> the system with these numbers
    # (system, fitted numbers, doubt) -> what is then suspected
    named: Callable[[RollingSystem, Array, Array], Iterator[Suspect]]
    # (system, numbers) -> the law with these numbers, where it is no system that has them
    law: Callable[[RollingSystem, Array], Law] | None = None

    def suspect(self, numbers: Array) -> Suspect:
        """Return numbers as something to try."""
        law = None if self.law is None else _LateLaw(self.law, numbers)
        return Suspect("", "", frozenset(), partial(self.system, x=numbers), law)  # type: ignore[call-arg]


@dataclass(frozen=True)
class _LateLaw:
    """A law that is made for the system that it is asked of."""

    law: Callable[[RollingSystem, Array], Law]
    numbers: Array

    def __call__(self, system: RollingSystem, at: laws.Instants) -> laws.Rates:
        return self.law(system, self.numbers)(system, at)


def least_squares(
    residuals: Callable[[Array], Array], guess: list[float], whole: Callable[[Array], Array] | None = None
) -> tuple[Array, Array] | None:
    """Fit numbers so that residuals, over their bounds, are least; return them with their doubts.

    Parameters
    ----------
    residuals : callable
        Takes several sets of n numbers, (k, n), and returns the residuals of each, (k, m).
    guess : list of n floats
        To start from.
    whole : callable, optional
        Takes one set, (n,); what fewer rows stand for.
    """
    from scipy import optimize

    scale = np.where(np.asarray(guess) == 0, 1.0, np.abs(guess))
    last: dict[bytes, Array] = {}

    def residual(x: Array) -> Array:
        key = x.tobytes()
        if key not in last:
            last.clear()
            last[key] = residuals(x[None] * scale)[0]
        return last[key]

    def slopes(x: Array) -> Array:
        beside = x + np.diag(np.copysign(_STEP * np.maximum(np.abs(x), 1.0), x))
        return (residuals(beside * scale) - residual(x)).T / np.diag(beside - x)

    try:
        x0 = np.asarray(guess) / scale
        if not np.isfinite(residual(x0)).all():
            return None
        # MINPACK without what SciPy's `least_squares` puts around each slope, which takes longer than the slope.
        x = optimize.leastsq(residual, x0, Dfun=slopes, full_output=True, maxfev=_MOST_TRIED, **_ENOUGH)[0]
        J = slopes(x)
    except (TrundleError, ValueError, ArithmeticError):
        return None
    normal = J.T @ J
    if not np.isfinite(normal).all() or np.linalg.matrix_rank(normal) < len(guess):
        return None
    # As if all residuals were as far off as the worst that is left, and all together.
    left = residual(x) if whole is None else whole(x * scale)
    doubt = max(float(np.abs(left).max()), 1e-6) * np.sqrt(np.diag(np.linalg.inv(normal)) * left.size)
    return x * scale, doubt * scale


def fitted(family: Family, system: RollingSystem, residual: Callable[[Suspect], Array]) -> Iterator[Suspect]:
    """Yield what a fit of one family suspects."""
    if not family.applies(system):
        return
    found = least_squares(
        lambda sets: np.array([residual(family.suspect(numbers)) for numbers in sets]), family.guess(system)
    )
    if found is not None:
        yield from family.named(system, *found)


def _about(value: float, doubt: float) -> str:
    """Return a number with its doubt, if that is worth a word."""
    return f"{value:.6g}" if doubt <= _TINY * abs(value) else f"{value:.4g} ± {doubt:.1g}"


def _rates(system: RollingSystem, numbers: Array, doubts: Array) -> Iterator[Suspect]:
    """Say which rate of the table fits."""
    omega, value, doubt = rate_of(system), float(numbers[0]), float(doubts[0])
    if abs(value - omega) > doubt:
        says = f"The table turns at another rate: {_about(value, doubt)} rad/s fits, for {omega:.6g}."
        changed = partial(laws.with_rate, rate=value)
        yield Suspect("wrong-table-rate", says, frozenset({"rate"}), changed, numbers={"rate": value}, named=False)


def _circles(system: RollingSystem, numbers: Array, doubts: Array) -> Iterator[Suspect]:
    """Say at which rate the ball goes round."""
    omega, value, doubt = rate_of(system), float(numbers[0]), float(doubts[0])
    k = float(system.body.inertia_ratio)
    if abs(value - k / (1 + k)) > doubt:
        says = (
            f"It goes round at another rate: κ = {_about(value * omega, doubt * abs(omega))} rad/s fits, where "
            f"ωk/(1 + k) = {omega * k / (1 + k):.5g}."
        )
        numbers_ = {"circle": value * omega}
        law = laws.circling(value)
        yield Suspect("wrong-circle", says, frozenset({"law", "rate"}), law=law, numbers=numbers_, named=False)


def _inertias(system: RollingSystem, numbers: Array, doubts: Array) -> Iterator[Suspect]:
    """Say which inertia fits: its ratio, or for principal moments the factor of all three."""
    if abs(numbers[0]) > math.log(1e3) or abs(numbers[0]) <= doubts[0]:
        return
    factor, doubt = math.exp(numbers[0]), float(doubts[0])
    changed, touched = partial(laws.with_inertia, factor=factor), frozenset({"inertia"})
    if not system.body.is_isotropic_sphere:
        says = f"The moments of inertia are wrong: {_about(factor, doubt * factor)} times as large ones fit."
        yield Suspect("wrong-inertia", says, touched, changed, numbers={"factor": factor}, named=False)
        return
    k = float(system.body.inertia_ratio)
    says = f"The inertia ratio is wrong: k = {_about(factor * k, doubt * factor * k)} fits, for {k:.6g}."
    numbers_ = {"inertia_ratio": factor * k}
    yield Suspect("wrong-inertia-ratio", says, touched, changed, numbers=numbers_, named=False)


def _pulls(system: RollingSystem, numbers: Array, doubts: Array) -> Iterator[Suspect]:
    """Say which constant force fits."""
    (x, y), doubt = (float(part) for part in numbers), float(np.hypot(*doubts))
    if math.hypot(x, y) <= doubt:
        return
    if any(math.hypot(x + fx, y + fy) <= max(doubt, _TINY * math.hypot(x, y)) for fx, fy in _constant(system)):
        return  # a load that was left out, which is suspected by itself
    g, down = float(system.gravity), constant_pull(system)[0]
    sine = (down + x) / g if g else math.inf
    lean = f", as on a tilt of {math.degrees(math.asin(sine)):.4g}°" if abs(sine) < 1 and abs(y) <= doubt else ""
    says = f"Another constant force acts: {x:.5g} m/s² more down the slope and {y:.5g} across it fit{lean}."
    changed = partial(laws.with_pull, x=x, y=y)
    touched = frozenset({"pull", "tilt", "gravity"})
    yield Suspect("wrong-gravity-or-force", says, touched, changed, numbers={"x": x, "y": y}, named=False)


def _constant(system: RollingSystem) -> list[tuple[float, float]]:
    """Return the constant forces among the loads along the plane, as accelerations, m/s²."""
    m = float(system.body.mass)
    forces = [load.force(at_rest(m)) for load in system.loads if load.constant]
    return [(float(force.x) / m, float(force.y) / m) for force in forces]


def _any(_: RollingSystem) -> bool:
    return True


def _rate(s: RollingSystem, x: Array) -> RollingSystem:
    return laws.with_rate(s, float(x[0]))


def _inertia(s: RollingSystem, x: Array) -> RollingSystem:
    return laws.with_inertia(s, math.exp(float(np.clip(x[0], -_LARGEST, _LARGEST))))


def _pull(s: RollingSystem, x: Array) -> RollingSystem:
    return laws.with_pull(s, float(x[0]), float(x[1]))


def _same(s: RollingSystem, x: Array) -> RollingSystem:  # noqa: ARG001
    return s


def _goes_round(system: RollingSystem) -> bool:
    return bool(rate_of(system)) and laws.turns(system) and system.body.is_isotropic_sphere


def _share(system: RollingSystem) -> list[float]:
    k = float(system.body.inertia_ratio)
    return [k / (1 + k)]


FAMILIES = (
    Family(laws.turns, lambda s: [rate_of(s)], _rate, _rates),
    Family(_any, lambda _: [0.0], _inertia, _inertias),
    Family(_any, lambda _: [0.0, 0.0], _pull, _pulls),
    Family(_goes_round, _share, _same, _circles, lambda _, x: laws.circling(float(x[0]))),
)
