"""Whether data can decide at all: which mistakes of the textbook they would have shown, had they been made."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...errors import TrundleError
from .case import Case
from .examining import examine, sensitivity
from .laws import independent_law
from .misread import misreadings
from .mistakes import Suspect, law_of, mechanical, with_mistakes
from .series import Series

_WINDOWS = 16


@dataclass(frozen=True)
class Power:
    """What data could show."""

    # Of each mistake what it says. Those that make no difference to such a motion are in neither.
    shown: dict[str, str]  # those that the data exclude
    blind: dict[str, str]  # those that they agree with as well as with the truth

    @property
    def decides(self) -> bool:
        """Whether at least half of the mistakes that matter would have been seen."""
        return len(self.shown) >= len(self.blind)


def power_of(case: Case) -> Power:
    """Suppose each mistake of the textbook in turn, and see whether the data would condemn it."""
    view, shown, blind = case.view.thinned(_WINDOWS), dict[str, str](), dict[str, str]()
    reacts = sensitivity(case.system, case.theirs, case.start, independent_law)
    right, _ = examine(case.system, case.theirs, case.tolerance, case.start, view, independent_law, reacts)
    suspects = [*mechanical(case.system, turning=case.motion.turning_known), *misreadings(case)]
    for suspect in (one for one in suspects if one.textbook):
        try:
            theirs = case.theirs if suspect.theirs is None else suspect.theirs(case.theirs)
            system = with_mistakes(case.system, (suspect,))
            with np.errstate(all="ignore"):
                wrong, _ = examine(system, theirs, case.tolerance, case.start, view, law_of((suspect,)), reacts)
        except (TrundleError, ArithmeticError, ValueError):
            continue
        kept = {name: one for name, one in wrong.items() if name not in suspect.excused and name in right}
        if not any(_differ(right[name], one) for name, one in kept.items()):
            continue
        told = shown if any(one.worst > 1 for one in kept.values()) else blind
        told.setdefault(suspect.name, suspect.says)
    return Power({name: says for name, says in shown.items() if name not in blind}, blind)


def _differ(one: Series, other: Series) -> bool:
    """Tell whether two residuals differ by more than samples without noise would be allowed."""
    if one.residual.shape != other.residual.shape:
        return True
    return float(np.linalg.norm(one.residual - other.residual, axis=1).max()) > max(one.asked, other.asked)


__all__ = ["Power", "Suspect", "power_of"]
