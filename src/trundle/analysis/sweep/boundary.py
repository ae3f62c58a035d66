"""A map of classes from runs near their boundary: in rounds, each of which depends on what the last one found."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .job import Columns, Job, block_of
from .measures import INFERRED, WAITING
from .plan import Plan
from .refining import Mask, Places, first_step, next_places


@dataclass
class NearBoundary:
    """The members of a grid near the boundary between the classes of the first measure, as an engine takes its work.

    A round is divided into pieces of members that go together. Which these are depends on the rounds before it alone:
    so a sweep that goes on repeats the rounds with what is known, runs the pieces that are not, and comes to the same.
    """

    plan: Plan  # the whole grid
    status: Any  # (members,): what became of each member so far
    classes: Any  # (members,): the class of each that has been run
    _run: Mask = field(init=False)
    _pieces: list[Places] = field(default_factory=list)
    _waiting: list[int] = field(default_factory=list)
    _left: set[int] = field(default_factory=set)
    _round: tuple[int, int] = 0, 0  # how many there have been, and the members of the last

    def __post_init__(self) -> None:
        shape = self.plan.grid or (1, 1)
        self._known = ~np.isin(self.status, (WAITING, INFERRED))
        self._found = np.where(self._known, self.classes, 0).astype(np.int64).reshape(shape)
        self._run = np.zeros(shape, dtype=bool)
        self._whole = self._found

    @property
    def job(self) -> Job:
        """What is done with each member."""
        return self.plan.job

    def values(self, piece: int) -> Any:
        """Return the values of the members of a piece."""
        return self.plan.table[self._pieces[piece]]

    def __call__(self) -> int | None:
        """Return the next piece to run; None while a round is not over, and when the map is whole."""
        while not self._left:
            places, self._whole = next_places(self._run, self._found)
            if not places.size:
                return None
            self._run.ravel()[places] = True
            self._round = self._round[0] + 1, places.size
            first, together = len(self._pieces), block_of(places.size)
            self._pieces += [places[start : start + together] for start in range(0, places.size, together)]
            self._waiting = [n for n in range(first, len(self._pieces)) if not self._known[self._pieces[n]].all()]
            self._left = set(self._waiting)
        return self._waiting.pop(0) if self._waiting else None

    def take(self, piece: int, columns: Columns) -> Places:
        """Take in what came of a piece, and return which members it had."""
        places = self._pieces[piece]
        self._found.ravel()[places] = columns[self.plan.measures[0].name]
        self._left.discard(piece)
        return places

    @property
    def share(self) -> float:
        """About how much is done: as a rule a round has twice the members of the last."""
        count, size = self._round
        run, left = int(self._run.sum()), sum(self._pieces[n].size for n in self._left)
        rounds = first_step(self._run.shape).bit_length()
        return float((run - left) / (run + size * (2 ** (rounds - count + 1) - 2))) if count else 0.0

    @property
    def inferred(self) -> tuple[Places, Any]:
        """Which members need no run, and their classes."""
        places = np.flatnonzero(~self._run)
        return places, self._whole.ravel()[places]
