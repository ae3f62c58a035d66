"""The mistakes that people make with the law of rolling: other numbers, another law, a term left out.

One list serves trajectories and equations. A mistake changes the system, or the law, or both; mistakes that change
different things can be made together, and are then tried together.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import partial

from ...mechanics.loads import at_rest
from ...mechanics.system import RollingSystem
from . import laws
from .examining import SLIP
from .laws import Law
from .record import ExternalTrajectory
from .series import Series

RATIOS = {2 / 5: "solid sphere", 2 / 3: "thin shell", 1 / 2: "solid cylinder", 1.0: "hoop"}
GRAVITIES = (9.80665, 9.81, 9.8, 10.0)
_SAME = 1e-9  # of a number
ALONE = frozenset({"everything"})  # touched by what is tried with nothing else
_SLIPS = frozenset({SLIP})


@dataclass(frozen=True)
class Suspect:
    """One mistake, as it can be tried."""

    name: str  # short, for programs
    says: str  # what the mistake is, as a sentence
    touches: frozenset[str]  # what it changes; two that touch the same are not tried together
    # the system that they had by mistake, from the right one
    system: Callable[[RollingSystem], RollingSystem] | None = None
    law: Law | None = None  # the law that they had by mistake
    # their samples without the mistake, from what they gave
    theirs: Callable[[ExternalTrajectory], ExternalTrajectory] | None = None
    excused: frozenset[str] = frozenset()  # checks that the mistake itself spoils
    begins: frozenset[str] = frozenset()  # of these, the ones that hold at the first instant
    # further checks that the mistake must pass, of a system
    further: Callable[[RollingSystem], tuple[Series, ...]] | None = None
    numbers: dict[str, float] = field(default_factory=dict)  # what the mistake makes of a number
    named: bool = True  # whether its number has a reason
    textbook: bool = False  # whether data that cannot tell it from the truth tell little
    whole: bool = True  # whether integrals, and the distance from a run of ours, must come out right, too


def together(suspects: Sequence[Suspect]) -> bool:
    """Tell whether mistakes can be made together."""
    touched = [part for suspect in suspects for part in suspect.touches]
    return len(touched) == len(set(touched)) and (len(suspects) == 1 or not ALONE & set(touched))


def with_mistakes(system: RollingSystem, suspects: Sequence[Suspect]) -> RollingSystem:
    """Return the system that somebody had who made mistakes: gravity and tilt first, of which the pull is made."""
    for suspect in sorted(suspects, key=lambda one: "pull" in one.touches):
        system = suspect.system(system) if suspect.system is not None else system
    return system


def law_of(suspects: Sequence[Suspect], otherwise: Law = laws.independent_law) -> Law:
    """Return the law that somebody had who made mistakes."""
    return next((suspect.law for suspect in suspects if suspect.law is not None), otherwise)


def mechanical(system: RollingSystem, *, turning: bool = True) -> Iterator[Suspect]:
    """Yield the mistakes of mechanics that can be made with a system, the commonest first.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.0), tilt=0.05)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table, gravity=9.81)
    >>> [suspect.name for suspect in mechanical(system)][:3]
    ['table-motion-ignored', 'sign-of-table-rate', 'degrees-for-radians']
    """
    yield from _rates(system)
    yield from _ratios(system)
    yield from _factors(system)
    yield from _tilts(system)
    yield from _gravities(system)
    yield from _terms(system)
    yield from _circles(system, turning)


def rate_of(system: RollingSystem) -> float:
    """Return the steady rate of the support, rad/s, with its sign; 0 where it has none."""
    return float(system.support.motion.steady_rate or 0.0)


def known_rates(omega: float) -> dict[str, tuple[float, str]]:
    """Return what mistakes make of the rate of a table, with what is then said."""
    return {
        "table-motion-ignored": (0.0, "The table's motion was ignored: they have ω = 0"),
        "sign-of-table-rate": (-omega, "The table turns the wrong way: ω has the other sign"),
        "degrees-for-radians": (math.degrees(omega), "The table's rate is in deg/s and was taken for rad/s"),
        "degrees-for-radians ": (math.radians(omega), "The table's rate was taken for deg/s"),
        "rate-unit": (omega * 30 / math.pi, "The table's rate is in rpm and was taken for rad/s"),
        "rate-unit ": (omega / (2 * math.pi), "The table's rate in turns per second was taken for rad/s"),
        "rate-unit  ": (omega * 2 * math.pi, "The table's rate in rad/s was taken for turns per second"),
    }


def _rates(system: RollingSystem) -> Iterator[Suspect]:
    omega = rate_of(system)
    if not omega or not laws.turns(system):
        return
    for name, (rate, says) in known_rates(omega).items():
        yield Suspect(
            name.strip(),
            f"{says}; {rate:.6g} rad/s fits, for {omega:.6g}.",
            frozenset({"rate"}),
            system=partial(laws.with_rate, rate=rate),
            numbers={"rate": rate},
            textbook=name in ("table-motion-ignored", "sign-of-table-rate"),
        )


def _ratios(system: RollingSystem) -> Iterator[Suspect]:
    if not system.body.is_isotropic_sphere:
        return
    k = float(system.body.inertia_ratio)
    for ratio, kind in RATIOS.items():
        if abs(ratio - k) > _SAME:
            reason = f"a {kind} has {Fraction(ratio).limit_denominator(9)}"
            yield Suspect(
                "wrong-inertia-ratio",
                f"The inertia ratio is wrong: k = {ratio:.6g} fits ({reason}), for {k:.6g}.",
                frozenset({"inertia"}),
                system=partial(laws.with_inertia, factor=ratio / k),
                numbers={"inertia_ratio": ratio},
                textbook=kind in ("solid sphere", "thin shell"),
            )


def constant_pull(system: RollingSystem) -> tuple[float, float, float]:
    """Return gravity and the constant forces together, as an acceleration in the support frame, m/s²."""
    m = float(system.body.mass)
    still, parts = at_rest(m), [float(part) for part in system.weight.acceleration]
    for load in system.loads:
        if load.constant:
            parts = [part + float(more) / m for part, more in zip(parts, load.force(still), strict=True)]
    return parts[0], parts[1], parts[2]


def _times(system: RollingSystem, factor: float) -> RollingSystem:
    """Return the system pulled by its weight and its constant forces some other times."""
    x, y, z = constant_pull(system)
    return laws.with_pull(system, (factor - 1) * x, (factor - 1) * y, (factor - 1) * z)


def _factors(system: RollingSystem) -> Iterator[Suspect]:
    """Yield what can be done wrong with the factor 1/(1 + k)."""
    if not system.body.is_isotropic_sphere:
        return
    k = float(system.body.inertia_ratio)
    for factor, says, known in (
        (1 + k, "It is pushed as if it slid without friction: the factor 1/(1 + k) of rolling was left out", True),
        ((1 + k) ** 2, "The factor of rolling is upside down: 1 + k stands for 1/(1 + k)", False),
        (1 / (1 + k), "The factor 1/(1 + k) of rolling was taken twice", False),
    ):
        pushed = partial(_times, factor=factor)
        numbers = {"factor": factor}
        yield Suspect("rolling-factor", f"{says}.", frozenset({"pull"}), pushed, numbers=numbers, textbook=known)


def _tilted(system: RollingSystem, tilt: float) -> RollingSystem:
    """Return the system pulled as on another tilt, which need not be one that a support may have."""
    g, now = float(system.gravity), float(system.support.tilt)
    return laws.with_pull(system, g * (math.sin(tilt) - math.sin(now)), 0.0, g * (math.cos(now) - math.cos(tilt)))


def _across(system: RollingSystem, side: float) -> RollingSystem:
    pull = float(system.gravity) * math.sin(float(system.support.tilt))
    return laws.with_pull(system, -pull, side * pull)


def _tilts(system: RollingSystem) -> Iterator[Suspect]:
    tilt = float(system.support.tilt)
    if not tilt or not float(system.gravity):
        return
    degrees = math.degrees(tilt)
    for name, other, says in (
        ("tilt-left-out", 0.0, "The tilt was left out: gravity has no part along the slope"),
        ("sign-of-tilt", -tilt, "The tilt has the wrong sign: the first axis points down the slope"),
        ("degrees-for-radians", degrees, f"The tilt of {degrees:.4g}° was taken for {degrees:.4g} rad"),
        ("degrees-for-radians", math.radians(tilt), f"The tilt of {tilt:.4g} rad was taken for {tilt:.4g}°"),
        ("wrong-gravity", math.pi / 2 - tilt, "g cos α pulls down the slope where g sin α should"),
    ):
        pulled = partial(_tilted, tilt=other)
        known = name in ("tilt-left-out", "sign-of-tilt")
        yield Suspect(name, f"{says}.", frozenset({"tilt"}), pulled, numbers={"tilt": other}, textbook=known)
    for side, how in ((1.0, "along"), (-1.0, "against")):
        says = f"Gravity pulls {how} the second axis; the first one points down the slope."
        yield Suspect("slope-axis", says, frozenset({"tilt"}), partial(_across, side=side))


def _with_gravity(system: RollingSystem, g: float) -> RollingSystem:
    return replace(system, gravity=g)


def _gravities(system: RollingSystem) -> Iterator[Suspect]:
    """Yield other values of g, where it is of any consequence."""
    g = float(system.gravity)
    flat = system.support.surface.flat
    if not g or (flat and not float(system.support.tilt)):
        return
    for other in GRAVITIES:
        if abs(other - g) > _SAME:
            says = f"Gravity is another: g = {other:g} m/s², for {g:g}."
            changed = partial(_with_gravity, g=other)
            yield Suspect("wrong-gravity", says, frozenset({"gravity"}), changed, numbers={"gravity": other})
    if not flat:
        says = "Gravity was left out."
        changed = partial(_with_gravity, g=0.0)
        yield Suspect(
            "gravity-left-out", says, frozenset({"gravity"}), changed, numbers={"gravity": 0.0}, textbook=True
        )


def _terms(system: RollingSystem) -> Iterator[Suspect]:
    """Yield terms that may be forgotten."""
    for i, load in enumerate(system.loads):
        says = f"A load was left out: {load.word}."
        left = partial(laws.without_load, load=load)
        yield Suspect("load-left-out", says, frozenset({f"load {i}"}), left, textbook=True)
    if not system.body.inertia.isotropic:
        says = "Ω×JΩ was left out of Euler's equation: the moments of inertia are not all the same."
        name, touched = "missing-gyroscopic-term", frozenset({"law", "inertia"})
        yield Suspect(name, says, touched, laws.without_gyroscopic, laws.eliminated_law, textbook=True)
    if system.support.motion.steady_rate == 0:
        return
    how, name = "u̇, the table's motion under the moving contact, was left out of the law", "missing-carrying-term"
    both = frozenset({"law", "rate"})
    yield Suspect(name, f"{how}.", both, laws.without_carrying, laws.eliminated_law, excused=_SLIPS, begins=_SLIPS)
    says = f"{how} of Ω, and V follows from V = u − Ω×ρ."
    yield Suspect(name, says, both, law=laws.without_carrying_in_turning)


def _circles(system: RollingSystem, turning: bool) -> Iterator[Suspect]:
    """Yield no friction at all, and other rates of the circle that a ball goes round in on a turning table."""
    says = "It slides as a puck does, without friction: neither the table nor the spin acts on its path."
    puck = frozenset({"law", "rate", "inertia", "pull"})
    if system.body.shape.axis is None:
        yield Suspect("puck", says, puck, law=laws.frictionless_law, excused=_SLIPS, textbook=True)
    omega = rate_of(system)
    if omega and system.body.shape.axis is None:  # on a support at rest only the factor of rolling is then missing
        law = laws.constrained(laws.frictionless_law)
        yield Suspect("puck", f"{says} Ω follows from no slip.", puck, law=law, textbook=True)
    if not omega or not system.body.is_isotropic_sphere or not laws.turns(system):
        return
    k = float(system.body.inertia_ratio)
    right, over = k / (1 + k), (1 + k) / k
    shares = [
        ("circle-upside-down", over, f"at {_fraction(over)} of the table's rate, {_fraction(right)} upside down"),
        ("coriolis-for-rolling", 2.0, "at 2ω, as a Coriolis force would have it"),
        ("coriolis-for-rolling", -2.0, "at −2ω, as a Coriolis force would have it"),
        ("circle-of-the-table", 1.0, "at the table's own rate"),
    ]
    if turning:  # without Ω they are those of another table
        shares += [("sign-of-table-rate", -right, "the wrong way"), ("table-motion-ignored", 0.0, "not at all")]
        shares += [("wrong-inertia-ratio", r / (1 + r), f"as k = {_fraction(r)} would have it") for r in RATIOS]
    for name, share, text in shares:
        if abs(share - right) > _SAME:
            yield Suspect(
                name,
                f"It goes round {text}: κ = {share * omega:.5g} rad/s, where ωk/(1 + k) = {omega * right:.5g}.",
                frozenset({"law", "circle"}),
                law=laws.circling(share),
                numbers={"circle": share * omega},
                textbook=name in ("circle-upside-down", "coriolis-for-rolling"),
            )


def _fraction(value: float) -> str:
    return str(Fraction(value).limit_denominator(99))
