"""`check_equations`: somebody else's equations of motion against the law, at random states that roll."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ...errors import InvalidValueError, TrundleError
from ...mechanics.algebra import Matrix, Quaternion, Vector
from ...mechanics.contact import contact_at
from ...mechanics.system import RollingSystem
from ...verify import CardFigure
from .fitting import FAMILIES, fitted
from .laws import Law, Rates, eliminated_law
from .mistakes import Suspect, law_of, mechanical, with_mistakes
from .motion import Instants
from .record import Array, check_covered
from .result import Check, Mistake
from .searching import Tried, explaining
from .symbols import callable_of

EXACT = 1e-9  # of the largest acceleration: two ways to write one law differ by rounding
_FITS = 1e-8  # what a fit of numbers may leave
NAMES = ("acceleration", "angular acceleration")


@dataclass(frozen=True)
class States:
    """Random states that roll; arrays (n,), (n, 3) and (n, 4), inertial support frame, SI."""

    time: Array
    point: Array
    position: Array
    velocity: Array
    orientation: Array
    angular_velocity: Array

    def instants(self, system: RollingSystem) -> Instants:
        """Return them with their contact with a support."""
        contact = contact_at(system, self.time, Vector.of(self.point), Quaternion.of(self.orientation))
        return Instants(self.time, self.position, self.velocity, self.angular_velocity, self.orientation, contact)

    def one(self, i: int) -> tuple[float, Array, Array, Array, Array]:
        """Return t, r, V, q and Ω of one state, as equations take them."""
        return float(self.time[i]), self.position[i], self.velocity[i], self.orientation[i], self.angular_velocity[i]


def states(system: RollingSystem, count: int, seed: int = 0) -> States:
    """Draw random states that touch and roll.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.5, 1.0), tr.Support(tr.Plane(), motion=tr.Spin(2.0)))
    >>> drawn = states(system, 3)
    >>> slip = drawn.velocity - np.cross([0, 0, 2.0], drawn.point) - 0.5 * np.cross(drawn.angular_velocity, [0, 0, 1])
    >>> bool(np.abs(slip).max() < 1e-12)
    True
    """
    draw = np.random.default_rng(seed)
    q = draw.normal(size=(count, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    rim = system.support.surface.rim
    zero = Vector(0.0, 0.0, 0.0)
    somewhere = _on_surface(system, 0.0, Vector(1e-3, 2e-3, 3e-3))
    arm = float(contact_at(system, 0.0, somewhere, Quaternion(1.0, *zero)).offset.norm())
    reach = 10 * arm if rim is None else 0.9 * float(rim)
    quick = math.sqrt(max(float(system.gravity), 1.0) / arm) + abs(float(system.support.motion.steady_rate or 0.0))
    time, rough = draw.uniform(0.0, 10.0, count), draw.uniform(-reach / 2**0.5, reach / 2**0.5, (count, 3))
    Omega = draw.normal(size=(count, 3)) * quick / 2
    found = [_placed(system, *row) for row in zip(time, rough, q, Omega, strict=True)]
    point, position, velocity = (np.array([row[i] for row in found]) for i in range(3))
    return States(time, point, position, velocity, q, Omega)


def _placed(system: RollingSystem, time: float, rough: Array, q: Array, Omega: Array) -> tuple[list[float], ...]:
    point = _on_surface(system, time, Vector(*map(float, rough)))
    contact = contact_at(system, time, point, Quaternion(*map(float, q)))
    velocity = contact.rolling_velocity(Vector(*map(float, Omega)))
    return [*point], [*contact.centre], [*velocity]


def _on_surface(system: RollingSystem, time: float, rough: Vector) -> Vector:
    """Go down to the surface along its normals, from a point near it."""
    surface, now = system.support.surface, system.support.motion.at(time)
    own = now.local(rough)
    for _ in range(60):
        n, level = surface.normal(own), float(surface.level(own))
        step = 1e-6 * max(abs(level), 1e-3)
        slope = (float(surface.level(own + n * step)) - float(surface.level(own - n * step))) / (2 * step)
        own = own - n * (level / slope)
        if abs(level) < 1e-15 * max(float(own.norm()), 1e-3):
            break
    return now.origin + now.rotation @ own


def check_equations(
    equations: Any,
    system: RollingSystem,
    *,
    values: Mapping[Any, float] | None = None,
    samples: int = 200,
    seed: int = 0,
    tolerance: float = EXACT,
) -> Check:
    """Compare somebody else's equations of motion with the law, at random states that roll.

    Parameters
    ----------
    equations : callable, or sequence or mapping of SymPy expressions
        A callable takes t, r, V, q, Ω (float and arrays, inertial support frame, SI) and returns V̇, or V̇ and Ω̇;
        of V̇ two components will do. Expressions are those of V̇, or of V̇ and Ω̇, in the symbols t, x, y, z, vx, vy,
        vz, qw, qx, qy, qz, wx, wy, wz.
    system : RollingSystem
        What is said to move.
    values : mapping, optional
        Values of further symbols, such as ``{"k": 0.4}``.
    samples : int
        How many states.
    seed : int
        Of their draw.
    tolerance : float
        Largest difference, as a share of the largest acceleration.

    Returns
    -------
    Check
        Its `worst_state` is the one furthest off; `likely` names wrong laws that the equations agree with.

    Raises
    ------
    InvalidValueError
        If the equations return something else.
    UnknownNameError
        If an expression has a symbol without a value.

    Examples
    --------
    A ball on a turning table goes round at 2/7 of the table's rate, not at the table's own:

    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.025, mass=0.065), table)
    >>> tr.check_equations(lambda t, r, V, q, Omega: (-3.5 * V[1], 3.5 * V[0]), system).passed
    False
    >>> tr.check_equations(lambda t, r, V, q, Omega: (-2 / 7 * 3.5 * V[1], 2 / 7 * 3.5 * V[0]), system).passed
    True
    """
    if not isinstance(system, RollingSystem):
        raise InvalidValueError("system", "must be a RollingSystem", system)
    check_covered(system)
    at = _states(system, _count(samples), seed)
    case = _Case(system, at, _evaluated(callable_of(equations, values or {}), at), tolerance)
    shares, worst = case.off(case.true)
    figures = [
        CardFigure(f"{name} against the law", share, "", tolerance, bool(share <= tolerance), f"at {samples} states")
        for name, share in zip(NAMES, shares, strict=False)
    ]
    failed = max(shares) > tolerance
    likely, nearest = _diagnosed(case, max(shares)) if failed else ((), ())
    state = dict(zip(("t", "r", "V", "q", "Ω"), map(_shown, at.one(worst)), strict=True))
    for i, name in enumerate(("V̇", "Ω̇")[: len(case.theirs)]):
        width = case.theirs[i].shape[1]
        state |= {f"their {name}": _shown(case.theirs[i][worst]), f"our {name}": _shown(case.true[i][worst][:width])}
    remark = "" if likely or not failed else "No wrong law that was tried here agrees with these equations."
    return Check(
        "Their equations against the law of rolling",
        f"{samples} random states that roll; ours: T1-T3, every state and rate in the inertial support frame",
        tuple(figures),
        likely=likely,
        nearest=nearest,
        remark=f"{remark} Nearest:" if nearest else remark,
        worst_state=state if failed else None,
    )


def _states(system: RollingSystem, count: int, seed: int) -> States:
    try:
        return states(system, count, seed)
    except (ArithmeticError, ValueError) as error:  # a formula that is not defined all around the axis
        surface = system.support.surface.word
        remedy = f"On the way to some random states: {error}. Check a trajectory instead."
        raise InvalidValueError("system", "must have a surface that goes on smoothly", surface, remedy) from None


def _count(samples: Any) -> int:
    if not isinstance(samples, int) or isinstance(samples, bool) or not 8 <= samples <= 1_000_000:
        raise InvalidValueError("samples", "must be a whole number from 8 to a million", samples)
    return samples


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    return "(" + ", ".join(f"{float(part):.6g}" for part in value) + ")"


def _evaluated(equations: Callable[..., Any], at: States) -> list[Array]:
    """Ask their equations at every state; return V̇ (n, 2 or 3), and Ω̇ (n, 3) if they give it."""
    rows = [_one(equations(*at.one(i))) for i in range(at.time.size)]
    if len({tuple(len(part) for part in row) for row in rows}) != 1:
        rule = "must return the same number of components at every state"
        raise InvalidValueError("equations", rule, "different ones")
    found = [np.array([row[i] for row in rows]) for i in range(len(rows[0]))]
    if not all(np.isfinite(part).all() for part in found):
        rule = "must return finite numbers at every state that rolls"
        raise InvalidValueError("equations", rule, "NaN or infinity")
    return found


def _one(returned: Any) -> list[list[float]]:
    rule = "must return V̇ (2 or 3 components), or V̇ and Ω̇ (3 and 3, or 6 in a row)"
    try:
        parts = [np.asarray(part, dtype=float).ravel() for part in returned]
    except (TypeError, ValueError):
        raise InvalidValueError("equations", rule, returned) from None
    if all(part.size == 1 for part in parts):  # one flat row
        flat = np.concatenate(parts) if parts else np.empty(0)
        parts = [flat[:3], flat[3:]] if flat.size == 6 else [flat]
    sizes = tuple(part.size for part in parts)
    if sizes not in ((2,), (3,), (2, 3), (3, 3)):
        raise InvalidValueError("equations", rule, f"sizes {sizes}")
    return [part.tolist() for part in parts]


@dataclass(frozen=True)
class _Case:
    """Their accelerations and ours at the same states."""

    system: RollingSystem
    at: States
    theirs: list[Array]
    tolerance: float

    def off(self, ours: Rates) -> tuple[list[float], int]:
        """Return the largest difference of each part as a share of the largest acceleration, and where it is worst."""
        lengths = [np.linalg.norm(part, axis=1) for part in self.shares(ours)]
        worst = int(np.argmax(np.max(lengths, axis=0)))
        return [float(length.max()) for length in lengths], worst

    def shares(self, ours: Rates) -> list[Array]:
        """Return the differences over the largest acceleration of the right law, or of theirs."""
        found = []
        for part, right, true in zip(self.theirs, ours, self.true, strict=False):
            width = part.shape[1]
            size = max(float(np.linalg.norm(true[:, :width], axis=1).max()), float(np.linalg.norm(part, axis=1).max()))
            found.append((part - right[:, :width]) / max(size, 1e-300))
        return found

    @cached_property
    def true(self) -> Rates:
        """The right V̇ and Ω̇."""
        return eliminated_law(self.system, self.states)

    @cached_property
    def states(self) -> Instants:
        """The states, with their contact."""
        return self.at.instants(self.system)

    def rates(self, suspects: Sequence[Suspect]) -> Rates:
        """Return V̇ and Ω̇ with some mistakes in them."""
        return law_of(suspects, eliminated_law)(with_mistakes(self.system, suspects), self.states_of(suspects))

    def states_of(self, suspects: Sequence[Suspect]) -> Instants:
        """Return the states on the support that somebody had who made mistakes."""
        same = all(suspect.system is None for suspect in suspects)
        return self.states if same else self.at.instants(with_mistakes(self.system, suspects))

    def tried(self, suspects: tuple[Suspect, ...]) -> Tried | None:
        """Try mistakes at all states."""
        try:
            with np.errstate(all="ignore"):
                each = self.shares(self.rates(suspects))
        except (TrundleError, ArithmeticError, ValueError):
            return None
        left = max(float(np.linalg.norm(part, axis=1).max()) for part in each)
        fits = any(not suspect.named for suspect in suspects)
        before = max(self.off(self.true)[0])
        return Tried(suspects, left / before, left <= max(self.tolerance, _FITS if fits else 0.0), left)

    def residual(self, suspect: Suspect) -> Array:
        """Return what a fit makes small."""
        return np.concatenate([part.ravel() for part in self.shares(self.rates((suspect,)))]) / self.tolerance


def _diagnosed(case: _Case, before: float) -> tuple[tuple[Mistake, ...], tuple[Mistake, ...]]:
    """Return the wrong laws that the equations agree with, and where there is none, those that they nearly do."""
    with np.errstate(all="ignore"):
        suspects = [*_axes(), *mechanical(case.system)]
        suspects += [suspect for family in FAMILIES for suspect in fitted(family, case.system, case.residual)]
        explain, nearest = explaining(suspects, case.tried, case.tried)

    def mistake(tried: Tried) -> Mistake:
        numbers = {name: number for suspect in tried.suspects for name, number in suspect.numbers.items()}
        return Mistake(
            " + ".join(suspect.name for suspect in tried.suspects),
            " ".join(suspect.says for suspect in tried.suspects),
            f"{NAMES[0]} against the law",
            before,
            tried.found,
            case.tolerance,
            numbers,
            tried.named,
            max(0.0, 1 - tried.left),
        )

    return tuple(map(mistake, explain)), tuple(map(mistake, nearest))


def _axes() -> Iterator[Suspect]:
    """Yield what else their Ω, or their Ω̇, may mean."""
    name, axes = "body-axes-for-space-axes", frozenset({"axes"})
    text = "Ω is taken for one along the axes of the body; it comes along space axes."
    yield Suspect(name, "Ω̇ has its components along the axes of the body.", axes, law=_answered)
    yield Suspect(name, text, axes, law=_turned_in)
    yield Suspect(name, text, axes, law=lambda system, at: _answered(system, at, _turned_in))
    yield Suspect("degrees-for-radians", "Ω is taken for deg/s.", axes, law=_in_degrees)


def _answered(system: RollingSystem, at: Instants, law: Law = eliminated_law) -> Rates:
    V_rate, Omega_rate = law(system, at)
    return V_rate, _turned(Quaternion.of(at.orientation).matrix().transpose, Omega_rate)


def _turned_in(system: RollingSystem, at: Instants) -> Rates:
    Omega = _turned(Quaternion.of(at.orientation).matrix(), at.angular_velocity)
    return eliminated_law(system, replace(at, angular_velocity=Omega))


def _in_degrees(system: RollingSystem, at: Instants) -> Rates:
    return eliminated_law(system, replace(at, angular_velocity=np.degrees(at.angular_velocity)))


def _turned(Q: Matrix, vectors: Array) -> Array:
    return np.asarray((Q @ Vector.of(vectors)).array(), dtype=float)
