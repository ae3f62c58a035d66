"""A trajectory: labelled arrays, where they came from, and what may be said of them."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import frames, labels
from .errors import InvalidValueError, TrundleError, UnknownNameError
from .netcdf import write_dataset
from .mechanics.system import RollingSystem, State
from .memory import check_room
from .scenario import ScenarioFile
from .solve.exact import ClosedForm, closed_form
from .solve.methods import Method
from .solve.samples import Event, Samples
from .viewer.viewable import Viewable

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from .verify import Card


@dataclass(frozen=True, repr=False)
class Trajectory(Viewable):
    """The motion of one body: a dataset over time, with the system and the start that gave it.

    Parameters
    ----------
    data : xarray.Dataset
        `position`, `contact`, `velocity`, `angular_velocity`, `orientation`, `contact_force`, `slip_velocity` and
        `phase` over `time`, SI units in the attributes.
    system : RollingSystem
        What moved.
    start : State
        Where it started.
    method : str
        "exact", "taylor" or "runge-kutta".
    events : tuple of Event
        What happened on the way.
    scenario : str
        The scenario as TOML text.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.49))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.025, mass=0.065), table)
    >>> run = tr.simulate(system, system.place((0.1, 0.0), (0.0, 0.2)), duration=2.0, every=0.5)
    >>> run.data.position.shape
    (5, 3)
    """

    data: xarray.Dataset
    system: RollingSystem
    start: State
    method: str
    events: tuple[Event, ...] = ()
    scenario: str = ""
    _kept: dict[str, Any] = field(default_factory=dict, compare=False)  # card and closed form, once asked for

    def __repr__(self) -> str:
        t = self.data.time.values
        ending = f", {self.events[-1].text}" if self.events else ""
        return f"<Trajectory: {t.size} samples over {t[-1] - t[0]:g} s, {self.method}, {self.frame} frame{ending}>"

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        raise UnknownNameError("attribute of a Trajectory", name, _public_names())

    @property
    def frame(self) -> str:
        """The frame of the vectors: "support", "world" or "corotating"."""
        return str(self.data.attrs["frame"])

    @property
    def title(self) -> str:
        """The scenario's title."""
        return str(self.data.attrs.get("title", ""))

    @property
    def tolerance(self) -> float:
        """The tolerance of the method; 0 for a closed form."""
        return float(self.data.attrs["tolerance"])

    @property
    def closed_form(self) -> ClosedForm | None:
        """The closed form of the phase in which it starts; None where there is none."""
        if "form" not in self._kept:
            self._kept["form"] = closed_form(self.system, self.start)
        return self._kept["form"]

    @property
    def samples(self) -> Samples:
        """The arrays in the inertial support frame, as the methods and the card take them."""
        data = self.in_frame("support").data
        arrays = {part.name: data[part.name].values for part in fields(Samples) if part.name in data}
        own = [data[name].values for name in labels.own_names(self.system)]
        return Samples(**arrays, events=self.events, own=np.stack(own, axis=-1) if own else None)

    def in_frame(self, frame: str) -> Trajectory:
        """Return the same motion seen from another frame.

        Parameters
        ----------
        frame : str
            "support": inertial, third axis the support's, first axis down the slope. "world": inertial, third axis
            vertically up. "corotating": fixed to the support, however it moves; velocities are those seen from it.

        Returns
        -------
        Trajectory
            A new one; the card stays that of the motion.

        Raises
        ------
        UnknownNameError
            If there is no such frame.

        Examples
        --------
        A ball put down on a turning table stays there, and so runs backwards in the table's eyes:

        >>> import trundle as tr
        >>> table = tr.Support(tr.Plane(), motion=tr.Spin(1.0))
        >>> system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.025, mass=0.065), table)
        >>> run = tr.simulate(system, system.place((0.5, 0.0)), duration=1.0, every=1.0)
        >>> [round(float(c), 6) for c in run.in_frame("corotating").data.velocity[0]]
        [0.0, -0.5, 0.0]
        """
        if frame not in frames.FRAMES:
            raise UnknownNameError("frame", str(frame), frames.FRAMES)
        if frame == self.frame:
            return self
        own = labels.own_names(self.system)
        return replace(self, data=frames.change(self.data, self.system.support, self.frame, frame, own))

    def at(self, times: Any) -> Trajectory:
        """Return the motion at other instants, by the same method from the same start: nothing is interpolated.

        Parameters
        ----------
        times : array (n,)
            Ascending, s, from the start on; past the end of the run nothing is known to have changed.

        Returns
        -------
        Trajectory
            In the same frame.

        Raises
        ------
        InvalidValueError
            If the times are not finite, ascending and within the run, or find no room in memory.

        Examples
        --------
        >>> import trundle as tr
        >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.5, 1.0), tr.Support(tr.Plane()))
        >>> run = tr.simulate(system, system.place(velocity=(1.0, 0.0)), duration=2.0, every=1.0)
        >>> run.at([0.25]).data.position[0, 0].item()
        0.25
        """
        wanted = np.atleast_1d(np.asarray(times, dtype=float))
        first, last = float(self.data.time.values[0]), float(self.data.time.values[-1])
        inside = wanted.size and np.isfinite(wanted).all() and wanted[0] >= first and wanted[-1] <= last
        if not inside or (np.diff(wanted) < 0).any():
            raise InvalidValueError("times", f"must ascend within the run, {first:g} to {last:g} s", times)
        each, received = labels.size_of(self.system), f"{wanted.size:,} times"
        check_room(wanted.size, each, "times", received, "ask for {:,} at a time".format)
        once, places = np.unique(wanted, return_inverse=True)
        samples = Method(self.method, self.tolerance).solve(self.system, self.start, once)
        samples = replace(samples, time=once).part(places)  # at the rim an integrator may stop a rounding earlier
        data = labels.dataset(self.system, samples, {**self.data.attrs, "frame": "support"})
        return replace(self, data=data).in_frame(self.frame)

    def card(self) -> Card:
        """Return the verification card: what was checked, and how well it held.

        Returns
        -------
        Card
            Made once; a loaded trajectory brings its own.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.Scenario.load("level-turntable-nudged").run(duration=5.0).card().passed
        True
        """
        from . import verify

        if "card" not in self._kept:
            method = Method(self.method, self.tolerance)
            self._kept["card"] = verify.card(self.system, self.start, self.samples, method, self.title)
        return self._kept["card"]

    def with_card(self, card: Card) -> Trajectory:
        """Return the same trajectory with a card that was made elsewhere.

        Parameters
        ----------
        card : Card
            Of this trajectory.

        Returns
        -------
        Trajectory
            Its `card()` returns the given one.

        Examples
        --------
        >>> import trundle as tr
        >>> run = tr.Scenario.load("level-turntable-nudged").run()
        >>> run.with_card(run.card()).card() is run.card()
        True
        """
        return replace(self, _kept={"card": card})

    def plot(self, kind: str = "path") -> Figure:
        """Draw the motion.

        Parameters
        ----------
        kind : str
            "path": the path in each frame, one sheet. "series": what changes over time.

        Returns
        -------
        matplotlib.figure.Figure
            Shown by notebooks; save it with `savefig`.

        Raises
        ------
        UnknownNameError
            If there is no such figure.

        Examples
        --------
        >>> import trundle as tr
        >>> len(tr.Scenario.load("level-turntable-nudged").run().plot().axes) >= 2
        True
        """
        from . import plots

        kinds = {"path": plots.path_figure, "series": plots.series_figure}
        if kind not in kinds:
            raise UnknownNameError("figure", str(kind), kinds)
        return kinds[kind](self)

    def save(self, path: Any) -> Path:
        """Write the trajectory to a NetCDF4 file, whole or not at all, with scenario, versions and card.

        Parameters
        ----------
        path : path
            Such as ``"run.nc"``; its folder must exist.

        Returns
        -------
        pathlib.Path
            The file.

        Raises
        ------
        TrundleError
            If it cannot be written.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> import trundle as tr
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     run = tr.Scenario.load("level-turntable-nudged").run()
        ...     again = tr.Trajectory.load(run.save(pathlib.Path(folder) / "run.nc"))
        >>> again.data.identical(run.data)
        True
        """
        target = Path(path)
        if not self.scenario:
            raise TrundleError(
                f"{target} is not written: a file holds the scenario, and the scenario format has no words for a part "
                "of this system. Keep `run.data` with its own `to_netcdf`, or teach the format the new part."
            )
        extra = {
            "scenario": self.scenario,
            "start": json.dumps(asdict(self.start)),
            "events": json.dumps([asdict(event) for event in self.events]),
            "card": self.card().as_json(),
        }
        write_dataset(self.data.assign_attrs(extra), target)
        return target

    @staticmethod
    def load(path: Any) -> Trajectory:
        """Read a trajectory back; nothing is lost.

        Parameters
        ----------
        path : path
            A file that `save` wrote.

        Returns
        -------
        Trajectory
            As it was saved.

        Raises
        ------
        TrundleError
            If the file cannot be read or is no trajectory of trundle's.

        Examples
        --------
        See `save`.
        """
        import xarray

        from . import verify

        try:
            data = xarray.load_dataset(Path(path), engine="h5netcdf")
        except FileNotFoundError:
            raise TrundleError(f"{path} does not exist.") from None
        except (OSError, ValueError) as error:
            raise TrundleError(f"{path} cannot be read as a NetCDF4 file ({error}).") from None
        missing = [key for key in ("scenario", "start", "events", "card", "method", "frame") if key not in data.attrs]
        if missing:
            raise TrundleError(f"{path} is no trajectory of trundle's: it lacks the attributes {', '.join(missing)}.")
        scenario, start, events, card = (data.attrs.pop(key) for key in ("scenario", "start", "events", "card"))
        return Trajectory(
            data,
            ScenarioFile.loads(scenario, source=str(path)).system(),
            State(**_tuples(json.loads(start))),
            str(data.attrs["method"]),
            tuple(_event(event) for event in json.loads(events)),
            scenario,
            {"card": verify.Card.from_json(card)},
        )


def _public_names() -> list[str]:
    names = {part.name for part in fields(Trajectory)} | set(dir(Trajectory))
    return sorted(name for name in names if not name.startswith("_"))


def _event(values: dict[str, Any]) -> Event:
    states = {name: State(**_tuples(values[name])) for name in ("before", "after") if values.get(name)}
    return Event(**{**_tuples(values), **states})


def _tuples(values: dict[str, Any]) -> dict[str, Any]:
    return {key: tuple(value) if isinstance(value, list) else value for key, value in values.items()}
