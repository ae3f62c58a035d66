"""What a sweep measures of each member: figures by name, of formulas in what is sampled, for many members at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError, TrundleError, did_you_mean
from ...mechanics.expressions import FUNCTIONS, Expression
from ...mechanics.system import RollingSystem, State
from ...scenario.together import tell_all
from ...simulation import labels
from ...solve.ensemble import together
from ...solve.samples import ENDS, KINDS, Samples
from ...verify.energy import energy
from ..many.running import Runs
from .dimensions import unit_of

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

_AXES = "xyz"
# Variables of a formula -> (variable of a dataset, which component) and the unit.
_SAMPLED = {
    **{axis: ("position", i, "m") for i, axis in enumerate(_AXES)},
    **{f"v{axis}": ("velocity", i, "m s-1") for i, axis in enumerate(_AXES)},
    **{f"w{axis}": ("angular_velocity", i, "rad s-1") for i, axis in enumerate(_AXES)},
    **{f"c{axis}": ("contact", i, "m") for i, axis in enumerate(_AXES)},
    **{f"f{axis}": ("contact_force", i, "N") for i, axis in enumerate(_AXES)},
    **{f"s{axis}": ("slip_velocity", i, "m s-1") for i, axis in enumerate(_AXES)},
}
VARIABLES = {"t": "s", **{name: unit for name, (_, _, unit) in _SAMPLED.items()}, "tilt": "rad", "energy": "J"}

OUTCOMES = ("waiting", "done", "refused", "failed", "inferred")  # of a member: the last from those about it
WAITING, DONE, REFUSED, FAILED, INFERRED = range(5)
_NEWTON = 60  # halvings of an interval between two samples


@dataclass(frozen=True)
class Sampled:
    """Members as they were sampled: each quantity (members, time), not a number after the end of a run."""

    systems: Sequence[RollingSystem]  # one for each member
    runs: Runs  # their arrays
    starts: Sequence[State]  # from where
    _kept: dict[str, Array] = field(default_factory=dict, compare=False)

    @property
    def times(self) -> Array:
        """The instants, s."""
        return self.runs.times

    def quantity(self, name: str) -> Array:
        """Return a variable of formulas (members, time)."""
        if name not in self._kept:
            self._kept[name] = self._made(name)
        return self._kept[name]

    def _made(self, name: str) -> Array:
        if name == "t":
            return np.broadcast_to(self.times, self.ran.shape)
        if name == "tilt":
            w, x, y, z = np.moveaxis(self.runs.arrays["orientation"], -1, 0)
            across = 2 * np.hypot(x * z + w * y, y * z - w * x)  # of the body's third axis, beside the support's
            return np.arctan2(across, w * w - x * x - y * y + z * z)
        if name == "energy":
            return self._energy()
        variable, component, _ = _SAMPLED[name]
        return self.runs.arrays[variable][..., component]

    def _energy(self) -> Array:
        members, instants = self.ran.shape
        flat: dict[str, Any] = {
            name: self.runs.arrays[name].swapaxes(0, 1).reshape(members * instants, *self.runs.arrays[name].shape[2:])
            for name in ("position", "contact", "velocity", "angular_velocity", "orientation", "contact_force", "phase")
        }
        names = labels.coordinate_names(self.systems[0])
        own = [self.runs.arrays[name].T.ravel() for name in names]
        columns = np.stack(own, axis=1) if own else None
        samples = Samples(np.repeat(self.times, members), **flat, support_coordinates=columns)
        with np.errstate(invalid="ignore"):
            return energy(together(self.systems, instants), samples).reshape(instants, members).T

    @cached_property
    def ran(self) -> NDArray[np.bool_]:
        """Whether a member's run reached an instant (members, time)."""
        return np.isfinite(self.runs.arrays["position"][..., 0])

    @property
    def last(self) -> NDArray[np.int64]:
        """The place of the last sample of each member; -1 where it has none."""
        return self.ran.sum(axis=1) - 1

    def formula(self, expression: Expression) -> Array:
        """Return a formula (members, time)."""
        with np.errstate(all="ignore"):
            value = expression.at(**{name: self.quantity(name) for name in expression.variables})
        return np.where(self.ran, np.broadcast_to(np.asarray(value, dtype=float), self.ran.shape), np.nan)

    def happened(self, kind: str) -> list[list[float]]:
        """Return when events of a kind came to each member."""
        return [[time for each, time in events if each == kind] for events in self.runs.happened]

    def dataset(self, member: int) -> xarray.Dataset:
        """Return what was sampled of one member, for a function of the user's."""
        import xarray

        count = int(self.last[member]) + 1
        variables = {
            name: (dims, self.runs.arrays[name][member, :count], said) for name, (dims, said) in self.runs.facts.items()
        }
        return xarray.Dataset(variables, coords=labels.coordinates(self.times[:count]))


# --- figures of a formula ---------------------------------------------------------------------------------------


def _at_end(sampled: Sampled, values: Array) -> Array:
    last = sampled.last
    return np.where(last >= 0, values[np.arange(last.size), np.maximum(last, 0)], np.nan)


def _at_start(_: Sampled, values: Array) -> Array:
    return values[:, 0]


def _reduced(reduce: Callable[..., Array], empty: float, _: Sampled, values: Array) -> Array:
    found = reduce(np.where(np.isnan(values), empty, values), axis=1)
    return np.where(np.isnan(values).all(axis=1), np.nan, found)


def _mean(sampled: Sampled, values: Array) -> Array:
    """Return the mean over time: each interval counts by how long it is."""
    steps = np.diff(sampled.times) * ~(np.isnan(values[:, 1:]) | np.isnan(values[:, :-1]))
    halves = np.nan_to_num(values)
    with np.errstate(invalid="ignore"):
        return (steps * (halves[:, 1:] + halves[:, :-1]) / 2).sum(axis=1) / steps.sum(axis=1)


def _first(sampled: Sampled, values: Array) -> Array:
    crossed = np.sign(values[:, 1:]) * np.sign(values[:, :-1]) <= 0
    crossed &= values[:, 1:] != values[:, :-1]
    return _crossings(sampled, values, crossed, np.argmax(crossed, axis=1))


def _crossings(sampled: Sampled, values: Array, crossed: Any, place: Any) -> Array:
    """Return when a formula is 0 between two samples, by the cubic through the four about it."""
    members = np.arange(len(values))
    t = sampled.times
    if t.size < 2:
        return np.full(len(values), np.nan)
    width = min(4, t.size)
    begin = np.clip(np.minimum(place - 1, sampled.last - width + 1), 0, t.size - width)
    nodes = begin[:, None] + np.arange(width)
    own, at = values[members[:, None], nodes], t[nodes]
    low, high = t[place].copy(), t[np.minimum(place + 1, t.size - 1)].copy()
    rises = values[members, np.minimum(place + 1, t.size - 1)] > values[members, place]
    for _ in range(_NEWTON):
        middle = (low + high) / 2
        above = (_lagrange(at, own, middle) > 0) == rises
        high, low = np.where(above, middle, high), np.where(above, low, middle)
    return np.where(crossed.any(axis=1), (low + high) / 2, np.nan)


def _lagrange(at: Array, own: Array, where: Array) -> Array:
    """Return the polynomial through some points of each member, somewhere."""
    total = np.zeros(len(own))
    for i in range(at.shape[1]):
        others = [j for j in range(at.shape[1]) if j != i]
        share = np.prod([(where - at[:, j]) / (at[:, i] - at[:, j]) for j in others], axis=0)
        total = total + own[:, i] * share
    return total


def _changes(_: Sampled, values: Array) -> Array:
    """Return how often a formula changes its sign."""
    signs = np.sign(np.nan_to_num(values))
    for place in range(1, signs.shape[1]):  # at 0 it has the sign that it had
        signs[:, place] = np.where(signs[:, place] == 0, signs[:, place - 1], signs[:, place])
    return (signs[:, 1:] * signs[:, :-1] < 0).sum(axis=1).astype(float)


def _period(sampled: Sampled, values: Array) -> Array:
    """Return the mean time between two passages upwards through the mean."""
    off = values - _mean(sampled, values)[:, None]
    up = (off[:, :-1] < 0) & (off[:, 1:] >= 0)
    count = up.sum(axis=1)
    first = _crossings(sampled, off, up, np.argmax(up, axis=1))
    last = _crossings(sampled, off, up, up.shape[1] - 1 - np.argmax(up[:, ::-1], axis=1))
    return np.where(count >= 2, (last - first) / np.maximum(count - 1, 1), np.nan)


_OF_FORMULA: dict[str, tuple[Callable[[Sampled, Array], Array], str]] = {
    "start": (_at_start, ""),
    "end": (_at_end, ""),
    "max": (partial(_reduced, np.max, -np.inf), ""),
    "min": (partial(_reduced, np.min, np.inf), ""),
    "mean": (_mean, ""),
    "first": (_first, "s"),
    "changes": (_changes, "1"),
    "period": (_period, "s"),
}

# --- figures of events and of the whole -------------------------------------------------------------------------


def _count(sampled: Sampled, kind: str) -> Array:
    return np.array([len(times) for times in sampled.happened(kind)], dtype=float)


def _time(sampled: Sampled, kind: str) -> Array:
    return np.array([times[0] if times else np.nan for times in sampled.happened(kind)])


_OF_EVENT: dict[str, tuple[Callable[[Sampled, str], Array], str]] = {"count": (_count, ""), "time": (_time, "s")}


def _energy_lost(sampled: Sampled) -> Array:
    found = sampled.quantity("energy")
    return _at_start(sampled, found) - _at_end(sampled, found)


def _turned_over(sampled: Sampled) -> Array:
    tilt = sampled.quantity("tilt")
    return np.where(np.cos(_at_start(sampled, tilt)) * np.cos(_at_end(sampled, tilt)) < 0, 1.0, 0.0)


def _ending(sampled: Sampled) -> Array:
    return np.array([1 + ENDS.index(kind) if kind in ENDS else 0 for kind in sampled.runs.ending])


def _lyapunov(sampled: Sampled) -> Array:
    """Return the largest Lyapunov exponent of each member, over the time of the run; none where it ends in rest."""
    from ..chaos import lyapunov_exponents

    found = np.full(len(sampled.systems), np.nan)
    for member, (system, start) in enumerate(zip(sampled.systems, sampled.starts, strict=True)):
        length = float(sampled.times[-1]) - start.time
        with suppress(TrundleError):
            found[member] = lyapunov_exponents(system, start, length, count=1).exponents[0]
    return found


# Name -> (what finds it, unit, what its values stand for where they are classes)
_WHOLE: dict[str, tuple[Callable[[Sampled], Array], str, tuple[str, ...]]] = {
    "energy-lost": (_energy_lost, "J", ()),
    "turned-over": (_turned_over, "", ("no", "yes")),
    "end-time": (lambda sampled: sampled.runs.end, "s", ()),
    "events": (lambda sampled: sampled.runs.events.astype(float), "", ()),
    "lyapunov": (_lyapunov, "s-1", ()),
    "ending": (_ending, "", ("none", *ENDS)),
}


_FUNCTION = "function"
_EXAMPLES = {"end": "hypot(vx, vy)", "max": "hypot(x, y)", "min": "z", "first": "wz", "mean": "energy"}


@dataclass(frozen=True)
class Measure:
    """A figure of each member."""

    name: str  # of its variable in the results
    text: str  # as it was written, such as "max hypot(x, y)"; the name of a function of the user's
    unit: str = ""  # SI
    classes: tuple[str, ...] = ()  # what its values stand for where they are classes: value 0 for the first; -1 is none
    function: Callable[[Any], Any] | None = None  # the user's own, of the dataset of one member

    @staticmethod
    def read(name: str, text: Any, key: str) -> Measure:
        """Read a figure; say what there is where there is no such.

        Examples
        --------
        >>> Measure.read("far", "max hypot(x, y)", "measure.far").unit
        'm'
        """
        if callable(text):
            return Measure(name, f"{_FUNCTION} {getattr(text, '__name__', '')}".strip(), function=text)
        if not isinstance(text, str):
            raise InvalidValueError(key, "must name a figure", text, _there_are(""))
        figure, _, rest = text.strip().partition(" ")
        rest = rest.strip()
        if figure == _FUNCTION:  # as results name one that they cannot hold
            return Measure(name, text)
        if figure in _WHOLE and not rest:
            _, unit, classes = _WHOLE[figure]
            return Measure(name, figure, unit, classes)
        if figure in _OF_EVENT:
            if rest not in KINDS:
                remedy = f"{did_you_mean(rest, KINDS)} Events are: {', '.join(KINDS)}.".strip()
                raise InvalidValueError(key, f"must name an event after `{figure}`", text, remedy)
            return Measure(name, text.strip(), _OF_EVENT[figure][1])
        if figure in _OF_FORMULA:
            if not rest:
                raise InvalidValueError(key, f"must have a formula after `{figure}`", text, _formulas(figure))
            try:
                expression = Expression.parse(rest, tuple(VARIABLES), key)
            except InvalidValueError as error:
                raise InvalidValueError(key, error.rule, rest, error.remedy) from None
            unit = unit_of(expression.tree, VARIABLES, key, rest)
            return Measure(name, text.strip(), _OF_FORMULA[figure][1] or unit)
        raise InvalidValueError(key, "must be one of the figures that exist", text, _there_are(figure))

    @property
    def dtype(self) -> Any:
        """Of its values: small whole numbers for classes."""
        return np.int8 if self.classes else np.float64

    @property
    def missing(self) -> Any:
        """What stands for no value."""
        return np.int8(-1) if self.classes else np.nan

    @property
    def about(self) -> dict[str, Any]:
        """The attributes of its variable."""
        if self.classes:
            flags = {"flag_values": list(range(-1, len(self.classes))), "flag_meanings": " ".join(("-", *self.classes))}
            return {"long_name": self.text, **flags}
        return {"long_name": self.text, "units": self.unit or "1"}

    def of(self, sampled: Sampled) -> Any:
        """Return the figure of each member (members,)."""
        figure, _, rest = self.text.partition(" ")
        if figure == _FUNCTION:
            found = self._by_function(sampled)
        elif figure in _WHOLE:
            found = _WHOLE[figure][0](sampled)
        elif figure in _OF_EVENT:
            found = _OF_EVENT[figure][0](sampled, rest.strip())
        else:
            expression = Expression.parse(rest.strip(), tuple(VARIABLES), self.name)
            found = _OF_FORMULA[figure][0](sampled, sampled.formula(expression))
        ran = sampled.ran.any(axis=1)
        return np.where(ran, found, self.missing).astype(self.dtype)

    def _by_function(self, sampled: Sampled) -> Array:
        if self.function is None:
            raise TrundleError(f"the measure `{self.name}` is a function: give it again, from Python, to go on.")
        found = np.full(len(sampled.systems), np.nan)
        for member in np.flatnonzero(sampled.ran.any(axis=1)):
            value = self.function(sampled.dataset(int(member)))
            try:
                found[member] = float(value)
            except (TypeError, ValueError):
                raise TrundleError(f"the measure `{self.name}` must return a number; it returned {value!r}.") from None
        return found


def read_measures(given: Any) -> list[Measure]:
    """Read what is measured: a text, a list of texts and functions, or a table of them by name.

    Examples
    --------
    >>> [measure.name for measure in read_measures(["turned-over", "max z"])]
    ['turned-over', 'max z']
    """
    if isinstance(given, str) or callable(given):
        given = [given]
    if isinstance(given, Mapping):
        named = {str(name): text for name, text in given.items()}
        where = {name: f"measure.{name}" for name in named}
    elif isinstance(given, (list, tuple)):
        names = [_named(text) for text in given]
        named = dict(zip(names, given, strict=True))
        where = {name: f"measure[{i}]" for i, name in enumerate(names)}
    else:
        named, where = {}, {}
    if not named:
        raise InvalidValueError("measure", "must name what is measured", given, _there_are(""))
    for name in named:
        if name in ("member", "status", "reason", "time") or "/" in name:
            raise InvalidValueError(where[name], "must have another name: this one is taken", name)
    return tell_all(*(partial(Measure.read, name, text, where[name]) for name, text in named.items()))


def _named(text: Any) -> str:
    """Return the name of a figure that was given none: its text, with no slash, which parts folders in a store."""
    return text.strip().replace("/", "÷") if isinstance(text, str) else getattr(text, "__name__", str(text))


def figures() -> list[str]:
    """Return figures to choose from: all that need no formula, and each of the others with a simple one.

    Examples
    --------
    >>> figures()[:2], "time slip" in figures(), "max hypot(x, y)" in figures()
    (['energy-lost', 'turned-over'], True, True)
    """
    of_events = [f"{figure} {kind}" for figure in _OF_EVENT for kind in KINDS]
    return [*_WHOLE, *(f"{figure} {_EXAMPLES.get(figure, 'x')}" for figure in _OF_FORMULA), *of_events]


def _formulas(figure: str) -> str:
    return f"Write for instance '{figure} hypot(x, y)', in {', '.join(VARIABLES)} and {', '.join(FUNCTIONS)}, SI."


def _there_are(received: str) -> str:
    known = [*_WHOLE, *_OF_EVENT, *_OF_FORMULA]
    whole, events, formulas = ", ".join(_WHOLE), " or ".join(_OF_EVENT), ", ".join(_OF_FORMULA)
    return (
        f"{did_you_mean(received, known)} There are: {whole}; {events} and an event, as 'count slip'; "
        f"{formulas} and a formula, as 'max hypot(x, y)'."
    ).strip()
