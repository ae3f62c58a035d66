"""The file of a run: NetCDF with scenario, start, events and card inside, and a digest of each of its parts."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InvalidValueError, RunFileError, TrundleError
from ..files import first_line, read_netcdf
from ..mechanics.system import RollingSystem, State
from ..scenario import ScenarioFile
from ..solve.frames import FRAMES
from ..solve.methods import METHODS, check_tolerance
from ..solve.samples import FLIGHT, Event
from ..verify import Card
from . import labels
from .netcdf import write_dataset

if TYPE_CHECKING:
    import xarray

TEXTS = ("scenario", "start", "events", "card")  # attributes that only the file has
CLAIMS = ("frame", "method", "tolerance")  # attributes of the dataset that a card depends on
DIGESTS = "sha256"
_BLOCK = 2**20  # numbers
_UNIT = 1e-6  # by which the length of a quaternion may be off
_AGAIN = "Save the run again."


@dataclass(frozen=True)
class RunFile:
    """What the file of a run holds.

    Examples
    --------
    >>> import trundle as tr
    >>> path = tr.Scenario.load("level-turntable-nudged").run().save("run.nc")
    >>> read(path).changed
    ()
    """

    name: str  # of the file, without its folder
    data: xarray.Dataset  # checked; its attributes are those of a run in memory
    system: RollingSystem  # what moved
    start: State  # where it started
    events: tuple[Event, ...]  # what happened
    scenario: str  # as TOML text
    card: Card  # as it was saved
    # the parts that are not as they were saved; absent: an older file without digests, so nobody can tell
    changed: tuple[str, ...] | None

    @property
    def intact(self) -> bool:
        """Whether nothing in the file has changed that a card depends on."""
        return self.changed == ()

    @property
    def origin(self) -> str:
        """Where the card of the run comes from, for the reader."""
        if self.changed is None:
            return f"made anew from {self.name}, which has no digests to tell whether it is as it was saved"
        if self.changed:
            return f"made anew from {self.name}, changed since it was saved: {', '.join(self.changed)}"
        return f"of the run as it was saved in {self.name}; the digests hold, nothing has changed since"


def digests(data: xarray.Dataset, system: RollingSystem, texts: Mapping[str, str]) -> dict[str, str]:
    """Return the SHA-256 of each part of a run that its card depends on, and of the card.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("level-turntable-nudged").run()
    >>> digests(run.data, run.system, {"scenario": "a"})["scenario"][:8]  # of the one letter, as sha256sum has it
    'ca978112'
    """
    arrays = {name: data[name].values for name in ("time", *labels.facts(system)) if name in data.variables}
    claims = {name: data.attrs[name] for name in CLAIMS if name in data.attrs}
    return {name: _digest(value) for name, value in {**arrays, **claims, **texts}.items()}


def _digest(value: Any) -> str:
    """Return the SHA-256 of a text or of numbers, which are taken a block at a time: a copy of a long run is large."""
    found = hashlib.sha256()
    if isinstance(value, str):
        found.update(value.encode())
        return found.hexdigest()
    numbers = np.asarray(value)
    kind = numbers.dtype.newbyteorder("<")
    for block in np.array_split(numbers.reshape(-1), numbers.size // _BLOCK + 1):
        if kind.kind == "f":
            block = np.where(np.isnan(block), np.nan, block)  # one NaN for all: files do not keep which it was
        found.update(np.ascontiguousarray(block, dtype=kind).view(np.uint8).data)
    return found.hexdigest()


def write(target: Path, data: xarray.Dataset, texts: Mapping[str, str], system: RollingSystem) -> None:
    """Write the file of a run, whole or not at all.

    Examples
    --------
    See `Trajectory.save`.
    """
    _check_data(data, system, str(target), "Leave the variables of a run as they are, and put yours beside them.")
    extra = {**texts, DIGESTS: json.dumps(digests(data, system, texts))}
    try:
        write_dataset(data.assign_attrs(extra), target)
    except (TypeError, ValueError) as error:  # an attribute or variable that somebody added
        raise TrundleError(
            f"{target} is not written: NetCDF cannot hold all of `run.data` ({first_line(error)})."
        ) from None


def read(path: Any) -> RunFile:
    """Read the file of a run, and check all of it.

    Examples
    --------
    See `RunFile`.
    """
    source, data = str(path), read_netcdf(Path(path))
    texts = {name: _text(data, name, source) for name in TEXTS}
    stored = json_of(_text(data, DIGESTS, source), dict[str, str], DIGESTS, source) if DIGESTS in data.attrs else None
    for name in (*TEXTS, DIGESTS):
        data.attrs.pop(name, None)
    _check_claims(data, source)
    system = ScenarioFile.loads(texts["scenario"], source).system()
    start = json_of(texts["start"], State, "start", source)
    events = json_of(texts["events"], tuple[Event, ...], "events", source)
    card = json_of(texts["card"], Card, "card", source)
    _check_data(data, system, source, _AGAIN)
    _check_start(start, data, system, source)
    _check_events(events, source)
    found = digests(data, system, texts)
    changed = None if stored is None else tuple(name for name in found if stored.get(name) != found[name])
    return RunFile(Path(path).name, data, system, start, events, texts["scenario"], card, changed)


def scenario_in(path: Any) -> str:
    """Return the scenario in a NetCDF file, of a run or of a path that was rolled, whatever else it holds.

    Examples
    --------
    >>> import trundle as tr
    >>> scenario_in(tr.Scenario.load("level-turntable-nudged").run().save("run.nc")).splitlines()[0]
    'title = "Steel ball nudged on a level turntable"'
    """
    text = read_netcdf(Path(path)).attrs.get("scenario", "")
    return text if isinstance(text, str) else ""


def _text(data: xarray.Dataset, name: str, source: str) -> str:
    if name not in data.attrs:
        rolled = "It is a path that was rolled: `trundle run` its scenario." if "distance" in data.dims else ""
        remedy = rolled or "Was it saved by trundle?"
        raise RunFileError(name, "must be among the attributes of a run", "nothing", remedy, source)
    text = data.attrs[name]
    if not isinstance(text, str):
        raise RunFileError(name, "must be text", text, _AGAIN, source)
    return text


def json_of(text: str, kind: Any, name: str, source: str) -> Any:
    """Read an attribute that holds JSON.

    Examples
    --------
    >>> json_of('{"a": "b"}', dict[str, str], "sha256", "run.nc")
    {'a': 'b'}
    """
    from pydantic import TypeAdapter, ValidationError

    try:
        return TypeAdapter(kind).validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        remedy = f"{f'At {place}: ' if place else ''}{first['msg']}."
        raise RunFileError(name, "must be what `save` writes, as JSON", text, remedy, source) from None


def _check_claims(data: xarray.Dataset, source: str) -> None:
    for name, known in (("frame", FRAMES), ("method", tuple(METHODS))):
        value = data.attrs.get(name, "nothing")
        if not isinstance(value, str) or value not in known:
            raise RunFileError(name, f"must be one of {', '.join(known)}", value, _AGAIN, source)
    tolerance = data.attrs.get("tolerance", "nothing")
    if not isinstance(tolerance, (int, float, np.number)):
        raise RunFileError("tolerance", "must be a number", tolerance, _AGAIN, source)
    if data.attrs["method"] == "exact":
        if tolerance != 0:
            raise RunFileError("tolerance", "must be 0 for a closed form", tolerance, _AGAIN, source)
        return
    try:
        check_tolerance(float(tolerance))
    except InvalidValueError as error:
        raise RunFileError("tolerance", error.rule, tolerance, _AGAIN, source) from None


def _check_data(data: xarray.Dataset, system: RollingSystem, source: str, remedy: str) -> None:
    """Check names, dimensions, units, types and values of what a run's dataset must have."""

    def check(name: str, holds: Any, rule: str, received: object) -> None:
        if not holds:
            raise RunFileError(name, rule, received, remedy, source)

    labelled = labels.coordinates(np.zeros(0))
    times, _, about = labelled.pop("time")
    for name, (dims, said) in {"time": (times, about), **labels.facts(system)}.items():
        check(name, name in data.variables, "must be among the variables of a run", "nothing")
        found = data[name]
        check(name, found.dims == dims, f"must have the dimensions {', '.join(dims)}", found.dims)
        dtype = np.asarray(said.get("flag_values", 0.0)).dtype
        check(name, found.dtype.newbyteorder("=") == dtype, f"must hold numbers of type {dtype}", str(found.dtype))
        wanted, units = said["units"], found.attrs.get("units", "nothing")
        check(name, isinstance(units, str) and units == wanted, f"must have the units {wanted!r}", units)
    for name, parts in labelled.items():
        there = data[name].values.tolist() if name in data.coords else "nothing"
        check(name, there == list(parts), f"must have the labels {', '.join(parts)}", there)
    _check_numbers({name: data[name].values for name in ("time", *labels.facts(system))}, check)


def _check_numbers(arrays: dict[str, Any], check: Callable[[str, Any, str, object], None]) -> None:
    """Check what no run's numbers can be."""
    time, phase = arrays["time"], arrays["phase"]
    check("time", time.size > 0, "must have samples", "none")
    known = ", ".join(f"{number} ({name})" for number, name in labels.PHASES.items())
    strange = phase[~np.isin(phase, list(labels.PHASES))]
    check("phase", strange.size == 0, f"must be one of {known}", strange[:1].tolist())
    for name, values in arrays.items():
        there = np.isfinite(values)
        if name == "slip_velocity":  # in flight nothing slips
            there = there | (phase == FLIGHT)[:, None]
        check(name, there.all(), "must be finite", values[~there][:1].tolist())
    steps = np.diff(time, append=time[-1:])
    falls = int(steps.argmin())
    check("time", steps[falls] >= 0, "must ascend", f"{time[(falls + 1) % time.size]:g} s after {time[falls]:g} s")
    with np.errstate(over="ignore"):
        length = np.linalg.norm(arrays["orientation"], axis=1)
    worst = float(length[np.abs(length - 1).argmax()])
    check("orientation", abs(worst - 1) <= _UNIT, "must hold quaternions of length 1", worst)


def _check_start(start: State, data: xarray.Dataset, system: RollingSystem, source: str) -> None:
    """Check the state that the run is said to have started from."""
    numbers = [*start.position, *start.velocity, *start.angular_velocity, *start.orientation, *start.support]
    coordinates, first = system.support.motion.coordinates, float(data.time.values[0])
    for holds, rule, received in (
        (np.isfinite([*numbers, start.time]).all(), "must hold finite numbers", numbers),
        (abs(np.linalg.norm(start.orientation) - 1) <= _UNIT, "must hold a quaternion of length 1", start.orientation),
        (
            len(start.support) == len(coordinates),
            f"must hold {', '.join(coordinates) or 'nothing'} of the support",
            start.support,
        ),
        (start.time <= first, f"must not be after the first sample, {first:g} s", start.time),
    ):
        if not holds:
            raise RunFileError("start", rule, received, _AGAIN, source)


def _check_events(events: tuple[Event, ...], source: str) -> None:
    times = [event.time for event in events]
    if not np.isfinite(times).all() or times != sorted(times):
        raise RunFileError("events", "must ascend in time", times, _AGAIN, source)
