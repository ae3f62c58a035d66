"""Results on the disk as they come: a Zarr store, a chunk of members whole or not at all."""

from __future__ import annotations

import os
import shutil
import tomllib
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError, TrundleError
from ...extras import need
from ...files import first_line, hold, written_whole
from ...simulation import labels
from ...simulation.simulate import Scenario
from ...solve.methods import Method
from .job import Columns
from .measures import OUTCOMES
from .plan import Plan, read_plan

if TYPE_CHECKING:
    import xarray

FORMAT = 1
_ROOM = 1.1  # times what the results take, before they are compressed


@dataclass(frozen=True)
class Store:
    """A folder with the results of a sweep, finished or not.

    The variable `status` of a chunk is written last, and by renaming: where it is there, the whole chunk is.
    """

    path: Path  # the folder

    # --- making and opening -----------------------------------------------------------------------------------------

    @staticmethod
    def create(path: Path, plan: Plan) -> Store:
        """Make a store in which no member is done."""
        need("sweep", "a store of a sweep")
        check_new(path)
        check_room(path, plan)
        with written_whole(path) as temporary:
            _make(temporary, plan)
        return Store(path)

    @staticmethod
    def open(path: Path) -> Store:
        """Return a store that is there; refuse what is none."""
        need("sweep", "a store of a sweep")
        store = Store(path)
        if not (path / "zarr.json").is_file():
            what = "It is a folder." if path.is_dir() else "It is a file." if path.exists() else "It is not there."
            raise InvalidValueError("store", "must be a store that a sweep wrote", str(path), what)
        if store.attributes.get("trundle_sweep") != FORMAT:
            remedy = "It is a Zarr store of something else, or of another version of trundle."
            raise InvalidValueError("store", "must be a store that a sweep wrote", str(path), remedy)
        return store

    @cached_property
    def _group(self) -> Any:
        import zarr

        try:
            return zarr.open_group(str(self.path), mode="r+", use_consolidated=False)
        except Exception as error:  # noqa: BLE001  a damaged store makes several libraries raise
            remedy = f"It is damaged ({first_line(error)})."
            raise InvalidValueError("store", "must be a store that a sweep wrote", str(self.path), remedy) from None

    @property
    def attributes(self) -> dict[str, Any]:
        """What the store says of itself."""
        return dict(self._group.attrs)

    def plan(self) -> Plan:
        """Return the sweep that the store holds the results of."""
        return plan_of(self.attributes, self._listed)

    def _listed(self, key: str) -> list[Any]:
        return as_listed(self.values(key), dict(self._array(key).attrs))

    # --- writing ----------------------------------------------------------------------------------------------------

    def write(self, where: slice | NDArray[np.int64], columns: Columns) -> None:
        """Write some members, what says that they are done last: a slice of whole chunks, or places in their order."""
        try:
            for name in sorted(columns, key=lambda one: one == "status"):
                values = columns[name]
                text = values.astype(np.dtypes.StringDType()) if name == "reason" else values
                self._array(name)[where, *(slice(None),) * (text.ndim - 1)] = text
        except OSError as error:
            raise NoRoomError(
                f"{self.path} cannot be written: {first_line(error)}. Make room, then go on with "
                f"`trundle sweep --resume {self.path}`: what is finished is kept."
            ) from None

    def _array(self, name: str) -> Any:
        if name not in self._arrays:
            self._arrays[name] = self._group[name]
        return self._arrays[name]

    @cached_property
    def _arrays(self) -> dict[str, Any]:
        return {}

    @cached_property
    def _chunk(self) -> int:
        return int(self.attributes["chunk"])

    @contextmanager
    def held(self) -> Iterator[None]:
        """Keep others from writing to it meanwhile, and clear what a killed process left half written."""
        lock = hold(self.path)
        if lock is None:
            remedy = "Wait until it ends, or stop it."
            raise InvalidValueError("store", "must not be written to by two at once", str(self.path), remedy)
        try:
            for left in self.path.rglob("*.partial"):
                left.unlink(missing_ok=True)
            yield
        finally:
            os.close(lock)

    # --- reading ----------------------------------------------------------------------------------------------------

    @property
    def status(self) -> NDArray[np.int8]:
        """What became of each member."""
        return self._group["status"][:]

    @property
    def done(self) -> NDArray[np.bool_]:
        """Which chunks are done."""
        return self.status[:: self._chunk] > 0

    def values(self, key: str) -> NDArray[np.float64]:
        """Return what a number was for each member."""
        return self._array(key)[:].astype(float)

    def counts(self) -> dict[str, int]:
        """Return how many members are waiting, done, refused, failed."""
        found = np.bincount(self.status, minlength=len(OUTCOMES))
        return dict(zip(OUTCOMES, found.tolist(), strict=True))

    def dataset(self) -> xarray.Dataset:
        """Return the results, read as they are used."""
        import xarray

        return xarray.open_dataset(self.path, engine="zarr", consolidated=False, chunks=None, decode_times=False)

    def check_same(self, plan: Plan) -> None:
        """Refuse a store with the results of another sweep, or of another version."""
        said, wanted = self.attributes, described(plan)
        for key in ("scenario", "over", "measured", "design", "seed", "chunk", "source"):
            if said[key] != wanted[key]:
                rule = f"must hold results of the same sweep, and has another `{key}`"
                raise InvalidValueError("store", rule, str(self.path), "Name another store.")
        columns = zip(plan.axes, plan.table.T, strict=True)
        if not all(np.array_equal(self.values(axis.key), column) for axis, column in columns):
            raise InvalidValueError(
                "store", "must hold results of the same members", str(self.path), "Name another store."
            )

    def take(self, other: Store) -> int:
        """Copy the chunks that another store of the same sweep has and this one has not; return how many."""
        mine = self.attributes
        missing = np.flatnonzero(other.done & ~self.done).tolist()
        names = [name for name in self._group if name not in mine["over"] and name not in _LABELS]
        for chunk in missing:
            for name in sorted(names, key=lambda one: one == "status"):
                self._copy(other, name, chunk)
        return len(missing)

    def _copy(self, other: Store, name: str, chunk: int) -> None:
        array = self._array(name)
        place = Path(name, "c", str(chunk), *["0"] * (array.ndim - 1))
        if (other.path / place).is_file():  # a chunk of nothing but what stands for no value has no file
            target = self.path / place
            target.parent.mkdir(parents=True, exist_ok=True)
            temporary = target.with_name(f"{target.name}.partial")
            shutil.copyfile(other.path / place, temporary)
            temporary.replace(target)


class NoRoomError(TrundleError):
    """The disk has no room for what has to be written."""


_LABELS = ("time", "axis", "quaternion")


def check_new(path: Path) -> None:
    """Refuse to write over what is there.

    Examples
    --------
    >>> check_new(Path("results.zarr"))
    """
    if path.exists():
        remedy = f"Go on with `trundle sweep --resume {path}`, or name another."
        raise InvalidValueError("store", "must not exist yet", str(path), remedy)
    if not path.absolute().parent.is_dir():
        raise InvalidValueError("store", "must be in a folder that exists", str(path), "Make it first.")


def check_room(path: Path, plan: Plan) -> None:
    """Refuse what the disk has no room for."""
    free = shutil.disk_usage(path.absolute().parent).free
    if plan.bytes * _ROOM > free:
        rule = f"must leave results that fit the disk, which has {in_bytes(free)} left"
        remedy = "Keep fewer samples (`keep`), or name fewer members."
        raise InvalidValueError("keep" if plan.keep else "over", rule, in_bytes(plan.bytes), remedy)


def in_bytes(count: float) -> str:
    """Return a number of bytes in words.

    Examples
    --------
    >>> in_bytes(12_300_000), in_bytes(40)
    ('12 MB', '40 bytes')
    """
    for size, unit in ((1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")):
        if count >= size:
            return f"{count / size:.2g} {unit}" if count < 10 * size else f"{count / size:.0f} {unit}"
    return f"{count:.0f} bytes"


def as_listed(values: NDArray[Any], about: dict[str, Any]) -> list[Any]:
    """Return the values of what varied as a sweep's file lists them: numbers, or the texts that they stand for."""
    words = about["flag_meanings"].split() if "flag_meanings" in about else []
    return [words[int(value)] for value in values] if words else values.tolist()


def plan_of(attributes: dict[str, Any], listed: Callable[[str], list[Any]]) -> Plan:
    """Return the sweep that some results are of, from what they say of themselves and the values of what varied."""
    tables = tomllib.loads(attributes["sweep"])
    document = Scenario.loads(attributes["scenario"], "scenario")
    if "table" in tables:
        tables["table"] = {key: listed(key) for key in attributes["over"]}
    tables = {key: value for key, value in tables.items() if key != "run"}  # the scenario has it
    plan = read_plan(tables | {"chunk": attributes["chunk"]}, document=document)
    return replace(plan, title=attributes["title"], text=attributes["sweep"])


def described(plan: Plan) -> dict[str, Any]:
    """Return what the results of a sweep say of themselves."""
    said = labels.attributes(plan.title, Method.of("taylor"))
    return {
        "Conventions": said["Conventions"],
        "title": plan.title,
        "notes": plan.notes,
        "source": said["source"],
        "trundle_sweep": FORMAT,
        "over": [axis.key for axis in plan.axes],
        "measured": [one.name for one in plan.measures],
        "design": plan.design.name,
        "seed": plan.design.seed,
        "grid": list(plan.grid or ()),
        "chunk": plan.chunk,
        "scenario": plan.document.to_toml(),
        "sweep": plan.text,
    }


def variables(plan: Plan) -> dict[str, tuple[tuple[str, ...], dict[str, Any]]]:
    """Return dimensions and attributes of each variable of the results.

    Examples
    --------
    >>> plan = read_plan({"scenario": "tilted-turntable", "over": {"gravity": [9.8, 9.9]}, "measure": "max z"})
    >>> list(variables(plan))
    ['max z', 'status', 'reason']
    """
    status = {"long_name": "what became of the member", "flag_values": list(range(len(OUTCOMES)))}
    own: dict[str, Any] = {one.name: (("member",), one.about) for one in plan.measures}
    own["status"] = (("member",), {**status, "flag_meanings": " ".join(OUTCOMES)})
    own["reason"] = (("member",), {"long_name": "why it was refused or failed, or what ended it early"})
    if plan.keep:
        own |= {name: (("member", *dims), _as_json(said)) for name, (dims, said) in plan.job.facts.items()}
    return own


def _as_json(said: dict[str, Any]) -> dict[str, Any]:
    return {key: value.tolist() if hasattr(value, "tolist") else value for key, value in said.items()}


def _make(folder: Path, plan: Plan) -> None:
    """Write what is known before anything runs: coordinates, attributes, and arrays of nothing."""
    import zarr

    attributes = described(plan)
    names = [axis.key for axis in plan.axes]
    attributes["coordinates"] = " ".join(name.replace(" ", "_") for name in names)
    group = zarr.create_group(str(folder), attributes=attributes)
    size = plan.members

    def array(name: str, shape: Any, chunks: Any, dtype: Any, fill: Any, dims: Any, said: Any) -> Any:
        return group.create_array(
            name, shape=shape, chunks=chunks, dtype=dtype, fill_value=fill, dimension_names=dims, attributes=said
        )

    for axis, column in zip(plan.axes, plan.table.T, strict=True):
        whole = min(size, 2**20)
        kind: Any = np.int8 if axis.words else np.float64
        array(axis.key, (size,), (whole,), kind, 0, ("member",), axis.about)[:] = column.astype(kind)
    if plan.keep:
        times = plan.job.times
        said = {"long_name": "time", "units": "s"}
        array("time", times.shape, times.shape, np.float64, 0, ("time",), said)[:] = times
        for name, parts in (("axis", ["x", "y", "z"]), ("quaternion", ["w", "x", "y", "z"])):
            array(name, (len(parts),), (len(parts),), str, "", (name,), {})[:] = np.array(
                parts, dtype=np.dtypes.StringDType()
            )
    empty = plan.job.empty(1)
    for name, (dims, said) in variables(plan).items():
        column = empty[name]
        text = column.dtype == object
        shape = (size, *column.shape[1:])
        chunks = (min(plan.chunk, size), *column.shape[1:])
        array(name, shape, chunks, str if text else column.dtype, "" if text else column.flat[0], dims, said)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # Zarr's third version has no word yet for where all of this is said at once
        zarr.consolidate_metadata(str(folder))
