"""A family of steady motions followed along one quantity: growth, frequencies, and where stability begins and ends."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Headline, Markup, Plottable, Serializable, fold, joined, number, table
from ...errors import InvalidValueError, SolverError
from ...mechanics import checks
from ...mechanics.motions import Spin
from .api import STEADY, check_name, described, held_from
from .finding import Relative, nearest
from .flow import Array
from .modes import Mode
from .quantities import KINDS, UNITS, Held, body_axis

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .result import SteadyMotion

_ROUNDS = 80  # of the search for a limit of stability, at most
_SHARP = 1e-13  # share to which it is found
_ASIDE = 1e-3  # of the interval: how far from the expected limit it is probed
_FEW = 9  # values asked for: no further ones are added
_CLOSE = (
    1.4,
    0.9,
    0.55,
    0.3,
    0.15,
    0.06,
    0.02,
    0.004,
)  # of a grid step: further values next to a limit, where the curves are steep
_NOTHING_TO_TWICE = (0.02, 2.0)
_FROM_REST = 20.0  # scales of the rate, for a quantity that is zero


@dataclass(frozen=True, repr=False)
class Sweep(Plottable, Serializable):
    """Growth and frequencies of a family of steady motions against one quantity.

    Parameters
    ----------
    name : str
        Of the quantity.
    values : (n,) array
        SI; fewer than asked where the family ends.
    motions : tuple of n SteadyMotion
        One for each.
    limits : tuple of float
        Values at which stability begins or ends, SI.
    here : float
        The value from which the family was followed.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane(), motion=tr.Spin(3.5)))
    >>> sweep = tr.steady_motions(table)[0].along("rate", 1.0, 7.0, count=3)
    >>> (sweep.frequencies[:, 0] / sweep.values).round(12).tolist()  # κ/ω = 2/7
    [0.285714285714, 0.285714285714, 0.285714285714]
    """

    name: str
    values: Array
    motions: tuple[SteadyMotion, ...] = field(repr=False)
    limits: tuple[float, ...]
    here: float
    ended: str = ""

    @property
    def unit(self) -> str:
        """Of the values."""
        return UNITS[self.name]

    @property
    def growth(self) -> Array:
        """The fastest growth at each value, 1/s; (n,)."""
        return np.array([one.growth for one in self.motions])

    @property
    def frequencies(self) -> Array:
        """The frequencies at each value, rad/s; (n, most), NaN where there are fewer."""
        rows = [one.frequencies for one in self.motions]
        most = max((len(row) for row in rows), default=0)
        return np.array([[*row, *[math.nan] * (most - len(row))] for row in rows]).reshape(len(rows), most)

    def __str__(self) -> str:
        from .words import said

        said_limits = " and ".join(said(self.name, limit) for limit in self.limits)
        first, last = (said(self.name, float(value)) for value in (self.values[0], self.values[-1]))
        where = f"{self.name} from {first} to {last}"
        words = {one.verdict for one in self.motions if one.verdict != "neutral"} or {"neutral"}
        if not self.limits:
            return f"{where}: {', '.join(sorted(words))} throughout{self.ended}"
        changes = f"stability changes at {self.name} {said_limits}"
        kinds = [self.motions[0].verdict, self.motions[-1].verdict]
        return f"{where}: {changes}; {kinds[0]} at the lower end, {kinds[1]} at the upper{self.ended}"

    def _headline(self) -> Headline:
        return Headline("", str(self))

    def _parts(self) -> Iterator[Markup]:
        rows = [
            (number(value), joined((number(part) for part in one.frequencies), ", "), number(one.growth), one.verdict)
            for value, one in zip(self.values, self.motions, strict=True)
        ]
        unit = f" ({self.unit})" if self.unit else ""
        heads = (f"{self.name}{unit}", "frequencies (rad/s)", "fastest growth (1/s)", "verdict")
        yield fold(f"{len(rows)} values", table(rows, heads, numbers=(0, 1, 2)))

    def as_dict(self) -> dict[str, Any]:
        """Return everything in SI units and plain types, for JSON."""
        return {
            "along": self.name,
            "unit": self.unit,
            "limits": list(self.limits),
            "values": self.values.tolist(),
            "growth": self.growth.tolist(),
            "frequencies": [list(one.frequencies) for one in self.motions],
            "verdicts": [one.verdict for one in self.motions],
        }

    def plot(self, title: str = "") -> Figure:
        """Draw frequencies over growth, with the limits of stability.

        Examples
        --------
        >>> import trundle as tr
        >>> table = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane(), motion=tr.Spin(3.5)))
        >>> figure = tr.steady_motions(table)[0].along("rate", count=3).plot()
        >>> figure.axes[0].get_ylabel()
        'frequency (rad/s)'
        """
        from .figure import draw

        return draw(self, title)


def deciding(motion: SteadyMotion) -> str:
    """Return the quantity that decides on stability: the rate of a turning support, else the speed, else the spin."""
    found = motion.quantities
    return "rate" if "rate" in found else "speed" if found["speed"] else "spin"


def follow(motion: SteadyMotion, name: str, lowest: Any, highest: Any, holding: Any, count: int) -> Sweep:
    """Follow a family of steady motions; see `SteadyMotion.along`."""
    begin = motion.relative
    axis = body_axis(begin.symmetries)
    check_name(name, axis, sweep=True)
    if name == "rate" and not isinstance(motion.system.support.motion, Spin):
        raise InvalidValueError("along", "must not be the rate of a support at rest", name, "Give it a spin.")
    if name not in motion.quantities:
        remedy = f"There are: {', '.join(motion.quantities)}."
        raise InvalidValueError("along", "must be a quantity of this motion", name, remedy)
    held = held_from(begin.flow, begin.y, begin.symmetries, holding)
    if any(one.name == name for one in held):
        raise InvalidValueError("holding", "must not name what is followed", name)
    here = motion.quantities[name]
    low, high = _ends(motion, name, here, lowest, highest)
    grid = np.linspace(low, high, max(int(checks.positive(count, "number", "count")), 2))

    def at(value: float, near: Relative) -> SteadyMotion | None:
        one = _member(near, name, value, held)
        return described(one.flow.system, one) if one.residual <= STEADY else None

    up, ended_up = _walk(grid[grid >= here], begin, at)
    down, ended_down = _walk(grid[grid < here][::-1], begin, at)
    members = dict([*down[::-1], *up])
    if not members:
        raise SolverError(f"No steady motion with {name} between {low:g} and {high:g} {UNITS[name]} was reached.")
    limits = _limits(members, at)
    for limit in limits if len(grid) > _FEW else ():
        _close_to(limit, float(grid[1] - grid[0]), members, at)
    values = sorted(members)
    ended = "; the family was lost before the end" if ended_up or ended_down else ""
    return Sweep(name, np.array(values), tuple(members[value] for value in values), tuple(limits), here, ended)


At = Callable[[float, Relative], "SteadyMotion | None"]


def _ends(motion: SteadyMotion, name: str, here: float, lowest: Any, highest: Any) -> tuple[float, float]:
    kind = KINDS[name]
    flow = motion.relative.flow
    size = here if here else _FROM_REST * flow.rate * (flow.length if name in ("speed", "distance") else 1.0)
    size = math.radians(80) / 2 if name == "lean" else size
    ends = sorted(share * size for share in _NOTHING_TO_TWICE)
    low = ends[0] if lowest is None else float(checks.real(lowest, kind, "lowest"))
    high = ends[1] if highest is None else float(checks.real(highest, kind, "highest"))
    if not low < high:
        raise InvalidValueError("highest", f"must be above the lowest, {low:g} {UNITS[name]}", high)
    return low, high


def _walk(values: Array, begin: Relative, at: At) -> tuple[list[tuple[float, SteadyMotion]], bool]:
    found: list[tuple[float, SteadyMotion]] = []
    near = begin
    for value in values:
        one = at(float(value), near)
        if one is None:
            return found, True
        near = one.relative
        found.append((float(value), one))
    return found, False


def _member(near: Relative, name: str, value: float, held: tuple[Held, ...]) -> Relative:
    """Return the member of the family with a given value, next to another member."""
    if name != "rate":
        wanted = Held(name, value, body_axis(near.symmetries))
        return nearest(near.flow, near.y, near.symmetries, (*held, wanted))
    system = near.flow.system
    system = replace(system, support=replace(system.support, motion=Spin(value)))
    flow = replace(near.flow, system=system, turning=value if near.flow.turning else 0.0)
    return nearest(flow, near.y, near.symmetries, held)


def _unstable(one: SteadyMotion) -> bool:
    return one.verdict == "unstable"


def _limits(members: dict[float, SteadyMotion], at: At) -> list[float]:
    """Return the values at which the verdict turns."""
    ordered = sorted(members)
    pairs = [(a, b) for a, b in pairwise(ordered) if _unstable(members[a]) != _unstable(members[b])]
    return [_limit(members[a], members[b], (a, b), at) for a, b in pairs]


def _limit(one: SteadyMotion, other: SteadyMotion, ends: tuple[float, float], at: At) -> float:
    """Return where growth begins, between a value where a nudge grows and one where none does.

    The square of the growth falls to 0 there in a nearly straight line, so two values with growth tell where. It is
    probed on either side of that place, ever wider until the limit lies between; halving takes over where that fails.
    """
    grows, (x, y) = (one, ends) if _unstable(one) else (other, ends[::-1])
    known, aside = [(grows.growth**2, x)], _ASIDE
    for count in range(_ROUNDS):
        if abs(y - x) <= _SHARP * max(abs(x), abs(y)):
            break
        guess, step = 0.5 * (x + y), aside * (y - x)
        probes = [guess]
        known.sort()
        if len(known) > 1 and known[1][0] > known[0][0] and count < _ROUNDS // 2:
            (square, near), (larger, far) = known[:2]
            guess = near - square * (far - near) / (larger - square)
            low, high = sorted((x + 0.5 * step, y - 0.5 * step))
            probes = [min(max(guess - step, low), high), min(max(guess + step, low), high)]
        for value in probes:
            probe = at(value, grows.relative)
            if probe is None:
                return 0.5 * (x + y)
            if _unstable(probe):
                x, grows = (value, probe) if abs(value - y) < abs(x - y) else (x, grows)
                known.append((probe.growth**2, value))
            else:
                y = value if abs(value - x) < abs(y - x) else y
        aside = _ASIDE if x in probes and y in probes else min(0.3, 8 * aside)
    return 0.5 * (x + y)


def _close_to(limit: float, step: float, members: dict[float, SteadyMotion], at: At) -> None:
    """Add members next to a limit, where growth and frequencies rise as square roots."""
    near = members[min(members, key=lambda value: abs(value - limit))].relative
    low, high = min(members), max(members)
    for share in _CLOSE:
        for value in (limit - share * step, limit + share * step):
            one = at(value, near) if low < value < high else None
            if one is not None:
                members[value] = one


__all__ = ["Mode", "Sweep", "deciding", "follow"]
