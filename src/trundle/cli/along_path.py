"""`trundle run` for a ball rolled along a path: what it prints, and the files that it writes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import InvalidValueError, ScenarioError

if TYPE_CHECKING:
    from ..analysis.geometry import PathScenario, RolledPath
    from ..verify import Card

FILES = ("run.nc", "stages.png")


def run(
    tables: dict[str, Any], source: str, folder: Path, *, figure: bool, **options: str | None
) -> tuple[Card, list[str], list[Path]]:
    """Roll the ball, and write the files whole or not at all.

    Examples
    --------
    >>> from trundle.scenario import files
    >>> tables = files.tables_of("roll-x-then-y")
    >>> card, lines, written = run(tables, "roll-x-then-y", Path("out"), figure=False)
    >>> lines[-1]
    'stage 2  (3.927, 3.927) cm, north pole along +x'
    """
    from .writing import check_folder, write_together

    names = FILES if figure else FILES[:1]
    scenario = _load(tables, source, {key: value for key, value in options.items() if value is not None})
    check_folder(folder, names)
    rolled = scenario.run()
    spacing = scenario.sampling.every
    every = None if spacing is None else float(spacing)
    writers = {
        "run.nc": lambda path: rolled.save(path, every),
        "stages.png": lambda path: rolled.plot().savefig(path),
    }
    written = write_together(folder, {name: writers[name] for name in names})
    return rolled.card(), [f"{name:<8} {what}".rstrip() for name, what in _stages(rolled)], written


def _load(tables: dict[str, Any], source: str, given: dict[str, str]) -> PathScenario:
    from ..analysis.geometry import PathScenario

    for option in ("duration", "method", "tolerance"):
        if option in given:
            remedy = "A path knows no time and no forces; leave the option out."
            raise InvalidValueError(f"--{option}", "is for motions under forces", given[option], remedy)
    if given and isinstance(tables.get("run", {}), dict):
        tables = {**tables, "run": {**tables.get("run", {}), **given}}
    try:
        return PathScenario.read(tables, source)
    except ScenarioError as error:
        raise error.naming({f"run.{key}": f"--{key}" for key in given}) from None


def _stages(rolled: RolledPath) -> list[tuple[str, str]]:
    """Return each stage's name, and where the ball and its north pole are."""
    return [(name, f"{place}, north pole {pole}" if place else "") for name, place, pole in rolled.stages.told()]


def expected(tables: dict[str, Any], source: str) -> Callable[[], list[tuple[str, str]]]:
    """Check the tables of a scenario, and return what tells what to expect of it.

    Examples
    --------
    >>> from trundle.scenario import files
    >>> expected(files.tables_of("roll-home-turned"), "roll-home-turned")()[-1]
    ('came home turned by', '120 deg about (0.57735, 0.57735, -0.57735)')
    """
    from ..analysis.geometry import PathScenario

    scenario = PathScenario.read(tables, source)

    def rows() -> list[tuple[str, str]]:
        rolled = scenario.run()
        home = "came home turned by" if rolled.is_closed else "turned in the end by"
        return [*_stages(rolled), (home, str(rolled.rotation))]

    return rows
