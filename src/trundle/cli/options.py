"""The options that several commands share, and what is made of them: each is told once, here."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer

from ..errors import InvalidValueError, ScenarioError
from ..scenario import files

if TYPE_CHECKING:
    from ..tracks import Track


def complete(incomplete: str) -> list[str]:
    """Offer the shipped scenarios, and files and folders as a shell would."""
    folder, _, start = incomplete.rpartition("/")
    inside = Path(folder + "/" if folder or incomplete.startswith("/") else ".").expanduser()
    try:
        found = [path for path in inside.iterdir() if path.name.startswith(start)]
    except OSError:
        found = []
    shown = [path for path in found if path.suffix == ".toml" or (path.is_dir() and path.name[0] != ".")]
    ahead = incomplete[: len(incomplete) - len(start)]
    paths = [f"{ahead}{path.name}{'/' if path.is_dir() else ''}" for path in sorted(shown)]
    return [name for name in files.names() if name.startswith(incomplete)] + paths


Name = Annotated[
    str,
    typer.Argument(metavar="SCENARIO", help="The name of a shipped one, or a TOML file.", autocompletion=complete),
]
WhatMoves = Annotated[
    str | None,
    typer.Option(
        "--scenario",
        "-s",
        metavar="SCENARIO",
        help="What moves: a shipped scenario or a TOML file.",
        autocompletion=complete,
    ),
]
Folder = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="FOLDER", help="Default: a folder of the scenario's name.")
]
FileFolder = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="FOLDER", help="Default: a folder of the file's name.")
]
NoFigure = Annotated[bool, typer.Option("--no-figure", help="Draw no figure.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")]
Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON, and nothing else.")]


def folder_for(output: Path | None, source: str | Path) -> Path:
    """Return the folder to write to: the one that was named, or one of the source's name.

    Examples
    --------
    >>> folder_for(None, "mine/ball.toml").name
    'ball'
    """
    return Path(Path(source).stem) if output is None else output.expanduser()


def no_scenario() -> InvalidValueError:
    """Return the error of a command that was not told what moves."""
    remedy = "Name a shipped one (`trundle list`) or a TOML file."
    return InvalidValueError("--scenario", "must say what moves", "none", remedy)


def load(scenario: str, tables: dict[str, Any] | None = None, **overrides: str | None) -> Any:
    """Read a scenario, or its tables, with some keys of its [run] table replaced by options of the command line."""
    from ..simulation.simulate import Scenario

    given = {key: value for key, value in overrides.items() if value is not None}
    tables = files.tables_of(scenario) if tables is None else dict(tables)
    if isinstance(tables.get("run", {}), dict):
        tables["run"] = {**tables.get("run", {}), **given}
    try:
        return Scenario.read(tables, scenario)
    except ScenarioError as error:
        raise error.naming({f"run.{key}": f"--{key}" for key in given}) from None


@dataclass(frozen=True)
class Reading:
    """The options that say how a measured track is read."""

    track: Annotated[
        str | None, typer.Option("--track", metavar="NAME", help="Which track, where there are several.")
    ] = None
    columns: Annotated[
        str | None, typer.Option("--columns", metavar="LIST", help="Names that do not tell: 't=frame_time, x=u, y=v'.")
    ] = None
    length: Annotated[
        str | None, typer.Option("--unit", "--length", metavar="UNIT", help="Of places, such as cm; speeds per second.")
    ] = None
    time: Annotated[str | None, typer.Option("--time", metavar="UNIT", help="Of time, such as ms.")] = None
    angle: Annotated[str | None, typer.Option("--angles", metavar="UNIT", help="rad or deg, also of rates.")] = None
    rate: Annotated[
        float | None, typer.Option("--rate", metavar="NUMBER", help="Frames a second, where frames count.")
    ] = None
    pixel: Annotated[
        str | None, typer.Option("--pixel", metavar="LENGTH", help="The size of one, such as '0.8 mm'.")
    ] = None
    y: Annotated[str | None, typer.Option("--y", metavar="SENSE", help="up or down: which way y grows.")] = None
    sense: Annotated[
        str | None, typer.Option("--sense", metavar="SENSE", help="clockwise or anticlockwise: how an angle grows.")
    ] = None
    decimal: Annotated[str | None, typer.Option("--decimal", metavar="SIGN", help="point or comma, for '1,234'.")] = (
        None
    )

    def read(self, file: Path, assumed: dict[str, str] | None = None, **options: Any) -> Track:
        """Read a track; where a unit is neither said nor in the file, take the one that is assumed, if any."""
        from ..tracks import read_track

        told = {field.name: getattr(self, field.name) for field in fields(self)}
        units = {kind: said for kind in ("length", "time", "angle") if (said := told.pop(kind)) is not None}
        told["columns"] = pairs(self.columns)
        return read_track(file, units={**(assumed or {}), **units}, **told, **options)


NOTHING_SAID = Reading()


def reads_tracks(command: Callable[..., None]) -> Callable[..., None]:
    """Offer each field of `Reading` as an option of a command that takes a `reading`, in the place of that one."""
    group = get_type_hints(Reading, include_extras=True)

    @wraps(command)
    def offered(**given: Any) -> None:
        reading = Reading(**{name: given.pop(name) for name in group})
        command(**given, reading=reading)

    signature = inspect.signature(command, eval_str=True)
    parameters: list[inspect.Parameter] = []
    for parameter in signature.parameters.values():
        if parameter.name == "reading":
            kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
            parameters += [inspect.Parameter(name, kind, default=None, annotation=hint) for name, hint in group.items()]
        else:
            parameters.append(parameter)
    offered.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    offered.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    del offered.__wrapped__
    return offered


def pairs(text: str | None) -> dict[str, str]:
    """Read 't=frame_time, x=u'.

    Examples
    --------
    >>> pairs("t=frame_time, x=u")
    {'t': 'frame_time', 'x': 'u'}
    """
    if text is None:
        return {}
    found = [pair.partition("=") for pair in text.split(",") if pair.strip()]
    wrong = next((f"{name}{sign}{heading}" for name, sign, heading in found if not (sign and heading.strip())), None)
    if wrong is not None:
        raise InvalidValueError("--columns", "must be pairs NAME=HEADING", wrong.strip(), "Write 't=time, x=u, y=v'.")
    return {name.strip(): heading.strip() for name, _, heading in found}
