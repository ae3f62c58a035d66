"""From a ball on a turntable to the charge that moves as it does, and back.

κ ↔ −QB/M, φ ↔ QE/M, γ ↔ C/M (theory page, section 5; [burns1981]).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...display import Headline, Markup, Plottable, paragraph
from ...errors import InvalidValueError, OutOfDomainError
from ...mechanics import checks
from ...mechanics.bodies import Body
from ...mechanics.loads import Drag, Force, Load
from ...mechanics.motions import Fixed, Spin
from ...mechanics.scalars import is_number
from ...mechanics.surfaces import Plane
from ...mechanics.system import STANDARD_GRAVITY, RollingSystem, State, Support
from ...solve.exact import SphereOnPlane
from ...solve.samples import ROLLING
from ...solve.transitions import at_start
from .particle import ELECTRON_MASS, ELEMENTARY_CHARGE, ChargedParticle

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.figure import Figure

    from ...scenario import ScenarioFile

LIGHT = 299792458.0  # m/s, exact by definition
FASTEST = 0.1  # of the speed of light: beyond it the slow particle's formulas are off by more than half a percent
ELECTRON_SLOW_MOTION = 1e6  # the electron's microseconds are the ball's seconds


@dataclass(frozen=True, repr=False)
class Twin(Plottable):
    """A ball and the charge that moves as it does: the same path, and the same times but for slow motion.

    Examples
    --------
    >>> import trundle as tr
    >>> pair = tr.twin(tr.Scenario.load("tilted-turntable"))
    >>> pair.largest_difference(20.0) < 1e-13
    True
    """

    ball: SphereOnPlane
    particle: ChargedParticle
    slow_motion: float = 1.0  # seconds of the ball for each of the particle
    tilt: float = 0.0  # of the table, rad
    title: str = ""
    duration: float = 0.0  # of the scenario, s; 0 where there is none

    def paths(self, t: Any) -> tuple[Any, Any]:
        """Return both paths, each by its own formulas.

        Parameters
        ----------
        t : array (n,)
            Times of the ball, s.

        Returns
        -------
        ball, particle : array (n, 2)
            x and y of the centre of the ball, and of the particle, m.
        """
        import numpy as np

        times = np.asarray(t, dtype=float)
        centre = self.ball.position_at(times)
        of_ball = np.stack([np.broadcast_to(part, times.shape) for part in (centre.x, centre.y)], axis=-1)
        return of_ball, np.stack(self.particle.position_at(times / self.slow_motion), axis=-1)

    def largest_difference(self, duration: Any, samples: int = 2001) -> float:
        """Return the greatest distance between the two paths, m, over a time in s."""
        import numpy as np

        ball, particle = self.paths(np.linspace(0.0, checks.positive(duration, "time", "duration"), samples))
        return float(np.hypot(*(ball - particle).T).max())

    def rounding(self, duration: Any) -> float:
        """Return what rounding may do to the difference of the paths, m.

        Some units in the last place of the size of the path, and of the radius for each radian turned, since the phase
        of the particle is kept in one float.
        """
        import numpy as np

        length = checks.positive(duration, "time", "duration")
        ball, _ = self.paths(np.linspace(0.0, length, 2001))
        size = float(np.abs(ball).max()) + math.hypot(*self.ball.velocity) * length
        turned = abs(self.ball.kappa) * length
        radius = self.ball.circle_radius if self.ball.has_guiding_centre else 0.0
        return 2.0**-52 * (16 * size + 4 * turned * min(radius, size))

    @property
    def agrees(self) -> bool:
        """Whether the two paths differ by no more than rounding, over the time that is shown."""
        return self.largest_difference(self.shown_duration) <= self.rounding(self.shown_duration)

    def __str__(self) -> str:
        from .table import report

        return report(self)

    def _headline(self) -> Headline:
        return Headline(self.title, f"the two paths {'agree' if self.agrees else 'DIFFER'}", self.agrees)

    def _parts(self) -> Iterator[Markup]:
        from .table import agreement, shown

        yield shown(self)
        yield paragraph(agreement(self))

    def table(self) -> list[tuple[str, str, str, str, str]]:
        """Return the correspondence by rows: what it is; of the ball, its formula and value; of the charge, the same.

        Each value comes from the formulas of its own side; those of the charge are in the time of the ball.
        """
        from .table import rows

        return rows(self)

    def plot(self, duration: Any = None) -> Figure:
        """Draw both paths over each other, with fields, drift and the line of equal height and equal potential.

        Parameters
        ----------
        duration : float or quantity, optional
            s; absent: the scenario's; where there is none, three turns or a minute.

        Returns
        -------
        matplotlib.figure.Figure
            Needs neither a display nor pyplot.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.twin(tr.Scenario.load("tilted-turntable")).plot().axes[0].get_xlabel()
        'y, level (cm)'
        """
        from .figure import draw

        return draw(self, self.shown_duration if duration is None else checks.positive(duration, "time", "duration"))

    @property
    def shown_duration(self) -> float:
        """The scenario's duration; where there is none, three turns, but at most a minute, s."""
        if self.duration:
            return self.duration
        return min(3 * 2 * math.pi / abs(self.ball.kappa), 60.0) if self.ball.kappa else 5.0


def twin(
    system: RollingSystem | ScenarioFile,
    start: State | None = None,
    *,
    mass: Any = None,
    charge: Any = 1.0,
    electron: bool = False,
    slow_motion: Any = None,
) -> Twin:
    """Find the charge in crossed fields that moves as a ball on a turntable does.

    Only the ratios QB/M, QE/M and C/M matter, so mass and charge are free.

    Parameters
    ----------
    system : RollingSystem or Scenario
        An isotropic sphere on a plane that is fixed or turns steadily, level or tilted, under constant forces and
        torques and drag in still air.
    start : State, optional
        A start that rolls; a scenario brings its own.
    mass : float or quantity, optional
        M of the charge, kg; absent: the ball's.
    charge : float
        Q, C.
    electron : bool
        Take an electron, in place of mass and charge.
    slow_motion : float, optional
        How many seconds the ball takes for one of the charge; absent: 1, and a million for an electron.

    Returns
    -------
    Twin
        Both motions.

    Raises
    ------
    OutOfDomainError
        If nothing corresponds to a part of the system, such as air that turns; the message names it.
    InvalidValueError
        If a value is refused, or the charge would come near the speed of light.

    Examples
    --------
    >>> import trundle as tr
    >>> pair = tr.twin(tr.Scenario.load("level-turntable-nudged"))
    >>> round(pair.particle.magnetic_field, 6), pair.particle.electric_field
    (-0.50813, (0.0, 0.0))
    """
    title, duration = "", 0.0
    rolling: Any = system
    if not isinstance(system, RollingSystem) and hasattr(system, "start_state"):
        rolling, start = system.system(), system.start_state() if start is None else start
        title, duration = system.title, _until_the_rim(rolling, start, float(system.timing.duration))
    checks.instance(rolling, RollingSystem, "system", "Give a tr.RollingSystem and a start, or a tr.Scenario.")
    ball = _ball(rolling, checks.instance(start, State, "start", "Give what system.place(...) returns."))
    pace = ELECTRON_SLOW_MOTION if electron else 1.0
    if slow_motion is not None:
        pace = checks.positive(slow_motion, "number", "slow_motion")
    if electron:
        if mass is not None or charge != 1.0:
            raise InvalidValueError(
                "electron", "must not stand beside mass or charge", (mass, charge), "Give one kind."
            )
        mass, charge = ELECTRON_MASS, -ELEMENTARY_CHARGE
    M = checks.positive(ball.mass if mass is None else mass, "mass", "mass")
    Q = checks.real(charge, "number", "charge")
    if Q == 0:
        raise InvalidValueError("charge", "must not be zero", charge, "No field turns what has no charge.")
    phi = (float(ball.phi.re), float(ball.phi.im))
    particle = ChargedParticle(
        mass=M,
        charge=Q,
        magnetic_field=-ball.kappa * pace * M / Q + 0.0,
        electric_field=(phi[0] * pace**2 * M / Q + 0.0, phi[1] * pace**2 * M / Q + 0.0),
        position=(float(ball.position[0]), float(ball.position[1])),
        velocity=(float(ball.velocity[0]) * pace, float(ball.velocity[1]) * pace),
        resistance=ball.gamma * pace * M,
    )
    found = Twin(ball, particle, pace, float(rolling.support.tilt), title, duration)
    _check_slow(found)
    return found


def _until_the_rim(system: RollingSystem, start: State, duration: float) -> float:
    """Return how long the ball is on the table: a charge knows no rim."""
    if system.support.surface.rim is None or SphereOnPlane.violations(system):
        return duration
    from ...simulation.simulate import simulate

    return float(simulate(system, start, duration, duration, "exact").data.time[-1]) - start.time


def _ball(system: RollingSystem, start: State) -> SphereOnPlane:
    outside = SphereOnPlane.violations(system)
    if outside:
        raise OutOfDomainError(
            "A charge in uniform crossed fields corresponds to an isotropic sphere on a plane that is fixed or turns "
            f"steadily, under constant loads and drag in still air. Nothing corresponds to this: {'; '.join(outside)}."
        )
    phase = at_start(system, start).law.code
    if phase != ROLLING:
        raise OutOfDomainError(
            f"A charge corresponds to a ball that rolls; this one {('', 'slips', 'falls', 'rests')[phase]} at first. "
            "Put it down so that it rolls."
        )
    ball = SphereOnPlane.of(system, start)
    if not all(is_number(part) for part in (ball.kappa, ball.phi.re, ball.phi.im, *ball.position, *ball.velocity)):
        raise InvalidValueError("system", "must be one ball", "arrays or symbols", "Take one member at a time.")
    return ball


def _check_slow(found: Twin) -> None:
    import numpy as np

    times = np.linspace(0.0, found.shown_duration / found.slow_motion, 501)
    fastest = float(np.hypot(*found.particle.velocity_at(times)).max())
    if fastest > FASTEST * LIGHT:
        raise InvalidValueError(
            "slow_motion",
            f"must leave the charge below {FASTEST:g} of the speed of light",
            found.slow_motion,
            f"It would reach {fastest:.3g} m/s; these formulas are those of a slow particle. Take a smaller one.",
        )


def to_turntable(
    particle: ChargedParticle,
    body: Body | None = None,
    *,
    slow_motion: Any = 1.0,
    gravity: Any = STANDARD_GRAVITY,
    force: bool = False,
) -> tuple[RollingSystem, State]:
    """Find the turntable on which a ball moves as a charge in crossed fields does.

    Parameters
    ----------
    particle : ChargedParticle
        The charge.
    body : Body, optional
        A sphere; absent: a solid one of 25 mm and of the particle's mass.
    slow_motion : float
        How many seconds the ball shall take for one of the charge.
    gravity : float or quantity
        g, m/s².
    force : bool
        Push with a constant force instead of a tilt. A tilt pushes along the first axis only.

    Returns
    -------
    system : RollingSystem
        Body, table, loads.
    start : State
        Its start.

    Raises
    ------
    OutOfDomainError
        If no tilt below 90° pushes hard enough, or E does not lie along the first axis.
    InvalidValueError
        If the body is no isotropic sphere, or a value is refused.

    Examples
    --------
    >>> system, start = to_turntable(ChargedParticle(0.065, 1.0, -0.065, (0.01, 0.0)))
    >>> round(system.support.motion.rate, 12)  # 7/2 of the rate of the circles
    3.5
    """
    checks.instance(particle, ChargedParticle, "particle", "Give a tr.ChargedParticle.")
    pace = checks.positive(slow_motion, "number", "slow_motion")
    body = body or Body.solid_sphere(radius=0.025, mass=particle.mass)
    k = body.inertia_ratio
    share = particle.charge / particle.mass / pace**2 * (1 + k)  # of E, what must push the ball, for each kg of it
    push = tuple(share * component for component in particle.electric_field)
    rate = particle.gyration_rate / pace * (1 + k) / k
    loads: tuple[Load, ...] = ()
    tilt = 0.0
    if force:
        loads = (Force((body.mass * push[0], body.mass * push[1], 0.0)),) if any(push) else ()
    else:
        tilt = _tilt(push, checks.non_negative(gravity, "acceleration", "gravity"))
    if particle.resistance:
        loads = (*loads, Drag(particle.resistance / particle.mass / pace * body.mass * (1 + k)))
    table = Support(Plane(), motion=Spin(rate) if rate else Fixed(), tilt=tilt)
    system = RollingSystem(body, table, loads, gravity)
    return system, system.place(particle.position, tuple(c / pace for c in particle.velocity))


def _tilt(push: tuple[float, ...], gravity: float) -> float:
    if push[1] != 0.0:
        raise OutOfDomainError(
            "The slope falls along the first axis, so E must lie along it; "
            f"here it makes {math.degrees(math.atan2(push[1], push[0])):.6g}° with it. "
            "Turn the axes, or push with a force (force=True)."
        )
    if push[0] and not abs(push[0]) < gravity:
        raise OutOfDomainError(
            f"A slope pushes with less than g = {gravity:g} m/s²; this needs {abs(push[0]):.6g} m/s². "
            "Take a larger slow_motion, or push with a force (force=True)."
        )
    return math.asin(push[0] / gravity) if push[0] else 0.0
