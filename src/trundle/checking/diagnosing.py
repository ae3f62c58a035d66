"""From a check that fails to the mistake behind it: each hypothesis is undone, and must leave nothing to explain."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from ..errors import TrundleError
from ..mechanics.system import RollingSystem, State
from .comparing import integrals, own_run
from .examining import Law, Series, examine, independent_law
from .motion import Motion
from .record import Theirs
from .result import Mistake

FIT_INSTANTS = 80
_GLANCE = 16  # instants
_MORE_ROOM = 10.0  # times: undoing a mistake may not buy its success with a wider bound


@dataclass(frozen=True)
class Case:
    """What failed.

    Parameters
    ----------
    system : RollingSystem
        What is said to move.
    theirs : Theirs
        Their samples, checked.
    tolerance : float
        As for `examine`.
    start : State or None
        Of the scenario.
    series : mapping from str to Series
        All that was found.
    motion : Motion
        Their motion.
    """

    system: RollingSystem
    theirs: Theirs
    tolerance: float
    start: State | None
    series: Mapping[str, Series]
    motion: Motion

    @property
    def failing(self) -> list[Series]:
        """The series beyond their bounds, the worst first."""
        return sorted((s for s in self.series.values() if s.worst > 1), key=lambda s: -s.worst)


@dataclass(frozen=True)
class Trial:
    """One mistake undone.

    Parameters
    ----------
    name, says : str
        As of a `Mistake`.
    theirs : Theirs, optional
        Their samples without it; absent: as they are.
    system : RollingSystem, optional
        The system that they had, by mistake.
    law : callable
        That they had, by mistake.
    excused : frozenset of str
        Checks that the mistake itself spoils.
    extra : tuple of Series
        Further checks that the mistake must pass.
    numbers : dict
        What was fitted.
    named : bool
        Whether it is a number with a reason.
    """

    name: str
    says: str
    theirs: Theirs | None = None
    system: RollingSystem | None = None
    law: Law = independent_law
    excused: frozenset[str] = frozenset()
    extra: tuple[Series, ...] = ()
    numbers: dict[str, float] = field(default_factory=dict)
    named: bool = True
    whole: bool = True


Hypothesis = Callable[[Case], Iterator[Trial]]


def diagnose(case: Case, hypotheses: tuple[Hypothesis, ...]) -> tuple[Mistake, ...]:
    """Return the mistakes that explain a failing check, those with a named number first.

    Parameters
    ----------
    case : Case
        What failed.
    hypotheses : tuple of callable
        Each yields trials, or none where it does not apply.

    Returns
    -------
    tuple of Mistake
        Empty where nothing explains it.
    """
    found: list[Mistake] = []
    for hypothesis in hypotheses:
        try:
            tried = [mistake for mistake in (judged(case, trial) for trial in hypothesis(case)) if mistake]
        except (TrundleError, ArithmeticError):  # their numbers, so changed, are no motion at all
            continue
        found += tried
    once = {mistake.says: mistake for mistake in found}
    return tuple(sorted(once.values(), key=lambda mistake: not mistake.named))


def judged(case: Case, trial: Trial) -> Mistake | None:
    """Return the mistake if undoing it leaves nothing beyond its bound.

    Parameters
    ----------
    case : Case
        What failed.
    trial : Trial
        The mistake undone.

    Returns
    -------
    Mistake or None
        None where it does not explain what was found.
    """
    theirs = case.theirs if trial.theirs is None else trial.theirs
    system = case.system if trial.system is None else trial.system
    if trial.theirs is not None:  # most are far off, and a few instants show it
        glance, _ = examine(system, theirs, case.tolerance, case.start, trial.law, _GLANCE)
        replaced = {extra.name for extra in trial.extra} | trial.excused
        if any(one.worst > 1 for name, one in glance.items() if name not in replaced):
            return None
    series, at = examine(system, theirs, case.tolerance, case.start, trial.law)
    series |= {extra.name: extra for extra in trial.extra}
    if not _holds(series, trial) or (trial.theirs is None and not _no_wider(case, series)):
        return None
    if trial.whole and trial.law is independent_law:  # what adds up over the run must come out right, too
        later = {one.name: one for one in integrals(system, at, case.tolerance)}
        ours, _ = own_run(system, theirs, at, case.tolerance)
        later |= {} if ours is None else {ours.name: ours}
        if not _holds(later, trial):
            return None
        series |= later
    told = [one for one in case.failing if one.name in series and one.name not in trial.excused]
    if not told and not trial.extra:
        return None
    worst = told[0] if told else case.failing[0]
    after = series[worst.name] if told else next(iter(trial.extra or series.values()))
    if after.allowed > _MORE_ROOM * max(worst.allowed, case.tolerance) and after.allowed > worst.share / _MORE_ROOM:
        return None
    return Mistake(
        trial.name, trial.says, worst.name, worst.share, after.share, after.allowed, trial.numbers, trial.named
    )


def _no_wider(case: Case, series: Mapping[str, Series]) -> bool:
    """Tell whether another system passes by what it explains, rather than by bounds that grow with its own speeds."""
    both = [(case.series[name], one) for name, one in series.items() if name in case.series]
    same = [(before, after) for before, after in both if before.time.size == after.time.size]
    return all((after.bound <= _MORE_ROOM * before.bound).all() for before, after in same)


def _holds(series: Mapping[str, Series], trial: Trial) -> bool:
    return all(one.worst <= 1 for name, one in series.items() if name not in trial.excused)
