"""What varies in a sweep: the numbers of a scenario by name, the values that each takes, and how these combine."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError, did_you_mean
from ...scenario import ScenarioFile
from ...scenario.together import each_checked, tell_all
from ...units import UNITS, plus_minus, sharing_unit, to_si
from ..sensitivities.keys import leaves

Array = NDArray[np.float64]

DESIGNS = ("grid", "boundary", "together", "random", "latin-hypercube", "sobol", "variance")
DRAWN = DESIGNS[3:]  # these draw from distributions, and need a number of members
MOST_MEMBERS = 10_000_000
SHAPES = (
    'Write a list, { from = 1, to = 2, count = 11 }, the same with scale = "log", { uniform = [1, 2] }, '
    '{ normal = [1.5, 0.1] } or "1.5 ± 0.1" with a unit.'
)
_KIND_OF = {unit: kind for kind, (unit, _) in UNITS.items()}


@dataclass(frozen=True)
class Axis:
    """One number of a scenario, and the values that it takes."""

    key: str  # its name, such as "start.velocity[0]"
    unit: str  # its SI unit; empty where it has none
    values: Array | None  # as listed or spaced; None where it is drawn from a distribution without limits of its own
    quantile: Callable[[Array], Array] = field(compare=False)  # from shares (0, 1) to values, for the designs that draw
    words: tuple[str, ...] = ()  # what the values stand for where they are texts: the value is the place of the text

    @property
    def extremes(self) -> list[Any]:
        """The values to try before anything runs: the least and the largest, or all texts."""
        if self.words:
            return list(self.words)
        some = self.quantile(np.array([1e-3, 1 - 1e-3])) if self.values is None else self.values
        return sorted({float(np.min(some)), float(np.max(some))})

    @property
    def about(self) -> dict[str, Any]:
        """The attributes of its coordinate."""
        if self.words:
            flags = {"flag_values": list(range(len(self.words))), "flag_meanings": " ".join(self.words)}
            return {"long_name": self.key, **flags}
        return {"long_name": self.key, "units": self.unit or "1"}


def read_axes(over: Any, scenario: ScenarioFile) -> list[Axis]:
    """Read what varies; tell of all that is wrong with it.

    Examples
    --------
    >>> import trundle as tr
    >>> scenario = tr.Scenario.load("tilted-turntable")
    >>> axes = read_axes({"support": {"tilt": {"from": "0 deg", "to": "3 deg", "count": 4}}}, scenario)
    >>> axes[0].key, axes[0].values.round(4).tolist()
    ('support.tilt', [0.0, 0.0175, 0.0349, 0.0524])
    """
    if not isinstance(over, Mapping) or not over:
        rule = "must be a table of what varies"
        raise InvalidValueError("over", rule, over, 'Write for instance: "support.tilt" = ["1 deg", "2 deg"].')
    given = dict(_flat(over))
    return tell_all(*(partial(_axis, key, spec, scenario) for key, spec in given.items()))


def _flat(over: Mapping[str, Any], before: str = "") -> list[tuple[str, Any]]:
    """Return what varies by its whole key: TOML makes tables of a key that has dots and no quotes."""
    found: list[tuple[str, Any]] = []
    for key, spec in over.items():
        whole = f"{before}{key}"
        inner = isinstance(spec, Mapping) and not set(spec) & {"from", "to", "count", "scale", "normal", "uniform"}
        found += _flat(spec, f"{whole}.") if inner and spec else [(whole, spec)]
    return found


def numbers_of(scenario: ScenarioFile) -> dict[str, tuple[Any, str]]:
    """Return the value and the SI unit of every number, word and absent number of a scenario, by its name.

    Examples
    --------
    >>> import trundle as tr
    >>> numbers_of(tr.Scenario.load("tilted-turntable"))["body.radius"]
    (0.025, 'm')
    """
    kinds = {
        f"{key}[{i}]": kind for key, each in scenario._kinds_of_components().items() for i, kind in enumerate(each)
    }
    found = {name: (value, unit) for name, value, unit in leaves(scenario)}
    return {name: (value, UNITS[kinds[name]][0] if name in kinds else unit) for name, (value, unit) in found.items()}


def _axis(key: str, spec: Any, scenario: ScenarioFile) -> Axis:
    where, known = f"over.{key}", numbers_of(scenario)
    if key not in known:
        absent = key.partition("[")[0]
        if absent != key and absent in known and known[absent][0] is None:
            rule, remedy = "must be a number that the scenario gives", f"Write `{absent}` into the scenario first."
        else:
            rule = "must be a number of the scenario"
            names = [name for name in known if not name.startswith("start.time")]
            remedy = f"{did_you_mean(key, names)} There are: {', '.join(names)}.".strip()
        raise InvalidValueError(where, rule, key, remedy)
    value, unit = known[key]
    if isinstance(value, str):
        return _texts(key, spec, where)
    return _numeric(key, spec, where, unit)


def _texts(key: str, spec: Any, where: str) -> Axis:
    if not isinstance(spec, (list, tuple)) or not spec or not all(isinstance(word, str) for word in spec):
        raise InvalidValueError(where, "must be a list of texts", spec, "The scenario has a text there.")
    places = np.arange(len(spec), dtype=float)
    return Axis(key, "", places, partial(_pick, places), tuple(spec))


def _numeric(key: str, spec: Any, where: str, unit: str) -> Axis:
    convert = partial(_si, kind=_KIND_OF[unit])
    if isinstance(spec, str) and plus_minus(spec) is not None:
        middle, half = _about(spec, convert, where)
        return _uniform(key, unit, middle - half, middle + half, where)
    if isinstance(spec, Mapping):
        return _spaced(key, spec, where, unit, convert)
    if hasattr(spec, "tolist"):
        spec = spec.tolist()
    if not isinstance(spec, (list, tuple, range)) or not spec:
        raise InvalidValueError(where, "must say which values it takes", spec, SHAPES)
    values = np.array(each_checked(convert, spec, where))
    return Axis(key, unit, values, partial(_pick, values))


def _sharing(values: list[Any]) -> list[Any]:
    """Return texts with the unit that stands once; numbers are SI."""
    return sharing_unit(values) if all(isinstance(value, str) for value in values) else values


def _si(value: Any, key: str, kind: str) -> float:
    if isinstance(value, np.generic):
        value = value.item()
    return float(to_si(value, kind, key))


def _about(text: str, convert: Any, where: str) -> tuple[float, float]:
    """Return the two numbers of "33.3 ± 0.3 rpm"."""
    parts = plus_minus(text)
    if parts is None:
        raise InvalidValueError(where, "must be a value with its limit", text, "Write for instance '33.3 ± 0.3 rpm'.")
    try:
        middle, half = (float(convert(part, where)) for part in parts)
    except InvalidValueError as error:
        raise InvalidValueError(where, error.rule, text, error.remedy) from None
    if not half > 0:
        raise InvalidValueError(where, "must have something above 0 after ±", text, "Leave out what is known exactly.")
    return middle, half


def _spaced(key: str, spec: Mapping[str, Any], where: str, unit: str, convert: Any) -> Axis:
    if set(spec) == {"normal"} and isinstance(spec["normal"], str):
        return _normal(key, unit, *_about(spec["normal"], convert, where), where)
    for name in ("uniform", "normal"):
        if name in spec:
            if set(spec) != {name} or not isinstance(spec[name], (list, tuple)) or len(spec[name]) != 2:
                example = "{ uniform = [1, 2] }" if name == "uniform" else "{ normal = [1.5, 0.1] }"
                raise InvalidValueError(where, f"must give two numbers to `{name}`", spec, f"Write {example}.")
            first, second = each_checked(convert, _sharing(list(spec[name])), f"{where}.{name}")
            return (
                _uniform(key, unit, first, second, where)
                if name == "uniform"
                else _normal(key, unit, first, second, where)
            )
    unknown = [name for name in spec if name not in ("from", "to", "count", "scale")]
    if unknown:
        raise InvalidValueError(f"{where}.{unknown[0]}", "is no key here", spec[unknown[0]], SHAPES)
    for name in ("from", "to"):
        if name not in spec:
            raise InvalidValueError(f"{where}.{name}", "must be given", None, SHAPES)
    ends = _sharing([spec["from"], spec["to"]])
    low, high = tell_all(
        *(partial(convert, end, f"{where}.{name}") for name, end in zip(("from", "to"), ends, strict=True))
    )
    return _between(key, unit, low, high, spec.get("count"), spec.get("scale", "linear"), where)


def _between(key: str, unit: str, low: float, high: float, count: Any, scale: Any, where: str) -> Axis:
    if scale not in ("linear", "log"):
        raise InvalidValueError(f"{where}.scale", 'must be "linear" or "log"', scale)
    if scale == "log" and not low * high > 0:
        rule = "must not reach or cross 0 on a logarithmic scale"
        raise InvalidValueError(f"{where}.from", rule, low, "Both ends have one sign, and neither is 0.")
    if count is not None and (isinstance(count, bool) or not isinstance(count, int) or count < 1):
        raise InvalidValueError(f"{where}.count", "must be a whole number, 1 or more", count)
    values = None
    if count is not None:
        values = np.geomspace(low, high, count) if scale == "log" else np.linspace(low, high, count)
    return Axis(key, unit, values, partial(_along, low, high, scale == "log"))


def _uniform(key: str, unit: str, low: float, high: float, where: str) -> Axis:
    if not low < high:
        raise InvalidValueError(f"{where}.uniform", "must have its lower limit first", [low, high])
    return Axis(key, unit, None, partial(_along, low, high, False))


def _normal(key: str, unit: str, mean: float, deviation: float, where: str) -> Axis:
    if not deviation > 0:
        rule = "must have a positive standard deviation as its second number"
        raise InvalidValueError(f"{where}.normal", rule, deviation)
    return Axis(key, unit, None, partial(_normally, mean, deviation))


def _pick(values: Array, u: Array) -> Array:
    return values[np.minimum((u * values.size).astype(int), values.size - 1)]


def _along(low: float, high: float, log: bool, u: Array) -> Array:
    return np.exp(np.log(abs(low)) * (1 - u) + np.log(abs(high)) * u) * np.sign(low) if log else low + (high - low) * u


def _normally(mean: float, deviation: float, u: Array) -> Array:
    from scipy.special import ndtri

    return mean + deviation * ndtri(u)


def check_values(axis: Axis, scenario: ScenarioFile) -> None:
    """Refuse an axis whose ends no scenario may have, by what the format says of them.

    Where a value alone is in order and only does not go with another, its members are rows that say so.
    """
    from ...errors import ScenarioError

    for value in axis.extremes:
        try:
            type(scenario).read(Varied(scenario, (axis,)).tables((value,)), "")
        except ScenarioError as error:
            told = [one for one in (error, *error.others) if one.key == axis.key]
            if told:
                raise InvalidValueError(f"over.{axis.key}", told[0].rule, value, told[0].remedy) from None


@dataclass(frozen=True)
class Varied:
    """A scenario as nested tables with other values for some keys.

    Examples
    --------
    >>> import trundle as tr
    >>> scenario = tr.Scenario.load("tilted-turntable")
    >>> Varied(scenario, tuple(read_axes({"support.tilt": [0.1]}, scenario))).tables((0.1,))["support"]["tilt"]
    0.1
    """

    scenario: ScenarioFile
    axes: tuple[Axis, ...]

    def tables(self, values: Sequence[Any]) -> dict[str, Any]:
        """Return the tables with a value for each axis; the place of a text, or the text."""
        tables = self.scenario.model_dump(exclude_unset=True, by_alias=True)
        for axis, value in zip(self.axes, values, strict=True):
            word = axis.words[int(value)] if axis.words and not isinstance(value, str) else value
            self._put(tables, axis.key, word if isinstance(word, str) else float(word))
        return tables

    def _put(self, tables: dict[str, Any], key: str, value: Any) -> None:
        parts = [part if part else int(index) for part, index in re.findall(r"([^.\[\]]+)(?![^\[]*\])|\[(\d+)\]", key)]
        place: Any = tables
        for i, part in enumerate(parts[:-1]):
            if isinstance(part, str) and isinstance(parts[i + 1], int) and part in place:
                place[part] = list(place[part])
            elif isinstance(part, str) and part not in place:
                place[part] = self._default(parts[: i + 1]) if isinstance(parts[i + 1], int) else {}
            place = place[part]
        place[parts[-1]] = value

    def _default(self, parts: Sequence[Any]) -> list[Any]:
        """Return the components of a list that the file leaves to the format."""
        model: Any = self.scenario
        for part in parts:
            model = model[part] if isinstance(part, int) else getattr(model, part)
        return list(model)


@dataclass(frozen=True)
class Design:
    """How the values combine."""

    # "grid": each with each. "boundary": a grid of two, run near the boundary between classes only. "together": the
    # first of each, then the second. "random", "latin-hypercube", "sobol": drawn. "variance": the sets of draws that
    # shares of the variance need.
    name: str = "grid"
    members: int | None = None  # how many are drawn; for "variance" in each set
    seed: int = 0  # of the draws

    def table(self, axes: Sequence[Axis]) -> Array:
        """Return the values of each member (members, axes).

        Examples
        --------
        >>> import trundle as tr
        >>> axes = read_axes({"gravity": [1, 2], "body.mass": [3, 4]}, tr.Scenario.load("tilted-turntable"))
        >>> Design().table(axes).tolist()
        [[1.0, 3.0], [1.0, 4.0], [2.0, 3.0], [2.0, 4.0]]
        """
        if self.name in DRAWN:
            drawn = self._drawn(len(axes))
            return np.column_stack([axis.quantile(column) for axis, column in zip(axes, drawn.T, strict=True)])
        columns = [axis.values for axis in axes]
        given = [column for column in columns if column is not None]
        if self.name == "together":
            return np.column_stack(given)
        return np.stack([mesh.ravel() for mesh in np.meshgrid(*given, indexing="ij")], axis=1)

    def size(self, axes: Sequence[Axis]) -> int:
        """Return how many members there are."""
        if self.name == "variance":
            return (self.members or 0) * (len(axes) + 2)
        if self.name in DRAWN:
            return self.members or 0
        sizes = [0 if axis.values is None else axis.values.size for axis in axes]
        return sizes[0] if self.name == "together" else int(np.prod(sizes, dtype=float))

    def check(self, axes: Sequence[Axis]) -> None:
        """Refuse what does not go together."""
        if self.name not in DESIGNS:
            remedy = f"{did_you_mean(self.name, DESIGNS)} There are: {', '.join(DESIGNS)}.".strip()
            raise InvalidValueError("design", "must be one of those that exist", self.name, remedy)
        drawn = self.name in DRAWN
        whole = isinstance(self.members, int) and not isinstance(self.members, bool)
        if drawn and not (whole and (self.members or 0) >= 1):
            rule = f'must be a whole number, 1 or more, for the design "{self.name}"'
            raise InvalidValueError("members", rule, self.members)
        if not drawn and self.members is not None:
            rule, remedy = "must not be given here", f'The design "{self.name}" says how many there are.'
            raise InvalidValueError("members", rule, self.members, remedy)
        if self.name in ("sobol", "variance") and (self.members or 0) & ((self.members or 0) - 1):
            near = 2 ** round(np.log2(self.members or 1))
            raise InvalidValueError("members", "must be a power of 2 for Sobol's points", self.members, f"Take {near}.")
        if isinstance(self.seed, bool) or not isinstance(self.seed, int) or self.seed < 0:
            raise InvalidValueError("seed", "must be a whole number, 0 or more", self.seed)
        if not drawn:
            self._check_listed(axes)
        if self.size(axes) > MOST_MEMBERS:
            raise InvalidValueError("members", f"must be at most {MOST_MEMBERS:,}", self.size(axes), "Take fewer.")

    def _check_listed(self, axes: Sequence[Axis]) -> None:
        for axis in axes:
            if axis.values is None:
                rule = f'must say how many values it takes where the design is "{self.name}"'
                remedy = 'Give a list or a `count`; or draw: design = "sobol" with `members`.'
                raise InvalidValueError(f"over.{axis.key}", rule, "a distribution or a range without `count`", remedy)
            if self.name == "boundary" and (len(axes) != 2 or axis.values.size < 2):
                rule = 'must be two numbers, each with 2 values or more, where the design is "boundary"'
                raise InvalidValueError("over", rule, [one.key for one in axes], 'Or take design = "grid".')
            if self.name == "together" and axes[0].values is not None and axis.values.size != axes[0].values.size:
                rule = f"must take as many values as `{axes[0].key}`, {axes[0].values.size}"
                raise InvalidValueError(
                    f"over.{axis.key}", rule, axis.values.size, 'Or let them combine: design = "grid".'
                )

    def _drawn(self, count: int) -> Array:
        """Return shares in (0, 1) of the members (members, count)."""
        from scipy.stats import qmc

        members = self.members or 1
        if self.name == "variance":
            both = qmc.Sobol(2 * count, rng=self.seed).random(members)
            one, other = both[:, :count], both[:, count:]
            mixed = [np.where(np.arange(count) == i, other, one) for i in range(count)]
            shares = np.vstack([one, other, *mixed])
        elif self.name == "sobol":
            shares = qmc.Sobol(count, rng=self.seed).random(members)
        elif self.name == "latin-hypercube":
            shares = qmc.LatinHypercube(count, rng=self.seed).random(members)
        else:
            shares = np.random.default_rng(self.seed).random((members, count))
        return np.clip(shares, 2.0**-53, 1 - 2.0**-53)


def grid_shape(design: Design, axes: Sequence[Axis]) -> tuple[int, ...] | None:
    """Return how many values each axis of a grid takes; None where the members are no grid."""
    if design.name not in ("grid", "boundary"):
        return None
    return tuple(axis.values.size for axis in axes if axis.values is not None)


__all__ = ["Axis", "Design", "Varied", "check_values", "grid_shape", "read_axes"]
