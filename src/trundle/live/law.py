"""The law of a scenario as the script of a page: its phases, what follows what, and the start placed anew."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from typing import Any

from ..analysis.sensitivities.keys import Key
from ..errors import OutOfDomainError
from ..fields.printers import javascript
from ..fields.routines import FILM, PhaseRoutines, Routine, check_analytic, phases_of
from ..fields.touching import CODES, HELD, NOTHING
from ..mechanics.kinks import kinks_and_jolts
from ..mechanics.parameters import parameters
from ..mechanics.quantities import is_ball
from ..mechanics.system import RollingSystem
from ..scenario import ScenarioFile
from ..solve.contact_state import ContactState, moment
from ..solve.phases import ENDS
from ..views.scene.curves import PREFIX
from ..views.scene.headline import KINDS
from ..wording import units_of
from .formula import FormulaRoutines
from .start import Placed

TOLERANCE = 1e-13  # relative, of each step

# What is said where a phase gives way to another, by its event and that which follows.
_SAID = {
    "grip": {
        "rolling": "Gripped and rolled",
        "slipping": "Slipped on the other way",
        HELD: "Slipped on the other way",
        "rest": "Came to rest",
    },
    "stop": {
        "rest": "Came to rest",
        "rolling": "Stood for an instant",
        "slipping": "Turned on the other way as it slipped",
        HELD: "Stopped turning as it slipped",
    },
    "start": {"rolling": "Began to roll", "slipping": "Began to turn as it slipped"},
    "slip": {"slipping": "Began to slip", HELD: "Began to slip"},
    "lift": {"flight": "Came off the support"},
    "land": {
        "flight": "Bounced",
        "slipping": "Landed and slipped",
        HELD: "Landed and slipped",
        "rolling": "Landed and rolled",
        "rest": "Landed and stayed",
    },
}
_JAM = "Friction would jam the body: the rigid law has no answer"


def check(scenario: ScenarioFile) -> None:
    """Refuse a scenario whose law no page can hold.

    Raises
    ------
    OutOfDomainError
        With the reason and the remedy.
    """
    system = scenario.system()
    check_analytic(system)
    begin = float(scenario.start.time)
    bends = kinks_and_jolts(system, begin, begin + float(scenario.timing.duration))
    if bends:
        raise OutOfDomainError(
            f"At t = {bends[0].time:.6g} s a formula in the time has a kink, and a live page has no law for what comes "
            "across it. Export it without --live, or take a formula that is smooth."
        )


def script_of(scenario: ScenarioFile, wanted: Sequence[Key], placed: Placed, said: str = "") -> str:
    """Return the law as text: functions, and `law`, which names them.

    `said`: the sentence of the headline, whose number is printed where a closed form has it.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.analysis.sensitivities.keys import chosen
    >>> scenario = tr.Scenario.load("tilted-turntable")
    >>> radius = chosen(scenario, ["body.radius"])
    >>> "function rolling_film(" in script_of(scenario, radius, Placed.of(scenario, radius))
    True
    """
    system = scenario.system()
    start = scenario.start_state()
    phases = {phase: PhaseRoutines(system, phase, ()) for phase in phases_of(system)}
    begins, promised = placed.phase, None
    if placed.form is not None:
        routines = FormulaRoutines(system, begins, placed.form, float(start.time))
        begins, promised = routines.name, routines.promised(said)
        phases[begins] = routines
    printed: list[Routine] = [placed.routine, *([promised] if promised else [])]
    told = {phase: _phase(routines, printed) for phase, routines in phases.items()}
    arm = float(ContactState.of(system, start).arm)
    law = {
        "shows": _shows(system, said),
        "begin": float(start.time),
        "duration": float(scenario.timing.duration),
        "phase": begins,
        "size": placed.size,
        "defaults": [key.value for key in wanted],
        "arm": arm,
        "moment": moment(system, start),
        "tolerance": TOLERANCE,
        "codes": CODES,
        "nothing": NOTHING,
        "turning": [name for name, _ in FILM].index("angular_velocity_x"),
        "said": _SAID,
        "ends": _ends(system),
        "method": _method(),
    }
    listed = ",\n".join(f"  {json.dumps(phase)}: {text}" for phase, text in told.items())
    said = "The law of this motion, as trundle wrote it. All numbers are in SI."
    # A worker's script is no module.
    text = re.sub(r"^export ", "", javascript.module(printed, said), flags=re.MULTILINE)
    theory = promised.name if promised else "null"
    return f"{text}\nconst law = {{...{json.dumps(law)}, placed, promised: {theory}, phases: {{\n{listed}\n}}}};\n"


def _shows(system: RollingSystem, said: str) -> dict[str, Any]:
    """Return what the page tells its headline from."""
    return {
        "said": said,
        "ball": is_ball(system),
        "deep": system.support.surface.where.startswith("in"),
        "row": [*(name for name, _ in FILM), *(one["column"].removeprefix(PREFIX) for one in curves_of(system))],
        "parameters": [name for name, _ in parameters(system)],
        "units": {unit: [[u.scale, u.symbol, u.least] for u in units_of(kind)] for unit, kind in KINDS.items()},
    }


def curves_of(system: RollingSystem) -> list[dict[str, Any]]:
    """Return what a row of the film holds to be drawn over the time, as a scene's header has it, and where."""
    told = PhaseRoutines(system, next(iter(phases_of(system))), ()).curves()
    return [
        {"column": f"{PREFIX}{one.key}", "label": one.label, "unit": one.unit, "index": i, "touching": one.touching}
        for i, one in enumerate(told, start=len(FILM))
    ]


def _phase(routines: PhaseRoutines, printed: list[Routine]) -> str:
    """Return one phase as an object of JavaScript, and add what it names to what is printed."""
    names, events = routines.events()
    own: dict[str, Routine] = {"rates": routines.rates(), "events": events, "film": routines.film()}
    if routines.law.event_parameters:
        own["eventParameters"] = routines.event_parameters()
    printed += own.values()
    parts = [
        f"name: {json.dumps(routines.phase)}, code: {routines.law.code}",
        *(f"{key}: {routine.name}" for key, routine in own.items()),
    ]
    parts += [f"names: {json.dumps(names)}", f"groups: {json.dumps(_groups(routines.state_names))}"]
    resets = []
    for event in routines.resets():
        following = list(routines.after(event))
        printed += following
        known = {
            each.name.removeprefix(f"{routines.name}_").removesuffix(f"_after_{event}"): each.name for each in following
        }
        choice = known.pop("phase", "null")
        states = ", ".join(f"{phase}: {name}" for phase, name in known.items())
        resets.append(f"{event}: {{choice: {choice}, states: {{{states}}}}}")
    return f"{{{', '.join(parts)}, resets: {{{', '.join(resets)}}}}}"


def _groups(names: Sequence[str]) -> list[list[Any]]:
    """Return which numbers of a state belong together: where they begin and end, and what they are."""
    heads = [name.partition("_")[0] for name in names]
    begins = [i for i, head in enumerate(heads) if i == 0 or head != heads[i - 1] or head == "support"]
    return [[i, j, heads[i]] for i, j in zip(begins, [*begins[1:], len(heads)], strict=True)]


def _ends(system: RollingSystem) -> dict[str, str]:
    """Return what is said where a motion ends, by event."""
    surface, shape = system.support.surface, system.body.shape
    known = {name: text.format(rim=0.0, end=surface.domain_end, left=shape.validity_end) for name, text in ENDS.items()}
    plain = {name: re.sub(r" \(.*?\)", "", text) for name, text in known.items()}
    return {name: text[:1].upper() + text[1:] for name, text in (plain | {"jam": _JAM}).items()}


def _method() -> dict[str, Any]:
    """Return the coefficients of DOP853, with those of its dense output."""
    from scipy.integrate import DOP853

    rows = [*DOP853.A[1:].tolist(), DOP853.B.tolist(), *DOP853.A_EXTRA.tolist()]
    return {
        "c": [*DOP853.C[1:].tolist(), 1.0, *DOP853.C_EXTRA.tolist()],
        "a": rows,
        "e3": DOP853.E3.tolist(),
        "e5": DOP853.E5.tolist(),
        "d": DOP853.D.tolist(),
    }


__all__ = ["TOLERANCE", "check", "script_of"]
