"""`check`: somebody else's trajectory against contact, constraint, law, integrals and trundle's own run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from trundle.wording import with_unit

from ...errors import InvalidValueError
from ...mechanics.kinks import kinks_and_jolts
from ...mechanics.system import RollingSystem, State
from ...scenario import ScenarioFile
from ...verify import CardFigure
from .case import Case
from .comparisons import ACCELERATION
from .deciding import Power, power_of
from .diagnosing import diagnose
from .examining import examine, view_of
from .integrals import integrals
from .motion import Motion, motion_of, with_orientation
from .own_run import OWN_RUN, OwnRun, own_run
from .reading import Conventions, read
from .record import ExternalTrajectory, check_covered, checked
from .result import Check, Mistake
from .sampled_alike import allowed_for
from .series import Series
from .spinning import acts, fitted_spin

TOLERANCE = 1e-5  # a share; what good methods leave is far below, and what a wrong law leaves far above
_LATER = 0.1  # of the run, that must hold before something can be said to change
_FOLLOWED = 2.0  # rad between samples
_CRUDE = 0.02  # a residual, as a share, that is more likely a matter of steps than of mechanics


@dataclass(frozen=True)
class Drawn:
    """What the figure shows."""

    system: RollingSystem  # for the title's numbers
    motion: Motion  # theirs, at the instants looked at
    series: tuple[Series, ...]  # all residuals
    ours: OwnRun  # our run


def check(
    data: Any,
    scenario: Any,
    *,
    start: State | None = None,
    columns: Mapping[str, str] | None = None,
    axes: str = "space",
    angles: str = "rad",
    quaternion: str = "wxyz",
    orientation: str = "body-to-space",
    euler: str = "xyz",
    frame: str = "support",
    time: str = "s",
    length: str = "m",
    tolerance: float = TOLERANCE,
) -> Check:
    """Say whether somebody else's trajectory rolls without slipping and obeys the law, and if not, why.

    Parameters
    ----------
    data : path, Track, pandas.DataFrame, xarray.Dataset, Trajectory or mapping of arrays
        Time and position of the centre at least; velocity, Ω and orientation where they are known. Columns are found
        by common names: t, x, y, z, vx, ..., wx, ..., qw, ...; vectors may come as arrays (n, 3): position, velocity,
        angular_velocity, orientation. A heading may carry a unit: "x [mm]".
    scenario : RollingSystem, Scenario, or the name or path of one
        What is said to move. Its start gives what the data leave open, such as the spin.
    start : State, optional
        Instead of the scenario's.
    columns : mapping, optional
        Trundle's name -> the heading in the file, where the name does not tell. This and the options below say how
        `data` is to be read; of a `Track`, which was read already, only `orientation` and `euler` are left open.
    axes : str
        "space" or "body": along which Ω has its components.
    angles : str
        "rad" or "deg", also of rates.
    quaternion : str
        "wxyz" or "xyzw", for numbered columns and arrays.
    orientation : str
        "body-to-space" or "space-to-body".
    euler : str
        Axes of the angles e1, e2, e3, as SciPy has them.
    frame : str
        "support", "world" or "corotating".
    time, length : str
        Units where the headings have none.
    tolerance : float
        To which they are held, as a share of the speed; ten times that for accelerations. Where noise or spacing of
        the samples leave more open, the bound is larger, and the card says so.

    Returns
    -------
    Check
        A card, with `first_failure`, `likely` and `plot()`.

    Raises
    ------
    InvalidValueError
        If the data cannot be read, or are no motion that could be checked.
    UnknownNameError
        If an option has no such value.

    Examples
    --------
    A ball that somebody integrated with the moment of inertia of a shell:

    >>> import numpy as np
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.025, mass=0.065), table)
    >>> t, kappa = np.arange(0.0, 5.0, 0.01), 0.4 * 3.5  # 2/5 of ω: k/(1 + k) of a shell
    >>> theirs = {"t": t, "x": 0.1 * np.cos(kappa * t), "y": 0.1 * np.sin(kappa * t)}
    >>> found = tr.check(theirs, system)
    >>> found.passed, [(mistake.name, round(mistake.numbers.get("inertia_ratio", 0.0), 4)) for mistake in found.likely]
    (False, [('wrong-inertia-ratio', 0.6667), ('wrong-table-rate', 0.0)])
    """
    tolerance = _positive(tolerance)
    system, start, title = _system_of(scenario, start)
    check_covered(system)
    conventions = Conventions(columns or {}, axes, angles, quaternion, orientation, euler, frame, time, length)
    theirs = checked(read(data, system, conventions), system)
    _check_smooth(system, theirs)
    given = theirs.parts
    theirs, coarse = followed(theirs, system)
    theirs = with_orientation(system, theirs, start)
    if start is None and acts(system, theirs):
        theirs, found = _with_spin(system, theirs, tolerance)
        coarse += found
    case, ours = _looked_at(system, theirs, tolerance, start)
    figures = [*_told(case), *coarse, *map(_figure, case.series.values())]
    if OWN_RUN not in case.series:
        figures.append(CardFigure(OWN_RUN, float("nan"), note=f"not compared: {ours.remark}"))
    likely, nearest = diagnose(case) if case.failing else ((), ())
    power = Power({}, {}) if case.failing else power_of(case)
    span = float(theirs.time[-1] - theirs.time[0])
    return Check(
        f"{theirs.source or 'Their motion'} against {title or 'the system given'}",
        f"their {given}, {theirs.time.size} samples over {span:g} s, compared over windows of the run",
        tuple(figures),
        _first_failure(case),
        likely,
        nearest,
        tuple(power.blind.values()),
        _decides(case, power),
        "\n".join([*theirs.remarks, *filter(None, [_remark(case, likely, nearest)])]),
        _apart(ours),
        _drawn=Drawn(system, case.motion, tuple(case.series.values()), ours),
    )


def _check_smooth(system: RollingSystem, theirs: ExternalTrajectory) -> None:
    """Refuse data that lead across a jump of the support's velocity: a window across it has no slopes."""
    first, last = float(theirs.time[0]), float(theirs.time[-1])
    jolt = next((kink.time for kink in kinks_and_jolts(system, first, last) if kink.jolts and kink.time > first), None)
    if jolt is not None:
        rule = "must not lead across a jump of the support's velocity, which strikes the body"
        remedy = "Check what lies before that instant and what lies behind it by themselves."
        raise InvalidValueError("time", rule, f"{first:g} s to {last:g} s, with a jump at {jolt:.9g} s", remedy)


def _with_spin(
    system: RollingSystem, theirs: ExternalTrajectory, tolerance: float
) -> tuple[ExternalTrajectory, list[CardFigure]]:
    """Add the spin that the path tells, where neither data nor start do."""
    spin = fitted_spin(system, theirs, tolerance, None)
    if spin is None:
        return theirs, []
    note = "nothing that was given tells it: fitted to the path"
    return replace(theirs, spin=spin), [CardFigure("spin at the start", spin, "rad/s", note=note)]


def _looked_at(
    system: RollingSystem, theirs: ExternalTrajectory, tolerance: float, start: State | None
) -> tuple[Case, OwnRun]:
    """Compare a motion with all there is to compare it with."""
    view = view_of(system, theirs, tolerance, start)
    series, at = examine(system, theirs, tolerance, start, view)
    series |= {one.name: one for one in integrals(system, theirs, tolerance, start)}
    fails = any(one.worst > 1 for one in series.values())
    compared, ours = own_run(system, theirs, tolerance, start, closest=fails)
    if ours.start is not None and fails:
        series = allowed_for(series, system, theirs, tolerance, view, ours.start)
    series |= {} if compared is None else {compared.name: compared}
    return Case(system, theirs, tolerance, start, view, series, at), ours


def _decides(case: Case, power: Power) -> bool:
    """Tell whether a line can be told, and most mistakes that matter would have been seen; if none does, the law."""
    if not any(one.tells for one in case.series.values()):
        return False
    return power.decides if power.shown or power.blind else case.series[ACCELERATION].tells


def _apart(ours: OwnRun) -> str:
    """Say how far apart the two bodies are in the end."""
    if not np.isfinite(ours.distance):
        return ""
    turned = "" if np.isnan(ours.angle) else f" and {np.degrees(ours.angle):.3g}°"
    return f"{with_unit(ours.distance, 'length')}{turned} from our own run after {ours.after:.4g} s"


def followed(theirs: ExternalTrajectory, system: RollingSystem) -> tuple[ExternalTrajectory, list[CardFigure]]:
    """Leave the orientation out where the body turns so far between samples that nobody could tell how often."""
    turn = _turn_between(theirs, system)
    if turn <= _FOLLOWED:
        return theirs, []
    if not system.body.is_isotropic_sphere:  # neither do samples of Ω so far apart add up to it
        raise InvalidValueError(
            "time", "must be sampled often enough to follow the orientation", f"{turn:.3g} rad a sample", "Write more."
        )
    if theirs.orientation is None:
        return theirs, []
    note = "the body turns too far between samples: the orientation is left out"
    return replace(theirs, orientation=None), [CardFigure("turn between samples", turn, "rad", note=note)]


def _turn_between(theirs: ExternalTrajectory, system: RollingSystem) -> float:
    """Return how far the body seems to turn from one sample to the next, rad."""
    steps, q = np.diff(theirs.time), theirs.orientation
    if theirs.angular_velocity is not None:
        return float(np.linalg.norm(theirs.angular_velocity, axis=1).max() * np.median(steps))
    if q is None:
        return 0.0
    some = np.unique(np.linspace(0, theirs.time.size - 1, min(theirs.time.size, 240)).round().astype(int))
    at = motion_of(system, theirs, None, some)
    fastest = float(np.linalg.norm((at.velocity - at.carried) / np.linalg.norm(at.offset[0]), axis=1).max())
    seen = 2 * np.arccos(np.clip(np.abs((q[1:] * q[:-1]).sum(axis=1)), 0.0, 1.0))
    return max(fastest * float(np.median(steps)), float(np.median(seen)))


def _positive(tolerance: Any) -> float:
    try:
        value = float(tolerance)
    except (TypeError, ValueError):
        value = -1.0
    if not 0 < value < 1:
        raise InvalidValueError("tolerance", "must be a share, above 0 and below 1", tolerance, "1e-5 is the default.")
    return value


def _system_of(scenario: Any, start: State | None) -> tuple[RollingSystem, State | None, str]:
    if isinstance(scenario, RollingSystem):
        return scenario, start, ""
    if not isinstance(scenario, ScenarioFile):
        scenario = ScenarioFile.load(scenario)
    return scenario.system(), start or scenario.start_state(), scenario.title


def _told(case: Case) -> list[CardFigure]:
    step = np.diff(case.theirs.time)
    even = np.ptp(step) <= 1e-3 * step.mean()
    noise = float(np.median(case.motion.estimates["position"].noise))
    found = [
        CardFigure("time between samples", float(np.median(step)), "s", note="even" if even else "the median; uneven"),
        CardFigure("scatter of the positions", noise, "m", note="each component, about a smooth path"),
    ]
    if case.start is not None:
        away = float(np.linalg.norm((case.theirs.position[0] - np.asarray(case.start.position))[:2]))
        found.append(CardFigure("start, from that of the scenario", away, "m", note="any start may be checked"))
    return found


def _figure(series: Series) -> CardFigure:
    share, allowed = series.share, series.allowed
    holds = share <= allowed
    room = float(series.bound[np.argmax(series.ratio)])
    note = series.note
    if room > 2 * series.asked:
        note += "; noise and spacing of the data leave that much open"
    if holds and not series.tells:
        return CardFigure(series.name, share, "", allowed, None, f"{note}: too much to tell")
    return CardFigure(series.name, share, "", allowed, holds, note)


def _first_failure(case: Case) -> float | None:
    """Return when a residual first exceeds its bound; from the first sample on, where it does so at once."""
    times = [one.first_failure for one in case.failing]
    found = [time for time in times if time is not None]
    return min(found) if found else None


def _remark(case: Case, likely: tuple[Mistake, ...], nearest: tuple[Mistake, ...]) -> str:
    if not case.failing:
        coarse = [one.name for one in case.series.values() if not one.tells]
        return f"The data are too few or too noisy to tell: {', '.join(coarse)}." if coarse else ""
    if likely:
        return ""
    failing = {series.name for series in case.failing}
    if failing == {OWN_RUN}:
        return (
            "At each instant the law holds as closely as the data can show, and yet the path departs from ours: "
            "small errors add up. Shorter steps, or a smaller tolerance of the integrator, would tell."
        )
    if nearest:
        return "Nothing tried here explains all of it. Nearest:"
    first, law = _first_failure(case), case.series[ACCELERATION]
    if first is not None and first > float(case.theirs.time[0]) + _LATER * np.ptp(case.theirs.time):
        return f"Until t = {first:.4g} s all holds. Nothing tried here explains the whole: look for what changes there."
    if all(series.share < _CRUDE for series in case.failing if series.name != OWN_RUN):
        return (
            f"Nothing tried here explains it. The law is off by {law.share:.2g} at most: so little is more often a "
            "matter of steps and tolerances than of mechanics. Halve the step and see whether it falls."
        )
    return "Nothing tried here explains it: no change of units, axes, numbers or terms leaves nothing over."
