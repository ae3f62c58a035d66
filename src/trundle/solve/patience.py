"""When to give a motion up: its steps have become so short that the run would not end."""

from __future__ import annotations

from ..errors import SolverError

STEPS = 5000  # after which the pace is looked at
_MOST_STEPS = 1e8  # that what is left of a run may take at the pace of the last steps
_GIVEN = 12  # looks in a row at a pace slower than that


class Patience:
    """Counts the steps of a method on its way, and gives up where they lead nowhere.

    Parameters
    ----------
    begin, end : float
        Of what the method follows, s.

    Examples
    --------
    >>> patience = Patience(0.0, 1.0)
    >>> for look in range(100):
    ...     patience.look(1e-15 * look)
    Traceback (most recent call last):
    ...
    trundle.errors.SolverError: At t = 1.2e-14 s the steps ...
    """

    def __init__(self, begin: float, end: float) -> None:
        self._reached, self._end, self._slow = begin, end, 0

    def look(self, time: float) -> None:
        """Note the time reached after another `STEPS` steps, s; raise SolverError where the end will not be reached."""
        step, self._reached = (time - self._reached) / STEPS, time
        self._slow = 0 if step * _MOST_STEPS > self._end - time else self._slow + 1
        if self._slow > _GIVEN:
            raise SolverError(
                f"At t = {time:.9g} s the steps have become so short ({step:.2g} s) that the run would not end. Look "
                "for forces that grow without limit there, or ask for a shorter run."
            )
