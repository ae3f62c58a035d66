"""The one entry: pick the method, run it, return a trajectory."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from ..errors import InvalidValueError, ScenarioError
from ..mechanics import line_contact
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import Contact
from ..mechanics.finiteness import check_finite
from ..mechanics.nearest import contact_of, misplaced
from ..mechanics.placing import no_gap, slips
from ..mechanics.system import RollingSystem, State
from ..scenario import ScenarioFile
from ..solve import methods
from ..solve.samples import Progress
from ..solve.sampling import check_clock, longer_step, sample_times
from . import labels
from .memory import check_room
from .trajectory import Trajectory

_OFF_UNIT = 1e-6  # by which the length of a quaternion may be off: it is made 1 on the way


def simulate(
    system: RollingSystem,
    start: State,
    duration: Any,
    every: Any,
    method: str = "auto",
    *,
    tolerance: float | None = None,
    title: str = "",
    scenario: str | None = None,
    progress: Progress | None = None,
) -> Trajectory:
    """Run a rolling system from a start and return its trajectory.

    Parameters
    ----------
    system : RollingSystem
        Body, support, loads.
    start : State
        As `RollingSystem.place` makes it.
    duration : float or quantity
        Length of the run, s.
    every : float or quantity
        Step between samples, s; the end is always sampled.
    method : str
        "exact": the closed form. "taylor": heyoka at 1e-15. "runge-kutta": DOP853 at 1e-12. "auto": the closed
        form where every phase of the run has one, else Taylor's method, or "runge-kutta" where it takes less work to
        the error that Taylor's method has at `tolerance`.
    tolerance : float, optional
        Of "taylor" and "runge-kutta", relative, for each step, 1e-15 to 1e-6; absent: as above. The run remembers it,
        a hundredth of it where "auto" takes "runge-kutta", and its card allows for it. A closed form has none.
    title : str
        For figures and the card.
    scenario : str, optional
        The scenario as TOML text, to be stored with the run; absent: written from the system and the start.
    progress : callable, optional
        Told the fraction done, 0 to 1.

    Returns
    -------
    Trajectory
        Labelled arrays that carry their evidence.

    Raises
    ------
    InvalidValueError
        If a value is refused, the start does not roll, a formula in the time is not finite throughout the run, or the
        samples find no room in memory.
    OutOfDomainError
        If method is "exact" and no closed form covers a phase that the run comes to.
    SolverError
        If a numerical method breaks down.

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.Body.solid_sphere(radius=0.025, mass=0.065)
    >>> table = tr.Support(tr.Plane(rim=0.5), motion=tr.Spin("33.3 rpm"))
    >>> system = tr.RollingSystem(ball, table)
    >>> run = tr.simulate(system, system.place(position=(0.1, 0.0)), duration="10 s", every="10 ms")
    >>> run.method, run.data.time.size
    ('exact', 1001)
    """
    check_state(system, start)
    since = sample_times(duration, every)
    times = start.time + since
    check_room(times.size, labels.size_of(system), "every", every, partial(longer_step, times))
    check_finite(system, float(times[0]), float(times[-1]))
    check_start(system, start, float(times[-1]))
    check_clock(system, start, float(since[1]))
    chosen, samples = methods.run(method, system, start, times, progress, tolerance)
    if scenario is None:
        title, scenario = described(system, start, times, method, title)
    return Trajectory._of(samples, labels.attributes(title, chosen), system, start, scenario)


def described(system: RollingSystem, start: State, times: Any, method: str, title: str) -> tuple[str, str]:
    """Return title and TOML text of a system; no text where the scenario format has no words for a part of it."""
    length = float(times[-1] - start.time)
    step = float(times[1] - times[0]) if times.size > 2 else length
    try:
        described = ScenarioFile.describe(system, start, duration=length, every=step, method=method, title=title)
    except ScenarioError:
        return title, ""
    return described.title, described.to_toml()


def check_start(system: RollingSystem, start: State, until: float) -> None:
    """Refuse a hand-made start inside the support, or one that slips where nothing limits the friction."""
    q, centre = Quaternion(*start.orientation), Vector(*start.position)
    contact = contact_of(system, start)
    point = centre + contact.offset
    gap = (point - contact.point).dot(contact.normal)
    if not gap >= -no_gap(contact, start.position):
        raise InvalidValueError(
            "start.position", "must put the body on the support or over it", start.position, f"Gap: {gap:g} m."
        )
    elsewhere = misplaced(system, contact, centre, q)
    if elsewhere:
        rule = "must have a point of the support that is nearest to the body, on a side that its shape covers"
        remedy = f"{elsewhere} Let system.place(...) make the start, or turn or move the body."
        raise InvalidValueError("start.position", rule, start.position, remedy)
    system.check_rim(contact, start.position)
    _check_loads(system, start, contact)
    if gap <= no_gap(contact, start.position):
        _check_slip(system, start, contact)
    line_contact.check_start(system, start, until)


def check_state(system: RollingSystem, start: State) -> None:
    """Refuse what is no state of a system.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> check_state(system, system.place())
    """
    if not isinstance(start, State):
        raise InvalidValueError("start", "must be a State, as system.place(...) makes it", start)
    coordinates, remedy = system.support.motion.coordinates, "Let system.place(...) make the start."
    for name, count in _sizes(system).items():
        given = getattr(start, name)
        if not _are_numbers(given, count):
            rule = f"{count} finite numbers" if name != "support" else f"{', '.join(coordinates) or 'nothing'}"
            raise InvalidValueError(f"start.{name}", f"must hold {rule}", given, remedy)
    if not _are_numbers((start.time,), 1):
        raise InvalidValueError("start.time", "must be a finite number, s", start.time, remedy)
    if abs(math.hypot(*start.orientation) - 1) > _OFF_UNIT:
        rule = "must be a unit quaternion (w, x, y, z)"
        raise InvalidValueError("start.orientation", rule, start.orientation, "Divide it by its length.")


def are_states(system: RollingSystem, starts: Sequence[State]) -> bool:
    """Tell whether all of many starts are plain states of a system, looked at together; if not, some still may be.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> are_states(system, [system.place(), system.place((1.0, 0.0))])
    True
    """
    for name, count in {**_sizes(system), "time": 0}.items():
        try:
            values = np.array([getattr(start, name) for start in starts])
        except (AttributeError, TypeError, ValueError):
            return False
        if values.shape[1:] != ((count,) if name != "time" else ()) or values.dtype.kind not in "fi":
            return False
        if not np.isfinite(values).all():
            return False
        if name == "orientation" and (abs(np.linalg.norm(values, axis=1) - 1) > _OFF_UNIT).any():
            return False
    return True


def _sizes(system: RollingSystem) -> dict[str, int]:
    """Return of how many numbers each part of a state is."""
    coordinates = len(system.support.motion.coordinates)
    return {"position": 3, "velocity": 3, "angular_velocity": 3, "orientation": 4, "support": coordinates}


def _are_numbers(values: Any, count: int) -> bool:
    try:
        return len(values) == count and all(math.isfinite(value) for value in values)
    except TypeError:
        return False


def _check_loads(system: RollingSystem, start: State, contact: Contact) -> None:
    """Refuse a load that has no value where the body starts."""
    V, q, Omega = Vector(*start.velocity), Quaternion(*start.orientation), Vector(*start.angular_velocity)
    motion = contact.body_motion(system.body.mass, start.time, V, q, Omega)
    for i, load in enumerate(system.loads):
        try:
            parts = [*load.force(motion), *load.torque(motion), *load.torque_per_normal_force(motion)]
            finite = all(math.isfinite(part) for part in parts)
        except (ArithmeticError, ValueError):  # a formula divides by 0, or takes the root of something negative
            finite = False
        if not finite:
            remedy = "Start somewhere else, or change its formula."
            raise InvalidValueError(f"loads[{i}]", "must be finite at the start", load.word, remedy)


def _check_slip(system: RollingSystem, start: State, contact: Contact) -> None:
    if system.support.friction is not None:
        return
    slip = slips(system, contact, Vector(*start.velocity), Vector(*start.angular_velocity))
    if slip is not None:
        raise InvalidValueError(
            "start.angular_velocity",
            "must agree with rolling, V + Ω×ρ = u(p), where the support has no `friction`",
            f"a slip of {slip:.6g} m/s",
            "Let system.place(...) find Ω from no slip; or give the support a friction.",
        )


class Scenario(ScenarioFile):
    """A scenario file that can be run.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("level-turntable-nudged").run()
    >>> run.method
    'exact'
    """

    def run(
        self,
        method: str | None = None,
        *,
        duration: Any = None,
        every: Any = None,
        tolerance: float | None = None,
        progress: Progress | None = None,
    ) -> Trajectory:
        """Run the scenario.

        Parameters
        ----------
        method : str, optional
            Instead of the file's.
        duration, every : float or quantity, optional
            Instead of the file's, s.
        tolerance : float, optional
            As for `simulate`.
        progress : callable, optional
            Told the fraction done, 0 to 1.

        Returns
        -------
        Trajectory
            With the scenario's text and title.

        Raises
        ------
        TrundleError
            As `simulate`.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.Scenario.load("tilted-turntable").run(duration=1.0, every=0.5).data.time.values.tolist()
        [0.0, 0.5, 1.0]
        """
        return simulate(
            self.system(),
            self.start_state(),
            float(self.timing.duration) if duration is None else duration,
            float(self.timing.every) if every is None else every,
            self.timing.method if method is None else method,
            tolerance=tolerance,
            title=self.title,
            scenario=self.to_toml(),
            progress=progress,
        )
