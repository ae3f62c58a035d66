"""From a check that fails to the mistakes behind it: they are undone, and must leave nothing to explain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ...errors import TrundleError
from .case import Case
from .comparisons import ACCELERATION, TURNING, Sensitivity
from .examining import SLIP, examine, sensitivity
from .fitting import FAMILIES, fitted
from .integrals import integrals
from .laws import independent_law
from .misread import misreadings
from .mistakes import Suspect, law_of, mechanical, with_mistakes
from .own_run import own_run
from .record import Array, ExternalTrajectory
from .result import Mistake
from .searching import Tried, explaining
from .series import Series
from .slipping import crude
from .spinning import another_spin

_GLANCE = 10  # windows on which mistakes are tried
_SAME = 1e-9  # of a size: a mistake that changes no more changes nothing
_NEARLY = 0.5  # of what is off, left over: worth a closer look
_MORE_ROOM = 10.0  # times: undoing a mistake may not buy its success with a wider bound
_FITTED = (SLIP, ACCELERATION, TURNING)


def diagnose(case: Case) -> tuple[tuple[Mistake, ...], tuple[Mistake, ...]]:
    """Return the mistakes that explain a failing check, and where none does, those that explain most of it."""
    with np.errstate(all="ignore"):  # numbers so changed may be no motion at all
        trials = _Trials(case)
        suspects = [
            *misreadings(case),
            *mechanical(case.system, turning=case.motion.turning_known),
            *another_spin(case),
            *crude(case),
        ]
        families = FAMILIES if case.motion.turning_known else FAMILIES[:-1]  # without Ω it is that of another table
        suspects += [suspect for family in families for suspect in fitted(family, case.system, trials.residual)]
        explain, nearest = explaining(suspects, trials.tried, trials.confirmed)
    return tuple(map(trials.mistake, explain)), tuple(map(trials.mistake, nearest))


@dataclass
class _Trials:
    """Mistakes undone, one after the other or several together, in what one case looks at."""

    case: Case
    base: Mapping[str, Series] = field(init=False)
    reacts: Sensitivity = field(init=False)
    changed: dict[tuple[int, ...], ExternalTrajectory | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        case = self.case
        self.view = case.view.thinned(_GLANCE)
        self.reacts = sensitivity(case.system, case.theirs, case.start, independent_law)
        self.base, _ = examine(
            case.system, case.theirs, case.tolerance, case.start, self.view, independent_law, self.reacts
        )
        self.off = _off(self.base, ())

    def theirs(self, suspects: tuple[Suspect, ...]) -> ExternalTrajectory | None:
        """Return their samples without some misreadings; it is worked out once."""
        found: ExternalTrajectory | None = self.case.theirs
        key: tuple[int, ...] = ()
        for suspect in suspects:
            if suspect.theirs is None or found is None:
                continue
            key = (*key, id(suspect))
            if key not in self.changed:
                try:
                    self.changed[key] = suspect.theirs(found)
                except (TrundleError, ArithmeticError, ValueError):
                    self.changed[key] = None
            found = self.changed[key]
        return found

    def series(
        self, suspects: tuple[Suspect, ...], *, whole: bool, reacts: Sensitivity | None = None
    ) -> dict[str, Series] | None:
        """Return what is left with mistakes undone, quickly or with all there is; None where that is no motion."""
        case, theirs = self.case, self.theirs(suspects)
        if theirs is None:
            return None
        law, view = law_of(suspects), case.view if whole else self.view
        try:
            system = with_mistakes(case.system, suspects)
            found, _ = examine(system, theirs, case.tolerance, case.start, view, law, reacts)
            found |= {one.name: one for suspect in suspects if suspect.further for one in suspect.further(system)}
            if whole and law is independent_law and all(suspect.whole for suspect in suspects):
                found |= {one.name: one for one in integrals(system, theirs, case.tolerance, case.start)}
                ours, _ = own_run(system, theirs, case.tolerance, case.start)
                found |= {} if ours is None else {ours.name: ours}
        except (TrundleError, ArithmeticError, ValueError):
            return None
        return found if all(np.isfinite(one.length).all() for one in found.values()) else None

    def tried(self, suspects: tuple[Suspect, ...]) -> Tried | None:
        """Try mistakes in a few windows."""
        found = self.series(suspects, whole=False, reacts=self.reacts)
        if found is None or not self._may(suspects) or not _no_wider(self.base, found):
            return None
        left = _off(found, suspects) / max(self.off, 1e-300)
        explains = self._explains(found, suspects, self.base)
        if not explains and left < _NEARLY:  # another law may make more of the noise in their states
            found = self.series(suspects, whole=False)
            explains = found is not None and self._explains(found, suspects, self.base)
        excused = {name for suspect in suspects for name in suspect.excused}
        kept = {name: one for name, one in (found or {}).items() if name in self.base and name not in excused}
        mended = sum(self.base[name].worst > 1 >= one.worst for name, one in kept.items())
        tells = any(_differ(one, self.base[name]) for name, one in kept.items())
        return Tried(suspects, left, explains, mended=mended, tells=tells)

    def confirmed(self, suspects: tuple[Suspect, ...]) -> Tried | None:
        """Try mistakes in all windows, with all that adds up over the run."""
        found = self.series(suspects, whole=True)
        if found is None:
            return None
        left = _off(found, suspects) / max(_off(self.case.series, suspects), 1e-300)
        return Tried(suspects, left, self._explains(found, suspects, self.case.series), found)

    def residual(self, suspect: Suspect) -> Array:
        """Return what a fit makes small: what is left of the law, over the bounds of what is off as it is."""
        found = self.series((suspect,), whole=False, reacts=self.reacts)
        names = [name for name in _FITTED if name in self.base]
        if found is None:
            raise TrundleError("No motion.")
        return np.concatenate([(found[name].residual / self.base[name].bound[:, None]).ravel() for name in names])

    def _may(self, suspects: tuple[Suspect, ...]) -> bool:
        """Tell whether what a mistake spoils later holds at the first instant, if it says so."""
        begins = {name for suspect in suspects for name in suspect.begins if name in self.base}
        return all(self.base[name].ratio[0] <= 1 for name in begins)

    def _explains(
        self, found: Mapping[str, Series], suspects: tuple[Suspect, ...], before: Mapping[str, Series]
    ) -> bool:
        excused = {name for suspect in suspects for name in suspect.excused}
        kept = {name: one for name, one in found.items() if name not in excused}
        return all(one.worst <= 1 for one in kept.values()) and _no_wider(before, kept)

    def mistake(self, tried: Tried) -> Mistake:
        """Return what was tried as what is told."""
        excused = {name for suspect in tried.suspects for name in suspect.excused}
        found = tried.found if tried.found is not None else self.series(tried.suspects, whole=False) or {}
        told = [one for one in self.case.failing if one.name in found and one.name not in excused]
        worst = told[0] if told else self.case.failing[0]
        after = found.get(worst.name) or max(found.values(), key=lambda one: one.worst, default=worst)
        numbers: dict[str, float] = {}
        for suspect in tried.suspects:
            numbers |= suspect.numbers
        return Mistake(
            " + ".join(suspect.name for suspect in tried.suspects),
            " ".join(suspect.says for suspect in tried.suspects),
            worst.name,
            worst.share,
            after.share,
            after.allowed,
            numbers,
            tried.named,
            max(0.0, 1 - tried.left),
        )


def _off(series: Mapping[str, Series], suspects: tuple[Suspect, ...]) -> float:
    """Return how far off a motion is altogether: each series as a share of its size, which counts for one at most."""
    excused = {name for suspect in suspects for name in suspect.excused}
    shares = [one.typical for name, one in series.items() if name not in excused]
    return float(np.sqrt(sum((share / (1 + share)) ** 2 for share in shares)))


def _differ(one: Series, other: Series) -> bool:
    """Tell whether two residuals are not the same to rounding."""
    if one.residual.shape != other.residual.shape:
        return True
    return not np.allclose(one.residual, other.residual, rtol=0.0, atol=_SAME * other.size)


def _no_wider(before: Mapping[str, Series], after: Mapping[str, Series]) -> bool:
    """Tell whether a motion passes by what mistakes explain, rather than by bounds that have become wider."""
    both = [(before[name], one) for name, one in after.items() if name in before]
    return all(
        other.room <= max(_MORE_ROOM * one.room, one.typical / _MORE_ROOM)  # in another unit, the size is another
        or other.room * other.size <= _MORE_ROOM * one.room * one.size
        for one, other in both
    )
