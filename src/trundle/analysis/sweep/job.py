"""The work of a sweep, in blocks of members: what a worker process is given, and what it gives back."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError
from ...mechanics.parameters import structure_of
from ...mechanics.system import RollingSystem, State
from ...simulation import labels
from ...simulation.simulate import Scenario
from ...solve.sampling import sample_times
from ..many.placing import PARTS, place_many
from ..many.running import run_members
from ..sensitivities.keys import moved
from .measures import DONE, FAILED, REFUSED, Measure, Sampled
from .varying import Axis, Varied, numbers_of

Array = NDArray[np.float64]
Columns = dict[str, Any]  # one array for each variable, a row for each member


_LARGEST = 256  # members of a block


def block_of(members: int) -> int:
    """Return how many members go together in a sweep of so many.

    Their blocks begin at whole multiples of this, so that a member's company depends on nothing but its number: results
    are the same to the last bit for any number of workers and any size of a chunk.

    Examples
    --------
    >>> block_of(100), block_of(100_000)
    (8, 256)
    """
    return next(block for least, block in ((4096, _LARGEST), (512, 32), (0, 8)) if members >= least)


@dataclass(frozen=True)
class Job:
    """What is done with each member."""

    scenario: str  # as TOML text
    axes: tuple[Axis, ...]  # what varies
    measures: tuple[Measure, ...]  # what is measured
    keep: int = 0  # each how-many-th sample is kept; 0: none
    block: int = 8  # members that go together

    @property
    def document(self) -> Scenario:
        """The scenario."""
        return _document(self.scenario)

    @cached_property
    def times(self) -> Array:
        """The instants of the samples that are kept, s."""
        timing = self.document.timing
        times = float(self.document.start.time) + sample_times(float(timing.duration), float(timing.every))
        return times[:: self.keep] if self.keep else times[:0]

    def run(self, values: Array) -> Columns:
        """Run some whole blocks of members, given the value of each axis (members, axes)."""
        parts = [self._block(values[first : first + self.block]) for first in range(0, len(values), self.block)]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _block(self, values: Array) -> Columns:
        systems, starts, refused = self._made(values)
        columns = self.empty(len(values))
        for member, reason in refused.items():
            columns["status"][member], columns["reason"][member] = REFUSED, reason
        for group in _alike(systems, starts):
            self._fill(columns, group, [systems[i] for i in group], [starts[i] for i in group])
        return columns

    def empty(self, count: int) -> Columns:
        """Return the columns of members of which nothing is known yet."""
        columns: Columns = {one.name: np.full(count, one.missing, dtype=one.dtype) for one in self.measures}
        columns["status"] = np.zeros(count, dtype=np.int8)
        columns["reason"] = np.full(count, "", dtype=object)
        if self.keep:
            sizes = {"time": self.times.size, "axis": 3, "quaternion": 4}
            for name, (dims, _) in self.facts.items():
                shape = (count, *(sizes[dim] for dim in dims))
                columns[name] = np.full(shape, -1 if name == "phase" else np.nan, np.int8 if name == "phase" else float)
        return columns

    @cached_property
    def facts(self) -> dict[str, tuple[tuple[str, ...], dict[str, Any]]]:
        """Dimensions and attributes of each variable that is sampled."""
        return labels.facts(self.document.system())

    def _fill(self, columns: Columns, group: list[int], systems: list[RollingSystem], starts: list[State]) -> None:
        """Run members of one structure, and put down what is measured of them."""
        timing = self.document.timing
        span, many = (float(timing.duration), float(timing.every)), self.block == _LARGEST
        runs = run_members(systems, starts, *span, method=timing.method, unrolled=many)
        sampled = Sampled(systems, runs, starts)
        for measure in self.measures:
            columns[measure.name][group] = measure.of(sampled)
        if self.keep:
            for name in self.facts:
                columns[name][group] = runs.arrays[name][:, :: self.keep]
        codes = {"refused": REFUSED, "failed": FAILED}
        for place, member in enumerate(group):
            columns["status"][member] = codes.get(runs.ending[place], DONE)
            columns["reason"][member] = _reason(runs.reason[place])

    # --- making members ---------------------------------------------------------------------------------------------

    def _made(self, values: Array) -> tuple[list[Any], list[Any], dict[int, str]]:
        """Return system and start of each member, and why there is none of some."""
        if self._only_starts:
            systems: list[Any] = [self.document.system()] * len(values)
            try:
                return systems, list(place_many(systems[0], **self._placed(values))), {}
            except InvalidValueError:  # one of them cannot be put down: each for itself
                pass
        made: list[Any] = []
        refused: dict[int, str] = {}
        for member, row in enumerate(values):
            try:
                made.append(self._alone(row))
            except InvalidValueError as error:
                made.append((None, None))
                refused[member] = str(error).partition("\n")[0]
        return [system for system, _ in made], [start for _, start in made], refused

    def member(self, row: Any) -> Scenario:
        """Return one member as a scenario of its own."""
        return Scenario.read(Varied(self.document, self.axes).tables(row), self.document.title)

    def _alone(self, row: Array) -> tuple[RollingSystem, State]:
        if self._only_numbers:
            return moved(self.document, {axis.key: float(value) for axis, value in zip(self.axes, row, strict=True)})
        document = self.member(row)
        return document.system(), document.start_state()

    @cached_property
    def _only_numbers(self) -> bool:
        """Whether all that varies are numbers that the scenario gives, so that nothing else of it has to be read."""
        known = numbers_of(self.document)
        return all(isinstance(known[axis.key][0], float) and not axis.words for axis in self.axes)

    @cached_property
    def _only_starts(self) -> bool:
        """Whether only the start varies, so that members can be put down together."""
        parts = [re.fullmatch(r"start\.(\w+)(\[\d+\])?", axis.key) for axis in self.axes]
        return self._only_numbers and all(part is not None and part[1] in PARTS for part in parts)

    def _placed(self, values: Array) -> dict[str, Any]:
        """Return what `place_many` takes."""
        given = self.document.start.arguments()
        for axis, column in zip(self.axes, values.T, strict=True):
            name, _, index = axis.key.removeprefix("start.").rstrip("]").partition("[")
            if not index:
                given[name] = column.copy()
                continue
            if not isinstance(given[name], np.ndarray):
                given[name] = np.tile(np.array(given[name], dtype=float), (len(values), 1))
            given[name][:, int(index)] = column
        if not any(isinstance(part, np.ndarray) for part in given.values()):
            given["position"] = np.tile(np.array(given["position"], dtype=float), (len(values), 1))
        return given


@cache
def _document(text: str) -> Scenario:
    return Scenario.loads(text)


def _alike(systems: list[Any], starts: list[Any]) -> Iterator[list[int]]:
    """Yield the members that can go together: of one structure, and from one instant on."""
    there = [i for i, system in enumerate(systems) if system is not None]
    kinds: list[Any] = []

    def kind(member: int) -> int:
        own = (structure_of(systems[member]), starts[member].time)
        if own not in kinds:
            kinds.append(own)
        return kinds.index(own)

    of = {member: kind(member) for member in there} if len({id(systems[i]) for i in there}) > 1 else {}
    ordered = sorted(there, key=lambda member: of.get(member, 0))
    for _, group in groupby(ordered, key=lambda member: of.get(member, 0)):
        yield list(group)


_ITS_NUMBER = re.compile(r"\bstarts\[\d+\]")


def _reason(text: str) -> str:
    """Return why a member has no result, without its place among those that were run with it."""
    return _ITS_NUMBER.sub("start", str(text)).partition("\n")[0]


__all__ = ["Columns", "Job", "block_of"]
