"""The file of a unit: its description, its sources, and a binary where a C compiler is found."""

from __future__ import annotations

import hashlib
import io
import json
import platform
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from enum import IntEnum
from importlib.resources import files
from pathlib import Path

import numpy as np

from ...errors import SolverError, TrundleError
from ...mechanics.parameters import numbers, with_numbers
from ...mechanics.system import RollingSystem, State
from ...solve.samples import SLIPPING
from ...solve.transitions import at_start
from ..compiler import compiler, shared_library
from ..field import VectorField
from ..printers import c
from ..routines import PhaseRoutines, Routine, starting_phase
from ..touching import CODES
from .description import IDENTIFIER, build_description, model_description

_SMALL = 1e-9  # a number that differs from 0, in any unit
_EARLIEST = (1980, 1, 1, 0, 0, 0)  # so that the same unit is the same file


class Sign(IntEnum):
    """What a number may be."""

    ANY = 0
    NOT_NEGATIVE = 1
    POSITIVE = 2


def fmu(system: RollingSystem, start: State, title: str) -> tuple[bytes, str]:
    """Make a unit of a system in the phase in which it starts.

    Parameters
    ----------
    system : RollingSystem
        What moves; each of its numbers becomes a tunable parameter.
    start : State
        From which it goes.
    title : str
        What the unit is.

    Returns
    -------
    bytes, str
        The file; and the platform of the binary in it, or nothing where no C compiler is found.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> made, _ = fmu(level, level.place(), "A ball")
    >>> zipfile.ZipFile(io.BytesIO(made)).namelist()[0]
    'modelDescription.xml'
    """
    field, y = beginning(system, start)
    sources = {
        "fmi3.c": files(__package__).joinpath("fmi3.c").read_text(encoding="utf-8"),
        "model.c": c.source(_routines(field), "model", title),
    }
    token = hashlib.sha256("".join([*sources.values(), repr(y.tolist())]).encode()).hexdigest()
    sources["model.h"] = _header(field, y, token)
    texts = {
        "modelDescription.xml": model_description(field, y, float(start.time), title, token),
        "sources/buildDescription.xml": build_description([name for name in sources if name.endswith(".c")]),
        **{f"sources/{name}": text for name, text in sources.items()},
    }
    binary, where = _binary(sources)
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in texts.items():
            archive.writestr(zipfile.ZipInfo(name, _EARLIEST), text, zipfile.ZIP_DEFLATED)
        if binary:
            archive.writestr(zipfile.ZipInfo(where, _EARLIEST), binary, zipfile.ZIP_DEFLATED)
    return held.getvalue(), where.split("/")[1] if binary else ""


def beginning(system: RollingSystem, start: State) -> tuple[VectorField, np.ndarray]:
    """Return the field with which a start goes on, and its state: slip where friction gives way at once."""
    field = VectorField(system, "c", starting_phase(system, start))
    y = field.pack(start)
    law = at_start(system, start).law
    if law.code == SLIPPING and field.phase in ("rolling", "rest"):
        there = VectorField(system, "numpy", field.phase)
        follows, y = there.after("slip", float(start.time), y, there.parameters, there.inputs)
        field = field.at(follows.phase)
    return field, np.asarray(y)


def _header(field: VectorField, y: np.ndarray, token: str) -> str:
    """Return what the functions of FMI know of the model."""
    phase, routines = field.phase, _routines(field)
    given = sum(len(each.outputs) for each in routines if each.name == f"{phase}_event_parameters")
    sizes = {
        "STATES": len(field.state_names),
        "PARAMETERS": len(field.parameter_names),
        "INPUTS": len(field.input_names),
        "EVENTS": len(field.event_names),
        "OUTPUTS": len(field.output_names),
        "GIVEN": given,
    }
    e = ", e" if given else ""
    begin = f"model_{phase}_event_parameters(t, y, p, u, e)" if given else "(void)0"
    arrays = {"start": y, "parameters": field.parameters, "inputs": field.inputs}
    return "\n".join(
        [
            c.header(routines, "model", "The model's functions, and its numbers."),
            *(f"#define MODEL_{name} {size}" for name, size in sizes.items()),
            f'#define MODEL_TOKEN "{token}"',
            f"#define MODEL_RATES(t, y, p, u, found) model_{phase}_rates(t, y, p, u, found)",
            f"#define MODEL_EVENTS_OF(t, y, p, u, e, found) model_{phase}_events(t, y, p, u{e}, found)",
            f"#define MODEL_OUTPUTS_OF(t, y, p, u, found) model_{phase}_outputs(t, y, p, u, found)",
            f"#define MODEL_BEGIN(t, y, p, u, e) {begin}",
            *(
                f"static const double model_{name}[] = {{{', '.join(map(repr, values.tolist()))}}};"
                for name, values in arrays.items()
            ),
            _texts("event_names", field.event_names),
            _texts("parameter_names", field.parameter_names),
            f"static const int model_signs[] = {{{', '.join(map(str, map(int, signs(field.system)))) or '0'}}};",
            *_goes_on(field, [each.name for each in routines]),
            "",
        ]
    )


def _routines(field: VectorField) -> list[Routine]:
    """Return what is in a unit: the phase by itself, and what follows an event after which it goes on."""
    found, own = PhaseRoutines(field.system, field.phase, field.input_groups), list[Routine]()
    for event in found.resets():
        follows = {each.name.removeprefix(f"{field.phase}_"): each for each in found.after(event)}
        wanted = f"{field.phase}_after_{event}"
        if wanted in follows:
            own += [follows[name] for name in (f"phase_after_{event}", wanted) if name in follows]
    return [*field.routines(alone=True), *own]


def _goes_on(field: VectorField, names: list[str]) -> Iterator[str]:
    """Yield the function that begins the phase anew where it follows its own event, and tells whether it does."""
    given = "int event, double t, const double *y, const double *p, const double *u, double *after"
    yield f"static int model_goes_on({given})"
    yield "{"
    yield "    double phase[1] = {-1};"
    yield "    (void)t, (void)y, (void)p, (void)u, (void)after, (void)phase;"
    yield "    switch (event) {"
    for i, event in enumerate(field.event_names):
        name = event.removeprefix("near ")
        if f"{field.phase}_phase_after_{name}" in names:
            yield f"    case {i}:"
            yield f"        model_{field.phase}_phase_after_{name}(t, y, p, u, phase);"
            yield f"        if (phase[0] != {CODES[field.phase]}) return 0;"
            yield f"        model_{field.phase}_{field.phase}_after_{name}(t, y, p, u, after);"
            yield "        return 1;"
    yield "    default: return 0;"
    yield "    }"
    yield "}"


def signs(system: RollingSystem) -> Iterator[Sign]:
    """Yield of each number of a system what its checks let it be.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> [sign.name for sign in signs(level)][:4]
    ['POSITIVE', 'POSITIVE', 'POSITIVE', 'ANY']
    """
    values = numbers(system)
    for i, value in enumerate(values):
        found = Sign.ANY
        for sign, other in ((Sign.NOT_NEGATIVE, -abs(value) or -_SMALL), (Sign.POSITIVE, 0.0)):
            try:
                with_numbers(system, [*values[:i], other, *values[i + 1 :]])
            except TrundleError:
                found = sign
            else:
                break
        yield found


def _texts(name: str, texts: Sequence[str]) -> str:
    listed = ", ".join(json.dumps(text) for text in texts) or "0"
    return f"static const char *const model_{name}[] = {{{listed}}};"


def _binary(sources: dict[str, str]) -> tuple[bytes, str]:
    """Compile the sources; nothing, where there is no compiler or it refuses."""
    command = compiler()
    system = {"Linux": ("linux", ".so"), "Darwin": ("darwin", ".dylib"), "Windows": ("windows", ".dll")}
    if command is None or platform.system() not in system:
        return b"", ""
    name, ending = system[platform.system()]
    machine = platform.machine().lower()
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(machine, machine)
    with tempfile.TemporaryDirectory(prefix="trundle-", ignore_cleanup_errors=True) as folder:
        for file, text in sources.items():
            (Path(folder) / file).write_text(text, encoding="utf-8")
        target = Path(folder) / f"{IDENTIFIER}{ending}"
        units = [Path(folder) / file for file in sources if file.endswith(".c")]
        try:
            shared_library(command, units, target, "-fvisibility=hidden")
        except SolverError:
            return b"", ""
        return target.read_bytes(), f"binaries/{machine}-{name}/{target.name}"
