"""`trundle export`: a run in another form, by the ending of the file's name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InvalidValueError
from ..scenario import files
from ..views.viewer import exports
from . import screen, signals
from .options import Quiet, load

if TYPE_CHECKING:
    from ..views.scene import Scene

_SEVERAL, _UNIT = ".html", ".fmu"
_MODELS = (".xml", ".sdf", ".urdf")


def export(
    runs: Annotated[
        list[str], typer.Argument(metavar="RUN", help="A run.nc, a scenario's name or a TOML file. .html: several.")
    ],
    file: Annotated[str, typer.Argument(metavar="FILE", help="The file to make.")],
    live: Annotated[
        bool, typer.Option("--live", help="A page that computes the motion itself, for other numbers, too.")
    ] = False,
    slider: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME[=FROM..TO]",
            help="A number to be moved in a live page, such as body.radius=1 cm..3 cm; may stand several times.",
        ),
    ] = None,
    quiet: Quiet = False,
) -> None:
    """Write a run in another form; the ending of FILE says which. A scenario is run first.

    .html: a page that plays it in any browser, without a network, to be mailed; of several runs, all on one stage.
    .glb: an animated model. .gif: an animation. .png, .svg: the figure of the path. .csv: its numbers. .nc: all of
    it. .toml: its scenario. .fmu: the law as a unit of FMI 3.0, for other simulators. .xml, .sdf, .urdf: body, support
    and start as MJCF, SDFormat or URDF, for physics engines.

    With --live, a page with sliders and curves that computes the motion where it is opened, without a network and
    without Python. What no page can compute is refused.

    Exit status: 0, all is well; 2, bad input; 130, interrupted; 1, all else.
    """
    from ..files import written_whole

    target = Path(file).expanduser()
    _check(runs, target)
    _check_live(runs, target, slider or [], live=live)
    told = unsaid = ""
    if target.suffix.lower() == _UNIT:
        content, told = _unit(runs[0])
    elif target.suffix.lower() in _MODELS:
        content, unsaid = _model(runs[0], target.suffix)
    elif live:
        content = _live(runs[0], slider or [], bar=not quiet)
    else:
        content = _content(runs, target.suffix.lower(), bar=not quiet)
    with written_whole(target) as temporary:
        temporary.write_bytes(content)
    if not quiet:
        screen.out(f"Wrote {target} ({_size(len(content))}{told})")
        if unsaid:
            screen.out(unsaid)


def _check(names: list[str], target: Path) -> None:
    """Refuse what cannot be meant before anything is computed."""
    formats = (*exports.FORMATS, _UNIT, *_MODELS)
    if target.suffix.lower() not in formats:
        raise InvalidValueError("FILE", f"must end in one of {', '.join(formats)}", str(target))
    if target.is_dir() or not target.parent.is_dir():
        rule = "must not be a folder" if target.is_dir() else "must lie in a folder that exists"
        raise InvalidValueError("FILE", rule, str(target))
    if target.suffix.lower() in exports.FORMATS:
        exports.check_installed(target.suffix, str(target))
    elif _is_run(names[0]):
        rule = f"must be a scenario for {target.suffix}"
        raise InvalidValueError("RUN", rule, names[0], "A run is numbers, and has no law.")
    if len(names) > 1 and target.suffix.lower() != _SEVERAL:
        remedy = f"Only {_SEVERAL} can hold several."
        raise InvalidValueError("RUN", "must be one", ", ".join(names), remedy)
    if any(_same(name, target) for name in names):
        raise InvalidValueError("FILE", "must not be the run itself", str(target), "Choose another name.")


def _check_live(names: list[str], target: Path, sliders: list[str], *, live: bool) -> None:
    """Refuse what a live page cannot be made of."""
    if sliders and not live:
        raise InvalidValueError("--slider", "must stand beside --live", ", ".join(sliders), "Add --live.")
    if live and target.suffix.lower() != _SEVERAL:
        raise InvalidValueError("FILE", f"must end in {_SEVERAL} for --live", str(target))
    if live and (len(names) > 1 or _is_run(names[0])):
        remedy = "A run is numbers, and has no law; several have several."
        raise InvalidValueError("RUN", "must be one scenario for --live", ", ".join(names), remedy)


def _same(name: str, target: Path) -> bool:
    try:
        return Path(name).samefile(target)
    except (OSError, ValueError):
        return False


def _content(names: list[str], suffix: str, *, bar: bool) -> bytes:
    if suffix == ".toml" and not _is_run(names[0]):
        return _scenario(names[0]).to_toml().encode()  # nothing need be computed for it
    if len(names) == 1:
        motion, make_scene = _motion(names[0], bar=bar)
        return exports.export(motion, suffix, make_scene)
    from ..views.viewer.page import check_count, page_of

    check_count(len(names))
    found = [_motion(name, bar=bar) for name in names]
    return page_of([make_scene(motion, with_card=True) for motion, make_scene in found])


def _unit(name: str) -> tuple[bytes, str]:
    """Return the law of a scenario as a unit of FMI, and a word about the binary in it."""
    from ..fields.fmi import fmu

    scenario = load(name)
    made, where = fmu(scenario.system(), scenario.start_state(), scenario.title)
    return made, f", with a binary for {where}" if where else ", sources only: no C compiler is found here"


def _model(name: str, ending: str) -> tuple[bytes, str]:
    """Return a scenario as a model for physics engines, and what they must be told besides."""
    from ..conformance.models import engine_model

    text, unsaid = engine_model(load(name), ending)
    return text.encode(), unsaid


def _live(name: str, sliders: list[str], *, bar: bool) -> bytes:
    """Return a live page of a scenario."""
    from ..errors import OutOfDomainError
    from ..live import live_page

    scenario = _scenario(name)
    if hasattr(scenario, "path"):
        raise InvalidValueError("RUN", "must be a scenario with forces", name, "A path to roll along has no law.")
    with screen.ProgressBar(wanted=bar) as progress:
        try:
            page = live_page(scenario, sliders, progress=progress)
        except OutOfDomainError as error:
            raise InvalidValueError("RUN", "must be one that a live page can compute", name, str(error)) from None
    signals.check()
    return page


def _is_run(name: str) -> bool:
    return Path(name).suffix.lower() == ".nc"


def _scenario(name: str) -> Any:
    """Return a scenario, or a path to roll along."""
    from ..analysis.geometry import PathScenario

    tables = files.tables_of(name)
    return PathScenario.read(tables, name) if files.rolls_along_path(tables) else load(name, tables)


def _motion(name: str, *, bar: bool) -> tuple[Any, Callable[..., Scene]]:
    """Return a motion, loaded or computed, and what makes a scene of it."""
    from ..views.scene import scene_of

    if _is_run(name):
        from ..simulation.trajectory import Trajectory

        run = Trajectory.load(Path(name).expanduser())
        if bar and run.changed:
            screen.note(f"trundle: {name} has changed since it was saved: {', '.join(run.changed)}")
        return run, scene_of
    scenario = _scenario(name)
    if hasattr(scenario, "path"):
        from ..analysis.geometry.scene import rolled_scene

        return scenario.run(), rolled_scene
    with screen.ProgressBar(wanted=bar) as progress:
        run = scenario.run(progress=progress)
    signals.check()
    return run, scene_of


def _size(count: int) -> str:
    return f"{count / 1e6:.1f} MB" if count >= 1e5 else f"{count / 1e3:.1f} kB"
