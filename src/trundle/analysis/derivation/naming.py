"""What can be derived by name, and the derivation of a name, a scenario or a system."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...errors import InvalidValueError, UnknownNameError
from ...scenario import files
from .topics import TOPICS

if TYPE_CHECKING:
    from ...mechanics.system import RollingSystem, State
    from .steps import Derivation


def derivable() -> list[tuple[str, str]]:
    """Return the topics and the shipped scenarios that `derive` knows by name, with their titles.

    Examples
    --------
    >>> derivable()[0]
    ('ball-on-plane', 'Ball on a level plane under a force and a torque')
    """
    scenarios = [name for name in files.names() if name not in TOPICS and not files.is_shipped_path(name)]
    return [(name, topic.title) for name, topic in TOPICS.items()] + [
        (name, files.title_of(name)) for name in scenarios
    ]


def derive(name_or_scenario: Any, *, with_numbers: bool = False) -> Derivation:
    """Derive the motion of a rolling body from Newton's and Euler's laws, with a proof of each equation.

    SymPy symbols pass through the same bodies, loads, motions and rolling law as the numbers of a run do.

    Parameters
    ----------
    name_or_scenario : str, path, Scenario or RollingSystem
        A topic or shipped scenario of `derivable()`, a scenario file, a scenario or a system.
    with_numbers : bool
        Whether to put the numbers of the scenario in at the end.

    Returns
    -------
    Derivation
        Its steps in the order of the lecture; `text()`, `markdown()`, `latex()` and `as_dict()`.

    Raises
    ------
    UnknownNameError
        If there is neither a topic nor a scenario of that name.
    InvalidValueError
        If there are no numbers to put in.
    DerivationError
        If an equation does not hold for what the rolling law returns.

    Examples
    --------
    >>> import trundle as tr
    >>> tr.derive("tilted-turntable").steps[-1].title
    'The closed form is a solution'
    """
    if isinstance(name_or_scenario, str) and name_or_scenario in TOPICS:
        return _of_topic(name_or_scenario, with_numbers=with_numbers)
    system, start, name, title = _described(name_or_scenario)
    return _of_system(system, start, name, title, with_numbers=with_numbers)


def _of_topic(name: str, *, with_numbers: bool) -> Derivation:
    from .forms import module_named
    from .steps import Derivation, checked

    topic = TOPICS[name]
    numbers = ()
    if with_numbers:
        if name not in files.names():
            raise InvalidValueError("with_numbers", "needs a scenario", name, "A topic has symbols only.")
        numbers = derive_scenario_numbers(name)
    module = module_named(topic.form)
    general = topic.form == "general"
    steps = module.law_steps() if general else module.derive_system(module.Setting(**topic.setting))
    steps = checked(name, steps)
    return Derivation(name, topic.title, topic.introduction, steps, numbers)


def derive_scenario_numbers(name: str) -> tuple[Any, ...]:
    """Return the constants of the closed form with the numbers of a scenario.

    Examples
    --------
    >>> [number.unit for number in derive_scenario_numbers("tilted-turntable")][-1]
    'm'
    """
    system, start, *_ = _described(name)
    return _numbers(system, start)


def _numbers(system: RollingSystem, start: State | None) -> tuple[Any, ...]:
    from .forms import form_of

    form, module = form_of(system, start)
    if form is None or start is None:
        return ()
    return tuple(module.numbers_of(form.of(system, start), system))


def _of_system(system: RollingSystem, start: State | None, name: str, title: str, *, with_numbers: bool) -> Derivation:
    from .forms import form_of
    from .steps import Derivation, checked

    if with_numbers and start is None:
        raise InvalidValueError("with_numbers", "needs a scenario", name, "A system alone has no start.")
    form, module = form_of(system, start)
    if form is None:
        if with_numbers:
            remedy = "None that is derived here covers it, so there are no constants to put numbers in; leave this out."
            raise InvalidValueError("with_numbers", "needs a closed form", name, remedy)
        from .general import derive_system, introduction

        return Derivation(name, title, introduction(system), checked(name, derive_system(system)))
    steps = checked(name, module.derive_system(module.Setting.of(system)))
    said = (
        f"How the motion follows from Newton's and Euler's laws, up to the closed form {form.equation} ({form.name})."
    )
    return Derivation(name, title, said, steps, _numbers(system, start) if with_numbers else ())


def _described(name_or_scenario: Any) -> tuple[RollingSystem, State | None, str, str]:
    """Return system, start, name and title."""
    from ...mechanics.system import RollingSystem
    from ...scenario import ScenarioFile

    if isinstance(name_or_scenario, RollingSystem):
        return name_or_scenario, None, "system", "A rolling body"
    if isinstance(name_or_scenario, ScenarioFile):
        scenario, name = name_or_scenario, "scenario"
    else:
        name = str(name_or_scenario)
        scenario = ScenarioFile.read(_tables_of(name), name)
    return scenario.system(), scenario.start_state(), name, scenario.title


def _tables_of(name: str) -> dict[str, Any]:
    """Return the tables of a scenario; refuse a name that is none, and a file that has no forces."""
    if name not in files.names() and not files.locate(name).exists():
        raise UnknownNameError("derivation", name, [known for known, _ in derivable()])
    return files.tables_of(name)
