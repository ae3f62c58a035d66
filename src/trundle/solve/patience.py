"""How much work a run may take, and how much more where it hardly gets on: then no run goes on for hours."""

from __future__ import annotations

import math

from ..errors import SolverError, TrundleError

_NOWHERE, _DEARER = 1e-10, 3  # steps of so small a share of the run lead nowhere, and count so many times
# Doublings of the work done, up to twice what is to spare: so many tell how long one takes, no longer in their later
# half than in their earlier. Even work takes ever longer for one. Where as long a doubling leads to so many times all
# steps, the end is out of reach.
_SEEN, _NO_LONGER, _BEYOND = 8, 1.12, 4


class Patience:
    """What refuses a run that would take longer than anyone waits.

    A run may take so many steps for all of its time, evenly, and where it hardly gets on, as near a pole of a formula
    just behind its end, some to spare. Where its work doubles again and again, as for a body that is thrown outwards
    over hill after hill, twice those to spare tell that it would come to no end.

    Parameters
    ----------
    begin, end : float
        Of the run, s.
    steps : float
        For all of it.
    spare : float
        Besides.
    name : str
        The method's.
    error : type
        What to raise.

    Examples
    --------
    >>> patience = Patience(0.0, 10.0, steps=1e6, spare=1e4, name="Taylor's method")
    >>> patience.after(50_000, 1.0)
    >>> patience.after(50_000, 1.0001)
    Traceback (most recent call last):
    ...
    trundle.errors.SolverError: Taylor's method hardly gets on at t = 1.0001 s: a step is 2e-09 s there. Ask for a ...
    """

    def __init__(
        self,
        begin: float,
        end: float,
        *,
        steps: float,
        spare: float,
        name: str,
        error: type[TrundleError] = SolverError,
    ) -> None:
        span = max(end - begin, 1e-300)
        self.time, self.pace, self.spare, self.nowhere = begin, steps / span, spare, _NOWHERE * span
        self.beyond = _BEYOND * (steps + spare)
        self.name, self.error = name, error
        self.owed = 0.0  # steps taken beyond the even ones
        self.end, self.done = end, 0.0
        self.doubled: list[float] = []  # when the steps done came to a share of those to spare, and twice it, and so on

    def after(self, steps: int, time: float, each: float = 1.0) -> None:
        """Take account of steps up to a time, each so many times the work of a usual one; refuse where it is too much.

        Work is counted, never timed, so that a run ends alike on any machine.
        """
        gone, self.time = max(time - self.time, 0.0), max(time, self.time)  # a step may be taken again, shorter
        counted = steps * each * (_DEARER if gone < steps * self.nowhere else 1)
        self.owed = max(0.0, self.owed + counted - gone * self.pace)
        if self.owed > self.spare or self._doubles_without_end(counted, gone):
            raise self.error(
                f"{self.name} hardly gets on at t = {time:.9g} s: a step is {gone / max(steps, 1):.1g} s there. Ask "
                "for a shorter run, or look for what turns so fast: a rate, a force, or a formula near where it ends."
            )

    def _doubles_without_end(self, counted: float, gone: float) -> bool:
        """Take account of the steps counted in the time gone; tell whether the end is out of reach of all to come."""
        before, self.done = self.done, self.done + counted
        first, began = 2 * self.spare / 2**_SEEN, self.time - gone
        while self.done >= (mark := first * 2 ** len(self.doubled)):
            self.doubled.append(began + gone * (mark - before) / counted)
        if len(self.doubled) <= _SEEN:
            return False
        earlier, middle, last = (self.doubled[-1 - back] for back in (_SEEN, _SEEN // 2, 0))
        each = (last - middle) / (_SEEN - _SEEN // 2)
        to_come = math.log2(self.beyond / self.done)
        return last - middle <= _NO_LONGER * (middle - earlier) and self.end - last > to_come * each
