"""The path of a ball beside the vakonomic one from the same start: what is right, what is wrong, and how far apart."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...display import Headline, Markup, Serializable, paragraph, table
from ...mechanics import checks
from ...mechanics.system import RollingSystem
from .equations import VakonomicPath, vakonomic_path

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from ...scenario import ScenarioFile
    from ...views.plots.sheet import Sheet

    Array = NDArray[np.float64]

FAMILY = 6  # initial multipliers, in directions evenly around
SHARE = 0.1  # of m V, V being the ball's largest speed: the size of these multipliers
REACH = 1.6  # times as far from the axis as the ball goes: where the vakonomic path is followed no more
_SAMPLES = 2001
_SAME = 1e-9  # share of the distance from the axis, below which two paths are one


@dataclass(frozen=True, repr=False)
class VakonomicComparison(Serializable):
    """A ball's path and the vakonomic ones from the same start.

    Parameters
    ----------
    title : str
        Of the scenario.
    system : RollingSystem
        Ball and plane.
    time : array (n,)
        s.
    position : array (n, 2)
        Of the ball's centre over the plane, by d'Alembert's principle, m: equation T5.
    vakonomic : VakonomicPath
        With the initial multipliers asked for, up to where it leaves the reach.
    family : tuple of VakonomicPath
        The same from other initial multipliers.
    radius : float, optional
        Of the ball's circle, m; None where there is none.
    reach : float
        Distance from the axis at which the vakonomic paths are followed no more, m.
    drifting : bool
        Whether the ball's circle moves.
    """

    title: str
    system: RollingSystem
    time: Array
    position: Array
    vakonomic: VakonomicPath
    family: tuple[VakonomicPath, ...]
    radius: float | None
    reach: float
    drifting: bool = False

    @property
    def apart(self) -> Array:
        """The distance between the two centres while the vakonomic path is followed, m."""
        import numpy as np

        seen = self.vakonomic.time.size
        return np.hypot(*(self.vakonomic.position - self.position[:seen]).T)

    @property
    def stays(self) -> bool:
        """Whether the ball stays where it was put down."""
        return bool(abs(self.position - self.position[0]).max() <= _SAME * self.reach)

    @property
    def agree(self) -> bool:
        """Whether the two paths are one, as from rest on a level table."""
        return bool(self.apart.max() <= _SAME * self.reach)

    @property
    def leaves(self) -> float | None:
        """When the vakonomic path leaves the reach, s, to a sample; None if it stays."""
        return float(self.vakonomic.time[-1]) if self.vakonomic.time.size < self.time.size else None

    @property
    def way(self) -> str:
        """What the ball does, in a few words."""
        from ...wording import with_unit

        if self.stays:
            return "stays where it was put"
        if self.radius is None:
            return "rolls along as drawn"
        size = with_unit(self.radius, "length", 4)
        return (
            f"goes round in loops of radius {size} that drift" if self.drifting else f"runs a circle of radius {size}"
        )

    def plot(self) -> Sheet:
        """Draw both paths, and those from other initial multipliers."""
        from .figure import draw

        return draw(self)

    def rows(self) -> list[tuple[float, complex, complex]]:
        """Return a few instants with the place of the ball and the vakonomic one, s and m."""
        last = self.vakonomic.time.size - 1
        places = (self.position, self.vakonomic.position)
        picked = [round(last * share) for share in (0.25, 0.5, 0.75, 1.0)]
        return [(float(self.time[i]), complex(*places[0][i]), complex(*places[1][i])) for i in picked]

    def as_dict(self) -> dict[str, Any]:
        """Return the findings as plain numbers and lists."""
        return {
            "title": self.title,
            "warning": "the vakonomic path is wrong mechanics, for comparison only",
            "multipliers": self.vakonomic.multipliers[0].tolist(),
            "circle_radius": self.radius,
            "leaves": self.leaves,
            "reach": self.reach,
            "rows": [
                {"time": t, "ball": [r.real, r.imag], "vakonomic": [w.real, w.imag], "apart": abs(w - r)}
                for t, r, w in self.rows()
            ],
            "family": [
                {"multipliers": path.multipliers[0].tolist(), "end": float(path.time[-1])} for path in self.family
            ],
        }

    @property
    def warning(self) -> str:
        """What is wrong with the vakonomic path, in a sentence."""
        return "Its equations are wrong." if self.agree else "It is wrong: no ball moves so."

    def __str__(self) -> str:
        lines = [self.title] if self.title else []
        lines += [f"The vakonomic path beside the true one. {self.warning}", ""]
        lines += ["     time            ball, x and y           vakonomic, x and y        apart"]
        lines += [f"{t:>9}  {ball}  {other}  {apart:>9}" for t, ball, other, apart in self._cells()]
        return "\n".join([*lines, "", *self._findings()])

    def _headline(self) -> Headline:
        return Headline(self.title, f"the vakonomic path beside the true one. {self.warning}")

    def _parts(self) -> Iterator[Markup]:
        heads = ("time", "ball, x and y", "vakonomic, x and y", "apart")
        yield table(self._cells(), heads, numbers=range(4))
        yield paragraph("\n".join(self._findings()))

    def _cells(self) -> list[tuple[str, ...]]:
        """Return `rows` as text."""
        from ...wording import short, unit_for

        unit = unit_for(float(self.apart.max()), "length")
        return [
            (
                f"{t:.3f} s",
                *(f"({z.real:z9.4f}, {z.imag:z9.4f}) m" for z in (ball, other)),
                f"{short(abs(other - ball) / unit.scale, 3)} {unit.symbol}",
            )
            for t, ball, other in self.rows()
        ]

    def _findings(self) -> list[str]:
        """Return what there is to say, line by line."""
        from ...wording import with_unit

        lines, lam = [], self.vakonomic.multipliers[0]
        if self.agree:
            lines.append("From this start and these multipliers the two agree, one of them by luck.")
        if self.radius is not None or self.stays:
            lines.append(f"The ball {self.way}.")
        if self.leaves is not None:
            where = with_unit(self.reach, "length", 4)
            lines.append(f"The vakonomic path is {where} from the axis after {self.leaves:.3g} s, and runs away.")
        lines.append(f"It began with the multipliers λ = ({lam[0]:g}, {lam[1]:g}) kg m/s. Nothing sets them:")
        if self.family:
            lines.append(
                f"with {len(self.family)} others there are as many other paths, and none of them is the ball's."
            )
        return lines


def compare_vakonomic(
    scenario: ScenarioFile, multipliers: Any = (0.0, 0.0), *, duration: Any = None
) -> VakonomicComparison:
    """Compare the path of a scenario's ball with the vakonomic one: a negative control, not a method.

    Parameters
    ----------
    scenario : Scenario
        A homogeneous ball on a plane that is at rest or turns steadily, tilted or not, under constant forces.
    multipliers : sequence of 2 floats
        λ of the vakonomic path at the start, kg m/s.
    duration : float or quantity, optional
        How long, s; absent: one round of the ball's circle, at most the scenario's own duration.

    Returns
    -------
    VakonomicComparison
        Both paths; its `plot` draws them.

    Raises
    ------
    OutOfDomainError
        If the scenario is another one.

    Examples
    --------
    >>> import trundle as tr
    >>> found = compare_vakonomic(tr.Scenario.load("level-turntable-nudged"))
    >>> bool(found.apart[0] == 0.0), bool(found.apart[-1] > 0.3), found.way
    (True, True, 'runs a circle of radius 10.04 cm')
    """
    import numpy as np

    from ...scenario import ScenarioFile
    from ...solve.exact import SphereOnPlane

    checks.instance(scenario, ScenarioFile, "scenario", "Give for instance tr.Scenario.load('tilted-turntable').")
    system, start = scenario.system(), scenario.start_state()
    begin = vakonomic_path(system, start, [start.time, start.time + 1e-9])  # refuses what is not covered
    motion = SphereOnPlane.of(system, start)
    round_ = motion.has_guiding_centre and motion.circle_radius > 0
    length = float(scenario.timing.duration)
    if duration is not None:
        length = checks.positive(duration, "time", "duration")
    elif round_:
        length = min(length, motion.period)
    time = start.time + np.linspace(0.0, length, _SAMPLES)
    centre = motion.position_at(time - start.time)
    position = np.column_stack([np.broadcast_to(part, time.shape) for part in (centre.x, centre.y)])
    rim = system.support.surface.rim
    distance = float(np.hypot(*position.T).max())
    reach = float(rim) if rim is not None else REACH * distance + 10 * float(begin.system.body.radius)
    speed = float(np.hypot(*np.gradient(position, time, axis=0).T).max())
    carried = abs(float(system.support.motion.steady_rate or 0.0)) * distance
    size = SHARE * float(system.body.mass) * (speed if speed > _SAME * carried else carried)
    around = [cmath.rect(size, 2 * math.pi * i / FAMILY) for i in range(FAMILY)] if size > 0 else []
    paths = [
        vakonomic_path(system, start, time, pair, reach=reach)
        for pair in (multipliers, *((one.real, one.imag) for one in around))
    ]
    radius = float(motion.circle_radius) if round_ else None
    drifting = radius is not None and motion.is_drifting
    family = tuple(paths[1:])
    return VakonomicComparison(scenario.title, system, time, position, paths[0], family, radius, reach, drifting)
