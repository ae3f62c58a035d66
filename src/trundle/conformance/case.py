"""A case: a motion that is known exactly, and the task that an engine is given for it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

FORMAT = 1  # of the task and the answer: raised when an adapter has to be changed
PARTS = {"position": 3, "velocity": 3, "angular_velocity": 3, "orientation": 4}
END = ("position", "velocity", "angular_velocity")  # of which derivatives are asked for

Array = NDArray[np.float64]
Task = dict[str, Any]


@dataclass(frozen=True)
class Motion:
    """A motion of one body or several, sampled in time, all of it in the axes of the support at rest.

    Parameters
    ----------
    time : array of shape (samples,)
        s.
    position, velocity, angular_velocity : array of shape (samples, bodies, 3)
        Of the centres of mass in m and m/s, and Ω in rad/s.
    orientation : array of shape (samples, bodies, 4)
        Unit quaternions (w, x, y, z), body axes to axes of the support.
    support : array of shape (samples, 2), optional
        The angle of a support on a hinge, rad, and its rate, rad/s.

    Examples
    --------
    >>> import trundle as tr
    >>> motion = tr.conformance.cases()[0].exact()
    >>> motion.position.shape[1:], motion.orientation.shape[1:]
    ((1, 3), (1, 4))
    """

    time: Array
    position: Array
    velocity: Array
    angular_velocity: Array
    orientation: Array
    support: Array | None = None


@dataclass(frozen=True)
class Input:
    """A number of a case by which the final state is differentiated.

    Parameters
    ----------
    name : str
        As the scenario calls it.
    direction : dict
        How the numbers of the task change with it: of the same structure, a slope in the place of each number.
    exact : array of shape (bodies, 9)
        What it does to position, velocity and angular velocity of each body at the end.
    size : float
        Its own, or 1 where it is zero.
    moved : callable
        Returns the case with so much more of it.

    Examples
    --------
    >>> import trundle as tr
    >>> case = next(case for case in tr.conformance.cases() if case.name == "incline")
    >>> tilt = next(each for each in case.inputs() if each.name == "support.tilt")
    >>> tilt.exact.shape, [round(slope, 3) for slope in tilt.direction["gravity"]]  # the plane leans, with its axes
    ((1, 9), [9.758, 0.0, 0.979])
    """

    name: str
    direction: Task
    exact: Array
    size: float
    moved: Callable[[float], Case]


@dataclass(frozen=True)
class Case(ABC):
    """One motion to be scored: what an engine is told of it, and how it truly goes.

    Parameters
    ----------
    name : str
        As the command line calls it.
    title : str
        A line about it.
    about : str
        What happens in it, and what it asks of an engine.

    Examples
    --------
    >>> import trundle as tr
    >>> case = next(case for case in tr.conformance.cases() if case.name == "incline")
    >>> case.title, sorted(case.needs)
    ('Ball rolling down an incline', ['plane', 'sphere'])
    """

    name: str
    title: str
    about: str

    @property
    @abstractmethod
    def duration(self) -> float:
        """Length of the run, s."""

    @property
    @abstractmethod
    def every(self) -> float:
        """Time between samples, s."""

    @abstractmethod
    def situation(self) -> Task:
        """Return bodies, support, friction and gravity, as the task tells them.

        Returns
        -------
        dict
            Numbers, words, lists and dicts only.
        """

    @abstractmethod
    def exact(self, method: str = "auto") -> Motion:
        """Return the motion itself.

        Parameters
        ----------
        method : str
            "auto", or another for a second route to the same motion.

        Returns
        -------
        Motion
            At the times of the samples.
        """

    @abstractmethod
    def slip(self, motion: Motion) -> Array:
        """Return the velocity at which each body slips, where it is nearest to what it rolls on.

        Parameters
        ----------
        motion : Motion
            The exact one, or an engine's.

        Returns
        -------
        array of shape (samples, bodies, 3)
            m/s; not a number where the motion does not tell how its support turns.
        """

    @abstractmethod
    def energy(self, motion: Motion) -> Array:
        """Return the energy, less what a driven support or a constant force has put in.

        Parameters
        ----------
        motion : Motion
            The exact one, or an engine's.

        Returns
        -------
        array of shape (samples,)
            J; not a number where the motion does not tell how its support turns.
        """

    def friction_force(self, motion: Motion) -> Array:  # noqa: ARG002  a case that has a force takes it
        """Return the mean force of friction of the support on all bodies, where forces are part of the case.

        Parameters
        ----------
        motion : Motion
            The exact one, or an engine's.

        Returns
        -------
        array of shape (3,)
            N; not a number where they are not.
        """
        return np.full(3, np.nan)

    def on_mesh(self) -> Motion | None:
        """Return the motion that is exact but for a mesh in the place of a smooth support; None where there is none.

        Returns
        -------
        Motion or None
            At the times of the samples.
        """
        return None

    def inputs(self) -> tuple[Input, ...]:
        """Return the numbers by which the final state has derivatives; none where it has none, or they are not known.

        Returns
        -------
        tuple of Input
            Those that change something.
        """
        return ()

    def kinetic_energy(self, motion: Motion) -> Array:
        """Return the kinetic energy of all bodies.

        Parameters
        ----------
        motion : Motion
            The exact one, or an engine's.

        Returns
        -------
        array of shape (samples,)
            J.
        """
        bodies = self.situation()["bodies"]
        mass, inertia = np.array([body["mass"] for body in bodies]), np.array([body["inertia"] for body in bodies])
        Omega = in_body_axes(motion.orientation, motion.angular_velocity)
        spin = np.einsum("tbi,bij,tbj->t", Omega, inertia, Omega)
        energy: Array = 0.5 * ((mass * (motion.velocity**2).sum(-1)).sum(-1) + spin)
        return energy

    @property
    def needs(self) -> frozenset[str]:
        """What an engine must be able to say to run it, as words of the task."""
        told = self.situation()
        bodies, support = told["bodies"], told["support"]
        found = {"mesh" if "mesh" in support else support["kind"], *(body["shape"]["kind"] for body in bodies)}
        if support["motion"]["kind"] != "fixed":
            found.add(support["motion"]["kind"])
        if told["restitution"]:
            found.add("restitution")
        if len(bodies) > 1:
            found.add("several bodies")
        if any(any(body["offset"]) for body in bodies):
            found.add("offset")
        return frozenset(found)

    def task(self, dt: float, setting: Mapping[str, Any] | None = None, derivatives: Sequence[Input] = ()) -> Task:
        """Return what an adapter is given.

        Parameters
        ----------
        dt : float
            The engine's step, s.
        setting : mapping, optional
            What the adapter is to set beside it, in words of its own.
        derivatives : sequence of Input
            By what it is to differentiate the final state.

        Returns
        -------
        dict
            Numbers, words, lists and dicts only: JSON can hold it.

        Examples
        --------
        >>> import trundle as tr
        >>> task = tr.conformance.cases()[0].task(dt=1e-3)
        >>> task["dt"], sorted(task["bodies"][0])[:4]
        (0.001, ['angular_velocity', 'force', 'inertia', 'mass'])
        """
        timing = {"dt": dt, "duration": self.duration, "every": self.every}
        told = {"format": FORMAT, "case": self.name, **timing, "setting": dict(setting or {}), **self.situation()}
        if derivatives:
            told["derivatives"] = [{"by": each.name, **each.direction} for each in derivatives]
        return told

    def times(self) -> Array:
        """Return the times of the samples, s."""
        return np.linspace(0.0, self.duration, round(self.duration / self.every) + 1)


def in_body_axes(orientation: Array, vectors: Array) -> Array:
    """Turn vectors from the axes of space to those of bodies with these unit quaternions.

    Examples
    --------
    >>> quarter = np.array([0.5**0.5, 0.0, 0.0, 0.5**0.5])  # about the third axis
    >>> in_body_axes(quarter, np.array([0.0, 2.0, 1.0])).round(6)[[0, 2]].tolist()
    [2.0, 1.0]
    """
    w, u = orientation[..., :1], -orientation[..., 1:]
    crossed: Array = 2.0 * np.cross(u, vectors)
    turned: Array = vectors + w * crossed
    turned += np.cross(u, crossed)
    return turned


def extent(case: Case) -> float:
    """Return the shortest length of any body in a case, m.

    Examples
    --------
    >>> extent(cases()[0])
    0.025
    """
    lengths: list[float] = []
    for body in case.situation()["bodies"]:
        for key, value in body["shape"].items():
            lengths += [] if key == "kind" else value if isinstance(value, list) else [value]
    return min(lengths)


def cases(folder: str | Path | None = None) -> list[Case]:
    """Return the cases that engines are scored on, to be run or to parametrize a test.

    Parameters
    ----------
    folder : path, optional
        Of case files; absent: those that ship with trundle.

    Returns
    -------
    list of Case
        In the order of their names.

    Raises
    ------
    ScenarioError
        If a file is not as the format asks.

    Examples
    --------
    >>> import trundle as tr
    >>> [case.name for case in tr.conformance.cases()][:3]
    ['billiard-draw', 'billiard-follow', 'billiard-swerve']
    """
    from ..errors import InvalidValueError
    from ..scenario import files
    from .bowl_of_triangles import BowlOfTriangles
    from .pushed_box import PushedBox
    from .rolling import Rolling

    place = Path(folder) if folder is not None else Path(__file__).with_name("cases")
    paths = sorted(place.glob("*.toml"))
    if not paths:
        raise InvalidValueError("folder", "must hold case files (*.toml)", str(place))
    found: list[Case] = []
    for path in paths:
        tables = files.tables_of(path)
        kind = next((each for each in (PushedBox, BowlOfTriangles) if each.table in tables), Rolling)
        found.append(kind.read(path.stem, tables, str(path)))
    return found
