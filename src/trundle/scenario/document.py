"""The scenario file as a whole: from TOML to a validated model, to the system and start, and back."""

from __future__ import annotations

from functools import cached_property, partial
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

from pydantic import Field, model_validator

from ..errors import InvalidValueError, ScenarioError
from .base import Document
from .fields import Measure, bare, written
from .tables import KINDS, Bodies, Loads, Run, Start, Supports
from .together import tell_all
from .validation_errors import Kinds

if TYPE_CHECKING:
    from ..mechanics.system import RollingSystem, State

Gravity = Annotated[float, Measure("acceleration", "not negative")]
DIALECT = "https://json-schema.org/draft/2020-12/schema"


class ScenarioFile(Document):
    """A body, a support, loads, a start and a run, as a scenario file says them.

    Every number is a float in SI; it remembers the text that it was written as, and `to_toml` writes that.

    Examples
    --------
    >>> import trundle as tr
    >>> scenario = tr.Scenario.load("tilted-turntable")
    >>> scenario.body.radius
    0.025
    >>> scenario.system().support.motion.rate == scenario.support.motion.rate
    True
    """

    kinds: ClassVar[Kinds] = KINDS

    gravity: Gravity = Field(default=9.80665, description="Acceleration of free fall, g; 0 turns it off.")
    body: Bodies
    support: Supports
    start: Start
    # Two keys have other names in Python, where `loads` reads a text, as in `json`, and `run` runs it.
    applied_loads: tuple[Loads, ...] = Field(default=(), alias="loads")
    timing: Run = Field(alias="run")

    # --- from Python ---------------------------------------------------------------------------------------

    @classmethod
    def describe(
        cls,
        system: RollingSystem,
        start: State,
        *,
        duration: float,
        every: float,
        method: str = "auto",
        title: str = "",
    ) -> Self:
        """Write a system and its start as a scenario, each number so that it reads back to the same float.

        Parameters
        ----------
        system : RollingSystem
            One system (no arrays of members).
        start : State
            Its start.
        duration, every : float
            Length of the run and time between samples, s.
        method : str
            ``"auto"``, ``"exact"``, ``"taylor"`` or ``"runge-kutta"``.
        title : str
            The title.

        Returns
        -------
        ScenarioFile
            The scenario.

        Raises
        ------
        ScenarioError
            If the format has no words for the system.

        Examples
        --------
        >>> import trundle as tr
        >>> system = tr.RollingSystem(tr.Body.hollow_sphere(radius=0.02, mass=0.0027), tr.Support(tr.Plane()))
        >>> start = system.place(position=(0.1, 0.0))
        >>> scenario = tr.Scenario.describe(system, start, duration=1.0, every=0.01)
        >>> scenario.system() == system and scenario.start_state() == start
        True
        """
        from .description import describe

        data = describe(system, start)
        data["run"] = {"duration": float(duration), "every": float(every), "method": method}
        return cls.read({"title": title, **data}, title or "scenario")

    # --- checks that look at the whole -------------------------------------------------------------------

    @model_validator(mode="after")
    def _check(self) -> Self:
        from ..mechanics.finiteness import check_finite

        system, begin = self.system(), float(self.start.time)
        coordinates = [
            partial(Measure(kind), part, f"{key}[{i}]")
            for key, kinds in self._kinds_of_components().items()
            for i, (part, kind) in enumerate(
                zip(getattr(self.start, key.removeprefix("start.")) or (), kinds, strict=False)
            )
        ]

        def finite() -> None:
            with _named_in(""):
                check_finite(system, begin, begin + float(self.timing.duration))

        tell_all(*coordinates, finite)
        self.start_state()  # placing it tells whether the body fits there, and whether the start rolls
        return self

    def _kinds_of_components(self) -> dict[str, tuple[str, ...]]:
        support = self.system().support
        return {"start.position": support.surface.coordinates, "start.support": tuple(support.motion.coordinate_kinds)}

    # --- what it describes -------------------------------------------------------------------------------

    def system(self) -> RollingSystem:
        """Return the rolling system.

        Returns
        -------
        RollingSystem
            Body, support and loads.

        Raises
        ------
        ScenarioError
            If the mechanics refuses a value.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.Scenario.load("hollow-ball-turntable").system().body.mass
        0.0027
        """
        return self._system

    def start_state(self) -> State:
        """Return the state in which the run starts.

        Returns
        -------
        State
            Position, velocity, angular velocity and orientation.

        Raises
        ------
        ScenarioError
            If the start contradicts itself: a velocity and an angular velocity that do not roll.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.Scenario.load("level-turntable-put-down").start_state().velocity
        (0.0, 0.0, 0.0)
        """
        return self._start

    # What it describes is frozen as it is itself: once is enough for the check, for the run and for whoever asks.

    @cached_property
    def _system(self) -> RollingSystem:
        from ..mechanics.system import RollingSystem

        with _named_in(""):
            body, support = self.body.build(), self.support.build()
            loads = tuple(tell_all(*(load.build for load in self.applied_loads)))
            return RollingSystem(body, support, loads, bare(self.gravity))

    @cached_property
    def _start(self) -> State:
        with _named_in("start", self.start):
            return self._system.place(**self.start.arguments())

    # --- for editors ----------------------------------------------------------------------------------------

    @classmethod
    def schema(cls) -> dict[str, Any]:  # type: ignore[override]
        """Return the JSON schema of a scenario file, for editors.

        Returns
        -------
        dict
            A schema of draft 2020-12.

        Examples
        --------
        >>> import trundle as tr
        >>> sorted(tr.Scenario.schema()["required"])
        ['body', 'run', 'start', 'support']
        """
        schema = ScenarioFile.model_json_schema()
        return {"$schema": DIALECT, **schema, "title": "trundle scenario"}


class _named_in:  # noqa: N801  a context manager reads as a phrase
    """Give a refusal by the mechanics its key in the file, and the words that stand there."""

    def __init__(self, path: str, table: Any = None) -> None:
        self.path, self.table = path, table

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        if isinstance(error, InvalidValueError):
            received = error.received if isinstance(error.received, str) else self._written(error)
            key = f"{self.path}.{error.key}" if self.path else error.key
            raise ScenarioError(key, error.rule, received, error.remedy) from None

    def _written(self, error: InvalidValueError) -> Any:
        return written(getattr(self.table, error.key, None) if self.table is not None else None) or error.received
