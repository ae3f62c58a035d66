"""What else the law may have: the same data fitted with one thing added, compared by Akaike's criterion."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Displayed, Headline, Markup, paragraph, table
from ...errors import TrundleError
from ...scenario import ScenarioFile
from ...solve.samples import Array
from .judging import ENOUGH, chi_square
from .minimising import minimise
from .problem import Problem
from .undetermined import pm
from .unknowns import Unknown, of_run

if TYPE_CHECKING:
    from .result import Fit

_PLAIN = 10.0  # by which Akaike's criterion must fall for another law to be plainly better (Burnham and Anderson 2002)
_TRIALS = 12  # of the model, for each law
_WOBBLE = ("support.motion.angle", "support.motion.phase")
_SLIGHT = 1e-5  # rad, of a table that hardly wobbles
_ALIKE = 1e-9  # of singular values, below which numbers are not told apart
_LEAST = 1e-6  # where an added number begins, which may have no slope at 0
HEADINGS = ("what is added", "χ²", "numbers", "AIC, against the fit", "value")

Tables = dict[str, Any]


@dataclass(frozen=True)
class _Idea:
    """Something that may be missing: how the tables of a scenario change, and which of their numbers is then free."""

    words: str
    change: Callable[[Tables], tuple[str, ...] | None]
    guess: Callable[[Problem, Any], Array] = lambda problem, held: problem.start  # noqa: ARG005


def _load(**keys: Any) -> Callable[[Tables], tuple[str, ...] | None]:
    """Return what adds a load; nothing where one of its kind is there."""

    def change(tables: Tables) -> tuple[str, ...] | None:
        loads = list(tables.get("loads", ()))
        alike = [
            one for one in loads if one["kind"] == keys["kind"] and one.get("air", "still") == keys.get("air", "still")
        ]
        if alike:
            return None
        tables["loads"] = [*loads, keys]
        free = next(name for name in keys if name not in ("kind", "air"))
        size = 2 if isinstance(keys[free], list) else 0
        name = f"loads[{len(loads)}].{free}"
        return tuple(f"{name}[{i}]" for i in range(size)) or (name,)

    return change


def _turning(change: Callable[[Tables], tuple[str, ...] | None]) -> Callable[[Tables], tuple[str, ...] | None]:
    """Return the same for a support that turns."""
    return lambda tables: change(tables) if _motion(tables).get("kind", "fixed") != "fixed" else None


def _motion(tables: Tables) -> Tables:
    return dict(tables["support"].get("motion", {}))


def _wobble(tables: Tables) -> tuple[str, ...] | None:
    motion = _motion(tables)
    if motion.get("kind") != "spin":
        return None
    tables["support"] = {**tables["support"], "motion": {**motion, "kind": "wobble", "angle": _SLIGHT}}
    return _WOBBLE


def _first_wobble(problem: Problem, held: Any) -> Array:
    """Return angle and phase of a wobble, and what else is free, by one step from a table that hardly wobbles.

    Of a small wobble the effect is that of one at the phase 0 times ε cos φ and of one at π/2 times ε sin φ.
    """
    values, keys = problem.start, [one.key for one in problem.unknowns]
    angle, phase = (keys.index(key) for key in _WOBBLE)
    others = np.flatnonzero(~held & ~np.isin(np.arange(len(keys)), (angle, phase)))
    columns = []
    for values[phase] in (0.5 * np.pi, 0.0):
        residual, jacobian = problem.both(values)
        columns.append(jacobian[:, angle])
    system = np.column_stack([*columns, jacobian[:, others]])
    sizes = np.linalg.norm(system, axis=0)
    sizes[sizes == 0] = 1.0
    step = np.linalg.lstsq(system / sizes, -residual, rcond=_ALIKE)[0] / sizes
    across, along = step[:2]
    values[others] += step[2:]
    values[angle], values[phase] = np.hypot(along + _SLIGHT, across), np.arctan2(across, along + _SLIGHT)
    return values


def _sliding(tables: Tables) -> tuple[str, ...] | None:
    tables["support"] = {**tables["support"], "friction": 0.0}
    return ()


IDEAS = (
    _Idea("drag of air at rest", _load(kind="drag", coefficient=0.0, air="still")),
    _Idea("drag of air that turns with the support", _turning(_load(kind="drag", coefficient=0.0, air="turning"))),
    _Idea("resistance to rolling", _load(kind="rolling-resistance", offset=_LEAST)),
    _Idea("a lean of the support, as a push along it", _load(kind="force", value=[0.0, 0.0, 0.0])),
    _Idea("a wobble of the support", _wobble, _first_wobble),
    _Idea("sliding without friction, in place of rolling", _sliding),
)


@dataclass(frozen=True)
class Alternative:
    """One law beside that of the fit.

    Parameters
    ----------
    words : str
        What is added.
    chi_square : float
        Of its own fit.
    numbers : int
        Fitted.
    freedom : int
        How many more values were measured.
    gain : float
        By which Akaike's criterion is less than that of the fit: more than 10 is plainly better.
    values : tuple of (str, float, float)
        Key, value and standard deviation of what is added, SI.
    """

    words: str
    chi_square: float
    numbers: int
    freedom: int
    gain: float
    values: tuple[tuple[str, float, float], ...]

    @property
    def cells(self) -> tuple[str, ...]:
        """A row of the table."""
        told = ", ".join(f"{key} = {pm(value, sigma)}" for key, value, sigma in self.values)
        return self.words, f"{self.chi_square:.5g}", str(self.numbers), f"{round(-self.gain, 6) + 0.0:+.4g}", told


@dataclass(frozen=True, repr=False)
class Alternatives(Displayed):
    """Other laws for the same data, the best first.

    Parameters
    ----------
    title : str
        Of the scenario.
    each : tuple of Alternative
        In the order of Akaike's criterion.
    noise_known : bool
        Whether χ² says how well each explains the data.

    Examples
    --------
    See `Fit.compare`.
    """

    title: str
    each: tuple[Alternative, ...]
    noise_known: bool = True

    @property
    def best(self) -> Alternative | None:
        """The best one, if it is plainly better than the fit."""
        return self.each[0] if self.each and self.each[0].gain > _PLAIN else None

    @property
    def rivals(self) -> tuple[Alternative, ...]:
        """Those plainly better than the fit that these data do not plainly tell from the best, itself the first."""
        if self.best is None:
            return ()
        return tuple(one for one in self.each if one.gain > max(_PLAIN, self.best.gain - _PLAIN))

    @property
    def verdict(self) -> str:
        """What may be missing."""
        if self.best is None:
            return "nothing that was tried explains the data plainly better"
        *others, last = (one.words.partition(",")[0] for one in self.rivals)
        either = f"{', '.join(others)} or {last}" if others else last
        said = f"{either} explains the data plainly better (AIC {-self.best.gain:+.4g})"
        if others:
            said += "; these data do not tell which"
        reduced = self.best.chi_square / max(self.best.freedom, 1)
        if self.noise_known and reduced > 1 + ENOUGH * np.sqrt(2 / max(self.best.freedom, 1)):
            said += f", but not well: χ²/dof is still {reduced:.4g}"
        return said

    def __str__(self) -> str:
        rows = [HEADINGS, *(one.cells for one in self.each)]
        widths = [max(len(row[i]) for row in rows) for i in range(len(HEADINGS))]
        lines = ["  ".join(f"{c:<{w}}" for c, w in zip(row, widths, strict=True)).rstrip() for row in rows]
        return "\n".join([f"{self.verdict[:1].upper()}{self.verdict[1:]}.", *lines])

    def _headline(self) -> Headline:
        return Headline(self.title, self.verdict)

    def _parts(self) -> Iterator[Markup]:
        yield table([one.cells for one in self.each], HEADINGS)
        yield paragraph("AIC is χ² and twice the count of numbers: less is better, by 10 plainly.")


def compare(fit: Fit) -> Alternatives:
    """Return the fits with something added, the best first."""
    found = [one for one in (tried(fit, idea) for idea in IDEAS) if one is not None]
    each = tuple(sorted(found, key=lambda one: -one.gain))
    return Alternatives(fit.title, each, fit.judgement.noise_known)


def tried(fit: Fit, idea: _Idea) -> Alternative | None:
    """Return one alternative; None where it is in the scenario already, or cannot be followed."""
    problem = fit.problem
    scenarios = []
    added: tuple[str, ...] | None = ()
    for model in problem.models:
        tables = model.scenario.model_dump(exclude_unset=True, by_alias=True)
        added = idea.change(tables)
        if added is None:
            return None
        try:
            scenarios.append(type(model.scenario).read(tables, "alternative"))
        except TrundleError:
            return None
    fresh = [Unknown(key, None, _number(scenarios[0], key), _unit(scenarios[0], key), True) for key in added or ()]
    unknowns = [*(replace(one, value=float(v)) for one, v in zip(problem.unknowns, fit.values, strict=True)), *fresh]
    models = [
        replace(model, scenario=scenario, unknowns=tuple(unknowns[j] for j in of_run(unknowns, i)))
        for i, (model, scenario) in enumerate(zip(problem.models, scenarios, strict=True))
    ]
    other = Problem(unknowns, models, problem.noises, dict(problem.priors))
    held = np.array([one.state in ("held", "limit") for one in fit.estimates] + [False] * len(fresh))
    try:
        minimum = minimise(other, idea.guess(other, held), held, staged=False, most=_TRIALS)
        chi = chi_square(other, other.residual(minimum.values))
        if not np.array_equal(other.inside(minimum.values), minimum.values):  # of nothing the data would like less
            chi = fit.judgement.chi_square
    except (TrundleError, ArithmeticError, ValueError):
        return None
    return _compared(fit, idea, other, minimum.values, minimum.covariance, chi, minimum.directions.basis.shape[1])


def _compared(
    fit: Fit, idea: _Idea, other: Problem, values: Array, covariance: Array, chi: float, numbers: int
) -> Alternative:
    size, before = other.size, fit.judgement.chi_square
    first = size - fit.judgement.freedom
    known = fit.judgement.noise_known
    gain = before - chi if known else size * float(np.log(max(before, 1e-300) / max(chi, 1e-300)))
    gain += 2.0 * (first - numbers)
    count = len(fit.problem.unknowns)
    factor = 1.0 if known else chi / max(size - numbers, 1)
    told = tuple(
        (one.key, float(other.inside(values)[j]), float(np.sqrt(covariance[j, j] * factor)))
        for j, one in enumerate(other.unknowns)
        if j >= count
    )
    return Alternative(idea.words, chi, numbers, size - numbers, gain, told)


def _number(scenario: ScenarioFile, key: str) -> float:
    from ..sensitivities import keys

    return float(keys.chosen(scenario, [key])[0].value)


def _unit(scenario: ScenarioFile, key: str) -> str:
    from ..sensitivities import keys

    return keys.chosen(scenario, [key])[0].unit
