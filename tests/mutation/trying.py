"""Try a mutant on its run: which figures of the card fail, or what the run says instead of a result."""

from __future__ import annotations

import signal
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from trundle.errors import SolverError

from .planting import Mutant, planted
from .runs import RUNS

PATIENCE = 60  # s


def tried(mutant: Mutant) -> tuple[list[str], str]:
    """Return the names of the figures that fail, and what the run said if it came to no result."""
    with planted(mutant), _no_longer_than(PATIENCE), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        try:
            card = RUNS[mutant.shows]().card()
        except SolverError as error:
            return [], str(error)
    return [figure.name for figure in card.failures], ""


def told(mutant: Mutant) -> str:
    """Return "caught", "refused" or "passes"."""
    failed, refused = tried(mutant)
    return "caught" if failed else "refused" if refused else "passes"


@contextmanager
def _no_longer_than(seconds: int) -> Iterator[None]:
    """Break off what a fault keeps from ending."""

    def stop(_: int, __: FrameType | None) -> None:
        raise TimeoutError(f"no answer in {seconds} s")

    before = signal.signal(signal.SIGALRM, stop)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
