"""Mistakes of mechanics: the numbers mean what they say, and the motion obeys another law."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from fractions import Fraction

import numpy as np

from ..errors import TrundleError
from ..mechanics.bodies import Principal
from ..mechanics.system import RollingSystem
from . import laws
from .diagnosing import FIT_INSTANTS, Case, Trial
from .examining import ACCELERATION, SLIP, TURNING, eliminated_law, examine
from .record import Array

_FITTED = (SLIP, ACCELERATION, TURNING)
_NEAR = 2e-3  # of a number with a reason, where the data tell no better
_HOW = "u̇, the table's motion under the moving contact, was left out of the law"


def fit(case: Case, system_with: Callable[..., RollingSystem], guess: list[float]) -> tuple[Array, Array] | None:
    """Fit numbers of a system to what was found, by least squares of residuals over bounds.

    Parameters
    ----------
    case : Case
        What failed.
    system_with : callable
        Takes the numbers, returns the system.
    guess : list of float
        To start from; also the scale, where it is not zero.

    Returns
    -------
    numbers, doubt : array
        With what each may be off by; None where no fit is to be had.
    """
    from scipy.optimize import least_squares

    scale = np.where(np.asarray(guess) == 0, 1.0, np.abs(guess))
    as_it_is, _ = examine(case.system, case.theirs, case.tolerance, case.start, instants=FIT_INSTANTS)
    bounds = {name: as_it_is[name].bound[:, None] for name in _FITTED if name in as_it_is}

    def residual(x: Array) -> Array:
        series, _ = examine(system_with(*(x * scale)), case.theirs, case.tolerance, case.start, instants=FIT_INSTANTS)
        return np.concatenate([(series[name].residual / bounds[name]).ravel() for name in bounds])

    try:
        found = least_squares(residual, np.asarray(guess) / scale, method="lm", max_nfev=60)
    except (TrundleError, ValueError):
        return None
    slopes = np.asarray(found.jac)
    normal = slopes.T @ slopes
    if not np.isfinite(normal).all() or np.linalg.matrix_rank(normal) < len(guess):
        return None
    # All residuals at their bounds together: the furthest that the numbers can be off.
    doubt = np.sqrt(np.diag(np.linalg.inv(normal)) * found.fun.size)
    return found.x * scale, doubt * scale


def _near(value: float, wanted: float, doubt: float, scale: float) -> bool:
    return abs(value - wanted) <= min(max(doubt, _NEAR * scale), 0.05 * scale)


def rate(case: Case) -> Iterator[Trial]:
    """Fit the rate of the table."""
    if not laws.turns(case.system):
        return
    omega = float(case.system.support.motion.steady_rate or 0.0)
    found = fit(case, lambda w: laws.with_rate(case.system, w), [omega])
    if found is None:
        return
    value, doubt = float(found[0][0]), float(found[1][0])
    size = abs(omega) if omega else 1.0
    known = {
        -omega: ("sign-of-table-rate", "The table turns the wrong way: ω has the other sign"),
        0.0: ("table-motion-ignored", "The table's motion was ignored: they have ω = 0"),
        omega * math.pi / 180: ("degrees-for-radians", "The table's rate was taken for deg/s"),
        omega * 180 / math.pi: ("degrees-for-radians", "The table's rate is in deg/s and was taken for rad/s"),
        omega * 30 / math.pi: ("rate-unit", "The table's rate is in rpm and was taken for rad/s"),
        omega / (2 * math.pi): ("rate-unit", "The table's rate in turns per second was taken for rad/s"),
        omega * 2 * math.pi: ("rate-unit", "The table's rate in rad/s was taken for turns per second"),
    }
    numbers = {"rate": value}
    for wanted, (name, says) in known.items():
        if wanted != omega and _near(value, wanted, doubt, max(abs(wanted), size if wanted == 0 else 0.0)):
            system = laws.with_rate(case.system, wanted)
            yield Trial(name, f"{says}; {value:.6g} rad/s fits, for {omega:.6g}.", system=system, numbers=numbers)
            return
    says = f"The table turns at another rate: {value:.6g} rad/s fits, for {omega:.6g}."
    yield Trial("wrong-table-rate", says, system=laws.with_rate(case.system, value), numbers=numbers, named=False)


def inertia(case: Case) -> Iterator[Trial]:
    """Fit the inertia ratio, or for a body with principal moments the factor of all three."""
    body = case.system.body
    found = fit(case, lambda s: laws.with_inertia(case.system, math.exp(s)), [0.0])
    if found is None:
        return
    factor, doubt = math.exp(found[0][0]), float(found[1][0])
    if not 1e-3 < factor < 1e3 or abs(found[0][0]) <= doubt:
        return
    if isinstance(body.inertia, Principal) or not body.is_isotropic_sphere:
        says = f"The moments of inertia are wrong: {factor:.5g} times as large ones fit."
        system = laws.with_inertia(case.system, factor)
        yield Trial("wrong-inertia", says, system=system, numbers={"factor": factor}, named=False)
        return
    k = float(body.inertia_ratio)
    value, names = factor * k, {2 / 5: "solid sphere", 2 / 3: "thin shell", 1 / 2: "solid cylinder", 1.0: "hoop"}
    near = [w for w in names if _near(value, w, doubt * value, w)]
    reason = f" (a {names[near[0]]} has {Fraction(near[0]).limit_denominator(9)})" if near else ""
    says = f"The inertia ratio is wrong: k = {value:.6g} fits{reason}, for {k:.6g}."
    system = laws.with_inertia(case.system, factor)
    yield Trial("wrong-inertia-ratio", says, system=system, numbers={"inertia_ratio": value}, named=bool(reason))


def push(case: Case) -> Iterator[Trial]:
    """Fit a constant force more or less: gravity, tilt, a load."""
    system = case.system
    for load in system.loads:
        says = f"A load was left out: {type(load).__name__}."
        yield Trial("load-left-out", says, system=laws.without_load(system, load))
    found = fit(case, lambda x, y: laws.with_push(system, x, y), [0.0, 0.0])
    if found is None:
        return
    (x, y), doubt = found[0], float(np.hypot(*found[1]))
    if math.hypot(x, y) <= doubt:
        return
    g, tilt = float(system.gravity), float(system.support.tilt)
    pull, numbers = g * math.sin(tilt), {"x": float(x), "y": float(y)}
    named = _pushes(system, g, tilt, pull)
    for (dx, dy), name, says in named:
        change = max(math.hypot(dx, dy), 1e-300)
        if math.hypot(x - dx, y - dy) <= min(max(doubt, _NEAR * change), 0.05 * change):
            yield Trial(name, says, system=laws.with_push(system, dx, dy), numbers=numbers)
            return
    down = (pull + x) / g if g else math.inf
    lean = f", as on a tilt of {math.degrees(math.asin(down)):.4g}°" if abs(down) < 1 and abs(y) <= doubt else ""
    says = f"Another constant force acts: {x:.5g} m/s² more down the slope and {y:.5g} across it fit{lean}."
    yield Trial("wrong-gravity-or-force", says, system=laws.with_push(system, x, y), numbers=numbers, named=False)


def _pushes(system: RollingSystem, g: float, tilt: float, pull: float) -> list[tuple[tuple[float, float], str, str]]:
    """Return the constant accelerations that a mistake with gravity or tilt adds, with the mistake."""
    if not tilt or not g:
        return []
    degrees = math.degrees(tilt)
    named = [
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
    if system.body.is_isotropic_sphere:
        k = float(system.body.inertia_ratio)
        named += [
            (
                (k * pull, 0.0),
                "rolling-factor",
                "The ball slides down without friction: 1/(1 + k), which rolling takes of g sin α, was left out.",
            ),
            ((-pull * k / (1 + k), 0.0), "rolling-factor", "The factor 1/(1 + k) of g sin α was taken twice."),
        ]
    for other in (9.81, 9.8, 10.0, 9.80665):
        if abs(other - g) > 1e-9:
            named.append((((other - g) * math.sin(tilt), 0.0), "wrong-gravity", f"g = {other:g} m/s², for {g:g}."))
    return named


def left_out(case: Case) -> Iterator[Trial]:
    """Try the law with a term forgotten."""
    if isinstance(case.system.body.inertia, Principal):
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


LAWS = (rate, inertia, push, left_out)
