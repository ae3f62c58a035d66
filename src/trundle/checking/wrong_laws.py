"""Mistakes of mechanics: the numbers mean what they say, and the motion obeys another law."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ..errors import TrundleError
from ..mechanics.bodies import Principal, Tensor
from ..mechanics.loads import at_rest
from ..mechanics.system import RollingSystem
from . import laws
from .diagnosing import FIT_INSTANTS, Case, Trial
from .examining import ACCELERATION, SLIP, TURNING, eliminated_law, examine
from .record import Array

_FITTED = (SLIP, ACCELERATION, TURNING)
_NEAR = 2e-3  # of a number with a reason, where the data tell no better
_HOW = "u̇, the table's motion under the moving contact, was left out of the law"


@dataclass(frozen=True)
class Family:
    """Systems that differ from the one in hand by a number or two.

    Parameters
    ----------
    applies : callable
        Whether a system has such numbers.
    guess : callable
        The numbers of a system, to start a fit from.
    system : callable
        (system, numbers) -> the system with these numbers.
    named : callable
        (system, fitted numbers, doubt) -> trials, with the reason for the numbers where there is one.
    """

    applies: Callable[[RollingSystem], bool]
    guess: Callable[[RollingSystem], list[float]]
    system: Callable[[RollingSystem, Array], RollingSystem]
    named: Callable[[RollingSystem, Array, Array], Iterator[Trial]]


def least_squares(residual: Callable[[Array], Array], guess: list[float]) -> tuple[Array, Array] | None:
    """Fit numbers so that residuals, over their bounds, are least.

    Parameters
    ----------
    residual : callable
        Takes the numbers.
    guess : list of float
        To start from; also the scale, where it is not zero.

    Returns
    -------
    numbers, doubt : array
        With what each may be off by; None where no fit is to be had.
    """
    from scipy import optimize

    scale = np.where(np.asarray(guess) == 0, 1.0, np.abs(guess))

    def scaled(x: Array) -> Array:
        return residual(x * scale)

    try:
        found = optimize.least_squares(scaled, np.asarray(guess) / scale, method="lm", max_nfev=60)
    except (TrundleError, ValueError, ArithmeticError):
        return None
    slopes = np.asarray(found.jac)
    normal = slopes.T @ slopes
    if not np.isfinite(normal).all() or np.linalg.matrix_rank(normal) < len(guess):
        return None
    # As if all residuals were as far off as the worst that is left, and all together.
    left = max(float(np.abs(found.fun).max()), 1e-6)
    doubt = left * np.sqrt(np.diag(np.linalg.inv(normal)) * found.fun.size)
    return found.x * scale, doubt * scale


def _fitted(family: Family) -> Callable[[Case], Iterator[Trial]]:
    """Return the hypothesis that fits a family to what was found."""

    def hypothesis(case: Case) -> Iterator[Trial]:
        if not family.applies(case.system):
            return
        as_it_is, _ = examine(case.system, case.theirs, case.tolerance, case.start, instants=FIT_INSTANTS)
        bounds = {name: as_it_is[name].bound[:, None] for name in _FITTED if name in as_it_is}

        def residual(numbers: Array) -> Array:
            system = family.system(case.system, numbers)
            series, _ = examine(system, case.theirs, case.tolerance, case.start, instants=FIT_INSTANTS)
            return np.concatenate([(series[name].residual / bounds[name]).ravel() for name in bounds])

        found = least_squares(residual, family.guess(case.system))
        if found is not None:
            yield from family.named(case.system, *found)

    return hypothesis


def _near(value: float, wanted: float, doubt: float, scale: float) -> bool:
    return abs(value - wanted) <= min(max(doubt, _NEAR * scale), 0.05 * scale)


def _rate_of(system: RollingSystem) -> float:
    return float(system.support.motion.steady_rate or 0.0)


def _rates(system: RollingSystem, numbers: Array, doubts: Array) -> Iterator[Trial]:
    """Say what the rate of the table means that fits."""
    omega, value, doubt = _rate_of(system), float(numbers[0]), float(doubts[0])
    value = 0.0 if abs(value) <= 1e-9 * abs(omega) else value
    known = {
        -omega: ("sign-of-table-rate", "The table turns the wrong way: ω has the other sign"),
        0.0: ("table-motion-ignored", "The table's motion was ignored: they have ω = 0"),
        omega * math.pi / 180: ("degrees-for-radians", "The table's rate was taken for deg/s"),
        omega * 180 / math.pi: ("degrees-for-radians", "The table's rate is in deg/s and was taken for rad/s"),
        omega * 30 / math.pi: ("rate-unit", "The table's rate is in rpm and was taken for rad/s"),
        omega / (2 * math.pi): ("rate-unit", "The table's rate in turns per second was taken for rad/s"),
        omega * 2 * math.pi: ("rate-unit", "The table's rate in rad/s was taken for turns per second"),
    }
    found = {"rate": value}
    for wanted, (name, says) in known.items():
        if omega and _near(value, wanted, doubt, abs(wanted or omega)):
            says = f"{says}; {value:.6g} rad/s fits, for {omega:.6g}."
            yield Trial(name, says, system=laws.with_rate(system, wanted), numbers=found)
            return
    if abs(value - omega) > doubt:
        says = f"The table turns at another rate: {value:.6g} rad/s fits, for {omega:.6g}."
        yield Trial("wrong-table-rate", says, system=laws.with_rate(system, value), numbers=found, named=False)


def _inertias(system: RollingSystem, numbers: Array, doubts: Array) -> Iterator[Trial]:
    """Say what the inertia means that fits: its ratio, or for principal moments the factor of all three."""
    if abs(numbers[0]) > math.log(1e3) or abs(numbers[0]) <= doubts[0]:
        return
    factor, doubt = math.exp(numbers[0]), float(doubts[0])
    changed = laws.with_inertia(system, factor)
    if isinstance(system.body.inertia, (Principal, Tensor)) or not system.body.is_isotropic_sphere:
        says = f"The moments of inertia are wrong: {factor:.5g} times as large ones fit."
        yield Trial("wrong-inertia", says, system=changed, numbers={"factor": factor}, named=False)
        return
    k = float(system.body.inertia_ratio)
    value, names = factor * k, {2 / 5: "solid sphere", 2 / 3: "thin shell", 1 / 2: "solid cylinder", 1.0: "hoop"}
    near = [w for w in names if _near(value, w, doubt * value, w)]
    reason = f" (a {names[near[0]]} has {Fraction(near[0]).limit_denominator(9)})" if near else ""
    says = f"The inertia ratio is wrong: k = {value:.6g} fits{reason}, for {k:.6g}."
    yield Trial("wrong-inertia-ratio", says, system=changed, numbers={"inertia_ratio": value}, named=bool(reason))


def _pushed(system: RollingSystem, numbers: Array, doubts: Array) -> Iterator[Trial]:
    """Say what the constant force means that fits: gravity, tilt, or a load."""
    (x, y), doubt = (float(part) for part in numbers), float(np.hypot(*doubts))
    if math.hypot(x, y) <= doubt:
        return
    g, tilt = float(system.gravity), float(system.support.tilt)
    pull, found = g * math.sin(tilt), {"x": x, "y": y}
    for (dx, dy), name, says in _pushes(system, g, tilt, pull):
        change = max(math.hypot(dx, dy), 1e-300)
        if math.hypot(x - dx, y - dy) <= min(max(doubt, _NEAR * change), 0.05 * change):
            yield Trial(name, says, system=laws.with_push(system, dx, dy), numbers=found)
            return
    if any(math.hypot(x + fx, y + fy) <= max(doubt, 1e-6 * math.hypot(x, y)) for fx, fy in _constant(system)):
        return  # a load that was left out, which `loads` tries by itself
    down = (pull + x) / g if g else math.inf
    lean = f", as on a tilt of {math.degrees(math.asin(down)):.4g}°" if abs(down) < 1 and abs(y) <= doubt else ""
    says = f"Another constant force acts: {x:.5g} m/s² more down the slope and {y:.5g} across it fit{lean}."
    yield Trial("wrong-gravity-or-force", says, system=laws.with_push(system, x, y), numbers=found, named=False)


def _pushes(system: RollingSystem, g: float, tilt: float, pull: float) -> list[tuple[tuple[float, float], str, str]]:
    """Return the constant accelerations that a mistake with gravity or tilt adds, with the mistake."""
    named = _rolling_factors(system, pull)
    if not tilt or not g:
        return named
    degrees = math.degrees(tilt)
    named += [
        ((-pull, 0.0), "tilt-left-out", "The tilt was left out: gravity has no part along the slope."),
        ((-2 * pull, 0.0), "sign-of-tilt", "The tilt has the wrong sign: the first axis points down the slope."),
        ((-pull, pull), "slope-axis", "Gravity pulls along the second axis; the first one points down the slope."),
        ((-pull, -pull), "slope-axis", "Gravity pulls against the second axis; the first one points down the slope."),
        (
            (g * math.sin(degrees) - pull, 0.0),
            "degrees-for-radians",
            f"The tilt of {degrees:.4g}° was taken for {degrees:.4g} rad.",
        ),
        (
            (g * math.sin(math.radians(tilt)) - pull, 0.0),
            "degrees-for-radians",
            f"The tilt of {tilt:.4g} rad was taken for {tilt:.4g}°.",
        ),
        ((g * math.cos(tilt) - pull, 0.0), "wrong-gravity", "g cos α pulls down the slope where g sin α should."),
    ]
    for other in (9.81, 9.8, 10.0, 9.80665):
        if abs(other - g) > 1e-9:
            named.append((((other - g) * math.sin(tilt), 0.0), "wrong-gravity", f"g = {other:g} m/s², for {g:g}."))
    return named


def _constant(system: RollingSystem) -> list[tuple[float, float]]:
    """Return the constant forces among the loads along the plane, as accelerations, m/s²."""
    m, still = float(system.body.mass), at_rest(float(system.body.mass))
    forces = [load.force(still) for load in system.loads if load.constant]
    return [(float(force.x) / m, float(force.y) / m) for force in forces]


def _rolling_factors(system: RollingSystem, pull: float) -> list[tuple[tuple[float, float], str, str]]:
    """Return what forgetting 1/(1 + k), or taking it twice, does to all constant forces together."""
    if not system.body.is_isotropic_sphere:
        return []
    k, constant = float(system.body.inertia_ratio), _constant(system)
    x, y = pull + sum(fx for fx, _ in constant), sum(fy for _, fy in constant)
    if math.hypot(x, y) == 0:
        return []
    says = "It is pushed as if it slid without friction: the factor 1/(1 + k), which rolling makes, was left out."
    return [
        ((k * x, k * y), "rolling-factor", says),
        ((-k * x / (1 + k), -k * y / (1 + k)), "rolling-factor", "The factor 1/(1 + k) of rolling was taken twice."),
    ]


def left_out(case: Case) -> Iterator[Trial]:
    """Try the law with a term forgotten."""
    if isinstance(case.system.body.inertia, (Principal, Tensor)):
        says = "Ω×JΩ was left out of Euler's equation: the moments of inertia are not all the same."
        yield Trial("missing-gyroscopic-term", says, system=laws.without_gyroscopic(case.system), law=eliminated_law)
    if case.system.support.motion.steady_rate == 0:
        return
    system, slip = laws.without_carrying(case.system), case.series.get(SLIP)
    if slip is None or slip.ratio[0] <= 1:  # it begins to slip only as this mistake makes it
        slips = frozenset({SLIP})
        yield Trial("missing-carrying-term", f"{_HOW}.", system=system, law=eliminated_law, excused=slips)

    def constrained(_: RollingSystem, at: laws.TheirMotion) -> tuple[Array, Array]:
        return laws.constrained_without_carrying(case.system, at)

    yield Trial("missing-carrying-term", f"{_HOW} of Ω, and V follows from V = u − Ω×ρ.", law=constrained)


def loads(case: Case) -> Iterator[Trial]:
    """Try each load left out."""
    for load in case.system.loads:
        says = f"A load was left out: {type(load).__name__}."
        yield Trial("load-left-out", says, system=laws.without_load(case.system, load))


RATE = Family(laws.turns, lambda s: [_rate_of(s)], lambda s, x: laws.with_rate(s, float(x[0])), _rates)
INERTIA = Family(
    lambda _: True, lambda _: [0.0], lambda s, x: laws.with_inertia(s, math.exp(float(np.clip(x[0], -9, 9)))), _inertias
)
PUSH = Family(lambda _: True, lambda _: [0.0, 0.0], lambda s, x: laws.with_push(s, float(x[0]), float(x[1])), _pushed)
FAMILIES = (RATE, INERTIA, PUSH)
LAWS = (*map(_fitted, FAMILIES), loads, left_out)
