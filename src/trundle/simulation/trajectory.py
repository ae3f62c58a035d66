"""A trajectory: labelled arrays, where they came from, and what may be said of them."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..display import Plottable
from ..errors import InvalidValueError, TrundleError, UnknownNameError
from ..mechanics.system import RollingSystem, State
from ..solve import frames
from ..solve.exact import ClosedForm, closed_form
from ..solve.methods import Method
from ..solve.samples import Event, Samples
from ..views.viewer.viewable import Viewable
from . import labels, run_file
from .memory import check_room

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from ..verify import Card


@dataclass(frozen=True, repr=False)
class Trajectory(Viewable, Plottable):
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
    # What was once asked for, or is known from elsewhere: `form`; `card`, with the facts it speaks of; `view`, the run
    # of which this is another view, with the facts of the view; `file`, from which it was loaded.
    _kept: dict[str, Any] = field(default_factory=dict, compare=False)

    @staticmethod
    def _of(
        samples: Samples, attributes: dict[str, Any], system: RollingSystem, start: State, scenario: str
    ) -> Trajectory:
        """Return the run that a method sampled; a viewer needs no dataset of it."""
        kept = {} if samples.form is None else {"form": samples.form}
        run = Trajectory(None, system, start, attributes["method"], samples.events, scenario, kept)  # type: ignore[arg-type]
        del vars(run)["data"]
        vars(run)["_sampled"] = samples, attributes
        return run

    def __getattr__(self, name: str) -> Any:
        own = vars(self)
        if name == "data" and "_sampled" in own:
            own[name] = data = labels.dataset(self.system, *own["_sampled"])
            own.pop("_sampled", None)  # the dataset has the numbers now
            return data
        if name.startswith("_"):
            raise AttributeError(name)
        raise UnknownNameError("attribute of a Trajectory", name, _public_names())

    @property
    def frame(self) -> str:
        """The frame of the vectors: "support", "world" or "corotating"."""
        return str(self._attributes["frame"])

    @property
    def title(self) -> str:
        """The scenario's title."""
        return str(self._attributes.get("title", ""))

    @property
    def tolerance(self) -> float:
        """The tolerance of the method; 0 for a closed form."""
        return float(self._attributes["tolerance"])

    @property
    def _attributes(self) -> dict[Any, Any]:
        """What the dataset says of itself."""
        own = vars(self)
        return own["_sampled"][1] if "_sampled" in own else self.data.attrs

    @property
    def _ends(self) -> tuple[float, float]:
        """When its first and its last sample are, s."""
        own = vars(self)
        time = own["_sampled"][0].time if "_sampled" in own else self.data.time.values
        return float(time[0]), float(time[-1])

    @property
    def changed(self) -> tuple[str, ...] | None:
        """What has changed in the file of a loaded run since it was saved; None where the file cannot tell."""
        file = self._kept.get("file")
        return () if file is None else file.changed

    @property
    def closed_form(self) -> ClosedForm | None:
        """The closed form of the phase in which it starts; None where there is none."""
        if "form" not in self._kept:
            self._kept["form"] = closed_form(self.system, self.start)
        return self._kept["form"]

    @property
    def samples(self) -> Samples:
        """The arrays in the inertial support frame, as the methods and the card take them."""
        own = vars(self)
        if "_sampled" in own:
            return own["_sampled"][0]
        data = self.in_frame("support").data
        names = {part.name for part in fields(Samples)} & {"time", *labels.facts(self.system)}
        coordinates = [data[name].values for name in labels.coordinate_names(self.system)]
        arrays = {name: data[name].values for name in names if name in data}
        return Samples(
            **arrays, events=self.events, support_coordinates=np.stack(coordinates, axis=-1) if coordinates else None
        )

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
        coordinates = labels.coordinate_names(self.system)
        data = frames.change(self.data, self.system.support, self.frame, frame, coordinates)
        seen = replace(self, data=data, _kept=dict(self._kept))
        seen._kept["view"] = self, seen._facts()
        return seen

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
        first, last = self._ends
        inside = wanted.size and np.isfinite(wanted).all() and wanted[0] >= first and wanted[-1] <= last
        if not inside or (np.diff(wanted) < 0).any():
            raise InvalidValueError("times", f"must ascend within the run, {first:g} to {last:g} s", times)
        each, received = labels.size_of(self.system), f"{wanted.size:,} times"
        check_room(wanted.size, each, "times", received, "ask for {:,} at a time".format)
        once, places = np.unique(wanted, return_inverse=True)
        samples = Method(self.method, self.tolerance).solve(self.system, self.start, once)
        # At the rim an integrator may stop a rounding earlier.
        samples = replace(samples, time=once, events=self.events).part(places)
        attributes = {**self._attributes, "frame": "support"}
        found = Trajectory._of(samples, attributes, self.system, self.start, self.scenario)
        found._kept.update(self._kept)
        return found.in_frame(self.frame)

    def card(self) -> Card:
        """Return the verification card: what was checked, and how well it held.

        Returns
        -------
        Card
            Made once, and made anew where the numbers have changed since. A loaded trajectory brings the one that was
            saved with it, as long as the digests in its file hold; its `origin` says so.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.Scenario.load("level-turntable-nudged").run(duration=5.0).card().passed
        True
        """
        run = self._whole()
        facts = run._facts()
        made = run._card_of(facts)
        if made is None:
            made = run._checked()
            run._kept["card"] = facts, made
        return made

    def _card_if_made(self) -> Card | None:
        """Return the card if it has been made, and nothing has changed since."""
        run = self._whole()
        return run._card_of(run._facts())

    def _card_of(self, facts: tuple[Any, ...]) -> Card | None:
        since, card = self._kept.get("card", (None, None))
        return card if since == facts else None

    def _whole(self) -> Trajectory:
        """Return the run of which this is a view, as long as nothing has changed in it; otherwise itself."""
        run, since = self._kept.get("view", (self, None))
        return run if since == self._facts() else self

    def _facts(self) -> tuple[Any, ...]:
        """Return all that a card depends on: it speaks of a run for which they are the same."""
        return self.system, self.start, self.method, self.events, run_file.digests(self.data, self.system, {})

    def _checked(self) -> Card:
        """Make the card."""
        from .. import verify

        method = Method(self.method, self.tolerance)
        file = self._kept.get("file")
        if file is None:
            return verify.card(self.system, self.start, self.samples, method, self.title)
        from ..verify.reread import card_of_file

        def read() -> tuple[Samples, Any]:
            seen = self.in_frame("support")
            return seen.samples, seen.data.slip_velocity.values

        made = card_of_file(self.system, self.start, self.data.time.values, read, method, self.title)
        origin = f"made anew: changed since {file.name} was read" if file.intact else file.origin
        return replace(made, origin=origin)

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
        return replace(self, _kept={**self._kept, "card": (self._facts(), card)})

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
        from ..views import plots

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
        texts = {
            "scenario": self.scenario,
            "start": json.dumps(asdict(self.start)),
            "events": json.dumps([asdict(event) for event in self.events]),
            "card": replace(self.card(), origin="").as_json(),
        }
        run_file.write(target, self.data, texts, self.system)
        return target

    @staticmethod
    def load(path: Any) -> Trajectory:
        """Read a trajectory back; nothing is lost, and what has changed since is told.

        Parameters
        ----------
        path : path
            A file that `save` wrote.

        Returns
        -------
        Trajectory
            As it was saved. Where a digest in the file does not hold, or there is none, `card()` checks the numbers
            as they are in the file, as soon as it is asked for.

        Raises
        ------
        RunFileError
            If the file cannot be read, is no run of trundle's, or holds what no run can be.

        Examples
        --------
        See `save`.
        """
        file = run_file.read(path)
        run = Trajectory(file.data, file.system, file.start, file.data.attrs["method"], file.events, file.scenario)
        run._kept["file"] = file
        if file.intact:
            run._kept["card"] = run._facts(), replace(file.card, origin=file.origin)
        return run


def _public_names() -> list[str]:
    names = {part.name for part in fields(Trajectory)} | set(dir(Trajectory))
    return sorted(name for name in names if not name.startswith("_"))
