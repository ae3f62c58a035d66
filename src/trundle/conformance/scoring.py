"""The score: engines on cases, in every profile and at every step; each outcome is a row."""

from __future__ import annotations

import math
import shlex
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from statistics import median
from typing import Any

from ..errors import InvalidValueError
from . import derivatives as slopes
from . import engines as shipped
from .animation import path_of
from .answers import CANNOT as CANNOT_OUTCOME
from .answers import NOT_FINITE, NOT_INSTALLED, OK, TOO_SLOW, Answer
from .case import Case, Input, Motion
from .engines import BEST, SHIPPED, CannotInstallError, Setting
from .measuring import Errors, cut_off, errors_of
from .results import Row, Score
from .running import LIMIT, Adapter

STEPS = (1e-2, 1e-3, 1e-4)  # s
Told = Callable[[str], object]


@dataclass(frozen=True)
class Entrant:
    """What is scored: an engine that ships, or a program of somebody's.

    Parameters
    ----------
    name : str
        For the table.
    settings : tuple of Setting
        How it is run.
    start : callable
        Returns its adapter, given the limit in s; raises CannotInstallError.
    """

    name: str
    settings: tuple[Setting, ...]
    start: Callable[[float], Adapter]

    @staticmethod
    def of_engine(name: str, *, ablations: bool = False) -> Entrant:
        """Return an engine that an adapter ships for."""
        found = shipped.engine(name)

        def start(limit: float) -> Adapter:
            found.install()
            return found.adapter(limit)

        # One that cannot run at all has one row a case, under the first profile.
        settings = found.settings if ablations else found.profiles
        return Entrant(found.title, settings or (Setting(SHIPPED),), start)

    @staticmethod
    def of_command(command: str) -> Entrant:
        """Return a program of somebody's: its settings are the two profiles, told by name."""
        try:
            words = shlex.split(command)
        except ValueError:  # a quotation mark without its other
            words = []
        if not words:
            raise InvalidValueError("--adapter", "must be a command", command, "Give a program and its arguments.")
        settings = tuple(Setting(name, {"profile": name}) for name in (SHIPPED, BEST))
        return Entrant(
            " ".join(word.rpartition("/")[2] for word in words), settings, lambda limit: Adapter(words, None, limit)
        )


def score(
    entrants: Iterable[Entrant],
    cases: Sequence[Case],
    steps: Sequence[float] = STEPS,
    *,
    derivatives: bool = False,
    repeat: int = 1,
    limit: float = LIMIT,
    tell: Told = lambda _: None,
) -> Score:
    """Run every entrant on every case, one process at a time, and measure each run.

    Parameters
    ----------
    entrants : iterable of Entrant
        What is scored.
    cases : sequence of Case
        On what.
    steps : sequence of float
        The engine's steps, s.
    derivatives : bool
        Whether to score the derivatives of the final state, too.
    repeat : int
        How often each run is made: the processor time is the median.
    limit : float
        s for one run.
    tell : callable
        Given a line for each setting of an entrant, as it begins.

    Returns
    -------
    Score
        A row for each run, whatever came of it.

    Examples
    --------
    >>> import trundle as tr
    >>> conformance = tr.conformance
    >>> found = conformance.score([conformance.Entrant.of_command("no-such-program")], conformance.cases()[:1], [1e-2])
    >>> [(row.outcome, row.message) for row in found.rows][:1]
    [('failed', 'no-such-program cannot be started: No such file or directory')]
    """
    return Score(tuple(runs(entrants, cases, steps, derivatives=derivatives, repeat=repeat, limit=limit, tell=tell)))


def runs(
    entrants: Iterable[Entrant],
    cases: Sequence[Case],
    steps: Sequence[float] = STEPS,
    *,
    derivatives: bool = False,
    repeat: int = 1,
    limit: float = LIMIT,
    tell: Told = lambda _: None,
) -> Iterator[Row]:
    """Yield the rows of `score` as they come, so that those that are there can be kept."""
    exact = {case.name: case.exact() for case in cases}
    inputs = {case.name: case.inputs() if derivatives else () for case in cases}
    for entrant in entrants:
        try:
            adapter = entrant.start(limit)
        except CannotInstallError as error:
            reason = Answer(NOT_INSTALLED, str(error))
            cells = [(setting, case, dt) for setting in entrant.settings for case in cases for dt in steps]
            yield from (_row(entrant, *cell, reason, None) for cell in cells if not cell[0].of)
            continue
        with adapter:
            for setting in entrant.settings:
                tell(f"{entrant.name}, {setting.name}")
                for case in cases:
                    yield from _runs(adapter, entrant, setting, case, steps, exact[case.name], repeat)
                    yield from _slopes(adapter, entrant, setting, case, steps, inputs[case.name])


def _runs(
    adapter: Adapter,
    entrant: Entrant,
    setting: Setting,
    case: Case,
    steps: Sequence[float],
    exact: Motion,
    repeat: int,
) -> Iterator[Row]:
    """Run one case at all steps, the coarsest first: where one cannot or is late, the finer ones are not tried."""
    answer: Answer | None = None
    for dt in sorted(steps, reverse=True):
        if answer is None or answer.outcome not in (CANNOT_OUTCOME, TOO_SLOW):
            answer = adapter.answer(case, dt, dict(setting.values))
            if answer.outcome == OK and repeat > 1:
                again = (adapter.answer(case, dt, dict(setting.values)).seconds for _ in range(repeat - 1))
                answer = replace(answer, seconds=median([answer.seconds, *again]))
        elif answer.outcome == TOO_SLOW:
            answer = Answer(TOO_SLOW, "not tried: a longer step is too slow already")
        yield _row(entrant, setting, case, dt, answer, exact)


def _slopes(
    adapter: Adapter,
    entrant: Entrant,
    setting: Setting,
    case: Case,
    steps: Sequence[float],
    inputs: Sequence[Input],
) -> Iterator[Row]:
    """Take the derivatives of one case at all steps, as `_runs` does: the engine's own, and differences of its runs."""
    told = adapter, case, inputs
    for take in (slopes.own, slopes.of_runs) if inputs else ():
        found: dict[str, slopes.Result] = {}
        for dt in sorted(steps, reverse=True):
            if not found or not {CANNOT_OUTCOME, TOO_SLOW}.issuperset(one.outcome for one in found.values()):
                found = take(*told, dt, setting.values)
            for way, one in found.items():
                said = Answer(one.outcome, one.message, None, one.seconds, one.engine)
                yield replace(_row(entrant, setting, case, dt, said, None), way=way, derivative=one.error)


def _row(entrant: Entrant, setting: Setting, case: Case, dt: float, answer: Answer, exact: Motion | None) -> Row:
    """Measure what came of a run."""
    told: dict[str, Any] = dict.fromkeys((each.name for each in fields(Errors)), math.nan)
    limit, path = None, ""
    if answer.outcome == NOT_FINITE:
        told |= {"position": math.inf, "turning": math.inf}
    if answer.outcome == OK and answer.motion is not None and exact is not None:
        told = vars(errors_of(case, exact, answer.motion))
        limit, path = cut_off(exact, answer.motion), path_of(answer.motion)
    return Row(
        engine=entrant.name,
        version=answer.engine,
        setting=setting.name,
        of=setting.of,
        case=case.name,
        step=dt,
        outcome=answer.outcome,
        message=answer.message,
        seconds=answer.seconds / case.duration,
        limit=math.nan if limit is None else limit,
        path=path,
        **told,
    )
